"""The updated local frame: a second reading of the paper's modified formulation, as a prototype.

The local coordinates of each element are updated to its deformed shape, strains are those of the
increment in these coordinates (at the middle of the increment, so that they add up to the
logarithmic strain), and the stress is Cauchy's, carried along by the frame of the element. The
stress of an equilibrated state balances by itself: the projector of the frame drops out.

Slow and plain on purpose (numpy, tangent by complex steps): only its figures matter, beside those
of the local strains `linear` and `logarithmic`. ``python -m benchmarks updated_frame``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

import corota as ct
from corota.verification.models import DRILLING
from corota.verification.plastic_models import CELL, find, perforated_strip, strip_mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

#: Complex step.
STEP = 1e-30
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], float)
GAUSS = 1.0 / np.sqrt(3.0)


def notched_strip(
    element: str,
    n: int,
    elongation: float,
    local_strain: Any = "logarithmic",
    material: Any = None,
) -> ct.Model:
    """Quarter strip 10 x 18 in plane strain with a round notch of radius 5 on either side.

    Steel that hardens by less than its stress (E 200000, nu 0.3, yield stress 250, slope 150);
    `elongation` is the displacement of the top over the height.
    """
    model = ct.Model(strip_mesh(n, CELL[element]))
    material = material or ct.Mises(E=200e3, nu=0.3, yield_stress=250.0, isotropic=150.0)
    model.section(
        "all", element=element, material=material, plane="strain", local_strain=local_strain
    )
    turn = 0.0 if element in DRILLING else None
    bottom, right, top = (find(model.mesh, a, v) for a, v in ((1, 0.0), (0, 10.0), (1, 18.0)))
    model.fix(bottom, x=None, y=0.0, rotation=turn)
    model.fix(right, x=0.0, y=None, rotation=turn)
    model.fix(top, x=None, y=18.0 * elongation, rotation=turn)
    return model


def derivatives(r: float, s: float) -> Array:
    """Natural derivatives of the eight serendipity functions, (8, 2)."""
    d = np.zeros((8, 2))
    for a, (p, q) in enumerate(CORNERS):
        if a < 4:
            d[a, 0] = 0.25 * p * (1 + q * s) * (2 * p * r + q * s)
            d[a, 1] = 0.25 * q * (1 + p * r) * (2 * q * s + p * r)
        elif p == 0:
            d[a] = -r * (1 + q * s), 0.5 * q * (1 - r * r)
        else:
            d[a] = 0.5 * p * (1 - s * s), -s * (1 + p * r)
    return d


@dataclass
class History:
    """Stress (e, p, 4) in the element frame, plastic strain, thickness strain (e, p)."""

    stress: Array
    plastic: Array
    normal: Array


class UpdatedFrame:
    """A mesh of Q8R cells with linear hardening.

    Parameters
    ----------
    model : corota.Model
        Its mesh, material, thickness and plane; loads and supports are given to `solve`.
    """

    def __init__(self, model: ct.Model) -> None:
        section = model.sections[0]
        law: Any = section.material
        self.x = model.mesh.points
        self.cells = np.concatenate([np.asarray(b.nodes) for b in model.mesh.cells])
        self.shear = law.E / (2.0 * (1.0 + law.nu))
        self.bulk = law.E / (3.0 * (1.0 - 2.0 * law.nu))
        self.yield_stress = law.yield_stress
        self.hardening = float(law.isotropic or 0.0)
        self.thickness, self.free = section.thickness, section.plane == "stress"
        places = [(r, s) for s in (-GAUSS, GAUSS) for r in (-GAUSS, GAUSS)]
        self.dn = np.stack([derivatives(r, s) for r, s in places])
        n, p = len(self.cells), len(places)
        self.committed = History(np.zeros((n, p, 4)), np.zeros((n, p)), np.zeros((n, p)))
        self.dofs = (2 * self.cells[:, :, None] + np.arange(2)).reshape(n, -1)
        self.u = np.zeros(self.x.size)

    def local(self, u: Array) -> tuple[Array, Array, Array]:
        """Local coordinates in the deformed shape, cosine and sine of the frame."""
        own = self.x[self.cells]
        start = own - own.mean(axis=1, keepdims=True)
        now = own + u.reshape(len(own), -1, 2)
        now = now - now.mean(axis=1, keepdims=True)
        along = (start * now).sum(axis=(1, 2))
        across = (start[..., 0] * now[..., 1] - start[..., 1] * now[..., 0]).sum(axis=1)
        size = np.sqrt(along**2 + across**2)
        c, s = (along / size)[:, None], (across / size)[:, None]
        turned = np.stack(
            [c * now[..., 0] + s * now[..., 1], c * now[..., 1] - s * now[..., 0]], axis=-1
        )
        return turned, c, s

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """Derivatives of the shape functions (e, p, a, i) by local coordinates, and area."""
        j = np.einsum("eai,paj->epij", x, self.dn)
        det = j[..., 0, 0] * j[..., 1, 1] - j[..., 0, 1] * j[..., 1, 0]
        inverse = np.empty_like(j)
        inverse[..., 0, 0], inverse[..., 1, 1] = j[..., 1, 1] / det, j[..., 0, 0] / det
        inverse[..., 0, 1], inverse[..., 1, 0] = -j[..., 0, 1] / det, -j[..., 1, 0] / det
        return np.einsum("paj,epji->epai", self.dn, inverse), det

    def respond(self, strain: Array) -> tuple[History, Array]:
        """Radial return from the committed state; `strain` xx, yy, xy (engineering) of the step."""
        at = self.committed
        normal = np.zeros_like(strain[..., 0])
        stress = normal
        for _ in range(40 if self.free else 1):
            full = np.stack([strain[..., 0], strain[..., 1], normal, 0.5 * strain[..., 2]], axis=-1)
            trace = full[..., :3].sum(axis=-1)
            trial = at.stress + 2.0 * self.shear * full
            trial[..., :3] += (self.bulk - 2.0 / 3.0 * self.shear) * trace[..., None]
            mean = trial[..., :3].sum(axis=-1) / 3.0
            dev = trial.copy()
            dev[..., :3] -= mean[..., None]
            norm = np.sqrt(
                1.5 * ((dev[..., :3] ** 2).sum(axis=-1) + 2.0 * dev[..., 3] ** 2) + 1e-60
            )
            over = norm - self.yield_stress - self.hardening * at.plastic
            flow = np.where(over.real > 0.0, over / (3.0 * self.shear + self.hardening), 0.0)
            share = 1.0 - 3.0 * self.shear * flow / norm
            stress = dev * share[..., None]
            stress[..., :3] += mean[..., None]
            if not self.free:
                break
            # Slope of the stress through the thickness, exact: Newton's method.
            n = dev[..., 2] / norm
            ratio = np.where(
                over.real > 0.0, 3.0 * self.shear / (3 * self.shear + self.hardening), 0
            )
            slope = self.bulk + 4.0 / 3.0 * self.shear * share
            slope = slope - 3.0 * self.shear * n**2 * (ratio - (1.0 - share))
            normal = normal - stress[..., 2] / slope
        return History(stress, at.plastic + flow, at.normal + normal), stress

    def force(self, u: Array) -> tuple[Array, History]:
        """Forces of all elements (e, 16) at element displacements `u`, and the new history."""
        before = self.local(self.u[self.dofs])[0]
        now, c, s = self.local(u)
        middle, _ = self.gradients(0.5 * (before + now))
        h = np.einsum("epaj,eai->epij", middle, now - before)
        strain = np.stack([h[..., 0, 0], h[..., 1, 1], h[..., 0, 1] + h[..., 1, 0]], axis=-1)
        history, stress = self.respond(strain)
        g, area = self.gradients(now)
        weight = area * self.thickness * (np.exp(history.normal) if self.free else 1.0)
        t = np.stack(
            [
                np.stack([stress[..., 0], stress[..., 3]], axis=-1),
                np.stack([stress[..., 3], stress[..., 1]], axis=-1),
            ],
            axis=-2,
        )
        f = np.einsum("epaj,epij,ep->eai", g, t, weight)
        turned = np.stack([c * f[..., 0] - s * f[..., 1], s * f[..., 0] + c * f[..., 1]], axis=-1)
        return turned.reshape(len(f), -1), history

    def equations(self, u: Array) -> tuple[Array, Any, History]:
        """Nodal forces, tangent and history at displacements `u`."""
        own = u[self.dofs]
        f, history = self.force(own)
        k = np.empty((*f.shape, f.shape[1]))
        for d in range(f.shape[1]):
            moved = own.astype(complex)
            moved[:, d] += 1j * STEP
            k[:, :, d] = self.force(moved)[0].imag / STEP
        total = np.zeros(len(u))
        np.add.at(total, self.dofs, f)
        rows = np.repeat(self.dofs, f.shape[1], axis=1).ravel()
        columns = np.tile(self.dofs, (1, f.shape[1])).ravel()
        return total, sp.csr_matrix((k.ravel(), (rows, columns)), shape=(len(u),) * 2), history

    def solve(self, held: Array, values: Array, load: Array, increments: int) -> Array:
        """Newton's method over increments that are halved where it fails; internal forces.

        Parameters
        ----------
        held : array of int
            Dofs that are prescribed, with their final `values`.
        load : array
            Dead nodal forces at the end.
        increments : int
            Number of increments at least.
        """
        time, step = 0.0, 1.0 / increments
        f = np.zeros_like(self.u)
        while time < 1.0 - 1e-12:
            to = min(time + step, 1.0)
            found = self._increment(held, to * values, to * load)
            if found is None:
                step *= 0.5
                if step < 1e-5:
                    raise RuntimeError(f"no convergence at {time:.4f} of the load")
                continue
            f, time = found, to
            step = min(1.5 * step, 1.0 / increments)
        return f

    def _increment(self, held: Array, values: Array, load: Array) -> Array | None:
        free = np.setdiff1d(np.arange(len(self.u)), held)
        u = self.u.copy()
        for iteration in range(12):
            f, k, history = self.equations(u)
            r = load - f
            if not np.isfinite(r).all():
                return None
            if iteration and np.abs(r[free]).max() <= 1e-7 * (np.abs(f).max() + 1e-30):
                self.u, self.committed = u, history
                return f
            du = np.zeros_like(u)
            if iteration == 0:
                du[held] = values - u[held]
            du[free] = spsolve(k[free][:, free].tocsc(), r[free] - (k @ du)[free])
            u = u + du
        return None


def prescribed(model: ct.Model) -> tuple[Array, Array]:
    """Held dofs and their values."""
    held: dict[int, float] = {}
    for support in model.supports:
        nodes = support.nodes
        for node in model.mesh.nodes_of(nodes) if isinstance(nodes, str) else np.asarray(nodes):
            if support.dof < 2:
                held[2 * int(node) + support.dof] = float(support.value)
    dofs = np.array(sorted(held))
    return dofs, np.array([held[d] for d in dofs])


def main(n: int = 3) -> None:
    """Force of the notched strip and of the perforated one, beside the local strains."""
    cases: list[tuple[str, Any, float]] = [
        ("notched", lambda strain, e=e: notched_strip("Q8R", n, e, strain), e)
        for e in (0.02, 0.05, -0.02, -0.05)
    ]
    cases.append(("perforated", lambda s: perforated_strip("Q8R", n, local_strain=s), 0.3 / 18.0))
    for name, model, elongation in cases:
        row = [f"{name} {elongation:+.3f}"]
        for strain in ("linear", "logarithmic"):
            shape = model(strain)
            results = ct.solve(shape, ct.Static(increments=20), threads=1, fields=False)
            top = find(shape.mesh, 1, 18.0)
            row.append(f"{strain} {results.frames[-1].RF[top, 1].sum():.2f}")
        shape = model("logarithmic")
        prototype = UpdatedFrame(shape)
        held, values = prescribed(shape)
        f = prototype.solve(held, values, np.zeros_like(prototype.u), 20)
        row.append(f"updated frame {f[2 * find(shape.mesh, 1, 18.0) + 1].sum():.2f}")
        print("  ".join(row), flush=True)


if __name__ == "__main__":
    main()

"""Models for verification and benchmarks of plasticity, for any element and mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota.verification.models import DRILLING, ELEMENTS, cell

if TYPE_CHECKING:
    from corota.arrays import Ints
    from corota.model.materials import Material

#: Cell kind that each element needs.
CELL: dict[str, Any] = {name: cell(name) for name in ELEMENTS}


def find(mesh: ct.Mesh, axis: int, value: float) -> Ints:
    """Nodes with a coordinate."""
    size = float(np.ptp(mesh.points, axis=0).max())
    return np.flatnonzero(np.abs(mesh.points[:, axis] - value) < 1e-9 * size)


def _arc(start: float, end: float, radius: float) -> Any:
    def point(t: float) -> tuple[float, float]:
        phi = np.radians(start + (end - start) * t)
        return radius * np.cos(phi), radius * np.sin(phi)

    return point


def _line(a: tuple[float, float], b: tuple[float, float]) -> Any:
    return lambda t: (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)


def strip_mesh(n: int, cell: Any, width: float = 10.0, height: float = 18.0) -> ct.Mesh:
    """Quarter of a strip with a hole of half its width: `n` cells along each side of the hole.

    Parameters
    ----------
    n : int
        Cells along each eighth of the hole, and from the hole to the sides.
    cell : str
    width, height : float
        Of the quarter [length].
    """
    r, w = 0.5 * width, width
    middle = (r / np.sqrt(2.0), r / np.sqrt(2.0))
    lower = ct.mesh.mapped(
        [_line((r, 0), (w, 0)), _line((w, 0), (w, w)), _line(middle, (w, w)), _arc(0, 45, r)],
        n,
        n,
        cell,
    )
    upper = ct.mesh.mapped(
        [_line(middle, (w, w)), _line((w, w), (0, w)), _line((0, r), (0, w)), _arc(45, 90, r)],
        n,
        n,
        cell,
    )
    rest = ct.mesh.rectangle(
        w, height - w, n, max(1, round(n * (height - w) / w)), cell, origin=(0.0, w)
    )
    return ct.mesh.merge(lower, upper, rest)


def perforated_strip(
    element: str,
    n: int,
    material: Material | None = None,
    pull: float = 0.3,
    local_strain: Any = "linear",
    thickness: float = 0.01,
) -> ct.Model:
    """Quarter strip 10 x 18 with a hole of radius 5, its top moved by `pull`.

    Aluminium with linear hardening (E 70000, nu 0.2, yield stress 243, slope 2240).
    """
    model = ct.Model(strip_mesh(n, CELL[element]))
    material = material or ct.Mises(E=70000.0, nu=0.2, yield_stress=243.0, isotropic=2240.0)
    model.section(
        "all", element=element, material=material, thickness=thickness, local_strain=local_strain
    )
    turn = 0.0 if element in DRILLING else None
    bottom, left, top = (find(model.mesh, a, v) for a, v in ((1, 0.0), (0, 0.0), (1, 18.0)))
    model.fix(bottom, x=None, y=0.0, rotation=turn)
    model.fix(left, x=0.0, y=None, rotation=turn)
    model.fix(top, x=None, y=pull, rotation=turn)
    return model


def cook(
    element: str,
    n: int,
    force: float = 1.8,
    local_strain: Any = "linear",
    material: Material | None = None,
) -> ct.Model:
    """Cook's tapered panel, clamped left, with a shear force on the right (plane stress).

    E 70, nu 1/3, yield stress 0.243, linear hardening 0.135 (kN, mm).
    """
    shape = [(0, 0), (48, 44), (48, 60), (0, 44)]
    model = ct.Model(ct.mesh.mapped(shape, n, n, CELL[element]))
    material = material or ct.Mises(E=70.0, nu=1.0 / 3.0, yield_stress=0.243, isotropic=0.135)
    model.section("all", element=element, material=material, local_strain=local_strain)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.traction("right", y=force / 16.0)
    return model


def cantilever(
    element: str,
    ny: int,
    move: float,
    local_strain: Any = "linear",
    length: float = 10.0,
    aspect: float = 1.0,
) -> ct.Model:
    """Perfectly plastic cantilever `length` x 1, its end moved down by `move`.

    E 1000, nu 0.3, yield stress 1; the limit load of beam theory is ``1 / (4 length)``.
    """
    nx = max(1, round(ny * length / aspect))
    model = ct.Model(ct.mesh.rectangle(length, 1.0, nx, ny, CELL[element]))
    law = ct.Mises(E=1000.0, nu=0.3, yield_stress=1.0)
    model.section("all", element=element, material=law, local_strain=local_strain)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.fix("right", x=None, y=-move)
    return model


def notched(
    element: str,
    n: int,
    pull: float,
    material: Material | None = None,
    mean_dilatation: bool = False,
) -> ct.Model:
    """Quarter of a deep double-notched tension specimen in plane strain, perfectly plastic.

    Half width 10, half ligament 1, half height 15. The limit load is ``(2 + pi) / sqrt(3)`` times
    the yield stress on the ligament (Nagtegaal, Parks & Rice 1974).
    """
    shape = strip_of_notch(n, CELL[element])
    model = ct.Model(shape)
    law = material or ct.Mises(E=206900.0, nu=0.29, yield_stress=450.0)
    model.section(
        "all", element=element, material=law, plane="strain", mean_dilatation=mean_dilatation
    )
    points = model.mesh.points
    turn = 0.0 if element in DRILLING else None
    ligament = np.flatnonzero((np.abs(points[:, 1]) < 1e-9) & (points[:, 0] < 1.0 + 1e-9))
    model.fix(ligament, x=None, y=0.0, rotation=turn)
    model.fix(find(model.mesh, 0, 0.0), x=0.0, y=None, rotation=turn)
    model.fix(find(model.mesh, 1, 15.0), x=None, y=pull, rotation=turn)
    return model


def strip_of_notch(n: int, cell: Any) -> ct.Mesh:
    """Quarter of the notched specimen, graded towards the ligament."""
    near = np.linspace(0.0, 1.0, n + 1)
    grow = 1.0 + np.cumsum(np.geomspace(1.0 / n, 3.0, 2 * n))
    xs = np.concatenate([near, 1.0 + (grow - 1.0) * 9.0 / (grow[-1] - 1.0)])
    ys = np.concatenate([near, 1.0 + (grow - 1.0) * 14.0 / (grow[-1] - 1.0)])
    unit = ct.mesh.rectangle(1.0, 1.0, len(xs) - 1, len(ys) - 1, cell)
    at = np.linspace(0.0, 1.0, len(xs)), np.linspace(0.0, 1.0, len(ys))
    unit.points[:, 0] = np.interp(unit.points[:, 0], at[0], xs)
    unit.points[:, 1] = np.interp(unit.points[:, 1], at[1], ys)
    return unit

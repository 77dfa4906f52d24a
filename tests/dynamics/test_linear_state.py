"""Small motions and buckling about the state of a geometrically linear step.

Its stress acts on the reference shape: the stiffness is ``K0 + K_sigma`` of the linear theory
(Cook, Malkus, Plesha & Witt 2002, chapter 18), however large the displacements are. References:
that sum assembled here, states that are bent without an axial force, and small nonlinear states.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.linalg import eigh

import corota as ct
from benchmarks.studies.preloaded_frequencies import STORED
from support.models import cell
from tests.support.lines import chain
from tests.support.pairs import cover

PLANAR = ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI"]
ELEMENTS = [*PLANAR, "BEAM"]
STRAINS = ["linear", "green_lagrange", "logarithmic"]
EVERY = [(e, s) for e in ELEMENTS for s in STRAINS if (e, s[:2]) in [("BEAM", "li")] or e in PLANAR]


# -- the linear theory, assembled apart ---------------------------------------------------------


class Plate:
    """A steel plate in plane strain, eight nodes, 3 x 3 points [mm, N, t, s].

    Everything from the definitions: ``K0 = int B^T D B``, ``K_sigma = int G sigma G^T I``.
    """

    corners = np.array(
        [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)], float
    )
    thickness, rho = 3.0, 7.8e-9

    def __init__(self) -> None:
        self.mesh = ct.mesh.rectangle(100.0, 10.0, nx=8, ny=2, cell="quad8")
        e, nu = 210000.0, 0.3
        stiff = np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, 0.5 - nu]])
        self.d = e / (1 + nu) / (1 - 2 * nu) * stiff
        self.n = 2 * self.mesh.n_nodes
        x = self.mesh.points[:, 0]
        self.left, self.right = (np.flatnonzero(abs(x - at) < 1e-9) for at in (0.0, 100.0))
        self.k = self.integral(lambda g, *_: self.b(g).T @ self.d @ self.b(g))
        two = np.eye(2)
        self.m = self.integral(lambda g, n, _: self.rho * np.kron(np.outer(n, n), two))

    def shape(self, r: float, s: float) -> tuple[np.ndarray, np.ndarray]:
        """Shape functions and their derivatives, shapes (8,) and (8, 2)."""
        n, d = np.zeros(8), np.zeros((8, 2))
        for a, (p, q) in enumerate(self.corners):
            if a < 4:
                n[a] = 0.25 * (1 + p * r) * (1 + q * s) * (p * r + q * s - 1)
                d[a, 0] = 0.25 * p * (1 + q * s) * (2 * p * r + q * s)
                d[a, 1] = 0.25 * q * (1 + p * r) * (p * r + 2 * q * s)
            elif p == 0:
                n[a] = 0.5 * (1 - r * r) * (1 + q * s)
                d[a] = [-r * (1 + q * s), 0.5 * q * (1 - r * r)]
            else:
                n[a] = 0.5 * (1 - s * s) * (1 + p * r)
                d[a] = [0.5 * p * (1 - s * s), -s * (1 + p * r)]
        return n, d

    @staticmethod
    def b(g: np.ndarray) -> np.ndarray:
        """Strain by nodal displacements, shape (3, 16)."""
        b = np.zeros((3, 16))
        b[0, 0::2] = b[2, 1::2] = g[:, 0]
        b[1, 1::2] = b[2, 0::2] = g[:, 1]
        return b

    def integral(self, what, u: np.ndarray | None = None) -> np.ndarray:
        """Assemble ``what(gradients, shape functions, displacements)``."""
        points, weights = np.polynomial.legendre.leggauss(3)
        total = np.zeros((self.n, self.n))
        for nodes in self.mesh.cells[0].nodes:
            dofs = np.stack([2 * nodes, 2 * nodes + 1], axis=1).ravel()
            own = np.zeros(16) if u is None else u[dofs]
            for r, wr in zip(points, weights, strict=True):
                for s, ws in zip(points, weights, strict=True):
                    n, d = self.shape(r, s)
                    jacobian = d.T @ self.mesh.points[nodes]
                    weight = np.linalg.det(jacobian) * wr * ws * self.thickness
                    g = d @ np.linalg.inv(jacobian).T
                    total[np.ix_(dofs, dofs)] += weight * what(g, n, own)
        return total

    def stress_stiffness(self, u: np.ndarray) -> np.ndarray:
        """Of the linear stress of a displacement."""

        def at(g, _, own):
            s = self.d @ (self.b(g) @ own)
            return np.kron(g @ np.array([[s[0], s[2]], [s[2], s[1]]]) @ g.T, np.eye(2))

        return self.integral(at, u)

    def displaced_stiffness(self, u: np.ndarray) -> np.ndarray:
        """Of the material, with Green-Lagrange strains about a displacement of any size."""

        def at(g, _, own):
            f = np.eye(2) + own.reshape(-1, 2).T @ g
            b = np.zeros((3, 16))
            for i in range(2):
                b[0, i::2], b[1, i::2] = f[i, 0] * g[:, 0], f[i, 1] * g[:, 1]
                b[2, i::2] = f[i, 0] * g[:, 1] + f[i, 1] * g[:, 0]
            return b.T @ self.d @ b

        return self.integral(at, u)

    def state(
        self, x: float = 0.0, y: float = 0.0, move: float | None = None, spin: float = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of the linear theory and free dofs: forces or a move of the end, a spin."""
        held = np.concatenate([2 * self.left, 2 * self.left + 1])
        u, f = np.zeros(self.n), np.zeros(self.n)
        f[2 * self.right], f[2 * self.right + 1] = x / 5.0, y / 5.0
        f += spin**2 * self.m @ (self.mesh.points - [0.0, 5.0]).ravel()
        if move is not None:
            held = np.concatenate([held, 2 * self.right + 1])
            u[2 * self.right + 1] = move
        free = np.setdiff1d(np.arange(self.n), held)
        rest = f - self.k @ u
        u[free] = np.linalg.solve(self.k[np.ix_(free, free)], rest[free])
        return u, free

    def model(self) -> ct.Model:
        model = ct.Model(self.mesh)
        steel = ct.Elastic(E=210000.0, nu=0.3, rho=self.rho)
        model.section(
            "all",
            element="Q8",
            material=steel,
            plane="strain",
            thickness=self.thickness,
            local_strain="green_lagrange",
        )
        model.fix(self.left)
        return model

    def step(
        self, x: float = 0.0, y: float = 0.0, move: float | None = None, spin: float = 0.0
    ) -> ct.Static:
        step = ct.Static(nlgeom=False)
        if spin:
            step.centrifugal(spin, about=(0.0, 5.0))
        self.load(step, x, y)
        if move is not None:
            step.fix(self.right, x=None, y=move)
        return step

    def load(self, step, x: float, y: float) -> None:
        for node in self.right.tolist():
            if x or y:
                step.force([node], x=x / 5.0, y=y / 5.0)


PLATE = Plate()
STATES = {
    "tension": {"x": 2e4},
    "bent by a fifth of its length": {"y": 3e3},
    "bent and pressed": {"x": -1e4, "y": 3e3},
    "end moved across": {"move": 20.0},
    "spinning about the root": {"spin": 4000.0},
}


def frequencies(state: str, stiffness: np.ndarray, free: np.ndarray) -> np.ndarray:
    """The first four, with what spin takes away [Hz]."""
    softer = stiffness - STATES[state].get("spin", 0.0) ** 2 * PLATE.m
    part = np.ix_(free, free)
    squares = eigh(softer[part], PLATE.m[part], eigvals_only=True)[:4]
    return np.sqrt(squares) / (2.0 * np.pi)


@pytest.mark.parametrize("state", STATES)
def test_frequencies_about_a_linear_state(state: str) -> None:
    u, free = PLATE.state(**STATES[state])
    expected = frequencies(state, PLATE.k + PLATE.stress_stiffness(u), free)
    steps = [PLATE.step(**STATES[state]), ct.Frequency(modes=4)]
    results = ct.solve(PLATE.model(), steps, threads=1)
    np.testing.assert_allclose(results.modes[0].factors, expected, rtol=1e-8)
    np.testing.assert_allclose(results.frames[-1].U.ravel(), u, atol=1e-9 * np.abs(u).max())


@pytest.mark.parametrize(
    ("case", "state"),
    [
        ("tension of 20 kN, linear preload", "tension"),
        ("bent by 3 kN across, linear preload", "bent by a fifth of its length"),
        ("one end moved across by 20, linear preload", "end moved across"),
        ("spin of 4000 rad/s, linear preload", "spinning about the root"),
    ],
)
def test_calculix_takes_strains_about_the_linear_displacement(case: str, state: str) -> None:
    """What its ``*FREQUENCY`` adds: parts that turn in the linear theory stretch and stiffen."""
    u, free = PLATE.state(**STATES[state])
    found = frequencies(state, PLATE.displaced_stiffness(u) + PLATE.stress_stiffness(u), free)
    theirs = json.loads(STORED.read_text(encoding="utf-8"))[case]
    np.testing.assert_allclose(found, theirs, rtol=1e-6)


@pytest.mark.parametrize("state", [state for state in STATES if state[:4] != "spin"])
def test_buckling_about_a_linear_state(state: str) -> None:
    """``K0 + K_sigma(state) + factor K_sigma(load)``, all on the reference shape."""
    u, free = PLATE.state(**STATES[state])
    part = np.ix_(free, free)
    base = (PLATE.k + PLATE.stress_stiffness(u))[part]
    # The load meets the stiffness of the state.
    force, added = np.zeros(PLATE.n), np.zeros(PLATE.n)
    force[2 * PLATE.right] = -2e3
    added[free] = np.linalg.solve(base, force[free])
    theta = eigh(-PLATE.stress_stiffness(added)[part], base, eigvals_only=True)
    step = ct.Buckle(modes=2)
    PLATE.load(step, -1e4, 0.0)
    results = ct.solve(PLATE.model(), [PLATE.step(**STATES[state]), step], threads=1)
    np.testing.assert_allclose(results.modes[0].factors, 1.0 / theta[::-1][:2], rtol=1e-6)


# -- every element ------------------------------------------------------------------------------

LENGTH, HEIGHT, YOUNG = 10.0, 0.5, 1e4
EULER = np.pi**2 * YOUNG * HEIGHT**3 / 12.0 / (4.0 * LENGTH**2)


def cantilever(element: str, strain: str) -> tuple[ct.Model, np.ndarray]:
    """A slender cantilever and the nodes of its end."""
    material = ct.Elastic(E=YOUNG, nu=0.0, rho=1.0)
    if element == "BEAM":
        model = ct.Model(chain(12, LENGTH))
        model.beam(list(range(12)), material=material, area=HEIGHT, inertia=HEIGHT**3 / 12.0)
        model.fix([0], x=0.0, y=0.0, rotation=0.0)
        return model, np.array([12])
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, nx=12, ny=2, cell=cell(element)))
    model.section("all", element=element, material=material, local_strain=strain)
    model.fix("left")
    return model, model.mesh.nodes_of("right")


def after(element: str, strain: str, step, x: float = 0.0, y: float = 0.0, nlgeom: bool = False):
    """The first factor of a step after a static one with a force on the end."""
    model, end = cantilever(element, strain)
    before = ct.Static(nlgeom=nlgeom)
    middle = end[[len(end) // 2]] if len(end) % 2 else end[:1]
    before.force(middle, x=x, y=y)
    if step.procedure == "buckle":
        step.force(end[[0, -1]] if len(end) > 1 else end, x=-0.5 if len(end) > 1 else -1.0)
    return ct.solve(model, [before, step], threads=1, fields=False).modes[0].factors[0]


@pytest.mark.parametrize(("element", "strain"), EVERY)
def test_bending_alone_changes_neither_frequency_nor_buckling_load(element, strain):
    """A tip deflection of 0.3 of the length by the linear theory has no axial force."""
    side = 0.3 * 3.0 * YOUNG * HEIGHT**3 / 12.0 / LENGTH**2
    for step in (ct.Frequency, ct.Buckle):
        rest, bent = (after(element, strain, step(modes=1), y=y) for y in (0.0, side))
        assert bent == pytest.approx(rest, rel=2e-3), step.__name__


@pytest.mark.parametrize(("share", "case"), cover([-0.5, 1.0], EVERY, strength=1))
def test_a_small_axial_state_is_that_of_the_nonlinear_theory(share, case):
    """The two differ by the strain, of the state and at buckling (here 5e-4)."""
    element, strain = case
    force = share * EULER
    for step in (ct.Frequency, ct.Buckle):
        found = [after(element, strain, step(modes=1), x=force, nlgeom=on) for on in (False, True)]
        size = EULER if step is ct.Frequency else found[1] + abs(force)
        error = 4.0 * size / (HEIGHT * YOUNG) * (size if step is ct.Buckle else found[1])
        assert abs(found[0] - found[1]) < error, step.__name__
    rest = after(element, strain, ct.Frequency(modes=1))
    assert abs(after(element, strain, ct.Frequency(modes=1), x=force) / rest - 1.0) > 0.03

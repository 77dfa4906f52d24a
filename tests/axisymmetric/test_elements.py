"""Contracts of every element of revolution, over the list of the elements that have this fact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
import corota._core as _core
from corota.model import elements

NAMES = [name for name in elements.names() if elements.find(name).revolved]
STRAINS = ["linear", "logarithmic", "green_lagrange"]
#: Corners of a distorted cell away from the axis, and of one with an edge on the axis.
QUAD = np.array([[1.0, 0.1], [2.1, 0.0], [2.3, 1.2], [0.9, 1.0]])
AT_AXIS = np.array([[0.0, 0.1], [1.1, 0.0], [1.3, 1.2], [0.0, 1.0]])
#: Cells that a stretch along the axes does not turn.
RECTANGLE = np.array([[1.0, 0.1], [2.5, 0.1], [2.5, 1.0], [1.0, 1.0]])
SYMMETRIC = np.array([[1.0, 0.1], [2.5, 0.1], [1.75, 1.0]])
#: A material of each law of the core, and the local strains that it is tried with.
LAWS = {
    "elastic": (ct.Elastic(E=7.0, nu=0.3), STRAINS),
    "orthotropic": (
        ct.Orthotropic(10.0, 4.0, 5.0, 0.2, 0.25, 0.15, 3.0), ["linear", "green_lagrange"]
    ),
    "mises": (
        ct.Mises(E=7.0, nu=0.3, yield_stress=0.05, isotropic=0.4, kinematic=0.8),
        ["linear", "logarithmic"],
    ),
    "ramberg_osgood": (
        ct.RambergOsgood(E=7.0, nu=0.3, yield_stress=0.05, exponent=5.0, offset=0.4),
        ["linear", "logarithmic"],
    ),
    "neo_hooke": (ct.NeoHooke(C10=1.0, D1=0.1), ["logarithmic"]),
    "ogden": (ct.Ogden([1.0], [3.0], [0.1]), ["logarithmic"]),
}  # fmt: skip


def points_of(name: str, corners: np.ndarray) -> np.ndarray:
    """Nodes of an element with straight sides, its middle nodes moved off their places a bit."""
    cell = elements.find(name).cell
    n = 3 if "tri" in cell else 4
    x = corners[:n]
    if cell in ("tri3", "quad4"):
        return x
    middle = 0.5 * (x + np.roll(x, -1, axis=0))
    rows = [x, middle]
    if cell == "quad9":
        rows.append(x.mean(axis=0)[None])
    return np.concatenate(rows)


def problem(
    name: str, law: str, strain: str, corners: np.ndarray = QUAD, mean: bool = False
) -> tuple[_core.Problem, np.ndarray]:
    points = np.ascontiguousarray(points_of(name, corners))
    material = LAWS[law][0]
    block = {
        "element": name, "law": material.law, "parameters": material.parameters(0.4),
        "plane": "axisymmetric", "local_strain": strain, "thickness": 1.0, "rho": 2.0,
        "mean_dilatation": mean, "beta0": None, "nodes": np.arange(len(points), dtype=np.uint32),
    }  # fmt: skip
    return _core.Problem(points, [block], np.zeros(len(points), np.uint8)), points


def respond(core: _core.Problem, u: np.ndarray, nlgeom: bool = True) -> tuple[np.ndarray, ...]:
    """Force and full tangent."""
    n = core.n_dofs
    force, scale, values = np.zeros(n), np.zeros(n), np.zeros(len(core.indices))
    core.assemble(u, nlgeom, force, scale, values)
    matrix = np.zeros((n, n))
    column = np.repeat(np.arange(n), np.diff(core.indptr.astype(np.int64)))
    matrix[core.indices, column] = values
    matrix[column, core.indices] = values
    return force, matrix


def energy(core: _core.Problem, u: np.ndarray) -> float:
    return float(core.recover(u, True)[0]["total_energy"])


def moved(points: np.ndarray, size: float, seed: int = 1) -> np.ndarray:
    """A rotation by half a radian about the middle, a stretch, and a random part."""
    rng = np.random.default_rng(seed)
    c, s = np.cos(0.5), np.sin(0.5)
    middle = points.mean(axis=0)
    turned = (points - middle) @ np.array([[c, s], [-s, c]]) * (1.0 + 0.5 * size) + middle
    turned[:, 0] += 0.1
    return (turned - points + size * rng.standard_normal(points.shape)).ravel()


CASES = [(n, law, strain) for n in NAMES for law, (_, some) in LAWS.items() for strain in some]
#: The law that sections refuse with one point: its hourglass would stay elastic.
CASES = [c for c in CASES if c[:2] != ("Q4R", "ramberg_osgood")]


@pytest.mark.parametrize(("name", "law", "strain"), CASES)
def test_tangent_is_the_derivative_of_the_force(name: str, law: str, strain: str) -> None:
    core, points = problem(name, law, strain)
    u = moved(points, 0.02)
    force, matrix = respond(core, u)
    h = 1e-6
    exact = np.empty_like(matrix)
    for j in range(len(u)):
        ahead, back = u.copy(), u.copy()
        ahead[j] += h
        back[j] -= h
        exact[:, j] = (respond(core, ahead)[0] - respond(core, back)[0]) / (2.0 * h)
    assert np.abs(force).max() > 0.0
    np.testing.assert_allclose(matrix, exact, atol=2e-6 * np.abs(matrix).max())
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * np.abs(matrix).max())


@pytest.mark.parametrize(
    ("name", "law", "strain"), [c for c in CASES if c[1] not in ("mises", "ramberg_osgood")]
)
def test_force_is_the_derivative_of_the_energy(name: str, law: str, strain: str) -> None:
    core, points = problem(name, law, strain)
    u = moved(points, 0.02)
    force, _ = respond(core, u)
    h = 1e-6
    exact = np.empty_like(force)
    for j in range(len(u)):
        ahead, back = u.copy(), u.copy()
        ahead[j] += h
        back[j] -= h
        respond(core, ahead)
        up = energy(core, ahead)
        respond(core, back)
        exact[j] = (up - energy(core, back)) / (2.0 * h)
    np.testing.assert_allclose(force, exact, atol=1e-6 * np.abs(force).max())


@pytest.mark.parametrize("name", ["Q4", "Q8R", "Q9"])
@pytest.mark.parametrize("strain", STRAINS)
def test_mean_dilatation_has_the_force_and_tangent_of_its_energy(name: str, strain: str) -> None:
    core, points = problem(name, "elastic", strain, mean=True)
    u = moved(points, 0.05)
    force, matrix = respond(core, u)
    h = 1e-6
    slope, exact = np.empty_like(force), np.empty_like(matrix)
    for j in range(len(u)):
        ends = []
        for sign in (1.0, -1.0):
            at = u.copy()
            at[j] += sign * h
            ends.append((energy(core, at), respond(core, at)[0]))
        slope[j] = (ends[0][0] - ends[1][0]) / (2.0 * h)
        exact[:, j] = (ends[0][1] - ends[1][1]) / (2.0 * h)
    np.testing.assert_allclose(force, slope, atol=1e-6 * np.abs(force).max())
    np.testing.assert_allclose(matrix, exact, atol=1e-6 * np.abs(matrix).max())


@pytest.mark.parametrize("corners", [QUAD, AT_AXIS], ids=["ring", "at the axis"])
@pytest.mark.parametrize("name", NAMES)
def test_one_rigid_motion_and_no_other(name: str, corners: np.ndarray) -> None:
    """Along the axis. One point alone cannot see a section roll about it, and four points of Q8R
    do not see its hourglass: one more mode, which a mesh of two elements across stiffens."""
    core, points = problem(name, "elastic", "linear", corners)
    _, matrix = respond(core, np.zeros(core.n_dofs), nlgeom=False)
    values, vectors = np.linalg.eigh(matrix)
    n_zero = int((np.abs(values) < 1e-10 * values[-1]).sum())
    along = np.zeros_like(points)
    along[:, 1] = 1.0
    blind = int(name in ("T3", "Q4R", "Q8R"))
    assert n_zero == 1 + blind
    if not blind:
        mode = np.abs(vectors[:, 0].reshape(-1, 2))
        np.testing.assert_allclose(mode[:, 0], 0.0, atol=1e-6)
    force, _ = respond(core, 100.0 * along.ravel())
    assert np.abs(force).max() < 1e-10 * values[-1]


@pytest.mark.parametrize("strain", STRAINS)
@pytest.mark.parametrize("name", NAMES)
def test_uniform_stretch_has_its_closed_form(name: str, strain: str) -> None:
    """Radial and hoop stretch 1.1, axial .95: stress by hand, the energy, and no internal modes."""
    corners = SYMMETRIC[:3] if "tri" in elements.find(name).cell else RECTANGLE
    core, points = problem(name, "elastic", strain, corners)
    a, b = 0.1, -0.05
    u = (points * [a, b]).ravel()
    force, _ = respond(core, u)
    measure = {
        "linear": lambda w: w,
        "logarithmic": np.log1p,
        "green_lagrange": lambda w: w + 0.5 * w * w,
    }[strain]
    e = np.array([measure(a), measure(b), measure(a)])
    young, nu = 7.0, 0.3
    lame, shear = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
    s = lame * e.sum() + 2.0 * shear * e
    own = core.recover(u, True)[0]
    np.testing.assert_allclose(own["values"]["E"][..., :3].reshape(-1, 3) - e, 0.0, atol=1e-12)
    density = 0.5 * float(e @ s)
    np.testing.assert_allclose(own["values"]["ENER"], density, rtol=1e-12)
    # Virtual work of the uniform stress on a uniform motion.
    slope = {
        "linear": lambda w: 1.0,
        "logarithmic": lambda w: 1.0 / (1.0 + w),
        "green_lagrange": lambda w: 1.0 + w,
    }[strain]
    volume = float(np.sum(own["volume"]))
    radial = (s[0] + s[2]) * slope(a) * volume
    assert force @ (points * [1.0, 0.0]).ravel() == pytest.approx(radial, rel=1e-12)
    axial = s[1] * slope(b) * volume
    assert force @ (points * [0.0, 1.0]).ravel() == pytest.approx(axial, rel=1e-12)


def test_elements_that_cannot_be_turned_are_refused_with_the_reason() -> None:
    steel = ct.Elastic(E=1.0, nu=0.3)
    for name in elements.names():
        if name not in NAMES:
            with pytest.raises(ct.InputError, match="drilling"):
                ct.Section("all", name, steel, plane="axisymmetric")
    with pytest.raises(ct.InputError, match="no thickness"):
        ct.Section("all", "Q4", steel, 2.0, plane="axisymmetric")

"""Homogenized constants beside closed forms, mean stress and gradient, what is refused."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from lattices import honeycomb, square, triangular

import corota as ct
from corota.cells import elastic_constants, ellipticity


def layers(slope: float, plane: str, element: str = "Q4") -> ct.Model:
    """Three layers of two materials along x; the cell is a parallelogram."""
    mesh = ct.mesh.mapped([(0, 0), (2, 0), (2 + slope, 1), (slope, 1)], 2, 4)
    model = ct.Model(mesh)
    rows = np.arange(8) // 2
    for which, (modulus, ratio) in enumerate([(1.0, 0.3), (10.0, 0.2)]):
        model.section(
            np.flatnonzero((rows == 2) == which),
            element=element,
            material=ct.Elastic(E=modulus, nu=ratio),
            plane=plane,
            thickness=2.0,
        )
    return model


def laminate(plane: str) -> dict[str, float]:
    """Constants of layers with shares of 3/4 and 1/4 (Backus 1962; Postma 1955)."""
    shares, c = [0.75, 0.25], []
    for modulus, ratio in [(1.0, 0.3), (10.0, 0.2)]:
        if plane == "strain":
            modulus, ratio = modulus / (1.0 - ratio**2), ratio / (1.0 - ratio)
        full = modulus / (1.0 - ratio**2)
        c.append((full, ratio * full, 0.5 * (1.0 - ratio) * full))
    c11, c12, c66 = (np.array(v) for v in zip(*c, strict=True))
    mean = lambda values: float(np.dot(shares, values))  # noqa: E731
    across = 1.0 / mean(1.0 / c11)
    coupled = mean(c12 / c11) * across
    along = mean(c11 - c12**2 / c11) + coupled**2 / across
    return {
        "E1": along - coupled**2 / across,
        "E2": across - coupled**2 / along,
        "G12": 1.0 / mean(1.0 / c66),
        "nu12": coupled / across,
        "nu21": coupled / along,
    }


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("slope", [0.0, 0.7])
def test_layers(plane: str, slope: float) -> None:
    cell = ct.PeriodicCell(layers(slope, plane), [(2.0, 0.0), (slope, 1.0)])
    assert elastic_constants(cell.tangent()) == pytest.approx(laminate(plane), rel=1e-10)


@pytest.mark.parametrize("t", [0.02, 0.2])
def test_lattices(t: float) -> None:
    """Square grid; triangles and hexagons, isotropic, of rigidly joined slender beams.

    Sources: L. J. Gibson, M. F. Ashby, *Cellular Solids* (1997), with the stretching of walls;
    M. Ostoja-Starzewski, Appl. Mech. Rev. 55 (2002) 35-60, triangular lattice.
    """
    k = t**2
    found = elastic_constants(square(t).tangent())
    expected = {"E1": t, "E2": t, "G12": 0.5 * t**3, "nu12": 0.0, "nu21": 0.0}
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * t)
    young, ratio = 4.0 / np.sqrt(3.0) * t**3 / (1.0 + 3.0 * k), (1.0 - k) / (1.0 + 3.0 * k)
    check_isotropic(elastic_constants(honeycomb(t).tangent()), young, ratio)
    ratio = (1.0 - k) / (3.0 + k)
    young = 2.0 * (1.0 - ratio) * np.sqrt(3.0) / 2.0 * t
    check_isotropic(elastic_constants(triangular(t).tangent()), young, ratio)


def check_isotropic(found: dict[str, float], young: float, ratio: float) -> None:
    shear = 0.5 * young / (1.0 + ratio)
    expected = {"E1": young, "E2": young, "G12": shear, "nu12": ratio, "nu21": ratio}
    assert found == pytest.approx(expected, rel=1e-6)


def test_stress_by_gradient_and_by_stress() -> None:
    """Mixed load: the tangent gives what is free; a small load is linear."""
    cell = ct.PeriodicCell(layers(0.0, "stress"))
    tangent = cell.tangent()
    size = 1e-7
    cell.drive([[None, 0.0], [None, size]], [[3.0 * size, 0.0], [-size, 0.0]])
    results = ct.solve(cell.model, ct.Static(), threads=1)
    gradient, stress = cell.gradient(results), cell.stress(results)
    assert stress[0, 0] == pytest.approx(3.0 * size, rel=1e-9)
    assert stress[1, 0] == pytest.approx(-size, rel=1e-9)
    assert gradient[1, 1] == pytest.approx(size, rel=1e-12)
    linear = np.einsum("ijkl,kl", tangent, gradient)
    np.testing.assert_allclose(linear, stress, rtol=1e-5, atol=1e-6 * size)


def test_stress_of_a_uniform_body_at_large_strain() -> None:
    """Neo-Hookean square: P = dW/dF by hand, and the tangent as its derivative."""
    from corota.model.hyperelastic import NeoHooke

    model = ct.Model(ct.mesh.rectangle(1.0, 2.0, nx=2, ny=2, cell="quad8"))
    model.section("all", element="Q8", material=NeoHooke(C10=0.5, D1=0.2), plane="strain")
    cell = ct.PeriodicCell(model)
    gradient = np.array([[0.3, 0.2], [-0.1, -0.25]])

    def energy(h: np.ndarray) -> float:
        f = np.eye(3)
        f[:2, :2] += h
        j = np.linalg.det(f)
        return 0.5 * (j ** (-2.0 / 3.0) * np.sum(f**2) - 3.0) + (j - 1.0) ** 2 / 0.2

    def nominal(h: np.ndarray) -> np.ndarray:
        out, step = np.zeros((2, 2)), 1e-4
        for i in range(2):
            for j in range(2):
                e = np.zeros((2, 2))
                e[i, j] = step
                near, far = energy(h + e) - energy(h - e), energy(h + 2 * e) - energy(h - 2 * e)
                out[i, j] = (8.0 * near - far) / (12.0 * step)
        return out

    cell.drive(gradient.tolist())
    results = ct.solve(cell.model, ct.Static(), threads=1)
    np.testing.assert_allclose(cell.stress(results), nominal(gradient), rtol=1e-8, atol=1e-9)
    tangent, step = cell.tangent(results), 1e-3
    for k in range(2):
        for m in range(2):
            e = np.zeros((2, 2))
            e[k, m] = step
            slope = (nominal(gradient + e) - nominal(gradient - e)) / (2.0 * step)
            np.testing.assert_allclose(tangent[:, :, k, m], slope, rtol=1e-4, atol=1e-5)
    assert ellipticity(tangent)[0] > 0.0


def test_a_turned_cell_has_turned_stress() -> None:
    """A macroscopic rotation carries no stress, also of beams."""
    cell = honeycomb(0.1, 2)
    c, s = np.cos(0.6), np.sin(0.6)
    cell.drive([[c - 1.0, -s], [s, c - 1.0]])
    results = ct.solve(cell.model, ct.Static(), threads=1)
    assert np.abs(cell.stress(results)).max() < 1e-9 * 0.1


def test_several_cells_are_as_stiff_as_one() -> None:
    cell = ct.PeriodicCell(layers(0.7, "stress"), [(2.0, 0.0), (0.7, 1.0)])
    several = cell.repeat(2, 3)
    assert several.area == pytest.approx(6.0 * cell.area)
    np.testing.assert_allclose(several.tangent(), cell.tangent(), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(
        honeycomb(0.1).repeat(3, 2).tangent(), honeycomb(0.1).tangent(), rtol=1e-7, atol=1e-9
    )


def test_what_is_refused() -> None:
    model = layers(0.0, "stress")
    other = model.copy()
    other.sections[0].thickness = 1.0
    with pytest.raises(ct.InputError, match="several thicknesses"):
        ct.PeriodicCell(other)
    held = model.copy()
    held.fix("left")
    with pytest.raises(ct.InputError, match="no supports"):
        ct.PeriodicCell(held)
    with pytest.raises(ct.InputError, match="span no area"):
        ct.PeriodicCell(model, [(1.0, 0.0), (2.0, 0.0)])
    with pytest.raises(ct.InputError, match="do not touch"):
        ct.PeriodicCell(model, [(2.0, 0.0), (0.0, 1.5)])
    moved = model.copy()
    moved.mesh.points[5, 1] += 0.02  # on the right side
    with pytest.raises(ct.InputError, match="no partner on the opposite side"):
        ct.PeriodicCell(moved)
    cell = ct.PeriodicCell(model)
    with pytest.raises(ct.InputError, match="could rotate"):
        cell.drive([[0.1, None], [None, None]])
    with pytest.raises(ct.InputError, match="both a gradient and a stress"):
        cell.drive([[0.1, 0.0], [0.0, None]], [[1.0, 0.0], [0.0, 0.0]])


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_closed_contact_within_a_cell(friction: float) -> None:
    """Blocks pressed on each other: the solid's tangent; without friction they slide freely."""
    low = ct.mesh.rectangle(1.0, 0.5, nx=3, ny=2)
    up = ct.mesh.move(low, (0.0, 0.5))
    law = ct.Elastic(E=1.0, nu=0.3)
    solid = ct.Model(ct.mesh.merge(low, up))
    solid.section("all", element="Q4", material=law)
    expected = elastic_constants(ct.PeriodicCell(solid).tangent())
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element="Q4", material=law)
    model.contact("low.top", "up.bottom", friction=friction)
    cell = ct.PeriodicCell(model)
    cell.drive([[0.0, 0.0], [0.0, -0.01]])
    results = ct.solve(cell.model, ct.Static(nlgeom=False), threads=1)
    found = elastic_constants(cell.tangent(results) + 1e-12 * np.eye(4).reshape(2, 2, 2, 2))
    if not friction:
        assert abs(found["G12"]) < 1e-9
        found["G12"] = expected["G12"]
    assert found == pytest.approx(expected, rel=1e-6)
    waves = cell.waves(results)
    slides = waves.least_stiffness((0.0, 0.5))
    assert slides < 1e-6 if not friction else slides > 0.1


def test_two_nodes_at_one_place_of_the_border_are_refused() -> None:
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2)
    cells = ct.mesh.Cells("quad4", mesh.cells[0].nodes, mesh.cells[0].labels)
    points = np.concatenate([mesh.points, mesh.points[[3]]])
    cells.nodes = cells.nodes.copy()
    cells.nodes[2] = np.where(cells.nodes[2] == 3, 9, cells.nodes[2])
    model = ct.Model(ct.mesh.Mesh(points, [cells]))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0, nu=0.3))
    with pytest.raises(ct.InputError, match="another node is at the place"):
        ct.PeriodicCell(model)

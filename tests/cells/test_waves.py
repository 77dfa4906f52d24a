"""Dispersion and Bloch stability beside closed forms, and beside several cells."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from lattices import honeycomb, square

import corota as ct


def uniform(n: int = 1, element: str = "Q4") -> ct.PeriodicCell:
    model = ct.Model(ct.mesh.rectangle(0.5 * n, 0.5 * n, nx=n, ny=n))
    model.section("all", element=element, material=ct.Elastic(E=2.0, nu=0.0, rho=3.0))
    return ct.PeriodicCell(model)


def test_dispersion_of_linear_elements() -> None:
    """Waves along x: w^2 = c^2 (6 / h^2) (1 - cos kh) / (2 + cos kh), c^2 = G / rho and E / rho."""
    shares = np.array([[0.0, 0.0], [0.1, 0.0], [0.37, 0.0], [0.5, 0.0]])
    phase = 2.0 * np.pi * shares[:, 0]
    shape = np.sqrt(24.0 * (1.0 - np.cos(phase)) / (2.0 + np.cos(phase))) / (2.0 * np.pi)
    expected = shape[:, None] * np.sqrt([1.0 / 3.0, 2.0 / 3.0])
    found = uniform().waves().frequencies(shares, 2)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-7)


def test_several_cells_fold_the_waves_of_one() -> None:
    """Of 2 x 2 cells at k: the waves of one at k/2 and k/2 + 1/2."""
    one, four = uniform(1), uniform(2)
    k = np.array([0.2, 0.34])
    parts = 0.5 * (k + np.array([[0, 0], [0, 1], [1, 0], [1, 1]]))
    expected = np.sort(one.waves().frequencies(parts, 2).ravel())
    np.testing.assert_allclose(four.waves().frequencies([k], 8)[0], expected, rtol=1e-9)
    cell = honeycomb(0.1, 2)
    parts = 0.5 * (k + np.array([[0, 0], [0, 1], [1, 0], [1, 1]]))
    expected = np.sort(cell.waves().frequencies(parts, 12).ravel())[:12]
    found = cell.repeat(2, 2).waves().frequencies([k], 12)[0]
    np.testing.assert_allclose(found, expected, rtol=1e-7)


def test_long_waves_have_the_speed_of_the_homogenized_body() -> None:
    """Speed of sound from the tangent, of a lattice of beams."""
    cell = honeycomb(0.1)
    tangent = cell.tangent()
    density = 0.3 / cell.area
    share = 1e-3
    k = share * np.linalg.inv(cell.vectors)[:, 0]  # phases 2 pi (share, 0)
    length = 2.0 * np.pi * np.hypot(*k)
    normal = k / np.hypot(*k)
    acoustic = np.einsum("j,ijkl,l", normal, tangent, normal)
    speeds = np.sqrt(np.linalg.eigvalsh(acoustic) / density)
    found = 2.0 * np.pi * cell.waves().frequencies([[share, 0.0]], 2)[0] / length
    np.testing.assert_allclose(found, speeds, rtol=1e-4)


def pattern(cell: ct.PeriodicCell, gradient: list, wave: tuple[float, float]) -> ct.cells.Onset:
    cell.drive(gradient)
    step = ct.Static(first_increment=0.2, largest_increment=0.2)
    return cell.onset(ct.solve(cell.model, step, threads=1), [wave])


@pytest.mark.parametrize(("lateral", "exact"), [(0.0, 2.0 * 2.0287578), (-1.0, np.pi)])
def test_buckling_of_a_square_grid(lateral: float, exact: float) -> None:
    """Joints turn in alternation: u / tan(u / 2) = -2 with transverse beams that carry no load,
    u = pi with equal loads both ways; P = u^2 EI."""
    t, loads = 1e-3, []
    for n in (8, 16):
        strain = 1.5 * exact**2 * t**2 / 12.0
        found = pattern(square(t, n), [[lateral * strain, 0.0], [0.0, -strain]], (0.5, 0.5))
        loads.append(found.time * strain * t / (t**3 / 12.0))
    extrapolated = (4.0 * loads[1] - loads[0]) / 3.0
    assert extrapolated == pytest.approx(exact**2, rel=2e-4)


def test_buckling_of_a_honeycomb() -> None:
    """Regular hexagons pressed along a wall: 0.22 E (t/l)^3 (Gibson & Ashby 1997, eq. 4.20)."""
    t = 0.01
    cell = honeycomb(t, 8)
    young = 4.0 / np.sqrt(3.0) * t**3
    strain = 0.3 * t**3 / young
    cell.drive([[None, 0.0], [0.0, -strain]])
    step = ct.Static(first_increment=0.1, largest_increment=0.1)
    results = ct.solve(cell.model, step, threads=1)
    found = cell.onset(results, 2)
    stresses = [-cell.stress(results, k)[1, 1] for k in range(len(results.frames))]
    stress = np.interp(found.time, [f.step_time for f in results.frames], stresses)
    assert stress / t**3 == pytest.approx(0.22, abs=0.01)


def test_what_is_refused() -> None:
    cell = uniform()
    with pytest.raises(ct.InputError, match="two shares"):
        cell.waves().negative((0.5, 0.5, 0.5))
    with pytest.raises(ct.InputError, match="waves of a vector"):
        cell.waves().frequencies([[0.1, 0.0]], 3)
    cell.drive([[0.01, 0.0], [0.0, 0.0]])
    results = ct.solve(cell.model, ct.Static(), threads=1)
    with pytest.raises(ct.InputError, match="none of the"):
        cell.onset(results, 2)
    with pytest.raises(ct.InputError, match="another model"):
        uniform(2).waves(results)

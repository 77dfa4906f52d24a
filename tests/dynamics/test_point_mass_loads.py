"""Gravity, spin and Coriolis forces of point masses, and of sets that name them in decks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells

STIFFNESS = 25.0
MASS = 1.0


def mass_on_springs() -> ct.Model:
    """Mass 1 at the origin on springs of 25 along x and y to the ground."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    cells = [
        Cells("line2", np.array([[1, 2]]), np.array([1])),
        Cells("point1", np.array([[0], [0]]), np.array([2, 3])),
    ]
    model = ct.Model(Mesh(points, cells, np.array([1, 2, 3])))
    model.truss([0], material=ct.Elastic(E=1.0, rho=1.0), area=1.0)
    model.spring([1], STIFFNESS, "x")
    model.spring([2], STIFFNESS, "y")
    model.point_mass([0], MASS)
    model.fix([1])
    model.fix([2])
    return model


@pytest.mark.parametrize("spin", [1.0, 3.0])
def test_frequencies_in_a_rotating_frame(spin: float) -> None:
    """A mass on springs k in a frame that turns: w0 - spin and w0 + spin, w0 = sqrt(k / m)."""
    model = mass_on_springs()
    model.centrifugal(spin)
    steps = [ct.Static(), ct.Frequency(modes=2, complex_modes=True)]
    found = np.sort(ct.solve(model, steps, fields=False).modes[-1].factors) * 2.0 * np.pi
    np.testing.assert_allclose(found, [5.0 - spin, 5.0 + spin], rtol=1e-9)


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_response_in_a_rotating_frame(direct: bool) -> None:
    """Coriolis forces couple x and y: (k - m s^2 - m w^2) x - 2i w m s y = f, and for y."""
    spin, frequency = 2.0, 0.3
    model = mass_on_springs()
    model.centrifugal(spin)
    answer = ct.SteadyState(lowest=frequency, highest=0.31, points=2, direct=direct)
    answer.force([0], x=1.0)
    steps = [ct.Static(), ct.Frequency(modes=2), answer]
    frames = [f for f in ct.solve(model, steps, fields=False).frames if f.step == 3]
    w = 2.0 * np.pi * frequency
    k = STIFFNESS - MASS * (spin**2 + w**2)
    c = 2j * w * spin * MASS
    x, y = np.linalg.solve(np.array([[k, -c], [c, k]]), [1.0, 0.0])
    first = next(f for f in frames if np.isclose(f.scalars["frequency"], frequency))
    size = max(abs(x), abs(y))
    assert first.scalars["largest amplitude"] == pytest.approx(size, rel=1e-6)
    assert first.U[0] == pytest.approx([x.real, y.real], rel=1e-6, abs=1e-9)


def test_transient_response_names_the_missing_coriolis_force() -> None:
    model = mass_on_springs()
    model.centrifugal(1.0)
    model.velocity([0], x=0.1)
    with pytest.warns(UserWarning, match="without Coriolis forces"):
        ct.solve(model, ct.Dynamic(period=0.1, increments=2), fields=False)


@pytest.mark.parametrize("nlgeom", [False, True])
def test_gravity_and_spin_at_the_moved_position(nlgeom: bool) -> None:
    """k u = m g; with large displacements k u = m s^2 (x + u), otherwise m s^2 x."""
    model = mass_on_springs()
    model.gravity(x=2.0, y=-1.0)
    step = ct.Static(nlgeom=nlgeom)
    u = ct.solve(model, step).frames[-1].U[0]
    np.testing.assert_allclose(u, [2.0 / STIFFNESS, -1.0 / STIFFNESS], rtol=1e-12)
    model = mass_on_springs()
    model.centrifugal(2.0, about=(-1.0, 0.0))
    u = ct.solve(model, ct.Static(nlgeom=nlgeom)).frames[-1].U[0]
    exact = 4.0 / (STIFFNESS - 4.0 * nlgeom)
    np.testing.assert_allclose(u, [exact, 0.0], rtol=1e-9, atol=1e-12)


DECK = """*NODE, NSET=NALL
1,0,0
2,1,0
3,1,1
4,0,1
*ELEMENT, TYPE=CPS4, ELSET=EA
1,1,2,3,4
*ELEMENT, TYPE=MASS, ELSET=MS
11,3
*ELSET, ELSET=WITH
EA, {member}
*MATERIAL, NAME=M
*ELASTIC
1000.,0.
*DENSITY
1.
*SOLID SECTION, ELSET=EA, MATERIAL=M
1.
*MASS, ELSET=MS
2.
*BOUNDARY
1,1,2
4,1
2,2
*STEP
*STATIC
*DLOAD
{set}, {load}
*END STEP
"""
GRAVITY, SPIN = "GRAV, 1., 1., 0., 0.", "CENTRIF, 1., 0., 0., 0., 0., 0., 1."


@pytest.mark.parametrize(
    ("name", "load", "expected"),
    [
        ("WITH", GRAVITY, (3.0, 0.0)),
        ("EA", GRAVITY, (1.0, 0.0)),
        ("MS", GRAVITY, (2.0, 0.0)),
        ("11", GRAVITY, (2.0, 0.0)),
        ("", GRAVITY, (3.0, 0.0)),
        ("WITH", SPIN, (2.5, 2.5)),
        ("EA", SPIN, (0.5, 0.5)),
        ("MS", SPIN, (2.0, 2.0)),
    ],
)
@pytest.mark.parametrize("member", ["MS", "11"])
def test_decks_load_the_masses_of_their_sets(
    name: str, load: str, expected: Any, member: str, tmp_path: Path
) -> None:
    """The block has mass 1, the corner 2 more; CalculiX 2.20 has the same supports' reactions."""
    deck, again = tmp_path / "deck.inp", tmp_path / "again.inp"
    deck.write_text(DECK.format(set=name, load=load, member=member))
    ct.write(ct.read(deck), again)
    for path in (deck, again):
        frame = ct.solve(ct.read(path), threads=1).frames[-1]
        np.testing.assert_allclose(frame.F.sum(axis=0)[:2], expected, atol=1e-12)

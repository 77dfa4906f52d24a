"""Stresses of beams in the ``.dat`` file: at the outer fibers of both ends."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

WIDTH, DEPTH, LENGTH, FORCE, PULL = 40.0, 100.0, 2000.0, 1e4, 3e4
DECK = """*NODE, NSET=ALL
1, 0., 0.
2, {x}, {y}
*ELEMENT, TYPE=B31, ELSET=EALL
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
210000., 0.
*BEAM SECTION, SECTION={section}, ELSET=EALL, MATERIAL=M
{sizes}
0, 0, 1
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*CLOAD
2, 1, {fx}
2, 2, {fy}
*EL PRINT, ELSET=EALL
S
*END STEP
"""


@pytest.mark.parametrize(
    ("section", "sizes", "area", "inertia"),
    [
        ("RECT", f"{WIDTH}, {DEPTH}", WIDTH * DEPTH, WIDTH * DEPTH**3 / 12.0),
        ("CIRC", "100., 100.", np.pi * 2500.0, np.pi * 100.0**4 / 64.0),
        ("PIPE", "50., 5.", np.pi * (2500.0 - 2025.0), np.pi * (50.0**4 - 45.0**4) / 4.0),
    ],
)
@pytest.mark.parametrize("angle", [0.0, 0.5 * np.pi, 0.7])
def test_outer_fibers(
    section: str, sizes: str, area: float, inertia: float, angle: float, tmp_path: Path
) -> None:
    """N / A and M c / I: the side away from the force is pulled at the clamp, the tip has none."""
    c, s = np.cos(angle), np.sin(angle)
    force = PULL * np.array([c, s]) + FORCE * np.array([-s, c])
    text = DECK.format(
        x=LENGTH * c, y=LENGTH * s, section=section, sizes=sizes, fx=force[0], fy=force[1]
    )
    deck = tmp_path / "deck.inp"
    deck.write_text(text)
    ct.solve(ct.read(deck), observers=[ct.JobFiles(tmp_path, name="job")], threads=1)
    table = (tmp_path / "job.dat").read_text().split("stresses")[-1].splitlines()[1:]
    rows = np.array([[float(v) for v in line.split()] for line in table if line.strip()])
    assert rows[:, 1].tolist() == [1, 2, 3, 4]
    axial, bending = PULL / area, FORCE * LENGTH * 50.0 / inertia
    # The force points to the left of the beam: its right side is pulled.
    exact = np.array([axial + bending, axial - bending, axial, axial])
    np.testing.assert_allclose(rows[:, 2], exact * c * c, rtol=1e-6, atol=1e-6 * bending)
    np.testing.assert_allclose(rows[:, 3], exact * s * s, rtol=1e-6, atol=1e-6 * bending)
    np.testing.assert_allclose(rows[:, 5], exact * c * s, rtol=1e-6, atol=1e-6 * bending)

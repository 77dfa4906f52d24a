"""Rubber without compressibility in decks: what its dialect takes, beside closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct

SQUARE = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=RUBBER
{material}*SOLID SECTION, ELSET=E, MATERIAL=RUBBER
1.
*BOUNDARY
1, 1, 2
4, 1
2, 2
*STEP, NLGEOM
*STATIC
.1, 1.
*BOUNDARY
2, 1, 1, .5
3, 1, 1, .5
*END STEP
"""
NEO_HOOKE = "*HYPERELASTIC, NEO HOOKE\n.5, 0.\n"


def read(path: Path, text: str) -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(text)
    return ct.read(deck)


def pull(path: Path, type_: str, material: str = NEO_HOOKE) -> float:
    model = read(path, SQUARE.format(type=type_, material=material))
    return float(ct.solve(model, threads=1).frames[-1].RF[1:3, 0].sum())


@pytest.mark.parametrize("type_", ["CPE4H", "CPE4RH", "CPE4IH"])
@pytest.mark.parametrize(
    "material",
    [
        NEO_HOOKE,
        "*HYPERELASTIC, OGDEN, N=2\n.5, 2., .5, 2., 0., 0.\n",
        "*HYPERELASTIC, N=2\n.5, 0., 0., 0., 0., 0., 0.\n",
        "*HYPERELASTIC, NEO HOOKE\n.5, 0.\n*MULLINS EFFECT\n2., .1\n",
    ],
)
def test_hybrid_elements_keep_the_volume(tmp_path: Path, type_: str, material: str) -> None:
    """Plane strain tension: F = mu (s - s^-3) at a stretch s."""
    exact = 1.5 - 1.5**-3
    assert pull(tmp_path, type_, material) == pytest.approx(exact, rel=2e-4)


@pytest.mark.parametrize(("type_", "force"), [("CPE4", 1.154350), ("CPS4", 1.0273304)])
def test_calculix_takes_a_bulk_modulus_of_20_times_the_shear_modulus(
    tmp_path: Path, type_: str, force: float
) -> None:
    """Forces of CalculiX 2.20."""
    assert pull(tmp_path, type_) == pytest.approx(force, rel=1e-6)


def test_plane_stress_of_abaqus_keeps_the_volume(tmp_path: Path) -> None:
    assert pull(tmp_path, "CPS4I") == pytest.approx(1.5 - 1.5**-2, rel=1e-9)


def test_elements_of_abaqus_that_are_not_hybrid_need_a_compressibility(tmp_path: Path) -> None:
    text = SQUARE.format(type="CPE4", material=NEO_HOOKE)
    with pytest.raises(ct.DeckError, match="D1 = 2 / K"):
        read(tmp_path, "*PREPRINT, ECHO=NO\n" + text)


def test_a_tube_of_hybrid_elements(tmp_path: Path) -> None:
    """Pressure that widens the inner radius from 1 to 1.5, of constant volume (radii 1, 2)."""
    n_r, n_t, inner = 3, 5, 1.5
    r = np.linspace(inner, math.sqrt(4.0 + inner**2 - 1.0), 2001)
    ratio = r**2 / (r**2 - inner**2 + 1.0)
    pressure = np.trapezoid((ratio - 1.0 / ratio) / r, r)
    radii, turns = np.linspace(1.0, 2.0, 2 * n_r + 1), np.linspace(0.0, np.pi / 2, 2 * n_t + 1)
    text, width = "*NODE\n", len(turns)
    for i, radius in enumerate(radii):
        for j, turn in enumerate(turns):
            x, y = radius * np.cos(turn), radius * np.sin(turn)
            text += f"{i * width + j + 1}, {x:.12g}, {y:.12g}\n"
    text += "*ELEMENT, TYPE=CPE8RH, ELSET=E\n"
    ways = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    for i in range(n_r):
        for j in range(n_t):
            nodes = [(2 * i + a) * width + 2 * j + b + 1 for a, b in ways]
            text += f"{i * n_t + j + 1}, {', '.join(map(str, nodes))}\n"
    ends = [[str(i * width + j + 1) for i in range(len(radii))] for j in (0, width - 1)]
    text += "*NSET, NSET=Y\n" + "\n".join(ends[0]) + "\n*NSET, NSET=X\n" + "\n".join(ends[1])
    text += f"\n*MATERIAL, NAME=M\n{NEO_HOOKE}*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"
    text += "*BOUNDARY\nX, 1\nY, 2\n*SURFACE, NAME=IN\n"
    text += "".join(f"{j + 1}, S4\n" for j in range(n_t))
    text += f"*STEP, NLGEOM\n*STATIC\n1., 1.\n*DSLOAD\nIN, P, {pressure:.12g}\n*END STEP\n"
    results = ct.solve(read(tmp_path, text), threads=1)
    assert results.frames[-1].U[0, 0] == pytest.approx(0.5, rel=2e-3)


def test_a_poissons_ratio_of_one_half_in_decks_of_abaqus(tmp_path: Path) -> None:
    """Plane strain tension: E / (1 - nu^2) = 4 E / 3."""
    text = SQUARE.format(type="CPE4H", material="*ELASTIC\n300., .5\n").replace(", NLGEOM", "")
    model = read(tmp_path, text)
    assert "0.5 is taken as" in str(model.notes)
    assert ct.solve(model, threads=1).frames[-1].RF[1:3, 0].sum() == pytest.approx(200.0, rel=1e-3)
    with pytest.raises(ct.DeckError, match="outside -1 < nu"):
        read(tmp_path, text.replace("CPE4H", "CPE4"))

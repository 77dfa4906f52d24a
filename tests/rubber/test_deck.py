"""Cards of hyperelastic laws: read, written, read again; the same decks by CalculiX."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from tests.support.calculix import needs_ccx, run_ccx

CARDS = {
    "*HYPERELASTIC, NEO HOOKE\n0.5, 0.02\n": ct.NeoHooke(C10=0.5, D1=0.02),
    "*HYPERELASTIC, MOONEY-RIVLIN\n0.4, 0.1, 0.02\n": ct.MooneyRivlin(C10=0.4, C01=0.1, D1=0.02),
    "*HYPERELASTIC, YEOH\n0.5, -0.01, 0.002, 0.02, 0.1, 0.3\n": ct.Yeoh(
        C10=0.5, C20=-0.01, C30=0.002, D1=0.02, D2=0.1, D3=0.3
    ),
    "*HYPERELASTIC, N=2\n0.4, 0.1, 0.01, 0.002, 0.003, 0.02, 0.1\n": ct.Polynomial(
        C10=0.4, C01=0.1, C20=0.01, C11=0.002, C02=0.003, D1=0.02, D2=0.1
    ),
    "*HYPERELASTIC, POLYNOMIAL, N=3\n.4, .1, .01, .002, .003, .004, .005, .006\n"
    ".007, .02, .1, .2\n": ct.Polynomial(
        0.4, 0.1, 0.01, 0.002, 0.003, 0.004, 0.005, 0.006, 0.007, 0.02, 0.1, 0.2
    ),
    "*HYPERELASTIC, REDUCED POLYNOMIAL, N=2\n0.4, 0.01, 0.02, 0.1\n": ct.Polynomial(
        C10=0.4, C20=0.01, D1=0.02, D2=0.1
    ),
    "*HYPERELASTIC, OGDEN, N=2\n0.5, 1.5, 0.1, -2., 0.02, 0.1\n": ct.Ogden(
        mu=(0.5, 0.1), alpha=(1.5, -2.0), D=(0.02, 0.1)
    ),
    "*HYPERELASTIC, ARRUDA-BOYCE\n1., 3., 0.02\n": ct.ArrudaBoyce(mu=1.0, limit=3.0, D=0.02),
    "*HYPERFOAM, N=2\n0.5, 4., 0.1, -2., 0.1, 0.3\n": ct.Hyperfoam(
        mu=(0.5, 0.1), alpha=(4.0, -2.0), nu=(0.1, 0.3)
    ),
}


def deck(card: str, element: str = "CPE8R", load: str = "top, 1, 2, 0.4") -> str:
    """A block of 4 x 4 cells whose top is moved aside and up."""
    kind = "quad8" if "8" in element else "quad4"
    mesh = ct.mesh.rectangle(1.0, 1.0, 4, 4, kind)
    text = "*NODE, NSET=all\n"
    text += "".join(f"{n + 1}, {x:.10g}, {y:.10g}, 0.\n" for n, (x, y) in enumerate(mesh.points))
    text += f"*ELEMENT, TYPE={element}, ELSET=body\n"
    for n, nodes in enumerate(mesh.cells[0].nodes):
        text += ", ".join(str(v) for v in (n + 1, *(nodes + 1))) + "\n"
    for name in ("bottom", "top"):
        text += f"*NSET, NSET={name}\n"
        text += "".join(f"{v + 1},\n" for v in mesh.nodes_of(name))
    text += f"*MATERIAL, NAME=rubber\n{card}*SOLID SECTION, ELSET=body, MATERIAL=rubber\n1.\n"
    text += (
        f"*BOUNDARY\nbottom, 1, 2\n*STEP, NLGEOM, INC=200\n*STATIC\n0.1, 1.\n*BOUNDARY\n{load}\n"
    )
    return text + "*NODE PRINT, NSET=all\nU\n*NODE PRINT, NSET=top\nRF\n*END STEP\n"


@pytest.mark.parametrize("card", CARDS, ids=lambda card: re.sub(r"\n.*", "", card, flags=re.S))
def test_round_trip(card: str, tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    path.write_text(deck(card))
    model = ct.read(path)
    law = model.sections[0].material
    assert law.parameters() == CARDS[card].parameters()
    assert model.sections[0].local_strain == "logarithmic"
    again = tmp_path / "b.inp"
    ct.write(model, again)
    assert ct.read(again).sections[0].material.parameters() == law.parameters()


def test_data_of_tests(tmp_path: Path) -> None:
    known = ct.Ogden(mu=0.6, alpha=2.4)
    text = "*HYPERELASTIC, OGDEN, N=1, TEST DATA INPUT, POISSON=0.495\n"
    for test in ("uniaxial", "biaxial", "planar"):
        text += f"*{test.upper()} TEST DATA\n"
        for strain in (0.1, 0.3, 0.8):
            text += f"{known.nominal(test, [1 + strain])[0]:.12g}, {strain}\n"
    path = tmp_path / "a.inp"
    path.write_text(deck(text))
    law = ct.read(path).sections[0].material
    assert isinstance(law, ct.Ogden)
    assert law.mu == pytest.approx((0.6,), rel=1e-6)
    assert law.alpha == pytest.approx((2.4,), rel=1e-6)
    ratio = 1.5 * law.bulk_modulus / law.shear_modulus
    assert (ratio - 1.0) / (2.0 * ratio + 1.0) == pytest.approx(0.495)


@pytest.mark.parametrize(
    ("card", "text"),
    [
        ("*HYPERELASTIC, NEO HOOKE\n-0.5, 0.1\n", "shear modulus -1 must be > 0"),
        ("*HYPERELASTIC, YEOH, OGDEN\n0.5, 0.1\n", "are both given"),
        ("*HYPERELASTIC, OGDEN, N=7\n0.5, 0.1\n", "at most 6 terms, not 7"),
        ("*HYPERELASTIC, NEO HOOKE, TEST DATA INPUT\n", "a fit needs test data"),
        ("*HYPERELASTIC, NEO HOOKE, POISSON=0.4\n0.5, 0.1\n", "goes with TEST DATA INPUT"),
        (
            "*HYPERELASTIC, NEO HOOKE\n0.5, 0.1\n*UNIAXIAL TEST DATA\n1., 1.\n",
            "belong below",
        ),
        ("*HYPERELASTIC, MOONEY-RIVLIN\n0.5\n", "C01 is missing"),
    ],
)
def test_refuses(card: str, text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    path.write_text(deck(card))
    with pytest.raises(ct.CorotaError, match=text):
        ct.read(path)


def displacements(text: str) -> np.ndarray:
    """Last table of displacements of a ``.dat`` file, by node."""
    tables = re.split(r"\n\s*displacements[^\n]*\n", text)
    rows = re.findall(r"^\s*(\d+)\s+(\S+)\s+(\S+)\s+\S+\s*$", tables[-1].split("forces")[0], re.M)
    return np.array([[float(x), float(y)] for _, x, y in rows])


@needs_ccx
@pytest.mark.parametrize("load", ["top, 1, 1, 0.8", "top, 1, 2, 0.4", "top, 2, 2, -0.3"])
@pytest.mark.parametrize(
    "card",
    [card for card in CARDS if "N=3" not in card],
    ids=lambda card: re.sub(r"\n.*", "", card, flags=re.S),
)
def test_beside_calculix(card: str, load: str, tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    path.write_text(deck(card, load=load))
    run_ccx(tmp_path, "a")
    theirs = displacements((tmp_path / "a.dat").read_text())
    ours = ct.solve(ct.read(path), threads=1).frames[-1].U
    assert np.abs(ours[: len(theirs), :2] - theirs).max() < 2e-4

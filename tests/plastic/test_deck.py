"""Plastic cards of decks: what they mean, and what is refused where."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

HEAD = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=ALL
1, 1, 2, 3, 4
*MATERIAL, NAME=STEEL
*ELASTIC
200000., .3
"""
TAIL = "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n1.\n"
#: Line of the first card below the head.
LINE = HEAD.count("\n") + 1


def read(cards: str, tmp_path: Path, head: str = "") -> ct.Model:
    path = tmp_path / "job.inp"
    path.write_text(head + HEAD + cards + TAIL, encoding="utf-8")
    return ct.read(path)


GOOD = [
    ("*PLASTIC\n250., 0.\n300., .1\n", {"yield_curve": [(250.0, 0.0), (300.0, 0.1)]}),
    ("*PLASTIC\n250.\n", {"yield_curve": [(250.0, 0.0)]}),
    ("*PLASTIC, HARDENING=ISOTROPIC\n250., 0., 20.\n", {"yield_curve": [(250.0, 0.0)]}),
    (
        "*PLASTIC, HARDENING=KINEMATIC\n250., 0.\n300., .1\n",
        {"yield_curve": [(250.0, 0.0)], "chaboche": [(500.0, 0.0)]},
    ),
    (
        "*PLASTIC, HARDENING=COMBINED\n250., 0.\n300., .1\n*CYCLIC HARDENING\n250., 0.\n280., .2\n",
        {"yield_curve": [(250.0, 0.0), (280.0, 0.2)], "chaboche": [(500.0, 0.0)]},
    ),
    (
        "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, NUMBER BACKSTRESSES=2\n"
        "250., 60000., 400., 3000., 5.\n*CYCLIC HARDENING, PARAMETERS\n250., 90., 12.\n",
        {
            "yield_stress": 250.0,
            "isotropic": ct.Voce(90.0, 12.0),
            "chaboche": [(60000.0, 400.0), (3000.0, 5.0)],
        },
    ),
]


CYCLIC = [
    "*CYCLIC HARDENING\n250., 0.\n280., .06\n300., .2\n",
    "*CYCLIC HARDENING, PARAMETERS\n250., 40., 9.\n",
]


@pytest.mark.parametrize("cyclic", CYCLIC)
def test_a_half_cycle_is_that_of_the_program_of_the_deck(cyclic: str, tmp_path: Path) -> None:
    """Abaqus: stress of the test, 400 at .1. CalculiX: without the growth of the yield surface.

    Abaqus Analysis User's Guide, nonlinear isotropic/kinematic hardening: the back-stress at a
    point of the test is its stress less the size of the yield surface there.
    """
    plastic = "*PLASTIC, HARDENING=COMBINED\n250., 0.\n400., .1\n" + cyclic
    size = 280.0 + 20.0 * 0.04 / 0.14 if "PARAM" not in cyclic else 290.0 - 40.0 * np.exp(-0.9)
    for head, stress in (("** DIALECT: abaqus\n", 400.0), ("", 150.0 + size)):
        law = read(plastic, tmp_path, head).sections[0].material
        assert isinstance(law, ct.Mises)
        ((modulus, recall),) = law.back_stresses
        assert recall == 0.0
        assert size + 0.1 * modulus == pytest.approx(stress, rel=1e-12)


@pytest.mark.parametrize(("cards", "wanted"), GOOD)
def test_reads(cards: str, wanted: dict, tmp_path: Path) -> None:
    law = read(cards, tmp_path).sections[0].material
    assert isinstance(law, ct.Mises)
    assert law.parameters() == ct.Mises(E=200000.0, nu=0.3, **wanted).parameters()


BAD = [
    ("*PLASTIC\n", 0, "a data line is missing"),
    ("*PLASTIC\n0.\n", 1, "yield stress must be > 0"),
    ("*PLASTIC\n-5.\n", 1, "yield stress must be > 0"),
    ("*PLASTIC\n250., .1\n", 1, "must start at plastic strain 0"),
    ("*PLASTIC\n250., 0.\n240., .1\n", 2, "may not fall"),
    ("*PLASTIC\n250., 0.\n260., 0.\n", 2, "must grow from row to row"),
    ("*PLASTIC\n250., 0.\n260., -.1\n", 2, "plastic strain must be >= 0"),
    ("*PLASTIC\n250., 0., 20.\n200., 0., 300.\n240., .1, 20.\n", 0, "20 is given twice"),
    ("*PLASTIC\n250., 0., 20.\n200., .1, 300.\n", 2, "must start at plastic strain 0"),
    ("*PLASTIC, HARDENING=COMBINED, DEPENDENCIES=1\n250.\n", 0, "many field variables"),
    ("*PLASTIC, HARDENING=WISHFUL\n250.\n", 0, "is not known"),
    ("*PLASTIC, HARDENING=KINEMATIC\n250.,0.\n260.,.1\n270.,.2\n", 3, "is linear: two rows"),
    ("*PLASTIC, DATA TYPE=PARAMETERS\n250., 1., 0.\n", 0, "needs HARDENING=COMBINED"),
    ("*PLASTIC\n250.\n*PLASTIC\n250.\n", 2, "already has a *PLASTIC"),
    ("*PLASTIC\n250.\n*CYCLIC HARDENING\n250.\n", 2, "belongs to *PLASTIC, HARDENING=COMBINED"),
    ("*CYCLIC HARDENING\n250.\n", 0, "needs *PLASTIC"),
    (
        "*PLASTIC, HARDENING=COMBINED\n250.\n*CYCLIC HARDENING\n240.\n",
        3,
        "give the same",
    ),
    (
        "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS\n250., 0., 1.\n",
        0,
        "C of back-stress 1 must be > 0",
    ),
    (
        "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, NUMBER BACKSTRESSES=2\n250., 1., 1.\n",
        1,
        "C of back-stress 2 is missing",
    ),
]


@pytest.mark.parametrize(("cards", "line", "reason"), BAD)
def test_refuses_with_the_place(cards: str, line: int, reason: str, tmp_path: Path) -> None:
    with pytest.raises(ct.DeckError) as caught:
        read(cards, tmp_path)
    text = str(caught.value)
    assert reason in text
    assert f"job.inp:{LINE + line}:" in text.splitlines()[0], text


def test_mean_dilatation_and_weight(tmp_path: Path) -> None:
    path = tmp_path / "job.inp"
    section = "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL, DILATATION=MEAN\n1.\n"
    strain = HEAD.replace("CPS4", "CPE4") + section
    path.write_text(strain, encoding="utf-8")
    assert ct.read(path).sections[0].mean_dilatation
    path.write_text(HEAD + section, encoding="utf-8")
    with pytest.raises(ct.DeckError, match="mean dilatation is for plane strain"):
        ct.read(path)


def test_history_of_points_in_the_tables(tmp_path: Path) -> None:
    """``*EL PRINT`` of PEEQ: every point of the set at every increment."""
    from corota.cli import main

    step = (
        "*BOUNDARY\n1, 1, 2\n4, 1, 1\n2, 2, 2\n*STEP\n*STATIC, DIRECT\n.5, 1.\n"
        "*BOUNDARY\n2, 1, 1, .004\n3, 1, 1, .004\n*EL PRINT, ELSET=ALL\nPEEQ\n*END STEP\n"
    )
    path = tmp_path / "job.inp"
    path.write_text(HEAD + "*PLASTIC\n250.\n" + TAIL + step, encoding="utf-8")
    assert main(["run", str(path), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    text = (tmp_path / "out" / "job.dat").read_text(encoding="utf-8")
    assert text.count("equivalent plastic strain") == 2
    rows = [line.split() for line in text.splitlines() if line[:10].strip() == "1"]
    assert [row[1] for row in rows] == ["1", "2", "3", "4"] * 2
    assert float(rows[-1][2]) == pytest.approx(0.004 - 250 / 200000, rel=1e-5)

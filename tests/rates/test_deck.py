"""Cards of rates and creep: read, written, read again, refused; decks beside CalculiX."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from tests.support.calculix import needs_ccx, run_ccx

ELASTIC = "*ELASTIC\n200000., .3\n"
PLASTIC = "*PLASTIC\n250., 0.\n300., .1\n"
CURVE = [(250.0, 0.0), (300.0, 0.1)]


def law(**options: Any) -> ct.Mises:
    return ct.Mises(200e3, 0.3, **options)


CARDS: dict[str, Any] = {
    PLASTIC + "*RATE DEPENDENT\n40., 5.\n": law(yield_curve=CURVE, rate=ct.CowperSymonds(40, 5)),
    PLASTIC + "*RATE DEPENDENT, TYPE=YIELD RATIO\n1., 0.\n1.3, 10.\n": law(
        yield_curve=CURVE, rate=ct.YieldRatio([(1.0, 0.0), (1.3, 10.0)])
    ),
    "*PLASTIC, RATE=0.\n250., 0.\n300., .1\n*PLASTIC, RATE=10.\n300., 0.\n390., .2\n": law(
        yield_curve=CURVE, rate=ct.RateCurves([(10.0, [(300.0, 0.0), (390.0, 0.2)])])
    ),
    "*CREEP\n1e-14, 5.\n": law(rate=ct.Norton(1e-14, 5.0)),
    "*CREEP, LAW=STRAIN\n1e-14, 5., -.3\n": law(rate=ct.Norton(1e-14, 5.0, -0.3, "strain")),
    PLASTIC + "*CREEP, LAW=TIME\n1e-14, 5., -.3\n": law(
        yield_curve=CURVE, rate=ct.Norton(1e-14, 5.0, -0.3)
    ),
}


def deck(cards: str, element: str = "CPS4", step: str = "", strain: float = 0.01) -> str:
    """A cell that is pulled by its right side."""
    step = step or "*STEP\n*STATIC\n0.1, 1.\n"
    return f"""*NODE, NSET=all
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE={element}, ELSET=body
1, 1, 2, 3, 4
*NSET, NSET=left
1, 4
*NSET, NSET=right
2, 3
*MATERIAL, NAME=steel
{ELASTIC}{cards}*SOLID SECTION, ELSET=body, MATERIAL=steel
1.
*BOUNDARY
left, 1
1, 2
{step}*BOUNDARY
right, 1, 1, {strain}
*NODE PRINT, NSET=right, FREQUENCY=1
RF
*END STEP
"""


def read(tmp_path: Path, text: str, name: str = "a.inp") -> ct.Model:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return ct.read(path)


@pytest.mark.parametrize("cards", CARDS, ids=lambda c: re.sub(r"[^A-Z=]+", " ", c))
def test_round_trip(cards: str, tmp_path: Path) -> None:
    model = read(tmp_path, deck(cards))
    found = model.sections[0].material
    assert found.law == "viscoplastic"
    assert found.parameters() == CARDS[cards].parameters()
    again = tmp_path / "b.inp"
    ct.write(model, again)
    assert ct.read(again).sections[0].material.parameters() == found.parameters()


def test_johnson_cook(tmp_path: Path) -> None:
    cards = (
        "*DENSITY\n7.85e-9\n*PLASTIC, HARDENING=JOHNSON COOK\n350., 275., .36, 1.03, 1500., 20.\n"
        "*RATE DEPENDENT, TYPE=JOHNSON COOK\n.022, 1.\n*SPECIFIC HEAT\n4.5e8\n"
        "*INELASTIC HEAT FRACTION\n.8\n"
    )
    heated = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nall, 20.\n"
    model = read(tmp_path, deck(cards, step=heated + "*STEP\n*STATIC\n0.1, 1.\n"))
    found = model.sections[0].material
    wanted = ct.JohnsonCook(
        E=200e3, nu=0.3, A=350.0, B=275.0, n=0.36, C=0.022, rate=1.0, m=1.03, melting=1500.0,
        transition=20.0, heat_fraction=0.8, specific_heat=4.5e8, rho=7.85e-9,
    )  # fmt: skip
    assert found.parameters() == pytest.approx(wanted.parameters(), rel=1e-12)


def test_creep_by_temperature(tmp_path: Path) -> None:
    """Between temperatures A, n and m are straight."""
    text = deck("*CREEP\n1e-14, 5., 0., 20.\n3e-14, 4., 0., 120.\n")
    text = text.replace("*STEP", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nall, 70.\n*STEP", 1)
    rate = read(tmp_path, text).sections[0].material.rate
    assert (rate.A, rate.n) == (pytest.approx(2e-14), pytest.approx(4.5))


def test_visco_steps(tmp_path: Path) -> None:
    """Their loads act at once unless AMPLITUDE=RAMP; CETOL bounds the error of the creep."""
    cards = "*CREEP\n1e-14, 5.\n"
    for options, ramp in (("", False), (", AMPLITUDE=RAMP", True), (", AMPLITUDE=STEP", False)):
        text = deck(cards, step=f"*STEP{options}\n*VISCO, CETOL=1e-4\n0.1, 10.\n")
        model = read(tmp_path, text)
        step = model.steps[0]
        assert isinstance(step, ct.Visco)
        assert (step.ramp, step.creep_tolerance, step.period) == (ramp, 1e-4, 10.0)
        again = tmp_path / "b.inp"
        ct.write(model, again)
        other = ct.read(again).steps[0]
        assert isinstance(other, ct.Visco)
        assert (other.ramp, other.creep_tolerance) == (ramp, 1e-4)


BAD = [
    ("*RATE DEPENDENT\n40., 5.\n", "needs \\*PLASTIC"),
    (PLASTIC + "*RATE DEPENDENT\n0., 5.\n", "rate D"),
    (PLASTIC + "*RATE DEPENDENT\n40., 5.\n*CREEP\n1e-9, 5.\n", "already has a"),
    (PLASTIC + "*RATE DEPENDENT, TYPE=JOHNSON COOK\n.1, 1.\n", "HARDENING=JOHNSON COOK"),
    ("*CREEP\n1e-9\n", "n is missing|expected"),
    ("*CREEP\n1e-9, 5., 0., 20.\n1e-9, 5., 0., 20.\n", "given twice"),
    ("*PLASTIC, RATE=1.\n250.\n*PLASTIC, RATE=1.\n260.\n", "given twice"),
    ("*PLASTIC, RATE=0.\n250.\n*PLASTIC, RATE=1.\n240.\n", "falls with the rate"),
    (PLASTIC + "*PLASTIC, RATE=1.\n260.\n", "in every"),
]


@pytest.mark.parametrize(("cards", "text"), BAD)
def test_refuses(cards: str, text: str, tmp_path: Path) -> None:
    with pytest.raises(ct.CorotaError, match=text):
        read(tmp_path, deck(cards))


#: Of CalculiX: creep, alone and over a yield stress, in the plane and in all directions.
BESIDE = [
    ("*CREEP\n1e-14, 5.\n", "CPS4", 1e-3),
    ("*CREEP\n1e-14, 5.\n", "CPE4", 1e-3),
    ("*CREEP\n1e-12, 4., -.3\n", "CPS4", 1e-3),
    (PLASTIC + "*CREEP\n1e-8, 3.\n", "CPS4", 3e-3),
    (PLASTIC + "*CREEP\n1e-8, 3.\n", "CPE4", 3e-3),
]


@needs_ccx
@pytest.mark.parametrize(("cards", "element", "strain"), BESIDE)
def test_beside_calculix(cards: str, element: str, strain: float, tmp_path: Path) -> None:
    """Relaxation at a strain that comes within one second: forces of twenty increments."""
    step = "*STEP, INC=1000, AMPLITUDE=RAMP\n*VISCO, DIRECT, CETOL=1000.\n0.05, 1.\n"
    text = deck(cards, element, step, strain)
    model = read(tmp_path, text)
    found = np.array([f.RF[[1, 2], 0].sum() for f in ct.solve(model).frames])
    run_ccx(tmp_path, "a")
    pattern = r"forces \(fx,fy,fz\)[^\n]*\n\n((?: +\d+.*\n)+)"
    blocks = re.findall(pattern, (tmp_path / "a.dat").read_text())
    theirs = np.array(
        [sum(float(row.split()[1]) for row in block.splitlines()) for block in blocks]
    )
    assert len(theirs) == len(found[-20:])
    size = np.abs(theirs).max()
    np.testing.assert_allclose(found[-20:], theirs, atol=2e-3 * size)

"""Cards of decks that CalculiX does not have: the same answer as that of a deck without them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

BLOCK = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
9, 2.5, .5
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=END
3, 6
*SURFACE, NAME=TIP
2, S2
*SURFACE, NAME=TOP
EALL, S3
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
4.
*SOLID SECTION, ELSET=EALL, MATERIAL=M
.5
*BOUNDARY
1, 1, 2
4, 1, 2
{model}*STEP
*STATIC
{step}*END STEP
"""


def solve(tmp_path: Path, model: str, step: str) -> np.ndarray:
    path = tmp_path / "deck.inp"
    path.write_text(BLOCK.format(model=model, step=step), encoding="utf-8")
    return ct.solve(ct.read(path), threads=1).frames[-1].U


def fault(tmp_path: Path, model: str, step: str = "") -> str:
    with pytest.raises(ct.DeckError) as caught:
        solve(tmp_path, model, step)
    return str(caught.value)


PUSH = "*CLOAD\n9, 2, -3.\n"
COUPLING = "*COUPLING, REF NODE=9, SURFACE=TIP, CONSTRAINT NAME=C{}\n"
DISTRIBUTED = COUPLING + "*DISTRIBUTING{}\n"


@pytest.mark.parametrize(
    ("model", "step", "same_model", "same_step"),
    [
        (
            "*KINEMATIC COUPLING, REF NODE=9\nEND, 1, 2\n",
            PUSH,
            COUPLING.format("") + "*KINEMATIC\n1, 2\n",
            PUSH,
        ),
        (
            "*ELEMENT, TYPE=DCOUP2D, ELSET=DC\n50, 9\n"
            "*DISTRIBUTING COUPLING, ELSET=DC\n3, 2.\n6, 2.\n",
            PUSH,
            DISTRIBUTED.format("", ""),
            PUSH,
        ),
        (
            DISTRIBUTED.format(", INFLUENCE RADIUS=5.", ", WEIGHTING METHOD=UNIFORM"),
            PUSH,
            DISTRIBUTED.format("", ""),
            PUSH,
        ),
        (
            "*SURFACE, NAME=BOTH, COMBINE=UNION\nTOP, TIP\n",
            "*DSLOAD\nBOTH, P, 2.\n",
            "",
            "*DSLOAD\nTOP, P, 2.\nTIP, P, 2.\n",
        ),
        (
            "*SURFACE, NAME=ALSO, COMBINE=UNION\nTOP, TIP\n"
            "*SURFACE, NAME=LESS, COMBINE=DIFFERENCE\nALSO, TOP\n"
            "*SURFACE, NAME=SAME, COMBINE=INTERSECTION\nLESS\nALSO\n",
            "*DSLOAD\nSAME, P, 2.\n",
            "",
            "*DSLOAD\nTIP, P, 2.\n",
        ),
        ("", "*DLOAD\nEALL, BY, -8.\n", "", "*DLOAD\nEALL, GRAV, 2., 0., -1., 0.\n"),
        ("", "*DLOAD\n2, BX, 8.\n", "", "*DLOAD\n2, GRAV, 2., 1., 0., 0.\n"),
        ("", "*DLOAD\n2, TRVEC2, 3., 0., -1.\n", "", "*DSLOAD\nTIP, TRVEC, 3., 0., -1.\n"),
        ("", "*DLOAD\nEALL, TRSHR3, 3., 1., 0.\n", "", "*DSLOAD\nTOP, TRSHR, 3., 1., 0.\n"),
        ("", "*CONTROLS, ANALYSIS=DISCONTINUOUS\n*DLOAD\n2, P2, 1.\n", "", "*DLOAD\n2, P2, 1.\n"),
    ],
)
def test_two_ways_to_write_it(
    tmp_path: Path, model: str, step: str, same_model: str, same_step: str
) -> None:
    found, expected = solve(tmp_path, model, step), solve(tmp_path, same_model, same_step)
    assert np.abs(expected).max() > 1e-6
    assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize(
    ("model", "step", "said"),
    [
        ("*KINEMATIC COUPLING, REF NODE=9\n", "", "data line is missing"),
        ("*DISTRIBUTING COUPLING, ELSET=NONE\n3, 1.\n", "", "no set named 'NONE'"),
        ("*DISTRIBUTING COUPLING, ELSET=DC\n", "*CLOAD\n77, 1, 1.\n", "data line is missing"),
        ("*DISTRIBUTING COUPLING, ELSET=DC\n3, -1.\n", "", "must be > 0"),
        (DISTRIBUTED.format(", INFLUENCE RADIUS=.1", ""), "", "within the radius"),
        (DISTRIBUTED.format("", ", WEIGHTING METHOD=CUBIC"), "", "expected UNIFORM"),
        ("*SURFACE, NAME=S, COMBINE=UNION\nTOP\n", "", "two surfaces are expected"),
        ("*SURFACE, NAME=S, COMBINE=UNION\nTOP, TOPS\n", "", "named 'TOPS'"),
        ("", "*DLOAD\nEALL, HP3, 1., 1., 1.\n", "both heights"),
        ("", "*DLOAD\nEALL, P3NU, 1.\n", "no user subroutine"),
        ("", "*DLOAD\nEALL, TRVEC5, 1., 1., 0.\n", "and no face 5"),
        ("", "*DSLOAD\nTOP, HP, 1., 1., 1.\n", "both heights"),
    ],
)
def test_faults_say_what_to_do(tmp_path: Path, model: str, step: str, said: str) -> None:
    assert said in fault(tmp_path, model, step)


def test_a_force_per_volume_needs_no_density(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    text = BLOCK.format(model="", step="*DLOAD\nEALL, BX, 1.\n")
    path.write_text(text.replace("*DENSITY\n4.\n", ""), encoding="utf-8")
    frame = ct.solve(ct.read(path), threads=1).frames[-1]
    assert frame.F.sum(axis=0)[0] == pytest.approx(1.0)

"""``*CHANGE SURFACE BEHAVIOR``: another contact law from a step on."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import CorotaError

if TYPE_CHECKING:
    from pathlib import Path

#: Two blocks of height 1, E = 1000, pressed together by .02 (nu = 0: the pressure is uniform).
DECK = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 0., 1.
6, 1., 1.
7, 1., 2.
8, 0., 2.
*ELEMENT, TYPE=CPS4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=HIGH
2, 5, 6, 7, 8
*NSET, NSET=B
1, 2
*NSET, NSET=T
7, 8
*SURFACE, NAME=M
1, S3
*SURFACE, NAME=S
2, S1
*MATERIAL, NAME=A
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=LOW, MATERIAL=A
1.
*SOLID SECTION, ELSET=HIGH, MATERIAL=A
1.
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE
S, M
*BOUNDARY
B, 1, 2
T, 1
5, 1
6, 1
*STEP
*STATIC
*BOUNDARY
T, 2, 2, -.02
*END STEP
*STEP
*STATIC
*CHANGE SURFACE BEHAVIOR, INTERACTION=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
250.
*END STEP
*STEP
*STATIC
*END STEP
*STEP
*STATIC
*CHANGE SURFACE BEHAVIOR, INTERACTION=I
*SURFACE BEHAVIOR
*END STEP
"""


def test_each_step_has_its_law(tmp_path: Path) -> None:
    """p = d / (2 h / E + 1 / k): k = 1000, 250, the same, hard; CalculiX has the first three."""
    path = tmp_path / "a.inp"
    path.write_text(DECK)
    results = ct.solve(ct.read(path), threads=1)
    top = results.model.mesh.nodes_of("T")
    ends = [[f for f in results.frames if f.step == k][-1] for k in (1, 2, 3, 4)]
    forces = [-float(f.RF[top, 1].sum()) for f in ends]
    assert forces == pytest.approx([0.02 / (0.002 + 1.0 / k) for k in (1e3, 250, 250, np.inf)])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("*CHANGE SURFACE BEHAVIOR, INTERACTION=I\n*SURFACE", "*SURFACE", "inside a step"),
        ("BEHAVIOR, INTERACTION=I\n", "BEHAVIOR, INTERACTION=J\n", "no *SURFACE INTERACTION"),
    ],
)
def test_what_cannot_be_changed(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "a.inp"
    path.write_text(DECK.replace(old, new, 1))
    with pytest.raises(CorotaError, match=message.replace("*", r"\*")):
        ct.read(path)

"""Rotation nodes of rigid bodies named by a set, as PrePoMax writes them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct

DECK = """*NODE
1,0,0
2,4,0
3,4,1
4,0,1
101,4,.5
102,4,.5
*ELEMENT, TYPE=CPS4R, ELSET=EA
1,1,2,3,4
*NSET, NSET=EDGE
2,3
*NSET, NSET=ROT
102
*MATERIAL, NAME=M
*ELASTIC
1000.,0.
*SOLID SECTION, ELSET=EA, MATERIAL=M
1.
*RIGID BODY, NSET=EDGE, REF NODE=101, ROT NODE=102
*BOUNDARY
1,1,2
4,1,2
*STEP
*STATIC
{}
*END STEP
"""


@pytest.mark.parametrize(
    ("by_set", "by_number"),
    [
        ("*CLOAD\nROT,3,.5", "*CLOAD\n102,3,.5"),
        ("*BOUNDARY\nROT,3,3,.01", "*BOUNDARY\n102,3,3,.01"),
        ("*BOUNDARY\nROT,1,3", "*BOUNDARY\n102,1,3"),
    ],
)
def test_a_set_of_the_rotation_node_is_the_node(
    tmp_path: Path, by_set: str, by_number: str
) -> None:
    found = []
    for text in (by_set, by_number):
        deck = tmp_path / "deck.inp"
        deck.write_text(DECK.format(text))
        found.append(ct.solve(ct.read(deck)).frames[-1].U)
    assert found[0] == pytest.approx(found[1])
    if "ROT,3" in by_set:
        assert abs(found[0]).max() > 1e-3

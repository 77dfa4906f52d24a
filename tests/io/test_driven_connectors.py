"""Motions, loads and stops of connectors, against statics by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import DeckError

if TYPE_CHECKING:
    from pathlib import Path

#: Two springs to the ground in line, 100 and 300, with a connector between their free ends.
DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, 4., 0.
*ELEMENT, TYPE=SPRING1, ELSET=LEFT
1, 2
*ELEMENT, TYPE=SPRING1, ELSET=RIGHT
2, 3
*ELEMENT, TYPE=CPS4, ELSET=BODY
9, 5, 6, 7, 8
*NODE
5, 0., -2.
6, 1., -2.
7, 1., -1.
8, 0., -1.
*ELEMENT, TYPE=CONN2D2, ELSET=WIRE
3, 2, 3
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=BODY, MATERIAL=M
1.
*SPRING, ELSET=LEFT
1
100.
*SPRING, ELSET=RIGHT
1
300.
*CONNECTOR SECTION, ELSET=WIRE{behavior}
{kind}
*BOUNDARY
5, 1, 2
6, 1, 2
7, 1, 2
8, 1, 2
2, 2
{third}"""
STEP = """*STEP{nlgeom}
*STATIC
{card}
*END STEP
"""


def run(
    path: Path, *cards: str, kind: str = "CARTESIAN", behavior: str = "", nlgeom: str = ""
) -> list[tuple[float, float]]:
    (path / "a.inp").write_text(
        (behavior and f"*CONNECTOR BEHAVIOR, NAME=B\n{behavior}\n")
        + DECK.format(
            kind=kind,
            behavior=", BEHAVIOR=B" if behavior else "",
            third="" if kind in ("TRANSLATOR", "SLOT") else "3, 2\n",
        )
        + "".join(STEP.format(nlgeom=nlgeom, card=card) for card in cards)
    )
    model = ct.read(path / "a.inp")
    at = np.searchsorted(model.mesh.node_labels, (2, 3))
    frames = ct.solve(model).frames
    ends = [
        f
        for f, after in zip(frames, [*frames[1:], None], strict=True)
        if after is None or after.step != f.step
    ]
    return [tuple(frame.U[at, 0].tolist()) for frame in ends[-len(cards) :]]


@pytest.mark.parametrize("kind", ["CARTESIAN", "TRANSLATOR", "SLOT", "AXIAL"])
def test_motion_and_load_of_a_connector(tmp_path: Path, kind: str) -> None:
    # The connector is a link of length 2 + d: equal forces, 100 u2 = -300 u3, u3 - u2 = d.
    first, second = run(
        tmp_path, "*CONNECTOR MOTION\nWIRE, 1, 0.4", "*CONNECTOR MOTION\n3, 1, -0.8", kind=kind
    )
    np.testing.assert_allclose(first, [-0.3, 0.1], rtol=1e-9)
    np.testing.assert_allclose(second, [0.6, -0.2], rtol=1e-9)
    # A load pushes both ends apart; it goes on until it is given again.
    found = run(
        tmp_path,
        "*CONNECTOR LOAD\nWIRE, 1, 30.",
        "*CLOAD\n2, 1, 10.",
        "*CONNECTOR LOAD\nWIRE, 1, 0.",
        kind=kind,
    )
    np.testing.assert_allclose(found, [(-0.3, 0.1), (-0.2, 0.1), (0.1, 0.0)], atol=1e-9)


def test_stops_of_a_connector(tmp_path: Path) -> None:
    # The nodes are 2 apart, and may be 1.9 to 2.1: free up to there, then one body on both springs.
    behavior = "*CONNECTOR STOP, COMPONENT=1\n1.9, 2.1"
    found = run(
        tmp_path,
        "*CLOAD\n2, 1, 5.",
        "*CLOAD\n2, 1, 90.",
        "*CLOAD\n2, 1, -90.",
        behavior=behavior,
        nlgeom=", NLGEOM",
    )
    np.testing.assert_allclose(found[0], [0.05, 0.0], atol=1e-9)
    # 100 u2 + 300 (u2 - 0.1) = 90
    np.testing.assert_allclose(found[1], [0.3, 0.2], atol=1e-9)
    np.testing.assert_allclose(found[2], [-0.3, -0.2], atol=1e-9)


@pytest.mark.parametrize(
    ("card", "kind", "said"),
    [
        ("*CONNECTOR MOTION\nWIRE, 2, 1.", "TRANSLATOR", "component 2 .* does not move"),
        ("*CONNECTOR MOTION\nNONE, 1, 1.", "CARTESIAN", "named 'NONE'"),
        ("*CONNECTOR LOAD, OP=NEW\nWIRE, 1, 1.", "CARTESIAN", "OP=NEW"),
        ("*CONNECTOR LOAD\nWIRE, 3, 1.", "CARTESIAN", "expected component 1, 2 or 6"),
    ],
)
def test_what_is_refused(tmp_path: Path, card: str, kind: str, said: str) -> None:
    with pytest.raises(DeckError, match=said):
        run(tmp_path, card, kind=kind)


def test_an_axial_motion_under_nlgeom_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DeckError, match="AXIAL turns under NLGEOM"):
        run(tmp_path, "*CONNECTOR MOTION\nWIRE, 1, 1.", kind="AXIAL", nlgeom=", NLGEOM")

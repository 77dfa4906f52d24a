"""Ends of beams without moment, and connectors of two nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from pathlib import Path

import pytest

import corota as ct

#: A beam of unit stiffness E I, of two elements from 0 to 1 and 3.
BEAM = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, {x}, 0.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2
2, 2, 3
*MATERIAL, NAME=M
*ELASTIC
12., 0.
*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT
1., 1.
0., 0., -1.
{card}*BOUNDARY
1, 1, 6
{support}
*STEP
*STATIC
*CLOAD
{load}
*END STEP
"""


def solve(path: Path, **words: str) -> ct.Results:
    given = {"x": "3.", "type": "B23", "card": "", "support": "4, 1, 6", **words}
    deck = path / "deck.inp"
    deck.write_text(BEAM.format(**given))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(ct.read(deck), threads=1)


@pytest.mark.parametrize("card", ["1, S2, M1", "1, S2, ALLM", "2, S1, M1-M2"])
@pytest.mark.parametrize("type_", ["B23", "B33"])
def test_a_hinge_in_a_beam(tmp_path: Path, card: str, type_: str) -> None:
    """Cantilever of 1 with P at its end, from which a bar hangs freely to a roller: P / 3 E I.

    The bar turns by u / 2, so that its own node has that rotation.
    """
    results = solve(
        tmp_path,
        type=type_,
        card=f"*RELEASE\n{card}\n",
        support="3, 1, 2\n4, 1, 6",
        load="2, 2, -.3",
    )
    frame = results.frames[-1]
    assert frame.U[1, 1] == pytest.approx(-0.1, rel=1e-6)
    turns = sorted(frame.UR[[1, 4]])
    assert turns == pytest.approx([-0.15, 0.05], rel=1e-6)


def test_a_moment_out_of_the_plane_is_noted(tmp_path: Path) -> None:
    plain = solve(tmp_path, load="2, 2, -.3", support="3, 1, 2\n4, 1, 6")
    found = solve(
        tmp_path, card="*RELEASE\n1, S2, M2\n", load="2, 2, -.3", support="3, 1, 2\n4, 1, 6"
    )
    assert found.frames[-1].U[1, 1] == pytest.approx(plain.frames[-1].U[1, 1], rel=1e-12)
    assert any("out of the plane" in note for note in found.model.notes)
    with pytest.raises(ct.DeckError, match="no beams in 7"):
        solve(tmp_path, card="*RELEASE\n7, S1, M1\n", load="2, 2, 1.")


CONNECT = "*ELEMENT, TYPE=CONN2D2, ELSET=C\n9, {nodes}\n*CONNECTOR SECTION, ELSET=C\n{kind}\n"


@pytest.mark.parametrize(
    ("kind", "x", "like"),
    [
        ("JOIN", "3.", "3, 1, 2"),
        ("HINGE", "3.", "3, 1, 2"),
        ("WELD", "3.", "3, 1, 6"),
        ("JOIN, ALIGN", "3.", "3, 1, 6"),
        ("BEAM", "4.", "3, 1, 6"),
    ],
)
@pytest.mark.parametrize("nodes", ["3, 4", "4, 3"])
def test_a_connector_holds_as_a_support_does(
    tmp_path: Path, kind: str, x: str, like: str, nodes: str
) -> None:
    """The end of the beam is connected to a node that is held."""
    found = solve(tmp_path, x=x, card=CONNECT.format(nodes=nodes, kind=kind), load="2, 2, -.3")
    wanted = solve(tmp_path, support=like + "\n4, 1, 6", load="2, 2, -.3")
    assert found.frames[-1].U[1, 1] == pytest.approx(wanted.frames[-1].U[1, 1], rel=1e-9)


@pytest.mark.parametrize(
    ("kind", "x", "said"),
    [("BUSHING", "4.", "there are JOIN"), ("JOIN", "4.", "apart")],
)
def test_other_connectors_say_what_to_give(tmp_path: Path, kind: str, x: str, said: str) -> None:
    with pytest.raises(ct.DeckError, match=said) as caught:
        solve(tmp_path, x=x, card=CONNECT.format(nodes="3, 4", kind=kind), load="2, 2, 1.")
    assert str(caught.value).count("error:") == 1

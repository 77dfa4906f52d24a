"""Abbreviated values of parameters are read as the value they stand for."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct

DECK = """*NODE, NSET=ALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*INITIAL CONDITIONS, TYPE={kind}
ALL, 1, 2.
"""


@pytest.mark.parametrize("kind", ["VELOCITY", "VELOC", "vel"])
def test_abbreviated_type_of_initial_conditions(kind: str, tmp_path: Path) -> None:
    """``TYPE=VELOC``, as in a deck that was cut off, ended in an internal error."""
    path = tmp_path / "part.inp"
    path.write_text(DECK.format(kind=kind), encoding="utf-8")
    found = ct.read(path).velocities
    assert [(item.value, item.dof) for item in found] == [((2.0,), 0)]

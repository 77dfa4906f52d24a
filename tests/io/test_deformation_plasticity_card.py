"""``*DEFORMATION PLASTICITY`` of CalculiX means large displacements."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

DECK = """*NODE
1, 0., 0.
2, 10., 0.
3, 10., 10.
4, 0., 10.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*NSET, NSET=R
2, 3
*MATERIAL, NAME=M
*DEFORMATION PLASTICITY
210000., .3, 250., 8., .4
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
2, 2
*STEP
*STATIC
.1, 1.
*BOUNDARY
R, 1, 1, 1.
*END STEP
"""


@pytest.mark.parametrize(
    ("comment", "step", "force"),
    [
        ("", "*STEP", 4398.5),
        ("", "*STEP, NLGEOM=NO", 4863.5),
        ("** DIALECT: abaqus\n", "*STEP", 4863.5),
    ],
)
def test_it_turns_nlgeom_on(tmp_path: Path, comment: str, step: str, force: float) -> None:
    """A bar stretched by 10 %: CalculiX 2.20 has 4398.5 with and without NLGEOM."""
    path = tmp_path / "a.inp"
    path.write_text(comment + DECK.replace("*STEP", step))
    results = ct.solve(ct.read(path), threads=1)
    right = results.model.mesh.nodes_of("R")
    assert results.frames[-1].RF[right, 0].sum() == pytest.approx(force, rel=2e-3)

"""Joints of decks at nodes with axes of their own: the same as without these axes.

*TRANSFORM turns the dofs of supports, loads and equations. PIN, TIE and LINEAR of *MPC join global
displacements (Abaqus Analysis User's Guide, general multi-point constraints), connectors act along
their orientations, embedded nodes follow their host.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
11, 0., 1.
12, 2., 1.
13, 0., 2.
14, 2., 2.
21, .3, .3
22, 1.6, .8
*ELEMENT, TYPE=CPS4, ELSET=HOST
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*ELEMENT, TYPE=CPS4, ELSET=UPPER
3, 11, 12, 14, 13
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=HOST, MATERIAL=M
1.
*SOLID SECTION, ELSET=UPPER, MATERIAL=M
1.
{axes}*BOUNDARY
1, 1, 2
4, 1, 2
11, 1, 2
13, 1, 2
{joint}*STEP{nlgeom}
*STATIC
*CLOAD
3, 1, 3.
3, 2, 5.
14, 1, 2.
14, 2, -3.
*END STEP
"""
CONNECTOR = (
    "*ORIENTATION, NAME=O\n.6, .8, 0., -.8, .6, 0.\n*ELEMENT, TYPE=CONN2D2, ELSET=C\n90, 6, 12\n"
    "*CONNECTOR SECTION, ELSET=C\n{}\nO,\n"
)
#: Cards of a joint, nodes of which one after the other gets axes.
JOINTS = {
    "PIN": ("*MPC\nPIN, 6, 12\n", (6, 12)),
    "TIE": ("*MPC\nTIE, 6, 12\n", (6, 12)),
    "LINEAR": ("*MPC\nLINEAR, 2, 1, 3\n", (1, 2)),
    "JOIN": (CONNECTOR.format("JOIN,"), (6, 12)),
    "SLOT": (CONNECTOR.format("SLOT,"), (6, 12)),
    "TRANSLATOR": (CONNECTOR.format("TRANSLATOR,"), (6, 12)),
    "EMBEDDED": (
        "*ELEMENT, TYPE=T2D2, ELSET=BAR\n91, 21, 22\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n2.\n"
        "*EMBEDDED ELEMENT, HOST ELSET=HOST\nBAR\n",
        (5, 21),
    ),
}


@pytest.mark.parametrize("nlgeom", ["", ", NLGEOM"])
@pytest.mark.parametrize("name", JOINTS)
def test_axes_of_nodes_do_not_turn_a_joint(tmp_path: Path, name: str, nlgeom: str) -> None:
    """Displacements with axes at one node are those without; was up to .6 of the largest."""
    joint, nodes = JOINTS[name]
    found = []
    for node in (0, *nodes):
        axes = f"*NSET, NSET=T\n{node}\n*TRANSFORM, NSET=T\n-.6, .8, 0., -.8, -.6, 0.\n"
        path = tmp_path / f"{node}.inp"
        path.write_text(DECK.format(axes=axes if node else "", joint=joint, nlgeom=nlgeom))
        found.append(ct.solve(ct.read(path)).frames[-1].U)
    assert np.abs(found[0]).max() > 5e-3
    for turned in found[1:]:
        np.testing.assert_allclose(turned, found[0], rtol=0.0, atol=1e-9)

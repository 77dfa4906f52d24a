"""Decks from which the mutations start: together they use every keyword."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from decks import DECK, MESH, SECTION, SUPPORT

ASSEMBLY = """*Part, name=Block
*Node
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*Element, type=CPS4R
1, 1, 2, 3, 4
*Nset, nset=Left
1, 4
*Elset, elset=All, generate
1, 1, 1
*Solid Section, elset=All, material=Steel
,
*End Part
*Assembly, name=Assembly
*Instance, name=Block-1, part=Block
*End Instance
*Instance, name=Block-2, part=Block
2., 0., 0.
2., 0., 0., 2., 0., 1., 90.
*End Instance
*Nset, nset=Held, instance=Block-1
2, 3
*Elset, elset=Second, instance=Block-2
1,
*Surface, type=ELEMENT, name=Top
Second, S3
*End Assembly
*Material, name=Steel
*Elastic
210000., 0.3
*Boundary
Held, 1, 2
Block-2.Left, ENCASTRE
*Step, name=Step-1, nlgeom=YES
*Static
0.1, 1., 1e-05, 1.
*Cload
Block-1.4, 1, 5.
*Dsload
Top, P, 2.
*Output, field, variable=PRESELECT
*End Step
"""

FULL = (
    "*HEADING\nEverything\n"
    + MESH
    + """*NSET, NSET=ends, GENERATE
1, 3, 2
*NSET, NSET=more
ends, 6
*ELSET, ELSET=second
2
*SURFACE, NAME=top
eall, S3
*SURFACE, NAME=points, TYPE=NODE
more
*ORIENTATION, NAME=o
1., 1., 0., -1., 1., 0.
"""
    + SECTION.replace("*SOLID", "*DENSITY\n7.8e-9\n*SOLID").replace(
        "=steel\n2.", "=steel, PLANE=STRESS\n2."
    )
    + """*MATERIAL, NAME=wood
*ELASTIC, TYPE=ENGINEERING CONSTANTS
10., 4., 3., .3, .2, .1, 2., 1.,
1.
*AMPLITUDE, NAME=up
0., 0., .5, 2., 1., 1.
*TIME POINTS, NAME=tp
.5, 1.
"""
    + SUPPORT
    + """*STEP, NLGEOM, INC=50
*STATIC
.1, 1., 1e-4, .5
*CLOAD, AMPLITUDE=up
more, 2, -5.
*DLOAD
second, P2, 3.
eall, GRAV, 9.81, 0., -1., 0.
eall, CENTRIF, 4., 0., 0., 0., 0., 0., 1.
*DSLOAD
top, P, 1.
*NODE PRINT, NSET=nall, TOTALS=YES, FREQUENCY=2
U, RF
*EL PRINT, ELSET=eall, TIME POINTS=tp
S, E
*NODE FILE
U
*EL FILE
S
*END STEP
*STEP
*STATIC, DIRECT
.5, 1.
*BOUNDARY, OP=NEW
1, 1, 6
3, 2, 2, .1
*CLOAD, OP=NEW
*END STEP
"""
)

GMSH = (
    """*Heading
 plate
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
******* E L E M E N T S *************
*ELEMENT, type=T3D2, ELSET=Line1
1, 1, 2
*ELEMENT, type=CPS3, ELSET=Surface1
10, 1, 2, 3
11, 1, 4, 3
*ELSET,ELSET=foot
1,
"""
    + SECTION.replace("eall", "Surface1")
    + """*BOUNDARY
foot, 1, 2
*STEP
*STATIC
*DSLOAD
foot, P, 2.
*END STEP
"""
)

DRILLING = (
    DECK.replace("CPS4", "Q4D").replace("3, 2, -5.", "3, 6, -5.").replace("1, 1, 2", "1, 1, 6")
)

SEEDS = (DECK, FULL, FULL, ASSEMBLY, GMSH, DRILLING)

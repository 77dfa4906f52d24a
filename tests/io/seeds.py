"""Decks from which the mutations start: together they use every keyword."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from decks import DECK, MESH, SECTION, STEP, SUPPORT

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
    DECK.replace("CPS4", "Q4D")
    .replace("3, 2, -5.", "3, 6, -5.")
    .replace("\n1, 1, 2\n4", "\n1, 1, 6\n4")
)

#: The squares with density, loose nodes, a surface and hardening; then cards and steps.
HEAD = (
    MESH
    + "*NODE\n20, 3., 0.5\n21, 3., 0.5\n*SURFACE, NAME=END\n2, S2\n*NSET, NSET=TIP\n3, 6\n"
    + SECTION.replace("*SOLID", "*DENSITY\n7.8e-9\n*PLASTIC\n200., 0.\n250., .1\n*SOLID")
)

CONSTRAINED = (
    HEAD
    + """*EQUATION
2
3, 1, 1., 6, 1, -1.
*TRANSFORM, NSET=nall, TYPE=R
1., 0., 0., 0., 1., 0.
*COUPLING, REF NODE=20, SURFACE=END, CONSTRAINT NAME=C1
*DISTRIBUTING
1, 2
"""
    + SUPPORT
    + STEP
)

RIGID = (
    HEAD
    + "*RIGID BODY, NSET=TIP, REF NODE=20, ROT NODE=21\n"
    + SUPPORT
    + """*BOUNDARY
21, 3, 3, .01
*STEP, NLGEOM, INC=40
*STATIC, RIKS
.1, 1., 1e-5, .5, , 20, 2, -.1
*CLOAD
20, 2, -5.
*END STEP
"""
)

MOVING = (
    HEAD
    + """*DAMPING, ALPHA=.1, BETA=1e-6
*INITIAL CONDITIONS, TYPE=VELOCITY
nall, 2, 1.
"""
    + SUPPORT
    + """*STEP, NLGEOM, INC=30
*DYNAMIC, ALPHA=-.05, DIRECT
1e-6, 1e-5
*CLOAD
3, 2, -5.
*END STEP
*STEP
*FREQUENCY
2
*END STEP
*STEP
*MODAL DYNAMIC
1e-6, 1e-5
*MODAL DAMPING
1, 2, .02
*CLOAD
3, 2, -5.
*END STEP
*STEP
*STEADY STATE DYNAMICS
100., 1e5, 5
*CLOAD
3, 2, -5.
*END STEP
"""
)

BUCKLING = (
    DECK.split("*STEP")[0]
    + """*STEP
*BUCKLE
1
*CLOAD
3, 1, -5.
*END STEP
*STEP, NLGEOM, INC=20
*STATIC
.5, 1.
*CONTROLS, PARAMETERS=FIELD
1e-6
*CLOAD
3, 1, -5.
*END STEP
"""
)

BOLTED = (
    DECK.split("*STEP")[0].replace("*ELASTIC", "*DENSITY\n4.\n*ELASTIC")
    + """*NODE
77, 9., 9.
88, 9., 0.
91, -1., 0.
92, 1., 0.
93, 3., 0.
*ELEMENT, TYPE=R2D2, ELSET=sides
91, 91, 92
92, 92, 93
*RIGID BODY, ELSET=sides, REF NODE=88
*SURFACE, NAME=cut
1, S2
*SURFACE, NAME=low
eall, S1
*SURFACE, NAME=both, COMBINE=UNION
cut, low
*SURFACE, NAME=floor
sides, SPOS
*PRE-TENSION SECTION, SURFACE=cut, NODE=77
1., 0., 0.
*SURFACE INTERACTION, NAME=slide
*FRICTION
.1
*CONTACT
*CONTACT INCLUSIONS, ALL EXTERIOR
*CONTACT PROPERTY ASSIGNMENT
 , , slide
*CONTACT PAIR, INTERACTION=slide, TYPE=MORTAR, ADJUST=nall
low, floor
*AMPLITUDE, NAME=shake
0., 0., 1., 2., 2., -1.
*BOUNDARY
88, 1, 6
*STEP, NLGEOM
*STATIC
*CLOAD
77, 1, 3.
*DSLOAD
low, TRSHR, 2., 1., 0.
both, P, 1.
low, TRVEC, 2., 1., 1.
*END STEP
*STEP, NLGEOM
*DYNAMIC, DIRECT
.1, 1.
*BOUNDARY, FIXED
77, 1
*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=shake
88, 1, 1, .5
*DLOAD, FOLLOWER=NO
eall, BX, 1.
1, TRVEC3, 2., 0., 1.
*END STEP
"""
)

COUPLED = (
    DECK.split("*STEP")[0]
    + """*NODE
77, 9., 9.
78, 8., 9.
*ELEMENT, TYPE=DCOUP2D, ELSET=dc
70, 77
*DISTRIBUTING COUPLING, ELSET=dc
3, 1.
4, 2.
*KINEMATIC COUPLING, REF NODE=78
2, 1, 2
*STEP
*STATIC
*CLOAD, FOLLOWER
78, 2, 1.
*END STEP
"""
)

#: Those whose models can be written as decks.
WRITABLE = (DECK, FULL, FULL, ASSEMBLY, GMSH, DRILLING)
SEEDS = (*WRITABLE, CONSTRAINED, RIGID, MOVING, BUCKLING, BOLTED, COUPLED)

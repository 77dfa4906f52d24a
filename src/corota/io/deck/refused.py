"""Cards and parameters of other programs that have no effect here or are refused, with reasons."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from corota.io.deck.card import key
from corota.io.deck.laws import LAWS

#: Cards without effect here; each is listed in ``Model.notes``.
IGNORED: dict[str, str] = {
    "PREPRINT": "it controls the echo of the input",
    "MONITOR": "progress shows every increment",
    "ENERGYPRINT": "energies are in the history",
    "ENERGYOUTPUT": "energies are in the history",
    "ENERGYFILE": "energies are in the history",
    "SECTIONCONTROLS": "no hourglass control is needed",
    "NOANALYSIS": "use the command check",
    "PRINT": "it controls the message file",
    "FILEFORMAT": "it controls the result file of another program",
    "SOLVERCONTROLS": "the linear solver is direct",
    "USERSUBROUTINE": "no user subroutine is called",
    "FIELD": "no data depend on field variables",
    "SOLUTIONTECHNIQUE": "Newton's method has the exact tangent",
    "USEROUTPUTVARIABLES": "no user subroutine is called",
    "VISCOSITY": "it belongs to fluids",
    "CONTOURINTEGRAL": "contour integrals are not computed; displacements and stresses are",
    "FAILSTRESS": "failure measures are not computed; stresses are",
    "FAILSTRAIN": "failure measures are not computed; strains are",
    **dict.fromkeys(
        (
            "CONDUCTIVITY",
            "GAPCONDUCTANCE",
            "GAPHEATGENERATION",
            "LATENTHEAT",
            "PHYSICALCONSTANTS",
            "JOULEHEATFRACTION",
            "ELECTRICALCONDUCTIVITY",
        ),
        "it contains no stresses; temperatures are given by *TEMPERATURE",
    ),
    **dict.fromkeys(
        (
            "SECTIONFILE",
            "INTEGRATEDOUTPUT",
            "INTEGRATEDOUTPUTSECTION",
            "INCREMENTATIONOUTPUT",
            "SURFACEOUTPUT",
            "MODALOUTPUT",
            "MODALFILE",
            "MODALPRINT",
            "RADIATIONOUTPUT",
            "FILTER",
            "FILEOUTPUT",
            "NODALENERGYRATE",
        ),
        "this output is not written; forces on a section are the sum of RF on its nodes",
    ),
    "DIAGNOSTICS": "the run prints progress and events",
    "PRINTLEVEL": "it controls the message file",
    "CONTACTDIAGNOSTICS": "the run prints progress and events",
    "BULKVISCOSITY": "explicit dynamics has no artificial viscosity here",
    "HOURGLASSSTIFFNESS": "the hourglass is stabilized by the elements themselves",
    "DISPLAYBODY": "it affects pictures only",
}

_CHANGE = (
    "an interaction applies to all steps: give a second pair with another one, and end the first "
    "by *MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE where it begins; friction has *CHANGE FRICTION"
)
_MPC = "use *EQUATION, *RIGID BODY, or *COUPLING with *KINEMATIC or *DISTRIBUTING"
HEAT = "heat conduction is not part of this version; give temperatures by *TEMPERATURE"
_OWN_CARDS = ", ".join(f"*{law.card}" for name, law in LAWS.items() if key(law.card) == name)
PLASTIC = (
    f"the material laws are *ELASTIC, *PLASTIC, *RATE DEPENDENT, *CREEP, *HYPERELASTIC, "
    f"*HYPERFOAM, {_OWN_CARDS}; use these"
)
PROCEDURE = "this procedure is not part of this version"
_LINE = "only planar solids, trusses, beams and springs are part of this version"

#: Cards that change the answer and are refused by name.
UNSUPPORTED: dict[str, str] = {
    "CHANGECONTACTTYPE": _CHANGE,
    "SURFACESMOOTHING": "give round rigid surfaces by *SURFACE, TYPE=SEGMENTS with CIRCL",
    "RIGIDSURFACE": "use *SURFACE, TYPE=SEGMENTS and *RIGID BODY, ANALYTICAL SURFACE=",
    **dict.fromkeys(("CYCLICSYMMETRYMODEL",), _MPC),
    **dict.fromkeys(
        (
            "HEATTRANSFER",
            "CFLUX",
            "DFLUX",
            "DSFLUX",
            "FILM",
            "SFILM",
            "RADIATE",
            "SRADIATE",
            "COUPLEDTEMPERATURE-DISPLACEMENT",
            "UNCOUPLEDTEMPERATURE-DISPLACEMENT",
            "COUPLEDTHERMAL-ELECTRICAL",
            "HEATGENERATION",
        ),
        HEAT,
    ),
    **dict.fromkeys(
        (
            "POROUSELASTIC",
            "JOINTEDMATERIAL",
            "VISCOUS",
            "HYSTERESIS",
            "ORNL",
            "CONCRETETENSIONSTIFFENING",
            "CONCRETECOMPRESSIONHARDENING",
            "BRITTLESHEAR",
            "MOHRCOULOMB",
            "MOHRCOULOMBHARDENING",
            "DRUCKERPRAGERHARDENING",
            "CASTIRONPLASTICITY",
            "CRUSHABLEFOAM",
            "CRUSHABLEFOAMHARDENING",
            "POROUSMETALPLASTICITY",
            "CLAYPLASTICITY",
            "BRITTLECRACKING",
            "EOS",
            "CHANGEPLASTIC",
            "DAMAGEINITIATION",
            "DAMAGEEVOLUTION",
            "UMAT",
            "DRUCKERPRAGER",
            "CAPPLASTICITY",
            "CONCRETE",
            "CONCRETEDAMAGEDPLASTICITY",
            "HYPOELASTIC",
            "SWELLING",
            "NOTENSION",
            "NOCOMPRESSION",
            "SUPERELASTIC",
        ),
        PLASTIC,
    ),
    **dict.fromkeys(
        (
            "GREEN",
            "RESPONSESPECTRUM",
            "RANDOMRESPONSE",
            "ANNEAL",
            "SUBSTRUCTUREPATH",
            "MASSDIFFUSION",
            "SENSITIVITY",
            "CRACKPROPAGATION",
        ),
        PROCEDURE,
    ),
    **dict.fromkeys(
        (
            "FLUIDSECTION",
            "USERELEMENT",
            "USERSECTION",
            "TRUSSSECTION",
            "FRAMESECTION",
        ),
        _LINE,
    ),
    "JOINT": "use a CONN2D2 element, or *SPRING and *DASHPOT between the two nodes",
    "REBARLAYER": "give bars as trusses in *EMBEDDED ELEMENT",
    "REBAR": "give bars as trusses in *EMBEDDED ELEMENT",
    "ANNEALTEMPERATURE": "hardening stays at any temperature: leave the card out below it",
    "LOADCASE": "give each load case a *STEP, PERTURBATION of its own",
    "ENDLOADCASE": "give each load case a *STEP, PERTURBATION of its own",
    "SUBMODEL": "submodels are not part of this version",
    "SUBSTRUCTUREGENERATE": "substructures are not part of this version",
    "CHANGESOLIDSECTION": "sections cannot change between steps",
    "CHANGEMATERIAL": "materials cannot change between steps",
    "NORMAL": "planar elements have no normals of their own",
    "CONNECTORLOCK": "give stops by *GAP",
    "CONNECTORFRICTION": "connectors slide without friction; use *CONTACT PAIR",
    "CONNECTORPLASTICITY": "connectors are elastic: give CONNECTOR ELASTICITY, or a truss",
    "CONNECTORCONSTITUTIVEREFERENCE": "a connector is free of force as it is drawn: move a node",
    "CONNECTORDAMAGEINITIATION": "connectors do not fail",
    "CONNECTORDAMAGEEVOLUTION": "connectors do not fail",
    "CONNECTORFAILURE": "connectors do not fail",
    "COHESIVESECTION": "cohesive elements are not part of this version; join the parts by *TIE",
    "COHESIVEBEHAVIOR": "surfaces with adhesion are not part of this version; use *TIE",
    "GEOSTATIC": "use *STATIC with *INITIAL CONDITIONS, TYPE=STRESS",
    "SOILS": "pore pressure is not part of this version; use *STATIC",
    "INERTIARELIEF": "fix the body by *BOUNDARY in three dofs",
    "BEAMSECTIONGENERATE": "give the numbers by *BEAM GENERAL SECTION",
    "FASTENER": "use *MPC or *COUPLING",
    "VALUESATINFINITY": "it belongs to fluid dynamics",
}

#: Parameters that change the answer and are refused by name.
REFUSED_PARAMETERS: dict[tuple[str, str], str] = {
    ("STATIC", "TOTALTIMEATSTART"): "the total time starts at zero",
    ("BOUNDARY", "USER"): "no user subroutine is called; use *AMPLITUDE",
    ("BOUNDARY", "TIMEDELAY"): "shift the amplitude by SHIFTX",
    ("BOUNDARY", "SUBMODEL"): "submodels are not part of this version",
    ("CLOAD", "USER"): "no user subroutine is called; use *AMPLITUDE",
    ("CLOAD", "TIMEDELAY"): "shift the amplitude by SHIFTX",
    ("CLOAD", "SUBMODEL"): "submodels are not part of this version",
    ("TEMPERATURE", "FILE"): "give the temperatures on data lines",
    ("TEMPERATURE", "USER"): "no user subroutine is called; use *AMPLITUDE",
    ("TEMPERATURE", "TIMEDELAY"): "shift the amplitude by SHIFTX",
    ("TEMPERATURE", "SUBMODEL"): "submodels are not part of this version",
    ("EXPANSION", "USER"): "no user subroutine is called; give a table",
    ("INITIALCONDITIONS", "USER"): "no user subroutine is called; write the values",
    ("DLOAD", "TIMEDELAY"): "shift the amplitude by SHIFTX",
    ("AMPLITUDE", "USER"): "no user subroutine is called; give a table",
    ("NFILL", "SINGULAR"): "move the nodes beside the crack tip by *NODE",
    ("NFILL", "TWOSTEP"): "give BIAS for single intervals",
    ("NGEN", "SYSTEM"): "give the point of the curve in global axes",
    ("NCOPY", "POLE"): "give the center of an arc by *NGEN, LINE=C",
    ("SOLIDSECTION", "COMPOSITE"): "layers are not part of this version",
    ("SHELLSECTION", "COMPOSITE"): "layers are not part of this version",
    ("SPRING", "ORIENTATION"): "give the springs global directions",
    ("SPRING", "COMPLEXSTIFFNESS"): "only real stiffness is part of this version",
    ("FRICTION", "ANISOTROPIC"): "in the plane there is one direction of sliding; leave it out",
    ("FRICTION", "TESTDATA"): "give the static and the kinetic coefficient and the decay",
    ("CHANGEFRICTION", "AMPLITUDE"): "the change is linear over the step (RAMP), or at once",
    ("CHANGEFRICTION", "NSET"): "the friction of all nodes of an interaction is the same",
    ("FRICTION", "USER"): "no user subroutine is called",
    ("DAMPING", "COMPOSITE"): "damping of modes is given by *MODAL DAMPING",
    ("DAMPING", "STRUCTURAL"): "damping is by ALPHA and BETA, and *MODAL DAMPING",
    ("MASS", "ALPHA"): "damping is by ALPHA of *DAMPING of materials, and *DASHPOT",
    ("PLASTIC", "SCALESTRESS"): "give the scaled yield stresses",
    ("GLOBALDAMPING", "STRUCTURAL"): "damping is by ALPHA and BETA, and *MODAL DAMPING",
    ("MODALDAMPING", "STRUCTURAL"): "give fractions of critical damping: half of it at resonance",
    ("MASS", "TYPE"): "a point has the same mass in both directions",
    ("MODALDYNAMIC", "CONTINUE"): "the motion goes on from the step before; leave it out",
    ("CLOAD", "SECTOR"): "cyclic symmetry is not part of this version",
    ("DLOAD", "SECTOR"): "cyclic symmetry is not part of this version",
    ("PLASTIC", "EXTRAPOLATION"): "the last yield stress of a table holds beyond it; add a row",
    ("CLEARANCE", "TABULAR"): "give one VALUE",
    ("TIE", "CYCLICSYMMETRY"): "cyclic symmetry is not part of this version",
    ("TIE", "MULTISTAGE"): "cyclic symmetry is not part of this version",
    **{
        (keyword, "DEPENDENCIES"): "field variables belong to *ELASTIC, *DENSITY, *EXPANSION and "
        "*PLASTIC in this version; give the constants at their values"
        for keyword in ("CYCLICHARDENING", "FRICTION", *LAWS)
    },
}

#: Names and places of output, which change nothing and are not noted.
LABELS = frozenset(
    {
        ("STEP", "NAME"),
        ("OUTPUT", "FIELD"),
        ("OUTPUT", "HISTORY"),
        ("OUTPUT", "NAME"),
        ("ELEMENTOUTPUT", "DIRECTIONS"),
        ("COUPLING", "CONSTRAINTNAME"),
    }
)

#: Values of parameters without effect; others of the same parameter are refused.
WITHOUT_EFFECT: dict[tuple[str, str], str] = {
    ("DAMPING", "COMPOSITE"): "0",
    ("DAMPING", "STRUCTURAL"): "0",
    ("MASS", "ALPHA"): "0",
    ("MASS", "COMPOSITE"): "0",
    ("ROTARYINERTIA", "ALPHA"): "0",
    ("PLASTIC", "EXTRAPOLATION"): "CONSTANT",
    ("PLASTIC", "SCALESTRESS"): "1",
    ("MASS", "TYPE"): "ISOTROPIC",
    ("MODALDYNAMIC", "CONTINUE"): "NO",
    ("CLOAD", "SECTOR"): "1",
    ("DLOAD", "SECTOR"): "1",
    **{(keyword, "DEPENDENCIES"): "0" for keyword in ("CYCLICHARDENING", "FRICTION", *LAWS)},
    ("RATEDEPENDENT", "EXTRAPOLATION"): "CONSTANT",
}

"""The table of keywords: one function and one entry each."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from corota.io.deck.cards import amplitudes as amplitudes
from corota.io.deck.cards import assembly as assembly
from corota.io.deck.cards import attachments as attachments
from corota.io.deck.cards import contact as contact
from corota.io.deck.cards import dynamic as dynamic
from corota.io.deck.cards import generate as generate
from corota.io.deck.cards import lines as lines
from corota.io.deck.cards import loads as loads
from corota.io.deck.cards import material as material
from corota.io.deck.cards import mesh as mesh
from corota.io.deck.cards import output as output
from corota.io.deck.cards import path as path
from corota.io.deck.cards import plastic as plastic
from corota.io.deck.cards import pretension as pretension
from corota.io.deck.cards import step as step
from corota.io.deck.cards import supports as supports
from corota.io.deck.cards import thermal as thermal
from corota.io.deck.cards import tie as tie
from corota.io.deck.deck import nearest
from corota.io.deck.lexer import key

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card


@dataclass(frozen=True, slots=True)
class Keyword:
    """Function of a keyword, and its parameters.

    Parameters
    ----------
    function : callable
        Reads the card into the deck.
    parameters : str
        Names that are used, blank-separated, themselves without blanks.
    ignored : str
        Names that are accepted and have no effect here; each is noted.
    place : {"model", "step", "any"}
        Where the card is allowed.
    """

    function: Callable[[Deck, Card], None]
    parameters: str = ""
    ignored: str = ""
    place: str = "any"


def heading(deck: Deck, card: Card) -> None:
    """``*HEADING``: free text."""
    deck.heading += [row.text.strip() for row in card.rows()]


def parameter(deck: Deck, card: Card) -> None:
    """``*PARAMETER``: its values are already substituted in the text."""


_PRINT = "TOTALS FREQUENCY FREQUENCYF TIMEPOINTS"
_FILE = "FREQUENCY FREQUENCYF TIMEPOINTS"
_FILE_IGNORED = (
    "GLOBAL OUTPUT LASTITERATIONS CONTACTELEMENTS OUTPUTALL POSITION DIRECTIONS SECTIONFORCES "
    "VARIABLE SUMMARY"
)

KEYWORDS: dict[str, Keyword] = {
    "HEADING": Keyword(heading, ignored="UNITS"),
    "PARAMETER": Keyword(parameter, ignored="DEPENDENT INDEPENDENT"),
    "NODE": Keyword(mesh.node, "NSET SYSTEM", place="model"),
    "NGEN": Keyword(generate.ngen, "NSET LINE", place="model"),
    "NFILL": Keyword(generate.nfill, "NSET BIAS", place="model"),
    "NCOPY": Keyword(
        generate.ncopy, "CHANGENUMBER OLDSET NEWSET SHIFT MULTIPLE REFLECT", place="model"
    ),
    "ELGEN": Keyword(generate.elgen, "ELSET", place="model"),
    "ELCOPY": Keyword(
        generate.elcopy, "ELEMENTSHIFT OLDSET NEWSET SHIFTNODES", "REFLECT", place="model"
    ),
    "SYSTEM": Keyword(generate.system, place="model"),
    "ELEMENT": Keyword(mesh.element, "TYPE ELSET", place="model"),
    "NSET": Keyword(mesh.nset, "NSET GENERATE ELSET INSTANCE INTERNAL UNSORTED", place="model"),
    "ELSET": Keyword(mesh.elset, "ELSET GENERATE INSTANCE INTERNAL", place="model"),
    "SURFACE": Keyword(
        mesh.surface,
        "NAME TYPE INTERNAL FILLETRADIUS COMBINE",
        "REGIONTYPE TRIM MAXRATIO",
        place="model",
    ),
    "MATERIAL": Keyword(material.material, "NAME", place="model"),
    "ELASTIC": Keyword(material.elastic, "TYPE", "MODULI", place="model"),
    "DEFORMATIONPLASTICITY": Keyword(material.deformation_plasticity, place="model"),
    "DENSITY": Keyword(material.density, place="model"),
    "EXPANSION": Keyword(thermal.expansion, "TYPE ZERO", place="model"),
    "PLASTIC": Keyword(plastic.plastic, "HARDENING DATATYPE NUMBERBACKSTRESSES", place="model"),
    "CYCLICHARDENING": Keyword(plastic.cyclic_hardening, "PARAMETERS", place="model"),
    "SOLIDSECTION": Keyword(
        material.solid_section,
        "ELSET MATERIAL ORIENTATION PLANE LOCALSTRAIN DILATATION BETA0 NODALTHICKNESS",
        "CONTROLS OFFSET REFNODE",
        place="model",
    ),
    "SHELLSECTION": Keyword(
        material.shell_section,
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "OFFSET CONTROLS POISSON SECTIONINTEGRATION TEMPERATURE DENSITY THICKNESSMODULUS ZERO",
        place="model",
    ),
    "NODALTHICKNESS": Keyword(material.nodal_thickness, place="model"),
    "MEMBRANESECTION": Keyword(
        material.shell_section,
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "CONTROLS POISSON",
        place="model",
    ),
    "BEAMSECTION": Keyword(
        lines.beam_section,
        "ELSET MATERIAL SECTION OFFSET1 OFFSET2 TEMPERATURE POISSON",
        "LUMP ROTARYINERTIA CONTROLS ORIENTATION",
        place="model",
    ),
    "BEAMGENERALSECTION": Keyword(
        lines.beam_general_section,
        "ELSET SECTION DENSITY OFFSET1 OFFSET2",
        "POISSON LUMP ROTARYINERTIA ZERO",
        place="model",
    ),
    "SPRING": Keyword(lines.spring, "ELSET NONLINEAR", place="model"),
    "ORIENTATION": Keyword(material.orientation, "NAME SYSTEM", "DEFINITION", place="model"),
    "AMPLITUDE": Keyword(
        amplitudes.amplitude,
        "NAME TIME SHIFTX SHIFTY DEFINITION VALUE FIXEDINTERVAL BEGIN",
        "SMOOTH",
    ),
    "TIMEPOINTS": Keyword(amplitudes.time_points, "NAME TIME GENERATE"),
    "STEP": Keyword(
        step.step,
        "NLGEOM INC AMPLITUDE PERTURBATION",
        "NAME UNSYMM EXTRAPOLATION SOLVER CONVERTSDI",
    ),
    "ENDSTEP": Keyword(step.end_step),
    "STATIC": Keyword(
        path.static,
        "DIRECT RIKS STABILIZE",
        "SOLVER TIMERESET ALLSDTOL CONTINUE FACTOR ADIABATIC LONGTERM",
    ),
    "BUCKLE": Keyword(path.buckle, "", "SOLVER EIGENSOLVER"),
    "CONTROLS": Keyword(path.controls, "PARAMETERS RESET", "ANALYSIS TYPE"),
    "DYNAMIC": Keyword(
        dynamic.dynamic,
        "ALPHA BETA GAMMA DIRECT EXPLICIT APPLICATION SCHEME",
        "SOLVER RELATIVETOABSOLUTE NOHAF HAFTOL HALFINCSCALEFACTOR INITIAL IMPACT SCALEFACTOR "
        "ELEMENTBYELEMENT INCREMENTATION ADIABATIC IMPROVEDDTMETHOD",
    ),
    "COMPLEXFREQUENCY": Keyword(dynamic.complex_frequency, "CORIOLIS", "SOLVER STORAGE"),
    "FREQUENCY": Keyword(
        dynamic.frequency,
        "",
        "SOLVER STORAGE EIGENSOLVER NORMALIZATION ACOUSTICCOUPLING RESIDUALMODES "
        "NUMBERINTERVAL SIM",
    ),
    "MODALDYNAMIC": Keyword(dynamic.modal_dynamic, "", "SOLVER DIRECT"),
    "STEADYSTATEDYNAMICS": Keyword(
        dynamic.steady_state, "DIRECT", "SOLVER FREQUENCYSCALE INTERVAL FRICTIONDAMPING"
    ),
    "MODALDAMPING": Keyword(dynamic.modal_damping, "RAYLEIGH", "MODAL"),
    "DAMPING": Keyword(dynamic.damping, "ALPHA BETA", place="model"),
    "MASS": Keyword(attachments.mass, "ELSET", place="model"),
    "DASHPOT": Keyword(attachments.dashpot, "ELSET", place="model"),
    "INITIALCONDITIONS": Keyword(dynamic.initial_conditions, "TYPE", place="model"),
    "EQUATION": Keyword(tie.equation, place="model"),
    "MPC": Keyword(tie.mpc, place="model"),
    "RIGIDBODY": Keyword(
        tie.rigid_body,
        "NSET ELSET ANALYTICALSURFACE REFNODE ROTNODE PINNSET TIENSET",
        "POSITION ISOTHERMAL",
        place="model",
    ),
    "COUPLING": Keyword(
        tie.coupling, "REFNODE SURFACE INFLUENCERADIUS", "CONSTRAINTNAME", place="model"
    ),
    "KINEMATICCOUPLING": Keyword(tie.kinematic_coupling, "REFNODE", place="model"),
    "DISTRIBUTINGCOUPLING": Keyword(tie.distributing_coupling, "ELSET", place="model"),
    "KINEMATIC": Keyword(tie.kinematic, place="model"),
    "DISTRIBUTING": Keyword(tie.distributing, "WEIGHTINGMETHOD", ignored="COUPLING", place="model"),
    "PRE-TENSIONSECTION": Keyword(
        pretension.pretension, "SURFACE ELEMENT NODE", "NAME", place="model"
    ),
    "TRANSFORM": Keyword(tie.transform, "NSET TYPE", place="model"),
    "CONTACTPAIR": Keyword(
        contact.contact_pair,
        "INTERACTION TYPE ADJUST SMALLSLIDING SMOOTH",
        "EXTENSIONZONE HCRIT TRACKING NOTHICKNESS SUPPLEMENTARYCONSTRAINTS OP WEIGHT CPSET "
        "MECHANICALCONSTRAINT GEOMETRICCORRECTION MINIMUMDISTANCE",
        place="model",
    ),
    "CONTACT": Keyword(contact.general, "", "OP", place="model"),
    "CONTACTINCLUSIONS": Keyword(contact.inclusions, "ALLEXTERIOR", place="model"),
    "CONTACTPROPERTYASSIGNMENT": Keyword(contact.property_assignment, place="model"),
    "CONTACTFORMULATION": Keyword(contact.formulation, "TYPE", place="model"),
    "SURFACEPROPERTYASSIGNMENT": Keyword(contact.formulation, "PROPERTY", place="model"),
    "SURFACEINTERACTION": Keyword(
        contact.surface_interaction,
        "NAME",
        "DEPVAR PROPERTIES UNSYMM PADTHICKNESS TRACKINGTHICKNESS",
        place="model",
    ),
    "SURFACEBEHAVIOR": Keyword(
        contact.surface_behavior,
        "PRESSURE-OVERCLOSURE",
        "AUGMENTEDLAGRANGE DIRECT PENALTY",
        place="model",
    ),
    "FRICTION": Keyword(contact.friction, "", "SLIPTOLERANCE LAGRANGE ELASTICSLIP", place="model"),
    "CLEARANCE": Keyword(contact.clearance, "SLAVE MASTER VALUE", place="model"),
    "TIE": Keyword(
        contact.tie, "NAME POSITIONTOLERANCE ADJUST", "TYPE NOROTATION NOTHICKNESS", place="model"
    ),
    "CONTACTCONTROLS": Keyword(
        contact.contact_controls,
        "STABILIZE SLAVE MASTER",
        "RESET AUTOMATICTOLERANCES APPROACH MAXCHP PERRMX UERRMX FRICTIONONSET TANGENTFRACTION "
        "LAGRANGEMULTIPLIER",
    ),
    "CONTACTINTERFERENCE": Keyword(contact.contact_interference, "SHRINK", "TYPE OP"),
    "CONTACTPRINT": Keyword(
        output.contact_print,
        "SLAVE MASTER TOTALS FREQUENCY FREQUENCYF TIMEPOINTS",
        "SUMMARY NSET",
    ),
    "CONTACTFILE": Keyword(output.contact_file, _FILE, "NSET SLAVE MASTER"),
    "CONTACTOUTPUT": Keyword(
        output.contact_file,
        _FILE,
        "NSET SLAVE MASTER VARIABLE CPSET SURFACE",
    ),
    "BOUNDARY": Keyword(supports.boundary, "OP AMPLITUDE TYPE LOADCASE FIXED", "REGIONTYPE"),
    "CLOAD": Keyword(loads.cload, "OP AMPLITUDE LOADCASE FOLLOWER", "REGIONTYPE"),
    "DLOAD": Keyword(loads.dload, "OP AMPLITUDE LOADCASE FOLLOWER", "REGIONTYPE CONSTANTRESULTANT"),
    "DSLOAD": Keyword(
        loads.dsload, "OP AMPLITUDE FOLLOWER LOADCASE", "REGIONTYPE CONSTANTRESULTANT"
    ),
    "TEMPERATURE": Keyword(thermal.temperature, "OP AMPLITUDE", "LOADCASE"),
    "NODEPRINT": Keyword(output.node_print, f"NSET {_PRINT} GLOBAL", "SUMMARY"),
    "ELPRINT": Keyword(output.el_print, f"ELSET {_PRINT}", "GLOBAL POSITION SUMMARY"),
    "NODEFILE": Keyword(output.node_file, f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "NODEOUTPUT": Keyword(output.node_file, f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "ELFILE": Keyword(output.el_file, f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "ELEMENTOUTPUT": Keyword(output.el_file, f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "RESTART": Keyword(output.restart, "WRITE READ FREQUENCY STEP INC ENDSTEP JOB", "OVERLAY"),
    "OUTPUT": Keyword(
        output.output,
        "FREQUENCY FREQUENCYF VARIABLE",
        "FIELD HISTORY NAME OP NUMBERINTERVAL TIMEMARKS TIMEINTERVAL TIMEPOINTS",
    ),
    "PART": Keyword(assembly.part, "NAME", place="model"),
    "ENDPART": Keyword(assembly.end_part, place="model"),
    "ASSEMBLY": Keyword(assembly.assembly, "NAME", place="model"),
    "ENDASSEMBLY": Keyword(assembly.end_assembly, place="model"),
    "INSTANCE": Keyword(assembly.instance, "NAME PART", place="model"),
    "ENDINSTANCE": Keyword(assembly.end_instance, place="model"),
}

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
    "USERSUBROUTINE": "no user subroutine is called",
    **dict.fromkeys(
        (
            "CONDUCTIVITY",
            "SPECIFICHEAT",
            "LATENTHEAT",
            "PHYSICALCONSTANTS",
            "INELASTICHEATFRACTION",
            "JOULEHEATFRACTION",
            "ELECTRICALCONDUCTIVITY",
        ),
        "it contains no stresses; temperatures are given by *TEMPERATURE",
    ),
    **dict.fromkeys(
        (
            "SECTIONPRINT",
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

_CONTACT = "name the pairs of surfaces by *CONTACT PAIR with a *SURFACE INTERACTION"
_CHANGE = "contact pairs and their interactions apply to all steps"
_MPC = "use *EQUATION, *RIGID BODY, or *COUPLING with *KINEMATIC or *DISTRIBUTING"
_HEAT = "heat conduction is not part of this version; give temperatures by *TEMPERATURE"
_PLASTIC = "the material laws are *ELASTIC, *PLASTIC and *DEFORMATION PLASTICITY; use these"
_RUBBER = (
    "use *ELASTIC with E = 3 G, G the initial shear modulus (Neo-Hooke: G = 2 C10, Mooney-Rivlin: "
    "G = 2 (C10 + C01)), a Poisson's ratio of 0.45 to 0.499, PLANE=STRAIN and LOCAL "
    "STRAIN=LOGARITHMIC in *SOLID SECTION, and elements Q4S; that is good up to moderate strains. "
    "In Python a law of your own is a UserMaterial"
)
_PROCEDURE = "this procedure is not part of this version"
_LINE = "only planar solids, trusses, beams and springs are part of this version"

#: Cards that change the answer and are refused by name.
UNSUPPORTED: dict[str, str] = {
    **dict.fromkeys(
        (
            "CONTACTEXCLUSIONS",
            "CONTACTINITIALIZATIONDATA",
            "CONTACTINITIALIZATIONASSIGNMENT",
            "GAP",
        ),
        _CONTACT,
    ),
    **dict.fromkeys(
        ("CHANGEFRICTION", "CHANGECONTACTTYPE", "CHANGESURFACEBEHAVIOR", "MODELCHANGE"), _CHANGE
    ),
    "CONTACTDAMPING": "contact has no damping of its own; damp the bodies by *DAMPING",
    "SURFACESMOOTHING": "give round rigid surfaces by *SURFACE, TYPE=SEGMENTS with CIRCL",
    "RIGIDSURFACE": "use *SURFACE, TYPE=SEGMENTS and *RIGID BODY, ANALYTICAL SURFACE=",
    **dict.fromkeys(
        (
            "EMBEDDEDELEMENT",
            "CYCLICSYMMETRYMODEL",
        ),
        _MPC,
    ),
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
        _HEAT,
    ),
    **dict.fromkeys(("HYPERELASTIC", "HYPERFOAM"), _RUBBER),
    **dict.fromkeys(
        (
            "CREEP",
            "RATEDEPENDENT",
            "DEPVAR",
            "USERMATERIAL",
            "MOHRCOULOMB",
            "CHANGEPLASTIC",
            "VISCOELASTIC",
            "DAMAGEINITIATION",
            "DAMAGEEVOLUTION",
            "UMAT",
            "DRUCKERPRAGER",
            "CAPPLASTICITY",
            "CONCRETE",
            "CONCRETEDAMAGEDPLASTICITY",
            "HYPOELASTIC",
            "SWELLING",
            "POTENTIAL",
            "NOTENSION",
            "NOCOMPRESSION",
            "SUPERELASTIC",
        ),
        _PLASTIC,
    ),
    **dict.fromkeys(
        (
            "VISCO",
            "GREEN",
            "SENSITIVITY",
            "CRACKPROPAGATION",
        ),
        _PROCEDURE,
    ),
    **dict.fromkeys(
        (
            "FLUIDSECTION",
            "USERELEMENT",
            "USERSECTION",
            "ROTARYINERTIA",
            "TRUSSSECTION",
        ),
        _LINE,
    ),
    "SUBMODEL": "submodels are not part of this version",
    "SUBSTRUCTUREGENERATE": "substructures are not part of this version",
    "CHANGESOLIDSECTION": "sections cannot change between steps",
    "CHANGEMATERIAL": "materials cannot change between steps",
    "DISTRIBUTION": "values given by element are not part of this version",
    "NORMAL": "planar elements have no normals of their own",
    "CONNECTORSECTION": "use *MPC, *EQUATION or *COUPLING",
    "COHESIVESECTION": "cohesive elements are not part of this version; join the parts by *TIE",
    "COHESIVEBEHAVIOR": "surfaces with adhesion are not part of this version; use *TIE",
    "GEOSTATIC": "use *STATIC with *INITIAL CONDITIONS, TYPE=STRESS",
    "SOILS": "pore pressure is not part of this version; use *STATIC",
    "FIXEDMASSSCALING": "there is no mass scaling: the stable increment is found automatically",
    "VARIABLEMASSSCALING": "there is no mass scaling: the stable increment is found automatically",
    "IMPERFECTION": "give the imperfect coordinates by *NODE",
    "FIELD": "fields are not part of this version; give temperatures by *TEMPERATURE",
    "INERTIARELIEF": "fix the body by *BOUNDARY in three dofs",
    "BASEMOTION": "prescribe the motion by *BOUNDARY with an amplitude",
    "BEAMSECTIONGENERATE": "give the numbers by *BEAM GENERAL SECTION",
    "FASTENER": "use *MPC or *COUPLING",
    "RELEASE": "join only the displacements of two nodes by *MPC, PIN",
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
    ("SURFACEBEHAVIOR", "NOSEPARATION"): "surfaces in contact may separate; join them by *TIE",
    ("FRICTION", "ROUGH"): "give a large friction coefficient",
    ("FRICTION", "ANISOTROPIC"): "friction has one coefficient",
    ("FRICTION", "EXPONENTIALDECAY"): "friction has one coefficient",
    ("FRICTION", "TAUMAX"): "there is no separate limit of the shear traction",
    ("FRICTION", "USER"): "no user subroutine is called",
    ("CLEARANCE", "TABULAR"): "give one VALUE",
    ("TIE", "CYCLICSYMMETRY"): "cyclic symmetry is not part of this version",
    ("TIE", "MULTISTAGE"): "cyclic symmetry is not part of this version",
    **{
        (keyword, "DEPENDENCIES"): "field variables are not part of this version; constants may "
        "depend on the temperature alone"
        for keyword in (
            "ELASTIC",
            "DENSITY",
            "EXPANSION",
            "PLASTIC",
            "CYCLICHARDENING",
            "DEFORMATIONPLASTICITY",
        )
    },
}


def interpret(deck: Deck, card: Card) -> None:
    """Read one card into the deck."""
    entry = KEYWORDS.get(card.keyword)
    if entry is None:
        _unknown(deck, card)
        return
    known = set(entry.parameters.split())
    ignored = set(entry.ignored.split())
    refused = {name for keyword, name in REFUSED_PARAMETERS if keyword == card.keyword}
    card.scope = deck.scope
    _spell_out(card, known | ignored | refused)
    for name, parameter in card.parameters.items():
        if name in known:
            continue
        if name in ignored:
            deck.note(f"{card.where}: {card.spelled}: {parameter.name} is ignored")
            continue
        place = type(card.where)(card.where.file, card.where.line, parameter.column)
        reason = REFUSED_PARAMETERS.get((card.keyword, name))
        if reason:
            deck.error(card, place, f"{parameter.name} is not supported", hint=reason)
        elif deck.lenient:
            deck.warning(card, place, f"unknown parameter {parameter.name} is ignored")
        else:
            hint = nearest(name, known | ignored)
            deck.error(card, place, f"unknown parameter {parameter.name}", hint=hint)
    if entry.place == "model" and deck.step is not None:
        deck.error(
            card,
            card.where,
            f"{card.spelled} inside a step",
            hint="model data stand before the first *STEP",
        )
        return
    entry.function(deck, card)


def _spell_out(card: Card, words: set[str]) -> None:
    """Give abbreviated parameters (``GEN``, ``FREQ``) their full names, where one fits."""
    for name in [n for n in card.parameters if n not in words and len(n) > 2]:
        fits = sorted((w for w in words if w.startswith(name)), key=len)
        if fits and all(w.startswith(fits[0]) for w in fits) and fits[0] not in card.parameters:
            card.parameters[fits[0]] = card.parameters.pop(name)


def _unknown(deck: Deck, card: Card) -> None:
    if card.keyword.startswith("HEADING"):
        deck.heading.append(card.text.strip()[len("*HEADING") :].strip())
        heading(deck, card)
        return
    if card.keyword in IGNORED:
        deck.note(f"{card.where}: {card.spelled} is ignored: {IGNORED[card.keyword]}")
        return
    if card.keyword in UNSUPPORTED:
        _answered(deck, card, UNSUPPORTED[card.keyword])
        deck.error(card, card.where, "the card is not supported", hint=UNSUPPORTED[card.keyword])
        return
    hint = nearest(card.keyword, [*KEYWORDS, *IGNORED, *UNSUPPORTED, "INCLUDE"])
    if deck.lenient:
        deck.warning(card, card.where, f"unknown keyword {card.spelled} is ignored", hint=hint)
    else:
        deck.error(card, card.where, f"unknown keyword {card.spelled[:60]}", hint=_pretty(hint))


def _answered(deck: Deck, card: Card, why: str) -> None:
    """Mark the data of a refused card: it is not reported as missing again."""
    if deck.material is not None and why in (_PLASTIC, _RUBBER) and not deck.material.law:
        deck.material.law = "REFUSED"
    if deck.step is not None and why in (_PROCEDURE, _HEAT) and deck.step.procedure is None:
        deck.step.procedure = card


def _pretty(hint: str) -> str:
    """Hint with the usual spelling: ``*END STEP`` for ``ENDSTEP``."""
    for plain in (*KEYWORDS, *IGNORED, *UNSUPPORTED, "INCLUDE"):
        if hint == f"did you mean {plain}?":
            return f"did you mean *{SPELLED.get(plain, plain)}?"
    return hint


SPELLED = {
    key(name): name
    for name in (
        "SOLID SECTION",
        "SHELL SECTION",
        "TIME POINTS",
        "END STEP",
        "NODE PRINT",
        "EL PRINT",
        "NODE FILE",
        "NODE OUTPUT",
        "EL FILE",
        "ELEMENT OUTPUT",
        "END PART",
        "END ASSEMBLY",
        "END INSTANCE",
        "CONTACT PAIR",
        "BEAM SECTION",
        "RIGID BODY",
        "SURFACE INTERACTION",
        "SURFACE BEHAVIOR",
        "CONTACT PRINT",
        "CONTACT FILE",
        "CONTACT OUTPUT",
        "CONTACT CONTROLS",
        "CONTACT INTERFERENCE",
        "INITIAL CONDITIONS",
        "SECTION PRINT",
        "NODAL THICKNESS",
        "DEFORMATION PLASTICITY",
    )
}

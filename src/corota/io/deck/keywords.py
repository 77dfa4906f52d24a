"""The table of keywords: one function and one entry each."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from corota.data_classes import dataclass
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
from corota.io.deck.laws import LAWS
from corota.io.deck.lexer import key

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card


@dataclass(frozen=True)
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

#: Keywords by their usual spelling.
_TABLE: dict[str, Keyword] = {
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
    # Laws with a card of their own.
    **{
        law.card: Keyword(partial(material.constants, law=name), place="model")
        for name, law in LAWS.items()
        if key(law.card) == name
    },
    "DENSITY": Keyword(material.density, place="model"),
    "EXPANSION": Keyword(thermal.expansion, "TYPE ZERO", place="model"),
    "PLASTIC": Keyword(plastic.plastic, "HARDENING DATATYPE NUMBERBACKSTRESSES", place="model"),
    "CYCLIC HARDENING": Keyword(plastic.cyclic_hardening, "PARAMETERS", place="model"),
    "SOLID SECTION": Keyword(
        material.solid_section,
        "ELSET MATERIAL ORIENTATION PLANE LOCALSTRAIN DILATATION BETA0 NODALTHICKNESS",
        "CONTROLS OFFSET REFNODE",
        place="model",
    ),
    "SHELL SECTION": Keyword(
        material.shell_section,
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "OFFSET CONTROLS POISSON SECTIONINTEGRATION TEMPERATURE DENSITY THICKNESSMODULUS ZERO",
        place="model",
    ),
    "NODAL THICKNESS": Keyword(material.nodal_thickness, place="model"),
    "MEMBRANE SECTION": Keyword(
        material.shell_section,
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "CONTROLS POISSON",
        place="model",
    ),
    "BEAM SECTION": Keyword(
        lines.beam_section,
        "ELSET MATERIAL SECTION OFFSET1 OFFSET2 TEMPERATURE POISSON",
        "LUMP ROTARYINERTIA CONTROLS ORIENTATION",
        place="model",
    ),
    "BEAM GENERAL SECTION": Keyword(
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
    "TIME POINTS": Keyword(amplitudes.time_points, "NAME TIME GENERATE"),
    "STEP": Keyword(
        step.step,
        "NLGEOM INC AMPLITUDE PERTURBATION",
        "NAME UNSYMM EXTRAPOLATION SOLVER CONVERTSDI",
    ),
    "END STEP": Keyword(step.end_step),
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
    "COMPLEX FREQUENCY": Keyword(dynamic.complex_frequency, "CORIOLIS", "SOLVER STORAGE"),
    "FREQUENCY": Keyword(
        dynamic.frequency,
        "",
        "SOLVER STORAGE EIGENSOLVER NORMALIZATION ACOUSTICCOUPLING RESIDUALMODES "
        "NUMBERINTERVAL SIM",
    ),
    "MODAL DYNAMIC": Keyword(dynamic.modal_dynamic, "", "SOLVER DIRECT"),
    "STEADY STATE DYNAMICS": Keyword(
        dynamic.steady_state, "DIRECT", "SOLVER FREQUENCYSCALE INTERVAL FRICTIONDAMPING"
    ),
    "MODAL DAMPING": Keyword(dynamic.modal_damping, "RAYLEIGH", "MODAL"),
    "DAMPING": Keyword(dynamic.damping, "ALPHA BETA", place="model"),
    "MASS": Keyword(attachments.mass, "ELSET", place="model"),
    "DASHPOT": Keyword(attachments.dashpot, "ELSET", place="model"),
    "INITIAL CONDITIONS": Keyword(dynamic.initial_conditions, "TYPE", place="model"),
    "EQUATION": Keyword(tie.equation, place="model"),
    "MPC": Keyword(tie.mpc, place="model"),
    "RIGID BODY": Keyword(
        tie.rigid_body,
        "NSET ELSET ANALYTICALSURFACE REFNODE ROTNODE PINNSET TIENSET",
        "POSITION ISOTHERMAL",
        place="model",
    ),
    "COUPLING": Keyword(
        tie.coupling, "REFNODE SURFACE INFLUENCERADIUS", "CONSTRAINTNAME", place="model"
    ),
    "KINEMATIC COUPLING": Keyword(tie.kinematic_coupling, "REFNODE", place="model"),
    "DISTRIBUTING COUPLING": Keyword(tie.distributing_coupling, "ELSET", place="model"),
    "KINEMATIC": Keyword(tie.kinematic, place="model"),
    "DISTRIBUTING": Keyword(tie.distributing, "WEIGHTINGMETHOD", ignored="COUPLING", place="model"),
    "PRE-TENSION SECTION": Keyword(
        pretension.pretension, "SURFACE ELEMENT NODE", "NAME", place="model"
    ),
    "TRANSFORM": Keyword(tie.transform, "NSET TYPE", place="model"),
    "CONTACT PAIR": Keyword(
        contact.contact_pair,
        "INTERACTION TYPE ADJUST SMALLSLIDING SMOOTH",
        "EXTENSIONZONE HCRIT TRACKING NOTHICKNESS SUPPLEMENTARYCONSTRAINTS OP WEIGHT CPSET "
        "MECHANICALCONSTRAINT GEOMETRICCORRECTION MINIMUMDISTANCE",
        place="model",
    ),
    "CONTACT": Keyword(contact.general, "", "OP", place="model"),
    "CONTACT INCLUSIONS": Keyword(contact.inclusions, "ALLEXTERIOR", place="model"),
    "CONTACT PROPERTY ASSIGNMENT": Keyword(contact.property_assignment, place="model"),
    "CONTACT FORMULATION": Keyword(contact.formulation, "TYPE", place="model"),
    "SURFACE PROPERTY ASSIGNMENT": Keyword(contact.formulation, "PROPERTY", place="model"),
    "SURFACE INTERACTION": Keyword(
        contact.surface_interaction,
        "NAME",
        "DEPVAR PROPERTIES UNSYMM PADTHICKNESS TRACKINGTHICKNESS",
        place="model",
    ),
    "SURFACE BEHAVIOR": Keyword(
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
    "CONTACT CONTROLS": Keyword(
        contact.contact_controls,
        "STABILIZE SLAVE MASTER",
        "RESET AUTOMATICTOLERANCES APPROACH MAXCHP PERRMX UERRMX FRICTIONONSET TANGENTFRACTION "
        "LAGRANGEMULTIPLIER",
    ),
    "CONTACT INTERFERENCE": Keyword(contact.contact_interference, "SHRINK", "TYPE OP"),
    "CONTACT PRINT": Keyword(
        output.contact_print,
        "SLAVE MASTER TOTALS FREQUENCY FREQUENCYF TIMEPOINTS",
        "SUMMARY NSET",
    ),
    "CONTACT FILE": Keyword(output.contact_file, _FILE, "NSET SLAVE MASTER"),
    "CONTACT OUTPUT": Keyword(
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
    "NODE PRINT": Keyword(output.node_print, f"NSET {_PRINT} GLOBAL", "SUMMARY"),
    "EL PRINT": Keyword(output.el_print, f"ELSET {_PRINT}", "GLOBAL POSITION SUMMARY"),
    "NODE FILE": Keyword(output.node_file, f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "NODE OUTPUT": Keyword(output.node_file, f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "EL FILE": Keyword(output.el_file, f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "ELEMENT OUTPUT": Keyword(output.el_file, f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "RESTART": Keyword(output.restart, "WRITE READ FREQUENCY STEP INC ENDSTEP JOB", "OVERLAY"),
    "OUTPUT": Keyword(
        output.output,
        "FREQUENCY FREQUENCYF VARIABLE",
        "FIELD HISTORY NAME OP NUMBERINTERVAL TIMEMARKS TIMEINTERVAL TIMEPOINTS",
    ),
    "PART": Keyword(assembly.part, "NAME", place="model"),
    "END PART": Keyword(assembly.end_part, place="model"),
    "ASSEMBLY": Keyword(assembly.assembly, "NAME", place="model"),
    "END ASSEMBLY": Keyword(assembly.end_assembly, place="model"),
    "INSTANCE": Keyword(assembly.instance, "NAME PART", place="model"),
    "END INSTANCE": Keyword(assembly.end_instance, place="model"),
}

KEYWORDS: dict[str, Keyword] = {key(name): keyword for name, keyword in _TABLE.items()}

#: Usual spelling of names of several words.
SPELLED = {key(name): name for name in (*_TABLE, "SECTION PRINT")}

__all__ = ["KEYWORDS", "SPELLED", "Keyword"]

"""The table of keywords: one function and one entry each."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from corota.io.deck.card import Card, key
from corota.io.deck.laws import LAWS
from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.io.deck.deck import Deck


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


def card(place: str) -> Callable[..., None]:
    """Function of a module of :mod:`corota.io.deck.cards`, which is loaded at its first card.

    Parameters
    ----------
    place : str
        ``"module.function"``.
    """
    return lazy(f"corota.io.deck.cards.{place.replace('.', ':')}")


def anywhere(place: str, parameters: str = "", ignored: str = "") -> Keyword:
    """Keyword of model and steps, by the place of its function."""
    return Keyword(card(place), parameters, ignored)


def of_model(place: str, parameters: str = "", ignored: str = "") -> Keyword:
    """Keyword that stands before the steps, by the place of its function."""
    return Keyword(card(place), parameters, ignored, "model")


def heading(deck: Deck, card: Card) -> None:
    """``*HEADING``: free text."""
    deck.heading += [row.text.strip() for row in card.rows()]


def parameter(deck: Deck, card: Card) -> None:
    """``*PARAMETER``: its values are already substituted in the text."""


_PRINT = "TOTALS FREQUENCY FREQUENCYF TIMEPOINTS"
_PRINT_IGNORED = "SUMMARY LASTITERATIONS CONTACTELEMENTS"
_FILE = "FREQUENCY FREQUENCYF TIMEPOINTS"
_FILE_IGNORED = (
    "GLOBAL OUTPUT LASTITERATIONS CONTACTELEMENTS OUTPUTALL POSITION DIRECTIONS SECTIONFORCES "
    "VARIABLE SUMMARY"
)

#: Keywords by their usual spelling.
_TABLE: dict[str, Keyword] = {
    "HEADING": Keyword(heading, ignored="UNITS"),
    "PARAMETER": Keyword(parameter, ignored="DEPENDENT INDEPENDENT"),
    "NODE": of_model("mesh.node", "NSET SYSTEM"),
    "NGEN": of_model("generate.ngen", "NSET LINE"),
    "NFILL": of_model("generate.nfill", "NSET BIAS"),
    "NCOPY": of_model("generate.ncopy", "CHANGENUMBER OLDSET NEWSET SHIFT MULTIPLE REFLECT"),
    "ELGEN": of_model("generate.elgen", "ELSET"),
    "ELCOPY": of_model("generate.elcopy", "ELEMENTSHIFT OLDSET NEWSET SHIFTNODES", "REFLECT"),
    "SYSTEM": of_model("generate.system"),
    "ELEMENT": of_model("mesh.element", "TYPE ELSET"),
    "NSET": anywhere("mesh.nset", "NSET GENERATE ELSET INSTANCE INTERNAL UNSORTED"),
    "ELSET": anywhere("mesh.elset", "ELSET GENERATE INSTANCE INTERNAL"),
    "SURFACE": of_model(
        "mesh.surface", "NAME TYPE INTERNAL FILLETRADIUS COMBINE", "REGIONTYPE TRIM MAXRATIO"
    ),
    "MATERIAL": of_model("material.material", "NAME"),
    "ELASTIC": of_model("material.elastic", "TYPE MODULI DEPENDENCIES"),
    # Laws with a card of their own.
    **{
        law.card: Keyword(partial(card("material.constants"), law=name), place="model")
        for name, law in LAWS.items()
        if key(law.card) == name
    },
    "HYPERELASTIC": of_model(
        "hyperelastic.hyperelastic",
        "NEOHOOKE MOONEY-RIVLIN YEOH ARRUDA-BOYCE POLYNOMIAL REDUCEDPOLYNOMIAL OGDEN N "
        "TESTDATAINPUT POISSON MODULI",
    ),
    "HYPERFOAM": of_model("hyperelastic.hyperfoam", "N TESTDATAINPUT POISSON MODULI"),
    "MULLINS EFFECT": of_model("hyperelastic.mullins_effect"),
    "USER MATERIAL": of_model("user_material.user_material", "CONSTANTS TYPE", "UNSYMM"),
    "DEPVAR": of_model("user_material.depvar", "", "DELETE"),
    "VISCOELASTIC": of_model("viscoelastic.viscoelastic", "TIME"),
    "TRS": of_model("viscoelastic.trs", "DEFINITION"),
    **{
        f"{test.upper()} TEST DATA": Keyword(
            partial(card("hyperelastic.test_data"), test=test), place="model"
        )
        for test in ("uniaxial", "biaxial", "planar")
    },
    "DENSITY": of_model("material.density", "DEPENDENCIES"),
    "EXPANSION": of_model("thermal.expansion", "TYPE ZERO DEPENDENCIES"),
    "PLASTIC": of_model(
        "plastic.plastic", "HARDENING DATATYPE NUMBERBACKSTRESSES RATE DEPENDENCIES"
    ),
    "POTENTIAL": of_model("plastic.potential"),
    "RATE DEPENDENT": of_model("rates.rate_dependent", "TYPE"),
    "CREEP": of_model("rates.creep", "LAW"),
    "SPECIFIC HEAT": of_model("rates.specific_heat"),
    "INELASTIC HEAT FRACTION": of_model("rates.heat_fraction"),
    "CYCLIC HARDENING": of_model("plastic.cyclic_hardening", "PARAMETERS"),
    "SOLID SECTION": of_model(
        "material.solid_section",
        "ELSET MATERIAL ORIENTATION PLANE LOCALSTRAIN DILATATION BETA0 NODALTHICKNESS",
        "CONTROLS OFFSET REFNODE STACKDIRECTION SYMMETRIC LAYUP",
    ),
    "SHELL SECTION": of_model(
        "material.shell_section",
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS SHELLTHICKNESS",
        "OFFSET CONTROLS POISSON SECTIONINTEGRATION TEMPERATURE DENSITY THICKNESSMODULUS ZERO "
        "STACKDIRECTION SYMMETRIC LAYUP",
    ),
    "DISTRIBUTION": of_model("distribution.distribution", "NAME LOCATION TABLE"),
    "DISTRIBUTION TABLE": of_model("distribution.distribution_table", "NAME"),
    "NODAL THICKNESS": of_model("material.nodal_thickness"),
    "IMPERFECTION": of_model("imperfection.imperfection", "FILE STEP INC NSET SYSTEM"),
    "MEMBRANE SECTION": of_model(
        "material.shell_section",
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "OFFSET CONTROLS POISSON",
    ),
    "BEAM SECTION": of_model(
        "lines.beam_section",
        "ELSET MATERIAL SECTION OFFSET1 OFFSET2 TEMPERATURE POISSON",
        "LUMP ROTARYINERTIA CONTROLS ORIENTATION",
    ),
    "BEAM GENERAL SECTION": of_model(
        "lines.beam_general_section",
        "ELSET SECTION DENSITY OFFSET1 OFFSET2",
        "POISSON LUMP ROTARYINERTIA ZERO",
    ),
    "TRANSVERSE SHEAR STIFFNESS": of_model("lines.shear_stiffness"),
    "SPRING": of_model("lines.spring", "ELSET NONLINEAR"),
    "ORIENTATION": of_model("material.orientation", "NAME SYSTEM", "DEFINITION"),
    "AMPLITUDE": anywhere(
        "amplitudes.amplitude",
        "NAME TIME SHIFTX SHIFTY DEFINITION VALUE FIXEDINTERVAL BEGIN",
        "SMOOTH",
    ),
    "TIME POINTS": anywhere("amplitudes.time_points", "NAME TIME GENERATE"),
    "STEP": anywhere(
        "step.step",
        "NLGEOM INC AMPLITUDE PERTURBATION",
        "NAME UNSYMM EXTRAPOLATION SOLVER CONVERTSDI",
    ),
    "END STEP": anywhere("step.end_step"),
    "STATIC": anywhere(
        "path.static",
        "DIRECT RIKS STABILIZE",
        "SOLVER TIMERESET ALLSDTOL CONTINUE FACTOR ADIABATIC LONGTERM",
    ),
    "VISCO": anywhere("rates.visco", "DIRECT CETOL", "SOLVER"),
    "BUCKLE": anywhere("path.buckle", "", "SOLVER EIGENSOLVER"),
    "CONTROLS": anywhere("path.controls", "PARAMETERS RESET", "ANALYSIS TYPE FIELD"),
    "DYNAMIC": anywhere(
        "dynamic.dynamic",
        "ALPHA BETA GAMMA DIRECT DIRECTUSERCONTROL EXPLICIT APPLICATION TIMEINTEGRATOR SCHEME "
        "NOHAF",
        "SOLVER RELATIVETOABSOLUTE HAFTOL HALFINCSCALEFACTOR INITIAL IMPACT SCALEFACTOR "
        "ELEMENTBYELEMENT INCREMENTATION ADIABATIC IMPROVEDDTMETHOD FIXEDTIMEINCREMENTATION",
    ),
    **{
        f"{name} MASS SCALING": anywhere(
            "mass_scaling.mass_scaling", "ELSET FACTOR DT TYPE", "FREQUENCY NUMBERINTERVAL"
        )
        for name in ("FIXED", "VARIABLE")
    },
    "COMPLEX FREQUENCY": anywhere("dynamic.complex_frequency", "CORIOLIS", "SOLVER STORAGE"),
    "FREQUENCY": anywhere(
        "dynamic.frequency",
        "",
        "SOLVER STORAGE EIGENSOLVER NORMALIZATION ACOUSTICCOUPLING RESIDUALMODES "
        "NUMBERINTERVAL SIM BIAS DAMPINGPROJECTION",
    ),
    "MODAL DYNAMIC": anywhere("dynamic.modal_dynamic", "", "SOLVER DIRECT"),
    "STEADY STATE DYNAMICS": anywhere(
        "dynamic.steady_state", "DIRECT", "SOLVER FREQUENCYSCALE INTERVAL FRICTIONDAMPING"
    ),
    "MODAL DAMPING": anywhere("dynamic.modal_damping", "RAYLEIGH VISCOUS DEFINITION", "MODAL"),
    "DAMPING": anywhere("dynamic.damping", "ALPHA BETA"),
    "GLOBAL DAMPING": anywhere("dynamic.global_damping", "ALPHA BETA", "FIELD"),
    "MASS": of_model("attachments.mass", "ELSET"),
    "ROTARY INERTIA": of_model("attachments.rotary_inertia", "ELSET"),
    "NONSTRUCTURAL MASS": of_model("nonstructural.nonstructural_mass", "ELSET UNITS DISTRIBUTION"),
    "DASHPOT": of_model("attachments.dashpot", "ELSET NONLINEAR", "RTOL REGULARIZE"),
    "CONNECTOR SECTION": of_model("connectors.connector_section", "ELSET BEHAVIOR", "CONTROLS"),
    "CONNECTOR BEHAVIOR": of_model(
        "connectors.connector_behavior", "NAME", "INTEGRATION EXTRAPOLATION"
    ),
    "CONNECTOR ELASTICITY": of_model(
        "connectors.connector_elasticity",
        "COMPONENT NONLINEAR RIGID",
        "REGULARIZE RTOL EXTRAPOLATION",
    ),
    "CONNECTOR DAMPING": of_model(
        "connectors.connector_damping", "COMPONENT NONLINEAR", "TYPE REGULARIZE RTOL EXTRAPOLATION"
    ),
    "CONNECTOR STOP": of_model("connectors.connector_stop", "COMPONENT", "REGULARIZE"),
    "CONNECTOR MOTION": Keyword(
        card("connectors.connector_motion"), "AMPLITUDE OP TYPE", "", "step"
    ),
    "CONNECTOR LOAD": Keyword(card("connectors.connector_load"), "AMPLITUDE OP", "", "step"),
    "RELEASE": of_model("release.release"),
    "GAP": of_model("attachments.gap", "ELSET"),
    "INITIAL CONDITIONS": of_model("dynamic.initial_conditions", "TYPE", "VARIABLE"),
    "EQUATION": of_model("tie.equation"),
    "MPC": of_model("tie.mpc"),
    "RIGID BODY": of_model(
        "tie.rigid_body",
        "NSET ELSET ANALYTICALSURFACE REFNODE ROTNODE PINNSET TIENSET",
        "POSITION ISOTHERMAL",
    ),
    "COUPLING": of_model("tie.coupling", "REFNODE SURFACE INFLUENCERADIUS", "CONSTRAINTNAME"),
    "KINEMATIC COUPLING": of_model("tie.kinematic_coupling", "REFNODE"),
    "DISTRIBUTING COUPLING": of_model("tie.distributing_coupling", "ELSET"),
    "KINEMATIC": of_model("tie.kinematic"),
    "DISTRIBUTING": of_model("tie.distributing", "WEIGHTINGMETHOD", ignored="COUPLING"),
    "PRE-TENSION SECTION": of_model("pretension.pretension", "SURFACE ELEMENT NODE", "NAME"),
    "EMBEDDED ELEMENT": of_model(
        "embedded.embedded_element",
        "HOSTELSET EXTERIORTOLERANCE",
        "ROUNDOFFTOLERANCE ABSOLUTEEXTERIORTOLERANCE",
    ),
    "TRANSFORM": of_model("tie.transform", "NSET TYPE"),
    "CONTACT PAIR": anywhere(
        "contact.contact_pair",
        "INTERACTION TYPE ADJUST SMALLSLIDING SMOOTH TIED",
        "EXTENSIONZONE HCRIT TRACKING NOTHICKNESS SUPPLEMENTARYCONSTRAINTS OP WEIGHT CPSET "
        "MECHANICALCONSTRAINT GEOMETRICCORRECTION MINIMUMDISTANCE",
    ),
    "CONTACT": anywhere("general_contact.general", "", "OP"),
    "CONTACT INCLUSIONS": anywhere("general_contact.inclusions", "ALLEXTERIOR"),
    "CONTACT EXCLUSIONS": anywhere("general_contact.exclusions"),
    "CONTACT PROPERTY ASSIGNMENT": anywhere("general_contact.property_assignment"),
    "CONTACT INITIALIZATION DATA": of_model(
        "general_contact.initialization_data",
        "NAME INTERFERENCE SEARCHABOVE INITIALCLEARANCE",
        "SEARCHBELOW",
    ),
    "CONTACT INITIALIZATION ASSIGNMENT": anywhere("general_contact.initialization_assignment"),
    "CONTACT FORMULATION": anywhere("general_contact.formulation", "TYPE"),
    "CONTACT CONTROLS ASSIGNMENT": anywhere(
        "general_contact.formulation",
        "TYPE CONTACTTHICKNESSREDUCTION AUTOMATICOVERCLOSURERESOLUTION NODALEROSION "
        "SCALEPENALTY STABILIZE SEEDONLY",
    ),
    "SURFACE PROPERTY ASSIGNMENT": anywhere("general_contact.formulation", "PROPERTY"),
    "SURFACE INTERACTION": of_model(
        "contact.surface_interaction",
        "NAME",
        "DEPVAR PROPERTIES UNSYMM PADTHICKNESS TRACKINGTHICKNESS",
    ),
    "SURFACE BEHAVIOR": anywhere(
        "contact.surface_behavior",
        "PRESSURE-OVERCLOSURE NOSEPARATION",
        "AUGMENTEDLAGRANGE DIRECT PENALTY",
    ),
    "CONTACT DAMPING": of_model("contact.contact_damping", "DEFINITION", "TANGENTFRACTION"),
    "FRICTION": anywhere(
        "contact.friction",
        "ROUGH TAUMAX EXPONENTIALDECAY",
        "SLIPTOLERANCE LAGRANGE ELASTICSLIP SHEARTRACTIONSLOPE",
    ),
    "CHANGE FRICTION": anywhere("contact.change_friction", "INTERACTION RESET RAMP"),
    "CHANGE SURFACE BEHAVIOR": anywhere("contact.change_surface_behavior", "INTERACTION"),
    "MODEL CHANGE": anywhere("contact.model_change", "TYPE ADD REMOVE ACTIVATE"),
    "CLEARANCE": of_model("contact.clearance", "SLAVE MASTER VALUE"),
    "TIE": of_model("contact.tie", "NAME POSITIONTOLERANCE ADJUST", "TYPE NOROTATION NOTHICKNESS"),
    "CONTACT CONTROLS": anywhere(
        "contact.contact_controls",
        "STABILIZE SLAVE MASTER",
        "RESET AUTOMATICTOLERANCES APPROACH MAXCHP PERRMX UERRMX FRICTIONONSET TANGENTFRACTION "
        "LAGRANGEMULTIPLIER ABSOLUTEPENETRATIONTOLERANCE RELATIVEPENETRATIONTOLERANCE "
        "STIFFNESSSCALEFACTOR TYPE CPSET FASTLOCALTRK GLOBTRKINC SCALEPENALTY WARP",
    ),
    "CONTACT INTERFERENCE": anywhere("contact.contact_interference", "SHRINK", "TYPE OP"),
    "CONTACT PRINT": anywhere(
        "output.contact_print",
        "SLAVE MASTER TOTALS FREQUENCY FREQUENCYF TIMEPOINTS",
        "SUMMARY NSET SET",
    ),
    "SECTION PRINT": anywhere(
        "output.section_print", "SURFACE FREQUENCY FREQUENCYF TIMEPOINTS", "NAME AXES UPDATE TOTALS"
    ),
    "CONTACT FILE": anywhere("output.contact_file", _FILE, "NSET SLAVE MASTER"),
    "CONTACT OUTPUT": anywhere(
        "output.contact_file", _FILE, "NSET SLAVE MASTER VARIABLE CPSET SURFACE"
    ),
    "BOUNDARY": anywhere(
        "supports.boundary", "OP AMPLITUDE TYPE LOADCASE FIXED REAL IMAGINARY", "REGIONTYPE"
    ),
    "BASE MOTION": anywhere("dynamic.base_motion", "DOF AMPLITUDE TYPE SCALE LOADCASE", "BASENAME"),
    "CLOAD": anywhere("loads.cload", "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY", "REGIONTYPE"),
    "DLOAD": anywhere(
        "loads.dload",
        "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY",
        "REGIONTYPE CONSTANTRESULTANT",
    ),
    "DSLOAD": anywhere(
        "loads.dsload",
        "OP AMPLITUDE FOLLOWER LOADCASE ORIENTATION REAL IMAGINARY",
        "REGIONTYPE CONSTANTRESULTANT",
    ),
    "PRESSURE PENETRATION": anywhere(
        "loads.pressure_penetration", "SLAVE MASTER AMPLITUDE OP", "PENETRATIONTIME"
    ),
    "TEMPERATURE": anywhere("thermal.temperature", "OP AMPLITUDE", "LOADCASE"),
    "NODE PRINT": anywhere("output.node_print", f"NSET {_PRINT} GLOBAL", _PRINT_IGNORED),
    "EL PRINT": anywhere("output.el_print", f"ELSET {_PRINT}", f"GLOBAL POSITION {_PRINT_IGNORED}"),
    "NODE FILE": anywhere("output.node_file", f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "NODE OUTPUT": anywhere("output.node_file", f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "EL FILE": anywhere("output.el_file", f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "ELEMENT OUTPUT": anywhere("output.el_file", f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "RESTART": anywhere(
        "output.restart",
        "WRITE READ FREQUENCY STEP INC ENDSTEP JOB",
        "OVERLAY NUMBERINTERVAL TIMEMARKS",
    ),
    "OUTPUT": anywhere(
        "output.output",
        "FREQUENCY FREQUENCYF VARIABLE",
        "FIELD HISTORY NAME OP NUMBERINTERVAL TIMEMARKS TIMEINTERVAL TIMEPOINTS FILTER",
    ),
    "PART": of_model("assembly.part", "NAME"),
    "END PART": of_model("assembly.end_part"),
    "ASSEMBLY": of_model("assembly.assembly", "NAME"),
    "END ASSEMBLY": of_model("assembly.end_assembly"),
    "INSTANCE": of_model("assembly.instance", "NAME PART"),
    "END INSTANCE": of_model("assembly.end_instance"),
}

KEYWORDS: dict[str, Keyword] = {key(name): keyword for name, keyword in _TABLE.items()}

#: Usual spelling of names of several words.
SPELLED = {key(name): name for name in _TABLE}

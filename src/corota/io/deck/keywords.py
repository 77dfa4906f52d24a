"""The table of keywords: one function and one entry each."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from corota.io.deck.laws import LAWS
from corota.io.deck.lexer import Card, key
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
    "NODE": Keyword(card("mesh.node"), "NSET SYSTEM", place="model"),
    "NGEN": Keyword(card("generate.ngen"), "NSET LINE", place="model"),
    "NFILL": Keyword(card("generate.nfill"), "NSET BIAS", place="model"),
    "NCOPY": Keyword(
        card("generate.ncopy"), "CHANGENUMBER OLDSET NEWSET SHIFT MULTIPLE REFLECT", place="model"
    ),
    "ELGEN": Keyword(card("generate.elgen"), "ELSET", place="model"),
    "ELCOPY": Keyword(
        card("generate.elcopy"), "ELEMENTSHIFT OLDSET NEWSET SHIFTNODES", "REFLECT", place="model"
    ),
    "SYSTEM": Keyword(card("generate.system"), place="model"),
    "ELEMENT": Keyword(card("mesh.element"), "TYPE ELSET", place="model"),
    "NSET": Keyword(card("mesh.nset"), "NSET GENERATE ELSET INSTANCE INTERNAL UNSORTED"),
    "ELSET": Keyword(card("mesh.elset"), "ELSET GENERATE INSTANCE INTERNAL"),
    "SURFACE": Keyword(
        card("mesh.surface"),
        "NAME TYPE INTERNAL FILLETRADIUS COMBINE",
        "REGIONTYPE TRIM MAXRATIO",
        place="model",
    ),
    "MATERIAL": Keyword(card("material.material"), "NAME", place="model"),
    "ELASTIC": Keyword(card("material.elastic"), "TYPE MODULI DEPENDENCIES", place="model"),
    # Laws with a card of their own.
    **{
        law.card: Keyword(partial(card("material.constants"), law=name), place="model")
        for name, law in LAWS.items()
        if key(law.card) == name
    },
    "HYPERELASTIC": Keyword(
        card("hyperelastic.hyperelastic"),
        "NEOHOOKE MOONEY-RIVLIN YEOH ARRUDA-BOYCE POLYNOMIAL REDUCEDPOLYNOMIAL OGDEN N "
        "TESTDATAINPUT POISSON MODULI",
        place="model",
    ),
    "HYPERFOAM": Keyword(
        card("hyperelastic.hyperfoam"), "N TESTDATAINPUT POISSON MODULI", place="model"
    ),
    "MULLINS EFFECT": Keyword(card("hyperelastic.mullins_effect"), place="model"),
    "USER MATERIAL": Keyword(
        card("user_material.user_material"), "CONSTANTS TYPE", "UNSYMM", place="model"
    ),
    "DEPVAR": Keyword(card("user_material.depvar"), "", "DELETE", place="model"),
    "VISCOELASTIC": Keyword(card("viscoelastic.viscoelastic"), "TIME", place="model"),
    "TRS": Keyword(card("viscoelastic.trs"), "DEFINITION", place="model"),
    **{
        f"{test.upper()} TEST DATA": Keyword(
            partial(card("hyperelastic.test_data"), test=test), place="model"
        )
        for test in ("uniaxial", "biaxial", "planar")
    },
    "DENSITY": Keyword(card("material.density"), "DEPENDENCIES", place="model"),
    "EXPANSION": Keyword(card("thermal.expansion"), "TYPE ZERO DEPENDENCIES", place="model"),
    "PLASTIC": Keyword(
        card("plastic.plastic"),
        "HARDENING DATATYPE NUMBERBACKSTRESSES RATE DEPENDENCIES",
        place="model",
    ),
    "POTENTIAL": Keyword(card("plastic.potential"), "", place="model"),
    "RATE DEPENDENT": Keyword(card("rates.rate_dependent"), "TYPE", place="model"),
    "CREEP": Keyword(card("rates.creep"), "LAW", place="model"),
    "SPECIFIC HEAT": Keyword(card("rates.specific_heat"), "", place="model"),
    "INELASTIC HEAT FRACTION": Keyword(card("rates.heat_fraction"), "", place="model"),
    "CYCLIC HARDENING": Keyword(card("plastic.cyclic_hardening"), "PARAMETERS", place="model"),
    "SOLID SECTION": Keyword(
        card("material.solid_section"),
        "ELSET MATERIAL ORIENTATION PLANE LOCALSTRAIN DILATATION BETA0 NODALTHICKNESS",
        "CONTROLS OFFSET REFNODE STACKDIRECTION SYMMETRIC LAYUP",
        place="model",
    ),
    "SHELL SECTION": Keyword(
        card("material.shell_section"),
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS SHELLTHICKNESS",
        "OFFSET CONTROLS POISSON SECTIONINTEGRATION TEMPERATURE DENSITY THICKNESSMODULUS ZERO "
        "STACKDIRECTION SYMMETRIC LAYUP",
        place="model",
    ),
    "DISTRIBUTION": Keyword(
        card("distribution.distribution"), "NAME LOCATION TABLE", place="model"
    ),
    "DISTRIBUTION TABLE": Keyword(card("distribution.distribution_table"), "NAME", place="model"),
    "NODAL THICKNESS": Keyword(card("material.nodal_thickness"), place="model"),
    "IMPERFECTION": Keyword(
        card("imperfection.imperfection"), "FILE STEP INC NSET SYSTEM", place="model"
    ),
    "MEMBRANE SECTION": Keyword(
        card("material.shell_section"),
        "ELSET MATERIAL ORIENTATION LOCALSTRAIN NODALTHICKNESS",
        "OFFSET CONTROLS POISSON",
        place="model",
    ),
    "BEAM SECTION": Keyword(
        card("lines.beam_section"),
        "ELSET MATERIAL SECTION OFFSET1 OFFSET2 TEMPERATURE POISSON",
        "LUMP ROTARYINERTIA CONTROLS ORIENTATION",
        place="model",
    ),
    "BEAM GENERAL SECTION": Keyword(
        card("lines.beam_general_section"),
        "ELSET SECTION DENSITY OFFSET1 OFFSET2",
        "POISSON LUMP ROTARYINERTIA ZERO",
        place="model",
    ),
    "TRANSVERSE SHEAR STIFFNESS": Keyword(card("lines.shear_stiffness"), place="model"),
    "SPRING": Keyword(card("lines.spring"), "ELSET NONLINEAR", place="model"),
    "ORIENTATION": Keyword(
        card("material.orientation"), "NAME SYSTEM", "DEFINITION", place="model"
    ),
    "AMPLITUDE": Keyword(
        card("amplitudes.amplitude"),
        "NAME TIME SHIFTX SHIFTY DEFINITION VALUE FIXEDINTERVAL BEGIN",
        "SMOOTH",
    ),
    "TIME POINTS": Keyword(card("amplitudes.time_points"), "NAME TIME GENERATE"),
    "STEP": Keyword(
        card("step.step"),
        "NLGEOM INC AMPLITUDE PERTURBATION",
        "NAME UNSYMM EXTRAPOLATION SOLVER CONVERTSDI",
    ),
    "END STEP": Keyword(card("step.end_step")),
    "STATIC": Keyword(
        card("path.static"),
        "DIRECT RIKS STABILIZE",
        "SOLVER TIMERESET ALLSDTOL CONTINUE FACTOR ADIABATIC LONGTERM",
    ),
    "VISCO": Keyword(card("rates.visco"), "DIRECT CETOL", "SOLVER"),
    "BUCKLE": Keyword(card("path.buckle"), "", "SOLVER EIGENSOLVER"),
    "CONTROLS": Keyword(card("path.controls"), "PARAMETERS RESET", "ANALYSIS TYPE FIELD"),
    "DYNAMIC": Keyword(
        card("dynamic.dynamic"),
        "ALPHA BETA GAMMA DIRECT DIRECTUSERCONTROL EXPLICIT APPLICATION TIMEINTEGRATOR SCHEME "
        "NOHAF",
        "SOLVER RELATIVETOABSOLUTE HAFTOL HALFINCSCALEFACTOR INITIAL IMPACT SCALEFACTOR "
        "ELEMENTBYELEMENT INCREMENTATION ADIABATIC IMPROVEDDTMETHOD FIXEDTIMEINCREMENTATION",
    ),
    **{
        f"{name} MASS SCALING": Keyword(
            card("mass_scaling.mass_scaling"), "ELSET FACTOR DT TYPE", "FREQUENCY NUMBERINTERVAL"
        )
        for name in ("FIXED", "VARIABLE")
    },
    "COMPLEX FREQUENCY": Keyword(card("dynamic.complex_frequency"), "CORIOLIS", "SOLVER STORAGE"),
    "FREQUENCY": Keyword(
        card("dynamic.frequency"),
        "",
        "SOLVER STORAGE EIGENSOLVER NORMALIZATION ACOUSTICCOUPLING RESIDUALMODES "
        "NUMBERINTERVAL SIM BIAS DAMPINGPROJECTION",
    ),
    "MODAL DYNAMIC": Keyword(card("dynamic.modal_dynamic"), "", "SOLVER DIRECT"),
    "STEADY STATE DYNAMICS": Keyword(
        card("dynamic.steady_state"), "DIRECT", "SOLVER FREQUENCYSCALE INTERVAL FRICTIONDAMPING"
    ),
    "MODAL DAMPING": Keyword(card("dynamic.modal_damping"), "RAYLEIGH VISCOUS DEFINITION", "MODAL"),
    "DAMPING": Keyword(card("dynamic.damping"), "ALPHA BETA"),
    "GLOBAL DAMPING": Keyword(card("dynamic.global_damping"), "ALPHA BETA", "FIELD"),
    "MASS": Keyword(card("attachments.mass"), "ELSET", place="model"),
    "ROTARY INERTIA": Keyword(card("attachments.rotary_inertia"), "ELSET", place="model"),
    "NONSTRUCTURAL MASS": Keyword(
        card("material.nonstructural_mass"), "ELSET UNITS DISTRIBUTION", place="model"
    ),
    "DASHPOT": Keyword(
        card("attachments.dashpot"), "ELSET NONLINEAR", "RTOL REGULARIZE", place="model"
    ),
    "CONNECTOR SECTION": Keyword(
        card("connectors.connector_section"), "ELSET BEHAVIOR", "CONTROLS", place="model"
    ),
    "CONNECTOR BEHAVIOR": Keyword(
        card("connectors.connector_behavior"), "NAME", "INTEGRATION EXTRAPOLATION", place="model"
    ),
    "CONNECTOR ELASTICITY": Keyword(
        card("connectors.connector_elasticity"),
        "COMPONENT NONLINEAR RIGID",
        "REGULARIZE RTOL EXTRAPOLATION",
        place="model",
    ),
    "CONNECTOR DAMPING": Keyword(
        card("connectors.connector_damping"),
        "COMPONENT NONLINEAR",
        "TYPE REGULARIZE RTOL EXTRAPOLATION",
        place="model",
    ),
    "CONNECTOR STOP": Keyword(
        card("connectors.connector_stop"), "COMPONENT", "REGULARIZE", place="model"
    ),
    "CONNECTOR MOTION": Keyword(
        card("connectors.connector_motion"), "AMPLITUDE OP TYPE", place="step"
    ),
    "CONNECTOR LOAD": Keyword(card("connectors.connector_load"), "AMPLITUDE OP", place="step"),
    "RELEASE": Keyword(card("release.release"), place="model"),
    "GAP": Keyword(card("attachments.gap"), "ELSET", place="model"),
    "INITIAL CONDITIONS": Keyword(
        card("dynamic.initial_conditions"), "TYPE", "VARIABLE", place="model"
    ),
    "EQUATION": Keyword(card("tie.equation"), place="model"),
    "MPC": Keyword(card("tie.mpc"), place="model"),
    "RIGID BODY": Keyword(
        card("tie.rigid_body"),
        "NSET ELSET ANALYTICALSURFACE REFNODE ROTNODE PINNSET TIENSET",
        "POSITION ISOTHERMAL",
        place="model",
    ),
    "COUPLING": Keyword(
        card("tie.coupling"), "REFNODE SURFACE INFLUENCERADIUS", "CONSTRAINTNAME", place="model"
    ),
    "KINEMATIC COUPLING": Keyword(card("tie.kinematic_coupling"), "REFNODE", place="model"),
    "DISTRIBUTING COUPLING": Keyword(card("tie.distributing_coupling"), "ELSET", place="model"),
    "KINEMATIC": Keyword(card("tie.kinematic"), place="model"),
    "DISTRIBUTING": Keyword(
        card("tie.distributing"), "WEIGHTINGMETHOD", ignored="COUPLING", place="model"
    ),
    "PRE-TENSION SECTION": Keyword(
        card("pretension.pretension"), "SURFACE ELEMENT NODE", "NAME", place="model"
    ),
    "EMBEDDED ELEMENT": Keyword(
        card("embedded.embedded_element"),
        "HOSTELSET EXTERIORTOLERANCE",
        "ROUNDOFFTOLERANCE ABSOLUTEEXTERIORTOLERANCE",
        place="model",
    ),
    "TRANSFORM": Keyword(card("tie.transform"), "NSET TYPE", place="model"),
    "CONTACT PAIR": Keyword(
        card("contact.contact_pair"),
        "INTERACTION TYPE ADJUST SMALLSLIDING SMOOTH TIED",
        "EXTENSIONZONE HCRIT TRACKING NOTHICKNESS SUPPLEMENTARYCONSTRAINTS OP WEIGHT CPSET "
        "MECHANICALCONSTRAINT GEOMETRICCORRECTION MINIMUMDISTANCE",
    ),
    "CONTACT": Keyword(card("general_contact.general"), "", "OP"),
    "CONTACT INCLUSIONS": Keyword(card("general_contact.inclusions"), "ALLEXTERIOR"),
    "CONTACT EXCLUSIONS": Keyword(card("general_contact.exclusions")),
    "CONTACT PROPERTY ASSIGNMENT": Keyword(card("general_contact.property_assignment")),
    "CONTACT INITIALIZATION DATA": Keyword(
        card("general_contact.initialization_data"),
        "NAME INTERFERENCE SEARCHABOVE INITIALCLEARANCE",
        "SEARCHBELOW",
        place="model",
    ),
    "CONTACT INITIALIZATION ASSIGNMENT": Keyword(card("general_contact.initialization_assignment")),
    "CONTACT FORMULATION": Keyword(card("general_contact.formulation"), "TYPE"),
    "CONTACT CONTROLS ASSIGNMENT": Keyword(
        card("general_contact.formulation"),
        "TYPE CONTACTTHICKNESSREDUCTION AUTOMATICOVERCLOSURERESOLUTION NODALEROSION "
        "SCALEPENALTY STABILIZE SEEDONLY",
    ),
    "SURFACE PROPERTY ASSIGNMENT": Keyword(card("general_contact.formulation"), "PROPERTY"),
    "SURFACE INTERACTION": Keyword(
        card("contact.surface_interaction"),
        "NAME",
        "DEPVAR PROPERTIES UNSYMM PADTHICKNESS TRACKINGTHICKNESS",
        place="model",
    ),
    "SURFACE BEHAVIOR": Keyword(
        card("contact.surface_behavior"),
        "PRESSURE-OVERCLOSURE NOSEPARATION",
        "AUGMENTEDLAGRANGE DIRECT PENALTY",
    ),
    "CONTACT DAMPING": Keyword(
        card("contact.contact_damping"), "DEFINITION", "TANGENTFRACTION", place="model"
    ),
    "FRICTION": Keyword(
        card("contact.friction"),
        "ROUGH TAUMAX EXPONENTIALDECAY",
        "SLIPTOLERANCE LAGRANGE ELASTICSLIP SHEARTRACTIONSLOPE",
    ),
    "CHANGE FRICTION": Keyword(card("contact.change_friction"), "INTERACTION RESET RAMP"),
    "CHANGE SURFACE BEHAVIOR": Keyword(card("contact.change_surface_behavior"), "INTERACTION"),
    "MODEL CHANGE": Keyword(card("contact.model_change"), "TYPE ADD REMOVE ACTIVATE"),
    "CLEARANCE": Keyword(card("contact.clearance"), "SLAVE MASTER VALUE", place="model"),
    "TIE": Keyword(
        card("contact.tie"),
        "NAME POSITIONTOLERANCE ADJUST",
        "TYPE NOROTATION NOTHICKNESS",
        place="model",
    ),
    "CONTACT CONTROLS": Keyword(
        card("contact.contact_controls"),
        "STABILIZE SLAVE MASTER",
        "RESET AUTOMATICTOLERANCES APPROACH MAXCHP PERRMX UERRMX FRICTIONONSET TANGENTFRACTION "
        "LAGRANGEMULTIPLIER ABSOLUTEPENETRATIONTOLERANCE RELATIVEPENETRATIONTOLERANCE "
        "STIFFNESSSCALEFACTOR TYPE CPSET FASTLOCALTRK GLOBTRKINC SCALEPENALTY WARP",
    ),
    "CONTACT INTERFERENCE": Keyword(card("contact.contact_interference"), "SHRINK", "TYPE OP"),
    "CONTACT PRINT": Keyword(
        card("output.contact_print"),
        "SLAVE MASTER TOTALS FREQUENCY FREQUENCYF TIMEPOINTS",
        "SUMMARY NSET SET",
    ),
    "SECTION PRINT": Keyword(
        card("output.section_print"),
        "SURFACE FREQUENCY FREQUENCYF TIMEPOINTS",
        "NAME AXES UPDATE TOTALS",
    ),
    "CONTACT FILE": Keyword(card("output.contact_file"), _FILE, "NSET SLAVE MASTER"),
    "CONTACT OUTPUT": Keyword(
        card("output.contact_file"),
        _FILE,
        "NSET SLAVE MASTER VARIABLE CPSET SURFACE",
    ),
    "BOUNDARY": Keyword(
        card("supports.boundary"), "OP AMPLITUDE TYPE LOADCASE FIXED REAL IMAGINARY", "REGIONTYPE"
    ),
    "BASE MOTION": Keyword(
        card("dynamic.base_motion"), "DOF AMPLITUDE TYPE SCALE LOADCASE", "BASENAME"
    ),
    "CLOAD": Keyword(
        card("loads.cload"), "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY", "REGIONTYPE"
    ),
    "DLOAD": Keyword(
        card("loads.dload"),
        "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY",
        "REGIONTYPE CONSTANTRESULTANT",
    ),
    "DSLOAD": Keyword(
        card("loads.dsload"),
        "OP AMPLITUDE FOLLOWER LOADCASE ORIENTATION REAL IMAGINARY",
        "REGIONTYPE CONSTANTRESULTANT",
    ),
    "PRESSURE PENETRATION": Keyword(
        card("loads.pressure_penetration"), "SLAVE MASTER AMPLITUDE OP", "PENETRATIONTIME"
    ),
    "TEMPERATURE": Keyword(card("thermal.temperature"), "OP AMPLITUDE", "LOADCASE"),
    "NODE PRINT": Keyword(card("output.node_print"), f"NSET {_PRINT} GLOBAL", _PRINT_IGNORED),
    "EL PRINT": Keyword(
        card("output.el_print"), f"ELSET {_PRINT}", f"GLOBAL POSITION {_PRINT_IGNORED}"
    ),
    "NODE FILE": Keyword(card("output.node_file"), f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "NODE OUTPUT": Keyword(card("output.node_file"), f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}"),
    "EL FILE": Keyword(card("output.el_file"), f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "ELEMENT OUTPUT": Keyword(card("output.el_file"), f"NSET ELSET {_FILE}", _FILE_IGNORED),
    "RESTART": Keyword(
        card("output.restart"),
        "WRITE READ FREQUENCY STEP INC ENDSTEP JOB",
        "OVERLAY NUMBERINTERVAL TIMEMARKS",
    ),
    "OUTPUT": Keyword(
        card("output.output"),
        "FREQUENCY FREQUENCYF VARIABLE",
        "FIELD HISTORY NAME OP NUMBERINTERVAL TIMEMARKS TIMEINTERVAL TIMEPOINTS FILTER",
    ),
    "PART": Keyword(card("assembly.part"), "NAME", place="model"),
    "END PART": Keyword(card("assembly.end_part"), place="model"),
    "ASSEMBLY": Keyword(card("assembly.assembly"), "NAME", place="model"),
    "END ASSEMBLY": Keyword(card("assembly.end_assembly"), place="model"),
    "INSTANCE": Keyword(card("assembly.instance"), "NAME PART", place="model"),
    "END INSTANCE": Keyword(card("assembly.end_instance"), place="model"),
}

KEYWORDS: dict[str, Keyword] = {key(name): keyword for name, keyword in _TABLE.items()}

#: Usual spelling of names of several words.
SPELLED = {key(name): name for name in _TABLE}

"""Small runs of every procedure, to be stopped anywhere and gone on with.

Three collections: decks as text, models with what decks do not hold (functions, paths with
branches, every time scheme), and what the examples solve, on coarse meshes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import io
import sys
from importlib import util
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota.model.plasticity import Voce
from corota.model.steps import Step

if TYPE_CHECKING:
    from collections.abc import Callable

EXAMPLES_FOLDER = Path(__file__).resolve().parents[2] / "examples"

# -- decks -----------------------------------------------------------------------------------


def _block(
    first: int, x: float, y: float, length: float, height: float, nx: int, ny: int, name: str
) -> str:
    """Nodes, elements, and the sets LEFT, RIGHT, BOTTOM and TOP of a rectangle."""
    mesh = ct.mesh.rectangle(length, height, nx, ny)
    lines = [f"*NODE, NSET=N{name}"]
    lines += [
        f"{first + k}, {x + a:.12g}, {y + b:.12g}" for k, (a, b) in enumerate(mesh.points.tolist())
    ]
    lines.append(f"*ELEMENT, TYPE=CARD, ELSET=E{name}")
    lines += [
        f"{first + k}, " + ", ".join(str(first + n) for n in cell)
        for k, cell in enumerate(mesh.cells[0].nodes.tolist())
    ]
    for place in ("left", "right", "bottom", "top"):
        lines.append(f"*NSET, NSET={place.upper()}{name}")
        lines += [f"{first + n}," for n in mesh.nodes_of(place).tolist()]
    return "\n".join(lines) + "\n"


ELASTIC = "*ELASTIC\n1000., .3\n*DENSITY\n1.\n*EXPANSION\n1e-3\n"
PRINTS = "*NODE PRINT, NSET=RIGHTA\nU\n*EL PRINT, ELSET=EA\nS\n"


def _strip(
    steps: str, material: str = ELASTIC, more: str = "", card: str = "CPS4", section: str = ""
) -> str:
    """A cantilever strip 8 x 1 of 16 elements."""
    return (
        _block(1, 0.0, 0.0, 8.0, 1.0, 8, 2, "A").replace("CARD", card)
        + f"*MATERIAL, NAME=M\n{material}*SOLID SECTION, ELSET=EA, MATERIAL=M{section}\n1.\n"
        + "*BOUNDARY\nLEFTA, 1, 2\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNA, 0.\n"
        + more
        + steps
    )


def _step(procedure: str, loads: str, options: str = ", NLGEOM") -> str:
    return f"*STEP{options}, INC=2000\n{procedure}\n{loads}{PRINTS}*END STEP\n"


def _pressed(interaction: str, steps: str, kind: str = "SURFACE TO SURFACE", more: str = "") -> str:
    """A block 2 x 1 on a wider one of another mesh, which is held at its bottom."""
    return (
        _block(1, 0.0, 0.0, 4.0, 1.0, 8, 2, "B").replace("CARD", "CPE4")
        + _block(101, 1.0, 1.0, 2.0, 1.0, 5, 2, "A").replace("CARD", "CPE4")
        + f"*MATERIAL, NAME=M\n{ELASTIC}*SOLID SECTION, ELSET=EA, MATERIAL=M\n1.\n"
        + "*SOLID SECTION, ELSET=EB, MATERIAL=M\n1.\n"
        + "*ELSET, ELSET=LOWA, GENERATE\n101, 105\n*ELSET, ELSET=UPB, GENERATE\n9, 16\n"
        + "*SURFACE, NAME=SLAVE\nLOWA, S1\n*SURFACE, NAME=MASTER\nUPB, S3\n"
        + (
            f"*SURFACE INTERACTION, NAME=I\n{interaction}"
            f"*CONTACT PAIR, INTERACTION=I, TYPE={kind}\nSLAVE, MASTER\n"
            if interaction
            else "*TIE, NAME=T\nSLAVE, MASTER\n"
        )
        + "*BOUNDARY\nBOTTOMB, 1, 2\n"
        + more
        + steps
    )


def _plastic(rows: str) -> str:
    return ELASTIC + rows


_TIP = "*CLOAD\nRIGHTA, 2, -.8\n"
_MOVED = "*BOUNDARY\nRIGHTA, 2, 2, -.6\n"
_BACK = _step("*STATIC\n.2, 1.", "*BOUNDARY\nRIGHTA, 2, 2, .2\n")
_PULL = _step("*STATIC\n.1, 1., , .15", _MOVED) + _BACK
_DOWN = _step("*STATIC\n.25, 1.", "*BOUNDARY\nTOPA, 1, 1, 0.\nTOPA, 2, 2, -.05\n")
_SLIDE = _DOWN + _step("*STATIC\n.1, 1., , .2", "*BOUNDARY\nTOPA, 1, 1, .4\n")
_HARD = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"
_RUB = _HARD + "*FRICTION\n.3\n"
_DIRECT = "*DYNAMIC, DIRECT\n.1, 1.5"
_BEAMS = (
    "*NODE, NSET=NA\n"
    + "".join(f"{k + 1}, 0., {12 * k}.\n" for k in range(11))
    + "".join(f"{k + 12}, {12 * (k + 1)}., 120.\n" for k in range(10))
    + "*ELEMENT, TYPE=B21, ELSET=EA\n"
    + "".join(f"{k}, {k}, {k + 1}\n" for k in range(1, 21))
    + "*NSET, NSET=RIGHTA\n13\n*MATERIAL, NAME=M\n*ELASTIC\n720., .3\n*DENSITY\n1.\n"
    + "*BEAM SECTION, ELSET=EA, MATERIAL=M, SECTION=RECT\n3., 2.\n0., 0., -1.\n"
    + "*BOUNDARY\n1, 1, 2\n21, 1, 2\n"
)

DECKS: dict[str, Callable[[], str]] = {
    "linear": lambda: _strip(_step("*STATIC", _TIP, "")),
    "large rotations": lambda: _strip(_step("*STATIC, DIRECT\n.1, 1.", _TIP)),
    "automatic increments": lambda: _strip(_step("*STATIC\n.05, 1., , .3", _TIP)),
    "cut-backs": lambda: _strip(
        _step("*CONTROLS, PARAMETERS=TIME INCREMENTATION\n, , , , 4\n*STATIC\n1., 1.", _TIP)
    ),
    "three steps": lambda: _strip(
        _step("*STATIC\n.25, 1.", _TIP)
        + _step("*STATIC\n.5, 1.", "*CLOAD, OP=NEW\nRIGHTA, 1, 2.\n")
        + _step("*STATIC\n.25, 1.", "*DLOAD\nEA, GRAV, .05, 0., -1., 0.\n")
    ),
    "amplitudes": lambda: _strip(
        _step("*STATIC\n.1, 1.", "*CLOAD, AMPLITUDE=T\nRIGHTA, 2, -.8\n"),
        more="*AMPLITUDE, NAME=T\n0., 0., .3, 1., .6, -.5, 1., .2\n",
    ),
    "pressure": lambda: _strip(
        _step("*STATIC\n.1, 1., , .2", "*DSLOAD\nS, P, .2\n"),
        more="*SURFACE, NAME=S\nEA, S3\n",
    ),
    "temperature": lambda: _strip(
        _step("*STATIC\n.2, 1.", "*TEMPERATURE\nNA, 30.\n")
        + _step("*STATIC\n.2, 1.", "*TEMPERATURE\nTOPA, 90.\n" + _TIP)
    ),
    "temperature beyond yield": lambda: _strip(
        _step("*STATIC\n.2, 1.", "*TEMPERATURE\nNA, 30.\n")
        + _step("*STATIC\n.2, 1.", "*TEMPERATURE\nNA, 0.\n"),
        _plastic("*PLASTIC\n8., 0.\n12., .1\n"),
        more="*BOUNDARY\nRIGHTA, 1, 2\n",
    ),
    "orthotropic": lambda: _strip(
        _step("*STATIC\n.25, 1.", _TIP),
        "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1000., 400., 400., .2, .2, .2, 200., 200.,\n200.\n",
        "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n3, 30.\n",
        section=", ORIENTATION=O",
    ),
    "drilling": lambda: _strip(_step("*STATIC\n.2, 1.", _TIP), card="Q4D"),
    "incompatible modes": lambda: _strip(_step("*STATIC\n.2, 1.", _TIP), card="CPE4I"),
    "logarithmic": lambda: _strip(
        _step("*STATIC\n.2, 1.", _TIP), section=", LOCAL STRAIN=LOGARITHMIC"
    ),
    "perfectly plastic": lambda: _strip(_PULL, _plastic("*PLASTIC\n10.\n")),
    "isotropic hardening": lambda: _strip(_PULL, _plastic("*PLASTIC\n8., 0.\n10., .01\n15., .1\n")),
    "kinematic hardening": lambda: _strip(
        _PULL, _plastic("*PLASTIC, HARDENING=KINEMATIC\n8., 0.\n15., .1\n")
    ),
    "combined hardening": lambda: _strip(
        _PULL,
        _plastic(
            "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, NUMBER BACKSTRESSES=2\n"
            "8., 500., 60., 90., 5.\n*CYCLIC HARDENING, PARAMETERS\n8., 4., 12.\n"
        ),
    ),
    "plane strain, plastic": lambda: _strip(
        _PULL, _plastic("*PLASTIC\n8., 0.\n15., .1\n"), card="CPE4", section=", DILATATION=MEAN"
    ),
    "springs": lambda: _strip(
        _step("*STATIC\n.2, 1.", "*CLOAD\nRIGHTA, 2, -.4\n"),
        more="*NODE\n900, 8., -3.\n*ELEMENT, TYPE=SPRINGA, ELSET=SP\n900, 9, 900\n"
        "*SPRING, ELSET=SP, NONLINEAR\n\n-1., -1.\n0., 0.\n3., 1.\n*BOUNDARY\n900, 1, 2\n",
    ),
    "equation": lambda: _strip(
        _step("*STATIC\n.2, 1.", _TIP), more="*EQUATION\n2\n27, 2, 1., 18, 2, -1.\n"
    ),
    "rigid body": lambda: _strip(
        _step("*STATIC\n.2, 1.", "*CLOAD\n900, 6, -4.\n900, 2, -.5\n"),
        more="*NODE\n900, 9., .5\n*RIGID BODY, NSET=RIGHTA, REF NODE=900\n",
    ),
    "coupling": lambda: _strip(
        _step("*STATIC\n.2, 1.", "*CLOAD\n900, 2, -1.\n"),
        more="*NODE\n900, 9., .5\n*SURFACE, NAME=END\nEA, S2\n"
        "*COUPLING, REF NODE=900, SURFACE=END, CONSTRAINT NAME=C\n*DISTRIBUTING\n",
    ),
    "local axes": lambda: _strip(
        _step("*STATIC\n.25, 1.", "*BOUNDARY\nRIGHTA, 1, 1, .3\n"),
        more="*TRANSFORM, NSET=RIGHTA\n1., 1., 0., -1., 1., 0.\n",
    ),
    "path of a frame": lambda: (
        _BEAMS
        + _step("*STATIC, RIKS\n.05, 1., , , .7, 13, 2, -60.", "*CLOAD\n13, 2, -2.\n").replace(
            "*EL PRINT, ELSET=EA\nS\n", ""
        )
    ),
    "path of a strip": lambda: _strip(
        _step("*STATIC, RIKS\n.05, 1., , , 1.", "*CLOAD\nRIGHTA, 2, -1.\n")
    ),
    "path beyond yield": lambda: _strip(
        _step("*STATIC, RIKS\n.1, 1., , , 1., 27, 2, -2.", "*CLOAD\nRIGHTA, 2, -.3\n"),
        _plastic("*PLASTIC\n8., 0.\n15., .1\n"),
    ),
    "path after a load": lambda: _strip(
        _step("*STATIC\n.5, 1.", "*CLOAD\nRIGHTA, 1, 1.\n")
        + _step("*STATIC, RIKS\n.1, 1., , , 1.", "*CLOAD\nRIGHTA, 2, -.5\n")
    ),
    "motion, HHT": lambda: _strip(_step(_DIRECT, _TIP)),
    "motion, automatic": lambda: _strip(_step("*DYNAMIC\n.1, 2.", _TIP)),
    "motion, quasi-static": lambda: _strip(
        _step("*DYNAMIC, DIRECT, APPLICATION=QUASI-STATIC\n.1, 1.5", _TIP)
    ),
    "motion, dissipating": lambda: _strip(
        _step("*DYNAMIC, DIRECT, APPLICATION=MODERATE DISSIPATION\n.1, 1.5", _TIP)
    ),
    "motion, explicit": lambda: _strip(_step("*DYNAMIC, EXPLICIT\n, .8", _TIP)),
    "motion, explicit, plastic": lambda: _strip(
        _step("*DYNAMIC, EXPLICIT\n, .8", "*CLOAD\nRIGHTA, 2, -2.\n"),
        _plastic("*PLASTIC\n8., 0.\n15., .1\n"),
    ),
    "motion, plastic": lambda: _strip(
        _step(_DIRECT, "*CLOAD\nRIGHTA, 2, -2.\n"), _plastic("*PLASTIC\n8., 0.\n15., .1\n")
    ),
    "motion, damped": lambda: _strip(
        _step(_DIRECT, _TIP), ELASTIC + "*DAMPING, ALPHA=.2, BETA=.01\n"
    ),
    "motion with mass and dashpot": lambda: _strip(
        _step(_DIRECT, _TIP),
        more="*ELEMENT, TYPE=MASS, ELSET=PM\n900, 9\n*MASS, ELSET=PM\n2.\n"
        "*ELEMENT, TYPE=DASHPOTA, ELSET=DP\n901, 9, 1\n*DASHPOT, ELSET=DP\n\n3.\n",
    ),
    "rest, motion, rest": lambda: _strip(
        _step("*STATIC\n.5, 1.", _TIP)
        + _step(_DIRECT, "*CLOAD, OP=NEW\nRIGHTA, 1, .5\n")
        + _step("*STATIC\n.5, 1.", "*CLOAD, OP=NEW\nRIGHTA, 2, .1\n")
    ),
    "frequencies between": lambda: _strip(
        _step("*STATIC\n.25, 1.", _TIP)
        + _step("*FREQUENCY\n3", "", ", PERTURBATION")
        + _step("*STATIC\n.25, 1.", "*CLOAD\nRIGHTA, 1, 1.\n")
    ),
    "buckling between": lambda: _strip(
        _step("*STATIC\n.25, 1.", "*CLOAD\nRIGHTA, 1, .3\n")
        + _step("*BUCKLE\n2", "*CLOAD\nRIGHTA, 1, -.1\n", ", PERTURBATION")
        + _step("*STATIC\n.25, 1.", _TIP)
    ),
    "modal motion": lambda: _strip(
        _step("*FREQUENCY\n4", "", "")
        + _step("*MODAL DYNAMIC\n.05, 2.\n*MODAL DAMPING\n1, 4, .02", _TIP, "")
    ),
    "steady state": lambda: _strip(
        _step("*STATIC\n.5, 1.", "*CLOAD\nRIGHTA, 1, 1.\n")
        + _step("*FREQUENCY\n4", "", ", PERTURBATION")
        + _step("*STEADY STATE DYNAMICS\n.01, .5, 5\n*MODAL DAMPING\n1, 4, .02", _TIP, "")
    ),
    "contact": lambda: _pressed(_HARD, _SLIDE),
    "contact, friction": lambda: _pressed(_RUB, _SLIDE),
    "contact, friction, nodes": lambda: _pressed(_RUB, _SLIDE, "NODE TO SURFACE"),
    "contact, soft": lambda: _pressed(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n5000.\n*FRICTION\n.2\n", _SLIDE
    ),
    "contact, stabilized": lambda: _pressed(
        _RUB,
        _step("*STATIC\n.2, 1.", "*CONTACT CONTROLS, STABILIZE\n*CLOAD\nTOPA, 2, -1.\n"),
    ),
    "contact, moving": lambda: _pressed(
        _RUB,
        _step("*DYNAMIC, DIRECT\n.02, .3", "*CLOAD\nTOPA, 2, -2.\nTOPA, 1, .5\n"),
        more="*INITIAL CONDITIONS, TYPE=VELOCITY\nNA, 2, -.2\n",
    ),
    "contact, explicit": lambda: _pressed(
        _RUB,
        _step("*DYNAMIC, EXPLICIT\n, .3", "*CLOAD\nTOPA, 2, -2.\nTOPA, 1, .5\n"),
        more="*INITIAL CONDITIONS, TYPE=VELOCITY\nNA, 2, -.2\n",
    ),
    "contact, explicit, nodes": lambda: _pressed(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n5000.\n*FRICTION\n.2\n",
        _step("*STATIC\n.5, 1.", "*BOUNDARY\nTOPA, 1, 1, 0.\nTOPA, 2, 2, -.02\n")
        + _step("*DYNAMIC, EXPLICIT\n, .3", "*BOUNDARY\nTOPA, 1, 1, .05\nTOPA, 2, 2, -.02\n"),
        "NODE TO SURFACE",
    ),
    "contact on a rigid profile": lambda: (
        (EXAMPLES_FOLDER.parent / "docs/decks/contact.inp")
        .read_text()
        .replace("0.5, 1.", "0.1, 1., , .1")
    ),
    "tie": lambda: _pressed("", _step("*STATIC\n.2, 1.", "*CLOAD\nTOPA, 1, 4.\n")),
    "tie in motion": lambda: _pressed(
        "", _step("*DYNAMIC, DIRECT\n.02, .3", "*CLOAD\nTOPA, 1, 4.\n")
    ),
    "tie, explicit": lambda: _pressed(
        "", _step("*DYNAMIC, EXPLICIT\n, .2", "*CLOAD\nTOPA, 1, 4.\n")
    ),
    "requests now and then": lambda: _strip(
        "*STEP, NLGEOM, INC=100\n*STATIC, DIRECT\n.05, 1.\n" + _TIP + "*NODE PRINT, NSET=RIGHTA,"
        " FREQUENCY=3\nU\n*NODE FILE, FREQUENCY=4\nU\n*EL FILE, FREQUENCY=4\nS\n*END STEP\n"
        + "*STEP, NLGEOM\n*STATIC\n.5, 1.\n*CLOAD\nRIGHTA, 1, .5\n*END STEP\n"
    ),
    "a run that stops": lambda: _strip(
        "*STEP, NLGEOM\n*STATIC\n.1, 1., .05, .1\n*BOUNDARY\nRIGHTA, 1, 1, -12.\n*END STEP\n",
    ),
}

#: Decks with a parameter, and its values.
SWEEPS: dict[str, tuple[str, str]] = {
    "sweep of a load": (
        "*PARAMETER\nload = .8\n" + DECKS["large rotations"]().replace("-.8", "-<load>"),
        "load=.1:1.:12",
    ),
    "sweep of a limit": (
        "*PARAMETER\nlimit = 8.\n"
        + DECKS["isotropic hardening"]().replace("8., 0.", "<limit>, 0."),
        "limit=6.:9.:6",
    ),
}

# -- models ----------------------------------------------------------------------------------


def _beam(*steps: Step, element: str = "Q4I", material: Any = None, load: float = -1.0) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name="job")
    own = ct.Elastic(E=1000.0, nu=0.3, rho=1.0) if material is None else material
    model.section("all", element=element, material=own)
    model.fix("left")
    model.force("right", y=load)
    model.steps = list(steps)
    return model


def _motion(scheme: str, **more: Any) -> ct.Model:
    step = ct.Dynamic(period=2.0, increments=12, scheme=scheme, **more)
    return _beam(step, element="Q4D")


def hardening(strain: Any, state: Any, plane: str) -> Any:
    """A law with a memory in Python: the stiffness falls with the largest strain so far."""
    c = 1000.0 / 0.91 * np.array([[1.0, 0.3, 0.0], [0.3, 1.0, 0.0], [0.0, 0.0, 0.35]])
    size = np.sqrt((strain**2).sum(axis=-1))
    largest = np.maximum(state[..., 0], size)
    share = 1.0 / (1.0 + 20.0 * largest)
    stress = share[..., None] * (strain @ c)
    tangent = share[..., None, None] * np.broadcast_to(c, (*strain.shape, 3))
    return stress, tangent, largest[..., None]


def _own_law(*steps: Step, rho: float = 0.0) -> ct.Model:
    return _beam(
        *steps, element="Q4", material=ct.UserMaterial(hardening, members=1, rho=rho), load=-0.1
    )


def _column() -> ct.Model:
    """A column that buckles and is followed along the branch."""
    model = ct.Model(ct.mesh.rectangle(20.0, 1.0, nx=12, ny=1, cell="quad8"), name="job")
    model.section("all", element="Q8", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.force("right", x=-1.0)
    tip = int(np.argmin(np.abs(model.mesh.points - [20.0, 0.5]).sum(axis=1)))
    path = ct.ArcLength(displacement=([tip], "y", 8.0), switch=True)
    model.steps = [ct.Static(path=path)]
    return model


def _through(path: Any = None, **more: Any) -> ct.Model:
    """A shallow arch of beams that snaps through."""
    from corota.verification.beam_models import williams_toggle

    model, node = williams_toggle(16)
    model.name = "job"
    model.steps = [ct.Static(path=path and path(node), **more)]
    return model


def _pushed(friction: float, **pair: Any) -> ct.Model:
    """A strip that is drawn over a round rigid bump."""
    model = ct.Model(ct.mesh.rectangle(6.0, 0.5, nx=18, ny=1), name="job")
    model.section(
        "all", element="Q4I", material=ct.Mises(E=1000.0, nu=0.3, yield_stress=15.0, isotropic=50.0)
    )
    model.fix("left", x=1.0)
    bump = ct.RigidCurve.circle((5.0, -1.05), 1.1)
    model.contact("bottom", bump, friction=friction, **pair)
    model.steps = [ct.Static(increments=12)]
    return model


def _ring(*steps: Step, rho: float = 1.0) -> ct.Model:
    """A tube in two tied parts, of steel that flows, in a rigid bore with friction."""
    inside = ct.mesh.rectangle(2.0, 6.0, 2, 6)
    outside = ct.mesh.rectangle(2.0, 6.0, 2, 5)
    inside.points[:, 0] += 8.0
    outside.points[:, 0] += 10.0
    model = ct.Model(ct.mesh.assembly(inside=inside, outside=outside), name="job")
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=5.0, isotropic=50.0, rho=rho)
    model.section("all", element="Q4I", material=steel, plane="axisymmetric")
    model.tie("inside.right", "outside.left")
    bore = ct.RigidCurve.line((12.01, -20.0), (12.01, 20.0))
    model.contact("outside.right", bore, friction=0.2)
    model.fix("inside.bottom", x=None)
    model.fix("outside.bottom", x=None)
    model.pressure("inside.left", 4.0)
    model.traction("outside.top", y=-1.0)
    model.steps = list(steps)
    return model


MODELS: dict[str, Callable[[], ct.Model]] = {
    "ring": lambda: _ring(ct.Static(increments=6), ct.Static(increments=4)),
    "ring, moving": lambda: _ring(ct.Dynamic(period=1.0, scheme="hht", increments=10)),
    "newmark": lambda: _motion("newmark"),
    "hht": lambda: _motion("hht", alpha=-0.2),
    "generalized alpha": lambda: _motion("generalized_alpha"),
    "energy-momentum": lambda: _motion("energy_momentum"),
    "central differences": lambda: _beam(ct.Dynamic(period=1.0, scheme="central_difference")),
    "energy-momentum, automatic": lambda: _beam(ct.Dynamic(period=2.0, scheme="energy_momentum")),
    "lumped, damped": lambda: _motion("newmark", mass="lumped", rayleigh=(0.1, 0.01)),
    "law in Python": lambda: _own_law(
        ct.Static(increments=8), ct.Static(increments=4, new_loads=True)
    ),
    "law in Python, moving": lambda: _own_law(ct.Dynamic(period=2.0, increments=12), rho=1.0),
    "Voce and back-stresses": lambda: _beam(
        ct.Static(increments=12),
        load=-0.03,
        material=ct.Mises(
            E=1000.0,
            nu=0.3,
            yield_stress=2.0,
            isotropic=Voce(2.0, 20.0),
            chaboche=[(200.0, 40.0), (50.0, 0.0)],
        ),
    ),
    "branch": _column,
    "snap-through": lambda: _through(lambda node: ct.ArcLength(displacement=([node], "y", -0.7))),
    "snap-through, spherical": lambda: _through(
        lambda node: ct.ArcLength(displacement=([node], "y", -0.7), shape="spherical")
    ),
    "displacement control": lambda: _through(
        lambda node: ct.DisplacementControl([node], "y", -0.7), increments=12
    ),
    "follow at the limit": lambda: _through(at_limit="follow", increments=10),
    "bump": lambda: _pushed(0.0),
    "bump, friction": lambda: _pushed(0.3),
    "bump, friction, nodes": lambda: _pushed(0.3, method="node_to_segment"),
    "complex modes between": lambda: _beam(
        ct.Static(increments=3), ct.Frequency(modes=2), ct.Buckle(), ct.Static(increments=3)
    ),
}

# -- examples --------------------------------------------------------------------------------


class _Found(Exception):
    """Ends an example where it would solve."""


def _example(path: str, call: Callable[[Any], Any], which: int = 1) -> Callable[[], ct.Model]:
    """What an example solves at its call of `solve` of that number, without solving."""

    def build() -> ct.Model:
        found: list[Any] = []

        def instead(model: ct.Model, steps: Any = None, **options: Any) -> Any:
            found.append((model, steps))
            if len(found) == which:
                raise _Found
            return true(model, steps, **options)

        true = ct.solve
        file = EXAMPLES_FOLDER / path
        sys.path.insert(0, str(file.parent))
        arguments, sys.argv = sys.argv, [str(file)]
        places: list[Any] = []
        try:
            spec = util.spec_from_file_location(f"example_{file.stem}", file)
            assert spec is not None
            assert spec.loader is not None
            module = util.module_from_spec(spec)
            spec.loader.exec_module(module)
            places = [m for m in list(sys.modules.values()) if vars(m).get("solve") is true]
            for place in places:
                place.solve = instead  # type: ignore[attr-defined]
            with contextlib.redirect_stdout(io.StringIO()):
                call(module)
        except _Found:
            pass
        finally:
            for place in places:
                place.solve = true  # type: ignore[attr-defined]
            sys.path.remove(str(file.parent))
            sys.argv = arguments
        model, steps = found[-1]
        model.name = "job"
        model.steps = [steps] if isinstance(steps, Step) else list(steps or model.steps)
        return model

    return build


EXAMPLES: dict[str, Callable[[], ct.Model]] = {
    "bistable_beam": _example("contact/bistable_beam.py", lambda m: m.run(nx=20)),
    "clip": _example("contact/clip.py", lambda m: m.run(nx=60, ny=3)),
    "crushed_ring": _example("contact/crushed_ring.py", lambda m: m.run(n=24, ny=2, way=2.0)),
    "hertz": _example("contact/hertz.py", lambda m: m.run(n=6)),
    "ironing": _example("contact/ironing.py", lambda m: m.run(friction=0.2, n=6)),
    "seal": _example("contact/seal.py", lambda m: m.run(n=30, ny=2)),
    "snap_by_load": _example("contact/snap_by_load.py", lambda m: m.by_load(0.3, 5.0)),
    "cook": _example("cook/cook.py", lambda m: m.tip("Q4I", 8, m.LARGE, nlgeom=True)),
    "cyclic_strip": _example(
        "cyclic_strip/cyclic_strip.py", lambda m: m.run(next(iter(m.materials().values())), 2)
    ),
    "flexure": _example("flexure/flexure.py", lambda m: m.main()),
    "frame_on_plate": _example("frame_on_plate/frame_on_plate.py", lambda m: m.main()),
    "lee frame": _example("frames/frames.py", lambda m: m.follow("lee")),
    "toggle": _example("frames/frames.py", lambda m: m.follow("toggle")),
    "column": _example("frames/frames.py", lambda m: m.buckle()),
    "gripper": _example("gripper/gripper.py", lambda m: m.main(["--output", "."])),
    "guide": _example("guide/guide.py", lambda m: m.main()),
    "impact bar": _example("impact/bar.py", lambda m: m.run(cells=30)),
    "impact ring": _example(
        "impact/ring.py", lambda m: m.run(plastic=True, around=24, through=1, period=0.4)
    ),
    "limit_load": _example("limit_load/limit_load.py", lambda m: m.run(ny=2)),
    "cantilever_sine": _example("motion/cantilever_sine.py", lambda m: m.path("Q4I", 60, cells=8)),
    "free_flight": _example("motion/free_flight.py", lambda m: m.fly(m.rod(), 1.0, 50)),
    "pendulum": _example("motion/pendulum.py", lambda m: m.swing(periods=0.5)),
    "whip": _example("motion/pulse.py", lambda m: m.whip(increments=120)),
    "pulse": _example("motion/pulse.py", lambda m: m.hit(increments=150)),
    "rotor": _example("motion/rotor.py", lambda m: m.turn(increments=20)),
    "perforated_strip": _example("perforated_strip/perforated_strip.py", lambda m: m.run(n=4)),
    "plastic_cook": _example("plastic_cook/plastic_cook.py", lambda m: m.tip("Q4I", 4)),
    "rollup": _example("rollup/rollup.py", lambda m: m.main()),
    "snap_fit": _example("snap_fit/snap_fit.py", lambda m: m.run()),
    "switch": _example("switch/switch.py", lambda m: m.follow(8)),
}

__all__ = ["DECKS", "EXAMPLES", "MODELS", "SWEEPS"]

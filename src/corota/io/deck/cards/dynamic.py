"""Cards of dynamics: procedures, damping, initial velocities."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.card import Card, complete, key
from corota.io.deck.cards.step import keeps_preload, open_procedure, open_step, step_times
from corota.io.deck.cards.supports import RATES
from corota.io.deck.cards.thermal import initial_stress, initial_temperature
from corota.io.deck.drafts import PLANAR, Draft, MaterialDraft, StepDraft
from corota.io.deck.keywords import keyword
from corota.lazy import lazy
from corota.model.loads import InitialVelocity
from corota.model.steps import Dynamic, Frequency, ModalDynamic, SteadyState

if TYPE_CHECKING:
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.deck import Deck


#: Values of ``APPLICATION=`` with their ALPHA of HHT.
APPLICATIONS = {
    "TRANSIENTFIDELITY": -0.05,
    "MODERATEDISSIPATION": -1.0 / 3.0,
    "QUASI-STATIC": 0.0,
}
#: Values of ``TIME INTEGRATOR=`` with the application that they belong to.
INTEGRATORS = {
    "HHT-TF": "TRANSIENTFIDELITY",
    "HHT-MD": "MODERATEDISSIPATION",
    "BWE": "QUASI-STATIC",
}
#: Values of ``SCHEME=``, which is our own parameter.
SCHEMES = {"HHT": "hht", "ENERGYMOMENTUM": "energy_momentum"}
#: Increments of an explicit or modal step without INC.
UNLIMITED_INCREMENTS = 10_000_000
#: Largest tolerance of the local error: the displacement itself.
ANY_ERROR = 1.0
#: Where cards of steps by modes stand.
LATE = "it belongs after *MODAL DYNAMIC or *STEADY STATE DYNAMICS in the same step"


def _grows(now: StepDraft) -> bool:
    """Whether ``*STEP, AMPLITUDE=RAMP`` lets loads grow that act at once by default."""
    return now.card.has("AMPLITUDE") and now.ramp


@keyword(
    "DYNAMIC",
    "ALPHA BETA GAMMA DIRECT DIRECTUSERCONTROL EXPLICIT APPLICATION TIMEINTEGRATOR SCHEME NOHAF",
    "SOLVER RELATIVETOABSOLUTE HAFTOL HALFINCSCALEFACTOR INITIAL IMPACT SCALEFACTOR "
    "ELEMENTBYELEMENT INCREMENTATION ADIABATIC IMPROVEDDTMETHOD FIXEDTIMEINCREMENTATION",
)
def dynamic(deck: Deck, card: Card) -> None:
    """``*DYNAMIC[, ALPHA=][, DIRECT][, EXPLICIT]``: increment, period, smallest, largest."""
    now = open_procedure(deck, card)
    now.direct = card.has("DIRECT") or card.has("DIRECTUSERCONTROL")
    integrator = card.choice("TIMEINTEGRATOR", INTEGRATORS, "HHT-TF")
    use = card.choice("APPLICATION", APPLICATIONS, INTEGRATORS[integrator])
    alpha = card.number("ALPHA", APPLICATIONS[use], -1.0 / 3.0)
    if alpha > 0.0:
        card.refuse(f"ALPHA must lie in [-1/3, 0], not {alpha:g}", "ALPHA")
    if card.has("GAMMA") and not card.has("ALPHA"):
        alpha = min(0.5 - card.number("GAMMA", 0.5 - alpha, 0.0), 0.0)
        deck.note(f"{card.where}: ALPHA={alpha:g}, which belongs to the GAMMA given")
    fits = {"BETA": 0.25 * (1.0 - alpha) ** 2, "GAMMA": 0.5 - alpha}
    for name, value in fits.items():
        given = card.number(name, value, 0.0)
        if abs(given - value) > 1e-3:
            text = f"{name}={given:g} does not belong to ALPHA={alpha:g} of the scheme, which takes"
            card.refuse(f"{text} {value:g}", name, hint="omit BETA and GAMMA")
    explicit = card.has("EXPLICIT")
    scheme = SCHEMES[card.choice("SCHEME", SCHEMES, "HHT")]
    others = [name for name in ("EXPLICIT", "ALPHA", "APPLICATION") if card.has(name)]
    if scheme != "hht" and others:
        text = f"{others[0]} does not belong to SCHEME=ENERGY MOMENTUM, which has no parameter"
        card.refuse(text, others[0], hint="leave one of both out")
    if explicit and not now.card.has("INC"):
        now.max_increments = UNLIMITED_INCREMENTS
    quasi_static = use == "QUASI-STATIC" and not explicit
    if use != "TRANSIENTFIDELITY" and not explicit:
        what = "HHT with the largest dissipation, ALPHA = -1/3"
        if quasi_static:
            what = "generalized-alpha with rho_inf = 0 and loads ramped over the step"
        name = "APPLICATION" if card.has("APPLICATION") else "TIME INTEGRATOR"
        deck.note(f"{card.where}: {name}={card.value(key(name))} is {what}")
    now.make = Dynamic
    now.options = {
        "alpha": alpha,
        "scheme": "central_difference"
        if explicit
        else "generalized_alpha"
        if quasi_static
        else scheme,
        **({"rho_inf": 0.0} if quasi_static else {}),
        # Without the residual at the half increment, which QUASI-STATIC has not either, only the
        # iterations limit the increments.
        **({"error_tolerance": ANY_ERROR} if card.has("NOHAF") or quasi_static else {}),
        "mass": "lumped" if explicit else "consistent",
        # Loads act at once unless they have an amplitude.
        "ramp": _grows(now) or (quasi_static and not now.card.has("AMPLITUDE")),
        "rayleigh": deck.damping,
    }
    step_times(card, now)
    if explicit and not now.direct:
        # The stable increment is found by the analysis.
        first, period, least, most = now.times
        now.times = (min(first, period), period, least, most)


@keyword("COMPLEX FREQUENCY", "CORIOLIS", "SOLVER STORAGE")
def complex_frequency(deck: Deck, card: Card) -> None:
    """``*COMPLEX FREQUENCY[, CORIOLIS]``: the number of modes, with damping and Coriolis forces."""
    now, whole = frequency(deck, card), {"lowest": 0.0, "highest": math.inf}
    if any(now.options[name] != value for name, value in whole.items()):
        card.note("the range of frequencies is ignored")
    now.options.update(complex_modes=True, rayleigh=deck.damping, **whole)


@keyword(
    "FREQUENCY",
    ignored="SOLVER STORAGE EIGENSOLVER NORMALIZATION ACOUSTICCOUPLING RESIDUALMODES "
    "NUMBERINTERVAL SIM BIAS DAMPINGPROJECTION",
)
def frequency(deck: Deck, card: Card) -> StepDraft:
    """``*FREQUENCY``: the number of modes, the lowest and the highest frequency."""
    now = open_procedure(deck, card)
    row = next(card.rows(), None)
    if row is None:
        card.refuse("a data line with the number of modes is missing")
    modes = row.integer(0, "the number of modes", 0 if row.get(2) else None)
    low = row.real(1, "the lowest frequency", 0.0)
    lowest, highest = complete([low, row.real(2, "the highest frequency", math.inf)])
    (count,) = complete([modes])
    if count < 1 and row.get(0):
        row.refuse(0, f"at least one mode is needed, not {count}")
    # Abaqus takes squares below zero as well, so that a free motion is among the modes.
    now.make = Frequency
    now.options = {"modes": count, "lowest": max(lowest, 0.0), "highest": highest}
    now.preload = keeps_preload(deck, card, now)
    return now


@keyword("MODAL DYNAMIC", ignored="SOLVER DIRECT")
def modal_dynamic(deck: Deck, card: Card) -> None:
    """``*MODAL DYNAMIC``: increment and period."""
    now = open_procedure(deck, card)
    now.make = ModalDynamic
    if not now.card.has("INC"):
        now.max_increments = UNLIMITED_INCREMENTS
    now.options = {"rayleigh": deck.damping, "ramp": _grows(now)}
    step_times(card, now)


@keyword("STEADY STATE DYNAMICS", "DIRECT", "SOLVER FREQUENCYSCALE INTERVAL FRICTIONDAMPING")
def steady_state(deck: Deck, card: Card) -> None:
    """``*STEADY STATE DYNAMICS[, DIRECT]``: range, points between modes, bias."""
    now = open_procedure(deck, card)
    row = next(card.rows(), None)
    if row is None:
        card.refuse("a data line with the range of frequencies is missing")
    low, high = row.real(0, "the lowest frequency", 0.0), row.real(1, "the highest frequency")
    count, bias = row.integer(2, "the number of points", 20), row.real(3, "the bias", 3.0)
    (lowest, highest, bias), (points,) = complete([low, high, bias]), complete([count])
    if not 0.0 <= lowest < highest:
        row.refuse(1, f"the range must increase, not {lowest:g} to {highest:g}")
    if points < 2:
        row.refuse(2, f"at least 2 points are needed, not {points}")
    if bias <= 0.0:
        row.refuse(3, f"the bias must be positive, not {bias:g}")
    now.make = SteadyState
    now.options = {"lowest": lowest, "highest": highest, "points": points, "bias": bias}
    now.options |= {"rayleigh": deck.damping, "ramp": False, "direct": card.has("DIRECT")}


@keyword("BASE MOTION", "DOF AMPLITUDE TYPE SCALE LOADCASE", "BASENAME")
def base_motion(deck: Deck, card: Card) -> None:
    """``*BASE MOTION, DOF=, AMPLITUDE=[, TYPE=][, SCALE=]``: all supports of a direction move."""
    now = open_step(deck, card)
    card.no_rows()
    text, amplitude = card.required("DOF"), card.required("AMPLITUDE")
    order = RATES[card.choice("TYPE", RATES, "ACCELERATION")]
    scale = card.number("SCALE", 1.0, -math.inf)
    if not text or not amplitude:
        return
    if now.make not in (Dynamic, ModalDynamic, SteadyState):
        card.error(LATE, hint="prescribe the motion of supports by *BOUNDARY in other steps")
    elif card.value("LOADCASE") not in ("", "1"):
        message = "a base moves in phase here: LOAD CASE=1"
        card.error(message, "LOADCASE", hint="shift the loads instead")
    elif text not in ("1", "2"):
        card.error(f"DOF must be 1 or 2 in the plane, not {text}", "DOF")
    else:
        draft = Draft("fixed", card.row_of("DOF"), "", (scale,), int(text) - 1, order=order)
        now.base_motions.append(draft)


@keyword("MODAL DAMPING", "RAYLEIGH VISCOUS DEFINITION", "MODAL")
def modal_damping(deck: Deck, card: Card) -> None:
    """``*MODAL DAMPING[, RAYLEIGH]``: share of critical damping, or alpha and beta."""
    now = open_step(deck, card)
    if now.make not in (ModalDynamic, SteadyState):
        card.refuse(LATE, hint="*DAMPING, ALPHA=, BETA= damps the other procedures")
    # Abaqus's words for what is the default.
    viscous = ("FRACTIONOFCRITICALDAMPING",)
    card.choice("VISCOUS", viscous, viscous[0])
    card.choice("DEFINITION", ("MODENUMBERS",), "MODENUMBERS")
    for row in card.rows():
        if card.has("RAYLEIGH"):
            now.options["rayleigh"] = tuple(row.reals(("alpha", "beta"), 0.0, 2))
            continue
        share, first = row.number(2, "the damping"), row.integer(0, "the first mode", 1)
        first, last = complete([first, row.integer(1, "the last mode", first)])
        if not 1 <= first <= last:
            row.error(0, f"expected a first mode >= 1 and a last one, not {first}, {last}")
        elif share < 0.0:
            row.error(2, f"the damping must be >= 0, not {share:g}")
        else:
            now.options.setdefault("damping", []).append((first, last, share))


@keyword("DAMPING", "ALPHA BETA")
def damping(deck: Deck, card: Card) -> None:
    """``*DAMPING, ALPHA=, BETA=``: Rayleigh damping of a material, or of the whole model."""
    value = _rayleigh(card)
    if deck.step is not None:
        # It damps the whole model from this step on, as in CalculiX.
        if any(m.damping not in ((0.0, 0.0), value) for m in deck.materials.values()):
            card.refuse("a material has its own *DAMPING: leave one of them out")
        for material in deck.materials.values():
            material.damping = (0.0, 0.0)
        deck.damping = value
        if "rayleigh" in deck.step.options:
            deck.step.options["rayleigh"] = value
        return
    owner: Deck | MaterialDraft = deck if deck.material is None else deck.material
    if owner.damping not in ((0.0, 0.0), value):
        what = "the model" if deck.material is None else f"material {deck.material.name}"
        card.refuse(f"damping differs from that given before for {what}")
    owner.damping = value


def _rayleigh(card: Card) -> tuple[float, float]:
    """``ALPHA=`` and ``BETA=`` of a card without data lines."""
    card.no_rows()
    return card.number("ALPHA", 0.0, 0.0), card.number("BETA", 0.0, 0.0)


@keyword("GLOBAL DAMPING", "ALPHA BETA", "FIELD")
def global_damping(deck: Deck, card: Card) -> None:
    """``*GLOBAL DAMPING, ALPHA=, BETA=``: Rayleigh damping of a linear dynamic step."""
    now, value = open_step(deck, card), _rayleigh(card)
    if now.make not in (ModalDynamic, SteadyState):
        card.refuse(LATE)
    card.choice("FIELD", ("ALL", "MECHANICAL"), "ALL")
    now.options["rayleigh"] = value


@keyword("INITIAL CONDITIONS", "TYPE", "VARIABLE", place="model")
def initial_conditions(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=``: velocities, temperatures or stresses."""
    kind = card.choice("TYPE", INITIAL, "")
    if kind in INITIAL:
        INITIAL[kind](deck, card)
    elif not card.has("TYPE"):
        card.error(f"TYPE= is missing; there are {', '.join(INITIAL)}")


def _velocity(deck: Deck, card: Card) -> None:
    """Node or set, dof, velocity."""
    for row in card.rows():
        row.at_most(3)
        dof, value = row.integer(1, "the degree of freedom"), row.real(2, "the velocity")
        if not row.get(0):
            row.error(0, "a node number or a set is missing")
        elif dof is not None and dof not in PLANAR:
            row.error(1, f"expected 1, 2 or 6 (drilling rotation), found {dof}")
        elif dof is not None and value is not None:
            draft = Draft("velocity", row, row.get(0), (value,), PLANAR[dof])
            deck.later("model", start_in_motion, draft)


def _rotating_velocity(deck: Deck, card: Card) -> None:
    """Node or set, angular velocity, velocity of the axis; two points of the axis."""
    rows = list(card.rows())
    for first, second in zip(rows[::2], rows[1::2], strict=False):
        names = ("the angular velocity", "vx", "vy", "vz")
        found = [first.real(i, name, 0.0) for i, name in enumerate(names, 1)]
        points = second.reals(["a point of the axis"] * 6, 0.0)
        (spin, vx, vy, vz), (ax, ay, az, bx, by, bz) = complete(found), points
        if not first.get(0):
            first.error(0, "a node number or a set is missing")
        elif vz != 0.0 or (spin and (math.hypot(bx - ax, by - ay) > 0.0 or az == bz)):
            second.error(0, "the axis must be normal to the plane")
        else:
            value = (vx, vy, math.copysign(spin, spin * (bz - az)) if spin else 0.0, ax, ay)
            deck.later("model", start_in_motion, Draft("velocity", first, first.get(0), value))
    if not rows or len(rows) % 2:
        card.error("two lines for each set are expected: velocities, axis")


def start_in_motion(targets: Targets, drafts: list[Draft]) -> None:
    """Initial velocities of the model."""
    for item in drafts:
        nodes = targets.nodes(item)
        if nodes is not None:
            dof = None if item.index < 0 else item.index
            targets.model.velocities.append(InitialVelocity(nodes, item.value, dof, item.row.where))


def _field(deck: Deck, card: Card) -> None:
    """Field variables, which no data depend on."""
    deck.note(f"{card.where}: {card.spelled}, TYPE=FIELD: no data depend on field variables")


#: Readers of ``*INITIAL CONDITIONS`` by type.
INITIAL = {
    "VELOCITY": _velocity,
    "ROTATINGVELOCITY": _rotating_velocity,
    "FIELD": _field,
    "HARDENING": lazy("corota.io.deck.cards.hardening:initial_hardening"),
    "TEMPERATURE": initial_temperature,
    "STRESS": initial_stress,
}

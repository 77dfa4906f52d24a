"""Cards of dynamics: procedures, damping, initial velocities."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.cards.step import keeps_preload, open_procedure, open_step, step_times
from corota.io.deck.cards.supports import RATES
from corota.io.deck.cards.thermal import initial_stress, initial_temperature
from corota.io.deck.cards.tie import parameter_row
from corota.io.deck.drafts import Draft, MaterialDraft, StepDraft
from corota.io.deck.lexer import Card, key
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


def dynamic(deck: Deck, card: Card) -> None:
    """``*DYNAMIC[, ALPHA=][, DIRECT][, EXPLICIT]``: increment, period, smallest, largest."""
    now = open_procedure(deck, card)
    if now is None:
        return
    now.direct = card.has("DIRECT") or card.has("DIRECTUSERCONTROL")
    integrator = deck.choice(card, "TIMEINTEGRATOR", INTEGRATORS, "HHT-TF")
    use = deck.choice(card, "APPLICATION", APPLICATIONS, INTEGRATORS[integrator])
    alpha = deck.parameter_number(card, "ALPHA", APPLICATIONS[use], -1.0 / 3.0)
    if alpha > 0.0:
        deck.error(card, card.at("ALPHA"), f"ALPHA must lie in [-1/3, 0], not {alpha:g}")
        return
    if card.has("GAMMA") and not card.has("ALPHA"):
        alpha = min(0.5 - deck.parameter_number(card, "GAMMA", 0.5 - alpha, 0.0), 0.0)
        deck.note(f"{card.where}: ALPHA={alpha:g}, which belongs to the GAMMA given")
    fits = {"BETA": 0.25 * (1.0 - alpha) ** 2, "GAMMA": 0.5 - alpha}
    for name, value in fits.items():
        given = deck.parameter_number(card, name, value, 0.0)
        if abs(given - value) > 1e-3:
            deck.error(
                card,
                card.at(name),
                f"{name}={given:g} does not belong to ALPHA={alpha:g} of the scheme, which takes "
                f"{value:g}",
                hint="omit BETA and GAMMA",
            )
            return
    explicit = card.has("EXPLICIT")
    scheme = SCHEMES[deck.choice(card, "SCHEME", SCHEMES, "HHT")]
    others = [name for name in ("EXPLICIT", "ALPHA", "APPLICATION") if card.has(name)]
    if scheme != "hht" and others:
        deck.error(
            card,
            card.at(others[0]),
            f"{others[0]} does not belong to SCHEME=ENERGY MOMENTUM, which has no parameter",
            hint="leave one of both out",
        )
        return
    if explicit and not now.card.has("INC"):
        now.max_increments = UNLIMITED_INCREMENTS
    quasi_static = use == "QUASI-STATIC" and not explicit
    if use != "TRANSIENTFIDELITY" and not explicit:
        what = (
            "generalized-alpha with rho_inf = 0 and loads ramped over the step"
            if quasi_static
            else "HHT with the largest dissipation, ALPHA = -1/3"
        )
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
    step_times(deck, card, now)
    if explicit and not now.direct:
        # The stable increment is found by the analysis.
        first, period, least, most = now.times
        now.times = (min(first, period), period, least, most)


def complex_frequency(deck: Deck, card: Card) -> None:
    """``*COMPLEX FREQUENCY[, CORIOLIS]``: the number of modes, with damping and Coriolis forces."""
    frequency(deck, card)
    if deck.step is not None and deck.step.make is Frequency:
        whole = {"lowest": 0.0, "highest": math.inf}
        if any(deck.step.options[name] != value for name, value in whole.items()):
            deck.note(f"{card.where}: {card.spelled}: the range of frequencies is ignored")
        deck.step.options.update(complex_modes=True, rayleigh=deck.damping, **whole)


def frequency(deck: Deck, card: Card) -> None:
    """``*FREQUENCY``: the number of modes, the lowest and the highest frequency."""
    now = open_procedure(deck, card)
    if now is None:
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line with the number of modes is missing")
        return
    row = rows[0]
    count = deck.integer(card, row, 0, "the number of modes", 0 if row.get(2) else None)
    low = deck.real(card, row, 1, "the lowest frequency", 0.0)
    high = deck.real(card, row, 2, "the highest frequency", math.inf)
    if count is None or low is None or high is None:
        return
    if count < 1 and row.get(0):
        deck.row_error(card, row, 0, f"at least one mode is needed, not {count}")
        return
    # Abaqus takes squares below zero as well, so that a free motion is among the modes.
    now.make, now.options = Frequency, {"modes": count, "lowest": max(low, 0.0), "highest": high}
    now.preload = keeps_preload(deck, card, now)


def modal_dynamic(deck: Deck, card: Card) -> None:
    """``*MODAL DYNAMIC``: increment and period."""
    now = open_procedure(deck, card)
    if now is None:
        return
    now.make = ModalDynamic
    if not now.card.has("INC"):
        now.max_increments = UNLIMITED_INCREMENTS
    now.options = {"rayleigh": deck.damping, "ramp": _grows(now)}
    step_times(deck, card, now)


def steady_state(deck: Deck, card: Card) -> None:
    """``*STEADY STATE DYNAMICS[, DIRECT]``: range, points between modes, bias."""
    now = open_procedure(deck, card)
    if now is None:
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line with the range of frequencies is missing")
        return
    low = deck.real(card, rows[0], 0, "the lowest frequency", 0.0)
    high = deck.real(card, rows[0], 1, "the highest frequency")
    points = deck.integer(card, rows[0], 2, "the number of points", 20)
    bias = deck.real(card, rows[0], 3, "the bias", 3.0)
    if low is None or high is None or points is None or bias is None:
        return
    if not 0.0 <= low < high:
        deck.row_error(card, rows[0], 1, f"the range must increase, not {low:g} to {high:g}")
    elif points < 2:
        deck.row_error(card, rows[0], 2, f"at least 2 points are needed, not {points}")
    elif bias <= 0.0:
        deck.row_error(card, rows[0], 3, f"the bias must be positive, not {bias:g}")
    else:
        now.make = SteadyState
        now.options = {
            "lowest": low,
            "highest": high,
            "points": points,
            "bias": bias,
            "rayleigh": deck.damping,
            "ramp": False,
            "direct": card.has("DIRECT"),
        }


def base_motion(deck: Deck, card: Card) -> None:
    """``*BASE MOTION, DOF=, AMPLITUDE=[, TYPE=][, SCALE=]``: all supports of a direction move."""
    now = open_step(deck, card)
    deck.no_rows(card)
    text, amplitude = deck.required(card, "DOF"), deck.required(card, "AMPLITUDE")
    order = RATES[deck.choice(card, "TYPE", RATES, "ACCELERATION")]
    scale = deck.parameter_number(card, "SCALE", 1.0, -math.inf)
    if now is None or not text or not amplitude:
        return
    if now.make not in (Dynamic, ModalDynamic, SteadyState):
        hint = "prescribe the motion of supports by *BOUNDARY in other steps"
        deck.error(card, card.where, LATE, hint=hint)
    elif card.value("LOADCASE") not in ("", "1"):
        message = "a base moves in phase here: LOAD CASE=1"
        deck.error(card, card.at("LOADCASE"), message, hint="shift the loads instead")
    elif text not in ("1", "2"):
        deck.error(card, card.at("DOF"), f"DOF must be 1 or 2 in the plane, not {text}")
    else:
        row = parameter_row(card, "DOF")
        draft = Draft("fixed", card, row, "", (scale,), int(text) - 1, amplitude)
        draft.order = order
        now.base_motions.append(draft)


def modal_damping(deck: Deck, card: Card) -> None:
    """``*MODAL DAMPING[, RAYLEIGH]``: share of critical damping, or alpha and beta."""
    now = open_step(deck, card)
    if now is None:
        return
    if now.make not in (ModalDynamic, SteadyState):
        hint = "*DAMPING, ALPHA=, BETA= damps the other procedures"
        deck.error(card, card.where, LATE, hint=hint)
        return
    # Abaqus's words for what is the default.
    viscous = ("FRACTIONOFCRITICALDAMPING",)
    deck.choice(card, "VISCOUS", viscous, viscous[0])
    deck.choice(card, "DEFINITION", ("MODENUMBERS",), "MODENUMBERS")
    for row in card.rows():
        if card.has("RAYLEIGH"):
            alpha = deck.real(card, row, 2, "alpha", 0.0)
            beta = deck.real(card, row, 3, "beta", 0.0)
            if alpha is not None and beta is not None:
                now.options["rayleigh"] = (alpha, beta)
            continue
        share = deck.real(card, row, 2, "the damping")
        if share is None:
            return
        first = deck.integer(card, row, 0, "the first mode", 1)
        last = deck.integer(card, row, 1, "the last mode", first)
        if first is None or last is None:
            return
        if not 1 <= first <= last:
            deck.row_error(
                card, row, 0, f"expected a first mode >= 1 and a last one, not {first}, {last}"
            )
        elif share < 0.0:
            deck.row_error(card, row, 2, f"the damping must be >= 0, not {share:g}")
        else:
            now.options.setdefault("damping", []).append((first, last, share))


def damping(deck: Deck, card: Card) -> None:
    """``*DAMPING, ALPHA=, BETA=``: Rayleigh damping of a material, or of the whole model."""
    deck.no_rows(card)
    value = (
        deck.parameter_number(card, "ALPHA", 0.0, 0.0),
        deck.parameter_number(card, "BETA", 0.0, 0.0),
    )
    if deck.step is not None:
        _damp_from_here(deck, deck.step, card, value)
        return
    owner: Deck | MaterialDraft = deck if deck.material is None else deck.material
    if owner.damping not in ((0.0, 0.0), value):
        what = "the model" if deck.material is None else f"material {deck.material.name}"
        deck.error(card, card.where, f"damping differs from that given before for {what}")
        return
    owner.damping = value


def _damp_from_here(deck: Deck, now: StepDraft, card: Card, value: tuple[float, float]) -> None:
    """Damp the whole model from a step on, as CalculiX does with a card in a step."""
    if any(m.damping not in ((0.0, 0.0), value) for m in deck.materials.values()):
        deck.error(card, card.where, "a material has its own *DAMPING: leave one of them out")
        return
    for material in deck.materials.values():
        material.damping = (0.0, 0.0)
    deck.damping = value
    if "rayleigh" in now.options:
        now.options["rayleigh"] = value


def global_damping(deck: Deck, card: Card) -> None:
    """``*GLOBAL DAMPING, ALPHA=, BETA=``: Rayleigh damping of a linear dynamic step."""
    deck.no_rows(card)
    now = open_step(deck, card)
    if now is None:
        return
    if now.make not in (ModalDynamic, SteadyState):
        deck.error(card, card.where, LATE)
        return
    deck.choice(card, "FIELD", ("ALL", "MECHANICAL"), "ALL")
    now.options["rayleigh"] = (
        deck.parameter_number(card, "ALPHA", 0.0, 0.0),
        deck.parameter_number(card, "BETA", 0.0, 0.0),
    )


def initial_conditions(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=``: velocities, temperatures or stresses."""
    kind = deck.choice(card, "TYPE", INITIAL, "")
    if kind in INITIAL:
        INITIAL[kind](deck, card)
    elif not card.has("TYPE"):
        deck.error(card, card.where, f"TYPE= is missing; there are {', '.join(INITIAL)}")


def _velocity(deck: Deck, card: Card) -> None:
    """Node or set, dof, velocity."""
    for row in card.rows():
        deck.extra_fields(card, row, 3)
        dof = deck.integer(card, row, 1, "the degree of freedom")
        value = deck.real(card, row, 2, "the velocity")
        if not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
        elif dof is not None and dof not in (1, 2, 6):
            deck.row_error(card, row, 1, f"expected 1, 2 or 6 (drilling rotation), found {dof}")
        elif dof is not None and value is not None:
            index = {1: 0, 2: 1, 6: 2}[dof]
            draft = Draft("velocity", card, row, row.get(0), (value,), index)
            deck.later("model", start_in_motion, draft)


def _rotating_velocity(deck: Deck, card: Card) -> None:
    """Node or set, angular velocity, velocity of the axis; two points of the axis."""
    rows = list(card.rows())
    for first, second in zip(rows[::2], rows[1::2], strict=False):
        names = ("the angular velocity", "vx", "vy", "vz")
        found = [deck.real(card, first, 1 + i, name, 0.0) for i, name in enumerate(names)]
        points = [deck.real(card, second, i, "a point of the axis", 0.0) for i in range(6)]
        if None in found or None in points:
            return
        spin, vx, vy, vz = (float(v or 0.0) for v in found)
        ax, ay, az, bx, by, bz = (float(v or 0.0) for v in points)
        if not first.get(0):
            deck.row_error(card, first, 0, "a node number or a set is missing")
        elif vz != 0.0 or (spin and (math.hypot(bx - ax, by - ay) > 0.0 or az == bz)):
            deck.row_error(card, second, 0, "the axis must be normal to the plane")
        else:
            value = (vx, vy, math.copysign(spin, spin * (bz - az)) if spin else 0.0, ax, ay)
            draft = Draft("velocity", card, first, first.get(0), value)
            deck.later("model", start_in_motion, draft)
    if not rows or len(rows) % 2:
        deck.error(card, card.where, "two lines for each set are expected: velocities, axis")


def start_in_motion(targets: Targets, drafts: list[Draft]) -> None:
    """Initial velocities of the model."""
    for item in drafts:
        nodes = targets.nodes(item)
        if nodes is not None:
            dof = None if item.index < 0 else item.index
            targets.model.velocities.append(InitialVelocity(nodes, item.value, dof, item.row.where))


def _field(deck: Deck, card: Card) -> None:
    """Field variables, which no data depend on."""
    list(card.rows())
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

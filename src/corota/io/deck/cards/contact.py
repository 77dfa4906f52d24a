"""Cards of contact: pairs of surfaces, what happens between them, rigid curves, ties."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from corota.errors import InputError, Location
from corota.io.deck import numerals
from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import Draft, InteractionDraft, PairDraft, StepDraft, Surface
from corota.io.deck.lexer import Card, Row, key
from corota.model.friction import MOST_FRICTION, DecayingFriction, Friction, FrictionTable

#: Types of contact pairs of CalculiX and Abaqus, and the discretization here.
TYPES = {
    "NODETOSURFACE": "node_to_segment",
    "SURFACETOSURFACE": "mortar",
    "MORTAR": "mortar",
    "LINMORTAR": "mortar",
    "PGLINMORTAR": "mortar",
    "PETROVGALERKINMORTAR": "mortar",
}
#: Names of PRESSURE-OVERCLOSURE.
LAWS = ("HARD", "LINEAR", "TABULAR", "EXPONENTIAL", "TIED")


def profile(deck: Deck, card: Card, found: Surface) -> None:
    """``*SURFACE, TYPE=SEGMENTS``: START, then LINE and CIRCL; the outward normal on the left."""
    radius = deck.parameter_number(card, "FILLETRADIUS", 0.0, 0.0)
    at: tuple[float, float] | None = None
    rows: list[tuple[float, ...]] = []
    for row in card.rows():
        kind = key(row.get(0))
        count = {"START": 2, "LINE": 2, "CIRCL": 4}.get(kind)
        if count is None:
            why = "parabolas are not supported: use arcs" if kind == "PARAB" else ""
            text = f"expected START, LINE or CIRCL, found {row.get(0)!r}"
            deck.row_error(card, row, 0, text, why)
            return
        deck.extra_fields(card, row, 1 + count)
        names = ("x", "y", "x of the center", "y of the center")
        numbers = [deck.real(card, row, 1 + i, names[i]) for i in range(count)]
        if any(v is None for v in numbers):
            return
        x, y, *center = (float(v or 0.0) for v in numbers)
        if (at is None) != (kind == "START"):
            text = "START, x, y comes first" if at is None else "START comes only once"
            deck.row_error(card, row, 0, text)
            return
        if at is not None:
            if math.dist(at, (x, y)) == 0.0:
                deck.row_error(card, row, 1, "the segment has no length")
                return
            sweep = 0.0
            if center:
                turn = _sweep(deck, card, row, at, (x, y), (center[0], center[1]))
                if turn is None:
                    return
                sweep = turn
            rows.append((*at, x, y, *(center or (0.0, 0.0)), sweep))
        at = (x, y)
    if not rows:
        deck.error(card, card.where, f"surface {found.name} needs START and one segment at least")
        return
    found.profile = np.array(rows)
    if radius > 0.0:
        if found.profile[:, 6].any():
            text = "FILLET RADIUS rounds the corners of straight lines only: give the arcs by CIRCL"
            deck.error(card, card.at("FILLETRADIUS"), text)
        found.fillet = radius


def _sweep(
    deck: Deck,
    card: Card,
    row: Row,
    start: tuple[float, float],
    end: tuple[float, float],
    center: tuple[float, float],
) -> float | None:
    """Angle of an arc of less than half a turn; ``None`` after an error."""
    a, b = (complex(*p) - complex(*center) for p in (start, end))
    if abs(abs(a) - abs(b)) > 1e-4 * max(abs(a), abs(b)) or abs(a) == 0.0:
        text = (
            f"the ends of the arc are {abs(a):g} and {abs(b):g} away from its center; they must "
            "be equally far"
        )
        deck.row_error(card, row, 3, text)
        return None
    turn = math.atan2((b * a.conjugate()).imag, (b * a.conjugate()).real)
    if abs(turn) > math.pi * (1.0 - 1e-9):
        deck.row_error(card, row, 1, "an arc must be less than 180 degrees: give it in two")
        return None
    return turn


def contact_pair(deck: Deck, card: Card) -> None:
    """``*CONTACT PAIR, INTERACTION=, TYPE=[, ADJUST=][, SMOOTH=]``: slave, master."""
    interaction = deck.required(card, "INTERACTION")
    if not card.has("TYPE"):
        deck.note(f"{card.where}: no TYPE: surface to surface (mortar) is taken")
    method = TYPES.get(deck.choice(card, "TYPE", TYPES, "MORTAR"), "mortar")
    if card.has("SMALLSLIDING"):
        deck.note(f"{card.where}: SMALL SLIDING: sliding is always finite")
    smooth = deck.parameter_number(card, "SMOOTH", 0.0, 0.0) > 0.0
    start, adjust, nodes = "keep", 0.0, ""
    if card.has("ADJUST"):
        start = "adjust"
        try:
            adjust = numerals.real(card.value("ADJUST"))
        except ValueError:
            nodes = deck.required(card, "ADJUST")
        if adjust < 0.0:
            deck.error(card, card.at("ADJUST"), "ADJUST must be >= 0")
            return
    tied = card.has("TIED")
    if tied:
        deck.note(f"{card.where}: TIED surfaces are joined where they are at the start")
    for row in _pair_rows(deck, card):
        pair = PairDraft(card, row, row.get(0), row.get(1) or row.get(0), tied=tied)
        pair.interaction, pair.method = interaction, method
        begins_in(pair, len(deck.steps))
        pair.start, pair.adjust, pair.adjust_set, pair.smooth = start, adjust, nodes, smooth
        deck.pairs.append(pair)


def begins_in(pair: PairDraft, step: int) -> None:
    """Let a pair act from a step on, as explicit steps of Abaqus define contact."""
    if step > 1:
        pair.changes = {0: False, step: True}


def tie(deck: Deck, card: Card) -> None:
    """``*TIE, NAME=[, POSITION TOLERANCE=][, ADJUST=NO]``: slave, master."""
    tolerance = deck.parameter_number(card, "POSITIONTOLERANCE", 0.0, 0.0)
    if deck.choice(card, "ADJUST", ("YES", "NO"), "YES") == "YES":
        text = "nodes are not moved onto the master surface; the distance at the start is kept"
        deck.note(f"{card.where}: {card.spelled}: {text}")
    for row in _pair_rows(deck, card):
        if not row.get(1):
            deck.row_error(card, row, 1, "the master surface is missing")
            continue
        pair = PairDraft(card, row, row.get(0), row.get(1), tied=True, adjust=tolerance)
        pair.name = card.value("NAME")
        deck.pairs.append(pair)


def _pair_rows(deck: Deck, card: Card) -> list[Row]:
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: slave surface, master surface")
    for row in rows:
        deck.extra_fields(card, row, 2)
        if not row.get(0):
            deck.row_error(card, row, 0, "the slave surface is missing")
    return [row for row in rows if row.get(0)]


def surface_interaction(deck: Deck, card: Card) -> None:
    """``*SURFACE INTERACTION, NAME=``: opens an interaction; a data line is a thickness."""
    name = deck.required(card, "NAME")
    deck.interaction = None
    if not name:
        return
    if key(name) in deck.interactions:
        deck.error(card, card.at("NAME"), f"interaction {name} is already defined")
        return
    for row in card.rows():
        deck.note(f"{row.where}: {card.spelled}: the thickness is that of the section")
    deck.interaction = deck.interactions[key(name)] = InteractionDraft(name, card)


def _open(deck: Deck, card: Card) -> InteractionDraft | None:
    if deck.interaction is None:
        deck.error(
            card,
            card.where,
            "the card belongs under a *SURFACE INTERACTION, but there is none before it",
        )
    return deck.interaction


def _changed(deck: Deck, card: Card) -> InteractionDraft | None:
    """The interaction with another law from the open step on."""
    old, deck.changed = deck.changed, None
    if old is None:
        text = f"{card.spelled} inside a step"
        hint = "put *CHANGE SURFACE BEHAVIOR, INTERACTION= before it to change an interaction"
        deck.error(card, card.where, text, hint=hint)
        return None
    if old.friction_steps or old.law == "TIED":
        deck.error(card, card.where, "an interaction is changed in its friction or its law alone")
        return None
    new = replace(old, pressure=[], overclosure=[], friction_steps={}, later={}, damping=None)
    old.later[len(deck.steps)] = new
    return new


def surface_behavior(deck: Deck, card: Card) -> None:
    """``*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=``: pressure against overclosure."""
    into = _open(deck, card) if deck.step is None else _changed(deck, card)
    law = deck.choice(card, "PRESSURE-OVERCLOSURE", LAWS, "HARD")
    rows = list(card.rows())
    if into is None:
        return
    into.law, into.law_where = law, card.where
    if card.has("NOSEPARATION"):
        into.separates = False
        if law != "HARD":
            deck.error(
                card,
                card.at("NOSEPARATION"),
                "surfaces that do not separate are in hard contact",
                hint="leave PRESSURE-OVERCLOSURE out",
            )
    if law in ("HARD", "TIED"):
        if rows:
            what = "nothing penetrates" if law == "HARD" else "the surfaces are joined exactly"
            deck.note(f"{rows[0].where}: {card.spelled}: {what}, the numbers are not used")
        return
    if law != "TABULAR" and len(rows) != 1:
        deck.error(card, card.where, f"one data line is expected with {law}, found {len(rows)}")
        return
    for row in rows:
        if law == "LINEAR":
            numbers = [deck.real(card, row, 0, "the stiffness")]
            if any(row.fields[1:]):
                text = "tension and the contact search distance are not used"
                deck.note(f"{row.where}: {card.spelled}: {text}")
        elif law == "TABULAR":
            deck.extra_fields(card, row, 3)
            numbers = [
                deck.real(card, row, 0, "the pressure"),
                deck.real(card, row, 1, "the overclosure"),
            ]
        else:
            deck.extra_fields(card, row, 3)
            numbers = [
                deck.real(card, row, 1, "the pressure at zero clearance"),
                deck.real(card, row, 0, "the clearance at zero pressure"),
            ]
        if any(v is None for v in numbers):
            return
        into.pressure.append(float(numbers[0] or 0.0))
        into.overclosure.append(float(numbers[1] or 0.0) if len(numbers) > 1 else 0.0)
    if law == "EXPONENTIAL":
        text = "the pressure is zero at the clearance c0, as in Abaqus (CalculiX: 1 % of p0)"
        deck.note(f"{card.where}: {card.spelled}: {text}")


def contact_damping(deck: Deck, card: Card) -> None:
    """``*CONTACT DAMPING``: without effect in steps without velocities, and on hard contact."""
    into = _open(deck, card)
    list(card.rows())
    deck.choice(card, "DEFINITION", ("DAMPINGCOEFFICIENT", "CRITICALDAMPINGFRACTION"), "")
    if into is not None:
        into.damping = card


def change_surface_behavior(deck: Deck, card: Card) -> None:
    """``*CHANGE SURFACE BEHAVIOR, INTERACTION=``: the law below it holds from this step."""
    deck.changed = _to_change(deck, card)


def _to_change(deck: Deck, card: Card) -> InteractionDraft | None:
    """The interaction that a card of a step names."""
    deck.no_rows(card)
    name = deck.required(card, "INTERACTION")
    found = deck.interactions.get(key(name))
    if deck.step is None:
        deck.error(card, card.where, "the card belongs in a step")
        return None
    if found is None and name:
        names = [i.name for i in deck.interactions.values()]
        text = f"no *SURFACE INTERACTION named {numerals.shown(name)}"
        deck.error(card, card.at("INTERACTION"), text, hint=nearest(name, names))
    return found


def change_friction(deck: Deck, card: Card) -> None:
    """``*CHANGE FRICTION, INTERACTION=[, RESET]``: ``*FRICTION`` below it holds from this step."""
    found, deck.changed = _to_change(deck, card), None
    if found is not None:
        # Abaqus changes it over the step, as it lets loads grow; CalculiX at once.
        found.friction_ramps = card.has("RAMP") or deck.dialect == "abaqus"
        if card.has("RESET"):
            found.friction_steps[len(deck.steps)] = found.friction
        else:
            deck.changed = found


def friction(deck: Deck, card: Card) -> None:
    """``*FRICTION``: coefficient, stick slope; more lines, ``EXPONENTIAL DECAY``: one that varies.

    ``ROUGH``: what touches does not slide.
    """
    if deck.step is not None:
        into, deck.changed = deck.changed, None
        if into is None:
            deck.error(
                card,
                card.where,
                f"{card.spelled} inside a step",
                hint="put *CHANGE FRICTION, INTERACTION= before it to change an interaction",
            )
    else:
        into = _open(deck, card)
    rows = list(card.rows())
    if into is None:
        return
    if card.has("TAUMAX"):
        limit = deck.parameter_number(card, "TAUMAX", math.inf, 0.0)
        if limit == 0.0:
            deck.error(card, card.at("TAUMAX"), "the largest shear traction must be > 0")
        if deck.step is not None and limit != into.shear_limit:
            deck.error(card, card.at("TAUMAX"), "the largest shear traction stays for all steps")
        into.shear_limit = limit or None
    if card.has("ROUGH"):
        _rub(deck, into, MOST_FRICTION)
        return
    if card.has("EXPONENTIALDECAY") or len(rows) > 1:
        found = _varying(deck, card, rows)
        if found is not None:
            _rub(deck, into, found)
        return
    if not rows:
        deck.error(card, card.where, "a data line is missing: the friction coefficient")
        return
    row = rows[0]
    mu = deck.real(card, row, 0, "the friction coefficient")
    if mu is None:
        return
    if mu < 0.0:
        deck.row_error(card, row, 0, f"the friction coefficient must be >= 0, not {mu:g}")
        return
    _rub(deck, into, mu)
    if any(row.fields[1:]):
        deck.note(f"{row.at(1)}: {card.spelled}: no stick slope is needed: sticking is exact")


def _varying(deck: Deck, card: Card, rows: list[Row]) -> Friction | None:
    """Static and kinetic coefficient and decay, or coefficients by slip rate and pressure."""
    decays = card.has("EXPONENTIALDECAY")
    if decays and len(rows) != 1:
        text = f"one data line is expected: static, kinetic coefficient, decay; found {len(rows)}"
        deck.error(card, card.where, text)
        return None
    names = ("the static coefficient", "the kinetic coefficient", "the decay coefficient")
    if not decays:
        names = ("the friction coefficient", "the slip rate", "the contact pressure")
    given = []
    for row in rows:
        deck.extra_fields(card, row, 3 if decays else 4)
        defaults = (None, None, None) if decays else (None, 0.0, 0.0)
        values = [deck.real(card, row, i, names[i], defaults[i]) for i in range(3)]
        if None in values:
            return None
        given.append(tuple(float(v or 0.0) for v in values))
        if not decays and row.get(3) != rows[0].get(3):
            deck.row_error(card, row, 3, "friction that depends on the temperature is not read")
            return None
    try:
        return DecayingFriction(*given[0]) if decays else FrictionTable(given)  # type: ignore[arg-type]
    except InputError as error:
        deck.error(card, rows[0].where, error.message)
        return None


def _rub(deck: Deck, into: InteractionDraft, mu: Friction) -> None:
    """Set the coefficient of the model, or that from the open step on."""
    if deck.step is None:
        into.friction = mu
    else:
        into.friction_steps[len(deck.steps)] = mu


def model_change(deck: Deck, card: Card) -> None:
    """``*MODEL CHANGE, TYPE=CONTACT PAIR or ELEMENT, ADD or REMOVE``: pairs, or elements."""
    kind = deck.choice(card, "TYPE", ("CONTACTPAIR", "ELEMENT"), "ELEMENT")
    added, removed = (card.has(name) for name in ("ADD", "REMOVE"))
    if card.has("ACTIVATE"):
        deck.note(
            f"{card.where}: {card.spelled}, ACTIVATE is ignored: nothing needs to be prepared"
        )
        return
    if added == removed:
        deck.error(card, card.where, "either ADD or REMOVE is expected")
        return
    if deck.step is None:
        deck.error(card, card.where, "the card belongs in a step")
        return
    if kind == "ELEMENT":
        _change_elements(deck, deck.step, card, added)
        return
    for row in _pair_rows(deck, card):
        slave, master = row.get(0), row.get(1) or row.get(0)
        for pair in _named_pairs(deck, card, slave, master, True, row.where):
            pair.changes[len(deck.steps)] = added


def _change_elements(deck: Deck, step: StepDraft, card: Card, added: bool) -> None:
    """Lines of element numbers and sets that leave the structure or join it."""
    ways = {"": 1, "STRAINFREE": 1, "WITHSTRAIN": 2}
    way = key(card.value("ADD")) if added else ""
    if way not in ways:
        deck.error(card, card.at("ADD"), f"expected STRAIN FREE or WITH STRAIN, found {way}")
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: elements or element sets")
    for row in rows:
        for name in filter(None, row.fields):
            change = Draft("cells", card, row, name, (), ways[way] if added else 0)
            step.element_changes.append(change)


def clearance(deck: Deck, card: Card) -> None:
    """``*CLEARANCE, SLAVE=, MASTER=, VALUE=``: gap at the start."""
    deck.no_rows(card)
    if not deck.required(card, "VALUE"):
        return
    value = deck.parameter_number(card, "VALUE", 0.0, -math.inf)
    for pair in _named_pairs(deck, card, card.value("SLAVE"), card.value("MASTER"), True):
        pair.clearance = value


def contact_controls(deck: Deck, card: Card) -> None:
    """``*CONTACT CONTROLS, STABILIZE[, SLAVE=, MASTER=]``: damp bodies without other supports."""
    if not card.has("STABILIZE"):
        deck.note(f"{card.where}: {card.spelled} is ignored: contact needs no control parameters")
        return
    if card.value("STABILIZE") or list(card.rows()):
        deck.note(f"{card.where}: {card.spelled}: the factor is not used; the damping is chosen")
    named = card.has("SLAVE") or card.has("MASTER")
    # Like other controls it applies to later steps, too.
    first = max(len(deck.steps), 1)
    if deck.general is not None and not named:
        deck.general.stabilize = deck.general.stabilize or first
        if not any(not pair.tied for pair in deck.pairs):
            return
    for pair in _named_pairs(deck, card, card.value("SLAVE"), card.value("MASTER"), named):
        pair.stabilize = pair.stabilize or first


def contact_interference(deck: Deck, card: Card) -> None:
    """``*CONTACT INTERFERENCE, SHRINK``: slave, master whose overlap is removed slowly."""
    if not card.has("SHRINK"):
        deck.error(card, card.where, "SHRINK is expected", hint="or use *CLEARANCE, VALUE=")
        return
    if len(deck.steps) != 1 or deck.step is None:
        deck.error(card, card.where, "the card belongs in the first step")
        return
    for row in _pair_rows(deck, card):
        slave, master = row.get(0), row.get(1) or row.get(0)
        for pair in _named_pairs(deck, card, slave, master, True, row.where):
            pair.start = "ramp"


def _named_pairs(
    deck: Deck, card: Card, slave: str, master: str, named: bool, where: Location | None = None
) -> list[PairDraft]:
    """Pairs with these surfaces, or all; an error if there are none."""
    pairs = [p for p in deck.pairs if not p.tied]
    found = [p for p in pairs if p.joins(slave, master)] if named else pairs
    if not found:
        known = ", ".join(f"{p.slave}, {p.master}" for p in pairs) or "none"
        deck.error(
            card,
            where or card.where,
            f"no *CONTACT PAIR of {slave or '?'} and {master or '?'} before this card",
            hint=f"slave, master of the pairs: {known}",
        )
    return found


def interaction_of(deck: Deck, pair: PairDraft) -> InteractionDraft | None:
    """Interaction that a pair names; ``None`` after an error."""
    found = deck.interactions.get(key(pair.interaction))
    if found is None:
        names = [i.name for i in deck.interactions.values()]
        deck.error(
            pair.card,
            pair.card.at("INTERACTION") if pair.card.has("INTERACTION") else pair.row.where,
            f"no *SURFACE INTERACTION named {numerals.shown(pair.interaction)}",
            hint=nearest(pair.interaction, names),
        )
    return found

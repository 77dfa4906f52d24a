"""Cards of contact: pairs of surfaces, what happens between them, rigid curves, ties."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from corota.errors import InputError
from corota.io.deck import numerals
from corota.io.deck.card import Card, Refused, Row, complete, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import Draft, InteractionDraft, PairDraft, StepDraft, Surface
from corota.io.deck.keywords import keyword
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


def profile(card: Card, found: Surface) -> None:
    """``*SURFACE, TYPE=SEGMENTS``: START, then LINE and CIRCL; the outward normal on the left."""
    radius = card.number("FILLETRADIUS", 0.0, 0.0)
    at: tuple[float, float] | None = None
    rows: list[tuple[float, ...]] = []
    for row in card.rows():
        kind = key(row.get(0))
        count = {"START": 2, "LINE": 2, "CIRCL": 4}.get(kind)
        if count is None:
            why = "parabolas are not supported: use arcs" if kind == "PARAB" else ""
            row.refuse(0, f"expected START, LINE or CIRCL, found {row.get(0)!r}", why)
        row.at_most(1 + count)
        names = ("x", "y", "x of the center", "y of the center")
        x, y, *center = row.reals(names[:count], start=1)
        if (at is None) != (kind == "START"):
            row.refuse(0, "START, x, y comes first" if at is None else "START comes only once")
        if at is not None:
            if math.dist(at, (x, y)) == 0.0:
                row.refuse(1, "the segment has no length")
            sweep = _sweep(row, at, (x, y), (center[0], center[1])) if center else 0.0
            rows.append((*at, x, y, *(center or (0.0, 0.0)), sweep))
        at = (x, y)
    if not rows:
        card.refuse(f"surface {found.name} needs START and one segment at least")
    found.profile = np.array(rows)
    if radius > 0.0:
        if found.profile[:, 6].any():
            text = "FILLET RADIUS rounds the corners of straight lines only: give the arcs by CIRCL"
            card.error(text, "FILLETRADIUS")
        found.fillet = radius


def _sweep(
    row: Row, start: tuple[float, float], end: tuple[float, float], center: tuple[float, float]
) -> float:
    """Angle of an arc of less than half a turn."""
    a, b = (complex(*p) - complex(*center) for p in (start, end))
    if abs(abs(a) - abs(b)) > 1e-4 * max(abs(a), abs(b)) or abs(a) == 0.0:
        text = f"the ends of the arc are {abs(a):g} and {abs(b):g} away from its center; they must "
        row.refuse(3, f"{text}be equally far")
    turn = math.atan2((b * a.conjugate()).imag, (b * a.conjugate()).real)
    if abs(turn) > math.pi * (1.0 - 1e-9):
        row.refuse(1, "an arc must be less than 180 degrees: give it in two")
    return turn


@keyword(
    "CONTACT PAIR",
    "INTERACTION TYPE ADJUST SMALLSLIDING SMOOTH TIED",
    "EXTENSIONZONE HCRIT TRACKING NOTHICKNESS SUPPLEMENTARYCONSTRAINTS OP WEIGHT CPSET "
    "MECHANICALCONSTRAINT GEOMETRICCORRECTION MINIMUMDISTANCE",
)
def contact_pair(deck: Deck, card: Card) -> None:
    """``*CONTACT PAIR, INTERACTION=, TYPE=[, ADJUST=][, SMOOTH=]``: slave, master."""
    interaction = card.required("INTERACTION")
    if not card.has("TYPE"):
        deck.note(f"{card.where}: no TYPE: surface to surface (mortar) is taken")
    method = TYPES.get(card.choice("TYPE", TYPES, "MORTAR"), "mortar")
    if card.has("SMALLSLIDING"):
        deck.note(f"{card.where}: SMALL SLIDING: sliding is always finite")
    smooth = card.number("SMOOTH", 0.0, 0.0) > 0.0
    start, adjust, nodes = "keep", 0.0, ""
    if card.has("ADJUST"):
        start = "adjust"
        try:
            adjust = numerals.real(card.value("ADJUST"))
        except ValueError:
            nodes = card.required("ADJUST")
        if adjust < 0.0:
            card.refuse("ADJUST must be >= 0", "ADJUST")
    tied = card.has("TIED")
    if tied:
        deck.note(f"{card.where}: TIED surfaces are joined where they are at the start")
    for row in _pair_rows(card):
        pair = PairDraft(row, row.get(0), row.get(1) or row.get(0), tied, interaction, method)
        begins_in(pair, len(deck.steps))
        pair.start, pair.adjust, pair.adjust_set, pair.smooth = start, adjust, nodes, smooth
        deck.pairs.append(pair)


def begins_in(pair: PairDraft, step: int) -> None:
    """Let a pair act from a step on, as explicit steps of Abaqus define contact."""
    if step > 1:
        pair.changes = {0: False, step: True}


@keyword("TIE", "NAME POSITIONTOLERANCE ADJUST", "TYPE NOROTATION NOTHICKNESS", place="model")
def tie(deck: Deck, card: Card) -> None:
    """``*TIE, NAME=[, POSITION TOLERANCE=][, ADJUST=NO]``: slave, master."""
    tolerance = card.number("POSITIONTOLERANCE", 0.0, 0.0)
    if card.choice("ADJUST", ("YES", "NO"), "YES") == "YES":
        text = "nodes are not moved onto the master surface; the distance at the start is kept"
        card.note(text)
    for row in _pair_rows(card):
        if not row.get(1):
            row.error(1, "the master surface is missing")
            continue
        pair = PairDraft(row, row.get(0), row.get(1), tied=True, adjust=tolerance)
        pair.name = card.value("NAME")
        deck.pairs.append(pair)


def _pair_rows(card: Card) -> list[Row]:
    rows = card.lines("slave surface, master surface")
    for row in rows:
        row.at_most(2)
        if not row.get(0):
            row.error(0, "the slave surface is missing")
    return [row for row in rows if row.get(0)]


@keyword(
    "SURFACE INTERACTION",
    "NAME",
    "DEPVAR PROPERTIES UNSYMM PADTHICKNESS TRACKINGTHICKNESS",
    place="model",
)
def surface_interaction(deck: Deck, card: Card) -> None:
    """``*SURFACE INTERACTION, NAME=``: opens an interaction; a data line is a thickness."""
    name = card.required("NAME")
    deck.interaction = None
    if name and key(name) in deck.interactions:
        card.error(f"interaction {name} is already defined", "NAME")
    elif name:
        for row in card.rows():
            row.note("the thickness is that of the section")
        deck.interaction = deck.interactions[key(name)] = InteractionDraft(name, card)


def _open(deck: Deck, card: Card) -> InteractionDraft:
    if deck.interaction is None:
        card.refuse("the card belongs under a *SURFACE INTERACTION, but there is none before it")
    return deck.interaction


def _changed(deck: Deck, card: Card, change: str) -> InteractionDraft:
    """The interaction that the card `change` before this one names in a step."""
    old, deck.changed = deck.changed, None
    if old is None:
        hint = f"put *CHANGE {change}, INTERACTION= before it to change an interaction"
        card.refuse(f"{card.spelled} inside a step", hint=hint)
    return old


@keyword(
    "SURFACE BEHAVIOR", "PRESSURE-OVERCLOSURE NOSEPARATION", "AUGMENTEDLAGRANGE DIRECT PENALTY"
)
def surface_behavior(deck: Deck, card: Card) -> None:
    """``*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=``: pressure against overclosure."""
    if deck.step is None:
        into = _open(deck, card)
    else:
        old = _changed(deck, card, "SURFACE BEHAVIOR")
        if old.friction_steps or old.law == "TIED":
            card.refuse("an interaction is changed in its friction or its law alone")
        into = replace(old, pressure=[], overclosure=[], friction_steps={}, later={}, damping=None)
        old.later[len(deck.steps)] = into
    law = card.choice("PRESSURE-OVERCLOSURE", LAWS, "HARD")
    rows = list(card.rows())
    into.law, into.law_where = law, card.where
    if card.has("NOSEPARATION"):
        into.separates = False
        if law != "HARD":
            text = "surfaces that do not separate are in hard contact"
            card.error(text, "NOSEPARATION", hint="leave PRESSURE-OVERCLOSURE out")
    if law in ("HARD", "TIED"):
        if rows:
            what = "nothing penetrates" if law == "HARD" else "the surfaces are joined exactly"
            rows[0].note(f"{what}, the numbers are not used")
        return
    if law != "TABULAR" and len(rows) != 1:
        card.refuse(f"one data line is expected with {law}, found {len(rows)}")
    for row in rows:
        if law == "LINEAR":
            pressure, overclosure = row.number(0, "the stiffness"), 0.0
            if any(row.fields[1:]):
                row.note("tension and the contact search distance are not used")
        elif law == "TABULAR":
            row.at_most(3)
            pressure, overclosure = row.reals(("the pressure", "the overclosure"))
        else:
            row.at_most(3)
            names = ("the clearance at zero pressure", "the pressure at zero clearance")
            overclosure, pressure = row.reals(names)
        into.pressure.append(pressure)
        into.overclosure.append(overclosure)
    if law == "EXPONENTIAL":
        card.note("the pressure is zero at the clearance c0, as in Abaqus (CalculiX: 1 % of p0)")


@keyword("CONTACT DAMPING", "DEFINITION", "TANGENTFRACTION", place="model")
def contact_damping(deck: Deck, card: Card) -> None:
    """``*CONTACT DAMPING``: without effect in steps without velocities, and on hard contact."""
    into = _open(deck, card)
    card.choice("DEFINITION", ("DAMPINGCOEFFICIENT", "CRITICALDAMPINGFRACTION"), "")
    into.damping = card


@keyword("CHANGE SURFACE BEHAVIOR", "INTERACTION")
def change_surface_behavior(deck: Deck, card: Card) -> None:
    """``*CHANGE SURFACE BEHAVIOR, INTERACTION=``: the law below it holds from this step."""
    deck.changed = _to_change(deck, card)


def _to_change(deck: Deck, card: Card) -> InteractionDraft | None:
    """The interaction that a card of a step names."""
    card.no_rows()
    name = card.required("INTERACTION")
    found = deck.interactions.get(key(name))
    if deck.step is None:
        card.refuse("the card belongs in a step")
    if found is None and name:
        names = [i.name for i in deck.interactions.values()]
        text = f"no *SURFACE INTERACTION named {numerals.shown(name)}"
        card.error(text, "INTERACTION", hint=nearest(name, names))
    return found


@keyword("CHANGE FRICTION", "INTERACTION RESET RAMP")
def change_friction(deck: Deck, card: Card) -> None:
    """``*CHANGE FRICTION, INTERACTION=[, RESET]``: ``*FRICTION`` below it holds from this step."""
    deck.changed = None
    found = _to_change(deck, card)
    if found is not None:
        # Abaqus changes it over the step, as it lets loads grow; CalculiX at once.
        found.friction_ramps = card.has("RAMP") or deck.dialect == "abaqus"
        if card.has("RESET"):
            found.friction_steps[len(deck.steps)] = found.friction
        else:
            deck.changed = found


@keyword(
    "FRICTION",
    "ROUGH TAUMAX EXPONENTIALDECAY",
    "SLIPTOLERANCE LAGRANGE ELASTICSLIP SHEARTRACTIONSLOPE",
)
def friction(deck: Deck, card: Card) -> None:
    """``*FRICTION``: coefficient, stick slope; more lines, ``EXPONENTIAL DECAY``: one that varies.

    ``ROUGH``: what touches does not slide.
    """
    into = _open(deck, card) if deck.step is None else _changed(deck, card, "FRICTION")
    if card.has("TAUMAX"):
        limit = card.number("TAUMAX", math.inf, 0.0)
        if limit == 0.0:
            card.error("the largest shear traction must be > 0", "TAUMAX")
        if deck.step is not None and limit != into.shear_limit:
            card.error("the largest shear traction stays for all steps", "TAUMAX")
        into.shear_limit = limit or None
    mu = _coefficient(card, list(card.rows()))
    if deck.step is None:
        into.friction = mu
    else:
        into.friction_steps[len(deck.steps)] = mu


def _varying(card: Card, rows: list[Row]) -> Friction:
    """Static and kinetic coefficient and decay, or coefficients by slip rate and pressure."""
    decays = card.has("EXPONENTIALDECAY")
    if decays and len(rows) != 1:
        text = f"one data line is expected: static, kinetic coefficient, decay; found {len(rows)}"
        card.refuse(text)
    names = ("the static coefficient", "the kinetic coefficient", "the decay coefficient")
    if not decays:
        names = ("the friction coefficient", "the slip rate", "the contact pressure")
    given = []
    for row in rows:
        row.at_most(3 if decays else 4)
        defaults = (None, None, None) if decays else (None, 0.0, 0.0)
        given.append(complete([row.real(i, names[i], defaults[i]) for i in range(3)]))
        if not decays and row.get(3) != rows[0].get(3):
            row.refuse(3, "friction that depends on the temperature is not read")
    try:
        return (
            DecayingFriction(*given[0])
            if decays
            else FrictionTable([(a, b, c) for a, b, c in given])
        )
    except InputError as error:
        card.deck.error(card, rows[0].where, error.message)
        raise Refused from None


def _coefficient(card: Card, rows: list[Row]) -> Friction:
    """The coefficient of ``*FRICTION``."""
    if card.has("ROUGH"):
        return MOST_FRICTION
    if card.has("EXPONENTIALDECAY") or len(rows) > 1:
        return _varying(card, rows)
    if not rows:
        card.refuse("a data line is missing: the friction coefficient")
    mu = rows[0].number(0, "the friction coefficient")
    if mu < 0.0:
        rows[0].refuse(0, f"the friction coefficient must be >= 0, not {mu:g}")
    if any(rows[0].fields[1:]):
        text = "no stick slope is needed: sticking is exact"
        card.deck.note(f"{rows[0].at(1)}: {card.spelled}: {text}")
    return mu


@keyword("MODEL CHANGE", "TYPE ADD REMOVE ACTIVATE")
def model_change(deck: Deck, card: Card) -> None:
    """``*MODEL CHANGE, TYPE=CONTACT PAIR or ELEMENT, ADD or REMOVE``: pairs, or elements."""
    kind = card.choice("TYPE", ("CONTACTPAIR", "ELEMENT"), "ELEMENT")
    added, removed = (card.has(name) for name in ("ADD", "REMOVE"))
    if card.has("ACTIVATE"):
        deck.note(
            f"{card.where}: {card.spelled}, ACTIVATE is ignored: nothing needs to be prepared"
        )
        return
    if added == removed:
        card.refuse("either ADD or REMOVE is expected")
    if deck.step is None:
        card.refuse("the card belongs in a step")
    if kind == "ELEMENT":
        _change_elements(deck.step, card, added)
        return
    for row in _pair_rows(card):
        for pair in _named_pairs(deck, card, row):
            pair.changes[len(deck.steps)] = added


def _change_elements(step: StepDraft, card: Card, added: bool) -> None:
    """Lines of element numbers and sets that leave the structure or join it."""
    ways = {"": 1, "STRAINFREE": 1, "WITHSTRAIN": 2}
    way = key(card.value("ADD")) if added else ""
    if way not in ways:
        card.refuse(f"expected STRAIN FREE or WITH STRAIN, found {way}", "ADD")
    for row in card.lines("elements or element sets"):
        for name in filter(None, row.fields):
            step.element_changes.append(Draft("cells", row, name, (), ways[way] if added else 0))


@keyword("CLEARANCE", "SLAVE MASTER VALUE", place="model")
def clearance(deck: Deck, card: Card) -> None:
    """``*CLEARANCE, SLAVE=, MASTER=, VALUE=``: gap at the start."""
    card.no_rows()
    if card.required("VALUE"):
        value = card.number("VALUE", 0.0, -math.inf)
        for pair in _named_pairs(deck, card):
            pair.clearance = value


@keyword(
    "CONTACT CONTROLS",
    "STABILIZE SLAVE MASTER",
    "RESET AUTOMATICTOLERANCES APPROACH MAXCHP PERRMX UERRMX FRICTIONONSET TANGENTFRACTION "
    "LAGRANGEMULTIPLIER ABSOLUTEPENETRATIONTOLERANCE RELATIVEPENETRATIONTOLERANCE "
    "STIFFNESSSCALEFACTOR TYPE CPSET FASTLOCALTRK GLOBTRKINC SCALEPENALTY WARP",
)
def contact_controls(deck: Deck, card: Card) -> None:
    """``*CONTACT CONTROLS, STABILIZE[, SLAVE=, MASTER=]``: damp bodies without other supports."""
    if not card.has("STABILIZE"):
        deck.note(f"{card.where}: {card.spelled} is ignored: contact needs no control parameters")
        return
    if card.value("STABILIZE") or list(card.rows()):
        card.note("the factor is not used; the damping is chosen")
    named = card.has("SLAVE") or card.has("MASTER")
    # Like other controls it applies to later steps, too.
    first = max(len(deck.steps), 1)
    if deck.general is not None and not named:
        deck.general.stabilize = deck.general.stabilize or first
        if all(pair.tied for pair in deck.pairs):
            return
    for pair in _named_pairs(deck, card, every=not named):
        pair.stabilize = pair.stabilize or first


@keyword("CONTACT INTERFERENCE", "SHRINK", "TYPE OP")
def contact_interference(deck: Deck, card: Card) -> None:
    """``*CONTACT INTERFERENCE, SHRINK``: slave, master whose overlap is removed slowly."""
    if not card.has("SHRINK"):
        card.refuse("SHRINK is expected", hint="or use *CLEARANCE, VALUE=")
    if len(deck.steps) != 1 or deck.step is None:
        card.refuse("the card belongs in the first step")
    for row in _pair_rows(card):
        for pair in _named_pairs(deck, card, row):
            pair.start = "ramp"


def _named_pairs(
    deck: Deck, card: Card, row: Row | None = None, every: bool = False
) -> list[PairDraft]:
    """Pairs with the surfaces of a row or of the card, or all; an error if there are none."""
    slave, master = card.value("SLAVE"), card.value("MASTER")
    if row is not None:
        slave, master = row.get(0), row.get(1) or row.get(0)
    pairs = [p for p in deck.pairs if not p.tied]
    found = [p for p in pairs if every or p.joins(slave, master)]
    if not found:
        known = ", ".join(f"{p.slave}, {p.master}" for p in pairs) or "none"
        deck.error(
            card,
            card.where if row is None else row.where,
            f"no *CONTACT PAIR of {slave or '?'} and {master or '?'} before this card",
            hint=f"slave, master of the pairs: {known}",
        )
    return found


def interaction_of(deck: Deck, pair: PairDraft) -> InteractionDraft | None:
    """Interaction that a pair names; ``None`` after an error."""
    found = deck.interactions.get(key(pair.interaction))
    if found is None:
        card, names = pair.row.card, [i.name for i in deck.interactions.values()]
        deck.error(
            card,
            card.at("INTERACTION") if card.has("INTERACTION") else pair.row.where,
            f"no *SURFACE INTERACTION named {numerals.shown(pair.interaction)}",
            hint=nearest(pair.interaction, names),
        )
    return found

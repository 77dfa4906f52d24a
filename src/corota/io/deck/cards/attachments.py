"""Point masses, rotary inertias, dashpots and gaps of decks: elements, and their values."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.cards.tie import PLANAR
from corota.io.deck.deck import nearest
from corota.io.deck.drafts import AttachedDraft, Draft
from corota.io.deck.elements import ATTACHED
from corota.io.deck.lexer import key
from corota.model.attachments import Dashpot, PointMass
from corota.model.constraints import Coupling, Equation
from corota.model.contact import gap_element

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card
    from corota.mesh.data import Ints
    from corota.model.model import Model

    Find = Callable[[Draft], str | Ints | None]

#: The card that gives the value of each.
CARDS = {
    "MASS": "MASS",
    "ROTARYI": "ROTARY INERTIA",
    "DASHPOTA": "DASHPOT",
    "DASHPOT1": "DASHPOT",
    "GAPUNI": "GAP",
    "CONN2D2": "CONNECTOR SECTION",
}
#: Connections of two nodes in the plane, and the dofs that they share; BEAM is rigid.
CONNECTIONS = {"JOIN": (0, 1), "HINGE": (0, 1), "WELD": (0, 1, 2), "BEAM": ()}
_OTHERS = {
    "LINK": "use a truss (T2D2) of a stiff material",
    "AXIAL": "use SPRINGA with *SPRING, DASHPOTA with *DASHPOT",
    "CARTESIAN": "use SPRING2 with *SPRING",
    "SLOT": "use *MPC, SLIDER",
    "TRANSLATOR": "use *MPC, SLIDER",
}


def elements(deck: Deck, card: Card, type_: str) -> None:
    """``*ELEMENT, TYPE=`` one of :data:`CARDS`: label, nodes.

    The set names them.
    """
    name = deck.required(card, "ELSET")
    draft = AttachedDraft(type_, name, card)
    count = ATTACHED[type_]
    for row in card.rows():
        deck.extra_fields(card, row, count + 1)
        numbers = [deck.integer(card, row, 0, "the element number")]
        numbers += [deck.node(card, row, i, f"node {i}") for i in range(1, count + 1)]
        if None in numbers:
            continue
        if len({row.get(i) for i in range(1, count + 1)}) < count:
            deck.row_error(card, row, 2, f"node {numbers[1]} occurs twice")
            continue
        draft.labels.append(int(numbers[0] or 0))
        draft.nodes.append([Draft("node", card, row, row.get(i), ()) for i in range(1, count + 1)])
    if name:
        deck.attached.append(draft)


def mass(deck: Deck, card: Card) -> None:
    """``*MASS, ELSET=``: the mass at each node of the set."""
    _value(deck, card, "MASS", "the mass")


def rotary_inertia(deck: Deck, card: Card) -> None:
    """``*ROTARY INERTIA, ELSET=``: I11, I22 and that about the normal of the plane, I33."""
    _value(deck, card, "ROTARYI", "the inertia about the normal of the plane", 2)


def dashpot(deck: Deck, card: Card) -> None:
    """``*DASHPOT, ELSET=``: an empty line or, to the ground, the dof; then force per velocity."""
    name = key(card.value("ELSET"))
    if not any(d.type == "DASHPOT1" and key(d.name) == name for d in deck.attached):
        _value(deck, card, "DASHPOTA", "the damping")
        return
    rows = list(card.rows())
    if len(rows) != 2:
        text = f"two data lines are expected, the dof and the damping, found {len(rows)}"
        deck.error(card, card.where, text)
        return
    dof = deck.integer(card, rows[0], 0, "the degree of freedom")
    value = deck.real(card, rows[1], 0, "the damping")
    if dof is None or value is None:
        return
    if dof not in PLANAR:
        deck.row_error(card, rows[0], 0, f"expected 1, 2 or 6 (rotation), found {dof}")
    elif not value >= 0.0:
        deck.row_error(card, rows[1], 0, f"the damping must be >= 0, not {value:g}")
    else:
        _assign(deck, card, "DASHPOT1", tuple(value * (i == PLANAR[dof]) for i in range(3)))


def _value(deck: Deck, card: Card, type_: str, what: str, place: int = 0) -> None:
    name = deck.required(card, "ELSET")
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, f"a data line is missing: {what}")
        return
    value = deck.real(card, rows[0], place, what)
    for row in rows[1:]:
        deck.row_error(card, row, 0, f"one data line is expected, {what}, constant in time")
        return
    if rows[0].get(1) and not place:
        deck.note(f"{rows[0].where}: the temperature or frequency {rows[0].get(1)} is ignored")
    if value is None or not name:
        return
    if not value >= 0.0:
        deck.row_error(card, rows[0], place, f"{what} must be >= 0, not {value:g}")
        return
    _assign(deck, card, type_, (value,))


def gap(deck: Deck, card: Card) -> None:
    """``*GAP, ELSET=``: clearance, direction from the first node to the second.

    Without a direction it is that of the line through the nodes.
    """
    rows = list(card.rows())
    if not deck.required(card, "ELSET"):
        return
    if len(rows) != 1:
        deck.error(card, card.where, f"one data line is expected, found {len(rows)}")
        return
    row = rows[0]
    clearance = deck.real(card, row, 0, "the clearance")
    given = [i for i in (1, 2, 3) if row.get(i)]
    direction = [deck.real(card, row, i, "the direction") if i in given else 0.0 for i in (1, 2, 3)]
    if clearance is None or None in direction:
        return
    x, y, z = (float(v or 0.0) for v in direction)
    if z != 0.0:
        deck.row_error(card, row, 3, f"the direction of a gap lies in the plane, not along z = {z}")
        return
    if given and x == y == 0.0:
        deck.row_error(card, row, 1, "the direction of a gap has no length")
        return
    if any(row.fields[4:]):
        text = "area, stiffness and tension are not used: a gap closes exactly"
        deck.note(f"{row.where}: {card.spelled}: {text}")
    _assign(deck, card, "GAPUNI", (clearance, x, y))


def connector_section(deck: Deck, card: Card) -> None:
    """``*CONNECTOR SECTION, ELSET=``: JOIN, HINGE, WELD or BEAM."""
    name, rows = deck.required(card, "ELSET"), list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the kind of the connection")
        return
    kind, turns = key(rows[0].get(0)), key(rows[0].get(1))
    if kind == "JOIN" and turns == "ALIGN":
        kind, turns = "WELD", ""
    if kind not in CONNECTIONS or turns not in ("", "REVOLUTE"):
        said = rows[0].get(0) if kind not in CONNECTIONS else rows[0].get(1)
        hint = f"there are {', '.join(CONNECTIONS)} and JOIN, ALIGN"
        text = f"connection {said!r} is not part of this version"
        deck.row_error(card, rows[0], 0, text, _OTHERS.get(kind, hint))
    if name:
        place = list(CONNECTIONS).index(kind) if kind in CONNECTIONS else -1
        _assign(deck, card, "CONN2D2", (float(place),))


def _connect(
    deck: Deck,
    model: Model,
    draft: AttachedDraft,
    nodes: list[int],
    find: Find,
    rotating: NDArray[np.bool_],
) -> None:
    """Constraints of one connector."""
    if draft.value[0] < 0.0:
        return  # the kind is refused already
    kind, where = list(CONNECTIONS)[int(draft.value[0])], draft.card.where
    first, second = nodes
    drafts = [*deck.supports, *(d for step in deck.steps for d in step.supports)]
    held = (find(d) for d in drafts)
    if any(n is not None and first in model.mesh.node_indices(n) for n in held):
        first, second = second, first  # a node that supports hold leads
    if kind == "BEAM":
        model.constraints.append(Coupling(np.array([first]), second, where=where))
        rotating[second] = True
        return
    if kind == "WELD" and rotating[nodes].any():
        rotating[nodes] = True
    away = float(np.hypot(*(model.mesh.points[second] - model.mesh.points[first])))
    if away > 1e-6 * float(np.ptp(model.mesh.points, axis=0).max()):
        labels = model.mesh.node_labels[nodes]
        deck.error(
            draft.card,
            where,
            f"nodes {labels[0]} and {labels[1]} of a connection {kind} are {away:g} apart",
            hint="give them one place, or use BEAM",
        )
        return
    for dof in CONNECTIONS[kind]:
        if dof < 2 or rotating[nodes].all():
            terms = [(first, dof, 1.0), (second, dof, -1.0)]
            model.constraints.append(Equation(terms, 0.0, where))


def _assign(deck: Deck, card: Card, type_: str, value: tuple[float, ...]) -> None:
    name = card.value("ELSET")
    mine = [d for d in deck.attached if d.type == type_ and key(d.name) == key(name)]
    for draft in mine:
        if draft.value:
            deck.error(card, card.at("ELSET"), f"{name} already has its value")
            return
        draft.value = value
    if not mine:
        names = [d.name for d in deck.attached if d.type == type_]
        deck.error(
            card,
            card.at("ELSET"),
            f"no *ELEMENT, TYPE={type_} with the set {name!r} before this card",
            hint=nearest(name, names),
        )


def build_attachments(deck: Deck, model: Model, find: Find, rotating: NDArray[np.bool_]) -> None:
    """Add the deck's point masses, dashpots, connectors and gaps to the model."""
    number = -1
    for draft in deck.attached:
        if not draft.value:
            deck.error(
                draft.card,
                draft.card.at("ELSET"),
                f"no *{CARDS[draft.type]}, ELSET={draft.name} gives these elements a value",
            )
            continue
        for label, drafts in zip(draft.labels, draft.nodes, strict=True):
            number += 1
            found = [find(d) for d in drafts]
            nodes = [int(n[0]) for n in found if n is not None and not isinstance(n, str)]
            if len(nodes) < len(drafts):
                continue
            where = drafts[0].row.where
            if draft.type in ("MASS", "ROTARYI"):
                deck.masses[number] = len(model.point_masses)
                (value,), turns = draft.value, draft.type == "ROTARYI"
                mass, inertia = (0.0, value) if turns else (value, 0.0)
                model.point_masses.append(PointMass(np.array(nodes), mass, inertia, where))
            elif draft.type == "CONN2D2":
                _connect(deck, model, draft, nodes, find, rotating)
            elif draft.type == "DASHPOT1":
                x, y, turn = draft.value
                model.dashpots.append(Dashpot(nodes[0], to_ground=(x, y, turn), where=where))
            elif draft.type == "DASHPOTA":
                model.dashpots.append(Dashpot(nodes[0], nodes[1], draft.value[0], where=where))
            else:
                points, (clearance, x, y) = model.mesh.points, draft.value
                direction = (x, y) if x or y else tuple(points[nodes[1]] - points[nodes[0]])
                both, name = (nodes[0], nodes[1]), f"{draft.name}-{label}"
                try:
                    found_gap = gap_element(points, both, clearance, direction, name, where)
                except InputError as error:
                    deck.error(draft.card, where, f"{error.message}; give it by *GAP")
                    continue
                model.contacts.append(found_gap)


__all__ = [
    "AttachedDraft",
    "build_attachments",
    "connector_section",
    "dashpot",
    "elements",
    "gap",
    "mass",
    "rotary_inertia",
]

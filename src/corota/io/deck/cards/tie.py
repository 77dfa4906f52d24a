"""Cards of constraints: equations, rigid bodies, couplings, local axes at nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from corota.io.deck.cards.step import turns_nlgeom_on
from corota.io.deck.drafts import Draft, TieDraft
from corota.io.deck.lexer import Card, Row, key
from corota.lazy import lazy

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

link = lazy("corota.io.deck.cards.connectors:link")

#: Degrees of freedom of decks in the plane, and their index here.
PLANAR = {1: 0, 2: 1, 6: 2}


def equation(deck: Deck, card: Card) -> None:
    """``*EQUATION``: number of terms, then node, dof, coefficient for each term."""
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "data lines are missing: the number of terms, the terms")
    fields = [(row, i) for row in rows for i in range(_used(row))]
    at = 0
    while at < len(fields):
        row, index = fields[at]
        count = deck.integer(card, row, index, "the number of terms")
        if count is None:
            return
        if count < 1 or index != 0:
            deck.row_error(card, row, index, "expected the number of terms, at least 1")
            return
        terms = fields[at + 1 : at + 1 + 3 * count]
        if len(terms) < 3 * count:
            deck.row_error(
                card, row, index, f"{count} terms need {3 * count} numbers, {len(terms)} follow"
            )
            return
        tie = TieDraft("equation", card, row.where, ready=True)
        for k in range(0, 3 * count, 3):
            (of_node, i), (of_dof, j), (of_value, c) = terms[k : k + 3]
            dof = deck.integer(card, of_dof, j, "the degree of freedom")
            value = deck.real(card, of_value, c, "the coefficient")
            if dof is None or value is None:
                return
            if not 1 <= dof <= 6:
                deck.row_error(card, of_dof, j, f"expected a degree of freedom 1 to 6, found {dof}")
                return
            if dof in PLANAR:
                tie.terms.append(
                    Draft("term", card, of_node, of_node.get(i), (value,), PLANAR[dof])
                )
        if tie.terms:  # terms that vanish in the plane are dropped
            deck.ties.append(tie)
        at += 1 + 3 * count


def _used(row: Row) -> int:
    """Fields up to the last that is not empty."""
    return max((i + 1 for i in range(len(row)) if row.get(i)), default=0)


def _reference(deck: Deck, card: Card, name: str) -> Draft | None:
    text = deck.required(card, name)
    if not text:
        return None
    return Draft("node", card, parameter_row(card, name), text, (0.0,))


def parameter_row(card: Card, name: str) -> Row:
    """Row of one field that stands for the value of a parameter."""
    from corota.io.deck.lexer import Row

    return Row(card.at(name), card.text, [card.value(name)], [card.at(name).column])


def rigid_body(deck: Deck, card: Card) -> None:
    """``*RIGID BODY, NSET= or ELSET= or ANALYTICAL SURFACE=, REF NODE=[, ROT NODE=]``."""
    deck.no_rows(card)
    profile = card.has("ANALYTICALSURFACE")
    alone = profile and not card.has("NSET") and not card.has("ELSET")
    # A profile without a reference node is fixed.
    fixed = alone and not card.has("REFNODE") and not card.has("ROTNODE")
    reference = None if fixed else _reference(deck, card, "REFNODE")
    if profile and (fixed or reference is not None):
        if not deck.required(card, "ANALYTICALSURFACE"):
            return
        deck.carriers[key(card.value("ANALYTICALSURFACE"))] = (card, reference)
    if alone:
        _rotation_node(deck, card, reference)
        return
    given = [p for p in ("NSET", "ELSET", "PINNSET", "TIENSET") if card.has(p)]
    if not given or (card.has("NSET") and card.has("ELSET")):
        deck.error(card, card.where, "either NSET= or ELSET= is expected")
        return
    _rotation_node(deck, card, reference)
    for parameter in given:
        name = deck.required(card, parameter)
        if reference is None or not name:
            return
        tie = TieDraft("kinematic", card, card.where, [reference], ready=True)
        if parameter == "ELSET":
            tie.elset = name
        else:
            tie.target = Draft("set", card, parameter_row(card, parameter), name, (0.0,))
        if parameter == "PINNSET":
            tie.dofs = (0, 1)
        deck.ties.append(tie)


def _rotation_node(deck: Deck, card: Card, reference: Draft | None) -> None:
    if card.has("ROTNODE") and reference is not None:
        # Its dof 3 is the rotation in the plane, its dofs 1 and 2 those out of it.
        deck.rotation_nodes[key(card.value("ROTNODE"))] = reference.target


def coupling(deck: Deck, card: Card) -> None:
    """``*COUPLING, REF NODE=, SURFACE=, CONSTRAINT NAME=``; its kind is the card after it."""
    deck.no_rows(card)
    reference = _reference(deck, card, "REFNODE")
    surface = deck.required(card, "SURFACE")
    if reference is not None and surface:
        tie = TieDraft("kinematic", card, card.where, [reference], surface=surface)
        if key(card.value("INFLUENCERADIUS")) not in ("", "WHOLESURFACE"):
            tie.radius = deck.parameter_number(card, "INFLUENCERADIUS", math.inf, 0.0)
        deck.ties.append(tie)


def kinematic(deck: Deck, card: Card) -> None:
    """``*KINEMATIC``: first and last dof that follow the reference node; by default all."""
    _kind(deck, card, "kinematic")


def distributing(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTING``: first and last dof of the reference node that follow the surface."""
    deck.choice(card, "WEIGHTINGMETHOD", ("UNIFORM",), "UNIFORM")
    _kind(deck, card, "distributing")


def kinematic_coupling(deck: Deck, card: Card) -> None:
    """``*KINEMATIC COUPLING, REF NODE=``: node or set, first dof, last dof."""
    reference = _reference(deck, card, "REFNODE")
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: node or set, first dof, last dof")
    for row in rows:
        deck.extra_fields(card, row, 3)
        first = deck.integer(card, row, 1, "the first dof", 1)
        last = deck.integer(card, row, 2, "the last dof", first if row.get(1) else 6)
        if reference is None or first is None or last is None:
            return
        dofs = tuple(PLANAR[d] for d in range(first, last + 1) if d in PLANAR)
        if not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
        elif not 1 <= first <= last <= 6:
            deck.row_error(card, row, 1, "expected 1 <= first dof <= last dof <= 6")
        elif dofs:
            tie = TieDraft("kinematic", card, row.where, [reference], ready=True, dofs=dofs)
            tie.target = Draft("set", card, row, row.get(0), (0.0,))
            deck.ties.append(tie)


def couplers(deck: Deck, card: Card) -> None:
    """``*ELEMENT, TYPE=DCOUP2D`` or ``DCOUP3D``: number, reference node of a coupling."""
    name = deck.required(card, "ELSET")
    for row in card.rows():
        deck.extra_fields(card, row, 2)
        label = deck.integer(card, row, 0, "the element number")
        node = deck.integer(card, row, 1, "the reference node")
        if name and label is not None and node is not None:
            deck.couplers[key(name)] = Draft("node", card, row, str(node), ())


def distributing_coupling(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTING COUPLING, ELSET=``: node or set, weight."""
    name = deck.required(card, "ELSET")
    tie = TieDraft("distributing", card, card.where, ready=True, elset=name)
    for row in card.rows():
        deck.extra_fields(card, row, 2)
        weight = deck.real(card, row, 1, "the weight", 1.0)
        if not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
        elif weight is not None and weight <= 0.0:
            deck.row_error(card, row, 1, f"the weight must be > 0, not {weight:g}")
        elif weight is not None:
            tie.members.append((Draft("node", card, row, row.get(0), (0.0,)), weight))
    if not list(card.rows()):
        deck.error(card, card.where, "a data line is missing: node or set, weight")
    elif name and tie.members:
        deck.ties.append(tie)


def _kind(deck: Deck, card: Card, kind: str) -> None:
    tie = deck.ties[-1] if deck.ties else None
    if tie is None or tie.ready or not tie.surface:
        deck.error(card, card.where, "the card belongs to a *COUPLING, but there is none before it")
        return
    tie.kind, tie.ready = kind, True
    dofs: list[int] = []
    for row in card.rows():
        deck.extra_fields(card, row, 2)
        first = deck.integer(card, row, 0, "the first dof")
        last = deck.integer(card, row, 1, "the last dof", first)
        if first is None or last is None:
            return
        if not 1 <= first <= last <= 6:
            deck.row_error(card, row, 0, "expected 1 <= first dof <= last dof <= 6")
            return
        dofs += [PLANAR[d] for d in range(first, last + 1) if d in PLANAR]
    if dofs:
        tie.dofs = tuple(sorted(set(dofs)))
    elif list(card.rows()):
        deck.error(card, card.where, "no dof of the plane is coupled; 1 = x, 2 = y, 6 = rotation")


def mpc(deck: Deck, card: Card) -> None:
    """``*MPC``: ``BEAM``, ``PIN`` or ``TIE`` with two nodes or sets, ``STRAIGHT`` with many.

    ``LINK`` keeps a distance, ``LINEAR`` is a node between two others, ``SLIDER`` a line whose
    ends come last. ``PLANE`` holds by itself. Rows that begin with a node continue the one before.
    """
    line: TieDraft | None = None
    turns_nlgeom_on(deck, "*MPC")
    for row in card.rows():
        type_ = key(row.get(0))
        if type_ == "STRAIGHT":
            line = TieDraft("straight", card, row.where, ready=True)
            _on_line(line, card, row, 1)
            deck.ties.append(line)
            continue
        if line is not None and type_.isdecimal():
            _on_line(line, card, row, 0)
            continue
        line = None
        if type_ == "SLIDER":
            deck.extra_fields(card, row, 4)
            between = TieDraft("straight", card, row.where, ready=True)
            _on_line(between, card, row, 1)
            between.terms = [*between.terms[1:], *between.terms[:1]]
            deck.ties.append(between)
            continue
        if type_ == "PLANE":
            deck.note(f"{row.where}: the nodes of a planar model lie in a plane: *MPC, PLANE holds")
            continue
        if type_ == "LINK":
            link(deck, card, row)
            continue
        if type_ == "LINEAR":
            deck.extra_fields(card, row, 4)
            between = TieDraft("between", card, row.where, ready=True)
            _on_line(between, card, row, 1)
            deck.ties.append(between)
            continue
        if type_ not in ("BEAM", "PIN", "TIE"):
            deck.row_error(
                card,
                row,
                0,
                f"MPC type {row.get(0)!r} is not supported",
                "BEAM, PIN, TIE, LINK, LINEAR, STRAIGHT, SLIDER, PLANE are; or write *EQUATION, "
                "*RIGID BODY or *COUPLING",
            )
            continue
        deck.extra_fields(card, row, 3)
        if not row.get(1) or not row.get(2):
            deck.row_error(card, row, 1, "two nodes are expected")
            continue
        follows = Draft("set", card, row, row.get(1), (0.0,))
        leads = Draft("node", card, row, row.get(2), (0.0,))
        kind = "kinematic" if type_ == "BEAM" else "same"
        tie = TieDraft(kind, card, row.where, [leads], follows, ready=True)
        if type_ == "PIN":
            tie.dofs = (0, 1)
        deck.ties.append(tie)


def _on_line(tie: TieDraft, card: Card, row: Row, start: int) -> None:
    """Take the nodes of a row; zeros are ignored."""
    for i in range(start, len(row)):
        if row.get(i) not in ("", "0"):
            tie.terms.append(Draft("node", card, row, row.get(i), (0.0,)))


def transform(deck: Deck, card: Card) -> None:
    """``*TRANSFORM, NSET=, TYPE=R or C``: two points that give the axes."""
    name = deck.required(card, "NSET")
    type_ = deck.choice(card, "TYPE", ("R", "C"), "R")
    rows = list(card.rows())
    if len(rows) != 1:
        deck.error(card, card.where, "one data line is expected: ax, ay, az, bx, by, bz")
        return
    row = rows[0]
    deck.extra_fields(card, row, 6)
    numbers = [
        deck.real(card, row, i, text, 0.0)
        for i, text in enumerate(("ax", "ay", "az", "bx", "by", "bz"))
    ]
    if None in numbers or not name:
        return
    ax, ay, az, bx, by, bz = (float(v or 0.0) for v in numbers)
    tie = TieDraft("axes", card, card.where, ready=True)
    tie.target = Draft("set", card, parameter_row(card, "NSET"), name, (0.0,))
    if type_ == "C":
        if math.hypot(bx - ax, by - ay) > 1e-9 * abs(bz - az) or bz <= az:
            deck.row_error(
                card, row, 0, "the axis from a to b must be normal to the plane and point to +z"
            )
            return
        tie.center = (ax, ay)
    else:
        cross = ax * by - ay * bx
        if math.hypot(ax, ay) == 0.0 or az != 0.0 or bz != 0.0 or cross <= 0.0:
            deck.row_error(
                card, row, 0, "a lies on the first axis and b left of it, both in the plane"
            )
            return
        tie.angle = math.atan2(ay, ax)
    deck.ties.append(tie)

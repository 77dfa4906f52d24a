"""Cards of constraints: equations, rigid bodies, couplings, local axes at nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from typing import TYPE_CHECKING

from corota.io.deck.card import Card, Refused, Row, both, complete, key
from corota.io.deck.cards.step import turns_nlgeom_on
from corota.io.deck.drafts import PLANAR, Draft, TieDraft
from corota.io.deck.keywords import keyword
from corota.lazy import lazy

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

#: Constraints of ``*MPC``, and their kinds.
MPC_KINDS = {"BEAM": "kinematic", "PIN": "same", "TIE": "same", "LINEAR": "between"}
MPC_KINDS |= {"STRAIGHT": "straight", "SLIDER": "straight"}

link = lazy("corota.io.deck.cards.connectors:link")


@keyword("EQUATION", place="model")
def equation(deck: Deck, card: Card) -> None:
    """``*EQUATION``: number of terms, then node, dof, coefficient for each term."""
    rows = list(card.rows())
    if not rows:
        card.error("data lines are missing: the number of terms, the terms")
    used = [max((i + 1 for i in range(len(row)) if row.get(i)), default=0) for row in rows]
    fields = [(row, i) for row, count in zip(rows, used, strict=True) for i in range(count)]
    at = 0
    while at < len(fields):
        row, index = fields[at]
        count = row.whole(index, "the number of terms")
        if count < 1 or index != 0:
            row.refuse(index, "expected the number of terms, at least 1")
        terms = fields[at + 1 : at + 1 + 3 * count]
        if len(terms) < 3 * count:
            text = f"{count} terms need {3 * count} numbers, {len(terms)} follow"
            row.refuse(index, text)
        tie = TieDraft("equation", card, row.where, ready=True)
        for k in range(0, 3 * count, 3):
            (of_node, i), (of_dof, j), (of_value, c) = terms[k : k + 3]
            way = of_dof.integer(j, "the degree of freedom")
            dof, value = both(way, of_value.real(c, "the coefficient"))
            if not 1 <= dof <= 6:
                of_dof.refuse(j, f"expected a degree of freedom 1 to 6, found {dof}")
            if dof in PLANAR:
                tie.terms.append(Draft("term", of_node, of_node.get(i), (value,), PLANAR[dof]))
        if tie.terms:  # terms that vanish in the plane are dropped
            deck.ties.append(tie)
        at += 1 + 3 * count


def _reference(card: Card) -> Draft | None:
    text = card.required("REFNODE")
    return Draft("node", card.row_of("REFNODE"), text, (0.0,)) if text else None


@keyword(
    "RIGID BODY",
    "NSET ELSET ANALYTICALSURFACE REFNODE ROTNODE PINNSET TIENSET",
    "POSITION ISOTHERMAL",
    place="model",
)
def rigid_body(deck: Deck, card: Card) -> None:
    """``*RIGID BODY, NSET= or ELSET= or ANALYTICAL SURFACE=, REF NODE=[, ROT NODE=]``."""
    card.no_rows()
    profile = card.has("ANALYTICALSURFACE")
    alone = profile and not card.has("NSET") and not card.has("ELSET")
    # A profile without a reference node is fixed.
    fixed = alone and not card.has("REFNODE") and not card.has("ROTNODE")
    reference = None if fixed else _reference(card)
    if profile and (fixed or reference is not None):
        if not card.required("ANALYTICALSURFACE"):
            return
        deck.carriers.append((card, reference))
    given = [p for p in ("NSET", "ELSET", "PINNSET", "TIENSET") if card.has(p)]
    if not alone and (not given or (card.has("NSET") and card.has("ELSET"))):
        card.refuse("either NSET= or ELSET= is expected")
    if card.has("ROTNODE") and reference is not None:
        # Its dof 3 is the rotation in the plane, its dofs 1 and 2 those out of it.
        deck.rotation_nodes[key(card.value("ROTNODE"))] = reference.target
    for parameter in given if not alone else ():
        name = card.required(parameter)
        if reference is None or not name:
            return
        tie = TieDraft("kinematic", card, card.where, [reference], ready=True)
        if parameter == "ELSET":
            tie.elset = name
        else:
            tie.target = Draft("set", card.row_of(parameter), name, (0.0,))
        if parameter == "PINNSET":
            tie.dofs = (0, 1)
        deck.ties.append(tie)


@keyword("COUPLING", "REFNODE SURFACE INFLUENCERADIUS", "CONSTRAINTNAME", place="model")
def coupling(deck: Deck, card: Card) -> None:
    """``*COUPLING, REF NODE=, SURFACE=, CONSTRAINT NAME=``; its kind is the card after it."""
    card.no_rows()
    reference, surface = _reference(card), card.required("SURFACE")
    if reference is not None and surface:
        tie = TieDraft("kinematic", card, card.where, [reference], surface=surface)
        if key(card.value("INFLUENCERADIUS")) not in ("", "WHOLESURFACE"):
            tie.radius = card.number("INFLUENCERADIUS", math.inf, 0.0)
        deck.ties.append(tie)


@keyword("KINEMATIC", place="model")
def kinematic(deck: Deck, card: Card) -> None:
    """``*KINEMATIC``: first and last dof that follow the reference node; by default all."""
    _kind(deck, card, "kinematic")


@keyword("DISTRIBUTING", "WEIGHTINGMETHOD", ignored="COUPLING", place="model")
def distributing(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTING``: first and last dof of the reference node that follow the surface."""
    card.choice("WEIGHTINGMETHOD", ("UNIFORM",), "UNIFORM")
    _kind(deck, card, "distributing")


@keyword("KINEMATIC COUPLING", "REFNODE", place="model")
def kinematic_coupling(deck: Deck, card: Card) -> None:
    """``*KINEMATIC COUPLING, REF NODE=``: node or set, first dof, last dof."""
    reference = _reference(card)
    for row in card.lines("node or set, first dof, last dof"):
        row.at_most(3)
        start = row.integer(1, "the first dof", 1)
        end = row.integer(2, "the last dof", start if row.get(1) else 6)
        first, last = complete([start, end])
        if reference is None:
            return
        dofs = tuple(PLANAR[d] for d in range(first, last + 1) if d in PLANAR)
        if not row.get(0):
            row.error(0, "a node number or a set is missing")
        elif not 1 <= first <= last <= 6:
            row.error(1, "expected 1 <= first dof <= last dof <= 6")
        elif dofs:
            nodes = Draft("set", row, row.get(0), (0.0,))
            tie = TieDraft("kinematic", card, row.where, [reference], nodes, dofs=dofs, ready=True)
            deck.ties.append(tie)


def couplers(deck: Deck, card: Card) -> None:
    """``*ELEMENT, TYPE=DCOUP2D`` or ``DCOUP3D``: number, reference node of a coupling."""
    name = card.required("ELSET")
    for row in card.rows():
        row.at_most(2)
        label, node = row.integer(0, "the element number"), row.integer(1, "the reference node")
        if name and label is not None and node is not None:
            deck.couplers[key(name)] = Draft("node", row, str(node), ())


@keyword("DISTRIBUTING COUPLING", "ELSET", place="model")
def distributing_coupling(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTING COUPLING, ELSET=``: node or set, weight."""
    name = card.required("ELSET")
    tie = TieDraft("distributing", card, card.where, ready=True, elset=name)
    for row in card.lines("node or set, weight"):
        row.at_most(2)
        weight = row.real(1, "the weight", 1.0)
        if not row.get(0):
            row.error(0, "a node number or a set is missing")
        elif weight is not None and weight <= 0.0:
            row.error(1, f"the weight must be > 0, not {weight:g}")
        elif weight is not None:
            tie.members.append((Draft("node", row, row.get(0), (0.0,)), weight))
    if name and tie.members:
        deck.ties.append(tie)


def _kind(deck: Deck, card: Card, kind: str) -> None:
    tie = deck.ties[-1] if deck.ties else None
    if tie is None or tie.ready or not tie.surface:
        card.refuse("the card belongs to a *COUPLING, but there is none before it")
    tie.kind, tie.ready = kind, True
    dofs: set[int] = set()
    rows = list(card.rows())
    for row in rows:
        row.at_most(2)
        start = row.integer(0, "the first dof")
        first, last = complete([start, row.integer(1, "the last dof", start)])
        if not 1 <= first <= last <= 6:
            row.refuse(0, "expected 1 <= first dof <= last dof <= 6")
        dofs |= {PLANAR[d] for d in range(first, last + 1) if d in PLANAR}
    if dofs:
        tie.dofs = tuple(sorted(dofs))
    elif rows:
        card.error("no dof of the plane is coupled; 1 = x, 2 = y, 6 = rotation")


@keyword("MPC", place="model")
def mpc(deck: Deck, card: Card) -> None:
    """``*MPC``: ``BEAM``, ``PIN`` or ``TIE`` with two nodes or sets, ``STRAIGHT`` with many.

    ``LINK`` keeps a distance, ``LINEAR`` is a node between two others, ``SLIDER`` a line whose
    ends come last. ``PLANE`` holds by itself. Rows that begin with a node continue the one before.
    """
    line: TieDraft | None = None
    turns_nlgeom_on(deck, "*MPC")
    for row in card.rows():
        type_ = key(row.get(0))
        if line is not None and type_.isdecimal():
            line.terms += _nodes(row, 0)
            continue
        line = None
        if type_ == "PLANE":
            deck.note(f"{row.where}: the nodes of a planar model lie in a plane: *MPC, PLANE holds")
            continue
        with suppress(Refused):
            if type_ == "LINK":
                link(deck, card, row)
                continue
            tie = _mpc(row, type_)
            deck.ties.append(tie)
            line = tie if type_ == "STRAIGHT" else None


def _mpc(row: Row, type_: str) -> TieDraft:
    """Constraint of one line of ``*MPC``."""
    if type_ not in MPC_KINDS:
        row.refuse(
            0,
            f"MPC type {row.get(0)!r} is not supported",
            "BEAM, PIN, TIE, LINK, LINEAR, STRAIGHT, SLIDER, PLANE are; or write *EQUATION, "
            "*RIGID BODY or *COUPLING",
        )
    kind = MPC_KINDS[type_]
    tie = TieDraft(kind, row.card, row.where, ready=True)
    if kind in ("straight", "between"):
        if type_ != "STRAIGHT":
            row.at_most(4)
        tie.terms = _nodes(row, 1)
        if type_ == "SLIDER":
            tie.terms = [*tie.terms[1:], *tie.terms[:1]]
        return tie
    row.at_most(3)
    if not row.get(1) or not row.get(2):
        row.refuse(1, "two nodes are expected")
    tie.target = Draft("set", row, row.get(1), (0.0,))
    tie.terms = [Draft("node", row, row.get(2), (0.0,))]
    if type_ == "PIN":
        tie.dofs = (0, 1)
    return tie


def _nodes(row: Row, start: int) -> list[Draft]:
    """Nodes of a row; zeros are ignored."""
    names = [row.get(i) for i in range(start, len(row))]
    return [Draft("node", row, name, (0.0,)) for name in names if name not in ("", "0")]


@keyword("TRANSFORM", "NSET TYPE", place="model")
def transform(deck: Deck, card: Card) -> None:
    """``*TRANSFORM, NSET=, TYPE=R or C``: two points that give the axes."""
    name = card.required("NSET")
    type_ = card.choice("TYPE", ("R", "C"), "R")
    names = ("ax", "ay", "az", "bx", "by", "bz")
    row = card.one_line(", ".join(names))
    row.at_most(6)
    ax, ay, az, bx, by, bz = row.reals(names, 0.0)
    if not name:
        return
    tie = TieDraft("axes", card, card.where, ready=True)
    tie.target = Draft("set", card.row_of("NSET"), name, (0.0,))
    if type_ == "C":
        if math.hypot(bx - ax, by - ay) > 1e-9 * abs(bz - az) or bz <= az:
            row.refuse(0, "the axis from a to b must be normal to the plane and point to +z")
        tie.center = (ax, ay)
    else:
        cross = ax * by - ay * bx
        if math.hypot(ax, ay) == 0.0 or az != 0.0 or bz != 0.0 or cross <= 0.0:
            row.refuse(0, "a lies on the first axis and b left of it, both in the plane")
        tie.angle = math.atan2(ay, ax)
    deck.ties.append(tie)

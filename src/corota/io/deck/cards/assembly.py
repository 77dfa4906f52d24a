"""Cards of parts, instances and the assembly."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

from corota.io.deck.card import Card, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import Instance, Scope
from corota.io.deck.keywords import keyword


@keyword("PART", "NAME", place="model")
def part(deck: Deck, card: Card) -> None:
    """``*PART, NAME=``: a name space of its own until ``*END PART``."""
    name = card.required("NAME")
    card.no_rows()
    if deck.in_assembly:
        card.refuse("a part cannot be defined inside the assembly")
    close_part(deck)
    if key(name) in deck.parts:
        card.error(f"part {name} is already defined", "NAME")
    deck.scope = deck.parts.setdefault(key(name), Scope(name))


@keyword("END PART", place="model")
def end_part(deck: Deck, card: Card) -> None:
    """``*END PART``."""
    card.no_rows()
    if deck.scope is deck.root or deck.instance is not None:
        card.refuse("there is no open *PART")
    deck.scope = deck.root


def close_part(deck: Deck) -> None:
    """End an open part that has no ``*END PART``, with a note."""
    if deck.scope is not deck.root and deck.instance is None:
        deck.note(f"part {deck.scope.name} has no *END PART; it ends where the next block begins")
        deck.scope = deck.root


@keyword("ASSEMBLY", "NAME", place="model")
def assembly(deck: Deck, card: Card) -> None:
    """``*ASSEMBLY, NAME=``."""
    card.no_rows()
    close_part(deck)
    if deck.in_assembly:
        card.error("another *ASSEMBLY is still open")
    deck.in_assembly = True


@keyword("END ASSEMBLY", place="model")
def end_assembly(deck: Deck, card: Card) -> None:
    """``*END ASSEMBLY``."""
    card.no_rows()
    if not deck.in_assembly:
        card.error("there is no open *ASSEMBLY")
    deck.in_assembly = False


@keyword("INSTANCE", "NAME PART", place="model")
def instance(deck: Deck, card: Card) -> None:
    """``*INSTANCE, NAME=, PART=``: shift, then a turn about an axis normal to the plane.

    What stands before ``*END INSTANCE`` (mesh, sets, sections) belongs to this instance only.
    """
    name, source = card.required("NAME"), card.required("PART")
    if not deck.in_assembly or deck.instance is not None:
        card.refuse("an instance belongs inside *ASSEMBLY, not in another instance")
    if not name or not source:
        return
    if key(source) not in deck.parts:
        hint = nearest(source, [p.name for p in deck.parts.values()])
        card.refuse(f"no part named {source!r}", "PART", hint)
    if key(name) in deck.instances:
        card.refuse(f"instance {name} is already defined", "NAME")
    found = Instance(name, key(source), card)
    rows = list(card.rows())
    if rows:
        rows[0].at_most(3)
        x, y, z = rows[0].reals(("shift x", "shift y", "shift z"), 0.0)
        if z != 0.0:
            rows[0].error(2, "a shift out of the plane z = 0")
        found.shift = (x, y)
    if len(rows) > 1:
        rows[1].at_most(7)
        ax, ay, az, bx, by, bz, degrees = rows[1].reals(["the axis or the angle"] * 7)
        if bz == az or abs(bx - ax) + abs(by - ay) > 1e-9 * abs(bz - az):
            rows[1].refuse(0, "the axis of rotation must be normal to the plane")
        found.center, found.angle = (ax, ay), math.radians(degrees) * (1 if bz > az else -1)
    for row in rows[2:3]:
        row.error(0, "at most two data lines are expected")
    deck.instances[key(name)] = deck.instance = found
    deck.scope = found.scope


@keyword("END INSTANCE", place="model")
def end_instance(deck: Deck, card: Card) -> None:
    """``*END INSTANCE``."""
    card.no_rows()
    if deck.instance is None:
        card.refuse("there is no open *INSTANCE")
    deck.instance, deck.scope = None, deck.root

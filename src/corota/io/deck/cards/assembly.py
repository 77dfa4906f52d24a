"""Cards of parts, instances and the assembly."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import Instance, Scope
from corota.io.deck.lexer import Card, key


def part(deck: Deck, card: Card) -> None:
    """``*PART, NAME=``: a name space of its own until ``*END PART``."""
    name = deck.required(card, "NAME")
    deck.no_rows(card)
    if deck.in_assembly:
        deck.error(card, card.where, "a part cannot be defined inside the assembly")
        return
    close_part(deck)
    if key(name) in deck.parts:
        deck.error(card, card.at("NAME"), f"part {name} is already defined")
    deck.scope = deck.parts.setdefault(key(name), Scope(name))


def end_part(deck: Deck, card: Card) -> None:
    """``*END PART``."""
    deck.no_rows(card)
    if deck.scope is deck.root or deck.instance is not None:
        deck.error(card, card.where, "there is no open *PART")
        return
    deck.scope = deck.root


def close_part(deck: Deck) -> None:
    """End an open part that has no ``*END PART``, with a note."""
    if deck.scope is not deck.root and deck.instance is None:
        deck.note(f"part {deck.scope.name} has no *END PART; it ends where the next block begins")
        deck.scope = deck.root


def assembly(deck: Deck, card: Card) -> None:
    """``*ASSEMBLY, NAME=``."""
    deck.no_rows(card)
    close_part(deck)
    if deck.in_assembly:
        deck.error(card, card.where, "another *ASSEMBLY is still open")
    deck.in_assembly = True


def end_assembly(deck: Deck, card: Card) -> None:
    """``*END ASSEMBLY``."""
    deck.no_rows(card)
    if not deck.in_assembly:
        deck.error(card, card.where, "there is no open *ASSEMBLY")
    deck.in_assembly = False


def instance(deck: Deck, card: Card) -> None:
    """``*INSTANCE, NAME=, PART=``: shift, then a turn about an axis normal to the plane.

    What stands before ``*END INSTANCE`` (mesh, sets, sections) belongs to this instance only.
    """
    name = deck.required(card, "NAME")
    source = deck.required(card, "PART")
    if not deck.in_assembly or deck.instance is not None:
        deck.error(
            card, card.where, "an instance belongs inside *ASSEMBLY, not in another instance"
        )
        return
    if not name or not source:
        return
    if key(source) not in deck.parts:
        deck.error(
            card,
            card.at("PART"),
            f"no part named {source!r}",
            hint=nearest(source, [p.name for p in deck.parts.values()]),
        )
        return
    if key(name) in deck.instances:
        deck.error(card, card.at("NAME"), f"instance {name} is already defined")
        return
    found = Instance(name, key(source), card)
    rows = list(card.rows())
    if rows:
        deck.extra_fields(card, rows[0], 3)
        x, y, z = (deck.real(card, rows[0], i, f"shift {'xyz'[i]}", 0.0) for i in range(3))
        if x is None or y is None or z is None:
            return
        if z != 0.0:
            deck.row_error(card, rows[0], 2, "a shift out of the plane z = 0")
        found.shift = (x, y)
    if len(rows) > 1:
        deck.extra_fields(card, rows[1], 7)
        values = [deck.real(card, rows[1], i, "the axis or the angle") for i in range(7)]
        if None in values:
            return
        ax, ay, _, bx, by, bz, degrees = (float(v or 0.0) for v in values)
        az = float(values[2] or 0.0)
        if bz == az or abs(bx - ax) + abs(by - ay) > 1e-9 * abs(bz - az):
            deck.row_error(card, rows[1], 0, "the axis of rotation must be normal to the plane")
            return
        found.center, found.angle = (ax, ay), math.radians(degrees) * (1 if bz > az else -1)
    for row in rows[2:]:
        deck.row_error(card, row, 0, "at most two data lines are expected")
        break
    deck.instances[key(name)] = found
    deck.instance = found
    deck.scope = found.scope


def end_instance(deck: Deck, card: Card) -> None:
    """``*END INSTANCE``."""
    deck.no_rows(card)
    if deck.instance is None:
        deck.error(card, card.where, "there is no open *INSTANCE")
        return
    deck.instance, deck.scope = None, deck.root

"""``*DISTRIBUTION``: values by element, for orientations and thicknesses of shells."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import DistributionDraft
from corota.io.deck.lexer import Card, Row, key

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats, Ints
    from corota.io.deck.build.mesh import View
    from corota.io.deck.build.sets import Sets

    Read = Callable[[Deck, Card, Row, int], float | None]


def distribution(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTION, NAME=, LOCATION=ELEMENT``: default; element or set, values."""
    name = deck.required(card, "NAME")
    place = deck.choice(card, "LOCATION", ("ELEMENT", "NODE", "NONE"), "ELEMENT")
    if place != "ELEMENT":
        hint = "give thicknesses of nodes by *NODAL THICKNESS" if place == "NODE" else ""
        deck.error(card, card.at("LOCATION"), "values are given by element", hint=hint)
        return
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the default values")
    elif name and key(name) in deck.scope.distributions:
        deck.error(card, card.at("NAME"), f"distribution {name} is already defined")
    elif name:
        deck.scope.distributions[key(name)] = DistributionDraft(name, card, rows)


def distribution_table(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTION TABLE``: kinds of the values, which follow from where they are used."""
    list(card.rows())


def plane_angle(deck: Deck, card: Card, row: Row, first: int = 0) -> float | None:
    """Angle of the first axis [rad] from six coordinates of a line, after `first` fields.

    They are a point on the first axis and one in the plane; None after an error.
    """
    deck.extra_fields(card, row, first + 6)
    names = ("ax", "ay", "az", "bx", "by", "bz")
    values = [deck.real(card, row, first + i, name, 0.0) for i, name in enumerate(names)]
    if None in values:
        return None
    ax, ay, az, bx, by, bz = (float(v or 0.0) for v in values)
    scale = math.hypot(ax, ay)
    if scale == 0.0 or abs(az) > 1e-9 * scale or abs(bz) > 1e-9 * math.hypot(bx, by, bz):
        text = "both points must lie in the plane z = 0, off the origin"
        deck.row_error(card, row, first, text)
        return None
    cross = ax * by - ay * bx
    if abs(cross) <= 1e-12 * scale * math.hypot(bx, by):
        deck.row_error(card, row, first + 3, "the two points and the origin lie on one line")
        return None
    if cross < 0.0:
        text = "the third axis would point to -z; give b left of the line to a"
        deck.row_error(card, row, first + 3, text)
        return None
    return math.atan2(ay, ax)


def thickness(deck: Deck, card: Card, row: Row, first: int = 0) -> float | None:
    """A thickness after `first` fields; None after an error."""
    deck.extra_fields(card, row, first + 1)
    value = deck.real(card, row, first, "the thickness")
    if value is not None and value <= 0.0:
        deck.row_error(card, row, first, f"the thickness must be > 0, not {value:g}")
        return None
    return value


def by_cell(
    deck: Deck, sets: Sets, view: View, use: tuple[Card, str], cells: Ints, read: Read
) -> Floats | None:
    """Values of a distribution in cells, shape (n,); None after an error.

    Parameters
    ----------
    use : Card, str
        The card that names the distribution, and this name.
    cells : ndarray of int, shape (n,)
    read : callable
        Reads a value from a line.
    """
    card, name = use
    known = deck.root.distributions | view.scope.distributions
    found = known.get(key(name))
    if found is None:
        hint = nearest(name, [d.name for d in known.values()])
        deck.error(card, card.where, f"no distribution named {name!r}", hint=hint)
        return None
    out = np.full(len(cells), math.nan)
    for row in found.rows:
        value = read(deck, found.card, row, 1)
        if value is None:
            return None
        if not row.get(0):
            out[:] = value
            continue
        named = sets.elements(view, row.get(0), row.at(0), found.card, row.text)
        if named is None:
            return None
        out[np.isin(cells, named.cells)] = value
    if np.isnan(out).any():
        label = sets.mesh.cell_labels[cells[np.isnan(out)][0]]
        text = f"distribution {found.name} has no value for element {label}"
        deck.error(found.card, found.card.where, text, hint="give the default on its first line")
        return None
    return out

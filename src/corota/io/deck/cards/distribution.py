"""``*DISTRIBUTION``: values by element, for orientations and thicknesses of shells."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.card import Card, Refused, Row, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import DistributionDraft
from corota.io.deck.keywords import keyword

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats, Ints
    from corota.io.deck.build.mesh import View
    from corota.io.deck.build.sets import Sets

    Read = Callable[[Row, int], float]


@keyword("DISTRIBUTION", "NAME LOCATION TABLE", place="model")
def distribution(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTION, NAME=, LOCATION=ELEMENT``: default; element or set, values."""
    name = card.required("NAME")
    place = card.choice("LOCATION", ("ELEMENT", "NODE", "NONE"), "ELEMENT")
    if place != "ELEMENT":
        hint = "give thicknesses of nodes by *NODAL THICKNESS" if place == "NODE" else ""
        card.refuse("values are given by element", "LOCATION", hint)
    rows = card.lines("the default values")
    if name and key(name) in deck.scope.distributions:
        card.error(f"distribution {name} is already defined", "NAME")
    elif name:
        deck.scope.distributions[key(name)] = DistributionDraft(name, card, rows)


@keyword("DISTRIBUTION TABLE", "NAME", place="model")
def distribution_table(deck: Deck, card: Card) -> None:
    """``*DISTRIBUTION TABLE``: kinds of the values, which follow from where they are used."""


def plane_angle(row: Row, first: int = 0) -> float:
    """Angle of the first axis [rad] from six coordinates of a line, after `first` fields.

    They are a point on the first axis and one in the plane.

    Raises
    ------
    Refused
        After an error.
    """
    row.at_most(first + 6)
    ax, ay, az, bx, by, bz = row.reals(("ax", "ay", "az", "bx", "by", "bz"), 0.0, first)
    scale = math.hypot(ax, ay)
    if scale == 0.0 or abs(az) > 1e-9 * scale or abs(bz) > 1e-9 * math.hypot(bx, by, bz):
        row.refuse(first, "both points must lie in the plane z = 0, off the origin")
    cross = ax * by - ay * bx
    if abs(cross) <= 1e-12 * scale * math.hypot(bx, by):
        row.refuse(first + 3, "the two points and the origin lie on one line")
    if cross < 0.0:
        row.refuse(first + 3, "the third axis would point to -z; give b left of the line to a")
    return math.atan2(ay, ax)


def thickness(row: Row, first: int = 0) -> float:
    """A thickness after `first` fields; as :func:`plane_angle`."""
    row.at_most(first + 1)
    return row.positive(("the thickness",), first)[0]


def by_cell(
    deck: Deck, sets: Sets, view: View, use: tuple[Card, str], cells: Ints, read: Read
) -> Floats:
    """Values of a distribution in cells, shape (n,).

    Parameters
    ----------
    use : Card, str
        The card that names the distribution, and this name.
    cells : ndarray of int, shape (n,)
    read : callable
        Reads a value from a line.

    Raises
    ------
    Refused
        After an error.
    """
    card, name = use
    known = deck.root.distributions | view.scope.distributions
    found = known.get(key(name))
    if found is None:
        hint = nearest(name, [d.name for d in known.values()])
        card.refuse(f"no distribution named {name!r}", hint=hint)
    out = np.full(len(cells), math.nan)
    for row in found.rows:
        value = read(row, 1)
        if not row.get(0):
            out[:] = value
            continue
        named = sets.elements(view, row.get(0), row.at(0), found.card, row.text)
        if named is None:
            raise Refused
        out[np.isin(cells, named.cells)] = value
    if np.isnan(out).any():
        label = sets.mesh.cell_labels[cells[np.isnan(out)][0]]
        text = f"distribution {found.name} has no value for element {label}"
        found.card.refuse(text, hint="give the default on its first line")
    return out

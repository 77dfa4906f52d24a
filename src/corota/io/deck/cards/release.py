"""Hinges at ends of beams."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck import numerals
from corota.io.deck.card import Card, key
from corota.io.deck.drafts import Draft, ElementBlock, ReleaseDraft, Scope, TieDraft
from corota.io.deck.elements import LINE_ELEMENTS
from corota.io.deck.keywords import keyword

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.deck import Deck

#: Ends of an element.
ENDS = {"S1": 0, "S2": -1}
#: What is released: whether it is the moment in the plane.
MOMENTS = {"M1": True, "ALLM": True, "M1-M2": True, "M2": False, "T": False, "M1-T": True}
MOMENTS |= {"M2-T": False}


@keyword("RELEASE", place="model")
def release(deck: Deck, card: Card) -> None:
    """``*RELEASE``: element or set, S1 or S2, moments that the end does not carry."""
    for row in card.rows():
        row.at_most(3)
        end, what = key(row.get(1)), key(row.get(2))
        if not row.get(0):
            row.error(0, "an element number or a set is missing")
        elif end not in ENDS:
            row.error(1, f"expected S1 or S2, found {row.get(1)!r}")
        elif what not in MOMENTS:
            row.error(2, f"expected {', '.join(MOMENTS)}, found {row.get(2)!r}")
        elif not MOMENTS[what]:
            row.note(f"{what} acts out of the plane and is ignored")
        else:
            deck.releases.append(ReleaseDraft(row, deck.scope, ENDS[end]))
    if not list(card.rows()):
        card.error("a data line is missing: element or set, S1 or S2, moments")


def add_releases(deck: Deck) -> None:
    """Give released ends a node of their own, which moves with the other but turns freely."""
    for draft in deck.releases:
        labels = _labels(draft.scope, draft.row.get(0))
        hinged = False
        for block in draft.scope.elements:
            if block.type not in LINE_ELEMENTS or LINE_ELEMENTS[block.type].role != "beam":
                continue
            for row in np.flatnonzero(np.isin(block.labels, labels)).tolist():
                hinged = True
                _hinge(deck, draft, block, row)
        if not hinged:
            draft.row.error(0, f"no beams in {draft.row.get(0)}")


def _labels(scope: Scope, name: str) -> Ints:
    """Numbers of the elements of a set, or the number itself."""
    if numerals.is_label(name):
        return np.array([int(name)], np.int64)
    named = scope.elsets.get(key(name))
    if named is None:
        return np.zeros(0, np.int64)
    parts = [_labels(scope, e.name) if e.name else e.labels for e in named.entries]
    return np.concatenate([np.zeros(0, np.int64), *parts])


def _hinge(deck: Deck, draft: ReleaseDraft, block: ElementBlock, row: int) -> None:
    old = int(block.nodes[row, draft.end])
    point = point_of(draft.scope, old)
    if point is not None:  # its element is reported otherwise
        at = Draft("node", draft.row, str(old), (0.0,))
        block.nodes[row, draft.end] = int(add_twin(deck, draft.scope, at, point).target)


def point_of(scope: Scope, label: int) -> Floats | None:
    """Coordinates of a node, shape (1, 3); ``None`` where the scope has none with this number."""
    for block in scope.nodes:
        found = np.flatnonzero(block.labels == label)
        if len(found):
            return np.array(block.points[found[-1:]], np.float64)
    return None


def add_twin(deck: Deck, scope: Scope, old: Draft, point: Floats) -> Draft:
    """A new node at the place of another, which moves with it but turns freely."""
    new = Draft("node", old.row, str(scope.add_node(point, old.row.where)), (0.0,))
    tie = TieDraft("same", old.card, old.row.where, [old], new, ready=True, dofs=(0, 1))
    deck.ties.append(tie)
    return new

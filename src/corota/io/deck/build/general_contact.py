"""General contact of a deck: its pairs of surfaces."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.deck.drafts import InteractionDraft, PairDraft, Surface
from corota.io.deck.lexer import Row, key

if TYPE_CHECKING:
    from corota.io.deck.build.sets import Sets
    from corota.io.deck.deck import Deck
    from corota.model.model import Model

#: Names of the surface of all outer edges, and of contact that no card describes.
EXTERIOR, DEFAULT = "ALL_EXTERIOR", "GENERAL_CONTACT"


def add_general(deck: Deck, model: Model, sets: Sets) -> None:
    """Add the pairs of general contact to those of the deck.

    All outer edges are one surface with self-contact, which covers contact between bodies
    and within each body; every rigid profile and rigid side that is a surface is another master.
    """
    draft = deck.general
    if draft is None:
        return
    card = draft.card
    if not draft.every and not draft.pairs:
        deck.error(card, card.where, "general contact has no *CONTACT INCLUSIONS below it")
        return
    interaction = draft.interaction
    if not interaction:
        interaction = DEFAULT
        deck.interactions.setdefault(key(DEFAULT), InteractionDraft(DEFAULT, card))
        deck.note(f"{card.where}: general contact without an interaction: hard, no friction")
    names = [(row.get(0), row.get(1) or row.get(0), of, row) for of, row in draft.pairs]
    if draft.every:
        row = Row(draft.where or card.where, card.text, [""], [1])
        root = sets.views[0]
        surface = Surface(EXTERIOR, card, False)
        sets.surfaces[key(EXTERIOR)] = (root, surface)
        model.mesh.edge_sets[EXTERIOR] = model.mesh.boundary_edges()
        names.append((EXTERIOR, EXTERIOR, card, row))
        rigid = [
            view.prefix + s.name
            for view, s in sets.surfaces.values()
            if s.profile is not None or (not s.nodes and sets.rigid_sides(view, s))
        ]
        names += [(EXTERIOR, name, card, row) for name in rigid]
        deck.note(
            f"{card.where}: general contact: all outer edges, each body with itself included"
            + (f", and {', '.join(rigid)}" if rigid else "")
            + "; mortar, finite sliding"
        )
    for slave, master, of, row in names:
        pair = PairDraft(of, row, slave, master, interaction=interaction)
        pair.start, pair.stabilize = "adjust", draft.stabilize
        deck.pairs.append(pair)


__all__ = ["add_general"]

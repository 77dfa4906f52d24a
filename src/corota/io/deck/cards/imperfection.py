"""``*IMPERFECTION``: nodes moved by shapes of an earlier job, or by given amounts."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import FileError
from corota.io.deck.drafts import Draft
from corota.io.deck.lexer import Card, Row

if TYPE_CHECKING:
    from pathlib import Path

    from corota.arrays import Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.deck import Deck
    from corota.mesh import Mesh
    from corota.results.frame import Frame

#: Endings of result files, in the order in which they are tried.
ENDINGS = ("modes.vtkhdf", "vtkhdf", "frd")


@dataclass(eq=False, repr=False)
class ImperfectionDraft:
    """One ``*IMPERFECTION``: modes of a result file with their factors, or moves of nodes."""

    card: Card
    file: str = ""
    step: int = 1
    #: Increment of a static step, 0 for the last.
    increment: int = 0
    modes: list[tuple[Row, int, float]] = field(default_factory=list)
    moves: list[Draft] = field(default_factory=list)


def imperfection(deck: Deck, card: Card) -> None:
    """``*IMPERFECTION, FILE=, STEP=[, INC=][, NSET=]``: mode, factor; or node or set, x, y."""
    deck.choice(card, "SYSTEM", ("R",), "R")
    draft = ImperfectionDraft(card, card.value("FILE"))
    if card.has("FILE"):
        deck.required(card, "FILE")
        if deck.required(card, "STEP"):
            draft.step = deck.parameter_integer(card, "STEP", 1, 1)
        draft.increment = deck.parameter_integer(card, "INC", 0, 1)
    else:
        for name in ("STEP", "INC", "NSET"):
            if card.has(name):
                deck.error(card, card.at(name), f"{name}= goes with FILE=")
    rows = list(card.rows())
    if not rows:
        what = "a mode and its factor" if draft.file else "a node and its displacement"
        deck.error(card, card.where, f"a data line is missing: {what}")
    for row in rows:
        if draft.file:
            deck.extra_fields(card, row, 2)
            mode = deck.integer(card, row, 0, "the mode")
            factor = deck.real(card, row, 1, "the factor")
            if mode is not None and factor is not None:
                draft.modes.append((row, mode, factor))
            continue
        deck.extra_fields(card, row, 4)
        moved = [deck.real(card, row, i, "the displacement", 0.0) for i in (1, 2, 3)]
        if moved[2]:
            deck.row_error(card, row, 3, "a displacement out of the plane is not supported")
        elif None not in moved and row.get(0):
            by = (float(moved[0] or 0.0), float(moved[1] or 0.0))
            draft.moves.append(Draft("imperfection", card, row, row.get(0), by))
        elif not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
    deck.later("mesh", move_nodes, draft)


def move_nodes(targets: Targets, drafts: list[ImperfectionDraft]) -> None:
    """Move the nodes of a mesh, in place."""
    deck, mesh, find = targets.deck, targets.mesh, targets.nodes
    for draft in drafts:
        for move in draft.moves:
            nodes = find(move)
            if nodes is not None:
                mesh.points[mesh.node_indices(nodes)] += move.value
        if not draft.file or not draft.modes:
            continue
        path = _results_of(deck, draft)
        if path is None:
            continue
        nodes = np.arange(mesh.n_nodes)
        if draft.card.has("NSET"):
            card, name = draft.card, draft.card.value("NSET")
            row = Row(card.where, card.text, [name], [card.at("NSET").column])
            found = find(Draft("imperfection", card, row, name, ()))
            if found is None:
                continue
            nodes = mesh.node_indices(found)
        try:
            _move_by_results(deck, draft, path, mesh, nodes)
        except FileError as error:
            deck.error(draft.card, draft.card.at("FILE"), str(error))


def _results_of(deck: Deck, draft: ImperfectionDraft) -> Path | None:
    """The result file that a card names, in the folder of the deck; ``None`` after an error."""
    assert deck.lexer is not None
    folder, name = deck.lexer.path.parent, draft.file
    places = [folder / name, *(folder / f"{name}.{ending}" for ending in ENDINGS)]
    place = draft.card.at("FILE")
    if not all(deck.lexer.allows(path) for path in places):
        deck.error(
            draft.card,
            place,
            f"FILE={name} is outside the folder of the deck",
            hint="move the results there, or allow it: --allow-include",
        )
        return None
    for path in places:
        if path.is_file():
            deck.lexer.files.add(path.resolve())
            return path
    deck.error(
        draft.card,
        place,
        f"there are no results {name}: neither {', '.join(p.name for p in places)}",
        hint="run the job with the buckling step first, with its results in this folder",
    )
    return None


def _move_by_results(
    deck: Deck, draft: ImperfectionDraft, path: Path, mesh: Mesh, nodes: Ints
) -> None:
    from corota.io.result_reader import read_results

    results = read_results(path)
    try:
        frames = [f for f in results.frames if f.step == draft.step]
        # Modes of all steps of a job may be numbered together.
        shapes: dict[int, Frame] = dict(enumerate((f for f in frames if "mode" in f.scalars), 1))
        if not shapes and frames:
            # Of a static step the displacement counts as its only mode.
            wanted = draft.increment or frames[-1].increment
            shapes = dict(enumerate((f for f in frames if f.increment == wanted), 1))
        labels = results.mesh.node_labels
        order = np.argsort(labels)
        at = np.minimum(np.searchsorted(labels[order], mesh.node_labels[nodes]), len(labels) - 1)
        source = order[at]
        missing = nodes[labels[source] != mesh.node_labels[nodes]]
        if len(missing):
            deck.error(
                draft.card,
                draft.card.at("FILE"),
                f"{path.name} has no node {mesh.node_labels[missing[0]]} ({len(missing)} nodes of "
                "this deck are missing there)",
                hint="NSET= limits the imperfection to the nodes of a set",
            )
            return
        for row, mode, factor in draft.modes:
            if mode not in shapes:
                there = f"modes {', '.join(map(str, sorted(shapes)))}" if shapes else "nothing"
                deck.row_error(
                    draft.card,
                    row,
                    0,
                    f"{path.name} has no mode {mode} in step {draft.step}; there is {there}",
                )
                continue
            mesh.points[nodes] += factor * shapes[mode].U[source]
    finally:
        close = getattr(results, "close", None)
        if close is not None:
            close()

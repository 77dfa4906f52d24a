"""``*IMPERFECTION``: nodes moved by shapes of an earlier job, or by given amounts."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Lookup
from corota.errors import FileError
from corota.io.deck.card import Card, Refused, Row
from corota.io.deck.drafts import Draft
from corota.io.deck.keywords import keyword

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


@keyword("IMPERFECTION", "FILE STEP INC NSET SYSTEM", place="model")
def imperfection(deck: Deck, card: Card) -> None:
    """``*IMPERFECTION, FILE=, STEP=[, INC=][, NSET=]``: mode, factor; or node or set, x, y."""
    card.choice("SYSTEM", ("R",), "R")
    draft = ImperfectionDraft(card, card.value("FILE"))
    if card.has("FILE"):
        card.required("FILE")
        if card.required("STEP"):
            draft.step = card.integer("STEP", 1, 1)
        draft.increment = card.integer("INC", 0, 1)
    else:
        for name in ("STEP", "INC", "NSET"):
            if card.has(name):
                card.error(f"{name}= goes with FILE=", name)
    for row in card.lines("a mode and its factor" if draft.file else "a node and its displacement"):
        if draft.file:
            row.at_most(2)
            mode, factor = row.integer(0, "the mode"), row.real(1, "the factor")
            if mode is not None and factor is not None:
                draft.modes.append((row, mode, factor))
            continue
        row.at_most(4)
        x, y, z = (row.real(i, "the displacement", 0.0) for i in (1, 2, 3))
        if z:
            row.error(3, "a displacement out of the plane is not supported")
        elif not row.get(0):
            row.error(0, "a node number or a set is missing")
        elif x is not None and y is not None and z is not None:
            draft.moves.append(Draft("imperfection", row, row.get(0), (x, y)))
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
        with suppress(Refused):
            path, nodes = _results_of(deck, draft), np.arange(mesh.n_nodes)
            if draft.card.has("NSET"):
                row = draft.card.row_of("NSET")
                found = find(Draft("imperfection", row, row.get(0), ()))
                if found is None:
                    continue
                nodes = mesh.node_indices(found)
            try:
                _move_by_results(draft, path, mesh, nodes)
            except FileError as error:
                draft.card.error(str(error), "FILE")


def _results_of(deck: Deck, draft: ImperfectionDraft) -> Path:
    """The result file that a card names, in the folder of the deck."""
    assert deck.lexer is not None
    folder, name = deck.lexer.path.parent, draft.file
    places = [folder / name, *(folder / f"{name}.{ending}" for ending in ENDINGS)]
    if not all(deck.lexer.allows(path) for path in places):
        text = f"FILE={name} is outside the folder of the deck"
        hint = "move the results there, or allow it: --allow-include"
        draft.card.refuse(text, "FILE", hint)
    for path in places:
        if path.is_file():
            deck.lexer.files.add(path.resolve())
            return path
    draft.card.refuse(
        f"there are no results {name}: neither {', '.join(p.name for p in places)}",
        "FILE",
        "run the job with the buckling step first, with its results in this folder",
    )


def _move_by_results(draft: ImperfectionDraft, path: Path, mesh: Mesh, nodes: Ints) -> None:
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
        source = Lookup(results.mesh.node_labels)(mesh.node_labels[nodes])
        missing = nodes[source < 0]
        if len(missing):
            draft.card.error(
                f"{path.name} has no node {mesh.node_labels[missing[0]]} ({len(missing)} nodes of "
                "this deck are missing there)",
                "FILE",
                hint="NSET= limits the imperfection to the nodes of a set",
            )
            return
        for row, mode, factor in draft.modes:
            if mode not in shapes:
                there = f"modes {', '.join(map(str, sorted(shapes)))}" if shapes else "nothing"
                row.error(
                    0, f"{path.name} has no mode {mode} in step {draft.step}; there is {there}"
                )
                continue
            mesh.points[nodes] += factor * shapes[mode].U[source]
    finally:
        close = getattr(results, "close", None)
        if close is not None:
            close()

"""``*RESTART, READ``: a deck whose steps follow a checkpoint of an earlier job.

Model and earlier steps are those of the earlier deck; what is new are steps, and the sets and
tables that they need.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import glob
from pathlib import Path
from typing import TYPE_CHECKING

from corota.errors import FileError
from corota.io.deck.card import Card
from corota.io.deck.lexer import Lexer
from corota.io.provenance import changed_file

if TYPE_CHECKING:
    from corota.io.checkpoint import Saved
    from corota.io.deck.deck import Deck

#: Cards that such a deck may have before its first step.
ALLOWED = ("HEADING", "RESTART", "AMPLITUDE", "NSET", "ELSET", "SURFACE", "TIMEPOINTS", "PREPRINT")


def card_that_reads(cards: list[Card]) -> Card | None:
    """The card ``*RESTART, READ`` of a deck, if it has one."""
    return next((c for c in cards if c.keyword == "RESTART" and c.has("READ")), None)


def with_earlier_steps(
    deck: Deck, lexer: Lexer, cards: list[Card], card: Card
) -> tuple[list[Card], Saved | None]:
    """Cards of the earlier deck up to the checkpoint, then those of this one; the checkpoint.

    Faults go to the deck.

    Raises
    ------
    FileError
        If there is no such checkpoint, or the earlier deck is missing or changed.
    """
    for own in cards:
        own.deck = deck
    for own in cards:
        if own.keyword == "STEP":
            break
        if own.keyword not in ALLOWED:
            own.error(
                "a deck with *RESTART, READ takes its model from the earlier job",
                hint="give steps, and the sets, surfaces and amplitudes that they need",
            )
            return cards, None
    step = card.integer("STEP", 0, 1)
    increment = card.integer("INC", 0, 0) if card.has("INC") else None
    if deck.n_errors:
        return cards, None
    job = lexer.path.parent / (card.value("JOB") or lexer.path.stem)
    if not lexer.allows(job):
        card.error(
            f"JOB={card.value('JOB')} is outside the folder of the deck",
            hint="move the earlier job there, or allow it: --allow-include",
        )
        return cards, None
    saved = _chosen(job, step, increment)
    saved.state.leave_step = increment is None or card.has("ENDSTEP")
    earlier = Lexer(_earlier_deck(saved), lexer.allow_include)
    earlier.cards = earlier.read()
    before = earlier.cards
    lexer.diagnostics += earlier.diagnostics
    lexer.files |= earlier.files | {saved.path.resolve()}
    inner = card_that_reads(before)
    if inner is not None:
        before, _ = with_earlier_steps(deck, earlier, before, inner)
        lexer.files |= earlier.files
    starts = [k for k, c in enumerate(before) if c.keyword == "STEP"]
    if saved.state.step < len(starts):
        before = before[: starts[saved.state.step]]
    return [*before, *cards], saved


def _chosen(job: Path, step: int, increment: int | None) -> Saved:
    """The checkpoint of a step's end or of an increment; the last one if neither is named."""
    from corota.io.checkpoint import load

    folder, name = job.parent, job.name
    kept = [Path(p) for p in sorted(glob.glob(f"{glob.escape(str(job))}.step-*.ckpt"))]
    paths = [*kept, folder / f"{name}.ckpt", folder / f"{name}.ckpt.1"]
    found: list[Saved] = []
    refused: list[str] = []
    for path in paths:
        if path.exists():
            try:
                found.append(load(path))
            except FileError as error:
                refused.append(str(error))
    fits = [s for s in found if step in (0, s.state.step)]
    if increment is not None:
        fits = [s for s in fits if s.state.increment == increment]
    elif step:
        fits = [s for s in fits if s.path in kept]
    if fits:
        return max(fits, key=lambda s: (s.state.step, s.state.increment))
    wanted = f"step {step}" if step else "any step"
    wanted = (
        f"increment {increment} of {wanted}" if increment is not None else f"the end of {wanted}"
    )
    there = ", ".join(
        f"{'the end of step' if s.path in kept else 'step'} {s.state.step}, increment "
        f"{s.state.increment}"
        for s in found
    )
    raise FileError(
        f"{job}: there is no checkpoint of {wanted}; there are: {there or 'none'}"
        + "".join(f"; {reason}" for reason in refused)
        + ". The earlier job keeps them by *RESTART, WRITE"
    )


def _earlier_deck(saved: Saved) -> Path:
    """The deck that a checkpoint was made from, as it was."""
    source = saved.options["source"]
    if "sha256" not in source:
        raise FileError(
            f"{saved.path}: this job was not read from a deck: continue in Python with "
            "corota.resume(path, steps=[...])"
        )
    places = [Path(source["path"]), saved.path.with_name(source["deck"])]
    for path in places:
        if path.exists() and not changed_file(source, path):
            return path
    raise FileError(
        f"{places[0]}: the deck of the earlier job, or a file that it includes, is not there or "
        f"has changed since {saved.path} was written"
    )

"""``corota seek``: the value of a deck's parameter for which a measure reaches a target."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.reading import reading_options
from corota.errors import FileError, InputError

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Seek; 0 if the target is reached."""
    from corota.sweeps.seek import seek
    from corota.sweeps.variant import DeckBuild

    deck = Path(args.deck)
    if not deck.is_file():
        raise FileError(f"{deck}: no such file")
    name, values = args.range
    if len(values) < 2:
        raise InputError(f"-p {name} needs a range, such as {name}=0.3:0.9")
    build = DeckBuild(deck, reading_options(args))

    def progress(value: float, measure: float) -> None:
        terminal.line(f"  {name} = {value:<14.8g} {args.measure} = {measure:.8g}")
        terminal.record({"event": "run", name: value, "measure": measure})

    found = seek(
        build,
        {name: (min(values), max(values))},
        args.measure,
        args.target,
        tolerance=args.tolerance,
        fixed=dict(args.parameters),
        store=Path(args.output or f"{deck.stem}_seek.jsonl"),
        progress=progress,
    )
    terminal.line(str(found))
    return 0

"""``corota sweep``: a deck with many values of its parameters."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.progress import duration
from corota.cli.reading import reading_options
from corota.errors import FileError, InputError

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.sweeps.variant import DeckBuild


def _refuse_inputs(build: DeckBuild, table: Path, store: Path) -> None:
    """Refuse tables that would replace what the sweep reads."""
    if table == store:
        raise InputError(f"{table}: the table is a file .csv; its rows are kept in {store}")
    inputs = {file.resolve() for file in build.files()}
    for path in (table, store):
        if path.resolve() in inputs:
            raise InputError(f"{path} is an input of this sweep and would be replaced: use -o")


def run(args: Any, terminal: Terminal) -> int:
    """Sweep; 0 if every row ended, else 4."""
    from corota.sweeps.design import grid, sample
    from corota.sweeps.run import sweep
    from corota.sweeps.variant import DeckBuild

    deck = Path(args.deck)
    if not deck.is_file():
        raise FileError(f"{deck}: no such file")
    names = [name for name, _ in args.grid]
    if len(set(names)) < len(names):
        raise InputError(f"-p names {max(names, key=names.count)!r} twice")
    if args.sample:
        ranges = {name: (min(values), max(values)) for name, values in args.grid}
        rows = sample(args.sample, ranges, seed=args.seed)
    else:
        rows = grid(**dict(args.grid))
    rows = [dict(args.parameters) | row for row in rows]
    build = DeckBuild(deck, reading_options(args))
    table = Path(args.output or f"{deck.stem}_sweep.csv")
    store = table.with_suffix(".jsonl")
    _refuse_inputs(build, table, store)
    if args.again:
        store.unlink(missing_ok=True)
    begin = time.perf_counter()

    def progress(done: int, total: int, failed: int) -> None:
        lost = f", {failed} failed" if failed else ""
        terminal.status(f" {done} of {total} rows{lost}, {duration(time.perf_counter() - begin)}")

    found = sweep(build, rows, args.measures, workers=args.workers, store=store, progress=progress)
    found.to_csv(table)
    for number in range(len(found)):
        record = {name: found[name][number].item() for name in [*found.parameters, *found.measures]}
        terminal.record({"event": "row", "row": number} | record)
    for note, count in found.notes.items():
        terminal.line(f"  note ({count} of {len(found)} rows): {note}")
    for number in found.failed:
        values = ", ".join(f"{name} = {found[name][number]:g}" for name in found.parameters)
        terminal.warning(f"row {number} ({values}): {found['error'][number]}")
    ended = len(found) - len(found.failed)
    terminal.line(
        f"{ended} of {len(found)} rows in {duration(time.perf_counter() - begin)}: {table} (rows "
        f"are kept in {store}; the same command continues from there)"
    )
    if args.plot:
        by = found.parameters[1] if len(found.parameters) == 2 and not args.sample else ""
        found.plot(by=by, path=args.plot)
        terminal.line(f"picture: {args.plot}")
    if not found.failed:
        return 0
    first = found["error"][found.failed[0]]
    terminal.error(f"{len(found.failed)} of {len(found)} rows failed; the first: {first}")
    return 5 if any(outcome.short for outcome in found.outcomes) else 4

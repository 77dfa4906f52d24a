"""``corota verify``: measure the problems of the catalog and compare."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from corota.cli.progress import duration
from corota.verification.catalogue import GROUPS, Problem, chosen
from corota.verification.outcome import Outcome
from corota.verification.runner import run as run_problems

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal

HEAD = ("problem", "quantity", "reference", "measured", "error", "tolerance", "status", "s")


def run(args: Any, terminal: Terminal) -> int:
    """Verify; 0 if every value is within its tolerance, else 4."""
    wanted = chosen(args.names)
    if args.list:
        return _list(wanted, terminal)
    if args.pages:
        from corota.plots.figure import matplotlib
        from corota.verification.pages import prepare

        matplotlib()
        prepare(args.pages)
    start = time.perf_counter()
    count = 0

    def done(outcome: Outcome) -> None:
        nonlocal count
        count += 1
        text = f"[{count}/{len(wanted)}] {outcome.name} {duration(outcome.seconds)}"
        if terminal.live:
            terminal.status(f" {text}")
        else:
            terminal.line(text + ("" if outcome.ok else "  MISSED"))
        for record in _records(outcome):
            terminal.record(record)

    terminal.status(f" [0/{len(wanted)}]")
    outcomes = run_problems(
        wanted, done, full=args.full, pages=args.pages or "", jobs=args.jobs or 0
    )
    if args.pages:
        from corota.verification.pages import write_index

        write_index(wanted, outcomes, args.pages)
    for line in table(outcomes):
        terminal.line(line.replace("MISSED", terminal.color("MISSED", "red")))
    missed = [o for o in outcomes if not o.ok]
    for outcome in missed:
        terminal.error(f"{outcome.name}: {_fault(outcome)}")
    values = sum(len(o.values) for o in outcomes)
    seconds = time.perf_counter() - start
    terminal.line(
        f"{len(outcomes) - len(missed)} of {len(outcomes)} problems and "
        f"{sum(v.ok for o in outcomes for v in o.values)} of {values} values are within their "
        f"tolerances; {duration(seconds)}"
    )
    terminal.record(
        {"event": "end", "problems": len(outcomes), "missed": len(missed), "seconds": seconds}
    )
    return 4 if missed else 0


def _list(wanted: list[Problem], terminal: Terminal) -> int:
    width = max(len(p.name) for p in wanted)
    for group in GROUPS:
        members = [p for p in wanted if p.group == group]
        if members:
            terminal.line(group)
        for problem in members:
            terminal.line(f"  {problem.name:{width}}  {problem.title}")
            facts = ("name", "title", "group", "source", "certainty")
            terminal.record({"event": "problem"} | {n: getattr(problem, n) for n in facts})
    return 0


def cells(outcome: Outcome) -> list[tuple[str, ...]]:
    """Rows of the table, one per value; the first has the name and the seconds."""
    rows: list[tuple[str, ...]] = []
    for k, v in enumerate(outcome.values):
        rows.append(
            (
                outcome.name if k == 0 else "",
                v.quantity,
                f"{'>= ' if v.kind == 'at least' else '<= ' if v.kind == 'at most' else ''}"
                f"{v.reference:.7g}",
                f"{v.measured:.7g}",
                f"{v.error:.1e}",
                "" if v.kind in ("at least", "at most") else f"{v.tolerance:.0e}",
                "ok" if v.ok else "MISSED",
                f"{outcome.seconds:.1f}" if k == 0 else "",
            )
        )
    if outcome.error or not rows:
        text = (outcome.error or "no values").splitlines()[0][:60]
        rows.append((outcome.name, text, "", "", "", "", "MISSED", f"{outcome.seconds:.1f}"))
    return rows


def table(outcomes: list[Outcome]) -> list[str]:
    """Lines of the table, aligned."""
    rows = [HEAD, *(row for outcome in outcomes for row in cells(outcome))]
    widths = [max(len(row[k]) for row in rows) for k in range(len(HEAD))]
    lines = []
    for row in rows:
        parts = [
            text.ljust(width) if k in (0, 1, 6) else text.rjust(width)
            for k, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(parts).rstrip())
    return lines


def _fault(outcome: Outcome) -> str:
    if outcome.error:
        return outcome.error
    worst = [v for v in outcome.values if not v.ok]
    if not worst:
        return "no values"
    return "; ".join(
        f"{v.quantity}: {v.measured:.8g}, not {v.reference:.8g} (error {v.error:.1e}, "
        f"tolerance {v.tolerance:.0e})"
        for v in worst
    )


def _records(outcome: Outcome) -> list[dict[str, Any]]:
    head = {"event": "value", "problem": outcome.name}
    if outcome.error:
        return [head | {"event": "failure", "message": outcome.error}]
    facts = ("quantity", "reference", "measured", "error", "tolerance", "kind", "ok")
    return [
        head | {n: getattr(v, n) for n in facts} | {"seconds": outcome.seconds}
        for v in outcome.values
    ]

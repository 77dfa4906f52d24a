"""``corota check``: read and validate without solving."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.cli.info import model_lines, model_record
from corota.cli.reading import read_input

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.errors import Diagnostic


def run(args: Any, terminal: Terminal) -> int:
    """Check an input; 0 if it can be solved, else 3 (its form is refused with 2 while reading)."""
    from corota.check import check

    model = read_input(args.deck, args)
    found = list(check(model))
    errors = [d for d in found if d.severity == "error"]
    for text in model_lines(model):
        terminal.line(text)
    for note in model.notes:
        terminal.line(f"note: {note}")
    for diagnostic in found:
        if diagnostic.severity == "error":
            terminal.error(str(diagnostic).removeprefix("error: "))
        else:
            terminal.line(_colored(diagnostic, terminal))
        terminal.record(_record(diagnostic))
    warnings = sum(d.severity == "warning" for d in found)
    terminal.line(f"{len(errors)} errors, {warnings} warnings")
    terminal.record(
        model_record(model) | {"event": "check", "errors": len(errors), "warnings": warnings}
    )
    return 3 if errors else 0


def _colored(diagnostic: Diagnostic, terminal: Terminal) -> str:
    text = str(diagnostic)
    if diagnostic.severity == "warning":
        return text.replace("warning:", terminal.color("warning:", "yellow"), 1)
    return text


def _record(diagnostic: Diagnostic) -> dict[str, Any]:
    where = diagnostic.where
    return {
        "event": "diagnostic", "severity": diagnostic.severity, "message": diagnostic.message,
        "file": where.file if where else None, "line": where.line if where else None,
        "column": where.column if where else None, "keyword": diagnostic.keyword,
        "hint": diagnostic.hint,
    }  # fmt: skip

"""``corota check``: read and validate without solving."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.cli.info import model_record
from corota.cli.reading import read_input
from corota.errors import CorotaError, Diagnostic
from corota.model.summary import model_lines

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal


def run(args: Any, terminal: Terminal) -> int:
    """Check an input; 0 if its run starts, otherwise the exit code of the run."""
    from corota.check import examine

    try:
        model = read_input(args.deck, args)
    except CorotaError as error:
        _refused(error, terminal)
        raise
    found, code = examine(model)
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
    return code


def _refused(error: CorotaError, terminal: Terminal) -> None:
    """Records of an input that cannot be read."""
    where = getattr(error, "where", None)
    found = getattr(error, "diagnostics", None) or [
        Diagnostic("error", getattr(error, "message", str(error)), where)
    ]
    for diagnostic in found:
        terminal.record(_record(diagnostic))
    errors = sum(d.severity == "error" for d in found)
    terminal.record({"event": "check", "errors": errors, "warnings": len(found) - errors})


def _colored(diagnostic: Diagnostic, terminal: Terminal) -> str:
    text = str(diagnostic)
    if diagnostic.severity == "warning":
        return text.replace("warning:", terminal.color("warning:", "yellow"), 1)
    return text


def _record(diagnostic: Diagnostic) -> dict[str, Any]:
    where = diagnostic.where
    return {
        "event": "diagnostic",
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        "file": where.file if where else None,
        "line": where.line if where else None,
        "column": where.column if where else None,
        "keyword": diagnostic.keyword,
        "hint": diagnostic.hint,
    }

"""Standard output and error, which may be a terminal, a pipe, closed or full."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import re
import sys
from typing import Any, TextIO

COLORS = {"red": "31", "green": "32", "yellow": "33", "blue": "34", "dim": "2", "bold": "1"}
#: Control characters and marks of direction, except ends of lines, tabs and :data:`COLORS`.
_REST = r"[\x00-\x08\x0b-\x1a\x1c-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]"
_COMMANDS = rf"\033(?!\[(?:0|{'|'.join(COLORS.values())})m)|{_REST}"
_COMMANDS_AND_COLORS = rf"\033|{_REST}"


class Terminal:
    """Writes lines; a closed reader never stops the run.

    Parameters
    ----------
    quiet : bool
        Print errors only.
    json : bool
        Print records instead of text.
    """

    def __init__(self, quiet: bool = False, json: bool = False) -> None:
        self.quiet, self.json = quiet, json
        self._failed: OSError | None = None
        self._gone = self._mute = False
        self.live = self._is_terminal(sys.stdout) and not quiet and not json
        plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
        self.colored = self.live and not plain
        self._open = False

    def mute(self) -> None:
        """Print nothing from now on, errors included: another process prints them."""
        self.quiet, self.json, self.live, self._mute = True, False, False, True

    def _is_terminal(self, stream: TextIO | None) -> bool:
        try:
            return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"
        except ValueError:
            return False

    @property
    def unicode(self) -> bool:
        """Whether the terminal takes more than ASCII."""
        return "utf" in (getattr(sys.stdout, "encoding", "") or "").lower()

    def color(self, text: str, name: str) -> str:
        """Text in a color, where colors are enabled."""
        return f"\033[{COLORS[name]}m{text}\033[0m" if self.colored else text

    def line(self, text: str = "") -> None:
        """Print a line of text unless quiet or JSON was requested."""
        if not self.quiet and not self.json:
            self._write(self._clear() + _plain(text, self.colored) + "\n")

    def record(self, record: dict[str, Any]) -> None:
        """Print a record as one line of JSON, if requested."""
        if self.json:
            from corota.io.events import json_line

            self._write(json_line(record))

    def status(self, text: str) -> None:
        """Replace the line that shows the progress."""
        if self.live:
            self._write("\r\033[2K" + _plain(text, self.colored))
            self._open = True

    def _clear(self) -> str:
        """Remove the progress line before other output."""
        was, self._open = self._open, False
        return "\r\033[2K" if was else ""

    def error(self, text: str) -> None:
        """Print an error on standard error."""
        self._stderr("error", text)

    def warning(self, text: str) -> None:
        """Print a warning on standard error."""
        if not self.quiet:
            self._stderr("warning", text)

    def _stderr(self, kind: str, text: str) -> None:
        if self._open:
            self._write(self._clear())
        if self._mute:
            return
        with contextlib.suppress(OSError, ValueError, AttributeError):
            sys.stderr.write(f"corota: {kind}: {_printable(_plain(text, False), sys.stderr)}\n")
            sys.stderr.flush()

    def _write(self, text: str) -> None:
        if self._gone or sys.stdout is None:
            return
        try:
            sys.stdout.write(_printable(text, sys.stdout))
            sys.stdout.flush()
        except BrokenPipeError:
            self._silence()
        except (OSError, ValueError) as error:
            self._failed = error if isinstance(error, OSError) else None
            self._silence()

    def _silence(self) -> None:
        """Discard all further output, and Python's own flush at the end."""
        self._gone = True
        with contextlib.suppress(OSError, ValueError, AttributeError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)

    def close(self, code: int) -> int:
        """End the output; return the exit code, 6 if standard output could not be written."""
        if self._open:
            self._write(self._clear())
        if self._failed is not None and code == 0:
            self.error(f"standard output: cannot write: {self._failed.strerror}")
            return 6
        return code


def _plain(text: str, colored: bool) -> str:
    """Text without control sequences, except colors where they are enabled.

    Names and lines of a deck are repeated in messages; they may hold anything.
    """
    commands = _COMMANDS if colored else _COMMANDS_AND_COLORS
    return re.sub(commands, lambda found: repr(found[0])[1:-1], text)


def _printable(text: str, stream: TextIO) -> str:
    """Text with replacements for characters that the stream cannot encode."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return text.encode(encoding, "replace").decode(encoding, "replace")

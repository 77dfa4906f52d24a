"""Typed errors: each names the object, the place and the remedy."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

#: Message where an allocation of Python fails.
SHORT = "not enough memory for this job; use a coarser mesh or a larger machine"
#: Message where the compute core is missing.
NO_CORE = "the compute core, corota._core, is not built; use make setup, or pip install ."


@dataclass(frozen=True)
class Location:
    """A place in the input: file, line and column (both from 1)."""

    file: str
    line: int
    column: int = 0

    def __str__(self) -> str:
        column = f":{self.column}" if self.column else ""
        return f"{self.file}:{self.line}{column}"


class CorotaError(Exception):
    """Base class of all errors that Corota raises.

    ``exit_code`` is what the command line returns for it.
    """

    exit_code = 70

    def __repr__(self) -> str:
        from corota.display import LONGEST

        text = super().__repr__()
        return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]}...)"


class InputError(CorotaError, ValueError):
    """An argument or a datum that cannot be accepted.

    Parameters
    ----------
    message : str
        What is wrong and what would be accepted.
    where : Location, optional
        Place in the input file, printed before the message.
    """

    exit_code = 2

    def __init__(self, message: str, where: Location | None = None) -> None:
        super().__init__(f"{where}: {message}" if where else message)
        self.message = message
        self.where = where


def number(
    value: object,
    what: str,
    where: Location | None = None,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
) -> float:
    """A finite number.

    Parameters
    ----------
    value : object
        The given value.
    what : str
        Its name, at the start of the message.
    above, least : float
        What it must exceed, and what it must reach.

    Raises
    ------
    InputError
        If it is not a number, not finite, or too small.
    """
    try:
        found = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{what} must be a number, not {value!r}", where) from None
    if not math.isfinite(found) or isinstance(value, str):
        raise InputError(f"{what} must be a finite number, not {value!r}", where)
    if found <= above or found < least:
        bound = f"> {above:g}" if found <= above else f">= {least:g}"
        raise InputError(f"{what} must be {bound}, not {value}", where)
    return found


@dataclass(frozen=True)
class Diagnostic:
    """One finding about an input: severity, place, card, text and remedy."""

    severity: str  # "error" | "warning" | "note"
    message: str
    where: Location | None = None
    keyword: str = ""
    text: str = ""  # the offending line of the file
    hint: str = ""

    def __str__(self) -> str:
        head = f"{self.where}: " if self.where else ""
        card = f"{self.keyword}: " if self.keyword else ""
        message = self.message
        if self.where:  # the file is named once
            message = re.sub(rf"{re.escape(self.where.file)}:(\d+)(:\d+)?", r"line \1", message)
        lines = [f"{head}{self.severity}: {card}{message}"]
        if self.text:
            lines.append("    " + self.text)
            if self.where and self.where.column:
                lines.append("    " + " " * (self.where.column - 1) + "^")
        if self.hint:
            lines.append(f"    hint: {self.hint}")
        return "\n".join(lines)


class DeckError(InputError):
    """All the errors of one input deck, found in one pass."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        super().__init__("\n".join(str(d) for d in diagnostics))
        self.diagnostics = list(diagnostics)


class ModelError(InputError):
    """Well-formed input of a model that cannot be solved."""

    exit_code = 3


class UnsupportedError(InputError):
    """A known feature that this version does not support, with an alternative."""


class SingularError(CorotaError):
    """The matrix is singular: names the free node and degree of freedom.

    Attributes
    ----------
    equation : int
        Index of the equation of the worst pivot, -1 if unknown.
    mode : numpy.ndarray or None
        Null vector over all equations, shape (n_dofs,), when it was found.
    modes : numpy.ndarray or None
        All null vectors that were found, shape (n_modes, n_dofs); the first is `mode`.
    """

    exit_code = 3

    def __init__(
        self, message: str, equation: int = -1, mode: Any = None, modes: Any = None
    ) -> None:
        super().__init__(message)
        self.equation = equation
        self.mode = mode
        self.modes = modes


class ConvergenceError(CorotaError):
    """An increment did not converge; converged results are kept.

    Attributes
    ----------
    reason : str
        Class of the failure in one line.
    results : Results or None
        Everything up to the last converged increment.
    """

    exit_code = 4

    def __init__(self, reason: str, results: Any = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.results = results


class ResourceError(CorotaError):
    """Not enough memory, disk or another resource.

    Attributes
    ----------
    results : Results or None
        Of an analysis, everything up to the last converged increment.
    """

    exit_code = 5
    results: Any = None


@contextmanager
def memory_errors() -> Iterator[None]:
    """Raise :class:`ResourceError` where Python runs out of memory.

    Modules are imported when they are first used, so any call of the interface may run out.

    Raises
    ------
    ResourceError
    """
    try:
        yield
    except (MemoryError, SystemError) as error:
        if not is_shortage(error):
            raise
        raise ResourceError(SHORT) from None


def is_shortage(error: BaseException) -> bool:
    """Whether an error says that memory is short.

    Where Python cannot even make a ``MemoryError``, it raises a ``SystemError`` which says that a
    call failed without an exception.
    """
    said = str(error)
    return isinstance(error, MemoryError) or (
        "without exception set" in said or "without setting an exception" in said
    )


class FileError(CorotaError):
    """A file that cannot be read or written."""

    exit_code = 6


class Interrupted(CorotaError):
    """Stopped by the user at the end of an increment."""

    exit_code = 7

"""Names that a user gives: the one that is meant, or the nearest valid one in the error."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.errors import Location

#: Most names that a message lists.
MOST_LISTED = 20


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """``; did you mean 'x'?`` with the nearest of the known names, or nothing.

    Examples
    --------
    >>> did_you_mean("rigth", ["left", "right"])
    "; did you mean 'right'?"
    """
    from difflib import get_close_matches

    lower = {name.lower(): name for name in known}
    begun = [name for name in lower if word and name.startswith(word.lower())]
    close = begun[:1] or get_close_matches(word.lower(), list(lower), 1, 0.5)
    return f"; did you mean {lower[close[0]]!r}?" if close else ""


def listed(known: Iterable[str]) -> str:
    """Names one after the other, cut where they are too many."""
    names = list(known)
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more if names else "none"


def match(word: str, known: Iterable[str]) -> str | None:
    """The known name that is written this way, or this way in other letters' case.

    Raises
    ------
    InputError
        If several names differ from it in case only.
    """
    names = list(known)
    if word in names:
        return word
    alike = [name for name in names if name.lower() == word.lower()]
    if len(alike) > 1:
        raise InputError(f"{word!r} may be {' or '.join(map(repr, alike))}; write it as it is")
    return alike[0] if alike else None


def choose(value: object, known: Iterable[str], what: str, where: Location | None = None) -> str:
    """One of the known names, in any case.

    Parameters
    ----------
    value : object
        What the user gave.
    known : iterable of str
    what : str
        What it names, such as ``"element"``.
    where : Location, optional

    Raises
    ------
    InputError
        With the nearest valid name.
    """
    names = list(known)
    found = match(value, names) if isinstance(value, str) else None
    if found is None:
        hint = did_you_mean(value, names) if isinstance(value, str) else ""
        raise InputError(f"no {what} {value!r}; there are {', '.join(names)}{hint}", where)
    return found


__all__ = ["choose", "did_you_mean", "listed", "match"]

"""Names given by users: the matching name, or the nearest valid one in the error."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterable

from corota.errors import InputError, Location

#: Largest number of names in a message.
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
    """A list of names, truncated if there are too many."""
    names = list(known)
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more if names else "none"


def match(word: str, known: Iterable[str]) -> str | None:
    """The known name that matches, exactly or regardless of case.

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
        The given value.
    what : str
        The kind of name, such as ``"element"``.

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


def choose_attribute(
    item: object, name: str, known: Iterable[str], what: str, where: Location | None = None
) -> None:
    """Replace an attribute by the known name that it matches; see :func:`choose`."""
    setattr(item, name, choose(getattr(item, name), known, what, where))

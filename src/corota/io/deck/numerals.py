"""Numbers of decks: allowed values of a field, and reasons of refusal."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import sys

# Every digit has one place in the pattern: a long wrong number fails in linear time.
_REAL = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eEdD][+-]?\d+)?\Z", re.ASCII)
_INTEGER = re.compile(r"[+-]?\d+\Z", re.ASCII)
_LARGEST_LABEL = 2**62


def real(text: str) -> float:
    """Value of a decimal number; Fortran's ``1.5D-3`` is accepted.

    Parameters
    ----------
    text : str
        One field, without surrounding blanks.

    Raises
    ------
    ValueError
        With the reason, for anything that is not a finite normal decimal number.
    """
    if not _REAL.match(text):
        raise ValueError(_reason(text, "a number"))
    value = float(text.replace("d", "e").replace("D", "e"))
    if abs(value) > sys.float_info.max:
        raise ValueError(f"{shown(text)} is too large for a number")
    if abs(value) < sys.float_info.min and _digits(text):
        raise ValueError(
            f"{shown(text)} is smaller than the smallest normal number, 2.2e-308; write 0"
        )
    return value


def integer(text: str) -> int:
    """Value of a whole number.

    Raises
    ------
    ValueError
        With the reason, for anything else.
    """
    if not _INTEGER.match(text):
        raise ValueError(_reason(text, "a whole number"))
    if len(text) > 20 or abs(int(text)) > _LARGEST_LABEL:
        raise ValueError(f"{shown(text)} is too large for a whole number")
    return int(text)


def is_integer(text: str) -> bool:
    """Whether a field is written as a whole number."""
    return bool(_INTEGER.match(text))


def is_label(text: str) -> bool:
    """Whether a field is a whole number that a node or an element can have."""
    return is_integer(text) and len(text) <= 20 and abs(int(text)) <= _LARGEST_LABEL


def is_number(text: str) -> bool:
    """Whether a field is written as a decimal number."""
    return bool(_REAL.match(text))


def shown(text: str) -> str:
    """Text of the user in quotes, shortened if it is long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")


def clipped(text: str, most: int = 300) -> str:
    """Text of a message, with its middle omitted if it is long."""
    return text if len(text) <= most else f"{text[: most // 2]} ... {text[-most // 3 :]}"


def _digits(text: str) -> bool:
    mantissa = re.split("[eEdD]", text)[0]
    return any(c in "123456789" for c in mantissa)


def _reason(text: str, wanted: str) -> str:
    low = text.lower().lstrip("+-")
    if not text:
        return f"expected {wanted}, the field is empty"
    if low in ("nan", "inf", "infinity") or low.startswith("nan"):
        return f"{shown(text)} is not accepted; expected {wanted}"
    if low.startswith("0x"):
        return f"hexadecimal {shown(text)} is not accepted; expected {wanted}"
    if " " in text or "\t" in text:
        return f"expected {wanted}, found {shown(text)} with a blank inside (a comma missing?)"
    return f"expected {wanted}, found {shown(text)}"

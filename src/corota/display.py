"""Representations of objects: one short line as text, a picture and a table in a notebook."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any

#: Longest text of a value within another, and of a whole object [characters].
LONGEST_VALUE, LONGEST = 60, 1500
#: Largest number of array entries and list members that are shown individually.
FEW = 6
#: Number of cells above which no picture of a mesh is made by default.
CELLS_DRAWN = 100_000


def brief(value: Any) -> str:
    """A value in few words: large arrays by their shape, long lists by their length.

    Examples
    --------
    >>> import numpy as np
    >>> brief(np.zeros((403, 2))), brief([0.0] * 9), brief("a")
    ('array(403 x 2)', 'list of 9', "'a'")
    """
    if hasattr(value, "shape") and hasattr(value, "dtype"):
        if value.ndim == 1 and value.size <= FEW:
            return f"[{', '.join(f'{v:g}' if value.dtype.kind == 'f' else str(v) for v in value)}]"
        return f"array({' x '.join(map(str, value.shape))})"
    if isinstance(value, dict):
        if not value or len(value) > FEW:
            return f"dict of {len(value)}" if value else "{}"
        text = ", ".join(f"{brief(k)}: {brief(v)}" for k, v in value.items())
        return f"{{{text}}}" if len(text) <= LONGEST_VALUE else f"dict of {len(value)}"
    if isinstance(value, list | tuple):
        text = ", ".join(map(brief, value)) if len(value) <= FEW else ""
        if value and not 0 < len(text) <= LONGEST_VALUE:
            return f"{type(value).__name__} of {len(value)}"
        return f"[{text}]" if isinstance(value, list) else f"({text})"
    if is_dataclass(value) and not isinstance(value, type):
        text = repr(value)
        return text if len(text) <= LONGEST_VALUE else f"{type(value).__name__}(...)"
    if callable(value):
        return str(getattr(value, "__name__", type(value).__name__))
    text = repr(value)
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 3]}..."


def short(item: Any) -> str:
    """``Name(field=value, ...)`` of a data class; fields at their defaults are omitted."""
    shown = []
    for part in fields(item):
        if not part.repr:
            continue
        value = getattr(item, part.name, None)
        default = part.default
        if default is MISSING and part.default_factory is not MISSING:
            default = part.default_factory()
        if default is not MISSING and type(value) is type(default):
            try:
                if bool(value == default):
                    continue
            except ValueError:  # arrays
                pass
        shown.append(f"{part.name}={brief(value)}")
    text = f"{type(item).__name__}({', '.join(shown)})"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]}...)"


class Brief:
    """Gives the data classes that derive from it a short ``repr``."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = short  # type: ignore[method-assign]


def table(rows: Mapping[str, object]) -> str:
    """An HTML table of two columns."""
    from html import escape

    body = "".join(
        f"<tr><th style='text-align:left'>{escape(name)}</th>"
        f"<td style='text-align:left'>{escape(str(value))}</td></tr>"
        for name, value in rows.items()
    )
    return f"<table>{body}</table>"


def picture(draw: Callable[[Path], Any]) -> str:
    """A drawing as an HTML image; nothing where matplotlib is missing or cannot draw it.

    Parameters
    ----------
    draw : callable
        Writes a PNG to the path that it gets.
    """
    from base64 import b64encode
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        try:
            draw(path)
            data = b64encode(path.read_bytes()).decode("ascii")
        except Exception:  # a representation must never raise
            return ""
    return f"<img style='max-width:100%' alt='' src='data:image/png;base64,{data}'/>"

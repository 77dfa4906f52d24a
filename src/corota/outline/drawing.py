"""Drawings: what each reader returns, and the table of readers."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from corota.lazy import lazy

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from pathlib import Path

    from corota.outline.curves import Curve

#: Words at a place: the name of the part around it.
Text = tuple[str, tuple[float, float]]


@dataclass
class Drawing:
    """Contents of a drawing.

    Parameters
    ----------
    curves : list of Curve
        Each with the name of its layer or color.
    texts : list of (str, (x, y))
        Names of the parts around these places.
    unit : str
        Of length; empty if the drawing does not say.
    notes : list of str
        What was left out.
    """

    curves: list[Curve] = field(default_factory=list)
    texts: list[Text] = field(default_factory=list)
    unit: str = ""
    notes: list[str] = field(default_factory=list)


#: Reader of each kind of drawing: ``read(path, layers)``.
DRAWINGS: dict[str, Callable[[Path, Collection[str]], Drawing]] = {
    ".dxf": lazy("corota.outline.dxf:read_dxf"),
    ".svg": lazy("corota.outline.svg:read_svg"),
}


def set_name(name: str) -> str:
    """Name of a set from that of a layer or a text.

    Examples
    --------
    >>> set_name("upper leaf (0.5)")
    'upper_leaf_0_5'
    """
    return re.sub(r"\W+", "_", name.strip()).strip("_") or "part"

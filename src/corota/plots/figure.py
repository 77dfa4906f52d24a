"""What all pictures share: the figure, its look, and writing it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.errors import InputError, ResourceError
from corota.io.atomic_file import full

if TYPE_CHECKING:
    from os import PathLike

    from corota.model.units import Units

#: Endings of the picture formats.
FORMATS = (".png", ".svg", ".pdf")
STYLE = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.fonttype": "none",
    "figure.dpi": 110.0,
    "axes.prop_cycle": None,
}
#: Colors that stay apart in print and for the color-blind (Okabe and Ito).
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999999")
INK, PALE = "#20242b", "#9aa3b0"


def matplotlib() -> Any:
    """Import matplotlib.

    Raises
    ------
    ResourceError
        Tells how to install it.
    """
    try:
        import matplotlib
    except ImportError:
        raise ResourceError(
            "pictures need matplotlib, which is not installed: pip install corota[plot]"
        ) from None
    return matplotlib


@contextlib.contextmanager
def look() -> Any:
    """Use our settings inside a ``with`` block only."""
    mpl = matplotlib()
    style: dict[str, Any] = dict(STYLE)
    style["axes.prop_cycle"] = mpl.cycler(color=COLORS)
    with mpl.rc_context(style):
        yield mpl


def new_figure(width: float, height: float, shown: bool) -> Any:
    """Make an empty figure [inch]; one that is only written does not touch the display."""
    if shown:
        from matplotlib import pyplot

        return pyplot.figure(figsize=(width, height), layout="constrained")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def picture_path(path: str | PathLike[str], formats: tuple[str, ...] = FORMATS) -> Path:
    """Check the ending of a picture's name.

    Raises
    ------
    InputError
        If it names no picture format.
    """
    target = Path(path)
    if target.suffix.lower() not in formats:
        raise InputError(
            f"{target}: unknown picture format {target.suffix!r}; use {', '.join(formats)}"
        )
    return target


def save(figure: Any, path: str | PathLike[str], dpi: float = 150.0) -> Path:
    """Write a figure: temporary name, then renaming.

    Raises
    ------
    FileError
        If the disk refuses.
    """
    target = picture_path(path)
    hidden = target.with_name(f".{target.name}.next")
    try:
        with look():
            figure.savefig(hidden, dpi=dpi, format=target.suffix[1:].lower())
        os.replace(hidden, target)
    except OSError as error:
        with contextlib.suppress(OSError):
            hidden.unlink(missing_ok=True)
        raise full(error, target) from None
    return target


def label_axes(ax: Any, units: Units) -> None:
    """Name x and y, with the unit of length where it is told."""
    unit = f" [{units.length}]" if units.length else ""
    ax.set_xlabel(f"x{unit}")
    ax.set_ylabel(f"y{unit}")


def extent_size(low: Any, high: Any, wide: float = 7.2) -> tuple[float, float, bool]:
    """Figure size [inch] for an extent, and whether the color bar lies below."""
    width, height = (max(float(b - a), 1e-12) for a, b in zip(low, high, strict=True))
    ratio = min(max(height / width, 1e-3), 1e3)
    if ratio < 0.8:
        return wide, min(max(wide * 0.9 * ratio, 0.9) + 1.75, 7.5), True
    tall = 6.0
    return min(max(tall / ratio * 0.92, 1.4) + 2.6, 8.5), tall, False

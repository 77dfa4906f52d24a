"""Common parts of all pictures: the figure, its style, and writing it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import textwrap
from contextvars import ContextVar
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
#: Colors that are distinct in print and for the color-blind (Okabe and Ito).
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999999")
INK, PALE = "#20242b", "#9aa3b0"
#: Colors of tension and compression, and of positive and negative section forces.
TENSION, COMPRESSION = COLORS[1], COLORS[0]
#: Width of new figures [inch]; 0 for that of each kind of picture.
_WIDTH: ContextVar[float] = ContextVar("width", default=0.0)
#: Own width of a picture of a wide body [inch].
WIDE = 7.2
#: Width [mm] below which letters are smaller.
NARROW = 110.0


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
    if 0.0 < _WIDTH.get() * 25.4 < NARROW:
        style |= {key: 7.5 for key in ("font.size", "axes.titlesize", "axes.labelsize")}
        style |= {key: 6.5 for key in ("xtick.labelsize", "ytick.labelsize", "legend.fontsize")}
    with mpl.rc_context(style):
        yield mpl


@contextlib.contextmanager
def width_of(millimeters: float) -> Any:
    """Set the width of all new figures inside a ``with`` block, such as one column of a page.

    Parameters
    ----------
    millimeters : float
        0 for the default width of each kind of picture.

    Raises
    ------
    InputError
        If it is not a page width.
    """
    if millimeters and not 40.0 <= millimeters <= 1000.0:
        raise InputError(f"the width of a picture is 40 to 1000 mm, not {millimeters:g}")
    before = _WIDTH.set(millimeters / 25.4)
    try:
        yield
    finally:
        _WIDTH.reset(before)


def new_figure(width: float, height: float, shown: bool) -> Any:
    """Make an empty figure [inch]; one that is only written does not touch the display."""
    wanted = _WIDTH.get()
    if wanted:
        width, height = wanted, height * min((wanted / width) ** 0.75, 1.5)
    if shown:
        from matplotlib import pyplot

        return pyplot.figure(figsize=(width, height), layout="constrained")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def figure_of(ax: Any, width: float, height: float, shown: bool) -> tuple[Any, Any]:
    """The figure of given axes and the axes, or a new figure [inch] with one pair of axes."""
    if ax is not None:
        return ax.figure, ax
    figure = new_figure(width, height, shown)
    return figure, figure.add_subplot()


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
        If writing fails.
    """
    target = picture_path(path)
    hidden = target.with_name(f".{target.name}.next")
    wrap_texts(figure)
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
    """Label x and y, with the unit of length if given."""
    unit = f" [{units.length}]" if units.length else ""
    ax.set_xlabel(f"x{unit}")
    ax.set_ylabel(f"y{unit}")


def wrap_texts(figure: Any) -> None:
    """Wrap titles and labels that exceed the figure."""
    wide, high = (72.0 * inches for inches in figure.get_size_inches())
    columns = {round(ax.get_position().x0, 2) for ax in figure.axes if not hasattr(ax, "_colorbar")}
    count = max(len(columns), 1)
    for ax in figure.axes:
        for text, space in (
            (ax._left_title, 0.92 * wide / count),
            (ax.xaxis.label, 0.95 * wide / count),
            (ax.yaxis.label, 0.95 * high),
        ):
            letters = max(int(space / (0.56 * text.get_fontsize())), 12)
            lines = text.get_text().split("\n")
            if any(len(line) > letters for line in lines):
                parts = [textwrap.fill(line, letters, break_on_hyphens=False) for line in lines]
                text.set_text("\n".join(parts))


def page_width() -> float:
    """Width of a picture of a wide body [inch]."""
    return _WIDTH.get() or WIDE


def extent_size(low: Any, high: Any, below: float = 1.75) -> tuple[float, float, bool]:
    """Figure size [inch] for an extent, and whether the color bar lies below.

    Parameters
    ----------
    low, high : array_like, shape (2,)
    below : float
        Height of titles, axes, legends and bars [inch].
    """
    wide = page_width()
    width, height = (max(float(b - a), 1e-12) for a, b in zip(low, high, strict=True))
    ratio = min(max(height / width, 1e-3), 1e3)
    if ratio < 0.8:
        least, below = (0.9, below) if wide > 5.0 else (0.4, 0.85 * below)
        return wide, min(max(wide * 0.9 * ratio, least) + below, 7.5), True
    tall = 6.0
    return min(max(tall / ratio * 0.92, 1.4) + 2.6, 8.5), tall, False

"""Common parts of all pictures: the figure, its style, and writing it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import re
import warnings
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

from corota.errors import InputError, ResourceError
from corota.io.atomic_file import replaced
from corota.plots.palette import LINES

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
    # Names of sets and jobs may hold a dollar sign.
    "text.parse_math": False,
    "figure.dpi": 110.0,
    "axes.prop_cycle": None,
}
#: Colors of lines.
COLORS = LINES
INK, PALE, GRID = "#20242b", "#8792a2", "#e6e9ee"
#: Colors of tension and compression, and of positive and negative section forces.
TENSION, COMPRESSION = COLORS[1], COLORS[0]
#: Width of new figures [inch]; 0 for that of each kind of picture.
_WIDTH: ContextVar[float] = ContextVar("width", default=0.0)
#: Own width of a picture of a wide body [inch].
WIDE = 7.2
#: Space beside texts at the edge of the figure [inch].
MARGIN = 0.08
#: Titles with less than this share of the figure's width to their right begin at its edge.
SHIFTED = 0.8
#: Layouts after which axes of equal scales stay where they are.
LAYOUTS = 3
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


#: Figures whose layout is ours; others belong to whoever gave their axes.
_OURS: WeakSet[Any] = WeakSet()


def new_figure(width: float, height: float, shown: bool) -> Any:
    """Make an empty figure [inch]; one that is only written does not touch the display."""
    wanted = _WIDTH.get()
    if wanted:
        width, height = wanted, height * min((wanted / width) ** 0.75, 1.5)
    if shown:
        from matplotlib import pyplot

        figure = pyplot.figure(figsize=(width, height), layout="constrained")
        _OURS.add(figure)
        return figure
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    _OURS.add(figure)
    return figure


def figure_of(ax: Any, width: float, height: float, shown: bool) -> tuple[Any, Any]:
    """The figure of given axes and the axes, or a new figure [inch] with one pair of axes."""
    if ax is not None:
        return ax.figure, ax
    figure = new_figure(width, height, shown)
    return figure, figure.add_subplot()


def body_figure(
    ax: Any, low: Any, high: Any, shown: bool, below: float = 1.75
) -> tuple[Any, Any, bool]:
    """Figure and axes for an extent, and whether a color bar lies below; see `extent_size`."""
    width, height, lying = extent_size(low, high, below)
    return (*figure_of(ax, width, height, shown), lying)


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
    with replaced(target) as hidden, look():
        _plain_powers(figure)
        figure.savefig(hidden, dpi=dpi, format=target.suffix[1:].lower())
    return target


def _plain_powers(figure: Any) -> None:
    """Write the numbers of logarithmic axes without markup, which our texts do not read."""
    from matplotlib.ticker import LogFormatter, LogFormatterMathtext

    for axis in (axis for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)):
        if isinstance(axis.get_major_formatter(), LogFormatterMathtext):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
        minor = axis.get_minor_formatter()
        if isinstance(minor, LogFormatterMathtext):
            axis.set_minor_formatter(LogFormatter(minor_thresholds=minor.minor_thresholds))


def plane_axes(ax: Any, low: Any, high: Any, pad: float, units: Units) -> None:
    """Fit axes of equal scales to an extent, shape (2,) each, with a margin; label them."""
    ax.set_xlim(low[0] - pad, high[0] + pad)
    ax.set_ylim(low[1] - pad, high[1] + pad)
    ax.set_aspect("equal")
    unit = f" [{units.length}]" if units.length else ""
    ax.set_xlabel(f"x{unit}")
    ax.set_ylabel(f"y{unit}")
    ax.tick_params(length=2.5)


def chart(ax: Any, zero: bool = True, powers: str = "both") -> None:
    """Style axes of curves: pale grid, line of zero, large numbers of `powers` by powers of ten."""
    if zero:
        ax.axhline(0.0, color=PALE, linewidth=0.6, zorder=1)
    ax.grid(True, color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(length=2.5, colors=INK)
    if powers:
        ax.ticklabel_format(style="sci", scilimits=(-3, 4), axis=powers)


def finish(figure: Any, path: str | PathLike[str] | None, dpi: float) -> Any:
    """Fit the texts into a figure of ours, and write it if there is a path; returns the figure."""
    _plain_powers(figure)
    if figure in _OURS:
        fit_texts(figure)
    if path is not None:
        save(figure, path, dpi)
    return figure


def fit_texts(figure: Any) -> None:
    """Break titles and labels that would run out of the figure.

    The layout keeps their height free, and not their width. Titles over narrow axes begin at the
    edge of the figure instead.
    """
    renderer = figure._get_renderer()
    margin = MARGIN * figure.dpi
    whole: dict[Any, str] = {}
    at_edge = []
    for _ in range(2):  # broken texts change the layout
        settled = _settle(figure)
        wide, high = figure.bbox.width, figure.bbox.height
        rows, more, changed = _rows(figure), 0, False
        for ax in figure.axes:
            box = ax.get_window_extent()
            title, left = ax._left_title, box.x0
            right = min([wide, *(o.get_window_extent().x0 for o in rows.get(ax, ()))])
            if title.get_text() and right == wide and wide - left < SHIFTED * wide:
                title.set_x((margin - left) / box.width)
                left, changed = margin, True
                at_edge.append(ax)
            along, up = 0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)
            for text, space in (
                (title, right - left - margin),
                (ax.xaxis.label, 2.0 * min(along, wide - along) - margin),
                (ax.yaxis.label, 2.0 * min(up, high - up) - margin),
            ):
                before = text.get_text()
                broken = _broken(whole.setdefault(text, before), text, space, renderer)
                if broken != before:
                    text.set_text(broken)
                    changed = True
                    below = text is ax.xaxis.label and hasattr(ax, "_colorbar")
                    more += (broken.count("\n") - before.count("\n")) * (text is title or below)
        if settled and not changed:
            break
        if more > 0:  # the picture grows by the lines, lest the axes shrink
            inches = figure.get_size_inches()
            line = 1.25 * figure.axes[0]._left_title.get_fontsize() / 72.0
            figure.set_size_inches(inches[0], inches[1] + more * line)
    else:
        _settle(figure)  # the last broken label may have moved the axes
    for ax in at_edge:
        box = ax.get_window_extent()
        ax._left_title.set_x((margin - box.x0) / box.width)


def _settle(figure: Any) -> bool:
    """Repeat the layout until axes of equal scales stay where they are, and say whether they do."""
    engine = figure.get_layout_engine()
    if engine is None:
        return True

    def places() -> list[Any]:
        return [ax.get_position(original).bounds for ax in figure.axes for original in (0, 1)]

    before = places()
    with warnings.catch_warnings():
        # Before long texts are broken there may be no room for the axes.
        warnings.filterwarnings("ignore", "constrained_layout not applied")
        for _ in range(LAYOUTS):
            engine.execute(figure)
            for ax in figure.axes:
                ax.apply_aspect()
            after = places()
            if after == before:
                return True
            before = after
    return False


def fitted_title(ax: Any, text: str) -> None:
    """Give axes another title in a layout that is settled, broken as the first one was."""
    title = ax._left_title
    left = ax.transAxes.transform(title.get_position())[0]
    space = ax.figure.bbox.width - left - MARGIN * ax.figure.dpi
    title.set_text(_broken(text, title, space, ax.figure._get_renderer()))


def _rows(figure: Any) -> dict[Any, list[Any]]:
    """Axes to the right of each on the same height, color bars left out."""
    every = [ax for ax in figure.axes if not hasattr(ax, "_colorbar")]
    boxes = {ax: ax.get_window_extent() for ax in every}
    return {
        ax: [o for o, b in boxes.items() if b.x0 > box.x0 + 1.0 and b.y0 < box.y1 and b.y1 > box.y0]
        for ax, box in boxes.items()
    }


def _broken(words: str, text: Any, space: float, renderer: Any) -> str:
    """Words in lines that are at most so long [pixel], broken at blanks and in long names."""
    font = text.get_fontproperties()
    lines: list[str] = []
    for line in words.split("\n"):
        now = ""
        for piece in re.findall(r"[^ _/]+[ _/]*|[ _/]+", line):
            whole = (now + piece).rstrip()
            long = renderer.get_text_width_height_descent(whole, font, False)[0] > space
            if now and long:
                lines.append(now.rstrip())
                now = ""
            now += piece
        lines.append(now.rstrip())
    return "\n".join(lines)


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

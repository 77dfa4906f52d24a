"""All frames of an analysis as a moving picture."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
import shutil
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.io.atomic_file import full
from corota.plots.contour import Drawing, frame_title, label_bar, paint
from corota.plots.figure import extent_size, look, new_figure, picture_path
from corota.results import variables as vf

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from corota.results.results import Results

#: More frames than this are thinned evenly.
MOST_FRAMES = 120
#: Even numbers of pixels and colors that every player knows.
PLAYABLE = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]


def require_ffmpeg() -> None:
    """Refuse MP4 where the program ffmpeg is missing.

    Raises
    ------
    InputError
    """
    if shutil.which("ffmpeg") is None:
        raise InputError(
            "an MP4 needs the program ffmpeg, which is not on the path: install it "
            "(such as apt install ffmpeg), or write a .gif"
        )


def animate(
    results: Results,
    name: str = "MISES",
    *,
    path: str | PathLike[str],
    scale: float = 1.0,
    per_cell: bool = False,
    edges: bool | None = None,
    seconds: float = 4.0,
    dpi: float = 100.0,
) -> Path:
    """Write all frames as a GIF or MP4, with one color scale and one window for all.

    Parameters
    ----------
    results : Results
    name : str
        Variable.
    path : path-like
        Ends with ``.gif``, or ``.mp4`` (needs the program ffmpeg).
    scale : float
        Factor of the displacements.
    per_cell : bool
        Averages of the cells.
    edges : bool, optional
    seconds : float
        Length of one pass.
    dpi : float

    Returns
    -------
    Path
    """
    target = picture_path(path, (".gif", ".mp4"))
    if target.suffix.lower() == ".mp4":
        require_ffmpeg()
    name = vf.match_name(name, results.variables())
    drawing = Drawing(results, name, per_cell)
    count = len(results.frames)
    chosen = np.unique(np.linspace(0, count - 1, min(count, MOST_FRAMES)).round().astype(int))
    ranges = [drawing.range(int(i)) for i in chosen]
    limits = (min(r[0] for r in ranges), max(r[1] for r in ranges))
    points = results.mesh.points
    low, high = points.min(axis=0), points.max(axis=0)
    for i in chosen:
        moved = points + scale * results.frame(int(i)).U
        low, high = np.minimum(low, moved.min(axis=0)), np.maximum(high, moved.max(axis=0))
    with look() as mpl:
        from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter

        width, height, below = extent_size(low, high)
        figure = new_figure(width, height, shown=False)
        ax = figure.add_subplot()
        pad = 0.04 * float((high - low).max())

        def show(i: int) -> list[Any]:
            ax.clear()
            painted = paint(ax, mpl, drawing, i, scale, edges, True, limits)
            ax.set_xlim(low[0] - pad, high[0] + pad)
            ax.set_ylim(low[1] - pad, high[1] + pad)
            ax.set_title(frame_title(results, i, scale), loc="left")
            return [painted]

        painted = show(int(chosen[0]))[0]
        bar = figure.colorbar(
            painted,
            ax=ax,
            location="bottom" if below else "right",
            shrink=0.75 if below else 0.8,
            aspect=38 if below else 28,
            pad=0.04,
        )
        label_bar(bar, name, per_cell, limits, results.model.unit_system)
        figure.canvas.draw()
        figure.set_layout_engine("none")  # else the axes would move with the titles
        rate = max(2, min(25, round(len(chosen) / seconds)))
        moving = FuncAnimation(figure, show, frames=[int(i) for i in chosen], blit=False)
        hidden = target.with_name(f".{target.stem}.next{target.suffix.lower()}")
        writer: Any = PillowWriter(fps=rate)
        if hidden.suffix == ".mp4":
            writer = FFMpegWriter(fps=rate, codec="h264", extra_args=PLAYABLE)
        try:
            moving.save(hidden, writer=writer, dpi=dpi)
            os.replace(hidden, target)
        except OSError as error:
            with contextlib.suppress(OSError):
                hidden.unlink(missing_ok=True)
            raise full(error, target) from None
    return target

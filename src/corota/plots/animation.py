"""An analysis as an animation, uniform in time."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import shutil
import subprocess
from base64 import b64encode
from io import BytesIO
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from corota.errors import InputError
from corota.io.atomic_file import replaced
from corota.names import choose
from corota.plots.contour import Drawing, color_bar, frame_title, label_bar, paint
from corota.plots.figure import (
    extent_size,
    fit_texts,
    fitted_title,
    look,
    new_figure,
    picture_path,
    plane_axes,
)
from corota.results import variables as vf

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from os import PathLike
    from pathlib import Path

    from numpy.typing import NDArray

    from corota.arrays import Floats, Ints
    from corota.results.results import Results


#: Pictures of one pass, at most.
MOST_FRAMES = 120
#: Even numbers of pixels and colors that every player supports.
PLAYABLE = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]
#: Colors of a GIF, which can have 256.
PALETTE = 128


def require_ffmpeg() -> None:
    """Refuse MP4 where the program ffmpeg is missing.

    Raises
    ------
    InputError
    """
    if shutil.which("ffmpeg") is None:
        raise InputError(
            "an MP4 needs the program ffmpeg, which is not on PATH: install it (such as apt "
            "install ffmpeg), or write a .gif"
        )


def moments(times: Floats, most: int, spacing: str) -> Ints:
    """Frames to show, one per picture; a long increment is shown proportionally longer.

    Examples
    --------
    >>> moments(np.array([0.0, 0.1, 0.2, 1.0]), 6, "time").tolist()
    [0, 2, 2, 2, 2, 3]
    """
    count = len(times)
    even = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    steps = np.diff(times)
    if spacing == "increments" or count < 3 or steps.min() <= 0.0:
        return np.asarray(even)
    if np.ptp(steps) <= 1e-6 * steps.max():
        return np.asarray(even)
    # Enough pictures to resolve the shortest increments, up to the limit.
    wanted = int(min(most, max(count, round((times[-1] - times[0]) / steps.min()) + 1)))
    at = np.linspace(times[0], times[-1], wanted)
    after = np.searchsorted(times, at + 1e-9 * (times[-1] - times[0]), side="right") - 1
    return np.asarray(np.clip(after, 0, count - 1))


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
    spacing: Literal["time", "increments"] = "time",
) -> Path:
    """Write an analysis as an animation, with one color scale and one window for all.

    Each picture is passed on as soon as it is drawn; a state that is shown longer is drawn once.

    Parameters
    ----------
    results : Results
    name : str
        Variable.
    path : path-like
        Ends with ``.gif``, ``.html`` (one page with the pictures in it, to play and to step), or
        ``.mp4`` (needs the program ffmpeg).
    scale : float
        Factor of the displacements.
    per_cell : bool
        Averages of the cells.
    edges : bool, optional
    seconds : float
        Length of one pass.
    dpi : float
    spacing : {"time", "increments"}
        Uniform in time, or one picture per increment.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the ending is unknown, or a program for it is missing.
    FileError
        If writing fails.
    """
    target = picture_path(path, tuple(FORMATS))
    way = choose(spacing, ("time", "increments"), "spacing")
    if target.suffix.lower() == ".mp4":
        require_ffmpeg()
    name = vf.match_name(name, results.variables())
    drawing = Drawing(results, name, per_cell)
    chosen = moments(results.times, MOST_FRAMES, way)
    shown = np.unique(chosen).tolist()
    ranges = [drawing.range(i) for i in shown]
    limits = (min(r[0] for r in ranges), max(r[1] for r in ranges))
    points = results.mesh.points
    low, high = points.min(axis=0), points.max(axis=0)
    for i in shown:
        moved = points + scale * results.frame(i).U
        low, high = np.minimum(low, moved.min(axis=0)), np.maximum(high, moved.max(axis=0))
    rate = max(2, min(25, round(len(chosen) / seconds)))

    def pictures() -> Iterator[Any]:
        """Images of 8-bit colors, shape (height, width, 3), each drawn once."""
        with look() as mpl:
            width, height, below = extent_size(low, high)
            figure = new_figure(width, height, shown=False)
            figure.set_dpi(dpi)
            ax = figure.add_subplot()
            painted = paint(ax, mpl, drawing, int(chosen[0]), scale, edges, True, limits)
            plane_axes(ax, low, high, 0.04 * float((high - low).max()), results.model.unit_system)
            # The longest title determines the layout of all.
            ax.set_title(frame_title(results, int(chosen[-1]), scale), loc="left")
            bar = color_bar(figure, ax, painted, below)
            label_bar(bar, name, per_cell, limits, results.model.unit_system)
            fit_texts(figure)
            stage = _Stage(figure, ax)
            last, image = int(chosen[0]), None
            for i in chosen.tolist():
                if i != last:
                    stage.clear()
                    paint(ax, mpl, drawing, i, scale, edges, True, limits)
                if i != last or image is None:
                    fitted_title(ax, frame_title(results, i, scale))
                    image, last = stage.picture(), i
                yield image

    with replaced(target, target.suffix.lower()) as hidden:
        FORMATS[target.suffix.lower()](pictures(), hidden, rate)
    return target


class _Stage:
    """Axes whose ticks, labels and color bar are drawn once; only the contents are repainted.

    Parameters
    ----------
    figure, ax
        With a first picture in them, which settles the layout.
    """

    def __init__(self, figure: Any, ax: Any) -> None:
        self._figure, self._ax = figure, ax
        figure.canvas.draw()
        figure.set_layout_engine("none")  # otherwise the axes move with the titles
        painted = self._painted()
        for artist in painted:
            artist.set_visible(False)
        self._ax.set_title("", loc="left")
        figure.canvas.draw()
        self._empty = figure.canvas.copy_from_bbox(figure.bbox)
        for artist in painted:
            artist.set_visible(True)

    def _painted(self) -> list[Any]:
        return [*self._ax.collections, *self._ax.lines, *self._ax.patches]

    def clear(self) -> None:
        """Remove the painted contents."""
        for artist in self._painted():
            artist.remove()

    def picture(self) -> Any:
        """The painted contents on the empty axes: 8-bit colors, shape (height, width, 3)."""
        canvas = self._figure.canvas
        canvas.restore_region(self._empty)
        for artist in sorted(self._painted(), key=lambda one: one.get_zorder()):
            self._ax.draw_artist(artist)
        self._ax.draw_artist(self._ax._left_title)
        return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _gif(pictures: Iterator[Any], path: Path, rate: int) -> None:
    """Pictures in sequence; Pillow stores the differences."""
    from PIL import Image

    palette: Any = None
    nearest = np.zeros(0, np.uint8)

    def reduced() -> Iterator[Any]:
        nonlocal palette, nearest
        last, held = None, palette
        for image in pictures:
            if image is not last:
                if palette is None:
                    # The first picture has all colors: they are in its bar.
                    palette = Image.fromarray(image).quantize(PALETTE)
                    nearest = _nearest(np.array(palette.getpalette()).reshape(-1, 3))
                short = image.astype(np.int64) >> 3
                held = Image.fromarray(nearest[short @ [1024, 32, 1]], "P")
                held.putpalette(palette.getpalette())
                last = image
            assert held is not None
            yield held.copy()

    stream = reduced()
    first = next(stream)
    first.save(
        path,
        save_all=True,
        append_images=stream,
        duration=round(1000 / rate),
        loop=0,
        optimize=False,
    )


def _nearest(palette: Ints) -> NDArray[np.uint8]:
    """Index of the nearest color of a palette for each color of five bits a channel."""
    level = np.arange(32) * (255.0 / 31.0)
    every = np.stack(np.meshgrid(level, level, level, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    pieces = np.array_split(every, 32)
    found = [((piece - palette) ** 2).sum(axis=-1).argmin(axis=1) for piece in pieces]
    return np.concatenate(found).astype(np.uint8)


def _mp4(pictures: Iterator[Any], path: Path, rate: int) -> None:
    """Raw pictures through a pipe to ffmpeg.

    Raises
    ------
    InputError
        With the last line of ffmpeg's message.
    """
    first = next(pictures)
    height, width = first.shape[:2]
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{width}x{height}", "-r", str(rate), "-i", "-", "-an"]
    command += ["-vcodec", "h264", *PLAYABLE, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert run.stdin is not None
        assert run.stderr is not None
        with contextlib.suppress(BrokenPipeError):
            run.stdin.write(first.tobytes())
            for image in pictures:
                run.stdin.write(image.tobytes())
        with contextlib.suppress(BrokenPipeError):
            run.stdin.close()
        said = run.stderr.read().decode(errors="replace").strip().splitlines()
        if run.wait():
            raise InputError(f"{path.name}: ffmpeg: {said[-1] if said else 'failed'}")


_PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Corota</title>
<style>body{font:14px system-ui,sans-serif;margin:1em;color-scheme:light}
img{max-width:100%%}input{width:min(100%%,40em)}</style>
<img id="i" alt="deformed shape"><br>
<button id="p">Pause</button> <input id="s" type="range" min="0" max="%(last)d" value="0"
 aria-label="picture">
<script>const f=[%(data)s],o=[%(order)s];let k=0,t=0;
const i=document.getElementById("i"),s=document.getElementById("s"),p=document.getElementById("p");
function show(n){k=n;s.value=n;i.src="data:image/png;base64,"+f[o[n]]}
function play(){t=setInterval(()=>show((k+1)%%o.length),%(pause)d);p.textContent="Pause"}
function stop(){clearInterval(t);t=0;p.textContent="Play"}
p.onclick=()=>t?stop():play();s.oninput=()=>{stop();show(+s.value)};
document.onkeydown=e=>{if(e.key==="ArrowRight"&&e.target!==s){stop();show((k+1)%%o.length)}
if(e.key==="ArrowLeft"&&e.target!==s){stop();show((k+o.length-1)%%o.length)}};
show(0);play();</script></html>
"""


def _html(pictures: Iterator[Any], path: Path, rate: int) -> None:
    """One page with the pictures in it; needs no network."""
    from PIL import Image

    data: list[str] = []
    order: list[int] = []
    last = None
    for image in pictures:
        if image is not last:
            buffer = BytesIO()
            Image.fromarray(image).quantize(PALETTE).save(buffer, "png")
            data.append(b64encode(buffer.getvalue()).decode("ascii"))
            last = image
        order.append(len(data) - 1)
    page = _PAGE % {
        "data": ",".join(f'"{text}"' for text in data),
        "order": ",".join(map(str, order)),
        "last": len(order) - 1,
        "pause": round(1000 / rate),
    }
    path.write_text(page, encoding="utf-8")


#: Encoder by file extension; it gets one picture at a time.
FORMATS: dict[str, Callable[[Iterator[Any], Path, int], None]] = {
    ".gif": _gif,
    ".mp4": _mp4,
    ".html": _html,
}

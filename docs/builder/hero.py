"""The pictures of the front page: a snap-fit in motion beside its force, and a strip rolled up.

``python docs/builder/hero.py [RESULTS.vtkhdf]`` draws it, from the results of
``examples/contact/clip.py`` or by solving it again (about a minute).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import io
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import corota as ct
from corota.plots.contour import Drawing, paint
from corota.plots.figure import COLORS, INK, PALE, look

Floats = NDArray[np.float64]
ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "images"
#: Pictures of a cycle, time of one [ms], size [inch], dots per inch and colors.
COUNT, DURATION, SIZE, DPI, PALETTE = 24, 130, (7.2, 2.9), 100, 64
#: The range of colors ends a little above yield [MPa].
LIMITS = (0.0, 60.0)
#: The view of the clip [mm].
VIEW = (-0.8, 33.0, -5.2, 6.3)


def solve() -> ct.Results:
    """Push the clip in and pull it out."""
    example = runpy.run_path(str(ROOT / "examples" / "contact" / "clip.py"))
    results: ct.Results = example["run"]()
    return results


def curves(results: ct.Results) -> tuple[Floats, Floats, Floats]:
    """Step, way and force of the root in every frame."""
    way, force = (np.array(results.history(name, at="left")) for name in ("U1", "RF1"))
    return np.array(results.history("step")), way, force


def chosen(step: Floats, way: Floats) -> list[int]:
    """Frames at about equal ways of the root: one cycle."""
    whole = np.where(step <= 1, way, 2.0 * way.max() - way)
    wanted = np.linspace(0.0, whole[-1], COUNT)
    return [int(np.abs(whole - at).argmin()) for at in wanted]


def draw(results: ct.Results, frame: int, curve: tuple[Floats, Floats, Floats]) -> Any:
    """One picture as RGB."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    step, way, force = curve
    with look() as mpl:
        figure = Figure(figsize=SIZE, layout="constrained")
        FigureCanvasAgg(figure)
        left, right = figure.subplots(1, 2, width_ratios=[1.75, 1.0])
        painted = paint(
            left, mpl, Drawing(results, "MISES", False), frame, 1.0, False, True, LIMITS
        )
        left.set(xlim=VIEW[:2], ylim=VIEW[2:], xlabel="", ylabel="")
        left.set_axis_off()
        left.plot([0.0, 5.0], [-4.4, -4.4], color=INK, linewidth=2.0)
        left.text(5.5, -4.4, "5 mm", va="center")
        left.set_title("A clip snaps past its catch, and out again", loc="left", weight="bold")
        bar = figure.colorbar(
            painted, ax=left, location="bottom", shrink=0.8, aspect=40, pad=0.02, extend="max"
        )
        bar.set_label("von Mises stress [MPa], 45 is yield", labelpad=2.0)
        bar.set_ticks([0, 15, 30, 45, 60])
        bar.outline.set_linewidth(0.5)
        for number, color, name in ((1, COLORS[0], "in"), (2, COLORS[1], "out")):
            part = step == number
            right.plot(way[part], force[part], color=PALE, linewidth=0.8)
            done = part & (np.arange(len(step)) <= frame)
            right.plot(way[done], force[done], color=color, linewidth=1.8)
            peak = int(np.abs(np.where(part, force, 0.0)).argmax())
            right.annotate(
                f"{name}: {abs(force[peak]):.1f} N",
                (way[peak], force[peak]),
                xytext=(4, 4 if number == 1 else -11),
                textcoords="offset points",
                color=color,
            )
        right.plot(way[frame], force[frame], "o", color=INK, markersize=5.0, zorder=5)
        right.axhline(0.0, color=PALE, linewidth=0.6)
        right.set(xlabel="way of the root [mm]", xlim=(0.0, 10.6), ylim=(-10.0, 13.5))
        right.set_title("Force on the root [N]", loc="left", fontsize=9.0)
        data = io.BytesIO()
        figure.savefig(data, dpi=DPI, format="png")
    with Image.open(data) as image:
        return image.convert("RGB")


def rollup(path: Path) -> None:
    """Draw the strip of the front page in five states, to one scale of stress."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    results = ct.solve(ct.examples.load("rollup"))
    data = io.BytesIO()
    with look() as mpl:
        figure = Figure(figsize=(4.4, 3.3), layout="constrained")
        FigureCanvasAgg(figure)
        ax = figure.subplots()
        drawing = Drawing(results, "MISES", False)
        last = len(results.frames) - 1
        limits = (0.0, drawing.range(last)[1])
        for frame in np.linspace(0, last, 5).round().astype(int):
            painted = paint(ax, mpl, drawing, int(frame), 1.0, False, False, limits)
        ax.set(xlim=(-2.3, 10.4), ylim=(-0.6, 7.6))
        ax.set_axis_off()
        bar = figure.colorbar(painted, ax=ax, location="bottom", shrink=0.7, aspect=34, pad=0.02)
        bar.set_label("von Mises stress", labelpad=2.0)
        bar.locator = mpl.ticker.MaxNLocator(4)
        bar.update_ticks()
        bar.outline.set_linewidth(0.5)
        figure.savefig(data, dpi=DPI, format="png")
    with Image.open(data) as image:
        image.convert("RGB").quantize(PALETTE).save(path, optimize=True)


def main() -> None:
    """Draw the pictures and write them."""
    from PIL import Image

    rollup(FOLDER / "rollup.png")
    results = ct.read_results(sys.argv[1]) if len(sys.argv) > 1 else solve()
    curve = curves(results)
    frames = chosen(*curve[:2])
    pictures = [draw(results, frame, curve) for frame in frames]
    peak = int(np.argmax(curve[2][frames]))
    # One palette for all pictures keeps colors steady and the file small.
    palette = pictures[peak].quantize(PALETTE)
    quantized = [
        picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures
    ]
    quantized[peak].save(FOLDER / "hero.png", optimize=True)
    quantized[0].save(
        FOLDER / "hero.gif",
        save_all=True,
        append_images=quantized[1:],
        duration=DURATION,
        loop=0,
        optimize=True,
    )


if __name__ == "__main__":
    main()

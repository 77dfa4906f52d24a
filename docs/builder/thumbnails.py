"""Pictures of the example scripts in ``docs/images/gallery``.

``python docs/builder/thumbnails.py [NAME]`` draws them. Each script runs as it is; the picture is
of its analysis with the most frames, at the frame of the largest stress or at the last one.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import io
import sys
import tempfile
from pathlib import Path

import corota as ct
from corota.plots.contour import Drawing, paint
from corota.plots.figure import look

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "images" / "gallery"
#: Size [inch], dots per inch and colors of a picture.
SIZE, DPI, COLORS = (3.6, 2.4), 110, 48
#: Pictures of the last frame, where the frame of the largest stress looks like another example.
LAST = {"contact-bistable_beam.png"}
#: Scripts that draw no results of their own.
NONE = {"gripper/mesh.py"}


def scripts() -> list[Path]:
    """Scripts that have a picture."""
    every = sorted((ROOT / "examples").glob("*/*.py"))
    return [p for p in every if p.relative_to(ROOT / "examples").as_posix() not in NONE]


def name(script: Path) -> str:
    """Name of the picture of a script."""
    return f"{script.parent.name}-{script.stem}.png"


def telling(results: ct.Results) -> int:
    """Index of the frame with the largest stress; of the last one where nothing is stressed."""
    if "MISES" not in results.variables(-1):
        return len(results.frames) - 1
    size = [float(results.nodal("MISES", i).max()) for i in range(len(results.frames))]
    return max(range(len(size)), key=lambda i: (size[i], i))


def draw(results: ct.Results, path: Path) -> None:
    """Draw the telling frame: the deformed body in colors alone, with its undeformed outline."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    frame = len(results.frames) - 1 if path.name in LAST else telling(results)
    name = "MISES" if "MISES" in results.variables(frame) else "U"
    data = io.BytesIO()
    with look() as mpl:
        figure = Figure(figsize=SIZE)
        FigureCanvasAgg(figure)
        ax = figure.add_axes((0.02, 0.02, 0.96, 0.96))
        paint(ax, mpl, Drawing(results, name, False), frame, 1.0, False, True, None)
        ax.set_axis_off()
        figure.savefig(data, dpi=DPI, format="png")
    with Image.open(data) as image:
        image.convert("RGB").quantize(COLORS).save(path, optimize=True)


if __name__ == "__main__":
    from benchmarks.campaigns.report_pages import solve_example

    FOLDER.mkdir(exist_ok=True)
    wanted = sys.argv[1:]
    for script in scripts():
        if wanted and not any(word in name(script) for word in wanted):
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = script.relative_to(ROOT / "examples").with_suffix("").as_posix()
            results = solve_example(path, Path(folder))
            draw(results, FOLDER / name(script))
        print(name(script), flush=True)

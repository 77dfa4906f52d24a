"""Pictures of the example scripts in ``docs/images/gallery``.

``python docs/builder/thumbnails.py [NAME]`` draws them.
Each script runs as it is; the picture is of its last results, at the frame of the largest stress.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import io
import os
import runpy
import sys
import tempfile
from pathlib import Path

import corota as ct

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "images" / "gallery"
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


def has_stress(results: ct.Results) -> bool:
    """Whether a picture of the stress shows something."""
    return "MISES" in results.variables(-1) and bool(results.nodal("MISES", telling(results)).any())


def draw(results: ct.Results, path: Path, dpi: int = 60) -> None:
    """Draw the telling frame of results."""
    import matplotlib.pyplot as plt

    results.plot(frame=telling(results), path=path, dpi=dpi)
    plt.close("all")


def solved(script: Path) -> list[ct.Results]:
    """Run a script in a folder of its own, and collect what it solves."""
    found: list[ct.Results] = []
    solve = ct.solve

    def kept(*args: object, **options: object) -> ct.Results:
        results = solve(*args, **options)  # type: ignore[arg-type]
        found.append(results)
        return results

    before, arguments = Path.cwd(), sys.argv
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        os.chdir(folder)
        sys.argv = [str(script)]
        ct.solve = kept  # type: ignore[assignment]
        try:
            runpy.run_path(str(script), run_name="__main__")
        except SystemExit:
            pass
        finally:
            ct.solve = solve
            sys.argv = arguments
            os.chdir(before)
    return found


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    wanted = sys.argv[1:]
    for script in scripts():
        if wanted and not any(word in name(script) for word in wanted):
            continue
        results = solved(script)
        if results:
            stressed = [r for r in results if has_stress(r)]
            draw((stressed or results)[-1], FOLDER / name(script))
        print(name(script), len(results), "analyses")

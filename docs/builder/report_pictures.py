"""Pictures of reports for the page about them: ``python docs/builder/report_pictures.py``.

They need a headless Chromium. Each page is made by the program, opened as it is, and kept as
``docs/images/report-NAME.png`` with few colors.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

import corota as ct
from benchmarks.campaigns.browser import Browser
from benchmarks.campaigns.report_pages import READY
from corota.report import report_job

FOLDER = Path(__file__).resolve().parents[1] / "images"
COLORS = 128


def leaf(name: str, thickness: float) -> ct.Model:
    """A leaf spring that is bent and let go."""
    model = ct.Model(ct.mesh.rectangle(60.0, thickness, nx=60, ny=2), name=name)
    model.units("mm", "N", "t", "s")
    steel = ct.Elastic(E=205e3, nu=0.3, name="spring steel")
    model.section(element="Q4I", material=steel, thickness=10.0)
    model.fix("left")
    tip = ct.near(60.0, 0.5 * thickness)
    there, back = ct.Static(increments=8), ct.Static(increments=8)
    there.fix(tip, x=None, y=10.0)
    back.fix(tip, x=None, y=0.0)
    model.steps = [there, back]
    return model


def run(model: ct.Model, folder: Path) -> Path:
    """Solve with files; the stem of the job."""
    with ct.JobFiles(folder) as files:
        ct.solve(model, observers=[files])
    return folder / model.name


def picture(browser: Browser, page: Path, name: str, size: tuple[int, int], dark: bool) -> None:
    """Open a page and keep what it shows first."""
    browser.prefer("dark" if dark else "light")
    browser.resize(*size)
    browser.open(page.as_uri(), READY, 120.0)
    browser.run("new Promise((done) => setTimeout(done, 400))")
    target = FOLDER / f"report-{name}.png"
    browser.picture(target)
    with Image.open(target) as image:
        image.convert("RGB").quantize(COLORS).save(target, optimize=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place, Browser() as browser:
        folder = Path(place)
        gripper = report_job(run(ct.examples.load("gripper"), folder))
        picture(browser, gripper, "wide", (1400, 860), False)
        thin, thick = (run(leaf(name, t), folder) for name, t in (("thin", 0.8), ("thick", 1.0)))
        both = report_job(thin, folder / "both.html", other=thick)
        picture(browser, both, "two", (1400, 860), False)
        seal = report_job(run(ct.examples.load("seal"), folder))
        picture(browser, seal, "narrow", (480, 900), True)

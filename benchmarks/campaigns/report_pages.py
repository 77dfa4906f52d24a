"""The report of every example, and of a run that stops, opened in a headless browser.

    python -m benchmarks report_pages [-o DIR] [--pictures] [NAME ...]

Each page must open without an error on the console and without a request beside itself, stay below
10 MB, play, answer a probe, and move its player at a click on a curve.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import contextlib
import importlib.util
import io
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import corota as ct
from benchmarks.campaigns.browser import Browser, BrowserError, find_browser
from corota.analysis.run import Analysis
from corota.report import report_job, write_report

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
#: Most bytes of a page.
MOST_BYTES = 10_000_000
#: A script that makes a mesh and solves nothing.
NO_MODEL = {"gripper/mesh"}
READY = "document.documentElement.dataset.ready === 'yes'"
PAGE = "window.corotaReport"


def names() -> list[str]:
    """Examples by their path, without the ending."""
    found = [p.relative_to(EXAMPLES).with_suffix("") for p in EXAMPLES.glob("*/*.py")]
    return sorted(str(path) for path in found if str(path) not in NO_MODEL)


@contextlib.contextmanager
def caught(results: list[ct.Results]) -> Iterator[None]:
    """Collect the results of all analyses, by whatever name they were started."""
    before = Analysis.run

    def run(analysis: Analysis) -> ct.Results:
        found = before(analysis)
        results.append(found)
        return found

    Analysis.run = run  # type: ignore[method-assign]
    try:
        yield
    finally:
        Analysis.run = before  # type: ignore[method-assign]


@contextlib.contextmanager
def inside(folder: Path) -> Iterator[None]:
    """Work in a folder for a while: examples write beside themselves."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def solve_example(name: str, folder: Path) -> ct.Results:
    """The results of an example that have the most frames."""
    path = EXAMPLES / f"{name}.py"
    spec = importlib.util.spec_from_file_location("report_example", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    results: list[ct.Results] = []
    arguments, sys.argv = sys.argv, [str(path)]
    sys.path.insert(0, str(path.parent))  # some use the models of their neighbors
    try:
        with (
            caught(results),
            inside(folder),
            contextlib.redirect_stdout(io.StringIO()),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            sys.modules["report_example"] = module
            spec.loader.exec_module(module)
            module.main()
    finally:
        sys.argv = arguments
        sys.path.remove(str(path.parent))
    if not results:
        raise RuntimeError(f"{name}: solved nothing")
    return max(results, key=lambda found: len(found.frames))


def aborted(folder: Path) -> Path:
    """Files of a run that stops: a bar of a perfectly plastic material beyond its limit load."""
    model = ct.Model(ct.mesh.rectangle(10.0, 2.0, nx=20, ny=4), name="aborted")
    steel = ct.Mises(E=1000.0, nu=0.3, yield_stress=1.0, name="soft steel")
    model.section("all", element="Q4I", material=steel)
    model.fix("left")
    model.force("right", y=-0.4)
    step = ct.Static(first_increment=0.2, nlgeom=False)
    with ct.JobFiles(folder) as files, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with contextlib.suppress(ct.ConvergenceError):
            ct.solve(model, step, observers=[files])
    return folder / "aborted"


def check_page(browser: Browser, path: Path) -> dict[str, Any]:
    """Open a page and use it; what was found, with the key ``faults``."""
    faults: list[str] = []
    size = path.stat().st_size
    if size > MOST_BYTES:
        faults.append(f"{size} bytes")
    begin = time.perf_counter()
    browser.open(path.as_uri(), READY, 120.0)
    opened = time.perf_counter() - begin
    shown = f"{PAGE}.scene.shown.length"
    frames = browser.run(shown)
    plays = plays_frames(browser) if frames > 1 else None
    probes = answers_probe(browser)
    links = follows_curve(browser) if frames > 1 else None
    browser.run(f"{PAGE}.player.showView('model')")
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    browser.run(f"{PAGE}.player.showView('results')")
    for name, good in (("play", plays), ("probe", probes), ("curve", links)):
        if good is False:
            faults.append(f"no answer: {name}")
    faults += [f"console: {text}" for text in browser.console]
    faults += [f"request: {a}" for a in browser.requests if a != path.as_uri()]
    return {
        "bytes": size, "frames": frames, "seconds": opened, "play": plays, "probe": probes,
        "curve": links, "faults": faults,
    }  # fmt: skip


def plays_frames(browser: Browser) -> bool:
    """Whether the button plays: another frame, or another phase of a mode."""
    browser.run(f"{PAGE}.scene.show(0)")
    state = f"[{PAGE}.scene.index, {PAGE}.scene.phase].join()"
    before = browser.run(state)
    press(browser, "#play")
    try:
        browser.wait(f"{state} !== '{before}'", 60.0)
    except BrowserError:
        return False
    if browser.run(f"{PAGE}.player.playing"):
        press(browser, "#play")
    browser.key("Home", 36)
    return bool(browser.run(f"{PAGE}.scene.index === 0"))


def press(browser: Browser, selector: str) -> None:
    """Click the middle of an element."""
    middle = f"""(() => {{
      const found = document.querySelector("{selector}");
      found.scrollIntoView({{ block: "center" }});
      const box = found.getBoundingClientRect();
      return [box.x + box.width / 2, box.y + box.height / 2];
    }})()"""
    x, y = browser.run(middle)
    browser.click(x, y)


def answers_probe(browser: Browser) -> bool:
    """Whether a click on the middle node probes it."""
    place = f"""(() => {{
      const {{ player, model }} = {PAGE};
      const {{ camera, nodes }} = player;
      const stage = document.getElementById("overlay");
      stage.scrollIntoView({{ block: "center" }});
      const box = stage.getBoundingClientRect();
      const node = model.used.lastIndexOf(1);
      const [x, y] = [camera.toX(nodes[2 * node]), camera.toY(nodes[2 * node + 1])];
      return [box.x + x, box.y + y];
    }})()"""
    x, y = browser.run(place)
    browser.click(x, y)
    panel = "document.getElementById('probe')"
    text = browser.run(f"{panel}.hidden ? '' : {panel}.textContent")
    return "Node" in text or "Element" in text


def follows_curve(browser: Browser) -> bool | None:
    """Whether a click on a curve moves the player; None where there is no curve."""
    place = f"""(() => {{
      const {{ scene, charts }} = {PAGE};
      if (scene.kind !== "increment") scene.showKind("increment");
      const chart = charts.charts[0];
      if (!chart || scene.shown.length < 2) return null;
      scene.show(0);
      chart.root.scrollIntoView({{ block: "center" }});
      const {{ x, y }} = chart.lines[0];
      // The middle: a curve may end where it begins.
      const i = x.length >> 1;
      const box = chart.plot.over.getBoundingClientRect();
      return [box.x + chart.plot.valToPos(x[i], "x"), box.y + chart.plot.valToPos(y[i], "y")];
    }})()"""
    found = browser.run(place)
    if found is None:
        return None
    browser.click(*found)
    return bool(browser.run(f"{PAGE}.scene.index > 0"))


def make_page(name: str, folder: Path) -> Path:
    """Solve an example, write its page."""
    target = folder / f"{name.replace('/', '-')}.html"
    if name == "aborted":
        return report_job(aborted(folder), target)
    return write_report(solve_example(name, folder), target)


def main() -> int:
    """Make and check the pages; 1 if any has a fault."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="examples; else all")
    parser.add_argument("-o", "--output", type=Path, help="folder of the pages")
    parser.add_argument(
        "--pictures", action="store_true", help="pictures too, two widths, two themes"
    )
    args = parser.parse_args()
    if find_browser() is None:
        sys.stdout.write("there is no Chromium on the path\n")
        return 1
    folder = args.output or Path(tempfile.mkdtemp(prefix="corota-pages-"))
    folder.mkdir(parents=True, exist_ok=True)
    folder = folder.resolve()
    bad = 0
    out = sys.stdout
    out.write(f"{'page':<34}{'MB':>7}{'frames':>8}{'opens s':>9}  play probe curve\n")
    with Browser() as browser:
        for name in args.names or [*names(), "aborted"]:
            path = make_page(name, folder)
            found = check_page(browser, path)
            words = {True: "yes", False: "NO", None: "-"}
            answers = " ".join(f"{words[found[k]]:>5}" for k in ("play", "probe", "curve"))
            numbers = f"{found['bytes'] / 1e6:7.2f}{found['frames']:8d}{found['seconds']:9.2f}"
            out.write(f"{name:<34}{numbers} {answers}\n")
            for fault in found["faults"]:
                bad += 1
                out.write(f"    {fault}\n")
            out.flush()
            if args.pictures:
                take_pictures(browser, path)
    out.write(f"{'no fault' if not bad else f'{bad} faults'}; pages in {folder}\n")
    return int(bad > 0)


def take_pictures(browser: Browser, path: Path) -> None:
    """Pictures of a page: wide and narrow, light and dark."""
    for theme in ("light", "dark"):
        browser.prefer(theme)
        for width, height in ((1400, 1000), (480, 900)):
            browser.resize(width, height)
            browser.open(path.as_uri(), READY, 120.0)
            browser.run("new Promise((done) => setTimeout(done, 300))")
            browser.picture(path.with_name(f"{path.stem}-{width}-{theme}.png"))
    browser.prefer("light")
    browser.resize(1400, 1000)


if __name__ == "__main__":
    raise SystemExit(main())

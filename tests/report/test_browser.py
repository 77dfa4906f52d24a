"""The page in a browser: it opens without a fault, plays, answers a probe and follows a curve."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import corota as ct
from benchmarks.campaigns.browser import Browser, find_browser
from benchmarks.campaigns.report_pages import READY, aborted, check_page
from corota.cli import main
from corota.report import report_job
from corota.report.records import JobPaths
from corota.report.server import PageServer

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_browser() is None, reason="there is no Chromium on the path"),
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as made:
        yield made


def test_finished_run(browser: Browser, tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2, cell="quad8"), name="beam")
    model.section("all", element="Q8R", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-1.0)
    path = ct.solve(model, ct.Static(increments=5), threads=1).report(tmp_path / "beam.html")
    found = check_page(browser, path)
    assert found["faults"] == []
    assert (found["frames"], found["play"], found["probe"], found["curve"]) == (6, True, True, True)
    # What the page computes is what Python computes.
    results = ct.solve(model, ct.Static(increments=5), threads=1)
    browser.run("window.corotaReport.scene.show(5)")
    for name in ("MISES", "SP1", "EP3", "U", "S12"):
        values = browser.run(
            "(() => { const { scene } = window.corotaReport;"
            f" return [...scene.values(scene.fields.get('{name}'))]; }})()"
        )
        wanted = results.nodal(name)
        assert values == pytest.approx(wanted, rel=1e-3, abs=1e-3 * abs(wanted).max())


def test_aborted_run(browser: Browser, tmp_path: Path) -> None:
    path = report_job(aborted(tmp_path))
    assert check_page(browser, path)["faults"] == []
    assert browser.run("document.getElementById('status').textContent") == "stopped"
    assert "limit load" in browser.run("document.getElementById('message').textContent")


@pytest.mark.parametrize("keys", [("ArrowLeft", 37, -1), ("Home", 36, None), ("End", 35, None)])
def test_keys(browser: Browser, tmp_path: Path, keys: tuple[str, int, int | None]) -> None:
    path = report_job(aborted(tmp_path))
    browser.open(path.as_uri(), READY)
    count = browser.run("window.corotaReport.scene.shown.length")
    browser.run("window.corotaReport.scene.show(5)")
    name, code, step = keys
    browser.key(name, code)
    wanted = 5 + step if step else {"Home": 0, "End": count - 1}[name]
    assert browser.run("window.corotaReport.scene.index") == wanted


def test_page_of_a_run_at_work(browser: Browser, tmp_path: Path) -> None:
    aborted(tmp_path)
    with PageServer(JobPaths(tmp_path, "aborted")) as server:
        browser.open(server.address, "window.corotaReport?.scene?.shown.length > 3")
        assert browser.console == []
        assert all(address.startswith(server.address) for address in browser.requests)
        assert browser.run("document.getElementById('status').textContent") == "stopped"


def loaded_and_unloaded() -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2), name="beam")
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    there, back = ct.Static(increments=3), ct.Static(increments=3)
    there.fix("right", x=None, y=1.0)
    back.fix("right", x=None, y=0.0)
    model.steps = [there, back]
    return model


def test_opens_on_the_largest_force_with_its_branches(browser: Browser, tmp_path: Path) -> None:
    path = ct.solve(loaded_and_unloaded(), threads=1).report(tmp_path / "beam.html")
    browser.open(path.as_uri(), READY)
    assert browser.console == []
    assert browser.run("window.corotaReport.scene.index") == 3  # the end of the first step
    chart = "window.corotaReport.charts.charts[0]"
    labels = browser.run(f"{chart}.lines.map((line) => line.label)")
    assert len(labels) == 2
    assert labels[1] == f"{labels[0]}, back"
    known = [browser.run(f"{chart}.lines[{i}].y.map((v) => v !== null)") for i in range(2)]
    assert known == [[True] * 4 + [False] * 3, [False] * 3 + [True] * 4]
    # The rows of the start of a step are no increments.
    assert " 6 increments" in browser.run("document.getElementById('subtitle').textContent")


def test_marks_limit_points_and_frames_the_tool(browser: Browser, tmp_path: Path) -> None:
    path = ct.solve(ct.examples.load("bistable"), threads=1).report(tmp_path / "switch.html")
    browser.open(path.as_uri(), READY)
    texts = browser.run("window.corotaReport.charts.charts[0].points.map((p) => p.text)")
    assert texts.count("limit") == 2
    # A click beside a mark shows its increment.
    browser.run("window.corotaReport.scene.show(0)")
    chart = "window.corotaReport.charts.charts[0]"
    browser.run(f"{chart}.root.scrollIntoView()")
    row, x, y = browser.run(
        f"(() => {{ const {{ plot, points }} = {chart};"
        " const box = plot.over.getBoundingClientRect(); const { row, x, y } = points[0];"
        " return [row, box.left + plot.valToPos(x, 'x'), box.top + plot.valToPos(y, 'y')]; })()"
    )
    browser.click(x + 6, y + 6)
    number = "window.corotaReport.scene.frame.increment"
    wanted = f"window.corotaReport.history.column('increment')[{row}]"
    assert browser.run(number) == browser.run(wanted)


def test_no_two_lines_of_a_chart_look_the_same(browser: Browser, tmp_path: Path) -> None:
    path = report_job(aborted(tmp_path))
    browser.open(path.as_uri(), READY)
    looks = browser.run(
        "window.corotaReport.charts.charts.map(({ lines }) =>"
        " lines.map(({ stroke, dash }) => `${stroke} ${dash ?? ''}`))"
    )
    assert all(len(set(chart)) == len(chart) for chart in looks)


def test_prints_light_and_within_the_sheet(browser: Browser, tmp_path: Path) -> None:
    path = report_job(aborted(tmp_path))
    browser.prefer("dark")
    browser.open(path.as_uri(), READY)
    browser.run("dispatchEvent(new Event('beforeprint'))")
    dark = {"name": "prefers-color-scheme", "value": "dark"}
    browser.send("Emulation.setEmulatedMedia", media="print", features=[dark])
    browser.resize(690, 980)
    try:
        assert browser.run("document.documentElement.dataset.shade") == "light"
        assert browser.run("document.documentElement.scrollWidth") <= 690
        assert not browser.run("document.getElementById('play').checkVisibility()")
        browser.run("dispatchEvent(new Event('afterprint'))")
        assert browser.run("document.documentElement.dataset.shade") == "dark"
    finally:
        browser.send("Emulation.setEmulatedMedia", media="")
        browser.resize(1400, 1000)
        browser.prefer("light")


def test_a_drop_opens_with_its_contact_force(browser: Browser, tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2), name="drop")
    model.section("all", element="Q4", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    floor = ct.RigidCurve.line((-100.0, -0.01), (100.0, -0.01))
    model.contact("bottom", floor, name="floor")
    model.velocity(y=-1.0)
    path = ct.solve(model, ct.Dynamic(period=0.12, increments=24), threads=1).report(
        tmp_path / "drop.html"
    )
    browser.open(path.as_uri(), READY)
    assert browser.console == []
    assert browser.run("window.corotaReport.charts.main") == "floor: force y"
    force = browser.run("window.corotaReport.history.column('floor: force y')")
    shown = browser.run("window.corotaReport.scene.index")
    assert abs(force[shown]) == pytest.approx(max(abs(v) for v in force if v is not None))
    # The floor is far larger than the body, so it does not shrink it.
    assert browser.run("window.corotaReport.player.camera.scale") > 100.0


def test_two_runs_are_compared_on_one_page(browser: Browser, tmp_path: Path) -> None:
    for name, young in (("soft", 1000.0), ("stiff", 2000.0)):
        model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=1), name=name)
        model.section("all", element="Q4I", material=ct.Elastic(E=young, nu=0.3))
        model.fix("left")
        model.fix("right", x=None, y=0.5)
        ct.solve(model, ct.Static(increments=2), observers=[ct.JobFiles(tmp_path)], threads=1)
    assert main(["report", str(tmp_path / "soft"), str(tmp_path / "stiff"), "--quiet"]) == 0
    browser.open((tmp_path / "soft.html").as_uri(), READY)
    assert browser.console == []
    chart = "window.corotaReport.charts.charts[0]"
    labels = browser.run(f"{chart}.lines.map((line) => line.label)")
    assert labels == [labels[0], f"{labels[0]}, stiff"]
    ends = [browser.run(f"{chart}.lines[{i}].y.at(-1)") for i in range(2)]
    assert ends[1] / ends[0] == pytest.approx(2.0, rel=1e-6)
    text = browser.run("document.getElementById('tables').textContent")
    assert "largest size, soft" in text
    assert "100.0 %" in text


def test_a_ring_is_shown_turned_three_quarters(browser: Browser, tmp_path: Path) -> None:
    """Ring 10 to 12, 2 high: wider than high on the canvas by the slant of the view."""
    model = ct.Model(ct.mesh.rectangle(2.0, 2.0, nx=4, ny=4, origin=(10.0, 0.0)), name="ring")
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.pressure("left", 1.0)
    path = ct.solve(model, threads=1).report(tmp_path / "ring.html")
    browser.open(path.as_uri(), READY)
    assert not browser.run("document.getElementById('revolved').parentElement.hidden")
    browser.run("document.getElementById('revolved').click()")
    browser.wait("document.getElementById('surface').hidden")
    # Extent of what is red or yellow on the right of the scale of colors.
    wide, high = browser.run(
        "(() => { const canvas = document.getElementById('overlay');"
        " const { width, height } = canvas;"
        " const data = canvas.getContext('2d').getImageData(0, 0, width, height).data;"
        " const x = [], y = [];"
        " for (let i = 0; i < width * height; i++)"
        " if (data[4 * i] - data[4 * i + 2] > 30 && i % width > 130)"
        " { x.push(i % width); y.push(Math.floor(i / width)); }"
        " const most = (v, s) => s * v.reduce((a, b) => Math.max(a, s * b), -Infinity);"
        " const size = (v) => most(v, 1) - most(v, -1);"
        " return [size(x), size(y)]; })()"
    )
    assert browser.console == []
    slant = 0.7 / 2.49**0.5
    # The quarter in front is missing: its ends reach as far as the rest of the ring.
    assert high / wide == pytest.approx((24.0 * slant * 0.854 + 2.0 * 0.896) / 24.0, rel=0.1)
    browser.run("document.querySelector('input[name=view][value=model]').click()")
    browser.wait("!document.getElementById('surface').hidden")


def test_a_plane_model_is_not_turned(browser: Browser, tmp_path: Path) -> None:
    path = ct.solve(loaded_and_unloaded(), threads=1).report(tmp_path / "beam.html")
    browser.open(path.as_uri(), READY)
    assert browser.run("document.getElementById('revolved').parentElement.hidden")

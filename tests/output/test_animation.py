"""Moving pictures: uniform in time, each state drawn once, in every format."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota import plots
from corota.plots import animation

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1), name="strip")
    model.units("mm", "N")
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=0.5)
    solved = ct.solve(model, ct.Static(increments=4), threads=1)
    for frame, time in zip(solved.frames, (0.0, 0.1, 0.2, 0.3, 1.0), strict=True):
        frame.time = time
    return solved


def test_pictures_are_uniform_in_time(results: ct.Results) -> None:
    """Of eleven pictures over one unit of time eight show what lasts from .3 to 1."""
    at = animation.moments(results.times, 120, "time")
    assert at.tolist() == [0, 1, 2, 3, 3, 3, 3, 3, 3, 3, 4]
    assert animation.moments(results.times, 120, "increments").tolist() == [0, 1, 2, 3, 4]
    even = np.linspace(0.0, 1.0, 403)
    assert len(animation.moments(even, 120, "time")) == 120


def test_a_state_is_drawn_once(
    results: ct.Results, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = []
    paint = animation.paint

    def counted(*args: object) -> object:
        drawn.append(args[3])
        return paint(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(animation, "paint", counted)
    plots.animate(results, "U2", path=tmp_path / "a.gif", dpi=40)
    assert drawn == [0, 1, 2, 3, 4]


def test_gif_has_the_length_that_was_asked_for(results: ct.Results, tmp_path: Path) -> None:
    from PIL import Image

    with Image.open(plots.animate(results, "U2", path=tmp_path / "a.gif", dpi=40)) as film:
        total = 0
        for number in range(film.n_frames):
            film.seek(number)
            total += film.info["duration"]
    assert total == pytest.approx(11 * 1000 / 3, abs=20)


def test_html_page_needs_no_network(results: ct.Results, tmp_path: Path) -> None:
    page = plots.animate(results, "U2", path=tmp_path / "a.html", dpi=40).read_text()
    assert page.count('"iVBOR') == 5
    assert re.search(r"o=\[0,1,2,3,3,3,3,3,3,3,4\]", page)
    assert "http" not in page

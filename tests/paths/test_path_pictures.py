"""Pictures of paths: what is drawn solid, dashed and marked."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from corota.io.result_reader import read_results
from support.frames import williams_toggle

matplotlib = pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def toggle():
    model, apex = williams_toggle()
    path = ct.ArcLength(displacement=(apex, "y", -0.6))
    return ct.solve(model, ct.Static(path=path)), apex


def test_unstable_branches_are_dashed_and_limit_points_marked(toggle, tmp_path):
    results, apex = toggle
    figure = results.history("U2", at=[apex]).plot("load factor", path=tmp_path / "path.svg")
    lines = figure.axes[0].lines
    drawn = [line for line in lines if len(line.get_xdata()) > 2]
    assert [line.get_linestyle() for line in drawn] == ["-", "--", "-"]
    marks = next(line for line in lines if line.get_label() == "limit point")
    factors = [p.factor for p in results.critical_points]
    assert list(marks.get_ydata()) == pytest.approx(factors)
    assert (tmp_path / "path.svg").stat().st_size > 1000


@pytest.mark.usefixtures("quick_pictures")
def test_stored_results_give_the_same_picture(toggle, tmp_path):
    results, apex = toggle
    results.write(tmp_path / "toggle.vtkhdf")
    with read_results(tmp_path / "toggle.vtkhdf") as stored:
        figure = stored.history("U2", at=[apex]).plot("load factor", path=tmp_path / "p.png")
        marks = [x for x in figure.axes[0].lines if x.get_label() == "limit point"]
        assert len(marks[0].get_xdata()) == 2

"""Histories that are picked from one place say where: smallest, largest, largest in size."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct


@pytest.fixture(scope="module")
def bent() -> ct.Results:
    """A cantilever bent down and pressed: compression below is larger than tension above."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3))
    model.fix("left")
    model.force("right", x=-20.0, y=-1.0)
    return ct.solve(model, ct.Static(increments=2), threads=1)


@pytest.mark.parametrize("combine", ["min", "absmax"])
def test_compression_does_not_disappear(bent: ct.Results, combine: str) -> None:
    history = bent.history("S11", combine=combine)
    extremes = bent.extremes("S11")
    assert history[-1] == extremes.smallest.value < -abs(extremes.largest.value)
    place = history.places[-1]
    assert place == extremes.smallest
    assert place.element in (1, 11)
    assert place.y < 0.5
    assert place.x < 1.0


def test_places_at_nodes(bent: ct.Results) -> None:
    history = bent.history("U2", combine="min")
    place = history.places[-1]
    node = int((bent.mesh.node_labels == place.node).argmax())
    assert bent.frames[-1].U[node, 1] == history[-1] == place.value
    now = bent.mesh.points[node] + bent.frames[-1].U[node]
    assert (place.x, place.y) == pytest.approx(tuple(now))
    assert bent.history("U1", at="right", combine="max").places[-1].x > 9.0


def test_sums_means_and_scalars_have_no_place(bent: ct.Results) -> None:
    assert bent.history("RF2", at="left").places == ()
    assert bent.history("U2", at="right").places == ()
    assert bent.history("load factor").places == ()


def test_places_are_the_same_from_a_file(bent: ct.Results, tmp_path: Path) -> None:
    bent.write(tmp_path / "bent.vtkhdf")
    again = ct.read_results(tmp_path / "bent.vtkhdf")
    for combine in ("min", "max", "absmax"):
        here, there = (r.history("S11", combine=combine) for r in (bent, again))
        assert there[-1] == pytest.approx(here[-1], rel=1e-12)
        assert there.places[-1].place == here.places[-1].place

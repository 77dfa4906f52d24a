"""Curves become loops: gaps, doubles, crossings, holes, whatever their order and direction."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

from corota.errors import InputError
from corota.outline import arc, circle, clean, line, polyline, spline
from corota.outline.curves import bulge
from corota.outline.loops import area

SQUARE = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]


@pytest.mark.parametrize("seed", range(8))
def test_order_direction_and_dirt_change_nothing(seed):
    random = np.random.default_rng(seed)
    curves = [*polyline(SQUARE, closed=True), *circle((2.0, 2.0), 1.0), line((0, 0), (0, 1e-7))]
    curves.append(line((4.0, 4.0), (4.0, 0.0)))  # drawn twice
    for curve in curves:
        curve.points = curve.points + random.uniform(-1e-6, 1e-6, (1, 2))
        if random.random() < 0.5:
            curve.points = curve.points[::-1]
    found = clean([curves[k] for k in random.permutation(len(curves))])
    assert [len(part) for part in found.parts] == [2]
    areas = sorted(area(found.polygon(k)) for k in range(2))
    # A polygon of 72 sides is short of the circle by 1 - sin(x) / x.
    step = 2.0 * math.pi / 72
    assert areas == pytest.approx([math.pi * math.sin(step) / step, 16.0], rel=1e-5)
    assert any("double" in text for text in found.report)
    assert any("shorter" in text for text in found.report)
    assert any("gaps" in text for text in found.report)


def test_parts_within_holes_are_parts():
    nested = [c for r in (4.0, 3.0, 2.0, 1.0) for c in circle((0.0, 0.0), r)]
    beside = polyline(np.array(SQUARE) + 10.0, closed=True)
    assert sorted(len(part) for part in clean([*nested, *beside]).parts) == [1, 2, 2]


def test_a_bulge_is_the_arc_of_dxf():
    # The bulge is the tangent of a quarter of the angle: 1 for a half circle, to the right of it.
    curves = bulge((0.0, 0.0), (2.0, 0.0), 1.0)
    points = np.vstack([c.points for c in curves])
    assert np.allclose(np.hypot(points[:, 0] - 1.0, points[:, 1]), 1.0)
    assert points[:, 1].min() == pytest.approx(-1.0)
    quarter = bulge((1.0, 0.0), (0.0, 1.0), math.tan(math.pi / 8.0))
    assert np.allclose(np.hypot(*quarter[0].points.T), 1.0)


def test_long_arcs_and_closed_splines_are_cut():
    assert len(circle((0.0, 0.0), 1.0)) == 3
    assert len(arc((0.0, 0.0), 1.0, 0.0, 1.0)) == 1
    angles = np.linspace(0.0, 2.0 * math.pi, 9)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    ring[-1] = ring[0]
    assert len(clean(spline(ring)).loops) == 1


@pytest.mark.parametrize(
    ("curves", "reason"),
    [
        (
            [line((0, 0), (1, 0)), line((1, 0), (1, 1)), line((1, 1), (0, 0.01))],
            r"open at \(0, 0\), \(0, 0.01\); the nearest ends are 0.01 apart",
        ),
        (polyline([(0, 0), (2, 2), (2, 0), (0, 2)], closed=True), r"curves cross at \(1, 1\)"),
        ([*polyline(SQUARE, closed=True), line((0, 0), (4, 4))], "three or more curves meet"),
        ([*polyline(SQUARE, closed=True), *circle((4.0, 2.0), 1.0)], r"curves cross at \(4, "),
        ([*polyline(SQUARE, closed=True), line((1, 1), (2, 2))], r"open at"),
        ([], "no curves"),
    ],
)
def test_what_is_no_outline_is_refused_with_the_place(curves, reason):
    with pytest.raises(InputError, match=reason):
        clean(curves)


def test_a_larger_gap_closes_it():
    curves = [line((0, 0), (1, 0)), line((1, 0), (1, 1)), line((1, 1), (0, 0.01))]
    assert len(clean(curves, gap=0.02).loops) == 1


@pytest.mark.parametrize("points", [[(0, 0, 0)], [(0, math.nan), (1, 1)], "ab"])
def test_points_are_pairs_of_finite_numbers(points):
    with pytest.raises((InputError, ValueError)):
        polyline(points)

"""Smoothed masters, and rounds of a master against facets of the slave."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota import _core
from corota.analysis.terms.contact.setup import Surface, smoothed
from corota.errors import InputError
from corota.model.loads import Fixed

STEP = 2e-6


def boundary(points, closed=False):
    """A chain of edges through points, the body on the left."""
    n = len(points)
    first = np.arange(n if closed else n - 1)
    nodes = np.column_stack([first, (first + 1) % n, np.full(len(first), -1)])
    zero = np.zeros(len(first))
    return Surface("chain", nodes[:, :2], nodes, zero, zero + 1.0, zero + 1.0)


def arc(n, angle=np.pi, radius=1.0):
    t = np.linspace(0.0, angle, n + 1)
    return radius * np.column_stack([np.cos(t), np.sin(t)])


def test_straight_boundaries_and_sharp_corners_stay():
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.5, 0.0), (1.5, 1.0), (0.0, 1.0)])
    nodes, _, shapes = smoothed(square, boundary(square, closed=True))
    np.testing.assert_array_equal(nodes, boundary(square, closed=True).nodes)
    assert not shapes.any()


def test_fine_rounds_are_smoothed_and_rounding_is_not():
    """A round of 1000 edges counted as a polygon: its turns are below half a degree."""
    points = arc(1000, 2.0 * np.pi)[:-1]
    assert (smoothed(points, boundary(points, closed=True))[2] == 1).all()
    turned = np.array([(np.cos(0.7), np.sin(0.7))]) * np.linspace(0.0, 1.0, 201)[:, None]
    for digits in (16, 6, 5):  # of 5 digits they turn by up to 4e-3
        written = np.round(turned, digits)
        assert not smoothed(written, boundary(written))[2].any()


def test_pieces_join_round_the_boundary():
    points = np.vstack([arc(6, np.pi / 2), [(-1.0, 1.0)], [(-1.0, -1.0)]])
    nodes, _, shapes = smoothed(points, boundary(points))
    # Half an edge, a parabola at each of the six nodes within, half an edge, two edges.
    assert shapes.tolist() == [2, 1, 1, 1, 1, 1, 1, 3, 0]
    ends = []
    for (a, b, c), shape in zip(nodes, shapes, strict=True):
        p, q = points[a], points[b]
        middle = 0.5 * (p + q)
        rows = {0: (p, q), 1: (0.5 * (p + points[c]), 0.5 * (points[c] + q))}
        ends.append({**rows, 2: (p, middle), 3: (middle, q)}[int(shape)])
    for one, other in zip(ends[:-1], ends[1:], strict=True):
        np.testing.assert_allclose(one[1], other[0], atol=1e-15)


def pair(method, slave, master, points, shapes=True):
    x = np.column_stack([points, np.zeros(len(points))])
    nodes, bulge, kinds = smoothed(points, master)
    if not shapes:
        nodes, bulge, kinds = master.nodes, master.bulge, None
    return x, _core.Contact.edges(
        x, slave.nodes, slave.bulge, slave.thickness, nodes, bulge,
        master_shapes=kinds, method=method, reach=1.0, margin=0.5,
    )  # fmt: skip


def placed(offset=0.0, n=8):
    """A slave of two facets above a round master of n facets to a half circle."""
    master = boundary(arc(n))
    low = arc(n)
    up = np.array([(-0.6, 1.03), (0.05, 1.01), (0.5, 1.02)]) + np.array([offset, 0.0])
    slave = boundary(up)
    slave.nodes[:, :2] += len(low)
    return slave, master, np.vstack([low, up])


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("offset", [0.0, 0.13, -0.21])
def test_derivatives_of_smoothed_masters(method, offset):
    slave, master, points = placed(offset)
    x, core = pair(method, slave, master, points)
    rng = np.random.default_rng(3)
    old = x + 0.01 * rng.standard_normal(x.shape)
    core.search(x)
    n = len(core.nodes)
    p, q = rng.uniform(0.5, 1.0, n), rng.uniform(0.5, 1.0, n)

    def gradient(x):
        raw = core.evaluate(x, old)
        out = np.zeros(x.size + 1)
        both = (
            p[raw["constraint"], None] * raw["gap_gradient"]
            + q[raw["constraint"], None] * raw["slip_gradient"]
        )
        np.add.at(out, raw["variables"], both)
        gaps = np.zeros(x.size + 1)
        np.add.at(gaps, raw["variables"], p[raw["constraint"], None] * raw["gap_gradient"])
        return out[:-1], gaps[:-1], float(p @ raw["total_gap"])

    dx = rng.standard_normal(x.shape) * [1.0, 1.0, 0.0]
    slope, of_gap, _ = gradient(x)
    assert np.abs(slope).max() > 0.1
    _, variables, values = core.hessian(p, q)
    (up, _, high), (down, _, low) = gradient(x + STEP * dx), gradient(x - STEP * dx)
    # The gradient of a slip is the direction of its traction, not that of the path so far.
    assert of_gap @ dx.ravel() == pytest.approx((high - low) / (2.0 * STEP), rel=1e-7)
    v = np.append(dx.ravel(), 0.0)
    curved = np.zeros(x.size + 1)
    np.add.at(curved, variables, (values @ v[variables][:, :, None])[:, :, 0])
    difference = (up - down) / (2.0 * STEP)
    np.testing.assert_allclose(curved[:-1], difference, atol=1e-7 * np.abs(difference).max())
    # Neither a shift nor a turn of everything changes a gap.
    for move in ([1.0, 0.0], [0.0, 1.0]):
        shift = np.tile([*move, 0.0], (len(x), 1))
        assert abs(slope @ shift.ravel()) < 1e-12


def test_distance_to_a_round_master_hardly_depends_on_the_place():
    """Over a circle of radius 1 the polygon's distance varies by its sagitta, the spline's not."""
    spread = []
    for shapes in (False, True):
        gaps = []
        for angle in np.linspace(-0.2, 0.2, 41):
            slave, master, points = placed(n=12)
            c, s = np.cos(angle), np.sin(angle)
            points[-3:] = (points[-3:] * [1.0, 1.0]) @ np.array([[c, s], [-s, c]])
            x, core = pair("node_to_segment", slave, master, points, shapes)
            core.search(x)
            raw = core.evaluate(x)
            seen = raw["total_area"] > 0.0
            gaps.append(float((raw["total_gap"][seen] / raw["total_area"][seen]).min()))
        spread.append(np.ptp(gaps))
    sagitta = 1.0 - np.cos(np.pi / 24)
    assert spread[0] > 0.5 * sagitta
    assert spread[1] < 0.05 * sagitta


@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
def test_the_force_of_a_small_round_slides_without_jumps(element):
    """A rigid round, two slave edges in radius, is drawn along a slope that bends down."""
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.rectangle(10.0, 0.5, 40 if cell == "quad4" else 20, 2, cell)
    ball = ct.mesh.add_node(mesh, 6.0, 1.5, "ball")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    circle = ct.RigidCurve.circle((6.0, 1.0), 0.5, reference=ball)
    model.contact("top", circle, name="ball", friction=0.2, method="node_to_segment")
    first = ct.Static(
        supports=[Fixed("ball", 0, 0.0), Fixed("ball", 1, -1.0), Fixed("ball", 2, 0.0)]
    )
    slide = ct.Static(increments=60, supports=[Fixed("ball", 0, 1.5)])
    results = ct.solve(model, [first, slide])
    force = np.array([results.history(f"ball: force {a}") for a in "xy"])[:, -50:]
    for component in force:
        smooth = np.polyval(np.polyfit(np.arange(50.0), component, 5), np.arange(50.0))
        assert np.abs(component - smooth).max() < 0.02 * np.abs(component).max()


def test_what_cannot_be_smoothed_is_said():
    mesh = ct.mesh.rectangle(1.0, 1.0, 1, 1)
    model = ct.Model(mesh)
    with pytest.raises(InputError, match="only a master of element edges"):
        model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)), smooth=True)


@pytest.mark.parametrize(("method", "noted"), [("node_to_segment", True), ("mortar", False)])
def test_facets_beside_an_overlap_are_noted(method, noted):
    """A quarter of a press fit of .004, whose master has facets .0019 high: force 1.39 by nodes."""
    inner, outer = ct.mesh.annulus(1.0, 2.004, 3, 24, 90.0), ct.mesh.annulus(2.0, 3.0, 3, 18, 90.0)
    model = ct.Model(ct.mesh.assembly(inner=inner, outer=outer))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    for body in ("inner", "outer"):
        model.fix(f"{body}.start", x=None)
        model.fix(f"{body}.end", y=None)
    model.contact("inner.outer", "outer.inner", method=method, name="fit")
    results = ct.solve(model, ct.Static(), threads=1)
    # Lame: the displacements of both rings under the pressure are the overlap.
    p = 0.004 * 1e4 / 2.0 / (5.0 / 3.0 - 0.3 + 13.0 / 5.0 + 0.3)
    right = results.frames[-1].scalars["fit: force x"] / (2.0 * p)
    assert (abs(abs(right) - 1.0) < 0.01) is not noted
    assert any("inside its rounds" in note for note in results.notes) is noted

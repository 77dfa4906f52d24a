"""Selections by geometry stand wherever a set may stand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError

END = ct.on_line((10.0, 0.0), (10.0, 1.0))
ROOT = ct.on_line((0.0, 0.0), (0.0, 1.0))
MIDDLE = ct.near(10.1, 0.45)


def strip(root, end, pressed, cells="all"):
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    model.section(cells, element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix(root)
    model.force(end, y=0.02)
    model.pressure(pressed, 0.01)
    return model


def test_selections_give_the_bits_of_named_sets():
    named = ct.solve(strip("left", "right", "top"))
    box = ct.inside((-1.0, -1.0), (11.0, 2.0))
    chosen = ct.solve(strip(ROOT, END, ct.on_line((10.0, 1.0), (0.0, 1.0)), box))
    assert (named.frames[-1].U == chosen.frames[-1].U).all()
    assert (named.history("RF2", at="left") == chosen.history("RF2", at=ROOT)).all()


def test_steps_take_selections_without_a_mesh():
    model = strip("left", "right", "top")
    model.loads.clear()
    step = ct.Static()
    step.force(END, y=0.02)
    step.fix(MIDDLE, x=0.0, y=None)
    other = ct.Static()
    other.force("right", y=0.02)
    other.fix([21], x=0.0, y=None)
    assert model.mesh.points[21].tolist() == [10.0, 0.5]
    first, second = ct.solve(model, step), ct.solve(model.copy(), other)
    assert (first.frames[-1].U == second.frames[-1].U).all()


def test_a_force_on_a_line_is_a_resultant_and_on_a_node_the_value():
    for where, total in ((END, 0.02), (MIDDLE, 0.02), ("right", 0.02)):
        model = strip("left", where, "top")
        model.loads.clear()
        model.force(where, y=0.02)
        results = ct.solve(model)
        assert results.history("RF2", at="left")[-1] == pytest.approx(-total, rel=1e-9)


@pytest.mark.parametrize("quadratic", [False, True])
def test_a_circle_takes_edges_by_their_ends(quadratic):
    ring = ct.mesh.annulus(1.0, 2.0, 2, 16)
    ring = ct.mesh.to_quadratic(ring) if quadratic else ring
    name = ct.on_circle((0.0, 0.0), 2.0)
    assert len(ring.edge_pairs(name)) == 16
    assert np.allclose(np.hypot(*ring.points[ring.nodes_of(name)].T), 2.0)


def test_a_measure_and_a_history_take_selections():
    results = ct.solve(strip("left", "right", "top"))
    from corota.sweeps.measures import Measure

    value = results.history("U2", at=MIDDLE)[-1]
    assert Measure(f"last(U2@{MIDDLE})")(results) == value
    assert Measure("last(U2@near(10.1, 0.45))")(results) == value


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("on_line(20, 0, 20, 1)", "no node lies there; the mesh has x from 0 to 10"),
        ("on_line(1, 1, 1, 1)", "two different points"),
        ("near(1)", r"write near\(x, y\)"),
        ("inside(0, 0, 1, nan)", r"write inside\("),
        ("on_circle(a, b, c)", r"write on_circle\("),
        ("beside(1, 2)", "no set named"),
    ],
)
def test_what_selects_nothing_is_named(name, reason):
    with pytest.raises(InputError, match=reason):
        ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2).nodes_of(name)


def test_a_point_is_a_pair():
    with pytest.raises(InputError, match="points are pairs"):
        ct.on_line((0.0, 0.0, 0.0), (1.0, 1.0))


def test_selections_are_written_to_decks(tmp_path):
    model = strip(ROOT, END, ct.on_line((10.0, 1.0), (0.0, 1.0)))
    model.steps = [ct.Static()]
    path = ct.write(model, tmp_path / "strip.inp")
    again = ct.solve(ct.read(path))
    assert np.allclose(again.frames[-1].U, ct.solve(model).frames[-1].U, rtol=1e-9, atol=1e-12)


def test_selections_are_drawn(tmp_path):
    strip(ROOT, END, "top").plot(path=tmp_path / "model.png")

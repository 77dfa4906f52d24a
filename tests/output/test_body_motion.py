"""Rotation, displacement and centers of a stage, beside the exact cross-spring pivot."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError

#: Symmetric cross-spring pivot: two leaves of length L at 90 degrees that cross at half length,
#: pure moment. Exact elastica by shooting: M L / EI, rotation [deg], shift of the crossing / L.
PIVOT = [
    (0.350829, 10.0, None),
    (0.712016, 20.0, (-2.466104e-3, 1.398597e-2)),
    (1.092898, 30.0, None),
    (1.501060, 40.0, (-1.881520e-2, 5.169433e-2)),
]


def cross_spring(moment, n=40, depth=0.002):
    half = 0.5 / np.sqrt(2.0)
    way = np.linspace(-half, half, n + 1)
    points = np.concatenate([np.column_stack([way, way]), np.column_stack([-way, way])])
    first = np.concatenate([np.arange(n), n + 1 + np.arange(n)])
    cells = ct.Cells("line2", np.column_stack([first, first + 1]), np.arange(1, 2 * n + 1))
    mesh = ct.Mesh(points, [cells])
    stage = ct.mesh.add_node(mesh, 0.0, 0.0, "stage")
    model = ct.Model(mesh)
    leaf = ct.Elastic(E=12.0 / depth**3, nu=0.0)  # EI = 1
    model.beam(np.arange(2 * n), material=leaf, area=depth, inertia=depth**3 / 12.0)
    model.fix([0, n + 1], rotation=True)
    model.rigid([n, 2 * n + 1], stage)
    model.force([stage], moment=moment)
    return ct.solve(model)


@pytest.mark.parametrize(("moment", "degrees", "shift"), PIVOT)
def test_cross_spring_pivot(moment, degrees, shift):
    results = cross_spring(moment)
    motion = results.body_motion([40, 81])
    assert np.degrees(motion.rotation[-1]) == pytest.approx(degrees, rel=1e-3)
    assert motion.distortion.max() < 1e-12
    if shift is not None:
        assert motion.displacement((0.0, 0.0))[-1] == pytest.approx(shift, rel=1e-3)
    # The reference node says the same.
    alone = results.body_motion("stage")
    assert alone.rotation[-1] == pytest.approx(motion.rotation[-1], rel=1e-12)


def test_centers_of_a_body_that_turns_about_a_point():
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    from corota.results.results import Frame, Results

    results = Results(model)
    about = np.array([3.0, -1.0])
    points = model.mesh.points
    for k, angle in enumerate(np.linspace(0.0, 3.0 * np.pi, 41)):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        moved = (points - about) @ turn.T + about - points
        zero = np.zeros((len(points), 3))
        results.add(Frame(1, k, float(k), float(k), 1.0, moved, zero[:, 0], zero, zero))
    motion = results.body_motion("right")
    assert motion.rotation[-1] == pytest.approx(3.0 * np.pi)
    assert np.isnan(motion.pole[0]).all()
    assert np.allclose(motion.pole[1:], about)
    # Central differences in steps of 0.24 rad: the chord is short by sin(x) / x.
    assert np.allclose(motion.instant_center[1:-1], about, atol=0.04)


def test_nodes_at_one_place_that_do_not_turn_are_refused():
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    with pytest.raises(InputError, match="two nodes at different places"):
        ct.solve(model).body_motion([4])

"""Ties of meshes that do not match: the patch test with shear, and large rotation."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from tests.support.contact import CELLS, stresses

SIGMA = np.array([1.0, -2.0, 0.7])


def tied(low, up, angle):
    """Two tied blocks under the tractions of a uniform stress."""
    a = ct.mesh.rectangle(2.0, 1.0, 3, 2, CELLS[low])
    b = ct.mesh.rectangle(2.0, 0.8, 4, 2, CELLS[up], origin=(0.0, 1.0))
    mesh = ct.mesh.move(ct.mesh.assembly(low=a, up=b), angle=angle)
    model = ct.Model(mesh)
    for name, element in (("low", low), ("up", up)):
        model.section(name, element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c, -s], [s, c]])
    sx, sy, t = SIGMA
    for side, (x, y) in {"left": (-sx, -t), "right": (sx, t)}.items():
        fx, fy = turn @ [x, y]
        model.traction(f"low.{side}", x=fx, y=fy)
        model.traction(f"up.{side}", x=fx, y=fy)
    for side, (x, y) in {"low.bottom": (-t, -sy), "up.top": (t, sy)}.items():
        fx, fy = turn @ [x, y]
        model.traction(side, x=fx, y=fy)
    along = mesh.points[mesh.node_sets["low.bottom"]] @ turn[:, 0]
    ends = mesh.node_sets["low.bottom"][np.argsort(along)[[0, -1]]]
    model.local_axes(ends, angle=np.radians(angle))
    model.fix(ends[:1], x=0.0, y=0.0)
    model.fix(ends[1:], x=None, y=0.0)
    model.tie("up.bottom", "low.top")
    return ct.solve(model, ct.Static(nlgeom=False), threads=1), turn


@pytest.mark.parametrize("shift", [0, 2, 5])
@pytest.mark.parametrize("low", CELLS)
def test_patch(low, shift):
    names = list(CELLS)
    up = names[(names.index(low) + shift) % len(names)]
    results, turn = tied(low, up, 30.0 if shift else 0.0)
    assert np.abs(stresses(results, turn) - SIGMA).max() < 1e-10


def test_a_tied_strip_turns_like_one_piece():
    """A strip of two halves, rolled up by an end moment, tied across its length."""
    left = ct.mesh.rectangle(5.0, 0.2, 10, 2, "quad8")
    right = ct.mesh.rectangle(5.0, 0.2, 10, 3, "quad8", origin=(5.0, 0.0))
    model = ct.Model(ct.mesh.assembly(left=left, right=right))
    model.section("all", element="Q8R", material=ct.Elastic(E=1e6, nu=0.0))
    model.fix("left.left")
    end = model.mesh.node_sets["right.right"]
    tip = ct.mesh.add_node(model.mesh, 10.0, 0.1)
    model.rigid(end, tip)
    inertia = 0.2**3 / 12.0
    model.fix([tip], x=None, y=None, rotation=np.pi)  # half a circle of radius 10 / pi
    model.tie("right.left", "left.right")
    results = ct.solve(model, ct.Static(increments=6), threads=1)
    frame = results.frames[-1]
    assert frame.U[tip] == pytest.approx([-10.0, 20.0 / np.pi], abs=0.02)
    assert frame.RF[tip, 2] == pytest.approx(1e6 * inertia * np.pi / 10.0, rel=2e-3)


def test_what_is_out_of_tolerance_is_named():
    low = ct.mesh.rectangle(2.0, 1.0, 4, 2)
    up = ct.mesh.rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.5))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element="Q4I", material=ct.Elastic(E=1.0))
    model.fix("low.bottom")
    model.tie("up.bottom", "low.top", tolerance=0.1)
    with pytest.raises(ct.ModelError, match=r"no edge of 'up.bottom' lies on 'low.top'"):
        ct.solve(model, threads=1)

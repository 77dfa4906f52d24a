"""Constraints in analyses: quadratic Newton, many turns, equilibrium, closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.newton import ROUNDING, Residuals
from support.tied import KINDS, beam, constrained


@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
@pytest.mark.parametrize("kind", KINDS)
def test_newton_stays_quadratic(kind: str, element: str) -> None:
    model, reference = constrained(kind, element)
    model.fix("left", rotation=True if element == "Q4D" else None)
    if kind == "equations":
        model.force([model.mesh.nodes_of("right")[2]], y=1.0)
        model.fix([reference], x=None, y=0.1)
    elif kind == "straight":
        model.force([model.mesh.nodes_of("right")[2]], x=-2.0, y=1.0)
    elif kind == "kinematic x":
        model.fix([reference], x=None, y=0.0)
        model.force([reference], x=-2.0, moment=2.0)
    else:
        model.force([reference], x=-2.0, y=1.0, moment=0.4)
    watch = Residuals()
    results = ct.solve(model, ct.Static(increments=8), observers=[watch])
    for residuals in watch.by_attempt.values():
        before, last = residuals[-2:]
        # A linear rate ends above a hundredth of the tolerance, far from this.
        assert last <= max(30.0 * before**2, ROUNDING), residuals
    assert np.abs(results.frames[-1].U).max() > 0.01


@pytest.mark.parametrize("kind", ["rigid", "distributing", "rigid in axes"])
def test_body_turned_by_several_turns(kind: str) -> None:
    model, reference = constrained(kind)
    # Turned by its reference node; a distributing one by turning the body's other edge.
    turns = 3
    if kind == "distributing":
        other = model.mesh.n_nodes - 1
        model.rigid("left", other)
        reference, measured = other, reference
    else:
        measured = reference
    model.fix([reference], rotation=2.0 * np.pi * turns)
    frames = ct.solve(model, ct.Static(increments=12 * turns)).frames
    x = model.mesh.points
    center = x[reference]
    for frame in frames[1:]:
        angle = 2.0 * np.pi * turns * frame.factor
        c, s = np.cos(angle), np.sin(angle)
        exact = center + (x - center) @ np.array([[c, s], [-s, c]])
        body = np.unique(model.mesh.cells[0].nodes)
        assert np.abs(x[body] + frame.U[body] - exact[body]).max() < 1e-9
        assert frame.UR[measured] == pytest.approx(angle, abs=1e-9)
        assert np.abs(frame.RF).max() < 1e-7


@pytest.mark.parametrize("kind", ["kinematic", "distributing"])
def test_reaction_at_a_held_reference_node_balances_the_load(kind: str) -> None:
    model, reference = beam()
    model.couple("left", reference, kind=kind)  # type: ignore[arg-type]
    model.fix([reference], rotation=True)
    tip = model.mesh.nodes_of("right")
    if kind == "kinematic":
        model.force(tip, y=0.5)
        frame = ct.solve(model, ct.Static(increments=2)).frames[-1]
        here = model.mesh.points[tip] + frame.U[tip] - model.mesh.points[reference]
        moment = (0.5 * here[:, 0]).sum()
        assert frame.RF[reference] == pytest.approx(
            [0.0, -0.5 * len(tip), -moment], rel=1e-9, abs=1e-9
        )
    else:
        # Held dependents belong to the constraint.
        with pytest.raises(ct.ModelError, match="is supported, but the distributing coupling"):
            ct.solve(model)


def test_distributing_coupling_spreads_a_load_by_weights() -> None:
    model, reference = beam(ny=2)
    right = model.mesh.nodes_of("right")
    model.couple("right", reference, kind="distributing", weights=[1.0, 2.0, 1.0])
    model.fix(np.unique(model.mesh.cells[0].nodes), rotation=None)
    model.force([reference], x=4.0, y=8.0, moment=3.0)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    points = model.mesh.points
    weights = np.array([0.25, 0.5, 0.25])
    arm = points[right] - weights @ points[right]
    offset = points[reference] - weights @ points[right]
    couple = 3.0 + offset[0] * 8.0 - offset[1] * 4.0
    inertia = weights @ (arm**2).sum(axis=1)
    turned = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    spread = weights[:, None] * (np.array([4.0, 8.0]) + couple / inertia * turned)
    assert frame.RF[right, :2] == pytest.approx(-spread, abs=1e-12)


def test_support_in_local_axes_is_an_inclined_roller() -> None:
    angle = 0.4
    model, _ = beam()
    model.fix("left", x=0.0, y=None)
    model.fix([model.mesh.nodes_of("left")[0]])
    corner = model.mesh.nodes_of("right")[:1]
    model.local_axes(corner, angle=angle)
    model.fix(corner, x=None, y=0.0)
    model.force([model.mesh.nodes_of("right")[-1]], y=-1.0)
    frame = ct.solve(model, ct.Static(increments=2)).frames[-1]
    normal = np.array([-np.sin(angle), np.cos(angle)])
    along = np.array([np.cos(angle), np.sin(angle)])
    assert abs(frame.U[corner[0]] @ normal) < 1e-14
    assert abs(frame.U[corner[0]] @ along) > 1e-4
    assert abs(frame.RF[corner[0], :2] @ along) < 1e-9
    assert abs(frame.RF[corner[0], :2] @ normal) > 0.1


def test_radial_axes_expand_a_ring_without_turning_it() -> None:
    ring = ct.mesh.annulus(1.0, 2.0, n_radial=4, n_around=24)
    model = ct.Model(ring)
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    inner = np.flatnonzero(np.hypot(*ring.points.T) < 1.0 + 1e-9)
    model.local_axes(inner, center=(0.0, 0.0))
    model.fix(inner, x=0.02, y=0.0)
    frame = ct.solve(model).frames[-1]
    radius = np.hypot(*ring.points.T)
    radial = (frame.U * ring.points).sum(axis=1) / radius
    across = (frame.U[:, 1] * ring.points[:, 0] - frame.U[:, 0] * ring.points[:, 1]) / radius
    assert radial[inner] == pytest.approx(0.02, abs=1e-14)
    assert np.abs(across).max() < 1e-10


def test_linear_steps_take_constraints_at_small_rotation() -> None:
    for kind in KINDS:
        model, reference = constrained(kind)
        model.fix("left", rotation=True)
        node = model.mesh.nodes_of("right")[2] if kind == "equations" else reference
        if kind in ("equations", "kinematic x"):
            model.fix([reference], x=None, y=0.0)
        load = {"x": 1.0} if kind == "kinematic x" else {"y": 1.0}
        moved = []
        for size in (1.0, 1000.0):
            model.loads.clear()
            model.force([node], **{k: size * v for k, v in load.items()})
            frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
            moved.append(frame.U)
            if kind == "equations":  # its constant does not grow with the load
                break
        if kind != "equations":
            assert moved[1] == pytest.approx(1000.0 * moved[0], rel=1e-9, abs=1e-12)


def test_stretch_of_a_truss_like_strip_by_an_equation() -> None:
    """The right edge moves as one: the force on one node gives uniform stress."""
    model, _ = beam(element="Q4I")
    right = model.mesh.nodes_of("right")
    model.fix("left", y=None)
    model.fix([model.mesh.nodes_of("left")[0]])
    for node in right[1:]:
        model.equation((node, "x", 1.0), (right[0], "x", -1.0))
    model.force([right[0]], x=10.0)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    assert frame.U[right, 0] == pytest.approx(10.0 * 2.0 / 1000.0, rel=1e-12)
    assert frame.fields[0].values["S"][..., 0] == pytest.approx(10.0, rel=1e-10)


def test_nodes_stay_on_a_line_that_turns_and_slide_along_it() -> None:
    """A strip's end kept straight, its nodes free along it, bent through a large angle."""
    mesh = ct.mesh.rectangle(6.0, 1.0, nx=12, ny=4)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element="Q4I", material=material, local_strain="green_lagrange")
    model.fix("left")
    right = mesh.nodes_of("right")
    right = right[np.argsort(mesh.points[right, 1])]
    model.straight("right", right[0], right[-1])
    model.force([right[0]], x=6.0, y=12.0)
    model.force([right[-1]], x=-6.0)
    watch = Residuals()
    frame = ct.solve(model, ct.Static(increments=5), observers=[watch]).frames[-1]
    for residuals in watch.by_attempt.values():
        before, last = residuals[-2:]
        assert last <= max(30.0 * before**2, ROUNDING), residuals
    x = mesh.points[right] + frame.U[right]
    along = (x[-1] - x[0]) / np.linalg.norm(x[-1] - x[0])
    off = (x - x[0]) @ [-along[1], along[0]]
    assert np.abs(off).max() < 1e-12
    assert np.arctan2(-along[0], along[1]) > 0.6
    # Nothing holds the nodes along the line: what is left of their forces is across it.
    assert np.abs(frame.RF[right[1:-1], :2] @ along).max() < 1e-7
    # Forces of the constraint are in balance: loads and the clamp's reactions, and their moments.
    left = mesh.nodes_of("left")
    loads = frame.F[:, :2].sum(axis=0)
    assert frame.RF[left, :2].sum(axis=0) == pytest.approx(-loads, abs=1e-6)


def test_a_node_off_its_line_is_refused() -> None:
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.straight([4], 0, 2)
    with pytest.raises(ct.ModelError, match=r"0\.5 away from the straight line"):
        ct.solve(model)

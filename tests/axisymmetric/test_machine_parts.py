"""Machine parts of revolution: press fits, snap-fits, expanded tubes, seals, ties, slots.

Beside closed forms, and beside CalculiX 2.20 where there is none (its reactions are those of a
sector of 2 degrees: times 180).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

METHODS = ["mortar", "node_to_segment"]


@pytest.mark.parametrize("method", METHODS)
def test_press_fit_slips_at_its_friction(method: str) -> None:
    """Rings 20/40.005 and 40/60, 19 long, mu = .1: 5.74 MPa x .1 x pi 40 x 19 = 1371 N."""
    pin = ct.mesh.rectangle(10.0025, 19.0, 4, 8, cell="quad8")
    hub = ct.mesh.rectangle(10.0, 19.0, 4, 9, cell="quad8")
    pin.points[:, 0] += 10.0
    hub.points[:, 0] += 20.0
    model = ct.Model(ct.mesh.assembly(pin=pin, hub=hub))
    model.section("all", element="Q8", material=ct.Elastic(196e3, 0.3), plane="axisymmetric")
    model.fix("hub.bottom", x=None)
    model.contact("pin.right", "hub.left", method=method, friction=0.1, name="fit")
    steps = []
    for way in (0.0, -0.05):
        step = ct.Static()
        step.fix("pin.top", x=None, y=way)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    force = -results.frames[-1].RF[model.mesh.node_sets["pin.top"], 1].sum()
    normal = abs(results.history("fit: force x")[-1])
    assert force == pytest.approx(0.1 * normal, rel=1e-3)
    # The compressed pin is wider, the hub, too: some thousandths.
    assert force == pytest.approx(1371.0, rel=5e-3)


def pushed(model: ct.Model, node: int, *stages: tuple[float, int]) -> list[np.ndarray]:
    """Ways and forces of the shaft in steps to given places, in given numbers of increments."""
    steps = []
    for way, increments in stages:
        step = ct.Static(increments=increments)
        step.fix([node], x=None if model.sections[0].axisymmetric else 0.0, y=way)
        steps.append(step)
    frames = ct.solve(model, steps, threads=1).frames
    return [
        np.array([[f.U[node, 1], f.RF[node, 1]] for f in frames if f.step == n + 1])
        for n in range(len(stages))
    ]


def test_tube_is_expanded_over_a_cone() -> None:
    """Bore 20, wall 1, E = 200 GPa, yield 250 + 500 p: a cone of 10 degrees to a radius of 10.8.

    CalculiX (CAX8R, the same elements, 200 increments of .08) needs 1108 and 1583 N after 3.2 and
    4.8; without friction all of it is for hoop strain and for bending to and fro.
    """
    mesh = ct.mesh.rectangle(1.0, 30.0, 2, 60, cell="quad8")
    mesh.points[:, 0] += 10.0
    node = ct.mesh.add_node(mesh, 0.0, -20.0, "cone")
    model = ct.Model(mesh)
    steel = ct.Mises(200e3, 0.3, yield_stress=250.0, isotropic=500.0)
    model.section("all", element="Q8R", material=steel, plane="axisymmetric")
    slope = np.tan(np.radians(10.0))
    nose = 0.6 / slope - 0.05
    profile = [(9.4, 40.0), (9.4, nose), (10.8, nose - 1.4 / slope), (10.8, nose - 70.0)]
    cone = ct.RigidCurve.polyline(profile, fillet=4.0, reference=node)
    model.contact("left", cone, method="node_to_segment")
    model.fix("top", x=None)
    way, force = pushed(model, node, (4.8, 16))[0].T
    found = np.interp([3.2, 4.8], way, force)
    np.testing.assert_allclose(found, [1108.0, 1583.0], rtol=0.06)


@pytest.mark.parametrize("element", ["Q4", "Q8", "Q8R"])
@pytest.mark.parametrize("inner", [0.0, 3.0])
@pytest.mark.parametrize("coarse_first", [True, False])
def test_a_tie_passes_uniform_stress(element: str, inner: float, coarse_first: bool) -> None:
    """Three cells on four, whichever side is the slave."""
    cell = "quad8" if element.startswith("Q8") else "quad4"
    low = ct.mesh.rectangle(6.0, 2.0, 4, 2, cell=cell)
    top = ct.mesh.rectangle(6.0, 2.0, 3, 2, cell=cell)
    low.points[:, 0] += inner
    top.points[:] += [inner, 2.0]
    model = ct.Model(ct.mesh.assembly(low=low, top=top))
    model.section("all", element=element, material=ct.Elastic(1e3, 0.3), plane="axisymmetric")
    model.fix("low.bottom", x=None)
    sides = ("top.bottom", "low.top") if coarse_first else ("low.top", "top.bottom")
    model.tie(*sides)
    model.traction("top.top", y=10.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    for fields in frame.fields:
        np.testing.assert_allclose(fields.values["S"][..., 1], 10.0, atol=1e-9)
        np.testing.assert_allclose(fields.values["S"][..., [0, 2, 3]], 0.0, atol=1e-9)


@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
def test_tied_tubes_are_one(element: str) -> None:
    """Lame's tube of two that are tied at 70, six cells on four: within 5e-4 and 1e-9."""
    cell = "quad8" if element == "Q8R" else "quad4"
    young, nu, a, c, b = 210e3, 0.3, 50.0, 70.0, 100.0
    inside = ct.mesh.rectangle(c - a, 20.0, 8, 6, cell=cell)
    outside = ct.mesh.rectangle(b - c, 20.0, 10, 4, cell=cell)
    inside.points[:, 0] += a
    outside.points[:, 0] += c
    model = ct.Model(ct.mesh.assembly(inside=inside, outside=outside))
    model.section("all", element=element, material=ct.Elastic(young, nu), plane="axisymmetric")
    for part in ("inside", "outside"):
        model.fix(f"{part}.bottom", x=None)
        model.fix(f"{part}.top", x=None)
    model.tie("inside.right", "outside.left")
    model.pressure("inside.left", 100.0)
    u = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].U[:, 0]
    for name, r in (("inside.left", a), ("outside.right", b)):
        k = 100.0 * a**2 / (young * (b**2 - a**2)) * (1.0 + nu)
        exact = k * ((1.0 - 2.0 * nu) * r + b**2 / r)
        nodes = model.mesh.node_sets[name]
        np.testing.assert_allclose(u[nodes], exact, rtol=1e-9 if element == "Q8R" else 5e-4)


@pytest.mark.parametrize("nlgeom", [False, True])
def test_a_slot_closes_on_itself(nlgeom: bool) -> None:
    """A ring slit from outside, pressed at nu = 0: its faces carry what the whole ring would."""
    low, top = (ct.mesh.rectangle(10.0, 2.0, 10, 3) for _ in range(2))
    low.points[:, 0] += 5.0
    top.points[:] += [5.0, 2.0]
    both = ct.mesh.assembly(low=low, top=top)
    points = both.points
    seam = {tuple(points[n]): n for n in both.node_sets["low.top"] if points[n, 0] < 8.1}
    place = np.arange(both.n_nodes)
    for n in both.node_sets["top.bottom"]:
        place[n] = seam.get(tuple(points[n]), n)
    used, nodes = np.unique(place[both.cells[0].nodes], return_inverse=True)
    nodes = nodes.reshape(-1, 4)
    mesh = ct.Mesh(points[used], [ct.Cells("quad4", nodes, both.cells[0].labels)])
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(1000.0, 0.0), plane="axisymmetric")
    model.fix(np.flatnonzero(mesh.points[:, 1] == 0.0), x=None)
    surface = mesh.boundary_edges()
    model.contact(surface, surface)
    head = np.flatnonzero(mesh.points[:, 1] == 4.0)
    step = ct.Static(nlgeom=nlgeom, increments=1)
    step.fix(head, x=None, y=-0.1)
    frame = ct.solve(model, step, threads=1).frames[-1]
    assert frame.RF[head, 1].sum() == pytest.approx(-25.0 * np.pi * 200.0, rel=1e-9)
    np.testing.assert_allclose(frame.fields[0].values["S"][..., 1], -25.0, rtol=1e-9)


def seal(radius: float, plane: str = "axisymmetric") -> tuple[ct.Model, int]:
    """An O-ring, 3.53 thick, between two plates and inside a wall; the node of a plate."""
    r = 1.765
    mesh = ct.mesh.rectangle(2.0, 2.0, 10, 10)
    x, y = (mesh.points - 1.0).T
    # A square as a disc without corners (Nowell).
    mesh.points[:] = r * np.stack([x * np.sqrt(1 - y**2 / 2), y * np.sqrt(1 - x**2 / 2)], axis=1)
    mesh.points[:] += [radius, r]
    plate = ct.mesh.add_node(mesh, 0.0, 2.0 * r, "plate")
    model = ct.Model(mesh)
    rubber = ct.NeoHooke(C10=0.8, D1=0.05)
    model.section("all", element="Q4", material=rubber, plane=plane, mean_dilatation=True)
    wide = 3.0 * r
    low, high = radius - wide, radius + wide
    floor = ct.RigidCurve.line((low, 0.0), (high, 0.0))
    press = ct.RigidCurve.line((high, 2.0 * r), (low, 2.0 * r), reference=plate)
    wall = ct.RigidCurve.line((radius + r + 0.3, -1.0), (radius + r + 0.3, 2.0 * r + 1.0))
    rim = np.concatenate([model.mesh.edge_sets[s] for s in ("bottom", "right", "top", "left")])
    model.contact(rim, floor, method="node_to_segment", friction=0.01, name="floor")
    model.contact(rim, press, method="node_to_segment", friction=0.01, name="press")
    model.contact(rim, wall, method="node_to_segment", name="wall")
    return model, plate


def test_an_o_ring_of_a_large_radius_is_squeezed_as_in_plane_strain() -> None:
    """By a fifth: the same line load. With fluid: ``examples/o_ring``."""
    model, plate = seal(400.0)
    squeeze = ct.Static()
    squeeze.fix("plate", x=None, y=-0.2 * 3.53)
    line = ct.solve(model, squeeze, threads=1).frames[-1].RF[plate, 1] / (800.0 * np.pi)
    flat, plate = seal(400.0, "strain")
    flat.fix("plate", x=0.0, y=None, rotation=True)
    middle = np.flatnonzero(np.abs(flat.mesh.points[:, 0] - 400.0) < 1e-9)
    flat.fix(middle[middle != plate], x=0.0, y=None)
    force = ct.solve(flat, squeeze, threads=1).frames[-1].RF[plate, 1]
    assert line == pytest.approx(force, rel=0.01)

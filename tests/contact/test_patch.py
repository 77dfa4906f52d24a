"""The contact patch test: a uniform pressure passes between meshes that do not match."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.verification.problems import contact_patch
from tests.support.contact import CELLS, stresses

E, NU, P = contact_patch.YOUNG, contact_patch.POISSON, contact_patch.PRESSURE


def solved(low, up, angle=0.0, plane="stress", slave="up", **options):
    results = contact_patch.solved(low, up, angle, plane, slave, **options)
    return results, contact_patch.axes(angle)


@pytest.mark.parametrize("up", CELLS)
@pytest.mark.parametrize("low", CELLS)
def test_linear_patch_of_all_pairs(low, up):
    index = list(CELLS).index(low) + list(CELLS).index(up)
    angle, plane = (30.0, "strain") if index % 2 else (0.0, "stress")
    results, turn = solved(low, up, angle, plane, "low" if index % 3 else "up", nlgeom=False)
    found = stresses(results, turn)
    assert np.abs(found - [0.0, -P, 0.0]).max() < 1e-10 * P


def uniform(results, turn, rows=slice(None)):
    """Whether the stress is one number, and across the interface only."""
    found = stresses(results, turn)[rows]
    assert np.abs(found[:, [0, 2]]).max() < 1e-10 * P
    assert np.ptp(found[:, 1]) < 1e-10 * P
    assert found[0, 1] == pytest.approx(-P, rel=0.02)  # per deformed area
    return True


@pytest.mark.parametrize(
    ("low", "up"),
    [("Q4I", "Q4I"), ("Q9", "T6"), ("Q4D", "Q8R"), ("T3", "Q4D"), ("Q8", "Q4"), ("T6", "T3")],
)
@pytest.mark.parametrize(("angle", "plane"), [(0.0, "strain"), (30.0, "stress")])
def test_nonlinear_patch(low, up, angle, plane):
    results, turn = solved(low, up, angle, plane)
    assert uniform(results, turn)
    sums = results.frames[-1].scalars
    force = turn.T @ [sums["up.bottom-low.top: force x"], sums["up.bottom-low.top: force y"]]
    assert force == pytest.approx([0.0, P * 2.0 * 0.5], abs=1e-10)


@pytest.mark.parametrize("element", [e for e in CELLS if e != "OPT"])
@pytest.mark.parametrize("slave", ["up", "low"])
def test_patch_after_sliding_on_part_of_the_master(element, slave):
    """The upper block slides over a wider one that is held altogether."""
    low = ct.mesh.rectangle(4.0, 0.5, 7, 1, CELLS[element])
    up = ct.mesh.rectangle(1.0, 0.8, 3, 2, CELLS[element], origin=(0.6, 0.5))
    mesh = ct.mesh.move(ct.mesh.assembly(low=low, up=up), angle=30.0)
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=E, nu=NU),
        plane="strain",
        local_strain="green_lagrange",
    )
    model.fix("low", x=0.0, y=0.0, rotation=True)
    model.local_axes(mesh.node_sets["up.top"], angle=np.radians(30.0))
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    turn = np.array([[c, -s], [s, c]])
    model.fix([mesh.node_sets["up.top"][0]], x=1.13, y=None)
    model.fix("up.top", x=None, y=None, rotation=True)
    push = turn @ [0.0, -P]
    model.traction("up.top", x=push[0], y=push[1])
    names = ("up.bottom", "low.top")
    model.contact(*(names if slave == "up" else names[::-1]))
    results = ct.solve(model, ct.Static(increments=3), threads=1)
    blocks = results.frames[-1].fields
    inside = np.isin(np.concatenate([b.cells for b in blocks]), mesh.cell_sets["up"])
    assert uniform(results, turn, np.repeat(inside, blocks[0].values["S"].shape[1]))


@pytest.mark.parametrize("element", CELLS)
def test_patch_on_a_rigid_line(element):
    mesh = ct.mesh.rectangle(1.0, 0.8, 3, 2, CELLS[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=NU))
    model.fix([mesh.node_sets["top"][0]], x=0.0, y=None)
    model.fix("top", x=None, y=None, rotation=True)
    model.traction("top", y=-P)
    model.contact("bottom", ct.RigidCurve.line([-1.0, 0.0], [2.0, 0.0]))
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    assert np.abs(stresses(results, np.eye(2)) - [0.0, -P, 0.0]).max() < 1e-10 * P
    pressure = results.nodal("CPRESS")[mesh.nodes_of("bottom")]
    assert pressure == pytest.approx(P, rel=1e-10)


@pytest.mark.parametrize("element", ["Q8", "Q8R", "Q9", "T6"])
@pytest.mark.parametrize("law", [False, True])
def test_a_uniform_pressure_is_uniform_at_nodes_of_quadratic_edges(element, law):
    """Areas of slave nodes are the integrals of their weights: corners had half as much again."""
    cell = {"Q9": "quad9", "T6": "tri6"}.get(element, "quad8")
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2, cell=cell))
    model.section("all", element=element, material=ct.Elastic(E=1e5))
    layer = ct.PressureLaw("linear", 400.0) if law else None
    floor = ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
    model.contact("bottom", floor, law=layer, method="node_to_segment", name="floor")
    model.fix("left", x=0.0, y=None)
    model.pressure("top", 8.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    bottom = model.mesh.node_sets["bottom"]
    np.testing.assert_allclose(results.nodal("CPRESS")[bottom], 8.0, rtol=1e-9)
    if law:
        np.testing.assert_allclose(results.frames[-1].U[bottom, 1], -0.02, rtol=1e-9)


@pytest.mark.parametrize(
    ("element", "left", "stiff"),
    [
        ("Q4I", 0.0, 0.25),
        ("Q4I", 0.002, 0.25),
        ("Q8R", 0.0, 1.0 / 12.0),
        ("Q4I", 0.1, 0.0),
        ("Q4I", 0.125, 0.0),
    ],
)
@pytest.mark.parametrize("rigid", [False, True])
def test_a_note_says_the_error_of_a_law_at_the_ends_of_the_master(element, left, stiff, rigid):
    """With node_to_segment a slave node presses on its whole area, which the master covers in part.

    A layer of the stiffness k under the force F over the length 1 sinks by F / k; mortar is exact.
    """
    cell = {"Q8R": "quad8"}.get(element, "quad4")
    table = ct.mesh.rectangle(3.0, 0.2, 12, 2, cell=cell, origin=(-1.0, -0.2))
    bodies = {"table": table}
    if not rigid:
        bodies["block"] = ct.mesh.rectangle(1.0, 0.1, 5, 1, cell=cell, origin=(left, 0.0))
    mesh = ct.mesh.assembly(**bodies)
    if rigid:
        node = ct.mesh.add_node(mesh, left + 0.5, 0.0, "punch")
    model = ct.Model(mesh)
    for body in bodies:
        model.section(body, element=element, material=ct.Elastic(E=1e7))
    model.fix("table.bottom")
    if rigid:
        master = ct.RigidCurve.line((left + 1.0, 0.0), (left, 0.0), reference=node)
        model.fix("punch", x=0.0, y=None, rotation=0.0)
        model.force("punch", y=-12.0)
    else:
        master = "block.bottom"
        model.fix("block.left", x=0.0, y=None)
        model.force("block.top", y=-12.0)
    layer = ct.PressureLaw("linear", 1e3)
    for method in ("node_to_segment", "mortar"):
        model.contacts.clear()
        model.contact("table.top", master, law=layer, method=method, name="layer")
        results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
        notes = [note for note in results.notes if "within slave edges" in note]
        sunk = -results.history("U2", at="punch" if rigid else "block.top", combine="mean")[-1]
        wrong = 0.012 / sunk - 1.0
        if method == "mortar" or stiff == 0.0:
            assert not notes
            assert abs(wrong) < 0.01
        else:
            assert len(notes) == 1
            assert f"{stiff:.0%} too stiff" in notes[0]
            assert wrong == pytest.approx(stiff, abs=0.01)

"""Self-contact of a closed slit: where it sticks or nothing pulls sideways, it is not there."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells, Mesh
from corota.model.contact import METHODS

#: Modulus, height of the block and its compression.
YOUNG, HEIGHT, SHORTER = 1e4, 2.0, 0.01


def slit_block(cell: str, first: float, last: float, roll: int) -> Mesh:
    """A block, 4 by 2, with a slit at half its height; `roll` edges begin its contour."""
    block = ct.mesh.rectangle(4.0, HEIGHT, 8, 4, cell)
    points, cells = block.points, block.cells[0].nodes.copy()
    middle = np.isclose(points[:, 1], 0.5 * HEIGHT)
    # A slit that begins at the side is open there; elsewhere its ends are single nodes.
    inside = (points[:, 0] > first + 1e-9) | ((first == 0.0) & (points[:, 0] < 1e-9))
    double = np.flatnonzero(middle & inside & (points[:, 0] < last - 1e-9))
    twin = np.arange(len(points))
    twin[double] = len(points) + np.arange(len(double))
    upper = points[cells].mean(axis=1)[:, 1] > 0.5 * HEIGHT
    cells[upper] = twin[cells[upper]]
    points = np.vstack([points, points[double]])
    labels = np.arange(1, len(cells) + 1), np.arange(1, len(points) + 1)
    mesh = Mesh(points, [Cells(cell, cells, labels[0])], labels[1])
    edges = mesh.boundary_edges()
    at = np.array([points[list(nodes)].mean(axis=0) for nodes in mesh.edge_nodes(edges)])
    slit = edges[np.isclose(at[:, 1], 0.5 * HEIGHT) & (at[:, 0] > first) & (at[:, 0] < last)]
    mesh.edge_sets["slit"] = np.roll(slit, -roll, axis=0)
    for name, y in (("bottom", 0.0), ("top", HEIGHT)):
        mesh.node_sets[name] = np.flatnonzero(np.isclose(points[:, 1], y))
    return mesh


def squeezed(
    method: str, element: str, slit: tuple[float, float, int], friction: float, sideways: float
) -> ct.Results:
    """The block squeezed, and then drawn sideways."""
    mesh = slit_block("quad8" if element == "Q8R" else "quad4", *slit)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=0.0))
    model.fix("bottom", x=0.0, y=0.0)
    model.contact("slit", "slit", method=method, friction=friction)
    press, draw = ct.Static(), ct.Static()
    press.fix("top", x=0.0, y=-SHORTER)
    draw.fix("top", x=sideways, y=-SHORTER)
    return ct.solve(model, [press, draw] if sideways else press, threads=1)


SLITS = {"inside": (1.0, 3.0, 0), "inside, from its middle": (1.0, 3.0, 3), "open": (0.0, 3.0, 2)}


@pytest.mark.parametrize("slit", list(SLITS))
@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
@pytest.mark.parametrize("method", METHODS)
def test_a_closed_slit_carries_pressure_as_if_it_were_not_there(
    method: str, element: str, slit: str
) -> None:
    """At every node once: also beside the tips, and where the contour begins."""
    results = squeezed(method, element, SLITS[slit], 0.0, 0.0)
    stress = np.concatenate([b.values["S"][..., 1].ravel() for b in results.frames[-1].fields])
    np.testing.assert_allclose(stress, -YOUNG * SHORTER / HEIGHT, rtol=2e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_closed_slit_that_sticks_carries_shear_as_if_it_were_not_there(method: str) -> None:
    results = squeezed(method, "Q4I", SLITS["inside, from its middle"], 0.5, 2e-3)
    whole = ct.Model(ct.mesh.rectangle(4.0, HEIGHT, 8, 4))
    whole.section("all", element="Q4I", material=ct.Elastic(E=YOUNG, nu=0.0))
    whole.fix("bottom", x=0.0, y=0.0)
    whole.fix("top", x=2e-3, y=-SHORTER)
    exact = ct.solve(whole, ct.Static(), threads=1).frames[-1]
    force = results.frames[-1].RF[results.model.mesh.nodes_of("top")].sum(axis=0)
    expected = exact.RF[whole.mesh.nodes_of("top")].sum(axis=0)
    np.testing.assert_allclose(force[:2], expected[:2], rtol=1e-4)


CELLS = {"T3": "tri3", "T6": "tri6", "Q8R": "quad8"}


@pytest.mark.filterwarnings("ignore:local strain reaches")
@pytest.mark.parametrize("nlgeom", [True, False])
@pytest.mark.parametrize("sideways", [0.0, 0.3, -0.3])
@pytest.mark.parametrize("cells", [(1, 1), (2, 2), (3, 3), (4, 2), (6, 3), (5, 10)])
@pytest.mark.parametrize("element", ["T3", "Q4I", "Q4D", "T6", "Q8R"])
def test_nodes_beside_a_corner_are_not_in_its_other_face(
    element: str, cells: tuple[int, int], sideways: float, nlgeom: bool
) -> None:
    """The outline of a block has no force, pressed or pressed and sheared.

    A node of the top lies behind the left side, less deep than half of the block's height: a block
    pressed with 476 for 0 there, or its run stopped. A node halfway up its side is as far from the
    ends of an edge above as of one below, which are no vertex for it.
    """
    mesh = ct.mesh.rectangle(2.0, 1.0, *cells, CELLS.get(element, "quad4"))  # type: ignore[arg-type]
    names = ("bottom", "right", "top", "left")
    mesh.edge_sets["outline"] = np.concatenate([mesh.edge_sets[name] for name in names])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=0.3))
    model.contact("outline", "outline", method="node_to_segment")
    model.fix("left")
    step = ct.Static(nlgeom=nlgeom)
    step.fix("right", x=-0.05, y=sideways or None)
    frame = ct.solve(model, step, threads=1).frames[-1]
    assert not frame.C[:, 0].any()


def legs(element: str, nlgeom: bool, outlines: bool) -> float:
    """Force between two cantilevers pressed together, by their facing sides or their outlines."""
    length, apart, force = 20.0, 0.1, 3e-3
    cell = CELLS.get(element, "quad4")
    lower = ct.mesh.rectangle(length, 1.0, 40, 2, cell)  # type: ignore[arg-type]
    upper = ct.mesh.rectangle(length, 1.0, 43, 2, cell, origin=(0.0, 1.0 + apart))  # type: ignore[arg-type]
    mesh = ct.mesh.assembly(a=lower, b=upper)
    names = [f"{leg}.{side}" for leg in "ab" for side in ("bottom", "right", "top")]
    mesh.edge_sets["sides"] = np.concatenate([mesh.edge_sets[name] for name in names])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.0))
    slave, master = ("sides", "sides") if outlines else ("b.bottom", "a.top")
    model.contact(slave, master, method="node_to_segment")
    model.fix("a.left")
    model.fix("b.left")
    step = ct.Static(nlgeom=nlgeom)
    step.force("a.right", y=force)
    step.force("b.right", y=-force)
    frame = ct.solve(model, step, threads=1).frames[-1]
    return force + float(frame.RF[mesh.node_sets["a.left"], 1].sum())


@pytest.mark.parametrize("nlgeom", [True, False])
@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T6"])
def test_outlines_of_two_legs_press_as_their_facing_sides_do(element: str, nlgeom: bool) -> None:
    force = legs(element, nlgeom, outlines=False)
    assert force > 1e-3
    assert legs(element, nlgeom, outlines=True) == pytest.approx(force, rel=1e-6)

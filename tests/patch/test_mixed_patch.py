"""Patches of several elements in one mesh, triangles beside quadrilaterals.

On an edge between a drilling element and another one the rotations bend the edge as far as both
can: not at all beside elements without rotations, and beside OPT as Q4D does.
"""

# SPDX-License-Identifier: BSD-3-Clause
import itertools

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from corota.model.steps import Static
from support.models import DRILLING, boundary, cell, prescribe

PAIRS = [("Q4", "T3"), ("Q4I", "T3"), ("Q8", "T6"), ("Q9", "T6"), ("Q8R", "T6"), ("Q4I", "Q4")]
PAIRS += [p for p in itertools.combinations(["Q4D", "Q4DI", "OPT", "Q4I", "Q4R", "T3"], 2)]
#: Relative errors of displacements and stresses: rounding.
DISPLACEMENT, STRESS = 1e-12, 1e-11
H = np.array([[1e-3, 4e-4], [-7e-4, -5e-4]])


def shuffled(elements, n=4, seed=3):
    """A distorted mesh n x n whose cells have the elements in any order, and each one's cells."""
    rng = np.random.default_rng(seed)
    base = ct.mesh.distort(ct.mesh.rectangle(3.0, 2.0, n, n), 0.2, seed=seed)
    quads = base.cells[0].nodes
    which = rng.integers(len(elements), size=len(quads))
    which[: len(elements)] = np.arange(len(elements))
    blocks, where, first = [], {}, 0
    for k, element in enumerate(elements):
        nodes = quads[which == k]
        if cell(element) == "tri3":
            nodes = np.concatenate([nodes[:, [0, 1, 2]], nodes[:, [0, 2, 3]]])
        blocks.append(Cells(cell(element), nodes, np.arange(first + 1, first + 1 + len(nodes))))
        where[element] = np.arange(first, first + len(nodes))
        first += len(nodes)
    return Mesh(base.points, blocks), where


def nodes_of(mesh, cells):
    """Nodes of some cells."""
    blocks = zip(mesh.offsets, mesh.cells, strict=False)
    rows = [b.nodes[np.isin(np.arange(len(b)) + o, cells)].ravel() for o, b in blocks]
    return np.unique(np.concatenate(rows))


def with_rotations(mesh, where):
    """Nodes of drilling elements."""
    return nodes_of(mesh, np.concatenate([[-1], *(c for e, c in where.items() if e in DRILLING)]))


def stresses(results):
    return np.concatenate([f.values["S"].reshape(-1, 4) for f in results.frames[-1].fields])


@pytest.mark.parametrize(("left", "right"), PAIRS)
def test_constant_strain_across_two_elements(left, right):
    one = ct.mesh.rectangle(1.5, 2.0, 2, 3, cell(left))
    two = ct.mesh.rectangle(1.5, 2.0, 2, 3, cell(right), "alternate", origin=(1.5, 0.0))
    one.cell_sets, two.cell_sets = (
        {"one": np.arange(one.n_cells)},
        {"two": np.arange(two.n_cells)},
    )
    mesh = ct.mesh.distort(ct.mesh.merge(one, two), 0.25, seed=2)
    model = ct.Model(mesh)
    drilled = []
    for name, element in (("one", left), ("two", right)):
        model.section(name, element=element, material=ct.Elastic(E=7.0, nu=0.3))
        if element in DRILLING:
            drilled.append(nodes_of(mesh, mesh.cell_sets[name]))
    check(model, np.unique(np.concatenate([np.zeros(0, int), *drilled])))


@pytest.mark.parametrize(
    "elements",
    [("Q4D", "Q4"), ("OPT", "T3"), ("Q4D", "OPT"), ("Q4D", "Q4DI", "OPT", "Q4I", "Q4S", "T3")],
)
@pytest.mark.parametrize("seed", [1, 2])
def test_constant_strain_in_a_mesh_of_elements_in_any_order(elements, seed):
    mesh, where = shuffled(elements, seed=seed)
    model = ct.Model(mesh)
    for element, cells in where.items():
        model.section(cells, element=element, material=ct.Elastic(E=7.0, nu=0.3))
    check(model, with_rotations(mesh, where))


def check(model, drilled):
    """Prescribe a linear field on the boundary: all of the body has it."""
    mesh = model.mesh
    u, skew = mesh.points @ H.T, 0.5 * (H[1, 0] - H[0, 1])
    edge = boundary(mesh)
    prescribe(model, np.setdiff1d(edge, drilled), u[np.setdiff1d(edge, drilled)])
    if len(drilled):
        both = np.intersect1d(edge, drilled)
        prescribe(model, both, u[both], np.array(skew))
    results = ct.solve(model, Static(nlgeom=False), threads=1)
    frame = results.frames[-1]
    assert np.abs(frame.U - u).max() <= DISPLACEMENT * np.abs(u).max()
    assert np.abs(frame.UR[drilled] - skew).max(initial=0.0) <= DISPLACEMENT * np.abs(u).max()
    stress = stresses(results)
    assert np.ptp(stress, axis=0).max() <= STRESS * np.abs(stress).max()


@pytest.mark.parametrize(("left", "right"), [("Q4D", "Q4I"), ("OPT", "T3"), ("Q4DI", "OPT")])
def test_a_pulled_strip_of_two_elements_has_the_stress_of_statics(left, right):
    """Pulled along a line that is turned by 50 degrees, with a free common edge: S = 1 along it."""
    turn = np.radians(50.0)
    c, s = np.cos(turn), np.sin(turn)
    quads = ct.mesh.rectangle(2.0, 1.0, 8, 4)
    nodes = quads.cells[0].nodes
    here = quads.points[nodes].mean(axis=1)[:, 0] < 1.0
    blocks, first = [], 0
    for element, part in ((left, nodes[here]), (right, nodes[~here])):
        if cell(element) == "tri3":
            part = np.concatenate([part[:, [0, 1, 2]], part[:, [0, 2, 3]]])
        blocks.append(Cells(cell(element), part, np.arange(first + 1, first + 1 + len(part))))
        first += len(part)
    mesh = Mesh(quads.points, blocks, node_sets=quads.node_sets)
    mesh.points[:] = mesh.points @ np.array([[c, s], [-s, c]])
    model = ct.Model(mesh)
    for k, element in enumerate((left, right)):
        cells = np.arange(len(blocks[0].nodes)) + k * len(blocks[0].nodes)
        cells = cells if k == 0 else np.arange(len(blocks[0].nodes), first)
        model.section(cells, element=element, material=ct.Elastic(E=1e3, nu=0.3))
    ends = np.concatenate([mesh.node_sets["left"], mesh.node_sets["right"]])
    # The state itself, with free rotations inside: u = e/E along, -nu e/E across.
    along, across = np.array([c, s]), np.array([-s, c])
    u = np.outer(mesh.points @ along, along) - 0.3 * np.outer(mesh.points @ across, across)
    for name in ("left", "right"):
        element = left if name == "left" else right
        nodes = mesh.node_sets[name]
        prescribe(model, nodes, 1e-3 * u[nodes], np.array(0.0) if element in DRILLING else None)
    results = ct.solve(model, Static(nlgeom=False), threads=1)
    wanted = [c * c, s * s, 0.0, c * s]
    assert np.abs(stresses(results) - wanted).max() <= 1e-10
    inside = np.setdiff1d(np.arange(mesh.n_nodes), ends)
    assert np.abs(results.frames[-1].UR[inside]).max() <= 1e-13


def test_a_mixed_body_spins_freely():
    """Momenta and energy of a tumbling body whose edges bend as far as both sides can."""
    mesh, where = shuffled(("Q4D", "OPT", "Q4I"), n=3, seed=5)
    model = ct.Model(mesh)
    for element, cells in where.items():
        model.section(cells, element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.velocity(x=0.4, y=-0.2, spin=2.0, about=(1.0, 1.0))
    step = ct.Dynamic(period=2.0, increments=20, scheme="energy_momentum")
    frames = ct.solve(model, step, threads=1, fields=False).frames
    for name in ("momentum x", "momentum y", "angular momentum"):
        values = np.array([f.scalars[name] for f in frames])
        assert np.ptp(values) <= 1e-9 * np.abs(values).max()
    assert max(abs(f.scalars["energy balance error"]) for f in frames) <= 1e-8

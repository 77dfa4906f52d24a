"""Contact across the border of a cell: beside several cells, energy, and closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.pairs import cover

#: Macroscopic compression that closes the slit, with shear.
GRADIENT = np.array([[-0.025, 0.012], [0.004, 0.002]])
METHODS = ["mortar", "node_to_segment"]


def slit(mesh: ct.Mesh, low: float, gap: float, inset: float = 0.0) -> ct.Mesh:
    """Open a lens on the right side of the unit square, from ``low`` to ``1 - low``.

    Its surface there ends before that on the left, at the distance `inset` from the tips.
    """
    along = np.clip((mesh.points[:, 1] - low) / (1.0 - 2.0 * low), 0.0, 1.0)
    bulge = 4.0 * along * (1.0 - along)
    left, right = np.abs(mesh.points[:, 0]) < 1e-9, np.abs(mesh.points[:, 0] - 1.0) < 1e-9
    mesh.points[right, 0] -= gap * bulge[right]
    mesh.points[left, 1] += 0.01 * bulge[left]  # no node opposite to another
    sides: dict[str, list[np.ndarray]] = {"slit left": [], "slit right": []}
    edges = mesh.boundary_edges()
    for edge, nodes in zip(edges, mesh.edge_nodes(edges), strict=True):
        x, y = mesh.points[np.array(nodes)].T
        half = 0.5 - low - np.abs(y - 0.5).max()  # to the end of the slit
        if half > 1e-9 and (np.abs(x) < 1e-9).all():
            sides["slit left"].append(edge)
        if half > inset + 1e-9 and (x > 1.0 - 2.0 * gap).all():
            sides["slit right"].append(edge)
    mesh.edge_sets |= {name: np.array(found) for name, found in sides.items()}
    return mesh


def slotted(method: str, friction: float = 0.0, element: str = "Q4I", **pair) -> ct.Model:
    """Square with a slit along its left and right sides."""
    mesh = slit(ct.mesh.rectangle(1.0, 1.0, nx=3, ny=12), 1.0 / 6.0, 0.006, 0.1)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=0.3))
    model.contact("slit right", "slit left", method=method, friction=friction, reach=0.3, **pair)
    return model


def without_middle(full: ct.Mesh) -> ct.Mesh:
    """Leave the outermost ring of the quadrilaterals of a square."""
    cells = full.cells[0].nodes
    ring = np.abs(full.points[cells].mean(axis=1) - 0.5).max(axis=1) > 0.4
    used, nodes = np.unique(cells[ring], return_inverse=True)
    number = np.cumsum(ring) - 1
    left = ct.mesh.Cells("quad4", nodes.reshape(-1, 4), 1 + np.arange(ring.sum()))
    sets = {
        name: np.column_stack([number[edges[:, 0]], edges[:, 1]])
        for name, edges in full.edge_sets.items()
    }
    return ct.mesh.Mesh(full.points[used], [left], edge_sets=sets)


def cell_of(model: ct.Model) -> ct.PeriodicCell:
    return ct.PeriodicCell(model, np.eye(2))


def pressed(cell: ct.PeriodicCell, gradient: np.ndarray = GRADIENT, increments: int = 2):
    cell.drive(gradient.tolist())
    return ct.solve(cell.model, ct.Static(increments=increments), threads=1)


@pytest.mark.parametrize(("method", "friction"), cover(METHODS, [0.0, 0.1, 0.8], strength=1))
def test_one_cell_is_as_stiff_as_four(method: str, friction: float) -> None:
    """Contact within a block of cells, and across the border of one: open, slipping, sticking."""
    cell = cell_of(slotted(method, friction))
    four = cell.repeat(2, 2)
    one, several = pressed(cell), pressed(four)
    np.testing.assert_allclose(four.stress(several), cell.stress(one), rtol=1e-8)
    force = "slit right-slit left: force x"
    assert one.frames[-1].scalars[force] < -0.005
    assert several.frames[-1].scalars[force] == pytest.approx(4.0 * one.frames[-1].scalars[force])
    np.testing.assert_allclose(four.tangent(several), cell.tangent(one), rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize(("method", "element"), [(METHODS[0], "Q4I"), (METHODS[1], "Q4D")])
def test_mean_stress_is_the_derivative_of_the_energy(method: str, element: str) -> None:
    """With elements without and with drilling rotations; and the tangent that of the stress."""
    cell = cell_of(slotted(method, element=element))
    results = pressed(cell)
    stress, tangent, step = cell.stress(results), cell.tangent(results), 1e-4
    for i in range(2):
        for j in range(2):
            more = np.zeros((2, 2))
            more[i, j] = step
            ends = [pressed(cell, GRADIENT + sign * more) for sign in (1.0, -1.0)]
            energy = [end.frames[-1].scalars["strain energy"] for end in ends]
            slope = (energy[0] - energy[1]) / (2.0 * step)
            assert slope == pytest.approx(stress[i, j], rel=1e-6)
            rates = (cell.stress(ends[0]) - cell.stress(ends[1])) / (2.0 * step)
            np.testing.assert_allclose(tangent[:, :, i, j], rates, atol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_tangent_of_surfaces_that_stick(method: str) -> None:
    """It is that of a small further step."""
    cell = cell_of(slotted(method, 0.8))
    results = pressed(cell)
    size = 1e-6
    tangent, more = cell.tangent(results), size * np.array([[0.3, -0.7], [1.0, 0.4]])
    first, last = ct.Static(increments=2), ct.Static(increments=1)
    cell.model.supports = [s for s in cell.model.supports if not cell.drives(s)]
    cell.drive(GRADIENT.tolist(), step=first)
    cell.drive((GRADIENT + more).tolist(), step=last)
    again = ct.solve(cell.model, [first, last], threads=1)
    change = cell.stress(again) - cell.stress(results)
    np.testing.assert_allclose(change, np.einsum("ijkl,kl", tangent, more), atol=2e-5 * size)


def test_a_surface_that_meets_its_own_image() -> None:
    """One surface of both sides: the pair of the two, the later one as slave."""
    model = slotted("node_to_segment", 0.1)
    expected = cell_of(model)
    model.contacts.clear()
    sets = model.mesh.edge_sets
    sets["slit"] = np.concatenate([sets["slit right"], sets["slit left"]])
    model.contact("slit", "slit", method="node_to_segment", friction=0.1, reach=0.3)
    cell = cell_of(model)
    found = cell.stress(pressed(cell))
    np.testing.assert_allclose(found, expected.stress(pressed(expected)), rtol=1e-8)


def holed(method: str, friction: float) -> ct.PeriodicCell:
    """Square holes in rubber, whose walls along y are slit in two."""
    full = slit(ct.mesh.rectangle(1.0, 1.0, nx=10, ny=10), 0.1, 2e-4)
    mesh = without_middle(full)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.NeoHooke(C10=0.5, D1=0.1), plane="strain")
    model.contact("slit right", "slit left", method=method, friction=friction, reach=0.2)
    return cell_of(model)


#: Compression past the onset of a pattern.
PATTERNED = np.diag([-0.024, -0.024])


@pytest.mark.filterwarnings("ignore:increment")  # the runs go past the onset
def test_four_cells_have_the_unstable_waves_of_one() -> None:
    cell = holed("node_to_segment", 0.5)
    four = cell.repeat(2, 2)
    one, several = pressed(cell, PATTERNED, 4), pressed(four, PATTERNED, 4)
    waves = 0.5 * np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
    counts = []
    for frame in (1, 4):
        found = cell.waves(one, frame)
        counts.append(four.waves(several, frame).negative((0.0, 0.0)))
        assert counts[-1] == sum(found.negative(k) for k in waves)
    assert counts[0] == 0 < counts[1]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:increment")  # the runs go past the onset
@pytest.mark.parametrize(("method", "friction"), [(METHODS[0], 0.0), (METHODS[1], 0.5)])
def test_onset_of_one_cell_is_that_of_four(method: str, friction: float) -> None:
    cell = holed(method, friction)
    four = cell.repeat(2, 2)
    found = cell.onset(pressed(cell, PATTERNED, 4), [(0.0, 0.5), (0.5, 0.5)])
    assert found.time < 0.98
    np.testing.assert_array_equal(found.wave, [0.0, 0.5])
    again = four.onset(pressed(four, PATTERNED, 4), [(0.0, 0.0)])
    assert again.time == pytest.approx(found.time, rel=1e-8)
    np.testing.assert_allclose(again.gradient, found.gradient, rtol=1e-8, atol=1e-12)

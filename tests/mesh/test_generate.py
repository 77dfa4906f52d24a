"""Generated and changed meshes: areas, sets, orientation."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from corota import mesh
from corota.errors import InputError
from corota.mesh.kinds import KINDS as KINDS_OF_CELLS
from corota.mesh.quality import classify, jacobians

KINDS = ("tri3", "tri6", "quad4", "quad8", "quad9")


def area(found: mesh.Mesh) -> float:
    """Area by the corners (exact for straight sides)."""
    total = 0.0
    for cells in found.cells:
        count = 3 if cells.kind.startswith("tri") else 4
        x, y = found.points[cells.nodes[:, :count]].transpose(2, 0, 1)
        total += 0.5 * float((x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum())
    return total


def check(found: mesh.Mesh) -> None:
    """Every cell is good, every edge set consists of boundary edges with their nodes."""
    for cells in found.cells:
        assert (classify(cells.kind, found.points[cells.nodes]) == 0).all()
        assert (jacobians(cells.kind, found.points[cells.nodes]) > 0.0).all()
    boundary = {tuple(edge) for edge in found.boundary_edges().tolist()}
    for name, edges in found.edge_sets.items():
        assert {tuple(edge) for edge in edges.tolist()} <= boundary
        nodes = np.unique(np.concatenate(found.edge_nodes(edges)))
        assert nodes.tolist() == sorted(found.node_sets[name].tolist())
    used = np.unique(np.concatenate([c.nodes.ravel() for c in found.cells]))
    assert used.tolist() == list(range(found.n_nodes))


@pytest.mark.parametrize("diagonal", ["right", "left", "alternate"])
@pytest.mark.parametrize("kind", KINDS)
def test_rectangle_has_its_area_sides_and_sets(kind: str, diagonal: str) -> None:
    found = mesh.rectangle(3.0, 2.0, 3, 4, kind, diagonal, origin=(1.0, -1.0))
    check(found)
    assert area(found) == pytest.approx(6.0)
    assert [c.kind for c in found.cells] == [kind]
    assert np.allclose(found.points[found.node_sets["left"], 0], 1.0)
    assert np.allclose(found.points[found.node_sets["right"], 0], 4.0)
    assert np.allclose(found.points[found.node_sets["bottom"], 1], -1.0)
    assert np.allclose(found.points[found.node_sets["top"], 1], 1.0)
    assert len(found.boundary_edges()) == 14
    assert len(found.cell_sets["all"]) == found.n_cells


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("angle", [90.0, 360.0])
def test_annulus_follows_the_circles(kind: str, angle: float) -> None:
    found = mesh.annulus(1.0, 2.0, 2, 12, angle, kind, start=30.0, center=(1.0, 2.0))
    check(found)
    for name, radius in (("inner", 1.0), ("outer", 2.0)):
        from_center = found.points[found.node_sets[name]] - [1.0, 2.0]
        assert np.allclose(np.linalg.norm(from_center, axis=1), radius)
    sides = {"inner", "outer"} | ({"start", "end"} if angle < 360.0 else set())
    assert set(found.edge_sets) == sides
    # Area of the polygon ring with 12 sides on the arc.
    step = math.radians(angle / 12)
    assert area(found) == pytest.approx(12 * 0.5 * math.sin(step) * (4 - 1))


def test_mapped_follows_curved_sides() -> None:
    found = mesh.mapped(
        [
            lambda t: (t, -0.2 * math.sin(math.pi * t)),
            lambda t: (1.0, t),
            lambda t: (t, 1.0),
            lambda t: (0.0, t),
        ],
        6,
        4,
        "quad9",
    )
    check(found)
    x, y = found.points[found.node_sets["bottom"]].T
    assert np.allclose(y, -0.2 * np.sin(np.pi * x))


@pytest.mark.parametrize("kind", KINDS)
def test_distortion_keeps_boundary_and_area(kind: str) -> None:
    plain = mesh.rectangle(2.0, 1.0, 6, 4, kind)
    found = mesh.distort(plain, 0.3, seed=5)
    check(found)
    assert area(found) == pytest.approx(2.0)
    assert not np.allclose(found.points, plain.points)
    edge = np.unique(np.concatenate(plain.edge_nodes(plain.boundary_edges())))
    assert np.array_equal(found.points[edge], plain.points[edge])


@pytest.mark.parametrize(("kind", "center"), [("tri3", False), ("quad4", False), ("quad4", True)])
def test_quadratic_mesh_equals_the_generated_one(kind: str, center: bool) -> None:
    found = mesh.to_quadratic(mesh.rectangle(2.0, 1.0, 4, 2, kind), center=center)
    wanted = {"tri3": "tri6", "quad4": "quad9" if center else "quad8"}[kind]
    direct = mesh.rectangle(2.0, 1.0, 4, 2, wanted)
    check(found)
    assert found.n_nodes == direct.n_nodes
    for name, nodes in direct.node_sets.items():
        mine = found.points[found.node_sets[name]]
        assert sorted(map(tuple, mine.tolist())) == sorted(
            map(tuple, direct.points[nodes].tolist())
        )


@pytest.mark.parametrize("kind", ["quad4", "quad9"])
@pytest.mark.parametrize("diagonal", ["right", "left"])
def test_triangles_keep_area_and_sets(kind: str, diagonal: str) -> None:
    found = mesh.to_triangles(mesh.rectangle(2.0, 1.0, 4, 2, kind), diagonal)
    check(found)
    assert area(found) == pytest.approx(2.0)
    assert found.n_cells == 16
    assert len(found.cell_sets["all"]) == 16


def test_merged_parts_share_their_nodes() -> None:
    a = mesh.rectangle(1.0, 1.0, 2, 2)
    b = mesh.rectangle(1.0, 1.0, 2, 2, "tri3", origin=(1.0, 0.0))
    found = mesh.merge(a, b)
    assert found.n_nodes == 15
    assert area(found) == pytest.approx(2.0)
    assert len(found.boundary_edges()) == 12
    assert sorted(found.points[found.node_sets["bottom"], 0].tolist()) == [0, 0.5, 1, 1.5, 2]
    assert found.cell_labels.tolist() == list(range(1, 13))
    x = found.points[np.concatenate(found.edge_nodes(found.edge_sets["right"])), 0]
    assert set(x.tolist()) == {2.0}


def test_shuffled_numbers_leave_the_shape() -> None:
    plain = mesh.rectangle(2.0, 1.0, 4, 2, "quad8")
    found = mesh.renumber(plain, seed=2)
    check(found)
    assert not np.array_equal(found.points, plain.points)
    for name, nodes in plain.node_sets.items():
        assert np.array_equal(found.points[found.node_sets[name]], plain.points[nodes])


def test_move_scales_turns_and_shifts() -> None:
    found = mesh.move(mesh.rectangle(2.0, 1.0, 2, 1), shift=(1.0, 0.0), angle=90.0, scale=2.0)
    assert np.allclose(found.points.min(axis=0), [-1.0, 0.0])
    assert np.allclose(found.points.max(axis=0), [1.0, 4.0])
    assert area(found) == pytest.approx(8.0)


def test_a_line_is_a_chain_of_its_sides() -> None:
    hook = mesh.line([(0, 0), (0, 10), (5, 10)], n=[8, 4])
    ends = hook.points[hook.cells[0].nodes]
    assert np.abs(ends[:, 1] - ends[:, 0]).sum() == pytest.approx(15.0)
    assert hook.points[hook.nodes_of("corner_1")].tolist() == [[0.0, 10.0]]
    assert hook.points[hook.nodes_of("end")].tolist() == [[5.0, 10.0]]
    closed = mesh.line([(0, 0), (4, 0), (4, 3), (0, 0)], n=2, name="loop")
    assert (closed.n_nodes, closed.n_cells) == (6, 6)
    assert list(closed.node_sets) == ["loop.corner_1", "loop.corner_2"]
    assert list(closed.cell_sets) == ["loop"]
    assert np.bincount(closed.cells[0].nodes.ravel()).tolist() == [2] * 6


@pytest.mark.parametrize(
    ("points", "n", "text"),
    [
        ([(0.0, 0.0)], 1, "two or more points"),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)], 1, "points 1 and 2 of the line are the same"),
        ([(0.0, 0.0), (np.nan, 0.0)], 1, "finite"),
        ([(0.0, 0.0), (1.0, 0.0)], [2, 3], "needs one or 1 counts"),
        ([(0.0, 0.0), (1.0, 0.0)], 0, "needs one or 1 counts"),
    ],
)
def test_what_is_no_line_is_refused(points: list[tuple[float, float]], n: int, text: str) -> None:
    with pytest.raises(InputError, match=text):
        mesh.line(points, n)


def test_nodes_of_a_set_of_any_sort() -> None:
    found = mesh.rectangle(2.0, 1.0, 2, 1)
    assert found.nodes_of("all").tolist() == [0, 1, 2, 3, 4, 5]
    del found.node_sets["left"]
    assert found.nodes_of("left").tolist() == [0, 3]
    with pytest.raises(InputError, match="no set named 'lef'"):
        found.nodes_of("lef")


def test_edges_are_found_by_their_ends() -> None:
    found = mesh.rectangle(2.0, 1.0, 2, 1)
    pairs = [edge[:2] for edge in found.edge_nodes(found.edge_sets["top"])]
    assert found.edges_between(pairs).tolist() == found.edge_sets["top"].tolist()
    assert found.edges_between([(0, 5)]).tolist() == [[-1, -1]]
    assert all(a != b for a, b in pairwise(map(tuple, pairs)))


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: mesh.rectangle(0.0, 1.0, 1, 1), "sides"),
        (lambda: mesh.rectangle(1.0, 1.0, 0, 1), "at least one cell"),
        (lambda: mesh.rectangle(1.0, 1.0, 1, 1, "quad5"), "unknown cell"),
        (lambda: mesh.annulus(2.0, 1.0, 1, 8), "inner < outer"),
        (lambda: mesh.mapped([(0, 0)], 1, 1), "four corners"),
        (lambda: mesh.distort(mesh.rectangle(1, 1, 1, 1), 0.7), "distortion"),
        (lambda: mesh.to_triangles(mesh.rectangle(1, 1, 1, 1, "quad8")), "quad9"),
        (lambda: mesh.to_quadratic(mesh.rectangle(1, 1, 1, 1, "tri6")), "tri6"),
        (lambda: mesh.merge(), "no mesh"),
    ],
)
def test_wrong_arguments_are_named(call, text: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match=text):
        call()


@pytest.mark.parametrize("kind", [k for k in KINDS_OF_CELLS if k.startswith("quad")])
def test_nodes_are_at_the_natural_coordinates_of_their_kind(kind):
    cells = mesh.rectangle(2.0, 4.0, 1, 2, kind)
    first = cells.points[cells.cells[0].nodes[0]]
    assert first == pytest.approx(np.array(KINDS_OF_CELLS[kind].natural) + 1.0, abs=1e-15)

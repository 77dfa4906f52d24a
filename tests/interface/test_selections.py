"""What a user selects is what is meant, or it is refused."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


@pytest.fixture
def model() -> ct.Model:
    made = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    made.section(element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
    return made


def test_a_mask_is_a_mask(model: ct.Model) -> None:
    mask = model.mesh.points[:, 0] == 10.0
    model.fix(mask)
    assert model.supports[0].nodes.tolist() == [4, 9]  # type: ignore[union-attr]
    model.gravity(y=-1.0, cells=np.array([False, True, False, False]))
    assert model.loads[0].cells.tolist() == [1]  # type: ignore[union-attr]
    results = ct.solve(_loaded(model), ct.Static(), threads=1)
    history = results.history("U2", at=mask)
    np.testing.assert_array_equal(history.values, results.history("U2", at=[4, 9]).values)
    assert history.name == "U2 at 2 nodes"


def _loaded(model: ct.Model) -> ct.Model:
    model.loads.clear()
    return model


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ([2.9], "not by float"),
        (np.array([1.0, 2.0]), "not by float"),
        ([], "no nodes are given"),
        (np.zeros(10, bool), "no nodes are given"),
        (np.ones(3, bool), r"shape \(10,\)"),
        ([-1], "negative"),
        ([10], "no node with index 10; there are 10"),
        ([[0, 1], [1, 1]], "looks like edges"),
        ([[0], [1, 2]], "unequal shape|selected by"),
        (["left", 3], "not by str"),
        (None, "not by NoneType"),
    ],
)
def test_what_is_no_selection_of_nodes_is_refused(
    model: ct.Model, nodes: object, words: str
) -> None:
    for give in (
        model.fix,
        lambda where: model.force(where, y=1.0),
        lambda where: model.point_mass(where, 1.0),
        lambda where: model.velocity(where, x=1.0),
    ):
        with pytest.raises(ct.InputError, match=words):
            give(nodes)  # type: ignore[arg-type]

    def by_step() -> None:
        step = ct.Static()
        step.fix(nodes)  # type: ignore[arg-type]
        ct.solve(model, step, threads=1)

    with pytest.raises(ct.InputError, match=words):  # at once, or where there is a mesh
        by_step()


def test_negative_and_missing_cells_and_edges_are_refused(model: ct.Model) -> None:
    for cells in ([-1], [4], [0.5], []):
        with pytest.raises(ct.InputError):
            model.section(cells, element="Q4I", material=ct.Elastic(E=1.0))
    for edges in ([0, 1], [[0, 4]], [[9, 0]], [[0.0, 1.0]], np.zeros((0, 2), int)):
        with pytest.raises(ct.InputError):
            model.pressure(edges, 1.0)


def test_an_empty_set_is_refused(model: ct.Model) -> None:
    model.mesh.node_sets["none"] = np.zeros(0, np.int64)
    with pytest.raises(ct.InputError, match="'none' is empty"):
        model.fix("none")


def test_names_of_sets_may_be_written_in_any_case(model: ct.Model) -> None:
    model.fix("LEFT")
    assert model.supports[0].nodes == "left"
    model.mesh.node_sets["TIP"] = np.array([4])
    model.mesh.node_sets["tip"] = np.array([9])
    assert model.mesh.nodes_of("tip").tolist() == [9]
    with pytest.raises(ct.InputError, match="'TIP' or 'tip'"):
        model.fix("Tip")


@pytest.mark.parametrize(("name", "meant"), [("rigth", "right"), ("lef", "left"), ("topp", "top")])
def test_a_name_that_is_none_is_answered_with_the_nearest(
    model: ct.Model, name: str, meant: str
) -> None:
    for give in (model.fix, lambda where: model.pressure(where, 1.0), model.mesh.nodes_of):
        with pytest.raises(ct.InputError, match=f"did you mean '{meant}'"):
            give(name)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, "1", None, [1.0, 2.0]])
def test_values_that_are_no_numbers_are_refused_when_given(model: ct.Model, value: object) -> None:
    calls = [
        lambda: model.fix([0], x="free" if value is None else value, y=None),
        lambda: model.force([0], y=value),
        lambda: model.traction("right", y=value),
        lambda: model.pressure("right", value),
        lambda: model.gravity(y=value),
        lambda: model.velocity(x=value),
        lambda: model.centrifugal(value),
        lambda: ct.Static(period=value),
    ]
    for call in calls:
        with pytest.raises(ct.InputError):
            call()  # type: ignore[no-untyped-call]
    assert not model.supports
    assert not model.loads


def test_temperatures_must_be_finite(model: ct.Model) -> None:
    with pytest.raises(ct.InputError, match="finite"):
        model.temperature([20.0, np.nan])


@pytest.mark.parametrize(
    ("kind", "nodes", "words"),
    [
        ("quad4", [[0, 1, 2, 3, 3]], r"has 4 nodes: its table has shape \(n, 4\)"),
        ("quad4", [0, 1, 2, 3], r"shape \(n, 4\)"),
        ("quad4", [[0.0, 1.0, 2.0, 3.0]], "whole numbers"),
        ("quad", [[0, 1, 2, 3]], "did you mean 'quad4'"),
    ],
)
def test_a_table_of_cells_has_as_many_columns_as_nodes(
    kind: str, nodes: list[object], words: str
) -> None:
    with pytest.raises(ct.InputError, match=words):
        ct.Cells(kind, np.array(nodes), np.array([1]))


def test_cells_of_nodes_that_are_not_there_are_refused() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    for bad in (4, -1):
        cells = ct.Cells("quad4", np.array([[0, 1, 2, bad]]), np.array([1]))
        with pytest.raises(ct.InputError, match=f"has node {bad}"):
            ct.Mesh(square, [cells])

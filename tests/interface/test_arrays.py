"""Results as arrays: at places, along lines, in xarray, pandas, PyVista and meshio."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError
from corota.mesh.kinds import KINDS, N_NODES, PLANAR
from corota.mesh.shape_functions import shape_functions
from corota.results.probe import Interpolation, natural


@pytest.fixture(scope="module")
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(10.0, 2.0, nx=10, ny=2), name="strip")
    model.units("mm", "N", "t", "s")
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.5)
    return ct.solve(model, ct.Static(increments=4), threads=1)


@pytest.mark.parametrize("kind", PLANAR)
def test_natural_coordinates_are_found_in_curved_cells(kind: str) -> None:
    """The inverse of the map of a distorted cell, at points that the map itself made."""
    random = np.random.default_rng(3)
    corners = np.array(KINDS[kind].natural) * [2.0, 1.0] + 0.08 * random.standard_normal(
        (N_NODES[kind], 2)
    )
    for _ in range(20):
        at = random.uniform(0.0, 1.0, 2) if kind[0] == "q" else random.dirichlet([1, 1, 1])[:2]
        if kind[0] == "q":
            at = 2 * at - 1
        found = natural(kind, corners, shape_functions(kind, at[None])[0] @ corners)
        assert found == pytest.approx(at, abs=1e-8)
    assert natural(kind, corners, np.array([50.0, 50.0])) is None


def test_linear_fields_are_kept_at_any_point() -> None:
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 3.0, nx=7, ny=5), 0.2)
    points = np.random.default_rng(1).uniform([0.1, 0.1], [3.9, 2.9], (50, 2))
    field = mesh.points @ [2.0, -3.0] + 1.0
    assert Interpolation(mesh, points).values(field) == pytest.approx(points @ [2.0, -3.0] + 1.0)
    assert np.isnan(Interpolation(mesh, [(9.0, 0.0)]).values(field)).all()


def test_a_place_gives_histories(results: ct.Results) -> None:
    corner = int(results.mesh.nodes_of("right")[0])
    label = int(results.mesh.node_labels[corner])
    direct = np.array([f.U[corner, 1] for f in results.frames])
    assert np.array(results.at(node=label)["U2"]) == pytest.approx(direct)
    assert np.array(results.at(point=results.mesh.points[corner])["U2"]) == pytest.approx(direct)
    assert results.at(node=label)["u2"].name == f"U2 at node {label}"
    total = np.array(results.at("left")["RF2"])
    assert total[-1] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("what", "text"),
    [
        ({"node": 999}, "no node 999"),
        ({"point": (99.0, 0.0)}, "in no element"),
        ({}, "one of node=, point= or a set"),
        ({"point": [(0.0, 0.0), (1.0, 0.0)]}, "one point"),
    ],
)
def test_places_that_are_none_are_refused(results: ct.Results, what: Any, text: str) -> None:
    with pytest.raises(InputError, match=text):
        results.at(**what)


def test_values_along_lines_and_edges(results: ct.Results) -> None:
    line = results.along([(0.0, 1.0), (10.0, 1.0)], points=11)
    on = np.flatnonzero(np.isclose(results.mesh.points[:, 1], 1.0))
    on = on[np.argsort(results.mesh.points[on, 0])]
    assert line.distance == pytest.approx(np.linspace(0.0, 10.0, 11))
    assert line["U2"] == pytest.approx(results.nodal("U2")[on])
    top = results.along("top")
    nodes = results.mesh.nodes_of("top")
    nodes = nodes[np.argsort(-results.mesh.points[nodes, 0])]  # counter-clockwise
    assert top["S11"] == pytest.approx(results.nodal("S11")[nodes])
    assert len(top.points) == 11
    assert np.all(np.diff(top.distance) > 0.0)
    half = results.along([(5.0, 1.0), (15.0, 1.0)], points=3)
    assert np.isnan(half["U1"]).tolist() == [False, False, True]
    with pytest.raises(InputError, match="outside of all elements"):
        results.along([(0.0, 9.0), (1.0, 9.0)])


def test_lines_are_drawn(results: ct.Results, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    figure = results.along("top").plot("S11", path=tmp_path / "top.png")
    assert figure.axes[0].get_xlabel() == "distance along the line [mm]"
    assert figure.axes[0].get_ylabel() == "S11: Cauchy stress xx [MPa]"


def test_xarray_has_dimensions_coordinates_and_units(results: ct.Results) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed (extra data)")
    data = results.to_xarray()
    assert data["U"].dims == ("frame", "node", "component")
    assert data["S"].dims == ("frame", "node", "tensor")
    assert data["U"].attrs["units"] == "mm"
    assert data["S"].attrs["units"] == "MPa"
    assert "units" not in data["E"].attrs
    assert data["time"].values == pytest.approx(results.times)
    assert data["U"].sel(component="y").values == pytest.approx(
        np.array([f.U[:, 1] for f in results.frames])
    )
    assert data["S"].sel(tensor="11").isel(frame=-1).values == pytest.approx(results.nodal("S11"))
    assert data["MISES"].isel(frame=2).values == pytest.approx(results.nodal("MISES", 2))
    few = results.to_xarray(["U2"], frames=[-1])
    assert list(few.data_vars) == ["U2"]
    assert few.sizes == {"frame": 1, "node": results.mesh.n_nodes}


def test_histories_become_a_table(results: ct.Results) -> None:
    pytest.importorskip("pandas", reason="pandas is not installed (extra data)")
    table = results.to_dataframe(results.history("U2", at="right"), "load factor")
    assert list(table.columns) == ["U2 at right", "load factor"]
    assert table.index.name == "time"
    assert table["load factor"].to_numpy() == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    assert table.attrs["units"] == {"U2 at right": "mm", "time": "s"}
    assert "ALLSE" in results.to_dataframe().columns
    assert results.history("U2").to_dataframe().shape == (5, 1)


def test_pyvista_grids_hold_every_field(results: ct.Results) -> None:
    pytest.importorskip("pyvista", reason="PyVista is not installed (extra view)")
    grid = results.to_pyvista(2)
    assert grid.n_points == results.mesh.n_nodes
    assert grid.n_cells == results.mesh.n_cells
    assert np.array_equal(grid.point_data["displacement"][:, :2], results.frame(2).U)
    assert grid.point_data["Mises"] == pytest.approx(results.nodal("MISES", 2))
    assert grid.cell_data["cell Mises"] == pytest.approx(results.cells("MISES", 2))
    moved = results.to_pyvista(2, scale=3.0)
    assert moved.points[:, :2] == pytest.approx(results.mesh.points + 3.0 * results.frame(2).U)
    assert moved.compute_cell_sizes()["Area"].sum() > 0.0
    assert results.mesh.to_pyvista().point_data["node set left"].sum() == 3


@pytest.mark.parametrize("quadratic", [False, True])
def test_meshio_round_trip_keeps_labels_and_sets(quadratic: bool) -> None:
    pytest.importorskip("meshio", reason="meshio is not installed")
    mesh = ct.mesh.rectangle(4.0, 2.0, nx=4, ny=2)
    if quadratic:
        mesh = ct.mesh.to_quadratic(mesh)
    mesh.node_labels = mesh.node_labels * 10
    mesh.cells[0].labels = mesh.cells[0].labels + 100
    mesh.cell_sets["some"] = np.array([1, 3])
    again = ct.Mesh.from_meshio(mesh.to_meshio())
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.node_labels, mesh.node_labels)
    assert np.array_equal(again.cell_labels, mesh.cell_labels)
    for name in mesh.edge_sets:
        assert sorted(map(tuple, again.edge_sets[name])) == sorted(map(tuple, mesh.edge_sets[name]))
    for name in mesh.node_sets:
        assert np.array_equal(again.node_sets[name], mesh.node_sets[name])
    assert np.array_equal(again.cell_sets["some"], [1, 3])


@pytest.mark.parametrize(
    ("method", "module", "extra"),
    [
        ("to_xarray", "xarray", "data"),
        ("to_dataframe", "pandas", "data"),
        ("to_pyvista", "pyvista", "view"),
    ],
)
def test_a_missing_package_is_named_with_its_extra(
    results: ct.Results, method: str, module: str, extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, module, None)
    with pytest.raises(ct.ResourceError, match=rf"{module}.*pip install corota\[{extra}\]"):
        getattr(results, method)()

"""Files that other programs open: every field to the last bit, by VTK's own readers and by h5py."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import corota as ct
from corota.examples.models import hinge
from corota.io.vtk.frame_arrays import cell_data, point_data
from corota.io.vtk.grid import Grid
from corota.results.invariants import OF_STRESS


def tool_on_two_sections() -> ct.Model:
    """A round tool, carried by a reference node, on a block of two materials."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=16, ny=4), name="tool")
    mesh = model.mesh
    mesh.cell_sets["a"], mesh.cell_sets["b"] = np.arange(32), np.arange(32, 64)
    model.units("mm", "N")
    model.section("a", element="Q4I", material=ct.Mises(E=1000.0, nu=0.3, yield_stress=5.0))
    model.section("b", element="Q4I", material=ct.Elastic(E=500.0, nu=0.3))
    node = ct.mesh.add_node(mesh, 2.0, 2.0)
    model.contact("top", ct.RigidCurve.circle((2.0, 2.0), 1.0, reference=node))
    model.fix("bottom")
    model.fix([node], x=0.0, y=-0.02, rotation=0.2)
    return model


@pytest.fixture(scope="module", params=[tool_on_two_sections, hinge])
def results(request: pytest.FixtureRequest) -> ct.Results:
    model = request.param()
    step = model.steps or [ct.Static(increments=3)]
    return ct.solve(model, step, threads=1)


def arrays(results: ct.Results, index: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """What a frame has to be in a file, at points and at cells."""
    grid, frame = Grid(results.model), results.frames[index]
    at_points = grid.at_points(point_data(frame, results.averaging), frame)
    at_cells = dict(grid.still) | grid.at_cells(cell_data(frame, results.mesh.n_cells))
    return at_points, at_cells


@pytest.mark.parametrize("options", [{}, {"compression": 0}, {"points": True}], ids=str)
def test_h5py_reads_every_field_to_the_last_bit(
    results: ct.Results, tmp_path: Path, options: dict[str, Any]
) -> None:
    path = results.write(tmp_path / "a.vtkhdf", **options)
    count = len(results.frames)
    with h5py.File(path) as file:
        for i in range(count):
            for place, wanted in zip(("PointData", "CellData"), arrays(results, i), strict=True):
                group = file[f"VTKHDF/{place}"]
                offsets = file[f"VTKHDF/Steps/{place}Offsets"]
                for name, values in wanted.items():
                    first = int(offsets[name.replace("/", "|")][i])
                    found = group[name.replace("/", "|")][first : first + len(values)]
                    assert np.array_equal(found, values), name


def test_vtk_reads_every_field_at_every_time(results: ct.Results, tmp_path: Path) -> None:
    """VTK's own reader: times, fields, topology and deformed positions."""
    pytest.importorskip("vtk", reason="vtk is not installed (requirements-view.txt)")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    path = results.write(tmp_path / "a.vtkhdf")
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(results.frames)
    grid = Grid(results.model)
    for i in range(len(results.frames)):
        reader.SetStep(i)
        reader.Update()
        assert reader.GetTimeValue() == results.frames[i].time
        read = reader.GetOutput()
        assert np.array_equal(vtk_to_numpy(read.GetPoints().GetData()), grid.points)
        assert np.array_equal(vtk_to_numpy(read.GetCells().GetConnectivityArray()), grid.chain)
        for data, wanted in zip(
            (read.GetPointData(), read.GetCellData()), arrays(results, i), strict=True
        ):
            assert data.GetNumberOfArrays() == len(wanted)
            for name, values in wanted.items():
                found = vtk_to_numpy(data.GetArray(name))
                assert np.array_equal(found, values), name


def test_vtk_reads_xml_files(results: ct.Results, tmp_path: Path) -> None:
    pytest.importorskip("vtk", reason="vtk is not installed (requirements-view.txt)")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    results.write(tmp_path / "a.pvd")
    for i in range(len(results.frames)):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(tmp_path / f"a_{i:04d}.vtu"))
        reader.Update()
        read = reader.GetOutput()
        for data, wanted in zip(
            (read.GetPointData(), read.GetCellData()), arrays(results, i), strict=True
        ):
            for name, values in wanted.items():
                assert np.array_equal(vtk_to_numpy(data.GetArray(name)), values), name


def test_a_rigid_tool_moves_in_the_file(tmp_path: Path) -> None:
    """Points of the circle turn about the reference node: an independent rotation matrix."""
    model = tool_on_two_sections()
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    path = results.write(tmp_path / "a.vtkhdf")
    n = model.mesh.n_nodes
    with h5py.File(path) as file:
        X = file["VTKHDF/Points"][n:, :2]
        u = file["VTKHDF/PointData/displacement"][:].reshape(3, -1, 3)[-1, n:, :2]
        assert file["VTKHDF/Types"][-1] == 4
        assert file["VTKHDF/CellData/section"][-1] == -1
        assert file["VTKHDF/PointData/stress"].attrs["units"] == "MPa"
    assert np.hypot(*(X - [2.0, 2.0]).T) == pytest.approx(np.ones(len(X)))
    angle = 0.2
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert X + u == pytest.approx((X - [2.0, 2.0]) @ turn.T + [2.0, 1.98], abs=1e-12)
    with ct.read_results(path) as back:
        assert back.mesh.n_nodes == n
        assert back.mesh.n_cells == model.mesh.n_cells


def test_jumps_between_sections_stay_without_points(tmp_path: Path) -> None:
    results = ct.solve(tool_on_two_sections(), ct.Static(increments=2), threads=1)
    with ct.read_results(results.write(tmp_path / "a.vtkhdf")) as back:
        for name in ("S22", "MISES", "SP1", "PEEQ", "E12"):
            for section in (0, 1):
                wanted = results.nodal(name, 1, section=section)
                assert back.nodal(name, 1, section=section) == pytest.approx(wanted, abs=1e-12)
            assert back.cells(name, 1) == pytest.approx(results.cells(name, 1), abs=1e-12)
            assert np.array_equal(back.cells_with(name), results.cells_with(name))
        again = back.write(tmp_path / "b.vtkhdf")
        with ct.read_results(again) as third:
            assert np.array_equal(third.nodal("S22", section=1), back.nodal("S22", section=1))
            assert np.array_equal(third.cells("S22"), back.cells("S22"))
    assert (tmp_path / "a.vtkhdf").stat().st_size > 0


def test_single_precision_and_chosen_fields(tmp_path: Path) -> None:
    results = ct.solve(tool_on_two_sections(), ct.Static(increments=2), threads=1)
    path = results.write(tmp_path / "a.vtkhdf", single=True, fields=["S"])
    with h5py.File(path) as file:
        names = set(file["VTKHDF/PointData"])
        of_stress = {item.array for item in OF_STRESS}
        assert names == {"displacement", "rotation", "stress", *of_stress}
        assert file["VTKHDF/PointData/stress"].dtype == np.float32
        assert file["corota/frames/time"].dtype == np.float64
    with ct.read_results(path) as back:
        assert back.nodal("S11") == pytest.approx(results.nodal("S11"), rel=1e-6, abs=1e-6)
        assert "RF1" not in back.variables()
        with pytest.raises(ct.InputError, match="no result variable named 'RF1'"):
            back.history("RF1", at="bottom")
        assert not any("RF1" in line for line in csv_of(back, tmp_path))
        assert not any("nan" in line for line in csv_of(back, tmp_path))


def csv_of(results: ct.Results, folder: Path) -> list[str]:
    return results.write(folder / "a.csv").read_text().splitlines()


def test_requests_of_a_deck_choose_fields(tmp_path: Path) -> None:
    model = tool_on_two_sections()
    step = ct.Static(increments=2)
    step.outputs = [ct.Output("node file", ("U",)), ct.Output("el file", ("PEEQ",))]
    model.steps = [step]
    ct.solve(model, observers=[ct.JobFiles(tmp_path, "j", fields="requested")], threads=1)
    with h5py.File(tmp_path / "j.vtkhdf") as file:
        assert set(file["VTKHDF/PointData"]) == {"displacement", "rotation", "PEEQ"}


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"fields": ["Q7"]}, "unknown field 'Q7'"),
        ({"fields": "some"}, "give 'all', 'requested'"),
        ({"compression": 10}, "a level from 0 to 9"),
        ({"color": 1}, "options are points"),
    ],
)
def test_wrong_options_are_refused(tmp_path: Path, options: dict[str, Any], text: str) -> None:
    results = ct.solve(tool_on_two_sections(), ct.Static(), threads=1)
    with pytest.raises(ct.InputError, match=text):
        results.write(tmp_path / "a.vtkhdf", **options)
    with pytest.raises(ct.InputError, match="has no options"):
        results.write(tmp_path / "a.csv", points=True)

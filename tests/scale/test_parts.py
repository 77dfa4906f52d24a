"""Result files in parts: every field of the file in one part, by our reader and by VTK's."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import corota as ct
from corota.analysis.parallel.partition import process_of_cells
from corota.errors import InputError
from corota.io.vtk.grid import topology
from corota.io.vtk.parts import Parts, whole


@pytest.fixture(scope="module")
def results() -> ct.Results:
    """Quadrilaterals and triangles, a rigid tool, and its reference node, which has no cell."""
    left = ct.mesh.rectangle(4.0, 1.0, nx=9, ny=3)
    right = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, cell="tri3")
    mesh = ct.mesh.assembly(left=left, right=ct.mesh.move(right, (4.0, 0.0)))
    model = ct.Model(mesh, name="tool")
    model.section("left", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.section("right", element="T3", material=ct.Elastic(E=500.0, nu=0.3))
    node = ct.mesh.add_node(mesh, 2.0, 2.0)
    model.contact("left.top", ct.RigidCurve.circle((2.0, 2.0), 1.0, reference=node))
    model.fix("left.bottom")
    model.fix("right.bottom")
    model.force("right.top", x=1.0)
    model.fix([node], x=0.0, y=-0.02, rotation=0.2)
    return ct.solve(model, ct.Static(increments=2), threads=1)


@pytest.mark.parametrize("count", [2, 3, 5])
def test_parts_are_put_together_again(results: ct.Results, count: int) -> None:
    mesh = results.mesh
    chain, ends, _, _ = topology(mesh)
    part = process_of_cells(results.model, count)
    cut = Parts(chain, ends, part, mesh.n_nodes)
    assert cut.sizes.sum(axis=0)[1:].tolist() == [mesh.n_cells, len(chain)]
    assert set(cut.nodes.tolist()) == set(range(mesh.n_nodes))
    again = whole(cut.chain, cut.ends, cut.sizes, cut.nodes, cut.cells)
    np.testing.assert_array_equal(again[0], chain)
    np.testing.assert_array_equal(again[1], ends)


@pytest.mark.parametrize("options", [{}, {"points": True}, {"fields": ["S"]}], ids=str)
def test_a_file_in_parts_reads_as_the_file_in_one(
    results: ct.Results, tmp_path: Path, options: dict[str, Any]
) -> None:
    results.write(tmp_path / "one.vtkhdf", **options)
    results.write(tmp_path / "four.vtkhdf", parts=4, **options)
    with (
        ct.read_results(tmp_path / "one.vtkhdf") as one,
        ct.read_results(tmp_path / "four.vtkhdf") as four,
    ):
        np.testing.assert_array_equal(four.mesh.points, one.mesh.points)
        for ours, theirs in zip(four.mesh.cells, one.mesh.cells, strict=True):
            assert ours.kind == theirs.kind
            np.testing.assert_array_equal(ours.nodes, theirs.nodes)
            np.testing.assert_array_equal(ours.labels, theirs.labels)
        np.testing.assert_array_equal(four.sections(), one.sections())
        for index, (a, b) in enumerate(zip(one.frames, four.frames, strict=True)):
            for name in ("U", "UR", "RF", "F", "C"):
                np.testing.assert_array_equal(getattr(b, name), getattr(a, name))
            for name in one.variables(index):
                np.testing.assert_array_equal(four.nodal(name, index), one.nodal(name, index))
            np.testing.assert_array_equal(four.cells("S11", index), one.cells("S11", index))
            for ours, theirs in zip(b.fields, a.fields, strict=True):
                np.testing.assert_array_equal(ours.frame_rotation, theirs.frame_rotation)
        again = four.write(tmp_path / "again.vtkhdf")
    with h5py.File(again) as file:
        assert len(file["VTKHDF/NumberOfPoints"]) == 1


def test_vtk_gives_each_of_its_processes_the_part_of_one(
    results: ct.Results, tmp_path: Path
) -> None:
    pytest.importorskip("vtk", reason="vtk is not installed (requirements-view.txt)")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    path = results.write(tmp_path / "a.vtkhdf", parts=3)
    part = process_of_cells(results.model, 3)
    mesh = results.mesh
    labels = mesh.cell_labels
    nodes_of = dict(
        zip(
            labels.tolist(),
            (n.tolist() for cells in mesh.cells for n in cells.nodes),
            strict=True,
        )
    )
    for piece in range(3):
        reader = vtkHDFReader()
        reader.SetFileName(str(path))
        reader.UpdateInformation()
        assert reader.GetNumberOfSteps() == len(results.frames)
        for step, frame in enumerate(results.frames):
            reader.SetStep(step)
            reader.UpdatePiece(piece, 3, 0)
            read = reader.GetOutputDataObject(0).GetPartition(piece)
            label = vtk_to_numpy(read.GetCellData().GetArray("element label"))
            mine = label > 0  # rigid curves have no label
            assert set(label[mine].tolist()) == set(labels[part == piece].tolist())
            assert (~mine).sum() == (1 if piece == 2 else 0)
            place = vtk_to_numpy(read.GetPoints().GetData())
            moved = vtk_to_numpy(read.GetPointData().GetArray("displacement"))
            for row in np.flatnonzero(mine):
                cell = read.GetCell(int(row))
                points = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
                nodes = nodes_of[int(label[row])]
                np.testing.assert_array_equal(place[points, :2], mesh.points[nodes])
                np.testing.assert_array_equal(moved[points, :2], frame.U[nodes])


def test_a_grid_without_parts_is_refused(results: ct.Results, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="one part or more"):
        results.write(tmp_path / "a.vtkhdf", parts=0)

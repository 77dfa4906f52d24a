"""A history of a result file reads the arrays of its name, not all variables."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import corota as ct

#: Arrays at the nodes that every frame holds in its own attributes.
OF_FRAMES = {"displacement", "rotation", "reaction", "reaction moment", "external force"}
OF_FRAMES |= {"external moment"}


@pytest.fixture
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 10, 2))
    model.section("all", element="Q4I", material=ct.Elastic(1e3, 0.3))
    model.fix("left")
    model.force("right", y=-0.01)
    return ct.solve(model, ct.Static(increments=3), threads=1)


@pytest.mark.parametrize("points", [False, True])
@pytest.mark.parametrize(
    ("name", "at_nodes", "at_points"),
    [("U1", set(), set()), ("MISES", {"Mises"}, {"S"}), ("E12", {"strain"}, {"E"})],
)
def test_a_history_reads_what_its_name_needs(
    results: ct.Results,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    points: bool,
    name: str,
    at_nodes: set[str],
    at_points: set[str],
) -> None:
    results.write(tmp_path / "job.vtkhdf", points=points)
    read: list[str] = []
    get = h5py.Dataset.__getitem__

    def counted(self: h5py.Dataset, *args: Any, **options: Any) -> Any:
        read.append(self.name)
        return get(self, *args, **options)

    with ct.read_results(tmp_path / "job.vtkhdf") as stored:
        monkeypatch.setattr(h5py.Dataset, "__getitem__", counted)
        found = stored.history(name, at="right")
    np.testing.assert_allclose(found.values, results.history(name, at="right").values, rtol=1e-12)
    fields = {n.rpartition("/")[2] for n in read if "PointData/" in n} - OF_FRAMES
    assert fields == (set() if points else at_nodes)
    assert not [n for n in read if "CellData/" in n]
    assert {n.rpartition("/")[2] for n in read if "corota/points" in n} <= (
        at_points | {"position", "reference volume"} if points else set()
    )


@pytest.mark.parametrize("points", [False, True])
def test_a_frame_of_a_closed_file_says_so(
    results: ct.Results, tmp_path: Path, points: bool
) -> None:
    results.write(tmp_path / "job.vtkhdf", points=points)
    with ct.read_results(tmp_path / "job.vtkhdf") as stored:
        frame = stored.frames[-1]
    np.testing.assert_array_equal(frame.U, results.frames[-1].U)
    with pytest.raises(ct.FileError, match="the result file is closed"):
        frame.fields[0].values["S"] if points else frame.averages["stress"]

"""Modes in a result file of their own, lines in files and pictures, motion as MP4."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import h5py
import numpy as np
import pytest

import corota as ct
from corota import plots
from corota.io.modes import as_results
from corota.verification.beam_models import lee_frame
from support.frames import column

if TYPE_CHECKING:
    from pathlib import Path


def test_buckling_modes_are_written_as_steps_of_a_file(tmp_path: Path) -> None:
    model = column(n=10)
    model.name = "job"
    results = ct.solve(model, ct.Buckle(modes=3), observers=[ct.JobFiles(tmp_path)], threads=1)
    modes = results.modes[0]
    with h5py.File(tmp_path / "job.modes.vtkhdf") as file:
        # What ParaView reads: as many steps as modes, the shape as the displacement.
        assert file["VTKHDF/Steps"].attrs["NSteps"] == 3
        shapes = file["VTKHDF/PointData/displacement"][:].reshape(3, -1, 3)
        assert shapes[:, :, :2] == pytest.approx(modes.shapes[:, :, :2])
    with ct.read_results(tmp_path / "job.modes.vtkhdf") as again:
        found = [frame.scalars["buckling factor"] for frame in again.frames]
        assert found == pytest.approx(modes.factors)
        picture = plots.contour(again, "U2", frame=1, scale=10.0, path=tmp_path / "mode.png")
    assert picture is not None
    assert (tmp_path / "mode.png").stat().st_size > 5000


def test_results_without_modes_say_so() -> None:
    model = column(n=2)
    with pytest.warns(UserWarning, match="bifurcation"):
        results = ct.solve(model, ct.Static(), threads=1)
    with pytest.raises(ct.InputError, match="no modes"):
        as_results(results)


@pytest.mark.usefixtures("quick_pictures")
def test_beams_are_in_files_and_pictures(tmp_path: Path) -> None:
    model, node = lee_frame(5)
    model.name = "lee"
    path = ct.ArcLength(displacement=(node, "y", -20.0))
    results = ct.solve(
        model, ct.Static(path=path), observers=[ct.JobFiles(tmp_path, points=True)], threads=1
    )
    with h5py.File(tmp_path / "lee.vtkhdf") as file:
        assert file["VTKHDF/Types"][:].tolist() == [3] * 10
    with ct.read_results(tmp_path / "lee.vtkhdf") as again:
        assert np.array_equal(again.mesh.cells[0].nodes, model.mesh.cells[0].nodes)
        values = again.frames[-1].fields[0].values["N"]
        assert values == pytest.approx(results.frames[-1].fields[0].values["N"])
        plots.contour(again, "N", path=tmp_path / "lee.png")
        plots.contour(again, "U", path=tmp_path / "lee_u.png")
    assert (tmp_path / "lee.png").stat().st_size > 5000


def short_path() -> ct.Results:
    model, node = lee_frame(5)
    path = ct.ArcLength(displacement=(node, "y", -5.0))
    return ct.solve(model, ct.Static(path=path), threads=1)


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="needs ffmpeg")
def test_motion_along_the_path_as_mp4(tmp_path: Path) -> None:
    found = plots.animate(short_path(), "U", path=tmp_path / "lee.mp4", dpi=40)
    data = found.read_bytes()
    assert data[4:8] == b"ftyp"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["lee.mp4"]


def test_without_ffmpeg_the_message_names_the_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ct.InputError, match=r"ffmpeg.*\.gif"):
        plots.animate(short_path(), "U", path=tmp_path / "lee.mp4")

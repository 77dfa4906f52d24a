"""Result files: structure, times, read-back, and what survives a killed or refused write."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import random
import re
import signal
import subprocess
import sys
import time
import zlib
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
import pytest

from corota.errors import CorotaError, FileError, InputError
from corota.io import atomic_file
from corota.io.atomic_file import AtomicFile, TextFile
from corota.io.job import JobFiles
from corota.io.result_reader import read_results
from corota.io.vtk.packing import packed
from corota.io.writers import WRITERS
from support.pairs import quickly

HERE = Path(__file__).parent
TIMES = [0.0, 0.25, 0.5, 0.75, 1.0]


def test_vtkhdf_is_a_temporal_grid_with_one_topology(results, tmp_path):
    path = results.write(tmp_path / "a.vtkhdf")
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert root.attrs["Type"] == b"UnstructuredGrid"
        assert root.attrs["Version"].tolist() == [2, 0]
        assert root["NumberOfPoints"][:].tolist() == [6]
        assert root["NumberOfCells"][:].tolist() == [2]
        assert root["Types"][:].tolist() == [9, 9]
        assert root["Offsets"][:].tolist() == [0, 4, 8]
        assert root["Points"].shape == (6, 3)
        steps = root["Steps"]
        assert steps.attrs["NSteps"] == 5
        assert steps["Values"][:].tolist() == TIMES
        assert steps["NumberOfParts"][:].tolist() == [1] * 5
        for name in ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"):
            assert not steps[name][:].any()
            assert len(steps[name]) == 5
        for kind, rows in (("PointData", 6), ("CellData", 2)):
            for name, data in root[kind].items():
                offsets = steps[f"{kind}Offsets"][name][:]
                still = name in ("section", "element label")
                assert len(data) == (rows if still else 5 * rows), name
                assert offsets.tolist() == ([0] * 5 if still else [rows * i for i in range(5)])
        shapes = {k: v.shape[1:] for k, v in root["PointData"].items()}
        assert shapes["displacement"] == (3,)
        assert shapes["stress"] == (6,)
        assert shapes["principal stress"] == (3,)
        assert shapes["rotation"] == shapes["Mises"] == ()
        assert "frame rotation" in root["CellData"]
        assert "averaged" in file["corota"].attrs["averaging"]


def test_vtkhdf_reads_back_what_was_written(results, tmp_path):
    path = results.write(tmp_path / "a.vtkhdf", points=True)
    with read_results(path) as back:
        assert len(back.frames) == 5
        assert back.times.tolist() == TIMES
        assert back.mesh.node_labels.tolist() == results.mesh.node_labels.tolist()
        assert back.mesh.cell_labels.tolist() == results.mesh.cell_labels.tolist()
        assert back.mesh.node_sets["LEFT"].tolist() == results.mesh.node_sets["LEFT"].tolist()
        for mine, theirs in zip(results.frames, back.frames, strict=True):
            assert (mine.step, mine.increment, mine.time) == (
                theirs.step,
                theirs.increment,
                theirs.time,
            )
            for name in ("U", "UR", "RF", "F"):
                assert np.array_equal(getattr(mine, name), getattr(theirs, name)), name
            for name, values in mine.fields[0].values.items():
                assert np.array_equal(values, theirs.fields[0].values[name]), name
            assert mine.scalars == theirs.scalars
        assert np.array_equal(back.nodal("SP1"), results.nodal("SP1"))
        assert np.array_equal(back.cells("S11"), results.cells("S11"))
        assert back.info == results.info
        assert back.history("U2", at="RIGHT").values == pytest.approx(
            results.history("U2", at="RIGHT").values
        )


def test_without_points_the_nodal_averages_remain(model, fake, tmp_path):
    files = JobFiles(tmp_path, points=False)
    results = fake.play(model, [files])
    with read_results(tmp_path / "beam.vtkhdf") as back:
        assert not back.frames[-1].fields
        for name in ("MISES", "S11", "SP1", "E12", "EP3"):
            assert back.nodal(name) == pytest.approx(results.nodal(name)), name


def test_frames_have_no_variable_that_appears_later(model, fake, tmp_path):
    def late(i, frame):
        if i >= 2:
            frame.fields[0].values["PEEQ"] = np.full((2, 4), 0.5)
            frame.scalars["plastic dissipation"] = 2.0

    files = JobFiles(tmp_path)
    fake.play(model, [files], sabotage=late)
    with read_results(tmp_path / "beam.vtkhdf") as back:
        # The arrays of the file are zero there, for viewers; frames as in memory.
        with pytest.raises(InputError, match="no result variable named 'PEEQ'"):
            back.nodal("PEEQ", 1)
        assert np.isnan(back.history("PEEQ", at="nodes").values[:2]).all()
        assert back.nodal("PEEQ", 2) == pytest.approx(np.full(6, 0.5))
        assert back.history("plastic dissipation").values.tolist() == [0, 0, 2, 2, 2]


def test_velocities_are_kept(model, fake, tmp_path):
    def move(i, frame):
        frame.V = np.full((6, 3), 0.5 * i)
        frame.A = np.full((6, 3), -1.0)

    results = fake.play(model, [JobFiles(tmp_path)], sabotage=move)
    assert results.history("V1", at="RIGHT").values.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    with read_results(tmp_path / "beam.vtkhdf") as back:
        assert back.frames[2].V.tolist() == np.full((6, 3), 1.0).tolist()
        assert back.nodal("AR3").tolist() == [-1.0] * 6
    with np.load(results.write(tmp_path / "a.npz")) as data:
        assert data["V"].shape == (5, 6, 3)


def test_static_results_have_no_velocity(results):
    assert "V1" not in results.variables()
    with pytest.raises(InputError, match="no result variable named 'V1'"):
        results.nodal("V1")


def test_vtu_and_pvd_hold_the_same_numbers(results, tmp_path):
    results.write(tmp_path / "a.pvd")
    sets = ElementTree.parse(tmp_path / "a.pvd").getroot().findall("Collection/DataSet")
    assert [float(s.get("timestep")) for s in sets] == TIMES
    raw = (tmp_path / sets[-1].get("file")).read_bytes()
    head, _, blob = raw.partition(b'<AppendedData encoding="raw">\n_')
    tree = ElementTree.fromstring(head + b"</VTKFile>")
    arrays = {a.get("Name"): a for a in tree.iter("DataArray")}

    def array(name, kind):
        at = int(arrays[name].get("offset"))
        size = int(np.frombuffer(blob[at : at + 8], np.uint64)[0])
        return np.frombuffer(blob[at + 8 : at + 8 + size], kind)

    U = array("displacement", np.float64).reshape(-1, 3)
    assert np.array_equal(U[:, :2], results.frames[-1].U)
    assert array("offsets", np.int64).tolist() == [4, 8]
    assert array("connectivity", np.int64).tolist() == results.mesh.cells[0].nodes.ravel().tolist()


def test_npz_holds_every_frame(results, tmp_path):
    with np.load(results.write(tmp_path / "a.npz")) as data:
        assert data["time"].tolist() == TIMES
        assert data["U"].shape == (5, 6, 2)
        assert data["S_0"].shape == (5, 2, 4, 4)
        assert data["strain_energy"].tolist() == [t * t for t in TIMES]


def test_every_format_of_the_table_is_written(results, tmp_path):
    for ending in WRITERS:
        path = results.write(tmp_path / f"x{ending}")
        assert path.stat().st_size > 0
    with pytest.raises(InputError, match=r"unknown result format '.xyz'; use one of .vtkhdf"):
        results.write(tmp_path / "x.xyz")
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", ["U", "S", "scalar"])
def test_no_number_that_is_not_finite_reaches_a_file(model, fake, tmp_path, bad, place):
    def spoil(i, frame):
        if i == 3:
            if place == "U":
                frame.U[2, 1] = bad
            elif place == "S":
                frame.fields[0].values["S"][1, 2, 0] = bad
            else:
                frame.scalars["strain energy"] = bad

    files = JobFiles(tmp_path)
    with pytest.raises(CorotaError, match=r"internal error: .* not finite in step 1, increment 3"):
        fake.play(model, [files], sabotage=spoil)
    with read_results(tmp_path / "beam.vtkhdf") as back:
        assert back.times.tolist() == TIMES[:3]
    for path in tmp_path.iterdir():
        if path.suffix != ".vtkhdf":
            assert not re.search(r"\b(nan|inf|infinity)\b", path.read_text().lower()), path


def test_csv_has_histories_with_energies_reactions_and_nodes(model, fake, tmp_path):
    files = JobFiles(tmp_path, histories=["U1@RIGHT", "RF2@101"])
    fake.play(model, [files])
    lines = (tmp_path / "beam.csv").read_text().splitlines()
    names = lines[0].split(",")
    table = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    column = dict(zip(names, table.T, strict=True))
    assert column["time"].tolist() == TIMES
    assert column["dt"].tolist() == [0.0, 0.25, 0.25, 0.25, 0.25]
    assert column["attempts"].tolist() == [0, 1, 2, 1, 1]
    assert column["strain energy"] == pytest.approx(np.square(TIMES))
    assert column["external work"] == pytest.approx(np.square(TIMES))
    assert column["energy balance error"] == pytest.approx(np.zeros(5))
    assert column["RF2 LEFT"] == pytest.approx(TIMES)
    assert column["RF2 all supports"] == pytest.approx(TIMES)
    assert column["RF2 101"] == pytest.approx(0.5 * np.array(TIMES))
    assert column["U2 node 103"] == pytest.approx(0.2 * np.array(TIMES))
    assert "U1 RIGHT" in column
    assert column["largest MISES"][-1] > 0.0


@pytest.mark.parametrize("request_", ["U9@LEFT", "U2", "U2@", "U2@999"])
def test_wrong_history_request_is_refused(model, fake, tmp_path, request_):
    with pytest.raises(InputError, match="history"):
        fake.play(model, [JobFiles(tmp_path, histories=[request_])])


def test_status_file_marks_the_attempt_given_up(model, fake, tmp_path):
    fake.play(model, [JobFiles(tmp_path)])
    lines = (tmp_path / "beam.sta").read_text().splitlines()[2:]
    assert any("1U" in line for line in lines)
    assert [line.split()[1:3] for line in lines if "U" not in line] == [
        ["1", "1"],
        ["2", "2"],
        ["3", "1"],
        ["4", "1"],
    ]


def test_twin_file_shows_only_committed_states(tmp_path):
    twin = AtomicFile(tmp_path / "t")
    rng = random.Random(4)
    image = bytearray()
    for _ in range(30):
        for _ in range(rng.randrange(1, 5)):
            at, data = rng.randrange(len(image) + 10), rng.randbytes(rng.randrange(1, 50))
            image.extend(bytes(max(0, at + len(data) - len(image))))
            image[at : at + len(data)] = data
            twin.seek(at)
            twin.write(data)
        shown = bytes(image)
        held = bytearray(len(image))
        twin.seek(0)
        assert twin.readinto(held) == len(image)
        assert held == image
        twin.commit()
        assert (tmp_path / "t").read_bytes() == shown
    twin.close()
    assert [p.name for p in tmp_path.iterdir()] == ["t"]


@pytest.mark.parametrize("fails", ["replace", "fsync"])
def test_a_failed_commit_of_a_twin_file_loses_nothing(tmp_path, monkeypatch, fails):
    """Pages of it may be written again in part before the next commit."""
    rng, image, shown, full = random.Random(5), bytearray(60_000), b"", False
    true = getattr(os, fails)

    def call(*args):
        if full:
            raise OSError(28, "No space left on device")
        return true(*args)

    monkeypatch.setattr(os, fails, call)
    monkeypatch.setattr(atomic_file, "YOUNG", 0.0)
    twin = AtomicFile(tmp_path / "t")
    twin.write(image)
    for number in range(40):
        at, data = rng.randrange(len(image) - 50), rng.randbytes(rng.randrange(1, 50))
        image[at : at + len(data)] = data
        twin.seek(at)
        twin.write(data)
        full = rng.random() < 0.4
        if full and number:
            with pytest.raises(FileError, match="No space left"):
                twin.commit()
        else:
            full = False
            twin.commit()
            shown = bytes(image)
        assert (tmp_path / "t").read_bytes() == shown
        held = bytearray(len(image))
        twin.seek(0)
        twin.readinto(held)
        assert held == image
    full = False
    twin.commit(last=True)
    assert (tmp_path / "t").read_bytes() == image


def test_twin_file_without_hard_links(tmp_path, monkeypatch):
    def refuse(*args, **options):
        raise OSError("no links here")

    monkeypatch.setattr(os, "link", refuse)
    twin = AtomicFile(tmp_path / "t")
    for number in range(4):
        twin.seek(number)
        twin.write(b"%d" % number)
        twin.commit()
        assert (tmp_path / "t").read_bytes() == b"0123"[: number + 1]
    twin.close()


def test_refused_piece_is_cut_off_again(tmp_path, monkeypatch):
    text = TextFile(tmp_path / "a.txt")
    text.append("whole\n")

    class Full:
        def __init__(self, file):
            self.file, self.left = file, 3
            self.close = file.close

        def write(self, data):
            if not self.left:
                raise OSError(28, "No space left on device")
            count, self.left = self.file.write(data[: self.left]), 0
            return count

        def __getattr__(self, name):
            return getattr(self.file, name)

    text._file = Full(text._file)
    with pytest.raises(FileError, match=r"a\.txt: cannot write: No space left on device"):
        text.append("broken\n")
    text.close()
    assert (tmp_path / "a.txt").read_text() == "whole\n"


RUN = """
import sys, time
sys.path.insert(0, {here!r})
import conftest as c
from corota.io import job, task_queue
from corota.model.materials import Elastic
from corota.model import Model
from corota.model.steps import Static
task_queue.BEAT = 0.02
model = Model(c.strip(40, 20), "beam")
model.section("EALL", element="Q4I", material=Elastic(E=1000.0, nu=0.3), thickness=0.1)
model.fix("LEFT")
model.steps.append(Static())
def pace(i, frame):
    time.sleep(0.01)
c.play(model, [job.JobFiles({out!r})], count=100, sabotage=pace)
"""


@pytest.mark.parametrize("target", quickly([1, 2, 7, 30, 60], 1, 7))
def test_killed_run_leaves_a_readable_file(tmp_path, target):
    """The file is whole whenever somebody looks, and after SIGKILL at any moment."""
    script = RUN.format(here=str(HERE), out=str(tmp_path))
    path = tmp_path / "beam.vtkhdf"
    seen = 0
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.DEVNULL) as run:
        while seen < target:
            assert run.poll() is None or path.exists()
            if path.exists():
                with read_results(path) as results:
                    assert len(results.frames) >= seen
                    seen = len(results.frames)
        time.sleep(random.Random(target).uniform(0.0, 0.04))
        run.send_signal(signal.SIGKILL)
    with read_results(path) as back:
        assert len(back.frames) >= target
        assert back.times == pytest.approx(np.arange(len(back.frames)) / 100)
        for frame in back.frames:
            assert frame.U[:, 1].max() == pytest.approx(0.2 * frame.factor)


def test_file_that_is_not_a_result_is_named(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        read_results(tmp_path / "a.vtkhdf")
    (tmp_path / "b.vtkhdf").write_text("text")
    with pytest.raises(FileError, match="not an HDF5 file, or damaged"):
        read_results(tmp_path / "b.vtkhdf")
    with h5py.File(tmp_path / "c.vtkhdf", "w") as file:
        file["x"] = 1
    with pytest.raises(FileError, match="not one of Corota's"):
        read_results(tmp_path / "c.vtkhdf")


def test_truncated_result_file_is_refused(results, tmp_path):
    path = results.write(tmp_path / "a.vtkhdf")
    data = path.read_bytes()
    for share in (0.1, 0.5, 0.9):
        path.write_bytes(data[: int(share * len(data))])
        with pytest.raises(FileError, match="damaged"):
            read_results(path)


@pytest.mark.parametrize("level", [1, 6])
@pytest.mark.parametrize("size", [0, 1, 5000, 200_000])
def test_packed_planes_are_one_stream_that_zlib_reads(size, level):
    """Planes that pack, planes of noise and empty ones give back their bytes, and zeros pack."""
    noise = np.random.default_rng(1).bytes(size)
    planes = [bytes(size), noise, b"ab" * (size // 2), noise[::-1]]
    found = packed(planes, level)
    assert zlib.decompress(found) == b"".join(planes)
    if size > 100_000:
        assert len(found) < 2.2 * size

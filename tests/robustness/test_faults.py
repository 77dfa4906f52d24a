"""Words that would do harm: inputs replaced, names that leave, bombs, escape sequences."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import time

import h5py
import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.restart_cases import DECKS, MODELS
from corota.cli import main
from corota.io import atomic_file, job, task_queue
from corota.io.checksum import fletcher32
from corota.io.result_reader import read_results

DECK = DECKS["large rotations"]()


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("ending", ["dat", "csv", "sta", "vtkhdf", "ckpt"])
def test_results_replace_no_input(ending, here, capsys):
    (here / f"d.{ending}").write_text(DECK)
    (here / "d.inp").write_text(f"*INCLUDE, INPUT=d.{ending}\n")
    assert main(["run", "d.inp", "-q"]) == 2
    assert "is an input of this job" in capsys.readouterr().err
    assert (here / f"d.{ending}").read_text() == DECK
    assert main(["run", "d.inp", "-q", "-o", "out"]) == 0


def test_results_replace_no_input_behind_a_link(here, capsys):
    (here / "d.dat").write_text(DECK)
    (here / "d.inp").write_text("*INCLUDE, INPUT=d.dat\n")
    (here / "out").symlink_to(here)
    assert main(["run", "d.inp", "-q", "-o", "out"]) == 2
    assert (here / "d.dat").read_text() == DECK


def test_convert_replaces_no_input(here, capsys):
    (here / "x.inp").write_text("*INCLUDE, INPUT=part.inp\n")
    (here / "part.inp").write_text(DECK)
    for target in ("x.inp", "./x.inp", "part.inp"):
        assert main(["convert", "x.inp", target]) == 2
        assert "name another file" in capsys.readouterr().err
    assert (here / "part.inp").read_text() == DECK
    assert main(["convert", "x.inp", "y.inp"]) == 0


@pytest.mark.parametrize("name", ["../x", "a/b", "..", "/tmp/x"])
def test_a_name_stays_in_the_folder(name, here, capsys):
    (here / "x.inp").write_text(DECK)
    assert main(["run", "x.inp", "-q", "--name", name]) == 2
    assert "without a folder" in capsys.readouterr().err
    assert [p.name for p in here.iterdir()] == ["x.inp"]


def test_an_include_bomb_is_refused_soon(here, capsys):
    """Ten includes of the next file, twelve deep: 10^12 files."""
    for k in range(12):
        (here / f"b{k}.inp").write_text(f"*INCLUDE, INPUT=b{k + 1}.inp\n" * 10)
    (here / "b12.inp").write_text("** nothing\n")
    assert main(["check", "b0.inp"]) == 2
    assert capsys.readouterr().err.count("files are included") == 1


@pytest.mark.parametrize(
    "word", ["\x1b[31mred", "\x1b]0;title\x07", "\x9b2J", "\u202eback", "\b\b"]
)
def test_what_a_deck_says_does_not_command_the_terminal(word, here, capsys):
    text = DECK.replace("*MATERIAL, NAME=M\n", f"*MATERIAL, NAME=M{word}\n")
    (here / "x.inp").write_text(text + f"*{word}\n")
    assert main(["check", "x.inp", "-v"]) == 2
    said = capsys.readouterr()
    assert "no material named" in said.err
    assert not set("\x1b\x07\x9b\u202e\b") & set(said.out + said.err)


def test_an_explicit_step_ends_after_its_increments(tmp_path):
    deck = tmp_path / "x.inp"
    deck.write_text(DECKS["motion, explicit"]().replace("INC=2000", "INC=7"))
    with pytest.raises(ct.ConvergenceError, match=r"used its 7 increments .* allow more"):
        ct.solve(ct.read(deck), threads=1)
    deck.write_text(DECKS["motion, explicit"]().replace(", INC=2000", ""))
    assert len(ct.solve(ct.read(deck), threads=1).frames) == 60


def test_an_explicit_step_that_turns_an_element_inside_out_names_it(tmp_path, capsys):
    deck = tmp_path / "x.inp"
    deck.write_text(DECKS["motion, explicit"]().replace("RIGHTA, 2, -.8", "RIGHTA, 1, -9e9"))
    assert main(["run", str(deck), "-q", "-o", str(tmp_path)]) == 4
    assert "element" in capsys.readouterr().err


@pytest.mark.parametrize("size", [1e30, 1e300, 1e308])
def test_huge_loads_are_no_internal_error(size):
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", x=size)
    with pytest.raises(ct.ConvergenceError):
        ct.solve(model, threads=1)


def test_any_number_of_instances(tmp_path):
    """Twenty-five copies of a part beside each other: the same as one by itself."""
    part = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=CPS4, ELSET=E\n1,1,2,3,4\n"
    part += "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*NSET, NSET=L\n1,4\n"
    tips = []
    for n in (1, 25):
        each = [f"I{k}" for k in range(n)]
        text = f"*PART, NAME=P\n{part}*END PART\n*ASSEMBLY, NAME=A\n"
        for k, name in enumerate(each):
            text += f"*INSTANCE, NAME={name}, PART=P\n{2 * k}., 0., 0.\n*END INSTANCE\n"
        text += "*END ASSEMBLY\n*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*BOUNDARY\n"
        text += "".join(f"{name}.L, 1, 2\n" for name in each) + "*STEP\n*STATIC\n*CLOAD\n"
        text += "".join(f"{name}.3, 2, 1.\n" for name in each) + "*END STEP\n"
        (tmp_path / "x.inp").write_text(text)
        moved = ct.solve(ct.read(tmp_path / "x.inp"), threads=1).frames[-1].U
        tips.append(moved.reshape(n, 4, 2)[:, 2])
    assert abs(tips[1] - tips[0]).max() < 1e-12 * abs(tips[0]).max()


def test_arrays_that_change_after_they_were_given_change_nothing():
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    nodes = np.array([4])
    model.force(nodes, x=1.0)
    nodes[0] = 7
    found = ct.solve(model, threads=1).frames[-1].F
    assert np.flatnonzero(found[:, 0]).tolist() == [4]


def test_frames_that_wait_for_the_disk_are_bounded(tmp_path, monkeypatch):
    """The analysis waits for the writer rather than fill the memory."""
    waiting = []

    def slow(self, frame, attempts):
        waiting.append(self._queue._waiting)
        time.sleep(0.005)
        true(self, frame, attempts)

    true = job.JobFiles._write
    monkeypatch.setattr(job.JobFiles, "_write", slow)
    monkeypatch.setattr(task_queue, "MOST_WAITING", 100_000)
    model = MODELS["central differences"]()
    results = ct.solve(model, observers=[job.JobFiles(tmp_path)], threads=1)
    one = max(
        8 * (f.U.size * 6 + sum(b.volume.size * 24 for b in f.fields)) for f in results.frames
    )
    assert max(waiting) <= 100_000 + 2 * one
    assert len(waiting) == len(results.frames)


def numbers(path):
    """All numbers of a result file as bytes."""
    with read_results(path) as results:
        found = [results.mesh.points.tobytes(), results.mesh.node_labels.tobytes()]
        for frame in results.frames:
            found += [frame.U.tobytes(), frame.RF.tobytes(), str(frame.scalars).encode()]
            found += [values.tobytes() for values in frame.averages.values()]
    return found


@pytest.mark.parametrize("name", ["newmark", "bump"])
def test_damaged_frames_are_refused_and_never_read_as_others(tmp_path, name):
    """Every chunk and every header has a checksum; arrays of `bump` are chunks of their own."""
    ct.solve(MODELS[name](), observers=[ct.JobFiles(tmp_path, "job")], threads=1)
    path = tmp_path / "job.vtkhdf"
    whole = path.read_bytes()
    right = numbers(path)
    rng = np.random.default_rng(3)
    refused = 0
    for _ in range(15):
        data = bytearray(whole)
        for at in rng.integers(len(data), size=8):
            data[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(data)
        try:
            assert numbers(path) == right
        except ct.CorotaError:
            refused += 1
    assert refused >= 8


@pytest.mark.parametrize("length", [1, 2, 511, 512, 514, 100_001, 2 * 65535])
@pytest.mark.parametrize("fill", [None, 0, 255])
def test_checksums_are_those_of_hdf5(tmp_path, length, fill):
    rng = np.random.default_rng(length)
    data = rng.integers(256, size=length) if fill is None else np.full(length, fill)
    with h5py.File(tmp_path / "x.h5", "w") as file:
        chunk = {"chunks": (length,), "fletcher32": True}
        made = file.create_dataset("x", data=data.astype(np.uint8), **chunk)
        file.flush()
        _, raw = made.id.read_direct_chunk((0,))
    assert fletcher32(raw[:-4]) == int.from_bytes(raw[-4:], "little")


def test_controls_of_a_later_step_do_not_damp_an_earlier_one(tmp_path):
    """*CONTACT CONTROLS, STABILIZE acts from its own step on."""
    first, second = "*STATIC\n.25, 1.\n", "*STATIC\n.1, 1., , .2\n"
    plain = DECKS["contact"]()
    control = "*CONTACT CONTROLS, STABILIZE\n"
    frames = {}
    for name, text in {
        "none": plain,
        "second": plain.replace(second, second + control),
        "first": plain.replace(first, first + control),
    }.items():
        (tmp_path / f"{name}.inp").write_text(text)
        model = ct.read(tmp_path / f"{name}.inp")
        assert [c.stabilize_from for c in model.contacts] == [2 if name == "second" else 1]
        frames[name] = [f.U for f in ct.solve(model, threads=1).frames if f.step == 1]
    assert len(frames["none"]) > 2
    for one, other in zip(frames["none"], frames["second"], strict=True):
        np.testing.assert_array_equal(one, other)
    damped = zip(frames["none"], frames["first"], strict=False)
    assert any((one != other).any() for one, other in damped)


def test_a_commit_reaches_the_disk_before_its_name(tmp_path, monkeypatch):
    """A power cut leaves a state of the file, not a name without numbers."""
    reported = []
    for name in ("fsync", "replace"):
        true = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *a, t=true, n=name: (reported.append(n), t(*a))[1])
    monkeypatch.setattr(atomic_file, "YOUNG", 0.0)
    file = atomic_file.AtomicFile(tmp_path / "x")
    for number in range(3):
        reported.clear()
        file.write(b"%d" % number)
        file.commit()
        assert reported[:2] == ["fsync", "replace"]
    file.close()
    assert (tmp_path / "x").read_bytes() == b"012"


@pytest.mark.parametrize("target", ["out.vtu", "out.npz", "out.frd"])
def test_a_file_with_numbers_that_are_none_is_not_converted(tmp_path, target, capsys):
    ct.solve(MODELS["newmark"](), observers=[ct.JobFiles(tmp_path, "job")], threads=1)
    with h5py.File(tmp_path / "job.vtkhdf", "r+") as file:
        file["VTKHDF/PointData/displacement"][-1, 0] = np.nan
    code = main(["convert", str(tmp_path / "job.vtkhdf"), str(tmp_path / target)])
    assert code in (1, 2, 6)
    assert "finite" in capsys.readouterr().err

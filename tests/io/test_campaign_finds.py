"""What the fault campaign found, mended and kept."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from decks import DECK, MESH, SECTION, SUPPORT, faults
from seeds import SEEDS

import corota as ct
from corota.io.vtk.vtkhdf import VtkhdfWriter

STEP = "*STEP\n*STATIC\n*DLOAD\n{}\n*END STEP\n"
BUCKLE = "*STEP\n*BUCKLE\n1\n*MODAL DAMPING\n1, 2, .02\n*CLOAD\n3, 1, -5.\n*END STEP\n"
HUGE = "9" * 5000
COMBINED = (
    "*PLASTIC, HARDENING=COMBINED, DATA TYPE=PARAMETERS, NUMBER BACKSTRESSES={}\n200., 1., 1.\n"
)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        # Options of modal damping went to a procedure that has none: TypeError.
        (MESH + SECTION + SUPPORT + BUCKLE, "*MODAL DYNAMIC"),
        # More digits than Python turns into a number: ValueError.
        (MESH + SECTION + SUPPORT + STEP.format(f"eall, P{HUGE}, 1."), "unknown load type"),
        (DECK.replace("*BOUNDARY", f"*SURFACE, NAME=f\neall, S{HUGE}\n*BOUNDARY", 1), "face"),
        # Digits that are none: ValueError; and a count that reserved memory.
        (DECK.replace("*SOLID", COMBINED.format("\u00b2") + "*SOLID"), "1 to 20"),
        (DECK.replace("*SOLID", COMBINED.format("1000000000") + "*SOLID"), "1 to 20"),
        # A load on nothing was accepted.
        (
            MESH + "*ELSET, ELSET=none\n,\n" + SECTION + SUPPORT + STEP.format("none, P1, 1."),
            "element set none is empty",
        ),
        (
            MESH + SECTION + "*RIGID BODY, REF NODE=2, ELSET\n" + SUPPORT + STEP.format("2, 1, 1."),
            "ELSET",
        ),
        (
            MESH + SECTION + "*RIGID BODY, REF NODE=2, NSET=\n" + SUPPORT + STEP.format("2, 1, 1."),
            "NSET",
        ),
    ],
)
def test_refused_with_a_message(tmp_path: Path, text: str, words: str) -> None:
    said = "\n".join(str(d) for d in faults(tmp_path, text))
    assert words in said
    assert len(said) < 5000


def test_reading_reserves_no_more_memory_than_the_deck_has(tmp_path: Path) -> None:
    """It allocated the eight gigabytes that a deck may have at most."""
    (tmp_path / "deck.inp").write_text(SEEDS[0])

    def small() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

    command = [sys.executable, "-m", "corota", "run", "deck.inp", "-q", "--threads", "1"]
    done = subprocess.run(
        command, cwd=tmp_path, preexec_fn=small, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_damaged_results_are_refused(tmp_path: Path) -> None:
    """Bytes flipped where numbers and shapes are: an error of files, whatever HDF5 thinks."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1), name="deck")
    model.section("all", element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
    model.fix("left")
    model.force("right", y=1e-4, per_node=True)
    ct.solve(model, ct.Static(), observers=[ct.JobFiles(tmp_path)], threads=1)
    whole = (tmp_path / "deck.vtkhdf").read_bytes()
    rng = np.random.default_rng(3)
    outcomes = set()
    for _ in range(60):
        data = bytearray(whole)
        for at in rng.integers(len(data), size=8):
            data[at] = rng.integers(256)
        (tmp_path / "bad.vtkhdf").write_bytes(bytes(data))
        try:
            with ct.read_results(tmp_path / "bad.vtkhdf") as results:
                for frame in results.frames:
                    assert frame.U.shape == (results.mesh.n_nodes, 2)
                assert len(results.times) == len(results.frames)
            outcomes.add("read")
        except ct.errors.FileError:
            outcomes.add("refused")
    assert outcomes == {"read", "refused"}


def test_elements_of_a_block_that_are_not_there(tmp_path: Path) -> None:
    """Averages at nodes ended in an index error, behind exit 70."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1), name="deck")
    model.section("all", element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
    model.fix("left")
    model.force("right", y=1e-4, per_node=True)
    ct.solve(model, ct.Static(), observers=[ct.JobFiles(tmp_path)], threads=1)
    with h5py.File(tmp_path / "deck.vtkhdf", "r+") as file:
        file["corota/points/0/cells"][2] = 205
    with pytest.raises(ct.errors.FileError, match="damaged or incomplete: elements of a block"):
        ct.read_results(tmp_path / "deck.vtkhdf")


def test_arrays_that_only_an_earlier_step_had_do_not_spoil_the_file(tmp_path: Path) -> None:
    """Velocities of a dynamic step, then a static one: the whole file could not be read."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1), name="two")
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3, rho=1.0))
    model.fix("left")
    model.force("right", y=-0.1, per_node=True)
    steps = [ct.Dynamic(period=0.2, increments=2), ct.Static(increments=2)]
    results = ct.solve(model, steps, threads=1)
    writer = VtkhdfWriter(tmp_path / "two.vtkhdf", model)
    for frame in results.frames:
        writer.add(frame)
        # One frame a commit, as in runs whose increments take their time.
        writer.commit()
    writer.close()
    with ct.read_results(tmp_path / "two.vtkhdf") as stored:
        assert len(stored.frames) == len(results.frames)
        for mine, theirs in zip(results.frames, stored.frames, strict=True):
            assert np.array_equal(mine.U, theirs.U)
            if mine.V is not None:
                assert np.allclose(mine.V, theirs.V)
            for name, value in mine.scalars.items():
                assert theirs.scalars[name] == value


@pytest.mark.parametrize("blank", ["\x1c", "\x1f", "\x85", "\xa0", "\u2003", "\u3000"])
def test_blanks_that_only_python_knows_are_no_number(tmp_path: Path, blank: str) -> None:
    """``str.split`` takes them for blanks, the reader of numbers does not: it found no word."""
    text = f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n{blank}\n$EndNodes\n"
    (tmp_path / "mesh.msh").write_bytes(text.encode())
    with pytest.raises(ct.CorotaError, match=r"mesh\.msh:6"):
        ct.mesh.read(tmp_path / "mesh.msh")

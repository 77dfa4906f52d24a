"""A received folder holds links, pipes and odd names; a run stays inside and never waits.

SECURITY.md lists what a received file may do; each line there has its test here.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

import corota as ct
from corota.cli import main
from corota.errors import DeckError, FileError
from corota.io.checkpoint import load
from corota.io.paraview import write_paraview
from corota.io.result_reader import read_results

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes of POSIX")

DECK = """\
*NODE, NSET=NALL
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*INCLUDE, INPUT=cells.inc
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*STATIC
.25, 1.
*CLOAD
2, 2, -1.
*NODE PRINT, NSET=NALL
U
*END STEP
"""
CELLS = "*ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n"


@pytest.fixture
def folder(tmp_path):
    """Folder with a deck and a file beyond it that must stay as it is."""
    own = tmp_path / "received"
    own.mkdir()
    (own / "job.inp").write_text(DECK)
    (own / "cells.inc").write_text(CELLS)
    (tmp_path / "beyond").write_text("untouched")
    return own


def corota(*words, cwd):
    return subprocess.run(
        [sys.executable, "-m", "corota", *words],
        cwd=cwd, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip


JOB = ["job.inp", "--format", "npz", "--format", "vtkhdf"]


def run(folder, *words):
    return corota("run", *JOB, *words, cwd=folder)


WRITTEN = ["dat", "sta", "cvg", "jsonl", "csv", "vtkhdf", "npz", "ckpt", "provenance.json"]
HIDDEN = [".job.lock", *(f".job.{ending}.next" for ending in WRITTEN)]


@pytest.mark.parametrize("name", [*(f"job.{ending}" for ending in WRITTEN), *HIDDEN])
def test_no_link_is_followed_out_of_the_folder(folder, name, monkeypatch, capsys):
    (folder / name).symlink_to("../beyond")
    monkeypatch.chdir(folder)
    code = main(["run", *JOB, "--checkpoint-every", "1", "--provenance"])
    assert (folder.parent / "beyond").read_text() == "untouched"
    said = capsys.readouterr().err
    assert code in (0, 6), said
    if code:
        assert name in said
        assert "it is a link" in said


@pytest.mark.parametrize("name", ["job.sta", "job.jsonl", ".job.lock"])
def test_a_pipe_in_place_of_a_file_is_refused(folder, name):
    os.mkfifo(folder / name)
    done = run(folder)
    assert done.returncode == 6
    assert name in done.stderr


@pytest.mark.parametrize("ending", [".msh", ".unv", ".frd", ".vtu", ".pvd", ".vtkhdf", ".ckpt"])
def test_a_pipe_is_no_input(tmp_path, ending):
    pipe = tmp_path / f"in{ending}"
    os.mkfifo(pipe)
    read = {".ckpt": load, ".msh": ct.mesh.read, ".unv": ct.mesh.read}.get(ending, read_results)
    with pytest.raises(FileError):
        read(pipe)


@pytest.mark.parametrize("target", ["../beyond", "/etc/hostname", "link"])
def test_a_collection_names_files_of_its_folder_only(tmp_path, target):
    own = tmp_path / "received"
    own.mkdir()
    (tmp_path / "beyond").write_text("untouched")
    (own / "link").symlink_to("../beyond")
    entry = f'<DataSet timestep="0" file="{target}"/>'
    path = own / "a.pvd"
    path.write_text(f'<VTKFile type="Collection"><Collection>{entry}</Collection></VTKFile>')
    with pytest.raises(FileError, match="outside the folder"):
        read_results(path)


def test_an_earlier_job_outside_the_folder_needs_leave(folder):
    (folder / "more.inp").write_text(
        "*RESTART, READ, JOB=../other/job\n*STEP\n*STATIC\n*END STEP\n"
    )
    with pytest.raises(DeckError, match="outside the folder of the deck"):
        ct.read(folder / "more.inp")


def test_a_name_is_no_code_in_the_script_for_paraview(folder, monkeypatch):
    assert run(folder).returncode == 0
    odd = folder / "a'''\"\"\"\nraise SystemExit(9)\n#.vtkhdf"
    (folder / "job.vtkhdf").rename(odd)
    script = write_paraview(odd, target=str(folder / "show.py"))
    tree = compile(script.read_text(), "show.py", "exec")
    assert "raise SystemExit" not in script.read_text().replace(repr(odd.name), "")
    assert tree.co_consts[0].startswith("Show a result file")


def test_an_included_file_is_part_of_the_deck_for_resume(folder):
    done = run(folder, "--checkpoint-every", "1")
    assert done.returncode == 0, done.stderr
    (folder / "cells.inc").write_text("** edited\n" + CELLS)
    done = corota("resume", "job.inp", cwd=folder)
    assert done.returncode == 6
    assert "cells.inc: it has changed since" in done.stderr


def test_an_included_file_is_part_of_the_deck_for_restart(folder):
    job = folder / "job.inp"
    job.write_text(DECK.replace("*CLOAD", "*RESTART, WRITE, FREQUENCY=1\n*CLOAD"))
    assert run(folder).returncode == 0
    (folder / "more.inp").write_text("*RESTART, READ, JOB=job\n*STEP\n*STATIC\n*END STEP\n")
    assert corota("run", "more.inp", cwd=folder).returncode == 0
    (folder / "cells.inc").write_text("** edited\n" + CELLS)
    done = corota("run", "more.inp", cwd=folder)
    assert done.returncode == 6
    assert "or a file that it includes" in done.stderr


def test_an_included_file_is_part_of_the_deck_for_sweeps(folder):
    text = DECK.replace("*NODE, NSET", "*PARAMETER\nload = 1.\n*NODE, NSET").replace(
        "-1.", "<load>"
    )
    (folder / "job.inp").write_text(text)

    def tip():
        found = ct.sweep(
            folder / "job.inp", {"load": [1.0, 2.0]}, {"tip": "last(U2@NALL)"},
            workers=1, store=folder / "rows.jsonl",
        )  # fmt: skip
        assert not any(found["error"]), found["error"]
        return found["tip"][0]

    first = tip()
    assert tip() == first
    (folder / "cells.inc").write_text(CELLS.replace("CPS4", "CPE4"))
    assert tip() != first


@pytest.mark.parametrize("change", ["value", "row", "run", "mixed"])
def test_a_row_of_a_sweep_that_was_changed_is_refused(folder, change):
    store = folder / "rows.jsonl"
    text = DECK.replace("*NODE, NSET", "*PARAMETER\nload = 1.\n*NODE, NSET").replace(
        "-1.", "<load>"
    )
    (folder / "job.inp").write_text(text)

    def sweep():
        ct.sweep(folder / "job.inp", {"load": [1.0, 2.0]}, "last(U2@NALL)", workers=1, store=store)

    sweep()
    first, second = (json.loads(line) for line in store.read_text().splitlines())
    if change == "value":
        first["outcome"]["values"]["last(U2@NALL)"] *= 2.0
    elif change == "mixed":
        first["outcome"] = second["outcome"]
    else:
        first[change] = second["row"] if change == "row" else "another"
    store.write_text(json.dumps(first) + "\n" + json.dumps(second) + "\n")
    with pytest.raises(FileError, match=r"rows.jsonl:1: this row has changed"):
        sweep()


def test_logs_nested_too_deeply_are_no_crash(folder):
    assert run(folder).returncode == 0
    with open(folder / "job.jsonl", "a") as log:
        log.write("[" * 100_000 + "\n" + "[1]\n" + '"text"\n')
    done = corota("report", "job.vtkhdf", cwd=folder)
    assert done.returncode == 0, done.stderr


def test_rows_of_a_sweep_nested_too_deeply_are_refused(folder):
    (folder / "rows.jsonl").write_text("[" * 100_000 + "\n")
    with pytest.raises(FileError, match="not a row of a sweep"):
        ct.sweep(folder / "job.inp", {"a": [1]}, "last(U2@NALL)", store=folder / "rows.jsonl")

"""Runs on two processes: the results of the default solver, for analyses of all kinds."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import corota as ct
from corota.cli import main
from scale import cases

#: Newton's method stops at a relative residual of 1e-9; the last correction is far below that.
AGREE = 1e-9
#: Critical points are located to a share of their increment. Errors of one unit in the last place
#: of the coordinates move those of the default solver, too, by up to 4.6e-7 of the displacement
#: (5 of 12 tries: the second limit point of the arch); the path between them agrees.
SENSITIVE = {"snap_through": 1e-6, "unstable": 1e-8}
#: Time that a started program may take on a busy machine [s].
PATIENCE = 240.0

needs_mpi = pytest.mark.skipif(
    shutil.which("mpiexec") is None or not find_spec("petsc4py") or not find_spec("mpi4py"),
    reason="scripts/install_petsc.sh installs PETSc and MPI",
)


def together(*command: str, folder: Path, count: int = 2) -> subprocess.CompletedProcess[str]:
    """Run a command on several processes."""
    tests = Path(__file__).parents[1]
    paths = [str(tests), *sys.path]
    own = {
        "PYTHONPATH": os.pathsep.join(p for p in paths if p),
        "OMP_NUM_THREADS": "1",
        "NO_COLOR": "1",
        # Open MPI: more processes than cores, none of which gives its core away; containers.
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "OMPI_MCA_mpi_yield_when_idle": "0",
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    }
    return subprocess.run(
        ["mpiexec", "-n", str(count), sys.executable, *command],
        cwd=folder,
        env=os.environ | own,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """Differences by process and case."""
    folder = tmp_path_factory.mktemp("distributed")
    done = together("-m", "scale.cases", "found.json", folder=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    every: list[dict[str, Any]] = json.loads((folder / "found.json").read_text())
    return every


@needs_mpi
@pytest.mark.parametrize("name", cases.CASES)
def test_two_processes_give_the_results_of_one(name: str, found: list[dict[str, Any]]) -> None:
    first, second = (own[name] for own in found)
    assert first["frames"] == 0
    assert max(first["U between"], second["U between"]) <= AGREE
    for kind in ("U", "UR", "RF", "S", *cases.SCALARS):
        assert first[kind] <= SENSITIVE.get(name, AGREE), kind
        assert second[kind] <= SENSITIVE.get(name, AGREE), kind


@needs_mpi
@pytest.mark.parametrize("name", cases.CASES)
def test_all_processes_have_the_same_bits(name: str, found: list[dict[str, Any]]) -> None:
    first, second = (own[name] for own in found)
    for kind in ("U", "UR", "RF", *cases.SCALARS):
        assert first[kind] == second[kind], kind


@needs_mpi
@pytest.mark.parametrize("name", cases.CASES)
def test_each_process_has_its_own_elements(name: str, found: list[dict[str, Any]]) -> None:
    first, second = (own[name] for own in found)
    assert first["cells"] == first["all cells"], "process 0 gathers what it writes"
    assert 0.4 * first["cells"] <= second["cells"] <= 0.6 * first["cells"]


@needs_mpi
def test_an_unconstrained_body_is_named_on_both(found: list[dict[str, Any]]) -> None:
    assert found[0]["unconstrained"] == found[1]["unconstrained"]
    assert "node" in found[0]["unconstrained"]


@needs_mpi
def test_the_motion_of_a_vanished_pivot_is_found(found: list[dict[str, Any]]) -> None:
    assert found[0]["chain"] == found[1]["chain"]
    np.testing.assert_allclose(np.abs(found[0]["chain"]), np.ones(12), rtol=1e-6)


@needs_mpi
def test_multigrid_with_rotations_gives_the_same_results(found: list[dict[str, Any]]) -> None:
    assert found[0]["multigrid"] == found[1]["multigrid"]
    assert max(found[0]["multigrid"].values()) <= 1e-7


def deck(folder: Path) -> Path:
    """A clamped strip of six elements with forces at its end."""
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1), name="job")
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=4.0)
    model.steps = [ct.Static(increments=4)]
    path = folder / "job.inp"
    ct.write(model, path)
    return path


RUN = ("-m", "corota", "run", "job.inp", "--solver", "petsc")


@needs_mpi
def test_one_process_writes_the_files_of_a_job(tmp_path: Path) -> None:
    path = deck(tmp_path)
    done = together(*RUN, "-o", "two", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("Done in") == 1
    assert main(["run", str(path), "-q", "-o", str(tmp_path / "one")]) == 0
    one, two = (ct.read_results(tmp_path / name / "job.vtkhdf") for name in ("one", "two"))
    assert len(one.frames) == len(two.frames) == 5
    for name in ("U", "RF"):
        a, b = getattr(one.frames[-1], name), getattr(two.frames[-1], name)
        np.testing.assert_allclose(b, a, rtol=0.0, atol=AGREE * np.abs(a).max())
    ours, theirs = (r.nodal("MISES") for r in (one, two))
    np.testing.assert_allclose(theirs, ours, rtol=1e-8)
    with h5py.File(tmp_path / "two" / "job.vtkhdf") as file:
        root = file["VTKHDF"]
        assert root["NumberOfCells"][:].tolist() == [3, 3], "one part for each process"
        assert root["NumberOfPoints"][:].tolist() == [8, 8]
        assert (root["Steps/NumberOfParts"][:] == 2).all()


@needs_mpi
def test_a_run_is_resumed_by_as_many_processes(tmp_path: Path) -> None:
    """With contact, whose matrix has multipliers."""
    model, _ = cases.contact()
    model.name, model.steps = "job", [ct.Static(increments=4)]
    ct.write(model, tmp_path / "job.inp")
    done = together(*RUN, "-q", "--checkpoint-every", "2", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    whole = ct.read_results(tmp_path / "job.vtkhdf").frames[-1]
    older = tmp_path / "job.ckpt.1"
    resume = ("-m", "corota", "resume", str(older), "--solver", "petsc", "-q")
    alone = subprocess.run(
        [sys.executable, *resume], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert alone.returncode == 2
    assert "the states of 2 processes, and there are 1" in alone.stderr
    done = together(*resume, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    again = ct.read_results(tmp_path / "job.vtkhdf")
    assert len(again.frames) == 5
    np.testing.assert_array_equal(again.frames[-1].U, whole.U)


@needs_mpi
def test_an_error_of_one_process_ends_all(tmp_path: Path) -> None:
    """Process 0 alone opens files: the other one waits for it."""
    deck(tmp_path)
    (tmp_path / "file").write_text("")
    done = together(*RUN, "-q", "-o", "file", folder=tmp_path)
    assert done.returncode == 6
    assert done.stderr.count("corota: error") == 1


@needs_mpi
def test_an_error_of_all_is_printed_once(tmp_path: Path) -> None:
    path = deck(tmp_path)
    path.write_text(path.read_text().replace("*ELASTIC", "*ELASTICS"))
    done = together(*RUN, folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("corota: error") == 1
    done = together("-m", "corota", "run", "job.inp", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("add --solver petsc") == 1

"""A run that goes on from any of its checkpoints ends with the same bits."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import gc
import io
import os
import shutil
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.same_bits import Takes, folder_differences, frame_differences
from benchmarks.corpora.restart_cases import DECKS, MODELS
from corota.analysis.procedures.static import StaticStepper
from corota.analysis.run import solve
from corota.analysis.state_tree import UnsuitableState
from corota.errors import FileError
from corota.io.checkpoint import load, newest
from corota.io.folder_lock import FolderLock
from support.checkpoints import goes_on, whole_run
from support.pairs import quickly

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

ELASTIC = ct.Elastic(E=1000.0, nu=0.3, rho=1.0)
PLASTIC = ct.Mises(E=1000.0, nu=0.3, yield_curve=[(2.0, 0.0), (3.0, 0.1)], rho=1.0)


def beam(steps, element="Q4I", material=ELASTIC, load=-1.0, ny=1):
    """A cantilever under a load at its end."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=ny), name="beam")
    model.section("all", element=element, material=material)
    model.fix("left")
    model.force("right", y=load)
    model.steps = steps
    return model


def motion(scheme, **more):
    return beam([ct.Dynamic(period=2.0, increments=6, scheme=scheme, **more)], element="Q4D")


def flight(scheme):
    """A bar that flies to a wall, with automatic increments, and is stopped by it."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2), name="bar")
    model.section("all", element="Q4I", material=ELASTIC)
    model.velocity(x=1.0)
    model.gravity(y=-0.1)
    model.contact("right", ct.RigidCurve.line((2.3, -5.0), (2.3, 5.0)), name="wall")
    model.steps = [ct.Dynamic(period=0.34, scheme=scheme)]
    return model


def thinned():
    """A beam whose upper half loses two elements in the second step, and gets one back."""
    steps = [ct.Static(nlgeom=True, increments=2) for _ in range(3)]
    model = beam(steps, element="Q4D", load=-0.1, ny=2)
    model.mesh.cell_sets |= {"gone": np.array([14, 15]), "back": np.array([15])}
    model.steps[1].remove_elements("gone")
    model.steps[2].add_elements("back")
    return model


def rubbing():
    """A block whose friction falls with its speed."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1), name="block")
    model.section("all", element="Q4", material=ELASTIC)
    model.contact(
        "bottom",
        ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0)),
        friction=ct.DecayingFriction(0.5, 0.2, 3.0),
        name="floor",
    )
    model.gravity(y=-10.0)
    model.velocity(x=1.0)
    model.steps = [ct.Dynamic(period=0.3, increments=8)]
    return model


def peaked():
    """A block that is pressed on a floor and let go, with its largest force between increments."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2))
    model.section("all", element="Q4I", material=ELASTIC)
    model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)), name="floor")
    model.amplitudes["push"] = ct.Amplitude(np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.0, 0.1]))
    step = ct.Static(increments=5)
    step.fix("top", x=0.0, y=-0.01, amplitude="push")
    model.steps = [step]
    return model


QUICK = {
    "a peak between increments": peaked,
    "elements that leave and come back": thinned,
    "friction that falls": rubbing,
    "static": lambda: beam([ct.Static(increments=4)]),
    "static with cut-backs": lambda: beam([ct.Static(increments=1, max_iterations=4)], load=-9.0),
    "two steps": lambda: beam([ct.Static(increments=2), ct.Static(increments=3, new_loads=True)]),
    "plastic": lambda: beam([ct.Static(increments=8)], material=PLASTIC, load=-0.02),
    "path": lambda: beam([ct.Static(path=ct.ArcLength(factor=1.0))], load=-3.0),
    "newmark": lambda: motion("newmark"),
    "hht, automatic": lambda: beam([ct.Dynamic(period=2.0, scheme="hht")]),
    "generalized_alpha": lambda: motion("generalized_alpha"),
    "energy_momentum": lambda: motion("energy_momentum"),
    "first contact, hht": lambda: flight("hht"),
    "first contact, energy_momentum": lambda: flight("energy_momentum"),
    "central_difference": lambda: beam([ct.Dynamic(period=0.5, scheme="central_difference")]),
    "statics, motion, statics": lambda: beam(
        [ct.Static(increments=2), ct.Dynamic(period=1.0, increments=3), ct.Static(increments=2)]
    ),
    "modes between": lambda: beam(
        [ct.Static(increments=2), ct.Frequency(modes=2), ct.Static(increments=2)]
    ),
}


@pytest.mark.parametrize("name", QUICK)
def test_every_increment_goes_on_to_the_same_bits(name):
    goes_on(QUICK[name])


def test_a_checkpoint_without_what_its_stepper_needs_is_refused(monkeypatch):
    """As one of another build of the same version may be."""
    found, _, _ = whole_run(QUICK["static"])
    before = StaticStepper.remembered
    monkeypatch.setattr(StaticStepper, "memory", lambda s: {n: getattr(s, n) for n in before})
    monkeypatch.setattr(StaticStepper, "remembered", (*before, "new_number"))
    with pytest.raises(UnsuitableState, match="it has no 'new_number'"):
        solve(QUICK["static"](), threads=1, start=found[0])


def test_checkpoint_of_another_model_is_refused():
    takes = Takes()
    solve(beam([ct.Static(increments=2)]), observers=[takes], threads=1)
    other = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=11, ny=1))
    other.section("all", element="Q4I", material=ELASTIC)
    other.fix("left")
    with pytest.raises(ct.CorotaError, match=r"differs|fit"):
        solve(other, ct.Static(increments=2), threads=1, start=takes.found[0])


# -- files -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Folders of a run without a stop and of one with checkpoints."""
    folder = tmp_path_factory.mktemp("runs")
    for name, every in (("whole", 0), ("kept", 2)):
        files = ct.JobFiles(folder / name, checkpoint_every=every)
        ct.solve(motion("newmark"), observers=[files], threads=1)
    return folder


def damaged(done, tmp_path):
    folder = tmp_path / "job"
    shutil.copytree(done / "kept", folder)
    return folder


@pytest.mark.parametrize("which", ["beam.ckpt", "beam.ckpt.1"])
def test_files_grow_on_without_gap_or_repeat(done, tmp_path, which):
    folder = damaged(done, tmp_path)
    if which == "beam.ckpt.1":
        (folder / "beam.ckpt").unlink()
    ct.resume(folder / "beam", threads=1)
    assert folder_differences(done / "whole", folder) == []


def test_python_results_hold_what_follows(done, tmp_path):
    folder = damaged(done, tmp_path)
    results = ct.resume(folder / "beam.ckpt.1", threads=1)
    assert [f.increment for f in results.frames] == [5, 6]


def test_new_steps_follow_a_checkpoint(done, tmp_path):
    folder = damaged(done, tmp_path)
    before = (folder / "beam.csv").read_bytes()
    new = ct.Static(increments=2)
    results = ct.resume(folder / "beam", new, threads=1)
    model = motion("newmark")
    whole = ct.solve(model, [*model.steps, new], threads=1)
    assert [f.step for f in results.frames] == [2, 2]
    for a, b in zip(whole.frames[-2:], results.frames, strict=True):
        assert not frame_differences(a, b)
    assert (folder / "beam.csv").read_bytes() == before


def test_damaged_checkpoints_are_refused_and_the_other_is_used(done, tmp_path):
    folder = damaged(done, tmp_path)
    path = folder / "beam.ckpt"
    whole = path.read_bytes()
    rng = np.random.default_rng(7)
    for trial in range(60):
        data = bytearray(whole)
        if trial % 3 == 0:
            data = data[: int(rng.integers(len(data)))]
        else:
            at = int(rng.integers(len(data)))
            data[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(data)
        with pytest.raises(FileError, match=r"ckpt: (damaged|not a checkpoint|a checkpoint of)"):
            load(path)
    found, refused = newest(folder / "beam")
    assert found.path.name == "beam.ckpt.1"
    assert len(refused) == 1


def test_checkpoint_of_another_version_is_refused(done, tmp_path, monkeypatch):
    folder = damaged(done, tmp_path)
    monkeypatch.setattr("corota._core.__version__", "0.0.0")
    with pytest.raises(FileError, match="written by version"):
        load(folder / "beam.ckpt")


def test_results_shorter_than_the_checkpoint_says_are_refused(done, tmp_path):
    folder = damaged(done, tmp_path)
    (folder / "beam.sta").write_text("")
    with pytest.raises(FileError, match=r"beam\.sta: 0 bytes"):
        ct.resume(folder / "beam", threads=1)
    files = [file for file in gc.get_objects() if isinstance(file, io.FileIO)]
    assert not [f.name for f in files if not f.closed and str(tmp_path) in str(f.name)]


def test_two_runs_in_one_folder(tmp_path):
    held = FolderLock(tmp_path / ".beam.lock")
    with pytest.raises(FileError, match="another run"):
        ct.solve(beam([ct.Static()]), observers=[ct.JobFiles(tmp_path)], threads=1)
    held.release()
    ct.solve(beam([ct.Static()]), observers=[ct.JobFiles(tmp_path)], threads=1)
    assert not list(tmp_path.glob(".*"))


def test_files_of_a_run_bear_its_name(done):
    import h5py

    for folder in (done / "whole", done / "kept"):
        with h5py.File(folder / "beam.vtkhdf") as file:
            name = file["corota"].attrs["run"]
        assert f'"run":"{name}"' in (folder / "beam.jsonl").read_text()
    assert load(done / "kept" / "beam.ckpt").run == name


def test_results_of_an_earlier_run_are_set_aside(tmp_path):
    """A run that stops early has no results of another one beside its tables."""

    ct.solve(beam([ct.Static()]), observers=[ct.JobFiles(tmp_path)], threads=1)
    files = ct.JobFiles(tmp_path)
    files.start(beam([ct.Static()]), [ct.Static()])
    names = {p.name for p in tmp_path.iterdir()}
    files.close()
    assert "beam.previous.vtkhdf" in names
    ct.solve(beam([ct.Static()]), observers=[ct.JobFiles(tmp_path)], threads=1)
    assert "beam.previous.vtkhdf" not in {p.name for p in tmp_path.iterdir()}


def test_one_object_serves_two_runs(tmp_path):
    files = ct.JobFiles(tmp_path)
    for _ in range(2):
        ct.solve(beam([ct.Static(increments=2)]), observers=[files], threads=1)
    assert len((tmp_path / "beam.sta").read_text().splitlines()) == 4


# -- signals ---------------------------------------------------------------------------------

DECK = """*NODE, NSET=ALL
1, 0, 0
2, 10, 0
3, 10, 1
4, 0, 1
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000, .3
*DENSITY
1
*SOLID SECTION, ELSET=E, MATERIAL=M
1
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP, NLGEOM, INC=100000
*DYNAMIC, DIRECT
.001, {period}
*CLOAD
2, 2, .1
*END STEP
"""


def start(folder, period, *more):
    (folder / "job.inp").write_text(DECK.format(period=period))
    command = [sys.executable, "-m", "corota", "run", "job.inp", "--threads", "1", *more]
    run = subprocess.Popen(
        command,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        preexec_fn=_listen,
    )
    while run.poll() is None and "      20 " not in _text(folder / "job.sta"):
        time.sleep(0.02)
    return run


def _listen():
    """Let no signal be ignored because the tests run in the background."""
    for name in ("SIGINT", "SIGHUP", "SIGTERM", "SIGXCPU"):
        signal.signal(getattr(signal, name), signal.SIG_DFL)


def _text(path):
    return path.read_text() if path.exists() else ""


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="signals of this system")
@pytest.mark.parametrize(
    "name", quickly(["SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU"], "SIGINT", "SIGTERM")
)
def test_signal_ends_with_a_checkpoint_and_says_how_to_go_on(tmp_path, name):
    run = start(tmp_path, 50.0)
    run.send_signal(getattr(signal, name))
    out, _ = run.communicate(timeout=60)
    assert run.returncode == 7, out
    assert "corota resume job.ckpt" in out
    assert load(tmp_path / "job.ckpt").state.increment >= 20


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="signals of this system")
def test_killed_run_goes_on_from_the_checkpoint_that_a_signal_asked_for(tmp_path):
    for name in ("whole", "killed"):
        (tmp_path / name).mkdir()
    start(tmp_path / "whole", 0.3).communicate(timeout=60)
    run = start(tmp_path / "killed", 0.3)
    run.send_signal(signal.SIGUSR1)
    while run.poll() is None and not (tmp_path / "killed/job.ckpt").exists():
        time.sleep(0.01)
    run.kill()
    run.communicate()
    if (tmp_path / "killed/job.ckpt").exists():
        command = [sys.executable, "-m", "corota", "resume", "job.inp", "--threads", "1"]
        subprocess.run(command, cwd=tmp_path / "killed", check=True, capture_output=True)
    for hidden in (tmp_path / "killed").glob(".*"):
        os.unlink(hidden)
    assert folder_differences(tmp_path / "whole", tmp_path / "killed") == []


def test_restart_card_keeps_checkpoints_of_the_ends_of_steps(tmp_path):
    text = DECK.format(period=0.004).replace("*DYNAMIC", "*RESTART, WRITE, FREQUENCY=3\n*DYNAMIC")
    again = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.001, .002\n*END STEP\n"
    (tmp_path / "job.inp").write_text(text + again)
    model = ct.read(tmp_path / "job.inp")
    assert [step.restart for step in model.steps] == [3, 3]
    ct.solve(model, observers=[ct.JobFiles(tmp_path / "whole", "job")], threads=1)
    shutil.copytree(tmp_path / "whole", tmp_path / "part")
    found = load(tmp_path / "part/job.step-1.ckpt")
    assert (found.state.step, found.state.increment) == (1, 4)
    assert load(tmp_path / "part/job.ckpt").state.increment == 3
    ct.resume(tmp_path / "part/job.step-1.ckpt", threads=1)
    assert folder_differences(tmp_path / "whole", tmp_path / "part") == []


def test_a_model_with_functions_is_asked_for(tmp_path):
    """A law in Python is not stored: without the model the error says so, with it all is there."""
    build = MODELS["law in Python"]
    for name, every in (("whole", 0), ("kept", 3)):
        files = ct.JobFiles(tmp_path / name, "job", checkpoint_every=every)
        ct.solve(build(), observers=[files], threads=1)
    with pytest.raises(FileError, match="model="):
        ct.resume(tmp_path / "kept/job", threads=1)
    ct.resume(tmp_path / "kept/job", model=build(), threads=1)
    assert folder_differences(tmp_path / "whole", tmp_path / "kept") == []


def test_a_run_that_stops_again_leaves_its_last_iterate_again(tmp_path):
    deck = tmp_path / "job.inp"
    deck.write_text(DECKS["a run that stops"]())
    for name in ("whole", "part"):
        files = ct.JobFiles(tmp_path / name, "job", checkpoint_every=1)
        with pytest.raises(ct.ConvergenceError):
            ct.solve(ct.read(deck), observers=[files], threads=1)
    with pytest.raises(ct.ConvergenceError):
        ct.resume(tmp_path / "part/job", threads=1)
    assert folder_differences(tmp_path / "whole", tmp_path / "part") == []


def test_a_checkpoint_may_be_used_twice():
    """Going on leaves a checkpoint in memory as it is: the history of friction is a copy."""
    takes = Takes()
    solve(MODELS["bump, friction"](), observers=[takes], threads=1)
    first, again = (
        solve(MODELS["bump, friction"](), threads=1, start=takes.found[4]) for _ in range(2)
    )
    for a, b in zip(first.frames, again.frames, strict=True):
        assert not frame_differences(a, b)


def test_costly_checkpoints_are_taken_seldom(tmp_path, monkeypatch):
    """Whatever one costs, checkpoints by time take at most a hundredth of the run.

    A clock that counts increments of ten seconds: one checkpoint a minute while they are cheap;
    when storing one takes five seconds, the next one waits for five hundred.
    """
    from corota.io import job

    now, cost, taken = 0.0, 0.0, []

    def store(*arguments, **options):
        nonlocal now
        taken.append(now)
        now += cost

    class Files(ct.JobFiles):
        def increment(self, frame):
            nonlocal now
            super().increment(frame)
            now += 10.0

        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            self._queue.start = lambda: None  # tasks at once, so that the clock counts them

    def read():
        return now

    clock = SimpleNamespace(**vars(time) | {"monotonic": read, "perf_counter": read})
    monkeypatch.setattr(job, "time", clock)
    monkeypatch.setattr(os, "fsync", lambda file: None)
    monkeypatch.setattr(job, "store", store)
    model = beam([ct.Static(increments=30)])
    ct.solve(model, observers=[Files(tmp_path / "cheap", formats=[])])
    assert len(taken) == 5
    taken.clear()
    cost = 5.0
    model = beam([ct.Static(increments=120)])
    ct.solve(model, observers=[Files(tmp_path / "dear", formats=[])])
    assert len(taken) > 1
    assert np.all(np.diff(taken) >= 500.0)

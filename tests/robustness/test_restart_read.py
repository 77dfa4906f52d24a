"""``*RESTART, READ``: new steps in a new deck follow an earlier job."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil

import pytest

import corota as ct
from benchmarks.campaigns.same_bits import folder_differences, frame_differences
from benchmarks.corpora.restart_cases import DECKS
from corota.cli import main
from tests.support.calculix import needs_ccx, run_ccx

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

#: Three steps, with checkpoints; where the third begins.
OLD = DECKS["three steps"]().replace("*STEP", "*RESTART, WRITE, FREQUENCY=1\n*STEP", 1)
THIRD = OLD.rindex("*STEP")
NEW = """*RESTART, READ, STEP=2{more}
*AMPLITUDE, NAME=UP
0., 0., 1., 1.
*NSET, NSET=MIDDLE
5, 14, 23
*STEP, NLGEOM
*STATIC
.5, 1.
*CLOAD, AMPLITUDE=UP
MIDDLE, 2, .2
*NODE PRINT, NSET=RIGHTA
U
*END STEP
"""


@pytest.fixture(scope="module")
def earlier(tmp_path_factory):
    folder = tmp_path_factory.mktemp("earlier")
    (folder / "old.inp").write_text(OLD)
    assert main(["run", str(folder / "old.inp"), "-o", str(folder), "-q", "--threads", "1"]) == 0
    return folder


@pytest.fixture
def folder(earlier, tmp_path):
    target = tmp_path / "job"
    shutil.copytree(earlier, target)
    return target


def in_one(folder, text):
    """Frames of the third step where all steps are in one deck."""
    _head, tail = NEW.split("*STEP, NLGEOM", 1)
    (folder / "one.inp").write_text(OLD[:THIRD] + text + "*STEP, NLGEOM" + tail)
    frames = ct.solve(ct.read(folder / "one.inp"), threads=1).frames
    return [f for f in frames if f.step == 3]


EXTRA = NEW.split("\n", 1)[1].split("*STEP", 1)[0]


def test_new_steps_of_a_deck_follow_the_end_of_a_step(folder):
    (folder / "new.inp").write_text(NEW.format(more=", JOB=old"))
    results = ct.solve(ct.read(folder / "new.inp"), threads=1)
    whole = in_one(folder, EXTRA)
    assert [f.step for f in results.frames] == [3, 3]
    for a, b in zip(whole, results.frames, strict=True):
        assert not frame_differences(a, b)


def test_the_command_writes_the_same_and_goes_on_again(folder, capsys):
    (folder / "new.inp").write_text(NEW.format(more=", JOB=old"))
    run = ["run", str(folder / "new.inp"), "-q", "--threads", "1", "--checkpoint-every", "1"]
    for name in ("whole", "again"):
        assert main([*run, "-o", str(folder / name)]) == 0, capsys.readouterr().err
    assert main(["resume", str(folder / "again/new"), "-q", "--threads", "1"]) == 0
    assert folder_differences(folder / "whole", folder / "again") == []


def test_a_deck_of_the_same_name_finds_its_job_and_does_not_replace_it(folder, capsys):
    """As in CalculiX, where the state of JOB is read by a deck of the name JOB."""
    for path in folder.glob("old.*ckpt*"):
        path.rename(folder / path.name.replace("old", "new"))
    (folder / "new.inp").write_text(NEW.format(more=""))
    run = ["run", str(folder / "new.inp"), "-q", "--threads", "1", "-o"]
    assert main([*run, str(folder)]) == 2
    assert "is an input of this job" in capsys.readouterr().err
    assert main([*run, str(folder / "other")]) == 0


def test_an_increment_goes_on_with_its_step_first(folder):
    """Abaqus: the interrupted step is completed, unless END STEP ends it there."""
    old = ct.solve(ct.read(folder / "old.inp"), threads=1).frames
    more = ", STEP=3, INC=3, JOB=old"
    (folder / "new.inp").write_text(NEW.format(more=more).replace("STEP=2, ", "", 1))
    found = ct.solve(ct.read(folder / "new.inp"), threads=1).frames
    rest = [f for f in old if (f.step, f.increment) > (3, 3)]
    assert len(rest) >= 1
    for a, b in zip(rest, found, strict=False):
        assert not frame_differences(a, b)
    assert [f.step for f in found] == [3] * len(rest) + [4, 4]
    text = (folder / "new.inp").read_text().replace("INC=3", "INC=3, END STEP")
    (folder / "new.inp").write_text(text)
    assert {f.step for f in ct.solve(ct.read(folder / "new.inp"), threads=1).frames} == {4}


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (", JOB=nobody", "no checkpoint of the end of step 2; there are: none"),
        (", INC=77, JOB=old", "increment 77 of step 2; there are: the end of step 1"),
        (", JOB=old\n*MATERIAL, NAME=X", "takes its model from the earlier job"),
        (", JOB=old, INC=-1", "INC"),
    ],
)
def test_what_is_not_there_is_named(more, words, folder, capsys):
    (folder / "new.inp").write_text(NEW.format(more=more))
    assert main(["check", str(folder / "new.inp")]) in (2, 6)
    assert words in capsys.readouterr().err


def test_an_earlier_deck_that_has_changed_is_refused(folder, capsys):
    (folder / "new.inp").write_text(NEW.format(more=", JOB=old"))
    (folder / "old.inp").write_text(OLD + "** changed\n")
    for path in folder.parent.parent.glob("earlier*/old.inp"):
        path.write_text(OLD + "** changed\n")
    try:
        assert main(["check", str(folder / "new.inp")]) == 6
        assert "has changed" in capsys.readouterr().err
    finally:
        for path in folder.parent.parent.glob("earlier*/old.inp"):
            path.write_text(OLD)


def test_a_deck_does_not_replace_the_job_that_it_starts_from(folder, capsys):
    (folder / "new.inp").write_text(NEW.format(more=", JOB=old"))
    run = ["run", str(folder / "new.inp"), "-q", "-o", str(folder), "--name", "old"]
    assert main(run) == 2
    assert "is an input of this job" in capsys.readouterr().err
    assert (folder / "old.step-2.ckpt").exists()


def quadratic(steps):
    """A strip of eight-node elements, as CalculiX reads it too."""
    mesh = ct.mesh.rectangle(8.0, 1.0, 8, 1, "quad8")
    lines = ["*NODE, NSET=NA"]
    lines += [f"{k + 1}, {x:.9g}, {y:.9g}, 0." for k, (x, y) in enumerate(mesh.points.tolist())]
    lines.append("*ELEMENT, TYPE=CPS8R, ELSET=EA")
    cells = mesh.cells[0].nodes.tolist()
    lines += [f"{k + 1}, " + ", ".join(str(n + 1) for n in c) for k, c in enumerate(cells)]
    for place in ("left", "right"):
        lines += [f"*NSET, NSET={place.upper()}A", *(f"{n + 1}," for n in mesh.nodes_of(place))]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., 0.", "*SOLID SECTION, ELSET=EA, MATERIAL=M"]
    lines += ["1.", "*BOUNDARY", "LEFTA, 1, 2", "*RESTART, WRITE, FREQUENCY=1"]
    return "\n".join(lines) + "\n" + steps


FIRST = """*STEP
*STATIC
1., 1.
*CLOAD
RIGHTA, 2, .1
*END STEP
*STEP
*STATIC
1., 1.
*CLOAD
RIGHTA, 1, 5.
*END STEP
"""
LATER = """*RESTART, READ, STEP={step}
*STEP
*STATIC
1., 1.
*CLOAD
RIGHTA, 2, .3
*NODE PRINT, NSET=RIGHTA
U
*END STEP
"""


def last_table(path):
    """Displacements of the last table of a .dat file, by node."""
    table = path.read_text().split("displacements")[-1].splitlines()[1:]
    rows = [line.split() for line in table if len(line.split()) == 4]
    return {int(row[0]): (float(row[1]), float(row[2])) for row in rows}


@needs_ccx
@pytest.mark.parametrize("step", [1, 2])
def test_calculix_means_the_same(step, tmp_path):
    """The same two decks there: the new step changes and keeps the loads of the named step."""
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    for folder in (ours, theirs):
        folder.mkdir()
        (folder / "old.inp").write_text(quadratic(FIRST))
    new = LATER.format(step=step)
    (ours / "new.inp").write_text(new.replace("READ,", "READ, JOB=old,"))
    (theirs / "new.inp").write_text(new)
    for name in ("old", "new"):
        assert main(["run", str(ours / f"{name}.inp"), "-o", str(ours), "-q"]) == 0
        run_ccx(theirs, name, check=False)
        if name == "old":
            (theirs / "old.rout").rename(theirs / "new.rin")
    mine, other = (last_table(folder / "new.dat") for folder in (ours, theirs))
    assert mine.keys() == other.keys()
    for node, moved in mine.items():
        assert moved == pytest.approx(other[node], rel=1e-4, abs=1e-9)

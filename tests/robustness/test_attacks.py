"""Sixty and more attacks on what SECURITY.md and docs/robustness.md promise.

They were written from these pages alone. Each ends in a typed error with its exit code, or in
sound results: nothing crashes, hangs, leaves the folder or gives numbers that are none.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import os
import signal
import sys
import time
import zipfile

import h5py
import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.errors import CorotaError
from corota.report.chunk import unpack
from corota.report.content import content_of_job
from corota.report.records import JobPaths

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes of POSIX")

NODES = "*NODE, NSET=NALL\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n"
CELLS = "*ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n"
LAW = "*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*DENSITY\n1.\n"
SECTION = "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"
HELD = "*BOUNDARY\n1, 1, 2\n4, 1, 2\n"
STEP = "*STEP\n*STATIC\n.25, 1.\n*CLOAD\n2, 2, -1.\n*END STEP\n"
SOUND = NODES + CELLS + LAW + SECTION + HELD + STEP
BEFORE = NODES + CELLS + LAW + SECTION + HELD
#: Seconds that an attack may take.
LATE = 30


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """An empty folder, a file beyond it, and an end to what hangs."""
    own = tmp_path / "received"
    own.mkdir()
    (tmp_path / "beyond").write_text("untouched")
    monkeypatch.chdir(own)

    def late(*_):
        raise TimeoutError(f"more than {LATE} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(LATE)
    yield own
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)
    assert (tmp_path / "beyond").read_text() == "untouched"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["beyond", "received"]


def corota(capfd, *words, allowed=(0, 2, 3, 4, 5, 6, 64)):
    """Exit code and messages of a command; what must never be is refused here."""
    capfd.readouterr()
    code = main(list(words))
    out, said = capfd.readouterr()
    assert code in allowed, (code, said[-500:])
    assert "Traceback" not in said, said
    assert f"more than {LATE} s" not in said
    assert "internal error" not in said, said
    assert code == 0 or "error" in said or "argument" in said, said
    assert len(said) < 1_000_000
    assert "\x1b]" not in said + out
    return code, said


def sound_results(name="job"):
    with ct.read_results(f"{name}.vtkhdf") as results:
        for frame in results.frames:
            for values in (frame.U, frame.RF, frame.F):
                assert np.isfinite(values).all()
    with open(f"{name}.csv", encoding="utf-8") as table:
        assert not {"nan", "inf", "-inf"} & set(table.read().replace("\n", ",").split(","))


def with_steps(*lines, before=BEFORE):
    return before + "\n".join(["*STEP", *lines, "*END STEP", ""])


#: Decks that are refused, or that give sound results.
DECKS = {
    "negative labels": SOUND.replace("4, 0, 1", "-4, 0, 1").replace(", 3, 4", ", 3, -4"),
    "label zero": SOUND.replace("4, 0, 1", "0, 0, 1").replace(", 3, 4", ", 3, 0"),
    "a set of itself by two others": SOUND.replace(
        "*MATERIAL", "*NSET, NSET=A\nB\n*NSET, NSET=B\nC\n*NSET, NSET=C\nA\n*MATERIAL", 1
    ),
    "parameter of powers": "*PARAMETER\na = 9**9**9**9\n" + SOUND,
    "parameter of a long text": "*PARAMETER\na = 'x' * 10**10\n" + SOUND,
    "parameter that overflows": "*PARAMETER\na = 1e308 * 1e308\n" + SOUND.replace("-1.", "<a>"),
    "parameter of itself": "*PARAMETER\na = a + 1\n" + SOUND,
    "parameter of a shift": "*PARAMETER\na = 1 << 10**12\n" + SOUND,
    "time points beyond count": "*TIME POINTS, NAME=T, GENERATE\n0., 1., 1e-15\n" + SOUND,
    "increments beyond count": SOUND.replace("*STEP", f"*STEP, INC={10**30}"),
    "period of 1e300": SOUND.replace(".25, 1.", "1e-300, 1e300"),
    "smallest above largest": SOUND.replace(".25, 1.", ".25, 1., .9, .1"),
    "equation without a first term": SOUND.replace("*STEP", "*EQUATION\n2\n2,1,0.,3,1,1.\n*STEP"),
    "equation of one dof twice": SOUND.replace("*STEP", "*EQUATION\n2\n2,1,1.,2,1,-1.\n*STEP"),
    "equations in a circle": SOUND.replace(
        "*STEP", "*EQUATION\n2\n2,1,1.,3,1,-1.\n*EQUATION\n2\n3,1,1.,2,1,-2.\n*STEP"
    ),
    "equation of a million terms": SOUND.replace("*STEP", "*EQUATION\n1000000\n2,1,1.\n*STEP"),
    "rigid body of its reference": SOUND.replace(
        "*STEP", "*NSET, NSET=R\n2, 3\n*RIGID BODY, NSET=R, REF NODE=2\n*STEP"
    ),
    "two rigid bodies with one node": SOUND.replace(
        "*STEP",
        "*NODE\n8, 2, 0\n9, 2, 1\n*NSET, NSET=R\n2, 3\n*RIGID BODY, NSET=R, REF NODE=8\n"
        "*RIGID BODY, NSET=R, REF NODE=9\n*STEP",
    ),
    "axes without length": SOUND.replace("*STEP", "*TRANSFORM, NSET=NALL\n0,0,0,0,0,0\n*STEP"),
    "axes on one line": SOUND.replace("*STEP", "*TRANSFORM, NSET=NALL\n1,1,0,2,2,0\n*STEP"),
    "a ninth face": SOUND.replace("*STEP", "*SURFACE, NAME=S\nE, S9\n*STEP"),
    "a surface against itself": SOUND.replace(
        "*STEP",
        "*SURFACE, NAME=S\nE, S1\n*SURFACE, NAME=T\nE, S1\n*SURFACE INTERACTION, NAME=I\n"
        "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nS, T\n*STEP",
    ),
    "yield that begins late": SOUND.replace("*DENSITY", "*PLASTIC\n10., .1\n20., .2\n*DENSITY"),
    "yield of zero": SOUND.replace("*DENSITY", "*PLASTIC\n0., 0.\n*DENSITY"),
    "escape codes in a name": SOUND.replace("NAME=M", "NAME=\x1b]0;owned\x07M"),
    "a modulus of 1e308": SOUND.replace("1000.,", "1e308,"),
    "a modulus of 1e-308": SOUND.replace("1000.,", "1e-308,"),
    "a thickness of 1e-320": SOUND.replace("MATERIAL=M\n1.", "MATERIAL=M\n1e-320"),
    "coordinates of 1e200": SOUND.replace("1, 0\n", "1e200, 0\n").replace("1, 1\n", "1e200, 1\n"),
    "all nodes at one place": SOUND.replace("2, 1, 0", "2, 0, 0")
    .replace("3, 1, 1", "3, 0, 0")
    .replace("4, 0, 1", "4, 0, 0"),
    "a load of 1e308": SOUND.replace("2, 2, -1.", "2, 2, -1e308\n3, 2, -1e308"),
    "loads of opposite infinity": SOUND.replace("-1.", "1e308").replace(
        "*END", "*CLOAD\n2, 2, 1e308\n2, 2, -1e308\n*END"
    ),
    "frequency of output 0": with_steps("*STATIC", "*NODE FILE, FREQUENCY=0", "U"),
    "frequency of output -7": with_steps("*STATIC", "*NODE FILE, FREQUENCY=-7", "U"),
    "a step of another job that is not there": "*RESTART, READ, STEP=999\n" + STEP,
    "alpha of 5": with_steps("*DYNAMIC, ALPHA=5.", ".1, 1."),
    "modal motion without modes": with_steps("*MODAL DYNAMIC", ".1, 1."),
    "a billion modes": with_steps("*FREQUENCY", "1000000000"),
    "no modes": with_steps("*FREQUENCY", "0"),
    "less than no modes": with_steps("*FREQUENCY", "-3"),
    "a billion frequencies": with_steps("*FREQUENCY", "2")
    + "*STEP\n*STEADY STATE DYNAMICS\n.01, .5, 1000000000\n*MODAL DAMPING\n1, 2, .02\n"
    "*CLOAD\n2, 2, 1.\n*END STEP\n",
    "friction below zero": SOUND.replace(
        "*STEP", "*SURFACE INTERACTION, NAME=I\n*FRICTION\n-.5\n*STEP", 1
    ),
    "motion without mass": with_steps(
        "*DYNAMIC, EXPLICIT", ", 1.", before=BEFORE.replace("*DENSITY\n1.\n", "")
    ),
    "a velocity of 1e308": with_steps(
        "*DYNAMIC", ".1, 1.", before=BEFORE + "*INITIAL CONDITIONS, TYPE=VELOCITY\nNALL, 1, 1e308\n"
    ),
    "a temperature of 1e308": with_steps(
        "*STATIC", "*TEMPERATURE", "NALL, 1e308",
        before=BEFORE.replace("*DENSITY", "*EXPANSION\n1e-5\n*DENSITY"),
    ),
    "amplitude that goes back": "*AMPLITUDE, NAME=A\n0., 0., 1., 1., .5, 2.\n"
    + SOUND.replace("*CLOAD", "*CLOAD, AMPLITUDE=A"),
    "steps within steps": SOUND.replace("*CLOAD", "*STEP\n*STEP\n*CLOAD"),
    "a line of five million characters": "*HEADING\n" + "x" * 5_000_000 + "\n" + SOUND,
    "a hundred thousand commas": SOUND.replace("2, 2, -1.", "2, 2, -1." + "," * 100_000),
    "a hundred thousand steps": BEFORE + "*STEP\n*STATIC\n" * 100_000,
    "sixteen bits a character": SOUND.encode("utf-16"),
    "zero bytes": SOUND.encode().replace(b"*STEP", b"\0*STEP"),
    "a mark before the first card": b"\xef\xbb\xbf" + SOUND.encode(),
    "old line ends": SOUND.replace("\n", "\r").encode(),
    "instances of nothing": "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=NONE\n*END INSTANCE\n"
    "*END ASSEMBLY\n" + SOUND,
    "a part of two thousand copies": "*PART, NAME=P\n" + NODES + CELLS
    + "*END PART\n*ASSEMBLY, NAME=A\n" + "*INSTANCE, NAME=I, PART=P\n*END INSTANCE\n" * 2000
    + "*END ASSEMBLY\n" + LAW + STEP,
}  # fmt: skip


#: Decks that are read for seconds.
LONG = {"a hundred thousand steps"}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in LONG else []) for n in DECKS]
)
def test_a_deck_is_refused_or_gives_sound_results(capfd, here, name):
    deck = DECKS[name]
    (here / "job.inp").write_bytes(deck if isinstance(deck, bytes) else deck.encode())
    code, _ = corota(capfd, "run", "job.inp", "-q", "--threads", "1")
    if code == 0:
        sound_results()


def _include(target):
    return SOUND.replace(CELLS, f"*INCLUDE, INPUT={target}\n")


@pytest.mark.parametrize(
    "how", ["link to itself", "hard link to itself", "link of a link", "pipe", "result", "folder"]
)
def test_an_include_is_read_once_and_inside(capfd, here, how):
    (here / "job.inp").write_text(_include("more.inc"))
    more = here / "more.inc"
    if how == "link to itself":
        more.symlink_to("job.inp")
    elif how == "hard link to itself":
        os.link(here / "job.inp", more)
    elif how == "link of a link":
        (here / "one").symlink_to("two")
        (here / "two").symlink_to("one")
        more.symlink_to("one")
    elif how == "pipe":
        os.mkfifo(more)
    elif how == "result":
        (here / "whole.inp").write_text(SOUND)
        corota(capfd, "run", "whole.inp", "-q", "--threads", "1", allowed=(0,))
        (here / "whole.vtkhdf").rename(more)
    else:
        more.mkdir()
    corota(capfd, "run", "job.inp", "-q", allowed=(2, 6))


HEAD = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
MESHES = {
    "a.msh": HEAD + "$Nodes\n1000000000000\n1 0 0 0\n$EndNodes\n",
    "b.msh": HEAD.replace(" 0 8", " 1 8") + "$Nodes\n4\nnot bytes\n$EndNodes\n",
    "c.msh": HEAD + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n$Elements\n-5\n$EndElements\n",
    "d.msh": HEAD + "$Nodes\n3\n-1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n"
    "1 2 2 0 1 -1 2 3\n$EndElements\n",
    "e.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 18446744073709551615 1 1\n",
    "f.unv": "    -1\n  2411\n         1         1         1        11\n",
    "g.unv": "    -1\n" * 100_000,
    "h.msh": HEAD + "$Nodes\n3\n1 0 0 9\n2 1 0 5\n3 0 1 nan\n$EndNodes\n",
}


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_with_odd_counts_is_refused(capfd, here, name):
    (here / name).write_text(MESHES[name])
    corota(capfd, "info", name, allowed=(2, 6))


@pytest.fixture
def solved(here, capfd):
    (here / "job.inp").write_text(SOUND)
    corota(
        capfd, "run", "job.inp", "-q", "--threads", "1", "--checkpoint-every", "1",
        "--format", "vtkhdf", "--format", "npz", allowed=(0,),
    )  # fmt: skip
    return here


def _displacements(file):
    found = []
    file.visititems(lambda name, item: found.append(name) if "displacement" in name else None)
    return next(n for n in found if isinstance(file[n], h5py.Dataset))


@pytest.mark.parametrize(
    "how", ["external link", "soft link to itself", "virtual", "huge", "text", "outside storage"]
)
def test_a_result_file_reads_no_other_and_takes_no_room(capfd, solved, how):
    other = solved.parent / "beyond"
    with h5py.File(solved / "job.vtkhdf", "r+") as file:
        name = _displacements(file)
        shape = file[name].shape
        del file[name]
        if how == "external link":
            file[name] = h5py.ExternalLink(str(other), "/x")
        elif how == "soft link to itself":
            file[name] = h5py.SoftLink("/" + name)
        elif how == "virtual":
            layout = h5py.VirtualLayout(shape, float)
            layout[:] = h5py.VirtualSource(str(other), "x", shape)
            file.create_virtual_dataset(name, layout)
        elif how == "huge":
            file.create_dataset(name, (10**13, 3), float, chunks=(1000, 3))
        elif how == "text":
            file.create_dataset(name, data=np.full(shape[0], b"x" * 100))
        else:
            file.create_dataset(name, (9,), "u1", external=[(str(other), 0, 9)])
    corota(capfd, "info", "job.vtkhdf", allowed=(0, 2, 5, 6))
    corota(capfd, "report", "job.vtkhdf", allowed=(0, 2, 5, 6))
    for path in solved.glob("*.html"):
        assert "untouched" not in path.read_text()


LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a "' + "ha" * 50 + '">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefg", "bcdefgh", strict=True))
    + "]><VTKFile>&h;</VTKFile>"
)  # fmt: skip
OUTSIDE = (
    '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a SYSTEM "file:../beyond">]><VTKFile>&a;</VTKFile>'
)


@pytest.mark.parametrize("ending", ["vtu", "pvd"])
@pytest.mark.parametrize(
    "text", [LAUGHS, OUTSIDE, "<VTKFile>" * 100_000], ids=["many", "out", "deep"]
)
def test_xml_expands_nothing(capfd, here, ending, text):
    (here / f"a.{ending}").write_text(text)
    begin = time.process_time()
    _, said = corota(capfd, "info", f"a.{ending}", allowed=(2, 6))
    assert "untouched" not in said
    assert time.process_time() - begin < 10


class Payload:
    """Writes a file where it is unpacked."""

    def __reduce__(self):
        return (open, ("owned", "w"))


@pytest.mark.parametrize("how", ["code", "bomb", "names"])
def test_an_archive_runs_no_code(capfd, solved, how):
    path = solved / "job.npz"
    if how == "code":
        with np.load(path) as data:
            arrays = {name: data[name] for name in data.files}
        arrays["U"] = np.array([Payload()], dtype=object)
        np.savez(path, **arrays, allow_pickle=True)
    else:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            header = b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': "
            header += b"(1000000000000,), }".ljust(70) + b"\n"
            archive.writestr("U.npy" if how == "bomb" else "../../owned.npy", header)
    corota(capfd, "info", "job.npz", allowed=(0, 2, 6))
    assert not list(solved.parent.rglob("owned*"))


@pytest.mark.parametrize("how", ["folder", "link out", "empty", "external link", "huge", "renamed"])
def test_a_checkpoint_that_is_none_is_refused(capfd, solved, how):
    paths = sorted(solved.glob("job.ckpt*"))
    assert paths
    for path in paths:
        if how in ("external link", "huge"):
            with h5py.File(path, "r+") as file:
                name = next(n for n in file if isinstance(file[n], h5py.Dataset) or n)
                del file[name]
                if how == "huge":
                    file.create_dataset(name, (10**13,), float, chunks=(1000,))
                else:
                    file[name] = h5py.ExternalLink(str(solved.parent / "beyond"), "/x")
            continue
        if how == "renamed":
            continue
        path.unlink()
        if how == "folder":
            path.mkdir()
        elif how == "link out":
            path.symlink_to("../beyond")
        else:
            path.write_bytes(b"")
    if how == "renamed":
        (solved / "job.inp").write_text(SOUND.replace("1000.", "2000."))
    corota(capfd, "resume", "job.inp", "-q", allowed=(2, 5, 6))


SWEPT = "*PARAMETER\nload = 1.\n" + SOUND.replace("-1.", "<load>")


@pytest.mark.parametrize("how", ["link", "pipe", "deck", "numbers", "binary", "folder"])
def test_a_store_of_a_sweep_is_its_own_or_refused(here, how):
    (here / "job.inp").write_text(SWEPT)
    store = here / "rows.jsonl"
    if how == "link":
        store.symlink_to("job.inp")
    elif how == "pipe":
        os.mkfifo(store)
    elif how == "deck":
        store = here / "job.inp"
    elif how == "numbers":
        store.write_text('{"digest": NaN, "run": 3, "row": Infinity, "outcome": {}}\n')
    elif how == "binary":
        store.write_bytes(bytes(range(256)))
    else:
        store.mkdir()
    with pytest.raises(CorotaError):
        ct.sweep("job.inp", {"load": [1.0]}, "last(U2@NALL)", workers=1, store=store)
    assert (here / "job.inp").read_text() == SWEPT


@pytest.mark.parametrize(
    "words",
    [
        ("sweep", "job.inp", "-p", "load=1:2:1000000000000", "-m", "last(U2@NALL)"),
        ("sweep", "job.inp", "-p", "load=1:inf:3", "-m", "last(U2@NALL)"),
        ("sweep", "job.inp", "-p", "load=1,2", "-m", "__import__('os').system('touch owned')"),
        ("sweep", "job.inp", "-p", "load=1,2", "-m", "last(U2@NALL)", "-o", "job.inp"),
        ("sweep", "job.inp", "-p", "load=1,2", "-m", "last(U2@NALL)", "-o", "rows.jsonl"),
        ("sweep", "job.inp", "-p", "load=1", "-m", "last(U2@NALL)", "--workers", "-3"),
        ("report", "job.inp", "-o", "job.inp"),
        ("sweep", "job.inp", "-p", "nothing=1", "-m", "last(U2@NALL)", "--workers", "1"),
        ("run", "job.inp", "--parameter", "load=__import__('os').system('touch owned')"),
        ("run", "job.inp", "--name", "../beyond"),
        ("run", "job.inp", "--name", "a\nb"),
        ("run", "job.inp", "--name", "x" * 5000),
        ("run", "job.inp", "--threads", "-4"),
        ("run", "job.inp", "--checkpoint-every", "-1"),
        ("run", "job.inp", "--history", "U9@NALL"),
        ("run", "job.inp", "--history", "U2@" + "x" * 100_000),
        ("run", "job.inp", "--element", "CPS4=rm"),
        ("run", "job.inp", "--fields", "U,../../x"),
        ("run", "job.inp", "-o", "job.inp"),
        ("convert", "job.inp", "job.inp"),
        ("convert", "job.inp", "../new.inp/x.inp"),
        ("seek", "job.inp", "-p", "load=nan:1", "-m", "last(U2@NALL)", "--target", "1"),
        ("info", "/dev/zero"),
        ("plot", "/dev/urandom"),
        ("report", ".."),
        ("verify", "../../beyond"),
        ("mesh", "/dev/zero"),
    ],
    ids=lambda words: " ".join(words)[:60],
)
def test_words_of_the_command_line_are_refused(capfd, here, words):
    (here / "job.inp").write_text(SWEPT)
    before = (here / "job.inp").read_text()
    corota(capfd, *words, allowed=(2, 3, 5, 6, 64))
    assert (here / "job.inp").read_text() == before
    assert not list(here.parent.rglob("owned*"))


def test_a_sweep_without_memory_for_some_rows_says_so(capfd, here, monkeypatch):
    """Also where warnings are not asked for: it ended with 4 and no message."""
    from corota.sweeps import variant

    (here / "job.inp").write_text(SWEPT)
    solve, calls = variant.solved, []

    def short(*args, **options):
        calls.append(1)
        if len(calls) == 2:
            raise MemoryError("no room")
        return solve(*args, **options)

    monkeypatch.setattr(variant, "solved", short)
    words = ("sweep", "job.inp", "-p", "load=1,2", "-m", "last(U2@NALL)", "--workers", "1", "-q")
    _, said = corota(capfd, *words, allowed=(5,))
    assert "1 of 2 rows failed; the first: MemoryError: no room" in said


LINEAR = ct.Elastic(E=1e3, nu=0.3, rho=1.0)


def strip():
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.fix("left")
    model.force("right", y=-0.1)
    return model


CALLS = {
    "a mesh of no number": lambda: ct.mesh.rectangle(float("nan"), 1.0, 2, 2),
    "a mesh of no cells": lambda: ct.mesh.rectangle(1.0, 1.0, 0, 2),
    "a mesh of a fraction of a cell": lambda: ct.mesh.rectangle(1.0, 1.0, 2.5, 2),
    "a mesh of too many cells": lambda: ct.mesh.rectangle(1.0, 1.0, 10**9, 10**9),
    "a mesh turned inside out": lambda: ct.mesh.rectangle(-1.0, 1.0, 2, 2),
    "nu of plane strain": lambda: ct.Elastic(E=1.0, nu=0.5000001),
    "a modulus of no number": lambda: ct.Elastic(E=float("inf"), nu=0.3),
    "yield below zero": lambda: ct.Mises(E=1.0, nu=0.3, yield_stress=-1.0),
    "increments of a half": lambda: ct.Static(increments=0.5),
    "increments below zero": lambda: ct.Static(increments=-3),
    "increments of no number": lambda: ct.Static(increments=float("nan")),
    "a period without end": lambda: ct.Dynamic(period=float("inf"), increments=3),
    "a path to no place": lambda: ct.ArcLength(displacement=([0], "y", float("nan"))),
    "modes of a half": lambda: ct.Frequency(2.5),
    "modes below zero": lambda: ct.Frequency(-1),
    "an amplitude that goes back": lambda: ct.Amplitude([0.0, 1.0, 0.5], [0.0, 1.0, 2.0]),
    "an amplitude of nothing": lambda: ct.Amplitude([], []),
    "threads of a text": lambda: ct.solve(strip(), ct.Static(), threads="2"),
    "a solver of a number": lambda: ct.solve(strip(), ct.Static(), solver=3),
    "a step of a text": lambda: ct.solve(strip(), "static"),
    "no model": lambda: ct.solve(None),
    "nodes beyond the last": lambda: strip().fix([10**9]),
    "nodes of a text within": lambda: strip().fix(["left", 3]),
    "a set that is not there": lambda: ct.solve(_with(lambda m: m.fix("nowhere")), ct.Static()),
    "a section on nothing": lambda: _section("nowhere"),
    "a thickness below zero": lambda: _section(thickness=-1.0),
    "an element of a number": lambda: _section(element=4),
    "no material": lambda: _section(material=None),
    "a force of no number": lambda: strip().force("right", y=float("nan")),
    "a force of a text": lambda: strip().force("right", y="1"),
    "to read a number": lambda: ct.read(3),
    "to read a folder": lambda: ct.read("."),
    "to write into a folder": lambda: ct.write(strip(), "."),
    "to write an unknown ending": lambda: ct.write(strip(), "a.exe"),
    "to read results of a deck": lambda: ct.read_results("beyond"),
    "a sweep of nothing": lambda: ct.sweep(strip, {}, "last(U2@right)"),
    "a sweep of no values": lambda: ct.sweep(strip, {"a": []}, "last(U2@right)"),
    "a measure that is code": lambda: ct.sweep(strip, {"a": [1]}, "__import__('os')", workers=1),
    "a job of two lines": lambda: _written("a\nb"),
    "a job with a zero byte": lambda: _written("a\0b"),
    "a job outside": lambda: _written("../x"),
    "a Python law of another shape": lambda: _law(lambda e, s, p: (e[..., :2], e, s)),
    "a Python law of a text": lambda: _law(lambda e, s, p: "stress"),
    "a Python law of nothing": lambda: _law(lambda e, s, p: None),
    "a thickness changed afterwards": lambda: ct.solve(_with(_thin), ct.Static()),
}  # fmt: skip


def _section(cells="all", element="Q4I", material=LINEAR, thickness=1.0):
    strip().section(cells, element=element, material=material, thickness=thickness)


def _written(name):
    return ct.solve(strip(), ct.Static(), observers=[ct.JobFiles(".", name)])


def _with(change):
    model = strip()
    change(model)
    return model


def _thin(model):
    model.sections[0].thickness = -1.0


def _law(function):
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    model.section("all", element="Q4", material=ct.UserMaterial(function))
    model.fix("left")
    model.force("right", y=-0.1)
    return ct.solve(model, ct.Static())


@pytest.mark.parametrize("name", CALLS)
def test_a_wrong_call_is_a_typed_error(here, name):
    with pytest.raises((CorotaError, TypeError)) as caught:
        CALLS[name]()
    assert str(caught.value).strip()


def test_results_of_two_runs_are_not_mixed(capfd, solved):
    """A table of another run beside a result is not shown as its own."""
    (solved / "job.inp").write_text(SOUND.replace("-1.", "-5."))
    kept = (solved / "job.jsonl").read_text()
    corota(capfd, "run", "job.inp", "-q", "--threads", "1", allowed=(0,))
    (solved / "job.jsonl").write_text(kept)
    found = unpack(content_of_job(JobPaths(solved, "job")).chunks["history"])
    assert "another run" in str(found)


def test_a_log_of_numbers_that_are_none_is_no_crash(capfd, solved):
    with open(solved / "job.jsonl", "a") as log:
        log.write('{"event": "increment", "step": NaN, "increment": 1e400, "time": "x"}\n')
        log.write(json.dumps({"event": "iteration", "step": -1, "increment": [1], "residual": {}}))
        log.write("\n" + '{"event": 3}\n{"event": "end", "profile": 7, "notes": "x"}\n')
    corota(capfd, "report", "job.vtkhdf", allowed=(0, 2, 6))

"""The command line: commands, exit codes and messages."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import corota
from corota import cli
from corota.cli.parser import COMMANDS
from corota.io.result_reader import read_results

DECK = Path(__file__).parent / "deck.inp"
CALL = [sys.executable, "-m", "corota"]


def test_version_needs_no_numerics():
    code = "import sys, corota.cli as c; c.main(['--version']); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["corota", *done.stdout.split()[1:2], "False"]


def test_run_writes_its_files_and_tells_them(tmp_path, call):
    done = call("run", DECK, "-o", tmp_path / "out", "-v")
    assert done.returncode == 0, done.stderr
    names = {p.name for p in (tmp_path / "out").iterdir()}
    assert names == {f"deck.{e}" for e in ("vtkhdf", "dat", "sta", "cvg", "csv", "jsonl")}
    for word in ("Step 1 of 1", "6 nodes, 2 elements", "Files in", "Done in", "phase", "factor"):
        assert word in done.stdout
    assert "\x1b" not in done.stdout
    rows = [line.split() for line in done.stdout.splitlines() if line.startswith("    1 ")]
    assert [r[1] for r in rows] == ["1", "2", "3", "4"]
    assert done.stderr == ""
    with read_results(tmp_path / "out" / "deck.vtkhdf") as results:
        assert results.frames[-1].factor == pytest.approx(1.0)
        assert {"read", "order", "assemble", "factor", "solve", "recover", "write"} <= set(
            results.info["profile"]
        )


def test_name_formats_and_histories(tmp_path, here):
    done = here(
        *("run", DECK, "-o", tmp_path, "--name", "job", "--format", "pvd", "--format", "npz"),
        *("--history", "U2@6", "-q"),
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    assert (tmp_path / "job.pvd").exists()
    assert (tmp_path / "job.npz").exists()
    assert not (tmp_path / "job.vtkhdf").exists()
    assert "U2 6" in (tmp_path / "job.csv").read_text().splitlines()[0]


def test_json_lines_tell_the_whole_run(tmp_path, here):
    done = here("run", DECK, "-o", tmp_path, "--json")
    records = [json.loads(line) for line in done.stdout.splitlines()]
    events = [r["event"] for r in records]
    assert events[:2] == ["start", "step"]
    assert events[-2:] == ["end", "files"]
    assert [r["increment"] for r in records if r["event"] == "increment"] == [0, 1, 2, 3, 4]
    iterations = [r for r in records if r["event"] == "iteration"]
    assert all(r["residual"] >= 0.0 for r in iterations)
    log = [json.loads(line) for line in (tmp_path / "deck.jsonl").read_text().splitlines()]
    assert [r["event"] for r in log] == events[:-1]


def test_element_type_is_replaced(tmp_path, here):
    done = here("run", DECK, "-o", tmp_path, "--element", "CPS4=Q4I", "-q", "--points")
    assert done.returncode == 0, done.stderr
    with read_results(tmp_path / "deck.vtkhdf") as results:
        assert results.frames[-1].fields[0].element == "Q4I"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "the following arguments are required"),
        (["solve", "a.inp"], "invalid choice"),
        (["run"], "deck"),
        (["run", "a.inp", "--threads", "0"], "not a whole number from 1"),
        (["run", "a.inp", "--element", "CPS4"], "OLD=NEW"),
        (["run", "a.inp", "--color"], "unrecognized arguments"),
    ],
)
def test_wrong_command_line_is_64_with_a_pointer(arguments, words, capsys):
    assert cli.main(arguments) == 64
    error = capsys.readouterr().err
    assert words in error
    assert "--help" in error


@pytest.mark.parametrize("arguments", [["--help"], ["--help", "run"], ["-h", "plot", "x"]])
def test_the_help_lists_every_command(arguments, capsys):
    assert cli.main(arguments) == 0
    shown = capsys.readouterr().out
    for name, (text, _) in COMMANDS.items():
        assert re.search(rf"^    {name} +{re.escape(text[:20])}", shown, re.MULTILINE), name


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_a_command_lists_its_arguments(name, capsys, monkeypatch):
    """Also after an option of no command, which is refused only where a command runs."""
    monkeypatch.setenv("COLUMNS", "200")
    assert cli.main([name, "--help"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith(f"usage: corota {name} [-h]")
    assert COMMANDS[name][0] in shown
    assert "--json" in shown
    assert cli.main(["--nonsense", name, "--help"]) == 0
    assert capsys.readouterr().out == shown


def test_an_option_before_the_command_is_refused(capsys):
    assert cli.main(["--json", "info", "a.inp"]) == 64
    assert "unrecognized arguments: --json" in capsys.readouterr().err


def test_bad_deck_is_2_with_file_line_and_word(tmp_path, here, deck):
    path = deck(tmp_path / "bad.inp", ("*ELASTIC", "*ELASTICK"))
    done = here("run", path, "-o", tmp_path / "out")
    assert done.returncode == 2
    assert "bad.inp:18:1" in done.stderr
    assert "*ELASTIC" in done.stderr
    assert not (tmp_path / "out").exists()


def test_deck_without_step_is_3(tmp_path, here):
    text = DECK.read_text()
    (tmp_path / "a.inp").write_text(text[: text.index("*STEP")])
    done = here("run", tmp_path / "a.inp", "-o", tmp_path / "out")
    assert done.returncode == 3
    assert "no *STEP" in done.stderr


def test_structure_that_is_not_held_is_3_and_names_a_node(tmp_path, here, deck):
    path = deck(tmp_path / "a.inp", ("LEFT,1,2", "LEFT,1,1"))
    done = here("run", path, "-o", tmp_path / "out")
    assert done.returncode == 3, done.stderr
    assert "node" in done.stderr


def test_load_that_cannot_be_carried_is_4_and_keeps_what_converged(tmp_path, here, deck):
    path = deck(tmp_path / "a.inp", ("RIGHT,2,-.05", "RIGHT,1,-400."))
    done = here("run", path, "-o", tmp_path / "out")
    assert done.returncode == 4, done.stdout + done.stderr
    assert "step 1" in done.stderr
    with read_results(tmp_path / "out" / "a.vtkhdf") as results:
        last = results.frames[-1]
        named = re.search(r"load factor ([\d.]+)", done.stderr)
        assert named
        assert float(named[1]) == pytest.approx(last.factor, rel=1e-5)
    assert "Files in" in done.stdout
    end = json.loads((tmp_path / "out" / "a.jsonl").read_text().splitlines()[-1])
    assert end["status"] == "failed"


@pytest.mark.parametrize("command", ["run", "check", "info", "plot", "convert"])
def test_missing_file_is_6_and_named(command, tmp_path, here, monkeypatch):
    monkeypatch.chdir(tmp_path)
    more = ["x.vtkhdf"] if command == "convert" else []
    for name in ("missing.inp", "missing.vtkhdf"):
        done = here(command, name, *more)
        assert done.returncode == (2 if (command, name) == ("plot", "missing.inp") else 6)
        assert "missing" in done.stderr


def test_folder_as_input_is_6(tmp_path, here):
    (tmp_path / "a.inp").mkdir()
    done = here("run", tmp_path / "a.inp")
    assert done.returncode == 6
    assert "folder" in done.stderr


def test_folder_that_cannot_be_made_is_6_and_named(tmp_path, here):
    (tmp_path / "file").write_text("")
    done = here("run", DECK, "-o", tmp_path / "file" / "out")
    assert done.returncode == 6
    assert str(tmp_path / "file" / "out") in done.stderr


def test_folder_that_takes_no_files_is_6(here):
    """A folder of the kernel where nobody, not even the administrator, may write."""
    done = here("run", DECK, "-o", "/proc/sys")
    assert done.returncode == 6
    assert "/proc/sys/deck" in done.stderr


def test_internal_error_is_70_without_traceback(monkeypatch, capsys):
    def broken(*args, **options):
        raise RuntimeError("the roof fell in")

    monkeypatch.setattr("corota.cli.info.read_input", broken)
    assert cli.main(["info", str(DECK)]) == 70
    error = capsys.readouterr().err
    assert "internal error: RuntimeError: the roof fell in" in error
    assert "Traceback" not in error


def test_too_little_memory_is_5(monkeypatch, capsys):
    def hungry(*args, **options):
        raise MemoryError

    monkeypatch.setattr("corota.cli.info.read_input", hungry)
    assert cli.main(["info", str(DECK)]) == 5
    assert "not enough memory" in capsys.readouterr().err


def test_info_describes_decks_and_results(tmp_path, here):
    here("run", DECK, "-o", tmp_path, "-q")
    text = here("info", DECK).stdout
    for word in ("6 nodes, 2 elements", "2 quad4", "LEFT", "EALL", "STEEL", "step 1: static"):
        assert word in text
    text = here("info", tmp_path / "deck.vtkhdf").stdout
    for word in ("5 frames", "MISES", "Phases of the run", "factor", "recover", "load factor 1"):
        assert word in text
    record = json.loads(here("info", tmp_path / "deck.vtkhdf", "--json").stdout)
    assert record["frames"] == 5
    assert record["element sets"] == {"EALL": 2}


def test_info_names_the_contact_of_a_results_file(tmp_path, capsys):
    """Method, law and friction are those of the pair, not defaults (mortar, no friction)."""
    mesh = corota.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    model = corota.Model(mesh)
    model.section("all", element="Q4I", material=corota.Elastic(E=1000.0, nu=0.3))
    model.fix("top", x=0.0, y=-0.01)
    floor = corota.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
    model.contact("bottom", floor, friction=0.2, method="node_to_segment")
    corota.solve(model, corota.Static(), threads=1).write(tmp_path / "a.vtkhdf")
    assert cli.main(["info", str(tmp_path / "a.vtkhdf")]) == 0
    assert "node_to_segment, hard, friction 0.2" in capsys.readouterr().out


def test_check_counts_and_does_not_solve(tmp_path, here, monkeypatch, deck):
    monkeypatch.chdir(tmp_path)
    done = here("check", DECK)
    assert done.returncode == 0, done.stderr
    assert "0 errors" in done.stdout
    assert not list(tmp_path.iterdir())
    loose = deck(tmp_path / "a.inp", ("LEFT,1,2", "LEFT,1,1"))
    done = here("check", loose, "--json")
    assert done.returncode == 3
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert any(r["event"] == "diagnostic" and r["severity"] == "error" for r in found)


def test_convert_changes_the_format_of_results(tmp_path, here):
    here("run", DECK, "-o", tmp_path, "-q")
    for ending in ("pvd", "npz", "csv"):
        done = here("convert", tmp_path / "deck.vtkhdf", tmp_path / f"b.{ending}")
        assert done.returncode == 0, done.stderr
        assert (tmp_path / f"b.{ending}").stat().st_size
    done = here("convert", tmp_path / "deck.vtkhdf", tmp_path / "b.xyz")
    assert done.returncode == 2


def test_convert_writes_meshes_as_decks(tmp_path, here):
    assert here("convert", DECK, tmp_path / "b.inp").returncode == 0
    first, second = (corota.mesh.read(p) for p in (DECK, tmp_path / "b.inp"))
    assert np.array_equal(first.points, second.points)
    assert np.array_equal(first.cells[0].nodes, second.cells[0].nodes)
    assert first.node_labels.tolist() == second.node_labels.tolist()
    assert {k: v.tolist() for k, v in first.node_sets.items()} == {
        k: v.tolist() for k, v in second.node_sets.items()
    }
    assert here("convert", DECK, tmp_path / "b.med").returncode == 2


@pytest.mark.usefixtures("quick_pictures")
def test_plot_draws_pictures(tmp_path, here, monkeypatch):
    monkeypatch.chdir(tmp_path)
    here("run", DECK, "-o", tmp_path, "-q")
    result = tmp_path / "deck.vtkhdf"
    for arguments in (
        ["-o", "a.png"],
        ["-o", "b.svg", "--field", "S11", "--element"],
        ["-o", "c.pdf", "--field", "U2", "--scale", "20", "--frame", "2"],
        ["-o", "d.png", "--curve", "U2@RIGHT,load factor"],
        ["-o", "e.png", "--curve", "RF2@1,U2@6"],
        ["-o", "f.gif", "--field", "SP1"],
        ["-o", "g.png", "--model"],
    ):
        done = here("plot", result, *arguments)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / arguments[1]).stat().st_size > 1000
    assert here("plot", DECK, "--model", "-o", "h.png").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--field", "MISS"], "did you mean MISES"),
        (["--frame", "99"], "no frame 99; there are 5"),
        (["-o", "a.bmp"], "unknown picture format '.bmp'"),
        (["--curve", "U2"], "write two quantities"),
        (["--curve", "U2@NOWHERE,time"], "no set named 'NOWHERE'"),
        (["--curve", "U2@77,time"], "there is no node 77"),
        (["--field", "U", "--element"], "is defined at nodes"),
    ],
)
def test_wrong_picture_is_2_with_the_way_out(arguments, words, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", str(DECK), "-q"]) == 0
    assert cli.main(["plot", "deck.vtkhdf", *arguments]) == 2
    assert words in capsys.readouterr().err


def test_deck_cannot_be_drawn_as_results(capsys):
    assert cli.main(["plot", str(DECK)]) == 2
    assert "--model" in capsys.readouterr().err


def test_missing_matplotlib_says_how_to_install_it(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert cli.main(["plot", str(DECK), "--model"]) == 5
    assert "pip install corota[plot]" in capsys.readouterr().err


def test_console_script_is_installed():
    script = shutil.which("corota", path=str(Path(sys.executable).parent))
    assert script
    done = subprocess.run([script, "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("corota ")

"""Words that would do harm: inputs replaced, names that leave, bombs, escape sequences."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from benchmarks.restart_cases import DECKS
from corota.cli import main

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

"""The demo runs anywhere, and the extras are the documented ones."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import pytest

from corota.cli import main

ROOT = Path(__file__).parents[2]


def test_the_demo_needs_no_file_and_tells_what_it_wrote(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["demo", "rollup"]) == 0
    written = {p.suffix for p in (tmp_path / "corota-demo" / "rollup").iterdir()}
    assert {".vtkhdf", ".csv", ".sta"} <= written
    out = capsys.readouterr().out
    assert "Files in" in out
    assert 'ct.examples.load("rollup")' in out


def test_the_demo_lists_its_examples_and_names_the_nearest(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["demo", "--list"]) == 0
    assert "gripper" in capsys.readouterr().out
    assert main(["demo", "griper"]) == 2
    assert "did you mean 'gripper'" in capsys.readouterr().err


def test_the_extras_are_those_of_the_page_on_installing() -> None:
    manifest = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    table = manifest.split("[project.optional-dependencies]")[1].split("\n[")[0]
    extras = set(re.findall(r"^(\w+) = ", table, re.MULTILINE))
    assert extras == {"plot", "mesh", "pardiso", "data", "view", "petsc", "optimize", "all"}
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    assert extras <= set(re.findall(r"`corota\[(\w+)\]`", page))

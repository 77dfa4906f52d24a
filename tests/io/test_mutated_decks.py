"""Mutated decks are refused with their faults or give a sound model; nothing else happens."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest
from decks import read
from fuzz_decks import run
from seeds import SEEDS


@pytest.mark.parametrize("number", range(len(SEEDS)))
def test_the_unmutated_decks_are_sound(tmp_path: Path, number: int) -> None:
    assert read(tmp_path, SEEDS[number]).mesh.n_cells >= 2


@pytest.mark.parametrize("count", [270, pytest.param(600, marks=pytest.mark.slow)])
def test_mutated_decks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    monkeypatch.chdir(tmp_path)
    outcomes = run(count, seed=3)
    # Both outcomes occur: the mutations are neither all harmless nor all fatal.
    assert outcomes["refused"] > count / 2
    assert outcomes["accepted"] > count / 30

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


def test_mutated_decks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    outcomes = run(600, seed=3)
    # Both outcomes occur: the mutations are neither all harmless nor all fatal.
    assert outcomes["refused"] > 300
    assert outcomes["accepted"] > 20

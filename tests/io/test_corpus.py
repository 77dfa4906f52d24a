"""A hundred small decks in the layouts of pre-processors: accepted, run, and right."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.check import examine

FOLDER = Path(__file__).parents[1] / "data" / "corpus"
#: x, y, ux, uy of two nodes of each deck, by CalculiX 2.20 or in closed form.
ANSWERS = json.loads((FOLDER / "answers.json").read_text(encoding="utf-8"))
DECKS = sorted(path.stem for path in FOLDER.glob("*.inp"))
#: CalculiX makes solids of planar elements: their stress across vanishes in the mean only.
SOLIDS = 1e-2
EXACT = 2e-5
#: CalculiX stops iterating a large rotation at this error.
ITERATED = 1e-4


def test_the_corpus_is_whole() -> None:
    assert len(DECKS) == 100
    assert set(DECKS) == set(ANSWERS)


@pytest.mark.parametrize("name", DECKS)
def test_a_deck_of_another_program_runs_and_is_right(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(FOLDER / f"{name}.inp")
        findings, code = examine(model)
        assert code == 0, "\n".join(map(str, findings))
        frame = ct.solve(model, threads=1).frames[-1]
    rows = ANSWERS[name]
    size = max(float(np.hypot(*row[2:])) for row in rows)
    tolerance = SOLIDS if name.endswith(("_cantilever", "_weight")) else EXACT
    if name.endswith("_rotation"):
        # Decks of Abaqus take another strain, which differs at the 4 % of this deck.
        same = model.sections[0].local_strain == "green_lagrange"
        tolerance = ITERATED if same else SOLIDS
    for x, y, *moved in rows:
        node = int(np.argmin(np.hypot(*(model.mesh.points - [x, y]).T)))
        assert frame.U[node] == pytest.approx(moved, abs=tolerance * size)

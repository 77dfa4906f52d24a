"""Decks as users of CalculiX and Abaqus/CAE write them run and give the right answer.

``answers.json`` holds for each deck of ``tests/data/user_decks`` the values, their tolerance and
where they come from: CalculiX 2.20 where it runs and is right, otherwise a closed form. CalculiX is
not used where it is wrong (buckling and modal dynamics of plane elements, implicit dynamics of
plane elements with NLGEOM, a beam of circular section with NLGEOM) or refuses (point masses on
beams, Abaqus's cards). Tolerances above 1e-3 are those of theory or of another discretization:
solids for beams, ties at nodes, penalties in contact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import corota as ct

FOLDER = Path(__file__).parents[1] / "data" / "user_decks"
ANSWERS = json.loads((FOLDER / "answers.json").read_text(encoding="utf-8"))
#: What is compared, from the displacements of the set OUT: relative to the largest value.
KINDS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "U": lambda u: u.ravel(),
    "mean U2": lambda u: u[:, 1].mean(keepdims=True),
    "last U2": lambda u: u[-1:, 1],
    "size": lambda u: np.hypot(*u[-1:].T),
}


def test_every_deck_has_an_answer() -> None:
    assert {path.stem for path in FOLDER.glob("*.inp")} == set(ANSWERS)
    assert len(ANSWERS) >= 50


@pytest.mark.parametrize("name", ANSWERS)
def test_a_deck_of_a_user_is_right(name: str) -> None:
    answer = ANSWERS[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(FOLDER / f"{name}.inp")
        results = ct.solve(model, threads=1)
    wanted = np.array(answer["values"])
    if answer["kind"] == "modes":
        found = np.asarray(results.modes[-1].factors)[: len(wanted)] / wanted
        wanted = np.ones(len(wanted))
    else:
        nodes = np.sort(model.mesh.nodes_of("OUT"))
        found = KINDS[answer["kind"]](results.frames[-1].U[nodes])
    close = answer["tolerance"] * np.abs(wanted).max()
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=close)

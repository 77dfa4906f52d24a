"""Cards of temperature and initial stress, and the way back into a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.io.formats import write
from corota.model.materials import Expansion

if TYPE_CHECKING:
    from pathlib import Path

DECK = """*NODE, NSET=nall
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=eall
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=ends
1, 4, 3, 6
*MATERIAL, NAME=steel
*ELASTIC
200000., .3
*EXPANSION, ZERO=20.
1.2e-5
*SOLID SECTION, ELSET=eall, MATERIAL=steel
2.
*INITIAL CONDITIONS, TYPE=TEMPERATURE
nall, 20.
*AMPLITUDE, NAME=up
0., 1., 1., 2.
*BOUNDARY
1, 2
3, 2
ends, 1
*STEP
*STATIC
*TEMPERATURE
nall, 120.
*END STEP
"""


def read(folder: Path, text: str) -> ct.Model:
    path = folder / "deck.inp"
    path.write_text(text)
    return ct.read(path)


def fault(folder: Path, text: str) -> str:
    with pytest.raises(ct.DeckError) as found:
        read(folder, text)
    return str(found.value)


def stress(model: ct.Model) -> np.ndarray:
    frame = ct.solve(model, threads=1).frames[-1]
    return np.concatenate([f.values["S"].reshape(-1, 4) for f in frame.fields])


def test_a_heated_bar_of_a_deck(tmp_path: Path) -> None:
    found = stress(read(tmp_path, DECK))
    assert found[:, 0] == pytest.approx(-200000.0 * 1.2e-5 * 100.0)
    assert np.abs(found[:, 1:]).max() < 1e-9


def test_an_amplitude_scales_the_temperature_itself(tmp_path: Path) -> None:
    """Temperature times factor, as CalculiX has it: 60 and 2 are 120 degrees."""
    deck = DECK.replace("*TEMPERATURE\nnall, 120.", "*TEMPERATURE, AMPLITUDE=up\nnall, 60.")
    assert stress(read(tmp_path, deck))[:, 0] == pytest.approx(-240.0)


def test_op_new_takes_temperatures_back(tmp_path: Path) -> None:
    deck = DECK + "*STEP\n*STATIC\n*TEMPERATURE, OP=NEW\n2, 20.\n*END STEP\n"
    assert np.abs(stress(read(tmp_path, deck))).max() < 1e-9


def test_expansion_as_a_table_and_along_axes(tmp_path: Path) -> None:
    table = DECK.replace("1.2e-5\n", "1e-5, 0.\n2e-5, 200.\n")
    assert read(tmp_path, table).sections[0].material.expansion == Expansion(
        (1e-5, 2e-5), (0.0, 200.0), 20.0
    )
    ortho = DECK.replace("*EXPANSION,", "*EXPANSION, TYPE=ORTHO,").replace(
        "1.2e-5\n", "1e-5, 2e-5, 3e-5\n"
    )
    assert read(tmp_path, ortho).sections[0].material.expansion == Expansion(
        ((1e-5, 2e-5, 3e-5),), (), 20.0
    )


@pytest.mark.parametrize(
    "line",
    [
        "eall, 10., 0., 5.",
        "eall, 10., 0., 0., 5.",
        "eall, 10., 0., 0., 5., 0., 0.",
        "1, 1, 10., 0., 0., 5., 0., 0.\n2, 1, 10., 0., 0., 5., 0., 0.\n"
        "2, 2, 10., 0., 0., 5., 0., 0.",
    ],
)
def test_initial_stress_of_both_programs(tmp_path: Path, line: str) -> None:
    deck = DECK.replace("*TEMPERATURE\nnall, 120.\n", "*TEMPERATURE\nnall, 20.\n")
    deck = deck.replace("*STEP\n", f"*INITIAL CONDITIONS, TYPE=STRESS\n{line}\n*STEP\n", 1)
    deck = deck.replace("ends, 1\n", "nall, 1, 2\n")
    assert stress(read(tmp_path, deck)) == pytest.approx(np.tile([10.0, 0.0, 0.0, 5.0], (8, 1)))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1.2e-5\n", "warm\n", "the coefficient"),
        ("1.2e-5\n", "1e-5, 50.\n1e-5, 40.\n", "must increase"),
        ("nall, 120.", "nall, 120., 3.", "gradient"),
        ("nall, 120.", "nill, 120.", "did you mean nall"),
        ("*STEP\n", "*INITIAL CONDITIONS, TYPE=STRESS\neall, 1., 2.\n*STEP\n", "1, 3, 4 or 6"),
        (
            "*STEP\n",
            "*INITIAL CONDITIONS, TYPE=STRESS\n1, 1, 1., 0., 0., 0., 0., 0.\n"
            "1, 2, 2., 0., 0., 0., 0., 0.\n*STEP\n",
            "different stresses",
        ),
    ],
)
def test_faults_are_named(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert said in fault(tmp_path, DECK.replace(old, new, 1))


def test_a_model_with_temperatures_is_written_and_read_back(tmp_path: Path) -> None:
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    model = ct.Model(mesh)
    expansion = Expansion((1e-5, 3e-5), (0.0, 100.0), 5.0)
    model.section("all", element="Q4I", material=ct.Elastic(2e5, 0.3, expansion=expansion))
    model.fix("left")
    model.fix("right", y=None)
    model.initial_temperature(15.0)
    model.temperature(np.linspace(20.0, 70.0, mesh.n_nodes))
    model.initial_stress(xx=np.array([3.0, 4.0])[:, None], xy=1.0)
    write(model, tmp_path / "out.inp")
    again = ct.read(tmp_path / "out.inp")
    one = ct.solve(model, ct.Static(), threads=1).frames[-1].U
    two = ct.solve(again, threads=1).frames[-1].U
    assert two == pytest.approx(one, rel=1e-12, abs=1e-15)

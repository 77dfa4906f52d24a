"""Constants that depend on field variables: at those of the whole model, or refused."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

DECK = """*NODE, NSET=ALL
1, 0., 0.
2, 4., 0.
3, 4., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*MATERIAL, NAME=M
*DENSITY, DEPENDENCIES=1
7., , 0.
8., , 3.
{material}*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1
{initial}
*STEP
*STATIC
{field}*END STEP
"""
TABLE = "*ELASTIC, DEPENDENCIES=1\n1000., 0., , 0.\n500., 0., , 1.\n200., .3, , 2.\n"


def read(path: Path, material: str = TABLE, initial: str = "ALL, 1.", field: str = "") -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(DECK.format(material=material, initial=initial, field=field))
    return ct.read(deck)


@pytest.mark.parametrize(
    ("value", "young", "ratio", "density"),
    [
        (0.0, 1000.0, 0.0, 7.0),
        (1.0, 500.0, 0.0, 7.0 + 1 / 3),
        (1.5, 350.0, 0.15, 7.5),
        (9, 200, 0.3, 8),
    ],
)
def test_constants_at_the_variable_of_the_model(
    tmp_path: Path, value: float, young: float, ratio: float, density: float
) -> None:
    """Linear between the lines, constant outside."""
    model = read(tmp_path, initial=f"ALL, {value}", field=f"*FIELD, VARIABLE=1\n1, {value}\n")
    material = model.sections[0].material
    assert (material.E, material.nu, material.rho) == pytest.approx((young, ratio, density))
    assert any("which the whole model has" in note for note in model.notes)


def test_without_a_value_the_variable_is_zero(tmp_path: Path) -> None:
    material = read(tmp_path, initial="ALL, 0.", material=TABLE).sections[0].material
    assert material.E == 1000.0
    other = TABLE.replace("1000., 0., , 0.", "1000., 0., , 0., 0.").replace(", 1.\n", ", 1., 0.\n")
    other = other.replace("DEPENDENCIES=1", "DEPENDENCIES=2").replace(", 2.\n", ", 2., 1.\n")
    assert read(tmp_path, other, "ALL, 1.").sections[0].material.E == 500.0


def test_temperatures_stay_beside_field_variables(tmp_path: Path) -> None:
    plastic = "*PLASTIC, DEPENDENCIES=1\n10., 0., 20., 1.\n12., .1, 20., 1.\n5., 0., 20., 2.\n"
    material = read(tmp_path, TABLE + plastic).sections[0].material
    assert isinstance(material, ct.Mises)
    np.testing.assert_allclose(material.yield_curve, [(10.0, 0.0), (12.0, 0.1)])


@pytest.mark.parametrize(
    ("initial", "field"),
    [("ALL, 0.", "*FIELD, VARIABLE=1\nALL, 1.\n"), ("1, 0.\n2, 1.", "")],
)
def test_variables_that_are_not_constant_are_refused_once(
    tmp_path: Path, initial: str, field: str
) -> None:
    with pytest.raises(ct.DeckError, match="not the same everywhere") as caught:
        read(tmp_path, initial=initial, field=field)
    assert len(caught.value.diagnostics) == 2  # *DENSITY and *ELASTIC
    assert "*TEMPERATURE" in str(caught.value)


def test_lines_that_do_not_reach_the_variables_are_refused(tmp_path: Path) -> None:
    table = "*ELASTIC, DEPENDENCIES=2\n1000., 0., , 0., 1.\n500., 0., , 1., 2.\n"
    with pytest.raises(ct.DeckError, match="no line is at the field variables 1, 0"):
        read(tmp_path, table)

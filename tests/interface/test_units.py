"""Units: labels everywhere, checks, and nothing converted."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError
from corota.model.units import Units
from corota.results.table import TABLE
from corota.results.variables import dimension


def strip(**material: float) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1), name="strip")
    given = {"E": 210e3, "nu": 0.3} | material
    kind = ct.Mises if "yield_stress" in given else ct.Elastic
    model.section(element="Q4I", material=kind(**given))
    model.fix("left")
    model.force("right", y=-0.1)
    return model


@pytest.mark.parametrize(
    ("names", "dimension", "label"),
    [
        (("mm", "N"), "force/length^2", "MPa"),
        (("m", "N", "kg", "s"), "force/length^2", "Pa"),
        (("m", "kN"), "energy", "kJ"),
        (("mm", "N"), "energy/length^3", "mJ/mm³"),
        (("in", "lbf"), "force/length^2", "psi"),
        (("in", "lbf"), "force*length", "lbf·in"),
        (("mm", "N", "s"), "length/time^2", "mm/s²"),
        (("mm", "N"), "length/time", ""),
        (("mm", "s"), "1/time", "1/s"),
        ((), "force", ""),
    ],
)
def test_derived_units_have_their_names(names: tuple[str], dimension: str, label: str) -> None:
    assert Units.of(*names).label(dimension) == label


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (("mm", "N", "kg", "s"), "take the mass in t"),
        (("mm", "N", "kg"), "inconsistent units"),
        (("mm", "Newton"), "unknown unit 'Newton'"),
        (("mm", "m"), "two units of length"),
    ],
)
def test_units_that_do_not_fit_are_refused(names: tuple[str], text: str) -> None:
    with pytest.raises(InputError, match=text):
        strip().units(*names)


@pytest.mark.parametrize(
    "names", [("mm", "kN", "kg", "ms"), ("m", "kN", "t", "s"), ("mm", "kN", "kg")]
)
def test_consistent_systems_are_taken(names: tuple[str]) -> None:
    strip().units(*names)


def test_a_variable_has_the_dimension_of_its_components() -> None:
    """Whole tensors and vectors too: xarray had stresses without a unit."""
    assert dimension("S") == "force/length^2"
    for name, row in TABLE.items():
        assert {dimension(part) for part, _ in row.parts} == {dimension(name)}, name


def test_a_comment_of_a_deck_names_the_units(tmp_path: Path) -> None:
    model = strip()
    model.units("mm", "N", "t", "s", "°C")
    path = ct.write(model, tmp_path / "strip.inp")
    assert "** UNITS: mm, N, t, s, °C\n" in path.read_text()
    assert ct.read(path).unit_system == model.unit_system


@pytest.mark.parametrize(
    "comment", ["** UNITS: SI (mm)", "** units = furlongs", "** Units: N, mm, kg"]
)
def test_a_comment_that_is_not_understood_is_a_note(tmp_path: Path, comment: str) -> None:
    path = ct.write(strip(), tmp_path / "strip.inp")
    text = path.read_text()
    path.write_text(f"*HEADING\n{comment}\n" + text.split("\n", 1)[1])
    read = ct.read(path)
    assert not read.unit_system
    assert any("strip.inp:2: the units of this comment are ignored" in n for n in read.notes)


def test_units_label_files_and_axes_and_change_no_number(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    plain, reported = strip(), strip()
    reported.units("mm", "N", "t", "s")
    results = [
        ct.solve(m, ct.Static(), observers=[ct.JobFiles(tmp_path, n)], threads=1)
        for m, n in ((plain, "plain"), (reported, "told"))
    ]
    assert np.array_equal(results[0].frame().U, results[1].frame().U)
    heads = [(tmp_path / f"{n}.csv").read_text().split("\n") for n in ("plain", "told")]
    assert heads[0][1:] == heads[1][1:]
    assert "time [s],step time [s],dt [s],load factor," in heads[1][0]
    for heading in ("largest U [mm]", "largest MISES [MPa]", "RF1 left [N]", "ALLSE [mJ]"):
        assert heading in heads[1][0]
    assert "[" not in heads[0][0]
    with ct.read_results(tmp_path / "told.vtkhdf") as read:
        assert read.model.unit_system == reported.unit_system
        figure = read.plot("S11")
        labels = [ax.get_xlabel() + ax.get_ylabel() for ax in figure.axes]
        assert any("S11: Cauchy stress xx [MPa]" in label for label in labels)
        assert any("x [mm]" in label for label in labels)
    figure = results[1].history("U2", at="right").plot(against="time")
    assert figure.axes[0].get_xlabel() == "time [s]"
    assert figure.axes[0].get_ylabel() == "U2: displacement y [mm], at right"


def findings(model: ct.Model) -> str:
    return " ".join(d.message for d in model.check().warnings)


def test_mixed_units_are_noticed_plasticity_included() -> None:
    assert "which no solid" not in findings(strip(yield_stress=250.0))
    assert "yield stress 2.5e+08 is 1.19e+03 of E" in findings(strip(yield_stress=250e6))
    reported = strip(E=210e9)
    reported.units("mm", "N")
    assert "2.1e+17 Pa, which no solid has" in findings(reported)
    reported = strip(rho=7850.0)
    reported.units("mm", "N", "t", "s")
    assert "kg/m^3" in findings(reported)
    reported = strip(rho=7.85e-9)
    reported.units("mm", "N", "t", "s")
    assert "which no solid" not in findings(reported)
    reported = strip(E=210.0, rho=7.85e-6)
    reported.units("mm", "kN", "kg", "ms")
    assert "which no solid" not in findings(reported)

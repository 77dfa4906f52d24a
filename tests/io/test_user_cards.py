"""Cards of CAE programs with a plain meaning, beside closed forms or the same in other words."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.report.content import content_of_results

ROOT = Path(__file__).parents[2]
PLATE = """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 4., 0.
4, 0., 3.
5, 2., 3.
6, 4., 3.
*ELEMENT, TYPE=CPS4I, ELSET=E
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=LEFT
1, 4
*SURFACE, NAME=RIGHT
2, S2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
1.
*EXPANSION
1e-3,
*SOLID SECTION, ELSET=E, MATERIAL=M
2.
{model}*BOUNDARY
LEFT, 1, 2
*STEP
{step}*END STEP
"""
BEAM = """*NODE
1, 0., 0.
2, 5., 0.
3, 10., 0.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2
2, 2, 3
*MATERIAL, NAME=M
*ELASTIC
1000., 0.25
*DENSITY
1.
{section}
*BOUNDARY
1, 1, 6
*STEP{perturbation}
{step}*END STEP
"""
RECT = "*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n1., .5\n0., 0., -1."


def solve(tmp_path: Path, text: str) -> ct.Results:
    path = tmp_path / "job.inp"
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(ct.read(path), threads=1)


def plate(tmp_path: Path, model: str = "", step: str = "*STATIC\n") -> ct.Results:
    return solve(tmp_path, PLATE.format(model=model, step=step))


def beam(tmp_path: Path, step: str, section: str = RECT, type_: str = "B21") -> ct.Results:
    perturbation = ", PERTURBATION" if "BUCKLE" in step else ""
    text = BEAM.format(type=type_, section=section, step=step, perturbation=perturbation)
    return solve(tmp_path, text)


@pytest.mark.parametrize(
    "load", ["*DSLOAD\nRIGHT, HP, 6., {level}, {at}\n", "*DLOAD\nE2, HP2, 6., {level}, {at}\n"]
)
@pytest.mark.parametrize(("level", "at"), [(3.0, 0.0), (1.5, 0.0), (0.0, 3.0), (9.0, 6.0)])
def test_a_liquid_presses_with_its_force_and_moment(tmp_path: Path, load, level, at) -> None:
    text = load.format(level=level, at=at)
    results = plate(tmp_path, "*ELSET, ELSET=E2\n2,\n", "*STATIC\n" + text)
    y, w = np.polynomial.legendre.leggauss(400)
    y, w = 1.5 + 1.5 * y, 1.5 * w
    p = np.maximum(6.0 * (y - level) / (at - level), 0.0)
    force, moment = 2.0 * (w @ p), 2.0 * (w @ (p * y))
    frame = results.frames[-1]
    ends = [2, 5]  # of the loaded edge
    f = frame.F[ends, 0]
    assert -f.sum() == pytest.approx(force, rel=1e-4)
    assert -f @ np.array([0.0, 3.0]) == pytest.approx(moment, rel=1e-4)


def test_a_load_of_zero_ends_a_liquid(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 2.0, nx=1, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3))
    model.fix("left")
    first, second = ct.Static(), ct.Static()
    first.hydrostatic_pressure("right", 3.0, level=2.0, height=0.0)
    second.remove("hydrostatic pressure", "right")
    results = ct.solve(model, [first, second], threads=1)
    assert np.abs(results.frames[1].U).max() > 1e-3
    assert np.abs(results.frames[2].U).max() < 1e-9
    ct.write(model, tmp_path / "job.inp", [first])
    again = ct.read(tmp_path / "job.inp")
    assert again.steps[0].loads[0].value == (3.0, 2.0, 0.0)


@pytest.mark.parametrize(
    ("card", "factor"),
    [
        ("TOTAL MASS\n72.", 2.0),  # the plate has 24
        ("TOTAL MASS, DISTRIBUTION=VOLUME PROPORTIONAL\n72.", 2.0),
        ("MASS PER VOLUME\n3.", 2.0),
        ("MASS PER AREA\n6.", 2.0),
    ],
)
def test_mass_without_stiffness_lowers_frequencies(tmp_path: Path, card: str, factor) -> None:
    modes = "*FREQUENCY\n3\n"
    bare = plate(tmp_path, step=modes).modes[-1].factors
    lined = plate(tmp_path, f"*NONSTRUCTURAL MASS, ELSET=E, UNITS={card}\n", modes)
    np.testing.assert_allclose(lined.modes[-1].factors, bare / factor, rtol=1e-9)


def test_the_mass_of_a_lined_beam_is_that_of_its_page() -> None:
    model = ct.read(ROOT / "docs" / "decks" / "nonstructural.inp")
    lined = ct.solve(model, threads=1).modes[-1].factors
    for section in model.sections:
        section.material.rho = 2e-9
    bare = ct.solve(model, threads=1).modes[-1].factors
    np.testing.assert_allclose(lined, bare / 2.0, rtol=1e-9)


def test_all_modes_in_a_range_are_found(tmp_path: Path) -> None:
    every = plate(tmp_path, step="*FREQUENCY\n8\n").modes[-1].factors
    low, high = 0.5 * (every[1] + every[2]), 0.5 * (every[4] + every[5])
    found = plate(tmp_path, step=f"*FREQUENCY, EIGENSOLVER=LANCZOS\n, {low}, {high}, , ,\n")
    np.testing.assert_allclose(found.modes[-1].factors, every[2:5], rtol=1e-9)
    some = plate(tmp_path, step=f"*FREQUENCY\n2, {low}, {high}\n").modes[-1].factors
    np.testing.assert_allclose(some, every[2:4], rtol=1e-9)
    with pytest.raises(ct.ModelError, match="no frequency"):
        plate(tmp_path, step=f"*FREQUENCY\n, {low}, {1.001 * low}\n")


def test_a_pressure_on_the_end_of_a_column_buckles_it_as_a_force_does(tmp_path: Path) -> None:
    step = "*BUCKLE\n1\n{load}"
    text = PLATE.replace("*STEP\n", "*STEP, PERTURBATION\n")
    forces = "*CLOAD\n3, 1, -3.\n6, 1, -3.\n"
    by_force = solve(tmp_path, text.format(model="", step=step.format(load=forces)))
    pressed = solve(
        tmp_path, text.format(model="", step=step.format(load="*DSLOAD\nRIGHT, P, 1.\n"))
    )
    assert pressed.modes[-1].factors == pytest.approx(by_force.modes[-1].factors, rel=1e-6)
    assert any("keep their directions" in note for note in pressed.notes)
    with pytest.raises(ct.UnsupportedError, match="dead_loads"):
        ct.solve(pressed.model, ct.Buckle(loads=pressed.steps[0].loads), threads=1)


def test_temperatures_that_are_repeated_through_the_thickness(tmp_path: Path) -> None:
    start = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 20., 20., 20.\n"
    heat = "*STATIC\n*TEMPERATURE\nNALL, 120., 120.\n"
    frame = plate(tmp_path, start, heat).frames[-1]
    assert frame.U[2, 0] == pytest.approx(0.4, rel=1e-6)
    with pytest.raises(ct.DeckError, match="gradient"):
        plate(tmp_path, start, heat.replace("120., 120.", "120., 119."))


def test_a_node_between_two_others(tmp_path: Path) -> None:
    """A hanging node at a quarter of an edge that turns and stretches."""
    more = "*NODE\n7, 4., .75\n*ELEMENT, TYPE=SPRINGA, ELSET=S\n9, 7, 6\n*SPRING, ELSET=S\n\n1e-6\n"
    more += "*MPC\nLINEAR, 7, 3, 6\n"
    frame = plate(tmp_path, more, "*STATIC\n*CLOAD\n6, 1, 5.\n6, 2, 3.\n").frames[-1]
    u = frame.U
    np.testing.assert_allclose(u[6], 0.75 * u[2] + 0.25 * u[5], atol=1e-12)


def test_general_sections_have_the_shapes_of_beam_sections(tmp_path: Path) -> None:
    load = "*STATIC\n*CLOAD\n3, 2, 1.\n"
    general = (
        "*BEAM GENERAL SECTION, ELSET=E, SECTION=RECT, DENSITY=1.\n1., .5\n0., 0., -1.\n1000., 400."
    )
    one = beam(tmp_path, load).frames[-1].U
    two = beam(tmp_path, load, general).frames[-1].U
    np.testing.assert_allclose(two, one, rtol=1e-12, atol=1e-15)
    pipe = RECT.replace("RECT\n1., .5", "PIPE\n1., .1")
    np.testing.assert_allclose(
        beam(tmp_path, load, pipe, "PIPE21").frames[-1].U, beam(tmp_path, load, pipe).frames[-1].U
    )


def test_words_of_cae_that_change_nothing(tmp_path: Path) -> None:
    plain = plate(tmp_path, step="*STATIC\n*CLOAD\n6, 2, 3.\n").frames[-1].U
    text = PLATE.replace("*ELASTIC\n", "*ELASTIC, DEPENDENCIES=0\n")
    text = text.format(model="", step="*STATIC\n*CLOAD, SECTOR=1\n6, 2, 3.\n")
    np.testing.assert_allclose(solve(tmp_path, text).frames[-1].U, plain)
    with pytest.raises(ct.DeckError, match="SECTOR"):
        solve(tmp_path, text.replace("SECTOR=1", "SECTOR=2"))


@pytest.mark.parametrize("name", ["gap", "assembly_steps"])
def test_a_report_shows_surfaces_of_single_nodes_and_pairs_of_steps(name: str) -> None:
    results = ct.solve(ct.read(ROOT / "docs" / "decks" / f"{name}.inp"), threads=1)
    assert content_of_results(results).chunks

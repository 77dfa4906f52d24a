"""A name means one number, in memory, files, tables, pictures, `info` and measures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli.info import result_lines
from corota.plots import palette
from corota.plots.contour import color_scale
from corota.results.derived import DERIVED, Derived
from corota.results.table import COMPONENTS, DIMENSIONS, INVARIANTS, MEANING, NODAL, TABLE
from corota.results.variables import point_value
from corota.sweeps.measures import Measure


@pytest.fixture(scope="module")
def results() -> ct.Results:
    """A strip of two materials under compression and bending."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2), name="strip")
    lower = np.repeat([True, False], 10)
    flowing = ct.Mises(E=1e5, nu=0.3, yield_stress=60.0, isotropic=1e3, expansion=1e-5)
    model.section(lower, element="Q4I", material=flowing)
    model.section(~lower, element="Q4I", material=ct.Elastic(E=2e4, nu=0.3, expansion=1e-5))
    model.mesh.cell_sets["lower"] = np.flatnonzero(lower)
    model.fix("left")
    model.force("right", x=-20.0, y=-0.4)
    model.temperature(np.linspace(0.0, 50.0, model.mesh.n_nodes))
    return ct.solve(model, ct.Static(increments=3), threads=1)


def truth(results: ct.Results, name: str, frame: int = -1) -> np.ndarray:
    blocks = [b for b in results.frames[frame].fields if _has(b, name)]
    return np.concatenate([point_value(b, name).ravel() for b in blocks])


def _has(block: ct.results.frame.PointFields, name: str) -> bool:
    try:
        point_value(block, name)
    except KeyError:
        return False
    return True


POINTS = ("S11", "S22", "S12", "MISES", "SP1", "SP3", "E11", "EP3", "PEEQ", "ENER", "PE11")


@pytest.mark.parametrize("options", [{}, {"points": True}, {"fields": ["U"]}])
def test_history_is_of_the_points_in_memory_and_in_every_file(
    results: ct.Results, tmp_path: Path, options: dict
) -> None:
    path = results.write(tmp_path / "strip.vtkhdf", **options)
    with ct.read_results(path) as read:
        for name in POINTS:
            if name not in read.variables():
                continue
            low, high = truth(results, name).min(), truth(results, name).max()
            for source in (results, read):
                assert source.history(name, combine="min")[-1] == low
                assert source.history(name, combine="max")[-1] == high
                largest = low if abs(low) > abs(high) else high
                assert source.history(name)[-1] == largest, name
                found = source.extremes(name)
                assert (found.smallest.value, found.largest.value) == (low, high)
            assert read.extremes(name) == results.extremes(name)
            assert read.extremes(name, at="nodes") == results.extremes(name, at="nodes")
            np.testing.assert_array_equal(read.nodal(name), results.nodal(name))
            nodal = results.history(name, at="nodes")
            assert "(nodal)" in nodal.name
            np.testing.assert_array_equal(read.history(name, at="nodes"), nodal)


def test_extremes_are_where_they_are(results: ct.Results) -> None:
    for name in POINTS:
        found = results.extremes(name)
        for extreme in (found.smallest, found.largest, found.by_size):
            cell = int(np.flatnonzero(results.mesh.cell_labels == extreme.element)[0])
            block = next(b for b in results.frames[-1].fields if cell in b.cells)
            row = int(np.flatnonzero(block.cells == cell)[0])
            assert point_value(block, name)[row, extreme.point - 1] == extreme.value
            at = block.points[row, extreme.point - 1]
            assert (extreme.x, extreme.y) == tuple(at)
    low = results.extremes("U2").smallest
    node = int(np.flatnonzero(results.mesh.node_labels == low.node)[0])
    assert results.frames[-1].U[node, 1] == low.value == results.frames[-1].U[:, 1].min()


def test_compression_is_not_lost(results: ct.Results) -> None:
    stress = truth(results, "S11")
    assert stress.min() < -abs(stress.max())
    assert results.history("S11")[-1] == stress.min()
    every = np.concatenate([truth(results, "S11", i) for i in range(len(results.frames))])
    assert Measure("min(S11)")(results) == every.min()
    assert Measure("max(S11)")(results) == every.max()
    assert Measure("absmax(S11)")(results) == np.abs(every).max()
    assert Measure("last(S11)")(results) == stress.min()
    assert Measure("min(S11@nodes)")(results) == min(
        results.nodal("S11", i).min() for i in range(len(results.frames))
    )


def test_names_of_measures_may_have_blanks(results: ct.Results) -> None:
    for name in ("load factor", "strain energy", "external work", "step time"):
        wanted = float(np.max(results.history(name)))
        assert Measure(f"max({name})")(results) == wanted
        assert Measure(f"max({name}) + 2 * last('{name}')")(results) == pytest.approx(3 * wanted)


def test_element_sets_have_points_and_nodes_have_nodal_values(results: ct.Results) -> None:
    lower = next(b for b in results.frames[-1].fields if 0 in b.cells)
    assert results.history("S11", at="lower", combine="min")[-1] == lower.values["S"][..., 0].min()
    at_left = results.history("S11", at="left")
    assert at_left.name == "S11 at left (nodal)"
    assert at_left[-1] == results.nodal("S11")[results.mesh.nodes_of("left")].mean()


def test_nodal_values_do_not_mix_sections(results: ct.Results) -> None:
    each = np.stack([results.nodal("S11", section=int(s)) for s in np.unique(results.sections())])
    nodal = results.nodal("S11")
    assert (np.abs(nodal[None] - each).min(axis=0) == 0.0).all()


def test_nodal_scalars_are_the_documented_average() -> None:
    """Linear fields are extrapolated exactly; positive variables are cut off after averaging."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1.0, nu=0.0))
    model.fix("left")
    model.force("right", x=1e-3)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    (block,) = results.frames[-1].fields
    for name in ("ENER", "PEEQ"):
        block.values[name] = block.points[..., 0] - 0.2
        wanted = np.maximum(results.mesh.points[:, 0] - 0.2, 0.0)
        np.testing.assert_allclose(results.nodal(name), wanted, atol=3e-3)


def test_files_with_nodal_values_only_say_so(results: ct.Results, tmp_path: Path) -> None:
    for ending in ("frd", "pvd"):
        with ct.read_results(results.write(tmp_path / f"strip.{ending}")) as read:
            with pytest.raises(ct.InputError, match='at="nodes"'):
                read.history("S11")
            assert read.history("S11", at="nodes").name == "S11 (nodal)"
            assert all(
                "(nodal)" in t for t in result_lines(read) if t.split()[0] in ("S11", "PEEQ")
            )


def test_info_and_tables_have_the_same_numbers(results: ct.Results, tmp_path: Path) -> None:
    with ct.read_results(results.write(tmp_path / "strip.vtkhdf")) as read:
        assert result_lines(read) == result_lines(results)
    line = next(t for t in result_lines(results) if t.split()[0] == "S11")
    found = results.extremes("S11")
    assert f"{found.smallest.value:.6g}  element {found.smallest.element}" in line
    from corota.io.tables.csv_history import Histories

    table = Histories(results.model, [ct.Static()], ["S11", "S11@nodes", "S11@right", "U2@right"])
    row = table.row(results.frames[-1])
    assert row["largest MISES"] == results.extremes("MISES").largest.value
    assert row["smallest S11"] == found.smallest.value
    assert row["smallest S11 (nodal)"] == results.nodal("S11").min()
    assert row["U2 right"] == results.history("U2", at="right")[-1]


def test_temperature_is_a_history_and_an_axis(results: ct.Results, tmp_path: Path) -> None:
    heat = results.history("temperature", at="nodes", combine="max")
    assert heat.values == pytest.approx([0.0, 50 / 3, 100 / 3, 50.0])
    assert results.history("U1", at="right").plot(against=heat, path=tmp_path / "t.png")
    for ending in ("vtkhdf", "frd", "pvd"):
        with ct.read_results(results.write(tmp_path / f"heat.{ending}")) as read:
            np.testing.assert_allclose(read.nodal("NT"), results.frames[-1].T, rtol=1e-5)


def test_resultant_of_reactions() -> None:
    """A ring under pressure: sizes of reactions add up, their resultant is the force."""
    model = ct.Model(ct.mesh.rectangle(2.0, 2.0, nx=4, ny=4))
    model.section(element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", x=3.0, y=4.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    assert results.history("RF", at="left")[-1] == pytest.approx(5.0)
    assert results.history("F", at="right")[-1] == pytest.approx(5.0)


def test_signed_variables_have_the_signs_of_colors() -> None:
    for low, high in ((-600.0, -100.0), (100.0, 600.0), (-300.0, 500.0), (-500.0, 0.0)):
        colors, levels = color_scale(low, high, signed=True)
        size = max(abs(low), abs(high))
        ends = (-size, size) if low < 0.0 < high else (levels[0], levels[-1])
        for value in (low, high):
            red, _, blue, _ = colors((value - ends[0]) / (ends[1] - ends[0]))
            if abs(value) > 0.1 * size:
                assert (red > blue) == (value > 0.0), (low, high, value)
    assert color_scale(0.0, 5.0, signed=False)[0].name == palette.SEQUENTIAL


def test_one_table_gives_all_lists() -> None:
    names = {n for row in TABLE.values() for n in row.names}
    assert names == set(DIMENSIONS) == set(MEANING)
    assert {*NODAL, *COMPONENTS, *INVARIANTS} <= names


def test_variables_of_users_reach_decks_and_frd(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    rule = Derived(lambda b: b.values["S"][..., :3].mean(axis=-1), "mean stress [force/length^2]")
    monkeypatch.setitem(DERIVED, "PRESS", rule)
    deck = tmp_path / "d.inp"
    deck.write_text(
        "*NODE, NSET=N\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT, TYPE=CPS4, ELSET=E\n1,1,2,3,4\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000.,.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"
        "*BOUNDARY\n1,1,2\n4,1,1\n*STEP\n*STATIC\n*CLOAD\n2,1,.5\n3,1,.5\n"
        "*EL PRINT, ELSET=E\nPRESS\n"
        "*END STEP\n"
    )
    model = ct.read(deck)
    assert model.steps[0].outputs[0].variables == ("PRESS",)
    results = ct.solve(model, observers=[ct.JobFiles(tmp_path, formats=["vtkhdf", "frd"])])
    value = results.history("PRESS")[-1]
    assert value == pytest.approx(1.0 / 3.0, rel=1e-2)
    assert f"{value:.6E}" in (tmp_path / "d.dat").read_text()
    with ct.read_results(tmp_path / "d.frd") as read:
        assert read.history("PRESS", at="nodes")[-1] == pytest.approx(value, rel=1e-5)

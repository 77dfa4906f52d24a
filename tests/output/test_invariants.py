"""A record of an invariant reaches every output, with the value of its formula."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

import corota as ct
from corota.cli.info import result_lines
from corota.report.fields import NodalArrays
from corota.results import invariants
from corota.results.derived import DERIVED, Derived
from corota.results.table import INVARIANTS, TABLE, markdown
from corota.results.variables import point_value

PAGE = Path(__file__).resolve().parents[2] / "docs" / "output.md"
DECK = """*NODE
1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,2,0\n6,2,1
*ELEMENT, TYPE=CPS4, ELSET=E\n1,1,2,3,4\n2,2,5,6,3
*MATERIAL, NAME=M\n*ELASTIC\n1000.,.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.
*BOUNDARY\n1,1,2\n4,1,2
*STEP\n*STATIC\n*CLOAD\n5,1,.5\n6,2,.5\n*EL PRINT, ELSET=E\n{0}\n*EL FILE\nS,E,{0}\n*END STEP
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[ct.Results, Path]:
    folder = tmp_path_factory.mktemp("run")
    deck = folder / "d.inp"
    deck.write_text(DECK.format(",".join(INVARIANTS)))
    files = ct.JobFiles(folder, formats=["vtkhdf", "frd"], histories=list(INVARIANTS))
    return ct.solve(ct.read(deck), observers=[files]), folder


@pytest.mark.parametrize("name", INVARIANTS)
def test_every_output_has_it(run: tuple[ct.Results, Path], name: str) -> None:
    results, folder = run
    last = results.frames[-1].fields[0]
    points, nodal = point_value(last, name), results.nodal(name)
    largest = points.max()
    assert np.ptp(points) > 0.0
    assert results.history(name, combine="max")[-1] == largest
    for value in points.ravel():
        assert f"{value:.6E}" in (folder / "d.dat").read_text()
    with ct.read_results(folder / "d.vtkhdf") as read:
        assert read.history(name, combine="max")[-1] == largest
        assert read.nodal(name) == pytest.approx(nodal, rel=1e-12, abs=1e-12)
        assert any(line.split()[0] == name for line in result_lines(read))
    with ct.read_results(folder / "d.frd") as read:
        assert read.nodal(name) == pytest.approx(nodal, rel=1e-4, abs=1e-5)
    assert f" -4  {name} " in (folder / "d.frd").read_text()
    array = INVARIANTS[name][1].array
    with h5py.File(folder / "d.vtkhdf") as file:
        assert array in file["VTKHDF/PointData"]
    table = (folder / "d.csv").read_text().splitlines()
    column = table[0].split(",").index(f"largest {name}")
    assert float(table[-1].split(",")[column]) == pytest.approx(largest)


def test_the_report_has_arrays_of_those_that_it_does_not_compute(
    run: tuple[ct.Results, Path],
) -> None:
    arrays = NodalArrays(run[0])
    assert {"S", "TRESC", "TRIAX"} <= set(arrays.names)
    values = arrays.read(1, ["TRIAX"], 20)["TRIAX"]
    assert values == pytest.approx(run[0].nodal("TRIAX"), rel=1e-4)


def test_a_variable_of_a_user_has_every_output(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    mean = Derived(lambda block: block.values["S"][..., :3].mean(axis=-1))
    monkeypatch.setitem(DERIVED, "SMEAN", mean)
    deck = tmp_path / "d.inp"
    deck.write_text(DECK.format("SMEAN"))
    files = ct.JobFiles(tmp_path, formats=["vtkhdf", "frd"], histories=["SMEAN"])
    results = ct.solve(ct.read(deck), observers=[files])
    values = point_value(results.frames[-1].fields[0], "SMEAN")
    text = (tmp_path / "d.dat").read_text()
    assert all(f"{value:.6E}" in text for value in values.ravel())
    assert " -4  SMEAN " in (tmp_path / "d.frd").read_text()
    assert "largest SMEAN" in (tmp_path / "d.csv").read_text()
    with ct.read_results(tmp_path / "d.vtkhdf") as read:
        assert read.nodal("SMEAN") == pytest.approx(results.nodal("SMEAN"))
        assert read.history("SMEAN", combine="max")[-1] == values.max()
    assert "SMEAN" in NodalArrays(results).names


def test_an_frd_file_without_requests_leaves_them_to_its_reader(
    run: tuple[ct.Results, Path], tmp_path: Path
) -> None:
    deck = tmp_path / "d.inp"
    deck.write_text(DECK.format("S").replace("*EL PRINT, ELSET=E\nS\n*EL FILE\nS,E,S\n", ""))
    ct.solve(ct.read(deck)).write(tmp_path / "d.frd")
    text = (tmp_path / "d.frd").read_text()
    assert " -4  STRESS " in text
    assert not [name for name in INVARIANTS if f" -4  {name} " in text]
    with ct.read_results(tmp_path / "d.frd") as read:
        assert read.nodal("TRIAX") == pytest.approx(run[0].nodal("TRIAX"), rel=1e-4)


def test_a_file_of_an_invariant_alone_is_read(run: tuple[ct.Results, Path], tmp_path: Path) -> None:
    results = run[0]
    for ending in ("vtkhdf", "frd"):
        path = results.write(tmp_path / f"d.{ending}", fields=["U", "TRIAX"])
        with ct.read_results(path) as read:
            assert read.nodal("TRIAX") == pytest.approx(results.nodal("TRIAX"), rel=1e-4)
            assert "S11" not in read.variables()


@pytest.mark.parametrize(
    ("stress", "tresca", "triaxiality"),
    [
        ((2.0, 0.0, 0.0, 0.0), 2.0, 1.0 / 3.0),  # uniaxial tension
        ((0.0, -2.0, 0.0, 0.0), 2.0, -1.0 / 3.0),
        ((3.0, 3.0, 0.0, 0.0), 3.0, 2.0 / 3.0),  # equibiaxial
        ((0.0, 0.0, 0.0, 5.0), 10.0, 0.0),  # shear
        ((3.0, 0.0, 1.5, 0.0), 3.0, 1.0 / 3.0**0.5),  # plane strain, incompressible
        ((0.0, 0.0, 0.0, 0.0), 0.0, 0.0),
    ],
)
def test_formulas(stress: tuple[float, ...], tresca: float, triaxiality: float) -> None:
    tensor = np.array([stress])
    assert invariants.tresca(tensor) == pytest.approx([tresca])
    assert invariants.triaxiality(tensor) == pytest.approx([triaxiality])


def test_the_triaxiality_of_a_hydrostatic_stress_is_huge_and_finite() -> None:
    found = invariants.triaxiality(np.array([[1.0, 1.0, 1.0, 0.0], [-1.0, -1.0, -1.0, 0.0]]))
    assert found == pytest.approx([1.0 / np.finfo(float).eps, -1.0 / np.finfo(float).eps])


def test_files_of_fewer_invariants_are_read(run: tuple[ct.Results, Path], tmp_path: Path) -> None:
    """A file of a version that had the first five names of the rows of a stress alone."""
    path = run[0].write(tmp_path / "d.vtkhdf")
    with h5py.File(path, "r+") as file:
        group = file["corota/extremes"]
        rows = group["S"][:]
        frames = len(rows) // len(TABLE["S"].names)
        del group["S"]
        group["S"] = rows.reshape(frames, -1, 10)[:, :5].reshape(-1, 10)
    with ct.read_results(path) as read:
        assert read.history("MISES")[-1] == run[0].history("MISES")[-1]
        assert read.nodal("TRIAX") == pytest.approx(run[0].nodal("TRIAX"))


def test_the_documents_have_the_table() -> None:
    assert "\n".join(markdown()) in PAGE.read_text(encoding="utf-8"), (
        "paste into docs/output.md, section Variables: "
        "python -c 'from corota.results.table import *; print(*markdown(), sep=chr(10))'"
    )

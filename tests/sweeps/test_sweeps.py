"""A sweep gives the numbers of single runs, in any executor, keeps errors and goes on."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.cli.parser import _values as range_of
from corota.sweeps.measures import Measure

DECK = """\
*PARAMETER
t = 1.0
half = t / 2
*NODE, NSET=ALL
1, 0., 0.
2, 10., 0.
3, 10., <t>
4, 0., <t>
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
<half>
*NSET, NSET=left
1, 4
*NSET, NSET=right
2, 3
*BOUNDARY
left, 1, 2
*STEP
*STATIC
*BOUNDARY
right, 1, 1, 0.1
*END STEP
"""


def strip(length: float, height: float = 1.0) -> tuple[ct.Model, ct.Static]:
    if length > 90.0:
        raise ct.InputError(f"too long: {length}")
    model = ct.Model(ct.mesh.rectangle(length, height, nx=4, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.fix("right", x=0.01 * length)
    return model, ct.Static(increments=2, nlgeom=False)


def force(results: ct.Results) -> float:
    return float(results.history("RF1", at="right")[-1])


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "bar.inp"
    path.write_text(DECK)
    return path


def test_a_grid_is_what_single_runs_give() -> None:
    found = ct.sweep(
        strip,
        {"length": [5.0, 10.0], "height": [1.0, 2.0]},
        {"F": force, "same": "last(RF1@right)", "twice": "RF1@right * 2"},
        workers=1,
    )
    assert found["length"].tolist() == [5.0, 5.0, 10.0, 10.0]
    assert found["height"].tolist() == [1.0, 2.0, 1.0, 2.0]
    assert found["F"] == pytest.approx(10.0 * found["height"], rel=1e-12)
    assert found["same"].tolist() == found["F"].tolist()
    assert found["twice"].tolist() == (2.0 * found["F"]).tolist()


def test_all_executors_give_the_same_bits() -> None:
    rows = [{"length": 5.0 + i} for i in range(4)]
    alone = ct.sweep(strip, rows, {"F": force, "S": "max(MISES)"}, workers=1)
    with ThreadPoolExecutor(2) as pool:
        threads = ct.sweep(strip, rows, {"F": force, "S": "max(MISES)"}, executor=pool)
    assert threads["S"].tolist() == alone["S"].tolist()
    assert threads["F"].tolist() == alone["F"].tolist()


@pytest.mark.slow
def test_processes_give_the_same_bits(deck: Path) -> None:
    alone = ct.sweep(deck, {"t": [1.0, 2.0, 3.0]}, ["RF1@right"], workers=1)
    default = ct.sweep(deck, {"t": [1.0, 2.0, 3.0]}, ["RF1@right"], workers=2)
    assert default["RF1@right"].tolist() == alone["RF1@right"].tolist()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        other = ct.sweep(deck, {"t": [1.0, 2.0, 3.0]}, ["RF1@right"], executor=pool)
    assert other["RF1@right"].tolist() == alone["RF1@right"].tolist()


def test_a_failed_row_keeps_its_reason_and_the_others_their_numbers() -> None:
    found = ct.sweep(strip, {"length": [5.0, 95.0]}, {"F": force}, workers=1)
    assert found.failed == [1]
    assert "too long: 95" in found["error"][1]
    assert np.isfinite(found["F"][0])
    assert np.isnan(found["F"][1])
    with pytest.raises(ct.InputError, match="every row of the sweep failed; the first: too long"):
        ct.sweep(strip, {"length": [91.0, 95.0]}, {"F": force}, workers=1)


def test_an_error_of_the_build_function_names_its_kind() -> None:
    found = ct.sweep(lambda n: strip(1.0 / n), {"n": [0, 1]}, {"F": force}, workers=1)
    assert found["error"][0].startswith("ZeroDivisionError: ")


def test_a_stopped_sweep_goes_on(tmp_path: Path) -> None:
    store, runs = tmp_path / "rows.jsonl", []

    def counted(length: float) -> Any:
        runs.append(length)
        if len(runs) == 3:
            raise KeyboardInterrupt
        return strip(length)

    rows = {"length": [5.0, 6.0, 7.0, 95.0]}
    with pytest.raises(KeyboardInterrupt):
        ct.sweep(counted, rows, {"F": force}, workers=1, store=store)
    with store.open("a") as file:
        file.write('{"digest": "cut')  # the line that was being written
    found = ct.sweep(counted, rows, {"F": force}, workers=1, store=store)
    assert runs == [5.0, 6.0, 7.0, 7.0, 95.0]
    assert found["F"][:3] == pytest.approx(10.0, rel=1e-12)
    assert found.failed == [3]
    again = ct.sweep(counted, rows, {"F": force}, workers=1, store=store)
    assert runs[5:] == [95.0], "failed rows run again, others do not"
    assert again["F"][:3].tolist() == found["F"][:3].tolist()


def test_the_store_knows_the_measures_and_the_deck(deck: Path, tmp_path: Path) -> None:
    store = tmp_path / "rows.jsonl"
    first = ct.sweep(deck, {"t": [1.0]}, ["RF1@right"], workers=1, store=store)
    other = ct.sweep(deck, {"t": [1.0]}, ["last(U1@right)"], workers=1, store=store)
    assert other["last(U1@right)"][0] == pytest.approx(0.1)
    deck.write_text(DECK.replace("1000., 0.", "2000., 0."))
    changed = ct.sweep(deck, {"t": [1.0]}, ["RF1@right"], workers=1, store=store)
    assert changed["RF1@right"][0] == pytest.approx(2.0 * first["RF1@right"][0])
    with pytest.raises(ct.FileError, match=r"bar\.inp:1: not a row of a sweep"):
        ct.sweep(deck, {"t": [1.0]}, ["RF1@right"], workers=1, store=deck)


def test_parameters_of_a_deck_are_replaced_with_what_depends_on_them(deck: Path) -> None:
    model = ct.read(deck, parameters={"T": 2.0})
    assert model.mesh.points[:, 1].max() == 2.0
    assert model.sections[0].thickness == 1.0
    with pytest.raises(ct.InputError, match=r"no \*PARAMETER named q; there are t, half"):
        ct.read(deck, parameters={"q": 2.0})


@pytest.mark.parametrize(
    "text",
    [
        "",
        "max(",
        "max(U1@tip, 2)",
        "top(U1)",
        "__import__('os')",
        "U1.real",
        "max(1)",
        "[1]",
        "U1@1.5",
    ],
)
def test_what_is_no_measure_is_refused(text: str) -> None:
    with pytest.raises(ct.InputError, match="write REDUCER"):
        Measure(text)


def test_measures_of_moments_nodes_and_scalars() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=2))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    model.force("right", y=0.5)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    assert Measure("RM3@left")(results) == pytest.approx(-5.0, rel=1e-9)
    node = int(results.mesh.node_labels[results.mesh.nodes_of("right")[0]])
    tip = results.frames[-1].U[results.mesh.nodes_of("right")[0], 1]
    assert Measure(f"max(U2@{node})")(results) == tip
    assert Measure("'load factor'")(results) == 1.0
    assert Measure("abs(-absmax('strain energy')) ** 2 - 1")(results) == pytest.approx(
        results.frames[-1].scalars["strain energy"] ** 2 - 1.0
    )
    with pytest.raises(ct.InputError, match="there is no node 999"):
        Measure("U1@999")(results)


def test_designs() -> None:
    rows = ct.sample(8, {"a": (0.0, 1.0), "b": (5.0, 6.0)}, engine="sobol", seed=3)
    assert rows == ct.sample(8, {"a": (0.0, 1.0), "b": (5.0, 6.0)}, engine="sobol", seed=3)
    assert all(0.0 <= r["a"] <= 1.0 and 5.0 <= r["b"] <= 6.0 for r in rows)
    # One point in each eighth of every axis.
    assert sorted(int(8 * r["a"]) for r in rows) == list(range(8))
    assert ct.grid(a=[1, 2], b=[3, 4]) == [
        {"a": 1, "b": 3},
        {"a": 1, "b": 4},
        {"a": 2, "b": 3},
        {"a": 2, "b": 4},
    ]
    with pytest.raises(ct.InputError, match="lower and a larger upper bound"):
        ct.sample(2, {"a": (1.0, 0.0)})


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"parameters": {}}, "no rows"),
        ({"parameters": {"length": 3.0}}, "give a list of values"),
        ({"parameters": [{"length": 1.0}, {"height": 1.0}]}, "row 1 of the sweep"),
        ({"measures": {}}, "at least one measure"),
        ({"measures": {"F": 3}}, "a function of the results or a string"),
        ({"measures": {"length": force}}, "both a parameter and a measure"),
        ({"workers": 0}, "at least one worker"),
    ],
)
def test_bad_sweeps_are_refused(given: dict[str, Any], message: str) -> None:
    call = {"parameters": {"length": [5.0]}, "measures": {"F": force}, "workers": 1} | given
    with pytest.raises(ct.InputError, match=message):
        ct.sweep(strip, call.pop("parameters"), call.pop("measures"), **call)


def test_the_command_writes_a_table_and_goes_on(
    deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    call = ["sweep", "bar.inp", "-p", "t=1:3:3", "-m", "max(RF1@right)", "--workers", "1"]
    assert main(call) == 0
    with (tmp_path / "bar_sweep.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(r["t"]) for r in rows] == [1.0, 2.0, 3.0]
    # E t (t/2) u / l
    assert [float(r["max(RF1@right)"]) for r in rows] == pytest.approx([5.0, 20.0, 45.0])
    kept = (tmp_path / "bar_sweep.jsonl").read_text()
    assert main([*call, "--json"]) == 0
    assert (tmp_path / "bar_sweep.jsonl").read_text() == kept
    capsys.readouterr()
    assert main([*call[:2], "-p", "t=0,1", *call[4:]]) == 4
    assert "row 0 (t = 0)" in capsys.readouterr().err
    assert main([*call[:2], "-p", "t=1:2", "--sample", "3", *call[4:]]) == 0
    assert main(["run", "bar.inp", "--parameter", "t=2"]) == 0
    with (tmp_path / "bar.csv").open() as file:
        last = list(csv.DictReader(file))[-1]
    assert float(last["RF1 right"]) == pytest.approx(20.0)


def test_the_array_and_the_picture(tmp_path: Path) -> None:
    found = ct.sweep(strip, {"length": [5.0, 6.0], "height": [1.0, 2.0]}, {"F": force}, workers=1)
    assert found.array["F"].tolist() == found["F"].tolist()
    assert found.array.dtype.names == ("length", "height", "F", "seconds", "error")
    found.plot("length", "F", by="height", path=tmp_path / "sweep.png")
    assert (tmp_path / "sweep.png").stat().st_size > 1000
    assert len(found._repr_html_()) < 2000
    assert repr(found) == "Sweep(length, height, F; 4 rows)"
    with pytest.raises(ct.InputError, match="column of the sweep"):
        found["G"]


def test_values_of_a_range_have_no_digits_of_rounding() -> None:
    name, values = range_of("t=0.2:0.6:9")
    assert (name, values) == ("t", [0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6])
    assert range_of("n=1e-7:3e-7:3")[1] == [1e-7, 2e-7, 3e-7]

"""Stages of decks, on the command line, in sweeps, after a restart and in reports."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.report.records import records_of_results
from corota.results.measures import MEASURES, table
from support.flexures import cross_spring, parallelogram, snap_through

ROOT = Path(__file__).resolve().parents[2]

DECK = """*HEADING
two bars
{comment}
*PARAMETER
rise = 2.
*NODE, NSET=ALL
1, 0., 0.
2, 10., <rise>
3, 10., <rise>
*NODE, NSET=APEX
3, 10., <rise>
*ELEMENT, TYPE=T2D2, ELSET=BAR
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*SOLID SECTION, ELSET=BAR, MATERIAL=M
1.
*NSET, NSET=TIP
2
*RIGID BODY, NSET=TIP, REF NODE=3
*BOUNDARY
1, 1, 2
3, 1
3, 6
*STEP, NLGEOM, INC=200
*STATIC, DIRECT
.025, 1.
*BOUNDARY
3, 2, 2, -4.5
*END STEP
"""


def deck(folder: Path, comment: str = "**") -> Path:
    path = folder / "bars.inp"
    path.write_text(DECK.format(comment=comment), encoding="utf-8")
    return path


def rows(path: Path) -> dict[str, np.ndarray]:
    with open(path, encoding="utf-8", newline="") as file:
        head, *lines = csv.reader(file)
    return dict(
        zip(
            head, np.array([[v or "nan" for v in row] for row in lines], dtype=float).T, strict=True
        )
    )


@pytest.mark.parametrize("option", [True, False])
def test_deck_with_a_stage(tmp_path: Path, option: bool) -> None:
    text = "APEX axis=0,-1"
    path = deck(tmp_path, "**" if option else f"** STAGE: {text}")
    more = ["--stage", text] if option else []
    assert main(["run", str(path), "-o", str(tmp_path), "--quiet", *more]) == 0
    found = rows(tmp_path / "bars.csv")
    assert found["APEX: second equilibrium"][-1] == pytest.approx(4.0, rel=1e-3)
    assert np.isnan(found["APEX: snap load"][0])
    with ct.read_results(tmp_path / "bars.vtkhdf") as read:
        assert read.history("snap load")[-1] == pytest.approx(found["APEX: snap load"][-1])
    assert main(["report", str(tmp_path / "bars.vtkhdf"), "-o", str(tmp_path / "bars.html")]) == 0


def test_bad_comment_is_an_error_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(ct.DeckError, match=r"bars.inp:3: error: stage 'APEX axis=up'"):
        ct.read(deck(tmp_path, "** STAGE: APEX axis=up"))


def test_seek_of_a_snap_load(tmp_path: Path) -> None:
    path = deck(tmp_path)
    command = ["seek", str(path), "-p", "rise=1.5:2.5", "-m", "last(snap load)", "--target", "2.0"]
    command += ["--stage", "APEX axis=0,-1", "-o", str(tmp_path / "s.jsonl"), "--json"]
    assert main(command) == 0
    found = ct.seek(path_of(path), {"rise": (1.5, 2.5)}, "last(snap load@APEX)", 2.0)
    # Shallow trusses snap at a load with the cube of the rise.
    assert found.value == pytest.approx(2.0 * (2.0 / 1.4835) ** (1 / 3), rel=0.02)


def path_of(path: Path):
    def build(rise: float) -> ct.Model:
        return ct.read(path, parameters={"rise": rise}, stages=["APEX axis=0,-1"])

    return build


def test_stages_are_written_to_decks(tmp_path: Path) -> None:
    model = parallelogram()
    model.force("stage", x=0.01)
    model.stage("stage", axis=(1.0, 0.5), point=(0.0, 3.0), allowable={"MISES": 4.0})
    model.stage("left", [0, 1, 2], axis="rotation", against="stage", input="stage",
                allowable={"fatigue": (1.0, 2.0)}, stiffness=False)  # fmt: skip
    path = ct.write(model, tmp_path / "stages.inp", ct.Static())
    again = ct.read(path)
    assert [stage.name for stage in again.stages] == ["stage", "left"]
    assert again.stages[1].allowable == {"fatigue": (1.0, 2.0)}
    assert set(again.mesh.node_indices(again.stages[1].nodes)) == {0, 1, 2}


def test_measures_continue_after_a_restart(tmp_path: Path) -> None:
    """A checkpoint has the path of a stage: snap load and work are those of one run."""
    path = deck(tmp_path, "** STAGE: APEX axis=0,-1")
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    assert main(["run", str(path), "-o", str(whole), "--quiet"]) == 0
    assert main(["run", str(path), "-o", str(parts), "--quiet", "--checkpoint-every", "15"]) == 0
    # As after a kill behind increment 30: the last checkpoint but one is there.
    (parts / "bars.ckpt").unlink(missing_ok=True)
    checkpoints = sorted(parts.glob("bars.ckpt*"))
    assert checkpoints
    checkpoints[0].rename(parts / "bars.ckpt")
    assert main(["resume", str(parts / "bars.ckpt"), "--quiet"]) == 0
    one, two = rows(whole / "bars.csv"), rows(parts / "bars.csv")
    for name in MEASURES:
        key = f"APEX: {name}"
        if key in one:
            assert np.allclose(one[key], two[key], rtol=1e-9, atol=1e-12, equal_nan=True), name


def test_sweep_of_measures(tmp_path: Path) -> None:
    def build(depth: float) -> ct.Model:
        model = cross_spring(n=8, depth=depth)
        model.force(["hub"], moment=0.2)
        model.stage("hub", axis="rotation")
        return model

    found = ct.sweep(
        build,
        {"depth": [0.01, 0.02]},
        {"ratio": "last(stiffness ratio@hub)", "soft": "last(axis stiffness)", "snap": "snap load"},
        workers=1,
    )
    # Both have E I = 1; the thinner leaves are stiffer along themselves.
    assert found["soft"][0] == pytest.approx(found["soft"][1], rel=1e-3)
    assert found["ratio"][0] > 1.05 * found["ratio"][1]
    assert np.isnan(found["snap"]).all()  # a pivot has no limit load


def test_the_page_has_the_table() -> None:
    page = (ROOT / "docs" / "measures.md").read_text(encoding="utf-8")
    assert "\n".join(table()) in page, (
        "paste: python -c 'from corota.results.measures import table; print(*table(), sep=chr(10))'"
    )


def test_report_has_the_curves(tmp_path: Path) -> None:
    model = snap_through()
    model.stage("apex", axis=(0.0, -1.0))
    step = ct.Static(increments=12)
    step.fix("apex", y=-3.0, x=None)
    results = ct.solve(model, step, threads=1)
    records = records_of_results(results)
    assert records.table()[:, records.names.index("apex: travel")] == pytest.approx(
        results.history("travel").values
    )
    assert results.report(tmp_path / "report.html").stat().st_size

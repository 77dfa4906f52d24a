"""Requested output of explicit and modal steps is not lost, and peaks between frames are known."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct

TIMES = [0.1, 0.333, 1.7771, 2.5]
DECK = """*NODE, NSET=NALL
1,0,0
2,1,0
3,1,1
4,0,1
*ELEMENT, TYPE=CPS4, ELSET=E
1,1,2,3,4
*NSET, NSET=TIP
3
*MATERIAL, NAME=M
*ELASTIC
100.,.3
*DENSITY
1.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1,1,2
4,1,2
*TIME POINTS, NAME=TP
.1,.333,1.7771,2.5
"""
STEPS = {
    "explicit": "*STEP,NLGEOM,INC=100000\n*DYNAMIC,EXPLICIT\n,4.\n",
    "implicit": "*STEP,NLGEOM,INC=100000\n*DYNAMIC\n.05,4.\n",
    "modal": "*STEP\n*FREQUENCY\n4\n*END STEP\n*STEP,INC=100000\n*MODAL DYNAMIC\n.05,4.\n",
}
LOAD = "*CLOAD\nTIP,2,2.\n"


def run(folder: Path, text: str) -> tuple[ct.Results, list[float]]:
    (folder / "x.inp").write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(ct.read(folder / "x.inp"), observers=[ct.JobFiles(folder)], threads=1)
    found = re.findall(r"displacements.*time\s+(\S+)", (folder / "x.dat").read_text())
    return results, [float(text) for text in found]


@pytest.mark.parametrize("kind", STEPS)
def test_time_points_are_hit(kind: str, tmp_path: Path) -> None:
    request = "*NODE PRINT,NSET=TIP,TIME POINTS=TP\nU\n*END STEP\n"
    results, times = run(tmp_path, DECK + STEPS[kind] + LOAD + request)
    assert times == pytest.approx([*TIMES, 4.0], rel=1e-6)
    start = results.frames[-1].time - 4.0
    assert all(np.isclose(results.times - start, t, rtol=0, atol=1e-9).any() for t in TIMES)


def test_requested_times_do_not_disturb_the_motion(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    for kind in ("explicit", "modal"):
        request = "*NODE PRINT,NSET=TIP,TIME POINTS=TP\nU\n*END STEP\n"
        with_times, _ = run(tmp_path, DECK + STEPS[kind] + LOAD + request)
        without, _ = run(tmp_path / "a", DECK + STEPS[kind] + LOAD + "*NODE PRINT\nU\n*END STEP\n")
        np.testing.assert_array_equal(with_times.frames[-1].U, without.frames[-1].U)
        tip = with_times.history("U2", at="TIP")
        dense = without.history("U2", at="TIP")
        for t in TIMES:
            assert tip.at(t) == pytest.approx(dense.at(t), abs=0.02 * abs(dense).max())


def test_time_points_are_kept_by_the_next_step(tmp_path: Path) -> None:
    request = "*NODE PRINT,NSET=TIP,TIME POINTS=TP\nU\n*END STEP\n"
    again = "*STEP,INC=1000\n*DYNAMIC\n.05,4.\n*END STEP\n"
    text = DECK + "*STEP,INC=1000\n*DYNAMIC\n.05,4.\n" + LOAD + request + again
    _, times = run(tmp_path, text)
    assert times == pytest.approx([*TIMES, 4.0, *(4.0 + t for t in TIMES), 8.0], rel=1e-6)


@pytest.mark.parametrize("frequency", [1, 7])
def test_a_frequency_counts_all_increments(frequency: int, tmp_path: Path) -> None:
    long = STEPS["explicit"].replace(",4.", ",100.")
    request = f"*NODE PRINT,NSET=TIP,FREQUENCY={frequency}\nU\n*END STEP\n"
    results, times = run(tmp_path, DECK + long + LOAD + request)
    last = results.frames[-1].increment
    assert last > 1000  # every increment is a frame no more
    assert len(times) == last // frequency + bool(last % frequency)


def strip(**options: object) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 0.8, nx=4, ny=1))
    model.section(element="Q4", material=ct.Elastic(E=1e3, nu=0.0, rho=1.0))
    return model


def test_a_pulse_between_frames_is_a_frame() -> None:
    model = strip()
    model.fix("left")
    model.amplitudes["p"] = ct.Amplitude([0.0, 1.0, 1.001, 1.002, 9.0], [0.0, 0.0, 1.0, 0.0, 0.0])
    model.force("right", x=1000.0, amplitude="p")
    step = ct.Dynamic(period=2.0, increments=2000, scheme="central_difference")
    with pytest.warns(UserWarning, match="is kept"):
        results = ct.solve(model, step, threads=1)
    assert len(results.frames) < 250
    assert max(f.F[:, 0].sum() for f in results.frames) == pytest.approx(1000.0)
    assert results.history("largest total F1").max() == pytest.approx(1000.0)


def test_extremes_between_frames_are_those_of_all_increments() -> None:
    def solved(outputs: list) -> ct.Results:
        model = strip()
        model.fix("left")
        model.force("right", y=1.0)
        step = ct.Dynamic(period=4.0, increments=1000, scheme="central_difference")
        step.outputs = outputs
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ct.solve(model, step, threads=1)

    from corota.model.steps import Output

    few = solved([])
    every = solved([Output("node print", ("U",), every=True)])
    assert len(few.frames) < 300 < 1000 < len(every.frames)
    for name, component, pick in (("largest U2", "U2", max), ("smallest V2", "V2", min)):
        wanted = pick(
            pick(float(v) for v in every.nodal(component, i)) for i in range(1, len(every.frames))
        )
        found = few.history(name)
        assert (found.max() if pick is max else found.min()) == pytest.approx(wanted, rel=1e-12)


def test_momenta_of_central_differences() -> None:
    """A free body with a spin and a push: momenta are those of a rigid body, and stay."""
    model = strip()
    model.velocity(x=2.0, y=-1.0, spin=0.3, about=(2.0, 0.4))
    step = ct.Dynamic(period=1.0, increments=100, scheme="central_difference", mass="lumped")
    results = ct.solve(model, step, threads=1)
    mass = 4.0 * 0.8
    px, py = results.history("momentum x"), results.history("momentum y")
    assert px[1:] == pytest.approx(2.0 * mass, rel=1e-10)
    assert py[1:] == pytest.approx(-1.0 * mass, rel=1e-10)
    spin = results.history("angular momentum")[1:]
    assert spin == pytest.approx(spin[0], rel=1e-6)
    implicit = ct.solve(model, ct.Dynamic(period=1.0, increments=20, mass="lumped"), threads=1)
    assert spin[0] == pytest.approx(implicit.history("angular momentum")[1], rel=1e-3)

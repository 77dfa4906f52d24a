"""An unstable equilibrium is never reached in silence."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct

EULER = np.pi**2 * 1e5 / 12 / 4 / 100  # 205.6


def column(side: float, load: float = 1.95 * EULER) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name="column")
    material = ct.Elastic(E=1e5, nu=0.0)
    model.section(element="Q4I", material=material, local_strain="green_lagrange")
    model.fix("left")
    model.force("right", x=-load, y=side)
    return model


@pytest.mark.parametrize("side", [0.0, -1.0])
def test_an_increment_that_jumps_a_bifurcation_is_named(side: float, tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match=r"between step times 0 and 1 of step 1 a bifurcation"):
        results = ct.solve(column(side), ct.Static(increments=1), threads=1)
    assert results.stable[-1] == 0.0
    assert "unstable in 1 frames from time 1 on" in repr(results)
    assert "unstable" in results.summary()
    assert any("negative pivots of the tangent: 1" in note for note in results.notes)
    with ct.read_results(results.write(tmp_path / "column.vtkhdf")) as read:
        assert "unstable in 1 frames" in repr(read)


def test_one_iteration_does_not_hide_it() -> None:
    """The straight path converges at once; its inertia is that of the end, not of the start."""
    for increments in (1, 2, 4):
        step = ct.Static(increments=increments, tolerance=1e-4)
        with pytest.warns(UserWarning, match="bifurcation"):
            results = ct.solve(column(0.0), step, threads=1)
        assert results.stable[-1] == 0.0


def test_stop_ends_before_the_bifurcation() -> None:
    for increments in (1, 10):
        step = ct.Static(increments=increments, at_bifurcation="stop")
        with pytest.raises(ct.ConvergenceError, match="a bifurcation or limit point") as stopped:
            ct.solve(column(0.0), step, threads=1)
        results = stopped.value.results
        assert (results.stable[1:] == 1.0).all()
        reached = results.history("load factor")[-1] * 1.95
        assert reached == pytest.approx(1.0, abs=0.03)


def test_stop_and_follow_find_the_stable_path() -> None:
    """Beside the column a small force down: it bends down, although one increment jumps up."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        many = ct.solve(column(-1.0), ct.Static(increments=40), threads=1)
        wanted = many.history("U2", at="right")[-1]
        for how in ("stop", "follow"):
            step = ct.Static(increments=1, at_bifurcation=how)  # type: ignore[arg-type]
            found = ct.solve(column(-1.0), step, threads=1)
            assert found.history("U2", at="right")[-1] == pytest.approx(wanted, rel=1e-5), how
            assert (found.stable[1:] == 1.0).all()


def test_follow_switches_to_the_branch() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        step = ct.Static(increments=2, at_bifurcation="follow")
        results = ct.solve(column(0.0), step, threads=1)
        bent = ct.solve(column(-0.5), ct.Static(increments=40), threads=1)
    tip = abs(results.history("U2", at="right")[-1])
    assert tip == pytest.approx(abs(bent.history("U2", at="right")[-1]), rel=0.02)
    assert results.stable[-1] == 1.0
    assert results.history("load factor")[-1] == pytest.approx(1.0)


def test_stable_equilibria_do_not_warn() -> None:
    results = ct.solve(column(0.0, 0.9 * EULER), ct.Static(increments=2), threads=1)
    assert (results.stable[1:] == 1.0).all()
    assert "unstable" not in repr(results)

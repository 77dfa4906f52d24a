"""History: failed increments leave no trace; control by plastic strain; first yield in one go."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.analysis import increment_loop as increment
from corota.verification.plastic_models import cantilever, find, perforated_strip
from support.newton import ROUNDING, Residuals

SETTINGS = {"threads": 1}

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


def state_of(results: ct.Results) -> list[np.ndarray]:
    """Everything that the last frame holds of the history."""
    frame = results.frames[-1]
    fields = frame.fields[0].values
    return [frame.U, frame.RF, fields["S"], fields["PE"], fields["PEEQ"], fields["PWORK"]]


@pytest.mark.parametrize("measure", ["linear", "logarithmic"])
@pytest.mark.parametrize("element", ["Q4I", "Q4D", "Q8", "OPT"])
def test_cut_backs_leave_no_trace(
    element: str, measure: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same path with and without failed attempts ends with the same bits."""

    def run() -> ct.Results:
        model = perforated_strip(element, 2, local_strain=measure)
        steps = [ct.Static(increments=4, largest_increment=0.25)]
        return ct.solve(model, steps, **SETTINGS)

    plain = run()
    true = increment.newton
    calls = {"n": 0}

    def failing(system: Any, u: Any, prescribed: Any, *rest: Any) -> Any:
        # Before each attempt a wilder one is made, iterated to its end and thrown away.
        calls["n"] += 1
        further = u + 3.0 * (prescribed - u)
        true(system, u, further, *rest[:2], None, None)
        return true(system, u, prescribed, *rest)

    monkeypatch.setattr(increment, "newton", failing)
    disturbed = run()
    assert calls["n"] >= len(plain.frames) - 1
    for one, two in zip(state_of(plain), state_of(disturbed), strict=True):
        np.testing.assert_array_equal(one, two)


def test_cut_increment_ends_where_the_short_ones_end() -> None:
    """A step whose first increment fails and is cut equals one that starts with the short one."""
    cut = ct.Static(first_increment=1.0, plastic_increment=0.004)
    results = ct.solve(perforated_strip("Q4I", 3, pull=0.1), cut, **SETTINGS)
    assert results.info["cut-backs"] >= 1
    times = np.array([f.step_time for f in results.frames])
    # The same increments, one step at a time.
    model = perforated_strip("Q4I", 3, pull=0.1)
    steps = []
    top = find(model.mesh, 1, 18.0)
    held = [s for s in model.supports if not np.array_equal(s.nodes, top)]
    model.supports[:] = held
    for t in times[1:]:
        steps.append(ct.Static(supports=[ct.model.Fixed(top, 1, 0.1 * t)]))
    short = ct.solve(model, steps, **SETTINGS)
    for one, two in zip(state_of(results), state_of(short), strict=True):
        assert np.abs(one - two).max() <= 1e-9 * max(np.abs(two).max(), 1e-30)


def test_plastic_strain_limits_the_increment() -> None:
    limit = 0.002
    step = ct.Static(first_increment=0.5, plastic_increment=limit)
    results = ct.solve(perforated_strip("Q4I", 3, pull=0.1), step, **SETTINGS)
    peeq = [f.fields[0].values["PEEQ"] for f in results.frames]
    growth = [float((b - a).max()) for a, b in pairwise(peeq)]
    assert max(growth) <= limit
    assert peeq[-1].max() > 3 * limit
    with pytest.raises(ct.InputError, match="plastic_increment must be >= 0"):
        ct.Static(plastic_increment=-1.0)


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q4D", "OPT"])
def test_first_yield_in_one_large_increment(element: str) -> None:
    """Prescribed displacements far through first yield: few increments, no tuning."""
    model = perforated_strip(element, 5, pull=0.3)
    results = ct.solve(model, ct.Static(), **SETTINGS)
    assert results.frames[-1].factor == 1.0
    assert len(results.frames) <= 16
    reference = ct.solve(perforated_strip(element, 5, pull=0.3), ct.Static(increments=20))
    top = find(model.mesh, 1, 18.0)
    force = [r.frames[-1].RF[top, 1].sum() for r in (results, reference)]
    # Implicit steps of different size: first order in the step.
    assert force[0] == pytest.approx(force[1], rel=0.005)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D"])
@pytest.mark.parametrize("measure", ["linear", "logarithmic"])
def test_plastic_steps_converge_quadratically(element: str, measure: Any) -> None:
    model = perforated_strip(element, 3, pull=0.1, local_strain=measure)
    watch = Residuals()
    results = ct.solve(model, ct.Static(increments=5), observers=[watch], **SETTINGS)
    for key, residuals in watch.by_attempt.items():
        before, last = residuals[-2:]
        # The constant is that of the yielding points; a linear rate of 1/100 is far above.
        assert last <= max(50.0 * before**2, ROUNDING), (key, residuals)
    assert results.frames[-1].fields[0].values["PEEQ"].max() > 0.01


def test_strongly_plastic_internal_modes() -> None:
    """Q4I and Q4D without hardening, in five steps far past the limit load."""
    for element in ("Q4I", "Q4D"):
        model = cantilever(element, 4, 1.0)
        results = ct.solve(model, ct.Static(nlgeom=False, increments=5), **SETTINGS)
        # The first fifth is twice the elastic limit in one go; one cut-back is allowed there.
        assert results.info.get("cut-backs", 0) <= 1
        assert results.info["iterations"] <= 60


def test_units() -> None:
    """Meters and newtons, or millimeters and megapascals: the same strains."""
    found = []
    for length, stress in ((1.0, 1.0), (1e-3, 1e6), (1e3, 1e-6)):
        model = ct.Model(ct.mesh.rectangle(10.0 * length, length, 10, 2))
        law = ct.Mises(
            E=70000.0 * stress, nu=0.3, yield_stress=200.0 * stress, kinematic=3000.0 * stress
        )
        model.section("all", element="Q4D", material=law, thickness=0.1 * length)
        model.fix("left", rotation=True)
        model.traction("right", y=-6.0 * stress)
        frame = ct.solve(model, ct.Static(increments=4), **SETTINGS).frames[-1]
        found.append((frame.U / length, frame.fields[0].values["PEEQ"]))
    assert found[0][1].max() > 1e-4
    for u, peeq in found[1:]:
        assert np.abs(u - found[0][0]).max() < 1e-9 * np.abs(u).max()
        assert np.abs(peeq - found[0][1]).max() < 1e-9


def test_energy_is_work() -> None:
    """External work is elastic energy and plastic work; the error falls with the increments."""
    errors = []
    for n in (10, 40):
        results = ct.solve(perforated_strip("Q4I", 3, pull=0.1), ct.Static(increments=n))
        frame = results.frames[-1]
        fields = frame.fields[0]
        plastic = float((fields.values["PWORK"] * fields.volume).sum())
        work = frame.scalars["external work"]
        errors.append(abs(frame.scalars["strain energy"] + plastic - work) / work)
    assert errors[1] < 0.02
    assert errors[1] < 0.5 * errors[0]

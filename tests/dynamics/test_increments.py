"""Automatic increments of motion: cut back where a load is fast, regrown after it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.steps import Output
from tests.dynamics.test_schemes import column, run

#: A pulse of a hundredth of the period of the body, late in the step.
BEGIN, LENGTH, PERIOD = 4.0, 0.04, 6.0


def struck():
    model = ct.Model(ct.mesh.rectangle(4.0, 0.5, nx=8, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=2e3, nu=0.3, rho=1.0))
    model.fix("left")
    model.amplitudes["pulse"] = ct.Amplitude(
        [0.0, BEGIN, BEGIN + 0.25 * LENGTH, BEGIN + 0.75 * LENGTH, BEGIN + LENGTH, PERIOD],
        [0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
    )
    model.gravity(y=-60.0, amplitude="pulse")
    return model


def test_increments_are_cut_at_a_pulse_and_grow_again():
    keys = {"period": PERIOD, "tolerance": 1e-8}
    results = run(struck(), error_tolerance=1e-2, **keys)
    time = np.array([f.time for f in results.frames[1:]])
    dt = column(results, "dt")
    during = dt[(time > BEGIN) & (time <= BEGIN + LENGTH)]
    after = dt[time > BEGIN + 1.0]
    # At rest the increments grow; none steps over a point of the amplitude.
    assert dt[time < BEGIN].max() > LENGTH
    for point in (BEGIN, BEGIN + LENGTH):
        assert point in time
    assert results.info["cut-backs"] > 0
    assert during.min() < LENGTH / 20.0
    assert np.median(after) > 5.0 * during.min()
    assert time[-1] == PERIOD
    exact = run(struck(), increments=1500, scheme="newmark", **keys)
    tip = struck().mesh.nodes_of("right")[0]
    fine = np.array([[f.time, f.U[tip, 1]] for f in exact.frames])
    found = np.array([[f.time, f.U[tip, 1]] for f in results.frames])
    error = found[:, 1] - np.interp(found[:, 0], fine[:, 0], fine[:, 1])
    # A hundredth of an increment's motion is allowed in each of some ten increments a swing.
    assert np.abs(error).max() <= 0.1 * np.abs(fine[:, 1]).max()


@pytest.mark.parametrize("fixed", [True, False])
def test_output_times_are_hit_exactly(fixed):
    model = struck()
    model.time_points["wanted"] = np.array([1.0 / 3.0, 1.0, np.pi])
    output = Output("node file", ("U",), time_points="wanted")
    keys = {"increments": 70} if fixed else {}
    results = run(model, period=5.0, outputs=[output], **keys)
    time = np.array([f.time for f in results.frames[1:]])
    for wanted in [*model.time_points["wanted"], 5.0]:
        assert wanted in time
    if fixed:
        # What lies between keeps the given length; only the pieces at an output are shorter.
        dt = column(results, "dt")
        assert dt.max() == pytest.approx(5.0 / 70.0, rel=1e-12)
        assert (dt < 5.0 / 70.0 * (1.0 - 1e-9)).sum() <= 4

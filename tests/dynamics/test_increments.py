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
    # At rest the increments grow; none steps over a point of the amplitude by more than a
    # twentieth of its size.
    assert dt[time < BEGIN].max() > LENGTH
    assert BEGIN in time
    pulse = struck().amplitudes["pulse"]
    seen = np.interp(pulse.time, time, [pulse(t) for t in time])
    assert np.abs(seen - pulse.value).max() <= 0.05
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


@pytest.mark.parametrize("scheme", ["newmark", "hht", "energy_momentum"])
def test_automatic_increments_do_not_see_a_uniform_velocity(scheme):
    """Galilei: as many increments and the same deformation in a frame that moves.

    The error was measured against the distance traveled: 62 increments became 10.
    """
    found = []
    for speed in (0.0, 100.0):
        model = ct.Model(ct.mesh.rectangle(10.0, 0.5, nx=10, ny=1))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
        model.amplitudes["pulse"] = ct.Amplitude([0.0, 0.2, 0.4, 9.0], [0.0, 1.0, 0.0, 0.0])
        model.force(model.mesh.nodes_of("right"), y=3.0, amplitude="pulse")
        model.velocity(x=speed, y=0.5 * speed)
        step = ct.Dynamic(period=0.8, first_increment=0.01, scheme=scheme)
        frames = ct.solve(model, step, fields=False).frames
        u = frames[-1].U
        found.append((len(frames), u - u.mean(axis=0)))
    assert found[0][0] == found[1][0]
    assert np.abs(found[0][1] - found[1][1]).max() < 1e-7 * np.abs(found[0][1]).max()


def test_automatic_increments_pass_a_kink_of_the_base():
    """Prescribed dofs have no error: 3000 increments came to 0.56 of 2."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.amplitudes["hold"] = ct.Amplitude([0.0, 0.5, 9.0], [0.0, 1.0, 1.0])
    model.fix("left", x=0.0, y=1.0, amplitude="hold")
    step = ct.Dynamic(
        period=1.0, first_increment=0.01, scheme="newmark", nlgeom=False, max_increments=300
    )
    assert ct.solve(model, step, fields=False).frames[-1].time == pytest.approx(1.0)


@pytest.mark.parametrize("free", [False, True])
@pytest.mark.parametrize("scheme", ["hht", "energy_momentum"])
def test_increments_do_not_depend_on_the_axes(scheme, free):
    """A body, its motion and its load turned by any angle: the same increments, to rounding."""
    sizes = []
    for angle in np.radians([0.0, 20.0, 45.0]):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        mesh = ct.mesh.rectangle(6.0, 0.6, nx=10, ny=1)
        mesh.points[:] = mesh.points @ turn.T
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
        load, speed = turn @ [0.1, -0.3], turn @ [1.0, 0.3]
        if free:
            model.velocity(x=speed[0], y=speed[1], spin=0.5, about=(0.0, 0.0))
        else:
            model.fix("left")
        model.force("right", x=load[0], y=load[1])
        sizes.append(column(run(model, period=3.0, scheme=scheme), "dt"))
    assert len({len(s) for s in sizes}) == 1
    for other in sizes[1:]:
        assert np.allclose(other, sizes[0], rtol=1e-6)


def test_a_step_ends_with_the_increments_that_it_may_take():
    """A stiff strip under a sudden force needs thousands: half of 20 are spent, then it says so."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e8, nu=0.0, rho=1.0))
    model.fix("left")
    model.force("right", y=1.0)
    step = ct.Dynamic(period=1.0, first_increment=0.01, max_increments=20)
    with pytest.warns(UserWarning, match="longer increments than the motion needs"):
        results = ct.solve(model, step, fields=False, threads=1)
    assert results.frames[-1].time == pytest.approx(1.0)
    assert results.frames[-1].increment <= 20
    assert any("longer increments" in note for note in results.notes)

"""Amplitudes of a harmonic response: of displacements, reactions and stresses."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.analysis.procedures.linear_fields import largest_mises

LENGTH, HEIGHT, THICKNESS, E, SHARE = 100.0, 2.0, 10.0, 210e3, 0.01


def response(path: Path | None = None) -> ct.Results:
    """A cantilever under a force at its end, one percent of critical damping."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, nx=40, ny=2))
    model.section(element="Q4I", material=ct.Elastic(E=E, rho=7.8e-9), thickness=THICKNESS)
    model.fix("left")
    step = ct.SteadyState(lowest=100.0, highest=300.0, points=21, damping=SHARE, residual=True)
    step.force("right", y=1.0)
    files = [ct.JobFiles(str(path), "bar")] if path else []
    return ct.solve(model, [ct.Frequency(modes=3), step], observers=files)


def test_stress_at_resonance_is_that_of_the_mode() -> None:
    """Root moment of the first mode, EI phi'' = 3.516 EI w / L^2, a quarter of a period late."""
    results = response()
    amplitude = results.history("UA2", "right", combine="max").values
    peak = int(np.nanargmax(amplitude))
    inertia = THICKNESS * HEIGHT**3 / 12.0
    # Modal response F phi^2 / (2 zeta K) with phi = 2 at the tip and K = EI (1.8751)^4 / L^3.
    exact = 4.0 / (2.0 * SHARE * E * inertia * 1.875104**4 / LENGTH**3)
    assert amplitude[peak] == pytest.approx(exact, rel=0.01)
    stress = E * 3.516 * amplitude[peak] / LENGTH**2 * HEIGHT / 2.0
    root = results.nodal("MISESA", peak).max()
    assert root == pytest.approx(stress, rel=0.05)
    assert results.nodal("MISES", peak).max() < 0.05 * root
    assert results.history("UP2", "right", combine="mean").values[peak] == pytest.approx(
        -np.pi / 2.0, abs=0.05
    )
    # Far below the mode reactions are in phase, at it they are not.
    for frame, share in ((2, 0.98), (peak, 0.0)):
        real, size = np.abs(results.nodal("RF2", frame)), results.nodal("RFA2", frame)
        assert (real <= size * (1.0 + 1e-9) + 1e-9).all()
        assert real.sum() >= share * size.sum()
    assert real.sum() < 0.05 * size.sum()


def test_largest_mises_over_a_period() -> None:
    """Beside 200,000 instants, with a state and without one, in phase and not."""
    draw = np.random.default_rng(3)
    for size in (0.0, 1.0):
        mean, cosine, sine = size * draw.normal(size=4), draw.normal(size=4), draw.normal(size=4)
        a = np.linspace(0.0, 2.0 * np.pi, 200_001)[:, None]
        x, y, z, t = (mean + np.cos(a) * cosine + np.sin(a) * sine).T
        exact = np.sqrt(0.5 * ((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) + 3.0 * t**2).max()
        assert largest_mises(mean, cosine, sine) == pytest.approx(exact, rel=3e-5)


@pytest.mark.parametrize("ending", ["vtkhdf", "pvd"])
def test_amplitudes_are_the_same_in_the_file(tmp_path: Path, ending: str) -> None:
    memory = response(tmp_path)
    memory.write(tmp_path / f"copy.{ending}")
    stored = ct.read_results(tmp_path / f"copy.{ending}")
    last = len(memory.frames) - 1
    for name in ("UA1", "UA2", "UP1", "UP2", "RFA1", "RFA2", "SA11", "MISESA"):
        assert stored.nodal(name, last) == pytest.approx(memory.nodal(name, last), rel=1e-12)
    # The frame of the frequency step has no amplitudes.
    there, here = (r.history("UA1", combine="max").values for r in (stored, memory))
    assert np.array_equal(there, here, equal_nan=True)


def test_stress_at_nodes_is_a_history_over_all_steps() -> None:
    """A frame of the frequency step has none."""
    values = response().history("MISESA", "left", combine="max").values
    assert np.isnan(values[0])
    assert np.nanmax(values) > 0.0


def test_points_crowd_near_the_modes() -> None:
    """The formula of the manuals: mean + half |t|^(1/3) sign(t)."""
    step = ct.SteadyState(lowest=100.0, highest=300.0, points=5)
    assert step.sweep(np.array([200.0]))[:5] == pytest.approx(
        [100.0, 150.0 - 50.0 * 0.5 ** (1 / 3), 150.0, 150.0 + 50.0 * 0.5 ** (1 / 3), 200.0]
    )
    assert step.sweep(np.zeros(0)) == pytest.approx([100.0, 150.0, 200.0, 250.0, 300.0])
    with pytest.raises(ct.InputError, match="bias"):
        ct.SteadyState(lowest=1.0, highest=2.0, bias=0.0)


def test_allowable_of_a_stage_takes_the_amplitude() -> None:
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, nx=20, ny=2))
    model.section(element="Q4I", material=ct.Elastic(E=E, rho=7.8e-9), thickness=THICKNESS)
    model.fix("left")
    model.stage("right", axis="y", allowable={"MISES": 100.0}, stiffness=False)
    step = ct.SteadyState(lowest=100.0, highest=300.0, points=5, damping=SHARE)
    step.force("right", y=1.0)
    results = ct.solve(model, [ct.Frequency(modes=2), step])
    used = results.history("right: utilization").values
    largest = results.history("MISESA", combine="max", at="nodes").values
    harmonic = ~np.isnan(largest)
    assert used[harmonic] == pytest.approx(largest[harmonic] / 100.0, rel=1e-9)


@pytest.mark.parametrize("direct", [True, False])
def test_spring_whose_response_vanishes_or_is_late(direct: bool) -> None:
    """``F / (k - m w^2 + i c w)``, also at rest, in resonance and without a stress of solids."""
    k, mass, c, force = 100.0, 1.0, 2.0, 5.0
    model = ct.Model(ct.mesh.line([(0.0, 0.0), (1.0, 0.0)], n=1))
    model.spring("all", k)
    model.point_mass("end", mass)
    model.dashpot(1, x=c)
    model.fix("start")
    model.fix("end", x=None, y=0.0)
    resonance = np.sqrt(k / mass) / (2.0 * np.pi)
    step = ct.SteadyState(lowest=resonance, highest=3.0, points=3, direct=direct, bias=1.0)
    step.force("end", x=force)
    results = ct.solve(model, [step] if direct else [ct.Frequency(modes=1), step], threads=1)
    steady = [i for i, frame in enumerate(results.frames) if frame.scalars.get("frequency")]
    w = 2.0 * np.pi * results.history("frequency")[steady]
    exact = force / (k - mass * w**2 + 1j * c * w)
    np.testing.assert_allclose(results.history("UA1", at="end")[steady], np.abs(exact), rtol=1e-8)
    np.testing.assert_allclose(results.history("UP1", at="end")[steady], np.angle(exact), rtol=1e-8)


@pytest.mark.parametrize("direct", [True, False])
def test_amplitudes_and_phases_do_not_depend_on_the_axes_of_nodes(*, direct: bool) -> None:
    """Damped motion in both directions; nodes with axes of their own have the same response."""
    answers = []
    for angle in (0.0, 0.6):
        model = ct.Model(ct.mesh.rectangle(10.0, 2.0, nx=4, ny=2))
        model.section(element="Q4", material=ct.Elastic(E=1000.0, rho=0.01), thickness=1.0)
        if angle:
            model.local_axes("right", angle=angle)
            model.local_axes("left", angle=-2.0)
        model.fix("left")
        damping = {"rayleigh": (30.0, 1e-3)} if direct else {"damping": 0.1}
        step = ct.SteadyState(lowest=2.0, highest=4.0, points=3, direct=direct, **damping)  # type: ignore[arg-type]
        model.traction("right", x=0.3, y=1.0)
        step.pressure("top", 0.5)
        frames = ct.solve(model, [step] if direct else [ct.Frequency(modes=6), step]).frames
        answers.append(frames[-1])
    plain, turned = answers
    assert plain.H is not None
    assert turned.H is not None
    assert np.abs(np.sin(plain.H[:, 2:4])).max() > 0.1
    np.testing.assert_allclose(turned.H, plain.H, rtol=1e-7, atol=1e-9 * np.abs(plain.H).max())
    for name in ("largest amplitude", "phase at largest"):
        assert turned.scalars[name] == pytest.approx(plain.scalars[name], rel=1e-7)

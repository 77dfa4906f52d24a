"""Prescribed dofs take velocity and acceleration from their amplitude, in every scheme."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Amplitude
from support.pairs import cover

SCHEMES = ("newmark", "hht", "generalized_alpha", "energy_momentum")
TIMES = np.linspace(0.0, 2.0, 8001)


def shaken(time, value, velocity=0.0):
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3, rho=1.0))
    model.amplitudes["base"] = ct.Amplitude(time, value)
    model.fix("left", x=0.0, y=None)
    model.fix("left", x=None, y=1.0, amplitude="base")
    model.velocity(y=velocity)
    return model


@pytest.mark.parametrize(("scheme", "rigid"), cover(SCHEMES, [False, True], strength=1))
def test_base_has_the_acceleration_of_a_smooth_amplitude(scheme, rigid):
    """Closed form: base at 1 - cos 2t, so V = 2 sin 2t, A = 4 cos 2t; second order in dt."""
    time = np.linspace(0.0, 2.0, 4001)
    errors = []
    for n in (20, 40):
        model = shaken(time, 1.0 - np.cos(2.0 * time))
        if rigid:
            mesh = model.mesh
            model = shaken(time, 1.0 - np.cos(2.0 * time))
            model.supports.clear()
            model.rigid(np.arange(1, mesh.n_nodes), 0)
            model.fix([0], x=0.0, y=None, rotation=True)
            model.fix([0], x=None, y=1.0, amplitude="base")
        step = ct.Dynamic(period=2.0, increments=n, scheme=scheme, nlgeom=rigid)
        frames = ct.solve(model, step, fields=False).frames[1:]
        node = model.mesh.nodes_of("left")[0]
        t = np.array([f.time for f in frames])
        v, a = (np.array([getattr(f, name)[node, 1] for f in frames]) for name in "VA")
        errors.append(
            (np.abs(v - 2.0 * np.sin(2.0 * t)).max(), np.abs(a - 4.0 * np.cos(2.0 * t)).max())
        )
    coarse, fine = np.array(errors)
    # The last frame is a one-sided difference, with the error 11/12 h^2 a(4).
    assert (fine < 0.04).all()
    assert (np.log2(coarse / fine) > 1.8).all()


@pytest.mark.parametrize("scheme", SCHEMES)
def test_base_rests_after_a_ramp_and_the_kink_is_named(scheme):
    """Ramp to 1 within 0.5, then hold: V = A = 0 from there on, in every increment."""
    model = shaken([0.0, 0.5, 9.0], [0.0, 1.0, 1.0])
    step = ct.Dynamic(period=1.0, increments=40, scheme=scheme, nlgeom=False)
    results = ct.solve(model, step, fields=False)
    node = model.mesh.nodes_of("left")[0]
    late = [f for f in results.frames if f.time > 0.55]
    assert max(abs(f.V[node, 1]) for f in late) < 1e-12
    assert max(abs(f.A[node, 1]) for f in late) < 1e-9
    # The pulse at the kink is the lost velocity.
    pulse = [f.A[node, 1] / 40.0 for f in results.frames[1:] if 0.3 < f.time < 0.9]
    assert sum(pulse) == pytest.approx(-2.0, rel=1e-9)
    assert any("'base'" in note and "0.5" in note for note in results.notes)


def test_derivatives_of_a_table():
    """Closed form of a parabola; straight parts have no acceleration, to the last digit."""
    time = np.linspace(0.0, 1.0, 1001)
    table = Amplitude(time, time**2)
    for t in (0.0, 0.5, 1.0):
        assert table.derivatives(t, 0.1, 0.0, 1.0) == pytest.approx((2.0 * t, 2.0), abs=1e-6)
    line = Amplitude([0.0, 1.0, 2.0], [0.0, 3.0, 3.0])
    assert line.derivatives(0.5, 0.1) == pytest.approx((3.0, 0.0))
    assert line.derivatives(0.5, 0.1)[1] == 0.0
    assert line.derivatives(1.0, 0.1) == pytest.approx((1.5, -30.0))
    assert list(line.kinks()) == [0.0, 1.0]
    wave = np.linspace(0.0, 10.0, 100)
    assert not len(Amplitude(wave, np.sin(wave)).kinks()[1:-1])


def on_a_moving_base(support):
    """A beam that its left end shakes, held at its nodes or by a rigid face."""
    model = ct.Model(ct.mesh.rectangle(2.0, 0.2, nx=6, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=500.0, nu=0.3, rho=1.0))
    model.amplitudes["base"] = ct.Amplitude(TIMES, np.sin(9.0 * TIMES) ** 2)
    base = model.mesh.nodes_of("left")
    if support == "rigid face":
        node = ct.mesh.add_node(model.mesh, -0.1, 0.1)
        model.rigid(base, node)
        base = np.array([node])
    model.fix(
        base, x=0.0, y=0.01, rotation=True if support == "rigid face" else None, amplitude="base"
    )
    return model, base


@pytest.mark.parametrize(
    ("support", "rayleigh"), cover(["nodes", "rigid face"], [(0.0, 0.0), (0.3, 0.001)], strength=1)
)
def test_modal_base_moves_to_the_last_frame_of_every_step(support, rayleigh):
    """Base at 0.01 sin^2 9t: V = 0.09 sin 18t, A = 1.62 cos 18t; reactions of direct integration.

    A step that ends while the base accelerates has the acceleration there, as inside.
    """
    model, base = on_a_moving_base(support)
    model.amplitudes["base"].total_time = True
    steps = [
        ct.ModalDynamic(period=0.5, increments=100, residual=True, rayleigh=rayleigh)
        for _ in range(2)
    ]
    modal = ct.solve(model, [ct.Frequency(modes=16), *steps], fields=False).frames[-200:]
    model, base = on_a_moving_base(support)
    step = ct.Dynamic(period=1.0, increments=200, scheme="newmark", nlgeom=False, rayleigh=rayleigh)
    direct = ct.solve(model, step, fields=False).frames[-200:]
    time = 0.005 * np.arange(1, 201)
    v, a = (np.array([getattr(f, name)[base[0], 1] for f in modal]) for name in "VA")
    assert np.abs(v - 0.09 * np.sin(18.0 * time)).max() < 4e-3 * 0.09
    assert np.abs(a - 1.62 * np.cos(18.0 * time)).max() < 1e-2 * 1.62
    rf = np.array([[f.RF[base, 1].sum() for f in frames] for frames in (modal, direct)])
    gap = np.abs(rf[0] - rf[1])
    for last in (100, 200):
        assert gap[last - 1] < 0.03 * np.abs(rf[1]).max()


@pytest.mark.parametrize("n", [1, 2, 3, 8])
def test_rates_of_moves_are_exact_for_parabolas(n):
    """s = 1 + 2t + 3t^2 has s' = 2 + 6t and s'' = 6, as far as the samples tell."""
    from corota.analysis.procedures.modal import rates_of_moves

    dt = 0.25
    t = dt * np.arange(n + 1)[:, None]
    rates, bends = rates_of_moves(1.0 + 2.0 * t + 3.0 * t**2, dt)
    if n > 1:
        assert rates == pytest.approx(2.0 + 6.0 * t, abs=1e-10)
        assert bends == pytest.approx(np.full_like(t, 6.0), abs=1e-9)
    else:
        assert rates == pytest.approx(np.full_like(t, 2.0 + 3.0 * dt), abs=1e-10)
        assert not bends.any()

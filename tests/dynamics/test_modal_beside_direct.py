"""Modal and harmonic response beside direct integration, ODE integrators and closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.model.loads import Amplitude, BodyForce, EdgeLoad, NodalForce
from support.lines import lines

PERIOD, STEPS = 0.4, 100
TIMES = np.linspace(0.0, PERIOD, 201)


def cantilever(**keys):
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=6, ny=1))
    steel = ct.Elastic(E=1e5, nu=0.3, rho=1.0, **keys)
    model.section("all", element="Q4I", material=steel)
    model.fix("left")
    smooth = 0.5 * (1.0 - np.cos(np.pi * TIMES / PERIOD))
    model.amplitudes["smooth"] = Amplitude(TIMES, smooth)
    model.amplitudes["sine"] = Amplitude(TIMES, np.sin(10.0 * TIMES))
    return model


LOADS = {
    "force": [NodalForce("right", 1, -0.1)],
    "force by amplitude": [NodalForce("right", 1, -0.1, "sine")],
    "two amplitudes": [NodalForce("right", 1, -0.1, "sine"), NodalForce("top", 0, 0.05, "smooth")],
    "traction": [EdgeLoad("top", "traction", (0.1, -0.2))],
    "pressure": [EdgeLoad("top", "pressure", (0.2,), "sine")],
    "gravity": [BodyForce("", "gravity", (0.3, -1.0))],
}
MODELS = {
    "plain": lambda m: None,
    "point mass": lambda m: m.point_mass("right", 2.0),
    "dashpots": lambda m: (
        m.dashpot(int(m.mesh.nodes_of("right")[0]), x=1.0, y=3.0),
        m.dashpot(int(m.mesh.nodes_of("right")[1]), int(m.mesh.nodes_of("left")[0]), c=5.0),
    ),
    "initial velocity": lambda m: m.velocity(spin=0.1, about=(0.0, 0.5)),
    "moving support": lambda m: (m.supports.clear(), m.fix("left", y=0.2, amplitude="smooth")),
    "rigid end": lambda m: m.rigid(m.mesh.nodes_of("right"), ct.mesh.add_node(m.mesh, 11.0, 0.5)),
}


def direct(model, loads, rayleigh=(0.0, 0.0), n=40):
    """Displacement at the end by the trapezoidal rule, extrapolated from n and 2 n increments."""
    ends = [
        ct.solve(
            model,
            ct.Dynamic(
                period=PERIOD,
                increments=k * n,
                scheme="newmark",
                nlgeom=False,
                loads=loads,
                rayleigh=rayleigh,
                error_tolerance=1.0,
            ),
            threads=1,
            fields=False,
        ).frames[-1]
        for k in (1, 2)
    ]
    return (4.0 * ends[1].U - ends[0].U) / 3.0, (4.0 * ends[1].V - ends[0].V) / 3.0


def modal(model, loads, modes, **keys):
    steps = [
        ct.Frequency(modes=modes, nlgeom=False),
        ct.ModalDynamic(period=PERIOD, increments=STEPS, loads=loads, nlgeom=False, **keys),
    ]
    return ct.solve(model, steps, threads=1, fields=False)


@pytest.mark.parametrize("load", LOADS)
def test_all_modes_give_the_direct_response_to_every_load(load):
    model = cantilever()
    u, v = direct(model, LOADS[load])
    frame = modal(cantilever(), LOADS[load], 24).frames[-1]
    assert np.abs(frame.U - u).max() <= 3e-3 * np.abs(u).max()
    assert np.abs(frame.V[:, :2] - v[:, :2]).max() <= 6e-2 * np.abs(v).max()


@pytest.mark.parametrize("kind", MODELS)
def test_all_modes_give_the_direct_response_of_every_model(kind):
    rayleigh = (2.0, 1e-4)
    found = []
    for _ in range(2):
        model = cantilever()
        MODELS[kind](model)
        found.append(model)
    loads = [] if kind in ("moving support", "initial velocity") else LOADS["force by amplitude"]
    u, v = direct(found[0], loads, rayleigh)
    frame = modal(found[1], loads, 24, rayleigh=rayleigh).frames[-1]
    assert np.abs(frame.U - u).max() <= 3e-3 * np.abs(u).max()
    # A start with a jump leaves high modes that the trapezoidal rule does not follow.
    share = 0.1 if kind == "initial velocity" else 0.03
    assert np.abs(frame.V[:, :2] - v[:, :2]).max() <= share * np.abs(v).max()


@pytest.mark.parametrize("residual", [False, True])
def test_the_response_converges_with_the_number_of_modes(residual):
    """To the response of all modes; residual modes make few of them enough."""
    load = LOADS["traction"]
    all_modes = modal(cantilever(), load, 24).frames
    exact = np.array([f.U for f in all_modes])[-STEPS:]
    errors = []
    for count in (1, 2, 4, 8):
        frames = modal(cantilever(), load, count, residual=residual).frames
        u = np.array([f.U for f in frames])[-STEPS:]
        errors.append(np.abs(u - exact).max() / np.abs(exact).max())
    assert all(b <= 1.02 * a for a, b in zip(errors, errors[1:], strict=False))
    assert errors[-1] < 0.02
    if residual:
        assert errors[0] < 0.02


def chain(c=0.3):
    """A support, two masses of 1 and 2 on springs of 50 and 80, with dashpots; along x."""
    mesh = lines([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], ("line2", [[0, 1], [1, 2]]))
    model = ct.Model(mesh)
    model.spring([0], 50.0, "x")
    model.spring([1], 80.0, "x")
    model.fix([1, 2], x=None, y=0.0)
    model.point_mass([1], 1.0)
    model.point_mass([2], 2.0)
    if c:
        model.dashpot(0, 1, c=c)
        model.dashpot(2, x=2.0 * c)
    return model


def test_base_motion_with_dashpots_and_a_start_beside_an_ode_integrator():
    """Two masses whose support moves as a sine: every term of the relative motion at work."""
    t = np.linspace(0.0, 2.0, 401)
    model = chain()
    model.amplitudes["s"] = Amplitude(t, np.sin(5.0 * t))
    model.fix([0], x=0.1, y=0.0, amplitude="s")
    model.velocity([1], x=0.7)

    def rate(time, z):
        x, v = z[:2], z[2:]
        s, ds = 0.1 * np.sin(5.0 * time), 0.5 * np.cos(5.0 * time)
        stretch, pull = 50.0 * (s - x[0]) + 0.3 * (ds - v[0]), 80.0 * (x[1] - x[0])
        return [*v, stretch + pull, (-pull - 0.6 * v[1]) / 2.0]

    exact = solve_ivp(rate, (0.0, 2.0), [0.0, 0.0, 0.7, 0.0], rtol=1e-10, atol=1e-12)
    steps = [
        ct.Frequency(modes=2, nlgeom=False),
        ct.ModalDynamic(period=2.0, increments=400, nlgeom=False),
    ]
    frame = ct.solve(model, steps, threads=1).frames[-1]
    assert frame.U[1:, 0] == pytest.approx(exact.y[:2, -1], rel=1e-4, abs=1e-6)
    assert frame.V[1:, 0] == pytest.approx(exact.y[2:, -1], rel=1e-3, abs=1e-4)
    # The support carries its spring and its dashpot.
    v0, u1, v1 = 0.5 * np.cos(10.0), exact.y[0, -1], exact.y[2, -1]
    force = 50.0 * (0.1 * np.sin(10.0) - u1) + 0.3 * (v0 - v1)
    assert frame.RF[0, 0] == pytest.approx(force, rel=2e-2)


def test_a_modal_step_goes_on_from_modal_and_direct_steps():
    """Two halves are the whole, and a start by direct integration is kept to its time error."""
    load = LOADS["force by amplitude"]
    whole = modal(cantilever(), load, 24).frames[-1]
    half = {"period": PERIOD / 2, "increments": STEPS // 2, "nlgeom": False}
    model = cantilever()
    t = TIMES
    model.amplitudes["sine"] = Amplitude(t, np.sin(10.0 * t), total_time=True)
    frequency = ct.Frequency(modes=24, nlgeom=False, period=1e-30)
    steps = [frequency, ct.ModalDynamic(**half, loads=load), ct.ModalDynamic(**half)]
    steps[2].loads = load
    two = ct.solve(model, steps, threads=1, fields=False).frames[-1]
    assert np.abs(two.U - whole.U).max() <= 1e-8 * np.abs(whole.U).max()
    assert np.abs(two.V - whole.V).max() <= 1e-8 * np.abs(whole.V).max()
    first = ct.Dynamic(
        period=PERIOD / 2, increments=200, scheme="newmark", nlgeom=False, loads=load
    )
    steps = [frequency, first, ct.ModalDynamic(**half, loads=load)]
    mixed = ct.solve(model, steps, threads=1, fields=False).frames[-1]
    assert np.abs(mixed.U - whole.U).max() <= 1e-2 * np.abs(whole.U).max()


def test_modal_stresses_are_those_of_a_linear_static_step():
    """A slow load: stress, strain and energy of the response are those of statics.

    Under nlgeom=True too: the response is linear about the state, so a large response has no
    stresses of large rotation.
    """
    load = [NodalForce("right", 1, -500.0)]
    still = ct.solve(cantilever(), ct.Static(nlgeom=False, loads=load), threads=1).frames[-1]
    model = cantilever()
    model.amplitudes["slow"] = Amplitude([0.0, 100.0], [0.0, 1.0])
    slow = [NodalForce("right", 1, -500.0, "slow")]
    steps = [
        ct.Frequency(modes=24),
        ct.ModalDynamic(period=100.0, increments=4, loads=slow, rayleigh=(2.0, 0.0)),
    ]
    frame = ct.solve(model, steps, threads=1).frames[-1]
    assert np.abs(frame.U - still.U).max() <= 2e-2 * np.abs(still.U).max()
    for name in ("S", "E", "MISES", "ENER"):
        a, b = frame.fields[0].values[name], still.fields[0].values[name]
        assert np.abs(a - b).max() <= 3e-2 * np.abs(b).max(), name
    assert frame.scalars["strain energy"] == pytest.approx(still.scalars["strain energy"], rel=3e-2)
    assert frame.RF.sum(axis=0)[1] == pytest.approx(still.RF.sum(axis=0)[1], rel=3e-2)


# -- harmonic ------------------------------------------------------------------------------


def sweep(model, loads, modes=None, **keys):
    step = ct.SteadyState(lowest=1.0, highest=12.0, points=6, loads=loads, nlgeom=False, **keys)
    steps = [step] if modes is None else [ct.Frequency(modes=modes, nlgeom=False), step]
    frames = ct.solve(model, steps, threads=1, fields=False).frames
    frames = [f for f in frames if "frequency" in f.scalars]
    f = np.array([x.scalars["frequency"] for x in frames])
    u = np.array([x.U for x in frames]) - 1j * np.array([x.V[:, :2] for x in frames]) / (
        2.0 * np.pi * f[:, None, None]
    )
    return f, u, frames


@pytest.mark.parametrize("kind", [k for k in MODELS if k != "initial velocity"])
def test_harmonic_response_by_all_modes_is_that_of_the_whole_model(kind):
    """Complex amplitudes, with Rayleigh damping and dashpots, at frequencies between modes."""
    found = []
    for modes in (24, None):
        model = cantilever(rayleigh=(1.0, 1e-5))
        MODELS[kind](model)
        for fixed in model.supports:
            fixed.amplitude = ""
        loads = LOADS["force"] if kind != "moving support" else []
        steps = [ct.Frequency(modes=24, nlgeom=False)]
        sweeping = ct.SteadyState(
            lowest=1.0, highest=12.0, points=4, loads=loads, nlgeom=False, direct=modes is None
        )
        frames = ct.solve(model, [*steps, sweeping], threads=1, fields=False).frames
        frames = [f for f in frames if "frequency" in f.scalars]
        found.append(np.array([[f.U, f.V[:, :2]] for f in frames]))
    assert found[0] == pytest.approx(found[1], abs=1e-6 * np.abs(found[1]).max())
    assert np.abs(found[1]).max() > 0.0


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_base_motion_and_quadrature_loads_of_a_chain(direct):
    """Two masses on a moving support, a force a quarter period ahead: 2 x 2 complex algebra."""
    model = chain()
    model.amplitudes["table"] = Amplitude([0.0, 4.0], [1.0, 3.0])
    model.fix([0], x=0.1, y=0.0, amplitude="table")
    steps = [ct.Frequency(modes=2, nlgeom=False)]
    steps.append(
        ct.SteadyState(
            lowest=0.5,
            highest=3.0,
            points=5,
            nlgeom=False,
            direct=direct,
            imaginary_loads=[NodalForce([2], 0, 4.0)],
        )
    )
    frames = ct.solve(model, steps, threads=1).frames
    frames = [f for f in frames if "frequency" in f.scalars]
    assert len(frames) > 4
    for frame in frames:
        f = frame.scalars["frequency"]
        w = 2.0 * np.pi * f
        base = 0.1 * (1.0 + 0.5 * f)
        k = np.array([[130.0, -80.0], [-80.0, 80.0]])
        c = np.diag([0.3, 0.6])
        dynamic = k - w**2 * np.diag([1.0, 2.0]) + 1j * w * c
        exact = np.linalg.solve(dynamic, [(50.0 + 0.3j * w) * base, 4.0j])
        found = frame.U[1:, 0] - 1j * frame.V[1:, 0] / w
        assert found == pytest.approx(exact, rel=1e-9)
        reaction = (50.0 + 0.3j * w) * (base - exact[0])
        assert frame.RF[0, 0] == pytest.approx(reaction.real, rel=1e-9)


def test_ranges_of_modal_damping():
    """Each mode has the damping of its range: the peak over the static part is 1 / (2 share)."""
    model = chain(0.0)
    model.fix([0])
    steps = [
        ct.Frequency(modes=2, nlgeom=False),
        ct.SteadyState(
            lowest=0.1,
            highest=4.0,
            points=41,
            nlgeom=False,
            loads=[NodalForce([1], 0, 1.0)],
            damping=[(1, 1, 0.01), (2, 2, 0.04)],
        ),
    ]
    results = ct.solve(model, steps, threads=1)
    modes = results.modes[0]
    frames = [f for f in results.frames if "frequency" in f.scalars]
    for frame in frames:
        w = 2.0 * np.pi * frame.scalars["frequency"]
        own = 2.0 * np.pi * modes.factors
        shape = modes.shapes[:, 1, 0]
        exact = (shape**2 / (own**2 - w**2 + 2j * np.array([0.01, 0.04]) * own * w)).sum()
        assert frame.U[1, 0] == pytest.approx(exact.real, rel=1e-8, abs=1e-10)

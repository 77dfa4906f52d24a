"""Modal dynamics and harmonic response, against closed forms and small programs."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy import linalg

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.particles import (
    MASSES,
    STIFFNESS,
    bars,
    chain,
    chain_matrices,
    linear_motion,
    modal_damping,
    network,
    table,
    without_first_support,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


CORNERS, SHIFTS = [0.0, 0.25, 0.5, 1.0, 2.0], [0.0, 0.1, 0.1, -0.2, 0.0]


@pytest.mark.parametrize("damping", ["modal", "rayleigh", "dashpot"])
def test_modal_dynamics_of_a_base_moved_by_a_table_with_corners(damping):
    # Velocity jumps at every corner. Modal shares damp the motion relative to the base, Rayleigh's
    # per mass the absolute one, a dashpot between support and first particle their approach.
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    model = without_first_support(chain(STIFFNESS, MASSES))
    table(model, "base", CORNERS, SHIFTS)
    slopes = np.diff(SHIFTS) / np.diff(CORNERS)
    options = {}
    if damping == "modal":
        c, options = modal_damping(k, m, 0.03), {"damping": 0.03}
        moved = c.sum(axis=1)
    elif damping == "rayleigh":
        c, options = 0.4 * m + 0.002 * k, {"rayleigh": (0.4, 0.002)}
        moved = 0.002 * to_base
    else:
        c = np.diag([3.0, 0.0, 0.0])
        model.dashpot(0, 1, c=3.0)
        moved = np.array([3.0, 0.0, 0.0])

    def load(t):
        piece = min(max(np.searchsorted(CORNERS, t, side="left") - 1, 0), 3)
        return to_base * np.interp(t, CORNERS, SHIFTS) + moved * slopes[piece]

    exact = linear_motion(k, m, c, load, 2.0, CORNERS)
    steps = [
        ct.Frequency(modes=3, supports=[Fixed([0], 0)]),
        ct.ModalDynamic(
            period=2.0, increments=40, supports=[Fixed([0], 0, 1.0, "base")], **options
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], exact[:3], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(frame.V[1:, 0], exact[3:], rtol=1e-6, atol=1e-8)


def test_modal_dynamics_goes_on_from_direct_integration():
    # Half a second by the trapezoidal rule under a force, then by modes without it: free vibration
    # from the state reached, by the matrix exponential.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    first = ct.Dynamic(
        nlgeom=False, period=0.5, increments=400, scheme="newmark", loads=[NodalForce([3], 0, 2.0)]
    )
    second = ct.ModalDynamic(nlgeom=False, period=1.0, increments=10, new_loads=True)
    results = ct.solve(model, [first, ct.Frequency(modes=3, nlgeom=False), second])
    reached = [f for f in results.frames if f.step == 1][-1]
    matrix = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(m, k), np.zeros((3, 3))]])
    start = np.r_[reached.U[1:, 0], reached.V[1:, 0]]
    exact = linalg.expm(matrix) @ start
    last = results.frames[-1]
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(last.V[1:, 0], exact[3:], rtol=1e-6, atol=1e-9)


def test_modal_dynamics_about_a_taut_string():
    # The middle of a taut string of five particles is plucked by a force that is let go over one
    # increment: modes about the taut state, with the linear stiffness T/a.
    n, k, m, a, tension = 5, 1e4, 0.2, 0.5, 30.0
    model = network([[i * a, 0.0] for i in range(n + 2)], [[i, i + 1] for i in range(n + 1)])
    bars(model, list(range(n + 1)), k, a)
    model.point_mass(list(range(1, n + 1)), m)
    model.initial_stress(xx=tension)
    model.fix([0, n + 1])
    table(model, "pluck", [0.0, 0.1, 0.105], [1.0, 1.0, 0.0])
    steps = [
        ct.Static(),
        ct.Frequency(modes=2 * n),
        ct.ModalDynamic(period=0.4, increments=80, loads=[NodalForce([3], 1, 0.05, "pluck")]),
    ]
    frame = ct.solve(model, steps).frames[-1]
    matrix = tension / a * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))

    def load(t):
        return np.array([0.0, 0.0, 0.05, 0.0, 0.0]) * np.interp(t, [0.1, 0.105], [1.0, 0.0])

    exact = linear_motion(matrix, m * np.eye(n), np.zeros((n, n)), load, 0.4, [0.1, 0.105])
    np.testing.assert_allclose(frame.U[1:-1, 1], exact[:n], atol=1e-5 * abs(exact[:n]).max())


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_response_to_forces_out_of_phase_with_dashpots(direct):
    # (K - w^2 M + i w C) u = f1 + i f2, with a dashpot that couples modes; a frame holds Re u in U
    # and -w Im u in V. Through resonance, modal and direct.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    c = 0.2 * m + np.diag([0.0, 0.0, 1.5])
    model = chain(STIFFNESS, MASSES)
    model.dashpot(3, x=1.5)
    steady = ct.SteadyState(
        lowest=0.5,
        highest=3.0,
        points=7,
        direct=direct,
        rayleigh=(0.2, 0.0),
        loads=[NodalForce([1], 0, 2.0)],
        imaginary_loads=[NodalForce([3], 0, -1.0)],
    )
    results = ct.solve(model, [ct.Frequency(modes=3), steady])
    frames = [f for f in results.frames if f.step == 2]
    assert len(frames) == 19
    for frame in frames:
        w = 2 * np.pi * frame.time
        exact = np.linalg.solve(k - w**2 * m + 1j * w * c, [2.0, 0.0, -1j])
        size = np.abs(exact).max()
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-6 * size)
        np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, atol=1e-6 * w * size)


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_motion_of_a_base_in_two_phases(direct):
    # The base moves by Re (1 + 0.5 i) b exp(i w t); Rayleigh damping per stiffness acts on the
    # approach to the base. Reaction of the base: k1 (1 + i w beta) (ub - u1).
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    beta, move = 0.003, 0.01
    model = without_first_support(chain(STIFFNESS, MASSES))
    steady = ct.SteadyState(
        lowest=0.6,
        highest=2.5,
        points=5,
        direct=direct,
        rayleigh=(0.0, beta),
        supports=[Fixed([0], 0, move)],
        imaginary_supports=[Fixed([0], 0, 0.5 * move)],
    )
    steps = [ct.Frequency(modes=3, supports=[Fixed([0], 0)]), steady]
    frames = [f for f in ct.solve(model, steps).frames if f.step == 2]
    for frame in frames:
        w = 2 * np.pi * frame.time
        complex_k = 1 + 1j * w * beta
        base = (1 + 0.5j) * move
        exact = np.linalg.solve(complex_k * k - w**2 * m, complex_k * to_base * base)
        size = np.abs(exact).max()
        np.testing.assert_allclose(frame.U[1:, 0], exact.real, atol=1e-6 * size)
        np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, atol=1e-6 * w * size)
        reaction = complex_k * 100.0 * (base - exact[0])
        np.testing.assert_allclose(frame.RF[0, 0], reaction.real, atol=1e-5 * abs(reaction))


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_force_where_a_dead_load_acts(direct):
    # The amplitude is that of the step, whatever load the state carries at the same place; U holds
    # the displacement of the state, too. The static step after it goes on under the dead load.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    steps = [
        ct.Static(loads=[NodalForce([3], 0, 1.0)]),
        ct.Frequency(modes=3),
        ct.SteadyState(
            lowest=0.3,
            highest=0.7,
            points=2,
            direct=direct,
            loads=[NodalForce([3], 0, 2.0)],
            imaginary_loads=[NodalForce([3], 0, 0.5)],
            rayleigh=(0.1, 0.0),
        ),
        ct.Static(),
    ]
    frames = ct.solve(chain(STIFFNESS, MASSES), steps).frames
    rest = np.linalg.solve(k, [0.0, 0.0, 1.0])
    for frame in frames:
        if frame.step == 3:
            w = 2 * math.pi * frame.scalars["frequency"]
            exact = np.linalg.solve(k + (0.1j * w - w**2) * m, [0.0, 0.0, 2.0 + 0.5j])
            np.testing.assert_allclose(frame.U[1:, 0], rest + exact.real, rtol=1e-7)
            np.testing.assert_allclose(frame.V[1:, 0], -w * exact.imag, rtol=1e-6)
    np.testing.assert_allclose(frames[-1].U[1:, 0], rest, rtol=1e-9)


def test_shares_of_damping_by_ranges_of_modes():
    # Modes 1 and 3 have their own shares, mode 2 none: decay of each from its own start, u =
    # shape (cos wd t + z w/wd sin wd t) exp(-z w t), started by a static force K phi.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    squares, modes = linalg.eigh(k, m)
    shares = [0.1, 0.0, 0.02]
    for i in range(3):
        model = chain(STIFFNESS, MASSES)
        force = k @ modes[:, i] * 1e-3
        steps = [
            ct.Static(nlgeom=False, loads=[NodalForce([j + 1], 0, force[j]) for j in range(3)]),
            ct.Frequency(modes=3, nlgeom=False),
            ct.ModalDynamic(
                nlgeom=False,
                period=0.7,
                increments=7,
                damping=[(1, 1, shares[0]), (3, 3, shares[2])],
                new_loads=True,
            ),
        ]
        frame = ct.solve(model, steps).frames[-1]
        w, z = math.sqrt(squares[i]), shares[i]
        wd = w * math.sqrt(1 - z**2)
        q = (math.cos(wd * 0.7) + z * w / wd * math.sin(wd * 0.7)) * math.exp(-z * w * 0.7)
        np.testing.assert_allclose(frame.U[1:, 0], 1e-3 * q * modes[:, i], atol=1e-9)


def test_one_mode_with_residual_modes_is_static_at_rest():
    # A force that grows slowly from zero: one mode alone misses the static answer, with residual
    # modes it is K^-1 f.
    k, _, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    table(model, "slow", [0.0, 50.0], [0.0, 1.0])
    steps = [
        ct.Frequency(modes=1),
        ct.ModalDynamic(
            period=50.0,
            increments=500,
            damping=0.3,
            residual=True,
            loads=[NodalForce([1], 0, 3.0, "slow")],
        ),
    ]
    frame = ct.solve(model, steps).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], np.linalg.solve(k, [3.0, 0.0, 0.0]), rtol=5e-3)

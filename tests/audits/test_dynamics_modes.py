# SPDX-License-Identifier: BSD-3-Clause
"""Second audit, linear procedures: modes, spin, damping, modal and harmonic response.

References: published tables of rotating beams, Ritz' method, SciPy's eigensolvers and matrix
exponentials, closed forms of beams and bars.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy import linalg
from scipy.optimize import brentq

import corota as ct
from corota.model.loads import Fixed, NodalForce
from support.particles import (
    LIGHT,
    chain,
    chain_matrices,
    extrapolated,
    linear_motion,
    network,
    table,
    without_first_support,
)

STIFFNESS, MASSES = [100.0, 200.0, 50.0], [1.0, 2.0, 0.5]
CORNERS, SHIFTS = [0.0, 0.25, 0.5, 1.0, 2.0], [0.0, 0.1, 0.1, -0.2, 0.0]


def beam(n, length=1.0, stretch=1e6, bending=1.0, line_mass=1.0, depth=None, **options):
    """A straight beam on the x axis; its rotary inertia is that of the cross-section."""
    x = np.linspace(0.0, length, n + 1)
    model = network([[a, 0.0] for a in x], [[i, i + 1] for i in range(n)])
    area = 1.0
    material = ct.Elastic(E=stretch, rho=line_mass)
    model.beam(list(range(n)), material=material, area=area, inertia=bending / stretch, **options)
    return model


def rates(model, modes, **options):
    return 2 * math.pi * ct.solve(model, ct.Frequency(modes=modes, **options)).modes[-1].factors


# --- spin ----------------------------------------------------------------------------------------

#: First two flapping frequencies of a uniform cantilever that turns about its root, over
#: sqrt(EI / m L^4), by Wright, Smith, Thresher and Wang (J. Appl. Mech. 49, 1982), table 1.
WRIGHT = {
    0: (3.5160, 22.0345),
    1: (3.6817, 22.1810),
    2: (4.1373, 22.6149),
    3: (4.7973, 23.3203),
    4: (5.5850, 24.2733),
    5: (6.4495, 25.4461),
    6: (7.3604, 26.8091),
    10: (11.2023, 33.6404),
}


@pytest.mark.parametrize("spin", [0, 1, 3, 6, 10])
def test_rotating_cantilever_of_the_literature(spin):
    # In the plane of spin the square is less by that of the spin (lead-lag); Wright et al. The
    # mass of beams is that of their chords, an error of the square of their length.
    def run(n):
        model = beam(n)
        model.fix([0], rotation=True)
        steps = [ct.Frequency(modes=2)]
        if spin:
            model.centrifugal(float(spin))
            steps = [ct.Static(), *steps]
        return 2 * math.pi * ct.solve(model, steps).modes[-1].factors

    exact = np.sqrt(np.square(WRIGHT[spin]) - spin**2)
    np.testing.assert_allclose(extrapolated(run, 16), exact, rtol=5e-4)


def ritz_rotating(spin, hub, tip=0.0, n=9):
    """Lead-lag frequencies of a unit cantilever on a hub with a tip mass, in polynomials."""
    basis = [Polynomial([0.0] * (i + 2) + [1.0]) for i in range(n)]

    def integral(p):
        q = p.integ()
        return q(1.0) - q(0.0)

    x = Polynomial([0.0, 1.0])
    pull = hub * (1 - x) + 0.5 * (1 - x * x) + tip * (hub + 1)  # tension over spin^2
    k, m = np.zeros((n, n)), np.zeros((n, n))
    for i, a in enumerate(basis):
        for j, b in enumerate(basis):
            mass = integral(a * b) + tip * a(1.0) * b(1.0)
            k[i, j] = integral(a.deriv(2) * b.deriv(2))
            k[i, j] += spin**2 * (integral(pull * a.deriv() * b.deriv()) - mass)
            m[i, j] = mass
    return np.sqrt(linalg.eigh(k, m, eigvals_only=True))


@pytest.mark.parametrize(("spin", "hub"), [(4.0, 1.0), (8.0, 0.5), (12.0, 2.0)])
@pytest.mark.parametrize("element", ["beam", "Q8"])
def test_rotating_blade_on_a_hub(spin, hub, element):
    # Ritz' method in the tension of the undeformed blade; beams and a slender strip.
    exact = ritz_rotating(spin, hub)[:3]

    def run(n):
        thin = 0.005
        if element == "beam":
            model = beam(n)
            model.fix([0], rotation=True)
        else:
            model = ct.Model(ct.mesh.rectangle(1.0, thin, nx=n, ny=1, cell="quad8"))
            material = ct.Elastic(E=12.0 / thin**3, nu=0.0, rho=1.0 / thin)
            model.section("all", element=element, material=material)
            model.fix("left")
        model.centrifugal(spin, about=(-hub, 0.0 if element == "beam" else 0.5 * thin))
        steps = [ct.Static(), ct.Frequency(modes=3)]
        return 2 * math.pi * ct.solve(model, steps).modes[-1].factors

    np.testing.assert_allclose(extrapolated(run, 16), exact, rtol=1.5e-3)


def test_coriolis_forces_couple_stretch_and_lag_of_a_blade():
    # Ritz: axial s and lateral w with 2 m W (s' dw - w' ds); a soft blade, so both meet. Every
    # mass of bars is a particle here: lumped, axial and lateral springs from a taut string.
    n, spin = 12, 3.0
    length, stretch, line_mass = 1.0, 900.0, 1.0
    a = length / n
    model = network([[i * a, 0.0] for i in range(n + 1)], [[i, i + 1] for i in range(n)])
    model.truss(list(range(n)), material=ct.Elastic(E=stretch, rho=line_mass), area=1.0)
    model.centrifugal(spin)
    held = [Fixed([0], 0), Fixed([0], 1)]
    steps = [
        ct.Static(supports=[Fixed([0], 0), Fixed(list(range(n + 1)), 1)]),
        ct.Frequency(modes=4, mass="lumped", complex_modes=True, new_supports=True, supports=held),
    ]
    results = ct.solve(model, steps)
    state = [f for f in results.frames if f.step == 1][-1]
    # own equilibrium: radii of particles under m W^2 r and linear springs
    m = np.full(n + 1, line_mass * a)
    m[-1] /= 2
    k = stretch / a
    matrix = np.zeros((n, n))
    for i in range(n):
        matrix[i, i] += k
        if i:
            matrix[i - 1, i - 1] += k
            matrix[i - 1, i] -= k
            matrix[i, i - 1] -= k
    mass = np.diag(m[1:])
    x0 = np.arange(1, n + 1) * a
    u = np.linalg.solve(matrix - spin**2 * mass, spin**2 * m[1:] * x0)
    np.testing.assert_allclose(state.U[1:, 0], u, rtol=1e-7)
    radii = np.r_[0.0, x0 + u]
    gap = np.diff(radii)
    force = k * (gap - a)
    lateral = np.zeros((n, n))
    for i in range(n):
        s = force[i] / gap[i]
        lateral[i, i] += s
        if i:
            lateral[i - 1, i - 1] += s
            lateral[i - 1, i] -= s
            lateral[i, i - 1] -= s
    stiff = linalg.block_diag(matrix - spin**2 * mass, lateral - spin**2 * mass)
    whole = linalg.block_diag(mass, mass)
    zero = np.zeros((n, n))
    turn = 2 * spin * np.block([[zero, -mass], [mass, zero]])
    state_matrix = np.block(
        [
            [np.zeros((2 * n, 2 * n)), np.eye(2 * n)],
            [-np.linalg.solve(whole, stiff), -np.linalg.solve(whole, turn)],
        ]
    )
    roots = np.sort(np.linalg.eigvals(state_matrix).imag)
    roots = roots[roots > 1e-6]
    modes = results.modes[-1]
    # the turn of the taut blade as a whole is no vibration
    np.testing.assert_allclose(2 * math.pi * modes.factors[0], 0.0, atol=1e-4)
    np.testing.assert_allclose(2 * math.pi * modes.factors[1:], roots[:3], rtol=1e-6)
    np.testing.assert_allclose(modes.growth, 0.0, atol=1e-4)


EAST_NORTH_WEST = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]


@pytest.mark.filterwarnings("ignore:the state of frequency step")
@pytest.mark.parametrize("element", ["Q8", "BEAM"])
def test_spinning_free_ring(element):
    # Inextensional ring with n lobes in the frame that turns, with the hoop tension m W^2 r^2:
    # (n^2 + 1) s^2 -+ 4 n W s = n^2 (n^2 - 1)^2 EI / m r^4 + n^2 (n^2 - 3) W^2, by Lagrange.
    spin, n = 2.0, 24
    angle = 2 * np.pi * np.arange(n) / n
    if element == "BEAM":
        points = np.c_[np.cos(angle), np.sin(angle)]
        model = network(points, [[i, (i + 1) % n] for i in range(n)])
        model.beam(list(range(n)), material=ct.Elastic(E=1e4, rho=1.0), area=0.1, inertia=8e-5)
    else:
        kind = "quad8" if element == "Q8" else "quad4"
        mesh = ct.mesh.annulus(0.95, 1.05, n_radial=1, n_around=n, cell=kind)
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.centrifugal(spin)
    points = model.mesh.points
    inner = np.hypot(*points.T) < 1.0 + 1e-9
    sides = [int(np.argmax(np.where(inner, points @ np.array(d), -9.0))) for d in EAST_NORTH_WEST]
    tangents = [Fixed([sides[0]], 1), Fixed([sides[1]], 0), Fixed([sides[2]], 1)]
    steps = [
        ct.Static(supports=tangents),
        ct.Frequency(modes=7, complex_modes=True, new_supports=True),
    ]
    found = np.sort(2 * math.pi * ct.solve(model, steps).modes[-1].factors)
    bending = 1e4 * (8e-5 if element == "BEAM" else 0.1**3 / 12)
    area, lobes = 0.1, 2
    square = lobes**2 * (lobes**2 - 1) ** 2 * bending / area + lobes**2 * (lobes**2 - 3) * spin**2
    p, q = 2 * lobes * spin / (lobes**2 + 1), square / (lobes**2 + 1)
    exact = np.array([math.sqrt(p**2 + q) - p, math.sqrt(p**2 + q) + p])
    near = [found[np.argmin(np.abs(found - e))] for e in exact]
    np.testing.assert_allclose(near, exact, rtol=0.025)
    # rigid motions seen from the frame: translations at the spin itself
    assert np.sum(np.abs(found - spin) < 0.02 * spin) >= 2


# --- beams, masses, springs ----------------------------------------------------------------------


@pytest.mark.parametrize("tip", [0.5, 2.0])
def test_cantilever_with_a_heavy_tip(tip):
    # Mass and inertia at the tip: roots of the determinant of the four constants.
    inertia = 0.05

    def run(n):
        model = beam(n)
        model.fix([0], rotation=True)
        model.point_mass([n], tip, inertia=inertia)
        return rates(model, 3)

    found = extrapolated(run, 12)

    def determinant(b):
        s, c, sh, ch = math.sin(b), math.cos(b), math.sinh(b), math.cosh(b)
        # w = A (cosh - cos) + B (sinh - sin); EI w'' = w^2 J w', EI w''' = -w^2 M w at the tip
        w2 = b**4
        rows = [
            [
                b**2 * (ch + c) - w2 * inertia * b * (sh + s),
                b**2 * (sh + s) - w2 * inertia * b * (ch - c),
            ],
            [b**3 * (sh - s) + w2 * tip * (ch - c), b**3 * (ch + c) + w2 * tip * (sh - s)],
        ]
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]

    grid = np.linspace(0.3, 12.0, 20000)
    values = np.array([determinant(b) for b in grid])
    low = np.flatnonzero(values[1:] * values[:-1] < 0)[:3]
    exact = [brentq(determinant, grid[i], grid[i + 1]) ** 2 for i in low]
    np.testing.assert_allclose(found, exact, rtol=3e-4)


@pytest.mark.parametrize("where", [0.25, 0.5])
def test_beam_on_a_spring_between_its_supports(where):
    # Simply supported with a spring to the ground: Rayleigh-Ritz in sines, which is exact here.
    stiff = 400.0

    def run(n):
        points = [[a / n, 0.0] for a in range(n + 1)]
        model = network(points, [[j, j + 1] for j in range(n)], [round(n * where)])
        material = ct.Elastic(E=1e6, rho=1.0)
        model.beam(list(range(n)), material=material, area=1.0, inertia=1e-6)
        model.spring([n], stiff, "y")
        model.fix([0])
        model.fix([n], x=None)
        return rates(model, 4)

    k = np.arange(1, 400) * math.pi
    sines = np.sin(k * where)
    matrix = np.diag(0.5 * k**4) + stiff * np.outer(sines, sines)
    exact = np.sqrt(2 * linalg.eigh(matrix, eigvals_only=True, subset_by_index=[0, 3]))
    np.testing.assert_allclose(extrapolated(run, 24), exact, rtol=1.5e-3)


def test_timoshenko_beam_with_rotary_inertia():
    # Simply supported, lobes j: m A w^2 ... the quadratic in w^2 of Timoshenko (1921), exactly.
    n, length, young, nu, depth = 60, 1.0, 1.0, 0.25, 0.2
    shear = young / (2 * (1 + nu))
    area, inertia, kappa = depth, depth**3 / 12, 5 / 6
    x = np.linspace(0.0, length, n + 1)
    model = network([[a, 0.0] for a in x], [[i, i + 1] for i in range(n)])
    model.beam(
        list(range(n)),
        material=ct.Elastic(E=young, nu=nu, rho=1.0),
        area=area,
        inertia=inertia,
        shear_area=kappa * area,
    )
    model.fix([0])
    model.fix([n], x=None)
    model.fix(list(range(1, n)), x=0.0, y=None)
    found = rates(model, 3)
    exact = []
    for j in (1, 2, 3):
        b = j * math.pi / length
        # [kGA b^2 - rA w^2, -kGA b; -kGA b, EI b^2 + kGA - rI w^2]
        k = np.array(
            [
                [kappa * shear * area * b**2, -kappa * shear * area * b],
                [-kappa * shear * area * b, young * inertia * b**2 + kappa * shear * area],
            ]
        )
        exact.append(math.sqrt(linalg.eigh(k, np.diag([area, inertia]), eigvals_only=True)[0]))
    np.testing.assert_allclose(found, exact, rtol=3e-3)


def test_taut_and_slack_beams_by_temperature():
    # w^2 = (j pi)^4 EI/m + (j pi)^2 T/m, T = -EA alpha dT of a beam held at both ends.
    for heat in (-20.0, 5.0):
        stretch = 1e4

        def run(n, heat=heat, stretch=stretch):
            x = np.linspace(0.0, 1.0, n + 1)
            model = network([[a, 0.0] for a in x], [[i, i + 1] for i in range(n)])
            material = ct.Elastic(E=stretch, rho=1.0, expansion=ct.Expansion([1e-4]))
            model.beam(list(range(n)), material=material, area=1.0, inertia=1e-4)
            model.fix([0, n])
            model.temperature(heat)
            return ct.solve(model, [ct.Static(), ct.Frequency(modes=3)]).modes[-1].factors

        found = extrapolated(run, 12)
        j = np.arange(1, 4) * math.pi
        tension = -stretch * 1e-4 * heat
        exact = np.sqrt(j**4 * stretch * 1e-4 + j**2 * tension) / (2 * math.pi)
        rotary = 1 / np.sqrt(1 + j**2 * 1e-4)
        np.testing.assert_allclose(found, exact * rotary, rtol=1.5e-3)


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_bar_of_tied_unlike_meshes_under_tension(mass):
    # Longitudinal modes of a bar whose halves are tied on unlike meshes: (2 j - 1) c / 4 L.
    a = ct.mesh.rectangle(1.0, 0.2, nx=12, ny=2)
    b = ct.mesh.rectangle(1.0, 0.2, nx=12, ny=3)
    b = replace(b, points=np.add(b.points, [1.0, 0.0]))
    model = ct.Model(ct.mesh.assembly(a=a, b=b))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.0, rho=1.0))
    model.tie("a.right", "b.left")
    model.fix("a.left")
    everything = np.arange(model.mesh.n_nodes)
    model.fix(everything, x=None)
    found = ct.solve(model, ct.Frequency(modes=3, mass=mass)).modes[-1].factors
    np.testing.assert_allclose(found, 10.0 * np.array([1, 3, 5]) / 8.0, rtol=8e-3)


# --- damping -------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ["T6", "Q8", "Q4D", "BEAM"])
def test_complex_modes_of_rayleigh_damping(element):
    # With C = a M + b K modes stay, growth is -(a + b w^2)/2, the damped circular frequency
    # sqrt(w^2 - growth^2).
    alpha, beta = 0.6, 2e-3
    if element == "BEAM":
        model = beam(8, stretch=1e4)
        model.fix([0], rotation=True)
    else:
        kind = {"T6": "tri6", "Q8": "quad8"}.get(element, "quad4")
        model = ct.Model(ct.mesh.rectangle(2.0, 0.4, nx=6, ny=2, cell=kind))
        model.section("all", element=element, material=ct.Elastic(E=400.0, nu=0.3, rho=1.0))
        model.fix("left", rotation=True if element == "Q4D" else None)
    plain = rates(model, 3)
    step = ct.Frequency(modes=3, complex_modes=True, rayleigh=(alpha, beta))
    modes = ct.solve(model, step).modes[-1]
    growth = -0.5 * (alpha + beta * plain**2)
    order = np.argsort(2 * math.pi * modes.factors)
    np.testing.assert_allclose(modes.growth[order], growth, rtol=1e-5)
    np.testing.assert_allclose(
        2 * math.pi * modes.factors[order], np.sqrt(plain**2 - growth**2), rtol=1e-6
    )


def test_damping_of_one_material_alone():
    # Two trusses in a row, one damped per stiffness: quadratic eigenproblem by SciPy.
    k, m = [80.0, 120.0], [1.0, 1.5]
    model = network([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], [[0, 1], [1, 2]])
    beta = 0.02
    soft = ct.Elastic(E=k[0], rho=LIGHT)
    damped = ct.Elastic(E=k[1], rho=LIGHT, rayleigh=(0.0, beta))
    model.truss([0], material=soft, area=1.0)
    model.truss([1], material=damped, area=1.0)
    model.point_mass([1], m[0])
    model.point_mass([2], m[1])
    model.fix([0])
    model.fix([1, 2], x=None)
    matrix, mass, _ = chain_matrices(k, m)
    c = beta * k[1] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    state = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-linalg.solve(mass, matrix), -linalg.solve(mass, c)]]
    )
    roots = linalg.eigvals(state)
    roots = roots[roots.imag > 0]
    roots = roots[np.argsort(roots.imag)]
    modes = ct.solve(model, ct.Frequency(modes=2, complex_modes=True)).modes[-1]
    np.testing.assert_allclose(2 * math.pi * modes.factors, roots.imag, rtol=1e-6)
    np.testing.assert_allclose(modes.growth, roots.real, rtol=1e-6)
    # the same decay in time
    end = 0.9
    start = np.r_[0.0, 0.0, 0.0, 1.0]
    exact = linalg.expm(state * end) @ start
    model.velocity([2], x=1.0)
    frame = ct.solve(
        model, [ct.Frequency(modes=2), ct.ModalDynamic(period=end, increments=9)]
    ).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], exact[:2], rtol=1e-6)
    step = ct.Dynamic(period=end, increments=400, scheme="newmark")
    frame = ct.solve(model, step).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], exact[:2], rtol=1e-3)


# --- modal transients ----------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["smooth", "jump", "table"])
def test_modal_beside_direct_beside_scipy_for_a_moving_base(kind):
    # The base by a smooth table, a jump in velocity at once, and corners; dashpots, shares and
    # Rayleigh damping together. SciPy, modal, and direct integration with reactions.
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)
    end = 1.2
    times = np.linspace(0.0, end, 25)
    moves = {
        "smooth": 0.1 * (1 - np.cos(5 * times)),
        "jump": 0.3 * times,
        "table": np.interp(times, CORNERS, SHIFTS),
    }[kind]
    model = without_first_support(chain(STIFFNESS, MASSES))
    table(model, "base", times, moves)
    model.dashpot(1, 2, c=2.0)
    c = 0.001 * k + 2.0 * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    slope = np.diff(moves) / np.diff(times)

    def load(t):
        piece = min(max(np.searchsorted(times, t, side="left") - 1, 0), len(slope) - 1)
        return to_base * (np.interp(t, times, moves) + 0.001 * slope[piece])

    exact = linear_motion(k, m, c, load, end, list(times))
    held = [Fixed([0], 0)]
    moved = [Fixed([0], 0, 1.0, "base")]
    modal = ct.ModalDynamic(period=end, increments=24, supports=moved, rayleigh=(0.0, 0.001))
    frame = ct.solve(model, [ct.Frequency(modes=3, supports=held), modal]).frames[-1]
    np.testing.assert_allclose(frame.U[1:, 0], exact[:3], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(frame.V[1:, 0], exact[3:], rtol=1e-6, atol=1e-7)
    direct = ct.Dynamic(
        period=end, increments=192, supports=moved, rayleigh=(0.0, 0.001), scheme="newmark"
    )
    last = ct.solve(model, direct).frames[-1]
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], atol=1e-3)
    # reaction: spring and its damping between base and first particle
    rate = np.gradient(moves, times, edge_order=2)[-1]
    force = 100.0 * (moves[-1] - exact[0] + 0.001 * (rate - exact[3]))
    np.testing.assert_allclose(last.RF[0, 0], force, atol=5e-3 * 100.0 * 0.1)
    np.testing.assert_allclose(frame.RF[0, 0], force, atol=5e-3 * 100.0 * 0.1)


@pytest.mark.parametrize("load", ["gravity", "pressure", "moment"])
def test_modal_beside_direct_for_loads(load):
    # A plate of Q4D with all of its modes beside the trapezoidal rule, linear, extrapolated.
    mesh = ct.mesh.rectangle(2.0, 0.5, nx=3, ny=1)
    material = ct.Elastic(E=300.0, nu=0.3, rho=1.0)

    def model():
        m = ct.Model(mesh)
        m.section("all", element="Q4D", material=material)
        m.fix("left", rotation=True)
        table(m, "sine", np.linspace(0, 1, 51), np.sin(3 * np.linspace(0, 1, 51)) ** 2)
        if load == "gravity":
            m.gravity(x=1.0, y=-2.0, amplitude="sine")
        elif load == "pressure":
            m.pressure("top", 0.3, amplitude="sine")
        else:
            m.force("right", moment=0.1, y=0.05, amplitude="sine")
        return m

    def direct(n):
        step = ct.Dynamic(nlgeom=False, period=1.0, increments=n, scheme="newmark")
        frame = ct.solve(model(), step).frames[-1]
        return np.c_[frame.U, frame.UR]

    exact = (4 * direct(300) - direct(150)) / 3
    count = 3 * (mesh.n_nodes - 2)
    steps = [
        ct.Frequency(nlgeom=False, modes=count),
        ct.ModalDynamic(nlgeom=False, period=1.0, increments=50),
    ]
    frame = ct.solve(model(), steps).frames[-1]
    found = np.c_[frame.U, frame.UR]
    np.testing.assert_allclose(found, exact, atol=0.01 * np.abs(exact).max())
    assert np.abs(exact).max() > 1e-4


def test_energies_of_modal_dynamics():
    # Kinetic and strain energy of a damped chain under a force, by SciPy.
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    model = chain(STIFFNESS, MASSES)
    table(model, "push", [0.0, 0.5, 1.5], [0.0, 1.0, -1.0])
    modal = ct.ModalDynamic(
        period=1.5, increments=30, rayleigh=(0.5, 0.0), loads=[NodalForce([3], 0, 4.0, "push")]
    )
    last = ct.solve(model, [ct.Frequency(modes=3), modal]).frames[-1]

    def load(t):
        return np.array([0.0, 0.0, 4.0 * np.interp(t, [0.0, 0.5, 1.5], [0.0, 1.0, -1.0])])

    z = linear_motion(k, m, 0.5 * m, load, 1.5, [0.5])
    found = [last.scalars["kinetic energy"], last.scalars["modal strain energy"]]
    np.testing.assert_allclose(found, [0.5 * z[3:] @ m @ z[3:], 0.5 * z[:3] @ k @ z[:3]], rtol=1e-6)


def test_modal_shares_of_a_moment_on_a_beam():
    # A cantilever struck by a moment at its tip that stays: modal series of the tip's rotation.
    end, shares = 0.5, 0.02

    def run(n):
        model = beam(n)
        model.fix([0], rotation=True)
        modal = ct.ModalDynamic(period=end, increments=20, damping=shares, residual=True)
        modal.force([n], moment=0.01)
        frame = ct.solve(model, [ct.Frequency(modes=10), modal]).frames[-1]
        return np.array([frame.UR[n], frame.U[n, 1]])

    # own: a finite element cantilever with Hermite's cubics
    n, h = 16, 1 / 16
    k, m = np.zeros((2 * n + 2,) * 2), np.zeros((2 * n + 2,) * 2)
    ke = (
        np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h**2, -6 * h, 4 * h**2],
            ]
        )
        / h**3
    )
    me = (
        np.array(
            [
                [156, 22 * h, 54, -13 * h],
                [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                [54, 13 * h, 156, -22 * h],
                [-13 * h, -3 * h**2, -22 * h, 4 * h**2],
            ]
        )
        * h
        / 420
    )
    for i in range(n):
        at = slice(2 * i, 2 * i + 4)
        k[at, at] += ke
        m[at, at] += me
    k, m = k[2:, 2:], m[2:, 2:]
    f = np.zeros(2 * n)
    f[-1] = 0.01
    squares, shapes = linalg.eigh(k, m)
    w = np.sqrt(squares)
    wd = w * math.sqrt(1 - shares**2)
    decay = np.exp(-shares * w * end)
    q = (
        (shapes.T @ f)
        / squares
        * (1 - decay * (np.cos(wd * end) + shares * w / wd * np.sin(wd * end)))
    )
    exact = shapes @ q
    np.testing.assert_allclose(extrapolated(run, 16), exact[[-1, -2]], rtol=2e-3)


# --- harmonic response ---------------------------------------------------------------------------


@pytest.mark.parametrize("direct", [False, True])
def test_harmonic_rotation_of_a_hub(direct):
    # The clamped end of a beam is turned by b exp(i w t): exact solution of the beam's equation.
    n, move = 24, 1e-3
    model = beam(n)
    model.fix([0])
    steady = ct.SteadyState(
        lowest=1.0,
        highest=2.5,
        points=4,
        direct=direct,
        residual=not direct,
        supports=[Fixed([0], 2, move)],
    )
    steps = [ct.Frequency(modes=8, supports=[Fixed([0], 2)]), steady]
    frames = [f for f in ct.solve(model, steps).frames if f.step == 2]
    assert len(frames) >= 4
    for frame in frames:
        w = 2 * math.pi * frame.scalars["frequency"]
        b = math.sqrt(w)
        s, c, sh, ch = math.sin(b), math.cos(b), math.sinh(b), math.cosh(b)
        # A cos + B sin + C cosh + D sinh; w(0)=0, w'(0)=move, w''(1)=0, w'''(1)=0
        a = np.array([[1, 0, 1, 0], [0, b, 0, b], [-c, -s, ch, sh], [s, -c, sh, ch]], float)
        x = np.linalg.solve(a, [0.0, move, 0.0, 0.0])
        tip = x @ [c, s, ch, sh]
        np.testing.assert_allclose(frame.U[n, 1], tip, rtol=5e-3, atol=1e-6)
        moment = -(x[2] - x[0]) * b**2  # of the support on the beam: -EI w''(0)
        np.testing.assert_allclose(frame.RF[0, 2], moment, rtol=1e-2, atol=5e-5)


def test_harmonic_response_about_a_spinning_state():
    # Particle on four springs in a turning frame, without Coriolis forces named: (K - W^2 - w^2).
    spin = 2.0
    model = beam(16)
    model.fix([0], rotation=True)
    model.centrifugal(spin)
    steady = ct.SteadyState(lowest=0.8, highest=1.2, points=3, direct=True)
    steady.force([16], y=1e-3)
    steps = [ct.Static(), steady]
    results = ct.solve(model, steps)
    frames = [f for f in results.frames if f.step == 2]
    squares, shapes = ritz_harmonic(spin)
    for frame in frames:
        w = 2 * math.pi * frame.scalars["frequency"]
        exact = (shapes**2 / (squares - w**2)).sum() * 1e-3
        np.testing.assert_allclose(frame.U[16, 1], exact, rtol=5e-3)


def ritz_harmonic(spin, n=9):
    basis = [Polynomial([0.0] * (i + 2) + [1.0]) for i in range(n)]
    x = Polynomial([0.0, 1.0])
    pull = 0.5 * (1 - x * x)
    k, m = np.zeros((n, n)), np.zeros((n, n))
    for i, a in enumerate(basis):
        for j, b in enumerate(basis):
            m[i, j] = (a * b).integ()(1.0)
            k[i, j] = (a.deriv(2) * b.deriv(2)).integ()(1.0)
            k[i, j] += spin**2 * ((pull * a.deriv() * b.deriv()).integ()(1.0) - m[i, j])
    squares, vectors = linalg.eigh(k, m)
    return squares, vectors.sum(axis=0)

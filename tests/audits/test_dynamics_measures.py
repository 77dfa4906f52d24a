"""Motion of a mass on a stretched block: strains, laws, schemes, steps and outputs in combination.

The block has length 1, area 1 and no Poisson effect (or is incompressible): its force N(u) under
each local strain is a closed form. The mass hangs on its right edge. It is so low that the motion
across has no inertia.
"""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import corota as ct
from support.pairs import cover, quickly

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")
E, MASS, LIGHT, HEIGHT = 100.0, 4.0, 1e-12, 0.005
CELLS = {"T3": "tri3", "Q4": "quad4", "Q4I": "quad4", "Q8": "quad8", "Q4D": "quad4"}
STRAINS = ["linear", "logarithmic", "green_lagrange"]
SCHEMES = ["hht", "newmark", "bossak", "generalized_alpha"]


def force(strain, u):
    """Force of the block stretched by u: derivative of its energy."""
    s = 1.0 + u
    return {
        "linear": E * u,
        "logarithmic": E * math.log(s) / s,
        "green_lagrange": E * 0.5 * (s * s - 1.0) * s,
    }[strain]


def stiffness(strain, u):
    s = 1.0 + u
    return {
        "linear": E,
        "logarithmic": E * (1.0 - math.log(s)) / s**2,
        "green_lagrange": E * 0.5 * (3.0 * s * s - 1.0),
    }[strain]


def exact(element, strain, *_):
    """The frame of a triangle turns a little under a stretch, which the linear strain feels."""
    return (element, strain) != ("T3", "linear")


def block(element, strain=None, material=None):
    """The block with half of the mass at either corner of its right edge."""
    mesh = ct.mesh.rectangle(1.0, HEIGHT, nx=1, ny=1, cell=CELLS[element])
    model = ct.Model(mesh)
    options = {} if strain is None else {"local_strain": strain}
    material = material or ct.Elastic(E=E, nu=0.0, rho=LIGHT)
    model.section("all", element=element, material=material, thickness=1.0 / HEIGHT, **options)
    model.fix("left", x=0.0, y=None)
    model.fix("bottom", x=None, y=0.0)
    if element == "Q4D":
        model.fix(range(4), x=None, y=None, rotation=0.0)
    ends = [i for i, (x, _) in enumerate(mesh.points) if x == 1.0]
    for node, share in shares(mesh, ends):
        model.point_mass([node], share * MASS)
    return model, ends


#: Weights am and af of each scheme with its default dissipation (Arnold and Bruels 2007).
FILTERS = {
    "hht": (0.0, 0.05),
    "newmark": (0.0, 0.0),
    "bossak": (-0.05, 0.0),
    "generalized_alpha": (0.6 / 1.8, 0.8 / 1.8),
}


def shares(mesh, ends):
    """Nodes of the edge with their shares of a uniform load."""
    middle = {0.5: 2.0 / 3.0, 0.0: 1.0 / 6.0, 1.0: 1.0 / 6.0}
    return [(i, middle[mesh.points[i][1] / HEIGHT] if len(ends) == 3 else 0.5) for i in ends]


def pull(target, model, ends, size):
    for node, share in shares(model.mesh, ends):
        target.force([node], x=share * size)


@pytest.mark.parametrize(
    ("element", "strain", "scheme"),
    cover(list(CELLS), STRAINS, SCHEMES, allowed=exact),
)
def test_one_large_increment_solves_the_equation_of_its_scheme(element, strain, scheme):
    # a = (F - N(u))/m at both ends, filtered by am and af (Arnold and Bruels 2007); u by Newmark.
    am, af = FILTERS[scheme]
    gamma = 0.5 - am + af
    beta = 0.25 * (1.0 - am + af) ** 2
    dt, load, v0 = 0.25, 30.0, 0.8
    a0 = load / MASS

    def filtered(a1):
        return ((1.0 - af) * a1 + af * a0 - am * a0) / (1.0 - am)

    def moved(a1):
        return dt * v0 + dt * dt * ((0.5 - beta) * a0 + beta * filtered(a1))

    def residual(a1):
        return MASS * a1 + force(strain, moved(a1)) - load

    a1 = brentq(residual, -50.0, 50.0, xtol=1e-14)
    model, ends = block(element, strain)
    model.velocity(ends, x=v0)
    pull(model, model, ends, load)
    frame = ct.solve(model, ct.Dynamic(period=dt, increments=1, scheme=scheme), threads=1).frames[
        -1
    ]
    v1 = v0 + dt * ((1.0 - gamma) * a0 + gamma * filtered(a1))
    np.testing.assert_allclose(frame.U[ends, 0], moved(a1), rtol=1e-5)
    np.testing.assert_allclose(frame.V[ends, 0], v1, rtol=1e-5)
    np.testing.assert_allclose(frame.A[ends, 0], a1, rtol=1e-4)
    assert frame.scalars["ALLKE"] == pytest.approx(0.5 * MASS * v1**2, rel=1e-5)
    assert frame.scalars["ALLWK"] == pytest.approx(load * moved(a1), rel=1e-5)
    left = model.mesh.node_sets["left"]
    assert frame.RF[left, 0].sum() == pytest.approx(-force(strain, moved(a1)), rel=1e-4)


@pytest.mark.parametrize(
    ("element", "strain"), cover(["T3", "Q4", "Q4I", "Q4D"], STRAINS, allowed=exact)
)
def test_one_large_increment_of_energy_momentum_keeps_the_energy(element, strain):
    # m v0^2/2 becomes strain energy and motion, to the tolerance of Newton's method.
    energy = {
        "linear": lambda u: 0.5 * E * u * u,
        "logarithmic": lambda u: 0.5 * E * math.log1p(u) ** 2,
        "green_lagrange": lambda u: 0.125 * E * ((1.0 + u) ** 2 - 1.0) ** 2,
    }[strain]
    model, ends = block(element, strain)
    model.velocity(ends, x=2.0)
    step = ct.Dynamic(period=0.3, increments=1, scheme="energy_momentum")
    frame = ct.solve(model, step, threads=1).frames[-1]
    u, v = frame.U[ends, 0].mean(), frame.V[ends, 0].mean()
    assert u > 0.25
    assert energy(u) + 0.5 * MASS * v * v == pytest.approx(0.5 * MASS * 4.0, rel=1e-6)
    assert frame.scalars["ALLSE"] == pytest.approx(energy(u), rel=1e-6)
    # The scheme is u = dt (v0 + v)/2.
    assert u == pytest.approx(0.3 * 0.5 * (2.0 + v), rel=1e-6)


@pytest.mark.parametrize(("element", "strain"), cover(list(CELLS), STRAINS, allowed=exact))
def test_frequency_about_a_stretch(element, strain):
    # sqrt(dN/du / m) about a static stretch by a force.
    u = 0.25
    model, ends = block(element, strain)
    static = ct.Static()
    pull(static, model, ends, force(strain, u))
    results = ct.solve(model, [static, ct.Frequency(modes=1)], threads=1)
    assert results.frames[1].U[ends[0], 0] == pytest.approx(u, rel=1e-6)
    wanted = math.sqrt(stiffness(strain, u) / MASS) / (2.0 * math.pi)
    assert results.modes[-1].factors[0] == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("strain", STRAINS)
def test_modal_step_about_a_stretch(strain):
    # The force of a node is given anew. What is more acts at once: F/k (1 - cos w t).
    u, more, t = 0.25, 0.5, 0.7
    model, ends = block("Q4", strain)
    static, modal = ct.Static(), ct.ModalDynamic(period=t, increments=50)
    pull(static, model, ends, force(strain, u))
    pull(modal, model, ends, force(strain, u) + more)
    results = ct.solve(model, [static, ct.Frequency(modes=1), modal], threads=1)
    k = stiffness(strain, u)
    w = math.sqrt(k / MASS)
    frame = results.frames[-1]
    np.testing.assert_allclose(frame.U[ends, 0], u + more / k * (1.0 - math.cos(w * t)), rtol=1e-5)
    np.testing.assert_allclose(frame.V[ends, 0], more / k * w * math.sin(w * t), rtol=1e-4)


@pytest.mark.parametrize(("strain", "direct"), cover(STRAINS, [True, False]))
def test_harmonic_step_about_a_stretch(strain, direct):
    # F / |k - m w^2| about the stretched state, where k is its tangent.
    u, more = 0.25, 0.5
    model, ends = block("Q4", strain)
    static = ct.Static()
    steady = ct.SteadyState(lowest=0.3, highest=1.5, points=4, direct=direct, bias=1.0)
    pull(static, model, ends, force(strain, u))
    pull(steady, model, ends, more)
    steps = [static, steady] if direct else [static, ct.Frequency(modes=1), steady]
    results = ct.solve(model, steps, threads=1)
    at = [i for i, frame in enumerate(results.frames) if frame.scalars.get("frequency")]
    f = results.history("frequency")[at]
    k = stiffness(strain, u)
    wanted = more / np.abs(k - MASS * (2.0 * np.pi * f) ** 2)
    found = results.history("UA1", at=ends[0])[at]
    near = np.abs(f - math.sqrt(k / MASS) / (2.0 * math.pi)) < 1e-9
    np.testing.assert_allclose(found[~near], wanted[~near], rtol=1e-4)


@pytest.mark.parametrize("element", ["Q4", "Q8", "T3"])
def test_frequency_of_stretched_rubber(element):
    # Incompressible: N = A mu (s - s^-2), mu = 2 C10.
    s, mu = 1.5, 20.0
    model, ends = block(element, material=ct.NeoHooke(C10=0.5 * mu, D1=0.0, rho=LIGHT))
    static = ct.Static()
    pull(static, model, ends, mu * (s - s**-2))
    results = ct.solve(model, [static, ct.Frequency(modes=1)], threads=1)
    assert results.frames[1].U[ends[0], 0] == pytest.approx(s - 1.0, rel=1e-5)
    wanted = math.sqrt(mu * (1.0 + 2.0 * s**-3) / MASS) / (2.0 * math.pi)
    assert results.modes[-1].factors[0] == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("scheme", quickly([*SCHEMES, "energy_momentum"], "hht", "energy_momentum"))
def test_mass_on_rubber_swings_through(scheme):
    # SciPy's integration of m u'' = F - A mu (s - s^-2).
    mu, load, t = 20.0, 15.0, 2.0
    wanted = solve_ivp(
        lambda _, z: [z[1], (load - mu * (1 + z[0] - (1 + z[0]) ** -2)) / MASS],
        (0.0, t),
        [0.0, 0.0],
        rtol=1e-10,
        atol=1e-12,
    ).y[:, -1]
    found = []
    for n in (60, 120):
        model, ends = block("Q4", material=ct.NeoHooke(C10=0.5 * mu, D1=0.0, rho=LIGHT))
        pull(model, model, ends, load)
        step = ct.Dynamic(period=t, increments=n, scheme=scheme)
        frame = ct.solve(model, step, threads=1).frames[-1]
        found.append([frame.U[ends, 0].mean(), frame.V[ends, 0].mean()])
    ends_of = np.array(found)
    errors = np.abs(ends_of - wanted).max(axis=1)
    assert errors[1] < 2e-3
    assert errors[1] < 0.35 * errors[0]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_one_large_increment_that_yields(scheme):
    # Newmark's relations with N of a bar that hardens linearly (true stress over logarithmic strain
    # is Kirchhoff's over the stretch); work = motion + energy stored + plastic work.
    sy, h, dt, v0 = 5.0, 10.0, 0.1, 2.0
    am, af = FILTERS[scheme]
    beta = 0.25 * (1.0 - am + af) ** 2

    def pulled(u):
        strain = math.log1p(u)
        tau = min(E * strain, sy + E * h / (E + h) * (strain - sy / E))
        return tau / (1.0 + u)

    def moved(a1):
        return dt * v0 + dt * dt * beta * ((1.0 - af) * a1) / (1.0 - am)

    a1 = brentq(lambda a: MASS * a + pulled(moved(a)), -50.0, 50.0, xtol=1e-14)
    u = moved(a1)
    material = ct.Mises(E=E, nu=0.0, yield_stress=sy, isotropic=h, rho=LIGHT)
    model, ends = block("Q4", "logarithmic", material)
    model.velocity(ends, x=v0)
    step = ct.Dynamic(period=dt, increments=1, scheme=scheme)
    results = ct.solve(model, step, threads=1)
    frame = results.frames[-1]
    assert frame.U[ends[0], 0] == pytest.approx(u, rel=1e-5)
    strain = math.log1p(u)
    plastic = (E * strain - sy) / (E + h)
    assert results.history("PEEQ")[-1] == pytest.approx(plastic, rel=1e-4)
    assert frame.scalars["ALLSE"] == pytest.approx(0.5 * E * (strain - plastic) ** 2, rel=1e-3)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_viscoelastic_mass_beside_an_integration(scheme):
    # m u'' + E (1 - g) u + q = 0, q' = g E u' - q/tau.
    g, tau, v0, t = 0.4, 0.3, 0.02, 2.0
    wanted = solve_ivp(
        lambda _, z: [z[1], -(E * (1 - g) * z[0] + z[2]) / MASS, g * E * z[1] - z[2] / tau],
        (0.0, t),
        [0.0, v0, 0.0],
        rtol=1e-10,
        atol=1e-14,
    ).y[:, -1]
    material = ct.Viscoelastic(ct.Elastic(E=E, nu=0.0, rho=LIGHT), terms=[(g, g, tau)])
    model, ends = block("Q4", material=material)
    model.velocity(ends, x=v0)
    frame = ct.solve(model, ct.Dynamic(period=t, increments=200, scheme=scheme), threads=1).frames[
        -1
    ]
    scale = v0 / math.sqrt(E / MASS)
    assert frame.U[ends, 0].mean() == pytest.approx(wanted[0], abs=0.02 * scale)
    assert frame.V[ends, 0].mean() == pytest.approx(wanted[1], abs=0.02 * v0)


@pytest.mark.parametrize("element", ["Q4", "Q8"])
def test_ring_under_a_sudden_pressure_breathes(element):
    # Thin ring: p r^2/(E t) (1 - cos w t), w = sqrt(E/rho)/r; the largest is twice the static one.
    r, t, p, e, rho = 100.0, 1.0, 0.01, 2000.0, 1e-3
    start = (r - 0.5 * t, 0.0)
    mesh = ct.mesh.rectangle(t, 1.0, nx=1, ny=1, cell=CELLS[element], origin=start)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Elastic(E=e, nu=0.0, rho=rho), plane="axisymmetric"
    )
    model.fix("bottom", x=None, y=0.0)
    model.pressure("left", p)
    w = math.sqrt(e / rho) / r
    end = math.pi / w
    frame = ct.solve(model, ct.Dynamic(period=end, increments=100), threads=1).frames[-1]
    inner = r - 0.5 * t
    wanted = 2.0 * p * inner * r / (e * t)
    assert frame.U[:, 0].mean() == pytest.approx(wanted, rel=5e-3)


@pytest.mark.parametrize("scheme", [*SCHEMES, "energy_momentum"])
@pytest.mark.parametrize("element", ["Q4D", "Q8"])
def test_released_cantilever_keeps_the_energy_of_its_deflection(element, scheme):
    # Static tip force, removed at once: F u/2 is all the energy of the motion.
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1, cell=CELLS[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.fix("left", rotation=True) if element == "Q4D" else model.fix("left")
    tip = [i for i, (x, y) in enumerate(mesh.points) if x == 10.0]
    static = ct.Static()
    static.force(tip, y=0.3 / len(tip))
    move = ct.Dynamic(period=1.8, increments=60, scheme=scheme)
    move.force(tip, y=0.0)
    results = ct.solve(model, [static, move], threads=1)
    first = [f for f in results.frames if f.step == 1][-1]
    stored = results.history("ALLSE") + results.history("ALLAE")
    motion = results.history("ALLKE")
    steps = np.array([f.step for f in results.frames])
    start = stored[np.flatnonzero(steps == 1)[-1]]
    work = 0.5 * float((first.U[tip, 1] * 0.3 / len(tip)).sum())
    assert start == pytest.approx(work, rel=5e-3)
    lost = 0.02 if scheme in ("hht", "bossak", "generalized_alpha") else 2e-3
    total = (stored + motion)[steps == 2]
    np.testing.assert_allclose(total, start, rtol=lost)
    assert motion.max() > 0.5 * start

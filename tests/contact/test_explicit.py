"""Contact in central differences: impacts, friction, momenta, energies, what is refused.

Closed forms: a bar that strikes a wall presses with rho c A v for the time 2 L / c and leaves as
it came; equal bars exchange their velocities; a sliding block stops after v^2 / (2 mu g); a wall
that moves sends a bar off at twice its speed; a rigid mass on a soft law turns round after half
a period of its spring.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools

import numpy as np
import pytest

import corota as ct
from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.equations import System
from corota.analysis.linear.solvers import make_solver
from corota.analysis.procedures.explicit import diagonal
from corota.analysis.terms.contact.motion import UnilateralConstraints
from tests.support.models import cell
from tests.support.pairs import quickly

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")

E = 1e4
SPEED_OF_SOUND = 100.0
LENGTH, HEIGHT = 10.0, 0.1
METHODS = ["mortar", "node_to_segment"]


def run(model, period, **keys):
    keys = {"scheme": "central_difference", "period": period, **keys}
    return ct.solve(model, ct.Dynamic(**keys), threads=1)


def lumped(model):
    """Masses and rotary inertias by node, shape (n_nodes, 3)."""
    system = System(model, make_solver("multifrontal"), 1)
    out = np.zeros((len(system.per_node), 3))
    out[system.node_of_dof, system.component] = diagonal(system)
    return out


def momenta(model, mass, frame, where="all"):
    """Linear and angular momentum of some nodes, shape (3,)."""
    nodes = np.arange(model.mesh.n_nodes) if where == "all" else model.mesh.nodes_of(where)
    m, v = mass[nodes], frame.V[nodes]
    x = model.mesh.points[nodes] + frame.U[nodes, :2]
    spin = (m[:, 0] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()
    spin += (m[:, 2:] * v[:, 2:]).sum()
    return np.array([*(m[:, :2] * v[:, :2]).sum(axis=0), spin])


def forces(results, name="hit: force x"):
    """Times and forces of all frames; every increment is one."""
    return (
        np.array([f.time for f in results.frames]),
        np.array([f.scalars[name] for f in results.frames]),
    )


def elastic(model, element, nu=0.0):
    model.section("all", element=element, material=ct.Elastic(E=E, nu=nu, rho=1.0))
    return model


def bar(element="Q4I", method="mortar", cells=60, ratio=1.0, unit=1.0):
    """A bar that flies against a wall at the left, which it reaches after 0.01."""
    mesh = ct.mesh.rectangle(LENGTH * unit, HEIGHT * unit, cells, 1, cell=cell(element))
    model = ct.Model(mesh)
    material = ct.Elastic(E=E / unit, nu=0.0, rho=1.0 / unit**3)
    model.section("all", element=element, material=material, thickness=unit)
    model.velocity(x=-unit)
    wall = ct.RigidCurve.line((-0.01 * unit, unit), (-0.01 * unit, -unit))
    model.contact("left", wall, name="hit", method=method)
    return model


FLIGHT = 0.01 + 1.3 * 2.0 * LENGTH / SPEED_OF_SOUND


@pytest.mark.parametrize(
    ("element", "method"),
    [
        *((e, "mortar") for e in ("T3", "Q4I", "Q8R", "OPT")),
        *((e, "node_to_segment") for e in ("Q4D", "T6")),
        *(pytest.param(e, "mortar", marks=pytest.mark.slow) for e in ("Q4", "Q4D", "Q8", "T6")),
        *(pytest.param(e, "node_to_segment", marks=pytest.mark.slow) for e in ("Q4I", "OPT", "Q8")),
    ],
)
def test_bar_strikes_a_wall(element, method):
    model = bar(element, method, cells=24)
    results = run(model, FLIGHT)
    time, force = forces(results)
    pressed = time[force > 0.0]
    dt = results.frames[-1].scalars["dt"]
    # It leaves once; on the waves of the first blow and of the last it may come off for an instant.
    within = (time - pressed[0]) / (pressed[-1] - pressed[0])
    assert (force[(within > 0.05) & (within < 0.95)] > 0.0).all()
    middle = force[(within > 0.1) & (within < 0.9)]
    assert middle.mean() == pytest.approx(SPEED_OF_SOUND * HEIGHT, rel=0.02)
    assert pressed[0] == pytest.approx(0.01, abs=2.0 * dt)
    assert pressed[-1] - pressed[0] == pytest.approx(2.0 * LENGTH / SPEED_OF_SOUND, rel=0.02)
    mass = lumped(model)
    first, last = (momenta(model, mass, results.frames[k]) for k in (0, -1))
    assert last[0] == pytest.approx(-first[0], rel=0.04)
    if len(time) == results.frames[-1].increment + 1:
        # What the wall gives is what the bar gains, to rounding.
        given = (results.frames[1].time - results.frames[0].time) * force.sum()
        assert last[0] - first[0] == pytest.approx(given, rel=1e-11)


def test_what_impacts_take_falls_with_the_mesh():
    """The mass of the end stops at once: its share of the bar is of the order of an edge."""
    lost = [-run(bar(cells=n), FLIGHT).frames[-1].scalars["ALLPW"] for n in (10, 20, 40)]
    assert lost[0] > 1.7 * lost[1] > 2.9 * lost[2] > 0.0


def test_impact_in_another_unit():
    """Forces and motion are the same in a unit of a thousandth."""
    a, b = run(bar(cells=20), FLIGHT), run(bar(cells=20, unit=1000.0), FLIGHT)
    assert len(a.frames) == len(b.frames)
    for one, other in zip(a.frames, b.frames, strict=True):
        assert np.abs(other.U[:, :2] - 1000.0 * one.U[:, :2]).max() <= 1e-9 * 1000.0
    assert forces(b)[1] == pytest.approx(1000.0 * forces(a)[1], rel=1e-8, abs=1e-6)


def two_bars(method, shift=0.0, friction=0.0, law=None, element="Q4I", ny=(2, 3)):
    first = ct.mesh.rectangle(10.0, 1.0, 40, ny[0], cell=cell(element))
    second = ct.mesh.rectangle(10.0, 1.0, 40, ny[1], origin=(10.05, shift), cell=cell(element))
    model = elastic(ct.Model(ct.mesh.assembly(a=first, b=second)), element)
    model.velocity("a", x=1.0)
    model.contact("a.right", "b.left", name="hit", method=method, friction=friction, law=law)
    return model


@pytest.mark.parametrize("method", METHODS)
def test_equal_bars_exchange_their_velocities(method):
    model = two_bars(method)
    results = run(model, 0.29)
    mass = lumped(model)
    last = results.frames[-1]
    assert momenta(model, mass, last, "a")[0] == pytest.approx(0.0, abs=0.12)
    assert momenta(model, mass, last, "b")[0] == pytest.approx(10.0, abs=0.12)
    energy = results.frames[0].scalars["ALLKE"]
    assert last.scalars["ALLKE"] > 0.98 * energy
    assert abs(last.scalars["energy balance error"]) < 3e-3


@pytest.mark.parametrize(
    ("element", "method"),
    [("T3", "mortar"), ("OPT", "mortar"), ("Q8", "node_to_segment"), ("Q4D", "node_to_segment")],
)
def test_bodies_that_meet_keep_linear_and_angular_momentum(method, element):
    """To rounding, with friction and drilling rotations, though the bodies turn."""
    model = two_bars(method, shift=0.37, friction=0.3, element=element, ny=(1, 2))
    results = run(model, 0.1)
    mass = lumped(model)
    first = momenta(model, mass, results.frames[0])
    for frame in results.frames[1:]:
        assert np.abs(momenta(model, mass, frame) - first).max() < 1e-12 * np.abs(first).max()
    assert results.frames[-1].scalars["ALLFD"] > 0.0
    assert max(f.scalars["hit: force x"] for f in results.frames) == pytest.approx(0.0, abs=1e-9)
    assert min(f.scalars["hit: force x"] for f in results.frames) < -10.0


def test_two_bars_on_a_soft_law_and_a_stiff_one():
    """Soft: the law gives back what it stores; stiff: as without a law, at the same increment."""
    soft = run(two_bars("mortar", law=ct.PressureLaw("linear", 1e3)), 0.4)
    energy = soft.frames[0].scalars["ALLKE"]
    assert max(f.scalars["ALLCL"] for f in soft.frames) > 0.2 * energy
    assert abs(soft.frames[-1].scalars["ALLPW"]) < 5e-3 * energy
    stiff = run(two_bars("mortar", law=ct.PressureLaw("linear", 1e9)), 0.29)
    hard = run(two_bars("mortar"), 0.29)
    assert stiff.frames[-1].scalars["dt"] == hard.frames[-1].scalars["dt"]
    speed = np.abs(hard.frames[-1].V).max()
    assert np.abs(stiff.frames[-1].V - hard.frames[-1].V).max() < 0.05 * speed


def test_mass_on_a_soft_law_turns_round_after_half_a_period():
    """t = pi sqrt(m / (k A)), and it leaves as fast as it came."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 4, 2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.velocity(y=-1.0)
    law = ct.PressureLaw("linear", 400.0)
    model.contact("bottom", ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0)), name="hit", law=law)
    results = run(model, 0.2)
    time, force = forces(results, "hit: force y")
    half = np.pi * np.sqrt(1.0 / 400.0)
    assert time[force > 0.0][-1] == pytest.approx(half, rel=0.01)
    assert results.frames[-1].V[:, 1].mean() == pytest.approx(1.0, rel=0.01)
    assert force.max() == pytest.approx(2.0 * np.sqrt(400.0), rel=0.02)


@pytest.mark.parametrize(
    ("element", "method"),
    quickly(
        [("T3", "mortar"), ("Q4I", "node_to_segment"), ("OPT", "mortar")],
        ("T3", "mortar"),
        ("Q4I", "node_to_segment"),
    ),
)
def test_sliding_block_stops(element, method):
    speed, friction, gravity = 2.0, 0.3, 10.0
    mesh = ct.mesh.rectangle(2.0, 1.0, 6, 3, cell=cell(element))
    model = elastic(ct.Model(mesh), element, nu=0.3)
    model.gravity(y=-gravity)
    floor = ct.RigidCurve.line((-5.0, 0.0), (20.0, 0.0))
    model.contact("bottom", floor, friction=friction, name="hit", method=method)
    model.velocity(x=speed)
    results = run(model, 0.75)
    way = speed**2 / (2.0 * friction * gravity)
    # Gravity that acts at once lets the block hop on its own waves.
    assert results.frames[-1].U[:, 0].mean() == pytest.approx(way, rel=0.03)
    last = results.frames[-1].scalars
    assert last["ALLFD"] == pytest.approx(0.5 * 2.0 * speed**2, rel=0.04)
    assert last["ALLKE"] < 0.01 * last["ALLFD"]
    worn = [f.scalars["ALLFD"] for f in results.frames]
    assert np.diff(worn).min() >= 0.0
    assert abs(last["energy balance error"]) < 2e-3


def test_block_rests_after_a_static_step():
    """Weight, then motion at nearly the stable increment: nothing moves, the force stays."""
    model = elastic(ct.Model(ct.mesh.rectangle(2.0, 1.0, 6, 3)), "Q4I")
    model.gravity(y=-10.0)
    model.fix("left", y=None)
    floor = ct.RigidCurve.line((-5.0, 0.0), (20.0, 0.0))
    model.contact("bottom", floor, name="hit", friction=0.2)
    motion = ct.Dynamic(period=1.0, scheme="central_difference")
    results = ct.solve(model, [ct.Static(), motion], threads=1)
    before, behind = ([f for f in results.frames if f.step == k] for k in (1, 2))
    rest = before[-1].U
    for frame in behind:
        assert np.abs(frame.U - rest).max() < 1e-8 * np.abs(rest).max()
        assert frame.scalars["hit: force y"] == pytest.approx(20.0, rel=1e-6)
        assert -frame.RF[:, 1].sum() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.3])
def test_spinning_ring_on_a_floor(friction):
    """While it slides, the impulse along the floor is mu times that across.

    The moment of the floor is what the ring gains in angular momentum.
    """
    middle = (0.0, 1.01)
    mesh = ct.mesh.annulus(0.6, 1.0, 2, 36, center=middle)
    model = elastic(ct.Model(mesh), "Q4I", nu=0.3)
    model.velocity("all", y=-1.0, spin=-3.0, about=middle)
    floor = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
    model.contact("outer", floor, friction=friction, name="hit", method="node_to_segment")
    results = run(model, 0.15)
    mass = lumped(model)
    first, last = (momenta(model, mass, results.frames[k]) for k in (0, -1))
    assert last[0] == pytest.approx(friction * (last[1] - first[1]), rel=1e-11, abs=1e-11)
    time, moment = forces(results, "hit: moment")
    assert len(time) == results.frames[-1].increment + 1
    assert last[2] - first[2] == pytest.approx(time[1] * moment.sum(), rel=1e-10)
    assert abs(results.frames[-1].scalars["energy balance error"]) < 1e-3


@pytest.mark.slow
def test_ring_beside_the_implicit_scheme_with_small_increments():
    """The same rebound as energy-momentum on the same masses."""
    model = ct.Model(ct.mesh.annulus(0.8, 1.0, 2, 48, center=(0.0, 1.0)))
    elastic(model, "Q4I", nu=0.3)
    model.velocity(y=-1.0)
    floor = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
    model.contact("outer", floor, name="hit")
    mass = lumped(model)
    ends = []
    same = {"increments": 500, "mass": "lumped", "redistribute": False}
    for scheme, more in (("central_difference", {}), ("energy_momentum", same)):
        results = run(model, 0.25, scheme=scheme, **more)
        last = results.frames[-1]
        ends.append((momenta(model, mass, last)[1] / mass[:, 1].sum(), last.U[:, 1].mean()))
    assert ends[0][0] == pytest.approx(ends[1][0], rel=0.015)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=3e-4)


def test_wall_that_moves_sends_a_bar_off_at_twice_its_speed():
    """And does the work 2 m v^2 on it, with the force rho c A v."""
    mesh = ct.mesh.assembly(a=ct.mesh.rectangle(LENGTH, 1.0, 60, 1))
    node = ct.mesh.add_node(mesh, -0.5, 0.5)
    model = elastic(ct.Model(mesh), "Q4I")
    wall = ct.RigidCurve.line((-0.01, 3.0), (-0.01, -3.0), reference=node)
    model.contact("a.left", wall, name="hit")
    model.amplitudes["even"] = ct.Amplitude(np.array([0.0, 0.26]), np.array([0.0, 1.0]))
    model.fix([node], x=0.26, y=0.0, rotation=0.0, amplitude="even")
    results = run(model, 0.26)
    mass, last = lumped(model), results.frames[-1]
    assert momenta(model, mass, last, "a")[0] == pytest.approx(20.0, rel=0.015)
    assert last.scalars["ALLWK"] == pytest.approx(20.0, rel=0.015)
    assert abs(last.scalars["energy balance error"]) < 2e-3
    _, force = forces(results)
    assert np.median(force[force > 0.0]) == pytest.approx(SPEED_OF_SOUND, rel=0.02)
    for frame in results.frames:
        assert frame.RF[node, 0] == pytest.approx(frame.scalars["hit: force x"], abs=1e-9)


def test_free_rigid_body_takes_part_in_the_momenta():
    mesh = ct.mesh.assembly(a=ct.mesh.rectangle(5.0, 1.0, 20, 4))
    node = ct.mesh.add_node(mesh, 5.5, 0.2)
    model = elastic(ct.Model(mesh), "Q4I")
    model.velocity("a", x=1.0)
    disc = ct.RigidCurve.circle((5.5, 0.2), 0.45, reference=node)
    model.contact("a.right", disc, name="hit", friction=0.3, method="node_to_segment")
    model.point_mass([node], 10.0)
    with pytest.raises(ct.ModelError, match=r"rotation has a contact force on it but no mass"):
        run(model, 0.3)
    model.point_masses.clear()
    model.point_mass([node], 10.0, inertia=2.0)
    results = run(model, 0.3)
    mass = lumped(model)
    first, last = (momenta(model, mass, results.frames[k]) for k in (0, -1))
    assert np.abs(last - first).max() < 1e-12 * np.abs(first).max()
    assert results.frames[-1].V[node, 0] > 0.3
    assert abs(results.frames[-1].V[node, 2]) > 0.05


@pytest.mark.parametrize("ny", [4, 3])
def test_tied_halves_move_as_one(ny):
    """Of matching and of other meshes, without work of the tie."""
    halves = ct.mesh.assembly(
        a=ct.mesh.rectangle(5.0, 1.0, 20, 4),
        b=ct.mesh.rectangle(5.0, 1.0, 20, ny, origin=(5.0, 0.0)),
    )
    tied = elastic(ct.Model(halves), "Q4I", nu=0.3)
    tied.tie("a.right", "b.left")
    tied.fix("a.left")
    tied.force("b.right", y=-2.0)
    whole = elastic(ct.Model(ct.mesh.rectangle(10.0, 1.0, 40, 4)), "Q4I", nu=0.3)
    whole.fix("left")
    whole.force("right", y=-2.0)
    a, b = (run(model, 0.3).frames[-1] for model in (tied, whole))
    assert a.U[:, 1].min() == pytest.approx(b.U[:, 1].min(), rel=2e-3 if ny == 3 else 2e-4)
    assert abs(a.scalars["ALLPW"]) < 1e-8 * a.scalars["ALLWK"]


def test_inner_walls_of_a_crushed_ring_meet():
    model = ct.Model(ct.mesh.annulus(0.85, 1.0, 2, 48, center=(0.0, 1.01)))
    material = ct.Elastic(E=E, nu=0.3, rho=1.0)
    model.section("all", element="Q4I", material=material, local_strain="logarithmic")
    model.velocity("all", y=-14.0)
    model.contact("outer", ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0)), name="floor")
    model.contact("inner", "inner", name="inside", friction=0.2)
    results = run(model, 0.25)
    met = [f for f in results.frames[1:] if f.pairs["inside"][:, 0].max() > 0.0]
    assert met
    edge = 2.0 * np.pi * 0.85 / 48
    assert min(f.pairs["inside"][:, 2].min() for f in results.frames[1:]) > -0.02 * edge
    assert abs(results.frames[-1].scalars["energy balance error"]) < 0.02


# -- starts, refusals ----------------------------------------------------------------


def overlapping(**keys):
    model = elastic(ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2)), "Q4I")
    model.fix("top", x=0.0, y=0.0)
    floor = ct.RigidCurve.line((-5.0, 0.01), (20.0, 0.01))
    model.contact("bottom", floor, name="hit", **keys)
    return model


def test_overlap_of_the_start_is_not_shot_out():
    results = run(overlapping(), 0.1)
    assert any("remains until the contact opens" in note for note in results.notes)
    assert max(f.scalars["ALLKE"] for f in results.frames) < 1e-20
    ramped = run(overlapping(start="ramp"), 2.0).frames[-1]
    bottom = ramped.U[[0, 1, 2, 3, 4], 1]
    assert bottom == pytest.approx(0.01, rel=1e-6)
    assert ramped.scalars["hit: force y"] == pytest.approx(E * 0.01 * 2.0, rel=0.1)


def test_held_surfaces_that_are_pressed_together_are_named():
    model = elastic(ct.Model(ct.mesh.rectangle(2.0, 1.0, 4, 2)), "Q4I")
    model.fix("bottom", x=0.0, y=-0.5)
    model.contact("bottom", ct.RigidCurve.line((-5.0, -0.01), (20.0, -0.01)), name="hit")
    with pytest.raises(ct.ConvergenceError, match=r"'hit': node \d+ is fixed and pressed into"):
        run(model, 0.1)


# -- the set of what is closed --------------------------------------------------------


def without_law(m):
    return np.zeros(m, bool), lambda gap: (np.zeros(m), np.zeros(m))


def random_constraints(rng, m, tangents, friction):
    of = np.arange(m)[:tangents]
    g = rng.standard_normal((m + tangents, 2 * m + 3))
    return UnilateralConstraints(
        g @ g.T,
        rng.standard_normal(m),
        rng.standard_normal(tangents),
        of,
        np.full(tangents, friction),
        np.zeros(m, bool),
        np.full(m, 1e-12),
        np.zeros(m),
        np.ones(m),
        *without_law(m),
    )


def holds(problem, z):
    """Whether forces, gaps and slips satisfy Signorini, Coulomb, ties and laws."""
    m, of, tied = len(problem.gap), problem.of, problem.tied
    moved = problem.matrix @ z
    gap, slip = problem.gap + moved[:m], problem.slip + moved[m:]
    p, q = z[:m], z[m:]
    hard = ~tied & ~problem.ruled
    good = [p[~tied] >= 0.0, gap[hard] >= -1e-7, np.abs(p * gap)[hard] < 1e-7]
    bound, sliding = problem.friction * p[of], np.abs(slip) > 1e-7
    good.append(tied[of] | (np.abs(q) <= bound + 1e-9))
    good.append(tied[of] | ~sliding | (np.abs(q + np.sign(slip) * bound) < 1e-7))
    good += [np.abs(gap[tied]) < 1e-7, ~sliding[tied[of]]]
    pressure, _ = problem.law(problem.soft + problem.share * moved[:m])
    good.append(np.abs(p - pressure)[problem.ruled] < 1e-7)
    return all(np.all(g) for g in good)


@pytest.mark.parametrize("start", [OPEN, CLOSED, SLIPPING])
def test_forces_fulfil_signorini_and_coulomb_from_every_state(start):
    rng = np.random.default_rng(1)
    for m, tangents in [(1, 0), (1, 1), (3, 0), (4, 4), (8, 5), (12, 12)]:
        for _ in range(20):
            problem = random_constraints(rng, m, tangents, 0.3)
            states = np.full(m, start if tangents == m else min(start, CLOSED), np.int8)
            found = problem.solve(states, np.ones(tangents))
            assert found is not None
            assert holds(problem, found[0])


def test_ties_and_laws_beside_unilateral_constraints_hold():
    rng = np.random.default_rng(3)
    for _ in range(20):
        problem = random_constraints(rng, 8, 5, 0.3)
        problem.tied[:2] = True
        problem.soft, problem.share = problem.gap, np.full(8, 0.5)
        stiff = rng.uniform(0.5, 2.0)

        def law(gap, stiff=stiff):
            deep = np.where(np.arange(8) < 5, 0.0, np.maximum(0.1 - gap, 0.0))
            return stiff * deep * (1.0 + deep), -stiff * (1.0 + 2.0 * deep) * (deep > 0.0)

        problem.ruled[5:], problem.law = True, law
        found = problem.solve(np.full(8, OPEN, np.int8), np.ones(5))
        assert found is not None
        assert holds(problem, found[0])
        again = problem.solve(*found[1:])
        assert again is not None
        assert np.allclose(again[0], found[0], rtol=1e-9, atol=1e-12)


def test_frictionless_forces_are_those_of_every_set_tried():
    rng = np.random.default_rng(2)
    for _ in range(20):
        problem = random_constraints(rng, 4, 0, 0.0)
        z = problem.solve(np.full(4, CLOSED, np.int8), np.ones(0))[0]
        for closed in itertools.product([False, True], repeat=4):
            rows = np.flatnonzero(closed)
            p = np.zeros(4)
            p[rows] = np.linalg.solve(problem.matrix[np.ix_(rows, rows)], -problem.gap[rows])
            if (p >= 0.0).all() and (problem.gap + problem.matrix @ p >= -1e-12).all():
                assert np.allclose(z, p, rtol=1e-6, atol=1e-9)
                break
        else:
            raise AssertionError


def test_dependent_constraints_share_their_force():
    """Two equal rows: their sum is what one would have."""
    problem = UnilateralConstraints(
        np.ones((2, 2)),
        np.array([-1.0, -1.0]),
        np.zeros(0),
        np.zeros(0, np.int64),
        np.zeros(0),
        np.zeros(2, bool),
        np.full(2, 1e-12),
        np.zeros(2),
        np.ones(2),
        *without_law(2),
    )
    z, state, _ = problem.solve(np.full(2, OPEN, np.int8), np.ones(0))
    assert z.sum() == pytest.approx(1.0, rel=1e-8)
    assert (z >= 0.0).all()
    assert SLIPPING not in state

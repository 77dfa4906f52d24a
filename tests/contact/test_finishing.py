# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems that stopped with the defaults run to their end, in balance.

They are a sample of ``python -m benchmarks contact_torture``; each of these stopped before states
were chosen from the whole linearized problem. Reactions and contact forces must balance.
"""

from types import SimpleNamespace

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.contact_torture import run
from benchmarks.corpora.contact_problems import problem
from corota.analysis.equations import System
from corota.analysis.failure import ElementFailure
from corota.analysis.linear import saddle_point
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.newton import Settings
from corota.analysis.procedures.stopping import unstable
from corota.analysis.rule import REST
from corota.analysis.terms.contact.relaxation import relax
from corota.results.observer import BaseObserver

#: Numbers of the torture set that stopped before.
STOPPED = (7, 10, 16)
#: And numbers that stopped for a cause of their own: a stabilized body whose damping the first
#: correction lacked, a rib seen through the body from behind, an overlap pushed out at once, a
#: flat punch whose round ends press on facets of which one node lies on the flat.
CAUSES = (36, 41, 69, 15)


#: Left end, height and elements of blocks on each other.
STACK = ((-0.1087, 0.3943186160, 4), (0.0161, 0.2475914511, 3), (0.0349, 0.3147265696, 4))


@pytest.mark.parametrize("number", STOPPED + CAUSES)
def test_what_stopped_finishes(number):
    row = run(number, limit=60)
    assert row["end"] == "done", row["why"]
    assert row["residual"] < 1e-6
    assert row["balance"] < 1e-8


def test_the_log_says_where_states_came_from_pivoting():
    notes = []

    class Log(BaseObserver):
        def iteration(self, info):
            notes.append(info.note)

    given = problem(906, size=0.5)
    ct.solve(given.model, given.steps, observers=[Log()], threads=1)
    assert "contact states by pivoting" in notes


@pytest.mark.slow
def test_a_hook_that_snaps_is_relaxed_to_rest_and_said():
    given = problem(94, size=0.5)
    results = ct.solve(given.model, given.steps, threads=1)
    assert results.times[-1] == pytest.approx(sum(step.period for step in given.steps))
    said = [note for note in results.notes if "moved on to another" in note]
    assert said
    assert "Dynamic follows the motion" in said[0]


def test_a_body_that_only_friction_will_hold_finds_its_first_equilibrium():
    # Round on plane: at the start the weighted gaps are open and nothing holds the ring.
    row = run(235, limit=60, size=0.5)
    assert row["end"] == "done", row["why"]
    assert row["balance"] < 1e-8
    given = problem(235, size=0.5)
    frames = ct.solve(given.model, given.steps, threads=1).frames[1:]
    force = [abs(frame.scalars["floor: force y"]) for frame in frames]
    # As long as the ring floats, all forces are rounding.
    held = [f for f, size in zip(frames, force, strict=True) if size > 1e-6 * max(force)]
    assert len(held) > 10
    assert max(frame.scalars["residual"] for frame in held) < 1e-8


@pytest.mark.parametrize("scale", [1.0, 1e3, 33.0])
def test_a_stack_that_only_contact_holds_finds_its_first_equilibrium(scale):
    # At a scale of 1000, rounding opens some of the joints; every body is free at the start.
    bodies, y = {}, 0.0
    for i, (x, high, n) in enumerate(
        [(-0.1087, 0.3943186, 4), (0.0161, 0.2476, 3), (0.035, 0.3147, 4)]
    ):
        bodies[f"b{i}"] = ct.mesh.rectangle(1.0, high, n, 1, origin=(x, y))
        y += high
    model = ct.Model(ct.mesh.move(ct.mesh.assembly(**bodies), scale=scale))
    material = ct.Elastic(E=1e3, nu=0.3, rho=1.0 / scale)
    model.section(
        "all", element="Q4I", material=material, plane="strain", local_strain="logarithmic"
    )
    floor = ct.RigidCurve.line((-3.0 * scale, 0.0), (4.0 * scale, 0.0))
    model.contact("b0.bottom", floor, friction=0.2, name="floor")
    for i in (1, 2):
        model.contact(f"b{i}.bottom", f"b{i - 1}.top", friction=0.2, name=f"joint{i}")
    model.gravity(x=1.2, y=-10.0)
    results = ct.solve(model, ct.Static(), threads=1)
    weight = 10.0 * scale * y
    assert results.history("floor: force y").values[-1] == pytest.approx(weight)
    assert results.history("floor: force x").values[-1] == pytest.approx(-0.12 * weight)


def test_a_ring_that_yields_is_found_between_the_gap_and_the_first_collapse():
    # With mortar contact the facets leave a gap of .01. No contact closes in the third increment
    # tried, and the fourth, three times as long, finds no equilibrium.
    mesh = ct.mesh.annulus(0.75, 1.0, 2, 24)
    plate = ct.mesh.add_node(mesh, 0.0, 1.0, "plate")
    model = ct.Model(mesh)
    metal = ct.Mises(E=1e3, nu=0.3, yield_stress=2.0, isotropic=10.0)
    model.section("all", element="Q4I", material=metal, plane="strain", local_strain="logarithmic")
    floor = ct.RigidCurve.line((-3.0, -1.0), (3.0, -1.0))
    roof = ct.RigidCurve.line((3.0, 1.0), (-3.0, 1.0), plate)
    model.contact("outer", floor, friction=0.5, name="floor")
    model.contact("outer", roof, friction=0.5, name="roof")
    model.fix("plate", x=0.0, y=-0.2, rotation=True)
    results = ct.solve(model, ct.Static(first_increment=0.01), threads=1)
    up, down = (results.history(f"{name}: force y").values[-1] for name in ("floor", "roof"))
    assert up == pytest.approx(-down)
    assert up == pytest.approx(0.22315, rel=1e-3)  # node to segment: 0.223153


@pytest.mark.slow
def test_a_clip_finishes_where_no_relaxed_position_balances():
    # An elastic clip with sharp corners and friction 1.
    notes = []

    class Log(BaseObserver):
        def iteration(self, info):
            notes.append(info.note)

    given = problem(562, size=0.5)
    results = ct.solve(given.model, given.steps, threads=1, observers=[Log()])
    assert results.times[-1] == pytest.approx(sum(step.period for step in given.steps))
    assert max(frame.scalars.get("residual", 0.0) for frame in results.frames[1:]) < 1e-8
    assert any("no springs" in note for note in notes)  # the state that is accepted has none


SLOW = [pytest.param(number, 0.5, marks=pytest.mark.slow) for number in (679, 1335, 1731)]


@pytest.mark.parametrize(("number", "size"), [(1192, 0.65), (274, 0.5), *SLOW])
def test_relaxation_passes_positions_at_which_gaps_jump(number, size):
    """Clips past sharp corners and blocks on wavy floors, all with friction.

    No position without overlap balances on either side of the jump, however stiff the springs are.
    """
    notes = []

    class Log(BaseObserver):
        def iteration(self, info):
            notes.append(info.note)

    given = problem(number, size=size)
    results = ct.solve(given.model, given.steps, threads=1, observers=[Log()])
    assert results.times[-1] == pytest.approx(sum(step.period for step in given.steps))
    assert max(frame.scalars.get("residual", 0.0) for frame in results.frames[1:]) < 1e-8
    assert any(note.startswith("relaxation, no springs") for note in notes)
    # Forces and conditions of contact are those of the model: no springs are left.
    for frame in results.frames[1:]:
        forces = [frame.RF[:, :2].sum(axis=0)]
        if isinstance(given.model.contacts[0].master, ct.RigidCurve):
            name = given.model.contacts[0].name
            forces.append([frame.scalars[f"{name}: force {axis}"] for axis in "xy"])
        size = max(np.abs(frame.RF).max(), 1e-30)
        np.testing.assert_allclose(np.sum(forces, axis=0), 0.0, atol=1e-7 * size)


def _pressed(monkeypatch, down, farthest=np.inf, moved=True):
    """A block that a floor compresses, relaxed, against Newton's method in one increment.

    Elements fail where a node moves farther than a distance from the last evaluation. The support
    has moved before relaxation begins, or moves in it. Returns the evaluations that failed.
    """
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 3, 3, "quad4"))
    material = ct.Elastic(E=10.0, nu=0.3)
    model.section(
        "all", element="Q4I", material=material, plane="strain", local_strain="logarithmic"
    )
    model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)), friction=0.2)
    model.fix("top", x=0.0, y=-down)
    expected = ct.solve(model, ct.Static(first_increment=1.0), threads=1)
    assert len(expected.frames) == 2
    system = System(model, Multifrontal())
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    start = system.conditions.supports.at(1.0, np.zeros(system.n_dofs))
    begin = start if moved else np.zeros_like(start)
    inner, last, failed = system.evaluate, [begin], []

    def evaluate(z, step_time, rule=REST):
        u = z[: system.n_dofs]
        if np.abs(u - last[0]).max() > farthest:
            failed.append(u)
            raise ElementFailure("inverted")
        last[0] = u.copy()
        return inner(z, step_time, rule)

    inner(np.append(begin, np.zeros(system.n_multipliers)), 0.0)  # measures stiffness
    monkeypatch.setattr(system, "evaluate", evaluate)
    found, _ = relax(system, begin, start, 1.0, Settings())
    assert found.converged, found.reason
    exact = expected.frames[-1].U[:, :2].ravel()
    np.testing.assert_allclose(found.u, exact, atol=1e-8)
    return failed


def test_relaxation_in_which_an_element_fails_goes_on_with_stiffer_springs(monkeypatch):
    assert not _pressed(monkeypatch, 0.1)
    assert _pressed(monkeypatch, 0.1, farthest=0.02)


@pytest.mark.parametrize("down", [0.1, 0.2, 0.3])
def test_relaxation_moves_supports_by_more_than_a_position_may(monkeypatch, down):
    # An edge is a third of the height, and a position at most half an edge away.
    _pressed(monkeypatch, down, moved=False)


def test_a_body_that_contact_never_holds_is_said_to_rest_anywhere():
    body = ct.mesh.rectangle(1.0, 1.0, 2, 2, "quad4", origin=(0.0, 0.1))
    top = ct.mesh.add_node(body, 0.5, 2.0, "plate")
    model = ct.Model(body)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    floor = ct.RigidCurve.line((-3.0, 0.0), (3.0, 0.0))
    roof = ct.RigidCurve.line((3.0, 1.5), (-3.0, 1.5), top)
    model.contact("bottom", floor, name="floor", friction=0.3)
    model.contact("top", roof, name="roof", friction=0.3)
    model.fix("plate", x=0.0, y=-0.2, rotation=True)  # the roof stays 0.2 above the body
    results = ct.solve(model, ct.Static(), threads=1)
    assert results.frames[-1].scalars["floor: force y"] == pytest.approx(0.0, abs=1e-9)
    said = [note for note in results.notes if "the position of that body is undetermined" in note]
    assert len(said) == 1


def test_an_impact_in_fixed_increments_is_relaxed():
    # A strip that snaps as it hits, with friction .8: no shorter increment may be tried.
    row = run(296, limit=60, size=0.5)
    assert row["end"] == "done", row["why"]
    assert row["increments"] == 100
    assert row["residual"] < 1e-8


@pytest.mark.parametrize("number", [880, 1897, pytest.param(1368, marks=pytest.mark.slow)])
def test_a_plastic_collapse_is_followed_to_its_limit_point(number):
    """Arc length goes on with what flows and slips at the end of load control.

    With the elastic tangent, or with nodes that stick again, the path seemed to turn round at once:
    the run stopped in increments of 1e-10 of the load that were elastic, and no reason was shown.
    """
    row = run(number, limit=60, size=0.5)
    assert row["why"].startswith("limit point")
    assert (row["reason"], row["right"]) == ("limit point", True)


def test_a_stop_behind_an_unstable_equilibrium_says_so():
    said = unstable(SimpleNamespace(negative=1))
    assert "The last equilibrium is unstable (negative pivots of the tangent: 1)" in said
    assert unstable(SimpleNamespace(negative=0)) == ""


@pytest.mark.parametrize("number", [30])
def test_slip_is_solved_alike_by_gmres_and_by_the_whole_matrix(number, monkeypatch):
    """Pivoting with friction has many right-hand sides; how they are solved is a matter of cost."""
    whole = saddle_point.SaddlePointSystem._by_lu
    compared = []

    def both(self, data, rest, b):
        try:
            x = self._gmres_all(rest, b)
        except ct.InputError:  # the symmetric part is singular
            x = None
        y = whole(self, data, rest, b)
        if x is not None and b.shape[1] > saddle_point.MOST_COLUMNS:
            for part in (slice(0, self.nf), slice(self.nf, None)):
                compared.append(abs(x[part] - y[part]).max() / abs(y[part]).max())
        return y

    monkeypatch.setattr(saddle_point.SaddlePointSystem, "_by_lu", both)
    given = problem(number, size=0.5)
    ct.solve(given.model, given.steps, threads=1)
    assert compared
    # GMRES ends at 1e-9 of its own residual; some of these matrices are nearly singular.
    assert max(compared) < 1e-3


@pytest.mark.parametrize(
    ("number", "exact"), [(340, 0.105947), (502, 0.0563506), (1080, 0.0857143)]
)
def test_default_increments_move_bodies_on_friction_as_fine_ones_do(number, exact):
    """Two stacks and a press fit; `exact` is with 200 and 414 increments.

    Where constraints slipped early from less load, these had 2 to 10 % error.
    """
    assert run(number, limit=60, size=0.5)["moved"] == pytest.approx(exact, rel=0.01)

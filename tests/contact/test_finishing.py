# SPDX-License-Identifier: BSD-3-Clause
"""Contact problems that stopped with the defaults run to their end, in balance.

They are a sample of ``python -m benchmarks.contact_torture``; each of these stopped before states
were chosen from the whole linearized problem. Reactions and contact forces must balance.
"""

import pytest

import corota as ct
from benchmarks.contact_problems import problem
from benchmarks.contact_torture import run
from corota.results.observer import BaseObserver

#: Numbers of the torture set that stopped before.
STOPPED = (7, 10, 16)
#: And numbers that stopped for a cause of their own: a stabilized body whose damping the first
#: correction lacked, a rib seen through the body from behind, an overlap pushed out at once, a
#: flat punch whose round ends press on facets of which one node lies on the flat.
CAUSES = (36, 41, 69, 15)


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

    model = problem(16).model
    ct.solve(model, ct.Static(), observers=[Log()], threads=1)
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
    assert row["residual"] < 1e-8
    assert row["balance"] < 1e-8


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

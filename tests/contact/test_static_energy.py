"""The energy account of static contact: closed where the answer is right, open where it is not."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.terms.contact.pair import Pair

METHODS = ["mortar", "node_to_segment"]
#: The sums are second-order accurate in the turn of normals within an increment.
CLOSED = 5e-3


def press_fit(method, friction=0.0, start="keep"):
    inner, outer = ct.mesh.annulus(1.0, 2.0, 3, 24), ct.mesh.annulus(1.99, 3.0, 3, 20)
    model = ct.Model(ct.mesh.assembly(inner=inner, outer=outer))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.contact("inner.outer", "outer.inner", method=method, friction=friction, start=start)
    points = model.mesh.points
    for radius in (1.0, 3.0):
        for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            node = int(np.argmin(np.hypot(*(points - radius * np.array([x, y])).T)))
            model.fix([node], x=None if x else 0.0, y=0.0 if x else None)
    return model


def block(method, gap=0.0, friction=0.0, drag=0.0):
    table = ct.mesh.rectangle(4.0, 1.0, 8, 2)
    above = ct.mesh.rectangle(1.0, 1.0, 4, 4, origin=(1.0, 1.0 + gap))
    model = ct.Model(ct.mesh.assembly(table=table, block=above))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.contact("block.bottom", "table.top", method=method, friction=friction)
    model.fix("table.bottom")
    model.fix("block.top", x=drag, y=-0.02 - gap)
    return model


CASES = {
    "press fit": lambda m: press_fit(m),
    "press fit over the step": lambda m: press_fit(m, start="ramp"),
    "press fit with friction": lambda m: press_fit(m, friction=0.3),
    "block that closes a gap": lambda m: block(m, gap=0.05),
    "dragged block": lambda m: block(m, friction=0.2, drag=1.0),
    "dragged block that closes a gap": lambda m: block(m, 0.05, 0.2, 0.5),
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("case", CASES)
def test_the_balance_closes_in_one_increment(case, method):
    """Contact begins within it: the work of loads alone would be up to 100 % off."""
    results = ct.solve(CASES[case](method), ct.Static(increments=1), threads=1)
    assert abs(results.frames[-1].scalars["energy balance error"]) <= CLOSED
    assert not [n for n in results.notes if "energy balance" in n]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slave", ["table", "pad"])
@pytest.mark.parametrize(("way", "increments"), [(0.3, 1), (0.3, 4), (3.5, 1), (3.5, 8)])
def test_a_block_that_is_pressed_and_then_dragged_rubs_mu_times_load_times_way(
    method, slave, way, increments
):
    """Also where it leaves slave nodes behind and comes to others: this was up to 44 % low."""
    table = ct.mesh.rectangle(6.0, 0.5, 30, 2, origin=(0.0, -0.5))
    pad = ct.mesh.rectangle(1.0, 0.5, 4, 2, origin=(0.5, 0.0))
    model = ct.Model(ct.mesh.assembly(table=table, pad=pad))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    sides = ("table.top", "pad.bottom")
    model.contact(
        *(sides if slave == "table" else sides[::-1]), friction=0.2, method=method, name="foot"
    )
    model.fix("table.bottom")
    model.force("pad.top", y=-10.0)
    press, drag = ct.Static(), ct.Static(increments=increments)
    press.fix("pad.top", x=0.0, y=None)
    drag.fix("pad.top", x=way, y=None)
    last = ct.solve(model, [press, drag], threads=1).frames[-1].scalars
    assert last["ALLFD"] == pytest.approx(0.2 * 10.0 * way, rel=1e-3)
    assert abs(last["energy balance error"]) <= 1e-3


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slave", ["table", "pad"])
def test_a_block_that_slides_back_over_other_slave_nodes_keeps_the_balance(method, slave):
    """There and back in one increment each: the work of what drives it was up to 36 % low."""
    table = ct.mesh.rectangle(6.0, 0.5, 30, 2, origin=(0.0, -0.5))
    pad = ct.mesh.rectangle(1.0, 0.5, 4, 2, origin=(2.0, 0.0))
    model = ct.Model(ct.mesh.assembly(table=table, pad=pad))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    sides = ("table.top", "pad.bottom")
    model.contact(*(sides if slave == "table" else sides[::-1]), friction=0.2, method=method)
    model.fix("table.bottom")
    model.force("pad.top", y=-10.0)
    steps = []
    for x in (0.0, 0.6, -0.7):
        steps.append(ct.Static(increments=1))
        steps[-1].fix("pad.top", x=x, y=None)
    last = ct.solve(model, steps, threads=1).frames[-1].scalars
    assert last["ALLFD"] == pytest.approx(0.2 * 10.0 * (0.6 + 1.3), rel=2e-3)
    assert last["ALLWK"] == pytest.approx(last["ALLFD"] + last["ALLSE"], rel=2e-3)
    assert abs(last["energy balance error"]) <= 2e-3


@pytest.mark.parametrize("method", METHODS)
def test_removed_overlap_is_the_energy_of_a_press_fit(method):
    """No load works: the strain energy is that of the pressures on the overlap."""
    last = ct.solve(press_fit(method), ct.Static(increments=1), threads=1).frames[-1].scalars
    assert last["ALLPW"] == pytest.approx(last["ALLSE"], rel=CLOSED)
    assert last["ALLWK"] == pytest.approx(0.0, abs=1e-12 * last["ALLSE"])


def test_pressures_do_no_work_as_increments_shrink():
    work = []
    for increments in (2, 4, 8):
        step = ct.Static(increments=increments)
        last = ct.solve(block("mortar", gap=0.05), step, threads=1).frames[-1].scalars
        work.append(abs(last["ALLPW"]) / last["ALLSE"])
    assert work[2] < 0.35 * work[0]


@pytest.mark.parametrize("method", METHODS)
def test_friction_that_is_not_dissipated_is_seen(method, monkeypatch):
    """A force along the surfaces whose work nothing accounts for: what a wrong friction does."""
    commit = Pair.commit

    def forget(self, *arguments):
        commit(self, *arguments)
        self.friction_work *= 0.5

    monkeypatch.setattr(Pair, "commit", forget)
    model = block(method, friction=0.2, drag=1.0)
    results = ct.solve(model, ct.Static(increments=1), threads=1)
    assert abs(results.frames[-1].scalars["energy balance error"]) > 0.2
    assert [n for n in results.notes if "energy balance" in n]


@pytest.mark.parametrize("keep", ["all", "last"])
def test_a_peak_that_an_increment_may_pass_is_noted(keep):
    """Whether all frames are kept or the last one only, as by ``corota run``."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0))
    model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (2.0, 0.0)), name="floor")
    model.amplitudes["push"] = ct.Amplitude(np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.0, 0.1]))
    step = ct.Static(increments=5)
    step.fix("top", x=0.0, y=-0.01, amplitude="push")
    notes = ct.solve(model, step, keep=keep, threads=1).notes
    assert sum("resolves the peak" in note for note in notes) == 1


@pytest.mark.parametrize("angle", [90.0, 360.0])
def test_no_peak_is_noted_on_a_plateau_or_in_rounding(angle):
    """A press fit in four increments: the force of a quarter stays, that of a ring is 0."""
    ring = ct.mesh.annulus(1.0, 2.01, 2, 24, angle=angle)
    model = ct.Model(ring)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    hole = ct.RigidCurve.circle((0.0, 0.0), 2.0, inside=True)
    model.contact("outer", hole, friction=0.2, name="hole")
    if angle < 360.0:
        model.fix("start", x=None)
        model.fix("end", y=None)
    else:
        model.fix("inner")
    notes = ct.solve(model, ct.Static(increments=4), threads=1).notes
    assert not [note for note in notes if "resolves the peak" in note]


@pytest.mark.parametrize("increments", [1, 5])
def test_friction_energy_counts_only_the_part_of_a_bar_that_slips(increments: int) -> None:
    """Pulled by F on a rough floor (q per length): F^3 / 6 EA q, and F^3 / 24 EA q on release.

    The part that does not slip has no shear traction at all; it does not leave the floor.
    """
    q, stiffness, force = 0.2, 1e3, 1.0
    model = ct.Model(ct.mesh.line([(0.0, 0.0), (10.0, 0.0)], n=100))
    model.truss("all", material=ct.Elastic(E=1e6), area=1e-3)
    floor = ct.RigidCurve.line((-1.0, 0.0), (12.0, 0.0))
    model.contact("all", floor, friction=0.4, name="floor")
    model.line_load(y=-q / 0.4)
    steps = [ct.Static(), ct.Static(increments=increments), ct.Static(increments=increments)]
    steps[1].force("end", x=force)
    steps[2].force("end", x=0.0)
    results = ct.solve(model, steps)
    pulled = int(np.flatnonzero(results.history("step") == 2)[-1])
    lost = results.history("friction energy")
    unit = force**3 / (stiffness * q)
    assert float(lost[pulled]) == pytest.approx(unit / 6.0, rel=1e-3)
    assert float(lost[-1] - lost[pulled]) == pytest.approx(unit / 24.0, rel=2e-3)
    assert abs(results.frames[-1].scalars["ETOTAL"]) < 1e-9

"""Contact on equilibrium paths: limit points under a rigid probe, friction, plasticity, stops."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.io.deck.write.model import write_deck
from corota.mesh import Cells, Mesh
from corota.model.loads import Fixed, NodalForce

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "contact"))
import bistable_beam

#: What equilibrium to the default tolerance of 1e-9 leaves of a force of order one.
SAME = 1e-7


def beam(kind="elastic", friction=0.0, unit=1.0):
    """The half beam of the example, coarser, its probe loaded by a unit force."""
    model = bistable_beam.beam(nx=16, unit=unit)
    young = 2000.0 * unit**2
    if kind == "plastic":
        model.sections[0].material = ct.Mises(
            E=young, nu=0.3, yield_stress=5.0 * unit**2, isotropic=100.0 * unit**2
        )
    model.contacts[0].friction = friction
    return model


def along(model, unit=1.0, down=-4.5, **path):
    """Load control by arc length."""
    model.force("probe", y=-1.0)
    path = path or {"displacement": ("probe", "y", down / unit)}
    return ct.solve(model, ct.Static(path=ct.ArcLength(**path)), threads=1)


def pushed(model, ways):
    """The probe held at each of some positions in turn: its force there."""
    steps = [ct.Static(increments=1, supports=[Fixed("probe", 1, way)]) for way in ways]
    results = ct.solve(model, steps, threads=1)
    force, step = -np.array(results.history("RF2", at="probe")), results.history("step")
    return force[[np.flatnonzero(np.array(step) == k)[-1] for k in range(1, len(ways) + 1)]]


@pytest.mark.parametrize(
    ("kind", "friction", "tolerance"),
    [
        ("elastic", 0.0, SAME),
        ("elastic", 0.3, SAME),
        # Cut increments of the other run flow along another way.
        ("plastic", 0.0, 1e-7),
        ("plastic", 0.3, 5e-4),
    ],
)
def test_forces_are_those_of_the_prescribed_probe(kind, friction, tolerance):
    found = along(beam(kind, friction))
    factor, way = np.array(found.history("load factor")), found.history("U2", at="probe")
    assert factor.max() > 1.5 * factor[-1] > 0.0  # the path has passed its limit point
    limit = [p for p in found.critical_points if p.kind == "limit"]
    assert len(limit) == 1
    assert limit[0].factor == pytest.approx(factor.max(), rel=max(tolerance, 1e-12))
    assert pushed(beam(kind, friction), way[1:]) == pytest.approx(factor[1:], abs=tolerance)


def test_stability_is_that_of_the_beam_without_the_multipliers():
    found = along(beam())
    limit = found.critical_points[0]
    assert limit.negative == (0, 1)
    stable = found.history("stable")
    assert list(stable[1:]) == sorted(stable[1:], reverse=True)
    # A unit force on the probe does the work of its way in the mode.
    probe = int(found.model.mesh.node_sets["probe"][0])
    assert limit.projection == pytest.approx(-limit.mode[probe, 1], rel=1e-9)
    assert abs(limit.projection) > 0.3


def test_friction_that_slips_tells_no_stability():
    """A probe beside the middle, where the surface is inclined, slides on it."""
    model = beam(friction=0.3)
    probe = int(model.mesh.node_sets["probe"][0])
    place, radius = (6.0, model.mesh.points[probe, 1]), bistable_beam.RADIUS
    tip = ct.RigidCurve.arc(place, radius, 45.0, -180.0, reference=probe)
    model.contacts[0].master = tip
    found = along(model, increments=3)
    assert "stable" not in found.frames[-1].scalars
    assert any("friction slips" in note for note in found.notes)


@pytest.mark.parametrize("kind", ["elastic", "plastic"])
def test_units_do_not_matter(kind):
    one, other = (along(beam(kind, 0.3, unit), unit, -2.0) for unit in (1.0, 1e3))
    assert list(one.history("iterations")) == list(other.history("iterations"))
    assert np.array(one.history("load factor")) == pytest.approx(
        other.history("load factor"), rel=1e-6
    )


def test_a_moving_probe_may_carry_the_load_factor():
    """Its position is then the factor, and turns where the force does not."""
    model = beam()
    path = ct.ArcLength(factor=1.0)
    found = ct.solve(model, ct.Static(path=path, supports=[Fixed("probe", 1, -4.5)]), threads=1)
    way = np.array(found.history("U2", at="probe"))
    assert way == pytest.approx(-4.5 * np.array(found.history("load factor")))
    force = -np.array(found.history("RF2", at="probe"))
    assert pushed(beam(), way[1:]) == pytest.approx(force[1:], abs=SAME)


@pytest.mark.parametrize("offset", [0.5, -0.1])
def test_a_probe_that_nothing_holds_begins_with_a_gap_or_an_overlap(offset):
    model = beam()
    curve, node = model.contacts[0].master, int(model.mesh.node_sets["probe"][0])
    x, y = model.mesh.points[node]
    radius = bistable_beam.RADIUS
    model.contacts[0].master = ct.RigidCurve.arc(
        (x, y + offset), radius, 45.0, -180.0, curve.reference
    )
    found = along(model, down=-4.5 - offset)
    assert found.critical_points[0].factor == pytest.approx(
        along(beam()).critical_points[0].factor, rel=1e-6
    )


def test_an_overlap_that_is_to_be_ramped_is_refused():
    model = beam()
    probe = model.contacts[0]
    probe.start, probe.clearance = "ramp", -0.1
    with pytest.raises(ct.ModelError, match=r"'probe' overlaps at the start.*static step before"):
        along(model)


def test_deck_with_riks_and_a_contact_pair(tmp_path):
    model = beam()
    label = int(model.mesh.node_labels[int(model.mesh.node_sets["probe"][0])])
    deck = write_deck(model, tmp_path / "beam.inp")
    text = deck.read_text().partition("*STEP")[0]
    assert "*CONTACT PAIR" in text
    text += f"*STEP, NLGEOM, INC=100\n*STATIC, RIKS\n.05, 1., , , , {label}, 2, -4.5\n"
    deck.write_text(f"{text}*CLOAD\n{label}, 2, -1.\n*END STEP\n")
    found = ct.solve(ct.read(deck), threads=1)
    assert found.critical_points[0].factor == pytest.approx(
        along(beam()).critical_points[0].factor, rel=1e-6
    )
    assert found.history("U2", at="probe")[-1] == pytest.approx(-4.5)


#: Height at which a stop waits below the middle of the beam.
STOP = 2.0


def stopped():
    model = beam()
    model.contact("bottom", ct.RigidCurve.line((-6.0, STOP), (6.0, STOP)), name="stop")
    return model


def test_a_stop_closes_on_the_way_down_and_opens_on_the_way_back():
    """The path turns by a kink there, both times at the same load; an elastic way is one curve."""
    model = stopped()
    model.force("probe", y=-1.0)
    there = ct.Static(path=ct.ArcLength(factor=2.0))
    back = ct.Static(path=ct.ArcLength(factor=0.9), loads=[NodalForce("probe", 1, 0.0)])
    found = ct.solve(model, [there, back], threads=1)
    way, area = np.array(found.history("U2", at="probe")), found.history("stop: area")
    force = -np.array(found.history("F2", at="probe"))
    assert max(area) > 0.0 == area[-1]
    assert pushed(stopped(), way[1:]) == pytest.approx(force[1:], abs=SAME)
    loads = [p.factor if p.step == 1 else 2.0 * (1.0 - p.factor) for p in found.critical_points]
    kinds = [(p.step, p.kind, p.negative) for p in found.critical_points]
    assert kinds[:2] == [(1, "limit", (0, 1)), (1, "limit", (1, 0))]
    assert kinds[-2:] == [(2, "limit", (0, 1)), (2, "limit", (1, 0))]
    assert loads[0] == pytest.approx(loads[-1], rel=1e-8)  # smooth
    assert loads[1] == pytest.approx(loads[-2], rel=1e-4)  # where the stop is touched
    assert list(found.history("stable")[1:4]) == [1.0, 1.0, 1.0]


def snap_fit(friction):
    """A clamped arm with a bump on it, and a rigid ball to be pushed over it to the left."""
    length, height, radius = 20.0, 1.5, 3.0

    def top(t):
        x = length * t
        return x, height + (0.5 + 0.5 * np.cos(np.pi * (x - 14.0) / 5.0)) * (abs(x - 14.0) < 5.0)

    sides = [lambda t: (length * t, 0.0), lambda t: (length, height * t)]
    mesh = ct.mesh.mapped([*sides, top, lambda t: (0.0, height * t)], 40, 2)
    center = (18.3, height + 0.2 + radius)
    ball = ct.mesh.add_node(mesh, *center, "ball")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=2300.0, nu=0.38), thickness=4.0)
    curve = ct.RigidCurve.circle(center, radius, reference=ball)
    model.contact("top", curve, friction=friction, name="bump")
    model.fix("left")
    model.fix("ball", x=None, y=0.0, rotation=0.0)
    return model


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_snap_fit_by_its_load_passes_node_after_node(friction):
    """Each node of the coarse bump makes the load rise and fall; the ends of pieces are kinks."""
    model = snap_fit(friction)
    model.force("ball", x=-1.0)
    path = ct.ArcLength(displacement=("ball", "x", -4.0))
    found = ct.solve(model, ct.Static(path=path, max_increments=200), threads=1)
    factor, way = np.array(found.history("load factor")), found.history("U1", at="ball")
    assert way[-1] == pytest.approx(-4.0)
    assert factor.max() > 0.4
    assert sum(p.kind == "limit" for p in found.critical_points) > 3
    steps = [ct.Static(increments=1, supports=[Fixed("ball", 0, x)]) for x in way[1:]]
    held = ct.solve(snap_fit(friction), steps, threads=1)
    assert -np.array(held.history("RF1", at="ball")) == pytest.approx(factor, abs=SAME)


def test_load_control_names_the_limit_point_or_goes_on_to_the_stop():
    model = beam()
    model.force("probe", y=-1.6)
    with pytest.raises(ct.ConvergenceError, match=r"limit point at load factor 0\.665059"):
        ct.solve(model, ct.Static(increments=8), threads=1)
    model = stopped()
    model.force("probe", y=-1.6)
    found = ct.solve(model, ct.Static(increments=40, at_limit="follow"), threads=1)
    assert found.frames[-1].factor == pytest.approx(1.0)
    assert [p.negative for p in found.critical_points] == [(0, 1), (1, 0)]


@pytest.mark.parametrize(("side", "stiffness"), [(1.0, 1e5), (1.0, 1e9), (-1.0, 1e5)])
@pytest.mark.parametrize("preload", [0.0, 0.06])
@pytest.mark.parametrize("friction", [0.0, 0.1, 0.3])
def test_a_strut_on_a_rough_floor_slides_from_load_zero(
    friction: float, preload: float, side: float, stiffness: float
) -> None:
    """``P (x / y - mu) = k (x - x0)``: half a frame, its foot held by a spring and friction.

    All that touches slides with the first load: what sticks would have another path. Where it is
    flat the foot lifts, and the top comes back to where the path ends: it ends before.
    """
    nodes = np.array([[0.0, 1.5], [side * 10.0, 0.0], [side * 30.0, 0.0]])
    model = ct.Model(Mesh(nodes, [Cells("line2", np.array([[0, 1], [1, 2]]), np.array([1, 2]))]))
    model.truss([0], material=ct.Elastic(E=stiffness, nu=0.0), area=1.0)
    model.spring([1], 10.0)
    model.fix([0], x=0.0, y=None)
    model.fix([2])
    model.contact([1], ct.RigidCurve.line((-50.0, 0.0), (50.0, 0.0)), friction=friction)
    steps = [ct.Static(loads=[NodalForce([0], 1, -preload)])] if preload else []
    path = ct.ArcLength(displacement=([0], "y", -1.2))
    steps.append(ct.Static(path=path, loads=[NodalForce([0], 1, -1.0)]))
    found = ct.solve(model, steps, threads=1)
    x = 10.0 + side * found.history("U1", at=[1]).values
    y = 1.5 + found.history("U2", at=[0]).values
    load = -np.array([frame.F[0, 1] for frame in found.frames])
    assert load * (x / y - friction) == pytest.approx(10.0 * (x - 10.0), abs=1e-7)
    assert y[-1] == pytest.approx(0.3)
    assert [point.kind for point in found.critical_points] == ["limit"]

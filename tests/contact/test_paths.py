"""Contact on equilibrium paths: limit points under a rigid probe, friction, plasticity, stops."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.model import Fixed

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
        ("plastic", 0.0, 2e-3),
        ("plastic", 0.3, 5e-3),
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
    found = along(beam(friction=0.3), increments=3)
    assert "stable" not in found.frames[-1].scalars
    assert any("friction slips" in note for note in found.notes)


@pytest.mark.parametrize("kind", ["elastic", "plastic"])
def test_units_do_not_matter(kind):
    one, other = (along(beam(kind, 0.3, unit), unit) for unit in (1.0, 1e3))
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
        (x, y + offset), radius, -135.0, 180.0, curve.reference
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

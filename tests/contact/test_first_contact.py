"""The first touch of a body is found when it happens, whatever the increments are.

Only automatic increments: fixed ones are the user's. A bar with one flat end that flies at speed v
towards a wall at a distance d meets it at d / v, is pressed by rho c A v for 2 L / c, and leaves
with v: the impulse is 2 m v, of which coarse meshes keep a few percent as vibration.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.pairs import cover

SCHEMES = ["hht", "newmark", "generalized_alpha", "energy_momentum"]
CELL = {"Q4I": "quad4", "Q4D": "quad4", "OPT": "tri3", "Q8R": "quad8"}
L, HIGH, E, RHO = 10.0, 1.0, 1e4, 1.0
C = (E / RHO) ** 0.5
#: A first touch may be found this late; docs/impact.md [slave edges].
LATE = 1e-2

pytestmark = pytest.mark.filterwarnings("ignore:energy balance")


def fly(scheme: str, element: str, method: str, speed: float, gap: float, **step: float):
    mesh = ct.mesh.rectangle(L, HIGH, nx=10, ny=2, cell=CELL[element])  # type: ignore[arg-type]
    model = ct.Model(mesh)
    material = ct.Elastic(E=E, nu=0.0, rho=RHO)
    model.section(element=element, material=material, plane="stress")
    model.velocity(x=speed)
    wall = ct.RigidCurve.line((L + gap, -5.0), (L + gap, 5.0))
    model.contact("right", wall, method=method, name="wall")  # type: ignore[arg-type]
    period = gap / speed + step.pop("after", 3.0) * L / C
    return ct.solve(model, ct.Dynamic(scheme=scheme, period=period, **step), threads=1)  # type: ignore[arg-type]


def first(results: ct.Results) -> float:
    """Time of the first frame with a force on the wall."""
    force = np.abs(results.history("wall: force x").values)
    return float(np.asarray(results.times)[np.flatnonzero(force > 0.0)[0]])


@pytest.mark.parametrize(
    ("scheme", "element", "method"),
    cover(SCHEMES, list(CELL), ["mortar", "node_to_segment"], strength=1),
)
def test_bar_meets_a_wall_at_the_exact_time_and_leaves_with_the_exact_impulse(
    scheme: str, element: str, method: str
) -> None:
    speed, gap = 1.0, 0.37
    results = fly(scheme, element, method, speed, gap)
    # The touch, and the increment after it where a scheme begins contact in that; an increment
    # in contact is a fraction of the time a wave takes through an edge.
    assert 0.0 <= first(results) - gap / speed < (LATE + 0.5 * speed / C) * 0.5 / speed
    impulse = RHO * L * HIGH * speed - results.history("momentum x").values[-1]
    assert impulse == pytest.approx(2.0 * RHO * L * HIGH * speed, rel=0.04)


@pytest.mark.parametrize(
    ("scheme", "gap", "first_increment"),
    cover(["hht", "energy_momentum"], [1e-3, 0.03, 3.0], [0.0, 1e-4, 0.03, 0.2]),
)
def test_time_of_first_contact_does_not_depend_on_the_increment(
    scheme: str, gap: float, first_increment: float
) -> None:
    """Slowly: the body travels less than a tenth of an edge while it is pressed."""
    step = {"first_increment": first_increment} if first_increment else {}
    results = fly(scheme, "Q4I", "mortar", 0.05, gap, after=0.5, **step)
    assert 0.0 <= first(results) - gap / 0.05 < LATE / 0.05
    assert len(results.frames) < 150


@pytest.mark.parametrize(("scheme", "speed"), cover(SCHEMES, [0.0, 0.2], strength=1))
def test_block_that_falls_meets_the_floor_at_the_exact_time(scheme: str, speed: float) -> None:
    """Free fall: d = v t + g t^2 / 2; soft enough that increments are long."""
    g, gap = 10.0, 0.5
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=4, ny=4)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3, rho=1.0))
    model.velocity(y=-speed)
    model.gravity(y=-g)
    floor = ct.RigidCurve.line((-9.0, -gap), (9.0, -gap))
    model.contact("bottom", floor, name="wall")
    exact = (-speed + np.sqrt(speed**2 + 2.0 * g * gap)) / g
    results = ct.solve(model, ct.Dynamic(scheme=scheme, period=1.01 * exact), threads=1)
    force = np.abs(results.history("wall: force y").values)
    when = np.asarray(results.times)[np.flatnonzero(force > 0.0)[0]]
    assert 0.0 <= (when - exact) * (speed + g * exact) < LATE * 0.25
    # The floor gives what the momentum gains: m (v + g T) less what is left.
    assert results.history("momentum y").values[-1] > -0.9 * (speed + g * exact)


@pytest.mark.parametrize(
    ("speed", "spin", "gap", "scheme"),
    [
        (1.0, 3.0, 1.0, "hht"),
        pytest.param(1.0, 3.0, 1.0, "energy_momentum", marks=pytest.mark.slow),
        (50.0, 0.0, 200.0, "hht"),
        (50.0, 0.0, 200.0, "energy_momentum"),
    ],
)
def test_a_turning_body_and_one_that_comes_fast_from_far_off_meet_in_time(
    speed: float, spin: float, gap: float, scheme: str
) -> None:
    """The corner of a spinning plate; within one increment it would pass the wall altogether."""
    mesh = ct.mesh.rectangle(1.0, 0.5, nx=4, ny=2, origin=(-0.5, -0.25))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.3, rho=1.0))
    model.velocity(x=speed, spin=spin)
    wall = ct.RigidCurve.line((gap, -99.0), (gap, 99.0))
    outline = np.vstack(list(mesh.edge_sets.values()))
    model.contact(outline, wall, method="node_to_segment", name="wall")
    t = np.linspace(0.0, gap / speed, 1000001)
    angles = np.array([0.0, np.pi]) + np.arctan2(0.25, [[0.5], [-0.5]])
    corners = [np.hypot(0.5, 0.25) * np.cos(a + spin * t) for a in angles.ravel()]
    exact = t[np.flatnonzero(speed * t + np.max(corners, axis=0) >= gap)[0]]
    when = first(ct.solve(model, ct.Dynamic(scheme=scheme, period=exact + 2e-3), threads=1))
    assert 0.0 <= (when - exact) * (speed + abs(spin)) < LATE * 0.25 + 1e-4

"""A block on a slope of 30 degrees sticks or slides according to Coulomb's law.

1 x 0.4, E = 10000, nu = 0.3, unit density, gravity 10, on a rigid line. With a friction of 0.58,
above tan 30 = 0.5774, it rests: the reaction of the slope equals its weight. With 0.57 no static
equilibrium exists, and the step reports that friction does not hold the body. Released in a dynamic
step with 0 and 0.3, it slides with the acceleration g (sin 30 - mu cos 30). Dragging a block under
pressure over another one takes the friction coefficient times the pressure.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Value, zero
from corota.verification.models import run


def incline(friction: float, method: Any = "mortar") -> ct.Model:
    """A block that lies on a slope of 30 degrees."""
    model = ct.Model(ct.mesh.move(ct.mesh.rectangle(1.0, 0.4, 4, 2), angle=30.0))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.gravity(y=-10.0)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    slope = ct.RigidCurve.line((-5 * c, -5 * s), (5 * c, 5 * s))
    model.contact("bottom", slope, friction=friction, method=method, name="slope")
    return model


def dragged(**keys: Any) -> ct.Results:
    """A block under a pressure of 10 is dragged over another, friction 0.3."""
    low = ct.mesh.rectangle(4.0, 0.5, 9, 1)
    up = ct.mesh.rectangle(1.0, 0.5, 3, 2, origin=(0.7, 0.5))
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("low.bottom")
    time = np.array([0.0, 0.2, 1.0])
    model.amplitudes["push"] = ct.Amplitude(time, np.array([0.0, 1.0, 1.0]))
    model.amplitudes["drag"] = ct.Amplitude(time, np.array([0.0, 0.0, 1.5]))
    model.fix("up.top", x=1.0, y=None, amplitude="drag")
    model.traction("up.top", y=-10.0, amplitude="push")
    model.contact("up.bottom", "low.top", friction=0.3, name="pair")
    return run(model, ct.Static(first_increment=0.2, largest_increment=0.2), **keys)


def sliding(friction: float) -> float:
    """Mean acceleration down the slope of a block that is let go there, over two tenths."""
    model = incline(friction)
    model.loads.clear()
    model.gravity(y=-10.0)
    period, mass = 0.2, 0.4
    step = ct.Dynamic(period=period, increments=80, scheme="generalized_alpha", rho_inf=0.5)
    last = run(model, step).frames[-1].scalars
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    return -float(last["momentum x"] * c + last["momentum y"] * s) / (mass * period)


def measure() -> Iterator[Value]:
    """Rest, slip, and the force that dragging takes."""
    for method in ("mortar", "node_to_segment"):
        sums = run(incline(0.58, method)).frames[-1].scalars
        yield Value(f"force up, friction 0.58, {method}", 4.0, sums["slope: force y"], 1e-9)
        yield zero(f"force across, friction 0.58, {method}", sums["slope: force x"], 1e-8)
    try:
        run(incline(0.57), ct.Static(smallest_increment=0.1))
        slides = 0.0
    except ct.ConvergenceError as error:
        slides = float("friction does not hold" in str(error))
    yield Value("refused as sliding, friction 0.57", 1.0, slides, 0.0, "absolute")
    for friction in (0.0, 0.3):
        exact = 10.0 * (0.5 - friction * 0.75**0.5)
        yield Value(
            f"acceleration down the slope, friction {friction:g}", exact, sliding(friction), 0.01
        )
    last = dragged().frames[-1].scalars
    yield Value("normal force of the dragged block", 10.0, last["pair: force y"], 1e-8)
    yield Value("friction of the dragged block", -3.0, last["pair: force x"], 2e-3)


PROBLEM = Problem(
    title="Stick and slip of a block",
    group="contact",
    source="C. A. Coulomb (1785)",
    certainty="analytic",
    why="rounding; the dragged block's surface is bent a little by the pressure",
    picture=lambda: Picture(dragged(fields=True), "S22"),
    seconds=0.5,
)

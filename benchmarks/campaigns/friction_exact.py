"""Friction against closed forms: random problems with the default settings of the program.

``python -m benchmarks friction_exact`` runs 300, ``--count 60`` the first 60, ``17`` one of them
and says what it is. Each answer is a number of the program over the exact one:

- drag, weigh: a block that slides has F = mu N; where its weight presses, up or down a slope,
  F = W (mu cos b +- sin b);
- turn: the moment of a pad on a drum is mu R times the sum of the pressures;
- rope: tensions differ by exp(mu a R / (R + t / 2)), for friction acts at the inner side;
- roll: a disc on a table turns by its way over R, one between plates by half the way of the plate;
- tip: a block tips where the slope is its width over its height;
- slide: the momentum along a table changes by mu times the impulse of the normal force, which is
  that of the weight and the change of the momentum across (a block that bounces included);
- spin: a disc that turns on a table gains mu times that impulse before it rolls.

Right is what differs by less than 1 %. Meshes are fine enough for that: blocks are pressed little,
for dents tilt the surfaces; friction on deformable drums is .25 at least. Beside CalculiX:
``python -m benchmarks friction_calculix``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import time
import warnings
from collections.abc import Callable

import numpy as np

import corota as ct
from benchmarks.common import table
from corota.model.contact import METHODS

#: Problems, and the error up to which an answer is right.
COUNT, RIGHT = 300, 0.01
#: CPU seconds from which a problem is listed.
SLOW = 10.0
#: Elements with the cells of their meshes.
ELEMENTS = {"Q4I": "quad4", "Q4D": "quad4", "Q8R": "quad8", "T6": "tri6", "OPT": "tri3"}
SCHEMES = {
    "hht": {"scheme": "hht"},
    "newmark": {"scheme": "newmark"},
    "generalized_alpha": {"scheme": "generalized_alpha", "rho_inf": 0.5},
    "energy_momentum": {"scheme": "energy_momentum"},
    "central_difference": {"scheme": "central_difference"},
}

Random = np.random.Generator
#: What was computed over what is exact, and a description.
Answer = tuple[float, str]


def _choose(rng: Random, *values: str) -> str:
    return str(rng.choice(list(values)))


def _static(rng: Random) -> tuple[ct.Static, str]:
    """A step with the default increments, with one, or with several."""
    n = int(rng.choice([0, 1, 7]))
    return (ct.Static(increments=n), f"{n} increments") if n else (ct.Static(), "default")


def _sum(results: ct.Results, at: str) -> np.ndarray:
    """Reaction of a set at the end."""
    return np.asarray(results.frames[-1].RF[results.model.mesh.nodes_of(at)].sum(axis=0))


def _block_on_table(rng: Random, element: str, mu: float, method: str) -> tuple[ct.Model, str]:
    """A block of 1 x .6 on a table of 4 x .5, or on a rigid line, and what the table is."""
    role = _choose(rng, "table slave", "table master", "rigid")
    cell, edges = ELEMENTS[element], int(rng.integers(3, 8))
    block = ct.mesh.rectangle(1.0, 0.6, edges, 3, cell, origin=(0.5, 0.5))
    if role == "rigid":
        model = ct.Model(ct.mesh.assembly(b=block))
        line = ct.RigidCurve.line((-9.0, 0.5), (9.0, 0.5))
        model.contact("b.bottom", line, friction=mu, method=method, name="c")
    else:
        low = ct.mesh.rectangle(4.0, 0.5, int(rng.integers(12, 24)), 3, cell)
        model = ct.Model(ct.mesh.assembly(b=block, t=low))
        pair = ("t.top", "b.bottom") if role == "table slave" else ("b.bottom", "t.top")
        model.contact(*pair, friction=mu, method=method, name="c")
        model.fix("t.bottom")
    return model, role


def drag(rng: Random) -> Answer:
    """A block on a table that is wider, deformable or rigid."""
    element, method = _choose(rng, *ELEMENTS), _choose(rng, *METHODS)
    mu, travel = rng.uniform(0.05, 0.5), rng.uniform(0.05, 1.4)
    model, role = _block_on_table(rng, element, mu, method)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3))
    press, (step, how) = ct.Static(), _static(rng)
    # Little: dents tilt the surfaces.
    press.fix("b.top", x=0.0, y=-0.001)
    step.fix("b.top", x=travel, y=-0.001)
    force = _sum(ct.solve(model, [press, step], threads=1), "b.top")
    return float(
        -force[0] / force[1]
    ) / mu, f"{role}, {element}, {method}, mu {mu:.2f}, by {travel:.2f}, {how}"


def past_an_end(rng: Random) -> Answer:
    """A block that is drawn past the end of a rigid line, or of a table."""
    element, method = _choose(rng, *ELEMENTS), _choose(rng, *METHODS)
    mu, travel, edges = rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.55), int(rng.integers(3, 8))
    role, cell = _choose(rng, "rigid", "table slave", "table master"), ELEMENTS[element]
    block = ct.mesh.rectangle(1.0, 0.6, edges, 3, cell, origin=(0.5, 0.5))
    if role == "rigid":
        model = ct.Model(ct.mesh.assembly(b=block))
        line = ct.RigidCurve.line((-9.0, 0.5), (1.6, 0.5))
        model.contact("b.bottom", line, friction=mu, method=method)
    else:
        low = ct.mesh.rectangle(1.6, 0.5, int(rng.integers(6, 12)), 3, cell)
        model = ct.Model(ct.mesh.assembly(b=block, t=low))
        pair = ("t.top", "b.bottom") if role == "table slave" else ("b.bottom", "t.top")
        model.contact(*pair, friction=mu, method=method)
        model.fix("t.bottom")
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3))
    press, (step, how) = ct.Static(), _static(rng)
    # The corner sinks in by the strain: its slope is part of the ratio.
    press.fix("b.top", x=0.0, y=-0.0002)
    step.fix("b.top", x=travel, y=-0.0002)
    force = _sum(ct.solve(model, [press, step], threads=1), "b.top")
    return float(
        -force[0] / force[1]
    ) / mu, f"{role}, {element}, {method}, mu {mu:.2f}, by {travel:.2f}, {how}"


def weigh(rng: Random) -> Answer:
    """A block that its weight presses, pushed up or down a slope by its upper side."""
    element, method = _choose(rng, *ELEMENTS), _choose(rng, *METHODS)
    mu, travel = rng.uniform(0.1, 0.5), float(rng.choice([-1, 1]) * rng.uniform(0.05, 0.5))
    slope = math.radians(rng.uniform(0.0, 30.0))
    model, role = _block_on_table(rng, element, mu, method)
    model.section("all", element=element, material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
    nodes = model.mesh.nodes_of("b.top")
    weight, (step, how) = ct.Static(), _static(rng)
    for s, way in ((weight, 0.0), (step, travel)):
        s.gravity(x=-10.0 * math.sin(slope), y=-10.0 * math.cos(slope), cells="b")
        s.fix(nodes, x=way, y=None)
    force = _sum(ct.solve(model, [weight, step], threads=1), "b.top")[0]
    exact = 6.0 * (math.sin(slope) + mu * math.copysign(math.cos(slope), travel))
    # Over the friction, which is not small beside the weight.
    error = (force - exact) / (6.0 * mu * math.cos(slope))
    return 1.0 + float(error), (
        f"{role}, {element}, {method}, mu {mu:.2f}, slope {math.degrees(slope):.0f}, "
        f"by {travel:.2f}, {how}"
    )


def turn(rng: Random) -> Answer:
    """A pad on a drum, which turns: the moment beside the sum of the normal forces."""
    method, mu = _choose(rng, *METHODS), rng.uniform(0.05, 0.5)
    role = _choose(rng, "rigid drum", "rigid drum", "drum master", "drum slave")
    if role != "rigid drum":
        # Facets turn the normal forces by some thousandths, which count as much as that of mu.
        mu = max(mu, 0.25)
    degrees = float(rng.choice([-1, 1]) * rng.uniform(5.0, 400.0))
    pad = ct.mesh.annulus(10.0, 12.0, 3, 8, angle=20.0, start=80.0)
    bodies = {"p": pad}
    if role != "rigid drum":
        bodies["d"] = ct.mesh.annulus(8.0, 10.0, 2, 120)
    mesh = ct.mesh.assembly(**bodies)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    if role == "rigid drum":
        circle = ct.RigidCurve.circle((0.0, 0.0), 10.0, reference=drum)
        model.contact("p.inner", circle, friction=mu, method=method, name="c")
    else:
        model.rigid("d.inner", drum)
        sides = ("p.inner", "d.outer") if role == "drum master" else ("d.outer", "p.inner")
        # Between facets the directions of nodes would differ by a degree and more.
        smooth = method == "node_to_segment"
        model.contact(*sides, friction=mu, method=method, name="c", smooth=smooth)
    press, (step, how) = ct.Static(), _static(rng)
    for s, angle in ((press, 0.0), (step, degrees)):
        s.fix("p.outer", x=0.0, y=-0.02)
        s.fix("drum", x=0.0, y=0.0, rotation=np.radians(angle))
    frame = ct.solve(model, [press, step], threads=1).frames[-1]
    # Forces of the pressures alone, node by node: the resultant of a part of an arc turns with it.
    if role == "drum slave":
        # Nodes at both ends of the pad are covered in part: the resultant of a uniform pressure.
        scalars, half = frame.scalars, np.radians(10.0)
        normal = [scalars[f"c: force {a}"] - scalars[f"c: friction {a}"] for a in "xy"]
        pressed = float(np.hypot(*normal)) * half / np.sin(half)
    else:
        nodes = mesh.nodes_of("p.inner")
        p = frame.C[nodes, 0]
        angle = np.arctan2(mesh.points[nodes, 1], mesh.points[nodes, 0])
        order = np.argsort(angle)
        weight = np.gradient(angle[order]) * 10.0
        weight[[0, -1]] *= 0.5
        pressed = float(weight @ p[order])
    exact = mu * 10.0 * pressed * np.sign(degrees)
    moment = float(frame.RF[drum, 2])
    return moment / exact, f"{role}, {method}, mu {mu:.2f}, {degrees:.0f} degrees, {how}"


def rope(rng: Random) -> Answer:
    """A thin strip around a drum, drawn over it against a force at its other end."""
    method, element = _choose(rng, *METHODS), _choose(rng, "Q4I", "Q8R")
    mu, degrees = rng.uniform(0.05, 0.4), rng.uniform(30.0, 270.0)
    step, how = _static(rng)
    ratio = tension(method, element, mu, degrees, step)
    return ratio, f"{method}, {element}, mu {mu:.2f}, {degrees:.0f} degrees, {how}"


def tension(method: str, element: str, mu: float, degrees: float, step: ct.Static) -> float:
    """Tension of the drawn end of such a strip over the exact one."""
    radius, t, pull = 1.0, 0.02, 1.0
    mesh = ct.mesh.annulus(
        radius, radius + t, 1, max(int(degrees / 3.0), 20), angle=degrees, cell=ELEMENTS[element]
    )
    end = ct.mesh.add_node(mesh, 0.0, 0.0, "wheel")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.0))
    model.rigid("end", end)
    circle = ct.RigidCurve.circle((0.0, 0.0), radius)
    model.contact("inner", circle, friction=mu, method=method)
    step.traction("start", y=-pull / t)
    # More than it stretches.
    step.fix("wheel", x=0.0, y=0.0, rotation=0.03)
    moment = ct.solve(model, step, threads=1).frames[-1].RF[end, 2]
    middle = radius + t / 2.0
    return float(moment / middle) / math.exp(mu * math.radians(degrees) * radius / middle) / pull


def roll(rng: Random) -> Answer:
    """A disc, pressed on a table and drawn along it, or between plates of which one moves."""
    method, travel = _choose(rng, *METHODS), rng.uniform(0.3, 3.0)
    press, (step, how) = ct.Static(), _static(rng)
    if rng.random() < 0.5:
        mesh = ct.mesh.rectangle(6.0, 0.5, 96, 4, origin=(-1.5, -0.5))
        disc = ct.mesh.add_node(mesh, 0.0, 1.0, "disc")
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
        model.fix("bottom")
        circle = ct.RigidCurve.circle((0.0, 1.0), 1.0, reference=disc)
        model.contact("top", circle, friction=0.5, method=method)
        press.fix("disc", x=0.0, y=-0.01)
        step.fix("disc", x=travel, y=-0.01)
        turned = -ct.solve(model, [press, step], threads=1).frames[-1].UR[disc]
        return float(turned) / travel, f"rigid disc, {method}, by {travel:.2f}, {how}"
    mesh = ct.mesh.annulus(0.5, 1.0, 3, 72)
    plate = ct.mesh.add_node(mesh, 0.0, 1.0, "plate")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3))
    upper = ct.RigidCurve.line((9.0, 1.0), (-9.0, 1.0), reference=plate)
    lower = ct.RigidCurve.line((-9.0, -1.0), (9.0, -1.0))
    for line, name in ((upper, "upper"), (lower, "lower")):
        model.contact("outer", line, friction=0.5, method=method, name=name)
    for s, way in ((press, 0.0), (step, travel)):
        s.fix("plate", x=way, y=None, rotation=True)
        # A force: on its facets the polygon is thinner than at its nodes.
        s.force("plate", y=-30.0)
    last = ct.solve(model, [press, step], threads=1).frames[-1]
    # The turn of the inner side as a rigid body.
    nodes = mesh.nodes_of("inner")
    before = mesh.points[nodes] @ [1.0, 1.0j]
    now = (mesh.points[nodes] + last.U[nodes, :2]) @ [1.0, 1.0j]
    turned = -np.angle(np.vdot(before - before.mean(), now - now.mean()))
    whole = travel / 2.0
    turned += 2.0 * np.pi * round((whole - turned) / (2.0 * np.pi))
    return float(turned) / whole, f"deformable disc, {method}, by {travel:.2f}, {how}"


def tip(rng: Random) -> Answer:
    """A block in a field that leans more and more: where equilibrium ends."""
    method, element = _choose(rng, *METHODS), _choose(rng, *ELEMENTS)
    role, n = _choose(rng, "rigid", "table slave", "table master"), int(rng.integers(1, 6))
    width, mu = rng.uniform(0.3, 0.7), rng.uniform(0.8, 1.2)
    block = ct.mesh.rectangle(width, 1.0, n, 5, ELEMENTS[element])
    bodies = {"b": block}
    if role != "rigid":
        cell = ELEMENTS[element]
        bodies["t"] = ct.mesh.rectangle(
            3.0, 0.5, int(rng.integers(9, 25)), 2, cell, origin=(-1.03, -0.5)
        )
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element=element, material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    if role == "rigid":
        line = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
        model.contact("b.bottom", line, friction=mu, method=method, name="floor")
    else:
        model.fix("t.bottom")
        pair = ("b.bottom", "t.top") if role == "table master" else ("t.top", "b.bottom")
        model.contact(*pair, friction=mu, method=method, name="floor")
    weight, lean = ct.Static(), ct.Static()
    weight.gravity(y=-1.0, cells="b")
    lean.gravity(x=1.0, cells="b")
    try:
        last = ct.solve(model, [weight, lean], threads=1).frames[-1]
    except ct.ConvergenceError as error:
        last = error.results.frames[-1]
    reached = float(last.step_time) if last.step == 2 else 0.0
    return reached / width, f"{role}, {element}, {method}, {n} edges, width {width:.2f}"


def slide(rng: Random) -> Answer:
    """A block that slides on a rigid line or on a table."""
    method, mu = _choose(rng, *METHODS), rng.uniform(0.1, 0.5)
    scheme, n = _choose(rng, *SCHEMES), int(rng.choice([0, 20, 60]))
    element = _choose(rng, *ELEMENTS)
    role = _choose(rng, "rigid", "rigid", "table slave", "table master")
    bodies = {"b": ct.mesh.rectangle(1.0, 0.5, 2, 2, ELEMENTS[element])}
    if role != "rigid":
        element = "Q4I"
        bodies = {"b": ct.mesh.rectangle(1.0, 0.5, 4, 2)}
        bodies["t"] = ct.mesh.rectangle(3.0, 0.3, 15, 2, origin=(-0.7, -0.3))
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.gravity(y=-10.0, cells="b")
    model.velocity("b", x=1.0)
    if role == "rigid":
        line = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
        model.contact("b.bottom", line, friction=mu, method=method)
    else:
        model.fix("t.bottom")
        pair = ("b.bottom", "t.top") if role == "table master" else ("t.top", "b.bottom")
        model.contact(*pair, friction=mu, method=method)
    n = 0 if scheme == "central_difference" else n
    # On a table the weight grows with time: waves would have momenta, too.
    ramp = role != "rigid"
    period = (0.16 if ramp else 0.08) / mu
    step = ct.Dynamic(period=period, increments=n, ramp=ramp, **SCHEMES[scheme])
    results = ct.solve(model, step, threads=1)
    last = results.frames[-1]
    momentum = [last.scalars[f"momentum {a}"] for a in "xy"]
    exact = mu * ((2.5 if ramp else 5.0) * period + momentum[1])
    what = f"{role}, {element}, {method}, mu {mu:.2f}, {scheme}, {n or 'automatic'} increments"
    named = next((note for note in results.notes if note.startswith("energy balance")), "")
    if named:
        return np.nan, f"{what}: {named[:90]}"
    return float((0.5 - momentum[0]) / exact), what


def spin(rng: Random) -> Answer:
    """A rigid disc that turns is laid on a table: it slides before it rolls."""
    method, mu = _choose(rng, *METHODS), rng.uniform(0.1, 0.5)
    scheme = _choose(rng, "hht", "newmark", "generalized_alpha", "energy_momentum")
    # Soft, so that the disc rests on several edges: between two nodes the floor would be a hollow.
    mesh = ct.mesh.rectangle(2.5, 0.3, 80, 4, origin=(-0.5, -0.3))
    disc = ct.mesh.add_node(mesh, 0.0, 1.0, "disc")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=5e4, nu=0.3, rho=1.0))
    model.fix("bottom")
    mass, inertia, rate = 5.0, rng.uniform(1.0, 5.0), 3.0
    model.point_mass("disc", mass, inertia=inertia)
    model.velocity("disc", spin=-rate, about=(0.0, 1.0))
    model.force("disc", y=-10.0 * mass)
    # On a floor without loss it would hop, and its slip at each landing be any.
    damping = 500.0
    model.dashpot(disc, y=damping)
    circle = ct.RigidCurve.circle((0.0, 1.0), 1.0, reference=disc)
    model.contact("top", circle, friction=mu, method=method)
    rolls = inertia * rate / (inertia + mass)
    period = float(rng.choice([0.4, 0.7, 0.9])) * rolls / (mu * 10.0)
    step = ct.Dynamic(period=period, increments=int(rng.choice([0, 40])), **SCHEMES[scheme])
    last = ct.solve(model, step, threads=1).frames[-1]
    v = last.V[disc]
    exact = mu * (mass * (10.0 * period + v[1]) + damping * last.U[disc, 1])
    count = step.increments or "automatic"
    return float(mass * v[0] / exact), f"{method}, mu {mu:.2f}, {scheme}, {count} increments"


KINDS: list[Callable[[Random], Answer]] = [
    drag,
    turn,
    slide,
    roll,
    past_an_end,
    tip,
    weigh,
    rope,
    slide,
    spin,
]


def problem(number: int) -> tuple[str, str, float, float]:
    """Kind, description, relative error and CPU seconds of a problem.

    The error is not a number where the program refused, or noted that the run gains energy.
    """
    kind = KINDS[number % len(KINDS)]
    begin = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ratio, what = kind(np.random.default_rng(number))
        error = abs(ratio - 1.0)
    except ct.CorotaError as refused:
        what, error = str(refused)[:160], np.nan
    return kind.__name__, what, error, time.process_time() - begin


def main() -> int:
    """Run them; prints those that are wrong, refused or slow, and counts by kind."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("number", nargs="?", type=int)
    parser.add_argument("--count", type=int, default=COUNT)
    parser.add_argument("--kind", help="of these only")
    chosen = parser.parse_args()
    numbers = range(chosen.count) if chosen.number is None else [chosen.number]
    if chosen.kind:
        numbers = [n for n in numbers if KINDS[n % len(KINDS)].__name__ == chosen.kind]
    answers = []
    for number in numbers:
        kind, what, error, seconds = problem(number)
        answers.append((kind, error, seconds))
        if chosen.number is not None or not error <= RIGHT or seconds > SLOW:
            result = "named" if np.isnan(error) else f"{100.0 * error:.2f} %"
            print(f"{number:4d} {kind:12s} {result:9s} {seconds:5.1f} s  {what}", flush=True)
    rows = []
    for kind in sorted({a[0] for a in answers}):
        errors = np.array([a[1] for a in answers if a[0] == kind])
        seconds = sum(a[2] for a in answers if a[0] == kind)
        right, refused = int((errors <= RIGHT).sum()), int(np.isnan(errors).sum())
        wrong = len(errors) - right - refused
        worst = f"{100.0 * np.nanmax(errors):.2f}" if refused < len(errors) else ""
        rows.append([kind, len(errors), right, refused, wrong, worst, f"{seconds:.0f}"])
    head = ["kind", "problems", "right", "refused or noted", "wrong", "largest error [%]", "CPU s"]
    print(table(head, rows))
    return min(sum(row[4] for row in rows), 63)


if __name__ == "__main__":
    raise SystemExit(main())

"""Friction against closed forms: random problems with the default settings of the program.

Blocks dragged over tables and past ends, pads on drums that turn, discs that roll, blocks that
slide to rest: F = mu N, moments, turns and decelerations within 1 %, or refused by name. A number
repeats one problem: ``python -m benchmarks.friction_exact 17``; ``--count 60`` runs fewer.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable

import numpy as np

import corota as ct
from benchmarks.common import table
from corota.model.contact import METHODS

#: Problems, and the error up to which an answer is right.
COUNT, RIGHT = 300, 0.01
#: Elements with the cells of their meshes.
ELEMENTS = {"Q4I": "quad4", "Q4D": "quad4", "Q8R": "quad8", "T6": "tri6", "OPT": "tri3"}
SCHEMES = {
    "hht": {"scheme": "hht"},
    "newmark": {"scheme": "newmark"},
    "generalized_alpha": {"scheme": "generalized_alpha", "rho_inf": 0.5},
    "energy_momentum": {"scheme": "energy_momentum"},
}

Random = np.random.Generator
#: What was computed over what is exact, and a description.
Answer = tuple[float, str]


def _static(rng: Random) -> tuple[ct.Static, str]:
    """A step with the default increments, with one, or with several."""
    n = int(rng.choice([0, 1, 7]))
    return (ct.Static(increments=n), f"{n} increments") if n else (ct.Static(), "default")


def _ratio(results: ct.Results, at: str) -> float:
    last = results.frames[-1].RF[results.model.mesh.nodes_of(at)].sum(axis=0)
    return float(last[0] / -last[1])


def drag(rng: Random) -> Answer:
    """A block on a table that is wider, deformable or rigid, or ends under the block."""
    element, method = str(rng.choice(list(ELEMENTS))), str(rng.choice(list(METHODS)))
    role = str(rng.choice(["table slave", "table master", "rigid", "past an end"]))
    mu, travel = rng.uniform(0.05, 0.5), rng.uniform(0.05, 1.4)
    cell, edges = ELEMENTS[element], int(rng.integers(3, 8))
    block = ct.mesh.rectangle(1.0, 0.6, edges, 3, cell, origin=(0.5, 0.5))
    if role.startswith("table"):
        low = ct.mesh.rectangle(4.0, 0.5, int(rng.integers(12, 24)), 3, cell)
        model = ct.Model(ct.mesh.assembly(b=block, t=low))
        pair = ("t.top", "b.bottom") if role == "table slave" else ("b.bottom", "t.top")
        model.contact(*pair, friction=mu, method=method)
        model.fix("t.bottom")
    else:
        end = 9.0
        if role == "past an end":
            end, travel = 1.6, min(travel, 0.55)
        line = ct.RigidCurve.line((-9.0, 0.5), (end, 0.5))
        model = ct.Model(ct.mesh.assembly(b=block))
        model.contact("b.bottom", line, friction=mu, method=method)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3))
    press, (step, how) = ct.Static(), _static(rng)
    # Little: dents tilt the surfaces.
    press.fix("b.top", x=0.0, y=-0.001)
    step.fix("b.top", x=travel, y=-0.001)
    found = _ratio(ct.solve(model, [press, step], threads=1), "b.top")
    return found / mu, f"{role}, {element}, {method}, mu {mu:.2f}, by {travel:.2f}, {how}"


def turn(rng: Random) -> Answer:
    """A pad on a rigid drum, which turns: the moment beside the sum of the normal forces."""
    method, mu = str(rng.choice(list(METHODS))), rng.uniform(0.05, 0.5)
    degrees = float(rng.choice([-1, 1]) * rng.uniform(5.0, 400.0))
    mesh = ct.mesh.annulus(10.0, 12.0, 3, 8, angle=20.0, start=80.0)
    drum = ct.mesh.add_node(mesh, 0.0, 0.0, "drum")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    circle = ct.RigidCurve.circle((0.0, 0.0), 10.0, reference=drum)
    model.contact("inner", circle, friction=mu, method=method, name="c")
    press, (step, how) = ct.Static(), _static(rng)
    for s, angle in ((press, 0.0), (step, degrees)):
        s.fix("outer", x=0.0, y=-0.02)
        s.fix("drum", x=0.0, y=0.0, rotation=np.radians(angle))
    frame = ct.solve(model, [press, step], threads=1).frames[-1]
    # Forces of the pressures alone, node by node: the resultant of a part of an arc turns with it.
    nodes = mesh.nodes_of("inner")
    p = frame.C[nodes, 0]
    angle = np.arctan2(mesh.points[nodes, 1], mesh.points[nodes, 0])
    order = np.argsort(angle)
    weight = np.gradient(angle[order]) * 10.0
    weight[[0, -1]] *= 0.5
    exact = mu * 10.0 * float(weight @ p[order]) * np.sign(degrees)
    return float(
        frame.RF[drum, 2]
    ) / exact, f"drum, {method}, mu {mu:.2f}, {degrees:.0f} degrees, {how}"


def roll(rng: Random) -> Answer:
    """A rigid disc, pressed on a table and drawn along it, turns by its way over its radius."""
    method, travel = str(rng.choice(list(METHODS))), rng.uniform(0.5, 3.0)
    mesh = ct.mesh.rectangle(6.0, 0.5, 96, 4, origin=(-1.5, -0.5))
    disc = ct.mesh.add_node(mesh, 0.0, 1.0, "disc")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("bottom")
    circle = ct.RigidCurve.circle((0.0, 1.0), 1.0, reference=disc)
    model.contact("top", circle, friction=0.5, method=method)
    press, (step, how) = ct.Static(), _static(rng)
    press.fix("disc", x=0.0, y=-0.01)
    step.fix("disc", x=travel, y=-0.01)
    found = -ct.solve(model, [press, step], threads=1).frames[-1].UR[disc]
    return float(found) / travel, f"disc, {method}, by {travel:.2f}, {how}"


def slide(rng: Random) -> Answer:
    """A block that slides on a rigid line loses mu g t of its speed."""
    method, mu = str(rng.choice(list(METHODS))), rng.uniform(0.1, 0.5)
    scheme, n = str(rng.choice(list(SCHEMES))), int(rng.choice([20, 60]))
    element = str(rng.choice(list(ELEMENTS)))
    mesh = ct.mesh.rectangle(1.0, 0.5, 2, 2, ELEMENTS[element])
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    model.gravity(y=-10.0)
    model.velocity(x=1.0)
    line = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
    model.contact("bottom", line, friction=mu, method=method)
    step = ct.Dynamic(period=0.08 / mu, increments=n, **SCHEMES[scheme])
    last = ct.solve(model, step, threads=1, fields=False).frames[-1]
    lost = 1.0 - last.scalars["momentum x"] / 0.5
    return float(lost / 0.8), f"motion, {element}, {method}, mu {mu:.2f}, {scheme}, {n} increments"


KINDS: list[Callable[[Random], Answer]] = [drag, turn, drag, roll, drag, slide]


def problem(number: int) -> tuple[str, str, float, float]:
    """Kind, description, relative error (not a number if refused) and CPU seconds of a problem."""
    kind = KINDS[number % len(KINDS)]
    begin = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found, what = kind(np.random.default_rng(number))
        error = abs(found - 1.0)
    except ct.CorotaError as refused:
        what, error = str(refused)[:160], np.nan
    return kind.__name__, what, error, time.process_time() - begin


def main() -> int:
    """Run them; prints those that are wrong or refused, and counts by kind."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", nargs="?", type=int)
    parser.add_argument("--count", type=int, default=COUNT)
    chosen = parser.parse_args()
    numbers = range(chosen.count) if chosen.number is None else [chosen.number]
    found = []
    for number in numbers:
        kind, what, error, seconds = problem(number)
        found.append((kind, error, seconds))
        if chosen.number is not None or not error <= RIGHT:
            result = "refused" if np.isnan(error) else f"{100.0 * error:.2f} %"
            print(f"{number:4d} {kind:6s} {result:9s} {seconds:5.1f} s  {what}", flush=True)
    rows = []
    for kind in sorted({f[0] for f in found}):
        errors = np.array([f[1] for f in found if f[0] == kind])
        seconds = sum(f[2] for f in found if f[0] == kind)
        right, refused = int((errors <= RIGHT).sum()), int(np.isnan(errors).sum())
        rows.append(
            [kind, len(errors), right, refused, len(errors) - right - refused, f"{seconds:.0f}"]
        )
    print(table(["kind", "problems", "right", "refused", "wrong", "CPU s"], rows))
    return min(sum(row[4] for row in rows), 63)


if __name__ == "__main__":
    raise SystemExit(main())

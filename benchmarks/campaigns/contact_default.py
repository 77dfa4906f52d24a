"""Both contact methods on problems with known answers, with default increments.

One of them is the default: ``python -m benchmarks contact_default`` prints what each finds over
what is exact; ``--write`` puts the table into docs/contact.md. Sources: patch test of Taylor and
Papadopoulos; Hertz; ring between plates, F = d E I / (.14878 R^3); tipping at width over height; a
rope round a drum, exp(mu a R / (R + t / 2)); Cattaneo and Mindlin, c / a = sqrt(1 - Q / mu P).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.campaigns.friction_exact import ELEMENTS, tension
from benchmarks.common import machine, table, write_between
from benchmarks.studies.contact_sawtooth import jagged
from corota.model.contact import METHODS
from corota.verification.contact_models import ellipse_of
from corota.verification.problems import contact_patch
from corota.verification.problems.konter_roller import hertz, pressures, roller

PAGE = Path(__file__).resolve().parents[2] / "docs" / "contact.md"
#: Ring, its thickness and modulus, and by how much it is squeezed.
RADIUS, THICK, YOUNG, SQUEEZE = 10.0, 0.4, 1e5, 0.05


def patch(method: str, element: str) -> float:
    """Largest error of a uniform stress between meshes that do not match, over the pressure."""
    results = contact_patch.solved(element, element, 0.0, method=method)
    return float(np.ptp(contact_patch.stresses(results, 0.0)[:, 1])) / contact_patch.PRESSURE


def peak(method: str, element: str, n: int) -> float:
    """Peak pressure of a roller on a block, n cells to the side, over that of Hertz."""
    results = roller(n, element, "strain", method=method)
    return ellipse_of(*pressures(results))[1] / hertz(35e3, "strain")[1]


def ring(method: str, element: str, rounds: float, side: str) -> float:
    """Force of a ring between plates (radius 0), cylinders (> 0) or hollows, over that of theory.

    The rounds are rigid, or stiff bodies that are the master or the slave (`side`).
    """
    mesh = ct.mesh.annulus(RADIUS - THICK / 2, RADIUS + THICK / 2, 2, 80, cell=ELEMENTS[element])
    top, around = RADIUS + THICK / 2, abs(rounds)
    center = top + rounds
    if side == "rigid":
        hold = ct.mesh.add_node(mesh, 0.0, 12.0, "tool")
        first, sweep = (330.0, -120.0) if rounds > 0.0 else (30.0, 120.0)
        if rounds:
            upper = ct.RigidCurve.arc((0.0, center), around, first, sweep, reference=hold)
            lower = ct.RigidCurve.arc((0.0, -center), around, first + 180.0, sweep)
        else:
            upper = ct.RigidCurve.line((30.0, top), (-30.0, top), reference=hold)
            lower = ct.RigidCurve.line((-30.0, -top), (30.0, -top))
        model = ct.Model(mesh)
        for curve, name in ((upper, "upper"), (lower, "lower")):
            model.contact("outer", curve, friction=0.3, method=method, name=name)
        model.fix("tool", x=0.0, y=-SQUEEZE, rotation=True)
    else:
        tools = {}
        for name, sign in (("upper", 1.0), ("lower", -1.0)):
            if rounds:
                inner, face = (around - 1.0, "outer") if rounds > 0.0 else (around, "inner")
                angle, middle = (
                    math.degrees(6.0 / around),
                    -90.0 * math.copysign(sign, sign * rounds),
                )
                part = ct.mesh.annulus(
                    inner, inner + 1.0, 2, 80, angle=angle, start=middle - angle / 2
                )
                tools[name] = ct.mesh.move(part, (0.0, sign * center))
            else:
                face = {"upper": "bottom", "lower": "top"}[name]
                low = top if sign > 0.0 else -top - 1.0
                tools[name] = ct.mesh.rectangle(6.0, 1.0, 80, 2, origin=(-3.0, low))
        mesh = ct.mesh.assembly(ring=mesh, **tools)
        model = ct.Model(mesh)
        for name, sign in (("upper", -1.0), ("lower", 0.0)):
            if not rounds:
                face = {"upper": "bottom", "lower": "top"}[name]
            model.section(name, element="Q4I", material=ct.Elastic(E=1e9, nu=0.0))
            pair = ["ring.outer", f"{name}.{face}"]
            surfaces = pair if side == "master" else pair[::-1]
            model.contact(*surfaces, friction=0.3, method=method, name=name)
            model.fix(mesh.nodes_of(name), x=0.0, y=sign * SQUEEZE)
    cells = "all" if side == "rigid" else "ring"
    model.section(cells, element=element, material=ct.Elastic(E=YOUNG, nu=0.0))
    force = ct.solve(model, ct.Static(), threads=1).frames[-1].scalars["upper: force y"]
    return abs(force) * 12.0 * 0.14878 * RADIUS**3 / (SQUEEZE * YOUNG * THICK**3)


def tipping(method: str, n: int, floor: str) -> float:
    """Inclination at which a block of n elements tips, over its width over its height."""
    bodies = {"b": ct.mesh.rectangle(0.5, 1.0, n, 2 * n)}
    if floor != "rigid":
        bodies["t"] = ct.mesh.rectangle(3.0, 0.5, 11, 2, origin=(-1.03, -0.5))
    model = ct.Model(ct.mesh.assembly(**bodies))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e7, nu=0.0, rho=1.0))
    if floor == "rigid":
        line = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
        model.contact("b.bottom", line, friction=0.9, method=method)
    else:
        model.fix("t.bottom")
        pair = ("b.bottom", "t.top") if floor == "master" else ("t.top", "b.bottom")
        model.contact(*pair, friction=0.9, method=method)
    weight, lean = ct.Static(), ct.Static()
    weight.gravity(y=-1.0, cells="b")
    lean.gravity(x=1.0, cells="b")
    try:
        last = ct.solve(model, [weight, lean], threads=1).frames[-1]
    except ct.ConvergenceError as error:
        last = error.results.frames[-1]
    return (float(last.step_time) if last.step == 2 else 0.0) / 0.5


def rope(method: str, degrees: float) -> float:
    """Tension behind a drum over the exact one."""
    return tension(method, "Q8R", 0.3, degrees, ct.Static())


def stick(method: str, n: int) -> float:
    """Half width of the part that sticks under a shear of about half of mu P, over the exact one.

    Two equal bodies of 2 x 1, one with a radius of 40, n slave edges to the half width.
    """
    mu, radius, young, half = 0.3, 40.0, 1e4, 0.1
    edge = half / n
    # Edges of one size where bodies touch, which grow outside.
    inside = np.arange(-int(2.0 * n), int(2.0 * n) + 1) * edge
    outside = inside[-1] + (1.0 - inside[-1]) * np.linspace(0.0, 1.0, 9)[1:] ** 1.6
    x = np.concatenate([-outside[::-1], inside, outside])
    depth = np.concatenate(
        [np.linspace(0.0, 0.2, n + 1), 0.2 + 0.8 * np.linspace(0.0, 1.0, 7)[1:] ** 1.4]
    )
    bodies = {}
    for name, sign in (("u", 1.0), ("l", -1.0)):
        body = ct.mesh.rectangle(1.0, 1.0, len(x) - 1, len(depth) - 1)
        column = np.rint(body.points[:, 0] * (len(x) - 1)).astype(int)
        row = np.rint(body.points[:, 1] * (len(depth) - 1)).astype(int)
        level = depth[row] if sign > 0.0 else -depth[::-1][row]
        bodies[name] = body
        # The lower one is shifted by a third of an edge, so that nodes are not opposite.
        body.points[:, 0] = x[column] + (0.0 if sign > 0.0 else edge / 3.0)
        body.points[:, 1] = level
        if sign > 0.0:
            body.points[:, 1] += x[column] ** 2 / (2.0 * radius) * (1.0 - level)
    mesh = ct.mesh.assembly(**bodies)
    top = ct.mesh.add_node(mesh, 0.0, 1.0, "top")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=young, nu=0.3), plane="strain")
    model.fix("l.bottom")
    model.rigid("u.top", top)
    model.contact("u.bottom", "l.top", friction=mu, method=method, name="c")
    modulus = young / (2.0 * (1.0 - 0.3**2))
    load = math.pi * modulus * half**2 / (4.0 * radius)
    press = ct.Static()
    press.fix("top", x=0.0, y=None, rotation=True)
    press.force("top", y=-load)
    approach = float(ct.solve(model, press, threads=1).frames[-1].U[top, 1])
    shear = ct.Static()
    shear.fix("top", x=-0.9 * mu * approach, y=None, rotation=True)
    shear.force("top", y=-load)
    frame = ct.solve(model, [press, shear], threads=1).frames[-1]
    part = abs(frame.scalars["c: force x"] / (mu * frame.scalars["c: force y"]))
    nodes = mesh.nodes_of("u.bottom")
    state, place = frame.C[nodes, 4], mesh.points[nodes, 0]
    sticks = np.abs(place[state == 1.0])
    # The fitted half width, for the bodies are no half planes; zones end between two nodes.
    a = ellipse_of(np.abs(place), frame.C[nodes, 0])[0]
    c = float(sticks.max(initial=0.0)) + 0.5 * edge
    return c / a / math.sqrt(1.0 - part)


def sawtooth(method: str, smooth: bool) -> float:
    """Departure of the force of a coarse catch from a smooth curve, over the largest force."""
    return jagged(method, smooth)[0]


#: Rounds that a ring is squeezed between, by their radius.
ROUNDS = {
    0.0: "plates",
    **{-radius: f"hollows {radius:g}" for radius in (100.0, 30.0, 15.0)},
    **{radius: f"cylinders {radius:g}" for radius in (100.0, 30.0, 15.0)},
}
#: Name, exact value, function and its arguments.
CASES: list[tuple[str, str, Callable[..., float], tuple[Any, ...]]] = [
    *((f"patch test, {e}: largest error of the stress", "0", patch, (e,)) for e in ("Q4I", "Q8R")),
    *(
        (f"Hertz, peak pressure, {e}, {n} x {n}", "1", peak, (e, n))
        for e in ("Q4I", "Q8R")
        for n in (10, 20, 40)
    ),
    *(
        (f"ring {e}, {what}, {side}", "1", ring, (e, radius, side))
        for e in ("Q4I", "Q8R")
        for radius, what in ROUNDS.items()
        for side in ("rigid", "master", "slave")
    ),
    *(
        (f"tipping, {n} elements, floor {floor}", "1", tipping, (n, floor))
        for n in (1, 2, 4)
        for floor in ("rigid", "master", "slave")
    ),
    *((f"rope round {a:g} degrees", "1", rope, (a,)) for a in (30.0, 90.0, 180.0, 270.0)),
    *((f"stick zone, Cattaneo and Mindlin, {n} edges to a", "1", stick, (n,)) for n in (6, 12)),
    ("force of a coarse catch: departure from a smooth curve", "0", sawtooth, (False,)),
    ("the same with smooth=True", "0", sawtooth, (True,)),
]


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", help="parts of names; all if there are none")
    parser.add_argument("--write", action="store_true", help="put the table into docs/contact.md")
    chosen = parser.parse_args()
    rows = []
    for name, exact, case, arguments in CASES:
        if chosen.names and not any(part in name for part in chosen.names):
            continue
        values, begin = [], time.process_time()
        for method in METHODS:
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    values.append(f"{case(method, *arguments):.4g}")
            except ct.CorotaError as error:
                values.append(f"stops: {str(error)[:50]}")
        rows.append([name, exact, *values])
        print(" | ".join([*rows[-1], f"{time.process_time() - begin:.1f} s"]), flush=True)
    text = table(["problem", "exact", *METHODS], rows)
    print(text)
    if chosen.write:
        said = f"`python -m benchmarks contact_default --write`, {machine()}"
        write_between(PAGE, "default", f"{said}\n\n{text}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

"""Checks of static contact against closed forms, written from the pages alone.

Run by ``python -m benchmarks contact_audit``. A check yields rows of a variant, the answer of the
program, the exact one and a tolerance (of the exact one; of 1 where that is 0), which was stated
before the first run. An answer to "does it stop, and with the right reason" is 1 or 0.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.model.contact import METHODS

Row = tuple[str, float, float, float]
Check = Callable[[], Iterator[Row]]
#: All checks by name, and those with friction.
CHECKS: dict[str, Check] = {}
WITH_FRICTION: set[str] = set()
#: Elements of solids with the cells of their meshes.
CELLS = {
    **dict.fromkeys(("T3", "OPT"), "tri3"),
    **dict.fromkeys(("Q4", "Q4I", "Q4R", "Q4D", "Q4S"), "quad4"),
    **dict.fromkeys(("Q8", "Q8R"), "quad8"),
    "T6": "tri6",
    "Q9": "quad9",
}


def check(*, friction: bool) -> Callable[[Check], Check]:
    """Register a check."""

    def register(function: Check) -> Check:
        name = function.__name__
        CHECKS[name] = function
        if friction:
            WITH_FRICTION.add(name)
        return function

    return register


def box(
    element: str, lx: float, ly: float, nx: int, ny: int, at: tuple[float, float] = (0.0, 0.0)
) -> ct.Mesh:
    """Rectangle of the cells of an element."""
    return ct.mesh.rectangle(lx, ly, nx, ny, cell=CELLS[element], origin=at)


def solids(element: str | dict[str, str], E: float = 1e5, **bodies: Any) -> ct.Model:
    """Elastic bodies, each of its element, or all of the same."""
    model = ct.Model(ct.mesh.assembly(**bodies))
    for body in bodies:
        name = element if isinstance(element, str) else element[body]
        model.section(body, element=name, material=ct.Elastic(E=E, nu=0.3))
    return model


def sprung_block(element: str) -> ct.Model:
    """A block 1 x .5 at the end of a spring of stiffness 20, whose other end is held."""
    spring = ct.mesh.line([(1.0, 0.25), (2.0, 0.25)], 1, "spring")
    mesh = ct.mesh.merge(box(element, 1.0, 0.5, 4, 2), spring)
    mesh.cell_sets["block"] = np.arange(mesh.n_cells - 1)
    model = ct.Model(mesh)
    model.section("block", element=element, material=ct.Elastic(E=1e5, nu=0.3))
    model.spring("spring", 20.0)
    model.fix("spring.end")
    return model


def pull(results: ct.Results, pair: str, of: str = "force x") -> float:
    """Last value of a history of a pair."""
    return float(results.history(f"{pair}: {of}")[-1])


def stops(model: ct.Model, step: Any, *words: str) -> float:
    """1 if the run stops with one of the words in its message, else 0."""
    try:
        ct.solve(model, step)
    except (ct.ConvergenceError, ct.SingularError, ct.ModelError) as error:
        return float(any(word in str(error) for word in words))
    return 0.0


def largest_factor(model: ct.Model, steps: Any) -> float:
    """Load factor of the last step where a body slides, which the message has to name."""
    try:
        ct.solve(model, steps)
    except ct.ConvergenceError as error:
        if "slide" not in str(error) or error.results is None:
            raise
        return float(error.results.history("load factor")[-1])
    return math.inf


def variants(*lists: Any) -> Iterator[tuple[Any, ...]]:
    """All combinations with both methods."""
    return itertools.product(METHODS, *lists)


# --- blocks and bars ------------------------------------------------------------------------------


@check(friction=True)
def wedge_between_two_walls() -> Iterator[Row]:
    """Driven in, a wedge of half angle a presses with tan(a + f), drawn out with tan(a - f)."""
    half, mu = math.radians(10.0), 0.3
    slope, angle = math.tan(half), math.atan(mu)
    for method, element in variants(("Q4I", "T6")):
        sides = [(-0.5, 0.0), (0.5, 0.0), (0.5 + slope, 1.0), (-0.5 - slope, 1.0)]
        model = solids(element, wedge=ct.mesh.mapped(sides, 8, 8, cell=CELLS[element]))
        low, high = np.array(sides[1]), np.array(sides[2])
        reach = high - low
        right = ct.RigidCurve.line(low - reach, high + reach)
        mirror = np.array([-1.0, 1.0])
        left = ct.RigidCurve.line((high + reach) * mirror, (low - reach) * mirror)
        for side, curve in (("right", right), ("left", left)):
            model.contact(f"wedge.{side}", curve, friction=mu, method=method, name=side)
        drive, draw = ct.Static(), ct.Static()
        model.fix(np.flatnonzero(np.hypot(*(model.mesh.points - [0.0, 1.0]).T) < 1e-9), y=None)
        drive.fix("wedge.top", x=None, y=-0.01)
        draw.fix("wedge.top", x=None, y=-0.006)
        results = ct.solve(model, [drive, draw])
        x, y = (results.history(f"right: force {c}") for c in "xy")
        ends = [int(np.flatnonzero(results.history("step") == k)[-1]) for k in (1, 2)]
        yield f"{method} {element} in", -y[ends[0]] / x[ends[0]], math.tan(half + angle), 0.01
        yield f"{method} {element} out", -y[ends[1]] / x[ends[1]], math.tan(half - angle), 0.01


@check(friction=True)
def drawer_jams_between_rails() -> Iterator[Row]:
    """A drawer of depth h, pushed at the distance e from its middle, jams from mu = h / 2e on."""
    for method, (mu, jams) in variants(((0.26, True), (0.24, False))):
        mesh = box("Q4I", 2.0, 0.5, 16, 4)
        x, y = mesh.points.T
        mesh.node_sets["corner left"] = np.flatnonzero((x == 0.0) & (y == 0.0))
        mesh.node_sets["corner right"] = np.flatnonzero((x == 2.0) & (y == 0.5))
        model = solids("Q4I", drawer=mesh)
        rails = {
            "left": ct.RigidCurve.line((0.0, 3.0), (0.0, -3.0)),
            "right": ct.RigidCurve.line((2.0, -3.0), (2.0, 3.0)),
        }
        for side, rail in rails.items():
            model.contact(f"drawer.corner {side}", rail, friction=mu, method=method, name=side)
        model.force("drawer.right", y=-1.0)
        if jams:
            results = ct.solve(model)
            left, right = (pull(results, side, "friction y") for side in ("left", "right"))
            normal = pull(results, "left")
            yield f"{method} bound", float(max(left, right) <= mu * normal), 1.0, 0.0
            yield f"{method} normal force", normal, 2.0 * (1.0 + left - right), 0.01
        else:
            yield f"{method} slides", stops(model, ct.Static(), "slide"), 1.0, 0.0


@check(friction=True)
def ladder_on_rough_floor_and_wall() -> Iterator[Row]:
    """A beam under its weight stands from tan(angle) = (1 - mu^2) / 2 mu on."""
    mu = 0.4
    limit = math.degrees(math.atan((1.0 - mu**2) / (2.0 * mu)))
    for method, stands in variants((True, False)):
        angle = math.radians(limit + (1.5 if stands else -1.5))
        foot, head = (math.cos(angle), 0.0), (0.0, math.sin(angle))
        model = ct.Model(ct.mesh.line([foot, head], n=8))
        model.beam("all", material=ct.Elastic(E=1e6), area=0.01, inertia=1e-5)
        model.line_load(y=-1.0)
        floor = ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
        wall = ct.RigidCurve.line((0.0, 3.0), (0.0, -1.0))
        model.contact(model.mesh.node_sets["start"], floor, friction=mu, method=method, name="foot")
        model.contact(model.mesh.node_sets["end"], wall, friction=mu, method=method, name="head")
        if stands:
            results = ct.solve(model)
            weight = pull(results, "foot", "force y") + pull(results, "head", "force y")
            yield f"{method} stands, weight", weight, 1.0, 1e-6
        else:
            yield f"{method} slides", stops(model, ct.Static(), "slide"), 1.0, 0.0


@check(friction=True)
def tongs_hold_a_block() -> Iterator[Row]:
    """Two jaws that press with P hold a weight of 2 mu P, and no more."""
    mu, press = 0.25, 10.0
    for method, element, swapped in variants(("Q4I", "Q8R", "OPT"), (False, True)):
        model = solids(
            element,
            left=box(element, 0.5, 1.0, 2, 5, (-0.5, 0.0)),
            block=box(element, 1.0, 1.0, 4, 4),
            right=box(element, 0.5, 1.0, 2, 5, (1.0, 0.0)),
        )
        for jaw, near in (("left", "right"), ("right", "left")):
            pair = [f"{jaw}.{near}", f"block.{jaw}"]
            slave, master = pair[::-1] if swapped else pair
            model.contact(slave, master, friction=mu, method=method, name=jaw)
        model.fix("left.left")
        model.fix("right.right", x=None, y=0.0)
        model.force("right.right", x=-press)
        hold, lift = ct.Static(), ct.Static()
        lift.force("block.bottom", y=-2.4 * mu * press)
        held = largest_factor(model, [hold, lift]) * 1.2
        yield f"{method} {element}{' swapped' if swapped else ''}", held, 1.0, 2e-3


@check(friction=True)
def disc_turned_in_a_corner() -> Iterator[Row]:
    """A disc between floor and wall needs the torque mu W R (1 + mu) / (1 + mu^2)."""
    for method, (mu, turn) in variants(((0.2, 0.5), (0.6, 3.0))):
        floor = box("Q4I", 2.0, 0.4, 40, 8, (-1.0, -0.4))
        wall = box("Q4I", 0.4, 2.0, 8, 40, (-1.4, 0.0))
        mesh = ct.mesh.assembly(floor=floor, wall=wall)
        ct.mesh.add_node(mesh, 0.0, 1.0, "disc")
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
        model.fix("floor.bottom")
        model.fix("wall.left")
        disc = ct.RigidCurve.circle((0.0, 1.0), 1.0, reference="disc")
        model.contact("floor.top", disc, friction=mu, method=method, name="floor")
        model.contact("wall.right", disc, friction=mu, method=method, name="wall")
        model.fix("disc", x=None, y=None, rotation=turn)
        model.force("disc", y=-1.0)
        results = ct.solve(model)
        torque = float(results.history("RM3", at="disc")[-1])
        exact = mu * (1.0 + mu) / (1.0 + mu**2)
        yield f"{method} mu {mu}, {turn} rad", torque, exact, 0.01


@check(friction=True)
def stack_of_three_under_side_forces() -> Iterator[Row]:
    """Each joint carries all side forces above it, until the first one slides."""
    for method, element, swapped in variants(("Q4I", "T6"), (False, True)):
        for share in (0.97, 1.03):
            model = solids(
                element,
                a=box(element, 2.0, 0.4, 5, 2),
                b=box(element, 2.0, 0.4, 7, 2, (0.0, 0.4)),
                c=box(element, 2.0, 0.4, 4, 2, (0.0, 0.8)),
            )
            floor = ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
            model.contact("a.bottom", floor, friction=0.3, method=method, name="floor")
            for lower, upper in ("ab", "bc"):
                slave, master = f"{upper}.bottom", f"{lower}.top"
                if swapped:
                    slave, master = master, slave
                model.contact(slave, master, friction=0.3, method=method, name=upper)
            model.force("c.top", y=-10.0)
            for body, force in (("c", 0.5), ("b", 1.0), ("a", 1.5 * share)):
                model.force(f"{body}.left", x=force)
            name = f"{method} {element}{' swapped' if swapped else ''} {share}"
            if share < 1.0:
                results = ct.solve(model)
                sign = -1.0 if swapped else 1.0
                for pair, exact in (("floor", -1.5 - 1.5 * share), ("b", -1.5), ("c", -0.5)):
                    factor = 1.0 if pair == "floor" else sign
                    yield f"{name} {pair}", factor * pull(results, pair), exact, 1e-6
            else:
                yield f"{name} slides", stops(model, ct.Static(), "slide"), 1.0, 0.0


@check(friction=True)
def column_with_an_inclined_joint() -> Iterator[Row]:
    """It fails at s1 / s3 = tan b (cos b + mu sin b) / (sin b - mu cos b) (Jaeger)."""
    mu, side = 0.3, 2.0
    for method, (lower, upper), degrees in variants(
        (("Q4I", "Q4I"), ("Q8R", "T3"), ("Q4D", "Q9"), ("Q4R", "Q8")), (30.0, 45.0)
    ):
        b = math.radians(degrees)
        rise = 0.5 * math.tan(b)
        low = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0 + rise), (0.0, 1.0 - rise)]
        high = [(0.0, 1.0 - rise), (1.0, 1.0 + rise), (1.0, 2.0), (0.0, 2.0)]
        model = solids(
            {"a": lower, "b": upper},
            a=ct.mesh.mapped(low, 5, 6, cell=CELLS[lower]),
            b=ct.mesh.mapped(high, 4, 5, cell=CELLS[upper]),
        )
        model.contact("b.bottom", "a.top", friction=mu, method=method, name="joint")
        model.fix("a.bottom", x=None, y=0.0)
        model.fix([0], x=0.0, y=0.0)
        model.fix("b.top", x=None, y=-0.0005)
        for body, edge in itertools.product("ab", ("left", "right")):
            model.pressure(f"{body}.{edge}", side)
        results = ct.solve(model, ct.Static(nlgeom=False))
        axial = -float(results.history("RF2", at="b.top")[-1])
        exact = side * math.tan(b) * (math.cos(b) + mu * math.sin(b))
        exact /= math.sin(b) - mu * math.cos(b)
        tolerance = 2e-3 if method == "mortar" else 0.02
        yield f"{method} {lower}/{upper} {degrees:.0f}", axial, exact, tolerance


@check(friction=True)
def shear_limit_and_coefficients_by_pressure() -> Iterator[Row]:
    """A flat strip slides at min(mu p, limit) A, or at mu(p) p A."""
    table = ct.FrictionTable([(0.4, 0.0, 1.0), (0.2, 0.0, 5.0)])
    laws: list[tuple[str, dict[str, Any], float, float]] = [
        ("limit", {"friction": 0.5, "shear_limit": 1.2}, 4.0, 1.2),
        ("below limit", {"friction": 0.5, "shear_limit": 1.2}, 2.0, 1.0),
        ("table", {"friction": table}, 3.0, 0.9),
        ("table, beyond", {"friction": table}, 8.0, 1.6),
    ]
    for method, (name, options, p, q) in variants(laws):
        model = solids("Q4I", strip=box("Q4I", 4.0, 0.1, 20, 2))
        floor = ct.RigidCurve.line((-2.0, 0.0), (8.0, 0.0))
        model.contact("strip.bottom", floor, method=method, name="floor", **options)
        model.pressure("strip.top", p)
        press, draw = ct.Static(), ct.Static()
        draw.fix("strip.right", x=0.5, y=None)
        results = ct.solve(model, [press, draw])
        yield f"{method} {name}", -pull(results, "floor"), q * 4.0, 2e-3


@check(friction=True)
def spring_held_by_friction_that_falls() -> Iterator[Row]:
    """A sprung block that friction holds goes back to the force of the smaller coefficient."""
    for method, element in variants(("Q4I", "Q8")):
        model = sprung_block(element)
        floor = ct.RigidCurve.line((-2.0, 0.0), (8.0, 0.0))
        model.contact(
            "bottom", floor, friction=0.3, friction_steps={3: 0.1}, method=method, name="floor"
        )
        model.force("top", y=-10.0)
        push, release, ease = ct.Static(), ct.Static(), ct.Static()
        push.force("left", x=9.0)
        release.force("left", x=0.0)
        results = ct.solve(model, [push, release, ease])
        friction = results.history("floor: friction x")
        ends = [int(np.flatnonzero(results.history("step") == k)[-1]) for k in (1, 2, 3)]
        for k, exact in enumerate((-3.0, 3.0, 1.0)):
            yield f"{method} {element} step {k + 1}", float(friction[ends[k]]), exact, 2e-3


@check(friction=True)
def wheel_climbs_a_step() -> Iterator[Row]:
    """The force at the axle is W (x / y) of the corner seen from the axle."""
    radius, height, weight = 1.0, 0.3, 10.0
    for method, element, way in variants(("Q4I", "Q8R"), (0.01, 0.2)):
        ring = ct.mesh.annulus(0.3, radius, 6, 120, cell=CELLS[element], center=(0.0, radius))
        ct.mesh.add_node(ring, 0.0, radius, "axle")
        model = ct.Model(ring)
        model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.3))
        model.rigid("inner", "axle")
        corner = math.sqrt(radius**2 - (radius - height) ** 2)
        steps = [(-3.0, 0.0), (corner, 0.0), (corner, height), (3.0, height)]
        model.contact(
            "outer", ct.RigidCurve.polyline(steps), friction=1.2, method=method, name="step"
        )
        model.fix("axle", x=way, y=None)
        model.force("axle", y=-weight)
        results = ct.solve(model)
        x = corner - way
        exact = weight * x / math.sqrt(radius**2 - x**2)
        force = float(results.frames[-1].RF[ring.node_sets["axle"][0], 0])
        yield f"{method} {element} {way}", force, exact, 0.01


@check(friction=True)
def disc_nipped_between_two_plates() -> Iterator[Row]:
    """Plates that close at an angle 2a hold a disc if mu > tan a, else they squeeze it out."""
    half = math.radians(12.0)
    for method, share in variants((1.1, 0.9)):
        mesh = ct.mesh.annulus(0.2, 1.0, 6, 90)
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
        # The plates open to the right; their normals lean by the half angle.
        for name, sign in (("upper", 1.0), ("lower", -1.0)):
            normal = np.array([-math.sin(half), sign * math.cos(half)])
            along = np.array([math.cos(half), sign * math.sin(half)])
            node = ct.mesh.add_node(mesh, *normal, name)
            ends = (normal - 3.0 * along, normal + 3.0 * along)
            plate = ct.RigidCurve.line(*(ends[::-1] if sign > 0.0 else ends), reference=node)
            model.contact("outer", plate, friction=share * math.tan(half), method=method, name=name)
            model.fix(name, x=0.0, y=-0.01 * sign, rotation=True)
        if share > 1.0:
            results = ct.solve(model)
            yield f"{method} pressed", float(pull(results, "lower", "force y") > 1.0), 1.0, 0.0
            yield f"{method} balance", pull(results, "lower"), 0.0, 1e-6
        else:
            words = ("slide", "nothing holds", "free")
            yield f"{method} squeezed out", stops(model, ct.Static(), *words), 1.0, 0.0


# --- ropes and belts ------------------------------------------------------------------------------


def wire(mesh: ct.Mesh, E: float = 1e6) -> ct.Model:
    """Beam of hardly any bending stiffness and thickness."""
    model = ct.Model(mesh)
    model.beam("all", material=ct.Elastic(E=E), area=1e-3, inertia=1e-4 / E)
    return model


def arc_points(center: Any, radius: float, start: float, end: float, n: int) -> list[Any]:
    """Points of an arc between two angles [degrees]."""
    angles = np.radians(np.linspace(start, end, n + 1))
    return list(np.asarray(center) + radius * np.column_stack((np.cos(angles), np.sin(angles))))


@check(friction=True)
def rope_over_a_bar_pulled_and_let_back() -> Iterator[Row]:
    """Tensions T exp(mu a) while it is drawn, T exp(-mu a) while it is let back."""
    mu = 0.25
    for method, n in variants((24, 48)):
        points = arc_points((0.0, 0.0), 1.0, 180.0, 0.0, n)
        spans = [n // 3, *[1] * n, n // 3]
        model = wire(ct.mesh.line([(-1.0, -1.0), *points, (1.0, -1.0)], n=spans))
        bar = ct.RigidCurve.circle((0.0, 0.0), 1.0)
        model.contact("all", bar, friction=mu, method=method, name="bar")
        model.fix("start", x=0.0, y=None)
        model.force("start", y=-1.0)
        results = []
        for ways in ((0.1,), (0.1, 0.05)):
            steps = [ct.Static() for _ in ways]
            for step, way in zip(steps, ways, strict=True):
                step.fix("end", x=0.0, y=-way)
            results.append(ct.solve(model, steps))
        end = model.mesh.node_sets["end"][0]
        for result, sign in zip(results, (1.0, -1.0), strict=True):
            pulled = -float(result.frames[-1].RF[end, 1])
            yield f"{method} {n} chords", pulled, math.exp(sign * mu * math.pi), 0.02


@check(friction=True)
def rope_in_zigzag_round_three_bars() -> Iterator[Row]:
    """Bars on both sides of a rope multiply its tension by exp(mu times all angles)."""
    mu, lean = 0.2, 40.0
    for method, n in variants((8, 16)):
        angles = ((90.0, 90.0 - lean), (-90.0 - lean, -90.0 + lean), (90.0 + lean, 90.0))
        place, points, spans, centers = np.zeros(2), [np.array([-1.0, 0.0])], [n], []
        for k, (first, last) in enumerate(angles):
            center = place - [math.cos(math.radians(first)), math.sin(math.radians(first))]
            centers.append(center)
            chords = n if k == 1 else n // 2
            turn = arc_points(center, 1.0, first, last, chords)
            points += turn
            sign = -1.0 if k == 1 else 1.0
            radius = (turn[-1] - center) * sign
            place = turn[-1] + 1.5 * np.array([radius[1], -radius[0]])
            spans += [*[1] * chords, n]
        points.append(points[-1] + [1.0, 0.0])
        model = wire(ct.mesh.line(points, n=spans))
        for k, center in enumerate(centers):
            bar = ct.RigidCurve.circle(center, 1.0)
            model.contact("all", bar, friction=mu, method=method, name=f"bar {k}")
        model.force("start", x=-1.0)
        model.fix("start", x=None, y=0.0)
        model.fix("end", x=0.2, y=0.0)
        results = ct.solve(model)
        pulled = float(results.frames[-1].RF[model.mesh.node_sets["end"][0], 0])
        yield f"{method} {n} chords", pulled, math.exp(mu * math.radians(4.0 * lean)), 0.02


@check(friction=True)
def rope_turns_a_free_pulley() -> Iterator[Row]:
    """A pulley on a bearing turns by the way of the rope over its radius; both ends pull alike."""
    for method, way in variants((0.05, 0.4)):
        points = arc_points((0.0, 0.0), 1.0, 180.0, 0.0, 24)
        mesh = ct.mesh.line([(-1.0, -1.0), *points, (1.0, -1.0)], n=[8, *[1] * 24, 8])
        ct.mesh.add_node(mesh, 0.0, 0.0, "bearing")
        model = wire(mesh, E=1e8)
        pulley = ct.RigidCurve.circle((0.0, 0.0), 1.0, reference="bearing")
        model.contact("all", pulley, friction=0.3, method=method, name="pulley")
        model.fix("bearing")
        model.fix("start", x=0.0, y=None)
        model.force("start", y=-1.0)
        model.fix("end", x=0.0, y=-way)
        results = ct.solve(model)
        pulled = -float(results.frames[-1].RF[mesh.node_sets["end"][0], 1])
        yield f"{method} {way} tension", pulled, 1.0, 0.01
        turned = float(results.history("UR3", at="bearing")[-1])
        yield f"{method} {way} turn", turned, -way, 0.02


@check(friction=True)
def belt_between_two_pulleys() -> Iterator[Row]:
    """A closed belt slips where its tensions differ by exp(pi mu), on both equal pulleys."""
    mu = 0.3
    for method, n in variants((16, 32)):
        left = arc_points((0.0, 0.0), 1.0, 90.0, 270.0, n)
        right = arc_points((4.0, 0.0), 1.0, -90.0, 90.0, n)
        mesh = ct.mesh.line([*left, (2.0, -1.0), *right, (2.0, 1.0), left[0]], n=1)
        for name, x in (("driver", 0.0), ("driven", 4.0)):
            ct.mesh.add_node(mesh, x, 0.0, name)
        model = wire(mesh)
        for name, x in (("driver", 0.0), ("driven", 4.0)):
            circle = ct.RigidCurve.circle((x, 0.0), 1.0, reference=name)
            model.contact("all", circle, friction=mu, method=method, name=name)
        model.fix("driver", rotation=True)
        spread, turn = ct.Static(), ct.Static()
        spread.fix("driven", x=0.01, y=0.0, rotation=True)
        turn.fix("driven", x=0.01, y=0.0, rotation=True)
        turn.fix("driver", x=0.0, y=0.0, rotation=0.5)
        results = ct.solve(model, [spread, turn])
        torque = abs(float(results.history("RM3", at="driver")[-1]))
        shaft = abs(float(results.frames[-1].RF[mesh.node_sets["driven"][0], 0]))
        ratio = (shaft + torque) / (shaft - torque)
        yield f"{method} {n} chords", ratio, math.exp(math.pi * mu), 0.03


@check(friction=True)
def bar_on_a_rough_floor_slips_from_its_end() -> Iterator[Row]:
    """Pulled by F, a bar moves F^2 / 2 EA q, keeps half of it, and loses F^3 / 12 EA q a cycle."""
    q, stiffness, force = 0.2, 1e3, 1.0
    for method, n, pieces in variants((100, 200), (1, 10)):
        model = ct.Model(ct.mesh.line([(0.0, 0.0), (10.0, 0.0)], n=n))
        model.truss("all", material=ct.Elastic(E=1e6), area=1e-3)
        floor = ct.RigidCurve.line((-1.0, 0.0), (12.0, 0.0))
        model.contact("all", floor, friction=0.4, method=method, name="floor")
        model.line_load(y=-q / 0.4)
        steps = [ct.Static()]
        for load in (force, 0.0, force):
            step = ct.Static(increments=pieces)
            step.force("end", x=load)
            steps.append(step)
        results = ct.solve(model, steps)
        ends = [int(np.flatnonzero(results.history("step") == k)[-1]) for k in (2, 3, 4)]
        moved = results.history("U1", at="end")
        way = force**2 / (2.0 * stiffness * q)
        lost = results.history("friction energy")
        name = f"{method} {n} elements, {pieces} increments"
        yield f"{name}, pulled", float(moved[ends[0]]), way, 0.02
        yield f"{name}, released", float(moved[ends[1]]), 0.5 * way, 0.03
        cycle = float(lost[ends[2]] - lost[ends[0]])
        yield f"{name}, energy", cycle, force**3 / (12.0 * stiffness * q), 0.05


# --- options of pairs -----------------------------------------------------------------------------


@check(friction=False)
def surfaces_that_stay_together_slide() -> Iterator[Row]:
    """With separates=False a joint carries tension, and nothing along it."""
    for method, element, swapped in variants(("Q4I", "Q8R"), (False, True)):
        model = solids(
            element,
            E=1e3,
            low=box(element, 1.0, 1.0, 4, 4),
            top=box(element, 1.0, 1.0, 3, 3, (0.0, 1.0)),
        )
        pair = ["top.bottom", "low.top"]
        if swapped:
            pair.reverse()
        model.contact(*pair, separates=False, friction=0.5, method=method, name="joint")
        model.fix("low.bottom", x=None, y=0.0)
        model.fix([0], x=0.0, y=None)
        model.fix("top.left", x=0.05, y=None)
        model.force("top.top", y=2.0)
        results = ct.solve(model, ct.Static(nlgeom=False))
        name = f"{method} {element}{' swapped' if swapped else ''}"
        sign = -1.0 if swapped else 1.0
        yield f"{name} tension", sign * pull(results, "joint", "force y"), -2.0, 1e-6
        yield f"{name} along", pull(results, "joint"), 0.0, 1e-6
        yield f"{name} way", float(results.history("U2", at="top.top")[-1]), 4e-3, 0.03


@check(friction=True)
def joint_that_ends_and_begins() -> Iterator[Row]:
    """A sprung block that leaves its brake goes to the spring; the brake takes hold there again."""
    for method, element in variants(("Q4I", "Q8")):
        model = sprung_block(element)
        ground = ct.RigidCurve.line((-2.0, 0.0), (8.0, 0.0))
        plate = ct.RigidCurve.line((8.0, 0.5), (-2.0, 0.5))
        model.contact("bottom", ground, method=method, name="smooth")
        model.contact("top", plate, friction=0.5, method=method, name="brake", steps=[1, 2, 4])
        model.force("top", y=-1.0)
        # The brake is pressed by its overlap with the plate: a block squeezed by heat.
        model.sections[0].material = ct.Elastic(E=1e5, nu=0.0, expansion=(0.0, 1e-5, 0.0))
        steps = [ct.Static() for _ in range(4)]
        steps[0].temperature(50.0)
        steps[1].temperature(50.0)
        steps[1].force("left", x=15.0)
        steps[2].force("left", x=4.0)
        steps[3].force("left", x=10.0)
        results = ct.solve(model, steps)
        ends = [int(np.flatnonzero(results.history("step") == k)[-1]) for k in (2, 3, 4)]
        moved = results.history("U1", at="spring.start")
        name = f"{method} {element}"
        yield f"{name} held", float(results.history("brake: friction x")[ends[0]]), -15.0, 0.02
        yield f"{name} free", float(moved[ends[1]]), 0.2, 0.01
        yield f"{name} held again", float(moved[ends[2]]), 0.2, 0.02


@check(friction=True)
def wire_drawn_between_two_blocks() -> Iterator[Row]:
    """A wire pressed on both sides of its line needs 2 mu P."""
    mu, press = 0.2, 6.0
    for method, element, n in variants(("Q4I", "Q8R"), (24, 48)):
        mesh = ct.mesh.assembly(
            low=box(element, 1.0, 0.4, 5, 2, (0.0, -0.45)),
            top=box(element, 1.0, 0.4, 7, 2, (0.0, 0.05)),
            wire=ct.mesh.line([(-1.0, 0.0), (2.0, 0.0)], n=n),
        )
        model = ct.Model(mesh)
        for body in ("low", "top"):
            model.section(body, element=element, material=ct.Elastic(E=1e5, nu=0.3))
        model.beam("wire", material=ct.Elastic(E=1e5), area=0.1, inertia=0.1**3 / 12.0, height=0.1)
        for body, face in (("low", "top"), ("top", "bottom")):
            model.contact("wire", f"{body}.{face}", friction=mu, method=method, name=body)
        model.fix("low.bottom")
        model.fix("top.top", x=0.0, y=None)
        model.force("top.top", y=-press)
        hold, draw = ct.Static(), ct.Static()
        hold.fix("wire.end", x=0.0, y=None)
        draw.fix("wire.end", x=0.3, y=None)
        results = ct.solve(model, [hold, draw])
        pulled = float(results.frames[-1].RF[mesh.node_sets["wire.end"][0], 0])
        yield f"{method} {element} {n} elements", pulled, 2.0 * mu * press, 0.01


@check(friction=True)
def plates_of_two_thicknesses_rub() -> Iterator[Row]:
    """Friction is mu times the force whatever the thicknesses; CPRESS is on the smaller one."""
    mu, load = 0.3, 12.0
    for method, element, swapped in variants(("Q4I", "Q8R", "T3"), (False, True)):
        model = solids(
            element,
            table=box(element, 3.0, 0.3, 12, 2, (-1.0, -0.3)),
            plate=box(element, 1.0, 0.1, 4, 1),
        )
        model.sections[0].thickness, model.sections[1].thickness = 2.5, 0.8
        pair = ["plate.bottom", "table.top"]
        if swapped:
            pair.reverse()
        model.contact(*pair, friction=mu, method=method, name="joint")
        model.fix("table.bottom")
        model.force("plate.top", y=-load)
        press, draw = ct.Static(), ct.Static()
        draw.fix("plate.right", x=0.25, y=None)
        results = ct.solve(model, [press, draw])
        pulled = float(results.history("RF1", at="plate.right")[-1])
        yield f"{method} {element}{' swapped' if swapped else ''}", pulled, mu * load, 5e-3


@check(friction=True)
def heated_bar_pushes_two_blocks_apart() -> Iterator[Row]:
    """A hot bar between two blocks on a floor: its force is that of the weaker friction."""
    for method, element in variants(("Q4I", "Q8R")):
        model = ct.Model(
            ct.mesh.assembly(
                left=box(element, 0.5, 0.5, 3, 3, (-0.5, 0.0)),
                bar=box(element, 2.0, 0.2, 8, 1, (0.0, 0.15)),
                right=box(element, 0.5, 0.5, 3, 3, (2.0, 0.0)),
            )
        )
        for body, expansion in (("left", 0.0), ("bar", 1e-4), ("right", 0.0)):
            material = ct.Elastic(E=1e4, expansion=expansion)
            model.section(body, element=element, material=material)
        floor = ct.RigidCurve.line((-4.0, 0.0), (6.0, 0.0))
        for body, mu in (("left", 0.4), ("right", 0.3)):
            model.contact(f"{body}.bottom", floor, friction=mu, method=method, name=f"{body} floor")
            model.force(f"{body}.top", y=-10.0)
        model.contact("bar.left", "left.right", friction=0.5, method=method, name="left end")
        model.contact("bar.right", "right.left", friction=0.5, method=method, name="right end")
        bar = model.mesh.node_sets["bar"]
        middle = bar[np.abs(model.mesh.points[bar, 0] - 1.0) < 1e-9]
        model.fix(middle, x=None, y=0.0)
        press, heat = ct.Static(), ct.Static()
        heat.temperature(50.0, nodes="bar")
        results = ct.solve(model, [press, heat])
        # The bar, held at its middle, presses on the blocks by the friction of its ends.
        exact = 0.3 * pull(results, "right floor", "force y")
        yield f"{method} {element}", -pull(results, "right floor", "friction x"), exact, 5e-3
        yield f"{method} {element} stays", pull(results, "left floor", "friction x"), exact, 5e-3


@check(friction=True)
def block_drawn_at_an_angle() -> Iterator[Row]:
    """A rope that leans by t moves it at mu W / (cos t + mu sin t)."""
    mu, weight = 0.4, 10.0
    for method, element, degrees in variants(("Q4I", "T6"), (0.0, 25.0, -25.0)):
        t = math.radians(degrees)
        exact = mu * weight / (math.cos(t) + mu * math.sin(t))
        model = solids(element, block=box(element, 2.0, 0.3, 8, 2))
        floor = ct.RigidCurve.line((-4.0, 0.0), (6.0, 0.0))
        model.contact("block.bottom", floor, friction=mu, method=method, name="floor")
        model.force("block.top", y=-weight)
        press, draw = ct.Static(), ct.Static()
        draw.force("block.top", x=2.0 * exact * math.cos(t), y=-weight + 2.0 * exact * math.sin(t))
        held = largest_factor(model, [press, draw]) * 2.0
        yield f"{method} {element} {degrees:.0f}", held, 1.0, 5e-3


@check(friction=True)
def rope_tied_to_a_block_drags_it() -> Iterator[Row]:
    """A bar whose end is tied to the face of a block carries mu P."""
    mu, load = 0.25, 8.0
    for method, element in variants(("Q4I", "Q8R", "OPT")):
        mesh = ct.mesh.assembly(
            block=box(element, 1.0, 0.4, 5, 3), bar=ct.mesh.line([(1.0, 0.05), (4.0, 0.05)], n=1)
        )
        model = ct.Model(mesh)
        model.section("block", element=element, material=ct.Elastic(E=1e5, nu=0.3))
        model.truss("bar", material=ct.Elastic(E=1e5), area=0.1)
        model.tie(mesh.node_sets["bar.start"], "block.right")
        floor = ct.RigidCurve.line((-4.0, 0.0), (9.0, 0.0))
        model.contact("block.bottom", floor, friction=mu, method=method, name="floor")
        model.force("block.top", y=-load)
        press, draw = ct.Static(), ct.Static()
        for step, way in ((press, 0.0), (draw, 0.5)):
            step.fix("bar.end", x=way, y=0.0)
        results = ct.solve(model, [press, draw])
        pulled = float(results.frames[-1].RF[mesh.node_sets["bar.end"][0], 0])
        yield f"{method} {element}", pulled, mu * load, 5e-3


@check(friction=False)
def ring_on_a_pin_however_its_overlap_begins() -> Iterator[Row]:
    """Lame's pressure of an overlap that is removed at once or over the step."""
    inner, outer, overlap, E, nu = 1.0, 1.6, 2e-3, 1e5, 0.3
    soft = inner / E * ((outer**2 + inner**2) / (outer**2 - inner**2) + nu)
    for method, element, start in variants(("Q4I", "Q8R", "T6"), ("keep", "ramp")):
        model = ct.Model(ct.mesh.annulus(inner, outer, 6, 16, angle=90.0, cell=CELLS[element]))
        model.section("all", element=element, material=ct.Elastic(E=E, nu=nu))
        pin = ct.RigidCurve.circle((0.0, 0.0), inner + overlap)
        model.contact("inner", pin, method=method, start=start, friction=0.2, name="pin")
        model.fix("start", x=None, y=0.0)
        model.fix("end", x=0.0, y=None)
        results = ct.solve(model, ct.Static(nlgeom=False))
        force = pull(results, "pin", "force y") / inner
        yield f"{method} {element} {start}", force, overlap / soft, 0.02

"""Random contact problems: bodies, curvatures, meshes, elements, laws, loads, units.

Every problem follows from its family and its number alone. What a user would have to tune is left
alone: methods and steps are the defaults, and first increments are what a user would type.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct

try:
    from corota.model.loads import Fixed
except ImportError:  # the first version, for benchmarks.campaigns.contact_before_after
    from corota.loads import Fixed

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.random import Generator
    from numpy.typing import NDArray

    from corota.mesh import Mesh
    from corota.model.contact import RigidCurve
    from corota.model.materials import Material
    from corota.model.steps import Step

    Floats = NDArray[np.float64]

#: Elements and their cells.
CELLS = {
    "Q4I": "quad4",
    "Q8R": "quad8",
    "Q8": "quad8",
    "T6": "tri6",
    "OPT": "tri3",
    "Q4D": "quad4",
    "Q4": "quad4",
}
#: Whether the rigid body lies to the left of a curve, as in the first version; now it is the
#: deformable one.
RIGID_ON_LEFT = bool(ct.RigidCurve.circle((0.0, 0.0), 1.0).segments[0, 6] > 0.0)


@dataclass
class Problem:
    """A model and its steps.

    Parameters
    ----------
    name : str
        Family and number.
    what : str
        What was drawn.
    model : Model
    steps : list of Step
    static : bool
    """

    name: str
    what: str
    model: ct.Model
    steps: list[Step]
    static: bool = True


@dataclass
class Draw:
    """What all families draw: element, law, friction, method, units.

    Parameters
    ----------
    rng : Generator
    unit : float
        Further factor on lengths, for the same problem in another unit.
    size : float
        Factor on numbers of elements along something.
    """

    rng: Generator
    unit: float = 1.0
    size: float = 1.0

    def __post_init__(self) -> None:
        rng = self.rng
        self.element = str(rng.choice(["Q4I", "Q8R", "Q8", "T6", "OPT", "Q4D"], p=_ELEMENTS))
        self.law = str(rng.choice(["elastic", "soft", "metal"], p=[0.4, 0.3, 0.3]))
        self.friction = float(rng.choice([0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0], p=_FRICTION))
        self.method = str(rng.choice(["mortar", "node_to_segment"], p=[0.7, 0.3]))
        length = self.length = float(rng.choice([1.0, 1e-3, 1e3])) * self.unit
        self.stress = float(rng.choice([1.0, 1e6])) / self.unit**2
        self.density = 1e-4 * self.stress / length**2  # waves take 1/100 of a unit of time
        self.what = f"{self.element} {self.law} mu {self.friction} {self.method} length {length:g}"

    @property
    def cell(self) -> Any:
        """Cell of the element."""
        return CELLS[self.element]

    def scaled(self, mesh: Mesh) -> Mesh:
        """A mesh in the unit of length."""
        return ct.mesh.move(mesh, scale=self.length)

    def material(self, softer: float = 1.0) -> Material:
        """The law; Young's modulus 1000 in the unit of stress, or 2 and nearly incompressible."""
        s, rho = self.stress * softer, self.density
        if self.law == "soft":
            return ct.Elastic(E=2.0 * s, nu=0.47, rho=rho)
        if self.law == "metal":
            return ct.Mises(E=1000.0 * s, nu=0.3, rho=rho, yield_stress=2.0 * s, isotropic=10.0 * s)
        return ct.Elastic(E=1000.0 * s, nu=0.3, rho=rho)

    @property
    def young(self) -> float:
        """Young's modulus."""
        return (2.0 if self.law == "soft" else 1000.0) * self.stress

    def model(self, mesh: Mesh, name: str) -> ct.Model:
        """A model of one material."""
        model = ct.Model(mesh, name=name)
        model.section(
            "all",
            element=self.element,
            material=self.material(),
            local_strain="logarithmic",
            plane="strain",
            thickness=self.length,
        )
        return model

    def touch(self, model: ct.Model, slave: Any, master: Any, name: str, **options: Any) -> None:
        """A pair with the friction and the method drawn."""
        if RIGID_ON_LEFT and isinstance(master, ct.RigidCurve) and not _full_circle(master):
            master = ct.RigidCurve(reversed_segments(master.segments), master.reference)
        model.contact(
            slave, master, friction=self.friction, method=self.method, name=name, **options
        )

    def cells(self, coarse: int, fine: int) -> int:
        """Elements along something; fewer quadratic ones."""
        n = round(self.size * int(self.rng.integers(coarse, fine + 1)))
        n = max(n, coarse)  # what is coarser is another problem
        return max(2, n // 2) if self.cell in ("quad8", "tri6") else n


def reversed_segments(segments: Floats) -> Floats:
    """Segments of a rigid curve in the other direction of travel, shape (n, 7)."""
    out: Floats = segments[::-1].copy()
    out[:, :2], out[:, 2:4] = segments[::-1, 2:4], segments[::-1, :2]
    out[:, 6] *= -1.0
    return out


def _full_circle(curve: RigidCurve) -> bool:
    """Whether a curve is one full circle, whose side no version leaves to the caller."""
    return len(curve.segments) == 1 and abs(float(curve.segments[0, 6])) > 6.28


_ELEMENTS = [0.35, 0.15, 0.15, 0.1, 0.15, 0.1]
_FRICTION = [0.3, 0.1, 0.1, 0.2, 0.1, 0.1, 0.05, 0.05]


def press(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A block with a flat, round or wavy face pressed into another, then drawn along it."""
    rng, L = d.rng, d.length
    face = str(rng.choice(["flat", "round", "wavy"]))
    ratio = float(rng.choice([0.1, 0.3, 1.0, 3.0, 10.0]))
    nx = d.cells(6, 16)
    mx = int(np.clip(nx * 3 * ratio, 4, round(60 * d.size)))
    gap = float(rng.choice([0.0, 0.0, 0.02, -0.01]))

    def bottom(t: float) -> tuple[float, float]:
        x = 0.8 + 1.2 * t
        rise = {"flat": 0.0, "round": 1.5 * (t - 0.5) ** 2, "wavy": 0.03 * np.sin(14.0 * t)}[face]
        return x, 1.0 + gap + rise + (0.03 if face == "wavy" else 0.0)

    def at(x: float) -> Callable[[float], tuple[float, float]]:
        t = 0.0 if x < 1.0 else 1.0
        low = bottom(t)
        return lambda s: (low[0], low[1] + s * (1.7 + gap - low[1]))

    up = ct.mesh.mapped(
        [bottom, at(2.0), lambda t: (0.8 + 1.2 * t, 1.7 + gap), at(0.8)],
        nx,
        max(2, nx // 3),
        d.cell,
    )
    low = ct.mesh.rectangle(3.5, 1.0, mx, max(2, mx // 4), d.cell)
    mesh = d.scaled(ct.mesh.assembly(low=low, up=up))
    model = d.model(mesh, "press")
    model.fix("low.bottom", rotation=True)
    d.touch(model, "up.bottom", "low.top", "pair")
    deep, far = 0.03 + max(gap, 0.0), float(rng.choice([0.0, 0.3, 1.0]))
    driven = bool(rng.random() < 0.6)
    d.what += f" {face} {nx}:{mx} gap {gap} far {far} {'driven' if driven else 'loaded'}"
    step: Any = ct.Static(first_increment=float(rng.choice([0.1, 0.25, 1.0])))
    if driven:
        sides = [Fixed("up.top", 0, 0.0), Fixed("up.top", 1, -deep * L)]
        step.supports = sides
    else:
        model.fix("up.top", y=None, rotation=True)
        model.traction("up.top", y=-0.004 * d.young)
        if gap > 0.0:
            d.what += " stabilized"
            model.contacts[0].stabilize = True
    steps: list[Step] = [step]
    if far:
        steps.append(ct.Static(first_increment=0.1, supports=[Fixed("up.top", 0, far * L)]))
    return model, steps


def ring(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A ring squeezed between plates, held by a symmetry or by friction alone."""
    rng, L = d.rng, d.length
    thick = float(rng.uniform(0.1, 0.25))
    n, ny = d.cells(24, 80), int(rng.integers(2, 4))
    mesh = d.scaled(ct.mesh.annulus(1.0 - thick, 1.0, ny, 4 * (n // 4), cell=d.cell))
    top = ct.mesh.add_node(mesh, 0.0, L, "plate")
    model = d.model(mesh, "ring")
    d.touch(model, "outer", ct.RigidCurve.line((-3 * L, -L), (3 * L, -L)), "floor")
    d.touch(model, "outer", ct.RigidCurve.line((3 * L, L), (-3 * L, L), top), "roof")
    held = d.friction == 0.0 or rng.random() < 0.4
    if held:
        axis = np.flatnonzero(np.abs(mesh.points[:, 0]) < 1e-9 * L)
        model.fix(axis[axis != top], y=None)
    inner = bool(rng.random() < 0.5)
    down = float(rng.uniform(0.3, 1.2 if inner else 0.8))
    if inner:
        d.touch(model, "inner", "inner", "inside")
    model.fix("plate", x=0.0, y=-down * L, rotation=True)
    d.what += f" n {n} thick {thick:.2f} down {down:.2f} {'held' if held else 'friction only'}"
    return model, [ct.Static(first_increment=float(rng.choice([0.01, 0.05])))]


def belt(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A strip over a quarter of a drum, pulled on one side against the other (capstan)."""
    rng, L = d.rng, d.length
    n, thick = d.cells(40, 120), float(rng.uniform(0.02, 0.06))
    mesh = ct.mesh.annulus(1.0, 1.0 + thick, int(rng.integers(1, 3)), n, 90.0, d.cell)
    mesh = d.scaled(mesh)
    model = d.model(mesh, "belt")
    drum = ct.RigidCurve.circle((0.0, 0.0), L)
    d.touch(model, "inner", drum, "drum")
    pull = 0.01 * d.young * thick
    model.fix("start", x=None if d.friction else 0.0, y=0.0)
    model.force("end", x=0.0)
    model.traction("end", x=-pull)
    d.what += f" n {n} thick {thick:.3f}"
    return model, [ct.Static(first_increment=float(rng.choice([0.1, 0.5])))]


def wave(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A block drawn across a rigid or soft wavy floor."""
    rng, L = d.rng, d.length
    nx = d.cells(6, 20)
    up = ct.mesh.rectangle(1.0, 0.5, nx, max(2, nx // 2), d.cell, origin=(0.2, 1.03))
    high, waves = float(rng.uniform(0.005, 0.03)), float(rng.uniform(4.0, 14.0))
    mx = d.cells(24, 80)

    def top(t: float) -> tuple[float, float]:
        return 3.0 * t, 1.0 + high * float(np.sin(waves * 3.0 * t))

    ends = (top(0.0)[1], top(1.0)[1])
    low = ct.mesh.mapped(
        [lambda t: (3.0 * t, 0.0), lambda t: (3.0, ends[1] * t), top, lambda t: (0.0, ends[0] * t)],
        mx,
        3,
        d.cell,
    )
    model = d.model(d.scaled(ct.mesh.assembly(low=low, up=up)), "wave")
    model.fix("low.bottom", rotation=True)
    d.touch(model, "up.bottom", "low.top", "pair")
    down, far = -0.05 * L, float(rng.uniform(0.3, 1.2)) * L
    first = ct.Static(
        first_increment=0.2, supports=[Fixed("up.top", 0, 0.0), Fixed("up.top", 1, down)]
    )
    then = ct.Static(first_increment=0.05, supports=[Fixed("up.top", 0, far)])
    d.what += f" {nx}:{mx} high {high:.3f} waves {waves:.1f}"
    return model, [first, then]


def clip(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A snap-fit pushed past a catch, rigid with a fillet or deformable with sharp corners."""
    rng, L = d.rng, d.length
    if d.law == "soft":
        d.law = "elastic"
    nx, ny = d.cells(40, 120), int(rng.integers(2, 5))
    corners = np.array([(0.0, 2.0), (14.0, 2.0), (15.6, 3.4), (16.4, 3.4), (20.0, 1.4)]) / 10.0

    def top(t: float) -> tuple[float, float]:
        return 2.0 * t, float(np.interp(2.0 * t, corners[:, 0], corners[:, 1]))

    arm = ct.mesh.mapped(
        [lambda t: (2.0 * t, 0.0), lambda t: (2.0, 0.14 * t), top, lambda t: (0.0, 0.2 * t)],
        nx,
        ny,
        d.cell,
    )
    way, kind = 0.8, str(rng.choice(["rigid", "rigid", "sharp", "deformable"]))
    fillet = 0.0 if kind == "sharp" else float(rng.uniform(0.01, 0.1))
    low, high, left, right = 0.24, 0.5, 2.02, 2.3
    if kind == "deformable":
        m = d.cells(4, 12)
        catch = ct.mesh.rectangle(right - left, high - low, m, m, d.cell, origin=(left, low))
        model = d.model(d.scaled(ct.mesh.assembly(arm=arm, catch=catch)), "clip")
        model.fix("catch.top", rotation=True)
        sets, name = model.mesh.edge_sets, "arm."
        master: Any = np.vstack([sets["catch.bottom"], sets["catch.left"], sets["catch.right"]])
    else:
        model = d.model(d.scaled(arm), "clip")
        sets, name = model.mesh.edge_sets, ""
        points = np.array([(left, low), (left, high), (right, high), (right, low)]) * L
        master = ct.RigidCurve.polyline(points, closed=True, fillet=fillet * L)
    upper = np.vstack([sets[f"{name}top"], sets[f"{name}right"]])
    d.touch(model, upper, master, "hook")
    root = f"{name}left"
    model.fix(root, x=None)
    d.what += f" n {nx} {kind} fillet {fillet:.3f}"
    there = ct.Static(first_increment=0.02, supports=[Fixed(root, 0, way * L)])
    back = ct.Static(first_increment=0.02, supports=[Fixed(root, 0, 0.0)])
    return model, [there, back] if rng.random() < 0.5 else [there]


def seal(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A tube in a groove under a rib, to self-contact."""
    rng, L = d.rng, d.length
    d.law = "soft" if rng.random() < 0.8 else "elastic"
    thick = float(rng.uniform(0.12, 0.3))
    n, ny = d.cells(24, 70), int(rng.integers(2, 4))
    mesh = d.scaled(ct.mesh.annulus(1.0 - thick, 1.0, ny, n, 180.0, d.cell, start=-90.0))
    rib = ct.mesh.add_node(mesh, 0.0, 1.3 * L, "rib")
    model = d.model(mesh, "seal")
    model.fix("start", y=None, rotation=True)
    model.fix("end", y=None, rotation=True)
    wide = float(rng.uniform(1.1, 1.6)) * L
    groove = ct.RigidCurve.polyline([(-L, -L), (wide, -L), (wide, 3.0 * L)], fillet=0.1 * L)
    d.touch(model, "outer", groove, "groove")
    round_ = ct.RigidCurve.arc((0.0, 1.3 * L), 0.3 * L, 45.0, -180.0, reference=rib)
    d.touch(model, "outer", round_, "rib")
    d.touch(model, "inner", "inner", "inside")
    down = (2.0 - 2.2 * thick) * float(rng.uniform(0.5, 0.95)) * L
    model.fix("rib", y=-down, rotation=True)
    d.what += f" n {n} thick {thick:.2f} down {down / L:.2f}"
    return model, [ct.Static(first_increment=0.05)]


def indent(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A rigid disc, wedge or punch pushed into a block by a way or by a force."""
    rng, L = d.rng, d.length
    nx = d.cells(10, 40)
    mesh = d.scaled(ct.mesh.rectangle(4.0, 1.5, nx, max(3, nx // 3), d.cell))
    gap = float(rng.choice([0.0, 0.02, -0.01])) * L
    tool = ct.mesh.add_node(mesh, 2.0 * L, 3.0 * L, "tool")
    model = d.model(mesh, "indent")
    model.fix("bottom", rotation=True)
    kind = str(rng.choice(["disc", "wedge", "punch"]))
    y = 1.5 * L + gap
    x = (2.0 + 0.1 * float(rng.normal())) * L
    if kind == "disc":
        curve: RigidCurve = ct.RigidCurve.circle((x, y + 0.8 * L), 0.8 * L, reference=tool)
    else:
        tip = [(x, y)] if kind == "wedge" else [(x + 0.5 * L, y), (x - 0.5 * L, y)]
        sides = [(x + 1.5 * L, y + 0.6 * L), *tip, (x - 1.5 * L, y + 0.6 * L)]
        fillet = float(rng.choice([0.0, 0.05, 0.2])) * L
        curve = ct.RigidCurve.polyline(sides, fillet=fillet, reference=tool)
    d.touch(model, "top", curve, "tool")
    deep = float(rng.uniform(0.02, 0.25)) * L
    model.fix("tool", y=-deep - max(gap, 0.0), rotation=True)
    d.what += f" {kind} n {nx} gap {gap / L} deep {deep / L:.2f}"
    return model, [ct.Static(first_increment=float(rng.choice([0.1, 0.5, 1.0])))]


def stack(d: Draw) -> tuple[ct.Model, list[Step]]:
    """Two to four blocks on each other and a rigid floor, by their weight and a push."""
    rng, L = d.rng, d.length
    count = int(rng.integers(2, 5))
    bodies, y = {}, 0.0
    for i in range(count):
        n = d.cells(3, 10)
        wide, high = 1.0, float(rng.uniform(0.2, 0.4))
        shift = 0.05 * float(rng.normal())
        bodies[f"b{i}"] = ct.mesh.rectangle(
            wide, high, n, max(1, n // 3), d.cell, origin=(shift, y)
        )
        y += high
    d.friction = max(d.friction, 0.2)
    model = d.model(d.scaled(ct.mesh.assembly(**bodies)), "stack")
    floor = ct.RigidCurve.line((-3.0 * L, 0.0), (4.0 * L, 0.0))
    d.touch(model, "b0.bottom", floor, "floor")
    for i in range(1, count):
        d.touch(model, f"b{i}.bottom", f"b{i - 1}.top", f"joint{i}")
    weight = float(rng.choice([1e-5, 1e-3, 1e-2])) * d.young
    model.gravity(y=-weight / (d.density * L))
    push = float(rng.uniform(0.0, 0.15)) * weight
    model.gravity(x=push / (d.density * L))
    d.what += f" {count} blocks weight {weight / d.young:g} push {push / weight:.2f}"
    return model, [ct.Static()]


def drop(d: Draw) -> tuple[ct.Model, list[Step]]:
    """A strip, a ring or a block that falls on a plate, with weight or without."""
    rng, L = d.rng, d.length
    body = str(rng.choice(["strip", "ring", "block"]))
    if body == "strip":
        n = d.cells(20, 60)
        mesh = ct.mesh.annulus(1.0, 1.04, 2, n, 90.0, d.cell, start=-135.0 + 15.0 * rng.random())
        slave = "outer"
    elif body == "ring":
        n = d.cells(20, 48)
        mesh = ct.mesh.annulus(0.8, 1.0, 2, n, cell=d.cell)
        slave = "outer"
    else:
        n = d.cells(4, 10)
        mesh = ct.mesh.move(ct.mesh.rectangle(1.0, 0.5, n, n, d.cell), angle=10.0 * rng.random())
        slave = "bottom"
    low = float(mesh.points[:, 1].min())
    mesh = d.scaled(ct.mesh.move(mesh, (0.0, 0.005 - low)))
    model = d.model(mesh, "drop")
    # The speed of waves is 100 in lengths per time for a modulus of one stress unit.
    wave = float(np.sqrt(d.young / d.density))
    speed = float(rng.choice([1e-3, 1e-2])) * wave
    model.velocity(y=-speed, x=float(rng.choice([0.0, 0.5])) * speed)
    weight = bool(rng.random() < 0.6)
    if weight:
        model.gravity(y=-float(rng.choice([0.01, 0.2])) * speed**2 / (0.05 * L))
    d.touch(model, slave, ct.RigidCurve.line((-9.0 * L, 0.0), (9.0 * L, 0.0)), "plate")
    scheme = str(rng.choice(["hht", "newmark", "generalized_alpha", "energy_momentum"]))
    period = 0.005 * L / speed + float(rng.uniform(0.5, 2.0)) * L / wave
    fixed = int(rng.choice([0, 0, 100]))
    d.what += f" {body} {scheme} weight {weight} {'fixed' if fixed else 'automatic'}"
    return model, [ct.Dynamic(period=period, scheme=scheme, increments=fixed)]


FAMILIES: dict[str, Callable[[Draw], tuple[ct.Model, list[Step]]]] = {
    f.__name__: f for f in (press, ring, belt, wave, clip, seal, indent, stack, drop)
}


def problem(number: int, unit: float = 1.0, size: float = 1.0) -> Problem:
    """The problem of a number; `unit` changes the unit of length, `size` the meshes."""
    names = list(FAMILIES)
    family = names[number % len(names)]
    draw = Draw(np.random.default_rng([20261122, number]), unit, size)
    model, steps = FAMILIES[family](draw)
    static = all(isinstance(step, ct.Static) for step in steps)
    return Problem(f"{family}-{number}", draw.what, model, steps, static)


__all__ = ["FAMILIES", "RIGID_ON_LEFT", "Problem", "problem", "reversed_segments"]

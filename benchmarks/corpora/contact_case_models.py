"""Eight jobs in contact that are hard to finish, each on several meshes, elements and methods."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota.model.loads import Fixed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from corota.mesh import Mesh
    from corota.model.steps import Step

METHODS = ("mortar", "node_to_segment")
SCHEMES = ("hht", "newmark", "generalized_alpha", "energy_momentum")
PERIODS = (1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 8e-3, 1e-2)
#: Options that a family takes, by name.
Options = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One run.

    Parameters
    ----------
    name : str
        Family, then its options.
    options : dict
        Of the builder of the family.
    build : callable
        Gives model and steps.
    force : str
        History whose largest value is reported.
    ends : str
        Words that the message has where the run must stop; empty if it must finish.
    """

    name: str
    options: Options
    build: Callable[..., tuple[ct.Model, list[Step]]]
    force: str
    ends: str = ""


def cell(element: str) -> Any:
    """Cell of an element."""
    return {"Q": "quad4", "T": "tri6", "O": "tri3"}[element[0]].replace(
        "quad4", "quad8" if element.startswith("Q8") else "quad4"
    )


def strip(
    element: str, n: int, tilt: float = 0.0, ny: int = 2, method: str = "mortar", mu: float = 0.0
) -> ct.Model:
    """A quarter of a thin steel ring, .2 above a rigid plate, falling at 5 m/s (mm, t, s, N)."""
    mesh = ct.mesh.annulus(49.5, 50.5, ny, n, 90.0, cell(element), start=-135.0 + tilt)
    mesh.points = mesh.points - [0.0, mesh.points[:, 1].min() - 0.2]
    model = ct.Model(mesh)
    steel = ct.Elastic(E=210e3, nu=0.3, rho=7.85e-9)
    model.section("all", element=element, material=steel, thickness=10.0)
    plate = ct.RigidCurve.line((-100.0, 0.0), (100.0, 0.0))
    model.contact("outer", plate, friction=mu, name="plate", method=method)
    model.velocity(y=-5000.0)
    return model


def drop(
    element: str, scheme: str, period: float, weight: bool, mu: float, method: str = "mortar"
) -> tuple[ct.Model, list[Step]]:
    """The strip, elastic."""
    model = strip(element, 80 if element != "Q8R" else 40, method=method, mu=mu)
    if weight:
        model.gravity(y=-9810.0)
    return model, [ct.Dynamic(period=period, scheme=scheme)]


def fixed(element: str, n: int, method: str, mu: float) -> tuple[ct.Model, list[Step]]:
    """The strip, tilted and yielding, energy-momentum, fixed increments of 5 us."""
    model = strip(element, n, 15.0, method=method, mu=mu)
    steel = ct.Mises(E=210e3, nu=0.3, rho=7.85e-9, yield_stress=250.0, isotropic=1000.0)
    model.sections.clear()
    model.section("all", element=element, material=steel, thickness=10.0)
    model.gravity(y=-9810.0)
    return model, [ct.Dynamic(period=1e-3, scheme="energy_momentum", increments=200)]


def belt(element: str, n: int, method: str, mu: float) -> tuple[ct.Model, list[Step]]:
    """A strip over a quarter of a drum, held at one end, pulled at the other."""
    mesh = ct.mesh.annulus(50.0, 51.0, 1, n, 90.0, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=2000.0, nu=0.3), thickness=10.0)
    drum = ct.RigidCurve.circle((0.0, 0.0), 50.0)
    model.contact("inner", drum, friction=mu, name="drum", method=method)
    model.fix("start")
    model.traction("end", x=-10.0)
    return model, [ct.Static()]


def wavy(element: str, n: int, method: str, mu: float) -> tuple[ct.Model, list[Step]]:
    """A block pressed on a wavy surface and drawn along it."""
    up = ct.mesh.rectangle(10.0, 4.0, n, max(2, n // 3), cell(element), origin=(2.0, 5.2))

    def top(t: float) -> tuple[float, float]:
        return 30.0 * t, 5.0 + 0.2 * float(np.sin(2.0 * np.pi * 6.0 * t))

    low = ct.mesh.mapped(
        [lambda t: (30.0 * t, 0.0), lambda t: (30.0, 5.0 * t), top, lambda t: (0.0, 5.0 * t)],
        3 * n,
        4,
        cell(element),
    )
    model = ct.Model(ct.mesh.assembly(low=low, up=up))
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3), plane="strain")
    model.fix("low.bottom")
    model.contact("up.bottom", "low.top", friction=mu, name="wave", method=method)
    first = ct.Static(supports=[Fixed("up.top", 0, 0.0), Fixed("up.top", 1, -0.3)])
    then = ct.Static(first_increment=0.05, supports=[Fixed("up.top", 0, 8.0)])
    return model, [first, then]


def ring(element: str, n: int, method: str, law: str = "metal") -> tuple[ct.Model, list[Step]]:
    """A ring squeezed between plates, held by friction .2 only; its walls may touch."""
    mesh = ct.mesh.annulus(4.2, 5.0, 5 if element == "Q4I" else 3, n, cell=cell(element))
    top = ct.mesh.add_node(mesh, 0.0, 5.0, name="plate")
    model = ct.Model(mesh)
    material: Any = ct.Mises(E=70e3, nu=0.33, yield_stress=50.0, isotropic=200.0)
    if law == "rubber":
        material = ct.Elastic(E=6.0, nu=0.48)
    model.section(
        "all", element=element, material=material, plane="strain", local_strain="logarithmic"
    )
    floor = ct.RigidCurve.line((-15.0, -5.0), (15.0, -5.0))
    roof = ct.RigidCurve.line((15.0, 5.0), (-15.0, 5.0), reference=top)
    model.contact("outer", floor, friction=0.2, name="floor", method=method)
    model.contact("outer", roof, friction=0.2, name="roof", method=method)
    model.contact("inner", "inner", friction=0.2, name="inside", method=method)
    model.fix("plate", x=0.0, y=-8.0, rotation=True)
    return model, [ct.Static(first_increment=0.01)]


def hook(element: str, edge: float) -> Mesh:
    """Arm of a snap-fit with a hook, edges of about a length; root at the left."""
    xs, ys = np.array([(0.0, 1.2), (14.0, 1.2), (15.2, 2.2), (15.6, 2.2), (18.0, 0.6)]).T

    def top(t: float) -> tuple[float, float]:
        return 18.0 * t, float(np.interp(18.0 * t, xs, ys))

    n, ny = round(18.0 / edge), max(2, round(1.2 / edge))
    bounds = [
        lambda t: (18.0 * t, 0.0),
        lambda t: (18.0, 0.6 * t),
        top,
        lambda t: (0.0, 1.2 * t),
    ]
    return ct.mesh.mapped(bounds, n, ny, cell(element))


#: Corners of the catch of the snap-fit.
CATCH = ((18.2, 0.85), (19.7, 0.85), (19.7, 6.0), (18.2, 6.0))


def snap(
    element: str, edge: float, method: str, mu: float, fillet: float = 0.3, out: bool = True
) -> tuple[ct.Model, list[Step]]:
    """A snap-fit past a rigid catch with fillets, and back: the catch is moved."""
    mesh = hook(element, edge)
    catch = ct.mesh.add_node(mesh, 19.0, 4.0, name="catch")
    model = ct.Model(mesh)
    curve = [(50.0, 0.0), (65.0, 0.01), (75.0, 0.03), (85.0, 0.10)]
    nylon = ct.Mises(E=3000.0, nu=0.38, yield_curve=curve)
    model.section("all", element=element, material=nylon, thickness=6.0, local_strain="logarithmic")
    model.fix("left")
    bar = ct.RigidCurve.polyline(CATCH[::-1], closed=True, fillet=fillet, reference=catch)
    upper = np.vstack([mesh.edge_sets["top"], mesh.edge_sets["right"]])
    model.contact(upper, bar, friction=mu, name="hook", method=method)
    held = [Fixed("catch", 1, 0.0), Fixed("catch", 2, 0.0)]
    steps: list[Step] = [ct.Static(first_increment=0.02, supports=[*held, Fixed("catch", 0, -5.6)])]
    if out:
        back = [*held, Fixed("catch", 0, 0.0)]
        steps.append(ct.Static(first_increment=0.02, supports=back))
    return model, steps


def catch_mesh(edge: float, fillet: float, element: str, outer: float = 0.4) -> Mesh:
    """Lower part of a catch with round corners: a bar with a half-round foot of two fillets.

    The corners are rounded by mapping the foot of the bar; `edge` is the length of edges round
    them.
    """
    (x0, y0), (x1, _) = CATCH[0], CATCH[1]
    high = 1.6
    arc = 0.5 * np.pi * fillet
    lengths = np.array([high - fillet, arc, x1 - x0 - 2.0 * fillet, arc, high - fillet])
    parts = [max(2, round(float(s) / outer)) for s in lengths]
    for k in (1, 3):
        parts[k] = max(2, round(arc / edge))

    def foot(s: float) -> tuple[float, float]:
        for k, piece in enumerate(lengths):
            if s <= piece or k == 4:
                break
            s -= float(piece)
        r = fillet
        if k == 0:
            return x0, y0 + high - s
        if k == 1:
            a = np.pi + s / r
            return x0 + r + r * float(np.cos(a)), y0 + r + r * float(np.sin(a))
        if k == 2:
            return x0 + r + s, y0
        if k == 3:
            a = 1.5 * np.pi + s / r
            return x1 - r + r * float(np.cos(a)), y0 + r + r * float(np.sin(a))
        return x1, y0 + r + s

    stations = np.concatenate(
        [
            np.linspace(0.0, 1.0, n + 1)[(1 if k else 0) :] * lengths[k] + lengths[:k].sum()
            for k, n in enumerate(parts)
        ]
    )
    grid = np.linspace(0.0, 1.0, len(stations))
    middle = 0.5 * (x0 + x1)

    def outside(t: float) -> tuple[float, float]:
        return foot(float(np.interp(t, grid, stations)))

    def inside(t: float) -> tuple[float, float]:
        # A thin core that shrinks the contour towards the middle of the bar.
        x, y = outside(t)
        return middle + 0.35 * (x - middle), y0 + high - 0.55 * (y0 + high - y)

    bounds = [
        outside,
        lambda t: tuple(np.array(outside(1.0)) * (1 - t) + np.array(inside(1.0)) * t),
        inside,
        lambda t: tuple(np.array(outside(0.0)) * (1 - t) + np.array(inside(0.0)) * t),
    ]
    return ct.mesh.mapped(bounds, len(stations) - 1, 3, cell(element))


def soft_catch(
    element: str,
    edge: float,
    method: str,
    mu: float,
    fillet: float = 0.3,
    per_fillet: float = 2.0,
    **options: Any,
) -> tuple[ct.Model, list[Step]]:
    """The snap-fit with a steel catch as master, so many edges per radius of its fillets."""
    arm, catch = hook(element, edge), catch_mesh(fillet / per_fillet, fillet, element)
    mesh = ct.mesh.assembly(arm=arm, catch=catch)
    model = ct.Model(mesh)
    law = dict(local_strain="logarithmic", thickness=6.0, element=element)
    model.section("arm.all", material=ct.Elastic(E=3000.0, nu=0.38), **law)
    model.section("catch.all", material=ct.Elastic(E=210e3, nu=0.3), **law)
    model.fix("arm.left")
    sets = mesh.edge_sets
    upper = np.vstack([sets["arm.top"], sets["arm.right"]])
    model.contact(upper, sets["catch.bottom"], friction=mu, name="hook", method=method, **options)
    held = [Fixed("catch.top", 1, 0.0)]
    step = ct.Static(first_increment=0.02, supports=[*held, Fixed("catch.top", 0, -4.2)])
    return model, [step]


def seal(element: str, n: int, method: str, mu: float = 0.0) -> tuple[ct.Model, list[Step]]:
    """Half a rubber tube in a groove under a rib, down until its walls lie on each other."""
    ny = 4 if cell(element) == "quad4" else 2
    half = ct.mesh.annulus(3.2, 4.0, ny, n, 180.0, cell(element), start=-90.0)
    rib = ct.mesh.add_node(half, 0.0, 5.5, name="rib")
    model = ct.Model(half)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=5.0, nu=0.45),
        plane="strain",
        local_strain="logarithmic",
    )
    model.fix("start", y=None)
    model.fix("end", y=None)
    groove = ct.RigidCurve.polyline([(-4.0, -4.0), (4.6, -4.0), (4.6, 12.0)], fillet=1.0)
    round_ = ct.RigidCurve.arc((0.0, 5.5), 1.5, 45.0, -180.0, reference=rib)
    model.contact("outer", groove, friction=mu, name="groove", method=method)
    model.contact("outer", round_, friction=mu, name="rib", method=method)
    model.contact("inner", "inner", friction=mu, name="inside", method=method)
    model.fix("rib", y=-6.8, rotation=True)
    return model, [ct.Static(first_increment=0.05)]


def collapse(element: str, n: int, method: str) -> tuple[ct.Model, list[Step]]:
    """An ideally plastic strip over a drum without friction, pulled to twice its yield force."""
    model, steps = belt(element, n, method, 0.0)
    model.sections.clear()
    soft = ct.Mises(E=2000.0, nu=0.3, yield_stress=5.0)
    model.section("all", element=element, material=soft, thickness=10.0)
    return model, steps


def wall(element: str, n: int, method: str) -> tuple[ct.Model, list[Step]]:
    """A block pushed to a wall whose normal points the wrong way."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 2 * n, n, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left", x=0.5, y=0.0)
    curve = ct.RigidCurve.line((2.1, 3.0), (2.1, -3.0))
    model.contact("right", curve, name="wall", method=method)
    return model, [ct.Static()]


def families(quick: bool) -> dict[str, list[Case]]:
    """All cases by family; a few of each if `quick`."""

    def cases(name: str, build: Any, force: str, rows: list[Options], ends: str = "") -> list[Case]:
        out = []
        for row in rows:
            said = " ".join(str(v) if not isinstance(v, bool) else k * v for k, v in row.items())
            out.append(Case(f"{name} {' '.join(said.split())}", row, build, force, ends))
        return out[:: max(len(out) // 3, 1)][:3] if quick else out

    def rows(**options: Any) -> list[Options]:
        return [dict(zip(options, row, strict=True)) for row in product(*options.values())]

    quads, meshes = ("Q4I", "Q8R"), (20, 30, 40, 60, 80)
    both = {"method": METHODS}
    return {
        "drop": cases(
            "drop",
            drop,
            "plate: force y",
            rows(
                element=("Q4I", "Q8R", "OPT"),
                scheme=SCHEMES,
                period=PERIODS,
                weight=(True, False),
                mu=(0.0, 0.1),
            ),
        ),
        "explicit": cases(
            "explicit",
            drop,
            "plate: force y",
            rows(
                element=("Q4I", "Q8R", "OPT"),
                scheme=("central_difference",),
                period=(2e-3,),
                weight=(True, False),
                mu=(0.0, 0.1),
                **both,
            ),
        ),
        "belt": cases(
            "belt",
            belt,
            "drum: force y",
            rows(element=("Q8", "Q4I"), n=(60, 75, 90, 105, 120), mu=(0.05, 0.2), **both),
        ),
        "wavy": cases(
            "wavy",
            wavy,
            "wave: force x",
            rows(element=quads, n=(8, 10, 12, 16, 20), mu=(0.2,), **both),
        ),
        "ring": cases(
            "ring", ring, "roof: force y", rows(element=quads, n=(80, 100, 120, 140, 160), **both)
        ),
        "snap": cases(
            "snap",
            snap,
            "hook: force x",
            rows(element=quads, edge=(0.3, 0.25, 0.2, 0.15, 0.1), mu=(0.0, 0.2), **both),
        ),
        "soft_catch": cases(
            "soft_catch",
            soft_catch,
            "hook: force x",
            rows(element=quads, edge=(0.3, 0.25, 0.2, 0.15, 0.1), mu=(0.2,), **both),
        ),
        "seal": cases(
            "seal",
            seal,
            "rib: force y",
            rows(element=quads, n=(30, 40, 50, 60, 80), mu=(0.0, 0.2), **both),
        ),
        "fixed": cases(
            "fixed",
            fixed,
            "plate: force y",
            rows(element=quads, n=meshes, mu=(0.0, 0.1), **both),
        ),
        "collapse": cases(
            "collapse",
            collapse,
            "drum: force y",
            rows(element=quads, n=(60, 75, 90, 105, 120), **both),
            "plastic collapse",
        ),
        "wall": cases(
            "wall",
            wall,
            "wall: force x",
            rows(element=quads, n=(2, 3, 4, 6, 8), **both),
            "wrong side",
        ),
    }


def all_cases(quick: bool) -> Iterator[Case]:
    """All cases."""
    for found in families(quick).values():
        yield from found


__all__ = ["Case", "all_cases", "families"]

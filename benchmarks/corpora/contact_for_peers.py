"""Contact problems of the torture set as data that other programs can be given.

Taken are problems that are static, elastic, without contact of a surface with itself and without
stabilization, with unit length and a modulus of 1000. Round tools become polygons with chords of
3 degrees. Elements that the peers do not have are replaced in Corota, too: ``Q4I`` and ``Q4D`` by
``Q4``, ``OPT`` by ``T3``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.corpora.contact_problems import FAMILIES, Draw, Problem
from benchmarks.peers.contact_data import ContactData, Face, Pair, Stage, Tool
from corota.model.contact import RigidCurve
from corota.model.loads import Fixed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Elements on both sides; the second for peers without quadratic elements in contact.
SAME = {"Q4I": "Q4", "Q4D": "Q4", "OPT": "T3"}
LINEAR = {"Q8": "Q4", "Q8R": "Q4", "T6": "OPT"}
#: Of the random numbers of the problems.
SEED = 20261122
#: Chords of round tools [rad], and the depth of what lies behind their edges.
CHORD, DEPTH = math.radians(3.0), 0.05


def chosen(count: int, size: float, *, linear: bool = False) -> list[Problem]:
    """Problems that the peers can be given; the same ones for both values of `linear`.

    Parameters
    ----------
    count : int
    size : float
        Factor on numbers of elements.
    linear : bool
        Linear elements in place of quadratic ones, in meshes of twice as many.
    """
    out: list[Problem] = []
    number = 0
    while len(out) < count:
        given = _unit_problem(number, size)
        if _fits(given):
            if linear and given.model.sections[0].element in LINEAR:
                given = _unit_problem(number, size, linear=True)
            for section in given.model.sections:
                section.element = SAME.get(section.element, section.element)
                section.local_strain = "green_lagrange"
            out.append(given)
        number += 1
    return out


def _unit_problem(number: int, size: float, *, linear: bool = False) -> Problem:
    """The problem of a number with unit length and a modulus of 1000."""
    names = list(FAMILIES)
    family = names[number % len(names)]
    draw = Draw(np.random.default_rng([SEED, number]), 1.0, size)
    draw.length, draw.stress, draw.density = 1.0, 1.0, 1e-4
    if linear:
        draw.element = LINEAR[draw.element]
    model, steps = FAMILIES[family](draw)
    static = all(isinstance(step, ct.Static) for step in steps)
    return Problem(f"{family}-{number}", draw.what, model, steps, static)


def _fits(given: Problem) -> bool:
    material = given.model.sections[0].material
    plain = isinstance(material, ct.Elastic) and material.nu < 0.4
    pairs = given.model.contacts
    alone = any(pair.itself or pair.stabilize for pair in pairs)
    return given.static and plain and not alone


def sheared(element: str = "Q4") -> Problem:
    """A block that is sheared and pulled, without contact: what all programs agree on."""
    cell: Any = {"T3": "tri3", "Q4": "quad4", "T6": "tri6"}.get(element, "quad8")
    model = ct.Model(ct.mesh.rectangle(1.0, 0.6, 4, 3, cell), name="sheared")
    _section(model, element)
    model.fix("bottom")
    model.traction("right", x=10.0, y=3.0)
    step = ct.Static(increments=2, supports=[Fixed("top", 0, 0.2), Fixed("top", 1, -0.03)])
    return Problem("sheared", element, model, [step])


def slid() -> Problem:
    """A block pressed on a larger one and drawn along it with friction 0.2."""
    up = ct.mesh.rectangle(1.0, 0.5, 6, 3, "quad4", origin=(0.5, 1.0))
    low = ct.mesh.rectangle(3.0, 1.0, 17, 4, "quad4")
    model = ct.Model(ct.mesh.assembly(low=low, up=up), name="slid")
    _section(model, "Q4")
    model.fix("low.bottom")
    model.contact("up.bottom", "low.top", friction=0.2, name="pair")
    press = [Fixed("up.top", 0, 0.0), Fixed("up.top", 1, -0.01)]
    steps: list[Any] = [
        ct.Static(first_increment=0.25, supports=press),
        ct.Static(first_increment=0.05, supports=[Fixed("up.top", 0, 0.4)]),
    ]
    return Problem("slid", "Q4", model, steps)


def _section(model: ct.Model, element: str) -> None:
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=1000.0, nu=0.3, rho=1e-4),
        local_strain="green_lagrange",
        plane="strain",
        thickness=1.0,
    )


def polygon(curve: RigidCurve) -> Floats:
    """A curve as the corners of a polygon, the deformable body on its left, shape (n, 2)."""
    points: list[Any] = []
    for x0, y0, x1, y1, cx, cy, sweep in curve.segments.tolist():
        if sweep == 0.0:
            some = np.array([(x0, y0), (x1, y1)])
        else:
            radius, start = math.hypot(x0 - cx, y0 - cy), math.atan2(y0 - cy, x0 - cx)
            angle = start + np.linspace(0.0, sweep, 1 + math.ceil(abs(sweep) / CHORD))
            some = np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)])
        points += [p for p in some if not points or np.hypot(*(p - points[-1])) > 1e-9]
    return np.array(points)


def data(given: Problem) -> ContactData:
    """A problem as data."""
    model = given.model
    mesh, section = model.mesh, model.sections[0]
    material = section.material
    out = ContactData(
        points=mesh.points[:, :2].tolist(),
        cells=[nodes for block in mesh.cells for nodes in block.nodes.tolist()],
        element=section.element,
        young=material.E,
        poisson=material.nu,
        density=material.rho,
        thickness=section.thickness,
    )
    curves: list[RigidCurve] = []
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            master = _tool(out, pair.master)
            curves.append(pair.master)
        else:
            master = _face(model, pair.master)
        out.pairs.append(Pair(_face(model, pair.slave), master, pair.friction))
    if out.tools:
        out.watched = out.tools[0].nodes
    else:
        out.watched = nodes_of(model, model.supports[0].nodes).tolist()
    out.stages = _stages(given, out.tools, curves)
    _loads(model, out)
    return out


def _face(model: ct.Model, where: Any) -> Face:
    mesh = model.mesh
    sides = mesh.edge_sets[where] if isinstance(where, str) else where
    edges = [[int(nodes[0]), int(nodes[1])] for nodes in mesh.edge_nodes(sides)]
    return Face([[int(cell), int(side)] for cell, side in sides], edges)


def _tool(out: ContactData, curve: RigidCurve) -> Face:
    """Elements behind the edges of a polygon."""
    front = polygon(curve)
    along = np.diff(front, axis=0)
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    mean = np.vstack([normal[:1], normal[:-1] + normal[1:], normal[-1:]])
    closed = np.hypot(*(front[0] - front[-1])) < 1e-9
    if closed:
        mean[0] = mean[-1] = normal[0] + normal[-1]
    rounds = np.hypot(*(curve.segments[:, :2] - curve.segments[:, 4:6]).T)
    depth = min(DEPTH, 0.5 * float(rounds[curve.segments[:, 6] != 0.0].min(initial=1.0)))
    back = front + depth * mean / np.hypot(*mean.T)[:, None]
    n, first = len(front), len(out.points)
    out.points += np.vstack([front, back]).tolist()
    # Counter-clockwise: the back lies on the right of the way.
    begin = len(out.cells) + sum(len(tool.cells) for tool in out.tools)
    cells = [[first + k + 1, first + k, first + n + k, first + n + k + 1] for k in range(n - 1)]
    out.tools.append(Tool(list(range(first, first + 2 * n)), cells))
    sides = [[begin + k, 0] for k in range(n - 1)]
    return Face(sides, [cell[:2] for cell in cells])


def _stages(given: Problem, tools: list[Tool], curves: list[RigidCurve]) -> list[Stage]:
    model = given.model
    reported: dict[tuple[int, int], float] = {}
    for tool in tools:
        reported |= {(node, dof): 0.0 for node in tool.nodes for dof in (0, 1)}
    out = []
    for number, step in enumerate(given.steps):
        for item in [*(model.supports if number == 0 else []), *step.supports]:
            if item.dof > 1:
                continue
            driven = [
                tool
                for tool, curve in zip(tools, curves, strict=True)
                if _is_of(model, item, curve)
            ]
            where = nodes_of(model, item.nodes).tolist()
            if driven:
                where = [node for tool in driven for node in tool.nodes]
            reported |= {(node, item.dof): item.value for node in where}
        first = min(step.first_increment, step.period)
        now = [(node, dof, value) for (node, dof), value in reported.items()]
        out.append(Stage(first, step.period, now))
    return out


def _loads(model: ct.Model, out: ContactData) -> None:
    for load in model.loads:
        if hasattr(load, "cells"):
            x, y = out.gravity
            out.gravity = (x + float(load.value[0]), y + float(load.value[1]))
        elif hasattr(load, "edges"):
            _traction(model, load, out)


def _traction(model: ct.Model, load: Any, out: ContactData) -> None:
    """A dead traction as forces on nodes."""
    mesh = model.mesh
    edges = mesh.edge_sets[load.edges] if isinstance(load.edges, str) else load.edges
    force: dict[int, Floats] = {}
    for nodes in mesh.edge_nodes(edges):
        length = np.hypot(*(mesh.points[nodes[1]] - mesh.points[nodes[0]]))
        share = (0.5, 0.5) if len(nodes) == 2 else (1 / 6, 1 / 6, 2 / 3)
        for n, part in zip(nodes, share, strict=True):
            value = part * length * model.sections[0].thickness * np.array(load.value)
            force[int(n)] = force.get(int(n), np.zeros(2)) + value
    out.forces += [(n, float(x), float(y)) for n, (x, y) in force.items()]


def nodes_of(model: ct.Model, where: Any) -> Any:
    """Indices of nodes."""
    return model.mesh.nodes_of(where) if isinstance(where, str) else np.atleast_1d(where)


def _is_of(model: ct.Model, item: Any, curve: RigidCurve) -> bool:
    """Whether a support is one of the reference node of a curve."""
    return isinstance(curve.reference, int | np.integer) and curve.reference in nodes_of(
        model, item.nodes
    )

"""Figures of the documents: ``python docs/builder/figures.py`` writes them all to ``docs/figures``.

Elements are drawn from the facts of the compute core and from a model of one cell; charts are
computed by the models below.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from svg import Curve, Svg, chart, flow

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import EDGES, Cells
from corota.model import elements

FOLDER = Path(__file__).resolve().parents[1] / "figures"
#: Side of a drawn cell [px].
SIDE = 190.0

Point = tuple[float, float]


def one_cell(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of a cell of the element in its node order, and its integration points."""
    facts = elements.find(name)
    grid = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=facts.cell)
    nodes = grid.cells[0].nodes[0]
    count = len(nodes)
    cells = Cells(facts.cell, np.arange(count)[None, :], np.array([1]))
    mesh = Mesh(grid.points[nodes], [cells], np.arange(1, count + 1))
    model = ct.Model(mesh)
    model.section(element=name, material=ct.Elastic(E=1.0))
    model.fix(np.arange(count), rotation=True if facts.drilling else None)
    fields = ct.solve(model, ct.Static(increments=1)).frames[-1].fields[0]
    return mesh.points, fields.points[0]


def drawn(points: np.ndarray, left: float, bottom: float) -> list[Point]:
    """Places of points of a unit cell; a right triangle is drawn with equal legs."""
    x, y = points.T
    if not np.isclose(x, 0.0).any() or (np.isclose(x, 0.0) & np.isclose(y, 1.0)).any():
        return list(zip(left + SIDE * x, bottom - SIDE * y, strict=True))
    return list(zip(left + SIDE * (x - 0.5 * y), bottom - SIDE * 0.9 * y, strict=True))


def _cell(name: str, left: float, bottom: float) -> tuple[list[Point], list[Point]]:
    nodes, points = one_cell(name)
    joined = np.concatenate([nodes, points])
    places = drawn(joined, left, bottom)
    return places[: len(nodes)], places[len(nodes) :]


def _outward(side: tuple[int, ...], nodes: list[Point]) -> tuple[Point, Point]:
    """Middle of a side and its outward direction; y grows downwards."""
    (ax, ay), (bx, by) = nodes[side[0]], nodes[side[1]]
    length = float(np.hypot(bx - ax, by - ay))
    return ((ax + bx) / 2, (ay + by) / 2), (-(by - ay) / length, (bx - ax) / length)


def element(name: str) -> str:
    """The element: node order, faces, integration points and dofs."""
    facts = elements.find(name)
    svg = Svg(
        548,
        290,
        f"Element {name}: {facts.n_nodes} nodes, {facts.dofs_per_node} dofs each, "
        f"{facts.n_points} integration points",
    )
    nodes, points = _cell(name, 55, 245)
    sides = EDGES[facts.cell]
    corners = [nodes[side[0]] for side in sides]
    svg.polygon(corners, "fill-fill")
    svg.line([*corners, corners[0]], "ink", 1.8)
    for number, side in enumerate(sides, 1):
        (x, y), (a, b) = _outward(side, nodes)
        away = 34 if len(side) == 3 else 28
        svg.text(x + away * a, y + away * b + 5, f"S{number}", "face", bold=True)
    middle = np.mean(corners, axis=0)
    for number, (x, y) in enumerate(nodes, 1):
        svg.circle(x, y, 4.5, "node-fill")
        if facts.drilling:
            svg.path(f"M{x + 8:.1f} {y + 5:.1f}A9.5 9.5 0 1 0 {x - 3:.1f} {y + 9:.1f}", "good")
            svg.polygon([(x + 2, y + 9), (x - 4, y + 5), (x - 4, y + 12)], "good-fill")
        out = np.array([x, y]) - middle
        size = float(np.hypot(*out))
        step = (-11.0, 11.0) if size < 1 else tuple((20.0 if facts.drilling else 15.0) * out / size)
        svg.text(x + step[0], y + step[1] + 5, str(number), bold=True)
    for number, (x, y) in enumerate(points, 1):
        for slope in (1, -1):
            svg.line([(x - 4, y - 4 * slope), (x + 4, y + 4 * slope)], "load", 1.6)
        if len(points) > 1:
            svg.text(x + 6, y - 5, str(number), "load", "start", 11)
    _legend(svg, name, facts)
    return str(svg)


def _legend(svg: Svg, name: str, facts: elements.Element) -> None:
    x, y = 328.0, 60.0
    svg.text(x, y, name, anchor="start", size=18, bold=True)
    dofs = "x, y" + (", rotation" if facts.dofs_per_node == 3 else "")
    y += 34
    svg.circle(x + 5, y - 5, 4.5, "node-fill")
    svg.text(x + 18, y, f"{facts.n_nodes} nodes: {dofs}", anchor="start")
    if facts.drilling:
        y += 26
        svg.path(f"M{x + 12:.1f} {y - 1:.1f}A8 8 0 1 0 {x + 2:.1f} {y + 3:.1f}", "good")
        svg.text(x + 18, y, "drilling rotation, dof 6", anchor="start")
    y += 26
    for slope in (1, -1):
        svg.line([(x + 1, y - 5 - 4 * slope), (x + 9, y - 5 + 4 * slope)], "load", 1.6)
    many = f"{facts.n_points} integration point" + ("s" if facts.n_points > 1 else "")
    svg.text(x + 18, y, many, anchor="start")
    y += 26
    svg.text(x - 6, y, "S1", "face", "start", bold=True)
    svg.text(x + 18, y, "faces of surfaces and loads", anchor="start")
    more = [
        f"{facts.n_internal_modes} internal modes" if facts.n_internal_modes > 1 else "",
        "1 internal mode" if facts.n_internal_modes == 1 else "",
        "1 hourglass mode" if facts.hourglass_modes else "",
        "hourglass stabilized" if facts.stabilized else "",
    ]
    for line in filter(None, more):
        y += 26
        svg.text(x + 18, y, line, "soft", "start")


def line_element(name: str) -> str:
    """A line element or spring: nodes and dofs."""
    facts = elements.find(name)
    dofs = "x, y" + (", rotation" if facts.dofs_per_node == 3 else "")
    many = f"{facts.n_nodes} node{'s' if facts.n_nodes > 1 else ''}: {dofs}"
    svg = Svg(500, 120, f"Element {name}, {many}")
    ends = [(50.0, 80.0), (230.0, 50.0)] if facts.turns else [(50.0, 65.0), (230.0, 65.0)]
    if facts.spring:
        (ax, ay), (bx, by) = ends
        along = np.array([bx - ax, by - ay])
        across = np.array([-along[1], along[0]]) / np.hypot(*along)
        zigzag = [
            tuple(np.array([ax, ay]) + t * along + (9 * side) * across)
            for t, side in zip(
                [0, 0.25, *np.linspace(0.29, 0.71, 8), 0.75, 1],
                [0, 0, 1, -1, 1, -1, 1, -1, 1, -1, 0, 0],
                strict=True,
            )
        ]
        svg.line(zigzag, "ink", 1.8)
    else:
        svg.line(ends, "ink", 5 if facts.dofs_per_node == 3 else 2)
    for number, (x, y) in enumerate(ends[: facts.n_nodes], 1):
        svg.circle(x, y, 4.5, "node-fill")
        svg.text(x, y + 26, str(number), bold=True)
        if facts.dofs_per_node == 3:
            svg.path(f"M{x + 8:.1f} {y + 5:.1f}A9.5 9.5 0 1 0 {x - 3:.1f} {y + 9:.1f}", "good")
            svg.polygon([(x + 2, y + 9), (x - 4, y + 5), (x - 4, y + 12)], "good-fill")
    if facts.n_nodes == 1:
        x, y = ends[1]
        svg.line([(x, y - 22), (x, y + 22)], "ink", 2)
        for k in range(-20, 24, 8):
            svg.line([(x, y + k), (x + 8, y + k - 8)], "ink", 1)
    svg.text(300, 48, name, anchor="start", size=18, bold=True)
    svg.text(300, 76, many, anchor="start")
    reported = "turns with its nodes" if facts.turns else "keeps its direction"
    svg.text(300, 98, reported, "soft", "start")
    return str(svg)


def faces() -> str:
    """Pressures and tractions on the faces of a quadrilateral and a triangle."""
    svg = Svg(640, 348, "Faces of quadrilaterals and triangles, and the loads on them")
    for name, left in (("Q4", 70.0), ("T3", 390.0)):
        nodes, _ = _cell(name, left, 265)
        sides = EDGES[elements.find(name).cell]
        svg.polygon(nodes, "fill-fill")
        svg.line([*nodes, nodes[0]], "ink", 1.8)
        for number, side in enumerate(sides, 1):
            (x, y), (a, b) = _outward(side, nodes)
            along = (-b, a)
            for shift in (-34, 0, 34):
                u, v = x + shift * along[0], y + shift * along[1]
                svg.arrow(u + 30 * a, v + 30 * b, u + 3 * a, v + 3 * b, "load")
            svg.text(x - 18 * a, y - 18 * b + 5, f"S{number}", "face", bold=True)
            svg.text(x + 43 * a, y + 43 * b + 5, f"P{number}", "load", bold=True)
        center = np.mean(nodes, axis=0)
        for number, (x, y) in enumerate(nodes, 1):
            svg.circle(x, y, 4.5, "node-fill")
            out = np.array([x, y]) - center
            step = 17 * out / np.hypot(*out)
            svg.text(x + step[0], y + step[1] + 5, str(number), bold=True)
    svg.text(
        320, 338, "P > 0 presses into the element. Face n runs from node n to the next.", "soft"
    )
    return str(svg)


def rigid_sides() -> str:
    """Which side of a rigid profile is outside."""
    svg = Svg(640, 190, "The outward normal of a rigid profile is on the left of its direction")
    profile = [(60.0, 140.0), (170.0, 140.0), (250.0, 80.0), (360.0, 80.0)]
    ground = [*profile, (360.0, 160.0), (60.0, 160.0)]
    svg.polygon(ground, "fill-fill")
    svg.line(profile, "ink", 2.2)
    for (ax, ay), (bx, by) in zip(profile, profile[1:], strict=False):
        length = float(np.hypot(bx - ax, by - ay))
        a, b = (by - ay) / length, -(bx - ax) / length
        x, y = (ax + bx) / 2, (ay + by) / 2
        svg.arrow(x, y, x + 34 * a, y + 34 * b, "load")
        u, v = (bx - ax) / length, (by - ay) / length
        svg.polygon(
            [
                (x + 26 * u, y + 26 * v),
                (x + 14 * u + 5 * a, y + 14 * v + 5 * b),
                (x + 14 * u - 5 * a, y + 14 * v - 5 * b),
            ],
            "node-fill",
        )
    svg.text(60, 182, "START", "ink", "middle", 13)
    svg.circle(60, 140, 4.5, "node-fill")
    svg.text(210, 30, "the body is here", "soft")
    svg.text(250, 140, "rigid", "soft")
    for i, words in enumerate(
        (
            "The normal is on the left",
            "of the direction.",
            "",
            "R2D2 sides: SPOS is the left",
            "of the way from node 1 to 2,",
            "SNEG the right.",
        )
    ):
        svg.text(400, 50 + 21 * i, words, anchor="start")
    return str(svg)


def why_no_convergence() -> str:
    """The causes, in the order in which to look."""
    return flow(
        "Why does it not converge? Questions from top to bottom; the first yes is the cause",
        [
            (
                "Does corota check or model.check() report an error?",
                "Correct it: a support is missing, an element is inverted, or a rigid wall faces "
                "the wrong way.",
            ),
            (
                "Does the message speak of a limit point?",
                "The load has a maximum. Prescribe the displacement, or follow the path: "
                'Static(at_limit="follow") or Static(path=ArcLength()).',
            ),
            (
                "Does it speak of plastic collapse?",
                "The load exceeds the collapse load. Prescribe the displacement.",
            ),
            (
                "Is a body supported by contact alone?",
                "Close the gap in a first step by a prescribed displacement, or give the pair "
                "stabilize=True (decks: *CONTACT CONTROLS, STABILIZE).",
            ),
            (
                "Does it name a folded element?",
                "The local strain is large there. Refine the mesh, or take "
                'local_strain="logarithmic".',
            ),
            (
                "Does only the first increment fail?",
                "Take a shorter one: first_increment=0.01.",
            ),
        ],
        "None of these: corota plot job.vtkhdf --last-iterate shows where the last attempt is "
        "out of balance.",
    )


def which_element() -> str:
    """From the mesh and the part to the element."""
    return flow(
        "Which element? Questions from top to bottom; the first yes decides",
        [
            (
                "Do moments or beams act on single nodes?",
                "Q4D on quadrilaterals, OPT on triangles: their nodes have a rotation.",
            ),
            (
                "Does a mesher give triangles?",
                "T6. With corner nodes only: OPT.",
            ),
            (
                "Curved sides, or stresses at notches and holes?",
                "Q9 or Q8.",
            ),
            (
                "Distorted quadrilaterals in bending?",
                "Q9; with corner nodes only: Q4D.",
            ),
            (
                "Plastic strains above a few percent?",
                'Q4S or Q9, with local_strain="logarithmic".',
            ),
        ],
        "None of these: Q4I, with two or more elements through the thickness. T3 and Q4 lock in "
        "bending; they are for comparison.",
    )


def which_step() -> str:
    """From what happens to the procedure."""
    return flow(
        "Which step? Questions from top to bottom; the first yes decides",
        [
            (
                "Impact, or long motion that must keep its energy?",
                'Dynamic(scheme="energy_momentum")',
            ),
            ("Short pulses and waves?", 'Dynamic(scheme="central_difference")'),
            ("Other motion?", 'Dynamic(scheme="hht"), the default'),
            ("Small vibrations about a state?", "Frequency; then ModalDynamic or SteadyState"),
            (
                "Only the load at which it buckles?",
                "Buckle; then a path with an imperfection, since real parts are not perfect",
            ),
            ("Do you know the displacement, not the load?", "Static with step.fix(..., y=-2.0)"),
            (
                "Does the load pass a maximum, or does the part snap?",
                "Static(path=ArcLength()) or Static(path=DisplacementControl(...))",
            ),
        ],
        "None of these: Static(increments=10). Large rotations are on.",
    )


def cantilever(name: str, trapezoids: bool) -> float:
    """Tip displacement of a slender cantilever of six elements, over that of beam theory.

    The beam of R. H. MacNeal and R. L. Harder (Finite Elements in Analysis and Design 1, 1985):
    6 by 0.2, a transverse force at its end; rectangles, or trapezoids of 45 degrees.
    """
    facts = elements.find(name)
    length, height, young, poisson, thickness = 6.0, 0.2, 1e7, 0.3, 0.1
    mesh = ct.mesh.rectangle(length, height, nx=6, ny=1, cell=facts.cell)
    if trapezoids:
        x, y = mesh.points.T
        slope = np.interp(x, np.arange(7), [0, 1, -1, 1, -1, 1, 0])
        mesh.points = np.column_stack([x + slope * (y - height / 2), y])
    model = ct.Model(mesh)
    material = ct.Elastic(E=young, nu=poisson)
    model.section(element=name, material=material, thickness=thickness)
    model.fix("left", rotation=True if facts.drilling else None)
    model.force("right", y=1.0)
    frame = ct.solve(model, ct.Static(nlgeom=False)).frames[-1]
    bending = length**3 / (3.0 * young * thickness * height**3 / 12.0)
    shear = length / (young / (2.0 + 2.0 * poisson) * 5.0 / 6.0 * thickness * height)
    return float(frame.U[mesh.nodes_of("right"), 1].mean() / (bending + shear))


def bending_by_element() -> str:
    """Bars: the slender cantilever by each element, on rectangles and on trapezoids."""
    svg = Svg(640, 380, "Tip displacement of a slender cantilever by each element")
    svg.text(
        10, 20, "tip displacement / beam theory, 6 elements, one through the height", anchor="start"
    )
    top, bottom, left, step = 45.0, 300.0, 55.0, 47.0
    for tick in (0.0, 0.5, 1.0):
        y = bottom - (bottom - top - 15) * tick
        svg.line([(left, y), (left + 12 * step, y)], "soft", 1.0 if tick == 1.0 else 0.4)
        svg.text(left - 8, y + 5, f"{tick:g}", "soft", "end", 13)
    for i, name in enumerate(elements.names()):
        for j, (trapezoids, kind) in enumerate(((False, "face"), (True, "load"))):
            value = cantilever(name, trapezoids)
            y = bottom - (bottom - top - 15) * value
            x = left + i * step + 6 + 18 * j
            svg.polygon([(x, bottom), (x + 16, bottom), (x + 16, y), (x, y)], f"{kind}-fill")
            svg.text(x + 8, y - 4, f"{value:.2f}".lstrip("0"), kind, size=9.5)
        svg.text(left + i * step + 24, bottom + 20, name, size=13)
    for x, kind, words in (
        (left + 6, "face", "rectangles (triangles: halves of them)"),
        (left + 300, "load", "trapezoids of 45 degrees"),
    ):
        svg.polygon([(x, 345), (x + 14, 345), (x + 14, 359), (x, 359)], f"{kind}-fill")
        svg.text(x + 20, 357, words, anchor="start")
    return str(svg)


def bar_force(local_strain: str, stretch: list[float]) -> list[float]:
    """Force of a bar of unit section and modulus at each elongation per length."""
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for value in stretch:
            mesh = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1)
            model = ct.Model(mesh)
            material = ct.Elastic(E=1.0, nu=0.3)
            model.section(element="Q4", material=material, local_strain=local_strain)
            model.fix("left", y=None)
            model.fix("bottom", x=None)
            model.fix("right", x=value, y=None)
            frame = ct.solve(model, ct.Static(increments=4)).frames[-1]
            found.append(float(frame.RF[mesh.nodes_of("right"), 0].sum()))
    return found


def local_strains() -> str:
    """Curves: force of a bar by each measure of the local strain."""
    stretch = [float(v) for v in np.linspace(-0.4, 0.6, 21)]
    curves = [
        Curve(name, stretch, bar_force(name, stretch), kind)
        for name, kind in (
            ("linear", "face"),
            ("logarithmic", "good"),
            ("green_lagrange", "load"),
        )
    ]
    return chart(
        "Force of an elastic bar by each measure of the local strain",
        curves,
        x=("elongation / length", [-0.4, -0.2, 0.0, 0.2, 0.4, 0.6]),
        y=("force / (E A), A undeformed", [-1.0, -0.5, 0.0, 0.5, 1.0, 1.5]),
    )


def spin_energy(scheme: str, increments: int = 400) -> tuple[list[float], list[float]]:
    """Total energy of a spinning strip about a pin over its first value, by time."""
    mesh = ct.mesh.rectangle(2.0, 0.2, nx=6, ny=1)
    pin = int(mesh.nodes_of("left")[0])
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.fix([pin])
    model.velocity(spin=3.0, about=tuple(mesh.points[pin]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            step = ct.Dynamic(period=20.0, increments=increments, scheme=scheme)
            results = ct.solve(model, step)
        except ct.ConvergenceError as error:
            results = error.results
    energy = np.array(results.history("kinetic energy"))
    energy = energy + np.array(results.history("strain energy"))
    times = [float(frame.time) for frame in results.frames]
    return times, [float(v) for v in energy / energy[0]]


def energy_by_scheme() -> str:
    """Curves: energy of a free motion by each scheme, at the same increments."""
    curves = []
    for scheme, kind in (
        ("energy_momentum", "good"),
        ("generalized_alpha", "plum"),
        ("hht", "face"),
        ("newmark", "load"),
    ):
        times, energy = spin_energy(scheme)
        kept = [i for i, value in enumerate(energy) if value <= 1.2]
        first = next((i for i, value in enumerate(energy) if value > 1.2), len(energy))
        kept = [i for i in kept if i < first]
        name = scheme if first == len(energy) else f"{scheme} (gains)"
        curves.append(Curve(name, [times[i] for i in kept], [energy[i] for i in kept], kind))
    return chart(
        "Energy of a spinning strip by each scheme, 400 increments",
        curves,
        x=("time (9.5 turns)", [0.0, 5.0, 10.0, 15.0, 20.0]),
        y=("total energy / its first value", [0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2]),
    )


#: Each figure of the documents that is not of one element, and what draws it.
FIGURES: dict[str, Callable[[], str]] = {
    "faces": faces,
    "rigid_sides": rigid_sides,
    "why_no_convergence": why_no_convergence,
    "which_element": which_element,
    "which_step": which_step,
    "bending_by_element": bending_by_element,
    "local_strains": local_strains,
    "energy_by_scheme": energy_by_scheme,
}


def all_figures() -> dict[str, str]:
    """Text of every figure by its file name."""
    found = {f"element_{name.lower()}.svg": element(name) for name in elements.names()}
    found |= {f"element_{name.lower()}.svg": line_element(name) for name in elements.line_names()}
    return found | {f"{name}.svg": draw() for name, draw in FIGURES.items()}


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in all_figures().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    print(f"{FOLDER}: {len(all_figures())} figures")

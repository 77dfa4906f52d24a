"""Contact with a superposed rotation: forces in the turned frame are those without it.

``python -m benchmarks objectivity`` runs static contact problems of each kind (friction, rounds,
corners, ends, lines, self-contact, pressure laws) in two increments, and again with
all supports and loads turned besides by up to 400 degrees in each increment. Forces of pairs and
supports, tractions, gaps, slips and states must agree to 1e-9 of the largest.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import corota as ct
from benchmarks.common import table
from corota.mesh import Cells
from corota.model.contact import METHODS

Floats = NDArray[np.float64]
#: Difference over the largest value that is rounding.
SAME = 1e-9
#: Superposed rotations of each increment [degrees], about a point that is none of the model.
ANGLES, CENTER = (0.0, 15.0, 90.0, 137.0, 180.0, 270.0, 360.0, 400.0), np.array([0.3, -0.7])
#: What is compared; gaps and slips with the largest displacement.
KINDS = ("force", "displacement", "pressure", "shear", "gap", "slip", "state")
#: Far below the default, so that what is left is rounding.
TOLERANCE = 1e-12


@dataclass
class Problem:
    """A model, and how its grips move: x, y and rotation at the end of each increment.

    `weight` is a uniform acceleration of cells, by increment; `forces` act at nodes.
    """

    model: ct.Model
    moves: list[dict[int, tuple[float, float, float]]]
    weight: dict[str, tuple[float, float]] = field(default_factory=dict)
    forces: dict[int, tuple[float, float]] = field(default_factory=dict)


def _grip(model: ct.Model, nodes: str, at: tuple[float, float] = (0.0, 0.0)) -> int:
    """A reference node that carries nodes; the model's mesh gets it."""
    node = ct.mesh.add_node(model.mesh, *at)
    model.rigid(nodes, node)
    return node


def _section(model: ct.Model, element: str, young: float = 1e4, **options: object) -> None:
    model.section("all", element=element, material=ct.Elastic(E=young, nu=0.3, rho=1.0), **options)


def drag(
    method: str, role: str, element: str = "Q4I", cell: str = "quad4", **options: object
) -> Problem:
    """A block pressed on a table or a rigid line and drawn along it, past an end if it is short."""
    block = ct.mesh.rectangle(1.0, 0.6, 4, 3, cell, origin=(0.5, 0.5))
    end = 1.7 if "short" in role else 4.0
    bodies = {"b": block}
    if "rigid" not in role:
        # No node lies opposite another: there rounding chooses the edge.
        bodies["t"] = ct.mesh.rectangle(
            end + 0.07, 0.5, int(4 * end) - 1, 2, cell, origin=(-0.07, 0)
        )
    model = ct.Model(ct.mesh.assembly(**bodies))
    _section(model, element)
    top = _grip(model, "b.top", (1.0, 1.1))
    if "rigid" in role:
        low = ct.mesh.add_node(model.mesh, 1.0, 0.0)
        line = ct.RigidCurve.line((-9.0, 0.5), (9.0 if end > 2.0 else end, 0.5), reference=low)
        model.contact("b.bottom", line, friction=0.3, method=method, name="c", **options)
    else:
        low = _grip(model, "t.bottom", (1.0, 0.0))
        pair = ("t.top", "b.bottom") if "slave" in role else ("b.bottom", "t.top")
        model.contact(*pair, friction=0.3, method=method, name="c", **options)
    still = (0.0, 0.0, 0.0)
    return Problem(
        model, [{top: (0.0, -0.01, 0.0), low: still}, {top: (0.43, -0.01, 0.0), low: still}]
    )


def drum(method: str, role: str) -> Problem:
    """A pad on a drum that turns by 50 degrees."""
    bodies = {"p": ct.mesh.annulus(10.0, 12.0, 2, 6, angle=20.0, start=80.0)}
    if role != "rigid":
        bodies["d"] = ct.mesh.annulus(8.0, 10.0, 1, 72)
    model = ct.Model(ct.mesh.assembly(**bodies))
    _section(model, "Q4I")
    pad, hub = _grip(model, "p.outer", (0.0, 12.0)), ct.mesh.add_node(model.mesh, 0.0, 0.0)
    if role == "rigid":
        circle = ct.RigidCurve.circle((0.0, 0.0), 10.0, reference=hub)
        model.contact("p.inner", circle, friction=0.2, method=method, name="c")
    else:
        model.rigid("d.inner", hub)
        sides = ("p.inner", "d.outer") if role == "master" else ("d.outer", "p.inner")
        model.contact(*sides, friction=0.2, method=method, name="c")
    pressed = (0.0, -0.02, 0.0)
    turned = (0.0, 0.0, np.radians(50.0))
    return Problem(model, [{pad: pressed, hub: (0.0, 0.0, 0.0)}, {pad: pressed, hub: turned}])


def rolled(method: str, role: str) -> Problem:
    """A ring between two plates that stick to it, of which one moves; friction alone carries it."""
    cell, element = ("quad8", "Q8R") if role == "Q8R" else ("quad4", "Q4I")
    model = ct.Model(ct.mesh.annulus(0.6, 1.0, 2, 48, cell=cell))
    _section(model, element)
    upper, lower = (ct.mesh.add_node(model.mesh, 0.0, y) for y in (1.0, -1.0))
    for node, ends, name in ((upper, (9.0, -9.0), "upper"), (lower, (-9.0, 9.0), "lower")):
        y = model.mesh.points[node, 1]
        line = ct.RigidCurve.line((ends[0], y), (ends[1], y), reference=node)
        model.contact("outer", line, friction=0.5, method=method, name=name)
    low = (0.0, 0.0, 0.0)
    return Problem(
        model, [{upper: (0.0, -0.02, 0.0), lower: low}, {upper: (0.3, -0.02, 0.0), lower: low}]
    )


def punch(method: str, role: str) -> Problem:
    """A corner, a disc or a profile with fillets pressed into a block and drawn along it."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 20, 5))
    material = ct.Elastic(E=1e4, nu=0.3)
    model.section("all", element="Q4I", material=material)
    low, tool = _grip(model, "bottom", (0.0, 0.0)), ct.mesh.add_node(model.mesh, 2.0, 2.0)
    if role == "corner":
        curve = ct.RigidCurve.polyline([(3.0, 2.0), (2.01, 1.0), (1.0, 2.0)], reference=tool)
    elif role == "fillet":
        curve = ct.RigidCurve.polyline(
            [(3.5, 3.0), (2.7, 1.0), (1.4, 1.0), (0.6, 3.0)], fillet=0.15, reference=tool
        )
    else:
        curve = ct.RigidCurve.circle((2.0, 2.0), 1.0, reference=tool)
    law = ct.PressureLaw("linear", 1e6) if role == "law" else None
    model.contact("top", curve, friction=0.3, method=method, name="c", law=law)
    still = (0.0, 0.0, 0.0)
    return Problem(
        model, [{low: still, tool: (0.0, -0.03, 0.0)}, {low: still, tool: (0.27, -0.03, 0.0)}]
    )


def stack(method: str, role: str) -> Problem:
    """Two blocks under their weight, which leans: they stick, or the upper one is pushed along."""
    model = ct.Model(
        ct.mesh.assembly(
            u=ct.mesh.rectangle(1.0, 0.4, 4, 2, origin=(0.3, 0.4)),
            l=ct.mesh.rectangle(2.0, 0.4, 7, 2),
        )
    )
    _section(model, "Q4I")
    low = _grip(model, "l.bottom")
    pair = ("u.bottom", "l.top") if role == "upper slave" else ("l.top", "u.bottom")
    model.contact(*pair, friction=0.4, method=method, name="c")
    return Problem(model, [{low: (0.0, 0.0, 0.0)}] * 2, {"u": (2.0, -10.0)})


def folded(method: str, _: str) -> Problem:
    """A U whose arms are pushed together: a boundary that meets itself."""
    # No node lies opposite another, nor on the axis of the fold: there rounding chooses the edge.
    arms = ct.mesh.annulus(0.3, 0.5, 2, 11, angle=180.0, start=90.0)
    upper = ct.mesh.rectangle(2.0, 0.2, 12, 2, origin=(0.0, 0.3))
    lower = ct.mesh.rectangle(2.0, 0.2, 11, 2, origin=(0.0, -0.5))
    mesh = ct.mesh.merge(arms, upper, lower)
    mesh.edge_sets["boundary"] = mesh.boundary_edges()
    model = ct.Model(mesh)
    _section(model, "Q4I")
    ends = {}
    for name, sign in (("up", 1.0), ("down", -1.0)):
        nodes = np.flatnonzero(
            (np.abs(mesh.points[:, 0] - 2.0) < 1e-9) & (sign * mesh.points[:, 1] > 0.35)
        )
        mesh.node_sets[name] = nodes
        ends[name] = _grip(model, name, (2.0, sign * 0.4))
    model.contact("boundary", "boundary", friction=0.3, method=method, name="c")
    one, two = (
        {ends["up"]: (x, -y, 0.0), ends["down"]: (0.0, y, 0.0)}
        for x, y in ((0.0, 0.304), (0.02, 0.3045))
    )
    return Problem(model, [one, two])


def wire(_: str, role: str) -> Problem:
    """A cantilever of beams pressed on a block, or on another one across it."""
    n = 10
    chain = np.column_stack([np.linspace(0.0, 2.0, n + 1), np.full(n + 1, 0.56)])
    solid = ct.mesh.rectangle(2.0, 0.5, 9, 2, origin=(0.6, 0.0))
    first = len(solid.points)
    if role == "on a block":
        points, cells, base = np.vstack([solid.points, chain]), list(solid.cells), solid.n_cells
    else:
        other = np.column_stack([np.full(6, 1.5), np.linspace(0.45, -1.0, 6)])
        points, first, cells, base = np.vstack([other, chain]), 6, [], 0
    lines = [(i, i + 1) for i in range(first, first + n)]
    if role != "on a block":
        lines = [(i, i + 1) for i in range(5)] + lines
    cells.append(Cells("line2", np.array(lines), np.arange(base + 1, base + len(lines) + 1)))
    mesh = ct.Mesh(points, cells, np.arange(1, len(points) + 1))
    model = ct.Model(mesh)
    wires = np.arange(base + len(lines) - n, base + len(lines))
    mesh.cell_sets["wire"] = wires
    steel = {"material": ct.Elastic(E=1e5, nu=0.3), "area": 0.1, "inertia": 0.1**3 / 12.0}
    model.beam("wire", height=0.1, **steel)
    mesh.node_sets["root"] = np.array([first])
    still = (0.0, 0.0, 0.0)
    root = _grip(model, "root", (0.0, 0.56))
    if role == "on a block":
        solid_cells = np.arange(base)
        mesh.cell_sets["block"] = solid_cells
        model.section("block", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
        mesh.edge_sets["top"] = solid.edge_sets["top"]
        mesh.node_sets["floor"] = solid.nodes_of("bottom")
        low = _grip(model, "floor", (0.0, 0.0))
        model.contact("wire", "top", friction=0.3, name="c")
    else:
        mesh.cell_sets["post"] = np.arange(5)
        model.beam("post", height=0.1, **steel)
        mesh.node_sets["foot"] = np.array([5])
        low = _grip(model, "foot", (1.5, -1.0))
        model.contact("wire", "post", friction=0.3, name="c")
    return Problem(
        model, [{root: (0.0, -0.05, 0.0), low: still}, {root: (0.2, -0.06, 0.0), low: still}]
    )


CASES: list[tuple[Callable[[str, str], Problem], str]] = [
    *((drag, role) for role in ("rigid", "table master", "table slave", "short rigid")),
    *((drag, role) for role in ("short table master", "short table slave")),
    *((drum, role) for role in ("rigid", "master", "slave")),
    *((rolled, role) for role in ("Q4I", "Q8R")),
    *((punch, role) for role in ("disc", "corner", "fillet", "law")),
    *((stack, role) for role in ("upper slave", "lower slave")),
    (folded, "on itself"),
    *((wire, role) for role in ("on a block", "on a wire")),
]
#: Elements with the cells of their meshes, on a block drawn along a table.
ELEMENTS = {"Q8R": "quad8", "T6": "tri6", "OPT": "tri3", "Q4D": "quad4"}


def _drag_of(element: str) -> Callable[[str, str], Problem]:
    return lambda method, role: drag(method, role, element, ELEMENTS[element])


def steps_of(problem: Problem, degrees: float) -> list[ct.Static]:
    """Steps of one increment each, turned by so much more in each."""
    steps = []
    for number, grips in enumerate(problem.moves, start=1):
        angle = np.radians(number * degrees)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        step = ct.Static(
            increments=1, tolerance=TOLERANCE, max_iterations=60, new_loads=["distributed"]
        )
        for node, (x, y, rotation) in grips.items():
            at = problem.model.mesh.points[node]
            ux, uy = CENTER + turn @ (at + np.array([x, y]) - CENTER) - at
            step.fix([node], x=float(ux), y=float(uy), rotation=rotation + angle)
        for cells, g in problem.weight.items():
            gx, gy = turn @ np.array(g)
            step.gravity(x=float(gx), y=float(gy), cells=cells)
        steps.append(step)
    return steps


def measured(problem: Problem, degrees: float) -> dict[str, Floats]:
    """Forces of pairs, turned back, and the table at slave nodes, at the end of each increment."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(problem.model, steps_of(problem, degrees), threads=1)
    out: dict[str, list[Floats]] = {name: [] for name in KINDS}
    for number, frame in enumerate(results.frames[1:], start=1):
        angle = np.radians(number * degrees)
        for pair in problem.model.contacts:
            force = sum(
                frame.scalars[f"{pair.name}: force {a}"] * v for a, v in (("x", 1), ("y", 1j))
            )
            force *= np.exp(-1j * angle)
            out["force"] += [np.array([force.real, force.imag])]
        # Where a boundary meets itself, those of the pair cancel.
        at = frame.RF[list(problem.moves[0])][:, :2] @ np.array([1.0, 1j]) * np.exp(-1j * angle)
        out["force"] += [at.real, at.imag]
        points = problem.model.mesh.points
        there = (points + frame.U[:, :2] - CENTER) @ np.array([1.0, 1j]) * np.exp(-1j * angle)
        moved = there - (points - CENTER) @ np.array([1.0, 1j])
        out["displacement"] += [moved.real, moved.imag]
        nodes = np.nan_to_num(frame.C)
        # At the bound of friction, without a slip, rounding says which of both states it is.
        rests = np.abs(nodes[:, 3]) < SAME * np.abs(moved).max()
        nodes[rests, 4] = np.minimum(nodes[rests, 4], 1.0)
        for column, name in enumerate(("pressure", "shear", "gap", "slip", "state")):
            out[name].append(nodes[:, column])
    return {name: np.concatenate(values) for name, values in out.items()}


def scale_of(still: dict[str, Floats], kind: str) -> float:
    """Value that differences of a kind are compared with."""
    lengths = ("displacement", "gap", "slip")
    return max(float(np.abs(still[k]).max()) for k in (lengths if kind in lengths else (kind,)))


def main() -> int:
    """A line for each problem: the largest difference of each kind over all rotations."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", help="parts of names; all if there are none")
    chosen = parser.parse_args()
    cases = [(make.__name__, role, make) for make, role in CASES]
    cases += [(f"drag {e}", r, _drag_of(e)) for e in ELEMENTS for r in ("table master", "rigid")]
    rows, wrong = [], 0
    for name, role, make in cases:
        for method in list(METHODS)[: 1 if name == "wire" else None]:
            what = f"{name}, {role}, {method}"
            if chosen.names and not any(part in what for part in chosen.names):
                continue
            begin = time.process_time()
            still, worst, at = measured(make(method, role), 0.0), 0.0, ""
            for degrees in ANGLES[1:]:
                try:
                    turned = measured(make(method, role), degrees)
                except ct.CorotaError as error:
                    worst, at = np.inf, f"{degrees:g} degrees stops: {str(error)[:120]}"
                    break
                for kind, values in turned.items():
                    scale = max(scale_of(still, kind), 1e-300)
                    if values.shape != still[kind].shape:
                        worst, at = np.inf, f"{degrees:g} degrees: {len(values)} values"
                        break
                    off = float(np.abs(values - still[kind]).max()) / scale
                    if off > worst:
                        worst, at = off, f"{kind}, {degrees:g} degrees"
            wrong += not worst <= SAME
            rows.append([what, f"{worst:.0e}", at, f"{time.process_time() - begin:.1f}"])
            if not worst <= SAME:
                print(f"{what}: {worst:.1e} {at}", flush=True)
    print(table(["problem", "largest difference", "where", "CPU s"], rows))
    print(f"{len(rows) - wrong} of {len(rows)} agree to {SAME:g}")
    return min(wrong, 63)


if __name__ == "__main__":
    raise SystemExit(main())

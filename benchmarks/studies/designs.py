"""Six designs, each found from three starts, and the analyses that it took beside differences.

``python -m benchmarks designs [NAME ...]`` prints a row for each start: objective, analyses with
exact gradients, and objective and analyses of SciPy's SLSQP with differences of the same measures
(one analysis gives all of them). The inverter has a density for each node: its number with
differences is what their gradients would take, and is not run. Meshes are coarse, so that all six
take minutes.

``--check`` finds each optimum once, from the first start, and analyzes it again with cells of a
third of the size: objective and constraints of both. ``--pictures FOLDER`` draws the first design
and the optimum. (The body of the inverter is meshed and analyzed by itself in every row.)
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import time
import warnings
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, minimize

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Worst value of an objective, relative to the first one, for a design that cannot be analyzed.
FAILED = 10.0
#: Refinement of the mesh that checks an optimum.
FINE = 3


@dataclass
class Task:
    """A design problem.

    Parameters
    ----------
    build : callable
    objective : Measure
    starts : sequence of sequence of float
        Three first designs.
    bounds : sequence of (float, float)
    constraints : list of Constraint
    maximize : bool
    most : int
        Most iterations.
    """

    build: Callable[[Floats], ct.Model]
    objective: gradients.Measure
    starts: Any
    bounds: Any
    constraints: list[gradients.Constraint] = field(default_factory=list)
    maximize: bool = False
    most: int = 60


def gripper(fine: int = 1) -> Task:
    """Jaw on a leaf: most travel of its tip for that of its drive, under a limit of the stress."""
    mesh = ct.mesh.rectangle(4.0, 40.0, nx=4 * fine, ny=40 * fine)
    shape = ct.shape(mesh)
    shape.control("left", 4, mirror=("x", 2.0))
    x, y = mesh.points.T
    drive = np.flatnonzero((x < 1e-9) & (np.abs(y - 12.0) < 1e-9))

    def build(p: Floats) -> ct.Model:
        model = ct.Model(shape.mesh(p))
        model.section("all", element="Q4I", material=ct.Elastic(E=1800.0, nu=0.4), thickness=5.0)
        model.fix("bottom")
        model.fix(drive, x=0.6, y=None)
        model.force("top", x=-1.0)
        model.steps = [ct.Static(increments=1, fixed_increments=True)]
        return model

    # The drive moves by .6 mm.
    advantage = gradients.Displacement("top", "x") / 0.6
    limits = [
        gradients.Constraint(gradients.Stress(p=10.0), upper=14.0),
        gradients.Constraint(gradients.Width("left", "right"), lower=0.8),
    ]
    starts = [(0.0,) * 4, (-0.8, -0.4, 0.0, 0.4), (0.5, -0.5, -0.5, 0.5)]
    return Task(build, advantage, starts, [(-1.5, 1.0)] * 4, limits, maximize=True)


def constant_force(fine: int = 1) -> Task:
    """Curved beam whose force stays the same over its way (example `constant_force`)."""
    from examples.constant_force import constant_force as example

    starts = [example.START, (4.0, 0.55, 0.9, 0.9, 0.9), (6.0, 0.5, 0.6, 0.7, 1.3)]
    cells = 16 * fine
    return Task(lambda x: example.flexure(x, cells), example.uneven(), starts, example.BOUNDS)


def bistable(fine: int = 1) -> Task:
    """Curved beam of least mass that switches at a force of 1 N and stays switched at .3 N."""

    def build(p: Floats) -> ct.Model:
        rise, depth = p
        mesh = ct.mesh.rectangle(1.0, 1.0, nx=10 * fine, ny=fine, cell="quad8")
        s, across = mesh.points[:, 0], mesh.points[:, 1] - 0.5
        height = 0.5 * rise * (1.0 - np.cos(np.pi * s))
        slope = 0.5 * rise * np.pi / 25.0 * np.sin(np.pi * s)
        size = np.hypot(1.0, slope)
        mesh.points = np.column_stack(
            [25.0 * s - across * depth * slope / size, height + across * depth / size]
        )
        model = ct.Model(mesh)
        nylon = ct.Elastic(E=1800.0, nu=0.4, rho=1.1e-9)
        model.section("all", element="Q8R", material=nylon, thickness=5.0)
        model.fix("left")
        model.fix("right", x=0.0, y=None)
        model.force("right", y=-1.0)
        path = ct.ArcLength(displacement=("right", "y", -2.2 * float(rise)))
        model.steps = [ct.Static(path=path)]
        return model

    limits = [
        gradients.Constraint(gradients.LimitLoad(0), lower=1.0, upper=1.0),
        gradients.Constraint(gradients.LimitLoad(1), upper=-0.3),
    ]
    starts = [(4.0, 0.5), (5.0, 0.6), (3.5, 0.45)]
    return Task(build, gradients.Mass(), starts, [(2.5, 7.0), (0.3, 0.9)], limits)


def hook(fine: int = 1) -> Task:
    """Snap hook of the least strain that takes a mean insertion force of 1.5 N."""

    def build(p: Floats) -> ct.Model:
        root, tip, ramp = p
        mesh = ct.mesh.rectangle(16.0, 1.0, nx=32 * fine, ny=2 * fine)
        x, share = mesh.points.T
        depth = root + (tip - root) * x / 16.0
        # The bottom is straight, and rises along the ramp of the hook to its end.
        lift = 1.2 * np.clip((x - (16.0 - ramp)) / ramp, 0.0, None)
        points = np.column_stack([x, lift + share * depth])
        mesh = replace(mesh, points=points)
        ct.mesh.add_node(mesh, 17.4, -0.3, "catch")
        model = ct.Model(mesh)
        polymer = ct.Elastic(E=2300.0, nu=0.38)
        model.section("all", element="Q4I", material=polymer, thickness=4.0)
        model.fix("left")
        catch = ct.RigidCurve.circle((17.4, -0.3), 1.5, reference="catch")
        model.contact("bottom", catch, method="node_to_segment")
        model.fix("catch", x=-4.0, y=0.0, rotation=True)
        model.steps = [ct.Static(increments=10, fixed_increments=True)]
        return model

    force = gradients.Reaction("catch", "x", frame=7) ** 2.0
    for frame in (8, 9, 10):
        force = force + gradients.Reaction("catch", "x", frame=frame) ** 2.0
    limit = gradients.Constraint((force / 4.0) ** 0.5, lower=1.5, upper=1.5)
    starts = [(2.0, 1.2, 4.0), (1.6, 1.6, 5.0), (2.6, 1.0, 3.5)]
    bounds = [(1.0, 3.5), (0.8, 3.0), (3.0, 6.0)]
    return Task(build, gradients.Stress(p=8.0) / 2300.0, starts, bounds, [limit])


def seal(fine: int = 1) -> Task:
    """Rubber profile under a rigid lid: least stress for a force of the lid, by its groove."""
    mesh = ct.mesh.rectangle(10.0, 6.0, nx=20 * fine, ny=8 * fine)
    shape = ct.shape(mesh, slide={"left": "y", "right": "y"})
    shape.control("bottom", 3, direction=(0.0, 1.0))
    shape.control("top", 1, direction=(0.0, 1.0))

    def build(p: Floats) -> ct.Model:
        moved = shape.mesh(np.array([p[0], p[1], p[0], p[2]]))
        ct.mesh.add_node(moved, 5.0, 16.0, "lid")
        model = ct.Model(moved)
        rubber = ct.NeoHooke(C10=1.0, D1=0.1)
        model.section("all", element="Q4I", material=rubber, plane="strain")
        ends = np.flatnonzero(mesh.points[:, 1] < 1e-9)
        sides = ends[np.abs(mesh.points[ends, 0] - 5.0) > 2.9]
        model.fix(sides)
        plate = ct.RigidCurve.circle((5.0, 16.0), 10.0, reference="lid")
        model.contact("top", plate, method="node_to_segment")
        model.fix("lid", x=0.0, y=-0.5, rotation=True)
        model.steps = [ct.Static(increments=4, fixed_increments=True)]
        return model

    force = gradients.Reaction("lid", "y") * -1.0
    limit = gradients.Constraint(force, lower=2.5, upper=2.5)
    starts = [(0.5, 1.0, 0.05), (1.0, 0.3, 0.1), (0.1, 0.2, 0.2)]
    bounds = [(0.0, 1.2), (0.0, 1.2), (0.0, 0.3)]
    return Task(build, gradients.Stress(p=8.0), starts, bounds, [limit])


TASKS: dict[str, Callable[..., Task]] = {
    "gripper": gripper,
    "constant force": constant_force,
    "bistable beam": bistable,
    "snap hook": hook,
    "seal": seal,
}


class Values:
    """Values of measures without gradients, each design analyzed once."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.measures = [task.objective, *(c.measure for c in task.constraints)]
        self.known: dict[bytes, Floats] = {}

    def __call__(self, x: Floats) -> Floats:
        """Values at a design; one that fails is worse than all before."""
        key = np.asarray(x).tobytes()
        if key not in self.known:
            try:
                results = ct.solve(self.task.build(np.array(x)), threads=1, fields=False)
                found = Run(results, self.measures, adjoint=False).values
            except ct.CorotaError:
                last = list(self.known.values())[-1]
                sign = -1.0 if self.task.maximize else 1.0
                found = last.copy()
                found[0] += sign * FAILED * abs(last[0])
            self.known[key] = found
        return self.known[key]


def by_differences(task: Task, start: Any) -> tuple[float, float, int]:
    """Objective, largest violation of a constraint, and analyses of SciPy with differences."""
    values = Values(task)
    sign = -1.0 if task.maximize else 1.0
    x0 = np.array(start, float)
    size = abs(values(x0)[0]) or 1.0
    low, high = np.array(task.bounds, float).T
    span = high - low
    conditions = [
        NonlinearConstraint(
            lambda y, k=k, c=c: values(y * span)[k] / c.size,
            -np.inf if c.lower is None else c.lower / c.size,
            np.inf if c.upper is None else c.upper / c.size,
        )
        for k, c in enumerate(task.constraints, 1)
    ]
    found = minimize(
        lambda y: sign * values(y * span)[0] / size,
        x0 / span,
        method="SLSQP",
        bounds=Bounds(low / span, high / span, keep_feasible=True),
        constraints=conditions,
        options={"maxiter": task.most, "ftol": 1e-8},
    )
    last = values(found.x * span)
    pairs = zip(task.constraints, last[1:], strict=True)
    excess = max((c.excess(v) / c.size for c, v in pairs), default=0.0)
    return float(last[0]), excess, len(values.known)


def inverter(say: Callable[[str], None]) -> None:
    """Compliant inverter by densities: uniform, and two uneven starts."""
    from examples.inverter import inverter as example

    nx = 40
    start = example.density(nx)
    x, y = start.mesh.points.T
    uneven = 0.3 + 0.15 * np.sin(x / 15.0) * np.cos(y / 12.0)
    noise = 0.3 + 0.1 * np.random.default_rng(1).uniform(-1.0, 1.0, len(x))
    for number, first in enumerate((None, uneven, noise), 1):
        counts = [0]

        def count(number: int, design: gradients.Design, counts: list[int] = counts) -> None:
            counts[0] = number

        begin = time.process_time()
        found, density = gradients.optimize_density(
            example.build, example.density(nx), example.stroke(start.mesh), example.SHARE,
            start=first, most=30, progress=count, threads=1,
        )  # fmt: skip
        soft = example.analyze(density.mesh, density.thicknesses(found))[1]
        body = ct.mesh.to_quadratic(density.body(found))
        exact = example.analyze(body, example.SHEET)[1]
        runs = 3 * counts[0]
        say(
            f"{'inverter':15s} {number} {soft:12.5f} (body {exact:.5f}) {runs:5d} "
            f"{'not run':>12s} {runs * (len(x) + 1):9d} {time.process_time() - begin:8.1f}"
        )


def check(name: str, fine: int, pictures: Path | None) -> list[str]:
    """Objective and constraints of an optimum on the mesh of its design and on a finer one."""
    task, finer = TASKS[name](), TASKS[name](fine)
    found = ct.optimize(
        task.build, task.starts[0], task.objective, task.constraints, bounds=task.bounds,
        maximize=task.maximize, most=task.most, threads=1,
    )  # fmt: skip
    rows, values = [], []
    for own in (task, finer):
        results = ct.solve(own.build(np.array(found.x)), threads=1)
        measures = [own.objective, *(c.measure for c in own.constraints)]
        values.append(Run(results, measures, adjoint=False).values)
        if pictures is not None and own is task:
            stem = name.replace(" ", "_")
            results.plot(path=pictures / f"{stem}-after.png")
            before = ct.solve(task.build(np.array(task.starts[0], float)), threads=1)
            before.plot(path=pictures / f"{stem}-before.png")
    for k, (one, two) in enumerate(zip(*values, strict=True)):
        what = "objective" if k == 0 else f"constraint {k}"
        rows.append(f"{name:15s} {what:13s} {one:12.6g} {two:12.6g} {two / one - 1.0:9.2%}")
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="of the designs; all by default")
    parser.add_argument("--check", action="store_true", help="optima on finer meshes alone")
    parser.add_argument("--pictures", type=Path, help="folder for designs before and after")
    given = parser.parse_args()
    names = given.names or [*TASKS, "inverter"]
    if given.check:
        if given.pictures is not None:
            given.pictures.mkdir(parents=True, exist_ok=True)
        print("design          value               design         fine difference")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for name in names:
                if name in TASKS:
                    print(*check(name, FINE, given.pictures), sep="\n", flush=True)
        return

    def say(line: str) -> None:
        print(line, flush=True)

    say(f"{'design':15s} start objective, runs with gradients; with differences; CPU [s] of both")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in names:
            if name == "inverter":
                inverter(say)
                continue
            task = TASKS[name]()
            for number, start in enumerate(task.starts, 1):
                begin = time.process_time()
                found = ct.optimize(
                    task.build, start, task.objective, task.constraints, bounds=task.bounds,
                    maximize=task.maximize, most=task.most, threads=1,
                )  # fmt: skip
                pairs = zip(task.constraints, found.constraints, strict=True)
                excess = max((c.excess(v) / c.size for c, v in pairs), default=0.0)
                first = time.process_time() - begin
                value, over, runs = by_differences(task, start)
                more = time.process_time() - begin - first
                say(
                    f"{name:15s} {number} {found.value:12.6g} {excess:8.1e} {found.runs:5d}   "
                    f"{value:12.6g} {over:8.1e} {runs:5d} {first:8.1f} {more:8.1f}   "
                    f"{np.round(found.x, 4)}"
                )


if __name__ == "__main__":
    main()

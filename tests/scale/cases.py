"""Small analyses of all kinds, each run by all processes together and by the default solver.

``mpiexec -n 2 python -m scale.cases FILE`` writes, by process and case, the largest differences.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota.analysis.linear.solvers import make_solver
from corota.errors import CorotaError, SingularError

Job = tuple[ct.Model, Any]


def cantilever(element: str = "Q4I", nx: int = 20, **more: Any) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=2))
    material = ct.Elastic(E=1.2e3, nu=0.3, rho=1e-3, **more)
    model.section("all", element=element, material=material)
    model.fix("left")
    return model


def drilling() -> Job:
    model = cantilever("Q4D")
    model.force("right", y=-0.4)
    model.gravity(y=-1.0)
    return model, ct.Static(increments=4)


def plasticity() -> Job:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=8, ny=4))
    steel = ct.Mises(E=2.1e5, nu=0.3, yield_stress=240.0, isotropic=800.0)
    model.section("all", element="Q4I", material=steel, local_strain="logarithmic")
    model.fix("left")
    model.fix("right", x=None, y=0.05)
    return model, ct.Static(increments=4)


def following_pressure() -> Job:
    """Its stiffness is unsymmetric: the matrix is gathered."""
    model = cantilever("Q4", nx=8)
    model.pressure("top", 0.5)
    return model, ct.Static(increments=3)


def dynamics() -> Job:
    model = cantilever(rayleigh=(0.1, 1e-4))
    model.force("right", y=-0.2)
    return model, ct.Dynamic(period=0.2, increments=8)


def conserving_dynamics() -> Job:
    model = cantilever("Q4D")
    model.force("right", y=-0.2)
    return model, ct.Dynamic(period=0.2, increments=6, scheme="energy_momentum")


def central_differences() -> Job:
    model = cantilever()
    model.force("right", y=-0.2)
    return model, ct.Dynamic(period=2e-3, scheme="central_difference")


def blocks(friction: float) -> ct.Model:
    lower = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    upper = ct.mesh.move(ct.mesh.rectangle(2.0, 1.0, nx=5, ny=2), (1.0, 1.0))
    model = ct.Model(ct.mesh.assembly(lower=lower, upper=upper))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("lower.bottom")
    model.contact("upper.bottom", "lower.top", friction=friction)
    return model


def contact() -> Job:
    """Contact alone constrains the upper block in y."""
    model = blocks(0.0)
    model.fix("upper.top", x=0.0, y=None)
    model.force("upper.top", y=-20.0)
    return model, ct.Static(increments=2)


def friction() -> Job:
    """Some of it slips: the matrix is unsymmetric."""
    model = blocks(0.2)
    model.fix("upper.top", x=0.05, y=-0.02)
    return model, ct.Static(increments=3)


def snap_through() -> Job:
    """A shallow arch by arc length, past its limit point."""
    rise = [lambda t, y=y: (10.0 * t, 0.5 * np.sin(np.pi * t) + y) for y in (0.0, 0.2)]
    ends = [lambda t, x=x: (x, 0.2 * t) for x in (10.0, 0.0)]
    model = ct.Model(ct.mesh.mapped([rise[0], ends[0], rise[1], ends[1]], nx=24, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0))
    model.fix("left")
    model.fix("right")
    model.force("top", y=-60.0)
    return model, ct.Static(path=ct.ArcLength(increments=8), increments=10, tolerance=1e-12)


def constraints() -> Job:
    """The right edge is rigid, in nodal axes at the left."""
    model = cantilever("Q4")
    right = model.mesh.nodes_of("right")
    model.rigid(right[1:], int(right[0]))
    model.local_axes("left", angle=0.5)
    model.force(right[:1], y=-0.2)
    return model, ct.Static(increments=2)


def frequencies() -> Job:
    return cantilever(), ct.Frequency(modes=4)


def buckling() -> Job:
    model = cantilever()
    model.force("right", x=-1.0)
    return model, ct.Buckle(modes=2)


def heating() -> Job:
    model = cantilever(expansion=1e-4)
    model.temperature(100.0, "top")
    return model, ct.Static(increments=2)


def python_law(strain: Any, state: Any, plane: str) -> Any:
    stiffness = 1e3 * np.array([[1.1, 0.33, 0.0], [0.33, 1.1, 0.0], [0.0, 0.0, 0.4]])
    return strain @ stiffness, np.broadcast_to(stiffness, (*strain.shape, 3)), state


def python_material() -> Job:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    model.section("all", element="Q4", material=ct.UserMaterial(python_law))
    model.fix("left")
    model.force("right", y=-0.4)
    return model, ct.Static(increments=2)


def inverted() -> Job:
    """The first increment inverts elements of one process: all cut it back."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.fix("right", x=-2.6, y=0.0)
    return model, ct.Static()


def unconstrained() -> Job:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left", y=None)
    model.force("right", y=-0.4)
    return model, ct.Static()


def unstable() -> Job:
    """A column above its buckling load; negative pivots are counted."""
    model = ct.Model(ct.mesh.rectangle(10.0, 0.2, nx=40, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    model.fix("left")
    model.force("right", x=-60.0)
    return model, ct.Static(increments=4)


CASES: dict[str, Callable[[], Job]] = {
    case.__name__: case
    for case in (
        drilling,
        plasticity,
        following_pressure,
        dynamics,
        conserving_dynamics,
        central_differences,
        contact,
        friction,
        snap_through,
        constraints,
        frequencies,
        buckling,
        heating,
        python_material,
        inverted,
        unstable,
    )
}
#: Scalars of frames that must agree.
SCALARS = ("ALLIE", "ALLKE", "ALLWK", "factor", "negative pivots", "frequency")


def difference(ours: Any, theirs: Any) -> dict[str, float]:
    """Largest differences of two results, relative to the largest value of the kind."""
    found = {"frames": float(abs(len(ours.frames) - len(theirs.frames)))}
    pairs = list(zip(ours.frames, theirs.frames, strict=False))
    for name in ("U", "UR", "RF"):
        values = [(getattr(a, name), getattr(b, name)) for a, b in pairs]
        size = max(float(np.abs(a).max()) for a, _ in values)
        found[name] = max(float(np.abs(a - b).max()) for a, b in values) / max(size, 1e-6)
    located = {float(point.factor) for point in ours.critical_points}
    size = max(float(np.abs(a.U).max()) for a, _ in pairs)
    between = [(a.U, b.U) for a, b in pairs if a.factor not in located]
    found["U between"] = max(float(np.abs(a - b).max()) for a, b in between) / max(size, 1e-6)
    for name in SCALARS:
        numbers = [(a.scalars.get(name, 0.0), b.scalars.get(name, 0.0)) for a, b in pairs]
        size = max(abs(float(a)) for a, _ in numbers)
        found[name] = max(abs(float(a - b)) for a, b in numbers) / max(size, 1e-6)
    return found


def stress_difference(ours: Any, theirs: Any) -> float:
    """The same of the stress at the points, of the cells that `theirs` has."""
    worst = 0.0
    for a, b in zip(ours.frames[-1].fields, theirs.frames[-1].fields, strict=True):
        rows = np.searchsorted(a.cells, b.cells)
        size = np.abs(a.values["S"]).max()
        if size > 0.0:
            error = np.abs(a.values["S"][rows] - b.values["S"]).max()
            worst = max(worst, float(error / size))
    return worst


def run(build: Callable[[], Job]) -> dict[str, Any]:
    """Run one case with both solvers."""
    model, step = build()
    ours = ct.solve(model, step, threads=1)
    theirs = ct.solve(model, step, solver="petsc")
    cells = sum(len(fields.cells) for fields in theirs.frames[-1].fields)
    every = sum(len(fields.cells) for fields in ours.frames[-1].fields)
    found: dict[str, Any] = difference(ours, theirs) | {"S": stress_difference(ours, theirs)}
    return found | {"cells": cells, "all cells": every}


def chain_without_support(process: int) -> list[float]:
    """Motion that the solver names where springs in a row are free; each process has every other.

    Other values first: the order and the memory of the solver are then those of later iterations.
    """
    n = 12
    indptr = np.concatenate([[0], 1 + 2 * np.arange(n)])
    indices = np.concatenate([[0], *([i - 1, i] for i in range(1, n))])
    solver = make_solver("petsc")
    solver.analyze(indptr, indices, np.arange(n))
    for ground in (1.0, 0.0):
        values = np.zeros(len(indices))
        values[0] = ground
        for i in range(1 + process, n, 2):
            values[indptr[i] - 1] += 1.0
            values[indptr[i + 1] - 1] += 1.0
            values[indptr[i]] -= 1.0
        try:
            solver.factorize(values)
        except SingularError as error:
            return [float(x) for x in np.ravel(np.asarray(error.mode, float))]
    return []


def main(path: Path) -> None:
    from mpi4py import MPI

    warnings.simplefilter("ignore")
    found: dict[str, Any] = {name: run(build) for name, build in CASES.items()}
    model, step = unconstrained()
    try:
        ct.solve(model, step, solver="petsc")
    except CorotaError as error:
        found["unconstrained"] = str(error)
    model, step = drilling()
    large = ct.solve(model, step, solver="petsc:gamg")
    found["multigrid"] = difference(ct.solve(model, step, threads=1), large)
    found["chain"] = chain_without_support(MPI.COMM_WORLD.rank)
    every = MPI.COMM_WORLD.gather(found)
    if every is not None:
        path.write_text(json.dumps(every))


if __name__ == "__main__":
    main(Path(sys.argv[1]))

"""The structural task of Mosaic in its plane, beside JAX-FEM: errors and times in one run.

Mosaic (``pip install mosaic-bench``, a suite of differentiable solvers) minimizes the compliance of
a cantilever of 2 x 1 x 1 by densities with the penalty ``E = Emin + (Emax - Emin) rho^3``, and
compares solvers by the error of their gradients against differences along random directions and by
their times. Its solvers run in containers on bricks; Corota is planar. So the task is rebuilt in
plane strain: the same size, clamp, load, material and penalty, random densities of 0.5 +- 0.3, at
the nodes, from which the stiffness is interpolated.

``python -m benchmarks differentiable --python PATH`` takes JAX-FEM from another interpreter (``pip
install jax-fem jax meshio fenics-basix gmsh pyfiglet scipy``); without it Corota alone is compared
with differences.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Emax [MPa], Poisson's ratio, Emin over Emax, and load [N] of Mosaic's task.
YOUNG, POISSON, LEAST, LOAD = 70e3, 0.3, 1e-3, 1.0
#: Cells along the length, and directions and steps of the differences, as in Mosaic's check.
SIZES, DIRECTIONS = (8, 32, 96, 192), 6
STEPS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


def cantilever(density: Floats, nx: int) -> ct.Model:
    """The task with densities of the nodes."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=nx, ny=nx // 2)
    model = ct.Model(mesh)
    stiffness = LEAST + (1.0 - LEAST) * density**3
    model.section(
        "all", element="Q4", material=ct.Elastic(E=YOUNG, nu=POISSON), plane="strain",
        thickness=stiffness,
    )  # fmt: skip
    model.fix("left")
    for node, force in zip(mesh.node_sets["right"], edge_forces(mesh), strict=True):
        model.force([int(node)], y=-float(force))
    model.steps = [ct.Static(nlgeom=False)]
    return model


def edge_forces(mesh: ct.Mesh) -> Floats:
    """Nodal forces of an even traction on the right side."""
    nodes = mesh.node_sets["right"]
    y = mesh.points[nodes, 1]
    inner = (y > 1e-9) & (y < 1.0 - 1e-9)
    return np.where(inner, 1.0, 0.5) * LOAD / (len(nodes) - 1)


def compliance(mesh: ct.Mesh) -> gradients.Measure:
    """Work of the load."""
    nodes = mesh.node_sets["right"]
    order = nodes[np.argsort(mesh.points[nodes, 1])]
    n = len(nodes) - 1
    ends = gradients.Displacement(order[[0, -1]], "y") * 2.0
    total = gradients.Displacement(nodes, "y") * float(n + 1)
    return (total - ends * 0.5) * (-LOAD / n)


def value(density: Floats, nx: int) -> float:
    """Compliance of densities."""
    model = cantilever(density, nx)
    results = ct.solve(model, threads=1, fields=False)
    return float(Run(results, [compliance(model.mesh)], adjoint=False).values[0])


def with_gradient(density: Floats, nx: int) -> tuple[float, Floats]:
    """Compliance and its gradient by the densities."""
    model = cantilever(density, nx)
    results = ct.solve(model, threads=1, fields=False)
    run = Run(results, [compliance(model.mesh)])
    by_thickness = run.by(gradients.Thickness(by="node"))[0]
    return float(run.values[0]), by_thickness * 3.0 * (1.0 - LEAST) * density**2


def error(slope: Floats, density: Floats, nx: int) -> float:
    """Largest relative error along random directions, each with the step that fits best."""
    rng = np.random.default_rng(0)
    worst = 0.0
    for _ in range(DIRECTIONS):
        way = rng.normal(size=len(density))
        way /= np.linalg.norm(way)
        exact = float(slope @ way)
        errors = []
        for step in STEPS:
            near = value(density + step * way, nx) - value(density - step * way, nx)
            far = value(density + 2 * step * way, nx) - value(density - 2 * step * way, nx)
            errors.append(abs((8.0 * near - far) / (12.0 * step) - exact))
        worst = max(worst, min(errors) / float(np.linalg.norm(slope)))
    return worst


def peer(python: str, density: Floats, nx: int, repeats: int) -> dict[str, Any]:
    """Values and times of JAX-FEM."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=nx, ny=nx // 2)
    force = np.zeros(mesh.n_nodes)
    force[mesh.node_sets["right"]] = edge_forces(mesh)
    worker = Path(__file__).parents[1] / "peers" / "run_jax_fem.py"
    with tempfile.TemporaryDirectory() as folder:
        task, result = Path(folder) / "task.npz", Path(folder) / "result.npz"
        np.savez(
            task, points=mesh.points, cells=mesh.cells[0].nodes, density=density, force=force,
            young=YOUNG, poisson=POISSON, least=LEAST, load=LOAD, height=1.0, repeats=repeats,
        )  # fmt: skip
        subprocess.run(
            [python, str(worker), str(task), str(result)], check=True, capture_output=True
        )
        return dict(np.load(result))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--python", help="interpreter with JAX-FEM")
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="cells along the length")
    given = parser.parse_args()
    print("program    cells     dofs compliance  run [s]  with gradient [s]  error, other program")
    for nx in (n for n in SIZES if n <= given.largest):
        nodes = (nx + 1) * (nx // 2 + 1)
        noise = np.random.default_rng(0).normal(size=nodes)
        density = np.clip(0.5 + 0.3 * noise, 0.05, 0.95)
        repeats = 5 if nx < 64 else 2
        with_gradient(density, nx)
        begin = time.perf_counter()
        for _ in range(repeats):
            value(density, nx)
        forward = (time.perf_counter() - begin) / repeats
        begin = time.perf_counter()
        for _ in range(repeats):
            found, slope = with_gradient(density, nx)
        both = (time.perf_counter() - begin) / repeats
        off = error(slope, density, nx) if nx < 64 else float("nan")
        head = f"{nx * (nx // 2):6d} {2 * nodes:8d}"
        print(f"Corota    {head} {found:.8e} {forward:8.4f} {both:8.4f} {off:10.1e}", flush=True)
        if given.python:
            other = peer(given.python, density, nx, repeats)
            far = float(np.abs(other["slope"] - slope).max() / np.abs(slope).max())
            off = error(other["slope"], density, nx) if nx < 64 else float("nan")
            print(
                f"JAX-FEM   {head} {float(other['value']):.8e} {float(other['forward']):8.4f} "
                f"{float(other['both']):8.4f} {off:10.1e} {far:10.1e}",
                flush=True,
            )


if __name__ == "__main__":
    main()

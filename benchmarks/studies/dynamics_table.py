"""What mass and scheme cost and give: the tables of docs/measured.md.

Three motions (a cantilever under a load that comes on smoothly, a free spinning rod, a flexible
pendulum), four elements, three masses, two meshes and two time steps with the energy-momentum
scheme: error of the path of the tip against a fine reference of the same problem (root mean
square over time, relative to that of its displacement); iterations an increment; relative
drift of energy balance and angular momentum; time. Then the drift of every scheme on the free rod.

``--quick`` takes the coarse mesh only; ``--write`` puts the tables between the marks in
docs/measured.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from functools import cache
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.common import machine, write_between

ELEMENTS = {"Q4I": "quad4", "Q8": "quad8", "OPT": "tri3", "Q4D": "quad4"}
MASSES = ("consistent", "constant", "lumped")
#: Length, depth, modulus, period, increments of the coarse time step.
CASES = {
    "cantilever": (10.0, 0.5, 1e6, 3.0, 60),
    "free rod": (10.0, 0.5, 1e4, 3.0, 60),
    "pendulum": (1.0, 0.05, 2e4, 1.5, 60),
}
MESHES = (8, 16)
PAGE = Path(__file__).resolve().parents[2] / "docs" / "measured.md"


def model(case: str, element: str, cells: int) -> ct.Model:
    """Build one of the three problems with `cells` along and one (or two) across."""
    length, depth, modulus, _, _ = CASES[case]
    # Two cells across: the pivot and the tip in the middle need nodes there.
    mesh = ct.mesh.rectangle(length, depth, nx=cells, ny=2, cell=ELEMENTS[element])
    made = ct.Model(mesh)
    made.section("all", element=element, material=ct.Elastic(E=modulus, nu=0.3, rho=1.0))
    if case == "cantilever":
        made.fix("left", rotation=True)
        # Comes on smoothly: no increment meets a mode that it does not resolve.
        made.amplitudes["on"] = ct.Amplitude(
            np.linspace(0.0, 1.0, 101), np.sin(np.linspace(0.0, 0.5 * np.pi, 101)) ** 2
        )
        made.traction("right", y=75.0, amplitude="on")
    elif case == "free rod":
        # Spins, and bends as the force couple of a short time sets it in motion.
        made.velocity(spin=2.0, about=(length / 2.0, depth / 2.0))
        made.amplitudes["pulse"] = ct.Amplitude(
            np.linspace(0.0, 0.5, 51), np.sin(np.linspace(0.0, np.pi, 51)) ** 2
        )
        made.traction("right", y=12.0, amplitude="pulse")
    else:
        made.fix([node(mesh, 0.0, depth / 2.0)])
        made.amplitudes["on"] = ct.Amplitude(
            np.linspace(0.0, 0.25, 51), np.sin(np.linspace(0.0, 0.5 * np.pi, 51)) ** 2
        )
        made.gravity(y=-9.81, amplitude="on")
    return made


def node(mesh: ct.Mesh, x: float, y: float) -> int:
    """Node nearest to a point."""
    return int(np.argmin(np.hypot(*(mesh.points - np.array([x, y])).T)))


def run(
    case: str,
    element: str,
    mass: str,
    cells: int,
    increments: int,
    scheme: str = "energy_momentum",
) -> tuple[np.ndarray, dict[str, float]]:
    """Path of the tip at the coarse times, shape (n, 2), and the figures of a run."""
    length, depth, _, period, _ = CASES[case]
    made = model(case, element, cells)
    tip = node(made.mesh, length, depth / 2.0)
    begin = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(
            made,
            ct.Dynamic(
                period=period, increments=increments, scheme=scheme, mass=mass, tolerance=1e-10
            ),
            threads=1,
            fields=False,
        )
    seconds = time.process_time() - begin
    frames = results.frames[1:]
    value = {n: np.array([f.scalars[n] for f in frames]) for n in frames[-1].scalars}
    # Momentum is conserved once the pulse is over.
    late = np.array([f.time for f in frames]) > 0.55 if case == "free rod" else slice(None)
    angular = value["angular momentum"][late] if "angular momentum" in value else np.full(1, np.nan)
    kinetic = value["kinetic energy"].max()
    figures = {
        "iterations": float(value["iterations"].mean()),
        "energy": float(np.ptp(value["energy balance"]) / kinetic),
        "angular": float(np.ptp(angular) / np.abs(angular).max()) if case == "free rod" else np.nan,
        "seconds": seconds,
    }
    every = increments // CASES[case][4]
    return np.array([f.U[tip] for f in frames[every - 1 :: every]]), figures


@cache
def reference(case: str) -> np.ndarray:
    """Q8 on a mesh twice and with a time step four times as fine as the finest of the table."""
    fine = 4 * 2 * CASES[case][4]
    return run(case, "Q8", "consistent", 2 * MESHES[-1], fine)[0]


def masses(meshes: tuple[int, ...]) -> list[str]:
    """Table of masses."""
    lines = [
        "| motion | element | mass | cells | increments | error | iterations | energy | "
        "momentum | CPU s |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for case, (*_, coarse) in CASES.items():
        exact = reference(case)
        for element in ELEMENTS:
            for mass in MASSES:
                for cells in meshes:
                    for increments in (coarse, 2 * coarse):
                        tip, f = run(case, element, mass, cells, increments)
                        error = np.linalg.norm(tip - exact) / np.linalg.norm(exact)
                        angular = f"{f['angular']:.0e}" if np.isfinite(f["angular"]) else ""
                        lines.append(
                            f"| {case} | {element} | {mass} | {cells} x 2 | {increments} | "
                            f"{error:.2%} | {f['iterations']:.1f} | {f['energy']:.0e} | "
                            f"{angular} | {f['seconds']:.2f} |"
                        )
                        sys.stdout.write(lines[-1] + "\n")
                        sys.stdout.flush()
    return lines


def schemes() -> list[str]:
    """Table of the drift of each scheme."""
    lines = [
        "| scheme | increments | energy balance | angular momentum | iterations |",
        "| --- | --- | --- | --- | --- |",
    ]
    for scheme in ("energy_momentum", "newmark", "hht", "generalized_alpha"):
        for increments in (60, 120):
            _, f = run("free rod", "Q4I", "consistent", 8, increments, scheme)
            lines.append(
                f"| {scheme} | {increments} | {f['energy']:.0e} | {f['angular']:.0e} | "
                f"{f['iterations']:.1f} |"
            )
    _, f = run("free rod", "Q4I", "lumped", 8, 3000, "central_difference")
    return [*lines, f"| central_difference | 3000 | {f['energy']:.0e} | | 1.0 |"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    drift = schemes()
    sys.stdout.write("\n".join(drift) + "\n")
    table = masses(MESHES[:1] if args.quick else MESHES)
    text = "\n".join([f"Measured on {machine()}.", "", *drift, "", *table])
    if args.write:
        write_between(PAGE, "dynamics tables", text)


if __name__ == "__main__":
    main()

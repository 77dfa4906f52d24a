"""A compliant inverter found by the density method, extracted and analyzed again.

Half of a square block of 100 x 100 mm, cut along its axis of symmetry, is held at its left corners.
A force pushes the middle of the left side in; the middle of the right side shall move against it,
against a spring. Large displacements are included all the time. The body where the density exceeds
1/2 is meshed to its boundary and analyzed again: the difference is the error of the densities.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota import gradients

#: Size of the half [mm], sheet of nylon [mm, MPa], force [N] and springs [N/mm].
LENGTH, HEIGHT, SHEET, YOUNG, POISSON = 100.0, 50.0, 5.0, 1800.0, 0.4
FORCE, INPUT_SPRING, OUTPUT_SPRING = 300.0, 200.0, 200.0
#: Share of material, and radius of the filter [mm].
SHARE, RADIUS = 0.3, 6.0


def nearest(mesh: ct.Mesh, x: float, y: float) -> int:
    """Node at a place."""
    return int(np.argmin(np.hypot(*(mesh.points - (x, y)).T)))


def build(mesh: ct.Mesh, thickness: Any) -> ct.Model:
    """Half of the inverter of a mesh and the thickness of its nodes."""
    entry, out = nearest(mesh, 0.0, 0.0), nearest(mesh, LENGTH, 0.0)
    points = ct.mesh.Cells("point1", np.array([[entry], [out]]), mesh.n_cells + np.array([1, 2]))
    whole = ct.Mesh(mesh.points, [*mesh.cells, points])
    model = ct.Model(whole, name="inverter")
    element = "Q4I" if mesh.cells[0].kind == "quad4" else "T6"
    solid = np.arange(mesh.n_cells)
    model.section(
        solid, element=element, material=ct.Elastic(E=YOUNG, nu=POISSON), thickness=thickness
    )
    model.spring([mesh.n_cells], INPUT_SPRING, "x")
    model.spring([mesh.n_cells + 1], OUTPUT_SPRING, "x")
    x, y = mesh.points.T
    model.fix(np.flatnonzero((x < 1e-6) & (y > 0.9 * HEIGHT)))
    model.fix(np.flatnonzero(y < 1e-6), x=None)
    model.force([entry], x=FORCE)
    model.steps = [ct.Static(increments=4)]
    return model


def density(nx: int = 40) -> gradients.Density:
    """Densities on nx x nx/2 elements; where forces and supports act there is material."""
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx=nx, ny=nx // 2)
    x, y = mesh.points.T
    ends = ((x < 5.1) | (x > LENGTH - 5.1)) & (y < 5.1) | (x < 5.1) & (y > 0.9 * HEIGHT - 0.1)
    return gradients.Density(mesh, RADIUS, thickness=SHEET, solid=np.flatnonzero(ends), least=1e-4)


def stroke(mesh: ct.Mesh) -> gradients.Measure:
    """Displacement of the output [mm]; negative is against the force."""
    return gradients.Displacement(nearest(mesh, LENGTH, 0.0), "x")


def find(
    nx: int = 40, most: int = 30, record: Path | None = None, **options: Any
) -> tuple[np.ndarray, gradients.Density]:
    """The densities of the best inverter."""
    start = density(nx)
    return gradients.optimize_density(
        build, start, stroke(start.mesh), SHARE, most=most, record=record, **options
    )


def analyze(mesh: ct.Mesh, thickness: Any) -> tuple[ct.Results, float]:
    """Analysis of a body, and the displacement of its output."""
    results = ct.solve(build(mesh, thickness), ct.Static(increments=8))
    return results, float(results.frames[-1].U[nearest(mesh, LENGTH, 0.0), 0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--record", type=Path, help="file from which the search goes on")
    record = parser.parse_args().record
    x, found = find(record=record)
    body = gradients.reanalyze(build, found, x, stroke)
    sys.stdout.write(
        f"share of material {found.volume(x)[0]:.4f}, gray {found.gray(x):.4f}\n"
        f"output by densities {body.densities:.4f} mm, by the body {body.body:.4f} mm "
        f"({body.mesh.n_cells} triangles), off by {body.error:.1%}\n"
    )


if __name__ == "__main__":
    main()

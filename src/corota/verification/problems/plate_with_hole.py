"""Infinite plate with a circular hole in tension (Kirsch), and a finite strip (Howland).

Kirsch's plate: a quarter of 4 x 4 hole radii carries the exact tractions of the infinite plate on
its outer edges; the ratio of the stress to the applied one is 3 at the side of the hole and -1 at
its pole. Howland's strip with a hole of half its width: 4.32 of the gross stress by his series; our
meshes converge to 4.347 with the same order as Kirsch's to 3.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import cell, edge_forces, nearest, run
from corota.verification.plastic_models import find, strip_mesh

R = 5.0


def kirsch(x: float, y: float) -> np.ndarray:
    """Stress (xx, yy, xy) about a hole of radius R under unit tension along x."""
    r, a = np.hypot(x, y), np.arctan2(y, x)
    q, c2, c4 = (R / r) ** 2, np.cos(2 * a), np.cos(4 * a)
    s2, s4 = np.sin(2 * a), np.sin(4 * a)
    return np.array(
        [
            1 - q * (1.5 * c2 + c4) + 1.5 * q * q * c4,
            -q * (0.5 * c2 - c4) - 1.5 * q * q * c4,
            -q * (0.5 * s2 + s4) + 1.5 * q * q * s4,
        ]
    )


def _quarter(element: str, n: int, width: float, height: float) -> ct.Model:
    mesh = strip_mesh(n, cell(element), width, height)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix(find(mesh, 0, 0.0), y=None)
    model.fix(find(mesh, 1, 0.0), x=None)
    return model


def _edges(model: ct.Model, axis: int, value: float) -> str:
    mesh, edges = model.mesh, model.mesh.boundary_edges()
    middle = [mesh.points[list(nodes)[:2], axis] for nodes in mesh.edge_nodes(edges)]
    name = f"side {axis}"
    mesh.edge_sets[name] = edges[[bool(np.abs(m - value).max() < 1e-9) for m in middle]]
    return name


def infinite(element: str, n: int) -> ct.Results:
    """Square of twice the hole's radius with Kirsch's tractions; it is pulled along x."""
    model = _quarter(element, n, 2.0 * R, 2.0 * R + 2.0 * R)
    for axis, place in ((0, 2.0 * R), (1, 4.0 * R)):

        def traction(x: np.ndarray, axis: int = axis) -> np.ndarray:
            s = kirsch(float(x[0]), float(x[1]))
            return np.array([s[0], s[2]] if axis == 0 else [s[2], s[1]])

        model.loads += edge_forces(model.mesh, _edges(model, axis, place), traction)
    return run(model, ct.Static(nlgeom=False), fields=True)


def strip(element: str, n: int) -> ct.Results:
    """Quarter of a long strip, half width twice the hole's radius, pulled along y."""
    model = _quarter(element, n, 2.0 * R, 12.0 * R)
    model.traction(_edges(model, 1, 12.0 * R), y=1.0)
    return run(model, ct.Static(nlgeom=False), fields=True)


def stresses(results: ct.Results) -> tuple[float, float]:
    """Stress along x at the pole of the hole (0, R), and along y at its side (R, 0)."""
    mesh = results.mesh
    pole, side = nearest(mesh, 0.0, R), nearest(mesh, R, 0.0)
    return float(results.nodal("S11")[pole]), float(results.nodal("S22")[side])


def measure() -> Iterator[Value]:
    """Both plates."""
    for element in ("Q8", "Q9"):
        top, side = stresses(infinite(element, 16))
        yield Value(f"Kirsch: largest stress, {element}, n = 16", 3.0, top, 5e-3)
        yield Value(f"Kirsch: smallest stress, {element}, n = 16", -1.0, side, 2e-2)
        yield Value(
            f"Howland: largest stress, {element}, n = 16",
            4.32,
            stresses(strip(element, 16))[1],
            0.01,
        )


def study() -> Study:
    """Error of the largest stress of the infinite plate."""
    return Study.over(
        "error of the largest stress",
        ("Q4I", "T6", "Q8", "Q9"),
        (3, 6, 12, 24),
        lambda e, n: abs(stresses(infinite(e, n))[0] / 3.0 - 1.0),
        "cells along an eighth of the hole",
    )


PROBLEM = Problem(
    title="Plates with a hole (Kirsch, Howland)",
    group="linear statics",
    source="G. Kirsch (1898); R. C. J. Howland, Phil. Trans. R. Soc. A 229 (1930)",
    certainty="analytic",
    why="stresses at the edge are extrapolated from points inside; Howland's series of 1930 "
    "is half a percent low",
    picture=lambda: Picture(strip("Q8", 8), "S22", 0.0),
    seconds=2.0,
)

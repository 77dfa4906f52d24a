"""Flexures of the tests of stages."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

import corota as ct


def cross_spring(n: int = 40, depth: float = 0.002, based: bool = False) -> ct.Model:
    """Two leaves of length 1 and EI = 1 at 90 degrees that cross at half length.

    Parameters
    ----------
    n : int
        Beams of each leaf.
    depth : float
        Of the leaves: their E A is 12 / depth^2.
    based : bool
        Whether the feet belong to a rigid body ``base``; else they are fixed.
    """
    half = 0.5 / np.sqrt(2.0)
    way = np.linspace(-half, half, n + 1)
    points = np.concatenate([np.column_stack([way, way]), np.column_stack([-way, way])])
    first = np.concatenate([np.arange(n), n + 1 + np.arange(n)])
    cells = ct.Cells("line2", np.column_stack([first, first + 1]), np.arange(1, 2 * n + 1))
    mesh = ct.Mesh(points, [cells])
    hub = ct.mesh.add_node(mesh, 0.0, 0.0, "hub")
    base = ct.mesh.add_node(mesh, 0.0, -half, "base") if based else -1
    model = ct.Model(mesh)
    leaf = ct.Elastic(E=12.0 / depth**3, nu=0.0)
    model.beam(np.arange(2 * n), material=leaf, area=depth, inertia=depth**3 / 12.0)
    if based:
        model.rigid([0, n + 1], base)
    else:
        model.fix([0, n + 1], rotation=True)
    model.rigid([n, 2 * n + 1], hub)
    return model


def parallelogram(element: str = "Q4I") -> ct.Model:
    """Two leaves 10 x 0.5, 6 apart, that carry a bar of the same material, the set ``stage``."""
    leaf = ct.mesh.rectangle(0.5, 10.0, nx=1, ny=20)
    bar = ct.mesh.move(ct.mesh.rectangle(7.0, 1.0, nx=14, ny=2), (0.0, 10.0))
    mesh = ct.mesh.merge(leaf, ct.mesh.move(leaf, (6.5, 0.0)), bar)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3))
    mesh.node_sets["stage"] = mesh.nodes_of(ct.inside((-1.0, 10.0), (8.0, 12.0)))
    model.fix(ct.on_line((0.0, 0.0), (7.0, 0.0)), rotation=element == "Q4D")
    return model


def snap_through(half: float = 10.0, rise: float = 2.0) -> ct.Model:
    """Half of a shallow truss of two bars, E A = 1000; the body ``apex`` slides down."""
    bar = ct.Cells("line2", np.array([[0, 1]]), np.array([1]))
    mesh = ct.Mesh(np.array([[0.0, 0.0], [half, rise]]), [bar])
    apex = ct.mesh.add_node(mesh, half, rise, "apex")
    model = ct.Model(mesh)
    model.truss([0], material=ct.Elastic(E=1000.0, nu=0.0), area=1.0)
    model.fix([0])
    model.rigid([1], apex)
    model.fix("apex", x=0.0, y=None, rotation=0.0)
    return model


def bar_load(travel: np.ndarray, half: float = 10.0, rise: float = 2.0) -> np.ndarray:
    """Force that pushes the apex of :func:`snap_through` down, in closed form."""
    height = rise - travel
    length, start = np.hypot(half, height), np.hypot(half, rise)
    return 1000.0 * (start - length) / start * height / length


__all__ = ["bar_load", "cross_spring", "parallelogram", "snap_through"]

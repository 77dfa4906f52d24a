"""What the audit of contact shares: blocks, chains and runs with the default settings."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells

METHODS = ("mortar", "node_to_segment")
STIFF = ct.Elastic(E=1e7, nu=0.3)


def solve(model: ct.Model, *steps: Any, **options: Any) -> ct.Results:
    """Run with the defaults, without the warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, list(steps) or None, threads=1, **options)


def block(
    lx: float,
    ly: float,
    nx: int,
    ny: int,
    at: tuple[float, float] = (0.0, 0.0),
    angle: float = 0.0,
    cell: str = "quad4",
) -> Mesh:
    """A rectangle whose lower left corner is turned about the origin and then moved to `at`."""
    return ct.mesh.move(ct.mesh.rectangle(lx, ly, nx, ny, cell=cell), at, angle=angle)  # type: ignore[arg-type]


def chain(points: Any, closed: bool = False) -> Mesh:
    """Lines through points, as the cell set "chain"."""
    points = np.asarray(points, dtype=float)
    n = len(points)
    a = np.arange(n if closed else n - 1)
    mesh = Mesh(
        points,
        [Cells("line2", np.column_stack([a, (a + 1) % n]), a + 1)],
        np.arange(1, n + 1),
    )
    mesh.cell_sets["chain"] = a
    return mesh


def scalar(results: ct.Results, name: str, frame: int = -1) -> float:
    return float(results.frames[frame].scalars[name])


def reaction(results: ct.Results, nodes: Any, frame: int = -1) -> np.ndarray:
    """Sum of the reactions of nodes: force x, force y, and the moments at the nodes."""
    if isinstance(nodes, str):
        nodes = results.mesh.nodes_of(nodes)
    total: np.ndarray = results.frames[frame].RF[nodes].sum(axis=0)
    return total


def step_ends(results: ct.Results) -> list[Any]:
    """The last frame of every step."""
    frames = results.frames
    return [
        f for f, g in zip(frames, [*frames[1:], None], strict=True) if g is None or g.step > f.step
    ]

"""Shape of the cells, and unconnected nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import Diagnostic
from corota.mesh.kinds import PLANAR
from corota.mesh.quality import STRAIGHT, aspect_ratio, corner_sines, jacobians
from corota.model.joints import constrained_nodes, joined_nodes

if TYPE_CHECKING:
    from corota.arrays import Bools, Ints
    from corota.mesh.data import Mesh
    from corota.model.model import Model

#: Corners flatter than 10 degrees, or turned by more than 170.
FLAT_SINE = 0.17
#: Smallest over largest Jacobian of a cell that is far from its regular shape.
UNEVEN = 0.1
#: Longest over shortest side.
LONG = 20.0
#: Distance of nodes at the same place, relative to the model.
TOUCHING = 1e-7


def check_cells(model: Model) -> list[Diagnostic]:
    """Findings about cells and nodes."""
    mesh = model.mesh
    found: list[Diagnostic] = []
    used = np.zeros(mesh.n_nodes, bool)
    for block in mesh.cells:
        used[block.nodes] = True
        if block.kind not in PLANAR:
            continue  # a line has no angles
        points = mesh.points[block.nodes]
        jacobian = jacobians(block.kind, points)
        ratio = jacobian.min(axis=1) / np.abs(jacobian).max(axis=1)
        sines = corner_sines(block.kind, points).min(axis=1)
        bad = (jacobian.min(axis=1) <= 0.0) | (sines < -STRAIGHT)
        found += _many("error", block.labels[bad], "inverted or folded", "repair the mesh")
        far = ~bad & ((ratio < UNEVEN) | (sines < FLAT_SINE))
        found += _many(
            "warning", block.labels[far], "far from a regular shape", "expect poor stresses there"
        )
        aspect = aspect_ratio(block.kind, points)
        if (aspect > LONG).any():
            worst = int(aspect.argmax())
            found.append(
                Diagnostic(
                    "warning",
                    f"{int((aspect > LONG).sum())} cells are longer than {LONG:g} times their "
                    f"width; the worst is element {block.labels[worst]} ({aspect[worst]:.0f})",
                )
            )
    lonely = mesh.node_labels[~(used | constrained_nodes(model))]
    if len(lonely):
        found.append(
            Diagnostic("note", f"{len(lonely)} nodes belong to no cell, such as {lonely[0]}")
        )
    return found + _same_place(mesh, np.flatnonzero(used), joined_nodes(model))


def _many(severity: str, labels: Ints, text: str, hint: str) -> list[Diagnostic]:
    if len(labels) == 0:
        return []
    others = f" and {len(labels) - 1} others are" if len(labels) > 1 else " is"
    return [Diagnostic(severity, f"element {labels[0]}{others} {text}", hint=hint)]


def _same_place(mesh: Mesh, used: Ints, joined: Bools) -> list[Diagnostic]:
    """Pairs of nodes at one place of which neither is joined to anything."""
    if len(used) < 2:
        return []
    from scipy.spatial import cKDTree  # takes longer to import than a small job to solve

    size = float(np.ptp(mesh.points[used], axis=0).max())
    pairs = cKDTree(mesh.points[used]).query_pairs(TOUCHING * size, output_type="ndarray")
    pairs = pairs[~joined[used[pairs]].any(axis=1)]
    if not len(pairs):
        return []
    a, b = mesh.node_labels[used[pairs[0]]]
    return [
        Diagnostic(
            "warning",
            f"{len(pairs)} pairs of nodes lie at the same place and are not joined, such as "
            f"{a} and {b}",
            hint="merge them (corota.mesh.merge), unless a slit is intended",
        )
    ]

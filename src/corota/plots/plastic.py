"""The elastic-plastic boundary."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError

if TYPE_CHECKING:
    from corota.arrays import Ints
    from corota.results.results import Results


def boundary(results: Results, frame: int = -1) -> Ints:
    """Edges between cells with plastic strain at some point and cells without any.

    Parameters
    ----------
    results : Results
        With the variable ``PEEQ``.
    frame : int

    Returns
    -------
    ndarray of int, shape (n, 2)
        Corner nodes of the edges.

    Raises
    ------
    InputError
        If the results have no plastic strain.
    """
    if "PEEQ" not in results.variables(frame):
        raise InputError(
            "there is no plastic strain (PEEQ) whose boundary could be drawn: plastic=True is for "
            "models with a material that flows"
        )
    plastic = np.nan_to_num(results.cells("PEEQ", frame)) > 0.0
    edges, flows = [], []
    for offset, cells in zip(results.mesh.offsets, results.mesh.cells, strict=False):
        if not cells.kind.startswith(("tri", "quad")):
            continue
        corners = cells.nodes[:, : 3 if cells.kind.startswith("tri") else 4]
        pairs = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)
        edges.append(np.sort(pairs.reshape(-1, 2), axis=1))
        flows.append(np.repeat(plastic[offset : offset + len(cells)], corners.shape[1]))
    every, flow = np.concatenate(edges), np.concatenate(flows)
    unique, index = np.unique(every, axis=0, return_inverse=True)
    counts = np.bincount(index.ravel(), minlength=len(unique))
    yielding = np.bincount(index.ravel(), weights=flow, minlength=len(unique))
    found: Ints = unique[(counts == 2) & (yielding == 1)]
    return found


def draw_boundary(ax: Any, results: Results, frame: int, scale: float) -> None:
    """Draw the elastic-plastic boundary on the deformed shape."""
    from matplotlib.collections import LineCollection

    positions = results.mesh.points + scale * results.frame(frame).U
    lines = positions[boundary(results, frame)]
    ax.add_collection(LineCollection(list(lines), colors="black", linewidths=1.2, zorder=4))

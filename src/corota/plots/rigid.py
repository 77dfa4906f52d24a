"""Rigid curves of contact as lines with a shaded rigid side."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.results.rigid import moved, rigid_curves

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.model.model import Model
    from corota.results.results import Frame


#: Color of rigid bodies, and the width of their shaded side as a share of the model's size.
STEEL, BAND = "#5b6470", 0.018
#: Rigid curves that make a picture larger than this times the body are not framed whole.
LARGE = 2.5


def with_rigid(
    model: Model, low: Floats, high: Floats, frame: Frame | None = None, scale: float = 1.0
) -> tuple[Floats, Floats]:
    """Extend an extent, shape (2,) each, by the rigid curves that are not far larger."""
    body = float(np.linalg.norm(high - low))
    for curve in rigid_curves(model):
        points = np.concatenate(moved(model, curve, frame, scale))
        least, most = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
        if np.linalg.norm(most - least) <= LARGE * body:
            low, high = least, most
    return low, high


def draw_rigid(ax: Any, model: Model, frame: Frame | None = None, scale: float = 1.0) -> None:
    """Draw the rigid curves of a model, each once, into axes."""
    from matplotlib.collections import LineCollection, PolyCollection

    width = BAND * float(np.ptp(model.mesh.points, axis=0).max())
    for curve in rigid_curves(model):
        lines = moved(model, curve, frame, scale)
        bands = []
        for points in lines:
            along = np.gradient(points, axis=0)
            normal = np.column_stack([along[:, 1], -along[:, 0]])
            normal /= np.hypot(*normal.T)[:, None]
            bands.append(np.concatenate([points, (points + width * normal)[::-1]]))
        ax.add_collection(PolyCollection(bands, facecolors=STEEL, alpha=0.35, linewidths=0.0))
        ax.add_collection(LineCollection(lines, colors=STEEL, linewidths=1.3))

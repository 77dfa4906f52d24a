"""Rigid curves of contact as lines of points, moved with their reference nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.model.model import Model
    from corota.results.results import Frame


def rigid_curves(model: Model) -> list[RigidCurve]:
    """The rigid curves of a model, each once; the lines of gap elements are no bodies."""
    found = {
        id(pair.master): pair.master
        for pair in model.contacts
        if isinstance(pair.master, RigidCurve) and pair.master.turns
    }
    return list(found.values())


def rigid_lines(curve: RigidCurve) -> list[Floats]:
    """Each segment of a curve as points, shape (k, 2); arcs by pieces of 4 degrees."""
    lines = []
    for row in curve.segments:
        start, end, center, sweep = row[:2], row[2:4], row[4:6], float(row[6])
        if sweep == 0.0:
            lines.append(np.array([start, end]))
            continue
        angle = np.linspace(0.0, sweep, 2 + math.ceil(abs(sweep) / math.radians(4.0)))
        c, s = np.cos(angle), np.sin(angle)
        x, y = start - center
        lines.append(center + np.column_stack([c * x - s * y, s * x + c * y]))
    return lines


def moved(model: Model, curve: RigidCurve, frame: Frame | None, scale: float = 1.0) -> list[Floats]:
    """Lines of a curve, moved with its reference node."""
    lines = rigid_lines(curve)
    reference = curve.reference
    if frame is None or not isinstance(reference, int | np.integer):
        return lines
    turn = scale * float(frame.UR[reference])
    c, s = math.cos(turn), math.sin(turn)
    at = model.mesh.points[reference]
    rotation = np.array([[c, s], [-s, c]])
    return [(p - at) @ rotation + at + scale * frame.U[reference] for p in lines]

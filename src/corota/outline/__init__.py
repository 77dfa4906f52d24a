"""Outlines of parts: curves of a drawing, cleaned into loops, meshed with quadrilaterals."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.outline.curves import Curve, arc, circle, line, polyline, spline
from corota.outline.loops import Loops, OutlineError, clean
from corota.outline.mesher import outline

__all__ = [
    "Curve",
    "Loops",
    "OutlineError",
    "arc",
    "circle",
    "clean",
    "line",
    "outline",
    "polyline",
    "spline",
]

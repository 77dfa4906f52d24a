"""Boundary curves of planar faces in STEP, IGES and BREP files, by Gmsh's geometry kernel."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from corota.errors import InputError
from corota.io.regular_file import require_regular
from corota.outline.curves import Curve, arc, line, spline

#: Formats that the kernel reads.
SOLIDS = (".step", ".stp", ".iges", ".igs", ".brep")
#: Points along a curve that is neither a line nor an arc.
POINTS = 81


def read_faces(gmsh: Any, path: Path) -> list[Curve]:
    """Boundary curves of the faces in a plane of constant z, named ``curve_1``, ``curve_2``, ...

    Raises
    ------
    InputError
        If there is no face, or it is not planar.
    """
    require_regular(path)
    gmsh.model.occ.importShapes(str(path))
    gmsh.model.occ.synchronize()
    faces = gmsh.model.getEntities(2)
    if not faces:
        raise InputError(f"{path}: there is no face; export a planar face, not a solid or a curve")
    low_x, low_y, low_z, high_x, high_y, high_z = gmsh.model.getBoundingBox(-1, -1)
    if high_z - low_z > 1e-6 * math.hypot(high_x - low_x, high_y - low_y):
        raise InputError(f"{path}: the faces do not lie in a plane of constant z")
    edges = gmsh.model.getBoundary(faces, combined=True, oriented=False)
    found: list[Curve] = []
    for _, tag in edges:
        name, kind = f"curve_{tag}", gmsh.model.getType(1, tag)
        (first,), (last,) = gmsh.model.getParametrizationBounds(1, tag)
        at = np.reshape(gmsh.model.getValue(1, tag, np.linspace(first, last, POINTS)), (-1, 3))
        at = at[:, :2]
        if kind == "Line":
            found.append(line(at[0], at[-1], name, name))
        elif kind == "Circle":
            found += _arcs(at, last - first, name)
        else:
            found += spline(at, name, name)
    return found


def _arcs(at: np.ndarray[Any, Any], turn: float, name: str) -> list[Curve]:
    """Arcs through points of a circle that spans an angle [rad]."""
    third = len(at) // 3
    a, b, c = at[0], at[third], at[2 * third]
    matrix = 2.0 * np.array([b - a, c - a])
    center = np.linalg.solve(matrix, [b @ b - a @ a, c @ c - a @ a])
    out, after = a - center, at[1] - center
    sign = math.copysign(1.0, out[0] * after[1] - out[1] * after[0])
    start = math.atan2(out[1], out[0])
    return arc(center, float(np.hypot(*out)), start, start + sign * abs(turn), name, name)

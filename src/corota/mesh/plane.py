"""Points in space that lie in one plane, rotated into the plane of the model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Bools, Floats

#: Distance from the plane that counts as rounding, relative to the size of the part.
FLAT = 1e-6
#: Axes of a plane that become x and y, in right-handed order, and the one that is dropped.
_PLANES = (("xy", (0, 1), 2), ("xz", (0, 2), 1), ("yz", (1, 2), 0))


def into_plane(points: Floats, used: Bools) -> tuple[Floats, list[str]] | None:
    """Points of a plane that is normal to an axis, in that plane.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
    used : ndarray of bool, shape (n,)
        Points that must lie in the plane.

    Returns
    -------
    points : ndarray, shape (n, 2)
    notes : list of str
        What was rotated or dropped.

    None where the used points lie in no such plane.
    """
    mine = points[used]
    if not len(mine):
        return points[:, :2], []
    extent = np.ptp(mine, axis=0)
    for name, axes, out in _PLANES:
        size = float(extent[list(axes)].max())
        middle = float(0.5 * (mine[:, out].min() + mine[:, out].max()))
        if extent[out] > FLAT * size or size == 0.0:
            continue
        largest = float(np.abs(mine[:, out]).max())
        letter = "xyz"[out]
        notes = []
        if name != "xy":
            notes.append(f"the part lies in the {name} plane: it is rotated, {name[1]} becomes y")
            if name == "yz":
                notes[0] = (
                    "the part lies in the yz plane: it is rotated, y becomes x and z becomes y"
                )
        if largest > FLAT * size:
            notes.append(f"{letter} = {middle:g} of all nodes is dropped")
        elif largest > 0.0:
            notes.append(f"{letter} coordinates up to {largest:g} are taken as 0")
        return np.ascontiguousarray(points[:, list(axes)]), notes
    return None

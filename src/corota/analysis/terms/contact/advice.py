"""What can be said of meshes in contact before the run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from corota.analysis.terms.contact.pair import Pair

#: Slave edges that a round corner should measure along its radius, and the least turn of one.
EDGES, TURN = 2.0, math.radians(20.0)


def fillet_note(pair: Pair) -> str:
    """A remark on round corners of a rigid curve that are too small for the slave edges, or ''."""
    curve = getattr(pair.item, "master", None)
    if not isinstance(curve, RigidCurve):
        return ""
    rows = curve.segments
    # Clockwise arcs have the rigid body inside: the corners that slave edges go round.
    corners = rows[rows[:, 6] < -TURN]
    if not len(corners):
        return ""
    radius = float(np.hypot(*(corners[:, :2] - corners[:, 4:6]).T).min())
    edge = float(np.median(pair.slave.length))
    if radius >= EDGES * edge:
        return ""
    return (
        f"contact pair {pair.item.name!r}: the smallest round corner of the rigid curve has the "
        f"radius {radius:.4g}, {radius / edge:.2g} slave edges (median {edge:.4g}); the force will "
        f"be jagged while nodes go round it one by one. Take slave edges of at most "
        f"{radius / EDGES:.3g} where they meet it, or a larger radius"
    )


__all__ = ["fillet_note"]

"""Notes on meshes in contact before the run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.smoothing import blunt_turns, sharp_corners
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.terms.contact.pair import Pair

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Slave edges that a round corner should measure along its radius, and the least turn of one.
EDGES, TURN = 2.0, math.radians(20.0)


def fillet_note(pair: Pair) -> str:
    """A remark on round corners of a rigid curve that are too small for the slave edges, or ''."""
    curve = getattr(pair.item, "master", None)
    if not isinstance(curve, RigidCurve) or pair.beside is None:
        return ""
    rows = curve.segments
    # Clockwise arcs have the rigid body inside: the corners that slave edges pass around.
    corners = rows[rows[:, 6] < -TURN]
    if not len(corners):
        return ""
    radius = float(np.hypot(*(corners[:, :2] - corners[:, 4:6]).T).min())
    # The mean by length: short edges at a nose do not represent the sliding face.
    edge = float((pair.slave.length**2).sum() / pair.slave.length.sum())
    if radius >= EDGES * edge:
        return ""
    return (
        f"contact pair {pair.item.name!r}: the smallest round corner of the rigid curve has the "
        f"radius {radius:.4g}, {radius / edge:.2g} slave edges (mean {edge:.4g}); the force "
        "will be jagged while nodes pass it one by one. Use method='node_to_segment' (TYPE=NODE "
        "TO SURFACE), which measures such rounds against edges; or use slave edges of at most "
        f"{radius / EDGES:.3g} where they meet it, or a larger radius"
    )


def corner_note(pair: Pair, points: Floats, labels: Ints) -> str:
    """A remark on masters that press with corners but not as corners, or ''.

    Sharp corners under a pressure law, and round boundaries with too coarse edges.
    """
    if pair.master is None or pair.tied or pair.slave.pointwise:
        return ""
    sharp = sharp_corners(points, pair.master.nodes[:, :2]) if pair.law is not None else []
    if sharp:
        named = ", ".join(str(labels[k]) for k in sharp[:3]) + ", ..." * (len(sharp) > 3)
        return (
            f"contact pair {pair.item.name!r}: the master has sharp corners (node {named}). A "
            "pressure law acts on areas, so a corner that presses alone sinks in between slave "
            "nodes and wedges: where the other body meets a corner, make this surface the slave, "
            "or use hard contact"
        )
    if getattr(pair.item, "smooth", True):
        return ""
    turns = blunt_turns(points, pair.master)
    node, turn = max(turns.items(), key=lambda item: item[1], default=(-1, 0.0))
    if turn <= TURN:
        return ""
    return (
        f"contact pair {pair.item.name!r}: the master turns by {math.degrees(turn):.0f} degrees "
        f"from edge to edge at node {labels[node]}; the force will jump when contact passes such "
        "nodes. Where the boundary should be round, treat it as a curve (smooth=True, SMOOTH of "
        "*CONTACT PAIR) or refine its edges"
    )


__all__ = ["corner_note", "fillet_note"]

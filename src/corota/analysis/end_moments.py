"""Moments at the ends of beams from loads and inertia along them.

The stiffness gives the moments of the end rotations alone. With the work-equivalent moments
``h = q l^2 / 12`` of the transverse force ``q`` per length, which the equilibrium has, the moments
in the beam at its ends are those of the rotations less those of the load (Przemieniecki 1968,
*Theory of Matrix Structural Analysis*, section 5.8).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.distributed_forces import BodyLoad
from corota.model.loads import BodyForce

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.arrays import Floats
    from corota.results.results import PointFields


def add_end_moments(
    system: System, fields: list[PointFields], u: Floats, step_time: float, a: Floats | None
) -> None:
    """Correct the moments of beams for what acts between their ends, in place.

    Parameters
    ----------
    fields : list of PointFields
        Of the own blocks.
    u : ndarray, shape (n_dofs,)
    step_time : float
        Loads are those at this time.
    a : ndarray, shape (n_dofs,), or None
        Acceleration, if there is inertia.
    """
    points = system.model.mesh.points
    moved = system.by_node(u)[:, :2] if system.nlgeom else np.zeros_like(points)
    conditions = system.conditions
    consistent = conditions.distributed.mass == "consistent"
    for number, (block, own) in enumerate(zip(system.own_blocks, fields, strict=True)):
        if "M1" not in own.values:
            continue
        nodes = block.nodes
        place = (points + moved)[nodes]
        chord, rest = place[:, 1] - place[:, 0], points[nodes[:, 1]] - points[nodes[:, 0]]
        length = np.hypot(*rest.T)
        per_length = block.section.profile[0] * block.section.material.rho
        pull = np.zeros_like(place)
        for load in conditions.distributed.loads:
            item = load.item
            if not isinstance(load.force, BodyLoad) or not isinstance(item, BodyForce):
                continue
            scale = conditions.scale(load, step_time)
            value = np.asarray(item.value, dtype=float)
            inside = load.force.masks[number][:, None, None]
            if item.kind == "line":
                pull += inside * scale * value
            elif item.kind == "volume":
                pull += inside * scale * block.section.profile[0] * value
            elif consistent and item.kind == "gravity":
                pull += inside * scale * per_length * value
            elif consistent:
                pull += inside * scale * per_length * value[0] * (place - value[1:])
        if a is not None and consistent:
            pull -= per_length * system.by_node(a)[nodes][..., :2]
        normal = np.stack([-chord[:, 1], chord[:, 0]], axis=1) / np.hypot(*chord.T)[:, None]
        across = np.einsum("eni,ei->e", pull, normal) / 2.0
        moment = across * length**2 / 12.0
        for name in ("M1", "M2"):
            own.values[name] = own.values[name] + moment[:, None]
        if own.fibers is None and block.section.fiber > 0.0:
            bending = moment[:, None] * block.section.fiber / block.section.profile[1]
            for name, sign in (("SR1", 1.0), ("SL1", -1.0), ("SR2", 1.0), ("SL2", -1.0)):
                own.values[name] = own.values[name] + sign * bending

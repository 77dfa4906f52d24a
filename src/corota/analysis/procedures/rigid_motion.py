"""The rigid part of a motion of points, and what remains without it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

from corota.arrays import Floats, skew


def rigid_rates(x: Floats, rates: Floats) -> Floats:
    """Rigid velocity field that is nearest to given rates at points, shapes (n, 2)."""
    arm = x - x.mean(axis=0)
    mean = rates.mean(axis=0)
    inertia = float((arm * arm).sum())
    lever = skew(arm)
    spin = float((lever * rates).sum()) / inertia if inertia > 0.0 else 0.0
    out: Floats = mean + spin * lever
    return out


def deformation(reference: Floats, x: Floats, finite: bool = True) -> Floats:
    """Displacements less the nearest rigid motion, finite or infinitesimal, shape (n, 2)."""
    if not finite:
        return x - reference - rigid_rates(reference, x - reference)
    before, now = reference - reference.mean(axis=0), x - x.mean(axis=0)
    along, across = float((before * now).sum()), float((skew(before) * now).sum())
    size = np.hypot(along, across) or 1.0
    out: Floats = now - (along * before + across * skew(before)) / size
    return out

"""Forces of contact between both ends of an increment, for the energy-momentum scheme.

A traction does exactly the work of its gap, ``p (G1 - G0)``, if it acts along a discrete gradient
of the gap. It is the gradient at the middle of the increment, which keeps the momenta because the
gap does not depend on the frame, with a correction that is orthogonal to all rigid motions of the
nodes of a constraint (Gonzalez 1996). A pressure law acts with the quotient of its energy and its
overclosure. A shear traction acts along its direction at the middle; what it does work on is the
slip of the increment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.terms.contact.gaps import covered
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.linear.types import Kind
    from corota.analysis.terms.contact.gaps import Terms

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


def discrete_gradient(
    end: Terms,
    middle: Terms,
    begun: Floats,
    full: Floats,
    positions: tuple[Floats, Floats],
    master: object,
    rounding: float,
) -> Terms:
    """Terms along which tractions act, whose products with the increment are its gap and slip.

    Parameters
    ----------
    end, middle : Terms
        At the end of the increment and half way.
    begun, full : ndarray, shape (n,)
        Weighted gap at the start [length^3], and whole area [length^2].
    positions : tuple of ndarray, shape (n_nodes, 3)
        Positions and rotations at the start and at the end.
    master : RigidCurve or other
    rounding : float
        Length below which deformations are rounding [length].
    """
    old, x = positions
    n = len(full)
    # Terms that exist only at the end act along the gradient there.
    known = covered(middle.area, full)
    parts = [(middle, known[middle.constraint]), (end, ~known[end.constraint])]

    def both(array: Callable[[Terms], NDArray[Kind]]) -> NDArray[Kind]:
        return np.concatenate([array(terms)[rows] for terms, rows in parts])

    constraint, variables = both(lambda t: t.constraint), both(lambda t: t.variables)
    move = x - old
    move[:, 2] = 2.0 * np.tan(0.5 * move[:, 2])
    away = _without_symmetry(master, variables, 0.5 * (x + old), move)
    size = np.bincount(constraint, (away**2).sum(axis=1), n)
    moved = move.ravel()[variables]

    def product(gradient: Floats) -> Floats:
        return np.asarray(np.bincount(constraint, (gradient * moved).sum(axis=1), n), np.float64)

    gradient, along = both(lambda t: t.gap_gradient), both(lambda t: t.slip_gradient)
    missing = end.gap - begun - product(gradient)
    counts = size > rounding**2
    factor = np.where(counts, missing / np.where(counts, size, 1.0), 0.0)
    return replace(
        end,
        constraint=constraint,
        variables=variables,
        pair=both(lambda t: t.pair),
        gap_gradient=gradient + factor[constraint, None] * away,
        slip_gradient=along,
        slip=product(along),
    )


def _without_symmetry(curve: object, variables: Ints, x: Floats, move: Floats) -> Floats:
    """Displacements by variable less the motions that do not change the gap; no rotations."""
    node, part = np.maximum(variables, 0) // 3, variables % 3
    used = variables >= 0
    first, second = used & (part == 0), used & (part == 1)
    own = move[node]
    if isinstance(curve, RigidCurve) and not isinstance(curve.reference, int | np.integer):
        if len(curve.segments) > 1:
            out = own[:, :, :2]
        else:
            # One line may be moved along, one arc about its center.
            x0, y0, x1, y1, cx, cy, sweep = curve.segments[0]
            line = np.array([y0 - y1, x1 - x0]) / np.hypot(x1 - x0, y1 - y0)
            normal = np.broadcast_to(line, own[:, :, :2].shape)
            if sweep:
                arm = x[node][:, :, :2] - [cx, cy]
                normal = arm / np.maximum(np.hypot(arm[..., 0], arm[..., 1]), 1e-300)[..., None]
            out = (own[:, :, :2] * normal).sum(axis=2, keepdims=True) * normal
        return np.where(first, out[:, :, 0], np.where(second, out[:, :, 1], 0.0))
    count = np.maximum(first.sum(axis=1), 1)[:, None]

    def centered(values: Floats) -> tuple[Floats, Floats]:
        a, b = (np.where(first, values[node][:, :, i], 0.0) for i in (0, 1))
        mean = a.sum(axis=1)[:, None] / count, b.sum(axis=1)[:, None] / count
        return np.where(first, a - mean[0], 0.0), np.where(first, b - mean[1], 0.0)

    (rx, ry), (dx, dy) = centered(x), centered(move)
    inertia = (rx * rx + ry * ry).sum(axis=1)
    spin = (rx * dy - ry * dx).sum(axis=1) / np.where(inertia > 0.0, inertia, 1.0)
    dx, dy = dx + spin[:, None] * ry, dy - spin[:, None] * rx
    # The y of a node is the variable behind its x.
    out_y = np.zeros_like(dy)
    out_y[:, 1:] = dy[:, :-1]
    return np.where(first, dx, np.where(second, out_y, 0.0))


__all__ = ["discrete_gradient"]

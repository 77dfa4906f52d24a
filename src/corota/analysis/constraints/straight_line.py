"""Nodes on the straight line through two others, as a relation between degrees of freedom."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from corota.analysis.constraints.relations import Relation
from corota.analysis.failure import ElementFailure
from corota.arrays import Floats

#: The axis of the dependent displacement may come this close to the line (sine of the angle).
CLOSEST = 1e-3
#: Angle from which a failed increment is attributed to this [degrees].
CLOSE = 15.0
#: ``S v`` rotates v by a right angle; ``e . S t = t . M e`` with M its transpose.
S = np.array([[0.0, -1.0], [1.0, 0.0]])
M = S.T


@dataclass
class OnLine(Relation):
    """One node on the line through two others: ``(p - a) . S (b - a) = 0``.

    With p = X + e u_e + d u_d, in the axes e and d of the node, that is ``N + D u_d = 0``, where
    ``N = w . S t``, ``D = d . S t``, ``w = X + e u_e - a``, ``t = b - a``: a quotient of a
    quadratic and a linear form of the masters u_e, a and b.

    Parameters
    ----------
    points : ndarray, shape (3, 2)
        Reference positions of the node and of the ends [length].
    free, bound : ndarray, shape (2,)
        Axes of the node's master displacement and of its dependent one.
    axes : ndarray, shape (2, 2, 2)
        Columns: axes of the two ends.
    nlgeom : bool
        Whether the line moves with its ends; else it is linearized about the reference.
    """

    points: Floats
    free: Floats
    bound: Floats
    axes: Floats
    nlgeom: bool = True

    instead = "the ends of the line"
    linear = False

    def _places(self, u: Floats) -> tuple[Floats, Floats]:
        """Node without its dependent displacement from the first end, and the line."""
        q = u[self.masters]
        node, first, last = self.points
        a, b = first + self.axes[0] @ q[1:3], last + self.axes[1] @ q[3:5]
        w: Floats = node + q[0] * self.free - a
        t: Floats = b - a
        return w, t

    def _forms(self, w: Floats, t: Floats) -> tuple[Floats, Floats, float]:
        """Gradients of N and D by the masters, and D."""
        across = S @ t
        d_w, d_d = M @ w, M @ self.bound
        n = np.concatenate(
            [[self.free @ across], self.axes[0].T @ (-across - d_w), self.axes[1].T @ d_w]
        )
        d = np.concatenate([[0.0], self.axes[0].T @ -d_d, self.axes[1].T @ d_d])
        size = float(self.bound @ across)
        if not abs(size) > CLOSEST * float(np.hypot(*t)):
            raise ElementFailure(
                f"{self.what} has rotated so far that it no longer determines that displacement"
            )
        return n, d, size

    def _start(self) -> tuple[Floats, Floats]:
        node, first, last = self.points
        return node - first, last - first

    def near_its_limit(self, u: Floats) -> str:
        if not self.nlgeom:
            return ""
        t = self._places(u)[1]
        length = float(np.hypot(*t)) or 1.0
        across = abs(float(self.bound @ (S @ t)))
        angle = math.degrees(math.asin(min(across / length, 1.0)))
        if not angle < CLOSE:
            return ""
        return (
            f"{self.what} has turned to within {angle:.1f} degrees of the displacement that it "
            "determines; axes of the node (local_axes, *TRANSFORM) with other directions help"
        )

    def values(self, u: Floats) -> Floats:
        if not self.nlgeom:
            return self.jacobian(u) @ u[self.masters]
        w, t = self._places(u)
        _, _, size = self._forms(w, t)
        return np.array([-(w @ (S @ t)) / size])

    def jacobian(self, u: Floats) -> Floats:
        if not self.nlgeom:
            n, _, size = self._forms(*self._start())
            return -n[None, :] / size
        w, t = self._places(u)
        n, d, size = self._forms(w, t)
        ratio = float(w @ (S @ t)) / size
        return -(n - ratio * d)[None, :] / size

    def _hessian(self, u: Floats) -> Floats:
        """Second derivative of the dependent by the masters, shape (5, 5)."""
        w, t = self._places(u)
        _, d, size = self._forms(w, t)
        slope = -self.jacobian(u)[0]
        second = np.zeros((5, 5))
        second[0, 1:3] = -self.axes[0].T @ (M @ self.free)
        second[0, 3:5] = self.axes[1].T @ (M @ self.free)
        second[1:3, 3:5] = self.axes[0].T @ M @ self.axes[1]
        second += second.T
        return -(second - np.outer(slope, d) - np.outer(d, slope)) / size

    def geometric_stiffness(self, u: Floats, force: Floats) -> Floats:
        return force[0] * self._hessian(u) if self.nlgeom else np.zeros((5, 5))

    def curve(self, u: Floats, v: Floats) -> Floats:
        if not self.nlgeom:
            return np.zeros(1)
        rate = v[self.masters]
        return np.array([rate @ self._hessian(u) @ rate])

    def secant(self, begin: Floats, end: Floats) -> Floats:
        """See :class:`Relation`; N is quadratic and D linear, so that mid-points are exact."""
        if not self.nlgeom:
            return self.jacobian(end)
        before, after = self._places(begin), self._places(end)
        n, d, size = self._forms(0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1]))
        ratio = -0.5 * float(self.values(begin)[0] + self.values(end)[0])
        return -(n - ratio * d)[None, :] / size

"""Independent references for plasticity: a return map in three dimensions with nested loops."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Solid:
    """J2 in three dimensions, Voigt rows 11 22 33 12 13 23 as full 3 x 3 tensors.

    Written from the definition: the flow direction and the step are found by a fixed-point
    iteration on the direction around a bisection on the step, nothing is projected.
    """

    E: float
    nu: float
    sy: float
    K: float = 0.0
    back: tuple[tuple[float, float], ...] = ()
    ep: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))
    p: float = 0.0
    beta: list[np.ndarray] = field(default_factory=list)

    def __post_init__(self) -> None:
        if not self.beta:
            self.beta = [np.zeros((3, 3)) for _ in self.back]

    def stress(self, strain: np.ndarray, commit: bool = False) -> np.ndarray:
        """Cauchy stress of a total strain tensor."""
        g = self.E / (2 * (1 + self.nu))
        bulk = self.E / (3 * (1 - 2 * self.nu))
        e = strain - self.ep
        mean = np.trace(e)
        s = 2 * g * (e - mean / 3 * np.eye(3))

        def eta(dp: float) -> np.ndarray:
            """Trial relative stress, back-stresses faded by the step."""
            return s - sum(
                (b / (1 + r * dp) for b, (_, r) in zip(self.beta, self.back, strict=True)),
                np.zeros((3, 3)),
            )

        def norm(t: np.ndarray) -> float:
            return float(np.sqrt(1.5 * np.sum(t * t)))

        def excess(dp: float) -> float:
            stiff = 3 * g + sum(c / (1 + r * dp) for c, r in self.back)
            return norm(eta(dp)) - stiff * dp - self.sy - self.K * (self.p + dp)

        if excess(0.0) <= 0.0:
            return s + bulk * mean * np.eye(3)
        low, high = 0.0, (norm(s) + sum(norm(b) for b in self.beta)) / (3 * g)
        # Until no number lies between.
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        dp = middle
        flow = 1.5 * dp * eta(dp) / norm(eta(dp))
        if commit:
            self.ep = self.ep + flow
            self.p += dp
            self.beta = [
                (b + 2 / 3 * c * flow) / (1 + r * dp)
                for b, (c, r) in zip(self.beta, self.back, strict=True)
            ]
        return s - 2 * g * flow + bulk * mean * np.eye(3)

    def plane_stress(self, e: np.ndarray) -> np.ndarray:
        """Stress 11, 22, 12 where 33 vanishes, the thickness strain found by bisection."""
        full = np.array([[e[0], e[2] / 2, 0], [e[2] / 2, e[1], 0], [0, 0, 0.0]])
        size = 3 * float(np.abs(e).max()) + 3 * float(np.abs(self.ep).max()) + 1e-12
        low, high = -size, size
        while low < (middle := 0.5 * (low + high)) < high:
            full[2, 2] = middle
            if self.stress(full)[2, 2] > 0:
                high = middle
            else:
                low = middle
        full[2, 2] = middle
        s = self.stress(full, commit=True)
        return np.array([s[0, 0], s[1, 1], s[0, 1]])

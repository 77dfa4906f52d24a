"""Amplitudes of displacement from tables of velocity or acceleration, integrated exactly."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.errors import Location


class IntegratedAmplitude(Amplitude):
    """The integral of a table over time: the displacement of a support from its start.

    The table is linear between its points, so velocity and displacement are polynomials there.
    A support with this amplitude moves from its position at the start of the step.

    Parameters
    ----------
    time, rate : ndarray, shape (n,)
        Increasing times, and the velocity or acceleration there; constant outside.
    order : {1, 2}
        How often the table is integrated: 1 for velocities, 2 for accelerations.
    begins : float
        Time at which displacement and, of accelerations, velocity are zero.
    total_time : bool
        Whether times count from the start of the analysis, not of the step.
    """

    def __init__(
        self,
        time: Floats,
        rate: Floats,
        order: int,
        begins: float = 0.0,
        total_time: bool = False,
        name: str = "",
        where: Location | None = None,
    ) -> None:
        table = Amplitude(time, rate, total_time, name, where)
        points = np.append(begins, table.time[table.time > begins])
        f = np.array([table(t) for t in points])
        h = np.diff(points)
        slope = np.append(np.diff(f) / h, 0.0)
        once = np.append(0.0, np.cumsum(h * (f[:-1] + 0.5 * h * slope[:-1])))
        twice = np.append(
            0.0, np.cumsum(h * (once[:-1] + h * (0.5 * f[:-1] + h * slope[:-1] / 6.0)))
        )
        self.order, self._points = order, points
        #: Value, rate and second rate at each point, and the slope of the table after it.
        self._pieces = np.stack([twice, once, f, slope][2 - order :])
        last = np.append(points, points[-1] + 1.0) if len(points) < 2 else points
        super().__init__(last, np.array([self(t) for t in last]), total_time, name, where)

    def _at(self, time: float) -> tuple[Floats, float]:
        """Coefficients of the piece that a time lies in, and the time since its start."""
        at = max(int(np.searchsorted(self._points, time, side="right")) - 1, 0)
        piece: Floats = self._pieces[:, at]
        return piece, time - float(self._points[at])

    def __call__(self, time: float) -> float:
        """Displacement per unit of the table at a time."""
        c, t = self._at(time)
        terms = c * t ** np.arange(len(c)) / np.array([1.0, 1.0, 2.0, 6.0])[: len(c)]
        return float(terms.sum())

    def velocity(self, time: float) -> float:
        """Rate of the displacement."""
        c, t = self._at(time)
        c = c[1:]
        return float((c * t ** np.arange(len(c)) / np.array([1.0, 1.0, 2.0])[: len(c)]).sum())

    def derivatives(
        self, time: float, window: float, first: float = -np.inf, last: float = np.inf
    ) -> tuple[float, float]:
        """Rate and acceleration at a time; that of a table of velocities over the window."""
        if self.order == 2:
            c, t = self._at(time)
            return self.velocity(time), float(c[2] + c[3] * t)
        low, high = max(time - window, first, float(self._points[0])), min(time + window, last)
        change = self.velocity(high) - self.velocity(low)
        return self.velocity(time), change / (high - low) if high > low else 0.0

    def kinks(self) -> Floats:
        """None: the velocity is continuous."""
        return np.zeros(0)


class VibrationAmplitude(Amplitude):
    """Displacement of a support that vibrates with an acceleration given over the frequency.

    At the frequency f the acceleration a belongs to the displacement ``-a / (2 pi f)^2``.

    Parameters
    ----------
    frequency, acceleration : ndarray, shape (n,)
        Linear between the points, constant outside.
    """

    def __call__(self, time: float) -> float:
        """Displacement per unit of the table at a frequency; 0 at rest."""
        rate = 2.0 * np.pi * time
        return -super().__call__(time) / rate**2 if rate > 0.0 else 0.0

"""Curves of ``*AMPLITUDE`` without a table, sampled finely."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.errors import Location

#: Samples of a smooth step, and of the shortest period: straight lines miss a sine by 4e-6.
PER_STEP, PER_PERIOD = 200, 1024
#: A frequency that is none.
EPS = float(np.finfo(float).eps)
#: Samples of one curve.
MOST = 1_000_000


def smooth_steps(time: Floats, value: Floats) -> tuple[Floats, Floats]:
    """Between two points a polynomial of fifth order, flat at both."""
    s = np.linspace(0.0, 1.0, PER_STEP + 1)[1:]
    blend = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    times, values = [time[:1]], [value[:1]]
    for i in range(len(time) - 1):
        times.append(time[i] + s * (time[i + 1] - time[i]))
        values.append(value[i] + blend * (value[i + 1] - value[i]))
    return np.concatenate(times), np.concatenate(values)


@dataclass(slots=True, eq=False, repr=False)
class Curve:
    """A curve without an end, sampled when the steps are known.

    ``numbers`` of ``PERIODIC`` are omega, start, initial value and pairs A, B of a Fourier series;
    of ``DECAY`` the initial value, size, start and decay time; of ``MODULATED`` the initial value,
    size, start and two angular frequencies, whose sines are multiplied.
    """

    kind: str
    numbers: list[float]
    total: bool
    name: str
    where: Location

    def sampled(self, until: float) -> Amplitude:
        """The curve as a table from time 0 to ``until``."""
        if self.kind == "PERIODIC":
            omega, start, first, *pairs = self.numbers
            a, b = np.array(pairs[::2]), np.array(pairs[1::2])
            n = np.arange(1, len(a) + 1)
            shortest = 2.0 * np.pi / (abs(omega) * len(a))
        elif self.kind == "MODULATED":
            first, size, start, *both = self.numbers
            shortest = 2.0 * np.pi / max(sum(map(abs, both)), EPS)
        else:
            first, size, start, decay = self.numbers
            shortest = 4.0 * abs(decay)
        stop = max(until, start + shortest)
        count = min(max(int(np.ceil((stop - start) / shortest * PER_PERIOD)), 2), MOST)
        later = np.linspace(0.0, stop - start, count + 1)
        if self.kind == "PERIODIC":
            phase = omega * later[:, None] * n
            value = first + np.cos(phase) @ a + np.sin(phase) @ b
        elif self.kind == "MODULATED":
            value = first + size * np.sin(both[0] * later) * np.sin(both[1] * later)
        else:
            value = first + size * np.exp(-later / decay)
        time = start + later
        if start > 0.0:
            # A jump at the start takes a thousandth of a sample.
            gap = 1e-3 * later[1]
            time, value = np.append([start - gap], time), np.append([first], value)
        return Amplitude(time, value, self.total, self.name, self.where)

"""Stress and strain of a linear response about a state."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.results.invariants import mises

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.arrays import Complex, Floats
    from corota.results.results import PointFields


#: Displacement of the differences, as a share of the model's size.
SIZE = 3e-5
#: Fields of second order in the displacement.
QUADRATIC = ("ENER",)
#: Instants of a period at which the von Mises stress is evaluated; the error of its largest value
#: with the parabola through three of them is about 1e-5.
INSTANTS = 48


class LinearFields:
    """Recovers what a change of displacement gives to first order (energy: to second).

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        The state about which the response is linear.
    """

    def __init__(self, system: System, u: Floats) -> None:
        self.system, self.u = system, u.copy()
        self.base, self.sums = system.recover(u.copy())

    def at(self, change: Floats) -> tuple[list[PointFields], dict[str, float]]:
        """Fields and sums at a change of displacement, as :meth:`System.recover` gives them."""
        system = self.system
        moved = float(np.abs(change[system.counted]).max(initial=0.0))
        turned = float(np.abs(change[~system.counted]).max(initial=0.0))
        largest = max(moved, turned * system.cell_size)
        if largest == 0.0:
            # Copies, as the caller adds values of its own.
            return [replace(f, values=dict(f.values)) for f in self.base], dict(self.sums)
        h = min(1.0, SIZE * system.length / largest)
        ahead, sums_ahead = self._recover(self.u + h * change)
        behind, sums_behind = self._recover(self.u - h * change)
        fields = [_combine(*three, h) for three in zip(self.base, ahead, behind, strict=True)]
        sums = dict(self.sums)
        name = "strain energy"
        sums[name] = _second(self.sums[name], sums_ahead[name], sums_behind[name], h)
        return fields, sums

    def over_period(self, change: Complex) -> tuple[list[PointFields], dict[str, float]]:
        """Fields and sums at the real part of a complex amplitude, with those of its whole period.

        ``SA`` has the amplitudes of the stresses, ``MISESA`` the largest von Mises stress.
        """
        fields, sums = self.at(change.real)
        behind, _ = self.at(change.imag)
        for base, real, imaginary in zip(self.base, fields, behind, strict=True):
            if "S" not in base.values:
                continue
            mean = base.values["S"]
            cosine, sine = real.values["S"] - mean, mean - imaginary.values["S"]
            real.values["SA"] = np.hypot(cosine, sine)
            real.values["MISESA"] = largest_mises(mean, cosine, sine)
        return fields, sums

    def _recover(self, u: Floats) -> tuple[list[PointFields], dict[str, float]]:
        self.system.constraints.complete(u)
        return self.system.recover(u)


def largest_mises(mean: Floats, cosine: Floats, sine: Floats) -> Floats:
    """Largest von Mises stress of ``mean + cosine cos a + sine sin a`` over all angles a.

    Its square is a trigonometric polynomial of second order: the largest of `INSTANTS` values is
    improved by the parabola through its neighbors.

    Parameters
    ----------
    mean, cosine, sine : ndarray, shape (..., 4)

    Returns
    -------
    ndarray, shape (...)
    """
    angles = 2.0 * np.pi * np.arange(INSTANTS) / INSTANTS
    squares = np.stack([mises(mean + np.cos(a) * cosine + np.sin(a) * sine) ** 2 for a in angles])
    top = squares.argmax(axis=0)[None]
    below, here, above = (
        np.take_along_axis(squares, (top + i) % INSTANTS, axis=0)[0] for i in (-1, 0, 1)
    )
    bend = 2.0 * here - below - above
    rise = (above - below) ** 2 / (8.0 * np.where(bend > 0.0, bend, 1.0))
    return np.asarray(np.sqrt(here + np.where(bend > 0.0, rise, 0.0)))


def _combine(base: PointFields, ahead: PointFields, behind: PointFields, h: float) -> PointFields:
    values = {}
    for name, value in base.values.items():
        a, b = ahead.values[name], behind.values[name]
        values[name] = _second(value, a, b, h) if name in QUADRATIC else value + (a - b) / (2 * h)
    if "MISES" in values and "S" in values:
        values["MISES"] = mises(values["S"])
    points = base.points + (ahead.points - behind.points) / (2.0 * h)
    forces = base.forces
    if forces is not None and ahead.forces is not None and behind.forces is not None:
        forces = forces + (ahead.forces - behind.forces) / (2.0 * h)
    fibers = base.fibers
    if fibers is not None and ahead.fibers is not None and behind.fibers is not None:
        fibers = fibers + (ahead.fibers - behind.fibers) / (2.0 * h)
    return replace(base, points=points, values=values, forces=forces, fibers=fibers)


def _second(base: Floats | float, ahead: Floats | float, behind: Floats | float, h: float):  # type: ignore[no-untyped-def]
    """Expansion to second order from values a step ahead and behind."""
    return base + (ahead - behind) / (2.0 * h) + (ahead - 2.0 * base + behind) / (2.0 * h * h)

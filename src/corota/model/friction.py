"""Coefficients of friction that depend on the slip rate and the pressure."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from corota.arrays import Floats
from corota.display import Brief
from corota.errors import InputError, number

#: Largest friction coefficient: no pressure lets surfaces slip with it.
MOST_FRICTION = 1e6


@dataclass(repr=False)
class DecayingFriction(Brief):
    """Coefficient that falls from a static to a kinetic one: mu_k + (mu_s - mu_k) exp(-d v).

    Parameters
    ----------
    static, kinetic : float
        Coefficients at rest and at high slip rates, mu_s and mu_k >= 0.
    decay : float
        Decay coefficient d [time/length], > 0: at the slip rate v = 1/d, 37 % of the difference are
        left.

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    ``*FRICTION, EXPONENTIAL DECAY`` of Abaqus. The slip rate is the slip of an increment over its
    time, the coefficient that at the end of the increment; in static steps the time is that of the
    step.
    """

    static: float
    kinetic: float
    decay: float

    def __post_init__(self) -> None:
        for what in ("static", "kinetic"):
            value = number(getattr(self, what), f"the {what} coefficient of friction")
            if not 0.0 <= value <= MOST_FRICTION:
                raise InputError(
                    f"the {what} coefficient of friction must be from 0 to {MOST_FRICTION:g}, "
                    f"not {value:g}"
                )
            setattr(self, what, value)
        self.decay = number(self.decay, "the decay of friction", above=0.0)

    @property
    def largest(self) -> float:
        """Largest coefficient."""
        return max(self.static, self.kinetic)

    def __call__(self, rate: Floats, pressure: Floats) -> Floats:
        """Coefficients at slip rates [length/time], shape (n,), whatever the pressures."""
        decayed = (self.static - self.kinetic) * np.exp(-self.decay * rate)
        return np.asarray(self.kinetic + decayed + 0.0 * pressure)


@dataclass(repr=False)
class FrictionTable(Brief):
    """Coefficients at slip rates and pressures: linear between them, constant beyond.

    Parameters
    ----------
    rows : sequence of (coefficient, slip rate, pressure)
        In any order [1], [length/time], [force/length^2]: for each pressure the coefficients at
        its slip rates.

    Raises
    ------
    InputError
        If a number is outside its range, or a rate and pressure are given twice.

    Notes
    -----
    As the data lines of ``*FRICTION`` in Abaqus: first interpolated over the slip rate at each
    pressure, then over the pressure. The rate is that of :class:`DecayingFriction`; the pressure is
    that at the end of the increment.
    """

    rows: Sequence[tuple[float, float, float]]

    def __post_init__(self) -> None:
        given = np.array(self.rows, dtype=np.float64)
        if given.ndim != 2 or given.shape[1] != 3 or len(given) < 2:
            raise InputError(
                "a table of friction has two rows (coefficient, slip rate, pressure) at least; "
                "give one coefficient as a number"
            )
        if not (np.isfinite(given).all() and (given >= 0.0).all()):
            raise InputError("coefficients, slip rates and pressures of friction must be >= 0")
        if given[:, 0].max() > MOST_FRICTION:
            raise InputError(f"coefficients of friction are at most {MOST_FRICTION:g}")
        if len(np.unique(given[:, 1:], axis=0)) < len(given):
            raise InputError("a slip rate and pressure of friction is given twice")
        order = np.lexsort((given[:, 1], given[:, 2]))
        self.rows = [(mu, rate, p) for mu, rate, p in given[order].tolist()]

    @property
    def largest(self) -> float:
        """Largest coefficient."""
        return max(mu for mu, _, _ in self.rows)

    def __call__(self, rate: Floats, pressure: Floats) -> Floats:
        """Coefficients at slip rates [length/time] and pressures [force/length^2], shape (n,)."""
        table = np.array(self.rows)
        pressures = np.unique(table[:, 2])
        each = [table[table[:, 2] == p] for p in pressures]
        by_rate = np.array([np.interp(rate, own[:, 1], own[:, 0]) for own in each])
        place = np.interp(pressure, pressures, np.arange(len(pressures)))
        low = np.minimum(place.astype(int), max(len(pressures) - 2, 0))
        high = np.minimum(low + 1, len(pressures) - 1)
        at = np.arange(len(rate))
        share = place - low
        return np.asarray((1.0 - share) * by_rate[low, at] + share * by_rate[high, at])


#: A coefficient of friction: a number, or one that depends on slip rate and pressure.
Friction = float | DecayingFriction | FrictionTable


def largest(friction: Friction) -> float:
    """Largest coefficient of friction that is reached."""
    if isinstance(friction, DecayingFriction | FrictionTable):
        return friction.largest
    return friction


def coefficients(friction: Friction, rate: Floats, pressure: Floats) -> Floats:
    """Coefficients at slip rates [length/time] and pressures [force/length^2], shape (n,)."""
    if isinstance(friction, float | int | np.number):
        return np.full(len(rate), float(friction))
    return friction(rate, pressure)


def described(friction: Friction) -> str:
    """The coefficient in a few words, as in summaries."""
    if isinstance(friction, DecayingFriction):
        return f"{friction.static:g} to {friction.kinetic:g} by exp(-{friction.decay:g} v)"
    if isinstance(friction, FrictionTable):
        return f"{min(row[0] for row in friction.rows):g} to {friction.largest:g} by a table"
    return f"{friction:g}"

"""Rates of plastic flow: what they add to the yield stress, and creep."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, number
from corota.names import choose_attribute

if TYPE_CHECKING:
    from collections.abc import Sequence

    #: Points (stress, plastic strain).
    Curve = Sequence[tuple[float, float]]

#: How creep hardens.
HARDENINGS = ("time", "strain")


@dataclass(repr=False)
class CowperSymonds(Brief):
    """Yield stress times ``1 + (p' / D)^(1 / n)`` with the rate p' of the plastic strain.

    The power law of Perzyna in terms of the stress: ``p' = D (q / sy - 1)^n``, as
    ``*RATE DEPENDENT``.

    Parameters
    ----------
    D : float
        Rate that doubles the yield stress [1/time], > 0.
    n : float
        Exponent, > 0.

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    Sources: G. R. Cowper and P. S. Symonds, *Strain-hardening and strain-rate effects in the impact
    loading of cantilever beams*, Brown University (1957); P. Perzyna, *Adv. Appl. Mech.* 9 (1966)
    243-377.
    """

    D: float
    n: float

    def __post_init__(self) -> None:
        number(self.D, "the rate D", above=0.0)
        number(self.n, "the exponent n", above=0.0)

    def numbers(self) -> list[float]:
        """Numbers for the core."""
        return [1.0, float(self.D), float(self.n)]


@dataclass(repr=False)
class YieldRatio(Brief):
    """Yield stress times a ratio that follows the rate of the plastic strain.

    Parameters
    ----------
    table : sequence of (ratio, rate)
        Straight between the rates [1/time], constant after the last. The rates rise from 0; the
        ratios do not fall.

    Raises
    ------
    InputError
        If the rows do not fit.

    Notes
    -----
    As ``*RATE DEPENDENT, TYPE=YIELD RATIO``.
    """

    table: Sequence[tuple[float, float]]

    def __post_init__(self) -> None:
        rows = [(number(r, "a ratio"), number(p, "a rate")) for r, p in self.table]
        if not rows or rows[0][1] != 0.0 or rows[0][0] <= 0.0:
            raise InputError("the ratios by rate start with a ratio > 0 at the rate 0")
        for (r0, p0), (r1, p1) in pairwise(rows):
            if p1 <= p0 or r1 < r0:
                raise InputError(
                    f"the rates must rise and the ratios may not fall, but {r1:g} at {p1:g} "
                    f"follows {r0:g} at {p0:g}"
                )

    def numbers(self) -> list[float]:
        """Numbers for the core."""
        return [3.0, *(float(v) for row in self.table for v in row)]


@dataclass(repr=False)
class RateCurves(Brief):
    """Yield curves at rates of the plastic strain above that of the material, which is at rate 0.

    Parameters
    ----------
    curves : sequence of (rate, curve)
        Rising rates [1/time] and points (stress, plastic strain) there: straight between the rates,
        constant after the last.

    Raises
    ------
    InputError
        If the rates do not rise.

    Notes
    -----
    As ``*PLASTIC, RATE=``. At every plastic strain the stress may not fall with the rate.
    """

    curves: Sequence[tuple[float, Curve]]

    def __post_init__(self) -> None:
        rates = [0.0, *(number(rate, "a rate") for rate, _ in self.curves)]
        if len(rates) < 2 or any(b <= a for a, b in pairwise(rates)):
            raise InputError(f"the rates of curves must rise from above 0, not {rates[1:]}")

    def joined(self, first: Curve) -> list[list[tuple[float, float]]]:
        """All curves at the same plastic strains, that at rate 0 first.

        Raises
        ------
        InputError
            If the stress falls with the rate.
        """
        curves = [np.array(c, dtype=np.float64) for c in (first, *(c for _, c in self.curves))]
        strains = np.unique(np.concatenate([c[:, 1] for c in curves]))
        stress = np.array([np.interp(strains, c[:, 1], c[:, 0]) for c in curves])
        fall = np.argwhere(np.diff(stress, axis=0) < 0.0)
        if len(fall):
            k, p = fall[0]
            raise InputError(
                f"the yield stress falls with the rate: {stress[k + 1, p]:g} after "
                f"{stress[k, p]:g} at plastic strain {strains[p]:g}"
            )
        return [list(zip(s.tolist(), strains.tolist(), strict=True)) for s in stress]

    def numbers(self, first: Curve) -> list[float]:
        """Numbers for the core, with the curve at rate 0."""
        rows = [[1.0, *(v for point in c for v in point)] for c in self.joined(first)]
        rates = [0.0, *(float(rate) for rate, _ in self.curves)]
        return [4.0, float(len(rates)), *rates, *(v for row in rows for v in row)]


@dataclass(repr=False)
class Norton(Brief):
    """Creep in powers of stress and time: ``p' = A q^n t^m``.

    It acts in steps in which time passes, :class:`~corota.Visco` and
    :class:`~corota.Dynamic`; other steps have none.

    Parameters
    ----------
    A : float
        Factor [1/time^(1+m)/stress^n], > 0.
    n : float
        Exponent of the stress, > 0.
    m : float
        Exponent of the time since the start of the analysis, > -1.
    hardening : {"time", "strain"}
        Whether the rate follows the time, or the creep strain so far, as after creep at one stress.

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    With a yield stress the overstress above it creeps, as in CalculiX; in Abaqus the whole stress
    does. An increment of constant stress is exact, whatever its length, for both kinds of
    hardening.

    Source: F. H. Norton, *The Creep of Steel at High Temperatures* (1929).
    """

    A: float
    n: float
    m: float = 0.0
    hardening: Literal["time", "strain"] = "time"

    def __post_init__(self) -> None:
        number(self.A, "the factor A of creep", above=0.0)
        number(self.n, "the exponent n of creep", above=0.0)
        number(self.m, "the exponent m of the time", above=-1.0)
        choose_attribute(self, "hardening", HARDENINGS, "hardening of creep")

    def numbers(self) -> list[float]:
        """Numbers for the core."""
        return [5.0, float(self.A), float(self.n), float(self.m), float(self.hardening == "strain")]


#: Any of them.
Rate = CowperSymonds | YieldRatio | RateCurves | Norton

"""The state of an analysis between increments."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.energies import Energies
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.missed_peaks import Peak
    from corota.analysis.newton import Outcome
    from corota.analysis.stages import StageRecorder
    from corota.analysis.terms.linearized import LinearMotion
    from corota.arrays import Floats
    from corota.model.paths import CriticalPoint, Modes
    from corota.results.results import PointFields


class Resumption(Protocol):
    """A checkpoint from which an analysis continues."""

    checkpoint: Any

    @property
    def kind(self) -> str:
        """Kind of the loop that it was taken in."""

    def restore(self, state: State) -> None:
        """Restore the state of all objects of the analysis."""


@dataclass
class State:
    """The committed state of an analysis.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    energies : Energies
        The energy balance.
    time : float
        Total time at the start of the current step [time].
    step_time : float
        Time in the current step [time].
    at : Evaluation or None
        Evaluation at `u`.
    reaction : ndarray, shape (n_dofs,), or None
        Reactions at `u` where inertia takes part in them; else they follow from `at`.
    negative : int
        Negative pivots of the tangent, -1 if unknown.
    v, a : ndarray, shape (n_dofs,), or None
        Velocity and acceleration; None before any motion.
    carried : tuple of ndarray or None
        The very arrays `u` and `v` that a step of the energy-momentum scheme ended with, and the
        velocities of its mid-point relations: the elements still carry the rates that their momenta
        are made of.
    modes : list of Modes
        Found so far.
    notes : list of str
        Remarks for the user.
    strains : list of tuple (float, int, int)
        Largest local strain under the linear measure so far, and that of the last frame, with
        their step and increment.
    peaks : list of Peak
        Where the largest force of each contact pair stands so far.
    linear : LinearMotion or None
        Matrices that the last vibration modes belong to.
    stages : StageRecorder or None
        Paths of the stages of the model so far.
    recover : callable or None
        Gives fields and sums of a linear response, in place of those of `u`.
    failed : Outcome or None
        The last attempt at an increment that did not converge.
    loop : dict or None
        Data that the procedure needs to continue from here, by name; None where it cannot be
        resumed.
    resumption : Resumption or None
        The checkpoint from which the procedure continues.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"resumption", "recover"})

    u: Floats
    energies: Energies
    time: float = 0.0
    step_time: float = 0.0
    at: Evaluation | None = None
    reaction: Floats | None = None
    negative: int = -1
    counters: dict[str, int] = field(default_factory=dict)
    v: Floats | None = None
    a: Floats | None = None
    carried: tuple[Floats, Floats, Floats] | None = None
    critical: list[CriticalPoint] = field(default_factory=list)
    modes: list[Modes] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    strains: list[tuple[float, int, int]] = field(default_factory=lambda: [(0.0, 0, 0)] * 2)
    peaks: list[Peak] = field(default_factory=list)
    linear: LinearMotion | None = None
    stages: StageRecorder | None = None
    harmonic: Floats | None = None
    recover: Callable[[], tuple[list[PointFields], dict[str, float]]] | None = None
    failed: Outcome | None = None
    loop: dict[str, Any] | None = None
    resumption: Resumption | None = None

    @property
    def resumes(self) -> str:
        """Kind of the loop that a checkpoint restores; empty for none."""
        return "" if self.resumption is None else self.resumption.kind

    def resume(self, kind: str, **fresh: object) -> dict[str, Any]:
        """Restore the checkpoint; the state of a procedure goes into `fresh` objects.

        Returns
        -------
        dict
            The procedure's :attr:`loop` at the checkpoint.
        """
        assert self.resumption is not None
        assert self.resumption.kind == kind
        resumption, self.resumption = self.resumption, None
        self.loop = dict(fresh)
        resumption.restore(self)
        assert self.loop is not None
        return self.loop

    def stand_still(self) -> None:
        """Reset the velocity: a static step has none, and neither has the step after it."""
        if self.v is not None:
            self.v, self.a = np.zeros_like(self.u), np.zeros_like(self.u)
        self.carried = None

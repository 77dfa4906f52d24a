"""Forces that frames of a motion show: those of the end of the increment."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.evaluation import Evaluation

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.procedures.motion import ConservingMotion, NewmarkMotion
    from corota.analysis.terms.inertia import MotionState
    from corota.arrays import Floats


class EndForces:
    """External forces and reactions at the end of an increment, for every scheme.

    Schemes that weigh the equation between both ends have all forces of the end. The
    energy-momentum scheme has those of the middle: stress and loads are taken again, inertia and
    damping are extrapolated linearly from the last two middles.

    Parameters
    ----------
    system : System

    Attributes
    ----------
    at : Evaluation
        Internal and external forces at the end.
    reaction : ndarray, shape (n_dofs,)
        By equilibrium there; zero where nothing is prescribed.
    """

    at: Evaluation
    reaction: Floats

    def __init__(self, system: System) -> None:
        self.system = system
        # Time from the instant of the last known inertia to the end of that increment.
        self._lag = 0.0

    def start(self, now: MotionState, contact: Floats) -> None:
        """Take the forces at the start of a motion, in which contact has a force."""
        internal = now.internal - contact
        self.at = Evaluation(internal, now.external, internal, np.empty(0), None, now.link)
        whole = now.reaction() - now.gathered(contact)
        self.reaction = np.where(self.system.conditions.constrained, whole, 0.0)

    def find(
        self, motion: NewmarkMotion | ConservingMotion, contact: Floats, step_time: float
    ) -> None:
        """Find the forces at the end of an accepted increment, in which contact has a force."""
        system, begin, end = self.system, motion.start, motion.end
        inertia = end.inertia + end.damping
        internal, external, link = end.internal, end.external, end.link
        if hasattr(motion, "increment"):
            half = 0.5 * motion.dt
            share = half / (half + self._lag)
            inertia = inertia + share * (inertia - begin.inertia - begin.damping)
            self._lag = half
            own = system.forces(end.u, step_time)
            internal, external = own.internal, own.external
            # Forces of the end have their moments about the masters as they lie there.
            link = system.constraints.link(end.u)
        internal = internal - contact
        self.at = Evaluation(internal, external, internal, np.empty(0), None, link)
        whole = link.gather(internal + inertia - external)
        self.reaction = np.where(system.conditions.constrained, whole, 0.0)

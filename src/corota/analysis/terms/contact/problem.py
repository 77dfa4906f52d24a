"""An increment with contact: right-hand sides, interface of the problem."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.coupling import Coupling
    from corota.analysis.linear.saddle_point import SaddlePointSystem
    from corota.analysis.terms.contact.contact import ContactTerm
    from corota.analysis.terms.contact.gaps import ContactState, Kink

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    States = list[NDArray[np.int8]]


@dataclass
class RightHandSides:
    """Right-hand sides of one linearization, one per column.

    Parameters
    ----------
    force, constrained : ndarray, shape (n_dofs, k)
        Of equilibrium, and prescribed changes at constrained dofs.
    own : ndarray, shape (k,)
        Share of the contact residual: 1 in a Newton correction, 0 in a rate.
    """

    force: Floats
    constrained: Floats
    own: Floats


class ContactProblem(Protocol):
    """Interface of the equations of an increment for the choice of states and for messages.

    Attributes
    ----------
    n : int
        Dofs.
    last : list of ndarray or None
        States of the last correction.
    seen : dict of bytes to int
        How often a set of states came back.
    slip_directions : dict of int to ndarray
        Of slipping tractions, by the pair's first multiplier.
    flips : list of ndarray
        How often the state of each constraint has changed.
    single, sliding, pivoted, corrections : int
        Single changes, bodies that slid, corrections by pivoting, and all corrections so far.
    waited : int
        Iterations without progress.
    cautious, pivoting : bool
        Whether states change one by one, and whether they come from the whole linearized problem.
    loose : str
        Bodies that were unconstrained until contact was closed.
    kink : Kink or None
        Kink of the contact surfaces at which the bodies may rest.
    kinks, beyond : int
        Kinks tried, and corrections in which one carried more than its jump.
    places : list of ndarray
        Displacements of the last three evaluations.
    stage : str
        How the last correction was found.
    """

    n: int
    system: System
    contact_term: ContactTerm
    last: States | None
    seen: dict[bytes, int]
    slip_directions: dict[int, Floats]
    flips: list[Ints]
    single: int
    sliding: int
    pivoted: int
    corrections: int
    waited: int
    cautious: bool
    pivoting: bool
    loose: str
    kink: Kink | None
    kinks: int
    beyond: int
    inherits: bool
    places: list[Floats]
    stage: str

    @property
    def border(self) -> SaddlePointSystem:
        """Linear algebra with the multipliers."""
        ...

    def complementarity(self, at: Evaluation) -> tuple[float, int, int]:
        """Largest contact residual as a force; its pair and constraint."""
        ...

    def _pairs(self, contact_state: ContactState) -> Any: ...

    def _moved(self, z: Floats) -> Floats: ...

    def _choose(self, contact_state: ContactState) -> States: ...

    def _coupling(
        self, contact_state: ContactState, states: States
    ) -> tuple[Coupling, Floats, int]: ...

    def _solve(
        self, at: Evaluation, states: States, right_sides: RightHandSides
    ) -> tuple[Floats, Floats, int]: ...

    def _columns(
        self, at: Evaluation, right_sides: RightHandSides, states: States
    ) -> tuple[Floats, int]: ...

    def _far(self, du: Floats, right_sides: RightHandSides) -> bool: ...

    def _let_slip(
        self,
        at: Evaluation,
        states: States,
        right_sides: RightHandSides,
        found: tuple[Floats, Floats, int],
    ) -> tuple[Floats, Floats, int, States]: ...


__all__ = ["ContactProblem", "RightHandSides"]

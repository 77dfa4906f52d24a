"""Interface of a term of the equation of motion: anything that adds a force to its residual."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel, Role
    from corota.arrays import Floats, Ints
    from corota.model.steps import Step


#: No nodes.
NO_NODES = np.zeros(0, np.int64)
#: Rates or multipliers where there are none.
NONE = np.zeros(0)


class StatePoint(NamedTuple):
    """State at which a term is evaluated, and weights of its derivatives in a time scheme.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        Displacement along the axes of the nodes.
    time : float
        Step time.
    v, a : ndarray, shape (n_dofs,)
        Velocity and acceleration, zero at rest.
    weights : tuple of float
        Derivatives of displacement, velocity and acceleration by the unknown displacement.
    between : tuple, optional
        Displacements at both ends and length of an increment over which `v` is the mean rate.
    multipliers : ndarray, shape (n_multipliers,)
        Of contact and ties.
    """

    u: Floats
    time: float
    v: Floats = NONE
    a: Floats = NONE
    weights: tuple[float, float, float] = (1.0, 0.0, 0.0)
    between: tuple[Floats, Floats, float] | None = None
    multipliers: Floats = NONE


@dataclass
class TermOutput:
    """Output of a term.

    Parameters
    ----------
    contact : ndarray, shape (n_nodes, 5), or None
        See :attr:`corota.results.Frame.C`.
    pairs : dict of str to ndarray, shape (n_nodes, 5)
        See :attr:`corota.results.Frame.pairs`.
    """

    contact: Floats | None = None
    scalars: dict[str, float] = field(default_factory=dict)
    pairs: dict[str, Floats] = field(default_factory=dict)


class Term(Protocol):
    """A term of the equation.

    Its committed state is in its attributes. A checkpoint holds them all for terms of the package,
    and what :meth:`state` returns for terms from outside.
    """

    #: Name in messages.
    name: str = "user-defined term"
    #: Number of its multipliers, unknowns besides the dofs.
    unknowns: int = 0
    #: Remarks for the user after the start.
    notes: Sequence[str] = ()

    @property
    def joins(self) -> bool:
        """Whether it constrains bodies without supports, and rotates with them."""
        return False

    @property
    def opens(self) -> bool:
        """Whether its force may begin and end within an increment."""
        return False

    @property
    def fades(self) -> bool:
        """Whether it damps motions over the time of the step, to nothing at its end."""
        return False

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        """Start a step at a total time from a displacement, and the reactions there."""
        return

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Add the force to `at`, its size to the scale, and its derivative to the tangent.

        The force stands on the side of the stresses: what pulls a body back along its displacement
        or velocity is positive. One that stores energy adds to `at.internal`, one of velocities by
        `at.add_damping`. Its derivatives by displacement and velocity are multiplied by the
        `weights` of the point. The tangent is not needed where `at.values` is empty.
        """

    def holds(self, time: float) -> bool:
        """Whether force and tangent of the last evaluation are those of another step time."""
        return True

    def commit(self) -> None:
        """Accept the last evaluated state."""
        return

    def revert(self) -> None:
        """Go back to the committed state."""
        return

    def state(self) -> dict[str, object]:
        """What a checkpoint holds of a user-defined term: arrays and plain values by name."""
        return {}

    def restore(self, state: dict[str, object]) -> None:
        """Take back what :meth:`state` returned."""
        return

    def energies(self) -> dict[str, float]:
        """Energy stored (``ALLSE``) or dissipated so far in the committed state, by name."""
        return {}

    def output(self) -> TermOutput:
        """Output of the committed state."""
        return TermOutput()

    def multiplier_force(self, u: Floats | None = None, values: Floats = NONE) -> Floats | None:
        """Force of its committed multipliers at the dofs; None without any.

        Parameters
        ----------
        u : ndarray, shape (n_dofs,), optional
            Displacement at which they act, in place of the committed one.
        values : ndarray, shape (nnz,), optional
            Tangent of the elements there.
        """
        return None

    def nodes(self, role: Role) -> Ints:
        """Nodes of the surfaces that it joins, by their role in it."""
        return NO_NODES

    def gives_way(self) -> str:
        """What it lets slide or tip beyond the committed state, for messages; or nothing."""
        return ""

    def wedges(self) -> str:
        """What is wedged in the committed state, for messages; or nothing."""
        return ""

    def remarks(self, u: Floats, finished: bool) -> list[str]:
        """Remarks on the displacement at which a run ends, `finished` or not."""
        return []

    def keeps(self, at: Evaluation, states: list[NDArray[np.int8]], tolerance: float) -> bool:
        """Whether `states` of its constraints are those of an equilibrium.

        Parameters
        ----------
        at : Evaluation
            The equilibrium, with multipliers.
        tolerance : float
            Share of the largest multiplier, and of the size of the model, that is rounding.
        """
        return True


#: User-defined terms: each entry gives the term of a model, or ``None`` where it has none
#: (``docs/howto/user_term.md``). They act on displacements and velocities, in every scheme and in
#: all linear procedures.
TERMS: dict[str, Callable[[NumberedModel], Term | None]] = {}

"""Interface of a term of the equation of motion: anything that adds a force to its residual."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.model.steps import Step

    Floats = NDArray[np.float64]


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
        Velocity and acceleration; empty at rest.
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


class Term(Protocol):
    """A term of the equation.

    Its committed state is in its attributes: a checkpoint holds them all.
    """

    #: Name in messages.
    name: str

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

        The tangent is not needed where `at.values` is empty.
        """
        ...

    def holds(self, time: float) -> bool:
        """Whether force and tangent of the last evaluation are those of another step time."""
        return True

    def commit(self) -> None:
        """Accept the last evaluated state."""
        return

    def energies(self) -> dict[str, float]:
        """Energy stored (``ALLSE``) or dissipated so far in the committed state, by name."""
        return {}


#: User-defined terms: each entry gives the term of a model, or ``None`` where it has none. They
#: act on displacements, in every implicit scheme and in all linear procedures.
TERMS: dict[str, Callable[[NumberedModel], Term | None]] = {}


__all__ = ["TERMS", "StatePoint", "Term"]

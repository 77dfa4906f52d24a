"""The elements: internal force and tangent, with thermal strain and materials in Python inside."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.newton import ElementFailure
from corota.analysis.terms.term import Term
from corota.analysis.terms.user_material import NO_NUMBER, UserBlocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.conditions import Conditions
    from corota.analysis.terms.term import StatePoint

    Floats = NDArray[np.float64]


class Elements(Term):
    """All elements of a model.

    They are the first term: they initialize the arrays to which the others add.

    Parameters
    ----------
    system : NumberedModel
    conditions : Conditions
        Provides the temperatures.
    """

    name = "elements"

    def __init__(self, system: NumberedModel, conditions: Conditions) -> None:
        self.system, self.conditions = system, conditions
        self.user = UserBlocks(system.core, system.blocks)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Fill in forces, their sizes and, unless it is empty, the tangent.

        Raises
        ------
        ElementFailure
            If an element is inverted or its material did not converge.
        """
        system = self.system
        self.heat(point.time)
        here, nlgeom = system.in_space(point.u), system.nlgeom

        def assemble() -> None:
            about = system.about_linear
            system.core.assemble(here, nlgeom, at.internal, at.scale, at.values, about)

        self._run(here, assemble)
        at.internal = system.at_nodes(at.internal)

    def add_conserving(self, point: StatePoint, begun: Floats, mass: str, at: Evaluation) -> Floats:
        """Fill in the mid-point forces of the energy-momentum scheme; the tangent is with inertia.

        Parameters
        ----------
        point : StatePoint
            With both ends of the increment.
        begun : ndarray, shape (n_dofs,)
            Velocities that the mid-point rule starts from.
        mass : str
            Kind of the mass matrix.
        at : Evaluation

        Returns
        -------
        ndarray, shape (n_dofs,)
            Internal force and inertia.
        """
        system = self.system
        assert point.between is not None
        start, end, dt = point.between
        self.heat(point.time)
        x1, x0, v0 = (system.in_space(x) for x in (end, start, begun))
        both = np.empty(system.n_dofs)

        def assemble() -> None:
            system.core.conserving(
                x1, x0, v0, dt, mass, system.nlgeom, both, at.internal, at.scale, at.values
            )

        self._run(x1, assemble, at.values)
        at.internal = system.at_nodes(at.internal)
        return system.at_nodes(both)

    def _run(
        self, here: Floats, assemble: Callable[[], None], between: Floats | None = None
    ) -> None:
        """Assemble with the results of materials in Python; failures name their elements.

        Forces `between` two states have the tangent that is given.
        """
        system, user = self.system, self.user
        try:
            with system.timed("assemble"):
                user.assemble(here, system.nlgeom, assemble, between=between is not None)
                if between is not None and user.blocks:
                    user.linearize(assemble, between)
        except RuntimeError as error:
            raise self._failure(*error.args) from None

    def _failure(self, why: str, failed: list[tuple[int, int]]) -> ElementFailure:
        labels = self.system.model.mesh.cell_labels
        found = [str(labels[self.system.blocks[b].cells[e]]) for b, e in failed]
        shown = ", ".join(found[:5]) + (", ..." if len(found) > 5 else "")
        known = why if why == NO_NUMBER else "inverted or not converged"
        return ElementFailure(f"{known}: element {shown}")

    # -- thermal strain ----------------------------------------------------------------

    def heat(self, time: float) -> None:
        """Give the elements the thermal strain of a step time."""
        free = self.system.free
        if free.responds:
            free.apply(self.conditions.temperatures(time))

    def holds(self, time: float) -> bool:
        """Whether the elements have the temperatures of a step time already."""
        free = self.system.free
        return not free.responds or free.follows(self.conditions.temperatures(time))

    # -- committed state ---------------------------------------------------------------

    def plastic_increment(self) -> float:
        """Largest growth of the equivalent plastic strain since the last commit."""
        return max(float(self.system.core.plastic_increment()), self.user.plastic_increment())

    def commit(self) -> None:
        """Accept the last evaluated state."""
        self.system.core.commit()
        self.user.commit()


__all__ = ["Elements"]

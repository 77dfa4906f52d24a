"""The elements: internal force and tangent, with thermal strain and materials in Python inside."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.analysis.terms.term import StatePoint, Term
from corota.analysis.terms.user_material import NO_NUMBER, UserBlocks
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from corota._core import Problem
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.conditions import Conditions
    from corota.arrays import Floats
    from corota.model.steps import Step


class Elements(Term):
    """All elements of a model.

    They are the first term: they initialize the arrays to which the others add.

    Parameters
    ----------
    conditions : Conditions
        Provides the temperatures.
    """

    name = "elements"

    def __init__(self, system: NumberedModel, conditions: Conditions) -> None:
        self.system, self.conditions = system, conditions
        self.user = UserBlocks(system.core, system.own_blocks)
        #: Total time at the start of the step, and step times of the last evaluation and the
        #: committed state.
        self.begun = self.seen = self.reached = 0.0
        self.lasting = self.passes = False

    @property
    def notes(self) -> list[str]:  # type: ignore[override]
        """What materials in Python leave out."""
        return self.user.notes

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        self.begun, self.seen, self.reached = time, 0.0, 0.0
        self.passes = hasattr(step, "lasting")
        self.lasting = getattr(step, "lasting", False)

    def _set_clock(self, time: float) -> None:
        """Tell the laws the time since the committed state."""
        self.seen = time
        self.give_clock(self.system.core)

    def give_clock(self, core: Problem) -> None:
        """Tell other elements the same time."""
        passed = max(self.seen - self.reached, 0.0) if self.passes else 0.0
        core.set_clock(passed, self.begun + self.seen, self.lasting)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Fill in forces, their sizes and, unless it is empty, the tangent.

        Raises
        ------
        ElementFailure
            If an element is inverted or its material did not converge.
        """
        system = self.system
        self.heat(point.time)
        self._set_clock(point.time)
        here, nlgeom = system.in_space(point.u), system.nlgeom

        def assemble() -> None:
            about = system.about_linear
            system.core.assemble(here, nlgeom, at.internal, at.scale, at.values, about)

        self._run(here, assemble)
        at.internal = system.at_nodes(system.communicator.sum(at.internal))
        at.scale = system.communicator.sum(at.scale)

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

        Returns
        -------
        ndarray, shape (n_dofs,)
            Internal force and inertia.
        """
        system = self.system
        assert point.between is not None
        start, end, dt = point.between
        self.heat(point.time)
        self._set_clock(point.time + 0.5 * dt)
        x1, x0, v0 = (system.in_space(x) for x in (end, start, begun))
        both = np.empty(system.n_dofs)

        def assemble() -> None:
            system.core.conserving(
                x1, x0, v0, dt, mass, system.nlgeom, both, at.internal, at.scale, at.values
            )

        self._run(x1, assemble, at.values)
        at.internal = system.at_nodes(system.communicator.sum(at.internal))
        at.scale = system.communicator.sum(at.scale)
        return system.at_nodes(system.communicator.sum(both))

    def _run(
        self, here: Floats, assemble: Callable[[], None], between: Floats | None = None
    ) -> None:
        """Assemble with the results of materials in Python; failures name their elements.

        Forces `between` two states have the tangent that is given.
        """
        if self.system.communicator.size > 1:
            self._run_together(here, assemble, between)
            return
        self._run_own(here, assemble, between)

    def _run_together(
        self, here: Floats, assemble: Callable[[], None], between: Floats | None
    ) -> None:
        """The same on several processes: all fail if one does."""
        failure: Exception | None = None
        try:
            self._run_own(here, assemble, between)
        except Exception as error:
            failure = error
        if (failure := self.system.communicator.agree(failure)) is not None:
            raise failure

    def _run_own(self, here: Floats, assemble: Callable[[], None], between: Floats | None) -> None:
        """The same for the own elements."""
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
        found = [str(labels[self.system.own_blocks[b].cells[e]]) for b, e in failed]
        shown = ", ".join(found[:5]) + (", ..." if len(found) > 5 else "")
        known = why if why == NO_NUMBER else "inverted or not converged"
        return ElementFailure(f"{known}: element {shown}")

    # -- thermal strain ----------------------------------------------------------------

    def heat(self, time: float) -> None:
        """Give the elements the thermal strain of a step time."""
        free = self.system.free
        if free.responds:
            free.apply(self.conditions.temperatures.at(time))

    def holds(self, time: float) -> bool:
        """Whether the elements have the temperatures of a step time already."""
        if self.system.depends_on_time and self.passes and time != self.seen:
            return False
        free = self.system.free
        return not free.responds or free.follows(self.conditions.temperatures.at(time))

    # -- committed state ---------------------------------------------------------------

    def plastic_increment(self) -> float:
        """Largest growth of the equivalent plastic strain since the last commit."""
        own = max(float(self.system.core.plastic_increment()), self.user.plastic_increment())
        return self.system.communicator.greatest(own)

    def creep_error(self) -> float:
        """Largest error of the creep strain of the last evaluation."""
        return self.system.communicator.greatest(float(self.system.core.creep_error()))

    @contextmanager
    def unloading(self, u: Floats) -> Iterator[None]:
        """Let every part of the elements answer elastically about the committed state.

        Points do so by themselves. The hourglass of an element with one point has the stiffness of
        the increment before; an increment without displacement gives it the elastic one.

        Parameters
        ----------
        u : ndarray, shape (n_dofs,)
            The committed displacement.
        """
        system = self.system
        sections = [block.section for block in system.blocks]
        if not any(elements.find(s.element).stabilized and s.material.remembers for s in sections):
            yield
            return
        values, lengths = system.core.state()
        force, scale = np.zeros((2, system.n_dofs))
        here, none, about = system.in_space(u), np.empty(0), system.about_linear

        def assemble() -> None:
            system.core.set_clock(0.0, 0.0, False)
            system.core.assemble(here, system.nlgeom, force, scale, none, about)

        self._run(here, assemble)
        system.core.commit()
        try:
            yield
        finally:
            system.core.restore_state(values, lengths)

    def commit(self) -> None:
        self.system.core.commit()
        self.user.commit()
        self.reached = self.seen

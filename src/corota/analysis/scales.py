"""Scales of the residual: tolerance, rounding, and excessive displacements.

The scale of a residual must not grow with the failure that it detects. It is the largest of
external forces, element forces, contact forces and inertia forces, here and in the committed
state. A residual above the tolerance counts as rounding if it is at most the effect of rounding of
the positions of all dofs, by the tangent, and never above a millionth of the scale.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.newton import FLOOR, ResidualNorms, larger
from corota.model import elements

if TYPE_CHECKING:
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.conditions import Conditions
    from corota.analysis.terms.term import Term
    from corota.arrays import Floats, Ints


#: Forces below this multiple of the rounding errors of the coordinates count as zero.
NEGLIGIBLE_FORCE = 1e3
#: Rounding is accepted up to this fraction of all acting forces; without loads, up to
#: this multiple of the zero force.
LARGEST_NOISE, FARTHEST = 1e-6, 10.0
#: Share of the moments over the size of the model that forces are measured by at least, and
#: of the forces times that size for moments: either may vanish altogether.
LEAST = 1e-6
#: A body that moves by this multiple of the model size beyond its supports is unconstrained.
FAR = 1e2
EPS, TINY = float(np.finfo(float).eps), float(np.finfo(float).tiny)


class Scales:
    """Sizes that residuals of a system are compared with.

    Parameters
    ----------
    terms : list of Term
        All terms of the equation.

    Attributes
    ----------
    stiffest : float
        Largest stiffness of a displacement at the start; elements alone [force/length].
    ratio : float
        Of the largest and the smallest of these.
    moved : float
        Largest displacement of the last checked state [length].
    tolerance : float
        Of the current step.
    """

    def __init__(self, system: NumberedModel, conditions: Conditions, terms: list[Term]) -> None:
        self.system, self.conditions, self.terms = system, conditions, terms
        self.stiffest, self.ratio, self.moved = 0.0, 1.0, 0.0
        self.tolerance = 1e-9
        #: Of the last checked state: inertia per displacement [force/length], all that acts, the
        #: largest rounding and the rounding of the stiffest dof [force].
        self._inertial_stiffness = self.whole = self._most = self._noise = 0.0
        #: Largest force and moment of the last checked state, and of the committed one.
        self._sizes = self._committed = [0.0, 0.0]
        self._begun: Floats | None = None
        #: Rotations, of reference nodes, that only the displacements of other nodes resist.
        self._levered: Ints = np.zeros(0, dtype=np.int64)
        self._bodies = any(not elements.find(b.section.element).line for b in system.blocks)

    def begin(self, tolerance: float, u: Floats) -> None:
        """Start a step at a displacement."""
        self.tolerance, self._begun = tolerance, u.copy()

    def measure(self, values: Floats) -> None:
        """Take the stiffness from a tangent of the elements, before anything is added to it."""
        diagonal = np.abs(self._diagonal(values))
        system = self.system
        held = system.link.gather_sizes(np.where(system.is_rotation, diagonal, 0.0))
        loose = np.zeros(len(held), dtype=bool)
        loose[system.constraints.free] = True
        self._levered = np.flatnonzero(loose & system.is_rotation & (held == 0.0))
        diagonal = diagonal[~system.is_rotation]
        self.stiffest = float(diagonal.max(initial=0.0))
        some = diagonal[diagonal > 0.0]
        self.ratio = self.stiffest / float(some.min()) if len(some) else 1.0

    def _diagonal(self, values: Floats) -> Floats:
        return self.system.pattern.diagonal_of(values)

    def commit(self) -> None:
        """Accept the last checked state."""
        self._committed = self._sizes

    @property
    def zero_force(self) -> float:
        """Force that rounding of the coordinates alone would give."""
        return (
            NEGLIGIBLE_FORCE * EPS * (self.stiffest + self._inertial_stiffness) * self.system.length
        )

    @property
    def force(self) -> float:
        """Largest force of the last checked state or of the committed one."""
        return max(self._sizes[0], self._committed[0])

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual against its scale, for forces and moments separately.

        The committed state is included because a fully unloaded body has no forces of
        its own to compare with. In dynamics `at.momentum` is the largest of the terms that the
        acceleration is a difference of: it measures rounding, not the residual.
        """
        system, length = self.system, self.system.length
        scale, internal, external = at.scale, at.internal, at.external
        if at.link.couples:
            # Forces transmitted by constraints are no scale: only the residual is checked.
            internal = at.reaction
            scale = external = at.link.gather_sizes(np.maximum(scale, np.abs(external)))
        self._sizes, residual, worst, displacement = system.core.sizes(
            internal, scale, external, u, self.conditions.constrained, not at.link.couples
        )
        self._inertial_stiffness = at.inertial_stiffness
        force = larger(self._sizes[0], self._committed[0])
        moment = larger(self._sizes[1], self._committed[1])
        moment, force = max(moment, LEAST * force * length), max(force, LEAST * moment / length)
        self.whole = whole = max(force, moment / length, at.momentum)
        # Rotations round like the displacements they give an element.
        moved = max(displacement[0], system.cell_size * displacement[1])
        self.moved = float(displacement[0])
        self._noise = EPS * (self.stiffest + at.inertial_stiffness) * moved
        zero_force = self.zero_force
        if whole <= zero_force and not at.external.any():
            # A slow motion may be that small: its size is unknown before a correction.
            return ResidualNorms(
                0.0, 0.0, 0.0, 0, idle=at.inertial_stiffness > 0.0 and bool(max(residual))
            )
        relative = (_ratio(residual[0], force), _ratio(residual[1], moment))
        norms = ResidualNorms(*relative, 0.0, worst[0] if relative[0] >= relative[1] else worst[1])
        norms.combined = (_ratio(residual[0], whole), _ratio(residual[1], whole * length))
        most = LARGEST_NOISE * whole
        if FARTHEST * zero_force > most and not at.external.any():
            most = FARTHEST * zero_force
        self._most = most
        if norms.size > self.tolerance and max(residual[0], residual[1] / length) <= most:

            def measure() -> tuple[float, float]:
                excess = self._beyond_noise(at, moved, force, moment)
                floors = [r / e if e > 0.0 else r for r, e in zip(relative, excess, strict=True)]
                return floors[0], floors[1]

            norms.measure = measure
        return norms

    def _beyond_noise(
        self, at: Evaluation, moved: float, force: float, moment: float
    ) -> tuple[float, float]:
        """Residuals above the tolerance over their rounding, the largest of each kind."""
        system = self.system
        if not len(at.values):
            return np.inf, np.inf
        left = np.abs(at.reaction)
        left[self.conditions.constrained] = 0.0
        turn = system.is_rotation
        # The force of a dof rounds with the positions of all dofs of its elements.
        rounding = EPS * moved / np.where(turn, system.cell_size, 1.0)
        noise = system.pattern.multiply(np.abs(at.values), rounding)
        if at.added is not None:
            noise = noise - at.added * rounding
        noise = at.link.gather_sizes(noise)
        above = left > np.where(turn, self.tolerance * moment, self.tolerance * force)
        over, turn = left[above] / np.maximum(noise[above], TINY), turn[above]
        return float(over[~turn].max(initial=0.0)), float(over[turn].max(initial=0.0))

    def add_complementarity(self, norms: ResidualNorms, complementarity: float) -> None:
        """Add the contact residual, a force, to the last residual norms."""
        # Where nothing is loaded yet, and where all surfaces part, forces of rounding size are
        # the measure.
        force = max(self.force, self.zero_force)
        ratio = _ratio(complementarity, force)
        norms.force = max(norms.force, min(ratio, 1.0))
        least, moment = norms.combined
        norms.combined = (
            max(least, _ratio(complementarity, max(self.whole, self.zero_force))),
            moment,
        )
        if norms.force > self.tolerance:
            # Gaps become forces by the stiffness of the nodes.
            rounding, of_elements = min(self._noise, self._most / FLOOR), norms.measure

            def measure() -> tuple[float, float]:
                floor, moment_floor = of_elements() if of_elements is not None else (0.0, 0.0)
                floor = max(floor, _ratio(rounding, force))
                if ratio > 1.0:
                    # The residual is reported as 1, and so is its rounding.
                    floor = min(floor / ratio, _ratio(rounding, complementarity))
                return floor, moment_floor

            norms.measure = measure

    def implausible_displacement(self, u: Floats, before: Floats | None = None) -> str:
        """Why a static displacement is implausible; empty if it is not.

        Parameters
        ----------
        before : ndarray, shape (n_dofs,), optional
            Displacement that the increment starts from.

        Notes
        -----
        A constrained body moves at most by its supports and its own deformation. Elements take
        rotations of their nodes up to whole turns: a node that an iterate turned once more is in
        equilibrium as well.
        """
        system = self.system
        if system.nlgeom and (twisted := self._twisted(u) or self._turned(u, before)):
            return twisted
        if not self._bodies or not (system.nlgeom or any(term.joins for term in self.terms)):
            return ""
        begun = 0.0 if self._begun is None else self._begun
        moved = np.abs(u[: system.n_dofs] - begun)
        moved[system.is_rotation] = 0.0
        worst = int(moved.argmax())
        if moved[worst] <= FAR * system.length:
            return ""
        constrained = moved[self.conditions.constrained].max(initial=0.0)
        if moved[worst] <= FAR * (system.length + float(constrained)):
            return ""
        node = system.model.mesh.node_labels[system.node_of_dof[worst]]
        return (
            f"node {node} moves by {moved[worst]:.3g}, {moved[worst] / system.length:.2g} times "
            "the size of the model: its body is unconstrained; add a support"
        )

    def _turned(self, u: Floats, before: Floats | None) -> str:
        """Which rigid body turns by more than half a turn in an increment, against springs alone.

        Its forces are the same after each whole turn: such an increment may end at any of them.
        Contact knows the way that its surfaces slide.
        """
        free = self._levered[~self.conditions.constrained[self._levered]]
        if before is None or not len(free) or any(term.joins for term in self.terms):
            return ""
        turned = np.abs(u[free] - before[free])
        worst = int(turned.argmax())
        if turned[worst] <= np.pi:
            return ""
        node = self.system.model.mesh.node_labels[self.system.node_of_dof[free[worst]]]
        return (
            f"the body of reference node {node} turns by {turned[worst]:.3g}, more than half a "
            "turn in an increment: take smaller ones"
        )

    def _twisted(self, u: Floats) -> str:
        """Which nodes of an element turn against each other by more than half a turn in a step."""
        system = self.system
        turned = u[: system.n_dofs] - (0.0 if self._begun is None else self._begun)
        for block in system.blocks:
            if elements.find(block.section.element).dofs_per_node < 3:
                continue
            angles = turned[system.start[block.nodes] + 2]
            first, last = angles.argmin(axis=1), angles.argmax(axis=1)
            apart = np.take_along_axis(angles, np.stack([first, last], 1), 1) @ [-1.0, 1.0]
            apart[self.conditions.changes.removed[block.cells]] = 0.0
            worst = int(apart.argmax())
            if apart[worst] > np.pi:
                ends = block.nodes[worst, [first[worst], last[worst]]]
                a, b = system.model.mesh.node_labels[ends]
                return (
                    f"nodes {a} and {b} of an element turn against each other by "
                    f"{apart[worst]:.3g}, more than half a turn in this step: take more elements"
                )
        return ""


def _ratio(size: float, scale: float) -> float:
    """``size / scale`` where the scale may be zero."""
    if scale == 0.0:
        return 0.0 if size == 0.0 else np.inf
    return size / scale

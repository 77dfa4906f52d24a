"""A model numbered for analysis: elements in the core, dofs, constraints, matrix pattern.

The basis of the terms of the equation, without loads, supports and contact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

import corota._core as _core
from corota.analysis.constraints.none import constraints_of
from corota.analysis.linear.matrix import AssembledPattern
from corota.analysis.linear.solvers import LinearSolver, Multifrontal
from corota.analysis.linear.system import LinearSystem
from corota.analysis.memory import require_model
from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.analysis.parallel.partition import own_blocks
from corota.analysis.terms.moving_mass import MovingMass
from corota.analysis.terms.thermal import FreeStrains, start_temperatures
from corota.errors import ModelError, SingularError
from corota.model import axisymmetry, elements
from corota.model.blocks import blocks_of, check_shapes, core_input

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.analysis.timer import Timer
    from corota.arrays import Bools, Floats, Ints
    from corota.model.model import Model
    from corota.model.steps import Step


#: Surfaces of ties; slaves and masters of contact.
Role = Literal["tied", "slave", "master"]
#: Names of the dofs in messages.
DOF_NAMES = ("x", "y", "rotation")


class NumberedModel:
    """The dofs and matrices of a model.

    Parameters
    ----------
    steps : sequence of Step, optional
        Their supports keep edges of drilling elements straight, as those of the model do.

    Attributes
    ----------
    n_dofs : int
    start : ndarray of int, shape (n_nodes + 1,)
        First dof of each node and the total.
    is_rotation : ndarray of bool, shape (n_dofs,)
    free_motion_excluded : bool
        Whether the structure without its loads has no free motion in this step.
    """

    free_motion_excluded = False

    def __init__(
        self, model: Model, solver: LinearSolver, threads: int = 1, steps: Sequence[Step] = ()
    ) -> None:
        self.model = model
        #: The processes that run this analysis; each has its own elements.
        self.communicator: Communicator = getattr(solver, "communicator", ALONE)
        self.blocks = blocks_of(model, steps)
        #: Mass for gravity in static steps.
        self.mass = MovingMass()
        self.linear = LinearSystem(solver)
        if isinstance(solver, Multifrontal):
            solver.place_nodes(model.mesh.points)
        mesh = model.mesh
        check_shapes(model, self.blocks)
        #: Whether any material depends on the time that passes.
        self.depends_on_time = any(b.section.material.depends_on_time for b in self.blocks)
        self.creeps = any(b.section.material.creeps for b in self.blocks)
        #: Whether the model is a solid of revolution; then nodes and their zero dof.
        self.axisymmetric = axisymmetry.is_axisymmetric(model)
        self.guided = axisymmetry.guided(model) if self.axisymmetric else []
        if self.axisymmetric:
            axisymmetry.check_constraints(model)
        start = start_temperatures(model)
        #: Blocks of the own elements, and their numbers in `blocks`.
        self.own_blocks, self.own_numbers = own_blocks(self.blocks, mesh.points, self.communicator)
        inputs = [core_input(b, mesh.points, start) for b in self.own_blocks]
        require_model(self.own_blocks, mesh.n_nodes)
        carried = np.zeros(mesh.n_nodes, np.int64)
        for b in self.blocks:
            own = elements.find(b.section.element).dofs_per_node
            np.maximum.at(carried, b.nodes.ravel(), own)
        extra = np.zeros(0, np.uint8)
        if model.constraints or model.contacts or model.point_masses or model.dashpots:
            from corota.analysis.constraints.setup import (
                carry_attachments,
                carry_curves,
                extra_dofs,
            )

            if model.constraints:
                extra = extra_dofs(model, carried > 0)
            if model.contacts:
                extra = carry_curves(model, carried, extra)
            if model.point_masses or model.dashpots:
                extra = carry_attachments(model, carried, extra)
        if self.communicator.size > 1:
            # All processes number the dofs of all elements.
            extra = np.maximum(extra if len(extra) else 0, carried).astype(np.uint8)
        #: Dofs of each node beside those of its elements.
        self.extra_dofs = extra
        try:
            self.core = _core.Problem(mesh.points, inputs, extra)
        except ValueError as error:
            raise ModelError(str(error)) from None
        self.core.set_threads(threads)
        self.free = FreeStrains(self.core, model, self.own_blocks, self.communicator)
        self.n_dofs: int = self.core.n_dofs
        self.start = self.core.dof_start.astype(np.int64)
        self.per_node = np.diff(self.start)
        self.node_of_dof = self.core.node_of_dof.astype(np.int64)
        self.component = np.arange(self.n_dofs) - self.start[self.node_of_dof]
        self.is_rotation = self.component == 2
        self.pattern = AssembledPattern(self.core, self.communicator)
        self.nlgeom = True
        #: Whether linear procedures look at the state of a geometrically linear step.
        self.about_linear = False
        #: Largest local strain at the last recovery, of sections where it is linear.
        self.largest_linear_strain = 0.0
        self.constraints = constraints_of(model, self.start, carried, self.pattern)
        #: The constraints as they were linearized for the last correction.
        self.link = self.constraints.link(np.zeros(self.n_dofs))
        if hasattr(solver, "motions"):
            motions = self.rigid_motions(mesh.points - mesh.points.mean(axis=0))
            # A ring moves along its axis alone.
            motions = motions[:, 1:2] if self.axisymmetric else motions
            solver.motions = motions[self.constraints.free]
        rows = mesh.points.T
        self.length = float(_extent(rows).max()) or 1.0
        self.cell_size = max(float(_extent(rows[:, b.nodes.T]).max()) for b in self.blocks)

    def rigid_motions(self, arm: Floats) -> Floats:
        """Two translations and a rotation, shape (n_dofs, 3), of nodes at `arm` (n_nodes, 2)."""
        one, zero = np.ones(len(arm)), np.zeros(len(arm))
        x, y = np.stack([one, zero, zero], axis=1), np.stack([zero, one, zero], axis=1)
        spin = np.stack([-arm[:, 1], arm[:, 0], one], axis=1)
        return np.stack([self.from_nodes(motion) for motion in (x, y, spin)], axis=1)

    # -- numbering ---------------------------------------------------------------------

    def dofs(self, nodes: Ints, dof: int | Ints) -> Ints:
        """Dof numbers of nodes, of each the same or its own; -1 where a node has no such dof."""
        nodes = np.asarray(nodes, np.int64)
        return np.where(self.per_node[nodes] > dof, self.start[nodes] + dof, -1)

    def attached_dofs(self, nodes: Ints, dof: int, what: str) -> Ints:
        """Dofs of nodes at which something is attached.

        Raises
        ------
        ModelError
            If a node has no such dof.
        """
        dofs = self.dofs(nodes, dof)
        if (dofs < 0).any():
            node = self.model.mesh.node_labels[nodes[int(np.argmax(dofs < 0))]]
            kind = "rotation" if dof == 2 else "displacement"
            raise ModelError(
                f"the {what} at node {node} needs a {kind}, which no element there has; put it "
                "on a node of an element" + (" with drilling rotations" if dof == 2 else "")
            )
        return dofs

    def by_node(self, vector: Floats) -> Floats:
        """Values by node and global component, shape (n_nodes, 3), 0 where there is no dof."""
        return self.core.by_node(np.ascontiguousarray(self.in_space(vector)))

    def in_space(self, vector: Floats) -> Floats:
        """A vector in nodal axes, converted to global axes, shape (n_dofs,)."""
        return self.constraints.to_global(vector)

    def at_nodes(self, vector: Floats) -> Floats:
        """A vector in global axes, converted to nodal axes, shape (n_dofs,)."""
        return self.constraints.to_axes(vector)

    def from_nodes(self, values: Floats) -> Floats:
        """Inverse of `by_node`."""
        out: Floats = values.reshape(-1, 3)[self.node_of_dof, self.component]
        return self.at_nodes(out)

    def describe(self, dof: int) -> str:
        """Name a dof by the user's node label."""
        node = self.node_of_dof[dof]
        return f"node {self.model.mesh.node_labels[node]} {DOF_NAMES[self.component[dof]]}"

    def product(self, values: Floats, x: Floats) -> Floats:
        """A matrix in global axes, upper triangle, times a vector along the nodes' axes."""
        return self.at_nodes(self.pattern.multiply(values, self.in_space(x)))

    def thermal_rate(self, u: Floats, heating: Floats) -> Floats:
        """Change of the internal force at `u` while the nodes heat up, shape (n_dofs,).

        A central difference about the temperatures that the elements have; exact for constant
        coefficients of expansion and a linear law.
        """
        now, here = self.free.now, self.in_space(u)
        forces = []
        for share in (0.5, -0.5):
            force, scale = np.empty(self.n_dofs), np.empty(self.n_dofs)
            self.free.apply(now + share * heating)
            self.core.assemble(here, self.nlgeom, force, scale, np.empty(0))
            forces.append(force)
        self.free.apply(now)
        return self.at_nodes(self.communicator.sum(forces[0] - forces[1]))

    @property
    def constrained(self) -> Bools:
        """Dofs that supports prescribe, shape (n_dofs,): none without terms."""
        return np.zeros(self.n_dofs, bool)

    def singular(self, error: SingularError) -> SingularError:
        """The error of a singular matrix in terms of nodes."""
        return error

    def nodes_of_terms(self, role: Role) -> Bools:
        """Nodes of the surfaces that terms join, shape (n_nodes,): none without terms."""
        return np.zeros(len(self.per_node), bool)

    @property
    def counted(self) -> Bools:
        """Dofs that measure the length of a path: displacements, not rotations."""
        counted: Bools = ~self.is_rotation
        return counted

    def timed(self, phase: str) -> Timer:
        """Add the time of a block to the profile."""
        return self.linear.timed(phase)

    @property
    def profile(self) -> dict[str, float]:
        """Seconds by phase."""
        return self.linear.profile


def _extent(points: Floats) -> Floats:
    """Extent along x and y of points of shape (2, n, ...): shape (2, ...)."""
    extent: Floats = points.max(axis=1) - points.min(axis=1)
    return extent

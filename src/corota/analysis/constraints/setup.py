"""From the constraints of a model to relations between numbered dofs, in the order of use."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.constraints.relations import Follow, LinearRelation, Mean, Relation
from corota.analysis.constraints.straight_line import OnLine
from corota.arrays import Bools, Floats, Ints, distinct
from corota.errors import Location, ModelError
from corota.mesh.parts import nodes_of
from corota.model.constraints import Coupling, Equation, StraightLine
from corota.model.contact import RigidCurve, is_gap, of_gap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.model.model import Model


NAMES = ("x", "y", "rotation")
#: Nodes of a straight line may be off it by this fraction of its length; the offset is removed.
OFF_LINE = 1e-6


def extra_dofs(model: Model, in_element: Bools) -> NDArray[np.uint8]:
    """Dofs that constraints give to nodes, shape (n_nodes,); empty without constraints.

    Reference nodes get a rotation; nodes without elements get the dofs that constraints use.
    """
    if not model.constraints:
        return np.zeros(0, np.uint8)
    extra = np.zeros(model.mesh.n_nodes, np.uint8)
    for item in model.constraints:
        if isinstance(item, Equation):
            for node, dof, _ in item.terms:
                if not in_element[node]:
                    extra[node] = max(extra[node], 2, dof + 1)
        elif isinstance(item, StraightLine):
            named = np.append(nodes_of(model.mesh, item.nodes), [item.first, item.last])
            loose = named[~in_element[named]]
            extra[loose] = np.maximum(extra[loose], 2)
        else:
            nodes = nodes_of(model.mesh, item.nodes)
            loose = nodes[~in_element[nodes]]
            if item.kind == "distributing" and len(loose):
                label = model.mesh.node_labels[loose[0]]
                raise ModelError(
                    f"node {label} of the distributing coupling belongs to no element; remove it "
                    "from the coupling",
                    item.where,
                )
            extra[loose] = np.maximum(extra[loose], 2)
            extra[item.reference] = 3
    return extra


def reference_nodes(model: Model) -> Ints:
    """Nodes that carry rigid curves; they have two displacements and a rotation."""
    curves = [pair.master for pair in model.contacts if isinstance(pair.master, RigidCurve)]
    nodes = (curve.turning_node for curve in curves)
    found = {node for node in nodes if node is not None}
    return _existing(model, found)


def gap_nodes(model: Model) -> Ints:
    """Nodes of gap elements; they have two displacements."""
    gaps = [of_gap(model.mesh.points, pair) for pair in model.contacts if is_gap(pair)]
    return _existing(model, {node for nodes, *_ in gaps for node in nodes})


def _existing(model: Model, found: set[int]) -> Ints:
    for node in found:
        if not 0 <= node < model.mesh.n_nodes:
            raise ModelError(f"a rigid curve has reference node index {node}, which does not exist")
    return np.array(sorted(found), np.int64)


def carry_attachments(model: Model, carried: Ints, extra: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Give nodes of point masses and dashpots their dofs; changes `carried`, returns `extra`."""
    wanted = np.zeros(model.mesh.n_nodes, np.uint8)
    for mass in model.point_masses:
        nodes = nodes_of(model.mesh, mass.nodes)
        wanted[nodes] = np.maximum(wanted[nodes], 3 if mass.inertia else 2)
    for item in model.dashpots:
        turns = item.to_ground[2] > 0.0 or 2 in (item.dofs or ())
        ends = [item.first] if item.second is None else [item.first, item.second]
        wanted[ends] = np.maximum(wanted[ends], 3 if turns else 2)
    extra = extra if len(extra) else np.zeros(model.mesh.n_nodes, np.uint8)
    # Nodes of elements and constraints keep their dofs: a rotation missing there is an error.
    bare = (carried == 0) & (extra == 0)
    extra[bare] = carried[bare] = wanted[bare]
    return extra


def carry_curves(model: Model, carried: Ints, extra: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Give reference nodes of rigid curves and nodes of images their dofs.

    Changes `carried`, returns `extra`.
    """
    wanted = np.zeros(model.mesh.n_nodes, np.int64)
    wanted[gap_nodes(model)] = 2
    wanted[reference_nodes(model)] = 3
    for pair in model.contacts:
        for image in pair.images if pair.images is not None else ():
            nodes = np.flatnonzero(image >= 0)
            wanted[image[nodes]] = carried[nodes]
    short = carried < wanted
    if short.any():
        carried[short] = wanted[short]
        extra = extra if len(extra) else np.zeros(model.mesh.n_nodes, np.uint8)
        extra[short] = wanted[short]
    return extra


class Builder:
    """Relations of a model.

    Parameters
    ----------
    start : ndarray of int, shape (n_nodes + 1,)
        First dof of each node and the total.
    axes : dict of int to ndarray, shape (2, 2)
        Columns: axes of the nodes that have their own.
    """

    def __init__(self, model: Model, start: Ints, axes: dict[int, Floats]) -> None:
        self.model, self.start, self.axes = model, start, axes

    def build(self) -> list[Relation]:
        """All relations, each after those that its masters depend on.

        Raises
        ------
        ModelError
            If two constraints determine the same dof, or they depend on each other circularly.
        """
        relations: list[Relation] = []
        for item in self.model.constraints:
            if isinstance(item, Equation):
                relations.append(self._equation(item))
            elif isinstance(item, StraightLine):
                relations += self._straight(item)
            elif item.kind == "kinematic":
                relations.append(self._follow(item))
            else:
                relations.append(self._mean(item))
        owner: dict[int, Relation] = {}
        for relation in relations:
            for dof in relation.dependent.tolist():
                if dof in owner:
                    raise ModelError(
                        f"{self.name(dof)} is determined twice: by {_said(owner[dof])} and by "
                        f"{_said(relation)}; leave it out of one of them (an equation "
                        "determines its first term)",
                        relation.where,
                    )
                owner[dof] = relation
        return self._sorted(relations, owner)

    def name(self, dof: int) -> str:
        """A dof by the user's label."""
        label = self.model.mesh.node_labels[self._node(dof)]
        return f"node {label} {NAMES[self._component(dof)]}"

    def _node(self, dof: int) -> int:
        return int(np.searchsorted(self.start, dof, side="right")) - 1

    def _component(self, dof: int) -> int:
        return int(dof - self.start[self._node(dof)])

    def _sorted(self, relations: list[Relation], owner: dict[int, Relation]) -> list[Relation]:
        done: dict[int, int] = {}  # 1: under way, 2: placed
        out: list[Relation] = []
        for first in relations:
            if id(first) in done:
                continue
            stack: list[tuple[Relation, list[int]]] = [(first, first.masters.tolist())]
            done[id(first)] = 1
            while stack:
                relation, left = stack[-1]
                if not left:
                    done[id(relation)] = 2
                    out.append(relation)
                    stack.pop()
                    continue
                needed = owner.get(left.pop())
                if needed is None or done.get(id(needed)) == 2:
                    continue
                if done.get(id(needed)) == 1:
                    circle = [r for r, _ in stack]
                    circle = circle[next(i for i, r in enumerate(circle) if r is needed) :]
                    names = " -> ".join(_said(r) for r in [*circle, needed])
                    raise ModelError(
                        f"constraints depend on each other circularly: {names}; make another dof "
                        "the first term of an equation, or leave one of them out",
                        needed.where,
                    )
                done[id(needed)] = 1
                stack.append((needed, needed.masters.tolist()))
        return out

    # -- single constraints ------------------------------------------------------------

    def _dof(self, node: int, dof: int, where: Location | None) -> int:
        if not 0 <= node < self.model.mesh.n_nodes:
            raise ModelError(
                f"a constraint refers to node index {node}, which does not exist", where
            )
        if dof >= self.start[node + 1] - self.start[node]:
            label = self.model.mesh.node_labels[node]
            raise ModelError(
                f"node {label} has no drilling rotation to constrain; use OPT or Q4D there", where
            )
        return int(self.start[node]) + dof

    def _equation(self, item: Equation) -> LinearRelation:
        total: dict[int, float] = {}
        for node, dof, coefficient in item.terms:
            number = self._dof(int(node), int(dof), item.where)
            total[number] = total.get(number, 0.0) + coefficient
        dependent, *masters = total
        pivot = total[dependent]
        row = np.array([-total[m] / pivot for m in masters])
        return LinearRelation(
            np.array([dependent]),
            np.array(masters, np.int64),
            f"the equation for {self.name(dependent)}",
            item.where,
            row,
            item.rhs / pivot,
            np.array([self._component(d) == 2 for d in total]),
        )

    def _axes_of(self, node: int) -> Floats:
        return self.axes.get(int(node), np.eye(2))

    def _measured(self, nodes: Ints, dofs: tuple[int, ...]) -> tuple[Ints, Ints, Floats]:
        """Existing dofs of the nodes of a list: numbers, nodes, components."""
        numbers, owners, axis = [], [], []
        for node in nodes.tolist():
            for dof in sorted(set(dofs)):
                if dof >= self.start[node + 1] - self.start[node]:
                    continue
                numbers.append(int(self.start[node]) + dof)
                owners.append(node)
                along = [0.0, 0.0, 1.0] if dof == 2 else [*self._axes_of(node)[:, dof], 0.0]
                axis.append(along)
        return (
            np.array(numbers, np.int64),
            np.array(owners, np.int64),
            np.array(axis, float).reshape(-1, 3),
        )

    def _described(self, item: Coupling) -> str:
        label = self.model.mesh.node_labels[item.reference]
        return f"the {item.name or item.kind + ' coupling'} with reference node {label}"

    def _members(self, item: Coupling) -> Ints:
        every: Ints = distinct(nodes_of(self.model.mesh, item.nodes))
        nodes: Ints = every[every != item.reference]
        if not len(nodes):
            raise ModelError(
                f"{self._described(item)} has no nodes besides its reference node", item.where
            )
        return nodes

    def _straight(self, item: StraightLine) -> list[OnLine]:
        points, labels = self.model.mesh.points, self.model.mesh.node_labels
        ends = np.array([item.first, item.last])
        for end in ends.tolist():
            self._dof(end, 0, item.where)
        what = f"the straight line through nodes {labels[ends[0]]} and {labels[ends[1]]}"
        along = points[item.last] - points[item.first]
        length = float(np.hypot(*along))
        if not length > 0.0:
            raise ModelError(f"{what} has no direction: they have the same position", item.where)
        nodes = distinct(nodes_of(self.model.mesh, item.nodes))
        nodes = nodes[~np.isin(nodes, ends)]
        if not len(nodes):
            raise ModelError(f"{what} has no other nodes", item.where)
        across = np.array([-along[1], along[0]]) / length
        out = []
        for node in nodes.tolist():
            off = abs(float((points[node] - points[item.first]) @ across))
            if off > OFF_LINE * length:
                raise ModelError(
                    f"node {labels[node]} is {off:.3g} away from {what}; a constraint cannot move "
                    "it there: place it on the line",
                    item.where,
                )
            axes = self._axes_of(node)
            bound = int(np.abs(axes.T @ across).argmax())
            first = self._dof(node, 0, item.where)
            masters = [first + 1 - bound, *(int(self.start[e]) + k for e in ends for k in (0, 1))]
            out.append(
                OnLine(
                    np.array([first + bound]),
                    np.array(masters, np.int64),
                    what,
                    item.where,
                    points[[node, *ends]],
                    axes[:, 1 - bound],
                    axes[:, bound],
                    np.array([self._axes_of(int(e)) for e in ends]),
                )
            )
        return out

    def _follow(self, item: Coupling) -> Follow:
        nodes, points = self._members(item), self.model.mesh.points
        dependent, owners, axis = self._measured(nodes, item.dofs)
        base = int(self.start[item.reference])
        return Follow(
            dependent,
            base + np.arange(3),
            self._described(item),
            item.where,
            points[owners] - points[item.reference],
            axis,
            self._axes_of(item.reference),
        )

    def _mean(self, item: Coupling) -> Mean:
        given, points = nodes_of(self.model.mesh, item.nodes), self.model.mesh.points
        nodes = self._members(item)
        weight = np.ones(len(nodes))
        if item.weights is not None:
            if len(item.weights) != len(given):
                raise ModelError(
                    f"{self._described(item)} has {len(item.weights)} weights for "
                    f"{len(given)} nodes",
                    item.where,
                )
            weight = np.array([item.weights[given == n].sum() for n in nodes])
        weight = weight / weight.sum()
        dependent, _, axis = self._measured(np.array([item.reference]), item.dofs)
        mean = weight @ points[nodes]
        arm = points[nodes] - mean
        if not np.any(weight @ arm**2 > 0.0):
            raise ModelError(
                f"{self._described(item)} needs nodes at two positions or more to define a "
                "rotation",
                item.where,
            )
        masters = (self.start[nodes][:, None] + np.arange(2)).ravel()
        return Mean(
            dependent,
            masters,
            self._described(item),
            item.where,
            arm,
            weight,
            points[item.reference] - mean,
            axis,
            np.array([self._axes_of(int(n)) for n in nodes]),
        )


def _said(relation: Relation) -> str:
    place = f" ({relation.where})" if relation.where is not None else ""
    return relation.what + place

"""Forces of distributed loads at a displacement, and their derivatives.

A load is linear in its scale. Without nlgeom it acts on the reference; with it, on the current
shape: a pressure follows its edge, a centrifugal force grows with the distance from the axis,
and the end moments of drilling elements rotate with their edges. What does not depend on the
displacement is computed once.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from corota.errors import InputError, ModelError
from corota.mesh import selection
from corota.mesh.shape_functions import edge_functions
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    import corota._core as _core
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints
    from corota.model.loads import BodyForce

    Triplets = tuple[Ints, Ints, Floats]
    #: Size of a load on edges: a pressure, or the components of a traction.
    Scale = TypeVar("Scale", float, tuple[float, float])
    #: Force by node, and rows, columns and values of its derivative.
    CoreForce = tuple[Floats, NDArray[np.uint32], NDArray[np.uint32], Floats]

#: Empty tangent and empty start: two arrays, because the core borrows both at once.
EMPTY, END_POINT = np.zeros(0), np.zeros(0)
#: Mass for gravity and spin in static steps.
STATIC_MASS = "consistent"


@dataclass
class LoadSum:
    """Sum of distributed loads.

    Parameters
    ----------
    force : ndarray, shape (n_dofs,)
        Along the axes of the nodes.
    values : ndarray, shape (nnz,) or (0,)
        Upper triangle of a tangent; the symmetric load stiffness is taken from it.
    share : float
        Factor of all derivatives.
    start : ndarray, shape (n_dofs,) or (0,)
        Displacement at the start of a mid-point increment: loads are then those in between.
    """

    force: Floats
    values: Floats
    share: float = 1.0
    start: Floats = field(default_factory=lambda: END_POINT)
    entries: list[Triplets] = field(default_factory=list)

    def middle(self, u: Floats) -> Floats:
        """Displacement at which loads without a closed-form mean are evaluated."""
        return 0.5 * (self.start + u) if len(self.start) else u

    @property
    def triplets(self) -> Triplets | None:
        """The rest of the derivative of the force: rows, columns and values."""
        if not self.entries:
            return None
        rows, columns, values = (np.concatenate(part) for part in zip(*self.entries, strict=True))
        return rows, columns, self.share * values


class Distribution(ABC):
    """A distributed load without its history."""

    #: Whether its force depends on the displacement.
    follows = True
    _unit: Floats | None = None

    def unit(self) -> Floats:
        """Force of unit scale on the reference, shape (n_dofs,)."""
        if self._unit is None:
            self._unit = self._reference()
        return self._unit

    @abstractmethod
    def _reference(self) -> Floats:
        """What `unit` keeps."""

    @abstractmethod
    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        """Add force and derivative at a displacement."""

    def set_mass(self, kind: str) -> None:
        """Use the inertial mass for gravity."""
        return


class BodyLoad(Distribution):
    """Gravity or centrifugal force of some elements."""

    def __init__(self, system: NumberedModel, item: BodyForce, mass: str) -> None:
        self.system, self.item, self.mass = system, item, mass
        mesh = system.model.mesh
        inside = np.ones(mesh.n_cells, bool)
        if not isinstance(item.cells, str):
            inside[:] = False
            if item.masses is None or len(item.cells):
                inside[selection.indices(item.cells, "cell", mesh.n_cells, item.where)] = True
        elif item.cells not in ("", "all"):
            try:
                name = mesh.set_name(item.cells, "cell")
            except InputError as error:
                raise ModelError(error.message, item.where) from None
            inside[:] = False
            inside[mesh.cell_sets[name]] = True
        #: Cells that it acts on, shape (n_cells,).
        self.inside = inside
        self.masks = [inside[b.cells] for b in system.own_blocks]
        self.inertial = item.kind in ("gravity", "centrifugal")
        sized = any(item.value[: 1 if item.kind == "centrifugal" else 2])
        for block in system.blocks:
            if not inside[block.cells].any() or elements.find(block.section.element).spring:
                continue
            if self.inertial and sized and block.section.material.rho <= 0.0:
                name = block.section.material.name or block.section.material.law
                raise ModelError(
                    f"material {name!r} has no density for a body force; add one (*DENSITY)",
                    item.where,
                )
            if item.kind == "centrifugal" and system.axisymmetric != block.section.axisymmetric:
                raise ModelError(
                    "the centrifugal load of an axisymmetric model acts about its axis, on rings; "
                    "on a section in the plane it would act about a point",
                    item.where,
                )
            if item.kind == "line" and not elements.find(block.section.element).line:
                label = mesh.cell_labels[block.cells[inside[block.cells]][0]]
                raise ModelError(
                    "a force per length acts on beams and trusses; element "
                    f"{label} is none: give a force per volume, or loads on edges",
                    item.where,
                )
        facts = [elements.find(b.section.element) for b in system.own_blocks]
        drilling = [
            f.dofs_per_node == 3 and not f.spring and mask.any()
            for f, mask in zip(facts, self.masks, strict=True)
        ]
        #: Elements whose force follows their rotation: sides of drilling elements and beams
        #: deflect by the rotations of their ends.
        self.nlgeom = [
            mask if turns else np.zeros_like(mask)
            for mask, turns in zip(self.masks, drilling, strict=True)
        ]
        #: Mass of the point masses that the load acts on, by dof.
        self.points = np.zeros(system.n_dofs)
        for point, nodes in item.point_masses(mesh, system.model.point_masses):
            for dof in (0, 1):
                np.add.at(self.points, system.attached_dofs(nodes, dof, "point mass"), point.mass)
        if item.kind == "centrifugal" and system.axisymmetric:
            self.points[system.component == 1] = 0.0  # the axis of the model, not z
        self.turns = system.communicator.any(any(drilling))
        self.follows = item.kind == "centrifugal" or self.turns
        self._linear: tuple[Floats, Floats] | None = None

    def set_mass(self, kind: str) -> None:
        self.mass, self._unit, self._linear = kind, None, None

    def _reference(self) -> Floats:
        return self.system.at_nodes(self._at_rest(self.masks, EMPTY))

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        system = self.system
        here, before = (
            np.ascontiguousarray(system.in_space(x)) if len(x) else x for x in (u, to.start)
        )
        force, stiffness = self._where_linear()
        force = scale * force
        if len(stiffness):
            force += scale * system.pattern.multiply(
                stiffness, 0.5 * (before + here) if len(before) else here
            )
            if len(to.values):
                to.values -= (scale * to.share) * stiffness
        if self._couples:
            self._evaluate(self.nlgeom, scale, here, before, -to.share, force, to.values)
        to.force += system.at_nodes(force)

    @property
    def _couples(self) -> bool:
        """Whether the force on some elements is a nonlinear function of the displacement."""
        return self.turns and (self.mass == "consistent" or not self.inertial)

    def _where_linear(self) -> tuple[Floats, Floats]:
        """Unit force on the reference, and its derivative (upper triangle; (0,) for none).

        Of the elements where the force is linear in the displacement, so both hold everywhere:
        a spin acts on a constant mass. In global axes.
        """
        if self._linear is None:
            masks = self.masks
            if self._couples:
                masks = [m & ~t for m, t in zip(masks, self.nlgeom, strict=True)]
            spins = self.system.communicator.any(
                self.item.kind == "centrifugal"
                and (any(m.any() for m in masks) or bool(self.points.any()))
            )
            stiffness = self.system.pattern.zeros() if spins else EMPTY
            self._linear = self._at_rest(masks, stiffness), stiffness
        return self._linear

    def _by_area(self, masks: list[Bools]) -> list[tuple[float, list[Bools]]]:
        """Volume per length of lines, inverted, with the elements that have it."""
        areas = np.array([block.section.profile[0] for block in self.system.own_blocks])
        return [
            (1.0 / area, [m & (a == area) for m, a in zip(masks, areas, strict=True)])
            for area in np.unique(areas[areas > 0.0]).tolist()
        ]

    def _at_rest(self, masks: list[Bools], values: Floats) -> Floats:
        """Unit force on the reference in global axes; adds its derivative to `values`."""
        system, item = self.system, self.item
        force = np.zeros(system.n_dofs)
        self._evaluate(masks, 1.0, np.zeros_like(force), END_POINT, 1.0, force, values)
        if self.points.any():
            pull = np.zeros((system.model.mesh.n_nodes, 3))
            if item.kind == "gravity":
                pull[:, :2] = item.value[:2]
            else:
                square, *center = item.value
                pull[:, :2] = square * (system.model.mesh.points - center)
                if len(values):
                    system.pattern.add_diagonal(values, square * self.points)
            force += self.points * pull[system.node_of_dof, system.component]
        return force

    def _evaluate(
        self,
        masks: list[Bools],
        scale: float,
        u: Floats,
        start: Floats,
        share: float,
        force: Floats,
        values: Floats,
    ) -> None:
        """Add force and derivative (times `share`) of the core; in global axes."""
        # Of a centrifugal force the scale is that of the square of the angular velocity.
        item, first = self.item, 1 if self.item.kind == "centrifugal" else 2
        value = [scale * v for v in item.value[:first]] + list(item.value[first:])
        kind = item.kind if self.inertial else "gravity"
        mass = self.mass if self.inertial else ""
        communicator = self.system.communicator
        own = force if communicator.size == 1 else np.zeros_like(force)
        for share_of, some in self._by_area(masks) if item.kind == "line" else ((1.0, masks),):
            given = [share_of * v for v in value]
            self.system.core.body_force(kind, given, mass, some, u, start, share, own, values)
        if own is not force:
            force += communicator.sum(own)


class Traction(Distribution):
    """A dead traction; on drilling elements its end moments rotate with the edges."""

    def __init__(
        self,
        system: NumberedModel,
        edges: _core.EdgeLoads,
        drilling: bool,
        value: tuple[float, float],
    ) -> None:
        self.system, self.edges, self.value = system, edges, value
        self.follows = drilling
        self._places: tuple[Ints, Ints] | None = None

    def _reference(self) -> Floats:
        return self._evaluate(1.0, None)[0]

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        force, (rows, columns, values) = self._evaluate(scale, to.middle(u))
        to.force += force
        if not len(to.values):
            return
        # Symmetric, between nodes of one element: the pattern contains it.
        if self._places is None:
            upper = np.flatnonzero(rows <= columns)
            places, _, mine = self.system.pattern.owned_places(rows[upper], columns[upper])
            self._places = (upper[mine], places[mine])
        upper, at = self._places
        np.add.at(to.values, at, -to.share * values[upper])

    def _evaluate(self, scale: float, u: Floats | None) -> tuple[Floats, Triplets]:
        t = (scale * self.value[0], scale * self.value[1])
        return evaluate(self.system, self.edges.traction, u, t)


class Pressure(Distribution):
    """A pressure that follows its edges; the scale is its size."""

    def __init__(self, system: NumberedModel, edges: _core.EdgeLoads) -> None:
        self.system, self.edges = system, edges

    def _reference(self) -> Floats:
        return evaluate(self.system, self.edges.pressure, None, 1.0)[0]

    def add(self, scale: float, u: Floats, to: LoadSum) -> None:
        force, entries = evaluate(self.system, self.edges.pressure, to.middle(u), scale)
        to.force += force
        to.entries.append(entries)


def hydrostatic_thickness(
    points: Floats, nodes: Ints, thickness: Floats, level: float, height: float
) -> Floats:
    """Thickness times the share of a hydrostatic pressure, projected onto the shape functions.

    With it the forces on the nodes of undeformed edges are the exact ones.

    Parameters
    ----------
    points : ndarray, shape (n_nodes, 2)
    nodes : ndarray of int, shape (n, 3)
        The third is the first on straight edges.
    thickness : ndarray, shape (n, 3)
    level, height : float
        y where the pressure is zero and where it is one [length].

    Returns
    -------
    ndarray, shape (n, 3)
    """
    out = np.zeros_like(thickness)
    for i, ends in enumerate(nodes):
        count = 2 if ends[2] == ends[0] else 3
        r, weight = _points_of_edge(points[ends[:count], 1] - level)
        n = np.ascontiguousarray(edge_functions(r, count == 3)[0][:, :count])
        share = np.maximum((n @ points[ends[:count], 1] - level) / (height - level), 0.0)
        load = n.T @ (weight * share * (n @ thickness[i, :count]))
        out[i, :count] = np.linalg.solve(n.T @ (weight[:, None] * n), load)
    return out


def _points_of_edge(depth: Floats) -> tuple[Floats, Floats]:
    """Quadrature points of an edge on both sides of the place where the depth vanishes."""
    t, w = np.polynomial.legendre.leggauss(4)
    polynomial = [0.5 * (depth[1] - depth[0]), 0.5 * (depth[0] + depth[1])]
    if len(depth) == 3:
        bend = 0.5 * (depth[0] + depth[1]) - depth[2]
        polynomial = [bend, polynomial[0], depth[2]]
    zeros = np.roots(polynomial) if np.any(polynomial[:-1]) else np.zeros(0)
    inside = np.sort(zeros.real[(zeros.imag == 0.0) & (np.abs(zeros.real) < 1.0)])
    ends = np.concatenate([[-1.0], inside, [1.0]])
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    return (middle[:, None] + half[:, None] * t).ravel(), (half[:, None] * w).ravel()


def evaluate(
    system: NumberedModel,
    load: Callable[[Floats, int, Scale], CoreForce],
    u: Floats | None,
    value: Scale,
) -> tuple[Floats, Triplets]:
    """Force of loaded edges along the nodes' axes, and its derivative in global axes.

    On the reference, without a derivative, where `u` is None.
    """
    n_nodes = len(system.model.mesh.points)
    moved = np.zeros((0, 3)) if u is None else system.by_node(u)
    force, rows, columns, values = load(moved, n_nodes, value)
    start = system.start
    i, j = start[rows // 3] + rows % 3, start[columns // 3] + columns % 3
    return system.from_nodes(force), (i, j, values)

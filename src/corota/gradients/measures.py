"""Measures of states: a number, and its derivatives by displacements, reactions and histories."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError, UnsupportedError
from corota.gradients.separate import Separate, fields_of
from corota.model.dofs import dof_index

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Bools, Floats, Ints
    from corota.gradients.trajectory import Point, Trajectory
    from corota.results.results import Results

    Where = str | int | ArrayLike


class Measure(ABC):
    """A smooth number of a state. Measures add, subtract, multiply, divide, and take powers."""

    #: Index of its frame.
    frame: int = -1
    #: Whether it depends on parameters through the state alone.
    state_only = False

    @abstractmethod
    def value(self, point: Point) -> float:
        """Value at a state."""

    def direct(self, point: Point) -> float:
        """Value at a varied state, without the part that :meth:`by_reaction` weighs."""
        return self.value(point)

    def by_displacement(self, point: Point) -> Floats:
        """Derivative by displacements, without that part, shape (n_dofs,)."""
        return np.zeros(point.system.n_dofs)

    def by_reaction(self, point: Point) -> Floats:
        """Derivative by the reactions of prescribed dofs, shape (n_dofs,)."""
        return np.zeros(point.system.n_dofs)

    def by_velocity(self, point: Point) -> Floats:
        """Derivative by velocities in a dynamic step, shape (n_dofs,)."""
        return np.zeros(point.system.n_dofs)

    def by_factor(self, point: Point) -> float:
        """Derivative by the load factor, of measures that contain it."""
        return 0.0

    def by_histories(self, point: Point) -> list[Floats] | None:
        """Derivative by the histories before the increment; None where it has none."""
        return None

    # -- arithmetic --------------------------------------------------------------------

    def _with(self, other: Any, of: Callable[[float, float], float], by: Any) -> Combination:
        parts: list[Measure] = [self]
        if isinstance(other, Measure):
            parts.append(other)
            return Combination(parts, lambda v: of(v[0], v[1]), lambda v: by(v[0], v[1]))
        b = float(other)
        return Combination(parts, lambda v: of(v[0], b), lambda v: by(v[0], b)[:1])

    def __add__(self, other: Measure | float) -> Combination:
        return self._with(other, lambda a, b: a + b, lambda a, b: (1.0, 1.0))

    def __radd__(self, other: float) -> Combination:
        return self + other

    def __sub__(self, other: Measure | float) -> Combination:
        return self._with(other, lambda a, b: a - b, lambda a, b: (1.0, -1.0))

    def __rsub__(self, other: float) -> Combination:
        return -self + other

    def __mul__(self, other: Measure | float) -> Combination:
        return self._with(other, lambda a, b: a * b, lambda a, b: (b, a))

    def __rmul__(self, other: float) -> Combination:
        return self * other

    def __truediv__(self, other: Measure | float) -> Combination:
        return self._with(other, lambda a, b: a / b, lambda a, b: (1.0 / b, -a / b**2))

    def __rtruediv__(self, other: float) -> Combination:
        return self**-1.0 * other

    def __pow__(self, power: float) -> Combination:
        return self._with(power, lambda a, b: a**b, lambda a, b: (b * a ** (b - 1.0),))

    def __neg__(self) -> Combination:
        return self * -1.0


class SpecialMeasure(Measure):
    """A measure that finds its adjoint state itself."""

    @abstractmethod
    def prepare(self, results: Results) -> None:
        """Take what it needs of a run, its frame included."""

    @abstractmethod
    def adjoint(self, trajectory: Trajectory, point: Point) -> Floats:
        """Weights of the residual, shape (n_dofs,). It may improve the state."""

    def vanishing(self, point: Point) -> Floats | None:
        """Weights of a residual that must not depend on a parameter; None for none."""
        return None


class Combination(Measure):
    """A function of other measures.

    Parameters
    ----------
    parts : sequence of Measure
    function : callable
        Its value from those of the parts.
    partials : callable
        Its derivatives by them.

    Examples
    --------
    >>> from corota import gradients
    >>> stiffness = gradients.Reaction("top", "y") / gradients.Displacement("top", "y")
    >>> len(stiffness.parts)
    2
    """

    def __init__(
        self,
        parts: Sequence[Measure],
        function: Callable[[list[float]], float],
        partials: Callable[[list[float]], Sequence[float]],
    ) -> None:
        self.parts, self.function, self.partials = list(parts), function, partials

    def value(self, point: Point) -> float:
        return self.function([part.value(point) for part in self.parts])


def leaves(measure: Measure) -> list[Measure]:
    """The measures that a measure is made of, itself if it is simple."""
    if isinstance(measure, Combination):
        return [leaf for part in measure.parts for leaf in leaves(part)]
    return [measure]


def combine(measure: Measure, values: dict[int, float], rows: dict[int, Any]) -> tuple[float, Any]:
    """Value and derivatives of a measure from those of its leaves, by their identity."""
    if not isinstance(measure, Combination):
        return values[id(measure)], rows[id(measure)]
    found = [combine(part, values, rows) for part in measure.parts]
    own = [value for value, _ in found]
    partials = measure.partials(own)
    total = sum(p * row for p, (_, row) in zip(partials, found, strict=True))
    return measure.function(own), total


def _nodes(point: Point, where: Where) -> Ints:
    mesh = point.system.model.mesh
    nodes = mesh.node_indices(where)
    if not len(nodes):
        raise InputError(f"{where!r} has no nodes")
    return np.asarray(nodes, np.int64)


def _mean(point: Point, where: Where, dof: str | int, mean: bool) -> Floats:
    """Weights by dof of a mean or a sum over nodes, along the axes of the nodes."""
    by_node = np.zeros((point.system.model.mesh.n_nodes, 3))
    nodes, component = _nodes(point, where), dof_index(dof)
    by_node[nodes, component] = 1.0 / len(nodes) if mean else 1.0
    if (point.system.dofs(nodes, component) < 0).any():
        raise InputError(f"a node of {where!r} has no dof {dof!r}")
    return point.system.from_nodes(by_node)


@dataclass
class Displacement(Measure):
    """Mean displacement or rotation of nodes in global axes [length or rad].

    Parameters
    ----------
    where : str, int or array_like of int
        Set, selection, node index or indices.
    dof : {"x", "y", "rotation"}
    frame : int
    """

    where: Where
    dof: str | int
    frame: int = -1
    state_only = True

    def value(self, point: Point) -> float:
        return float(self.by_displacement(point) @ point.u)

    def by_displacement(self, point: Point) -> Floats:
        return _mean(point, self.where, self.dof, mean=True)


@dataclass
class Velocity(Measure):
    """Mean velocity of nodes in global axes, in a dynamic step [length/time or rad/time].

    Parameters
    ----------
    where : str, int or array_like of int
    dof : {"x", "y", "rotation"}
    frame : int
    """

    where: Where
    dof: str | int
    frame: int = -1
    state_only = True

    def value(self, point: Point) -> float:
        """Value at a state.

        Raises
        ------
        InputError
            If its frame is not of a dynamic step.
        """
        if not len(point.v):
            raise InputError(f"{self!r}: a velocity belongs to a dynamic step")
        return float(self.by_velocity(point) @ point.v)

    def by_velocity(self, point: Point) -> Floats:
        return _mean(point, self.where, self.dof, mean=True)


@dataclass
class Reaction(Measure):
    """Sum of the reactions of supported nodes in global axes [force or moment].

    Parameters
    ----------
    where : str, int or array_like of int
    dof : {"x", "y", "rotation"}
    frame : int
    """

    where: Where
    dof: str | int
    frame: int = -1
    state_only = True

    def value(self, point: Point) -> float:
        return float(self.by_reaction(point) @ point.reaction)

    def direct(self, point: Point) -> float:
        """Zero: parameters act on it through the reaction alone."""
        return 0.0

    def by_reaction(self, point: Point) -> Floats:
        """The weights of the dofs.

        Raises
        ------
        InputError
            If a dof is not supported.
        """
        weights = _mean(point, self.where, self.dof, mean=False)
        free = (weights != 0.0) & ~point.system.conditions.constrained
        if free.any():
            dof = int(np.flatnonzero(free)[0])
            raise InputError(f"{point.system.describe(dof)} is not supported and has no reaction")
        return weights


@dataclass
class LoadFactor(Measure):
    """Load factor of a state on a path.

    At the end of a step with displacement control it is that at a fixed displacement.

    Parameters
    ----------
    frame : int
    """

    frame: int = -1
    state_only = True

    def value(self, point: Point) -> float:
        return point.increment.factor

    def direct(self, point: Point) -> float:
        """Nothing: it depends on no parameter at a fixed state."""
        return 0.0

    def by_factor(self, point: Point) -> float:
        return 1.0


@dataclass
class StrainEnergy(Measure):
    """Recoverable energy of all elements [force*length].

    Parameters
    ----------
    frame : int
    """

    frame: int = -1

    def value(self, point: Point) -> float:
        here = point.system.in_space(point.u)
        return float(sum(b["total_energy"] for b in fields_of(point.system.core, here, point)))

    def by_displacement(self, point: Point) -> Floats:
        """The internal force of the elements.

        Raises
        ------
        UnsupportedError
            If a material remembers: its work is not all recoverable.
        """
        system = point.system
        if any(block.section.material.remembers for block in system.blocks):
            raise UnsupportedError(
                "the strain energy of materials with history has no gradient: part of the work "
                "is lost"
            )
        force, scale = np.zeros(system.n_dofs), np.zeros(system.n_dofs)
        system.core.assemble(system.in_space(point.u), system.nlgeom, force, scale, np.empty(0))
        return system.at_nodes(force)


@dataclass
class Mass(Measure):
    """Mass of the elements in a set, or of all.

    Parameters
    ----------
    cells : str or array_like of int, optional
    """

    cells: Where | None = None
    frame: int = -1

    def value(self, point: Point) -> float:
        return _volume(point, self.cells, weighed=True)


@dataclass
class Area(Measure):
    """Reference area of the elements in a set, or of all [length^2]; line elements have none.

    Solids of revolution are refused: their volume is that of the circumference.

    Parameters
    ----------
    cells : str or array_like of int, optional
    """

    cells: Where | None = None
    frame: int = -1

    def value(self, point: Point) -> float:
        return _volume(point, self.cells, weighed=False)


@dataclass
class Width(Measure):
    """Least distance of two boundaries in the reference shape [length], as a bound of a member.

    ``(sum d^-p)^(-1/p)`` over the distances d of the nodes of both: smooth, and never above the
    least of them, to which it rises with p.

    Parameters
    ----------
    one, other : str
        Edge sets.
    p : float
    """

    one: str
    other: str
    p: float = 24.0
    frame: int = -1

    def value(self, point: Point) -> float:
        mesh = point.system.model.mesh
        found, edges = [], {}
        for name in (self.one, self.other):
            if name not in mesh.edge_sets:
                raise InputError(f"{self!r}: no edge set named {name!r}")
            edges[name] = mesh.edge_nodes(mesh.edge_sets[name])
        for here, there in ((self.one, self.other), (self.other, self.one)):
            at = mesh.points[np.unique(np.concatenate(edges[here]))]
            ends = np.stack([e[:2] for e in edges[there]])
            a, step = mesh.points[ends[:, 0]], np.diff(mesh.points[ends], axis=1)[:, 0]
            offset = at[:, None] - a
            share = np.clip((offset * step).sum(axis=2) / (step**2).sum(axis=1), 0.0, 1.0)
            far = np.linalg.norm(offset - share[..., None] * step, axis=2)
            found.append(far.min(axis=1))
        distance = np.concatenate(found)
        least = float(distance.min())
        if not least > 0.0:
            raise InputError(f"{self!r}: the boundaries touch")
        return float(least * ((least / distance) ** self.p).sum() ** (-1.0 / self.p))


def _volume(point: Point, cells: Where | None, weighed: bool) -> float:
    from corota.model import elements

    system, total, heavy = point.system, 0.0, False
    wanted = _cells(point, cells)
    fields = fields_of(system.core, system.in_space(point.u), point)
    for block, own in zip(system.blocks, fields, strict=True):
        inside = wanted[block.cells]
        volume = own["volume"][inside]
        if weighed:
            heavy = heavy or block.section.material.rho > 0.0
            total += block.section.material.rho * float(volume.sum())
        elif block.section.axisymmetric:
            raise UnsupportedError(
                "the area of a solid of revolution is no measure with a gradient: take Mass"
            )
        elif not elements.find(block.section.element).line:
            thickness = np.full(volume.shape, float(block.section.thickness))
            if block.section.nodal_thickness is not None:
                nodal = block.section.thickness_at(block.nodes, system.model.mesh.points)
                thickness = (nodal @ own["shape"].T)[inside]
            total += float((volume / thickness).sum())
    if weighed and not heavy:
        raise InputError("no material of these elements has a density: give rho=, or take Area")
    return total


def _cells(point: Point, cells: Where | None) -> Bools:
    mesh = point.system.model.mesh
    wanted = np.zeros(mesh.n_cells, bool)
    if cells is None or (isinstance(cells, str) and cells == "all"):
        wanted[:] = True
    elif isinstance(cells, str):
        if cells not in mesh.cell_sets:
            raise InputError(f"no element set named {cells!r}")
        wanted[mesh.cell_sets[cells]] = True
    else:
        wanted[np.asarray(cells, np.int64)] = True
    return wanted


@dataclass
class Stress(Measure):
    """A norm of a stress at the points of elements [stress].

    The p-norm weighs points by their volume, so that it does not depend on the mesh; it rises with
    p towards the largest value. With ``p=1`` and one element it is its mean.

    Parameters
    ----------
    cells : str or array_like of int, optional
        All by default.
    variable : str
        ``MISES``, or ``S11``, ``S22``, ``S33``, ``S12``.
    p : float
        Of components that may be negative ``p=1`` only.
    frame : int
    """

    cells: Where | None = None
    variable: str = "MISES"
    p: float = 8.0
    frame: int = -1

    def __post_init__(self) -> None:
        components = {"S11": 0, "S22": 1, "S33": 2, "S12": 3}
        if self.variable != "MISES" and self.variable not in components:
            raise InputError(f"no stress {self.variable!r}; there are MISES, S11, S22, S33, S12")
        if self.variable != "MISES" and self.p != 1.0:
            raise InputError(f"a norm of {self.variable}, which may be negative, takes p=1")
        if not self.p >= 1.0:
            raise InputError(f"the power p must be at least 1, not {self.p}")
        self._component = components.get(self.variable)

    def value(self, point: Point) -> float:
        system = point.system
        fields = fields_of(system.core, system.in_space(point.u), point)
        wanted = _cells(point, self.cells)
        pairs = []
        for block, own in zip(system.blocks, fields, strict=True):
            inside = wanted[block.cells]
            pairs.append((self._of(own)[inside].ravel(), own["volume"][inside].ravel()))
        size, volume = (np.concatenate(each) for each in zip(*pairs, strict=True))
        return self._norm(size, volume)

    def by_displacement(self, point: Point) -> Floats:
        return self._differentiate(point, histories=False)[0]

    def by_histories(self, point: Point) -> list[Floats] | None:
        if not any(len(h) for h in point.system.core.histories(False)):
            return None
        return self._differentiate(point, histories=True)[1]

    def _differentiate(self, point: Point, histories: bool) -> tuple[Floats, list[Floats]]:
        system = point.system
        here, wanted = system.in_space(point.u), _cells(point, self.cells)
        fields = fields_of(system.core, here, point)
        parts = [
            (self._of(own)[wanted[block.cells]], own["volume"][wanted[block.cells]])
            for block, own in zip(system.blocks, fields, strict=True)
        ]
        slopes = [
            self._by_stress(own["values"]["S"][wanted[block.cells]])
            for block, own in zip(system.blocks, fields, strict=True)
        ]
        size = np.concatenate([s.ravel() for s, _ in parts])
        volume = np.concatenate([v.ravel() for _, v in parts])
        slope = self._slope(size, volume)
        out = np.zeros(system.n_dofs)
        known = system.core.histories(False)
        by_history = [np.zeros(len(h)) for h in known]
        start = 0
        each = zip(system.blocks, parts, slopes, strict=True)
        for index, (block, (own, _), by_stress) in enumerate(each):
            weights = slope[start : start + own.size].reshape(own.shape)
            start += own.size
            rows = np.flatnonzero(wanted[block.cells])
            if not len(rows):
                continue
            separate = Separate(system, index, rows, here)
            of = self._weighted(weights[..., None] * by_stress)
            separate.by_displacement(of, out)
            if histories and len(known[index]):
                separate.by_history(of, by_history[index])
        return system.at_nodes(out), by_history

    def _weighted(self, weights: Floats) -> Callable[[dict[str, Any]], Floats]:
        return lambda own: (weights * own["values"]["S"]).sum(axis=(1, 2))

    def _by_stress(self, stress: Floats) -> Floats:
        """Derivative of the variable by the components, which are smooth where it is zero, too."""
        if self._component is not None:
            one: Floats = np.eye(4)[self._component] + np.zeros_like(stress)
            return one
        mean = stress[..., :3].mean(axis=-1, keepdims=True)
        out: Floats = 1.5 * (stress - mean * np.array([1.0, 1.0, 1.0, 0.0]))
        out[..., 3] *= 2.0
        size = np.sqrt((out[..., :3] ** 2).sum(axis=-1) / 1.5 + out[..., 3] ** 2 / 3.0)
        out /= np.where(size > 0.0, size, 1.0)[..., None]
        return out

    def _of(self, own: dict[str, Any]) -> Floats:
        values: Floats = own["values"]["MISES"]
        if self._component is not None:
            values = own["values"]["S"][..., self._component]
        return values

    def _norm(self, size: Floats, volume: Floats) -> float:
        share = volume / volume.sum()
        if self.p == 1.0:
            return float(share @ size)
        most = float(size.max(initial=0.0)) or 1.0
        return float(most * float(share @ (size / most) ** self.p) ** (1.0 / self.p))

    def _slope(self, size: Floats, volume: Floats) -> Floats:
        share: Floats = volume / volume.sum()
        if self.p == 1.0:
            return share
        norm = self._norm(size, volume) or 1.0
        return share * (size / norm) ** (self.p - 1.0)

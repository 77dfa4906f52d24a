"""Supports, loads, amplitudes and initial velocities as plain data."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location, number
from corota.mesh import selection
from corota.mesh.parts import cells_of, nodes_of_cells
from corota.model.dofs import dof_index
from corota.names import choose_attribute

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.model.attachments import PointMass


@dataclass(repr=False)
class Amplitude(Brief):
    """A table of factor against time, constant outside.

    Parameters
    ----------
    time, value : ndarray, shape (n,)
        Strictly increasing times and the factors there.
    total_time : bool
        Whether ``time`` counts from the start of the analysis, not of the step.
    """

    time: Floats
    value: Floats
    total_time: bool = False
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.time = np.asarray(self.time, dtype=np.float64)
        self.value = np.asarray(self.value, dtype=np.float64)
        if self.time.shape != self.value.shape or self.time.ndim != 1 or self.time.size == 0:
            raise InputError("an amplitude needs as many times as values, at least one", self.where)
        if not (np.isfinite(self.time).all() and np.isfinite(self.value).all()):
            raise InputError("an amplitude must be finite", self.where)
        if (np.diff(self.time) <= 0.0).any():
            at = int(np.flatnonzero(np.diff(self.time) <= 0.0)[0])
            raise InputError(
                f"the times of an amplitude must increase: {self.time[at]:g} is followed by "
                f"{self.time[at + 1]:g}",
                self.where,
            )

    def __call__(self, time: float) -> float:
        """Factor at a time [1]."""
        return float(np.interp(time, self.time, self.value))

    def derivatives(
        self, time: float, window: float, first: float = -np.inf, last: float = np.inf
    ) -> tuple[float, float]:
        """Rate and acceleration of the factor at a time, by differences over a window.

        Both are of second order in the window: central differences, or one-sided ones where
        the window would reach beyond `first` or `last`; these have the error of the central ones
        where the table is smooth. The second difference of a table is the
        sum of the jumps of its slope, each times a hat function of the window's width: exactly
        zero on straight parts, and a pulse of the right area about a kink.

        Parameters
        ----------
        time : float
        window : float
            Half the width [time].
        first, last : float
            Times between which the table is used.

        Returns
        -------
        rate : float [1/time]
        acceleration : float [1/time^2]
        """
        h, slack = window, 1e-6 * window
        if time - h < first - slack or time + h > last + slack:
            sign = 1.0 if time - h < first - slack else -1.0
            near, far = (self._second_difference(time + sign * k * h, h) for k in (1.0, 2.0))
            slope = (self(time + sign * h) - self(time)) / (sign * h)
            inside = sign * (self.kinks() - time)
            broken = np.any((inside > slack) & (inside < 3.0 * h - slack))
            end = 2.0 * near - far
            return slope - 0.5 * sign * h * (near if broken else end), end
        return (self(time + h) - self(time - h)) / (2.0 * h), self._second_difference(time, h)

    def _second_difference(self, time: float, h: float) -> float:
        """Second difference over `h` about a time [1/time^2]."""
        low, high = np.searchsorted(self.time, (time - h, time + h))
        near = np.arange(low, high)
        weight = np.maximum(1.0 - np.abs(self.time[near] - time) / h, 0.0)
        return float(weight @ self._jumps[near]) / h

    @cached_property
    def _jumps(self) -> Floats:
        """Jump of the slope at each time of the table, which is constant outside."""
        slope = np.diff(self.value) / np.diff(self.time)
        return np.diff(slope, prepend=0.0, append=0.0)

    def kinks(self) -> Floats:
        """Times at which the slope jumps, unlike that of a finely sampled smooth function.

        A jump counts that is half of the largest slope, or a tenth of it and three times its
        neighbors.
        """
        size = np.abs(self._jumps)
        steepest = np.abs(np.diff(self.value) / np.diff(self.time)).max(initial=0.0)
        around = np.maximum(np.append(size[1:], 0.0), np.append(0.0, size[:-1]))
        alone = (size > 0.1 * steepest) & (size > 3.0 * around)
        out: Floats = self.time[(size > 0.5 * steepest) | alone]
        return out


def selected(where: object, what: str, source: Location | None) -> str | Ints:
    """Names of sets, or indices that are checked as far as they can be without a mesh.

    Several names stay a tuple until the mesh is known: see :func:`applied`.
    """
    if isinstance(where, str):
        return where
    if several := selection.names(where):
        return several  # type: ignore[return-value]
    if what == "edge":
        return selection.pairs(where, where=source)  # type: ignore[arg-type]
    found = selection.indices(where, what, where=source)  # type: ignore[arg-type]
    mask = np.asarray(where)
    if mask.dtype == np.bool_:
        return mask  # its length is checked with the mesh
    return found


def _amplitude(name: object, where: Location | None) -> str:
    if not isinstance(name, str):
        raise InputError(
            f"an amplitude is named as in Model.amplitudes, not {type(name).__name__}", where
        )
    return name


def finite(value: object, what: str, where: Location | None) -> float | Floats:
    """A finite number or array of them.

    Raises
    ------
    InputError
        If it is not.
    """
    if np.ndim(value) == 0:  # type: ignore[arg-type]
        return number(value, what, where)
    try:
        found = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{what} must be numbers", where) from None
    if not np.isfinite(found).all():
        raise InputError(f"{what} must be finite", where)
    return found


@dataclass(repr=False)
class Fixed(Brief):
    """A prescribed displacement or rotation.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set, node indices, or a mask of nodes.
    dof : {"x", "y", "rotation"} or int
        Kept as 0 and 1 for displacement [length], 2 for the drilling rotation [rad].
    value : float
        Reached at the end of the step, along the amplitude or a ramp.
    amplitude : str
        Name in ``Model.amplitudes``; empty: ramp in static steps.
    keep : bool
        Fix the nodes at their position at the start of the step, whatever `value` is.
    implied : bool
        Whether the method ``fix`` fixed this direction with the other one, which alone was given.
    free : bool
        End the supports of this place and direction.
    """

    nodes: str | Ints
    dof: int
    value: float = 0.0
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)
    keep: bool = False
    implied: bool = field(default=False, compare=False, repr=False)
    free: bool = False

    def __post_init__(self) -> None:
        self.nodes = selected(self.nodes, "node", self.where)
        if isinstance(self.nodes, tuple):
            raise InputError(
                "Fixed takes one set; the method fix of a model or a step takes several", self.where
            )
        self.dof = dof_index(self.dof, self.where)
        self.value = number(self.value, "a prescribed displacement", self.where)
        self.amplitude = _amplitude(self.amplitude, self.where)

    @property
    def place(self) -> str:
        """The set, or the nodes in words."""
        if isinstance(self.nodes, str):
            return repr(self.nodes)
        return (
            f"{len(self.nodes)} nodes from index {self.nodes[0]}" if len(self.nodes) else "no node"
        )

    def same_dofs(self, other: Fixed) -> bool:
        """Whether another support is at the same place in the same direction."""
        return self.dof == other.dof and np.array_equal(self.nodes, other.nodes)


@dataclass(repr=False)
class NodalForce(Brief):
    """A force [force] or drilling moment [force*length] at each node of a set.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set, node indices, or a mask of nodes.
    dof : {"x", "y", "rotation"} or int
        Kept as 0, 1 or 2.
    value : float or ndarray, shape (n,)
        At each node, or one for each of the nodes.
    amplitude : str
        Name in ``Model.amplitudes``; empty: ramp in static steps.
    follower : bool
        Whether a force follows the rotation of its node in geometrically nonlinear steps; it
        is dead otherwise.
    """

    nodes: str | Ints
    dof: int
    value: float | Floats
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)
    follower: bool = False

    def __post_init__(self) -> None:
        self.nodes = selected(self.nodes, "node", self.where)
        self.dof = dof_index(self.dof, self.where)
        self.value = finite(self.value, "a force", self.where)
        self.amplitude = _amplitude(self.amplitude, self.where)
        self.follower = self.follower and self.dof < 2


@dataclass(repr=False)
class Force(Brief):
    """A dead force: a resultant on edges, and per node on nodes.

    The mesh decides which: see :meth:`on`.

    Parameters
    ----------
    at : str, sequence of str or array_like of int
        Edge or node set, several, node indices, or a mask of nodes. A name of both an edge set
        and a node set means the edges.
    x, y : float
        Force [force].
    moment : float
        Drilling moment [force*length].
    spread : {"", "total", "per node"}
        Whether the values are the resultant or apply to each node; by default the resultant on
        edges and per node on nodes.
    amplitude : str
        Name in ``Model.amplitudes``; empty: ramp in static steps.
    """

    at: str | Ints
    x: float = 0.0
    y: float = 0.0
    moment: float = 0.0
    spread: Literal["", "total", "per node"] = ""
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.at = selected(self.at, "node", self.where)
        self.x = number(self.x, "the force x", self.where)
        self.y = number(self.y, "the force y", self.where)
        self.moment = number(self.moment, "the moment", self.where)
        self.amplitude = _amplitude(self.amplitude, self.where)

    def on(self, mesh: Mesh) -> list[NodalForce | EdgeLoad]:
        """The equivalent loads on a mesh.

        A resultant on edges is a traction, and a moment is shared by the nodes as a moment per
        length; a total on nodes is shared equally.

        Parameters
        ----------
        mesh : Mesh

        Raises
        ------
        InputError
            If there is no such set or node.
        """
        at = self.at
        if isinstance(at, tuple):
            names = [mesh.set_name(name) for name in at]
            if self.spread != "per node" and all(name in mesh.edge_sets for name in names):
                return self._on_edges(mesh, mesh.edge_pairs(names))
            at = mesh.node_indices(names)
        if isinstance(at, str):
            at = mesh.set_name(at)
            if at in mesh.edge_sets and self.spread != "per node":
                return self._on_edges(mesh, at)
            if not len(mesh.nodes_of(at)):
                raise InputError(f"node set {at!r} is empty", self.where)
        else:
            mesh.node_indices(at)
        share = 1.0
        if self.spread == "total":
            share = 1.0 / len(mesh.node_indices(at))
        return [
            NodalForce(at, dof, share * value, self.amplitude, self.where)
            for dof, value in enumerate((self.x, self.y, self.moment))
            if value != 0.0
        ]

    def ends(self, mesh: Mesh) -> list[NodalForce | EdgeLoad]:
        """Loads of zero that end the components of an earlier force at the same place.

        A force is one vector: given again, it replaces both components. A moment is another load;
        a force that is zero altogether ends both.

        Parameters
        ----------
        mesh : Mesh
        """
        pushes, turns = self.x != 0.0 or self.y != 0.0, self.moment != 0.0
        probe = replace(self, x=1.0, y=1.0, moment=1.0)
        found: list[NodalForce | EdgeLoad] = []
        for load in probe.on(mesh):
            if isinstance(load, EdgeLoad):
                if not pushes and not turns:
                    found.append(replace(load, value=(0.0, 0.0)))
                continue
            value = (self.x, self.y, self.moment)[load.dof]
            if value == 0.0 and ((pushes or not turns) if load.dof < 2 else (turns or not pushes)):
                found.append(replace(load, value=0.0))
        return found

    def _on_edges(self, mesh: Mesh, name: str | Ints) -> list[NodalForce | EdgeLoad]:
        edges = mesh.edge_pairs(name)
        if not len(edges):
            raise InputError(f"edge set {name!r} is empty", self.where)
        found: list[NodalForce | EdgeLoad] = []
        if self.x != 0.0 or self.y != 0.0:
            value = (self.x, self.y)
            found.append(
                EdgeLoad(name, "traction", value, self.amplitude, total=True, where=self.where)
            )
        if self.moment != 0.0:
            nodes = mesh.edge_set_nodes(edges)
            weight = np.zeros(mesh.n_nodes)
            for ends in mesh.edge_nodes(edges):
                weight[ends[:2]] += 0.5 * np.hypot(*(mesh.points[ends[1]] - mesh.points[ends[0]]))
            shares = self.moment * weight[nodes] / weight.sum()
            taking = shares != 0.0
            found.append(NodalForce(nodes[taking], 2, shares[taking], self.amplitude, self.where))
        return found


#: Kinds of loads on edges.
EDGE_LOADS = (
    *("pressure", "traction", "following traction", "shear", "electrostatic"),
    *("penetrating pressure", "hydrostatic pressure"),
)


@dataclass(repr=False)
class EdgeLoad(Brief):
    """A distributed load on element edges.

    Parameters
    ----------
    edges : str or array_like of int, shape (n, 2)
        Edge set, or pairs of global cell index and local edge (from 0).
    kind : {"pressure", "traction", "following traction", "shear", "electrostatic", \
            "penetrating pressure", "hydrostatic pressure"}
        ``pressure``: normal, positive into the element, follows the deforming edge in
        geometrically nonlinear steps (the thickness stays the undeformed one); ``traction``:
        dead, fixed in space; ``following traction``: the same on the undeformed edge, rotates with
        it and acts on its current length, as a pressure does; ``shear``: along the edge, with the
        element on the left, and follows it; ``electrostatic``: towards an opposite electrode, by
        the current gap; ``penetrating pressure``: a pressure on the edges that a fluid reaches;
        ``hydrostatic pressure``: value ``(p, level, height)``, a pressure that is zero at the
        level and on its far side, p at the height and linear in y, by undeformed heights.
    value : tuple of float
        ``(p,)``, ``(tx, ty)`` or ``(t,)`` [force/length^2]; times thickness and length.
        ``electrostatic``: half the permittivity times the square of the voltage [force], and x, y
        of two points of the opposite electrode, if it is a fixed line [length].
        ``penetrating pressure``: ``(p,)``, or with the critical contact pressure.
    total : bool
        Whether a traction's value is a total force [force], distributed over the edges' area.
    opposite : str or array_like of int, shape (n, 2), optional
        Edges of the opposite electrode, if they can move, or of the other body beside a fluid.
    start : str or array_like of int, optional
        Nodes where a fluid is from the start.
    """

    edges: str | Ints
    kind: Literal[
        "pressure", "traction", "following traction", "shear", "electrostatic",
        "penetrating pressure", "hydrostatic pressure",
    ]  # fmt: skip
    value: tuple[float, ...]
    amplitude: str = ""
    total: bool = False
    where: Location | None = field(default=None, compare=False, repr=False)
    opposite: str | Ints | None = None
    start: str | Ints | None = None

    def __post_init__(self) -> None:
        self.edges = selected(self.edges, "edge", self.where)
        if self.opposite is not None:
            self.opposite = selected(self.opposite, "edge", self.where)
        if self.start is not None:
            self.start = selected(self.start, "node", self.where)
        choose_attribute(self, "kind", EDGE_LOADS, "load on edges", self.where)
        what = "a pressure" if self.kind.endswith("pressure") else "a traction"
        self.value = tuple(number(v, what, self.where) for v in self.value)
        if self.kind == "hydrostatic pressure" and self.value[1] == self.value[2]:
            text = (
                "a hydrostatic pressure needs two heights: that of the level and that of its size"
            )
            raise InputError(text, self.where)
        if self.kind == "penetrating pressure" and min(self.value) < 0.0:
            raise InputError(f"a fluid has pressures >= 0, not {min(self.value):g}", self.where)
        self.amplitude = _amplitude(self.amplitude, self.where)


#: Kinds of loads on cells.
BODY_FORCES = ("gravity", "volume", "line", "centrifugal")


@dataclass(repr=False)
class BodyForce(Brief):
    """A load on the volume of cells.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set ("" for all), or global cell indices.
    kind : {"gravity", "volume", "line", "centrifugal"}
        ``gravity``: value ``(bx, by)`` [length/time^2];
        ``volume``: dead force ``(fx, fy)`` per undeformed volume [force/length^3];
        ``line``: dead force ``(qx, qy)`` per undeformed length of beams and trusses
        [force/length];
        ``centrifugal``: value ``(omega^2, x0, y0)`` [1/time^2, length, length], at current
        positions in geometrically nonlinear steps.
    direction : tuple of float or None
        Of uniform loads, as given: also kept for a negative or zero size.
        That of the value by default.
    every : bool
        Whether a load of zero ends those of every direction, axis and set in its cells. In decks it
        ends that of its set, and direction or axis.
    masses : ndarray of int, optional
        Indices of the model's point masses that gravity and spin act on. By default those at
        nodes of the cells, or all where the load acts on all cells.
    """

    cells: str | Ints
    kind: Literal["gravity", "volume", "line", "centrifugal"]
    value: tuple[float, ...]
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)
    direction: tuple[float, float] | None = None
    masses: Ints | None = None
    every: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        if self.masses is None or len(self.cells):
            self.cells = selected(self.cells, "cell", self.where)
        choose_attribute(self, "kind", BODY_FORCES, "load on cells", self.where)
        self.value = tuple(number(v, self.kind, self.where) for v in self.value)
        self.amplitude = _amplitude(self.amplitude, self.where)

    def point_masses(self, mesh: Mesh, masses: Sequence[PointMass]) -> list[tuple[PointMass, Ints]]:
        """Point masses that the load acts on, each with the nodes where it does."""
        if self.kind not in ("gravity", "centrifugal"):
            return []
        placed = [(mass, mesh.node_indices(mass.nodes)) for mass in masses]
        if self.masses is not None:
            return [placed[i] for i in self.masses.tolist()]
        if isinstance(self.cells, str) and self.cells in ("", "all"):
            return placed
        at = nodes_of_cells(mesh, cells_of(mesh, self.cells))
        return [(mass, nodes[np.isin(nodes, at)]) for mass, nodes in placed]

    @property
    def axis(self) -> Floats | None:
        """Unit vector along a uniform load, shape (2,); None without any direction."""
        along = np.array(self.direction or self.value[:2])
        size = float(np.hypot(*along))
        return along / size if size > 0.0 else None


@dataclass(repr=False)
class InitialVelocity(Brief):
    """Velocity of nodes at the start of the first dynamic step.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : tuple of float
        ``(vx, vy)`` [length/time]; or with a spin ``(vx, vy, omega, x0, y0)``: the rigid
        motion with angular velocity omega [rad/time] about a point.
    dof : int or None
        Set this component only, to ``value[0]``.
    """

    nodes: str | Ints
    value: tuple[float, ...]
    dof: int | None = None
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.nodes = selected(self.nodes, "node", self.where)
        self.value = tuple(number(v, "an initial velocity", self.where) for v in self.value)


@dataclass(repr=False)
class Temperature(Brief):
    """A prescribed temperature of nodes.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : float or array_like
        One temperature, or one for each node; reached at the end of the step, along the
        amplitude or a ramp from what was there before.
    """

    nodes: str | Ints
    value: float | Floats
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.nodes = selected(self.nodes, "node", self.where)
        self.value = finite(self.value, "temperatures", self.where)
        self.amplitude = _amplitude(self.amplitude, self.where)


@dataclass(repr=False)
class InitialTemperature(Brief):
    """Temperature of nodes without thermal strain; 0 where none is given.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : float or array_like
        One temperature, or one for each node.
    """

    nodes: str | Ints
    value: float | Floats
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass(repr=False)
class InitialStress(Brief):
    """Stress of cells in the reference, before any displacement.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set ("" for all), or global cell indices.
    value : tuple of float or array_like
        xx, yy, zz, xy in global axes [force/length^2]; each a number, or an array with one
        value for each cell (n, 1) or for each quadrature point (n, p). Of trusses and beams xx
        is the stress along the axis.
    """

    cells: str | Ints
    value: tuple[float | Floats, ...]
    where: Location | None = field(default=None, compare=False, repr=False)


#: Loads that act on a given mesh.
AppliedLoad = NodalForce | EdgeLoad | BodyForce | Temperature
Load = AppliedLoad | Force
#: Loads that ``OP=NEW`` removes together: those of *CLOAD, of *DLOAD and *DSLOAD, and of
#: *TEMPERATURE.
LoadKind = Literal["force", "distributed", "temperature"]
LOAD_KINDS: tuple[LoadKind, ...] = ("force", "distributed", "temperature")


def kind_of(load: AppliedLoad) -> LoadKind:
    """The kind of a load that ``OP=NEW`` concerns."""
    if isinstance(load, NodalForce):
        return "force"
    return "temperature" if isinstance(load, Temperature) else "distributed"


def given_as(load: AppliedLoad) -> LoadKind:
    """The kind of a load as the methods of models and steps name it: resultants are forces."""
    return "force" if isinstance(load, EdgeLoad) and load.total else kind_of(load)


def check_loads(loads: object, where: Location | None = None) -> None:
    """Refuse objects that are not loads.

    Raises
    ------
    InputError
        Naming the object and what is accepted.
    """
    for item in _items(loads, "loads", where):
        if not isinstance(item, NodalForce | EdgeLoad | BodyForce | Temperature | Force):
            raise InputError(
                f"{item!r} is not a load; use the methods force, traction, pressure, gravity, "
                "centrifugal and temperature of a step or a model, or Force, NodalForce, "
                "EdgeLoad, BodyForce, Temperature",
                where,
            )


def check_supports(supports: object, where: Location | None = None) -> None:
    """Refuse objects that are not supports.

    Raises
    ------
    InputError
        Naming the object and what is accepted.
    """
    for item in _items(supports, "supports", where):
        if not isinstance(item, Fixed):
            raise InputError(
                f"{item!r} is not a support; use the method fix of a step or a model, or Fixed",
                where,
            )


def _items(given: object, what: str, where: Location | None) -> Iterable[object]:
    if not isinstance(given, (list, tuple)):
        raise InputError(f"{what} is a list, not {type(given).__name__}", where)
    return given


def applied(loads: Iterable[Load], mesh: Mesh) -> list[AppliedLoad]:
    """Loads as they act on a mesh: each :class:`Force` by what it consists of, sets united."""
    found: list[AppliedLoad] = []
    for load in loads:
        found += load.on(mesh) if isinstance(load, Force) else [_united(load, mesh)]
    return found


def applied_in_step(loads: Sequence[Load], mesh: Mesh) -> list[AppliedLoad]:
    """Loads of a step, and those of zero that end components which its forces leave out."""
    zeros = [zero for load in loads if isinstance(load, Force) for zero in load.ends(mesh)]
    return applied(loads, mesh) + zeros


def _united(load: AppliedLoad, mesh: Mesh) -> AppliedLoad:
    """The load with the members of its sets, where it names several."""
    if isinstance(load, EdgeLoad):
        if _several(load.opposite):
            assert load.opposite is not None
            load = replace(load, opposite=mesh.edge_pairs(load.opposite))
        if _several(load.start):
            assert load.start is not None
            load = replace(load, start=mesh.node_indices(load.start))
        return replace(load, edges=mesh.edge_pairs(load.edges)) if _several(load.edges) else load
    if isinstance(load, BodyForce):
        return replace(load, cells=mesh.cell_indices(load.cells)) if _several(load.cells) else load
    return replace(load, nodes=mesh.node_indices(load.nodes)) if _several(load.nodes) else load


def _several(where: object) -> bool:
    return isinstance(where, tuple)

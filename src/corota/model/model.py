"""The model: plain data, valid or refused; no solver objects inside."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.errors import InputError
from corota.model.attachments import Dashpot, PointMass
from corota.model.constraints import Constraint, Coupling, Equation, LocalAxes, StraightLine
from corota.model.contact import ContactPair, PressureLaw, RigidCurve, Tie
from corota.model.initial import InitialFields
from corota.model.line_sections import LineSections
from corota.model.loads import (
    Amplitude as Amplitude,
)
from corota.model.loads import (
    BodyForce as BodyForce,
)
from corota.model.loads import (
    EdgeLoad as EdgeLoad,
)
from corota.model.loads import (
    Fixed as Fixed,
)
from corota.model.loads import (
    InitialStress as InitialStress,
)
from corota.model.loads import (
    InitialTemperature as InitialTemperature,
)
from corota.model.loads import (
    InitialVelocity as InitialVelocity,
)
from corota.model.loads import (
    Load as Load,
)
from corota.model.loads import (
    NodalForce as NodalForce,
)
from corota.model.loads import (
    Temperature as Temperature,
)
from corota.model.sections import Section as Section

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from corota.mesh import Mesh
    from corota.model.local_strain import LocalStrain
    from corota.model.materials import Material
    from corota.model.steps import Step

    Ints = NDArray[np.int64]
    Where = str | ArrayLike

#: Degrees of freedom of a node by name.
DOFS = {"x": 0, "y": 1, "theta": 2}


def _some(found: Ints, what: str, name: str = "") -> Ints:
    """Refuse a set without members: what acts on it would be lost in silence."""
    if not len(found):
        raise InputError(f"{what} set {name!r} is empty" if name else f"no {what}s are given")
    return found


class Model(LineSections, InitialFields):
    """Mesh, sections, materials, supports, loads and steps.

    Parameters
    ----------
    mesh : Mesh
    name : str
        Job name, used for files and titles.

    Attributes
    ----------
    sections : list of Section
    amplitudes : dict of str to Amplitude
    supports : list of Fixed
        Hold in every step.
    loads : list of Load
        Act in every step; a deck's loads are in its steps.
    steps : list of Step
        Used by :func:`corota.solve` when no step is given.
    velocities : list of InitialVelocity
        Of the start of the first dynamic step.
    initial_temperatures : list of InitialTemperature
    initial_stresses : list of InitialStress
    point_masses : list of PointMass
    dashpots : list of Dashpot
    constraints : list of Constraint
        Equations, couplings and straight lines, in force in every step.
    axes : list of LocalAxes
        Axes of nodes; the last for a node counts.
    contacts : list of ContactPair
    ties : list of Tie
    notes : list of str
        What the reader ignored, repaired or assumed.
    title : str
        Heading of a deck.
    time_points : dict of str to ndarray
        Times [time] within a step, by the name that :class:`corota.model.steps.Output` gives.
    """

    def __init__(self, mesh: Mesh, name: str = "model") -> None:
        self.mesh = mesh
        self.name = name
        self.sections: list[Section] = []
        self.amplitudes: dict[str, Amplitude] = {}
        self.supports: list[Fixed] = []
        self.loads: list[Load] = []
        self.velocities: list[InitialVelocity] = []
        self.initial_temperatures: list[InitialTemperature] = []
        self.initial_stresses: list[InitialStress] = []
        self.point_masses: list[PointMass] = []
        self.dashpots: list[Dashpot] = []
        self.constraints: list[Constraint] = []
        self.axes: list[LocalAxes] = []
        self.contacts: list[ContactPair] = []
        self.ties: list[Tie] = []
        self.steps: list[Step] = []
        self.notes: list[str] = []
        self.title = ""
        self.time_points: dict[str, NDArray[np.float64]] = {}

    def section(
        self,
        cells: str | ArrayLike = "all",
        *,
        element: str,
        material: Material,
        thickness: float = 1.0,
        plane: Literal["stress", "strain"] = "stress",
        local_strain: LocalStrain = "linear",
        orientation: float = 0.0,
        mean_dilatation: bool = False,
        beta0: float | None = None,
    ) -> None:
        """Give a set of cells an element type, a material and a thickness.

        Parameters
        ----------
        cells : str or array_like of int, shape (n,)
            Name of a cell set, ``"all"``, or global cell indices.
        element : str
            One of ``corota.model.elements.names()``; must fit the cells' shape.
        material : Material
            Copied; later changes have no effect.
        thickness : float, optional
            Out-of-plane thickness [length].
        plane : {"stress", "strain"}, optional
        local_strain : {"linear", "logarithmic", "green_lagrange"}, optional
            ``logarithmic`` for plastic flow or local strains above a few percent; see
            :class:`corota.model.sections.Section`.
        orientation : float, optional
            Angle of the material axes [rad].
        mean_dilatation : bool, optional
            Quadrilaterals in plane strain: no volumetric locking.
        beta0 : float, optional
            OPT: weight of the bending stiffness.

        Raises
        ------
        InputError
            If the set is unknown or a number is outside its range.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
        """
        from copy import deepcopy

        where = cells if isinstance(cells, str) else np.asarray(cells, dtype=np.int64)
        if isinstance(where, str) and where != "all" and where not in self.mesh.cell_sets:
            names = ", ".join(["all", *self.mesh.cell_sets])
            raise InputError(f"no cell set named {where!r}; the mesh has: {names}")
        if isinstance(where, str):
            if where != "all":
                _some(self.mesh.cell_sets[where], "cell", where)
        else:
            _some(where, "cell")
        self.sections.append(
            Section(
                where,
                element,
                deepcopy(material),
                thickness,
                plane,
                local_strain,
                orientation,
                mean_dilatation=mean_dilatation,
                beta0=beta0,
            )
        )

    def _cells(self, cells: str | ArrayLike) -> str | Ints:
        if isinstance(cells, str):
            if cells not in self.mesh.cell_sets:
                names = ", ".join(self.mesh.cell_sets) or "none"
                raise InputError(f"no cell set named {cells!r}; the mesh has: {names}")
            _some(self.mesh.cell_sets[cells], "cell", cells)
            return cells
        return _some(np.atleast_1d(np.asarray(cells, dtype=np.int64)), "cell")

    def fix(
        self,
        nodes: str | ArrayLike,
        *,
        x: float | None = 0.0,
        y: float | None = 0.0,
        rotation: float | bool | None = None,
        amplitude: str = "",
    ) -> None:
        """Hold or move nodes; ``None`` leaves a direction free.

        Parameters
        ----------
        nodes : str or array_like of int
            Node, edge or cell set, or node indices.
        x, y : float or None
            Displacement at the end of a step [length].
        rotation : float, bool or None
            ``True`` holds the drilling rotation, a number prescribes it [rad].
        """
        where = self._nodes(nodes)
        turn = 0.0 if rotation is True else None if rotation is False else rotation
        for dof, value in enumerate((x, y, turn)):
            if value is not None:
                self.supports.append(Fixed(where, dof, float(value), amplitude))

    def force(
        self,
        where: str | ArrayLike,
        *,
        x: float = 0.0,
        y: float = 0.0,
        moment: float = 0.0,
        amplitude: str = "",
    ) -> None:
        """Apply a dead force or a drilling moment.

        On a node set the values hold for each node (as ``*CLOAD``); on an edge set they are
        totals, spread consistently over its length.

        Parameters
        ----------
        where : str or array_like of int
            Node or edge set, or node indices.
        x, y : float
            Force [force].
        moment : float
            Drilling moment at each node [force*length].
        """
        if (
            isinstance(where, str)
            and where not in self.mesh.node_sets
            and where in self.mesh.edge_sets
        ):
            self.loads.append(EdgeLoad(where, "traction", (x, y), amplitude, total=True))
            return
        nodes = self._nodes(where)
        for dof, value in enumerate((x, y, moment)):
            if value != 0.0:
                self.loads.append(NodalForce(nodes, dof, float(value), amplitude))

    def traction(
        self,
        edges: str | ArrayLike,
        *,
        x: float = 0.0,
        y: float = 0.0,
        amplitude: str = "",
    ) -> None:
        """Apply a dead traction [force/length^2] on edges."""
        self.loads.append(EdgeLoad(self._edges(edges), "traction", (x, y), amplitude))

    def pressure(self, edges: str | ArrayLike, p: float, amplitude: str = "") -> None:
        """Apply a pressure [force/length^2] on edges, positive into the element."""
        self.loads.append(EdgeLoad(self._edges(edges), "pressure", (p,), amplitude))

    def gravity(
        self,
        x: float = 0.0,
        y: float = 0.0,
        cells: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Apply an acceleration field [length/time^2] to cells (default all)."""
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        self.loads.append(BodyForce(where, "gravity", (x, y), amplitude))

    def centrifugal(
        self,
        omega: float,
        about: tuple[float, float] = (0.0, 0.0),
        cells: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Apply the centrifugal force of a steady spin to cells (default all).

        The model is seen from a frame that turns with it: the force grows with the current
        distance from the axis in geometrically nonlinear steps, with that of the undeformed body
        in linear ones. Modes and buckling see its stiffness. Coriolis forces are left out.

        Parameters
        ----------
        omega : float
            Angular velocity [rad/time]; its sign does not matter.
        about : tuple of float
            Where the axis meets the plane [length].
        cells : str or array_like of int
            Cell set ("" for all), or global cell indices.
        amplitude : str
            Scales the force, that is omega squared, as the ramp of a static step does.
        """
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        value = (float(omega) ** 2, float(about[0]), float(about[1]))
        self.loads.append(BodyForce(where, "centrifugal", value, amplitude))

    def velocity(
        self,
        nodes: str | ArrayLike = "",
        *,
        x: float = 0.0,
        y: float = 0.0,
        spin: float = 0.0,
        about: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Give nodes an initial rigid motion.

        Parameters
        ----------
        nodes : str or array_like of int
            Node, edge or cell set ("" for all), or node indices.
        x, y : float
            Velocity [length/time].
        spin : float
            Angular velocity [rad/time] about a point, added.
        about : tuple of float
            That point [length].
        """
        where = "" if isinstance(nodes, str) and not nodes else self._nodes(nodes)
        self.velocities.append(InitialVelocity(where, (x, y, spin, *about)))

    def point_mass(self, nodes: str | ArrayLike, mass: float, *, inertia: float = 0.0) -> None:
        """Add a mass [mass] and an inertia [mass*length^2] at each node of a set."""
        self.point_masses.append(PointMass(self._nodes(nodes), float(mass), float(inertia)))

    def dashpot(
        self,
        first: int,
        second: int | None = None,
        *,
        c: float = 0.0,
        x: float = 0.0,
        y: float = 0.0,
        rotation: float = 0.0,
    ) -> None:
        """Damp the approach of two nodes of an element, or the motion of one to the ground.

        Parameters
        ----------
        first, second : int, int or None
            Node indices.
        c : float
            Along the line of the two nodes, which turns with them [force*time/length].
        x, y, rotation : float
            To the ground [force*time/length], [force*length*time].
        """
        if (second is None) == bool(c) or (second is not None and (x or y or rotation)):
            raise InputError("a dashpot between nodes takes c; one to the ground x, y, rotation")
        other = None if second is None else int(second)
        self.dashpots.append(
            Dashpot(int(first), other, float(c), (float(x), float(y), float(rotation)))
        )

    def equation(self, *terms: tuple[int, str, float], rhs: float = 0.0) -> None:
        """Relate dofs linearly: the sum of coefficient times dof is `rhs`.

        Parameters
        ----------
        *terms : tuple of (int, str, float)
            Node index, ``"x"``, ``"y"`` or ``"theta"``, coefficient; the first term is
            eliminated.
        rhs : float
        """
        self.constraints.append(Equation([(int(n), DOFS[d], float(c)) for n, d, c in terms], rhs))

    def couple(
        self,
        nodes: str | ArrayLike,
        reference: int,
        *,
        kind: Literal["kinematic", "distributing"] = "kinematic",
        dofs: str = "x y theta",
        weights: ArrayLike | None = None,
    ) -> None:
        """Couple nodes with a reference node (see :class:`corota.model.constraints.Coupling`)."""
        where = self._nodes(nodes)
        chosen = tuple(DOFS[d] for d in dofs.split())
        given = None if weights is None else np.asarray(weights, dtype=np.float64)
        self.constraints.append(Coupling(where, int(reference), kind, chosen, given))

    def rigid(self, nodes: str | ArrayLike, reference: int) -> None:
        """Make nodes one rigid body with a reference node, in any rotation."""
        self.constraints.append(Coupling(self._nodes(nodes), int(reference), name="rigid body"))

    def straight(self, nodes: str | ArrayLike, first: int, last: int) -> None:
        """Keep nodes on the straight line through two others; they may slide along it."""
        self.constraints.append(StraightLine(self._nodes(nodes), int(first), int(last)))

    def local_axes(
        self,
        nodes: str | ArrayLike,
        *,
        angle: float = 0.0,
        centre: tuple[float, float] | None = None,
    ) -> None:
        """Turn the axes in which supports and forces of nodes are meant.

        Parameters
        ----------
        nodes : str or array_like of int
        angle : float
            Angle of the first axis [rad].
        centre : tuple of float, optional
            Radial and circumferential axes about this point [length].
        """
        self.axes.append(LocalAxes(self._nodes(nodes), angle, centre))

    def contact(
        self,
        slave: str | ArrayLike,
        master: str | ArrayLike | RigidCurve,
        *,
        method: Literal["mortar", "node_to_segment"] = "mortar",
        friction: float = 0.0,
        law: PressureLaw | None = None,
        clearance: float | None = None,
        start: Literal["keep", "adjust", "ramp"] = "keep",
        adjust: float = 0.0,
        stabilise: bool = False,
        reach: float = 0.0,
        name: str = "",
    ) -> None:
        """Let two edge sets touch, or an edge set and a rigid curve; see ``docs/contact.md``.

        The parameters are those of :class:`corota.model.contact.ContactPair`; the same set twice is
        contact of a surface with itself.
        """
        other = master if isinstance(master, RigidCurve) else self._edges(master)
        self.contacts.append(
            ContactPair(
                self._edges(slave),
                other,
                method,
                friction,
                law,
                clearance,
                start,
                stabilise,
                reach,
                name,
                adjust=adjust,
            )
        )

    def tie(
        self,
        slave: str | ArrayLike,
        master: str | ArrayLike,
        *,
        tolerance: float = 0.0,
        name: str = "",
    ) -> None:
        """Join two edge sets whose nodes need not match (:class:`corota.model.contact.Tie`)."""
        self.ties.append(Tie(self._edges(slave), self._edges(master), tolerance, name))

    def _nodes(self, where: str | ArrayLike) -> str | Ints:
        if isinstance(where, str):
            _some(self.mesh.nodes_of(where), "node", where)
            return where
        return _some(np.atleast_1d(np.asarray(where, dtype=np.int64)), "node")

    def _edges(self, where: str | ArrayLike) -> str | Ints:
        if isinstance(where, str):
            if where not in self.mesh.edge_sets:
                names = ", ".join(self.mesh.edge_sets) or "none"
                raise InputError(f"no edge set named {where!r}; the mesh has: {names}")
            _some(self.mesh.edge_sets[where], "edge", where)
            return where
        return _some(np.asarray(where, dtype=np.int64).reshape(-1, 2), "edge")

"""Methods of models and steps that define supports and loads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.errors import InputError, number
from corota.mesh import selection
from corota.model.loads import BodyForce, EdgeLoad, Fixed, Force, Load, Temperature, selected

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints


#: Default of directions: fixed, and distinct from a 0 that is given.
FIXED = np.float64(0.0)


#: Permittivity of vacuum [N/V^2].
VACUUM = 8.8541878128e-12


def _is_real(values: object) -> bool:
    """Whether an array holds coordinates, not indices of edges."""
    return np.asarray(values).dtype.kind == "f"


class Loading:
    """Methods that add to ``supports`` and ``loads``.

    A model checks sets and nodes at once; those of a step are checked when it runs.
    """

    supports: list[Fixed]
    loads: list[Load]

    def _nodes(self, where: str | ArrayLike) -> str | Ints:
        return selected(where, "node", None)

    def _edges(self, where: str | ArrayLike) -> str | Ints:
        return selected(where, "edge", None)

    def _cells(self, cells: str | ArrayLike) -> str | Ints:
        return selected(cells, "cell", None)

    def _add_force(self, force: Force) -> None:
        self.loads.append(force)

    def _fixes_nothing(self) -> None:
        """What a call of :meth:`fix` without any direction means; nothing in a model."""

    def fix(
        self,
        nodes: str | ArrayLike,
        *,
        x: float | None = FIXED,
        y: float | None = FIXED,
        rotation: float | bool | None = None,
        amplitude: str = "",
    ) -> None:
        """Fix or move nodes; ``None`` leaves a direction free.

        Parameters
        ----------
        nodes : str, sequence of str or array_like of int
            Node, edge or cell set, a list of them, node indices, or a mask of nodes.
        x, y : float or None
            Displacement at the end of a step [length]; both are 0 by default. ``x=0.0``
            alone fixes y as well, with a warning, as does ``x=1.0`` with a sentence in
            :meth:`Model.summary`: write ``y=None`` to leave it free.
        rotation : float, bool or None
            ``True`` fixes the drilling rotation, a number prescribes it [rad]. Nodes of beams, of
            ``OPT``, ``Q4D`` and ``Q4DI``, and reference nodes have one; where no node of the
            place has, ``check`` warns and the results have a note.
        amplitude : str
            Name in ``Model.amplitudes``; empty: ramp in static steps.

        Raises
        ------
        InputError
            If there is no such set or node, or a value is not finite.

        Examples
        --------
        >>> import corota as ct
        >>> step = ct.Static()
        >>> step.fix("left")
        >>> step.fix("pin", x=-0.5, y=None)
        >>> [(s.nodes, s.dof, s.value) for s in step.supports]
        [('left', 0, 0.0), ('left', 1, 0.0), ('pin', 0, -0.5)]
        """
        places = [self._nodes(place) for place in selection.names(nodes) or [nodes]]
        for name, value, other, rest in (("x", x, "y", y), ("y", y, "x", x)):
            if (
                rest is FIXED
                and value is not FIXED
                and isinstance(value, int | float)
                and value == 0
            ):
                warnings.warn(
                    f"fix(..., {name}=0.0) fixes {other} as well; write {other}=None to leave it "
                    f"free, or {other}=0.0 to fix both",
                    stacklevel=2,
                )
        if x is None and y is None and (rotation is None or rotation is False):
            self._fixes_nothing()
        turn = 0.0 if rotation is True else None if rotation is False else rotation
        one = (x is FIXED) != (y is FIXED)
        for where in places:
            for dof, value in enumerate((x, y, turn)):
                if value is not None:
                    implied = value is FIXED and one
                    given = 0.0 if value is FIXED else value
                    self.supports.append(Fixed(where, dof, given, amplitude, implied=implied))

    def force(
        self,
        where: str | ArrayLike,
        *,
        x: float = 0.0,
        y: float = 0.0,
        moment: float = 0.0,
        total: bool = False,
        per_node: bool = False,
        amplitude: str = "",
    ) -> None:
        """Apply a dead force or a drilling moment.

        On an edge set the values are the resultant, distributed consistently over the length of the
        edges, independent of the mesh. On nodes they apply to each node. A name of both, such as
        the
        sides of :func:`corota.mesh.rectangle` are, means the edges.

        Parameters
        ----------
        where : str, sequence of str or array_like of int
            Edge or node set, a list of them (united), node indices, or a mask of nodes.
        x, y : float
            Force [force]: along the local axes of nodes that have them, on edges always global.
        moment : float
            Drilling moment [force*length].
        total : bool
            The values are the resultant on nodes too, shared equally.
        per_node : bool
            The values apply to each node of an edge set too, as those of ``*CLOAD``.
        amplitude : str
            Name in ``Model.amplitudes``; empty: ramp in static steps.

        Raises
        ------
        InputError
            If there is no such set or node, or a value is not finite.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=4))
        >>> model.force("right", y=-5.0)  # 5 in all
        >>> model.force([0, 1], y=-5.0)  # 5 at each of the two
        """
        if total and per_node:
            raise InputError("a force is either total or per_node")
        if not isinstance(where, str):
            # Of several names only the mesh determines whether they are edges.
            where = selection.names(where) or self._nodes(where)
        spread = "total" if total else "per node" if per_node else ""
        self._add_force(Force(where, x, y, moment, spread, amplitude))  # type: ignore[arg-type]

    def traction(
        self,
        edges: str | ArrayLike,
        *,
        x: float = 0.0,
        y: float = 0.0,
        amplitude: str = "",
        follow: bool = False,
    ) -> None:
        """Apply a traction [force/length^2] on edges: dead, or following them.

        A follower traction keeps its tangential and normal components in geometrically nonlinear
        steps, and acts on its current length.
        """
        kind: Literal["following traction", "traction"]
        kind = "following traction" if follow else "traction"
        self.loads.append(EdgeLoad(self._edges(edges), kind, (x, y), amplitude))

    def shear(self, edges: str | ArrayLike, t: float, amplitude: str = "") -> None:
        """Apply a shear traction [force/length^2] along edges, with the element on the left.

        It follows the edges in geometrically nonlinear steps.
        """
        self.loads.append(EdgeLoad(self._edges(edges), "shear", (t,), amplitude))

    def pressure(self, edges: str | ArrayLike, p: float, amplitude: str = "") -> None:
        """Apply a pressure [force/length^2] on edges, positive into the element."""
        self.loads.append(EdgeLoad(self._edges(edges), "pressure", (p,), amplitude))

    def hydrostatic_pressure(
        self,
        edges: str | ArrayLike,
        p: float,
        *,
        level: float,
        height: float,
        amplitude: str = "",
    ) -> None:
        """Apply the pressure of a liquid at rest on edges, which follows them as a pressure does.

        It is zero at the level and above, and grows linearly with the depth; heights are y of the
        undeformed edges.

        Parameters
        ----------
        edges : str or array_like of int, shape (n, 2)
        p : float
            Pressure at `height` [force/length^2].
        level, height : float
            y where the pressure is zero, and where it is `p` [length].
        amplitude : str
            Name in ``Model.amplitudes``; empty: a ramp.

        Raises
        ------
        InputError
            If both heights are the same.
        """
        value = (p, level, height)
        self.loads.append(EdgeLoad(self._edges(edges), "hydrostatic pressure", value, amplitude))

    def penetrating_pressure(
        self,
        edges: str | ArrayLike,
        p: float,
        start: str | ArrayLike,
        *,
        opposite: str | ArrayLike | None = None,
        critical: float | None = None,
        amplitude: str = "",
    ) -> None:
        """Let a fluid press on edges as far as it gets between surfaces in contact.

        The fluid is at the start and passes along the edges, one by one, where contact does not
        press harder than the fluid (or than `critical`). It acts on edges that it has passed, as a
        pressure does. Between increments it draws back where the surfaces press again. The scalar
        ``wetted length`` says how far it is. For static and implicit dynamic steps.

        Parameters
        ----------
        edges : str or array_like of int, shape (n, 2)
            The slave surface of a contact pair, with the free surface that leads there.
        p : float
            Pressure of the fluid, >= 0 [force/length^2].
        start : str or array_like of int
            Nodes of these edges that are in the fluid.
        opposite : str or array_like of int, optional
            Edges of the other body, if it is deformable: the fluid presses on them as well.
        critical : float, optional
            Contact pressure up to which the fluid passes [force/length^2], by default that of the
            fluid; 0 for surfaces that are apart only.
        amplitude : str
            Name in ``Model.amplitudes``; empty: a ramp.

        Raises
        ------
        InputError
            If a pressure is negative.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 2.0, nx=10, ny=2))
        >>> model.section("all", element="Q4", material=ct.Elastic(E=100.0, nu=0.0))
        >>> model.contact("bottom", ct.RigidCurve.line((-5.0, 0.0), (15.0, 0.0)), name="floor")
        >>> model.fix("top")
        >>> model.fix("right", x=None, y=0.0)
        >>> model.penetrating_pressure("bottom", 2.0, start=[0])
        >>> frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
        >>> frame.scalars["wetted length"]
        10.0
        """
        value = (p,) if critical is None else (p, critical)
        sides = None if opposite is None else self._edges(opposite)
        nodes = selection.names(start) or self._nodes(start)
        on, kind = self._edges(edges), "penetrating pressure"
        self.loads.append(
            EdgeLoad(on, kind, value, amplitude, opposite=sides, start=nodes)  # type: ignore[arg-type]
        )

    def electrostatic(
        self,
        edges: str | ArrayLike,
        opposite: str | ArrayLike | None = None,
        voltage: float = 0.0,
        *,
        permittivity: float = VACUUM,
        amplitude: str = "",
    ) -> None:
        """Attract edges by an opposite electrode, parallel to them, across the current gap.

        The traction is ``1/2 permittivity (voltage / gap)^2``, without fringe fields; it follows
        the edges in geometrically nonlinear steps, and pull-in is a limit point of a path. Free
        ends of the edges are pulled along the electrode as well, by ``1/2 permittivity
        voltage^2 / gap`` times the thickness: the energy grows with the length that faces it. The
        force goes with the square of the voltage: so does the load factor, which is
        (voltage so far / `voltage`)^2.

        Parameters
        ----------
        edges : str or array_like of int, shape (n, 2)
            The electrode, the shorter one of two.
        opposite : str, array_like of int or array_like of float, shape (2, 2)
            Edges that are attracted, too, or two points of a fixed straight electrode [length].
        voltage : float
            Zero ends the load.
        permittivity : float
            [force] per square volt; by default that of vacuum for forces in N and any length.
        amplitude : str
            Name in ``Model.amplitudes``, of the square of the voltage; empty: a ramp.

        Raises
        ------
        InputError
            If there is a voltage without an opposite electrode.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(100.0, 2.0, nx=50, ny=2))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1.69e5, nu=0.06))
        >>> model.fix("left"); model.fix("right")
        >>> model.electrostatic("bottom", [(0.0, -1.0), (100.0, -1.0)], voltage=40.0)
        """
        strength = 0.5 * permittivity * voltage**2
        line: tuple[float, ...] = ()
        sides: str | Ints | None = None
        if strength and opposite is None:
            raise InputError("an electrostatic load needs the opposite electrode")
        if opposite is not None and np.shape(opposite) == (2, 2) and _is_real(opposite):
            line = tuple(np.asarray(opposite, dtype=np.float64).ravel().tolist())
        elif opposite is not None:
            sides = self._edges(opposite)
        value = (strength, *line)
        on = self._edges(edges)
        self.loads.append(EdgeLoad(on, "electrostatic", value, amplitude, opposite=sides))

    def gravity(
        self,
        x: float = 0.0,
        y: float = 0.0,
        cells: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Apply an acceleration field [length/time^2] to cells (default all).

        Fields of zero end gravity of every direction in these cells.
        """
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        every = x == 0.0 and y == 0.0
        self.loads.append(BodyForce(where, "gravity", (x, y), amplitude, every=every))

    def line_load(
        self,
        x: float = 0.0,
        y: float = 0.0,
        cells: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Apply a dead force per undeformed length [force/length] to beams and trusses.

        Beams take the consistent end moments, which turn with them in geometrically nonlinear
        steps: one element is exact at its ends.

        Parameters
        ----------
        x, y : float
            Components in global axes.
        cells : str or array_like of int
            Cell set, cell indices, or a mask of cells; ("" for all, which must then be lines).
        amplitude : str
            Name in ``Model.amplitudes``; empty: a ramp in static steps.

        Examples
        --------
        >>> import corota as ct
        >>> line = ct.Cells("line2", [[0, 1]], [1])
        >>> model = ct.Model(ct.Mesh([[0.0, 0.0], [2.0, 0.0]], [line]))
        >>> model.beam([0], material=ct.Elastic(E=1000.0, nu=0.0), area=0.1, inertia=0.001)
        >>> model.fix([0], rotation=True)
        >>> model.line_load(y=-0.01)
        >>> tip = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].U[1, 1]
        >>> float(tip.round(6))  # q l^4 / (8 E I)
        -0.02
        """
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        self.loads.append(BodyForce(where, "line", (x, y), amplitude))

    def centrifugal(
        self,
        omega: float,
        about: tuple[float, float] | None = None,
        cells: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Apply the centrifugal force of a steady spin to cells (default all).

        The frame of reference rotates with the model: the force grows with the current
        distance from the axis in geometrically nonlinear steps, with that of the undeformed body
        in linear ones. Modes and buckling include its stiffness. Complex modes, modal and harmonic
        steps include Coriolis forces; transient steps do not, and say so.

        Parameters
        ----------
        omega : float
            Angular velocity [rad/time]; its sign does not matter.
        about : tuple of float, optional
            Point where the axis meets the plane [length]; the origin by default. A spin of zero
            without it ends those about every axis.
        cells : str or array_like of int
            Cell set ("" for all), cell indices, or a mask of cells.
        amplitude : str
            Scales the force, that is omega squared, as the ramp of a static step does.
        """
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        x, y = about or (0.0, 0.0)
        value = (number(omega, "omega") ** 2, float(x), float(y))
        every = value[0] == 0.0 and about is None
        self.loads.append(BodyForce(where, "centrifugal", value, amplitude, every=every))

    def temperature(
        self,
        value: ArrayLike | Callable[[Floats, Floats], ArrayLike],
        nodes: str | ArrayLike = "",
        amplitude: str = "",
    ) -> None:
        """Set the temperature of nodes; materials with an ``expansion`` expand.

        Parameters
        ----------
        value : float, array_like or callable
            One temperature, or one for each node, at the end of the step. Of a model also a
            function of the arrays x and y, such as ``lambda x, y: 20.0 + 3.0 * y`` or, of a table,
            SciPy's ``LinearNDInterpolator(points, values)``.
        nodes : str or array_like of int
            Node, edge or cell set ("" for all), node indices, or a mask of nodes.
        amplitude : str
            Name in ``Model.amplitudes``; empty: a ramp in static steps.

        Raises
        ------
        InputError
            If a function is given to a step, or its values are not finite.
        """
        where = "" if isinstance(nodes, str) and not nodes else self._nodes(nodes)
        if callable(value):
            mesh = getattr(self, "mesh", None)
            if mesh is None:
                raise InputError(
                    "a step has no mesh: give the temperatures of its nodes, "
                    "function(*mesh.points.T)"
                )
            points = (
                mesh.points
                if isinstance(where, str) and not where
                else (mesh.points[mesh.node_indices(where)])
            )
            value = np.broadcast_to(value(*points.T), len(points))
        self.loads.append(Temperature(where, value, amplitude))  # type: ignore[arg-type]

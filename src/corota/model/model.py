"""The model: plain data, valid or refused; no solver objects inside."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, cast

import numpy as np

from corota.display import CELLS_DRAWN, LONGEST, brief, picture, table
from corota.errors import Diagnostic, InputError, number
from corota.lazy import lazy
from corota.mesh import EDGES, selection
from corota.model.attachments import Dashpot, PointMass
from corota.model.constraints import Constraint, Coupling, Equation, LocalAxes, StraightLine
from corota.model.contact import ContactPair, PressureLaw, RigidCurve, Tie
from corota.model.dofs import dof_index, dof_indices
from corota.model.initial import InitialFields
from corota.model.line_sections import LineSections
from corota.model.loading import Loading
from corota.model.loads import (
    Amplitude,
    Fixed,
    Force,
    InitialStress,
    InitialTemperature,
    InitialVelocity,
    Load,
)
from corota.model.sections import Plane, Section
from corota.model.stages import Stage, Stages
from corota.model.units import Units
from corota.renamed import accept_old_names

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.model.friction import Friction
    from corota.model.local_strain import LocalStrain
    from corota.model.materials import Material
    from corota.model.paths import Modes
    from corota.model.steps import Step

    Where = str | ArrayLike

# Conveniences: functions of higher layers, which load at their first call.
check_model = lazy("corota.check:check")
draw_model = lazy("corota.plots:model")
model_lines = lazy("corota.model.summary:model_lines")

#: Findings of a check that its ``repr`` shows; ``print`` shows all.
FINDINGS_SHOWN = 10


class Model(Loading, LineSections, InitialFields, Stages):
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
        Active in every step.
    loads : list of Load
        Act in every step; a deck's loads are in its steps.
    stages : list of Stage
        Bodies that are measured in every frame, see :meth:`stage`.
    steps : list of Step
        Used by :func:`corota.solve` when no step is given.
    velocities : list of InitialVelocity
        Of the start of the first dynamic step.
    initial_temperatures : list of InitialTemperature
    initial_stresses : list of InitialStress
    point_masses : list of PointMass
    dashpots : list of Dashpot
    constraints : list of Constraint
        Equations, couplings and straight lines, active in every step.
    axes : list of LocalAxes
        Axes of nodes; the last for a node counts.
    contacts : list of ContactPair
    ties : list of Tie
    notes : list of str
        Notes of the reader: what it ignored, repaired or assumed.
    title : str
        Heading of a deck.
    sources : list of str
        Files that it was read from, the deck first; results never replace them.
    start : Checkpoint or None
        Where an analysis of :attr:`steps` starts, after ``*RESTART, READ``.
    time_points : dict of str to ndarray
        Times [time] within a step, by the name that :class:`corota.model.steps.Output` gives.
    unit_system : Units
        Names of the units, see :meth:`units`; empty if not given.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"start"})

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
        self.stages: list[Stage] = []
        self.steps: list[Step] = []
        self.notes: list[str] = []
        self.title = ""
        self.sources: list[str] = []
        self.start: Any = None
        self.time_points: dict[str, Floats] = {}
        self.unit_system = Units()

    def __setattr__(self, name: str, value: object) -> None:
        """Set an attribute; ``model.units = "mm"`` calls the method of that name.

        Raises
        ------
        AttributeError
            If it would hide another method.
        """
        if name == "units":
            self.units(*((value,) if isinstance(value, str) else value))  # type: ignore[misc]
        elif callable(getattr(type(self), name, None)):
            raise AttributeError(f"{name} is a method of the model: call model.{name}(...)")
        else:
            super().__setattr__(name, value)

    def units(self, *names: str) -> None:
        """Name the units of the model, for axes, tables and files.

        Nothing is converted: the numbers must be consistent by themselves.

        Parameters
        ----------
        *names : str
            Units of length, force, mass, time and temperature, in any order; those that are
            omitted have no label.

        Raises
        ------
        InputError
            If a unit is unknown, or force, mass, length and time do not fit each other.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.units("mm", "N", "t", "s", "°C")
        >>> model.unit_system.label("force/length^2")
        'MPa'
        """
        self.unit_system = Units.of(*names)

    def section(
        self,
        cells: str | ArrayLike = "all",
        *,
        element: str | Mapping[str, str],
        material: Material,
        thickness: float | ArrayLike = 1.0,
        plane: Plane = "stress",
        local_strain: LocalStrain | None = None,
        orientation: float = 0.0,
        mean_dilatation: bool = False,
        beta0: float | None = None,
    ) -> None:
        """Give a set of cells an element type, a material and a thickness.

        Parameters
        ----------
        cells : str or array_like of int, shape (n,)
            Name of a cell set, ``"all"``, or global cell indices.
        element : str or dict of str to str
            One of ``corota.model.elements.names()``; must fit the cells' shape. In a mixed mesh one
            for each kind of cell: ``{"quad4": "Q4I", "tri3": "OPT"}``.
        material : Material
            Copied; later changes have no effect.
        thickness : float or array_like, shape (n_nodes,), optional
            Out-of-plane thickness [length], or that of every node of the mesh; between the nodes
            it follows the shape functions.
        plane : {"stress", "strain", "axisymmetric"}, optional
            Axisymmetric: x is the radius, y the axis; forces, masses and energies are those of the
            whole circumference.
        local_strain : {"linear", "logarithmic", "green_lagrange"}, optional
            By default that which the material is for: ``logarithmic`` for laws that flow and for
            hyperelastic ones, ``linear`` for elastic ones; see
            :class:`corota.model.sections.Section`.
        orientation : float, optional
            Angle of the material axes [rad].
        mean_dilatation : bool, optional
            Quadrilaterals in plane strain and axisymmetry: no volumetric locking.
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

        everything = isinstance(cells, str) and cells.lower() in ("", "all")
        where = "all" if everything else self._cells(cells)
        parts: list[tuple[str | Ints, str]]
        if isinstance(element, Mapping):
            parts = self._by_kind(where, element)
        else:
            parts = [(where, element)]
        for part, name in parts:
            self.sections.append(
                Section(
                    part,
                    name,
                    deepcopy(material),
                    cast("float", thickness),
                    plane,
                    local_strain,
                    orientation,
                    mean_dilatation=mean_dilatation,
                    beta0=beta0,
                )
            )

    def _by_kind(
        self, cells: str | Ints, element: Mapping[str, str]
    ) -> list[tuple[str | Ints, str]]:
        """The plane cells of each kind among some, and the element that they get."""
        chosen = self.mesh.cell_indices(cells)
        found: list[tuple[str | Ints, str]] = []
        for first, block in zip(self.mesh.offsets, self.mesh.cells, strict=False):
            mine = chosen[(chosen >= first) & (chosen < first + len(block))]
            if not len(mine) or not EDGES[block.kind]:
                continue
            if block.kind not in element:
                raise InputError(f"element= names none for the {len(mine)} {block.kind} cells")
            found.append((mine, element[block.kind]))
        return found

    def velocity(
        self,
        nodes: str | ArrayLike = "",
        *,
        x: float = 0.0,
        y: float = 0.0,
        spin: float = 0.0,
        about: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Set an initial rigid motion of nodes.

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
        """Add a dashpot between two nodes of an element, or from one to the ground.

        Parameters
        ----------
        first, second : int, int or None
            Node indices.
        c : float
            Along the current line of the two nodes [force*time/length].
        x, y, rotation : float
            To the ground [force*time/length], [force*length*time].
        """
        if (second is None) == bool(c) or (second is not None and (x or y or rotation)):
            raise InputError("a dashpot between nodes takes c; one to the ground x, y, rotation")
        other = None if second is None else self._node(second)
        self.dashpots.append(
            Dashpot(self._node(first), other, float(c), (float(x), float(y), float(rotation)))
        )

    def equation(self, *terms: tuple[int, str, float], rhs: float = 0.0) -> None:
        """Add a linear equation: the sum of coefficient times dof is `rhs`.

        Parameters
        ----------
        *terms : tuple of (int, str, float)
            Node index, ``"x"``, ``"y"`` or ``"rotation"``, coefficient; the first term is
            eliminated.
        rhs : float
        """
        found = []
        for term in terms:
            if not isinstance(term, (tuple, list)) or len(term) != 3:
                raise InputError(f"a term is (node, dof, coefficient), not {term!r}")
            node, dof, factor = term
            found.append((self._node(node), dof_index(dof), number(factor, "a coefficient")))
        self.constraints.append(Equation(found, number(rhs, "the right-hand side")))

    def couple(
        self,
        nodes: str | ArrayLike,
        reference: int,
        *,
        kind: Literal["kinematic", "distributing"] = "kinematic",
        dofs: str = "x y rotation",
        weights: ArrayLike | None = None,
    ) -> None:
        """Couple nodes with a reference node (see :class:`corota.model.constraints.Coupling`)."""
        where = self._nodes(nodes)
        chosen = dof_indices(dofs)
        given = None if weights is None else np.asarray(weights, dtype=np.float64)
        self.constraints.append(Coupling(where, self._node(reference), kind, chosen, given))

    def rigid(self, nodes: str | ArrayLike, reference: int | str) -> None:
        """Make nodes (a set, a list of sets, indices) one rigid body with a reference node.

        The reference node is given by its index, or by the name of a set that has it alone.
        """
        self.constraints.append(
            Coupling(self._nodes(nodes), self._node(reference), name="rigid body")
        )

    def straight(self, nodes: str | ArrayLike, first: int, last: int) -> None:
        """Keep nodes on the straight line through two others; they may slide along it."""
        self.constraints.append(
            StraightLine(self._nodes(nodes), self._node(first), self._node(last))
        )

    @accept_old_names(centre="center")
    def local_axes(
        self,
        nodes: str | ArrayLike,
        *,
        angle: float = 0.0,
        center: tuple[float, float] | None = None,
    ) -> None:
        """Set local axes of nodes for their supports and forces.

        Parameters
        ----------
        nodes : str or array_like of int
        angle : float
            Angle of the first axis [rad].
        center : tuple of float, optional
            Radial and circumferential axes about this point [length].
        """
        self.axes.append(LocalAxes(self._nodes(nodes), angle, center))

    def imperfection(
        self, modes: Modes | ArrayLike, scales: Sequence[float] | Mapping[int, float]
    ) -> None:
        """Move the nodes by shapes, such as buckling modes: a real part is not perfect.

        Beams between moved nodes stay straight. Call it before sets by geometry are used.

        Parameters
        ----------
        modes : Modes or array_like, shape (m, n_nodes, 2 or 3) or (n_nodes, 2 or 3)
            Of a buckling or frequency step of a model with the same nodes: ``results.modes[0]``.
            The largest displacement of a buckling mode is 1. Or displacements of all nodes:
            those of a frame (``frame.U``), or of :func:`corota.mesh.random_field`; a third
            component is a rotation and has no effect.
        scales : sequence of float or mapping of int to float
            Size of each mode from the first on, or by the number of the mode from 1 [length].

        Raises
        ------
        InputError
            If the modes have other nodes, or there is no such mode.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(20.0, 0.5, nx=20, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", x=-1.0)
        >>> mode = ct.solve(model, ct.Buckle(modes=1), threads=1).modes[0]
        >>> model.imperfection(mode, [0.05])
        >>> round(float(abs(model.mesh.points[:, 1] - 0.25).max()), 3) > 0.25
        True
        >>> rough = ct.mesh.random_field(model.mesh, 2.0, seed=1)
        >>> model.imperfection(rough, [0.001])
        """
        shapes = np.asarray(getattr(modes, "shapes", modes), dtype=np.float64)
        if shapes.ndim == 2:
            shapes = shapes[None]
        if shapes.ndim != 3 or shapes.shape[2] not in (2, 3) or not np.isfinite(shapes).all():
            raise InputError(
                "the shapes of an imperfection are finite displacements of all nodes, (m, n_nodes, "
                f"2 or 3), not an array of shape {shapes.shape}"
            )
        if shapes.shape[1] != self.mesh.n_nodes:
            raise InputError(
                f"the modes have {shapes.shape[1]} nodes, the mesh {self.mesh.n_nodes}"
            )
        given = dict(scales) if isinstance(scales, Mapping) else dict(enumerate(scales, start=1))
        moved = self.mesh.points.copy()
        for mode, scale in given.items():
            if not 1 <= mode <= len(shapes):
                raise InputError(f"no mode {mode}; there are {len(shapes)}, counted from 1")
            moved += number(scale, "the size of an imperfection") * shapes[mode - 1, :, :2]
        self.mesh = replace(self.mesh, points=moved)

    @accept_old_names(stabilise="stabilize")
    def contact(
        self,
        slave: str | ArrayLike,
        master: str | ArrayLike | RigidCurve,
        *,
        method: str = "mortar",
        friction: Friction = 0.0,
        law: PressureLaw | None = None,
        clearance: float | None = None,
        start: Literal["keep", "adjust", "ramp"] = "keep",
        adjust: float = 0.0,
        stabilize: bool = False,
        reach: float = 0.0,
        smooth: bool = False,
        shear_limit: float | None = None,
        separates: bool = True,
        steps: Sequence[int] | None = None,
        friction_steps: Mapping[int, Friction] | None = None,
        friction_ramps: bool = True,
        name: str = "",
    ) -> None:
        """Define contact of two surfaces, or of one and a rigid curve; see ``docs/contact.md``.

        A surface is an edge set, or a list of edge sets that are one surface, a cell set of beams
        or trusses, or, as slave, a node set.

        The parameters are those of :class:`corota.model.contact.ContactPair`; the same set twice
        gives self-contact.
        """
        other = master if isinstance(master, RigidCurve) else self._surface(master)
        if isinstance(other, RigidCurve) and isinstance(other.reference, str):
            other = replace(other, reference=self._node(other.reference))
        self.contacts.append(
            ContactPair(
                self._surface(slave),
                other,
                method,
                friction,
                law,
                clearance,
                start,
                stabilize,
                reach,
                name,
                adjust=adjust,
                smooth=smooth,
                shear_limit=shear_limit,
                separates=separates,
                steps=None if steps is None else tuple(steps),
                friction_steps=friction_steps or {},
                friction_ramps=friction_ramps,
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
        """Join two surfaces whose nodes need not match (:class:`corota.model.contact.Tie`).

        Surfaces are those of :meth:`contact`.
        """
        self.ties.append(Tie(self._surface(slave), self._surface(master), tolerance, name))

    def copy(self) -> Model:
        """An independent copy: for a variant, or the next run of a sweep.

        Examples
        --------
        >>> import corota as ct
        >>> base = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> variant = base.copy()
        >>> variant.fix("left")
        >>> len(base.supports), len(variant.supports)
        (0, 2)
        """
        from copy import deepcopy

        return deepcopy(self)

    def check(self, steps: Step | Sequence[Step] | None = None) -> Findings:
        """Check for errors and likely mistakes, without solving more than the start.

        Parameters
        ----------
        steps : Step or sequence of Step, optional
            What will be run, as :func:`corota.solve` takes it; the model's own steps by default.
            With steps the check starts the first increment, as ``corota check`` does.

        Returns
        -------
        Findings
            A list of :class:`corota.errors.Diagnostic`, errors first; printed as text.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section(element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
        >>> model.fix("left", y=None)
        >>> print(model.check().errors[0].message)
        a free body: it can move along y
        """
        return Findings(check_model(self, steps))

    def summary(self, steps: Step | Sequence[Step] | None = None) -> str:
        """Nodes, elements, sets, sections, supports, loads and steps as text.

        Parameters
        ----------
        steps : Step or sequence of Step, optional
            What will be run, as :func:`corota.solve` takes it; the model's own steps by default.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1), name="strip")
        >>> print(model.summary().splitlines()[0])
        strip: 22 nodes, 10 elements
        """
        return "\n".join(model_lines(self, steps))

    def __repr__(self) -> str:
        mesh = self.mesh
        return (
            f"Model({brief(self.name)}: {mesh.n_nodes:,} nodes, {mesh.n_cells:,} elements, "
            f"{len(self.sections)} sections, {len(self.supports)} supports, "
            f"{len(self.loads)} loads, {len(self.steps)} steps)"
        )

    def _repr_html_(self) -> str:
        mesh = self.mesh
        materials = {id(s.material): brief(s.material) for s in self.sections}
        rows = {
            "model": self.name,
            "nodes": f"{mesh.n_nodes:,}",
            "elements": f"{mesh.n_cells:,}",
            "sections": ", ".join(f"{s.element} in {brief(s.cells)}" for s in self.sections[:8]),
            "materials": ", ".join(list(materials.values())[:8]),
            "supports, loads": f"{len(self.supports)}, {len(self.loads)}",
            "steps": ", ".join(type(s).__name__ for s in self.steps[:8]),
            "contact pairs": len(self.contacts),
            "units": self.unit_system,
        }
        shown = {name: value for name, value in rows.items() if value}
        drawn = ""
        if mesh.n_cells <= CELLS_DRAWN:
            drawn = picture(lambda path: draw_model(self, path=path, dpi=80.0))
        return drawn + table(shown)

    def plot(self, **options: Any) -> Any:
        """Draw mesh, sets, supports, loads and contact; see :func:`corota.plots.model`."""
        return draw_model(self, **options)

    def _add_force(self, force: Force) -> None:
        self.loads += force.on(self.mesh)

    def _node(self, node: object) -> int:
        if isinstance(node, str):
            nodes = self.mesh.nodes_of(self.mesh.set_name(node))
            if len(nodes) != 1:
                raise InputError(f"one node is expected; {node!r} has {len(nodes)}")
            return int(nodes[0])
        return selection.one(node, "node", self.mesh.n_nodes)

    def _nodes(self, where: str | ArrayLike) -> str | Ints:
        if isinstance(where, str):
            name = self.mesh.set_name(where)
            if not len(self.mesh.nodes_of(name)):
                raise InputError(f"node set {name!r} is empty")
            return name
        return self.mesh.node_indices(where)

    def _cells(self, cells: str | ArrayLike) -> str | Ints:
        if isinstance(cells, str):
            if cells == "all" and cells not in self.mesh.cell_sets:
                return cells
            name = self.mesh.set_name(cells, "cell")
            if not len(self.mesh.cell_sets[name]):
                raise InputError(f"cell set {name!r} is empty")
            return name
        return self.mesh.cell_indices(cells)

    def _surface(self, where: str | ArrayLike) -> str | Ints:
        """An edge set, lines as one of the same name, or nodes."""
        mesh = self.mesh
        if isinstance(where, str):
            if where not in mesh.edge_sets and where in mesh.cell_sets:
                cells = mesh.cell_sets[where]
                if len(cells) and mesh.are_lines(cells).all():
                    mesh.edge_sets[where] = mesh.line_sides(cells)
            if where not in mesh.edge_sets and where in mesh.node_sets:
                return where
        elif np.ndim(where) == 1 and len(np.asarray(where)) and not isinstance(where[0], str):  # type: ignore[index]
            return self._nodes(where)
        return self._edges(where)

    def _edges(self, where: str | ArrayLike) -> str | Ints:
        if isinstance(where, str):
            name = self.mesh.set_name(where, "edge")
            if not len(self.mesh.edge_sets[name]):
                raise InputError(f"edge set {name!r} is empty")
            return name
        return self.mesh.edge_pairs(where)


class Findings(list["Diagnostic"]):
    """What a check found, errors first; ``print`` shows it as text."""

    @property
    def errors(self) -> list[Diagnostic]:
        """Findings that a run refuses."""
        return [d for d in self if d.severity == "error"]

    @property
    def warnings(self) -> list[Diagnostic]:
        """Findings that look wrong but do not stop a run."""
        return [d for d in self if d.severity == "warning"]

    def __str__(self) -> str:
        return "\n".join(str(d) for d in self)

    def __repr__(self) -> str:
        shown = "\n".join(str(d) for d in self[:FINDINGS_SHOWN])
        more = f"\n... {len(self) - FINDINGS_SHOWN} more" if len(self) > FINDINGS_SHOWN else ""
        return shown[:LONGEST] + more

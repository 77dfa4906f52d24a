"""A cell of a periodic body, driven by its mean deformation or stress.

Displacements of nodes that are one in the periodic body differ by ``H d``, with the mean
displacement gradient H and the vector d between them. The columns of H are displacements of two
reference nodes, over the size of the cell; their forces are the mean nominal stress
(first Piola-Kirchhoff) times area over size. Source: J. C. Michel, H. Moulinec, P. Suquet,
Comput. Methods Appl. Mech. Engrg 172 (1999) 109-143.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import cKDTree

from corota.analysis.linear.factor import Factor
from corota.analysis.terms.linearized import Linearized
from corota.cells.images import add_images, contact_nodes
from corota.cells.pairs import SAME, pair_nodes
from corota.cells.states import point_of
from corota.errors import InputError, UnsupportedError, number
from corota.mesh import add_node, merge, move
from corota.model import elements
from corota.model.blocks import blocks_of
from corota.model.constraints import Coupling, Equation
from corota.model.model import Model

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Bools, Floats, Ints
    from corota.cells.onset import Onset
    from corota.cells.waves import Waves
    from corota.model.sections import Section
    from corota.model.steps import Step
    from corota.results.results import Results

    Entries = Sequence[Sequence[float | None]]


class PeriodicCell:
    """One cell of a body that repeats itself along two vectors.

    Parameters
    ----------
    model : Model
        Of one cell, without supports: mesh, sections, contact, loads such as a pressure in a hole.
        It is copied. Surfaces meet within the cell and across its border. Opposite sides have the
        same nodes; the shape of the cell is any whose copies fill the body.
    vectors : array_like, shape (2, 2), optional
        Vectors of the lattice, one a row [length]; by default the sides of the rectangle around
        the mesh.
    depth : float, optional
        Extension out of the plane that stresses refer to [length]; by default the thickness of
        the sections, and 1 for line elements.

    Attributes
    ----------
    model : Model
        The cell with its equations and reference nodes, to be solved: set its gradient or stress
        by :meth:`drive`.
    base : Model
        The cell alone.
    around : Model
        The cell with images of its contact surfaces in the cells around it, see
        :mod:`corota.cells.images`.
    reference : tuple of int
        Nodes whose displacements over `size` are the columns of the mean displacement gradient.
    size : float
        Square root of the area of the cell [length].
    first, shift : ndarray of int
        Classes of nodes that are one, see :func:`corota.cells.pairs.pair_nodes`.

    Raises
    ------
    InputError
        If a node on a side of the cell has no partner, or the model has supports.

    Examples
    --------
    A bar of layers, soft and stiff in turn, stretched across them: the mean of the compliances.

    >>> import corota as ct
    >>> layers = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=2))
    >>> for cells, modulus in (([0], 1.0), ([1], 3.0)):
    ...     layers.section(cells, element="Q4", material=ct.Elastic(E=modulus, nu=0.0))
    >>> constants = ct.cells.elastic_constants(ct.PeriodicCell(layers).tangent())
    >>> print(f"{constants['E2']:.6f}")
    1.500000
    """

    def __init__(
        self, model: Model, vectors: ArrayLike | None = None, depth: float | None = None
    ) -> None:
        if model.supports or any(step.supports for step in model.steps):
            raise InputError("a periodic cell has no supports: drive() prescribes its gradient")
        if model.axes:
            raise UnsupportedError("nodes of a periodic cell have no local axes")
        self.base = model.copy()
        self.base.steps = []
        points = self.base.mesh.points
        box = np.diag(np.ptp(points, axis=0))
        self.vectors = np.asarray(box if vectors is None else vectors, dtype=np.float64)
        if self.vectors.shape != (2, 2) or not np.isfinite(self.vectors).all():
            raise InputError(f"the lattice has two vectors (x, y), not {vectors!r}")
        self.area = abs(float(np.linalg.det(self.vectors)))
        if not self.area > SAME * float(np.abs(self.vectors).max()) ** 2:
            raise InputError("the vectors of the lattice span no area")
        self.size = math.sqrt(self.area)
        own = _depth(self.base) if depth is None else depth
        self.depth = number(own, "the depth", above=0.0)
        classes = pair_nodes(self.base.mesh, self.vectors, contact_nodes(self.base))
        self.around, self.first, self.shift, repeated = add_images(
            self.base, self.vectors, *classes
        )
        self.model = self.around.copy()
        corner = points.min(axis=0)
        self.reference = (
            add_node(self.model.mesh, corner[0] + self.size, corner[1], "gradient x"),
            add_node(self.model.mesh, corner[0], corner[1] + self.size, "gradient y"),
        )
        self.model.constraints += self._equations(_nodes_with_rotation(self.base)[repeated])
        paired = np.flatnonzero(self.shift.any(axis=1))
        self.model.fix([int(self.first[paired[0]])])

    def _equations(self, rotating: Bools) -> list[Equation]:
        found = []
        distances = self.shift @ self.vectors / self.size
        for node in np.flatnonzero(self.first != np.arange(len(self.first))).tolist():
            first = int(self.first[node])
            for dof in range(2):
                terms = [(node, dof, 1.0), (first, dof, -1.0)]
                for reference, part in zip(self.reference, distances[node], strict=True):
                    if abs(part) > SAME * SAME:
                        terms.append((reference, dof, -float(part)))
                found.append(Equation(terms))
            if rotating[node] and rotating[first]:
                found.append(Equation([(node, 2, 1.0), (first, 2, -1.0)]))
        return found

    # -- load and response -------------------------------------------------------------

    def drive(
        self, gradient: Entries, stress: Entries | None = None, step: Step | None = None
    ) -> None:
        """Prescribe the mean displacement gradient, or the mean stress where it is ``None``.

        Parameters
        ----------
        gradient : nested sequence, shape (2, 2)
            ``H = F - 1`` at the end of a step; the first index is that of the displacement.
        stress : nested sequence, shape (2, 2), optional
            Nominal stress of the components that `gradient` leaves free; 0 by default.
        step : Step, optional
            Where it acts; in all steps by default, instead of what was prescribed before.

        Raises
        ------
        InputError
            If the cell could rotate: both shear components are free.
        """
        wanted = [list(row) for row in gradient]
        given = [[0.0, 0.0], [0.0, 0.0]] if stress is None else [list(row) for row in stress]
        if [len(row) for row in (*wanted, *given)] != [2, 2, 2, 2]:
            raise InputError("gradient and stress have the shape (2, 2)")
        if wanted[0][1] is None and wanted[1][0] is None:
            raise InputError(
                "the cell could rotate: prescribe one of the two shear components of its gradient"
            )
        place: Any = step
        if step is None:
            place = self.model
            place.supports = [s for s in place.supports if not self.drives(s)]
            place.loads = [load for load in place.loads if not self.drives(load)]
        for j, node in enumerate(self.reference):
            moved = [wanted[i][j] for i in range(2)]
            values = [None if v is None else self.size * number(v, "a gradient") for v in moved]
            if any(v is not None for v in values):
                place.fix([node], x=values[0], y=values[1])
            for i in range(2):
                value = number(given[i][j] or 0.0, "a stress")
                if value and moved[i] is not None:
                    raise InputError(f"component {i + 1}{j + 1} has both a gradient and a stress")
                if value:
                    force = value * self.area * self.depth / self.size
                    place.force([node], **{"xy"[i]: force})

    def drives(self, item: Any) -> bool:
        """Whether a support or load acts on a reference node."""
        nodes = np.atleast_1d(np.asarray(getattr(item, "nodes", getattr(item, "at", ""))))
        return nodes.dtype.kind in "iu" and bool(np.isin(nodes, self.reference).any())

    def gradient(self, results: Results, frame: int = -1) -> Floats:
        """Mean displacement gradient H of a frame, shape (2, 2)."""
        moved: Floats = results.frame(frame).U[list(self.reference)]
        out: Floats = moved.T / self.size
        return out

    def stress(self, results: Results, frame: int = -1) -> Floats:
        """Mean nominal stress of a frame, shape (2, 2) [stress].

        Force along the first index on a face whose normal before deformation is the second.
        """
        found = results.frame(frame)
        force: Floats = (found.RF + found.F)[list(self.reference), :2]
        out: Floats = force.T * self.size / (self.area * self.depth)
        return out

    def tangent(self, results: Results | None = None, frame: int = -1) -> Floats:
        """Derivative of the mean nominal stress by the mean gradient, shape (2, 2, 2, 2) [stress].

        Closed contact stays closed. Without `results` it is that of the unloaded cell.
        """
        point = point_of(self.model, results, frame)
        lin = Linearized(point.system, point.u, *point.contact, time=point.time)
        position = np.full(point.system.n_dofs, -1)
        position[lin.free] = np.arange(lin.nf)
        nodes = np.array(self.reference)
        driven = position[np.stack([point.system.dofs(nodes, c) for c in range(2)], axis=1)].ravel()
        rest = np.setdiff1d(lin.active, driven)
        k = lin.stiffness.tocsc()
        factor = Factor(
            k[rest][:, rest].tocsc(), lin.symmetric, lin.node[rest], lin.multiplier[rest], 1
        )
        side = k[rest][:, driven].toarray()
        whole = k[driven][:, driven].toarray() - k[driven][:, rest] @ factor.solve(side)
        whole *= self.size**2 / (self.area * self.depth)
        return np.asarray(whole.reshape(2, 2, 2, 2).transpose(1, 0, 3, 2))

    # -- waves ---------------------------------------------------------------------------

    def waves(
        self, results: Results | None = None, frame: int = -1, *, mass: str = "consistent"
    ) -> Waves:
        """Small waves about a state of the cell; of the unloaded one without `results`."""
        from corota.cells.waves import Waves

        return Waves(self, point_of(self.model, results, frame), mass)

    def onset(self, results: Results, waves: int | ArrayLike = 4) -> Onset:
        """First load at which a wave has no stiffness; see :func:`corota.cells.onset.find_onset`.

        Parameters
        ----------
        results : Results
            Of a static step of :attr:`model`.
        waves : int or array_like, shape (n, 2)
            Wave vectors in shares of the reciprocal lattice: ``(1/2, 1/2)`` has a period of two
            cells along both vectors. A number: all multiples of its inverse, up to sign.
        """
        from corota.cells.onset import find_onset

        return find_onset(self, results, waves)

    # -- several cells -------------------------------------------------------------------

    def repeat(self, n: int, m: int) -> PeriodicCell:
        """Join n x m cells to one.

        Sets of the same name are united, so that loads, contact and sections of sets act in all.

        Raises
        ------
        UnsupportedError
            If the model has parts that name nodes by their indices, besides couplings.
        """
        if n < 1 or m < 1:
            raise InputError(f"a cell is repeated at least once along both vectors, not {n} x {m}")
        base = self.base
        named = [*base.contacts, *base.ties, *base.loads]
        places = [getattr(i, k, "") for i in named for k in ("slave", "master", "nodes", "at")]
        others = (base.point_masses, base.dashpots, base.velocities, base.stages)
        if any(others) or not all(isinstance(place, str) for place in places):
            raise UnsupportedError(
                "repeat() copies sections and couplings, and loads and contact of named sets; add "
                "the rest to its base"
            )
        if any(not isinstance(c, Coupling) or isinstance(c.nodes, str) for c in base.constraints):
            raise UnsupportedError("repeat() copies couplings of node indices only")
        steps = [(i, j) for j in range(m) for i in range(n)]
        shifts = [self.vectors.T @ step for step in steps]
        mesh = merge(
            *(move(base.mesh, shift=(float(s[0]), float(s[1]))) for s in shifts),
            tolerance=SAME * self.size,
        )
        count = base.mesh.n_nodes
        if mesh.n_nodes != _count_nodes(self.first[:count], self.shift[:count], n, m):
            raise UnsupportedError("repeat() would merge nodes of a cell that are at one place")
        nodes = self.nodes_of_copies(mesh.points, shifts)
        model = Model(mesh, base.name)
        cells = _cells_of_copies(base, mesh, len(steps))
        for section in base.sections:
            model.sections.append(_copied(section, cells, nodes, mesh.n_nodes))
        model.contacts, model.ties, model.loads = [*base.contacts], [*base.ties], [*base.loads]
        model.amplitudes = dict(base.amplitudes)
        for item in base.constraints:
            assert isinstance(item, Coupling)
            for own in nodes:
                members = own[np.asarray(item.nodes)]
                model.constraints.append(
                    replace(item, nodes=members, reference=int(own[item.reference]))
                )
        vectors = self.vectors * [[n], [m]]
        return PeriodicCell(model, vectors, self.depth)

    def pattern(self, repeated: PeriodicCell, found: Onset) -> Floats:
        """Real part of a wave in several cells, as an imperfection of their base.

        Parameters
        ----------
        repeated : PeriodicCell
            Of :meth:`repeat`.
        found : Onset

        Returns
        -------
        ndarray, shape (n_nodes, 3)
            Displacements of the nodes of its base; the largest of the first cell is 1.
        """
        counts = np.rint(repeated.vectors @ np.linalg.inv(self.vectors)).astype(int).diagonal()
        steps = [(i, j) for j in range(counts[1]) for i in range(counts[0])]
        shifts = [self.vectors.T @ step for step in steps]
        out = np.zeros((repeated.base.mesh.n_nodes, 3))
        nodes = self.nodes_of_copies(repeated.base.mesh.points, shifts)
        for own, step in zip(nodes, steps, strict=True):
            out[own] = (np.exp(2j * math.pi * float(found.wave @ step)) * found.shape).real
        return out

    def nodes_of_copies(self, points: Floats, shifts: Sequence[Floats]) -> list[Ints]:
        """For each shifted copy of the cell the indices of its nodes among points."""
        tree: Any = cKDTree(points)
        found = []
        for shift in shifts:
            distance, index = tree.query(self.base.mesh.points + shift)
            if distance.max() > SAME * self.size:
                raise InputError("the points are not those of repeated cells")
            found.append(np.asarray(index, np.int64))
        return found


def _depth(model: Model) -> float:
    """The one thickness of the planar sections, 1 without any."""
    planar = [s for s in model.sections if not any(s.profile)]
    if any(s.nodal_thickness is not None for s in planar) or len({s.thickness for s in planar}) > 1:
        raise InputError("the sections have several thicknesses: give the depth of the cell")
    return float(planar[0].thickness) if planar else 1.0


def _nodes_with_rotation(model: Model) -> Bools:
    """Nodes whose elements have rotations, shape (n_nodes,)."""
    found = np.zeros(model.mesh.n_nodes, bool)
    for block in blocks_of(model):
        if elements.find(block.section.element).dofs_per_node > 2:
            found[block.nodes.ravel()] = True
    return found


def _count_nodes(first: Ints, shift: Ints, n: int, m: int) -> int:
    """Number of nodes of n x m copies of a cell."""
    steps = np.array([(i, j) for i in range(n) for j in range(m)])
    places = (shift[None] + steps[:, None]).reshape(-1, 2)
    rows = np.column_stack([np.tile(first, len(steps)), places])
    return len(np.unique(rows, axis=0))


def _cells_of_copies(base: Model, mesh: Any, count: int) -> list[Ints]:
    """Global indices of the cells of each copy in a merged mesh."""
    found = []
    for copy in range(count):
        parts = [
            np.arange(len(block)) + start + copy * len(block)
            for block, start in zip(base.mesh.cells, mesh.offsets, strict=False)
        ]
        found.append(np.concatenate(parts))
    return found


def _copied(section: Section, cells: list[Ints], nodes: list[Ints], count: int) -> Section:
    """A section of all copies."""
    where = section.cells
    if not isinstance(where, str):
        where = np.concatenate([own[np.asarray(where)] for own in cells])
    if section.nodal_thickness is None:
        return replace(section, cells=where)
    spread = np.ones(count)
    for own in nodes:
        spread[own] = section.nodal_thickness
    return replace(section, cells=where, nodal_thickness=spread)

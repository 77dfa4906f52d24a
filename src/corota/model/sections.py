"""Element type, material and thickness of cells."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location, number
from corota.mesh.parts import cells_of
from corota.model import elements
from corota.model.local_strain import LocalStrain, local_strain
from corota.model.materials import Material
from corota.names import choose

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh


#: State of the plane: no stress through the thickness, no strain there, a solid of revolution.
Plane = Literal["stress", "strain", "axisymmetric"]
PLANES: tuple[Plane, ...] = ("stress", "strain", "axisymmetric")


@dataclass(repr=False)
class Section(Brief):
    """Element type, material and thickness of a set of cells.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set, or global cell indices.
    element : str
        Element name (``Q4I``, ``Q4D``, ``OPT``, ...).
    material : Material
    thickness : float or array_like, shape (n_nodes,)
        Out-of-plane thickness [length], > 0; or that of every node of the mesh, interpolated
        with the shape functions of the elements. The attribute is then the mean.
    plane : {"stress", "strain", "axisymmetric"}
        Axisymmetric: a solid of revolution, x is the radius and y the axis; without a thickness.
    local_strain : {"linear", "logarithmic", "green_lagrange"}, optional
        Measure of the local displacement gradient. ``linear`` is the classical co-rotational one,
        for local strains of a few percent and the default of elastic bodies; ``logarithmic`` is
        for large strain, with plasticity or without, and the default of materials that flow;
        ``green_lagrange`` gives the St. Venant-Kirchhoff solid.
        ``simplified`` and ``modified``, the names of Cho et al. (2017), stand for the first two.
    orientation : float
        Angle of the material axes from the global ones in the reference [rad].
    profile : tuple of float
        Numbers of line elements: area, second moment, shear area; of springs the stiffness and
        the dofs of both ends.
    table : tuple of pairs of float
        Elongation (or angle) and force of nonlinear springs, rising; empty for linear ones.
    fibers : tuple of triples of float
        Distance from the axis, area and initial stress of the fibers of a beam, see
        :class:`corota.profiles.Profile`; plastic beams need them.
    height : float
        Height of the cross-section of a beam or truss in the plane [length], for contact; 0 for
        that of the rectangle with the same area and second moment.
    mean_dilatation : bool
        Replace the volume strain by its mean over each element: no volumetric locking in plastic
        or nearly incompressible plane strain and axisymmetry. Quadrilaterals only, not in plane
        stress.
    beta0 : float, optional
        Weight of the bending stiffness of OPT, > 0; by default the one that makes elastic bending
        exact. In plastic bending it is too stiff; see the page on plasticity.
    """

    cells: str | Ints
    element: str
    material: Material
    thickness: float = 1.0
    plane: Plane = "stress"
    local_strain: LocalStrain | None = None
    orientation: float = 0.0
    where: Location | None = field(default=None, compare=False, repr=False)
    mean_dilatation: bool = field(default=False, kw_only=True)
    beta0: float | None = field(default=None, kw_only=True)
    profile: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), kw_only=True)
    table: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)
    fibers: tuple[tuple[float, float, float], ...] = field(default=(), kw_only=True, repr=False)
    height: float = field(default=0.0, kw_only=True)
    #: Distance of the outer fibers of a beam from its axis [length], 0 if it is not known.
    fiber: float = field(default=0.0, kw_only=True, compare=False)
    #: Thickness of the nodes, where it is given for each.
    nodal_thickness: Floats | None = field(default=None, kw_only=True, compare=False, repr=False)

    @property
    def line_height(self) -> float:
        """Height of the cross-section of a beam or truss [length]; 0 where nothing tells it."""
        area, inertia, _ = self.profile
        if self.height or not area:
            return self.height
        return math.sqrt(12.0 * inertia / area)

    def __post_init__(self) -> None:
        self.check()

    def check(self) -> None:
        """Refuse what does not go together; also what was set after the section was made.

        Raises
        ------
        InputError
            If an analysis would be without meaning.
        """
        self.element = elements.find(self.element, self.where).name
        if not isinstance(self.material, Material):
            raise InputError(
                f"a section needs a material such as Elastic or Mises, not {self.material!r}",
                self.where,
            )
        self.plane = cast("Plane", choose(self.plane, PLANES, "plane state", self.where))
        needed = self.material.local_strain
        measure = local_strain(self.local_strain or self.material.default_strain, self.where)
        self.local_strain = cast("LocalStrain", measure)
        if needed and measure != needed:
            raise InputError(
                f"{type(self.material).__name__} is for local_strain={needed!r}, not {measure!r}: "
                "omit it",
                self.where,
            )
        if self.material.local_strain and elements.find(self.element).weighted:
            raise InputError(
                f"{self.element} is for local strains of a few percent: in a strip that is "
                "stretched to twice its length its strain is not uniform. For hyperelastic laws "
                "use T6",
                self.where,
            )
        if self.plane != "stress" and self.material.incompressible:
            shear = float(1.0 / self.material.compliance()[3, 3])
            raise InputError(
                "constant volume (D = 0) is for plane stress; else give the "
                f"compressibility: D1 = 2 / K, e.g. {0.002 / shear:.6g} for a bulk modulus K of "
                "1000 times the shear modulus, and an element that does not lock (Q4 with "
                "mean_dilatation, Q4S, Q8R)",
                self.where,
            )
        if self.local_strain == "green_lagrange" and self.material.flows:
            raise InputError(
                "the Green-Lagrange local strain is for elastic materials: with plastic flow it "
                "compares a true yield stress with the second Piola-Kirchhoff stress; use "
                "local_strain='logarithmic' (LOCAL STRAIN=LOGARITHMIC)",
                self.where,
            )
        element = elements.find(self.element)
        if element.stabilized and self.material.flows and not self.material.remembers:
            raise InputError(
                f"the hourglass of {element.name} would stay elastic under deformation plasticity "
                "and the part too stiff in bending: use Q4I or Q8R",
                self.where,
            )
        pairs = np.asarray(self.table, dtype=np.float64).reshape(-1, 2)
        rising = (np.diff(pairs[:, 0]) > 0.0).all() and len(pairs) != 1
        if not (np.isfinite(pairs).all() and rising):
            raise InputError(
                "a nonlinear spring needs at least two finite pairs of elongation and force, "
                "with increasing elongation",
                self.where,
            )
        if self.axisymmetric:
            self._check_axisymmetric()
        if np.ndim(self.thickness):
            self._set_nodal_thickness()
        self.thickness = number(self.thickness, "the thickness", self.where)
        self.orientation = number(self.orientation, "the orientation", self.where)
        if not self.thickness > 0.0:
            raise InputError(f"the thickness must be > 0, not {self.thickness}", self.where)
        if not np.isfinite(self.orientation):
            raise InputError(
                f"the orientation must be a finite angle, not {self.orientation}", self.where
            )
        if self.mean_dilatation and self.plane == "stress":
            raise InputError(
                "mean dilatation is for plane strain; in plane stress the thickness can change "
                "and nothing locks: omit it",
                self.where,
            )
        fact = elements.known(self.element)
        if self.mean_dilatation and fact and fact.n_internal_modes > 1:
            raise InputError(
                f"{self.element} does not lock because of its incompatible modes, which would "
                "have no stiffness with mean dilatation: omit it",
                self.where,
            )
        if self.mean_dilatation and not (
            fact and fact.cell.startswith("quad") and not fact.stabilized
        ):
            raise InputError(
                f"mean dilatation is for quadrilaterals, not {self.element}, whose volume strain "
                "is constant or nearly so already: use Q4I, Q8R or Q4D instead",
                self.where,
            )
        if self.beta0 is not None and not (
            fact and fact.weighted and np.isfinite(self.beta0) and self.beta0 > 0.0
        ):
            raise InputError(
                f"beta0 = {self.beta0} for {self.element}: only "
                f"{', '.join(elements.weighted_names())} has this weight, and it must be > 0",
                self.where,
            )

    @property
    def axisymmetric(self) -> bool:
        """Whether the cells are a solid of revolution."""
        return self.plane == "axisymmetric" and not elements.find(self.element).line

    def _check_axisymmetric(self) -> None:
        """Refuse what a solid of revolution cannot have."""
        element = elements.find(self.element)
        if not element.revolved:
            why = (
                "its drilling rotations bend the edges, and its strain is assumed for a plane"
                if element.drilling
                else "it has no hoop strain"
            )
            names = ", ".join(n for n in elements.names() if elements.find(n).revolved)
            raise InputError(
                f"{self.element} is not for axisymmetric bodies: {why}; use one of {names}",
                self.where,
            )
        if np.ndim(self.thickness) or self.thickness != 1.0:
            raise InputError(
                "an axisymmetric section has no thickness: forces, masses and energies are those "
                "of the whole circumference; omit it",
                self.where,
            )
        if not self.material.for_rings:
            raise InputError(
                f"a {type(self.material).__name__} gives the stress in the plane and no hoop "
                "stress: axisymmetric sections take the laws of the core",
                self.where,
            )

    def _set_nodal_thickness(self) -> None:
        given = np.array(self.thickness, dtype=np.float64)
        fact = elements.find(self.element)
        if given.ndim != 1 or fact.line:
            raise InputError(
                "a thickness by node is an array (n_nodes,) for planar elements, not "
                f"{given.shape} for {self.element}",
                self.where,
            )
        known = given[np.isfinite(given) & (given > 0.0)]
        self.nodal_thickness = given
        # Nodes of other sections need none.
        self.thickness = float(known.mean()) if len(known) else 0.0

    def thickness_at(self, nodes: Ints, points: Floats) -> Floats:
        """Thickness of nodes [length], of the shape of `nodes`; of a ring its circumference.

        `points` are the coordinates of all nodes, shape (n_nodes, 2).
        """
        if self.axisymmetric:
            return np.asarray(2.0 * np.pi * points[nodes, 0])
        if self.nodal_thickness is None:
            return np.full(np.shape(nodes), self.thickness)
        return np.asarray(self.nodal_thickness[nodes])


def thickness_at(
    mesh: Mesh, sections: Iterable[Section], cells: Ints, nodes: Ints, x: Floats | None = None
) -> Floats:
    """Thickness of nodes (n, k) [length] from the sections of cells (n,); 1 without one.

    Circumferences are those at the positions `x` (n_nodes, 2), by default the undeformed ones.
    """
    found, points = np.ones(nodes.shape), mesh.points if x is None else x
    for section in sections:
        mine = np.isin(cells, cells_of(mesh, section.cells))
        found[mine] = section.thickness_at(nodes[mine], points)
    return found

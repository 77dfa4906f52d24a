"""Trusses, beams and springs of a model: a part of :class:`corota.Model`."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError, number
from corota.mesh.parts import cells_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Ints
    from corota.mesh import Mesh
    from corota.model.materials import Material
    from corota.model.sections import Section
    from corota.profiles import Profile


class LineSections:
    """Line elements of :class:`corota.Model`."""

    mesh: Mesh
    sections: list[Section]

    if TYPE_CHECKING:  # a method of the whole

        def _cells(self, cells: str | ArrayLike) -> str | Ints: ...

    def truss(
        self, cells: str | ArrayLike, *, material: Material, area: float, height: float = 0.0
    ) -> None:
        """Make two-node lines bars that carry an axial force only.

        Parameters
        ----------
        cells : str or array_like of int, shape (n,)
        material : Elastic, Mises or JohnsonCook
        area : float
            Cross-section [length^2].
        height : float, optional
            Height of the cross-section in the plane [length]: where its surfaces come into contact.
        """
        self._line(cells, "TRUSS", material, (area, 0.0, 0.0), height)

    def beam(
        self,
        cells: str | ArrayLike,
        *,
        material: Material,
        profile: Profile | None = None,
        area: float | None = None,
        inertia: float | None = None,
        shear_area: float | None = None,
        height: float = 0.0,
    ) -> None:
        """Make two-node lines straight beams; their nodes get a rotation.

        Parameters
        ----------
        cells : str or array_like of int, shape (n,)
        material : Elastic, Mises or JohnsonCook
        profile : Profile, optional
            Cross-section, such as ``ct.profiles.rectangle(2.0, 10.0)``; plastic beams need one.
            Instead of it:
        area : float, optional
            Cross-section [length^2].
        inertia : float, optional
            Second moment of the cross-section [length^4].
        shear_area : float, optional
            Shear area [length^2]; 0, the default without a profile, for no shear deformation.
        height : float, optional
            Height of the cross-section in the plane [length]: where its surfaces come into contact.
            By default that of the profile, or of the rectangle with this area and second moment.

        Raises
        ------
        InputError
            If numbers are missing or outside their range.
        """
        fibers: tuple[tuple[float, float, float], ...] = ()
        fiber = 0.0
        if profile is not None:
            if area is not None or inertia is not None:
                raise InputError("give a beam either a profile, or its area and inertia")
            area, inertia = profile.area, profile.inertia
            shear_area = profile.shear_area if shear_area is None else shear_area
            height, fiber = height or profile.height, profile.fiber
            fibers = profile.rows
        if area is None or inertia is None:
            raise InputError("a beam needs a profile, or its area and inertia")
        shear_area = shear_area or 0.0
        if not (np.isfinite(inertia) and inertia > 0.0 and 0.0 <= shear_area < np.inf):
            raise InputError(
                f"a beam needs inertia > 0 and shear_area >= 0, not {inertia} and {shear_area}"
            )
        if not (material.linear or fibers):
            raise InputError(
                "a plastic beam needs the shape of its cross-section: "
                "profile=ct.profiles.rectangle(width, height), or another one"
            )
        self._line(cells, "BEAM", material, (area, inertia, shear_area), height, fibers, fiber)

    def spring(self, cells: str | ArrayLike, stiffness: ArrayLike, dofs: str | None = None) -> None:
        """Make lines or points springs.

        Parameters
        ----------
        cells : str or array_like of int, shape (n,)
            Two-node lines, or points for springs to the ground.
        stiffness : float or array_like, shape (m, 2)
            Force per length, or moment per angle; or pairs of elongation and force, with the
            force constant outside.
        dofs : str, optional
            Fixed directions that the spring joins: ``"x"``, ``"y"`` or ``"rotation"``, or two of
            them for the two nodes; the elongation is the displacement of the first node minus that
            of the second. By default it acts along the line of its nodes.
        """
        from corota.model.dofs import dof_indices
        from corota.model.materials import Elastic
        from corota.model.sections import Section

        given = np.asarray(stiffness, dtype=np.float64)
        if given.ndim not in (0, 2) or (given.ndim and given.shape[1] != 2):
            raise InputError(f"a stiffness, or pairs of elongation and force, not {stiffness!r}")
        if not np.isfinite(given).all():
            raise InputError(f"the stiffness of a spring must be finite, not {stiffness!r}")
        value = float(given) if given.ndim == 0 else 0.0
        pairs = [] if given.ndim == 0 else given.tolist()
        name, ends = "SPRING", (0, 0)
        if dofs is not None:
            chosen = dof_indices(dofs)
            ends = (chosen[0], chosen[-1])
            found = self._cells(cells)
            every = cells_of(self.mesh, found)
            kinds = {self.mesh.cells[self.mesh.locate(int(c))[0]].kind for c in every}
            name = ("SPRING1" if kinds == {"point1"} else "SPRING2") + "R" * (2 in ends)
        table = tuple((e, f) for e, f in pairs)
        self.sections.append(
            Section(self._cells(cells), name, Elastic(E=1.0), profile=(value, *ends), table=table)
        )

    def _line(
        self,
        cells: str | ArrayLike,
        element: str,
        material: Material,
        profile: tuple[float, float, float],
        height: float,
        fibers: tuple[tuple[float, float, float], ...] = (),
        fiber: float = 0.0,
    ) -> None:
        from copy import deepcopy

        from corota.model.sections import Section

        number(profile[0], "the area", above=0.0)
        number(height, "the height of a section", least=0.0)
        where, law = self._cells(cells), deepcopy(material)
        found = Section(
            where,
            element,
            law,
            profile[0],
            profile=profile,
            height=height,
            fibers=fibers,
            fiber=fiber,
        )
        self.sections.append(found)

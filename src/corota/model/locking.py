"""Elements that lock in their use: nearly incompressible, or too few in a slender part."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.errors import Diagnostic
from corota.mesh.kinds import EDGES
from corota.mesh.parts import cells_of, part_of_cells
from corota.model import elements
from corota.model.local_strain import ADVICE
from corota.model.material_table import MaterialTable
from corota.model.materials import Elastic

if TYPE_CHECKING:
    from corota.mesh.data import Mesh
    from corota.model.model import Model
    from corota.model.sections import Section
    from corota.model.steps import Step

#: Cells up to which a run looks for elements that lock.
MOST_CELLS = 100_000
#: Squared outline over area above which a part counts as slender (a strip 4 times its width).
SLENDER = 25.0


def locking(model: Model) -> list[Diagnostic]:
    """Sections whose elements lock, as :func:`corota.check.check` finds them, before a run.

    Meshes of more than :data:`MOST_CELLS` are left to the check.
    """
    if model.mesh.n_cells > MOST_CELLS:
        return []
    return [
        diagnostic
        for section in model.sections
        for diagnostic in locking_in(
            model.mesh, section, cells_of(model.mesh, section.cells), model.steps
        )
        if diagnostic.severity == "warning"
    ]


def locking_in(mesh: Mesh, section: Section, cells: Ints, steps: list[Step]) -> list[Diagnostic]:
    """Warnings and notes about the elements of a section."""
    found = []
    name = section.element
    material = section.material
    if isinstance(material, MaterialTable):
        material = max((m for _, m in material.table), key=lambda m: getattr(m, "nu", 0.0))
    element = elements.find(name)
    state = "axisymmetry" if section.axisymmetric else "plane strain"
    ratio = material.nu if isinstance(material, Elastic) else 0.0
    if material.local_strain:
        compliance = material.compliance()
        ratio = float(-compliance[0, 1] / compliance[0, 0])
    if (
        section.plane != "stress"
        and ratio > 0.49
        and not element.free_volume
        and not section.mean_dilatation
    ):
        found.append(
            Diagnostic(
                "warning",
                f"{name} locks in {state} at Poisson's ratio {ratio:.6g}",
                section.where,
                hint="use Q4S or Q8R, or the mean dilatation (DILATATION=MEAN) of quadrilaterals",
            )
        )
    if (
        section.local_strain != "logarithmic"
        and material.default_strain == "logarithmic"
        and any(s.nlgeom for s in steps)
    ):
        found.append(
            Diagnostic(
                "note",
                f"{material.name or 'a material'} may flow under the {section.local_strain} local "
                f"strain. {ADVICE}",
                section.where,
            )
        )
    if element.bending_cells:
        found += _bending(mesh, section, cells)
    return found


def outlines(mesh: Mesh) -> tuple[Ints, Floats, Floats]:
    """Part of each cell, and outline [length] and area of each part, shape (n_parts,)."""
    part = part_of_cells(mesh)
    outline = np.zeros(part.max(initial=-1) + 1)
    edges = mesh.boundary_edges()
    for cell, nodes in zip(edges[:, 0], mesh.edge_nodes(edges), strict=True):
        outline[part[cell]] += math.dist(mesh.points[nodes[0]], mesh.points[nodes[1]])
    area: Floats = np.bincount(part, area_of_cells(mesh), len(outline)).astype(float)
    return part, outline, area


def _bending(mesh: Mesh, section: Section, cells: Ints) -> list[Diagnostic]:
    part, outline, areas = outlines(mesh)
    area = area_of_cells(mesh)
    name = section.element
    element = elements.find(name)
    triangle = element.n_nodes == 3
    for number in distinct(part[cells]):
        mine = cells[part[cells] == number]
        if outline[number] ** 2 < SLENDER * areas[number]:
            continue
        width = 2.0 * areas[number] / outline[number]
        factor = 2.0 if triangle else 1.0
        size = float(np.sqrt(factor * area[mine].mean()))
        if width < element.bending_cells * size:
            better = "OPT or T6" if triangle else "Q4I or Q4D"
            return [
                Diagnostic(
                    "warning",
                    f"{name} is too stiff in bending: about {max(width / size, 1.0):.1f} cells "
                    f"through the width of the part of element {mesh.cell_labels[mine[0]]}",
                    section.where,
                    hint=f"use {better}, or at least {element.bending_cells} cells",
                )
            ]
    return []


def area_of_cells(mesh: Mesh) -> Floats:
    """Area of each cell by its corners, shape (n_cells,) [length^2]; 0 of lines."""
    parts = [np.zeros(0)]
    for block in mesh.cells:
        if not EDGES[block.kind]:
            parts.append(np.zeros(len(block)))
            continue
        count = 3 if block.kind.startswith("tri") else 4
        x, y = mesh.points[block.nodes[:, :count]].transpose(2, 0, 1)
        parts.append(0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum(axis=1))
    return np.concatenate(parts)

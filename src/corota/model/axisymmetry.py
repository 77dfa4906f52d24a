"""Solids of revolution: x is the radius, y the axis; what a model of them may have.

Sections in plane stress beside rings are what interrupts the circumference, such as ribs or the
webs between holes; their thickness is that of all of them together. A ring has one rigid motion,
along the axis: nodes on the axis and bodies without deformation are guided along it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import ModelError
from corota.mesh.parts import cells_of, nodes_of_cells
from corota.model import elements
from corota.model.constraints import Coupling, StraightLine
from corota.model.contact import RigidCurve
from corota.model.loads import BodyForce, EdgeLoad

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.arrays import Ints
    from corota.model.model import Model
    from corota.model.sections import Section


#: Radius that counts as zero, relative to the largest coordinate.
ON_AXIS = 1e-9


def is_axisymmetric(model: Model) -> bool:
    """Whether the model is a solid of revolution.

    Raises
    ------
    ModelError
        If only a part of it is.
    """
    rings = [s for s in model.sections if s.axisymmetric]
    if not rings:
        return False
    for section in model.sections:
        element = elements.find(section.element)
        if section.axisymmetric or element.spring:
            continue
        if element.line:
            what = f"{section.element} elements would need a hoop strain, which lines have not"
        elif section.plane == "strain" and _joined(model, section, rings):
            what = "a section in plane strain has no end around the axis; take plane stress"
        else:
            continue
        raise ModelError(
            "an axisymmetric model takes axisymmetric sections, springs, and plane stress for what "
            f"interrupts the circumference: {what}",
            section.where,
        )
    return True


def _joined(model: Model, section: Section, rings: list[Section]) -> bool:
    """Whether a section has nodes of rings."""
    mesh = model.mesh
    nodes = [nodes_of_cells(mesh, cells_of(mesh, s.cells)) for s in (section, *rings)]
    return bool(np.isin(nodes[0], np.concatenate(nodes[1:])).any())


def in_the_plane(model: Model) -> list[Section]:
    """Sections of bodies that are no rings."""
    found = [s for s in model.sections if not s.axisymmetric]
    return [
        s for s in found if not (elements.find(s.element).line or elements.find(s.element).spring)
    ]


def nodes_on_axis(model: Model) -> Ints:
    """Nodes of the elements on the axis.

    Raises
    ------
    ModelError
        Naming a node with a negative radius.
    """
    mesh = model.mesh
    radius = mesh.points[:, 0]
    tolerance = ON_AXIS * float(np.abs(mesh.points).max(initial=0.0))
    found = [np.zeros(0, np.int64)]
    for section in model.sections:
        if not section.axisymmetric:
            continue
        nodes = nodes_of_cells(mesh, cells_of(mesh, section.cells))
        low = nodes[radius[nodes] < -tolerance]
        if len(low):
            raise ModelError(
                f"node {mesh.node_labels[low[0]]} has the negative radius x = "
                f"{radius[low[0]]:g}: x is the radius of an axisymmetric model, y its axis; move "
                "the mesh to x >= 0",
                section.where,
            )
        found.append(nodes[radius[nodes] <= tolerance])
    return np.unique(np.concatenate(found))


def guided(model: Model) -> list[tuple[Ints, int]]:
    """Nodes and the dof of each that is zero.

    The radius on the axis; of bodies without deformation the radius and the rotation.
    """
    references = [c.reference for c in model.constraints if isinstance(c, Coupling)]
    curves = [pair.master for pair in model.contacts if isinstance(pair.master, RigidCurve)]
    references += [c.turning_node for c in curves if c.turning_node is not None]
    bodies = np.unique(np.asarray(references, np.int64))
    axis = np.setdiff1d(nodes_on_axis(model), bodies)
    return [(axis, 0), (bodies, 0), (bodies, 2)]


def check_constraints(model: Model) -> None:
    """Refuse constraints that an axisymmetric model cannot have.

    Raises
    ------
    ModelError
    """
    if model.stages:
        raise ModelError(
            "a stage moves in the plane and turns in it; a ring moves along its axis only: take "
            "displacements and reactions of a node set"
        )
    mesh = model.mesh
    found = [cells_of(mesh, s.cells) for s in in_the_plane(model)]
    ribs = nodes_of_cells(mesh, np.concatenate([np.zeros(0, np.int64), *found]))
    for item in model.constraints:
        if isinstance(item, Coupling) and np.isin(mesh.node_indices(item.nodes), ribs).any():
            raise ModelError(
                "a coupling of an axisymmetric model moves along the axis only: it holds nodes of "
                "rings, not those of sections in the plane",
                item.where,
            )
        if isinstance(item, StraightLine):
            raise ModelError(
                "a straight line of nodes that turns is no motion of a ring: use equations",
                item.where,
            )
        if isinstance(item, Coupling) and item.kind == "distributing":
            raise ModelError(
                "a distributing coupling would share a force over a circumference that depends on "
                "the radius: use a pressure or traction, or a kinematic coupling",
                item.where,
            )


def check_loads(loads: Iterable[object]) -> None:
    """Refuse loads that would not be the same around the axis.

    Raises
    ------
    ModelError
    """
    for item in loads:
        if isinstance(item, EdgeLoad) and item.kind == "electrostatic":
            raise ModelError(
                "an electrostatic load is that of plates in a plane: between rings the field is "
                "another one",
                item.where,
            )
        if not isinstance(item, BodyForce):
            continue
        if item.kind == "gravity" and item.value[0] != 0.0:
            raise ModelError(
                f"gravity of an axisymmetric model is along the axis y; x is the radius, and "
                f"{item.value[0]:g} along it would not be the same around the axis",
                item.where,
            )
        if item.kind == "centrifugal" and item.value[1] != 0.0:
            raise ModelError(
                "an axisymmetric model turns about its axis: the point of the centrifugal load "
                f"has x = 0, not {item.value[1]:g}",
                item.where,
            )

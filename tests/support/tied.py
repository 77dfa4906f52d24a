"""Small models with one constraint of every kind."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import SOLVERS

if TYPE_CHECKING:
    from corota.mesh import Mesh

KINDS = ("rigid", "kinematic x", "distributing", "equations", "rigid in axes", "chain", "straight")


def with_nodes(mesh: Mesh, *points: tuple[float, float]) -> Mesh:
    """The mesh with more nodes, which belong to no element."""
    every = np.vstack([mesh.points, points])
    return replace(mesh, points=every, node_labels=np.arange(1, len(every) + 1))


def beam(nx: int = 3, ny: int = 2, element: str = "Q4D") -> tuple[ct.Model, int]:
    """A block of 2 x 1 with two loose nodes; the index of the first of them."""
    mesh = with_nodes(ct.mesh.rectangle(2.0, 1.0, nx=nx, ny=ny), (3.0, 0.7), (3.5, 0.2))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3))
    return model, mesh.n_nodes - 2


def constrained(kind: str, element: str = "Q4D") -> tuple[ct.Model, int]:
    """A block whose right edge has a constraint, and the reference node."""
    model, reference = beam(element=element)
    right = model.mesh.nodes_of("right")
    if kind == "rigid":
        model.rigid("right", reference)
    elif kind == "kinematic x":
        model.couple("right", reference, dofs="x")
    elif kind == "distributing":
        model.couple("right", reference, kind="distributing")
    elif kind == "equations":
        model.equation((right[0], "x", 1.0), (right[1], "x", -2.0), (reference, "y", 0.5))
        model.equation((right[1], "x", 1.0), (right[2], "y", -2.0), rhs=0.01)
    elif kind == "rigid in axes":
        model.local_axes("right", angle=0.3)
        model.local_axes([reference], angle=-0.7)
        model.rigid("right", reference)
    elif kind == "straight":
        # The reference rides on the edge's end, so that the line has a master that depends too.
        model.local_axes(right[1:2], angle=0.4)
        model.local_axes(right[:1], angle=-0.5)
        model.straight([right[1], reference + 1], right[0], right[2])
        model.mesh.points[reference + 1] = [2.0, 1.6]
        model.equation((reference, "x", 1.0), (right[1], "x", 0.5), (right[2], "y", -0.2))
        model.equation((reference, "y", 1.0), (right[1], "y", 0.5))
        model.equation((reference + 1, "y", 1.0), (right[2], "y", -1.0), (right[0], "x", 0.3))
    elif kind == "chain":
        model.couple("right", reference, kind="distributing")
        model.rigid([reference + 1], reference)
        model.local_axes(right[:1], angle=0.4)
        top = model.mesh.nodes_of("top")[1]
        model.equation((top, "y", 1.0), (reference + 1, "y", -0.3), (right[1], "x", 0.2))
    return model, reference


def system_of(model: ct.Model) -> System:
    """The system of a model, with finite rotations."""
    system = System(model, SOLVERS["multifrontal"](), 1)
    system.constraints.set_nlgeom(True)
    return system

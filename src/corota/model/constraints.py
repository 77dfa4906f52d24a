"""Constraints of a model: dependent degrees of freedom, eliminated by the analysis."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location, ModelError
from corota.names import choose_attribute
from corota.renamed import accept_old_names

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh


@dataclass(repr=False)
class Equation(Brief):
    """A linear relation ``sum coefficient * dof = rhs``; its first term is eliminated.

    Parameters
    ----------
    terms : list of tuple (int, int, float)
        Node index, dof (0 and 1 displacement, 2 rotation) and coefficient. Dofs of nodes with
        local axes are those along the axes.
    rhs : float
        Right-hand side [length or rad], active from the start of the analysis.
    """

    terms: list[tuple[int, int, float]]
    rhs: float = 0.0
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not self.terms:
            raise InputError("an equation needs at least one term", self.where)
        if not np.isfinite([c for *_, c in self.terms] + [self.rhs]).all():
            raise InputError("the numbers of an equation must be finite", self.where)
        first = (int(self.terms[0][0]), int(self.terms[0][1]))
        total = sum(c for n, d, c in self.terms if (int(n), int(d)) == first)
        if total == 0.0:
            raise InputError(
                "the first term of an equation is eliminated: its coefficient must not be zero",
                self.where,
            )


@dataclass(repr=False)
class Coupling(Brief):
    """Nodes that move with a reference node, or a reference node that follows nodes.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set, or node indices.
    reference : int
        Reference node; it gets a rotation if it has none.
    kind : {"kinematic", "distributing"}
        ``kinematic``: the chosen dofs of `nodes` follow the rigid motion of the reference
        node, in any rotation. ``distributing``: the chosen dofs of the reference node follow
        the weighted mean motion of `nodes`; a load there is distributed over them.
    dofs : tuple of int
        Coupled dofs: 0 and 1 displacement, 2 rotation.
    weights : ndarray, shape (n,), or None
        Weights of a distributing coupling [1], > 0; equal by default.
    """

    nodes: str | Ints
    reference: int
    kind: Literal["kinematic", "distributing"] = "kinematic"
    dofs: tuple[int, ...] = (0, 1, 2)
    weights: Floats | None = None
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not self.dofs or not set(self.dofs) <= {0, 1, 2}:
            raise InputError("the dofs of a coupling are 0, 1 and 2", self.where)
        choose_attribute(self, "kind", ("kinematic", "distributing"), "coupling", self.where)
        if self.weights is not None:
            self.weights = np.asarray(self.weights, dtype=np.float64)
            if not (np.isfinite(self.weights).all() and (self.weights > 0.0).all()):
                raise InputError("the weights of a coupling must be > 0", self.where)


@accept_old_names(centre="center")
@dataclass(repr=False)
class LocalAxes(Brief):
    """Local axes of nodes for their supports, forces and equations.

    Parameters
    ----------
    nodes : str or array_like of int
    angle : float
        Angle of the first axis from the global one [rad].
    center : tuple of float or None
        If given, the axes are radial and circumferential about this point [length], in the
        reference configuration, and `angle` is added.
    """

    nodes: str | Ints
    angle: float = 0.0
    center: tuple[float, float] | None = None
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        if not np.isfinite([self.angle, *(self.center or ())]).all():
            raise InputError("the angle and the center of local axes must be finite", self.where)


def local_axes(mesh: Mesh, given: Sequence[LocalAxes]) -> dict[int, Floats]:
    """Axes (columns) of the nodes with local axes; the last definition counts."""
    axes: dict[int, Floats] = {}
    for item in given:
        for node in mesh.node_indices(item.nodes).tolist():
            angle = item.angle
            if item.center is not None:
                arm = mesh.points[node] - np.asarray(item.center)
                if not np.any(arm):
                    label = mesh.node_labels[node]
                    raise ModelError(
                        f"node {label} lies at the center of its axes and has no radial "
                        "direction; leave it out",
                        item.where,
                    )
                angle += float(np.arctan2(arm[1], arm[0]))
            c, s = np.cos(angle), np.sin(angle)
            axes[node] = np.array([[c, -s], [s, c]])
    return axes


@dataclass(repr=False)
class StraightLine(Brief):
    """Nodes that stay on the straight line through two others, in any motion of these.

    They may slide along it. Each loses the displacement along its axis that is further from
    the line at the start; the line may rotate until it is parallel to that axis.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set, or node indices; both ends are excluded.
    first, last : int
        The nodes that define the line, at different positions.
    """

    nodes: str | Ints
    first: int
    last: int
    where: Location | None = field(default=None, compare=False, repr=False)


Constraint = Equation | Coupling | StraightLine

"""Parameters of a model that gradients are taken by."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError, UnsupportedError
from corota.gradients.adjoint import Adjoint, Field
from corota.model import elements

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.gradients.trajectory import Trajectory
    from corota.model.model import Model


class Parameter(ABC):
    """Numbers of a model that are varied one by one.

    The residual of the varied model is evaluated at the state of the run: all that depends on
    the parameter is included, whatever it is.
    """

    @abstractmethod
    def values(self, model: Model) -> Floats:
        """Present values of the parameters."""

    @abstractmethod
    def vary(self, model: Model, index: int, change: float) -> Model:
        """A copy of the model with one of them changed."""

    def sizes(self, model: Model) -> Floats:
        """Sizes of the parameters, over which forces are smooth."""
        values = np.abs(np.ravel(self.values(model)))
        most = float(values.max(initial=0.0)) or 1.0
        return np.where(values > 0.0, values, most)


def _copy(model: Model) -> Model:
    """A copy that shares all but the lists and the mesh's points."""
    other = copy(model)
    for name in ("sections", "loads", "supports"):
        setattr(other, name, list(getattr(model, name)))
    return other


@dataclass
class Constant(Parameter):
    """A constant of the material of a section, such as ``E`` of `Elastic`.

    Parameters
    ----------
    name : str
        Attribute of the material.
    section : int
        Index of the section in the model.
    """

    name: str
    section: int = 0

    def _material(self, model: Model) -> Any:
        if not 0 <= self.section < len(model.sections):
            raise InputError(f"no section {self.section}; there are {len(model.sections)}")
        material = model.sections[self.section].material
        value = getattr(material, self.name, None)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError(f"{type(material).__name__} has no number {self.name!r}")
        return material

    def values(self, model: Model) -> Floats:
        return np.array(float(getattr(self._material(model), self.name)))

    def vary(self, model: Model, index: int, change: float) -> Model:
        old, other = self._material(model), _copy(model)
        new = replace(old, **{self.name: getattr(old, self.name) + change})
        other.sections = [
            replace(s, material=new) if s.material is old else s for s in other.sections
        ]
        return other


@dataclass
class Orientation(Parameter):
    """Angle of the material axes of a section [rad].

    Parameters
    ----------
    section : int
    """

    section: int = 0

    def values(self, model: Model) -> Floats:
        return np.array(float(model.sections[self.section].orientation))

    def sizes(self, model: Model) -> Floats:
        return np.ones(1)

    def vary(self, model: Model, index: int, change: float) -> Model:
        other = _copy(model)
        old = other.sections[self.section]
        other.sections[self.section] = replace(old, orientation=old.orientation + change)
        return other


class Attribute(Parameter):
    """Any numbers of a model, by functions that read and write them.

    Parameters
    ----------
    read : callable
        Gives the values of a model.
    write : callable
        ``write(model, values)`` sets them; `model` is a copy whose lists `sections`, `loads` and
        `supports` are its own, but not their items: put changed copies into the lists.
    size : float, optional
        Size of the numbers, over which forces are smooth; by default their largest.

    Examples
    --------
    The third load:

    >>> from dataclasses import replace
    >>> from corota import gradients
    >>> def write(model, values):
    ...     model.loads[2] = replace(model.loads[2], value=values[0])
    >>> load = gradients.Attribute(lambda model: [model.loads[2].value], write)
    """

    def __init__(
        self,
        read: Callable[[Model], ArrayLike],
        write: Callable[[Model, Floats], Any],
        size: float | None = None,
    ) -> None:
        self.read, self.write, self.size = read, write, size

    def values(self, model: Model) -> Floats:
        return np.asarray(self.read(model), dtype=float)

    def sizes(self, model: Model) -> Floats:
        """The given size, or that of the largest value."""
        if self.size is None:
            return super().sizes(model)
        return np.full(self.values(model).size, float(self.size))

    def vary(self, model: Model, index: int, change: float) -> Model:
        values = self.values(model).copy()
        values.reshape(-1)[index] += change
        other = _copy(model)
        self.write(other, values)
        return other


class Shape(Parameter):
    """Parameters of the shape: they move the nodes of the mesh.

    Loads, masses and constraints follow the nodes.

    Parameters
    ----------
    motion : array_like, shape (k, n_nodes, 2), or callable
        Change of the positions by each parameter, at the present shape; or a function that gives
        the positions of all nodes, shape (n_nodes, 2), for parameters of shape (k,).
    at : array_like, shape (k,), optional
        Present values of the parameters, of a function.
    """

    def __init__(
        self, motion: ArrayLike | Callable[[Floats], ArrayLike], at: ArrayLike | None = None
    ) -> None:
        self.function: Callable[[Floats], ArrayLike] | None = None
        if callable(motion):
            if at is None:
                raise InputError("a shape by a function needs the present parameters: at=")
            self.function, self.at = motion, np.asarray(at, dtype=float)
        else:
            self.motion = np.asarray(motion, dtype=float)
            if self.motion.ndim != 3 or self.motion.shape[2] != 2:
                raise InputError("the motion of a shape has the shape (k, n_nodes, 2)")
            self.at = np.zeros(len(self.motion))

    def values(self, model: Model) -> Floats:
        return self.at

    def sizes(self, model: Model) -> Floats:
        """Changes that move a node by the size of a cell, about."""
        if self.function is not None:
            return super().sizes(model)
        length = float(np.ptp(model.mesh.points, axis=0).max())
        most = np.abs(self.motion).max(axis=(1, 2))
        return length / np.where(most > 0.0, most, 1.0)

    def vary(self, model: Model, index: int, change: float) -> Model:
        points = model.mesh.points
        if self.function is None:
            if self.motion.shape[1] != len(points):
                raise InputError(
                    f"the motion moves {self.motion.shape[1]} nodes; the mesh has {len(points)}"
                )
            moved = points + change * self.motion[index]
        else:
            at = self.at.astype(float).copy()
            at.reshape(-1)[index] += change
            moved = np.asarray(self.function(at), dtype=float)
        other = _copy(model)
        other.mesh = replace(model.mesh, points=moved)
        return other


@dataclass
class Positions(Field):
    """Coordinates of all nodes: gradient of shape (n_nodes, 2).

    For shape parameters multiply it by the derivatives of the positions. Loads, masses and
    constraints that depend on positions are refused: `Shape` includes them.
    """

    def wanted(self) -> str:
        return "positions"

    def gather(self, trajectory: Trajectory, found: dict[str, Any]) -> Floats:
        return np.array(found["positions"])

    def require(self, trajectory: Trajectory, adjoint: Adjoint) -> None:
        model = trajectory.model
        what = ""
        if trajectory.system.conditions.distributed.loads:
            what = "loads of edges and bodies"
        elif model.constraints or model.axes:
            what = "constraints and local axes"
        elif model.contacts or model.ties:
            what = "contact and ties"
        if what:
            raise UnsupportedError(
                f"the gradient by positions does not include {what}, which depend on them: take "
                "gradients.Shape, which does"
            )


#: Elements whose strain depends on the slopes of a thickness by node.
_BY_SLOPE = ("Q4R", "OPT")


@dataclass
class Thickness(Field):
    """Thickness of the elements of all sections, or of some cells.

    Parameters
    ----------
    by : {"element", "node", "section"}
        What has a thickness of its own: gradient of shape (n_cells,), (n_nodes,) or (n_sections,).
        Of nodes it is interpolated within the elements.
    """

    by: str = "element"

    def __post_init__(self) -> None:
        if self.by not in ("element", "node", "section"):
            raise InputError(f"a thickness is by element, node or section, not by {self.by!r}")

    def wanted(self) -> str:
        return "thickness"

    def gather(self, trajectory: Trajectory, found: dict[str, Any]) -> Floats:
        system, model = trajectory.system, trajectory.model
        count = {
            "element": model.mesh.n_cells,
            "node": model.mesh.n_nodes,
            "section": len(model.sections),
        }[self.by]
        out = np.zeros(count)
        index = {id(section): k for k, section in enumerate(model.sections)}
        for number, (block, own) in enumerate(zip(system.blocks, found["thickness"], strict=True)):
            if self.by == "node":
                shape = system.core.shape(number).reshape(own.shape[1], -1)
                np.add.at(out, block.nodes, own @ shape)
            elif self.by == "element":
                out[block.cells] += own.sum(axis=1)
            else:
                out[index[id(block.section)]] += own.sum()
        return out

    def require(self, trajectory: Trajectory, adjoint: Adjoint) -> None:
        """Refuse what acts on the thickness in other ways: loads on edges, slopes of nodes."""
        for section in (block.section for block in trajectory.system.blocks):
            by_node = self.by == "node" or section.nodal_thickness is not None
            if by_node and section.element in _BY_SLOPE:
                raise UnsupportedError(
                    f"{section.element} depends on the slopes of a thickness by node, which have "
                    "no gradient: take Q4I, Q8 or T6, or gradients.Attribute"
                )
        model, what = trajectory.model, ""
        sections = (block.section for block in trajectory.system.blocks)
        if all(s.axisymmetric or elements.find(s.element).line for s in sections):
            raise UnsupportedError(
                "line elements and solids of revolution have no thickness: take "
                "gradients.Attribute or value_and_grad for their cross-sections"
            )
        if trajectory.system.conditions.distributed.loads:
            what = "loads of edges and bodies"
        elif model.contacts or model.ties:
            what = "contact and ties"
        if what:
            raise UnsupportedError(
                f"the gradient by thickness does not include {what}, which act on it: take "
                "gradients.Attribute, which does"
            )

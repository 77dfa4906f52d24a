"""A contact problem as plain data, for programs in environments of their own.

Needs NumPy only. Nodes and elements count from zero; the elements of tools follow those of the
body.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

Edges = list[list[int]]


@dataclass
class Face:
    """One side of a pair.

    Parameters
    ----------
    sides : list of (element, side)
        Sides count from zero.
    edges : list of (first node, last node)
        In the order of the element, the material on the left.
    """

    sides: Edges
    edges: Edges


@dataclass
class Pair:
    """Slave and master face, and Coulomb's coefficient."""

    slave: Face
    master: Face
    friction: float


@dataclass
class Tool:
    """Elements behind the edges of a rigid tool, whose nodes are all driven."""

    nodes: list[int]
    cells: Edges


@dataclass
class Stage:
    """A step: its first increment, its period, displacements at its end.

    Parameters
    ----------
    driven : list of (node, direction, displacement)
        All that are prescribed; they change linearly from the end of the step before.
    """

    first: float
    period: float
    driven: list[tuple[int, int, float]]


@dataclass
class ContactData:
    """A problem.

    Parameters
    ----------
    points : list of (x, y)
        Of all nodes. Some may have no element.
    cells : list of list of int
    element : str
        Name in Corota.
    young, poisson, density, thickness : float
        Of all elements.
    plane : str
        ``strain`` or ``stress``.
    forces : list of (node, force x, force y)
        They grow linearly in the first step.
    gravity : tuple of float
        Likewise.
    watched : list of int
        Nodes whose reaction is compared.
    """

    points: list[list[float]]
    cells: Edges
    element: str
    young: float
    poisson: float
    density: float
    thickness: float
    plane: str = "strain"
    pairs: list[Pair] = field(default_factory=list)
    tools: list[Tool] = field(default_factory=list)
    stages: list[Stage] = field(default_factory=list)
    forces: list[tuple[int, float, float]] = field(default_factory=list)
    gravity: tuple[float, float] = (0.0, 0.0)
    watched: list[int] = field(default_factory=list)

    @property
    def period(self) -> float:
        """Of all steps."""
        return sum(stage.period for stage in self.stages)

    @property
    def used(self) -> list[int]:
        """Nodes of the body's elements."""
        return sorted({node for cell in self.cells for node in cell})

    def save(self, path: Path) -> None:
        """Write it as JSON."""
        path.write_text(json.dumps(asdict(self)), encoding="ascii")

    @staticmethod
    def load(path: Path) -> ContactData:
        """Read what :meth:`save` wrote."""
        values = json.loads(path.read_text(encoding="ascii"))
        values["pairs"] = [
            Pair(Face(**pair["slave"]), Face(**pair["master"]), pair["friction"])
            for pair in values["pairs"]
        ]
        values["tools"] = [Tool(**tool) for tool in values["tools"]]
        values["stages"] = [Stage(**stage) for stage in values["stages"]]
        return ContactData(**values)


@dataclass
class Outcome:
    """How a run ended.

    Parameters
    ----------
    end : str
        "yes", or why it stopped, with the share of the way.
    iterations : int
        Of all attempts.
    force : float
        Magnitude of the force on the tool or the support, averaged over the run.
    """

    end: str
    iterations: int
    force: float


def mean(found: Iterable[tuple[float, float]], period: float) -> float:
    """Mean over time of forces that begin with none, linear between their times."""
    time, force = np.array([(0.0, 0.0), *found]).T
    return float(np.trapezoid(force, time)) / period

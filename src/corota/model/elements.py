"""The registered elements and their facts, as the core gives them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from corota import _core
from corota.errors import InputError


@dataclass(frozen=True)
class Element:
    """Facts of an element.

    Parameters
    ----------
    name : str
    cell : str
        Kind of cell that it fits.
    n_nodes, dofs_per_node, n_points : int
    hourglass_modes : int
        Zero-energy modes beyond the three rigid ones.
    alpha_b : float
        Share of a normal edge traction that goes into end moments.
    line : bool
        Structural companion (truss, beam, spring) and no part of the plane.
    turns : bool
        Whether its frame turns with it.
    """

    name: str
    cell: str
    n_nodes: int
    dofs_per_node: int
    n_points: int
    hourglass_modes: int
    alpha_b: float
    line: bool = False
    turns: bool = True


@cache
def _all() -> dict[str, Element]:
    return {facts["name"]: Element(**facts) for facts in _core.elements()}


def names() -> tuple[str, ...]:
    """Names of all planar elements."""
    return tuple(name for name, element in _all().items() if not element.line)


def line_names() -> tuple[str, ...]:
    """Names of all structural companions: trusses, beams, springs."""
    return tuple(name for name, element in _all().items() if element.line)


def find(name: str) -> Element:
    """Facts of the element of that name.

    Raises
    ------
    InputError
        If there is none.
    """
    try:
        return _all()[name]
    except KeyError:
        raise InputError(f"no element named {name!r}; there are {', '.join(_all())}") from None

"""The registered elements and their facts, from the core."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import corota._core as _core
from corota.errors import InputError, Location
from corota.names import choose


@dataclass(frozen=True)
class Element:
    """Facts of an element.

    Parameters
    ----------
    name : str
    cell : str
        Kind of cell.
    n_nodes, dofs_per_node, n_points : int
    n_internal_modes : int
        Internal displacement modes, condensed within the element.
    hourglass_modes : int
        Zero-energy modes beyond the three rigid ones.
    alpha_b : float
        Fraction of a normal edge traction that gives end moments.
    free_volume : bool
        Does not lock in plane strain with incompressible material.
    bending_cells : int
        Cells through a slender part below which it is too stiff in bending; 0 for none.
    weighted : bool
        Whether its higher-order stiffness has a weight (``beta0``).
    about_mean : bool
        Nonlinear strains are linear about the mean gradient of the element, so that its internal
        modes are stable at large strain.
    stabilized : bool
        Has one point and a stabilized hourglass mode.
    line : bool
        Line element (truss, beam, spring) and no part of the plane.
    spring : bool
        Line element without mass, section and axial strain.
    turns : bool
        Whether it has a co-rotated frame.
    revolved : bool
        Whether it can be a part of a solid of revolution.
    """

    name: str
    cell: str
    n_nodes: int
    dofs_per_node: int
    n_points: int
    n_internal_modes: int
    hourglass_modes: int
    alpha_b: float
    free_volume: bool
    bending_cells: int
    weighted: bool
    stabilized: bool
    line: bool = False
    spring: bool = False
    turns: bool = True
    about_mean: bool = False
    revolved: bool = False

    @property
    def drilling(self) -> bool:
        """Whether its nodes have rotations; planar elements."""
        return self.dofs_per_node == 3 and not self.line

    @property
    def loose_modes(self) -> bool:
        """Whether large plastic strain can localize in its incompatible modes."""
        return self.n_internal_modes > 0 and not (self.drilling or self.about_mean)


@cache
def _all() -> dict[str, Element]:
    return {facts["name"]: Element(**facts) for facts in _core.elements()}


def names() -> tuple[str, ...]:
    """Names of all planar elements."""
    return tuple(name for name, element in _all().items() if not element.line)


def line_names() -> tuple[str, ...]:
    """Names of all line elements: trusses, beams, springs."""
    return tuple(name for name, element in _all().items() if element.line)


def weighted_names() -> tuple[str, ...]:
    """Names of the elements whose higher-order stiffness has a weight."""
    return tuple(name for name, element in _all().items() if element.weighted)


def known(name: str) -> Element | None:
    """Facts of the element of that name, if there is one."""
    return _all().get(name)


def find(name: str, where: Location | None = None) -> Element:
    """Facts of the element of that name.

    Raises
    ------
    InputError
        If there is none.
    """
    found = known(name) if isinstance(name, str) else None
    if found is None and isinstance(name, str) and name[:3].upper() in ("CPS", "CPE", "CAX"):
        raise InputError(
            f"{name!r} is an element of decks. Here plane= is a setting of its own, and elements "
            "are Q4 (CPS4), Q4I (CPS4I, CPS4R), Q8 (CPS8), Q8R (CPS8R), T3 (CPS3), T6 (CPS6)",
            where,
        )
    return found or _all()[choose(name, _all(), "element", where)]

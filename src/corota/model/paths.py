"""Methods for equilibrium paths, and the points on them where stability changes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, number
from corota.model.dofs import dof_index
from corota.model.settings import Settings
from corota.names import choose_attribute

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats

    Where = str | int | ArrayLike


class Label(int):
    """A node by its number in the deck, where an index from 0 would be taken otherwise."""


@dataclass(kw_only=True, repr=False)
class ArcLength(Brief, Settings):
    """Follow the path by arc length: through limit points and snap-back, without tuning.

    The step ends where the first of the named ends is reached. With none named it ends at
    load factor 1; otherwise the load factor is not limited.

    Parameters
    ----------
    factor : float, optional
        End where the load factor crosses this value.
    displacement : tuple, optional
        ``(where, dof, value)``: end where the mean displacement of a set, node or nodes
        crosses a value [length].
    increments : int, optional
        End after so many increments.
    shape : {"cylindrical", "spherical"}
        Whether only displacements count in the length of an increment, or the load factor too.
    locate : bool
        Locate limit and bifurcation points and make each an increment.
    switch : bool
        Switch to the branch at the first bifurcation point.
    side : {1, -1}
        Side of the mode, whose largest component is positive.
    branch : int
        Which branch to take, from 1, where several leave a multiple bifurcation point; they are
        listed in :attr:`CriticalPoint.branches`.
    stop_at_limit : bool
        End at the first limit point.

    Examples
    --------
    >>> import corota as ct
    >>> ct.Static(path=ct.ArcLength(displacement=("top", "y", -2.0))).path.factor is None
    True
    """

    factor: float | None = None
    displacement: tuple[Where, str | int, float] | None = None
    increments: int | None = None
    shape: Literal["cylindrical", "spherical"] = "cylindrical"
    locate: bool = True
    switch: bool = False
    side: Literal[1, -1] = 1
    branch: int = 1
    stop_at_limit: bool = False

    def __post_init__(self) -> None:
        choose_attribute(self, "shape", ("cylindrical", "spherical"), "shape")
        if self.side not in (1, -1):
            raise InputError(f"side must be 1 or -1, not {self.side!r}")
        if self.branch < 1:
            raise InputError(f"branches are counted from 1, not {self.branch!r}")
        if self.increments is not None and self.increments < 1:
            raise InputError(f"a path needs at least one increment, not {self.increments}")
        if self.factor is not None:
            number(self.factor, "the load factor at the end")
        if self.displacement is not None:
            if len(self.displacement) != 3 or not math.isfinite(self.displacement[2]):
                raise InputError(
                    "displacement must be (where, dof, value) with a finite value, not "
                    f"{self.displacement!r}"
                )
            dof_index(self.displacement[1])
        ends = (self.factor, self.displacement, self.increments, self.stop_at_limit or None)
        if all(end is None for end in ends):
            self.factor = 1.0


@dataclass(repr=False)
class DisplacementControl(Brief):
    """Follow the path by a displacement that grows to a target while the load adapts.

    Where the displacement turns back (snap-back), arc length takes over.

    Parameters
    ----------
    where : str, int or array_like of int
        Set, node index or indices; the mean over them is controlled.
    dof : {"x", "y", "rotation"}
    target : float
        Value at the end of the step [length or rad].
    also : list of tuple
        More terms ``(where, dof, weight)`` that are added to the controlled quantity.
    increments : int
        Increments without cut-backs.
    locate : bool
        Locate limit and bifurcation points and make each an increment.

    Examples
    --------
    The opening between two jaws:

    >>> import corota as ct
    >>> jaws = ct.DisplacementControl("upper", "y", 0.5, also=[("lower", "y", -1.0)])
    """

    where: Where
    dof: str | int
    target: float
    also: list[tuple[Where, str | int, float]] = field(default_factory=list)
    increments: int = 20
    locate: bool = True

    def __post_init__(self) -> None:
        number(self.target, "the target displacement")
        if self.increments < 1:
            raise InputError(f"a path needs at least one increment, not {self.increments}")
        for _, dof, weight in self.terms:
            dof_index(dof)
            number(weight, "the weight of a term")

    @property
    def terms(self) -> list[tuple[Where, str | int, float]]:
        """All terms of the controlled quantity."""
        return [(self.where, self.dof, 1.0), *self.also]


@dataclass(repr=False)
class CriticalPoint(Brief):
    """A limit or bifurcation point of a path.

    Parameters
    ----------
    kind : {"limit", "bifurcation"}
        Whether the load factor has a turning point there, or another branch crosses.
    step, increment : int
        Of its frame.
    factor : float
        Load factor.
    mode : ndarray, shape (n_nodes, 3)
        Direction in which the tangent has no stiffness: displacements and rotation by node,
        the largest displacement 1.
    projection : float
        Work of the load in the mode, over the load times the mode's largest displacement:
        of order one at a limit point, 0 at a bifurcation.
    negative : tuple of int
        Negative pivots before and after; -1 where unknown.
    branches : ndarray, shape (m, n_nodes, 3)
        Directions of the branches, if they were searched (``switch=True``).
    """

    kind: Literal["limit", "bifurcation"]
    step: int
    increment: int
    factor: float
    mode: Floats
    projection: float
    negative: tuple[int, int]
    branches: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)))

    def __str__(self) -> str:
        before, after = self.negative
        known = min(before, after) >= 0
        pivots = f"; negative pivots {before} before, {after} after" if known else ""
        return (
            f"{self.kind} point at load factor {self.factor:.6g} (step {self.step}, increment "
            f"{self.increment}{pivots})"
        )


@dataclass(repr=False)
class Modes(Brief):
    """Eigenvalues with their shapes.

    Parameters
    ----------
    kind : {"buckling", "frequency"}
    step : int
        Step that found them.
    factors : ndarray, shape (m,)
        Increasing; for buckling the factors on the perturbing load that make the state critical;
        else frequencies [1/time].
    shapes : ndarray, shape (m, n_nodes, 3)
        Displacements and rotation by node; for buckling the largest displacement is 1, for
        frequencies the modal mass. Of complex modes the real part.
    growth : ndarray, shape (m,)
        Rates of growth of the modes [1/time]: negative where they decay, positive where the state
        is unstable (divergence without a frequency, flutter with one).
    imaginary : ndarray, shape (m, n_nodes, 3), or None
        Imaginary part of complex modes.
    """

    kind: Literal["buckling", "frequency"]
    step: int
    factors: Floats
    shapes: Floats
    growth: Floats = field(default_factory=lambda: np.zeros(0))
    imaginary: Floats | None = None

    def __post_init__(self) -> None:
        if not len(self.growth):
            self.growth = np.zeros(len(self.factors))

"""Supports, loads, amplitudes and initial velocities as plain data."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.errors import InputError, Location

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ints = NDArray[np.int64]


@dataclass
class Amplitude:
    """A table of factor against time, constant outside.

    Parameters
    ----------
    time, value : ndarray, shape (n,)
        Strictly increasing times and the factors there.
    total_time : bool
        Whether ``time`` counts from the start of the analysis, not of the step.
    """

    time: NDArray[np.float64]
    value: NDArray[np.float64]
    total_time: bool = False
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.time = np.asarray(self.time, dtype=np.float64)
        self.value = np.asarray(self.value, dtype=np.float64)
        if self.time.shape != self.value.shape or self.time.ndim != 1 or self.time.size == 0:
            raise InputError("an amplitude needs as many times as values, at least one", self.where)
        if not (np.isfinite(self.time).all() and np.isfinite(self.value).all()):
            raise InputError("an amplitude must be finite", self.where)
        if (np.diff(self.time) <= 0.0).any():
            at = int(np.flatnonzero(np.diff(self.time) <= 0.0)[0])
            raise InputError(
                f"the times of an amplitude must increase: {self.time[at]:g} is followed by "
                f"{self.time[at + 1]:g}",
                self.where,
            )

    def __call__(self, time: float) -> float:
        """Factor at a time [1]."""
        return float(np.interp(time, self.time, self.value))


@dataclass
class Fixed:
    """A prescribed displacement or rotation.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set, or node indices.
    dof : int
        0 and 1 displacement [length], 2 drilling rotation [rad].
    value : float
        Reached at the end of the step, along the amplitude or a ramp.
    amplitude : str
        Name in ``Model.amplitudes``; empty: ramp in static steps.
    """

    nodes: str | Ints
    dof: int
    value: float = 0.0
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class NodalForce:
    """A dead force [force] or drilling moment [force*length] at each node of a set."""

    nodes: str | Ints
    dof: int
    value: float
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class EdgeLoad:
    """A distributed load on element edges.

    Parameters
    ----------
    edges : str or array_like of int, shape (n, 2)
        Edge set, or pairs of global cell index and local edge (from 0).
    kind : {"pressure", "traction"}
        ``pressure``: normal, positive into the element, follows the deforming edge in
        geometrically nonlinear steps; ``traction``: dead, fixed in space.
    value : tuple of float
        ``(p,)`` or ``(tx, ty)`` [force/length^2]; times thickness and reference length.
    total : bool
        Whether a traction's value is a total force [force], spread over the edges' area.
    """

    edges: str | Ints
    kind: Literal["pressure", "traction"]
    value: tuple[float, ...]
    amplitude: str = ""
    total: bool = False
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class BodyForce:
    """A load on the volume of cells.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set ("" for all), or global cell indices.
    kind : {"gravity", "centrifugal"}
        ``gravity``: value ``(bx, by)`` [length/time^2];
        ``centrifugal``: value ``(omega^2, x0, y0)`` [1/time^2, length, length].
    direction : tuple of float or None
        Of gravity, as it was given: a negative size and a size of zero keep their direction.
        That of the value by default.
    """

    cells: str | Ints
    kind: Literal["gravity", "centrifugal"]
    value: tuple[float, ...]
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)
    direction: tuple[float, float] | None = None

    @property
    def axis(self) -> NDArray[np.float64] | None:
        """Unit vector along gravity, shape (2,); None without any direction."""
        along = np.array(self.direction or self.value[:2])
        size = float(np.hypot(*along))
        return along / size if size > 0.0 else None


@dataclass
class InitialVelocity:
    """Velocity of nodes at the start of the first dynamic step.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : tuple of float
        ``(vx, vy)`` [length/time]; or with a spin ``(vx, vy, omega, x0, y0)``: the rigid
        motion with angular velocity omega [rad/time] about a point.
    dof : int or None
        Set this component only, to ``value[0]``.
    """

    nodes: str | Ints
    value: tuple[float, ...]
    dof: int | None = None
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class Temperature:
    """A prescribed temperature of nodes.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : float or array_like
        One temperature, or one for each node; reached at the end of the step, along the
        amplitude or a ramp from what was there before.
    """

    nodes: str | Ints
    value: float | NDArray[np.float64]
    amplitude: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class InitialTemperature:
    """Temperature of nodes at which there is no thermal strain; 0 where none is given.

    Parameters
    ----------
    nodes : str or array_like of int
        Node, edge or cell set ("" for all), or node indices.
    value : float or array_like
        One temperature, or one for each node.
    """

    nodes: str | Ints
    value: float | NDArray[np.float64]
    where: Location | None = field(default=None, compare=False, repr=False)


@dataclass
class InitialStress:
    """Stress of cells in the reference, before any displacement.

    Parameters
    ----------
    cells : str or array_like of int
        Cell set ("" for all), or global cell indices.
    value : tuple of float or array_like
        xx, yy, zz, xy in global axes [force/length^2]; each a number, or an array with one
        value for each cell (n, 1) or for each quadrature point (n, p). Of trusses and beams xx
        is the stress along the axis.
    """

    cells: str | Ints
    value: tuple[float | NDArray[np.float64], ...]
    where: Location | None = field(default=None, compare=False, repr=False)


Load = NodalForce | EdgeLoad | BodyForce | Temperature
#: Loads that ``OP=NEW`` takes away together: those of *CLOAD, of *DLOAD and *DSLOAD, and of
#: *TEMPERATURE.
LoadKind = Literal["force", "distributed", "temperature"]
LOAD_KINDS: tuple[LoadKind, ...] = ("force", "distributed", "temperature")


def kind_of(load: Load) -> LoadKind:
    """The kind of a load that ``OP=NEW`` concerns."""
    if isinstance(load, NodalForce):
        return "force"
    return "temperature" if isinstance(load, Temperature) else "distributed"

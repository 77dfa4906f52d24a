"""Critical loads of a path and natural frequencies, and their derivatives.

A limit load is stationary along the path: with the left null vector w of the tangent, scaled so
that its product with the rate of the residual by the load factor is one, it changes by
``-w . dr/dp``. A simple symmetric bifurcation moves on its path so that the tangent stays singular
along its mode f: ``d(f . K f) = 0`` (Reitinger & Ramm, Thin-Walled Struct. 23 (1995) 159-177;
Wu & Arora, Comput. Mech. 3 (1988) 129-140). A square of a simple frequency changes by
``f . (dK - w^2 dM) f`` (Fox & Kapoor, AIAA J. 6 (1968) 2426-2429). The change of the state is
included in dK.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from corota.analysis.terms.linearized import LinearMotion
from corota.errors import InputError, UnsupportedError
from corota.gradients.adjoint import factor_rate
from corota.gradients.differences import STENCIL, derivative
from corota.gradients.measures import SpecialMeasure

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.arrays import Floats
    from corota.gradients.trajectory import Point, Trajectory
    from corota.results.results import Results


#: Slope of the load factor at a limit point, or test function at a bifurcation, over its change in
#: the first step of the search.
LOCATED = 1e-7
#: Last step of the search over the first, where rounding of slender structures ends it.
ROUNDED = 1e-5
#: Steps of a search, and of Newton's method in each.
SEARCH, NEWTON = 12, 10
#: Share of the size of the model of a difference along a mode.
ALONG = 4e-4
#: Relative difference of two frequencies that are one.
DOUBLE = 1e-6
#: Coupling of a mode with other terms, over their size, that symmetry excludes.
SYMMETRY = 1e-5
#: Rounding of that coupling, over the change of the forces of the mode.
NOISE = 1e-11


class Tangent:
    """Tangent of the active unknowns at a state, with rows and columns added.

    Parameters
    ----------
    system : System
    u : ndarray, shape (n_dofs,)
    time : float
    """

    def __init__(self, system: System, u: Floats, time: float) -> None:
        at = system.evaluate(u, time)
        self.free = system.constraints.free
        self.active = np.flatnonzero(~system.conditions.constrained[self.free])
        self.link = at.link
        self.matrix = _full(system, at)[self.active][:, self.active].tocsc()
        self.residual = self.restrict(at.reaction)
        system.return_tangent(at)

    def restrict(self, vector: Floats) -> Floats:
        """Entries of the active unknowns."""
        return vector[self.free][self.active]

    def expand(self, x: Floats) -> Floats:
        """Changes of all dofs, shape (n_dofs,)."""
        unknowns = np.zeros(len(self.free))
        unknowns[self.active] = x
        return np.array(self.link.expand(unknowns))

    def bordered(self, column: Floats, row: Floats) -> Any:
        """Factors of the tangent with one more column and row."""
        side, below = sp.csc_array(column[:, None]), sp.csc_array(row[None, :])
        return splu(sp.block_array([[self.matrix, side], [below, None]], format="csc"))


@dataclass
class LimitLoad(SpecialMeasure):
    """Load factor at a limit point of a path.

    Parameters
    ----------
    index : int
        Which of the limit points of the run.
    """

    index: int = 0
    state_only = True
    frame: int = field(default=-1, init=False)
    mode: Any = field(default=None, init=False, repr=False)

    def prepare(self, results: Results) -> None:
        self.frame, self.mode = _critical(results, "limit", self.index)

    def value(self, point: Point) -> float:
        return point.increment.factor

    def direct(self, point: Point) -> float:
        """Nothing: it depends on the residual alone."""
        return 0.0

    def adjoint(self, trajectory: Trajectory, point: Point) -> Floats:
        """Improve the limit point, and give its left null vector."""
        system, increment = point.system, point.increment
        start = system.from_nodes(self.mode)

        def slope(amplitude: float) -> float:
            _settle_at_amplitude(point, row, amplitude)
            border = Tangent(system, point.u, increment.time)
            rate = border.restrict(factor_rate(point))
            unit = np.append(np.zeros(len(rate)), 1.0)
            return float(border.bordered(rate, border.restrict(row)).solve(unit)[-1])

        row = start / (start @ start)
        here = float(row @ point.u)
        _secant(slope, here, 1e-3 * system.length * float(row @ start), self)
        tangent = Tangent(system, point.u, increment.time)
        rate = tangent.restrict(factor_rate(point))
        unit = np.append(np.zeros(len(rate)), 1.0)
        left = tangent.bordered(rate, tangent.restrict(row)).solve(unit, trans="T")[:-1]
        return -tangent.expand(left)


@dataclass
class BifurcationLoad(SpecialMeasure):
    """Load factor at a simple symmetric bifurcation of a path.

    It has a derivative by parameters that keep the symmetry; others make the branches part.

    Parameters
    ----------
    index : int
        Which of the bifurcation points of the run.
    """

    index: int = 0
    frame: int = field(default=-1, init=False)
    mode: Any = field(default=None, init=False, repr=False)
    null: Any = field(default=None, init=False, repr=False)
    rate: float = field(default=1.0, init=False, repr=False)

    def prepare(self, results: Results) -> None:
        self.frame, self.mode = _critical(results, "bifurcation", self.index)

    def value(self, point: Point) -> float:
        return point.increment.factor

    def direct(self, point: Point) -> float:
        """Stiffness along the mode, over its rate by the load factor."""
        return -_quadratic(point, self.null) / self.rate

    def vanishing(self, point: Point) -> Floats:
        """Weights of a residual that symmetry makes zero."""
        return point.at.link.expand(self.null)

    def adjoint(self, trajectory: Trajectory, point: Point) -> Floats:
        """Improve the bifurcation point, and find how the state changes its stiffness."""
        system, increment = point.system, point.increment
        mode = system.from_nodes(self.mode)
        mode /= math.sqrt(float(mode @ mode))

        def test(factor: float) -> float:
            increment.factor, increment.time = factor, factor * system.conditions.factors.period
            _settle_beside_mode(point, mode)
            tangent = Tangent(system, point.u, increment.time)
            border = tangent.restrict(mode)
            unit = np.append(np.zeros(len(border)), 1.0)
            return float(tangent.bordered(border, border).solve(unit)[-1])

        _secant(test, increment.factor, 1e-3 * max(abs(increment.factor), 1e-3), self)
        tangent = Tangent(system, point.u, increment.time)
        border = tangent.restrict(mode)
        factors = tangent.bordered(border, border)
        own = factors.solve(np.append(np.zeros(len(border)), 1.0))[:-1]
        own /= math.sqrt(float(own @ own))
        self.null = np.zeros(len(tangent.free))
        self.null[tangent.active] = own
        slope = _quadratic_slope(point, self.null)[tangent.active]
        size = SYMMETRY * float(np.abs(own) @ np.abs(slope))
        size += NOISE * math.sqrt(float(slope @ slope))
        if abs(own @ slope) > size:
            raise UnsupportedError(
                f"{self!r}: the bifurcation is not symmetric (its branches cross at an angle): the "
                "load has no derivative by most parameters"
            )
        solved = factors.solve(np.append(-slope, 0.0))[:-1]
        z = tangent.expand(solved)
        rate, _ = derivative(lambda d: self._along(point, d), max(abs(increment.factor), 1.0))
        self.rate = float(rate) + float(z @ factor_rate(point))
        return -z / self.rate

    def _along(self, point: Point, change: float) -> tuple[Floats, Floats]:
        value = np.array(_quadratic(point, self.null, change))
        return value, np.abs(value)


@dataclass
class Frequency(SpecialMeasure):
    """A simple natural frequency of a frequency step [1/time].

    Parameters
    ----------
    mode : int
        From 0, the lowest.
    step : int
        From 1; by default the last frequency step.
    """

    mode: int = 0
    step: int | None = None
    frame: int = field(default=-1, init=False)
    found: float = field(default=0.0, init=False, repr=False)
    shape: Any = field(default=None, init=False, repr=False)
    mass: str = field(default="consistent", init=False, repr=False)

    def prepare(self, results: Results) -> None:
        own = [m for m in results.modes if m.kind == "frequency"]
        own = [m for m in own if self.step is None or m.step == self.step]
        if not own or self.mode >= len(own[-1].factors):
            raise InputError(f"{self!r}: the run has no such frequency")
        modes = own[-1]
        if modes.imaginary is not None or modes.growth.any():
            raise UnsupportedError(f"{self!r}: only real modes of stable states have a gradient")
        self.found, self.shape = float(modes.factors[self.mode]), modes.shapes[self.mode]
        other = np.delete(modes.factors, self.mode)
        near = np.flatnonzero(np.abs(other - self.found) <= DOUBLE * abs(self.found))
        if len(near):
            raise UnsupportedError(
                f"{self!r} is a double frequency ({self.found:.6g}): it splits under most changes "
                "and has no derivative"
            )
        self.mass = getattr(results.steps[modes.step - 1], "mass", "consistent")
        frames = results.frames
        own_frames = (k for k, f in enumerate(frames) if f.step == modes.step and f.increment)
        self.frame = next(own_frames)

    def value(self, point: Point) -> float:
        return self.found

    def direct(self, point: Point) -> float:
        """Rayleigh's quotient of the mode, over its rate by the frequency."""
        system = point.system
        lin = LinearMotion(system, point.u, self.mass)
        if not lin.symmetric:
            raise UnsupportedError(f"{self!r}: the loads have no potential")
        shape = lin.restrict(system.from_nodes(self.shape))
        square = (2.0 * math.pi * self.found) ** 2
        stiffness, mass = float(shape @ (lin.stiffness @ shape)), float(shape @ (lin.mass @ shape))
        return (stiffness - square * mass) / (8.0 * math.pi**2 * self.found)

    def adjoint(self, trajectory: Trajectory, point: Point) -> Floats:
        """How the state changes the stiffness along the mode."""
        system = point.system
        if not np.any(point.u) and not np.any(point.at.external):
            return np.zeros(system.n_dofs)
        if system.is_rotation.any() and self.mass == "consistent":
            raise UnsupportedError(
                f"{self!r}: the mass of elements with rotations depends on the state; "
                "mass='constant' or 'lumped' in the frequency step has a gradient"
            )
        shape = system.from_nodes(self.shape)
        slope = _quadratic_slope(point, shape[system.constraints.free])
        tangent = Tangent(system, point.u, point.increment.time)
        solved = splu(tangent.matrix).solve(-slope[tangent.active])
        return tangent.expand(solved) / (8.0 * math.pi**2 * self.found)


def _critical(results: Results, kind: str, index: int) -> tuple[int, Floats]:
    """Frame and mode of a critical point of a run."""
    points = [c for c in results.critical_points if c.kind == kind]
    if not 0 <= index < len(points):
        raise InputError(
            f"the run has {len(points)} {kind} points, counted from 0: there is no {index}; follow "
            "a path (path=ArcLength(...)) past it"
        )
    wanted = points[index].step, points[index].increment
    frames = [k for k, f in enumerate(results.frames) if (f.step, f.increment) == wanted]
    return frames[0], points[index].mode


def _move(point: Point, change: Floats) -> None:
    """Move a state and evaluate the forces there."""
    system, increment = point.system, point.increment
    u = system.conditions.supports.at(increment.time, point.u + change)
    system.constraints.complete(u)
    point.u = u
    point.at = system.forces(u, increment.time)
    increment.by_node = system.by_node(u)


def _settle_at_amplitude(point: Point, row: Floats, amplitude: float) -> None:
    """Find the equilibrium with a given amplitude along a row; its load factor follows."""
    system, increment = point.system, point.increment
    period = system.conditions.factors.period
    for _ in range(NEWTON):
        tangent = Tangent(system, point.u, increment.time)
        rate = tangent.restrict(factor_rate(point))
        left = np.append(-tangent.residual, amplitude - float(row @ point.u))
        found = tangent.bordered(rate, tangent.restrict(row)).solve(left)
        increment.factor += float(found[-1])
        increment.time = increment.factor * period
        change = tangent.expand(found[:-1])
        _move(point, change)
        settled = np.abs(change).max() <= 1e-13 * max(float(np.abs(point.u).max()), 1e-300)
        if settled and abs(found[-1]) <= 1e-13 * abs(increment.factor):
            return


def _settle_beside_mode(point: Point, mode: Floats) -> None:
    """Find the equilibrium of the primary path at the load factor of the increment."""
    _move(point, np.zeros_like(point.u))  # prescribed displacements are part of the load
    for _ in range(NEWTON):
        tangent = Tangent(point.system, point.u, point.increment.time)
        border = tangent.restrict(mode)
        found = tangent.bordered(border, border).solve(np.append(-tangent.residual, 0.0))
        change = tangent.expand(found[:-1])
        _move(point, change)
        if np.abs(change).max() <= 1e-13 * max(float(np.abs(point.u).max()), 1e-300):
            return


def _secant(function: Callable[[float], float], start: float, step: float, what: Any) -> None:
    """Find a zero near a start; the last call is there."""
    x0, x1 = start, start + step
    f0 = function(x0)
    if f0 == 0.0:
        return
    f1 = function(x1)
    size = max(abs(f0 - f1), 1e-300)
    for _ in range(SEARCH):
        if f1 == f0:
            break
        x2 = x1 - f1 * (x1 - x0) / (f1 - f0)
        x0, f0, x1 = x1, f1, x2
        f1 = function(x1)
        if abs(f1) <= LOCATED * size or abs(x1 - x0) <= 1e-12 * max(abs(x1), abs(step)):
            return
    if abs(x1 - x0) > ROUNDED * abs(step):
        raise UnsupportedError(f"{what!r}: the critical point could not be located exactly")


def _full(system: System, at: Evaluation) -> Any:
    matrix = system.pattern.full(at.values).tocsr()
    if at.load_stiffness is not None:
        rows, columns, values = at.load_stiffness
        n = system.n_dofs
        matrix = matrix - sp.coo_array((values, (rows, columns)), shape=(n, n)).tocsr()
    return sp.csc_array(at.link.reduce_full(matrix.tocsc(), at.residual))


def _reduced(system: System, u: Floats, time: float) -> Any:
    tangent = system.evaluate(u, time)
    out = _full(system, tangent)
    system.return_tangent(tangent)
    return out


def _quadratic(point: Point, shape: Floats, change: float = 0.0) -> float:
    """Stiffness along a shape of the unknowns, at a change of the load factor."""
    system = point.system
    time = point.increment.time + change * system.conditions.factors.period
    u = system.conditions.supports.at(time, point.u)
    system.constraints.complete(u)
    return float(shape @ (_reduced(system, u, time) @ shape))


def _quadratic_slope(point: Point, shape: Floats) -> Floats:
    """Derivative of the stiffness along a shape by the unknowns, shape (n_unknowns,).

    It is that of the tangent along the shape, times the shape: third derivatives of a potential
    commute.
    """
    system = point.system
    moved = np.array(point.at.link.expand(shape))
    step = ALONG * system.length / max(float(np.abs(moved).max()), 1e-300)
    total = np.zeros(len(shape))
    unknowns = np.zeros(system.n_dofs)
    unknowns[system.constraints.free] = shape
    for offset, weight in STENCIL:
        u = point.u + offset * step * unknowns
        system.constraints.complete(u)
        total += weight / step * (_reduced(system, u, point.increment.time) @ shape)
    return total

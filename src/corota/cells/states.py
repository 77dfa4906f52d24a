"""States of a cell along a run, and between its increments."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from corota.analysis.equations import System
from corota.analysis.linear.solvers import make_solver
from corota.analysis.terms.linearized import Linearized
from corota.errors import ConvergenceError, InputError, UnsupportedError
from corota.gradients.trajectory import Increment, Trajectory, increments_of
from corota.model.steps import Static, Step

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.model.model import Model
    from corota.results.results import Results


#: Iterations to a state between increments, and the last correction over the displacement.
NEWTON, SETTLED = 20, 1e-12


class Cell(Protocol):
    """What waves need of a :class:`corota.cells.PeriodicCell`."""

    base: Model
    around: Model
    model: Model
    reference: tuple[int, int]
    size: float
    first: Ints
    shift: Ints

    def drives(self, item: Any) -> bool: ...


@dataclass
class State:
    """An equilibrium state.

    Parameters
    ----------
    system : System
        Equations of the model, in the step of the state.
    step : Step
    u : ndarray, shape (n_dofs,)
    time : float
        Step time of its loads.
    contact : tuple
        Multipliers and states of contact, both ``None`` where there is none.
    """

    system: System
    step: Step
    u: Floats
    time: float = 0.0
    contact: tuple[Any, Any] = (None, None)


def point_of(model: Model, results: Results | None, frame: int) -> State:
    """State of a frame, or the unloaded one.

    Raises
    ------
    InputError
        If the results are those of another model.
    UnsupportedError
        If a material has a history.
    """
    if results is None or results.frames[frame].increment == 0:
        step = Static()
        system = System(model, make_solver("multifrontal"))
        u = np.zeros(system.n_dofs)
        system.begin(step, 0.0, u, None)
        return State(system, step, u)
    wanted = range(len(results.frames))[frame]
    increments = increments_of(results)
    found = next(k for k, increment in enumerate(increments) if increment.frame == wanted)
    return state_at(model, results, increments, found)


def state_at(model: Model, results: Results, increments: list[Increment], number: int) -> State:
    """State of an increment of a run."""
    if not np.array_equal(results.model.mesh.points, model.mesh.points):
        raise InputError("the results are those of another model than that of the cell")
    trajectory = Trajectory(model, results.steps, kinks=True)
    if trajectory.remembers:
        raise UnsupportedError("tangents and waves of cells do not include materials with history")
    increment = increments[number]
    before = increments[:number]
    if not trajectory.slides:  # slips go from one increment to the next
        before = list({i.step: i for i in before if i.step < increment.step}.values())
    *_, point = trajectory.walk([*before, increment])
    trajectory.require_equilibrium(point)
    surfaces = increment.surfaces
    contact = (None, None) if surfaces is None else (surfaces.multipliers, surfaces.states)
    step = trajectory.steps[increment.step]
    return State(point.system, step, point.u, increment.time, contact)


def settle(state: State, u: Floats, time: float, beside: Floats | None = None) -> State:
    """Equilibrium at another step time, from a displacement nearby.

    What is closed stays closed and sticks, if it has friction; what is open stays open.

    Parameters
    ----------
    state : State
    u : ndarray, shape (n_dofs,)
    time : float
    beside : ndarray, shape (n_dofs,), optional
        Direction in which the state stays: a mode that may have no stiffness there.

    Raises
    ------
    ConvergenceError
    """
    system = state.system
    u = system.conditions.supports.at(time, u)
    pressures, states = state.contact
    for _ in range(NEWTON):
        system.constraints.complete(u)
        lin = Linearized(system, u, pressures, states, time=time)
        matrix = lin.sub(lin.stiffness)
        rhs = np.concatenate([-lin.reaction[lin.free], lin.residuals])[lin.active]
        if beside is not None:
            border = sp.csc_array(lin.restrict(beside)[lin.active][:, None])
            matrix = sp.block_array([[matrix, border], [border.T, None]], format="csc")
            rhs = np.append(rhs, 0.0)
        z = lin.from_active(splu(matrix).solve(rhs)[: len(lin.active)])
        change = lin.expand(z)
        u = u + change
        if pressures is not None:
            pressures = pressures + z[lin.nf :]
        if np.abs(change).max() <= SETTLED * np.abs(u).max():
            return replace(state, u=u, time=time, contact=(pressures, states))
    raise ConvergenceError(f"no equilibrium of the cell at the step time {time:.6g}")

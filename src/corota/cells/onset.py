"""Onset of patterns: the first load at which a Bloch wave has no stiffness."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from corota.analysis.terms.linearized import Linearized
from corota.cells.states import Cell, State, point_of, settle, state_at
from corota.cells.waves import UNIFORM, Waves
from corota.display import Brief
from corota.errors import ConvergenceError, InputError, UnsupportedError
from corota.gradients.trajectory import increments_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Complex, Floats
    from corota.results.results import Results


#: Share of the largest pressure, and of the size of the cell, by which contact may be wrong.
OVER = 1e-9
#: Where the load of the onset is not between two equilibria with the same contact.
CHANGES = (
    "surfaces meet, part or slip in the increment in which a wave loses its stiffness: its load is "
    "found with smaller increments"
)
#: Shares of an increment by which the search for a stable state goes back from its end.
BACK = (0.125, 0.25, 0.5, 1.0)
#: Size of the interval of the load in which the onset lies, over that of an increment.
LOCATED = 1e-13


@dataclass(repr=False)
class Onset(Brief):
    """Where a pattern begins.

    Parameters
    ----------
    time : float
        Step time; its share of the period is the load factor.
    wave : ndarray, shape (2,)
        In shares of the reciprocal lattice.
    shape : ndarray, shape (n_nodes, 3)
        Displacements in the first cell, complex; see :meth:`Waves.softest`.
    gradient : ndarray, shape (2, 2)
        Mean displacement gradient there.
    """

    time: float
    wave: Floats
    shape: Complex = field(repr=False)
    gradient: Floats

    def __str__(self) -> str:
        period = [f"{1.0 / k:.4g}" if k else "1" for k in self.wave]
        return (
            f"onset at step time {self.time:.6g}, with a period of {' x '.join(period)} cells; "
            f"mean displacement gradient {self.gradient.tolist()}"
        )


def find_onset(cell: Cell, results: Results, waves: int | ArrayLike) -> Onset:
    """First load of a static step at which a wave has no stiffness.

    Parameters
    ----------
    cell : PeriodicCell
    results : Results
    waves : int or array_like, shape (n, 2)
        See :meth:`corota.cells.PeriodicCell.onset`.

    Raises
    ------
    InputError
        If no wave loses its stiffness up to the end of the run.
    UnsupportedError
        If surfaces meet, part or slip in the increment of the onset, or with several steps.
    """
    if len(results.steps) > 1:
        raise UnsupportedError("onset is for one static step")
    vectors = _grid(waves) if isinstance(waves, int) else np.atleast_2d(np.asarray(waves, float))
    increments = increments_of(results)
    before = point_of(cell.model, None, -1)
    for number in range(len(increments)):
        after = state_at(cell.model, results, increments, number)
        found = Waves(cell, after)
        lost = [k for k in vectors if found.negative(k)]
        if lost:
            return _first(cell, before, after, lost)
        before = after
    raise InputError(
        f"none of the {len(vectors)} waves loses its stiffness up to the end of the run; load "
        "further, or try other waves"
    )


def _first(cell: Cell, before: State, after: State, lost: list[Floats]) -> Onset:
    """The first onset within an increment."""
    last = after.time
    begin = before.time

    def at(time: float, beside: Floats | None) -> State:
        share = (time - begin) / (after.time - begin)
        return settle(after, before.u + share * (after.u - before.u), time, beside)

    wave, state = lost[0], after
    for k in lost:
        if k is not lost[0] and not Waves(cell, state).negative(k):
            continue

        mode = _mode(cell, after, k)

        def stiffness(time: float, k: Floats = k, mode: Floats | None = mode) -> float:
            return Waves(cell, at(time, mode)).least_stiffness(k)

        if k is not lost[0] and stiffness(last) >= 0.0:
            continue
        # Beside an equilibrium, where contact is as there, and not further back than necessary.
        try:
            back = (last - share * (last - begin) for share in BACK)
            stable = next((time for time in back if stiffness(time) > 0.0), None)
        except ConvergenceError:
            stable = None
        if stable is None:
            raise UnsupportedError(CHANGES)
        last = float(brentq(stiffness, stable, last, xtol=LOCATED * (after.time - begin)))
        wave, state = k, at(last, mode)
    if not _keeps_contact(state):
        raise UnsupportedError(CHANGES)
    shape = Waves(cell, state).softest(wave)
    moved = state.system.by_node(state.u)[list(cell.reference), :2]
    return Onset(last, wave, shape, moved.T / cell.size)


def _keeps_contact(state: State) -> bool:
    """Whether the states of contact are those of an equilibrium there."""
    pressures, states = state.contact
    if pressures is None:
        return True
    lin = Linearized(state.system, state.u, pressures, states, time=state.time)
    return state.system.keeps(lin.at, states, OVER)


def _mode(cell: Cell, state: State, wave: Floats) -> Floats | None:
    """Softest displacement of the cell, if the wave has its period: else ``None``."""
    if np.abs(wave - np.rint(wave)).max() > UNIFORM:
        return None
    nodes = np.zeros((cell.model.mesh.n_nodes, 3))
    nodes[: cell.base.mesh.n_nodes] = Waves(cell, state).softest(wave).real
    out: Floats = state.system.from_nodes(nodes)
    return out


def _grid(n: int) -> Floats:
    """Multiples of 1/n along both vectors, one of each pair of opposite ones."""
    if n < 1:
        raise InputError(f"the grid of waves has at least one, not {n}")
    found = [(i, j) for i in range(n) for j in range(n) if (i, j) <= (-i % n, -j % n)]
    return np.array(found, float) / n

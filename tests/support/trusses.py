"""Pin-jointed trusses as systems of equations: what the drivers need, without a mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from corota.analysis.newton import ResidualNorms
from corota.errors import SingularError


@dataclass
class State:
    """What an evaluation hands to the drivers."""

    internal: np.ndarray
    external: np.ndarray
    matrix: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        return self.internal - self.external


class Truss:
    """Bars with linear engineering strain between joints in the plane.

    Parameters
    ----------
    joints : array, shape (n, 2)
    bars : list of (i, j, EA)
    held : list of dofs
    load : array, shape (2 n,)
        Load of a unit of load factor.
    move : array, shape (2 n,), optional
        Displacement of held dofs for a unit of load factor.
    springs : dict of dof to stiffness
    """

    def __init__(self, joints, bars, held, load, move=None, springs=None):
        self.joints = np.asarray(joints, float)
        self.bars, self.load = bars, np.asarray(load, float)
        n = self.load.size
        self.move = np.zeros(n) if move is None else np.asarray(move, float)
        self.constrained = np.zeros(n, bool)
        self.constrained[held] = True
        self.n_dofs = n
        self.springs = springs or {}
        self.counted = np.ones(n, bool)
        self.length = float(np.ptp(self.joints, axis=0).max())
        self.evaluations = self.factorizations = self.commits = 0

    def evaluate(self, u, step_time):
        self.evaluations += 1
        n = u.size
        force, matrix = np.zeros(n), np.zeros((n, n))
        for i, j, stiffness in self.bars:
            dofs = [2 * i, 2 * i + 1, 2 * j, 2 * j + 1]
            ends = self.joints[[i, j]] + u[dofs].reshape(2, 2)
            before = np.hypot(*(self.joints[j] - self.joints[i]))
            vector = ends[1] - ends[0]
            now = np.hypot(*vector)
            along = np.concatenate([-vector, vector]) / now
            across = np.array([[-along[3], along[2], along[3], -along[2]]]).T
            tension = stiffness * (now - before) / before
            force[dofs] += tension * along
            matrix[np.ix_(dofs, dofs)] += stiffness / before * np.outer(along, along)
            matrix[np.ix_(dofs, dofs)] += tension / now * (across @ across.T)
        for dof, stiffness in self.springs.items():
            force[dof] += stiffness * u[dof]
            matrix[dof, dof] += stiffness
        return State(force, step_time * self.load, matrix)

    def rows(self, u, step_time):
        return self.evaluate(u, step_time).internal

    def residual_norms(self, at, u):
        scale = max(np.abs(at.internal).max(), np.abs(at.external).max(), 1e-300)
        residual = np.where(self.constrained, 0.0, np.abs(at.residual)) / scale
        return ResidualNorms(float(residual.max()), 0.0, 1e-14, int(residual.argmax()))

    def load_rate(self, u):
        return self.load, self.move

    def correct(self, at, rhs, du_prescribed):
        self.factorizations += 1
        free = ~self.constrained
        self.last = at.matrix[np.ix_(free, free)]
        x = np.array(du_prescribed, float)
        b = (rhs - at.matrix @ du_prescribed)[free]
        try:
            x[free] = np.linalg.solve(self.last, b)
        except np.linalg.LinAlgError:
            raise SingularError("singular") from None
        return x, int((np.linalg.eigvalsh(self.last) < 0.0).sum())

    def advance(self, at, force, move):
        columns = [(-at.residual, np.zeros_like(move)), (force, move)]
        return tuple(self.correct(at, rhs, held)[0] for rhs, held in columns)

    def rate(self, at, force, move):
        return self.correct(at, force, move)

    def restart(self, loose=False, like=None):
        pass

    def refuse(self, at, u):
        return ""

    def explain(self, at):
        return ""

    def ahead(self, at, rate):
        return 0.0

    def around(self, *_):
        return None

    def solve_with_last_factor(self, rhs):
        x = np.zeros_like(rhs)
        x[~self.constrained] = np.linalg.solve(self.last, rhs[~self.constrained])
        return x

    def commit(self):
        self.commits += 1


def von_mises(rise, half=1.0, stiffness=1.0, spring=0.0, size=1.0):
    """Two bars that meet at an apex pushed down by a unit load; `size` scales lengths."""
    joints = size * np.array([[-half, 0.0], [0.0, rise], [half, 0.0]])
    return Truss(
        joints,
        [(0, 1, stiffness), (1, 2, stiffness)],
        [0, 1, 4, 5],
        [0, 0, 0, -1, 0, 0],
        springs={2: spring},
    )


def exact_load(rise, drop, half=1.0, stiffness=1.0):
    """Load on the apex of :func:`von_mises` that has come down by `drop`."""
    before, now = np.hypot(half, rise), np.hypot(half, rise - drop)
    return 2.0 * stiffness * (before - now) / before * (rise - drop) / now

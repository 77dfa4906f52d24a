"""Linear buckling of a structure that is free where its load does nothing.

With the free motions R (``K0 R = 0``) and a load in equilibrium (``R^T f = 0``), a mode of
``(K0 + factor K1) mode = 0`` has ``R^T K1 mode = 0``: the equation times R. The derivative
``K1 - K1 R (R^T K1 R)^-1 R^T K1`` has these modes and factors, and R is in its null space as it is
in that of K0. So the factors are those under any statically determinate supports; some are added
for the time of the step. Where ``K1 R = 0``, as for a translation, nothing is subtracted.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.free_motion import describe
from corota.errors import ModelError, SingularError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.model.steps import Buckle

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Work of the load in a free motion, relative to that of its parts, that is rounding.
BALANCED = 1e-6
#: Force that the load gains by a free motion, relative to its parts, that is rounding.
NEUTRAL = 1e-6


class FreeMotions:
    """Free motions in which a load does no work, held for the time of a step.

    Attributes
    ----------
    response : ndarray, shape (n_dofs,)
        To the load, under these supports.
    negative : int
        Negative pivots of the tangent.
    neutral, loaded : ndarray, shape (n_dofs, m)
        Motions by which the load gains no force, and the others.
    driven : int
        Motions of which the load does work as they grow.

    Raises
    ------
    SingularError
        If the load is not in equilibrium: it names the motions.
    """

    def __init__(
        self, system: System, base: Evaluation, values: Floats, force: Floats, move: Floats
    ) -> None:
        self.system = system
        self.supported = system.conditions.constrained.copy()
        self.neutral = self.loaded = self.gained = np.zeros((system.n_dofs, 0))
        self.stiffness = np.zeros((0, 0))
        self.driven = 0
        refused = None
        while True:
            try:
                self.response, self.negative = self._correct(base, force, move)
                break
            except SingularError as error:
                refused = refused or error
                if error.modes is None or not np.any(error.modes):
                    raise refused from None
                system.conditions.constrained[_holding(system, np.array(error.modes).T)] = True
        if refused is None:
            return
        held = np.flatnonzero(system.conditions.constrained & ~self.supported)
        unit = np.zeros((system.n_dofs, len(held)))
        unit[held, np.arange(len(held))] = 1.0
        self.neutral, _ = self._correct(base, np.zeros_like(unit), unit)
        reaction = _products(system, values, self.neutral)
        work = self.neutral.T @ force - reaction.T @ move
        parts = self._size(self.neutral, force) + self._size(reaction, move)
        if (abs(work) > BALANCED * parts).any():
            raise refused
        # A rotation along with the response would be one of first order, which strains.
        self.response = self._still(self.response, self.neutral)

    def _still(self, x: Floats, motions: Floats) -> Floats:
        """Columns without their part in free motions, that of least squares of displacements."""
        counted = self.system.counted
        return x - motions @ np.linalg.lstsq(motions[counted], x[counted], rcond=None)[0]

    def _size(self, x: Floats, y: Floats) -> Floats:
        """Largest that products of columns with `y` can be, displacements and turns apart."""
        size = np.zeros(x.shape[1])
        for kind in (self.system.is_rotation, ~self.system.is_rotation):
            size += abs(x[kind]).max(axis=0, initial=0.0) * abs(y[kind]).sum()
        return size

    def _correct(self, base: Evaluation, force: Floats, move: Floats) -> tuple[Floats, int]:
        return self.system.correct(replace(base, values=base.values.copy()), force, move)

    def __len__(self) -> int:
        return self.neutral.shape[1] + self.loaded.shape[1]

    def load(self, change: Floats, step: Buckle, number: int) -> str:
        """Take the derivative of the tangent; a note on the motions.

        Raises
        ------
        ModelError
            If the load drives a motion of a structure that has supports.
        """
        system, motions = self.system, self.neutral
        gained = _products(system, change, motions)
        sizes = _products(system, abs(change), abs(motions))
        scale = float(sizes.max()) or 1.0
        _, size, axes = np.linalg.svd(gained / scale, full_matrices=False)
        turns = size > NEUTRAL
        self.neutral, self.loaded = motions @ axes[~turns].T, motions @ axes[turns].T
        self.gained = gained @ axes[turns].T
        self.stiffness = self.loaded.T @ self.gained
        least = NEUTRAL * scale
        values = np.linalg.eigvalsh(self.stiffness)
        self.driven = int((values < -least).sum())
        what = describe(system, motions.T) or "the structure is a mechanism"
        alone = not self.supported.any() and (abs(values) > least).all()
        if (values < least).any() and not alone:
            raise ModelError(
                f"the load of buckling step {number} moves the structure without resistance, at a "
                f"factor of 0: {what}; hold it, or remove the mechanism",
                step.where,
            )
        turned = "; the load turns with it" if self.driven else ""
        return (
            f"{what}{turned}; the load does no work there, and the factors are those of the "
            "deformation"
        )

    def force(self, x: Floats) -> Floats:
        """What the product of the derivative with columns loses, shape (n_dofs, k)."""
        return self.gained @ np.linalg.solve(self.stiffness, self.gained.T @ x)

    def shapes(self, x: Floats) -> Floats:
        """Modes of columns: without the motions, in the sense that each of them has."""
        x = x - self.loaded @ np.linalg.solve(self.stiffness, self.gained.T @ x)
        return self._still(x, self.neutral)

    @property
    def held(self) -> NDArray[np.bool_]:
        """Dofs of the supports, and of one for each neutral motion, shape (n_dofs,)."""
        held: NDArray[np.bool_] = self.supported.copy()
        held[_holding(self.system, self.neutral)] = True
        return held


def _products(system: System, values: Floats, x: Floats) -> Floats:
    """A matrix of the unknowns times columns, of shape (n_dofs, m) as they are."""
    out, free = np.zeros(x.shape), system.constraints.free
    for k in range(x.shape[1]):
        column = np.ascontiguousarray(x[free, k])
        out[free, k] = system.constraints.pattern.multiply(values, column)
    return out


def _holding(system: System, motions: Floats) -> Ints:
    """Unknowns, as many as motions, that hold them."""
    from scipy.linalg import qr

    free = system.constraints.free
    order: Ints = qr(motions[free].T, mode="r", pivoting=True)[1]
    return free[order[: motions.shape[1]]]


__all__ = ["FreeMotions"]

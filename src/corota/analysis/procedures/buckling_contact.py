"""Linear buckling of models with ties or contact: what is closed stays closed, what is open, open.

The unknowns are displacements and multipliers; both move along the response to the perturbing
load. The pencil is symmetric but its stiffness is indefinite, by the multipliers, so that the
factors come from Arnoldi's method.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigs

from corota.analysis.terms.linearized import Linearized
from corota.errors import ConvergenceError, ModelError, UnsupportedError

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.terms.conditions import Conditions
    from corota.arrays import Floats


#: Displacement of the differences, as a share of the model's size.
DIFFERENCE = 1e-5
#: Second over first difference of the tangent that shows a jump.
CORNER = 0.1
#: Imaginary part of a factor, relative to its size, that is rounding.
REAL = 1e-6
#: Unknowns up to which the dense eigenvalue solver is faster.
DENSE = 300
#: Additional factors that are computed, because many may be negative.
BESIDE = 6


def factors_with_contact(
    system: System, u: Floats, force: Floats, move: Floats, loads: Conditions, count: int
) -> tuple[Floats, Floats]:
    """Lowest positive factors and their shapes, of the form (n_dofs, m).

    Raises
    ------
    ModelError
        If the state is unstable, or nothing buckles.
    UnsupportedError
        If loads have no potential, the stability of the state is unknown, or the tangent jumps.
    """
    base = Linearized(system, u)
    if not base.symmetric:
        raise UnsupportedError(
            "loads that follow the structure without a potential have no buckling factors "
            "(non-conservative: use dynamics)"
        )
    k = base.sub(base.stiffness)
    factor = base.factor(k, True)
    if factor.negative < 0:
        raise UnsupportedError(
            "the pivots of this state with contact do not show whether it is stable; follow its "
            "path instead (path=ArcLength(...))"
        )
    if factor.negative > 0:
        raise ModelError(
            f"the state is unstable ({factor.negative} negative pivots): linear buckling needs a "
            "stable one; follow its path instead (path=ArcLength(...))"
        )
    z = base.restrict(move)
    z[base.active] += factor.solve(base.gather(force) - (base.stiffness @ z)[base.active])
    moved = float(np.abs(base.expand(z)[system.counted]).max(initial=0.0))
    moved = max(moved, system.free.largest(loads.heating) * system.length)
    if not np.isfinite(moved) or moved == 0.0:
        raise ConvergenceError("the perturbing load causes no displacement")
    change = _change(base, z, loads, moved)
    a = base.sub(change)
    n = a.shape[0]

    def apply(x: Floats) -> Floats:
        return -factor.solve(np.ascontiguousarray(a @ x))

    wanted = 2 * count + BESIDE
    if n <= DENSE or wanted >= n - 1:
        theta, x = np.linalg.eig(apply(np.eye(n)))
    else:
        start = apply(np.random.default_rng(11).standard_normal(n))
        operator = LinearOperator((n, n), matvec=lambda v: apply(v.ravel()), dtype=float)
        theta, x = eigs(operator, k=wanted, which="LR", v0=start, ncv=max(3 * wanted, 40))
    # A load that would stretch the structure by its own size is not a buckling load.
    real = (np.abs(theta.imag) <= REAL * np.abs(theta)) & (theta.real * system.length > moved)
    order = np.argsort(-theta.real[real])[:count]
    if not len(order):
        raise ModelError("the load gives no positive factor; does it cause tension only?")
    shapes = base.expand(base.from_active(x[:, real][:, order].real))
    return 1.0 / theta.real[real][order], shapes


def _change(base: Linearized, z: Floats, loads: Conditions, moved: float) -> Floats:
    """Derivative of the stiffness along a response, a sparse matrix of all unknowns."""
    system = base.system
    size = DIFFERENCE * system.length / moved
    heating = loads.heating if loads.heating.any() else None
    mechanical = loads.external(loads.factors.period, base.u)[0] - loads.external(0.0, base.u)[0]
    du, dp = base.expand(z), z[base.nf :]

    def neighbor(h: float) -> Linearized:
        system.free.offset = None if heating is None else h * heating
        try:
            return Linearized(
                system, base.u + h * du, base.multipliers + h * dp, base.states, h * mechanical
            )
        finally:
            system.free.offset = None

    ahead, behind = neighbor(size).stiffness, neighbor(-size).stiffness
    change = ahead - behind
    geometric_stiffness = ahead + behind - 2.0 * base.stiffness
    if abs(geometric_stiffness).max() > CORNER * abs(change).max():
        raise UnsupportedError(
            "the tangent changes abruptly at this state (plastic flow, contact), so linear "
            "buckling is not meaningful; follow the path instead (path=ArcLength(...))"
        )
    change = change / (2.0 * size)
    own = system.pattern.zeros()
    _, triplets = loads.external(loads.factors.period, base.u, own)
    if triplets is not None:
        triplets = (triplets[0], triplets[1], -triplets[2])
    if triplets is not None or own.any():
        change = change + base.padded(base.reduce(own, triplets))
    found: Floats = change.tocsc()
    return found

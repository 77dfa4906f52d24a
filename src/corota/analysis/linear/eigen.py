"""Eigenvalues of the linearized equations of motion near zero, real and complex.

Three problems: both matrices symmetric (Lanczos), an unsymmetric stiffness (Arnoldi), and the
quadratic problem with damping and gyroscopic forces in state space (Arnoldi). All of them use one
factorization near zero (shift and invert).

Source: F. Tisseur and K. Meerbergen, SIAM Review 43 (2001) 235-286; R. B. Lehoucq,
D. C. Sorensen and C. Yang, ARPACK Users' Guide (1998), ch. 3.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigs, eigsh

from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.linear.factor import Factor
    from corota.analysis.linear.types import Sparse
    from corota.analysis.terms.linearized import LinearMotion
    from corota.arrays import Complex, Floats


#: Unknowns up to which the dense eigenvalue solver is faster.
DENSE = 150
#: Shift of a free body, relative to the largest ratio of stiffness to mass.
SHIFT = 1e-9
#: Eigenvalues of the inverse below this share of the largest belong to unknowns without mass.
MASSLESS = 1e-13
#: Square of a circular frequency, over the largest ratio of stiffness to mass, that no mesh has:
#: closed constraints of contact have a compliance of 1e-10.
RIGID = 1e5
#: Additional modes that are searched for an instability.
BESIDE = 6


def shifted_factor(lin: LinearMotion) -> tuple[Factor, float]:
    """The stiffness factorized, with a little of the mass added where bodies are free.

    Returns
    -------
    factor : Factor
    shift : float
        [1/time^2], 0 where the stiffness is regular.
    """
    k, m = lin.sub(lin.stiffness), lin.sub(lin.mass)
    try:
        return lin.factor(k, lin.symmetric), 0.0
    except SingularError:
        shift = SHIFT * _largest_ratio(k, m)
        if shift == 0.0:
            raise
        return lin.factor(k + shift * m, lin.symmetric), shift


def _largest_ratio(k: Sparse, m: Sparse) -> float:
    stiff, heavy = k.diagonal(), m.diagonal()
    moving = heavy > 0.0
    return float((stiff[moving] / heavy[moving]).max(initial=0.0))


def _rigid(lin: LinearMotion) -> float:
    """Square of a circular frequency beyond which modes are those of constraints that give way."""
    if not lin.multiplier[lin.active].any():
        return np.inf
    return RIGID * _largest_ratio(lin.sub(lin.stiffness), lin.sub(lin.mass))


def symmetric_modes(lin: LinearMotion, count: int) -> tuple[Floats, Floats]:
    """Lowest squares of the circular frequency; negative ones, of unstable states, first.

    Returns
    -------
    squares : ndarray, shape (m,)
    shapes : ndarray, shape (n_active, m)
        With unit modal mass.
    """
    factor, shift = shifted_factor(lin)
    m = lin.sub(lin.mass)
    n = len(lin.active)
    if n <= DENSE or 4 * count > n:
        return _dense_symmetric(factor, m, shift, count, _rigid(lin))
    shape = (n, n)
    weigh = LinearOperator(shape, matvec=lambda x: m @ x.ravel(), dtype=float)
    invert = LinearOperator(shape, matvec=lambda x: factor.solve(x.ravel()), dtype=float)
    start = factor.solve(m @ np.random.default_rng(7).standard_normal(n))

    def run(k: int, which: Literal["LM", "LA", "SA"]) -> tuple[Floats, Floats]:
        # With a shift, `which` goes by 1 / (square + shift). The stiffness itself is not used.
        return eigsh(weigh, k=k, M=weigh, sigma=-shift, OPinv=invert, v0=start, which=which)

    values, shapes = run(count, "LM" if factor.negative == 0 else "LA")
    if factor.negative != 0:
        # Unknown inertia: instabilities appear at this end of the spectrum.
        below, unstable = run(factor.negative if factor.negative > 0 else 4, "SA")
        real = below < -shift
        values = np.concatenate([below[real], values])
        shapes = np.concatenate([unstable[:, real], shapes], axis=1)
    order = np.argsort(values)[:count]
    return values[order], shapes[:, order]


def _dense_symmetric(
    factor: Factor, m: Sparse, shift: float, count: int, rigid: float
) -> tuple[Floats, Floats]:
    """Small systems, or most of a spectrum: by the flexibility, which may be indefinite."""
    n = m.shape[0]
    weights, axes = np.linalg.eigh(m.toarray())
    heavy = weights > np.finfo(float).eps * weights.max(initial=0.0) * n
    root = axes[:, heavy] * np.sqrt(weights[heavy])
    moved = factor.solve(np.asfortranarray(root))
    flexible = root.T @ moved
    theta, y = eigh(0.5 * (flexible + flexible.T))
    real = np.abs(theta) > MASSLESS * np.abs(theta).max(initial=0.0)
    real &= (theta < 0.0) | (theta * rigid > 1.0)
    theta, y = theta[real], y[:, real]
    values = 1.0 / theta - shift
    order = np.argsort(values)[:count]
    return values[order], (moved @ y[:, order]) / theta[order]


def unsymmetric_modes(lin: LinearMotion, count: int) -> tuple[Complex, Complex]:
    """Eigenvalues ``s`` of ``s^2 M + K`` with an unsymmetric K, those nearest to zero.

    Returns
    -------
    values : ndarray of complex, shape (m,)
        With an imaginary part that is not negative; of a pair that differs in the sign of its real
        part alone, the one that grows.
    shapes : ndarray of complex, shape (n_active, m)
    """
    factor, shift = shifted_factor(lin)
    m = lin.sub(lin.mass)
    n = len(lin.active)

    def apply(x: Floats) -> Floats:
        return factor.solve(np.ascontiguousarray(m @ x))

    theta, x = _nearest(apply, n, 2 * count + BESIDE)
    # A real matrix: complex squares come in pairs, each of which is one s.
    squares = 1.0 / theta - shift
    keep = (squares.imag >= 0.0) & (np.abs(squares) < _rigid(lin))
    squares, x = squares[keep], x[:, keep]
    # Real squares that differ from a pair by rounding count as real.
    squares = np.where(np.abs(squares.imag) <= 1e-7 * np.abs(squares), squares.real + 0j, squares)
    values = np.sqrt(-squares)
    values = np.where(values.real < 0.0, -values, values)
    values = np.where(values.imag < 0.0, values.conj(), values)
    return _first(values, x, count)


def quadratic_modes(lin: LinearMotion, damping: Sparse, count: int) -> tuple[Complex, Complex]:
    """Eigenvalues ``s`` of ``s^2 M + s C + K``, those nearest to zero; see `unsymmetric_modes`.

    `damping` is C with the gyroscopic matrix, of all unknowns.
    """
    k, m, c = lin.sub(lin.stiffness), lin.sub(lin.mass), lin.sub(damping)
    n = len(lin.active)
    shift = 0.0
    symmetric = lin.symmetric
    try:
        factor = lin.factor(k, symmetric)
    except SingularError:
        ratio = _largest_ratio(k, m)
        if ratio == 0.0:
            raise
        shift = np.sqrt(1e-7 * ratio)
        shifted = k + shift * c + shift**2 * m
        skew = abs(shifted - shifted.T).max()
        factor = lin.factor(shifted, bool(skew <= 1e-12 * abs(shifted).max()))

    def apply(z: Floats) -> Floats:
        # State (x, s x): one step of (A - shift B)^-1 B.
        x, y = z[:n], z[n:]
        now = -factor.solve(np.ascontiguousarray(c @ x + m @ (y + shift * x)))
        return np.concatenate([now, x + shift * now], axis=0)

    theta, z = _nearest(apply, 2 * n, 2 * count + BESIDE)
    values = 1.0 / theta + shift
    keep = values.imag >= 0.0
    return _first(values[keep], z[:n, keep], count)


def _nearest(apply: Callable[[Floats], Floats], n: int, count: int) -> tuple[Complex, Complex]:
    """Largest eigenvalues of an operator, without those of unknowns that have no mass."""
    if n <= 2 * DENSE or 4 * count > n:
        theta, x = np.linalg.eig(apply(np.eye(n)))
    else:
        start = apply(np.random.default_rng(7).standard_normal(n))
        operator = LinearOperator((n, n), matvec=lambda v: apply(v.ravel()), dtype=float)
        theta, x = eigs(operator, k=count, v0=start, which="LM", ncv=max(3 * count, 40))
    real = np.abs(theta) > MASSLESS * np.abs(theta).max(initial=0.0)
    return theta[real].astype(complex), x[:, real].astype(complex)


def _first(values: Complex, x: Complex, count: int) -> tuple[Complex, Complex]:
    """The first of them by frequency; growing modes are never omitted."""
    growing = values.real > 1e-6 * np.abs(values)
    order = np.lexsort((values.imag, np.abs(values)))
    chosen = np.zeros(len(values), bool)
    chosen[order[:count]] = True
    chosen |= growing
    order = order[chosen[order]]
    return values[order], x[:, order]

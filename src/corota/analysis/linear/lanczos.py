"""Eigenvalues of a symmetric pencil of large sparse matrices by block Lanczos.

The procedures supply a factorized matrix; each step costs one solution with two right-hand sides
and no factorization. Linear buckling and free vibration are both of this form.

Source: R. G. Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix Anal. Appl. 15 (1994)
228-272; here with full reorthogonalization and without restart.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from corota.arrays import Floats

#: Vectors in a block: a double eigenvalue is found together.
BLOCK = 2
#: Longest basis.
LONGEST = 240
#: Basis that contains every positive eigenvalue above noise.
TELLING = 60
#: Directions whose square is below this share of a block's largest are dependent.
DEPENDENT = 1e-12
#: New directions below this share of the largest eigenvalue are rounding errors.
EXHAUSTED = 1e-11


def largest(
    apply: Callable[[Floats], Floats],
    solve: Callable[[Floats], Floats],
    start: Floats,
    count: int,
    tolerance: float = 1e-6,
) -> tuple[Floats, Floats]:
    """Largest eigenvalues theta of ``A x = theta B x``, B positive definite.

    Parameters
    ----------
    apply : callable
        ``A x`` for columns, shape (n, k).
    solve : callable
        ``B^-1 y`` for columns.
    start : ndarray, shape (n, k)
        Right-hand sides to start from; k is the size of a block.
    count : int
        Number of requested eigenvalues.
    tolerance : float
        Residual of a vector relative to its eigenvalue; the eigenvalue's own error is of its
        square.

    Returns
    -------
    values : ndarray, shape (m,)
        Positive eigenvalues, falling; fewer than `count` if no more are found in a basis
        of :data:`LONGEST` vectors.
    vectors : ndarray, shape (n, m)
        With ``x^T B x = 1``.
    """
    n = len(start)
    # Vectors lie in rows: products with the basis then run through memory once.
    basis = np.empty((LONGEST + BLOCK, n))
    images = np.empty((LONGEST + BLOCK, n))  # B times the basis
    projected = np.empty((0, 0))
    first = np.ascontiguousarray(start.T)
    block, image, _ = _orthonormal(_rows(solve(start)), first, 0.0)
    m = 0
    while True:
        width = len(block)
        basis[m : m + width], images[m : m + width] = block, image
        m += width
        known, known_images = basis[:m], images[:m]
        image = _rows(apply(block.T))
        columns = known @ image.T
        grown = np.zeros((m, m))
        grown[: m - width, : m - width] = projected
        grown[:, m - width :] = columns
        grown[m - width :, :] = columns.T
        grown[m - width :, m - width :] = 0.5 * (columns[m - width :] + columns[m - width :].T)
        projected = grown
        # B times the next block is known without a product, since it is B B^-1 A block.
        block = _rows(solve(image.T))
        # In exact arithmetic only the last two blocks overlap; one pass over all removes
        # what rounding leaves.
        for first_row in (max(m - width - BLOCK, 0), 0):
            near, near_images = known[first_row:], known_images[first_row:]
            overlap = image @ near.T
            block -= overlap @ near
            image -= overlap @ near_images
        size = float(np.abs(projected).max(initial=0.0))
        block, image, coupling = _orthonormal(block, image, (EXHAUSTED * size) ** 2)
        values, shapes = np.linalg.eigh(projected)
        values, shapes = values[::-1], shapes[:, ::-1]
        noise = EXHAUSTED * float(np.abs(values).max(initial=0.0))
        wanted = min(count, int((values > noise).sum()))
        error = np.linalg.norm(coupling @ shapes[m - width :, :wanted], axis=0)
        exhausted = len(block) == 0
        good = wanted
        if not exhausted and m >= LONGEST:
            # Eigenvalues not found by now are below many others.
            good = int(np.cumprod(error <= tolerance * values[:wanted]).sum())
            exhausted = True
        enough = wanted == count or m >= TELLING
        if exhausted or (enough and (error <= tolerance * values[:wanted]).all()):
            return values[:good], np.ascontiguousarray((shapes[:, :good].T @ known).T)


def _rows(x: Floats) -> Floats:
    return np.array(x.T, order="C")


def _orthonormal(block: Floats, image: Floats, least: float) -> tuple[Floats, Floats, Floats]:
    """Orthonormal rows in the product of B, their images and the coefficients.

    Dependent directions, and those with squares below `least`, are dropped.
    """
    gram = block @ image.T
    values, vectors = np.linalg.eigh(0.5 * (gram + gram.T))
    kept = values > max(DEPENDENT * float(values.max(initial=0.0)), least)
    root = np.sqrt(values[kept])
    turn = (vectors[:, kept] / root).T
    return turn @ block, turn @ image, (vectors[:, kept] * root).T

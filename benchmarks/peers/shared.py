"""What the drivers share: arguments, clocks, the line of JSON, a material for those without one.

Needs NumPy only, for it runs in every program's environment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.corpora.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Residual relative to the first of the increment at which the peers stop. In motion the first
#: one is already small, and 1e-8 of it below what round-off leaves.
TOLERANCE, TOLERANCE_IN_MOTION = 1e-8, 1e-6
MAX_ITERATIONS = 50


def arguments() -> tuple[Problem, dict[str, str]]:
    """Problem and options of the command line."""
    options = dict(word.split("=", 1) for word in sys.argv[2:])
    return Problem.load(sys.argv[1]), options


def tolerance(p: Problem) -> float:
    """Where a program stops that compares with the first residual of an increment."""
    return TOLERANCE_IN_MOTION if p.name == "P4" else TOLERANCE


class Clock:
    """Wall and processor seconds since it was made."""

    def __init__(self) -> None:
        self.wall, self.cpu = time.perf_counter(), time.process_time()

    def tell(self, version: str, iterations: int, result: Sequence[float], **more: Any) -> None:
        """Print the line: times of the increments, iterations, what the problem asks for."""
        line = {
            "version": version,
            "solve": time.perf_counter() - self.wall,
            "cpu": time.process_time() - self.cpu,
            "iterations": int(iterations),
            "result": [float(value) for value in result],
            **more,
        }
        sys.stdout.write("\n" + json.dumps(line) + "\n")


def plane_stress(young: float, poisson: float) -> tuple[float, float]:
    """Lame constants (lambda, mu) of a law in the plane that is in plane stress."""
    return young * poisson / (1.0 - poisson**2), young / (2.0 * (1.0 + poisson))


def piola(gradient: Floats, lam: float, mu: float) -> tuple[Floats, Floats]:
    """First Piola-Kirchhoff stress and tangent of the St. Venant-Kirchhoff material.

    Parameters
    ----------
    gradient : ndarray, shape (2, 2, ...)
        Deformation gradient.
    lam, mu : float

    Returns
    -------
    stress : ndarray, shape (2, 2, ...)
    tangent : ndarray, shape (2, 2, 2, 2, ...)
    """
    unit = np.eye(2)
    strain = 0.5 * np.einsum("ki...,kj...->ij...", gradient, gradient)
    strain[0, 0] -= 0.5
    strain[1, 1] -= 0.5
    second = 2.0 * mu * strain
    trace = lam * (strain[0, 0] + strain[1, 1])
    second[0, 0] += trace
    second[1, 1] += trace
    left = np.einsum("ik...,jk...->ij...", gradient, gradient)
    tangent = (
        np.einsum("ik,jl...->ijkl...", unit, second)
        + lam * np.einsum("ij...,kl...->ijkl...", gradient, gradient)
        + mu * np.einsum("ik...,jl->ijkl...", left, unit)
        + mu * np.einsum("il...,kj...->ijkl...", gradient, gradient)
    )
    return np.einsum("ik...,kj...->ij...", gradient, second), tangent


def place(points: Floats, others: Floats) -> NDArray[np.int64]:
    """Index in `others` of each of `points`, where a program numbers the nodes its own way."""
    scale = 1e7 / np.ptp(points, axis=0).max()
    index = {tuple(key): k for k, key in enumerate(np.rint(others * scale).astype(int).tolist())}
    return np.array([index[tuple(key)] for key in np.rint(points * scale).astype(int).tolist()])

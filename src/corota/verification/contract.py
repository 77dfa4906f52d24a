"""The contract of all materials, as a check that users can run on their own."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from corota.arrays import Floats


def random_path(seed: int, corners: int = 11, steps: int = 6, size: float = 0.004) -> Floats:
    """Strain path between random corners, shape (steps (corners - 1), 3), starting at rest.

    Parameters
    ----------
    seed, corners, steps : int
        Random seed, corners of the path, steps between two.
    size : float
        Largest strain component.
    """
    points = np.random.default_rng(seed).uniform(-size, size, (corners, 3))
    points[0] = 0.0
    share = np.linspace(1.0 / steps, 1.0, steps)
    return np.array([a + (b - a) * t for a, b in pairwise(points) for t in share])


def check_material(
    material: Any, plane: str = "stress", size: float = 0.004, step: float = 1e-7
) -> None:
    """Check a material that has ``respond``: :class:`corota.Mises`, `UserMaterial`.

    The tangent is the derivative of the stress (central differences over `step`; its symmetric
    part where it is not symmetric), the same path gives the same stress, and where there is a
    dissipation or an equivalent plastic strain it never falls.

    Parameters
    ----------
    material : Mises or UserMaterial
    plane : {"stress", "strain"}
    size : float
        Largest strain component of the random cyclic paths.
    step : float
        Difference of strain, relative to `size`, times a hundred.

    Raises
    ------
    AssertionError
        With the violated condition and its place.
    """
    width = 100.0 * step * size
    for seed in range(3):
        path = random_path(seed, size=size)
        answer = material.respond(path, plane)
        again = material.respond(path, plane)
        if not np.array_equal(answer["stress"], again["stress"]):
            raise AssertionError("the same strain path gives different stresses")
        for name in ("PDISS", "PEEQ"):
            if name in answer and np.diff(answer[name], prepend=0.0).min() < -1e-12 * max(
                float(np.abs(answer[name]).max()), 1e-300
            ):
                raise AssertionError(f"{name} falls on a cyclic path")
        stiff = float(np.abs(answer["tangent"]).max())
        for n in range(0, len(path), 7):
            columns = []
            for j in range(3):
                ends = []
                for sign in (1.0, -1.0):
                    moved = path[: n + 1].copy()
                    moved[n, j] += sign * width
                    ends.append(material.respond(moved, plane)["stress"][n])
                columns.append((ends[0] - ends[1]) / (2.0 * width))
            exact = np.array(columns).T
            error = float(np.abs(0.5 * (exact + exact.T) - answer["tangent"][n]).max())
            if error > 1e-4 * stiff:
                raise AssertionError(
                    f"the tangent is not the derivative of the stress at strain {path[n]}: "
                    f"relative error {error / stiff:.1e}"
                )

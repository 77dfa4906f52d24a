"""Models and measures that several tests share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise

import numpy as np

import corota as ct
from corota.verification.models import (
    COOK,
    DRILLING,
    ELEMENTS,
    ISOPARAMETRIC,
    QUADRATIC,
    Watch,
    assemble,
    boundary,
    cantilever,
    cell,
    cook,
    edge_forces,
    linear,
    nearest,
    prescribe,
    single,
)

__all__ = [
    "COOK",
    "DRILLING",
    "ELEMENTS",
    "ISOPARAMETRIC",
    "QUADRATIC",
    "Watch",
    "assemble",
    "assert_contracts",
    "assert_quadratic",
    "balance",
    "boundary",
    "cantilever",
    "cell",
    "cook",
    "edge_forces",
    "linear",
    "nearest",
    "prescribe",
    "run",
    "single",
]


def assert_quadratic(watch, size, below=1e-3):
    """Assert that Newton's last iterations converge with order 1.8 at least.

    Parameters
    ----------
    watch : Watch
    size : float
        Length over which the problem is nonlinear, thickness^2 / length of a slender part.
    below : float
        Share of it from which corrections count as the last ones.
    """
    orders = watch.orders(size, below)
    assert len(orders) > 0, "no increment has two corrections in the asymptotic range"
    assert (orders >= 1.8).all(), orders


def assert_contracts(watch, constant, floor):
    """Assert e1 <= constant e0^2 for successive corrections, down to a rounding floor.

    For slender structures: the constant, about length / thickness^2, is so large and the
    stiffness so ill-conditioned that no pair of corrections shows the order itself. Linear
    convergence breaks this bound all the same, near the floor.
    """
    for key, run in watch.runs.items():
        for (_, a), (_, b) in pairwise(run):
            assert b <= max(constant * a * a, floor), (key, a, b)


def run(model, steps=None, watch=None, **keys):
    """Solve with one thread and return the last frame."""
    keys = {"threads": 1, "fields": False, **keys}
    return ct.solve(model, steps, observers=[watch] if watch else [], **keys).frames[-1]


def balance(model, frame, moved=True):
    """Sum of reactions and loads, and of their moments about the origin, over their sizes.

    Parameters
    ----------
    moved : bool
        Moments about the deformed body; a geometrically linear one balances undeformed.
    """
    held = np.zeros((model.mesh.n_nodes, 3), bool)
    for item in model.supports:
        nodes = model.mesh.nodes_of(item.nodes) if isinstance(item.nodes, str) else item.nodes
        held[nodes, item.dof] = True
    total = np.where(held, frame.RF, 0.0) + frame.F
    x = model.mesh.points + (frame.U if moved else 0.0)
    size = np.abs(frame.RF[held]).max() + np.abs(frame.F).max()
    moment = x[:, 0] @ total[:, 1] - x[:, 1] @ total[:, 0] + total[:, 2].sum()
    return np.abs(total[:, :2].sum(axis=0)).max() / size, abs(moment) / (size * np.abs(x).max())

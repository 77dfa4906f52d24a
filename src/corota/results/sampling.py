"""Nodal variables between the nodes: components are interpolated, invariants taken from them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.results import variables as vf
from corota.results.table import COMPONENTS, INVARIANTS, POSITIVE

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats
    from corota.results.source import ResultSource


def sampled(
    results: ResultSource,
    name: str,
    frame: int,
    onto: Callable[[Floats], Floats],
    section: int | None = None,
) -> Floats:
    """A variable between the nodes.

    Parameters
    ----------
    results : Results
    name : str
    frame : int
    onto : callable
        Interpolates nodal values (n_nodes, ...) to places (m, ...).
    section : int, optional
        Average over the cells of this section group only.

    Returns
    -------
    ndarray, shape (m,)

    Raises
    ------
    InputError
        If there is no such variable.
    """
    state = results.frame(frame)
    name = vf.canonical(name, state)
    if name in INVARIANTS:
        tensor = INVARIANTS[name][0]
        components = [n for n, (of, _) in COMPONENTS.items() if of == tensor]
        if state.fields:
            nodal = results.averaging.nodal(state.fields, [tensor], section)[tensor]
            return vf.invariant(name, onto(nodal))
        if set(components) <= set(results.variables(frame)):
            nodal = np.stack([results.nodal(n, frame, section) for n in components], axis=-1)
            return vf.invariant(name, onto(nodal))
    values = onto(results.nodal(name, frame, section))
    # Parabolas through nodal values may be negative where the variable is not.
    return np.maximum(values, 0.0) if name in POSITIVE else values

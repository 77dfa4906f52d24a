"""Adjoint states with friction, backwards through the increments.

Slip is measured from the positions at the start of an increment, so that each increment depends
on the one before. What slips has the traction that friction allows, what sticks has no slip; the
derivatives of gaps, slips and forces by the nodes of the surfaces are taken by differences of the
core's exact values. The matrix is not symmetric: its transpose is factorized.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import norm, splu

from corota.errors import UnsupportedError
from corota.gradients.differences import all_derivatives
from corota.gradients.surfaces import Surfaces, contact_of, evaluate, residuals

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.analysis.equations import System
    from corota.arrays import Floats, Ints


#: Step of a position over the size of a cell.
STEP = 1e-5
#: Share of a traction on free nodes that is none.
NONE = 1e-12


def surface_dofs(system: System) -> Ints:
    """Translations of the nodes of all contact surfaces."""
    nodes: list[Ints] = []
    for pair in contact_of(system).pairs:
        nodes.append(pair.slave.node_list)
        if pair.master is not None:
            nodes.append(pair.master.node_list)
    every = np.unique(np.concatenate(nodes))
    found = np.concatenate([system.dofs(every, component) for component in (0, 1)])
    return np.sort(found[found >= 0])


def _parts(system: System, u: Floats, time: float, surfaces: Surfaces) -> tuple[Floats, Floats]:
    """Forces of contact on the nodes, and residuals of the constraints."""
    state = evaluate(system, u, surfaces.multipliers, time)
    return state.force, residuals(system, state, surfaces)


def _by_dofs(dofs: Ints, function: Callable[[int, float], Floats], step: float) -> Floats:
    columns = [all_derivatives(partial(function, int(dof)), step) for dof in dofs]
    return np.stack(columns, axis=1)


def solve(
    system: System, u: Floats, time: float, surfaces: Surfaces, rhs: Floats, moved: Floats
) -> tuple[Floats, Floats]:
    """Adjoint displacements and multipliers, shapes (n_dofs, m) and (n_multipliers, m).

    Raises
    ------
    UnsupportedError
        With constraints.
    """
    if system.model.constraints or system.model.axes:
        raise UnsupportedError("gradients with friction do not include constraints and local axes")
    term, n = contact_of(system), system.n_dofs
    at = system.evaluate(u, time)
    matrix = system.pattern.full(at.values).tocsr()
    if at.load_stiffness is not None:
        rows, columns, values = at.load_stiffness
        matrix = matrix - sp.coo_array((values, (rows, columns)), shape=(n, n)).tocsr()
    dofs, step = surface_dofs(system), STEP * system.cell_size

    def moves(dof: int, offset: float) -> Floats:
        other = u.copy()
        other[dof] += offset
        force, residual = _parts(system, other, time, surfaces)
        return np.concatenate([-force, residual])

    slopes = _by_dofs(dofs, moves, step)
    spread = sp.csr_array((np.ones(len(dofs)), (np.arange(len(dofs)), dofs)), shape=(len(dofs), n))
    matrix = matrix + sp.csr_array(slopes[:n]) @ spread
    rows_of = sp.csr_array(slopes[n:]) @ spread
    border, diagonal = _by_multipliers(system, u, time, surfaces)
    free = np.flatnonzero(~system.conditions.constrained)
    # A traction that supports take alone, as at a plane of symmetry, changes nothing.
    moved_by = norm(border[free], axis=0) > NONE * norm(border, axis=0)
    which = np.flatnonzero(surfaces.acting & moved_by)
    held = np.flatnonzero(system.conditions.constrained)
    whole = sp.block_array(
        [[matrix, border[:, which]], [rows_of[which], diagonal[which][:, which]]], format="csc"
    )
    unknowns = np.concatenate([free, n + np.arange(len(which))])
    transposed = whole.T.tocsr()
    given = np.concatenate([rhs, np.zeros((len(which), rhs.shape[1]))])
    given = given[unknowns] - transposed[unknowns][:, held] @ moved[held]
    found = splu(transposed[unknowns][:, unknowns].tocsc()).solve(np.ascontiguousarray(given))
    z, y = moved.copy(), np.zeros((term.n, rhs.shape[1]))
    z[free], y[which] = found[: len(free)], found[len(free) :]
    return z, y


def _by_multipliers(system: System, u: Floats, time: float, surfaces: Surfaces) -> tuple[Any, Any]:
    """Derivatives of the residuals of equilibrium and of the constraints by multipliers."""
    term = contact_of(system)
    state = evaluate(system, u, surfaces.multipliers, time)
    rows, columns, values = [], [], []
    for pair, terms in zip(term.pairs, state.terms, strict=True):
        acting = terms.acting
        dofs = pair.dofs(acting.variables)
        gradients = [(pair.first, acting.gap_gradient)]
        if pair.two:
            gradients.append((pair.first + pair.n, acting.slip_gradient))
        for first, gradient in gradients:
            number = np.broadcast_to(first + acting.constraint[:, None], dofs.shape)
            real = dofs >= 0
            rows.append(dofs[real])
            columns.append(number[real])
            values.append(-gradient[real])
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    border = sp.coo_array(entries, shape=(system.n_dofs, term.n)).tocsc()
    diagonal = sp.lil_array((term.n, term.n))
    for pair, slips, sign in zip(term.pairs, surfaces.slipping, surfaces.signs, strict=True):
        for k in np.flatnonzero(slips):
            own = pair.first + pair.n + k
            diagonal[own, own] = 1.0
            diagonal[own, pair.first + k] = -sign[k] * pair.friction[k]
    return border, diagonal.tocsr()


def by_start(
    system: System, u: Floats, time: float, surfaces: Surfaces, z: Floats, y: Floats
) -> Floats:
    """Derivative of ``z . r + y . g`` by the positions at the start, shape (n_dofs, m)."""
    term = contact_of(system)
    start, out = term.u, np.zeros(z.shape)
    dofs, step = surface_dofs(system), STEP * system.cell_size

    def moves(dof: int, offset: float) -> Floats:
        term.u = start.copy()
        term.u[dof] += offset
        force, residual = _parts(system, u, time, surfaces)
        return residual @ y - force @ z

    try:
        out[dofs] = _by_dofs(dofs, moves, step).T
    finally:
        term.u = start
    return out

"""Natural frequencies and modes about any equilibrium state.

The tangent of the state is the stiffness, so pre-stress and large displacements count; a
centrifugal load also softens (the frame of reference turns with the body; Coriolis forces are
left out).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, eigsh

from corota.drivers.motion import Inertia
from corota.errors import ModelError, SingularError
from corota.paths import Modes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.drivers.observers import Observers
    from corota.drivers.state import State
    from corota.drivers.system import Evaluation, System
    from corota.steps import Frequency

    Floats = NDArray[np.float64]

#: Free dofs up to which the dense eigenvalue solver is quicker.
DENSE = 150
#: Shift of a free body, relative to the largest ratio of stiffness to mass.
SHIFT = 1e-9


def frequency_step(
    system: System,
    step: Frequency,
    number: int,
    state: State,
    observers: Observers,
    save: Callable[[State, int, float, dict[str, float]], None],
    stops: list[float],
) -> None:
    """Find the lowest frequencies and their modes.

    Raises
    ------
    ModelError
        If a material has no density, or the state is unstable.
    """
    from corota.drivers.dynamics import check_density

    check_density(system)
    inertia = Inertia(system, step.mass)
    mass = inertia.tangent(state.u)
    base = system.evaluate(state.u, 0.0)
    softening = spin_softening(system)
    if softening:
        base.values -= softening * mass
    squares, shapes = lowest(system, base, mass, step.modes, step, number)
    frequencies = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi)
    by_node = np.array([system.by_node(shape) for shape in shapes.T])
    state.modes.append(
        Modes("frequency", number, frequencies, by_node.reshape(len(squares), -1, 3))
    )
    scalars = {f"frequency {k}": float(f) for k, f in enumerate(frequencies, start=1)}
    # Share of the mass that moves with each mode along x and y.
    total = inertia.momenta(state.u, np.zeros(system.n_dofs), False)[4]
    for axis in (0, 1):
        rigid = system.at_nodes(np.where(system.component == axis, 1.0, 0.0))
        share = (shapes.T @ system.product(mass, rigid)) ** 2 / total
        for k, value in enumerate(share, start=1):
            scalars[f"effective mass {'xy'[axis]} {k}"] = float(value)
    state.at = system.evaluate(state.u, 0.0)
    save(state, 1, 1.0, scalars)


def spin_softening(system: System) -> float:
    """Square of the angular velocity of the centrifugal load that acts, or 0 [1/time^2]."""
    rates = [
        scale * item.value[0]
        for item, scale in system.conditions.body_forces()
        if item.kind == "centrifugal"
    ]
    return float(sum(rates))


def lowest(
    system: System, base: Evaluation, mass: Floats, count: int, step: Frequency, number: int
) -> tuple[Floats, Floats]:
    """Lowest squares of the circular frequency, and shapes with unit modal mass.

    Returns
    -------
    squares : ndarray, shape (m,)
    shapes : ndarray, shape (n_dofs, m)
    """
    held = system.conditions.held
    zero = np.zeros(system.n_dofs)
    shift = 0.0
    try:
        _, negative = system.correct(replace(base, values=base.values.copy()), zero, zero)
    except SingularError:
        diagonal = system.indptr[1:].astype(np.int64) - 1
        heavy = mass[diagonal] > 0.0
        shift = SHIFT * float((base.values[diagonal][heavy] / mass[diagonal][heavy]).max())
        _, negative = system.correct(replace(base, values=base.values + shift * mass), zero, zero)
    if negative > 0:
        raise ModelError(
            f"the state before frequency step {number} is unstable ({negative} negative "
            "pivots): it has growing motions instead of frequencies",
            step.where,
        )

    n = system.n_dofs
    free = np.flatnonzero(~_held(system, held))
    if len(free) <= DENSE or 4 * count > len(free):
        return _dense(system, base, mass, count)

    # With constraints, vectors are those of all dofs that keep to them.
    def weigh(x: Floats) -> Floats:
        out = system.product(mass, np.where(held, 0.0, x.ravel()))
        out[held] = 0.0
        return out

    def invert(x: Floats) -> Floats:
        return system.solve_again(np.ascontiguousarray(x.ravel()))

    start = np.where(held, 0.0, np.random.default_rng(7).standard_normal(n))
    shape = (n, n)
    values, shapes = eigsh(
        # The matrix itself is not used where its inverse is given.
        LinearOperator(shape, matvec=weigh, dtype=float),
        k=count,
        M=LinearOperator(shape, matvec=weigh, dtype=float),
        sigma=-shift,
        OPinv=LinearOperator(shape, matvec=invert, dtype=float),
        v0=invert(weigh(start)),
    )
    order = np.argsort(values)
    return values[order], shapes[:, order]


def _dense(system: System, base: Evaluation, mass: Floats, count: int) -> tuple[Floats, Floats]:
    """Small systems, or most of a spectrum, by the dense solver."""
    link, pair = base.link, (base.values, mass)
    indices, indptr = system.indices, system.indptr
    if link is not None:
        zero = np.zeros(system.n_dofs)
        pair = (link.reduce(base.values, base.residual), link.reduce(mass, zero))
        indices, indptr = link.ties.places.indices, link.ties.places.indptr
    n = len(indptr) - 1
    free = np.flatnonzero(~_held(system, system.conditions.held))
    k, m = (
        csc_array((values, indices, indptr), shape=(n, n))[free][:, free].toarray()
        for values in pair
    )
    # Rotations that only their differences give inertia leave the mass singular: so the
    # stiffness, shifted to be definite, takes its place.
    shift = SHIFT * float((k.diagonal()[m.diagonal() > 0] / m.diagonal()[m.diagonal() > 0]).max())
    count = min(count, len(free))
    theta, shapes = eigh(
        m, k + shift * m, lower=False, subset_by_index=(len(free) - count, len(free) - 1)
    )
    moving = theta > np.finfo(float).eps * theta.max(initial=0.0)
    theta, shapes = theta[moving][::-1], shapes[:, moving][:, ::-1]
    out = np.zeros((n, len(theta)))
    out[free] = shapes / np.sqrt(theta)
    return 1.0 / theta - shift, out if link is None else system.expand(link, out)


def _held(system: System, held: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What holds of the dofs, for the unknowns that constraints leave."""
    return held if system.ties is None else held[system.ties.free]


__all__ = ["frequency_step", "lowest", "spin_softening"]

"""Natural frequencies and modes about any equilibrium state, real or complex.

The tangent of the state is the stiffness, so pre-stress, large displacements, loads that follow
and closed contact count. A centrifugal load also softens: the frame of reference turns with the
body. Coriolis forces and damping are included where complex modes are requested.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.linear.eigen import quadratic_modes, symmetric_modes, unsymmetric_modes
from corota.analysis.procedures.motion_start import check_density
from corota.analysis.terms.complex_stiffness import relaxing_note
from corota.analysis.terms.linearized import LinearMotion
from corota.errors import ModelError, UnsupportedError
from corota.model.paths import Modes

if TYPE_CHECKING:
    from corota.analysis.increment_loop import IncrementLoop
    from corota.analysis.state import State
    from corota.arrays import Complex, Floats
    from corota.model.steps import Frequency


#: Growth relative to the eigenvalue's size from which a mode is unstable.
GROWS = 1e-6
#: Squares of free motions are zero to this share of the largest that was found.
FREE = 1e-9


def frequency_step(loop: IncrementLoop, step: Frequency, stops: list[float]) -> None:
    """Find the lowest frequencies and their modes; name what makes the state unstable.

    Raises
    ------
    ModelError
        If a material has no density, or nothing that moves has mass.
    """
    system, number, state = loop.system, loop.number, loop.state
    check_density(system)
    lin = LinearMotion(system, state.u, step.mass)
    lin.turns = step.complex_modes
    if step.complex_modes:
        values, shapes = quadratic_modes(lin, lin.damping(step.rayleigh), step.modes)
    elif lin.symmetric:
        squares, real = _real_modes(lin, step)
        # Free motions have squares of rounding size, of either sign.
        noise = FREE * float(np.abs(squares).max(initial=0.0))
        values = np.where(squares < -noise, 1.0, 1j) * np.sqrt(np.abs(squares))
        shapes = real.astype(complex)
    else:
        if (step.lowest, step.highest) != (0.0, math.inf):
            raise UnsupportedError(
                "with loads without a potential modes are found by number, not by range", step.where
            )
        values, shapes = unsymmetric_modes(lin, step.modes)
        if np.any(lin.damping().data):
            state.notes.append(
                f"the damping of the model is ignored in frequency step {number}; "
                "complex_modes=True (*COMPLEX FREQUENCY) includes it"
            )
    if not len(values):
        raise ModelError(f"no free dof in frequency step {number} has mass", step.where)
    if note := relaxing_note(system):
        state.notes.append(f"frequency step {number}: {note}")
    modes = _modes(lin, values, shapes, number, step.complex_modes or not lin.symmetric)
    state.modes.append(modes)
    state.linear = lin
    _name_instability(modes, state, number, None if step.complex_modes else lin.symmetric)
    scalars = _scalars(lin, modes)
    state.at = system.evaluate(state.u, 0.0)
    loop.save(state, 1, 1.0, scalars)


def _real_modes(lin: LinearMotion, step: Frequency) -> tuple[Floats, Floats]:
    """Squares of circular frequencies in the range of the step, and shapes."""
    if (step.lowest, step.highest) == (0.0, math.inf):
        return symmetric_modes(lin, step.modes)
    skipped = _count_below(lin, step.lowest, step) if step.lowest else 0
    count = skipped + step.modes
    if step.highest < math.inf:
        inside = _count_below(lin, step.highest, step)
        count = inside if not step.modes else min(count, inside)
    if count <= skipped:
        raise ModelError(
            f"no frequency lies between {step.lowest:g} and {step.highest:g}", step.where
        )
    squares, shapes = symmetric_modes(lin, count)
    return squares[skipped:], shapes[:, skipped:]


def _count_below(lin: LinearMotion, frequency: float, step: Frequency) -> int:
    """Modes below a frequency: as many as the shifted stiffness has negative pivots."""
    square = (2.0 * math.pi * frequency) ** 2
    factor = lin.factor(lin.sub(lin.stiffness) - square * lin.sub(lin.mass), True)
    if factor.negative < 0:
        raise UnsupportedError(
            "with contact the modes in a range cannot be counted: give their number", step.where
        )
    return factor.negative


def _modes(
    lin: LinearMotion, values: Complex, shapes: Complex, number: int, complex_ones: bool
) -> Modes:
    """Modes by node, with unit modal mass and the largest component of complex ones real."""
    system = lin.system
    mass = lin.sub(lin.mass)
    for k in range(shapes.shape[1]):
        x = shapes[:, k]
        largest = x[np.abs(x).argmax()] or 1.0
        x = x * (abs(largest) / largest)
        size = float((x.conj() @ (mass @ x)).real)
        shapes[:, k] = x / math.sqrt(size) if size > 0.0 else x
    dofs = lin.expand(lin.from_active(shapes))

    def by_node(part: Floats) -> Floats:
        found = np.array([system.by_node(shape) for shape in part.T])
        return found.reshape(len(values), -1, 3)

    return Modes(
        "frequency",
        number,
        values.imag / (2.0 * math.pi),
        by_node(dofs.real),
        values.real.copy(),
        by_node(dofs.imag) if complex_ones else None,
    )


def _name_instability(modes: Modes, state: State, number: int, symmetric: bool | None) -> None:
    """Say which modes grow, and how."""
    size = np.abs(modes.growth + 2j * math.pi * modes.factors)
    largest = float(size.max(initial=0.0))
    growing = np.flatnonzero(modes.growth > GROWS * np.maximum(size, GROWS * largest))
    for k in growing.tolist():
        rate, f = modes.growth[k], modes.factors[k]
        flutter = 2.0 * math.pi * f > GROWS * rate
        how = (
            f"flutter: mode {k + 1} oscillates at {f:.6g} per time and grows at the rate {rate:.6g}"
            if flutter
            else f"divergence: mode {k + 1} grows at the rate {rate:.6g} without oscillation"
        )
        note = f"the state of frequency step {number} is unstable by {how} per time"
        state.notes.append(note)
        warnings.warn(note, stacklevel=2)


def _scalars(lin: LinearMotion, modes: Modes) -> dict[str, float]:
    """Frequencies, growth and damping, and effective masses of real modes."""
    scalars = {f"frequency {k}": float(f) for k, f in enumerate(modes.factors, start=1)}
    if modes.imaginary is not None or (modes.growth != 0.0).any():
        for k, (rate, f) in enumerate(zip(modes.growth, modes.factors, strict=True), start=1):
            size = math.hypot(rate, 2.0 * math.pi * f)
            scalars[f"growth rate {k}"] = float(rate)
            scalars[f"damping ratio {k}"] = float(-rate / size) if size else 0.0
    if modes.imaginary is not None:
        return scalars
    # Share of the mass that moves with each mode along x and y.
    system = lin.system
    total = lin.inertia.momenta(lin.u, np.zeros(system.n_dofs), False)[4]
    shapes = np.array([system.from_nodes(shape) for shape in modes.shapes]).T
    for axis in (0, 1):
        rigid = system.at_nodes(np.where(system.component == axis, 1.0, 0.0))
        share = (shapes.T @ system.product(lin.mass_values, rigid)) ** 2 / (total or 1.0)
        for k, value in enumerate(share, start=1):
            scalars[f"effective mass {'xy'[axis]} {k}"] = float(value)
    return {**scalars, **_participation(lin, shapes)}


def _participation(lin: LinearMotion, shapes: Floats) -> dict[str, float]:
    """Participation of modes in rigid motions of the free dofs, and the mass of these.

    As CalculiX prints them: along x, y and about the origin, with constrained dofs at rest.
    """
    system = lin.system
    motions = np.ascontiguousarray(system.rigid_motions(system.model.mesh.points).T)
    scalars: dict[str, float] = {}
    for name, rigid in zip(("x", "y", "rotation"), motions, strict=True):
        rigid[system.conditions.constrained] = 0.0
        force = system.product(lin.mass_values, rigid)
        for k, value in enumerate(shapes.T @ force, start=1):
            scalars[f"participation {name} {k}"] = float(value)
        scalars[f"moving mass {name}"] = float(rigid @ force)
    return scalars

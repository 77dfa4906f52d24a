"""Error of the integration of plastic flow over an increment, relative to its work.

The return map takes the flow of a whole increment in the direction of the stress at its end (R. D.
Krieg, D. B. Krieg, J. Press. Vess. Tech. 99 (1977) 510). Where that direction turns, stress is
wrong by the first order of the increment. As in error control by two orders (S. W. Sloan, Int. J.
Numer. Meth. Engng 24 (1987) 893), the end is reached in one step and in two, by a state in the
middle of the increment; in proportional loading both are the same. The von Mises stress of the
difference does work on the flow of the increment. Over all points, that is related to the plastic
work of the increment and the elastic energy at its end.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure

if TYPE_CHECKING:
    from corota.analysis.newton import Outcome
    from corota.analysis.procedures.static import StaticStepper
    from corota.arrays import Floats

#: Residual of the state in the middle of an increment.
MIDDLE = 1e-3
#: Share of the largest work in the step to which the error of a small increment is related.
SHARE = 0.25
#: Note of the iterations that find that state.
HALFWAY = "middle of the increment, for the error of plastic flow"


def plastic_error(stepper: StaticStepper, outcome: Outcome, target: float) -> float:
    """Error of an increment that ends with an equilibrium at a step time.

    Parameters
    ----------
    stepper : StaticStepper
        Takes the plastic work as `spent`, and the largest work of the step.

    Returns
    -------
    float
        Infinite if it cannot be found.

    Notes
    -----
    The path of displacements is taken to bend as it did since the increment before. Where there
    was none, or if the error is too large by that path, the state in the middle is solved for. An
    increment whose middle is not found is too long.
    """
    system, u0, u1 = stepper.system, stepper.state.u, outcome.u
    if system.depends_on_time or system.elements.user.blocks:
        return 0.0
    if not system.elements.plastic_increment():
        return 0.0
    begun = stepper.control.time
    dt = target - begun
    middle = begun + 0.5 * dt
    moved, straight = u1 - u0, 0.5 * (u0 + u1)
    system.elements.heat(begun)
    old = [strain for _, strain, _ in _points(stepper, u0)[0]]
    system.elements.heat(target)
    once, energy = _points(stepper, u1)
    total = system.communicator.sum

    def work(stresses: list[Floats], strains: list[Floats]) -> float:
        """Work of equivalent stresses on the flow of the increment."""
        each = zip(stresses, strains, old, once, strict=True)
        work = sum(float(np.sum(s * (p - p0) * volume)) for s, p, p0, (_, _, volume) in each)
        return float(total(np.array([work]))[0])

    stepper.spent = work([_mises(s) for s, _, _ in once], [p for _, p, _ in once])
    whole = stepper.spent + energy
    stepper.largest_work = max(stepper.largest_work, stepper.worked + whole)
    whole = max(whole, SHARE * stepper.largest_work)
    if 2.0 * stepper.spent <= stepper.plastic_tolerance * whole:
        return 0.0  # no stress is wrong by more than twice the yield stress
    values, lengths = system.core.state()

    def error(halfway: Floats) -> float:
        try:
            system.forces(halfway, middle)
            system.core.commit()
            system.forces(u1, target)
            twice, _ = _points(stepper, u1)
        except ElementFailure:
            return math.inf
        finally:
            system.core.restore_state(values, lengths)
        wrong = [_mises(b[0] - a[0]) for a, b in zip(once, twice, strict=True)]
        flow = [np.maximum(a[1], b[1]) for a, b in zip(once, twice, strict=True)]
        return work(wrong, flow) / whole

    found = math.inf
    if stepper.moved is not None:
        bend = 0.25 * dt / (dt + stepper.lasted)
        found = error(straight + bend * (dt / stepper.lasted * stepper.moved - moved))
    if found > stepper.plastic_tolerance:
        kept = stepper.settings
        stepper.settings = replace(kept, tolerance=max(kept.tolerance, MIDDLE))
        between, _ = stepper.equilibrium(
            middle, None, before=outcome.iterations, begin=straight, how=HALFWAY
        )
        stepper.settings = kept
        stepper.loop.count("iterations", between.iterations)
        if not between.reason:
            found = error(between.u)
    system.forces(u1, target)
    return found


def _points(stepper: StaticStepper, u: Floats) -> tuple[list[tuple[Floats, Floats, Floats]], float]:
    """Stress, equivalent plastic strain and volume of all points; the elastic energy."""
    system, found, energy = stepper.system, [], 0.0
    for own in system.core.recover(system.in_space(u), system.nlgeom):
        values = own["values"]
        energy += own["total_energy"]
        if "PEEQ" in values and "S" in values:
            found.append((values["S"], values["PEEQ"], own["volume"]))
    return found, float(system.communicator.sum(np.array([energy]))[0])


def _mises(stress: Floats) -> Floats:
    """Equivalent stress, shape (n, points), of shape (n, points, 4)."""
    direct = stress[..., :3] - stress[..., :3].mean(axis=-1, keepdims=True)
    squared: Floats = 1.5 * np.sum(direct**2, axis=-1) + 3.0 * stress[..., 3] ** 2
    return np.sqrt(squared)

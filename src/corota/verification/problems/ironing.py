"""Ironing: a round elastic die is pressed into a softer block and moved across it.

Block 9 x 3, E = 1; die of radius 1.5, E = 10, nu = 0.3, plane strain, logarithmic strain; 0.3 down,
then 4 across, over many cells. There is no formula for the forces. Without friction there is no
resistance to the sliding (all positions are equivalent); with friction 0.3, slip occurs at exactly
0.3 of the pressure; both bodies are in equilibrium; and the work equals strain energy and
frictional dissipation.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.contact_models import ACROSS, ironing, steps
from corota.verification.models import run

FRICTION = 0.3


@cache
def solved(friction: float, finer: int = 1) -> ct.Results:
    """Press and draw; `finer` divides the increments."""
    way = steps()
    for step in way:
        step.first_increment /= finer
        step.largest_increment = 0.1 / finer
    return run(ironing(friction, n=8), list(way), fields=True)


def forces(results: ct.Results) -> np.ndarray:
    """Step time across, force across and down at the top of the die, shape (n, 3)."""
    top = results.mesh.nodes_of("die.top")
    frames = [f for f in results.frames if f.step == 2]
    return np.array([[f.step_time, f.RF[top, 0].sum(), -f.RF[top, 1].sum()] for f in frames])


def work(results: ct.Results) -> float:
    """Work of the loads over the energy that is stored and the friction's."""
    last = results.frames[-1].scalars
    return last["external work"] / (last["strain energy"] + last["friction energy"])


def measure() -> Iterator[Value]:
    """Forces, balance, Coulomb's law, work."""
    for friction in (0.0, FRICTION):
        results = solved(friction)
        mesh, text = results.mesh, f"friction {friction:g}"
        time, across, down = forces(results).T
        middle = (time > 0.3) & (time < 0.7)
        ratio = float(across[middle].mean() / down[middle].mean())
        if friction:
            yield Value(f"force across / down at most, {text}", friction, ratio, 0.0, "at most")
            yield Value(f"force across / down, {text}", 0.9 * friction, ratio, 0.0, "at least")
        else:
            yield zero(f"force across / down, {text}", ratio, 2e-3)
        balance, law = 0.0, 0.0
        for frame in results.frames[1:]:
            total = sum(
                frame.RF[mesh.nodes_of(n), :2].sum(axis=0) for n in ("die.top", "block.bottom")
            )
            balance = max(balance, float(np.abs(total).max()))
            assert frame.C is not None
            slips = frame.C[:, 4] == 2.0
            differ = np.abs(frame.C[slips, 1]) - friction * frame.C[slips, 0]
            law = max(law, float(np.abs(differ).max(initial=0.0)))
        yield zero(
            f"resultant of all supports / force down, {text}", balance / float(down.max()), 1e-7
        )
        if friction:
            yield zero(f"shear less friction times pressure, {text}", law, 1e-9)
        yield Value(f"work over strain energy and friction, {text}", 1.0, work(results), 0.03)


def picture() -> Picture:
    """Half way across."""
    results = solved(FRICTION)
    half = [f for f in results.frames if f.step == 1 or f.step_time <= 0.51]
    return Picture(ct.Results(results.model, half), "MISES")


def curve() -> Curve:
    """Forces against the way."""
    series = {}
    for friction in (0.0, FRICTION):
        time, across, down = forces(solved(friction)).T
        series[f"down, friction {friction:g}"] = (ACROSS * time, down)
        series[f"across, friction {friction:g}"] = (ACROSS * time, across)
    return Curve("way across", "force on the die", series)


def study() -> Study:
    """Error of the balance of energy against increments of the way across."""
    finer = (1, 2, 4)
    return Study(
        "energy-balance error of work, strain energy and friction",
        {
            f"friction {f:g}": (
                [10.0 * k for k in finer],
                [abs(work(solved(f, k)) - 1.0) for k in finer],
            )
            for f in (0.0, FRICTION)
        },
        "increments across",
    )


PROBLEM = Problem(
    title="Ironing",
    group="contact",
    source="symmetry, Coulomb's law, balance of forces and energy",
    certainty="analytic",
    why="the ends of the block; the work is summed by trapezoids over the increments",
    picture=picture,
    seconds=1.5,
)

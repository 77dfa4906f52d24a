"""Whether the reason that a contact run gives for its end is right, by means of its own.

A message may name plastic collapse, a limit point, an unstable equilibrium or faces in no pair. The
first two are looked for in the states of the run. An equilibrium is unstable if the bodies move
away from it in dynamics, under the same loads. Faces were missing if the run ends with the whole
boundaries in the pair. A message that names nothing of this kind ("no progress", "no
equilibrium nearby") gives no reason: such a run counts as failed.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from corota.mesh.parts import part_of_cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from benchmarks.corpora.contact_problems import Problem

    Floats = NDArray[np.float64]

#: Displacement per load at a limit over that of the first increment.
SOFT = 5.0
#: Share of the internal energy that has flowed where a structure collapses plastically.
FLOWED = 0.1
#: Distance from the end at which the last equilibrium is computed again, over its load factor.
BEFORE = 2e-4
#: Displacement over the size of the model that shows that bodies move away ...
AWAY = 0.1
#: ... within this time, over that of a compression wave through the model.
WAVES = 300.0


def reason(given: Problem, results: ct.Results | None, why: str) -> tuple[str, bool]:
    """Reason that a message names, and whether the states of the run show it.

    Returns
    -------
    named : str
        ``"collapse"``, ``"limit point"``, ``"unstable"``, ``"no pair"``, or ``"none"``.
    right : bool
    """
    if results is None or len(results.frames) < 3:
        return "none", False
    if "plastic collapse:" in why:
        return "collapse", _soft(results) and _flowed(results)
    if why.startswith("limit point"):
        yields = "with yielding" not in why or _flowed(results)
        return "limit point", yields and _soft(results)
    if "The last equilibrium is unstable" in why:
        return "unstable", _departs(given, results)
    if "in no pair" in why:
        return "no pair", _finishes_with_whole_surfaces(given)
    return "none", False


def _finishes_with_whole_surfaces(given: Problem) -> bool:
    """Whether the run ends with the whole boundary of each body in its pair."""
    model = given.model.copy()
    part, edges = part_of_cells(model.mesh), model.mesh.boundary_edges()
    for pair in model.contacts:
        for side in ("slave", "master"):
            surface: Any = getattr(pair, side)
            if not isinstance(surface, ct.RigidCurve):
                own = part[model.mesh.edge_pairs(surface)[:, 0]]
                setattr(pair, side, edges[np.isin(part[edges[:, 0]], own)])
    try:
        ct.solve(model, given.steps, threads=1, fields=False)
    except ct.ConvergenceError:
        return False
    return True


def _soft(results: ct.Results) -> bool:
    """Whether displacements grow much faster with the load at the end of a step than at first.

    The slope of a limit point has no bound: the last two increments count.
    """
    last = [f for f in results.frames if f.step == results.frames[-1].step]
    u = [f.U for f in last]
    factor = np.array([f.factor for f in last])
    if len(last) < 3:
        return False
    way = np.array([np.abs(b - a).max() for a, b in zip(u, u[1:], strict=False)])
    rise = np.abs(np.diff(factor))
    known = rise > 0.0
    slope = way[known] / rise[known]
    return bool(len(slope) > 1 and slope[-2:].max() >= SOFT * slope[0])


def _flowed(results: ct.Results) -> bool:
    """Whether plastic work is a notable part of the internal energy."""
    of = results.frames[-1].scalars
    return float(of.get("ALLPD", 0.0)) >= FLOWED * abs(float(of.get("ALLIE", np.inf)))


def _departs(given: Problem, results: ct.Results) -> bool:
    """Whether the bodies move away from the last equilibrium in dynamics, under its loads."""
    last = results.frames[-1]
    factors = [f.factor for f in results.frames if f.step == last.step]
    factor = max((f for f in factors if f <= last.factor * (1.0 - BEFORE)), default=0.0)
    earlier, step = given.steps[: last.step - 1], given.steps[last.step - 1]
    model = given.model.copy()
    if not earlier:
        for item in [*model.supports, *model.loads]:
            item.value = _scaled(item.value, factor)
    begin = {_place(s): s.value for each in earlier for s in each.supports}
    held = []
    for support in step.supports:
        start = begin.get(_place(support), 0.0)
        held.append(replace(support, value=start + factor * (support.value - start)))
    size = float(np.ptp(model.mesh.points, axis=0).max())
    law: Any = model.sections[0].material
    motion = ct.Dynamic(period=WAVES * size * np.sqrt(law.rho / law.E), max_increments=10_000)
    try:
        found = ct.solve(
            model, [*earlier, replace(step, supports=held), motion], threads=1, fields=False
        )
    except ct.ConvergenceError as error:
        found = error.results
    frames = {n: [f for f in found.frames if f.step == last.step + n] for n in (0, 1)}
    if not frames[0] or not frames[1]:
        return False
    start = frames[0][-1].U[:, :2]
    moved = max(float(np.abs(f.U[:, :2] - start).max()) for f in frames[1])
    return moved >= AWAY * size


def _scaled(value: Any, factor: float) -> Any:
    if isinstance(value, tuple | list):
        return type(value)(factor * v for v in value)
    return factor * value


def _place(support: Any) -> tuple[str, int]:
    return str(support.nodes), support.dof


__all__ = ["reason"]

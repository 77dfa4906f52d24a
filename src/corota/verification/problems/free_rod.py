"""Free flexible rod (Simo and Vu-Quoc): results that do not depend on its flexibility.

A rod from (6, 0) to (0, 8), mass 1 per unit length, EA = 10000, EI = 100, is loaded at its lower
end by a force of 8 along x and a moment of 80 for 2.5 units of time, and then flies freely with
bending vibrations. Its center moves as x = 3 + 0.4 t^2, then 5.5 + 2 (t - 2.5), and y = 4. Its
momentum reaches 20; then angular momentum and energy are constant. A planar strip does not have the
rotary inertia of the published beam, so shapes are not compared.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

import corota as ct
from corota.model import elements
from corota.verification.beam_models import polyline
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.models import cell, run

PUSH, END, CELLS = 2.5, 4.0, 12
DEPTH = float(np.sqrt(12.0 * 100.0 / 1e4))


def rod(element: str) -> tuple[ct.Model, int]:
    """The rod; with the node at its lower end that is pushed."""
    if elements.find(element).line:
        model = ct.Model(polyline(np.linspace([6.0, 0.0], [0.0, 8.0], CELLS + 1)))
        material = ct.Elastic(E=1e4, nu=0.0, rho=1.0)
        model.beam(np.arange(CELLS), material=material, area=1.0, inertia=0.01)
        return model, 0
    ny = 1 if element == "Q4I" else 2
    mesh = ct.mesh.rectangle(10.0, DEPTH, CELLS, ny, cell(element), origin=(0.0, -0.5 * DEPTH))
    angle = float(np.degrees(np.arctan2(8.0, -6.0)))
    mesh = ct.mesh.move(mesh, shift=(6.0, 0.0), angle=angle)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1e4 / DEPTH, nu=0.0, rho=1.0 / DEPTH)
    model.section("all", element=element, material=material)
    pushed = int(np.argmin(np.hypot(*(mesh.points - [6.0, 0.0]).T)))
    if not elements.find(element).drilling:
        model.rigid(np.setdiff1d(mesh.nodes_of("left"), pushed), pushed)
    return model, pushed


@cache
def flown(element: str, **keys: Any) -> ct.Results:
    """Push, then fly: increments of 0.01."""
    model, node = rod(element)
    where = np.array([node])
    loads: list[Any] = [ct.NodalForce(where, 0, 8.0), ct.NodalForce(where, 2, 80.0)]
    common: dict[str, Any] = {
        "scheme": "energy_momentum",
        "tolerance": 1e-11,
        "max_iterations": 40,
    }
    push = ct.Dynamic(period=PUSH, increments=250, loads=loads, **common)
    free = ct.Dynamic(period=END - PUSH, increments=150, new_loads=True, **common)
    return run(model, [push, free], **keys)


def center(results: ct.Results) -> np.ndarray:
    """Time and center of mass of each frame, shape (n, 3), of lines and of linear cells.

    Nodes of a regular mesh weigh as the mass that their shape functions carry.
    """
    mesh = results.mesh
    weight = np.zeros(mesh.n_nodes)
    for cells in mesh.cells:
        np.add.at(weight, cells.nodes.ravel(), 1.0)
    weight /= weight.sum()
    return np.array([[f.time, *(weight @ (mesh.points + f.U))] for f in results.frames])


def measure() -> Iterator[Value]:
    """Path of the center, momenta, energy."""
    for element in ("Q4I", "Q4D", "OPT", "BEAM"):
        results = flown(element)
        frames = [f for f in results.frames if f.increment > 0]
        late = [f.scalars for f in frames if f.step == 2]
        yield Value(f"momentum at the end, {element}", 20.0, late[-1]["momentum x"], 1e-9)
        yield zero(f"momentum across, {element}", late[-1]["momentum y"], 1e-8)
        size = max(s["kinetic energy"] for s in late)
        for name in ("angular momentum", "energy balance"):
            change = float(np.ptp([s[name] for s in late])) / size
            yield zero(f"drift of the {name} in flight, {element}", change, 1e-9)
        if element == "Q4I":
            time, x, y = center(results).T
            exact = np.where(time < PUSH, 3.0 + 0.4 * time**2, 5.5 + 2.0 * (time - PUSH))
            yield zero(f"error of the center's path x, {element}", np.abs(x - exact).max(), 1e-8)
            yield zero(f"error of the center's path y, {element}", np.abs(y - 4.0).max(), 1e-8)
        bent = float(np.ptp([s["internal work"] for s in late])) / size
        yield Value(f"strain energy that comes and goes, {element}", 1e-3, bent, 0.0, "at least")


def picture() -> Picture:
    """The rod when the push ends."""
    results = flown("Q4D", fields=True)
    return Picture(ct.Results(results.model, [f for f in results.frames if f.step == 1]), "S11")


def curve() -> Curve:
    """Path of the center, and strain energy."""
    time, x, _ = center(flown("Q4I")).T
    some = np.linspace(0.0, END, 11)
    exact = np.where(some < PUSH, 3.0 + 0.4 * some**2, 5.5 + 2.0 * (some - PUSH))
    return Curve("time", "x of the center", {"Q4I": (time, x)}, {"exact": (some, exact)})


PROBLEM = Problem(
    title="Free flexible rod",
    group="dynamics",
    source="laws of momentum; data: J. C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986)",
    certainty="analytic",
    why="Newton's tolerance of 1e-11 over 400 increments",
    picture=picture,
    seconds=3.0,
)

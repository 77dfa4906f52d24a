"""Simply supported beam under a sine force in its middle, small displacements: a sum of modes.

Length 10 m, 0.3 m wide, 0.1 m deep, E = 200 GPa, density 700 kg/m^3, 100 N sin(w t) from rest, with
w = 2 and 30 1/s; the first angular frequency is 48. By Euler and Bernoulli the middle moves by the
sum over odd n of ``2 F / (rho A L) (sin w t - w / w_n sin w_n t) / (w_n^2 - w^2)``. It is computed
with beam elements and with Q8, by direct integration and by modal superposition.
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
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import nearest, run

LENGTH, WIDTH, DEPTH, YOUNG, DENSITY, FORCE = 10.0, 0.3, 0.1, 200e9, 700.0, 100.0
PERIOD = 0.4
CASES = [("BEAM", "newmark"), ("BEAM", "modal"), ("Q8", "newmark"), ("Q8", "modal")]


def beam(element: str, speed: float) -> tuple[ct.Model, int]:
    """The beam; with the node in its middle."""
    material = ct.Elastic(E=YOUNG, nu=0.0, rho=DENSITY)
    if elements.find(element).line:
        points = np.linspace([0.0, 0.0], [LENGTH, 0.0], 41)
        model = ct.Model(polyline(points))
        inertia = WIDTH * DEPTH**3 / 12.0
        model.beam(np.arange(40), material=material, area=WIDTH * DEPTH, inertia=inertia)
    else:
        mesh = ct.mesh.rectangle(LENGTH, DEPTH, 40, 1, "quad8", origin=(0.0, -0.5 * DEPTH))
        model = ct.Model(mesh)
        model.section("all", element=element, material=material, thickness=WIDTH)
    points = model.mesh.points
    model.fix([nearest(model.mesh, 0.0, 0.0)])
    model.fix([nearest(model.mesh, LENGTH, 0.0)], x=None)
    time = np.linspace(0.0, PERIOD, 4001)
    model.amplitudes["sine"] = ct.Amplitude(time, np.sin(speed * time))
    middle = int(np.argmin(np.hypot(points[:, 0] - 0.5 * LENGTH, points[:, 1] + 0.5 * DEPTH)))
    return model, middle


@cache
def moved(element: str, way: str, speed: float, increments: int = 800) -> tuple[Any, Any]:
    """Times, and displacements of the middle."""
    model, middle = beam(element, speed)
    keys: dict[str, Any] = {
        "period": PERIOD,
        "increments": increments,
        "nlgeom": False,
        "loads": [ct.NodalForce(np.array([middle]), 1, FORCE, "sine")],
    }
    steps: Any = ct.Dynamic(scheme="newmark", **keys)
    if way == "modal":
        steps = [ct.Frequency(modes=12, nlgeom=False), ct.ModalDynamic(**keys)]
    results = run(model, steps)
    last = results.frames[-1].step
    frames = [f for f in results.frames if f.step == last and f.increment > 0]
    return (np.array([f.step_time for f in frames]), np.array([f.U[middle, 1] for f in frames]))


def exact(time: Any, speed: float) -> np.ndarray:
    """The sum of 50 modes."""
    t, out = np.asarray(time, float), np.zeros(len(time))
    bending = YOUNG * WIDTH * DEPTH**3 / 12.0
    line = DENSITY * WIDTH * DEPTH
    for n in range(1, 100, 2):
        own = (n * np.pi / LENGTH) ** 2 * np.sqrt(bending / line)
        wave = np.sin(speed * t) - speed / own * np.sin(own * t)
        out += 2.0 * FORCE / (line * LENGTH) * wave / (own**2 - speed**2)
    return out


def measure() -> Iterator[Value]:
    """Largest error over the largest displacement."""
    for element, way in CASES:
        for speed in (2.0, 30.0):
            time, found = moved(element, way, speed)
            known = exact(time, speed)
            worst = float(np.abs(found - known).max() / np.abs(known).max())
            yield zero(f"largest error at {speed:g} 1/s, {element}, {way}", worst, 5e-3)
            k = int(np.abs(known).argmax())
            yield Value(
                f"largest displacement [m], {speed:g} 1/s, {element}, {way}",
                known[k],
                found[k],
                5e-3,
            )


def picture() -> Picture:
    """The beam and its load."""
    model, middle = beam("Q8", 30.0)
    model.force([middle], y=FORCE)
    return Picture(model)


def curve() -> Curve:
    """Displacement over time."""
    time, found = moved("BEAM", "newmark", 30.0)
    fine = np.linspace(0.0, PERIOD, 400)
    return Curve(
        "time [s]",
        "displacement of the middle [mm]",
        {"sum of modes": (fine, 1e3 * exact(fine, 30.0))},
        {"beams, 800 increments": (time[::25], 1e3 * found[::25])},
    )


def study() -> Study:
    """Error against increments."""

    def worst(way: str, n: int) -> float:
        time, found = moved("BEAM", way, 30.0, n)
        known = exact(time, 30.0)
        return float(np.abs(found - known).max() / np.abs(known).max())

    label = "largest error / largest displacement, down to that of 40 beams"
    return Study.over(label, ("newmark", "modal"), (100, 200, 400, 800), worst, "increments")


PROBLEM = Problem(
    title="Beam under a sine force",
    group="dynamics",
    source="modes of the Euler-Bernoulli beam; data of a published example of beam vibration",
    certainty="analytic",
    why="phase error of 800 increments, modes above the twelfth, shear and rotary inertia",
    picture=picture,
    seconds=2.0,
)

"""Cantilever under a sine force at its end (T.-N. Le, J.-M. Battini and M. Hjiaj).

Length 10 m, section 0.5 m x 0.25 m, E = 210 GPa, nu = 0.3, density 7850 kg/m^3, a force of 10 MN
sin(50 t): the end moves by two thirds of the length. The published curves are not available as
numbers. The reference is our beam element (60 elements, 960 increments, with shear and rotary
inertia), whose path changes by 0.03 % of the length with 90 elements and 4800 increments.
Energy-momentum scheme; 32 cells along, 2 across.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.beam_models import polyline
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import run
from corota.verification.motion_models import (
    DENSITY,
    DEPTH,
    FORCE,
    LENGTH,
    OMEGA,
    PERIOD,
    POISSON,
    WIDTH,
    YOUNG,
    sine_cantilever,
    sine_path,
)


@cache
def beams(n: int = 60, increments: int = 960) -> np.ndarray:
    """Displacement of the end at 30 equal times by `n` beams, shape (30, 2) [m]."""
    model = ct.Model(polyline(np.linspace([0.0, 0.0], [LENGTH, 0.0], n + 1)))
    area = WIDTH * DEPTH
    model.beam(
        np.arange(n),
        material=ct.Elastic(E=YOUNG, nu=POISSON, rho=DENSITY),
        area=area,
        inertia=WIDTH * DEPTH**3 / 12.0,
        shear_area=area * 5.0 / 6.0,
    )
    model.fix([0], rotation=True)
    time = np.linspace(0.0, PERIOD, 1501)
    model.amplitudes["sine"] = ct.Amplitude(time, np.sin(OMEGA * time))
    model.force([n], y=FORCE, amplitude="sine")
    step = ct.Dynamic(period=PERIOD, increments=increments, scheme="energy_momentum")
    every = increments // 30
    return np.array([f.U[n] for f in run(model, step).frames[every::every]])


@cache
def solid(element: str, cells: int = 32, increments: int = 480) -> np.ndarray:
    """The cantilever of planar elements."""
    return sine_path(element, increments, cells=cells)


def measure() -> Iterator[Value]:
    """Largest deflection, and the largest distance between the paths."""
    known = beams()
    for element, tolerance in (("Q8", 0.005), ("Q4I", 0.02), ("OPT", 0.02), ("Q4D", 0.02)):
        found = solid(element)
        yield Value(
            f"largest deflection [m], {element} 32 x 2",
            np.abs(known[:, 1]).max(),
            np.abs(found[:, 1]).max(),
            0.005,
        )
        distance = float(np.hypot(*(found - known).T).max()) / LENGTH
        yield zero(f"largest distance of the paths / length, {element} 32 x 2", distance, tolerance)


def picture() -> Picture:
    """The cantilever at its largest deflection."""
    model, tip = sine_cantilever("Q8", 32)
    step = ct.Dynamic(period=PERIOD, increments=480, scheme="energy_momentum")
    results = run(model, step, fields=True)
    k = int(np.argmax([abs(f.U[tip, 1]) for f in results.frames]))
    return Picture(ct.Results(model, results.frames[: k + 1]), "S11")


def curve() -> Curve:
    """Deflection and shortening over time."""
    time = PERIOD * np.arange(1, 31) / 30.0
    known, found = beams(), solid("Q8")
    return Curve(
        "time [s]",
        "displacement of the end [m]",
        {"across, beams": (time, known[:, 1]), "along, beams": (time, known[:, 0])},
        {"across, Q8 32 x 2": (time, found[:, 1]), "along, Q8 32 x 2": (time, found[:, 0])},
    )


def study() -> Study:
    """Distance of the paths with cells and increments refined together."""
    return Study.over(
        "largest distance of the paths / length",
        ("Q4I", "Q4D", "OPT", "Q8"),
        (12, 16, 24, 32),
        lambda e, n: float(np.hypot(*(solid(e, n, 15 * n) - beams()).T).max()) / LENGTH,
        "cells along",
    )


PROBLEM = Problem(
    title="Cantilever under a sine force (Le, Battini, Hjiaj)",
    group="dynamics",
    source="data: T.-N. Le, J.-M. Battini, M. Hjiaj, Comput. Methods Appl. Mech. Engrg 200 (2011); "
    "path by beams",
    certainty="converged here",
    why="the motion is followed through six swings, over which the phase errors of 32 cells add up",
    picture=picture,
    seconds=6.0,
)

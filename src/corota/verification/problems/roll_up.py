"""Roll-up: a cantilever bent to a full circle by the end moment 2 pi EI / L.

Length 10, depth 0.1, nu = 0. With drilling rotations the moment acts on the nodes of the end; the
values are the positions of the end at a quarter, half, three quarters and all of the moment.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Study, Value, zero
from corota.verification.models import Watch, cantilever, last_frames, run

LENGTH, HEIGHT, YOUNG = 10.0, 0.1, 1.2e9
#: Share of the full moment, and the position of the end over the length.
EXACT = {
    0.25: (0.6366197724, 0.6366197724),
    0.5: (0.0, 0.6366197724),
    0.75: (-0.2122065908, 0.2122065908),
    1.0: (0.0, 0.0),
}
MESHES = {"OPT": (200, 2), "Q4D": (200, 4)}


def solved(element: str, nx: int, ny: int, watch: Watch | None = None, **keys: Any) -> ct.Results:
    """Four steps of four increments."""
    model = cantilever(element, LENGTH, HEIGHT, nx, ny, E=YOUNG)
    tip = model.mesh.node_sets["right"]
    moment = 2.0 * np.pi * YOUNG * HEIGHT**3 / 12.0 / LENGTH / len(tip)
    steps: list[Any] = [
        ct.Static(loads=[ct.NodalForce(tip, 2, part * moment)], increments=4) for part in EXACT
    ]
    return run(model, steps, observers=[watch] if watch else [], **keys)


def places(results: ct.Results, every: bool = False) -> np.ndarray:
    """Position of the end over the length after each step, or in every frame."""
    mesh = results.mesh
    tip = mesh.node_sets["right"]
    frames = results.frames if every else last_frames(results)
    return np.array([(mesh.points[tip] + f.U[tip]).mean(axis=0) for f in frames]) / LENGTH


def measure() -> Iterator[Value]:
    """Distance of the end from its exact place."""
    for element, (nx, ny) in MESHES.items():
        for (part, exact), found in zip(
            EXACT.items(), places(solved(element, nx, ny)), strict=True
        ):
            miss = float(np.hypot(*(found - exact)))
            yield zero(f"miss of the end / L at {part:g}, {element} {nx} x {ny}", miss, 2e-3)


def curve() -> Curve:
    """Path of the end, and the exact cycloid-like curve sin(a)/a, (1 - cos a)/a."""
    path = places(solved("Q4D", 100, 4), every=True)
    a = np.linspace(1e-6, 2.0 * np.pi, 60)
    return Curve(
        "x / L",
        "y / L",
        {"exact": (np.sin(a) / a, (1.0 - np.cos(a)) / a)},
        {"end, Q4D 100 x 4": (path[:, 0], path[:, 1])},
    )


def study() -> Study:
    """Miss of the end at the full moment."""
    return Study.over(
        "miss of the end over the length",
        MESHES,
        (25, 50, 100, 200),
        lambda e, n: float(np.hypot(*places(solved(e, n, MESHES[e][1]))[-1])),
        "cells along",
    )


PROBLEM = Problem(
    title="Roll-up of a strip to a circle",
    group="large displacement",
    source="a bar of constant curvature; h / L = 0.01",
    certainty="analytic",
    why="membrane and bending of a depth of a hundredth of the length, and the mesh",
    picture=lambda: Picture(solved("OPT", 100, 2, fields=True), "U1"),
    seconds=2.1,
)

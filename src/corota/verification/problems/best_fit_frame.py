"""Simple shear of one rectangle: the best-fit frame is not the polar rotation.

A rectangle of height 1 and length a = 1, 4 or 16 is sheared by u = 0.1 y. The frame that fits its
nodes in the least-squares sense rotates by -atan(0.1 / (a^2 + 1)): that is the polar rotation for
the square and less for long cells. The transverse strain, cos(phi) + 0.1 sin(|phi|) - 1, differs
between shapes to second order in the shear. Co-rotational elements with a linear local strain
neglect this term; finite-strain patches therefore depend on the shape of the cells.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import cell, prescribe, run

SHEAR = 0.1
ASPECTS = (1.0, 4.0, 16.0)


def sheared(element: str, aspect: float) -> ct.Results:
    """One rectangle, every node of it moved."""
    mesh = ct.mesh.rectangle(aspect, 1.0, 1, 1, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=0.0))
    u = np.stack([SHEAR * mesh.points[:, 1], np.zeros(mesh.n_nodes)], axis=1)
    prescribe(model, np.arange(mesh.n_nodes), u)
    return run(model, ct.Static(increments=1), fields=True)


def frame(results: ct.Results) -> tuple[float, float]:
    """Rotation of the frame, and the strain across in its axes."""
    fields = results.frames[-1].fields[0]
    angle = float(fields.frame_rotation[0])
    xx, yy, _, xy = fields.values["E"][0, 0]
    c, s = np.cos(angle), np.sin(angle)
    return angle, float(s * s * xx + c * c * yy - s * c * xy)


def exact(aspect: float) -> tuple[float, float]:
    """The same by the formulas."""
    angle = np.arctan(SHEAR / (aspect**2 + 1.0))
    return -float(angle), float(np.cos(angle) + SHEAR * np.sin(angle) - 1.0)


def measure() -> Iterator[Value]:
    """Three kinds of cells, whose nodes all have these second moments."""
    for element in ("Q4", "Q8", "Q9"):
        for aspect in ASPECTS:
            found, known = frame(sheared(element, aspect)), exact(aspect)
            text = f"aspect {aspect:g}, {element}"
            yield Value(f"rotation of the frame [rad], {text}", known[0], found[0], 1e-10)
            yield Value(f"strain across in its axes, {text}", known[1], found[1], 1e-9)


def curve() -> Curve:
    """Strain across against the aspect."""
    aspect = np.geomspace(1.0, 16.0, 40)
    return Curve(
        "length of the cell / height",
        "strain across in the frame's axes",
        {"formula": (aspect, [exact(a)[1] for a in aspect])},
        {"Q4": (ASPECTS, [frame(sheared("Q4", a))[1] for a in ASPECTS])},
    )


PROBLEM = Problem(
    title="The best-fit frame in simple shear",
    group="properties of the method",
    source="least squares over the nodes; values in agreement with an independent computation",
    certainty="analytic",
    why="rounding",
    picture=lambda: Picture(sheared("Q4", 4.0), "U1"),
    seconds=0.2,
)

"""First yield and limit in plane stress under simple loadings, by von Mises.

Simple shear yields at sy / sqrt 3, equal biaxial tension at sy; tension without lateral strain
reaches 2 sy / sqrt 3. A bar that hardens by K isotropically and H kinematically has the slope E (K
+ H) / (E + K + H), and yields in reverse loading at the other end of its elastic range. One element
Q4I under prescribed displacements.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Problem, Value
from corota.verification.models import last_frames, prescribe, run

YOUNG, NU, YIELD = 200000.0, 0.3, 250.0


def stresses(
    strains: Sequence[tuple[float | None, float | None, float]], **hardening: Any
) -> np.ndarray:
    """Stress (xx, yy, xy) after each of a list of strains xx, yy and shear angle.

    ``None`` leaves the square free across.
    """
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    law = ct.Mises(E=YOUNG, nu=NU, yield_stress=YIELD, **hardening)
    model.section("all", element="Q4I", material=law)
    points = model.mesh.points
    steps: list[Any] = []
    for xx, yy, angle in strains:
        part = ct.Model(model.mesh)
        if yy is None:
            part.fix("left", y=None)
            part.fix("bottom", x=None)
            part.fix("right", x=xx, y=None)
        else:
            h = np.array([[xx, angle], [0.0, yy]], float)
            prescribe(part, np.arange(4), points @ h.T)
        steps.append(ct.Static(nlgeom=False, increments=10, supports=part.supports))
    frames = last_frames(run(model, steps, fields=True))
    return np.array([f.fields[0].values["S"][0, 0, [0, 1, 3]] for f in frames])


def measure() -> Iterator[Value]:
    """Loadings of a perfectly plastic square; loops of one that hardens."""
    root = 3.0**0.5
    first = YIELD / root / (YOUNG / 2.0 / (1.0 + NU))
    found = stresses([(0.0, 0.0, 0.999 * first), (0.0, 0.0, 4.0 * first)])
    yield Value("shear stress just before yield", 0.999 * YIELD / root, found[0, 2], 1e-9)
    yield Value("shear stress beyond yield", YIELD / root, found[1, 2], 1e-9)
    first = YIELD * (1.0 - NU) / YOUNG
    found = stresses([(0.999 * first, 0.999 * first, 0.0), (4.0 * first, 4.0 * first, 0.0)])
    yield Value("equal tension just before yield", 0.999 * YIELD, found[0, 0], 1e-9)
    yield Value("equal tension beyond yield", YIELD, found[1, 0], 1e-9)
    found = stresses([(0.1, 0.0, 0.0)])
    yield Value("tension without strain across, limit", 2.0 * YIELD / root, found[0, 0], 1e-6)
    yield Value("stress across there", YIELD / root, found[0, 1], 1e-3)
    for name, iso, kin in (
        ("isotropic", 3000.0, 0.0),
        ("kinematic", 0.0, 3000.0),
        ("both", 1000.0, 2000.0),
    ):
        slope = YOUNG * 3000.0 / (YOUNG + 3000.0)
        top = YIELD + slope * (0.01 - YIELD / YOUNG)
        plastic = 0.01 - top / YOUNG
        # The elastic range is as wide as the yield stress has become, both ways.
        low = top - 2.0 * (YIELD + iso * plastic)
        turn = 0.01 - (top - low) / YOUNG
        at = stresses(
            [(0.01, None, 0.0), (turn, None, 0.0), (turn - 0.001, None, 0.0)],
            isotropic=iso,
            kinematic=kin,
        )
        yield Value(f"stress at a strain of 0.01, {name} hardening", top, at[0, 0], 1e-9)
        yield Value(f"stress at reverse yield, {name} hardening", low, at[1, 0], 1e-9)
        yield Value(
            f"slope beyond it, {name} hardening", slope, (at[1, 0] - at[2, 0]) / 0.001, 1e-7
        )


def curve() -> Curve:
    """Stress against strain of the three loadings without hardening."""
    size = np.linspace(0.0, 0.006, 49)[1:]
    cases = {
        "shear": (0.0, 0.0, 1.0),
        "tension, no strain across": (1.0, 0.0, 0.0),
        "equal tension": (1.0, 1.0, 0.0),
    }
    series = {}
    for name, (xx, yy, angle) in cases.items():
        found = stresses([(xx * s, yy * s, angle * s) for s in size])
        column = found[:, 2 if name == "shear" else 0] / YIELD
        series[name] = ([0.0, *size], [0.0, *column])
    limits = {
        f"limit, {n}": ([0.006], [v])
        for n, v in zip(cases, (1.0 / 3.0**0.5, 2.0 / 3.0**0.5, 1.0), strict=True)
    }
    return Curve("strain", "stress / yield stress", series, limits)


PROBLEM = Problem(
    title="Yield in plane stress",
    group="plasticity",
    source="R. von Mises (1913); R. Hill, The Mathematical Theory of Plasticity (1950)",
    certainty="analytic",
    why="rounding; the limit without strain across is approached exponentially",
    seconds=0.3,
)

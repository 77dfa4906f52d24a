"""Elastoplastic transient contact: a ring and a block fly against a rigid wall."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.studies.elements.case import Case, nearest, slanted, solved
from corota.verification.plastic_models import CELL, DRILLING

if TYPE_CHECKING:
    from benchmarks.studies.elements.case import Floats

ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D")
MATERIAL = ct.Mises(E=1.0e4, nu=0.3, rho=1.0, yield_stress=60.0, isotropic=200.0)
#: Distance from the wall at the start.
GAP = 0.001
INNER, OUTER = 0.9, 1.0
WIDTH, HEIGHT = 0.5, 2.0
RING_SPEED, BLOCK_SPEED = 1.0, 3.0


def against_wall(
    model: ct.Model, slave: str, speed: float, period: float, increments: int, variant: str
) -> ct.Dynamic:
    """Throw a model down on the wall y = -GAP; increments are shortened where contact asks."""
    model.velocity(y=-speed)
    model.contact(slave, ct.RigidCurve.line((-9.0, -GAP), (9.0, -GAP)), name="wall")
    longest = period / increments
    return ct.Dynamic(
        period=period,
        first_increment=longest,
        largest_increment=longest,
        scheme="energy_momentum" if variant == "energy-momentum" else "hht",
        mass=variant if variant in ("consistent", "lumped") else "constant",
        error_tolerance=1.0,
    )


def strain(variant: str) -> str:
    """Local strain of a variant."""
    return "linear" if variant == "linear" else "logarithmic"


def ring(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Dynamic]:
    """Half of a ring of radius 1 and thickness 0.1, `n` cells through it, twelve n along it."""
    along = 12 * n
    mesh = ct.mesh.rectangle(np.pi, OUTER - INNER, along, n, CELL[element], "alternate")
    if variant == "trapezoids":
        mesh = slanted(mesh, along)
    around, inward = mesh.points.T
    radius = OUTER - inward
    bent = np.stack([radius * np.sin(around), 1.0 - radius * np.cos(around)], axis=-1)
    mesh.points[:] = bent
    model = ct.Model(mesh)
    model.section("all", element=element, material=MATERIAL, local_strain=strain(variant))
    turn = 0.0 if element in DRILLING else None
    for side in ("left", "right"):
        model.fix(side, x=0.0, y=None, rotation=turn)
    return model, against_wall(model, "bottom", RING_SPEED, 1.2, 400, variant)


def block(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Dynamic]:
    """Half of a block 1 x 2, `n` cells across the half, its inner nodes shifted."""
    mesh = ct.mesh.rectangle(WIDTH, HEIGHT, n, 4 * n, CELL[element], "alternate")
    model = ct.Model(ct.mesh.distort(mesh, 0.2, seed=9) if n > 1 else mesh)
    model.section("all", element=element, material=MATERIAL, local_strain=strain(variant))
    model.fix("left", x=0.0, y=None, rotation=0.0 if element in DRILLING else None)
    return model, against_wall(model, "bottom", BLOCK_SPEED, 0.2, 200, variant)


def path(results: ct.Results) -> Floats:
    """Vertical displacement of the top on the axis, at twenty equal times."""
    node = nearest(results.mesh, 0.0, 2.0)
    time = np.array([f.time for f in results.frames])
    moved = np.array([f.U[node, 1] for f in results.frames])
    return np.interp(np.linspace(0.05, 1.0, 20) * time[-1], time, moved)


def energy_error(results: ct.Results, first: float) -> dict[str, float]:
    """Largest energy-balance error over the energy at the start."""
    worst = max(abs(f.scalars.get("energy balance", 0.0)) for f in results.frames)
    return {"balance error": worst / first}


def ring_error(results: ct.Results) -> dict[str, float]:
    return energy_error(results, 0.25 * np.pi * (OUTER**2 - INNER**2) * RING_SPEED**2)


def block_error(results: ct.Results) -> dict[str, float]:
    return energy_error(results, 0.5 * WIDTH * HEIGHT * BLOCK_SPEED**2)


def scheme(variant: str) -> str:
    """The variant that a reference is computed with: all but one share theirs."""
    return variant if variant == "energy-momentum" else "logarithmic"


@cache
def ring_on(n: int, variant: str) -> Floats:
    return path(solved(*ring("Q9", variant, n)))


@cache
def block_on(n: int, variant: str) -> Floats:
    return path(solved(*block("Q9", variant, n)))


CASES = (
    Case(
        "impact",
        "impact-slender",
        "Slender: a yielding ring hits a wall",
        "Half of a ring of radius 1 and thickness 0.1 (E = 1e4, yield stress 60, hardening 200, "
        "density 1) flies against a rigid wall with velocity 1; at least 400 increments of HHT; "
        "constant inertia, redistributed at the contact; cells 2.5 times as long as thick. In the "
        "third column the cells are trapezoids; in the fourth the scheme is energy-momentum. "
        "Value: path of the top (root mean square). Reference: Q9 with 12 cells through the "
        "thickness and 144 along the ring, the logarithmic strain, and the same scheme and "
        "increments.",
        ("linear", "logarithmic", "trapezoids", "energy-momentum"),
        (1, 2, 4, 8),
        ring,
        path,
        lambda v: ring_on(12, scheme(v)),
        ELEMENTS,
        "error of the path",
        per_variant=True,
        coarser=lambda v: ring_on(6, scheme(v)),
        extra=ring_error,
    ),
    Case(
        "impact",
        "impact-bulky",
        "Bulky: a yielding block hits a wall, distorted mesh",
        "Half of a block 1 x 2 of the same material flies against the wall with velocity 3; inner "
        "nodes are shifted at random by up to 0.2 of a side; at least 200 increments of HHT with "
        "the logarithmic strain and constant inertia, unless the column says otherwise. Value: "
        "path of the middle of the top. Reference: Q9 with 16 cells across the half and 64 in the "
        "height, the logarithmic strain, and the same scheme and increments.",
        ("linear", "logarithmic", "consistent", "lumped", "energy-momentum"),
        (1, 2, 4, 8),
        block,
        path,
        lambda v: block_on(16, scheme(v)),
        ELEMENTS,
        "error of the path",
        per_variant=True,
        coarser=lambda v: block_on(8, scheme(v)),
        extra=block_error,
    ),
)

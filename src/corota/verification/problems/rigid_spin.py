"""A body in rigid motion has the kinetic energy of its mass and polar moment of inertia.

A block 3 x 1 of unit density and thickness 0.4 moves at (0.3, -0.4) and spins at 1.7 about the
origin, on a distorted mesh: ``T = m v_c^2 / 2 + I_c w^2 / 2``, momentum ``m v_c``, angular momentum
``m (x_c x v_c) + I_c w``, to rounding for the consistent inertia of every element, including
drilling rotations.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.procedures.motion_start import initial_velocity
from corota.verification.catalogue import Picture, Problem, Value
from corota.verification.models import ELEMENTS, cell

SPIN, VELOCITY, DENSITY, THICKNESS = 1.7, np.array([0.3, -0.4]), 2.5, 0.4


def block(element: str) -> ct.Model:
    """The block, in motion."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(3.0, 1.0, 3, 2, cell(element)), 0.2, seed=5)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1e4, nu=0.3, rho=DENSITY)
    model.section("all", element=element, material=material, thickness=THICKNESS)
    model.velocity(x=VELOCITY[0], y=VELOCITY[1], spin=SPIN)
    return model


def momenta(element: str, mass: Any = "consistent") -> tuple[float, ...]:
    """Kinetic energy, momentum x and y, angular momentum, mass."""
    system = System(block(element), Multifrontal())
    v = initial_velocity(system)
    found = system.core.momenta(np.zeros(system.n_dofs), v, mass, False)
    return tuple(float(x) for x in found)


def exact() -> tuple[float, ...]:
    """The same of the rigid block."""
    mass, center = DENSITY * THICKNESS * 3.0, np.array([1.5, 0.5])
    polar = mass * (3.0**2 + 1.0) / 12.0
    v = VELOCITY + SPIN * np.array([-center[1], center[0]])
    angular = mass * (center[0] * v[1] - center[1] * v[0]) + polar * SPIN
    energy = 0.5 * mass * float(v @ v) + 0.5 * polar * SPIN**2
    return energy, float(mass * v[0]), float(mass * v[1]), float(angular), mass


def measure() -> Iterator[Value]:
    """Every element, with its consistent and its constant mass."""
    names = ("kinetic energy", "momentum x", "momentum y", "angular momentum", "mass")
    for element in ELEMENTS:
        for mass in ("consistent", "constant"):
            for name, known, found in zip(names, exact(), momenta(element, mass), strict=True):
                yield Value(f"{name}, {element}, {mass}", known, found, 1e-12)


PROBLEM = Problem(
    title="Rigid spin",
    group="dynamics",
    source="mechanics of the rigid body",
    certainty="analytic",
    why="rounding",
    picture=lambda: Picture(block("Q4D")),
    seconds=0.3,
)

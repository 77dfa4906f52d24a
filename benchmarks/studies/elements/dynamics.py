"""Motion with consistent, constant and lumped inertia: a slender and a bulky body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.studies import dynamics_table as table
from benchmarks.studies.elements.case import Case, nearest, solved
from corota.verification.plastic_models import CELL

if TYPE_CHECKING:
    from benchmarks.studies.elements.case import Floats

ELEMENTS = ("Q4I", "Q9", "OPT", "Q4D")
MASSES = ("consistent", "constant", "lumped")
#: Increments of every run, the reference's too: the errors are those of mesh and mass alone.
INCREMENTS = 120
LENGTH, HEIGHT = 2.0, 1.0


def step(period: float, mass: str) -> ct.Dynamic:
    """Trapezoidal rule."""
    return ct.Dynamic(
        period=period, increments=INCREMENTS, scheme="newmark", mass=mass, tolerance=1e-10
    )


def rod(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Dynamic]:
    """Free rod 10 x 0.5 that spins and is bent by a pulse, `n` cells along it and two across."""
    model = table.model("free rod", "Q8" if element == "Q9" else element, n)
    if element == "Q9":
        model.mesh = ct.mesh.rectangle(LONG, DEEP, n, 2, "quad9")
        model.sections[0].element = "Q9"
    return model, step(3.0, variant)


LONG, DEEP = table.CASES["free rod"][:2]


def rod_path(results: ct.Results) -> Floats:
    """Path of the middle of the loaded end, every sixth increment."""
    tip = nearest(results.mesh, LONG, DEEP / 2.0)
    return np.array([f.U[tip, :2] for f in results.frames[6::6]])


def rod_on(n: int, variant: str) -> Floats:
    """Q9, consistent whatever the variant."""
    return rod_path(solved(*rod("Q9", "consistent", n)))


def block(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Dynamic]:
    """Free block 2 x 1 that spins and is pulled by a pulse; distorted cells."""
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, 2 * n, n, CELL[element], "alternate")
    if n > 1:
        mesh = ct.mesh.distort(mesh, 0.2, seed=5)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0e3, nu=0.3, rho=1.0))
    model.velocity(spin=4.0, about=(LENGTH / 2.0, HEIGHT / 2.0))
    model.amplitudes["pulse"] = ct.Amplitude(
        np.linspace(0.0, 0.5, 51), np.sin(np.linspace(0.0, np.pi, 51)) ** 2
    )
    model.traction("right", x=20.0, y=20.0, amplitude="pulse")
    return model, step(1.5, variant)


def block_path(results: ct.Results) -> Floats:
    """Path of the upper corner of the loaded side, every sixth increment."""
    corner = nearest(results.mesh, LENGTH, HEIGHT)
    return np.array([f.U[corner, :2] for f in results.frames[6::6]])


def block_on(n: int, variant: str) -> Floats:
    """Q9, consistent whatever the variant."""
    return block_path(solved(*block("Q9", "consistent", n)))


CASES = (
    Case(
        "dynamics",
        "dynamics-slender",
        "Slender: free rod",
        "Free rod 10 x 0.5, E = 1e4, spinning at 2 rad per unit of time and bent by a pulse at "
        "one end; two cells across; 120 increments of the trapezoidal rule. Value: path of the "
        "end over a turn (root mean square). Reference: Q9 with 64 cells and the same increments, "
        "so that only mesh and mass matter.",
        MASSES,
        (4, 8, 16, 32),
        rod,
        rod_path,
        partial(rod_on, 64),
        ELEMENTS,
        "error of the path",
        coarser=partial(rod_on, 32),
    ),
    Case(
        "dynamics",
        "dynamics-bulky",
        "Bulky: tumbling block, distorted mesh",
        "Free block 2 x 1, E = 1e3, spinning at 4 rad per unit of time and pulled by a pulse on "
        "one side; inner nodes shifted at random by up to 0.2 of a side; 120 increments of the "
        "trapezoidal rule. Value: path of a corner. Reference: Q9 with 64 x 32 cells and the same "
        "increments.",
        MASSES,
        (1, 2, 4, 8, 16),
        block,
        block_path,
        partial(block_on, 32),
        ELEMENTS,
        "error of the path",
        coarser=partial(block_on, 16),
    ),
)

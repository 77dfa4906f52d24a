"""Contact in statics: a strip bent by a rigid disc, two blocks with a curved face."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.studies.elements.case import Case, solved
from corota.verification.plastic_models import CELL, DRILLING

if TYPE_CHECKING:
    from benchmarks.studies.elements.case import Floats

ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D")
VARIANTS = (
    "mortar",
    "node to segment",
    "mortar, friction 0.3",
    "node to segment, friction 0.3",
)


def pair(model: ct.Model, variant: str, slave: str, master: Any) -> None:
    """Put a contact pair of a variant into a model."""
    friction = 0.3 if "friction" in variant else 0.0
    method = "node_to_segment" if variant.startswith("node") else "mortar"
    model.contact(slave, master, method=method, friction=friction, name="pair")


def force(results: ct.Results) -> Floats:
    """Force on the slave side: vertical, mean over the way and at the end, horizontal at the end.

    Where one node of the strip carries the disc, the horizontal force of smooth contact jumps
    when the disc goes over to the next one: its mean says nothing of the element.
    """
    time = np.array([f.time for f in results.frames])
    x, y = (
        np.array([f.scalars.get(f"pair: force {axis}", 0.0) for f in results.frames])
        for axis in "xy"
    )
    return np.array([0.5 * np.diff(time) @ (y[1:] + y[:-1]), y[-1], x[-1]])


def strip(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Clamped strip 10 x 0.5, bent by a rigid disc that moves down by 1.4, `n` cells high."""
    mesh = ct.mesh.rectangle(10.0, 0.5, 8 * n, n, CELL[element], "alternate")
    disc = ct.mesh.add_node(mesh, 8.0, 1.5, "disc")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0e6, nu=0.3))
    model.fix("left", rotation=True if element in DRILLING else None)
    model.fix([disc], x=0.0, y=-1.4, rotation=0.0)
    pair(model, variant, "top", ct.RigidCurve.circle((8.0, 1.5), 1.0, reference=disc))
    return model, ct.Static(increments=20)


def blocks(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """P3: block 1 x 0.5 with a face of radius 8 pressed by 0.02 into a block 2 x 1.

    The lower block has half as many cells again along the face, its inner nodes shifted.
    """
    cell = CELL[element]

    def face(t: Any) -> Any:
        x = np.asarray(t) - 0.5
        return np.stack([x, 1.0 + 8.0 - np.sqrt(64.0 - x**2)], axis=-1)

    def line(a: tuple[float, float], b: tuple[float, float]) -> Any:
        first, last = np.array(a), np.array(b)
        return lambda t: first + (last - first) * np.asarray(t)[..., None]

    low = float(face(0.0)[1])
    upper = ct.mesh.mapped(
        [
            face,
            line((0.5, low), (0.5, 1.5)),
            line((-0.5, 1.5), (0.5, 1.5)),
            line((-0.5, low), (-0.5, 1.5)),
        ],
        n,
        max(1, n // 2),
        cell,
    )
    lower = ct.mesh.rectangle(2.0, 1.0, 3 * n // 2, max(1, 3 * n // 4), cell, origin=(-1.0, 0.0))
    mesh = ct.mesh.assembly(upper=upper, lower=ct.mesh.distort(lower, 0.2, seed=7))
    model = ct.Model(mesh)
    material = ct.Elastic(E=210000.0, nu=0.3)
    model.section("all", element=element, material=material, thickness=0.01)
    turn = 0.0 if element in DRILLING else None
    model.fix("lower.bottom", rotation=turn)
    model.fix("upper.top", x=0.0, y=-0.02, rotation=turn)
    pair(model, variant, "upper.bottom", "lower.top")
    return model, ct.Static(increments=10)


def on_mesh(build: Any, n: int, variant: str) -> Floats:
    """Q9 with mortar contact; with friction where the variant has it."""
    chosen = "mortar, friction 0.3" if "friction" in variant else "mortar"
    return force(solved(*build("Q9", chosen, n)))


CASES = (
    Case(
        "contact",
        "contact-slender",
        "Slender: strip bent by a rigid disc",
        "Clamped strip 10 x 0.5, E = 1e6, nu = 0.3. A rigid disc of radius 1 above x = 8 moves "
        "down by 1.4 in twenty increments and slides along it. Value: force on the disc "
        "(vertical, mean over the path and at its end; horizontal at its end). Reference: Q9 with "
        "256 x 32 cells and mortar contact.",
        VARIANTS,
        (1, 2, 4, 8),
        strip,
        force,
        partial(on_mesh, strip, 32),
        ELEMENTS,
        "error of the force",
        per_variant=True,
        coarser=partial(on_mesh, strip, 16),
    ),
    Case(
        "contact",
        "contact-bulky",
        "Bulky: two blocks, curved face, distorted mesh",
        "Problem P3: a block 1 x 0.5 with a face of radius 8 is pressed by 0.02 into a block 2 x "
        "1 in ten increments, E = 210000, nu = 0.3; the meshes do not match, and the inner nodes "
        "of the lower one are shifted at random by up to 0.2 of a side. Value: force between the "
        "blocks, as above. Reference: Q9 with 64 cells along the face and mortar contact.",
        VARIANTS,
        (4, 8, 16),
        blocks,
        force,
        partial(on_mesh, blocks, 64),
        ELEMENTS,
        "error of the force",
        per_variant=True,
        coarser=partial(on_mesh, blocks, 32),
    ),
)

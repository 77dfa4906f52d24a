"""Large rotations in statics: a slender strip and Cook's panel, regular and distorted meshes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import corota as ct
from benchmarks.studies.elements.case import Case, nearest, slanted, solved
from corota.verification.plastic_models import CELL, DRILLING

if TYPE_CHECKING:
    from benchmarks.studies.elements.case import Floats

LENGTH, HEIGHT = 10.0, 0.5
#: Cells along the strip for each through its height: aspect ratio five.
ALONG = 4


def strip(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Strip clamped left under a dead shear ``P L^2 / (E I) = 4``, `n` cells in its height."""
    nx = ALONG * n
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, nx, n, CELL[element], "alternate")
    if variant == "trapezoids":
        mesh = slanted(mesh, nx)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0e6, nu=0.3))
    model.fix("left", rotation=True if element in DRILLING else None)
    model.traction("right", y=4.0 * 1.0e6 * HEIGHT**3 / 12.0 / LENGTH**2 / HEIGHT)
    return model, ct.Static(increments=10)


def strip_tip(results: ct.Results) -> Floats:
    """Mean displacement of the two corners of the end."""
    corners = [nearest(results.mesh, LENGTH, y) for y in (0.0, HEIGHT)]
    return results.frames[-1].U[corners, :2].mean(axis=0)


def strip_on(n: int, variant: str) -> Floats:
    """Q9 with square cells, `n` in the height; the variants are meshes only."""
    model, step = strip("Q9", "", 2)
    model.mesh = ct.mesh.rectangle(LENGTH, HEIGHT, 20 * n, n, "quad9")
    return strip_tip(solved(model, step))


def panel(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Cook's panel under a dead shear of 0.2 on its right side, `n` cells a side."""
    corners = [(0.0, 0.0), (48.0, 44.0), (48.0, 60.0), (0.0, 44.0)]
    mesh = ct.mesh.mapped(corners, n, n, CELL[element], "alternate")
    if variant == "random":
        mesh = ct.mesh.distort(mesh, 0.2, seed=3)
    model = ct.Model(mesh)
    strain = "green_lagrange" if variant == "green_lagrange" else "linear"
    material = ct.Elastic(E=1.0, nu=1.0 / 3.0)
    model.section("all", element=element, material=material, local_strain=strain)
    model.fix("left", rotation=True if element in DRILLING else None)
    model.traction("right", y=0.2 / 16.0)
    return model, ct.Static(increments=4)


def panel_tip(results: ct.Results) -> Floats:
    """Displacement of the middle of the right side."""
    return results.frames[-1].U[nearest(results.mesh, 48.0, 52.0), :2]


def panel_on(n: int, variant: str) -> Floats:
    """Q9 with regular cells."""
    return panel_tip(solved(*panel("Q9", variant.replace("random", ""), n)))


CASES = (
    Case(
        "statics",
        "statics-slender",
        "Slender: strip 20 to 1",
        "Clamped strip 10 x 0.5 under a dead shear force at its end, `P L^2 / (E I) = 4`, which "
        "rotates the end by 64 degrees in ten increments. Cells are five times as long as high; "
        "in the second column they are trapezoids whose upright sides lean alternately by 0.3 of "
        "a cell. Value: mean displacement of the two corners of the end. Reference: Q9 with 160 x "
        "8 square cells.",
        ("rectangles", "trapezoids"),
        (1, 2, 4, 8, 16),
        strip,
        strip_tip,
        partial(strip_on, 8),
        quantity="error of the tip displacement",
        coarser=partial(strip_on, 4),
    ),
    Case(
        "statics",
        "statics-bulky",
        "Bulky: Cook's panel",
        "Panel (0, 0), (48, 44), (48, 60), (0, 44), E = 1, nu = 1/3, clamped at the left, with a "
        "dead shear force of 0.2 at the right (displacement 4.4 for a height of 16), in four "
        "increments. In the second column inner nodes are shifted at random by up to 0.2 of a "
        "side; in the third the local strain is `green_lagrange`. Value: displacement of the "
        "middle of the right side. Reference: Q9 with 64 x 64 cells.",
        ("regular", "random", "green_lagrange"),
        (2, 4, 8, 16, 32),
        panel,
        panel_tip,
        partial(panel_on, 64),
        quantity="error of the tip displacement",
        per_variant=True,
        coarser=partial(panel_on, 32),
    ),
)

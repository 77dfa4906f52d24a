"""Beyond yield with the three local strains: a slender beam and a bulky strip with a hole."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.studies.elements.case import Case, nearest, solved
from corota.verification.plastic_models import cantilever, cook, perforated_strip

if TYPE_CHECKING:
    from benchmarks.studies.elements.case import Floats

#: The paper's, and the two that stay stable and bend well beyond yield.
ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D", "Q4S", "Q4DI")
STRAINS = ("linear", "logarithmic")
#: The panel of a material whose hardening is above its stress.
HARDENS = "log., hardening 0.3"
HARDER = ct.Mises(E=70.0, nu=1.0 / 3.0, yield_stress=0.243, isotropic=0.3)


def beam(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Perfectly plastic cantilever 10 x 1, its end moved by 0.5; `n` cells in the height."""
    return cantilever(element, n, 0.5, variant, aspect=2.0), ct.Static(increments=10)


def force(results: ct.Results) -> Floats:
    """Vertical force on the nodes that are moved."""
    frame = results.frames[-1]
    moved = [s for s in results.model.supports if s.value != 0.0]
    nodes = np.concatenate(
        [results.mesh.nodes_of(s.nodes) if isinstance(s.nodes, str) else s.nodes for s in moved]
    )
    return np.array([frame.RF[nodes, 1].sum()])


@cache
def beam_with(n: int) -> Floats:
    return force(solved(*beam("Q9", "logarithmic", n)))


def beam_on(n: int, variant: str) -> Floats:
    """Q9 with the logarithmic strain, extrapolated from `n` cells and half as many.

    The strain is infinite at the corners of the clamp: halving the cells from 8 to 16 and 32
    changes the force by 0.83 and 0.48 %, so by first order.
    """
    return 2.0 * beam_with(n) - beam_with(n // 2)


def strip(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Perforated strip 10 x 18 drawn by 0.3; `n` cells along an eighth of the hole."""
    return perforated_strip(element, n, local_strain=variant), ct.Static(increments=10)


def strip_on(n: int, variant: str) -> Floats:
    """Q9 with the logarithmic strain whatever the variant."""
    return force(solved(*strip("Q9", "logarithmic", n)))


def panel(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Cook's panel beyond yield under a force of 1.8, its inner nodes shifted at random."""
    strain = variant if variant in STRAINS else "logarithmic"
    model = cook(element, n, 1.8, strain, HARDER if variant == HARDENS else None)
    model.mesh = ct.mesh.distort(model.mesh, 0.2, seed=3)
    return model, ct.Static(first_increment=0.1)


def panel_tip(results: ct.Results) -> Floats:
    """Displacement of the upper right corner."""
    return results.frames[-1].U[nearest(results.mesh, 48.0, 60.0), :2]


@cache
def panel_with(material: str, n: int) -> Floats:
    return panel_tip(solved(*panel("Q9", material, n)))


def panel_on(n: int, variant: str) -> Floats:
    """Q9 with the logarithmic strain whatever the variant, and its material."""
    return panel_with(variant if variant == HARDENS else "logarithmic", n)


CASES = (
    Case(
        "plasticity",
        "plasticity-slender",
        "Slender: perfectly plastic cantilever",
        "Cantilever 10 x 1 whose end is displaced by 0.5 (about three times the elastic limit) in "
        "ten increments; cells twice as long as high. Value: force at the end. Reference: Q9 with "
        "the logarithmic strain, extrapolated (first order) from 16 and 32 cells in the height.",
        STRAINS,
        (2, 4, 8, 16),
        beam,
        force,
        partial(beam_on, 32),
        ELEMENTS,
        "error of the force",
        coarser=partial(beam_on, 16),
    ),
    Case(
        "plasticity",
        "plasticity-bulky",
        "Bulky: strip with a hole",
        "Quarter strip 10 x 18 with a hole of radius 5, stretched by 0.3 with linear hardening "
        "(problem P2) in ten increments; mapped mesh, skewed towards the corner. Value: force. "
        "Reference: Q9 with 40 cells along an eighth of the hole and the logarithmic strain. The "
        "ligament strains by a few tenths; the difference between the local strains is a modeling "
        "error.",
        STRAINS,
        (3, 5, 10, 20),
        strip,
        force,
        partial(strip_on, 40),
        ELEMENTS,
        "error of the force",
        coarser=partial(strip_on, 20),
    ),
    Case(
        "plasticity",
        "plasticity-cook",
        "Bulky and bent: Cook's panel, distorted mesh",
        "Cook's panel, yield stress 0.243, hardening 0.135, under a dead shear force of 1.8; "
        "inner nodes shifted at random by up to 0.2 of a side; in the fourth column the hardening "
        "is 0.3, above the stress. Value: displacement of the upper corner. Reference: Q9 with 48 "
        "x 48 cells and the logarithmic strain.",
        (*STRAINS, HARDENS),
        (4, 8, 16, 24),
        panel,
        panel_tip,
        partial(panel_on, 48),
        ELEMENTS,
        "error of the tip displacement",
        coarser=partial(panel_on, 24),
        per_variant=True,
    ),
)

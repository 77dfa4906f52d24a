"""Beyond yield with the three local strains: a slender beam and a bulky strip with a hole."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.studies.case import Case, nearest, solved
from corota.verification.plastic_models import cantilever, cook, perforated_strip

if TYPE_CHECKING:
    from benchmarks.studies.case import Floats

ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D")
STRAINS = ("simplified", "modified", "logarithmic")


def beam(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Perfectly plastic cantilever 10 x 1, its end moved by 0.5; `n` cells in the height."""
    return cantilever(element, n, 0.5, variant, aspect=2.0), ct.Static(increments=10)


def force(results: ct.Results) -> Floats:
    """Vertical force on the nodes that are moved."""
    frame = results.frames[-1]
    moved = [s for s in results.model.supports if s.value != 0.0]
    nodes = np.concatenate([results.mesh.nodes_of(s.nodes) if isinstance(s.nodes, str) else s.nodes
                            for s in moved])  # fmt: skip
    return np.array([frame.RF[nodes, 1].sum()])


def beam_reference(variant: str) -> Floats:
    """Q8 with the logarithmic strain on a mesh half as fine again as the finest."""
    return force(solved(*beam("Q8", "logarithmic", 24)))


def strip(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Perforated strip 10 x 18 drawn by 0.3; `n` cells along an eighth of the hole."""
    return perforated_strip(element, n, local_strain=variant), ct.Static(increments=10)


def strip_reference(variant: str) -> Floats:
    """Q8 with the logarithmic strain on a mesh half as fine again as the finest."""
    return force(solved(*strip("Q8", "logarithmic", 30)))


def panel(element: str, variant: str, n: int) -> tuple[ct.Model, ct.Static]:
    """Cook's panel beyond yield under a force of 1.8, its inner nodes shifted at random."""
    model = cook(element, n, 1.8, variant)
    model.mesh = ct.mesh.distort(model.mesh, 0.2, seed=3)
    return model, ct.Static(first_increment=0.1)


def panel_tip(results: ct.Results) -> Floats:
    """Displacement of the upper right corner."""
    return results.frames[-1].U[nearest(results.mesh, 48.0, 60.0), :2]


def panel_reference(variant: str) -> Floats:
    """Q8 with the logarithmic strain on a mesh half as fine again as the finest."""
    return panel_tip(solved(*panel("Q8", "logarithmic", 36)))


CASES = (
    Case(
        "plasticity", "plasticity-slender", "Slender: perfectly plastic cantilever",
        "Cantilever 10 x 1, its end moved by 0.5 (about three times the elastic limit); cells "
        "twice as long as high; ten increments. Force at the end against Q8 with 24 cells in the "
        "height and the logarithmic strain.",
        STRAINS, (2, 4, 8, 16), beam, force, beam_reference, ELEMENTS, "error of the force",
    ),
    Case(
        "plasticity", "plasticity-bulky", "Bulky: strip with a hole",
        "The quarter strip 10 x 18 with a hole of radius 5, drawn by 0.3 with linear hardening "
        "(problem P2); cells of a mapped mesh, skewed towards the corner; ten increments. Force "
        "against Q8 with 30 cells along an eighth of the hole and the logarithmic strain. The "
        "ligament strains by a few tenths: what the local strains differ by is the model's error.",
        STRAINS, (3, 5, 10, 20), strip, force, strip_reference, ELEMENTS, "error of the force",
    ),
    Case(
        "plasticity", "plasticity-cook", "Bulky and bent: Cook's panel, distorted mesh",
        "Cook's panel with linear hardening under a dead shear force of 1.8, inner nodes shifted "
        "at random by up to 0.2 of a side. Displacement of the upper corner against Q8 with "
        "36 x 36 cells and the logarithmic strain.",
        STRAINS, (4, 8, 16, 24), panel, panel_tip, panel_reference, ELEMENTS,
        "error of the tip displacement",
    ),
)  # fmt: skip

"""Flow that localizes because of an element or a strain: found in the results, and said."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.model import elements
from corota.model.plasticity import Mises

if TYPE_CHECKING:
    from corota.model.blocks import BlockOfCells
    from corota.results.results import PointFields

#: Difference of the plastic strain within an element from which it counts.
SPREAD = 0.1
#: Share of the largest one that the least one may have.
SHARE = 0.3


def localized(block: BlockOfCells, own: PointFields) -> tuple[int, str] | None:
    """Global index of the worst cell that has localized, and what to say of it.

    A quadrilateral with incompatible modes is stable in a uniform state only while the nominal
    stress rises with the stretch, although a constrained continuum is stable for longer (de
    Souza Neto, Peric, Huang & Owen, Commun. Numer. Methods Eng. 11, 1995). Under the logarithmic
    strain that ends in tension where the material hardens by less than its stress.
    """
    section = block.section
    law = section.material
    flow = own.values.get("PEEQ")
    if (
        not elements.find(section.element).loose_modes
        or section.local_strain == "linear"
        or flow is None
        or not isinstance(law, Mises)
    ):
        return None
    most, least = flow.max(axis=1), flow.min(axis=1)
    cell = int(np.argmax(np.where(least < SHARE * most, most - least, 0.0)))
    spread = float(most[cell] - least[cell])
    if spread < SPREAD or least[cell] >= SHARE * most[cell]:
        return None
    reached = float(most[cell])
    stress = law.uniaxial(np.append(np.linspace(0.0, reached, 20), reached + 1e-4))
    slope = float(stress[-1] - stress[-2]) / 1e-4
    if slope > stress[-1]:
        return None
    return int(block.cells[cell]), (
        f"the plastic strain differs by {spread:.2g} within a {section.element} element, and its "
        f"material hardens by less ({slope:.3g}) than its stress ({stress[-1]:.3g}): "
        "incompatible modes then localize the plastic flow in half an element, and a finer mesh "
        "makes it worse; use Q4S, whose modes are stable, or Q8R"
    )

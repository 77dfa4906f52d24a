"""Fields and energies of the elements at a state."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.results.derived import add_derived
from corota.results.results import PointFields

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.user_material import UserBlocks
    from corota.arrays import Floats
    from corota.model.sections import Section


#: Sums over the model, in their order.
SUMS = (
    "strain energy", "artificial energy", "plastic work", "creep work", "damage", "thermal work",
)  # fmt: skip


def recover(
    system: NumberedModel, user: UserBlocks, u: Floats
) -> tuple[list[PointFields], dict[str, float]]:
    """Fields at the quadrature points of the own elements, and sums over all.

    Raises
    ------
    ElementFailure
        If a value is not a number.
    """
    communicator = system.communicator
    failure: Exception | None = None
    try:
        fields, sums, largest = _own(system, user, u)
    except Exception as error:
        if communicator.size == 1:
            raise
        failure = error
    if communicator.size > 1:
        if (failure := communicator.agree(failure)) is not None:
            raise failure
        sums = communicator.sum(sums)
        largest = communicator.broadcast(max(communicator.gather(largest), default=0.0))
    system.largest_linear_strain = largest
    return fields, dict(zip(SUMS, sums.tolist(), strict=True))


def _own(
    system: NumberedModel, user: UserBlocks, u: Floats
) -> tuple[list[PointFields], Floats, float]:
    """Fields, sums and largest linear local strain of the own elements."""
    fields, energy, largest = [], 0.0, 0.0
    artificial = plastic = creep = damage = 0.0
    # Those of the committed state, after which no time has passed.
    system.core.set_clock(0.0, 0.0, False)
    raw = system.core.recover(system.in_space(u), system.nlgeom)
    for index, (block, own) in enumerate(zip(system.own_blocks, raw, strict=True)):
        for name, values in own["values"].items():
            if not np.isfinite(values).all():
                bad = int(np.argwhere(~np.isfinite(values))[0][0])
                label = system.model.mesh.cell_labels[block.cells[bad]]
                raise ElementFailure(
                    f"{name} of element {label} is not a number at the equilibrium found: the "
                    "strain exceeds what the material and the plane state allow (for example "
                    "the thickness vanishes); check loads, moduli and units"
                )
        if block.section.axisymmetric:
            own["values"].pop("STH", None)  # a ring has no thickness
        if "M1" in own["values"]:
            own["values"] |= surface_stress(block.section, own["values"], own.get("fibers"))
        if system.nlgeom and "M1" in own["values"]:
            # Moments of the ends balance the shear force over the current length of a beam.
            values = own["values"]
            values["V"] = values["V"] / (1.0 + values["E"][..., :2].sum(axis=-1))
        energy += own["total_energy"]
        artificial += own["artificial_energy"]
        if (work := own["values"].get("PWORK")) is not None:
            plastic += float(np.einsum("ep,ep->", work, own["volume"]))
        if (work := own["values"].get("CWORK")) is not None:
            creep += float(np.einsum("ep,ep->", work, own["volume"]))
        if (lost := own["values"].get("DMENER")) is not None:
            damage += float(np.einsum("ep,ep->", lost, own["volume"]))
        if "heat" in own:
            system.free.record(index, own["heat"], own["volume"], own.get("stabilized"))
        plastic += own["dissipated_energy"]
        stored, lost = user.energies(index, own["values"]["ENER"], own["volume"])
        energy, plastic = energy + stored, plastic + lost
        if system.nlgeom and block.section.local_strain == "linear":
            largest = max(largest, float(own["largest_strain"]))
        found = PointFields(
            block.section.element,
            block.cells,
            own["points"],
            own["shape"],
            own["rotation"],
            own["volume"],
            own["values"],
            own["forces"],
            own.get("fibers"),
        )
        add_derived(found)
        fields.append(found)
    return fields, np.array([energy, artificial, plastic, creep, damage, system.free.work]), largest


def surface_stress(
    section: Section, values: dict[str, Floats], fibers: Floats | None
) -> dict[str, Floats]:
    """Axial stress of beams at their surfaces, each of shape (n, 1).

    ``SR1`` and ``SL1`` are those on the right and the left of the way from the first end to the
    second, at the first end; ``SR2`` and ``SL2`` at the second. Empty where the distance of the
    surfaces is not known.
    """
    names = ("SR1", "SL1", "SR2", "SL2")
    if fibers is not None:
        stress = fibers[:, [0, 0, -1, -1], [0, -1, 0, -1], 0]
        return {name: stress[:, i : i + 1] for i, name in enumerate(names)}
    if not section.fiber > 0.0:
        return {}
    area, inertia, _ = section.profile
    found = {}
    for name in names:
        bending = values[f"M{name[-1]}"] * section.fiber / inertia
        found[name] = values["N"] / area + (bending if name[1] == "R" else -bending)
    return found

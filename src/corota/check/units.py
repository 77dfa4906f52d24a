"""Numbers that hint at mixed units."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import Diagnostic
from corota.model.materials import Elastic

if TYPE_CHECKING:
    from corota.model.model import Model

#: Young's modulus that can only be in pascal, and a size that is hardly in metres.
PASCAL, LARGE = 1e9, 50.0
#: Wave speeds of solids, from rubber in m/s to diamond in mm/s.
SLOW, FAST = 10.0, 5e7


def check_units(model: Model) -> list[Diagnostic]:
    """Warnings, one a material."""
    points = model.mesh.points
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    found: dict[str, Diagnostic] = {}
    for section in model.sections:
        material = section.material
        if not isinstance(material, Elastic):
            continue
        name = material.name or "a material"
        if material.E >= PASCAL and size >= LARGE:
            found[name] = Diagnostic(
                "warning",
                f"{name}: E = {material.E:g} in a part of size {size:g} looks like pascal mixed "
                "with millimetres",
                material.where,
                hint="use N, mm and MPa, or N, m and Pa",
            )
        elif material.rho > 0.0:
            speed = math.sqrt(material.E / material.rho)
            if not SLOW <= speed <= FAST:
                found[name] = Diagnostic(
                    "warning",
                    f"{name}: E = {material.E:g} and density {material.rho:g} give a wave speed "
                    f"of {speed:.3g}, which no solid has",
                    material.where,
                    hint="beside N, mm and MPa the density is in t/mm^3 (steel: 7.85e-9)",
                )
    return list(found.values())

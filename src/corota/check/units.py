"""Numbers that hint at mixed units."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import Diagnostic
from corota.model.material_table import MaterialTable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.model.materials import Material
    from corota.model.model import Model
    from corota.model.units import Units

#: Young's modulus that can only be in pascal, and a size that is hardly in meters.
PASCAL, LARGE = 1e9, 50.0
#: Wave speeds of solids, from rubber in m/s to diamond in mm/s.
SLOW, FAST = 10.0, 5e7
#: The same in m/s, where units are given: foam to diamond.
SLOW_SI, FAST_SI = 1.0, 2e4
#: Young's moduli of solids, from gels to diamond [Pa].
SOFT, STIFF = 1e2, 2e12
#: Yield stress over Young's modulus that no solid reaches: metals .01, glassy polymers .05.
STRONG = 0.2
#: Densities of solids, from aerogel to osmium [kg/m^3].
LIGHT, HEAVY = 1.0, 3e4


def check_units(model: Model) -> list[Diagnostic]:
    """Warnings, one per material; with the units of the model if given."""
    points = model.mesh.points
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    found: dict[str, Diagnostic] = {}
    for section in model.sections:
        material = section.material
        if isinstance(material, MaterialTable):
            material = material.first
        modulus = young(material)
        name = section.material.name or "a material"
        if modulus <= 0.0 or name in found:
            continue
        for text, hint in _doubts(model.unit_system, material, modulus, size):
            found[name] = Diagnostic("warning", f"{name}: {text}", material.where, hint=hint)
            break
    return list(found.values())


def young(material: Material) -> float:
    """The largest Young's modulus of a material; 0 if it has none by that name."""
    values = (getattr(material, name, 0.0) for name in ("E", "E1", "E2", "E3"))
    return max((float(v) for v in values if isinstance(v, int | float)), default=0.0)


def yield_stress(material: Material) -> float:
    """The first yield stress of a material; 0 if it does not yield."""
    curve = getattr(material, "yield_curve", None)
    if curve:
        return float(curve[0][0])
    return float(getattr(material, "yield_stress", None) or 0.0)


def _doubts(
    units: Units, material: Material, modulus: float, size: float
) -> Iterator[tuple[str, str]]:
    strength, density = yield_stress(material), material.rho
    if strength > STRONG * modulus:
        yield (
            f"the yield stress {strength:g} is {strength / modulus:.3g} of E = {modulus:g}, "
            "which no solid reaches",
            "give both in the same unit of stress",
        )
    if units.force and units.length:
        yield from _told(units, modulus, density)
        return
    if modulus >= PASCAL and size >= LARGE:
        yield (
            f"E = {modulus:g} in a part of size {size:g} looks like pascals mixed with millimeters",
            "use N, mm and MPa, or N, m and Pa",
        )
    elif density > 0.0:
        speed = math.sqrt(modulus / density)
        if not SLOW <= speed <= FAST:
            yield (
                f"E = {modulus:g} and density {density:g} give a wave speed of {speed:.3g}, "
                "which no solid has",
                "with N, mm and MPa the density is in t/mm^3 (steel: 7.85e-9)",
            )


def _told(units: Units, modulus: float, density: float) -> Iterator[tuple[str, str]]:
    """Warnings about numbers with given units."""
    length, force = units.size("length"), units.size("force")
    stress = units.label("force/length^2")
    pascal = modulus * force / length**2
    if not SOFT <= pascal <= STIFF:
        yield (
            f"E = {modulus:g} {stress} is {pascal:.3g} Pa, which no solid has",
            f"the units of the model are {units}: give E in {stress} (steel: "
            f"{210e9 * length**2 / force:.3g})",
        )
    if density <= 0.0:
        return
    time = units.size("time") or 1.0
    mass = force * time**2 / length
    solid = density * mass / length**3
    if not LIGHT <= solid <= HEAVY:
        steel = 7850.0 * length**3 / mass
        yield (
            f"density {density:g} is {solid:.3g} kg/m^3 in {units}, which no solid has",
            f"masses are force*time^2/length: the density of steel is {steel:.3g}",
        )
    speed = math.sqrt(pascal / solid)
    if not SLOW_SI <= speed <= FAST_SI:
        yield (
            f"E = {modulus:g} and density {density:g} give a wave speed of {speed:.3g} m/s, "
            "which no solid has",
            f"the units of the model are {units}",
        )

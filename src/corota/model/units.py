"""The units of a model: labels only, numbers are never converted.

Corota computes with plain numbers; consistent units are the user's responsibility. The names given
here label axes, tables and files, and are used by :mod:`corota.check.units`.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from dataclasses import dataclass

from corota.errors import InputError, Location
from corota.names import did_you_mean

#: Kind of unit to its names, each with its size in meters, newtons, kilograms, seconds, kelvins.
KNOWN: dict[str, dict[str, float]] = {
    "length": {
        "m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "km": 1e3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9,
        "in": 0.0254, "ft": 0.3048,
    },
    "force": {
        "N": 1.0, "mN": 1e-3, "uN": 1e-6, "µN": 1e-6, "kN": 1e3, "MN": 1e6, "daN": 10.0,
        "kgf": 9.80665, "lbf": 4.4482216152605, "kip": 4448.2216152605,
    },
    "mass": {
        "kg": 1.0, "g": 1e-3, "mg": 1e-6, "t": 1e3, "kt": 1e6, "lb": 0.45359237,
        "slug": 14.593902937206, "slinch": 175.126835246476,
    },
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "min": 60.0, "h": 3600.0},
    "temperature": {"K": 1.0, "°C": 1.0, "C": 1.0, "°F": 5.0 / 9.0, "F": 5.0 / 9.0},
}  # fmt: skip
#: Names of derived units.
NAMED = {
    ("force/length^2", "N", "mm"): "MPa",
    ("force/length^2", "N", "m"): "Pa",
    ("force/length^2", "kN", "m"): "kPa",
    ("force/length^2", "kN", "mm"): "GPa",
    ("force/length^2", "MN", "m"): "MPa",
    ("force/length^2", "mN", "um"): "GPa",
    ("force/length^2", "uN", "um"): "MPa",
    ("force/length^2", "mN", "µm"): "GPa",
    ("force/length^2", "µN", "µm"): "MPa",
    ("force/length^2", "lbf", "in"): "psi",
    ("force/length^2", "kip", "in"): "ksi",
    ("energy", "N", "m"): "J",
    ("energy", "N", "mm"): "mJ",
    ("energy", "kN", "m"): "kJ",
    ("energy", "kN", "mm"): "J",
}
#: Units of moments and volumes are written out; energies have their own name.
_ENERGY = {"energy": "force*length", "energy/length^3": "force*length/length^3"}
_FACTOR = r"([*/]?)([a-z]+)(?:\^(\d))?"
_RAISED = {"2": "²", "3": "³", "4": "⁴"}
#: Relative tolerance of masses against force times time squared over length.
SAME = 1e-3


@dataclass(frozen=True)
class Units:
    """Names of the units; empty if not given.

    Parameters
    ----------
    length, force, mass, time, temperature : str
        Keys of :data:`KNOWN`.

    Examples
    --------
    >>> units = Units.of("mm", "N", "t", "s", "°C")
    >>> units.label("force/length^2"), units.label("force*length"), units.label("length/time^2")
    ('MPa', 'N·mm', 'mm/s²')
    >>> print(units)
    mm, N, t, s, °C
    """

    length: str = ""
    force: str = ""
    mass: str = ""
    time: str = ""
    temperature: str = ""

    @staticmethod
    def of(*names: str, where: Location | None = None) -> Units:
        """Units by their names, in any order.

        Raises
        ------
        InputError
            If a name is unknown, one kind is named twice, or force, mass, length and time do not
            fit each other.
        """
        found: dict[str, str] = {}
        for name in (n.strip() for n in names):
            kind = next((kind for kind, units in KNOWN.items() if name in units), "")
            if not kind:
                every = [n for units in KNOWN.values() for n in units]
                raise InputError(
                    f"unknown unit {name!r}{did_you_mean(name, every)}; known: {', '.join(every)}",
                    where,
                )
            if found.get(kind, name) != name:
                raise InputError(f"two units of {kind}: {found[kind]} and {name}", where)
            found[kind] = name
        made = Units(**found)
        made._fit(where)
        return made

    def _fit(self, where: Location | None) -> None:
        """Refuse a mass that is not force times time squared over length."""
        if not (self.length and self.force and self.mass):
            return
        times = [self.time] if self.time else list(KNOWN["time"])
        masses = {
            t: self.size("force") * KNOWN["time"][t] ** 2 / self.size("length") for t in times
        }
        if any(abs(self.size("mass") / mass - 1.0) <= SAME for mass in masses.values()):
            return
        time, wanted = next((t, m) for t, m in masses.items() if t == (self.time or "s"))
        fitting = [n for n, size in KNOWN["mass"].items() if abs(size / wanted - 1.0) <= SAME]
        proper = f"the mass in {fitting[0]}" if fitting else f"masses of {wanted:g} kg"
        raise InputError(
            f"inconsistent units: {self.force} is not {self.mass}*{self.length}/{time}^2; beside "
            f"{self.length}, {self.force} and {time} take {proper}",
            where,
        )

    def size(self, kind: str) -> float:
        """Size of a unit in SI; 0 if it is not given."""
        return KNOWN[kind].get(getattr(self, kind), 0.0)

    def label(self, dimension: str) -> str:
        """The unit of a dimension such as ``force/length^2``; empty if a part is not given.

        Parameters
        ----------
        dimension : str
            Factors ``length``, ``force``, ``mass``, ``time``, ``temperature`` or ``energy``
            joined by ``*`` and ``/``, with whole powers; or ``rad``, or empty.
        """
        if dimension in ("", "rad"):
            return dimension
        if not self:
            return ""
        named = NAMED.get((dimension, self.force, self.length))
        if named:
            return named
        head, _, rest = dimension.partition("/")
        if head == "energy":
            joule = self.label("energy") if rest else ""
            if joule and "·" not in joule:
                below = self.label(rest)
                return f"{joule}/{below}" if below else ""
            dimension = _ENERGY.get(dimension, dimension)
        text = ""
        for sign, name, power in re.findall(_FACTOR, dimension):
            unit = str(getattr(self, name, ""))
            if not unit and name != "rad":
                return ""
            text += {"": "", "*": "·", "/": "/"}[sign] + (unit or name) + _RAISED.get(power, "")
        return f"1{text}" if text.startswith("/") else text

    def __str__(self) -> str:
        every = (self.length, self.force, self.mass, self.time, self.temperature)
        return ", ".join(name for name in every if name)

    def __bool__(self) -> bool:
        return bool(str(self))

"""Values of output variables in frames: components, invariants, and their names."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.results.derived import DERIVED
from corota.results.scalars import SCALARS, general
from corota.results.table import (
    COMPONENTS,
    DIMENSIONS,
    INVARIANTS,
    MEANING,
    NODAL,
    TABLE,
    TENSORS,
    variables,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from corota.arrays import Floats
    from corota.model.units import Units
    from corota.results.frame import Frame, PointFields
    from corota.results.table import Variable


#: Forces of the nodes on the elements, in files.
FORCES = "nodal forces"

#: Tensors by their names in files; other values have their own.
STORED = {name: row.array for name, row in TABLE.items() if row.tensor and row.array}

#: Other spellings that :func:`canonical` accepts (compared in lower case).
ALIASES = {
    "displacement": "U",
    "rotation": "UR3",
    "ur": "UR3",
    "reaction": "RF",
    "rf3": "RM3",
    "temperature": "NT",
    "nt11": "NT",
    "von mises": "MISES",
    "principal": "SP1",
    "sxx": "S11",
    "syy": "S22",
    "szz": "S33",
    "sxy": "S12",
    "exx": "E11",
    "eyy": "E22",
    "ezz": "E33",
    "exy": "E12",
}


def meaning(name: str) -> str:
    """Description of a variable, with its dimension; empty if unknown."""
    return MEANING.get(name) or (DERIVED[name].meaning if name in DERIVED else "")


#: Dimension of quantities of the whole model.
_OF_THE_WHOLE = {
    "plastic work": "energy", "section N": "force", "section V": "force",
    "section M": "force*length", "length": "length",
}  # fmt: skip


def dimension(name: str) -> str:
    """Dimension of a variable, a history or a scalar of frames, as ``force/length^2``.

    Empty for numbers without one, and if unknown.

    Examples
    --------
    >>> dimension("S11"), dimension("RF1 at left"), dimension("ALLKE"), dimension("load factor")
    ('force/length^2', 'force', 'energy', '')
    """
    if name in _OF_THE_WHOLE:
        return _OF_THE_WHOLE[name]
    if (scalar := general(name)) in SCALARS:
        return SCALARS[scalar][1]
    if name.endswith((" energy", " dissipation")) or (name.startswith("ALL") and name.isupper()):
        return "energy"
    variable = re.sub("^(largest|smallest) ", "", name).split(" ")[0].rstrip(":")
    if variable in DERIVED:
        return variables()[variable].dimension
    if variable in TABLE:
        return TABLE[variable].dimension
    return DIMENSIONS.get(variable, DIMENSIONS.get(f"{variable}1", ""))


#: Dimensions of arrays of files.
_OF_ARRAYS = {
    **{row.stored: row.dimension for row in TABLE.values()},
    **{item.array: DIMENSIONS[name] for name, (_, item) in INVARIANTS.items()},
    "frame rotation": "rad",
    "position": "length",
}


def dimension_of_array(name: str) -> str:
    """Dimension of an array of a result file, in the form of :func:`dimension`."""
    stem = name.removeprefix("cell ").partition(": ")[0]
    return _OF_ARRAYS[stem] if stem in _OF_ARRAYS else dimension(stem)


def stored_as(name: str) -> tuple[str, int]:
    """Array of a file that holds a component, invariant or scalar, and its column; -1 for all."""
    if name in COMPONENTS:
        tensor, column = COMPONENTS[name]
        return STORED.get(tensor, tensor), column
    if name in INVARIANTS:
        item = INVARIANTS[name][1]
        return item.array, item.column
    return name, -1


def averaged_names(arrays: Iterable[str]) -> list[str]:
    """Components, invariants and scalars that arrays of a file hold, by the names of these."""
    there = set(arrays)
    found = [n for n in (*COMPONENTS, *INVARIANTS) if stored_as(n)[0] in there]
    skip = {*TENSORS, *STORED.values(), *(item.array for _, item in INVARIANTS.values())}
    return found + sorted(there - skip)


def averaged_value(averages: Mapping[str, Floats], name: str) -> Floats:
    """A component, invariant or scalar from arrays of a file, shape (n,)."""
    array, column = (name, -1) if name in averages else stored_as(name)
    if array not in averages and name in INVARIANTS:
        tensor = STORED[INVARIANTS[name][0]]
        return invariant(name, averages[tensor][:, :4])
    values = averages[array]
    return np.asarray(values if column < 0 else values[:, column], dtype=np.float64)


def labeled(name: str, units: Units, of: str = "") -> str:
    """A name with its unit in brackets, where both are known: ``time [s]``.

    Parameters
    ----------
    of : str
        The dimension, for names that :func:`dimension` does not know.
    """
    if not units:
        return name
    unit = units.label(of or dimension(name))
    return f"{name} [{unit}]" if unit and unit != "rad" else name


def described(name: str, units: Units) -> str:
    """Description of a variable, with its unit, or with its dimension where no unit is given."""
    text = meaning(name)
    unit = units.label(dimension(name))
    if not unit or not text:
        return text
    return f"{text.partition(' [')[0]} [{unit}]"


def invariant(name: str, tensor: Floats) -> Floats:
    """Values of an invariant of :data:`INVARIANTS` from its tensor, (..., 4) to (...)."""
    kind, item = INVARIANTS[name]
    values = item.function(of_the_tensor(TABLE[kind], tensor))
    return np.asarray(values if item.column < 0 else values[..., item.column])


def of_the_tensor(row: Variable, values: Floats) -> Floats:
    """Components of a tensor from the stored ones: the shear strain is stored as the angle."""
    return values if row.shear == 1.0 else values * [1.0, 1.0, 1.0, row.shear]


def available(fields: Iterable[PointFields]) -> list[str]:
    """Names of variables of point fields: components, invariants and scalars."""
    have = {name for block in fields for name in block.values}
    found = [name for name, (tensor, _) in COMPONENTS.items() if tensor in have]
    found += [name for name, (tensor, _) in INVARIANTS.items() if tensor in have]
    return found + sorted(have - set(TENSORS) - set(INVARIANTS))


def canonical(name: str, frame: Frame) -> str:
    """Canonical name of a variable.

    Raises
    ------
    InputError
        If there is no such variable; names the nearest and lists all.
    """
    return match_name(name, names_of(frame))


def names_of(frame: Frame) -> list[str]:
    """All variables of a frame, from its points or from averages."""
    if frame.fields or not frame.averages:
        return [*nodal_names(frame), *available(frame.fields)]
    of_cells = [n.removeprefix("cell ") for n in frame.cell_averages]
    found = [*nodal_names(frame), *averaged_names(frame.averages)]
    rest = [n for n in averaged_names(of_cells) if n not in found and n != "frame rotation"]
    return [*found, *rest]


def match_name(name: str, valid: list[str]) -> str:
    """Find a name in a list, regardless of case or alias; raise with the list if there is none."""
    wanted = ALIASES.get(name.lower(), name)
    for candidate in valid:
        if candidate.lower() == wanted.lower():
            return candidate
    from difflib import get_close_matches

    near = get_close_matches(wanted.upper(), valid, n=1)
    hint = f"; did you mean {near[0]}?" if near else "."
    if known := meaning(wanted.upper()):
        hint = f": this analysis has no {known}."
    raise InputError(f"no result variable named {name!r}{hint} There are: {', '.join(valid)}")


def nodal_names(frame: Frame) -> list[str]:
    """Names of :data:`NODAL` that a frame has."""
    return [
        name
        for name, (where, _) in NODAL.items()
        if getattr(frame, where) is not None and where not in frame.absent
    ]


def nodal_value(frame: Frame, name: str) -> Floats:
    """A variable of :data:`NODAL` at all nodes, shape (n_nodes,)."""
    attribute, column = NODAL[name]
    array = getattr(frame, attribute)
    if array is None:  # a static step in an analysis with dynamic steps
        return np.zeros(len(frame.U))
    if array.ndim == 1:
        return np.asarray(array)
    if column < 0:
        return np.asarray(np.hypot(array[:, 0], array[:, 1]))
    return np.asarray(array[:, column])


def point_value(block: PointFields, name: str) -> Floats:
    """A variable at the points of a block, shape (n, p)."""
    if name in COMPONENTS:
        tensor, column = COMPONENTS[name]
        return block.values[tensor][..., column]
    if name in INVARIANTS:
        return invariant(name, block.values[INVARIANTS[name][0]])
    return block.values[name]

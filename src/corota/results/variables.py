"""Names of result variables, their meaning and dimension; invariants."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.results.derived import DERIVED
from corota.results.scalars import SCALARS, general

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray

    from corota.model.units import Units
    from corota.results.frame import Frame, PointFields

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: Nodal variables: name to (attribute of a frame, component); -1 is the magnitude.
NODAL: dict[str, tuple[str, int]] = {
    "U1": ("U", 0),
    "U2": ("U", 1),
    "U": ("U", -1),
    "UR3": ("UR", 0),
    "RF1": ("RF", 0),
    "RF2": ("RF", 1),
    "RF": ("RF", -1),
    "RM3": ("RF", 2),
    "F1": ("F", 0),
    "F2": ("F", 1),
    "F": ("F", -1),
    "M3": ("F", 2),
    "V1": ("V", 0),
    "V2": ("V", 1),
    "V": ("V", -1),
    "VR3": ("V", 2),
    "A1": ("A", 0),
    "A2": ("A", 1),
    "A": ("A", -1),
    "AR3": ("A", 2),
    "CPRESS": ("C", 0),
    "CSHEAR": ("C", 1),
    "COPEN": ("C", 2),
    "CSLIP": ("C", 3),
    "CSTATUS": ("C", 4),
}

#: Scalars of frames that are undefined where missing; others are 0 there.
UNKNOWN = ("stable", "negative pivots")

#: Columns of the contact values at nodes.
CONTACT = ("CPRESS", "CSHEAR", "COPEN", "CSLIP", "CSTATUS")

#: Forces of the nodes on the elements, in files.
FORCES = "nodal forces"

#: Tensors at points, rows xx, yy, zz, xy: stress, strain, plastic strain, back-stress deviator.
TENSORS = ("S", "E", "PE", "ALPHA")

#: Components of the tensors at points: name to (tensor, column).
COMPONENTS: dict[str, tuple[str, int]] = {
    f"{tensor}{name}": (tensor, column)
    for tensor in TENSORS
    for column, name in enumerate(("11", "22", "33", "12"))
}

#: Invariants: name to (tensor, which); computed from averaged components at nodes.
INVARIANTS: dict[str, tuple[str, str]] = {
    "MISES": ("S", "mises"),
    "SP1": ("S", "1"),
    "SP2": ("S", "2"),
    "SP3": ("S", "3"),
    "EP1": ("E", "1"),
    "EP2": ("E", "2"),
    "EP3": ("E", "3"),
}

#: Tensors by their names in files; other values have their own.
STORED = {"S": "stress", "E": "strain"}

#: Other spellings that :func:`canonical` accepts (compared in lower case).
ALIASES = {
    "displacement": "U",
    "rotation": "UR3",
    "ur": "UR3",
    "reaction": "RF",
    "rf3": "RM3",
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

#: Description of each variable, with its dimension; used in labels, file metadata and documents.
MEANING = {
    "U1": "displacement x [length]",
    "U2": "displacement y [length]",
    "U": "size of the displacement [length]",
    "UR3": "drilling rotation [rad]",
    "RF1": "reaction x [force]",
    "RF2": "reaction y [force]",
    "RF": "size of the reaction [force]",
    "RM3": "reaction moment [force*length]",
    "F1": "external force x [force]",
    "F2": "external force y [force]",
    "F": "size of the external force [force]",
    "M3": "external moment [force*length]",
    "V1": "velocity x",
    "V2": "velocity y",
    "V": "speed",
    "VR3": "angular velocity",
    "A1": "acceleration x",
    "A2": "acceleration y",
    "A": "size of the acceleration",
    "AR3": "angular acceleration",
    "S11": "Cauchy stress xx",
    "S22": "Cauchy stress yy",
    "S33": "Cauchy stress zz",
    "S12": "Cauchy stress xy",
    "MISES": "von Mises stress",
    "SP1": "largest principal stress",
    "SP2": "middle principal stress",
    "SP3": "smallest principal stress",
    "E11": "strain xx",
    "E22": "strain yy",
    "E33": "strain zz",
    "E12": "shear strain (angle)",
    "EP1": "largest principal strain",
    "EP2": "middle principal strain",
    "EP3": "smallest principal strain",
    "ENER": "strain energy density",
    "PEEQ": "equivalent plastic strain",
    "YRATIO": "equivalent over yield stress",
    "PE11": "plastic strain xx",
    "PE22": "plastic strain yy",
    "PE33": "plastic strain zz",
    "PE12": "plastic shear strain (angle)",
    "ALPHA11": "back-stress deviator xx",
    "ALPHA22": "back-stress deviator yy",
    "ALPHA33": "back-stress deviator zz",
    "ALPHA12": "back-stress deviator xy",
    "PWORK": "plastic work density",
    "PDISS": "plastic dissipation density",
    "STH": "current thickness [length]",
    "N": "axial force [force]",
    "M1": "moment at the first end [force*length]",
    "M2": "moment at the second end [force*length]",
    "CPRESS": "contact pressure",
    "CSHEAR": "contact shear traction",
    "COPEN": "contact gap [length]",
    "CSLIP": "contact slip [length]",
    "CSTATUS": "contact status: 0 open, 1 closed, 2 slipping",
}


def meaning(name: str) -> str:
    """Description of a variable, with its dimension; empty if unknown."""
    return MEANING.get(name) or (DERIVED[name].meaning if name in DERIVED else "")


#: Dimension of variables, by their names without the numbers of components.
_DIMENSIONS = {
    "U": "length", "UR": "rad", "RF": "force", "RM": "force*length", "F": "force",
    "M": "force*length", "V": "length/time", "VR": "rad/time", "A": "length/time^2",
    "AR": "rad/time^2", "S": "force/length^2", "MISES": "force/length^2", "SP": "force/length^2",
    "ALPHA": "force/length^2", "E": "", "EP": "", "PE": "", "YRATIO": "", "ENER": "energy/length^3",
    "PWORK": "energy/length^3", "PDISS": "energy/length^3", "STH": "length", "N": "force",
    "CPRESS": "force/length^2", "CSHEAR": "force/length^2", "COPEN": "length", "CSLIP": "length",
    "CSTATUS": "", "STATUS": "",
}  # fmt: skip
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
    variable = name.removeprefix("largest ").split(" ")[0].rstrip(":")
    if variable in DERIVED:
        found = DERIVED[variable].meaning.partition("[")[2].partition("]")[0]
        return found if found in ("length", "force", "force/length^2", "rad") else ""
    stem = variable.rstrip("0123456789")
    return _DIMENSIONS.get(stem, "") if variable.isupper() else ""


#: Dimensions of arrays of files.
_OF_ARRAYS = {
    "displacement": "length", "rotation": "rad", "reaction": "force", "external force": "force",
    "reaction moment": "force*length", "external moment": "force*length",
    "velocity": "length/time", "angular velocity": "rad/time", "acceleration": "length/time^2",
    "angular acceleration": "rad/time^2", "stress": "force/length^2", "frame rotation": "rad",
    "principal stress": "force/length^2", "Mises": "force/length^2", "position": "length",
    "strain": "", "principal strain": "",
}  # fmt: skip


def dimension_of_array(name: str) -> str:
    """Dimension of an array of a result file, in the form of :func:`dimension`."""
    stem = name.removeprefix("cell ").partition(": ")[0]
    return _OF_ARRAYS[stem] if stem in _OF_ARRAYS else dimension(stem)


def stored_as(name: str) -> tuple[str, int]:
    """Array of a file that holds a component, invariant or scalar, and its column; -1 for all."""
    if name in COMPONENTS:
        tensor, column = COMPONENTS[name]
        return STORED.get(tensor, tensor), column
    if name == "MISES":
        return "Mises", -1
    if name in INVARIANTS:
        tensor, which = INVARIANTS[name]
        return f"principal {STORED[tensor]}", int(which) - 1
    return name, -1


def averaged_names(averages: Mapping[str, Floats]) -> list[str]:
    """Components, invariants and scalars that arrays of a file hold."""
    tensors = {*TENSORS, *STORED.values()}
    found = [n for n in (*COMPONENTS, *INVARIANTS) if stored_as(n)[0] in averages]
    skip = {"Mises", "principal stress", "principal strain", *tensors}
    return found + sorted(n for n in averages if n not in skip)


def averaged_value(averages: Mapping[str, Floats], name: str) -> Floats:
    """A component, invariant or scalar from arrays of a file, shape (n,)."""
    array, column = stored_as(name)
    if array not in averages and name in INVARIANTS:
        tensor = STORED[INVARIANTS[name][0]]
        return invariant(name, averages[tensor][:, :4])
    values = averages[array]
    return np.asarray(values if column < 0 else values[:, column], dtype=np.float64)


def labelled(name: str, units: Units, of: str = "") -> str:
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


def mises(stress: Floats) -> Floats:
    """Von Mises stress of rows xx, yy, zz, xy; shape (..., 4) to (...)."""
    xx, yy, zz, xy = (stress[..., i] for i in range(4))
    square = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2
    return np.asarray(np.sqrt(square), dtype=np.float64)


def principal(tensor: Floats, shear: float = 1.0) -> Floats:
    """Principal values, largest first, out-of-plane one included; (..., 4) to (..., 3).

    Parameters
    ----------
    tensor : ndarray, shape (..., 4)
        Rows xx, yy, zz, xy.
    shear : float
        Factor from the stored shear to the tensor's: 1 for stress, 1/2 for strain.
    """
    xx, yy, zz, xy = (tensor[..., i] for i in range(4))
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), shear * xy)
    high, low = middle + radius, middle - radius
    between = np.maximum(low, np.minimum(high, zz))
    return np.stack([np.maximum(high, zz), between, np.minimum(low, zz)], axis=-1)


def invariant(name: str, tensor: Floats) -> Floats:
    """Values of an invariant of :data:`INVARIANTS` from its tensor, (..., 4) to (...)."""
    kind, which = INVARIANTS[name]
    if which == "mises":
        return mises(tensor)
    return np.asarray(principal(tensor, 1.0 if kind == "S" else 0.5)[..., int(which) - 1])


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
    of_cells = {n.removeprefix("cell "): v for n, v in frame.cell_averages.items()}
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

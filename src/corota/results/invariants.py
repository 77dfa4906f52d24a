"""Invariants of stress and strain, one record each, from which all outputs follow.

A record of :data:`OF_STRESS` or :data:`OF_STRAIN` is an output variable everywhere: in histories,
extremes, pictures, requests of decks, ``.dat``, ``.frd`` and VTK files, the report, allowables of
stages. It is computed from averaged or interpolated components wherever these are.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from corota.arrays import Floats


@dataclass(frozen=True)
class Invariant:
    """A number computed from the components of a tensor.

    Parameters
    ----------
    name, meaning : str
    function : callable
        Takes the tensor components xx, yy, zz, xy, shape (..., 4); returns shape (...), or
        (..., k) if several invariants are columns of one array. It must be finite.
    array : str
        Its array in result files.
    column : int
        Column of the array; -1 for an array of one number.
    dimension : str, optional
        That of the tensor by default.
    positive : bool
        Whether it is negative nowhere.
    """

    name: str
    meaning: str
    function: Callable[[Floats], Floats]
    array: str
    column: int = -1
    dimension: str | None = None
    positive: bool = False


def mises(stress: Floats) -> Floats:
    """Von Mises stress of rows xx, yy, zz, xy; shape (..., 4) to (...)."""
    xx, yy, zz, xy = (stress[..., i] for i in range(4))
    square = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2
    return np.asarray(np.sqrt(square), dtype=np.float64)


def principal(tensor: Floats) -> Floats:
    """Principal values, largest first, out-of-plane one included; (..., 4) to (..., 3)."""
    xx, yy, zz, xy = (tensor[..., i] for i in range(4))
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    high, low = middle + radius, middle - radius
    between = np.maximum(low, np.minimum(high, zz))
    return np.stack([np.maximum(high, zz), between, np.minimum(low, zz)], axis=-1)


def tresca(stress: Floats) -> Floats:
    """Tresca equivalent stress, the largest difference of principal stresses."""
    values = principal(stress)
    return np.asarray(values[..., 0] - values[..., 2])


def triaxiality(stress: Floats) -> Floats:
    """Mean stress over von Mises stress: 1/3 in uniaxial tension; 0 without stress.

    It has no bound as the stress becomes hydrostatic; rounding of the von Mises stress limits it
    to 1 over the machine epsilon.
    """
    mean = stress[..., :3].mean(axis=-1)
    size = np.maximum(mises(stress), np.finfo(np.float64).eps * np.abs(mean))
    found: Floats = np.divide(mean, size, out=np.zeros_like(mean), where=size > 0.0)
    return found


def _principal(letter: str, what: str) -> tuple[Invariant, ...]:
    array = f"principal {what}"
    return tuple(
        Invariant(f"{letter}P{i + 1}", f"{place} {array}", principal, array, i)
        for i, place in enumerate(("largest", "middle", "smallest"))
    )


#: In the order of the rows of result files: new ones come last.
OF_STRESS = (
    Invariant("MISES", "von Mises stress", mises, "Mises", positive=True),
    *_principal("S", "stress"),
    Invariant("TRESC", "Tresca equivalent stress", tresca, "Tresca", positive=True),
    Invariant("TRIAX", "stress triaxiality", triaxiality, "triaxiality", dimension=""),
)  # fmt: skip
OF_STRAIN = _principal("E", "strain")

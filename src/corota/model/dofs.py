"""Degrees of freedom of a node by name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from corota.errors import InputError, Location
from corota.names import did_you_mean

#: Degrees of freedom of a node by name; decks number them 1, 2 and 6.
DOFS = {"x": 0, "y": 1, "rotation": 2}
#: Names that other programs use.
_FOREIGN = {
    "theta": "rotation", "rz": "rotation", "ur3": "rotation", "phi": "rotation", "moment":
    "rotation", "ux": "x", "u1": "x", "uy": "y", "u2": "y", "1": "x", "2": "y", "6": "rotation",
}  # fmt: skip


def dof_index(dof: object, where: Location | None = None) -> int:
    """Number of a dof from ``"x"``, ``"y"``, ``"rotation"``, or that number itself, 0 to 2.

    Raises
    ------
    InputError
        If it is none of these.

    Examples
    --------
    >>> dof_index("rotation")
    2
    """
    if not isinstance(dof, (bool, str)) and dof in (0, 1, 2):
        return int(dof)
    if isinstance(dof, str) and dof.lower() in DOFS:
        return DOFS[dof.lower()]
    known = _FOREIGN.get(str(dof).lower())
    hint = f"; did you mean {known!r}?" if known else did_you_mean(str(dof), DOFS)
    raise InputError(
        f"no degree of freedom {dof!r}; there are 'x', 'y' and 'rotation'{hint}", where
    )


def dof_indices(dofs: object) -> tuple[int, ...]:
    """Numbers of the dofs in ``"x y"``, or in a sequence of names or numbers.

    Raises
    ------
    InputError
        If one is unknown, or there are none.
    """
    names = dofs.split() if isinstance(dofs, str) else dofs
    if not isinstance(names, (list, tuple)) or not names:
        raise InputError(f"dofs are named as in 'x y rotation', not {dofs!r}")
    return tuple(dof_index(name) for name in names)

"""Selections by arrays: indices or masks of nodes and cells, pairs for edges."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError, Location

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from corota.arrays import Ints


def indices(
    given: ArrayLike, what: str, count: int | None = None, where: Location | None = None
) -> Ints:
    """Indices of nodes or cells, shape (n,).

    Parameters
    ----------
    given : array_like
        Whole numbers from 0, or a mask with one entry for each node or cell.
    what : str
        ``"node"`` or ``"cell"``.
    count : int, optional
        How many there are; without it the range is not checked.

    Raises
    ------
    InputError
        If these are not indices, are empty or out of range.

    Examples
    --------
    >>> import numpy as np
    >>> indices(np.array([True, False, True]), "node", 3).tolist()
    [0, 2]
    """
    array = _array(given, what, where)
    if array.dtype == np.bool_:
        if array.ndim != 1 or (count is not None and len(array) != count):
            raise InputError(
                f"a mask of {what}s needs one entry for each {what}, shape "
                f"({'n' if count is None else count},), not {array.shape}",
                where,
            )
        array = np.flatnonzero(array)
    elif array.ndim > 1:
        pairs = (
            "; this looks like edges (cell, side): use an edge set or traction, or take "
            "mesh.edge_set_nodes(edges)"
        )
        raise InputError(
            f"{what} indices have shape (n,), not {array.shape}"
            + (pairs if what == "node" and array.shape[-1] == 2 else ""),
            where,
        )
    array = np.atleast_1d(array)
    if not array.size:
        raise InputError(f"no {what}s are given", where)
    _in_range(array, what, count, where)
    return array.astype(np.int64)


def names(given: object) -> tuple[str, ...] | None:
    """Names of several sets, where a list, a tuple or an array of names is given.

    Examples
    --------
    >>> names(["left", "top"]), names("left"), names([0, 1])
    (('left', 'top'), None, None)
    """
    if isinstance(given, np.ndarray) and given.dtype.kind in "US":
        given = given.ravel().tolist()
    if isinstance(given, list | tuple) and given and all(isinstance(g, str) for g in given):
        return tuple(given)
    return None


def pairs(given: ArrayLike, count: int | None = None, where: Location | None = None) -> Ints:
    """Edges as pairs of cell index and local edge, shape (n, 2).

    Raises
    ------
    InputError
        If these are not such pairs.
    """
    array = _array(given, "edge", where)
    if array.dtype == np.bool_ or array.ndim != 2 or array.shape[1] != 2:
        raise InputError(
            "edges are pairs of cell index and local edge, shape (n, 2), not "
            f"{array.dtype} of shape {array.shape}",
            where,
        )
    if not array.size:
        raise InputError("no edges are given", where)
    _in_range(array[:, 0], "cell", count, where)
    _in_range(array[:, 1], "local edge", 4, where)
    return array.astype(np.int64)


def one(given: object, what: str, count: int) -> int:
    """One index.

    Raises
    ------
    InputError
        If it is not an index, or out of range.
    """
    if isinstance(given, (bool, np.bool_)) or not isinstance(given, (int, np.integer)):
        raise InputError(f"a {what} is given by its index, not {given!r}")
    _in_range(np.array([int(given)]), what, count, None)
    return int(given)


def _array(given: ArrayLike, what: str, where: Location | None) -> NDArray[Any]:
    try:
        array = np.asarray(given)
    except ValueError:
        raise InputError(f"{what}s of unequal shape", where) from None
    if array.size and array.dtype.kind not in "iub":
        example = array.ravel()[0]
        raise InputError(
            f"{what}s are selected by the name of a set, whole numbers from 0, or a mask, not by "
            f"{type(example).__name__} such as {example!r}",
            where,
        )
    return array


def _in_range(array: NDArray[Any], what: str, count: int | None, where: Location | None) -> None:
    low, high = int(array.min()), int(array.max())
    if low < 0:
        raise InputError(f"{what} index {low} is negative; indices count from 0", where)
    if count is not None and high >= count:
        raise InputError(f"no {what} with index {high}; there are {count}, counted from 0", where)

"""One number of each frame: variables at a place, reduced over its nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.mesh.selection import names
from corota.names import choose
from corota.results.history import History
from corota.results.variables import NODAL, UNKNOWN, match_name, point_value

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.results.source import ResultSource

    Ints = NDArray[np.int64]

#: Attributes of frames by the names of their histories.
OF_FRAMES = {
    "time": "time",
    "step time": "step_time",
    "load factor": "factor",
    "factor": "factor",
    "step": "step",
    "increment": "increment",
}
#: Reducers over the nodes.
REDUCERS = ("auto", "sum", "mean", "max")


def history(
    results: ResultSource, name: str, at: str | int | Sequence[int] | None, combine: str
) -> History:
    """A variable over the frames; see :meth:`corota.results.Results.history`."""
    frames = results.frames
    if name in OF_FRAMES:
        values = [float(getattr(f, OF_FRAMES[name])) for f in frames]
        return History("load factor" if name == "factor" else name, np.array(values), results)
    if any(name in f.scalars for f in frames):
        missing = np.nan if name in UNKNOWN else 0.0
        values = [f.scalars.get(name, missing) for f in frames]
        return History(name, np.array(values), results)
    choose(combine, REDUCERS, "way to combine")
    name = variable_name(results, name)
    nodes = None if at is None else results.mesh.node_indices(at)
    values = [_one(results, name, i, nodes, combine) for i in range(len(frames))]
    where = "" if at is None else f" at {_place(at)}"
    return History(name + where, np.array(values), results)


def variable_name(results: ResultSource, name: str) -> str:
    """Name of a variable of any frame.

    Raises
    ------
    InputError
        With all existing names, including scalars of frames.
    """
    frames = results.frames
    if not frames:
        raise InputError("there are no frames yet")
    valid = list(dict.fromkeys([*results.variables(-1), *results.variables(0)]))
    try:
        return match_name(name, valid)
    except InputError as error:
        scalars = sorted({key for f in (frames[0], frames[-1]) for key in f.scalars})
        raise InputError(
            f"{error.message}; of the whole: time, step time, load factor, step, increment, "
            + ", ".join(scalars)
        ) from None


def _one(results: ResultSource, name: str, index: int, at: Ints | None, combine: str) -> float:
    """A variable of a frame at nodes, or everywhere."""
    frame = results.frame(index)
    if name in NODAL and getattr(frame, NODAL[name][0]) is None:
        return float("nan")  # such as a velocity before the first dynamic step
    if at is None and name not in NODAL and combine in ("auto", "max"):
        if not frame.fields:
            return float(results.nodal(name, index).max())
        return max(float(point_value(b, name).max()) for b in frame.fields)
    values = results.nodal(name, index)
    if at is not None:
        values = values[at]
    if combine == "auto":
        force = name in NODAL and name[0] in "RFM"
        combine = "sum" if force else "mean" if at is not None else "size"
    if combine == "size":
        return float(values[np.argmax(np.abs(values))])
    if combine == "sum":
        return float(values.sum())
    return float(values.mean() if combine == "mean" else values.max())


def _place(at: Any) -> str:
    """A place in few words: a set's name, a node, or a number of nodes."""
    if isinstance(at, str):
        return at
    if several := names(at):
        return ", ".join(several)
    array = np.atleast_1d(np.asarray(at))
    count = int(array.sum()) if array.dtype == bool else len(array)
    return f"node {array[0]}" if count == 1 and array.dtype != bool else f"{count} nodes"

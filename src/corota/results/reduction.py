"""One number of each frame: variables at a place, reduced over its nodes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.mesh.geometric import is_selection
from corota.mesh.selection import names
from corota.names import choose, listed
from corota.results.extremes import Extreme, extremes_of_row, no_points, row_of
from corota.results.history import History
from corota.results.measures import MEASURES, stage_measure
from corota.results.table import NODAL, TABLE
from corota.results.variables import ALIASES, available, match_name, nodal_value, point_value

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from corota.arrays import Ints
    from corota.results.frame import Frame
    from corota.results.source import ResultSource


#: Reducers over the nodes.
REDUCERS = ("auto", "sum", "mean", "max", "min", "absmax")
#: Which of the nodes a reducer takes.
PICKED: dict[str, Callable[[Any], Any]] = {
    "max": np.argmax,
    "min": np.argmin,
    "absmax": lambda values: np.argmax(np.abs(values)),
}
#: Vectors of forces by the names of their sizes: several nodes have a resultant.
RESULTANTS = {r.size[0]: r.frame for r in TABLE.values() if r.force and r.size[0]}
#: Variables that several nodes have the sum of.
SUMMED = {name for r in TABLE.values() if r.force for name in r.names}


def is_summed(name: str) -> bool:
    """Whether several nodes have the sum of a variable: a force or a moment."""
    return ALIASES.get(name.lower(), name.upper()) in SUMMED


def history(
    results: ResultSource, name: str, at: str | int | Sequence[int] | None, combine: str
) -> History:
    """A variable over the frames; see :meth:`corota.results.Results.history`."""
    frames = results.frames
    name = "load factor" if name == "factor" else name
    if scalar := _scalar(results, name, at):
        return History(scalar, results.scalar_values(scalar), results)
    combine = choose(combine, REDUCERS, "way to combine")
    name = variable_name(results, name)
    where = "" if at is None else f" at {_place(at)}"
    if name in NODAL or not _at_points(results, at):
        nodes = None if at is None or _all_nodes(results, at) else results.mesh.node_indices(at)
        label = f"{name}{where}" if name in NODAL else f"{name}{where} (nodal)"
        found = [_nodal(results, name, i, nodes, combine) for i in range(len(frames))]
        return _with_places(label.replace(" at nodes (nodal)", " (nodal)"), found, results)
    cells = None
    if at is not None:
        cells = np.zeros(results.mesh.n_cells, dtype=bool)
        cells[results.mesh.cell_indices(at)] = True
    found = [_of_points(results, f, name, cells, combine) for f in frames]
    return _with_places(name + where, found, results)


def _with_places(label: str, found: list[float | Extreme], results: ResultSource) -> History:
    """A history, with the place of each value that is one of a place."""
    places = tuple(f if isinstance(f, Extreme) else None for f in found)
    values = [f.value if isinstance(f, Extreme) else f for f in found]
    return History(label, np.array(values), results, places if any(places) else ())


def _scalar(results: ResultSource, name: str, at: Any) -> str:
    """Scalar of the frames by its name, or by that of a measure and of a stage; else empty.

    Raises
    ------
    InputError
        If a measure is named without its stage, and there is not exactly one.
    """
    known = results.scalar_names()
    if name in known:
        return name
    stages = {key.rpartition(": ")[0] for key in known if stage_measure(key)}
    if stage_measure(name) and name.rpartition(": ")[0] in stages:
        return name
    if name not in MEASURES:
        return ""
    if at is None and len(stages) == 1:
        return f"{stages.pop()}: {name}"
    if isinstance(at, str) and at in stages:
        return f"{at}: {name}"
    defined = f"stages are {', '.join(sorted(stages))}" if stages else "the model has no stage"
    raise InputError(
        f"{name!r} is a measure of a stage, and {defined}; define it before the run, by "
        "model.stage(...) or --stage, and write history(..., at=stage)"
    )


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
        scalars = [key for key in results.scalar_names() if not stage_measure(key)]
        measures = ""
        if len(scalars) < len(results.scalar_names()):
            words = set(name.lower().split())
            near = [m for m in MEASURES if words & set(m.split())] or list(MEASURES)
            measures = f"; measures of stages: {listed(near)}"
        raise InputError(f"{error.message}; of the whole: {', '.join(scalars)}{measures}") from None


def _all_nodes(results: ResultSource, at: Any) -> bool:
    """Whether a place is the word for all nodes, not the name of a set."""
    mesh = results.mesh
    names_of_sets = {*mesh.node_sets, *mesh.edge_sets, *mesh.cell_sets}
    return isinstance(at, str) and at == "nodes" and at not in names_of_sets


def _at_points(results: ResultSource, at: Any) -> bool:
    """Whether a place has quadrature points: everywhere, or an element set."""
    mesh = results.mesh
    if at is None:
        return True
    if not isinstance(at, str) or is_selection(at) or _all_nodes(results, at):
        return False
    name = mesh.set_name(at)
    return name in mesh.cell_sets and name not in mesh.node_sets and name not in mesh.edge_sets


def _of_points(
    results: ResultSource, frame: Frame, name: str, cells: Any, combine: str
) -> float | Extreme:
    """A variable at the points of a frame; not a number in frames without it."""
    if combine in ("sum", "mean"):
        parts = [
            point_value(b, name)[slice(None) if cells is None else cells[b.cells]].ravel()
            for b in frame.fields
            if name in available([b])
        ]
        if not parts:
            raise no_points(name)
        every = np.concatenate(parts)
        return float(every.sum() if combine == "sum" else every.mean())
    row = row_of(frame, name, cells)
    if row is None:
        known = frame.fields or (cells is None and frame.extremes)
        if known:
            return float("nan")
        raise no_points(name)
    low, high = extremes_of_row(row, results.mesh.cell_labels)
    if combine == "min":
        return low
    return high if combine == "max" or abs(high.value) >= abs(low.value) else low


def _nodal(
    results: ResultSource, name: str, index: int, at: Ints | None, combine: str
) -> float | Extreme:
    """A variable of a frame at nodes, or at all of them."""
    frame = results.frame(index)
    if name in NODAL and getattr(frame, NODAL[name][0]) is None:
        # Static steps are at rest, as files and tables have it.
        return 0.0 if NODAL[name][0] in ("V", "A") else float("nan")
    if name in RESULTANTS and combine in ("auto", "sum"):
        force = getattr(frame, RESULTANTS[name])[:, :2]
        return float(np.hypot(*(force if at is None else force[at]).sum(axis=0)))
    if name not in NODAL and name not in results.variables(index):
        return float("nan")  # as of the amplitudes of stress in a step before the harmonic one
    values = nodal_value(frame, name) if name in NODAL else results.nodal(name, index)
    if at is not None:
        values = values[at]
    if combine == "auto":
        combine = "sum" if name in SUMMED else "mean" if at is not None else "absmax"
    if combine not in PICKED:
        return float(getattr(values, combine)())
    row = int(PICKED[combine](values))
    node = row if at is None else int(at[row])
    x, y = (results.mesh.points[node] + frame.U[node]).tolist()
    return Extreme(float(values[row]), x, y, node=int(results.mesh.node_labels[node]))


def _place(at: Any) -> str:
    """A place in few words: a set's name, a node, or a number of nodes."""
    if isinstance(at, str):
        return at
    if several := names(at):
        return ", ".join(several)
    array = np.atleast_1d(np.asarray(at))
    count = int(array.sum()) if array.dtype == bool else len(array)
    return f"node {array[0]}" if count == 1 and array.dtype != bool else f"{count} nodes"

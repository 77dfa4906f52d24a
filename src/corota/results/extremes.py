"""The smallest and the largest value of a variable in a frame, each with its place."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Bools, Floats, Ints, distinct
from corota.errors import InputError
from corota.results.table import NODAL, variables
from corota.results.variables import match_name, point_value

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from corota.results.frame import Frame, PointFields
    from corota.results.source import ResultSource


#: Numbers of an extreme in result files: value, index of the cell, point from 0, position.
WIDTH = 5


@dataclass(frozen=True)
class Extreme:
    """A value and its place.

    Parameters
    ----------
    value : float
    x, y : float
        Current position [length].
    node : int or None
        Label, of a nodal value.
    element, point : int or None
        Label, and number of the quadrature point from 1.
    """

    value: float
    x: float
    y: float
    node: int | None = None
    element: int | None = None
    point: int | None = None

    @property
    def place(self) -> str:
        """The place in words."""
        if self.node is not None:
            return f"node {self.node}"
        return f"element {self.element}, point {self.point}"

    def __str__(self) -> str:
        return f"{self.value:.6g} at {self.place}"


@dataclass(frozen=True)
class Extremes:
    """Extremes of a variable in a frame.

    Parameters
    ----------
    name : str
    at : {"points", "nodes"}
        Whether these are values at quadrature points or nodal values.
    smallest, largest : Extreme
    """

    name: str
    at: str
    smallest: Extreme
    largest: Extreme

    @property
    def by_size(self) -> Extreme:
        """The extreme of the larger size, with its sign."""
        low, high = self.smallest, self.largest
        return high if abs(high.value) >= abs(low.value) else low

    def __str__(self) -> str:
        kind = " (nodal)" if self.at == "nodes" and self.name not in NODAL else ""
        return f"{self.name}{kind}: smallest {self.smallest}; largest {self.largest}"


def rows_of(frame: Frame) -> dict[str, Floats]:
    """Extremes at points by variable, as files have them: rows of its names, shape (n, 10)."""
    found: dict[str, Floats] = {}
    for variable, row in variables().items():
        if not row.frame:
            rows = [row_of(frame, name) for name in row.names]
            if not any(one is None for one in rows):
                found[variable] = np.stack(rows)  # type: ignore[arg-type]
    return found


def places_of(rows: Mapping[str, int]) -> dict[str, tuple[str, int]]:
    """Array and row of each variable, component and invariant of such a dictionary.

    Parameters
    ----------
    rows : mapping of str to int
        Number of rows of each array; files of earlier versions do not have the last ones.
    """
    known = variables()
    return {
        part: (name, i)
        for name, count in rows.items()
        for i, part in enumerate((known[name].names if name in known else [name])[:count])
    }


def point_row(
    fields: Iterable[PointFields], name: str, cells: Bools | None = None
) -> Floats | None:
    """Smallest and largest value at points with their places, shape (10,); None without points.

    Parameters
    ----------
    fields : iterable of PointFields
    name : str
    cells : ndarray of bool, shape (n_cells,), optional
        Cells that count.
    """
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    for block in fields:
        try:
            values = point_value(block, name)
        except KeyError:
            continue
        if cells is not None:
            values = np.where(cells[block.cells][:, None], values, np.nan)
        if not values.size or (cells is not None and np.isnan(values).all()):
            continue
        least, most = (int(np.nanargmin(values)), int(np.nanargmax(values)))
        if not low or values.flat[least] < low[0]:
            low = _row(block, values, least)
        if not high or values.flat[most] > high[0]:
            high = _row(block, values, most)
    return np.array([*low, *high]) if low else None


def _row(block: PointFields, values: Floats, flat: int) -> tuple[float, ...]:
    n, p = divmod(flat, values.shape[1])
    return (float(values[n, p]), float(block.cells[n]), float(p), *block.points[n, p].tolist())


def row_of(frame: Frame, name: str, cells: Bools | None = None) -> Floats | None:
    """Extremes at the points of a frame, or those that its file contains; shape (10,)."""
    if frame.fields:
        return point_row(frame.fields, name, cells)
    if cells is not None or name not in frame.extremes:
        return None
    row = np.asarray(frame.extremes[name], dtype=np.float64)
    return None if np.isnan(row).any() else row


def extremes(results: ResultSource, name: str, index: int, at: str) -> Extremes:
    """Extremes of a variable; see :meth:`corota.results.Results.extremes`."""
    frame = results.frame(index)
    name = match_name(name, results.variables(index))
    if at not in ("points", "nodes"):
        raise InputError(f"extremes are taken at 'points' or at 'nodes', not {at!r}")
    if name in NODAL or at == "nodes":
        return _at_nodes(results, frame, name, index)
    row = row_of(frame, name)
    if row is None:
        raise no_points(name)
    return Extremes(name, "points", *extremes_of_row(row, results.mesh.cell_labels))


def extremes_of_row(row: Floats, labels: Ints) -> tuple[Extreme, Extreme]:
    """Smallest and largest value of a row of :func:`row_of`; `labels`: of the cells."""
    low, high = (
        Extreme(value, x, y, element=int(labels[int(cell)]), point=int(point) + 1)
        for value, cell, point, x, y in (row[:WIDTH].tolist(), row[WIDTH:].tolist())
    )
    return low, high


def no_points(name: str) -> InputError:
    """The error where there are only nodal values."""
    return InputError(
        f"these results have {name} at the nodes only, extrapolated and averaged, not at the "
        'quadrature points; take the nodal values: at="nodes"'
    )


def _at_nodes(results: ResultSource, frame: Frame, name: str, index: int) -> Extremes:
    mesh = results.mesh
    groups: list[int | None] = [None]
    inside = None
    if name not in NODAL:
        inside = results.cells_with(name, index)
        if not inside.any() and not frame.fields:
            inside = np.ones(mesh.n_cells, dtype=bool)  # files that do not tell
        of_cells = results.sections()
        groups = [int(g) for g in distinct(of_cells[inside])]
    found: list[tuple[float, int]] = []
    for group in groups:
        values = results.nodal(name, index, group)
        nodes = np.arange(mesh.n_nodes)
        if inside is not None:
            cells = inside & (of_cells == group)
            around = [
                block.nodes[cells[offset : offset + len(block)]].ravel()
                for offset, block in zip(mesh.offsets, mesh.cells, strict=False)
            ]
            nodes = distinct(np.concatenate(around))
        picked = values[nodes]
        found += [(float(picked[i]), int(nodes[i])) for i in (picked.argmin(), picked.argmax())]
    at = mesh.points + frame.U
    low, high = (
        Extreme(value, float(at[node, 0]), float(at[node, 1]), node=int(mesh.node_labels[node]))
        for value, node in (min(found, key=lambda f: f[0]), max(found, key=lambda f: f[0]))
    )
    return Extremes(name, "nodes", low, high)

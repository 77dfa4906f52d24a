"""Histories as CSV: one row per increment, one column per quantity."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Ints, distinct
from corota.errors import FileError, InputError
from corota.io.atomic_file import TextFile, full, replace_text
from corota.model.units import Units
from corota.results.derived import DERIVED
from corota.results.extremes import WIDTH, row_of
from corota.results.results import Results
from corota.results.scalars import where_missing
from corota.results.table import DIMENSIONS, NODAL
from corota.results.variables import labeled, nodal_value

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.frame import Frame


#: Scalars of a frame that always have a column.
ALWAYS = ("iterations", "strain energy", "external work", "kinetic energy")
#: Components of a reaction.
FORCES = ("RF1", "RF2")
#: Largest number of nodes of a print request that get a column each.
FEW_NODES = 10


def support_sets(model: Model, steps: Sequence[Step]) -> dict[str, Ints]:
    """Nodes of each named support, and of all supports together under ``all supports``."""
    found: dict[str, Ints] = {}
    every: list[Ints] = []
    for support in [*model.supports, *(s for step in steps for s in step.supports)]:
        where = support.nodes
        nodes = model.mesh.node_indices(where)
        every.append(nodes)
        if isinstance(where, str):
            found[where] = distinct(nodes)
    if every:
        found["all supports"] = distinct(np.concatenate(every))
    return found


def requested_nodes(
    model: Model, steps: Sequence[Step], extra: Sequence[str] = ()
) -> list[tuple[str, str, Any, Any]]:
    """Columns of requests: (heading, variable, place, reducer).

    Parameters
    ----------
    extra : sequence of str
        ``VARIABLE@SET`` or ``VARIABLE@node number``, such as ``U2@TIP``, as
        :meth:`~corota.results.results.Results.history` takes them; without a place two columns, the
        smallest and the largest value anywhere.
    """
    mesh = model.mesh
    found: list[tuple[str, str, Any, Any]] = []
    for request in extra:
        name, _, where = (part.strip() for part in request.partition("@"))
        name = name.upper()
        bare = name in NODAL or "@" in request
        if (name not in DIMENSIONS and name not in DERIVED) or (bare and not where):
            raise InputError(
                f"history {request!r}: write VARIABLE@SET or VARIABLE@NODE, or a variable at "
                "points, with one of " + ", ".join([*DIMENSIONS, *DERIVED])
            )
        if not where or where == "nodes":
            everywhere, kind = where or None, " (nodal)" if where and name not in NODAL else ""
            found.append((f"smallest {name}{kind}", name, everywhere, "min"))
            found.append((f"largest {name}{kind}", name, everywhere, "max"))
            continue
        place: Any = where
        if where.isdigit() and where not in mesh.node_sets:
            place = np.flatnonzero(mesh.node_labels == int(where))
            if not len(place):
                raise InputError(f"history {request!r}: there is no node {where}")
        else:
            mesh.nodes_of(where)
        found.append((f"{name} {where}", name, place, "auto"))
    for output in (o for step in steps for o in step.outputs):
        if output.kind != "node print" or not output.where:
            continue
        nodes = mesh.nodes_of(output.where)
        if output.totals != "no" and "RF" in (v.upper() for v in output.variables):
            found += [(f"{part} {output.where}", part, output.where, "sum") for part in FORCES]
        if len(nodes) > FEW_NODES or output.totals == "only":
            continue
        for node in nodes:
            label = int(mesh.node_labels[node])
            for name in (v.upper() for v in output.variables):
                parts = {"U": ("U1", "U2"), "RF": FORCES}.get(name, ())
                at = np.array([node])
                found += [(f"{part} node {label}", part, at, "auto") for part in parts]
    return list({column[0]: column for column in found}.values())


def balance_error(scalars: dict[str, float]) -> float:
    """Energy-balance error relative to the largest energy so far; 0 at the start."""
    if "energy balance error" in scalars:
        return scalars["energy balance error"]
    if "external work" not in scalars:  # modes, for instance: there is no balance
        return 0.0
    stored = [v for k, v in scalars.items() if k.endswith("energy") or k.endswith("dissipation")]
    work = scalars.get("external work", 0.0)
    scale = max([abs(work), *map(abs, stored)], default=0.0)
    missing = scalars.get("energy balance", sum(stored) - work)
    return missing / scale if scale > 0.0 else 0.0


class Histories:
    """Collects one row of numbers from each frame.

    Parameters
    ----------
    extra : sequence of str
        See :func:`requested_nodes`.
    """

    def __init__(self, model: Model, steps: Sequence[Step], extra: Sequence[str] = ()) -> None:
        self._supports = support_sets(model, steps)
        self._points = model.mesh.points
        self._labels = model.mesh.node_labels
        self._turns = [getattr(step, "nlgeom", True) for step in steps]
        self._nodes = requested_nodes(model, steps, extra)
        self._one = Results(model)
        self._before: tuple[int, float] = (0, 0.0)

    @property
    def before(self) -> tuple[int, float]:
        """Step and step time of the last row."""
        return self._before

    def resume(self, before: tuple[int, float]) -> None:
        """Continue after a row."""
        self._before = before

    def row(self, frame: Frame, attempts: int = 1) -> dict[str, float]:
        """Headings and numbers of a frame."""
        step, time = self._before
        dt = frame.step_time - (time if frame.step == step else 0.0)
        self._before = (frame.step, frame.step_time)
        row: dict[str, float] = {
            "step": frame.step,
            "increment": frame.increment,
            "time": frame.time,
            "step time": frame.step_time,
            "dt": dt,
            "load factor": frame.factor,
            "attempts": attempts if frame.increment else 0,
        }
        row |= {name: frame.scalars.get(name, 0.0) for name in ALWAYS}
        row |= frame.scalars
        row["energy balance error"] = balance_error(frame.scalars)
        row["largest U"] = float(nodal_value(frame, "U").max(initial=0.0))
        found = row_of(frame, "MISES")
        row["largest MISES"] = 0.0 if found is None else float(found[WIDTH])
        for name, nodes in self._supports.items() if "RF" not in frame.absent else ():
            for i, part in enumerate(FORCES):
                row[f"{part} {name}"] = float(frame.RF[nodes, i].sum())
            heading, moment = self.moment(frame, nodes)
            row[f"RM3 {name} {heading}"] = moment
        self._one.frames = [frame]
        for heading, name, place, combine in self._nodes:
            try:
                row[heading] = float(self._one.history(name, place, combine)[0])
            except InputError:  # a frame without the variable, such as a velocity at rest
                row[heading] = 0.0
        return row

    def moment(self, frame: Frame, nodes: Ints) -> tuple[str, float]:
        """Total moment of the reactions, and the point it is about.

        Of one node that is the node itself, where it is; of several the centroid of their
        undeformed positions. Forces act at the current positions.
        """
        if len(nodes) == 1:
            label = int(self._labels[nodes[0]])
            return f"about node {label}", float(frame.RF[nodes[0], 2])
        center = self._points[nodes].mean(axis=0)
        arm = self._points[nodes] - center
        turns = self._turns[frame.step - 1] if frame.step <= len(self._turns) else True
        if turns:
            arm = arm + frame.U[nodes]
        force = frame.RF[nodes]
        total = arm[:, 0] @ force[:, 1] - arm[:, 1] @ force[:, 0] + force[:, 2].sum()
        return f"about ({center[0]:.6g} {center[1]:.6g})", float(total)


def csv_text(rows: Sequence[dict[str, float]], units: Units | None = None) -> str:
    """Table of rows; missing quantities are 0. Headings include the given units."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    return _line(headings(names, units)) + "".join(_values(row, names) for row in rows)


def headings(names: Sequence[str], units: Units | None) -> list[str]:
    """Names of columns with their units, without quotes."""
    named_units = units or Units()
    return [labeled(name, named_units).replace('"', "'") for name in names]


def _line(names: Sequence[str]) -> str:
    quoted = (f'"{n}"' if "," in n else n for n in names)
    return ",".join(quoted) + "\n"


def _values(row: dict[str, float], names: Sequence[str]) -> str:
    values = (row.get(name, where_missing(name)) for name in names)
    # What is undefined in a frame is an empty field.
    return ",".join("" if v != v else f"{v:.12g}" for v in values) + "\n"


class CsvWriter:
    """Extends a CSV file by one row per frame; a new column rewrites it.

    Parameters
    ----------
    units : Units, optional
        For the headings.
    """

    def __init__(self, path: Path, units: Units | None = None) -> None:
        self.path, self._units = path, units
        self._rows: list[dict[str, float]] = []
        self._names: list[str] = []
        self._file: TextFile | None = None

    @property
    def state(self) -> tuple[int, list[str]]:
        """Rows and headings so far."""
        return len(self._rows), self._names

    def sync(self) -> None:
        """Flush everything to the disk."""
        if self._file is not None:
            self._file.sync()

    def resume(self, count: int, names: list[str]) -> None:
        """Continue with the first rows and columns of the existing file.

        Raises
        ------
        FileError
            If it has fewer.
        """
        try:
            with open(self.path, encoding="utf-8", newline="") as file:
                table = list(csv.reader(file))
        except OSError as error:
            raise full(error, self.path) from None
        head, rows = (table[0], table[1:]) if table else ([], [])
        if len(rows) < count or head[: len(names)] != headings(names, self._units):
            raise FileError(f"{self.path}: {len(rows)} rows, the checkpoint expects {count}")
        self._names = list(names)
        self._rows = [
            {name: float(text or "nan") for name, text in zip(names, row, strict=False)}
            for row in rows[:count]
        ]
        replace_text(self.path, csv_text(self._rows, self._units))
        self._file = TextFile(self.path, keep=True)

    def add(self, row: dict[str, float]) -> None:
        """Append a row.

        Raises
        ------
        FileError
            If writing fails.
        """
        self._rows.append(row)
        if self._file is None or any(name not in self._names for name in row):
            self.close()
            text = csv_text(self._rows, self._units)
            self._names = list(dict.fromkeys(n for r in self._rows for n in r))
            replace_text(self.path, text)
            self._file = TextFile(self.path, keep=True)
            return
        self._file.append(_values(row, self._names))

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()

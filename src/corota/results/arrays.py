"""Results as arrays and tables of xarray and pandas."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError, ResourceError
from corota.results import variables as vf
from corota.results.averaging import AVERAGING
from corota.results.history import History
from corota.results.reduction import variable_name
from corota.results.table import COMPONENTS, TABLE, TENSORS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.results.source import ResultSource

#: Vectors of frames: name and its components.
VECTORS = {n: tuple(part for part, _ in r.parts) for n, r in TABLE.items() if r.size[0]}
#: Components of stress and strain.
TENSOR = ("11", "22", "33", "12")


def require(module: str, extra: str) -> Any:
    """Import a package of an extra.

    Raises
    ------
    ResourceError
        Tells how to install it.
    """
    try:
        return import_module(module)
    except ImportError:
        raise ResourceError(
            f"this needs {module}, which is not installed: pip install corota[{extra}]"
        ) from None


def to_xarray(
    results: ResultSource, variables: Sequence[str] | None, frames: Sequence[int] | None
) -> Any:
    """Fields at the nodes as a dataset; see :meth:`corota.results.Results.to_xarray`."""
    xarray = require("xarray", "data")
    mesh, units = results.mesh, results.model.unit_system
    chosen = list(range(len(results.frames)) if frames is None else frames)
    names = list(variables) if variables is not None else _every(results)
    data: dict[str, Any] = {}

    def attributes(name: str) -> dict[str, str]:
        unit = units.label(vf.dimension(name))
        found = {"long_name": vf.meaning(name).partition(" [")[0] or name}
        return found | ({"units": unit} if unit else {})

    for name in names:
        if name in VECTORS:
            parts = [_stack(results, part, chosen) for part in VECTORS[name]]
            dims: tuple[str, ...] = ("frame", "node", "component")
            data[name] = (dims, np.stack(parts, axis=-1), attributes(name))
        elif name in TENSORS:
            parts = [_stack(results, name + part, chosen) for part in TENSOR]
            data[name] = (("frame", "node", "tensor"), np.stack(parts, axis=-1), attributes(name))
        else:
            name = variable_name(results, name)
            data[name] = (("frame", "node"), _stack(results, name, chosen), attributes(name))
    states = [results.frame(i) for i in chosen]
    coordinates: dict[str, Any] = {
        "frame": chosen,
        "time": ("frame", [f.time for f in states], attributes("time")),
        "load_factor": ("frame", [f.factor for f in states]),
        "step": ("frame", [f.step for f in states]),
        "increment": ("frame", [f.increment for f in states]),
        "node": mesh.node_labels,
        "x": ("node", mesh.points[:, 0], attributes("U1") | {"long_name": "reference x"}),
        "y": ("node", mesh.points[:, 1], attributes("U2") | {"long_name": "reference y"}),
    }
    used = {dim for entry in data.values() for dim in entry[0]}
    if "component" in used:
        coordinates["component"] = ["x", "y"]
    if "tensor" in used:
        coordinates["tensor"] = list(TENSOR)
    head = {"job": results.model.name, "averaging": AVERAGING}
    if units:
        head["units"] = str(units)
    return xarray.Dataset(data, coordinates, head)


def _every(results: ResultSource) -> list[str]:
    """Vectors, then tensors, then scalars, each once."""
    known = list(dict.fromkeys([*results.variables(-1), *results.variables(0)]))
    parts = {part for names in VECTORS.values() for part in names}
    found = [name for name, names in VECTORS.items() if names[0] in known]
    found += [name for name in TENSORS if f"{name}11" in known]
    skip = parts | set(VECTORS) | set(COMPONENTS)
    return found + [name for name in known if name not in skip]


def _stack(results: ResultSource, name: str, frames: Sequence[int]) -> Any:
    rows = []
    for i in frames:
        try:
            rows.append(np.asarray(results.nodal(name, i), dtype=np.float64))
        except InputError:
            if name not in (*results.variables(-1), *results.variables(0)):
                raise
            rows.append(np.full(results.mesh.n_nodes, np.nan))  # as a velocity in a static step
    return np.stack(rows) if rows else np.zeros((0, results.mesh.n_nodes))


def to_dataframe(results: ResultSource, histories: Sequence[History | str]) -> Any:
    """Histories as columns over the total time; see :meth:`Results.to_dataframe`."""
    pandas = require("pandas", "data")
    if not histories:
        names = ["step", "increment", "step time", "load factor"]
        names += list(dict.fromkeys(k for f in results.frames for k in f.scalars))
        histories = names
    found = [h if isinstance(h, History) else results.history(h) for h in histories]
    index = pandas.Index(results.times, name="time")
    table = pandas.DataFrame({h.name: np.asarray(h) for h in found}, index=index)
    units = results.model.unit_system
    if units:
        every = [*table.columns, "time"]
        labels = {name: units.label(vf.dimension(name)) for name in every}
        table.attrs["units"] = {name: label for name, label in labels.items() if label}
    return table

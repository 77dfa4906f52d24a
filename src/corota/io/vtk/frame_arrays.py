"""Arrays of a frame by the names they have in files of VTK."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Floats, Ints, distinct
from corota.io.finite import check
from corota.results import variables as vf
from corota.results.averaging import (
    Averaging,
    cell_mean,
    cell_weights,
    nodes_of_groups,
    section_of_cells,
)
from corota.results.table import CONTACT, HARMONIC, INVARIANTS, TABLE, TENSORS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from corota.model.model import Model
    from corota.results.results import Frame


#: Arrays at nodes that a frame holds in its own attributes.
NODAL_ARRAYS = {row.stored for row in TABLE.values() if row.frame}


def six(tensor: Floats) -> Floats:
    """Rows xx, yy, zz, xy as xx, yy, zz, xy, yz, xz, the order ParaView names itself."""
    return np.concatenate([tensor, np.zeros((*tensor.shape[:-1], 2))], axis=-1)


def point_data(frame: Frame, averaging: Averaging) -> dict[str, Floats]:
    """Arrays at the nodes by the names they have in files."""
    zero = np.zeros(len(frame.U))
    data: dict[str, Floats] = {}
    for row in TABLE.values():
        values = getattr(frame, row.frame) if row.frame else None
        if values is None or row.frame in frame.absent:
            continue
        columns = values.reshape(len(zero), -1)[:, row.first : row.first + len(row.parts)]
        data[row.stored] = np.column_stack([columns, zero]) if row.size[0] else columns[:, 0]
    for pair, values in frame.pairs.items():
        data |= {f"{n}: {pair}": v for n, v in zip(CONTACT, values.T, strict=True)}
    if not frame.fields and frame.averages:
        return data | dict(frame.averages)
    stored = sorted({k for b in frame.fields for k in b.values} - INVARIANTS.keys())
    for name, values in averaging.nodal(frame.fields, stored).items():
        data |= tensor_arrays(name, values) if name in TENSORS else {name: values}
    return data


def nodal_values(at: Mapping[str, Floats], n: int) -> dict[str, Any]:
    """Nodal values of a frame by the names of its attributes, the reverse of :func:`point_data`.

    Parameters
    ----------
    at : mapping of str to ndarray
        Arrays at the nodes of a file.
    n : int
        Number of nodes.
    """
    forces = {"RF": ("reaction", "reaction moment"), "F": ("external force", "external moment")}

    def with_turn(name: str, turn: str) -> Floats:
        """The first two columns, and the third from an array of its own."""
        return np.column_stack([at[name][:, :2], at.get(turn, np.zeros(n))])

    found: dict[str, Any] = {"U": at["displacement"][:, :2], "UR": at["rotation"]}
    for attribute, (name, moment) in forces.items():
        # Not numbers where the file has none.
        found[attribute] = with_turn(name, moment) if name in at else np.full((n, 3), np.nan)
    for attribute, name in (("V", "velocity"), ("A", "acceleration")):
        if name in at:
            found[attribute] = with_turn(name, f"angular {name}")
    if "temperature" in at:
        found["T"] = at["temperature"]
    for attribute, names in (("C", CONTACT), ("H", HARMONIC)):
        if any(name in at for name in names):
            columns = np.column_stack([at.get(name, np.zeros(n)) for name in names])
            # Frames of other procedures have zeros in place of amplitudes.
            if attribute == "C" or columns.any():
                found[attribute] = columns
    head = f"{CONTACT[0]}: "
    pairs = [name.removeprefix(head) for name in at if name.startswith(head)]
    found["pairs"] = {
        pair: np.column_stack([at.get(f"{column}: {pair}", np.zeros(n)) for column in CONTACT])
        for pair in pairs
    }
    found["absent"] = frozenset(key for key, (name, _) in forces.items() if name not in at)
    return found


def tensor_arrays(name: str, values: Floats) -> dict[str, Floats]:
    """Arrays of a tensor, rows xx, yy, zz, xy, and of its invariants."""
    row = TABLE[name]
    data = {row.stored: six(values)}
    for item in row.invariants:
        if item.array not in data:
            data[item.array] = item.function(vf.of_the_tensor(row, values))
    return data


def cell_data(frame: Frame, n_cells: int) -> dict[str, Floats]:
    """Volume averages over the cells, by the names they have in files; rows of all cells."""
    if not frame.fields and frame.cell_averages:
        return dict(frame.cell_averages)
    data: dict[str, Floats] = {"frame rotation": np.zeros(n_cells)}
    for block in frame.fields:
        data["frame rotation"][block.cells] = block.frame_rotation
        weights = cell_weights(block)
        for name in (n for n in block.values if n not in INVARIANTS):
            mean = cell_mean(block, name, weights)
            arrays = {vf.STORED.get(name, name): six(mean) if name in TENSORS else mean}
            if name in TENSORS:
                single = (item for item in TABLE[name].invariants if item.column < 0)
                tensor = vf.of_the_tensor(TABLE[name], mean)
                arrays |= {item.array: item.function(tensor) for item in single}
            for label, values in arrays.items():
                data.setdefault(f"cell {label}", np.zeros((n_cells, *values.shape[1:])))
                data[f"cell {label}"][block.cells] = values
    return data


def scalars(frame: Frame) -> dict[str, Floats]:
    """Number, time and load factor of a frame and its histories, arrays of one value."""
    basic = {
        "step": frame.step,
        "increment": frame.increment,
        "time": frame.time,
        "step time": frame.step_time,
        "load factor": frame.factor,
    }
    return {k: np.array([float(v)]) for k, v in (basic | frame.scalars).items()}


def halved(frame: Frame, arrays: dict[str, Floats]) -> dict[str, Any]:
    """Arrays of 4 bytes a number.

    Raises
    ------
    CorotaError
        If a number is too large for them.
    """
    with np.errstate(over="ignore"):
        found = {name: values.astype(np.float32) for name, values in arrays.items()}
    for name, values in found.items():
        check(frame, f"{name} in single precision", values)
    return found


def nodes_of_sections(model: Model) -> dict[int, Ints]:
    """Nodes of each section group."""
    mesh, of_cells = model.mesh, section_of_cells(model)
    blocks = [
        (of_cells[offset : offset + len(cells)], cells.nodes)
        for offset, cells in zip(mesh.offsets, mesh.cells, strict=False)
        if len(cells)
    ]
    group, node, _ = nodes_of_groups([g for g, _ in blocks], [k for _, k in blocks], mesh.n_nodes)
    bounds = {g: np.searchsorted(group, [g, g + 1]) for g in distinct(group).tolist()}
    return {g: node[first:last] for g, (first, last) in bounds.items()}

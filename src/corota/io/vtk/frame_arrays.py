"""Arrays of a frame by the names they have in files of VTK."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import distinct
from corota.io.finite import check
from corota.results import variables as vf
from corota.results.averaging import Averaging, cell_mean, cell_weights, section_of_cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.model.model import Model
    from corota.results.results import Frame

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

_REACTION = ("reaction", "reaction moment")
_EXTERNAL = ("external force", "external moment")


def six(tensor: Floats) -> Floats:
    """Rows xx, yy, zz, xy as xx, yy, zz, xy, yz, xz, the order ParaView names itself."""
    return np.concatenate([tensor, np.zeros((*tensor.shape[:-1], 2))], axis=-1)


def point_data(frame: Frame, averaging: Averaging) -> dict[str, Floats]:
    """Arrays at the nodes by the names they have in files."""
    n = len(frame.U)
    data = {
        "displacement": np.column_stack([frame.U, np.zeros(n)]),
        "rotation": frame.UR,
        "reaction": np.column_stack([frame.RF[:, :2], np.zeros(n)]),
        "reaction moment": frame.RF[:, 2],
        "external force": np.column_stack([frame.F[:, :2], np.zeros(n)]),
        "external moment": frame.F[:, 2],
    }
    for attribute, names in (("RF", _REACTION), ("F", _EXTERNAL)):
        if attribute in frame.absent:
            data = {name: values for name, values in data.items() if name not in names}
    for title, moving in (("velocity", frame.V), ("acceleration", frame.A)):
        if moving is not None:
            data[title] = np.column_stack([moving[:, :2], np.zeros(n)])
            data[f"angular {title}"] = moving[:, 2]
    if frame.C is not None:
        data |= dict(zip(vf.CONTACT, frame.C.T, strict=True))
    for pair, values in frame.pairs.items():
        data |= {f"{n}: {pair}": v for n, v in zip(vf.CONTACT, values.T, strict=True)}
    if not frame.fields and frame.averages:
        return data | dict(frame.averages)
    stored = sorted({k for b in frame.fields for k in b.values} - {"MISES"})
    mean = averaging.average(frame.fields, stored)
    if "S" in mean:
        data["stress"] = six(mean["S"])
        data["principal stress"] = vf.principal(mean["S"])
        data["Mises"] = vf.mises(mean["S"])
    if "E" in mean:
        data["strain"] = six(mean["E"])
        data["principal strain"] = vf.principal(mean["E"], 0.5)
    rest = {k: v for k, v in mean.items() if k not in ("S", "E")}
    return data | {k: six(v) if k in vf.TENSORS else v for k, v in rest.items()}


def cell_data(frame: Frame, n_cells: int) -> dict[str, Floats]:
    """Volume averages over the cells, by the names they have in files; rows of all cells."""
    if not frame.fields and frame.cell_averages:
        return dict(frame.cell_averages)
    data: dict[str, Floats] = {"frame rotation": np.zeros(n_cells)}
    for block in frame.fields:
        data["frame rotation"][block.cells] = block.frame_rotation
        weights = cell_weights(block)
        for name in block.values:
            if name == "MISES":
                continue
            mean = cell_mean(block, name, weights)
            label = {"S": "stress", "E": "strain"}.get(name, name)
            if name in vf.TENSORS:
                mean = six(mean)
            data.setdefault(f"cell {label}", np.zeros((n_cells, *mean.shape[1:])))
            data[f"cell {label}"][block.cells] = mean
            if name == "S":
                data.setdefault("cell Mises", np.zeros(n_cells))
                data["cell Mises"][block.cells] = vf.mises(mean[:, :4])
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


def cells_and_nodes(model: Model) -> dict[int, tuple[NDArray[np.bool_], Ints]]:
    """Cells and nodes of each section group of planar elements."""
    mesh, of_cells = model.mesh, section_of_cells(model)
    planar = np.zeros(mesh.n_cells, dtype=bool)
    for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
        planar[offset : offset + len(cells)] = cells.kind.startswith(("tri", "quad"))
    found = {}
    for group in distinct(of_cells[planar]).tolist():
        chosen = (of_cells == group) & planar
        nodes = [
            cells.nodes[chosen[offset : offset + len(cells)]].ravel()
            for offset, cells in zip(mesh.offsets, mesh.cells, strict=False)
        ]
        found[int(group)] = chosen, distinct(np.concatenate(nodes))
    return found


__all__ = ["cell_data", "cells_and_nodes", "halved", "point_data", "scalars", "six"]

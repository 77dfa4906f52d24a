"""``.pvd`` and ``.vtu`` files that Corota wrote, read back."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from corota.arrays import Ints
from corota.errors import FileError
from corota.io.regular_file import read_bytes
from corota.io.vtk.frame_arrays import NODAL_ARRAYS, nodal_values
from corota.io.vtk.grid import POLY_LINE, grid_cells
from corota.mesh import Mesh
from corota.model.model import Model
from corota.results.results import Frame, Results
from corota.results.table import CONTACT

_TYPES = {"Float64": np.float64, "Float32": np.float32, "Int64": np.int64, "UInt8": np.uint8}


def read_vtk_xml(path: Path) -> Results:
    """Read a ``.pvd`` with its ``.vtu`` files, or one ``.vtu``.

    The files do not contain steps and increments: frames are counted.

    Raises
    ------
    FileError
        If a file is missing, damaged, or not one of Corota's.
    """
    try:
        if path.suffix.lower() == ".vtu":
            pieces = [path]
        else:
            entries = ElementTree.fromstring(read_bytes(path)).findall("Collection/DataSet")
            pieces = [_inside(path.parent, str(entry.get("file"))) for entry in entries]
        read = [_arrays(piece) for piece in pieces]
        if not read:
            raise ValueError("no frames")
        mesh = _mesh(read[0])
        results = _Sectioned(Model(mesh, path.stem), read[0]["section"][: mesh.n_cells])
        # A single file is the end of an analysis, not its start.
        for number, data in enumerate(read, start=int(path.suffix.lower() == ".vtu")):
            results.add(_frame(mesh, data, number))
    except (ElementTree.ParseError, KeyError, ValueError, IndexError) as error:
        raise FileError(f"{path}: damaged, or not written by Corota: {error}") from None
    return results


class _Sectioned(Results):
    """Results whose model has no sections, but numbers of them."""

    def __init__(self, model: Model, sections: Ints) -> None:
        super().__init__(model)
        self._numbers = sections

    def sections(self) -> Ints:
        return self._numbers


def _inside(folder: Path, name: str) -> Path:
    """Path of a file that a collection names, which must be below its folder."""
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise ValueError(f"{name!r} is outside the folder of the file")
    return path


def _arrays(path: Path) -> dict[str, Any]:
    raw = read_bytes(path)
    head, mark, blob = raw.partition(b'<AppendedData encoding="raw">\n_')
    if not mark:
        raise ValueError(f"{path.name} has no appended data")
    found: dict[str, Any] = {}
    for item in ElementTree.fromstring(head + b"</VTKFile>").iter("DataArray"):
        at = int(item.get("offset", ""))
        size = int(np.frombuffer(blob[at : at + 8], np.uint64)[0])
        data = np.frombuffer(blob[at + 8 : at + 8 + size], _TYPES[item.get("type", "")])
        width = int(item.get("NumberOfComponents", "1"))
        found[item.get("Name", "")] = data.reshape(-1, width) if width > 1 else data
    return found


def _mesh(data: dict[str, Any]) -> Mesh:
    types, chain = data["types"], data["connectivity"]
    ends = np.concatenate([[0], data["offsets"]])
    n_cells = int((types != POLY_LINE).sum())
    lines = chain[ends[n_cells] :]
    n_nodes = int(lines.min()) if len(lines) else len(data["Points"])
    cells = grid_cells(types[:n_cells], chain, ends, data["element label"])
    return Mesh(data["Points"][:n_nodes, :2], cells)


def _frame(mesh: Mesh, data: dict[str, Any], number: int) -> Frame:
    n, geometry = mesh.n_nodes, {"Points", "connectivity", "offsets", "types", "TimeValue"}
    still = {"section", "element label"}
    rows = len(data["Points"])
    of_cells = {
        k: np.asarray(v[: mesh.n_cells])
        for k, v in data.items()
        if (k.startswith("cell ") or k == "frame rotation") and k not in still
    }
    names = [k for k in data if k not in geometry | still and k not in of_cells]
    at = {k: np.asarray(data[k][:n]) for k in names if len(data[k]) == rows}
    time = float(np.ravel(data["TimeValue"])[0])
    values = nodal_values(at, n)
    stems = tuple(f"{column}: " for column in CONTACT)
    return Frame(
        1,
        number,
        time,
        time,
        1.0,
        values.pop("U"),
        values.pop("UR"),
        values.pop("RF"),
        values.pop("F"),
        averages={k: v for k, v in at.items() if k not in NODAL_ARRAYS and not k.startswith(stems)},
        cell_averages=of_cells,
        **values,
    )

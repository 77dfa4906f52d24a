"""``.pvd`` and ``.vtu`` files that Corota wrote, read back."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from corota.arrays import Floats, Ints
from corota.errors import FileError
from corota.io.regular_file import read_bytes
from corota.io.vtk.grid import POLY_LINE, VTK_TYPES
from corota.mesh import Cells, Mesh
from corota.mesh.kinds import N_NODES
from corota.model.model import Model
from corota.results.results import Frame, Results
from corota.results.table import CONTACT, TABLE

_TYPES = {"Float64": np.float64, "Float32": np.float32, "Int64": np.int64, "UInt8": np.uint8}
_KINDS = {number: kind for kind, number in VTK_TYPES.items()}
#: Arrays at nodes that a frame holds in its own attributes.
_OWN = {row.stored for row in TABLE.values() if row.frame}

#: Forces that a file may leave out.
_FORCES = {"RF": "reaction", "F": "external force"}


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
    n_nodes = int(chain[: ends[n_cells]].max(initial=-1)) + 1
    lines = chain[ends[n_cells] :]
    n_nodes = int(lines.min()) if len(lines) else len(data["Points"])
    cuts = [0, *(np.flatnonzero(np.diff(types[:n_cells])) + 1).tolist(), n_cells]
    cells = []
    for first, end in pairwise(cuts):
        if first < end:
            kind = _KINDS[int(types[first])]
            nodes = chain[ends[first] : ends[end]].reshape(-1, N_NODES[kind])
            cells.append(Cells(kind, nodes, data["element label"][first:end]))
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
    pairs: dict[str, Floats] = {}
    for name in [k for k in at if k.startswith("CPRESS: ")]:
        pair = name.removeprefix("CPRESS: ")
        pairs[pair] = np.column_stack([at[f"{column}: {pair}"] for column in CONTACT])

    def force(name: str, moment: str) -> Floats:
        if name not in at:
            return np.full((n, 3), np.nan)
        return np.column_stack([at[name][:, :2], at[moment]])

    time = float(np.ravel(data["TimeValue"])[0])
    there = {"V": "velocity", "A": "acceleration"}
    moving: dict[str, Any] = {
        key: force(name, f"angular {name}") for key, name in there.items() if name in at
    }
    if "temperature" in at:
        moving["T"] = at["temperature"]
    for letter in ("C", "H"):  # contact at nodes, amplitudes and phases
        columns = [row.stored for row in TABLE.values() if row.frame == letter]
        if columns[0] in at:
            moving[letter] = np.column_stack([at[name] for name in columns])
    stems = tuple(f"{column}: " for column in CONTACT)
    return Frame(
        1,
        number,
        time,
        time,
        1.0,
        at["displacement"][:, :2],
        at["rotation"],
        force("reaction", "reaction moment"),
        force("external force", "external moment"),
        pairs=pairs,
        averages={k: v for k, v in at.items() if k not in _OWN and not k.startswith(stems)},
        cell_averages=of_cells,
        absent=frozenset(k for k, v in _FORCES.items() if v not in at),
        **moving,
    )

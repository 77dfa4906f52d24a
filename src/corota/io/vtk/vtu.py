"""XML VTK files: one ``.vtu`` per frame and a ``.pvd`` with their names and times.

The fall-back for programs that do not read VTKHDF. Source: VTK file formats, "XML formats",
appended raw data with 64-bit headers.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.atomic_file import replace_text, replaced, sync
from corota.io.finite import check_frame
from corota.io.vtk.frame_arrays import cell_data, point_data
from corota.io.vtk.grid import Grid
from corota.results.averaging import Averaging, section_of_cells

if TYPE_CHECKING:
    from pathlib import Path

    from corota.arrays import Ints
    from corota.model.model import Model
    from corota.model.paths import Modes
    from corota.results.results import Frame, Results


_NAMES = {"float64": "Float64", "int64": "Int64", "uint8": "UInt8"}


def vtu_bytes(
    model: Model, frame: Frame, averaging: Averaging, sections: Ints | None = None
) -> bytes:
    """Bytes of one ``.vtu`` file.

    Parameters
    ----------
    sections : ndarray of int, shape (n_cells,), optional
        Section group of each cell; those of the model by default.
    """
    check_frame(frame)
    grid = Grid(model, sections)
    blobs: list[bytes] = []
    at = 0

    def array(name: str, values: np.ndarray) -> str:
        nonlocal at
        raw = np.ascontiguousarray(values).tobytes()
        width = values.shape[1] if values.ndim == 2 else 1
        tag = (
            f'<DataArray type="{_NAMES[str(values.dtype)]}" Name="{escape(name)}" '
            f'NumberOfComponents="{width}" format="appended" offset="{at}"/>\n'
        )
        blobs.append(np.uint64(len(raw)).tobytes() + raw)
        at += 8 + len(raw)
        return tag

    points = array("Points", grid.points)
    cells = "".join(
        array(n, v)
        for n, v in (
            ("connectivity", grid.chain),
            ("offsets", grid.ends[1:]),
            ("types", grid.types),
        )
    )
    of_nodes = grid.at_points(point_data(frame, averaging), frame)
    at_points = "".join(array(n, v) for n, v in of_nodes.items())
    of_cells = dict(grid.still) | grid.at_cells(cell_data(frame, model.mesh.n_cells))
    at_cells = "".join(array(n, v) for n, v in of_cells.items())
    time = array("TimeValue", np.array([frame.time]))
    head = (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
        'byte_order="LittleEndian" header_type="UInt64">\n<UnstructuredGrid>\n<FieldData>\n'
        + time.replace("NumberOfComponents", 'NumberOfTuples="1" NumberOfComponents')
        + f'</FieldData>\n<Piece NumberOfPoints="{len(grid.points)}" '
        f'NumberOfCells="{len(grid.types)}">\n'
        f"<Points>\n{points}</Points>\n<Cells>\n{cells}</Cells>\n"
        f"<PointData>\n{at_points}</PointData>\n<CellData>\n{at_cells}</CellData>\n"
        '</Piece>\n</UnstructuredGrid>\n<AppendedData encoding="raw">\n_'
    )
    return head.encode() + b"".join(blobs) + b"\n</AppendedData>\n</VTKFile>\n"


def write_vtu(results: Results, path: Path) -> None:
    """Write the last frame as one ``.vtu`` file."""
    data = vtu_bytes(results.model, results.frame(), results.averaging, results.sections())
    with replaced(path) as hidden:
        hidden.write_bytes(data)


class PvdWriter:
    """A ``.vtu`` for each frame beside a ``.pvd`` that is rewritten after each.

    Parameters
    ----------
    path : Path
        The ``.pvd``; its stem names the others.
    """

    def __init__(
        self,
        path: Path,
        model: Model,
        resume: dict[str, Any] | None = None,
        sections: Ints | None = None,
    ) -> None:
        self.path, self.model, self._sections = path, model, sections
        groups = section_of_cells(model) if sections is None else sections
        self._averaging = Averaging(model.mesh, groups)
        self._entries: list[str] = [] if resume is None else list(resume["entries"])

    @property
    def state(self) -> dict[str, Any]:
        """Frames so far."""
        return {"entries": list(self._entries)}

    def add_modes(self, modes: Modes) -> None:
        """Do nothing: modes have a separate file."""

    def sync(self) -> None:
        """Flush the frames to the disk."""
        for name in [self.path, *self.path.parent.glob(f"{self.path.stem}_????.vtu")][-2:]:
            if name.exists():
                sync(name)

    def add(self, frame: Frame) -> None:
        """Write a frame.

        Raises
        ------
        FileError
            If writing fails.
        """
        piece = self.path.with_name(f"{self.path.stem}_{len(self._entries):04d}.vtu")
        with replaced(piece) as hidden:
            hidden.write_bytes(vtu_bytes(self.model, frame, self._averaging, self._sections))
        self._entries.append(f'<DataSet timestep="{frame.time!r}" file="{escape(piece.name)}"/>\n')
        body = "".join(self._entries)
        replace_text(
            self.path,
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n<Collection>\n'
            f"{body}</Collection>\n</VTKFile>\n",
        )

    def commit(self) -> None:
        """Do nothing: every frame is already on disk."""

    def close(self, info: dict[str, Any] | None = None) -> None:
        """Nothing is open."""


def write_pvd(results: Results, path: Path) -> None:
    """Write all frames."""
    writer = PvdWriter(path, results.model, sections=results.sections())
    for frame in results.frames:
        writer.add(frame)

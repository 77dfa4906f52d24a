"""Temporal VTKHDF unstructured grid: one file that ParaView and PyVista open.

Source: VTK file formats, "VTKHDF file format", version 2.0 (UnstructuredGrid, ``Steps``).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.parallel.partition import process_of_cells
from corota.errors import CorotaError, FileError
from corota.io.atomic_file import AtomicFile
from corota.io.contacts import store_contacts
from corota.io.datasets import Series, make_group, store
from corota.io.description import store_description
from corota.io.file_options import FileOptions, wanted
from corota.io.finite import check_frame
from corota.io.vtk.frame_arrays import cell_data, halved, nodes_of_sections, point_data, scalars
from corota.io.vtk.grid import Grid
from corota.lazy import lazy
from corota.results import variables as vf
from corota.results.averaging import AVERAGING, Averaging, section_of_cells
from corota.results.extremes import rows_of
from corota.results.scalars import where_missing
from corota.results.table import INVARIANTS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from corota.arrays import Floats, Ints
    from corota.model.model import Model
    from corota.model.paths import Modes
    from corota.model.steps import Step
    from corota.results.results import Frame, PointFields


fletcher32 = lazy("corota.io.checksum:fletcher32")
packed = lazy("corota.io.vtk.packing:packed")

#: Bytes of one array of a frame up to which several frames share a chunk, uncompressed.
SMALL = 4096
#: Bytes of a chunk, at most; up to here a chunk is one array of one frame.
LARGEST = 1 << 30
#: Chunks of a data set that are found in the cache: the one that is being filled.
SLOTS = 7
#: Versions of the file format: headers with checksums, and no mark in files that are being written.
FORMAT = ("v108", "v108")
#: The array that other programs need to turn components back into the frames of elements.
TURN = "frame rotation"
#: Group of the smallest and largest values at points (:func:`corota.results.extremes.rows_of`).
EXTREMES = "corota/extremes"


def _section(group: int) -> str:
    return f"corota/sections/{group}"


def _is_vtk(place: str) -> bool:
    """Whether VTK reads the arrays of a group, by their offsets."""
    return place.startswith("VTKHDF")


def _offsets(place: str) -> str:
    """Group of the offsets of such arrays."""
    return f"VTKHDF/Steps/{place.removeprefix('VTKHDF/')}Offsets"


def _missing(place: str, name: str) -> float:
    """Fill value of an array that a frame does not have."""
    unknown = place == EXTREMES or (place == "corota/frames" and np.isnan(where_missing(name)))
    return np.nan if unknown else 0.0


class VtkhdfWriter:
    """Writes frames one after the other; the file is complete after each commit.

    Parameters
    ----------
    options : FileOptions, optional
        Fields, their precision and compression, values at quadrature points.
    run : str
        Name of the run, an attribute of the group ``corota``.
    sections : ndarray of int, shape (n_cells,), optional
        Section group of each cell; those of the model by default.
    resume : dict, optional
        Continue the existing file from such a :attr:`state`; later frames are dropped.
    steps : sequence of Step, optional
        Those that are run, for the description of the model and ``fields="requested"``; the
        model's own by default.
    """

    def __init__(
        self,
        path: Path,
        model: Model,
        options: FileOptions | None = None,
        run: str = "",
        resume: dict[str, Any] | None = None,
        sections: Ints | None = None,
        steps: Sequence[Step] | None = None,
    ) -> None:
        import h5py

        self.path, self.model, self.run = path, model, run
        self._options = options or FileOptions()
        self._steps = model.steps if steps is None else steps
        self._chosen = self._options.chosen(self._steps)
        self._twin = AtomicFile(path, keep=resume is not None)
        groups = section_of_cells(model) if sections is None else sections
        self._averaging = Averaging(model.mesh, groups)
        self._sections = nodes_of_sections(model)
        count = self._options.parts
        self._grid = Grid(model, sections, process_of_cells(model, count) if count > 1 else None)
        try:
            # A small chunk cache: every chunk is written once and never read back.
            mode = "w" if resume is None else "r+"
            cache = {"rdcc_nbytes": 1 << 20, "rdcc_nslots": SLOTS}
            self._file = h5py.File(self._twin, mode, libver=FORMAT, **cache)
        except OSError as error:
            raise FileError(f"{path}: cannot write: {error}") from None
        self._taken: list[tuple[float, dict[str, dict[str, Floats]]]] = []
        # Groups and data sets that are open, by place, and place and name: looking one up in the
        # file takes as long as writing a small array.
        self._groups: dict[str, Any] = {}
        self._series: dict[tuple[str, str], Series] = {}
        if resume is not None:
            self._resume(resume)
            return
        self._root = self._file.create_group("VTKHDF", track_order=True)
        self._static()
        self._count = 0
        self._known: dict[tuple[str, str], Floats] = {}

    @property
    def state(self) -> dict[str, Any]:
        """Frames on disk, and names, types and shapes of their arrays."""
        known = [
            [place, name, like.dtype.str, list(like.shape)]
            for (place, name), like in self._known.items()
        ]
        return {"count": self._count, "known": known}

    def add_modes(self, modes: Modes) -> None:
        """Do nothing: modes have a separate file."""

    def sync(self) -> None:
        """Flush the last commit to the disk."""
        self._twin.sync()

    def _resume(self, state: dict[str, Any]) -> None:
        """Drop the frames after a checkpoint.

        Raises
        ------
        FileError
            If there are fewer.
        """
        try:
            self._drop(state)
        except (KeyError, OSError, ValueError) as error:
            raise FileError(f"{self.path}: cannot continue this file: {error}") from None

    def _drop(self, state: dict[str, Any]) -> None:
        self._root = self._file["VTKHDF"]
        self._still = list(self._grid.still)
        self._count = count = int(state["count"])
        if self._root["Steps"].attrs["NSteps"] < count:
            raise ValueError(
                f"{self._root['Steps'].attrs['NSteps']} frames, the checkpoint expects {count}"
            )
        self._known = {
            (place, name): np.broadcast_to(np.zeros(1, dtype), shape)
            for place, name, dtype, shape in state["known"]
        }
        rows = {(p, n.replace("/", "|")): like.shape[0] for (p, n), like in self._known.items()}
        fixed = {"cells", "shape functions", "reference volume", "nodes", *self._still}
        places = ["VTKHDF/PointData", "VTKHDF/CellData", "corota/frames", EXTREMES]
        for parent in ("corota/points", "corota/sections"):
            places += [f"{parent}/{name}" for name in self._file.get(parent, ())]
        for place in places:
            group = self._file[place]
            for name in list(group):
                if (place, name) in rows:
                    group[name].resize(count * rows[place, name], axis=0)
                elif name not in fixed or place in ("VTKHDF/PointData", "corota/frames"):
                    del group[name]
        steps = self._root["Steps"]
        for name in list(steps):
            if name.endswith("DataOffsets"):
                place = f"VTKHDF/{name.removesuffix('Offsets')}"
                for own in list(steps[name]):
                    if (place, own) in rows or own in self._still:
                        steps[name][own].resize(count, axis=0)
                    else:
                        del steps[name][own]
            else:
                steps[name].resize(count, axis=0)
        steps.attrs["NSteps"] = count

    def _static(self) -> None:
        """Write the constant data: topology, labels, sets, metadata."""
        from corota._core import __version__

        mesh, root, grid = self.model.mesh, self._root, self._grid
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        root.attrs["Type"] = np.bytes_("UnstructuredGrid")
        static = {
            "NumberOfPoints": grid.sizes[:, 0],
            "NumberOfCells": grid.sizes[:, 1],
            "NumberOfConnectivityIds": grid.sizes[:, 2],
            "Points": grid.points,
            "Connectivity": grid.chain,
            "Offsets": grid.ends,
            "Types": grid.types,
        }
        for name, values in static.items():
            self._once(root, name, values)
        for name in ("PointData", "CellData", "FieldData", "Steps"):
            self._make_group(f"VTKHDF/{name}")
        self._groups["VTKHDF/Steps"].attrs["NSteps"] = 0
        for name in ("Values", "PartOffsets", "NumberOfParts", "PointOffsets"):
            self._growing("VTKHDF/Steps", name, np.zeros(0, "f8" if name == "Values" else "i8"))
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            self._growing("VTKHDF/Steps", name, np.zeros((0, 1), "i8"))
        for name in ("PointDataOffsets", "CellDataOffsets"):
            self._make_group(f"VTKHDF/Steps/{name}")
        own = self._make_group("corota")
        own.attrs["version"] = __version__
        own.attrs["job"] = self.model.name
        own.attrs["run"] = self.run
        own.attrs["units"] = str(self.model.unit_system)
        own.attrs["averaging"] = AVERAGING
        own.attrs["tensors"] = "order xx yy zz xy yz xz; shear strain is the angle (engineering)"
        store(own, "node labels", mesh.node_labels)
        store(own, "cell labels", mesh.cell_labels)
        for kind in ("node", "cell", "edge"):
            group = self._make_group(f"corota/{kind} sets")
            for name, members in getattr(mesh, f"{kind}_sets").items():
                store(group, name.replace("/", "|"), members)
        store_contacts(self._make_group("corota/contacts"), self.model)
        store_description(own, self.model, self._steps)
        self._make_group("corota/frames")
        self._make_group(EXTREMES)
        self._make_group("corota/points")
        if grid.rows:
            parts = self._make_group("corota/parts")
            for name, values in grid.rows.items():
                self._once(parts, name, values)
        self._make_group("corota/sections")
        self._still = list(grid.still)
        for name, labels in grid.still.items():
            self._once(self._groups["VTKHDF/CellData"], name, labels)
            self._growing("VTKHDF/Steps/CellDataOffsets", name, np.zeros(0, "i8"))

    def _once(self, group: Any, name: str, values: NDArray[Any]) -> None:
        """Write an array that does not change, packed if it is large."""
        store(group, name, values, self._options.compression if values.nbytes >= SMALL else 0)

    def _make_group(self, place: str) -> Any:
        """Create a group; those around it exist."""
        self._groups[place] = made = make_group(self._file, place)
        return made

    def _group(self, place: str) -> Any:
        """An existing group."""
        if place not in self._groups:
            self._groups[place] = self._file[place]
        return self._groups[place]

    def _series_at(self, place: str, name: str) -> Series:
        """An existing series."""
        if (place, name) not in self._series:
            self._series[place, name] = Series.open(self._group(place), name)
        return self._series[place, name]

    def _growing(self, place: str, name: str, rows: NDArray[Any]) -> None:
        """Create a data set with one row per frame."""
        self._series[place, name] = Series.create(
            self._group(place), name, rows.shape, rows.dtype, (64, *rows.shape[1:]), data=rows
        )

    def add(self, frame: Frame) -> None:
        """Take a frame; :meth:`commit` writes all taken frames to the disk.

        Raises
        ------
        CorotaError
            If a number is not finite; the file stays without the frame.
        """
        check_frame(frame)
        mesh, chosen = self.model.mesh, self._chosen
        at_nodes = point_data(frame, self._averaging)
        of_cells = cell_data(frame, mesh.n_cells)
        grid = self._grid
        data: dict[str, dict[str, Floats]] = {
            "VTKHDF/PointData": grid.at_points(
                {k: v for k, v in at_nodes.items() if wanted(k, chosen)}, frame
            ),
            "VTKHDF/CellData": grid.at_cells(
                {k: v for k, v in of_cells.items() if wanted(k, chosen) or k == TURN}
            ),
        }
        data |= self._of_sections(frame)
        if frame.cells_with and not frame.fields:
            self._blocks_of_file(frame)
        for number, block in enumerate(frame.fields):
            place = self._block(number, block)
            if self._options.points:
                data[place] = {**block.values, "position": block.points}
                if block.forces is not None:
                    data[place][vf.FORCES] = block.forces
        if self._options.single:
            data = {place: halved(frame, arrays) for place, arrays in data.items()}
        data["corota/frames"] = scalars(frame)
        data[EXTREMES] = rows_of(frame)
        self._taken.append((frame.time, data))

    def _of_sections(self, frame: Frame) -> dict[str, dict[str, Floats]]:
        """Averages at nodes within each section, where there are several and no point values.

        They preserve jumps between sections.
        """
        if not frame.fields:
            for group, arrays in frame.section_averages.items():
                self._nodes_of_section(group, np.asarray(arrays["nodes"], dtype=np.int64))
            return {
                _section(group): {k: arrays[k] for k in arrays if k != "nodes"}
                for group, arrays in frame.section_averages.items()
            }
        if self._options.points or len(self._sections) < 2:
            return {}
        names = sorted({k for b in frame.fields for k in b.values} - INVARIANTS.keys())
        names = [name for name in names if wanted(vf.STORED.get(name, name), self._chosen)]
        groups, at, mean = self._averaging.by_group(frame.fields, names)
        found: dict[str, dict[str, Floats]] = {}
        for number, nodes in self._sections.items():
            self._nodes_of_section(number, nodes)
            begin, end = np.searchsorted(groups, [number, number + 1])
            own = found[_section(number)] = {}
            for name, values in mean.items():
                own[name] = np.zeros((len(nodes), *values.shape[1:]))
                own[name][np.searchsorted(nodes, at[begin:end])] = values[begin:end]
        return found

    def _nodes_of_section(self, group: int, nodes: Ints) -> None:
        place = _section(group)
        if place not in self._groups and place not in self._file:
            store(self._make_group(place), "nodes", nodes)

    def _blocks_of_file(self, frame: Frame) -> None:
        """Cells with each variable, for a frame that was read from a file."""
        if len(self._file["corota/points"]):
            return
        names = sorted(frame.cells_with)
        masks = np.stack([frame.cells_with[name] for name in names], axis=1)
        kinds, which = np.unique(masks, axis=0, return_inverse=True)
        for number, kind in enumerate(kinds):
            group = self._make_group(f"corota/points/{number}")
            group.attrs["element"] = ""
            group.attrs["variables"] = " ".join(
                n for n, has in zip(names, kind, strict=True) if has
            )
            store(group, "cells", np.flatnonzero(which.ravel() == number))
            store(group, "shape functions", np.zeros((0, 0)))

    def _block(self, number: int, block: PointFields) -> str:
        """Group of a block of points, made at its first frame."""
        name = f"corota/points/{number}"
        if name not in self._groups and name not in self._file:
            group = self._make_group(name)
            group.attrs["element"] = block.element
            group.attrs["variables"] = " ".join(sorted(block.values))
            store(group, "cells", block.cells)
            store(group, "shape functions", block.shape)
            if self._options.points:
                store(group, "reference volume", block.volume)
        return name

    def _store(self) -> None:
        """Write the taken frames, each array of all of them at once."""
        first, end = self._count, self._count + len(self._taken)
        names: dict[tuple[str, str], Floats] = {}
        for _, data in self._taken:
            for place, arrays in data.items():
                names |= {(place, name): values for name, values in arrays.items()}
        for (place, name), like in names.items():
            rows = [data.get(place, {}).get(name) for _, data in self._taken]
            full = [np.full_like(like, _missing(place, name)) if r is None else r for r in rows]
            self._append(place, name, like, first, full)
        for (place, name), like in self._known.items():
            if (place, name) not in names:
                # An array of an earlier step, such as velocities: zero from here on.
                count, own = len(like), name.replace("/", "|")
                series = self._series_at(place, own)
                series.resize(end * count)
                self._point_at(place, own, count, end, known=True)
                if np.isnan(_missing(place, name)):
                    none = np.full(((end - first) * count, *like.shape[1:]), np.nan)
                    series.write(first * count, none)
        # Shapes only: the numbers are on disk.
        self._known |= {
            key: np.broadcast_to(np.zeros(1, like.dtype), like.shape) for key, like in names.items()
        }
        for name in ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"):
            self._series_at("VTKHDF/Steps", name).resize(end)  # new rows of a data set are 0
        for name in self._still:
            self._series_at("VTKHDF/Steps/CellDataOffsets", name).resize(end)
        for name, values in (
            ("NumberOfParts", np.full(end - first, len(self._grid.sizes))),
            ("Values", np.array([time for time, _ in self._taken])),
        ):
            series = self._series_at("VTKHDF/Steps", name)
            series.resize(end)
            series.write(first, values)
        self._group("VTKHDF/Steps").attrs["NSteps"] = end
        self._count, self._taken = end, []

    def _append(
        self, place: str, name: str, like: Floats, first: int, frames: list[Floats]
    ) -> None:
        """Add frames from number `first` on to an array; frames that it missed are zero."""
        rows, end, own = len(like), first + len(frames), name.replace("/", "|")
        known = (place, name) in self._known
        if known:
            series = self._series_at(place, own)
            series.resize(end * rows)
            self._fill(series, first, frames)
        else:
            self._create(place, own, like, first, frames)
        self._point_at(place, own, rows, end, known)

    def _create(
        self, place: str, name: str, like: Floats, first: int, frames: list[Floats]
    ) -> None:
        """Create the data set of an array with its frames from number `first` on."""
        rows, rest = len(like), like.shape[1:]
        row = like.dtype.itemsize * int(np.prod(rest, dtype=int))
        level = self._options.compression if rows * row >= SMALL else 0
        if rows * row < SMALL:  # several frames a chunk
            size = rows * max(1, SMALL // (rows * row or 1))
        else:
            size = min(rows, max(1, LARGEST // row))
        # Writing while creating is fastest, where HDF5 need not pack.
        at_once = not first and not level
        self._series[place, name] = made = Series.create(
            self._group(place),
            name,
            ((first + len(frames)) * rows, *rest),
            like.dtype,
            # Where a chunk is a whole frame, one for each component: those that are zero take
            # no space and no time, and the digits of others pack better among their own.
            (max(1, size), *((1,) if len(rest) == 1 and size == rows else rest)),
            level=level,
            fill=_missing(place, name),
            data=np.concatenate(frames) if at_once else None,
        )
        if not at_once:
            self._fill(made, first, frames)
        unit = self.model.unit_system.label(vf.dimension_of_array(name))
        if unit:
            self._group(place)[name].attrs["units"] = unit

    def _point_at(self, place: str, name: str, rows: int, end: int, known: bool) -> None:
        """Extend the rows at which the frames of an array begin, where the format has them."""
        if not _is_vtk(place):
            return
        if not known:
            self._growing(_offsets(place), name, np.arange(end) * rows)
            return
        offsets = self._series_at(_offsets(place), name)
        first = offsets.rows
        offsets.resize(end)
        offsets.write(first, np.arange(first, end) * rows)

    def _fill(self, series: Series, first: int, frames: list[Floats]) -> None:
        """Put frames into a series from frame number ``first`` on."""
        rows = len(frames[0])
        if not series.level or series.chunks[0] != rows:
            series.write(first * rows, np.concatenate(frames))
            return
        # Chunks are whole frames, compressed here because HDF5 would block the interpreter.
        flat = series.chunks[1:] == (1,)
        for number, values in enumerate(frames, first):
            parts = list(values.T) if flat else [values]
            for column, part in enumerate(parts):
                if not part.any() and not np.isnan(series.fill):
                    continue  # rows that are not written are 0
                data = np.ascontiguousarray(part, series.dtype)
                planes = data.view(np.uint8).reshape(-1, data.itemsize).T
                chunk = packed([plane.tobytes() for plane in planes], self._options.compression)
                chunk += fletcher32(chunk).to_bytes(4, "little")
                place = (column,) if flat else (0,) * (data.ndim - 1)
                series.write_chunk((number * rows, *place), chunk)

    def commit(self) -> None:
        """Make all frames so far visible on disk, at once or not at all.

        Raises
        ------
        FileError
            If writing fails; the frames of the commit before stay readable.
        """
        if self._taken:
            self._store()
        self._file.flush()
        self._twin.commit()

    def close(self, info: dict[str, Any] | None = None) -> None:
        """Add the counts and phase times of the run, commit and close."""
        try:
            if self._taken:
                self._store()
            self._file["corota"].attrs["info"] = json.dumps(info or {}, default=float)
            self._file.close()
            self._twin.commit(last=True)
        except (OSError, ValueError) as error:
            raise CorotaError(f"internal error: {self.path}: {error}") from error
        finally:
            self._twin.close()

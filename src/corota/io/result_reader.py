"""Results read back from a file, frame by frame when asked for."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from corota.errors import FileError, InputError
from corota.io.contacts import contacts_of_results
from corota.io.description import description_of_results
from corota.io.vtk.vtkhdf import VTK_TYPES
from corota.mesh import Cells, Mesh
from corota.mesh.data import N_NODES
from corota.model.model import Model
from corota.model.units import Units
from corota.results import variables as vf
from corota.results.results import Frame, PointFields, Results

if TYPE_CHECKING:
    from os import PathLike
    from types import TracebackType

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

_KINDS = {number: kind for kind, number in VTK_TYPES.items()}
#: Arrays at nodes that a frame holds in its own attributes.
_NODAL_ARRAYS = {
    "displacement", "rotation", "reaction", "reaction moment", "external force",
    "external moment", "velocity", "angular velocity", "acceleration", "angular acceleration",
    *vf.CONTACT,
}  # fmt: skip
#: Scalars of a frame that are its own attributes.
_OWN = ("step", "increment", "time", "step time", "load factor")


def read_results(path: str | PathLike[str]) -> FileResults:
    """Open a result file that Corota wrote.

    Parameters
    ----------
    path : path-like
        ``<job>.vtkhdf``.

    Returns
    -------
    StoredResults
        Same methods as the results of an analysis; a context manager that closes the file.

    Raises
    ------
    FileError
        If the file cannot be opened or is not such a file.
    """
    import h5py

    name = Path(path)
    if not name.is_file():
        raise FileError(f"{name}: no such file")
    try:
        file = h5py.File(name, "r")
    except OSError:
        raise FileError(f"{name}: not an HDF5 file, or damaged") from None
    try:
        with _damage(name):
            if "corota" not in file or "VTKHDF" not in file:
                raise FileError(f"{name}: an HDF5 file, but not one of Corota's results")
            return FileResults(file)
    except FileError:
        file.close()
        raise


@contextmanager
def _damage(name: str | Path) -> Iterator[None]:
    """Say of whatever HDF5 and the shapes of arrays object to that the file is damaged."""
    try:
        yield
    except (FileError, MemoryError):
        raise
    except Exception as error:
        raise FileError(f"{name}: damaged or incomplete: {error}") from None


def _whole(good: bool, what: str) -> None:
    if not good:
        raise ValueError(what)


class FileFrames(Sequence[Frame]):
    """Frames of a file; each is read when it is asked for, the last one is remembered."""

    def __init__(self, file: Any) -> None:
        self._file = file
        self._count = int(file["VTKHDF/Steps"].attrs["NSteps"])
        self._nodes = len(file["VTKHDF/Points"])
        _whole(self._count >= 0, f"{self._count} frames")
        self._blocks = [file["corota/points"][k] for k in sorted(file["corota/points"], key=int)]
        self._fixed = [
            (str(b.attrs["element"]), b["cells"][:], b["shape functions"][:]) for b in self._blocks
        ]
        types = file["VTKHDF/Types"][:]
        run = np.cumsum(np.diff(types, prepend=types[:1]) != 0)
        for _, cells, _ in self._fixed:
            inside = len(cells) and cells.min() >= 0 and cells.max() < len(types)
            _whole(bool(inside) and len(set(run[cells].tolist())) == 1, "elements of a block")
        self._last: tuple[int, Frame] | None = None

    def __len__(self) -> int:
        return self._count

    def clear(self) -> None:
        """Forget the frame that is remembered."""
        self._last = None

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(self._count))]
        number = range(self._count)[index]
        if self._last is None or self._last[0] != number:
            with _damage(self._file.filename):
                self._last = (number, self._read(number))
        return self._last[1]

    def scalars(self, name: str) -> Floats:
        """A scalar of all frames."""
        with _damage(self._file.filename):
            values = np.asarray(self._file["corota/frames"][name][:], np.float64)
            _whole(len(values) == self._count, f"{name} of {len(values)} frames")
            return values

    def point_names(self) -> list[str]:
        """Names of the arrays at the nodes."""
        return list(self._file["VTKHDF/PointData"])

    def head(self, number: int) -> dict[str, float]:
        """Scalars of a frame, its step, increment and time among them; without its arrays."""
        with _damage(self._file.filename):
            group = self._file["corota/frames"]
            return {name: float(group[name][number]) for name in group}

    def at_points(self, name: str, number: int) -> Floats:
        """An array of ``PointData`` in a frame."""
        with _damage(self._file.filename):
            data = self._file["VTKHDF/PointData"][name]
            rows = len(data) // self._count
            _whole(rows == self._nodes and data.dtype.kind == "f", f"{name} at {rows} nodes")
            return np.asarray(data[number * rows : (number + 1) * rows])

    def _read(self, number: int) -> Frame:
        group = self._file["corota/frames"]
        found = {name: float(group[name][number]) for name in group}
        scalars = {name: value for name, value in found.items() if not np.isnan(value)}
        force, outer = (self.at_points(n, number) for n in ("reaction", "external force"))
        moment, turn = (self.at_points(n, number) for n in ("reaction moment", "external moment"))
        moving = {}
        for attribute, name in (("V", "velocity"), ("A", "acceleration")):
            if name in self._file["VTKHDF/PointData"]:
                at = self.at_points(name, number)
                at[:, 2] = self.at_points(f"angular {name}", number)
                moving[attribute] = at
        if vf.CONTACT[0] in self._file["VTKHDF/PointData"]:
            columns = [self.at_points(name, number) for name in vf.CONTACT]
            moving["C"] = np.column_stack(columns)
        fields = [self._fields(block, number) for block in range(len(self._blocks))]
        return Frame(
            int(scalars["step"]),
            int(scalars["increment"]),
            scalars["time"],
            scalars["step time"],
            scalars["load factor"],
            self.at_points("displacement", number)[:, :2],
            self.at_points("rotation", number),
            np.column_stack([force[:, :2], moment]),
            np.column_stack([outer[:, :2], turn]),
            fields,
            {k: v for k, v in scalars.items() if k not in _OWN},
            **moving,
            pairs=self._pairs(number),
            averages={} if fields else self._averages(number),
        )

    def _pairs(self, number: int) -> dict[str, Floats]:
        """Contact of each pair, where pairs share nodes."""
        head = f"{vf.CONTACT[0]}: "
        names = [n.removeprefix(head) for n in self._file["VTKHDF/PointData"] if n.startswith(head)]
        return {
            pair.replace("|", "/"): np.column_stack(
                [self.at_points(f"{column}: {pair}", number) for column in vf.CONTACT]
            )
            for pair in names
        }

    def _averages(self, number: int) -> dict[str, Floats]:
        """What the file holds at nodes of values whose points it does not hold."""
        of_pairs = tuple(f"{column}: " for column in vf.CONTACT)
        return {
            name: self.at_points(name, number)
            for name in self._file["VTKHDF/PointData"]
            if name not in _NODAL_ARRAYS and not name.startswith(of_pairs)
        }

    def _fields(self, block: int, number: int) -> PointFields:
        group = self._blocks[block]
        element, cells, shape = self._fixed[block]
        n = len(cells)
        values = {
            name: data[number * n : (number + 1) * n]
            for name, data in group.items()
            if name not in ("cells", "shape functions", "reference volume", "position")
        }
        points = len(shape)
        for name, part in values.items():
            _whole(part.shape[:2] == (n, points) and part.dtype.kind == "f", f"{name} at points")
        position = group["position"][number * n : (number + 1) * n]
        turns = self._file["VTKHDF/CellData/frame rotation"]
        rows = len(turns) // self._count
        rotation = turns[number * rows : (number + 1) * rows][np.minimum(cells, rows - 1)]
        return PointFields(
            element, cells, position, shape, rotation, group["reference volume"][:], values
        )


class FileResults(Results):
    """Results in a file, with the methods of :class:`~corota.results.Results`.

    Parameters
    ----------
    file : h5py.File
        Closed by :meth:`close` or at the end of a ``with`` block.

    Attributes
    ----------
    description : dict
        What :func:`corota.model.description.describe` said of the model; empty in old files.
    attributes : dict of str to str
        ``version`` of the program, ``job`` and ``run``.
    path : str
        Name of the file.
    """

    def __init__(self, file: Any) -> None:
        own = file["corota"]
        model = Model(_mesh(file), str(own.attrs["job"]))
        model.contacts = contacts_of_results(own)
        model.unit_system = Units.of(*filter(None, str(own.attrs.get("units", "")).split(", ")))
        info = json.loads(own.attrs["info"]) if "info" in own.attrs else {}
        super().__init__(model, info=info)
        self.description = description_of_results(own)
        names = ("version", "job", "run")
        self.attributes = {n: str(own.attrs[n]) for n in names if n in own.attrs}
        self.path = str(file.filename)
        self._file = file
        self._section = file["VTKHDF/CellData/section"][:]
        self.frames = FileFrames(file)  # type: ignore[assignment]

    def sections(self) -> Ints:
        return np.asarray(self._section)

    def variables(self, index: int = -1) -> list[str]:
        names = super().variables(index)
        if self.frames and not self.frames[index].fields:
            names += [n for n in (*vf.COMPONENTS, *vf.INVARIANTS) if self._has(n)]
        return names

    def _has(self, name: str) -> bool:
        return self._source(name)[0] in self._file["VTKHDF/PointData"]

    def _source(self, name: str) -> tuple[str, int]:
        if name in vf.COMPONENTS:
            tensor, column = vf.COMPONENTS[name]
            return {"S": "stress", "E": "strain"}.get(tensor, tensor), column
        if name == "MISES":
            return "Mises", -1
        tensor, which = vf.INVARIANTS[name]
        return f"principal {'stress' if tensor == 'S' else 'strain'}", int(which) - 1

    def nodal(self, name: str, index: int = -1, section: int | None = None) -> Floats:
        """Values at the nodes; without stored points the averages in the file."""
        frame = self.frame(index)
        if frame.fields:
            return super().nodal(name, index, section)
        name = vf.match_name(name, self.variables(index))
        if name in vf.NODAL:
            return vf.nodal_value(frame, name)
        assert isinstance(self.frames, FileFrames)
        source, column = self._source(name)
        values = self.frames.at_points(source, index % len(self.frames))
        return values if column < 0 else values[:, column]

    def scalar_names(self) -> list[str]:
        """Names of the scalars of the frames."""
        return list(self._file["corota/frames"])

    def history(self, name: str, at: Any = None, combine: Any = "auto") -> Any:
        """One number for each frame; scalars are read without the frames."""
        from corota.results.history import History

        assert isinstance(self.frames, FileFrames)
        if name == "factor":
            name = "load factor"
        if name in self._file["corota/frames"]:
            return History(name, self.frames.scalars(name), self)
        return super().history(name, at, combine)

    @property
    def times(self) -> Floats:
        assert isinstance(self.frames, FileFrames)
        return self.frames.scalars("time")

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> FileResults:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _mesh(file: Any) -> Mesh:
    """Mesh of a file: its cells, labels and sets."""
    root, own = file["VTKHDF"], file["corota"]
    types, chain, offsets = root["Types"][:], root["Connectivity"][:], root["Offsets"][:]
    labels = root["CellData/element label"][:]
    cells: list[Cells] = []
    cuts = [0, *(np.flatnonzero(np.diff(types)) + 1).tolist(), len(types)]
    for first, end in pairwise(cuts):
        if first == end:
            continue
        kind = _KINDS.get(int(types[first]))
        if kind is None:
            raise InputError(f"cell type {types[first]} is not one of Corota's")
        nodes = chain[offsets[first] : offsets[end]].reshape(-1, N_NODES[kind])
        cells.append(Cells(kind, nodes, labels[first:end]))
    points = root["Points"][:, :2]
    _whole(bool(np.isfinite(points).all()), "points that are no numbers")
    for block in cells:
        inside = block.nodes.size and block.nodes.min() >= 0 and block.nodes.max() < len(points)
        _whole(bool(inside), "cells with nodes that are not there")
    mesh = Mesh(points, cells, node_labels=own["node labels"][:])
    for kind in ("node", "cell", "edge"):
        group = own[f"{kind} sets"]
        getattr(mesh, f"{kind}_sets").update({k.replace("|", "/"): v[:] for k, v in group.items()})
    return mesh

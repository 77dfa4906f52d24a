"""Results read back from a file, frame by frame when requested."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from corota.errors import FileError
from corota.io.contacts import contacts_of_results
from corota.io.description import description_of_results
from corota.io.regular_file import parse_json
from corota.io.vtk.frame_arrays import NODAL_ARRAYS, nodal_values
from corota.io.vtk.grid import grid_cells
from corota.io.vtk.parts import whole
from corota.mesh import Mesh
from corota.model.model import Model
from corota.model.units import Units
from corota.results.extremes import places_of
from corota.results.results import Frame, PointFields, Results
from corota.results.scalars import OF_FRAMES, where_missing
from corota.results.table import CONTACT
from corota.results.variables import FORCES, STORED

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

    from numpy.typing import NDArray

    from corota.arrays import Bools, Floats, Ints


#: Arrays of a block of point values that are no variables.
AT_POINTS = ("cells", "shape functions", "reference volume", "position", FORCES)


def read_results(path: str | PathLike[str]) -> Results:
    """Open a result file.

    Parameters
    ----------
    path : path-like
        ``<job>.vtkhdf`` with everything; ``.frd`` of CalculiX or Corota, ``.pvd`` and ``.vtu`` of
        Corota with what is in them.

    Returns
    -------
    Results
        Same methods as the results of an analysis; a context manager that closes the file.

    Raises
    ------
    FileError
        If the file cannot be opened or is not such a file.
    """
    name = Path(path)
    if not name.is_file():
        raise FileError(f"{name}: no such file")
    return RESULT_READERS.get(name.suffix.lower(), read_vtkhdf)(name)


def read_vtkhdf(name: Path) -> FileResults:
    """Open a ``.vtkhdf`` file; see :func:`read_results`."""
    import h5py

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


def _read_frd(name: Path) -> Results:
    from corota.io.frd.reader import read_frd

    return read_frd(name)


def _read_vtk_xml(name: Path) -> Results:
    from corota.io.vtk.vtu_reader import read_vtk_xml

    return read_vtk_xml(name)


#: Ending of the file name to its reader.
RESULT_READERS: dict[str, Callable[[Path], Results]] = {
    ".vtkhdf": read_vtkhdf,
    ".hdf": read_vtkhdf,
    ".frd": _read_frd,
    ".pvd": _read_vtk_xml,
    ".vtu": _read_vtk_xml,
}


@contextmanager
def _damage(name: str | Path) -> Iterator[None]:
    """Report errors of HDF5 and wrong array shapes as a damaged file."""
    try:
        yield
    except (FileError, MemoryError):
        raise
    except Exception as error:
        raise FileError(f"{name}: damaged or incomplete: {error}") from None


def _check_open(file: Any) -> None:
    """Refuse to read an array of a frame that outlived its file."""
    if not file:
        raise FileError("the result file is closed; take what you need of a frame before")


def _whole(good: bool, what: str) -> None:
    if not good:
        raise ValueError(what)


def _finite(name: str, values: NDArray[Any]) -> Floats:
    """Values of a field; runs write only finite numbers."""
    _whole(bool(np.isfinite(values).all()), f"{name} has values that are not finite")
    return np.asarray(values, np.float64)


class Arrays(Mapping[str, "Floats"]):
    """Arrays of a file by name; each is read when it is requested."""

    def __init__(self, names: list[str], read: Callable[[str], Floats]) -> None:
        self._names, self._read = names, read

    def __getitem__(self, name: str) -> Floats:
        if name not in self._names:
            raise KeyError(name)
        return self._read(name)

    def __contains__(self, name: object) -> bool:
        return name in self._names  # as inherited it would read the array

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def _of_section(file: Any, group: Any, number: int, count: int) -> Callable[[str], Floats]:
    """Reads arrays of a section in a frame."""

    def read(name: str) -> Floats:
        with _damage(file.filename):
            data = group[name]
            if name == "nodes":
                return np.asarray(data[:])
            rows = len(group["nodes"])
            _whole(len(data) == rows * count, f"{name} of a section")
            return _finite(name, data[number * rows : (number + 1) * rows])

    return read


def _cells_with(blocks: list[Any], n_cells: int) -> dict[str, Bools]:
    """Cells that have a variable at their points."""
    found: dict[str, Bools] = {}
    for block in blocks:
        for name in str(block.attrs.get("variables", "")).split():
            found.setdefault(name, np.zeros(n_cells, dtype=bool))[block["cells"][:]] = True
    return found


class _Rows:
    """Rows of nodes and of cells in the arrays of a grid, where rigid curves follow.

    Attributes
    ----------
    nodes, cells : slice or ndarray of int
        Row of each node, of those in several parts the first one, and of each cell.
    """

    nodes: slice | Ints
    cells: slice | Ints

    def __init__(self, file: Any) -> None:
        own = file["corota"]
        n_nodes, n_cells = len(own["node labels"]), len(own["cell labels"])
        if "parts" not in own:
            self.nodes, self.cells = slice(n_nodes), slice(n_cells)
            return
        nodes, cells = own["parts/nodes"][:], own["parts/cells"][:]
        self.nodes, self.cells = np.full(n_nodes, -1), np.full(n_cells, -1)
        self.nodes[nodes[::-1]] = np.arange(len(nodes))[::-1]
        self.cells[cells] = np.arange(len(cells))
        _whole(bool((self.nodes >= 0).all() and (self.cells >= 0).all()), "rows of parts")


class FileFrames(Sequence[Frame]):
    """Frames of a file, read on demand; the last one is cached."""

    def __init__(self, file: Any) -> None:
        self._file = file
        self._count = int(file["VTKHDF/Steps"].attrs["NSteps"])
        self._nodes = len(file["corota/node labels"])
        self._cells = len(file["corota/cell labels"])
        _whole(self._count >= 0, f"{self._count} frames")
        every = [file["corota/points"][k] for k in sorted(file["corota/points"], key=int)]
        self._blocks = [block for block in every if "reference volume" in block]
        self._sections = {int(k): g for k, g in file.get("corota/sections", {}).items()}
        self._fixed = [
            (str(b.attrs["element"]), b["cells"][:], b["shape functions"][:]) for b in self._blocks
        ]
        self._rows = _Rows(file)
        types = file["VTKHDF/Types"][:][self._rows.cells]
        run = np.cumsum(np.diff(types, prepend=types[:1]) != 0)
        for cells in (block["cells"][:] for block in every):
            inside = len(cells) and cells.min() >= 0 and cells.max() < len(types)
            _whole(bool(inside) and len(set(run[cells].tolist())) == 1, "elements of a block")
        self._cells_with = _cells_with(every, self._cells)
        extremes = file["corota"].get("extremes", {})
        self._places = places_of({k: len(v) // max(self._count, 1) for k, v in extremes.items()})
        self._last: tuple[int, Frame] | None = None

    def __len__(self) -> int:
        return self._count

    def clear(self) -> None:
        """Clear the cached frame."""
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
        _check_open(self._file)
        with _damage(self._file.filename):
            data = self._file["VTKHDF/PointData"][name]
            rows = len(data) // self._count
            _whole(rows >= self._nodes and data.dtype.kind == "f", f"{name} at {rows} nodes")
            return _finite(name, data[number * rows : (number + 1) * rows][self._rows.nodes])

    def at_cells(self, name: str, number: int) -> Floats:
        """An array of ``CellData`` in a frame."""
        with _damage(self._file.filename):
            data = self._file["VTKHDF/CellData"][name]
            rows = len(data) // self._count
            good = rows >= self._cells and data.dtype.kind == "f"
            _whole(good, f"{name} of {rows} elements")
            return _finite(name, data[number * rows : (number + 1) * rows][self._rows.cells])

    def _read(self, number: int) -> Frame:
        group = self._file["corota/frames"]
        found = {name: float(group[name][number]) for name in group}
        scalars = {name: value for name, value in found.items() if not np.isnan(value)}
        names = self.point_names()
        values = nodal_values(Arrays(names, lambda name: self.at_points(name, number)), self._nodes)
        # Names of arrays have no slash.
        pairs = values.pop("pairs")
        values["pairs"] = {pair.replace("|", "/"): value for pair, value in pairs.items()}
        none = self._without(number)
        fields = [self._fields(block, number, none) for block in range(len(self._blocks))]
        return Frame(
            int(scalars["step"]),
            int(scalars["increment"]),
            scalars["time"],
            scalars["step time"],
            scalars["load factor"],
            values.pop("U"),
            values.pop("UR"),
            values.pop("RF"),
            values.pop("F"),
            fields,
            {k: v for k, v in scalars.items() if k not in OF_FRAMES},
            **values,
            **({} if fields else self._averages(number, none)),
        )

    def _without(self, number: int) -> set[str]:
        """Variables at points that a frame does not have, where frames of other steps do.

        Their arrays are zero there, in ``PointData`` and at points; extremes are not numbers.
        """
        found = set()
        for name, data in self._file["corota"].get("extremes", {}).items():
            if np.isnan(data[number * (len(data) // self._count)]).all():
                found.add(name)
        return found

    def _averages(self, number: int, none: set[str]) -> dict[str, Any]:
        """What the file holds of values whose points it does not hold; read when requested."""
        of_pairs = tuple(f"{column}: " for column in CONTACT)
        absent = {STORED.get(name, name) for name in none}
        at_nodes = [
            name
            for name in self._file["VTKHDF/PointData"]
            if name not in NODAL_ARRAYS | absent and not name.startswith(of_pairs)
        ]
        still = {"section", "element label", *(f"cell {name}" for name in absent)}
        of_cells = [name for name in self._file["VTKHDF/CellData"] if name not in still]
        return {
            "averages": Arrays(at_nodes, lambda name: self.at_points(name, number)),
            "cell_averages": Arrays(of_cells, lambda name: self.at_cells(name, number)),
            "section_averages": {
                section: Arrays(list(group), _of_section(self._file, group, number, self._count))
                for section, group in self._sections.items()
            },
            "cells_with": self._cells_with,
            "extremes": Arrays(list(self._places), lambda name: self._extreme(name, number)),
        }

    def _extreme(self, name: str, number: int) -> Floats:
        """Smallest and largest value of a variable at points, not numbers where it has none."""
        array, row = self._places[name]
        data = self._file["corota/extremes"][array]
        rows = len(data) // max(self._count, 1)
        return np.asarray(data[number * rows + row], np.float64)

    def _fields(self, block: int, number: int, none: set[str]) -> PointFields:
        element, cells, shape = self._fixed[block]
        group, n = self._blocks[block], len(cells)
        names = [name for name in group if name not in AT_POINTS and name not in none]

        def read(name: str) -> Floats:
            _check_open(self._file)
            with _damage(self._file.filename):
                part = np.asarray(group[name][number * n : (number + 1) * n])
                good = name == FORCES or part.shape[:2] == (n, len(shape))
                _whole(good and part.dtype.kind == "f", f"{name} at points")
                return part

        def rotation() -> Floats:
            turns: Floats = self.at_cells("frame rotation", number)[cells]
            return turns

        return FilePoints(element, cells, shape, group, names, read, rotation)


class FilePoints(PointFields):
    """Values at the points of a block in a file; each array is read when it is requested."""

    def __init__(
        self,
        element: str,
        cells: Ints,
        shape: Floats,
        group: Any,
        names: list[str],
        read: Callable[[str], Floats],
        rotation: Callable[[], Floats],
    ) -> None:
        self.element, self.cells, self.shape = element, cells, shape
        self.values = Arrays(names, read)  # type: ignore[assignment]
        self._group, self._read, self._rotation = group, read, rotation

    @cached_property
    def points(self) -> Floats:  # type: ignore[override]
        return self._read("position")

    @cached_property
    def volume(self) -> Floats:  # type: ignore[override]
        return np.asarray(self._group["reference volume"][:])

    @cached_property
    def frame_rotation(self) -> Floats:  # type: ignore[override]
        return self._rotation()

    @cached_property
    def forces(self) -> Floats | None:  # type: ignore[override]
        return self._read(FORCES) if FORCES in self._group else None


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
        info = parse_json(own.attrs["info"]) if "info" in own.attrs else {}
        super().__init__(model, info=info)
        self.description = description_of_results(own)
        names = ("version", "job", "run")
        self.attributes = {n: str(own.attrs[n]) for n in names if n in own.attrs}
        self.path = str(file.filename)
        self._file = file
        self._section = file["VTKHDF/CellData/section"][:][_Rows(file).cells]
        self.frames = FileFrames(file)  # type: ignore[assignment]

    __repr__ = Results.__repr__

    def sections(self) -> Ints:
        return np.asarray(self._section)

    def scalar_names(self) -> list[str]:
        return list(self._file["corota/frames"])

    def scalar_values(self, name: str) -> Floats:
        assert isinstance(self.frames, FileFrames)
        if name not in self._file["corota/frames"]:
            return np.full(len(self.frames), where_missing(name))
        return self.frames.scalars(name)

    def __enter__(self) -> FileResults:
        return self

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _mesh(file: Any) -> Mesh:
    """Mesh of a file: its cells, labels and sets."""
    root, own = file["VTKHDF"], file["corota"]
    rows = _Rows(file)
    types, chain, offsets = (root[name][:] for name in ("Types", "Connectivity", "Offsets"))
    types = types[rows.cells]
    labels = root["CellData/element label"][:][rows.cells]
    if "parts" in own:
        counts = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")
        sizes = np.column_stack([root[name][:] for name in counts])
        chain, offsets = whole(chain, offsets, sizes, own["parts/nodes"][:], own["parts/cells"][:])
    cells = grid_cells(types, chain, offsets, labels)
    points = root["Points"][:][rows.nodes, :2]
    _whole(bool(np.isfinite(points).all()), "coordinates that are not numbers")
    for block in cells:
        inside = block.nodes.size and block.nodes.min() >= 0 and block.nodes.max() < len(points)
        _whole(bool(inside), "cells refer to missing nodes")
    mesh = Mesh(points, cells, node_labels=own["node labels"][:])
    for kind in ("node", "cell", "edge"):
        group = own[f"{kind} sets"]
        getattr(mesh, f"{kind}_sets").update({k.replace("|", "/"): v[:] for k, v in group.items()})
    return mesh

"""Temporal VTKHDF unstructured grid: one file that ParaView and PyVista open.

Source: VTK file formats, "VTKHDF file format", version 2.0 (UnstructuredGrid, ``Steps``).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import CorotaError, FileError
from corota.io.atomic_file import AtomicFile
from corota.io.contacts import store_contacts
from corota.io.description import store_description
from corota.io.finite import check_frame
from corota.results import variables as vf

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.results import Frame, PointFields

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]

#: VTK cell types of our kinds; node orders agree.
VTK_TYPES = {
    "tri3": 5,
    "tri6": 22,
    "quad4": 9,
    "quad8": 23,
    "quad9": 28,
    "line2": 3,
    "line3": 21,
    "point1": 1,
}
#: Bytes of a frame's data of one name held in one chunk, at most.
_CHUNK = 4 << 20


def topology(mesh: Mesh) -> tuple[Ints, Ints, NDArray[np.uint8], Ints]:
    """Connectivity, offsets, types and global cell indices of all cells."""
    chain: list[Ints] = []
    sizes: list[Ints] = []
    types: list[NDArray[np.uint8]] = []
    index: list[Ints] = []
    for offset, cells in zip(mesh.offsets, mesh.cells, strict=False):
        if not len(cells):
            continue
        chain.append(cells.nodes.ravel())
        sizes.append(np.full(len(cells), cells.nodes.shape[1], np.int64))
        types.append(np.full(len(cells), VTK_TYPES[cells.kind], np.uint8))
        index.append(np.arange(len(cells), dtype=np.int64) + offset)
    if not chain:
        return *(np.zeros(0, np.int64),) * 2, np.zeros(0, np.uint8), np.zeros(0, np.int64)
    ends = np.concatenate([[0], np.cumsum(np.concatenate(sizes))])
    return np.concatenate(chain), ends, np.concatenate(types), np.concatenate(index)


def six(tensor: Floats) -> Floats:
    """Rows xx, yy, zz, xy as xx, yy, zz, xy, yz, xz, the order ParaView names itself."""
    return np.concatenate([tensor, np.zeros((*tensor.shape[:-1], 2))], axis=-1)


def point_data(frame: Frame, averaging: vf.Averaging) -> dict[str, Floats]:
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
    for name, moving in (("velocity", frame.V), ("acceleration", frame.A)):
        if moving is not None:
            data[name] = np.column_stack([moving[:, :2], np.zeros(n)])
            data[f"angular {name}"] = moving[:, 2]
    if frame.C is not None:
        data |= dict(zip(vf.CONTACT, frame.C.T, strict=True))
    for pair, values in frame.pairs.items():
        data |= {f"{n}: {pair}": v for n, v in zip(vf.CONTACT, values.T, strict=True)}
    if not frame.fields and frame.averages:
        return data | frame.averages
    names = sorted({k for b in frame.fields for k in b.values})
    mean = averaging.average(frame.fields, [k for k in names if k != "MISES"])
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
    data: dict[str, Floats] = {"frame rotation": np.zeros(n_cells)}
    for block in frame.fields:
        data["frame rotation"][block.cells] = block.frame_rotation
        for name in block.values:
            if name == "MISES":
                continue
            mean = vf.cell_mean(block, name)
            label = {"S": "stress", "E": "strain"}.get(name, name)
            if name in vf.TENSORS:
                mean = six(mean)
            data.setdefault(f"cell {label}", np.zeros((n_cells, *mean.shape[1:])))
            data[f"cell {label}"][block.cells] = mean
            if name == "S":
                data.setdefault("cell Mises", np.zeros(n_cells))
                data["cell Mises"][block.cells] = vf.mises(mean[:, :4])
    return data


def _scalars(frame: Frame) -> dict[str, Floats]:
    basic = {
        "step": frame.step,
        "increment": frame.increment,
        "time": frame.time,
        "step time": frame.step_time,
        "load factor": frame.factor,
    }
    return {k: np.array([float(v)]) for k, v in (basic | frame.scalars).items()}


def _missing(place: str, name: str) -> float:
    """What stands where a frame lacks an array."""
    return np.nan if place == "corota/frames" and name in vf.UNKNOWN else 0.0


class VtkhdfWriter:
    """Writes frames one after the other; the file is complete after each commit.

    Parameters
    ----------
    path : Path
    model : Model
    points : bool
        Store the values at the quadrature points too (group ``corota/points``).
    run : str
        Name of the run, an attribute of the group ``corota``.
    resume : dict, optional
        Go on with the file that is there from such a :attr:`state`; what is behind is dropped.
    steps : sequence of Step, optional
        Those that are run, for the description of the model; the model's own by default.
    """

    def __init__(
        self,
        path: Path,
        model: Model,
        points: bool = True,
        run: str = "",
        resume: dict[str, Any] | None = None,
        steps: Sequence[Step] = (),
    ) -> None:
        import h5py

        self._steps = steps
        self.path, self.model, self.points, self.run = path, model, points, run
        self._twin = AtomicFile(path, keep=resume is not None)
        self._averaging = vf.Averaging(model.mesh)
        try:
            # A small chunk cache: every chunk is written once and never read back.
            mode = "w" if resume is None else "r+"
            self._file = h5py.File(self._twin, mode, rdcc_nbytes=1 << 20)
        except OSError as error:
            raise FileError(f"{path}: cannot write: {error}") from None
        self._taken: list[tuple[float, dict[str, dict[str, Floats]]]] = []
        if resume is not None:
            self._resume(resume)
            return
        self._root = self._file.create_group("VTKHDF", track_order=True)
        self._index = self._static()
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

    def sync(self) -> None:
        """Bring the last commit to the disk."""
        self._twin.sync()

    def _resume(self, state: dict[str, Any]) -> None:
        """Drop the frames that a checkpoint does not know.

        Raises
        ------
        FileError
            If there are fewer.
        """
        try:
            self._drop(state)
        except (KeyError, OSError, ValueError) as error:
            raise FileError(f"{self.path}: cannot go on with this file: {error}") from None

    def _drop(self, state: dict[str, Any]) -> None:
        self._root = self._file["VTKHDF"]
        self._index = topology(self.model.mesh)[3]
        self._still = ["section", "element label"]
        self._count = count = int(state["count"])
        if self._root["Steps"].attrs["NSteps"] < count:
            raise ValueError(
                f"{self._root['Steps'].attrs['NSteps']} frames, the checkpoint knows {count}"
            )
        self._known = {
            (place, name): np.broadcast_to(np.zeros(1, dtype), shape)
            for place, name, dtype, shape in state["known"]
        }
        rows = {(p, n.replace("/", "|")): like.shape[0] for (p, n), like in self._known.items()}
        points = self._file["corota/points"]
        fixed = {"cells", "shape functions", "reference volume", *self._still}
        places = ["VTKHDF/PointData", "VTKHDF/CellData", "corota/frames"]
        for place in [*places, *(f"corota/points/{name}" for name in points)]:
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

    def _static(self) -> Ints:
        """Write what does not change: topology, labels, sets, metadata."""
        from corota import __version__

        mesh, root = self.model.mesh, self._root
        chain, ends, types, index = topology(mesh)
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        root.attrs["Type"] = np.bytes_("UnstructuredGrid")
        root["NumberOfPoints"] = np.array([mesh.n_nodes])
        root["NumberOfCells"] = np.array([len(index)])
        root["NumberOfConnectivityIds"] = np.array([len(chain)])
        root["Points"] = np.column_stack([mesh.points, np.zeros(mesh.n_nodes)])
        root["Connectivity"], root["Offsets"], root["Types"] = chain, ends, types
        for name in ("PointData", "CellData", "FieldData"):
            root.create_group(name)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = 0
        for name in ("Values", "PartOffsets", "NumberOfParts", "PointOffsets"):
            number = "f8" if name == "Values" else "i8"
            steps.create_dataset(name, (0,), number, maxshape=(None,), chunks=(64,))
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            steps.create_dataset(name, (0, 1), np.int64, maxshape=(None, 1), chunks=(64, 1))
        for name in ("PointDataOffsets", "CellDataOffsets"):
            steps.create_group(name)
        own = self._file.create_group("corota")
        own.attrs["version"] = __version__
        own.attrs["job"] = self.model.name
        own.attrs["run"] = self.run
        own.attrs["units"] = str(self.model.unit_system)
        own.attrs["averaging"] = vf.AVERAGING
        own.attrs["tensors"] = "order xx yy zz xy yz xz; shear strain is the angle (engineering)"
        own["node labels"] = mesh.node_labels
        own["cell labels"] = mesh.cell_labels
        for kind in ("node", "cell", "edge"):
            group = own.create_group(f"{kind} sets")
            for name, members in getattr(mesh, f"{kind}_sets").items():
                group[name.replace("/", "|")] = members
        store_contacts(own.create_group("contacts"), self.model)
        store_description(own, self.model, self._steps)
        own.create_group("frames")
        own.create_group("points")
        group = root["CellData"]
        section = vf.section_of_cells(self.model)[index]
        group["section"] = section
        group["element label"] = mesh.cell_labels[index]
        self._still = ["section", "element label"]
        for name in self._still:
            self._offsets("CellData", name)
        return index

    def add(self, frame: Frame) -> None:
        """Take a frame; :meth:`commit` brings all taken frames to the disk.

        Raises
        ------
        CorotaError
            If a number is not finite; the file stays without the frame.
        """
        check_frame(frame)
        mesh = self.model.mesh
        data: dict[str, dict[str, Floats]] = {
            "VTKHDF/PointData": point_data(frame, self._averaging),
            "VTKHDF/CellData": {
                k: v[self._index] for k, v in cell_data(frame, mesh.n_cells).items()
            },
            "corota/frames": _scalars(frame),
        }
        if self.points:
            for number, block in enumerate(frame.fields):
                data[self._block(number, block)] = block.values | {"position": block.points}
        self._taken.append((frame.time, data))

    def _block(self, number: int, block: PointFields) -> str:
        """Group of a block of points, made at its first frame."""
        name = f"corota/points/{number}"
        if name not in self._file:
            group = self._file.create_group(name)
            group.attrs["element"] = block.element
            group["cells"], group["shape functions"] = block.cells, block.shape
            group["reference volume"] = block.volume
        return name

    def _offsets(self, kind: str, name: str) -> Any:
        group = self._root["Steps"][f"{kind}Offsets"]
        if name not in group:
            group.create_dataset(name, (0,), np.int64, maxshape=(None,), chunks=(64,))
        return group[name]

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
            self._series(place, name, like, end)[first * len(like) :] = np.concatenate(full)
        for (place, name), like in self._known.items():
            if (place, name) not in names:
                # An array of an earlier step, such as velocities: zero from here on.
                self._series(place, name, like, end)
                if np.isnan(_missing(place, name)):
                    self._file[place][name][first:] = np.nan
        # Shapes only: the numbers are on disk.
        self._known |= {
            key: np.broadcast_to(np.zeros(1, like.dtype), like.shape) for key, like in names.items()
        }
        steps = self._root["Steps"]
        for name in ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets"):
            steps[name].resize(end, axis=0)  # what a data set is extended by is 0
        for name in self._still:
            self._offsets("CellData", name).resize(end, axis=0)
        for name, values in (
            ("NumberOfParts", np.ones(end - first, np.int64)),
            ("Values", np.array([time for time, _ in self._taken])),
        ):
            steps[name].resize(end, axis=0)
            steps[name][first:] = values
        steps.attrs["NSteps"] = end
        self._count, self._taken = end, []

    def _series(self, place: str, name: str, like: Floats, end: int) -> Any:
        """Data set of a name, long enough for ``end`` frames; frames it missed are zero."""
        rows, rest = len(like), like.shape[1:]
        group = self._file[place]
        name = name.replace("/", "|")
        if name not in group:
            row = 8 * int(np.prod(rest, dtype=int))
            if rows * row < 4096:  # small: several frames a chunk
                size = rows * max(1, 4096 // (rows * row or 1))
            else:
                size = min(rows, max(1, _CHUNK // row))
            group.create_dataset(
                name,
                (0, *rest),
                like.dtype,
                maxshape=(None, *rest),
                chunks=(max(1, size), *rest),
                fillvalue=_missing(place, name),
            )
        group[name].resize(end * rows, axis=0)
        if place.startswith("VTKHDF"):
            offsets = self._offsets(place.removeprefix("VTKHDF/"), name)
            known = len(offsets)
            offsets.resize(end, axis=0)
            offsets[known:] = np.arange(known, end) * rows
        return group[name]

    def commit(self) -> None:
        """Make all frames so far visible on disk, at once or not at all.

        Raises
        ------
        FileError
            If the disk refuses; the frames of the commit before stay readable.
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
            self._twin.commit()
        except (OSError, ValueError) as error:
            raise CorotaError(f"internal error: {self.path}: {error}") from error
        finally:
            self._twin.close()

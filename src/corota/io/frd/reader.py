"""Results of CalculiX read back: planar meshes, displacements, stress, strain, forces."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from corota.arrays import Floats, Ints, Lookup
from corota.errors import FileError, UnsupportedError
from corota.io.frd.layout import NAMES, NODES
from corota.io.regular_file import read_bytes
from corota.io.vtk.frame_arrays import tensor_arrays
from corota.mesh import Cells, Mesh
from corota.model.model import Model
from corota.results.results import Frame, Results
from corota.results.table import requests
from corota.results.variables import stored_as


class _Source:
    """Bytes of a file with a place to read from."""

    def __init__(self, path: Path) -> None:
        self.data = read_bytes(path)
        self.path, self.at = path, 0

    def line(self) -> str:
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = self.data[self.at : end].decode("utf-8", "replace")
        self.at = end + 1
        return text

    def take(self, kind: Any, count: int) -> Any:
        size = np.dtype(kind).itemsize * count
        if self.at + size > len(self.data):
            raise ValueError("the file ends within a block")
        found = np.frombuffer(self.data, kind, count, self.at)
        self.at += size
        return found

    @property
    def done(self) -> bool:
        return self.at >= len(self.data)


def read_frd(path: str | PathLike[str]) -> Results:
    """Read a ``.frd`` file, text or binary, of CalculiX or of Corota.

    Returns
    -------
    Results
        Nodal values only. ``RF`` is CalculiX's: reaction and load together.

    Raises
    ------
    FileError
        If the file is damaged.
    UnsupportedError
        If its elements are not planar.
    """
    from pathlib import Path

    source = _Source(Path(path))
    if b"    2C" not in source.data[:100000] and b"    1C" not in source.data[:10]:
        raise FileError(f"{path}: not a .frd file")
    try:
        return _Reader(source).read()
    except UnsupportedError:
        raise
    except (ValueError, IndexError, KeyError) as error:
        raise FileError(f"{path}: damaged or incomplete: {error}") from None


#: Types of analysis that give modes, and the meaning of their number.
MODES = {2: "frequency", 3: "frequency", 4: "buckling factor"}


class _Reader:
    def __init__(self, source: _Source) -> None:
        self.source = source
        self.frames: dict[tuple[int, int, float, int, int], dict[str, tuple[Ints, Floats]]] = {}

    def read(self) -> Results:
        labels, points = np.zeros(0, np.int64), np.zeros((0, 3))
        elements: list[tuple[int, int, list[int]]] = []
        where = (1, 0)
        while not self.source.done:
            text = self.source.line()
            if text.startswith("    2C"):
                labels, points = self._nodes(text)
            elif text.startswith("    3C"):
                elements = self._elements(text)
            elif text.startswith("    1PSTEP"):
                numbers = [int(part) for part in text[10:].split()]
                where = (numbers[2] if len(numbers) > 2 else 1, numbers[1])
            elif text.startswith("  100C"):
                self._block(text, where)
            elif text.strip() == "9999":
                break
        return self._results(labels, points, elements)

    def _nodes(self, head: str) -> tuple[Ints, Floats]:
        count, how = int(head[24:36]), int(head[-1:])
        if how in (2, 3):
            kind = "<f4" if how == 2 else "<f8"
            table = self.source.take([("label", "<i4"), ("v", kind, (3,))], count)
            return table["label"].astype(np.int64), table["v"].astype(np.float64)
        return self._rows(3)

    def _rows(self, width: int) -> tuple[Ints, Floats]:
        """Lines ``-1 label values`` up to ``-3``; fields have fixed widths."""
        labels: list[int] = []
        values: list[list[float]] = []
        while not self.source.done:
            text = self.source.line()
            if text.startswith(" -3"):
                break
            fields = [text[i : i + 12] for i in range(13, len(text.rstrip()), 12)]
            if text.startswith(" -2"):  # more components of the same node
                values[-1] += [float(field) for field in fields]
                continue
            labels.append(int(text[3:13]))
            values.append([float(field) for field in fields])
        else:
            raise ValueError("the file ends within a block")
        table = np.array(values).reshape(len(labels), -1)
        return np.array(labels, dtype=np.int64), table[:, :width]

    def _elements(self, head: str) -> list[tuple[int, int, list[int]]]:
        count, how = int(head[24:36]), int(head[-1:])
        found: list[tuple[int, int, list[int]]] = []
        if how == 2:
            for _ in range(count):
                label, kind, _, _ = self.source.take("<i4", 4).tolist()
                found.append((label, kind, self.source.take("<i4", NODES[kind]).tolist()))
            return found
        while not self.source.done:
            text = self.source.line()
            if text.startswith(" -3"):
                break
            if text.startswith(" -1"):
                found.append((int(text[3:13]), int(text[13:18]), []))
            elif text.startswith(" -2"):
                found[-1][2].extend(int(text[i : i + 10]) for i in range(3, len(text.rstrip()), 10))
        return found

    def _block(self, head: str, where: tuple[int, int]) -> None:
        time, count, how = float(head[12:24]), int(head[24:36]), int(head[-1:])
        text = self.source.line()
        name, components = text[5:13].strip(), int(text[13:18])
        stored = 0
        for _ in range(components):
            part = self.source.line()
            stored += len(part) < 36 or part[33:38].strip() != "1"
        if how == 2:
            table = self.source.take([("label", "<i4"), ("v", "<f4", (stored,))], count)
            data = table["label"].astype(np.int64), table["v"].astype(np.float64)
        else:
            data = self._rows(stored)
        # Modes may have the same frequency: the number of the set distinguishes them.
        kind, number = int(head[56:58] or 0), int(head[58:63] or 0)
        self.frames.setdefault((*where, time, kind, number), {})[name] = data

    def _results(
        self, labels: Ints, points: Floats, elements: list[tuple[int, int, list[int]]]
    ) -> Results:
        flat = np.abs(points[:, 2]).max(initial=0.0) == 0.0
        if not flat or any(kind not in NAMES for _, kind, _ in elements):
            raise UnsupportedError(
                f"{self.source.path}: not a planar mesh; CalculiX writes one with OUTPUT=2D on "
                "*NODE FILE"
            )
        rows = Lookup(labels)

        def index(nodes: Any) -> Ints:
            at = rows(nodes)
            if (at < 0).any():
                raise ValueError("elements refer to missing nodes")
            return at

        cells = []
        for kind in dict.fromkeys(k for _, k, _ in elements):
            own = [(label, nodes) for label, k, nodes in elements if k == kind]
            table = index(np.array([nodes for _, nodes in own]))
            cells.append(Cells(NAMES[kind], table, np.array([label for label, _ in own])))
        mesh = Mesh(points[:, :2], cells, node_labels=labels)
        results = Results(Model(mesh, self.source.path.stem))
        results.notes.append("RF of a .frd file holds reactions and loads together")
        n = mesh.n_nodes
        for (step, increment, time, kind, _), data in self.frames.items():

            def at_nodes(name: str, data: Any = data) -> Floats | None:
                if name not in data:
                    return None
                own, values = data[name]
                out = np.zeros((n, values.shape[1]))
                out[index(own)] = values
                return out

            frame = _frame(step, increment, time, n, at_nodes)
            if kind in MODES:
                mode = 1 + sum("mode" in f.scalars and f.step == step for f in results.frames)
                frame.scalars |= {MODES[kind]: time, "mode": float(mode)}
            results.add(frame)
        return results


def _frame(step: int, increment: int, time: float, n: int, at_nodes: Any) -> Frame:
    shift, force, speed = (at_nodes(name) for name in ("DISP", "FORC", "VELO"))
    averages: dict[str, Floats] = {}
    for name, row in requests().items():
        values = at_nodes(row.block) if row.block and not row.frame else None
        if values is not None and row.tensor:
            averages |= tensor_arrays(name, values[:, :4] / [1.0, 1.0, 1.0, row.shear])
        elif values is not None and stored_as(name)[0] not in averages:
            averages[name] = values[:, 0]
    heat = at_nodes("NDTEMP")
    contact, traction = at_nodes("CONTACT"), None
    if contact is not None:
        gap, slip, _, pressure, shear, _ = contact.T
        status = np.where(pressure > 0.0, 1.0, 0.0)
        traction = np.column_stack([pressure, shear, gap, slip, status])
    nothing = np.full((n, 3), np.nan)
    return Frame(
        step,
        increment,
        time,
        time,
        1.0,
        nothing[:, :2] if shift is None else shift[:, :2],
        np.zeros(n),
        nothing if force is None else np.column_stack([force[:, :2], np.zeros(n)]),
        nothing,
        V=None if speed is None else np.column_stack([speed[:, :2], np.zeros(n)]),
        C=traction,
        T=None if heat is None else heat[:, 0],
        averages=averages,
        absent=frozenset(
            name for name, values in (("U", shift), ("RF", force), ("F", None)) if values is None
        ),
    )

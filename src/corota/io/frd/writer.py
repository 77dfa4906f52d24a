"""Results as CalculiX writes them: text, or numbers in binary."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.atomic_file import TextFile
from corota.io.file_options import FileOptions
from corota.io.finite import check_frame
from corota.io.frd.layout import (
    CONTACT,
    DISP,
    ELEMENTS,
    FORC,
    NDTEMP,
    PDISP,
    STRESS,
    SURFACES,
    TOSTRAIN,
    VELO,
    blocks,
)
from corota.io.requests import Requests
from corota.io.tables.dat import internal_force
from corota.io.vtk.frame_arrays import point_data
from corota.model.contact import edges_or_nodes
from corota.results.averaging import Averaging, section_of_cells
from corota.results.rigid import moved, rigid_curves, rigid_lines
from corota.results.table import INVARIANTS
from corota.results.variables import averaged_value, stored_as

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from corota.arrays import Bools, Floats, Ints
    from corota.io.frd.layout import Block
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.paths import Modes
    from corota.model.steps import Step
    from corota.results.results import Frame, Results


END = b" 9999\n"
#: Types of analysis of modes; 0 is static and 1 dynamic.
ANALYSIS, COMPLEX = {"frequency": 2, "buckling": 4}, 3
#: Numbers closer to 0 are 0: their exponents have three digits.
TINY = 1e-99


@dataclass(frozen=True)
class _Head:
    """Data of the lines before a block."""

    step: int
    increment: int
    value: float
    kind: int
    mode: int = 0


def _head_of(frame: Frame) -> _Head:
    moving = frame.V is not None and bool(frame.V.any())
    return _Head(frame.step, frame.increment, frame.time, 1 if moving else 0)


class FrdWriter:
    """Writes increments one after the other; the file ends properly after each.

    The initial state is not written, as in CalculiX. Rigid tools are line elements
    with numbers behind all others.

    Parameters
    ----------
    steps : sequence of Step
        Their ``*NODE FILE``, ``*EL FILE`` and ``*CONTACT FILE`` requests choose what is written;
        without any, all are written.
    options : FileOptions, optional
        A list of fields goes before the requests.
    resume : dict, optional
        Continue the existing file from such a :attr:`state`.
    sections : ndarray of int, shape (n_cells,), optional
        Section group of each cell; those of the model by default.
    """

    def __init__(
        self,
        path: Path,
        model: Model,
        steps: Sequence[Step] = (),
        options: FileOptions | None = None,
        binary: bool = False,
        resume: dict[str, Any] | None = None,
        sections: Ints | None = None,
    ) -> None:
        self.path, self._model, self._binary = path, model, binary
        self._requests = Requests(model, steps)
        fields = (options or FileOptions()).fields
        self._fields = None if isinstance(fields, str) else {name.upper() for name in fields}
        groups = section_of_cells(model) if sections is None else sections
        self._averaging = Averaging(model.mesh, groups)
        self._curves = rigid_curves(model)
        lines = [np.concatenate(rigid_lines(curve)) for curve in self._curves]
        self._lines = lines
        labels = model.mesh.node_labels
        first = int(labels.max(initial=0)) + 1
        self._rigid_labels = np.arange(first, first + sum(map(len, lines)), dtype=np.int64)
        self._file = TextFile(path, keep=resume is not None)
        if resume is None:
            self._blocks = self._frames = 0
            self._file.append(self._head() + self._mesh() + END)
        else:
            self._blocks, self._frames = resume["blocks"], resume["frames"]
            self._file.cut(resume["length"])

    @property
    def state(self) -> dict[str, Any]:
        """Length of the file, blocks and frames so far."""
        return {"length": self._file.length, "blocks": self._blocks, "frames": self._frames}

    def _head(self) -> bytes:
        from corota._core import __version__

        model = self._model
        now = time.localtime()
        lines = [f"    1C{model.name[:60]}"]
        entries = [
            ("USER", ""),
            ("DATE", time.strftime("%d.%m.%Y", now)),
            ("TIME", time.strftime("%H:%M:%S", now)),
            ("HOST", ""),
            ("PGM", "Corota"),
            ("VERSION", f"Version {__version__}"),
            ("UNITS", str(model.unit_system)),
            ("DBN", model.name[:40]),
        ]
        lines += [f"    1U{name:<18}{text:<48}" for name, text in entries]
        for number, material in enumerate(self._materials(), start=1):
            lines.append(f"    1UMAT{number:5d}{material[:64]}")
        return ("\n".join(lines) + "\n").encode("utf-8", "replace")

    def _materials(self) -> list[str]:
        found = {id(s.material): s.material for s in self._model.sections}
        return [m.name or type(m).__name__ for m in found.values()]

    def _mesh(self) -> bytes:
        mesh = self._model.mesh
        flat = np.concatenate([mesh.points, *self._lines])
        labels = np.concatenate([mesh.node_labels, self._rigid_labels])
        points = np.column_stack([flat, np.zeros(len(flat))])
        kinds = [(c, *ELEMENTS[c.kind]) for c in mesh.cells if c.kind in ELEMENTS and len(c)]
        count = sum(len(c) for c, _, _ in kinds) + sum(len(line) - 1 for line in self._lines)
        how = 3 if self._binary else 1
        out = [f"    2C{'':18}{len(flat):12d}{'':37}{how:1d}\n".encode()]
        out.append(self._rows(labels, points, np.float64))
        how = 2 if self._binary else 1
        out.append(f"    3C{'':18}{count:12d}{'':37}{how:1d}\n".encode())
        elements = [
            (number, c.labels, mesh.node_labels[c.nodes[:, :width]]) for c, number, width in kinds
        ]
        label = int(mesh.cell_labels.max(initial=0)) + 1
        start = 0
        for line in self._lines:
            own = self._rigid_labels[start : start + len(line)]
            start += len(line)
            pairs = np.column_stack([own[:-1], own[1:]])
            elements.append((11, np.arange(label, label + len(pairs)), pairs))
            label += len(pairs)
        for number, own, nodes in elements:
            out.append(self._elements(number, own, nodes))
        out.append(b"" if self._binary else b" -3\n")
        return b"".join(out)

    def _elements(self, number: int, labels: Ints, nodes: Ints) -> bytes:
        if self._binary:
            same = np.broadcast_to([number, 0, 1], (len(labels), 3))
            return np.column_stack([labels, same, nodes]).astype("<i4").tobytes()
        per_line = 10
        width = nodes.shape[1]
        cuts = [(i, min(i + per_line, width)) for i in range(0, width, per_line)]
        form = f" -1%10d{number:5d}    0    1\n" + "".join(
            f" -2{'%10d' * (b - a)}\n" for a, b in cuts
        )
        rows = np.column_stack([labels, nodes]).tolist()
        return "".join([form % tuple(row) for row in rows]).encode()

    def _rows(self, labels: Ints, values: Floats, kind: Any = np.float32) -> bytes:
        """Lines of a label and values each; in binary without an end mark."""
        if self._binary:
            table = np.empty(
                len(labels), [("label", "<i4"), ("v", np.dtype(kind).str, (values.shape[1],))]
            )
            with np.errstate(over="ignore"):
                table["label"], table["v"] = labels, values
            return table.tobytes()
        form = " -1%10d" + "%12.5E" * values.shape[1] + "\n"
        clean = np.where(np.abs(values) < TINY, 0.0, values)
        rows = zip(labels.tolist(), clean.tolist(), strict=True)
        return "".join([form % (label, *row) for label, row in rows]).encode() + b" -3\n"

    def add(self, frame: Frame) -> None:
        """Write an increment.

        Raises
        ------
        CorotaError
            If a number is not finite; the file stays without the increment.
        FileError
            If writing fails.
        """
        check_frame(frame)
        if frame.increment == 0:
            return
        self._frames += 1
        text = b"".join(
            self._block(_head_of(frame), block, labels, values)
            for block, labels, values in self._data(frame)
        )
        self._append(text)

    def add_modes(self, modes: Modes) -> None:
        """Write modes of vibration or buckling, a set of blocks each.

        Raises
        ------
        FileError
            If writing fails.
        """
        labels = np.concatenate([self._model.mesh.node_labels, self._rigid_labels])
        still = np.zeros((len(self._rigid_labels), 3))
        kind = ANALYSIS[modes.kind] if modes.imaginary is None else COMPLEX
        text = b""
        for mode, (value, shape) in enumerate(zip(modes.factors, modes.shapes, strict=True)):
            self._frames += 1
            head = _Head(modes.step, 0 if kind == COMPLEX else 1, float(value), kind, mode + 1)
            real = shape * [1.0, 1.0, 0.0]
            text += self._block(head, DISP, labels, np.concatenate([real, still]))
            if modes.imaginary is None:
                continue
            wave = real + 1j * modes.imaginary[mode] * [1.0, 1.0, 0.0]
            polar = np.column_stack([np.abs(wave), np.degrees(np.angle(wave))])
            polar = np.concatenate([polar, np.zeros((len(still), 6))])
            text += self._block(head, PDISP, labels, polar)
        self._append(text)

    def _append(self, text: bytes) -> None:
        self._file.cut(self._file.length - len(END))
        self._file.append(text + END)

    def _block(self, head: _Head, block: Block, labels: Ints, values: Floats) -> bytes:
        self._blocks += 1
        when = head.value
        shown = f"{when:#.10g}"[:11] if 1.0 <= abs(when) < 1e9 else f"{when:11.5E}"
        how = 2 if self._binary else 1
        lines = [f"    1PSTEP{self._blocks:26d}{head.increment:12d}{head.step:12d}{'':10}"]
        if head.kind in (ANALYSIS["frequency"], COMPLEX):
            stiffness = (2.0 * np.pi * when) ** 2
            lines += [f"    1P{n:<4}{v:26.6E}{'':34}" for n, v in (("GM", 1.0), ("GK", stiffness))]
            numbers = (("HID", -1), ("SUBC", 0), ("MODE", head.mode))
            lines += [f"    1P{n:<4}{v:26d}{'':34}" for n, v in numbers]
        form = "MODAL" if head.kind == ANALYSIS["frequency"] else ""
        lines += [
            f"  100CL{100 + self._frames:5d} {shown:<11}{len(labels):12d}{'':20}"
            f"{head.kind:2d}{self._frames:5d}{form:<10}{how:2d}",
            f" -4  {block.name:<8}{len(block.components) + bool(block.size):5d}    1",
        ]
        for name, kind, row, column in block.components:
            lines.append(f" -5  {name:<8}{1:5d}{kind:5d}{row:5d}{column:5d}")
        if block.size:
            lines.append(f" -5  {block.size:<8}{1:5d}{2:5d}{0:5d}{0:5d}{1:5d}{block.size}")
        return ("\n".join(lines) + "\n").encode() + self._rows(labels, values)

    def _data(self, frame: Frame) -> list[tuple[Block, Ints, Floats]]:
        """Blocks of an increment with their nodes and values."""
        data = point_data(frame, self._averaging)
        labels = self._model.mesh.node_labels
        every = np.concatenate([labels, self._rigid_labels])
        more = len(self._rigid_labels)

        def longer(values: Floats) -> Floats:
            return np.concatenate([values, np.zeros((more, values.shape[1]))])

        shift = longer(data["displacement"])
        if more:
            lines = [line for curve in self._curves for line in moved(self._model, curve, frame)]
            rest = np.concatenate(lines) - np.concatenate(self._lines)
            shift[len(labels) :, :2] = rest
        found: list[tuple[Block, Ints, Floats]] = []
        surfaces = surface_stresses(self._model.mesh, frame)
        for block in blocks():
            if not self._wanted(block, frame):
                continue
            if block.name in surfaces:
                found.append((block, every, longer(surfaces[block.name][:, None])))
            elif block is DISP:
                found.append((block, every, shift))
            elif block is VELO and frame.V is not None:
                found.append((block, every, longer(data["velocity"])))
            elif block is FORC and not {"RF", "F"} <= frame.absent:
                force = internal_force(self._model, frame) if not frame.absent else frame.RF[:, :2]
                found.append((block, every, longer(np.column_stack([force, 0.0 * labels]))))
            elif block is STRESS and "stress" in data:
                found.append((block, every, longer(data["stress"])))
            elif block is TOSTRAIN and "strain" in data:
                tensor = data["strain"] * [1.0, 1.0, 1.0, 0.5, 0.5, 0.5]
                found.append((block, every, longer(tensor)))
            elif block is NDTEMP and frame.T is not None:
                found.append((block, every, longer(frame.T[:, None])))
            elif stored_as(block.request)[0] in data and len(block.components) == 1:
                found.append((block, every, longer(averaged_value(data, block.request)[:, None])))
            elif block is CONTACT and frame.C is not None:
                slaves = np.flatnonzero(self._slaves(frame))
                pressure, shear, gap, slip, _ = frame.C[slaves].T
                none = np.zeros(len(slaves))
                table = np.column_stack([gap, slip, none, pressure, shear, none])
                found.append((block, labels[slaves], table))
        return [entry for entry in found if len(entry[1])]

    def _slaves(self, frame: Frame) -> Bools:
        """Nodes of slave surfaces; of models from files those that have a value."""
        mesh = self._model.mesh
        out = np.zeros(mesh.n_nodes, dtype=bool)
        for pair in self._model.contacts:
            edges, nodes = edges_or_nodes(mesh, pair.slave)
            out[nodes if len(nodes) else mesh.edge_set_nodes(edges)] = True
        if not self._model.contacts and frame.C is not None:
            out = np.asarray(frame.C.any(axis=1))
        return out

    def _wanted(self, block: Block, frame: Frame) -> bool:
        if self._fields is not None:
            return block is DISP or block.request in self._fields or block.name in self._fields
        requested = [o for o in self._requests.active(frame) if o.of_file]
        if not requested:  # invariants follow from the tensors
            return block.request not in INVARIANTS
        names = {name for o in requested for name in o.variables}
        return block.request in names or (block is CONTACT and bool(names & {"CDIS", "CSTR"}))

    def sync(self) -> None:
        """Flush everything to the disk."""
        self._file.sync()

    def commit(self) -> None:
        """Do nothing: every increment is already on disk."""

    def close(self, info: dict[str, Any] | None = None) -> None:
        """Close the file."""
        self._file.close()


def surface_stresses(mesh: Mesh, frame: Frame) -> dict[str, Floats]:
    """Axial stress at the surfaces of the beams at nodes, by block; empty without beams.

    Where beams meet it is that of the largest size.
    """
    found: dict[str, Floats] = {}
    for block in frame.fields:
        if "SR1" not in block.values or not len(block.cells):
            continue
        number, _ = mesh.locate(int(block.cells[0]))
        nodes = mesh.cells[number].nodes[block.cells - mesh.offsets[number]]
        for side, kind in SURFACES.items():
            ends = np.hstack([block.values[f"{side}{end}"] for end in (1, 2)])
            at = found.setdefault(kind.name, np.zeros(mesh.n_nodes))
            order = np.argsort(np.abs(ends), axis=None)  # the last one of a node stays
            largest = np.zeros(mesh.n_nodes)
            largest[nodes.ravel()[order]] = ends.ravel()[order]
            found[kind.name] = np.where(np.abs(largest) > np.abs(at), largest, at)
    return found


def write_frd(results: Results, path: Path, binary: bool = False, **options: Any) -> None:
    """Write all increments but the state at the start, and all modes.

    Parameters
    ----------
    binary : bool
        Numbers in 4 bytes each instead of text.
    """
    from corota.io.file_options import from_keywords

    model = results.model
    chosen = from_keywords(options)
    writer = FrdWriter(path, model, model.steps, chosen, binary, sections=results.sections())
    try:
        for frame in results.frames:
            writer.add(frame)
        for modes in results.modes:
            writer.add_modes(modes)
    finally:
        writer.close()

"""The sections of a ``.msh`` file, checked against the available bytes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from corota._core import parse_reals
from corota.errors import InputError, Location, UnsupportedError
from corota.io.deck import numerals
from corota.io.deck.card import decode
from corota.mesh.kinds import KINDS, N_NODES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Floats, Ints


#: Cell kinds by Gmsh's element number.
NAMES = {kind.gmsh: name for name, kind in KINDS.items()}
#: Lines, triangles and quadrilaterals of third and higher order.
HIGHER = (*range(20, 29), *range(36, 53), *range(62, 71))
_LABEL_LIMIT = 2**53
_PHYSICAL = re.compile(r'\s*(\d{1,15})\s+(\d{1,15})\s+"(.*)"\s*\Z', re.ASCII)


@dataclass(slots=True)
class Block:
    """Elements of one kind and the same groups: tags (n,), node tags (n, k)."""

    kind: str
    groups: tuple[int, ...]
    tags: Ints
    nodes: Ints

    @property
    def dimension(self) -> int:
        """0 for points, 1 for lines, 2 for cells."""
        return KINDS[self.kind].dimension


@dataclass(slots=True)
class Parsed:
    """Contents of the file: node tags (n,), points (n, 3), blocks, names by (dimension, tag)."""

    tags: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    points: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    blocks: list[Block] = field(default_factory=list)
    names: dict[tuple[int, int], str] = field(default_factory=dict)


class Stream:
    """Numbers of one section, from text or bytes; taking more than there are is an error.

    Parameters
    ----------
    start : int
        Byte after the line that opens the section.
    """

    def __init__(self, reader: Reader, start: int, section: str) -> None:
        self.reader, self.at, self.section = reader, start, section
        self.start = start
        self._text: Floats = np.zeros(0)
        if not reader.binary:
            end = reader.data.find(b"$End" + section.encode(), start)
            if end < 0:
                raise reader.fault(f"section ${section} has no $End{section}", start)
            self._text = _numbers(reader, start, end)
            self.end = end
            self._next = 0

    def ints(self, count: int, width: int = 4) -> Ints:
        """Next whole numbers, of ``width`` bytes in binary files."""
        if self.reader.binary:
            return self._bytes(count, f"i{width}").astype(np.int64)
        values = self._take(count)
        if (values != np.floor(values)).any() or (np.abs(values) > _LABEL_LIMIT).any():
            bad = float(values[(values != np.floor(values)) | (np.abs(values) > _LABEL_LIMIT)][0])
            raise self.reader.fault(
                f"${self.section}: expected a whole number, found {bad:g}", self.place()
            )
        return values.astype(np.int64)

    def reals(self, count: int) -> Floats:
        """Next real numbers."""
        if not self.reader.binary:
            return self._take(count)
        values = self._bytes(count, "f8").astype(np.float64)
        _check_finite(self.reader, values, self.start)
        return values

    def numbered(self, count: int, width: int) -> tuple[Ints, Floats]:
        """Next rows of a whole number and ``width`` real ones."""
        if self.reader.binary:
            rows = self.table(count, [("tag", "i4", 1), ("x", "f8", width)])
            places = rows["x"].astype(np.float64)
            _check_finite(self.reader, places.ravel(), self.start)
            return rows["tag"][:, 0].astype(np.int64), places
        rows = self._take(count * (1 + width)).reshape(-1, 1 + width)
        if (rows[:, 0] != np.floor(rows[:, 0])).any() or (np.abs(rows[:, 0]) > _LABEL_LIMIT).any():
            raise self.reader.fault(f"${self.section}: a node number is not whole", self.place())
        return rows[:, 0].astype(np.int64), rows[:, 1:]

    def table(self, rows: int, types: list[tuple[str, str, int]]) -> NDArray[Any]:
        """Next rows of a mixed record (binary files only)."""
        form = np.dtype([(n, self.reader.order + t, (k,)) for n, t, k in types])
        return self._bytes(rows, form)

    def peek(self, count: int) -> Ints:
        """Next whole numbers of a text section, without taking them."""
        values = self.ints(count)
        self._next -= count
        return values

    def run(self, width: int, most: int, same: tuple[int, ...]) -> Ints:
        """Next rows of a text section, as long as the columns ``same`` do not change."""
        first, window, rows = self.ints(width), 64, 1
        head = self._next - width
        while rows < most:
            fit = (len(self._text) - self._next) // width
            ahead = min(window, most - rows, fit)
            if ahead < 1:
                break
            part = self._text[self._next : self._next + ahead * width].reshape(-1, width)
            equal = (part[:, same] == first[list(same)]).all(axis=1)
            good = ahead if equal.all() else int(np.argmin(equal))
            rows, window = rows + good, 2 * window
            self._next += good * width
            if good < ahead:
                break
        count = self._next - head
        self._next = head
        return self.ints(count).reshape(-1, width)

    def finish(self) -> int:
        """Byte after the section; everything in it must have been used."""
        if not self.reader.binary:
            if self._next != len(self._text):
                raise self.reader.fault(
                    f"${self.section}: more numbers than the counts announce", self.place()
                )
            return self.end
        closing = b"$End" + self.section.encode()
        end = self.reader.data.find(closing, self.at)
        if end < 0 or self.reader.data[self.at : end].strip():
            raise self.reader.fault(f"${self.section}: $End{self.section} is missing", self.start)
        return end

    def _take(self, count: int) -> Floats:
        if count < 0 or self._next + count > len(self._text):
            raise self.reader.fault(
                f"${self.section} ends early: {count} numbers are announced, "
                f"{len(self._text) - self._next} are left",
                self.place(),
            )
        values = self._text[self._next : self._next + count]
        self._next += count
        return values

    def _bytes(self, count: int, form: Any) -> NDArray[Any]:
        kind = np.dtype(self.reader.order + form) if isinstance(form, str) else form
        if count < 0 or self.at + count * kind.itemsize > len(self.reader.data):
            raise self.reader.fault(
                f"${self.section} ends early: {count} records are announced", self.start
            )
        values = np.frombuffer(self.reader.data, kind, count, self.at)
        self.at += count * kind.itemsize
        return values

    def place(self) -> int:
        """Byte of the number that was taken last."""
        at = self.start
        for number, match in enumerate(re.finditer(rb"\S+", self.reader.data[self.start :])):
            at = self.start + match.start()
            if number >= self._next:
                break
        return min(at, self.end)


class Reader:
    """Reads one file.

    Parameters
    ----------
    path : str
        Shown in messages.
    """

    def __init__(self, path: str, data: bytes) -> None:
        self.path, self.data = path, data
        self.binary, self.order, self.version = False, "<", 0.0
        self.parsed = Parsed()
        self._entities: dict[tuple[int, int], tuple[int, ...]] = {}
        self._seen: set[str] = set()
        self._section_name = ""

    def fault(self, message: str, at: int) -> InputError:
        """Error at a byte."""
        return InputError(message, Location(self.path, self.data.count(b"\n", 0, at) + 1))

    def read(self) -> Parsed:
        """Read all sections.

        Raises
        ------
        InputError
            With file and line.
        """
        # Text before the first section is a comment.
        at = max(self.data.find(b"$MeshFormat"), 0)
        while True:
            start = self.data.find(b"$", at)
            if start < 0:
                break
            if self.data[at:start].strip() and at:
                raise self.fault("text between two sections", at)
            end_of_line = self.data.find(b"\n", start)
            end_of_line = len(self.data) if end_of_line < 0 else end_of_line
            name = decode(self.data[start + 1 : end_of_line]).strip()
            at = self._section(name, end_of_line + 1, start)
        for needed in ("MeshFormat", "Nodes", "Elements"):
            if needed not in self._seen:
                raise InputError(f"section ${needed} is missing", Location(self.path, 1))
        return self.parsed

    def _section(self, name: str, body: int, start: int) -> int:
        sections = {
            "MeshFormat": self._format,
            "PhysicalNames": self._physical_names,
            "Entities": self._entities_section,
            "PartitionedEntities": self._partitions,
            "Nodes": self._nodes,
            "ParametricNodes": self._nodes,
            "Elements": self._elements,
        }
        if name != "MeshFormat" and "MeshFormat" not in self._seen:
            raise self.fault("a .msh file starts with $MeshFormat", start)
        if name in sections:
            if name in self._seen:
                raise self.fault(f"section ${name} occurs twice", start)
            self._seen.add("Nodes" if name == "ParametricNodes" else name)
            self._section_name = name
            end = sections[name](body)
        else:
            end = self.data.find(b"$End" + name.encode(), body)
            if end < 0 or not name:
                raise self.fault(f"section ${name[:40]} has no end", start)
        after = end + len(b"$End") + len(name.encode())
        if self.data[end:after] != b"$End" + name.encode():
            raise self.fault(f"$End{name} is missing", end)
        return after

    def _format(self, body: int) -> int:
        line_end = self.data.find(b"\n", body)
        fields = decode(self.data[body:line_end]).split() if line_end >= 0 else []
        if len(fields) != 3 or not re.fullmatch(r"\d+(\.\d+)?", fields[0]):
            raise self.fault("expected version, file type and data size", body)
        self.version, self.binary = float(fields[0]), fields[1] == "1"
        if self.version not in (2.0, 2.1, 2.2, 4.0, 4.1):
            raise UnsupportedError(
                f"MSH version {fields[0]} is not read; export 4.1 or 2.2 (gmsh -format msh41)",
                Location(self.path, 2),
            )
        if fields[1] not in ("0", "1") or fields[2] not in ("4", "8"):
            raise self.fault("the file type must be 0 or 1 and the data size 8", body)
        end = line_end + 1
        if self.binary:
            one = self.data[end : end + 4]
            if one == b"\1\0\0\0":
                self.order = "<"
            elif one == b"\0\0\0\1":
                self.order = ">"
            else:
                raise self.fault("the byte order of the binary file is not known", end)
            end += 4
        found = self.data.find(b"$EndMeshFormat", end)
        if found < 0:
            raise self.fault("$EndMeshFormat is missing", body)
        return found

    def _physical_names(self, body: int) -> int:
        end = self.data.find(b"$EndPhysicalNames", body)
        if end < 0:
            raise self.fault("section $PhysicalNames has no end", body)
        at = body
        for number, line in enumerate(self.data[body:end].split(b"\n")):
            text = decode(line)
            match = _PHYSICAL.match(text)
            if match and len(match.group(1)) < 3 and len(match.group(2)) < 16:
                self.parsed.names[int(match.group(1)), int(match.group(2))] = match.group(3)
            elif text.strip() and number:
                raise self.fault('expected: dimension tag "name"', at)
            at += len(line) + 1
        return end

    def _entities_section(self, body: int) -> int:
        stream = Stream(self, body, "Entities")
        counts = stream.ints(4, 8)
        for dimension, count in enumerate(counts):
            for _ in range(int(count)):
                tag = int(stream.ints(1)[0])
                self._entities[dimension, tag] = self._groups(stream, dimension)
        return stream.finish()

    def _groups(self, stream: Stream, dimension: int) -> tuple[int, ...]:
        """Physical groups of an entity, behind its box."""
        stream.reals(3 if dimension == 0 and self.version > 4.0 else 6)
        groups = stream.ints(int(stream.ints(1, 8)[0]))
        if dimension > 0:
            stream.ints(int(stream.ints(1, 8)[0]))
        return tuple(int(abs(g)) for g in groups)

    def _partitions(self, body: int) -> int:
        """Parts of entities; they belong to the groups of their parents."""
        stream = Stream(self, body, "PartitionedEntities")
        stream.ints(1, 8)
        stream.ints(2 * int(stream.ints(1, 8)[0]))
        whole = dict(self._entities)
        for dimension, count in enumerate(stream.ints(4, 8)):
            for _ in range(int(count)):
                tag, of, parent = (int(v) for v in stream.ints(3))
                stream.ints(int(stream.ints(1, 8)[0]))
                groups = self._groups(stream, dimension)
                if not groups and of == dimension:
                    groups = whole.get((of, parent), ())
                self._entities[dimension, tag] = groups
        return stream.finish()

    def _nodes(self, body: int) -> int:
        tags, points = (self._nodes_4 if self.version >= 4 else self._nodes_2)(body)
        self.parsed.tags = np.concatenate([np.zeros(0, np.int64), *tags])
        self.parsed.points = np.concatenate([np.zeros((0, 3)), *points])
        labels = np.sort(self.parsed.tags)
        twice = labels[1:][np.diff(labels) == 0]
        if len(twice):
            raise self.fault(f"$Nodes: node {twice[0]} occurs twice", body)
        if len(labels) and labels[0] < 1:
            raise self.fault(f"$Nodes: the node number {labels[0]} is not positive", body)
        return self._end

    def _counted(self, body: int) -> tuple[int, Stream]:
        """Number of entries of a section of MSH 2, and its numbers behind it."""
        if self.binary:
            count, body = self._count_line(body)
            return count, Stream(self, body, self._section_name)
        stream = Stream(self, body, self._section_name)
        return int(stream.ints(1)[0]), stream

    def _nodes_2(self, body: int) -> tuple[list[Ints], list[Floats]]:
        count, stream = self._counted(body)
        if self._section_name == "Nodes":
            own, places = stream.numbered(count, 3)
            self._end = stream.finish()
            return [own], [places]
        # Coordinates on curves and surfaces are not used.
        tags, points = [], []
        for _ in range(count):
            tags.append(int(stream.ints(1)[0]))
            points.append(stream.reals(3))
            dimension = int(stream.ints(2)[0])
            if dimension in (1, 2):
                stream.reals(dimension)
        self._end = stream.finish()
        return [np.array(tags, np.int64)], [np.array(points).reshape(-1, 3)]

    def _nodes_4(self, body: int) -> tuple[list[Ints], list[Floats]]:
        stream = Stream(self, body, "Nodes")
        n_blocks = int(stream.ints(2 if self.version == 4.0 else 4, 8)[0])
        tags, points = [], []
        for _ in range(n_blocks):
            head = [int(v) for v in stream.ints(3)]
            dimension, parametric = head[1 if self.version == 4.0 else 0], head[2]
            count = int(stream.ints(1, 8)[0])
            width = 3 + (dimension if parametric else 0)
            if self.version == 4.0:
                own, places = stream.numbered(count, width)
                tags.append(own)
                points.append(places[:, :3])
                continue
            tags.append(stream.ints(count, 8))
            points.append(stream.reals(count * width).reshape(-1, width)[:, :3])
        self._end = stream.finish()
        return tags, points

    def _elements(self, body: int) -> int:
        (self._elements_4 if self.version >= 4 else self._elements_2)(body)
        return self._end

    def _elements_4(self, body: int) -> None:
        stream = Stream(self, body, "Elements")
        n_blocks = int(stream.ints(2 if self.version == 4.0 else 4, 8)[0])
        for _ in range(n_blocks):
            dimension, entity, type_ = (int(v) for v in stream.ints(3))
            if self.version == 4.0:
                dimension, entity = entity, dimension
            count = int(stream.ints(1, 8)[0])
            kind = self._kind(type_, stream)
            size = N_NODES[kind] + 1
            table = stream.ints(count * size, 4 if self.version == 4.0 else 8).reshape(-1, size)
            groups = self._entities.get((dimension, entity), ())
            self.parsed.blocks.append(Block(kind, groups, table[:, 0], table[:, 1:]))
        self._end = stream.finish()

    def _elements_2(self, body: int) -> None:
        count, stream = self._counted(body)
        rows: dict[tuple[str, tuple[int, ...]], list[Ints]] = {}
        done = 0
        while done < count:
            # Text has type and tags in each row, binary files before rows of one type.
            if self.binary:
                type_, number, n_tags = (int(v) for v in stream.ints(3))
            else:
                _, type_, n_tags = (int(v) for v in stream.peek(3))
            kind = self._kind(type_, stream)
            if self.binary and (number < 1 or n_tags < 0):
                raise self.fault("$Elements: a block of elements is empty or damaged", body)
            if n_tags < 0:
                raise self.fault("$Elements: a number of tags is negative", body)
            first = 1 if self.binary else 3
            width = first + n_tags + N_NODES[kind]
            if self.binary:
                table = stream.ints(number * width).reshape(-1, width)
            else:
                table = stream.run(width, count - done, (1, 2))
            physical = np.abs(table[:, first]) if n_tags else np.zeros(len(table), np.int64)
            for group in np.unique(physical):
                place = (kind, (int(group),) if group else ())
                mine = table[physical == group]
                rows.setdefault(place, []).append(mine[:, [0, *range(first + n_tags, width)]])
            done += len(table)
        self._end = stream.finish()
        for (kind, groups), parts in rows.items():
            table = np.concatenate(parts)
            self.parsed.blocks.append(Block(kind, groups, table[:, 0], table[:, 1:]))

    def _kind(self, type_: int, stream: Stream) -> str:
        if type_ in NAMES:
            return NAMES[type_]
        text = (
            f"Gmsh's element type {type_} is not read; expected triangles "
            "(3 or 6 nodes) and quadrilaterals (4, 8 or 9), with lines and points"
        )
        if type_ in HIGHER:
            text = (
                f"the elements are of third or higher order (Gmsh's type {type_}); "
                "mesh with first or second order (gmsh -order 2)"
            )
        at = stream.start if self.binary else stream.place()
        where = Location(self.path, self.data.count(b"\n", 0, at) + 1)
        raise UnsupportedError(f"$Elements: {text}", where)

    def _count_line(self, body: int) -> tuple[int, int]:
        end = self.data.find(b"\n", body)
        text = decode(self.data[body:end]).strip() if end >= 0 else ""
        if not (text.isascii() and text.isdigit()) or len(text) > 15:
            raise self.fault("expected the number of entries", body)
        return int(text), end + 1


def _numbers(reader: Reader, start: int, end: int) -> Floats:
    """Numbers of a text section."""
    found = parse_reals(reader.data, start, end)
    if isinstance(found, int):
        text = decode(reader.data[start + found : min(end, start + found + 40)])
        # Python accepts more characters as blanks than the number reader.
        word = next(iter(text.split()), text)
        raise reader.fault(_reason(word), start + found)
    _check_finite(reader, found, start)
    return found


def _reason(word: str) -> str:
    """Why a word is not a number."""
    try:
        numerals.real(word)
    except ValueError as error:
        return str(error)
    return f"{numerals.shown(word)} is too long for a number"


def _check_finite(reader: Reader, values: Floats, start: int) -> None:
    size = np.abs(values)
    bad = ~(size <= 1e100) | ((size > 0.0) & (size < sys.float_info.min))
    if not bad.any():
        return
    number = int(np.flatnonzero(bad)[0])
    at = start
    if not reader.binary:
        for count, match in enumerate(re.finditer(rb"\S+", reader.data[start:])):
            if count == number:
                at = start + match.start()
                break
    raise reader.fault("a number is too large, too small or not a number", at)

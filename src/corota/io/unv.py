"""Meshes of I-DEAS universal files (``.unv``), as Salome and others write them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError, Location
from corota.io.meshio_bridge import from_meshio
from corota.io.regular_file import read_bytes
from corota.mesh.kinds import KINDS

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from corota.mesh.data import Mesh

#: Kinds by the element numbers of the format.
_KINDS = {number: kind for kind in KINDS.values() for number in kind.unv}
#: Beams have a line of their own before their nodes.
_BEAMS = (11, 21, 22, 23, 24)
#: Data sets of groups that hold two members a line, four numbers each.
_GROUPS = (2429, 2430, 2432, 2435, 2452, 2467, 2477)
_MOST = 100


@dataclass
class _Found:
    """Nodes, elements by kind and groups of a file."""

    points: dict[int, tuple[float, ...]] = field(default_factory=dict)
    cells: dict[str, list[tuple[int, list[int]]]] = field(default_factory=dict)
    groups: list[tuple[str, list[int], list[int]]] = field(default_factory=list)


def read_unv(path: str | os.PathLike[str]) -> Mesh:
    """Read the nodes, elements and groups of a ``.unv`` file.

    Raises
    ------
    InputError
        With file and line of the error, or if there are no planar elements.
    FileError
        If the file cannot be read.
    """
    lines = read_bytes(path).decode("latin-1").splitlines()
    found = _Found()
    readers = {2411: _nodes, 781: _nodes, 2412: _elements, **dict.fromkeys(_GROUPS, _group)}
    for number, start, stop in _data_sets(lines, str(path)):
        if number in readers:
            at = start
            try:
                while at < stop:
                    at = readers[number](lines, at, stop, found)
            except (ValueError, IndexError, KeyError) as error:
                raise InputError(
                    f"data set {number} is damaged: {error}", Location(str(path), at + 1)
                ) from None
    return from_meshio(_as_meshio(found, str(path)), str(path))


def _data_sets(lines: list[str], path: str) -> Iterator[tuple[int, int, int]]:
    """Number, first and last line of each data set, which stands between two lines of -1."""
    marks = [i for i, line in enumerate(lines) if line.strip() == "-1"]
    if len(marks) < 2 or len(marks) % 2:
        raise InputError("data sets stand between two lines of -1", Location(path, 1))
    for first, last in zip(marks[::2], marks[1::2], strict=True):
        head = lines[first + 1].split() if first + 1 < last else []
        if not head or not head[0].isdigit():
            raise InputError("the number of a data set is missing", Location(path, first + 2))
        yield int(head[0]), first + 2, last


def _nodes(lines: list[str], at: int, stop: int, found: _Found) -> int:
    if at + 2 > stop:
        raise ValueError("a node has no coordinates")
    label = int(lines[at].split()[0])
    xyz = [float(v) for v in lines[at + 1].upper().replace("D", "E").split()]
    if len(xyz) != 3 or not np.isfinite(xyz).all():
        raise ValueError(f"node {label} needs three coordinates")
    if label in found.points:
        raise ValueError(f"node {label} occurs twice")
    found.points[label] = tuple(xyz)
    return at + 2


def _elements(lines: list[str], at: int, stop: int, found: _Found) -> int:
    head = [int(v) for v in lines[at].split()]
    label, number, count = head[0], head[1], head[5]
    if not 1 <= count <= _MOST:
        raise ValueError(f"element {label} has {count} nodes")
    at += 2 if number in _BEAMS else 1
    nodes: list[int] = []
    while len(nodes) < count and at < stop:
        nodes += [int(v) for v in lines[at].split()]
        at += 1
    if len(nodes) != count:
        raise ValueError(f"element {label} has {len(nodes)} nodes, not {count}")
    kind = _KINDS.get(number)
    if kind is not None:
        if count != kind.count:
            raise ValueError(f"element {label} of type {number} has {count} nodes")
        # Nodes are in cyclic order: each mid-side node follows its corner.
        if kind.quadratic:
            nodes = nodes[::2] + nodes[1::2]
        found.cells.setdefault(kind.meshio, []).append((label, nodes))
    return at


def _group(lines: list[str], at: int, stop: int, found: _Found) -> int:
    count = int(lines[at].split()[7])
    name = lines[at + 1].strip()
    at += 2
    members: list[int] = []
    while len(members) < 4 * count and at < stop:
        members += [int(v) for v in lines[at].split()]
        at += 1
    if len(members) < 4 * count:
        raise ValueError(f"group {name!r} ends early")
    nodes = [tag for kind, tag in zip(members[::4], members[1::4], strict=False) if kind == 7]
    cells = [tag for kind, tag in zip(members[::4], members[1::4], strict=False) if kind == 8]
    found.groups.append((name, nodes, cells))
    return at


def _as_meshio(found: _Found, path: str) -> Any:
    """The file as a meshio object."""
    row = {label: i for i, label in enumerate(found.points)}
    blocks, labels, place = [], [], {}
    for number, (kind, rows) in enumerate(found.cells.items()):
        for i, (label, nodes) in enumerate(rows):
            missing = [n for n in nodes if n not in row]
            if missing:
                raise InputError(f"{path}: element {label}: node {missing[0]} is not defined")
            place[label] = (number, i)
        data = np.array([[row[n] for n in nodes] for _, nodes in rows], np.int64)
        blocks.append(SimpleNamespace(type=kind, data=data))
        labels.append(np.array([label for label, _ in rows], np.int64))
    point_sets, cell_sets = {}, {}
    for name, nodes, cells in found.groups:
        if nodes:
            point_sets[name] = np.array([row[n] for n in nodes if n in row], np.int64)
        parts: list[list[int]] = [[] for _ in blocks]
        for label in cells:
            if label in place:
                number, i = place[label]
                parts[number].append(i)
        if any(parts):
            cell_sets[name] = [np.array(part, np.int64) for part in parts]
    return SimpleNamespace(
        points=np.array(list(found.points.values()), np.float64).reshape(-1, 3),
        cells=blocks,
        point_sets=point_sets,
        cell_sets=cell_sets,
        point_data={"node label": np.array(list(found.points), np.int64)},
        cell_data={"element label": labels},
    )

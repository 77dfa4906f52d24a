"""A mesh with its sets as the mesh part of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from typing import TYPE_CHECKING

from corota.io.atomic_file import replace_text
from corota.mesh.kinds import KINDS, PLANAR

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from corota.mesh import Mesh

#: Element type written for each cell kind.
TYPES = {name: KINDS[name].deck for name in PLANAR}
#: Entries on a line of a set.
PER_LINE = 10


def write_deck_mesh(mesh: Mesh, path: Path, title: str = "") -> None:
    """Write nodes, elements, sets and surfaces; sections and steps are the user's to add.

    Line and point cells are omitted. Blanks and commas in set names become ``_``.

    Raises
    ------
    FileError
        If writing fails.
    """
    replace_text(path, "".join(_cards(mesh, title or path.stem)))


def _cards(mesh: Mesh, title: str) -> Iterator[str]:
    yield f"*HEADING\n{title}\n*NODE, NSET=NALL\n"
    for label, (x, y) in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True):
        yield f"{label}, {x!r}, {y!r}\n"
    for cells in mesh.cells:
        if cells.kind not in TYPES or not len(cells):
            continue
        yield f"*ELEMENT, TYPE={TYPES[cells.kind]}, ELSET=EALL\n"
        named = mesh.node_labels[cells.nodes]
        for label, row in zip(cells.labels.tolist(), named.tolist(), strict=True):
            yield f"{label}, {', '.join(map(str, row))}\n"
    for name, members in mesh.node_sets.items():
        if _plain(name) != "NALL":
            yield f"*NSET, NSET={_plain(name)}\n"
            yield from _lines(mesh.node_labels[members].tolist())
    planar = [len(c) if c.kind in TYPES else 0 for c in mesh.cells]
    labels = mesh.cell_labels
    for name, members in mesh.cell_sets.items():
        kept = [int(c) for c in members if planar[mesh.locate(int(c))[0]]]
        if kept and _plain(name) != "EALL":
            yield f"*ELSET, ELSET={_plain(name)}\n"
            yield from _lines(labels[kept].tolist())
    for name, edges in mesh.edge_sets.items():
        yield f"*SURFACE, NAME={_plain(name)}, TYPE=ELEMENT\n"
        for cell, side in edges.tolist():
            yield f"{labels[cell]}, S{side + 1}\n"


def _plain(name: str) -> str:
    return re.sub(r"[\s,=*]+", "_", name).upper()


def _lines(numbers: Iterable[int]) -> Iterator[str]:
    row: list[str] = []
    for number in numbers:
        row.append(str(number))
        if len(row) == PER_LINE:
            yield ", ".join(row) + "\n"
            row = []
    if row:
        yield ", ".join(row) + "\n"

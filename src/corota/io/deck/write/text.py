"""Names, numbers and lists in the format of decks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from corota.arrays import Ints
    from corota.mesh.data import Mesh
    from corota.model.model import Model

#: Entries on a line of a set.
PER_LINE = 10
#: Degrees of freedom of decks by ours.
DOFS = (1, 2, 6)


class Writer(Protocol):
    """Interface of the writer for its parts: the model, and names of sets."""

    model: Model
    mesh: Mesh

    def nodes(self, where: str | Ints) -> list[str]:
        """Targets that stand for nodes: a set, or node numbers."""
        ...

    def node_set(self, where: str | Ints) -> str:
        """Name of a node set, generated for an array."""
        ...

    def cell_set(self, where: str | Ints) -> str:
        """Name of an element set, generated for an array."""
        ...

    def edge_set(self, where: str | Ints) -> str:
        """Name of a surface, generated for an array."""
        ...


def number(value: float) -> str:
    """Shortest text that reads back to the same number."""
    return repr(float(value))


def numbers(values: Iterable[float]) -> str:
    """Numbers on one line."""
    return ", ".join(number(v) for v in values)


def plain(name: str) -> str:
    """Valid name in a deck; one that starts with a digit would be read as a number."""
    text = re.sub(r"[\s,=*\"]+", "_", name)
    return f"_{text}" if re.match(r"[-+.\d]", text) else text


def rows(items: Iterable[object], per_line: int = PER_LINE) -> Iterator[str]:
    """Lines of a list."""
    row = [str(item) for item in items]
    for start in range(0, len(row), per_line):
        yield ", ".join(row[start : start + per_line]) + "\n"

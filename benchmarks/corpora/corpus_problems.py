"""Small planar problems that the corpus writes in the layouts of many programs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class Problem:
    """A strip of ``nx`` by ``ny`` elements, held on the left.

    ``loads`` holds lines of ``*CLOAD`` (set, dof, value), ``pressure`` acts on the set TOP,
    ``moved`` prescribes dof 1 of the set RIGHT.
    """

    name: str
    type: str
    nx: int = 4
    ny: int = 2
    size: tuple[float, float] = (4.0, 1.0)
    thickness: float = 0.5
    elastic: tuple[float, float] = (210000.0, 0.3)
    density: float = 0.0
    plastic: tuple[tuple[float, float], ...] = ()
    expansion: float = 0.0
    nlgeom: bool = False
    clamped: bool = True
    loads: list[tuple[str, int, float]] = field(default_factory=list)
    pressure: float = 0.0
    gravity: float = 0.0
    heat: float = 0.0
    moved: float | None = None

    def mesh(self) -> tuple[dict[int, tuple[float, float]], dict[int, list[int]]]:
        """Nodes and elements by number."""
        quadratic = self.type[3:4] in ("6", "8")
        step = 2 if quadratic else 1
        nx, ny = self.nx * step, self.ny * step
        number = {}
        nodes: dict[int, tuple[float, float]] = {}
        for j in range(ny + 1):
            for i in range(nx + 1):
                if self.type[3:4] == "8" and i % 2 and j % 2:
                    continue
                number[i, j] = len(nodes) + 1
                nodes[len(nodes) + 1] = (self.size[0] * i / nx, self.size[1] * j / ny)
        elements: dict[int, list[int]] = {}
        for j in range(0, ny, step):
            for i in range(0, nx, step):
                corners = [(i, j), (i + step, j), (i + step, j + step), (i, j + step)]
                if self.type[3:4] in ("4", "8"):
                    shapes = [corners]
                else:
                    shapes = [[corners[0], corners[1], corners[2]], [corners[0], *corners[2:]]]
                for shape in shapes:
                    ends = [number[c] for c in shape]
                    if quadratic:
                        pairs = zip(shape, shape[1:] + shape[:1], strict=True)
                        ends += [number[(a[0] + b[0]) // 2, (a[1] + b[1]) // 2] for a, b in pairs]
                    elements[len(elements) + 1] = ends
        return nodes, elements

    def sets(self) -> dict[str, list[int]]:
        """Nodes of the ends and of one corner, elements and faces of the top."""
        nodes, elements = self.mesh()
        at = {
            "LEFT": [n for n, p in nodes.items() if p[0] == 0.0],
            "RIGHT": [n for n, p in nodes.items() if p[0] == self.size[0]],
            "CORNER": [n for n, p in nodes.items() if p == (0.0, 0.0)],
            "TIP": [n for n, p in nodes.items() if p == self.size],
        }
        top = {n for n, p in nodes.items() if p[1] == self.size[1]}
        for e, ends in elements.items():
            corners = ends[: 3 if self.type[3:4] in ("3", "6") else 4]
            for face in range(len(corners)):
                if {corners[face], corners[(face + 1) % len(corners)]} <= top:
                    at.setdefault(f"TOP_S{face + 1}", []).append(e)
        return at

    def supports(self) -> list[tuple[str, int, int, float]]:
        """Set, first and last dof, value."""
        if self.clamped:
            found = [("LEFT", 1, 2, 0.0)]
        else:
            found = [("LEFT", 1, 1, 0.0), ("CORNER", 2, 2, 0.0)]
        return found

    def prescribed(self) -> list[tuple[str, int, int, float]]:
        """Supports of the step."""
        return [] if self.moved is None else [("RIGHT", 1, 1, self.moved)]


PROBLEMS = [
    Problem("cantilever", "CPS8R", loads=[("TIP", 2, -10.0)]),
    Problem("block", "CPE8R", clamped=False, pressure=25.0, size=(2.0, 1.0)),
    Problem("bar", "CPS4", clamped=False, moved=0.002),
    Problem("weight", "CPS6", density=7.8e-9, gravity=9810.0),
    Problem("plate", "CPE3", nx=6, ny=3, loads=[("TIP", 1, 40.0), ("TIP", 2, 15.0)]),
    Problem("heated", "CPE8", clamped=True, expansion=1.2e-5, heat=80.0, nx=3, ny=1),
    Problem("flow", "CPS8R", clamped=False, plastic=((200.0, 0.0), (300.0, 0.1)), moved=0.02, ny=1),
    Problem(
        "rotation", "CPE8R", nlgeom=True, nx=6, ny=1, size=(10.0, 0.5), loads=[("TIP", 2, 40.0)]
    ),
]

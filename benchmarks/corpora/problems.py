"""The benchmark problems P1 to P4 as arrays that every program's driver reads.

A problem is a mesh of quadrilaterals, one material, held and loaded components and what to look
at. Written as one ``.npz`` file, so that a driver needs NumPy only and all programs have the same
nodes. Forces are those of the thickness of the problem.

P1 is a cantilever 10 x 1 that bends to 6.8 under a dead shear, P2 a strip with a hole beyond
yield, P3 presses a block with a curved face into another (P3f with friction), P4 is the cantilever
under a load that acts at once (P4x2 under twice that load).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.corpora import cantilever as p1

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


@dataclass
class Problem:
    """What a driver needs to know.

    Parameters
    ----------
    name : {"P1", "P2", "P3", "P4"}
    points : ndarray, shape (n, 2)
    cells : ndarray, shape (m, 4 or 8)
        From 0, corners first, counter-clockwise.
    held_nodes, held_dofs, held_values : ndarray, shape (k,)
        Prescribed displacements at full load.
    load_nodes, load_dofs, load_values : ndarray, shape (l,)
        Nodal forces at full load.
    watch : ndarray
        The node whose displacement is the result (P1, P4), or the nodes whose vertical reactions
        are summed (P2, P3).
    increments, last : int
        Equal increments of the whole load, and how many of them are run.
    slave, master : ndarray, shape (k, 2)
        Nodes of the edges in contact, the body on the left (P3).
    friction : float
    young, poisson, density, thickness, yield_stress, slope : float
        ``yield_stress`` 0 is elastic; ``slope`` is the isotropic hardening.
    period : float
        Of P4 [time].
    """

    name: str
    points: Floats
    cells: Ints
    held_nodes: Ints
    held_dofs: Ints
    held_values: Floats
    load_nodes: Ints
    load_dofs: Ints
    load_values: Floats
    watch: Ints
    increments: int
    last: int
    young: float
    poisson: float
    thickness: float
    density: float = 1.0
    yield_stress: float = 0.0
    slope: float = 0.0
    period: float = 1.0
    friction: float = 0.0
    slave: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    master: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))

    @property
    def n_dofs(self) -> int:
        """Displacement components, held ones included."""
        return 2 * len(self.points)

    def save(self, path: Path) -> None:
        """Write it as ``.npz``."""
        np.savez(path, **{f.name: getattr(self, f.name) for f in fields(self)})

    @staticmethod
    def load(path: str | Path) -> Problem:
        """Read what :meth:`save` wrote."""
        with np.load(path) as data:
            values: dict[str, Any] = {f.name: data[f.name] for f in fields(Problem)}
        return Problem(**{k: v if v.ndim else v.item() for k, v in values.items()})


def cantilever(n: int, order: int = 1, last: int = 0) -> Problem:
    """P1 with `n` elements through the height, linear or quadratic."""
    points, cells = p1.grid(n, order)
    root = np.flatnonzero(points[:, 0] == 0.0)
    shares = p1.tip_shares(points, order)
    return Problem(
        "P1",
        points,
        cells,
        np.repeat(root, 2),
        np.tile([0, 1], len(root)),
        np.zeros(2 * len(root)),
        np.array(list(shares)),
        np.ones(len(shares), np.int64),
        p1.SHEAR * p1.THICKNESS * np.array(list(shares.values())),
        np.array([p1.tip_middle(points)]),
        p1.INCREMENTS,
        last or p1.INCREMENTS,
        p1.YOUNG,
        p1.POISSON,
        p1.THICKNESS,
    )


def transient(n: int, order: int = 1, last: int = 0, load: float = 1000.0) -> Problem:
    """P4: the cantilever of P1 under a force per unit thickness that acts at once."""
    made = cantilever(n, order)
    made.name, made.increments, made.period = "P4", 200, 1.0
    made.last = last or made.increments
    made.load_values *= load / p1.SHEAR
    return made


def strip(n: int, order: int = 1, last: int = 0) -> Problem:
    """P2: the strip 10 x 18 with a hole of radius 5, pulled by 0.3 beyond yield."""
    from corota.verification.plastic_models import find, strip_mesh

    mesh = strip_mesh(n, "quad8" if order == 2 else "quad4")
    bottom, left, top = (find(mesh, a, v) for a, v in ((1, 0.0), (0, 0.0), (1, 18.0)))
    nothing = np.zeros(0, np.int64)
    return Problem(
        "P2",
        mesh.points,
        np.concatenate([c.nodes for c in mesh.cells]),
        np.concatenate([bottom, left, top]),
        np.repeat([1, 0, 1], [len(bottom), len(left), len(top)]),
        np.repeat([0.0, 0.0, 0.3], [len(bottom), len(left), len(top)]),
        nothing,
        nothing,
        np.zeros(0),
        top,
        20,
        last or 20,
        70000.0,
        0.2,
        0.01,
        yield_stress=243.0,
        slope=2240.0,
    )


def blocks(n: int, order: int = 1, last: int = 0, friction: float = 0.0) -> Problem:
    """P3: a block 1 x 0.5 with a face of radius 8, pressed by 0.02 into a block 2 x 1.

    `n` elements along the curved face, half as many again along the other for the same length.
    """
    if order != 1:
        raise ValueError("P3 has linear elements")
    s, t, upper = lattice(n, max(1, n // 2))
    x = s - 0.5
    low = 9.0 - np.sqrt(64.0 - x**2)
    top = np.flatnonzero(t == 1.0)
    bottom = np.flatnonzero(t == 0.0)
    first = np.stack([x, low + (1.5 - low) * t], axis=1)
    u, v, lower = lattice(3 * n, max(1, 3 * n // 2))
    other = np.stack([2.0 * u - 1.0, v], axis=1)
    base = len(first) + np.flatnonzero(v == 0.0)
    face = len(first) + np.flatnonzero(v == 1.0)
    nothing = np.zeros(0, np.int64)
    return Problem(
        "P3",
        np.concatenate([first, other]),
        np.concatenate([upper, len(first) + lower]),
        np.concatenate([np.repeat(base, 2), np.repeat(top, 2)]),
        np.tile([0, 1], len(base) + len(top)),
        np.concatenate([np.zeros(2 * len(base)), np.tile([0.0, -0.02], len(top))]),
        nothing,
        nothing,
        np.zeros(0),
        top,
        10,
        last or 10,
        210000.0,
        0.3,
        0.01,
        friction=friction,
        slave=np.stack([bottom[:-1], bottom[1:]], axis=1),
        master=np.stack([face[1:], face[:-1]], axis=1),
    )


def lattice(nx: int, ny: int) -> tuple[Floats, Floats, Ints]:
    """Coordinates from 0 to 1 of the nodes of nx by ny quadrilaterals, and the quadrilaterals."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij"))
    corner = (np.arange(nx)[:, None] * (ny + 1) + np.arange(ny)).ravel()
    cells = np.stack([corner, corner + ny + 1, corner + ny + 2, corner + 1], axis=1)
    return i / nx, j / ny, cells


BUILDERS = {
    "P1": cantilever,
    "P2": strip,
    "P3": blocks,
    "P3f": partial(blocks, friction=0.3),
    "P4": transient,
    "P4x2": partial(transient, load=2000.0),
}
#: What a program that can do the one can do too.
LIKE = {"P3f": "P3", "P4x2": "P4"}
#: Elements across (P1, P4: the height; P2: an eighth of the hole), linear and quadratic.
SIZES: dict[str, dict[str, tuple[int, int]]] = {
    "P1": {
        "400": (4, 2),
        "4k": (14, 8),
        "40k": (45, 26),
        "250k": (111, 64),
        "400k": (141, 81),
        "1M": (223, 129),
    },
    "P2": {"400": (8, 5), "4k": (26, 15), "40k": (85, 49), "400k": (267, 154), "1M": (422, 244)},
}
SIZES["P3"] = {k: (n, n) for k, n in {"1k": 10, "4k": 20, "33k": 57, "200k": 141}.items()}
SIZES["P3f"] = SIZES["P3"]
SIZES["P4"] = SIZES["P4x2"] = SIZES["P1"]
#: Increments that are run where the whole problem would take the peers hours.
LAST: dict[str, dict[str, int]] = {
    "P1": {"40k": 1, "250k": 1, "400k": 1, "1M": 1},
    "P2": {"40k": 2, "400k": 1, "1M": 1},
    "P3": {"200k": 1},
    "P3f": {"200k": 1},
    "P4": {"4k": 20, "40k": 2, "250k": 1, "400k": 1, "1M": 1},
    "P4x2": {"40k": 2, "250k": 1, "400k": 1, "1M": 1},
}


def build(name: str, size: str, order: int = 1, last: int | None = None) -> Problem:
    """A problem of one of the named sizes, with the increments of :data:`LAST`."""
    run = LAST[name].get(size, 0) if last is None else last
    return BUILDERS[name](SIZES[name][size][order - 1], order, run)

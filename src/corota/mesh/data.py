"""Planar meshes: points, cells by kind, named sets of nodes, cells and edges."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from itertools import accumulate
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Bools, Floats, Ints, distinct
from corota.display import CELLS_DRAWN, Brief, picture, table
from corota.errors import InputError
from corota.lazy import lazy
from corota.mesh import geometric, selection
from corota.mesh.kinds import EDGES, N_NODES, SIDES
from corota.names import choose, did_you_mean, listed, match

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


# Conveniences: functions of higher layers, which load at their first call.
draw_model = lazy("corota.plots:model")
mesh_grid = lazy("corota.io.vtk.pyvista_bridge:mesh_grid")
mesh_of = lazy("corota.io.meshio_bridge:from_meshio")
to_meshio = lazy("corota.io.meshio_bridge:to_meshio")


@dataclass(repr=False)
class Cells(Brief):
    """Cells of one kind.

    Parameters
    ----------
    kind : str
        A key of :data:`corota.mesh.kinds.KINDS`.
    nodes : ndarray of int, shape (n_cells, n_nodes)
        Indices into the points, from 0.
    labels : ndarray of int, shape (n_cells,)
        The user's element numbers.
    """

    kind: str
    nodes: Ints
    labels: Ints

    def __post_init__(self) -> None:
        self.kind = choose(self.kind, N_NODES, "kind of cell")
        self.nodes, self.labels = np.asarray(self.nodes), np.asarray(self.labels)
        if self.nodes.size and not np.issubdtype(self.nodes.dtype, np.integer):
            raise InputError(f"nodes of cells are whole numbers, not {self.nodes.dtype}")
        wanted = N_NODES[self.kind]
        if self.nodes.ndim != 2 or self.nodes.shape[1] != wanted:
            raise InputError(
                f"a {self.kind} has {wanted} nodes: its table has shape (n, {wanted}), not "
                f"{self.nodes.shape}"
            )
        if self.labels.shape != (len(self.nodes),):
            raise InputError(
                f"{len(self.nodes)} cells need as many labels, not {self.labels.shape}"
            )

    def __len__(self) -> int:
        return len(self.nodes)


@dataclass(repr=False)
class Mesh(Brief):
    """Points and cells with the user's numbers and named sets.

    A cell has one global index: blocks are numbered one after the other.

    Parameters
    ----------
    points : ndarray, shape (n_nodes, 2)
        Reference coordinates [length].
    cells : list of Cells
    node_labels : ndarray of int, shape (n_nodes,)
        The user's node numbers.
    node_sets : dict of str to ndarray of int
        Node indices, in the user's order.
    cell_sets : dict of str to ndarray of int
        Global cell indices.
    edge_sets : dict of str to ndarray of int, shape (n, 2)
        Pairs of global cell index and local edge (from 0).
    notes : list of str
        Notes of a reader: what it repaired or dropped.
    """

    points: Floats
    cells: list[Cells]
    node_labels: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    node_sets: dict[str, Ints] = field(default_factory=dict)
    cell_sets: dict[str, Ints] = field(default_factory=dict)
    edge_sets: dict[str, Ints] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.points = np.ascontiguousarray(self.points, dtype=np.float64)
        if self.points.ndim != 2 or self.points.shape[1] != 2:
            raise InputError(f"points must have shape (n, 2), not {self.points.shape}")
        if not np.isfinite(self.points).all():
            bad = int(np.flatnonzero(~np.isfinite(self.points).all(axis=1))[0])
            raise InputError(f"point {bad} is not finite: {self.points[bad]}")
        if len(self.points) and np.abs(self.points).max() > 1e100:
            raise InputError("a coordinate exceeds 1e100")
        if len(self.node_labels) == 0:
            self.node_labels = np.arange(1, self.n_nodes + 1)
        for block in self.cells:
            low, high = block.nodes.min(initial=0), block.nodes.max(initial=-1)
            if low < 0 or high >= self.n_nodes:
                raise InputError(
                    f"a {block.kind} has node {low if low < 0 else high}; there are "
                    f"{self.n_nodes}, counted from 0"
                )

    @property
    def n_nodes(self) -> int:
        return len(self.points)

    @property
    def n_cells(self) -> int:
        return sum(len(c) for c in self.cells)

    @property
    def offsets(self) -> Ints:
        """Global index of the first cell of each block, and the total; shape (n_blocks + 1,)."""
        return np.array([0, *accumulate(len(c) for c in self.cells)], np.int64)

    @property
    def cell_labels(self) -> Ints:
        """User's element numbers by global cell index, shape (n_cells,)."""
        if not self.cells:
            return np.zeros(0, np.int64)
        return np.concatenate([c.labels for c in self.cells])

    def locate(self, cell: int) -> tuple[int, int]:
        """Block number and row in the block of a global cell index."""
        block = int(np.searchsorted(self.offsets, cell, side="right")) - 1
        return block, cell - int(self.offsets[block])

    def edge_nodes(self, edges: ArrayLike) -> list[Ints]:
        """Node indices of edges: for each, (first, last[, middle]).

        Parameters
        ----------
        edges : array_like of int, shape (n, 2)
            Pairs of global cell index and local edge.
        """
        edges = np.asarray(edges, dtype=np.int64).reshape(-1, 2)
        offsets, found = self.offsets, []
        blocks = np.searchsorted(offsets, edges[:, 0], side="right") - 1
        rows = edges[:, 0] - offsets[blocks]
        for block, row, side in zip(blocks, rows, edges[:, 1].tolist(), strict=True):
            cells = self.cells[block]
            found.append(cells.nodes[row, list(SIDES[cells.kind][side])])
        return found

    def are_lines(self, cells: Ints) -> Bools:
        """Which of some cells are lines of two nodes."""
        kinds = np.repeat([c.kind == "line2" for c in self.cells], [len(c) for c in self.cells])
        return np.asarray(kinds[cells], bool)

    def line_sides(self, cells: Ints) -> Ints:
        """Lines as edges that follow each other where they can, shape (n, 2)."""
        cells = np.unique(cells)
        ends = np.array([n[:2] for n in self.edge_nodes(np.stack([cells, 0 * cells], axis=1))])
        at: dict[int, list[int]] = {}
        for k, pair in enumerate(ends.tolist()):
            for node in pair:
                at.setdefault(node, []).append(k)
        side = np.full(len(cells), -1, np.int64)
        # From free ends first, then round what is closed.
        for start in sorted(range(len(cells)), key=lambda k: min(len(at[n]) for n in ends[k])):
            if side[start] >= 0:
                continue
            side[start] = 0 if len(at[int(ends[start, 0])]) != 2 else 1
            k, node = start, int(ends[start, 1 - side[start]])
            while len(at[node]) == 2:
                k = at[node][0] if at[node][1] == k else at[node][1]
                if side[k] >= 0:
                    break
                side[k] = 0 if ends[k, 0] == node else 1
                node = int(ends[k, 1 - side[k]])
        return np.stack([cells, side], axis=1)

    def cell_edges(self) -> tuple[Ints, Ints]:
        """A number for the ends of every edge of the cells, and the pairs (cell, local edge)."""
        keys, pairs = [np.zeros(0, np.int64)], [np.zeros((0, 2), np.int64)]
        for offset, cells in zip(self.offsets, self.cells, strict=False):
            rows = np.arange(len(cells), dtype=np.int64) + offset
            for side, local in enumerate(EDGES[cells.kind]):
                keys.append(self._edge_key(cells.nodes[:, local[:2]]))
                pairs.append(np.stack([rows, np.full(len(cells), side, np.int64)], axis=1))
        return np.concatenate(keys), np.concatenate(pairs)

    def boundary_edges(self) -> Ints:
        """Edges that belong to one cell only, shape (n, 2)."""
        keys, pairs = self.cell_edges()
        _, first, count = np.unique(keys, return_index=True, return_counts=True)
        return np.asarray(pairs[np.sort(first[count == 1])])

    def edges_between(self, ends: ArrayLike) -> Ints:
        """Find the cell edges with given end nodes.

        Parameters
        ----------
        ends : array_like of int, shape (n, 2)
            Node indices, in any direction.

        Returns
        -------
        ndarray of int, shape (n, 2)
            Global cell index and local edge; of two cells the first one; -1 where no cell has
            such an edge.
        """
        every, pairs = self.cell_edges()
        order = np.argsort(every, kind="stable")
        every = every[order]
        wanted = self._edge_key(np.asarray(ends, dtype=np.int64).reshape(-1, 2))
        found = np.full((len(wanted), 2), -1, np.int64)
        if len(every):
            at = np.minimum(np.searchsorted(every, wanted), len(every) - 1)
            hit = every[at] == wanted
            found[hit] = pairs[order[at[hit]]]
        return found

    def _edge_key(self, ends: Ints) -> Ints:
        ends = np.sort(ends, axis=1)
        return np.asarray(ends[:, 0] * np.int64(self.n_nodes) + ends[:, 1])

    def set_name(self, name: str, *kinds: str) -> str:
        """Name of a set, found regardless of case.

        Parameters
        ----------
        name : str
        *kinds : str
            ``"node"``, ``"edge"``, ``"cell"``: the accepted kinds of sets; all by default.

        Raises
        ------
        InputError
            If there is no such set: with the nearest name, and all of them.
        """
        kinds = kinds or ("node", "edge", "cell")
        if any(name in getattr(self, f"{kind}_sets") for kind in kinds):
            return name
        if isinstance(name, str) and geometric.is_selection(name) and name not in self.node_sets:
            self._add_selection(name)
            return self.set_name(name, *kinds)
        names = dict.fromkeys(n for kind in kinds for n in getattr(self, f"{kind}_sets"))
        found = match(str(name), names)
        if found is not None:
            return found
        other = dict.fromkeys([*self.node_sets, *self.edge_sets, *self.cell_sets])
        hint = did_you_mean(name, names)
        if not hint and name in other:
            kind = next(k for k in ("node", "edge", "cell") if name in getattr(self, f"{k}_sets"))
            hint = f"; there is {'an' if kind == 'edge' else 'a'} {kind} set of that name"
        what = f"{kinds[0]} set" if len(kinds) == 1 else "set"
        raise InputError(f"no {what} named {name!r}; the mesh has: {listed(names)}{hint}")

    def _add_selection(self, name: str) -> None:
        """Add the sets of a selection by geometry, under its name."""
        chosen = geometric.selected(name, self.points)
        self.node_sets[name] = np.flatnonzero(chosen)
        if geometric.is_point(name):
            return
        boundary = self.boundary_edges()
        # A middle node of a straight-sided cell lies off a circle: the ends of an edge decide.
        within = [bool(chosen[nodes[:2]].all()) for nodes in self.edge_nodes(boundary)]
        if any(within):
            self.edge_sets[name] = boundary[within]
        if geometric.is_area(name):
            full = [chosen[block.nodes].all(axis=1) for block in self.cells]
            cells = np.flatnonzero(np.concatenate(full)) if full else np.zeros(0, np.int64)
            if len(cells):
                self.cell_sets[name] = cells

    def nodes_of(self, name: str) -> Ints:
        """Node indices of a node, edge or cell set (first found in that order), in any case."""
        name = self.set_name(name)
        if name in self.node_sets:
            return self.node_sets[name]
        if name in self.edge_sets:
            return self.edge_set_nodes(self.edge_sets[name])
        rows, offsets = self.cell_sets[name], self.offsets
        parts = [np.zeros(0, np.int64)]
        for number, cells in enumerate(self.cells):
            inside = (rows >= offsets[number]) & (rows < offsets[number + 1])
            parts.append(cells.nodes[rows[inside] - offsets[number]].ravel())
        return np.asarray(distinct(np.concatenate(parts)))

    def node_indices(self, where: str | ArrayLike) -> Ints:
        """Node indices of a set, several sets, indices or a mask, checked; shape (n,).

        Of a list of names each node counts once, in the order of the sets.

        Raises
        ------
        InputError
            If there is no such set, or the indices are not nodes of the mesh.
        """
        if isinstance(where, str):
            return self.nodes_of(where)
        if several := selection.names(where):
            return _united([self.nodes_of(self._full(name)) for name in several])
        return selection.indices(where, "node", self.n_nodes)

    def cell_indices(self, where: str | ArrayLike) -> Ints:
        """Global cell indices of a cell set, several, indices or a mask, checked; shape (n,).

        Raises
        ------
        InputError
            If there is no such set, or these are no indices of cells of the mesh.
        """
        if isinstance(where, str):
            if where == "all" and where not in self.cell_sets:
                return np.arange(self.n_cells, dtype=np.int64)
            return self.cell_sets[self.set_name(where, "cell")]
        if several := selection.names(where):
            return _united([self.cell_indices(self._full(name, "cell")) for name in several])
        return selection.indices(where, "cell", self.n_cells)

    def _full(self, name: str, kind: str = "") -> str:
        """Name of a set that is not empty.

        Raises
        ------
        InputError
            If there is no such set, or it is empty.
        """
        if kind == "cell" and name == "all" and name not in self.cell_sets:
            return name
        found = self.set_name(name, *([kind] if kind else []))
        members = getattr(self, f"{kind}_sets")[found] if kind else self.nodes_of(found)
        if not len(members):
            raise InputError(f"{kind or 'node'} set {found!r} is empty")
        return found

    def edge_pairs(self, where: str | ArrayLike) -> Ints:
        """Edges of an edge set, several, or pairs (cell, local edge), checked; shape (n, 2).

        Raises
        ------
        InputError
            If there is no such set, or the pairs are not edges of the mesh.
        """
        if isinstance(where, str):
            return self.edge_sets[self.set_name(where, "edge")]
        if several := selection.names(where):
            return _united([self.edge_sets[self._full(name, "edge")] for name in several])
        return selection.pairs(where, self.n_cells)

    def edge_set_nodes(self, edges: Ints) -> Ints:
        """Node indices of edges (n, 2), each once, in ascending order."""
        parts, offsets = [np.zeros(0, np.int64)], self.offsets
        for number, cells in enumerate(self.cells):
            for side, local in enumerate(SIDES[cells.kind]):
                here = edges[:, 1] == side
                here &= (edges[:, 0] >= offsets[number]) & (edges[:, 0] < offsets[number + 1])
                rows = edges[here, 0] - offsets[number]
                parts.append(cells.nodes[np.ix_(rows, local)].ravel())
        return np.asarray(distinct(np.concatenate(parts)))

    # Other programs.
    def to_meshio(self) -> Any:
        """A ``meshio.Mesh`` with all sets.

        Edge sets are cells ``line`` or ``line3`` with cell sets; node and element labels are
        the data ``node label`` and ``element label``.

        Raises
        ------
        UnsupportedError
            If meshio is not installed.
        """
        return to_meshio(self)

    @staticmethod
    def from_meshio(found: Any) -> Mesh:
        """Take triangles, quadrilaterals and sets of a ``meshio.Mesh``.

        Raises
        ------
        InputError
            If the mesh is not planar or has no such cells.
        """
        mesh: Mesh = mesh_of(found, "meshio mesh")
        return mesh

    def to_pyvista(self) -> Any:
        """A ``pyvista.UnstructuredGrid`` with labels, and sets as arrays of 0 and 1.

        Raises
        ------
        ResourceError
            If PyVista is not installed (``pip install corota[view]``).
        """
        return mesh_grid(self)

    def __repr__(self) -> str:
        kinds = ", ".join(f"{len(cells):,} {cells.kind}" for cells in self.cells[:8])
        names = [len(self.node_sets), len(self.cell_sets), len(self.edge_sets)]
        return (
            f"Mesh({self.n_nodes:,} nodes, {self.n_cells:,} elements: {kinds or 'none'}; "
            f"{names[0]} node, {names[1]} element, {names[2]} edge sets)"
        )

    def _repr_html_(self) -> str:
        rows: dict[str, object] = {
            "nodes": f"{self.n_nodes:,}",
            "elements": ", ".join(f"{len(c):,} {c.kind}" for c in self.cells),
        }
        if self.n_nodes:
            low, high = self.points.min(axis=0), self.points.max(axis=0)
            rows["x"] = f"{low[0]:g} ... {high[0]:g}"
            rows["y"] = f"{low[1]:g} ... {high[1]:g}"
        for name, sets in (
            ("node sets", self.node_sets),
            ("element sets", self.cell_sets),
            ("edge sets", self.edge_sets),
        ):
            if sets:
                rows[name] = listed(sets)
        drawn = ""
        if 0 < self.n_cells <= CELLS_DRAWN:
            drawn = picture(lambda path: draw_model(self, path=path, dpi=80.0))
        return drawn + table(rows)


def _united(parts: list[Ints]) -> Ints:
    """Rows of several arrays, each once, in their order."""
    every = np.concatenate(parts)
    _, first = np.unique(every, axis=0, return_index=True)
    return np.asarray(every[np.sort(first)])

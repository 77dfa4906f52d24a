"""From a deck to a mesh: numbers looked up, cells reversed, sets resolved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Lookup
from corota.errors import Diagnostic, Location
from corota.io.deck.card import key
from corota.io.deck.elements import ELEMENTS, LINE_ELEMENTS, LINES, collapsed
from corota.mesh.data import Cells, Mesh
from corota.mesh.kinds import KINDS
from corota.mesh.quality import CLOCKWISE, FLAT, FOLDED, GOOD, classify

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.arrays import Bools, Floats, Ints
    from corota.io.deck.deck import Deck
    from corota.io.deck.drafts import AttachedDraft, ElementBlock, Instance, NodeBlock, Scope

#: Largest coordinate; areas and their products stay finite.
LARGEST = 1e100
#: Powers of ten that are added to the numbers of instances; then multiples of a smaller one.
LARGEST_OFFSET = 10**12
#: Errors of one kind that are listed individually.
MAX_LISTED = 20


#: Messages on loads and supports out of the plane.
OUT_OF_PLANE = r"\bdof [345]\b|out of (the|its) plane"


@dataclass(eq=False, repr=False)
class View:
    """One name space placed in the model: the flat deck, or an instance of a part."""

    scope: Scope
    prefix: str = ""
    instance: Instance | None = None
    nodes: Lookup = field(default_factory=lambda: Lookup(np.zeros(0, np.int64)))
    cells: Lookup = field(default_factory=lambda: Lookup(np.zeros(0, np.int64)))
    lines: Lookup = field(default_factory=lambda: Lookup(np.zeros(0, np.int64)))
    node_offset: int = 0
    cell_offset: int = 0


@dataclass(eq=False, repr=False)
class Placed:
    """Valid cells of one block."""

    kind: str
    nodes: Ints
    labels: Ints
    turned: Ints
    view: View
    block: ElementBlock
    #: Name of the element if it is not that of the block.
    type: str = ""
    #: Side of a quadrilateral that is one node, -1 for none.
    side: int = -1


class MeshBuilder:
    """Builds the mesh of a deck; faults go to ``deck.diagnostics``.

    Attributes
    ----------
    views : list of View
        The flat deck first, then the instances.
    types : list of str
        Names of deck elements that occur.
    cell_type : ndarray of int, shape (n_cells,)
        Index into ``types``.
    turned : ndarray of bool, shape (n_cells,)
        Cells given clockwise.
    side : ndarray of int, shape (n_cells,)
        Side of the deck's quadrilateral that is one node, -1 for none.
    line_nodes : list of ndarray of int
        Nodes of each line element that is not a truss.
    twin : ndarray of int, shape (n_cells,)
        Second half of a beam of three nodes, -1 for others.
    """

    def __init__(self, deck: Deck) -> None:
        self.deck = deck
        self.views = [View(deck.root)]
        for instance in deck.instances.values():
            scope = deck.parts[instance.part].joined(instance.scope)
            self.views.append(View(scope, instance.name + ".", instance))
        self.types: list[str] = []
        self.cell_type: Ints = np.zeros(0, np.int64)
        self.out_of_plane = False
        self.turned = np.zeros(0, bool)
        self.side: Ints = np.zeros(0, np.int64)
        self.line_nodes: list[Ints] = []
        self.line_types: list[str] = []
        self.twin: Ints = np.zeros(0, np.int64)
        self._halves: list[tuple[View, Ints, Ints]] = []

    def build(self) -> Mesh:
        """Nodes and cells, without sets."""
        points, labels = self._nodes()
        blocks = self._cells(points)
        kinds = list(dict.fromkeys(block.kind for block in blocks))
        cells, order = [], []
        for kind in kinds:
            same = [block for block in blocks if block.kind == kind]
            order += same
            cells.append(
                Cells(
                    kind,
                    np.concatenate([b.nodes for b in same]),
                    np.concatenate([b.labels + b.view.cell_offset for b in same]),
                )
            )
        self._index_cells(order)
        return Mesh(points, cells, labels)

    def _nodes(self) -> tuple[Floats, Ints]:
        points, labels, start, largest = [np.zeros((0, 2))], [np.zeros(0, np.int64)], 0, 0
        out_of_plane = 0.0
        for view in self.views:
            blocks = view.scope.nodes
            if not blocks:
                continue
            own = np.concatenate([b.labels for b in blocks])
            xyz = np.concatenate([b.points for b in blocks])
            self._check_size(blocks, own, xyz)
            keep = self._unique_nodes(blocks, own, xyz)
            own, xyz = own[keep], xyz[keep]
            out_of_plane = max(out_of_plane, self._check_plane(blocks, own, xyz))
            view.nodes = Lookup(own, np.arange(start, start + len(own)))
            view.node_offset = self._offset(view, own, largest, "nodes")
            largest = max(largest, int(own.max()) + view.node_offset)
            points.append(placed(xyz[:, :2], view.instance))
            labels.append(own + view.node_offset)
            start += len(own)
        if start == 0:
            self.deck.error(None, None, "the deck has no nodes")
        elif out_of_plane > 0.0:
            self.deck.note(
                f"z coordinates up to {out_of_plane:g} are taken as 0: the part lies in the plane"
            )
        return np.concatenate(points), np.concatenate(labels)

    def _check_size(self, blocks: list[NodeBlock], labels: Ints, xyz: Floats) -> None:
        far = np.flatnonzero((np.abs(xyz) > LARGEST).any(axis=1))
        for at in far[:MAX_LISTED]:
            self._fault(
                _where(blocks, int(at)),
                f"node {labels[at]}: a coordinate exceeds {LARGEST:g}",
                "*NODE",
            )
        xyz[far] = 0.0

    def _offset(self, view: View, labels: Ints, largest: int, what: str) -> int:
        if largest == 0 or view.instance is None:
            return 0
        offset: int = 10 ** len(str(largest))
        if offset > LARGEST_OFFSET:
            step = 10 ** len(str(int(labels.max())))
            offset = (largest // step + 1) * step
        self.deck.note(
            f"instance {view.instance.name}: {offset} is added to the numbers of its {what}"
        )
        return int(offset)

    def _unique_nodes(self, blocks: list[NodeBlock], labels: Ints, xyz: Floats) -> Ints:
        order = np.argsort(labels, kind="stable")
        same = np.flatnonzero(np.diff(labels[order]) == 0)
        if not len(same):
            return np.arange(len(labels))
        second, first = order[same + 1], order[same]
        differ = (xyz[second] != xyz[first]).any(axis=1)
        for at, before in zip(second[differ][:MAX_LISTED], first[differ], strict=False):
            self._fault(
                _where(blocks, int(at)),
                f"node {labels[at]} is already defined with other "
                f"coordinates ({_where(blocks, int(before))})",
                "*NODE",
            )
        self._more(differ.sum(), "nodes are defined twice")
        if not differ.any():
            self.deck.note(f"{len(same)} nodes are given twice with the same coordinates")
        keep = np.ones(len(labels), bool)
        keep[second] = False
        return np.flatnonzero(keep)

    def _check_plane(self, blocks: list[NodeBlock], labels: Ints, xyz: Floats) -> float:
        size = float(np.ptp(xyz[:, :2], axis=0).max()) if len(xyz) else 0.0
        out = np.abs(xyz[:, 2])
        bad = np.flatnonzero(out > 1e-6 * size)
        for at in bad[:1]:
            place = next(
                Location(b.file, int(b.lines[np.flatnonzero(b.labels == labels[at])[0]]))
                for b in blocks
                if (b.labels == labels[at]).any()
            )
            other = next((i for i in (0, 1) if np.ptp(xyz[:, i]) <= 1e-6 * np.ptp(xyz[:, 2])), None)
            turn = "" if other is None else f": exchange {'xy'[other]} and z in the whole deck"
            self._fault(
                place,
                f"node {labels[at]} has z = {xyz[at, 2]:g}; the part must lie in the plane z = 0"
                + (f" ({len(bad)} nodes in all)" if len(bad) > 1 else "")
                + turn,
                "*NODE",
            )
            # Elements without area, and loads and supports out of the plane, have this cause.
            self.out_of_plane = True
            self.deck.refused_types.add("out of the plane")
            self.deck.diagnostics = [
                d for d in self.deck.diagnostics if not re.search(OUT_OF_PLANE, d.message)
            ]
        return 0.0 if len(bad) else float(out.max(initial=0.0))

    def _cells(self, points: Floats) -> list[Placed]:
        placed: list[Placed] = []
        largest, n_turned, example = 0, 0, 0
        for view in self.views:
            blocks = view.scope.elements
            if not blocks:
                continue
            own = np.concatenate([b.labels for b in blocks])
            repeated = self._repeated(blocks, own)
            view.cell_offset = self._offset(view, own, largest, "elements")
            largest = max(largest, int(own.max()) + view.cell_offset)
            line_labels, line_rows = [], []
            trusses = _truss_labels(view.scope)
            for block in blocks:
                nodes = self._nodes_of(view, block)
                good = self._known(block, nodes)
                if repeated is not None:
                    good &= ~np.isin(block.labels, repeated)
                if block.type in LINE_ELEMENTS:
                    placed += self._line_elements(view, block, nodes, good)
                    continue
                if block.type in LINES:
                    truss = good & np.isin(block.labels, trusses)
                    good &= ~truss
                    if truss.any():
                        placed += self._trusses(view, block, nodes, truss)
                    for at in np.flatnonzero(good):
                        line_labels.append(int(block.labels[at]))
                        line_rows.append(len(self.line_nodes))
                        self.line_nodes.append(nodes[at])
                        self.line_types.append(block.type)
                    continue
                kind = ELEMENTS[block.type].kind
                twice = _twice(nodes)
                if kind in ("quad4", "quad8") and twice.any():
                    for part in self._collapsed(view, block, nodes, good, points):
                        placed.append(part)
                        n_turned += int(part.turned.sum())
                    if len(good) and not good.any():
                        continue
                good &= self._distinct(block, nodes, good, twice)
                shape = np.zeros(len(nodes), np.int64)
                shape[good] = classify(kind, points[nodes[good]])
                self._bad_shapes(block, shape)
                good &= (shape != FLAT) & (shape != FOLDED)
                turned = shape == CLOCKWISE
                nodes[turned] = nodes[turned][:, KINDS[kind].reversal]
                if turned.any():
                    n_turned += int(turned.sum())
                    example = example or int(block.labels[np.flatnonzero(turned)[0]])
                placed.append(
                    Placed(kind, nodes[good], block.labels[good], turned[good], view, block)
                )
            view.lines = Lookup(
                np.array(line_labels, dtype=np.int64), np.array(line_rows, dtype=np.int64)
            )
        if n_turned:
            self.deck.note(
                f"{n_turned} clockwise elements (such as {example}) are turned; their faces keep "
                "the numbers of the deck"
            )
        if self.line_nodes:
            self.deck.note(
                f"{len(self.line_nodes)} line elements are not computed; their sets become edge "
                "sets"
            )
        if not placed:
            self.deck.error(None, None, "the deck has no elements")
        return placed

    def _nodes_of(self, view: View, block: ElementBlock) -> Ints:
        """Node indices of a block, -1 for unknown ones; of instances too, where it names them."""
        nodes = view.nodes(block.nodes)
        for at in zip(*np.nonzero(block.nodes < 0), strict=True):
            name = -1 - int(block.nodes[at])
            if name >= len(self.deck.instance_nodes):  # a negative label of the deck
                continue
            found = view_of(self.views, self.deck.instance_nodes[name])
            if found is not None:
                nodes[at] = found[0].nodes(np.array([int(found[1])]))[0]
        return nodes

    def _trusses(self, view: View, block: ElementBlock, nodes: Ints, mine: Ints) -> list[Placed]:
        if LINES[block.type] != 2:
            at = int(np.flatnonzero(mine)[0])
            self._block_fault(block, at, f"trusses have two nodes here; use {block.type[:-1]}2")
            return []
        rows = mine & self._distinct(block, nodes)
        still = np.zeros(int(rows.sum()), np.int64)
        return [Placed("line2", nodes[rows], block.labels[rows], still, view, block)]

    def _line_elements(
        self, view: View, block: ElementBlock, nodes: Ints, good: Ints
    ) -> list[Placed]:
        """Cells of beams and springs; beams of three nodes become two."""
        info = LINE_ELEMENTS[block.type]
        if block.nodes.shape[1] > 1:
            good = good & self._distinct(block, nodes)
        nodes, labels = nodes[good], block.labels[good]
        still = np.zeros(len(labels), np.int64)
        if info.n_nodes < 3:
            return [Placed(info.kind, nodes, labels, still, view, block)]
        if not len(labels):
            return []
        every = np.concatenate([b.labels for b in view.scope.elements])
        second = labels + 10 ** len(str(int(every.max())))
        self.deck.note(
            f"{block.type} elements are two beams of two nodes each; the second has a number from "
            f"{int(second.min())} on"
        )
        self._halves.append((view, labels, second))
        return [
            Placed(info.kind, nodes[:, :2], labels, still, view, block),
            Placed(info.kind, nodes[:, 1:], second, still, view, block),
        ]

    def _repeated(self, blocks: list[ElementBlock], labels: Ints) -> Ints | None:
        order = np.argsort(labels, kind="stable")
        same = np.flatnonzero(np.diff(labels[order]) == 0)
        for at in same[:MAX_LISTED]:
            second, first = int(order[at + 1]), int(order[at])
            self._fault(
                _where(blocks, second),
                f"element {labels[second]} is already defined ({_where(blocks, first)})",
                "*ELEMENT",
            )
        self._more(len(same), "elements are defined twice")
        return labels[order[same]] if len(same) else None

    def _known(self, block: ElementBlock, nodes: Ints) -> Ints:
        bad = np.flatnonzero((nodes < 0).any(axis=1))
        for at in bad[:MAX_LISTED]:
            missing = block.nodes[at][nodes[at] < 0][0]
            if missing < 0 and -1 - missing < len(self.deck.instance_nodes):
                missing = self.deck.instance_nodes[-1 - missing]
            self._block_fault(block, int(at), f"node {missing} is not defined")
        self._more(len(bad), "elements have undefined nodes")
        return np.asarray((nodes >= 0).all(axis=1))

    def _collapsed(
        self, view: View, block: ElementBlock, nodes: Ints, good: Ints, points: Floats
    ) -> list[Placed]:
        """Triangles of quadrilaterals with a side of one node; they leave ``good``."""
        quadratic = nodes.shape[1] == 8
        found = []
        for side in range(4):
            twin = (side + 1) % 4
            same = good & (nodes[:, side] == nodes[:, twin])
            keep = [i for i in range(4) if i != twin]
            if quadratic:
                same &= nodes[:, 4 + side] == nodes[:, side]
                keep += [4 + i for i in range(4) if i != side]
            if not same.any():
                continue
            corners = np.sort(nodes[:, keep], axis=1)
            same &= (np.diff(corners, axis=1) > 0).all(axis=1)
            shape = np.zeros(len(nodes), np.int64)
            kind = "tri6" if quadratic else "tri3"
            triangles = nodes[:, _rotated(keep, side, quadratic)]
            shape[same] = classify(kind, points[triangles[same]])
            self._bad_shapes(block, np.where(same, shape, GOOD))
            good &= ~same
            same &= (shape != FLAT) & (shape != FOLDED)
            turned = same & (shape == CLOCKWISE)
            triangles[turned] = triangles[turned][:, KINDS[kind].reversal]
            if same.any():
                found.append(
                    Placed(
                        kind,
                        triangles[same],
                        block.labels[same],
                        turned[same],
                        view,
                        block,
                        collapsed(block.type),
                        side,
                    )
                )
        count = sum(len(part.labels) for part in found)
        if count:
            name = "six" if quadratic else "three"
            self.deck.note(
                f"{count} {block.type} elements (such as {found[0].labels[0]}) have a side of one "
                f"node; they become triangles of {name} nodes, which is the same"
                + (" except for internal terms of the element" if quadratic else "")
            )
        return found

    def _distinct(
        self,
        block: ElementBlock,
        nodes: Ints,
        among: Ints | None = None,
        twice: Bools | None = None,
    ) -> Ints:
        """Elements without a node that occurs twice; ``twice`` is known or found."""
        twice = _twice(nodes) if twice is None else twice
        if among is not None:
            twice = np.asarray(twice & among.astype(bool)[:, None], bool)
        bad = np.flatnonzero(twice.any(axis=1))
        for at in bad[:MAX_LISTED]:
            labels, counts = np.unique(block.nodes[at], return_counts=True)
            self._block_fault(block, int(at), f"node {labels[counts > 1][0]} occurs twice")
        self._more(len(bad), "elements have a node twice")
        return np.asarray(~twice.any(axis=1))

    def _bad_shapes(self, block: ElementBlock, shape: Ints) -> None:
        if self.out_of_plane:
            return
        for code, text in (
            (FLAT, "it has no area or a side of no length"),
            (FOLDED, "it is folded or inverted"),
        ):
            bad = np.flatnonzero(shape == code)
            for at in bad[:MAX_LISTED]:
                self._block_fault(block, int(at), text)
            self._more(len(bad), f"elements are bad: {text}")

    def _index_cells(self, order: list[Placed]) -> None:
        names = [block.type or block.block.type for block in order]
        self.types = list(dict.fromkeys(names))
        start = 0
        by_view: dict[int, list[tuple[Ints, Ints]]] = {}
        types, turned = [np.zeros(0, np.int64)], [np.zeros(0, bool)]
        sides = [np.zeros(0, np.int64)]
        for block, name in zip(order, names, strict=True):
            count = len(block.labels)
            rows = np.arange(start, start + count)
            by_view.setdefault(id(block.view), []).append((block.labels, rows))
            types.append(np.full(count, self.types.index(name), np.int64))
            turned.append(np.asarray(block.turned, bool))
            sides.append(np.full(count, block.side, np.int64))
            start += count
        self.cell_type, self.turned = np.concatenate(types), np.concatenate(turned)
        self.side = np.concatenate(sides)
        for view in self.views:
            parts = by_view.get(id(view))
            if parts:
                view.cells = Lookup(
                    np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])
                )
        self.twin = np.full(start, -1, np.int64)
        for view, first, second in self._halves:
            self.twin[view.cells(first)] = view.cells(second)

    def _block_fault(self, block: ElementBlock, row: int, text: str) -> None:
        where = Location(block.file, int(block.lines[row]))
        self._fault(where, f"element {block.labels[row]}: {text}", block.card.spelled)

    def _fault(self, where: Location, text: str, keyword: str) -> None:
        self.deck.diagnostics.append(Diagnostic("error", text, where, keyword))

    def _more(self, count: int, text: str) -> None:
        if count > MAX_LISTED:
            self.deck.error(None, None, f"{count} {text}; the first {MAX_LISTED} are listed")


def _twice(nodes: Ints) -> Bools:
    """Where the sorted nodes of an element repeat, shape (n, k - 1)."""
    in_order = np.sort(nodes, axis=1)
    return np.asarray((np.diff(in_order, axis=1) == 0) & (in_order[:, 1:] >= 0))


def _rotated(keep: list[int], side: int, quadratic: bool) -> list[int]:
    """Local nodes of the triangle so that each mid-side node follows its corner."""
    corners = keep[:3]
    if not quadratic:
        return corners
    # Edge i of the quadrilateral starts at corner i; the twin of the collapsed side lends its own.
    twin = (side + 1) % 4
    return corners + [4 + (twin if i == side else i) for i in corners]


def views_in(views: list[View], deck: Deck, scope: object) -> list[View]:
    """Views of a card: that of its instance, those of its part, or the assembly."""
    if scope is None or scope is deck.root:
        return views[:1]
    return [
        view
        for view in views[1:]
        if view.instance
        and (view.instance.scope is scope or deck.parts[view.instance.part] is scope)
    ]


def attached_in(views: list[View], deck: Deck) -> Iterator[tuple[View, AttachedDraft]]:
    """Each card of point masses and the like, in each of its views."""
    for draft in deck.attached:
        for view in views_in(views, deck, draft.scope):
            yield view, draft


def _truss_labels(scope: Scope) -> Ints:
    """Line elements of sets that contain only lines and have a section: trusses."""
    none = np.zeros(0, np.int64)
    curves = [none, *(b.labels for b in scope.elements if b.type in LINES)]
    every = np.concatenate(curves)

    def labels(name: str, depth: int) -> Ints:
        named = scope.elsets.get(key(name))
        if named is None or depth > 50:
            return none
        parts = [none]
        for entry in named.entries:
            own = not entry.name or entry.name.startswith("@")
            parts.append(entry.labels if own else labels(entry.name, depth + 1))
        return np.concatenate(parts)

    found = [none]
    for section in scope.sections:
        members = labels(section.elset, 0)
        if len(members) and np.isin(members, every).all():
            found.append(members)
    return np.concatenate(found)


def view_of(views: list[View], target: str) -> tuple[View, str] | None:
    """Instance and rest of a name such as ``Part-1-1.12``, or ``None``."""
    prefix, dot, rest = target.rpartition(".")
    if dot:
        for view in views[1:]:
            if key(view.prefix) == key(prefix) + ".":
                return view, rest
    return None


def placed(points: Floats, instance: Instance | None) -> Floats:
    """Shift, then rotate."""
    if instance is None:
        return points
    center = np.array(instance.center)
    return np.asarray(turned(points + np.array(instance.shift) - center, instance) + center)


def turned(directions: Floats, instance: Instance | None) -> Floats:
    """Directions that a part gives, in the assembly."""
    if instance is None:
        return directions
    c, s = math.cos(instance.angle), math.sin(instance.angle)
    return np.asarray(directions @ np.array([[c, s], [-s, c]]))


def _where(blocks: list[NodeBlock] | list[ElementBlock], row: int) -> Location:
    for block in blocks:
        if row < len(block.labels):
            return Location(block.file, int(block.lines[row]))
        row -= len(block.labels)
    raise IndexError(row)

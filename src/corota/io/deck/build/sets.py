"""Sets and surfaces of a deck: names and numbers turned into indices."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import Ints, distinct
from corota.io.deck import numerals
from corota.io.deck.build.mesh import MeshBuilder, View, attached_in, view_of
from corota.io.deck.card import Card, Refused, key, nearest
from corota.io.deck.elements import WITH_SIDES
from corota.mesh.kinds import EDGES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from corota.errors import Location
    from corota.io.deck.drafts import NamedSet, Surface, SurfaceRow
    from corota.mesh.data import Mesh

_FACE = r"([SE])(\d{1,9})\Z"
_SIDES = "a planar model takes no load out of its plane; the edges of shells are faces 3 to 6"
_NONE: Ints = np.zeros(0, np.int64)


@dataclass(slots=True, eq=False, repr=False)
class Elements:
    """Contents of an element set: cells, line elements of curves, and numbers of attached ones."""

    cells: Ints
    lines: Ints
    attached: Ints = field(default_factory=lambda: _NONE)


class Sets:
    """Looks up sets, surfaces and single numbers by the names of the deck.

    Parameters
    ----------
    builder : MeshBuilder
        After :meth:`MeshBuilder.build`.
    mesh : Mesh
        Receives the sets.
    """

    def __init__(self, builder: MeshBuilder, mesh: Mesh) -> None:
        self.deck, self.mesh, self.views = builder.deck, mesh, builder.views
        self.turned, self.line_nodes = builder.turned, builder.line_nodes
        self.line_types = builder.line_types
        self.side = builder.side
        sided = [name in WITH_SIDES for name in builder.types]
        #: Whether a cell is a shell or membrane, whose edges are its faces from the third on.
        self.sided = np.array([*sided, False])[builder.cell_type]
        self.twin = builder.twin
        self.nsets: dict[str, tuple[View, NamedSet]] = {}
        self.elsets: dict[str, tuple[View, NamedSet]] = {}
        self.surfaces: dict[str, tuple[View, Surface]] = {}
        for view in self.views:
            prefix = key(view.prefix)
            for mine, theirs in (
                (self.nsets, view.scope.nsets),
                (self.elsets, view.scope.elsets),
                (self.surfaces, view.scope.surfaces),
            ):
                for name, found in theirs.items():
                    mine[prefix + name] = (view, found)  # type: ignore[assignment]
        #: Numbers of point masses and dashpots, from 0, by prefix and label, and by set.
        self.attached: dict[tuple[str, int], int] = {}
        self.attached_sets: dict[str, list[int]] = {}
        number = 0
        for view, draft in attached_in(self.views, self.deck):
            for label in draft.labels:
                self.attached[view.prefix, label] = number
                full = key(view.prefix) + key(draft.name)
                self.attached_sets.setdefault(full, []).append(number)
                number += 1
        #: Labels without nodes, by set: name, labels, place.
        self.missing: list[tuple[str, Ints, Location]] = []
        self._nodes: dict[str, Ints | None] = {}
        self._elements: dict[str, Elements | None] = {}
        self._edges: dict[str, Ints] = {}

    def fill(self) -> None:
        """Resolve every set and surface, and put them into the mesh."""
        for full, (view, named) in self.nsets.items():
            nodes = self.node_set(full)
            if nodes is not None:
                self.mesh.node_sets[view.prefix + named.name] = nodes
        for full, (view, named) in self.elsets.items():
            found = self.element_set(full)
            if found is None:
                continue
            name = view.prefix + named.name
            if len(found.cells) or not len(found.lines):
                self.mesh.cell_sets[name] = found.cells
            if len(found.lines):
                edges = self._edges_of_lines(found.lines)
                if len(edges):
                    self.mesh.edge_sets.setdefault(name, edges)
                self.mesh.node_sets.setdefault(
                    name, _unique(np.concatenate([self.line_nodes[i] for i in found.lines]))
                )
        for full, (view, surface) in self.surfaces.items():
            name = view.prefix + surface.name
            if key(surface.card.value("TYPE")) == "SEGMENTS":
                continue
            if surface.nodes:
                self.mesh.node_sets[name] = self._node_surface(view, surface)
            else:
                self.mesh.edge_sets[name] = self._edge_surface(full)

    def spelled(self, table: dict[str, tuple[View, NamedSet]], full: str) -> str:
        """Name under which a set is in the mesh."""
        view, named = table[full]
        return view.prefix + named.name

    def full_name(self, table: Mapping[str, object], view: View, name: str) -> str:
        """Key of a set seen from a view, empty if there is none.

        A name unknown to the view is that of the only instance that has it.
        """
        for candidate in (key(view.prefix) + key(name), key(name)):
            if candidate in table:
                return candidate
        return _only(key(name), table)

    def mesh_name(self, table: Mapping[str, object], view: View, name: str) -> str:
        """Name of a set or surface of the mesh seen from a view, empty if there is none."""
        keys = {key(spelled): spelled for spelled in table}
        for candidate in (key(view.prefix) + key(name), key(name)):
            if candidate in keys:
                return keys[candidate]
        return keys.get(_only(key(name), keys), "")

    def node_set(self, full: str) -> Ints | None:
        """Node indices of a set; ``None`` after an error."""
        if full not in self._nodes:
            self._nodes[full] = None  # a set that occurs within itself is circular
            view, named = self.nsets[full]
            self._nodes[full] = self._resolve_nodes(view, named)
        return self._nodes[full]

    def _resolve_nodes(self, view: View, named: NamedSet) -> Ints:
        parts = [_NONE]
        for entry in named.entries:
            if entry.name.startswith("elset:"):
                found = self.nodes_of_elements(view, entry.name[6:], entry.where, None)
                if found is not None:
                    parts.append(found)
                continue
            if entry.name and not entry.name.startswith("@"):
                nodes = self._named_nodes(view, entry.name, entry.where)
                if nodes is not None:
                    parts.append(nodes)
                continue
            at = view_of(self.views, entry.name[1:] + "0") if entry.name else None
            nodes = (at[0] if at else view).nodes(entry.labels)
            # Programs omit such nodes from a set; whether that is harmless depends on its use.
            self.missing.append((named.name, entry.labels[nodes < 0], entry.where))
            parts.append(nodes[nodes >= 0])
        return _unique(np.concatenate(parts))

    def _named_nodes(self, view: View, name: str, where: Location) -> Ints | None:
        full = self.full_name(self.nsets, view, name)
        if full:
            if full in self._nodes and self._nodes[full] is None:
                self.deck.error(None, where, f"node set {name} contains itself")
            return self.node_set(full)
        found = view_of(self.views, name)
        if found and numerals.is_label(found[1]):
            nodes = found[0].nodes(np.array([int(found[1])]))
            if nodes[0] >= 0:
                return nodes
        hint = nearest(name, [self.spelled(self.nsets, n) for n in self.nsets])
        self.deck.error(None, where, f"no node set named {numerals.shown(name)}", hint=hint)
        return None

    def nodes_of_elements(
        self, view: View, name: str, where: Location, card: Card | None
    ) -> Ints | None:
        """Nodes of the elements of a set or a number; ``None`` after an error."""
        found = self.elements(view, name, where, card)
        if found is None:
            return None
        parts = [self.line_nodes[i] for i in found.lines]
        blocks, offsets = self.mesh.cells, self.mesh.offsets
        for number, block in enumerate(blocks):
            inside = (found.cells >= offsets[number]) & (found.cells < offsets[number + 1])
            parts.append(block.nodes[found.cells[inside] - offsets[number]].ravel())
        return distinct(np.concatenate([_NONE, *parts]))

    def element_set(self, full: str) -> Elements | None:
        """Cells and lines of a set; ``None`` after an error."""
        if full not in self._elements:
            self._elements[full] = None
            view, named = self.elsets[full]
            self._elements[full] = self._resolve_elements(view, named)
        return self._elements[full]

    def _resolve_elements(self, view: View, named: NamedSet) -> Elements:
        cells, lines, attached = [_NONE], [_NONE], [_NONE]
        lost: list[tuple[Ints, Location]] = []
        for entry in named.entries:
            if entry.name and not entry.name.startswith("@"):
                found = self.elements(view, entry.name, entry.where, None)
                if found is not None:
                    cells.append(found.cells)
                    lines.append(found.lines)
                    attached.append(found.attached)
                continue
            at = view_of(self.views, entry.name[1:] + "0") if entry.name else None
            place = at[0] if at else view
            rows, curves = place.cells(entry.labels), place.lines(entry.labels)
            known = np.where(rows >= 0, rows, curves)
            other = entry.labels[known < 0]
            if len(other):
                own = [self.attached.get((place.prefix, i), -1) for i in other.tolist()]
                numbers = np.array(own, np.int64)
                attached.append(numbers[numbers >= 0])
                other = other[numbers < 0]
            if len(other):
                lost.append((other, entry.where))
            cells.append(rows[rows >= 0])
            lines.append(curves[curves >= 0])
        if lost:
            bad = np.concatenate([labels for labels, _ in lost])
            self._say_undefined(bad, lost[0][1], "element", named.name, False)
        whole = self._with_halves(_unique(np.concatenate(cells)))
        rest = _unique(np.concatenate(attached))
        return Elements(whole, _unique(np.concatenate(lines)), rest)

    def _with_halves(self, cells: Ints) -> Ints:
        """Cells with the second halves of beams of three nodes."""
        twins = self.twin[cells] if len(self.twin) else _NONE
        return _unique(np.concatenate([cells, twins[twins >= 0]]))

    def elements(
        self, view: View, target: str, where: Location, card: Card | None, text: str = ""
    ) -> Elements | None:
        """Cells and lines of a set name or an element number."""
        if numerals.is_integer(target):
            found: tuple[View, str] | None = (view, target)
        else:
            full = self.full_name(self.elsets, view, target)
            if full:
                if full in self._elements and self._elements[full] is None:
                    self.deck.error(card, where, f"element set {target} contains itself")
                return self.element_set(full)
            full = self.full_name(self.attached_sets, view, target)
            if full:
                return Elements(_NONE, _NONE, np.array(self.attached_sets[full]))
            found = view_of(self.views, target)
        if found and numerals.is_label(found[1]):
            label = np.array([int(found[1])])
            cells, lines = found[0].cells(label), found[0].lines(label)
            if cells[0] >= 0 or lines[0] >= 0:
                return Elements(self._with_halves(cells[cells >= 0]), lines[lines >= 0])
            for place in (found[0], self.views[0]):
                if (place.prefix, int(label[0])) in self.attached:
                    number = self.attached[place.prefix, int(label[0])]
                    return Elements(_NONE, _NONE, np.array([number]))
            self.deck.error(card, where, f"element {target} is not defined", text=text)
            return None
        hint = nearest(target, [self.spelled(self.elsets, n) for n in self.elsets])
        self.deck.error(
            card, where, f"no element set named {numerals.shown(target)}", text=text, hint=hint
        )
        return None

    def report_missing(self, used: set[str]) -> None:
        """Refuse undefined nodes in sets that supports, loads or constraints use.

        Parameters
        ----------
        used : set of str
            Keys of the names that they use.
        """
        for view in self.views:
            for named in view.scope.nsets.values():
                used = used | {key(entry.name) for entry in named.entries}
        for name, labels, where in self.missing:
            self._say_undefined(labels, where, "node", name, key(name) not in used)

    def _say_undefined(
        self, bad: Ints, where: Location, what: str, name: str, harmless: bool = False
    ) -> None:
        if len(bad):
            more = f" and {len(bad) - 1} others" if len(bad) > 1 else ""
            text = f"{what} {bad[0]}{more} in set {name}: not defined in the deck"
            severity = "warning" if self.deck.lenient or harmless else "error"
            self.deck.error(None, where, text, severity=severity)

    def _node_surface(self, view: View, surface: Surface) -> Ints:
        parts = [_NONE]
        for row in surface.rows:
            if numerals.is_label(row.target):
                label = np.array([int(row.target)])
                nodes = view.nodes(label)
                self._say_undefined(label[nodes < 0], row.where, "node", surface.name)
                parts.append(nodes[nodes >= 0])
            else:
                found = self._named_nodes(view, row.target, row.where)
                if found is not None:
                    parts.append(found)
        return _unique(np.concatenate(parts))

    def _edge_surface(self, full: str) -> Ints:
        """Edges of a surface, also of one that others make."""
        if full not in self._edges:
            view, surface = self.surfaces[full]
            self._edges[full] = np.zeros((0, 2), np.int64)  # while it is open
            made = self._combined if surface.combine else self._surface
            self._edges[full] = made(view, surface)
        return self._edges[full]

    def _combined(self, view: View, surface: Surface) -> Ints:
        """Union, difference or intersection of surfaces."""
        out: Ints | None = None
        for row in surface.rows:
            full = self.full_name(self.surfaces, view, row.target)
            if not full or self.surfaces[full][1].nodes:
                text = f"no surface of edges named {numerals.shown(row.target)}"
                hint = nearest(row.target, [s.name for _, s in self.surfaces.values()])
                self.deck.error(surface.card, row.where, text, text=row.text, hint=hint)
                continue
            edges = self._edge_surface(full)
            if out is None:
                out = edges
                continue
            inside = (out[:, None] == edges[None]).all(axis=2).any(axis=1)
            if surface.combine == "UNION":
                extra = (edges[:, None] == out[None]).all(axis=2).any(axis=1)
                out = np.concatenate([out, edges[~extra]])
            else:
                out = out[inside if surface.combine == "INTERSECTION" else ~inside]
        return out if out is not None else np.zeros((0, 2), np.int64)

    def _surface(self, view: View, surface: Surface) -> Ints:
        parts = [np.zeros((0, 2), np.int64)]
        for row in surface.rows:
            found = self.elements(view, row.target, row.where, surface.card, row.text)
            if found is None:
                continue
            if len(found.lines):
                rigid = np.array([self.line_types[i] == "R2D2" for i in found.lines])
                parts.append(self._edges_of_lines(found.lines[~rigid]))
                if rigid.all() and not len(found.cells):
                    continue  # sides of a rigid body: contact takes them as a curve
            with suppress(Refused):
                parts.append(self._row_edges(row, found.cells))
        edges = np.concatenate(parts)
        if len(edges) and self.mesh.are_lines(edges[:, 0]).all():
            return self.mesh.line_sides(edges[:, 0])
        _, first = np.unique(edges, axis=0, return_index=True)
        return edges[np.sort(first)]

    def rigid_sides(self, view: View, surface: Surface) -> list[tuple[SurfaceRow, Ints]]:
        """Rows of a surface that name sides of rigid bodies (R2D2), with their lines."""
        found: list[tuple[SurfaceRow, Ints]] = []
        for row in surface.rows if not surface.combine else ():
            elements = self.elements(view, row.target, row.where, surface.card, row.text)
            if elements is not None and len(elements.lines) and not len(elements.cells):
                lines = [i for i in elements.lines.tolist() if self.line_types[i] == "R2D2"]
                if len(lines) == len(elements.lines):
                    found.append((row, elements.lines))
        return found

    def _row_edges(self, row: SurfaceRow, cells: Ints) -> Ints:
        lines = self.mesh.are_lines(cells)
        if len(lines) and lines.all() and row.face in ("", "SPOS", "SNEG"):
            if row.face:
                text = f"{row.face}: contact acts on both sides of lines"
                self.deck.note(f"{row.where}: {row.card.spelled}: {text}")
            return self.mesh.line_sides(cells)
        if not row.face:
            free = self.mesh.boundary_edges()
            return free[np.isin(free[:, 0], cells)]
        match = re.match(_FACE, row.face, re.ASCII)
        if not match:
            shells = bool(len(cells)) and self.sided[cells].all()
            out_of_plane = shells and row.face in ("SPOS", "SNEG")
            known = "S3 to S6" if shells else "S1 to S4"
            hint = _SIDES if out_of_plane else ""
            row.refuse(f"unknown face {row.face!r}; expected {known}", hint)
        face = int(match.group(2)) - 1
        if match.group(1) == "E":
            # Edges of shells in Abaqus.
            face += 2
            if not self.sided[cells].all():
                label = self.mesh.cell_labels[cells[np.argmin(self.sided[cells])]]
                text = f"{row.face} is an edge of a shell; element {label} is none"
                row.refuse(text, "give its faces S1 to S4")
        return self.faces(cells, face, row)

    def faces(self, cells: Ints, face: int, row: SurfaceRow) -> Ints:
        """Edges (n, 2) of one face number (from 0, as the deck counts) of cells.

        Raises
        ------
        Refused
            After an error.
        """
        sided = self.sided[cells]
        if sided.any() and face < 2:
            label = self.mesh.cell_labels[cells[np.argmax(sided)]]
            text = f"face {face + 1} of the shell or membrane {label} is a side of its plane"
            row.refuse(text, _SIDES)
        face_of = np.where(sided, face - 2, face)
        side = self.side[cells]
        if (side >= 0).any():
            # Of a quadrilateral with a side of one node three faces are left.
            for missing in distinct(side[side >= 0]).tolist():
                for shift in (0, 2):
                    if 0 <= face - shift < 4:
                        hit = (side == missing) & (sided == (shift == 2))
                        face_of[hit] = _face_of_triangle(face - shift, missing)
            cells, face_of = cells[face_of >= 0], face_of[face_of >= 0]
        edges = np.stack([cells, face_of], axis=1)
        offsets = self.mesh.offsets
        for number, block in enumerate(self.mesh.cells):
            inside = (cells >= offsets[number]) & (cells < offsets[number + 1])
            count = len(EDGES[block.kind])
            if (inside & ((face_of < 0) | (face_of >= count))).any():
                label = self.mesh.cell_labels[cells[inside][0]]
                if not count:
                    row.refuse(
                        f"element {label} is a line and has no faces: P1 and P2 are forces per "
                        "length of beams in Abaqus and pressures on their width in CalculiX",
                        "give PX and PY, forces per length in global directions",
                    )
                what = "edges" if sided.any() else "faces"
                row.refuse(f"element {label} has {count} {what}, and no face {face + 1}")
            back = inside & self.turned[cells]
            edges[back, 1] = count - 1 - face_of[back]
        return edges

    def _edges_of_lines(self, lines: Ints) -> Ints:
        """Cell edges on line elements; a line without a cell is ignored."""
        edges = self.mesh.edges_between([self.line_nodes[i][:2] for i in lines])
        return np.asarray(edges[edges[:, 0] >= 0])


def _face_of_triangle(face: int, missing: int) -> int:
    """Face of the triangle that a quadrilateral without one side is; -1 for that side."""
    if face == missing:
        return -1
    twin = (missing + 1) % 4
    corners = [i for i in range(4) if i != twin]
    return corners.index(missing if face == twin else face)


def _only(name: str, names: Iterable[str]) -> str:
    """The one name of the form ``INSTANCE.name``, or an empty text."""
    found = [full for full in names if full.endswith("." + name)]
    return found[0] if len(found) == 1 else ""


def _unique(values: Ints) -> Ints:
    """Values without repetition, in the order of their first occurrence."""
    if (np.diff(values) > 0).all():
        return values
    _, first = np.unique(values, return_index=True)
    return values[np.sort(first)]

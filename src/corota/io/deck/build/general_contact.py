"""General contact of a deck: its pairs of surfaces."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from corota.io.deck import numerals
from corota.io.deck.card import Row, key, nearest
from corota.io.deck.cards.contact import begins_in
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import GeneralDraft, InteractionDraft, PairDraft, StartDraft, Surface

if TYPE_CHECKING:
    from corota.arrays import Floats, Ints
    from corota.io.deck.build.sets import Sets
    from corota.model.model import Model

#: Names of the surface of all outer edges, and of contact that no card describes.
EXTERIOR, DEFAULT = "ALL_EXTERIOR", "GENERAL_CONTACT"
#: Pairs of edges up to which it is tried whether two sets face each other.
MOST = 4_000_000


@dataclass(frozen=True)
class _Rule:
    """Interaction and start of two surfaces that may meet."""

    interaction: str
    start: str = ""


def add_general(deck: Deck, model: Model, sets: Sets) -> None:
    """Add the pairs of general contact to those of the deck.

    All outer edges are one surface with self-contact, which covers contact between bodies
    and within each body; every rigid profile and rigid side that is a surface is another master.
    Lines that name surfaces divide the edges into groups, and pairs of groups have a rule each.
    """
    draft = deck.general
    if draft is None:
        return
    card = draft.card
    if not draft.every and not draft.pairs and not draft.included:
        card.error("general contact has no *CONTACT INCLUSIONS below it")
        return
    default = draft.interaction
    every = draft.every or bool(draft.included)
    if not default and (every or len(draft.properties) < len(draft.pairs)):
        default = DEFAULT
        deck.interactions.setdefault(key(DEFAULT), InteractionDraft(DEFAULT, card))
        deck.note(f"{card.where}: general contact without an interaction: hard, no friction")
    default = default or draft.properties[0].get(2)
    _General(deck, model, sets, draft, default).add()


class _General:
    """Pairs of surfaces of general contact.

    Parameters
    ----------
    default : str
        Interaction of pairs that no line names.
    """

    def __init__(
        self, deck: Deck, model: Model, sets: Sets, draft: GeneralDraft, default: str
    ) -> None:
        self.deck, self.model, self.sets, self.draft = deck, model, sets, draft
        first = [row.get(2) for row in draft.starts if not row.get(0) and not row.get(1)]
        self.rule = _Rule(default, first[-1] if first else "")
        self.row = Row(draft.card, draft.where or draft.card.where, draft.card.text, [""], [1])

    def add(self) -> None:
        """Add all pairs."""
        draft = self.draft
        lines = [*draft.properties, *(x for x in draft.starts if x.get(0) or x.get(1))]
        if not draft.every and not draft.included:
            self._named(lines)
            return
        root = self.sets.views[0]
        self.model.mesh.edge_sets[EXTERIOR] = self.model.mesh.boundary_edges()
        self.sets.surfaces[key(EXTERIOR)] = (root, Surface(EXTERIOR, draft.card, False))
        rigid = [
            view.prefix + s.name
            for view, s in self.sets.surfaces.values()
            if s.profile is not None or (not s.nodes and self.sets.rigid_sides(view, s))
        ]
        start = self.deck.starts.get(key(self.rule.start))
        # An overlap of two bodies that presses needs a pair of its own.
        plain = start is None or start.start == "adjust"
        if draft.every and not lines and not draft.excluded and plain:
            for master in (EXTERIOR, *rigid):
                self._pair(self.row, EXTERIOR, master, self.rule)
            what = "all outer edges, each body with itself included"
        else:
            self._groups(lines, rigid)
            what = "outer edges by their pairs of surfaces"
        self.deck.note(
            f"{draft.card.where}: general contact: {what}"
            + (f", and {', '.join(rigid)}" if rigid else "")
            + "; mortar, finite sliding"
        )
        for row in draft.pairs:
            self._pair(row, row.get(0), row.get(1) or row.get(0), self.rule)

    def _named(self, lines: list[Row]) -> None:
        """Pairs that the inclusions name, with what other lines say of the same two surfaces."""

        def names(row: Row) -> frozenset[str]:
            return frozenset((key(row.get(0)), key(row.get(1) or row.get(0))))

        rules = {names(row): self.rule for row in self.draft.pairs}
        gone = {names(row) for row in self.draft.excluded}
        for row in [*self.draft.excluded, *lines]:
            if names(row) not in rules:
                shown = "; ".join(f"{r.get(0)}, {r.get(1)}" for r in self.draft.pairs)
                row.error(
                    0,
                    "no inclusion of general contact has these two surfaces",
                    f"name the surfaces of an inclusion: {shown}",
                )
                return
        for row in lines:
            rules[names(row)] = _changed(rules[names(row)], row)
        for row in self.draft.pairs:
            if names(row) not in gone:
                self._pair(row, row.get(0), row.get(1) or row.get(0), rules[names(row)])

    def _groups(self, lines: list[Row], rigid: list[str]) -> None:
        """Pairs of groups of edges: those of a body that the same surfaces contain."""
        mesh, draft = self.model.mesh, self.draft
        edges = mesh.edge_sets[EXTERIOR]
        place = {tuple(e): i for i, e in enumerate(edges.tolist())}
        columns: dict[str, int] = {}
        inside: list[Ints] = []
        for row in [*draft.included, *draft.excluded, *lines]:
            for index in (0, 1):
                name = row.get(index)
                if not name or key(name) in columns or key(name) in map(key, rigid):
                    continue
                full = self.sets.mesh_name(mesh.edge_sets, self.sets.views[0], name)
                if not full:
                    row.error(
                        index,
                        f"no surface of element edges named {numerals.shown(name)}",
                        nearest(name, [*mesh.edge_sets, *rigid]),
                    )
                    return
                mask = np.zeros(len(edges), np.int64)
                mask[
                    [place[tuple(e)] for e in mesh.edge_sets[full].tolist() if tuple(e) in place]
                ] = 1
                columns[key(name)] = len(inside)
                inside.append(mask)
        table = np.column_stack([self._bodies(edges), *inside])
        kinds, group = np.unique(table, axis=0, return_inverse=True)
        n = len(kinds)
        bodies = [*kinds[:, 0].tolist(), *(-1 - i for i in range(len(rigid)))]

        def members(name: str) -> list[int]:
            if not name or key(name) == key(EXTERIOR):
                return list(range(n))
            if key(name) in columns:
                inner: list[int] = np.flatnonzero(kinds[:, 1 + columns[key(name)]]).tolist()
                return inner
            return [n + [key(r) for r in rigid].index(key(name))]

        def pairs(row: Row) -> set[tuple[int, int]]:
            # One surface alone is that surface with itself, a blank first one all the others.
            first = members(row.get(0))
            second = members(row.get(1)) if row.get(1) else first
            return {(min(a, b), max(a, b)) for a in first for b in second if min(a, b) < n}

        total = n + len(rigid)
        rules: dict[tuple[int, int], _Rule] = {}
        if draft.every:
            every = ((a, b) for a in range(n) for b in range(a, total))
            rules = dict.fromkeys(every, self.rule)
        for row in draft.included:
            rules.update(dict.fromkeys(pairs(row), self.rule))
        for row in draft.excluded:
            for pair in pairs(row):
                rules.pop(pair, None)
        for row in lines:
            for pair in pairs(row) & rules.keys():
                rules[pair] = _changed(rules[pair], row)
        sets = [edges[group.ravel() == g] for g in range(n)]
        self._surfaces(rules, sets, bodies, rigid)

    def _surfaces(
        self,
        rules: dict[tuple[int, int], _Rule],
        sets: list[Ints],
        bodies: list[int],
        rigid: list[str],
    ) -> None:
        """Pairs of surfaces for the rules of pairs of groups."""
        n = len(sets)
        done: dict[tuple[int, ...], str] = {}

        def surface(groups: list[int]) -> str:
            name = tuple(sorted(groups))
            if name not in done:
                done[name] = full = f"{EXTERIOR}-{len(done) + 1}"
                self.model.mesh.edge_sets[full] = np.concatenate([sets[g] for g in name])
                made = Surface(full, self.draft.card, False)
                self.sets.surfaces[key(full)] = (self.sets.views[0], made)
            return done[name]

        def size(groups: list[int]) -> float:
            return float(self._sides(np.concatenate([sets[g] for g in groups]))[2].mean())

        def meet(slaves: list[int], masters: list[int], rule: _Rule) -> None:
            if slaves != masters and masters[0] < n and size(masters) < size(slaves):
                slaves, masters = masters, slaves
            master = surface(masters) if masters[0] < n else rigid[masters[0] - n]
            self._pair(self.row, surface(slaves), master, rule)

        of = {
            body: [g for g, b in enumerate(bodies) if b == body] for body in dict.fromkeys(bodies)
        }
        for body, groups in of.items():
            if body < 0:
                continue
            inner = {p: rules.get(p) for p in _pairs(groups)}
            met = {rule for p, rule in inner.items() if self._face(sets[p[0]], sets[p[1]])}
            if len(met - {None}) > 1 or (None in met and len(met) > 1 and self.draft.every):
                self.row.error(
                    0,
                    "edges of one body that face each other have different rules of contact",
                    "name them by *CONTACT PAIR, or treat all edges of the body alike",
                )
                return
            some = (met or {*inner.values()}) - {None}
            rule = some.pop() if len(some) == 1 else self.rule if some else None
            if rule is not None:
                meet(groups, groups, rule)
        for one, two in combinations(of, 2):
            for a in of[one]:
                by_rule: dict[_Rule, list[int]] = {}
                for b in of[two]:
                    rule = rules.get((min(a, b), max(a, b)))
                    if rule is not None:
                        by_rule.setdefault(rule, []).append(b)
                for rule, masters in by_rule.items():
                    if two >= 0 and not any(self._face(sets[a], sets[b]) for b in masters):
                        continue  # they meet only where a body turns over
                    meet([a], masters, rule)

    def _face(self, one: Ints, two: Ints) -> bool:
        """Whether any edge of one set is in front of an edge of the other that looks back at it."""
        if len(one) * len(two) > MOST:
            return True
        (x, n, size), (y, m, _) = (self._sides(edges) for edges in (one, two))
        ahead = np.einsum("ijk,ik->ij", y[None] - x[:, None], n) > -0.5 * size[:, None]
        behind = np.einsum("ijk,jk->ij", x[:, None] - y[None], m) > -0.5 * size[:, None]
        return bool(((n @ m.T < -1e-6) & ahead & behind).any())

    def _sides(self, edges: Ints) -> tuple[Floats, Floats, Floats]:
        """Centers, outward normals and lengths of edges, whose bodies are on the left."""
        ends = np.array([nodes[:2] for nodes in self.model.mesh.edge_nodes(edges)])
        first, second = self.model.mesh.points[ends[:, 0]], self.model.mesh.points[ends[:, 1]]
        along = second - first
        size = np.linalg.norm(along, axis=1)
        normal = np.column_stack([along[:, 1], -along[:, 0]]) / size[:, None]
        return 0.5 * (first + second), normal, size

    def _bodies(self, edges: Ints) -> Ints:
        """Number of the body that each edge belongs to."""
        mesh = self.model.mesh
        links = [c.nodes[:, [0, k]] for c in mesh.cells for k in range(1, c.nodes.shape[1])]
        pairs = np.concatenate(links)
        graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (mesh.n_nodes,) * 2)
        label = connected_components(graph, directed=False)[1]
        return np.array([label[nodes[0]] for nodes in mesh.edge_nodes(edges)], np.int64)

    def _pair(self, row: Row, slave: str, master: str, rule: _Rule) -> None:
        pair = PairDraft(row, slave, master, interaction=rule.interaction)
        start = self.deck.starts.get(key(rule.start)) or StartDraft("", row.card)
        pair.start, pair.adjust, pair.clearance = start.start, start.adjust, start.clearance
        pair.stabilize = self.draft.stabilize
        begins_in(pair, self.draft.step)
        self.deck.pairs.append(pair)


def _pairs(groups: list[int]) -> list[tuple[int, int]]:
    return [(a, b) for i, a in enumerate(groups) for b in groups[i:]]


def _changed(rule: _Rule, row: Row) -> _Rule:
    """Rule of two surfaces after a line that names them."""
    if "PROPERTY" in row.card.keyword:
        return replace(rule, interaction=row.get(2))
    return replace(rule, start=row.get(2))

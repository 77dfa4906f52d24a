"""Cards that make nodes and elements from others: ``*NGEN``, ``*NFILL``, ``*ELGEN``, copies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.arrays import distinct
from corota.io.deck import numerals
from corota.io.deck.deck import nearest
from corota.io.deck.drafts import ElementBlock, Entry, NamedSet, NodeBlock
from corota.io.deck.lexer import key

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card, Row
    from corota.mesh.data import Floats, Ints

#: Nodes or elements that one line may make.
MAX_GENERATED = 50_000_000
#: Sets inside sets.
_DEPTH = 50


def ngen(deck: Deck, card: Card) -> None:
    """``*NGEN[, LINE=C or P]``: first, last node, increment[, node or point of the curve]."""
    curve = deck.choice(card, "LINE", ("C", "P"), "")
    for row in card.rows():
        numbers = _integers(
            deck,
            card,
            row,
            (("the first node", None), ("the last node", None), ("the increment", 1)),
        )
        if numbers is None:
            return
        first, last, by = numbers
        ends = [_point(deck, card, row, i, label) for i, label in enumerate((first, last))]
        if ends[0] is None or ends[1] is None:
            return
        by = abs(by) if last >= first else -abs(by)
        if by == 0 or (last - first) % by or abs((last - first) // by) > MAX_GENERATED:
            deck.row_error(card, row, 2, f"{last} is not reached from {first} in steps of {by}")
            return
        labels = np.arange(first + by, last, by, dtype=np.int64)
        share = (labels - first) / (last - first) if last != first else np.zeros(0)
        extra = _extra_point(deck, card, row) if curve else np.zeros(3)
        if extra is None:
            return
        if curve == "C":
            normal = deck.real(card, row, 9, "the normal", 0.0)
            points = _on_arc(ends[0], ends[1], extra, share, float(normal or 0.0))
        elif curve == "P":
            a, b, s = ends[0], ends[1], share[:, None]
            points = a * (1 - s) * (1 - 2 * s) + extra * 4 * s * (1 - s) + b * s * (2 * s - 1)
        else:
            points = ends[0] + share[:, None] * (ends[1] - ends[0])
        _add_nodes(deck, card, row, labels, points)
        _extend(deck, card, "NSET", np.concatenate([[first], labels, [last]]), row)


def _on_arc(first: Floats, last: Floats, centre: Floats, share: Floats, normal: float) -> Floats:
    """Points between two ends about a centre: the shorter way, or counter-clockwise about +z."""
    a, b = first[:2] - centre[:2], last[:2] - centre[:2]
    turn = math.atan2(a[0] * b[1] - a[1] * b[0], float(a @ b))
    if normal != 0.0 and turn * normal < 0.0:
        turn += math.copysign(2.0 * math.pi, normal)
    angle = math.atan2(a[1], a[0]) + share * turn
    radius = np.hypot(*a) + share * (np.hypot(*b) - np.hypot(*a))
    z = first[2] + share * (last[2] - first[2])
    return np.stack(
        [centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle), z], axis=1
    )


def _extra_point(deck: Deck, card: Card, row: Row) -> Floats | None:
    if row.get(3):
        label = deck.integer(card, row, 3, "the node of the curve")
        return None if label is None else _point(deck, card, row, 3, label)
    values = [
        deck.real(card, row, 4 + i, f"{'xyz'[i]} of the curve's point", 0.0) for i in range(3)
    ]
    return None if None in values else np.array([float(v or 0.0) for v in values])


def nfill(deck: Deck, card: Card) -> None:
    """``*NFILL[, BIAS=]``: first set, last set, number of intervals, increment of numbers."""
    bias = deck.parameter_number(card, "BIAS", 1.0, 1e-9)
    for row in card.rows():
        sets = [_set(deck, card, row, i, nodes=True) for i in (0, 1)]
        intervals = deck.integer(card, row, 2, "the number of intervals", 1)
        by = deck.integer(card, row, 3, "the increment", 1)
        if sets[0] is None or sets[1] is None or intervals is None or by is None:
            return
        a, b = (np.sort(s) for s in sets if s is not None)
        if len(a) != len(b):
            deck.row_error(card, row, 1, f"{len(a)} nodes cannot be joined with {len(b)} nodes")
            return
        if not 1 <= intervals <= MAX_GENERATED // max(len(a), 1):
            deck.row_error(card, row, 2, f"at least one interval is expected, not {intervals}")
            return
        from_, to = _points(deck, card, row, a), _points(deck, card, row, b)
        if from_ is None or to is None:
            return
        # The intervals grow by 1 / BIAS from the first set on.
        sizes = bias ** -np.arange(intervals, dtype=float)
        share = np.cumsum(sizes)[:-1] / sizes.sum()
        made = [a]
        for k, s in enumerate(share, 1):
            _add_nodes(deck, card, row, a + k * by, from_ + s * (to - from_))
            made.append(a + k * by)
        _extend(deck, card, "NSET", np.concatenate([*made, b]), row)


def elgen(deck: Deck, card: Card) -> None:
    """``*ELGEN``: element; number in a row, node and element increments; rows; layers."""
    names = ("elements in the first row", "the increment of nodes", "the increment of elements")
    for row in card.rows():
        master = deck.integer(card, row, 0, "the element number")
        steps: list[tuple[int, int, int]] = []
        for start in range(1, 10, 3):
            found = _integers(deck, card, row, [(n, 1) for n in names], start)
            if found is None:
                return
            steps.append((found[0], found[1], found[2]))
        if master is None:
            return
        found_at = _element(deck, master)
        if found_at is None:
            deck.row_error(card, row, 0, f"element {master} is not defined before this card")
            return
        block, at = found_at
        total = math.prod(max(count, 1) for count, _, _ in steps)
        if any(count < 1 for count, _, _ in steps) or total > MAX_GENERATED:
            deck.row_error(card, row, 1, f"between 1 and {MAX_GENERATED} elements are expected")
            return
        shift_nodes, shift = np.zeros(1, np.int64), np.zeros(1, np.int64)
        for count, by_nodes, by_elements in steps:
            k = np.arange(count, dtype=np.int64)[:, None]
            shift_nodes = (shift_nodes[None, :] + k * by_nodes).ravel()
            shift = (shift[None, :] + k * by_elements).ravel()
        labels, nodes = master + shift, block.nodes[at] + shift_nodes[:, None]
        _add_elements(deck, card, row, block, labels[1:], nodes[1:])
        _extend(deck, card, "ELSET", labels, row)


def ncopy(deck: Deck, card: Card) -> None:
    """``*NCOPY, CHANGE NUMBER=, OLD SET=, SHIFT or REFLECT=``: nodes moved, turned, mirrored."""
    by = deck.parameter_integer(card, "CHANGENUMBER", 0, 0)
    rows = list(card.rows())
    old = deck.required(card, "OLDSET", "OLD SET")
    multiple = deck.parameter_integer(card, "MULTIPLE", 1, 1)
    if not old or by < 1:
        if old:
            deck.error(card, card.where, "CHANGE NUMBER= is missing: what is added to the numbers")
        return
    labels = _labels(deck, old, nodes=True)
    if labels is None:
        deck.error(card, card.at("OLDSET"), f"no node set named {numerals.shown(old)} before this")
        return
    row = rows[0] if rows else _no_row(card)
    points = _points(deck, card, row, labels)
    values = [_reals(deck, card, r) for r in rows]
    if points is None or any(v is None for v in values):
        return
    given = [np.array(v, dtype=float) for v in values if v is not None]
    for k in range(1, multiple + 1):
        if card.has("REFLECT"):
            moved = _mirrored(deck, card, points, given)
        elif card.has("SHIFT"):
            moved = _shifted(points, given)
        else:
            deck.error(card, card.where, "SHIFT or REFLECT= is expected")
            return
        if moved is None:
            return
        points = moved
        _add_nodes(deck, card, row, labels + k * by, points)
        _extend(deck, card, "NEWSET", labels + k * by, row)


def _shifted(points: Floats, given: list[Floats]) -> Floats:
    """Shift, then turn about an axis through two points."""
    shift = np.resize(np.append(given[0], [0.0] * 3), 3) if given else np.zeros(3)
    moved = points + shift
    if len(given) > 1 and len(given[1]) > 6 and given[1][6] != 0.0:
        a, b = given[1][:3], given[1][3:6]
        axis = (b - a) / np.linalg.norm(b - a)
        c, s = math.cos(math.radians(given[1][6])), math.sin(math.radians(given[1][6]))
        d = moved - a
        along = (d @ axis)[:, None] * axis
        moved = a + along + (d - along) * c + np.cross(axis, d) * s
    return np.asarray(moved)


def _mirrored(deck: Deck, card: Card, points: Floats, given: list[Floats]) -> Floats | None:
    """Reflection in a point, a line, or a plane."""
    how = deck.choice(card, "REFLECT", ("POINT", "LINE", "MIRROR"), "")
    numbers = np.concatenate([np.zeros(0), *given])
    needed = {"POINT": 3, "LINE": 6, "MIRROR": 9}.get(how, 0)
    if not needed:
        return None
    if len(numbers) < needed:
        deck.error(card, card.where, f"REFLECT={how} needs {needed} coordinates")
        return None
    a = numbers[:3]
    if how == "POINT":
        return np.asarray(2.0 * a - points)
    axis = numbers[3:6] - a
    if how == "MIRROR":
        axis = np.cross(axis, numbers[6:9] - a)
    size = float(np.linalg.norm(axis))
    if size == 0.0:
        deck.error(card, card.where, "the points of the reflection coincide or lie on one line")
        return None
    axis = axis / size
    along = ((points - a) @ axis)[:, None] * axis
    return np.asarray(points - 2.0 * along if how == "MIRROR" else 2.0 * (a + along) - points)


def elcopy(deck: Deck, card: Card) -> None:
    """``*ELCOPY, ELEMENT SHIFT=, OLD SET=, SHIFT NODES=``: elements with new numbers."""
    deck.no_rows(card)
    old = deck.required(card, "OLDSET", "OLD SET")
    by = deck.parameter_integer(card, "ELEMENTSHIFT", 0, 0)
    nodes = deck.parameter_integer(card, "SHIFTNODES", 0, 0)
    if not old:
        return
    labels = _labels(deck, old, nodes=False)
    if labels is None or by < 1:
        text = "ELEMENT SHIFT= is missing" if by < 1 else f"no element set named {old} before this"
        deck.error(card, card.at("OLDSET"), text)
        return
    row = _no_row(card)
    for block in list(deck.scope.elements):
        mine = np.isin(block.labels, labels)
        if mine.any():
            _add_elements(
                deck, card, row, block, block.labels[mine] + by, block.nodes[mine] + nodes
            )
    _extend(deck, card, "NEWSET", labels + by, row)


def _no_row(card: Card) -> Row:
    from corota.io.deck.lexer import Row

    return Row(card.where, card.text, [], [])


def _reals(deck: Deck, card: Card, row: Row) -> list[float] | None:
    values = [deck.real(card, row, i, "the number", 0.0) for i in range(len(row))]
    return None if None in values else [float(v or 0.0) for v in values]


def _integers(
    deck: Deck,
    card: Card,
    row: Row,
    names: tuple[tuple[str, int | None], ...] | list[tuple[str, int]],
    start: int = 0,
) -> list[int] | None:
    found = []
    for index, (name, default) in enumerate(names):
        value = deck.integer(card, row, start + index, name, default)
        if value is None:
            return None
        found.append(value)
    return found


def _point(deck: Deck, card: Card, row: Row, index: int, label: int) -> Floats | None:
    """Coordinates (3,) of a node defined before; ``None`` after an error."""
    for block in reversed(deck.scope.nodes):
        at = np.flatnonzero(block.labels == label)
        if len(at):
            return np.asarray(block.points[at[0]])
    deck.row_error(card, row, index, f"node {label} is not defined before this card")
    return None


def _points(deck: Deck, card: Card, row: Row, labels: Ints) -> Floats | None:
    blocks = deck.scope.nodes
    every = np.concatenate([np.zeros(0, np.int64), *(b.labels for b in blocks)])
    xyz = np.concatenate([np.zeros((0, 3)), *(b.points for b in blocks)])
    order = np.argsort(every, kind="stable")
    at = np.minimum(np.searchsorted(every[order], labels), max(len(every) - 1, 0))
    if len(labels) and (not len(every) or (every[order][at] != labels).any()):
        known = np.isin(labels, every)
        missing = labels[~known][0]
        deck.row_error(card, row, 0, f"node {missing} is not defined before this card")
        return None
    return np.asarray(xyz[order][at])


def _set(deck: Deck, card: Card, row: Row, index: int, *, nodes: bool) -> Ints | None:
    text = row.get(index)
    if numerals.is_integer(text) and len(text) < 19:
        return np.array([int(text)], dtype=np.int64)
    found = _labels(deck, text, nodes=nodes) if text else None
    if found is None:
        table = deck.scope.nsets if nodes else deck.scope.elsets
        deck.row_error(
            card,
            row,
            index,
            f"no node set named {numerals.shown(text)} before this card",
            nearest(text, table) if text else "",
        )
    return found


def _labels(deck: Deck, name: str, *, nodes: bool, depth: int = 0) -> Ints | None:
    """Labels of a set, sorted, as far as it is given by now."""
    table = deck.scope.nsets if nodes else deck.scope.elsets
    named = table.get(key(name))
    if named is None or depth > _DEPTH:
        return None
    parts = [np.zeros(0, np.int64)]
    for entry in named.entries:
        if entry.name and not entry.name.startswith("@"):
            inner = _labels(deck, entry.name, nodes=nodes, depth=depth + 1)
            if inner is None:
                return None
            parts.append(inner)
        else:
            parts.append(entry.labels)
    return distinct(np.concatenate(parts))


def _element(deck: Deck, label: int) -> tuple[ElementBlock, int] | None:
    for block in reversed(deck.scope.elements):
        at = np.flatnonzero(block.labels == label)
        if len(at):
            return block, int(at[0])
    return None


def _add_nodes(deck: Deck, card: Card, row: Row, labels: Ints, points: Floats) -> None:
    if not len(labels):
        return
    if labels.min() < 1:
        deck.row_error(card, row, 0, f"node number {labels.min()} would be made; at least 1")
        return
    lines = np.full(len(labels), row.where.line, np.int64)
    deck.scope.nodes.append(NodeBlock(labels, points, row.where.file, lines))


def _add_elements(
    deck: Deck, card: Card, row: Row, like: ElementBlock, labels: Ints, nodes: Ints
) -> None:
    if not len(labels):
        return
    if labels.min() < 1:
        deck.row_error(card, row, 0, f"element number {labels.min()} would be made; at least 1")
        return
    lines = np.full(len(labels), row.where.line, np.int64)
    block = ElementBlock(like.card, like.type, labels, nodes, row.where.file, lines)
    deck.scope.elements.append(block)


def _extend(deck: Deck, card: Card, parameter: str, labels: Ints, row: Row) -> None:
    name = card.value(parameter)
    if name:
        nodes = parameter == "NSET" or card.keyword == "NCOPY"
        table = deck.scope.nsets if nodes else deck.scope.elsets
        found = table.setdefault(key(name), NamedSet(name, card.where))
        found.entries.append(Entry(row.where, np.asarray(labels, dtype=np.int64)))


def system(deck: Deck, card: Card) -> None:
    """``*SYSTEM``: axes in which the nodes after it are given; without data the global ones."""
    rows = list(card.rows())
    deck.system = None
    if not rows:
        return
    values = [_reals(deck, card, row) for row in rows[:2]]
    if any(v is None for v in values):
        return
    a = np.resize(np.append(values[0] or [], np.zeros(6)), 6)
    x = a[3:] - a[:3] if a[3:].any() else np.array([1.0, 0.0, 0.0])
    if len(rows) > 1:
        c = np.resize(np.append(values[1] or [], np.zeros(3)), 3) - a[:3]
    else:
        c = np.array([-x[1], x[0], 0.0])
    y = c - x * (c @ x) / (x @ x) if x.any() else c
    if not (x.any() and y.any()):
        deck.row_error(card, rows[0], 3, "the points of the axes coincide or lie on one line")
        return
    x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
    deck.system = (a[:3], np.stack([x, y, np.cross(x, y)]))


def in_global_axes(deck: Deck, card: Card, points: Floats) -> Floats:
    """Coordinates of ``*NODE`` lines in global axes (``SYSTEM=`` of the card, ``*SYSTEM``)."""
    how = deck.choice(card, "SYSTEM", ("R", "C", "S"), "R")
    if how != "R":
        # Radius, angle in degrees and height; of spheres the second angle lies in the plane z = 0.
        radius, angle = points[:, 0], np.radians(points[:, 1])
        z = points[:, 2]
        if how == "S":
            z, radius = radius * np.sin(np.radians(z)), radius * np.cos(np.radians(z))
        points = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
    if deck.system is not None:
        origin, axes = deck.system
        points = origin + points @ axes
    return points


__all__ = ["elcopy", "elgen", "in_global_axes", "ncopy", "nfill", "ngen", "system"]

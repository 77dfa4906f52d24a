"""Cards of nodes, elements, sets and surfaces."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from corota._core import parse_labels, parse_nodes, parse_table
from corota.arrays import Ints
from corota.errors import Location
from corota.io.deck import numerals
from corota.io.deck.card import Card, Chunk, Refused, Row, complete, key, nearest
from corota.io.deck.deck import Deck, int_array
from corota.io.deck.drafts import ElementBlock, Entry, NamedSet, NodeBlock, Surface, SurfaceRow
from corota.io.deck.elements import (
    ALIASES,
    ATTACHED,
    ELEMENTS,
    LINE_ELEMENTS,
    LINES,
    OWN,
    why_unsupported,
)
from corota.io.deck.keywords import keyword
from corota.lazy import lazy
from corota.mesh.kinds import N_NODES

# Functions of cards that few decks have.
attached_elements = lazy("corota.io.deck.cards.attachments:elements")
couplers = lazy("corota.io.deck.cards.tie:couplers")
in_global_axes = lazy("corota.io.deck.cards.generate:in_global_axes")
profile = lazy("corota.io.deck.cards.contact:profile")

#: Elements that name the reference node of ``*DISTRIBUTING COUPLING``.
COUPLERS = ("DCOUP2D", "DCOUP3D")
#: Bytes of a set from which it is read in bulk.
LONG = 1 << 16
#: Entries of one GENERATE line.
MAX_GENERATE = 50_000_000


@keyword("NODE", "NSET SYSTEM", place="model")
def node(deck: Deck, card: Card) -> None:
    """``*NODE``: label, x, y[, z]."""
    labels_of_card = []
    for chunk in card.chunks:
        block = _node_block(deck, card, chunk)
        if card.has("SYSTEM") or deck.system is not None:
            block.points = in_global_axes(deck, card, block.points)
        if len(block.labels):
            deck.scope.nodes.append(block)
            labels_of_card.append(block.labels)
    if card.has("NSET"):
        _extend(deck.scope.nsets, card, "NSET", labels_of_card)


def _node_block(deck: Deck, card: Card, chunk: Chunk) -> NodeBlock:
    source = chunk.source
    labels, points, lines, odd = parse_nodes(source.data, chunk.start, chunk.stop, chunk.line)
    points = points.reshape(-1, 3)
    more_labels, more_points, more_lines = [], [], []
    for row in _odd_rows(card, chunk, odd):
        found = _node_row(deck, row)
        if found is not None:
            more_labels.append(found[0])
            more_points.append(found[1])
            more_lines.append(row.where.line)
    if more_labels:
        labels = np.concatenate([labels, int_array(more_labels)])
        points = np.concatenate([points, np.array(more_points)])
        lines = np.concatenate([lines, int_array(more_lines)])
        order = np.argsort(lines, kind="stable")
        labels, points, lines = labels[order], points[order], lines[order]
    return NodeBlock(labels, points, source.name, lines)


def _odd_rows(card: Card, chunk: Chunk, odd: list[tuple[int, int]]) -> Iterator[Row]:
    """Lines that the bulk reader handed back, cut by the rules of the lexer."""
    for at, number in odd:
        text, _ = chunk.source.line(chunk.start + at)
        if text.strip():
            yield card.row(text, Location(chunk.source.name, number))


def _node_row(deck: Deck, row: Row) -> tuple[int, tuple[float, float, float]] | None:
    rest = [row.get(i) for i in range(4, len(row)) if row.get(i)]
    if rest and (deck.lenient or all(_zero(text) for text in rest)):
        deck.note(f"{row.where}: fields after z of a node are not used")
    else:
        row.at_most(4)
    label = _label(row, "the node number")
    x, y, z = (row.real(i, name, 0.0) for i, name in enumerate("xyz", 1))
    if not any(row.get(i) for i in range(1, len(row))):
        deck.note(f"{row.where}: a node without coordinates is at the origin")
    if label is not None and x is not None and y is not None and z is not None:
        return label, (x, y, z)
    return None


def _zero(text: str) -> bool:
    try:
        return numerals.real(text) == 0.0
    except ValueError:
        return False


@keyword("ELEMENT", "TYPE ELSET", place="model")
def element(deck: Deck, card: Card) -> None:
    """``*ELEMENT, TYPE=``: label, nodes."""
    name = card.required("TYPE")
    if not name:
        return
    type_ = key(name)
    if type_ in COUPLERS:
        couplers(deck, card)
        return
    if type_ in ATTACHED:
        attached_elements(deck, card, type_)
        return
    if type_ in ELEMENTS:
        size = N_NODES[ELEMENTS[type_].kind]
    elif type_ in LINES:
        size = LINES[type_]
    elif type_ in LINE_ELEMENTS:
        size = LINE_ELEMENTS[type_].n_nodes
    else:
        deck.refused_types.add(type_)
        if why := why_unsupported(type_):
            card.refuse(f"elements of type {name} are not supported: {why}", "TYPE")
        card.refuse(f"unknown element type {numerals.shown(name)}", "TYPE", _known_types(type_))
    if type_ in ELEMENTS and ELEMENTS[type_].note:
        deck.note(f"{type_} {ELEMENTS[type_].note}")
    labels_of_card = []
    for chunk in card.chunks:
        table, lines = _element_rows(deck, card, chunk, size)
        if len(table):
            labels, nodes = table[:, 0].copy(), table[:, 1:].copy()
            block = ElementBlock(card, type_, labels, nodes, chunk.source.name, lines)
            deck.scope.elements.append(block)
            labels_of_card.append(labels)
    if card.has("ELSET"):
        _extend(deck.scope.elsets, card, "ELSET", labels_of_card)


def _known_types(type_: str) -> str:
    """A type with a similar name, or the known ones."""
    same = [t for t in (*ELEMENTS, *LINE_ELEMENTS) if t not in OWN and t[:3] == type_[:3]]
    known = "known: CPS and CPE with " + ", ".join([*ALIASES, *OWN, *LINE_ELEMENTS])
    return nearest(type_, same, 0.8) or known


def _element_rows(deck: Deck, card: Card, chunk: Chunk, size: int) -> tuple[Ints, Ints]:
    source = chunk.source
    values, numbers, odd = parse_table(source.data, chunk.start, chunk.stop, chunk.line, size + 1)
    if not odd:
        return values.reshape(-1, size + 1), numbers
    # A line that continues in the next one cannot be read alone: all are read again.
    table, lines = [], []
    for row in _joined(card.rows_of(chunk), size + 1):
        label = _label(row, "the element number")
        count = len(row) - 1
        if count != size:
            row.error(
                min(size + 1, len(row)), f"{card.value('TYPE')} has {size} nodes, found {count}"
            )
            continue
        nodes = [deck.node(row, i, f"node {i}") for i in range(1, size + 1)]
        if label is not None and None not in nodes:
            table.append([label, *nodes])
            lines.append(row.where.line)
    return np.array(table, dtype=np.int64).reshape(-1, size + 1), int_array(lines)


def _joined(rows: Iterator[Row], size: int) -> Iterator[Row]:
    """Rows of at least ``size`` fields: a line that ends with a comma continues on the next."""
    open_row: Row | None = None
    for row in rows:
        last = row.text
        if open_row is not None:
            columns = open_row.columns + [len(open_row.text)] * len(row.fields)
            row = replace(open_row, fields=open_row.fields + row.fields, columns=columns)
        open_row = row if len(row) < size and last.rstrip().endswith(",") else None
        if open_row is None:
            yield row
    if open_row is not None:
        yield open_row


@keyword("NSET", "NSET GENERATE ELSET INSTANCE INTERNAL UNSORTED")
def nset(deck: Deck, card: Card) -> None:
    """``*NSET, NSET=[, GENERATE][, ELSET=]``."""
    if card.has("UNSORTED"):
        deck.unsorted.add(key(card.value("NSET")))
    if card.has("ELSET"):
        _nodes_of_elset(deck, card)
    else:
        _set(deck, card, deck.scope.nsets, "NSET")


@keyword("ELSET", "ELSET GENERATE INSTANCE INTERNAL")
def elset(deck: Deck, card: Card) -> None:
    """``*ELSET, ELSET=[, GENERATE]``."""
    _set(deck, card, deck.scope.elsets, "ELSET")


def _nodes_of_elset(deck: Deck, card: Card) -> None:
    name = card.required("NSET")
    target = card.required("ELSET")
    card.no_rows()
    if name and target:
        found = deck.scope.nsets.setdefault(key(name), NamedSet(name, card.where))
        found.entries.append(Entry(card.at("ELSET"), int_array(()), "elset:" + target))


def _set(deck: Deck, card: Card, table: dict[str, NamedSet], parameter: str) -> None:
    name, instance, prefix = card.required(parameter), card.value("INSTANCE"), ""
    if not name:
        return
    if card.has("INSTANCE"):
        prefix = instance + "."
        if key(instance) not in deck.instances:
            hint = nearest(instance, deck.instances)
            card.error(f"no instance named {instance}", "INSTANCE", hint)
    found, of = table.setdefault(key(name), NamedSet(name, card.where)), prefix and "@" + prefix
    if card.has("GENERATE"):
        for row in card.rows():
            with suppress(Refused):
                found.entries.append(Entry(row.where, _generated(row), of))
        return
    for row in _set_rows(card, found, of):
        run: list[int] = []
        for index, text in enumerate(row.fields):
            if not text:
                continue
            if numerals.is_integer(text):
                label = _label(row, "the number", index)
                if label is not None:
                    run.append(label)
            elif numerals.is_number(text):
                row.error(index, f"expected a whole number or a set name, found {text!r}")
            else:
                if run:
                    found.entries.append(Entry(row.where, int_array(run), of))
                    run = []
                found.entries.append(Entry(row.at(index), int_array(()), prefix + text))
        if run:
            found.entries.append(Entry(row.where, int_array(run), of))


def _set_rows(card: Card, found: NamedSet, name: str) -> Iterator[Row]:
    """Rows of a set; long pieces that contain only labels are read in bulk."""
    for chunk in card.chunks:
        if chunk.stop - chunk.start > LONG:
            labels = parse_labels(chunk.source.data, chunk.start, chunk.stop, chunk.line)
            if labels is not None:
                where = Location(chunk.source.name, chunk.line)
                found.entries.append(Entry(where, labels, name))
                continue
        yield from card.rows_of(chunk)


def _generated(row: Row) -> Ints:
    row.at_most(3)
    first, last = row.integer(0, "the first number"), row.integer(1, "the last number")
    first, last, by = complete([first, last, row.integer(2, "the increment", 1)])
    if by <= 0 or last < first or first < 1:
        row.refuse(0, "expected first <= last, both >= 1, and increment >= 1")
    if (last - first) % by:
        row.refuse(1, f"{last} is not reached from {first} in steps of {by}")
    if (last - first) // by >= MAX_GENERATE:
        row.refuse(1, f"{(last - first) // by + 1} entries; at most {MAX_GENERATE} are taken")
    return np.arange(first, last + 1, by, dtype=np.int64)


@keyword(
    "SURFACE", "NAME TYPE INTERNAL FILLETRADIUS COMBINE", "REGIONTYPE TRIM MAXRATIO", place="model"
)
def surface(deck: Deck, card: Card) -> None:
    """``*SURFACE, NAME=[, TYPE=ELEMENT|NODE|SEGMENTS]``: element or set, face; or nodes."""
    name = card.required("NAME")
    if not name:
        return
    kind = card.choice("TYPE", ("ELEMENT", "NODE", "SEGMENTS"), "ELEMENT")
    found = deck.scope.surfaces.get(key(name))
    if found is not None:
        text = f"surface {name} is already defined in {found.card.where}"
        card.refuse(text, "NAME", hint="put all its lines under one card")
    found = deck.scope.surfaces[key(name)] = Surface(name, card, kind == "NODE")
    if kind == "SEGMENTS":
        profile(card, found)
        return
    if card.has("COMBINE"):
        _combination(card, found)
        return
    for row in card.rows():
        row.at_most(2)
        if row.get(0):
            found.rows.append(SurfaceRow(card, row.where, row.text, row.get(0), key(row.get(1))))
        else:
            row.error(0, "an element number or a set is missing")
    if not found.rows:
        deck.note(f"{card.where}: surface {name} is empty")


def _combination(card: Card, found: Surface) -> None:
    """``COMBINE=``: names of surfaces, of which a difference takes two."""
    found.combine = card.choice("COMBINE", ("UNION", "DIFFERENCE", "INTERSECTION"), "UNION")
    for row in card.rows():
        for index in range(len(row)):
            if row.get(index):
                found.rows.append(SurfaceRow(card, row.at(index), row.text, row.get(index), ""))
    if len(found.rows) < 2 or (found.combine == "DIFFERENCE" and len(found.rows) > 2):
        card.error("the names of two surfaces are expected")


def _label(row: Row, what: str, index: int = 0) -> int | None:
    label = row.integer(index, what)
    if label is not None and label < 1:
        row.error(index, f"{what} must be >= 1, not {label}")
        return None
    return label


def _extend(table: dict[str, NamedSet], card: Card, parameter: str, labels: list[Ints]) -> None:
    name = card.value(parameter)
    if not name:
        card.refuse(f"{parameter}= needs a name", parameter)
    found = table.setdefault(key(name), NamedSet(name, card.where))
    found.entries.extend(Entry(Location(card.where.file, card.where.line), part) for part in labels)

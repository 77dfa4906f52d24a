"""Cards of temperatures, thermal expansion and initial stress."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, cast

from corota.errors import InputError
from corota.io.deck.cards.material import open_material
from corota.io.deck.cards.step import loads_of
from corota.io.deck.drafts import Draft, InitialDraft
from corota.model.loads import InitialStress, InitialTemperature, Temperature
from corota.model.materials import Expansion

if TYPE_CHECKING:
    from corota.arrays import Ints
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card, Row

#: Coefficients by ``TYPE=``.
_TYPES = {"ISO": 1, "ORTHO": 3}
#: Where xx, yy, zz, xy stand among the numbers of a line of initial stress.
_STRESSES = {1: (0,), 3: (0, 1, 2), 4: (0, 1, 2, 3), 6: (0, 1, 2, 3)}


def expansion(deck: Deck, card: Card) -> None:
    """``*EXPANSION[, TYPE=ISO or ORTHO][, ZERO=]``: coefficients, temperature."""
    found = open_material(deck, card)
    kind = deck.choice(card, "TYPE", _TYPES, "ISO")
    zero = deck.parameter_number(card, "ZERO", 0.0, float("-inf"))
    count = _TYPES[kind]
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing: the coefficient of expansion")
    values, temperatures = [], []
    for row in rows:
        deck.extra_fields(card, row, count + 1)
        numbers = [deck.real(card, row, i, "the coefficient") for i in range(count)]
        at = deck.real(card, row, count, "the temperature", 0.0)
        if at is None or None in numbers:
            return
        alphas = cast("list[float]", numbers)
        values.append(alphas[0] if count == 1 else (alphas[0], alphas[1], alphas[2]))
        temperatures.append(at)
    if found is None or not values:
        return
    try:
        table = tuple(temperatures) if len(values) > 1 else ()
        found.expansion = Expansion(tuple(values), table, zero)
    except InputError as error:
        deck.error(card, rows[0].where, error.message)


def temperature(deck: Deck, card: Card) -> None:
    """``*TEMPERATURE[, OP=][, AMPLITUDE=]``: node or set, temperature."""
    now = loads_of(deck, card, "temperature")
    if now is None:
        return
    for row in card.rows():
        value = _temperature(deck, card, row)
        if value is not None:
            draft = Draft("temperature", card, row, row.get(0), (value,), -1)
            draft.amplitude = card.value("AMPLITUDE")
            now.loads.append(draft)


def _temperature(deck: Deck, card: Card, row: Row) -> float | None:
    if not row.get(0):
        deck.row_error(card, row, 0, "a node number or a set is missing")
        return None
    value = deck.real(card, row, 1, "the temperature")
    for index in range(2, len(row)):
        # CAE repeats the temperature for each point of the thickness.
        if row.get(index) and deck.real(card, row, index, "the temperature") != value:
            deck.row_error(
                card, row, index, "a temperature gradient through the thickness is not supported"
            )
            return None
    return value


def initial_temperature(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=TEMPERATURE``: node or set, temperature."""
    for row in card.rows():
        value = _temperature(deck, card, row)
        if value is not None:
            draft = Draft("initial temperature", card, row, row.get(0), (value,))
            deck.initial.append(InitialDraft(draft))


def initial_stress(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=STRESS``: stresses of elements.

    As Abaqus: element or set, then xx (of lines), xx, yy, xy, or xx, yy, zz, xy[, xz, yz]. As
    CalculiX: element, integration point, xx, yy, zz, xy, xz, yz.
    """
    for row in card.rows():
        deck.extra_fields(card, row, 8)
        used = max((i + 1 for i in range(len(row)) if row.get(i)), default=0)
        first = 2 if used == 8 else 1
        count = used - first
        if count not in _STRESSES:
            deck.row_error(
                card,
                row,
                0,
                "expected an element or a set and 1, 3, 4 or 6 stresses, or an element, an "
                "integration point and 6 stresses",
            )
            continue
        point = deck.integer(card, row, 1, "the integration point") if first == 2 else 0
        numbers = [deck.real(card, row, i, "the stress") for i in range(first, used)]
        if point is None or None in numbers:
            continue
        given = [float(v or 0.0) for v in numbers]
        if any(given[4:]):
            deck.row_error(card, row, first + 4, "shear stress out of the plane is not supported")
            continue
        if count == 3:  # xx, yy, xy
            given = [given[0], given[1], 0.0, given[2]]
        stress = (*given[:4], 0.0, 0.0, 0.0)[:4]
        draft = Draft("initial stress", card, row, row.get(0), stress)
        deck.initial.append(InitialDraft(draft, point))


def build_initial(targets: Targets) -> None:
    """Add initial temperatures and stresses to the model."""
    deck, model = targets.deck, targets.model
    points: dict[tuple[int, ...], tuple[float, ...]] = {}
    for item in deck.initial:
        draft = item.draft
        if draft.kind == "initial temperature":
            nodes = targets.nodes(draft)
            if nodes is not None:
                model.initial_temperatures.append(
                    InitialTemperature(nodes, draft.value[0], draft.row.where)
                )
            continue
        found = targets.cells_of(draft)
        if found is None:
            continue
        if item.point:
            cell = tuple(found.cells.tolist())
            if points.get(cell, draft.value) != draft.value:
                deck.row_error(
                    draft.card,
                    draft.row,
                    1,
                    "the points of an element have different stresses, and their order differs "
                    "here",
                    "give each element one stress",
                )
                continue
            if cell in points:
                continue
            points[cell] = draft.value
        model.initial_stresses.append(InitialStress(found.cells, draft.value, draft.row.where))


def build_temperature(draft: Draft, nodes: str | Ints, amplitude: str) -> Temperature:
    """A temperature of the model."""
    return Temperature(nodes, draft.value[0], amplitude, draft.row.where)

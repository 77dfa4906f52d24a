"""Cards of temperatures, thermal expansion and initial stress."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from corota.errors import InputError
from corota.io.deck.card import Refused, complete
from corota.io.deck.cards.material import open_material
from corota.io.deck.cards.step import loads_of
from corota.io.deck.drafts import Draft, InitialDraft
from corota.io.deck.keywords import keyword
from corota.model.loads import InitialStress, InitialTemperature
from corota.model.materials import Expansion

if TYPE_CHECKING:
    from corota.io.deck.build.targets import Targets
    from corota.io.deck.card import Card, Row
    from corota.io.deck.deck import Deck

#: Coefficients by ``TYPE=``.
_TYPES = {"ISO": 1, "ORTHO": 3}


@keyword("EXPANSION", "TYPE ZERO DEPENDENCIES", place="model")
def expansion(deck: Deck, card: Card) -> None:
    """``*EXPANSION[, TYPE=ISO or ORTHO][, ZERO=]``: coefficients, temperature."""
    found = open_material(deck, card)
    count = _TYPES[card.choice("TYPE", _TYPES, "ISO")]
    zero = card.number("ZERO", 0.0, float("-inf"))
    names = ["the coefficient"] * count + ["the temperature"]
    rows = card.lines("the coefficient of expansion")
    values, temperatures = [], []
    for row in rows:
        row.at_most(count + 1)
        *alphas, at = row.reals(names, 0.0, required=count)
        values.append(alphas[0] if count == 1 else (alphas[0], alphas[1], alphas[2]))
        temperatures.append(at)
    try:
        table = tuple(temperatures) if len(values) > 1 else ()
        found.expansion = Expansion(tuple(values), table, zero)
    except InputError as error:
        deck.error(card, rows[0].where, error.message)


@keyword("TEMPERATURE", "OP AMPLITUDE", "LOADCASE")
def temperature(deck: Deck, card: Card) -> None:
    """``*TEMPERATURE[, OP=][, AMPLITUDE=]``: node or set, temperature."""
    now = loads_of(deck, card, "temperature")
    for row in card.rows():
        with suppress(Refused):
            now.loads.append(Draft("temperature", row, row.get(0), _temperature(row)))


def _temperature(row: Row) -> tuple[float]:
    if not row.get(0):
        row.refuse(0, "a node number or a set is missing")
    value = row.real(1, "the temperature")
    for index in range(2, len(row)):
        # CAE repeats the temperature for each point of the thickness.
        if row.get(index) and row.real(index, "the temperature") != value:
            row.refuse(index, "a temperature gradient through the thickness is not supported")
    return (complete([value])[0],)


def initial_temperature(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=TEMPERATURE``: node or set, temperature."""
    for row in card.rows():
        with suppress(Refused):
            draft = Draft("initial temperature", row, row.get(0), _temperature(row))
            deck.initial.append(InitialDraft(draft))


def initial_stress(deck: Deck, card: Card) -> None:
    """``*INITIAL CONDITIONS, TYPE=STRESS``: stresses of elements.

    As Abaqus: element or set, then xx (of lines), xx, yy, xy, or xx, yy, zz, xy[, xz, yz]. As
    CalculiX: element, integration point, xx, yy, zz, xy, xz, yz.
    """
    for row in card.rows():
        with suppress(Refused):
            deck.initial.append(_stress(row))


def _stress(row: Row) -> InitialDraft:
    row.at_most(8)
    used = max((i + 1 for i in range(len(row)) if row.get(i)), default=0)
    first = 2 if used == 8 else 1
    count = used - first
    if count not in (1, 3, 4, 6):
        row.refuse(
            0,
            "expected an element or a set and 1, 3, 4 or 6 stresses, or an element, an "
            "integration point and 6 stresses",
        )
    point = row.integer(1, "the integration point") if first == 2 else 0
    given = row.reals(["the stress"] * count, start=first)
    if any(given[4:]):
        row.refuse(first + 4, "shear stress out of the plane is not supported")
    if count == 3:  # xx, yy, xy
        given = [given[0], given[1], 0.0, given[2]]
    draft = Draft("initial stress", row, row.get(0), (*given[:4], 0.0, 0.0, 0.0)[:4])
    return InitialDraft(draft, *complete([point]))


def build_initial(targets: Targets) -> None:
    """Add initial temperatures and stresses to the model."""
    model = targets.model
    points: dict[tuple[int, ...], tuple[float, ...]] = {}
    for item in targets.deck.initial:
        draft = item.draft
        if draft.kind == "initial temperature":
            nodes = targets.nodes(draft)
            if nodes is not None:
                found = InitialTemperature(nodes, draft.value[0], draft.row.where)
                model.initial_temperatures.append(found)
            continue
        elements = targets.cells_of(draft)
        if elements is None:
            continue
        if item.point:
            cell = tuple(elements.cells.tolist())
            if points.get(cell, draft.value) != draft.value:
                draft.row.error(
                    1,
                    "the points of an element have different stresses, and their order differs "
                    "here",
                    "give each element one stress",
                )
            if cell in points:
                continue
            points[cell] = draft.value
        model.initial_stresses.append(InitialStress(elements.cells, draft.value, draft.row.where))

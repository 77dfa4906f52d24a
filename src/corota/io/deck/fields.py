"""``DEPENDENCIES=``: the constants of a card at field variables that the whole model has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from corota.io.deck import numerals
from corota.io.deck.card import Card, Row, key
from corota.io.deck.laws import LAWS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.io.deck.deck import Deck

#: Constants before the temperature, of the cards whose field variables are read; those of elastic
#: laws are in their table.
COUNTS = {"DENSITY": 1, "EXPANSION": 1, "PLASTIC": 2, "ELASTIC": 2}
#: Fields of a data line.
PER_ROW = 8


def find_fields(cards: Iterable[Card]) -> dict[int, float | None]:
    """Value of each field variable that a deck gives; ``None`` if it is not the same everywhere.

    A variable that no card gives is zero.
    """
    found: dict[int, float | None] = {}
    for card in cards:
        initial = card.keyword == "INITIALCONDITIONS" and key(card.value("TYPE")) == "FIELD"
        if not initial and card.keyword != "FIELD":
            continue
        number = int(card.value("VARIABLE")) if card.value("VARIABLE").isdigit() else 1
        for row in card.rows():
            try:
                value: float | None = numerals.real(row.get(1) or "0")
            except ValueError:
                value = None
            # What follows on the first value is compared with it; a *FIELD alone starts at zero.
            before = found.setdefault(number, value if initial else 0.0)
            if value != before:
                found[number] = None
    return found


def pick_rows(deck: Deck, card: Card) -> None:
    """Leave the data lines of a card at the field variables of the model, without these."""
    n_fields, before = card.integer("DEPENDENCIES", 1, 0), deck.n_errors
    if not n_fields:
        return
    kind = key(card.value("TYPE") or card.value("HARDENING"))
    count = COUNTS[card.keyword]
    if card.keyword == "EXPANSION" and kind.startswith("ORTHO"):
        count = 3
    elif card.keyword == "ELASTIC" and kind in LAWS:
        count = len(LAWS[kind].constants)
    n_rows, used = count // PER_ROW + 1, count % PER_ROW
    rows, current = list(card.rows()), []
    for number in range(1, n_fields + 1):
        value = deck.fields.get(number, 0.0)
        if value is None:
            card.error(
                f"field variable {number} is not the same everywhere and at all times",
                "DEPENDENCIES",
                hint="constants may follow the temperature: give the variable by *TEMPERATURE",
            )
        current.append(value or 0.0)
    groups: dict[tuple[float, ...], list[Row]] = {}
    if used + 1 + n_fields > PER_ROW or (card.keyword == "PLASTIC" and kind == "COMBINED"):
        text = "constants that follow so many field variables are not part of this version"
        card.error(text, "DEPENDENCIES", hint="leave out variables that are zero")
    for first in range(0, len(rows), n_rows):
        mine = rows[first : first + n_rows]
        last = mine[-1]
        last.at_most(used + 1 + n_fields)
        columns = range(used + 1, used + 1 + n_fields)
        values = [last.real(i, "the field variable", 0.0) for i in columns]
        plain = replace(last, fields=last.fields[: used + 1], columns=last.columns[: used + 1])
        at = tuple(float(v or 0.0) for v in values)
        groups.setdefault(at, []).extend([*mine[:-1], plain])
    if not groups:
        return
    if deck.n_errors > before:
        card.picked = next(iter(groups.values()))
        return
    card.picked = _at(card, groups, tuple(current))
    if deck.n_errors == before:
        card.note(
            f"the constants are those at the field variables "
            f"{', '.join(f'{v:g}' for v in current)}, which the whole model has"
        )


def _at(
    card: Card,
    groups: dict[tuple[float, ...], list[Row]],
    current: tuple[float, ...],
) -> list[Row]:
    """Lines at values of the field variables: linear between two, constant outside."""
    if current in groups:
        return groups[current]
    if len(groups) == 1:
        return next(iter(groups.values()))
    if len(current) == 1:
        at, given = current[0], sorted(groups)
        if not given[0][0] < at < given[-1][0]:
            return groups[given[0] if at < given[0][0] else given[-1]]
        above = next(i for i, values in enumerate(given) if values[0] > at)
        (low,), (high,) = given[above - 1 : above + 1]
        share = (at - low) / (high - low)
        mixed = _mixed(groups[(low,)], groups[(high,)], share)
        if mixed:
            return mixed
    card.error(
        f"no line is at the field variables {', '.join(f'{v:g}' for v in current)} of the model",
        "DEPENDENCIES",
        hint="give the constants there; *INITIAL CONDITIONS, TYPE=FIELD gives the variables",
    )
    return next(iter(groups.values()))


def _mixed(low: list[Row], high: list[Row], share: float) -> list[Row]:
    """Lines between those of two values; empty where they do not correspond."""
    found = []
    for a, b in zip(low, high, strict=False):
        if len(low) != len(high) or len(a) != len(b):
            return []
        fields = []
        for one, two in zip(a.fields, b.fields, strict=True):
            try:
                x, y = numerals.real(one or "0"), numerals.real(two or "0")
            except ValueError:
                return []
            fields.append(one if x == y else repr((1.0 - share) * x + share * y))
        found.append(replace(a, fields=fields))
    return found

"""Tables over time: amplitudes and time points."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.amplitudes import Curve, smooth_steps
from corota.io.deck.lexer import Card, key
from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck


#: Curves without an end, and their numbers after the initial value, size and start.
ENDLESS = {
    "PERIODIC": (),
    "DECAY": ("the decay time",),
    "MODULATED": ("the first frequency", "the second frequency"),
}


def amplitude(deck: Deck, card: Card) -> None:
    """``*AMPLITUDE, NAME=[, DEFINITION=]``: pairs of time and factor, or the curve's numbers."""
    name = deck.required(card, "NAME")
    total = deck.choice(card, "TIME", ("STEPTIME", "TOTALTIME"), "STEPTIME") == "TOTALTIME"
    kinds = ("TABULAR", "EQUALLYSPACED", "SMOOTHSTEP", *ENDLESS)
    kind = deck.choice(card, "DEFINITION", kinds, "TABULAR")
    if deck.choice(card, "VALUE", ("RELATIVE", "ABSOLUTE"), "RELATIVE") == "ABSOLUTE":
        deck.absolute.add(key(name))
    if kind in ENDLESS:
        _endless(deck, card, kind, name, total)
        return
    table = _equally_spaced(deck, card) if kind == "EQUALLYSPACED" else _pairs(deck, card)
    if table is None or not name or _amplitude_twice(deck, card, name):
        return
    times, values = (np.array(column) for column in table)
    try:
        if kind == "SMOOTHSTEP" and len(times) > 1 and (np.diff(times) > 0.0).all():
            times, values = smooth_steps(times, values)
        deck.amplitudes[key(name)] = Amplitude(times, values, total, name, card.where)
    except InputError as error:
        deck.error(card, card.where, error.message)


def _pairs(deck: Deck, card: Card) -> tuple[list[float], list[float]] | None:
    shift_x = deck.parameter_number(card, "SHIFTX", 0.0, -math.inf)
    shift_y = deck.parameter_number(card, "SHIFTY", 0.0, -math.inf)
    times: list[float] = []
    values: list[float] = []
    for row in card.rows():
        for index in range(0, len(row), 2):
            if not row.get(index) and not row.get(index + 1):
                continue
            time = deck.real(card, row, index, "the time")
            value = deck.real(card, row, index + 1, "the factor")
            if time is None or value is None:
                return None
            if times and time + shift_x <= times[-1]:
                deck.row_error(
                    card,
                    row,
                    index,
                    f"the times must increase: {times[-1] - shift_x:g} is followed by {time:g}",
                )
                return None
            times.append(time + shift_x)
            values.append(value + shift_y)
    return times, values


def _equally_spaced(deck: Deck, card: Card) -> tuple[list[float], list[float]] | None:
    if not deck.required(card, "FIXEDINTERVAL", "FIXED INTERVAL"):
        return None
    by = deck.parameter_number(card, "FIXEDINTERVAL", 0.0, 0.0)
    first = deck.parameter_number(card, "BEGIN", 0.0, -math.inf)
    found = [
        deck.real(card, row, i, "the factor")
        for row in card.rows()
        for i in range(len(row))
        if row.get(i)
    ]
    if None in found or by <= 0.0:
        if by <= 0.0:
            deck.error(card, card.at("FIXEDINTERVAL"), "FIXED INTERVAL must be > 0")
        return None
    return [first + by * i for i in range(len(found))], [float(v or 0.0) for v in found]


def _endless(deck: Deck, card: Card, kind: str, name: str, total: bool) -> None:
    """Numbers of a curve without an end.

    ``PERIODIC``: terms, omega, start, A0; pairs A, B. ``DECAY``: A0, A, start, decay time.
    ``MODULATED``: A0, A, start and two frequencies.
    """
    rows = list(card.rows())
    if not rows:
        deck.error(card, card.where, "a data line is missing")
        return
    if kind == "PERIODIC":
        count = deck.integer(card, rows[0], 0, "the number of terms")
        head = [
            deck.real(card, rows[0], i + 1, what, 0.0 if i else None)
            for i, what in enumerate(("the frequency", "the start", "the initial value"))
        ]
        if count is None or None in head:
            return
        fields = [(row, i) for row in rows[1:] for i in range(len(row))][: 2 * max(count, 0)]
        pairs = [deck.real(card, row, i, "a coefficient", 0.0) for row, i in fields]
        if None in pairs:
            return
        if count < 1 or len(pairs) < 2 * count or head[0] == 0.0:
            deck.error(card, card.where, f"{count} terms need as many pairs A, B and a frequency")
            return
        numbers = [float(v or 0.0) for v in head + pairs]
    else:
        names = ("the initial value", "the size", "the start", *ENDLESS[kind])
        found = [deck.real(card, rows[0], i, what) for i, what in enumerate(names)]
        if None in found:
            return
        numbers = [float(v or 0.0) for v in found]
        if min(numbers[3:]) <= 0.0:
            deck.row_error(card, rows[0], 3, f"{' and '.join(ENDLESS[kind])} must be > 0")
            return
    if name and not _amplitude_twice(deck, card, name):
        deck.curves[key(name)] = Curve(kind, numbers, total, name, card.where)


def _amplitude_twice(deck: Deck, card: Card, name: str) -> bool:
    found = deck.amplitudes.get(key(name)) or deck.curves.get(key(name))
    if found is not None:
        text = f"amplitude {name} is already defined in {found.where}"
        deck.error(card, card.at("NAME"), text)
    return found is not None


def time_points(deck: Deck, card: Card) -> None:
    """``*TIME POINTS, NAME=[, GENERATE]``: times at which output is written."""
    name = deck.required(card, "NAME")
    if card.has("TIME") and key(card.value("TIME")) == "TOTALTIME":
        deck.error(card, card.at("TIME"), "time points count from the start of the step here")
    times: list[float] = []
    for row in card.rows():
        if card.has("GENERATE"):
            numbers = [
                deck.real(card, row, i, text)
                for i, text in enumerate(("the first time", "the last time", "the interval"))
            ]
            if None in numbers:
                return
            first, last, by = (float(v or 0.0) for v in numbers)
            if by <= 0.0 or last < first or (last - first) / by > 1e6:
                deck.row_error(
                    card, row, 0, "expected first <= last and an interval > 0 (at most 1e6 times)"
                )
                return
            count = int((last - first) / by * (1 + 1e-12)) + 1
            times += [first + by * i for i in range(count)]
            continue
        for index in range(len(row)):
            value = deck.real(card, row, index, "the time")
            if value is None:
                return
            times.append(value)
    if not times:
        deck.error(card, card.where, "a data line with times is missing")
    elif any(b <= a for a, b in pairwise(times)):
        deck.error(card, card.where, "the times must increase")
    elif name:
        deck.time_points[key(name)] = np.array(times)

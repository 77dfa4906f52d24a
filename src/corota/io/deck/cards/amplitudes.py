"""Tables over time: amplitudes and time points."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.io.deck.amplitudes import Curve, smooth_steps
from corota.io.deck.card import Card, Refused, complete, key
from corota.io.deck.keywords import keyword
from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck


#: Curves without an end, and their numbers after the initial value, size and start.
ENDLESS = {
    "PERIODIC": (),
    "DECAY": ("the decay time",),
    "MODULATED": ("the first frequency", "the second frequency"),
}


@keyword("AMPLITUDE", "NAME TIME SHIFTX SHIFTY DEFINITION VALUE FIXEDINTERVAL BEGIN", "SMOOTH")
def amplitude(deck: Deck, card: Card) -> None:
    """``*AMPLITUDE, NAME=[, DEFINITION=]``: pairs of time and factor, or the curve's numbers."""
    name = card.required("NAME")
    total = card.choice("TIME", ("STEPTIME", "TOTALTIME"), "STEPTIME") == "TOTALTIME"
    kinds = ("TABULAR", "EQUALLYSPACED", "SMOOTHSTEP", *ENDLESS)
    kind = card.choice("DEFINITION", kinds, "TABULAR")
    if card.choice("VALUE", ("RELATIVE", "ABSOLUTE"), "RELATIVE") == "ABSOLUTE":
        deck.absolute.add(key(name))
    if kind in ENDLESS:
        numbers = _endless(card, kind)
    else:
        columns = _equally_spaced(card) if kind == "EQUALLYSPACED" else _pairs(card)
    before = deck.amplitudes.get(key(name)) or deck.curves.get(key(name))
    if name and before is not None:
        card.refuse(f"amplitude {name} is already defined in {before.where}", "NAME")
    if name and kind in ENDLESS:
        deck.curves[key(name)] = Curve(kind, numbers, total, name, card.where)
    elif name:
        times, values = (np.array(column) for column in columns)
        if kind == "SMOOTHSTEP" and len(times) > 1 and (np.diff(times) > 0.0).all():
            times, values = smooth_steps(times, values)
        deck.amplitudes[key(name)] = Amplitude(times, values, total, name, card.where)


def _pairs(card: Card) -> tuple[list[float], list[float]]:
    shift_x = card.number("SHIFTX", 0.0, -math.inf)
    shift_y = card.number("SHIFTY", 0.0, -math.inf)
    times: list[float] = []
    values: list[float] = []
    for row in card.rows():
        for index in range(0, len(row), 2):
            if not row.get(index) and not row.get(index + 1):
                continue
            time, value = row.reals(("the time", "the factor"), start=index)
            if times and time + shift_x <= times[-1]:
                before = f"{times[-1] - shift_x:g}"
                row.refuse(index, f"the times must increase: {before} is followed by {time:g}")
            times.append(time + shift_x)
            values.append(value + shift_y)
    return times, values


def _equally_spaced(card: Card) -> tuple[list[float], list[float]]:
    if not card.required("FIXEDINTERVAL", "FIXED INTERVAL"):
        raise Refused
    by = card.number("FIXEDINTERVAL", 0.0, 0.0)
    first = card.number("BEGIN", 0.0, -math.inf)
    fields = [(row, i) for row in card.rows() for i in range(len(row)) if row.get(i)]
    found = [row.real(i, "the factor") for row, i in fields]
    if by <= 0.0:
        card.refuse("FIXED INTERVAL must be > 0", "FIXEDINTERVAL")
    return [first + by * i for i in range(len(found))], complete(found)


def _endless(card: Card, kind: str) -> list[float]:
    """Numbers of a curve without an end.

    ``PERIODIC``: terms, omega, start, A0; pairs A, B. ``DECAY``: A0, A, start, decay time.
    ``MODULATED``: A0, A, start and two frequencies.
    """
    rows = list(card.rows())
    if not rows:
        card.refuse("a data line is missing")
    if kind != "PERIODIC":
        names = ("the initial value", "the size", "the start", *ENDLESS[kind])
        numbers = rows[0].reals(names)
        if min(numbers[3:]) <= 0.0:
            rows[0].refuse(3, f"{' and '.join(ENDLESS[kind])} must be > 0")
        return numbers
    terms = rows[0].integer(0, "the number of terms")
    names = ("the frequency", "the start", "the initial value")
    head = [rows[0].real(i, what, 0.0 if i > 1 else None) for i, what in enumerate(names, 1)]
    (count,), numbers = complete([terms]), complete(head)
    fields = [(row, i) for row in rows[1:] for i in range(len(row))][: 2 * max(count, 0)]
    pairs = complete([row.real(i, "a coefficient", 0.0) for row, i in fields])
    if count < 1 or len(pairs) < 2 * count or numbers[0] == 0.0:
        card.refuse(f"{count} terms need as many pairs A, B and a frequency")
    return numbers + pairs


@keyword("TIME POINTS", "NAME TIME GENERATE")
def time_points(deck: Deck, card: Card) -> None:
    """``*TIME POINTS, NAME=[, GENERATE]``: times at which output is written."""
    name = card.required("NAME")
    if card.has("TIME") and key(card.value("TIME")) == "TOTALTIME":
        card.error("time points count from the start of the step here", "TIME")
    times: list[float] = []
    for row in card.rows():
        if card.has("GENERATE"):
            first, last, by = row.reals(("the first time", "the last time", "the interval"))
            if by <= 0.0 or last < first or (last - first) / by > 1e6:
                row.refuse(0, "expected first <= last and an interval > 0 (at most 1e6 times)")
            count = int((last - first) / by * (1 + 1e-12)) + 1
            times += [first + by * i for i in range(count)]
        else:
            for index in range(len(row)):
                times.append(row.number(index, "the time"))
    if not times:
        card.error("a data line with times is missing")
    elif any(b <= a for a, b in pairwise(times)):
        card.error("the times must increase")
    elif name:
        deck.time_points[key(name)] = np.array(times)

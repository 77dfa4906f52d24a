"""Cards of steps, supports, loads and amplitudes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.amplitudes import Curve, smooth_steps
from corota.io.deck.deck import nearest
from corota.io.deck.drafts import Draft, StepDraft
from corota.io.deck.lexer import key
from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck
    from corota.io.deck.lexer import Card, Row
    from corota.model.loads import LoadKind

#: Names of Abaqus for groups of degrees of freedom (numbers from 1).
NAMED_SUPPORTS = {
    "ENCASTRE": (1, 2, 3, 4, 5, 6),
    "PINNED": (1, 2, 3),
    "XSYMM": (1, 5, 6),
    "YSYMM": (2, 4, 6),
    "ZSYMM": (3, 4, 5),
    "XASYMM": (2, 3, 4),
    "YASYMM": (1, 3, 5),
    "ZASYMM": (1, 2, 6),
}
#: What a support prescribes, and how often that is integrated to a displacement.
RATES = {"DISPLACEMENT": 0, "VELOCITY": 1, "ACCELERATION": 2}
#: Cards that ``OP=NEW`` concerns together.
_KINDS = {
    "support": "supports (*BOUNDARY)",
    "force": "nodal forces (*CLOAD)",
    "distributed": "distributed loads (*DLOAD, *DSLOAD)",
    "temperature": "temperatures (*TEMPERATURE)",
}
_TRACTION = re.compile(r"(TRVEC|TRSHR)(\d{1,9})\Z", re.ASCII)
#: Loads that other programs know, and what to give instead.
_OTHER_LOADS = (
    (re.compile(r"HP\d?\Z"), "give each edge its mean pressure: P1 to P4, or P on surfaces"),
    (
        re.compile(r"(P\d?|BX|BY|TRVEC\d?|TRSHR\d?)NU\Z"),
        "no user subroutine is called: give values",
    ),
    (re.compile(r"(ROTA|CORIO)\Z"), "turn the base by *BOUNDARY, or give BX and BY"),
    (re.compile(r"ROTDYNF\Z"), "CENTRIF takes the square of the angular velocity"),
    (re.compile(r"(F|VBF|SBF|SP)\d?\Z"), "give springs by *SPRING, pressures by P1 to P4"),
)
_FACE = re.compile(r"P(\d{1,9})\Z", re.ASCII)


def step(deck: Deck, card: Card) -> None:
    """``*STEP[, NLGEOM][, INC=][, AMPLITUDE=RAMP|STEP]``."""
    if deck.step is not None:
        deck.error(
            card, card.where, f"the step of {deck.step.card.where} has no *END STEP before this"
        )
    nlgeom = bool(deck.steps and deck.steps[-1].nlgeom)
    if card.has("NLGEOM"):
        if deck.choice(card, "NLGEOM", ("YES", "NO", ""), "YES") != "NO":
            nlgeom = True
        elif nlgeom:
            deck.notes.append(
                f"{card.where}: NLGEOM=NO after a step with NLGEOM has no effect: large "
                "rotations stay on, because the structure would jump to the solution of the "
                "linear theory"
            )
    limit = deck.parameter_integer(card, "INC", 100, 1)
    ramp = deck.choice(card, "AMPLITUDE", ("RAMP", "STEP"), "RAMP") == "RAMP"
    deck.step = StepDraft(card, nlgeom, limit, ramp, restart=deck.restart)
    deck.steps.append(deck.step)
    deck.material = None


def end_step(deck: Deck, card: Card) -> None:
    """``*END STEP``."""
    deck.no_rows(card)
    if deck.step is None:
        deck.error(card, card.where, "there is no open *STEP")
    elif deck.step.procedure is None:
        deck.error(
            card,
            card.where,
            f"the step of {deck.step.card.where} has no procedure",
            hint="put *STATIC after *STEP",
        )
    elif deck.step.card.has("PERTURBATION") and deck.step.make is None:
        if deck.steps[0] is deck.step:
            deck.note(f"{deck.step.card.where}: PERTURBATION of the first step: it is linear")
        else:
            deck.error(
                deck.step.card,
                deck.step.card.at("PERTURBATION"),
                "a linear perturbation of a loaded state is not part of this version",
                hint="leave PERTURBATION out: loads then continue from the step before",
            )
    deck.step = None


def static(deck: Deck, card: Card) -> None:
    """Read ``*STATIC[, DIRECT]``: first increment, period, smallest and largest increment."""
    now = open_step(deck, card)
    if now is None:
        return
    if now.procedure is not None:
        deck.error(card, card.where, "the step already has a procedure")
        return
    now.procedure, now.direct = card, card.has("DIRECT")
    step_times(deck, card, now)


def step_times(deck: Deck, card: Card, now: StepDraft) -> None:
    """Read the data line of a procedure: first increment, period, smallest, largest."""
    rows = list(card.rows())
    if len(rows) > 1:
        deck.row_error(card, rows[1], 0, "one data line is expected")
    if not rows:
        return
    deck.extra_fields(card, rows[0], 4)
    names = ("the first increment", "the period", "the smallest increment", "the largest increment")
    values = [deck.real(card, rows[0], i, name, 0.0) for i, name in enumerate(names)]
    for index, value in enumerate(values):
        if value is None:
            return
        if value < 0.0 or (value == 0.0 and index < 2 and rows[0].get(index)):
            deck.row_error(card, rows[0], index, f"{names[index]} must be > 0, not {value:g}")
            return
    first, period, least, most = (float(v or 0.0) for v in values)
    period = period or 1.0
    first = first or period
    if first > period:
        deck.row_error(
            card, rows[0], 0, f"the first increment {first:g} exceeds the period {period:g}"
        )
    elif least > first:
        deck.row_error(
            card, rows[0], 2, f"the smallest increment {least:g} exceeds the first, {first:g}"
        )
    elif most and most < first:
        deck.row_error(
            card, rows[0], 3, f"the largest increment {most:g} is below the first, {first:g}"
        )
    else:
        now.times = (first, period, least, most)


def amplitude(deck: Deck, card: Card) -> None:
    """``*AMPLITUDE, NAME=[, DEFINITION=]``: pairs of time and factor, or the curve's numbers."""
    name = deck.required(card, "NAME")
    total = deck.choice(card, "TIME", ("STEPTIME", "TOTALTIME"), "STEPTIME") == "TOTALTIME"
    kinds = ("TABULAR", "EQUALLYSPACED", "SMOOTHSTEP", "PERIODIC", "DECAY")
    kind = deck.choice(card, "DEFINITION", kinds, "TABULAR")
    if deck.choice(card, "VALUE", ("RELATIVE", "ABSOLUTE"), "RELATIVE") == "ABSOLUTE":
        deck.error(
            card,
            card.at("VALUE"),
            "VALUE=ABSOLUTE is not supported",
            hint="give the loads the size 1 and the amplitude VALUE=RELATIVE",
        )
        return
    if kind in ("PERIODIC", "DECAY"):
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
    """``PERIODIC``: terms, omega, start, A0; pairs A, B. ``DECAY``: A0, A, start, decay time."""
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
        names = ("the initial value", "the size", "the start", "the decay time")
        found = [deck.real(card, rows[0], i, what) for i, what in enumerate(names)]
        if None in found:
            return
        numbers = [float(v or 0.0) for v in found]
        if numbers[3] <= 0.0:
            deck.row_error(card, rows[0], 3, "the decay time must be > 0")
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


def boundary(deck: Deck, card: Card) -> None:
    """``*BOUNDARY[, OP=][, AMPLITUDE=][, TYPE=][, FIXED]``: target, first dof[, last[, value]]."""
    if _renews(deck, deck.step, card, "support") and deck.step is not None:
        deck.step.new_supports = True
    kind = deck.choice(card, "TYPE", RATES, "DISPLACEMENT")
    into = deck.step.supports if deck.step is not None else deck.supports
    keep = card.has("FIXED")
    if deck.step is None and (keep or RATES[kind]):
        name = "FIXED" if keep else "TYPE"
        text = f"{card.parameters[name].name} belongs in a step"
        deck.error(card, card.at(name), text, hint="put the card between *STEP and *END STEP")
        return
    for row in card.rows():
        deck.extra_fields(card, row, 4)
        found = _supports(deck, card, row)
        for draft in found:
            draft.order, draft.keep = RATES[kind], keep
        into.extend(found)


def _supports(deck: Deck, card: Card, row: Row) -> list[Draft]:
    amplitude = card.value("AMPLITUDE")
    named = key(row.get(1))
    if not row.get(0):
        deck.row_error(card, row, 0, "a node number or a set is missing")
        return []
    if named and not named.lstrip("+-")[:1].isdigit():
        if named not in NAMED_SUPPORTS:
            deck.row_error(
                card,
                row,
                1,
                f"expected a degree of freedom 1 to 6, found {row.get(1)!r}",
                nearest(named, NAMED_SUPPORTS),
            )
            return []
        dofs, value = NAMED_SUPPORTS[named], 0.0
    else:
        first = _dof(deck, card, row, 1)
        last = _dof(deck, card, row, 2) if row.get(2) else first
        number = deck.real(card, row, 3, "the value", 0.0)
        if first is None or last is None or number is None:
            return []
        if last < first:
            deck.row_error(card, row, 2, f"the last dof {last} is below the first, {first}")
            return []
        dofs, value = tuple(range(first, last + 1)), number
    found = []
    if key(row.get(0)) in deck.rotation_nodes:
        return _turns(deck, card, row, dofs, value)
    for dof in dofs:
        if dof in (1, 2, 6):
            index = {1: 0, 2: 1, 6: 2}[dof]
            wide = len(dofs) > 1 and value == 0.0
            found.append(
                Draft("fixed", card, row, row.get(0), (value,), index, amplitude, silent=wide)
            )
        elif value != 0.0:
            deck.row_error(card, row, 3, f"dof {dof} of a planar model is zero and cannot be moved")
            return []
    if not found:
        found.append(Draft("nothing", card, row, row.get(0), (0.0,)))
    return found


def _turns(deck: Deck, card: Card, row: Row, dofs: tuple[int, ...], value: float) -> list[Draft]:
    """Supports of a rotation node: its dof 3 is the rotation of the reference node."""
    target = deck.rotation_nodes[key(row.get(0))]
    if value != 0.0 and any(dof != 3 for dof in dofs):
        deck.row_error(card, row, 3, "only dof 3 of a rotation node turns in the plane")
        return []
    kind = "fixed" if 3 in dofs else "nothing"
    return [Draft(kind, card, row, target, (value,), 2, card.value("AMPLITUDE"))]


def _dof(deck: Deck, card: Card, row: Row, index: int) -> int | None:
    dof = deck.integer(card, row, index, "the degree of freedom")
    if dof is None:
        return None
    if dof == 11:
        deck.row_error(
            card,
            row,
            index,
            "dof 11 belongs to heat conduction",
            "give temperatures by *TEMPERATURE",
        )
        return None
    if not 1 <= dof <= 6:
        deck.row_error(
            card,
            row,
            index,
            f"expected a degree of freedom 1 to 6, found {dof}",
            "1 = x, 2 = y, 6 = drilling rotation",
        )
        return None
    return dof


def cload(deck: Deck, card: Card) -> None:
    """``*CLOAD[, OP=][, AMPLITUDE=]``: node or set, dof, value."""
    now = loads_of(deck, card, "force")
    if now is None:
        return
    for row in card.rows():
        deck.extra_fields(card, row, 3)
        dof = _dof(deck, card, row, 1)
        value = deck.real(card, row, 2, "the force")
        if not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
        if dof is None or value is None or not row.get(0):
            continue
        target = row.get(0)
        if key(target) in deck.rotation_nodes and dof == 3:
            target, dof = deck.rotation_nodes[key(target)], 6
        if dof in (3, 4, 5):
            if value != 0.0:
                deck.row_error(card, row, 1, f"a planar model takes no load in dof {dof}")
            continue
        index = {1: 0, 2: 1, 6: 2}[dof]
        now.loads.append(
            Draft("force", card, row, target, (value,), index, card.value("AMPLITUDE"))
        )


def dload(deck: Deck, card: Card) -> None:
    """``*DLOAD``: pressure on faces, ``GRAV``, ``CENTRIF``."""
    now = loads_of(deck, card, "distributed")
    if now is None:
        return
    for row in card.rows():
        label = key(row.get(1))
        face = _FACE.match(label)
        if face:
            _pressure(deck, card, row, int(face.group(1)), now)
        elif label == "GRAV":
            _gravity(deck, card, row, now)
        elif label == "CENTRIF":
            _centrifugal(deck, card, row, now)
        elif label in ("BX", "BY"):
            _volume_force(deck, card, row, label, now)
        elif traction := _TRACTION.match(label):
            _edge_traction(deck, card, row, traction.group(1), int(traction.group(2)), now)
        else:
            known = "expected P1 to P4, TRVEC1 to 4, TRSHR1 to 4, BX, BY, GRAV or CENTRIF"
            why = next((text for rule, text in _OTHER_LOADS if rule.match(label)), "")
            deck.row_error(
                card,
                row,
                1,
                f"load type {row.get(1)!r} is not part of this version"
                if why
                else f"unknown load type {row.get(1)!r}; {known}",
                why or (nearest(label, ("GRAV", "CENTRIF")) if label else ""),
            )


def _volume_force(deck: Deck, card: Card, row: Row, label: str, now: StepDraft) -> None:
    """``BX``, ``BY``: force per volume."""
    deck.extra_fields(card, row, 3)
    value = deck.real(card, row, 2, "the force per volume")
    if value is not None:
        vector = (value, 0.0) if label == "BX" else (0.0, value)
        now.loads.append(
            Draft("volume", card, row, row.get(0), vector, amplitude=card.value("AMPLITUDE"))
        )


def _edge_traction(deck: Deck, card: Card, row: Row, label: str, face: int, now: StepDraft) -> None:
    """``TRVECn``, ``TRSHRn``: as those of ``*DSLOAD``, on one face of elements."""
    if not row.get(0):
        deck.row_error(card, row, 0, "an element number or a set is missing")
    elif not 1 <= face <= 4:
        deck.row_error(card, row, 1, f"face {face} does not exist; expected 1 to 4")
    else:
        draft = _traction(deck, card, row, label, now)
        if draft is not None:
            draft.index = face - 1
            now.loads.append(draft)


def _pressure(deck: Deck, card: Card, row: Row, face: int, now: StepDraft) -> None:
    deck.extra_fields(card, row, 3)
    value = deck.real(card, row, 2, "the pressure")
    if not 1 <= face <= 4:
        deck.row_error(card, row, 1, f"face P{face} does not exist; expected P1 to P4")
    elif not row.get(0):
        deck.row_error(card, row, 0, "an element number or a set is missing")
    elif value is not None:
        now.loads.append(
            Draft("pressure", card, row, row.get(0), (value,), face - 1, card.value("AMPLITUDE"))
        )


def _gravity(deck: Deck, card: Card, row: Row, now: StepDraft) -> None:
    deck.extra_fields(card, row, 6)
    g = deck.real(card, row, 2, "the acceleration")
    numbers = [deck.real(card, row, i + 3, text, 0.0) for i, text in enumerate(("nx", "ny", "nz"))]
    if g is None or None in numbers:
        return
    nx, ny, nz = (float(v or 0.0) for v in numbers)
    size = math.hypot(nx, ny)
    if nz != 0.0:
        deck.row_error(card, row, 5, "gravity out of the plane has no effect in a planar model")
    elif size == 0.0:
        deck.row_error(card, row, 3, "the direction of gravity is zero")
    else:
        # A size that is not positive still has the direction that it was given.
        value = (g * nx / size, g * ny / size, *((nx / size, ny / size) if g <= 0.0 else ()))
        now.loads.append(
            Draft("gravity", card, row, row.get(0), value, amplitude=card.value("AMPLITUDE"))
        )


def _centrifugal(deck: Deck, card: Card, row: Row, now: StepDraft) -> None:
    deck.extra_fields(card, row, 9)
    square = deck.real(card, row, 2, "the square of the angular velocity")
    names = ("x", "y", "z", "nx", "ny", "nz")
    numbers = [deck.real(card, row, i + 3, name, 0.0) for i, name in enumerate(names)]
    if square is None or None in numbers:
        return
    x, y, _, nx, ny, nz = (float(v or 0.0) for v in numbers)
    if square < 0.0:
        deck.row_error(card, row, 2, "the square of the angular velocity must be >= 0")
    elif nz == 0.0 or nx != 0.0 or ny != 0.0:
        deck.row_error(card, row, 6, "the axis must be normal to the plane: 0, 0, 1")
    else:
        value = (square, x, y)
        now.loads.append(
            Draft("centrifugal", card, row, row.get(0), value, amplitude=card.value("AMPLITUDE"))
        )


def dsload(deck: Deck, card: Card) -> None:
    """``*DSLOAD``: surface, ``P``, pressure; or ``TRVEC`` or ``TRSHR``, size, direction."""
    now = loads_of(deck, card, "distributed")
    if now is None:
        return
    for row in card.rows():
        label = key(row.get(1))
        if label == "P":
            value = deck.real(card, row, 2, "the size of the load")
            deck.extra_fields(card, row, 3)
            if value is not None:
                amplitude = card.value("AMPLITUDE")
                now.loads.append(
                    Draft("surface pressure", card, row, row.get(0), (value,), -1, amplitude)
                )
        elif label in ("TRVEC", "TRSHR"):
            draft = _traction(deck, card, row, label, now)
            if draft is not None:
                now.loads.append(draft)
        else:
            why = next((text for rule, text in _OTHER_LOADS if rule.match(label)), "")
            deck.row_error(
                card, row, 1, f"unknown load type {row.get(1)!r}; expected P, TRVEC or TRSHR", why
            )


def _traction(deck: Deck, card: Card, row: Row, label: str, now: StepDraft) -> Draft | None:
    """Size and direction of ``TRVEC`` or ``TRSHR``; ``None`` after an error."""
    follower = deck.choice(card, "FOLLOWER", ("YES", "NO", ""), "YES") != "NO"
    kinds = {
        "TRSHR": "surface shear",
        "TRVEC": "surface following traction" if follower else "surface traction",
    }
    deck.extra_fields(card, row, 6)
    value = deck.real(card, row, 2, "the size of the load")
    x = deck.real(card, row, 3, "the direction x", 0.0)
    y = deck.real(card, row, 4, "the direction y", 0.0)
    if value is None or x is None or y is None:
        return None
    size = math.hypot(x, y)
    if label == "TRSHR" and not follower:
        text = "a shear traction follows the surface: FOLLOWER=NO belongs to TRVEC"
        deck.error(card, card.at("FOLLOWER"), text)
        return None
    if size == 0.0:
        deck.row_error(card, row, 3, "the direction of the traction is zero")
        return None
    vector = (value * x / size, value * y / size)
    return Draft(kinds[label], card, row, row.get(0), vector, -1, card.value("AMPLITUDE"))


def _renews(deck: Deck, now: StepDraft | None, card: Card, kind: str) -> bool:
    """Whether a card takes away what earlier steps gave of its kind (``OP=NEW``)."""
    new = deck.choice(card, "OP", ("NEW", "MOD"), "MOD") == "NEW"
    if now is None:
        return new
    before = kind in now.said
    now.said.add(kind)
    renewed = now.new_supports if kind == "support" else kind in now.new_loads
    if new and before and not renewed:
        deck.error(
            card,
            card.at("OP"),
            f"OP=NEW comes after another card of the step with {_KINDS[kind]}",
            hint="put OP=NEW on the first of them; CalculiX ignores it here",
        )
    return new


def loads_of(deck: Deck, card: Card, kind: LoadKind) -> StepDraft | None:
    """Return the step that a card of loads belongs to, or None after an error."""
    now = open_step(deck, card)
    if now is not None and _renews(deck, now, card, kind):
        now.new_loads.add(kind)
    return now


def keeps_preload(deck: Deck, card: Card, now: StepDraft) -> bool:
    """Whether a step starts from stresses and displacements of the steps before.

    As in CalculiX, it is ``*STEP, PERTURBATION`` that says so.
    """
    kept = now.card.has("PERTURBATION")
    if len(deck.steps) > 1 and not kept:
        deck.notes.append(
            f"{card.where}: *{card.keyword} is about the structure without load, as in CalculiX; "
            "write *STEP, PERTURBATION to keep the preload of the steps before"
        )
    return kept


def open_step(deck: Deck, card: Card) -> StepDraft | None:
    """Return the open step, or None after an error."""
    if deck.step is None:
        deck.error(card, card.where, "the card belongs inside a step, between *STEP and *END STEP")
    return deck.step

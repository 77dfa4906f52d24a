"""Cards of loads on nodes, edges and bodies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re

from corota.io.deck.cards.step import loads_of, open_step
from corota.io.deck.cards.supports import dof_of
from corota.io.deck.deck import Deck, nearest
from corota.io.deck.drafts import Draft, StepDraft
from corota.io.deck.lexer import Card, Row, key

_FACE = r"(H?P)(\d{1,9})\Z"
_TRACTION = r"(TRVEC|TRSHR)(\d{1,9})\Z"
#: Loads of other programs, and what to give instead.
_OTHER_LOADS = (
    (r"(PZ|BZ)\Z", "a planar model takes no load out of its plane"),
    (r"(P\d?|[BP][XY]|TRVEC\d?|TRSHR\d?)NU\Z", "no user subroutine is called: give values"),
    (
        r"ROTA\Z",
        "prescribe the rotation of a *RIGID BODY at the axis in *DYNAMIC: inertia follows from it",
    ),
    (r"CORIO\Z", "in rotating frames they follow from CENTRIF in *COMPLEX FREQUENCY, CORIOLIS"),
    (
        r"(EDNOR|EDLD)\d?\Z",
        "give a *SURFACE of the edges (S3 to S6) and its pressure: the force per length divided by "
        "the thickness",
    ),
    (
        r"P\Z",
        "the pressure on the side of a shell acts out of the plane; edges take P1 to P4 of planar "
        "elements, P3 to P6 of shells and membranes",
    ),
    (r"ROTDYNF\Z", "CENTRIF takes the square of the angular velocity"),
    (r"(F|VBF|SBF|SP)\d?\Z", "give springs by *SPRING, pressures by P1 to P4"),
)


def cload(deck: Deck, card: Card) -> None:
    """``*CLOAD[, OP=][, AMPLITUDE=]``: node or set, dof, value."""
    now = loads_of(deck, card, "force")
    if now is None:
        return
    for row in card.rows():
        deck.extra_fields(card, row, 3)
        dof = dof_of(deck, card, row, 1)
        value = deck.real(card, row, 2, "the force")
        if not row.get(0):
            deck.row_error(card, row, 0, "a node number or a set is missing")
        if dof is None or value is None or not row.get(0):
            continue
        target = row.get(0)
        turned = deck.turned(target)
        if turned is not None and dof == 3:
            target, dof = turned, 6
        if dof in (3, 4, 5):
            if value != 0.0:
                deck.row_error(card, row, 1, f"a planar model takes no load in dof {dof}")
            continue
        index = {1: 0, 2: 1, 6: 2}[dof]
        now.loads.append(
            Draft("force", card, row, target, (value,), index, card.value("AMPLITUDE"))
        )


def dload(deck: Deck, card: Card) -> None:
    """``*DLOAD``: pressure on faces, ``GRAV``, ``CENTRIF``, ``CENT``, forces per volume."""
    now = loads_of(deck, card, "distributed")
    if now is None:
        return
    for row in card.rows():
        label = key(row.get(1))
        face = re.match(_FACE, label, re.ASCII)
        if face:
            _pressure(deck, card, row, int(face.group(2)), now, face.group(1))
        elif label == "GRAV":
            _gravity(deck, card, row, now)
        elif label in ("CENTRIF", "CENT"):
            _centrifugal(deck, card, row, now)
        elif label in ("BX", "BY", "PX", "PY"):
            _volume_force(deck, card, row, label, now)
        elif traction := re.match(_TRACTION, label, re.ASCII):
            _edge_traction(deck, card, row, traction.group(1), int(traction.group(2)), now)
        else:
            faces = "P1 to P4, HP1 to 4, TRVEC1 to 4, TRSHR1 to 4"
            known = f"expected {faces}, BX, BY, PX, PY, GRAV, CENTRIF or CENT"
            why = next((text for rule, text in _OTHER_LOADS if re.match(rule, label)), "")
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
    """``BX``, ``BY``: force per volume; ``PX``, ``PY``: force per length of beams and trusses."""
    kind = "volume" if label.startswith("B") else "line"
    deck.extra_fields(card, row, 3)
    value = deck.real(card, row, 2, f"the force per {'volume' if kind == 'volume' else 'length'}")
    if kind == "line" and not row.get(0):
        deck.row_error(card, row, 0, "an element number or a set is missing")
    elif value is not None:
        vector = (value, 0.0) if label.endswith("X") else (0.0, value)
        now.loads.append(
            Draft(kind, card, row, row.get(0), vector, amplitude=card.value("AMPLITUDE"))
        )


def _edge_traction(deck: Deck, card: Card, row: Row, label: str, face: int, now: StepDraft) -> None:
    """``TRVECn``, ``TRSHRn``: as those of ``*DSLOAD``, on one face of elements."""
    if not row.get(0):
        deck.row_error(card, row, 0, "an element number or a set is missing")
    elif not 1 <= face <= 6:
        deck.row_error(card, row, 1, f"face {face} does not exist; expected 1 to 4")
    else:
        draft = _traction(deck, card, row, label, now)
        if draft is not None:
            draft.index = face - 1
            now.loads.append(draft)


def _pressure_values(deck: Deck, card: Card, row: Row, label: str) -> tuple[float, ...] | None:
    """Pressure of ``P``; of ``HP`` the pressure, the height of its level, that where it acts."""
    names = ("the pressure", "the height of the level", "the height at which the pressure acts")
    count = 1 if label == "P" else 3
    deck.extra_fields(card, row, 2 + count)
    values = [deck.real(card, row, 2 + i, name) for i, name in enumerate(names[:count])]
    if None in values:
        return None
    if count == 3 and values[1] == values[2]:
        deck.row_error(card, row, 4, "both heights are the same")
        return None
    return tuple(float(v or 0.0) for v in values)


def _pressure(
    deck: Deck, card: Card, row: Row, face: int, now: StepDraft, label: str = "P"
) -> None:
    value = _pressure_values(deck, card, row, label)
    if not 1 <= face <= 4:
        deck.row_error(card, row, 1, f"face P{face} does not exist; expected P1 to P4")
    elif not row.get(0):
        deck.row_error(card, row, 0, "an element number or a set is missing")
    elif value is not None:
        now.loads.append(
            Draft("pressure", card, row, row.get(0), value, face - 1, card.value("AMPLITUDE"))
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
        # A size that is not positive keeps its given direction.
        value = (g * nx / size, g * ny / size, *((nx / size, ny / size) if g <= 0.0 else ()))
        now.loads.append(
            Draft("gravity", card, row, row.get(0), value, amplitude=card.value("AMPLITUDE"))
        )


def _centrifugal(deck: Deck, card: Card, row: Row, now: StepDraft) -> None:
    deck.extra_fields(card, row, 9)
    what = "the square of the angular velocity"
    if key(row.get(1)) == "CENT":
        what = "the density times the square of the angular velocity"
    square = deck.real(card, row, 2, what)
    names = ("x", "y", "z", "nx", "ny", "nz")
    numbers = [deck.real(card, row, i + 3, name, 0.0) for i, name in enumerate(names)]
    if square is None or None in numbers:
        return
    x, y, _, nx, ny, nz = (float(v or 0.0) for v in numbers)
    if square < 0.0:
        deck.row_error(card, row, 2, f"{what} must be >= 0")
    elif nx != 0.0 or (ny == 0.0) == (nz == 0.0):
        text = "the axis must be normal to the plane: 0, 0, 1; of axisymmetric parts it is 0, 1, 0"
        deck.row_error(card, row, 6, text)
    else:
        # The index is that of the axis: the load builder knows whether the part is axisymmetric.
        axis, value = (1 if ny else 2), (square, x, 0.0 if ny else y)
        amplitude = card.value("AMPLITUDE")
        now.loads.append(Draft("centrifugal", card, row, row.get(0), value, axis, amplitude))


def dsload(deck: Deck, card: Card) -> None:
    """``*DSLOAD``: surface, ``P``, ``HP``, pressure; or ``TRVEC``, ``TRSHR``, size, direction."""
    now = loads_of(deck, card, "distributed")
    if now is None:
        return
    for row in card.rows():
        label = key(row.get(1))
        if label in ("P", "HP"):
            value = _pressure_values(deck, card, row, label)
            if value is not None:
                kind = "surface pressure" if label == "P" else "surface hydrostatic pressure"
                amplitude = card.value("AMPLITUDE")
                now.loads.append(Draft(kind, card, row, row.get(0), value, -1, amplitude))
        elif label in ("TRVEC", "TRSHR"):
            draft = _traction(deck, card, row, label, now)
            if draft is not None:
                now.loads.append(draft)
        else:
            why = next((text for rule, text in _OTHER_LOADS if re.match(rule, label)), "")
            deck.row_error(
                card,
                row,
                1,
                f"unknown load type {row.get(1)!r}; expected P, HP, TRVEC or TRSHR",
                why,
            )


def _axes(deck: Deck, card: Card) -> float | None:
    """Angle of the axes of ``ORIENTATION`` for directions; ``None`` after an error."""
    if not card.has("ORIENTATION"):
        return 0.0
    name = card.value("ORIENTATION")
    known = deck.root.orientations | deck.scope.orientations
    angle = known.get(key(name))
    if angle is None:
        hint = nearest(name, list(known))
        deck.error(card, card.at("ORIENTATION"), f"no orientation named {name!r}", hint=hint)
    elif math.isnan(angle):
        hint = "give the direction in global axes"
        deck.error(card, card.at("ORIENTATION"), f"{name} is not rectangular", hint=hint)
        return None
    return angle


def pressure_penetration(deck: Deck, card: Card) -> None:
    """``*PRESSURE PENETRATION, SLAVE=, MASTER=``: node, node, pressure, critical pressure."""
    now = open_step(deck, card)
    if now is None:
        return
    if deck.choice(card, "OP", ("MOD", "NEW", ""), "MOD") == "NEW":
        deck.error(
            card,
            card.at("OP"),
            "OP=NEW of fluids that penetrate is not part of this version",
            hint="give each of them the pressure 0",
        )
    for name in ("SLAVE", "MASTER"):
        if not card.value(name):
            deck.error(card, card.where, f"{name}= is missing: the surfaces of a contact pair")
            return
    for row in card.rows():
        deck.extra_fields(card, row, 4)
        pressure = deck.real(card, row, 2, "the pressure of the fluid")
        critical = deck.real(card, row, 3, "the critical contact pressure", 0.0)
        if not row.get(0):
            deck.row_error(card, row, 0, "the node of the slave surface in the fluid is missing")
        elif pressure is not None and critical is not None:
            if min(pressure, critical) < 0.0:
                deck.row_error(card, row, 2, "the pressures of a fluid must be >= 0")
                continue
            value, amplitude = (pressure, critical), card.value("AMPLITUDE")
            now.loads.append(
                Draft("penetrating pressure", card, row, row.get(0), value, -1, amplitude)
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
    angle = _axes(deck, card)
    if angle is None:
        return None
    c, s = math.cos(angle), math.sin(angle)
    vector = (value * (c * x - s * y) / size, value * (s * x + c * y) / size)
    return Draft(kinds[label], card, row, row.get(0), vector, -1, card.value("AMPLITUDE"))

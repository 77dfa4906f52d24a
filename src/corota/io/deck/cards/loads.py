"""Cards of loads on nodes, edges and bodies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from contextlib import suppress

from corota.io.deck.card import Card, Refused, Row, complete, key, nearest
from corota.io.deck.cards.step import loads_of, open_step
from corota.io.deck.cards.supports import dof_of
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import PLANAR, Draft
from corota.io.deck.keywords import keyword

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


@keyword("CLOAD", "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY", "REGIONTYPE")
def cload(deck: Deck, card: Card) -> None:
    """``*CLOAD[, OP=][, AMPLITUDE=]``: node or set, dof, value."""
    now = loads_of(deck, card, "force")
    for row in card.rows():
        row.at_most(3)
        dof, value, target = dof_of(row, 1), row.real(2, "the force"), row.get(0)
        if not target:
            row.error(0, "a node number or a set is missing")
        if dof is None or value is None or not target:
            continue
        turned = deck.turned(target)
        if turned is not None and dof == 3:
            target, dof = turned, 6
        if dof in PLANAR:
            now.loads.append(Draft("force", row, target, (value,), PLANAR[dof]))
        elif value != 0.0:
            row.error(1, f"a planar model takes no load in dof {dof}")


@keyword("DLOAD", "OP AMPLITUDE LOADCASE FOLLOWER REAL IMAGINARY", "REGIONTYPE CONSTANTRESULTANT")
def dload(deck: Deck, card: Card) -> None:
    """``*DLOAD``: pressure on faces, ``GRAV``, ``CENTRIF``, ``CENT``, forces per volume."""
    now = loads_of(deck, card, "distributed")
    for row in card.rows():
        with suppress(Refused):
            now.loads.append(_load(deck, row))


def _load(deck: Deck, row: Row) -> Draft:
    """One line of ``*DLOAD``."""
    label = key(row.get(1))
    if face := re.match(_FACE, label, re.ASCII):
        return _pressure(row, int(face.group(2)), face.group(1))
    if label == "GRAV":
        return _gravity(row)
    if label in ("CENTRIF", "CENT"):
        return _centrifugal(row, label)
    if label in ("BX", "BY", "PX", "PY"):
        return _volume_force(row, label)
    if traction := re.match(_TRACTION, label, re.ASCII):
        return _edge_traction(deck, row, traction.group(1), int(traction.group(2)))
    why = next((text for rule, text in _OTHER_LOADS if re.match(rule, label)), "")
    if why:
        row.refuse(1, f"load type {row.get(1)!r} is not part of this version", why)
    faces = "P1 to P4, HP1 to 4, TRVEC1 to 4, TRSHR1 to 4"
    known = f"expected {faces}, BX, BY, PX, PY, GRAV, CENTRIF or CENT"
    hint = nearest(label, ("GRAV", "CENTRIF")) if label else ""
    row.refuse(1, f"unknown load type {row.get(1)!r}; {known}", hint)


def _volume_force(row: Row, label: str) -> Draft:
    """``BX``, ``BY``: force per volume; ``PX``, ``PY``: force per length of beams and trusses."""
    kind, per = ("volume", "volume") if label.startswith("B") else ("line", "length")
    row.at_most(3)
    value = row.real(2, f"the force per {per}")
    if kind == "line" and not row.get(0):
        row.refuse(0, "an element number or a set is missing")
    (size,) = complete([value])
    return Draft(kind, row, row.get(0), (size, 0.0) if label.endswith("X") else (0.0, size))


def _edge_traction(deck: Deck, row: Row, label: str, face: int) -> Draft:
    """``TRVECn``, ``TRSHRn``: as those of ``*DSLOAD``, on one face of elements."""
    if not row.get(0):
        row.refuse(0, "an element number or a set is missing")
    if not 1 <= face <= 6:
        row.refuse(1, f"face {face} does not exist; expected 1 to 4")
    draft = _traction(deck, row, label)
    draft.index = face - 1
    return draft


def _pressure_values(row: Row, label: str) -> tuple[float, ...]:
    """Pressure of ``P``; of ``HP`` the pressure, the height of its level, that where it acts."""
    names = ("the pressure", "the height of the level", "the height at which the pressure acts")
    count = 1 if label == "P" else 3
    row.at_most(2 + count)
    values = row.reals(names[:count], start=2)
    if count == 3 and values[1] == values[2]:
        row.refuse(4, "both heights are the same")
    return tuple(values)


def _pressure(row: Row, face: int, label: str) -> Draft:
    value = _pressure_values(row, label)
    if not 1 <= face <= 4:
        row.refuse(1, f"face P{face} does not exist; expected P1 to P4")
    if not row.get(0):
        row.refuse(0, "an element number or a set is missing")
    return Draft("pressure", row, row.get(0), value, face - 1)


def _gravity(row: Row) -> Draft:
    row.at_most(6)
    g, nx, ny, nz = row.reals(("the acceleration", "nx", "ny", "nz"), 0.0, 2, required=1)
    size = math.hypot(nx, ny)
    if nz != 0.0:
        row.refuse(5, "gravity out of the plane has no effect in a planar model")
    if size == 0.0:
        row.refuse(3, "the direction of gravity is zero")
    # A size that is not positive keeps its given direction.
    value = (g * nx / size, g * ny / size, *((nx / size, ny / size) if g <= 0.0 else ()))
    return Draft("gravity", row, row.get(0), value)


def _centrifugal(row: Row, label: str) -> Draft:
    row.at_most(9)
    density = "the density times " if label == "CENT" else ""
    what = f"{density}the square of the angular velocity"
    names = (what, "x", "y", "z", "nx", "ny", "nz")
    square, x, y, _, nx, ny, nz = row.reals(names, 0.0, 2, required=1)
    if square < 0.0:
        row.refuse(2, f"{what} must be >= 0")
    if nx != 0.0 or (ny == 0.0) == (nz == 0.0):
        text = "the axis must be normal to the plane: 0, 0, 1; of axisymmetric parts it is 0, 1, 0"
        row.refuse(6, text)
    # The index is that of the axis: the load builder knows whether the part is axisymmetric.
    value = (square, x, 0.0 if ny else y)
    return Draft("centrifugal", row, row.get(0), value, 1 if ny else 2)


@keyword(
    "DSLOAD",
    "OP AMPLITUDE FOLLOWER LOADCASE ORIENTATION REAL IMAGINARY",
    "REGIONTYPE CONSTANTRESULTANT",
)
def dsload(deck: Deck, card: Card) -> None:
    """``*DSLOAD``: surface, ``P``, ``HP``, pressure; or ``TRVEC``, ``TRSHR``, size, direction."""
    now = loads_of(deck, card, "distributed")
    kinds = {"P": "surface pressure", "HP": "surface hydrostatic pressure"}
    for row in card.rows():
        with suppress(Refused):
            label = key(row.get(1))
            if label in kinds:
                value = _pressure_values(row, label)
                now.loads.append(Draft(kinds[label], row, row.get(0), value))
            elif label in ("TRVEC", "TRSHR"):
                now.loads.append(_traction(deck, row, label))
            else:
                why = next((text for rule, text in _OTHER_LOADS if re.match(rule, label)), "")
                known = "expected P, HP, TRVEC or TRSHR"
                row.error(1, f"unknown load type {row.get(1)!r}; {known}", why)


def _axes(deck: Deck, card: Card) -> float:
    """Angle of the axes of ``ORIENTATION`` for directions."""
    if not card.has("ORIENTATION"):
        return 0.0
    name = card.value("ORIENTATION")
    known = deck.root.orientations | deck.scope.orientations
    angle = known.get(key(name))
    if angle is None:
        hint = nearest(name, list(known))
        card.refuse(f"no orientation named {name!r}", "ORIENTATION", hint)
    if math.isnan(angle):
        hint = "give the direction in global axes"
        card.refuse(f"{name} is not rectangular", "ORIENTATION", hint)
    return angle


@keyword("PRESSURE PENETRATION", "SLAVE MASTER AMPLITUDE OP", "PENETRATIONTIME")
def pressure_penetration(deck: Deck, card: Card) -> None:
    """``*PRESSURE PENETRATION, SLAVE=, MASTER=``: node, node, pressure, critical pressure."""
    now = open_step(deck, card)
    if card.choice("OP", ("MOD", "NEW", ""), "MOD") == "NEW":
        text = "OP=NEW of fluids that penetrate is not part of this version"
        card.error(text, "OP", hint="give each of them the pressure 0")
    for name in ("SLAVE", "MASTER"):
        if not card.value(name):
            card.refuse(f"{name}= is missing: the surfaces of a contact pair")
    for row in card.rows():
        row.at_most(4)
        pressure = row.real(2, "the pressure of the fluid")
        critical = row.real(3, "the critical contact pressure", 0.0)
        if not row.get(0):
            row.error(0, "the node of the slave surface in the fluid is missing")
        elif pressure is not None and critical is not None:
            if min(pressure, critical) < 0.0:
                row.error(2, "the pressures of a fluid must be >= 0")
                continue
            value = (pressure, critical)
            now.loads.append(Draft("penetrating pressure", row, row.get(0), value))


def _traction(deck: Deck, row: Row, label: str) -> Draft:
    """Size and direction of ``TRVEC`` or ``TRSHR``."""
    follower = row.card.choice("FOLLOWER", ("YES", "NO", ""), "YES") != "NO"
    kinds = {
        "TRSHR": "surface shear",
        "TRVEC": "surface following traction" if follower else "surface traction",
    }
    row.at_most(6)
    names = ("the size of the load", "the direction x", "the direction y")
    value, x, y = row.reals(names, 0.0, 2, required=1)
    size = math.hypot(x, y)
    if label == "TRSHR" and not follower:
        text = "a shear traction follows the surface: FOLLOWER=NO belongs to TRVEC"
        row.card.refuse(text, "FOLLOWER")
    if size == 0.0:
        row.refuse(3, "the direction of the traction is zero")
    angle = _axes(deck, row.card)
    c, s = math.cos(angle), math.sin(angle)
    vector = (value * (c * x - s * y) / size, value * (s * x + c * y) / size)
    return Draft(kinds[label], row, row.get(0), vector)

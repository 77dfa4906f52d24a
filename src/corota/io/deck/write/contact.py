"""Contact pairs, rigid curves and ties of a model as cards."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.cards.contact import LAWS
from corota.mesh.parts import cells_of
from corota.model.contact import ContactPair, PressureLaw, RigidCurve, edges_or_nodes, is_gap
from corota.model.friction import DecayingFriction, Friction, FrictionTable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.arrays import Floats, Ints
    from corota.io.deck.write.text import Writer
    from corota.model.model import Model

#: Arcs are cut into pieces of at most this angle [rad]; a deck's are less than half a turn.
PIECE = math.radians(120.0)
_TYPES = {"mortar": "SURFACE TO SURFACE", "node_to_segment": "NODE TO SURFACE"}


def contact_cards(writer: Writer) -> Iterator[str]:
    """Cards of contact pairs and ties.

    Raises
    ------
    UnsupportedError
        If a deck cannot hold them.
    """
    model = writer.model
    known: list[str] = []
    for tie in model.ties:
        tolerance = f", POSITION TOLERANCE={tie.tolerance!r}" if tie.tolerance else ""
        slave, master = _side(writer, tie.slave), writer.edge_set(tie.master)
        yield from _new_node_surface(writer, tie.slave, known)
        yield f"*TIE, NAME={_word(tie.name)}, ADJUST=NO{tolerance}\n{slave}, {master}\n"
    for number, pair in enumerate(model.contacts, start=1):
        if is_gap(pair):
            continue
        if pair.reach:
            raise UnsupportedError(
                f"contact pair {pair.name!r}: reach cannot be written to a deck: leave it out, or "
                "keep the model in Python"
            )
        yield f"*SURFACE INTERACTION, NAME=INTERACTION{number}\n"
        if pair.law is not None:
            yield _behavior(pair.law)
        if not pair.separates:
            yield "*SURFACE BEHAVIOR, NO SEPARATION\n"
        if pair.most_friction:
            limit = "" if pair.shear_limit is None else f", TAUMAX={float(pair.shear_limit)!r}"
            yield _friction(pair.friction, limit)
        _check_heights(model, pair)
        if pair.images is not None:
            raise UnsupportedError(
                f"contact pair {pair.name!r}: no card of a deck repeats a surface across the "
                "border of a periodic cell; keep the model in Python"
            )
        slave, master = surfaces(writer, pair)
        yield from _new_node_surface(writer, pair.slave, known)
        if isinstance(pair.master, RigidCurve) and master not in known:
            known.append(master)
            yield _profile(model, pair.master, master)
        adjust = f", ADJUST={float(pair.adjust)!r}" if pair.start == "adjust" else ""
        if adjust and pair.adjust_nodes is not None:
            adjust = f", ADJUST={writer.node_set(pair.adjust_nodes)}"
        if pair.method not in _TYPES:
            raise UnsupportedError(
                f"contact pair {pair.name!r}: decks have no method {pair.method!r}; take one of "
                f"{', '.join(_TYPES)}, or keep the model in Python"
            )
        yield f"*CONTACT PAIR, INTERACTION=INTERACTION{number}, TYPE={_TYPES[pair.method]}"
        smooth = ", SMOOTH=0.5" if pair.smooth else ""
        yield f"{adjust}{smooth}\n{slave}, {master}\n"
        if pair.clearance is not None:
            yield f"*CLEARANCE, SLAVE={slave}, MASTER={master}, VALUE={float(pair.clearance)!r}\n"


def step_cards(writer: Writer, number: int) -> Iterator[str]:
    """Cards of contact that stand in a step, counted from 1."""
    for place, pair in enumerate(writer.model.contacts, start=1):
        slave, master = surfaces(writer, pair)
        if pair.start == "ramp" and number == 1:
            yield f"*CONTACT INTERFERENCE, SHRINK\n{slave}, {master}\n"
        acts = pair.steps is None or number in pair.steps
        if acts != (pair.steps is None or number == 1 or number - 1 in pair.steps):
            change = "ADD" if acts else "REMOVE"
            yield f"*MODEL CHANGE, TYPE=CONTACT PAIR, {change}\n{slave}, {master}\n"
        if pair.stabilize and pair.stabilize_from == number:
            yield f"*CONTACT CONTROLS, STABILIZE, SLAVE={slave}, MASTER={master}\n"
        if number in pair.friction_steps:
            ramp = ", RAMP" if pair.friction_ramps else ""
            yield f"*CHANGE FRICTION, INTERACTION=INTERACTION{place}{ramp}\n"
            yield _friction(pair.friction_steps[number])


def surfaces(writer: Writer, pair: ContactPair) -> tuple[str, str]:
    """Names of the slave and the master surface in the deck."""
    slave = _side(writer, pair.slave)
    if not isinstance(pair.master, RigidCurve):
        return slave, writer.edge_set(pair.master)
    curves = [p.master for p in writer.model.contacts if isinstance(p.master, RigidCurve)]
    return slave, f"RIGID{1 + next(i for i, c in enumerate(curves) if c is pair.master)}"


def _side(writer: Writer, where: str | Ints) -> str:
    """Name of a surface of edges, lines or single nodes."""
    if len(edges_or_nodes(writer.model.mesh, where)[1]):
        return f"NODES_{writer.node_set(where)}"
    return writer.edge_set(where)


def _new_node_surface(writer: Writer, where: str | Ints, known: list[str]) -> Iterator[str]:
    """The card of a surface of single nodes, once."""
    name = _side(writer, where)
    if len(edges_or_nodes(writer.model.mesh, where)[1]) and name not in known:
        known.append(name)
        yield f"*SURFACE, TYPE=NODE, NAME={name}\n{writer.node_set(where)}\n"


def _check_heights(model: Model, pair: ContactPair) -> None:
    """Refuse lines in contact whose height does not follow from the section card."""
    sides = [pair.slave] if isinstance(pair.master, RigidCurve) else [pair.slave, pair.master]
    cells = np.concatenate([edges_or_nodes(model.mesh, side)[0][:, 0] for side in sides])
    cells = cells[model.mesh.are_lines(cells)]
    for section in model.sections if len(cells) else ():
        plain = replace(section, height=0.0).line_height
        same = math.isclose(section.line_height, plain, rel_tol=1e-12)
        if not same and np.isin(cells, cells_of(model.mesh, section.cells)).any():
            raise UnsupportedError(
                f"contact pair {pair.name!r}: no card of a deck holds the height "
                f"{section.height:g} of a line with this area and second moment; leave it out, or "
                "keep the model in Python"
            )


def _behavior(law: PressureLaw) -> str:
    if law.kind.upper() not in LAWS:
        raise UnsupportedError(f"no card of a deck holds a {law.kind} pressure law")
    rows = f"{float(law.pressure[0])!r}\n"
    if law.kind == "exponential":
        rows = f"{float(law.overclosure[0])!r}, {rows}"
    elif law.kind == "tabular":
        pairs = zip(law.pressure.tolist(), law.overclosure.tolist(), strict=True)
        rows = "".join(f"{p!r}, {w!r}\n" for p, w in pairs)
    return f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE={law.kind.upper()}\n{rows}"


def _friction(friction: Friction, more: str = "") -> str:
    if isinstance(friction, DecayingFriction):
        numbers = (friction.static, friction.kinetic, friction.decay)
        return f"*FRICTION, EXPONENTIAL DECAY{more}\n{', '.join(map(repr, numbers))}\n"
    rows = friction.rows if isinstance(friction, FrictionTable) else [(float(friction),)]
    return f"*FRICTION{more}\n" + "".join(f"{', '.join(map(repr, row))}\n" for row in rows)


def _profile(model: Model, curve: RigidCurve, name: str) -> str:
    """A rigid curve as profile; in both the outward normal is on the left."""
    text, last = "", None
    for row in curve.segments:
        points, center = _pieces(row)
        if last is None:
            text += f"START, {_point(points[0])}\n"
        elif math.dist(last, points[0]) > 1e-9 * float(np.ptp(curve.segments[:, :4])):
            raise UnsupportedError(
                "a rigid curve of separate pieces cannot be written to a deck: make each piece a "
                "curve with a contact pair of its own"
            )
        for point in points[1:]:
            tail = f", {_point(center)}" if center is not None else ""
            text += f"{'CIRCL' if tail else 'LINE'}, {_point(point)}{tail}\n"
        last = points[-1]
    text = f"*SURFACE, TYPE=SEGMENTS, NAME={name}\n{text}"
    if isinstance(curve.reference, int | np.integer):
        label = model.mesh.node_labels[curve.reference]
        text += f"*RIGID BODY, ANALYTICAL SURFACE={name}, REF NODE={label}\n"
    return text


def _pieces(row: Floats) -> tuple[Floats, Floats | None]:
    """Points along a segment from its start to its end, and the center of an arc."""
    start, end, center, sweep = row[:2], row[2:4], row[4:6], float(row[6])
    if sweep == 0.0:
        return np.array([start, end]), None
    count = math.ceil(abs(sweep) / PIECE)
    angle = sweep * np.arange(count + 1) / count
    c, s = np.cos(angle), np.sin(angle)
    x, y = start - center
    return center + np.column_stack([c * x - s * y, s * x + c * y]), center


def _point(at: Floats) -> str:
    return f"{float(at[0])!r}, {float(at[1])!r}"


def _word(name: str) -> str:
    return "_".join(name.replace(",", " ").split()) or "TIE"

"""Cards of output requests."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Literal, cast

from corota.io.deck import numerals
from corota.io.deck.deck import Deck, nearest
from corota.io.deck.lexer import Card, key
from corota.model.steps import Output
from corota.results.table import requests

Kind = Literal[
    "node print",
    "el print",
    "contact print",
    "section print",
    "node file",
    "el file",
    "contact file",
]

#: Variables that are written, by their location; of the tables of nodes and points see `written`.
WRITTEN = {
    "node": (),
    "el": ("ELSE", "ELKE", "EVOL"),
    "section": ("SOF", "SOM", "SOAREA"),
    "contact": ("CDIS", "CSTR", "CELS", "CNUM", "CF", "CFN", "CFS"),
}
#: Names of Abaqus for the same.
ALIASES = {"CSTRESS": "CSTR", "CDISP": "CDIS", "CFORCE": "CF", "NT11": "NT"}


def written(place: str) -> tuple[str, ...]:
    """Variables that are written at nodes, in elements or of contact."""
    rows = {n: r for n, r in requests().items() if r.title and place in ("node", "el")}
    own = tuple(n for n, r in rows.items() if bool(r.frame) == (place == "node"))
    return own + WRITTEN[place]


def restart(deck: Deck, card: Card) -> None:
    """``*RESTART, WRITE[, FREQUENCY=]``: keep checkpoints of this step and the later ones.

    ``READ`` is handled before; steps of the earlier deck end with it.
    """
    deck.no_rows(card)
    if card.has("READ") and deck.step is not None:
        deck.error(card, card.at("READ"), "READ belongs before the first *STEP")
        return
    if card.has("READ") and not card.has("WRITE"):
        deck.restart = 0
        return
    deck.restart = deck.parameter_integer(card, "FREQUENCY", 1, 0)
    if deck.step is not None:
        deck.step.restart = deck.restart


def node_print(deck: Deck, card: Card) -> None:
    """``*NODE PRINT[, NSET=]``: table of nodal values in ``<job>.dat``; else of all nodes.

    ``GLOBAL=YES`` prints them in global axes where nodes have their own, too.
    """
    _request(deck, card, "node print", card.value("NSET"))


def el_print(deck: Deck, card: Card) -> None:
    """``*EL PRINT[, ELSET=]``: table of values at integration points in ``<job>.dat``."""
    _request(deck, card, "el print", card.value("ELSET"))


def node_file(deck: Deck, card: Card) -> None:
    """``*NODE FILE`` or ``*NODE OUTPUT``: nodal fields in the result file."""
    _request(deck, card, "node file", card.value("NSET"))


def el_file(deck: Deck, card: Card) -> None:
    """``*EL FILE`` or ``*ELEMENT OUTPUT``: element fields in the result file."""
    _request(deck, card, "el file", card.value("NSET") or card.value("ELSET"))


def contact_print(deck: Deck, card: Card) -> None:
    """``*CONTACT PRINT[, SLAVE=, MASTER=]``: tables of contact in ``<job>.dat``."""
    slave, master = card.value("SLAVE"), card.value("MASTER")
    if bool(slave) != bool(master):
        deck.error(card, card.where, "SLAVE= and MASTER= belong together")
        return
    _request(deck, card, "contact print", f"{slave}-{master}" if slave else "")


def section_print(deck: Deck, card: Card) -> None:
    """``*SECTION PRINT, SURFACE=[, NAME=]``: force and moment on a surface in ``<job>.dat``."""
    surface = deck.required(card, "SURFACE")
    if surface:
        _request(deck, card, "section print", surface)


def contact_file(deck: Deck, card: Card) -> None:
    """``*CONTACT FILE`` or ``*CONTACT OUTPUT``: contact fields, which are always written."""
    _request(deck, card, "contact file", "")


def output(deck: Deck, card: Card) -> None:
    """``*OUTPUT``: frequency of the ``*... OUTPUT`` cards below it."""
    if deck.step is None:
        deck.error(card, card.where, "the card belongs inside a step")
        return
    deck.step.frequency = _frequency(deck, card)
    if key(card.value("VARIABLE")) in ("PRESELECT", "ALL"):
        into = deck.step.outputs
        into.append(Output("node file", ("U", "RF"), frequency=deck.step.frequency))
        into.append(Output("el file", ("S", "E"), frequency=deck.step.frequency))
    deck.no_rows(card)


def ignored(deck: Deck, card: Card) -> None:
    """Read a card that has no effect here."""
    deck.note(f"{card.where}: {card.spelled} is ignored")


def _request(deck: Deck, card: Card, kind: Kind, where: str) -> None:
    if deck.step is None:
        deck.error(card, card.where, "the card belongs inside a step")
        return
    place = kind.split()[0]
    known = written(place)
    requested: list[str] = []
    left_out: dict[str, str] = {}
    for row in card.rows():
        for text in row.fields:
            name = key(text)
            name = ALIASES.get(name, name)
            if not name:
                continue
            if name not in known and name.rstrip("0123456789") in known:
                name = name.rstrip("0123456789")  # a component: all of them are written
            if name in known:
                if name not in requested:
                    requested.append(name)
            else:
                left_out.setdefault(name, numerals.clipped(name, 30))
    if left_out:
        shown = ", ".join(left_out.values())
        deck.note(
            f"{card.where}: {card.spelled}: {shown} is not written; there are {', '.join(known)}"
        )
    totals = deck.choice(card, "TOTALS", ("NO", "YES", "ONLY"), "NO").lower()
    frequency = _frequency(deck, card)
    points = card.value("TIMEPOINTS")
    if card.has("TIMEPOINTS") and key(points) not in deck.time_points:
        deck.error(
            card,
            card.at("TIMEPOINTS"),
            f"no *TIME POINTS named {points!r} before this card",
            hint=nearest(points, deck.time_points),
        )
        return
    if frequency == 0:
        deck.note(f"{card.where}: {card.spelled} with FREQUENCY=0 requests nothing")
    elif requested:
        deck.step.outputs.append(
            Output(
                kind,
                tuple(requested),
                where,
                frequency,
                cast("Literal['no', 'yes', 'only']", totals),
                key(points),
                card.where,
                kind == "node print" and deck.choice(card, "GLOBAL", ("NO", "YES"), "NO") == "YES",
                card.has("FREQUENCY") or card.has("FREQUENCYF"),
            )
        )


def _frequency(deck: Deck, card: Card) -> int:
    under = deck.step is not None and card.keyword in (
        "NODEOUTPUT",
        "ELEMENTOUTPUT",
        "CONTACTOUTPUT",
    )
    default = deck.step.frequency if under and deck.step is not None else 1
    name = "FREQUENCYF" if card.has("FREQUENCYF") else "FREQUENCY"
    return deck.parameter_integer(card, name, default, 0)

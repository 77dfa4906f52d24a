"""Cards of output requests."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Literal, cast

from corota.io.deck import numerals
from corota.io.deck.card import Card, key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.drafts import StepDraft
from corota.io.deck.keywords import keyword
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

_PRINT = "TOTALS FREQUENCY FREQUENCYF TIMEPOINTS"
_PRINT_IGNORED = "SUMMARY LASTITERATIONS CONTACTELEMENTS"
_FILE = "FREQUENCY FREQUENCYF TIMEPOINTS"
_FILE_IGNORED = (
    "GLOBAL OUTPUT LASTITERATIONS CONTACTELEMENTS OUTPUTALL POSITION DIRECTIONS SECTIONFORCES "
    "VARIABLE SUMMARY"
)
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


@keyword("RESTART", "WRITE READ FREQUENCY STEP INC ENDSTEP JOB", "OVERLAY NUMBERINTERVAL TIMEMARKS")
def restart(deck: Deck, card: Card) -> None:
    """``*RESTART, WRITE[, FREQUENCY=]``: keep checkpoints of this step and the later ones.

    ``READ`` is handled before; steps of the earlier deck end with it.
    """
    card.no_rows()
    if card.has("READ") and deck.step is not None:
        card.refuse("READ belongs before the first *STEP", "READ")
    if card.has("READ") and not card.has("WRITE"):
        deck.restart = 0
        return
    deck.restart = card.integer("FREQUENCY", 1, 0)
    if deck.step is not None:
        deck.step.restart = deck.restart


@keyword("NODE PRINT", f"NSET {_PRINT} GLOBAL", _PRINT_IGNORED)
def node_print(deck: Deck, card: Card) -> None:
    """``*NODE PRINT[, NSET=]``: table of nodal values in ``<job>.dat``; else of all nodes.

    ``GLOBAL=YES`` prints them in global axes where nodes have their own, too.
    """
    _request(deck, card, "node print", card.value("NSET"))


@keyword("EL PRINT", f"ELSET {_PRINT}", f"GLOBAL POSITION {_PRINT_IGNORED}")
def el_print(deck: Deck, card: Card) -> None:
    """``*EL PRINT[, ELSET=]``: table of values at integration points in ``<job>.dat``."""
    _request(deck, card, "el print", card.value("ELSET"))


@keyword("NODE FILE", f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}")
@keyword("NODE OUTPUT", f"NSET {_FILE}", f"ELSET {_FILE_IGNORED}")
def node_file(deck: Deck, card: Card) -> None:
    """``*NODE FILE`` or ``*NODE OUTPUT``: nodal fields in the result file."""
    _request(deck, card, "node file", card.value("NSET"))


@keyword("EL FILE", f"NSET ELSET {_FILE}", _FILE_IGNORED)
@keyword("ELEMENT OUTPUT", f"NSET ELSET {_FILE}", _FILE_IGNORED)
def el_file(deck: Deck, card: Card) -> None:
    """``*EL FILE`` or ``*ELEMENT OUTPUT``: element fields in the result file."""
    _request(deck, card, "el file", card.value("NSET") or card.value("ELSET"))


@keyword("CONTACT PRINT", "SLAVE MASTER TOTALS FREQUENCY FREQUENCYF TIMEPOINTS", "SUMMARY NSET SET")
def contact_print(deck: Deck, card: Card) -> None:
    """``*CONTACT PRINT[, SLAVE=, MASTER=]``: tables of contact in ``<job>.dat``."""
    slave, master = card.value("SLAVE"), card.value("MASTER")
    if bool(slave) != bool(master):
        card.refuse("SLAVE= and MASTER= belong together")
    _request(deck, card, "contact print", f"{slave}-{master}" if slave else "")


@keyword("SECTION PRINT", "SURFACE FREQUENCY FREQUENCYF TIMEPOINTS", "NAME AXES UPDATE TOTALS")
def section_print(deck: Deck, card: Card) -> None:
    """``*SECTION PRINT, SURFACE=[, NAME=]``: force and moment on a surface in ``<job>.dat``."""
    surface = card.required("SURFACE")
    if surface:
        _request(deck, card, "section print", surface)


@keyword("CONTACT FILE", _FILE, "NSET SLAVE MASTER")
@keyword("CONTACT OUTPUT", _FILE, "NSET SLAVE MASTER VARIABLE CPSET SURFACE")
def contact_file(deck: Deck, card: Card) -> None:
    """``*CONTACT FILE`` or ``*CONTACT OUTPUT``: contact fields, which are always written."""
    _request(deck, card, "contact file", "")


@keyword(
    "OUTPUT",
    "FREQUENCY FREQUENCYF VARIABLE",
    "FIELD HISTORY NAME OP NUMBERINTERVAL TIMEMARKS TIMEINTERVAL TIMEPOINTS FILTER",
)
def output(deck: Deck, card: Card) -> None:
    """``*OUTPUT``: frequency of the ``*... OUTPUT`` cards below it."""
    now = _open_step(deck, card)
    now.frequency = _frequency(now, card)
    if key(card.value("VARIABLE")) in ("PRESELECT", "ALL"):
        now.outputs.append(Output("node file", ("U", "RF"), frequency=now.frequency))
        now.outputs.append(Output("el file", ("S", "E"), frequency=now.frequency))
    card.no_rows()


def _open_step(deck: Deck, card: Card) -> StepDraft:
    if deck.step is None:
        card.refuse("the card belongs inside a step")
    return deck.step


def _request(deck: Deck, card: Card, kind: Kind, where: str) -> None:
    now = _open_step(deck, card)
    known = written(kind.split()[0])
    requested: list[str] = []
    left_out: dict[str, str] = {}
    for text in (text for row in card.rows() for text in row.fields):
        name = ALIASES.get(key(text), key(text))
        if name not in known and name.rstrip("0123456789") in known:
            name = name.rstrip("0123456789")  # a component: all of them are written
        if name and name not in known:
            left_out.setdefault(name, numerals.clipped(name, 30))
        elif name and name not in requested:
            requested.append(name)
    if left_out:
        shown = ", ".join(left_out.values())
        card.note(f"{shown} is not written; there are {', '.join(known)}")
    totals = card.choice("TOTALS", ("NO", "YES", "ONLY"), "NO").lower()
    frequency = _frequency(now, card)
    points = card.value("TIMEPOINTS")
    if card.has("TIMEPOINTS") and key(points) not in deck.time_points:
        text = f"no *TIME POINTS named {points!r} before this card"
        card.refuse(text, "TIMEPOINTS", nearest(points, deck.time_points))
    if frequency == 0:
        deck.note(f"{card.where}: {card.spelled} with FREQUENCY=0 requests nothing")
    elif requested:
        now.outputs.append(
            Output(
                kind,
                tuple(requested),
                where,
                frequency,
                cast("Literal['no', 'yes', 'only']", totals),
                key(points),
                card.where,
                kind == "node print" and card.choice("GLOBAL", ("NO", "YES"), "NO") == "YES",
                card.has("FREQUENCY") or card.has("FREQUENCYF"),
            )
        )


def _frequency(now: StepDraft, card: Card) -> int:
    """Increments between outputs; those of ``*OUTPUT`` for the cards below it."""
    under = card.keyword in ("NODEOUTPUT", "ELEMENTOUTPUT", "CONTACTOUTPUT")
    name = "FREQUENCYF" if card.has("FREQUENCYF") else "FREQUENCY"
    return card.integer(name, now.frequency if under else 1, 0)

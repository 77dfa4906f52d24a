"""Reading a deck: lexer, keywords, model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from corota.errors import DeckError, Diagnostic, InputError
from corota.io.deck.build.model import ModelBuilder
from corota.io.deck.card import key, nearest
from corota.io.deck.deck import Deck
from corota.io.deck.dialect import find_dialect, is_of_calculix
from corota.io.deck.elements import ELEMENTS, OWN
from corota.io.deck.fields import find_fields
from corota.io.deck.interpret import interpret
from corota.io.deck.lexer import Lexer
from corota.io.deck.restart import card_that_reads, with_earlier_steps
from corota.lazy import lazy
from corota.model.units import Units

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from corota.model.model import Model

close_part = lazy("corota.io.deck.cards.assembly:close_part")


def read_deck(
    path: str | os.PathLike[str],
    element_map: Mapping[str, str] | None = None,
    lenient: bool = False,
    allow_include: bool = False,
    as_written: bool = False,
    parameters: Mapping[str, float] | None = None,
    library: str | os.PathLike[str] | None = None,
) -> Model:
    """Read a CalculiX or Abaqus deck; parameters as of :func:`corota.io.formats.read`.

    Returns
    -------
    Model
        With what was ignored or repaired in ``Model.notes``.

    Raises
    ------
    DeckError
        With all the faults of the deck.
    FileError
        If the file cannot be read.
    """
    lexer = Lexer(Path(path), allow_include, parameters)
    cards = lexer.read()
    deck = Deck(lenient=lenient, element_map=_checked_map(element_map or {}), literal=as_written)
    deck.library = library
    deck.diagnostics, deck.lexer = lexer.diagnostics, lexer
    saved = None
    if (reads := card_that_reads(cards)) is not None:
        cards, saved = with_earlier_steps(deck, lexer, cards, reads)
    deck.dialect, deck.fields = lexer.dialect or find_dialect(cards), find_fields(cards)
    deck.of_calculix = lexer.dialect == "calculix" or is_of_calculix(cards)
    for card in cards:
        interpret(deck, card)
    if not cards and not deck.n_errors:
        deck.error(None, None, f"{path} has no keyword; a deck starts with one such as *NODE")
    _open_ends(deck)
    model = None
    deck.building = True
    try:
        model = ModelBuilder(deck, Path(path).stem).build()
    except InputError as error:
        deck.error(None, error.where, error.message)
    if deck.hidden:
        deck.diagnostics.append(Diagnostic("error", f"{deck.hidden} more errors are not listed"))
    if deck.n_errors or model is None:
        raise DeckError(deck.diagnostics)
    _name_units(model, lexer)
    for text, where in lexer.stages:
        try:
            model.add_stage(text)
        except InputError as error:
            raise DeckError([Diagnostic("error", error.message, where)]) from None
    first = str(Path(path).resolve())
    model.sources = [first, *sorted({str(file) for file in lexer.files} - {first})]
    model.start = None if saved is None else saved.state
    for finding in deck.diagnostics:
        warnings.warn(str(finding), stacklevel=2)
    return model


def _name_units(model: Model, lexer: Lexer) -> None:
    """Read the units of a comment; an unknown one is a note, not an error."""
    if lexer.units is None:
        return
    text, where = lexer.units
    try:
        model.unit_system = Units.of(*filter(None, re.split(r"[,;\s]+", text)), where=where)
    except InputError as error:
        model.notes.append(f"{where}: the units of this comment are ignored: {error.message}")


def _open_ends(deck: Deck) -> None:
    if deck.step is not None:
        deck.step.card.error("the step has no *END STEP")
    if deck.instance is not None:
        where = deck.instance.card.where
        deck.error(deck.instance.card, where, "the instance has no *END INSTANCE")
    elif deck.scope is not deck.root:
        close_part(deck)
    elif deck.in_assembly:
        deck.error(None, None, "the assembly has no *END ASSEMBLY")


def _checked_map(element_map: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    found = {}
    for given, wanted in element_map.items():
        old, new = key(given), key(wanted)
        if old not in ELEMENTS:
            hint = nearest(old, ELEMENTS)
            raise InputError(f"unknown element {given!r} to replace; {hint or 'see the table'}")
        if new not in ELEMENTS:
            raise InputError(f"unknown element {wanted!r} for {given}; known: {', '.join(OWN)}")
        if ELEMENTS[old].kind != ELEMENTS[new].kind:
            raise InputError(f"{wanted} cannot replace {given}: it has another shape")
        found[old] = (ELEMENTS[new].element, ELEMENTS[new].plane)
    return found

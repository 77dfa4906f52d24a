"""The table of keywords, which the functions of their cards enter themselves."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from corota.io.deck.card import Card, key
from corota.io.deck.laws import LAWS
from corota.lazy import lazy

if TYPE_CHECKING:
    from corota.io.deck.deck import Deck

Function = TypeVar("Function", bound="Callable[[Deck, Card], object]")


@dataclass(frozen=True)
class Keyword:
    """Function of a keyword, and its parameters.

    Parameters
    ----------
    function : callable
        Reads the card into the deck.
    parameters : str
        Names that are used, blank-separated, themselves without blanks.
    ignored : str
        Names that are accepted and have no effect here; each is noted.
    place : {"model", "step", "any"}
        Where the card is allowed.
    """

    function: Callable[[Deck, Card], object]
    parameters: str = ""
    ignored: str = ""
    place: str = "any"


#: Usual spelling of each keyword, and the module that declares it, by the name without blanks.
_DECLARED = {
    key(name): (name, path.stem)
    for path in sorted(Path(__file__).with_name("cards").glob("*.py"))
    for name in map(bytes.decode, re.findall(rb'\n@keyword\(\s*"([^"]+)"', path.read_bytes()))
}
if not _DECLARED:
    raise ImportError(
        "the sources of corota.io.deck.cards, which declare the keywords, are missing"
    )
SPELLED = {plain: name for plain, (name, _) in _DECLARED.items()}


class _Keywords(dict[str, Keyword | None]):
    """Keywords by name without blanks; the module of a card is loaded at its first use."""

    def __getitem__(self, name: str) -> Keyword:
        if super().__getitem__(name) is None:
            import_module(f"corota.io.deck.cards.{_DECLARED[name][1]}")
        found = super().__getitem__(name)
        assert found is not None, name
        return found


KEYWORDS = _Keywords(dict.fromkeys(_DECLARED))
# Laws with a card of their own.
for _name, _law in LAWS.items():
    if key(_law.card) == _name:
        _read = partial(lazy("corota.io.deck.cards.material:constants"), law=_name)
        KEYWORDS[_name], SPELLED[_name] = Keyword(_read, place="model"), _law.card


def keyword(
    name: str, parameters: str = "", ignored: str = "", place: str = "any"
) -> Callable[[Function], Function]:
    """Enter a function in the table, under the usual spelling of its card; see :class:`Keyword`.

    The table finds the functions of :mod:`corota.io.deck.cards` by these lines of their modules,
    which it reads without loading them.
    """

    def enter(function: Function) -> Function:
        # What a program has put in the place of one of these cards stays.
        if key(name) not in _DECLARED or dict.get(KEYWORDS, key(name)) is None:
            KEYWORDS[key(name)] = Keyword(function, parameters, ignored, place)
        return function

    return enter

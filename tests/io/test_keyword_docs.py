"""The page of keywords names every keyword that is read or passed over."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import pytest

from corota.io.deck.card import key
from corota.io.deck.cards.output import WRITTEN
from corota.io.deck.elements import ALIASES, ELEMENTS, LINES, OWN
from corota.io.deck.keywords import KEYWORDS
from corota.io.deck.refused import IGNORED, UNSUPPORTED

PAGE = (Path(__file__).parents[2] / "docs" / "keywords.md").read_text(encoding="utf-8")
NAMED = {key(name) for name in re.findall(r"`\*([A-Z][A-Z -]*)", PAGE)}
CODE = {word for text in re.findall(r"`([^`]*)`", PAGE) for word in re.split(r"[ ,]+", text)}


@pytest.mark.parametrize("keyword", [*KEYWORDS, *IGNORED])
def test_every_keyword_is_on_the_page(keyword: str) -> None:
    assert keyword in NAMED, f"docs/keywords.md has no row of {keyword}"


def test_the_page_names_no_keyword_that_the_reader_does_not_know() -> None:
    assert {*KEYWORDS, *IGNORED, *UNSUPPORTED, "INCLUDE"} >= NAMED


def test_no_keyword_is_in_two_tables() -> None:
    assert not set(KEYWORDS) & set(IGNORED)
    assert not (set(KEYWORDS) | set(IGNORED)) & set(UNSUPPORTED)


def test_elements_and_variables_are_on_the_page() -> None:
    missing = (set(LINES) | set(OWN)) - CODE
    assert not missing, f"docs/keywords.md (Elements) does not name the types {missing}"
    for name in ELEMENTS:
        assert name in CODE or name[3:] in ALIASES
    for names in WRITTEN.values():
        assert set(names) <= CODE

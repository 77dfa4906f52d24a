"""Cards of a deck and their data lines: what they hold, where it stands, what is wrong with it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NoReturn, Protocol, TypeVar

from corota.errors import Location
from corota.io.deck import numerals

Number = TypeVar("Number", int, float)
One = TypeVar("One")
Two = TypeVar("Two")

_BLANK = re.compile(r'[\s"]+')


class Refused(Exception):
    """The rest of a card, or of a data line, is not read; its fault is recorded."""


class Record(Protocol):
    """What keeps the faults and notes of cards: a :class:`~corota.io.deck.deck.Deck`."""

    def error(
        self,
        card: Card | None,
        where: Location | None,
        message: str,
        *,
        text: str | None = None,
        hint: str = "",
        severity: str = "error",
    ) -> None:
        """Record an error, or a warning; reading continues."""

    def note(self, text: str) -> None:
        """Note what was ignored, repaired or assumed, once."""


@dataclass(frozen=True)
class Source:
    """Bytes of one file and the name shown in messages."""

    name: str
    data: bytes

    def line(self, start: int) -> tuple[str, int]:
        """Text of the line that starts at a byte, and the byte after it."""
        end = self.data.find(b"\n", start)
        stop = len(self.data) if end < 0 else end
        text = decode(self.data[start:stop]).rstrip("\r")
        return text, len(self.data) if end < 0 else end + 1


@dataclass(frozen=True)
class Chunk:
    """Consecutive data lines of one file: bytes ``start:stop``, first line number."""

    source: Source
    start: int
    stop: int
    line: int

    def data(self) -> bytes:
        """Bytes of the lines."""
        return self.source.data[self.start : self.stop]


@dataclass(slots=True, eq=False, repr=False)
class Row:
    """One data line of a card as fields with their columns (from 1)."""

    card: Card
    where: Location
    text: str
    fields: list[str]
    columns: list[int]

    def __len__(self) -> int:
        return len(self.fields)

    def at(self, index: int) -> Location:
        """Place of a field, or the end of the line."""
        end = len(self.text.rstrip()) + 1
        column = self.columns[index] if index < len(self.columns) else end
        return Location(self.where.file, self.where.line, column)

    def get(self, index: int) -> str:
        """Text of a field, empty if it is not there."""
        return self.fields[index] if index < len(self.fields) else ""

    def error(self, index: int, message: str, hint: str = "") -> None:
        """Record an error at a field."""
        self.card.deck.error(self.card, self.at(index), message, text=self.text, hint=hint)

    def refuse(self, index: int, message: str, hint: str = "") -> NoReturn:
        """Record an error at a field and end the reading of the card.

        Raises
        ------
        Refused
        """
        self.error(index, message, hint)
        raise Refused

    def note(self, text: str) -> None:
        """Note what was ignored or assumed on this line."""
        self.card.deck.note(f"{self.where}: {self.card.spelled}: {text}")

    def real(self, index: int, what: str, default: float | None = None) -> float | None:
        """Value of a field; an empty one is the default; ``None`` after an error."""
        return self._value(index, what, default, numerals.real)

    def integer(self, index: int, what: str, default: int | None = None) -> int | None:
        """Value of a whole-number field; as :meth:`real`."""
        return self._value(index, what, default, numerals.integer)

    def reals(
        self,
        names: Sequence[str],
        default: float | None = None,
        start: int = 0,
        required: int = 0,
    ) -> list[float]:
        """Values of consecutive fields from `start` on; empty ones after `required` the default.

        Raises
        ------
        Refused
            After an error in any of them; all are recorded.
        """
        defaults = [None] * required + [default] * (len(names) - required)
        each = enumerate(zip(names, defaults, strict=False), start)
        return complete([self.real(i, what, value) for i, (what, value) in each])

    def integers(
        self, names: Sequence[str], default: int | None = None, start: int = 0
    ) -> list[int]:
        """Values of consecutive whole-number fields; as :meth:`reals`."""
        return complete([self.integer(i, what, default) for i, what in enumerate(names, start)])

    def number(self, index: int, what: str, default: float | None = None) -> float:
        """Value of one field; as :meth:`reals`."""
        return self.reals((what,), default, index)[0]

    def whole(self, index: int, what: str, default: int | None = None) -> int:
        """Value of one whole-number field; as :meth:`reals`."""
        return self.integers((what,), default, index)[0]

    def positive(self, names: Sequence[str], start: int = 0) -> list[float]:
        """Values of consecutive fields, all > 0.

        Raises
        ------
        Refused
            After the first error.
        """
        found = []
        for index, what in enumerate(names, start):
            value = self.number(index, what)
            if value <= 0.0:
                self.refuse(index, f"{what} must be > 0, not {value:g}")
            found.append(value)
        return found

    def _value(
        self, index: int, what: str, default: Number | None, read: Callable[[str], Number]
    ) -> Number | None:
        text = self.get(index)
        if not text and default is not None:
            return default
        try:
            if not text:
                self.error(index, f"{what} is missing")
                return None
            return read(text)
        except ValueError as error:
            self.error(index, f"{what}: {error}")
            return None

    def at_most(self, most: int) -> None:
        """Refuse non-empty fields after the last one that the card takes."""
        for index in range(most, len(self)):
            if self.fields[index]:
                self.error(index, f"too many fields: at most {most} are expected")
                return


@dataclass(slots=True, eq=False, repr=False)
class Parameter:
    """One parameter of a keyword line; ``value`` is empty if none was given."""

    name: str
    value: str
    column: int
    value_column: int


@dataclass(slots=True, eq=False, repr=False)
class Card:
    """One keyword line with its data lines.

    Attributes
    ----------
    keyword : str
        Upper case without blanks, without the star: ``SOLIDSECTION``.
    spelled : str
        As in the file: ``*Solid Section``.
    parameters : dict of str to Parameter
        By name, upper case without blanks.
    scope : object
        Part, instance or assembly in which it stands; set where cards are interpreted.
    deck : Record
        What keeps its faults and notes; set where cards are interpreted.
    """

    keyword: str
    spelled: str
    parameters: dict[str, Parameter]
    where: Location
    text: str
    chunks: list[Chunk] = field(default_factory=list)
    scope: object = None
    #: Data lines that take the place of those in the file.
    picked: list[Row] | None = None
    deck: Record = field(init=False)

    def rows(self) -> Iterator[Row]:
        """Iterate over the data lines, without comments and empty ones."""
        if self.picked is not None:
            yield from self.picked
            return
        for chunk in self.chunks:
            yield from self.rows_of(chunk)

    def rows_of(self, chunk: Chunk) -> Iterator[Row]:
        """Iterate over some of the data lines."""
        start, number = chunk.start, chunk.line
        while start < chunk.stop:
            text, start = chunk.source.line(start)
            stripped = text.strip()
            if stripped and not stripped.startswith("**"):
                yield self.row(text, Location(chunk.source.name, number))
            number += 1

    def row(self, text: str, where: Location) -> Row:
        """Cut a data line at its commas; one trailing comma adds no field."""
        fields, columns, column = [], [], 1
        for part in split_at_commas(text) if '"' in text else text.split(","):
            body = part.strip()
            fields.append(body)
            columns.append(column + len(part) - len(part.lstrip()) if body else column)
            column += len(part) + 1
        if len(fields) > 1 and not fields[-1]:
            fields.pop()
            columns.pop()
        return Row(self, where, text, fields, columns)

    def row_of(self, name: str) -> Row:
        """Row of one field that stands for the value of a parameter."""
        where = self.at(name)
        return Row(self, where, self.text, [self.value(name)], [where.column])

    def lines(self, what: str) -> list[Row]:
        """The data lines, of which there is at least one.

        Raises
        ------
        Refused
            If there is none; the message says that `what` is missing.
        """
        rows = list(self.rows())
        if not rows:
            self.refuse(f"a data line is missing: {what}")
        return rows

    def one_line(self, what: str, counted: bool = False) -> Row:
        """The one data line.

        Raises
        ------
        Refused
            If there are none or several; the message says that `what` is expected.
        """
        rows = list(self.rows())
        if len(rows) != 1:
            found = f", found {len(rows)}" if counted else ""
            self.refuse(f"one data line is expected{what and ': '}{what}{found}")
        return rows[0]

    def no_rows(self) -> None:
        """Refuse data lines under a card that takes none."""
        for row in self.rows():
            row.error(0, "no data line is expected here")
            return

    def value(self, name: str) -> str:
        """Value of a parameter, empty if it is absent."""
        found = self.parameters.get(name)
        return found.value if found else ""

    def has(self, name: str) -> bool:
        """Whether a parameter is given."""
        return name in self.parameters

    def at(self, name: str) -> Location:
        """Place of a parameter's value, or of the card."""
        found = self.parameters.get(name)
        if found is None:
            return self.where
        column = found.value_column or found.column
        return Location(self.where.file, self.where.line, column)

    def error(self, message: str, at: str = "", hint: str = "") -> None:
        """Record an error of the card, at the value of the parameter `at`, if it is given."""
        self.deck.error(self, self.at(at), message, hint=hint)

    def refuse(self, message: str, at: str = "", hint: str = "") -> NoReturn:
        """Record an error and end the reading of the card.

        Raises
        ------
        Refused
        """
        self.error(message, at, hint)
        raise Refused

    def note(self, text: str) -> None:
        """Note what was ignored or assumed."""
        self.deck.note(f"{self.where}: {self.spelled}: {text}")

    def number(self, name: str, default: float, least: float) -> float:
        """Value of a numeric parameter, at least ``least``."""
        return self._number(name, default, least, numerals.real)

    def integer(self, name: str, default: int, least: int) -> int:
        """Value of a whole-number parameter, at least ``least``."""
        return self._number(name, default, least, numerals.integer)

    def _number(
        self, name: str, default: Number, least: Number, read: Callable[[str], Number]
    ) -> Number:
        if not self.has(name):
            return default
        try:
            value = read(self.value(name))
            if value < least:
                raise ValueError(f"{value:g} is less than {least:g}")
        except ValueError as error:
            self.error(f"{self.parameters[name].name}: {error}", name)
            return default
        return value

    def choice(self, name: str, choices: Iterable[str], default: str) -> str:
        """Value of a parameter out of a list (compared without case and blanks).

        Unique abbreviations of at least three letters are accepted, as in Abaqus.
        """
        if not self.has(name):
            return default
        value, allowed = key(self.value(name)), list(choices)
        if value in allowed:
            return value
        begun = [word for word in allowed if len(value) > 2 and word.startswith(value)]
        if len(begun) == 1:
            return begun[0]
        shown = f"{self.parameters[name].name}={self.value(name)}"
        message = f"{shown} is not known; expected {', '.join(allowed)}"
        self.error(message, name, nearest(value, allowed))
        return default

    def required(self, name: str, shown: str = "") -> str:
        """Value of a parameter that must be there; empty after an error."""
        value = self.value(name)
        if not value:
            self.error(f"{shown or name}= is missing")
        return value


def complete(values: Sequence[Number | None]) -> list[Number]:
    """The values, if none is missing.

    Raises
    ------
    Refused
        If one is ``None``, after an error.
    """
    found = [value for value in values if value is not None]
    if len(found) < len(values):
        raise Refused
    return found


def both(one: One | None, two: Two | None) -> tuple[One, Two]:
    """Two values of different types; as :func:`complete`."""
    if one is None or two is None:
        raise Refused
    return one, two


def decode(data: bytes) -> str:
    """Text of bytes: UTF-8, else Latin-1 (which takes every byte)."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def key(name: str) -> str:
    """Form in which names are compared: upper case, no blanks, no quotes."""
    return _BLANK.sub("", name).upper()


def split_at_commas(text: str) -> list[str]:
    """Cut a line at commas outside quotes."""
    parts, quoted, start = [], False, 0
    for at, character in enumerate(text):
        if character == '"':
            quoted = not quoted
        elif character == "," and not quoted:
            parts.append(text[start:at])
            start = at + 1
    return [*parts, text[start:]]


def nearest(word: str, words: Iterable[str], cutoff: float = 0.7) -> str:
    """Question that names the nearest word, or an empty text."""
    from difflib import get_close_matches

    candidates = {key(w): w for w in words}
    found = get_close_matches(key(word)[:80], list(candidates), 1, cutoff)
    return f"did you mean {candidates[found[0]]}?" if found else ""

"""Cards of a deck with file, line and column; includes resolved, nothing interpreted."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import re
import stat
from collections.abc import Mapping
from pathlib import Path

import corota._core as _core
from corota.errors import Diagnostic, FileError, InputError, Location
from corota.io.deck import numerals
from corota.io.deck.card import Card, Chunk, Parameter, Source, decode, key, split_at_commas
from corota.io.deck.parameters import Parameters, Value

#: Files inside files.
MAX_DEPTH = 16
#: Files that a deck includes, each time counted.
MAX_FILES = 1000
#: Bytes of a deck with everything that it includes.
MAX_BYTES = 8 << 30
#: Memory per byte of a deck or mesh (measured on a million nodes).
READ = 8.0

_QUOTED = re.compile(r'^"(.*)"$')
#: A comment such as ``** UNITS: N, mm, t, s`` in the first bytes of a deck.
_UNITS = re.compile(rb"^[ \t]*\*\*[ \t]*units[ \t]*[:=]([^\r\n]*)", re.IGNORECASE | re.MULTILINE)
#: Comments such as ``** STAGE: HUB axis=rotation`` there.
_STAGE = re.compile(rb"^[ \t]*\*\*[ \t]*stage[ \t]*[:=]([^\r\n]*)", re.IGNORECASE | re.MULTILINE)
#: A comment ``** DIALECT: calculix`` there.
_DIALECT = re.compile(
    rb"^[ \t]*\*\*[ \t]*dialect[ \t]*[:=][ \t]*(calculix|abaqus)\b", re.IGNORECASE | re.MULTILINE
)
#: How far into a deck these comments are read [bytes].
HEAD = 65536


class Lexer:
    """Reads a deck and what it includes into cards.

    Parameters
    ----------
    path : Path
        The deck.
    allow_include : bool
        Whether includes may leave the deck's folder.
    parameters : mapping of str to number, optional
        Values of ``*PARAMETER`` names that replace those of the deck.

    Attributes
    ----------
    cards : list of Card
    diagnostics : list of Diagnostic
    files : set of Path
        All files that were read.
    """

    def __init__(
        self,
        path: Path,
        allow_include: bool = False,
        parameters: Mapping[str, Value] | None = None,
    ) -> None:
        self.path = path
        self.allow_include = allow_include
        self.cards: list[Card] = []
        self.diagnostics: list[Diagnostic] = []
        #: What a comment ``** UNITS: N, mm`` says, and where.
        self.units: tuple[str, Location] | None = None
        #: What a comment ``** DIALECT: calculix`` says.
        self.dialect = ""
        #: What comments ``** STAGE: HUB axis=rotation`` say, and where.
        self.stages: list[tuple[str, Location]] = []
        self._root = path.resolve().parent
        self._bytes = self._opens = 0
        self.files: set[Path] = {path.resolve()}
        self._parameters = Parameters(parameters)

    def read(self) -> list[Card]:
        """Read everything.

        Raises
        ------
        FileError
            If the deck itself cannot be read.
        """
        try:
            data = self._load(self.path)
        except (OSError, ValueError) as error:
            raise FileError(f"{self.path}: {_why(error)}") from error
        self._read_comments(data)
        self.scan(self._source(str(self.path), data), [self.path.resolve()])
        if lost := self._parameters.unused():
            known = ", ".join(name for name in self._parameters.values if name != "pi") or "none"
            raise InputError(f"{self.path}: no *PARAMETER named {lost[0]}; there are {known}")
        return self.cards

    def _read_comments(self, data: bytes) -> None:
        """Read the comments that name units, dialect and stages, near the head of the deck."""

        def said(comment: re.Match[bytes]) -> tuple[str, Location]:
            line = data.count(b"\n", 0, comment.start(1)) + 1
            return decode(comment.group(1)).strip(), Location(str(self.path), line)

        units = _UNITS.search(data, 0, HEAD)
        self.units = None if units is None else said(units)
        dialect = _DIALECT.search(data, 0, HEAD)
        self.dialect = "" if dialect is None else decode(dialect.group(1)).lower()
        self.stages = [said(comment) for comment in _STAGE.finditer(data, 0, HEAD)]

    def _source(self, name: str, data: bytes) -> Source:
        """The text of a file with its parameters put in."""
        data, faults = self._parameters.applied(data, decode)
        for number, message in faults:
            self._error(Location(name, number), f"*PARAMETER: {message}")
        return Source(name, data)

    def scan(self, source: Source, stack: list[Path]) -> None:
        """Cut one file into cards; lines before its first card continue the last one."""
        data = source.data
        if b"\0" in data:
            number = data.count(b"\n", 0, data.index(b"\0")) + 1
            self._error(Location(source.name, number), "the file is binary, not a text deck")
            return
        start, number = 0, 1
        while start < len(data):
            stop = _next_keyword(data, start)
            if stop > start:
                self._data(Chunk(source, start, stop, number))
                number += data.count(b"\n", start, stop)
            if stop == len(data):
                return
            start, number = self._keyword(source, stop, number, stack)

    def _data(self, chunk: Chunk) -> None:
        if self.cards:
            self.cards[-1].chunks.append(chunk)
            return
        lost = Card("", "", {}, Location(chunk.source.name, chunk.line), "", [chunk])
        for row in lost.rows():
            self._error(
                row.where,
                "a data line before the first keyword",
                text=row.text,
                hint="a deck starts with a keyword such as *NODE",
            )
            return

    def _keyword(
        self, source: Source, start: int, number: int, stack: list[Path]
    ) -> tuple[int, int]:
        text, after = source.line(start)
        where = Location(source.name, number)
        number += 1
        while text.rstrip().endswith(",") and after < len(source.data):
            more, next_after = source.line(after)
            first = more.split(",")[0].strip()
            if not first or first.startswith("*") or not _continues(first):
                break
            text, after, number = text.rstrip() + more, next_after, number + 1
        card = self._card(text, where)
        if card.keyword == "INCLUDE":
            self._include(card, stack)
        else:
            self.cards.append(card)
            if card.has("INPUT"):
                self._rows_of_file(card, stack)
        return after, number

    def _rows_of_file(self, card: Card, stack: list[Path]) -> None:
        """Take the data lines of a card from a file."""
        name = card.value("INPUT")
        found = self._opened(card, stack, name)
        if found is not None:
            data, _ = found
            shown = os.path.join(os.path.dirname(card.where.file), name)
            source = self._source(shown, data)
            if _next_keyword(source.data, 0) < len(source.data):
                self._error(
                    card.at("INPUT"),
                    f"{numerals.shown(name)} has keywords; data lines only",
                    card,
                    hint="include it by *INCLUDE, INPUT=",
                )
                return
            card.chunks.append(Chunk(source, 0, len(source.data), 1))
            del card.parameters["INPUT"]

    def _card(self, text: str, where: Location) -> Card:
        column = len(text) - len(text.lstrip()) + 1
        where = Location(where.file, where.line, column)
        parts = split_at_commas(text)
        spelled = parts[0].strip()
        parameters: dict[str, Parameter] = {}
        at = len(parts[0]) + 2
        card = Card(key(spelled)[1:], spelled, parameters, where, text)
        for part in parts[1:]:
            name, equals, value = part.partition("=")
            place = at + len(part) - len(part.lstrip())
            value_at = at + len(name) + 1 + len(value) - len(value.lstrip()) if equals else 0
            at += len(part) + 1
            if not name.strip():
                if equals:
                    self._error(
                        Location(where.file, where.line, place),
                        "a parameter without a name",
                        card,
                    )
                continue
            match = _QUOTED.match(value.strip())
            found = Parameter(
                name.strip(), match.group(1) if match else value.strip(), place, value_at
            )
            if key(name) in parameters:
                self._error(
                    Location(where.file, where.line, place),
                    f"parameter {name.strip()} is given twice",
                    card,
                )
            parameters[key(name)] = found
        return card

    def _include(self, card: Card, stack: list[Path]) -> None:
        name = card.value("INPUT")
        for parameter in card.parameters.values():
            if key(parameter.name) != "INPUT":
                self._error(
                    Location(card.where.file, card.where.line, parameter.column),
                    f"unknown parameter {parameter.name}",
                    card,
                    hint="*INCLUDE takes INPUT=file",
                )
        if not name:
            self._error(card.where, "INPUT=file is missing", card)
            return
        found = self._opened(card, stack, name)
        if found is not None:
            shown = os.path.join(os.path.dirname(card.where.file), name)
            self.scan(self._source(shown, found[0]), [*stack, found[1]])

    def allows(self, path: Path) -> bool:
        """Whether the deck may read a file: one in its folder or below, links followed."""
        return self.allow_include or path.resolve().is_relative_to(self._root)

    def _opened(self, card: Card, stack: list[Path], name: str) -> tuple[bytes, Path] | None:
        """Bytes and place of a file that a card names; ``None`` after an error."""
        where = card.at("INPUT")
        path = Path(os.path.normpath(stack[-1].parent / name))
        if len(stack) > MAX_DEPTH:
            self._error(where, f"*INCLUDE is nested more than {MAX_DEPTH} levels deep", card)
            return None
        self._opens += 1
        if self._opens > MAX_FILES:
            if self._opens == MAX_FILES + 1:
                self._error(where, f"more than {MAX_FILES:,} files are included", card)
            return None
        try:
            target = path.resolve()
            if not self.allows(target):
                self._error(
                    where,
                    f"{numerals.shown(name)} is outside the folder of the deck",
                    card,
                    hint="allow it with --allow-include (Python: allow_include=True)",
                )
                return None
            if target in stack:
                names = " -> ".join(p.name for p in [*stack[stack.index(target) :], target])
                self._error(where, f"the file includes itself: {names}", card)
                return None
            data = self._load(target)
            self.files.add(target)
            return data, target
        except (OSError, ValueError, RuntimeError) as error:
            self._error(where, f"{numerals.shown(name)} cannot be read: {_why(error)}", card)
            return None

    def _load(self, path: Path) -> bytes:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise ValueError("it is a folder")
        if not stat.S_ISREG(status.st_mode):
            raise ValueError("it is not a regular file")
        self._bytes += status.st_size
        if self._bytes > MAX_BYTES:
            raise ValueError(f"the deck and its files exceed {MAX_BYTES >> 30} GB")
        _core.require_memory(READ * status.st_size, f"reading {path.name}")
        with open(path, "rb") as file:
            # Python allocates the requested size: read no more than the file has.
            data = file.read(status.st_size)
        data = data.removeprefix(b"\xef\xbb\xbf")
        if b"\n" not in data:
            data = data.replace(b"\r", b"\n")
        return data if data.endswith(b"\n") or not data else data + b"\n"

    def _error(
        self,
        where: Location,
        message: str,
        card: Card | None = None,
        *,
        text: str = "",
        hint: str = "",
    ) -> None:
        keyword = numerals.clipped(card.spelled, 60) if card else ""
        line = card.text if card else text
        line = line if len(line) <= 160 else ""
        message = numerals.clipped(message)
        self.diagnostics.append(Diagnostic("error", message, where, keyword, line, hint))


def _next_keyword(data: bytes, start: int) -> int:
    """First byte of the next keyword line, from the first byte of a line on."""
    while True:
        star = data.find(b"*", start)
        if star < 0:
            return len(data)
        line = max(data.rfind(b"\n", start, star) + 1, start)
        if data[star + 1 : star + 2] != b"*" and not data[line:star].strip(b" \t"):
            return line
        end = data.find(b"\n", star)
        if end < 0:
            return len(data)
        start = end + 1


def _continues(first: str) -> bool:
    """Whether the first field of a line can only be a parameter of the line before."""
    return not numerals.is_number(first) and "=" in first


def _why(error: Exception) -> str:
    if isinstance(error, OSError):
        return error.strerror or str(error)
    return str(error)

"""Mutations of decks: bytes, lines, fields, cards; always the same for the same seed."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random

NUMBERS = [
    "0",
    "-1",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "-1e400",
    "1e-310",
    "0x1F",
    "2147483647",
    "1000000000",
    "9223372036854775808",
    "1e",
    "e5",
    "1.5.2",
    "--1",
    "1D3",
    "1d-3",
    "1.e0",
    ".5",
    "+",
    "",
    " ",
    "1 2",
    "99999999999999999999999999",
    "1e300",
    "-0.0",
    "1_000",
    "\u0661",
]
WORDS = [
    "all",
    "",
    "nowhere",
    "*",
    "**",
    ",",
    ",,,,",
    "=",
    "a=b",
    "NSET=",
    "GENERATE",
    '"quoted',
    "é",
    "x" * 5000,
    "Left.Right",
    ".",
    "1.2.3",
    "INST.1",
    "OP=NEW",
    "TYPE=CPS4",
    "TYPE=Q9",
    "TYPE=OPT",
    "TYPE=T3D2",
    "TYPE=S4",
    "NLGEOM",
    "DIRECT",
    "PLANE=STRAIN",
    "AMPLITUDE=none",
    "GRAV",
    "P1",
    "S3",
]
CARDS = [
    "*NODE",
    "*NODE, NSET=n",
    "*ELEMENT, TYPE=CPS3",
    "*ELEMENT, TYPE=CPS8R, ELSET=e",
    "*NSET, NSET=s, GENERATE\n1, 1000000000",
    "*NSET, NSET=s\ns",
    "*ELSET, ELSET=q\nq, 1",
    "*SURFACE, NAME=f\neall, S1",
    "*SURFACE, NAME=f, TYPE=NODE\n1",
    "*MATERIAL, NAME=m",
    "*ELASTIC\n1., .2",
    "*ELASTIC, TYPE=LAMINA\n1., 1., 5., 1.",
    "*DENSITY\n-1.",
    "*SOLID SECTION, ELSET=eall, MATERIAL=steel",
    "*BOUNDARY\n1, 1, 6, 3.",
    "*BOUNDARY, OP=NEW",
    "*CLOAD\n1, 6, 1.",
    "*DLOAD\neall, P3, 1.",
    "*DLOAD\neall, GRAV, 1., 1., 0., 0.",
    "*DSLOAD\nf, P, 1.",
    "*AMPLITUDE, NAME=a\n0., 0., 0., 1.",
    "*STEP",
    "*END STEP",
    "*STATIC",
    "*STATIC\n0., 0., 0., 0.",
    "*INCLUDE, INPUT=deck.inp",
    "*INCLUDE, INPUT=/dev/zero",
    "*INCLUDE, INPUT=../x",
    "*INCLUDE",
    "*PART, NAME=p",
    "*END PART",
    "*ASSEMBLY, NAME=a",
    "*INSTANCE, NAME=i, PART=p",
    "*END INSTANCE",
    "*END ASSEMBLY",
    "*ORIENTATION, NAME=o\n1,0,0,0,1,0",
    "*TIME POINTS, NAME=t, GENERATE\n0., 1., 1e-12",
    "*NODE PRINT, NSET=nall\nU",
    "*OUTPUT, FIELD",
    "*EL PRINT, ELSET=eall, TIME POINTS=t\nS",
    "*HEADING\n" + "h" * 2000,
    "*RESTART, WRITE",
    "*PLASTIC",
    "*UNKNOWN THING",
    "*",
    "*,",
    "*NODE FILE\nU, RF, NT, QQ",
]


def mutate(deck: str, rng: random.Random) -> bytes:
    """One to four mutations of a deck."""
    data = deck
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        data = rng.choice(_TEXT)(data, rng)
    raw = data.encode("utf-8", "surrogatepass")
    if rng.random() < 0.25:
        raw = mutate_bytes(raw, rng)
    return raw


def mutate_bytes(raw: bytes, rng: random.Random) -> bytes:
    """One mutation that knows of bytes only."""
    return rng.choice(_BYTES)(raw, rng)


def _lines(deck: str) -> list[str]:
    return deck.split("\n")


def _drop_line(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    del lines[rng.randrange(len(lines))]
    return "\n".join(lines) or "\n"


def _copy_line(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(lines))
    return "\n".join(lines)


def _swap_lines(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return "\n".join(lines)


def _field(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    at = rng.randrange(len(lines))
    fields = lines[at].split(",")
    fields[rng.randrange(len(fields))] = rng.choice(NUMBERS + WORDS)
    lines[at] = ",".join(fields)
    return "\n".join(lines)


def _more_fields(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    at = rng.randrange(len(lines))
    lines[at] += ", " + ", ".join(rng.choice(NUMBERS + WORDS) for _ in range(rng.randint(1, 40)))
    return "\n".join(lines)


def _fewer_fields(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    at = rng.randrange(len(lines))
    fields = lines[at].split(",")
    lines[at] = ",".join(fields[: rng.randrange(len(fields) + 1)])
    return "\n".join(lines)


def _digit(deck: str, rng: random.Random) -> str:
    places = [i for i, c in enumerate(deck) if c.isdigit()]
    if not places:
        return deck
    at = rng.choice(places)
    return deck[:at] + rng.choice("0123456789.-eDx ") + deck[at + 1 :]


def _card(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(CARDS))
    return "\n".join(lines)


def _misspell(deck: str, rng: random.Random) -> str:
    stars = [i for i, line in enumerate(_lines(deck)) if line.startswith("*")]
    lines = _lines(deck)
    if not stars:
        return deck
    at = rng.choice(stars)
    spot = rng.randrange(len(lines[at]))
    lines[at] = lines[at][:spot] + rng.choice(["", "X", "=", ",", " ", "*"]) + lines[at][spot + 1 :]
    return "\n".join(lines)


def _cut(deck: str, rng: random.Random) -> str:
    return deck[: rng.randrange(len(deck) + 1)]


def _repeat(deck: str, rng: random.Random) -> str:
    lines = _lines(deck)
    a = rng.randrange(len(lines))
    b = min(len(lines), a + rng.randint(1, 8))
    return "\n".join(lines[:b] + lines[a:b] * rng.randint(1, 5) + lines[b:])


def _flip(raw: bytes, rng: random.Random) -> bytes:
    data = bytearray(raw)
    for _ in range(rng.randint(1, 6)):
        if data:
            data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def _insert(raw: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(raw) + 1)
    return raw[:at] + rng.randbytes(rng.randint(1, 20)) + raw[at:]


def _endings(raw: bytes, rng: random.Random) -> bytes:
    return raw.replace(b"\n", rng.choice([b"\r\n", b"\r", b"\n\n", b"\n\r", b"\x0b", b"\x85"]))


def _long(raw: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(raw) + 1)
    return raw[:at] + rng.choice([b"9", b",", b" ", b"x", b"*"]) * 100_000 + raw[at:]


_TEXT = (
    _drop_line,
    _copy_line,
    _swap_lines,
    _field,
    _field,
    _field,
    _more_fields,
    _fewer_fields,
    _digit,
    _digit,
    _card,
    _card,
    _misspell,
    _cut,
    _repeat,
)
_BYTES = (_flip, _insert, _endings, _long)

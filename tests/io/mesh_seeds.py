"""Small ``.msh`` files, text and binary, from which the mutations of meshes start."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random
import struct

from mutate import NUMBERS

POINTS = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
NAMES = '$PhysicalNames\n3\n0 5 "corner"\n1 2 "left"\n2 1 "all"\n$EndPhysicalNames\n'

OLD = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    + NAMES
    + "$Nodes\n6\n"
    + "".join(f"{k} {x} {y} 0\n" for k, (x, y) in enumerate(POINTS, 1))
    + "$EndNodes\n$Elements\n5\n1 15 2 5 1 1\n2 1 2 2 1 4 1\n3 3 2 1 1 1 2 5 4\n"
    "4 2 2 1 1 2 3 6\n5 2 2 1 1 2 6 5\n$EndElements\n"
).encode()

NEW = (
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    + NAMES
    + """$Entities
1 1 1 0
1 0 0 0 1 5
1 0 0 0 0 1 0 1 2 2 1 -1
1 0 0 0 2 1 0 1 1 1 1
$EndEntities
$Nodes
1 6 1 6
2 1 0 6
"""
    + "".join(f"{k}\n" for k in range(1, 7))
    + "".join(f"{x} {y} 0\n" for x, y in POINTS)
    + """$EndNodes
$Elements
4 5 1 5
0 1 15 1
1 1
1 1 1 1
2 4 1
2 1 3 1
3 1 2 5 4
2 1 2 2
4 2 3 6
5 2 6 5
$EndElements
"""
).encode()


def _binary_old() -> bytes:
    one = struct.pack("<i", 1)
    nodes = b"".join(struct.pack("<iddd", k, x, y, 0) for k, (x, y) in enumerate(POINTS, 1))
    cells = struct.pack("<iii", 3, 1, 2) + struct.pack("<7i", 1, 1, 1, 1, 2, 5, 4)
    cells += struct.pack("<iii", 2, 2, 2)
    cells += struct.pack("<6i", 2, 1, 1, 2, 3, 6) + struct.pack("<6i", 3, 1, 1, 2, 6, 5)
    return (
        b"$MeshFormat\n2.2 1 8\n"
        + one
        + b"\n$EndMeshFormat\n"
        + NAMES.encode()
        + b"$Nodes\n6\n"
        + nodes
        + b"\n$EndNodes\n$Elements\n3\n"
        + cells
        + b"\n$EndElements\n"
    )


def _binary_new() -> bytes:
    one = struct.pack("<i", 1)
    entities = struct.pack("<4Q", 0, 0, 1, 0)
    entities += struct.pack("<i6d", 1, 0, 0, 0, 2, 1, 0) + struct.pack("<QiQ", 1, 1, 0)
    nodes = struct.pack("<4Q", 1, 6, 1, 6) + struct.pack("<iiiQ", 2, 1, 0, 6)
    nodes += struct.pack("<6Q", *range(1, 7))
    nodes += b"".join(struct.pack("<3d", x, y, 0) for x, y in POINTS)
    cells = struct.pack("<4Q", 1, 2, 1, 2) + struct.pack("<iiiQ", 2, 1, 3, 2)
    cells += struct.pack("<5Q", 1, 1, 2, 5, 4) + struct.pack("<5Q", 2, 2, 3, 6, 5)
    return (
        b"$MeshFormat\n4.1 1 8\n"
        + one
        + b"\n$EndMeshFormat\n"
        + NAMES.encode()
        + b"$Entities\n"
        + entities
        + b"\n$EndEntities\n$Nodes\n"
        + nodes
        + b"\n$EndNodes\n$Elements\n"
        + cells
        + b"\n$EndElements\n"
    )


SEEDS = (OLD, NEW, _binary_old(), _binary_new())


def mutate(raw: bytes, rng: random.Random) -> bytes:
    """One to four mutations: numbers, lines, bytes, counts that promise too much."""
    for _ in range(rng.choice((1, 1, 2, 3, 4))):
        raw = rng.choice((_number, _number, _line, _flip, _cut, _insert, _word))(raw, rng)
    return raw


def _number(raw: bytes, rng: random.Random) -> bytes:
    words = raw.split(b" ")
    at = rng.randrange(len(words))
    tail = words[at].partition(b"\n")
    words[at] = rng.choice(NUMBERS).encode() + tail[1] + tail[2]
    return b" ".join(words)


def _line(raw: bytes, rng: random.Random) -> bytes:
    lines = raw.split(b"\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    if rng.random() < 0.4:
        del lines[a]
    elif rng.random() < 0.5:
        lines.insert(b, lines[a])
    else:
        lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def _flip(raw: bytes, rng: random.Random) -> bytes:
    data = bytearray(raw)
    for _ in range(rng.randint(1, 4)):
        if data:
            data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def _cut(raw: bytes, rng: random.Random) -> bytes:
    return raw[: rng.randrange(len(raw) + 1)] if rng.random() < 0.5 else raw


def _insert(raw: bytes, rng: random.Random) -> bytes:
    at = rng.randrange(len(raw) + 1)
    return raw[:at] + rng.randbytes(rng.randint(1, 16)) + raw[at:]


def _word(raw: bytes, rng: random.Random) -> bytes:
    """Replace four or eight bytes by a large count."""
    at = rng.randrange(len(raw) + 1)
    size = rng.choice((4, 8))
    value = rng.choice((0, 1, 2**31 - 1, -1, 2**30, 255))
    return raw[:at] + struct.pack("<i" if size == 4 else "<q", value) + raw[at + size :]

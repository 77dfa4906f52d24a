"""Files of contact that a card passes on its way to the first correction, and the ways back.

``python scripts/contact_walk.py [--list]`` follows the calls of two squares with friction, from the
function that reads ``*CONTACT PAIR`` to the first solution with multipliers. A file of contact has
it in its path, or stands between it and the matrix; a return is a call into a file that was passed
before. ``scripts/measures.py`` runs it on a tree.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from types import FrameType
from typing import Any

import corota as ct

DECK = """*NODE
1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 0, 1\n6, 1, 1\n7, 1, 2\n8, 0, 2
*ELEMENT, TYPE=CPE4, ELSET=LOW
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPE4, ELSET=UP
2, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=LOW, MATERIAL=M
*SOLID SECTION, ELSET=UP, MATERIAL=M
*SURFACE, NAME=TOP
LOW, S3
*SURFACE, NAME=DIE
UP, S1
*SURFACE INTERACTION, NAME=DRY
*FRICTION
.3
*CONTACT PAIR, INTERACTION=DRY
TOP, DIE
*BOUNDARY
1, 1, 2\n2, 1, 2
*STEP
*STATIC
*BOUNDARY
7, 1, 1, .001\n8, 1, 1, .001\n7, 2, 2, -.01\n8, 2, 2, -.01
*END STEP
"""
FIRST, LAST = ("contact_pair", "cards/contact.py"), ("solve", "linear/saddle_point.py")
#: Parts of the paths of files of contact.
OF_CONTACT = ("contact", "linear/saddle_point", "linear/coupling")


def walk(deck: Path) -> list[tuple[str, str]]:
    """Calls from the card to the first correction: file and function."""
    root = Path(ct.__file__).parent
    calls: list[tuple[str, str]] = []

    def follow(frame: FrameType, event: str, _: Any) -> None:
        path = Path(frame.f_code.co_filename)
        if not path.is_relative_to(root):
            return
        file, function = path.relative_to(root).as_posix(), frame.f_code.co_name
        if event == "call" and (calls or (function == FIRST[0] and file.endswith(FIRST[1]))):
            calls.append((file, function))
        elif event == "return" and calls and function == LAST[0] and file.endswith(LAST[1]):
            sys.setprofile(None)

    ct.solve(ct.read(deck), threads=1)  # modules that are loaded lazily are loaded
    sys.setprofile(follow)
    ct.solve(ct.read(deck), threads=1)
    sys.setprofile(None)
    return [call for call in calls if any(part in call[0] for part in OF_CONTACT)]


def stops(calls: list[tuple[str, str]]) -> list[tuple[str, list[str]]]:
    """Calls that follow each other in one file, together."""
    found: list[tuple[str, list[str]]] = []
    for file, function in calls:
        if not found or found[-1][0] != file:
            found.append((file, []))
        found[-1][1].append(function)
    return found


def main() -> None:
    """Print the number of files and of returns, or the whole way."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "squares.inp"
        deck.write_text(DECK)
        way = stops(walk(deck))
    files = {file for file, _ in way}
    if "--list" in sys.argv:
        sys.stdout.write("".join(f"{file}: {' '.join(names)}\n" for file, names in way))
    sys.stdout.write(f"{len(files)} files, {len(way) - len(files)} returns\n")


if __name__ == "__main__":
    main()

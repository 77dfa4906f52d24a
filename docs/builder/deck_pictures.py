"""Pictures of the models of the decks that the pages of keywords show."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import tempfile
from pathlib import Path

import corota as ct

#: The laws of a library, which nobody has compiled where pages are built.
LIBRARY = re.compile(r"^\*USER MATERIAL.*?(?=^\*SOLID)", re.MULTILINE | re.DOTALL)
#: Colors of a picture, and its dots per inch.
COLORS, DPI = 48, 90


def draw(deck: Path, picture: Path) -> None:
    """Draw the model of a deck: sections, sets, supports and loads of the last step."""
    from matplotlib import pyplot
    from PIL import Image

    text = LIBRARY.sub("*ELASTIC\n1.\n", deck.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / deck.name
        copy.write_text(text, encoding="utf-8")
        figure = ct.read(copy).plot(title="")
    figure.savefig(picture, dpi=DPI)
    pyplot.close(figure)
    with Image.open(picture) as image:
        image.convert("RGB").quantize(COLORS).save(picture, optimize=True)


def write(decks: Path, folder: Path) -> None:
    """Draw each deck that is newer than its picture."""
    for deck in sorted(decks.glob("*.inp")):
        picture = folder / f"deck-{deck.stem}.png"
        if not picture.exists() or picture.stat().st_mtime < deck.stat().st_mtime:
            draw(deck, picture)

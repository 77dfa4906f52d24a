"""Pictures of the how-to pages: those that the program of the page writes.

``python docs/builder/page_pictures.py NAME ...`` runs the Python of ``docs/howto/NAME.md`` and
keeps its pictures as ``docs/images/howto/NAME-PICTURE.png``, with few colors.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import re
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
FOLDER = DOCS / "images" / "howto"
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Colors of a picture, and its largest width [pixels].
COLORS, WIDTH = 160, 900


def draw(name: str) -> list[Path]:
    """Run the program of a page in a folder of its own, and keep its pictures."""
    from PIL import Image

    page = DOCS / "howto" / f"{name}.md"
    program = "\n".join(BLOCK.findall(page.read_text(encoding="utf-8")))
    before, found = Path.cwd(), []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            exec(compile(program, str(page), "exec"), {"__name__": name})
        finally:
            os.chdir(before)
        for picture in sorted(Path(folder).glob("*.png")):
            with Image.open(picture) as image:
                image.thumbnail((WIDTH, WIDTH))
                target = FOLDER / f"{name}-{picture.name}"
                image.convert("RGB").quantize(COLORS).save(target, optimize=True)
                found.append(target)
    return found


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for page in sys.argv[1:]:
        print(*draw(page))

"""One page per keyword: syntax, parameters, what differs, figure, and a deck that runs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

from corota.io.deck.keywords import KEYWORDS

ROW = re.compile(r"^\| (`\*[^|]*?) \| ((?:[^|]|\\\|)*?) ?\| ((?:[^|]|\\\|)*?) ?\|$", re.MULTILINE)
NOTE = re.compile(r"^## ([A-Z -]+)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
PLACE = {"model": "before the first step", "step": "in a step", "any": "anywhere"}
#: Figures of keywords.
FIGURES = {
    "ELEMENT": [
        ("element_q4", "Nodes and faces of a quadrilateral"),
        ("element_t6", "and of a quadratic triangle"),
    ],
    "SURFACE": [
        ("faces", "Faces of elements"),
        ("rigid_sides", "Outward normal of rigid profiles"),
    ],
    "DLOAD": [("faces", "Faces of elements and pressures on them")],
    "DSLOAD": [("faces", "Faces of elements and pressures on them")],
    "RIGIDBODY": [("rigid_sides", "Outward normal of rigid profiles")],
}
#: Parameters that mean the same on every card which takes them.
COMMON = {
    "INTERNAL": "`INTERNAL`, which CAE writes, has no effect.",
    "UNSORTED": "`UNSORTED` has no effect: the order is always kept.",
    "OFFSET1": "`OFFSET1` and `OFFSET2` must be zero.",
    "VALUE": "Of `VALUE` only `RELATIVE` is taken.",
    "FREQUENCYF": "`FREQUENCYF` means the same as `FREQUENCY`.",
    "LOADCASE": "`LOAD CASE=2`, in `*STEADY STATE DYNAMICS` only: the load acts a quarter of a "
    "period ahead.",
}
#: More to read by keyword.
SEE_ALSO = {
    "ELEMENT": "[All elements, a page each](../elements/index.md).",
    "SOLIDSECTION": "[Which local strain?](../../decisions.md#which-local-strain)",
    "STATIC": "[Which step?](../../decisions.md#which-step)",
    "DYNAMIC": "[Which step?](../../decisions.md#which-step)",
}


def rows(docs: Path) -> dict[str, list[tuple[str, str, str]]]:
    """Rows of the page of keywords by keyword: name, parameters, remarks."""
    text = (docs / "keywords.md").read_text(encoding="utf-8")
    found: dict[str, list[tuple[str, str, str]]] = {}
    for names, parameters, remarks in ROW.findall(text):
        for name in re.findall(r"\*([A-Z][A-Z -]*[A-Z])", names):
            up = [re.sub(r"\]\(([a-z_/-]+\.md)", r"](../../\1", t) for t in (parameters, remarks)]
            found.setdefault(name.replace(" ", ""), []).append((name, *up))
    return found


def notes(docs: Path) -> dict[str, tuple[str, str, str]]:
    """Name, blocks of syntax and difference of each keyword."""
    text = (docs / "decks" / "syntax.md").read_text(encoding="utf-8")
    found = {}
    for name, body in NOTE.findall(text):
        cut = body.rindex("```") + 3
        rest = body[cut:].strip().replace("](../", "](../../")
        found[name.replace(" ", "")] = (name, body[:cut].strip(), rest)
    return found


def deck_of(name: str, decks: dict[str, str]) -> tuple[str, str, list[int]] | None:
    """File, text and lines of the card in the shortest deck that holds the keyword."""
    pattern = re.compile(rf"\*{name}\s*(,|$)")
    found = [
        (text, file, [i for i, line in enumerate(text.splitlines(), 1) if pattern.match(line)])
        for file, text in decks.items()
    ]
    fit = sorted((len(text), file, text, lines) for text, file, lines in found if lines)
    return (fit[0][1], fit[0][2], fit[0][3]) if fit else None


def page(key: str, docs: Path) -> str:
    """Text of the page of a keyword, from the facts of the reader and the documents."""
    known = KEYWORDS[key]
    name, syntax, difference = notes(docs)[key]
    lines = [f"# *{name}", "", f"Stands {PLACE[known.place]}.", "", "## Syntax", "", syntax, ""]
    for _, parameters, remarks in rows(docs).get(key, []):
        lines += [f"**Parameters**: {parameters or 'none'}", ""]
        if remarks:
            lines += [f"**Data lines**: {remarks}.", ""]
    same = [words for key_, words in COMMON.items() if key_ in known.parameters.split()]
    if same:
        lines += [" ".join(same), ""]
    if known.ignored:
        words = ", ".join(f"`{word}`" for word in known.ignored.split())
        lines += [
            f"Accepted without effect, each with a note: {words} (written without blanks).",
            "",
        ]
    for figure, words in FIGURES.get(key, []):
        lines += [f"![{words}](../../figures/{figure}.svg)", ""]
    lines += ["## What differs from CalculiX and Abaqus", "", difference, ""]
    lines += [
        "See also [the rules of all decks](../../keywords.md#rules).",
        SEE_ALSO.get(key, ""),
        "",
    ]
    decks = {p.name: p.read_text(encoding="utf-8") for p in sorted((docs / "decks").glob("*.inp"))}
    deck = deck_of(name, decks)
    if deck:
        file, text, marked = deck
        library = " --allow-library law.so" if "*USER MATERIAL" in text else ""
        lines += [
            "## A deck that runs",
            "",
            f"`corota run {file}{library}`",
            "",
            "```{code-block} text",
        ]
        lines += [f":emphasize-lines: {','.join(map(str, marked))}", "", text.rstrip(), "```", ""]
        lines += [f"![Model of {file}](../static/deck-{Path(file).stem}.png)", ""]
    return "\n".join(lines)


def pages(docs: Path) -> dict[str, str]:
    """Text of every page of keywords, and of their index, by file name."""
    found = {f"{key.lower()}.md": page(key, docs) for key in KEYWORDS}
    toc = "\n".join(sorted(key.lower() for key in KEYWORDS))
    found["index.md"] = (
        "# Keywords, a page each\n\nThe [rules of all decks](../../keywords.md) have one page.\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{toc}\n```\n"
    )
    return found

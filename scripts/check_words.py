"""Refuse retired words: identifiers of Python and Rust, and phrases of documents and messages.

`docs/glossary.md` has the words to use instead.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import io
import re
import subprocess
import sys
import tokenize
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: Retired identifier: the word to use.
IDENTIFIERS = {
    "Touching": "ContactTerm",
    "Touch": "ContactState",
    "Touched": "ContactEvaluation",
    "TouchingSystem": "ContactEquations",
    "touched": "contact_evaluation",
    "touching": "closed, a state of contact",
    "go_round": "predict_through_events",
    "lack": "complementarity or energy_error",
    "Asked": "RightHandSides",
    "Bordered": "SaddlePointSystem",
    "turning": "nlgeom",
    "Ties": "Constraints",
    "du_held": "du_prescribed",
    "room": "borrow_tangent",
    "judge": "residual_norms",
    "Judgement": "ResidualNorms",
    "Given": "Tabulated",
    "Race": "ThreadAutotuner",
    "TwinFile": "AtomicFile",
    "Silent": "BaseObserver",
    "NOTHING": "the quantity",
    "MORE": "the quantity",
    "RETURNS": "the quantity",
    "HOPELESS": "the quantity",
    "ALIKE": "the quantity",
    "SHARP": "the quantity",
    "ASIDE": "the quantity",
    "ENOUGH": "the quantity",
    "COMPANIONS": "LINE_ELEMENTS",
    "heft": "inertial_stiffness",
    "honest": "combined residuals",
    "senseless": "implausible_displacement",
    "told": "the quantity, or reported",
    "book": "energy_balance",
}
#: Retired phrase of documents and messages: what to write.
PHRASES = {
    r"held by nothing": "unconstrained",
    r"\bcompanions?\b": "line element",
    r"laws of yours": "user-defined materials",
    r"at rest and in motion": "static and dynamic",
    r"skipped in silence": "silently ignored",
    r"passed over": "ignored",
    r"cells a side": "elements per side",
    r"lacking energy|energy lacking|balance lacks": "energy-balance error",
    r"conditions lack|lack of the contact": "contact residual",
    r"\btouching (?:state|node|area)|taken as touching|counts? as touching": "in contact",
    r"\bhopeless\b": "given up",
    r"is no number\b": "is not a number",
    r"energy account": "energy balance",
    r"nothing holds\b": "unconstrained",
    r"goe?s? round in (?:a circle|circles)": "cycles",
    r"no place in a checkpoint": "cannot be stored in a checkpoint",
    r"disk refuses": "writing fails",
}
#: Retired phrase of the Python sources and of the pages of the site.
SOURCES = {
    r"\banew\b": "again",
    r"\bask(?:s|ed)? for\b": "request",
    r"\black(?:s|ed|ing)?\b": "without, missing",
    r"turn(?:s|ed)? inside out": "inverted",
    r"\bto and fro\b": "alternating, cycling",
    r"\blooked (?:for|at)\b": "searched, checked",
    r"\bknows (?:no|nothing|only)\b": "has no, has only",
}
#: Retired phrase of the pages of the site.
PAGES = {
    r"turning frame": "co-rotational frame",
    r"\bper cent\b": "percent",
}


def python_faults(text: str) -> list[tuple[int, str]]:
    """Retired identifiers of Python code by line."""
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    found = [
        (t.start[0], f"'{t.string}' is retired: {IDENTIFIERS[t.string]}")
        for t in tokens
        if t.type == tokenize.NAME and t.string in IDENTIFIERS
    ]
    # Parameters and types of docstrings: "name, name : type".
    for number, line in enumerate(text.splitlines(), 1):
        if re.match(r"\s+\w+(, \w+)* : \w", line):
            found += [
                (number, f"'{word}' is retired: {IDENTIFIERS[word]}")
                for word in re.findall(r"\w+", line)
                if word in IDENTIFIERS
            ]
    return found


def rust_faults(text: str) -> list[tuple[int, str]]:
    """Retired identifiers of Rust code by line; comments and strings may use English words."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        code = re.sub(r'"(\\.|[^"\\])*"', "", line.split("//", 1)[0])
        for word in re.findall(r"[A-Za-z_]\w*", code):
            if word in IDENTIFIERS:
                found.append((number, f"'{word}' is retired: {IDENTIFIERS[word]}"))
    return found


def phrase_faults(text: str, phrases: dict[str, str] = PHRASES) -> list[tuple[int, str]]:
    """Retired phrases by line."""
    return [
        (number, f"'{match.group(0)}' is retired: {better}")
        for number, line in enumerate(text.splitlines(), 1)
        for pattern, better in phrases.items()
        if (match := re.search(pattern, line, re.IGNORECASE))
    ]


def faults(path: Path) -> list[tuple[int, str]]:
    """List the retired words of one file.

    Parameters
    ----------
    path : Path
        Relative to the root.
    """
    text = (ROOT / path).read_text(encoding="utf-8")
    if path.suffix == ".py":
        found = python_faults(text)
        return found + (phrase_faults(text, PHRASES | SOURCES) if path.parts[0] == "src" else [])
    if path.suffix == ".rs":
        return rust_faults(text) + phrase_faults(text)
    found = phrase_faults(text)
    by_hand = path.parts[0] in ("README.md", "docs") and "verification" not in path.parts
    return found + (phrase_faults(text, PAGES | SOURCES) if by_hand else [])


def main() -> int:
    """Print the faults; 1 if there are any."""
    listing = subprocess.run(
        ["git", "ls-files", "*.py", "*.rs", "*.md"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    ).stdout.split()
    paths = [Path(name) for name in listing]
    skipped = {Path("scripts/check_words.py"), Path("docs/glossary.md"), Path("CHANGELOG.md")}
    lines = [
        f"{path}:{number}: {what}"
        for path in paths
        if path not in skipped and (ROOT / path).is_file()
        for number, what in faults(path)
    ]
    print("\n".join(lines) if lines else "words: none is retired")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())

"""Measures of the equation and of contact: ``python scripts/measures.py [TREE]`` prints them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

from house_facts import ROOT, circles, imports, lines_with, size, sources

CONTACT = "analysis/terms/contact/"
#: A constant of a module.
CONSTANT = r"^_?[A-Z][A-Z0-9_]*(, [A-Z][A-Z0-9_]*)*(: [^=]+)? = "
#: The contact term of a system, by its class or by the attribute that it once was.
TERM = r"\b(contact_term|ContactTerm)\b"
#: Beginning of an import from the folder of contact, for types as well.
IMPORT = "from corota.analysis.terms.contact"
#: A drawer of the evaluation.
DRAWER = r"^    [a-z]\w*: "


def constants(tree: Path) -> list[tuple[str, str]]:
    """Constants of modules of contact, (file, name); a tuple that is assigned has each."""
    return [
        (path.removeprefix(CONTACT), name.strip())
        for path, text in sources(tree)
        for line in text.splitlines()
        if path.startswith(CONTACT) and re.match(CONSTANT, line) and "__all__" not in line
        for name in line.split("=")[0].split(":")[0].split(",")
    ]


def evaluations(tree: Path) -> int:
    """Classes of `analysis` that evaluate the equation at unknowns and a step time."""
    found = 0
    for path, text in sources(tree):
        for node in ast.walk(ast.parse(text)) if path.startswith("analysis/") else ():
            if not isinstance(node, ast.ClassDef) or "Protocol" in ast.dump(ast.List(node.bases)):
                continue
            methods = [m for m in node.body if isinstance(m, ast.FunctionDef)]
            named = [m for m in methods if m.name == "evaluate"]
            found += sum([a.arg for a in m.args.args][2:3] == ["step_time"] for m in named)
    return found


@cache
def walk(tree: Path) -> list[int]:
    """Files of contact that a card passes to the first correction, and returns to them."""
    paths = os.pathsep.join((str(tree / "src"), str(tree)))
    command = [sys.executable, str(ROOT / "scripts/contact_walk.py")]
    run = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True, check=True
    )
    return [int(number) for number in re.findall(r"\d+", run.stdout)]


MEASURES: dict[str, Callable[[Path], int]] = {
    "files of contact": lambda t: sum(p.startswith(CONTACT) for p, _ in sources(t)),
    "lines of contact": lambda t: size(t, CONTACT),
    "constants of contact": lambda t: len(constants(t)),
    "files that know the contact term": lambda t: sum(
        bool(re.search(TERM, text)) for _, text in sources(t)
    ),
    "of these outside its folder": lambda t: sum(
        bool(re.search(TERM, text)) for p, text in sources(t) if not p.startswith(CONTACT)
    ),
    "files outside that import from its folder": lambda t: sum(
        IMPORT in text for p, text in sources(t) if not p.startswith(CONTACT)
    ),
    "lines of analysis": lambda t: size(t, "analysis/"),
    "lines with Any in analysis": lambda t: lines_with(t, r"\bAny\b", r"^(?!analysis/)"),
    "definitions of evaluate of the equation": evaluations,
    "fields of an evaluation": lambda t: sum(
        bool(re.match(DRAWER, line))
        for path, text in sources(t)
        for line in text.splitlines()
        if path == "analysis/evaluation.py"
    ),
    "files that a contact card passes to the first correction": lambda t: walk(t)[0],
    "returns to them on that way": lambda t: walk(t)[1],
    "modules in import circles": lambda t: sum(len(g) for g in circles(imports(t))),
}


def main() -> None:
    """Print the measures of a tree."""
    tree = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT
    for name, measure in MEASURES.items():
        sys.stdout.write(f"{measure(tree):7d}  {name}\n")


if __name__ == "__main__":
    main()

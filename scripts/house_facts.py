"""Facts about the structure of the code that a search finds; ``house_facts.py OLD NEW`` compares.

Each argument is a source tree; without any it is this one. The table of docs/design.md is written
by ``python scripts/house_facts.py OLD . --write``, with OLD the tree to compare with.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- facts: begin -->", "<!-- facts: end -->"
#: Folders whose imports are looked at for circles by themselves.
PARTS = ("analysis", "io/deck", "model", "results")


def sources(tree: Path) -> Iterator[tuple[str, str]]:
    """Python files of the package: path in it, and text."""
    home = tree / "src" / "corota"
    for path in sorted(home.rglob("*.py")):
        yield path.relative_to(home).as_posix(), path.read_text(encoding="utf-8")


def lines_with(tree: Path, pattern: str, but: str = "") -> int:
    """Lines that match a pattern in files whose paths do not match another."""
    found, skip = re.compile(pattern), re.compile(but) if but else None
    return sum(
        bool(found.search(line))
        for path, text in sources(tree)
        if not (skip and skip.search(path))
        for line in text.splitlines()
    )


def imports(tree: Path) -> dict[str, set[str]]:
    """Modules that each module imports: for types, within functions and from packages as well.

    The root package names what users see; its names load at their first use.
    """
    texts = {"corota." + p.removesuffix(".py").replace("/", "."): t for p, t in sources(tree)}
    texts = {name.removesuffix(".__init__"): text for name, text in texts.items()}
    graph: dict[str, set[str]] = {name: set() for name in texts if name != "corota"}
    for name in graph:
        for node in ast.walk(ast.parse(texts[name])):
            if isinstance(node, ast.ImportFrom) and node.module:
                for item in node.names:
                    inner = f"{node.module}.{item.name}"
                    target = inner if inner in graph else node.module
                    if target in graph and target != name:
                        graph[name].add(target)
            elif isinstance(node, ast.Import):
                graph[name] |= {a.name for a in node.names if a.name in graph} - {name}
    return graph


def exceptions(tree: Path) -> int:
    """Imports that the order of the layers leaves out."""
    text = (tree / "pyproject.toml").read_text(encoding="utf-8")
    return len(re.findall(r'"corota[\w.*]* -> corota[\w.*]*"', text))


def circles(graph: dict[str, set[str]]) -> list[set[str]]:
    """Groups of modules that import each other in a circle (Tarjan 1972)."""
    number: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[set[str]] = []

    def visit(name: str) -> None:
        number[name] = low[name] = len(number)
        stack.append(name)
        for other in sorted(graph[name]):
            if other not in number:
                visit(other)
                low[name] = min(low[name], low[other])
            elif other in stack:
                low[name] = min(low[name], number[other])
        if low[name] == number[name]:
            group = set(stack[stack.index(name) :])
            del stack[stack.index(name) :]
            if len(group) > 1:
                found.append(group)

    sys.setrecursionlimit(10_000)
    for name in sorted(graph):
        if name not in number:
            visit(name)
    return found


def in_circles(tree: Path, part: str = "") -> int:
    """Modules of a part of the package that take part in circles within it."""
    start = "corota." + part.replace("/", ".")
    graph = imports(tree)
    graph = {k: {m for m in v if m.startswith(start)} for k, v in graph.items()}
    return sum(len(g) for g in circles({k: v for k, v in graph.items() if k.startswith(start)}))


#: Start of a line with a condition.
CONDITION = r"\b(if|elif|while|assert|and|or|not)\b.*"
#: Names of elements, as a user writes them.
ELEMENT_NAME = re.compile(r"(Q[489][A-Z]*|T[36]|OPT|SPRING\w*|BEAM|TRUSS)")


def names_in_conditions(tree: Path, name: re.Pattern[str]) -> int:
    """Comparisons with such a name, or with a tuple of them, outside decks."""
    found = 0
    for path, text in sources(tree):
        if path.startswith("io/"):
            continue
        for node in ast.walk(ast.parse(text)):
            parts = node.comparators if isinstance(node, ast.Compare) else []
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "startswith":
                parts = node.args
            every = [c for part in parts for c in ast.walk(part) if isinstance(c, ast.Constant)]
            found += any(isinstance(c.value, str) and name.fullmatch(c.value) for c in every)
    return found


def size(tree: Path, pattern: str) -> int:
    """Lines of the files of the package whose paths match a pattern."""
    return sum(len(t.splitlines()) for p, t in sources(tree) if re.match(pattern, p))


def rust_lines_with(tree: Path, pattern: str) -> int:
    """Lines of Rust that match a pattern."""
    texts = (p.read_text(encoding="utf-8") for p in (tree / "rust" / "src").rglob("*.rs"))
    return sum(bool(re.search(pattern, line)) for t in texts for line in t.splitlines())


def rust_folders(tree: Path) -> dict[str, set[str]]:
    """Folders of the core that each folder imports from, tests left out."""
    home = tree / "rust" / "src"
    graph: dict[str, set[str]] = {p.name: set() for p in home.iterdir() if p.is_dir()}
    for name, found in graph.items():
        for path in (home / name).rglob("*.rs"):
            if "test" in path.relative_to(home).as_posix():
                continue
            text = path.read_text(encoding="utf-8").partition("#[cfg(test)]")[0]
            text = re.sub(r"//.*", "", text)
            for one, group in re.findall(r"crate::(?:(\w+)|\{([^}]*)\})", text):
                found |= {one, *re.findall(r"\w+", group)} & graph.keys() - {name}
    return graph


#: Facts by their names.
FACTS: dict[str, Callable[[Path], int]] = {
    "reads of `indptr` outside `analysis/linear`": lambda t: lines_with(
        t, r"indptr", r"^analysis/linear/"
    ),
    "`constraints` or `link` `is (not) None` outside `analysis/constraints`": lambda t: lines_with(
        t, r"\b(constraints|link) is (not )?None", r"^analysis/constraints/"
    ),
    "contact `is (not) None` outside its own files": lambda t: lines_with(
        t,
        r"\b(contact_term|touching) is (not )?None",
        r"^analysis/terms/contact/|^drivers/touching_",
    ),
    "`contact_term.joins`, `.pairs` or `.opens` outside `terms/contact`": lambda t: lines_with(
        t, r"contact_term\.(joins|acts|pairs|opens)", r"^analysis/terms/contact/"
    ),
    "`contact_term.n` or `.damped` in conditions outside `terms/contact`": lambda t: lines_with(
        t, rf"{CONDITION}\bcontact_term\.(n|damped)\b", r"^analysis/terms/contact/"
    ),
    "`couples` or `dependent` in conditions outside `analysis/constraints`": lambda t: lines_with(
        t, rf"{CONDITION}\b(link|constraints)\.(couples|dependent)\b", r"^analysis/constraints/"
    ),
    "element names in conditions": lambda t: names_in_conditions(t, ELEMENT_NAME),
    "law names in conditions": lambda t: lines_with(t, r"law (==|!=) \"", r"^io/deck/"),
    "`# fmt: skip`": lambda t: lines_with(t, r"# fmt: skip"),
    "modules in import circles, whole package": lambda t: in_circles(t),
    **{
        f"modules in import circles, {part}": lambda t, part=part: in_circles(t, part)
        for part in PARTS
    },
    "exceptions from the order of layers": exceptions,
    "folders of Rust in import circles": lambda t: sum(len(g) for g in circles(rust_folders(t))),
    "names of contact discretizations matched in Rust": lambda t: rust_lines_with(
        t, r"Method::(Mortar|NodeToSegment)"
    ),
    "lines of `analysis` (`drivers` in the first version)": lambda t: size(
        t, r"(analysis|drivers)/"
    ),
    "of these contact": lambda t: size(t, r"analysis/terms/contact/|drivers/touching_"),
    "files of more than 600 lines": lambda t: sum(
        len(text.splitlines()) > 600 for _, text in sources(t)
    ),
    'texts "no ... set named"': lambda t: lines_with(
        t, r"no (node|element|edge|cell)?.?set named|no set named"
    ),
}


def table(trees: list[Path]) -> str:
    """Markdown table of the facts of one tree or two."""
    rows = ["| fact | " + " | ".join(["before", "now"][-len(trees) :]) + " |"]
    rows.append("| --- |" + " --: |" * len(trees))
    for name, count in FACTS.items():
        rows.append(f"| {name} | " + " | ".join(str(count(t)) for t in trees) + " |")
    return "\n".join(rows) + "\n"


def main() -> int:
    """Print the table, or write it into docs/design.md."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("trees", nargs="*", type=Path, default=[ROOT], help="source trees")
    options.add_argument("--write", action="store_true", help="put the table into docs/design.md")
    options.add_argument("--circles", action="store_true", help="name the modules in circles")
    chosen = options.parse_args()
    if chosen.circles:
        for part in ("", *PARTS):
            start = "corota." + part.replace("/", ".")
            graph = imports(chosen.trees[-1])
            inner = {k: {m for m in v if m.startswith(start)} for k, v in graph.items()}
            for group in circles({k: v for k, v in inner.items() if k.startswith(start)}):
                sys.stdout.write(f"{part or 'corota'}: {', '.join(sorted(group))}\n")
        return 0
    text = table(chosen.trees)
    if not chosen.write:
        sys.stdout.write(text)
        return 0
    page = ROOT / "docs" / "design.md"
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    page.write_text(f"{before}{BEGIN}\n{text}{END}{rest.split(END)[1]}", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())

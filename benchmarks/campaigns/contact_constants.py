"""What half and twice of each constant of the contact layer change.

``python -m benchmarks contact_constants --keep FILE`` runs the sample below with each constant that
``scripts/measures.py`` counts at half and at twice its value: endings that differ, the largest
relative difference of forces, displacements and momenta, iterations over those with the constant as
it is. A problem is run again only if it reads the constant. With an old FILE the run goes on where
it was stopped; ``--only NAME`` runs some; ``--write`` puts the table, with the comments above the
constants, into docs/contact-constants.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import ast
import importlib
import importlib.machinery
import importlib.util
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.common import machine, table, write_between

if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

    from benchmarks.corpora.contact_problems import Problem

    Row = dict[str, Any]

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "contact-constants.md"
COMMAND = "python -m benchmarks contact_constants"
FOLDER = "corota.analysis.terms.contact."
#: Numbers of problems of :mod:`contact_problems`, and what is changed in them. All nine
#: families; some choose states by pivoting, bring free bodies into contact, rest at kinks, pass
#: through surfaces, jump and relax.
SAMPLE: tuple[tuple[int, str], ...] = (
    *((number, "") for number in (378, 666, 864)),  # press
    *((number, "") for number in (1207, 100, 1405)),  # ring
    (1685, ""),  # belt
    *((number, "") for number in (741, 1533, 1956, 390)),  # wave
    *((number, "") for number in (265, 895, 256, 274)),  # clip
    *((number, "") for number in (986, 923)),  # seal
    *((number, "") for number in (474, 1995, 411)),  # indent
    *((number, "") for number in (1528, 1204, 1258)),  # stack
    *((number, "") for number in (1358, 1952, 494, 710)),  # drop
    (494, "explicit"),
    (1952, "explicit law"),
    (474, "law"),
    (411, "path"),
    (864, "stabilized"),
)
SIZE, LIMIT = 0.5, 30
FACTORS = (0.5, 2.0)


def counted() -> list[str]:
    """Module and name of each constant, as scripts/measures.py counts them."""
    sys.path.insert(0, str(ROOT / "scripts"))
    measures: Any = importlib.import_module("measures")
    return [f"{file.removesuffix('.py')}.{name}" for file, name in measures.constants(ROOT)]


# -- constants at other values ---------------------------------------------------------------


class Constants:
    """What modules of contact read in place of their constants: one of them may be scaled.

    Attributes
    ----------
    scaled : str
    factor : float
    read : set of str
        Constants that were read.
    """

    def __init__(self) -> None:
        self.scaled, self.factor = "", 1.0
        self.read: set[str] = set()

    def __call__(self, name: str, value: Any) -> Any:
        """The value that is read."""
        self.read.add(name)
        return _times(value, self.factor) if name == self.scaled else value


def _times(value: Any, factor: float) -> Any:
    """A number, or each of several; counts stay counts, of 1 at least."""
    if isinstance(value, tuple):
        return tuple(_times(v, factor) for v in value)
    return max(1, round(value * factor)) if isinstance(value, int) else value * factor


class _Loader(importlib.machinery.SourceFileLoader):
    """Loads a module of contact such that it reads its constants by :class:`Constants`."""

    def __init__(self, name: str, path: str, constants: Constants, names: set[str]) -> None:
        super().__init__(name, path)
        self.constants, self.names = constants, names

    def exec_module(self, module: ModuleType) -> None:
        """Run the code with calls in place of names that are read."""
        tree = ast.parse(Path(self.path).read_bytes())
        own = self.name.removeprefix(FOLDER)
        found = {name.split(".")[1]: name for name in self.names if name.startswith(f"{own}.")}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(FOLDER):
                names = {a.name: f"{node.module}.{a.name}".removeprefix(FOLDER) for a in node.names}
                found |= {name: long for name, long in names.items() if long in self.names}
        vars(module)["_constant"] = self.constants
        tree = ast.fix_missing_locations(_Calls(found).visit(tree))
        exec(compile(tree, self.path, "exec"), vars(module))


class _Calls(ast.NodeTransformer):
    def __init__(self, found: dict[str, str]) -> None:
        self.found = found

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id not in self.found or not isinstance(node.ctx, ast.Load):
            return node
        call = f"_constant({self.found[node.id]!r}, {node.id})"
        return ast.copy_location(ast.parse(call, mode="eval").body, node)


class _Finder:
    """Finds modules of contact for :class:`_Loader`."""

    def __init__(self, constants: Constants, names: set[str]) -> None:
        self.constants, self.names = constants, names

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if not fullname.startswith(FOLDER):
            return None
        spec = importlib.machinery.PathFinder.find_spec(fullname, path)
        assert spec is not None
        assert spec.origin is not None
        loader = _Loader(fullname, spec.origin, self.constants, self.names)
        return importlib.util.spec_from_file_location(fullname, spec.origin, loader=loader)


# -- runs ------------------------------------------------------------------------------------


def given(number: int, change: str) -> Problem:
    """A problem of the sample."""
    import corota as ct
    from benchmarks.corpora.contact_problems import problem

    found = problem(number, size=SIZE)
    steps: Any = found.steps
    if "law" in change:
        length = float(np.ptp(found.model.mesh.points))
        for pair in found.model.contacts:
            pair.law = ct.PressureLaw("linear", 1e3 * found.model.sections[0].material.E / length)
    if "stabilized" in change:
        for pair in found.model.contacts:
            pair.stabilize = True
    if "explicit" in change:
        steps = [ct.Dynamic(period=steps[0].period, scheme="central_difference")]
    if "path" in change:
        steps = [ct.Static(path=ct.ArcLength())]
    return replace(found, steps=steps, what=f"{found.what} {change}".strip())


def run(number: int, change: str) -> Row:
    """Outcome of a problem of the sample, with what it found."""
    from benchmarks.campaigns.contact_torture import outcome

    return outcome(given(number, change), LIMIT, answers=True)


def difference(one: Row, other: Row) -> float:
    """Largest relative difference of displacement, forces and momentum of two finished runs."""
    a, b = one["answer"], other["answer"]
    force = max(a["largest force"], 1e-300)
    parts = [
        (one["moved"], other["moved"], one["moved"]),
        (a["largest force"], b["largest force"], force),
        (a["end force"], b["end force"], force),
        (a.get("momentum", 0.0), b.get("momentum", 0.0), 1.0),
    ]
    return max(float(np.abs(np.subtract(x, y)).max()) / max(size, 1e-300) for x, y, size in parts)


def compared(before: dict[str, Row], after: dict[str, Row]) -> Row:
    """Endings that differ, difference of the answers and iterations of problems that ran again."""
    ends = [
        f"{key}: {row['end']}" for key, row in after.items() if row["end"] != before[key]["end"]
    ]
    both = [k for k, row in after.items() if row["end"] == before[k]["end"] == "done"]
    work = sum(before[k]["all iterations"] for k in both)
    return {
        "ends": ends,
        "difference": max((difference(before[k], after[k]) for k in both), default=0.0),
        "where": max(both, key=lambda k: difference(before[k], after[k]), default=""),
        "iterations": sum(after[k]["all iterations"] for k in both) / work if work else 1.0,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--only", nargs="*", help="constants, as module.NAME")
    parser.add_argument("--write", action="store_true", help=f"write the table into {PAGE.name}")
    args = parser.parse_args()
    names, constants = counted(), Constants()
    sys.meta_path.insert(0, _Finder(constants, set(names)))  # type: ignore[arg-type]
    kept: dict[str, Row] = {}
    if args.keep and args.keep.exists():
        kept = {r["name"]: r for r in map(json.loads, args.keep.read_text().splitlines())}
    before: dict[str, Row] = {}
    reads: dict[str, set[str]] = {}
    left = [name for name in args.only or names if name not in kept]
    for number, change in SAMPLE if left else ():
        key, constants.read = f"{number} {change}".strip(), set()
        before[key] = run(number, change)
        reads[key] = constants.read
    for name in left:
        users = [job for job in SAMPLE if name in reads[f"{job[0]} {job[1]}".strip()]]
        row: Row = {"name": name, "used": len(users)}
        for factor in FACTORS:
            constants.scaled, constants.factor = name, factor
            after = {f"{n} {change}".strip(): run(n, change) for n, change in users}
            row[f"times {factor:g}"] = compared(before, after)
        kept[name] = row
        if args.keep:
            with args.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
    chosen = [name for name in args.only or names if name in kept]
    text = lines(chosen, kept)
    sys.stdout.write(f"{text}\n")
    if args.write:
        write_between(PAGE, "constants", f"`{COMMAND} --write`, {machine()}\n\n{text}")
    return 0


def lines(names: list[str], kept: dict[str, Row]) -> str:
    """Table of constants: value, what each is, effect of half and of twice."""

    def effect(row: Row) -> str:
        ends = f"{len(row['ends'])} end otherwise; " if row["ends"] else ""
        work = f"{row['iterations']:.2f}"
        if not ends and row["difference"] == 0.0 and work == "1.00":
            return "none"
        return f"{ends}{row['difference']:.0e}, {work}"

    shown = []
    for name in names:
        module, own = name.split(".")
        value, comment = meaning(module, own)
        row = kept[name]
        both = [effect(row[f"times {factor:g}"]) if row["used"] else "-" for factor in FACTORS]
        shown.append([f"`{name}`", value, comment, str(row["used"]), *both])
    return table(["constant", "value", "what it is", "read by", "half", "twice"], shown)


def meaning(module: str, name: str) -> tuple[str, str]:
    """Value of a constant as it is written, and the comment above it."""
    home = ROOT / "src" / "corota" / Path(*FOLDER.split(".")[1:])
    text = (home / f"{module}.py").read_text(encoding="utf-8")
    node = next(node for node in ast.parse(text).body if name in assigned(node))
    assert isinstance(node, ast.Assign)
    target, value = node.targets[0], node.value
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        value = value.elts[[ast.unparse(t) for t in target.elts].index(name)]
    above: list[str] = []
    for line in reversed(text.splitlines()[: node.lineno - 1]):
        if not line.startswith("#:"):
            break
        above.insert(0, line.removeprefix("#:").strip())
    return ast.unparse(value), " ".join(above)


def assigned(node: ast.stmt) -> set[str]:
    """Names that a statement assigns."""
    if not isinstance(node, ast.Assign):
        return set()
    return {n.id for target in node.targets for n in ast.walk(target) if isinstance(n, ast.Name)}


if __name__ == "__main__":
    sys.exit(main())

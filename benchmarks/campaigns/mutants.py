"""Which small errors in the source the tests find, and which only slow or former tests find.

    python -m benchmarks mutants TEST ... [--before REVISION] [--number 200] [--seed 0]

Each mutant changes one operator, comparison, sign or number of a function that the tests call. It
runs in a fork, with only the tests that call this function, and is killed if one fails or does not
end. What survives meets the slow tests also, and those of REVISION: a mutant that only these
kill is what a reduction has lost. Tests that start processes see no mutant there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import ast
import gc
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "corota"
PARTS = ("analysis", "io", "mesh", "model", "results")
#: Seconds within which the tests of a mutant end, over the time they take without it.
PATIENCE, SLOWDOWN = 20.0, 5.0
#: What takes the place of an operator or a comparison.
OTHER = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.And: ast.Or,
    ast.Or: ast.And,
    ast.Lt: ast.Gt,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}


def mutated(node: ast.AST) -> ast.expr | None:
    """Return the expression that takes the place of `node`; None if it has no mutant."""
    if isinstance(node, (ast.BinOp, ast.BoolOp)) and type(node.op) in OTHER:
        changed = {**vars(node), "op": OTHER[type(node.op)]()}
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in OTHER:
        changed = {**vars(node), "ops": [OTHER[type(node.ops[0])](), *node.ops[1:]]}
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
        return node.operand
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        value = node.value + 1 if isinstance(node.value, int) else 2.0 * node.value or 1.0
        return ast.Constant(value)
    else:
        return None
    return type(node)(**changed)


def expressions(node: ast.AST) -> Iterator[ast.expr]:
    """Walk what a function evaluates: no functions within it, texts or annotations."""
    for name, child in ast.iter_fields(node):
        for part in child if isinstance(child, list) else [child]:
            inner = (ast.FunctionDef, ast.ClassDef, ast.Lambda, ast.JoinedStr)
            if isinstance(part, ast.AST) and not isinstance(part, inner) and name != "annotation":
                if isinstance(part, ast.expr):
                    yield part
                yield from expressions(part)


def mutants(path: Path, called: set[int]) -> Iterator[tuple[Path, int, int, str, str]]:
    """Give file, first line of the function, line of the mutant, old text and the new file."""
    text = path.read_bytes()
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    tree = ast.parse(text).body
    tree += [part for c in tree if isinstance(c, ast.ClassDef) for part in c.body]
    for function in tree:
        if not isinstance(function, ast.FunctionDef):
            continue
        first = min([function.lineno, *(d.lineno for d in function.decorator_list)])
        if first not in called:
            continue
        for node in expressions(ast.Module(function.body, [])):
            new = mutated(node)
            if new is None or node.end_lineno is None or node.end_col_offset is None:
                continue
            begin = starts[node.lineno - 1] + node.col_offset
            end = starts[node.end_lineno - 1] + node.end_col_offset
            changed = text[:begin] + f"({ast.unparse(new)})".encode() + text[end:]
            yield path, first, node.lineno, text[begin:end].decode(), changed.decode()


def codes(code: CodeType) -> Iterator[CodeType]:
    """Walk a code object and those within it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from codes(constant)


def put_in(path: Path, first: int, text: str) -> None:
    """Let the function of this file that begins in line `first` do what it does in `text`."""
    import_module(".".join(path.relative_to(SOURCE.parent).with_suffix("").parts))
    for new in codes(compile(text, str(path), "exec")):
        if new.co_firstlineno != first or new.co_name == "<module>":
            continue
        for thing in gc.get_objects():
            code = thing.__code__ if isinstance(thing, FunctionType) else None
            if code is not None and (code.co_filename, code.co_firstlineno, code.co_name) == (
                new.co_filename,
                first,
                new.co_name,
            ):
                thing.__code__ = new


def fork(work: Callable[[], bool], limit: float = 3600.0) -> bool:
    """Return whether `work` says yes, in a fork, in time."""
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            signal.alarm(round(limit))
            silent = os.open(os.devnull, os.O_WRONLY)
            os.dup2(silent, 1)
            os.dup2(silent, 2)
            code = 0 if work() else 1
        finally:
            os._exit(code)
    return os.waitpid(pid, 0)[1] == 0


class Loop:
    """Plugin of pytest that runs the collected tests once, and then mutant by mutant."""

    def __init__(self, number: int, seed: int) -> None:
        self.number, self.seed = number, seed

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Take the place of the loop over the tests."""
        with tempfile.TemporaryDirectory() as place:
            record = Path(place, "calls.json")
            if not fork(lambda: trace(session.items, record)):
                pytest.exit("the tests fail without a mutant", 1)
            seconds, calls = json.loads(record.read_text(encoding="utf-8"))
        users = defaultdict(list)
        for k, called in enumerate(calls):
            for path, line in called:
                users[Path(path), line].append(k)
        paths = sorted({p for p, _ in users if p.relative_to(SOURCE).parts[0] in PARTS})
        found = [m for p in paths for m in mutants(p, {line for q, line in users if q == p})]
        chosen = random.Random(self.seed).sample(found, min(self.number, len(found)))
        results: dict[str, int] = defaultdict(int)
        for path, first, line, old, text in chosen:
            result = "survives"
            for name in ("killed", "LOST"):
                tests = [
                    k
                    for k in sorted(users[path, first], key=seconds.__getitem__)
                    if is_kept(session.items[k]) == (name == "killed")
                ]
                given = [session.items[k] for k in tests]
                limit = PATIENCE + SLOWDOWN * sum(seconds[k] for k in tests)
                if tests and not fork(partial(passes, given, path, first, text), limit):
                    result = name
                    break
            results[result] += 1
            print(f"{result:9} {path.relative_to(SOURCE)}:{line} {old!r}", flush=True)
        print(f"{len(chosen)} of {len(found)} mutants:", dict(results))
        return True


def is_kept(item: pytest.Item) -> bool:
    """Whether a test is one of `make test` in this tree."""
    return item.path.is_relative_to(ROOT) and item.get_closest_marker("slow") is None


def passes(items: list[pytest.Item], *mutant: Any) -> bool:
    """Run tests with a mutant until one fails."""
    put_in(*mutant)
    for item, after in zip(items, [*items[1:], None], strict=True):
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
        if item.session.testsfailed:
            return False
    return True


def trace(items: list[pytest.Item], record: Path) -> bool:
    """Run all tests and write their seconds and the functions of the package that they call."""
    seconds, calls = [], []
    for item, after in zip(items, [*items[1:], None], strict=True):
        seen: set[CodeType] = set()

        def note(frame: FrameType, event: str, _: object, seen: set[CodeType] = seen) -> None:
            if event == "call":
                seen.add(frame.f_code)

        begin = time.perf_counter()
        sys.setprofile(note)
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
        sys.setprofile(None)
        seconds.append(time.perf_counter() - begin)
        files = [code for code in seen if code.co_filename.startswith(str(SOURCE))]
        calls.append([(code.co_filename, code.co_firstlineno) for code in files])
    record.write_text(json.dumps([seconds, calls]), encoding="utf-8")
    return not items[0].session.testsfailed


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("files", nargs="+", metavar="TEST")
    parser.add_argument("--before", metavar="REVISION")
    parser.add_argument("--number", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        files = list(given.files)
        if given.before:
            archive = subprocess.run(
                ["git", "archive", given.before], cwd=ROOT, check=True, capture_output=True
            )
            subprocess.run(["tar", "-x"], cwd=place, input=archive.stdout, check=True)
            files += [f"{place}/{file}" for file in given.files]
        options = ["-q", "-m", "", "-s", "-p", "no:cacheprovider"]
        sys.exit(pytest.main([*options, *files], [Loop(given.number, given.seed)]))


if __name__ == "__main__":
    main()

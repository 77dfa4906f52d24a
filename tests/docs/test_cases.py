"""Cases of tests: those that are chosen run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
from pathlib import Path

TESTS = Path(__file__).parents[1]


def test_no_chosen_case_is_skipped() -> None:
    """`cover` chooses few cases out of many: one that skips itself stands for others that exist."""
    found = []
    for path in sorted(TESTS.rglob("test_*.py")):
        text = path.read_text(encoding="utf-8")
        if "cover(" not in text:
            continue
        for node in ast.parse(text).body:
            if isinstance(node, ast.FunctionDef) and any(
                "'cover'" in ast.dump(mark) for mark in node.decorator_list
            ):
                skips = [n for n in ast.walk(node) if isinstance(n, ast.Attribute)]
                if any(n.attr == "skip" for n in skips):
                    found.append(f"{path.relative_to(TESTS)}: {node.name}: say `allowed=`")
    assert not found

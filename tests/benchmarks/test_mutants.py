"""Mutants of ``python -m benchmarks mutants``: one expression of a function changed."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

from benchmarks.campaigns.mutants import mutants

TEXT = """def f(x: int = 3) -> float:
    if not x < 2:
        return -x + f"{x + 1}".count("1")
    return 0.0


def g(x):
    return x * 2
"""


def test_each_mutant_changes_one_expression_of_the_functions_called(tmp_path: Path) -> None:
    path = tmp_path / "m.py"
    path.write_text(TEXT, encoding="utf-8")
    found = [(line, old) for _, _, line, old, _ in mutants(path, {1})]
    assert sorted(found) == [
        (2, "2"),
        (2, "not x < 2"),
        (2, "x < 2"),
        (3, "-x"),
        (3, '-x + f"{x + 1}".count("1")'),
        (4, "0.0"),
    ]
    for *_, old, text in mutants(path, {1, 7}):
        compile(text, "m.py", "exec")
        assert text != TEXT, old
    assert [line for _, _, line, _, _ in mutants(path, {7})] == [8, 8]

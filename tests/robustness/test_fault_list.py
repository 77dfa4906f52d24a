"""Every fault and every promise of the lists has a test, and the list of faults counts them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent
PAGE = TESTS.parent / "docs" / "robustness.md"


def test_the_tests_of_the_list_are_there():
    rows = [
        line.split("|")[1:-1] for line in PAGE.read_text().splitlines() if line.startswith("| ")
    ]
    numbered = [row for row in rows if row[0].strip().isdigit()]
    assert [int(row[0]) for row in numbered] == list(range(1, len(numbered) + 1))
    assert len(numbered) >= 50
    for row in numbered:
        for path, name in re.findall(r"`(\S+\.py)::(\w+)`", row[-1]):
            assert f"def {name}(" in (TESTS / path).read_text(), row


def test_the_tests_of_promises_and_findings_are_there():
    """A path is in the repository; a bare name is a test of this folder."""
    root, here = TESTS.parent, "".join(p.read_text() for p in (TESTS / "robustness").glob("*.py"))
    promise = (root / "SECURITY.md").read_text().partition("promise: begin -->")[2]
    audits = (root / "docs" / "audits.md").read_text()
    findings = audits.partition("## Received files, memory, arguments")[2].partition("\n## ")[0]
    for text in (promise.partition("<!-- promise: end")[0], findings):
        rows = [line.split("|")[1:-1] for line in text.splitlines() if line.startswith("| ")][2:]
        assert len(rows) >= 10
        for row in rows:
            named = re.findall(r"`([\w/.]+)`", row[-1])
            assert named, row
            for name in named:
                if "/" in name:
                    assert (root / name).exists(), row
                elif not name.endswith(".py"):
                    assert f"def {name}" in here or f"_{name}" in here, row

"""Every fault of the list has a test, and the list counts them."""

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

"""docs/contact-constants.md lists every constant of contact, with the value that it has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib

from benchmarks.campaigns.contact_constants import FOLDER, PAGE, counted


def test_the_page_of_constants_has_those_of_the_code() -> None:
    """Modules and names as scripts/measures.py counts them; numbers by their values."""
    text = PAGE.read_text(encoding="utf-8")
    rows = text.split("<!-- constants: begin -->")[1].split("<!-- constants: end -->")[0]
    cells = [[c.strip() for c in line.split("|")] for line in rows.splitlines() if "| `" in line]
    listed = {row[1].strip("`"): float(row[2]) for row in cells}
    found = {}
    for name in counted():
        module, constant = name.split(".")
        found[name] = float(getattr(importlib.import_module(FOLDER + module), constant))
    assert listed == found

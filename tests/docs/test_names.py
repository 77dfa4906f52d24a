"""Files and modules that pages name exist."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "CONTRIBUTING.md", ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
PAGES = [page for page in PAGES if "generated" not in page.parts]
#: Files that a reader makes, and names that stand for any.
MADE = {"DIR/part.inp", "contact/law/NAME.rs"}
LISTED = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
FILES = LISTED.stdout.split() or [p.relative_to(ROOT).as_posix() for p in ROOT.rglob("*.*")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_what_a_page_names_exists(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    code = " ".join(re.findall(r"`([^`\n]+)`", text))
    named = set(re.findall(r"(?<![\w./])[\w-]+/[\w./-]+\.(?:py|rs|md|inp)\b", code)) - MADE
    modules = re.findall(r"python -m (benchmarks[\w.]+)", text)
    named |= {module.replace(".", "/") + ".py" for module in modules}
    missing = {name for name in named if not any(f"/{file}".endswith(f"/{name}") for file in FILES)}
    packages = {name for name in missing if name.removesuffix(".py") + "/__main__.py" in FILES}
    assert not missing - packages, f"{page.name} names files that do not exist"

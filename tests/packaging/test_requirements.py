"""Pinned versions hold hashes and no address; what the package needs is pinned."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted(ROOT.glob("requirements*.txt"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.name)
def test_every_pin_has_a_hash_and_no_address(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert "://" not in text
    pins = re.split(r"\n(?=[a-z])", re.sub(r"^#.*\n", "", text, flags=re.MULTILINE))
    for pin in pins:
        assert re.match(r"[a-z0-9-]+==[0-9][^ ]*", pin), pin.splitlines()[0]
        assert "--hash=sha256:" in pin, pin.splitlines()[0]


def test_runtime_dependencies_are_pinned() -> None:
    manifest = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    listed = re.search(r"^dependencies = \[(.*)\]", manifest, flags=re.MULTILINE)
    assert listed
    pins = (ROOT / "requirements.txt").read_text(encoding="utf-8")
    for name in re.findall(r'"([a-z0-9]+)', listed.group(1)):
        assert re.search(rf"^{name}==", pins, flags=re.MULTILINE), name

"""The pages of the site that are generated are whole, and the decks of the documents run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

import corota as ct
from corota.cli import main
from corota.io.deck.keywords import KEYWORDS

DOCS = Path(__file__).resolve().parents[2] / "docs"
DECKS = sorted((DOCS / "decks").glob("*.inp"))


@pytest.fixture(scope="module")
def site() -> ModuleType:
    spec = importlib.util.spec_from_file_location("site_pages", DOCS / "site_pages.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["site_pages"] = module
    spec.loader.exec_module(module)
    return module


def test_every_public_name_is_in_the_reference(site: ModuleType) -> None:
    listed = [name for names in site.REFERENCE.values() for name in names.split()]
    assert len(listed) == len(set(listed))
    modules = {name.split(".")[1] for name in site.MODULES}
    assert {*listed, *modules, "LOCAL_STRAINS"} == set(ct.__all__)


def test_every_keyword_has_its_page(site: ModuleType, tmp_path: Path) -> None:
    site._keywords(DOCS, tmp_path)
    assert {p.stem for p in tmp_path.glob("*.md")} == {"index", *(k.lower() for k in KEYWORDS)}
    static = (tmp_path / "static.md").read_text(encoding="utf-8")
    assert "**Parameters**" in static
    assert "corota run" in static


@pytest.mark.parametrize("deck", DECKS, ids=lambda p: p.name)
def test_decks_of_the_documents_run(deck: Path, tmp_path: Path) -> None:
    assert main(["run", str(deck), "-o", str(tmp_path), "--quiet"]) == 0


def test_links_of_the_repository_lead_into_the_site(site: ModuleType) -> None:
    text = ["[x](../examples/gripper) [y](../CONTRIBUTING.md#z) [w](../benchmarks/README.md)"]
    site.mend_links(None, "index", text)
    assert text[0] == "[x](generated/gallery/gripper.md) [y](generated/contributing.md#z) w"


def test_every_page_is_in_the_index() -> None:
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    fenced = {
        w for block in re.findall(r"```{toctree}(.*?)```", index, re.DOTALL) for w in block.split()
    }
    for page in DOCS.glob("*.md"):
        assert page.stem in fenced or page.stem == "index", page.name

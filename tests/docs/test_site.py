"""The pages of the site that are generated are whole, and the decks of the documents run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib
import os
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

import corota as ct
from corota.cli import main
from corota.io.deck.keywords import KEYWORDS
from corota.model import elements
from support.compiled import compiled_laws

DOCS = Path(__file__).resolve().parents[2] / "docs"
DECKS = sorted((DOCS / "decks").glob("*.inp"))


@pytest.fixture(scope="module")
def site() -> ModuleType:
    return script("site_pages")


def script(name: str) -> ModuleType:
    """Import a module of the folder of documents."""
    if str(DOCS / "builder") not in sys.path:
        sys.path.insert(0, str(DOCS / "builder"))
    return importlib.import_module(name)


def test_every_public_name_is_in_the_reference(site: ModuleType) -> None:
    listed = [name for names in site.REFERENCE.values() for name in names.split()]
    assert len(listed) == len(set(listed))
    modules = {name.split(".")[1] for name in site.MODULES}
    assert {*listed, *modules, "LOCAL_STRAINS"} == set(ct.__all__)
    # A section named like a module would be written over by its page.
    assert not modules & {title.lower().replace(" ", "-") for title in site.REFERENCE}


def test_every_keyword_has_its_page() -> None:
    found = script("keyword_pages").pages(DOCS)
    assert set(found) == {"index.md", *(f"{k.lower()}.md" for k in KEYWORDS)}


def test_every_keyword_has_its_section() -> None:
    written = set(script("keyword_pages").notes(DOCS))
    missing, unknown = set(KEYWORDS) - written, written - set(KEYWORDS)
    assert not missing, f"docs/decks/syntax.md needs a section (syntax, difference) of {missing}"
    assert not unknown, f"docs/decks/syntax.md has sections of unknown keywords: {unknown}"


@pytest.mark.parametrize("key", KEYWORDS)
def test_page_of_a_keyword_is_whole(key: str) -> None:
    pages = script("keyword_pages")
    assert key in pages.notes(DOCS), f"docs/decks/syntax.md has no section of {key}"
    assert key in pages.rows(DOCS), f"docs/keywords.md has no row of {key}"
    name, syntax, difference = pages.notes(DOCS)[key]
    text = pages.page(key, DOCS)
    assert f"\n*{name}" in syntax
    assert difference
    assert "## A deck that runs" in text, f"no deck of docs/decks has a line *{name}"
    reported = re.sub(r"[^A-Z0-9-]", "", text.split("## What differs")[0])
    for parameter in KEYWORDS[key].parameters.split():
        assert parameter in reported, f"*{name} does not tell of its parameter {parameter}"
    generated = DOCS / "generated"  # In a fresh clone nobody has written these pages yet.
    for target in re.findall(r"\]\((?!http)([^)#]+\.md)", text):
        page = (generated / "keywords" / target).resolve()
        if page.is_relative_to(generated):
            folder, name = page.relative_to(generated).parts
            assert name in script(f"{folder[:-1]}_pages").pages(DOCS), target
        else:
            assert page.exists(), target


@pytest.mark.parametrize("name", elements.names())
def test_deck_of_an_element_gives_the_stress_it_says(name: str, tmp_path: Path) -> None:
    pages = script("element_pages")
    assert name in pages.theory_rows(DOCS), f"docs/theory.md (3. Elements) has no row of {name}"
    deck = tmp_path / "part.inp"
    deck.write_text(pages.deck(name), encoding="utf-8")
    stress = ct.solve(ct.read(deck)).frames[-1].fields[0].values["S"]
    assert stress[..., 0] == pytest.approx(100.0, rel=1e-12)
    assert stress[..., 1:] == pytest.approx(0.0, abs=1e-10)


@pytest.mark.parametrize("deck", DECKS, ids=lambda p: p.name)
def test_decks_of_the_documents_run(deck: Path, tmp_path: Path) -> None:
    options = []
    if "*USER MATERIAL" in deck.read_text(encoding="utf-8"):
        options = ["--allow-library", str(compiled_laws(tmp_path))]
    assert main(["run", str(deck), "-o", str(tmp_path), "--quiet", *options]) == 0


def test_links_of_the_repository_lead_into_the_site(site: ModuleType) -> None:
    text = [
        "[x](../examples/gripper) [c](../examples/contact/clip.py) [y](../CONTRIBUTING.md#z) "
        "[w](../benchmarks/README.md) [v](../rust/src)"
    ]
    site.mend_links(None, "index", text)
    assert text[0] == (
        "[x](generated/gallery/gripper.md) [c](generated/gallery/contact-clip.md) "
        "[y](generated/contributing.md#z) [w](generated/benchmarks.md) v"
    )


def test_links_of_all_pages_lead_to_pages(site: ModuleType) -> None:
    """Building the site takes such links for errors; it is not part of every run of the tests."""
    hidden = ("builder", "generated")
    pages = {
        str(path.relative_to(DOCS).with_suffix("")): path.read_text(encoding="utf-8")
        for path in DOCS.rglob("*.md")
        if path.relative_to(DOCS).parts[0] not in hidden
    }
    del pages["decks/syntax"]  # its sections are the pages of the keywords
    for name, source in site.ROOT_PAGES.items():
        text = (DOCS.parent / source).read_text(encoding="utf-8")
        pages[f"generated/{name}"] = site._moved(text)
    keywords = script("keyword_pages").pages(DOCS)
    known = {*pages, "generated/cite", *(f"generated/keywords/{k[:-3]}" for k in keywords)}
    made = ("generated/gallery/", "generated/reference/")
    lost = []
    for name, text in pages.items():
        source = [text]
        site.mend_links(None, name, source)
        for link in re.findall(r"\]\((?!http)([^)#\s]+)\.md(?:#[^)]*)?\)", source[0]):
            page = os.path.normpath(os.path.join(os.path.dirname(name), link))
            if page not in known and not page.startswith(made):
                lost.append(f"{name}: {link}.md")
    assert not lost


def test_every_example_is_in_the_gallery_and_linked_with_its_topic() -> None:
    gallery, thumbnails = script("gallery"), script("thumbnails")
    folder = DOCS.parent / "examples"
    scripts = [p.relative_to(folder).with_suffix("").as_posix() for p in thumbnails.scripts()]
    assert set(scripts) == set(gallery.ENTRIES)
    assert set(script("example_runs").stored()) == set(scripts), "run docs/builder/example_runs.py"
    pages = gallery.pages()
    for path, entry in gallery.ENTRIES.items():
        page = gallery.page_name(path)
        assert f":link: {page}\n" in pages["index.md"]
        for topic in gallery.TOPICS[entry.topic]:
            assert f"({topic}.md)" in pages[f"{page}.md"].replace("../../", "")
            assert f"gallery/{page}.md" in gallery.with_examples(topic, "# A topic\n")
    for notebook in (DOCS.parent / "notebooks").glob("*.ipynb"):
        assert f"(notebook-{notebook.stem}.md)" in pages["index.md"]
    pictures = {thumbnails.name(folder / f"{path}.py") for path in gallery.ENTRIES}
    assert {p.name for p in thumbnails.FOLDER.iterdir()} <= pictures


def test_words_of_the_search_belong_to_pages() -> None:
    search = script("search")
    for page in search.WORDS:
        assert (DOCS / f"{page}.md").is_file(), page
    assert "! single: elastomer\n" in search.with_words("rubber", "# Rubber\n\ntext\n")


def test_every_page_is_in_the_contents() -> None:
    listed = set()
    for page in ("index", "begin", "howto/index", "topics", "reference"):
        path = DOCS / f"{page}.md"
        for block in re.findall(
            r"```{toctree}(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL
        ):
            listed |= {(path.parent / word).resolve() for word in block.split() if word[0] != ":"}
    for page in [*DOCS.glob("*.md"), *DOCS.glob("howto/*.md")]:
        assert page.with_suffix("") in listed or page == DOCS / "index.md", page.name

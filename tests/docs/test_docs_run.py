"""The Python of the readme and of the pages runs, and their links lead somewhere."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted(
    [
        *ROOT.glob("*.md"),
        *(ROOT / "docs").glob("*.md"),
        *(ROOT / "docs" / "howto").glob("*.md"),
        ROOT / "benchmarks" / "README.md",
    ]
)
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


def solved() -> dict[str, object]:
    """What a page about results may take for granted: a small analysis that has run."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.06)
    return {"ct": ct, "model": model, "results": ct.solve(model, ct.Static(increments=2))}


#: Pages whose programs take seconds; they run with the slow tests.
LONG = {"cable_clip", "constant_force", "corner_drop", "crushed_tube", "detent", "seal", "snap_fit"}
#: Names that pages find defined; the others must begin from nothing.
GIVEN: dict[str, Callable[[], dict[str, object]]] = defaultdict(lambda: dict, output=solved)


def programs(page: Path) -> str:
    """All Python blocks of a page, in order, as one program."""
    return "\n".join(BLOCK.findall(page.read_text(encoding="utf-8")))


@pytest.mark.usefixtures("quick_pictures")
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=[pytest.mark.slow] if p.stem in LONG else [])
        for p in PAGES
        if programs(p)
    ],
    ids=lambda p: str(p.relative_to(ROOT)),
)
def test_python_of_the_page_runs(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    exec(compile(programs(page), str(page), "exec"), {"__name__": page.stem, **GIVEN[page.stem]()})


def test_readme_and_tutorial_hold_programs() -> None:
    assert programs(ROOT / "README.md")
    assert programs(ROOT / "docs" / "tutorial.md")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_to_files(page: Path) -> None:
    for target in LINK.findall(page.read_text(encoding="utf-8")):
        if target.startswith("generated/"):  # the site makes them, many from scripts
            scripts = [script.stem for script in (ROOT / "examples").rglob("*.py")]
            assert Path(target).stem.endswith(("index", *scripts)), target
        elif "://" not in target:
            assert (page.parent / target).exists(), target


def test_readme_commands_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for name in re.findall(r"`?make ([a-z-]+)", (ROOT / "README.md").read_text(encoding="utf-8")):
        assert re.search(rf"^{name}:", makefile, re.MULTILINE), name


def test_deck_of_the_page_on_gmsh_runs(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "howto" / "gmsh.md").read_text(encoding="utf-8")
    deck = re.search(r"^\*INCLUDE.*?^\*END STEP\n", text, re.MULTILINE | re.DOTALL)
    assert deck is not None
    (tmp_path / "plate.inp").write_text(deck.group(), encoding="utf-8")
    mesh = ct.mesh.rectangle(4.0, 2.0, nx=4, ny=2, cell="tri6")
    mesh.cell_sets["body"] = np.arange(mesh.n_cells)
    ct.write(mesh, tmp_path / "mesh.inp")
    assert main(["run", str(tmp_path / "plate.inp"), "-o", str(tmp_path), "-q"]) == 0
    found = ct.read_results(tmp_path / "plate.vtkhdf")
    np.testing.assert_allclose(found.nodal("S11"), 100.0, rtol=1e-9)

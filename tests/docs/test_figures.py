"""The figures of the documents are those that ``python docs/builder/figures.py`` draws."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

from corota.mesh.data import EDGES
from corota.model import elements

DOCS = Path(__file__).resolve().parents[2] / "docs"
STORED = sorted((DOCS / "figures").glob("*.svg"))
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def module() -> ModuleType:
    if str(DOCS / "builder") not in sys.path:
        sys.path.insert(0, str(DOCS / "builder"))
    return importlib.import_module("figures")


@pytest.fixture(scope="module")
def drawn() -> dict[str, str]:
    found: dict[str, str] = module().all_figures()
    return found


def test_there_is_a_figure_of_every_element(drawn: dict[str, str]) -> None:
    assert {p.name for p in STORED} == set(drawn)
    every = [*elements.names(), *elements.line_names()]
    assert {f"element_{name.lower()}.svg" for name in every} <= set(drawn)


@pytest.mark.parametrize("path", STORED, ids=lambda p: p.stem)
def test_a_figure_is_up_to_date(path: Path, drawn: dict[str, str]) -> None:
    stored, now = path.read_text(encoding="utf-8"), drawn[path.name]
    assert NUMBER.sub("0", stored) == NUMBER.sub("0", now), "run python docs/builder/figures.py"
    pairs = zip(NUMBER.findall(stored), NUMBER.findall(now), strict=True)
    # A tenth of a pixel, as coordinates are written, and what rounding does to long motions.
    assert all(abs(float(a) - float(b)) < 0.35 for a, b in pairs), (
        "run python docs/builder/figures.py"
    )


@pytest.mark.parametrize("name", elements.names())
def test_a_figure_names_nodes_faces_and_points(name: str, drawn: dict[str, str]) -> None:
    facts = elements.find(name)
    text = drawn[f"element_{name.lower()}.svg"]
    assert text.count('class="node-fill"') == facts.n_nodes + 1  # one in the legend
    assert len(re.findall(r">S\d<", text)) == len(EDGES[facts.cell]) + 1
    assert text.count('class="load" d=') == 2 * (facts.n_points + 1)

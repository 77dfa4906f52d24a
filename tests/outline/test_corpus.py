"""Outlines in dialects of CAD programs: places, area, loops, lengths of sets, or a reason."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct
from benchmarks.corpora.outline_drawings import CORPUS, DIALECTS, REFUSED, SHAPES
from benchmarks.corpora.outlines import check
from corota.errors import InputError

pytest.importorskip("gmsh", reason="the extra mesh: make test-mesh", exc_type=ImportError)
pytest.importorskip("ezdxf", reason="the extra mesh: make test-mesh")


@pytest.mark.parametrize(("name", "dialect"), CORPUS)
def test_outline(tmp_path: Path, name: str, dialect: str) -> None:
    _, figures, wrong = check(name, dialect, tmp_path)
    assert not wrong, figures
    assert figures["quadrilaterals"] >= 0.97


@pytest.mark.parametrize("name", REFUSED)
def test_refused(tmp_path: Path, name: str) -> None:
    write, message = REFUSED[name]
    write(tmp_path / "a.dxf")
    with pytest.raises(InputError, match=message):
        ct.mesh.outline(tmp_path / "a.dxf")


def test_the_corpus_has_fifty_outlines() -> None:
    assert len(CORPUS) >= 50
    assert {dialect for _, dialect in CORPUS} == set(DIALECTS)
    assert {name for name, _ in CORPUS} == set(SHAPES)

"""The verification table of the readme holds what the program computes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import corota as ct

ROOT = Path(__file__).resolve().parents[2]


def row(words: str) -> str:
    """Corota's cell of the row whose first cell begins with the words."""
    for line in (ROOT / "README.md").read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and cells[0].startswith(words):
            return cells[1]
    raise AssertionError(f"no row {words!r}")


def script(path: str) -> ModuleType:
    """Import a script of the repository."""
    name = "readme_" + Path(path).stem
    spec = importlib.util.spec_from_file_location(name, ROOT / path)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def test_cook() -> None:
    cook = script("examples/cook/cook.py")
    assert row("Cook's membrane, linear") == f"{cook.tip('Q9', 16, 1.0, nlgeom=False):.3f}"
    assert row("Cook's membrane, large") == f"{cook.tip('Q9', 16, 0.5, nlgeom=True):.3f}"


def test_elastica() -> None:
    length, height, young = 10.0, 0.1, 1.2e6
    mesh = ct.mesh.rectangle(length, height, nx=100, ny=1, cell="quad9")
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E=young, nu=0.0))
    model.fix("left")
    model.traction("right", y=10.0 * young * height**2 / 12.0 / length**2)
    frame = ct.solve(model, ct.Static(increments=10)).frames[-1]
    u, v = frame.U[mesh.nodes_of("right")].mean(axis=0) / length
    assert row("Elastica") == f"({u:.4f}, {v:.4f})"


def test_rollup() -> None:
    rollup = script("examples/rollup/rollup.py")
    results = ct.solve(rollup.strip(), ct.Static(increments=20))
    end = results.mesh.nodes_of("right")
    place = (results.mesh.points[end] + results.frames[-1].U[end]).mean(axis=0)
    miss = np.hypot(place[0], place[1] - rollup.HEIGHT / 2.0) / rollup.LENGTH
    assert row("Strip") == f"{miss:.4f}"


@pytest.mark.filterwarnings("ignore:local strain reaches")
def test_cantilever_beside_other_programs() -> None:
    p1 = script("benchmarks/corpora/cantilever.py")
    points, cells = p1.grid(14)
    blocks = [ct.mesh.Cells("quad4", cells, np.arange(1, len(cells) + 1))]
    model = ct.Model(ct.Mesh(points, blocks))
    model.section(
        "all",
        element="Q4",
        material=ct.Elastic(E=p1.YOUNG, nu=p1.POISSON),
        thickness=p1.THICKNESS,
        local_strain="green_lagrange",
    )
    model.fix(np.flatnonzero(points[:, 0] == 0.0))
    for node, share in p1.tip_shares(points).items():
        model.force([node], y=p1.SHEAR * p1.THICKNESS * share)
    frame = ct.solve(model, ct.Static(increments=10)).frames[-1]
    u, v = frame.U[p1.tip_middle(points)]
    assert row("Cantilever") == f"({u:.5f}, {v:.5f})"

"""Stress at the surfaces of beams, in memory, histories and files, beside closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct

PROFILE = ct.profiles.rectangle(20.0, 10.0)
NAMES = ("SR1", "SL1", "SR2", "SL2")


def cantilever(yields: bool) -> ct.Model:
    """Along y, pushed to the right at its end: bending stretches its left side."""
    model = ct.Model(ct.mesh.line([(0.0, 0.0), (0.0, 100.0)], n=2))
    material = ct.Mises(200e3, 0.3, yield_stress=250.0) if yields else ct.Elastic(200e3, 0.3)
    model.beam("all", material=material, profile=PROFILE)
    model.fix("start", rotation=True)
    return model


def read_frd(path: Path, name: str) -> np.ndarray:
    """Values at the nodes of the last block of a name."""
    text = path.read_text().split(f" -4  {name:<8}")[-1].split(" -3")[0]
    return np.array([float(line[13:25]) for line in text.splitlines() if line.startswith(" -1")])


def test_elastic_beam(tmp_path: Path) -> None:
    """Force and axial pull at the end, and a load along the beam: N / A and M c / I."""
    model = cantilever(False)
    model.force("end", x=30.0, y=4000.0)
    model.line_load(x=0.2)
    results = ct.solve(model, ct.Static(nlgeom=False))
    values = results.frames[-1].fields[0].values
    moment = 30.0 * np.array([100.0, 50.0, 0.0]) + 0.1 * np.array([100.0, 50.0, 0.0]) ** 2
    bending = moment * 6.0 / (20.0 * 10.0**2)
    for element in (0, 1):
        for end in (0, 1):
            left = 4000.0 / 200.0 + bending[element + end]
            right = 4000.0 / 200.0 - bending[element + end]
            assert values[f"SL{end + 1}"][element, 0] == pytest.approx(left, rel=1e-9)
            assert values[f"SR{end + 1}"][element, 0] == pytest.approx(right, rel=1e-9)
    peak = results.history("SL1", combine="max").values[-1]
    assert peak == pytest.approx(20.0 + bending[0], rel=1e-9)
    results.write(tmp_path / "a.vtkhdf")
    saved = ct.read_results(tmp_path / "a.vtkhdf").frames[-1].cell_averages
    for name in NAMES:
        assert saved[f"cell {name}"] == pytest.approx(values[name][:, 0], rel=1e-6)
    results.write(tmp_path / "a.frd")
    assert read_frd(tmp_path / "a.frd", "SLEFT") == pytest.approx(20.0 + bending, rel=1e-4)
    assert read_frd(tmp_path / "a.frd", "SRIGHT") == pytest.approx(20.0 - bending, rel=1e-4)


def test_plastic_hinge(tmp_path: Path) -> None:
    """Pushed far: the section at the foot is plastic throughout, at the tip there is no stress."""
    model = cantilever(True)
    model.fix("end", x=20.0, y=None)
    results = ct.solve(model, ct.Static(nlgeom=False, increments=1))
    values = results.frames[-1].fields[0].values
    ends = [values[name][n, 0] for n, name in ((0, "SR1"), (0, "SL1"), (1, "SR2"), (1, "SL2"))]
    assert ends == pytest.approx([-250.0, 250.0, 0.0, 0.0], abs=1e-3)
    results.write(tmp_path / "a.frd")
    assert read_frd(tmp_path / "a.frd", "SLEFT")[0] == pytest.approx(250.0, rel=1e-4)

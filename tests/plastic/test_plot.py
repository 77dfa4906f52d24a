"""Pictures of plasticity: PEEQ with the elastic-plastic boundary, the uniaxial answer."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.plots.contour import boundary
from corota.verification.plastic_models import perforated_strip

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


def test_boundary_separates_yielding_cells(tmp_path: Path) -> None:
    model = perforated_strip("Q4I", 4, pull=0.05)
    results = ct.solve(model, ct.Static(increments=4), threads=1)
    peeq = results.frames[-1].fields[0].values["PEEQ"]
    flows = (peeq > 0).any(axis=1)
    assert 0 < flows.sum() < len(flows)
    edges = {tuple(e) for e in boundary(results)}
    assert edges
    nodes = np.concatenate([c.nodes for c in results.mesh.cells])
    for edge in edges:
        owners = [i for i, cell in enumerate(nodes) if set(edge) <= set(cell)]
        assert len(owners) == 2
        assert flows[owners].sum() == 1
    path = tmp_path / "peeq.png"
    figure = results.plot("PEEQ", path=path)
    assert path.stat().st_size > 5000
    lines = [c for c in figure.axes[0].collections if type(c).__name__ == "LineCollection"]
    assert any(len(c.get_segments()) == len(edges) for c in lines)


def test_uniaxial_plot() -> None:
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=250.0, chaboche=[(60000.0, 400.0)])
    ax = law.plot_uniaxial()
    strain, stress = ax.lines[0].get_data()
    assert stress.max() < 400.0 + 1e-6
    assert stress[-1] == pytest.approx(stress.max(), rel=0.01)
    assert np.ptp(strain) == pytest.approx(20 * 250 / 200000)
    matplotlib.pyplot.close("all")

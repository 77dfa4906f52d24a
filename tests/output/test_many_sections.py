"""Averages at nodes take one pass over all sections, however many there are."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.results import averaging


@pytest.mark.parametrize("count", [1, 3, 12])
def test_each_cell_is_averaged_once(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The nodes that are summed over are as many as the cells have, not times the sections."""
    model = ct.Model(ct.mesh.rectangle(12.0, 1.0, 12, 1))
    for k, cells in enumerate(np.split(np.arange(12), count)):
        model.section(cells, element="Q4", material=ct.Elastic(E=1e3 + 100.0 * k, nu=0.3))
    model.fix("left")
    model.force("right", x=1.0, y=0.1)
    results = ct.solve(model, ct.Static(increments=1), threads=1)
    sizes = []
    plain = np.bincount

    def counted(values, weights=None, minlength=0):  # type: ignore[no-untyped-def]
        if weights is None:
            sizes.append(minlength)
        return plain(values, weights, minlength)

    monkeypatch.setattr(averaging.np, "bincount", counted)
    results.nodal("S11")
    # A border of sections has its two nodes twice; each block of cells is summed once.
    assert max(sizes) <= 26 + 2 * (count - 1)
    assert len(sizes) <= len(results.frames[-1].fields)


def test_at_borders_the_larger_section_counts() -> None:
    """Two bars of one force and different thickness: the stress of the thin one at the border."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    law = ct.Elastic(E=1e3, nu=0.0)
    model.section([0, 1], element="Q4", material=law, thickness=1.0)
    model.section([2, 3], element="Q4", material=law, thickness=0.5)
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    model.force("right", x=0.01)
    results = ct.solve(model, ct.Static(increments=1), threads=1)
    stress = results.nodal("S11")
    x = results.mesh.points[:, 0]
    assert stress[x < 1.5] == pytest.approx(0.01, rel=1e-4)
    assert stress[x > 1.5] == pytest.approx(0.02, rel=1e-4)
    assert results.nodal("S11", section=0)[x == 2.0] == pytest.approx(0.01, rel=1e-4)
    assert not results.nodal("S11", section=0)[x > 2.5].any()

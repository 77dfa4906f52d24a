"""A static step that follows an unstable equilibrium says so."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import pytest

import corota as ct


def column() -> ct.Model:
    """A column, 10 long and 1 thick, clamped at one end."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.0))
    model.fix("left")
    return model


@pytest.mark.parametrize(("shortening", "unstable"), [(0.01, False), (0.15, True)])
def test_a_driven_column_that_stays_straight_is_named_unstable(shortening, unstable):
    """Clamped and free, it buckles when it is pi^2 h^2 / (48 L) = 0.0206 shorter (Euler)."""
    step = ct.Static(increments=10)
    step.fix("right", x=-shortening, y=None)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        results = ct.solve(column(), step, threads=1)
    assert any("unstable" in str(w.message) for w in warned) == unstable
    said = [note for note in results.notes if "unstable" in note]
    assert bool(said) == unstable
    assert bool(min(f.scalars.get("stable", 1.0) for f in results.frames) == 0.0) == unstable
    if said:
        assert "DisplacementControl" in said[0]

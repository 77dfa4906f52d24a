"""A compressed half-space of neo-Hooke rubber loses its stability at Biot's stretch."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct

#: The square x of the stretch solves x³ + x² + 3 x = 1 (M. A. Biot, *Mechanics of Incremental
#: Deformations*, 1965).
BIOT = 0.543689


def last_stable_stretch(element: str, n: int, depth: float = 2.0) -> float:
    """Of a strip between smooth walls one half wave apart; its cells grow with the depth."""
    mesh = ct.mesh.rectangle(1.0, depth, n, 2 * n, "quad8" if element == "Q8R" else "quad4")
    mesh.points[:, 1] = depth * (1.0 - (1.0 - mesh.points[:, 1] / depth) ** 1.7)
    model = ct.Model(mesh)
    model.section(element=element, material=ct.NeoHooke(C10=0.5, D1=2e-4), plane="strain")
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    model.fix("right", x=-0.5, y=None)
    step = ct.Static(increments=20, at_bifurcation="stop", smallest_increment=1e-5)
    with pytest.raises(ct.ConvergenceError, match="bifurcation or limit point") as stop:
        ct.solve(model, step, threads=1)
    results = stop.value.results
    assert results is not None
    return 1.0 + float(results.history("U1", at="right").values[-1])


@pytest.mark.parametrize(
    ("element", "n", "tolerance"), [("Q8R", 6, 5e-4), ("Q8R", 10, 5e-5), ("Q4S", 16, 4e-3)]
)
def test_half_space(element: str, n: int, tolerance: float) -> None:
    assert last_stable_stretch(element, n) == pytest.approx(BIOT, rel=tolerance)

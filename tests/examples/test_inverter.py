"""The inverter by densities: its extracted body moves against the force, too."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:local strain")  # of a coarse body
def test_body_of_the_inverter(load) -> None:
    pytest.importorskip("mmapy", reason="mmapy is not installed (requirements-optimize.txt)")
    example = load("inverter/inverter.py")
    x, found = example.find(nx=20, most=12, threads=1)
    _, soft = example.analyze(found.mesh, found.thicknesses(x))
    _, exact = example.analyze(ct.mesh.to_quadratic(found.body(x)), example.SHEET)
    assert soft < -0.1
    assert exact == pytest.approx(soft, rel=0.3)

"""A bound on the memory of the way back: histories in a file give the same gradient to the bit."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

MEASURES = [gradients.Displacement("right", "y"), gradients.Displacement("right", "x", frame=3)]


def build(x: Any) -> ct.Model:
    """A clamped strip that flows, let go in a second step."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    material = ct.Mises(1000.0, 0.3, yield_stress=20.0 * x[0], isotropic=50.0)
    model.section("all", element="Q4I", material=material)
    model.fix("left")
    load = ct.Static(increments=5, fixed_increments=True)
    load.force("right", y=-0.3 * x[1])
    free = ct.Static(increments=2, fixed_increments=True, new_loads=True)
    model.steps = [load, free]
    return model


@pytest.mark.parametrize("memory", [0.0, 0.01])
def test_gradients_are_the_same_to_the_bit(memory: float) -> None:
    x = [1.0, 1.0]
    wanted = ct.value_and_grad(build, MEASURES, threads=1)(x)
    found = ct.value_and_grad(build, MEASURES, threads=1, memory=memory)(x)
    for one, two in zip(wanted, found, strict=True):
        assert np.array_equal(one, two)
    results = ct.solve(build(x), threads=1)
    by = gradients.Constant("E")
    assert np.array_equal(
        ct.gradient(results, MEASURES, by), ct.gradient(results, MEASURES, by, memory=memory)
    )


def test_no_more_is_in_memory() -> None:
    results = ct.solve(build([1.0, 1.0]), threads=1)
    whole = Run(results, MEASURES).store
    assert whole.filed == 0
    bounded = Run(results, MEASURES, memory=0.5e-6 * whole.kept).store
    assert bounded.kept <= 0.5 * whole.kept
    assert bounded.kept + bounded.filed == whole.kept
    assert bounded.filed > 0


@pytest.mark.parametrize("memory", [-1.0, np.nan])
def test_refused(memory: float) -> None:
    results = ct.solve(build([1.0, 1.0]), threads=1)
    with pytest.raises(ct.InputError, match="memory must be"):
        ct.gradient(results, MEASURES[0], gradients.Constant("E"), memory=memory)

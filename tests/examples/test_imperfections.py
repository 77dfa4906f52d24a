"""Knock-down of Roorda's frame and of a shallow arch: powers and coefficients of Koiter's laws."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from corota import gradients


def test_asymmetric_branching_of_a_frame(load) -> None:
    """Power 1/2, and its coefficient extrapolated to no imperfection."""
    example = load("imperfections/imperfections.py")
    assert example.frame_load() == pytest.approx(13.8859, abs=1e-4)
    assert example.frame_slope() == pytest.approx(0.3805, abs=5e-5)
    model = example.frame()
    point = example.bifurcation(model)
    turn = point.mode[len(point.mode) // 2, 2]
    amplitudes = np.array([1e-5, 4e-5])
    lost = example.losses(model, point, math.copysign(1.0, turn) * amplitudes)
    assert math.log(lost[1] / lost[0], 4.0) == pytest.approx(0.5, abs=0.01)
    rate = lost / np.sqrt(amplitudes)
    coefficient = 2.0 * rate[0] - rate[1]  # the next term goes with the amplitude
    assert coefficient == pytest.approx(
        2.0 * math.sqrt(example.frame_slope() * abs(turn)), rel=2e-3
    )


def test_symmetric_branching_of_an_arch(load) -> None:
    """The theory of shallow arches at each imperfection, and the power 2/3."""
    example = load("imperfections/imperfections.py")
    model = example.arch()
    point = example.bifurcation(model)
    amplitudes = example.RISE * np.array([1e-5, 8e-5])
    lost = example.losses(model, point, amplitudes)
    shallow = np.array([1.0 - example.arch_load(e) / example.arch_load() for e in amplitudes])
    np.testing.assert_allclose(lost, shallow, rtol=5e-3)
    assert math.log(lost[1] / lost[0], 8.0) == pytest.approx(2.0 / 3.0, abs=0.01)
    law = example.arch_asymptote(amplitudes[0])[0]
    assert lost[0] == pytest.approx(law, rel=2e-2)


def test_gradient_of_a_limit_load_by_an_imperfection(load) -> None:
    """Beside differences of sixth order; about ``-c / (2 sqrt e)`` by Koiter's law."""
    example = load("imperfections/imperfections.py")
    perfect = example.frame(8)
    mode = example.bifurcation(perfect).mode
    turn = mode[len(mode) // 2, 2]
    mode *= math.copysign(1.0, turn)

    def build(x: np.ndarray) -> ct.Model:
        model = example.frame(8)
        model.imperfection(mode, [x[0]])
        path = ct.ArcLength(increments=200, stop_at_limit=True)
        model.steps = [ct.Static(path=path)]
        return model

    limit = ct.value_and_grad(build, gradients.LimitLoad(), threads=1)
    size, h = 1e-3, 2e-5
    _, slope = limit([size])
    loads = {k: limit([size + k * h])[0] for k in (-3, -2, -1, 1, 2, 3)}
    difference = sum(w * (loads[k] - loads[-k]) for k, w in ((1, 45.0), (2, -9.0), (3, 1.0))) / (
        60.0 * h
    )
    assert slope[0] == pytest.approx(difference, rel=1e-7)
    koiter = -math.sqrt(example.frame_slope() * abs(turn) / size)
    assert slope[0] == pytest.approx(koiter, rel=0.1)


def test_asymmetric_branching_has_no_gradient(load) -> None:
    """The frame's branches cross at an angle, the column's do not, however slender both are."""
    example = load("imperfections/imperfections.py")
    model = example.frame(8)
    model.steps = [ct.Static(path=ct.ArcLength(factor=1.05))]
    with pytest.raises(ct.UnsupportedError, match="branches cross at an angle"):
        ct.value_and_grad(lambda _: model, gradients.BifurcationLoad(), threads=1)([1.0])

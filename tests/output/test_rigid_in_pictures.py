"""Pictures show rigid tools whole, unless these are far larger than the body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


@pytest.fixture
def model() -> ct.Model:
    made = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    made.section(element="Q4", material=ct.Elastic(E=1.0))
    made.fix("left")
    return made


def limits(model: ct.Model, kind: str, axis: str) -> tuple[float, float]:
    shown = model if kind == "model" else ct.solve(model, ct.Static(increments=1))
    figure = shown.plot()
    found: tuple[float, float] = getattr(figure.axes[0], f"get_{axis}lim")()
    pytest.importorskip("matplotlib.pyplot").close(figure)
    return found


@pytest.mark.parametrize("kind", ["model", "results"])
def test_a_tool_is_framed_whole(model: ct.Model, kind: str) -> None:
    pytest.importorskip("matplotlib").use("agg")
    model.contact("top", ct.RigidCurve.circle((2.0, 3.0), 1.5))
    assert limits(model, kind, "y")[1] > 4.5


@pytest.mark.parametrize("kind", ["model", "results"])
def test_a_large_floor_does_not_shrink_the_body(model: ct.Model, kind: str) -> None:
    pytest.importorskip("matplotlib").use("agg")
    model.contact("bottom", ct.RigidCurve.line((-500.0, -0.1), (500.0, -0.1)))
    assert np.ptp(limits(model, kind, "x")) < 10.0

"""One-sided derivatives at kinks, beside closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.mesh.data import Cells

E, H, YIELD, LENGTH = 1000.0, 250.0, 8.0, 2.0
TIP = gradients.Displacement("right", "x")


def bar(x: np.ndarray) -> ct.Model:
    """A bar under the force that makes it yield, times ``x``; of area one."""
    mesh = ct.mesh.rectangle(LENGTH, 1.0, nx=2, ny=1)
    model = ct.Model(mesh)
    material = ct.Mises(E, 0.0, yield_stress=YIELD, isotropic=H)
    model.section("all", element="Q4", material=material, thickness=1.0)
    model.fix("left", y=None)
    model.fix("bottom", x=None, y=0.0)
    model.traction("right", x=YIELD * x[0])
    model.steps = [ct.Static(nlgeom=False, increments=2, fixed_increments=True, tolerance=1e-12)]
    return model


@pytest.mark.parametrize(
    ("side", "slope"),
    [("left", YIELD * LENGTH / E), ("right", YIELD * LENGTH * (1.0 / E + 1.0 / H))],
)
def test_a_bar_about_to_yield(side: str, slope: float) -> None:
    value, found = ct.value_and_grad(bar, TIP, one_sided=side, threads=1)([1.0])
    assert value == pytest.approx(YIELD * LENGTH / E, rel=1e-9)
    assert found[0] == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize(("side", "slope"), [("left", -LENGTH / H), ("right", 0.0)])
def test_of_a_run_by_the_yield_stress(side: str, slope: float) -> None:
    """A smaller yield stress lets the bar flow by ``L (sigma - yield) / H``."""
    results = ct.solve(bar(np.ones(1)), threads=1)
    by = gradients.Constant("yield_stress")
    found = ct.gradient(results, TIP, by, one_sided=side)
    assert found == pytest.approx(slope, rel=1e-7, abs=1e-9)


def two_bars(x: np.ndarray) -> ct.Model:
    """A bar that is pulled until it touches another one, times ``x``: both of unit area."""
    gap = 0.01
    one = ct.mesh.rectangle(1.0, 1.0, nx=2, ny=1)
    two = ct.mesh.rectangle(0.5, 1.0, nx=1, ny=1, origin=(1.0 + gap, 0.0))
    model = ct.Model(ct.mesh.assembly(a=one, b=two))
    for name, modulus in (("a", E), ("b", 2.0 * E)):
        law = ct.Elastic(E=modulus, nu=0.0)
        model.section(name, element="Q4", material=law, thickness=1.0)
    model.fix("a.left")
    model.fix("b.right")
    model.force("a.right", x=E * gap * x[0])
    model.contact("a.right", "b.left")
    model.steps = [ct.Static(nlgeom=False, tolerance=1e-12)]
    return model


@pytest.mark.parametrize(("side", "stiffness"), [("left", E), ("right", E + 4.0 * E)])
def test_a_gap_about_to_close(side: str, stiffness: float) -> None:
    measure = gradients.Displacement("a.right", "x")
    with pytest.raises(ct.UnsupportedError, match="one-sided"):
        ct.value_and_grad(two_bars, measure, threads=1)([1.0])
    _, found = ct.value_and_grad(two_bars, measure, one_sided=side, threads=1)([1.0])
    assert found[0] == pytest.approx(E * 0.01 / stiffness, rel=1e-6)


def block(x: np.ndarray) -> ct.Model:
    """A hard block on a spring that friction of the floor is about to let go, times ``x``."""
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1)
    springs = Cells("point1", mesh.node_sets["bottom"][:, None], np.array([2, 3]))
    model = ct.Model(replace(mesh, cells=[*mesh.cells, springs]))
    model.section([0], element="Q4", material=ct.Elastic(E=1e7, nu=0.0), thickness=1.0)
    model.spring([1, 2], 10.0, dofs="x")
    floor = ct.RigidCurve.line((-2.0, 0.0), (3.0, 0.0))
    model.contact("bottom", floor, method="node_to_segment", friction=0.3)
    model.force("top", y=-5.0)
    model.force("bottom", x=1.5 * x[0])
    model.steps = [ct.Static(nlgeom=False, tolerance=1e-12)]
    return model


@pytest.mark.parametrize(("side", "compliance"), [("left", 0.0), ("right", 1.0 / 20.0)])
def test_a_block_about_to_slip(side: str, compliance: float) -> None:
    measure = gradients.Displacement("bottom", "x")
    with pytest.raises(ct.UnsupportedError, match="stick and slip"):
        ct.value_and_grad(block, measure, threads=1)([1.0])
    _, found = ct.value_and_grad(block, measure, one_sided=side, threads=1)([1.0])
    assert found[0] == pytest.approx(1.5 * compliance, rel=1e-5, abs=1e-6)


def test_refused() -> None:
    with pytest.raises(ct.InputError, match="one_sided"):
        ct.value_and_grad(bar, TIP, one_sided="both")
    results = ct.solve(bar(np.ones(1)), threads=1)
    with pytest.raises(ct.UnsupportedError, match="Attribute"):
        ct.gradient(results, TIP, gradients.Thickness(), one_sided="left")

"""Bodies that flow everywhere and are then unloaded, in increments that may not be cut."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct

CELL: dict[str, Any] = {
    "Q4I": "quad4",
    "Q4D": "quad4",
    "T3": "tri3",
    "OPT": "tri3",
    "Q8R": "quad8",
}
YOUNG, YIELD = 200e3, 250.0
#: Isotropic and kinematic hardening modulus [MPa].
HARDENING = {"isotropic": (2000.0, 0.0), "kinematic": (0.0, 2000.0), "combined": (500.0, 1500.0)}
#: Stress at the ends of three steps [MPa].
PEAKS = (300.0, -300.0, 310.0)
LENGTH = 10.0

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


class Notes(ct.BaseObserver):
    """Notes of all iterations."""

    def __init__(self) -> None:
        self.all: list[tuple[int, int, int, str]] = []

    def iteration(self, info: Any) -> None:
        self.all.append((info.step, info.increment, info.iteration, info.note))


def cycle(
    element: str, material: ct.Material, nlgeom: bool, watch: Notes | None = None, **options: Any
) -> ct.Results:
    """A square pulled, pushed and pulled again by tractions."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, LENGTH, 1, 1, cell=CELL[element]))
    measure: Any = "logarithmic" if nlgeom else "linear"
    model.section(element=element, material=material, local_strain=measure)
    model.fix("left", y=None)
    model.fix([0], x=None)
    steps = []
    for stress in PEAKS:
        step = ct.Static(nlgeom=nlgeom, **options)
        step.traction("right", x=stress)
        steps.append(step)
    return ct.solve(model, steps, threads=1, observers=[watch] if watch else [])


def steel(kind: str) -> ct.Mises:
    isotropic, kinematic = HARDENING[kind]
    return ct.Mises(E=YOUNG, nu=0.3, yield_stress=YIELD, isotropic=isotropic, kinematic=kinematic)


def strain(kind: str) -> float:
    """Of a bar after the three steps: each yields beyond twice the yield stress of the last."""
    isotropic, kinematic = HARDENING[kind]
    slope, radius, flow = isotropic + kinematic, YIELD, 0.0
    before, center = 0.0, 0.0
    for stress in PEAKS:
        sign = np.sign(stress - before)
        step = (sign * (stress - center) - radius) / slope
        radius += isotropic * step
        center += sign * kinematic * step
        flow += sign * step
        before = stress
    return float(before / YOUNG + flow)


@pytest.mark.parametrize("fixed", [True, False], ids=["fixed", "automatic"])
@pytest.mark.parametrize("kind", HARDENING)
@pytest.mark.parametrize("element", ["Q4I", "T3", "Q8R"])
def test_reversal_of_a_bar_that_flows_everywhere(element: str, kind: str, fixed: bool) -> None:
    """Closed form of one-dimensional plasticity; no increment is cut."""
    results = cycle(element, steel(kind), False, increments=10, fixed_increments=fixed)
    assert results.info.get("cut-backs", 0) == 0
    right = results.model.mesh.node_indices("right")
    np.testing.assert_allclose(results.frames[-1].U[right, 0], LENGTH * strain(kind), rtol=1e-9)


@pytest.mark.parametrize("kind", HARDENING)
@pytest.mark.parametrize("element", ["Q4I", "T3", "Q8R"])
def test_reversal_at_finite_strain(element: str, kind: str) -> None:
    """Ten fixed increments end where forty do: the integration is exact on a proportional path."""
    found = []
    for n in (10, 40):
        results = cycle(element, steel(kind), True, increments=n, fixed_increments=True)
        right = results.model.mesh.node_indices("right")
        found.append(results.frames[-1].U[right, 0].mean())
    assert found[0] == pytest.approx(found[1], rel=1e-7)


@pytest.mark.parametrize("kind", HARDENING)
@pytest.mark.parametrize(("element", "nlgeom"), [("Q4D", False), ("Q4D", True), ("OPT", False)])
def test_reversal_with_edge_moments(element: str, kind: str, nlgeom: bool) -> None:
    """Elements with rotations flow unevenly: fixed increments end near shorter, automatic ones."""
    fixed = cycle(element, steel(kind), nlgeom, increments=10, fixed_increments=True)
    short = cycle(element, steel(kind), nlgeom, increments=40)
    right = fixed.model.mesh.node_indices("right")
    found = [r.frames[-1].U[right, 0].mean() for r in (fixed, short)]
    assert found[0] == pytest.approx(found[1], rel=0.03)


@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
def test_reversal_after_the_end_of_the_yield_curve(element: str) -> None:
    """The last tangent is nearly singular: the curve is nearly flat from its second point on."""
    curve = [(YIELD, 0.0), (YIELD + 20.0, 0.002), (YIELD + 20.01, 1.0)]
    flat = ct.Mises(E=YOUNG, nu=0.3, yield_curve=curve)
    model = ct.Model(ct.mesh.rectangle(LENGTH, LENGTH, 1, 1, cell=CELL[element]))
    model.section(element=element, material=flat)
    model.fix("left", y=None)
    model.fix([0], x=None)
    steps = []
    for stretch, stress in ((0.01, None), (None, -200.0)):
        step = ct.Static(nlgeom=False, increments=4, fixed_increments=True, new_supports=True)
        step.fix("left", y=None)
        step.fix([0], x=None)
        if stretch is not None:
            step.fix("right", x=LENGTH * stretch, y=None)
        else:
            step.traction("right", x=stress)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    right = results.model.mesh.node_indices("right")
    slope = 0.01 / 0.998
    stress = (YIELD + 20.0 + slope * 0.008) / (1.0 + slope / YOUNG)
    expected = 0.01 - (stress + 200.0) / YOUNG
    np.testing.assert_allclose(results.frames[-1].U[right, 0], LENGTH * expected, rtol=1e-9)


def test_second_attempts_are_reported() -> None:
    """Their iterations continue the numbers and have a note; increments of loading have none."""
    notes = Notes()
    cycle("Q4I", steel("kinematic"), False, notes, increments=10, fixed_increments=True)
    noted = [n for n in notes.all if "elastic tangent" in n[3]]
    assert {(step, increment) for step, increment, _, _ in noted} == {(2, 1), (3, 1)}
    first = [
        iteration for step, increment, iteration, _ in notes.all if (step, increment) == (2, 1)
    ]
    assert first == list(range(1, len(first) + 1))


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S"])
def test_load_that_turns_in_another_step_unloads_elastically(element: str) -> None:
    """Strip of a law with two back-stresses under 340 and -240, increments of a fifth to begin.

    With the tangent of flow the fourth step began at 2.4 times the length, under 15 negative
    pivots, or ended with an error.
    """
    high, low = 340.0, -240.0
    law = ct.Mises(E=YOUNG, nu=0.3, yield_stress=YIELD, chaboche=[(6e4, 400.0), (4e3, 10.0)])
    model = ct.Model(ct.mesh.rectangle(2.0 * LENGTH, 4.0, 10, 2))
    model.section(element=element, material=law)
    model.fix("left", y=None)
    model.fix([0], x=None)
    steps = []
    for stress in (high, low) * 3:
        steps.append(ct.Static(first_increment=0.2, new_loads=True))
        steps[-1].traction("right", x=stress)
    results = ct.solve(model, steps, threads=1)
    right = model.mesh.node_indices("right")
    change = 0.2 * (high - low) / YOUNG
    for before, after in zip(results.frames[:-1], results.frames[1:], strict=True):
        if after.step > 1 and after.increment == 1:
            stretch = (after.U[right, 0] - before.U[right, 0]) / (2.0 * LENGTH)
            sign = 1.0 if after.step % 2 else -1.0
            # Of the deformed strip, by half a percent of strain, and of its stress.
            np.testing.assert_allclose(stretch, sign * change, rtol=0.02)
            assert after.scalars["iterations"] <= 3.0
    assert max(frame.scalars.get("negative pivots", 0.0) for frame in results.frames) == 0.0


@pytest.mark.parametrize("increments", [12, 30])
def test_load_that_turns_within_a_step(increments: int) -> None:
    """The same by an amplitude, logarithmic beside linear strain: half a percent of strain apart.

    In thirty increments the strip was pulled to twelve times its length.
    """
    law = ct.Mises(E=YOUNG, nu=0.3, yield_stress=YIELD, chaboche=[(6e4, 400.0), (4e3, 10.0)])
    found = []
    for measure in ("linear", "logarithmic"):
        model = ct.Model(ct.mesh.rectangle(2.0 * LENGTH, 4.0, 10, 2))
        model.section(element="Q4I", material=law, local_strain=measure)
        model.fix("left", y=None)
        model.fix([0], x=None)
        model.amplitudes["c"] = ct.Amplitude(range(7), [0, 340, -240, 340, -240, 340, -240])
        step = ct.Static(period=6.0, increments=increments)
        step.traction("right", x=1.0, amplitude="c")
        results = ct.solve(model, step, threads=1)
        assert results.frames[-1].step_time == pytest.approx(6.0)
        right = results.model.mesh.node_indices("right")
        found.append([frame.U[right, 0].mean() for frame in results.frames])
    np.testing.assert_allclose(*found, atol=0.05 * np.max(found[0]))

"""Increments are bounded by the error of plastic flow whose direction changes in them.

Reference: the same steps in 80 increments. Single increments of the default are compared.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.verification.models import cell, nearest
from corota.verification.plastic_models import perforated_strip

ELEMENTS = ["Q4I", "Q8", "T6", "Q8R"]


def metal(isotropic: float = 10.0) -> ct.Mises:
    return ct.Mises(E=1000.0, nu=0.3, yield_stress=2.0, isotropic=isotropic)


def body(element: str, n: int, plane: str = "strain") -> ct.Model:
    """A square whose bottom is clamped."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, n, n, cell(element)))
    model.section("all", element=element, material=metal(), plane=plane, local_strain="logarithmic")
    model.fix("bottom")
    return model


def solved(model: ct.Model, steps: list[ct.Static], nodes: str, **options: float) -> tuple:
    """Force on nodes at the end, its largest size, and results."""
    for step in steps:
        for name, value in options.items():
            setattr(step, name, value)
    results = ct.solve(model, steps, threads=1)
    force = results.frames[-1].RF[model.mesh.nodes_of(nodes), :2].sum(axis=0)
    return force, results


def fine(model: ct.Model, steps: list[ct.Static], nodes: str) -> np.ndarray:
    for step in steps:
        step.first_increment = step.largest_increment = step.period / 80
    return solved(model, steps, nodes, plastic_tolerance=0.0)[0]


def apart(found: np.ndarray, exact: np.ndarray) -> float:
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


@pytest.mark.parametrize(("plane", "most"), [("stress", 1e-3), ("strain", 0.03)])
@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "OPT", "Q4S"])
def test_proportional_loading_takes_one_increment(element: str, plane: str, most: float) -> None:
    """A bar stretched to fifty times its yield strain, at once, and back.

    In plane strain the stress through the thickness grows from 0.3 to half of that along the bar.
    """
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 2, cell(element))
    forces = []
    for tolerance in (0.0, most):
        model = ct.Model(mesh)
        model.section(
            "all", element=element, material=metal(), plane=plane, local_strain="logarithmic"
        )
        model.fix("left", y=None)
        model.fix("bottom", x=None)
        there, back = (ct.Static(plastic_tolerance=tolerance) for _ in range(2))
        there.fix("right", x=0.4, y=None)
        back.fix("right", x=0.0, y=None)
        results = ct.solve(model, [there, back], threads=1)
        assert len(results.frames) == 3
        assert results.info.get("cut-backs", 0) == 0
        forces.append(results.frames[-1].RF)
    np.testing.assert_array_equal(*forces)


def pull_then_shear(element: str) -> tuple[ct.Model, list[ct.Static]]:
    model = body(element, 2)
    pull, shear = ct.Static(), ct.Static()
    pull.fix("top", x=0.0, y=0.01)
    shear.fix("top", x=0.01, y=0.01)
    return model, [pull, shear]


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_direction_that_turns_is_followed(element: str) -> None:
    """Pulled, then sheared: one increment each is a third off in the pull that is left."""
    exact = fine(*pull_then_shear(element), "top")
    found, results = solved(*pull_then_shear(element), "top")
    once, _ = solved(*pull_then_shear(element), "top", plastic_tolerance=0.0)
    assert abs(once[1] / exact[1] - 1.0) > 0.3
    assert apart(found, exact) < 0.5 * apart(once, exact)
    assert apart(found, exact) < 0.12
    assert 3 < len(results.frames) < 12


def crushed(element: str) -> tuple[ct.Model, list[ct.Static]]:
    model = body(element, 6)
    step = ct.Static()
    step.fix("top", x=0.0, y=-0.1)
    return model, [step]


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_crushed_block_is_within_half_a_percent(element: str) -> None:
    exact = fine(*crushed(element), "top")
    found, _ = solved(*crushed(element), "top")
    assert apart(found, exact) < 5e-3


def test_fixed_increments_stay_and_are_noted() -> None:
    model, steps = crushed("Q8")
    _, results = solved(model, steps, "top", fixed_increments=True)
    assert len(results.frames) == 2
    assert any("too long for plastic flow" in note for note in results.notes)


def test_no_flow_and_no_limit_change_nothing() -> None:
    """Below yield the values are the same to the last bit."""
    frames = []
    for tolerance in (0.0, 0.03):
        model = body("Q8", 3)
        step = ct.Static(increments=2, plastic_tolerance=tolerance)
        step.fix("top", x=1e-4, y=1e-4)
        frames.append(ct.solve(model, step, threads=1).frames[-1])
    np.testing.assert_array_equal(frames[0].U, frames[1].U)
    np.testing.assert_array_equal(frames[0].RF, frames[1].RF)
    with pytest.raises(ct.InputError, match="plastic_tolerance must be >= 0"):
        ct.Static(plastic_tolerance=-1.0)


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "OPT"])
def test_a_line_search_takes_the_whole_increment(element: str) -> None:
    """The perforated strip, beyond yield everywhere: cut twice and 39 to 88 iterations before."""
    model = perforated_strip(element, 4, local_strain="logarithmic")
    results = ct.solve(model, ct.Static(), threads=1)
    assert len(results.frames) == 2
    assert results.info["iterations"] <= 25
    top = np.flatnonzero(model.mesh.points[:, 1] > 18.0 - 1e-9)
    assert nearest(model.mesh, 0.0, 18.0) in top
    force = results.frames[-1].RF[top, 1].sum()
    many = ct.solve(
        perforated_strip(element, 4, local_strain="logarithmic"),
        ct.Static(increments=40),
        threads=1,
    )
    assert force == pytest.approx(many.frames[-1].RF[top, 1].sum(), rel=2e-3)

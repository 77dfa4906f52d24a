"""A further audit of statics and results, from closed forms: 60 checks made without the code.

One name means one number in memory and file; zero ends a load; section forces, resultants and
extremes are those of the closed form; unstable equilibria warn; settings act when they change.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.verification.models import DRILLING, cell

ELEMENTS = ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI"]
E = 1000.0


def strip(
    element: str = "Q4I", nx: int = 8, material: Any = None, length: float = 8.0, **more: Any
) -> ct.Model:
    """A strip of height 1 and thickness 1, clamped on the left."""
    model = ct.Model(ct.mesh.rectangle(length, 1.0, nx=nx, ny=2, cell=cell(element)))
    law = material or ct.Elastic(E=E, nu=0.0, rho=1.0, expansion=1e-3)
    model.section(element=element, material=law, **more)
    model.fix("left", rotation=0.0 if element in DRILLING else None)
    return model


def solve(model: ct.Model, *steps: Any) -> ct.Results:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, list(steps) or None, threads=1)


@pytest.mark.parametrize("element", ELEMENTS)
def test_section_forces_of_a_cantilever(element: str) -> None:
    """12 checks: N = 3, V = 2 and M = 2 (8 - x) at x = 5, in the middle of a cell or not."""
    model = strip(element)
    model.force("right", x=3.0, y=-2.0)
    results = solve(model, ct.Static(nlgeom=False))
    found = results.section((5.0, -1.0), (5.0, 2.0))
    assert abs(found.N) == pytest.approx(3.0, rel=1e-8)
    assert abs(found.V) == pytest.approx(2.0, rel=1e-8)
    assert abs(found.M) == pytest.approx(6.0, rel=1e-8)


LOADS: dict[str, Callable[[Any, float], None]] = {
    "force": lambda s, f: s.force("right", x=f, y=-f),
    "one node": lambda s, f: s.force([3], y=-f),
    "traction": lambda s, f: s.traction("top", y=-f),
    "pressure": lambda s, f: s.pressure("top", f),
    "shear": lambda s, f: s.shear("top", f),
    "gravity": lambda s, f: s.gravity(y=-f),
    "centrifugal": lambda s, f: s.centrifugal(f),
    "temperature": lambda s, f: s.temperature(f),
}


@pytest.mark.parametrize("kind", LOADS)
def test_zero_ends_a_load(kind: str) -> None:
    """8 checks: nothing is left of it, and something was there."""
    first, last = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
    LOADS[kind](first, 1.0)
    LOADS[kind](last, 0.0)
    results = solve(strip(), first, last)
    size = [np.abs(f.U).max() for f in results.frames]
    assert max(size) > 1e-4
    assert size[-1] < 1e-9 * max(size)


NAMES = ["S11", "S22", "S12", "MISES", "SP1", "SP3", "E11", "ENER", "U2", "RF2"]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_means_one_number(name: str, tmp_path: Path) -> None:
    """10 checks: histories in memory and from the file are equal to the bit."""
    model = strip()
    model.force("right", x=3.0, y=-2.0)
    results = solve(model, ct.Static(increments=2))
    with ct.read_results(results.write(tmp_path / "job.vtkhdf")) as read:
        for combine in ("auto", "min", "max"):
            one = results.history(name, combine=combine).values
            two = read.history(name, combine=combine).values
            np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("what", ["min", "max", "auto"])
def test_extremes_of_bending_and_tension(what: str, side: float) -> None:
    """6 checks: N / A +- M y / I at the outermost points of the rule of Q8R, (1 + 1/sqrt 3) / 4."""
    model = strip("Q8R", nx=4)
    model.traction("right", x=side * 0.5)
    right = model.mesh.nodes_of("right")
    y = model.mesh.points[right, 1] - 0.5
    # A moment of 2 as nodal forces of a linear traction.
    weights = {0.0: 1 / 12, 0.25: 1 / 3, 0.5: 1 / 6, 0.75: 1 / 3, 1.0: 1 / 12}
    for node, at in zip(right, y, strict=True):
        model.force([int(node)], x=24.0 * float(at) * weights[round(float(at) + 0.5, 2)])
    sum_y = sum(24.0 * a * a * weights[round(a + 0.5, 2)] for a in y.tolist())
    results = solve(model, ct.Static(nlgeom=False))
    lever = 0.25 * (1.0 + 1.0 / math.sqrt(3.0))
    bent = 12.0 * sum_y * lever
    wanted = {"min": side * 0.5 - bent, "max": side * 0.5 + bent}
    wanted["auto"] = wanted["max"] if side > 0 else wanted["min"]
    found = results.history("S11", combine=what)[-1]
    assert found == pytest.approx(wanted[what], rel=0.02)


@pytest.mark.parametrize("strain", [0.01, 0.02, 0.04])
def test_dissipation_of_a_perfectly_plastic_bar(strain: float) -> None:
    """3 checks: ALLPD is the yield stress times the plastic strain times the volume."""
    law = ct.Mises(E=E, nu=0.3, yield_stress=5.0)
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=1, ny=1))
    model.section(element="Q4", material=law, local_strain="linear")
    model.fix("left", y=None)
    model.fix([0], x=None)
    step = ct.Static(increments=10, nlgeom=False)
    step.fix("right", x=2.0 * strain, y=None)
    frame = solve(model, step).frames[-1]
    assert frame.scalars["ALLPD"] == pytest.approx(5.0 * (strain - 0.005) * 2.0, rel=1e-6)
    assert frame.scalars["ALLSE"] == pytest.approx(0.5 * 25.0 / E * 2.0, rel=1e-6)


@pytest.mark.parametrize(("x", "y"), [(3.0, 0.0), (0.0, -2.0), (3.0, -4.0), (-5.0, 12.0)])
def test_reactions_are_resultants(x: float, y: float) -> None:
    """4 checks: RF of a set is the size of the sum, its components are the sums."""
    model = strip()
    model.force("right", x=x, y=y)
    results = solve(model, ct.Static(nlgeom=False))
    assert results.history("RF", at="left")[-1] == pytest.approx(math.hypot(x, y), rel=1e-9)
    assert results.history("RF1", at="left")[-1] == pytest.approx(-x, abs=1e-9)
    assert results.history("RF2", at="left")[-1] == pytest.approx(-y, abs=1e-9)


@pytest.mark.parametrize(("share", "how"), [(0.9, "quiet"), (1.1, "warns"), (1.1, "stops")])
@pytest.mark.parametrize("increments", [1, 3])
def test_a_column_around_its_euler_load(share: float, how: str, increments: int) -> None:
    """6 checks: pi^2 E I / 4 L^2 (1 % for shear and strain) of a column of length 20."""
    euler = math.pi**2 * E / 12.0 / 4.0 / 20.0**2
    model = strip(nx=20, length=20.0)
    model.force("right", x=-share * euler)
    step = ct.Static(increments=increments, at_bifurcation="stop" if how == "stops" else "warn")
    if how == "stops":
        with pytest.raises(ct.ConvergenceError, match="bifurcation"):
            ct.solve(model, step, threads=1)
        return
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        results = ct.solve(model, step, threads=1)
    assert any("bifurcation" in str(w.message) for w in said) == (how == "warns")
    assert (results.stable[-1] == 1.0) == (how == "quiet")


@pytest.mark.parametrize("angle", [0.0, 17.0, 90.0, 143.0])
def test_increments_do_not_depend_on_the_axes(angle: float) -> None:
    """4 checks: automatic increments of a bent plastic strip, turned."""

    def times(turn: float) -> list[float]:
        mesh = ct.mesh.move(ct.mesh.rectangle(8.0, 1.0, nx=8, ny=2), angle=turn)
        model = ct.Model(mesh)
        model.section(element="Q4I", material=ct.Mises(E, 0.3, yield_stress=4.0, isotropic=50.0))
        model.fix("left")
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        step = ct.Static(first_increment=0.1)
        step.force("right", x=0.12 * s, y=-0.12 * c)
        return [f.time for f in solve(model, step).frames]

    assert times(angle) == pytest.approx(times(31.0))


@pytest.mark.parametrize("start", ["force", "temperature", "support"])
def test_perturbations_add_to_the_preload(start: str) -> None:
    """3 checks: half of the critical load, then the same cause again: the factor is one half."""
    euler = math.pi**2 * E / 12.0 / 4.0 / 20.0**2
    model = strip(nx=20, length=20.0)
    if start != "force":
        model.fix("right", y=None, x=0.0)
        euler *= 4.0  # the end is guided
    strain = euler / E

    def load(step: Any, share: float) -> None:
        if start == "force":
            step.force("right", x=-share * euler)
        elif start == "temperature":
            step.temperature(share * strain / 1e-3)
        else:
            step.fix("right", x=-share * strain * 20.0, y=None)

    first, modes = ct.Static(nlgeom=True), ct.Buckle(modes=1, preload=True)
    load(first, 0.5)
    load(modes, 1.0)
    factor = solve(model, first, modes).modes[-1].factors[0]
    assert factor == pytest.approx(0.5, rel=0.03)


@pytest.mark.parametrize("setting", ["increments", "period", "first_increment", "tolerance"])
def test_settings_act_when_they_change(setting: str) -> None:
    """4 checks: a step changed after its construction is the step constructed so."""
    values: dict[str, Any] = {
        "increments": 4,
        "period": 3.0,
        "first_increment": 0.25,
        "tolerance": 1e-6,
    }
    step = ct.Static()
    setattr(step, setting, values[setting])
    built = ct.Static(**{setting: values[setting]})
    model = strip()
    model.force("right", y=-0.1)
    one, two = solve(model, step), solve(model, built)
    assert [f.time for f in one.frames] == [f.time for f in two.frames]
    np.testing.assert_array_equal(one.frames[-1].U, two.frames[-1].U)

"""The energy account: every term against a closed form, and the balance of all procedures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.model import elements

SETTINGS: dict[str, Any] = {"threads": 1}


def bar(material: Any, plane: str = "stress", element: str = "Q4") -> ct.Model:
    """Bar 4 x 1 x .5 held at the left, free to contract."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element=element, material=material, plane=plane, thickness=0.5)
    model.fix("left", y=None)
    model.fix([0], x=None)
    return model


def worst(results: ct.Results) -> float:
    """Largest balance error over the largest energy."""
    return max(abs(f.scalars["energy balance error"]) for f in results.frames)


@pytest.mark.parametrize("increments", [1, 5])
@pytest.mark.parametrize("hardening", [{}, {"isotropic": 500.0}, {"kinematic": 500.0}])
def test_plastic_work_of_a_bar(hardening: dict[str, float], increments: int) -> None:
    """Pulled to 2 %: sigma deps by hand, with linear hardening, even in one increment."""
    young, flow, stretch = 2e4, 100.0, 0.02
    model = bar(ct.Mises(E=young, nu=0.3, yield_stress=flow, **hardening))
    model.fix("right", x=4.0 * stretch, y=None)
    step = ct.Static(increments=increments, nlgeom=False)
    last = ct.solve(model, step, **SETTINGS).frames[-1].scalars
    slope = sum(hardening.values())
    plastic = (stretch - flow / young) / (1.0 + slope / young)
    end = flow + slope * plastic
    assert last["ALLPD"] == pytest.approx(2.0 * 0.5 * (flow + end) * plastic, rel=1e-9)
    assert last["ALLSE"] == pytest.approx(2.0 * 0.5 * end**2 / young, rel=1e-9)
    assert last["ALLIE"] == pytest.approx(last["ALLSE"] + last["ALLPD"], rel=1e-12)


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("law", ["elastic", "mises", "orthotropic"])
def test_heat_of_a_held_bar(law: str, plane: str) -> None:
    """Pulled, then heated with its ends held: the account closes, and without pull all of
    E alpha^2 T^2 / 2 comes from heat (plane stress, free sides)."""
    young, alpha, heat = 1e3, 1e-3, 10.0
    material = {
        "elastic": lambda: ct.Elastic(E=young, nu=0.3, expansion=alpha),
        "mises": lambda: ct.Mises(E=young, nu=0.3, yield_stress=1e3, expansion=alpha),
        "orthotropic": lambda: ct.Orthotropic(
            E1=young,
            E2=300.0,
            E3=500.0,
            nu12=0.2,
            nu13=0.1,
            nu23=0.3,
            G12=200.0,
            expansion=(alpha, 2.0 * alpha, 3.0 * alpha),
        ),
    }[law]()
    for pull in (0.0, 0.02):
        model = bar(material, plane)
        model.fix("right", x=pull, y=None)
        warm = ct.Static(increments=2, nlgeom=False, loads=[ct.model.Temperature("", heat)])
        results = ct.solve(model, [ct.Static(nlgeom=False), warm], **SETTINGS)
        last = results.frames[-1].scalars
        assert worst(results) < 1e-9
        if plane == "stress" and not pull:
            stored = 2.0 * 0.5 * young * (alpha * heat) ** 2
            assert last["ALLTH"] == pytest.approx(stored, rel=1e-9)
            assert last["ALLSE"] == pytest.approx(stored, rel=1e-9)
            assert last["ALLWK"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "OPT", "Q8R", "T6"])
def test_a_cycle_of_a_plastic_cantilever(element: str) -> None:
    """Bent past yield and back: the balance error falls with the square of the increment, and what
    is left of the work is plastic."""
    errors = []
    for increments in (10, 20):
        model = ct.Model(ct.mesh.rectangle(8.0, 1.0, nx=8, ny=2, cell=elements.find(element).cell))
        law = ct.Mises(E=1e4, nu=0.3, yield_stress=40.0, isotropic=400.0, kinematic=300.0)
        model.section("all", element=element, material=law)
        model.fix("left")
        model.fix("right", x=None, y=-1.0)
        back = ct.Static(increments=increments, supports=[ct.model.Fixed("right", 1, 0.0)])
        results = ct.solve(model, [ct.Static(increments=increments), back], **SETTINGS)
        errors.append(worst(results))
        last = results.frames[-1].scalars
        assert last["ALLPD"] > 0.5 * last["ALLWK"] > 0.0
    assert errors[1] < 5e-3
    assert errors[1] < 0.4 * errors[0]


def test_a_user_material_without_energies() -> None:
    """What is done on a Python material is counted, though it gives no energy."""

    def hooke(strain: np.ndarray, state: np.ndarray, plane: str) -> Any:
        c = 1e3 * np.diag([1.0, 1.0, 0.5])
        return strain @ c, np.broadcast_to(c, (*strain.shape, 3)).copy(), state

    model = bar(ct.UserMaterial(hooke))
    model.traction("right", x=10.0)
    results = ct.solve(model, ct.Static(increments=2), **SETTINGS)
    assert results.frames[-1].scalars["ALLSE"] == pytest.approx(2.0 * 0.5 * 0.1, rel=1e-6)
    assert worst(results) < 1e-6


@pytest.mark.parametrize(
    "scheme", ["newmark", "hht", "generalized_alpha", "energy_momentum", "central_difference"]
)
def test_one_account_over_static_and_dynamic_steps(scheme: Any) -> None:
    """Bent, let go, and held again: work goes on, motion that a static step ends is left out."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.fix("left")
    bent = ct.Static(increments=4, loads=[ct.model.NodalForce("right", 1, -0.5)])
    lumped = {"mass": "lumped"} if scheme == "central_difference" else {}
    free = ct.Dynamic(period=1.0, increments=200, scheme=scheme, new_loads=True, **lumped)
    results = ct.solve(model, [bent, free, ct.Static(increments=2)], **SETTINGS)
    of = {k: np.array(results.history(k)) for k in ("ALLWK", "ALLKE", "ETOTAL", "energy balance")}
    assert worst(results) < 4e-3
    assert of["ALLKE"].max() > 0.1 * of["ALLWK"].max()
    assert of["ALLKE"][-1] == 0.0
    assert not np.any(results.frames[-1].V)


def test_a_large_error_is_named() -> None:
    """HHT with heavy dissipation loses a bar's vibration: the note says how much and why."""
    model = bar(ct.Elastic(E=1e3, nu=0.0, rho=1.0))
    model.velocity("", x=1.0)
    step = ct.Dynamic(period=2.0, increments=20, scheme="hht", alpha=-0.3)
    (note,) = ct.solve(model, step, **SETTINGS).notes
    assert "is lost by step 1" in note
    assert "numerical dissipation of hht" in note
    quiet = ct.Dynamic(period=2.0, increments=200, scheme="energy_momentum")
    assert not ct.solve(model, quiet, **SETTINGS).notes


@pytest.mark.parametrize("then", ["lumped", "static"])
def test_total_energy_does_not_jump_between_steps(then: str) -> None:
    """Another mass has another kinetic energy, and a stop has none: work from outside."""
    model = ct.Model(ct.mesh.rectangle(6.0, 1.0, nx=6, ny=1))
    model.section("all", element="Q4D", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.velocity(x=0.5, spin=2.0, about=(0.0, 0.0))
    if then == "static":
        model.fix([0], rotation=True)
        last: Any = ct.Static()
    else:
        last = ct.Dynamic(period=0.04, increments=10, scheme="energy_momentum", mass=then)
    first = ct.Dynamic(period=0.04, increments=10, scheme="energy_momentum")
    frames = ct.solve(model, [first, last], **SETTINGS).frames
    total = np.array([f.scalars["ETOTAL"] for f in frames])
    kinetic = [f.scalars["ALLKE"] for f in frames]
    assert abs(kinetic[10] - kinetic[11]) > 1e-3 * kinetic[10]
    # To the tolerance of Newton's method; a static increment releases what the motion has bent, and
    # its work is that of a straight line between both ends.
    assert np.ptp(total) <= (1e-6 if then == "lumped" else 5e-3) * kinetic[0]

"""Bodies that flow with time: rings, bars, all procedures, energy, checkpoints."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from benchmarks.campaigns.same_bits import Takes
from corota.verification.plastic_models import CELL


def ring(n: float, element: str, cells: int = 8, **options: Any) -> ct.Model:
    """Quarter ring 1 to 2 in plane strain under an inner pressure of 1, with Norton creep."""
    mesh = ct.mesh.annulus(1.0, 2.0, cells, cells, 90.0, CELL[element])
    model = ct.Model(mesh)
    law = ct.Mises(E=1000.0, nu=0.3, rate=ct.Norton(1e-3, n))
    model.section("all", element=element, material=law, plane="strain", **options)
    model.fix("start", x=None, y=0.0)
    model.fix("end", x=0.0, y=None)
    model.pressure("inner", 1.0)
    return model


@pytest.mark.parametrize(("n", "inner", "outer"), [(3, 0.80161, 1.13494), (5, 0.65193, 1.25193)])
def test_steady_ring(n: int, inner: float, outer: float) -> None:
    """Hoop stress ``(1 + (2 / n - 1) (b / r)^(2 / n)) / ((b / a)^(2 / n) - 1)`` at both radii."""
    for r, value in ((1.0, inner), (2.0, outer)):
        by_hand = (1.0 + (2.0 / n - 1.0) * (2.0 / r) ** (2.0 / n)) / (2.0 ** (2.0 / n) - 1.0)
        assert by_hand == pytest.approx(value, abs=6e-6)
    results = ct.solve(
        ring(n, "Q8R"),
        [
            ct.Static(nlgeom=False),
            ct.Visco(nlgeom=False, period=200.0, first_increment=0.01, creep_tolerance=2e-5),
        ],
        fields=True,
    )
    frame = results.frames[-1]
    fields = frame.fields[0]
    x, y = np.moveaxis(results.frames[0].fields[0].points, -1, 0)
    radius = np.hypot(x, y)
    xx, yy, _, xy = np.moveaxis(fields.values["S"], -1, 0)
    hoop = (xx * y**2 + yy * x**2 - 2.0 * xy * x * y) / radius**2
    known = (1.0 + (2.0 / n - 1.0) * (2.0 / radius) ** (2.0 / n)) / (2.0 ** (2.0 / n) - 1.0)
    assert np.abs(hoop / known - 1.0).max() < 5e-3
    for r, wanted in ((1.0, inner), (2.0, outer)):
        near = np.abs(radius - r) < 0.25
        there = np.polyval(np.polyfit(radius[near] - r, hoop[near], 2), 0.0)
        assert there == pytest.approx(wanted, rel=5e-3), r
    assert frame.scalars["ALLCD"] > 10.0 * frame.scalars["ALLSE"]
    assert abs(frame.scalars["ALLPD"]) < 1e-12 * frame.scalars["ALLCD"]
    assert abs(frame.scalars["energy balance error"]) < 1e-2


def bar(
    material: Any, element: str = "Q4", plane: Any = "stress", pull: float | None = None
) -> ct.Model:
    """A bar 2 x 1 that may contract; its end is moved by `pull`, or free."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1, CELL[element]))
    model.section("all", element=element, material=material, plane=plane)
    model.fix(model.mesh.nodes_of("left")[:1], x=None, y=0.0)
    turn = 0.0 if element == "OPT" else None
    model.fix("left", x=0.0, y=None, rotation=turn)
    if pull is not None:
        model.fix("right", x=pull, y=None, rotation=turn)
    return model


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q8R", "T6", "OPT"])
def test_relaxation_of_a_bar(element: str) -> None:
    """Norton: ``s^(1 - n) = s0^(1 - n) + (n - 1) E A t``; the load comes at once."""
    law = ct.Mises(E=200e3, nu=0.3, rate=ct.Norton(1e-16, 5.0))
    model = bar(law, element, pull=2e-3)
    steps = [
        ct.Static(nlgeom=False),
        ct.Visco(nlgeom=False, period=20.0, first_increment=0.01, creep_tolerance=1.5e-7),
    ]
    results = ct.solve(model, steps, fields=True)
    wanted = (200.0**-4 + 4.0 * 200e3 * 1e-16 * 20.0) ** -0.25
    stress = results.frames[-1].fields[0].values["S"]
    np.testing.assert_allclose(stress[..., 0], wanted, rtol=3e-3)
    assert abs(results.frames[-1].scalars["energy balance error"]) < 1e-3
    assert len(results.frames) < 150


def test_static_steps_do_not_creep_and_their_time_is_a_rate() -> None:
    creep = ct.Mises(E=200e3, nu=0.3, rate=ct.Norton(1e-10, 5.0))
    results = ct.solve(bar(creep, pull=2e-3), ct.Static(nlgeom=False, period=1e6), fields=True)
    assert results.frames[-1].fields[0].values["S"][..., 0] == pytest.approx(200.0)
    law = ct.Mises(E=200e3, nu=0.3, yield_stress=250.0, rate=ct.CowperSymonds(40.0, 5.0))
    for rate in (0.1, 100.0):
        step = ct.Static(nlgeom=False, period=0.05 / rate, increments=50)
        results = ct.solve(bar(law, pull=0.1), step, fields=True)
        wanted = 250.0 * (1.0 + (rate / 40.0) ** 0.2)
        found = results.frames[-1].fields[0].values["S"][..., 0]
        np.testing.assert_allclose(found, wanted, rtol=1e-6)


def test_a_fixed_load_creeps_in_one_increment() -> None:
    """Under a constant load nothing changes but the creep: the increment must not be taken for
    solved. ``A s^n t`` exactly, in a step with loads at once."""
    law = ct.Mises(E=200e3, nu=0.3, rate=ct.Norton(1e-14, 5.0))
    model = bar(law)
    model.traction("right", x=100.0)
    steps = [ct.Static(nlgeom=False), ct.Visco(nlgeom=False, period=10.0)]
    results = ct.solve(model, steps, fields=True)
    strain = results.frames[-1].U[results.mesh.nodes_of("right"), 0] / 2.0
    np.testing.assert_allclose(strain, 100.0 / 200e3 + 1e-14 * 100.0**5 * 10.0, rtol=1e-8)
    scalars = results.frames[-1].scalars
    assert scalars["ALLCD"] == pytest.approx(2.0 * 100.0 * 1e-14 * 100.0**5 * 10.0, rel=1e-8)
    assert abs(scalars["energy balance error"]) < 1e-9


def test_motion_with_a_rate_against_statics() -> None:
    """A light bar pulled at a constant speed has the stress of that rate."""
    law = ct.Mises(E=200e3, nu=0.3, yield_stress=250.0, rate=ct.CowperSymonds(40.0, 5.0), rho=1e-12)
    model = bar(law, pull=0.1)
    step = ct.Dynamic(nlgeom=False, period=0.05, increments=400, ramp=True, scheme="newmark")
    results = ct.solve(model, step, fields=True)
    wanted = 250.0 * (1.0 + (1.0 / 40.0) ** 0.2)
    found = results.frames[-1].fields[0].values["S"][..., 0]
    np.testing.assert_allclose(found, wanted, rtol=2e-3)


def test_temperature_of_the_model_softens() -> None:
    """Johnson-Cook with the temperatures of a step: the factor is exact between any two."""
    law = ct.JohnsonCook(E=200e3, nu=0.3, A=350.0, m=1.7, melting=1500.0, transition=20.0)
    model = bar(law.with_temperatures(), pull=0.1)
    model.initial_temperature(20.0)
    step = ct.Static(nlgeom=False, increments=4)
    step.temperature(613.0)
    found = ct.solve(model, step, fields=True).frames[-1].fields[0].values["S"][..., 0]
    np.testing.assert_allclose(found, 350.0 * (1.0 - (593.0 / 1480.0) ** 1.7), rtol=1e-9)


@pytest.mark.parametrize("loaded_before", [True, False])
def test_creep_of_a_bar_under_a_dead_load_ends_at_its_time(loaded_before: bool) -> None:
    """Hoff (1953): a force that stays thins the bar without end at the time 1 / (n A s^n).

    This was called a plastic collapse, or an increment turned the bar round and the step went on.
    The true stress of the elastic bar is 1e-4 larger at the start: 249.87 for 250.
    """
    exponent, factor = 4.0, 1e-3
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    law = ct.Mises(E=1e4, nu=0.3, rate=ct.Norton(factor, exponent))
    model.section("all", element="Q4I", material=law)
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    model.force("right", x=1.0)
    steps = [ct.Static()] * loaded_before + [ct.Visco(period=400.0)]
    with pytest.raises(ct.ConvergenceError, match="creep accelerates without end") as error:
        ct.solve(model, steps, threads=1)
    assert "plastic" not in str(error.value)
    end = error.value.results.frames[-1].step_time
    assert end == pytest.approx(249.87, rel=0.01)


def test_a_ring_section_creeps_under_an_axial_stress() -> None:
    """Free to contract: ``s / E + A s^n t`` along the axis, in one increment."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2, "quad4", origin=(1.0, 0.0)))
    law = ct.Mises(E=1000.0, nu=0.3, rate=ct.Norton(1e-3, 3.0))
    model.section("all", element="Q4", material=law, plane="axisymmetric")
    model.fix("bottom", x=None, y=0.0)
    model.pressure("top", -1.0)
    steps = [ct.Static(nlgeom=False), ct.Visco(nlgeom=False, period=10.0)]
    strain = ct.solve(model, steps, fields=True).frames[-1].fields[0].values["E"]
    np.testing.assert_allclose(strain[..., 1], 1e-3 + 1e-2, rtol=1e-7)
    np.testing.assert_allclose(strain[..., 2], -0.3e-3 - 0.5e-2, rtol=1e-7)


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8R"])
def test_a_turned_body_creeps_alike(element: str, plane: Any) -> None:
    """A stretched cell is turned by 90 degrees, then relaxes: the stress turns with it."""
    law = ct.Mises(E=1000.0, nu=0.3, rate=ct.Norton(1e-3, 3.0))
    found = []
    for turn in (np.eye(2), np.array([[0.0, -1.0], [1.0, 0.0]])):
        model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1, CELL[element]))
        model.section("all", element=element, material=law, plane=plane)
        first, second = ct.Static(), ct.Static()
        for node, x in enumerate(model.mesh.points):
            stretched = x * np.array([1.01, 0.996])
            moved, last = stretched - x, turn @ stretched - x
            first.fix([node], x=moved[0], y=moved[1])
            second.fix([node], x=last[0], y=last[1])
        held = ct.Visco(period=5.0, increments=3)
        stress = (
            ct.solve(model, [first, second, held], fields=True).frames[-1].fields[0].values["S"]
        )
        s = np.array([[stress[..., 0], stress[..., 3]], [stress[..., 3], stress[..., 1]]])
        found.append(np.einsum("ki,klep,lj->ijep", turn, s, turn))
    np.testing.assert_allclose(found[1], found[0], atol=1e-9)
    assert np.abs(found[0]).max() < 9.0  # 10 and more without creep


def test_what_needs_no_time_is_refused() -> None:
    law = ct.Mises(E=200e3, nu=0.3, rate=ct.Norton(1e-14, 5.0), rho=1e-9)
    with pytest.raises(ct.ModelError, match="follows a path has no time"):
        ct.solve(bar(law, pull=1e-3), ct.Static(path=ct.ArcLength()))


LAWS = {
    "Cowper-Symonds": ct.Mises(
        1000.0, 0.3, yield_stress=1.0, isotropic=20.0, rate=ct.CowperSymonds(0.2, 2.0), rho=1.0
    ),
    "Johnson-Cook": ct.JohnsonCook(
        1000.0, 0.3, A=1.0, B=3.0, n=0.4, C=0.05, rate=1e-3, melting=1500.0, transition=20.0,
        rho=1.0, heat_fraction=0.9, specific_heat=1e-3,
    ),
    "Norton": ct.Mises(1000.0, 0.3, rate=ct.Norton(5e-4, 3.0), rho=1.0),
    "Prony": ct.Viscoelastic(ct.Elastic(1000.0, 0.3, rho=1.0), [(0.4, 0.0, 0.02)]),
}  # fmt: skip


def struck(law: Any, scheme: str, increments: int, plane: Any) -> ct.Results:
    """A block 2 x 1 on a floor is pressed at once and let go, two waves long."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1, origin=(1.0, 0.0)))
    model.section("all", element="Q4", material=law, plane=plane)
    model.fix("bottom", x=None)
    if plane != "axisymmetric":
        model.fix("left", x=0.0, y=None)
    model.velocity(y=-0.3)
    step = ct.Dynamic(period=0.12, scheme=scheme, increments=increments)
    return ct.solve(model, step, threads=1, fields=True)


@pytest.mark.parametrize("plane", ["strain", "axisymmetric"])
@pytest.mark.parametrize("name", list(LAWS))
def test_the_energy_momentum_scheme_moves_laws_with_a_time(name: str, plane: Any) -> None:
    """Beside Newmark's scheme with three times as many increments: within 2 %.

    Laws that account for their work keep the balance of energy to rounding.
    """
    known = struck(LAWS[name], "newmark", 240, plane).frames[-1].U[:, 1]
    frame = struck(LAWS[name], "energy_momentum", 80, plane).frames[-1]
    assert np.abs(frame.U[:, 1] - known).max() < 0.02 * np.abs(known).max()
    if name != "Prony":
        assert abs(frame.scalars["energy balance error"]) < 1e-8


def test_a_checkpoint_goes_on_with_its_time() -> None:
    """Interrupted and resumed creep ends where the whole run ends."""
    law = ct.Mises(E=200e3, nu=0.3, rate=ct.Norton(1e-16, 5.0, 0.4))
    steps = [
        ct.Static(nlgeom=False),
        ct.Visco(nlgeom=False, period=20.0, increments=8),
    ]
    takes = Takes()
    whole = ct.solve(bar(law, pull=2e-3), steps, observers=[takes], threads=1)
    again = ct.solve(bar(law, pull=2e-3), steps, threads=1, start=takes.found[4])
    a, b = (r.frames[-1].fields[0].values["S"] for r in (whole, again))
    np.testing.assert_array_equal(b, a)


@pytest.mark.parametrize(("increments", "warns"), [(1, True), (10, True), (1000, False)])
def test_relaxation_in_long_increments_is_noted(increments: int, warns: bool) -> None:
    """``s^(1-n) = s0^(1-n) + (n-1) E A t``: a note where the error is above a few percent."""
    n, young, factor, period = 4.0, 1000.0, 1e-6, 100.0
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=ct.Mises(E=young, rate=ct.Norton(factor, n)))
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    model.fix("right", x=0.04, y=None)
    held = ct.Visco(
        nlgeom=False, period=period, first_increment=period / increments, fixed_increments=True
    )
    results = ct.solve(model, [ct.Static(nlgeom=False), held], threads=1)
    exact = (10.0 ** (1.0 - n) + (n - 1.0) * young * factor * period) ** (1.0 / (1.0 - n))
    error = abs(results.history("RF1", at="right")[-1] / exact - 1.0)
    assert (error > 0.05) == warns
    assert any("creep_tolerance" in note for note in results.notes) == warns


@pytest.mark.parametrize("loaded_before", [True, False])
@pytest.mark.parametrize(
    ("n", "young", "factor", "stress", "period", "most", "error"),
    [(4.0, 1000.0, 1e-6, 10.0, 100.0, 100, 0.02), (5.0, 200e3, 1e-16, 200.0, 20.0, 30, 0.01)],
)
def test_default_increments_relax_a_bar(
    loaded_before: bool,
    n: float,
    young: float,
    factor: float,
    stress: float,
    period: float,
    most: int,
    error: float,
) -> None:
    """``s^(1-n) = s0^(1-n) + (n-1) E A t`` from steps with their defaults; strains act at once.

    The rate of creep may change the creep strain of an increment by 0.003 of the elastic strain:
    the stress by less than `sqrt(0.003 / n)` in one of them, and by half of 0.003 in error.
    """
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=ct.Mises(E=young, rate=ct.Norton(factor, n)))
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    model.fix("right", x=4.0 * stress / young, y=None)
    steps = [ct.Static(nlgeom=False)] * loaded_before
    steps += [ct.Visco(nlgeom=False, period=period)]
    results = ct.solve(model, steps, threads=1)
    exact = (stress ** (1.0 - n) + (n - 1.0) * young * factor * period) ** (1.0 / (1.0 - n))
    assert results.history("RF1", at="right")[-1] == pytest.approx(exact, rel=error)
    assert len(results.frames) < most
    assert not results.notes


def test_few_increments_end_a_step_of_creep() -> None:
    """The default tolerance stops no step for want of increments; a note says that they are few."""
    model = bar(ct.Mises(E=1000.0, nu=0.3, rate=ct.Norton(1e-6, 4.0)), pull=0.02)
    steps = [ct.Static(nlgeom=False), ct.Visco(nlgeom=False, period=1e4, max_increments=10)]
    results = ct.solve(model, steps, threads=1)
    assert results.frames[-1].time == pytest.approx(1e4 + 1.0)
    assert any("too long for creep" in note for note in results.notes)

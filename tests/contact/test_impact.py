"""Contact in motion: a bar and a ring on a wall, rest under gravity, friction."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from support.pairs import quickly

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "impact"))
import bar
import ring


@pytest.mark.parametrize("scheme", ["newmark", "hht", "generalized_alpha", "energy_momentum"])
def test_bar_touches_once_and_leaves_as_it_came(scheme):
    hit = bar.strike("Q4I", scheme, cells=60)
    assert hit.contacts == 1
    assert hit.duration == pytest.approx(1.0, abs=0.02)
    assert hit.rebound == pytest.approx(1.0, abs=0.01)
    assert hit.energy == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("element", quickly(["T3", "Q8", "OPT", "Q4D"], "T3", "Q8"))
def test_bar_of_every_kind_of_edge(element):
    hit = bar.strike(element, cells=60)
    assert hit.contacts == 1
    assert hit.duration == pytest.approx(1.0, abs=0.03)
    assert hit.rebound == pytest.approx(1.0, abs=0.02)


def test_mass_at_the_contact_creates_energy_and_chatters():
    """Why the mass is redistributed: the same bar without."""
    hit = bar.strike("Q4I", "newmark", cells=50, redistribute=False)
    assert hit.contacts > 5
    assert hit.energy > 1.5


@pytest.mark.parametrize("element", quickly(["Q4I", "Q8", "OPT", "Q4D"], "Q8", "Q4D"))
def test_ring_keeps_its_energy(element):
    flight = ring.fly(element, around=24, increments=80, period=0.06)
    assert flight.energy_error < 5e-4
    assert flight.sideways < 1e-9


def test_ring_in_meters_and_millimeters():
    """Same increments, same iterations, same motion."""
    runs = [ring.fly("Q4I", around=24, increments=30, period=0.15, unit=u) for u in (1.0, 1e3)]
    assert runs[0].iterations == runs[1].iterations
    assert runs[1].rebound == pytest.approx(runs[0].rebound, rel=1e-6)


def test_yielding_ring_accounts_for_its_energy():
    """Of what is stored and dissipated, within 1 %: the increments miss some of the flow. The
    scheme's own balance, of the work of its mean forces, is closer."""
    flight = ring.fly("Q4D", around=32, plastic=True, speed=1.0, period=0.15, increments=0)
    assert flight.results is not None
    assert flight.plastic > 0.1
    assert flight.energy_error < 0.01
    first = 0.5 * ring.mass_of(flight.results)
    for frame in flight.results.frames[1:]:
        of = frame.scalars
        missing = of["kinetic energy"] + of["internal work"] - first - of["external work"]
        assert abs(missing) < 1e-3 * first
        assert abs(of["energy balance"]) < 0.01 * first


def test_block_rests_on_a_wall_after_a_static_step():
    """Weight, then motion: nothing moves, and the force stays the weight."""
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.gravity(y=-1.0)
    model.fix("left", y=None)
    wall = ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0))
    model.contact("bottom", wall, name="wall")
    frames = ct.solve(
        model,
        [ct.Static(), ct.Dynamic(period=0.2, increments=20, scheme="newmark")],
        fields=False,
    ).frames
    moving = [f for f in frames if f.step == 2 and f.increment > 0]
    force = np.array([f.scalars["wall: force y"] for f in moving])
    assert force == pytest.approx(2.0, rel=1e-6)
    assert max(f.scalars["kinetic energy"] for f in moving) < 1e-12


@pytest.mark.parametrize(("around", "increments"), [(24, 100), (48, 40)])
def test_energy_that_an_impact_makes_is_warned_of_with_the_way_out(around, increments):
    """An elastic ring without friction, in long increments: Newmark's rule makes energy.

    In 100 increments with 48 elements around it loses 2 %.
    """
    with pytest.warns(UserWarning, match="is gained .* use scheme='energy_momentum'"):
        results = ring.run(
            "Q4I", around, scheme="newmark", increments=increments, period=0.4, speed=1.0
        )
    assert max(f.scalars["energy balance error"] for f in results.frames[1:]) > 0.03
    assert any("is gained" in note for note in results.notes)


def test_energy_that_an_impact_loses_is_noted_and_the_conserving_scheme_keeps_it():
    for scheme in ("hht", "energy_momentum"):
        results = ring.run("Q4I", 48, scheme=scheme, increments=200, period=0.4, speed=1.0)
        frames = results.frames[1:]
        first = frames[0].scalars["ALLKE"] + frames[0].scalars["ALLIE"]
        energy = np.array([f.scalars["ALLKE"] + f.scalars["ALLIE"] for f in frames])
        lost = 1.0 - energy[-1] / first
        reported = -frames[-1].scalars["energy balance error"]
        if scheme == "hht":
            assert lost > 0.04
            assert reported == pytest.approx(lost, abs=0.02)
            assert any("lost" in n and "energy_momentum" in n for n in results.notes)
        else:
            assert abs(lost) < 1e-3
            assert not any("energy balance" in n for n in results.notes)


@pytest.mark.parametrize(("layers", "said"), [(2, True), (3, False)])
def test_a_changed_moment_of_inertia_is_said(layers, said):
    """A thick ring of two elements cannot keep it once its outer nodes have no mass."""
    model = ct.Model(ct.mesh.annulus(0.8, 1.6, layers, 24))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0, rho=1.0))
    model.contact("outer", ct.RigidCurve.line((-9.0, -1.7), (9.0, -1.7)), name="floor")
    results = ct.solve(model, ct.Dynamic(period=0.02, first_increment=0.01), threads=1)
    assert any("changes the moment of inertia" in note for note in results.notes) == said

"""The examples of contact: Hertz, friction, self-contact, plasticity; the same in m and in mm."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import corota as ct
from support.pairs import quickly

if TYPE_CHECKING:
    from collections.abc import Callable

    from conftest import Load


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
def test_cylinder_against_hertz(load: Load, plane: str, element: str) -> None:
    """Half width and greatest pressure within 1 % on 48 cells a side (17 of them touch)."""
    hertz = load("contact/hertz.py")
    results = ct.solve(hertz.cylinder(plane, 48, element), ct.Static(nlgeom=False))
    assert hertz.measured(results) == pytest.approx(hertz.theory(plane), rel=0.01)


def iterations(results: ct.Results) -> list[float]:
    return np.array(results.history("iterations")).tolist()


#: Quick runs of examples in a unit of length.
QUICK: dict[str, Callable[[Any, float], ct.Results]] = {
    "hertz": lambda example, unit: example.run(n=16, unit=unit),
    "ironing": lambda example, unit: example.run(0.3, unit),
    "seal": lambda example, unit: example.run(unit),
    "crushed_ring": lambda example, unit: ct.solve(
        example.ring(n=30, ny=2, unit=unit), example.steps(unit, 3.0)[:1]
    ),
    "bistable_beam": lambda example, unit: example.run(unit, nx=20),
}


@pytest.mark.parametrize("name", quickly(QUICK, *list(QUICK)[:2]))
def test_units_do_not_matter(load: Load, name: str) -> None:
    """The same course to the bit in a unit 1024 times as long, in which all numbers round alike.

    `python -m benchmarks contact_units` does it with all examples in full, in mm and in m.
    """
    example = load(f"contact/{name}.py")
    small, large = (QUICK[name](example, unit) for unit in (1.0, 1024.0))
    assert iterations(small) == iterations(large)
    assert small.info.get("cut-backs") == large.info.get("cut-backs")
    np.testing.assert_array_equal(small.frame().U, 1024.0 * large.frame().U)


@pytest.mark.parametrize("name", [name for name in QUICK if name != "bistable_beam"])
def test_millimeters_or_meters_do_not_matter(load: Load, name: str) -> None:
    """The same increments and iterations in mm and in m, and displacements to rounding.

    The snap of the bistable beam magnifies rounding: its times of contact differ in the 6th digit.
    The die of the ironing example touches at the start: rounding decides which of its nodes have a
    gap of zero, so its first increment may take an iteration more in one unit.
    """
    example = load(f"contact/{name}.py")
    small, large = (QUICK[name](example, unit) for unit in (1.0, 1000.0))
    first = 2 if name == "ironing" else 0
    assert iterations(small)[first:] == iterations(large)[first:]
    assert small.info.get("cut-backs") == large.info.get("cut-backs")
    # The residual is relative to the largest force, so states agree to a multiple of 1e-9.
    np.testing.assert_allclose(
        small.frame().U, 1000.0 * large.frame().U, atol=1e-6 * np.abs(small.frame().U).max()
    )


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_ironing_balances_and_obeys_coulomb(load: Load, friction: float) -> None:
    results = load("contact/ironing.py").run(friction)
    mesh = results.mesh
    for frame in results.frames[1:]:
        total = frame.RF[mesh.nodes_of("die.top")].sum(axis=0)
        total += frame.RF[mesh.nodes_of("block.bottom")].sum(axis=0)
        assert np.abs(total[:2]).max() < 1e-7
        slipping = frame.C[:, 4] == 2.0
        np.testing.assert_allclose(
            np.abs(frame.C[slipping, 1]), friction * frame.C[slipping, 0], atol=1e-9
        )
        assert (frame.C[:, 0] >= 0.0).all()
    if friction:
        assert (results.frames[-3].C[:, 4] == 2.0).sum() >= 4


def test_inner_walls_of_the_seal_touch(load: Load) -> None:
    """What pushes the upper wall up pushes the lower one down: no resultant of self-contact."""
    results = load("contact/seal.py").run()
    frame, mesh = results.frame(), results.mesh
    inner = mesh.nodes_of("inner")
    assert frame.C[inner, 0].max() > 0.5
    assert abs(frame.scalars["inside: force x"]) < 1e-12
    assert abs(frame.scalars["inside: force y"]) < 1e-12
    now = mesh.points[inner] + frame.U[inner]
    upper = mesh.points[inner, 1] > 0.0
    at = np.argsort(now[upper, 0])
    below = np.interp(
        now[~upper, 0], now[upper][at, 0], now[upper][at, 1], left=np.nan, right=np.nan
    )
    near = (now[~upper, 0] < 0.8) & np.isfinite(below)
    # Weighted gaps vanish, so nodes of coarse walls overlap by a share of the edges only.
    assert (below - now[~upper, 1])[near].min() > -0.02


def test_crushed_ring_carries_its_limit_load(load: Load) -> None:
    """DeRuntz and Hodge's load of the first mechanism, and hardening of a few percent over it."""
    ring = load("contact/crushed_ring.py")
    results = ct.solve(ring.ring(n=30, ny=2), ring.steps(way=1.2)[:1])
    force = -2.0 * np.array(results.history("RF2", at="plate"))
    way = -np.array(results.history("U2", at="plate"))
    early = float(np.interp(1.0, way, force))
    assert ring.limit_load() < early < 1.15 * ring.limit_load()
    floor, roof = (np.array(results.history(f"{n}: force y")) for n in ("floor", "roof"))
    np.testing.assert_allclose(floor, -roof, atol=1e-6 * np.abs(roof).max())


def test_clip_snaps_in(load: Load) -> None:
    clip = load("contact/clip.py")
    results = ct.solve(clip.clip(0.2, nx=80, ny=2), clip.steps()[:1])
    force = np.array(results.history("RF1", at="left"))
    # Pushed, then drawn in by the slope behind the hook, then free.
    assert force.max() > 4.0
    assert force.min() < -1.0
    assert np.abs(results.frame().C[:, 0]).max() == 0.0
    dissipated = np.array(results.history("friction energy"))
    assert (np.diff(dissipated) > -1e-9).all()
    assert dissipated[-1] > 0.0


@pytest.mark.slow
def test_bistable_beam_leaves_the_probe_where_its_force_vanishes(load: Load) -> None:
    """After 4 h / 3 (Qiu, Lang, Slocum 2004, slender beams); then it hangs in its second shape."""
    beam = load("contact/bistable_beam.py")
    results = beam.run()
    force = -2.0 * np.array(results.history("RF2", at="probe"))
    way = -np.array(results.history("U2", at="probe"))
    last = int(np.flatnonzero(force > 0.0)[-1])
    assert way[last] == pytest.approx(4.0 / 3.0 * beam.HEIGHT, rel=0.02)
    middle = -np.array(results.history("U2", at="left"))
    assert middle[-1] > way[-1]


def test_beam_snaps_through_by_its_load_onto_the_stop(
    load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same curve as with a held probe, in mm and in m the same iterations."""
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "examples" / "contact"))
    example = load("contact/snap_by_load.py")
    case = example.CASES["friction 0.3"]
    results = example.by_load(*case)
    way, force = example.curve(results)
    assert example.held(*case, way[1:]) == pytest.approx(force[1:], abs=1e-7)
    other = example.by_load(*case, unit=1e3)
    assert list(other.history("iterations")) == list(results.history("iterations"))
    limit, lowest = results.critical_points[:2]
    assert limit.factor > lowest.factor
    assert np.array(results.history("stop: area"))[-1] > 0.0

"""Zero ends a load of its kind, `remove` says it plainly, and settings act late, too."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest

import corota as ct

MESH = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1)
TIP = 4


def model() -> ct.Model:
    found = ct.Model(MESH)
    found.section(element="Q4I", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0, expansion=1e-4))
    found.fix("left")
    found.mesh.cell_sets["part"] = np.array([1, 2])
    return found


Load = Callable[[ct.Static], None]
LOADS: dict[str, tuple[Load, Load]] = {
    "force on nodes": (lambda s: s.force([TIP], x=5.0, y=-1.0), lambda s: s.force([TIP])),
    "force on edges": (lambda s: s.force("right", x=5.0, y=-1.0), lambda s: s.force("right")),
    "total on nodes": (
        lambda s: s.force([TIP, 9], x=5.0, total=True), lambda s: s.force([TIP, 9], total=True)
    ),
    "traction": (lambda s: s.traction("right", x=5.0), lambda s: s.traction("right")),
    "following traction": (
        lambda s: s.traction("right", x=5.0, follow=True), lambda s: s.traction("right")
    ),
    "pressure": (lambda s: s.pressure("right", 5.0), lambda s: s.pressure("right", 0.0)),
    "shear": (lambda s: s.shear("right", 1.0), lambda s: s.shear("right", 0.0)),
    "gravity": (lambda s: s.gravity(0.0, -1.0), lambda s: s.gravity()),
    "gravity of a set": (lambda s: s.gravity(1.0, 0.0, cells="part"), lambda s: s.gravity()),
    "spin": (lambda s: s.centrifugal(0.1, (9.0, 0.0)), lambda s: s.centrifugal(0.0)),
    "spin of a set": (
        lambda s: s.centrifugal(0.1, (9.0, 0.0), cells="part"), lambda s: s.centrifugal(0.0)
    ),
}  # fmt: skip
REMOVED: dict[str, tuple[str, str | list[int] | None]] = {
    "force on nodes": ("force", [TIP]),
    "force on edges": ("force", "right"),
    "traction": ("traction", "right"),
    "pressure": ("pressure", "right"),
    "shear": ("shear", "right"),
    "gravity": ("gravity", None),
    "gravity of a set": ("gravity", "part"),
    "spin": ("centrifugal", None),
}


def total(*steps: ct.Static, of: ct.Model | None = None) -> np.ndarray:
    results = ct.solve(of or model(), list(steps), threads=1)
    return results.frames[-1].F.sum(axis=0)[:2]


@pytest.mark.parametrize("kind", LOADS)
@pytest.mark.parametrize("nlgeom", [False, True])
def test_zero_ends_a_load(kind: str, nlgeom: bool) -> None:
    load, zero = LOADS[kind]
    first, second = ct.Static(nlgeom=nlgeom), ct.Static(nlgeom=nlgeom)
    load(first)
    zero(second)
    assert np.abs(total(first)).max() > 0.09 or "spin" in kind
    assert np.abs(total(first)).max() > 0.0
    assert total(first, second) == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("kind", REMOVED)
def test_remove_ends_a_load_of_a_step_and_of_the_model(kind: str) -> None:
    what, at = REMOVED[kind]
    first, second = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
    LOADS[kind][0](first)
    second.remove(what, at)
    assert total(first, second) == pytest.approx([0.0, 0.0], abs=1e-12)
    loaded = model()
    LOADS[kind][0](loaded)  # type: ignore[arg-type]
    assert total(ct.Static(nlgeom=False), second, of=loaded) == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("what", ["all", "force", "distributed", "temperature"])
def test_remove_everywhere_ends_its_kinds_only(what: str) -> None:
    first, second, third = (ct.Static(nlgeom=False) for _ in range(3))
    first.force([TIP], x=2.0)
    first.force("right", x=3.0)
    first.pressure("right", 3.0)
    first.temperature(10.0)
    second.remove(what)
    third.force([TIP], y=0.25)
    results = ct.solve(model(), [first, second, third], threads=1)
    at_end = results.frames[2]
    wanted = 5.0 * (what not in ("all", "force")) - 3.0 * (what not in ("all", "distributed"))
    assert at_end.F[:, 0].sum() == pytest.approx(wanted, abs=1e-12)
    heated = what not in ("all", "temperature")
    assert pytest.approx(10.0 * heated) == at_end.T
    assert results.frames[-1].F[:, 1].sum() == pytest.approx(0.25)


def test_a_zero_body_force_ends_its_elements_only() -> None:
    first, second = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
    first.gravity(1.0, 0.0)
    second.gravity(cells="part")
    assert total(first, second) == pytest.approx([2.0, 0.0], abs=1e-12)


def test_a_force_given_again_replaces_the_vector_and_not_the_moment() -> None:
    drilling = ct.Model(MESH)
    drilling.section(element="Q4D", material=ct.Elastic(E=1e3, nu=0.3))
    drilling.fix("left", rotation=True)
    for place in ([TIP], "right"):
        first, second = ct.Static(nlgeom=False), ct.Static(nlgeom=False)
        first.force(place, x=5.0, y=-1.0, moment=0.5)
        second.force(place, x=0.0, y=-2.0)
        frame = ct.solve(drilling, [first, second], threads=1).frames[-1]
        assert frame.F[:, :2].sum(axis=0) == pytest.approx([0.0, -2.0], abs=1e-12)
        assert frame.F[:, 2].sum() == pytest.approx(0.5, abs=0.35)


def test_remove_without_place_or_kind_is_refused() -> None:
    step = ct.Static()
    with pytest.raises(ct.InputError, match="give kind and place"):
        step.remove("pressure")
    with pytest.raises(ct.InputError, match="kind of load"):
        step.remove("presure")


def frames_of(step: ct.Static) -> int:
    loaded = model()
    loaded.force("right", y=0.1)
    return len(ct.solve(loaded, step, threads=1).frames) - 1


def test_settings_changed_after_construction_act() -> None:
    late = ct.Static()
    late.increments = 5
    longer = ct.Static(increments=5)
    longer.period = 2.0
    assert [frames_of(s) for s in (ct.Static(increments=5), late, longer)] == [5, 5, 5]
    own = ct.Static(increments=5)
    own.first_increment = own.largest_increment = 0.5
    assert frames_of(own) == 2
    twin = copy.copy(late)
    twin.increments = 2
    assert (late.first_increment, twin.first_increment) == (0.2, 0.5)
    again = pickle.loads(pickle.dumps(late))
    again.increments = 4
    assert again.first_increment == 0.25
    moving = ct.Dynamic(period=1.0)
    moving.increments = 8
    assert (moving.first_increment, moving.fixed_increments) == (0.125, True)
    end = ct.ArcLength()
    end.displacement = ("right", "y", 1.0)
    assert end.factor is None


def test_wrong_settings_after_construction_are_refused() -> None:
    step = ct.Static()
    with pytest.raises(ct.InputError, match="at_limit"):
        step.at_limit = "go on"  # type: ignore[assignment]
    with pytest.raises(ct.InputError, match="period"):
        step.period = -1.0
    assert step.period == 1.0
    with pytest.raises(AttributeError, match="no setting 'increment'"):
        step.increment = 5  # type: ignore[attr-defined]


def test_one_direction_of_zero_warns_that_both_are_fixed() -> None:
    found = ct.Model(MESH)
    with pytest.warns(UserWarning, match="fixes y as well; write y=None"):
        found.fix("left", x=0.0)
    with pytest.warns(UserWarning, match="fixes x as well; write x=None"):
        found.fix("left", y=0)
    found.fix("left")
    found.fix("left", x=0.0, y=None)
    found.fix("left", x=0.0, y=0.0)
    found.fix("left", x=0.1)

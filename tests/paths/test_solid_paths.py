"""Paths of solid models against exact beam solutions and against themselves.

The beam values come from the differential equations of extensible shear-flexible beams, solved
to seven digits; a solid differs from them at corners and supports, hence two percent.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import corota as ct
from support.frames import column, deep_arch, lee_frame, node_at, williams_toggle

#: Solid against beam.
SOLID = 0.02
#: Points on the same path, found with Newton's tolerance at different conditioning.
SAME = 1e-6


def limits(results):
    """Load factors of the limit points."""
    assert {p.kind for p in results.critical_points} == {"limit"}
    return [p.factor for p in results.critical_points]


@pytest.fixture(scope="module")
def lee():
    model, node = lee_frame()
    path = ct.ArcLength(displacement=(node, "y", -62.0))
    return ct.solve(model, ct.Static(path=path), fields=False), node


def test_lee_frame_has_the_limit_points_of_the_exact_beam(lee):
    """Timoshenko beam: 1.8544527 at (26.878, 48.754), -.93924896 at (90.177, 58.225)."""
    results, node = lee
    assert limits(results) == pytest.approx([1.8544527, -0.93924896], rel=SOLID)
    first, second = (results.frames[p.increment].U[node] for p in results.critical_points)
    assert first == pytest.approx([26.87833, -48.75424], rel=SOLID)
    assert second == pytest.approx([90.17700, -58.22496], rel=SOLID)
    assert [p.negative for p in results.critical_points] == [(0, 1), (1, 0)]


def test_lee_frame_snaps_back(lee):
    """The loaded point moves up again while the load falls."""
    results, node = lee
    down = -results.history("U2", at=[node]).values
    factor = results.history("load factor").values
    back = (np.diff(down) < 0.0) & (np.diff(factor) < 0.0)
    assert back.any()


def test_each_equilibrium_tells_its_stability(lee):
    results, _ = lee
    first, second = (p.increment for p in results.critical_points)
    stable = results.history("stable").values
    assert stable[1 : first + 1].all()
    assert not stable[first + 1 : second + 1].any()
    assert stable[second + 1 :].all()


@pytest.mark.parametrize("first", [2.0, 0.3, 0.002])
def test_the_same_path_whatever_the_first_increment(lee, first):
    """Limit points agree, and points lie on the other path: interpolated there."""
    results, node = lee
    model, _ = lee_frame()
    path = ct.ArcLength(displacement=(node, "y", -62.0))
    other = ct.solve(model, ct.Static(path=path, first_increment=first), fields=False)
    assert limits(other) == pytest.approx(limits(results), rel=SAME)
    # At the displacement of a point, the other path has its load: solved for by control.
    for value in (-20.0, -45.0):
        loads = []
        for start in (None, first):
            step = ct.Static(
                path=ct.ArcLength(displacement=(node, "y", value)), first_increment=start or 0.0
            )
            loads.append(ct.solve(model, step, fields=False).frames[-1].factor)
        assert loads[0] == pytest.approx(loads[1], rel=SAME)


def test_meters_and_millimeters_give_the_same_path(lee):
    results, node = lee
    model, _ = lee_frame(scale=1e-3)
    path = ct.ArcLength(displacement=(node, "y", -0.062))
    other = ct.solve(model, ct.Static(path=path), fields=False)
    assert len(other.frames) == len(results.frames)
    assert limits(other) == pytest.approx(limits(results), rel=SAME)
    for one, two in zip(results.frames, other.frames, strict=True):
        assert one.U[node] == pytest.approx(1e3 * two.U[node], rel=1e-4, abs=1e-4)


def test_spherical_arcs_follow_the_same_path(lee):
    results, node = lee
    model, _ = lee_frame()
    path = ct.ArcLength(displacement=(node, "y", -62.0), shape="spherical")
    other = ct.solve(model, ct.Static(path=path), fields=False)
    assert limits(other) == pytest.approx(limits(results), rel=SAME)


def test_toggle_has_the_limit_loads_of_the_exact_beam():
    """Timoshenko beam: 33.847716 and 31.246220; deflections of Euler-Bernoulli's."""
    model, apex = williams_toggle()
    path = ct.ArcLength(displacement=(apex, "y", -0.7))
    results = ct.solve(model, ct.Static(path=path), fields=False)
    assert limits(results) == pytest.approx([33.847716, 31.246220], rel=SOLID)
    drops = [-results.frames[p.increment].U[apex, 1] for p in results.critical_points]
    assert drops == pytest.approx([0.2321569, 0.3915943], rel=SOLID)


def test_deep_arch_has_the_limit_load_of_the_exact_beam():
    """8.973 EI/R^2 at (-61.14, 113.73), then -.73055 EI/R^2."""
    model, crown = deep_arch(load=1000.0)
    path = ct.ArcLength(displacement=(crown, "y", -124.0))
    results = ct.solve(model, ct.Static(path=path), fields=False)
    assert limits(results) == pytest.approx([0.897289, -0.073055], rel=SOLID)
    first = results.frames[results.critical_points[0].increment]
    assert first.U[crown] == pytest.approx([-61.14168, -113.73065], rel=SOLID)


def elastica(load: float) -> tuple[float, float]:
    """Deflection and shortening over length of a cantilever column; load over Euler's."""
    k = brentq(lambda k: (2.0 / np.pi * ellipk(k * k)) ** 2 - load, 1e-9, 1.0 - 1e-9)
    return 2.0 * k / ellipk(k * k), 2.0 - 2.0 * ellipe(k * k) / ellipk(k * k)


@pytest.mark.parametrize("side", [1, -1])
def test_column_leaves_its_axis_along_the_elastica(side):
    """Post-buckling of the Euler column by branch switching."""
    model = column("Q8", n=40)
    tip = node_at(model.mesh, 100.0, 1.0)
    path = ct.ArcLength(displacement=([tip], "y", 70.0 * side), switch=True, side=side)
    results = ct.solve(model, ct.Static(path=path), fields=False)
    critical = results.critical_points[0]
    assert critical.kind == "bifurcation"
    assert np.abs(critical.mode[:, 1]).max() == pytest.approx(1.0)
    checked = 0
    for frame in results.frames[critical.increment + 1 :]:
        load = frame.factor / critical.factor
        if load > 1.02:
            deflection, shortening = elastica(load)
            assert side * frame.U[tip, 1] == pytest.approx(100.0 * deflection, rel=5e-3)
            assert -frame.U[tip, 0] == pytest.approx(100.0 * shortening, rel=2e-2)
            assert frame.scalars["stable"] == 1.0
            checked += 1
    assert checked >= 3


def test_loads_follow_each_other_with_a_constant_preload():
    """The preload stays while the second step's load makes the path."""
    from corota.model.loads import NodalForce

    model, apex = williams_toggle(load=0.0)
    preload = ct.Static(loads=[NodalForce(np.array([apex]), 1, -5.0)])
    path = ct.ArcLength(displacement=(apex, "y", -0.7))
    push = ct.Static(path=path, loads=[NodalForce(np.array([apex]), 1, -6.0)])
    results = ct.solve(model, [preload, push], fields=False)
    # Half loads: from 5 the second step goes 1 further at factor one.
    total = [2.0 * (5.0 + f) for f in limits(results)]
    assert total == pytest.approx([33.862, 31.276], rel=1e-4)
    last = results.frames[-1]
    assert last.F[apex, 1] == pytest.approx(-(5.0 + last.factor))


def test_a_moving_support_snaps_with_its_factor():
    """The toggle's apex pushed by a support gives the reaction of the loaded one."""
    model, apex = williams_toggle(load=0.0)
    model.fix([apex], x=None, y=-0.5)
    results = ct.solve(model, ct.Static(path=ct.ArcLength(increments=15)), fields=False)
    reaction = [-2.0 * f.RF[apex, 1] for f in results.frames]
    drop = [-f.U[apex, 1] for f in results.frames]
    other, _ = williams_toggle()
    for force, w in list(zip(reaction, drop, strict=True))[3:12:4]:
        step = ct.Static(path=ct.ArcLength(displacement=(apex, "y", -w)))
        assert ct.solve(other, step, fields=False).frames[-1].factor == pytest.approx(
            force, rel=1e-6
        )


def test_following_pressure_is_followed_and_said_to_be_non_conservative():
    """An unsymmetric tangent: the path agrees with load control at the full load."""
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=20, ny=1, cell="quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.pressure("top", 1.5)
    by_load = ct.solve(model, ct.Static(), fields=False).frames[-1]
    results = ct.solve(model, ct.Static(path=ct.ArcLength()), fields=False)
    assert results.frames[-1].factor == 1.0
    assert pytest.approx(by_load.U, abs=1e-6) == results.frames[-1].U
    assert "stable" not in results.frames[-1].scalars
    assert any("non-conservative" in note for note in results.notes)


def test_load_control_ends_at_the_limit_point_with_the_reason():
    model, _ = lee_frame(load=3.0)
    with pytest.raises(ct.ConvergenceError, match=r"limit point at load factor 0\.62") as caught:
        ct.solve(model, ct.Static(increments=10), fields=False)
    results = caught.value.results
    assert results.frames[-1].factor == pytest.approx(1.8544527 / 3.0, rel=SOLID)
    assert results.frames[-1].scalars["limit point"] == 1.0


def test_load_control_goes_on_by_arc_length_when_asked():
    model, _ = lee_frame(load=3.0)
    step = ct.Static(increments=10, at_limit="follow")
    results = ct.solve(model, step, fields=False)
    assert results.frames[-1].factor == pytest.approx(1.0)
    assert len(results.critical_points) == 2


def test_displacement_control_of_a_combination(lee):
    """The rotation of a section as a difference of two displacements."""
    model, apex = williams_toggle()
    left = node_at(model.mesh, 12.943 / 2.0, 0.386 / 2.0)
    control = ct.DisplacementControl([apex], "y", -0.3, also=[([left], "y", -1.0)])
    results = ct.solve(model, ct.Static(path=control), fields=False)
    last = results.frames[-1]
    assert last.U[apex, 1] - last.U[left, 1] == pytest.approx(-0.3)


def test_a_step_after_a_path_keeps_the_load_that_was_reached():
    model, apex = williams_toggle(load=20.0)
    steps = [ct.Static(path=ct.ArcLength(factor=0.5)), ct.Static()]
    results = ct.solve(model, steps, fields=False)
    before = next(f for f in reversed(results.frames) if f.step == 1)
    last = results.frames[-1]
    assert last.step == 2
    assert last.F[apex, 1] == pytest.approx(-5.0)
    assert last.U[apex] == pytest.approx(before.U[apex], rel=1e-8)
    assert (np.diff(results.times) > 0.0).all()


def test_plastic_path_goes_on_from_what_was_committed():
    """Attempts and located points leave no plastic strain: small arcs give the same path."""
    found = []
    for first, largest in ((0.05, 0.0), (0.01, 0.02)):
        model, apex = williams_toggle(load=33.0, cells=10)
        curve = [(8e3, 0.0), (18e3, 0.01)]
        model.sections[0].material = ct.Mises(E=1.03e7, nu=0.3, yield_curve=curve)
        path = ct.ArcLength(displacement=(apex, "y", -0.3))
        step = ct.Static(path=path, first_increment=first, largest_increment=largest)
        results = ct.solve(model, step)
        assert results.frames[-1].fields[0].values["PEEQ"].max() > 1e-4
        found.append([p.factor for p in results.critical_points])
    assert len(found[0]) == len(found[1]) == 1
    # Plastic strain is integrated with the increments: first order, not to Newton's tolerance.
    assert found[0] == pytest.approx(found[1], rel=2e-3)


def test_bad_paths_are_refused():
    model, apex = williams_toggle()
    with pytest.raises(ct.InputError, match="shape"):
        ct.ArcLength(shape="cubic")
    with pytest.raises(ct.InputError, match="no degree of freedom 'z'"):
        ct.DisplacementControl([apex], "z", 1.0)
    with pytest.raises(ct.InputError, match="no rotation"):
        ct.solve(model, ct.Static(path=ct.DisplacementControl([apex], "rotation", 1.0)))
    with pytest.raises(ct.ModelError, match="nothing in it grows"):
        ct.solve(model, [ct.Static(), ct.Static(path=ct.ArcLength())])
    model.amplitudes["A"] = ct.Amplitude([0.0, 1.0], [0.0, 1.0])
    model.loads[0].amplitude = "A"
    with pytest.raises(ct.ModelError, match="amplitude 'A'"):
        ct.solve(model, ct.Static(path=ct.ArcLength()))


def test_pivots_that_are_not_counted_make_no_critical_point():
    """A following pressure beside a force: symmetric at rest, and never again."""
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1, cell="quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.pressure("top", 0.2)
    model.force([node_at(mesh, 10.0, 1.0)], y=-0.1)
    results = ct.solve(model, ct.Static(path=ct.ArcLength()), fields=False)
    assert results.critical_points == []
    assert not any("bifurcation" in note for note in results.notes)

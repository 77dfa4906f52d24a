"""Measures of stages beside closed forms; the same in memory, in files and in tables."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import corota as ct
from corota.results.measures import MEASURES, StagePath, measure_values
from corota.sweeps.measures import Measure
from support.flexures import bar_load, cross_spring, parallelogram, snap_through


def pushed(steps: list[ct.Static]) -> ct.Results:
    """The truss of two bars, pushed through and pulled back."""
    model = snap_through()
    model.stage("apex", axis=(0.0, -1.0))
    for step, depth in zip(steps, (4.5, 0.0), strict=False):
        step.fix("apex", y=-depth, x=None)
    return ct.solve(model, steps, threads=1)


@pytest.fixture(scope="module")
def through() -> ct.Results:
    return pushed([ct.Static(increments=90), ct.Static(increments=90)])


def last(results: ct.Results, name: str, at: str | None = None) -> float:
    return float(results.history(name, at=at)[-1])


def test_snap_through_of_two_bars(through: ct.Results) -> None:
    travel = through.history("travel", at="apex")
    assert np.allclose(through.history("load", at="apex"), bar_load(travel.values), atol=1e-9)
    top = minimize_scalar(lambda s: -bar_load(s), bounds=(0.0, 2.0), method="bounded")
    energy = 0.5 * 1000.0 / np.hypot(10, 2) * (np.hypot(10, 2) - 10.0) ** 2
    wanted = {
        "snap travel": top.x,
        "snap load": -top.fun,
        "return travel": 4.0 - top.x,
        "return load": top.fun,
        "switching travel": 2.0,
        "second equilibrium": 4.0,
        "switching energy": energy,
        "return energy": energy,
        # Against the motion, in and out.
        "insertion load": float(bar_load(np.array(4.5))),
        "retention load": -top.fun,
        "largest load": float(bar_load(np.array(4.5))),
    }
    for name, value in wanted.items():
        assert last(through, name) == pytest.approx(value, rel=2e-3), name
    # Known only once they are passed.
    snap = through.history("snap load").values
    passed = int(np.flatnonzero(np.isfinite(snap))[0])
    assert travel[passed - 1] <= top.x + 0.05 < travel[passed] + 0.1
    assert (snap[passed:] == snap[passed]).all()


def test_heat_before_the_push_does_not_turn_the_sense() -> None:
    """Hot bars bulge without load, against the travel; the push through them begins there."""
    model = snap_through()
    for section in model.sections:
        section.material = ct.Elastic(E=1000.0, nu=0.3, expansion=0.004)
    model.stage("apex", axis=(0.0, -1.0))
    model.fix("apex", x=0.0, y=None)
    heat, push = ct.Static(), ct.Static(increments=90)
    heat.temperature(1.0)
    push.fix("apex", x=None, y=-3.7)
    results = ct.solve(model, [heat, push], threads=1)

    def load(s: float) -> float:
        rise, long = 2.0 - s, np.hypot(10.0, 2.0)
        return 1000.0 * (1.004 / np.hypot(10.0, rise) - 1.0 / long) * rise

    top = minimize_scalar(lambda s: -load(s), bounds=(-0.2, 2.0), method="bounded")
    wanted = {
        "snap travel": top.x,
        "snap load": -top.fun,
        "return travel": 4.0 - top.x,
        "return load": top.fun,
        "switching travel": 2.0,
        "insertion load": -top.fun,
    }
    for name, value in wanted.items():
        assert last(results, name) == pytest.approx(value, rel=5e-3), name


def test_limit_load_of_coarse_increments_is_that_of_a_parabola() -> None:
    coarse = pushed([ct.Static(increments=15)])
    top = minimize_scalar(lambda s: -bar_load(s), bounds=(0.0, 2.0), method="bounded")
    assert last(coarse, "snap load") == pytest.approx(-top.fun, rel=1e-2)
    assert coarse.history("load").values[:7].max() < last(coarse, "snap load")


def test_pivot_of_crossed_leaves() -> None:
    """Rotation and shift of the crossing, see REFERENCE in test_joints; here the other measures."""
    model = cross_spring()
    model.force(["hub"], moment=0.712016)
    model.stage("hub", axis="rotation")
    results = ct.solve(model, ct.Static(increments=16), threads=1)
    assert last(results, "axis stiffness") == pytest.approx(
        np.gradient(results.history("load").values, results.history("travel").values)[-2], rel=0.03
    )
    assert float(results.history("axis stiffness")[0]) == pytest.approx(2.0, rel=1e-6)
    # Driven by a moment it turns about the elastic center.
    for axis in "xy":
        near = results.history(f"elastic center {axis}").values
        assert results.history(f"instant center {axis}").values[2:] == pytest.approx(
            near[2:], abs=1e-4
        )
    shift = np.hypot(
        results.history("instant center x").values, results.history("instant center y").values
    )
    assert results.history("center shift").values[1:] == pytest.approx(shift[1:])
    assert last(results, "parasitic translation") == pytest.approx(
        np.hypot(last(results, "motion x"), last(results, "motion y"))
    )
    # The softest translation and the stiffness of the leaves along the axes at the start.
    assert float(results.history("lateral stiffness")[0]) == pytest.approx(
        float(results.history("stiffness xx")[0]), rel=1e-3
    )
    ratio = results.history("stiffness ratio").values
    assert ratio == pytest.approx(
        results.history("lateral stiffness").values / results.history("axis stiffness").values
    )
    assert last(results, "work") == pytest.approx(last(results, "strain energy"), rel=2e-3)


def test_parallelogram_by_beam_theory() -> None:
    """Two leaves of length L: 24 EI / L^3, shortened by 3/5 d^2 / L, turned by their stretch."""
    model = parallelogram("Q4I")
    model.force("stage", x=0.25 / len(model.mesh.nodes_of("stage")))
    model.stage("stage", axis="x")
    results = ct.solve(model, ct.Static(increments=4), threads=1)
    leaf = 1e4 * 0.5**3 / 12.0
    assert float(results.history("axis stiffness")[0]) == pytest.approx(24 * leaf / 1e3, rel=0.03)
    moved = last(results, "travel")
    assert last(results, "parasitic translation") == pytest.approx(-0.6 * moved**2 / 10, rel=0.05)
    # The stage does not turn at first: its leaves lengthen and shorten by the moment of the load.
    turn = float(results.history("rotation coupling")[0])
    # Load at the middle of the stage, 5.5 above the middle of the leaves.
    stretch = 2.0 * (10.0 / (1e4 * 0.5)) / 6.5**2
    assert turn == pytest.approx(-24 * leaf / 1e3 * 5.5 * stretch, rel=0.1)


def test_instant_center_of_a_body_that_turns_about_a_point() -> None:
    about, reference = np.array([3.0, -1.0]), np.array([0.5, 0.25])
    path = StagePath(np.array([0.0, 0.0, 1.0]), reference)
    unknown = np.full((3, 3), np.nan)
    for angle in np.linspace(0.0, 3.0 * np.pi, 40):
        cos, sin = np.cos(angle), np.sin(angle)
        moved = np.array([[cos, -sin], [sin, cos]]) @ (reference - about) + about
        # The fit of a rotation has no whole turns.
        motion = np.append(moved - reference, np.arctan2(sin, cos))
        path.add(motion, np.zeros(3), unknown, np.eye(3), np.full(4, np.nan))
        values = measure_values(path)
        if len(path.motion) == 2:  # the center of the finite rotation
            assert values["instant center x"] == pytest.approx(3.0, abs=1e-12)
        if len(path.motion) > 1:
            assert values["center shift"] == pytest.approx(np.hypot(2.5, 1.25), rel=0.05)
    assert values["rotation"] == pytest.approx(3.0 * np.pi)


def test_lever() -> None:
    """An elastic lever 1 : 2 lifts a dead load: what it stores it does not give."""
    n, long, short = 12, 2.0, 1.0
    x = np.linspace(-short, long, 3 * n + 1)
    cells = ct.Cells("line2", np.column_stack([np.arange(3 * n), np.arange(1, 3 * n + 1)]),
                     np.arange(1, 3 * n + 1))  # fmt: skip
    model = ct.Model(ct.Mesh(np.column_stack([x, np.zeros_like(x)]), [cells]))
    model.beam(np.arange(3 * n), material=ct.Elastic(E=1e6, nu=0.0), area=1.0, inertia=1e-3)
    model.fix([n])
    model.fix([0], y=-0.01, x=None)
    model.force([3 * n], y=-4.0)
    model.stage("handle", [0], axis=(0.0, -1.0))
    model.stage("load", [3 * n], axis="y", input="handle")
    results = ct.solve(model, ct.Static(increments=3, nlgeom=False), threads=1)
    assert last(results, "force ratio", "load") == pytest.approx(0.5, rel=1e-9)
    bend = 4.0 * long**2 * (long + short) / (3.0 * 1e3)
    assert last(results, "travel", "load") == pytest.approx(0.02 - bend, rel=1e-6)
    assert last(results, "transmission ratio", "load") == pytest.approx(2.0 - bend / 0.01, rel=1e-6)
    given = 0.5 * 4.0 * (0.02 - bend)
    stored = last(results, "strain energy")
    assert last(results, "efficiency", "load") == pytest.approx(given / (given + stored), rel=1e-6)


def test_travel_to_an_allowable_and_its_place() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.0))
    model.fix("left", y=None)
    model.fix(ct.near(0.0, 0.0))
    model.fix("right", x=0.5, y=None)
    limits = {"MISES": 20.0, "EP1": 0.04, "fatigue": (10.0, 100.0)}
    for name, limit in limits.items():
        model.stage(name, "right", axis="x", allowable={name: limit}, stiffness=False)
    model.stage("all of them", "right", axis="x", allowable=limits, stiffness=False)
    results = ct.solve(model, ct.Static(increments=7, nlgeom=False), threads=1)
    # A bar in tension of s = 100 d: amplitude and mean of the cycle are s / 2.
    goodman = 1.0 / (0.5 * 100.0 / 10.0 + 0.5 * 100.0 / 100.0)
    reached = {"MISES": 0.2, "EP1": 0.4, "fatigue": goodman, "all of them": goodman}
    for name, travel in reached.items():
        assert last(results, "travel to allowable", name) == pytest.approx(travel, rel=1e-9)
        assert last(results, "utilization", name) == pytest.approx(0.5 / travel, rel=1e-9)
        assert last(results, "safety factor", name) == pytest.approx(travel / 0.5, rel=1e-9)
    assert "MISES: stiffness xx" not in results.frames[-1].scalars


def test_place_of_the_allowable_is_the_foot_of_a_cantilever() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.0))
    model.fix("left")
    model.fix("right", x=None, y=-0.5)
    model.stage("right", axis="y", allowable={"SP3": 1.0})
    results = ct.solve(model, ct.Static(increments=4), threads=1)
    low = results.extremes("SP3", at="nodes").smallest
    assert low.value < results.extremes("SP3").smallest.value
    assert last(results, "utilization") == pytest.approx(abs(low.value))
    assert last(results, "utilization element") in (1, 21)
    assert (last(results, "utilization x"), last(results, "utilization y")) == (low.x, low.y)
    assert last(results, "allowable x") < 1.0


@pytest.mark.parametrize(("element", "rows"), [("Q4I", 1), ("Q4I", 3), ("Q8R", 1), ("Q4D", 2)])
def test_margin_is_that_of_the_surface(element: str, rows: int) -> None:
    """Pure bending of a strip: E θ h / 2 L at the surface, where no quadrature point is."""
    kind: Any = "quad8" if element == "Q8R" else "quad4"
    drills = element == "Q4D"
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=rows, cell=kind))
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.0))
    model.fix("left", y=None, rotation=drills or None)
    model.fix(ct.near(0.0, 0.5 if rows % 2 == 0 or kind == "quad8" else 0.0))
    for node in model.mesh.node_indices("right"):
        height = model.mesh.points[node, 1] - 0.5
        model.fix([int(node)], x=-0.1 * height, y=None, rotation=0.1 if drills else None)
    model.stage("right", axis="y", allowable={"MISES": 10.0}, stiffness=False)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    # The turn of .1 over a length of 10 strains the surface by .005.
    assert last(results, "utilization") == pytest.approx(0.5)


@pytest.fixture(scope="module")
def everything() -> ct.Results:
    """A run in which every measure has a value: the truss, and a cantilever beside it."""
    block = ct.mesh.move(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2), (20.0, 0.0))
    bar = ct.Cells("line2", np.array([[0, 1]]), np.array([1]))
    mesh = ct.mesh.merge(ct.Mesh(np.array([[0.0, 0.0], [10.0, 2.0]]), [bar]), block)
    apex = ct.mesh.add_node(mesh, 10.0, 2.0, "apex")
    model = ct.Model(mesh, "both")
    model.truss([0], material=ct.Elastic(E=1000.0, nu=0.0), area=1.0)
    model.section(np.arange(1, mesh.n_cells), element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix(ct.near(0.0, 0.0))
    model.rigid([1], apex)
    model.fix("apex", x=0.0, y=None, rotation=0.0)
    model.fix("left")
    model.force("right", x=0.1, y=-0.8)
    model.stage("apex", axis=(0.0, -1.0))
    model.stage("end", "right", axis="y", input="apex", allowable={"MISES": 10.0})
    model.stage("turned", "right", axis="rotation")
    first, second = ct.Static(increments=18), ct.Static(increments=6)
    first.fix("apex", y=-4.5, x=None)
    second.fix("apex", y=-4.0, x=None)
    return ct.solve(model, [first, second], threads=1)


def test_the_table_is_complete(everything: ct.Results) -> None:
    found = {name.partition(": ")[2] for f in everything.frames for name in f.scalars}
    assert set(MEASURES) <= found


@pytest.mark.parametrize("name", MEASURES)
def test_memory_file_and_table_agree(
    everything: ct.Results, files: tuple[ct.Results, dict[str, np.ndarray]], name: str
) -> None:
    read, table = files
    for stage in ("apex", "end", "turned"):
        key = f"{stage}: {name}"
        if not any(key in frame.scalars for frame in everything.frames):
            continue
        here = everything.history(name, at=stage).values
        assert np.array_equal(here, read.history(name, at=stage).values, equal_nan=True)
        assert np.array_equal(here, read.history(key).values, equal_nan=True)
        assert np.allclose(here, table[key], rtol=1e-11, atol=0.0, equal_nan=True)
        for text in (f"last({name}@{stage})", f"last('{key}')"):
            assert Measure(text)(everything) == pytest.approx(here[-1], nan_ok=True)
            assert Measure(text)(read) == pytest.approx(here[-1], nan_ok=True)


@pytest.fixture(scope="module")
def files(everything: ct.Results, tmp_path_factory: pytest.TempPathFactory):
    folder: Path = tmp_path_factory.mktemp("measures")
    path = everything.write(folder / "both.csv")
    with open(path, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    table = dict(
        zip(head, np.array([[v or "nan" for v in row] for row in rows], dtype=float).T, strict=True)
    )
    with ct.read_results(everything.write(folder / "both.vtkhdf")) as read:
        yield read, table


def test_names_without_a_stage(everything: ct.Results, through: ct.Results) -> None:
    assert Measure("snap load")(through) == last(through, "snap load", "apex")
    assert Measure("absmax(return load) / 2")(through) == pytest.approx(
        abs(last(through, "return load")) / 2
    )
    with pytest.raises(ct.InputError, match="apex, end, turned"):
        everything.history("snap load")
    model = snap_through()
    model.fix("apex", y=-0.1, x=None)
    bare = ct.solve(model, ct.Static(), threads=1)
    with pytest.raises(ct.InputError, match=r"no stage; define it before"):
        bare.history("travel", at="apex")


def test_a_near_name_of_a_measure_is_suggested(through: ct.Results) -> None:
    with pytest.raises(ct.InputError, match=r"measures of stages: .*snap load"):
        through.history("snap force")


def test_scalars_with_blanks_and_colons_are_measures(through: ct.Results) -> None:
    (name,) = [s for s in through.scalar_names() if s.endswith(": snap load")]
    for text in (f"last({name})", "last(snap load)", f"last('{name}')"):
        assert Measure(text)(through) == last(through, "snap load")


def test_axes_of_curves_have_names_with_blanks(through: ct.Results, tmp_path: Path) -> None:
    figure = through.history("load").plot(against=through.history("travel"))
    assert figure.axes[0].get_xlabel().startswith("apex: travel")
    path = tmp_path / "curve.svg"
    through.history("load factor").plot(against="apex: axis stiffness", path=path)
    assert path.stat().st_size


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"axis": "z"}, "'x', 'y', 'rotation' or a direction"),
        ({"axis": (0.0, 0.0)}, "no length"),
        ({"axis": "x", "input": "motor"}, "define the stage 'motor'"),
        ({"axis": "x", "allowable": {"fatigue": 3.0}}, r"\(endurance, ultimate\)"),
        ({"axis": "x", "allowable": {"MISES": 0.0}}, "one number > 0"),
    ],
)
def test_bad_stages_are_refused(options: dict, message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        parallelogram().stage("stage", **options)


def test_unknown_variables_of_an_allowable_are_refused() -> None:
    model = parallelogram()
    model.stage("stage", axis="x", allowable={"MISSES": 3.0})
    with pytest.raises(ct.InputError, match="no variable 'MISSES'"):
        ct.solve(model, threads=1)
    model = parallelogram()
    model.stage("corner", ct.near(0.0, 10.0), axis="x")
    with pytest.raises(ct.InputError, match="two nodes at different places"):
        ct.solve(model, threads=1)


def test_stage_as_text() -> None:
    model = parallelogram()
    model.add_stage("stage axis=1,0.5 point=0,3 MISES=40 fatigue=10,20 stiffness=no")
    stage = model.stages[0]
    assert stage.point == (0.0, 3.0)
    assert stage.allowable == {"MISES": 40.0, "fatigue": (10.0, 20.0)}
    assert not stage.stiffness
    assert stage.direction == pytest.approx(np.array([2.0, 1.0, 0.0]) / 5**0.5)
    for text, message in {
        "stage": "name the wanted motion",
        "stage axis=q": "needs numbers",
        "stage axis": "KEY=VALUE",
    }.items():
        with pytest.raises(ct.InputError, match=message):
            parallelogram().add_stage(text)

"""Stops say what stopped, where, and the way out; each has its exit code."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora.contact_case_models import collapse
from corota.analysis.procedures.path.branches import BranchTracer
from corota.analysis.procedures.path.plan import PathStalled
from corota.analysis.procedures.stopping import plateau
from corota.cli import main
from corota.model.paths import CriticalPoint
from corota.model.steps import Static
from support.lines import lines
from support.models import cell
from support.pairs import cover

DECKS = Path(__file__).parent / "decks"


@pytest.mark.parametrize("name", ["explicit_element_failure", "recover_nan"])
def test_elements_beyond_sense_are_no_internal_error(name, tmp_path, capsys):
    shutil.copy(DECKS / f"{name}.inp", tmp_path / "job.inp")
    code = main(["run", str(tmp_path / "job.inp"), "--output", str(tmp_path), "--quiet"])
    text = capsys.readouterr().err
    assert code == 4, text
    assert "element " in text
    assert "internal error" not in text


@pytest.mark.parametrize("element", ["T3", "Q4I", "Q4D", "Q8"])
@pytest.mark.parametrize("wrong", ["stress", "tangent"])
def test_a_user_material_that_gives_no_number_cuts_back_and_is_named(element, wrong):
    c = np.array([[1000.0, 300.0, 0.0], [300.0, 1000.0, 0.0], [0.0, 0.0, 350.0]])

    def law(strain, state, plane):
        bad = np.nan if np.abs(strain).max() > 1e-4 else 1.0
        stress = (strain @ c) * (bad if wrong == "stress" else 1.0)
        tangent = np.broadcast_to(c, (*strain.shape, 3)) * (bad if wrong == "tangent" else 1.0)
        return stress, tangent, state

    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 1, cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.UserMaterial(law))
    model.fix("left", rotation=True)
    model.force("right", x=1.0, per_node=True)
    with pytest.raises(ct.ConvergenceError, match=r"material function .* not a number"):
        ct.solve(model, Static(), threads=1)


@pytest.mark.parametrize(("element", "share"), [("T6", 0.1), ("Q8", 0.2), ("Q9", 0.85)])
def test_mid_side_nodes_beyond_the_quarter_points_are_refused(element, share):
    mesh = ct.mesh.rectangle(1.0, 1.0, 1, 1, cell(element))
    points = mesh.points.copy()
    middle = np.flatnonzero((points == [0.5, 0.0]).all(axis=1))
    points[middle, 0] = share
    mesh.points = points
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=0.3))
    model.fix("left")
    with pytest.raises(ct.errors.ModelError, match=r"mid-side node \d+ lies at"):
        ct.solve(model, Static(), threads=1)
    points[middle, 0] = 0.25  # as in elements at the tip of a crack
    mesh.points = points
    ct.solve(model, Static(), threads=1)


def bar_beyond_its_limit(element, local_strain=None):
    """Bar 4 x 1 of a perfectly plastic material under 1.15 times its limit load."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
    material = ct.Mises(E=2e5, nu=0.3, yield_stress=200.0)
    model.section("all", element=element, material=material, local_strain=local_strain)
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    model.traction("right", x=230.0)
    return model


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S"])
def test_collapse_of_a_bar_that_thins_is_its_limit_point(element):
    """The Kirchhoff stress yields at 200: the load is 200 exp(-200 / E) and falls in flow.

    All elements yield at once, so that the tangent has several soft modes there; in Q4I the path
    passed the limit as a bifurcation and the step ended far behind it, at a sixteenth of the load.
    """
    model, step = bar_beyond_its_limit(element), Static(first_increment=0.2)
    with pytest.raises(ct.ConvergenceError, match=r"limit point .*plastic collapse") as error:
        ct.solve(model, step, threads=1, fields=False)
    results = error.value.results
    exact = 200.0 / 230.0 * np.exp(-200.0 / 2e5)
    assert results.frames[-1].factor == pytest.approx(exact, rel=1e-6)
    assert [p.kind for p in results.critical_points] == ["limit"]


@pytest.mark.parametrize("at_limit", ["stop", "follow"])
def test_plastic_collapse_is_named_with_its_load(at_limit):
    """Limit load of a bar: yield stress times area, 200 of 230 (closed form).

    The linear local strain has the undeformed area: there the load stays constant in flow.
    """
    model = bar_beyond_its_limit("Q4I", "linear")
    step = Static(first_increment=0.2, at_limit=at_limit)
    with pytest.raises(ct.ConvergenceError, match="plastic collapse: the limit load") as error:
        ct.solve(model, step, threads=1, fields=False)
    last = error.value.results.frames[-1].factor
    assert last == pytest.approx(200.0 / 230.0, rel=2e-3)
    assert f"at load factor {last:.6g}" in str(error.value)


@pytest.mark.slow
def test_collapse_is_named_where_all_stiffness_goes_at_once():
    """A strip over a drum without friction, pulled to twice its yield force of 50.

    Its straight parts yield all at once. Up to there displacements grow 7 times as fast as at
    first, in the last increments no faster than at first, as nothing flows in so short ones. With
    flow behind them the tangent has a negative pivot.
    """
    model, steps = collapse("Q8R", 60, "node_to_segment")
    with pytest.raises(ct.ConvergenceError, match="plastic collapse: the limit load") as error:
        ct.solve(model, steps, threads=1, fields=False)
    assert error.value.results.frames[-1].factor == pytest.approx(0.5, rel=0.01)


def frame_beam(curve=((250.0, 0.0),), end="fixed", n=4):
    """Beam of length 200 and plastic moment 500, fixed at the left, with a force in the middle.

    The force reaches 1.5 times the collapse load of perfect plasticity at 250.
    """
    model = ct.Model(
        lines([(200.0 * i / n, 0.0) for i in range(n + 1)], ("line2", [*pairwise(range(n + 1))]))
    )
    steel = ct.Mises(E=200e3, nu=0.3, yield_curve=list(curve))
    model.beam(np.arange(n), material=steel, profile=ct.profiles.rectangle(2.0, 2.0))
    model.fix([0], rotation=True)
    if end == "fixed":
        model.fix([n], rotation=True)
    else:
        model.fix([n], x=None, y=0.0)
    # The mechanism: 4 M (kinks at both ends and twice in the middle) or 3 M, over half the length.
    model.force([n // 2], y=-1.5 * (4.0 if end == "fixed" else 3.0) * 500.0 / 100.0)
    return model


@pytest.mark.parametrize(
    ("end", "at_limit"), cover(["fixed", "propped"], ["stop", "follow"], strength=1)
)
def test_a_path_ends_where_the_load_does_not_grow(end, at_limit):
    """Linear geometry, perfect plasticity: the collapse load by its mechanism.

    There the load stays the same for ever. The path followed it for 955 increments, to
    displacements 1e8 times too large.
    """
    with pytest.raises(ct.ConvergenceError, match="plastic collapse: the limit load") as error:
        ct.solve(
            frame_beam(end=end), Static(nlgeom=False, at_limit=at_limit), threads=1, fields=False
        )
    frames = error.value.results.frames
    # Fibers of a section reach its plastic moment but for the last ones.
    assert frames[-1].factor == pytest.approx(2.0 / 3.0, rel=5e-3)
    assert len(frames) < 50
    assert np.abs(frames[-1].U).max() < 100.0
    assert "times as fast" not in str(error.value)


@pytest.mark.parametrize("isotropic", [0.0, 2.0])
@pytest.mark.parametrize("nlgeom", [False, True])
def test_collapse_of_a_thick_ring(nlgeom, isotropic):
    """Pressure 2/sqrt(3) Y log 2 within, in plane strain (Hill); it thins: a little less."""
    exact = 2.0 / np.sqrt(3.0) * 200.0 * np.log(2.0)
    model = ct.Model(ct.mesh.annulus(1.0, 2.0, 6, 6, 90.0, "quad8"))
    steel = ct.Mises(E=2e5, nu=0.3, yield_stress=200.0, isotropic=isotropic)
    model.section("all", element="Q8R", material=steel, plane="strain")
    model.fix("start", x=None)
    model.fix("end", y=None)
    model.pressure("inner", 1.3 * exact)
    if isotropic and not nlgeom:
        ct.solve(model, Static(nlgeom=False), threads=1, fields=False)
        return
    with pytest.raises(ct.ConvergenceError, match=r"limit point|the limit load") as error:
        ct.solve(model, Static(nlgeom=nlgeom), threads=1, fields=False)
    last = 1.3 * error.value.results.frames[-1].factor
    assert last == pytest.approx(0.993 if nlgeom else 1.0, rel=1e-4)


#: A yield plateau of 24 elastic strains, hardening, and the least of it.
PLATEAU = ((250.0, 0.0), (250.0, 0.03), (500.0, 0.2))
HARDENING = ((250.0, 0.0), (450.0, 0.1))
SLIGHT = ((250.0, 0.0), (450.0, 10.0))


@pytest.mark.parametrize(
    ("end", "curve"), cover(["fixed", "propped"], [PLATEAU, HARDENING, SLIGHT], strength=1)
)
def test_a_path_goes_on_where_the_law_hardens(end, curve):
    model = frame_beam(curve, end)
    results = ct.solve(model, Static(nlgeom=False), threads=1, fields=False)
    assert results.frames[-1].factor == 1.0


def test_a_yield_plateau_counts_up_to_its_end():
    def longest(*curves):
        laws = [ct.Mises(E=200e3, nu=0.3, yield_curve=list(curve)) for curve in curves]
        blocks = [SimpleNamespace(section=SimpleNamespace(material=law)) for law in laws]
        return plateau(SimpleNamespace(blocks=blocks))

    assert longest(((250.0, 0.0),)) == 0.0
    assert longest(HARDENING, PLATEAU) == pytest.approx(24.0)
    assert longest(((250.0, 0.0), (300.0, 0.1), (300.0, 0.2))) == 0.0  # perfect in the end


def test_a_path_without_an_equilibrium_near_its_start_stops_with_its_reason(monkeypatch):
    """Two problems of contact ended with an internal error: the path had no direction yet."""

    def stalls(self):
        raise PathStalled("no equilibrium near the start")
        yield

    monkeypatch.setattr(BranchTracer, "_begin", stalls)
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=0.01)
    with pytest.raises(ct.ConvergenceError, match="no equilibrium near the start"):
        ct.solve(model, ct.Static(path=ct.ArcLength()))


def test_unknown_pivots_are_not_told():
    point = CriticalPoint("limit", 1, 3, 0.5, np.zeros((1, 3)), 0.0, (-1, -1))
    assert "pivots" not in str(point)
    point = CriticalPoint("limit", 1, 3, 0.5, np.zeros((1, 3)), 0.0, (0, 1))
    assert "negative pivots 0 before, 1 after" in str(point)


def test_a_panic_of_the_core_is_an_internal_error(monkeypatch, capsys):
    class PanicException(BaseException):  # the name under which the core's panics come
        pass

    def panics(args, terminal):
        raise PanicException("index out of bounds")

    monkeypatch.setattr("corota.cli.info.run", panics)
    assert main(["info", "none.inp"]) == 70
    assert "please report it" in capsys.readouterr().err

"""Elements that are removed and added in steps, beside closed forms and smaller models."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells, Mesh
from corota.model.contact import RigidCurve

E, RHO = 100.0, 0.2


def bars(nlgeom: bool, material: ct.Mises | None = None) -> ct.Model:
    """Two bars side by side along x, of lengths and areas 1, held at x = 0 and guided."""
    cells = Cells("line2", np.array([[0, 1], [0, 1]]), np.array([1, 2]))
    mesh = Mesh(np.array([[0.0, 0.0], [1.0, 0.0]]), [cells], np.array([1, 2]))
    mesh.cell_sets |= {"a": np.array([0]), "b": np.array([1])}
    model = ct.Model(mesh)
    for name in ("a", "b"):
        model.truss(name, material=material or ct.Elastic(E, 0.0, rho=RHO), area=1.0)
    model.fix([0], x=0.0, y=0.0)
    model.fix([1], x=None, y=0.0)
    for _ in range(3):
        model.steps.append(ct.Static(nlgeom=nlgeom))
    return model


def forces(results: ct.Results) -> list[float]:
    return [float(b.values["S"][0, 0, 0]) for b in results.frames[-1].fields]


@pytest.mark.parametrize("nlgeom", [False, True])
def test_a_bar_that_is_removed_gives_its_force_to_the_other(nlgeom: bool) -> None:
    model = bars(nlgeom)
    model.steps[0].force([1], x=20.0)
    model.steps[1].remove_elements("b")
    results = ct.solve(model, threads=1)
    ends = [f for f in results.frames if f.time in (1.0, 2.0)]
    assert ends[0].U[1, 0] == pytest.approx(0.1, rel=1e-3 if nlgeom else 1e-9)
    assert ends[-1].U[1, 0] == pytest.approx(0.2, rel=1e-9)
    stress = forces(results)
    assert stress[1] == 0.0
    assert stress[0] > 0.0


@pytest.mark.parametrize("nlgeom", [False, True])
def test_a_bar_that_is_added_has_no_strain(nlgeom: bool) -> None:
    """The first carries 20 alone, then both carry 10 more; the second begins as long as it is."""
    model = bars(nlgeom)
    model.steps[0].remove_elements("b")
    model.steps[0].force([1], x=20.0)
    model.steps[1].add_elements("b")
    model.steps[2].force([1], x=30.0)
    results = ct.solve(model, threads=1)
    begin, middle, end = (f.U[1, 0] for f in results.frames if f.time in (1.0, 2.0, 3.0))
    assert (begin, middle) == pytest.approx((0.2, 0.2), rel=1e-9)
    length = 1.0 + begin if nlgeom else 1.0
    assert end - begin == pytest.approx(10.0 / (E + E / length), rel=1e-9)


def test_elements_with_strain_are_as_if_they_had_never_left() -> None:
    model = bars(True)
    model.steps[0].remove_elements("b")
    model.steps[0].force([1], x=20.0)
    model.steps[1].add_elements("b", strain_free=False)
    found = ct.solve(model, threads=1).frames[-1].U[1, 0]
    model = bars(True)
    model.steps[0].force([1], x=20.0)
    assert found == pytest.approx(ct.solve(model, threads=1).frames[-1].U[1, 0], rel=1e-9)


def strip(element: str = "Q4", cells: int = 4) -> ct.Model:
    mesh = ct.mesh.rectangle(float(cells), 1.0, cells, 1)
    mesh.cell_sets["right"] = np.array([cells - 1])
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E, 0.0, rho=RHO))
    return model


@pytest.mark.parametrize("nlgeom", [False, True])
def test_weight_and_pressure_go_with_the_elements(nlgeom: bool) -> None:
    """A hanging strip of 4 loses its last quarter, with the pressure on it."""
    model = strip()
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    model.gravity(1.0, 0.0)
    model.traction("right", x=0.5)
    model.steps = [ct.Static(nlgeom=nlgeom), ct.Static(nlgeom=nlgeom)]
    model.steps[1].remove_elements("right")
    results = ct.solve(model, threads=1)
    first, last = (f for f in results.frames if f.time in (1.0, 2.0))
    at = model.mesh.node_indices("left")
    assert first.RF[at, 0].sum() == pytest.approx(-0.5 - 4.0 * RHO, rel=1e-9)
    assert last.RF[at, 0].sum() == pytest.approx(-3.0 * RHO, rel=1e-9)
    # Nodes of the removed element alone stay where they were.
    far = model.mesh.node_indices("right")
    assert last.U[far] == pytest.approx(first.U[far], abs=1e-12)
    stress = np.concatenate([b.values["S"][..., 0].ravel() for b in last.fields])
    assert stress.max() == pytest.approx(2.5 * RHO, rel=1e-6)
    # The nodal value at the border is that of the elements that are there.
    border = np.isclose(model.mesh.points[:, 0], 3.0)
    assert results.nodal("S11", results.frames.index(last))[border] == pytest.approx(
        0.5 * RHO, rel=1e-6
    )


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8", "OPT", "Q4D"])
def test_elements_join_a_body_that_has_turned(element: str) -> None:
    """A right angle in one increment: no force, and then the stiffness of the whole strip."""
    kind = {"Q8": "quad8", "OPT": "tri3"}.get(element, "quad4")
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 1, cell=kind)
    middle = mesh.points[mesh.cells[0].nodes].mean(axis=1)[:, 0]
    mesh.cell_sets["far"] = np.flatnonzero(middle > 1.0)
    model = ct.Model(mesh)
    model.section(element=element, material=ct.Elastic(E, 0.3))
    at = mesh.points
    turned = np.stack([-at[:, 1], at[:, 0]], axis=1)
    first, second = ct.Static(), ct.Static()
    first.remove_elements("far")
    for node, (dx, dy) in enumerate(turned - at):
        first.fix([node], x=float(dx), y=float(dy))
    if element in ("OPT", "Q4D"):
        first.fix("all", x=None, y=None, rotation=0.5 * np.pi)
    second.add_elements("far")
    model.steps = [first, second]
    results = ct.solve(model, threads=1)
    last = results.frames[-1]
    assert max(np.abs(b.values["S"]).max() for b in last.fields) < 1e-10 * E
    assert np.abs(last.RF).max() < 1e-10 * E


def test_frequencies_of_what_is_left() -> None:
    model = strip()
    model.fix("left", x=0.0, y=0.0)
    step = ct.Static(nlgeom=False)
    step.remove_elements("right")
    model.steps = [step, ct.Frequency(modes=3, nlgeom=False)]
    found = ct.solve(model, threads=1).modes[-1].factors
    small = strip(cells=3)
    small.fix("left", x=0.0, y=0.0)
    small.steps = [ct.Frequency(modes=3)]
    assert found == pytest.approx(ct.solve(small, threads=1).modes[-1].factors, rel=1e-9)


def test_a_plastic_element_comes_back_as_new() -> None:
    model = bars(True, ct.Mises(E, 0.3, yield_stress=1.0, isotropic=10.0))
    model.steps[0].fix([1], x=0.1, y=None)
    model.steps[1].remove_elements("b")
    model.steps[2].add_elements("b")
    last = ct.solve(model, threads=1).frames[-1]
    peeq = [float(b.values["PEEQ"].max()) for b in last.fields]
    assert peeq[0] > 0.05
    assert peeq[1] == 0.0


def test_motion_of_what_is_left() -> None:
    """A free strip that moves along x keeps the velocity of its three quarters."""
    model = strip()
    model.velocity(x=2.0)
    model.steps = [ct.Dynamic(period=0.1, increments=2), ct.Dynamic(period=0.1, increments=2)]
    model.steps[1].remove_elements("right")
    results = ct.solve(model, threads=1)
    alive = model.mesh.points[:, 0] < 3.5
    assert results.frames[-1].V[alive, 0] == pytest.approx(2.0, rel=1e-9)
    assert results.frames[-1].scalars["ALLKE"] == pytest.approx(0.5 * 3.0 * RHO * 4.0, rel=1e-9)


def test_a_beam_joins_a_bent_one() -> None:
    """A cantilever is bent by a moment; a second beam joins it, and half of the next is its own."""
    cells = Cells("line2", np.array([[0, 1], [0, 1]]), np.array([1, 2]))
    mesh = Mesh(np.array([[0.0, 0.0], [1.0, 0.0]]), [cells], np.array([1, 2]))
    mesh.cell_sets |= {"a": np.array([0]), "b": np.array([1])}
    model = ct.Model(mesh)
    for name in ("a", "b"):
        model.beam(name, material=ct.Elastic(1.0, 0.0), area=1.0, inertia=1.0)
    model.fix([0], rotation=True)
    model.steps = [ct.Static(nlgeom=False) for _ in range(3)]
    model.steps[0].remove_elements("b")
    model.steps[0].force([1], moment=0.3)
    model.steps[1].add_elements("b")
    model.steps[2].force([1], moment=0.5)
    results = ct.solve(model, threads=1)
    turns = [f.UR[1] for f in results.frames if f.time in (1.0, 2.0, 3.0)]
    assert turns == pytest.approx([0.3, 0.3, 0.4], rel=1e-9)


def test_contact_on_elements_that_leave() -> None:
    model = strip()
    model.fix("left")
    model.contact("right", RigidCurve.line((4.5, 0.0), (4.5, 2.0)), name="wall")
    model.steps = [ct.Static()]
    model.steps[0].remove_elements("right")
    with pytest.raises(ct.UnsupportedError, match="let the pair end"):
        ct.solve(model, threads=1)


def test_what_is_refused() -> None:
    model = bars(True)
    model.steps[0].add_elements("b")
    with pytest.raises(ct.ModelError, match="is in the structure already"):
        ct.solve(model, threads=1)
    model = bars(True)
    model.steps[0].remove_elements("none")
    with pytest.raises(ct.ModelError, match="none"):
        ct.solve(model, threads=1)
    model = bars(True)
    model.steps.append(ct.Frequency(modes=1))
    model.steps[-1].remove_elements("b")
    with pytest.raises(ct.UnsupportedError, match="static and implicit"):
        ct.solve(model, threads=1)


DECK = """*NODE
1, 0., 0.
2, 1., 0.
*ELEMENT, TYPE=T2D2, ELSET=A
1, 1, 2
*ELEMENT, TYPE=T2D2, ELSET=B
2, 1, 2
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*SOLID SECTION, ELSET=A, MATERIAL=M
1.
*SOLID SECTION, ELSET=B, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
2, 2
*STEP
*STATIC
*MODEL CHANGE, REMOVE
B,
*CLOAD
2, 1, 20.
*END STEP
*STEP
*STATIC
*MODEL CHANGE, TYPE=ELEMENT, ADD{way}
2
*CLOAD
2, 1, 30.
*END STEP
"""


@pytest.mark.parametrize(("way", "u"), [("", 0.25), ("=STRAIN FREE", 0.25), ("=WITH STRAIN", 0.15)])
def test_the_card(tmp_path: Path, way: str, u: float) -> None:
    deck = tmp_path / "deck.inp"
    deck.write_text(DECK.format(way=way))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = ct.solve(ct.read(deck), threads=1).frames[-1].U[1, 0]
    assert found == pytest.approx(u, rel=1e-9)


def test_cards_that_are_wrong(tmp_path: Path) -> None:
    deck = tmp_path / "deck.inp"
    for old, new, said in (
        ("REMOVE\nB,", "REMOVE\nC,", "no element set named"),
        ("ADD{way}", "ADD, REMOVE", "either ADD or REMOVE"),
        ("{way}", "=AGAIN", "STRAIN FREE or WITH STRAIN"),
        ("REMOVE\nB,", "REMOVE", "data line is missing"),
    ):
        deck.write_text(DECK.replace(old, new).format(way=""))
        with pytest.raises(ct.DeckError, match=said):
            ct.read(deck)


@pytest.mark.parametrize("owner", ["model", "call"])
def test_changes_act_in_the_steps_of_the_model_and_in_those_of_the_call(owner: str) -> None:
    """Half of a pulled body leaves it; so does the mean of its stress at the common nodes."""
    model = ct.Model(ct.mesh.rectangle(2.0, 2.0, 1, 2))
    model.section("all", element="Q4I", material=ct.Elastic(E, 0.0))
    model.fix("left", x=0.0, y=None)
    model.fix("bottom", x=None, y=0.0)
    model.fix("right", x=0.02, y=None)
    steps = [ct.Static(), ct.Static()]
    steps[1].remove_elements([1])
    if owner == "model":
        model.steps = steps
    results = ct.solve(model, steps if owner == "call" else None, threads=1)
    assert results.history("RF1", at="right")[1:] == pytest.approx([2.0, 1.0], rel=1e-9)
    stress = sorted(float(b.values["S"][0, 0, 0]) for b in results.frames[-1].fields)
    assert stress == pytest.approx([0.0, 1.0])
    middle = results.nodal("S11")[model.mesh.points[:, 1] == 1.0]
    assert middle == pytest.approx(1.0)

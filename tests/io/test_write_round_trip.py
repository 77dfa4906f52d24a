"""Claim: a written deck has the results of the model, over loads, their changes and procedures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh import Mesh
from corota.mesh.data import Cells
from support.pairs import cover

LOADS: dict[str, Callable[[Any, float], None]] = {
    "dead traction": lambda s, f: s.traction("top", x=0.05 * f, y=-0.1 * f),
    "follower traction": lambda s, f: s.traction("top", x=0.05 * f, y=-0.1 * f, follow=True),
    "resultant": lambda s, f: s.force("right", x=0.05 * f, y=-0.1 * f),
    "nodal force": lambda s, f: s.force([3], x=0.05 * f, y=-0.1 * f),
    "pressure": lambda s, f: s.pressure("top", 0.3 * f),
    "shear": lambda s, f: s.shear("top", 0.3 * f),
    "gravity": lambda s, f: s.gravity(x=0.1 * f, y=-0.3 * f),
    "centrifugal": lambda s, f: s.centrifugal(0.3 * f),
    "temperature": lambda s, f: s.temperature(50.0 * f),
}
STEPS: dict[str, Callable[[], Any]] = {
    "static": lambda: ct.Static(increments=2),
    "linear": lambda: ct.Static(nlgeom=False),
    "dynamic": lambda: ct.Dynamic(period=0.4, increments=4),
    "explicit": lambda: ct.Dynamic(period=0.1, scheme="central_difference"),
}


def block() -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    law = ct.Elastic(E=1000.0, nu=0.3, rho=1.0, expansion=1e-3)
    model.section(element="Q4I", material=law)
    model.fix("left")
    return model


def same_after_writing(model: ct.Model, steps: list[Any], path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        here = ct.solve(model, steps, threads=1)
        ct.write(model, path, steps)
        there = ct.solve(ct.read(path), threads=1)
    assert len(here.frames) == len(there.frames)
    for one, two in zip(here.frames, there.frames, strict=True):
        scale = np.abs(one.U).max() + 1e-9
        np.testing.assert_allclose(two.U, one.U, rtol=0.0, atol=1e-9 * scale)


@pytest.mark.parametrize(("load", "kind", "then"), cover(LOADS, STEPS, [0.0, 0.5, -1.0]))
def test_a_load_and_its_change(load: str, kind: str, then: float, tmp_path: Path) -> None:
    first, second = STEPS["static"](), STEPS[kind]()
    if kind == "linear":
        first = STEPS[kind]()
    LOADS[load](first, 1.0)
    LOADS[load](second, then)
    same_after_writing(block(), [first, second], tmp_path / "model.inp")


@pytest.mark.parametrize("load", LOADS)
def test_loads_of_the_model(load: str, tmp_path: Path) -> None:
    model = block()
    LOADS[load](model, 1.0)
    last = ct.Static()
    LOADS[load](last, 0.0)
    same_after_writing(model, [ct.Static(increments=2), last], tmp_path / "model.inp")


def test_gravity_of_size_zero_ends_that_of_every_direction(tmp_path: Path) -> None:
    first, second, third = ct.Static(), ct.Static(), ct.Static()
    first.gravity(x=0.2, y=-0.3)
    second.gravity(y=-0.3)
    third.gravity()
    model = block()
    same_after_writing(model, [first, second, third], tmp_path / "model.inp")
    assert abs(ct.solve(model, [first, second, third]).frames[-1].U).max() < 1e-9


@pytest.mark.parametrize("sets", [(), ("plate",), ("plate", "rods")])
@pytest.mark.parametrize("kind", ["gravity", "centrifugal"])
def test_body_forces_act_on_lines_too(kind: str, sets: tuple[str, ...], tmp_path: Path) -> None:
    """Weight and spin of beams beside planar elements: the resultant is that of all masses."""
    plate = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    n, cells = plate.n_nodes, plate.n_cells
    points = np.vstack([plate.points, [4.0, 0.0], [4.0, 1.0]])
    lines = Cells("line2", np.array([[2, n], [n, n + 1]]), np.array([101, 102]))
    named = {"plate": np.arange(cells), "rods": np.array([cells, cells + 1])}
    mesh = Mesh(
        points,
        [*plate.cells, lines],
        np.arange(1, n + 3),
        node_sets=plate.node_sets,
        edge_sets=plate.edge_sets,
        cell_sets={name: named[name] for name in sets},
    )
    model = ct.Model(mesh)
    law = ct.Elastic(E=1000.0, nu=0.3, rho=1.0)
    model.section(np.arange(cells), element="Q4I", material=law)
    model.beam([cells, cells + 1], material=law, area=0.5, inertia=0.1)
    model.fix("left")
    model.fix([2], rotation=True, x=None, y=None)
    if kind == "gravity":
        model.gravity(y=-1.0)
    else:
        model.centrifugal(0.1)
    same_after_writing(model, [ct.Static(nlgeom=False)], tmp_path / "model.inp")
    if kind == "gravity":
        again = ct.solve(ct.read(tmp_path / "model.inp"), threads=1)
        assert again.frames[-1].F.sum(axis=0)[1] == pytest.approx(-(2.0 + 0.5 * 3.0))


@pytest.mark.parametrize("where", ["", [0, 1], [1]])
def test_initial_stress_by_cells(where: Any, tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section(element="Q4", material=ct.Elastic(E=1.0))
    model.fix("left")
    model.initial_stress(where, xx=0.01)
    same_after_writing(model, [ct.Static()], tmp_path / "model.inp")


def test_a_loss_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A writer that drops a card is noticed before the file is written."""
    from corota.io.deck.write import model as writing

    model = block()
    model.gravity(y=-1.0)
    monkeypatch.setattr(
        writing, "step_cards", lambda writer, steps: iter(list(_without_loads(writer, steps)))
    )
    with pytest.raises(ct.UnsupportedError, match="gravity of step 1 would not be the same"):
        ct.write(model, tmp_path / "model.inp")
    assert not (tmp_path / "model.inp").exists()


def _without_loads(writer: Any, steps: Any) -> Any:
    from corota.io.deck.write.steps import step_cards

    for card in step_cards(writer, steps):
        if not card.startswith("*DLOAD"):
            yield card

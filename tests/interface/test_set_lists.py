"""Every argument that takes a set takes a list of sets: their members, each once."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.loading import Loading

STEEL = ct.Elastic(1000.0, 0.3, rho=1.0, expansion=1e-5)


def model() -> ct.Model:
    made = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    made.mesh.cell_sets["first"] = np.array([0, 1, 2])
    made.mesh.cell_sets["rest"] = np.array([2, 3, 4, 5, 6, 7])
    return made


def united(m: ct.Model, *names: str) -> set[int]:
    return set(np.concatenate([m.mesh.nodes_of(n) for n in names]).tolist())


@pytest.mark.parametrize(
    ("give", "attribute"),
    [
        (lambda m, w: m.velocity(w, x=1.0), "velocities"),
        (lambda m, w: m.point_mass(w, 1.0), "point_masses"),
        (lambda m, w: m.couple(w, 5), "constraints"),
        (lambda m, w: m.rigid(w, 5), "constraints"),
        (lambda m, w: m.straight(w, 5, 9), "constraints"),
        (lambda m, w: m.local_axes(w, angle=0.1), "axes"),
        (lambda m, w: m.initial_temperature(3.0, w), "initial_temperatures"),
    ],
)
def test_nodes(give: Callable[[ct.Model, object], None], attribute: str) -> None:
    for names in (["left", "top"], ("left", "top"), np.array(["left", "TOP"])):
        m = model()
        give(m, names)
        nodes = getattr(m, attribute)[0].nodes
        assert set(nodes.tolist()) == united(m, "left", "top")
        assert len(nodes) == len(set(nodes.tolist()))


@pytest.mark.parametrize(
    ("give", "attribute", "edges"),
    [
        (lambda m, w: m.contact(w, "bottom"), "contacts", True),
        (lambda m, w: m.tie(w, "bottom"), "ties", True),
        (lambda m, w: m.section(w, element="Q4", material=STEEL), "sections", False),
        (lambda m, w: m.initial_stress(w, xx=1.0), "initial_stresses", False),
    ],
)
def test_edges_and_cells(
    give: Callable[[ct.Model, object], None], attribute: str, edges: bool
) -> None:
    m = model()
    give(m, ["left", "top"] if edges else ["first", "rest"])
    item = getattr(m, attribute)[0]
    assert len(item.slave if edges else item.cells) == (6 if edges else 8)


LOADS: dict[str, Callable[[Loading], None]] = {
    "force on edges": lambda s: s.force(["left", "top"], x=3.0),
    "moment": lambda s: s.force(["left", "top"], x=3.0, per_node=True),
    "total": lambda s: s.force(["left", "top"], x=3.0, total=True),
    "traction": lambda s: s.traction(["left", "top"], x=3.0),
    "shear": lambda s: s.shear(("left", "top"), 3.0),
    "pressure": lambda s: s.pressure(["left", "top"], 3.0),
    "gravity": lambda s: s.gravity(y=-9.0, cells=["first", "rest"]),
    "centrifugal": lambda s: s.centrifugal(2.0, cells=["first", "rest"]),
    "temperature": lambda s: s.temperature(30.0, ["left", "top"]),
}


def solved(m: ct.Model, step: ct.Static) -> np.ndarray:
    m.section(element="Q4", material=STEEL)
    m.fix(["bottom", "right"])
    return ct.solve(m, step, threads=1).frames[-1].U


@pytest.mark.parametrize("load", LOADS)
def test_loads_of_models_and_steps_are_the_same(load: str) -> None:
    m, step = model(), ct.Static()
    LOADS[load](m)
    other = model()
    LOADS[load](step)
    of_step = solved(other, step)
    np.testing.assert_array_equal(solved(m, ct.Static()), of_step)
    assert np.abs(of_step).max() > 0.0


def test_a_force_on_several_edge_sets_is_one_resultant() -> None:
    m = model()
    m.section(element="Q4", material=STEEL)
    m.fix("bottom")
    m.force(["left", "right"], x=3.0)
    results = ct.solve(m, ct.Static(nlgeom=False), threads=1)
    assert results.frames[-1].F[:, 0].sum() == pytest.approx(3.0)


def test_supports_of_several_sets_keep_their_names() -> None:
    step = ct.Static()
    step.fix(["left", "top"], y=None)
    assert [(s.nodes, s.dof) for s in step.supports] == [("left", 0), ("top", 0)]


def test_histories_take_several_sets() -> None:
    m = model()
    m.section(element="Q4", material=STEEL)
    m.fix("left")
    m.fix("right", x=0.01, y=None)
    results = ct.solve(m, ct.Static(), threads=1)
    both = results.history("RF1", at=["left", "right"])
    assert both.name == "RF1 at left, right"
    assert both[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("where", "words"),
    [
        (["left", "tpo"], "no set named 'tpo'.*did you mean 'top'"),
        (["left", 3], "nodes are selected by the name of a set"),
        ([], "no nodes are given"),
    ],
)
def test_faults_are_named(where: object, words: str) -> None:
    with pytest.raises(ct.InputError, match=words):
        model().rigid(where, 5)  # type: ignore[arg-type]

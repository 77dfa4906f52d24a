"""A force on edges is a resultant, on nodes it holds for each node."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


def strip(ny: int = 2, element: str = "Q4I", nx: int = 8) -> ct.Model:
    cell = {"Q4I": "quad4", "Q4D": "quad4", "Q8": "quad8", "T6": "tri6", "OPT": "tri3"}[element]
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=ny, cell=cell))  # type: ignore[arg-type]
    model.section(element=element, material=ct.Elastic(E=1e4, nu=0.3))
    model.fix("left")
    return model


def reaction(model: ct.Model, step: ct.Static | None = None) -> np.ndarray:
    return ct.solve(model, step or ct.Static(), threads=1).frames[-1].F.sum(axis=0)


@pytest.mark.parametrize("ny", [1, 2, 5])
@pytest.mark.parametrize("element", ["Q4I", "Q4D", "Q8", "T6", "OPT"])
def test_a_force_on_edges_is_its_resultant_whatever_the_mesh(element: str, ny: int) -> None:
    model = strip(ny, element)
    model.force("right", x=2.0, y=-3.0)
    np.testing.assert_allclose(reaction(model)[:2], [2.0, -3.0], rtol=1e-12)


def test_it_is_spread_consistently_over_unequal_edges() -> None:
    model = strip(2)
    x = model.mesh.points
    x[x[:, 1] == 0.5, 1] = 0.2  # edges of length 0.2 and 0.8
    model.force("right", x=10.0)
    force = ct.solve(model, ct.Static(), threads=1).frames[-1].F[:, 0]
    right = model.mesh.nodes_of("right")
    right = right[np.argsort(x[right, 1])]
    np.testing.assert_allclose(force[right], [1.0, 5.0, 4.0], rtol=1e-12)


@pytest.mark.parametrize("ny", [1, 3])
def test_a_moment_on_edges_is_a_resultant_too(ny: int) -> None:
    model = strip(ny, "Q4D")
    model.force("right", moment=6.0)
    moments = ct.solve(model, ct.Static(), threads=1).frames[-1].F[:, 2]
    assert moments.sum() == pytest.approx(6.0, rel=1e-12)
    right = model.mesh.nodes_of("right")
    ends = np.isin(model.mesh.points[right, 1], [0.0, 1.0])
    np.testing.assert_allclose(moments[right][ends], 3.0 / ny, rtol=1e-12)


def test_on_nodes_it_holds_for_each_unless_it_is_the_total() -> None:
    each, total, edges = strip(), strip(), strip()
    right = each.mesh.nodes_of("right")
    each.force(right, y=1.0)
    total.force(right, y=1.0, total=True)
    edges.force("right", y=1.0, per_node=True)
    assert reaction(each)[1] == pytest.approx(3.0)
    assert reaction(total)[1] == pytest.approx(1.0)
    assert reaction(edges)[1] == pytest.approx(3.0)


def test_total_and_per_node_together_are_refused() -> None:
    with pytest.raises(ct.InputError, match="either total or per_node"):
        strip().force("right", y=1.0, total=True, per_node=True)


def test_edge_pairs_where_nodes_are_meant_are_refused() -> None:
    model = strip()
    for give in (model.fix, lambda where: model.force(where, y=1.0)):
        with pytest.raises(ct.InputError, match=r"looks like edges"):
            give(model.mesh.edge_sets["right"])


def test_a_force_of_a_step_is_the_same_as_one_of_the_model() -> None:
    model, other = strip(), strip()
    model.force("right", x=2.0, y=-3.0)
    step = ct.Static()
    step.force("RIGHT", x=2.0, y=-3.0)
    mine = ct.solve(model, ct.Static(), threads=1).frames[-1]
    its = ct.solve(other, step, threads=1).frames[-1]
    np.testing.assert_array_equal(mine.U, its.U)


def test_supports_and_all_kinds_of_loads_are_methods_of_a_step() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=2))
    hot = ct.Elastic(E=1e4, nu=0.3, rho=1.0, expansion=1e-5)
    model.section(element="Q4I", material=hot)
    step = ct.Static()
    step.fix("left")
    step.force("right", y=1.0)
    step.traction("top", x=0.1)
    step.pressure("bottom", 0.2)
    step.gravity(y=-1.0)
    step.centrifugal(0.1)
    step.temperature(20.0)
    assert len(step.supports) == 2
    assert len(step.loads) == 6
    assert ct.solve(model, step, threads=1).frames[-1].factor == 1.0


def test_a_forces_set_is_checked_when_the_step_runs() -> None:
    step = ct.Static()
    step.force("rigth", y=1.0)
    with pytest.raises(ct.InputError, match="did you mean 'right'"):
        ct.solve(strip(), step, threads=1)

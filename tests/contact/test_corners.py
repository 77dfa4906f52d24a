"""Sharp corners sink in between slave nodes where they are masters; as slaves they do not.

A square on its tip is pressed into a block, whose edges are as long as the depth many times over,
at the middle of one of them.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from benchmarks.contact_problems import problem
from benchmarks.contact_reasons import reason

DEEP = 0.06


def pressed(slave: str, master: str, method: str) -> tuple[ct.Results, float]:
    """The run, and the depth of the tip below the edge that it meets."""
    block = ct.mesh.rectangle(2.0, 1.0, nx=5, ny=3)
    square = ct.mesh.move(ct.mesh.rectangle(0.5, 0.5, nx=4, ny=4), (1.0, 1.0), angle=45.0)
    mesh = ct.mesh.assembly(block=block, square=square)
    tip = int(
        np.argmin(np.where(mesh.points[:, 1] > 0.999, np.hypot(*(mesh.points - [1.0, 1.0]).T), 9.0))
    )
    sides = np.vstack([mesh.edge_sets["square.left"], mesh.edge_sets["square.bottom"]])
    surfaces = {"block": "block.top", "square": sides}
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0, nu=0.3)
    model.section("all", element="Q4", material=material, local_strain="logarithmic")
    model.fix("block.bottom")
    upper = np.unique(np.concatenate([mesh.nodes_of("square.right"), mesh.nodes_of("square.top")]))
    model.fix(upper, x=0.0, y=-DEEP)
    model.contact(surfaces[slave], surfaces[master], method=method, name="tip")  # type: ignore[arg-type]
    results = ct.solve(model, ct.Static(), threads=1)
    x = mesh.points + results.frames[-1].U
    top = mesh.nodes_of("block.top")
    top = top[np.argsort(x[top, 0])]
    return results, float(np.interp(x[tip, 0], x[top, 0], x[top, 1]) - x[tip, 1])


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
def test_a_sharp_corner_is_a_slave_or_a_note_says_that_it_sinks_in(method: str) -> None:
    results, depth = pressed("block", "square", method)
    assert any("the master has sharp corners" in note for note in results.notes)
    assert depth == pytest.approx(DEEP)  # nothing holds it
    results, depth = pressed("square", "block", method)
    assert not any("sharp corners" in note for note in results.notes)
    # Mortar keeps the mean over the edges of the square, a quarter of its side long.
    assert depth < (0.5 * DEEP if method == "mortar" else 1e-9)


def test_a_run_that_a_corner_stops_names_it_and_its_states_show_it() -> None:
    given = problem(193, size=0.5)
    with pytest.raises(ct.ConvergenceError, match=r"sharp corner of the master at node \d+") as end:
        ct.solve(given.model, given.steps, threads=1)
    assert reason(given.model, end.value.results, str(end.value)) == ("corner inside", True)
    # Another node is no corner inside, and a message without a reason has none.
    other = str(end.value).replace("master at node 332", "master at node 336")
    assert reason(given.model, end.value.results, other) == ("corner inside", False)
    assert reason(given.model, end.value.results, "no progress") == ("none", False)
    pair = given.model.contacts[0]
    pair.slave, pair.master = pair.master, pair.slave
    assert ct.solve(given.model, given.steps, threads=1).times[-1] == pytest.approx(2.0)

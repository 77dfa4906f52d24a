"""Pictures of contact, from an analysis and from its result file."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota import cli, plots
from corota.io.result_reader import read_results
from corota.results.rigid import moved, rigid_lines

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def results() -> ct.Results:
    """A block under a rigid disc that comes down and turns."""
    block = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    center = ct.mesh.add_node(block, 2.0, 3.0, name="center")
    model = ct.Model(block, name="pressed")
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3))
    model.fix("bottom")
    model.contact("top", ct.RigidCurve.circle((2.0, 3.0), 2.0, reference=center), name="disc")
    model.fix("center", y=-0.04, rotation=0.25)
    return ct.solve(model, ct.Static(first_increment=0.5), threads=1)


def test_the_line_shows_the_pressures_of_the_slave_nodes(results: ct.Results) -> None:
    figure = plots.contact_line(results, "disc")
    drawn = figure.axes[0].lines[0]
    way, pressure = drawn.get_data()
    mesh = results.mesh
    top = mesh.nodes_of("top")
    # The body is on the left, so the way along its top goes from right to left.
    top = top[np.argsort(-mesh.points[top, 0])]
    np.testing.assert_allclose(way, 4.0 - mesh.points[top, 0])
    np.testing.assert_array_equal(pressure, results.nodal("CPRESS")[top])
    assert pressure.max() > 0.0


def test_rigid_curves_move_with_their_node(results: ct.Results) -> None:
    curve = results.model.contacts[0].master
    assert isinstance(curve, ct.RigidCurve)
    (before,), (after,) = rigid_lines(curve), moved(results.model, curve, results.frame())
    np.testing.assert_allclose(np.hypot(*(after - [2.0, 2.96]).T), 2.0)
    angle = np.angle(complex(*(after[0] - [2.0, 2.96])) / complex(*(before[0] - [2.0, 3.0])))
    assert angle == pytest.approx(0.25)


@pytest.mark.usefixtures("quick_pictures")
def test_pictures_from_a_result_file(results: ct.Results, tmp_path: Path) -> None:
    path = results.write(tmp_path / "pressed.vtkhdf")
    with read_results(path) as stored:
        (pair,) = stored.model.contacts
        assert pair.name == "disc"
        assert pair.slave == "top"
        assert isinstance(pair.master, ct.RigidCurve)
        assert pair.master.reference == results.mesh.n_nodes - 1
    for options in (["--contact"], ["--field", "CSTATUS"], ["--field", "CPRESS"]):
        picture = tmp_path / f"{options[-1]}.png"
        assert cli.main(["plot", str(path), *options, "-o", str(picture)]) == 0
        assert picture.stat().st_size > 5000


def test_unknown_pairs_are_named(results: ct.Results) -> None:
    with pytest.raises(ct.errors.InputError, match="no contact pair named 'die'; there are: disc"):
        plots.contact_line(results, "die")

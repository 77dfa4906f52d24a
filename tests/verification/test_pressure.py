"""Following pressure: quadratic Newton, symmetric answers, work of a closed curve."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.models import ELEMENTS, Watch, assert_contracts, assert_quadratic, balance, cell

CORNERS = {"tri3": 3, "tri6": 3, "quad4": 4, "quad8": 4, "quad9": 4}


@pytest.mark.parametrize("element", ELEMENTS)
def test_pressure_bends_a_strip_with_open_ends(element):
    """The load stiffness is not symmetric there; Newton stays quadratic."""
    mesh = ct.mesh.rectangle(10.0, 1.0, 20, 2, cell(element), "alternate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1200.0, nu=0.3))
    model.fix("left", rotation=True)
    model.pressure("bottom", 0.5)
    watch = Watch()
    frame = ct.solve(
        model, Static(increments=4, tolerance=1e-11), observers=[watch], threads=1, fields=False
    ).frames[-1]
    # Far enough that a dead load would give another answer.
    assert frame.U[:, 1].max() > 3.0
    assert_quadratic(watch, 0.1, below=1e-2)
    assert_contracts(watch, 200.0, 1e-9)
    assert max(balance(model, frame)) <= 1e-8


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")
def test_closed_ring_under_pressure_stays_round(element):
    """Equal cells answer equally, and the pressure does the work p times the area lost."""
    n = 24
    mesh = ct.mesh.annulus(1.0, 1.3, 2, n, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=100.0, nu=0.3))
    x = mesh.points
    on_x = [int(np.argmin(np.hypot(x[:, 0] - r, x[:, 1]))) for r in (1.3, -1.3)]
    on_y = [int(np.argmin(np.hypot(x[:, 0], x[:, 1] - r))) for r in (1.3, -1.3)]
    model.fix(on_x, x=None, y=0.0)
    model.fix(on_y, x=0.0, y=None)
    model.pressure("outer", 1.0)
    watch = Watch()
    step = Static(increments=4, tolerance=1e-11)
    # A thin ring becomes oval at 3 E I / (r^2 r_outer) = 0.39; only T3 is too stiff for that.
    with pytest.warns(UserWarning, match="local strain" if element == "T3" else "a bifurcation"):
        results = ct.solve(model, step, observers=[watch], threads=1)
    frame = results.frames[-1]
    outward = x / np.hypot(*x.T)[:, None]
    radial = (frame.U * outward).sum(axis=1)
    around = frame.U[:, 1] * outward[:, 0] - frame.U[:, 0] * outward[:, 1]
    size = np.abs(radial).max()
    assert size > 0.03
    # Nodes of one kind: corners, or middles of sides, at one radius.
    radius = np.round(np.hypot(*x.T), 9)
    for name in ("inner", "outer"):
        nodes = mesh.node_sets[name]
        corners = nodes[
            np.isin(
                nodes, mesh.cells[0].nodes[:, : 3 + (mesh.cells[0].nodes.shape[1] not in (3, 6))]
            )
        ]
        assert np.ptp(radial[corners]) <= 1e-9 * size, name
        assert len(np.unique(radius[corners])) == 1
    # Sheared triangles turn every corner alike: the ring may rotate, not wobble.
    assert np.abs(frame.RF[on_x + on_y]).max() <= 1e-8
    assert np.ptp(around[mesh.node_sets["outer"]]) <= size
    energy = [f.scalars["strain energy"] for f in results.frames]
    work = [f.scalars["external work"] for f in results.frames[1:]]
    assert abs(work[-1] / energy[-1] - 1.0) <= 0.01


@pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")
def test_pressure_works_on_the_area_it_sweeps():
    """p dA = dE for a conservative load: strain energy against the enclosed area."""
    mesh = ct.mesh.annulus(1.0, 1.3, 2, 24, cell="quad9")
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E=100.0, nu=0.3))
    model.fix(mesh.node_sets["inner"][:1])
    model.fix(mesh.node_sets["inner"][12:13], x=None)
    model.pressure("inner", 2.0)
    frames = ct.solve(model, Static(increments=40), threads=1).frames

    def area(frame):
        """Area inside the inner boundary, by Green's theorem on quadratic edges."""
        total = 0.0
        for ends in mesh.edge_nodes(mesh.edge_sets["inner"]):
            p = (mesh.points + frame.U)[list(ends)]
            for r, w in zip(*np.polynomial.legendre.leggauss(3), strict=True):
                q = np.array([r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r]) @ p
                d = np.array([r - 0.5, r + 0.5, -2 * r]) @ p
                total += 0.5 * w * (q[0] * d[1] - q[1] * d[0])
        return abs(total)

    areas = np.array([area(f) for f in frames])
    pressures = np.array([2.0 * f.factor for f in frames])
    work = float((0.5 * (pressures[1:] + pressures[:-1]) * np.diff(areas)).sum())
    assert abs(work / frames[-1].scalars["strain energy"] - 1.0) <= 1e-3

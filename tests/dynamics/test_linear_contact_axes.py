"""Linear motions of bodies in contact whose nodes have local axes."""

# SPDX-License-Identifier: BSD-3-Clause

import numpy as np
import pytest

import corota as ct


@pytest.mark.parametrize("element", ["Q4I", "Q4D"])
def test_axes_of_slave_nodes_change_nothing(element):
    """Axes without supports, forces and equations in them are a change of variables."""
    found = []
    for angle in (0.0, 0.7):
        mesh = ct.mesh.rectangle(3.0, 1.0, nx=4, ny=2)
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=100.0, nu=0.3, rho=1.0))
        model.fix("left", rotation=element == "Q4D" or None)
        if angle:
            model.local_axes(np.flatnonzero(mesh.points[:, 0] > 0.1), angle=angle)
        floor = ct.RigidCurve.line((-1.0, -0.05), (5.0, -0.05))
        model.contact("bottom", floor, friction=0.2, name="floor")
        model.pressure("top", 0.3)
        shaken = ct.SteadyState(lowest=0.01, highest=0.3, points=2, direct=True)
        shaken.pressure("right", 0.1)
        results = ct.solve(model, [ct.Static(increments=2), ct.Frequency(modes=3), shaken])
        frame = results.frames[-1]
        found.append((results.modes[0].factors, frame.U, frame.RF, frame.C))
    for plain, turned in zip(*found, strict=True):
        assert np.abs(plain - turned).max() < 1e-9 * max(1.0, np.abs(plain).max())

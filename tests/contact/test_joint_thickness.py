"""Contact pressure of a joint of two thicknesses does not depend on which side is the slave.

The class of defect: an area that belongs to one side only.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.contact import METHODS
from corota.model.steps import Static


@pytest.mark.parametrize("slave", ["thick", "thin"])
@pytest.mark.parametrize("method", METHODS)
def test_pressure_belongs_to_the_smaller_thickness(slave: str, method: str) -> None:
    """Blocks of thickness 2 and .5 under a force of 1.5 on a width of 1: 1.5 / .5 = 3.

    .75 or 3 before, depending on the side.
    """
    # Node to segment passes the patch test where nodes meet.
    lower = ct.mesh.rectangle(1.0, 1.0, nx=3 if method == "mortar" else 2, ny=2)
    upper = ct.mesh.move(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2), (0.0, 1.0))
    mesh = ct.mesh.assembly(lower=lower, upper=upper)
    model = ct.Model(mesh)
    for name, thickness in (("lower", 2.0), ("upper", 0.5)):
        model.section(name, element="Q4I", material=ct.Elastic(1e4, 0.0), thickness=thickness)
    sides = {"thick": "lower.top", "thin": "upper.bottom"}
    master = sides["thin" if slave == "thick" else "thick"]
    model.contact(sides[slave], master, method=method)
    model.fix("lower.bottom")
    model.fix("upper.left", y=None)
    model.traction("upper.top", y=-3.0)
    results = ct.solve(model, Static(nlgeom=False), threads=1)
    nodes = mesh.nodes_of(sides[slave])
    pressure = results.nodal("CPRESS")[nodes]
    assert pressure == pytest.approx(np.full(len(nodes), 3.0), rel=1e-6)

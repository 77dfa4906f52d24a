"""Patches of several elements in one mesh, triangles beside quadrilaterals.

Drilling elements are left out: those of another share of the edge moments (OPT beside Q4D, or
either beside elements without rotations) balance on an edge only between edges of one length.
"""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.models import boundary, cell, prescribe

PAIRS = [("Q4", "T3"), ("Q4I", "T3"), ("Q8", "T6"), ("Q9", "T6"), ("Q8R", "T6"), ("Q4I", "Q4")]


@pytest.mark.parametrize(("left", "right"), PAIRS)
def test_constant_strain_across_two_elements(left, right):
    one = ct.mesh.rectangle(1.5, 2.0, 2, 3, cell(left))
    two = ct.mesh.rectangle(1.5, 2.0, 2, 3, cell(right), "alternate", origin=(1.5, 0.0))
    one.cell_sets, two.cell_sets = (
        {"one": np.arange(one.n_cells)},
        {"two": np.arange(two.n_cells)},
    )
    mesh = ct.mesh.distort(ct.mesh.merge(one, two), 0.25, seed=2)
    model = ct.Model(mesh)
    for name, element in (("one", left), ("two", right)):
        model.section(name, element=element, material=ct.Elastic(E=7.0, nu=0.3))
    h = np.array([[1e-3, 4e-4], [-7e-4, -5e-4]])
    u = mesh.points @ h.T
    edge = boundary(mesh)
    prescribe(model, edge, u[edge])
    results = ct.solve(model, Static(nlgeom=False), threads=1)
    frame = results.frames[-1]
    assert np.abs(frame.U - u).max() <= 1e-12 * np.abs(u).max()
    stress = np.concatenate([f.values["S"].reshape(-1, 4) for f in frame.fields])
    assert np.ptp(stress, axis=0).max() <= 1e-11 * np.abs(stress).max()

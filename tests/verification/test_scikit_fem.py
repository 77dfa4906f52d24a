"""`green_lagrange` beside scikit-fem: the St. Venant-Kirchhoff solid to ten digits."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.model.loads import EdgeLoad
from corota.model.steps import Static
from corota.verification.models import cook, edge_forces

fem = pytest.importorskip("skfem")
E, NU, FORCE, INCREMENTS = 1.0, 1.0 / 3.0, 0.6, 3

#: Element of scikit-fem and order of its quadrature, exact to that of ours.
ELEMENTS = {"T3": ("ElementTriP1", 1), "Q4": ("ElementQuad1", 3), "Q9": ("ElementQuad2", 5)}


def mesh_of(mesh):
    """Mesh of scikit-fem by corners; quadratic nodes follow by place, sides being straight."""
    corners = mesh.cells[0].nodes[:, : 3 if mesh.cells[0].kind.startswith("tri") else 4]
    used = np.unique(corners)
    new = np.full(mesh.n_nodes, -1)
    new[used] = np.arange(len(used))
    kind = fem.MeshTri if corners.shape[1] == 3 else fem.MeshQuad
    return kind(mesh.points[used].T.copy(), new[corners].T.copy())


@pytest.mark.parametrize("element", ELEMENTS)
def test_every_displacement_agrees(element):
    model, _ = cook(element, 4, local_strain="green_lagrange", E=E, nu=NU)
    model.loads.clear()
    mesh = model.mesh
    load = EdgeLoad("right", "traction", (0.0, FORCE / 16.0))
    step = Static(loads=[load], increments=INCREMENTS, tolerance=1e-13)
    found = ct.solve(model, step, threads=1, fields=False).frames[-1].U

    name, order = ELEMENTS[element]
    basis = fem.Basis(mesh_of(mesh), fem.ElementVector(getattr(fem, name)()), intorder=order)
    place = basis.doflocs.T
    node = np.array([np.hypot(*(mesh.points - x).T).argmin() for x in place])
    assert np.abs(mesh.points[node] - place).max() < 1e-10
    axis = np.zeros(basis.N, int)
    for dofs in (basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs):
        axis[dofs[1::2].ravel()] = 1
    force = np.zeros((mesh.n_nodes, 2))
    for item in edge_forces(mesh, "right", lambda x: (0.0, FORCE / 16.0)):
        force[item.nodes[0], item.dof] += item.value
    force = force[node, axis]
    free = np.flatnonzero(~np.isin(node, mesh.node_sets["left"]))
    lame, shear = E * NU / (1.0 - NU**2), E / (2.0 * (1.0 + NU))

    def stress(w):
        grad = w["u"].grad
        eye = np.eye(2)[:, :, None, None]
        f = eye + grad
        green = 0.5 * (np.einsum("ki...,kj...->ij...", f, f) - eye)
        return f, lame * np.trace(green) * eye + 2.0 * shear * green

    @fem.LinearForm
    def internal(v, w):
        f, s = stress(w)
        return np.einsum("ik...,kj...,ij...", f, s, v.grad)

    @fem.BilinearForm
    def tangent(u, v, w):
        f, s = stress(w)
        change = np.einsum("ki...,kj...->ij...", u.grad, f)
        change = 0.5 * (change + np.einsum("ij...->ji...", change))
        eye = np.eye(2)[:, :, None, None]
        ds = lame * np.trace(change) * eye + 2.0 * shear * change
        first = np.einsum("ik...,kj...,ij...", u.grad, s, v.grad)
        return first + np.einsum("ik...,kj...,ij...", f, ds, v.grad)

    u = np.zeros(basis.N)
    for part in np.linspace(1.0 / INCREMENTS, 1.0, INCREMENTS):
        for _ in range(20):
            state = basis.interpolate(u)
            residual = (part * force - internal.assemble(basis, u=state))[free]
            matrix = tangent.assemble(basis, u=state).tocsc()[free][:, free]
            du = fem.solve(matrix, residual)
            u[free] += du
            if np.abs(du).max() <= 1e-13 * np.abs(u).max():
                break
        else:
            raise AssertionError("scikit-fem did not converge")
    assert np.abs(u).max() > 5.0
    assert np.abs(found[node, axis] - u).max() <= 1e-10 * np.abs(u).max()

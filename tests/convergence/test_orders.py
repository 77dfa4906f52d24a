"""Observed orders of convergence on smooth solutions of linear elasticity.

The displacement of the complex potentials phi = exp(z), psi = sin(z) is in equilibrium
without body force (N. I. Muskhelishvili, Some Basic Problems, chapter 5); a second solution
has one, so that loads are tested too.
"""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model import NodalForce
from support import continuum
from support.models import DRILLING, QUADRATIC, boundary, cell, linear, prescribe

E, NU = 5.0, 0.25
ELEMENTS = ("T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D")
REGION = [(0.0, 0.0), (1.0, 0.1), (1.15, 1.0), (0.1, 0.9)]


def potentials(x):
    """Displacement and rotation of the complex potentials, plane stress."""
    z = x[..., 0] + 1j * x[..., 1]
    mu, kappa = E / (2 * (1 + NU)), (3 - NU) / (1 + NU)
    w = (kappa * np.exp(z) - z * np.conj(np.exp(z)) - np.conj(np.sin(z))) / (2 * mu)
    rotation = (kappa + 1) / (2 * mu) * np.exp(z).imag
    return np.stack([w.real, w.imag], axis=-1), rotation


def waves(x):
    """Displacement and rotation of two sine waves."""
    p, q = x[..., 0], x[..., 1]
    u = np.stack([np.sin(2 * p + q), np.cos(p - 2 * q)], axis=-1)
    rotation = 0.5 * (-np.sin(p - 2 * q) - np.cos(2 * p + q))
    return u, rotation


def waves_body_force(x):
    """Force per volume that holds `waves` in equilibrium, plane stress."""
    p, q = x[..., 0], x[..., 1]
    c, g = E / (1 - NU**2), E / (2 * (1 + NU))
    s, t = np.sin(2 * p + q), np.cos(p - 2 * q)
    u_xx, u_yy, u_xy = -4 * s, -s, -2 * s
    v_xx, v_yy, v_xy = -t, -4 * t, 2 * t
    return -np.stack(
        [
            c * (u_xx + NU * v_xy) + g * (u_yy + v_xy),
            c * (v_yy + NU * u_xy) + g * (v_xx + u_xy),
        ],
        axis=-1,
    )


def body_forces(mesh, force):
    """Consistent nodal forces of a field, with the shape functions of the cells."""
    nodes = mesh.cells[0].nodes
    xi, weights = continuum.gauss(nodes.shape[1], 4)
    n, dn = continuum.shape(nodes.shape[1], xi)
    x = mesh.points[nodes]
    dv = weights * np.linalg.det(np.einsum("pnj,eni->epij", dn, x))
    parts = np.einsum("ep,epi,pn->eni", dv, force(np.einsum("pn,eni->epi", n, x)), n)
    total = np.zeros((mesh.n_nodes, 2))
    np.add.at(total, nodes, parts)
    return [NodalForce(np.array([a]), i, float(v)) for (a, i), v in np.ndenumerate(total)]


def error(element, n, exact, force=None):
    """L2 norm of the error of the interpolated displacement."""
    kind = cell(element)
    mesh = ct.mesh.mapped(REGION, n, n, kind, "alternate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=E, nu=NU))
    edge = boundary(mesh)
    u, rotation = exact(mesh.points[edge])
    prescribe(model, edge, u, rotation if element in DRILLING else None)
    if force is not None:
        model.loads += body_forces(mesh, force)
    found = linear(model).U
    nodes = mesh.cells[0].nodes
    xi, weights = continuum.gauss(nodes.shape[1], 4)
    values, dn = continuum.shape(nodes.shape[1], xi)
    x = mesh.points[nodes]
    dv = weights * np.linalg.det(np.einsum("pnj,eni->epij", dn, x))
    difference = np.einsum("pn,eni->epi", values, found[nodes])
    difference -= exact(np.einsum("pn,eni->epi", values, x))[0]
    return np.sqrt((dv[..., None] * difference**2).sum())


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("solution", ["potentials", "waves"])
def test_displacement_converges_with_its_order(element, solution):
    exact = {"potentials": potentials, "waves": waves}[solution]
    force = waves_body_force if solution == "waves" else None
    errors = [error(element, n, exact, force) for n in (4, 8, 16)]
    order = np.log2(errors[-2] / errors[-1])
    assert order >= (2.9 if element in QUADRATIC else 1.95), errors

"""A small finite element program for hyperelastic continua, independent of the package.

Total Lagrangian, written from the definitions: shape functions from monomials, first
Piola-Kirchhoff stress and its derivative by the deformation gradient, no frames. Cells of 3,
4, 6, 8 and 9 nodes, numbered as everywhere: corners, mid-sides, center.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from corota.verification.shapes import QUAD, TRIANGLE, gauss, shape

__all__ = [
    "QUAD",
    "RULE",
    "TRIANGLE",
    "biot_linear",
    "element",
    "fourth",
    "gauss",
    "moduli",
    "saint_venant_kirchhoff",
    "shape",
    "solve",
]

#: Quadrature of the package's elements, for agreement to rounding.
RULE = {
    "T3": (np.array([[1 / 3, 1 / 3]]), np.array([0.5])),
    "T6": (np.array([[1, 1], [4, 1], [1, 4]]) / 6, np.full(3, 1 / 6)),
    "Q4": gauss(4, 2),
    "Q8": gauss(8, 3),
    "Q8R": gauss(8, 2),
    "Q9": gauss(9, 3),
}


def moduli(E, nu, plane="stress"):
    """Isotropic moduli, rows 11, 22, 12 with engineering shear."""
    g = E / (2 * (1 + nu))
    if plane == "stress":
        c, d = E / (1 - nu**2), nu
    else:
        c, d = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), nu / (1 - nu)
    return np.array([[c, c * d, 0.0], [c * d, c, 0.0], [0.0, 0.0, g]])


def fourth(c):
    """Moduli as a tensor C_ijkl."""
    row = {(0, 0): 0, (1, 1): 1, (0, 1): 2, (1, 0): 2}
    return np.array(
        [
            [[[c[row[i, j], row[k, m]] for m in (0, 1)] for k in (0, 1)] for j in (0, 1)]
            for i in (0, 1)
        ]
    )


def saint_venant_kirchhoff(f, c):
    """First Piola-Kirchhoff stress and dP/dF of W = E : C : E / 2, Green-Lagrange strain."""
    eye = np.eye(2)
    green = 0.5 * (np.einsum("...ki,...kj->...ij", f, f) - eye)
    s = np.einsum("ijkl,...kl->...ij", c, green)
    p = f @ s
    fc = np.einsum("...ip,pjql->...ijql", f, c)
    a = np.einsum("ik,...jl->...ijkl", eye, s) + np.einsum("...ijql,...kq->...ijkl", fc, f)
    return p, a


def biot_linear(f, c):
    """Stress and dP/dF of W = (U - I) : C : (U - I) / 2 for isotropic C."""
    a, b = f[..., 0, 0] + f[..., 1, 1], f[..., 1, 0] - f[..., 0, 1]
    length2 = a * a + b * b
    cos, sin = a / np.sqrt(length2), b / np.sqrt(length2)
    r = np.stack([np.stack([cos, -sin], -1), np.stack([sin, cos], -1)], -2)
    rt = np.swapaxes(r, -1, -2)
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    u = rt @ f
    s = np.einsum("ijkl,...kl->...ij", c, u - np.eye(2))
    slope = np.zeros((*f.shape, 2, 2))
    for k in (0, 1):
        for m in (0, 1):
            df = np.zeros((2, 2))
            df[k, m] = 1.0
            dtheta = (a * (df[1, 0] - df[0, 1]) - b * (df[0, 0] + df[1, 1])) / length2
            du = rt @ df - dtheta[..., None, None] * (turn @ u)
            ds = np.einsum("ijkl,...kl->...ij", c, du)
            slope[..., k, m] = r @ ds + dtheta[..., None, None] * (r @ turn @ s)
    return r @ s, slope


def element(x, u, law, c, rule, thickness=1.0):
    """Forces (e, n, 2) and tangents (e, n, 2, n, 2) of cells x, u of shape (e, n, 2)."""
    xi, weights = rule
    _, dn = shape(x.shape[1], xi)
    jacobian = np.einsum("pnj,eni->epij", dn, x)
    inverse = np.linalg.inv(jacobian)
    g = np.einsum("pnj,epji->epni", dn, inverse)
    dv = thickness * weights * np.linalg.det(jacobian)
    f = np.eye(2) + np.einsum("eni,epnj->epij", u, g)
    p, a = law(f, fourth(c))
    force = np.einsum("ep,epij,epnj->eni", dv, p, g)
    weighted = np.einsum("ep,epijkl,epnj->epnikl", dv, a, g, optimize=True)
    tangent = np.einsum("epnikl,epml->enimk", weighted, g, optimize=True)
    return force, tangent


def solve(points, cells, law, c, rule, loads, held, thickness=1.0):
    """Displacements under each of a list of dead nodal loads (n, 2), by Newton's method.

    `held` (n, 2) marks dofs that stay at zero.
    """
    n = len(points)
    dofs = (2 * cells[:, :, None] + np.arange(2)).reshape(len(cells), -1)
    rows = np.repeat(dofs, dofs.shape[1], axis=1).ravel()
    columns = np.tile(dofs, dofs.shape[1]).ravel()
    free = np.flatnonzero(~held.ravel())
    u, answers = np.zeros((n, 2)), []
    for load in loads:
        for _ in range(30):
            force, tangent = element(points[cells], u[cells], law, c, rule, thickness)
            r = load.ravel().copy()
            np.subtract.at(r, dofs.ravel(), force.ravel())
            k = sp.csr_array((tangent.ravel(), (rows, columns)), shape=(2 * n, 2 * n))
            du = np.zeros(2 * n)
            du[free] = spsolve(k[free][:, free].tocsc(), r[free])
            u = u + du.reshape(n, 2)
            if np.abs(du).max() <= 1e-13 * np.abs(u).max():
                break
        else:
            raise AssertionError("the independent program did not converge")
        answers.append(u)
    return answers

"""Q4I in a uniform state beyond yield: where it is unstable though the continuum is not.

By van Hove's theorem a uniform body whose boundary is held is stable while the material is
elliptic, and so is every conforming mesh of it. Incompatible modes are not conforming: with the
tangent ``A = dP/dF`` split by the direction of the derivatives, the hourglass of a square cell
has the stiffness ``S_1 + S_2`` of the two Schur complements of A, positive for certain only
while ``dP : dF > 0`` for every dF.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh

import corota as ct
from corota import _core
from corota.verification.plastic_models import CELL, cook

ANGLE = np.radians(22.5)


def law(hardening):
    return ct.Mises(E=70.0, nu=1.0 / 3.0, yield_stress=0.243, isotropic=hardening)


def pulled(material, strain=0.15, increments=30):
    """Deformation gradients of uniaxial tension (logarithmic strain), by increments."""
    n = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    along, across = np.outer(n, n), np.eye(2) - np.outer(n, n)
    rows, out = np.zeros((0, 3)), []
    for e in strain * np.arange(1, increments + 1) / increments:

        def side(s, e=e, rows=rows):
            return material.respond(np.vstack([rows, [e, s, 0.0]]))["stress"][-1, 1]

        s = brentq(side, -e, e, xtol=1e-15)
        rows = np.vstack([rows, [e, s, 0.0]])
        out.append(np.exp(e) * along + np.exp(s) * across)
    return out


def hencky(f):
    values, axes = np.linalg.eigh(f.T @ f)
    e = (axes * (0.5 * np.log(values))) @ axes.T
    return np.array([e[0, 0], e[1, 1], 2.0 * e[0, 1]])


def differences(function, f, h):
    columns = []
    for k in range(4):
        d = np.zeros(4)
        d[k] = h
        d = d.reshape(2, 2)
        columns.append((function(f + d) - function(f - d)) / (2.0 * h))
    return np.stack(columns, axis=-1)


def moduli(material, path):
    """``dP/dF`` at the end of a path, components 11, 12, 21, 22, by differences."""
    before = np.array([hencky(f) for f in path[:-1]])

    def nominal(f):
        stress = material.respond(np.vstack([before, hencky(f)]))["stress"][-1]
        return stress @ differences(hencky, f, 1e-6)

    return differences(nominal, path[-1], 1e-5)


def ellipticity(a):
    """Least eigenvalue of the acoustic tensors."""
    angles = np.linspace(0.0, np.pi, 181)
    n = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    q = np.einsum("iajb,na,nb->nij", a.reshape(2, 2, 2, 2), n, n)
    return np.linalg.eigvalsh(0.5 * (q + q.transpose(0, 2, 1))).min()


def hourglass(a):
    """Least stiffness of the hourglass of a square cell, its internal modes free."""
    parts = [[0, 2], [1, 3]]
    total = np.zeros((2, 2))
    for keep, drop in (parts, parts[::-1]):
        row = a[np.ix_(keep, drop)]
        total += a[np.ix_(keep, keep)] - row @ np.linalg.solve(a[np.ix_(drop, drop)], row.T)
    return np.linalg.eigvalsh(0.5 * (total + total.T))[0]


def least(element, n, material, path):
    """Least eigenvalue of the tangent of the inner nodes of a uniformly strained square."""
    mesh = ct.mesh.rectangle(1.0, 1.0, n, n, CELL[element])
    x = mesh.points
    block = {
        "element": element,
        "law": material.law,
        "parameters": material.parameters(),
        "plane": "stress",
        "local_strain": "logarithmic",
        "thickness": 1.0,
        "rho": 0.0,
        "nodes": np.asarray(mesh.cells[0].nodes, np.uint32).ravel(),
    }
    core = _core.Problem(x, [block], np.zeros(0, np.uint8))
    size = core.n_dofs
    force, scale, values = np.empty(size), np.empty(size), np.empty(len(core.indices))
    for f in path:
        core.assemble(np.ravel(x @ (f - np.eye(2)).T), True, force, scale, values)
        core.commit()
    upper = sp.csc_matrix(
        (values, core.indices.astype(int), core.indptr.astype(int)), shape=(size, size)
    )
    inner = np.flatnonzero(((x > 1e-9) & (x < 1.0 - 1e-9)).all(axis=1))
    dofs = np.sort(np.concatenate([2 * inner, 2 * inner + 1]))
    tangent = (upper + sp.triu(upper, 1).T).tocsc()[dofs][:, dofs]
    return float(eigsh(tangent, k=1, sigma=-5.0, return_eigenvectors=False)[0])


@pytest.mark.parametrize(("hardening", "stable"), [(0.135, False), (0.3, True)])
def test_uniform_tension_is_unstable_where_theory_says(hardening, stable):
    """Hardening below and above the stress (0.26 and 0.29): the material is elliptic in both."""
    material = law(hardening)
    path = pulled(material)
    a = moduli(material, path)
    assert ellipticity(a) > 0.0
    assert (hourglass(a) > 0.0) == stable
    assert (least("Q4I", 32, material, path) > 0.0) == stable
    for element, n in (("Q8", 16), ("Q4S", 32), ("Q4R", 32)):
        assert least(element, n, material, path) > 0.0, element


@pytest.mark.parametrize(
    ("element", "hardening", "said"),
    [("Q4I", 0.135, True), ("Q4I", 0.3, False), ("Q8", 0.135, False)],
)
def test_localized_flow_is_said(element, hardening, said):
    """On Cook's panel; once."""
    model = cook(element, 8, 1.8, "logarithmic", law(hardening))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        results = ct.solve(model, ct.Static(first_increment=0.1), threads=1)
    found = [n for n in results.notes if "within a Q4I element" in n]
    assert len(found) == said
    assert sum("within a Q4I element" in str(w.message) for w in caught) == said

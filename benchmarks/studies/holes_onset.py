"""Onset of the pattern in a square array of holes: the package beside elements of NumPy alone.

``python -m benchmarks holes_onset`` presses the array of the example ``cells/holes`` along y, and
alike along x and y, on finer and finer meshes. The other program has nine-node elements in the
total Lagrangian form, one cell, and the wave (1/2, 1/2), whose phases are signs; of the package it
takes the mesh alone. `BERTOLDI` has the constants of Bertoldi and Boyce, c1 = .55, c2 = .3, K = 55,
with which K. Bertoldi and others (J. Mech. Phys. Solids 56 (2008) 2642-2668) computed such arrays;
quoted by F. Hendriks and others, arXiv:2507.11195.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh, splu

import corota as ct

Floats = NDArray[np.float64]

#: Shear and bulk modulus of the neo-Hookean rubber.
SHEAR, BULK = 1.0, 100.0
#: The same initial moduli as c1 (I1 - 3) + c2 (I1 - 3)^2 - 2 c1 ln J + K (J - 1)^2 / 2.
BERTOLDI = ct.Yeoh(C10=0.55, C20=0.3, C30=0.0, D1=2.0 / (55.0 + 2.0 / 3.0 * 1.1))
#: Strains between which the onset lies, one way and both ways.
BETWEEN = {False: (0.028, 0.036), True: (0.01, 0.014)}
EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "cells" / "holes.py"


def mesh_of(n: int) -> ct.Mesh:
    """Mesh of the example, with 4 n elements around the hole."""
    spec = importlib.util.spec_from_file_location("holes", EXAMPLE)
    assert spec
    assert spec.loader
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    mesh: ct.Mesh = example.square_with_hole(example.RADIUS, n)
    return mesh


def by_package(mesh: ct.Mesh, both: bool, law: Any = None) -> float:
    """Strain along y at the onset."""
    model = ct.Model(mesh)
    rubber = ct.NeoHooke(C10=0.5 * SHEAR, D1=2.0 / BULK) if law is None else law
    model.section("all", element="Q9", material=rubber, plane="strain")
    cell = ct.PeriodicCell(model)
    end = BETWEEN[both][1]
    cell.drive([[-end if both else None, 0.0], [0.0, -end]])
    results = ct.solve(cell.model, ct.Static(increments=4), fields=False, threads=1)
    return -float(cell.onset(results, [(0.5, 0.5)]).gradient[1, 1])


def stress(f: NDArray[Any]) -> NDArray[Any]:
    """First Piola-Kirchhoff stress of the neo-Hookean body, shape (..., 2, 2)."""
    j = f[..., 0, 0] * f[..., 1, 1] - f[..., 0, 1] * f[..., 1, 0]
    other = np.empty_like(f)  # transpose of the inverse
    other[..., 0, 0], other[..., 1, 1] = f[..., 1, 1] / j, f[..., 0, 0] / j
    other[..., 0, 1], other[..., 1, 0] = -f[..., 1, 0] / j, -f[..., 0, 1] / j
    third = ((f**2).sum(axis=(-1, -2)) + 1.0) / 3.0
    shape = SHEAR * j ** (-2.0 / 3.0)
    volume = BULK * (j - 1.0) * j
    out: NDArray[Any] = shape[..., None, None] * (f - third[..., None, None] * other)
    return out + volume[..., None, None] * other


def slopes(f: Floats) -> Floats:
    """Derivative of the stress, shape (..., 2, 2, 2, 2), by complex steps."""
    out = np.empty((*f.shape, 2, 2))
    for k in range(2):
        for m in range(2):
            step = f.astype(complex)
            step[..., k, m] += 1e-30j
            out[..., k, m] = stress(step).imag / 1e-30
    return out


def gradients_at_points() -> tuple[Floats, Floats]:
    """Derivatives of nine shape functions at 3 x 3 points, shape (9, 9, 2), and weights."""
    r, w = np.array([-1.0, 0.0, 1.0]) * np.sqrt(0.6), np.array([5.0, 8.0, 5.0]) / 9.0
    places = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)]

    def value(a: int, x: float) -> float:
        return 0.5 * x * (x + a) if a else 1.0 - x * x

    def slope(a: int, x: float) -> float:
        return x + 0.5 * a if a else -2.0 * x

    points = [(x, y) for x in r for y in r]
    of = [
        [[slope(a, x) * value(b, y), value(a, x) * slope(b, y)] for a, b in places]
        for x, y in points
    ]
    return np.array(of), np.outer(w, w).ravel()


class Array:
    """One cell of nine-node elements, with nodes that are one in the periodic body.

    Parameters
    ----------
    mesh : Mesh
    both : bool
        Whether it is pressed along x, too; else it is free there.
    """

    def __init__(self, mesh: ct.Mesh, both: bool) -> None:
        self.points, self.nodes = points, nodes = mesh.points, mesh.cells[0].nodes
        d, w = gradients_at_points()
        jacobian = np.einsum("eai,qaj->eqij", points[nodes], d)
        self.g = np.einsum("qaj,eqji->eqai", d, np.linalg.inv(jacobian))
        self.area = np.linalg.det(jacobian) * w
        self.dofs = (2 * nodes[:, :, None] + np.arange(2)).reshape(len(nodes), -1)
        n = len(points)
        place = np.round(np.mod(points + 1e-9, 1.0), 6)
        one = np.unique(place, axis=0, return_inverse=True)[1].ravel()
        first = np.unique(one, return_index=True)[1][one]
        count = np.rint(points - points[first]).sum(axis=1)
        columns = 2 * np.repeat(one, 2) + np.tile([0, 1], n)

        def link(signs: Floats) -> Any:
            return sp.csc_array((np.repeat(signs, 2), (np.arange(2 * n), columns)))

        self.macro = np.zeros((2 * n, 2))
        self.macro[0::2, 0], self.macro[1::2, 1] = points[:, 0], points[:, 1]
        periodic = link(np.ones(n))[:, 2:]
        free = [] if both else [sp.csc_array(self.macro[:, :1])]
        self.periodic = sp.hstack([periodic, *free]).tocsc()
        self.wave = link((-1.0) ** count)
        self.moves = self.macro.sum(axis=1) if both else self.macro[:, 1]
        self.state = np.zeros(self.periodic.shape[1])

    def least_stiffness(self, strain: float) -> float:
        """Smallest eigenvalue of the stiffness against the wave, at the equilibrium."""
        stiffness = self._equilibrium(strain)
        matrix = (self.wave.T @ stiffness @ self.wave).tocsc()
        return float(eigsh(matrix, 1, sigma=0.0, return_eigenvectors=False)[0])

    def _equilibrium(self, strain: float) -> Any:
        for _ in range(30):
            force, stiffness = self._forces(self.periodic @ self.state - strain * self.moves)
            matrix = (self.periodic.T @ stiffness @ self.periodic).tocsc()
            step = splu(matrix).solve(-(self.periodic.T @ force))
            self.state = self.state + step
            if np.abs(step).max() < 1e-13:
                return stiffness
        raise RuntimeError(f"no equilibrium at a strain of {strain}")

    def _forces(self, u: Floats) -> tuple[Floats, Any]:
        moved = u.reshape(-1, 2)[self.nodes]
        f = np.einsum("eai,eqaj->eqij", moved, self.g) + np.eye(2)
        size = (len(self.nodes), 18)
        force = np.einsum("eqij,eqaj,eq->eai", stress(f), self.g, self.area).reshape(size)
        weighted = slopes(f) * self.area[:, :, None, None, None, None]
        k = np.einsum("eqijkl,eqaj,eqbl->eaibk", weighted, self.g, self.g, optimize=True)
        k = k.reshape(*size, 18)
        rows = np.broadcast_to(self.dofs[:, :, None], k.shape).ravel()
        columns = np.broadcast_to(self.dofs[:, None, :], k.shape).ravel()
        n = len(u)
        whole = sp.coo_array((k.ravel(), (rows, columns)), shape=(n, n)).tocsc()
        return np.bincount(self.dofs.ravel(), force.ravel(), n), whole


def by_numpy(mesh: ct.Mesh, both: bool) -> float:
    """Strain along y at the onset, by the elements of this module."""
    array = Array(mesh, both)
    for share in (0.25, 0.5, 0.75, 1.0):
        array.least_stiffness(share * BETWEEN[both][0])
    return float(brentq(array.least_stiffness, *BETWEEN[both], xtol=1e-12))


def main() -> None:
    """Print the onset mesh by mesh."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--finest", type=int, default=16, help="elements of a quarter of the hole")
    given = parser.parse_args()
    say = sys.stdout.write
    say("pressed   elements around   package     NumPy       difference   rubber of Bertoldi\n")
    for both in (False, True):
        for n in (n for n in (4, 8, 12, 16, 24) if n <= given.finest):
            mesh = mesh_of(n)
            one, two = by_package(mesh, both), by_numpy(mesh, both)
            off = one / two - 1.0
            ways = "both ways" if both else "along y"
            law = by_package(mesh, both, BERTOLDI)
            say(f"{ways:9s} {4 * n:15d} {one:11.7f} {two:11.7f} {off:11.1e} {law:11.6f}\n")


if __name__ == "__main__":
    main()

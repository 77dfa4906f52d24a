"""Orders of convergence on manufactured solutions of linear elasticity, for every element.

The complex potentials phi = exp(z), psi = sin(z) are in equilibrium without body force; two sine
waves need one, so that loads are tested too. A skew region with 4, 8 and 16 elements per side, with
the solution prescribed on its boundary. The error of the displacement falls with order two for
linear and three for quadratic elements, that of the gradient with one order less; drilling elements
and incompatible modes count as linear.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Problem, Study, Value
from corota.verification.models import (
    DRILLING,
    ELEMENTS,
    QUADRATIC,
    boundary,
    cell,
    linear,
    prescribe,
)
from corota.verification.shapes import gauss, shape

YOUNG, POISSON = 5.0, 0.25
REGION = [(0.0, 0.0), (1.0, 0.1), (1.15, 1.0), (0.1, 0.9)]
Field = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def potentials(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, gradient and rotation of the complex potentials, plane stress."""
    z = x[..., 0] + 1j * x[..., 1]
    mu, kappa = YOUNG / (2 * (1 + POISSON)), (3 - POISSON) / (1 + POISSON)
    phi, psi = np.exp(z), np.sin(z)
    w = (kappa * phi - z * np.conj(phi) - np.conj(psi)) / (2 * mu)
    # phi' = phi'' = phi; dw/dx = w_z + w_zbar, dw/dy = i (w_z - w_zbar).
    along = (kappa * phi - np.conj(phi)) / (2 * mu)
    across = (-z * np.conj(phi) - np.conj(np.cos(z))) / (2 * mu)
    dx, dy = along + across, 1j * (along - across)
    gradient = np.stack([np.stack([dx.real, dy.real], -1), np.stack([dx.imag, dy.imag], -1)], -2)
    rotation = 0.5 * (gradient[..., 1, 0] - gradient[..., 0, 1])
    return np.stack([w.real, w.imag], axis=-1), gradient, rotation


def waves(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, gradient and rotation of two sine waves."""
    p, q = x[..., 0], x[..., 1]
    u = np.stack([np.sin(2 * p + q), np.cos(p - 2 * q)], axis=-1)
    c, s = np.cos(2 * p + q), np.sin(p - 2 * q)
    gradient = np.stack([np.stack([2 * c, c], -1), np.stack([-s, 2 * s], -1)], -2)
    return u, gradient, 0.5 * (-s - c)


def waves_body_force(x: np.ndarray) -> np.ndarray:
    """Force per volume that holds `waves` in equilibrium, plane stress."""
    p, q = x[..., 0], x[..., 1]
    c, g = YOUNG / (1 - POISSON**2), YOUNG / (2 * (1 + POISSON))
    s, t = np.sin(2 * p + q), np.cos(p - 2 * q)
    u_xx, u_yy, u_xy = -4 * s, -s, -2 * s
    v_xx, v_yy, v_xy = -t, -4 * t, 2 * t
    return -np.stack(
        [
            c * (u_xx + POISSON * v_xy) + g * (u_yy + v_xy),
            c * (v_yy + POISSON * u_xy) + g * (v_xx + u_xy),
        ],
        axis=-1,
    )


def points_of(mesh: ct.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Shape functions (p, n), gradients (e, p, n, 2), places (e, p, 2), volumes (e, p)."""
    nodes = mesh.cells[0].nodes
    xi, weights = gauss(nodes.shape[1], 4)
    values, slopes = shape(nodes.shape[1], xi)
    x = mesh.points[nodes]
    jacobian = np.einsum("pnj,eni->epij", slopes, x)
    gradients = np.einsum("pnj,epji->epni", slopes, np.linalg.inv(jacobian))
    return values, gradients, np.einsum("pn,eni->epi", values, x), weights * np.linalg.det(jacobian)


def body_forces(mesh: ct.Mesh, force: Callable[[np.ndarray], np.ndarray]) -> list[Any]:
    """Consistent nodal forces of a field, with the shape functions of the cells."""
    values, _, places, volumes = points_of(mesh)
    parts = np.einsum("ep,epi,pn->eni", volumes, force(places), values)
    total = np.zeros((mesh.n_nodes, 2))
    np.add.at(total, mesh.cells[0].nodes, parts)
    return [ct.NodalForce(np.array([a]), i, float(v)) for (a, i), v in np.ndenumerate(total)]


SOLUTIONS: dict[str, tuple[Field, Callable[[np.ndarray], np.ndarray] | None]] = {
    "potentials": (potentials, None),
    "waves": (waves, waves_body_force),
}


def errors(element: str, n: int, solution: str) -> tuple[float, float]:
    """L2 norms of the errors of the interpolated displacement and of its gradient."""
    exact, force = SOLUTIONS[solution]
    model = ct.Model(ct.mesh.mapped(REGION, n, n, cell(element), "alternate"))
    mesh = model.mesh
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=POISSON))
    edge = boundary(mesh)
    u, _, rotation = exact(mesh.points[edge])
    prescribe(model, edge, u, rotation if element in DRILLING else None)
    if force is not None:
        model.loads += body_forces(mesh, force)
    found = linear(model).U[mesh.cells[0].nodes]
    values, gradients, places, volumes = points_of(mesh)
    u, slope, _ = exact(places)
    miss = np.einsum("pn,eni->epi", values, found) - u
    tilt = np.einsum("eni,epnj->epij", found, gradients) - slope
    return (
        float(np.sqrt((volumes[..., None] * miss**2).sum())),
        float(np.sqrt((volumes[..., None, None] * tilt**2).sum())),
    )


def measure() -> Iterator[Value]:
    """Both orders over the finest pair."""
    for solution in SOLUTIONS:
        for element in ELEMENTS:
            coarse, fine = errors(element, 8, solution), errors(element, 16, solution)
            first = 2.9 if element in QUADRATIC else 1.95
            for what, bound, a, b in zip(
                ("displacement", "gradient"), (first, first - 1.0), coarse, fine, strict=True
            ):
                yield Value(
                    f"order of the {what}, {element}, {solution}",
                    bound,
                    float(np.log2(a / b)),
                    0.0,
                    "at least",
                )


def study() -> Study:
    """Error of the displacement."""
    return Study.over(
        "error of the displacement (L2), potentials",
        ELEMENTS,
        (4, 8, 16, 32),
        lambda e, n: errors(e, n, "potentials")[0],
        "elements per side",
    )


PROBLEM = Problem(
    title="Orders on manufactured solutions",
    group="properties of the method",
    source="N. I. Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity, "
    "chapter 5",
    certainty="analytic",
    why="0.05 (0.1 for quadratic elements) below the theory on the finest pair",
    seconds=2.0,
)

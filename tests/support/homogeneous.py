"""Homogeneous states of finite strain: a reference program of a single point."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

import corota as ct
from corota.model.loads import Fixed
from support.audits import CELL, DRILLING, boundary, rotation


def strain_of(stretch: np.ndarray) -> np.ndarray:
    """Hencky strain from the right Cauchy-Green tensor."""
    values, vectors = np.linalg.eigh(stretch)
    return vectors @ np.diag(0.5 * np.log(values)) @ vectors.T


class Point:
    """J2 plasticity in three dimensions, radial return, linear hardenings.

    The stress through the thickness is made zero by a scalar equation for the thickness strain.
    """

    def __init__(self, E: float, nu: float, sy: float, H: float, K: float, plane: str) -> None:
        self.G, self.bulk = E / (2 + 2 * nu), E / (3 - 6 * nu)
        self.sy, self.H, self.K, self.plane = sy, H, K, plane
        self.ep, self.beta, self.p = np.zeros((3, 3)), np.zeros((3, 3)), 0.0
        self.ezz = 0.0

    def trial(self, e2: np.ndarray, ezz: float) -> tuple[Any, ...]:
        e = np.zeros((3, 3))
        e[:2, :2], e[2, 2] = e2, ezz
        ee = e - self.ep
        mean = np.trace(ee) / 3
        s = 2 * self.G * (ee - mean * np.eye(3))
        xi = s - self.beta
        q = math.sqrt(1.5) * np.linalg.norm(xi)
        dp = max(0.0, (q - self.sy - self.H * self.p) / (3 * self.G + self.H + self.K))
        flow = 1.5 * xi / q if q > 0 else xi
        stress = s - 2 * self.G * dp * flow + 3 * self.bulk * mean * np.eye(3)
        return stress, self.ep + dp * flow, self.beta + 2 / 3 * self.K * dp * flow, self.p + dp

    def move(self, e2: np.ndarray) -> np.ndarray:
        ezz = 0.0
        if self.plane == "stress":
            ezz = brentq(lambda z: self.trial(e2, z)[0][2, 2], -2.0, 2.0, xtol=1e-15, rtol=1e-14)
        stress, self.ep, self.beta, self.p = self.trial(e2, ezz)
        self.ezz = ezz
        return stress


def hencky_cauchy(point: Point, F: np.ndarray) -> np.ndarray:
    """Cauchy stress xx, yy, zz, xy; the stress conjugate to ln U by differences of dE/dC."""
    C = F.T @ F
    T = point.move(strain_of(C))
    S = np.zeros((2, 2))
    for i in range(2):
        for j in range(i, 2):
            dC = np.zeros((2, 2))
            dC[i, j] = dC[j, i] = 1.0
            h = 1e-5
            dE = (strain_of(C + h * dC) - strain_of(C - h * dC)) / (2 * h)
            S[i, j] = S[j, i] = 2 * np.sum(T[:2, :2] * dE) / (1 if i == j else 2)
    J = np.linalg.det(F) * math.exp(point.ezz)
    sigma = F @ S @ F.T / J
    return np.array([sigma[0, 0], sigma[1, 1], T[2, 2] / J, sigma[0, 1]])


def frame_angle(X: np.ndarray, F: np.ndarray) -> float:
    """Rotation that fits the nodes of one element best."""
    X = X - X.mean(axis=0)
    x = X @ F.T
    return math.atan2(np.sum(X[:, 0] * x[:, 1] - X[:, 1] * x[:, 0]), np.sum(X * x))


def linear_cauchy(point: Point, F: np.ndarray, X: np.ndarray) -> np.ndarray:
    """Stress of the linear local strain, turned with the frame."""
    R = rotation(frame_angle(X, F))
    H = R.T @ F - np.eye(2)
    T = point.move((H + H.T) / 2)
    sigma = R @ T[:2, :2] @ R.T
    return np.array([sigma[0, 0], sigma[1, 1], T[2, 2], sigma[0, 1]])


def drive(
    element: str, material: Any, plane: str, strain: str, path: list[np.ndarray], **section: Any
) -> Any:
    """Prescribe homogeneous deformations at the boundary of 2 x 2 equal cells, a step each."""
    mesh = ct.mesh.rectangle(2.0, 1.6, nx=2, ny=2, cell=CELL[element])
    model = ct.Model(mesh)
    section = {"thickness": 0.7} | section
    model.section(
        "all", element=element, material=material, plane=plane, local_strain=strain, **section
    )
    nodes = boundary(mesh)
    steps = []
    turn = 0.0
    for F in path:
        u = mesh.points @ (F - np.eye(2)).T
        supports = [Fixed([int(n)], d, float(u[n, d])) for n in nodes for d in (0, 1)]
        if element in DRILLING:  # the rotation of the field, or the sides would bulge
            angle = frame_angle(mesh.points[mesh.cells[0].nodes[0]], F)
            turn += (angle - turn + math.pi) % (2 * math.pi) - math.pi
            local = rotation(turn).T @ F
            spin = turn + 0.5 * (local[1, 0] - local[0, 1])
            supports += [Fixed([int(n)], 2, spin) for n in nodes]
        steps.append(ct.Static(supports=supports, increments=1, tolerance=1e-11))
    return ct.solve(model, steps, threads=1)


PATH = [
    np.array([[1.004, 0.0], [0.0, 1.0]]),
    rotation(1.1) @ np.array([[1.03, 0.02], [0.0, 0.99]]),
    rotation(1.9) @ np.array([[1.005, -0.01], [0.01, 1.0]]),
    rotation(2.6) @ np.array([[0.97, 0.0], [0.03, 1.01]]),
    rotation(3.3) @ np.array([[1.0, 0.0], [0.0, 1.0]]),
]

"""Objectivity: forces and stiffness of a strained body rotate with it, over more than one turn.

A patch of distorted cells is strained at random by a few percent and then rotated by multiples of
60 degrees up to 480, with drilling rotations beyond pi: the internal forces and the tangent must
rotate with it. A second measure rotates the unstrained patch by 0 to 720 degrees in steps of 5 and
translates it: the forces, relative to E times the size of a cell, must vanish.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.verification.catalogue import Problem, Value, zero
from corota.verification.models import DRILLING, ELEMENTS, assemble, cell

STRAINS = ("linear", "green_lagrange", "logarithmic")
YOUNG = 1000.0


def patch(element: str, strain: Any = "linear") -> ct.Model:
    """Distorted cells 2 x 2 on a rectangle 2 x 1."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 2, 2, cell(element)), 0.2, seed=3)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=0.3), local_strain=strain)
    return model


def turned(model: ct.Model, u: np.ndarray, angle: float, shift: float = 0.0) -> np.ndarray:
    """Displacements (and rotations) of the body in the state `u`, turned and moved."""
    x = model.mesh.points + u[:, :2]
    c, s = np.cos(angle), np.sin(angle)
    out: np.ndarray = u.copy()
    out[:, :2] = x @ np.array([[c, s], [-s, c]]) + shift - model.mesh.points
    out[:, 2:] += angle
    return out


def errors(element: str, strain: str) -> tuple[float, float]:
    """Largest differences of forces and tangents over their sizes, for all angles."""
    model = patch(element, strain)
    width = 3 if element in DRILLING else 2
    n = model.mesh.n_nodes
    u = np.random.default_rng(1).uniform(-0.02, 0.02, (n, width))
    force, tangent = assemble(model, u)
    force_error = tangent_error = 0.0
    for k in range(1, 9):
        angle = k * np.pi / 3.0
        q = np.eye(width)
        c, s = np.cos(angle), np.sin(angle)
        q[:2, :2] = [[c, -s], [s, c]]
        turn = np.kron(np.eye(n), q)
        f, k_turned = assemble(model, turned(model, u, angle))
        force_error = max(force_error, float(np.abs(f - turn @ force).max()))
        tangent_error = max(tangent_error, float(np.abs(k_turned - turn @ tangent @ turn.T).max()))
    return force_error / float(np.abs(force).max()), tangent_error / float(np.abs(tangent).max())


def rigid(element: str) -> float:
    """Largest internal force under rigid motions over E times the size of a cell."""
    model = patch(element)
    core = System(model, Multifrontal()).core
    width = 3 if element in DRILLING else 2
    zero = np.zeros((model.mesh.n_nodes, width))
    worst = 0.0
    for degrees in range(0, 721, 5):
        u = turned(model, zero, np.radians(degrees), 3.0).ravel()
        force, scale, values = np.empty(u.size), np.empty(u.size), np.empty(len(core.indices))
        core.assemble(u, True, force, scale, values)
        worst = max(worst, float(np.abs(force).max()))
    return worst / YOUNG


def measure() -> Iterator[Value]:
    """Every element; the turned strain for every local strain."""
    for element in ELEMENTS:
        yield zero(f"force under rigid motion, 0 to 720 degrees, {element}", rigid(element), 1e-11)
        for strain in STRAINS:
            force, tangent = errors(element, strain)
            yield zero(f"error of turned forces, {element}, {strain}", force, 1e-11)
            yield zero(f"error of turned stiffness, {element}, {strain}", tangent, 1e-11)


PROBLEM = Problem(
    title="Objectivity under large rotation",
    group="properties of the method",
    source="rigid motion changes no strain",
    certainty="analytic",
    why="rounding; internal forces are small differences of the stiffness times positions",
    seconds=1.0,
)

"""Contact patch: two blocks with non-matching meshes transmit a uniform pressure.

2 x 1 below 2 x 0.8, three cells on four, E = 1000, nu = 0.3, a pressure of 5 on top; every pair of
elements, also rotated by 30 degrees. With mortar contact on straight edges, the normal stress at
the interface equals the pressure everywhere, to rounding.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Value, zero
from corota.verification.models import ELEMENTS, cell, run

YOUNG, POISSON, PRESSURE = 1000.0, 0.3, 5.0


def blocks(low: str, up: str, angle: float = 0.0, overhang: float = 0.0) -> ct.Mesh:
    """Two blocks on each other, the upper one narrower by `overhang` at both sides."""
    a = ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(low))
    b = ct.mesh.rectangle(2.0 - 2.0 * overhang, 0.8, 4, 2, cell(up), origin=(overhang, 1.0))
    return ct.mesh.move(ct.mesh.assembly(low=a, up=b), angle=angle)


def axes(angle: float) -> np.ndarray:
    """Rotation matrix of an angle [degrees]."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array([[c, -s], [s, c]])


def hold(model: ct.Model, angle: float) -> None:
    """Supports that let both blocks strain freely: the bottom slides, one corner is fixed."""
    mesh, turn = model.mesh, axes(angle)
    for name in ("low.bottom", "up.top"):
        if angle:
            model.local_axes(mesh.node_sets[name], angle=np.radians(angle))
    # The uniform state needs moments at the corners of edges that bulge.
    model.fix("low.bottom", x=None, y=0.0, rotation=True)
    for name in ("low.bottom", "up.top"):
        nodes = mesh.node_sets[name]
        first = nodes[np.argmin((mesh.points[nodes] @ turn)[:, 0])]
        model.fix([first], x=0.0, y=None)


def solved(
    low: str,
    up: str,
    angle: float = 0.0,
    plane: Any = "stress",
    slave: str = "up",
    nlgeom: bool = True,
    overhang: float = 0.0,
    **options: Any,
) -> ct.Results:
    """The blocks under the pressure; `slave` is the one that the multipliers live on."""
    model = ct.Model(blocks(low, up, angle, overhang))
    material = ct.Elastic(E=YOUNG, nu=POISSON)
    # A uniform strain is exact at large deformation with the strain of the true gradient only.
    strain: Any = "green_lagrange" if nlgeom else "linear"
    for name, element in (("low", low), ("up", up)):
        model.section(
            name,
            element=element,
            material=material,
            thickness=0.5,
            plane=plane,
            local_strain=strain,
        )
    hold(model, angle)
    push = axes(angle) @ [0.0, -PRESSURE]
    model.traction("up.top", x=float(push[0]), y=float(push[1]))
    faces = ("up.bottom", "low.top") if slave == "up" else ("low.top", "up.bottom")
    model.contact(*faces, **options)
    return run(model, ct.Static(nlgeom=nlgeom), fields=True)


def stresses(results: ct.Results, angle: float) -> np.ndarray:
    """Stress at all points in the axes of the interface, shape (n, 3): along, across, shear."""
    s = np.concatenate([b.values["S"].reshape(-1, 4) for b in results.frames[-1].fields])
    full = np.array([[s[:, 0], s[:, 3]], [s[:, 3], s[:, 1]]])
    turn = axes(angle)
    local = np.einsum("ji,jkn,kl->iln", turn, full, turn)
    return np.column_stack([local[0, 0], local[1, 1], local[0, 1]])


def measure() -> Iterator[Value]:
    """Largest error of the stress over the pressure, each element below and above."""
    for k, low in enumerate(ELEMENTS):
        worst = 0.0
        for m, up in enumerate(ELEMENTS):
            angle, plane = (30.0, "strain") if (k + m) % 2 else (0.0, "stress")
            slave = "low" if (k + m) % 3 else "up"
            found = stresses(solved(low, up, angle, plane, slave, nlgeom=False), angle)
            worst = max(worst, float(np.abs(found - [0.0, -PRESSURE, 0.0]).max()) / PRESSURE)
        yield zero(f"stress error, {low} below every element", worst, 1e-10)


PROBLEM = Problem(
    title="Contact patch test",
    group="contact",
    source="R. L. Taylor, P. Papadopoulos, in Computational Plasticity (1991)",
    certainty="analytic",
    why="rounding",
    picture=lambda: Picture(solved("Q4I", "T6", nlgeom=False), "U2", 20.0),
    seconds=2.0,
)

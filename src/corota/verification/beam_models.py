"""Lee's frame, Williams' toggle, a deep arch and von Mises' truss of beams and bars."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize_scalar

import corota as ct
from corota.mesh.data import Cells, Mesh

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def polyline(points: ArrayLike) -> Mesh:
    """A mesh of lines from point to point, shape (n, 2)."""
    x = np.asarray(points, dtype=np.float64)
    first = np.arange(len(x) - 1)
    cells = Cells("line2", np.stack([first, first + 1], axis=1), first + 1)
    return Mesh(x, [cells], np.arange(1, len(x) + 1))


def _beams(
    points: ArrayLike, young: float, nu: float, area: float, inertia: float, shear: float
) -> ct.Model:
    model = ct.Model(polyline(points))
    lines = np.arange(model.mesh.n_cells)
    material = ct.Elastic(E=young, nu=nu)
    model.beam(lines, material=material, area=area, inertia=inertia, shear_area=shear * area)
    return model


def lee_frame(n: int = 60, shear: bool = True, scale: float = 1.0) -> tuple[ct.Model, int]:
    """Lee's frame: two legs of 120 with `n` beams each, A = 6, I = 2, E = 720, nu = 0.3.

    `scale` changes the unit of length; forces stay. The loaded node, 24 from the corner, comes
    with it; `n` must be a multiple of five.
    """
    leg = np.linspace(0.0, 120.0, n + 1)
    up, right = np.stack([0.0 * leg, leg], axis=1), np.stack([leg, 0.0 * leg + 120.0], axis=1)
    points = scale * np.concatenate([up, right[1:]])
    k = 5.0 / 6.0 if shear else 0.0
    model = _beams(points, 720.0 / scale**2, 0.3, 6.0 * scale**2, 2.0 * scale**4, k)
    model.fix([0, 2 * n])
    loaded = n + n // 5
    model.force([loaded], y=-1.0)
    return model, loaded


def williams_toggle(n: int = 60, shear: bool = True) -> tuple[ct.Model, int]:
    """Half of Williams' toggle, with the load of the whole: half span 12.943 in, rise .386."""
    way = np.linspace(0.0, 1.0, n + 1)
    points = np.stack([12.943 * way, 0.386 * way], axis=1)
    area, inertia = 0.753 * 0.243, 0.753 * 0.243**3 / 12.0
    model = _beams(points, 1.03e7, 0.3, area, inertia, 5.0 / 6.0 if shear else 0.0)
    model.fix([0], rotation=True)
    model.fix([n], y=None, rotation=True)
    model.force([n], y=-0.5)
    return model, n


def deep_arch(n: int = 160) -> tuple[ct.Model, int]:
    """Arch of 215 degrees, R = 100, EI = 1e6, EA = kGA = 1e8: hinged left, clamped right.

    The load factor is the load over 1000. `n` must be even.
    """
    angle = np.radians(90.0 + np.linspace(107.5, -107.5, n + 1))
    points = 100.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    model = _beams(points, 1e8, -0.5, 1.0, 0.01, 1.0)
    model.fix([0])
    model.fix([n], rotation=True)
    model.force([n // 2], y=-1000.0)
    return model, n // 2


def von_mises_truss(rise: float = 1.0, scale: float = 1.0) -> tuple[ct.Model, int]:
    """Two bars of half span 10 and EA = 1000 under a force on the apex."""
    points = scale * np.array([[0.0, 0.0], [10.0, rise], [20.0, 0.0]])
    model = ct.Model(polyline(points))
    model.truss([0, 1], material=ct.Elastic(E=1000.0 / scale**2), area=scale**2)
    model.fix([0, 2])
    model.force([1], y=-1.0)
    return model, 1


def von_mises_limits(rise: float = 1.0) -> tuple[float, float]:
    """Both limit loads of the truss with strain (l - l0) / l0, from the derivative's zeros."""
    before = np.hypot(10.0, rise)

    def load(height: float) -> float:
        now = np.hypot(10.0, height)
        return float(-2.0 * 1000.0 * (now - before) / before * height / now)

    found = minimize_scalar(
        lambda h: -load(h), bounds=(0.0, rise), method="bounded", options={"xatol": 1e-12}
    )
    return -float(found.fun), float(found.fun)

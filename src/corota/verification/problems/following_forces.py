"""Columns under follower forces: critical loads and the kind of instability.

Beck's column carries a tangential force at its end, Leipholz' column a tangential force distributed
over its length, and Ziegler's pendulum (two rigid bars on torsion springs, masses 2 and 1) one at
its end. None of these forces has a potential: two frequencies coalesce and become complex
(flutter), although there is no other static equilibrium. Under a dead force the first column
diverges. The critical loads are bracketed by halving; loads are in units of E I / L^2, E I / L^3
and k / L. Small equal damping in both joints lowers Ziegler's load (his paradox). The curves are
those of Beck's column; m is its mass per length.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from corota.mesh.data import Cells, Mesh
from corota.verification.catalogue import Curve, Picture, Problem, Value, zero
from corota.verification.models import cell, run

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

YOUNG, LENGTH, DEPTH = 1e4, 10.0, 0.25
INERTIA = DEPTH**3 / 12.0


def column(element: str, nx: int) -> ct.Model:
    """A clamped column of slenderness 40."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, DEPTH, nx=nx, ny=1, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=YOUNG, nu=0.0, rho=1.0))
    model.fix("left")
    return model


def modes(model: ct.Model, damped: bool = False) -> ct.Modes:
    """Modes of the loaded state, for the search of instabilities."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return run(model, [ct.Static(), ct.Frequency(modes=2, complex_modes=damped)]).modes[-1]


def beck(load: float, element: str = "Q8", nx: int = 16) -> ct.Modes:
    """A pressure on the end."""
    model = column(element, nx)
    model.pressure("right", load * YOUNG * INERTIA / LENGTH**2 / DEPTH)
    return modes(model)


def dead(load: float) -> ct.Modes:
    """A force that keeps its direction."""
    model = column("Q8", 16)
    model.traction("right", x=-load * YOUNG * INERTIA / LENGTH**2 / DEPTH)
    return modes(model)


def leipholz(load: float, nx: int = 32) -> ct.Modes:
    """A pressure on the cross-section behind each element, on the last of half the size."""
    model = column("Q8", nx)
    each = load * YOUNG * INERTIA / LENGTH**3 * (LENGTH / nx) / DEPTH
    start = model.mesh.points[model.mesh.cells[0].nodes[:, 0], 0]
    for k, element in enumerate(np.argsort(start).tolist()):
        model.pressure(np.array([[element, 1]]), each if k < nx - 1 else 0.5 * each)
    return modes(model)


def ziegler(load: float, damping: float = 0.0) -> ct.Modes:
    """Two rigid bars of length 1, springs of 1, a small block at the end for the pressure."""
    h = 0.1
    block = [(2.0, -h / 2), (2.0 + h, -h / 2), (2.0 + h, h / 2), (2.0, h / 2)]
    points = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (2.0, 0.0), *block, (0.0, 0.0), (1.0, 0.0)]
    points = points if damping else points[:-1]
    bars = Cells("line2", np.array([[0, 1], [2, 3], [1, 2], [8, 0]]), np.arange(1, 5))
    quads = Cells("quad4", np.array([[4, 5, 6, 7]]), np.array([5]))
    model = ct.Model(Mesh(np.array(points), [bars, quads], np.arange(1, len(points) + 1)))
    light = ct.Elastic(E=1e6, nu=0.0, rho=1e-9)
    model.beam([0, 1], material=light, area=1.0, inertia=1.0)
    model.spring([2, 3], 1.0, "rotation")
    model.section([4], element="Q4", material=light)
    for dof in ("x", "y"):
        model.equation((2, dof, 1.0), (1, dof, -1.0))
    model.rigid([4, 5, 6, 7], 3)
    model.fix([0])
    model.fix([8], rotation=True)
    model.point_mass([1], 2.0)
    model.point_mass([3], 1.0)
    model.pressure(np.array([[4, 1]]), load / h)
    if damping:
        # A dashpot turns against the ground: a node of its own has the angle of the second joint.
        model.equation((9, "rotation", 1.0), (2, "rotation", -1.0), (1, "rotation", 1.0))
        model.dashpot(0, rotation=damping)
        model.dashpot(9, rotation=damping)
    return modes(model, bool(damping))


def critical(grows: Callable[[float], ct.Modes], low: float, high: float) -> tuple[float, float]:
    """Load from which a mode grows, to 0.1 %, and the frequency at which it does."""
    found = grows(high)
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        now = grows(middle)
        if now.growth.max() > 1e-9:
            high, found = middle, now
        else:
            low = middle
    return 0.5 * (low + high), float(found.factors[int(found.growth.argmax())])


def measure() -> Iterator[Value]:
    """Critical loads and frequencies of the growing mode."""
    unit = float(np.sqrt(YOUNG * INERTIA / (DEPTH * LENGTH**4))) / (2.0 * np.pi)
    for element, nx in (("Q8", 24), ("Q4I", 48)):
        load, f = critical(lambda p, e=element, n=nx: beck(p, e, n), 18.0, 22.0)  # type: ignore[misc]
        yield Value(f"Beck, critical load, {element}", 20.05, load, 0.01)
        yield Value(f"Beck, frequency of flutter, {element}", 11.016, f / unit, 0.02)
    load, f = critical(dead, 2.0, 3.0)
    yield Value("dead force, critical load, Q8", np.pi**2 / 4.0, load, 0.01)
    yield zero("dead force, frequency of divergence, Q8", f / unit, 1e-6)
    load, f = critical(leipholz, 36.0, 44.0)
    yield Value("Leipholz, critical load, Q8", 40.05, load, 0.01)
    yield Value("Leipholz, flutter: frequency above, Q8", 1.0, f / unit, 0.0, "at least")
    load, f = critical(ziegler, 1.5, 2.5)
    yield Value("Ziegler, critical load", 3.5 - np.sqrt(2.0), load, 2e-3)
    yield Value("Ziegler, flutter: frequency above", 0.1, f, 0.0, "at least")
    load, _ = critical(lambda p: ziegler(p, 1e-3), 1.2, 1.8)
    yield Value("Ziegler, critical load with a little damping", 41.0 / 28.0, load, 5e-3)


def curve() -> Curve:
    """Frequencies of Beck's column and their growth over the load."""
    unit = float(np.sqrt(YOUNG * INERTIA / (DEPTH * LENGTH**4))) / (2.0 * np.pi)
    loads = np.r_[np.linspace(0.0, 19.0, 20), np.linspace(19.5, 21.0, 13), np.linspace(22, 26, 5)]
    found = [beck(float(p)) for p in loads]
    lines: dict[str, tuple[ArrayLike, ArrayLike]] = {}
    # Beyond flutter both have become one pair with the first frequency.
    same = [0 if m.growth.max() > 1e-9 else 1 for m in found]
    lines["frequency of mode 1"] = (loads, [m.factors[0] / unit for m in found])
    second = [m.factors[k] / unit for m, k in zip(found, same, strict=True)]
    lines["frequency of mode 2"] = (loads, second)
    lines["growth rate"] = (loads, [m.growth.max() / (2.0 * np.pi * unit) for m in found])
    return Curve(
        "P L^2 / (E I)",
        "rate / sqrt(E I / (m L^4))",
        lines,
        {"flutter (Beck)": ([20.05], [11.016])},
    )


PROBLEM = Problem(
    title="Following forces: Beck, Leipholz and Ziegler",
    group="dynamics",
    source="M. Beck, Z. angew. Math. Phys. 3 (1952) 225-228; H. Leipholz, Z. angew. Math. Phys. 13 "
    "(1962) 359-372; H. Ziegler, Ingenieur-Archiv 20 (1952) 49-56; values as in V. V. Bolotin, "
    "Nonconservative Problems of the Theory of Elastic Stability (1963)",
    certainty="published",
    why="the columns are solids of slenderness 40 with shear and rotary inertia, and coarse; loads "
    "are bracketed to 0.1 %",
    picture=lambda: Picture(column("Q8", 16)),
    seconds=6.0,
)

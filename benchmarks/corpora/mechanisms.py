"""Plane mechanisms of flexible bars: one description for every program, and its run in Corota."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import corota as ct
from corota.mesh.data import Cells, Mesh

Floats = NDArray[np.float64]
#: One end of a bar: its number, and 0 for the start or 1 for the end.
End = tuple[int, int]


@dataclass(frozen=True)
class Bar:
    """A straight flexible bar between two points; stiffness and mass per length."""

    start: tuple[float, float]
    end: tuple[float, float]
    ea: float
    ei: float
    ga: float
    mass: float

    @property
    def length(self) -> float:
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))


@dataclass(frozen=True)
class Mechanism:
    """Bars, joints, masses and what drives them.

    Parameters
    ----------
    bars : list of Bar
    period : float
    pins : list of (End, End)
        Ends that share a point and turn freely.
    held : list of (End, str)
        Ends with fixed displacements, "x", "y" or "xy".
    angle : callable or None
        Rotation over time [rad] of the start of the first bar, prescribed.
    masses : list of (End, float)
    gravity : float
        Acceleration along -y.
    increments : int
        Of our coarsest run, a multiple of SAMPLES.
    quantities : dict of str to callable
        What is compared, from the time, shape (t,), and the positions of the nodes of each bar,
        shape (t, n + 1, 2): shape (t,).
    """

    bars: list[Bar]
    period: float
    quantities: dict[str, Callable[[Floats, list[Floats]], Floats]]
    pins: list[tuple[End, End]] = field(default_factory=list)
    held: list[tuple[End, str]] = field(default_factory=list)
    angle: Callable[[float], float] | None = None
    masses: list[tuple[End, float]] = field(default_factory=list)
    gravity: float = 0.0
    increments: int = 300


#: Times at which programs are compared, the start besides.
SAMPLES = 150


def from_chord(bar: int, share: float = 0.5) -> Callable[[Floats, list[Floats]], Floats]:
    """Distance of a point of a bar from the line of its ends."""

    def measure(_: Floats, x: list[Floats]) -> Floats:
        first, last = x[bar][:, 0], x[bar][:, -1]
        chord = last - first
        chord /= np.linalg.norm(chord, axis=1)[:, None]
        r = x[bar][:, round(share * (x[bar].shape[1] - 1))] - first
        return np.asarray(chord[:, 0] * r[:, 1] - chord[:, 1] * r[:, 0])

    return measure


def coordinate(bar: int, node: int, axis: int) -> Callable[[Floats, list[Floats]], Floats]:
    """Displacement of a node."""
    return lambda _, x: x[bar][:, node, axis] - x[bar][0, node, axis]


def spin_angle(t: float) -> float:
    """Simo and Vu-Quoc's maneuver: from rest to 6 rad/s in 15 s."""
    if t >= 15.0:
        return 6.0 * t - 45.0
    return 0.4 * (0.5 * t * t + (7.5 / np.pi) ** 2 * (np.cos(2.0 * np.pi * t / 15.0) - 1.0))


def beside_shadow(axis: int) -> Callable[[Floats, list[Floats]], Floats]:
    """Displacement of the tip in the frame that turns as prescribed."""

    def measure(time: Floats, x: list[Floats]) -> Floats:
        psi = np.array([spin_angle(t) for t in time])
        c, s = np.cos(psi), np.sin(psi)
        r = x[0][:, -1] - x[0][:, 0]
        along, across = c * r[:, 0] + s * r[:, 1], c * r[:, 1] - s * r[:, 0]
        return np.asarray(along - along[0] if axis == 0 else across)

    return measure


def start_up(speed: float, time: float) -> Callable[[float], float]:
    """Angle of a drive that comes smoothly to its speed."""

    def angle(t: float) -> float:
        if t >= time:
            return speed * (t - 0.5 * time)
        return speed * (
            0.5 * t * t / time + time / (4.0 * np.pi**2) * (np.cos(2 * np.pi * t / time) - 1.0)
        )

    return angle


def spin_up() -> Mechanism:
    """A beam that is spun up about its end (Simo and Vu-Quoc 1986, part II)."""
    bar = Bar((0.0, 0.0), (10.0, 0.0), ea=2.8e7, ei=1.4e4, ga=1e7, mass=1.2)
    return Mechanism(
        [bar],
        20.0,
        {"tip, along": beside_shadow(0), "tip, across": beside_shadow(1)},
        held=[((0, 0), "xy")],
        angle=spin_angle,
        increments=900,
    )


def pendulum() -> Mechanism:
    """A very flexible rod that falls from the horizontal about a pin."""
    bar = Bar((0.0, 0.0), (1.0, 0.0), ea=1e5, ei=0.5, ga=4e4, mass=1.0)
    return Mechanism(
        [bar],
        1.2,
        {
            "tip x": coordinate(0, -1, 0),
            "tip y": coordinate(0, -1, 1),
            "middle from chord": from_chord(0),
        },
        held=[((0, 0), "xy")],
        gravity=9.81,
    )


def slider_crank() -> Mechanism:
    """Crank of .15, rod of .3 and a slider; the rod bends."""
    crank = Bar((0.0, 0.0), (0.15, 0.0), ea=2e6, ei=20.0, ga=8e5, mass=0.25)
    rod = Bar((0.15, 0.0), (0.45, 0.0), ea=8e5, ei=2.0, ga=3.2e5, mass=0.2)
    return Mechanism(
        [crank, rod],
        0.25,
        {"slider x": coordinate(1, -1, 0), "middle of rod from chord": from_chord(1)},
        pins=[((0, 1), (1, 0))],
        held=[((0, 0), "xy"), ((1, 1), "y")],
        angle=start_up(100.0, 0.08),
        masses=[((1, 1), 0.03)],
    )


def four_bar() -> Mechanism:
    """A crank that turns, a coupler and a rocker, all flexible, under gravity."""
    crank = Bar((0.0, 0.0), (0.0, 0.2), ea=4e5, ei=4.0, ga=1.6e5, mass=0.3)
    coupler = Bar((0.0, 0.2), (0.7, 0.5), ea=2e5, ei=2.0, ga=8e4, mass=0.2)
    rocker = Bar((0.7, 0.5), (0.7, 0.0), ea=2e5, ei=2.0, ga=8e4, mass=0.2)
    return Mechanism(
        [crank, coupler, rocker],
        1.0,
        {
            "rocker x": coordinate(2, 0, 0),
            "middle of coupler from chord": from_chord(1),
            "middle of rocker from chord": from_chord(2),
        },
        pins=[((0, 1), (1, 0)), ((1, 1), (2, 0))],
        held=[((0, 0), "xy"), ((2, 1), "xy")],
        angle=start_up(12.0, 0.5),
        gravity=9.81,
    )


MECHANISMS: dict[str, Callable[[], Mechanism]] = {
    "spin_up": spin_up,
    "pendulum": pendulum,
    "slider_crank": slider_crank,
    "four_bar": four_bar,
}


def measured(mechanism: Mechanism, time: Floats, x: list[Floats]) -> dict[str, Floats]:
    """All quantities of a run."""
    return {name: f(time, x) for name, f in mechanism.quantities.items()}


def amplitude(angle: Callable[[float], float], period: float, increments: int) -> ct.Amplitude:
    """Table of a drive at the ends of the increments."""
    time = np.linspace(0.0, period, increments + 1)
    return ct.Amplitude(time, np.array([angle(t) for t in time]))


def with_beams(
    mechanism: Mechanism, cells: int, increments: int, scheme: str
) -> tuple[Floats, list[Floats]]:
    """Run with `cells` beams a bar; times and positions of the nodes of each bar."""
    points, lines, first = [], [], []
    for bar in mechanism.bars:
        first.append(sum(len(p) for p in points))
        points.append(np.linspace(bar.start, bar.end, cells + 1))
        n = first[-1] + np.arange(cells)
        lines.append(np.column_stack([n, n + 1]))
    connected = np.vstack(lines)
    total = len(mechanism.bars) * (cells + 1)
    mesh = Mesh(
        np.vstack(points),
        [Cells("line2", connected, np.arange(1, len(connected) + 1))],
        np.arange(1, total + 1),
    )
    model = ct.Model(mesh)
    young = 1e6
    for k, bar in enumerate(mechanism.bars):
        area = bar.ea / young
        material = ct.Elastic(E=young, nu=0.0, rho=bar.mass / area)
        model.beam(
            k * cells + np.arange(cells),
            material=material,
            area=area,
            inertia=bar.ei / young,
            shear_area=2.0 * bar.ga / young,
        )

    def node(end: End) -> int:
        return first[end[0]] + end[1] * cells

    for one, other in mechanism.pins:
        for dof in ("x", "y"):
            model.equation((node(other), dof, 1.0), (node(one), dof, -1.0))
    for end, dofs in mechanism.held:
        model.fix([node(end)], **{d: 0.0 if d in dofs else None for d in ("x", "y")})
    if mechanism.angle is not None:
        model.amplitudes["drive"] = amplitude(mechanism.angle, mechanism.period, increments)
        model.fix([0], x=None, y=None, rotation=1.0, amplitude="drive")
    for end, mass in mechanism.masses:
        model.point_mass([node(end)], mass)
    if mechanism.gravity:
        model.gravity(y=-mechanism.gravity)
    frames = ct.solve(
        model,
        ct.Dynamic(period=mechanism.period, increments=increments, scheme=scheme),
        fields=False,
        threads=1,
    ).frames
    time = np.array([f.time for f in frames])
    x = mesh.points + np.array([f.U[:, :2] for f in frames])
    return time, [x[:, n : n + cells + 1] for n in first]


def with_planes(
    mechanism: Mechanism, element: str, cells: int, increments: int, scheme: str
) -> tuple[Floats, list[Floats]]:
    """Run a mechanism of one bar as a strip of planar elements, with its line's positions.

    Depth and Poisson's ratio follow from the stiffnesses; the held end is a rigid section.
    """
    (bar,) = mechanism.bars
    depth = float(np.sqrt(12.0 * bar.ei / bar.ea))
    thickness = 1.0 / depth
    poisson = 5.0 * bar.ea / (12.0 * bar.ga) - 1.0
    mesh = ct.mesh.rectangle(bar.length, depth, nx=cells, ny=2, cell="quad8")
    mesh = ct.mesh.move(mesh, (0.0, -0.5 * depth))
    line = np.flatnonzero(np.abs(mesh.points[:, 1]) < 1e-9 * bar.length)
    line = line[np.argsort(mesh.points[line, 0])]
    points = np.vstack([mesh.points, [[0.0, 0.0]]])
    mesh = Mesh(points, mesh.cells, np.arange(1, len(points) + 1), mesh.node_sets, mesh.cell_sets)
    model = ct.Model(mesh)
    material = ct.Elastic(E=bar.ea, nu=poisson, rho=bar.mass)
    model.section("all", element=element, material=material, thickness=thickness)
    reference = len(points) - 1
    left = np.flatnonzero(np.abs(mesh.points[:-1, 0]) < 1e-9 * bar.length)
    model.rigid(left, reference)
    model.fix([reference])
    if mechanism.angle is not None:
        model.amplitudes["drive"] = amplitude(mechanism.angle, mechanism.period, increments)
        model.fix([reference], x=None, y=None, rotation=1.0, amplitude="drive")
    if mechanism.gravity:
        model.gravity(y=-mechanism.gravity)
    frames = ct.solve(
        model,
        ct.Dynamic(period=mechanism.period, increments=increments, scheme=scheme),
        fields=False,
        threads=1,
    ).frames
    time = np.array([f.time for f in frames])
    return time, [np.array([mesh.points[line] + f.U[line, :2] for f in frames])]

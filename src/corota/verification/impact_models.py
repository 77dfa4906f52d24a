"""Impacts on a rigid wall that examples and problems share: an elastic bar, yielding rings."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import corota as ct
from corota.model.materials import Material
from corota.verification.models import cell

#: The elastic bar: length, modulus, density, speed, and the speed of its waves.
LENGTH, YOUNG, DENSITY, SPEED = 10.0, 900.0, 1.0, 0.1
WAVE = (YOUNG / DENSITY) ** 0.5
#: The ring: outer radius, depth of its wall, modulus, yield stress, hardening.
RADIUS, DEPTH, RING_YOUNG = 1.0, 0.1, 1e4
YIELD, HARDENING = 60.0, 200.0


@dataclass
class Impact:
    """Results of an impact, relative to the exact values except for the contacts.

    Parameters
    ----------
    contacts : int
        Number of contacts of the bar with the wall.
    duration, force, rebound, energy : float
        Time in contact, largest force, velocity of the center of mass and energy at the end.
    mean_force, shortening : float
        Impulse over the exact duration, and how much shorter the bar gets.
    iterations : float
        Newton iterations an increment.
    history : ndarray, shape (n, 3)
        Time over 2 L / c, force over rho c A v, energy over that of the start.
    """

    contacts: int
    duration: float
    force: float
    rebound: float
    energy: float
    mean_force: float
    shortening: float
    iterations: float
    history: np.ndarray


def bar(element: str = "Q4I", cells: int = 200, unit: float = 1.0, **contact: Any) -> ct.Model:
    """Build the bar, just touching the wall x = 0, on its way into it.

    `unit` is one meter in the unit of length; masses stay, so stresses scale with 1 / unit.
    """
    length = LENGTH * unit
    height = length / cells * 2.0
    mesh = ct.mesh.rectangle(length, height, nx=cells, ny=1, cell=cell(element))
    model = ct.Model(mesh, name="bar")
    material = ct.Elastic(E=YOUNG / unit, nu=0.0, rho=DENSITY / unit**3)
    model.section("all", element=element, material=material, thickness=unit**2 / height)
    model.fix("bottom", x=None)
    model.velocity(x=-SPEED * unit)
    wall = ct.RigidCurve.line((0.0, unit + height), (0.0, -unit))
    model.contact("left", wall, name="wall", **contact)
    return model


def run_bar(
    element: str = "Q4I",
    scheme: str = "hht",
    cells: int = 200,
    redistribute: bool = True,
    mass: Any = "consistent",
    step: float = 0.5,
    unit: float = 1.0,
    **contact: Any,
) -> ct.Results:
    """Run the impact; `step` is the increment over the time of a wave through a cell, or 0.

    Contact with mass creates energy, which is the purpose of the run: there is no warning.
    """
    period = 2.6 * LENGTH / WAVE
    dynamic = ct.Dynamic(
        period=period,
        increments=round(period / (step * LENGTH / cells / WAVE)) if step else 0,
        scheme=scheme,
        mass=mass,
        redistribute=redistribute,
    )
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "energy balance")
        return ct.solve(bar(element, cells, unit, **contact), dynamic, fields=False)


def strike(element: str = "Q4I", scheme: str = "hht", **options: Any) -> Impact:
    """Run the impact and measure it; options as for :func:`run_bar`."""
    exact = 2.0 * LENGTH / WAVE
    results = run_bar(element, scheme, **options)
    frames = results.frames[1:]
    end = results.mesh.nodes_of("right")
    shorter = max(-float(f.U[end, 0].mean()) for f in frames)
    value = {n: np.array([f.scalars[n] for f in frames]) for n in frames[-1].scalars}
    time = np.array([f.time for f in frames])
    force = value["wall: force x"]
    closed = force > 1e-6 * force.max()
    total = value["kinetic energy"] + value["internal work"]
    first = 0.5 * DENSITY * LENGTH * SPEED**2
    return Impact(
        contacts=int(closed[0]) + int((np.diff(closed.astype(int)) > 0).sum()),
        duration=float(np.ptp(time[closed])) / exact if closed.any() else 0.0,
        force=float(force.max() / (DENSITY * WAVE * SPEED)),
        rebound=float(value["momentum x"][-1] / (DENSITY * LENGTH * SPEED)),
        energy=float(total[-1] / first),
        mean_force=float(force @ value["dt"] / exact / (DENSITY * WAVE * SPEED)),
        shortening=shorter / (SPEED * LENGTH / WAVE),
        iterations=float(value["iterations"].mean()),
        history=np.column_stack([time / exact, force / (DENSITY * WAVE * SPEED), total / first]),
    )


@dataclass
class Flight:
    """Results of the ring; energies over the initial kinetic energy.

    Parameters
    ----------
    rebound : float
        Velocity of the center of mass at the end over that of the start.
    kinetic, strain, plastic, energy_error : float
        Energies at the end, and the largest energy-balance error at any time.
    sideways : float
        Largest momentum along the wall over that of the start.
    squash : float
        Height of the body at the end, over that at rest, minus one.
    released : float
        Time at which the ring finally leaves the wall [time].
    iterations : float
        Newton iterations an increment.
    history : dict of ndarray
        Time, force and the energies.
    """

    rebound: float
    kinetic: float
    strain: float
    plastic: float
    energy_error: float
    sideways: float
    squash: float
    released: float
    iterations: float
    history: dict[str, np.ndarray] = field(default_factory=dict)
    results: ct.Results | None = None


def ring(
    element: str = "Q4I",
    around: int = 64,
    through: int = 2,
    *,
    plastic: bool = False,
    speed: float = 2.0,
    sideways: float = 0.0,
    spin: float = 0.0,
    unit: float = 1.0,
    local_strain: Any = "green_lagrange",
    body: str = "ring",
    **contact: Any,
) -> ct.Model:
    """Build the ring, or a bar upright, nearly touching the wall y = 0.

    `around` counts the elements along the ring or bar; `sideways` and `spin` are velocities along
    the wall and about the center, `contact` goes to the pair; `unit` is one meter in the unit of
    length. Masses stay, so stresses scale with 1 / unit (force = mass length / time^2).
    """
    if body == "bar":
        # 1 x 0.2, standing on the wall; it bulges at the foot like a Taylor bar.
        mesh = ct.mesh.rectangle(
            0.2 * unit, RADIUS * unit, nx=through, ny=around, cell=cell(element)
        )
        mesh = ct.mesh.move(mesh, (-0.1 * unit, 0.001 * RADIUS * unit))
    else:
        mesh = ct.mesh.annulus(
            (RADIUS - DEPTH) * unit,
            RADIUS * unit,
            n_radial=through,
            n_around=around,
            cell=cell(element),
            center=(0.0, 1.001 * RADIUS * unit),
        )
    model = ct.Model(mesh, name=body)
    stress, density = 1.0 / unit, DENSITY / unit**3
    material: Material = ct.Elastic(E=RING_YOUNG * stress, nu=0.3, rho=density)
    if plastic:
        material = ct.Mises(
            E=RING_YOUNG * stress,
            nu=0.3,
            rho=density,
            yield_stress=YIELD * stress,
            isotropic=HARDENING * stress,
        )
    model.section(
        "all", element=element, material=material, thickness=unit, local_strain=local_strain
    )
    center = (0.0, 1.001 * RADIUS * unit)
    model.velocity(x=sideways * unit, y=-speed * unit, spin=spin, about=center)
    # The body lies to the left of the line, above it.
    wall = ct.RigidCurve.line((-3.0 * unit, 0.0), (3.0 * unit, 0.0))
    model.contact("outer" if body == "ring" else "bottom", wall, name="wall", **contact)
    return model


def run_ring(
    element: str = "Q4I",
    around: int = 64,
    through: int = 2,
    *,
    plastic: bool = False,
    scheme: str = "energy_momentum",
    period: float = 1.0,
    increments: int = 0,
    mass_kind: Any = "consistent",
    redistribute: bool = True,
    tolerance: float = 5e-3,
    **options: Any,
) -> ct.Results:
    """Run the impact; 0 increments for automatic ones, other options as for :func:`ring`."""
    model = ring(
        element,
        around,
        through,
        plastic=plastic,
        local_strain="linear" if plastic else "green_lagrange",
        **options,
    )
    step = ct.Dynamic(
        period=period,
        increments=increments,
        first_increment=2e-3,
        error_tolerance=tolerance,
        scheme=scheme,
        mass=mass_kind,
        redistribute=redistribute,
    )
    return ct.solve(model, step)


def fly(
    element: str = "Q4I",
    *,
    speed: float = 2.0,
    unit: float = 1.0,
    increments: int = 200,
    **options: Any,
) -> Flight:
    """Run the impact and measure it; options as for :func:`run_ring`."""
    results = run_ring(element, speed=speed, unit=unit, increments=increments, **options)
    frames = results.frames

    def total(name: str) -> np.ndarray:
        """Integral of a density over the ring, each frame but the first."""
        return np.array(
            [
                sum(float((f.volume * f.values.get(name, 0.0)).sum()) for f in frame.fields)
                for frame in frames[1:]
            ]
        )

    value = {n: np.array([f.scalars[n] for f in frames[1:]]) for n in frames[-1].scalars}
    mass = mass_of(results)
    first = 0.5 * mass * (speed * unit) ** 2
    kinetic = value["kinetic energy"] / first
    strain, worked = value["strain energy"] / first, total("PWORK") / first
    force = value["wall: force y"]
    closed = force > 1e-9 * force.max()
    time = np.array([f.time for f in frames[1:]])
    rest = results.mesh.points[:, 1]
    y = rest + frames[-1].U[:, 1]
    momentum = mass * speed * unit
    return Flight(
        rebound=float(value["momentum y"][-1] / momentum),
        kinetic=float(kinetic[-1]),
        strain=float(strain[-1]),
        plastic=float(worked[-1]),
        energy_error=float(np.abs(kinetic + strain + worked - 1.0).max()),
        sideways=float(np.abs(value["momentum x"]).max() / momentum),
        squash=float(np.ptp(y) / np.ptp(rest) - 1.0),
        released=float(time[closed][-1]) if closed.any() else 0.0,
        iterations=float(value["iterations"].mean()),
        history={
            "time": time,
            "force": force,
            "kinetic": kinetic,
            "strain": strain,
            "plastic": worked,
        },
        results=results,
    )


def mass_of(results: ct.Results) -> float:
    """Mass of the ring from the volume of its quadrature points."""
    rho = results.model.sections[0].material.rho
    return float((rho * np.concatenate([f.volume.ravel() for f in results.frames[0].fields])).sum())

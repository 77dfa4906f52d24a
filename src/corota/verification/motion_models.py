"""Bodies in motion that examples and problems share: a cantilever, thrown rods and blocks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np

import corota as ct
from corota.verification.models import cell

#: The cantilever under a sine load: sides [m], material, tip force [N] and its angular frequency.
LENGTH, WIDTH, DEPTH = 10.0, 0.5, 0.25
YOUNG, POISSON, DENSITY, FORCE, OMEGA = 210e9, 0.3, 7850.0, 10e6, 50.0
PERIOD = 0.3
#: Time for which thrown bodies are pushed.
PULSE = 0.5


def column(results: ct.Results, name: str) -> np.ndarray:
    """A scalar of every increment."""
    return np.array([f.scalars[name] for f in results.frames if f.increment > 0])


def flyer(element: str, strain: Any = "linear", E: float = 1e4) -> ct.Model:
    """A flexible block 4 x 1 that spins and flies freely."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1, cell=cell(element)))
    model.section(
        "all", element=element, material=ct.Elastic(E=E, nu=0.3, rho=1.0), local_strain=strain
    )
    model.velocity(spin=1.0, x=0.3, about=(1.0, 0.0))
    return model


def sine_cantilever(element: str = "Q4I", cells: int = 16) -> tuple[ct.Model, int]:
    """Build the model; returns it with the node in the middle of the tip."""
    mesh = ct.mesh.rectangle(LENGTH, DEPTH, nx=cells, ny=2, cell=cell(element))
    model = ct.Model(mesh, name="cantilever")
    material = ct.Elastic(E=YOUNG, nu=POISSON, rho=DENSITY)
    model.section("all", element=element, material=material, thickness=WIDTH)
    model.fix("left", rotation=True)
    time = np.linspace(0.0, PERIOD, 1501)
    model.amplitudes["sine"] = ct.Amplitude(time, np.sin(OMEGA * time))
    model.traction("right", y=FORCE / (WIDTH * DEPTH), amplitude="sine")
    tip = int(np.argmin(np.hypot(*(mesh.points - [LENGTH, DEPTH / 2.0]).T)))
    return model, tip


def sine_path(
    element: str, increments: int, mass: Any = "consistent", cells: int = 16
) -> np.ndarray:
    """Displacement of the tip at 30 equal times, shape (30, 2) [m]."""
    model, tip = sine_cantilever(element, cells)
    step = ct.Dynamic(period=PERIOD, increments=increments, scheme="energy_momentum", mass=mass)
    results = ct.solve(model, step, fields=False)
    every = increments // 30
    return np.array([f.U[tip] for f in results.frames[every::every]])


def rod(element: str = "Q4D") -> ct.Model:
    """Slender rod of length 10, pushed aside at one end."""
    mesh = ct.mesh.rectangle(10.0, 0.3, nx=20, ny=1, cell=cell(element))
    return _thrown(mesh, element, "right", (4.0, 8.0))


def block(element: str = "Q4I") -> ct.Model:
    """L-shaped block of two legs, pushed at the end of one."""
    long = ct.mesh.rectangle(4.0, 1.0, 8, 2, cell(element))
    short = ct.mesh.move(ct.mesh.rectangle(1.0, 3.0, 2, 6, cell(element)), shift=(0.0, 1.0))
    for names in (short.node_sets, short.edge_sets):
        names.clear()
    mesh = ct.mesh.merge(long, short)
    return _thrown(mesh, element, "right", (10.0, 30.0))


def _thrown(mesh: ct.Mesh, element: str, edge: str, force: tuple[float, float]) -> ct.Model:
    model = ct.Model(mesh, name="flight")
    model.section("all", element=element, material=ct.Elastic(E=2e4, nu=0.3, rho=1.0))
    time = np.linspace(0.0, PULSE, 51)
    model.amplitudes["pulse"] = ct.Amplitude(time, np.sin(np.pi * time / PULSE) ** 2)
    model.traction(edge, x=force[0], y=force[1], amplitude="pulse")
    return model


def fly(
    model: ct.Model, period: float = 5.0, increments: int = 250, scheme: str = "energy_momentum"
) -> ct.Results:
    """Run the flight, by default with the energy-momentum scheme."""
    step = ct.Dynamic(period=period, increments=increments, scheme=scheme, tolerance=1e-11)
    return ct.solve(model, step)


def drift(results: ct.Results) -> dict[str, float]:
    """Largest change of each invariant after the pulse, relative to the kinetic energy."""
    late = [f for f in results.frames if f.time > PULSE + 1e-9]
    size = max(f.scalars["kinetic energy"] for f in late)
    names = ("momentum x", "momentum y", "angular momentum", "energy balance")
    return {n: float(np.ptp([f.scalars[n] for f in late])) / size for n in names}

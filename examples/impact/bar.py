"""An elastic bar hits a rigid wall: one contact of the duration 2 L / c, then it flies back.

The exact solution: the bar is compressed with the force rho c A v for the time 2 L / c that the
wave takes to the free end and back, and leaves with the velocity it came with. A time scheme
whose contact force acts on nodes with mass creates energy instead, and chatters; here other nodes
of the elements carry the mass of the contact nodes.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass

import numpy as np

import corota as ct

LENGTH, YOUNG, DENSITY, SPEED = 10.0, 900.0, 1.0, 0.1
WAVE = (YOUNG / DENSITY) ** 0.5
CELLS = {"OPT": "tri3", "T3": "tri3", "Q8": "quad8", "Q9": "quad9"}


@dataclass
class Impact:
    """What an impact was like, each figure over its exact value but for the contacts.

    Parameters
    ----------
    contacts : int
        How often the bar came to touch the wall.
    duration, force, rebound, energy : float
        Time in contact, largest force, velocity of the centre of mass and energy at the end.
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
    iterations: float
    history: np.ndarray


def bar(element: str = "Q4I", cells: int = 200, **contact: str) -> ct.Model:
    """Build the bar, just touching the wall x = 0, on its way into it."""
    height = LENGTH / cells * 2.0
    mesh = ct.mesh.rectangle(LENGTH, height, nx=cells, ny=1, cell=CELLS.get(element, "quad4"))
    model = ct.Model(mesh, name="bar")
    material = ct.Elastic(E=YOUNG, nu=0.0, rho=DENSITY)
    model.section("all", element=element, material=material, thickness=1.0 / height)
    model.fix("bottom", x=None)
    model.velocity(x=-SPEED)
    wall = ct.RigidCurve.line((0.0, -1.0), (0.0, 1.0 + height))
    model.contact("left", wall, name="wall", **contact)
    return model


def strike(
    element: str = "Q4I",
    scheme: str = "hht",
    cells: int = 200,
    redistribute: bool = True,
    mass: str = "consistent",
    step: float = 0.5,
) -> Impact:
    """Run the impact; `step` is the increment over the time of a wave through a cell."""
    model = bar(element, cells)
    exact = 2.0 * LENGTH / WAVE
    increment = step * LENGTH / cells / WAVE
    dynamic = ct.Dynamic(
        period=1.3 * exact,
        increments=round(1.3 * exact / increment),
        scheme=scheme,
        mass=mass,
        redistribute=redistribute,
    )
    frames = ct.solve(model, dynamic, fields=False).frames[1:]
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
        iterations=float(value["iterations"].mean()),
        history=np.column_stack([time / exact, force / (DENSITY * WAVE * SPEED), total / first]),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=200, help="elements along the bar")
    args = parser.parse_args()
    sys.stdout.write("over the exact values: contacts, duration, force, rebound, energy\n")
    for element in ("Q4I", "Q8", "OPT", "Q4D"):
        hit = strike(element, cells=args.cells)
        sys.stdout.write(
            f"{element:4}{hit.contacts:4d}{hit.duration:9.4f}{hit.force:9.4f}{hit.rebound:9.4f}"
            f"{hit.energy:9.4f}\n"
        )


if __name__ == "__main__":
    main()

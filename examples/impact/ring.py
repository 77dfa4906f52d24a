"""A ring flies against a rigid wall, elastic or yielding, with the energy that goes where.

Four elements, the consistent inertia, the energy-momentum scheme and contact by Lagrange
multipliers. What the balance lacks in the end is what scheme and contact made up.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, field

import numpy as np

import corota as ct

RADIUS, DEPTH, YOUNG, DENSITY = 1.0, 0.1, 1e4, 1.0
YIELD, HARDENING = 60.0, 200.0
CELLS = {"OPT": "tri3", "T3": "tri3", "Q8": "quad8", "Q9": "quad9"}


@dataclass
class Flight:
    """What became of the ring; energies over the kinetic energy of the start.

    Parameters
    ----------
    rebound : float
        Velocity of the centre of mass at the end over that of the start.
    kinetic, strain, plastic, lack : float
        Energies at the end, and what the balance lacks at most at any time.
    sideways : float
        Largest momentum along the wall over that of the start.
    squash : float
        Height of the body at the end, over that at rest, minus one.
    released : float
        Time at which the ring leaves the wall for good [time].
    iterations : float
        Newton iterations an increment.
    history : dict of ndarray
        Time, force and the energies.
    """

    rebound: float
    kinetic: float
    strain: float
    plastic: float
    lack: float
    sideways: float
    squash: float
    released: float
    iterations: float
    history: dict[str, np.ndarray] = field(default_factory=dict)
    results: ct.Results | None = None


def ring(
    element: str = "Q4I", around: int = 64, through: int = 2, *, plastic: bool = False,
    speed: float = 2.0, unit: float = 1.0, local_strain: str = "modified", body: str = "ring",
) -> ct.Model:  # fmt: skip
    """Build the ring, or a bar upright, nearly touching the wall y = 0.

    `around` counts the elements along the ring or bar; `unit` is one metre in the unit of length.
    Masses stay, so stresses scale with 1 / unit (force = mass length / time^2).
    """
    if body == "bar":
        # 1 x 0.2, standing on the wall; it bulges at the foot like a Taylor bar.
        mesh = ct.mesh.rectangle(
            0.2 * unit, RADIUS * unit, nx=through, ny=around, cell=CELLS.get(element, "quad4")
        )
        mesh = ct.mesh.move(mesh, (-0.1 * unit, 0.001 * RADIUS * unit))
    else:
        mesh = ct.mesh.annulus(
            (RADIUS - DEPTH) * unit, RADIUS * unit, n_radial=through, n_around=around,
            cell=CELLS.get(element, "quad4"), centre=(0.0, 1.001 * RADIUS * unit),
        )  # fmt: skip
    model = ct.Model(mesh, name=body)
    stress, density = 1.0 / unit, DENSITY / unit**3
    material: ct.Material = ct.Elastic(E=YOUNG * stress, nu=0.3, rho=density)
    if plastic:
        material = ct.Mises(
            E=YOUNG * stress, nu=0.3, rho=density, yield_stress=YIELD * stress,
            isotropic=HARDENING * stress,
        )  # fmt: skip
    model.section(
        "all", element=element, material=material, thickness=unit, local_strain=local_strain
    )
    model.velocity(y=-speed * unit)
    # The wall lies to the left of the line, below it.
    wall = ct.RigidCurve.line((3.0 * unit, 0.0), (-3.0 * unit, 0.0))
    model.contact("outer" if body == "ring" else "bottom", wall, name="wall")
    return model


def fly(
    element: str = "Q4I", *, plastic: bool = False, speed: float = 2.0, around: int = 64,
    through: int = 2, unit: float = 1.0, scheme: str = "energy_momentum", period: float = 1.0,
    increments: int = 200, mass_kind: str = "consistent", redistribute: bool = True,
    tolerance: float = 5e-3, body: str = "ring",
) -> Flight:  # fmt: skip
    """Run the impact; 0 increments for automatic ones."""
    model = ring(
        element, around, through, plastic=plastic, speed=speed, unit=unit,
        local_strain="simplified" if plastic else "modified", body=body,
    )  # fmt: skip
    step = ct.Dynamic(
        period=period,
        increments=increments,
        first_increment=2e-3,
        error_tolerance=tolerance,
        scheme=scheme,
        mass=mass_kind,
        redistribute=redistribute,
    )
    results = ct.solve(model, step)
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
    rest = model.mesh.points[:, 1]
    y = rest + frames[-1].U[:, 1]
    momentum = mass * speed * unit
    return Flight(
        rebound=float(value["momentum y"][-1] / momentum),
        kinetic=float(kinetic[-1]),
        strain=float(strain[-1]),
        plastic=float(worked[-1]),
        lack=float(np.abs(kinetic + strain + worked - 1.0).max()),
        sideways=float(np.abs(value["momentum x"]).max() / momentum),
        squash=float(np.ptp(y) / np.ptp(rest) - 1.0),
        released=float(time[closed][-1]) if closed.any() else 0.0,
        iterations=float(value["iterations"].mean()),
        history={
            "time": time, "force": force, "kinetic": kinetic, "strain": strain, "plastic": worked,
        },
        results=results,
    )  # fmt: skip


def mass_of(results: ct.Results) -> float:
    """Mass of the ring from the volume of its quadrature points."""
    rho = results.model.sections[0].material.rho
    return float(sum(f.volume.sum() for f in results.frames[0].fields) * rho)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=64, help="elements around the ring")
    args = parser.parse_args()
    sys.stdout.write(
        "material element  rebound  kinetic   strain  plastic     lack  shape  iterations\n"
    )
    for plastic in (False, True):
        for element in ("Q4I", "Q8", "OPT", "Q4D"):
            f = fly(element, plastic=plastic, speed=1.0, around=args.around, increments=0)
            sys.stdout.write(
                f"{'yielding' if plastic else 'elastic':9}{element:7}{f.rebound:9.4f}"
                f"{f.kinetic:9.4f}{f.strain:9.4f}{f.plastic:9.4f}{f.lack:9.1e}{f.squash:7.3f}"
                f"{f.iterations:7.1f}\n"
            )


if __name__ == "__main__":
    main()

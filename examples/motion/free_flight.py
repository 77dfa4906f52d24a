"""Free flight: a flexible rod that is thrown spinning, and an L-shaped block that tumbles.

Nothing holds the bodies. A pulse acts on a corner for a while; from then on linear momentum,
angular momentum and energy must stay, whatever the body does.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct

PULSE = 0.5


def rod(element: str = "Q4D") -> ct.Model:
    """Slender rod of length 10, pushed aside at one end."""
    cell = "tri3" if element == "OPT" else "quad4"
    mesh = ct.mesh.rectangle(10.0, 0.3, nx=20, ny=1, cell=cell)
    return _thrown(mesh, element, "right", (4.0, 8.0))


def block(element: str = "Q4I") -> ct.Model:
    """L-shaped block of two legs, pushed at the end of one."""
    long = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    short = ct.mesh.move(ct.mesh.rectangle(1.0, 3.0, nx=2, ny=6), shift=(0.0, 1.0))
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


def fly(model: ct.Model, period: float = 5.0, increments: int = 250) -> ct.Results:
    """Run the flight with the energy-momentum scheme."""
    step = ct.Dynamic(
        period=period, increments=increments, scheme="energy_momentum", tolerance=1e-11
    )
    return ct.solve(model, step)


def drift(results: ct.Results) -> dict[str, float]:
    """Largest change of each invariant after the pulse, relative to the kinetic energy."""
    late = [f for f in results.frames if f.time > PULSE + 1e-9]
    size = max(f.scalars["kinetic energy"] for f in late)
    names = ("momentum x", "momentum y", "angular momentum", "energy balance")
    return {n: float(np.ptp([f.scalars[n] for f in late])) / size for n in names}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=Path, help="folder for animations in true time")
    args = parser.parse_args()
    for name, model in (("rod", rod()), ("block", block())):
        results = fly(model)
        sys.stdout.write(f"{name}: drift of the invariants in free flight\n")
        for what, value in drift(results).items():
            sys.stdout.write(f"  {what:18}{value:9.1e}\n")
        if args.pictures:
            from corota import plots

            plots.animate(results, "MISES", path=args.pictures / f"{name}.gif")


if __name__ == "__main__":
    main()

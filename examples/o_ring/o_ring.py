"""An O-ring in a groove: squeezed, then pressed against its wall by a fluid that seeks its way.

A rubber ring, 3.53 thick with a mean diameter of 40 (mm, N, MPa), is squeezed by a fifth between
floor and lid. A fluid enters at the inner side: it presses on the free surface and creeps between
rubber and metal as far as the contact pressure lets it. Rubber passes pressure on like a fluid, so
the contact pressure rises with that of the fluid and stays above it: the ring seals.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from typing import Any

import numpy as np

import corota as ct

RADIUS, CORD, SQUEEZE, CLEARANCE = 20.0, 3.53, 0.2, 0.3
JOINTS = ("floor", "lid", "wall")


def groove(plane: Any = "axisymmetric", n: int = 12) -> tuple[ct.Model, int, list[int]]:
    """Model, the node of the lid, and the innermost node of the ring, which is in the fluid."""
    r = 0.5 * CORD
    mesh = ct.mesh.rectangle(2.0, 2.0, n, n)
    x, y = (mesh.points - 1.0).T
    # A square as a disc without corners (Nowell).
    mesh.points[:] = r * np.stack([x * np.sqrt(1 - y**2 / 2), y * np.sqrt(1 - x**2 / 2)], axis=1)
    mesh.points[:] += [RADIUS, r]
    inner = [int(np.argmin(mesh.points[:, 0]))]
    lid = ct.mesh.add_node(mesh, 0.0, 2.0 * r, "lid")
    model = ct.Model(mesh, name="O-ring")
    rubber = ct.NeoHooke(C10=0.8, D1=0.05)
    model.section("all", element="Q4", material=rubber, plane=plane, mean_dilatation=True)
    low, high = RADIUS - 3.0 * r, RADIUS + 3.0 * r
    at = RADIUS + r + CLEARANCE
    metal = {
        "floor": ct.RigidCurve.line((low, 0.0), (high, 0.0)),
        "lid": ct.RigidCurve.line((high, 2.0 * r), (low, 2.0 * r), reference=lid),
        "wall": ct.RigidCurve.line((at, -1.0), (at, 2.0 * r + 1.0)),
    }
    model.mesh.edge_sets["rim"] = np.concatenate(
        [mesh.edge_sets[side] for side in ("bottom", "right", "top", "left")]
    )
    for name in JOINTS:
        friction = 0.01 if name != "wall" else 0.0
        model.contact("rim", metal[name], method="node_to_segment", friction=friction, name=name)
    return model, lid, inner


def run(pressures: tuple[float, ...] = (1.0, 2.0, 4.0), plane: Any = "axisymmetric") -> ct.Results:
    """Squeeze the ring, then raise the fluid to pressures, a step each."""
    model, _, inner = groove(plane)
    flat = plane != "axisymmetric"
    steps = [ct.Static(new_supports=True) for _ in (0.0, *pressures)]
    for step, p in zip(steps, (0.0, *pressures), strict=True):
        step.fix("lid", x=0.0 if flat else None, y=-SQUEEZE * CORD, rotation=flat)
        if p:
            step.penetrating_pressure("rim", p, start=inner)
        elif flat:  # where no hoop centers it
            r = 0.5 * CORD
            middle = int(np.argmin(np.hypot(*(model.mesh.points - [RADIUS, r]).T)))
            step.fix([middle], x=0.0, y=None)
    return ct.solve(model, steps, threads=1)


def sealing(results: ct.Results, step: int) -> dict[str, float]:
    """Largest contact pressure on each metal face at the end of a step."""
    frame = [f for f in results.frames if f.step == step][-1]
    return {name: float(frame.pairs[name][:, 0].max()) for name in JOINTS}


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    pressures = (0.0, 1.0, 2.0, 4.0)
    results = run(pressures[1:])
    sys.stdout.write("   fluid   floor     lid    wall  wetted length\n")
    for step, p in enumerate(pressures, start=1):
        last = [f for f in results.frames if f.step == step][-1]
        row = (p, *sealing(results, step).values(), last.scalars.get("wetted length", 0.0))
        sys.stdout.write("{:8.2f}{:8.3f}{:8.3f}{:8.3f}{:15.3f}\n".format(*row))


if __name__ == "__main__":
    main()

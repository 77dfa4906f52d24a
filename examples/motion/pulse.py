"""A whipping fly rod, and an elastoplastic frame under a pulse.

The rod is driven by a prescribed rotation at its grip; the frame is
loaded by a short pulse on its beam, yields and vibrates about a new equilibrium position.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct


def rod(cells: int = 20) -> tuple[ct.Model, int]:
    """Slender rod whose grip turns by a right angle and back; with a node of its tip.

    The nodes of the grip move on circles, so their displacements have amplitudes of their own.
    """
    mesh = ct.mesh.rectangle(3.0, 0.02, nx=cells, ny=1)
    model = ct.Model(mesh, name="fly rod")
    model.section("all", element="Q4I", material=ct.Elastic(E=5e7, nu=0.3, rho=1.0))
    time = np.linspace(0.0, 1.0, 401)
    angle = 0.25 * np.pi * (1.0 - np.cos(2.0 * np.pi * time))
    for node in mesh.nodes_of("left"):
        x, y = mesh.points[node]
        moved = (
            (np.cos(angle) - 1.0) * x - np.sin(angle) * y,
            np.sin(angle) * x + (np.cos(angle) - 1.0) * y,
        )
        for name, values in zip("xy", moved, strict=True):
            model.amplitudes[f"{name}{node}"] = ct.Amplitude(time, values)
        model.fix([node], x=1.0, y=None, amplitude=f"x{node}")
        model.fix([node], x=None, y=1.0, amplitude=f"y{node}")
    return model, int(mesh.nodes_of("right")[0])


def whip(increments: int = 200) -> tuple[ct.Results, int]:
    """Cast once; returns the results and the tip."""
    model, tip = rod()
    step = ct.Dynamic(
        period=1.5, increments=increments, scheme="energy_momentum", max_iterations=40
    )
    return ct.solve(model, step, fields=False), tip


def frame(peak: float = 4e5, yields: bool = True) -> tuple[ct.Model, int]:
    """Portal of two columns and a beam, hit sideways; with a node at the beam's end."""
    parts = []
    for width, height, x, y in ((0.2, 3.0, 0.0, 0.0), (0.2, 3.0, 3.8, 0.0), (4.0, 0.2, 0.0, 3.0)):
        nx, ny = max(round(width / 0.1), 2), max(round(height / 0.1), 2)
        part = ct.mesh.rectangle(width, height, nx=nx, ny=ny)
        for names in (part.node_sets, part.edge_sets):
            names.clear()
        parts.append(ct.mesh.move(part, shift=(x, y)))
    mesh = ct.mesh.merge(*parts)
    model = ct.Model(mesh, name="frame")
    plastic = ct.Mises(E=210e9, nu=0.3, yield_stress=250e6, isotropic=2e9, rho=7850.0)
    material = plastic if yields else ct.Elastic(E=210e9, nu=0.3, rho=7850.0)
    model.section("all", element="Q4I", material=material, thickness=0.1)
    model.fix(np.flatnonzero(mesh.points[:, 1] < 1e-9))
    time = np.linspace(0.0, 0.04, 41)
    model.amplitudes["pulse"] = ct.Amplitude(time, np.sin(np.pi * time / 0.04) ** 2)
    corner = int(np.argmin(np.hypot(*(mesh.points - [0.0, 3.2]).T)))
    joint = np.flatnonzero((mesh.points[:, 0] < 1e-9) & (mesh.points[:, 1] > 2.99))
    model.force(joint, x=peak / len(joint), amplitude="pulse")
    return model, corner


def hit(increments: int = 150, yields: bool = True) -> tuple[ct.Results, int]:
    """Hit the frame and let it swing."""
    model, corner = frame(yields=yields)
    step = ct.Dynamic(period=0.3, increments=increments, scheme="hht", alpha=-0.05)
    return ct.solve(model, step), corner


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    results, tip = whip()
    speed = max(float(np.hypot(*f.V[tip, :2])) for f in results.frames[1:])
    sys.stdout.write(f"largest speed of the tip of the rod {speed:.2f}\n")
    for yields in (False, True):
        results, corner = hit(yields=yields)
        late = [f.U[corner, 0] for f in results.frames if f.time > 0.1]
        word = "elastoplastic" if yields else "elastic"
        sys.stdout.write(f"{word} frame swings about {np.mean(late):.4f} m\n")


if __name__ == "__main__":
    main()

"""A portal frame of I beams pushed until hinges make it a mechanism, beside its collapse load.

Columns of 4 m and a beam of 8 m, all HEB 200 of ideally plastic steel (fillets left out), fixed at
the feet, carry H at the knee and V = H in the middle of the beam. The work of the loads and of the
hinges (right knee, middle of the beam, both feet) is ``H a + V a = 6 M`` for a height a, a plastic
moment M and a unit turn: ``H = 3 M / a``. Beams of fibers form the hinges by themselves. Axial
forces take half a percent of it, large displacements more, because V leans on swaying columns.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct

#: Height of the columns, half the length of the beam [mm]; yield stress [MPa].
A, YIELD = 4000.0, 235.0
PROFILE = ct.profiles.i_section(200.0, widths=200.0, flanges=15.0, web=9.0)
#: Load H of the mechanism [N], of first-order limit analysis without axial forces.
COLLAPSE = 3.0 * YIELD * PROFILE.plastic_modulus / A


def portal(pieces: int = 4) -> ct.Model:
    """The frame under unit loads."""
    corners = [(0.0, 0.0), (0.0, A), (A, A), (2.0 * A, A), (2.0 * A, 0.0)]
    model = ct.Model(ct.mesh.line(corners, n=pieces))
    model.name = "portal"
    model.beam("all", material=ct.Mises(E=210e3, nu=0.3, yield_stress=YIELD), profile=PROFILE)
    for foot in ("start", "end"):
        model.fix(foot, rotation=True)
    model.force("corner_1", x=1.0)
    model.force("corner_2", y=-1.0)
    return model


def push(nlgeom: bool, sway: float = 300.0) -> ct.Results:
    """Move the knee aside by a distance; the load factor is H [N]."""
    path = ct.DisplacementControl("corner_1", "x", sway, increments=30, locate=False)
    return ct.solve(portal(), ct.Static(nlgeom=nlgeom, path=path))


def load_at(results: ct.Results, sway: np.ndarray) -> np.ndarray:
    """H [kN] at some sways of the knee [mm]."""
    moved = results.history("U1", at="corner_1").values
    return np.interp(sway, moved, results.history("load factor").values) / 1e3


def hinges(results: ct.Results) -> list[tuple[float, float, float, float, float]]:
    """Hinges of the last frame: place, plastic rotation of all ends, stress at both surfaces."""
    values = results.frames[-1].fields[0].values
    mesh = results.model.mesh
    turns = np.zeros(mesh.n_nodes)
    sides = np.zeros((mesh.n_nodes, 2))
    for end in (1, 2):
        nodes = mesh.cells[0].nodes[:, end - 1]
        np.add.at(turns, nodes, values[f"PR{end}"][:, 0])
        sides[nodes] = np.hstack([values[f"S{side}{end}"] for side in "RL"])
    places = np.flatnonzero(np.abs(turns) > 0.02)
    return [(*mesh.points[n], turns[n], *sides[n]) for n in places]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=Path, help="folder for the curve of load and sway")
    args = parser.parse_args()
    write = sys.stdout.write
    write(f"mechanism: H = {COLLAPSE / 1e3:.2f} kN\n")
    first, second = push(False), push(True)
    write(f"{'sway [mm]':>10}{'H [kN]':>10}{'large displacements [kN]':>26}\n")
    at = np.array([20.0, 40.0, 60.0, 80.0, 100.0, 150.0, 200.0, 250.0, 300.0])
    for row in zip(at, load_at(first, at), load_at(second, at), strict=True):
        write("{:10.0f}{:10.2f}{:26.2f}\n".format(*row))
    write(f"H over that of the mechanism: {first.frames[-1].factor / COLLAPSE:.4f}\n\n")
    write("hinge at [mm]  rotation [rad]  stress right, left [MPa]\n")
    for x, y, turn, right, left in hinges(first):
        write(f"{x:6.0f}{y:6.0f}{turn:15.4f}{right:16.1f}{left:9.1f}\n")
    if args.pictures:
        args.pictures.mkdir(parents=True, exist_ok=True)
        sway = second.history("U1", at="corner_1")
        second.history("load factor").plot(against=sway, path=args.pictures / "portal.png")


if __name__ == "__main__":
    main()

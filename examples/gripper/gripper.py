"""Close a compliant gripper: read Gmsh's mesh, pull the pin, write results and pictures.

The part is cut in one piece from a 5 mm plate of polyamide (mm, N, MPa). A pin pulls the shaft
back by 3.3 mm; the two jaws turn on their leaf hinges by 18 degrees until they almost meet. The
strain stays below three percent, but the rotation is large.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct
from corota.cli.progress import Progress
from corota.cli.terminal import Terminal

PULL = 3.3
STROKE = 10


def gripper(pull: float = PULL) -> ct.Model:
    """Build the gripper with its bolts held and its pin moved.

    Parameters
    ----------
    pull : float
        Displacement of the pin to the left [length].
    """
    mesh = ct.mesh.read(ct.examples.path("gripper.msh"))
    model = ct.Model(mesh, name="gripper")
    model.section("all", element="Q4I", material=ct.Elastic(E=1600.0, nu=0.35), thickness=5.0)
    model.fix("bolts")
    model.fix("pin", x=-pull, y=0.0)
    return model


def jaw_rotation(results: ct.Results) -> float:
    """Rotation of the upper jaw at the end, from two points of its grip [degrees]."""
    mesh = results.mesh
    nodes = mesh.nodes_of("grip_upper")
    first = nodes[np.argmin(mesh.points[nodes, 0])]
    last = nodes[np.argmax(mesh.points[nodes, 0])]
    before = mesh.points[last] - mesh.points[first]
    after = before + results.frames[-1].U[last] - results.frames[-1].U[first]
    turn = np.arctan2(after[1], after[0]) - np.arctan2(before[1], before[0])
    return float(np.degrees(turn))


def main(arguments: list[str] | None = None) -> ct.Results:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", type=Path, default=Path("results/gripper"))
    options.add_argument("--pull", type=float, default=PULL, help="travel of the pin [mm]")
    chosen = options.parse_args(arguments)

    model = gripper(chosen.pull)
    mesh = model.mesh
    say = Terminal().line
    say(f"Compliant gripper: {mesh.n_nodes:,} nodes, {mesh.n_cells:,} elements Q4I")
    with ct.JobFiles(chosen.output, "gripper") as files:
        results = ct.solve(
            model, ct.Static(increments=STROKE), observers=[files, Progress(Terminal())]
        )
    chosen.output.mkdir(parents=True, exist_ok=True)
    picture = chosen.output / "gripper.png"
    curve = chosen.output / "gripper_force.png"
    results.plot("MISES").savefig(picture, dpi=200)
    results.history("RF1", at="pin").plot(against=results.history("U1", at="pin")).savefig(curve)

    force = -results.history("RF1", at="pin")[-1]
    gap = sum(
        s * (mesh.points[n, 1] + results.frames[-1].U[n, 1])
        for s, n in ((1.0, mesh.nodes_of("tip_upper")[0]), (-1.0, mesh.nodes_of("tip_lower")[0]))
    )
    say(f"The jaws turn by {abs(jaw_rotation(results)):.1f} degrees; {gap:.2f} mm are left between")
    say(f"their tips. The pin pulls with {force:.1f} N; the largest Mises stress is")
    say(f"{results.history('MISES').max():.1f} MPa.")
    for path in sorted(chosen.output.iterdir()):
        say(f"  {path}")
    return results


if __name__ == "__main__":
    main()
    sys.exit(0)

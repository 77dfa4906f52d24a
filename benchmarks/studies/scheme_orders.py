"""Measured orders of the time schemes: the table of docs/dynamics.md.

A soft strip that turns and swings, so slow that the increments resolve its highest mode: free,
with each kind of constraint, with moving supports and with each kind of damping. Runs with n, 2n
and 4n increments give the order from the differences of their ends (Richardson): of displacements
and, after the stroke, of velocities. Every scheme is of second order in theory.

``--write`` puts the table between the marks in docs/dynamics.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import write_between
from corota.errors import ConvergenceError, InputError, UnsupportedError

PAGE = Path(__file__).resolve().parents[2] / "docs" / "dynamics.md"
THEORY = 2.0
INCREMENTS = 24
PERIOD = 2.0
#: The dissipation is strong, so that a term of first order would show.
SCHEMES: dict[str, dict[str, Any]] = {
    "newmark": {},
    "hht": {"alpha": -0.3},
    "generalized_alpha": {"rho_inf": 0.3},
    "energy_momentum": {},
    "central_difference": {},
}
#: Node beyond the strip, for what needs a reference.
BEYOND = (3.5, 0.4)


def strip(element: str = "Q4I", beyond: bool = False) -> ct.Model:
    """A free strip of 3 x 0.8 that turns in a field of gravity."""
    mesh = ct.mesh.rectangle(3.0, 0.8, nx=3, ny=1)
    if beyond:
        points = np.vstack([mesh.points, [BEYOND]])
        mesh = replace(mesh, points=points, node_labels=np.arange(1, len(points) + 1))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1.0, nu=0.2, rho=1.0))
    model.gravity(y=-0.1)
    model.velocity(spin=0.5, about=(0.0, 0.4))
    return model


def corner(model: ct.Model, x: float, y: float) -> int:
    """The node next to a point."""
    return int(np.hypot(*(model.mesh.points - [x, y]).T).argmin())


def free() -> ct.Model:
    """Nothing but the strip."""
    return strip()


def drilling() -> ct.Model:
    """The strip with rotations and inertia that depends on the configuration."""
    return strip("Q4D")


def pinned() -> ct.Model:
    """Turns about a corner."""
    model = strip()
    model.velocities.clear()
    model.velocity(spin=0.5)
    model.fix([corner(model, 0.0, 0.0)])
    return model


def rigid_end() -> ct.Model:
    """A rigid end whose reference node is away from it."""
    model = strip(beyond=True)
    model.rigid("right", model.mesh.n_nodes - 1)
    return model


def distributing() -> ct.Model:
    """A node that follows the end on the average, with a force that is spread over the end."""
    model = strip(beyond=True)
    last = model.mesh.n_nodes - 1
    model.couple("right", last, kind="distributing")
    model.force([last], y=0.05)
    return model


def point_mass() -> ct.Model:
    """A corner carries a mass."""
    model = strip()
    model.point_mass([0], 0.5)
    return model


def straight() -> ct.Model:
    """Nodes that slide along a line through two others."""
    model = strip()
    bottom = np.asarray(model.mesh.nodes_of("bottom"))
    bottom = bottom[np.argsort(model.mesh.points[bottom, 0])]
    model.straight(bottom[1:-1], int(bottom[0]), int(bottom[-1]))
    return model


def moving_support() -> ct.Model:
    """The left side is driven up and down."""
    model = strip()
    model.velocities.clear()
    t = np.linspace(0.0, PERIOD, 1025)
    model.amplitudes["swing"] = ct.Amplitude(t, np.sin(np.pi * t / PERIOD) ** 4)
    model.fix("left", x=0.0, y=0.2, amplitude="swing")
    return model


def dashpot() -> ct.Model:
    """Two corners are damped to each other."""
    model = strip()
    model.dashpot(corner(model, 0.0, 0.0), corner(model, 1.0, 0.8), c=0.2)
    return model


Build = Callable[[], ct.Model]
Case = tuple[Build, dict[str, Any]]
CASES: dict[str, Case] = {
    "free": (free, {}),
    "free, Q4D": (drilling, {}),
    "pinned": (pinned, {}),
    "rigid end": (rigid_end, {}),
    "distributing": (distributing, {}),
    "point mass": (point_mass, {}),
    "straight line": (straight, {}),
    "moving support": (moving_support, {}),
    "damped per mass": (free, {"rayleigh": (0.5, 0.0)}),
    "damped per stiffness": (free, {"rayleigh": (0.0, 0.05)}),
    "dashpot": (dashpot, {}),
    "rigid end, all damping": (rigid_end, {"rayleigh": (0.5, 0.05)}),
}


def order(case: str, scheme: str, n: int = INCREMENTS) -> tuple[float, float] | None:
    """Orders of displacement and velocity.

    None where the scheme refuses the case, not a number where it does not converge.
    """
    build, keys = CASES[case]
    ends = []
    for many in (n, 2 * n, 4 * n):
        step = ct.Dynamic(
            period=PERIOD,
            increments=many,
            scheme=scheme,
            tolerance=1e-10,
            **SCHEMES[scheme],
            **keys,
        )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                frame = ct.solve(build(), step, fields=False, threads=1, keep="last").frames[-1]
        except (InputError, UnsupportedError):
            return None
        except ConvergenceError:
            return np.nan, np.nan
        ends.append((frame.U, frame.V[:, :2]))
    (u0, v0), (u1, v1), (u2, v2) = ends

    def rate(a: Any, b: Any, c: Any) -> float:
        return float(np.log2(np.linalg.norm(a - b) / np.linalg.norm(b - c)))

    return rate(u0, u1, u2), rate(v0, v1, v2)


def table() -> str:
    """Lines of Markdown."""
    names = list(SCHEMES)
    lines = [
        f"| case | theory | {' | '.join(names)} |",
        "| --- | --- |" + " --- |" * len(names),
    ]
    sys.stdout.write("\n".join(lines) + "\n")
    for case in CASES:
        cells = []
        for scheme in names:
            found = order(case, scheme)
            cells.append("refused" if found is None else f"{found[0]:.2f} / {found[1]:.2f}")
        lines.append(f"| {case} | {THEORY:.0f} | {' | '.join(cells)} |")
        sys.stdout.write(lines[-1] + "\n")
        sys.stdout.flush()
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    text = table()
    if parser.parse_args().write:
        write_between(PAGE, "orders", text)


if __name__ == "__main__":
    main()

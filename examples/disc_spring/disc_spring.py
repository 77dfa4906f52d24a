"""Disc springs: friction of the edges, and one that snaps through, beside Almen and Laszlo.

A disc spring 50 / 25.4 x 1.25 (outer and inner diameter, thickness; steel, E = 206 GPa; N, mm)
with a cone of 1.6 is pressed between two rigid plates with a friction of .1 and let go. Friction
acts on the edges with the height H between them as its arm, against a lever a = (50 - 25.4) / 2, so
that the force is 1 / (1 - mu H / a) of that without friction on the way down and
1 / (1 + mu H / a) on the way up. A second spring, 1 thick with a cone of 2.2, exceeds the ratio
sqrt(2) of height and thickness: its force has a maximum and a minimum, between which it snaps
through and back.

Almen and Laszlo (1936) turn a section that does not deform and give it the stiffness of plane
strain, E / (1 - nu^2). But only the hoop is strained, and the section is free to follow: with E
alone their formula is right within 1 percent for thin springs; as it stands it is 9 percent
above them.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np

import corota as ct

OUTER, INNER = 25.0, 12.7
E, NU = 206e3, 0.3
LEVER = OUTER - INNER


def formula(s: float, height: float, thickness: float) -> float:
    """Force of Almen and Laszlo at the deflection `s`."""
    d = OUTER / INNER
    k = ((d - 1.0) / d) ** 2 / (np.pi * ((d + 1.0) / (d - 1.0) - 2.0 / np.log(d)))
    plate = 4.0 * E / (1.0 - NU**2) * thickness**3 / (k * (2.0 * OUTER) ** 2) * s
    return float(plate * ((height - s) * (height - 0.5 * s) / thickness**2 + 1.0))


def disc(height: float, thickness: float, nx: int = 24) -> tuple[ct.Mesh, int, int]:
    """Mesh of a straight cone; nodes of its upper inner and its lower outer edge."""
    mesh = ct.mesh.rectangle(LEVER, thickness, nx, 2, cell="quad8")
    length = float(np.hypot(LEVER, height))
    c, s = LEVER / length, height / length
    along, across = mesh.points[:, 0] * length / LEVER, mesh.points[:, 1] - 0.5 * thickness
    upper, lower = int(np.argmin(along - across)), int(np.argmax(along - across))
    radius, axial = INNER + along * c + across * s, height - along * s + across * c
    mesh.points[:] = np.stack([radius, axial], axis=1)
    return mesh, upper, lower


def between_plates(friction: float, method: str = "mortar") -> tuple[ct.Model, int, int]:
    """The first spring between rigid plates, the node that moves the upper one, its upper edge."""
    mesh, upper, lower = disc(1.6, 1.25)
    low, high = float(mesh.points[lower, 1]), float(mesh.points[upper, 1])
    plate = ct.mesh.add_node(mesh, 0.0, high + 1.0, "plate")
    model = ct.Model(mesh, name="disc spring")
    model.section("all", element="Q8R", material=ct.Elastic(E, NU), plane="axisymmetric")
    floor = ct.RigidCurve.line((0.0, low), (60.0, low))
    press = ct.RigidCurve.line((60.0, high), (0.0, high), reference=plate)
    model.contact("bottom", floor, friction=friction, method=method, name="floor")
    model.contact("top", press, friction=friction, method=method, name="press")
    return model, plate, upper


def press_and_release(friction: float, method: str = "mortar") -> list[tuple[float, float]]:
    """Deflection and force after pressing to 3/4 of the height and coming back to .4."""
    model, plate, _ = between_plates(friction, method)
    steps = []
    for share in (0.75, 0.4):
        step = ct.Static()
        step.fix("plate", x=None, y=-1.6 * share)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    ends = [[f for f in results.frames if f.step == n][-1] for n in (1, 2)]
    return [(-float(f.U[plate, 1]), -float(f.RF[plate, 1])) for f in ends]


def friction_ratio(s: float, friction: float, down: bool) -> float:
    """Force with friction over that without: the edges are H = t + h0 - s apart."""
    share = friction * (1.25 + 1.6 - s) / LEVER
    return 1.0 / (1.0 - share if down else 1.0 + share)


def snap() -> tuple[ct.Results, int]:
    """The second spring through maximum and minimum of a force on its edge; the node of that."""
    mesh, upper, lower = disc(2.2, 1.0)
    model = ct.Model(mesh, name="steep disc spring")
    model.section("all", element="Q8R", material=ct.Elastic(E, NU), plane="axisymmetric")
    model.fix([lower], x=None)
    model.force([upper], y=-1000.0)
    path = ct.ArcLength(displacement=(upper, "y", -4.6))
    return ct.solve(model, ct.Static(path=path, increments=24), threads=1), upper


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    free, rough = press_and_release(0.0), press_and_release(0.1)
    sys.stdout.write("       s      force    mu .1    ratio    exact  Almen-Laszlo\n")
    for (s, force), (_, other), down in zip(free, rough, (True, False), strict=True):
        exact = friction_ratio(s, 0.1, down)
        row = (s, force, other, other / force, exact, formula(s, 1.6, 1.25))
        sys.stdout.write("{:8.3f} {:10.1f} {:8.1f} {:8.4f} {:8.4f} {:13.1f}\n".format(*row))
    results, upper = snap()
    sys.stdout.write("\n       s      force    energy  stable  Almen-Laszlo\n")
    for frame in results.frames[1:]:
        s = -float(frame.U[upper, 1])
        stable = "yes" if frame.scalars["stable"] else "no"
        row = (s, 1000.0 * frame.factor, frame.scalars["strain energy"], stable)
        sys.stdout.write("{:8.3f} {:10.1f} {:9.1f} {:>7} ".format(*row))
        sys.stdout.write(f"{formula(s, 2.2, 1.0):13.1f}\n")
    for point in results.critical_points:
        sys.stdout.write(f"{point}\n")


if __name__ == "__main__":
    main()

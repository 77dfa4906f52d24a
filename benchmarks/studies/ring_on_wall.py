"""A steel ring that flies against a wall and yields by its rate, beside an independent program.

``python -m benchmarks ring_on_wall`` runs the ring with plane stress elements, implicitly, and a
chain of rigid links with fibers between them, explicitly, which uses nothing of the package: points
with mass, the stretch of the links, the angle between them, and Cowper's and Symonds' law in each
fiber over the thickness. Both have half a ring on its line of symmetry. It prints the largest
crushing, the crushing that stays, the speed away from the wall and the dissipation of the flow.

Without the rate hinges localize, and both programs converge slowly: the crushing is 18.36 and 18.49
by 80 links and by 160 with twice the fibers, 18.74 and 18.57 by 60 and 120 cells. The rows without
the rate have the finer cells.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.common import report

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Mean radius, thickness [mm], density [t/mm^3], speed [mm/s], end of the motion [s].
RADIUS, THICKNESS, DENSITY, SPEED, END = 50.0, 4.0, 7.85e-9, 20e3, 4e-3
#: Young's modulus, yield stress, slope of hardening [MPa]; D [1/s] and n of the rate.
YOUNG, YIELD, SLOPE, RATE, POWER = 210e3, 250.0, 1000.0, 40.0, 5.0
#: Largest difference of the two that passes: thin beams against a ring of a twelfth of its radius.
TOLERANCE = 0.02


@dataclass
class Answer:
    """What both programs give: crushing [mm], speed [mm/s], dissipation by mm of width [mJ]."""

    largest: float
    staying: float
    rebound: float
    dissipated: float

    def row(self) -> list[float]:
        return [self.largest, self.staying, self.rebound, self.dissipated]


def flow(stress: Floats, limit: Floats, dt: float) -> Floats:
    """Plastic strain of an increment at the size of a trial stress.

    ``p' = D (s / limit - 1)^n`` with the stress at the end, by Newton's method, which comes from
    one side because the function is convex.
    """
    s = stress.copy()
    c = YOUNG * dt * RATE
    for _ in range(30):
        over = np.maximum(s / limit - 1.0, 0.0)
        power = over ** (POWER - 1.0)
        step = (s + c * power * over - stress) / (1.0 + c * POWER * power / limit)
        s -= step
        if np.abs(step).max() < 1e-9 * YIELD:
            break
    return (stress - s) / YOUNG


def chain(links: int, fibers: int, share: float, rates: bool = True) -> Answer:
    """Explicit motion of half a ring of rigid-ended links; central differences.

    Parameters
    ----------
    links : int
        On half of the ring.
    fibers : int
        Over the thickness, at Gauss points.
    share : float
        Increment over the stable one.
    """
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, links + 1)
    x = np.stack(
        [RADIUS * np.cos(angle), RADIUS * np.sin(angle) + RADIUS + 0.5 * THICKNESS], axis=1
    )
    x[[0, -1], 0] = 0.0
    length = np.linalg.norm(np.diff(x, axis=0), axis=1)
    whole = float(length[0])
    eta, weight = np.polynomial.legendre.leggauss(fibers)
    eta, weight = 0.5 * THICKNESS * eta, 0.5 * THICKNESS * weight
    # Points on the line of symmetry have half a mass, and half a joint.
    joint = np.full(links + 1, whole)
    joint[[0, -1]] *= 0.5
    mass = DENSITY * THICKNESS * joint[:, None]
    speed = np.sqrt(YOUNG / DENSITY)
    bending = whole**2 / (2.0 * speed * THICKNESS / np.sqrt(12.0))
    dt = share * min(whole / speed, bending)
    wall = (0.3 / dt) ** 2 * float(mass[1, 0])
    v = np.zeros_like(x)
    v[:, 1] = -SPEED
    strain = np.zeros((links + 1, fibers))
    plastic, stress, accumulated = strain.copy(), strain.copy(), strain.copy()
    work, lowest = 0.0, np.inf
    turn0 = None
    heights = []
    for n in range(int(END / dt)):
        edge = np.diff(x, axis=0)
        size = np.linalg.norm(edge, axis=1)
        t = edge / size[:, None]
        stretch = np.log(size / length)
        # Links before and after; beyond the line of symmetry their images.
        before = np.vstack([t[:1] * [1.0, -1.0], t])
        after = np.vstack([t, t[-1:] * [1.0, -1.0]])
        cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        turn = np.arctan2(cross, (before * after).sum(axis=1))
        if turn0 is None:
            turn0 = turn.copy()
        curvature = (turn - turn0) / whole
        mean = 0.5 * (np.append(stretch[0], stretch) + np.append(stretch, stretch[-1]))
        # The joint bends to the left: the fiber at the right is stretched.
        new = mean[:, None] + curvature[:, None] * eta
        trial = YOUNG * (new - plastic)
        limit = YIELD + SLOPE * accumulated
        excess = np.abs(trial) > limit
        dp = np.zeros_like(trial)
        if excess.any():
            if rates:
                dp[excess] = flow(np.abs(trial[excess]), limit[excess], dt)
            else:
                dp[excess] = (np.abs(trial[excess]) - limit[excess]) / (YOUNG + SLOPE)
        plastic += dp * np.sign(trial)
        stress = trial - YOUNG * dp * np.sign(trial)
        work += 2.0 * float(((np.abs(stress) * dp) @ weight) @ joint)
        accumulated += dp
        force = (stress @ weight) * joint
        moment = (stress * eta) @ weight / whole * joint
        # Derivatives of the energy of the joints by the places of the points.
        along = 0.5 * (force[:-1] + force[1:])
        along[0] += 0.5 * force[0]
        along[-1] += 0.5 * force[-1]
        f = np.zeros_like(x)
        pull = (along / size)[:, None] * t
        f[:-1] += pull
        f[1:] -= pull
        normal = np.stack([-t[:, 1], t[:, 0]], axis=1) / size[:, None]
        # A turned link opens the angle before it, closes that after it; on the line twice as much.
        both = moment.copy()
        both[[0, -1]] *= 2.0
        couple = (both[:-1] - both[1:])[:, None] * normal
        f[1:] -= couple
        f[:-1] += couple
        depth = 0.5 * THICKNESS - x[:, 1]
        f[:, 1] += np.where(depth > 0.0, wall * depth * joint / whole, 0.0)
        f[[0, -1], 0] = 0.0
        v += dt * f / mass
        v[[0, -1], 0] = 0.0
        x += dt * v
        lowest = min(lowest, float(x[-1, 1] - x[0, 1]))
        heights.append((n * dt, float(x[-1, 1] - x[0, 1])))
    total = mass.sum()
    late = np.array([h for when, h in heights if when > 0.7 * END])
    return Answer(
        2.0 * RADIUS - lowest,
        2.0 * RADIUS - float(0.5 * (late.max() + late.min())),
        float((mass[:, 0] * v[:, 1]).sum() / total),
        work,
    )


def ring(cells: int, through: int, increments: int, rates: bool = True) -> Answer:
    """The same by eight-node elements in plane stress, with contact at a rigid line."""
    import corota as ct

    mesh = ct.mesh.rectangle(1.0, 1.0, through, cells, "quad8")
    s, t = mesh.points.T.copy()
    r = RADIUS + THICKNESS * (s - 0.5)
    angle = np.pi * (t - 0.5)
    mesh.points[:] = np.stack(
        [r * np.cos(angle), r * np.sin(angle) + RADIUS + 0.5 * THICKNESS], axis=1
    )
    model = ct.Model(mesh)
    steel = ct.Mises(
        E=YOUNG,
        nu=0.3,
        yield_stress=YIELD,
        isotropic=SLOPE,
        rate=ct.CowperSymonds(RATE, POWER) if rates else None,
        rho=DENSITY,
    )
    model.section("all", element="Q8R", material=steel, plane="stress", thickness=1.0)
    model.fix("bottom", x=0.0, y=None)
    model.fix("top", x=0.0, y=None)
    floor = ct.RigidCurve.line((-10.0, 0.0), (2.0 * RADIUS, 0.0))
    model.contact("right", floor, name="wall")
    model.velocity(y=-SPEED)
    dt = END / increments
    step = ct.Dynamic(period=END, first_increment=dt, largest_increment=dt)
    results = ct.solve(model, step, threads=1)
    on_line = np.isclose(mesh.points[:, 0], 0.0, atol=1e-9)
    low, high = (np.flatnonzero(on_line & side) for side in _sides(mesh.points))

    def height(frame: object) -> float:
        y = frame.U[:, 1] + mesh.points[:, 1]  # type: ignore[attr-defined]
        return float(y[high].mean() - y[low].mean())

    heights = np.array([height(f) for f in results.frames])
    times = np.array([f.time for f in results.frames])
    late = heights[times > 0.7 * END]
    last = results.frames[-1]
    momentum = last.scalars["momentum y"]
    mass = DENSITY * THICKNESS * np.pi * RADIUS
    return Answer(
        2.0 * RADIUS - float(heights.min()),
        2.0 * RADIUS - 0.5 * float(late.max() + late.min()),
        momentum / mass,
        2.0 * last.scalars["ALLPD"],
    )


def _sides(points: Floats) -> tuple[Floats, Floats]:
    lower = points[:, 1] < RADIUS
    return lower, ~lower


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--links", type=int, default=80)
    options.add_argument("--cells", type=int, default=60)
    options.add_argument("--increments", type=int, default=200)
    given = options.parse_args()
    rows: list[list[object]] = []
    begin = time.perf_counter()
    explicit = chain(given.links, 10, 0.5)
    between = time.perf_counter()
    implicit = ring(given.cells, 2, given.increments)
    rows.append(["chain, explicit", *explicit.row(), between - begin])
    rows.append(["elements, implicit", *implicit.row(), time.perf_counter() - between])
    off = [b / a - 1.0 for a, b in zip(explicit.row(), implicit.row(), strict=True)]
    rows.append(["difference", *off, ""])
    rows.append(["chain without the rate", *chain(given.links, 10, 0.5, rates=False).row(), ""])
    plain = ring(2 * given.cells, 2, given.increments, rates=False)
    rows.append(["elements without the rate", *plain.row(), ""])
    head = ["ring", "crushing [mm]", "staying [mm]", "rebound [mm/s]", "dissipated [mJ]", "[s]"]
    report("A yielding ring on a wall", head, rows)
    return int(max(map(abs, off)) > TOLERANCE)


if __name__ == "__main__":
    sys.exit(main())

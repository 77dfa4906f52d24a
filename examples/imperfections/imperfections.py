"""Limit loads of imperfect structures beside Koiter's laws.

Roorda's frame: two bars of length 1 with EI = 1 in a right angle, both far ends pinned, a load
down on the joint along the column. Its branches cross at an angle: with an imperfection of the
amplitude e in its buckling mode the frame carries ``1 - 2 sqrt(s e)`` of the critical load. The
slope ``P / P_c = 1 - 0.3805 t`` of the branch over the rotation t of the joint follows by hand from
the energy to third order (inextensible bars): with the column's mode V, the beam's mode W and the
moment ``3 t`` of the joint, ``s = 3/2 * 3 (int W'^2 + int V'^2) / (P_c int V'^2)``.

A shallow arch ``y = h sin(pi x)`` under a load of the same shape buckles into two waves before its
limit point. Its branch falls symmetrically: the load falls with the power 2/3 of the imperfection.
In the theory of shallow arches two amplitudes are exact
(Y. C. Fung, A. Kaplan, NACA TN 2840, 1952).

Source: W. T. Koiter, *On the stability of elastic equilibrium*, thesis, Delft (1945).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import sys
from functools import cache

import numpy as np
from scipy.optimize import brentq, minimize_scalar

import corota as ct
from corota.verification.beam_models import polyline

#: Rise of the arch, and its radius of gyration.
RISE, GYRATION = 0.002, 0.00025


def frame(n: int = 32) -> ct.Model:
    """Roorda's frame of n beams a bar, under its critical load."""
    way = np.linspace(0.0, 1.0, n + 1)
    column, beam = np.stack([0.0 * way, way], axis=1), np.stack([way, 0.0 * way + 1.0], axis=1)
    model = ct.Model(polyline(np.concatenate([column, beam[1:]])))
    area = 1e6
    model.beam(np.arange(2 * n), material=ct.Elastic(E=1.0), area=area, inertia=1.0)
    model.fix([0])
    # The beam's pin goes down as the column shortens, which would be an imperfection otherwise.
    model.fix([2 * n], y=-frame_load() / area)
    model.force([n], y=-frame_load())
    return model


@cache
def frame_load() -> float:
    """Critical load of the frame: the stiffness of the column against rotation is -3."""
    return float(brentq(lambda u: 3.0 * (1.0 - u / math.tan(u)) + u**2, 3.3, 4.2) ** 2)


def frame_slope() -> float:
    """Fall of the branch of the frame by the rotation of its joint, by hand: 0.3805."""
    load = frame_load()
    u = math.sqrt(load)
    column = 0.5 * load + 0.25 * u * math.sin(2.0 * u) - math.sin(u) ** 2
    column /= (math.sin(u) - u * math.cos(u)) ** 2
    return 4.5 * (0.2 + column) / (load * column)


def arch(n: int = 200) -> ct.Model:
    """Half sine under a load that is a half sine, of n beams, under its critical load."""
    x = np.linspace(0.0, 1.0, n + 1)
    shape = np.sin(math.pi * x)
    model = ct.Model(polyline(np.stack([x, RISE * shape], axis=1)))
    model.beam(np.arange(n), material=ct.Elastic(E=1.0), area=GYRATION**-2, inertia=1.0)
    model.fix([0, n])
    for node in range(1, n):
        model.force([node], y=-arch_load() * math.pi**4 * shape[node] / n)
    return model


def arch_load(imperfection: float = 0.0) -> float:
    """Largest load of the arch in shallow theory, over EI (pi / L)^4."""
    h, r = RISE, GYRATION
    if not imperfection:
        return h + 3.0 * math.sqrt(h**2 - 16.0 * r**2)

    def load(waves: float) -> float:
        thrust = 4.0 - 4.0 * imperfection / waves
        rise = math.sqrt(h**2 + 4.0 * (imperfection**2 - waves**2 - r**2 * thrust))
        return h + (thrust - 1.0) * rise

    _, waves = arch_asymptote(imperfection)
    found = minimize_scalar(
        lambda b: -load(b),
        bounds=(0.3 * waves, 2.0 * waves),
        method="bounded",
        options={"xatol": 1e-12 * waves},
    )
    return float(-found.fun)


def arch_asymptote(imperfection: float) -> tuple[float, float]:
    """Koiter's law of the arch: loss of load over the critical load, and the amplitude there."""
    rise = math.sqrt(RISE**2 - 16.0 * GYRATION**2)
    fall, rate = 6.0 / rise, 4.0 * rise - 24.0 * GYRATION**2 / rise
    waves = (rate * imperfection / (2.0 * fall)) ** (1.0 / 3.0)
    return 3.0 * fall * waves**2 / arch_load(), waves


def bifurcation(model: ct.Model) -> ct.CriticalPoint:
    """First bifurcation of the perfect structure."""
    step = ct.Static(path=ct.ArcLength(factor=1.02))
    points = ct.solve(model, step, fields=False).critical_points
    return next(p for p in points if p.kind == "bifurcation")


def limit_load(model: ct.Model, mode: np.ndarray, amplitude: float) -> ct.Results:
    """Path of a structure with an imperfection up to its limit point."""
    crooked = model.copy()
    crooked.imperfection(mode, [amplitude])
    step = ct.Static(path=ct.ArcLength(increments=200, stop_at_limit=True))
    return ct.solve(crooked, step, fields=False)


def losses(model: ct.Model, point: ct.CriticalPoint, amplitudes: np.ndarray) -> np.ndarray:
    """Loss of load over the critical load of the same mesh for each amplitude."""
    loads = [limit_load(model, point.mode, e).critical_points[0].factor for e in amplitudes]
    return 1.0 - np.array(loads) / point.factor


def main() -> None:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    model, say = frame(), sys.stdout.write
    point = bifurcation(model)
    turn = point.mode[len(point.mode) // 2, 2]
    amplitudes = math.copysign(1.0, turn) * 4.0 ** np.arange(-9.0, -4.0)
    lost = losses(model, point, amplitudes)
    law = 2.0 * np.sqrt(frame_slope() * abs(turn * amplitudes))
    say(f"frame, critical load {frame_load():.4f}, slope {frame_slope():.4f}\n")
    say(" amplitude   1 - load   over Koiter's law   power\n")
    for k, e in enumerate(amplitudes):
        power = math.log(lost[k] / lost[k - 1], 4.0) if k else math.nan
        say(f"{abs(e):10.2e} {lost[k]:10.6f} {lost[k] / law[k]:15.5f} {power:13.4f}\n")
    model = arch()
    point = bifurcation(model)
    amplitudes = RISE * 8.0 ** np.arange(-5.0, -1.0)
    lost = losses(model, point, amplitudes)
    say(" amplitude / rise   1 - load   over Koiter's law   over shallow theory   power\n")
    for k, e in enumerate(amplitudes):
        power = math.log(lost[k] / lost[k - 1], 8.0) if k else math.nan
        shallow = 1.0 - arch_load(e) / arch_load()
        law = arch_asymptote(e)[0]
        say(
            f"{e / RISE:13.2e} {lost[k]:14.6f} {lost[k] / law:15.5f} {lost[k] / shallow:19.5f} "
            f"{power:14.4f}\n"
        )


if __name__ == "__main__":
    main()

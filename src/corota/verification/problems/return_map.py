"""Plane-stress J2 return map on a strain path with corners, to eight digits.

E = 200000, nu = 0.3, yield stress 250; the strain (e11, e22, gamma12) goes from zero through (.002,
0, 0), (.002, 0, .004), (-.001, .001, .004) back to zero in N equal backward-Euler steps per leg,
with perfect plasticity and with isotropic slope K and kinematic slope H. The references are of an
independent return map that agrees with the nested three-dimensional one.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Problem, Value

CORNERS = np.array([(0, 0, 0), (0.002, 0, 0), (0.002, 0, 0.004), (-0.001, 0.001, 0.004), (0, 0, 0)])
#: K, H, steps a leg, stresses at the ends of the legs, equivalent plastic strain at the end.
ROWS = [
    (0, 0, 1, [(285.82736553, 107.88458294, 0), (140.51464109, 67.60372233, 126.07495805),
               (-221.30548352, 17.81124702, 55.57252262),
               (-48.47285812, -85.94196336, -137.75608100)], 0.0046242745),
    (0, 0, 10, [(286.28932238, 111.06946958, 0), (101.41677310, 59.12178257, 135.04961233),
                (-244.42431686, -3.68975125, 34.85686919),
                (-40.67305446, -95.80332931, -136.09315286)], 0.0051813098),
    (2000, 0, 1, [(287.57413124, 108.30232157, 0), (143.49049990, 68.73017566, 128.31452269),
                  (-226.07646719, 19.85017169, 58.36948099),
                  (-52.84794154, -88.22109271, -142.78699166)], 0.0044970443),
    (0, 2000, 10, [(288.02093657, 111.41606717, 0), (105.09932830, 60.40575352, 136.59390988),
                   (-242.92273730, -1.55343847, 37.22502734),
                   (-39.75832350, -94.38193166, -134.96504069)], 0.0051316365),
    (1000, 3000, 1, [(289.28065986, 108.70732062, 0), (146.86356591, 69.85299802, 129.59412450),
                     (-221.92455237, 21.40887066, 60.22894178),
                     (-49.23814653, -85.25918299, -138.50281860)], 0.0044956073),
]  # fmt: skip


def path(steps: int) -> np.ndarray:
    """Strains of the path, shape (4 steps, 3)."""
    share = np.linspace(1.0 / steps, 1.0, steps)[:, None]
    return np.concatenate([a + (b - a) * share for a, b in zip(CORNERS, CORNERS[1:], strict=False)])


def measure() -> Iterator[Value]:
    """Every component at every corner."""
    for k, h, steps, legs, alpha in ROWS:
        law = ct.Mises(
            E=200000.0, nu=0.3, yield_stress=250.0, isotropic=float(k), kinematic=float(h)
        )
        answer = law.respond(path(steps), "stress")
        text = f"K {k}, H {h}, {steps} a leg"
        for leg, exact in enumerate(legs, 1):
            found = answer["stress"][leg * steps - 1]
            for name, reference, value in zip(("11", "22", "12"), exact, found, strict=True):
                yield Value(
                    f"stress {name}, leg {leg}, {text}", reference, value, 0.6e-8, "absolute"
                )
        yield Value(
            f"equivalent plastic strain, {text}", alpha, answer["PEEQ"][-1], 0.6e-10, "absolute"
        )


PROBLEM = Problem(
    title="Plane-stress return map",
    group="plasticity",
    source="J. C. Simo, R. L. Taylor, Int. J. Numer. Meth. Engng 22 (1986), programmed "
    "independently",
    certainty="computed independently",
    why="the last printed digit",
    seconds=0.1,
)

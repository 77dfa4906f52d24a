"""Where CalculiX 2.20 is wrong: what is right, from the definitions.

The exceptions of benchmarks/corpora/deck_family.py point here.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

SQUARE = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, .5, 0.
6, 1., .5
7, .5, 1.
8, 0., .5
*ELEMENT, TYPE=CPE8, ELSET=EALL
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
1e3, 0.
*DENSITY
1.
*EXPANSION
1e-5
*SOLID SECTION, ELSET=EALL, MATERIAL=M
.1
*INITIAL CONDITIONS, TYPE=TEMPERATURE
NALL, 20.
*AMPLITUDE, NAME=LOCAL
0., 0., 1., .5
*AMPLITUDE, NAME=TOTAL, TIME=TOTAL TIME
0., 1., 3., 4.
"""
HELD = "*BOUNDARY\n1, 1, 2\n4, 1\n2, 2\n"


def solve(tmp_path: Path, text: str) -> dict[int, ct.results.Frame]:
    """Last frame of every step."""
    path = tmp_path / "deck.inp"
    path.write_text(SQUARE + text)
    return {frame.step: frame for frame in ct.solve(ct.read(path), threads=1).frames}


def shapes(r: float, s: float) -> tuple[np.ndarray, np.ndarray]:
    """Functions of the eight-node element and their derivatives, corners before mid-sides."""
    n, d = [], []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        n.append(0.25 * (1 + a * r) * (1 + b * s) * (a * r + b * s - 1))
        d.append(
            (
                0.25 * a * (1 + b * s) * (2 * a * r + b * s),
                0.25 * b * (1 + a * r) * (2 * b * s + a * r),
            )
        )
    for a, b in ((0, -1), (1, 0), (0, 1), (-1, 0)):
        if a == 0:
            n.append(0.5 * (1 - r * r) * (1 + b * s))
            d.append((-r * (1 + b * s), 0.5 * b * (1 - r * r)))
        else:
            n.append(0.5 * (1 - s * s) * (1 + a * r))
            d.append((0.5 * a * (1 - s * s), -s * (1 + a * r)))
    return np.array(n), np.array(d)


def matrices() -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and mass of the unit square, E = 1e3, nu = 0, rho = 1, thickness .1."""
    k, m = np.zeros((16, 16)), np.zeros((16, 16))
    g = np.sqrt(0.6)
    rule = ((-g, 5 / 9), (0.0, 8 / 9), (g, 5 / 9))
    for r, w in rule:
        for s, v in rule:
            n, d = shapes(r, s)
            d, weight = 2.0 * d, 0.25 * 0.1 * w * v
            b, h = np.zeros((3, 16)), np.zeros((2, 16))
            b[0, ::2], b[1, 1::2], b[2, ::2], b[2, 1::2] = d[:, 0], d[:, 1], d[:, 1], d[:, 0]
            h[0, ::2], h[1, 1::2] = n, n
            k += weight * b.T @ np.diag([1e3, 1e3, 500.0]) @ b
            m += weight * h.T @ h
    return k, m


def test_a_sudden_load_starts_with_the_acceleration_of_the_equation_of_motion(
    tmp_path: Path,
) -> None:
    """Trapezoidal rule with matrices of its own; CalculiX: 5.543934e-3 for 5.649426e-3."""
    k, m = matrices()
    f = np.zeros(16)
    f[[1, 3, 9]] = 0.1 * np.array([1, 1, 4]) / 6
    u, v, a, dt = np.zeros(16), np.zeros(16), np.linalg.solve(m, f), 0.1
    for _ in range(3):
        known = f + m @ ((u + dt * v) / (0.25 * dt * dt) + a)
        new = np.linalg.solve(m / (0.25 * dt * dt) + k, known)
        after = (new - u - dt * v) / (0.25 * dt * dt) - a
        u, v, a = new, v + 0.5 * dt * (a + after), after
    text = "*STEP\n*DYNAMIC, DIRECT, ALPHA=0.\n.1, .3\n*DLOAD\nEALL, P1, 1.\n*END STEP\n"
    found = solve(tmp_path, text)[1].U.ravel()
    assert found == pytest.approx(u, abs=1e-10)


def test_an_amplitude_of_step_time_ends_for_temperatures_as_for_all_loads(tmp_path: Path) -> None:
    """Free expansion alpha (T - T0): 0.5 x 100 - 20 stays; CalculiX starts again from 0."""
    steps = "*STEP\n*STATIC\n1., 1.\n*TEMPERATURE, AMPLITUDE=LOCAL\nNALL, 100.\n*END STEP\n"
    found = solve(tmp_path, HELD + steps + "*STEP\n*STATIC\n.4, .4\n*END STEP\n")
    assert [found[k].U[1, 0] for k in (1, 2)] == pytest.approx([30e-5, 30e-5])


def test_temperatures_taken_away_are_the_initial_ones(tmp_path: Path) -> None:
    """No strain at T0; CalculiX multiplies T0 by the amplitude of the load that is gone."""
    steps = "*STEP\n*STATIC\n*TEMPERATURE, AMPLITUDE=TOTAL\nNALL, 50.\n*END STEP\n"
    steps += "*STEP\n*STATIC\n*TEMPERATURE, OP=NEW\n*END STEP\n"
    found = solve(tmp_path, HELD + steps)
    assert [found[k].U[1, 0] for k in (1, 2)] == pytest.approx([80e-5, 0.0], abs=1e-12)


@pytest.mark.parametrize("what", ["*FREQUENCY\n1", "*BUCKLE\n1\n*CLOAD\n3, 2, -1."])
def test_a_perturbation_leaves_the_loads_as_they_are(tmp_path: Path, what: str) -> None:
    """CalculiX forgets the forces at *STEP, PERTURBATION (``steps.f``: nforc=0, "check!!")."""
    steps = "*STEP\n*STATIC\n*CLOAD\n2, 1, .003\n*END STEP\n"
    steps += f"*STEP, PERTURBATION\n{what}\n*END STEP\n*STEP\n*STATIC\n*END STEP\n"
    found = solve(tmp_path, HELD + steps)
    assert [found[k].RF[[0, 3], 0].sum() for k in (1, 3)] == pytest.approx([-3e-3, -3e-3])

"""Collapse loads of frames of ideally plastic beams.

Expected are those of limit analysis: by the mechanism in closed form where it is given (Neal, *The
Plastic Methods of Structural Analysis*), and for all by the static theorem as a linear program for
the end moments, which knows nothing of the elements. Axial forces reduce the plastic moments of the
slender members (height over length 1/50) by less than 0.1 %.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.optimize import linprog

import corota as ct
from support.lines import lines

YIELD, WIDTH, HEIGHT = 250.0, 2.0, 2.0
#: Plastic moment of the unit member.
FULL = YIELD * WIDTH * HEIGHT**2 / 4.0
A = 100.0
STEEL = ct.Mises(E=200e3, nu=0.3, yield_stress=YIELD)


@dataclass
class Frame:
    """Joints, members (first, last, width over that of the unit member), supports and loads.

    Supports are (joint, whether its rotation is fixed too, whether it may slide along x); loads are
    (joint, fx, fy), the first of which leads the displacement. `factor` is the collapse load in
    units of the plastic moment over A.
    """

    joints: list[tuple[float, float]]
    members: list[tuple[int, int, float]]
    supports: list[tuple[int, bool, bool]]
    loads: list[tuple[int, float, float]]
    factor: float | None = None
    pieces: int = 1
    target: float = field(default=20.0)


def beam(n: int) -> list[tuple[float, float]]:
    return [(A * i, 0.0) for i in range(n + 1)]


def spans(n: int, width: float = 1.0) -> list[tuple[int, int, float]]:
    return [(i, i + 1, width) for i in range(n)]


PORTAL = [(0.0, 0.0), (0.0, A), (A, A), (2 * A, A), (2 * A, 0.0)]
COLUMNS = [(0, True, False), (4, True, False)]
PINS = [(0, False, False), (4, False, False)]
TWO_BAYS = [*PORTAL, (3 * A, A), (4 * A, A), (4 * A, 0.0)]
BAYS = [(0, 1, 1.0), (1, 2, 1.0), (2, 3, 1.0), (3, 4, 1.5), (3, 5, 1.0), (5, 6, 1.0), (6, 7, 1.0)]
GABLE = [(0.0, 0.0), (0.0, A), (A, 1.5 * A), (2 * A, A), (2 * A, 0.0)]

FRAMES = {
    "fixed beam": Frame(beam(2), spans(2), [(0, True, False), (2, True, False)], [(1, 0, -1)], 4.0),
    "propped beam, two loads": Frame(
        beam(3), spans(3), [(0, True, False), (3, False, True)], [(1, 0, -1), (2, 0, -1)], 4.0 / 3.0
    ),
    "propped beam of ten pieces": Frame(
        beam(2), spans(2), [(0, True, False), (2, False, True)], [(1, 0, -1)], 3.0, 5
    ),
    "continuous beam of three spans": Frame(
        beam(6),
        [(i, i + 1, 1.0 if i < 4 else 2.0) for i in range(6)],
        [(0, False, False), (2, False, True), (4, False, True), (6, False, True)],
        [(3, 0, -1.0), (1, 0, -0.7), (5, 0, -1.2)],
        4.0,
    ),
    "portal, sway": Frame(PORTAL, spans(4), COLUMNS, [(1, 1.0, 0.0)], 4.0),
    "portal, beam": Frame(PORTAL, spans(4), COLUMNS, [(2, 0.0, -1.0), (1, 0.1, 0.0)], 4.0),
    "portal, combined": Frame(PORTAL, spans(4), COLUMNS, [(1, 1.0, 0.0), (2, 0.0, -1.0)], 3.0),
    "portal on pins, combined": Frame(
        PORTAL, spans(4), PINS, [(1, 1.0, 0.0), (2, 0.0, -2.0)], 4.0 / 3.0
    ),
    "two bays": Frame(
        TWO_BAYS,
        BAYS,
        [(0, True, False), (4, True, False), (7, False, False)],
        [(1, 1.0, 0.0), (2, 0.0, -1.2), (5, 0.0, -0.8)],
    ),
    "gable": Frame(GABLE, spans(4), COLUMNS, [(2, 0.0, -1.0), (1, 0.5, 0.0)]),
}


def static_theorem(frame: Frame) -> float:
    """Largest load factor in equilibrium with end moments up to the plastic ones."""
    n = len(frame.joints)
    equilibrium = np.zeros((3 * n, 3 * len(frame.members)))
    bounds = []
    for m, (i, j, width) in enumerate(frame.members):
        (x0, y0), (x1, y1) = frame.joints[i], frame.joints[j]
        length = np.hypot(x1 - x0, y1 - y0)
        t = np.array([x1 - x0, y1 - y0]) / length
        across = np.array([-t[1], t[0]]) / length
        # Axial force and end moments on the joints' side.
        for joint, sign in ((i, -1.0), (j, 1.0)):
            equilibrium[3 * joint : 3 * joint + 2, 3 * m] = sign * t
            for k in (1, 2):
                equilibrium[3 * joint : 3 * joint + 2, 3 * m + k] = -sign * across
        equilibrium[3 * i + 2, 3 * m + 1] = equilibrium[3 * j + 2, 3 * m + 2] = 1.0
        bounds += [(None, None), *[(-width * FULL, width * FULL)] * 2]
    load = np.zeros(3 * n)
    for joint, fx, fy in frame.loads:
        load[3 * joint : 3 * joint + 2] += (fx, fy)
    free = np.ones(3 * n, bool)
    for joint, fixed, slides in frame.supports:
        free[3 * joint : 3 * joint + 3] = (slides, False, not fixed)
    rows = np.column_stack([equilibrium, -load])[free]
    cost = np.zeros(rows.shape[1])
    cost[-1] = -1.0
    found = linprog(cost, A_eq=rows, b_eq=np.zeros(len(rows)), bounds=[*bounds, (0.0, None)])
    assert found.status == 0
    return float(-found.fun)


def model_of(frame: Frame) -> ct.Model:
    points, cells, widths = list(frame.joints), [], []
    for i, j, width in frame.members:
        start, end = np.array(frame.joints[i]), np.array(frame.joints[j])
        between = [tuple(start + (end - start) * k / frame.pieces) for k in range(1, frame.pieces)]
        nodes = [i, *range(len(points), len(points) + len(between)), j]
        points += between
        cells += list(zip(nodes[:-1], nodes[1:], strict=True))
        widths += [width] * frame.pieces
    model = ct.Model(lines(points, ("line2", cells)))
    for width in sorted(set(widths)):
        profile = ct.profiles.rectangle(WIDTH * width, HEIGHT)
        model.beam(np.flatnonzero(np.array(widths) == width), material=STEEL, profile=profile)
    for joint, fixed, slides in frame.supports:
        if slides:
            model.fix([joint], x=None, y=0.0)
        else:
            model.fix([joint], rotation=fixed)
    for joint, fx, fy in frame.loads:
        model.force([joint], x=fx, y=fy)
    return model


def collapse(frame: Frame, increments: int) -> float:
    joint, fx, _ = frame.loads[0]
    dof, sign = ("x", np.sign(fx)) if fx else ("y", -1.0)
    path = ct.DisplacementControl(
        [joint], dof, sign * frame.target, increments=increments, locate=False
    )
    return float(ct.solve(model_of(frame), ct.Static(nlgeom=False, path=path)).frames[-1].factor)


@pytest.mark.parametrize("increments", [1, 10])
@pytest.mark.parametrize("name", FRAMES)
def test_collapse_load_is_that_of_limit_analysis(name: str, increments: int) -> None:
    frame = FRAMES[name]
    expected = static_theorem(frame)
    if frame.factor is not None:
        assert expected == pytest.approx(frame.factor * FULL / A, rel=1e-9)
    assert collapse(frame, increments) == pytest.approx(expected, rel=5e-3)

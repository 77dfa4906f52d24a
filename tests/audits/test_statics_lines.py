"""Trusses, beams and springs far from their places, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.mesh.data import Cells
from support.audits import line_mesh, run

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


def test_prestressed_string_with_a_large_load(tmp_path: Path) -> None:
    """Two bars with initial stress, a side load, heat: N = A s0 + EA (l/L - 1 - alpha T), exactly.

    Equilibrium in one unknown, P = 2 N v/l; solved by bracketing.
    """
    text = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
*ELEMENT, TYPE=T3D2, ELSET=all
1, 1, 2
2, 2, 3
*MATERIAL, NAME=m
*ELASTIC
1000., 0.
*EXPANSION
1e-3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*INITIAL CONDITIONS, TYPE=STRESS
all, 30.
*NSET, NSET=every, ELSET=all
*BOUNDARY
1, 1, 2
3, 1, 2
*STEP, NLGEOM
*STATIC
0.25, 1.
*CLOAD
2, 2, 40.
*TEMPERATURE
every, 10.
*END STEP
"""
    frame = run(tmp_path / "s.inp", text).frames[-1]

    def gap(v: float) -> float:
        long = math.hypot(1.0, v)
        return 2 * (0.2 * 30.0 + 200.0 * (long - 1 - 0.01)) * v / long - 40.0

    v = brentq(gap, 0.01, 2.0)
    assert frame.U[1, 1] == pytest.approx(v, rel=1e-8)
    force = 6.0 + 200.0 * (math.hypot(1.0, v) - 1.01)
    values = frame.fields[0].values
    assert np.allclose(values["N"].ravel(), force, rtol=1e-7)
    assert np.allclose(values["S"][..., :2].sum(axis=-1), force / 0.2, rtol=1e-7)
    assert frame.RF[0, 0] == pytest.approx(-force / math.hypot(1, v), rel=1e-7)


def test_section_forces_of_a_far_bent_beam() -> None:
    """N, V, M1, M2 of beams in an elastica under a dead tip load, by statics of the free end.

    At each node the tip force through its current arm; N along, V across the chord of the beam.
    """
    n, L, _EI, P = 40, 2.0, 3.0, np.array([-1.5, 6.0])
    x = np.linspace(0, L, n + 1)
    mesh = line_mesh(np.column_stack([x, 0 * x]), [(i, i + 1) for i in range(n)])
    model = ct.Model(mesh)
    model.beam(list(range(n)), material=ct.Elastic(E=3e4), area=0.1, inertia=1e-4)
    model.fix([0], rotation=True)
    model.force([n], x=P[0], y=P[1])
    frame = ct.solve(model, ct.Static(increments=5), threads=1).frames[-1]
    pos = mesh.points + frame.U
    values = frame.fields[0].values
    N, V = values["N"].ravel(), values["V"].ravel()
    M1, M2 = values["M1"].ravel(), values["M2"].ravel()
    assert frame.U[n, 1] > 1.2
    for i in range(n):
        e = (pos[i + 1] - pos[i]) / np.linalg.norm(pos[i + 1] - pos[i])
        arm0, arm1 = pos[n] - pos[i], pos[n] - pos[i + 1]
        m0 = arm0[0] * P[1] - arm0[1] * P[0]
        m1 = arm1[0] * P[1] - arm1[1] * P[0]
        assert N[i] == pytest.approx(P @ e, rel=1e-6, abs=1e-6)
        # The load bends upwards and stretches the lower side, on the right of the way.
        assert M1[i] == pytest.approx(m0, rel=1e-5, abs=1e-6)
        assert M2[i] == pytest.approx(m1, rel=1e-5, abs=1e-6)
        across = -P[0] * e[1] + P[1] * e[0]
        assert abs(V[i]) == pytest.approx(abs(across), rel=1e-5, abs=1e-5)
    clamp = pos[n, 0] * P[1] - pos[n, 1] * P[0]
    assert frame.RF[0, 2] == pytest.approx(-clamp, rel=1e-7)


def test_nonlinear_springs_in_series_with_the_ground() -> None:
    """A table spring between two nodes and one to the ground; constant force outside the table."""
    from corota.mesh import Mesh

    cells = [
        Cells("line2", np.array([[0, 1]]), np.array([1])),
        Cells("point1", np.array([[0]]), np.array([2])),
    ]
    mesh = Mesh(np.array([[0.0, 0.0], [3.0, 0.0]]), cells, np.array([1, 2]))
    model = ct.Model(mesh)
    model.spring([0], [(-1.0, -5.0), (0.0, 0.0), (0.5, 4.0), (1.0, 5.0)])
    model.spring([1], 20.0, "x")
    model.fix([0], x=None)
    model.fix([1], x=2.0)
    results = ct.solve(model, ct.Static(increments=20), threads=1)
    for f in results.frames[1:]:
        u = f.U[1, 0]

        def balance(a: float, u: float = u) -> float:
            return float(np.interp(u - a, [-1, 0, 0.5, 1], [-5, 0, 4, 5])) - 20.0 * a

        a = brentq(balance, -1.0, 2.0)
        assert f.U[0, 0] == pytest.approx(a, rel=1e-8)
        assert f.RF[1, 0] == pytest.approx(20.0 * a, rel=1e-8)


@pytest.mark.parametrize(
    ("section", "area", "inertia", "shear"),
    [
        ("RECT\n0.2, 0.6\n0., 0., -1.", 0.12, 0.6 * 0.2**3 / 12, 5 / 6),
        ("RECT\n0.2, 0.6\n0., 1., 0.", 0.12, 0.2**3 * 0.6 / 12, 5 / 6),
        ("CIRC\n0.4, 0.4\n0., 0., -1.", math.pi * 0.04, math.pi * 0.2**4 / 4, 0.9),
        (
            "PIPE\n0.3, 0.1\n0., 0., -1.",
            math.pi * (0.09 - 0.04),
            math.pi / 4 * (0.3**4 - 0.2**4),
            0.5,
        ),
    ],
)
def test_beam_sections(
    tmp_path: Path, section: str, area: float, inertia: float, shear: float
) -> None:
    """Tip of a Timoshenko cantilever, P L^3/3EI + P L/(k G A), and its stretch, at 30 degrees.

    RECT has the first size along the first axis: a depth in the plane of 0.6 if that is the normal.
    """
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    text = f"""*NODE
1, 0., 0.
2, {c}, {s}
3, {2 * c}, {2 * s}
*ELEMENT, TYPE=B31, ELSET=all
1, 1, 2
2, 2, 3
*MATERIAL, NAME=m
*ELASTIC
1000., 0.25
*BEAM SECTION, ELSET=all, MATERIAL=m, SECTION={section}
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*CLOAD
3, 1, {-s}
3, 2, {c}
*END STEP
*STEP
*STATIC
*CLOAD, OP=NEW
3, 1, {c}
3, 2, {s}
*END STEP
"""
    results = run(tmp_path / "b.inp", text)
    one, two = ([f for f in results.frames if f.step == k][-1] for k in (1, 2))
    if section.startswith("RECT\n0.2, 0.6\n0., 0."):
        inertia = 0.2 * 0.6**3 / 12
    across = one.U[2] @ [-s, c]
    assert across == pytest.approx(
        8.0 / (3 * 1000.0 * inertia) + 2.0 / (shear * 400.0 * area), rel=1e-9
    )
    assert two.U[2] @ [c, s] == pytest.approx(2.0 / (1000.0 * area), rel=1e-9)
    assert one.RF[0, 2] == pytest.approx(-2.0, rel=1e-9)

"""A further audit of decks, from closed forms: 60 checks made without the code.

Each deck is a bar, a beam, a spring or one element whose answer is known by hand.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct

#: A bar 4 x 1 of two elements, E = 100, free to thin.
BAR = """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 4., 0.
4, 0., 1.
5, 2., 1.
6, 4., 1.
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=LEFT
1, 4
*NSET, NSET=RIGHT
3, 6
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*DENSITY
2.
*EXPANSION
1.E-3
*SOLID SECTION, ELSET=EALL, MATERIAL=M
1.
*BOUNDARY
LEFT, 1
1, 2
"""
#: A beam of length 10 of ten elements, E I = 100 * 8 / 12, E A = 200.
BEAM = """*NODE, NSET=NALL
1, 0., 0.
11, 10., 0.
*NGEN, NSET=NALL
1, 11
*ELEMENT, TYPE={type}, ELSET=EALL
1, 1, 2
*ELGEN, ELSET=EALL
1, 10
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*DENSITY
2.
*BEAM SECTION, ELSET=EALL, MATERIAL=M, SECTION=RECT
1., 2.
0., 0., 1.
*BOUNDARY
1, 1, 6
"""
EI = 100.0 * 8.0 / 12.0


def solve(text: str, path: Path) -> tuple[ct.Model, ct.Results]:
    deck = path / "job.inp"
    deck.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(deck)
        return model, ct.solve(model, threads=1)


def end(text: str, path: Path, label: int = 3) -> list[float]:
    model, results = solve(text, path)
    node = int(np.flatnonzero(model.mesh.node_labels == label)[0])
    found: list[float] = results.frames[-1].U[node].tolist()
    return found


def step(lines: str, more: str = "", static: str = "*STATIC") -> str:
    return f"*STEP{more}\n{static}\n{lines}\n*END STEP\n"


BODIES = {
    "cload": ("*CLOAD\nRIGHT, 1, 1.", 2.0 * 4.0 / 100.0),
    "cload twice": ("*CLOAD\nRIGHT, 1, 1.\n*CLOAD\nRIGHT, 1, 2.", 6.0 * 4.0 / 100.0),
    "P2": ("*DLOAD\n2, P2, 3.", -3.0 * 4.0 / 100.0),
    "dsload": ("*SURFACE, NAME=S\n2, S2\n", 0.0),
    "gravity": ("*DLOAD\nEALL, GRAV, 5., 1., 0., 0.", 2.0 * 5.0 * 16.0 / 2.0 / 100.0),
    "gravity back": ("*DLOAD\nEALL, GRAV, 5., -1., 0., 0.", -2.0 * 5.0 * 16.0 / 2.0 / 100.0),
    "BX": ("*DLOAD\nEALL, BX, 5.", 5.0 * 16.0 / 2.0 / 100.0),
    "centrif": ("*DLOAD\nEALL, CENTRIF, .5, 0., 0., 0., 0., 0., 1.", 64.0 / 3.0 / 100.0),
    "heat": ("*TEMPERATURE\nNALL, 20.", 4.0 * 20.0e-3),
    "moved": ("*BOUNDARY\nRIGHT, 1, 1, .3", 0.3),
    "equation": ("*CLOAD\n3, 1, 2.", 2.0 * 4.0 / 100.0),
    "amplitude": ("*CLOAD, AMPLITUDE=A\nRIGHT, 1, 1.", 0.5 * 2.0 * 4.0 / 100.0),
}


@pytest.mark.parametrize("name", BODIES)
def test_a_bar_gets_longer(name: str, tmp_path: Path) -> None:
    """12 checks: F L / E A, rho g L^2 / 2 E, rho W^2 L^3 / 3 E, alpha T L; linear elements."""
    lines, wanted = BODIES[name]
    head = BAR
    if name == "equation":
        head += "*EQUATION\n2\n6, 1, 1., 3, 1, -1.\n"
    if name == "amplitude":
        head += "*AMPLITUDE, NAME=A\n0., 0., 1., .5\n"
    if name == "dsload":
        head, lines, wanted = head + lines, "*DSLOAD\nS, P, -3.", 3.0 * 4.0 / 100.0
    u = [end(head + step(lines), tmp_path, label)[0] for label in (3, 6)]
    # The weight of the spin is off the axis: the bar bends, its middle does not get longer by that.
    found = u[0] if name == "P2" else sum(u) / 2.0
    assert found == pytest.approx(wanted, rel=1e-9)


OPS = {
    "MOD adds": ("*CLOAD\n3, 1, 1.", "*CLOAD, OP=MOD\n6, 1, 1.", 2.0),
    "MOD replaces": ("*CLOAD\nRIGHT, 1, 1.", "*CLOAD, OP=MOD\nRIGHT, 1, 2.", 4.0),
    "NEW removes": ("*CLOAD\nRIGHT, 1, 1.", "*CLOAD, OP=NEW\n3, 1, 1.", 1.0),
    "NEW of others": ("*CLOAD\nRIGHT, 1, 1.", "*DLOAD, OP=NEW\n2, P2, -1.", 3.0),
    "zero ends": ("*CLOAD\nRIGHT, 1, 1.", "*CLOAD\nRIGHT, 1, 0.", 0.0),
    "pressure stays": ("*DLOAD\n2, P2, -1.", "*CLOAD\nRIGHT, 1, 1.", 3.0),
    "pressure zero": ("*DLOAD\n2, P2, -1.", "*DLOAD\n2, P2, 0.", 0.0),
    "pressure replaced": ("*DLOAD\n2, P2, -1.", "*DLOAD\n2, P2, -3.", 3.0),
}


@pytest.mark.parametrize("name", OPS)
def test_loads_over_two_steps(name: str, tmp_path: Path) -> None:
    """8 checks: the force at the end of the second step, from the mean of both end nodes."""
    first, second, force = OPS[name]
    deck = BAR + step(first) + step(second)
    model, results = solve(deck, tmp_path)
    u = results.frames[-1].U[model.mesh.nodes_of("RIGHT"), 0].mean()
    assert u == pytest.approx(force * 4.0 / 100.0, rel=1e-9, abs=1e-12)


TYPES = ["B21", "B31", "B23", "B33"]


@pytest.mark.parametrize("type_", TYPES)
@pytest.mark.parametrize("load", ["force", "moment", "weight", "per length", "tension"])
def test_a_cantilever_of_beams(type_: str, load: str, tmp_path: Path) -> None:
    """20 checks: F L^3/3EI (+ 6 F L / 5 G A), M L^2/2EI, q L^4/8EI (+ 6 q L^2/10 G A), F L/E A."""
    shear = 1.2 / (50.0 * 2.0) if type_ in ("B21", "B31") else 0.0
    q, length = 0.01, 10.0
    lines, wanted = {
        "force": ("*CLOAD\n11, 2, .1", 0.1 * (length**3 / (3 * EI) + shear * length)),
        "moment": ("*CLOAD\n11, 6, .1", 0.1 * length**2 / (2 * EI)),
        "weight": (
            f"*DLOAD\nEALL, GRAV, {q / 4.0}, 0., 1., 0.",
            q * (length**4 / (8 * EI) + shear * length**2 / 2),
        ),
        "per length": (
            f"*DLOAD\nEALL, PY, {q}",
            q * (length**4 / (8 * EI) + shear * length**2 / 2),
        ),
        "tension": ("*CLOAD\n11, 1, .5", 0.5 * length / 200.0),
    }[load]
    found = end(BEAM.format(type=type_) + step(lines), tmp_path, 11)
    assert found[0 if load == "tension" else 1] == pytest.approx(wanted, rel=1e-6)


SPRINGS = {
    "SPRINGA": ("1, 1, 2", "\n40.", 1.0 / 40.0),
    "SPRING1": ("1, 2", "1\n40.", 1.0 / 40.0),
    "SPRING2": ("1, 1, 2", "1, 1\n40.", 1.0 / 40.0),
    "two": ("1, 1, 2\n2, 1, 2", "\n40.", 1.0 / 80.0),
}


@pytest.mark.parametrize("what", ["force", "frequency"])
@pytest.mark.parametrize("name", SPRINGS)
def test_a_spring_with_a_mass(name: str, what: str, tmp_path: Path) -> None:
    """8 checks: F / k and sqrt(k / m) / 2 pi."""
    elements, value, wanted = SPRINGS[name]
    type_ = "SPRINGA" if name == "two" else name
    head = (
        f"*NODE\n1, 0., 0.\n2, 3., 0.\n*ELEMENT, TYPE={type_}, ELSET=SP\n{elements}\n"
        f"*SPRING, ELSET=SP\n{value}\n*ELEMENT, TYPE=MASS, ELSET=MS\n9, 2\n*MASS, ELSET=MS\n.1\n"
        "*BOUNDARY\n1, 1, 2\n2, 2\n"
    )
    if what == "force":
        found = end(head + step("*CLOAD\n2, 1, 1."), tmp_path, 2)[0]
        assert found == pytest.approx(wanted, rel=1e-9)
    else:
        _, results = solve(head + step("1", static="*FREQUENCY"), tmp_path)
        exact = math.sqrt(1.0 / wanted / 0.1) / (2.0 * math.pi)
        assert results.modes[-1].factors[0] == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("strain", [0.02, 0.05, 0.1, 0.2])
def test_true_stress_of_a_plastic_bar(strain: float, tmp_path: Path) -> None:
    """4 checks: F = A s(e) exp(-e) of an incompressible bar, e logarithmic (0.6 %: elasticity)."""
    flow = "*PLASTIC\n.2, 0.\n.4, 1.\n"
    text = BAR.replace("*DENSITY", flow + "*DENSITY").replace("100., 0.", "100., .5")
    text = text.replace("100., .5", "100., .49")
    lines = f"*BOUNDARY\nRIGHT, 1, 1, {4.0 * strain}"
    model, results = solve(text + step(lines, ", NLGEOM, INC=500", "*STATIC\n.1, 1."), tmp_path)
    force = -results.frames[-1].RF[model.mesh.nodes_of("LEFT"), 0].sum()
    e = math.log1p(strain)
    stress = (0.2 + 0.2 * e) / (1.0 + 0.2 / 100.0)
    assert force == pytest.approx(stress * math.exp(-e), rel=6e-3)


@pytest.mark.parametrize("type_", TYPES)
@pytest.mark.parametrize("what", ["buckling", "frequency"])
def test_euler_and_first_frequency(type_: str, what: str, tmp_path: Path) -> None:
    """8 checks: pi^2 E I / 4 L^2 and 3.516 sqrt(E I / rho A L^4) / 2 pi; 3 % for h / L = .2."""
    if what == "buckling":
        lines, wanted = "*CLOAD\n11, 1, -1.", math.pi**2 * EI / 400.0
        _, results = solve(
            BEAM.format(type=type_) + step("1\n" + lines, static="*BUCKLE"), tmp_path
        )
    else:
        wanted = 3.516015 * math.sqrt(EI / 4.0 / 1e4) / (2.0 * math.pi)
        _, results = solve(BEAM.format(type=type_) + step("1", static="*FREQUENCY"), tmp_path)
    assert results.modes[-1].factors[0] == pytest.approx(wanted, rel=0.03)

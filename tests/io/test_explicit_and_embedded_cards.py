"""Mass scaling, embedded elements, shear stiffness, rotating starts, dampers to the ground."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct

#: A bar of two elements, E = 1000, density 1, without Poisson effect.
BAR = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 3., 0.
4, 0., 1.
5, 1., 1.
6, 3., 1.
*ELEMENT, TYPE=CPE4, ELSET=A
1, 1, 2, 5, 4
*ELEMENT, TYPE=CPE4, ELSET=B
2, 2, 3, 6, 5
*ELSET, ELSET=AB
A, B
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DENSITY
{rho}
*SOLID SECTION, ELSET=AB, MATERIAL=M
1.
"""
EXPLICIT = """*STEP
*DYNAMIC, EXPLICIT
, .1
{scaling}{load}
*END STEP
"""
PULL = "*BOUNDARY\n1, 1, 2\n4, 1, 2\n*CLOAD\n3, 1, 1.\n6, 1, 1."
FALL = "*DLOAD\nAB, GRAV, 10., 0., -1."


def read(path: Path, text: str) -> ct.Model:
    deck = path / "deck.inp"
    deck.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.read(deck)


def solve(path: Path, text: str) -> ct.Results:
    return ct.solve(read(path, text), threads=1)


def explicit(path: Path, scaling: str, load: str = PULL, rho: float = 1.0) -> ct.Results:
    return solve(path, BAR.format(rho=rho) + EXPLICIT.format(scaling=scaling, load=load))


@pytest.mark.parametrize(
    ("card", "rho"),
    [
        ("FACTOR=9.", 9.0),
        # A wave, of speed sqrt(1000), takes 1 / sqrt(1000) through the height of both.
        (f"DT={2.0 / math.sqrt(1000.0)!r}", 4.0),
        (f"DT={2.0 / math.sqrt(1000.0)!r}, TYPE=UNIFORM", 4.0),
        (f"DT={0.5 / math.sqrt(1000.0)!r}", 1.0),
        (f"DT={0.5 / math.sqrt(1000.0)!r}, TYPE=SET EQUAL DT", 0.25),
        (f"FACTOR=4., DT={3.0 / math.sqrt(1000.0)!r}", 9.0),
    ],
)
@pytest.mark.parametrize("name", ["FIXED", "VARIABLE"])
def test_scaled_mass_is_that_of_a_denser_material(
    tmp_path: Path, card: str, rho: float, name: str
) -> None:
    if name == "VARIABLE" and "DT" not in card:
        return
    found = explicit(tmp_path, f"*{name} MASS SCALING, {card}\n")
    wanted = explicit(tmp_path, "", rho=rho)
    assert len(found.frames) == len(wanted.frames)
    assert np.allclose(found.frames[-1].U, wanted.frames[-1].U, rtol=1e-9, atol=1e-12)


def test_gravity_acts_on_the_mass_without_scaling(tmp_path: Path) -> None:
    """Free fall of elements that are four times as heavy: g t^2 / 8."""
    found = explicit(tmp_path, "*FIXED MASS SCALING, FACTOR=4.\n", FALL).frames[-1]
    assert found.U[:, 1] == pytest.approx(-0.5 * 2.5 * 0.1**2, rel=0.02)
    plain = explicit(tmp_path, "", FALL).frames[-1]
    assert np.allclose(found.U, 0.25 * plain.U, rtol=0.02, atol=1e-6)


def test_a_part_is_scaled_and_what_is_refused(tmp_path: Path) -> None:
    model = read(
        tmp_path,
        BAR.format(rho=1.0)
        + EXPLICIT.format(scaling="*FIXED MASS SCALING, ELSET=B, FACTOR=5.\n", load=PULL),
    )
    assert sorted(section.material.rho for section in model.sections) == [1.0, 5.0]
    static = BAR.format(rho=1.0) + "*STEP\n*STATIC\n*FIXED MASS SCALING, FACTOR=5.\n*END STEP\n"
    with pytest.raises(ct.DeckError, match="EXPLICIT"):
        read(tmp_path, static)
    text = BAR.format(rho=1.0) + EXPLICIT.format(scaling="", load=PULL)
    with pytest.raises(ct.DeckError, match="same in all steps"):
        read(
            tmp_path, text + EXPLICIT.format(scaling="*FIXED MASS SCALING, FACTOR=5.\n", load=PULL)
        )
    spin = "*DLOAD\nAB, CENTRIF, 1., 0., 0., 0., 0., 0., 1."
    with pytest.raises(ct.DeckError, match="centrifugal"):
        explicit(tmp_path, "*FIXED MASS SCALING, FACTOR=5.\n", spin)


REBAR = """*NODE
11, 0., .5
12, {x}, .5
13, 3., .5
*ELEMENT, TYPE=T2D2, ELSET=REBAR
11, 11, 12
12, 12, 13
*SOLID SECTION, ELSET=REBAR, MATERIAL=M
.2
*EMBEDDED ELEMENT{host}
REBAR
*BOUNDARY
1, 1, 2
4, 1
*STEP{nlgeom}
*STATIC
*BOUNDARY
3, 1, 1, {pull}
6, 1, 1, {pull}
*END STEP
"""


@pytest.mark.parametrize("host", ["", ", HOST ELSET=AB"])
@pytest.mark.parametrize(("nlgeom", "pull"), [("", 0.03), (", NLGEOM", 0.6)])
@pytest.mark.parametrize("x", [0.4, 1.0, 2.2])
def test_an_embedded_bar_is_stretched_with_its_host(
    tmp_path: Path, host: str, nlgeom: str, pull: float, x: float
) -> None:
    """Bars in parallel: the force is that without the bar times 1 + A_bar / A."""
    text = BAR.format(rho=1.0) + REBAR.format(x=x, host=host, nlgeom=nlgeom, pull=pull)
    frame = solve(tmp_path, text).frames[-1]
    assert frame.U[7, 0] == pytest.approx(pull * x / 3.0, rel=1e-9)
    force = -frame.RF[[0, 3], 0].sum()
    if not nlgeom:
        assert force == pytest.approx(1.2 * 1000.0 * pull / 3.0, rel=1e-9)
    else:
        # The deck is one of Abaqus: a host of logarithmic strain; trusses have that of length.
        stretch = 1.0 + pull / 3.0
        host_force = 1000.0 * math.log(stretch) / stretch
        assert force == pytest.approx(host_force + 200.0 * pull / 3.0, rel=1e-9)


def test_a_node_outside_its_host_is_refused(tmp_path: Path) -> None:
    text = BAR.format(rho=1.0) + REBAR.format(x=1.0, host="", nlgeom="", pull=0.1)
    with pytest.raises(ct.DeckError, match="node 12 of the embedded elements is in no element"):
        read(tmp_path, text.replace("12, 1.0, .5", "12, 1.0, 1.5"))


def test_shear_stiffness_of_a_cantilever(tmp_path: Path) -> None:
    """P L^3 / 3 E I + P L / K."""
    text = """*NODE
1, 0., 0.
2, 5., 0.
3, 10., 0.
*ELEMENT, TYPE=B21, ELSET=E
1, 1, 2
2, 2, 3
*MATERIAL, NAME=M
*ELASTIC
1000., .25
*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT
1., 2.
0., 0., -1.
*TRANSVERSE SHEAR STIFFNESS
50., 50.
*BOUNDARY
1, 1, 6
*STEP
*STATIC
*CLOAD
3, 2, .1
*END STEP
"""
    wanted = 0.1 * 1000.0 / (3.0 * 1000.0 * 8.0 / 12.0) + 0.1 * 10.0 / 50.0
    assert solve(tmp_path, text).frames[-1].U[2, 1] == pytest.approx(wanted, rel=1e-6)


def test_a_body_starts_to_rotate(tmp_path: Path) -> None:
    """Velocities v0 + omega x r about an axis through (1, 2)."""
    text = BAR.format(rho=1.0) + (
        "*INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\nALL, 2., 3., 4., 0.\n"
        "1., 2., 0., 1., 2., {z}\n"
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.001, .001\n*END STEP\n"
    )
    for z, spin in ((1.0, 2.0), (-1.0, -2.0)):
        model = read(tmp_path, text.format(z=z))
        first = ct.solve(model, threads=1).frames[0]
        x = model.mesh.points
        wanted = np.stack([3.0 - spin * (x[:, 1] - 2.0), 4.0 + spin * (x[:, 0] - 1.0)], axis=1)
        assert np.allclose(first.V[:, :2], wanted, rtol=1e-9)


@pytest.mark.parametrize("extra", ["", "2, 7., 0.\n"])
def test_a_damper_to_the_ground(tmp_path: Path, extra: str) -> None:
    """A mass on a spring, with a damper of a tenth of the critical damping, under a sudden force.

    One version stopped where the model has a single node.
    """
    text = f"""*NODE
1, 0., 0.
{extra}*ELEMENT, TYPE=SPRING1, ELSET=SP
1, 1
*ELEMENT, TYPE=DASHPOT1, ELSET=DA
2, 1
*ELEMENT, TYPE=MASS, ELSET=MA
3, 1
*SPRING, ELSET=SP
1
100.
*DASHPOT, ELSET=DA
1
2.
*MASS, ELSET=MA
1.
*BOUNDARY
1, 2
{"2, 1, 2" if extra else "1, 6"}
*STEP, INC=1000
*DYNAMIC, ALPHA=0., {{direct}}
{{first}}, .3
*CLOAD
1, 1, 1.
*END STEP
"""
    z, w = 0.1, 10.0
    d = w * math.sqrt(1.0 - z * z)
    wave = math.cos(0.3 * d) + z * w / d * math.sin(0.3 * d)
    wanted = 0.01 * (1.0 - math.exp(-z * w * 0.3) * wave)
    exact = solve(tmp_path, text.format(direct="DIRECT", first=".001")).frames[-1].U[0, 0]
    assert exact == pytest.approx(wanted, rel=1e-4)
    default = solve(tmp_path, text.format(direct="", first=".3")).frames[-1].U[0, 0]
    assert default == pytest.approx(wanted, rel=0.05)


def test_an_amplitude_with_absolute_values(tmp_path: Path) -> None:
    """The values of the table count, not those of the loads."""
    text = BAR.format(rho=1.0) + (
        "*AMPLITUDE, NAME=T, VALUE=ABSOLUTE\n0., 0., 1., .02\n*BOUNDARY\n1, 1, 2\n4, 1\n"
        "*STEP\n*STATIC\n*BOUNDARY, AMPLITUDE=T\n3, 1, 1, 7.\n6, 1, 1, 7.\n*END STEP\n"
    )
    frame = solve(tmp_path, text).frames[-1]
    assert frame.U[[2, 5], 0] == pytest.approx(0.02, rel=1e-12)
    heavy = text.replace(
        "*BOUNDARY, AMPLITUDE=T", "*DLOAD, AMPLITUDE=T\nAB, GRAV, 1., 0., -1.\n*CLOAD"
    )
    with pytest.raises(ct.DeckError, match="VALUE=ABSOLUTE"):
        read(tmp_path, heavy)


def test_fields_that_no_data_depend_on_are_noted(tmp_path: Path) -> None:
    text = BAR.format(rho=1.0) + (
        "*INITIAL CONDITIONS, TYPE=FIELD, VARIABLE=1\nALL, 1.\n*BOUNDARY\n1, 1, 2\n4, 1\n"
        "*STEP\n*STATIC\n*FIELD, VARIABLE=1\nALL, 2.\n*SOLUTION TECHNIQUE, TYPE=QUASI-NEWTON\n"
        "*CLOAD\n3, 1, 1.\n*END STEP\n"
    )
    model = read(tmp_path, text)
    assert sum("field variables" in note for note in model.notes) == 2


@pytest.mark.parametrize(
    "table", ["10., 0.\n20., .1\n", "10., 0.\n12., .02\n20., .1\n", "10., 0.\n"]
)
@pytest.mark.parametrize("strain", [0.0, 0.04, 0.3])
def test_initial_hardening_begins_further_on_the_curve(
    tmp_path: Path, table: str, strain: float
) -> None:
    """A bar drawn by .05 per length: s = sy(p0 + p) with s / E + p = .05, in one increment."""
    text = BAR.format(rho=1.0).replace("*DENSITY", f"*PLASTIC\n{table}*DENSITY")
    text = text.replace("CPE4", "CPS4R") + (
        f"*INITIAL CONDITIONS, TYPE=HARDENING\nAB, {strain}\n*BOUNDARY\n1, 1, 2\n4, 1\n"
        "*STEP\n*STATIC\n*BOUNDARY\n3, 1, 1, .15\n6, 1, 1, .15\n*END STEP\n"
    )
    stresses, strains = np.array(
        [[float(x) for x in row.split(",")] for row in table.splitlines()]
    ).T
    low, high = 0.0, 0.05
    for _ in range(60):
        p = 0.5 * (low + high)
        over = 1000.0 * (0.05 - p) > np.interp(strain + p, strains, stresses)
        low, high = (p, high) if over else (low, p)
    deck = tmp_path / "deck.inp"
    deck.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        frame = ct.solve(ct.read(deck, as_written=True), threads=1).frames[-1]
    assert -frame.RF[[0, 3], 0].sum() == pytest.approx(1000.0 * (0.05 - p), rel=1e-6)
    kinematic = text.replace("*PLASTIC", "*PLASTIC, HARDENING=KINEMATIC")
    if strain and len(stresses) == 2:
        with pytest.raises(ct.DeckError, match="isotropic hardening"):
            read(tmp_path, kinematic)

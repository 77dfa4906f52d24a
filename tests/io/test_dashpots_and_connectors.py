"""Dashpots in dofs and by tables, cards before and behind their elements, connectors that move."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.model.attachments import Dashpot
from support.pairs import cover

MASS = 2.0
#: A mass on a spring of stiffness 50 from a node that is held; a third node holds the dashpot.
SWING = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
{cards}*BOUNDARY
1, 1, 2
3, 1, 2
2, 2
*STEP, NLGEOM, INC=1000
*DYNAMIC, DIRECT, ALPHA=0.
.005, 1.
*CLOAD
2, 1, 5.
*END STEP
"""
SPRING = ("*ELEMENT, TYPE=SPRINGA, ELSET=S\n1, 1, 2\n", "*SPRING, ELSET=S\n\n50.\n")
POINT = ("*ELEMENT, TYPE=MASS, ELSET=M\n2, 2\n", f"*MASS, ELSET=M\n{MASS}\n")
DAMPERS = {
    "DASHPOTA": ("3, 2, 3", "\n4.\n"),
    "DASHPOT2": ("3, 2, 3", "1, 1\n4.\n"),
    "DASHPOT1": ("3, 2", "1\n4.\n"),
}


def run(path: Path, text: str) -> ct.Results:
    deck = path / "deck.inp"
    deck.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(ct.read(deck), threads=1)


def integrate(force: object) -> float:
    """Position at t = 1 of the mass, by Runge and Kutta."""

    def rate(y: np.ndarray) -> np.ndarray:
        return np.array([y[1], (5.0 - 50.0 * y[0] - force(y[1])) / MASS])  # type: ignore[operator]

    y, h = np.zeros(2), 2e-3
    for _ in range(500):
        a = rate(y)
        b = rate(y + 0.5 * h * a)
        c = rate(y + 0.5 * h * b)
        d = rate(y + h * c)
        y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return float(y[0])


@pytest.mark.parametrize(("type_", "last"), cover(DAMPERS, [False, True], strength=1))
def test_a_damped_swing(tmp_path: Path, type_: str, last: bool) -> None:
    """The card with the value stands behind its elements, or before them, as CAE writes it."""
    line, value = DAMPERS[type_]
    damper = (f"*ELEMENT, TYPE={type_}, ELSET=D\n{line}\n", f"*DASHPOT, ELSET=D\n{value}")
    cards = [part for pair in (SPRING, POINT, damper) for part in (pair[::-1] if last else pair)]
    found = run(tmp_path, SWING.format(cards="".join(cards))).frames[-1].U[1, 0]
    assert found == pytest.approx(integrate(lambda v: 4.0 * v), rel=5e-4)


@pytest.mark.parametrize("type_", DAMPERS)
def test_a_dashpot_with_a_table(tmp_path: Path, type_: str) -> None:
    """Less damping from a velocity of .1 on; none more beyond .4."""
    line, value = DAMPERS[type_]
    table = [(-1.2, -0.4), (-0.8, -0.1), (0.0, 0.0), (0.6, 0.1), (1.0, 0.4)]
    rows = "".join(f"{f}, {v}\n" for f, v in table)
    dofs = value.partition("\n")[0]
    cards = (*SPRING, *POINT, f"*ELEMENT, TYPE={type_}, ELSET=D\n{line}\n")
    text = "".join(cards) + f"*DASHPOT, ELSET=D, NONLINEAR\n{dofs}\n{rows}"
    found = run(tmp_path, SWING.format(cards=text)).frames[-1].U[1, 0]
    # The first node of DASHPOTA approaches the other: the table is that of parting.
    sign = -1.0 if type_ == "DASHPOTA" else 1.0
    f, v = np.array(table).T
    wanted = integrate(lambda rate: sign * np.interp(sign * rate, v, f))
    assert found == pytest.approx(wanted, rel=1e-3)


def test_dashpots_that_make_no_sense() -> None:
    for words in (
        {"table": ((0.0, 0.0), (0.0, 1.0))},
        {"table": ((-1.0, 1.0), (1.0, 2.0))},
        {"table": ((-1.0, -1.0), (1.0, 1.0)), "c": 2.0},
        {"dofs": (0, 3)},
    ):
        with pytest.raises(ct.InputError):
            Dashpot(0, 1, **words)  # type: ignore[arg-type]


def test_dashpots_are_written_and_read(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    model.section(element="Q4", material=ct.Elastic(100.0, 0.3, rho=1.0))
    model.dashpot(1, x=1.0, y=2.0)
    model.dashpot(1, 2, c=3.0)
    table = ((-1.0, -2.0), (0.0, 0.0), (1.0, 3.0))
    model.dashpots += [Dashpot(1, 3, 4.0, dofs=(0, 1)), Dashpot(1, 2, table=table)]
    model.dashpots.append(Dashpot(4, dofs=(1, 1), table=table))
    ct.write(model, tmp_path / "model.inp")
    read = ct.read(tmp_path / "model.inp").dashpots
    assert [(d.first, d.second, d.dofs, d.c) for d in read[:4]] == [
        (1, None, None, 0.0),
        (1, None, None, 0.0),
        (1, 2, None, 3.0),
        (1, 3, (0, 1), 4.0),
    ]
    assert [d.to_ground for d in read[:2]] == [(1.0, 0.0, 0.0), (0.0, 2.0, 0.0)]
    assert read[4].table == read[5].table == table
    assert (read[5].second, read[5].dofs) == (None, (1, 1))


@pytest.mark.parametrize("order", ["1, 2", "2, 1"])
def test_a_rigid_bar_by_mpc(tmp_path: Path, order: str) -> None:
    """Node 2 of a solid is on a bar of length 1 from a pinned node: it moves across it alone."""
    deck = f"""*NODE
1, -1., 0.
2, 0., 0.
3, 1., 0.
4, 1., 1.
5, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 2, 3, 4, 5
*MATERIAL, NAME=M
*ELASTIC
100., 0.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*MPC
LINK, {order}
*BOUNDARY
1, 1, 2
3, 1, 2
4, 1, 2
*STEP, NLGEOM
*STATIC
1., 1.
*CLOAD
2, 2, 20.
2, 1, 5.
*END STEP
"""
    found = run(tmp_path, deck)
    x, y = found.mesh.points[1] + found.frames[-1].U[1]
    assert math.hypot(x + 1.0, y) == pytest.approx(1.0, abs=1e-12)
    assert abs(y) > 0.05


def test_two_dampings_are_refused(tmp_path: Path) -> None:
    cards = "".join((*SPRING, *POINT)) + "*ELEMENT, TYPE=DASHPOTA, ELSET=D\n3, 2, 3\n"
    cards += "*DASHPOT, ELSET=D\n\n4., 0.\n5., 100.\n"
    with pytest.raises(ct.DeckError, match="no temperature and no frequency"):
        run(tmp_path, SWING.format(cards=cards))


#: Two nodes: one held, the other on weak springs to it; the connector is in between.
PAIR = """*NODE, NSET=ALL
1, 0., 0.
2, {x}, 0.
3, 9., 9.
4, 9., 8.
*ELEMENT, TYPE=SPRINGA, ELSET=S
1, 3, 4
*SPRING, ELSET=S

1.
{cards}*BOUNDARY
1, 1, 2
3, 1, 2
4, 1, 2
{support}*STEP{nlgeom}
{procedure}
*CLOAD
2, 1, {fx}
2, 2, {fy}
*END STEP
"""


def connected(path: Path, section: str, behavior: str = "", **words: object) -> ct.Results:
    given = {"x": 1.0, "support": "", "nlgeom": "", "fx": 0.0, "fy": 0.0}
    given |= {"procedure": "*STATIC\n1., 1.", "order": "1, 2", **words}
    named = ", BEHAVIOR=B" if behavior else ""
    cards = f"*CONNECTOR BEHAVIOR, NAME=B\n{behavior}" if behavior else ""
    cards += f"*CONNECTOR SECTION, ELSET=C{named}\n{section}\n"
    cards += f"*ELEMENT, TYPE=CONN2D2, ELSET=C\n9, {given['order']}\n"
    cards += "*ORIENTATION, NAME=O30\n.8660254037844387, .5, 0., -.5, .8660254037844387, 0.\n"
    cards += "*ORIENTATION, NAME=O90\n0., 1., 0., -1., 0., 0.\n"
    cards += words.get("more", "")  # type: ignore[operator]
    return run(path, PAIR.format(cards=cards, **given))


def elastic(component: int, k: float) -> str:
    return f"*CONNECTOR ELASTICITY, COMPONENT={component}\n{k},\n"


#: Holds node 2 along y.
SOFT = "*ELEMENT, TYPE=SPRING1, ELSET=G\n7, 2\n*SPRING, ELSET=G\n2\n{k}\n"


def test_an_axial_spring_in_one_large_increment(tmp_path: Path) -> None:
    """A force of 30 across a line of 1, and a soft spring along y."""
    soft = SOFT.format(k=1.0)
    words = {"nlgeom": ", NLGEOM", "fx": 18.0, "fy": 24.0, "more": soft}
    found = connected(tmp_path, "AXIAL,", elastic(1, 20.0), **words)
    x, y = found.mesh.points[1] + found.frames[-1].U[1]
    length = math.hypot(x, y)
    force = 20.0 * (length - 1.0) / length
    assert (force * x, force * y + y) == pytest.approx((18.0, 24.0), rel=1e-8)


@pytest.mark.parametrize("order", ["1, 2", "2, 1"])
def test_springs_along_both_axes(tmp_path: Path, order: str) -> None:
    behavior = elastic(1, 20.0) + elastic(2, 5.0)
    plain = connected(tmp_path, "CARTESIAN,", behavior, fx=2.0, fy=3.0, order=order)
    assert plain.frames[-1].U[1] == pytest.approx([0.1, 0.6])
    turned = connected(tmp_path, "CARTESIAN,\nO90,", behavior, fx=2.0, fy=3.0, order=order)
    assert turned.frames[-1].U[1] == pytest.approx([0.4, 0.15])
    with pytest.raises(ct.DeckError, match="along x and y"):
        connected(tmp_path, "CARTESIAN,\nO30,", behavior, fx=2.0)


@pytest.mark.parametrize(("orientation", "u"), [("", -0.3), ("\nO90,", 0.1)])
def test_a_spring_that_is_stiff_on_one_side(tmp_path: Path, orientation: str, u: float) -> None:
    """10 when node 2 goes to the side of local 1, 30 when it goes back; across it, always 4.

    Local 2 of the orientation of 90 degrees is -x: with the table there, -x is the soft side.
    """
    rows = "-30., -1.\n0., 0.\n10., 1.\n"
    component = 1 if not orientation else 2
    behavior = f"*CONNECTOR ELASTICITY, COMPONENT={component}, NONLINEAR\n{rows}"
    behavior += elastic(3 - component, 4.0)
    found = connected(tmp_path, f"CARTESIAN,{orientation}", behavior, fx=3.0 if u > 0 else -9.0)
    assert found.frames[-1].U[1] == pytest.approx([u, 0.0], abs=1e-9)


def test_a_spring_to_the_ground(tmp_path: Path) -> None:
    behavior = elastic(1, 20.0) + elastic(2, 5.0)
    found = connected(tmp_path, "CARTESIAN,", behavior, fx=2.0, fy=3.0, order=", 2")
    assert found.frames[-1].U[1] == pytest.approx([0.1, 0.6])


@pytest.mark.parametrize(
    ("section", "behavior"),
    [("LINK,", ""), ("AXIAL,", "*CONNECTOR ELASTICITY, RIGID, COMPONENT=1\n")],
)
@pytest.mark.parametrize("order", ["1, 2", "2, 1"])
def test_a_rigid_link_turns_into_its_load(
    tmp_path: Path, section: str, behavior: str, order: str
) -> None:
    """Of length 1, on a soft spring along y from (1, 0): k y = F - N sin, N cos = 0 for no fx."""
    soft = SOFT.format(k=10.0)
    found = connected(
        tmp_path, section, behavior, nlgeom=", NLGEOM", fx=6.0, fy=8.0, order=order, more=soft
    )
    x, y = found.mesh.points[1] + found.frames[-1].U[1]
    assert math.hypot(x, y) == pytest.approx(1.0, abs=1e-9)
    # No force remains along the circle.
    assert -6.0 * y + (8.0 - 10.0 * y) * x == pytest.approx(0.0, abs=1e-6)


def test_a_slot_leads_along_its_direction(tmp_path: Path) -> None:
    behavior = elastic(1, 5.0)
    plain = connected(tmp_path, "SLOT,", behavior, fx=2.0, fy=3.0)
    assert plain.frames[-1].U[1] == pytest.approx([0.4, 0.0], abs=1e-12)
    soft = SOFT.format(k=10.0)
    found = connected(tmp_path, "SLOT,\nO30,", fx=2.0, fy=3.0, more=soft, nlgeom=", NLGEOM")
    s = (2.0 * math.cos(math.pi / 6.0) + 1.5) / (10.0 * 0.25)  # along the slot
    assert found.frames[-1].U[1] == pytest.approx([s * math.cos(math.pi / 6.0), 0.5 * s])


@pytest.mark.parametrize("order", ["2, 4", "4, 2"])
@pytest.mark.parametrize("kind", ["SLOT", "TRANSLATOR"])
def test_a_slot_at_a_beam_turns_with_it(tmp_path: Path, kind: str, order: str) -> None:
    """Node 4 lies 2 ahead of the end of a cantilever: it goes to v + 2 rotation.

    With node 4 first the direction is that of a node without rotation: it goes along by v alone.
    """
    deck = f"""*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
4, 3., 0.
*ELEMENT, TYPE=B23, ELSET=E
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
12., 0.
*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT
1., 1.
0., 0., -1.
*ELEMENT, TYPE=CONN2D2, ELSET=C
9, {order}
*CONNECTOR SECTION, ELSET=C
{kind},
*BOUNDARY
1, 1, 6
4, 1
*STEP
*STATIC
*CLOAD
2, 2, .3
*END STEP
"""
    found = run(tmp_path, deck).frames[-1]
    assert found.U[1, 1] == pytest.approx(0.1)
    assert found.U[2, 1] == pytest.approx(0.1 + 2.0 * 0.15 * (order == "2, 4"))


def test_a_damper_in_a_connector(tmp_path: Path) -> None:
    """A constant force on a damper of 4 and a spring of 20: u = F / k (1 - exp(-k t / c))."""
    behavior = elastic(1, 20.0) + "*CONNECTOR DAMPING, COMPONENT=1\n4.,\n"
    found = connected(
        tmp_path,
        "CARTESIAN,",
        behavior + elastic(2, 1.0),
        fx=10.0,
        procedure="*DYNAMIC, DIRECT, ALPHA=0.\n.002, .2",
        more="*ELEMENT, TYPE=MASS, ELSET=M\n5, 2\n*MASS, ELSET=M\n1e-6,\n",
    )
    wanted = 0.5 * (1.0 - math.exp(-20.0 * 0.2 / 4.0))
    assert found.frames[-1].U[1, 0] == pytest.approx(wanted, rel=2e-3)


def test_what_connectors_refuse(tmp_path: Path) -> None:
    for section, behavior, said in (
        ("BUSHING,", "", "not part of this version"),
        ("AXIAL,", elastic(2, 1.0), "component 2 of a connection AXIAL"),
        ("AXIAL,", "*CONNECTOR ELASTICITY\n1.,\n", "COMPONENT= is missing"),
        ("CARTESIAN,\nNONE,", elastic(1, 1.0), "no orientation named"),
    ):
        with pytest.raises(ct.DeckError, match=said):
            connected(tmp_path, section, behavior)


def test_damping_in_a_step_is_that_of_the_model(tmp_path: Path) -> None:
    """As in CalculiX; beside a material that has its own it is refused."""
    strip = """*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1.
{material}*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*DYNAMIC, DIRECT
.01, .2
{step}*CLOAD
2, 2, 5.
*END STEP
"""
    card = "*DAMPING, ALPHA=2., BETA=.01\n"
    own = run(tmp_path, strip.format(material=card, step="")).frames[-1].U
    free = run(tmp_path, strip.format(material="", step="")).frames[-1].U
    found = run(tmp_path, strip.format(material="", step=card)).frames[-1].U
    assert np.abs(own - free).max() > 0.01 * np.abs(free).max()
    assert found == pytest.approx(own, rel=1e-12)
    with pytest.raises(ct.DeckError, match="has its own"):
        run(tmp_path, strip.format(material=card.replace("2.", "3."), step=card))


def test_damping_of_a_harmonic_step(tmp_path: Path) -> None:
    """A mass on a spring near its resonance: F / |k - m w^2 + i w alpha m|."""
    deck = SWING.format(cards="".join((*SPRING, *POINT)))
    begin = deck.index("*STEP")
    deck = (
        deck[:begin]
        + """*STEP
*STEADY STATE DYNAMICS, DIRECT
.6, .9, 4
*GLOBAL DAMPING, ALPHA=.4, FIELD=ALL
*CLOAD
2, 1, 5.
*END STEP
"""
    )
    results = run(tmp_path, deck)
    for number, frame in enumerate(results.frames):
        if frame.increment:
            w = 2.0 * math.pi * frame.time
            wanted = 5.0 / abs(50.0 - MASS * w * w + 1j * w * 0.4 * MASS)
            assert results.nodal("UA1", number)[1] == pytest.approx(wanted, rel=1e-6)

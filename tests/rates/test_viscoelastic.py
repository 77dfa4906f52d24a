"""Relaxation by Prony series: closed forms for any increment, bodies, motion, decks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.verification.plastic_models import CELL
from support.laws import RUBBER

E, NU = 1000.0, 0.3
G, K = E / 2.6, E / 1.2
TERMS = [(0.3, 0.1, 0.2), (0.2, 0.0, 5.0)]
EQUAL = [(0.3, 0.3, 0.2), (0.2, 0.2, 5.0)]
ELASTIC = ct.Elastic(E, NU)
LAWS: dict[str, ct.Viscoelastic] = {
    "elastic": ct.Viscoelastic(ELASTIC, TERMS),
    "long term": ct.Viscoelastic(ELASTIC, TERMS, "long term"),
    "shifted": ct.Viscoelastic(ELASTIC, TERMS, shift=ct.WLF(17.4, 51.6, 20.0), temperature=26.0),
    **{
        name: ct.Viscoelastic(law, EQUAL if isinstance(law, ct.Hyperfoam) else TERMS)
        for name, law in RUBBER.items()
    },
    "incompressible": ct.Viscoelastic(ct.NeoHooke(C10=0.5), [(0.4, 0.0, 0.3)]),
}
#: Increments to a time of 107.4, coarse and fine.
INCREMENTS = [[107.4], [0.1, 0.3, 7.0, 100.0], [2.0] * 53 + [1.4]]


def left(law: ct.Viscoelastic, t: float) -> tuple[float, float]:
    """Shares of the moduli by hand."""
    g = 1.0 - sum(a * (1.0 - np.exp(-t / tau)) for a, _, tau in law.terms)
    k = 1.0 - sum(a * (1.0 - np.exp(-t / tau)) for _, a, tau in law.terms)
    return g, k


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_the_derivative(name: str, plane: str) -> None:
    if name == "incompressible" and plane == "strain":
        with pytest.raises(ValueError, match="D = 0"):
            LAWS[name].respond([[0.0, 0.0, 0.0]], plane)
        return
    random = np.random.default_rng(3)
    for _ in range(20):
        size = 10.0 ** random.uniform(-9.0, -0.7)
        path = np.cumsum(size * random.uniform(-1.0, 1.0, (6, 3)), axis=0)
        times = np.cumsum(10.0 ** random.uniform(-6.0, 5.0) * random.uniform(0.1, 1.0, 6))
        found = LAWS[name].respond(path, plane, times)
        top = np.abs(found["derivative"]).max()
        assert np.abs(found["tangent"] - found["derivative"]).max() < 1e-12 * top


@pytest.mark.parametrize("steps", INCREMENTS, ids=["one", "four", "54"])
def test_relaxation_is_exact_for_any_increment(steps: list[float]) -> None:
    """A strain that comes at once and stays: the moduli at the time, to rounding."""
    times = np.r_[0.0, np.cumsum(steps)]
    path = np.full((len(times), 3), [1e-3, 0.0, 2e-3])
    for name in ("elastic", "long term"):
        law = LAWS[name]
        found = law.respond(path, "strain", times)
        g, k = left(law, times[-1])
        shear, bulk = G, K
        if name == "long term":
            shear, bulk = G / 0.5, K / 0.9
        wanted = [1e-3 * (k * bulk + 4 / 3 * g * shear), 1e-3 * (k * bulk - 2 / 3 * g * shear)]
        np.testing.assert_allclose(found["stress"][-1, :2], wanted, rtol=1e-12)
        assert found["stress"][-1, 2] == pytest.approx(2e-3 * g * shear, rel=1e-12)
        assert found["zz"][-1, 1] == pytest.approx(wanted[1], rel=1e-12)
    law = ct.Viscoelastic(ELASTIC, EQUAL)
    path = np.full((len(times), 3), [1e-3, -0.3e-3, 0.0])
    found = law.respond(path, "stress", times)
    np.testing.assert_allclose(
        found["stress"][-1], [1.0 * left(law, times[-1])[0], 0.0, 0.0], atol=1e-12
    )
    assert found["zz"][-1, 0] == pytest.approx(-0.3e-3, rel=1e-9)


@pytest.mark.parametrize("steps", INCREMENTS, ids=["one", "four", "54"])
def test_an_even_rate_is_exact(steps: list[float]) -> None:
    """Shear at a constant rate r: ``r G (g0 t + sum g tau (1 - exp(-t / tau)))``."""
    times, law = np.cumsum(steps), LAWS["elastic"]
    path = np.outer(times, [0.0, 0.0, 1e-4])
    found = law.respond(path, "strain", times)["stress"][-1, 2]
    t = times[-1]
    held = 0.5 * t + sum(g * tau * (1.0 - np.exp(-t / tau)) for g, _, tau in TERMS)
    assert found == pytest.approx(1e-4 * G * held, rel=1e-12)


def test_the_shift_divides_the_times() -> None:
    law = LAWS["shifted"]
    factor = 10.0 ** (-17.4 * 6.0 / (51.6 + 6.0))
    path = np.full((2, 3), [0.0, 0.0, 1e-3])
    found = law.respond(path, "strain", [0.0, 0.05])["stress"][-1, 2]
    assert found == pytest.approx(1e-3 * G * left(law, 0.05 / factor)[0], rel=1e-12)
    assert law.relaxation(0.05)[0] == pytest.approx(left(law, 0.05 / factor)[0], rel=1e-12)
    frozen = ct.Viscoelastic(ELASTIC, TERMS, shift=law.shift, temperature=-60.0)
    found = frozen.respond(path, "strain", [0.0, 1e9])["stress"][-1, 2]
    assert found == pytest.approx(1e-3 * G, rel=1e-12)


@pytest.mark.parametrize("stretch", [0.6, 2.0])
def test_rubber_relaxes_by_its_share(stretch: float) -> None:
    """Incompressible and uniaxial: the stress at once times what is left of the shear modulus."""
    law, e = LAWS["incompressible"], float(np.log(stretch))
    path = np.full((2, 3), [e, -0.5 * e, 0.0])
    found = law.respond(path, "stress", [0.0, 0.7])
    at_once = stretch**2 - 1.0 / stretch
    assert found["stress"][0, 0] == pytest.approx(at_once, rel=1e-12)
    assert found["stress"][1, 0] == pytest.approx(at_once * left(law, 0.7)[0], rel=1e-12)
    assert found["zz"][1, 0] == pytest.approx(-0.5 * e, rel=1e-12)


def test_energy_of_a_relaxing_point() -> None:
    """All work at once is stored; what is left after a long time is that of the lasting moduli."""
    law = LAWS["elastic"]
    path = np.full((3, 3), [0.0, 0.0, 1e-3])
    found = law.respond(path, "strain", [0.0, 1.0, 1e6])
    whole = 0.5 * G * 1e-6
    np.testing.assert_allclose(found["energy"][[0, 2]], [whole, 0.5 * whole], rtol=1e-12)
    np.testing.assert_allclose(found["CWORK"][[0, 2]], [0.0, 0.5 * whole], atol=1e-9 * whole)
    # In between by the closed form of two Maxwell bodies beside a spring.
    stored = 0.5 + sum(g * np.exp(-2.0 / tau) for g, _, tau in TERMS)
    assert found["energy"][1] == pytest.approx(whole * stored, rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_dissipation_grows_along_any_path(name: str) -> None:
    """In a cycle at an even pace, at moderate strain."""
    plane = "stress" if name == "incompressible" else "strain"
    t = np.linspace(0.0, 8.0, 401)
    path = np.outer(np.sin(3.0 * t), [0.02, -0.01, 0.03])
    lost = LAWS[name].respond(path, plane, t)["CWORK"]
    assert lost[-1] > 0.0
    assert np.diff(lost).min() > -1e-3 * lost[-1]


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q8R", "T6"])
@pytest.mark.parametrize("increments", [1, 5])
def test_relaxation_of_a_strip(element: str, increments: int) -> None:
    """Pulled at once by a static step, then held: ``E(t)`` to 1e-6, in one and five increments."""
    law = ct.Viscoelastic(ELASTIC, EQUAL)
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1, CELL[element]))
    model.section("all", element=element, material=law)
    model.fix("left", x=0.0, y=None)
    model.fix(model.mesh.nodes_of("left")[:1], x=None, y=0.0)
    model.fix("right", x=2e-3, y=None)
    hold = ct.Visco(nlgeom=False, period=3.0, increments=increments)
    results = ct.solve(model, [ct.Static(nlgeom=False), hold], fields=True)
    stress = results.frames[-1].fields[0].values["S"][..., 0]
    np.testing.assert_allclose(stress, 1.0 * left(law, 3.0)[0], rtol=1e-6)
    scalars = results.frames[-1].scalars
    assert abs(scalars["energy balance error"]) < 1e-9
    share = sum(g * (1.0 - np.exp(-6.0 / tau)) for g, _, tau in EQUAL)
    assert scalars["ALLCD"] == pytest.approx(0.5 * 1.0 * 1e-3 * 2.0 * share, rel=1e-6)


def test_a_ring_of_a_turned_part_relaxes() -> None:
    """Uniaxial along the axis of a solid of revolution, free to contract."""
    law = ct.Viscoelastic(ELASTIC, EQUAL)
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2, "quad4", origin=(1.0, 0.0)))
    model.section("all", element="Q4", material=law, plane="axisymmetric")
    model.fix("bottom", x=None, y=0.0)
    model.fix("top", x=None, y=1e-3)
    hold = ct.Visco(nlgeom=False, period=3.0)
    results = ct.solve(model, [ct.Static(nlgeom=False), hold], fields=True)
    stress = results.frames[-1].fields[0].values["S"]
    np.testing.assert_allclose(stress[..., 1], left(law, 3.0)[0], rtol=1e-6)
    np.testing.assert_allclose(stress[..., 2], 0.0, atol=1e-9)


@pytest.mark.parametrize("loaded_before", [True, False])
@pytest.mark.parametrize(("g", "period"), [(0.9, 10.0), (0.9, 100.0), (0.5, 1.0), (0.99, 30.0)])
def test_a_dead_load_stretches_in_default_increments(
    g: float, period: float, loaded_before: bool
) -> None:
    """The compliance of a spring beside a Maxwell element, and what is left without the load.

    ``J = (1 - g exp(-(1 - g) t / tau)) / (1 - g)``: the strain is not linear over an increment.
    """
    law = ct.Viscoelastic(ELASTIC, [(g, g, 1.0)])
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1, "quad4"))
    model.section("all", element="Q4", material=law)
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    off, rest = ct.Static(nlgeom=False), ct.Visco(nlgeom=False, period=period)
    pull = [ct.Static(nlgeom=False)] * loaded_before + [ct.Visco(nlgeom=False, period=period)]
    for step in pull:
        step.force("right", x=0.001 * ELASTIC.E)
    off.force("right", x=0.0)
    results = ct.solve(model, [*pull, off, rest], threads=1)
    stretch = results.history("U1", at="right")
    last = [k for k, f in enumerate(results.frames) if f.step == len(pull)][-1]
    crept = (1.0 - g * np.exp(-(1.0 - g) * period)) / (1.0 - g)
    assert stretch[last] == pytest.approx(0.001 * crept, rel=1.5e-2)
    left_over = (crept - 1.0) * np.exp(-(1.0 - g) * period)
    assert stretch[-1] == pytest.approx(0.001 * left_over, abs=1e-5 * crept)
    assert len(results.frames) < 120


def test_rubber_at_large_stretch_in_a_body() -> None:
    """A strip of rubber at twice its length relaxes by its share, without any change of shape."""
    law = LAWS["incompressible"]
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1, "quad8"))
    model.section("all", element="Q8R", material=law)
    model.fix("left", x=0.0, y=None)
    model.fix(model.mesh.nodes_of("left")[:1], x=None, y=0.0)
    model.fix("right", x=2.0, y=None)
    results = ct.solve(model, [ct.Static(increments=4), ct.Visco(period=0.7)], fields=True)
    stress = results.frames[-1].fields[0].values["S"][..., 0]
    np.testing.assert_allclose(stress, (4.0 - 0.5) * left(law, 0.7)[0], rtol=1e-6)


def test_free_vibration_beside_an_ordinary_equation() -> None:
    """One cell in uniaxial strain with its consistent mass, against Maxwell beside a spring."""
    law = ct.Viscoelastic(ELASTIC, [(0.4, 0.2, 0.05)], rho=1.0)
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1, "quad4"))
    model.section("all", element="Q4", material=law, plane="strain")
    model.fix("left", x=0.0, y=0.0)
    model.fix("right", x=None, y=0.0)
    model.velocity("right", x=0.1)
    n = 600
    step = ct.Dynamic(nlgeom=False, period=0.3, increments=n, scheme="newmark")
    results = ct.solve(model, step)
    node = model.mesh.nodes_of("right")[0]
    found = np.array([f.U[node, 0] for f in results.frames])
    whole, relaxes = K + 4 * G / 3, 0.2 * K + 0.4 * 4 * G / 3

    def rate(_: float, y: np.ndarray) -> list[float]:
        u, v, h = y
        return [v, -3.0 * ((whole - relaxes) * u + h), relaxes * v - h / 0.05]

    t = np.linspace(0.0, 0.3, n + 1)[-len(found) :]
    wanted = solve_ivp(rate, (0.0, 0.3), [0.0, 0.1, 0.0], t_eval=t, rtol=1e-10, atol=1e-14).y[0]
    size = np.abs(wanted).max()
    assert np.abs(found - wanted).max() < 5e-3 * size
    assert np.abs(wanted[-60:]).max() < 0.7 * size, "damping is part of the test"
    assert abs(results.frames[-1].scalars["energy balance error"]) < 1e-2


BAD: list[tuple[Any, str]] = [
    (lambda: ct.Viscoelastic(ELASTIC, []), "must be terms"),
    (lambda: ct.Viscoelastic(ELASTIC, [(0.6, 0.0, 1.0), (0.5, 0.0, 2.0)]), "below 1"),
    (lambda: ct.Viscoelastic(ELASTIC, [(0.6, 0.0, 0.0)]), "tau > 0"),
    (lambda: ct.Viscoelastic(ct.Mises(E, NU, yield_stress=1.0), EQUAL), "Mises does not"),
    (lambda: ct.Viscoelastic(ct.Hyperfoam(mu=0.5, alpha=4.0, nu=0.2), TERMS), "the same g and k"),
    (lambda: ct.Viscoelastic(ELASTIC, TERMS, temperature=20.0), "without a shift"),
    (lambda: ct.Viscoelastic(ct.Elastic(E, NU, expansion=1e-5), TERMS), "thermal strain"),
    (lambda: ct.WLF(0.0, 51.6), "C1 must be > 0"),
]


@pytest.mark.parametrize(("make", "text"), BAD, ids=[text for _, text in BAD])
def test_refuses(make: Any, text: str) -> None:
    with pytest.raises(ct.InputError, match=text):
        make()


DECK = """*NODE, NSET=all
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPE4, ELSET=body
1, 1, 2, 3, 4
*MATERIAL, NAME=polymer
{}*SOLID SECTION, ELSET=body, MATERIAL=polymer
1.
*BOUNDARY
all, 2, 2
1, 1
4, 1
{}*STEP
*STATIC
*BOUNDARY
2, 1, 1, 0.001
3, 1, 1, 0.001
*END STEP
*STEP
*VISCO
1., 3.
*END STEP
"""
PRONY = "*VISCOELASTIC, TIME=PRONY\n.3, .1, .2\n.2, 0., 5.\n"


def read(tmp_path: Path, cards: str, initial: str = "") -> ct.Model:
    path = tmp_path / "a.inp"
    path.write_text(DECK.format(cards, initial), encoding="utf-8")
    return ct.read(path)


@pytest.mark.parametrize("moduli", ["", ", MODULI=LONG TERM", ", MODULI=INSTANTANEOUS"])
def test_deck(moduli: str, tmp_path: Path) -> None:
    model = read(tmp_path, f"*ELASTIC{moduli}\n1000., .3\n{PRONY}")
    law = model.sections[0].material
    name = "elastic" if "INST" in moduli else "long term"
    assert law.parameters() == pytest.approx(LAWS[name].parameters())
    again = tmp_path / "b.inp"
    ct.write(model, again)
    assert ct.read(again).sections[0].material.parameters() == law.parameters()
    results = ct.solve(model, fields=True)
    shear, bulk = (G, K) if name == "elastic" else (G / 0.5, K / 0.9)
    g, k = left(LAWS["elastic"], 3.0)
    stress = results.frames[-1].fields[0].values["S"][..., 0]
    np.testing.assert_allclose(stress, 1e-3 * (k * bulk + 4 / 3 * g * shear), rtol=1e-6)


def test_deck_of_rubber_with_a_shift(tmp_path: Path) -> None:
    """The temperature of the shift is the one that the whole model has."""
    cards = "*HYPERELASTIC, NEO HOOKE\n.5, .02\n" + PRONY + "*TRS\n20., 17.4, 51.6\n"
    heated = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nall, 26.\n"
    law = read(tmp_path, cards, heated).sections[0].material
    wanted = ct.Viscoelastic(
        ct.NeoHooke(C10=0.5, D1=0.02), TERMS, "long term", ct.WLF(17.4, 51.6, 20.0), 26.0
    )
    assert law.parameters() == pytest.approx(wanted.parameters())
    assert law.parent.parameters()[0] == 0.5
    assert law.parameters()[2] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("cards", "text"),
    [
        ("*ELASTIC\n1000., .3\n*VISCOELASTIC, TIME=CREEP TEST DATA\n1., 1.\n", "TIME=PRONY"),
        ("*ELASTIC\n1000., .3\n" + PRONY + PRONY, "already has a"),
        ("*ELASTIC\n1000., .3\n*PLASTIC\n10.\n" + PRONY, "Mises does not"),
        ("*ELASTIC\n1000., .3\n*VISCOELASTIC, TIME=PRONY\n.3, .1\n", "tau"),
    ],
)
def test_decks_that_are_refused(cards: str, text: str, tmp_path: Path) -> None:
    with pytest.raises(ct.CorotaError, match=text):
        read(tmp_path, cards)


def test_initial_stress_through_the_thickness_is_refused() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section(element="Q4", material=LAWS["elastic"], plane="strain")
    model.initial_stress(xx=1.0)
    model.fix("all")
    with pytest.raises(ct.ModelError, match="would not relax"):
        ct.solve(model, ct.Visco(period=1.0))

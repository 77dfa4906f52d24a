"""Deformation plasticity (Ramberg-Osgood): the law, its energy, decks, and what refuses it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.errors import InputError
from corota.io.deck.write.model import write_deck
from support.calculix import curved_mesh

E, NU, Y, N, A = 200e3, 0.3, 300.0, 7.0, 0.43
LAW = ct.RambergOsgood(E, NU, Y, N, A)


def strains(seed: int, size: float, count: int = 40) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-size, size, (count, 3))


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("size", [1e-12, 1e-4, 2e-3, 0.05, 3.0])
def test_stress_gives_back_the_strain(size: float, plane: str) -> None:
    """``E e = (1 + nu) S - (1 - 2 nu) p I + 3/2 a (q/s0)^(n-1) S``, all components."""
    path = strains(1, size)
    answer = LAW.respond(path, plane)
    s, zz = answer["stress"], answer["zz"]
    stress = np.zeros((len(path), 3, 3))
    stress[:, 0, 0], stress[:, 1, 1], stress[:, 2, 2] = s[:, 0], s[:, 1], zz[:, 1]
    stress[:, 0, 1] = stress[:, 1, 0] = s[:, 2]
    p = -np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3.0
    deviator = stress + p * np.eye(3)
    q = np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))[:, None, None]
    elastic = (1 + NU) * deviator - (1 - 2 * NU) * p * np.eye(3)
    found = (elastic + 1.5 * A * (q / Y) ** (N - 1) * deviator) / E
    expected = np.zeros_like(found)
    expected[:, 0, 0], expected[:, 1, 1], expected[:, 2, 2] = path[:, 0], path[:, 1], zz[:, 0]
    expected[:, 0, 1] = expected[:, 1, 0] = 0.5 * path[:, 2]
    assert np.abs(found - expected).max() < 1e-12 * size
    if plane == "stress":
        assert (zz[:, 1] == 0.0).all()
    else:
        assert (zz[:, 0] == 0.0).all()


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_tangent_is_exact_and_stress_is_the_derivative_of_the_energy(plane: str) -> None:
    path = strains(2, 0.01)
    answer = LAW.respond(path, plane)
    assert np.abs(answer["tangent"] - answer["derivative"]).max() < 1e-10 * E
    h = 1e-6
    for i in range(3):
        step = h * np.eye(3)[i]
        up, down = (LAW.respond(path + sign * step, plane)["energy"] for sign in (1, -1))
        assert (up - down) / (2 * h) == pytest.approx(answer["stress"][:, i], abs=1e-6 * Y)


def test_nothing_at_zero_strain() -> None:
    answer = LAW.respond(np.zeros((1, 3)), "strain")
    assert not answer["stress"].any()
    elastic = ct.Mises(E=E, nu=NU, yield_stress=Y).respond(np.zeros((1, 3)), "strain")
    assert answer["tangent"] == pytest.approx(elastic["tangent"], rel=1e-13)


@pytest.mark.parametrize("exponent", [1.0, 3.0, 25.0])
def test_uniaxial_curve(exponent: float) -> None:
    law = ct.RambergOsgood(E, NU, Y, exponent, A)
    top = Y * 60.0 ** (1.0 / exponent)
    stress = top * np.array([0.01, 0.4, 0.8, 1.0, 0.9, 0.6, 0.0, -0.8])
    strain = (stress + A * Y * np.sign(stress) * (np.abs(stress) / Y) ** exponent) / E
    assert law.uniaxial(strain) == pytest.approx(stress, rel=1e-9, abs=1e-9)
    assert law.plot_uniaxial().get_lines()


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"exponent": 0.5}, "the exponent must be >= 1"),
        ({"exponent": float("nan")}, "the exponent must be a finite number"),
        ({"offset": 0.0}, "the offset must be > 0"),
        ({"yield_stress": -1.0}, "the yield stress must be > 0"),
        ({"nu": 0.5}, "Poisson's ratio"),
    ],
)
def test_wrong_numbers_are_refused(wrong: dict[str, float], message: str) -> None:
    given = {"E": E, "nu": NU, "yield_stress": Y, "exponent": N, "offset": A, **wrong}
    with pytest.raises(InputError, match=message):
        ct.RambergOsgood(**given)


def test_what_does_not_fit_is_refused() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2))
    with pytest.raises(InputError, match="Green-Lagrange"):
        model.section("all", element="Q4", material=LAW, local_strain="green_lagrange")
    with pytest.raises(InputError, match="hourglass of Q4R would stay elastic"):
        model.section("all", element="Q4R", material=LAW)


CELLS = {"T3": "tri3", "T6": "tri6", "OPT": "tri3", "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9"}


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize(
    "element", ["T3", "T6", "Q4", "Q4I", "Q4S", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI"]
)
def test_every_element_passes_the_patch_test(element: str, plane: str) -> None:
    """A linear field far beyond the yield stress gives the stress of the point."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 2, CELLS.get(element, "quad4"))
    gradient = np.array([[0.004, 0.001], [0.003, -0.002]])
    strain = [[gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]]]
    model = ct.Model(mesh)
    model.section("all", element=element, material=LAW, plane=plane)
    edge = np.unique(np.concatenate([mesh.nodes_of(s) for s in ("left", "right", "top", "bottom")]))
    turn = 0.5 * (gradient[1, 0] - gradient[0, 1])
    for node in edge:
        x, y = gradient @ mesh.points[node]
        drills = element in ("OPT", "Q4D", "Q4DI")
        model.fix([node], x=x, y=y, rotation=turn if drills else None)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    expected = LAW.respond(strain, plane)
    stress = np.concatenate([f.values["S"].reshape(-1, 4) for f in frame.fields])
    assert stress[:, [0, 1, 3]] == pytest.approx(
        np.broadcast_to(expected["stress"][0], (len(stress), 3)), rel=1e-8
    )
    assert stress[:, 2] == pytest.approx(np.full(len(stress), expected["zz"][0, 1]), rel=1e-8)


def beam(rho: float = 0.0) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 8, 1, "quad8"))
    law = ct.RambergOsgood(E, NU, Y, N, A, rho=rho)
    model.section("all", element="Q8R", material=law, local_strain="logarithmic")
    model.fix("left")
    return model


def test_unloading_goes_back_along_the_curve() -> None:
    model = beam()
    up, down = ct.Static(increments=5), ct.Static(increments=5)
    up.force("right", y=11.0)
    down.force("right", y=1e-12)
    frames = ct.solve(model, [up, down], threads=1).frames
    assert np.abs(frames[5].U).max() > 0.3  # elastic: 0.22
    assert np.abs(frames[-1].U).max() < 1e-9


def test_energy_momentum_keeps_the_energy() -> None:
    """A beam bent beyond the yield stress is let go: all energy is recoverable."""
    model = beam(1e-6)
    bend = ct.Static(increments=4)
    bend.force("right", y=9.0)
    swing = ct.Dynamic(period=0.003, increments=90, scheme="energy_momentum")
    swing.force("right", y=1e-12)
    results = ct.solve(model, [bend, swing], threads=1)
    moving = [i for i, f in enumerate(results.frames) if f.step == 2]
    assert max(results.history("MISES")) > Y
    total, kinetic = (np.array(results.history(n))[moving] for n in ("ETOTAL", "ALLKE"))
    assert np.ptp(total) < 1e-6 * kinetic.max()


def test_heat_in_plane_strain() -> None:
    """A held square that is heated: pressure alone, ``-E a T / (1 - 2 nu)``, without flow."""
    law = ct.RambergOsgood(E, NU, Y, N, A, expansion=1e-5)
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2))
    model.section("all", element="Q4I", material=law, plane="strain")
    for side in ("left", "right", "top", "bottom"):
        model.fix(side)
    model.temperature(400.0)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    stress = frame.fields[0].values["S"]
    expected = -E * 1e-5 * 400.0 / (1 - 2 * NU)
    assert stress[..., :3] == pytest.approx(np.full(stress[..., :3].shape, expected))


# -- decks ---------------------------------------------------------------------------------

MESH = (
    curved_mesh("CPE8")
    + """*MATERIAL, NAME=m
*DEFORMATION PLASTICITY
1000., 0.3, 0.002, 5., 0.6
*SOLID SECTION, ELSET=all, MATERIAL=m
0.7
"""
)
DECK = (
    MESH
    + """*BOUNDARY
left, 1, 1
1, 2, 2
*STEP, INC=1000
*STATIC
0.1, 1., 1e-6, 0.1
*CLOAD
right, 1, 0.35e-3
13, 2, -0.05e-3
*END STEP
"""
)
#: Displacements of all nodes by CalculiX 2.20, in units of 1e-6.
PLANE_STRAIN = [
    (0.0, 0.0),
    (0.5852369, -2.307001),
    (0.7878068, -6.042983),
    (1.009531, -10.77323),
    (2.748570, -17.79053),
    (0.0, -0.4000671),
    (3.390935, -6.296149),
    (5.843060, -18.27456),
    (0.0, -1.277725),
    (3.298245, -2.812410),
    (5.750345, -6.739314),
    (7.500857, -12.01613),
    (9.979749, -19.00606),
]
#: Stresses xx, yy, xy in plane stress under a uniform strain, by CalculiX 2.20.
PLANE_STRESS = (1.805650e-3, 1.011086e-4, 6.392009e-4)


def read(path: Path, text: str) -> Any:
    path.write_text(text, encoding="ascii")
    return ct.read(path)


def test_deck_beside_calculix(tmp_path: Path) -> None:
    """Curved-sided elements, power term six times the elastic strain.

    Strains are so small that the geometry, which CalculiX takes as nonlinear with this card, does
    not matter. Its inner iteration is loose: its displacements change by 1e-3 with its increments.
    """
    frame = ct.solve(read(tmp_path / "a.inp", DECK), threads=1).frames[-1]
    assert pytest.approx(np.array(PLANE_STRAIN), abs=3e-4 * 19.0) == 1e6 * frame.U


def test_plane_stress_beside_calculix() -> None:
    """Its stress gives the strain back to 2e-5, ours to rounding."""
    law = ct.RambergOsgood(1000.0, 0.3, 0.002, 5.0, 0.6)
    # u = 3e-6 x + 1e-6 y, v = 2e-6 x - 1e-6 y
    stress = law.respond([[3e-6, -1e-6, 3e-6]])["stress"][0]
    assert stress == pytest.approx(PLANE_STRESS, abs=1e-5 * PLANE_STRESS[0])


def test_deck_is_written_and_read(tmp_path: Path) -> None:
    model = read(tmp_path / "a.inp", DECK)
    again = ct.read(write_deck(model, tmp_path / "b.inp"))
    assert again.sections[0].material == model.sections[0].material
    assert isinstance(again.sections[0].material, ct.RambergOsgood)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("1000., 0.3, 0.002, 5.", "the offset is missing"),
        ("1000., 0.3, 0.002, 0.5, 0.6", "the exponent must be >= 1"),
        ("1000., 0.3, 0., 5., 0.6", "the yield stress must be > 0"),
        ("1000., 0.3, 2., 5., 0.6, 20.\n900., 0.3, 2., 5., 0.6, 20.", "20 is given twice"),
        ("1000., 0.3, 2., 5., 0.6\n*ELASTIC\n1000., 0.3", "already has constants"),
        ("1000., 0.3, 2., 5., 0.6\n*PLASTIC\n2., 0.", "needs isotropic constants in *ELASTIC"),
        ("", "a data line is missing: Young's modulus"),
    ],
)
def test_wrong_cards_are_refused(tmp_path: Path, data: str, message: str) -> None:
    text = DECK.replace("1000., 0.3, 0.002, 5., 0.6\n", data + "\n" * bool(data))
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path / "a.inp", text)
    assert message in str(caught.value)

"""Hill's yield function: closed forms, Mises as a special case, axes that turn, decks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota import _core

E, NU, SY = 200e3, 0.3, 200.0
SHEET = ct.Hill(E, NU, yield_stress=SY, isotropic=500.0, R22=1.2, R33=0.9, R12=0.8)
MOVING = ct.Hill(E, NU, yield_stress=SY, kinematic=2e3, R22=1.2, R33=0.9, R12=0.8)
RECALLED = ct.Hill(
    E, NU, yield_stress=SY, isotropic=500.0, chaboche=[(2e4, 100.0), (1e3, 0.0)], R22=1.2, R33=0.9
)


def yielding(law: ct.Hill, angle: float) -> tuple[float, float]:
    """Uniaxial yield stress at an angle from axis 1, and ratio of strains, from the function."""
    f, g, h = law._normal
    n = 1.5 / law.R12**2
    c, s = np.cos(angle), np.sin(angle)
    q = np.sqrt(f * s**4 + g * c**4 + h * (c**2 - s**2) ** 2 + 2.0 * n * (s * c) ** 2)
    # Plastic strain along the material axes for a unit stress, then across the strip.
    e11 = g * c**2 + h * (c**2 - s**2)
    e22 = f * s**2 - h * (c**2 - s**2)
    across = e11 * s**2 + e22 * c**2 - 2.0 * n * (s * c) ** 2
    return SY / q, across / -(e11 + e22)


def test_ratios_of_one_are_mises() -> None:
    random = np.random.default_rng(2)
    path = np.cumsum(2e-3 * random.uniform(-1.0, 1.0, (20, 3)), axis=0)
    curve = [(SY, 0.0), (250.0, 0.01)]
    back = {"kinematic": 2e3, "chaboche": [(2e4, 100.0)]}
    for plane, more in product(("stress", "strain"), ({}, back)):
        one = ct.Hill(E, NU, yield_curve=curve, **more).respond(path, plane)
        two = ct.Mises(E, NU, yield_curve=curve, **more).respond(path, plane)
        for name in ("stress", "tangent", "zz", "energy", "PEEQ", "PWORK", "PDISS", "YRATIO"):
            size = np.abs(two[name]).max()
            np.testing.assert_allclose(one[name], two[name], atol=1e-9 * size, err_msg=name)


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("law", [SHEET, MOVING, RECALLED], ids=["isotropic", "linear", "recall"])
def test_tangent_is_the_derivative(law: ct.Hill, plane: str) -> None:
    """With recall its symmetric part."""
    random = np.random.default_rng(4)
    for _ in range(20):
        size = 10.0 ** random.uniform(-6.0, -1.0)
        path = np.cumsum(size * random.uniform(-1.0, 1.0, (6, 3)), axis=0)
        found = law.respond(path, plane)
        exact = 0.5 * (found["derivative"] + np.swapaxes(found["derivative"], 1, 2))
        assert np.abs(found["tangent"] - exact).max() < 1e-10 * E


@pytest.mark.parametrize("angle", [0.0, 0.5 * np.pi, 0.3])
def test_back_stress_moves_the_surface(angle: float) -> None:
    """A bar cut at an angle: the slope is C times the square of the ratio of the yields, and it
    yields in reverse after twice the first yield stress.
    """
    turned = replace(MOVING)
    first, _ = yielding(MOVING, angle)
    ratio = first / SY
    stress = uniaxial(turned, np.array([0.02, 0.03]), angle)
    slope = (stress[1] - stress[0]) / 0.01
    # In the direction of the bar the plastic strain is the equivalent one over the ratio.
    modulus = MOVING.kinematic * ratio**2
    assert slope == pytest.approx(modulus * E / (E + modulus), rel=1e-6)
    top = stress[1]
    back = np.array([0.03, 0.03 - 1.999 * first / E, 0.03 - 2.001 * first / E - 1e-3])
    path = uniaxial(turned, np.concatenate([[0.02], back]), angle)
    assert path[1] - path[2] == pytest.approx(1.999 * first, rel=1e-9)
    assert top - path[3] < 2.05 * first


def uniaxial(law: ct.Hill, strain: np.ndarray, angle: float) -> np.ndarray:
    """Stress of a bar cut at an angle; the other two components of its stress are zero."""
    state, free, found = np.zeros(0), np.zeros(2), []
    for axial in strain:
        for _ in range(60):
            raw = _core.material_path(
                law.law, law.parameters(angle), "stress", np.array([[axial, *free]]), state
            )
            tangent = raw["tangent"].reshape(3, 3)
            step = np.linalg.solve(tangent[1:, 1:], raw["stress"][1:])
            if np.abs(raw["stress"][1:]).max() < 1e-11 * SY:
                break
            free = free - step
        state = raw["state"]
        found.append(raw["stress"][0])
    return np.array(found)


def strip(angle: float, element: str = "Q4", pull: float = 0.01) -> ct.Results:
    """A strip cut at an angle from the rolling direction, pulled without a constraint across."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1, "quad8" if "8" in element else "quad4"))
    model.section("all", element=element, material=SHEET, orientation=angle, local_strain="linear")
    # A uniform state: nodes move by its strains, those across and of shear found by the force.
    model.fix("left", x=0.0, y=None)
    model.fix("right", x=pull, y=None)
    model.fix(model.mesh.nodes_of("left")[:1], x=None, y=0.0)
    return ct.solve(model, ct.Static(nlgeom=False, increments=10))


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8R"])
@pytest.mark.parametrize("angle", [0.0, np.pi / 2])
def test_yield_along_the_axes(element: str, angle: float) -> None:
    """Stress and ratio of plastic strains along the axes of the sheet."""
    wanted, ratio = yielding(SHEET, -angle)
    found = strip(angle, element).frames[-1].fields[0].values
    grown = 1.0 + 500.0 * found["PEEQ"] / SY
    np.testing.assert_allclose(found["S"][..., 0], wanted * grown, rtol=1e-8)
    np.testing.assert_allclose(found["PE"][..., 1] / found["PE"][..., 2], ratio, rtol=1e-8)


@pytest.mark.parametrize("angle", [0.3, np.pi / 4, 1.2])
def test_yield_at_an_angle(angle: float) -> None:
    """At a point: the strains that leave a uniaxial stress, by Newton's method."""
    import corota._core as core

    law = ct.Hill(E, NU, yield_stress=SY, R22=1.2, R33=0.9, R12=0.8)
    strain, state = np.zeros(3), np.zeros(0)
    for axial in np.linspace(0.0, 0.05, 51)[1:]:
        strain[0] = axial
        for _ in range(30):
            raw = core.material_path("hill", law.parameters(angle), "stress", strain[None], state)
            tangent = raw["tangent"].reshape(3, 3)
            if np.abs(raw["stress"][1:]).max() < 1e-9:
                break
            strain[1:] -= np.linalg.solve(tangent[1:, 1:], raw["stress"][1:])
        state = raw["state"]
    wanted, ratio = yielding(law, angle)
    assert raw["stress"][0] == pytest.approx(wanted, rel=1e-9)
    elastic = np.array([1.0, -NU]) * raw["stress"][0] / E
    through = raw["zz"][0] + NU * raw["stress"][0] / E
    assert (strain[1] - elastic[1]) / through == pytest.approx(ratio, rel=1e-3)


def test_lankford_ratios() -> None:
    law = ct.Hill.from_lankford(1.8, 1.4, 2.2, E=E, nu=NU, yield_stress=SY)
    for angle, r in ((0.0, 1.8), (np.pi / 4, 1.4), (np.pi / 2, 2.2)):
        assert yielding(law, angle)[1] == pytest.approx(r, rel=1e-12)
    assert yielding(law, 0.0)[0] == pytest.approx(SY, rel=1e-12)


def test_shear_and_plane_strain() -> None:
    """Shear yields at ``R12 sy / sqrt 3``; the pressure does not yield."""
    law = ct.Hill(E, NU, yield_stress=SY, R22=1.2, R33=0.9, R12=0.8)
    for plane in ("stress", "strain"):
        stress = law.respond([[0.0, 0.0, 0.01]], plane)["stress"][0]
        assert stress[2] == pytest.approx(0.8 * SY / np.sqrt(3.0), rel=1e-9)
    found = law.respond([[0.01, 0.004, 0.003], [0.02, -0.004, 0.003]], "strain")
    f, g, h = law._normal
    for (xx, yy, xy), zz in zip(found["stress"], found["zz"][:, 1], strict=True):
        q2 = f * (yy - zz) ** 2 + g * (zz - xx) ** 2 + h * (xx - yy) ** 2 + 3.0 / 0.8**2 * xy**2
        assert np.sqrt(q2) == pytest.approx(SY, rel=1e-9)
        assert xx + yy + zz == pytest.approx(
            E / (1 - 2 * NU) * (0.014 if zz == found["zz"][0, 1] else 0.016), rel=1e-9
        )


def test_the_axes_turn_with_the_body() -> None:
    """A cell that is turned by 90 degrees, then pulled along its turned axis."""
    found = []
    turned = np.array([[0.0, -1.0], [1.0, 0.0]])
    for turn in (np.eye(2), turned):
        model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
        model.section("all", element="Q4", material=SHEET, plane="strain", orientation=0.4)
        first, second = ct.Static(), ct.Static(increments=5)
        for node, x in enumerate(model.mesh.points):
            moved, last = turn @ x - x, turn @ (x * np.array([1.02, 0.99])) - x
            first.fix([node], x=moved[0], y=moved[1])
            second.fix([node], x=last[0], y=last[1])
        stress = ct.solve(model, [first, second]).frames[-1].fields[0].values["S"]
        s = np.array([[stress[..., 0], stress[..., 3]], [stress[..., 3], stress[..., 1]]])
        found.append(np.einsum("ki,klep,lj->ijep", turn, s, turn))
    np.testing.assert_allclose(found[1], found[0], rtol=2e-3)


DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=sheet
1, 1, 2, 3, 4
*MATERIAL, NAME=steel
*ELASTIC
200000., .3
*PLASTIC{}
200., 0.
250., .1
*POTENTIAL
{}
*SOLID SECTION, ELSET=sheet, MATERIAL=steel
1.
"""


def test_deck(tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    path.write_text(DECK.format("", "1., 1.2, .9, .8, 1., 1."), encoding="utf-8")
    law = ct.read(path).sections[0].material
    curve = [(200.0, 0.0), (250.0, 0.1)]
    wanted = ct.Hill(E, NU, yield_curve=curve, R22=1.2, R33=0.9, R12=0.8)
    assert law.parameters() == wanted.parameters()
    again = tmp_path / "b.inp"
    ct.write(ct.read(path), again)
    assert ct.read(again).sections[0].material.parameters() == wanted.parameters()
    path.write_text(DECK.format(", HARDENING=KINEMATIC", "1., 1.2, .9, .8"), encoding="utf-8")
    moving = ct.read(path).sections[0].material
    assert isinstance(moving, ct.Hill)
    assert moving.back_stresses == [(pytest.approx(500.0), 0.0)]
    assert (moving.first_yield, moving.R22) == (200.0, 1.2)
    ct.write(ct.read(path), again)
    assert ct.read(again).sections[0].material.parameters() == moving.parameters()
    for options, row, text in (
        ("", "1., 1.2", "R33"),
        ("", "1., 9., .8, .8", "do not close"),
    ):
        path.write_text(DECK.format(options, row), encoding="utf-8")
        with pytest.raises(ct.CorotaError, match=text):
            ct.read(path)

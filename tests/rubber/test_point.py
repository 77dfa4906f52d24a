"""Hyperelastic laws at a point beside their energy in principal stretches, written again."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.model.hyperelastic import Hyperelastic
from support.laws import RUBBER, energy

POLYNOMIAL = {
    "C10": 0.5, "C01": 0.1, "C20": 0.02, "C11": 0.01, "C02": 0.03, "C30": 0.005, "C21": 0.001,
    "C12": 0.002, "C03": 0.003, "D1": 0.1, "D2": 0.5, "D3": 2.0,
}  # fmt: skip
LAWS: dict[str, Hyperelastic] = {
    **RUBBER,
    "stiff volume": ct.NeoHooke(C10=0.5, D1=2e-5),
    "three volumes": ct.Yeoh(C10=0.5, C20=-0.01, C30=0.004, D1=0.1, D2=0.3, D3=1.0),
    "all powers": ct.Polynomial(**POLYNOMIAL),
    "Ogden 6": ct.Ogden(
        mu=(0.5, 0.2, 0.1, 0.1, 0.05, 0.05), alpha=(1, 2, 3, -1, -2, 7), D=(0.1, 0.2, 0.3, 0, 0, 0)
    ),
    "term without sides": ct.Hyperfoam(mu=(0.5, 0.1), alpha=(8.0, -2.0), nu=(0.0, 0.3)),
}
PLANES = ["strain", "stress"]


def principal(law: Any, strain: np.ndarray) -> np.ndarray:
    """Kirchhoff stress of three principal logarithmic strains, by complex steps."""
    out = []
    for i in range(3):
        step = np.zeros(3, complex)
        step[i] = 1e-30j
        out.append(energy(law, np.exp(strain + step)).imag / 1e-30)
    return np.array(out)


def reference(law: Any, e: np.ndarray, plane: str) -> tuple[np.ndarray, float, float]:
    """Stress xx, yy, xy, strain and stress through the thickness."""
    values, axes = np.linalg.eigh([[e[0], e[2] / 2], [e[2] / 2, e[1]]])
    z = 0.0
    if plane == "stress":
        z = brentq(lambda z: principal(law, np.array([*values, z]))[2], -3.0, 3.0, xtol=1e-15)
    t = principal(law, np.array([*values, z]))
    tensor = axes @ np.diag(t[:2]) @ axes.T
    return tensor[[0, 1, 0], [0, 1, 1]], z, t[2]


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", LAWS)
def test_stress_is_that_of_the_energy(name: str, plane: str) -> None:
    law = LAWS[name]
    rng = np.random.default_rng(3)
    path = np.vstack([rng.uniform(-0.6, 0.6, (20, 3)), [[0.3, 0.3, 0.0], [0.5, -0.5, 1e-9]]])
    answer = law.respond(path, plane)
    for row, e in enumerate(path):
        stress, z, normal = reference(law, e, plane)
        scale = max(1.0, np.abs(stress).max())
        stiff = 1e5 if name == "stiff volume" else 1e2
        assert np.abs(answer["stress"][row] - stress).max() < 1e-13 * stiff * scale
        zz = (z, 0.0) if plane == "stress" else (0.0, normal)
        assert answer["zz"][row] == pytest.approx(zz, abs=1e-13 * stiff * scale)
        values = np.linalg.eigvalsh([[e[0], e[2] / 2], [e[2] / 2, e[1]]])
        assert answer["energy"][row] == pytest.approx(
            float(np.real(energy(law, np.exp([*values, z])))), rel=1e-10
        )


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_the_derivative(name: str, plane: str) -> None:
    path = np.random.default_rng(4).uniform(-1.0, 1.0, (40, 3))
    path[:5] *= 1e-9
    answer = LAWS[name].respond(path, plane)
    size = np.abs(answer["tangent"]).max(axis=(1, 2), keepdims=True)
    assert (np.abs(answer["tangent"] - answer["derivative"]) < 1e-10 * size).all()


@pytest.mark.parametrize(
    "law",
    [
        ct.NeoHooke(C10=0.5),
        ct.MooneyRivlin(C10=0.4, C01=0.1),
        ct.Ogden(mu=(1.2, 0.05), alpha=(1.3, -2.0)),
        ct.ArrudaBoyce(mu=1.0, limit=2.5),
    ],
    ids=lambda law: type(law).__name__,
)
def test_constant_volume_is_the_limit_of_a_stiff_one(law: Any) -> None:
    """In plane stress; the error falls with the compressibility."""
    path = np.random.default_rng(5).uniform(-0.5, 0.5, (10, 3))
    exact = law.respond(path)
    assert exact["zz"][:, 0] == pytest.approx(-path[:, 0] - path[:, 1], abs=1e-15)
    assert np.abs(exact["tangent"] - exact["derivative"]).max() < 1e-12 * exact["tangent"].max()
    close = law.with_ratio(0.4999995).respond(path)
    assert np.abs(exact["stress"] - close["stress"]).max() < 2e-5


def test_closed_forms_of_neo_hooke() -> None:
    stretch = np.array([0.5, 0.8, 1.0, 1.5, 3.0])
    law = ct.NeoHooke(C10=0.35)
    near = pytest.approx
    assert law.nominal("uniaxial", stretch) == near(0.7 * (stretch - stretch**-2), abs=1e-14)
    assert law.nominal("biaxial", stretch) == near(0.7 * (stretch - stretch**-5.0), abs=1e-13)
    assert law.nominal("planar", stretch) == near(0.7 * (stretch - stretch**-3.0), abs=1e-14)


def test_closed_form_of_foam() -> None:
    """Poisson's ratio zero: the sides do not move, and each direction is by itself."""
    stretch = np.array([0.3, 0.7, 1.4])
    law = ct.Hyperfoam(mu=0.2, alpha=6.0, nu=0.0)
    expected = 2 * 0.2 / 6.0 * (stretch**6 - 1.0) / stretch
    for test in ("uniaxial", "biaxial", "planar"):
        assert law.nominal(test, stretch) == pytest.approx(expected, abs=1e-13)


def test_small_strain_moduli() -> None:
    law = ct.ArrudaBoyce(mu=2.0, limit=5.0, D=0.01)
    powers = 3 / 5 / 25 + 99 / 175 / 5**4 + 513 / 875 / 5**6 + 42039 / 67375 / 5**8
    assert law.shear_modulus == pytest.approx(2.0 * (1 + powers), rel=1e-12)
    assert law.bulk_modulus == pytest.approx(200.0, rel=1e-10)
    foam = ct.Hyperfoam(mu=0.6, alpha=4.0, nu=0.25)
    assert foam.shear_modulus == pytest.approx(0.6)
    assert foam.bulk_modulus == pytest.approx(0.6 * 2 * 1.25 / (3 * 0.5))


def test_refuses() -> None:
    with pytest.raises(ct.InputError, match="shear modulus -1 must be > 0"):
        ct.NeoHooke(C10=-0.5, D1=0.1)
    with pytest.raises(ct.InputError, match="bulk modulus"):
        ct.NeoHooke(C10=0.5, D1=-0.1)
    with pytest.raises(ct.InputError, match="not finite"):
        ct.NeoHooke(C10=float("nan"))
    with pytest.raises(ct.InputError, match="as many numbers as terms"):
        ct.Ogden(mu=(1.0, 2.0), alpha=2.0)
    with pytest.raises(ct.InputError, match="alpha must not be zero"):
        ct.Ogden(mu=1.0, alpha=0.0)
    with pytest.raises(ct.InputError, match="limit stretch > 0"):
        ct.ArrudaBoyce(mu=1.0, limit=-1.0)
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    with pytest.raises(ct.InputError, match=r"D1 = 2 / K, e.g. 0\.002 for a bulk modulus"):
        model.section("all", element="Q4S", material=ct.NeoHooke(C10=0.5), plane="strain")
    with pytest.raises(ct.InputError, match="is for local_strain='logarithmic', not 'linear'"):
        model.section("all", element="Q4S", material=ct.NeoHooke(C10=0.5), local_strain="linear")

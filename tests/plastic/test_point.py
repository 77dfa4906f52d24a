"""The material contract of J2 plasticity at one point."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import corota as ct
from support.solid import Solid

HARDENING = {
    "perfect": {"yield_stress": 250.0},
    "linear": {"yield_stress": 250.0, "isotropic": 2000.0},
    "table": {"yield_curve": [(250.0, 0.0), (300.0, 0.001), (330.0, 0.004), (340.0, 0.02)]},
    "voce": {"yield_stress": 250.0, "isotropic": ct.Voce(120.0, 300.0, 500.0)},
    "kinematic": {"yield_stress": 250.0, "kinematic": 4000.0},
    "combined": {"yield_stress": 250.0, "isotropic": 1000.0, "kinematic": 3000.0},
    "voce and kinematic": {
        "yield_stress": 250.0,
        "isotropic": ct.Voce(120.0, 300.0),
        "kinematic": 3000.0,
    },
    "chaboche": {"yield_stress": 250.0, "chaboche": [(60000.0, 400.0), (9000.0, 0.0)]},
    "chaboche and voce": {
        "yield_stress": 250.0,
        "isotropic": ct.Voce(50.0, 30.0),
        "chaboche": [(60000.0, 400.0), (20000.0, 90.0), (3000.0, 3.0)],
    },
}


def material(name: str) -> ct.Mises:
    return ct.Mises(E=200000.0, nu=0.3, **HARDENING[name])


def random_path(seed: int, steps: int = 60, size: float = 0.004) -> np.ndarray:
    """Corners of random strain, joined by a few steps each."""
    corners = np.random.default_rng(seed).uniform(-size, size, (steps // 6 + 1, 3))
    corners[0] = 0.0
    share = np.linspace(1 / 6, 1, 6)
    return np.array([a + (b - a) * t for a, b in pairwise(corners) for t in share])


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", HARDENING)
def test_tangent_is_the_derivative(name: str, plane: str) -> None:
    """Exact with forward differentiation; with recall it is the derivative's symmetric part."""
    answer = material(name).respond(random_path(1), plane)
    exact = answer["derivative"]
    size = np.abs(exact).max()
    symmetric = 0.5 * (exact + exact.transpose(0, 2, 1))
    assert np.abs(answer["tangent"] - symmetric).max() < 1e-10 * size
    skew = np.abs(exact - symmetric).max() / size
    if "chaboche" in name:
        assert skew > 1e-4
    else:
        assert skew < 1e-10
    assert answer["PEEQ"][-1] > 0.01
    assert (np.diff(answer["PEEQ"]) > 0.0).sum() > 20


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", HARDENING)
def test_state_stays_on_the_yield_surface_and_dissipates(name: str, plane: str) -> None:
    for seed in range(5):
        answer = material(name).respond(random_path(seed), plane)
        assert answer["YRATIO"].max() < 1.0 + 1e-11
        flowing = np.diff(answer["PEEQ"], prepend=0.0) > 0
        assert np.abs(answer["YRATIO"][flowing] - 1.0).max() < 1e-11
        assert np.diff(answer["PDISS"], prepend=0.0).min() > -1e-12 * answer["PDISS"].max()
        assert (np.abs(answer["zz"][:, 1]).max() == 0.0) == (plane == "stress")


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", ["perfect", "linear", "kinematic", "combined", "chaboche"])
def test_agrees_with_a_return_map_in_three_dimensions(name: str, plane: str) -> None:
    data = HARDENING[name]
    back = [(data["kinematic"], 0.0)] if "kinematic" in data else data.get("chaboche", [])
    solid = Solid(200000.0, 0.3, 250.0, data.get("isotropic", 0.0), tuple(back))
    path = random_path(7, steps=24)
    answer = material(name).respond(path, plane)
    for e, stress, zz in zip(path, answer["stress"], answer["zz"], strict=True):
        if plane == "stress":
            reference = solid.plane_stress(e)
        else:
            full = solid.stress(
                np.array([[e[0], e[2] / 2, 0], [e[2] / 2, e[1], 0], [0, 0, 0.0]]), commit=True
            )
            reference = np.array([full[0, 0], full[1, 1], full[0, 1]])
            assert abs(zz[1] - full[2, 2]) < 1e-10 * 250
        assert np.abs(stress - reference).max() < 1e-10 * 250
    assert answer["PEEQ"][-1] == pytest.approx(solid.p, rel=1e-10)


#: Strain path of the driver: corners xx, yy, xy.
CORNERS = np.array(
    [[0, 0, 0], [0.002, 0, 0], [0.002, 0, 0.004], [-0.001, 0.001, 0.004], [0, 0, 0]], float
)

#: Slopes, steps a leg, stresses at the ends of the legs, equivalent plastic strain at the end.
DRIVER = [
    (0, 0, 1, [285.82736553, 107.88458294, 0, 140.51464109, 67.60372233, 126.07495805,
               -221.30548352, 17.81124702, 55.57252262, -48.47285812, -85.94196336,
               -137.75608100], 0.0046242745),
    (0, 0, 10, [286.28932238, 111.06946958, 0, 101.41677310, 59.12178257, 135.04961233,
                -244.42431686, -3.68975125, 34.85686919, -40.67305446, -95.80332931,
                -136.09315286], 0.0051813098),
    (2000, 0, 1, [287.57413124, 108.30232157, 0, 143.49049990, 68.73017566, 128.31452269,
                  -226.07646719, 19.85017169, 58.36948099, -52.84794154, -88.22109271,
                  -142.78699166], 0.0044970443),
    (0, 2000, 10, [288.02093657, 111.41606717, 0, 105.09932830, 60.40575352, 136.59390988,
                   -242.92273730, -1.55343847, 37.22502734, -39.75832350, -94.38193166,
                   -134.96504069], 0.0051316365),
    (1000, 3000, 1, [289.28065986, 108.70732062, 0, 146.86356591, 69.85299802, 129.59412450,
                     -221.92455237, 21.40887066, 60.22894178, -49.23814653, -85.25918299,
                     -138.50281860], 0.0044956073),
]  # fmt: skip


def driver_path(steps: int) -> np.ndarray:
    legs = pairwise(CORNERS)
    return np.array([a + (b - a) * t / steps for a, b in legs for t in range(1, steps + 1)])


@pytest.mark.parametrize(("K", "H", "steps", "ends", "alpha"), DRIVER)
def test_driver_table(K: float, H: float, steps: int, ends: list[float], alpha: float) -> None:
    """Values computed independently, to eight digits after the point."""
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=250.0, isotropic=K, kinematic=H)
    answer = law.respond(driver_path(steps))
    stress = answer["stress"][steps - 1 :: steps]
    assert np.abs(stress.ravel() - ends).max() < 6e-9
    assert abs(answer["PEEQ"][-1] - alpha) < 6e-11


def test_one_step_with_shear() -> None:
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=250.0)
    stress = law.respond([[0.002, -0.0005, 0.003]])["stress"][0]
    assert np.abs(stress - [198.35207792, 34.88541981, 98.07999487]).max() < 6e-9


def test_huge_steps_converge() -> None:
    """A thousand times the yield strain in one step, for every law."""
    for name in HARDENING:
        for plane in ("stress", "strain"):
            path = np.array([[1.0, -0.3, 0.4], [-1.2, 0.5, 0.7]])
            assert np.abs(material(name).respond(path, plane)["YRATIO"] - 1).max() < 1e-9


def test_uniaxial_slopes_and_reverse_yield() -> None:
    """Slope E (K + H) / (E + K + H); reverse yield two yield stresses below the top
    (kinematic), or at the top's opposite (isotropic)."""
    E, sy = 200000.0, 250.0
    for K, H in [(3000.0, 0.0), (0.0, 3000.0), (1000.0, 2000.0)]:
        law = ct.Mises(E=E, nu=0.3, yield_stress=sy, isotropic=K, kinematic=H)
        top = law.uniaxial([0.002, 0.004])
        slope = E * (K + H) / (E + K + H)
        assert (top[1] - top[0]) / 0.002 == pytest.approx(slope, rel=1e-9)
        reach = top[1] - sy - (top[1] - sy) * K / (K + H)  # back-stress
        reverse = reach - (sy + (top[1] - sy) * K / (K + H))
        elastic = 0.004 - (top[1] - reverse) / E
        below = law.uniaxial([0.004, elastic + 1e-9, elastic - 1e-3])
        assert below[1] == pytest.approx(reverse, abs=1e-3)
        assert (below[1] - below[2]) / 1e-3 == pytest.approx(slope, rel=1e-3)


def test_armstrong_frederick_saturates() -> None:
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=250.0, chaboche=[(60000.0, 400.0)])
    assert law.uniaxial(np.linspace(0, 0.2, 400))[-1] == pytest.approx(250 + 150, rel=1e-9)


def test_yield_in_simple_states() -> None:
    """Shear at sy/sqrt 3, equal tension at sy, tension with held width at 2 sy/sqrt 3."""
    law = ct.Mises(E=200000.0, nu=0.3, yield_stress=250.0)
    path = np.linspace(0, 1, 50)[:, None]
    assert law.respond(path * [0, 0, 0.1])["stress"][-1, 2] == pytest.approx(250 / 3**0.5)
    assert law.respond(path * [0.1, 0.1, 0])["stress"][-1, 0] == pytest.approx(250)
    assert law.respond(path * [0.1, 0, 0])["stress"][-1, 0] == pytest.approx(500 / 3**0.5)


BAD = [
    ({"yield_stress": 0.0}, "yield stress must be > 0"),
    ({"yield_stress": -1.0}, "yield stress must be > 0"),
    ({}, "either yield_curve or yield_stress"),
    ({"yield_stress": 1.0, "yield_curve": [(1.0, 0.0)]}, "either yield_curve or yield_stress"),
    ({"yield_curve": []}, "no points"),
    ({"yield_curve": [(1.0, 0.1)]}, "must start at plastic strain 0"),
    ({"yield_curve": [(1.0, 0.0), (2.0, 0.0)]}, "must grow from row to row"),
    ({"yield_curve": [(1.0, 0.0), (0.9, 0.1)]}, "may not fall"),
    ({"yield_curve": [(1.0, 0.0), (1.1, -0.1)]}, "plastic strain must be >= 0"),
    ({"yield_curve": [(1.0, 0.0), (-1.1, 0.1)]}, "yield stress must be > 0"),
    ({"yield_curve": [(1.0, 0.0)], "isotropic": 1.0}, "leave out isotropic"),
    ({"yield_stress": 1.0, "isotropic": -1.0}, "isotropic slope must be >= 0"),
    ({"yield_stress": 1.0, "kinematic": -1.0}, "kinematic modulus must be >= 0"),
    ({"yield_stress": 1.0, "chaboche": [(0.0, 1.0)]}, "C of back-stress 1"),
    ({"yield_stress": 1.0, "chaboche": [(1.0, -1.0)]}, "gamma of back-stress 1"),
    ({"yield_stress": 1.0, "chaboche": [(1.0, 1.0)] * 7}, "at most 6 back-stresses"),
    ({"yield_stress": 1.0, "nu": 0.5}, "Poisson's ratio 0.5"),
    ({"yield_stress": 1.0, "E": 0.0}, "Young's modulus"),
]


@pytest.mark.parametrize(("data", "reason"), BAD)
def test_refuses(data: dict, reason: str) -> None:
    with pytest.raises(ct.InputError, match=reason):
        ct.Mises(**{"E": 1000.0, "nu": 0.3, **data})


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", HARDENING)
def test_a_repeated_strain_is_elastic(name: str, plane: str) -> None:
    """On the yield surface rounding must not choose between the tangents."""
    twice = np.repeat(random_path(3), 2, axis=0)
    answer = material(name).respond(twice, plane)
    elastic = material(name).respond(np.zeros((1, 3)), plane)["tangent"][0]
    assert np.abs(answer["tangent"][1::2] - elastic).max() < 1e-12 * np.abs(elastic).max()
    np.testing.assert_allclose(answer["PEEQ"][1::2], answer["PEEQ"][::2], rtol=1e-12)
    assert answer["PEEQ"][-1] > 0.005

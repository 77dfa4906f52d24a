"""Rates and creep at a point: closed forms, tangents, energy, in one increment and in many."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import corota as ct

E, NU = 200e3, 0.3
CURVE = [(250.0, 0.0), (300.0, 0.05), (330.0, 0.2)]
STEEL = ct.JohnsonCook(
    E=E,
    nu=NU,
    A=350.0,
    B=275.0,
    n=0.36,
    C=0.022,
    rate=1.0,
    m=1.03,
    melting=1500.0,
    transition=20.0,
    rho=7.85e-9,
    heat_fraction=0.9,
    specific_heat=4.5e8,
)
LAWS: dict[str, Any] = {
    "power": ct.Mises(E, NU, yield_curve=CURVE, rate=ct.CowperSymonds(40.0, 5.0)),
    "power, kinematic": ct.Mises(
        E, NU, yield_stress=250.0, kinematic=2000.0, rate=ct.CowperSymonds(40.0, 5.0)
    ),
    "ratio": ct.Mises(
        E, NU, yield_curve=CURVE, rate=ct.YieldRatio([(1.0, 0.0), (1.2, 1.0), (1.5, 100.0)])
    ),
    "curves": ct.Mises(
        E,
        NU,
        yield_curve=CURVE,
        rate=ct.RateCurves([(1.0, [(280.0, 0.0), (360.0, 0.2)]), (100.0, [(400.0, 0.0)])]),
    ),
    "Johnson-Cook": STEEL,
    "creep": ct.Mises(E, NU, rate=ct.Norton(1e-14, 5.0)),
    "creep by time": ct.Mises(E, NU, rate=ct.Norton(1e-14, 5.0, -0.4)),
    "creep by strain": ct.Mises(E, NU, rate=ct.Norton(1e-14, 5.0, -0.4, "strain")),
    "creep over yield": ct.Mises(E, NU, yield_curve=CURVE, rate=ct.Norton(1e-8, 3.0)),
}


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_the_derivative(name: str, plane: str) -> None:
    """By dual numbers, at increments from nothing to 1e6, strains from nothing to a tenth."""
    random = np.random.default_rng(5)
    for _ in range(25):
        size = 10.0 ** random.uniform(-12.0, -1.0)
        path = np.cumsum(size * random.uniform(-1.0, 1.0, (6, 3)), axis=0)
        times = np.cumsum(10.0 ** random.uniform(-7.0, 6.0) * random.uniform(0.1, 1.0, 6))
        found = LAWS[name].respond(path, plane, times)
        assert np.isfinite(found["stress"]).all()
        error = np.abs(found["tangent"] - found["derivative"]).max()
        assert error < 1e-11 * E, (size, times[0], error)


@pytest.mark.parametrize("increments", [1, 40])
@pytest.mark.parametrize("rate", [1e-3, 1.0, 1e3])
def test_rising_yield_of_a_bar(rate: float, increments: int) -> None:
    """Perfectly plastic with a power of the rate: after the start the stress stays, at
    ``s0 (1 + (rate / D)^(1 / n))``; one increment solves the implicit equation."""
    law = ct.Mises(E, NU, yield_stress=250.0, rate=ct.CowperSymonds(40.0, 5.0))
    strain = np.linspace(0.0, 0.05, increments + 1)[1:]
    found = law.uniaxial(strain, strain / rate)[-1]
    if increments > 1:
        wanted = 250.0 * (1.0 + (rate / 40.0) ** 0.2)
    else:
        time = 0.05 / rate

        def rest(s: float) -> float:
            return s - 250.0 * (1.0 + ((0.05 - s / E) / time / 40.0) ** 0.2)

        wanted = brentq(rest, 250.0, 250.0 * 20, xtol=1e-13, rtol=1e-14)
    assert found == pytest.approx(wanted, rel=1e-9)


def test_hardening_with_a_rate_follows_its_ordinary_equation() -> None:
    """Table with a power of the rate under a strain that grows evenly, by an explicit solver."""
    law = LAWS["power"]
    points = np.array(CURVE)

    def grow(_: float, p: np.ndarray) -> np.ndarray:
        over = E * (10.0 * _ - p[0]) / np.interp(p[0], points[:, 1], points[:, 0]) - 1.0
        return np.array([40.0 * max(over, 0.0) ** 5.0])

    end = solve_ivp(grow, (0.0, 0.01), [0.0], rtol=1e-10, atol=1e-14, method="LSODA").y[0, -1]
    errors = []
    for n in (50, 100):
        strain = np.linspace(0.0, 0.1, n + 1)[1:]
        errors.append(abs(law.uniaxial(strain, strain / 10.0)[-1] / (E * (0.1 - end)) - 1.0))
    assert errors[1] < 1e-4
    assert errors[1] < 0.6 * errors[0] or errors[1] < 1e-9


def test_tables_by_rate_are_straight_between_rates() -> None:
    ratio, curves = LAWS["ratio"], LAWS["curves"]
    for rate, factor in ((0.5, 1.1), (1.0, 1.2), (50.5, 1.35), (1e4, 1.5)):
        strain = np.linspace(0.0, 0.4, 81)[1:]
        found = ratio.uniaxial(strain, strain / rate)[-1]
        assert found == pytest.approx(330.0 * factor, rel=1e-4)
    # At plastic strain 0.2 and above: 330, 360, 400 at the rates 0, 1, 100.
    for rate, wanted in ((0.5, 345.0), (1.0, 360.0), (50.5, 380.0), (1e4, 400.0)):
        strain = np.linspace(0.0, 0.4, 81)[1:]
        found = curves.uniaxial(strain, strain / rate)[-1]
        assert found == pytest.approx(wanted, rel=1e-4)


def test_lower_rates_than_the_first_ones_are_as_without_a_rate() -> None:
    strain = np.linspace(0.0, 0.1, 11)[1:]
    plain = ct.Mises(E, NU, yield_curve=CURVE)
    for law in (LAWS["power"], LAWS["ratio"], LAWS["curves"]):
        found = law.uniaxial(strain, strain * 1e30)
        np.testing.assert_allclose(found, plain.uniaxial(strain), rtol=1e-5)


@pytest.mark.parametrize("rate", [0.1, 1.0, 1e3])
def test_johnson_cook_curve(rate: float) -> None:
    """Isothermal: (A + B p^n)(1 + C ln max(rate, 1))(1 - T*^m) at 20 and 900 degrees."""
    strain = np.array([0.002, 0.01, 0.05, 0.2, 0.5])
    for temperature in (20.0, 900.0):
        law = ct.JohnsonCook(
            E=E, nu=NU, A=350.0, B=275.0, n=0.36, C=0.022, rate=1.0, m=1.03, melting=1500.0,
            transition=20.0, temperature=temperature,
        )  # fmt: skip
        left = 1.0 - ((temperature - 20.0) / 1480.0) ** 1.03
        path = np.concatenate(
            [np.linspace(a, b, 40)[1:] for a, b in zip([0.0, *strain[:-1]], strain, strict=True)]
        )
        stress = law.uniaxial(path, path / rate)[38::39]
        p = strain - stress / E
        wanted = (350.0 + 275.0 * p**0.36) * (1.0 + 0.022 * np.log(max(rate, 1.0))) * left
        # The rate of the plastic strain is that of the strain but for its elastic part.
        np.testing.assert_allclose(stress[1:], wanted[1:], rtol=5e-4)


def test_adiabatic_johnson_cook_by_an_explicit_solver() -> None:
    """Plastic work heats: the temperature by its ordinary equation at a constant plastic rate."""
    law, rate = STEEL, 1e3
    share = 0.9 / (7.85e-9 * 4.5e8)

    def stress(p: float, t: float) -> float:
        cold = (350.0 + 275.0 * p**0.36) * (1.0 + 0.022 * np.log(rate))
        return float(cold * (1.0 - (max(t - 20.0, 0.0) / 1480.0) ** 1.03))

    path = solve_ivp(
        lambda p, t: [share * stress(p, t[0])], (0.0, 1.0), [20.0], rtol=1e-10, dense_output=True
    )
    for n, most in ((50, 4e-3), (200, 1e-3)):
        strain = np.linspace(0.0, 0.8, n + 1)[1:]
        found = law.uniaxial(strain, strain / rate)
        p = strain - found / E
        wanted = np.array([stress(q, path.sol(q)[0]) for q in p])
        assert np.abs(found[n // 4 :] / wanted[n // 4 :] - 1.0).max() < most
    cold = (350.0 + 275.0 * p[-1] ** 0.36) * (1.0 + 0.022 * np.log(rate))
    assert wanted[-1] < 0.95 * cold


@pytest.mark.parametrize("hardening", ["time", "strain"])
@pytest.mark.parametrize("m", [-0.5, 0.0, 0.8])
@pytest.mark.parametrize("increments", [1, 7])
def test_creep_at_constant_stress_is_exact(hardening: Any, m: float, increments: int) -> None:
    """``A s^n t^(m + 1) / (m + 1)``: the strain that keeps a stress, in one increment and more."""
    law = ct.Mises(E, NU, rate=ct.Norton(1e-14, 5.0, m, hardening))
    times = np.linspace(0.0, 50.0, increments + 1)[1:]
    strain = 100.0 / E + 1e-14 * 100.0**5 * times ** (m + 1.0) / (m + 1.0)
    # The stress comes in an instant before.
    path, at = np.r_[100.0 / E, strain], np.r_[1e-9, times]
    found = law.uniaxial(path, at)
    np.testing.assert_allclose(found[1:], 100.0, rtol=1e-7 if m >= 0.0 else 1e-3)


def test_relaxation_by_norton_converges_to_the_closed_form() -> None:
    """``s^(1 - n) = s0^(1 - n) + (n - 1) E A t`` at a constant strain of a bar."""
    law = ct.Mises(E, NU, rate=ct.Norton(1e-16, 5.0))
    errors = []
    for n in (20, 40):
        times = np.r_[1e-12, np.linspace(0.0, 20.0, n + 1)[1:]]
        found = law.uniaxial(np.full(n + 1, 1e-3), times)[-1]
        wanted = (200.0**-4 + 4.0 * E * 1e-16 * 20.0) ** -0.25
        errors.append(abs(found / wanted - 1.0))
    assert wanted < 190.0
    assert errors[1] < 1e-2
    assert errors[1] < 0.6 * errors[0]


def test_without_lasting_time_nothing_creeps() -> None:
    strain = np.array([1e-3, 2e-3])
    found = LAWS["creep"].uniaxial(strain, [1e6, 2e6], lasting=False)
    np.testing.assert_allclose(found, E * strain, rtol=1e-12)
    plain = ct.Mises(E, NU, yield_curve=CURVE).uniaxial(strain)
    found = LAWS["creep over yield"].uniaxial(strain, [1e6, 2e6], lasting=False)
    np.testing.assert_allclose(found, plain, rtol=1e-9)


@pytest.mark.parametrize("name", LAWS)
def test_energy_of_a_path_is_its_work(name: str) -> None:
    """Stored energy and work of flow against the integral of the stress, of second order."""
    errors = []
    for n in (100, 200):
        t = np.linspace(0.0, 1.0, n + 1)
        path = np.stack([0.01 * t, -0.003 * t, 0.004 * np.sin(3.0 * t)], axis=1)
        found = LAWS[name].respond(path[1:], "strain", t[1:])
        stress = np.r_[np.zeros((1, 3)), found["stress"]]
        mean = 0.5 * (stress[1:] + stress[:-1])
        work = float(np.sum(mean * np.diff(path, axis=0)))
        inside = found["energy"][-1] + found["PWORK"][-1] + found["CWORK"][-1]
        errors.append(abs(inside / work - 1.0))
    assert errors[1] < 2e-3, errors
    assert errors[1] < 0.6 * errors[0] or errors[1] < 1e-6, errors


def test_melting_leaves_a_thousandth() -> None:
    """One increment from the virgin state through melting, and back: a stress and a tangent."""
    hot = replace(STEEL, heat_fraction=1.0, specific_heat=4.5e6)
    for plane in ("stress", "strain"):
        for strain in (0.1, 0.5):
            path = np.array([[strain, -strain, 0.3], [-strain, strain, 0.1]])
            found = hot.respond(path, plane, [1e-3, 2e-3])
            assert np.abs(found["tangent"] - found["derivative"]).max() < 1e-9 * E


def test_units_do_not_matter() -> None:
    """The same body in other units of stress and time."""
    path = np.cumsum(np.full((5, 3), [2e-3, -5e-4, 1e-3]), axis=0)
    times = np.arange(1.0, 6.0)
    base = LAWS["creep over yield"].respond(path, "stress", times)["stress"]
    scaled = ct.Mises(
        E * 1e6,
        NU,
        yield_curve=[(s * 1e6, p) for s, p in CURVE],
        rate=ct.Norton(1e-8 / 1e18 / 60.0, 3.0),
    )
    other = scaled.respond(path, "stress", times * 60.0)["stress"]
    np.testing.assert_allclose(other, base * 1e6, rtol=1e-9)


BAD: list[tuple[Any, str]] = [
    (lambda: ct.CowperSymonds(0.0, 5.0), "rate D"),
    (lambda: ct.Norton(1e-9, 5.0, -1.0), "exponent m"),
    (lambda: ct.YieldRatio([(1.0, 0.0), (0.9, 1.0)]), "ratios may not fall"),
    (lambda: ct.YieldRatio([(1.0, 1.0)]), "at the rate 0"),
    (lambda: ct.RateCurves([(0.0, CURVE)]), "must rise"),
    (lambda: ct.Mises(E, NU, rate=ct.CowperSymonds(1.0, 1.0)), "yield_curve or yield_stress"),
    (
        lambda: ct.Mises(E, NU, yield_curve=CURVE, rate=ct.RateCurves([(1.0, [(200.0, 0.0)])])),
        "falls with the rate",
    ),
    (lambda: ct.JohnsonCook(E, NU, A=0.0), "yield stress A"),
    (lambda: ct.JohnsonCook(E, NU, A=1.0, melting=10.0, transition=20.0), "above the transition"),
    (lambda: ct.JohnsonCook(E, NU, A=1.0, melting=10.0, heat_fraction=0.9), "specific heat"),
    (lambda: ct.Visco(creep_tolerance=-1.0), "creep_tolerance"),
    (lambda: ct.Visco(path=ct.ArcLength()), "follows its time"),
]


@pytest.mark.parametrize(("make", "text"), BAD, ids=[text for _, text in BAD])
def test_refuses(make: Any, text: str) -> None:
    with pytest.raises(ct.InputError, match=text):
        make()

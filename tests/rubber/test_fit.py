"""Fits of hyperelastic laws to tests, and the range in which a law is stable."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

import corota as ct
from support.laws import RUBBER

STRAIN = {
    "uniaxial": np.linspace(-0.3, 2.0, 12),
    "biaxial": np.linspace(0.05, 0.8, 8),
    "planar": np.linspace(0.1, 1.5, 8),
}
#: Tension of vulcanized rubber at 20 C by Treloar (1944): nominal strain, stress [MPa].
TRELOAR = np.array(
    [
        [0.13, 0.14], [0.20, 0.23], [0.25, 0.29], [0.43, 0.42], [0.63, 0.52], [0.92, 0.60],
        [1.17, 0.69], [1.45, 0.78], [2.07, 0.98], [2.64, 1.19], [3.10, 1.38], [3.83, 1.77],
        [4.47, 2.19], [4.82, 2.46],
    ]
)[:, ::-1]  # fmt: skip


def answers_of(law: Any) -> dict[str, np.ndarray]:
    """What a law answers in all three tests: rows of stress and strain."""
    return {
        test: np.column_stack([law.nominal(test, 1.0 + strain), strain])
        for test, strain in STRAIN.items()
    }


def sheets() -> list[tuple[Any, dict[str, Any]]]:
    """Laws at constant volume, and what their fit is told; a foam has one Poisson's ratio."""
    found: list[tuple[Any, dict[str, Any]]] = [
        (ct.Ogden(mu=(0.6,), alpha=(2.4,)), {"terms": 1}),
        (ct.Hyperfoam(mu=(0.3,), alpha=(5.0,), nu=0.2), {"terms": 1, "nu": 0.2}),
    ]
    for law in RUBBER.values():
        stiff = {f.name: 0.0 for f in fields(law) if f.name in ("D", "D1", "D2", "D3")}
        if not isinstance(law, ct.Hyperfoam):
            options = {"terms": 2} if isinstance(law, ct.Polynomial) else {}
            found.append((replace(law, **stiff), options))
    return found


@pytest.mark.parametrize(
    ("law", "options"),
    sheets(),
    ids=lambda value: type(value).__name__ if not isinstance(value, dict) else "",
)
def test_a_fit_finds_the_law_that_made_the_data(law: Any, options: dict[str, Any]) -> None:
    data = answers_of(law)
    found = type(law).fit(**data, **options)
    for test, rows in data.items():
        assert found.nominal(test, 1.0 + rows[:, 1]) == pytest.approx(rows[:, 0], rel=1e-4)


def test_measured_rubber() -> None:
    """Three terms of Ogden are within a few percent of Treloar's tension, one modulus is not."""
    errors = []
    for law in (ct.Ogden.fit(uniaxial=TRELOAR, terms=3), ct.NeoHooke.fit(uniaxial=TRELOAR)):
        ratio = law.nominal("uniaxial", 1.0 + TRELOAR[:, 1]) / TRELOAR[:, 0]
        errors.append(float(np.sqrt(np.mean((ratio - 1.0) ** 2))))
    assert errors[0] < 0.08
    assert errors[1] > 2.0 * errors[0]


def test_stability_ends_where_the_law_softens() -> None:
    """Yeoh with a negative second constant: the biaxial tangent vanishes at a stretch."""
    law = ct.Yeoh(C10=0.5, C20=-0.05)
    low, high = law.stability()["uniaxial"]
    assert low < 1.0 < high < 10.0
    axial = np.log(np.array([high, high * 1.02]))
    path = np.column_stack([axial, -0.5 * axial, 0.0 * axial])
    lowest = np.linalg.eigvalsh(law.respond(path)["tangent"][:, :2, :2])[:, 0]
    assert lowest[0] > 0.0 > lowest[1]
    assert ct.NeoHooke(C10=0.5).stability()["biaxial"] == pytest.approx((0.1, 10.0))


def test_an_unstable_fit_is_named() -> None:
    strain = np.linspace(0.1, 1.5, 10)
    stress = strain * (1.0 - 0.35 * strain)
    with pytest.warns(UserWarning, match=r"MooneyRivlin|Yeoh is unstable in the uniaxial test"):
        ct.Yeoh.fit(uniaxial=np.column_stack([stress, strain]))


def test_refuses() -> None:
    with pytest.raises(ct.InputError, match="a fit needs test data"):
        ct.NeoHooke.fit()
    with pytest.raises(ct.InputError, match="rows of nominal stress and nominal strain"):
        ct.NeoHooke.fit(uniaxial=[1.0, 2.0])
    with pytest.raises(ct.InputError, match="-1 or less"):
        ct.NeoHooke.fit(uniaxial=[(1.0, -1.0)])
    with pytest.raises(ct.InputError, match="1 to 3 terms"):
        ct.Polynomial.fit(uniaxial=[(1.0, 1.0)], terms=4)


def test_plot() -> None:
    axes = ct.NeoHooke(C10=0.5).plot_tests(uniaxial=TRELOAR)
    assert axes.get_xlabel() == "stretch"

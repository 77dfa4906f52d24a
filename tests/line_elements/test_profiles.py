"""Cross-sections: areas, second and plastic moments against their closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

P = ct.profiles
PI = np.pi


@pytest.mark.parametrize("layers", [1, 3, 10])
@pytest.mark.parametrize(
    ("make", "area", "inertia", "plastic"),
    [
        (lambda n: P.rectangle(2.0, 5.0, layers=n), 10.0, 2 * 125 / 12, 2 * 25 / 4),
        (lambda n: P.circle(4.0, layers=n), 4 * PI, 4 * PI, 64 / 6),
        (lambda n: P.circle(4.0, width=2.0, layers=n), 2 * PI, 2 * PI, 64 / 12),
        (
            lambda n: P.pipe(3.0, 1.0, layers=n),
            5 * PI,
            PI * (81 - 16) / 4,
            4 * (27 - 8) / 3,
        ),
        (
            lambda n: P.box(4.0, 6.0, 0.5, layers=n),
            24 - 15,
            (4 * 216 - 3 * 125) / 12,
            (4 * 36 - 3 * 25) / 4,
        ),
        (
            lambda n: P.i_section(10.0, 6.0, 1.0, 0.5, layers=n),
            16.0,
            (6 * 1000 - 5.5 * 512) / 12,
            6 * 1 * 9 + 0.5 * 64 / 4,
        ),
        # A T: the plastic axis, which halves the area, lies in the flange.
        (
            lambda n: P.of_rectangles([(1.0, 0.0, 4.0), (8.0, 4.0, 5.0)], layers=n),
            12.0,
            64 / 12 + 4 * (3.6667 - 2) ** 2 + 8 / 12 + 8 * (4.5 - 3.6667) ** 2,
            4 * 2.25 + 8 * (0.25**2 + 0.75**2) / 2,
        ),
    ],
)
def test_areas_second_and_plastic_moments_are_exact(
    make: object, area: float, inertia: float, plastic: float, layers: int
) -> None:
    profile = make(layers)  # type: ignore[operator]
    y, part, _ = profile.fibers.T
    assert profile.area == pytest.approx(area, rel=1e-12)
    assert part.sum() == pytest.approx(area, rel=1e-12)
    assert part @ y == pytest.approx(0.0, abs=1e-11 * area)
    assert profile.inertia == pytest.approx(inertia, rel=1e-8)
    assert part @ y**2 == pytest.approx(profile.inertia, rel=1e-11)
    assert profile.plastic_modulus == pytest.approx(plastic, rel=1e-9)


def test_shape_factors() -> None:
    """Rectangle 3/2, circle 16/(3 pi), thin tube 4/pi."""
    assert P.rectangle(3.0, 7.0).shape_factor == pytest.approx(1.5, rel=1e-12)
    assert P.circle(3.0).shape_factor == pytest.approx(16 / (3 * PI), rel=1e-12)
    assert P.pipe(100.0, 0.1).shape_factor == pytest.approx(4 / PI, rel=1e-3)


@pytest.mark.parametrize(
    "make",
    [
        lambda: P.rectangle(0.0, 1.0),
        lambda: P.circle(-1.0),
        lambda: P.pipe(1.0, 2.0),
        lambda: P.box(1.0, 1.0, 0.5),
        lambda: P.i_section(1.0, 1.0, 0.5, 0.1),
        lambda: P.rectangle(1.0, 1.0, layers=0),
        lambda: P.of_fibers([(0.0, 1.0)]),
        lambda: P.of_fibers([(0.0, 1.0), (1.0, -1.0)]),
        lambda: P.of_rectangles([(1.0, 2.0, 1.0)]),
        lambda: P.rectangle(1.0, 1.0).with_stress(lambda y: y * np.nan),
    ],
)
def test_sizes_are_checked(make: object) -> None:
    with pytest.raises(ct.InputError):
        make()  # type: ignore[operator]


def test_a_list_of_fibers_lies_about_its_centroid() -> None:
    profile = P.of_fibers([(4.0, 1.0), (0.0, 3.0)], shear_area=2.0)
    assert profile.fibers[:, 0].tolist() == [-1.0, 3.0]
    assert (profile.area, profile.inertia, profile.shear_area) == (4.0, 12.0, 2.0)

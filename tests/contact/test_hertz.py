"""A roller on a block against Hertz's line contact (Konter's data)."""

# SPDX-License-Identifier: BSD-3-Clause
import pytest

from corota.verification.problems.konter_roller import ellipse, hertz, roller


@pytest.mark.parametrize(
    ("element", "plane", "nlgeom"),
    [
        ("Q8R", "strain", False),
        ("Q8R", "stress", False),
        ("Q4D", "strain", True),
    ],
)
def test_peak_pressure_and_half_width(element, plane, nlgeom):
    load = 35e3
    results = roller(20, element, plane, load, nlgeom)
    assert ellipse(results) == pytest.approx(hertz(load, plane), rel=0.02)
    frame = results.frames[-1]
    assert frame.scalars["roller: force y"] == pytest.approx(0.5 * load, rel=1e-9)
    assert frame.scalars["iterations"] <= 16
    assert results.info.get("cut-backs", 0) == 0


def test_the_reference_values():
    assert hertz(35e3, "strain") == pytest.approx((6.214627867, 3585.362231), rel=1e-9)

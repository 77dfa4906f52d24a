"""A sample of the table of scheme orders in docs/dynamics.md."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

from benchmarks.studies import scheme_orders

SAMPLE = [
    ("free, Q4D", "generalized_alpha"),
    ("rigid end", "hht"),
    ("moving support", "newmark"),
    ("damped per stiffness", "energy_momentum"),
    ("point mass", "central_difference"),
    ("rigid end, all damping", "generalized_alpha"),
]


@pytest.mark.parametrize(("case", "scheme"), SAMPLE)
def test_schemes_have_their_theoretical_order(case: str, scheme: str) -> None:
    """Two, by theory; a scheme of first order would show 1.0 in displacements."""
    found = scheme_orders.order(case, scheme)
    assert found is not None
    assert found[0] >= scheme_orders.THEORY - 0.15
    assert found[1] >= 1.5


def test_the_page_has_every_case() -> None:
    text = scheme_orders.PAGE.read_text(encoding="utf-8")
    table = text.split("<!-- orders: begin -->")[1].split("<!-- orders: end -->")[0]
    assert all(f"| {case} |" in table for case in scheme_orders.CASES)

"""Linear procedures about the state of a linear step: right while it is small, named where not."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import pytest

import corota as ct


def steps(kind):
    return {
        "frequency": lambda: ct.Frequency(modes=1),
        "complex": lambda: ct.Frequency(modes=1, complex_modes=True),
        "buckle": lambda: ct.Buckle(modes=1),
    }[kind]()


def bent(kind, share, nlgeom=False):
    """A cantilever whose tip was bent by a share of its length."""
    model = ct.Model(ct.mesh.rectangle(10.0, 0.5, nx=20, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.fix("left")
    load = 3.0 * 1e4 * 0.5**3 / 12.0 / 10.0**3 * 10.0 * share
    before = ct.Static(increments=5 if nlgeom else 1, nlgeom=nlgeom)
    before.force("right", y=load)
    after = steps(kind)
    if kind == "buckle":
        after.force("right", x=-1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.solve(model, [before, after], threads=1)


@pytest.mark.parametrize("kind", ["frequency", "complex", "buckle"])
@pytest.mark.parametrize(
    ("share", "nlgeom", "named"), [(1e-4, False, False), (0.1, False, True), (0.1, True, False)]
)
def test_a_linear_state_with_large_displacements_is_named(kind, share, nlgeom, named):
    """Turned by linear displacements a slender part stretches, which stiffens it for nothing."""
    results = bent(kind, share, nlgeom)
    assert any("linear step" in note and "NLGEOM" in note for note in results.notes) == named


def test_a_small_linear_state_gives_the_frequency_of_the_nonlinear_one():
    """The two differ by the square of deflection over thickness."""
    small, large = (bent("frequency", 1e-4, on).modes[0].factors[0] for on in (False, True))
    assert small == pytest.approx(large, rel=5e-5)

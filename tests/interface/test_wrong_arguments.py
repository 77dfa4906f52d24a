"""Arguments that make no sense are refused by name, with a typed error."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import pytest

import corota as ct
from corota.errors import InputError


def strip():
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.01)
    return model


@pytest.mark.parametrize("step", [ct.Static, ct.Dynamic])
@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.inf, math.nan, 2.0, "fine"])
def test_tolerances_lie_between_zero_and_one(step, tolerance):
    with pytest.raises(InputError, match="tolerance must be > 0 and <= 1"):
        step(tolerance=tolerance)


@pytest.mark.parametrize("name", ["increments", "max_increments", "max_iterations"])
@pytest.mark.parametrize("value", [-1, 2.5, "many"])
def test_counts_are_whole_numbers(name, value):
    with pytest.raises(InputError, match=f"{name} must be a whole number"):
        ct.Static(**{name: value})


def test_a_path_is_no_word():
    with pytest.raises(InputError, match="path must be an ArcLength"):
        ct.Static(path="riks")


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"keep": "some"}, "keep must be 'all' or 'last'"),
        ({"observers": [3]}, "3 has no method start"),
        ({"threads": -3}, "threads must be a whole number"),
        ({"threads": 1.5}, "threads must be a whole number"),
        ({"solver": 3}, "needs a method analyze"),
    ],
)
def test_solve_names_the_argument(arguments, reason):
    with pytest.raises(InputError, match=reason):
        ct.solve(strip(), ct.Static(), **arguments)


def test_a_surface_is_not_tied_to_itself():
    with pytest.raises(InputError, match="cannot be tied to itself"):
        strip().tie("right", "right")


@pytest.mark.usefixtures("quick_pictures")
def test_dollar_signs_in_names_are_drawn(tmp_path):
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2)
    model = ct.Model(mesh, name="cost $\\frac{")
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.01)
    model.contact("right", ct.RigidCurve.line((3.0, -1.0), (3.0, 2.0)), name="$_x^")
    results = ct.solve(model, ct.Static())
    model.plot(path=tmp_path / "model.png")
    results.plot("MISES", path=tmp_path / "mises.png")


@pytest.mark.parametrize("curve", [240.0, [240.0, 300.0], [("high", 0.0)]])
def test_a_yield_curve_is_rows_of_two_numbers(curve):
    with pytest.raises(InputError, match="yield_curve is rows of"):
        ct.Mises(210e3, 0.3, curve)

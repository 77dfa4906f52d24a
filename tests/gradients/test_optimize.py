"""Optimization with gradients: a closed form, records, restart, failures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota import gradients

if TYPE_CHECKING:
    from pathlib import Path


def cantilever(x: np.ndarray) -> ct.Model:
    """Beam of one section whose height is given at both ends."""
    mesh = ct.mesh.rectangle(10.0, 1.0, nx=6, ny=1)
    along = mesh.points[:, 0] / 10.0
    mesh.points[:, 1] = (mesh.points[:, 1] - 0.5) * (x[0] + (x[1] - x[0]) * along)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0, rho=1.0))
    model.fix("left")
    model.force("right", y=-1.0)
    return model


SAG = gradients.Constraint(gradients.Displacement("right", "y"), lower=-0.05)
BOUNDS = [(0.2, 3.0), (0.2, 3.0)]


def lightest(**options: object) -> gradients.Optimum:
    return ct.optimize(
        cantilever, [1.5, 1.5], gradients.Mass(), [SAG], bounds=BOUNDS, threads=1, **options
    )


METHODS = ["SLSQP", "trust-constr", "MMA"]


def require(method: str) -> None:
    if method == "MMA":
        pytest.importorskip("mmapy", reason="mmapy is not installed (requirements-optimize.txt)")


@pytest.mark.parametrize("method", METHODS)
def test_the_lightest_cantilever_is_tapered(method: str) -> None:
    """Lighter than the uniform one of the same sag, with the sag at its bound."""
    require(method)
    found = lightest(method=method)
    uniform = 10.0 * (4.0 * 10.0**3 / (1e5 * 0.05)) ** (1.0 / 3.0)
    assert found.constraints[0] == pytest.approx(-0.05, rel=1e-3)
    assert found.value < 0.95 * uniform
    assert found.x[1] < found.x[0]


def test_both_methods_find_the_same_design() -> None:
    one = lightest()
    two = ct.optimize(cantilever, [2.5, 0.9], gradients.Mass(), [SAG], bounds=BOUNDS, threads=1)
    np.testing.assert_allclose(one.x, two.x, rtol=1e-3)
    assert one.value == pytest.approx(two.value, rel=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_a_run_that_was_stopped_continues_to_the_bit(tmp_path: Path, method: str) -> None:
    require(method)
    whole = lightest(method=method, most=12)
    record = tmp_path / "designs.jsonl"

    def stop(number: int, design: gradients.Design) -> None:
        if number == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        lightest(record=record, progress=stop, method=method, most=12)
    with record.open("a") as file:
        file.write('{"x": [1.0')  # as a process that was killed leaves it
    again = lightest(record=record, method=method, most=12)
    assert again.runs == len(whole.history) - 4
    assert [d.x for d in again.history] == [d.x for d in whole.history]
    assert again.x.tobytes() == whole.x.tobytes()


@pytest.mark.parametrize("method", ["SLSQP", "MMA"])
def test_designs_that_fail_are_left(method: str) -> None:
    """The analysis of thin beams fails: the optimum next to them is found all the same."""
    require(method)

    def build(x: np.ndarray) -> ct.Model:
        if x[1] < 0.55:
            raise ct.ModelError("too thin")
        return cantilever(x)

    found = ct.optimize(
        build,
        [1.5, 1.5],
        gradients.Mass(),
        [SAG],
        bounds=[(0.2, 3.0), (0.6, 3.0)],
        method=method,
        threads=1,
    )
    assert found.constraints[0] == pytest.approx(-0.05, rel=1e-4)
    with pytest.raises(ct.ModelError, match="too thin"):
        ct.optimize(build, [1.5, 0.5], gradients.Mass(), [SAG], threads=1)


def test_senseless_input_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="no bound"):
        gradients.Constraint(gradients.Mass())
    with pytest.raises(ct.InputError, match="above the upper"):
        gradients.Constraint(gradients.Mass(), 2.0, 1.0)
    with pytest.raises(ct.InputError, match="bounds for 2"):
        ct.optimize(cantilever, [1.0, 1.0], gradients.Mass(), bounds=[(0.1, 2.0)])
    with pytest.raises(ct.InputError, match="shape"):
        ct.optimize(cantilever, 1.0, gradients.Mass())  # type: ignore[arg-type]
    other = tmp_path / "other.jsonl"
    other.write_text("a line of another kind\n")
    with pytest.raises(ct.FileError, match="not a design"):
        lightest(record=other)


def test_moving_asymptotes_find_the_design_of_the_others() -> None:
    require("MMA")
    one, two = lightest(), lightest(method="MMA")
    assert two.success
    np.testing.assert_allclose(two.x, one.x, rtol=2e-3)
    assert two.value == pytest.approx(one.value, rel=1e-5)
    free = ct.optimize(
        cantilever,
        [1.5, 1.5],
        gradients.Displacement("right", "y") ** 2,
        bounds=BOUNDS,
        method="MMA",
        threads=1,
    )
    np.testing.assert_allclose(free.x, [3.0, 3.0], rtol=1e-5)  # the stiffest there is


def test_what_moving_asymptotes_refuse() -> None:
    with pytest.raises(ct.InputError, match="finite bounds"):
        ct.optimize(cantilever, [1.5, 1.5], gradients.Mass(), method="MMA")
    require("MMA")
    even = gradients.Constraint(gradients.Displacement("right", "y"), -0.05, -0.05)
    with pytest.raises(ct.InputError, match="no equations"):
        ct.optimize(cantilever, [1.5, 1.5], gradients.Mass(), [even], bounds=BOUNDS, method="MMA")


def test_where_no_design_keeps_the_constraints_the_nearest_counts() -> None:
    """Also where the last analysis failed, which has no values."""
    model_of = ct.shape(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    model_of.control("top", 1)

    def build(x: np.ndarray) -> ct.Model:
        model = ct.Model(model_of.mesh(x))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        model.fix("left")
        model.force("right", y=-0.5)
        return model

    limit = gradients.Constraint(gradients.Mass(), upper=2.0)
    tip = gradients.Displacement("right", "y")
    found = ct.optimize(build, [0.0], tip, [limit], bounds=[(-1.5, 0.5)], most=4, threads=1)
    assert any(design.error for design in found.history)
    assert found.constraints[0] == min(d.values[1] for d in found.history if not d.error)

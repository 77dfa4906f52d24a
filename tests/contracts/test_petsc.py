"""The solver ``petsc``: refusals that name the node, and the results of the default solver."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import corota as ct
from corota.analysis.linear.solvers import SOLVERS, make_solver
from corota.cli import main
from corota.cli import parser as arguments
from corota.errors import SingularError, UnsupportedError

#: Newton's method stops at a relative residual of 1e-9; the last correction is far below that.
AGREE = 1e-9
needs_petsc = pytest.mark.skipif(
    find_spec("petsc4py") is None, reason="scripts/install_petsc.sh installs PETSc"
)


def cantilever(element: str = "Q4I") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    model.section("all", element=element, material=ct.Elastic(E=1.2e3, nu=0.3, rho=1e-3))
    model.fix("left")
    return model


def bent() -> tuple[ct.Model, ct.Static]:
    model = cantilever("Q4D")
    model.force("right", y=-0.4)
    return model, ct.Static(increments=5)


def plastic() -> tuple[ct.Model, ct.Static]:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=8, ny=4))
    steel = ct.Mises(E=2.1e5, nu=0.3, yield_stress=240.0, isotropic=800.0)
    model.section("all", element="Q4I", material=steel, local_strain="logarithmic")
    model.fix("left")
    model.fix("right", x=None, y=0.05)
    return model, ct.Static(increments=5)


def moving() -> tuple[ct.Model, ct.Dynamic]:
    model = cantilever()
    model.force("right", y=-0.2)
    return model, ct.Dynamic(period=0.5, increments=25)


def pressed() -> tuple[ct.Model, ct.Static]:
    """A block that only contact holds in y, on another one with a mesh that does not match."""
    lower = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    upper = ct.mesh.move(ct.mesh.rectangle(2.0, 1.0, nx=5, ny=2), (1.0, 1.0))
    model = ct.Model(ct.mesh.assembly(lower=lower, upper=upper))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("lower.bottom")
    model.fix("upper.top", x=0.0, y=None)
    model.contact("upper.bottom", "lower.top")
    model.force("upper.top", y=-20.0)
    return model, ct.Static(increments=2)


@needs_petsc
@pytest.mark.parametrize("build", [bent, plastic, moving, pressed])
def test_results_are_those_of_the_default_solver(build: object) -> None:
    model, step = build()  # type: ignore[operator]
    ours = ct.solve(model, step, threads=1)
    theirs = ct.solve(model, step, threads=1, solver="petsc")
    assert len(ours.frames) == len(theirs.frames)
    for name in ("U", "UR"):
        size = np.abs(getattr(ours.frames[-1], name)).max()
        for a, b in zip(ours.frames, theirs.frames, strict=True):
            error = np.abs(getattr(a, name) - getattr(b, name)).max()
            assert error <= AGREE * max(size, 1e-6), name


@needs_petsc
def test_negative_pivots_are_those_of_the_default_solver() -> None:
    """A column above its buckling load: ``stable`` follows from the inertia."""
    model = ct.Model(ct.mesh.rectangle(10.0, 0.2, nx=40, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0))
    model.fix("left")
    model.force("right", x=-60.0)
    counts = []
    for solver in ("multifrontal", "petsc"):
        with pytest.warns(UserWarning, match="a bifurcation"):
            results = ct.solve(model, ct.Static(increments=4), threads=1, solver=solver)
        counts.append([f.scalars["negative pivots"] for f in results.frames if f.increment])
    assert counts[0] == counts[1]
    assert max(counts[0]) > 0.0


@needs_petsc
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e9])
def test_a_body_that_turns_freely_is_refused_and_the_node_named(size: float) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0 * size, size, nx=8, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix([0])
    model.force("right", y=-1.0 * size)
    with pytest.raises(SingularError, match=r"node \d+"):
        ct.solve(model, ct.Static(), threads=1, solver="petsc")


@needs_petsc
def test_soft_is_not_singular() -> None:
    """Springs of 1 and 1e-10 in a row: a condition of 1e12, and an exact answer."""
    upper = sp.csc_array(np.array([[1.0 + 1e-10, -1e-10], [0.0, 1e-10]]))
    upper.sort_indices()
    solver = make_solver("petsc")
    solver.analyze(upper.indptr, upper.indices, np.arange(2))
    assert solver.factorize(upper.data) == (2, 0, 0)
    np.testing.assert_allclose(solver.solve(np.array([0.0, 1.0])), [1.0, 1e10 + 1.0], rtol=1e-5)


@needs_petsc
def test_the_command_line_takes_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = cantilever()
    model.force("right", y=-1.0)
    model.steps.append(ct.Static(increments=2))
    ct.write(model, tmp_path / "job.inp")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "job.inp", "-q", "--solver", "petsc"]) == 0
    found = ct.read_results("job.vtkhdf").frames[-1].U
    expected = ct.solve(model, threads=1).frames[-1].U
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=AGREE * np.abs(expected).max())


def test_the_command_line_knows_all_solvers() -> None:
    assert set(arguments.SOLVERS) == set(SOLVERS)


def test_a_run_that_is_started_many_times_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "2")
    assert main(["run", str(tmp_path / "job.inp")]) == 2
    assert "this solver runs on one: add --solver petsc" in capsys.readouterr().err


def test_missing_petsc_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "petsc4py", None)
    with pytest.raises(UnsupportedError, match=r"scripts/install_petsc\.sh"):
        make_solver("petsc")

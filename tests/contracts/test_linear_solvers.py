"""Every registered linear solver: backward error, inertia, refusal of singular matrices."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np
import pytest
import scipy.sparse as sp

from corota.analysis.linear import pardiso
from corota.analysis.linear.solvers import SOLVERS, LinearSolver, Multifrontal, make_solver
from corota.errors import InputError, SingularError, UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Callable

#: Those whose library is here; the refusal of the others is tested too.
NEEDED = {"pardiso": pardiso.find_mkl, "petsc": lambda: find_spec("petsc4py")}
#: Iterates to a tolerance, without inertia; see tests/scale.
ITERATIVE = {"petsc:gamg"}
NAMES = [
    name
    for name in SOLVERS
    if name not in ITERATIVE and (name not in NEEDED or NEEDED[name]() is not None)
]


def chain(n: int, *, held: bool = True) -> sp.csc_array:
    """Springs in a row, the first held or not; condition about n squared."""
    diagonal = np.full(n, 2.0)
    diagonal[-1] = 1.0
    if not held:
        diagonal[0] = 1.0
    matrix = sp.diags_array([diagonal, np.full(n - 1, -1.0)], offsets=[0, 1])
    return sp.csc_array(matrix)


def saddle(n: int) -> sp.csc_array:
    """The same springs, free, with one multiplier that holds the mean of both ends."""
    upper = chain(n, held=False).tolil()
    upper.resize((n + 1, n + 1))
    upper[0, n] = upper[n - 1, n] = 1.0
    return sp.csc_array(upper)


def analyzed(name: str, upper: sp.csc_array, *, symmetric: bool = True) -> LinearSolver:
    solver = make_solver(name, symmetric)
    upper.sort_indices()
    solver.analyze(upper.indptr, upper.indices, np.arange(upper.shape[0]))
    return solver


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("build", [chain, saddle])
def test_symmetric_backward_error_and_inertia(
    name: str, build: Callable[[int], sp.csc_array]
) -> None:
    upper = build(40)
    n = upper.shape[0]
    full = (upper + sp.triu(upper, 1).T).toarray()
    solver = analyzed(name, upper)
    for scale in (1.0, 1e6):
        inertia = solver.factorize(scale * upper.data)
        if inertia is not None:
            values = np.linalg.eigvalsh(full)
            assert inertia == (int(np.sum(values > 0)), int(np.sum(values < 0)), 0)
        rhs = np.random.default_rng(3).normal(size=(n, 3))
        kept = rhs.copy()
        for b in (rhs, rhs[:, 0]):
            x = solver.solve(b)
            assert x.shape == b.shape
            error = np.abs(scale * full @ x - b).max()
            assert error <= 1e-14 * (4 * scale * np.abs(x).max() + np.abs(b).max())
        np.testing.assert_array_equal(rhs, kept)


@pytest.mark.parametrize("name", NAMES)
def test_unsymmetric_backward_error(name: str) -> None:
    generator = np.random.default_rng(4)
    full = np.where(generator.random((30, 30)) < 0.2, generator.normal(size=(30, 30)), 0.0)
    np.fill_diagonal(full, generator.normal(size=30) + 3.0)
    matrix = sp.csc_array(full)
    solver = analyzed(name, matrix, symmetric=False)
    assert solver.factorize(matrix.data) is None
    b = generator.normal(size=30)
    x = solver.solve(b)
    assert np.abs(full @ x - b).max() <= 1e-13 * np.abs(full).sum(1).max() * np.abs(x).max()


@pytest.mark.parametrize("name", NAMES)
def test_a_free_chain_is_refused(name: str) -> None:
    upper = chain(30, held=False)
    solver = analyzed(name, upper)

    def run() -> None:
        solver.factorize(upper.data)
        solver.solve(np.arange(30.0))

    with pytest.raises(SingularError):
        run()


def test_the_refusal_tells_where_and_how_it_moves() -> None:
    solver = analyzed("multifrontal", chain(30, held=False))
    with pytest.raises(SingularError, match="singular") as caught:
        solver.factorize(chain(30, held=False).data)
    assert 0 <= caught.value.equation < 30
    np.testing.assert_allclose(np.abs(caught.value.mode), 1.0, rtol=1e-10)


def test_threads_are_set_and_change_nothing() -> None:
    upper = chain(50)
    answers = []
    for threads in (0, 1, 2):
        solver = Multifrontal()
        solver.threads = threads
        assert solver.threads == threads
        solver.analyze(upper.indptr, upper.indices, np.arange(50))
        solver.factorize(upper.data)
        answers.append(solver.solve(np.ones(50)))
    np.testing.assert_array_equal(answers[0], answers[1])
    np.testing.assert_array_equal(answers[0], answers[2])


def test_bad_input_is_named() -> None:
    upper = chain(5)
    solver = analyzed("multifrontal", upper)
    values = upper.data.copy()
    values[3] = np.nan
    with pytest.raises(InputError, match=r"entry \(1, 2\) is not a finite number"):
        solver.factorize(values)
    with pytest.raises(InputError, match="8 values for 9 entries"):
        solver.factorize(upper.data[1:])
    with pytest.raises(InputError, match="factorize before solve"):
        solver.solve(np.ones(5))
    solver.factorize(upper.data)
    with pytest.raises(InputError, match="right-hand side of 4 values for 5 equations"):
        solver.solve(np.ones(4))
    with pytest.raises(InputError, match="no linear solver 'lu'; there are: multifrontal"):
        make_solver("lu")


def test_missing_pardiso_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pardiso, "find_mkl", lambda: None)
    with pytest.raises(UnsupportedError, match=r"pip install 'corota\[pardiso\]'"):
        make_solver("pardiso")

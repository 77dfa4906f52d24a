"""Large displacement against exact and converged solutions; Newton converges quadratically."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

from corota.model.steps import Static
from corota.verification.models import last_frames
from corota.verification.problems import cook_large, elastica, roll_up, thick_cantilever
from support.models import (
    Watch,
    assert_contracts,
    assert_quadratic,
    balance,
    cook,
    run,
)

SLENDER = 2e-3


@pytest.mark.parametrize("element", elastica.MESHES)
def test_elastica(element):
    watch = Watch()
    results = elastica.solved(element, *elastica.MESHES[element], watch)
    exact = np.array([row[1:] for row in elastica.EXACT])
    assert np.abs(elastica.end(results) / exact - 1.0).max() <= SLENDER
    for frame in last_frames(results):
        assert max(balance(results.model, frame)) <= 1e-8
    assert_contracts(watch, 20 * elastica.LENGTH / elastica.HEIGHT**2, 1e-9 * elastica.LENGTH)


@pytest.mark.parametrize("element", roll_up.MESHES)
def test_roll_up(element):
    watch = Watch()
    found = roll_up.places(roll_up.solved(element, *roll_up.MESHES[element], watch))
    assert np.abs(found - list(roll_up.EXACT.values())).max() <= SLENDER
    assert_contracts(watch, 20 * roll_up.LENGTH / roll_up.HEIGHT**2, 1e-9 * roll_up.LENGTH)


@pytest.mark.parametrize(
    ("problem", "arguments", "size"),
    [(thick_cantilever, ("Q9", 80), 0.1), (cook_large, ("Q9", 32), 4.0)],
    ids=["cantilever", "cook"],
)
def test_newton_is_quadratic_beside_the_biot_continuum(problem, arguments, size, monkeypatch):
    """The values are those of the catalog, from the same run."""
    watch, solved = Watch(), problem.solved
    with pytest.warns(UserWarning, match="local strain"):
        results = solved(*arguments, watch, fields=True)
    monkeypatch.setattr(problem, "solved", lambda *_: results)
    for value in problem.measure():
        assert value.ok, value
    assert_quadratic(watch, size)


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D"])
def test_newton_is_quadratic_for_every_element(element, local_strain):
    model, _ = cook(element, 4, force=0.3, local_strain=local_strain)
    watch = Watch()
    frame = run(model, Static(increments=2, tolerance=1e-12), watch)
    assert_quadratic(watch, 10.0)
    assert watch.cuts == 0
    assert max(balance(model, frame)) <= 1e-10

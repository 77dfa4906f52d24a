"""Periodic cells of the examples: pattern of holes, chiral lattice, squares that meet."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:increment")  # the run goes past the onset
def test_one_cell_finds_what_four_find(load) -> None:
    """The critical load of 2 x 2 cells, by their matrices and by a path, is that of one cell."""
    example = load("cells/holes.py")
    one, found = example.onset(4)
    np.testing.assert_array_equal(found.wave, [0.5, 0.5])
    four = one.repeat(2, 2)
    again = four.onset(example.pressed(four, 0.06), 1)
    assert again.time == pytest.approx(found.time, rel=1e-8)
    np.testing.assert_allclose(again.gradient, found.gradient, rtol=1e-8, atol=1e-12)
    four.model.steps = [ct.Static(path=ct.ArcLength(factor=1.05 * found.time))]
    load_of_path = ct.value_and_grad(lambda _: four.model, ct.gradients.BifurcationLoad())([1.0])[0]
    assert load_of_path == pytest.approx(found.time, rel=1e-8)


def test_onset_converges(load) -> None:
    """About 2.98 % with a fine mesh; 2.5 % more with six elements a quarter."""
    example = load("cells/holes.py")
    assert -example.onset(6)[1].gradient[1, 1] == pytest.approx(0.0298, rel=4e-2)


def test_pattern_has_a_negative_ratio(load) -> None:
    example = load("cells/holes.py")
    one, found = example.onset(4)
    four = example.patterned(one, found, 1e-3)
    results = example.pressed(four, 0.1)
    wide = [four.gradient(results, k)[0, 0] for k in (3, -2, -1)]
    assert wide[0] > 0.0
    assert wide[2] < wide[1]


@pytest.mark.parametrize(("share", "most"), [(0.02, -0.99), (0.1, -0.78)])
def test_chiral_lattice(load, share: float, most: float) -> None:
    """Bulk modulus by hand, isotropy, and a ratio near -1."""
    example = load("cells/chiral.py")
    height = share * example.LENGTH
    found = ct.cells.elastic_constants(example.cell(height).tangent())
    bulk = 0.5 * found["E1"] / (1.0 - found["nu12"])
    assert bulk == pytest.approx(example.bulk_modulus(height), rel=1e-6)
    assert found["E2"] == pytest.approx(found["E1"], rel=1e-6)
    assert found["G12"] == pytest.approx(0.5 * found["E1"] / (1.0 + found["nu12"]), rel=1e-6)
    assert -1.0 < found["nu12"] < most


def test_rotating_squares_close_across_the_border(load) -> None:
    """No stress up to the closing strain, then that of rigid squares."""
    example = load("cells/squares.py")
    one = example.cell(2)
    before = one.stress(example.pressed(one, (1.0 - 1e-9) * example.STRAIN))
    np.testing.assert_allclose(before, 0.0, atol=1e-9)
    for share in (1.0 + 1e-4, 1.03):
        found = one.stress(example.pressed(one, share * example.STRAIN))
        expected = example.stress(share * example.STRAIN)
        np.testing.assert_allclose(found.diagonal(), expected, rtol=3e-4)
        assert abs(found[0, 1]) < 1e-3 * abs(expected)

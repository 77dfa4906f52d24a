"""The benchmarks' own parts: problems, decks, the comparison's page."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from benchmarks.corpora import decks
from benchmarks.corpora.problems import BUILDERS, Problem
from benchmarks.peers.run_corota import model_of
from benchmarks.speed import phase_profile
from benchmarks.studies import comparison

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("name", ["P1", "P2"])
def test_deck_and_driver_are_the_same_problem(name: str, tmp_path: Path) -> None:
    p = BUILDERS[name](2, last=1)
    p.save(tmp_path / "problem.npz")
    p = Problem.load(tmp_path / "problem.npz")
    decks.write_deck(tmp_path / "job.inp", p)
    read = ct.read(tmp_path / "job.inp")
    read.sections[0].element = "Q4"
    by_deck = ct.solve(read, threads=1).frames[-1].U
    driven = model_of(p, "Q4", "logarithmic" if name == "P2" else "green_lagrange")
    for item in (*driven.supports, *driven.loads):
        item.value *= p.last / p.increments
    found = ct.solve(driven, ct.Static(increments=1), threads=1).frames[-1].U
    np.testing.assert_allclose(by_deck, found, rtol=0.0, atol=1e-7 * np.abs(found).max())


def test_page_has_a_place_for_every_case() -> None:
    text = comparison.PAGE.read_text(encoding="utf-8")
    for case in comparison.cases():
        assert all(mark in text for mark in comparison.marks(case.name))


def test_cost_is_interpolated_on_the_logarithms() -> None:
    line = [{"error": 1e-1, "dofs": 10}, {"error": 1e-3, "dofs": 1000}]
    assert comparison.cost(line, 1e-2, "dofs") == pytest.approx(100.0)
    assert np.isnan(comparison.cost(line, 1e-4, "dofs"))
    assert comparison.cost(line, 0.2, "dofs") == 10.0


def test_operations_of_dissection_grow_with_the_power_three_halves() -> None:
    small, large = (phase_profile.dissection(n, n, 0) for n in (255, 511))
    assert np.log(large / small) / np.log((511 / 255) ** 2) == pytest.approx(1.5, abs=0.06)


def test_operations_of_a_chain_are_those_of_its_band() -> None:
    # A line of n nodes, eliminated by halves: each separator of 2 dofs meets at most 4 others.
    n = 1023
    most = 2.0**3 / 3.0 + 2.0**2 * 4.0 + 2.0 * 4.0**2
    assert phase_profile.dissection(n, 1, 0) < n * most
    assert phase_profile.dissection(n, 1, 0) > 0.5 * (n / 2) * most

"""Flexible mechanisms beside exudyn's stored answers; the finer runs are in docs/multibody.md."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from benchmarks.corpora.mechanisms import MECHANISMS, SAMPLES, measured, with_beams
from benchmarks.studies.multibody import answers, largest
from support.pairs import quickly


@pytest.mark.parametrize("name", quickly(["pendulum", "slider_crank"], "pendulum"))
def test_a_mechanism_of_beams_moves_as_in_exudyn(name: str) -> None:
    """Halving elements and increments quarters the difference, or nearly."""
    mechanism = MECHANISMS[name]()
    errors = []
    for cells, increments in ((4, 300), (8, 600)):
        time, x = with_beams(mechanism, cells, increments, "generalized_alpha")
        found = measured(mechanism, time, x)
        each = increments // SAMPLES
        errors.append(
            {
                q: largest(found[q][::each] - np.array(v), np.array(v))
                for q, v in answers(name)["values"].items()
            }
        )
    gross = next(iter(errors[0]))
    assert errors[1][gross] < 0.02
    for quantity in errors[0]:
        assert errors[1][quantity] < 0.45 * errors[0][quantity], quantity

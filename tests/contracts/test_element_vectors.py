"""Single elements at rest and in large rotation against an independent implementation.

``tests/data/element_vectors.json``: computed by an independent implementation.
"""

# SPDX-License-Identifier: BSD-3-Clause
import json
from pathlib import Path

import numpy as np
import pytest

from support.models import assemble, single

DATA = Path(__file__).parents[1] / "data" / "element_vectors.json"
CASES = json.loads(DATA.read_text())["elastic"]
AGREE = 1e-10


@pytest.mark.parametrize(
    "case", CASES, ids=[f"{c['element']}-{c['local_strain']}-{i}" for i, c in enumerate(CASES)]
)
def test_force_and_tangent_agree_with_an_independent_implementation(case):
    u = np.array(case["u"])
    names = ("E", "nu", "plane", "local_strain", "thickness")
    model = single(case["element"], np.array(case["X"]), **{k: case[k] for k in names})
    _, rest = assemble(model, np.zeros_like(u))
    force, tangent = assemble(model, u)
    for found, key in ((rest, "stiffness_at_rest"), (force, "force"), (tangent, "tangent")):
        expected = np.array(case[key])
        assert np.abs(found - expected).max() <= AGREE * np.abs(expected).max(), key

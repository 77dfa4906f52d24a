"""A rotation superposed on an increment turns the forces and changes nothing else."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from benchmarks.campaigns import objectivity
from corota.model.contact import METHODS
from support.pairs import cover

CASES = [
    (objectivity.drag, "rigid"),
    (objectivity.drag, "table master"),
    (objectivity.drag, "short table master"),
    (objectivity.drag, "short table slave"),
    (objectivity.drum, "master"),
    (objectivity.punch, "disc"),
    (objectivity.punch, "fillet"),
    (objectivity.rolled, "Q4I"),
    (objectivity.stack, "upper slave"),
    (objectivity.stack, "lower slave"),
    (objectivity.folded, "on itself"),
    (objectivity.wire, "on a block"),
]


@pytest.mark.parametrize(
    ("degrees", "make", "role", "method"),
    [(a, *b, c) for a, b, c in cover([90.0, 180.0, 400.0], CASES, METHODS)],
)
def test_forces_turn_with_a_superposed_rotation(make, role, method, degrees):
    """In each of two increments, friction included; slips of whole turns belong to no body."""
    still = objectivity.measured(make(method, role), 0.0)
    turned = objectivity.measured(make(method, role), degrees)
    for kind, values in turned.items():
        scale = objectivity.scale_of(still, kind)
        np.testing.assert_allclose(values, still[kind], atol=objectivity.SAME * scale, err_msg=kind)

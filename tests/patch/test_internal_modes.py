"""Internal modes of an element at rest: what rounding has left in them does not stop a run."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from support.pairs import cover


@pytest.mark.parametrize(
    ("element", "material", "size"),
    cover(
        ["Q4I", "Q4DI", "Q4S"],
        [ct.Elastic(E=1e3, nu=0.3), ct.Mises(E=1e3, nu=0.3, yield_stress=1.0)],
        [10.0**-k for k in range(20, 324, 8)],
    ),
)
def test_modes_however_small_vanish_in_an_element_at_rest(element, material, size):
    """A body in flight is undeformed: each evaluation makes its modes smaller, to underflow."""
    model = ct.Model(ct.mesh.rectangle(1.0, 0.5, 4, 2))
    model.section("all", element=element, material=material)
    system = System(model, Multifrontal())
    values, lengths = system.core.state()
    at, count = int(lengths[0]), int(lengths[1])  # of the internal modes
    assert count
    values[at : at + count] = size * np.cos(np.arange(count))
    system.core.restore_state(values, lengths)
    force, scale = np.zeros(system.n_dofs), np.zeros(system.n_dofs)
    tangent = np.zeros(len(system.pattern.indices))
    u = np.zeros(system.n_dofs)
    for _ in range(3):
        system.core.assemble(u, True, force, scale, tangent, False)
        assert np.abs(force).max() <= 1e3 * size
        system.core.commit()

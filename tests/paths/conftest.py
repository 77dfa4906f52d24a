"""Running a path without a mesh."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.analysis.newton import Settings
from corota.analysis.path_system import Point
from corota.analysis.procedures.path.branches import BranchTracer
from corota.analysis.procedures.path.plan import Plan


@pytest.fixture
def follow():
    """Increments of a system's path, as a list."""

    def run(system, most=200, **plan):
        start = Point(np.zeros(system.load.size), 0.0, None)
        start.at = system.evaluate(start.u, 0.0)
        found = []
        for increment in BranchTracer(system, start, 1.0, Settings(), Plan(**plan)):
            found.append(increment)
            assert len(found) < most
        return found

    return run

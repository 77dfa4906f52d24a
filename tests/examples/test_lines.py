# SPDX-License-Identifier: BSD-3-Clause
"""The frame that meets a stop, against its sway stiffness."""

import pytest

import corota as ct


@pytest.mark.parametrize("increments", [1, 8])
def test_the_stop_takes_what_the_frame_does_not(load, increments):
    """F - k d; the girder shortens by F h/EA, about 2 % of the gap; rotations of .003."""
    example = load("lines/frame_stop.py")
    results = ct.solve(example.model(), ct.Static(increments=increments))
    found = -results.frames[-1].scalars["stop: force x"]
    exact = example.LOAD - example.sway_stiffness() * example.GAP
    assert found == pytest.approx(exact, rel=0.01)

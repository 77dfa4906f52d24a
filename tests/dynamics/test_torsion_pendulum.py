"""Frequency of a model whose only inertia turns."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import pytest

import corota as ct


def test_a_disk_on_a_torsion_spring(tmp_path: Path) -> None:
    """ω² = k / I; no mass moves along x or y."""
    deck = tmp_path / "disk.inp"
    deck.write_text(
        "*NODE\n1,0,0\n2,0,0\n*ELEMENT, TYPE=SPRING2, ELSET=K\n1,1,2\n*SPRING, ELSET=K\n6,6\n100.\n"
        "*ELEMENT, TYPE=ROTARYI, ELSET=R\n2,2\n*ROTARY INERTIA, ELSET=R\n0.,0.,4.\n"
        "*BOUNDARY\n1,1,6\n2,1,2\n*STEP\n*FREQUENCY\n1\n*END STEP\n"
    )
    scalars = ct.solve(ct.read(deck)).frames[-1].scalars
    assert scalars["frequency 1"] == pytest.approx(5.0 / (2.0 * math.pi))
    assert scalars["effective mass x 1"] == 0.0

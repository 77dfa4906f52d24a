"""``*IMPERFECTION``: shapes of an earlier job, or given displacements."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

COLUMN = """*NODE, NSET=all_nodes
1, 0., 0.
2, 25., 0.
3, 50., 0.
4, 75., 0.
5, 100., 0.
*ELEMENT, TYPE=B23, ELSET=column
1, 1, 2
2, 2, 3
3, 3, 4
4, 4, 5
*NSET, NSET=upper
3, 4, 5
*MATERIAL, NAME=steel
*ELASTIC
210000., 0.3
*BEAM SECTION, ELSET=column, MATERIAL=steel, SECTION=RECT
5., 1.
0., 0., -1.
*BOUNDARY
1, 1, 6
{card}*STEP
*STATIC
*CLOAD
5, 2, 0.1
*END STEP
*STEP
*BUCKLE
3
*CLOAD
5, 1, -1.
*END STEP
"""


def read(folder: Path, card: str = "") -> ct.Model:
    path = folder / "column.inp"
    path.write_text(COLUMN.format(card=card), encoding="utf-8")
    return ct.read(path)


@pytest.fixture(params=["vtkhdf", "frd"])
def solved(request: pytest.FixtureRequest, tmp_path: Path) -> ct.Results:
    model = read(tmp_path)
    files = ct.JobFiles(tmp_path, "job", formats=[request.param])
    return ct.solve(model, observers=[files], threads=1)


def test_modes_of_an_earlier_job(solved: ct.Results, tmp_path: Path) -> None:
    straight = read(tmp_path)
    expected = straight.copy()
    expected.imperfection(solved.modes[0], {1: 0.5, 3: -0.2})
    crooked = read(tmp_path, "*IMPERFECTION, FILE=job, STEP=2\n1, 0.5\n3, -0.2\n")
    np.testing.assert_allclose(crooked.mesh.points, expected.mesh.points, rtol=1e-5, atol=1e-7)
    assert any(name.startswith(str(tmp_path / "job.")) for name in crooked.sources)
    card = "*IMPERFECTION, FILE=job, STEP=2, NSET=upper\n1, 0.5\n3, -0.2\n"
    part = read(tmp_path, card).mesh.points
    assert np.array_equal(part[:2], straight.mesh.points[:2])
    assert np.array_equal(part[2:], crooked.mesh.points[2:])


def test_state_of_a_static_step(tmp_path: Path) -> None:
    solved = ct.solve(read(tmp_path), observers=[ct.JobFiles(tmp_path, "job")], threads=1)
    moved = read(tmp_path, "*IMPERFECTION, FILE=job.vtkhdf, STEP=1\n1, 10.\n").mesh.points
    frame = next(f for f in reversed(solved.frames) if f.step == 1)
    expected = read(tmp_path).mesh.points + 10.0 * frame.U
    np.testing.assert_allclose(moved, expected, rtol=1e-12)


def test_given_displacements(tmp_path: Path) -> None:
    moved = read(tmp_path, "*IMPERFECTION\n2, 0.1, 0.2\nupper, , 0.3, 0.\n").mesh.points
    expected = read(tmp_path).mesh.points
    expected[1] += (0.1, 0.2)
    expected[2:, 1] += 0.3
    np.testing.assert_allclose(moved, expected, rtol=1e-15)


@pytest.mark.parametrize(
    ("card", "message"),
    [
        ("*IMPERFECTION, FILE=none, STEP=2\n1, 0.5\n", "there are no results none"),
        ("*IMPERFECTION, FILE=../job, STEP=2\n1, 0.5\n", "outside the folder"),
        ("*IMPERFECTION, FILE=job\n1, 0.5\n", "STEP= is missing"),
        ("*IMPERFECTION, FILE=job, STEP=2\n4, 0.5\n", "no mode 4 in step 2"),
        ("*IMPERFECTION, FILE=job, STEP=7\n1, 0.5\n", "no mode 1 in step 7; there is nothing"),
        ("*IMPERFECTION, FILE=job, STEP=2\n", "a data line is missing"),
        ("*IMPERFECTION, FILE=job, STEP=2, NSET=none\n1, 1.\n", "no node set named 'none'"),
        ("*IMPERFECTION, STEP=2\n1, 0.5\n", "STEP= goes with FILE="),
        ("*IMPERFECTION\n1, 0.5, 0., 1.\n", "out of the plane"),
        ("*IMPERFECTION\n77, 0.5\n", "node 77 is not defined"),
        ("*NODE\n9, 0., 5.\n*IMPERFECTION, FILE=job, STEP=2\n1, 0.5\n", "no node 9 "),
    ],
)
def test_what_is_refused(tmp_path: Path, card: str, message: str) -> None:
    ct.solve(read(tmp_path), observers=[ct.JobFiles(tmp_path, "job")], threads=1)
    with pytest.raises(ct.DeckError) as caught:
        read(tmp_path, card)
    assert message in str(caught.value)
    assert "column.inp:" in str(caught.value)

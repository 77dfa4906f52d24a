"""Quadrilaterals with two nodes at one place, as meshes of fans and crack tips have them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import CorotaError
from corota.mesh import Mesh
from corota.mesh.data import Cells

if TYPE_CHECKING:
    from pathlib import Path

DECK = """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 2., 0.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*CLOAD
2, 1, 2.
*END STEP
"""


def fan(element: str) -> ct.Model:
    """A square of two such quadrilaterals, whose inner nodes are apart, and two triangles."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.45, 0.5], [0.45, 0.5]])
    quads = Cells("quad4", np.array([[0, 1, 4, 5], [2, 3, 5, 4]]), np.array([1, 2]))
    triangles = Cells("tri3", np.array([[1, 2, 4], [3, 0, 5]]), np.array([3, 4]))
    model = ct.Model(Mesh(points, [quads, triangles]))
    material = ct.Elastic(E=1000.0, nu=0.3)
    model.section([0, 1], element=element, material=material)
    model.section([2, 3], element="T3", material=material)
    for node, (x, y) in enumerate(points[:4].tolist()):
        model.fix([node], x=0.01 * x + 0.004 * y, y=-0.003 * y)
    return model


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q4R", "Q4D", "Q4DI"])
def test_constant_strain(element: str) -> None:
    """Both inner nodes move with the plate; nothing joins them but the strain."""
    results = ct.solve(fan(element), ct.Static(nlgeom=False), fields=False)
    expected = np.array([0.01 * 0.45 + 0.004 * 0.5, -0.003 * 0.5])
    np.testing.assert_allclose(results.frames[-1].U[4:, :2], [expected] * 2, rtol=0.0, atol=1e-15)


def test_deck_with_a_triangle_of_four_nodes(tmp_path: Path) -> None:
    """Runs, and is the triangle where both nodes move alike; two such sides are refused by line."""
    path = tmp_path / "job.inp"
    path.write_text(DECK.replace("*STEP", "*EQUATION\n2\n2, 1, 1., 3, 1, -1.\n*STEP", 1))
    both = ct.solve(ct.read(path)).frames[-1].U[1, 0]
    path.write_text(DECK.replace("1, 1, 2, 3, 4", "1, 1, 2, 2, 4"))
    assert both == pytest.approx(ct.solve(ct.read(path)).frames[-1].U[1, 0], rel=1e-9)
    path.write_text(DECK.replace("4, 0., 1.", "4, 0., 0."))
    with pytest.raises(CorotaError, match=r"job.inp:7.*no area"):
        ct.read(path)

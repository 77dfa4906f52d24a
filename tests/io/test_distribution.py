"""Values by element: axes beside CalculiX, thicknesses of shells by hand."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import DeckError

if TYPE_CHECKING:
    from pathlib import Path

#: Two elements of wood, the grain of the second turned by 30 degrees.
WOOD = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
11, .5, 0.
12, 1.5, 0.
13, .5, 1.
14, 1.5, 1.
15, 0., .5
16, 1., .5
17, 2., .5
*ELEMENT, TYPE=CPS8, ELSET=EALL
1, 1, 2, 5, 4, 11, 16, 13, 15
2, 2, 3, 6, 5, 12, 17, 14, 16
*MATERIAL, NAME=WOOD
*ELASTIC, TYPE=ENGINEERING CONSTANTS
12000., 900., 900., .3, 0., 0., 700., 700.,
700.
*DISTRIBUTION, NAME=AXES
, 1., 0., 0., 0., 1., 0.
2, .8660254037844387, .5, 0., -.5, .8660254037844387, 0.
*ORIENTATION, NAME=OR, SYSTEM=RECTANGULAR
AXES
3, 0.
*SOLID SECTION, ELSET=EALL, MATERIAL=WOOD, ORIENTATION=OR
.001
*BOUNDARY
1, 1, 2
4, 1
15, 1
*STEP
*STATIC
*CLOAD
3, 1, .01
6, 1, .01
17, 1, .04
*NODE PRINT, NSET=NALL
U
*END STEP
"""

#: Displacements of CalculiX 2.20 with this deck.
CALCULIX = {
    2: (5.130067e-03, 5.522673e-04),
    3: (2.751903e-02, -2.818094e-02),
    4: (0.0, -1.511650e-03),
    17: (2.745786e-02, -3.002023e-02),
}


def solve(path: Path, text: str) -> tuple[ct.Model, dict[int, tuple[float, float]]]:
    (path / "a.inp").write_text(text)
    model = ct.read(path / "a.inp")
    u = ct.solve(model).frames[-1].U
    return model, dict(zip(model.mesh.node_labels.tolist(), u.tolist(), strict=True))


@pytest.mark.parametrize("angle", [0, 30])
def test_axes_by_element_beside_calculix(tmp_path: Path, angle: int) -> None:
    # With 30 degrees more for all, those of the default line are given 30 less.
    text = WOOD
    if angle:
        c, s = np.sqrt(0.75), 0.5
        text = text.replace("3, 0.\n*SOLID", "3, 30.\n*SOLID")
        text = text.replace(
            "2, .8660254037844387, .5, 0., -.5, .8660254037844387, 0.", "2, 1., 0., 0., 0., 1., 0."
        )
        text = text.replace(", 1., 0., 0., 0., 1., 0.\n2,", f", {c}, -{s}, 0., {s}, {c}, 0.\n2,")
    _, u = solve(tmp_path, text)
    for label, expected in CALCULIX.items():
        np.testing.assert_allclose(u[label], expected, rtol=2e-6, atol=2e-8)


def test_thickness_of_shells_by_element(tmp_path: Path) -> None:
    # Two elements in line under 6: 6 / (1000 t) each, t of 0.2 and 0.5.
    text = (
        WOOD[: WOOD.index("*MATERIAL")].replace("CPS8", "S8")
        + """*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*DISTRIBUTION, NAME=DEPTH, LOCATION=ELEMENT, TABLE=T
, 0.2
2, 0.5
*DISTRIBUTION TABLE, NAME=T
LENGTH
*SHELL SECTION, ELSET=EALL, MATERIAL=M, SHELL THICKNESS=DEPTH
*BOUNDARY
1, 1, 2
4, 1
15, 1
*STEP
*STATIC
*CLOAD
3, 1, 1.
6, 1, 1.
17, 1, 4.
*END STEP
"""
    )
    model, u = solve(tmp_path, text)
    assert [section.thickness for section in model.sections] == [0.2, 0.5]
    assert u[2][0] == pytest.approx(0.03, rel=1e-9)
    assert u[3][0] == pytest.approx(0.03 + 0.012, rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (", 1., 0., 0., 0., 1., 0.\n2,", "2,", "no value for element 1"),
        ("\n2, .866", "\nNONE, .866", "NONE"),
        ("-.5, .866", "-.5, -.866", "third axis would point to -z"),
        ("\nAXES\n", "\nAXIS\n", "no distribution named 'AXIS'"),
        ("NAME=AXES", "NAME=AXES, LOCATION=NODE", "by element"),
    ],
)
def test_what_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in WOOD
    (tmp_path / "a.inp").write_text(WOOD.replace(old, new))
    with pytest.raises(DeckError, match=said):
        ct.read(tmp_path / "a.inp")

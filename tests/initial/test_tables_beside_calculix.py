"""Constants by temperature beside CalculiX 2.20: displacements of the end of a tapered block.

The decks are plane strain, in which both programs have the same elements, and a homogeneous plane
stress. CalculiX ran them with ``*NODE FILE, OUTPUT=2D``; its results have six digits.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import corota as ct

CELLS = {"3": "tri3", "6": "tri6", "8": "quad8"}
ELASTIC = "*ELASTIC\n210000., .3, 20.\n150000., .33, 300.\n80000., .37, 700.\n"
PLASTIC = """*PLASTIC
300., 0., 20.
360., .05, 20.
400., .2, 20.
150., 0., 500.
200., .1, 500.
210., .2, 500.
"""
ORTHO = """*ELASTIC, TYPE=ORTHO
141000., 3500., 9500., 3300., 3400., 8500., 5000., 5000.
3000., 20.
91000., 1500., 4300., 1300., 1400., 3700., 2000., 2000.
1500., 400.
"""
EXPANSION = "*EXPANSION, ZERO=20.\n1.2E-5, 20.\n1.5E-5, 500.\n"
EXPANSION_ORTHO = (
    "*EXPANSION, TYPE=ORTHO, ZERO=20.\n1E-6, 2E-5, 2E-5, 20.\n2E-6, 3E-5, 3E-5, 400.\n"
)
NO_EXPANSION = "*EXPANSION\n0.\n"

Field = Callable[[float, float], float]


def warm(x: float, y: float) -> float:
    return 100.0 + 80.0 * x + 60.0 * y


def wide(x: float, y: float) -> float:
    return -100.0 + 300.0 * x


def step(
    increment: float,
    *,
    force: float | None = None,
    pull: float | None = None,
    heat: float | Field | None = None,
) -> Callable[[np.ndarray], str]:
    """A step of fixed increments: forces or displacements of the end, temperatures."""

    def text(points: np.ndarray) -> str:
        cards = f"*STEP, INC=1000\n*STATIC, DIRECT\n{increment}, 1.\n"
        if force is not None:
            cards += f"*CLOAD\nRIGHT, 1, {force}\nRIGHT, 2, {force / 5}\n"
        if pull is not None:
            cards += f"*BOUNDARY\nRIGHT, 1, 1, {pull}\n"
        if callable(heat):
            cards += "*TEMPERATURE\n" + "".join(
                f"{i}, {heat(x, y)!r}\n" for i, (x, y) in enumerate(points.tolist(), start=1)
            )
        elif heat is not None:
            cards += f"*TEMPERATURE\nALL, {heat}\n"
        return cards + "*NODE FILE, OUTPUT=2D\nU\n*END STEP\n"

    return text


def deck(
    kind: str,
    law: str,
    *steps: Callable[[np.ndarray], str],
    expansion: str = EXPANSION,
    taper: float = 0.15,
) -> str:
    mesh = ct.mesh.rectangle(4.0, 2.0, nx=4, ny=2, cell=CELLS[kind[3]])  # type: ignore[arg-type]
    points = mesh.points.copy()
    points[:, 1] += taper * points[:, 0] * points[:, 1] / 2.0
    nodes = "".join(f"{i}, {x!r}, {y!r}\n" for i, (x, y) in enumerate(points.tolist(), start=1))
    elements = "".join(
        f"{e}, {', '.join(str(n + 1) for n in cell)}\n"
        for e, cell in enumerate(mesh.cells[0].nodes.tolist(), start=1)
    )
    sets = "".join(
        f"*NSET, NSET={name}\n" + "".join(f"{n + 1},\n" for n in mesh.node_sets[side].tolist())
        for name, side in (("LEFT", "left"), ("RIGHT", "right"))
    )
    return (
        f"*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE={kind}, ELSET=E\n{elements}{sets}"
        f"*MATERIAL, NAME=M\n{law}{expansion}*DENSITY\n7.8E-9\n"
        "*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*BOUNDARY\nLEFT, 1, 1\n1, 2, 2\n"
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\n"
        + "".join(text(points) for text in steps)
    )


DECKS = {
    "CPE8R elastic, linear field": deck("CPE8R", ELASTIC, step(1.0, force=2000.0, heat=warm)),
    "CPE8 elastic, linear field": deck("CPE8", ELASTIC, step(1.0, force=2000.0, heat=warm)),
    "CPE6 elastic, linear field": deck("CPE6", ELASTIC, step(1.0, force=2000.0, heat=warm)),
    "CPE3 elastic, linear field": deck("CPE3", ELASTIC, step(1.0, force=2000.0, heat=warm)),
    "CPE8R elastic, beyond the table": deck("CPE8R", ELASTIC, step(1.0, force=2000.0, heat=wide)),
    "CPE8R orthotropic, linear field": deck(
        "CPE8R", ORTHO, step(1.0, force=500.0, heat=warm), expansion=EXPANSION_ORTHO
    ),
    "CPE8R flow, loaded then heated": deck(
        "CPE8R", ELASTIC + PLASTIC, step(0.1, force=60.0), step(0.1, heat=warm)
    ),
    "CPE6 flow, loaded then heated": deck(
        "CPE6", ELASTIC + PLASTIC, step(0.1, force=60.0), step(0.1, heat=300.0)
    ),
    "CPE3 flow, heated and cooled": deck(
        "CPE3",
        ELASTIC + PLASTIC,
        step(0.1, force=60.0, heat=warm),
        step(0.1, force=0.0, heat=20.0),
    ),
    "CPE8R flow, pulled then heated": deck(
        "CPE8R",
        ELASTIC + PLASTIC,
        step(0.1, pull=0.016),
        step(0.1, pull=0.02, heat=260.0),
        expansion=NO_EXPANSION,
    ),
    "CPE8 flow under heat, reversed": deck(
        "CPE8",
        ELASTIC + PLASTIC,
        step(0.1, pull=0.012, heat=warm),
        step(0.1, pull=-0.004, heat=40.0),
    ),
    "CPE6 flow, linear field, pulled": deck(
        "CPE6", ELASTIC + PLASTIC, step(0.1, heat=warm), step(0.1, pull=0.02)
    ),
    "CPS8R flow, homogeneous": deck(
        "CPS8R",
        ELASTIC + PLASTIC,
        step(0.1, pull=0.012),
        step(0.1, pull=0.016, heat=300.0),
        taper=0.0,
    ),
    "CPS3 elastic, homogeneous": deck("CPS3", ELASTIC, step(1.0, pull=0.01, heat=410.0), taper=0.0),
}

#: Displacements of the nodes of the right end by CalculiX, in the order of their numbers.
BY_CALCULIX: dict[str, list[tuple[float, float]]] = {
    "CPE8R elastic, linear field": [
        (0.235911, 0.274447),
        (0.132417, 0.245548),
        (0.117529, 0.226978),
        (0.0713082, 0.209035),
        (0.111384, 0.190429),
    ],
    "CPE8 elastic, linear field": [
        (0.220968, 0.26333),
        (0.138081, 0.240263),
        (0.110187, 0.224494),
        (0.0767771, 0.210515),
        (0.0943443, 0.196781),
    ],
    "CPE6 elastic, linear field": [
        (0.213534, 0.260567),
        (0.14062, 0.237442),
        (0.108711, 0.228275),
        (0.0793788, 0.214702),
        (0.0816697, 0.211935),
    ],
    "CPE3 elastic, linear field": [
        (0.11228, 0.100741),
        (0.0749564, 0.0908542),
        (0.0669673, 0.0944471),
    ],
    "CPE8R elastic, beyond the table": [
        (0.331517, 0.334939),
        (0.178408, 0.292958),
        (0.161619, 0.268257),
        (0.0957758, 0.245759),
        (0.151761, 0.223589),
    ],
    "CPE8R orthotropic, linear field": [
        (0.220129, 0.682311),
        (-0.00872537, 0.592861),
        (0.128622, 0.556738),
        (-0.024316, 0.510528),
        (0.206676, 0.491207),
    ],
    "CPE8R flow, loaded then heated": [
        (0.0673553, 0.0352282),
        (0.0362958, 0.0160012),
        (0.0387405, 0.015562),
        (0.0373419, 0.016573),
        (0.0739787, 0.00428373),
    ],
    "CPE6 flow, loaded then heated": [
        (0.0500589, 0.0399007),
        (0.0353171, 0.0339127),
        (0.0296813, 0.0357747),
        (0.0247405, 0.0378761),
        (0.0218175, 0.0408037),
    ],
    "CPE3 flow, heated and cooled": [
        (0.00518111, 0.00498898),
        (0.00346806, 0.00309048),
        (0.00413668, 0.00242795),
    ],
    "CPE8R flow, pulled then heated": [
        (0.02, -0.0172886),
        (0.02, -0.0184586),
        (0.02, -0.0192945),
        (0.02, -0.0197498),
        (0.02, -0.0199154),
    ],
    "CPE8 flow under heat, reversed": [
        (-0.004, -0.00222581),
        (-0.004, 0.0005048),
        (-0.004, 0.00349869),
        (-0.004, 0.00611782),
        (-0.004, 0.00773791),
    ],
    "CPE6 flow, linear field, pulled": [
        (0.02, -0.00452681),
        (0.02, 0.0010782),
        (0.02, 0.00784025),
        (0.02, 0.0154112),
        (0.02, 0.0237723),
    ],
    "CPS8R flow, homogeneous": [
        (0.016, 1.14987e-16),
        (0.016, 0.00176744),
        (0.016, 0.00353488),
        (0.016, 0.00530231),
        (0.016, 0.00706975),
    ],
    "CPS3 elastic, homogeneous": [(0.01, 1.35742e-16), (0.01, 0.00669817), (0.01, 0.0133963)],
}


@pytest.mark.parametrize("name", DECKS)
def test_displacements_are_those_of_calculix(name: str, tmp_path: Path) -> None:
    path = tmp_path / "job.inp"
    path.write_text(DECKS[name])
    model = ct.read(path)
    frame = ct.solve(model, threads=1).frames[-1]
    nodes = np.sort(model.mesh.nodes_of("RIGHT"))
    want = np.array(BY_CALCULIX[name])
    found = frame.U[nodes]
    assert np.abs(found - want).mean() < 1e-5 * np.abs(want).max()

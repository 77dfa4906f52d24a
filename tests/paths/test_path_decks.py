"""The cards of paths and stability, by decks of a few lines."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import corota as ct
from corota.model.paths import ArcLength
from corota.model.steps import Buckle
from support.frames import euler_load

if TYPE_CHECKING:
    from pathlib import Path


def column_deck(step: str, n: int = 40) -> str:
    """Cantilever column 100 x 2 of CPS8 cells along x, E = 1000, with Euler's linear strain."""
    nodes, cells, lines = {}, [], ["*NODE, NSET=ALL"]
    for i in range(2 * n + 1):
        for j in range(5):
            if i % 2 == 0 or j % 2 == 0:
                nodes[i, j] = len(nodes) + 1
                lines.append(f"{len(nodes)}, {50.0 * i / n}, {0.5 * j}")
    lines.append("*ELEMENT, TYPE=CPS8, ELSET=EALL")
    offsets = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    for i in range(0, 2 * n, 2):
        for j in (0, 2):
            cells.append([nodes[i + a, j + b] for a, b in offsets])
            lines.append(f"{len(cells)}, " + ", ".join(map(str, cells[-1])))
    lines += ["*NSET, NSET=CLAMP", *(f"{nodes[0, j]}," for j in range(5))]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "1000., 0."]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=M, LOCAL STRAIN=LINEAR", "1."]
    lines += ["*BOUNDARY", "CLAMP, 1, 2"]
    shares = {0: 1 / 12, 1: 1 / 3, 2: 1 / 6, 3: 1 / 3, 4: 1 / 12}
    loads = "".join(f"{nodes[2 * n, j]}, 1, {-w}\n" for j, w in shares.items())
    tip = nodes[2 * n, 2]
    return "\n".join(lines) + "\n" + step.format(loads=loads, tip=tip)


def read(folder: Path, step: str) -> ct.Model:
    path = folder / "column.inp"
    path.write_text(column_deck(step))
    return ct.read(path)


BUCKLE = "*STEP\n*BUCKLE\n3\n*CLOAD\n{loads}*END STEP\n"


def test_buckle_card_gives_the_euler_loads(tmp_path: Path) -> None:
    model = read(tmp_path, BUCKLE)
    assert isinstance(model.steps[0], Buckle)
    factors = ct.solve(model).modes[0].factors
    assert factors[0] == pytest.approx(euler_load(), rel=2e-3)
    assert factors[1] / factors[0] == pytest.approx(9.0, rel=5e-3)


def test_buckling_factors_stand_in_the_dat_file(tmp_path: Path) -> None:
    """As CalculiX prints them, without a print request."""
    model = read(tmp_path, BUCKLE)
    results = ct.solve(model, observers=[ct.JobFiles(tmp_path)])
    text = (tmp_path / "column.dat").read_text()
    assert "B U C K L I N G   F A C T O R   O U T P U T" in text
    rows = [line.split() for line in text.splitlines() if line.strip()[:1].isdigit()]
    assert [int(row[0]) for row in rows] == [1, 2, 3]
    assert [float(row[1]) for row in rows] == pytest.approx(results.modes[0].factors, rel=1e-6)


def test_buckling_keeps_the_preload_and_takes_its_own_load(tmp_path: Path) -> None:
    preload = "*STEP, NLGEOM\n*STATIC\n*CLOAD\n{tip}, 1, -0.08\n*END STEP\n"
    step = BUCKLE.replace("*STEP", "*STEP, PERTURBATION")
    model = read(tmp_path, preload + step)
    factor = ct.solve(model).modes[0].factors[0]
    assert factor == pytest.approx(euler_load() - 0.08, rel=4e-3)


def test_buckling_without_perturbation_leaves_the_preload_out(tmp_path: Path) -> None:
    """As CalculiX; the Euler load is the load of the step alone, whatever came before."""
    preload = "*STEP, NLGEOM\n*STATIC\n*CLOAD\n{tip}, 1, -0.08\n*END STEP\n"
    model = read(tmp_path, preload + BUCKLE)
    assert any("without load" in note for note in model.notes)
    factor = ct.solve(model).modes[0].factors[0]
    assert factor == pytest.approx(euler_load(), rel=4e-3)


def test_riks_card_follows_the_path_to_its_ends(tmp_path: Path) -> None:
    """First arc .02 of a period 2: an hundredth; the load factor ends it."""
    step = "*STEP, NLGEOM, INC=30\n*STATIC, RIKS\n.02, 2., , .2, .3\n*CLOAD\n{loads}*END STEP\n"
    model = read(tmp_path, step)
    static = model.steps[0]
    assert static.path == ArcLength(factor=0.3, increments=30)
    assert (static.first_increment, static.largest_increment) == pytest.approx((0.01, 0.1))
    results = ct.solve(model)
    assert results.frames[1].factor == pytest.approx(0.01)
    assert results.frames[-1].factor == pytest.approx(0.3)
    assert [p.kind for p in results.critical_points] == ["bifurcation"]
    assert results.critical_points[0].factor == pytest.approx(euler_load(), rel=2e-3)


def test_riks_ends_at_a_displacement_or_after_its_increments(tmp_path: Path) -> None:
    step = "*STEP, NLGEOM, INC=4\n*STATIC, RIKS\n{more}*CLOAD\n{loads}*END STEP\n"
    model = read(tmp_path, step.replace("{more}", "0.01\n"))
    assert ct.solve(model).frames[-1].increment == 4
    model = read(tmp_path, step.replace("{more}", ".01,,,,, {tip}, 1, -0.002\n"))
    last = ct.solve(model).frames[-1]
    tip = int(model.steps[0].path.displacement[0])
    index = int((model.mesh.node_labels == tip).argmax())
    assert last.U[index, 0] == pytest.approx(-0.002)


def test_controls_set_tolerance_and_iterations(tmp_path: Path) -> None:
    cards = (
        "*CONTROLS, PARAMETERS=FIELD\n1e-11, 1.\n"
        "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n4, 8, 9, 16, 7\n"
        "*STEP, NLGEOM\n*STATIC\n*CLOAD\n{tip}, 1, -0.01\n*END STEP\n"
        "*CONTROLS, RESET\n*STEP, NLGEOM\n*STATIC\n*END STEP\n"
    )
    model = read(tmp_path, cards)
    one, two = model.steps
    assert (one.tolerance, one.max_iterations) == (1e-11, 7)
    assert (two.tolerance, two.max_iterations) == (1e-9, 16)
    assert any("*CONTROLS" in note for note in model.notes)


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ("*STEP\n*BUCKLE\n0\n*END STEP\n", "at least one factor"),
        ("*STEP\n*STATIC, RIKS\n-1.\n*END STEP\n", "first arc must be > 0"),
        ("*STEP\n*STATIC, RIKS\n1.,,,,,{tip}\n*END STEP\n", "degree of freedom"),
        ("*STEP\n*STATIC, RIKS\n1.,,,,,{tip},4,1.\n*END STEP\n", "1, 2 or 6"),
        ("*CONTROLS, PARAMETERS=SPEED\n*STEP\n*STATIC\n*END STEP\n", "must be one of"),
        (
            "*STEP\n*STATIC\n*END STEP\n*STEP, PERTURBATION\n*STATIC\n*END STEP\n",
            "PERTURBATION",
        ),
    ],
)
def test_bad_lines_are_named(tmp_path: Path, step: str, message: str) -> None:
    with pytest.raises(ct.DeckError, match=message):
        read(tmp_path, step)


def test_an_unknown_node_at_the_end_of_a_path_is_named(tmp_path: Path) -> None:
    step = "*STEP\n*STATIC, RIKS\n1.,,,,,99999,1,1.\n*CLOAD\n{loads}*END STEP\n"
    with pytest.raises(ct.InputError, match="99999"):
        ct.solve(read(tmp_path, step))

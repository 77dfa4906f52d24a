"""Forces per length on beams and trusses: ``PX`` and ``PY`` of ``*DLOAD``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import pytest

import corota as ct

E, WIDTH, HEIGHT, LENGTH = 210000.0, 0.1, 0.2, 4.0
AREA, INERTIA = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12.0


def read(path: Path, n: int, load: str, density: str = "*DENSITY\n7.8E-9\n") -> ct.Model:
    nodes = "".join(f"{i + 1}, {LENGTH * i / n}, 0.\n" for i in range(n + 1))
    lines = "".join(f"{i + 1}, {i + 1}, {i + 2}\n" for i in range(n))
    path.write_text(
        f"*NODE\n{nodes}*ELEMENT, TYPE=B31, ELSET=E\n{lines}*MATERIAL, NAME=M\n"
        f"*ELASTIC\n{E}, 0.\n{density}*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n"
        f"{WIDTH}, {HEIGHT}\n0., 0., -1.\n*BOUNDARY\n1, 1, 6\n*STEP\n*STATIC\n"
        f"*DLOAD\n{load}\n*END STEP\n"
    )
    return ct.read(path)


def test_forces_per_length_bend_and_stretch(tmp_path: Path) -> None:
    """q L^2 / 2 E A along the beam; across it q L^4 / 8 E I and the shear, with any elements."""
    frame = ct.solve(read(tmp_path / "a.inp", 4, "E, PX, 3."), threads=1).frames[-1]
    assert frame.U[-1, 0] == pytest.approx(3.0 * LENGTH**2 / (2.0 * E * AREA), rel=1e-9)
    bending = 3.0 * LENGTH**4 / (8.0 * E * INERTIA)
    shear = 3.0 * LENGTH**2 / (2.0 * 0.5 * E * AREA * 5.0 / 6.0)
    for n in (1, 4, 8):
        frame = ct.solve(read(tmp_path / "a.inp", n, "E, PY, 3."), threads=1).frames[-1]
        assert frame.U[-1, 1] == pytest.approx(bending + shear, rel=1e-9)
        assert frame.RF[:, 1].sum() == pytest.approx(-3.0 * LENGTH, rel=1e-12)


def test_the_pressure_of_calculix_is_a_force_per_length(tmp_path: Path) -> None:
    """``P2``, -1 there on 8 quadratic beams of this section: 0.228952 at the end for PY = width."""
    frame = ct.solve(read(tmp_path / "a.inp", 32, f"E, PY, {WIDTH}"), threads=1).frames[-1]
    assert frame.U[-1, 1] == pytest.approx(0.228952, rel=2e-3)


@pytest.mark.parametrize(
    ("load", "density", "words"),
    [
        ("E, P2, 1.", "", "give PX and PY, forces per length"),
        ("E, P1, 1.", "", "pressures on their width in CalculiX"),
        ("E, PZ, 1.", "", "no load out of its plane"),
        ("E, PYNU, 1.", "", "no user subroutine is called"),
        (", PY, 1.", "", "an element number or a set is missing"),
    ],
)
def test_loads_that_lines_do_not_take(tmp_path: Path, load: str, density: str, words: str) -> None:
    with pytest.raises(ct.DeckError, match=words):
        read(tmp_path / "a.inp", 2, load, density)


def test_planar_elements_take_no_force_per_length(tmp_path: Path) -> None:
    path = tmp_path / "a.inp"
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1)
    model = ct.Model(mesh)
    model.section(element="Q4", material=ct.Elastic(E=E, rho=1.0))
    model.fix("left")
    model.steps.append(ct.Static())
    model.steps[0].gravity(0.0, -1.0)
    ct.write(model, path)
    text = path.read_text()
    assert "GRAV" in text
    start = text.index("*DLOAD")
    end = text.index("*", start + 1)
    path.write_text(text[:start] + "*DLOAD\nall, PX, 1.\n" + text[end:])
    with pytest.raises(ct.DeckError, match="element 1 is none"):
        ct.read(path)

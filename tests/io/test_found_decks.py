"""Cards of decks found in public repositories that were refused or misread."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

#: A square of side 1; a force of 1 stretches it by 1e-3.
BLOCK = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE={element}, ELSET=EALL
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
{section}, ELSET=EALL, MATERIAL=M
1.
{model}*BOUNDARY
1, 1, 2
2, 2
4, 1
{step}
*CLOAD
2, 1, .5
3, 1, .5
{output}*END STEP
"""
PLAIN = {
    "element": "CPS4",
    "section": "*SOLID SECTION",
    "model": "",
    "step": "*STEP\n*STATIC",
    "output": "",
}


def read(path: Path, **parts: str) -> ct.Model:
    (path / "deck.inp").write_text(BLOCK.format(**{**PLAIN, **parts}))
    return ct.read(path / "deck.inp")


@pytest.mark.parametrize(
    ("parts", "note"),
    [
        ({"step": "*STEP\n*STATIC\n1., 1., 1e-5, .25"}, "is reduced to the largest, 0.25"),
        ({"step": "*STEP, NLGEOM=OFF\n*STATIC"}, ""),
        ({"model": "*SURFACE, NAME=UNUSED\n"}, "surface UNUSED is empty"),
        ({"element": "M3D4", "section": "*MEMBRANE SECTION, OFFSET=0."}, "OFFSET is ignored"),
        ({"output": "*CONTACT PRINT, SET=NALL, FREQUENCY=10\nCDIS\n"}, "SET is ignored"),
    ],
)
def test_what_calculix_takes_is_taken(parts: dict[str, str], note: str, tmp_path: Path) -> None:
    model = read(tmp_path, **parts)
    assert any(note in text for text in model.notes) or not note
    frame = ct.solve(model, threads=1).frames[-1]
    np.testing.assert_allclose(frame.U[[1, 2], 0], 1e-3, rtol=1e-9)


def test_nlgeom_on_is_nonlinear(tmp_path: Path) -> None:
    assert read(tmp_path, step="*STEP, NLGEOM=ON\n*STATIC").steps[0].nlgeom
    assert not read(tmp_path, step="*STEP, NLGEOM=OFF\n*STATIC").steps[0].nlgeom


def test_an_empty_surface_is_refused_where_it_is_used(tmp_path: Path) -> None:
    with pytest.raises(ct.DeckError, match="surface UNUSED has no edges"):
        read(tmp_path, model="*SURFACE, NAME=UNUSED\n", output="*DSLOAD\nUNUSED, P, 1.\n")


BEAM = """{head}*NODE
1, 0., 0.
2, 1., 0.
*ELEMENT, TYPE={element}, ELSET=E
1, 1, 2
*MATERIAL, NAME=M
*ELASTIC
1000., 0.
*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION={section}
{sizes}
0., 0., 1.
*BOUNDARY
1, 1, 6
*STEP
*STATIC{solver}
*CLOAD
2, 1, 1.
*END STEP
"""
DECK = {"head": "", "element": "B31", "section": "CIRC", "sizes": ".4", "solver": ""}


@pytest.mark.parametrize(
    ("parts", "area"),
    [
        ({"section": "RECTANGULAR", "sizes": ".4, .5"}, 0.2),
        ({"section": "CIRCULAR", "sizes": ".4, .4"}, 0.04 * np.pi),
        ({"head": "** DIALECT: calculix\n"}, 0.04 * np.pi),
        ({"solver": ", SOLVER=SPOOLES"}, 0.04 * np.pi),
        ({"element": "B31R"}, 0.04 * np.pi),
        ({"head": "** DIALECT: abaqus\n"}, 0.16 * np.pi),
    ],
)
def test_sizes_of_sections(parts: dict[str, str], area: float, tmp_path: Path) -> None:
    """One number of a circle: the diameter in CalculiX, the radius in Abaqus."""
    (tmp_path / "deck.inp").write_text(BEAM.format(**{**DECK, **parts}))
    frame = ct.solve(ct.read(tmp_path / "deck.inp"), threads=1).frames[-1]
    assert frame.U[1, 0] == pytest.approx(1.0 / (1000.0 * area))


def test_one_number_of_a_circle_is_refused_if_the_program_is_unknown(tmp_path: Path) -> None:
    (tmp_path / "deck.inp").write_text(BEAM.format(**DECK))
    with pytest.raises(ct.DeckError, match="DIALECT"):
        ct.read(tmp_path / "deck.inp")


def test_a_point_mass_on_a_spinning_ring_pulls_outward_only(tmp_path: Path) -> None:
    """Mean radial displacement of a thin ring: ``F r / 2 pi E A``; CalculiX has no axial force."""
    deck = tmp_path / "deck.inp"
    deck.write_text(
        "*NODE\n1, 10., 4.\n2, 10.1, 4.\n3, 10.1, 4.1\n4, 10., 4.1\n"
        "*ELEMENT, TYPE=CAX4, ELSET=E\n1, 1, 2, 3, 4\n"
        "*ELEMENT, TYPE=MASS, ELSET=MS\n2, 1\n3, 2\n4, 3\n5, 4\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
        "*MASS, ELSET=MS\n.01\n*BOUNDARY\n1, 2\n2, 2\n*STEP\n*STATIC\n"
        "*DLOAD\nMS, CENTRIF, 2., 0., 0., 0., 0., 1., 0.\n*END STEP\n"
    )
    frame = ct.solve(ct.read(deck), threads=1).frames[-1]
    force = 4 * 0.01 * 2.0 * 10.05
    assert frame.U[:, 0].mean() == pytest.approx(
        force * 10.05 / (2 * np.pi * 1000.0 * 0.01), rel=1e-3
    )
    assert frame.RF[:, 1].sum() == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(frame.F.sum(axis=0)[:2], [force, 0.0], atol=1e-12)


@pytest.mark.parametrize("direct", [False, True])
def test_a_sweep_goes_on_past_an_undamped_resonance(direct: bool) -> None:
    """``F / (k - m w^2)`` at all other frequencies; the frequency itself has no answer."""
    model = ct.Model(ct.mesh.line([(0.0, 0.0), (1.0, 0.0)], n=1))
    model.spring("all", 100.0)
    model.point_mass("end", 4.0)
    model.fix("start")
    model.fix("end", x=None, y=0.0)
    step = ct.SteadyState(lowest=0.1, highest=2.0, points=3, direct=direct, bias=1.0)
    step.force("end", x=1.0)
    results = ct.solve(model, [ct.Frequency(modes=1), step], threads=1)
    steady = [i for i, frame in enumerate(results.frames) if frame.scalars.get("frequency")]
    own = 5.0 / (2.0 * np.pi)
    f = results.history("frequency")[steady]
    np.testing.assert_allclose(f, [0.1, (0.1 + own) / 2, (own + 2.0) / 2, 2.0])
    exact = np.abs(1.0 / (100.0 - 4.0 * (2.0 * np.pi * f) ** 2))
    np.testing.assert_allclose(results.history("UA1", at="end")[steady], exact, rtol=1e-8)
    assert any("is left out" in note for note in results.notes)

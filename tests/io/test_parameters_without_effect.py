"""Parameters that change nothing, cards of inertia, and curves that decks of CAE programs have."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.errors import DeckError

if TYPE_CHECKING:
    from pathlib import Path

DECK = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
*ELEMENT, TYPE=B21, ELSET=E
1, 1, 2
*ELEMENT, TYPE=MASS, ELSET=MS
2, 2
*MASS, ELSET=MS{mass}
{m}
{more}*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1e-9
{damping}*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT
1., .1
0., 0., -1.
*BOUNDARY
1, 1, 6
{amplitude}*STEP, INC=10000
*DYNAMIC, DIRECT{dynamic}
.001, .01
{controls}*CLOAD{load}
2, 2, .01
*END STEP
"""
DAMPING = "*DAMPING, ALPHA=0.1\n"
PLAIN = {
    "mass": "", "m": ".1", "more": "", "damping": DAMPING, "amplitude": "", "dynamic": "",
    "controls": "", "load": "",
}  # fmt: skip


def read(tmp_path: Path, **words: str) -> ct.Model:
    path = tmp_path / "job.inp"
    path.write_text(DECK.format(**{**PLAIN, **words}))
    return ct.read(path)


@pytest.mark.parametrize(
    "words",
    [
        {"mass": ", ALPHA=0."},
        {"damping": "*DAMPING, ALPHA=0.1, COMPOSITE=0., STRUCTURAL=0\n"},
        {"dynamic": ", TIME INTEGRATOR=HHT-TF"},
        {"controls": "*CONTROLS, PARAMETERS=FIELD, FIELD=DISPLACEMENT\n.005, 1.\n"},
    ],
)
def test_same_answer(tmp_path: Path, words: dict[str, str]) -> None:
    plain = ct.solve(read(tmp_path), fields=False).frames[-1].U
    np.testing.assert_array_equal(
        ct.solve(read(tmp_path, **words), fields=False).frames[-1].U, plain
    )


@pytest.mark.parametrize(
    "words",
    [
        {"mass": ", ALPHA=.1"},
        {"damping": "*DAMPING, COMPOSITE=.1\n"},
        {"damping": "*DAMPING, STRUCTURAL=1\n"},
    ],
)
def test_other_values_are_refused(tmp_path: Path, words: dict[str, str]) -> None:
    with pytest.raises(DeckError, match="is not supported"):
        read(tmp_path, **words)


@pytest.mark.parametrize(
    ("integrator", "application"),
    [("HHT-MD", "MODERATE DISSIPATION"), ("BWE", "QUASI-STATIC")],
)
def test_integrators_are_those_of_applications(
    tmp_path: Path, integrator: str, application: str
) -> None:
    found, expected = (
        ct.solve(read(tmp_path, dynamic=text), fields=False).frames[-1].U
        for text in (f", TIME INTEGRATOR={integrator}", f", APPLICATION={application}")
    )
    np.testing.assert_array_equal(found, expected)


PLATE = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=E
1, 1, 2, 3, 4
*SURFACE, NAME=TOP
E, S3
*ORIENTATION, NAME=O
0., 1., 0., -1., 0., 0.
3, 30.
*ORIENTATION, NAME=C, SYSTEM=CYLINDRICAL
0., 0., 0., 0., 0., 1.
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
1, 1, 2
2, 1, 2
*STEP
*STATIC
*DSLOAD, FOLLOWER=NO, ORIENTATION={name}
TOP, TRVEC, 4., 1., 1., 0.
*END STEP
"""


def test_direction_of_a_traction_in_other_axes(tmp_path: Path) -> None:
    """The axes are turned by 90 + 30 degrees, and the direction lies at 45 in them."""
    path = tmp_path / "job.inp"
    path.write_text(PLATE.format(name="O"))
    force = -ct.solve(ct.read(path), fields=False).frames[-1].RF[:, :2].sum(axis=0)
    angle = np.radians(165.0)
    np.testing.assert_allclose(force, [4.0 * np.cos(angle), 4.0 * np.sin(angle)], rtol=1e-9)
    for name, text in (("C", "not rectangular"), ("P", "no orientation named")):
        path.write_text(PLATE.format(name=name))
        with pytest.raises(DeckError, match=text):
            ct.read(path)


def test_rotary_inertia(tmp_path: Path) -> None:
    """A cantilever with a mass and an inertia at its end: two frequencies by hand."""
    more = "*ELEMENT, TYPE=ROTARYI, ELSET=RI\n3, 2\n*ROTARY INERTIA, ELSET=RI\n9., 9., .02\n"
    model = read(tmp_path, more=more, damping="")
    found = (
        np.array(ct.solve(model, ct.Frequency(modes=2), fields=False).modes[-1].factors)
        * 2.0
        * np.pi
    )
    bending, shear = 1000.0 * 0.1**3 / 12.0, 1000.0 / 2.6 * 0.1 * 5.0 / 6.0
    flexibility = np.array(
        [[1 / 3 / bending + 1 / shear, 0.5 / bending], [0.5 / bending, 1 / bending]]
    )
    values = np.linalg.eigvals(flexibility @ np.diag([0.1, 0.02]))
    np.testing.assert_allclose(np.sort(found), np.sort(1.0 / np.sqrt(values)), rtol=1e-4)
    again = tmp_path / "again.inp"
    ct.write(model, again)
    written = ct.read(again)
    assert [(m.mass, m.inertia) for m in written.point_masses] == [
        (m.mass, m.inertia) for m in model.point_masses
    ]


def test_modulated_amplitude(tmp_path: Path) -> None:
    """A0 + A sin(w1 (t - t0)) sin(w2 (t - t0)) after t0."""
    card = "*AMPLITUDE, NAME=A, DEFINITION=MODULATED\n.5, 2., .002, 900., 70.\n"
    model = read(tmp_path, amplitude=card, load=", AMPLITUDE=A")
    time = np.linspace(0.002, 0.01, 300)
    exact = 0.5 + 2.0 * np.sin(900.0 * (time - 0.002)) * np.sin(70.0 * (time - 0.002))
    table = model.amplitudes["A"]
    np.testing.assert_allclose(np.interp(time, table.time, table.value), exact, atol=1e-4)
    assert np.interp(0.001, table.time, table.value) == pytest.approx(0.5)

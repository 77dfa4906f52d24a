"""What nothing holds is refused by name, whatever the loads: never a state that ran away.

The motions that are free are known by construction. Decks are finds of attacks with random
models; all but two of them ended with exit code 0, with residuals up to 1.0 and bodies up to
1e10 away.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.model.steps import Static
from support.models import cell

DECKS = Path(__file__).parent / "decks"

#: Exit code and words of the message.
REFUSED = {
    "free_bodies": (3, "the part with element 7 can turn about"),
    "free_in_x": (3, "part with element 1 can move in x"),
    "free_with_contact": (3, "the part with element 1 can move in x"),
    "loose_tie": (3, "parts with element 1, 2 can move in x"),
    "stabilize_gap_flies": (4, "stopped at"),
    "stabilized_pulled_away": (4, "part with element 2 can move in y"),
}


def run(name, folder, capsys):
    shutil.copy(DECKS / f"{name}.inp", folder / "job.inp")
    code = main(["run", str(folder / "job.inp"), "--output", str(folder), "--quiet"])
    return code, capsys.readouterr().err


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_decks_with_free_motions_are_refused(name, tmp_path, capsys):
    code, text = run(name, tmp_path, capsys)
    wanted, words = REFUSED[name]
    assert code == wanted, text
    assert words in text


@pytest.mark.parametrize("name", ["moments_of_rounding", "stabilize_touching_flies"])
def test_decks_that_end_do_so_in_equilibrium(name, tmp_path, capsys):
    code, text = run(name, tmp_path, capsys)
    assert code == 0, text
    rows = (tmp_path / "job.csv").read_text().splitlines()
    names = rows[0].replace('"', "").split(",")
    residual = [float(row.split(",")[names.index("residual")] or 0.0) for row in rows[2:]]
    assert max(residual) <= 1e-6


def block(element="Q4I", shift=0.0):
    mesh = ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(element), "alternate")
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=2e5, nu=0.3))
    return model


@pytest.mark.parametrize("element", ["T3", "Q4I", "Q4D", "Q8", "T6"])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_pressure_that_follows_holds_nothing(element, size):
    """The load stiffness of a free body is none; its LU has no zero pivot."""
    model = block(element)
    model.fix("bottom", x=None)  # y alone
    model.pressure("top", size)
    with pytest.raises(ct.SingularError, match="part with element 1 can move in x; "):
        ct.solve(model, Static(), threads=1, fields=False)


def test_a_hinged_body_can_turn_about_its_hinge():
    model = block()
    corner = int(np.flatnonzero((model.mesh.points == 0.0).all(axis=1))[0])
    model.fix([corner])
    model.pressure("top", 1.0)
    with pytest.raises(ct.SingularError, match=r"element 1 can turn about \(0, 0\)"):
        ct.solve(model, Static(), threads=1, fields=False)


def test_a_stiffness_beyond_double_precision_is_said_to_be_so():
    """A stiff block on one 1e17 times softer: whether it is held, rounding hides."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 3, 2, "quad4")
    model = ct.Model(mesh)
    stiff = mesh.points[mesh.cells[0].nodes].mean(axis=1)[:, 0] < 1.0
    for E, cells in ((2e5, stiff), (2e-12, ~stiff)):
        material = ct.Elastic(E=E, nu=0.3)
        model.section(np.flatnonzero(cells), element="Q4I", material=material)
    model.fix("right")
    model.force("left", x=1e-12, per_node=True)
    with pytest.raises(ct.SingularError, match="rounding hides that in double precision"):
        ct.solve(model, Static(), threads=1, fields=False)


def test_a_body_that_only_contact_holds_does_not_slide_away(tmp_path, capsys):
    """Linear contact whose normals rounding tilts: it ended 756 sizes away with exit 0."""
    code, text = run("slides_away", tmp_path, capsys)
    assert code in (0, 3, 4), text
    if code == 0:
        frame = ct.read_results(tmp_path / "job.vtkhdf").frames[-1]
        assert np.abs(frame.U).max() < 0.0176

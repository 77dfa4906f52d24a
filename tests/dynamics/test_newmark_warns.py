"""Newmark's rule makes energy where contact opens and closes: it says so wherever results are read.

The energy of an elastic ring without friction is constant; the energy-momentum scheme keeps it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.report.chunk import unpack
from corota.report.content import content_of_job
from corota.report.records import find_job

WORDS = ("gained by step 1", "newmark does not conserve energy", "scheme='energy_momentum'")


def ring() -> ct.Model:
    """An elastic ring that flies to a wall."""
    model = ct.Model(ct.mesh.annulus(0.8, 1.0, 2, 24, center=(0.0, 1.02)))
    material = ct.Elastic(E=2e3, nu=0.3, rho=1.0)
    model.section("all", element="Q4I", material=material, local_strain="green_lagrange")
    model.contact("outer", ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0)))
    model.velocity(y=-0.5)
    return model


def test_python_warns() -> None:
    with pytest.warns(UserWarning, match="does not conserve energy where contact opens"):
        results = ct.solve(ring(), ct.Dynamic(period=0.8, increments=20, scheme="newmark"))
    note = next(n for n in results.notes if n.startswith("energy balance"))
    assert all(word in note for word in WORDS)
    assert max(f.scalars["energy balance error"] for f in results.frames) > 0.1


def test_the_scheme_it_names_keeps_the_energy() -> None:
    step = ct.Dynamic(period=0.8, increments=20, scheme="energy_momentum")
    results = ct.solve(ring(), step)
    assert not any(n.startswith("energy balance") for n in results.notes)
    assert max(abs(f.scalars["energy balance error"]) for f in results.frames) < 1e-9


def deck(card: str) -> str:
    """The ring as a deck."""
    mesh = ring().mesh
    rows = ["*HEADING", "ring", "*NODE"]
    rows += [f"{i + 1}, {x!r}, {y!r}" for i, (x, y) in enumerate(mesh.points.tolist())]
    rows += ["*ELEMENT, TYPE=CPS4I, ELSET=ring"]
    rows += [
        f"{i + 1}, " + ", ".join(str(n + 1) for n in cell)
        for i, cell in enumerate(mesh.cells[0].nodes.tolist())
    ]
    rows += ["*NSET, NSET=all, GENERATE", f"1, {mesh.n_nodes}", "*SURFACE, NAME=outer"]
    rows += [f"{cell + 1}, S{side + 1}" for cell, side in mesh.edge_sets["outer"].tolist()]
    base = mesh.n_nodes + 1
    rows += ["*NODE", f"{base}, 0., -1."]
    rows += ["*SURFACE, NAME=wall, TYPE=SEGMENTS", "START, -9., 0.", "LINE, 9., 0."]
    rows += [f"*RIGID BODY, ANALYTICAL SURFACE=wall, REF NODE={base}"]
    rows += ["*MATERIAL, NAME=m", "*ELASTIC", "2000., 0.3", "*DENSITY", "1."]
    rows += ["*SOLID SECTION, ELSET=ring, MATERIAL=m, LOCAL STRAIN=GREEN LAGRANGE", "1."]
    rows += ["*SURFACE INTERACTION, NAME=smooth", "*CONTACT PAIR, INTERACTION=smooth"]
    rows += ["outer, wall", "*BOUNDARY", f"{base}, 1, 2", f"{base}, 6, 6"]
    rows += ["*INITIAL CONDITIONS, TYPE=VELOCITY", "all, 2, -0.5"]
    rows += ["*STEP, NLGEOM, INC=100", card, "0.04, 0.8", "*END STEP"]
    return "\n".join(rows) + "\n"


def reported(job: Path, capsys: pytest.CaptureFixture[str]) -> tuple[str, str]:
    """What the console says of a run, and the notes of its report."""
    out = job.parent / "out"
    assert main(["run", str(job), "-o", str(out)]) == 0
    said = " ".join("".join(capsys.readouterr()).split())
    page = content_of_job(find_job(out / job.stem))
    return said, " ".join(unpack(page.chunks["history"])[0]["notes"])


def test_console_and_report_show_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    job = tmp_path / "ring.inp"
    job.write_text(deck("*DYNAMIC, DIRECT, ALPHA=0."))
    for text in reported(job, capsys):
        assert "gained by step 1" in text
        assert "does not conserve energy where contact opens and closes" in text
        assert "*DYNAMIC, SCHEME=ENERGY MOMENTUM" in text
    # And what it names helps.
    job = tmp_path / "keeps.inp"
    job.write_text(deck("*DYNAMIC, DIRECT, SCHEME=ENERGY MOMENTUM"))
    for text in reported(job, capsys):
        assert "energy balance:" not in text


@pytest.mark.parametrize("other", ["ALPHA=-.1", "EXPLICIT", "APPLICATION=QUASI-STATIC"])
def test_the_scheme_takes_no_other_parameter(other: str, tmp_path: Path) -> None:
    job = tmp_path / "ring.inp"
    job.write_text(deck(f"*DYNAMIC, SCHEME=ENERGY MOMENTUM, {other}"))
    with pytest.raises(ct.InputError, match="does not belong to SCHEME=ENERGY MOMENTUM"):
        ct.read(job)


def test_smooth_contact_is_not_blamed() -> None:
    """A bar that rests on a floor makes no energy, and nothing is said."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=3))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.0, rho=1.0))
    model.contact("bottom", ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0)))
    model.gravity(y=-1.0)
    model.fix([0], y=None)
    steps = [ct.Static(), ct.Dynamic(period=0.1, increments=10, scheme="newmark")]
    results = ct.solve(model, steps)
    assert not any(n.startswith("energy balance") for n in results.notes)
    assert np.abs(results.frames[-1].V).max() < 1e-6

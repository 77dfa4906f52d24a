"""Decks with masses, dashpots and damping: closed forms, the other program, refusals."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.io.deck.write.model import write_deck
from tests.dynamics.test_attachments import exact
from tests.dynamics.test_schemes import column
from tests.support.calculix import needs_ccx, run_ccx

HEAD = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=E1
1, 1, 2, 5, 4
*ELEMENT, TYPE=CPS4, ELSET=E2
2, 2, 3, 6, 5
*ELSET, ELSET=EALL
E1, E2
*NSET, NSET=TIP
3, 6
*BOUNDARY
1, 1, 2
4, 1, 2
2, 2, 2
3, 2, 2
5, 2, 2
6, 2, 2
*AMPLITUDE, NAME=ON
0., 1., 100., 1.
"""
STEP = """*STEP, NLGEOM, INC=100000
*DYNAMIC, DIRECT
.01, 2.
*CLOAD, AMPLITUDE=ON
3, 1, .05
6, 1, .05
*NODE PRINT, NSET=TIP
U
*EL PRINT, ELSET=EALL, TOTALS=YES
ELSE, ELKE, EVOL
*END STEP
"""
MASS = "*ELEMENT, TYPE=MASS, ELSET=EM\n11, 3\n12, 6\n*MASS, ELSET=EM\n2.\n"
DASH = "*ELEMENT, TYPE=DASHPOTA, ELSET=ED\n21, 1, 3\n22, 4, 6\n*DASHPOT, ELSET=ED\n\n4.,\n"


def material(number, rho, damping=""):
    return (
        f"*MATERIAL, NAME=M{number}\n*ELASTIC\n200., 0.\n*DENSITY\n{rho}\n{damping}"
        f"*SOLID SECTION, ELSET=E{number}, MATERIAL=M{number}\n1.\n"
    )


def deck(tmp_path, extra="", damping=("", ""), rho=1e-4):
    path = tmp_path / "job.inp"
    text = HEAD + material(1, rho, damping[0]) + material(2, rho, damping[1]) + extra + STEP
    path.write_text(text, encoding="ascii")
    return path


def tables(dat):
    """Rows of numbers of a ``.dat`` file."""
    rows = [line.split() for line in dat.read_text(encoding="ascii").splitlines() if line.strip()]
    return [[float(x) for x in row] for row in rows if row[0][-1].isdigit()]


ALL = "*DAMPING, ALPHA=1., BETA=.04\n"
CASES = {
    "mass": (MASS, ("", "")),
    "dashpot": (MASS + DASH, ("", "")),
    "damping": (MASS, (ALL, ALL)),
}


@needs_ccx
@pytest.mark.parametrize("case", CASES)
def test_deck_prints_what_calculix_prints(case, tmp_path):
    # CalculiX moves CPS4 in *DYNAMIC with half of its mass (its bricks and its frequencies agree
    # with ours): the point masses, which are right, outweigh the bar here.
    path = deck(tmp_path, *CASES[case])
    assert main(["run", str(path), "-o", str(tmp_path / "out"), "--quiet"]) == 0
    ours = tmp_path / "out" / "job.dat"
    run_ccx(tmp_path, "job")
    theirs = tmp_path / "job.dat"

    def titles(dat):
        lines = dat.read_text(encoding="ascii").splitlines()
        return [line for line in lines if line.strip() and not line.split()[0][-1].isdigit()]

    assert titles(ours) == titles(theirs)
    mine, other = tables(ours), tables(theirs)
    assert [len(row) for row in mine] == [len(row) for row in other]
    # Displacements, energies of elements, their sums; CalculiX stops at half a percent.
    for k, n in ((4, 1), (2, 3), (1, 3)):
        pair = [
            np.array([row[-1 if k < 4 else 1] for row in rows if len(row) == k])
            for rows in (mine, other)
        ]
        if k == 2:
            # Two elements in each of three tables.
            pair = [values.reshape(-1, 3, 2) for values in pair]
        else:
            pair = [values.reshape(-1, n, 1) for values in pair]
        size = np.abs(pair[1]).max(axis=(0, 2))
        assert (np.abs(pair[0] - pair[1]).max(axis=(0, 2)) <= 0.01 * size).all()


@pytest.mark.parametrize("case", CASES)
def test_deck_oscillates_as_in_closed_form(case, tmp_path):
    model = ct.read(deck(tmp_path, *CASES[case]))
    results = ct.solve(model, threads=1)
    time = np.array([f.time for f in results.frames[1:]])
    tip = np.array([f.U[model.mesh.nodes_of("TIP")[0], 0] for f in results.frames[1:]])
    # Stiffness 100, mass 4; dashpots of 8, or shares of 0.1 + 0.1.
    zeta = {"mass": 0.0, "dashpot": 0.2, "damping": 0.2}[case]
    assert np.abs(tip - exact(time, zeta)).max() <= 0.02 * 0.002


def test_damping_of_one_material_is_that_of_its_elements(tmp_path):
    model = ct.read(deck(tmp_path, MASS, (ALL.replace("1.,", "0.,"), "")))
    assert [s.material.rayleigh for s in model.sections] == [(0.0, 0.04), (0.0, 0.0)]
    assert any("materials differ in *DAMPING" in note for note in model.notes)
    results = ct.solve(model, threads=1)
    time = np.array([f.time for f in results.frames[1:]])
    tip = np.array([f.U[model.mesh.nodes_of("TIP")[0], 0] for f in results.frames[1:]])
    # A damper in parallel with one of two springs: x1 + x2 = x, k x1 + c dx1/dt = k x2.
    k, c, m, force = 200.0, 8.0, 4.0, 0.1
    matrix = np.array([[0.0, 1.0, 0.0], [-k / m, 0.0, k / m], [k / c, 0.0, -2.0 * k / c]])
    rest = np.linalg.solve(matrix, [0.0, -force / m, 0.0])
    values, vectors = np.linalg.eig(matrix)
    start = np.linalg.solve(vectors, -rest.astype(complex))
    want = rest[0] + (vectors @ (start[:, None] * np.exp(np.outer(values, time)))).real[0]
    assert np.abs(tip - want).max() <= 0.02 * 0.002
    balance = column(results, "energy balance")
    assert np.abs(balance).max() <= 0.01 * np.abs(column(results, "external work")).max()


def test_mass_damping_of_a_material_slows_its_elements():
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2))
    model.section("all", element="Q4I", material=ct.Elastic(E=10.0, rho=2.0, rayleigh=(0.5, 0.0)))
    model.velocity(x=1.0)
    keys = {"period": 2.0, "increments": 100}
    for scheme in ("newmark", "energy_momentum"):
        frame = ct.solve(model, ct.Dynamic(scheme=scheme, **keys), threads=1).frames[-1]
        assert frame.V[:, 0] == pytest.approx(np.exp(-0.5 * 2.0), rel=1e-4)
    with pytest.raises(ct.InputError, match="damping"):
        ct.solve(model, ct.Dynamic(period=0.1, scheme="central_difference"), threads=1)


def test_modal_steps_take_damping_of_materials():
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, rho=1.0, rayleigh=(0.1, 0.02)))
    model.fix("left")
    model.force("right", y=-0.01, per_node=True)
    modes = ct.Frequency(modes=3)
    keys = {"period": 5.0, "first_increment": 0.05}
    by_material = ct.solve(model, [modes, ct.ModalDynamic(**keys)], threads=1).frames[-1].U
    model.sections[0].material = ct.Elastic(E=100.0, rho=1.0)
    step = ct.ModalDynamic(rayleigh=(0.1, 0.02), **keys)
    by_step = ct.solve(model, [modes, step], threads=1).frames[-1].U
    assert np.abs(by_material - by_step).max() <= 1e-9 * np.abs(by_step).max()


BAD = [
    ("*ELEMENT, TYPE=MASS\n11, 3\n", "ELSET= is missing"),
    ("*ELEMENT, TYPE=MASS, ELSET=EM\n11, 3\n", "no *MASS, ELSET=EM gives"),
    ("*ELEMENT, TYPE=MASS, ELSET=EM\n11, 33\n*MASS, ELSET=EM\n1.\n", "node 33 is not defined"),
    (MASS.replace("2.", "-2."), "must be >= 0"),
    ("*MASS, ELSET=EM\n1.\n", "no *ELEMENT, TYPE=MASS with the set"),
    (MASS + "*MASS, ELSET=EM\n1.\n", "already has its value"),
    (DASH.replace("1, 3", "3, 3"), "node 3 occurs twice"),
    (DASH.replace("4.,", "4.,\n5., 10."), "no temperature and no frequency"),
]


@pytest.mark.parametrize(("cards", "reason"), BAD)
def test_wrong_attachments_of_decks_are_refused_with_the_place(cards, reason, tmp_path):
    with pytest.raises(ct.DeckError) as caught:
        ct.read(deck(tmp_path, cards))
    assert reason in str(caught.value)
    assert "job.inp:" in str(caught.value)


def test_weight_of_the_bending_stiffness_in_a_deck(tmp_path):
    path = tmp_path / "job.inp"
    text = HEAD + material(1, 1.0) + material(2, 1.0)
    opt = text.replace("TYPE=CPS4, ELSET=E1\n1, 1, 2, 5, 4", "TYPE=OPT, ELSET=E1\n1, 1, 2, 4")
    path.write_text(opt.replace("MATERIAL=M1", "MATERIAL=M1, BETA0=.01"), encoding="ascii")
    model = ct.read(path)
    assert [s.beta0 for s in model.sections] == [0.01, None]
    again = write_deck(model, tmp_path / "again.inp")
    assert [s.beta0 for s in ct.read(again).sections] == [0.01, None]
    for wrong in ("MATERIAL=M2, BETA0=.01", "MATERIAL=M2, BETA0=-1"):
        path.write_text(opt.replace("MATERIAL=M2", wrong), encoding="ascii")
        with pytest.raises(ct.DeckError, match=r"BETA0|beta0"):
            ct.read(path)

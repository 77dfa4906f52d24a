"""Rows of the print, status and convergence files, byte by byte as CalculiX 2.20 writes them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.errors import InputError
from corota.io.job import JobFiles
from corota.io.requests import Requests, due, in_force, last_of_steps
from corota.io.result_reader import read_results
from corota.io.tables.dat import check_requests, dat_blocks
from corota.io.tables.dat_numbers import fortran
from corota.io.tables.sta import CVG_HEAD, STA_HEAD, cvg_line, sta_failed, sta_line
from corota.model.steps import Output, Static
from corota.results.observer import Iteration

# Written by CalculiX 2.20 for a two-element cantilever (its numbers, not ours).
CCX_U = """
 displacements (vx,vy,vz) for set RIGHT and time  0.5000000E+00

       103 -4.073855E-03 -1.260847E-02  0.000000E+00
       106  4.010948E-03 -1.264208E-02  0.000000E+00
"""
CCX_RF = """
 forces (fx,fy,fz) for set LEFT and time  0.5000000E+00

       101  9.999842E-02  2.497163E-02  0.000000E+00
       104 -9.999843E-02  2.502837E-02  0.000000E+00

 total force (fx,fy,fz) for set LEFT and time  0.5000000E+00

       -1.000000E-08  5.000000E-02  0.000000E+00
"""
CCX_S = """
 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.5000000E+00

        11   1 -1.878138E+00 -5.437536E-01  5.562547E-02 -1.161176E+00  0.000000E+00  0.000000E+00
"""
CCX_E = """
 strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) for set EALL and time  0.5000000E+00

        11   1 -1.718361E-03 -3.163400E-06  7.831808E-04 -1.511937E-03  0.000000E+00  0.000000E+00
"""
CCX_ELSE = """
 internal energy (element, energy) for set EALL and time  0.5000000E+00

        11  2.548358E-04
        12  6.079169E-05

 total internal energy for set EALL and time  0.5000000E+00

        3.156275E-04
"""
CCX_EVOL = """
 total volume for set EALL and time  0.5000000E+00

        2.000000E-01
"""
CCX_PEEQ = """
 equivalent plastic strain (elem, integ.pnt.,pe)for set EALL and time  0.5000000E+00

        11   1  1.000000E-02
"""
CCX_ENER = """
 internal energy density (elem, integ.pnt.,energy) for set EALL and time  0.5000000E+00

        11   1  3.407118E-03
"""
CCX_STA = (
    "SUMMARY OF JOB INFORMATION\n"
    "  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME\n"
    "     1          1     3U    6  0.000000E+00  0.000000E+00  0.625000E-01\n"
    "     1          1     4     9  0.156250E-01  0.156250E-01  0.156250E-01\n"
)
CCX_CVG = (
    "SUMMARY OF C0NVERGENCE INFORMATION\n"
    "  STEP   INC  ATT   ITER     CONT.   RESID.        CORR.      RESID.      CORR.\n"
    "                              EL.    FORCE         DISP       FLUX        TEMP.\n"
    "                              (#)     (%)           (%)        (%)         (%)\n"
    "     1     1     1     2        0  0.7772E-02  0.2501E+00  0.0000E+00  0.0000E+00\n"
)


@pytest.fixture
def answer(fake):
    """Text of one request at half time."""

    def answer(model, output, frame=None):
        frame = frame or fake.state(model, 1, 2, 0.5, 0.5)
        model.steps[0].outputs = [output]
        return dat_blocks(model, [output], frame)

    return answer


def test_displacements_as_calculix(model, fake, answer):
    frame = fake.state(model, 1, 2, 0.5, 0.5)
    frame.U[model.mesh.node_sets["RIGHT"]] = [
        [-4.073855e-03, -1.260847e-02],
        [4.010948e-03, -1.264208e-02],
    ]
    assert answer(model, Output("node print", ("U",), "RIGHT"), frame) == CCX_U


def test_forces_are_internal_forces_as_calculix_prints_them(model, fake, answer):
    frame = fake.state(model, 1, 2, 0.5, 0.5)
    left = model.mesh.node_sets["LEFT"]
    frame.F[left, 0] = 0.5
    frame.RF[left] = [[9.999842e-02 - 0.5, 2.497163e-02, 0], [-9.999843e-02 - 0.5, 2.502837e-02, 0]]
    output = Output("node print", ("RF",), "LEFT", totals="yes")
    assert answer(model, output, frame) == CCX_RF
    only = Output("node print", ("RF",), "LEFT", totals="only")
    assert answer(model, only, frame) == CCX_RF[CCX_RF.index("\n total") :]


@pytest.mark.parametrize(("name", "wanted", "shear"), [("S", CCX_S, 1.0), ("E", CCX_E, 2.0)])
def test_tensors_as_calculix(model, name, wanted, shear, fake, answer):
    frame = fake.state(model, 1, 2, 0.5, 0.5)
    numbers = [float(t) for t in wanted.split()[-6:]]
    frame.fields[0].values[name][0, 0] = [*numbers[:3], shear * numbers[3]]
    text = answer(model, Output("el print", (name,), "EALL"), frame)
    assert text.startswith(wanted)
    assert len(text.splitlines()) == 3 + 8


def test_rotations_are_about_the_third_axis(model, answer):
    text = answer(model, Output("node print", ("UR",), "RIGHT"))
    assert text.startswith("\n rotations (rx,ry,rz) for set RIGHT and time  0.5000000E+00\n\n")
    assert text.splitlines()[-1].split()[:3] == ["106", "0.000000E+00", "0.000000E+00"]


def test_plastic_strain_of_an_elastic_material_is_zero(model, answer):
    text = answer(model, Output("el print", ("PEEQ",), "EALL"))
    rows = text.splitlines()[3:]
    assert len(rows) == 8
    assert all(row.split()[2] == "0.000000E+00" for row in rows)


def test_element_sums_as_calculix(model, fake, answer):
    frame = fake.state(model, 1, 2, 0.5, 0.5)
    block = frame.fields[0]
    block.volume[:] = 0.025
    block.values["ENER"][:] = np.array([[2.548358e-04], [6.079169e-05]]) / 0.1
    assert answer(model, Output("el print", ("ELSE",), "EALL", totals="yes"), frame) == CCX_ELSE
    assert answer(model, Output("el print", ("EVOL",), "EALL", totals="only"), frame) == CCX_EVOL


@pytest.mark.parametrize(("name", "wanted"), [("PEEQ", CCX_PEEQ), ("ENER", CCX_ENER)])
def test_scalars_at_points_as_calculix(model, name, wanted, fake, answer):
    frame = fake.state(model, 1, 2, 0.5, 0.5)
    frame.fields[0].values[name] = np.full((2, 4), float(wanted.split()[-1]))
    assert answer(model, Output("el print", (name,), "EALL"), frame).startswith(wanted)


def test_rows_follow_the_order_of_the_set(model, answer):
    model.mesh.cell_sets["BACK"] = np.array([1, 0])
    text = answer(model, Output("el print", ("S",), "BACK"))
    labels = [line.split()[0] for line in text.splitlines()[3:]]
    assert labels == ["12"] * 4 + ["11"] * 4


def test_empty_set_gives_a_heading_only(model, answer):
    model.mesh.cell_sets["NONE"] = np.zeros(0, np.int64)
    text = answer(model, Output("el print", ("S", "EVOL"), "NONE", totals="yes"))
    assert "for set NONE" in text
    assert "        0.000000E+00\n" in text


@pytest.mark.parametrize(
    ("value", "digits", "wanted"),
    [
        (0.5, 7, "0.5000000E+00"),
        (0.0, 7, "0.0000000E+00"),
        (1.0, 6, "0.100000E+01"),
        (-0.00234, 4, "-0.2340E-02"),
        (9.9999999, 4, "0.1000E+02"),
    ],
)
def test_fortran_numbers(value, digits, wanted):
    assert fortran(value, digits) == wanted


def test_status_lines_as_calculix(model, fake):
    frame = fake.state(model, 1, 1, 0.015625, 0.015625)
    frame.scalars["iterations"] = 9.0
    text = STA_HEAD + sta_failed(1, 1, 3, 6, (0.0, 0.0), 0.0625) + sta_line(frame, 4, 0.015625)
    assert text == CCX_STA


def test_convergence_lines_as_calculix():
    info = Iteration(1, 1, 1, 2, 0.7772e-4, 0.0, 0.002501, 0, 0)
    assert CVG_HEAD + cvg_line(info, 1.0) == CCX_CVG


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_iteration_that_overflowed_is_a_large_number(bad):
    line = cvg_line(Iteration(1, 1, 1, 2, bad, 0.0, bad, 0, 0), 1.0)
    assert line.split()[5:7] == ["0.9999E+99", "0.9999E+99"]
    assert len(line) == len(CCX_CVG.splitlines()[-1]) + 1


def test_requests_carry_over_by_kind():
    a, b, c = (Output(k, ("U",)) for k in ("node print", "el print", "node print"))
    steps = [Static(outputs=[a, b]), Static(outputs=[c]), Static()]
    assert in_force(steps) == [[a, b], [b, c], [b, c]]


def test_frequency_asks_for_every_so_many_and_the_last(model, fake):
    model.steps[0].outputs = [Output("node print", ("U",), frequency=3)]
    frames = [fake.state(model, 1, i, i / 4, i / 4) for i in range(5)]
    requests = Requests(model, model.steps)
    now = [len(requests.due_now(f)) for f in frames]
    rest = [len(requests.left_over(f)) for f in frames]
    assert now == [0, 0, 0, 1, 0]
    assert rest == [0, 1, 1, 0, 1]


def test_time_points_are_hit(model, fake):
    model.time_points = {"TP": np.array([0.25, 0.75])}
    output = Output("node print", ("U",), time_points="TP")
    step = model.steps[0]
    requested = [due(output, fake.state(model, 1, i, i / 4, i / 4), step, model) for i in range(5)]
    assert requested == [False, True, False, True, False]


def test_last_frames_of_steps(model, fake):
    frames = [fake.state(model, s, i, 0.0, 0.0) for s, i in ((1, 0), (1, 1), (1, 2), (2, 1))]
    assert last_of_steps(frames) == [False, False, True, True]


def test_file_requests_thin_the_result_file(model, fake, tmp_path):
    model.steps[0].outputs = [Output("node file", ("U",), frequency=2)]
    fake.play(model, [JobFiles(tmp_path)], count=5)
    with read_results(tmp_path / "beam.vtkhdf") as back:
        assert [f.increment for f in back.frames] == [0, 2, 4, 5]


def test_print_requests_are_answered_at_the_end_of_a_path_too(model, fake, tmp_path):
    """A path ends where it ends, not when a period is over."""
    model.steps[0].outputs = [Output("node print", ("U",), "RIGHT", frequency=3)]
    model.steps[0].period = 0.1
    results = fake.play(model, [JobFiles(tmp_path)], count=5)
    text = (tmp_path / "beam.dat").read_text()
    assert text.count("displacements") == 2
    assert results.write(tmp_path / "again.dat").read_text() == text


def test_unknown_print_variable_is_refused_with_the_valid_ones(model):
    model.steps[0].outputs = [Output("el print", ("SDV",), "EALL")]
    with pytest.raises(InputError, match=r"\*EL PRINT: no variable SDV; there are: S, E, PEEQ"):
        check_requests(model.steps)

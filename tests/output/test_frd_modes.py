"""Modes in ``.frd`` files: laid out as CalculiX does, read back by us, cgx and ccx2paraview."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from corota.io.frd.writer import FrdWriter, write_frd
from corota.model.paths import Modes

#: Lines before a block of CalculiX 2.20: a frequency, a buckling factor, a complex mode.
FREQUENCY = """    1PSTEP                         4           1           1          
    1PGM                1.000000E+00                                  
    1PGK                6.907968E+01                                  
    1PHID                         -1                                  
    1PSUBC                         0                                  
    1PMODE                         3                                  
  100CL  103 1.322803396           6                     2    3MODAL      1
 -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
"""  # noqa: W291
BUCKLING = """    1PSTEP                         1           1           1          
  100CL  101 13.02065903           6                     4    1           1
 -4  DISP        4    1
"""  # noqa: W291
COMPLEX = """    1PSTEP                         2           0           3          
    1PGM                1.000000E+00                                  
    1PGK                1.052263E+00                                  
    1PHID                         -1                                  
    1PSUBC                         0                                  
    1PMODE                         1                                  
  100CL  101 1.63261E-01           6                     3    1           1
 -4  PDISP       6    1
 -5  MAG1        1   12    1    0
 -5  MAG2        1   12    2    0
 -5  MAG3        1   12    3    0
 -5  PHA1        1   12    4    0
 -5  PHA2        1   12    5    0
 -5  PHA3        1   12    6    0
"""  # noqa: W291


def model() -> ct.Model:
    found = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1), name="modes")
    found.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    found.fix("left")
    return found


def written(tmp_path: Path, *every: Modes) -> str:
    writer = FrdWriter(tmp_path / "a.frd", model())
    for modes in every:
        writer.add_modes(modes)
    writer.close()
    return (tmp_path / "a.frd").read_text()


def test_lines_before_modes_are_those_of_calculix(tmp_path: Path) -> None:
    shapes = np.zeros((3, 6, 3))
    text = written(tmp_path, Modes("frequency", 1, np.array([0.5, 1.0, 1.322803396]), shapes))
    assert FREQUENCY.replace("4           1  ", "3           1  ", 1) in text
    text = written(tmp_path, Modes("buckling", 1, np.array([13.02065903]), shapes[:1]))
    assert BUCKLING in text
    wave = Modes("frequency", 3, np.array([0.163261]), shapes[:1], imaginary=shapes[:1])
    text = written(tmp_path, wave)
    first = COMPLEX.split("1PGK")[0]
    assert first in text
    assert COMPLEX.split("1PHID")[1] in text
    assert text.endswith(" 9999\n")


def test_complex_modes_have_size_and_phase(tmp_path: Path) -> None:
    real, imaginary = np.zeros((1, 6, 3)), np.zeros((1, 6, 3))
    real[0, 2, 0], imaginary[0, 2, 0], imaginary[0, 5, 1] = 3.0, 4.0, 2.0
    text = written(tmp_path, Modes("frequency", 1, np.array([1.0]), real, imaginary=imaginary))
    rows = text.split("PHA3")[1].splitlines()[1:7]
    table = np.array([[float(row[i : i + 12]) for i in range(13, 85, 12)] for row in rows])
    assert table[2, [0, 3]] == pytest.approx([5.0, np.degrees(np.arctan2(4, 3))], rel=1e-5)
    assert table[5, [1, 4]] == pytest.approx([2.0, 90.0])


@pytest.mark.parametrize("binary", [False, True])
def test_modes_are_read_back(tmp_path: Path, binary: bool) -> None:
    results = ct.solve(model(), ct.Frequency(modes=4), threads=1)
    write_frd(results, tmp_path / "a.frd", binary)
    found = ct.read_results(tmp_path / "a.frd")
    modes = [f for f in found.frames if "mode" in f.scalars]
    (wanted,) = results.modes
    assert [f.scalars["frequency"] for f in modes] == pytest.approx(wanted.factors, rel=1e-5)
    for frame, shape in zip(modes, wanted.shapes, strict=True):
        assert np.allclose(frame.U, shape[:, :2], atol=2e-6 * np.abs(shape).max())
    assert [f.scalars["mode"] for f in modes] == [1.0, 2.0, 3.0, 4.0]


DECK = """*NODE
1,0,0
2,1,0
3,2,0
4,0,1
5,1,1
6,2,1
*ELEMENT, TYPE=CPS4, ELSET=E
1,1,2,5,4
2,2,3,6,5
*MATERIAL, NAME=M
*ELASTIC
1000.,0.3
*DENSITY
1.
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1,1,2
4,1,2
*STEP
*FREQUENCY
2
*END STEP
*STEP
*BUCKLE
1
*CLOAD
3,1,-1.
6,1,-1.
*END STEP
"""


def test_a_run_writes_its_modes_and_cgx_reads_them(tmp_path: Path) -> None:
    (tmp_path / "job.inp").write_text(DECK)
    assert main(["run", str(tmp_path / "job.inp"), "-o", str(tmp_path), "--frd", "-q"]) == 0
    with ct.read_results(tmp_path / "job.modes.vtkhdf") as stored:
        shapes = [frame.U for frame in stored.frames]
    found = [f for f in ct.read_results(tmp_path / "job.frd").frames if "mode" in f.scalars]
    assert len(found) == len(shapes) == 3
    for frame, shape in zip(found, shapes, strict=True):
        assert np.allclose(frame.U, shape, atol=2e-6 * np.abs(shape).max())
    if shutil.which("cgx") is None:
        pytest.skip("calculix-cgx is not installed")
    sets = (tmp_path / "job.frd").read_text().count("100CL")
    (tmp_path / "a.fbd").write_text(f"read job.frd\nsend all abq ds{sets} e2\nquit\n")
    subprocess.run(
        ["cgx", "-bg", "a.fbd"], cwd=tmp_path, capture_output=True, timeout=60, check=False
    )
    text = (tmp_path / f"all_ds{sets}e2.dat").read_text()
    rows = [line.split(",") for line in text.splitlines() if re.match(r" *\d+ *,", line)]
    read = [float(row[-1]) for row in sorted(rows, key=lambda row: int(row[0]))]
    assert read == pytest.approx(shapes[-1][:, 1], rel=1e-4, abs=1e-6)


class AtOnce:
    """A thread that does its work when it is started: ccx2paraview changes what it still writes."""

    def __init__(self, target: Callable[..., None], args: tuple[object, ...] = ()) -> None:
        self.start = lambda: target(*args)

    def join(self) -> None:
        """Nothing."""


def test_ccx2paraview_reads_modes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ccx2paraview = pytest.importorskip(
        "ccx2paraview", reason="ccx2paraview is not installed (requirements-view.txt)"
    )
    results = ct.solve(model(), ct.Frequency(modes=2), threads=1)
    write_frd(results, tmp_path / "a.frd")
    monkeypatch.setattr("threading.Thread", AtOnce)
    ccx2paraview.Converter(str(tmp_path / "a.frd"), ["vtu"]).run()
    sets = (tmp_path / "a.frd").read_text().count(" -4  DISP")
    assert len(list(tmp_path.glob("a*.vtu"))) == sets

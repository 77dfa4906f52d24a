"""Tables of eigenvalues and masses beside those that CalculiX 2.20 wrote for the same deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct

if TYPE_CHECKING:
    from pathlib import Path

#: A strip of five CPS4 without Poisson's ratio, no print request at all.
DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 3., 0.
5, 4., 0.
6, 5., 0.
11, 0., .1
12, 1., .1
13, 2., .1
14, 3., .1
15, 4., .1
16, 5., .1
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 12, 11
2, 2, 3, 13, 12
3, 3, 4, 14, 13
4, 4, 5, 15, 14
5, 5, 6, 16, 15
*MATERIAL, NAME=M
*ELASTIC
1e5, 0.
*DENSITY
1.
*SOLID SECTION, ELSET=EALL, MATERIAL=M
.1
*BOUNDARY
1, 1, 2
11, 1, 2
*STEP
*FREQUENCY
3
*END STEP
"""
#: ``ccx``'s file; what its bricks do out of the plane is left out (z, rotations about x and y).
THEIRS = """
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY   
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.8351260E+02   0.9138523E+01   0.1454441E+01   0.0000000E+00
      2   0.3562687E+04   0.5968825E+02   0.9499680E+01   0.0000000E+00
      3   0.9951043E+04   0.9975491E+02   0.1587649E+02   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1  -0.1494031E-15   0.1755764E+00   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.6368728E+00
      2  -0.6617970E-15   0.9499595E-01   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.9898934E-01
      3  -0.1980230E+00  -0.7599477E-15   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.9901150E-02

     E F F E C T I V E   M O D A L   M A S S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.2232127E-31   0.3082706E-01   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.4056070E+00
      2   0.4379753E-30   0.9024231E-02   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.9798890E-02
      3   0.3921311E-01   0.5775204E-30   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.9803277E-04
TOTAL     0.3921311E-01   0.3985129E-01   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.4155039E+00

     T O T A L   E F F E C T I V E   M A S S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

          0.4333333E-01   0.4333333E-01   0.0000000E+00   0.0000000E+00   0.0000000E+00   0.4168111E+00

"""  # noqa: E501, W291


def test_eigenvalues_and_masses_are_printed_as_calculix_does(tmp_path: Path) -> None:
    """Same lines and layout; numbers equal up to the sign of a mode and rounding."""
    path = tmp_path / "job.inp"
    path.write_text(DECK)
    files = ct.JobFiles(tmp_path, name="job")
    ct.solve(ct.read(path), observers=[files], threads=1)
    ours = (tmp_path / "job.dat").read_text()
    assert len(ours.splitlines()) == len(THEIRS.splitlines())
    for mine, other in zip(ours.splitlines(), THEIRS.splitlines(), strict=True):
        words = other.split()
        if not words or not words[-1].endswith(tuple("0123456789")):
            assert mine == other
            continue
        assert len(mine) == len(other)
        numbers = [np.abs(np.array(line[7:].split(), float)) for line in (mine, other)]
        assert np.allclose(*numbers, rtol=1e-5, atol=1e-12)


def test_an_unstable_state_has_a_negative_eigenvalue(tmp_path: Path) -> None:
    """As CalculiX: the square is negative and the imaginary part is the rate of growth."""
    path = tmp_path / "job.inp"
    load = "*STEP\n*STATIC\n*CLOAD\n6, 1, -5.\n16, 1, -5.\n*END STEP\n"
    path.write_text(DECK.replace("*STEP\n", load + "*STEP, PERTURBATION\n"))
    model = ct.read(path)
    files = ct.JobFiles(tmp_path, name="job")
    with pytest.warns(UserWarning, match="divergence"):
        ct.solve(model, observers=[files], threads=1)
    row = (tmp_path / "job.dat").read_text().split("(RAD/TIME)")[-1].split()[:5]
    assert float(row[1]) < 0.0
    assert float(row[2]) == 0.0
    assert np.isclose(float(row[4]) ** 2, -float(row[1]))

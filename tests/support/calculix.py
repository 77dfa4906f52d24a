"""CalculiX beside: running it, and a mesh that several comparisons share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

#: Skips a test where CalculiX is not installed.
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")


def run_ccx(folder: Path, job: str, *, check: bool = True) -> None:
    """Run CalculiX on ``job.inp`` of a folder; its files lie beside the deck.

    Parameters
    ----------
    folder : Path
    job : str
        Without ending.
    check : bool
        Fail where it ends with an error.
    """
    command = ["ccx", "-i", job]
    subprocess.run(command, cwd=folder, check=check, capture_output=True, timeout=60)


def curved_mesh(kind: str) -> str:
    """Two quadratic elements with curved sides, and the node sets nall, left and right."""
    return f"""*NODE, NSET=nall
1, 0., 0.
2, 1.1, 0.1
3, 2., 0.
4, 2.9, -0.1
5, 4., 0.
6, 0., 0.5
7, 2., 0.55
8, 4., 0.5
9, 0., 1.
10, 1., 1.05
11, 2., 1.1
12, 3., 1.
13, 4., 1.
*ELEMENT, TYPE={kind}, ELSET=all
1, 1, 3, 11, 9, 2, 7, 10, 6
2, 3, 5, 13, 11, 4, 8, 12, 7
*NSET, NSET=left
1, 6, 9
*NSET, NSET=right
5, 8, 13
"""

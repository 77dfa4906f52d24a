# SPDX-License-Identifier: BSD-3-Clause
"""What a small job waits for before it begins."""

from __future__ import annotations

import subprocess
import sys


def test_a_static_job_does_without_scipy() -> None:
    """SciPy takes longer to import than a small job to solve."""
    code = (
        "import sys, corota as ct\n"
        "model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 8, 2))\n"
        "model.section('all', element='Q4I', material=ct.Elastic(E=1e3, nu=0.3))\n"
        "model.fix('left')\n"
        "model.force('right', y=-0.01)\n"
        "ct.solve(model, ct.Static(), threads=1)\n"
        "import corota.cli.run\n"
        "print([m for m in sys.modules if m.split('.')[0] in ('scipy', 'matplotlib', 'meshio')])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.strip().endswith("[]"), done.stdout + done.stderr

"""A source tree without its compiled core says how to build it."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAMS = {
    "Python": "import corota; corota.Model",
    "command": "from corota.cli import main; sys.exit(main(['check', 'part.inp']))",
}


@pytest.mark.parametrize("way", PROGRAMS)
def test_a_missing_core_is_named_with_the_remedy(way: str) -> None:
    hidden = f"import sys; sys.modules['corota._core'] = None; {PROGRAMS[way]}"
    run = subprocess.run(
        [sys.executable, "-c", hidden], capture_output=True, text=True, check=False
    )
    assert run.returncode != 0
    assert "is not built; use make setup, or pip install ." in run.stderr

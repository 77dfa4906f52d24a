"""The campaign of killed runs strikes where it says."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

import pytest

from benchmarks.campaigns.kill_worker import JOB, Case, Strike, run
from benchmarks.speed.start_time import ONE

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the campaign forks its runs")
@pytest.mark.parametrize("inside", ["append", "commit", "before replace", "after replace"])
def test_a_run_that_is_killed_in_a_write_goes_on(tmp_path: Path, inside: str) -> None:
    case, folder = Case("one element", "deck", deck=ONE), tmp_path / "run"
    (tmp_path / f"{JOB}.inp").write_text(ONE, encoding="utf-8")
    code, log = run(case, folder, 1, False, Strike(inside=inside, count=1))
    assert code == -signal.SIGKILL, log
    code, log = run(case, folder, 1, False, Strike())
    assert code == 0, log

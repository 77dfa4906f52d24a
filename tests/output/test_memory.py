# SPDX-License-Identifier: BSD-3-Clause
"""A machine with little memory: refused with a message before anything is taken, exit 5."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import corota as ct
from corota import _core
from corota.analysis.memory import require_libraries
from corota.errors import ResourceError
from corota.io.formats import write
from corota.results.observer import BaseObserver

pytestmark = pytest.mark.skipif(not Path("/proc/self/limits").exists(), reason="asks Linux")

#: Runs a deck with so many MB of addresses left.
RUN = """
import resource, sys
from pathlib import Path
import numpy
from corota import _core
from corota.cli import main
used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + (int(sys.argv[1]) << 20),) * 2)
sys.exit(main(["run", "strip.inp", "-q", "--threads", sys.argv[2]]))
"""


def test_a_job_that_no_machine_can_hold() -> None:
    with pytest.raises(ResourceError, match=r"for a test: it takes about \d+ MB, \d+ MB are free"):
        _core.require_memory(1e15, "a test")
    _core.require_memory(0.0, "nothing")


def test_libraries_that_find_no_room_are_not_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """OpenBLAS asks for ever for memory that it does not get while it is loaded."""
    asked: list[float] = []
    monkeypatch.setattr(_core, "require_memory", lambda size, _: asked.append(size))
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    monkeypatch.delitem(sys.modules, "scipy.linalg", raising=False)
    require_libraries()
    assert asked == [pytest.approx(202e6)]


def test_a_failed_allocation_of_python_is_a_typed_error_with_the_results() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 20, 1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.01)

    class Full(BaseObserver):
        def increment(self, frame: ct.Frame) -> None:
            if frame.increment == 2:
                raise MemoryError

    with pytest.raises(ResourceError, match="All increments before are kept") as caught:
        ct.solve(model, ct.Static(increments=4), observers=[Full()], threads=1)
    assert [frame.increment for frame in caught.value.results.frames] == [0, 1, 2]


@pytest.mark.parametrize(("left", "threads", "code"), [(8, 1, 5), (8, 2, 5), (3000, 1, 0)])
def test_an_address_limit_is_seen_before_it_is_met(
    tmp_path: Path, left: int, threads: int, code: int
) -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 20, 4), name="strip")
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.01, per_node=True)
    model.steps.append(ct.Static(increments=1))
    write(model, tmp_path / "strip.inp")
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(left), str(threads)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == code, done.stderr
    assert (tmp_path / "strip.vtkhdf").exists() == (code == 0)
    if code:
        assert "not enough memory for corota run" in done.stderr

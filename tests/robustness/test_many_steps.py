"""The work of a run of many steps is in proportion to their number."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import corota as ct
from corota.io.job import JobFiles

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def reads_of_steps(count: int, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """How often a run reads each attribute of its steps."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1), name="job")
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.fix("left")
    steps = [ct.Static(increments=1) for _ in range(count)]
    for number, step in enumerate(steps):
        step.force("right", y=1e-3 * number)
    reads: Counter[str] = Counter()
    plain = ct.Static.__getattribute__

    def read(self: Any, name: str) -> Any:
        reads[name] += 1
        return plain(self, name)

    with monkeypatch.context() as patch:
        patch.setattr(ct.Static, "__getattribute__", read)
        formats = ("vtkhdf", "frd")
        ct.solve(model, steps, observers=[JobFiles(folder, "job", formats=formats)], threads=1)
    return reads


def test_no_step_is_read_more_often_the_more_there_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    few, many = (reads_of_steps(n, tmp_path / str(n), monkeypatch) for n in (8, 32))
    assert few["outputs"]
    beyond = {name: (few[name], n) for name, n in many.items() if n > 5 * few[name] + 8}
    assert not beyond

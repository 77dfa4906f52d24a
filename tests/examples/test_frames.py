"""The table of frames is printed with values beside those of exact beams."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest


def test_the_table_of_frames(load, capsys, monkeypatch) -> None:
    example = load("frames/frames.py")
    monkeypatch.setattr("sys.argv", ["frames.py"])
    example.main()
    lines = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line.split()[1:] for line in lines if line.strip()}
    for name, exact in example.EXACT.items():
        found = [float(x) for x in rows[name][:2]]
        assert found == pytest.approx(exact, rel=0.02)
    assert "bifurcation" in lines[-1]

"""Pictures of motion from the command: modes, response, energies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota import plots
from corota.cli import main
from corota.io.result_reader import read_results

matplotlib = pytest.importorskip("matplotlib")

DECK = """*NODE
1, 0., 0.
2, 2., 0.
3, 4., 0.
4, 0., 1.
5, 2., 1.
6, 4., 1.
*ELEMENT, TYPE=CPS4I, ELSET=ALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*MATERIAL, NAME=M
*ELASTIC
100., .3
*DENSITY
1.
*SOLID SECTION, ELSET=ALL, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1, 2
*STEP
*FREQUENCY
3
*END STEP
*STEP
*STEADY STATE DYNAMICS
.01, 2., 10
*MODAL DAMPING
1, 3, .02
*CLOAD
6, 2, -1.
*END STEP
*STEP, NLGEOM
*DYNAMIC, DIRECT
.2, 2.
*CLOAD
6, 2, -.5
*END STEP
"""


def test_pictures_of_motion(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.inp").write_text(DECK, encoding="ascii")
    assert main(["run", "job.inp", "--quiet"]) == 0
    for kind in ("modes", "response", "energies"):
        assert main(["plot", "job.vtkhdf", f"--{kind}"]) == 0
        assert (tmp_path / f"job_{kind}.png").stat().st_size > 5000
    with read_results(tmp_path / "job.modes.vtkhdf") as stored:
        assert [f.scalars["mode"] for f in stored.frames] == [1.0, 2.0, 3.0]
        titles = [ax.get_title(loc="left") for ax in plots.modes(stored, path="m.png").axes]
        assert titles[0].startswith("1: frequency ")
    with read_results(tmp_path / "job.vtkhdf") as stored:
        upper = plots.response(stored, path="r.png").axes[0]
        line = upper.lines[0]
        assert line.get_xdata().min() > 0.0
        # The largest peak is at the first natural frequency, which is marked.
        marks = [x.get_xdata()[0] for x in upper.lines[1:]]
        assert line.get_xdata()[np.argmax(line.get_ydata())] == pytest.approx(marks[0], rel=1e-6)
        labels = [
            x.get_text() for x in plots.energies(stored, path="e.png").axes[0].get_legend().texts
        ]
        assert labels == ["kinetic", "internal work", "external work"]


def test_what_is_not_there_is_not_drawn(tmp_path):
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0))
    model.fix("left")
    results = ct.solve(model, ct.Static())
    for draw in (plots.modes, plots.response, plots.energies):
        with pytest.raises(ct.InputError, match="to draw"):
            draw(results, path=tmp_path / "none.png")

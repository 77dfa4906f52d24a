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


@pytest.mark.usefixtures("quick_pictures")
def test_pictures_of_motion(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.inp").write_text(DECK, encoding="ascii")
    assert main(["run", "job.inp", "--quiet"]) == 0
    axes = {}
    for kind in ("modes", "response", "energies"):
        draw = getattr(plots, kind)

        def drawn(results, kind=kind, draw=draw, **keys):
            axes[kind] = draw(results, **keys).axes

        monkeypatch.setattr(plots, kind, drawn)
        assert main(["plot", "job.vtkhdf", f"--{kind}"]) == 0
        assert (tmp_path / f"job_{kind}.png").stat().st_size > 5000
    with read_results(tmp_path / "job.modes.vtkhdf") as stored:
        assert [f.scalars["mode"] for f in stored.frames] == [1.0, 2.0, 3.0]
    assert axes["modes"][0].get_title(loc="left").startswith("1: frequency ")
    line, *marks = axes["response"][0].lines
    assert line.get_xdata().min() > 0.0
    # The largest peak is at the first natural frequency, which is marked.
    peak = line.get_xdata()[np.argmax(line.get_ydata())]
    assert peak == pytest.approx(marks[0].get_xdata()[0], rel=1e-6)
    labels = [text.get_text() for text in axes["energies"][0].get_legend().texts]
    assert labels == ["kinetic", "internal work", "external work"]


def test_what_is_not_there_is_not_drawn(tmp_path):
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=1.0))
    model.fix("left")
    results = ct.solve(model, ct.Static())
    for draw in (plots.modes, plots.response, plots.energies):
        with pytest.raises(ct.InputError, match="to draw"):
            draw(results, path=tmp_path / "none.png")

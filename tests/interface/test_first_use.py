"""What new users met: names of reference nodes, first frames, notes, words of messages."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.cli import main

if TYPE_CHECKING:
    from pathlib import Path

STRIP = """*NODE
1, 0., 0.
2, 10., 0.
3, 10., 1.
4, 0., 1.
*ELEMENT, TYPE={type}, ELSET=E
1, 1, 2, 3, 4
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=E, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*CLOAD
2, 2, -.01
*END STEP
"""


def pressed(by_name: bool) -> ct.Results:
    """A block under a round tool that its reference node drives down by a tenth."""
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=8, ny=2)
    tool = ct.mesh.add_node(mesh, 2.0, 2.0, name="tool")
    model = ct.Model(mesh)
    model.section(element="Q4I", material=ct.Elastic(E=100.0, nu=0.3))
    model.fix("bottom")
    curve = ct.RigidCurve.circle((2.0, 2.0), 1.0, reference="tool" if by_name else tool)
    model.contact("top", curve, name="tool")
    model.fix("tool", x=0.0, y=-0.1, rotation=True)
    return ct.solve(model, ct.Static(increments=1), threads=1, fields=False)


def test_a_reference_node_has_a_name() -> None:
    by_name, by_index = (pressed(choice).frames[-1] for choice in (True, False))
    assert by_name.scalars["tool: force y"] < 0.0  # on the block
    np.testing.assert_array_equal(by_name.U, by_index.U)


def test_the_first_frame_of_an_explicit_step_has_its_momenta() -> None:
    """Mass 2 x 1 x 3 with the velocity (2, -1) and no forces: (12, -6) in each frame."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section(element="Q4", material=ct.Elastic(E=10.0, nu=0.0, rho=3.0))
    model.velocity(x=2.0, y=-1.0)
    step = ct.Dynamic(period=0.1, scheme="central_difference")
    results = ct.solve(model, step, threads=1, fields=False)
    np.testing.assert_allclose(results.history("momentum x").values, 12.0, rtol=1e-9)
    np.testing.assert_allclose(results.history("momentum y").values, -6.0, rtol=1e-9)


@pytest.mark.parametrize(("kind", "locks"), [("CPS4", True), ("CPS4I", False)])
def test_a_run_notes_elements_that_lock(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    kind: str,
    locks: bool,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "strip.inp").write_text(STRIP.format(type=kind))
    assert main(["run", "strip.inp"]) == 0
    said = capsys.readouterr()
    assert ("too stiff in bending" in said.out + said.err) == locks
    assert ("too stiff in bending" in (tmp_path / "strip.jsonl").read_text()) == locks


def test_a_variable_that_the_analysis_does_not_have() -> None:
    with pytest.raises(ct.InputError, match="has no equivalent plastic strain"):
        pressed(True).history("PEEQ")


def test_a_check_without_steps_says_so() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=10.0))
    model.fix("left")
    text = "the start of a run is not tried"
    assert text in str(model.check())
    assert text not in str(model.check(ct.Static()))

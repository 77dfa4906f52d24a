"""Missing is not zero; walls stand on one side, and what a run changes is said."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.cli import main
from support.frames import lee_frame


def test_frames_without_stability_are_not_unstable(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=8, ny=2))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.01)
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    assert "stable" not in results.frames[0].scalars
    path = results.write(tmp_path / "strip.vtkhdf")
    with ct.read_results(path) as stored:
        assert "stable" not in stored.frames[0].scalars
        assert stored.frames[1].scalars["stable"] == 1.0
        assert np.isnan(stored.history("stable")[0])
        from corota.plots.curves import has_stability

        assert not has_stability(stored)


@pytest.mark.parametrize("ending", ["vtu", "vtkhdf"])
def test_convert_keeps_nodal_stress_of_files_without_points(tmp_path: Path, ending: str) -> None:
    model = ct.examples.load("hinge")
    with ct.JobFiles(tmp_path, "hinge", points=False) as files:
        results = ct.solve(model, observers=[files], threads=1)
    target = tmp_path / f"other.{ending}"
    assert main(["convert", str(tmp_path / "hinge.vtkhdf"), str(target), "--quiet"]) == 0
    if ending == "vtkhdf":
        with ct.read_results(target) as stored:
            np.testing.assert_allclose(
                stored.nodal("MISES"), results.nodal("MISES"), rtol=1e-9, atol=1e-9
            )
    else:
        assert b'Name="Mises"' in target.read_bytes()


def two_walls() -> ct.Results:
    """A block pushed into a corner whose lower wall alone carries."""
    block = ct.mesh.rectangle(4.0, 4.0, nx=4, ny=4)
    model = ct.Model(block)
    model.section(element="Q4I", material=ct.Elastic(E=100.0, nu=0.0))
    block.edge_sets["skin"] = np.vstack([block.edge_sets["bottom"], block.edge_sets["right"]])
    model.contact("skin", ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0)), name="floor")
    model.contact("skin", ct.RigidCurve.line((4.5, -9.0), (4.5, 9.0)), name="wall")
    model.fix("top", x=0.0, y=-0.1)
    return ct.solve(model, ct.Static(), threads=1)


def test_one_walls_line_does_not_show_anothers_pressure(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    results = two_walls()
    pressed = results.frames[-1].pairs
    assert pressed["floor"][:, 0].max() > 1.0
    assert pressed["wall"][:, 0].max() == 0.0
    path = results.write(tmp_path / "walls.vtkhdf")
    with ct.read_results(path) as stored:
        for name, values in pressed.items():
            np.testing.assert_allclose(stored.frames[-1].pairs[name], values)
        for source in (results, stored):
            figure = ct.plots.contact_line(source, "wall")
            drawn = figure.axes[0].lines[0].get_ydata()
            assert np.abs(drawn).max() == 0.0


def test_a_switch_to_arc_length_is_announced_and_its_time_stays_in_the_step(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model, _ = lee_frame(load=3.0)
    heard: list[str] = []

    class Ear(ct.BaseObserver):
        def note(self, step: int, text: str) -> None:
            heard.append(text)

    step = ct.Static(increments=10, at_limit="follow", period=2.0)
    results = ct.solve(model, step, observers=[Ear()], threads=1)
    assert any("arc length takes over" in note for note in results.notes)
    assert "arc length takes over" in heard[0]
    by_arc = results.history("arc length")
    assert set(by_arc.values) == {0.0, 1.0}
    times = results.times
    assert (np.diff(times) > 0.0).all()
    assert times[-1] == pytest.approx(2.0)
    assert results.frames[-1].factor == pytest.approx(1.0)
    results.model.steps = [step]
    text = results.write(tmp_path / "arch.csv").read_text()
    assert "arc length" in text.splitlines()[0]
    from corota.cli.progress import Progress
    from corota.cli.terminal import Terminal

    Progress(Terminal()).note(1, heard[0])
    assert "arc length takes over" in capsys.readouterr().out


def test_extrapolation_makes_no_negative_energy_density(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = ct.solve(ct.examples.load("hinge"), threads=1)
    assert min(float(b.values["ENER"].min()) for b in results.frames[-1].fields) >= 0.0
    assert results.nodal("ENER").min() >= 0.0
    path = results.write(tmp_path / "hinge.vtkhdf")
    assert main(["info", str(path)]) == 0
    row = next(r for r in capsys.readouterr().out.splitlines() if r.split()[:1] == ["ENER"])
    assert float(row.split()[1]) >= 0.0


def over_a_floor(start: tuple[float, float], end: tuple[float, float]) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 4.0, nx=2, ny=2, origin=(0.0, 0.1)))
    model.section(element="Q4I", material=ct.Elastic(E=100.0, nu=0.0))
    model.contact("bottom", ct.RigidCurve.line(start, end), name="floor")
    model.fix("top", y=-0.2)
    model.steps = [ct.Static()]
    return model


def test_a_body_that_starts_wholly_behind_its_wall_is_refused_by_run_and_check() -> None:
    right = over_a_floor((-9.0, 0.0), (9.0, 0.0))  # the body on the left of the way
    assert ct.solve(right, threads=1).frames[-1].C is not None
    assert not right.check().errors
    wrong = over_a_floor((9.0, 0.0), (-9.0, 0.0))
    with pytest.raises(ct.ModelError, match="wrong side of the rigid curve"):
        ct.solve(wrong, threads=1)
    assert any("wrong side" in d.message for d in wrong.check().errors)


def test_decks_have_the_same_side(tmp_path: Path) -> None:
    for ends, good in (((-9.0, 9.0), True), ((9.0, -9.0), False)):
        model = over_a_floor((ends[0], 0.0), (ends[1], 0.0))
        path = tmp_path / "floor.inp"
        ct.write(model, path)
        again = ct.read(path)
        found = any("wrong side" in d.message for d in again.check().errors)
        assert found is not good


def test_rigid_walls_are_drawn_with_their_solid_side() -> None:
    pytest.importorskip("matplotlib")
    figure = over_a_floor((-9.0, 0.0), (9.0, 0.0)).plot()
    assert figure.axes[0].collections or figure.axes[0].patches


def test_memory_that_ends_while_a_module_is_imported_is_a_resource_error(monkeypatch) -> None:
    """Modules are imported at their first use: under a limit that may be in any call."""

    def out_of_memory(*_: object, **__: object) -> None:
        raise MemoryError

    solve, model = ct.solve, ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1))
    step, error = ct.Static(), ct.ResourceError
    monkeypatch.setattr("corota.import_module", out_of_memory)
    with pytest.raises(error, match="not enough memory"):
        ct.__getattr__("Visco")
    monkeypatch.setattr("corota.analysis.run.Analysis", out_of_memory)
    with pytest.raises(error, match="not enough memory"):
        solve(model, step)

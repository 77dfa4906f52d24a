"""The script for ParaView: it is Python, names what is in the file, and finds it anywhere."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import runpy
import shutil
import sys
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import MagicMock, call

import pytest

import corota as ct
from corota.cli import main
from corota.io.paraview import write_paraview
from corota.results.table import POSITIVE


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place: Path = tmp_path_factory.mktemp("job")
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1), name="part")
    model.units("mm", "N", "t", "s")
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=0.1)
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    results.write(place / "part.vtkhdf")
    results.write(place / "part.pvd")
    results.write(place / "part.frd")
    return place


def run(script: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run a script with a ParaView that records what is requested."""
    simple = ModuleType("paraview.simple")
    names = ("OpenDataFile", "GetAnimationScene", "GetActiveViewOrCreate", "Show", "ColorBy")
    names += ("WarpByVector", "GetColorTransferFunction", "GetScalarBar", "AnnotateTimeFilter")
    names += ("ResetCamera", "Render", "SaveScreenshot")
    for name in names:
        setattr(simple, name, MagicMock(name=name))
    colors = simple.GetColorTransferFunction.return_value
    colors.RGBPoints = [-3.0, 0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 0.0]
    monkeypatch.setitem(sys.modules, "paraview", ModuleType("paraview"))
    monkeypatch.setitem(sys.modules, "paraview.simple", simple)
    monkeypatch.setattr(sys, "argv", [str(script), "picture.png"])
    runpy.run_path(str(script))
    return {name: getattr(simple, name) for name in names}


@pytest.mark.parametrize("ending", ["vtkhdf", "pvd"])
def test_a_script_opens_the_file_beside_it(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    assert main(["convert", str(folder / f"part.{ending}"), "--paraview", "-q"]) == 0
    text = (folder / "part.paraview.py").read_text()
    assert str(folder) not in text
    # Both may be moved together.
    for name in (f"part.{ending}", "part.paraview.py"):
        shutil.copy(folder / name, tmp_path)
    calls = run(tmp_path / "part.paraview.py", monkeypatch)
    calls["OpenDataFile"].assert_called_once_with(str(tmp_path / f"part.{ending}"))
    assert calls["ColorBy"].call_args.args[1] == ("POINTS", "Mises")
    title = "MISES [MPa]" if ending == "vtkhdf" else "MISES"  # .pvd has no units
    assert calls["GetScalarBar"].return_value.Title == title
    calls["SaveScreenshot"].assert_called_once()
    (tmp_path / f"part.{ending}").unlink()
    with pytest.raises(RuntimeError, match="keep it beside"):
        run(tmp_path / "part.paraview.py", monkeypatch)


@pytest.mark.parametrize("field", ["S11", "S12", "SP1", "U2", "UR3", "RF", "MISES", "ENER", "E22"])
def test_what_is_named_is_in_the_file(
    folder: Path, monkeypatch: pytest.MonkeyPatch, field: str
) -> None:
    """VTK's own reader finds the array, with the component that is meant."""
    pytest.importorskip("vtk", reason="vtk is not installed (requirements-view.txt)")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    script = write_paraview(folder / "part.vtkhdf", field, scale=2.0)
    calls = run(script, monkeypatch)
    colored = calls["ColorBy"].call_args.args[1]
    rescaled = calls["GetColorTransferFunction"].return_value.RescaleTransferFunction
    assert rescaled.call_args_list == ([] if field in POSITIVE else [call(-3.0, 3.0)])
    reader = vtkHDFReader()
    reader.SetFileName(str(folder / "part.vtkhdf"))
    reader.UpdateInformation()
    reader.SetStep(reader.GetNumberOfSteps() - 1)
    reader.Update()
    data = reader.GetOutput().GetPointData()
    assert data.HasArray("displacement")
    found = vtk_to_numpy(data.GetArray(colored[1]))
    part = {"X": 0, "Y": 1, "XX": 0, "YY": 1, "ZZ": 2, "XY": 3}
    if colored[2:] == ("Magnitude",):
        found = (found**2).sum(axis=1) ** 0.5
    elif colored[2:]:
        found = found[:, part[colored[2]]]
    with ct.read_results(folder / "part.vtkhdf") as results:
        assert found == pytest.approx(results.nodal(field), abs=1e-12)


def test_what_paraview_does_not_read_is_refused(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="convert it first"):
        write_paraview(folder / "part.frd")
    with pytest.raises(ct.InputError, match="no result variable"):
        write_paraview(folder / "part.vtkhdf", "S77")
    with pytest.raises(ct.InputError, match="must be in the folder"):
        write_paraview(folder / "part.vtkhdf", target=str(tmp_path / "a.py"))
    assert main(["convert", str(folder / "part.vtkhdf"), "-q"]) == 2

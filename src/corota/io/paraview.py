"""A script that shows a result file in ParaView: opened, warped and colored."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from os import PathLike
from pathlib import Path

from corota.errors import InputError
from corota.io.atomic_file import replace_text
from corota.io.result_reader import read_results
from corota.results.table import NODAL, POSITIVE
from corota.results.variables import labeled, match_name, stored_as

#: Files that ParaView reads.
READABLE = (".vtkhdf", ".hdf", ".pvd", ".vtu")

_SCRIPT = '''\
"""Show a result file of Corota in ParaView: deformed and colored, with a time axis.

    paraview --script=THIS_FILE        or Macros > Import new macro
    pvpython THIS_FILE picture.png     without a window

The result file must be in the folder of this script; move both together.
"""

import os
import sys

from paraview.simple import *

FILE = {file!r}
ARRAY, COMPONENT = {array!r}, {component!r}
SCALE = {scale!r}

try:
    folder = os.path.dirname(os.path.abspath(__file__))
except NameError:  # some versions do not define __file__ in macros
    folder = os.getcwd()
source = os.path.join(folder, FILE)
if not os.path.isfile(source):
    raise RuntimeError(source + " is missing: keep it beside this script")

results = OpenDataFile(source)
results.UpdatePipeline()
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()

view = GetActiveViewOrCreate("RenderView")
view.InteractionMode = "2D"
view.OrientationAxesVisibility = 0

undeformed = Show(results, view)
undeformed.SetRepresentationType("Feature Edges")
undeformed.AmbientColor = undeformed.DiffuseColor = [0.6, 0.6, 0.6]
ColorBy(undeformed, None)

warp = WarpByVector(Input=results)
warp.Vectors = ["POINTS", "displacement"]
warp.ScaleFactor = SCALE
shown = Show(warp, view)
shown.SetRepresentationType("Surface")
if COMPONENT:
    ColorBy(shown, ("POINTS", ARRAY, COMPONENT))
else:
    ColorBy(shown, ("POINTS", ARRAY))
colors = GetColorTransferFunction(ARRAY)
colors.ApplyPreset({preset!r}, True)
shown.RescaleTransferFunctionToDataRangeOverTime()
if {signed!r}:  # white is zero
    size = max(abs(colors.RGBPoints[0]), abs(colors.RGBPoints[-4]))
    colors.RescaleTransferFunction(-size, size)
shown.SetScalarBarVisibility(view, True)
bar = GetScalarBar(colors, view)
bar.Title, bar.ComponentTitle = {label!r}, {kind!r}

clock = AnnotateTimeFilter(Input=results)
Show(clock, view)
ResetCamera(view)
Render(view)
if sys.argv[1:] and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1600, 1000])
'''
#: Components as ParaView names those of arrays of six.
_COMPONENTS = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")


def write_paraview(
    path: str | PathLike[str], field: str = "", *, scale: float = 1.0, target: str | None = None
) -> Path:
    """Write a Python script for ParaView beside a result file.

    Parameters
    ----------
    path : path-like
        ``.vtkhdf``, ``.pvd`` or ``.vtu`` of Corota.
    field : str
        Variable of the colors; ``MISES``, or ``U`` where nothing is stressed, by default.
    scale : float
        Factor of the displacements.
    target : str, optional
        Name of the script, in the same folder; ``JOB.paraview.py`` by default.

    Returns
    -------
    Path
        Of the script. It names the result file without its folder.

    Raises
    ------
    InputError
        If ParaView does not read such a file, or there is no such variable.
    FileError
        If the file cannot be read or the script not written.
    """
    source = Path(path)
    if source.suffix.lower() not in READABLE:
        raise InputError(
            f"{source}: ParaView reads {', '.join(READABLE)}; convert it first: "
            f"corota convert {source} {source.stem}.vtkhdf"
        )
    with read_results(source) as results:
        names = results.variables()
        name = match_name(field, names) if field else "MISES" if "MISES" in names else "U"
        unit = results.model.unit_system
    array, component = _array(name)
    script = Path(target) if target else source.with_name(f"{source.stem}.paraview.py")
    if script.resolve().parent != source.resolve().parent:
        raise InputError(f"{script}: the script must be in the folder of {source}")
    text = _SCRIPT.format(
        file=source.name,
        label=labeled(name, unit),
        array=array,
        component=component,
        scale=float(scale),
        kind="nodal" * (name not in NODAL),
        signed=name not in POSITIVE,
        preset="Viridis (matplotlib)" if name in POSITIVE else "Cool to Warm",
    )
    replace_text(script, text)
    return script


def _array(name: str) -> tuple[str, str]:
    """Array of the file that holds a variable, and the component as ParaView names it."""
    nodal = {
        "U": ("displacement", "Magnitude"),
        "U1": ("displacement", "X"),
        "U2": ("displacement", "Y"),
        "UR3": ("rotation", ""),
        "RF": ("reaction", "Magnitude"),
        "RF1": ("reaction", "X"),
        "RF2": ("reaction", "Y"),
        "V": ("velocity", "Magnitude"),
        "V1": ("velocity", "X"),
        "V2": ("velocity", "Y"),
    }
    if name in nodal:
        return nodal[name]
    array, column = stored_as(name)
    if column < 0:
        return array, ""
    return array, "XYZ"[column] if array.startswith("principal") else _COMPONENTS[column]

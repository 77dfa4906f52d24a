"""A seal of nearly incompressible rubber to its full stroke, with four elements and three meshes.

``python -m benchmarks rubber_seal [ELEMENT ...]`` closes half a tube of neo-Hooke rubber (Poisson's
ratio .4999, plane strain) between groove and rib until its walls press on each other, and compares
the closing force at four strokes from mesh to mesh. Wanted: 2 % between the last two.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import report
from corota.model import elements

#: Elements that hold the volume, with the options that they need.
ELEMENTS: dict[str, dict[str, Any]] = {
    "Q4S": {},
    "Q4R": {},
    "Q4": {"mean_dilatation": True},
    "Q8R": {},
}
#: Cells through the wall and around; strokes of the rib [mm]; shear modulus [MPa].
MESHES = (3, 40), (4, 60), (6, 80)
STROKES = (2.0, 4.0, 5.0, 6.0)
SHEAR, RATIO = 5.0 / 3.0, 0.4999
#: Largest change of a force from the last mesh but one.
WANTED = 0.02


def seal(element: str, through: int, around: int) -> ct.Model:
    """The example of the seal with rubber, its element and a mesh."""
    kind = elements.find(element).cell
    mesh = ct.mesh.annulus(3.2, 4.0, through, around, 180.0, kind, start=-90.0)
    rib = ct.mesh.add_node(mesh, 0.0, 5.5, name="rib")
    model = ct.Model(mesh, name="seal")
    bulk = SHEAR * 2.0 * (1.0 + RATIO) / (3.0 * (1.0 - 2.0 * RATIO))
    rubber = ct.NeoHooke(C10=0.5 * SHEAR, D1=2.0 / bulk)
    model.section(element=element, material=rubber, plane="strain", **ELEMENTS[element])
    model.fix("start", y=None)
    model.fix("end", y=None)
    groove = ct.RigidCurve.polyline([(-4.0, -4.0), (4.6, -4.0), (4.6, 12.0)], fillet=1.0)
    tool = ct.RigidCurve.arc((0.0, 5.5), 1.5, 45.0, -180.0, reference=rib)
    model.contact("outer", groove, name="groove")
    model.contact("outer", tool, name="rib")
    model.contact("inner", "inner", name="inside")
    model.fix("rib", y=None, rotation=True)
    for stroke in STROKES:
        press = ct.Static(first_increment=0.1)
        press.fix("rib", x=None, y=-stroke)
        model.steps.append(press)
    return model


def forces(element: str, through: int, around: int) -> tuple[list[float], float, str]:
    """Closing forces of the whole tube at the strokes [N/mm], seconds, and why it stopped."""
    begin, why = time.process_time(), ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            results = ct.solve(seal(element, through, around), threads=1)
        except ct.ConvergenceError as error:
            results, why = error.results, str(error)[:80]
    assert results is not None
    force = -2.0 * results.history("RF2", at="rib").values
    steps = np.array([frame.step for frame in results.frames])
    ends = [f.time for f in results.frames]
    found = [
        float(force[steps == n][-1]) if (steps == n).any() and ends[-1] >= n else np.nan
        for n in range(1, len(STROKES) + 1)
    ]
    return found, time.process_time() - begin, why


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("elements", nargs="*", metavar="ELEMENT", help=", ".join(ELEMENTS))
    rows: list[list[object]] = []
    worst = 0.0
    for element in options.parse_args().elements or ELEMENTS:
        before = None
        for through, around in MESHES:
            found, seconds, why = forces(element, through, around)
            change = np.nan
            if before is not None:
                change = float(np.abs(np.array(found) / before - 1.0).max())
            rows.append([element, f"{through} x {around}", *found, change, seconds, why])
            print(rows[-1], flush=True)
            before = np.array(found)
        worst = np.fmax(worst, change) if np.isfinite(change) else np.inf
    head = ["element", "mesh", *(f"{s:g} mm" for s in STROKES), "change", "CPU [s]", "stopped"]
    report("Closing force of a rubber seal [N/mm]", head, rows)
    return int(not worst <= WANTED)


if __name__ == "__main__":
    sys.exit(main())

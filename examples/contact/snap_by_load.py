"""A bistable beam is pushed through by a load on a rigid probe, by arc length, onto a stop.

The beam of ``bistable_beam.py``: its load rises to a limit point, falls while the beam snaps
through, and rises again where the beam meets a stop. Elastic, with friction, and of a metal that
yields (yield stress 5, hardening 100). Marks are runs with prescribed displacement of the probe:
the same
curve, up to where the elastic forces of both agree to the solver's tolerance.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys

import numpy as np
from bistable_beam import YOUNG, beam

import corota as ct
from corota.model.loads import Fixed

#: Height of the stop, and largest load [force]; the model is half the beam.
STOP, LOAD = 2.0, 3.0
CASES = {"elastic": (0.0, 0.0), "friction 0.3": (0.3, 0.0), "friction, yields at 5": (0.3, 5.0)}


def model(friction: float, yields: float, unit: float = 1.0) -> ct.Model:
    """Half the beam, probe and stop; `yields` is the yield stress, 0 for elastic."""
    half = beam(unit=unit)
    if yields:
        half.sections[0].material = ct.Mises(
            E=YOUNG * unit**2, nu=0.3, yield_stress=yields * unit**2, isotropic=100.0 * unit**2
        )
    half.contacts[0].friction = friction
    line = ct.RigidCurve.line((-6.0 / unit, STOP / unit), (6.0 / unit, STOP / unit))
    half.contact("bottom", line, friction=friction, name="stop")
    return half


def by_load(friction: float, yields: float, unit: float = 1.0) -> ct.Results:
    """Follow the path to the full load."""
    half = model(friction, yields, unit)
    half.force("probe", y=-0.5 * LOAD)
    return ct.solve(half, ct.Static(path=ct.ArcLength(factor=1.0)))


def held(friction: float, yields: float, ways: list[float]) -> list[float]:
    """Forces that hold the probe at some ways down, one after the other."""
    steps = [ct.Static(increments=1, supports=[Fixed("probe", 1, -way)]) for way in ways]
    results = ct.solve(model(friction, yields), steps)
    step, force = np.array(results.history("step")), results.history("RF2", at="probe")
    last = [int(np.flatnonzero(step == k)[-1]) for k in range(1, len(ways) + 1)]
    return [-2.0 * float(force[k]) for k in last]


def curve(results: ct.Results) -> tuple[list[float], list[float]]:
    """Way of the probe and load, of the whole beam."""
    way = -np.array(results.history("U2", at="probe"))
    return way.tolist(), (LOAD * np.array(results.history("load factor"))).tolist()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plot", metavar="FILE", help="draw load against way")
    args = parser.parse_args()
    axes = None
    if args.plot:
        import matplotlib as mpl

        mpl.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    sys.stdout.write(
        "                       limit load   lowest  increments  iterations  difference\n"
    )
    for k, (name, case) in enumerate(CASES.items()):
        results = by_load(*case)
        way, load = curve(results)
        found = [LOAD * p.factor for p in results.critical_points if p.kind == "limit"]
        forces = held(*case, way[1:])
        difference = float(np.abs(np.array(forces) - load[1:]).max())
        sys.stdout.write(
            f"{name:24}{found[0]:9.4f}{found[1]:9.4f}{len(way) - 1:12}"
            f"{results.info['iterations']:12}{difference:12.1e}\n"
        )
        if axes is not None:
            axes.plot(way, load, color=f"C{k}", label=f"{name}: by the load")
            axes.plot(way[1:], forces, "o", mfc="none", ms=5, color=f"C{k}")
    if axes is not None:
        axes.plot([], [], "ko", mfc="none", ms=5, label="probe held")
        axes.set(xlabel="way of the probe [mm]", ylabel="load [N]", ylim=(0.0, None))
        axes.legend()
        figure.savefig(args.plot, dpi=120)


if __name__ == "__main__":
    main()

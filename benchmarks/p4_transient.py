"""P4 beside CalculiX and Akantu: the cantilever under a load that acts at once, and twice it.

200 increments of 0.005, bilinear quadrilaterals, mass as each program takes it. Corota (Q4,
residual 1e-9) runs the trapezoidal rule like Akantu, HHT (-0.05) like CalculiX, and the
energy-momentum scheme. Times are those of the increments for Corota and Akantu and of the whole
process for CalculiX. ``--sizes 400 4k 40k``, ``--threads``, ``--only`` names of programs.
Akantu's Python is looked for in ``$COROTA_PEERS/akantu``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

from benchmarks import cantilever as p1
from benchmarks.common import TIME_LIMIT, report

SIZES = {"400": 4, "4k": 14, "40k": 45}
LOADS = (1000.0, 2000.0)
DT, INCREMENTS = 0.005, 200
THICKNESS = 0.01
ROOT = Path(__file__).resolve().parent.parent


def corota(n: int, load: float, scheme: str, threads: int) -> dict[str, float]:
    """Run Corota in this process."""
    import corota as ct

    points, cells = p1.grid(n)
    mesh = ct.Mesh(points, [ct.mesh.Cells("quad4", cells, np.arange(1, len(cells) + 1))])
    model = ct.Model(mesh)
    material = ct.Elastic(E=p1.YOUNG, nu=p1.POISSON, rho=1.0)
    model.section("all", element="Q4", material=material, local_strain="modified")
    model.fix(np.flatnonzero(points[:, 0] == 0.0))
    for node, share in p1.tip_shares(points).items():
        model.force([node], y=load * share)
    step = ct.Dynamic(period=DT * INCREMENTS, increments=INCREMENTS, scheme=scheme, mass="constant")
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(model, step, threads=threads, fields=False)
    seconds = time.perf_counter() - begin
    tip = p1.tip_middle(points)
    most = max(float(f.U[tip, 1]) for f in results.frames)
    return {"seconds": seconds, "iterations": results.info["iterations"], "most": most}


def akantu(n: int, load: float, threads: int) -> dict[str, float] | str:
    """Run Akantu in a process of its own."""
    python = Path(os.environ.get("COROTA_PEERS", "peers")) / "akantu" / "bin" / "python"
    if not python.exists():
        return "not installed"
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": str(threads)}
        try:
            done = subprocess.run(
                [str(python), "-m", "benchmarks.peers.akantu_p4", str(n), str(load)],
                cwd=folder, env=environment, capture_output=True, text=True, check=False,
                timeout=TIME_LIMIT,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return "over limit"
    if done.returncode:
        return "failed: " + (done.stderr.strip().splitlines() or ["?"])[-1][:60]
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def calculix(n: int, load: float, threads: int) -> dict[str, float] | str:
    """Run CalculiX; its plane stress has the thickness 0.01."""
    if shutil.which("ccx") is None:
        return "not installed"
    points, cells = p1.grid(n)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{k + 1}, {x:.12g}, {y:.12g}, 0." for k, (x, y) in enumerate(points.tolist())]
    lines.append("*ELEMENT, TYPE=CPS4, ELSET=EALL")
    lines += [f"{k + 1}, " + ", ".join(map(str, c + 1)) for k, c in enumerate(cells)]
    lines.append("*NSET, NSET=ROOT")
    lines += [f"{k + 1}," for k in np.flatnonzero(points[:, 0] == 0.0)]
    lines.append(f"*NSET, NSET=TIP\n{p1.tip_middle(points) + 1},")
    lines.append(
        f"*MATERIAL, NAME=M\n*ELASTIC\n{p1.YOUNG}, {p1.POISSON}\n*DENSITY\n1.\n"
        f"*SOLID SECTION, ELSET=EALL, MATERIAL=M\n{THICKNESS}\n*BOUNDARY\nROOT, 1, 3\n"
        "*AMPLITUDE, NAME=ON\n0., 1., 10., 1.\n"
        f"*STEP, NLGEOM, INC=100000\n*DYNAMIC, DIRECT\n{DT}, {DT * INCREMENTS}\n"
        "*CLOAD, AMPLITUDE=ON"
    )
    lines += [f"{k + 1}, 2, {load * s * THICKNESS!r}" for k, s in p1.tip_shares(points).items()]
    lines.append("*NODE PRINT, NSET=TIP\nU\n*END STEP\n")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "p4.inp").write_text("\n".join(lines), encoding="ascii")
        begin = time.perf_counter()
        try:
            subprocess.run(
                ["ccx", "-i", "p4"], cwd=folder, capture_output=True, check=False,
                timeout=TIME_LIMIT, env={**os.environ, "OMP_NUM_THREADS": str(threads)},
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return "over limit"
        seconds = time.perf_counter() - begin
        rows = [r.split() for r in (folder / "p4.sta").read_text(encoding="ascii").splitlines()]
        rows = [r for r in rows if len(r) == 7 and r[0].isdigit()]
        tip = [r.split() for r in (folder / "p4.dat").read_text(encoding="ascii").splitlines()]
        most = max((float(r[2]) for r in tip if len(r) == 4 and r[0].isdigit()), default=np.nan)
    if not rows or float(rows[-1][5]) < DT * INCREMENTS * (1.0 - 1e-6):
        return f"stopped at time {rows[-1][5] if rows else 0}"
    return {"seconds": seconds, "iterations": sum(int(r[3]) for r in rows), "most": most}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="+", choices=SIZES, default=list(SIZES))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--only", nargs="+", default=["Corota", "CalculiX", "Akantu"])
    args = parser.parse_args()
    rows: list[list[object]] = []
    for size in args.sizes:
        for load in LOADS:
            n = SIZES[size]
            programs = {
                f"Corota {scheme}": lambda scheme=scheme: corota(n, load, scheme, args.threads)  # noqa: B023
                for scheme in ("newmark", "hht", "energy_momentum")
            }
            programs["CalculiX"] = lambda: calculix(n, load, args.threads)  # noqa: B023
            programs["Akantu"] = lambda: akantu(n, load, args.threads)  # noqa: B023
            for name, run in programs.items():
                if name.split()[0] not in args.only:
                    continue
                try:
                    found = run()
                except RuntimeError as error:
                    found = str(error)[:80]
                if isinstance(found, str):
                    rows.append([name, size, f"{load:g}", "", "", "", found])
                else:
                    each = 1e3 * found["seconds"] / found["iterations"]
                    tip = f"{found['most']:.4f}"
                    count = int(found["iterations"])
                    rows.append([name, size, f"{load:g}", count, found["seconds"], each, tip])
                sys.stderr.write(f"{rows[-1]}\n")
    head = ["program", "dofs", "load", "iterations", "time [s]", "ms/iteration", "largest tip"]
    report("P4, transient: 200 increments", head, rows)


if __name__ == "__main__":
    main()

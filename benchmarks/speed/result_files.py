"""Size and time of result files: `python -m benchmarks result_files`.

A cantilever of Q4I elements, ten increments, files written as `corota run` writes them. *before*:
values at quadrature points too, nothing packed; *after*: the defaults. `held` is what the analysis
itself waited for the writer, a thread beside it; `more` is how much longer the run took than one
without files, the median of repeated pairs (means little on a busy machine). `--examples` reads
every field of every example back by h5py and, where it is installed, by VTK's own reader, and
compares bits.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import statistics
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota.io.vtk.frame_arrays import cell_data, point_data
from corota.io.vtk.grid import Grid

#: Elements along and across by number of degrees of freedom.
SIZES = {256: (31, 3), 41000: (512, 39), 1000000: (2500, 199)}
#: Options of the files: as they were, and as they are.
FORMS: dict[str, dict[str, Any]] = {
    "before": {"points": True, "compression": 0},
    "after": {},
    "single": {"single": True},
}


def cantilever(nx: int, ny: int) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=nx, ny=ny), name="cantilever")
    model.section("all", element="Q4I", material=ct.Elastic(E=1.2e6, nu=0.3), thickness=0.01)
    model.fix("left")
    model.force("right", y=40.0)
    return model


def run(model: ct.Model, folder: Path, options: dict[str, Any] | None) -> dict[str, float]:
    """Seconds of a run of ten increments, with files unless there are no options."""
    observers = [] if options is None else [ct.JobFiles(folder, **options, checkpoint_seconds=0.0)]
    begin = time.perf_counter()
    results = ct.solve(model, ct.Static(increments=10), observers=observers, keep="last")
    wall = time.perf_counter() - begin
    path = folder / f"{model.name}.vtkhdf"
    return {
        "wall": wall,
        "write": results.info["profile"].get("write", 0.0),
        "held": results.info.get("seconds held by output", 0.0),
        "bytes": path.stat().st_size if options is not None else 0,
        "frames": 11,
    }


def measure(dofs: int, repeats: int, forms: list[str]) -> None:
    model = cantilever(*SIZES[dofs])
    print(f"{2 * model.mesh.n_nodes:,} dofs, {model.mesh.n_cells:,} elements, 10 increments")
    print(
        f"  {'':8}{'MB':>9}{'kB/frame':>10}{'writer s':>10}{'held s':>9}{'held':>8}{'run s':>8}"
        f"{'more':>8}",
        flush=True,
    )
    for name in forms:
        options = FORMS[name]
        more, last = [], {}
        for _ in range(repeats):
            with tempfile.TemporaryDirectory() as folder:
                bare = run(model, Path(folder), None)["wall"]
                last = run(model, Path(folder), options)
                more.append(last["wall"] / bare - 1.0)
        print(
            f"  {name:8}{last['bytes'] / 1e6:9.2f}{last['bytes'] / last['frames'] / 1e3:10.1f}"
            f"{last['write']:10.2f}{last['held']:9.2f}{last['held'] / last['wall']:8.1%}"
            f"{last['wall']:8.1f}{statistics.median(more):8.1%}",
            flush=True,
        )


def read_back() -> None:
    """Compare the fields of every example with what is read from its file."""
    for name in ct.examples.names():
        model = ct.examples.load(name)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            results = ct.solve(model, threads=1)
        with tempfile.TemporaryDirectory() as folder:
            path = results.write(Path(folder) / "a.vtkhdf")
            counts = {"h5py": by_h5py(results, path)}
            try:
                counts["VTK"] = by_vtk(results, path)
            except ImportError:
                counts["VTK"] = -1
        text = ", ".join(
            f"{reader} {'not installed' if n < 0 else f'{n:,} arrays equal to the last bit'}"
            for reader, n in counts.items()
        )
        print(f"{name:10}{len(results.frames):5} frames: {text}")


def wanted(results: ct.Results, index: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Arrays of a frame at points and at cells."""
    grid, frame = Grid(results.model), results.frames[index]
    at_points = grid.at_points(point_data(frame, results.averaging), frame)
    at_cells = grid.at_cells(cell_data(frame, results.mesh.n_cells))
    return at_points, dict(grid.still) | at_cells


def by_h5py(results: ct.Results, path: Path) -> int:
    import h5py

    count = 0
    with h5py.File(path) as file:
        for i in range(len(results.frames)):
            for place, arrays in zip(("PointData", "CellData"), wanted(results, i), strict=True):
                for name, values in arrays.items():
                    stored = name.replace("/", "|")
                    first = int(file[f"VTKHDF/Steps/{place}Offsets/{stored}"][i])
                    found = file[f"VTKHDF/{place}/{stored}"][first : first + len(values)]
                    if not np.array_equal(found, values):
                        raise SystemExit(f"{path.name}: {name} of frame {i} differs (h5py)")
                    count += 1
    return count


def by_vtk(results: ct.Results, path: Path) -> int:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader, count = vtkHDFReader(), 0
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for i in range(len(results.frames)):
        reader.SetStep(i)
        reader.Update()
        read = reader.GetOutput()
        if reader.GetTimeValue() != results.frames[i].time:
            raise SystemExit(f"{path.name}: time of frame {i} differs (VTK)")
        places = (read.GetPointData(), read.GetCellData())
        for data, arrays in zip(places, wanted(results, i), strict=True):
            for name, values in arrays.items():
                found = vtk_to_numpy(data.GetArray(name.replace("/", "|")))
                if not np.array_equal(found, values):
                    raise SystemExit(f"{path.name}: {name} of frame {i} differs (VTK)")
                count += 1
    return count


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--dofs", type=int, nargs="*", choices=list(SIZES), default=[256, 41000])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--forms", nargs="*", choices=list(FORMS), default=list(FORMS))
    parser.add_argument("--examples", action="store_true")
    args = parser.parse_args()
    if args.examples:
        read_back()
        return
    for dofs in args.dofs:
        measure(dofs, args.repeats, args.forms)


if __name__ == "__main__":
    main()

"""Results as one compressed NumPy archive."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.atomic_file import replaced
from corota.io.finite import check_frame

if TYPE_CHECKING:
    from pathlib import Path

    from corota.results.results import Results


def write_npz(results: Results, path: Path) -> None:
    """Write all frames: arrays ``time``, ``U`` (frames, nodes, 2), ``S_0`` (frames, n, p, 4), ...

    The number after a point variable counts the blocks; ``cells_0`` holds their cells.

    Raises
    ------
    FileError
        If writing fails.
    """
    frames, mesh = results.frames, results.mesh
    for frame in frames:
        check_frame(frame)
    data: dict[str, Any] = {
        "X": mesh.points,
        "node_labels": mesh.node_labels,
        "cell_labels": mesh.cell_labels,
        "step": np.array([f.step for f in frames]),
        "increment": np.array([f.increment for f in frames]),
        "time": results.times,
        "load_factor": np.array([f.factor for f in frames]),
    }
    for name in ("U", "UR", "RF", "F"):
        data[name] = np.stack([getattr(f, name) for f in frames])
    for name in ("V", "A", "C"):
        have = [f for f in frames if getattr(f, name) is not None]
        if have:
            zero = np.zeros_like(getattr(have[0], name))
            rows = [getattr(f, name) for f in frames]
            data[name] = np.stack([zero if r is None else r for r in rows])
    for number, cells in enumerate(mesh.cells):
        data[f"{cells.kind}_{number}"] = cells.nodes
    for number, block in enumerate(frames[-1].fields):
        data[f"cells_{number}"] = block.cells
        data[f"points_{number}"] = np.stack([f.fields[number].points for f in frames if f.fields])
        for name in block.values:
            values = [f.fields[number].values[name] for f in frames if f.fields]
            data[f"{name}_{number}"] = np.stack(values)
    for name in frames[-1].scalars:
        data[name.replace(" ", "_")] = np.array([f.scalars.get(name, 0.0) for f in frames])
    with replaced(path) as hidden, open(hidden, "wb") as file:
        np.savez_compressed(file, **data)

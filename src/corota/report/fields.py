"""Arrays at the nodes for the page: their names, their order of importance, their size."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.result_reader import FileResults
from corota.io.vtk.frame_arrays import point_data
from corota.report.chunk import rounded
from corota.results.table import CONTACT, INVARIANTS, TABLE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.arrays import Floats
    from corota.results.results import Results


#: Vectors: name in the page to the names of their parts in files.
VECTORS = {
    "U": ("displacement", ""),
    "RF": ("reaction", "reaction moment"),
    "F": ("external force", "external moment"),
    "VEL": ("velocity", "angular velocity"),
    "ACC": ("acceleration", "angular acceleration"),
}
#: Arrays from which the page computes invariants (``assets/fields.js``); it reads the others.
COMPUTED = {"Mises", "principal stress", "principal strain"}
#: Tensors and invariants: name in files to the name in the page.
PAGE_NAMES = {row.stored: name for name, row in TABLE.items() if row.tensor} | {
    item.array: name for name, (_, item) in INVARIANTS.items() if item.array not in COMPUTED
}
#: Order of importance; other names come last.
ORDER = (
    "U", "S", *CONTACT, "RF", "PEEQ", "N", "M1", "M2", "UR", "VEL", "E", "YRATIO", "ENER", "F",
    "PE", "ACC", "ALPHA", "PWORK", "PDISS", "CEEQ", "CWORK", "DMENER", "TRISE", "STH",
)  # fmt: skip
#: Share of the largest force below which a reaction is rounding.
NO_FORCE = 1e-9


class NodalArrays:
    """Arrays at the nodes of the frames of results, by their names in the page."""

    def __init__(self, results: Results) -> None:
        self.results = results
        self._frames: Any = results.frames if isinstance(results, FileResults) else None
        found: dict[str, None] = {}
        count = len(results.frames)
        for index in dict.fromkeys((0, count // 2, count - 1)) if count else ():
            found |= dict.fromkeys(self._files(index))
        self._have = set(found)
        names = [n for n, (main, _) in VECTORS.items() if main in found]
        names += [n for file, n in PAGE_NAMES.items() if file in found]
        names += ["UR"] if "rotation" in found else []
        used = {part for parts in VECTORS.values() for part in parts} | {"rotation"}
        used |= set(PAGE_NAMES) | COMPUTED
        names += [n for n in found if n not in used and ": " not in n]
        rank = {name: i for i, name in enumerate(ORDER)}
        #: All names, the most important first.
        self.names: list[str] = sorted(names, key=lambda n: (rank.get(n, len(rank)), n))

    def _files(self, index: int) -> list[str]:
        if self._frames is not None:
            return list(self._frames.point_names())
        return list(point_data(self.results.frames[index], self.results.averaging))

    def read(self, index: int, names: list[str], bits: int) -> dict[str, NDArray[np.float32]]:
        """Arrays of a frame that are not zero everywhere, rounded."""
        if self._frames is not None:
            frames = self._frames
            data = {f: frames.at_points(f, index) for n in names for f in _files_of(n, self._have)}
        else:
            data = point_data(self.results.frames[index], self.results.averaging)
        arrays = {}
        for name in names:
            files = [f for f in _files_of(name, self._have) if f in data]
            # A frame of a static step has no velocity, for instance.
            if files and (values := _assembled(name, [data[f] for f in files])).any():
                arrays[name] = rounded(values, bits)
        return arrays


def _files_of(name: str, have: set[str]) -> list[str]:
    """Names in files of the arrays that make one of the page."""
    if name in VECTORS:
        return [file for file in VECTORS[name] if file in have]
    in_files = {own: file for file, own in PAGE_NAMES.items()}
    return ["rotation" if name == "UR" else in_files.get(name, name)]


def _assembled(name: str, parts: list[Floats]) -> Floats:
    if name in VECTORS:
        values = np.column_stack([parts[0][:, :2], *parts[1:]])
        return without_rounding(values) if name == "RF" else values
    return parts[0][:, :4] if parts[0].ndim == 2 else parts[0]


def without_rounding(forces: Floats) -> Floats:
    """Forces and moments (n, 3) without those that are rounding: zero bytes deflate to nothing."""
    size = np.abs(forces)
    out: Floats = forces.copy()
    for columns in ([0, 1], [2]):
        part = size[:, columns]
        out[:, columns] = np.where(part < NO_FORCE * part.max(initial=0.0), 0.0, out[:, columns])
    return out

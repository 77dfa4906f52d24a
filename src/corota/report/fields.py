"""Arrays at the nodes for the page: their names, their order of importance, their size."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.result_reader import FileResults
from corota.io.vtk.vtkhdf import point_data
from corota.report.chunk import rounded
from corota.results import variables as vf

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from corota.results.results import Results

    Floats = NDArray[np.float64]

#: Vectors: name in the page to the names of their parts in files.
VECTORS = {
    "U": ("displacement", ""),
    "RF": ("reaction", "reaction moment"),
    "F": ("external force", "external moment"),
    "VEL": ("velocity", "angular velocity"),
    "ACC": ("acceleration", "angular acceleration"),
}
#: Tensors: name in files to the name in the page.
TENSOR_FILES = {"stress": "S", "strain": "E", "PE": "PE", "ALPHA": "ALPHA"}
#: What the page computes itself.
DERIVED_FILES = {"principal stress", "principal strain", "Mises"}
#: What is kept longest, first; names that are not here come last.
ORDER = (
    "U", "S", *vf.CONTACT, "RF", "PEEQ", "N", "M1", "M2", "UR", "VEL", "E", "YRATIO", "ENER", "F",
    "PE", "ACC", "ALPHA", "PWORK", "PDISS", "STH",
)  # fmt: skip
#: Share of the largest force below which a reaction is rounding.
NO_FORCE = 1e-9


class NodalArrays:
    """Arrays at the nodes of the frames of results, by their names in the page.

    Parameters
    ----------
    results : Results
    """

    def __init__(self, results: Results) -> None:
        self.results = results
        self._frames: Any = results.frames if isinstance(results, FileResults) else None
        found: dict[str, None] = {}
        count = len(results.frames)
        for index in dict.fromkeys((0, count // 2, count - 1)) if count else ():
            found |= dict.fromkeys(self._files(index))
        self._have = set(found)
        names = [n for n, (main, _) in VECTORS.items() if main in found]
        names += [n for file, n in TENSOR_FILES.items() if file in found]
        names += ["UR"] if "rotation" in found else []
        used = {part for parts in VECTORS.values() for part in parts} | {"rotation"}
        used |= set(TENSOR_FILES) | DERIVED_FILES
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

            def get(name: str) -> Floats:
                found: Floats = frames.at_points(name, index)
                return found
        else:
            data = point_data(self.results.frames[index], self.results.averaging)

            def get(name: str) -> Floats:
                zero = np.zeros(self.results.mesh.n_nodes)
                return data.get(name, zero)

        arrays = {}
        for name in names:
            values = self._assemble(name, get)
            if values.any():
                arrays[name] = rounded(values, bits)
        return arrays

    def _assemble(self, name: str, get: Callable[[str], Floats]) -> Floats:
        values: Floats
        if name in VECTORS:
            main, turn = VECTORS[name]
            values = get(main)[:, :2]
            if turn:
                values = np.column_stack([values, get(turn)])
            if name == "RF":
                values = without_rounding(values)
            return values
        for file, own in TENSOR_FILES.items():
            if own == name:
                return get(file)[:, :4]
        return get("rotation" if name == "UR" else name)


def without_rounding(forces: Floats) -> Floats:
    """Forces and moments (n, 3) without those that are rounding: zero bytes deflate to nothing."""
    size = np.abs(forces)
    out: Floats = forces.copy()
    for columns in ([0, 1], [2]):
        part = size[:, columns]
        out[:, columns] = np.where(part < NO_FORCE * part.max(initial=0.0), 0.0, out[:, columns])
    return out


__all__ = ["NodalArrays", "without_rounding"]

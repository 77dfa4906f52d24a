"""Section forces along trusses and beams."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.display import Brief
from corota.errors import InputError
from corota.lazy import lazy

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.results.source import ResultSource


# A convenience: a function of a higher layer, which loads at its first call.
draw_forces = lazy("corota.plots:section_forces")


@dataclass(repr=False)
class Members(Brief):
    """Section forces at both ends of line elements, in co-rotated axes.

    Parameters
    ----------
    results : Results
    frame : int
    cells : ndarray of int, shape (n,)
        Global cell indices.
    nodes : ndarray of int, shape (n, 2)
    N, V : ndarray, shape (n,)
        Axial force, positive in tension, and shear force [force]; constant along an element.
        ``V = (M1 - M2) / L``: it is positive if it pushes the second end to the left of the
        direction from the first node to the second.
    M : ndarray, shape (n, 2)
        Moment at both ends, positive if it stretches the right side of that direction
        [force*length]; linear between.
    """

    results: ResultSource = field(repr=False)
    frame: int
    cells: Ints
    nodes: Ints
    N: Floats
    V: Floats
    M: Floats

    def ends(self, name: str) -> Floats:
        """``N``, ``V`` or ``M`` at both ends, shape (n, 2)."""
        if name not in ("N", "V", "M"):
            raise InputError(f"members have N, V and M, not {name!r}")
        values: Floats = getattr(self, name)
        return values if values.ndim == 2 else np.stack([values, values], axis=1)

    def to_dataframe(self) -> Any:
        """Table of elements and their forces as a ``pandas.DataFrame``."""
        mesh = self.results.mesh
        columns = {
            "element": mesh.cell_labels[self.cells],
            "node 1": mesh.node_labels[self.nodes[:, 0]],
            "node 2": mesh.node_labels[self.nodes[:, 1]],
            "N": self.N,
            "V": self.V,
            "M1": self.M[:, 0],
            "M2": self.M[:, 1],
        }
        return import_module("pandas").DataFrame(columns)

    def plot(
        self, name: str = "M", *, path: str | PathLike[str] | None = None, **options: Any
    ) -> Any:
        """Draw the diagram of ``N``, ``V`` or ``M``; see :func:`corota.plots.section_forces`."""
        return draw_forces(self, name, path=path, **options)


def members(results: ResultSource, cells: str | ArrayLike | None, frame: int) -> Members:
    """Find them; see :meth:`corota.results.Results.member_forces`."""
    mesh = results.mesh
    names = results.variables(frame)
    wanted = np.zeros(mesh.n_cells, dtype=bool)
    if cells is None:
        wanted[:] = True
    else:
        wanted[mesh.cell_indices(cells)] = True
    # Springs have a force N, but no section.
    has = wanted & (results.cells_with("S", frame) if "N" in names else False)
    rows, nodes = [np.zeros(0, np.int64)], [np.zeros((0, 2), np.int64)]
    for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
        if block.kind == "line2":
            mine = np.flatnonzero(has[offset : offset + len(block)])
            rows.append(mine + offset)
            nodes.append(block.nodes[mine])
    found, pairs = np.concatenate(rows), np.concatenate(nodes)
    if not len(found):
        raise InputError(
            "there are no trusses or beams with section forces"
            + ("" if cells is None else " in the chosen elements")
            + "; those of planar elements are section(start, end)"
        )
    n, v, m1, m2 = (
        results.cells(name, frame)[found] if name in names else np.zeros(len(found))
        for name in ("N", "V", "M1", "M2")
    )
    return Members(results, frame, found, pairs, n, v, np.stack([m1, m2], axis=1))

"""Temperatures and initial stresses of a model: a part of :class:`corota.Model`."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.model.loads import InitialStress, InitialTemperature

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints


class InitialFields:
    """Temperatures and initial stresses of :class:`corota.Model`."""

    initial_temperatures: list[InitialTemperature]
    initial_stresses: list[InitialStress]

    if TYPE_CHECKING:  # methods of the whole

        def _nodes(self, where: str | ArrayLike) -> str | Ints: ...

        def _cells(self, cells: str | ArrayLike) -> str | Ints: ...

    def initial_temperature(self, value: ArrayLike, nodes: str | ArrayLike = "") -> None:
        """Set the temperature without thermal strain; 0 where none is given.

        Parameters
        ----------
        value : float or array_like
            One temperature, or one for each node.
        nodes : str or array_like of int
            Node, edge or cell set ("" for all), or node indices.
        """
        where = "" if isinstance(nodes, str) and not nodes else self._nodes(nodes)
        self.initial_temperatures.append(InitialTemperature(where, _temperature(value)))

    def initial_stress(
        self,
        cells: str | ArrayLike = "",
        *,
        xx: ArrayLike = 0.0,
        yy: ArrayLike = 0.0,
        zz: ArrayLike = 0.0,
        xy: ArrayLike = 0.0,
    ) -> None:
        """Set the stress of cells in the reference; unbalanced stress deforms the structure.

        Parameters
        ----------
        cells : str or array_like of int
            Cell set ("" for all), or global cell indices.
        xx, yy, zz, xy : float or array_like
            Stress in global axes [force/length^2]: a number, an array with one value for each
            cell (n, 1), or one for each quadrature point (n, p). Of trusses and beams xx is the
            stress along the axis. In plane stress zz must vanish.
        """
        where = "" if isinstance(cells, str) and not cells else self._cells(cells)
        value = tuple(np.asarray(v, dtype=np.float64) for v in (xx, yy, zz, xy))
        if not all(np.isfinite(v).all() for v in value):
            raise InputError("an initial stress must be finite")
        self.initial_stresses.append(InitialStress(where, value))


def _temperature(value: ArrayLike) -> float | Floats:
    found = np.asarray(value, dtype=np.float64)
    if not np.isfinite(found).all():
        raise InputError("temperatures must be finite")
    return float(found) if found.ndim == 0 else found

"""Softening of rubber by its largest stretch so far."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError, number
from corota.model.hyperelastic import Hyperelastic, laws_of_energies

if TYPE_CHECKING:
    from typing_extensions import Self


@dataclass
class Mullins(Hyperelastic):
    """Rubber or foam that is softer below its largest energy so far (Mullins effect).

    The energy U of the change of shape is reduced by
    ``eta = 1 - erf((U_max - U) / (m + beta U_max)) / r``, where ``U_max`` is its largest value so
    far at the point. Beyond ``U_max`` the law is its parent. Of foams the whole energy is reduced.

    Parameters
    ----------
    parent : a hyperelastic material
        The law of the first loading.
    r : float
        Inverse of the largest softening, > 1.
    m : float
        Energy density at which small deformations soften [force/length^2], >= 0.
    beta : float
        Share of ``U_max`` in that energy, >= 0; m and beta are not both zero.

    Raises
    ------
    InputError
        If a number is outside its range, or the parent is another material.

    Notes
    -----
    As ``*MULLINS EFFECT`` of Abaqus. There is no permanent set. The output ``DMENER`` is the energy
    density that the damage has lost, ``ALLDMD`` its sum over the model.

    Source: R. W. Ogden and D. G. Roxburgh, *Proc. R. Soc. Lond. A* 455 (1999) 2861-2877, with the
    ``beta`` of Abaqus.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.Mullins(ct.NeoHooke(C10=0.5), r=2.0, m=0.1)
    >>> up, down = rubber.nominal("uniaxial", [2.0, 1.5])
    >>> round(float(up), 4), round(float(down), 4), round(1.5 - 1.5**-2, 4)
    (1.75, 0.5278, 1.0556)
    """

    parent: Hyperelastic
    r: float
    m: float
    beta: float = 0.0

    law = "mullins"
    remembers = True

    def __post_init__(self) -> None:
        if not isinstance(self.parent, Hyperelastic) or isinstance(self.parent, Mullins):
            raise InputError(
                f"hyperelastic materials soften, {type(self.parent).__name__} does not", self.where
            )
        r, m, beta = (number(getattr(self, name), name) for name in ("r", "m", "beta"))
        if not (np.isfinite([r, m, beta]).all() and r > 1.0 and min(m, beta) >= 0.0 < m + beta):
            raise InputError(
                "the softening needs r > 1, m >= 0 and beta >= 0, not both zero; "
                f"got r = {r:g}, m = {m:g}, beta = {beta:g}",
                self.where,
            )
        self.rho = self.rho or self.parent.rho
        self.expansion = self.expansion or self.parent.expansion
        super().__post_init__()

    @property
    def incompressible(self) -> bool:
        return self.parent.incompressible

    def with_ratio(self, nu: float) -> Self:
        return replace(self, parent=self.parent.with_ratio(nu))

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Number of the parent, r, m, beta, parameters of the parent."""
        own = (float(laws_of_energies().index(self.parent.law)), float(self.r), float(self.m))
        return [*own, float(self.beta), *self.parent.parameters()]

"""Complex stiffness of viscoelastic materials in harmonic motion.

Shear and bulk modulus are ``G (1 - sum g / (1 + i w tau))`` and the same with the shares k. With
their complex ratio ``r = K / G`` the stiffness of a part is ``G F(r)`` with a matrix F that is
analytic in r, whatever the elements: it is interpolated in ``ln r`` between real ratios, where
elastic elements give it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np

import corota._core as _core
from corota.model.blocks import BlockOfCells, core_input
from corota.model.materials import Elastic
from corota.model.viscoelastic import Viscoelastic

if TYPE_CHECKING:
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.linearized import LinearMotion
    from corota.arrays import Complex, Floats


#: Ratios between which a stiffness is interpolated where they change: its error is below 1e-8 for
#: shares up to 0.9.
RATIOS = 14
#: Relative difference of ratios that is rounding.
RATIO_TOLERANCE = 1e-9
#: Largest Poisson's ratio of the elastic elements.
LARGEST_NU = 0.4999999


class ComplexStiffness:
    """What viscoelastic parts have beside their instantaneous stiffness, by the frequency.

    It is that of their moduli at small strain on the current shape: the stiffness of a preload's
    stress stays as it is.

    Parameters
    ----------
    rates : ndarray, shape (k,)
        All circular frequencies of the response [rad/time].
    """

    def __init__(self, lin: LinearMotion, rates: Floats) -> None:
        self.lin = lin
        system = lin.system
        self._parts: list[_Part] = []
        self.points = system.model.mesh.points
        if any(_relaxes(b) for b in system.own_blocks):
            self.points = self.points + system.by_node(lin.u)[:, :2]
        for index, block in enumerate(system.own_blocks):
            if _relaxes(block):
                self._parts.append(_Part(lin, self.points, index, rates))

    def __bool__(self) -> bool:
        return self.lin.system.communicator.any(bool(self._parts))

    def at(self, rate: float) -> Any:
        """Complex matrix of all unknowns at a circular frequency [rad/time]."""
        values = self.lin.system.pattern.zeros().astype(complex)
        for part in self._parts:
            values += part.at(rate)
        real, imaginary = (self.lin.reduce(v) for v in (values.real.copy(), values.imag.copy()))
        return self.lin.padded(real) + 1j * self.lin.padded(imaginary)


class _Part:
    def __init__(self, lin: LinearMotion, points: Floats, index: int, rates: Floats) -> None:
        self.system, self.points, self.index = lin.system, points, index
        self.material = cast("Viscoelastic", lin.system.own_blocks[index].section.material)
        compliance = self.material.compliance()
        young, nu = 1.0 / compliance[0, 0], -compliance[0, 1] / compliance[0, 0]
        nu = min(nu, LARGEST_NU)
        self.shear = 1.0 / compliance[3, 3]
        self.bulk = young / (3.0 * (1.0 - 2.0 * nu))
        g, k = self.material.complex_moduli(rates)
        ratios = np.log(np.append(k / g * self.bulk, self.bulk) / self.shear)
        low, high = ratios.real.min(), ratios.real.max()
        middle, half = 0.5 * (low + high), 0.5 * (high - low) + np.abs(ratios.imag).max()
        count = 1 if half < RATIO_TOLERANCE else RATIOS
        angles = (np.arange(count) + 0.5) * math.pi / count
        #: Chebyshev points and their barycentric weights.
        self.nodes = middle + half * np.cos(angles)
        self.weights = np.sin(angles) * (-1.0) ** np.arange(count)
        self.values = np.array([self._stiffness(ratio) for ratio in np.exp(self.nodes)])
        self.instantaneous = self._at(complex(self.shear), complex(self.bulk))

    def at(self, rate: float) -> Complex:
        """Values of the matrix at a circular frequency, less the instantaneous ones."""
        g, k = self.material.complex_moduli(np.array([rate]))
        return self._at(g[0] * self.shear, k[0] * self.bulk) - self.instantaneous

    def _at(self, shear: complex, bulk: complex) -> Complex:
        distance = np.log(bulk / shear) - self.nodes
        hit = np.abs(distance) < RATIO_TOLERANCE * max(1.0, float(np.abs(self.nodes).max()))
        share = hit.astype(complex) if hit.any() else self.weights / distance
        found: Complex = shear * (share / share.sum() @ self.values)
        return found

    def _stiffness(self, ratio: float) -> Floats:
        """Values of the stiffness with a shear modulus of one and a bulk modulus."""
        young = 9.0 * ratio / (3.0 * ratio + 1.0)
        elastic = Elastic(young, (3.0 * ratio - 2.0) / (2.0 * (3.0 * ratio + 1.0)))
        system = self.system
        inputs = [core_input(b, self.points) for b in system.own_blocks]
        own = inputs[self.index]
        own.update(law=elastic.law, parameters=elastic.parameters(), local_strain="linear")
        core = _core.Problem(self.points, inputs, system.extra_dofs)
        core.set_active([i == self.index for i in range(len(inputs))])
        n = system.n_dofs
        values = np.empty(system.pattern.nnz)
        core.assemble(np.zeros(n), False, np.empty(n), np.empty(n), values)
        return values


def _relaxes(block: BlockOfCells) -> bool:
    return isinstance(block.section.material, Viscoelastic)


def relaxing_note(system: NumberedModel) -> str:
    """What procedures without complex moduli say of viscoelastic materials, if there are any."""
    if not any(_relaxes(b) for b in system.blocks):
        return ""
    return "of viscoelastic materials the instantaneous moduli count"

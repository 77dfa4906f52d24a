"""Random displacements of nodes with a correlation length."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from corota.errors import number

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.mesh.data import Mesh

#: Waves whose sum is a field; its distribution at a point is Gaussian to about 1 / WAVES.
WAVES = 500


def random_field(mesh: Mesh, length: float, *, seed: int = 0) -> Floats:
    """Draw smooth random displacements: imperfections without a preferred shape.

    Both components are independent Gaussian fields with mean 0, standard deviation 1 and the
    correlation ``exp(-r^2 / (2 length^2))`` at a distance r. The field is a function of the
    position: other meshes of the same body with the same seed get the same displacements.

    Parameters
    ----------
    mesh : Mesh
    length : float
        Correlation length [length], > 0.
    seed : int, optional
        Of the random numbers.

    Returns
    -------
    ndarray, shape (n_nodes, 2)
        For :meth:`corota.Model.imperfection`, whose scale is the standard deviation.

    Notes
    -----
    Source: M. Shinozuka, G. Deodatis, *Simulation of multi-dimensional Gaussian stochastic fields
    by spectral representation*, Appl. Mech. Rev. 49 (1996) 29-53; the wave numbers are drawn from
    the spectrum.

    Examples
    --------
    >>> from corota import mesh
    >>> strip = mesh.rectangle(100.0, 1.0, nx=100, ny=1)
    >>> field = mesh.random_field(strip, 5.0, seed=3)
    >>> field.shape
    (202, 2)
    """
    number(length, "the correlation length", above=0.0)
    rng = np.random.default_rng(seed)
    waves = rng.standard_normal((WAVES, 2, 2)) / length
    phases = rng.uniform(0.0, 2.0 * math.pi, (WAVES, 2))
    field = np.zeros((mesh.n_nodes, 2))
    for wave, phase in zip(waves, phases, strict=True):
        field += np.cos(mesh.points @ wave + phase)
    return field * math.sqrt(2.0 / WAVES)

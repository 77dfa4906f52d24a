"""Bodies in motion that examples and problems share: pendulum, thrown rod, thrown block."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota import mesh as meshes
from corota.materials import Elastic
from corota.model import Model
from corota.verification.models import cell

if TYPE_CHECKING:
    from corota.results import Results


def column(results: Results, name: str) -> np.ndarray:
    """A scalar of every increment."""
    return np.array([f.scalars[name] for f in results.frames if f.increment > 0])


def flyer(element: str, strain: Any = "simplified", E: float = 1e4) -> Model:
    """A flexible block 4 x 1 that spins and flies freely."""
    model = Model(meshes.rectangle(4.0, 1.0, nx=4, ny=1, cell=cell(element)))
    model.section("all", element=element, material=Elastic(E=E, nu=0.3, rho=1.0),
                  local_strain=strain)  # fmt: skip
    model.velocity(spin=1.0, x=0.3, about=(1.0, 0.0))
    return model

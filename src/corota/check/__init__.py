"""What can be said of a model before it is solved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.check.cells import check_cells
from corota.check.data import check_data
from corota.check.rigid import check_rigid
from corota.check.sections import check_sections
from corota.check.units import check_units

if TYPE_CHECKING:
    from corota.errors import Diagnostic
    from corota.model.model import Model

__all__ = ["check"]


def check(model: Model) -> list[Diagnostic]:
    """Look for what will fail, mislead or surprise, without solving.

    Errors are cells without a section or of the wrong shape, inverted cells, loads without
    effect, and free rigid-body modes with the node to hold. Warnings are meshes that lock,
    distorted cells, nodes at the same place, doubtful units. Notes count and list.

    Parameters
    ----------
    model : Model

    Returns
    -------
    list of Diagnostic
        Errors first, then warnings, then notes.

    Examples
    --------
    >>> import corota as ct
    >>> from corota.check import check
    >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    >>> model.section("all", element="Q4I", material=ct.Elastic(E=1.0, nu=0.3))
    >>> model.fix("left", y=None)
    >>> for finding in check(model):
    ...     if finding.severity == "error":
    ...         print(finding)
    error: a free body: it can move along y
        hint: hold node 1 in y (dof 2)
    """
    found = check_data(model)
    sections, complete = check_sections(model)
    found += sections
    found += check_cells(model)
    found += check_units(model)
    if complete:
        found += check_rigid(model)
    order = {"error": 0, "warning": 1, "note": 2}
    return sorted(found, key=lambda d: order[d.severity])

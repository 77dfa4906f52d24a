"""Checks of a model before it is solved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterable
from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING

from corota.check.cells import check_cells
from corota.check.data import check_data
from corota.check.rigid import check_rigid
from corota.check.sections import check_sections
from corota.check.start import refusal
from corota.check.units import check_units
from corota.errors import Diagnostic, SingularError
from corota.mesh.kinds import PLANAR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.model import Model
    from corota.model.steps import Step

__all__ = ["check", "examine"]


def check(model: Model, steps: Step | Sequence[Step] | None = None) -> list[Diagnostic]:
    """Check for errors and likely mistakes, without solving more than the start.

    Errors are what a run refuses: cells without a section or of the wrong shape, inverted cells,
    and free motions, with the node to fix. A model with steps is checked by the
    run's own first increment, so that constraints, ties and contact are included;
    problems that do not stop a run at its start are warnings, as is a motion that only a
    later step releases. Warnings are also given for meshes that lock,
    distorted cells, coincident nodes, doubtful units. Notes count and list.

    Parameters
    ----------
    model : Model
    steps : Step or sequence of Step, optional
        What will be run; the model's own steps by default.

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
    if steps is not None:
        model = copy(model)
        model.steps = list(steps) if isinstance(steps, Iterable) else [steps]
    return examine(model)[0]


def examine(model: Model) -> tuple[list[Diagnostic], int]:
    """Findings of :func:`check`, and the exit code: 0 if a run starts.

    A mesh without sections and steps is not yet a model, and is not checked as one.
    """
    found, code = check_data(model), 0
    if model.sections or model.steps:
        sections, complete = check_sections(model)
        found += sections
        found += check_cells(model) + check_units(model)
        if complete and model.steps:
            found, code = _by_start(model, found)
        else:
            text = "there are no steps, so the start of a run is not tried: check(step) tries it"
            found.append(Diagnostic("note", text))
            if complete and _plain(model):
                found += check_rigid(model)
    elif model.mesh.n_cells:
        # A mesh alone is not checked as a model.
        found += [replace(d, severity="note") for d in check_sections(model)[0]]
        found += check_cells(model)
    order = {"error": 0, "warning": 1, "note": 2}
    found = sorted(found, key=lambda d: order[d.severity])
    return found, code or 3 * any(d.severity == "error" for d in found)


def _by_start(model: Model, found: list[Diagnostic]) -> tuple[list[Diagnostic], int]:
    """Findings, adjusted to whether the run starts, and the exit code if it does not."""
    error = refusal(model)
    if error is None:
        found = [replace(d, severity="warning") if d.severity == "error" else d for d in found]
        if not _plain(model):
            return found, 0
        # Models without loads start, and so do bodies that later steps release.
        free = check_rigid(model, first=1) or check_rigid(model)
        return found + [replace(d, severity="warning") for d in free], 0
    named = isinstance(error, SingularError) and _plain(model)
    motions = check_rigid(model) if named else []
    if not motions and not any(d.severity == "error" for d in found):
        where = getattr(error, "where", None)
        motions = [Diagnostic("error", getattr(error, "message", str(error)), where)]
    return found + motions, error.exit_code


def _plain(model: Model) -> bool:
    """Whether supports and common nodes alone constrain the model's bodies."""
    joined = model.constraints or model.axes or model.contacts or model.ties
    return not joined and all(block.kind in PLANAR for block in model.mesh.cells)

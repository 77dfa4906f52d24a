"""Sections: every cell has one that fits; elements that lock in their use."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import Diagnostic, InputError
from corota.mesh.parts import cells_of
from corota.model import elements
from corota.model.locking import locking_in

if TYPE_CHECKING:
    from corota.arrays import Ints
    from corota.mesh.data import Mesh
    from corota.model.model import Model
    from corota.model.sections import Section


def check_sections(model: Model) -> tuple[list[Diagnostic], bool]:
    """Findings, and whether every cell has exactly one section that fits."""
    found: list[Diagnostic] = []
    mesh = model.mesh
    count = np.zeros(mesh.n_cells, np.int64)
    fits = True
    for section in model.sections:
        cells = cells_of(mesh, section.cells)
        count[cells] += 1
        wrong = _wrong_shape(mesh, section, cells)
        fits = fits and wrong is None
        found += [wrong] if wrong else locking_in(mesh, section, cells, model.steps)
    labels = mesh.cell_labels
    for code, text, hint in (
        (count == 0, "no section", "give one to every cell"),
        (count > 1, "more than one section", "make the sets of the sections disjoint"),
    ):
        bad = np.flatnonzero(code)
        if len(bad):
            verb = f"and {len(bad) - 1} others have" if len(bad) > 1 else "has"
            found.append(Diagnostic("error", f"element {labels[bad[0]]} {verb} {text}", hint=hint))
    return found, fits and bool((count == 1).all()) and mesh.n_cells > 0


def _wrong_shape(mesh: Mesh, section: Section, cells: Ints) -> Diagnostic | None:
    try:
        kind = elements.find(section.element).cell
    except InputError as error:
        return Diagnostic("error", error.message, section.where)
    offsets = mesh.offsets
    for number, block in enumerate(mesh.cells):
        inside = (cells >= offsets[number]) & (cells < offsets[number + 1])
        if inside.any() and block.kind != kind:
            label = mesh.cell_labels[cells[inside][0]]
            return Diagnostic(
                "error",
                f"element {label} is a {block.kind}; {section.element} needs a {kind}",
                section.where,
            )
    return None

"""Sections that differ by cell in one number."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from corota.arrays import Floats, distinct
from corota.mesh.parts import cells_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.model import Model
    from corota.model.sections import Section


def change_sections(
    model: Model, values: Floats, same: float, change: Callable[[Section, float], Section]
) -> None:
    """Split the sections of a model by the values of their cells.

    Parameters
    ----------
    values : ndarray, shape (n_cells,)
    same : float
        Value of cells whose section stays; springs always keep theirs.
    change : callable
        Section of cells with another value.
    """
    sections = []
    for section in model.sections:
        cells = cells_of(model.mesh, section.cells)
        for value in distinct(values[cells]).tolist():
            mine = cells[values[cells] == value]
            part = section if len(mine) == len(cells) else replace(section, cells=mine)
            stays = value == same or section.element.startswith("SPRING")
            sections.append(part if stays else change(part, value))
    model.sections = sections

"""Modes as results: one frame per mode, for files and pictures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from corota.errors import InputError
from corota.results.results import Frame, Results


def as_results(results: Results) -> Results:
    """Buckling and vibration modes as frames of a separate results object.

    Returns
    -------
    Results
        A frame for each mode: its displacement is the shape, its time and increment the number
        of the mode, its scalars hold ``buckling factor`` or ``frequency``. The largest
        displacement of a buckling mode is 1; vibration modes have modal mass 1.

    Raises
    ------
    InputError
        If there are no modes.
    """
    if not results.modes:
        raise InputError("there are no modes: the analysis has no buckling or frequency step")
    out = Results(results.model)
    number = 0
    for modes in results.modes:
        named = "buckling factor" if modes.kind == "buckling" else "frequency"
        for factor, rate, shape in zip(modes.factors, modes.growth, modes.shapes, strict=True):
            number += 1
            none = np.zeros((len(shape), 3))
            value = float(factor)
            out.add(
                Frame(
                    modes.step,
                    number,
                    float(number),
                    float(number),
                    value,
                    shape[:, :2].copy(),
                    shape[:, 2].copy(),
                    none,
                    none,
                    scalars=_scalars(named, value, float(rate), number),
                )
            )
    return out


def _scalars(named: str, value: float, growth: float, number: int) -> dict[str, float]:
    """Scalars of a mode for files."""
    scalars = {named: value, "mode": float(number)}
    if growth:
        scalars["growth rate"] = growth
    return scalars


def write_modes(results: Results, path: Path) -> None:
    """Write the modes as a temporal VTKHDF file, a time step a mode."""
    from corota.io.vtk.vtkhdf import VtkhdfWriter

    found = as_results(results)
    writer = VtkhdfWriter(path, found.model)
    for frame in found.frames:
        writer.add(frame)
    writer.close(found.info)


def write_iterate(results: Results, path: Path) -> None:
    """Write the last state of a run that stopped and the last iterate, as time steps."""
    from corota.io.vtk.vtkhdf import VtkhdfWriter

    writer = VtkhdfWriter(path, results.model)
    for frame in (results.last_state, results.last_iterate):
        assert frame is not None
        bare = replace(frame, scalars={}, fields=[], V=None, A=None, C=None, pairs={}, T=None)
        writer.add(bare)
    writer.close({})

"""Pictures of dynamics: mode shapes, frequency response, the energy balance."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.plots.contour import Drawing, paint
from corota.plots.figure import COLORS, INK, PALE, chart, finish, look, new_figure, plane_axes
from corota.results.variables import labeled

if TYPE_CHECKING:
    from os import PathLike

    from corota.results.results import Frame, Results

#: Modes of one picture, and modes beside each other.
MOST, ACROSS = 9, 3
#: Largest drawn displacement of a mode, relative to the model's size.
SHARE = 0.1
#: Scalars of the balance with their names in the legend.
ENERGIES = {
    "kinetic energy": "kinetic",
    "internal work": "internal work",
    "damping energy": "damping",
    "external work": "external work",
}


def modes(results: Results, *, path: str | PathLike[str] | None = None, dpi: float = 150.0) -> Any:
    """Draw mode shapes side by side, each with its frequency or buckling factor.

    Parameters
    ----------
    results : Results
        With modes, or their frames as :func:`corota.io.modes.as_results` makes them. The
        largest displacement is drawn as a tenth of the model's size.
    path, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there are no modes.
    """
    from corota.io.modes import as_results

    if not any("mode" in f.scalars for f in results.frames):
        if not results.modes:
            raise InputError(
                "there are no modes to draw: they come from *FREQUENCY and *BUCKLE steps"
            )
        results = as_results(results)
    frames = [i for i, f in enumerate(results.frames) if f.scalars.get("mode")][:MOST]
    size = SHARE * float(np.ptp(results.mesh.points, axis=0).max())
    scales = {i: size / (float(np.hypot(*results.frames[i].U.T).max()) or 1.0) for i in frames}
    drawing = Drawing(results, "U", False)
    columns = min(ACROSS, len(frames))
    rows = math.ceil(len(frames) / columns)
    moved = [results.mesh.points + scale * results.frames[i].U for i, scale in scales.items()]
    every = np.concatenate([results.mesh.points, *moved])
    low, high = every.min(axis=0), every.max(axis=0)
    across, up = np.maximum(high - low, 1e-12 * float((high - low).max()))
    width = min(3.0, 3.0 * across / up)
    with look() as mpl:
        figure = new_figure(
            max(columns * width, 2.4), rows * (width * up / across + 0.35), shown=path is None
        )
        for place, index in enumerate(frames):
            ax = figure.add_subplot(rows, columns, place + 1)
            paint(ax, mpl, drawing, index, scales[index], None, True, None)
            plane_axes(ax, low, high, 0.04 * float((high - low).max()), results.model.unit_system)
            ax.set_axis_off()
            ax.set_title(_mode_title(results.frames[index]), loc="left")
        return finish(figure, path, dpi)


def _mode_title(frame: Frame) -> str:
    name = "frequency" if "frequency" in frame.scalars else "buckling factor"
    return f"{frame.scalars['mode']:.0f}: {name} {frame.scalars[name]:.5g}"


def response(
    results: Results, *, path: str | PathLike[str] | None = None, dpi: float = 150.0
) -> Any:
    """Draw a steady-state step: largest amplitude and its phase against the frequency.

    Parameters
    ----------
    results : Results
    path : path-like, optional
    dpi : float

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no harmonic response.
    """
    # Files hold a zero where a frame has no such number.
    frames = [f for f in results.frames if f.scalars.get("largest amplitude")]
    if not frames:
        raise InputError(
            "there is no harmonic response to draw: it comes from *STEADY STATE DYNAMICS"
        )
    frequency, size, phase = (
        np.array([f.scalars[name] for f in frames])
        for name in ("frequency", "largest amplitude", "phase at largest")
    )
    with look():
        figure = new_figure(5.6, 4.6, shown=path is None)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        upper.semilogy(frequency, size, color=COLORS[0], linewidth=1.4)
        upper.yaxis.set_major_formatter("{x:g}")
        lower.plot(
            frequency, np.degrees(phase), color=COLORS[0], linewidth=1.4, marker=".", markersize=3
        )
        for natural in _natural(results):
            if frequency[0] <= natural <= frequency[-1]:
                for ax in (upper, lower):
                    ax.axvline(natural, color=PALE, linewidth=0.7, linestyle=(0, (4, 3)), zorder=1)
        upper.set_ylabel("largest amplitude")
        lower.set_ylabel("its phase [degrees]")
        lower.set_xlabel("frequency (natural ones dashed)")
        lower.set_ylim(-185.0, 185.0)
        lower.set_yticks([-180, -90, 0, 90, 180])
        for ax in (upper, lower):
            chart(ax, zero=False, powers="")
        upper.set_title(results.model.name, loc="left")
        return finish(figure, path, dpi)


def _natural(results: Results) -> list[float]:
    """Natural frequencies that frequency steps of the analysis found."""
    return [
        value
        for frame in results.frames
        for name, value in frame.scalars.items()
        if name.startswith("frequency ") and value > 0.0
    ]


def energies(
    results: Results, *, path: str | PathLike[str] | None = None, dpi: float = 150.0
) -> Any:
    """Draw the energies over time, and the energy-balance error.

    Parameters
    ----------
    results : Results
    path : path-like, optional
    dpi : float

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no energy balance.
    """
    frames = [f for f in results.frames if "energy balance" in f.scalars]
    if not any(f.scalars.get(name) for f in frames for name in ENERGIES):
        raise InputError("there are no energies to draw")
    time = np.array([f.time for f in frames])
    with look():
        figure = new_figure(5.6, 4.6, shown=path is None)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.6, 1.0))
        for name, label in ENERGIES.items():
            values = np.array([f.scalars.get(name, 0.0) for f in frames])
            if np.any(values):
                upper.plot(time, values, linewidth=1.4, label=label)
        balance = np.array([f.scalars["energy balance"] for f in frames])
        lower.plot(time, balance, color=INK, linewidth=1.2)
        units = results.model.unit_system
        upper.set_ylabel(labeled("energy", units, "energy"))
        upper.legend(ncols=2)
        lower.set_ylabel(labeled("balance", units, "energy"))
        lower.set_xlabel(labeled("time", units))
        for ax in (upper, lower):
            chart(ax, powers="y")
        upper.set_title(results.model.name, loc="left")
        return finish(figure, path, dpi)

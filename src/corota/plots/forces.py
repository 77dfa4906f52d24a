"""Diagrams of section forces: along line elements, across planar ones, over the frames."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.plots.contour import frame_title
from corota.plots.figure import (
    COMPRESSION,
    INK,
    PALE,
    TENSION,
    body_figure,
    chart,
    finish,
    look,
    new_figure,
    plane_axes,
)
from corota.plots.rigid import draw_rigid
from corota.plots.surface import outline
from corota.results.variables import labeled

if TYPE_CHECKING:
    from os import PathLike

    from corota.arrays import Floats, Ints
    from corota.results.members import Members
    from corota.results.section import Cut, SectionDiagram


#: Names of section forces, with their dimensions.
NAMES = {
    "N": ("normal force", "force"),
    "V": ("shear force", "force"),
    "M": ("bending moment", "force*length"),
}
#: Height of the largest value, as a share of the diagonal of the model.
HEIGHT = 0.13


def section_forces(
    members: Members,
    name: str = "M",
    *,
    scale: float = 1.0,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw the diagram of a section force on trusses and beams.

    Moments are drawn on the tension side; positive normal and shear forces on
    the left of the direction from the first node to the second.

    Parameters
    ----------
    members : Members
        Of :meth:`corota.results.Results.member_forces`.
    name : {"N", "V", "M"}
    scale : float
        Factor of the drawn displacements.
    title : str, optional
    path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such section force.
    """
    name = name.upper()
    values = members.ends(name)
    results = members.results
    mesh, units = results.mesh, results.model.unit_system
    positions = mesh.points + scale * results.frame(members.frame).U
    low, high = positions.min(axis=0), positions.max(axis=0)
    size = float(np.linalg.norm(high - low)) or 1.0
    ends = positions[members.nodes]
    axis = ends[:, 1] - ends[:, 0]
    axis = axis / np.maximum(np.hypot(*axis.T), 1e-300)[:, None]
    left = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
    side = _smooth(left, members.nodes) * (-1.0 if name == "M" else 1.0)
    largest = float(np.abs(values).max())
    tops = ends + (HEIGHT * size / (largest or 1.0)) * values[..., None] * side
    low, high = (
        np.minimum(low, tops.min(axis=(0, 1))),
        np.maximum(high, tops.max(axis=(0, 1))),
    )
    with look():
        from matplotlib.collections import LineCollection, PolyCollection

        figure, ax, _ = body_figure(ax, low, high, path is None, below=1.2)
        ax.add_collection(LineCollection(outline(mesh, positions), colors=PALE, linewidths=0.7))
        draw_rigid(ax, results.model, results.frame(members.frame), scale)
        for positive, color in ((True, TENSION), (False, COMPRESSION)):
            pieces = _pieces(ends, tops, values if positive else -values)
            if pieces:
                ax.add_collection(
                    PolyCollection(
                        pieces, facecolors=color, edgecolors=color, alpha=0.35, linewidths=0.4
                    )
                )
        ax.add_collection(LineCollection(list(tops), colors=INK, linewidths=0.6))
        ax.add_collection(LineCollection(list(ends), colors=INK, linewidths=1.8, capstyle="round"))
        _extremes(ax, ends, tops, values, largest)
        plane_axes(ax, low, high, 0.07 * size, units)
        what, of = NAMES[name]
        head = labeled(f"{name}: {what}", units, of)
        heading = frame_title(results, members.frame, scale)
        ax.set_title(title if title is not None else f"{head}\n{heading}", loc="left")
        return finish(figure, path, dpi)


def _smooth(left: Floats, nodes: Ints) -> Floats:
    """Normals at the ends of lines, shape (n, 2, 2); the mean between two collinear lines."""
    side = np.repeat(left[:, None], 2, axis=1)
    begins, ends = (np.bincount(nodes[:, k], minlength=nodes.max() + 1) for k in (0, 1))
    through = (begins == 1) & (ends == 1)
    start = np.zeros(len(begins), np.int64)
    start[nodes[:, 0]] = np.arange(len(nodes))
    for row in np.flatnonzero(through[nodes[:, 1]]):
        following = start[nodes[row, 1]]
        if left[row] @ left[following] > 0.9:
            mean = left[row] + left[following]
            side[row, 1] = side[following, 0] = mean / np.hypot(*mean)
    return side


def _pieces(ends: Floats, tops: Floats, values: Floats) -> list[Floats]:
    found = []
    for axis, top, (first, last) in zip(ends, tops, values, strict=True):
        if first <= 0.0 and last <= 0.0:
            continue
        zero = None
        if first * last < 0.0:
            zero = axis[0] + (axis[1] - axis[0]) * first / (first - last)
        corners = []
        if first > 0.0:
            corners += [axis[0], top[0]]
        if zero is not None:
            corners.append(zero)
        if last > 0.0:
            corners += [top[1], axis[1]]
        if first > 0.0 >= last and zero is None:
            corners.append(axis[1])
        found.append(np.array(corners))
    return found


def _extremes(ax: Any, ends: Floats, tops: Floats, values: Floats, largest: float) -> None:
    """Write the largest and the smallest value where they are."""
    flat, at, foot = values.ravel(), tops.reshape(-1, 2), ends.reshape(-1, 2)
    for index in dict.fromkeys((int(flat.argmax()), int(flat.argmin()))):
        value = float(flat[index])
        if abs(value) < 1e-6 * largest or largest == 0.0:
            continue
        away = at[index] - foot[index]
        away = away / max(float(np.hypot(*away)), 1e-300)
        ax.annotate(
            f"{value:.4g}",
            at[index],
            xytext=tuple(5.0 * away),
            textcoords="offset points",
            ha="left" if away[0] > 0.4 else "right" if away[0] < -0.4 else "center",
            va="bottom" if away[1] > 0.4 else "top" if away[1] < -0.4 else "center",
            color=INK,
            zorder=5,
        )


def section_diagram(
    diagram: SectionDiagram,
    *,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    dpi: float = 150.0,
) -> Any:
    """Draw N, V and M of planar elements along their axis.

    Parameters
    ----------
    diagram : SectionDiagram
        Of :meth:`corota.results.Results.section_diagram`.
    title : str, optional
    path, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    results = diagram.results
    along = labeled("along the axis", results.model.unit_system, "length")
    rows = [diagram.N, diagram.V, diagram.M]
    return _three(
        results, diagram.distance, rows, along, title or results.model.name, path, dpi, True
    )


def section_history(
    cut: Cut,
    *,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    dpi: float = 150.0,
) -> Any:
    """Draw N, V and M of a cut over the time.

    Parameters
    ----------
    cut : Cut
    title : str, optional
    path, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    results = cut.results
    found = [cut.forces(i) for i in range(len(results.frames))]
    rows = [np.array([getattr(f, name) for f in found]) for name in NAMES]
    (a, b), (c, d) = cut.start, cut.end
    heading = title or f"{results.model.name}: cut from ({a:g}, {b:g}) to ({c:g}, {d:g})"
    x = labeled("time", results.model.unit_system)
    return _three(results, results.times, rows, x, heading, path, dpi, False)


def _three(
    results: Any,
    x: Floats,
    rows: list[Floats],
    along: str,
    title: str,
    path: str | PathLike[str] | None,
    dpi: float,
    filled: bool,
) -> Any:
    units = results.model.unit_system
    if len(x) == 0:
        raise InputError("there are no frames yet")
    with look():
        figure = new_figure(5.2, 4.6, shown=path is None)
        panels = figure.subplots(3, 1, sharex=True)
        # Values of rounding size are drawn as zero.
        arm = float(np.ptp(results.mesh.points, axis=0).max()) or 1.0
        force = max(*(float(np.abs(r).max()) for r in rows[:2]), float(np.abs(rows[2]).max()) / arm)
        for ax, (name, (what, of)), values in zip(panels, NAMES.items(), rows, strict=True):
            least = 1e-7 * force * (arm if name == "M" else 1.0)
            shown = np.where(np.abs(values) < least, 0.0, values)
            ax.plot(x, shown, color=INK, linewidth=1.2, marker="." if len(x) == 1 else "")
            if filled:
                for keep, color in ((shown >= 0.0, TENSION), (shown <= 0.0, COMPRESSION)):
                    ax.fill_between(
                        x, 0.0, shown, keep, color=color, alpha=0.35, lw=0.0, interpolate=True
                    )
            ax.set_ylabel(labeled(f"{what}\n{name}", units, of))
            ax.margins(x=0.0, y=0.12)
            chart(ax)
        panels[-1].set_xlabel(along)
        panels[0].set_title(title, loc="left")
        figure.align_ylabels(panels)
        return finish(figure, path, dpi)

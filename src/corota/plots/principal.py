"""Principal stresses as crosses, and the flow of force as lines."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.names import choose
from corota.plots.contour import frame_title
from corota.plots.figure import (
    COMPRESSION,
    INK,
    TENSION,
    body_figure,
    finish,
    look,
    page_width,
    plane_axes,
)
from corota.plots.rigid import draw_rigid
from corota.plots.surface import outline, surface

if TYPE_CHECKING:
    from os import PathLike

    from corota.arrays import Floats, Ints
    from corota.results.results import Results


#: Crosses, and lines of force, along the longer side of the body and across it where it is thin.
CROSSES, LINES = (45, 6), (24, 8)
#: Lines, or crosses, per inch at most.
MOST = 18.0
#: Stresses below this share of the largest are not drawn.
SMALL = 0.01
#: Kinds of lines: trajectories of both principal stresses, or the flow of a force along an axis.
KINDS = ("principal", "x", "y")


def principal(
    results: Results,
    *,
    frame: int = -1,
    scale: float = 1.0,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw the in-plane principal stresses as crosses, with lengths proportional to the stress.

    Parameters
    ----------
    results : Results
        With stress.
    frame : int
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
        If there is no stress of planar elements.
    """
    mesh = results.mesh
    positions = mesh.points + scale * results.frame(frame).U
    centers, areas, cells = _planar(results, positions, frame)
    low = positions.min(axis=0)
    spacing = _apart(results, positions, float(areas.sum()), *CROSSES)
    spacing = max(spacing, float(np.sqrt(np.median(areas))))
    # Of the cells in a square, the one nearest to its middle.
    square = np.floor((centers - low) / spacing).astype(np.int64)
    order = np.argsort(np.hypot(*(centers - low - (square + 0.5) * spacing).T), kind="stable")
    _, first = np.unique(square[order], axis=0, return_index=True)
    first = order[first]
    stress = np.stack([results.cells(n, frame)[cells[first]] for n in ("S11", "S22", "S12")], 1)
    values, angles = principal_axes(stress)
    largest = float(np.abs(values).max())
    # Otherwise a concentrated load makes the rest too short.
    whole = float(np.quantile(np.abs(values), 0.98)) or largest
    with look():
        from matplotlib.collections import LineCollection

        figure, ax = _body(results, positions, frame, scale, ax, path)
        at = centers[first]
        if largest > 0.0:
            for column, turn in ((0, 0.0), (1, 0.5 * np.pi)):
                direction = np.stack([np.cos(angles + turn), np.sin(angles + turn)], axis=1)
                share = np.clip(values[:, column] / whole, -1.3, 1.3)
                half = 0.48 * spacing * share[:, None] * direction
                drawn = np.abs(share) > SMALL
                for sign, color in ((1.0, TENSION), (-1.0, COMPRESSION)):
                    mine = drawn & (sign * values[:, column] > 0.0)
                    lines = np.stack([at - half, at + half], axis=1)[mine]
                    ax.add_collection(
                        LineCollection(list(lines), colors=color, linewidths=1.1, capstyle="butt")
                    )
        _finish(ax, results, frame, scale, title, f"principal stresses, {_size(results, largest)}")
        return finish(figure, path, dpi)


def flow(
    results: Results,
    kind: str = "principal",
    *,
    frame: int = -1,
    scale: float = 1.0,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw the flow of force through the body, in lines that are wide where stress is large.

    Parameters
    ----------
    results : Results
        With stress.
    kind : {"principal", "x", "y"}
        Trajectories of both principal stresses; or the flow of a force along x (or y):
        lines along the vector of stress (S11, S12) (or S12, S22), between two of which the force
        stays the same (Kelly and Tosh 2000).
    frame, scale, title, path, ax, dpi
        As of :func:`corota.plots.contour`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no stress of planar elements.
    """
    kind = choose(kind, KINDS, "kind of flow")
    positions = results.mesh.points + scale * results.frame(frame).U
    area = float(_planar(results, positions, frame)[1].sum())
    field = _Field(results, positions, frame, _apart(results, positions, area, *LINES))
    with look():
        figure, ax = _body(results, positions, frame, scale, ax, path)
        if kind == "principal":
            largest = field.largest
            for family in (0, 1):
                _draw_lines(ax, field, _trajectory(field, family), largest, signed=True)
            what = f"trajectories of principal stress, {_size(results, largest)}"
        else:
            row = KINDS.index(kind) - 1
            _draw_lines(ax, field, _load_path(row), field.largest, signed=False)
            what = f"flow of force along {kind}"
        _finish(ax, results, frame, scale, title, what, legend=kind == "principal")
        return finish(figure, path, dpi)


def principal_axes(stress: Floats) -> tuple[Floats, Floats]:
    """Principal stresses of the plane and the direction of the first.

    Parameters
    ----------
    stress : ndarray, shape (..., 3)
        Rows xx, yy, xy.

    Returns
    -------
    values : ndarray, shape (..., 2)
        The larger one first.
    angle : ndarray, shape (...)
        Of the first [rad].
    """
    xx, yy, xy = (stress[..., i] for i in range(3))
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    return np.stack([middle + radius, middle - radius], axis=-1), np.asarray(angle)


def _planar(results: Results, positions: Floats, frame: int) -> tuple[Floats, Floats, Ints]:
    """Centers, areas and numbers of the planar cells with stress."""
    has = results.cells_with("S", frame)
    centers, areas, cells = [], [], []
    for offset, block in zip(results.mesh.offsets, results.mesh.cells, strict=False):
        if not block.kind.startswith(("tri", "quad")):
            continue
        mine = np.flatnonzero(has[offset : offset + len(block)])
        corners = positions[block.nodes[mine][:, : 3 if block.kind.startswith("tri") else 4]]
        x, y = corners[..., 0], corners[..., 1]
        following = np.roll(x, -1, 1), np.roll(y, -1, 1)
        areas.append(0.5 * np.abs((x * following[1] - y * following[0]).sum(axis=1)))
        centers.append(corners.mean(axis=1))
        cells.append(mine + offset)
    if not sum(map(len, cells)):
        raise InputError("the results hold no stress of planar elements")
    return np.concatenate(centers), np.concatenate(areas), np.concatenate(cells)


def _apart(results: Results, positions: Floats, area: float, along: int, across: int) -> float:
    """Distance of crosses or lines: so many along the body and across where it is thin."""
    longer = float(np.ptp(positions, axis=0).max())
    rim = sum(
        float(np.hypot(*np.diff(p, axis=0).T).sum()) for p in outline(results.mesh, positions)
    )
    thick = 2.0 * area / rim if rim > 0.0 else longer
    return max(min(longer / along, thick / across), longer / (MOST * page_width()))


def _body(
    results: Results,
    positions: Floats,
    frame: int,
    scale: float,
    ax: Any,
    path: str | PathLike[str] | None,
) -> tuple[Any, Any]:
    """Axes with the outline of the body."""
    from matplotlib.collections import LineCollection

    low, high = positions.min(axis=0), positions.max(axis=0)
    figure, ax, _ = body_figure(ax, low, high, path is None, below=1.6)
    ax.add_collection(
        LineCollection(outline(results.mesh, positions), colors=INK, linewidths=0.8, zorder=3)
    )
    draw_rigid(ax, results.model, results.frame(frame), scale)
    pad = 0.04 * float((high - low).max())
    plane_axes(ax, low, high, pad, results.model.unit_system)
    return figure, ax


def _finish(
    ax: Any,
    results: Results,
    frame: int,
    scale: float,
    title: str | None,
    what: str,
    legend: bool = True,
) -> None:
    if legend:
        for color, name in ((TENSION, "tension"), (COMPRESSION, "compression")):
            ax.plot([], [], color=color, linewidth=1.6, label=name)
        ax.figure.legend(loc="outside lower center", ncols=2)
    heading = f"{what}\n{frame_title(results, frame, scale)}"
    ax.set_title(title if title is not None else heading, loc="left")


def _size(results: Results, largest: float) -> str:
    unit = results.model.unit_system.label("force/length^2")
    return f"up to {largest:.4g}" + (f" {unit}" if unit else "")


class _Field:
    """Stress in the plane on a regular grid, not a number outside of the body."""

    def __init__(self, results: Results, positions: Floats, frame: int, apart: float) -> None:
        mesh = results.mesh
        planar = results.cells_with("S", frame)
        for offset, block in zip(mesh.offsets, mesh.cells, strict=False):
            if not block.kind.startswith(("tri", "quad")):
                planar[offset : offset + len(block)] = False
        part = surface(mesh, planar)
        x, y = part.values(positions).T
        self.low = np.array([x.min(), y.min()])
        self.high = np.array([x.max(), y.max()])
        self.apart, self.step = apart, apart / 5.0
        nx, ny = (np.ceil((self.high - self.low) / self.step).astype(int) + 1).tolist()
        nodal = np.stack([results.nodal(n, frame) for n in ("S11", "S22", "S12")], axis=1)
        corners = (np.stack([x, y], axis=1)[part.triangles] - self.low) / self.step
        self.stress = _on_grid(corners, part.values(nodal)[part.triangles], (ny, nx))
        self.largest = float(np.abs(principal_axes(nodal)[0]).max())

    def at(self, point: Floats) -> Floats | None:
        """Stress (xx, yy, xy) at a point, by bilinear interpolation."""
        u, v = ((point - self.low) / self.step).tolist()
        i, j = int(u), int(v)
        if not (0 <= j < len(self.stress) - 1 and 0 <= i < self.stress.shape[1] - 1):
            return None
        a, b = u - i, v - j
        corner = self.stress[j : j + 2, i : i + 2]
        value = (1 - b) * ((1 - a) * corner[0, 0] + a * corner[0, 1])
        value = value + b * ((1 - a) * corner[1, 0] + a * corner[1, 1])
        return None if np.isnan(value[0]) else np.asarray(value)


def _on_grid(corners: Floats, values: Floats, shape: tuple[int, int]) -> Floats:
    """Values at the corners of triangles, linear between, at the points of a grid.

    Parameters
    ----------
    corners : ndarray, shape (t, 3, 2)
        In steps of the grid.
    values : ndarray, shape (t, 3, k)
    shape : (int, int)
        Points upwards and along.

    Returns
    -------
    ndarray, shape (*shape, k)
        Not a number outside of all triangles.
    """
    out = np.full((*shape, values.shape[2]), np.nan)
    low = np.maximum(np.ceil(corners.min(axis=1) - 1e-9), 0).astype(np.int64)
    last = np.array([shape[1] - 1, shape[0] - 1])
    high = np.minimum(np.floor(corners.max(axis=1) + 1e-9), last).astype(np.int64)
    wide, tall = np.maximum(high - low + 1, 0).T
    owner = np.repeat(np.arange(len(corners)), wide * tall)
    count = np.arange(len(owner)) - np.repeat(np.cumsum(wide * tall) - wide * tall, wide * tall)
    i = low[owner, 0] + count % np.maximum(wide[owner], 1)
    j = low[owner, 1] + count // np.maximum(wide[owner], 1)
    origin, one, two = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
    area = np.where(area == 0.0, np.inf, area)
    x, y = i - origin[owner, 0], j - origin[owner, 1]
    a = (x * two[owner, 1] - y * two[owner, 0]) / area[owner]
    b = (y * one[owner, 0] - x * one[owner, 1]) / area[owner]
    inside = (a >= -1e-9) & (b >= -1e-9) & (a + b <= 1 + 1e-9)
    owner, a, b = owner[inside], a[inside, None], b[inside, None]
    found = (1 - a - b) * values[owner, 0] + a * values[owner, 1] + b * values[owner, 2]
    out[j[inside], i[inside]] = found
    return out


def _trajectory(field: _Field, family: int) -> Any:
    """Direction and size of a principal stress; the direction has no sign."""

    def direction(stress: Floats, before: Floats | None) -> tuple[Floats, float]:
        xx, yy, xy = stress.tolist()
        angle = 0.5 * np.arctan2(2.0 * xy, xx - yy) + 0.5 * np.pi * family
        found = np.array([np.cos(angle), np.sin(angle)])
        radius = float(np.hypot(0.5 * (xx - yy), xy))
        value = 0.5 * (xx + yy) + (radius if family == 0 else -radius)
        if before is not None and found @ before < 0.0:
            found = -found
        return found, value

    return direction


def _load_path(row: int) -> Any:
    """Direction and size of the force on planes across it, along one axis."""

    def direction(stress: Floats, before: Floats | None) -> tuple[Floats, float]:
        vector = stress[[0, 2]] if row == 0 else stress[[2, 1]]
        size = float(np.hypot(*vector))
        found = vector / size if size > 0.0 else np.zeros(2)
        # Tension and compression transmit the same force.
        if before is not None and found @ before < 0.0:
            found = -found
        return found, size

    return direction


def _draw_lines(ax: Any, field: _Field, direction: Any, largest: float, signed: bool) -> None:
    """Trace lines that keep a distance, and draw them."""
    from matplotlib.collections import LineCollection

    if largest <= 0.0:
        return
    apart = field.apart
    taken: set[tuple[int, int]] = set()
    pieces, widths, colors = [], [], []
    seeds = _seeds(field, apart)
    for seed in seeds:
        if _square(field, seed, apart) in taken:
            continue
        points, values = _trace(field, direction, seed, apart, taken, SMALL * largest)
        if len(points) < 16:
            continue
        taken.update(_square(field, p, apart) for p in points)
        middle = 0.5 * (values[1:] + values[:-1])
        pieces.append(np.stack([points[:-1], points[1:]], axis=1))
        widths.append(0.3 + np.sqrt(0.5 * page_width()) * np.sqrt(np.abs(middle) / largest))
        colors += [
            (TENSION if v > 0.0 else COMPRESSION) if signed else INK for v in middle.tolist()
        ]
    if pieces:
        ax.add_collection(
            LineCollection(
                list(np.concatenate(pieces)),
                colors=colors,
                linewidths=np.concatenate(widths),
                capstyle="round",
                zorder=2,
            )
        )


def _seeds(field: _Field, apart: float) -> list[Floats]:
    """Points inside of the body, those with large stress first."""
    step = max(round(0.5 * apart / field.step), 1)
    size = np.abs(field.stress[::step, ::step]).max(axis=-1)
    rows, columns = np.nonzero(np.isfinite(size))
    order = np.argsort(-size[rows, columns], kind="stable")
    at = np.stack([columns, rows], axis=1)[order] * step
    return list(field.low + field.step * at)


def _square(field: _Field, point: Floats, apart: float) -> tuple[int, int]:
    u, v = ((point - field.low) / apart).tolist()
    return int(u), int(v)


def _trace(
    field: _Field,
    direction: Any,
    seed: Floats,
    apart: float,
    taken: set[tuple[int, int]],
    least: float,
) -> tuple[Floats, Floats]:
    """A line through a point both ways, until it leaves the body, fades or meets another."""
    step = 0.5 * apart / 4.0
    most = int(6.0 * float((field.high - field.low).max()) / step)
    halves = []
    for sense in (-1.0, 1.0):
        points: list[Floats] = []
        values: list[float] = []
        at, before = seed, None
        own = {_square(field, seed, apart)}
        for _ in range(most):
            stress = field.at(at)
            if stress is None:
                break
            one, value = direction(stress, before)
            if before is None:
                one = sense * one
            square = _square(field, at, apart)
            if abs(value) < least or (square in taken and square not in own):
                break
            own.add(square)
            points.append(at)
            values.append(value)
            # The midpoint rule.
            half = field.at(at + 0.5 * step * one)
            ahead = one if half is None else direction(half, one)[0]
            at, before = at + step * ahead, ahead
            if len(points) > 20 and float(np.hypot(*(at - seed))) < step:
                points.append(seed)
                values.append(values[0])
                break
        halves.append((points, values))
    (back, a), (front, b) = halves
    points, values = back[:0:-1] + front, a[:0:-1] + b
    return np.array(points).reshape(-1, 2), np.array(values)

"""A variable in colors on the deformed shape, with the undeformed outline."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.plots import palette
from corota.plots.figure import INK, PALE, body_figure, finish, look, plane_axes
from corota.plots.lines import draw_links
from corota.plots.rigid import draw_rigid, with_rigid
from corota.plots.surface import Surface, edge_lines, outline, surface
from corota.results import variables as vf
from corota.results.sampling import sampled
from corota.results.table import NODAL, POSITIVE

if TYPE_CHECKING:
    from os import PathLike

    from corota.arrays import Floats, Ints
    from corota.mesh import Mesh
    from corota.model.units import Units
    from corota.results.results import Results
    from corota.results.source import ResultSource


#: Meshes with fewer cells show their edges by default.
EDGES_UP_TO = 1500
#: Bands of color between the smallest and the largest value.
BANDS = 16
#: More triangles than this are drawn as pixels, also in SVG and PDF.
PIXELS_FROM = 60000


#: Variables of line elements only.
LINE_ONLY = ("N", "V", "M1", "M2", "PR1", "PR2", "SR1", "SL1", "SR2", "SL2")
#: Cells' edges are drawn by default where cells are larger than this share of the picture.
EDGES_FROM = 0.008


@dataclass
class Drawing:
    """Data of a model that are the same for all frames.

    Parameters
    ----------
    name : str
        Variable as :mod:`corota.results.variables` spells it.
    per_cell : bool
        One color a cell, from its average.
    """

    results: Results
    name: str
    per_cell: bool

    def __post_init__(self) -> None:
        results = self.results
        self.groups = results.sections()
        planar = np.zeros(results.mesh.n_cells, dtype=bool)
        for offset, cells in zip(results.mesh.offsets, results.mesh.cells, strict=False):
            planar[offset : offset + len(cells)] = cells.kind.startswith(("tri", "quad"))
        blocks = zip(results.mesh.offsets, results.mesh.cells, strict=False)
        of_lines = [(o + np.arange(len(c)), c.nodes) for o, c in blocks if c.kind == "line2"]
        none = np.zeros(0, np.int64), np.zeros((0, 2), np.int64)
        #: Trusses, beams and springs: their cells and nodes.
        self.lines = tuple(np.concatenate(part) for part in zip(none, *of_lines, strict=True))
        jumps = not self.per_cell and self.name not in NODAL
        self.parts: list[tuple[int | None, Surface]] = [
            (int(g) if jumps else None, surface(results.mesh, (self.groups == g) & planar))
            for g in np.unique(self.groups[planar])
        ]

    def draw(self, frame: int) -> list[tuple[Surface, Floats]]:
        """Values for each part: at its drawn points, or at its triangles if per cell."""
        if self.per_cell:
            cells = self.results.cells(self.name, frame)
            return [(part, cells[part.owner]) for _, part in self.parts]
        return [
            (part, sampled(self.results, self.name, frame, part.values, group))
            for group, part in self.parts
        ]

    def line_values(self, frame: int) -> Floats:
        """Value of each line, not a number where it has none."""
        cells, nodes = self.lines
        if self.name in NODAL:
            return np.asarray(self.results.nodal(self.name, frame)[nodes].mean(axis=1))
        own = np.full(self.results.mesh.n_cells, np.nan)
        try:
            known = self.results.cells(self.name, frame)
        except InputError:
            return np.asarray(own[cells])
        has = self.results.cells_with(self.name, frame)
        own[has] = known[has]
        return np.asarray(own[cells])

    def range(self, frame: int) -> tuple[float, float]:
        """Smallest and largest drawn value."""
        values = [v for _, v in self.draw(frame) if len(v)]
        lines = self.line_values(frame)
        values += [lines[np.isfinite(lines)]] if np.isfinite(lines).any() else []
        if not values:
            return 0.0, 0.0
        return min(float(v.min()) for v in values), max(float(v.max()) for v in values)


def color_scale(low: float, high: float, signed: bool) -> tuple[Any, Floats]:
    """Color map and levels.

    A signed variable has red for positive and blue for negative values, pale near zero: about zero
    for values of both signs, else that half of the map. Others are pale where they are small.
    """
    size = max(abs(low), abs(high))
    if high - low <= 1e-9 * size or size == 0.0:
        pad = 0.5 * size or 1.0
        low, high = low - pad, high + pad
        size = size or pad
    name = palette.map_of(low, high, signed)
    colors = palette.colormap(name)
    if name != palette.DIVERGING:
        return colors, np.linspace(low, high, BANDS + 1)
    levels = np.linspace(-size, size, BANDS + 1)
    used = levels[(levels >= low - 2 * size / BANDS) & (levels <= high + 2 * size / BANDS)]
    return colors, used if len(used) > 2 else levels


def contour(
    results: Results,
    name: str = "MISES",
    *,
    frame: int = -1,
    scale: float = 1.0,
    deformed: bool = True,
    per_cell: bool = False,
    edges: bool | None = None,
    undeformed: bool = True,
    plastic: bool | None = None,
    limits: tuple[float, float] | None = None,
    title: str | None = None,
    path: str | PathLike[str] | None = None,
    ax: Any = None,
    dpi: float = 150.0,
) -> Any:
    """Draw a variable on the deformed shape, and the elastic-plastic boundary on demand.

    Parameters
    ----------
    results : Results
    name : str
        Variable, in any case: ``MISES``, ``S11``, ``SP1``, ``U2``, ...
    frame : int
        The last by default.
    scale : float
        Factor of the drawn displacements; ``deformed=False`` is 0.
    per_cell : bool
        Averages of the cells instead of nodal averages. Nodal averages never mix sections.
    edges : bool, optional
        Draw the cells' edges; by default in meshes of up to 1,500 cells.
    undeformed : bool
        Draw the undeformed outline.
    plastic : bool, optional
        Draw the boundary between elements with plastic strain at some point and those without
        any; by default with ``PEEQ`` only.
    limits : (float, float), optional
        Of the colors.
    title : str, optional
    path : path-like, optional
        Write PNG, SVG or PDF there.
    ax : matplotlib axes, optional
        Draw into these.
    dpi : float

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If there is no such variable or frame, or no plastic strain for its boundary.
    ResourceError
        If matplotlib is missing.
    """
    scale = scale if deformed else 0.0
    state = results.frame(frame)
    name = vf.match_name(name, results.variables(frame))
    if per_cell and name in NODAL:
        raise InputError(
            f"{name} is defined at nodes; only stress and strain are averaged over elements"
        )
    drawing = Drawing(results, name, per_cell)
    with look() as mpl:
        positions = results.mesh.points + scale * state.U
        every = np.concatenate([results.mesh.points, positions]) if undeformed else positions
        low, high = with_rigid(results.model, every.min(axis=0), every.max(axis=0), state, scale)
        figure, ax, below = body_figure(ax, low, high, path is None)
        painted = paint(ax, mpl, drawing, frame, scale, edges, undeformed, limits)
        flows = plastic or (plastic is None and name == "PEEQ")
        if flows:
            draw_boundary(ax, results, frame, scale)
        bar = color_bar(figure, ax, painted, below)
        shown = drawing.range(frame)
        if not per_cell and len(drawing.parts) and not len(drawing.lines[0]):
            found = results.extremes(name, frame, at="nodes")
            shown = found.smallest.value, found.largest.value
        points = "" if per_cell else point_range(results, name, frame)
        more = points + ("; black line: boundary of the flow" if flows else "")
        label_bar(bar, name, per_cell, shown, results.model.unit_system, more)
        plane_axes(ax, low, high, 0.04 * float((high - low).max()), results.model.unit_system)
        ax.set_title(title if title is not None else frame_title(results, frame, scale), loc="left")
        return finish(figure, path, dpi)


def color_bar(figure: Any, ax: Any, painted: Any, below: bool) -> Any:
    """Color bar of what was painted into axes, below or beside them."""
    place, shrink, aspect = ("bottom", 0.75, 38) if below else ("right", 0.8, 28)
    return figure.colorbar(painted, ax=ax, location=place, shrink=shrink, aspect=aspect, pad=0.04)


def without_rounding(low: float, high: float) -> tuple[float, float]:
    """Limits of which one that is small beside the other is zero."""
    size = max(abs(low), abs(high))
    return tuple(0.0 if abs(v) < 1e-6 * size else v for v in (low, high))  # type: ignore[return-value]


def point_range(results: Results, name: str, frame: int) -> str:
    """Words with the extremes at the quadrature points: nodal values are extrapolated from them."""
    if name in NODAL:
        return ""
    try:
        found = results.extremes(name, frame, at="points")
    except InputError:  # a file with nodal values only, or a variable of lines
        return ""
    low, high = without_rounding(found.smallest.value, found.largest.value)
    return f" (extrapolated; points {low:.5g} ... {high:.5g})"


def label_bar(
    bar: Any, name: str, per_cell: bool, limits: tuple[float, float], units: Units, more: str = ""
) -> None:
    """Label a color bar with the smallest and largest value, more words, and few ticks."""
    from matplotlib.ticker import MaxNLocator

    meaning = vf.described(name, units)
    plain = name in NODAL or name in LINE_ONLY
    how = ", element averages" if per_cell else "" if plain else ", nodal"
    label = f"{name}: {meaning}{how}" if meaning else name + how
    low, high = without_rounding(*limits)
    # Below a lying bar the power of ten of its ticks has a row of its own.
    lying = bar.orientation == "horizontal"
    # A standing bar is short: the range begins a line there.
    label += "; " if lying else "\n"
    bar.set_label(f"{label}{low:.5g} ... {high:.5g}{more}", labelpad=9.0 if lying else None)
    bar.outline.set_linewidth(0.5)
    bar.locator = MaxNLocator(7)
    bar.formatter.set_powerlimits((-3, 4))
    bar.update_ticks()
    bar.ax.minorticks_off()
    bar.ax.tick_params(width=0.5, length=2.5)


def frame_title(results: ResultSource, frame: int, scale: float) -> str:
    """Job, step, time and scale of the displacements."""
    state = results.frame(frame)
    shape = "undeformed shape" if scale == 0.0 else f"displacements times {scale:g}"
    when = f"time {state.time:.6g}, load factor {state.factor:.4g}"
    if state.scalars.get("frequency"):
        when = f"frequency {state.scalars['frequency']:.6g}"
    return f"{results.model.name}: step {state.step}, increment {state.increment}, {when}; {shape}"


def paint(
    ax: Any,
    mpl: Any,
    drawing: Drawing,
    frame: int,
    scale: float,
    edges: bool | None,
    undeformed: bool,
    limits: tuple[float, float] | None,
) -> Any:
    """Fill axes with one frame; return what a color bar needs."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import LineCollection
    from matplotlib.colors import BoundaryNorm

    results = drawing.results
    mesh = results.mesh
    ax.set_aspect("equal")
    positions = mesh.points + scale * results.frame(frame).U
    low, high = limits or drawing.range(frame)
    colors, levels = color_scale(low, high, drawing.name not in POSITIVE)
    if colors.name == palette.DIVERGING:
        size = max(abs(low), abs(high))
        norm = BoundaryNorm(np.linspace(-size, size, BANDS + 1), colors.N)
    else:
        norm = BoundaryNorm(levels, colors.N)
    for part, values in drawing.draw(frame):
        if not len(part.triangles):
            continue
        x, y = part.values(positions).T
        pixels = len(part.triangles) > PIXELS_FROM
        if drawing.per_cell:
            ax.tripcolor(
                x,
                y,
                part.triangles,
                facecolors=values,
                cmap=colors,
                norm=norm,
                rasterized=pixels,
                antialiased=False,
            )
        else:
            drawn = ax.tricontourf(
                x,
                y,
                part.triangles,
                np.clip(values, levels[0], levels[-1]),
                levels=levels,
                cmap=colors,
                norm=norm,
                antialiased=False,
            )
            drawn.set_rasterized(pixels)
            drawn.set_edgecolor("face")
            drawn.set_linewidth(0.15)
    _paint_lines(ax, drawing, frame, positions, colors, norm)
    show = _edges_show(mesh, positions) if edges is None else edges
    if show:
        width = 0.35 if mesh.n_cells < 400 else 0.2
        lines = edge_lines(mesh, positions)
        ax.add_collection(LineCollection(lines, colors=INK, linewidths=width, alpha=0.45))
    if undeformed and scale != 0.0:
        lines = outline(mesh, mesh.points)
        ax.add_collection(
            LineCollection(lines, colors=PALE, linewidths=0.8, linestyles=(0, (4, 3)), zorder=0.5)
        )
    slender = edges is None and not show and mesh.n_cells <= EDGES_UP_TO
    ax.add_collection(
        LineCollection(outline(mesh, positions), colors=INK, linewidths=0.35 if slender else 0.8)
    )
    draw_links(ax, results.model, positions)
    draw_rigid(ax, results.model, results.frame(frame), scale)
    painted = ScalarMappable(
        norm=BoundaryNorm(levels, _between(colors, norm, levels).N),
        cmap=_between(colors, norm, levels),
    )
    painted.set_array([])
    return painted


def _edges_show(mesh: Mesh, positions: Floats) -> bool:
    """Whether cells are few, and wide enough in the picture to be seen between their edges."""
    if mesh.n_cells > EDGES_UP_TO:
        return False
    sizes = [
        np.sqrt(np.prod(np.ptp(positions[c.nodes], axis=1), axis=1))
        for c in mesh.cells
        if c.kind.startswith(("tri", "quad"))
    ]
    if not sizes:
        return True
    whole = float(np.ptp(positions, axis=0).max())
    return bool(np.median(np.concatenate(sizes)) > EDGES_FROM * whole)


def _paint_lines(
    ax: Any, drawing: Drawing, frame: int, positions: Floats, colors: Any, norm: Any
) -> None:
    """Trusses, beams and springs as thick lines; those without the variable in ink."""
    from matplotlib.collections import LineCollection

    _, nodes = drawing.lines
    if not len(nodes):
        return
    values = drawing.line_values(frame)
    known = np.isfinite(values)
    ax.add_collection(LineCollection(positions[nodes], colors=INK, linewidths=3.2))
    painted = LineCollection(positions[nodes[known]], cmap=colors, norm=norm, linewidths=2.2)
    painted.set_array(values[known])
    ax.add_collection(painted)
    ax.autoscale_view()


def _between(colors: Any, norm: Any, levels: Floats) -> Any:
    """Color map of the bands between levels only."""
    from matplotlib.colors import ListedColormap

    middle = 0.5 * (levels[1:] + levels[:-1])
    return ListedColormap(colors(norm(middle)))


def boundary(results: Results, frame: int = -1) -> Ints:
    """Edges between cells with plastic strain at some point and cells without any.

    Parameters
    ----------
    results : Results
        With the variable ``PEEQ``.

    Returns
    -------
    ndarray of int, shape (n, 2)
        Corner nodes of the edges.

    Raises
    ------
    InputError
        If the results have no plastic strain.
    """
    if "PEEQ" not in results.variables(frame):
        raise InputError(
            "there is no plastic strain (PEEQ) whose boundary could be drawn: plastic=True is for "
            "models with a material that flows"
        )
    plastic = np.nan_to_num(results.cells("PEEQ", frame)) > 0.0
    edges, flows = [], []
    for offset, cells in zip(results.mesh.offsets, results.mesh.cells, strict=False):
        if not cells.kind.startswith(("tri", "quad")):
            continue
        corners = cells.nodes[:, : 3 if cells.kind.startswith("tri") else 4]
        pairs = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)
        edges.append(np.sort(pairs.reshape(-1, 2), axis=1))
        flows.append(np.repeat(plastic[offset : offset + len(cells)], corners.shape[1]))
    every, flow = np.concatenate(edges), np.concatenate(flows)
    unique, index = np.unique(every, axis=0, return_inverse=True)
    counts = np.bincount(index.ravel(), minlength=len(unique))
    yielding = np.bincount(index.ravel(), weights=flow, minlength=len(unique))
    found: Ints = unique[(counts == 2) & (yielding == 1)]
    return found


def draw_boundary(ax: Any, results: Results, frame: int, scale: float) -> None:
    """Draw the elastic-plastic boundary on the deformed shape."""
    from matplotlib.collections import LineCollection

    positions = results.mesh.points + scale * results.frame(frame).U
    lines = positions[boundary(results, frame)]
    ax.add_collection(LineCollection(list(lines), colors="black", linewidths=1.2, zorder=4))

"""The interactive viewer: results in a window of PyVista, with sliders for time and warp."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.vtk.revolution import Revolution
from corota.plots import palette
from corota.plots.figure import INK
from corota.results import variables as vf
from corota.results.arrays import require
from corota.results.table import NODAL, POSITIVE

if TYPE_CHECKING:
    from os import PathLike

    from corota.results.results import Results


class Viewer:
    """A window on results, controlled by methods, sliders and keys.

    Keys: right and left change the frame, up and down the variable, ``e`` shows and hides the
    edges of elements.

    Parameters
    ----------
    name : str
        Variable; ``MISES``, or ``U`` where nothing is stressed, by default.
    scale : float
        Factor of the displacements.
    off_screen : bool
        Draw without a window, for pictures.
    revolve : float
        Angle [degrees] by which the section of an axisymmetric model is turned; 0 for the section.
    """

    def __init__(
        self,
        results: Results,
        name: str = "",
        scale: float = 1.0,
        off_screen: bool = False,
        revolve: float = 0.0,
    ) -> None:
        pyvista = require("pyvista", "view")
        self.results, self.scale, self.frame, self.edges = (
            results,
            scale,
            len(results.frames) - 1,
            True,
        )
        self.names = results.variables()
        wanted = name or ("MISES" if "MISES" in self.names else "U")
        self.name = vf.match_name(wanted, self.names)
        self._solid = Revolution(results.model, revolve) if revolve else None
        self._grid = results.to_pyvista(self.frame, revolve=revolve)
        self._still = np.column_stack([results.mesh.points, np.zeros(results.mesh.n_nodes)])
        self.plotter = pyvista.Plotter(off_screen=off_screen)
        self.plotter.set_background("white")
        self._actor: Any = None
        self._title: Any = None
        self._limits: dict[str, tuple[float, float]] = {}
        self.draw()
        if self._solid is None:
            self.plotter.view_xy()
        else:
            # Into the quarter that is left out, from above.
            self.plotter.view_vector((1.0, 0.7, -1.0), viewup=(0.0, 1.0, 0.0))
        self.plotter.enable_parallel_projection()

    def limits(self) -> tuple[float, float]:
        """Smallest and largest value of the variable over the first, middle and last frames."""
        if self.name not in self._limits:
            count = len(self.results.frames)
            some = {0, count // 4, count // 2, 3 * count // 4, count - 1}
            values = [self.results.nodal(self.name, i) for i in some]
            low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
            self._limits[self.name] = (low, high if high > low else low + 1.0)
        return self._limits[self.name]

    def draw(self) -> None:
        """Show the current frame, variable and scale."""
        state = self.results.frame(self.frame)
        moved = self._still.copy()
        moved[:, :2] += self.scale * state.U
        shown = self.results.nodal(self.name, self.frame)
        if self._solid is not None:
            moved, shown = self._solid.vectors(moved), self._solid.repeat(shown)
        self._grid.points = moved
        self._grid.point_data["shown"] = shown
        units = self.results.model.unit_system
        title = vf.labeled(self.name, units) + " (nodal)" * (self.name not in NODAL)
        low, high = self.limits()
        colors = palette.map_of(low, high, self.name not in POSITIVE)
        size = max(abs(low), abs(high))
        if self._actor is not None:
            self.plotter.remove_actor(self._actor, render=False)
            for bar in list(self.plotter.scalar_bars.keys()):
                self.plotter.remove_scalar_bar(bar, render=False)
        self._actor = self.plotter.add_mesh(
            self._grid,
            scalars="shown",
            cmap=palette.colormap(colors),
            clim=(-size, size) if colors == palette.DIVERGING else (low, high),
            show_edges=self.edges and self._grid.n_cells <= 20_000,
            line_width=1.0,
            lighting=self._solid is not None,
            scalar_bar_args={"title": title, "color": INK, "vertical": True},
            reset_camera=self._actor is None,
            render=False,
        )
        text = (
            f"{self.results.model.name}: step {state.step}, increment {state.increment}, "
            f"time {state.time:.5g}; displacements times {self.scale:g}"
        )
        self._title = self.plotter.add_text(
            text, position="upper_left", font_size=9, color=INK, name="title", render=False
        )
        self.plotter.render()

    def show_frame(self, index: float) -> None:
        """Show another frame."""
        index = int(np.clip(round(index), 0, len(self.results.frames) - 1))
        if index != self.frame:
            self.frame = index
            self.draw()

    def show_variable(self, step: int) -> None:
        """Show the next variable, or the one before."""
        self.name = self.names[(self.names.index(self.name) + step) % len(self.names)]
        self.draw()

    def warp(self, scale: float) -> None:
        """Change the scale factor of the displacements."""
        self.scale = float(scale)
        self.draw()

    def toggle_edges(self) -> None:
        """Show or hide the edges of elements."""
        self.edges = not self.edges
        self.draw()

    def controls(self) -> None:
        """Add sliders and keys."""
        last = len(self.results.frames) - 1
        if last:
            self.plotter.add_slider_widget(
                callback=self.show_frame,
                rng=[0, last],
                value=self.frame,
                title="frame",
                pointa=(0.05, 0.08),
                pointb=(0.45, 0.08),
                fmt="%.0f",
                color=INK,
                style="modern",
            )
        self.plotter.add_slider_widget(
            callback=self.warp,
            rng=[0.0, max(2.0, 2.0 * self.scale)],
            value=self.scale,
            title="warp",
            pointa=(0.55, 0.08),
            pointb=(0.95, 0.08),
            color=INK,
            style="modern",
        )
        self.plotter.add_key_event("Right", lambda: self.show_frame(self.frame + 1))
        self.plotter.add_key_event("Left", lambda: self.show_frame(self.frame - 1))
        self.plotter.add_key_event("Up", lambda: self.show_variable(1))
        self.plotter.add_key_event("Down", lambda: self.show_variable(-1))
        self.plotter.add_key_event("e", self.toggle_edges)


def view(
    results: Results,
    name: str = "",
    *,
    scale: float = 1.0,
    revolve: float = 0.0,
    path: str | PathLike[str] | None = None,
) -> Any:
    """Show results in a window; in a notebook with trame, if it is installed.

    Parameters
    ----------
    results : Results
    name : str
        Variable; ``MISES``, or ``U`` where nothing is stressed, by default.
    scale : float
        Factor of the displacements.
    revolve : float
        Angle [degrees] by which the section of an axisymmetric model is turned, 270 to see its
        section and its faces; 0 for the section.
    path : path-like, optional
        Write a picture there and open no window.

    Returns
    -------
    object
        PyVista's return value: None after a window, a widget in a notebook.

    Raises
    ------
    ResourceError
        If PyVista is not installed (``pip install corota[view]``).
    """
    viewer = Viewer(results, name, scale, off_screen=path is not None, revolve=revolve)
    if path is not None:
        viewer.plotter.screenshot(str(path))
        viewer.plotter.close()
        return None
    viewer.controls()
    return viewer.plotter.show(title=results.model.name)

"""Results of an analysis, frame by frame; all data are copies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from corota.display import CELLS_DRAWN, Brief, brief, picture, table
from corota.errors import InputError
from corota.lazy import lazy
from corota.results.frame import Frame, PointFields

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike
    from pathlib import Path

    from numpy.typing import ArrayLike

    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.paths import CriticalPoint, Modes
    from corota.model.steps import Step
    from corota.results.averaging import Averaging
    from corota.results.body_motion import BodyMotion
    from corota.results.extremes import Extremes
    from corota.results.history import History
    from corota.results.members import Members
    from corota.results.probe import Line, Place
    from corota.results.section import SectionDiagram, SectionForces
    from corota.results.stage_results import StageResults


# Conveniences: functions of higher layers, which load at their first call.
draw_contour = lazy("corota.plots:contour")
results_grid = lazy("corota.io.vtk.pyvista_bridge:results_grid")
show = lazy("corota.plots:view")
write_report = lazy("corota.report:write_report")
write_results = lazy("corota.io.writers:write")

__all__ = ["Frame", "PointFields", "Results"]


@dataclass(repr=False)
class Results(Brief):
    """All frames of an analysis.

    Parameters
    ----------
    model : Model
    frames : list of Frame
        Increment 0 of the first step first.
    notes : list of str
        Warnings and remarks of the analysis.
    info : dict
        Counts and phase times; ``info["profile"]`` maps a phase to its seconds.
    critical_points : list of CriticalPoint
        Limit and bifurcation points of the paths that were followed.
    modes : list of Modes
        Those of each buckling step.
    keep : {"all", "last"}
        ``"last"`` holds one frame only, for large models whose frames go to disk.
    last_state : Frame or None
        The converged state before `last_iterate`, which a resumed run may have begun with.
    last_iterate : Frame or None
        Last iterate, if the analysis did not converge: not in equilibrium, for
        inspection. Its ``RF`` holds the residual.
    steps : list of Step
        Those that were run.
    """

    model: Model
    frames: list[Frame] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    info: dict[str, Any] = field(default_factory=dict)
    keep: Literal["all", "last"] = "all"
    critical_points: list[CriticalPoint] = field(default_factory=list)
    modes: list[Modes] = field(default_factory=list)
    last_state: Frame | None = None
    last_iterate: Frame | None = None
    steps: list[Step] = field(default_factory=list)

    @property
    def stable(self) -> Floats:
        """1 for frames in stable equilibrium, 0 for unstable ones, nan if unknown; (n_frames,)."""
        return self.scalar_values("stable")

    def scalar_names(self) -> list[str]:
        """Names of the scalars of the frames: those of the whole model, of pairs and of stages."""
        from corota.results.scalars import OF_FRAMES

        return list(dict.fromkeys([*OF_FRAMES, *(key for f in self.frames for key in f.scalars)]))

    def scalar_values(self, name: str) -> Floats:
        """A scalar of all frames, shape (n_frames,); in frames without it 0, or NaN if unknown."""
        import numpy as np

        from corota.results.scalars import OF_FRAMES, where_missing

        if name in OF_FRAMES:
            return np.array([float(getattr(f, OF_FRAMES[name])) for f in self.frames])
        missing = where_missing(name)
        return np.array([f.scalars.get(name, missing) for f in self.frames])

    def add(self, frame: Frame) -> None:
        """Take a frame; with ``keep="last"`` it replaces the one before."""
        if self.keep == "last":
            self.frames.clear()
        self.frames.append(frame)

    @property
    def mesh(self) -> Mesh:
        """Mesh of the model."""
        return self.model.mesh

    @property
    def times(self) -> Floats:
        """Total times of the frames, shape (n_frames,) [time]."""
        return self.scalar_values("time")

    @property
    def averaging(self) -> Averaging:
        """Map from points to nodes; computed once."""
        if self._averaging is None:
            from corota.results.averaging import Averaging

            self._averaging = Averaging(self.model.mesh, self.sections())
        return self._averaging

    _averaging: Averaging | None = field(default=None, init=False, repr=False, compare=False)

    def frame(self, index: int = -1) -> Frame:
        """One frame, the last by default.

        Raises
        ------
        InputError
            If there is none.
        """
        if not -len(self.frames) <= index < len(self.frames):
            raise InputError(f"no frame {index}; there are {len(self.frames)}, counted from 0")
        return self.frames[index]

    def variables(self, index: int = -1) -> list[str]:
        """Variable names for :meth:`nodal`, :meth:`history` and :meth:`plot`."""
        from corota.results.variables import names_of

        return names_of(self.frame(index))

    def nodal(self, name: str, index: int = -1, section: int | None = None) -> Floats:
        """Nodal values, shape (n_nodes,).

        Stress, strain and other results are computed at the quadrature points: their nodal values
        are extrapolated and averaged within one section, and at a border of sections the larger by
        size (:data:`corota.results.averaging.AVERAGING`). :meth:`extremes` and :meth:`history`
        take the values at the points.

        Parameters
        ----------
        name : str
            Such as ``U2``, ``S11``, ``MISES``, ``SP1``, in any case.
        index : int
            Frame, the last by default.
        section : int, optional
            Average over the cells of this section group only (:meth:`sections`).

        Raises
        ------
        InputError
            If there is no such variable.
        """
        from corota.results.averaging import stored_at_nodes
        from corota.results.table import NODAL
        from corota.results.variables import canonical, nodal_value

        frame = self.frame(index)
        name = canonical(name, frame)
        if name in NODAL:
            return nodal_value(frame, name)
        if not frame.fields:
            return stored_at_nodes(frame, name, section)
        return self.averaging.values(frame.fields, name, section)

    def sections(self) -> Ints:
        """Section group of each cell, -1 without; shape (n_cells,)."""
        from corota.results.averaging import section_of_cells

        return section_of_cells(self.model)

    def cells(self, name: str, index: int = -1) -> Floats:
        """Volume averages over the cells, shape (n_cells,), 0 where there are none.

        Invariants are taken from the averaged components.
        """
        from corota.results.averaging import cell_values
        from corota.results.variables import canonical

        frame = self.frame(index)
        return cell_values(frame, canonical(name, frame), self.mesh.n_cells)

    def extremes(
        self, name: str, frame: int = -1, at: Literal["points", "nodes"] = "points"
    ) -> Extremes:
        """Smallest and largest value of a variable, and the larger by size, with their places.

        Parameters
        ----------
        name : str
        frame : int
        at : {"points", "nodes"}
            The values at quadrature points, or the nodal ones (:meth:`nodal`). Displacements,
            forces and contact are at the nodes in any case.

        Raises
        ------
        InputError
            If there is no such variable, or a file has no values at points.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", x=-1.0)
        >>> found = ct.solve(model, ct.Static(), threads=1).extremes("U1")
        >>> found.by_size is found.smallest, found.largest.value
        (True, 0.0)
        """
        from corota.results.extremes import extremes

        return extremes(self, name, frame, at)

    def cells_with(self, name: str, index: int = -1) -> Bools:
        """Whether each cell has a variable at its points, shape (n_cells,)."""
        from corota.results.averaging import cells_with

        return cells_with(self.frame(index), name, self.mesh.n_cells)

    def history(
        self,
        name: str,
        at: str | int | Sequence[int] | None = None,
        combine: Literal["auto", "sum", "mean", "max", "min", "absmax"] = "auto",
    ) -> History:
        """One number for each frame.

        Parameters
        ----------
        name : str
            A nodal or point variable, ``"time"``, ``"load factor"``, ``"step"``, ``"increment"``,
            or a scalar of the frames such as ``"strain energy"``.
        at : str, int or array_like, optional
            Set, node index or indices, or a mask of nodes; everywhere by default. Stress, strain
            and other variables at points are taken at the quadrature points: of the whole model, or
            of an element set. At nodes they are nodal values (:meth:`nodal`), which the name of the
            history says; ``"nodes"`` are those of all nodes.
        combine : {"auto", "sum", "mean", "max", "min", "absmax"}
            Reducer: ``"absmax"`` is the value of the largest size, with its sign; of it, ``max``
            and ``min`` the history has the ``places``. ``"auto"``: forces
            are summed (``RF`` and ``F`` are the size of the resultant), at nodes other variables
            are averaged; everywhere and in element sets the value of the largest size is taken.

        Raises
        ------
        InputError
            If the variable or the set is unknown.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", y=0.01)
        >>> results = ct.solve(model, ct.Static(increments=2), threads=1)
        >>> deflection = results.history("U2", at="right")
        >>> len(deflection), bool(deflection[-1] > deflection[1] > 0.0)
        (3, True)

        ``deflection.plot(against="load factor")`` draws the curve.
        """
        from corota.results.reduction import history

        return history(self, name, at, combine)

    def plot(self, name: str = "", **options: Any) -> Any:
        """Draw a contour on the deformed shape; see :func:`corota.plots.contour`.

        Parameters
        ----------
        name : str
            Variable; by default ``MISES`` (``MISESA`` of a harmonic response), or ``U`` where
            nothing is stressed.
        **options
            Those of :func:`corota.plots.contour`.
        """
        if not name:
            known = self.variables(options.get("frame", -1))
            name = next((n for n in ("MISESA", "MISES") if n in known and self.nodal(n).any()), "U")
        return draw_contour(self, name, **options)

    def view(
        self,
        name: str = "",
        *,
        scale: float = 1.0,
        revolve: float = 0.0,
        path: str | PathLike[str] | None = None,
    ) -> Any:
        """Show the results in a PyVista window; see :func:`corota.plots.view`.

        Parameters
        ----------
        name : str
            Variable; ``MISES``, or ``U`` where nothing is stressed, by default.
        scale : float
            Factor of the displacements.
        revolve : float
            Angle [degrees] by which the section of an axisymmetric model is turned, such as 270.
        path : path-like, optional
            Write a picture there and open no window.

        Raises
        ------
        ResourceError
            If PyVista is not installed (``pip install corota[view]``).
        """
        return show(self, name, scale=scale, revolve=revolve, path=path)

    def write(self, path: str | PathLike[str], **options: Any) -> Path:
        """Write to a file; its extension selects the format (:mod:`corota.io.writers`).

        Parameters
        ----------
        path : path-like
            ``.vtkhdf``, ``.pvd``, ``.vtu``, ``.npz``, ``.csv``, ``.dat`` or ``.sta``.
        **options
            Of ``.vtkhdf``: ``points``, ``single``, ``fields``, ``compression``
            (:class:`corota.io.file_options.FileOptions`).

        Raises
        ------
        InputError
            If the ending is unknown.
        FileError
            If the file cannot be written.
        """
        written: Path = write_results(self, path, **options)
        return written

    def report(self, path: str | PathLike[str], **options: Any) -> Path:
        """Write an HTML page of the results; see :func:`corota.report.write_report`.

        Parameters
        ----------
        path : path-like
            ``.html``; one file that needs no network.
        **options
            Those of :func:`corota.report.write_report`.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        written: Path = write_report(self, path, **options)
        return written

    def body_motion(self, nodes: str | ArrayLike) -> BodyMotion:
        """Motion of a stage: its rotation, the displacement of its points, centers of rotation.

        Parameters
        ----------
        nodes : str or array_like of int
            Set, selection, or node indices that move as a rigid body.

        Returns
        -------
        BodyMotion

        Raises
        ------
        InputError
            If there are no such nodes, or they lie at one place and do not rotate.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", y=0.01)
        >>> motion = ct.solve(model, ct.Static(), threads=1).body_motion("right")
        >>> bool(motion.rotation[-1] > 0.0)
        True
        """
        import numpy as np

        from corota.results.body_motion import fit_rigid_motion

        rows = self.mesh.node_indices(nodes)
        U = np.array([frame.U[rows] for frame in self.frames])
        UR = np.array([frame.UR[rows] for frame in self.frames])
        return fit_rigid_motion(self.mesh.points[rows], U, UR)

    def stage(self, name: str = "") -> StageResults:
        """Path of a stage: motion, force and stiffness as arrays; pseudo-rigid body; spring table.

        Parameters
        ----------
        name : str
            That of :meth:`corota.model.stages.Stages.stage`; may be omitted where there is one.

        Raises
        ------
        InputError
            If there is no such stage.
        """
        from corota.results.stage_results import stage_results

        return stage_results(self, name)

    def at(
        self,
        where: str | ArrayLike | None = None,
        *,
        node: int | None = None,
        point: ArrayLike | None = None,
    ) -> Place:
        """Results at one place.

        Parameters
        ----------
        where : str or array_like of int, optional
            Set, or node indices.
        node : int, optional
            The user's number of a node.
        point : array_like, shape (2,), optional
            A point of the undeformed shape [length]; values are interpolated in its element.

        Returns
        -------
        Place
            ``place["U2"]`` is the history of a variable there.

        Raises
        ------
        InputError
            If there is no such node or set, or the point is in no element.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", y=0.01)
        >>> results = ct.solve(model, ct.Static(), threads=1)
        >>> results.at(point=(10.0, 0.5))["U2"].max() > results.at(point=(5.0, 0.5))["U2"].max()
        True
        """
        from corota.results.probe import place

        return place(self, node, point, where)

    def along(
        self,
        path: str | ArrayLike,
        *,
        points: int = 101,
        frame: int = -1,
        spread: Literal["even", "given"] = "even",
    ) -> Line:
        """Results along a line of the undeformed shape.

        Parameters
        ----------
        path : str or array_like, shape (n, 2)
            Corners of the line [length], or an edge or node set, whose nodes are taken.
        points : int
            Points on the whole line, evenly spread.
        frame : int
        spread : {"even", "given"}
            ``"given"`` takes the points of `path` themselves.

        Returns
        -------
        Line
            ``line["S11"]`` are the values at its points, nan outside of the body.

        Raises
        ------
        InputError
            If the path is invalid, or outside of all elements.
        """
        from corota.results.probe import line

        return line(self, path, points, frame, spread)

    def section(
        self,
        start: ArrayLike,
        end: ArrayLike,
        *,
        frame: int = -1,
        cells: str | ArrayLike | None = None,
    ) -> SectionForces:
        """Section forces N, V and M of a straight cut, as of a free body.

        Parameters
        ----------
        start, end : array_like, shape (2,)
            Points of the undeformed shape, outside of the body or on its surface [length]. The
            normal points to the right of the direction between them: along x for an upward cut.
        frame : int
        cells : str or array_like of int, optional
            Cut this element set only, where others lie on the line too.

        Returns
        -------
        SectionForces
            About the center of the cut in the deformed body. The transmitted forces are summed at
            the
            nodes of the elements next to the cut, ahead of it.

        Raises
        ------
        InputError
            If the cut misses the body, or ends inside it.

        Examples
        --------
        >>> import corota as ct
        >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
        >>> model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
        >>> model.fix("left")
        >>> model.force("right", y=-0.001, total=True)
        >>> results = ct.solve(model, ct.Static(), threads=1)
        >>> cut = results.section((4.0, 0.0), (4.0, 1.0))
        >>> round(cut.V, 6), round(cut.M, 5)
        (-0.001, -0.006)
        """
        from corota.results.section import Cut

        return Cut(self, start, end, cells).forces(frame)

    def section_history(
        self, name: str, start: ArrayLike, end: ArrayLike, *, cells: str | ArrayLike | None = None
    ) -> History:
        """``N``, ``V`` or ``M`` of a cut over the frames; see :meth:`section`."""
        from corota.results.section import Cut

        return Cut(self, start, end, cells).history(name)

    def section_diagram(
        self, axis: ArrayLike, width: float, *, cuts: int = 41, frame: int = -1
    ) -> SectionDiagram:
        """N, V and M of planar elements along an axis, by cuts across it.

        Parameters
        ----------
        axis : array_like, shape (n, 2)
            Points of the undeformed shape along the member [length].
        width : float
            Length of the cuts, half of it on either side [length]; they end outside of the body.
        cuts : int
        frame : int

        Returns
        -------
        SectionDiagram
            With a method ``plot``.

        Raises
        ------
        InputError
            As :meth:`section`.
        """
        from corota.results.section import diagram

        return diagram(self, axis, width, cuts, frame)

    def member_forces(self, cells: str | ArrayLike | None = None, *, frame: int = -1) -> Members:
        """N, V and M of trusses and beams.

        Parameters
        ----------
        cells : str or array_like of int, optional
            Element set or cells; all line elements with section forces by default.
        frame : int

        Returns
        -------
        Members
            With a method ``plot``.

        Raises
        ------
        InputError
            If there are none.
        """
        from corota.results.members import members

        return members(self, cells, frame)

    def to_xarray(
        self, variables: Sequence[str] | None = None, frames: Sequence[int] | None = None
    ) -> Any:
        """Fields at the nodes as an ``xarray.Dataset``.

        Parameters
        ----------
        variables : sequence of str, optional
            ``U``, ``S`` and the like with all components, or single ones as :meth:`nodal`
            takes; all by default.
        frames : sequence of int, optional
            All by default, which may take much memory.

        Returns
        -------
        xarray.Dataset
            Dimensions ``frame``, ``node`` (the user's numbers) and ``component`` (x, y) or
            ``tensor`` (11, 22, 33, 12); coordinates ``time``, ``load_factor``, ``step``,
            ``increment``, ``x``, ``y``; the attribute ``units`` of each variable where the model
            has units.

        Raises
        ------
        ResourceError
            If xarray is not installed (``pip install corota[data]``).
        """
        from corota.results.arrays import to_xarray

        return to_xarray(self, variables, frames)

    def to_dataframe(self, *histories: History | str) -> Any:
        """Histories as a ``pandas.DataFrame`` over the total time.

        Parameters
        ----------
        *histories : History or str
            Columns; by default all scalars of the frames.

        Raises
        ------
        ResourceError
            If pandas is not installed (``pip install corota[data]``).
        """
        from corota.results.arrays import to_dataframe

        return to_dataframe(self, histories)

    def to_pyvista(self, frame: int = -1, *, scale: float = 0.0, revolve: float = 0.0) -> Any:
        """One frame as a ``pyvista.UnstructuredGrid`` with the arrays of result files.

        Parameters
        ----------
        frame : int
        scale : float
            Factor of the displacements of the points; 0 for the undeformed shape.
        revolve : float
            Angle [degrees] by which the section of an axisymmetric model is turned about its axis,
            270 for a solid that shows its section; 0 for the section alone. Vectors turn with it;
            tensors keep their radial, axial and hoop components.

        Raises
        ------
        InputError
            If a model that is not axisymmetric is to be revolved.
        ResourceError
            If PyVista is not installed (``pip install corota[view]``).
        """
        return results_grid(self, frame, scale, revolve)

    def close(self) -> None:
        """Close the file that the results are read from, if there is one."""

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def _instability(self) -> str:
        """Which frames are unstable, in a few words; empty for none."""
        unstable = (self.stable == 0.0).nonzero()[0]
        if not len(unstable):
            return ""
        return f"unstable in {len(unstable):,} frames from time {self.times[unstable[0]]:g} on"

    def summary(self) -> str:
        """The results in a few lines: extremes of displacement and stress, stability, notes.

        Returns
        -------
        str
        """
        lines = [repr(self)]
        if self.frames:
            names = [
                name
                for name in ("U", "UA1", "UA2", "MISES", "MISESA", "S11", "S22")
                if name in self.variables()
            ]
            for name in names:
                lines.append(f"  {self.extremes(name, at=self._places)}")
            if unstable := self._instability():
                lines.append(f"  {unstable}: a real structure snaps or buckles before")
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])

    @property
    def _places(self) -> Literal["points", "nodes"]:
        """Where the last frame has its stress."""
        last = self.frames[-1]
        return "points" if last.fields or last.extremes else "nodes"

    def __repr__(self) -> str:
        frames = len(self.frames)
        text = f"Results({brief(self.model.name)}: {frames:,} frames"
        if frames:
            last = self.frames[-1]
            text += f", last step {last.step} increment {last.increment} time {last.time:g}"
            text += f", {self._instability()}" * bool(self._instability())
        return text + f", {len(self.modes)} sets of modes)" if self.modes else text + ")"

    def _repr_html_(self) -> str:
        rows: dict[str, object] = {
            "model": self.model.name,
            "nodes": f"{self.mesh.n_nodes:,}",
            "elements": f"{self.mesh.n_cells:,}",
            "frames": f"{len(self.frames):,}",
        }
        drawn = ""
        if self.frames:
            last = self.frames[-1]
            rows["last"] = f"step {last.step}, increment {last.increment}, time {last.time:g}"
            if unstable := self._instability():
                rows["stability"] = unstable
            unit = self.model.unit_system.label("length")
            rows["largest displacement"] = f"{self.history('U').max():.6g} {unit}"
            rows["variables"] = ", ".join(self.variables()[:40])
            if self.mesh.n_cells <= CELLS_DRAWN:
                drawn = picture(lambda path: self.plot(path=path, dpi=80.0))
        for number, note in enumerate(self.notes[:10], 1):
            rows[f"note {number}"] = note
        return drawn + table(rows)

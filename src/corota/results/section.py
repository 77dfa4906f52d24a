"""Section forces: the resultant of the forces transmitted through a cut of the body."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.arrays import Bools, Floats, Ints, distinct
from corota.display import Brief
from corota.errors import InputError
from corota.lazy import lazy
from corota.mesh.kinds import EDGES, KINDS
from corota.mesh.parts import parts_without
from corota.mesh.shape_functions import shape_functions, shape_gradients
from corota.model import elements
from corota.results.history import History

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.mesh import Mesh
    from corota.results.frame import Frame
    from corota.results.source import ResultSource


# A convenience: a function of a higher layer, which loads at its first call.
draw_diagram = lazy("corota.plots:section_diagram")

#: Share of the model's size below which a node lies on the cut, and a cut ends on the surface.
ON = 1e-7
#: Share of the forces by which both parts of a free body may differ.
BALANCED = 1e-6
#: What is said where only stresses are left.
INTEGRATED = (
    "the section force is integrated from stresses and does not balance the loads exactly: the "
    "results contain no forces of the elements; call section() on the results of solve(), or write "
    "the file with values at points (--points)"
)


@dataclass(repr=False)
class SectionForces(Brief):
    """Resultant of a cut, in axes that rotate with the body.

    The normal points to the right of the direction from the first to the second point of the cut:
    an
    upward cut has it along x. The forces are those that the part ahead exerts on the part behind,
    along the normal and along the cut. The signs are those of beams.

    Parameters
    ----------
    N : float
        Normal force, positive in tension [force].
    V : float
        Shear force along the cut from its first to its second point; ``-dM/ds`` along the normal
        where no load acts [force].
    M : float
        Bending moment about the center, positive if it stretches the side of the first point
        (for a cut upwards: the lower side) [force*length].
    force : ndarray, shape (2,)
        The same force in global axes.
    center : ndarray, shape (2,)
        Center of the cut in the deformed body [length].
    normal : ndarray, shape (2,)
        Of the cut in the deformed body.
    length : float
        Length of the cut inside of planar elements, undeformed.
    method : str
        ``"element forces"`` (exact), ``"free body"`` (exact, from loads and reactions), or
        ``"stress"`` (integrated; as good as the stress, with a warning).
    """

    N: float
    V: float
    M: float
    force: Floats
    center: Floats
    normal: Floats
    length: float
    method: str


@dataclass
class _Crossing:
    """Cells of one kind that a cut goes through."""

    kind: str
    cells: Ints
    nodes: Ints
    ahead: Bools
    # Of each cell the ends of its part of the cut: nodes and share between them.
    ends: Ints  # (n, 2, 2)
    share: Floats  # (n, 2)
    length: Floats  # (n,)
    middle: Floats  # (n,), along the cut


class Cut:
    """A straight cut through the undeformed body.

    Parameters
    ----------
    results : Results
    start, end : array_like, shape (2,)
        Points outside of the body or on its surface [length].
    cells : str or array_like of int, optional
        Cut these cells only.

    Raises
    ------
    InputError
        If the cut misses the body, or ends inside it.
    """

    def __init__(
        self,
        results: ResultSource,
        start: ArrayLike,
        end: ArrayLike,
        cells: str | ArrayLike | None = None,
    ) -> None:
        self.results = results
        mesh = results.mesh
        if _is_ring(results):
            raise InputError(
                "section forces are for planar models: around the axis of an axisymmetric one the "
                "radial forces and the moments of a cut balance by themselves; sum the reactions "
                "along the axis, or integrate 2 pi r S"
            )
        first, last = (np.asarray(p, dtype=np.float64) for p in (start, end))
        if first.shape != (2,) or last.shape != (2,) or not np.isfinite([first, last]).all():
            raise InputError(f"a cut needs two points (x, y), not {start!r} and {end!r}")
        self.start, self.end = first, last
        whole = float(np.hypot(*(last - first)))
        if whole == 0.0:
            raise InputError("a cut needs two different points")
        along = (last - first) / whole
        normal = np.array([along[1], -along[0]])
        size = float(np.ptp(mesh.points, axis=0).max()) or 1.0
        self._chosen = _mask(mesh, cells)
        distance = (mesh.points - first) @ normal
        way = (mesh.points - first) @ along
        self.ahead = distance > -ON * size
        self.crossings = [
            found
            for offset, block in zip(mesh.offsets, mesh.cells, strict=False)
            if (found := self._cross(block, int(offset), distance, way, whole, size)) is not None
        ]
        if not self.crossings:
            raise InputError(
                f"the cut from ({first[0]:g}, {first[1]:g}) to ({last[0]:g}, {last[1]:g}) meets no "
                "element (undeformed coordinates)"
            )

    def _cross(
        self, block: Any, offset: int, distance: Floats, way: Floats, whole: float, size: float
    ) -> _Crossing | None:
        nodes = block.nodes
        if EDGES[block.kind]:
            sides = [e if len(e) == 2 else (e[0], e[2], e[1]) for e in EDGES[block.kind]]
            pairs = [p for s in sides for p in pairwise(s)]
        elif block.kind == "line2":
            pairs = [(0, 1)]
        else:
            return None
        here = self._chosen[offset : offset + len(nodes)]
        side = self.ahead[nodes]
        rows = np.flatnonzero(here & side.any(axis=1) & ~side.all(axis=1))
        if not len(rows):
            return None
        nodes = nodes[rows]
        ends = nodes[:, np.array(pairs)]  # (n, m, 2)
        crosses = self.ahead[ends[..., 0]] != self.ahead[ends[..., 1]]
        a, b = distance[ends[..., 0]], distance[ends[..., 1]]
        gap = np.where(crosses, b - a, 1.0)
        share = np.clip(np.where(crosses, -a / gap, 0.0), 0.0, 1.0)
        at = way[ends[..., 0]] * (1 - share) + way[ends[..., 1]] * share
        low = np.where(crosses, at, np.inf).argmin(axis=1)
        high = np.where(crosses, at, -np.inf).argmax(axis=1)
        every = np.arange(len(rows))
        begin, stop = at[every, low], at[every, high]
        middle = 0.5 * (begin + stop)
        inside = (middle > -ON * size) & (middle < whole + ON * size)
        self._whole(block, rows, begin, stop, whole, 1e3 * ON * size)
        if not inside.any():
            return None
        picked = np.stack([low, high], axis=1)
        return _Crossing(
            block.kind,
            (rows + offset)[inside],
            nodes[inside],
            self.ahead[nodes[inside]],
            ends[every[:, None], picked][inside],
            share[every[:, None], picked][inside],
            (stop - begin)[inside],
            middle[inside],
        )

    @staticmethod
    def _whole(
        block: Any, rows: Ints, begin: Floats, stop: Floats, whole: float, near: float
    ) -> None:
        """Refuse a cut that ends inside of a cell."""
        for at, name in ((0.0, "begins"), (whole, "ends")):
            inside = np.flatnonzero((begin < at - near) & (stop > at + near))
            if len(inside):
                raise InputError(
                    f"the cut {name} inside element {block.labels[rows[inside[0]]]}: a section "
                    "goes through the whole body; let it begin and end outside"
                )

    def forces(self, frame: int = -1) -> SectionForces:
        """Resultant in a frame.

        Raises
        ------
        InputError
            If the result file contains no stress.
        """
        state = self.results.frame(frame)
        moved = state.U if self._nlgeom(state) else 0.0
        positions = self.results.mesh.points + moved
        center, normal = self._place(positions)
        found, method = self._of_elements(state, positions, center), "element forces"
        if found is None:
            found, method = self._free_body(state, positions, center), "free body"
        if found is None:
            found, method = self._of_stress(state, positions, center, frame), "stress"
            warnings.warn(INTEGRATED, stacklevel=3)
        force, moment = found
        across = np.array([-normal[1], normal[0]])
        return SectionForces(
            float(force @ normal),
            float(force @ across),
            moment,
            force,
            center,
            normal,
            float(sum(c.length.sum() for c in self.crossings)),
            method,
        )

    def history(self, name: str = "M") -> History:
        """``N``, ``V`` or ``M`` over the frames."""
        name = name.upper()
        if name not in ("N", "V", "M"):
            raise InputError(f"a section has N, V and M, not {name!r}")
        values = [getattr(self.forces(i), name) for i in range(len(self.results.frames))]
        return History(f"section {name}", np.array(values), self.results)

    def _place(self, positions: Floats) -> tuple[Floats, Floats]:
        """Center and normal of the cut in the deformed body."""
        ends = np.concatenate(
            [
                positions[c.ends[..., 0]] * (1 - c.share)[..., None]
                + positions[c.ends[..., 1]] * c.share[..., None]
                for c in self.crossings
            ]
        )
        length = np.concatenate([c.length for c in self.crossings])
        depth = np.concatenate([_depth(self.results, c) for c in self.crossings])
        # The centroid of the area: along a piece the thickness is linear.
        weight = length[:, None] * (depth + depth[:, ::-1] / 2.0) / 3.0
        if weight.sum() <= 0.0:
            weight = np.ones(weight.shape)
        center = np.einsum("nei,ne->i", ends, weight) / weight.sum()
        middle = np.concatenate([c.middle for c in self.crossings])
        chord = ends[middle.argmax(), 1] - ends[middle.argmin(), 0]
        size = float(np.hypot(*chord))
        if length.sum() > 0.0 and size > 0.0:
            chord = chord / size
            return center, np.array([chord[1], -chord[0]])
        # Line elements alone: along their axis.
        axes = []
        for c in self.crossings:
            axis = positions[c.nodes[:, 1]] - positions[c.nodes[:, 0]]
            axes.append(np.where(c.ahead[:, 1:2], axis, -axis))
        axis = np.concatenate(axes)
        axis = (axis / np.hypot(*axis.T)[:, None]).sum(axis=0)
        return center, axis / np.hypot(*axis)

    def _nlgeom(self, state: Frame) -> bool:
        """Whether the frame's step has large displacements: equilibrium of the deformed shape."""
        steps = self.results.steps or self.results.model.steps
        if 0 < state.step <= len(steps):
            return steps[state.step - 1].nlgeom
        described = getattr(self.results, "description", {}).get("steps", [])
        if 0 < state.step <= len(described):
            return bool(described[state.step - 1].get("nlgeom", False))
        return True

    def _of_elements(
        self, state: Frame, positions: Floats, center: Floats
    ) -> tuple[Floats, float] | None:
        """By the forces of the nodes ahead on the elements; None if not all were recorded."""
        force, moment = np.zeros(2), 0.0
        for crossing in self.crossings:
            values = np.zeros((*crossing.nodes.shape, 3))
            known = np.zeros(len(values), dtype=bool)
            for block in state.fields:
                mine = np.isin(crossing.cells, block.cells)
                if block.forces is None or not mine.any():
                    continue
                rows = np.searchsorted(block.cells, crossing.cells[mine])
                values[mine, :, : block.forces.shape[2]] = block.forces[rows]
                known |= mine
            if not known.all():
                return None
            ahead = crossing.ahead
            one, turn = _resultant(positions[crossing.nodes][ahead], values[ahead], center)
            force, moment = force + one, moment + turn
        return force, moment

    def _free_body(
        self, state: Frame, positions: Floats, center: Floats
    ) -> tuple[Floats, float] | None:
        """From loads and reactions of the part behind, if the cut severs it from the rest."""
        mesh = self.results.mesh
        moving = any(v is not None and v.any() for v in (state.V, state.A))
        closed = state.C is not None and state.C[:, 4].any()
        described = getattr(self.results, "description", {})
        joined = bool(
            self.results.model.constraints or described.get("couplings") or described.get("joints")
        )
        if moving or closed or joined or {"RF", "F"} & state.absent:
            return None
        if self.results.model.contacts:
            return None
        crossed = np.zeros(mesh.n_cells, dtype=bool)
        for c in self.crossings:
            crossed[c.cells] = True
        part = parts_without(mesh, crossed)
        behind = distinct(np.concatenate([part[c.nodes[~c.ahead]] for c in self.crossings]))
        ahead = distinct(np.concatenate([part[c.nodes[c.ahead]] for c in self.crossings]))
        if np.isin(behind, ahead).any():
            return None
        outside = state.F + state.RF
        found = []
        for parts in (behind, ahead):
            mine = np.isin(part, parts)
            found.append(_resultant(positions[mine], outside[mine], center))
        (back, turn), (front, other) = found
        size = max(float(np.abs(outside[:, :2]).sum()), 1e-300)
        arm = float(np.ptp(mesh.points, axis=0).max()) or 1.0
        off = max(float(np.abs(back + front).max()), abs(turn + other) / arm)
        return (front, other) if off <= BALANCED * size else None

    def _of_stress(
        self, state: Frame, positions: Floats, center: Floats, index: int
    ) -> tuple[Floats, float]:
        """By the stress in the deformed elements, and the forces of line elements."""
        self._need_plain_elements()
        force, moment = np.zeros(2), 0.0
        for crossing in self.crossings:
            if crossing.kind == "line2":
                values = self._of_lines(crossing, positions, index)
            else:
                values = self._of_planes(crossing, state, positions, index)
            nodes, ahead = crossing.nodes, crossing.ahead
            one, turn = _resultant(positions[nodes][ahead], values[ahead], center)
            force, moment = force + one, moment + turn
        return force, moment

    def _need_plain_elements(self) -> None:
        """Refuse elements whose nodal forces do not follow from their stress."""
        described = getattr(self.results, "description", {}).get("sections", [])
        names = {s.element for s in self.results.model.sections} | {s["element"] for s in described}
        for name in sorted(names):
            facts = elements.known(name)
            if facts is not None and (facts.stabilized or facts.drilling):
                raise InputError(
                    f"the nodal forces of {name} do not follow from its stress alone, and the part "
                    "cut off cannot be balanced with loads and reactions: call section() on the "
                    "results of solve(), or write the file with values at points (--points)"
                )

    def _of_lines(self, crossing: _Crossing, positions: Floats, index: int) -> Floats:
        ends = positions[crossing.nodes]
        axis = ends[:, 1] - ends[:, 0]
        axis = axis / np.hypot(*axis.T)[:, None]
        across = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
        names = self.results.variables(index)
        n, v, m1, m2 = (
            self.results.cells(name, index)[crossing.cells]
            if name in names
            else np.zeros(len(axis))
            for name in ("N", "V", "M1", "M2")
        )
        pull = n[:, None] * axis + v[:, None] * across
        first = np.column_stack([-pull, -m1])
        return np.stack([first, np.column_stack([pull, m2])], axis=1)

    def _of_planes(
        self, crossing: _Crossing, state: Frame, positions: Floats, index: int
    ) -> Floats:
        at, weight, stress = _points(self.results, crossing, state, index)
        slope = np.moveaxis(shape_gradients(crossing.kind, at), 1, 2)  # (p, k, 2)
        now = np.einsum("pki,nkj->npij", slope, positions[crossing.nodes])
        volume = weight * np.linalg.det(now)
        gradient = np.einsum("npij,pkj->npki", np.linalg.inv(now), slope)
        tensor = np.empty((*stress.shape[:2], 2, 2))
        tensor[..., 0, 0], tensor[..., 1, 1] = stress[..., 0], stress[..., 1]
        tensor[..., 0, 1] = tensor[..., 1, 0] = stress[..., 3]
        out = np.zeros((*crossing.nodes.shape, 3))
        out[..., :2] = np.einsum("np,npij,npkj->nki", volume, tensor, gradient)
        return out


def _points(
    results: ResultSource, crossing: _Crossing, state: Frame, index: int
) -> tuple[Floats, Floats, Floats]:
    """Natural points (p, 2), weights with the thickness (n, p), stress (n, p, 4) of cells."""
    if "S11" not in results.variables(index):
        raise InputError("the results hold no stress; section forces need S")
    depth = _thickness(results, crossing, crossing.nodes)
    corners = np.array(KINDS[crossing.kind].natural)
    for block in state.fields:
        rows = np.flatnonzero(np.isin(block.cells, crossing.cells))
        if len(rows) == len(crossing.cells):
            at = block.shape @ corners
            if len(at) in (1, 3, 4, 9):
                here = depth @ shape_functions(crossing.kind, at).T
                return at, here * _weights(crossing.kind, at), block.values["S"][rows]
    # The mean of each cell, and the slope of the averages at its nodes.
    at = _gauss(crossing.kind)
    weight = _weights(crossing.kind, at)
    shape = shape_functions(crossing.kind, at)
    group = results.sections()[crossing.cells]
    stress = np.empty((len(crossing.cells), len(at), 4))
    for column, name in enumerate(("S11", "S22", "S33", "S12")):
        mean = results.cells(name, index)[crossing.cells]
        for number in distinct(group):
            mine = group == number
            nodal = results.nodal(name, index, section=int(number) if number >= 0 else None)
            values = nodal[crossing.nodes[mine]] @ shape.T
            middle = (values * weight).sum(axis=1) / weight.sum()
            stress[mine, :, column] = values + (mean[mine] - middle)[:, None]
    return at, (depth @ shape.T) * weight, stress


def _gauss(kind: str) -> Floats:
    if kind.startswith("tri"):
        return np.array([[1, 1], [4, 1], [1, 4]]) / 6.0
    g = 1.0 / np.sqrt(3.0)
    return np.array([[-g, -g], [g, -g], [g, g], [-g, g]])


def _weights(kind: str, at: Floats) -> Floats:
    """Weights of the rules of Gauss that elements have."""
    count = len(at)
    if kind.startswith("tri"):
        return np.full(count, 0.5 / count)
    if count < 9:
        return np.full(count, 4.0 / count)
    line = np.where(np.abs(at) < 1e-6, 8.0, 5.0) / 9.0
    return np.asarray(line.prod(axis=1))


def _resultant(where: Floats, values: Floats, center: Floats) -> tuple[Floats, float]:
    arm = where - center
    moment = arm[:, 0] * values[:, 1] - arm[:, 1] * values[:, 0] + values[:, 2]
    return values[:, :2].sum(axis=0), float(moment.sum())


def _mask(mesh: Mesh, cells: str | ArrayLike | None) -> Bools:
    if cells is None:
        return np.ones(mesh.n_cells, dtype=bool)
    mask = np.zeros(mesh.n_cells, dtype=bool)
    mask[mesh.cell_indices(cells)] = True
    return mask


def _is_ring(results: ResultSource) -> bool:
    """Whether results are those of a solid of revolution."""
    planes = [section.plane for section in results.model.sections]
    if not planes:
        described = getattr(results, "description", {}).get("sections", [])
        planes = [section.get("plane", "") for section in described]
    return "axisymmetric" in planes


def _depth(results: ResultSource, crossing: _Crossing) -> Floats:
    """Thickness at both ends of the part of each cell that is cut, shape (n, 2)."""
    ends = crossing.ends
    first, last = (_thickness(results, crossing, ends[..., i]) for i in (0, 1))
    return np.asarray(first * (1.0 - crossing.share) + last * crossing.share)


def _thickness(results: ResultSource, crossing: _Crossing, nodes: Ints) -> Floats:
    """Thickness of nodes of the cells, of the shape of `nodes` (n, k); lines have none."""
    if crossing.kind == "line2":
        return np.zeros(nodes.shape)
    mesh = results.mesh
    owner = np.full(mesh.n_cells, -1)
    sections: list[tuple[Any, Any]] = [
        (s.cells, s.thickness if s.nodal_thickness is None else s.nodal_thickness)
        for s in results.model.sections
        if not s.profile[0]
    ]
    if not sections:
        described = getattr(results, "description", {}).get("sections", [])
        sections = [
            (s["where"], np.array(s.get("thickness of nodes", s["thickness"])))
            for s in described
            if not s["line"]
        ]
    alike = len({np.asarray(t).tobytes() for _, t in sections}) == 1
    for number, (where, _) in enumerate(sections):
        if not isinstance(where, str):
            owner[np.asarray(where)] = number
        elif where in mesh.cell_sets:
            owner[mesh.cell_sets[where]] = number
        elif alike or where == "all":
            owner[:] = number
    mine = owner[crossing.cells]
    if (mine < 0).any():
        raise InputError("the file does not contain the thickness of the elements at the cut")
    found = np.empty(nodes.shape)
    for number in np.unique(mine):
        own, value = mine == number, np.asarray(sections[number][1], dtype=np.float64)
        found[own] = value[nodes[own]] if value.ndim else value
    return found


@dataclass(repr=False)
class SectionDiagram(Brief):
    """Section forces of cuts across an axis; see :meth:`corota.results.Results.section_diagram`.

    Parameters
    ----------
    results : Results
    distance : ndarray, shape (n,)
        Of the cuts along the axis [length].
    N, V, M : ndarray, shape (n,)
        As in :class:`SectionForces`.
    """

    results: ResultSource = field(repr=False)
    distance: Floats
    N: Floats
    V: Floats
    M: Floats

    def plot(self, **options: Any) -> Any:
        """Draw them over the axis; see :func:`corota.plots.section_diagram`."""
        return draw_diagram(self, **options)


def diagram(
    results: ResultSource, path: ArrayLike, width: float, count: int, frame: int
) -> SectionDiagram:
    """Cut across an axis; see :meth:`corota.results.Results.section_diagram`."""
    corners = np.asarray(path, dtype=np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 2:
        raise InputError(f"an axis is two or more points (x, y), not an array {corners.shape}")
    if count < 2 or not width > 0.0:
        raise InputError(f"a diagram needs two or more cuts and a width > 0, not {count}, {width}")
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    # Cuts at the ends would have no part behind or ahead of them.
    at = along[-1] * (np.arange(count) + 0.5) / count
    x = np.stack([np.interp(at, along, corners[:, i]) for i in (0, 1)], axis=1)
    piece = np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(along) - 2)
    axis = np.diff(corners, axis=0)[piece]
    axis = axis / np.hypot(*axis.T)[:, None]
    across = 0.5 * width * np.stack([-axis[:, 1], axis[:, 0]], axis=1)
    found = [Cut(results, p - a, p + a).forces(frame) for p, a in zip(x, across, strict=True)]
    table = np.array([[f.N, f.V, f.M] for f in found])
    return SectionDiagram(results, at, *table.T)

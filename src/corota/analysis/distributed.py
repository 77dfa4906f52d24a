"""Distributed loads over the steps: pressures, tractions and body forces; follower forces.

A load is identified by what it acts on. On an edge of an element that is the edge and the kind
(pressure, traction or shear), whatever the name of the set; of a nodal force that follows its
node, the node and the direction. Of a body it is the set, the kind, and the
direction of gravity or the axis of rotation: gravity in another direction is another load. A
load that is given again in a later step replaces the one before; loads of one step add up.

Source: CalculiX 2.20, ``loadadd.f`` and ``bodyadd.f``; tests/steps compares with its results.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

import corota._core as _core
from corota.analysis.distributed_forces import (
    STATIC_MASS,
    BodyLoad,
    Distribution,
    Pressure,
    Traction,
    hydrostatic_thickness,
)
from corota.arrays import Bools, Floats, Ints, distinct
from corota.errors import InputError, Location, ModelError
from corota.mesh.kinds import EDGES
from corota.mesh.shape_functions import edge_functions
from corota.model import axisymmetry, elements
from corota.model.loads import BodyForce, EdgeLoad, NodalForce

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from corota.analysis.electrostatics import ElectrostaticPressure
    from corota.analysis.following_forces import FollowingTraction
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.penetration import PenetratingPressure

    Item = EdgeLoad | BodyForce | NodalForce

#: Tolerance for equal directions and axes (CalculiX's own tolerance).
SAME = 1e-10
#: Upper bound of the side numbers of an element.
SIDES = 8


@dataclass
class DistributedLoad:
    """A load with the history of its scale.

    Parameters
    ----------
    begin, end : float
        Scale at the ends of the step; with an amplitude `end` is its value at factor one.
    amplitude : int
        Index into the names of amplitudes; 0 for none.
    removed : bool
        Whether the step removed the load.
    force : Distribution
        Its force per unit scale, given when the load is built.
    faces : ndarray, shape (n, 2)
        Cell and side of loaded edges; node and direction of follower forces; empty for bodies.
    traction : tuple of float
        Of tractions and shear: force per area and unit scale; of follower forces, their values.
    item : EdgeLoad, BodyForce or NodalForce
        The load's definition; the first of several.
    """

    begin: float
    end: float
    amplitude: int
    item: Item
    removed: bool = False
    force: Distribution = field(init=False)
    faces: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    traction: tuple[float, ...] = (0.0, 0.0)


class DistributedLoads:
    """The active distributed loads, and how a step changes them."""

    def __init__(self, system: NumberedModel) -> None:
        self.system = system
        self.loads: list[DistributedLoad] = []
        #: Mass that body forces act on.
        self.mass = STATIC_MASS
        self._cells: dict[int, tuple[int, int]] = {}

    def set_mass(self, kind: str) -> None:
        """Apply body forces to the mass of this kind."""
        self.mass = kind
        for load in self.loads:
            load.force.set_mass(kind)

    def carry(self, scale: Callable[[DistributedLoad], float], runs_on: Bools) -> None:
        """Start the next step from the reached values, except where an amplitude continues."""
        for load in self.loads:
            load.begin, load.removed = scale(load), False
            if not runs_on[load.amplitude]:
                load.end, load.amplitude = load.begin, 0
        self.loads = [load for load in self.loads if load.begin != 0.0 or load.end != 0.0]

    def remove(self, ends: Callable[[Item], bool]) -> None:
        """Remove all loads that end: distributed ones, or follower forces."""
        for load in self.loads:
            if ends(load.item):
                load.end, load.amplitude, load.removed = 0.0, 0, True

    def set(self, items: Sequence[Item], amplitude: Callable[[str, Location | None], int]) -> None:
        """Add the loads of a step in place of those on the same edges, nodes or sets."""
        if self.system.axisymmetric:
            axisymmetry.check_loads(items)
        fresh = self._bodies([i for i in items if isinstance(i, BodyForce)], amplitude)
        fresh += self._on_edges([i for i in items if isinstance(i, EdgeLoad)], amplitude)
        # Dead forces only replace earlier loads.
        fresh += self._turning(
            [i for i in items if isinstance(i, NodalForce) and (self.loads or not _is_dead(i))],
            amplitude,
        )
        for load in fresh:
            self._replace(load)
        self.loads += [load for load in fresh if not _is_dead(load.item)]

    def drop(self, removed: Bools) -> None:
        """Forget loads on the edges of cells that are not in the structure, shape (n_cells,)."""
        kept = []
        for load in self.loads:
            on = isinstance(load.item, EdgeLoad)
            gone = removed[load.faces[:, 0]] if on else np.zeros(1, bool)
            if not gone.any():
                kept.append(load)
            elif not gone.all():
                kept.append(self._part(load, ~gone))
        self.loads = kept

    # -- replacing ----------------------------------------------------------------------

    def _replace(self, new: DistributedLoad) -> None:
        """Ramp from older loads on the same edges, nodes or sets to the new one."""
        kept: list[DistributedLoad] = []
        for old in self.loads:
            one, other = old.item, new.item
            if isinstance(one, BodyForce) or isinstance(other, BodyForce):
                if not (isinstance(one, BodyForce) and isinstance(other, BodyForce)):
                    kept.append(old)
                elif one.kind == other.kind and other.every:
                    # A body force of zero ends every earlier one of its kind in its elements.
                    kept += self._without(old, new)
                elif _same_body(one, other):
                    kept += _fading(old, new)
                else:
                    kept.append(old)
                continue
            if _goes_on(old, new):
                continue
            alike = _family(old.item) == _family(new.item)
            hit = np.isin(_codes(old.faces), _codes(new.faces)) & alike
            if not hit.any():
                kept.append(old)
            elif hit.all():
                kept += _fading(old, new)
            else:
                kept.append(self._part(old, ~hit))
                kept += _fading(self._part(old, hit), new)
        self.loads = kept

    def _part(self, load: DistributedLoad, chosen: Bools) -> DistributedLoad:
        """The same load on some of its edges or nodes."""
        faces = load.faces[chosen]
        if isinstance(load.item, NodalForce):
            values = tuple(np.asarray(load.traction)[chosen].tolist())
            return self._at_nodes(replace(load, faces=faces, traction=values))
        return self._edge_load(replace(load, faces=faces))

    def _without(self, old: DistributedLoad, zero: DistributedLoad) -> list[DistributedLoad]:
        """A body force that ends in some elements; elsewhere it acts on."""
        assert isinstance(old.force, BodyLoad)
        assert isinstance(zero.force, BodyLoad)
        found: list[DistributedLoad] = []
        both = old.force.inside & zero.force.inside
        if (both == old.force.inside).all():
            return _fading(old, zero)
        for inside, left in ((old.force.inside & ~both, False), (both, True)):
            if not inside.any():
                continue
            item = replace(old.item, cells=np.flatnonzero(inside))  # type: ignore[arg-type]
            part = replace(old, item=item)
            part.force = BodyLoad(self.system, item, self.mass)  # type: ignore[arg-type]
            found += _fading(part, zero) if left else [part]
        return found

    # -- building -----------------------------------------------------------------------

    def _bodies(
        self, items: Sequence[BodyForce], amplitude: Callable[[str, Location | None], int]
    ) -> list[DistributedLoad]:
        found = []
        for item in items:
            load = DistributedLoad(0.0, 1.0, amplitude(item.amplitude, item.where), item)
            load.force = BodyLoad(self.system, item, self.mass)
            found.append(load)
        return found

    def _on_edges(
        self, items: Sequence[EdgeLoad], amplitude: Callable[[str, Location | None], int]
    ) -> list[DistributedLoad]:
        """Loads on edges; items of the same size and amplitude share one core object."""
        found: dict[tuple[object, ...], tuple[DistributedLoad, list[Ints]]] = {}
        for item in items:
            faces = self._faces(item)
            load = DistributedLoad(0.0, 1.0, amplitude(item.amplitude, item.where), item)
            if item.kind.endswith("pressure"):
                load.end = item.value[0]
            else:
                share = 1.0 / self._area(faces) if item.total else 1.0
                load.traction = tuple(share * v for v in item.value)
            more = [np.asarray(part).tobytes() for part in (item.opposite, item.start)]
            key = (item.kind, load.end, load.amplitude, load.traction, item.value[1:], *more)
            found.setdefault(key, (load, []))[1].append(faces)
        return [
            self._edge_load(replace(load, faces=np.concatenate(faces)))
            for load, faces in found.values()
        ]

    def _turning(
        self, items: Sequence[NodalForce], amplitude: Callable[[str, Location | None], int]
    ) -> list[DistributedLoad]:
        """Follower forces; dead ones are included to replace those of earlier steps."""
        found = []
        for item in items:
            nodes = self.system.model.mesh.node_indices(item.nodes)
            load = DistributedLoad(0.0, 1.0, amplitude(item.amplitude, item.where), item)
            load.faces = np.stack([nodes, np.full(len(nodes), item.dof)], axis=1)
            load.traction = tuple(np.broadcast_to(item.value, len(nodes)).tolist())
            found.append(load if _is_dead(item) else self._at_nodes(load))
        return found

    def _at_nodes(self, load: DistributedLoad) -> DistributedLoad:
        assert isinstance(load.item, NodalForce)
        nodes, system = load.faces[:, 0], self.system
        bare = system.per_node[nodes] < 3
        if bare.any():
            label = system.model.mesh.node_labels[nodes[bare][0]]
            raise ModelError(
                f"a force that turns with its node: node {label} has no rotation; load the edges "
                "by a pressure or a traction that follows them",
                load.item.where,
            )
        from corota.analysis.following_forces import TurningForce

        load.force = TurningForce(system, nodes, load.item.dof, np.asarray(load.traction))
        return load

    def _edge_load(self, load: DistributedLoad) -> DistributedLoad:
        """Build a load on edges with the data of its faces in the core."""
        assert isinstance(load.item, EdgeLoad)
        if load.item.kind in ("following traction", "shear"):
            load.force = self._following(load)
            return load
        if load.item.kind == "electrostatic":
            load.force = self._electrostatic(load)
            return load
        if load.item.kind == "penetrating pressure":
            load.force = self._penetrating(load)
            return load
        presses = load.item.kind.endswith("pressure")
        hydrostatic = load.item.kind == "hydrostatic pressure"
        heights = load.item.value[1:] if hydrostatic else ()
        core, drilling = self._core(load.faces, heights, presses)
        if presses:
            load.force = Pressure(self.system, core)
        else:
            x, y = load.traction
            load.force = Traction(self.system, core, drilling, (x, y))
        return load

    def _following(self, load: DistributedLoad) -> FollowingTraction:
        """A follower traction; edges of drilling elements are separate."""
        nodes, thickness, alpha = self._edges(load.faces)
        x = self.system.model.mesh.points
        along = x[nodes[:, 1]] - x[nodes[:, 0]]
        angle = np.round(np.arctan2(along[:, 1], along[:, 0]), 12)
        bulges = []
        for value in distinct(angle[alpha > 0.0]).tolist():
            mask = (angle == value) & (alpha > 0.0)
            bulges.append((mask, self._core(load.faces[mask])[0]))
        from corota.analysis.following_forces import FollowingTraction

        ring = self._rings(load.faces)
        return FollowingTraction(self.system, nodes, thickness, load.traction, bulges, ring)

    def _electrostatic(self, load: DistributedLoad) -> ElectrostaticPressure:
        from corota.analysis.electrostatics import ElectrostaticPressure

        assert isinstance(load.item, EdgeLoad)
        nodes, thickness, _ = self._edges(load.faces)
        strength, *line = load.traction
        opposite = None
        if load.item.opposite is not None:
            opposite = self._edges(self._faces(replace(load.item, edges=load.item.opposite)))[0]
        ground = np.reshape(line, (2, 2)) if line else None
        return ElectrostaticPressure(
            self.system, nodes, thickness, strength, ground, opposite, load.item.where
        )

    def _penetrating(self, load: DistributedLoad) -> PenetratingPressure:
        from corota.analysis.penetration import Edges, PenetratingPressure

        item = load.item
        assert isinstance(item, EdgeLoad)
        assert item.start is not None
        chain, opposite = Edges(*self._edges(load.faces)), None
        if item.opposite is not None:
            opposite = Edges(*self._edges(self._faces(replace(item, edges=item.opposite))))
        if self.system.axisymmetric and not self._rings(load.faces):
            text = "a fluid penetrates between rings, not beside a section in the plane"
            raise ModelError(text, item.where)
        start = self.system.model.mesh.node_indices(item.start)
        critical = item.value[1] if len(item.value) > 1 else None
        force = PenetratingPressure(self.system, chain, opposite, start, critical, item.where)
        self._check_contact(force, item)
        return force

    def _check_contact(self, fluid: PenetratingPressure, item: EdgeLoad) -> None:
        """Refuse a fluid whose edges are no slave surface: their contact pressure is not known."""
        slaves, masters = (self.system.nodes_of_terms(role) for role in ("slave", "master"))
        if (fluid.on_chain & masters & ~slaves).any():
            raise ModelError(
                "the edges of a fluid that penetrates are a master surface of contact: give those "
                "of the slave, and these as opposite=",
                item.where,
            )
        if not (fluid.on_chain & slaves).any():
            raise ModelError(
                "the edges of a fluid that penetrates are no slave surface of contact: a pressure "
                "acts on free edges",
                item.where,
            )

    def _faces(self, item: EdgeLoad) -> Ints:
        """Cell and side of every loaded edge, shape (n, 2)."""
        mesh = self.system.model.mesh
        if isinstance(item.edges, str):
            try:
                faces = mesh.edge_pairs(item.edges)
            except InputError as error:
                raise ModelError(error.message, item.where) from None
        else:
            faces = mesh.edge_pairs(item.edges)
        if not self._cells:
            self._cells = {
                int(c): (b, r)
                for b, block in enumerate(self.system.blocks)
                for r, c in enumerate(block.cells)
            }
        for cell in faces[:, 0].tolist():
            if cell not in self._cells:
                label = mesh.cell_labels[cell]
                raise ModelError(f"element {label} of a loaded edge has no section", item.where)
        return faces

    def _ends(self, cell: int, side: int) -> tuple[list[int], int]:
        """Nodes of an edge, and the block of its element."""
        b, row = self._cells[cell]
        block = self.system.blocks[b]
        local = EDGES[elements.find(block.section.element).cell][side]
        return [int(block.nodes[row, a]) for a in local], b

    def _rings(self, faces: Ints) -> bool:
        """Whether loaded edges are those of rings; sections in the plane have other edges."""
        found = {
            self.system.blocks[self._cells[cell][0]].section.axisymmetric
            for cell in faces[:, 0].tolist()
        }
        if len(found) > 1:
            raise ModelError(
                "a load acts on edges of axisymmetric sections and of sections in the plane: give "
                "each its own edge set"
            )
        return found == {True}

    def _edges(self, faces: Ints) -> tuple[Ints, Floats, Floats]:
        """Nodes (the third is the first on straight edges), their thickness, bulge of edges."""
        nodes, thickness, alpha = [], [], []
        points = self.system.model.mesh.points
        for cell, side in faces.tolist():
            ends, b = self._ends(cell, side)
            section = self.system.blocks[b].section
            nodes.append([ends[0], ends[1], ends[2] if len(ends) == 3 else ends[0]])
            thickness.append(section.thickness_at(np.array(nodes[-1]), points))
            alpha.append(self.system.blocks[b].shares(self._cells[cell][1], side))
        table = np.asarray(nodes, np.int64).reshape(-1, 3)
        return table, np.array(thickness).reshape(-1, 3), np.asarray(alpha, np.float64)

    def _core(
        self, faces: Ints, heights: tuple[float, ...] = (), presses: bool = False
    ) -> tuple[_core.EdgeLoads, bool]:
        """The core's edges, and whether some of them bulge with rotations.

        A hydrostatic pressure is one of unit size on edges whose thickness varies with the depth.
        """
        nodes, thickness, alpha = self._edges(faces)
        points = self.system.model.mesh.points
        ring = self._rings(faces)
        if ring and presses:  # pressures act on the current way around, which the core knows
            thickness = np.ones_like(thickness)
        if heights:
            thickness = hydrostatic_thickness(points, nodes, thickness, *heights)
        edges = _core.EdgeLoads(points, nodes.astype(np.uint32), thickness, alpha, ring)
        return edges, bool((alpha > 0.0).any())

    def _area(self, faces: Ints) -> float:
        """Area of edges times thickness; curved ones by Gauss's rule of three points."""
        area = 0.0
        for cell, side in faces.tolist():
            ends, b = self._ends(cell, side)
            points = self.system.model.mesh.points
            x = points[ends]
            thickness = self.system.blocks[b].section.thickness_at(np.array(ends), points)
            if len(ends) == 2:
                area += float(np.hypot(*(x[1] - x[0]))) * float(thickness.mean())
                continue
            r = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
            shape, slope = edge_functions(r)
            d = slope @ x
            weight = np.array([5.0, 8.0, 5.0]) / 9.0 * (shape @ thickness)
            area += float(np.hypot(d[:, 0], d[:, 1]) @ weight)
        return area


def _goes_on(old: DistributedLoad, new: DistributedLoad) -> bool:
    """Whether a fluid gets another pressure; where it is and what it was are then those of `new`.

    Raises
    ------
    ModelError
        If the edges are others.
    """
    pair = [load.item for load in (old, new) if isinstance(load.item, EdgeLoad)]
    if len(pair) < 2 or {item.kind for item in pair} != {"penetrating pressure"}:
        return False
    from corota.analysis.penetration import PenetratingPressure

    both = np.isin(_codes(old.faces), _codes(new.faces))
    if not both.any():
        return False
    if len(old.faces) != len(new.faces) or not both.all():
        raise ModelError(
            "a fluid that penetrates gets another pressure on the same edges as before",
            new.item.where,
        )
    assert isinstance(old.force, PenetratingPressure)
    assert isinstance(new.force, PenetratingPressure)
    new.begin = old.begin
    new.force.take_over(old.force)
    return True


def _codes(faces: Ints) -> Ints:
    """One number for each pair of cell and side."""
    return faces[:, 0] * SIDES + faces[:, 1]


def _fading(old: DistributedLoad, new: DistributedLoad) -> list[DistributedLoad]:
    """Remainder of a load that `new` replaces: none if the new one has an amplitude."""
    if new.amplitude or old.begin == 0.0:
        return []
    left = replace(old, end=0.0, amplitude=0, removed=False)
    left.force = old.force
    return [left]


def _family(item: Item) -> str:
    """Loads on the same edge or node replace each other within a family."""
    return item.kind.removeprefix("following ") if isinstance(item, EdgeLoad) else "force"


def _is_dead(item: Item) -> bool:
    """Whether a nodal force keeps its direction: it is applied elsewhere."""
    return isinstance(item, NodalForce) and not item.follower


def _same_body(old: BodyForce, new: BodyForce) -> bool:
    """Whether two body forces are one load, of which the later value counts."""
    if old.kind != new.kind or _name(old) != _name(new):
        return False
    if old.kind == "centrifugal":
        return float(np.hypot(*np.subtract(old.value[1:3], new.value[1:3]))) <= SAME
    if old.kind in ("volume", "line") and not (old.direction and new.direction):
        return True  # both components of a load in Python; cards have one each
    one, other = old.axis, new.axis
    # Gravity of size zero ends gravity in every direction.
    return one is None or other is None or float(np.dot(one, other)) > 1.0 - SAME


def _name(item: BodyForce) -> object:
    masses = None if item.masses is None else item.masses.tobytes()
    if isinstance(item.cells, str):
        return item.cells if item.cells != "all" else "", masses
    return np.asarray(item.cells).tobytes(), masses

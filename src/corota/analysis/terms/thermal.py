"""Thermal strain and initial stress: strains that the elements have without any displacement.

With the free strain ``e = alpha dT - S s0`` (thermal strain, initial stress ``s0`` and elastic
compliance ``S``) the law is ``strain - e = S stress``. In plane strain the strain through the
thickness is eliminated, which leaves

    e_in - S_in,zz e_zz / S_zz,zz     and the stress    -e_zz / S_zz,zz

in the plane and through the thickness; for an isotropic material ``(1 + nu) alpha dT`` and
``-E alpha dT`` (Timoshenko and Goodier, *Theory of Elasticity*, ch. 13).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.errors import InputError, Location, ModelError
from corota.mesh.parts import nodes_of
from corota.model import elements
from corota.model.material_table import MaterialTable
from corota.model.materials import Expansion, Material

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeGuard

    import corota._core as _core
    from corota.arrays import Floats, Ints
    from corota.model.blocks import BlockOfCells
    from corota.model.model import Model


#: Local strain that belongs to the stretch ``1 + e`` of free thermal expansion.
MEASURES: dict[str, Callable[[Floats], Floats]] = {
    "linear": lambda e: e,
    "green_lagrange": lambda e: e + 0.5 * e * e,
    "logarithmic": np.log1p,
}
#: Rows of a compliance in the plane, and through the thickness.
IN, ZZ = [0, 1, 3], 2


@dataclass
class _Block:
    index: int
    nodes: Ints
    shape: Floats  # (p, k)
    expansion: Expansion
    turn: Floats  # (4, 4), strain along the material axes to rows xx, yy, zz, xy
    constant: Floats | None  # compliance, (4, 4), rows xx, yy, zz, xy; none for tables
    table: MaterialTable | None
    line: bool
    strain: bool  # plane strain
    spherical: bool
    local_strain: str
    stress: Floats | None = None  # initial, (n, p, 4)
    start: Floats = field(init=False)  # temperatures at the points, (n, p), and now
    now: Floats = field(init=False)
    at_start: Floats | None = None  # compliance, where there is an initial stress
    free: Floats = field(init=False)  # free strains
    rows: Floats = field(init=False)  # passed to the core, (n, p, 4)
    # Strains of the last frame, forces on them, temperatures, energies beside the points.
    last: tuple[Floats, Floats, Floats, Floats | None] | None = None

    @property
    def responds(self) -> bool:
        return bool(self.expansion) or self.table is not None

    def compliance(self, temperature: Floats) -> Floats:
        """At temperatures (n, p): shape (4, 4), or (n, p, 4, 4) where it depends on them."""
        if self.constant is not None:
            return self.constant
        assert self.table is not None
        turned: Floats = self.turn @ self.table.compliances(temperature) @ self.turn.T
        return turned


class FreeStrains:
    """The free strains of a model and their temperatures.

    Parameters
    ----------
    blocks : sequence of BlockOfCells
        Of the elements in the core.
    communicator : Communicator
        Processes that have the other elements.

    Attributes
    ----------
    start : ndarray, shape (n_nodes,)
        Initial temperature.
    now : ndarray, shape (n_nodes,)
        Temperature in the core.
    offset : ndarray or None
        Added to every temperature while a procedure evaluates neighboring states.
    responds : bool
        Whether any material expands or has constants that follow the temperature.
    """

    #: One process has all elements.
    communicator: Communicator = ALONE

    def __init__(
        self,
        core: _core.Problem,
        model: Model,
        blocks: Sequence[BlockOfCells],
        communicator: Communicator = ALONE,
    ) -> None:
        self.core, self.model = core, model
        if communicator is not ALONE:
            self.communicator = communicator
        self.start = start_temperatures(model)
        self.offset: Floats | None = None
        #: Whether displacements are finite.
        self.finite = False
        #: Work of changing thermal strain so far [force*length].
        self.work = 0.0
        stresses = self._stresses(blocks)
        self._blocks: list[_Block] = []
        for index, block in enumerate(blocks):
            material, stress = block.section.material, stresses[index]
            expansion = Expansion.of(material.expansion)
            if expansion or stress is not None or _follows(material):
                own = _block(core, index, block, expansion, stress)
                own.start = self.start[own.nodes] @ own.shape.T
                if own.stress is not None:
                    own.at_start = own.compliance(own.start)
                self._blocks.append(own)
        self.responds = communicator.any(any(block.responds for block in self._blocks))
        self.now = self.start.copy()
        for own in self._blocks:
            self._set(own, self.start)

    def _stresses(self, blocks: Sequence[BlockOfCells]) -> list[Floats | None]:
        """Initial stress by block, shapes (n, p, 4)."""
        found: list[Floats | None] = [None] * len(blocks)
        mesh = self.model.mesh
        for item in self.model.initial_stresses:
            cells = item.cells
            if isinstance(cells, str):
                if cells and cells not in mesh.cell_sets:
                    raise ModelError(f"no element set named {cells!r}", item.where)
                cells = mesh.cell_sets[cells] if cells else np.arange(mesh.n_cells)
            order = np.full(mesh.n_cells, -1, np.int64)
            order[cells] = np.arange(len(cells))
            for index, block in enumerate(blocks):
                rows = np.flatnonzero(order[block.cells] >= 0)
                facts = elements.find(block.section.element)
                if not len(rows) or facts.spring:
                    continue
                shape = (len(block.cells), facts.n_points)
                stress = found[index]
                if stress is None:
                    stress = found[index] = np.zeros((*shape, 4))
                at = order[block.cells[rows]]
                for component, value in enumerate(item.value):
                    given = np.asarray(value, dtype=np.float64)
                    try:
                        own = given if given.ndim == 0 else given[at]
                        stress[rows, :, component] = np.broadcast_to(own, (len(rows), shape[1]))
                    except (ValueError, IndexError):
                        raise ModelError(
                            f"an initial stress of shape {given.shape} does not fit {len(cells)} "
                            f"cells with {shape[1]} points each ({facts.name}); give a number, "
                            "(n, 1) or (n, points)",
                            item.where,
                        ) from None
                if facts.line:
                    stress[..., 1:] = 0.0
                elif block.section.plane == "stress" and stress[..., 2].any():
                    label = mesh.cell_labels[block.cells[np.argmax(stress[..., 2].any(axis=1))]]
                    raise ModelError(
                        f"element {label} is in plane stress and cannot have an initial stress "
                        "through the thickness (zz)",
                        item.where,
                    )
                elif (
                    block.section.plane != "stress"
                    and block.section.material.law == "viscoelastic"
                    and stress.any()
                ):
                    raise ModelError(
                        "viscoelastic materials have no initial stress in plane strain or around "
                        "an axis: its part through the thickness would not relax; use plane "
                        "stress, or load the body in a step",
                        item.where,
                    )
        return found

    def require_response(self, where: Location | None) -> None:
        """Refuse temperatures without effect.

        Raises
        ------
        ModelError
        """
        if not self.responds:
            raise ModelError(
                "temperatures without effect: no material has a coefficient of thermal expansion "
                "or constants that follow the temperature; give it one (expansion=, *EXPANSION) "
                "or several sets of constants (MaterialTable)",
                where,
            )

    def follows(self, temperature: Floats) -> bool:
        """Whether the core has these temperatures already."""
        return not self.responds or np.array_equal(self._wanted(temperature), self.now)

    def apply(self, temperature: Floats) -> None:
        """Set the strains of the core from nodal temperatures, shape (n_nodes,)."""
        if self.follows(temperature):
            return
        self.now = self._wanted(temperature)
        for block in self._blocks:
            if block.responds:
                self._set(block, self.now)

    def give(self, index: int, rows: Ints, core: _core.Problem) -> None:
        """Give the strains and temperatures of some elements of a block to another core."""
        for block in self._blocks:
            if block.index == index:
                if block.table is not None:
                    core.set_temperatures(0, block.now[rows].ravel())
                core.set_initial(0, block.rows[rows].ravel())

    def set_kinematics(self, nlgeom: bool) -> None:
        """Let displacements be finite or infinitesimal from now on."""
        if nlgeom != self.finite:
            self.finite = nlgeom
            for block in self._blocks:
                if block.expansion and block.local_strain != "linear":
                    self._set(block, self.now)

    def largest(self, heating: Floats) -> float:
        """Largest thermal strain of a change of temperature about those of the core."""
        found = [
            np.abs(
                block.expansion.strain((self.now + heating)[block.nodes], self.now[block.nodes])
            ).max(initial=0.0)
            for block in self._blocks
            if block.expansion
        ]
        return self.communicator.greatest(float(max(found, default=0.0)))

    def _wanted(self, temperature: Floats) -> Floats:
        return temperature + self.offset if self.offset is not None else temperature.copy()

    def _set(self, block: _Block, temperature: Floats) -> None:
        block.now = temperature[block.nodes] @ block.shape.T
        if block.table is not None:
            try:
                self.core.set_temperatures(block.index, block.now.ravel())
            except ValueError as error:
                raise ModelError(str(error), block.table.where) from None
        thermal = block.expansion.strain(block.now, block.start)
        if self.finite:
            thermal = MEASURES[block.local_strain](thermal)
        block.free = thermal @ block.turn[:, :3].T
        if block.stress is not None and block.at_start is not None:
            # The strain of the initial stress is kept.
            block.free -= np.einsum("...ij,...j->...i", block.at_start, block.stress)
        block.rows = _rows(block, block.free, block.compliance(block.now))
        self.core.set_initial(block.index, block.rows.ravel())

    def record(
        self, index: int, heat: Floats, volume: Floats, stabilized: Floats | None = None
    ) -> None:
        """Add the work that temperatures have done since the last call, by the trapezoidal rule.

        Parameters
        ----------
        index : int
            Block.
        heat : ndarray, shape (n, p, 5)
            Stress of the elements that is conjugate to the strains, in their rows, and the stress
            of the law through the thickness [stress].
        volume : ndarray, shape (n, p)
        stabilized : ndarray, shape (n, k, 2), optional
            Energies beside the points, each with the stiffness to which it is proportional, where
            it follows the temperature.
        """
        force, stress_zz = heat[..., :4], heat[..., 4]
        block = next(b for b in self._blocks if b.index == index)
        if block.table is not None:
            self._record_table(block, block.table, force, stress_zz, volume, stabilized)
            return
        if block.last is not None:
            rows, before, _, _ = block.last
            moved = block.rows - rows
            self.work -= 0.5 * float(np.einsum("epr,epr,ep->", force + before, moved, volume))
        block.last = (block.rows, force, block.now, None)

    def _record_table(
        self,
        block: _Block,
        table: MaterialTable,
        force: Floats,
        stress_zz: Floats,
        volume: Floats,
        stabilized: Floats | None,
    ) -> None:
        """The same for a law that follows the temperature.

        At a fixed elastic strain the energy changes by what the complementary energy loses at a
        fixed stress.
        """
        stress = np.zeros(force.shape)
        stress[..., IN], stress[..., ZZ] = force[..., :3], stress_zz
        if block.line:
            stress[..., 1:] = 0.0
        if block.last is not None:
            free, before, at, beside = block.last
            moved = np.einsum("epr,epr->ep", stress + before, block.free - free)
            for s in (before, stress):
                # The transposed map of strains turns a stress to the material axes.
                own = s @ block.turn
                gained = table.complementary_energy(block.now, own)
                moved += gained - table.complementary_energy(at, own)
            self.work -= 0.5 * float(np.einsum("ep,ep->", moved, volume))
            if stabilized is not None and beside is not None:
                # At a fixed deformation these energies change as their stiffness does.
                strain = stabilized[..., 0] / stabilized[..., 1] + beside[..., 0] / beside[..., 1]
                self.work += 0.5 * float((strain * (stabilized[..., 1] - beside[..., 1])).sum())
        block.last = (block.free, stress, block.now, stabilized)


def start_temperatures(model: Model) -> Floats:
    """Initial temperatures of the nodes, shape (n_nodes,).

    Raises
    ------
    ModelError
        If there are more or fewer values than nodes.
    """
    start = np.zeros(model.mesh.n_nodes)
    for item in model.initial_temperatures:
        nodes = nodes_of(model.mesh, item.nodes)
        try:
            start[nodes] = item.value
        except ValueError:
            raise ModelError(
                f"{np.size(item.value)} initial temperatures for {len(start[nodes])} nodes",
                item.where,
            ) from None
    return start


def _rows(block: _Block, free: Floats, s: Floats) -> Floats:
    """Values for the core from free strains in rows xx, yy, zz, xy, shape (n, p, 4).

    `s` is the compliance, shape (4, 4) or (n, p, 4, 4).
    """
    rows = np.zeros(free.shape)
    if block.line:
        rows[..., 0] = free[..., 0]
        return rows
    rows[..., :3], rows[..., 3] = free[..., IN], free[..., ZZ]
    if not block.strain:
        return rows
    across = s[..., ZZ, ZZ]
    rows[..., 3] = -free[..., ZZ] / across
    rows[..., :3] += s[..., IN, ZZ] * rows[..., 3:]
    if block.spherical:
        # The same stress as a pressure on all sides, which does not change the deviator.
        share = -s[..., ZZ, IN] / across[..., None]
        inside = s[..., np.array(IN)[:, None], IN]
        pairs = s[..., IN, ZZ][..., :, None] * s[..., ZZ, IN][..., None, :]
        reduced = inside - pairs / across[..., None, None]
        rows[..., 3] /= 1.0 - share[..., 0] - share[..., 1]
        rows[..., :3] += rows[..., 3:] * (reduced[..., 0] + reduced[..., 1])
    return rows


def _block(
    core: _core.Problem,
    index: int,
    block: BlockOfCells,
    expansion: Expansion,
    stress: Floats | None,
) -> _Block:
    section = block.section
    facts = elements.find(section.element)
    c, s = np.cos(section.orientation), np.sin(section.orientation)
    # Strain along the material axes in global ones (engineering shear).
    turn = np.array(
        [
            [c * c, s * s, 0.0, -c * s],
            [s * s, c * c, 0.0, c * s],
            [0.0, 0.0, 1.0, 0.0],
            [2.0 * c * s, -2.0 * c * s, 0.0, c * c - s * s],
        ]
    )
    material, constant, table = section.material, None, None
    if material.local_strain and (block.section.plane != "stress" or stress is not None):
        raise InputError(
            f"{type(material).__name__} has no initial stress, and no thermal strain in plane "
            "strain and axisymmetry: use Elastic there, or plane stress",
            section.where,
        )
    if _follows(material):
        table = material
    else:
        constant = turn @ material.compliance() @ turn.T
    return _Block(
        index,
        block.nodes,
        core.shape(index).reshape(-1, facts.n_nodes),
        expansion,
        turn,
        constant,
        table,
        facts.line,
        section.plane == "strain",
        section.material.flows and section.plane == "strain",
        "linear" if facts.line else str(section.local_strain),
        stress,
    )


def _follows(material: Material) -> TypeGuard[MaterialTable]:
    """Whether constants of the material depend on the temperature."""
    return isinstance(material, MaterialTable) and material.varies

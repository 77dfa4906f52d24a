"""Loads and supports over the steps of an analysis.

Without an amplitude a static load or support moves linearly from what the last step reached
to its new value; with one it is the value times the amplitude. What a step does not mention
stays (``OP=MOD``) or goes back to zero over the step (``OP=NEW``). A support that is
released leaves its reaction as a force that fades out over the step.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota import _core
from corota.errors import ModelError, UnsupportedError
from corota.mesh import EDGES
from corota.model import elements
from corota.model.loads import BodyForce, EdgeLoad, NodalForce, Temperature

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.errors import Location
    from corota.model.loads import Fixed, Load
    from corota.model.steps import Step

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


#: Procedures whose state stays as it is.
LINEAR = ("modal dynamic", "steady state")
#: Times whose external forces are kept: those an increment goes from and to.
KNOWN = 2


class Course:
    """How numbers go through a step: from `begin` to `end`, or `end` times an amplitude."""

    def __init__(self, n: int) -> None:
        self.begin = np.zeros(n)
        self.end = np.zeros(n)
        self.amplitude = np.zeros(n, np.int64)  # index into the names, 0 is the ramp

    def at(self, ramp: float, factors: Floats) -> Floats:
        """Values where the ramp has `ramp` and the amplitudes have `factors`."""
        out: Floats = self.begin + ramp * (self.end - self.begin)
        if len(factors) > 1:
            named = self.amplitude > 0
            out[named] = self.end[named] * factors[self.amplitude[named]]
        return out


@dataclass
class Spread:
    """A distributed load with its course: one scale for a fixed vector, or a pressure."""

    key: tuple[object, ...]
    vector: Floats | None  # force per unit scale by dof; None for a following pressure
    edges: object | None  # core object of a pressure
    begin: float
    end: float
    amplitude: int
    item: EdgeLoad | BodyForce


class Conditions:
    """The loads and supports that act now.

    Parameters
    ----------
    system : System

    Attributes
    ----------
    held : ndarray of bool, shape (n_dofs,)
        Dofs with a prescribed value.
    fixed : ndarray of int
        Their numbers.
    """

    def __init__(self, system: System) -> None:
        n = system.n_dofs
        self.system = system
        self.held = np.zeros(n, bool)
        self.fixed: Ints = np.zeros(0, np.int64)
        #: External forces that do not follow the displacement, by the times asked for last.
        self._known: dict[float, Floats] = {}
        self._following = False
        self.support = Course(n)
        self.force = Course(n)
        #: Nodal forces with an amplitude: their values at factor one, by amplitude.
        self.timed: dict[int, Floats] = {}
        self.fading = np.zeros(n)
        self.spread: list[Spread] = []
        #: Temperatures of nodes, absolute.
        self.temperature = Course(len(system.free.start))
        self.temperature.begin[:] = self.temperature.end[:] = system.free.start
        self.names = ["", *system.model.amplitudes]
        self.period = 1.0
        self.end_time = 1.0  # step time at which the step ended: a path may end anywhere
        self.time = 0.0
        self.ramp = True
        self._cells: dict[int, tuple[int, int]] = {}

    # -- steps -------------------------------------------------------------------------

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        """Start a step at total time `time` from displacement `u`.

        Parameters
        ----------
        reaction : ndarray, shape (n_dofs,), or None
            Reactions at the end of the step before, for supports that are released.
        """
        first = reaction is None
        self.fading = np.zeros(self.system.n_dofs)
        if not first:
            end = self.end_time
            reached = self._nodal(end)
            self.force.begin, self.force.end = reached, reached.copy()
            self.timed = {}
            for load in self.spread:
                load.begin = load.end = self._scale(load, end)
                load.amplitude = 0
            heat = self.temperature
            heat.begin = self._values(heat, end)
            heat.end, heat.amplitude = heat.begin.copy(), np.zeros_like(heat.amplitude)
        held_before = self.held.copy()
        self.support.begin, self.support.end = u.copy(), u.copy()
        self.support.amplitude[:] = 0
        if step.new_loads:
            self.force.end[:] = 0.0
            for load in self.spread:
                load.end = 0.0
            self.temperature.end = self.system.free.start.copy()
        if step.new_supports:
            self.held[:] = False
        model = self.system.model
        loads = [*(model.loads if first or step.new_loads else []), *step.loads]
        supports = [*(model.supports if first or step.new_supports else []), *step.supports]
        self._set_supports(supports)
        self._set_loads(loads)
        if reaction is not None:
            released = held_before & ~self.held
            self.fading[released] = reaction[released]
        self.period, self.time, self.end_time = step.period, time, step.period
        self.ramp = getattr(step, "ramp", True)
        self._known = {}
        if step.procedure in LINEAR and self.heating.any():
            raise UnsupportedError(
                f"temperatures do not change in a {step.procedure} step; heat in a static or "
                "dynamic step before",
                step.where,
            )

    def add(self, loads: list[Load], supports: Iterable[Fixed]) -> None:
        """Add loads and supports that grow from zero, apart from any step."""
        self._set_supports(supports)
        self._set_loads(loads)
        self._known = {}

    def prescribed(self, step_time: float, u: Floats) -> Floats:
        """Values at held dofs, and `u` elsewhere; shape (n_dofs,)."""
        out: Floats = np.where(self.held, self._values(self.support, step_time), u)
        return out

    def external(
        self, step_time: float, u: Floats
    ) -> tuple[Floats, tuple[Ints, Ints, Floats] | None]:
        """External force at a time and displacement, and its derivative as triplets.

        The force is for reading only.
        """
        force = self._known.get(step_time)
        if force is None:
            force = self._dead(step_time)
        if not self._following:
            return force, None
        force = force.copy()
        triplets: list[tuple[Ints, Ints, Floats]] = []
        for load in self.spread:
            if load.vector is None and (scale := self._scale(load, step_time)) != 0.0:
                turning = self.system.turning
                moved = self.system.by_node(u)[:, :2] if turning else 0.0
                x = np.ascontiguousarray(self.system.model.mesh.points + moved)
                f, rows, columns, values = load.edges.pressure(x, scale)  # type: ignore[attr-defined]
                force += self.system.from_nodes(f)
                if turning:
                    start = self.system.start
                    i = start[rows // 3] + rows % 3
                    j = start[columns // 3] + columns % 3
                    triplets.append((i, j, values))
        if not triplets:
            return force, None
        rows, columns, values = (np.concatenate(part) for part in zip(*triplets, strict=True))
        return force, (rows, columns, values)

    def temperatures(self, step_time: float) -> Floats:
        """Temperatures of the nodes, shape (n_nodes,)."""
        return self._values(self.temperature, step_time)

    @property
    def heating(self) -> Floats:
        """Change of temperature per unit of load factor, shape (n_nodes,)."""
        return self.temperature.end - self.temperature.begin

    def _dead(self, step_time: float) -> Floats:
        """External forces at a time that do not follow the displacement."""
        force = self._nodal(step_time)
        force += (1.0 - self._ramp(step_time)) * self.fading
        for load in self.spread:
            if load.vector is not None:
                force += self._scale(load, step_time) * load.vector
        force.flags.writeable = False
        if len(self._known) >= KNOWN:
            self._known.clear()
        self._known[step_time] = force
        self._following = any(load.vector is None for load in self.spread)
        return force

    def rate(self, u: Floats) -> tuple[Floats, Floats]:
        """Change of external forces and of held dofs per unit of load factor, at `u`.

        Loads and supports are linear in the load factor (the share of the period), so the
        difference over one unit is exact once :meth:`check_proportional` has passed. Thermal
        strain acts as the internal force that it takes away.
        """
        force = self.external(self.period, u)[0] - self.external(0.0, u)[0]
        heating = self.heating
        if heating.any():
            force = force - self.system.thermal_rate(u, heating)
        move = np.where(self.held, self.support.end - self.support.begin, 0.0)
        return force, move

    def check_proportional(self) -> None:
        """Refuse loads that do not grow with the load factor.

        Raises
        ------
        ModelError
            If there is an amplitude, an abrupt load or a released support.
        """
        named = {int(i) for i in np.unique(self.support.amplitude[self.held])}
        named |= set(self.timed) | {load.amplitude for load in self.spread}
        named |= {int(i) for i in np.unique(self.temperature.amplitude)}
        for index in named - {0}:
            raise ModelError(
                f"amplitude {self.names[index]!r} in a step that follows a path: its loads "
                "grow with the load factor; leave the amplitude out, or put that load into a "
                "step before"
            )
        if not self.ramp:
            raise ModelError(
                "a step that follows a path needs loads that grow (ramp=True, AMPLITUDE=RAMP)"
            )
        laws = {block.section.material.law for block in self.system.blocks}
        if self.heating.any() and laws - {"elastic", "orthotropic"}:
            raise ModelError(
                "temperatures that change in a step that follows a path need elastic material; "
                "heat in a static step before"
            )
        if np.any(self.fading):
            dof = int(np.flatnonzero(self.fading)[0])
            raise ModelError(
                f"{self.system.describe(dof)} is released in a step that follows a path; "
                "release it in a static step before"
            )

    def body_forces(self) -> list[tuple[BodyForce, float]]:
        """Body forces that act at the end of the step, each with its scale."""
        return [
            (load.item, scale)
            for load in self.spread
            if isinstance(load.item, BodyForce) and (scale := self._scale(load, self.period)) != 0.0
        ]

    # -- courses -----------------------------------------------------------------------

    def _ramp(self, step_time: float) -> float:
        return step_time / self.period if self.ramp else 1.0

    def _factors(self, step_time: float) -> Floats:
        factors = np.ones(len(self.names))
        amplitudes = self.system.model.amplitudes
        for i, name in enumerate(self.names[1:], start=1):
            table = amplitudes[name]
            factors[i] = table(step_time + (self.time if table.total_time else 0.0))
        return factors

    def _values(self, course: Course, step_time: float) -> Floats:
        return course.at(self._ramp(step_time), self._factors(step_time))

    def _nodal(self, step_time: float) -> Floats:
        factors = self._factors(step_time)
        force = self.force.at(self._ramp(step_time), factors)
        for amplitude, values in self.timed.items():
            force += factors[amplitude] * values
        return force

    def _scale(self, load: Spread, step_time: float) -> float:
        if load.amplitude:
            return load.end * float(self._factors(step_time)[load.amplitude])
        return load.begin + self._ramp(step_time) * (load.end - load.begin)

    def _amplitude(self, name: str, where: Location | None) -> int:
        if name not in self.names:
            known = ", ".join(self.names[1:]) or "none"
            raise ModelError(f"no amplitude named {name!r}; there are: {known}", where)
        return self.names.index(name)

    # -- reading the model's items -----------------------------------------------------

    def _set_supports(self, supports: Iterable[Fixed]) -> None:
        for item in supports:
            nodes = self._nodes(item.nodes)
            dofs = self.system.dofs(nodes, item.dof)
            # A rotation may be named for nodes without one, as dofs 1-6 of decks do.
            if item.dof == 2 and item.value != 0.0 and (dofs < 0).any():
                label = self.system.model.mesh.node_labels[nodes[dofs < 0][0]]
                raise ModelError(
                    f"node {label} has no drilling rotation to prescribe; use OPT or Q4D there",
                    item.where,
                )
            dofs = dofs[dofs >= 0]
            if self.system.ties is not None:
                self.system.ties.refuse_held(dofs, item.where)
            self.held[dofs] = True
            self.support.end[dofs] = item.value
            self.support.amplitude[dofs] = self._amplitude(item.amplitude, item.where)
        self.fixed = np.flatnonzero(self.held)

    def _set_loads(self, loads: list[Load]) -> None:
        forces = [item for item in loads if isinstance(item, NodalForce)]
        self._replace_forces(forces)
        for item in forces:
            self._add_force(item)
        for heated in loads:
            if isinstance(heated, Temperature):
                self._heat(heated)
        spread = [item for item in loads if isinstance(item, EdgeLoad | BodyForce)]
        named = {self._key(item) for item in spread}
        ramped = {self._key(item) for item in spread if not item.amplitude}
        for old in self.spread:
            if old.key in named:
                # The old load fades while the new one grows: a ramp between the two.
                old.end, old.amplitude = 0.0, 0
                old.begin = old.begin if old.key in ramped else 0.0
        self.spread = [s for s in self.spread if s.begin != 0.0 or s.end != 0.0]
        fresh: list[Spread] = []
        for load in spread:
            self._add_spread(load, fresh)
        self.spread += fresh

    def _heat(self, item: Temperature) -> None:
        self.system.free.require_expansion(item.where)
        course, amplitude = self.temperature, self._amplitude(item.amplitude, item.where)
        every = isinstance(item.nodes, str) and not item.nodes
        nodes = np.arange(len(course.end)) if every else self._nodes(item.nodes)
        try:
            course.end[nodes] = item.value
        except ValueError:
            raise ModelError(
                f"{np.size(item.value)} temperatures for {len(nodes)} nodes", item.where
            ) from None
        course.amplitude[nodes] = amplitude

    def _force_dofs(self, item: NodalForce) -> Ints:
        nodes = self._nodes(item.nodes)
        dofs = self.system.dofs(nodes, item.dof)
        if (dofs < 0).any():
            label = self.system.model.mesh.node_labels[nodes[dofs < 0][0]]
            what = (
                "has no drilling rotation for a moment; use OPT or Q4D there"
                if item.dof == 2
                else "belongs to no element and cannot carry a force"
            )
            raise ModelError(f"node {label} {what}", item.where)
        if self.system.ties is not None:
            self.system.ties.refuse_loaded(dofs, item.where)
        return dofs

    def _replace_forces(self, forces: list[NodalForce]) -> None:
        """Take away what the step names again: at once if only amplitudes follow it."""
        named = np.zeros(self.system.n_dofs, bool)
        ramped = np.zeros(self.system.n_dofs, bool)
        for item in forces:
            dofs = self._force_dofs(item)
            named[dofs] = True
            ramped[dofs] |= not item.amplitude
        self.force.end[named] = 0.0
        self.force.begin[named & ~ramped] = 0.0

    def _add_force(self, item: NodalForce) -> None:
        # Several entries of one step add up, each with its own amplitude.
        amplitude = self._amplitude(item.amplitude, item.where)
        target = self.force.end
        if amplitude:
            target = self.timed.setdefault(amplitude, np.zeros(self.system.n_dofs))
        np.add.at(target, self._force_dofs(item), item.value)

    def _key(self, item: EdgeLoad | BodyForce) -> tuple[object, ...]:
        where = item.edges if isinstance(item, EdgeLoad) else item.cells
        name = where if isinstance(where, str) else np.asarray(where).tobytes()
        return (type(item).__name__, item.kind, name)

    def _add_spread(self, item: EdgeLoad | BodyForce, fresh: list[Spread]) -> None:
        key, amplitude = self._key(item), self._amplitude(item.amplitude, item.where)
        vector: Floats | None = None
        edges: object | None = None
        end, edge = 1.0, isinstance(item, EdgeLoad)
        if isinstance(item, BodyForce):
            vector = self._body(item)
        else:
            core, area = self._edges(item)
            if item.kind == "pressure":
                edges, end = core, item.value[0]
            else:
                share = 1.0 / area if item.total else 1.0
                x = self.system.model.mesh.points
                t = (share * item.value[0], share * item.value[1])
                vector = self.system.from_nodes(core.traction(x, t))  # type: ignore[attr-defined]
        for other in fresh:
            # Body forces stay apart: each is known by its item.
            if edge and (other.key, other.amplitude) == (key, amplitude):
                if vector is None or other.vector is None:
                    other.end += end
                else:
                    other.vector = other.vector + vector
                return
        fresh.append(Spread(key, vector, edges, 0.0, end, amplitude, item))

    def _body(self, item: BodyForce) -> Floats:
        density = [b.section.material.rho for b in self.system.blocks]
        mesh = self.system.model.mesh
        inside = np.ones(mesh.n_cells, bool)
        if not isinstance(item.cells, str):
            inside[:] = False
            inside[item.cells] = True
        elif item.cells not in ("", "all"):
            if item.cells not in mesh.cell_sets:
                known = ", ".join(mesh.cell_sets) or "none"
                raise ModelError(
                    f"no element set named {item.cells!r}; there are: {known}", item.where
                )
            inside[:] = False
            inside[mesh.cell_sets[item.cells]] = True
        masks = [inside[b.cells] for b in self.system.blocks]
        for block, rho, mask in zip(self.system.blocks, density, masks, strict=True):
            massless = block.section.element.startswith("SPRING")
            if mask.any() and rho <= 0.0 and not massless:
                name = block.section.material.name or block.section.material.law
                raise ModelError(
                    f"material {name!r} has no density for a body force; add one (*DENSITY)",
                    item.where,
                )
        force: Floats = self.system.core.body_force(item.kind, list(item.value), density, masks)
        return self.system.at_nodes(force)

    def _edges(self, item: EdgeLoad) -> tuple[object, float]:
        mesh = self.system.model.mesh
        if isinstance(item.edges, str):
            if item.edges not in mesh.edge_sets:
                known = ", ".join(mesh.edge_sets) or "none"
                raise ModelError(f"no surface named {item.edges!r}; there are: {known}", item.where)
            pairs = mesh.edge_sets[item.edges]
        else:
            pairs = np.asarray(item.edges, np.int64).reshape(-1, 2)
        if not self._cells:
            self._cells = {
                int(c): (b, r)
                for b, block in enumerate(self.system.blocks)
                for r, c in enumerate(block.cells)
            }
        nodes, thickness, alpha = [], [], []
        area = 0.0
        for cell, side in pairs:
            if int(cell) not in self._cells:
                label = mesh.cell_labels[int(cell)]
                raise ModelError(f"element {label} of a loaded edge has no section", item.where)
            b, row = self._cells[int(cell)]
            block = self.system.blocks[b]
            element = elements.find(block.section.element)
            local = EDGES[element.cell][int(side)]
            ends = [int(block.nodes[row, a]) for a in local]
            nodes.append([ends[0], ends[1], ends[2] if len(ends) == 3 else ends[0]])
            thickness.append(block.section.thickness)
            alpha.append(element.alpha_b)
            x = mesh.points[ends]
            if len(ends) == 2:
                length = float(np.hypot(*(x[1] - x[0])))
            else:
                r = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
                d = np.stack([r - 0.5, r + 0.5, -2.0 * r], axis=1) @ x
                length = float(np.hypot(d[:, 0], d[:, 1]) @ np.array([5.0, 8.0, 5.0]) / 9.0)
            area += length * block.section.thickness
        core = _core.EdgeLoads(
            np.asarray(nodes, np.uint32).reshape(-1, 3), np.asarray(thickness), np.asarray(alpha)
        )
        return core, area

    def _nodes(self, where: str | Ints) -> Ints:
        if isinstance(where, str):
            return self.system.model.mesh.nodes_of(where)
        return np.asarray(where, np.int64)

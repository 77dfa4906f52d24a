"""Loads and supports over the steps of an analysis.

Without an amplitude a static load or support moves linearly from what the last step reached
to its new value; with one it is the value times the amplitude. What a step does not mention
stays (``OP=MOD``): an amplitude of total time runs on, one of step time ends with its step and
leaves its last value. With ``OP=NEW`` loads of that kind go back to zero, over a static step
and at once in dynamics. A support that is released leaves its reaction as a force that fades out
over the step.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.distributed import DistributedLoads
from corota.analysis.distributed_forces import EMPTY, END_POINT, LoadSum
from corota.analysis.load_history import LoadHistory
from corota.analysis.terms.moving_mass import massless_nodes
from corota.analysis.terms.redistribution import set_moving_mass
from corota.analysis.terms.term import Term
from corota.arrays import distinct
from corota.errors import ModelError, UnsupportedError
from corota.model.dofs import DOFS
from corota.model.integrated import IntegratedAmplitude
from corota.model.loads import (
    Amplitude,
    BodyForce,
    NodalForce,
    Temperature,
    applied,
    check_loads,
    check_supports,
    kind_of,
)
from corota.model.rotations import without_rotation

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from corota.analysis.distributed import DistributedLoad
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.analysis.terms.term import StatePoint
    from corota.errors import Location
    from corota.model.loads import Fixed, Load
    from corota.model.steps import Step

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]


#: Procedures whose state stays as it is.
LINEAR = ("modal dynamic", "steady state")
#: Procedures that look at a state and leave the loads as they are.
PERTURBATION = ("frequency", "buckle")
#: Procedures whose loads are amplitudes of vibrations: apart from those that act on the state.
HARMONIC = ("steady state",)
#: Procedures in which loads that are taken away go at once.
ABRUPT = ("dynamic", *LINEAR)
#: Times whose external forces are kept: those an increment goes from and to.
KNOWN = 2


class Conditions(Term):
    """The loads and supports that act now.

    Parameters
    ----------
    system : NumberedModel

    Attributes
    ----------
    constrained : ndarray of bool, shape (n_dofs,)
        Dofs with a prescribed value.
    fixed : ndarray of int
        Their numbers.
    """

    name = "loads"

    def __init__(self, system: NumberedModel) -> None:
        n = system.n_dofs
        self.system = system
        self.constrained = np.zeros(n, bool)
        self.fixed: Ints = np.zeros(0, np.int64)
        #: External forces that do not follow the displacement, by the last requested times and
        #: whether others do.
        self._known: dict[tuple[float, bool], Floats] = {}
        self.support = LoadHistory(n)
        self.force = LoadHistory(n)
        #: Nodal forces with an amplitude: their values at factor one, by amplitude.
        self.timed: dict[int, Floats] = {}
        #: Nodal forces at the end of the step before.
        self._reached = np.zeros(n)
        self.fading = np.zeros(n)
        self.distributed = DistributedLoads(system)
        #: Temperatures of nodes, absolute.
        self.temperature = LoadHistory(len(system.free.start))
        self.temperature.begin[:] = self.temperature.end[:] = system.free.start
        #: Notes on the step.
        self.notes: list[str] = []
        for name, table in system.model.amplitudes.items():
            if not isinstance(table, Amplitude | IntegratedAmplitude):
                raise ModelError(
                    f"amplitude {name!r} is no Amplitude but {type(table).__name__}: write "
                    f"model.amplitudes[{name!r}] = ct.Amplitude(times, values)"
                )
        self.names = ["", *system.model.amplitudes]
        #: Amplitudes of total time continue in later steps.
        self._runs_on = np.array([False, *(a.total_time for a in system.model.amplitudes.values())])
        #: Amplitudes that move supports from their position at the start of the step.
        self._moves_on = np.array(
            [False] + [isinstance(a, IntegratedAmplitude) for a in system.model.amplitudes.values()]
        )
        self.period = 1.0
        self.end_time = 1.0  # step time at which the step ended: a path may end anywhere
        self.time = 0.0
        self.ramp = True
        self.abrupt = False  # whether removed loads vanish at once
        self._loaded = False  # whether the model's own loads already act
        #: Amplitudes of the harmonic steps so far, apart from the loads of the state.
        self.harmonic: Conditions | None = None
        self._starting = False

    # -- steps -------------------------------------------------------------------------

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        """Start a step at total time `time` from displacement `u`.

        Parameters
        ----------
        reaction : ndarray, shape (n_dofs,), or None
            Reactions at the end of the step before, for supports that are released.
        """
        first = reaction is None
        self.reset_mass()
        self.fading = np.zeros(self.system.n_dofs)
        if not first:
            self._carry()
        constrained_before = self.constrained.copy()
        self.support.carry(u, self._runs_on)
        if step.new_supports:
            self.constrained[:] = False
            self.support.amplitude[:] = 0
        self.period, self.time, self.end_time = step.period, time, step.period
        harmonic = step.procedure in HARMONIC
        self.ramp = harmonic or getattr(step, "ramp", True)
        self.abrupt = step.procedure in ABRUPT
        model = self.system.model
        with_model = first or step.new_supports
        for supports in (model.supports if with_model else [], step.supports):
            self._refuse_conflicts(supports)
            self._set_supports(supports)
        if step.procedure in PERTURBATION or harmonic:
            # Perturbation loads are not among the loads that later steps start from.
            self.end_time = 0.0
            if harmonic:
                self._begin_harmonic(step, model.supports if first else [])
        else:
            self._change_loads(step)
        if reaction is not None:
            released = constrained_before & ~self.constrained
            self.fading[released] = reaction[released]
        self._known = {}
        changing = self.harmonic if harmonic else self
        if step.procedure in LINEAR and changing is not None and changing._heats():
            raise UnsupportedError(
                f"temperatures do not change in a {step.procedure} step; heat in a static or "
                "dynamic step before",
                step.where,
            )

    def _begin_harmonic(self, step: Step, supports: list[Fixed]) -> None:
        """Start a harmonic step: its amplitudes, and those of harmonic steps before it.

        They vary about the state, whatever loads the state carries at the same places. Tables
        are over the frequency.

        Parameters
        ----------
        supports : list of Fixed
            Of the model, if its moves have not been made yet.
        """
        waves = self.harmonic
        if waves is None:
            waves = self.harmonic = Conditions(self.system)
            waves.ramp, waves.abrupt = False, True
        else:
            waves._carry()
        waves.reset_mass()
        waves.support = LoadHistory(self.system.n_dofs)
        waves.constrained[:] = False
        waves.period = waves.end_time = step.period
        waves._set_supports([*supports, *step.supports])
        waves._loaded = self._loaded
        waves._change_loads(step)
        waves._known = {}

    def _change_loads(self, step: Step) -> None:
        """Remove the loads that the step does not keep, and set those that it defines."""
        if step.renews("force"):
            self.force.begin, self.timed = self._reached.copy(), {}
            self.force.remove()
            self.distributed.remove("force")
        if step.renews("distributed"):
            self.distributed.remove()
        if step.renews("temperature"):
            self.temperature.remove(self.system.free.start)
        model = applied(self.system.model.loads, self.system.model.mesh)
        again = [x for x in model if not self._loaded or step.renews(kind_of(x))]
        self._loaded = True
        self._set_loads([*again, *step.loads])

    def _carry(self) -> None:
        """Continue the loads from the values that the step reached, or along their amplitudes."""
        end = self.end_time
        self.distributed.carry(lambda load: self._scale(load, end), self._runs_on)
        self.temperature.carry(self.temperatures(end), self._runs_on)
        self._reached = self._nodal(end)
        self.timed = {a: values for a, values in self.timed.items() if self._runs_on[a]}
        factors = self._factors(end)
        ended = self._reached.copy()
        for amplitude, values in self.timed.items():
            ended -= factors[amplitude] * values
        self.force.carry(ended, self._runs_on)

    def add_items(self, loads: list[Load], supports: Iterable[Fixed]) -> None:
        """Add loads and supports that grow from zero, apart from any step."""
        self._set_supports(supports)
        self._set_loads(loads)
        self._known = {}

    def prescribed(self, step_time: float, u: Floats) -> Floats:
        """Values at prescribed dofs, and `u` elsewhere; shape (n_dofs,)."""
        values = self._values(self.support, step_time)
        course = self.support
        on = self._moves_on[course.amplitude]
        if on.any():
            begun = self._factors(0.0)[course.amplitude[on]]
            values[on] += course.begin[on] - course.end[on] * begun
        out: Floats = np.where(self.constrained, values, u)
        return out

    def support_rates(self, step_time: float, window: float) -> tuple[Floats, Floats]:
        """Velocity and acceleration of prescribed dofs at a time, 0 elsewhere; shapes (n_dofs,).

        Amplitudes are seen over a window (half its width), which is the increment: what
        changes faster than that is a pulse of the right impulse.
        """
        constrained, course = self.constrained, self.support
        v, a = np.zeros(len(constrained)), np.zeros(len(constrained))
        if self.ramp:
            v = np.where(constrained, (course.end - course.begin) / self.period, 0.0)
        window = min(window, self.period / 3.0)
        for index in distinct(course.amplitude[constrained]).tolist():
            if index:
                table = self.system.model.amplitudes[self.names[index]]
                start = self.time if table.total_time else 0.0
                rate, growth = table.derivatives(
                    start + step_time, window, start, start + self.period
                )
                named = constrained & (course.amplitude == index)
                v[named], a[named] = course.end[named] * rate, course.end[named] * growth
        return v, a

    def support_kinks(self) -> list[tuple[str, float]]:
        """Amplitudes of supports whose rate jumps within the step, with the first step time."""
        out = []
        for index in distinct(self.support.amplitude[self.constrained]).tolist():
            if index:
                table = self.system.model.amplitudes[self.names[index]]
                times = table.kinks() - (self.time if table.total_time else 0.0)
                inside = times[(times > 0.0) & (times < self.period * (1.0 - 1e-9))]
                if len(inside):
                    out.append((self.names[index], float(inside[0])))
        return out

    def set_mass(self, kind: str) -> None:
        """Apply gravity and spin to the inertial mass: free fall is free of stress."""
        self._known = {}
        self.distributed.set_mass(kind)

    def reset_mass(self) -> None:
        """Apply them to the mass of the dynamic step that this step belongs to."""
        mass = self.system.mass
        set_moving_mass(self.system, mass.kind, massless_nodes(self.system, mass.redistribute))
        self.set_mass(mass.kind)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        """Set the external force, and what its derivative adds to the tangent."""
        u, start = point.u, END_POINT
        if point.between is not None:
            start, u, _ = point.between
        share = point.weights[0]
        at.external, at.load_stiffness = self.external(point.time, u, at.values, share, start)

    def external(
        self,
        step_time: float,
        u: Floats,
        values: Floats = EMPTY,
        share: float = 1.0,
        start: Floats = END_POINT,
    ) -> tuple[Floats, tuple[Ints, Ints, Floats] | None]:
        """External force at a time and displacement, and its derivative.

        Parameters
        ----------
        values : ndarray, shape (nnz,), optional
            Upper triangle of a tangent. The derivative of loads with a potential of their own is
            taken from it, in place.
        share : float
            Factor of all derivatives.
        start : ndarray, shape (n_dofs,), optional
            Where a mid-point increment starts that ends at `u`: loads are those in between.

        Returns
        -------
        force : ndarray, shape (n_dofs,)
            For reading only.
        triplets : tuple of ndarray or None
            Rows, columns and values of the rest of the derivative.
        """
        follow = self._follow
        force = self._known.get((step_time, follow))
        if force is None:
            force = self._dead(step_time)
        following = [load for load in self.distributed.loads if follow and load.force.follows]
        if not following:
            return force, None
        if self.system.about_linear:
            u = np.zeros_like(u)
        total = LoadSum(force.copy(), values, share, start)
        for load in following:
            if (scale := self._scale(load, step_time)) != 0.0:
                load.force.add(scale, u, total)
        return total.force, total.triplets

    def temperatures(self, step_time: float) -> Floats:
        """Temperatures of the nodes, shape (n_nodes,)."""
        return self._values(self.temperature, step_time)

    @property
    def heating(self) -> Floats:
        """Change of temperature per unit of load factor, shape (n_nodes,)."""
        return self.temperature.end - self.temperature.begin

    @property
    def _follow(self) -> bool:
        """Whether loads turn with the structure, or would if it moved on from here."""
        return self.system.nlgeom or self.system.about_linear

    def _dead(self, step_time: float) -> Floats:
        """External forces at a time that do not follow the displacement."""
        force = self._nodal(step_time)
        force += (1.0 - self._ramp(step_time)) * self.fading
        follow = self._follow
        for load in self.distributed.loads:
            dead = not (follow and load.force.follows)
            if dead and (scale := self._scale(load, step_time)) != 0.0:
                force += scale * load.force.unit()
        force.flags.writeable = False
        if len(self._known) >= KNOWN:
            self._known.clear()
        self._known[step_time, follow] = force
        return force

    def rate(self, u: Floats) -> tuple[Floats, Floats]:
        """Change of external forces and of prescribed dofs per unit of load factor, at `u`.

        Loads and supports are linear in the load factor (the share of the period), so the
        difference over one unit is exact once :meth:`check_proportional` has passed. Thermal
        strain acts as the internal force that it takes away.
        """
        force = self.external(self.period, u)[0] - self.external(0.0, u)[0]
        heating = self.heating
        if heating.any():
            force = force - self.system.thermal_rate(u, heating)
        move = np.where(self.constrained, self.support.end - self.support.begin, 0.0)
        return force, move

    def check_proportional(self) -> None:
        """Refuse loads that do not grow with the load factor.

        Raises
        ------
        ModelError
            If there is an amplitude, an abrupt load or a released support.
        """
        named = {int(i) for i in distinct(self.support.amplitude[self.constrained])}
        named |= set(self.timed) | {load.amplitude for load in self.distributed.loads}
        named |= {int(i) for i in distinct(self.temperature.amplitude)}
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
        materials = [block.section.material for block in self.system.blocks]
        linear = all(m.linear and not m.follows_temperature for m in materials)
        if self.heating.any() and not linear:
            raise ModelError(
                "temperatures that change in a step that follows a path need elastic material "
                "with constants that do not depend on them; heat in an earlier static step"
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
            for load in self.distributed.loads
            if isinstance(load.item, BodyForce) and (scale := self._scale(load, self.period)) != 0.0
        ]

    @contextmanager
    def as_reached(self) -> Iterator[None]:
        """Reset forces to those that earlier steps reached: no load of this step acts yet."""
        self._starting, self._known = True, {}
        try:
            yield
        finally:
            self._starting, self._known = False, {}

    # -- histories ---------------------------------------------------------------------

    def _ramp(self, step_time: float) -> float:
        return step_time / self.period if self.ramp else 1.0

    def _removal(self, step_time: float) -> float:
        """Removed fraction of a load that the step removes."""
        return 1.0 if self.abrupt else step_time / self.period

    def _factors(self, step_time: float) -> Floats:
        factors = np.ones(len(self.names))
        amplitudes = self.system.model.amplitudes
        for i, name in enumerate(self.names[1:], start=1):
            table = amplitudes[name]
            factors[i] = table(step_time + (self.time if table.total_time else 0.0))
        return factors

    def _values(self, history: LoadHistory, step_time: float) -> Floats:
        return history.at(self._ramp(step_time), self._removal(step_time), self._factors(step_time))

    def _nodal(self, step_time: float) -> Floats:
        if self._starting:
            return np.array(self._reached)
        force = self._values(self.force, step_time)
        factors = self._factors(step_time)
        for amplitude, values in self.timed.items():
            force += factors[amplitude] * values
        return force

    def _scale(self, load: DistributedLoad, step_time: float) -> float:
        if self._starting:
            return load.begin
        if load.amplitude:
            return load.end * float(self._factors(step_time)[load.amplitude])
        share = self._removal(step_time) if load.removed else self._ramp(step_time)
        return load.begin + share * (load.end - load.begin)

    def _heats(self) -> bool:
        """Whether temperatures change in the step."""
        tables = self.system.model.amplitudes
        times = {0.0, self.period}
        for index in distinct(self.temperature.amplitude):
            if index:
                table = tables[self.names[index]]
                own = table.time - (self.time if table.total_time else 0.0)
                times |= set(own[(own > 0.0) & (own < self.period)].tolist())
        start = self.temperature.begin
        return any(not np.array_equal(self.temperatures(t), start) for t in times)

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
            # A rotation may be given for nodes without one, as with dofs 1-6 in decks.
            if item.dof == 2 and item.value != 0.0 and (dofs < 0).any():
                label = self.system.model.mesh.node_labels[nodes[dofs < 0][0]]
                raise ModelError(
                    f"node {label} has no drilling rotation to prescribe; use OPT or Q4D there",
                    item.where,
                )
            if item.dof == 2 and item.where is None and (dofs < 0).all():
                self.notes.append(without_rotation(self.system.model.mesh, item))
            dofs = dofs[dofs >= 0]
            self.system.constraints.refuse_constrained(dofs, item.where)
            self.constrained[dofs] = True
            value = self.support.begin[dofs] if item.keep else item.value
            self.support.set(dofs, value, self._amplitude(item.amplitude, item.where))
        self.fixed = np.flatnonzero(self.constrained)

    def _refuse_conflicts(self, supports: list[Fixed]) -> None:
        """Refuse a dof that is given two values at once; the same one twice is one.

        Of decks the later value counts, with a note.

        Raises
        ------
        ModelError
            Naming the node, the direction and both values.
        """
        check_supports(supports)
        n = self.system.n_dofs
        value, amplitude, given = np.zeros(n), np.zeros(n, np.int64), np.zeros(n, bool)
        for item in supports:
            nodes = self._nodes(item.nodes)
            dofs = self.system.dofs(nodes, item.dof)
            nodes, dofs = nodes[dofs >= 0], dofs[dofs >= 0]
            index = self._amplitude(item.amplitude, item.where)
            given_before = given[dofs] & (not item.keep)
            twice = given_before & ((value[dofs] != item.value) | (amplitude[dofs] != index))
            if twice.any():
                at = int(np.flatnonzero(twice)[0])
                label = self.system.model.mesh.node_labels[nodes[at]]
                name = list(DOFS)[item.dof]
                other, own = value[dofs[at]], item.value
                what = f"two values, {other:g} and {own:g}" if other != own else "two amplitudes"
                dof = f"{name} (dof {(1, 2, 6)[item.dof]})"
                if item.where is not None:  # a deck: as CalculiX does, but with a note
                    self.notes.append(
                        f"{item.where}: node {label} is given {what}, in {dof}; the later one is "
                        "used"
                    )
                    break
                raise ModelError(
                    f"node {label} is given {what}, in {dof}: leave "
                    "one of the supports out, or put the later one into a step of its own",
                    item.where,
                )
            value[dofs], amplitude[dofs], given[dofs] = item.value, index, True

    def _set_loads(self, given: Sequence[Load]) -> None:
        check_loads(given)
        loads = applied(given, self.system.model.mesh)
        forces = [item for item in loads if isinstance(item, NodalForce)]
        self._replace_forces(forces)
        for item in forces:
            if not item.follower:
                self._add_force(item)
        for heated in loads:
            if isinstance(heated, Temperature):
                self._heat(heated)
        self.distributed.set(
            [item for item in loads if not isinstance(item, Temperature)], self._amplitude
        )

    def _heat(self, item: Temperature) -> None:
        self.system.free.require_response(item.where)
        amplitude = self._amplitude(item.amplitude, item.where)
        every = isinstance(item.nodes, str) and not item.nodes
        nodes = np.arange(len(self.temperature.end)) if every else self._nodes(item.nodes)
        try:
            self.temperature.set(nodes, item.value, amplitude)
        except ValueError:
            raise ModelError(
                f"{np.size(item.value)} temperatures for {len(nodes)} nodes", item.where
            ) from None

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
        self.system.constraints.refuse_loaded(dofs, item.where)
        return dofs

    def _replace_forces(self, forces: list[NodalForce]) -> None:
        """Remove forces that the step redefines: at once if only amplitudes follow."""
        named = np.zeros(self.system.n_dofs, bool)
        ramped = np.zeros(self.system.n_dofs, bool)
        for item in forces:
            dofs = self._force_dofs(item)
            named[dofs] = True
            ramped[dofs] |= not item.amplitude
        for values in self.timed.values():
            values[named] = 0.0
        self.force.set(np.flatnonzero(named), 0.0, 0)
        self.force.begin[named] = np.where(ramped, self._reached, 0.0)[named]

    def _add_force(self, item: NodalForce) -> None:
        # Several entries of one step add up, each with its own amplitude.
        amplitude = self._amplitude(item.amplitude, item.where)
        target = self.force.end
        if amplitude:
            target = self.timed.setdefault(amplitude, np.zeros(self.system.n_dofs))
        np.add.at(target, self._force_dofs(item), item.value)

    def _nodes(self, where: str | Ints) -> Ints:
        return self.system.model.mesh.node_indices(where)

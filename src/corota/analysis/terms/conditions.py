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
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.analysis.distributed import DistributedLoad, DistributedLoads
from corota.analysis.distributed_forces import EMPTY, END_POINT, LoadSum
from corota.analysis.terms.element_changes import ElementChanges
from corota.analysis.terms.load_factors import LoadFactors
from corota.analysis.terms.nodal_forces import NodalForces
from corota.analysis.terms.redistribution import massless_nodes, set_moving_mass
from corota.analysis.terms.supports import Supports
from corota.analysis.terms.temperatures import Temperatures
from corota.analysis.terms.term import StatePoint, Term
from corota.errors import ModelError, UnsupportedError
from corota.model.loads import (
    LOAD_KINDS,
    BodyForce,
    EdgeLoad,
    Fixed,
    Load,
    NodalForce,
    Temperature,
    applied,
    applied_in_step,
    check_loads,
    given_as,
    kind_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from corota.analysis.evaluation import Evaluation
    from corota.analysis.numbered_model import NumberedModel
    from corota.arrays import Bools, Floats, Ints
    from corota.model.steps import Step


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

    Attributes
    ----------
    factors : LoadFactors
        Ramp and amplitudes of the step.
    supports : Supports
    forces : NodalForces
        Those that keep their direction.
    distributed : DistributedLoads
        Loads of edges and bodies, and forces that follow their nodes.
    temperatures : Temperatures
    fading : ndarray, shape (n_dofs,)
        Reactions of released supports.
    end_time : float
        Step time at which the step ended: a path may end anywhere [time].
    harmonic : Conditions or None
        Amplitudes of the harmonic steps so far, apart from the loads of the state.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"_known"})

    name = "loads"

    def __init__(self, system: NumberedModel) -> None:
        self.system = system
        #: External forces that do not follow the displacement, by the last requested times and
        #: whether others do.
        self._known: dict[tuple[float, bool], Floats] = {}
        self.factors = LoadFactors(system.model.amplitudes)
        self.supports = Supports(system, self.factors)
        self.forces = NodalForces(system, self.factors)
        self.distributed = DistributedLoads(system)
        self.temperatures = Temperatures(system, self.factors)
        self.fading = np.zeros(system.n_dofs)
        self.changes = ElementChanges(system)
        self.end_time = 1.0
        self.harmonic: Conditions | None = None
        self._loaded = False  # whether the model's own loads already act
        self._starting = False

    @property
    def constrained(self) -> Bools:
        """Dofs with a prescribed value, shape (n_dofs,)."""
        return self.supports.constrained

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
        self.changes.check(step)
        self.supports.constrained[self.changes.held] = False
        constrained_before = self.constrained.copy()
        self.supports.carry(u)
        if step.new_supports:
            self.supports.release()
        factors, harmonic = self.factors, step.procedure in HARMONIC
        factors.period, factors.time, self.end_time = step.period, time, step.period
        factors.ramp = harmonic or getattr(step, "ramp", True)
        factors.abrupt = step.procedure in ABRUPT
        model = self.system.model
        with_model = first or step.new_supports
        for supports in (model.supports if with_model else [], step.supports):
            self.supports.add(supports, once=True)
        if step.procedure in PERTURBATION or harmonic:
            # Perturbation loads are not among the loads that later steps start from.
            self.end_time = 0.0
            if harmonic:
                self._begin_harmonic(step, model.supports if first else [])
        else:
            self._change_loads(step)
        self._refuse_fluids(step)
        if reaction is not None:
            released = constrained_before & ~self.constrained
            self.fading[released] = reaction[released]
        self._known = {}
        if step.element_changes or self.changes.removed.any():
            self._change_elements(step, u)
        changing = self.harmonic if harmonic else self
        if step.procedure in LINEAR and changing is not None and changing.temperatures.vary():
            raise UnsupportedError(
                f"temperatures do not change in a {step.procedure} step; heat in a static or "
                "dynamic step before",
                step.where,
            )

    def _change_elements(self, step: Step, u: Floats) -> None:
        """Remove and add elements; what they carried and their loads fade out over the step."""
        changes = self.changes
        begin = self.external(0.0, u)[0] - changes.force(u)
        changes.change(step, u)
        self.distributed.drop(changes.removed)
        self.set_mass(self.distributed.mass)
        if step.element_changes:
            self.fading = self.fading + begin - self.external(0.0, u)[0] + changes.force(u)
            self._known = {}
        changes.held = changes.bare() & ~self.constrained
        self.supports.hold(changes.held, u)

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
            waves.factors.ramp, waves.factors.abrupt = False, True
        else:
            waves._carry()
        waves.reset_mass()
        waves.supports = Supports(self.system, waves.factors)
        waves.factors.period = waves.end_time = step.period
        waves.supports.add([*supports, *step.supports])
        waves._loaded = self._loaded
        waves._change_loads(step)
        waves._known = {}

    def _change_loads(self, step: Step) -> None:
        """Remove the loads that the step does not keep, and set those that it defines."""
        renewed = {kind for kind in LOAD_KINDS if step.renews(kind)}
        gone = renewed | step.ended
        if "force" in gone:
            self.forces.remove()
        if "temperature" in gone:
            self.temperatures.remove()
        self.distributed.remove(lambda x: kind_of(x) in renewed or given_as(x) in step.ended)
        model = applied(self.system.model.loads, self.system.model.mesh)
        again = [
            x
            for x in model
            if given_as(x) not in step.ended and (not self._loaded or step.renews(kind_of(x)))
        ]
        self._loaded = True
        self._set_loads([*again, *step.loads])

    def _carry(self) -> None:
        """Continue the loads from the values that the step reached, or along their amplitudes."""
        end = self.end_time
        self.distributed.carry(lambda load: self.scale(load, end), self.factors.runs_on)
        self.temperatures.carry(end)
        self.forces.carry(end)

    # -- fluids that penetrate ----------------------------------------------------------

    @property
    def fluids(self) -> list[DistributedLoad]:
        """Loads of fluids that penetrate between surfaces."""
        return [
            load
            for load in self.distributed.loads
            if isinstance(load.item, EdgeLoad) and load.item.kind == "penetrating pressure"
        ]

    def begin_fluids(self, contact: Floats, soft: Bools, u: Floats) -> None:
        """Put the fronts of fluids where the committed contact pressures allow them."""
        for load in self.fluids:
            load.force.begin(contact, soft, u)  # type: ignore[attr-defined]
        self._known = {}

    def advance_fluids(self, contact: Floats, soft: Bools, u: Floats, step_time: float) -> bool:
        """Advance the fronts of fluids at an equilibrium; False where all stand."""
        moved = [
            load.force.advance(contact, soft, self.scale(load, step_time), u)  # type: ignore[attr-defined]
            for load in self.fluids
        ]
        if any(moved):
            self._known = {}
        return any(moved)

    def commit(self) -> None:
        """Accept the fronts of fluids."""
        for load in self.fluids:
            load.force.commit()  # type: ignore[attr-defined]

    def wetted(self) -> dict[str, float]:
        """How far fluids have penetrated, by the name of the scalar."""
        fluids = self.fluids
        if not fluids:
            return {}
        return {"wetted length": sum(load.force.wetted for load in fluids)}  # type: ignore[attr-defined]

    def _refuse_fluids(self, step: Step) -> None:
        """Refuse a fluid in a step that does not find out where it is."""
        explicit = getattr(step, "scheme", "") == "central_difference"
        path = getattr(step, "path", None) is not None
        if step.procedure in ("static", "dynamic") and not (explicit or path):
            return
        for load in (self.harmonic or self).fluids:
            if load.begin != load.end or explicit:
                raise UnsupportedError(
                    "a fluid that penetrates is for static steps by load control and implicit "
                    "dynamic steps",
                    load.item.where,
                )

    def add_items(self, loads: list[Load], supports: Iterable[Fixed]) -> None:
        """Add loads and supports that grow from zero, apart from any step."""
        self.supports.add(supports)
        self._set_loads(loads)
        self._known = {}

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
            if (scale := self.scale(load, step_time)) != 0.0:
                load.force.add(scale, u, total)
        return total.force, total.triplets

    @property
    def heating(self) -> Floats:
        """Change of temperature per unit of load factor, shape (n_nodes,)."""
        return self.temperatures.change

    @property
    def _follow(self) -> bool:
        """Whether loads turn with the structure, or would if it moved on from here."""
        return self.system.nlgeom or self.system.about_linear

    def _dead(self, step_time: float) -> Floats:
        """External forces at a time that do not follow the displacement."""
        force = self.forces.reached.copy() if self._starting else self.forces.at(step_time)
        force += (1.0 - self.factors.growth(step_time)) * self.fading
        follow = self._follow
        for load in self.distributed.loads:
            dead = not (follow and load.force.follows)
            if dead and (scale := self.scale(load, step_time)) != 0.0:
                force += scale * load.force.unit()
        force.setflags(write=False)
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
        force = self.external(self.factors.period, u)[0] - self.external(0.0, u)[0]
        heating = self.heating
        if heating.any():
            force = force - self.system.thermal_rate(u, heating)
        return force, self.supports.change()

    def check_proportional(self) -> None:
        """Refuse loads that do not grow with the load factor.

        Raises
        ------
        ModelError
            If there is an amplitude, an abrupt load or a released support.
        """
        named = {*self.supports.amplitudes(), *self.temperatures.amplitudes()}
        named |= set(self.forces.timed) | {load.amplitude for load in self.distributed.loads}
        for index in named - {0}:
            raise ModelError(
                f"amplitude {self.factors.names[index]!r} in a step that follows a path: its loads "
                "grow with the load factor; leave the amplitude out, or put that load into a "
                "step before"
            )
        if any(load.begin != load.end for load in self.fluids):
            raise ModelError(
                "a fluid that penetrates in a step that follows a path: its front is no function "
                "of the load factor; let its pressure grow in a step before"
            )
        if not self.factors.ramp:
            raise ModelError(
                "a step that follows a path needs loads that grow (ramp=True, AMPLITUDE=RAMP)"
            )
        materials = [block.section.material for block in self.system.blocks]
        if self.system.depends_on_time:
            raise ModelError(
                "a step that follows a path has no time, but a material depends on it: use a step "
                "by load control"
            )
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
        end = self.factors.period
        return [
            (load.item, scale)
            for load in self.distributed.loads
            if isinstance(load.item, BodyForce) and (scale := self.scale(load, end)) != 0.0
        ]

    @contextmanager
    def as_reached(self) -> Iterator[None]:
        """Reset forces to those that earlier steps reached: no load of this step acts yet."""
        self._starting, self._known = True, {}
        try:
            yield
        finally:
            self._starting, self._known = False, {}

    def scale(self, load: DistributedLoad, step_time: float) -> float:
        """Scale of a distributed load at a time of the step."""
        if self._starting:
            return load.begin
        if load.amplitude:
            return load.end * float(self.factors.of_amplitudes(step_time)[load.amplitude])
        factors = self.factors
        share = factors.removal(step_time) if load.removed else factors.growth(step_time)
        return load.begin + share * (load.end - load.begin)

    def _set_loads(self, given: Sequence[Load]) -> None:
        check_loads(given)
        mesh = self.system.model.mesh
        loads = applied_in_step(given, mesh)
        self.forces.set([item for item in loads if isinstance(item, NodalForce)])
        for heated in loads:
            if isinstance(heated, Temperature):
                self.temperatures.set(heated)
        self.distributed.set(
            [item for item in loads if not isinstance(item, Temperature)], self.factors.index
        )

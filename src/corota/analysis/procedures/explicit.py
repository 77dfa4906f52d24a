"""Central differences: explicit time integration with the lumped mass."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, get_args

import numpy as np

from corota.analysis.energies import LARGE_ERROR
from corota.analysis.increment_loop import Accepted, IncrementLoop, Stepper
from corota.analysis.numbered_model import Role
from corota.analysis.procedures.explicit_constraints import FreeMass, ReducedMass, mass_of
from corota.analysis.procedures.motion_start import initial_velocity
from corota.analysis.rule import AtVelocity
from corota.analysis.terms.contact.motion import ForwardContact
from corota.analysis.terms.damping import material_pairs
from corota.analysis.terms.inertia import Inertia
from corota.errors import ConvergenceError, InputError, ModelError

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.terms.term import StatePoint
    from corota.arrays import Bools, Floats
    from corota.model.steps import Dynamic


#: Share of the stable increment that automatic increments take.
SAFETY = 0.9
#: Iterations for the largest frequency; its estimate rises to the true value.
POWER = 60
#: Total energy, relative to the energy put in, that may be a blow-up.
BLOW_UP = 10.0
#: Moves within an increment, relative to the model's size, that are as good as none.
ROUND_OFF = 1e-12
#: Unbalanced force at dofs without mass, relative to the largest force, that counts as zero.
BALANCED = 1e-9
#: Largest number of kept frames of a step, unless outputs request times.
FRAMES = 200
#: Two times closer than this share of the period are the same.
SAME_TIME = 1e-9


def diagonal(system: System) -> Floats:
    """Lumped mass by dof, shape (n_dofs,) [mass], [mass*length^2] for rotations."""
    values = Inertia(system, "lumped").matrix
    assert values is not None
    return system.pattern.diagonal_of(values)


def stable_increment(system: System, u: Floats, mass: FreeMass) -> float:
    """Largest stable increment, 2 / (largest frequency) [time].

    Only dofs that are free and have mass count: constrained ones follow their supports, with or
    without
    mass. It is infinite if none of those has stiffness.

    Raises
    ------
    ModelError
        If a free dof has stiffness but no mass, or if the frequency is not finite.
    """
    moving, idle = mass.moving, mass.idle
    values = system.evaluate(u.copy(), 0.0).values
    if idle.any():
        _refuse_idle(system, idle & mass.felt(values), "has stiffness but no mass")
    if not moving.any():
        return np.inf
    x = np.where(moving, np.random.default_rng(0).standard_normal(system.n_dofs), 0.0)
    largest = 0.0
    for _ in range(POWER):
        x /= np.sqrt(x @ mass.inertia(x))
        y = np.where(moving, mass.stiffness(values, x), 0.0)
        largest = float(x @ y)
        x = mass.response(y)
        if not x.any():
            return np.inf
    if not np.isfinite(largest):
        raise ModelError(
            "the largest frequency is not finite, so central differences have no stable "
            "increment: check stiffness and mass, or use an implicit scheme"
        )
    return 2.0 / float(np.sqrt(largest)) if largest > 0.0 else np.inf


def _refuse_idle(system: System, idle: Bools, what: str) -> None:
    """Refuse the first of some free dofs without mass."""
    if idle.any():
        raise ModelError(
            f"{system.describe(int(np.flatnonzero(idle)[0]))} {what}: central differences cannot "
            "move it; add a point mass, fix it, or use an implicit scheme"
        )


def explicit_step(loop: IncrementLoop, step: Dynamic, stops: list[float]) -> None:
    """Run a step with central differences.

    Raises
    ------
    InputError
        If there is damping, which this scheme leaves out.
    UnsupportedError
        If nodes are in contact and depend on others by constraints.
    ModelError
        If the requested increment is not stable; the message gives the stable one. If a free dof
        with stiffness or load has no mass, or if there is no stiffness to find an increment from.
    ConvergenceError
        If the motion blows up all the same.
    """
    system = loop.system
    if system.model.dashpots or any(step.rayleigh) or material_pairs(system):
        raise InputError(
            "central differences do not support damping; use an implicit scheme, or remove "
            "dashpots and rayleigh",
            step.where,
        )
    stepper = ExplicitStepper(loop, step, stops)
    loop.run(stepper)
    # A static step that follows needs the static equation at this displacement.
    loop.state.reaction, loop.state.at = None, stepper.at
    stepper.tell_of_impacts()
    if stepper.keep > 1:
        warnings.warn(
            f"central differences took {stepper.n} increments of {stepper.dt:.3g} (stable: "
            f"{stepper.stable:.3g}); every {stepper.keep}th is kept",
            stacklevel=2,
        )


class CentralDifference(AtVelocity):
    """The end of an increment; terms see the velocity of its middle, half an increment late."""

    def close(self, point: StatePoint, at: Evaluation) -> None:
        """Count forces of velocities among the internal ones."""
        if at.damping is not None:
            at.internal = at.internal + at.damping


class ExplicitStepper(Stepper):
    """Increments of central differences, all of one size; some of many are shown.

    Parameters
    ----------
    stops : list of float
        Step times that are shown.
    """

    kind, advice = "explicit", "allow more (INC=)"
    remembered = (
        *("known", "taken", "n", "keep", "wanted", "dt", "stable", "u", "v", "at", "begin", "work"),
        *("internal", "reported_internal", "driven", "contact", "force", "between"),
    )

    def __init__(self, loop: IncrementLoop, step: Dynamic, stops: list[float]) -> None:
        self.system, self.state, self.step = loop.system, loop.state, step
        system, state = loop.system, loop.state
        self.mass = mass = diagonal(system)
        self.moved = mass_of(system, mass, state.u)
        if isinstance(self.moved, ReducedMass):
            for role in get_args(Role):
                self.moved.refuse_contact(system.nodes_of_terms(role), step.where)
        constrained = system.conditions.constrained
        resumes = bool(state.resumes)
        self.stable = np.inf if resumes else stable_increment(system, state.u, self.moved)
        # A checkpoint contains the increment.
        dt = step.period if resumes else self._increment()
        self.n = max(int(np.ceil(step.period / dt * (1.0 - 1e-12))), 1)
        self.dt = dt = step.period / self.n
        self.keep = max(self.n // FRAMES, 1)
        self.heated = system.free.responds and system.conditions.temperatures.vary()
        grid = [(s, round(s / dt)) for s in stops if 0.0 < s <= step.period]
        on = [i for s, i in grid if abs(i * dt - s) <= SAME_TIME * step.period]
        #: Requested times within increments.
        self.between = sorted({s for s, i in grid if i not in on})
        peaks = [round(t / dt) for t in peak_times(loop, step)]
        self.wanted = {*on, *peaks, step.max_increments}
        #: Every so many increments is a frame by request.
        self.every = [o.frequency for o in loop.observers.requests if o.every or o.frequency > 1]
        self.save, self.number = loop.save, loop.number
        self.envelope = Envelope(system)
        state.counters["stable increment"] = self.stable  # type: ignore[assignment]
        if state.v is None:
            state.v = initial_velocity(system, state.u)
        given_v, given_a = system.conditions.supports.rates(0.0, dt)
        state.v[constrained] = given_v[constrained]
        self.u = state.u.copy()
        self.at = system.evaluate(self.u, 0.0, CentralDifference(state.v))
        self.idle = self.moved.idle
        self.account = account = state.energies
        self.contact = ForwardContact(system, account, dt)
        if not resumes:
            _refuse_pushed(system, self.idle, self.at)
            system.constraints.complete_rates(self.u, state.v)
        free = state.v - 0.5 * dt * self.moved.inverse * self.at.residual
        still, force = np.zeros_like(free), np.zeros_like(free)
        if not resumes:
            force = self._contact(still, state.v, free, 0.5, 0.0)
        #: Contact forces of the last increment.
        self.force = force
        residual = self.at.residual - force
        a = self._accelerate(state.v, residual, 0.0, 0.5)
        residual = self._gathered(self.at, residual, a)
        account.drive(self.at.external, residual)
        self.begin = account.work
        #: Velocity half an increment ahead.
        self.v = state.v + 0.5 * dt * a
        self.work = self.internal = self.reported_internal = 0.0
        first = 0.5 * float(state.v @ (mass * state.v))
        self.known = Known(system, mass, first, dt)
        account.set_kinetic(first)
        self.driven = 0.5 * float((mass * state.v**2)[constrained].sum())
        if resumes:
            self.resume()
            return
        state.at = replace(self.at, internal=self.at.internal - force)
        state.a = np.where(constrained, given_a, a)
        state.reaction = np.where(constrained, residual + mass * given_a, 0.0)
        scalars = {"kinetic energy": first, "external work": account.work}
        scalars |= momenta(system, mass, state.u, state.v)
        loop.show_start(scalars | self.contact.sums())

    def _increment(self) -> float:
        """Requested increment, or a stable one [time]."""
        step, stable = self.step, self.stable
        if step.fixed_increments:
            if step.first_increment > stable:
                raise ModelError(
                    f"the increment {step.first_increment:g} is above the stable one of central "
                    f"differences, {stable:.4g}; use at most {SAFETY * stable:.3g}, or an "
                    "implicit scheme",
                    step.where,
                )
            return step.first_increment
        if not np.isfinite(stable):
            raise ModelError(
                "no free dof has stiffness at the start, so there is no stable increment; give "
                "increments, or use an implicit scheme",
                step.where,
            )
        return min(SAFETY * stable, step.largest_increment)

    @property
    def finished(self) -> bool:
        return self.taken >= self.n

    @property
    def where(self) -> str:
        return f"step time {self.taken * self.dt:g} of {self.step.period:g}"

    def advance(self) -> Accepted:
        while True:
            shown = self._one()
            if shown is not None:
                return shown

    def _one(self) -> Accepted | None:
        system, state, account, mass, dt = (
            self.system,
            self.state,
            self.account,
            self.mass,
            self.dt,
        )
        constrained = system.conditions.constrained
        i = self.taken + 1
        time = i * dt
        before = self.at
        while self.between and self.between[0] < time:
            self._show_between(self.between.pop(0))
        du = np.where(
            constrained, system.conditions.supports.at(time, self.u) - self.u, dt * self.v
        )
        self.u = self.u + du
        self.at = at = system.evaluate(self.u, time, CentralDifference(self.v))
        system.commit()
        _refuse_pushed(system, self.idle, at)
        # Prescribed dofs have the rates of their amplitude, as in the implicit schemes.
        given_v, given_a = system.conditions.supports.rates(time, dt)
        free = self.v - dt * self.moved.inverse * at.residual
        force = self._contact(du, self.v, free, 1.0, time)
        self.force = force
        residual = at.residual - force
        a = self._accelerate(self.v, residual, time, 1.0)
        residual = self._gathered(at, residual, a)
        account.add_work(du, at.external, residual)
        damped = 0.0
        if before.damping is not None and at.damping is not None:
            damped = float(0.5 * (before.damping + at.damping) @ du)
            account.viscous += damped
        self.internal += float(0.5 * (before.internal + at.internal) @ du) - damped
        whole = np.where(constrained, given_v, self.v + 0.5 * dt * a)
        # Supports accelerate the mass that moves with them.
        moved = 0.5 * float((mass * whole**2)[constrained].sum())
        account.work += moved - self.driven
        worked = account.work - self.begin - self.work
        self.driven, self.work = moved, account.work - self.begin
        self.v = np.where(constrained, given_v, self.v + dt * a)
        carried = self.moved.carried
        stiff = float(np.where(carried, at.internal - before.internal, 0.0) @ du)
        inert = float(np.where(carried, mass * du, 0.0) @ du)
        kinetic = 0.5 * float(whole @ (mass * whole))
        pending = float((at.external + np.where(constrained, residual, 0.0)) @ whole) * dt
        allowed = BLOW_UP * self.known.energy(worked, self.internal, pending)
        # The frequency of the increment itself is above the stable one, and energy comes of it.
        unstable = stiff * dt**2 > 4.0 * inert and kinetic + self.internal > allowed
        if unstable and self.heated:  # heat changes forces without any motion
            still = system.forces(self.u - du, time).internal
            stiff = float(np.where(carried, at.internal - still, 0.0) @ du)
            unstable = stiff * dt**2 > 4.0 * inert
        if unstable or not np.isfinite(kinetic + self.internal):
            raise ConvergenceError(
                f"the solution diverges at step time {time:g}; the stable increment has become "
                f"smaller than {dt:g}: use automatic increments with a smaller first one"
            )
        self.taken = i
        self.envelope.add(self.u, whole, at.external, np.where(constrained, residual, 0.0))
        requested = i in self.wanted or any(f and i % f == 0 for f in self.every)
        if i % self.keep and i != self.n and not requested:
            if self.heated:
                system.recover(self.u)  # adds the work of heat
            return None
        state.u, state.v = self.u, whole
        state.at = replace(at, internal=at.internal - force)
        state.a = np.where(constrained, given_a, a)
        state.step_time, account.kinetic = time, kinetic
        account.internal += self.internal - self.reported_internal
        self.reported_internal = self.internal
        state.reaction = np.where(constrained, residual + mass * given_a, 0.0)
        scalars = {
            "dt": dt,
            "iterations": 1.0,
            "external work": account.work,
            "internal work": account.internal,
            "kinetic energy": kinetic,
            **momenta(system, mass, self.u, whole),
            **(self.envelope.scalars() if self.keep > 1 else {}),
            **self.contact.sums(),
        }
        self.envelope.clear()
        return Accepted(i, time / self.step.period, scalars)

    def _show_between(self, time: float) -> None:
        """Output a requested time within the next increment, which stays as it is.

        The motion of central differences is linear within an increment; stress and forces are
        those of the position, contact forces those of its start.
        """
        system, state, account = self.system, self.state, self.account
        kept = dict(vars(state))
        sums = account.kinetic, account.work, account.internal
        constrained = system.conditions.constrained
        lag = time - self.taken * self.dt
        moved = np.where(
            constrained, system.conditions.supports.at(time, self.u) - self.u, lag * self.v
        )
        at = system.evaluate(self.u + moved, time, CentralDifference(self.v))
        residual = at.residual - self.force
        acceleration = self._accelerate(self.v, residual, time, 1.0, self.u + moved)
        residual = self._gathered(at, residual, acceleration)
        given_v, given_a = system.conditions.supports.rates(time, self.dt)
        # The velocity of the middle of the increment is `v`.
        velocity = self.v + (lag - 0.5 * self.dt) * acceleration
        state.u, state.v = self.u + moved, np.where(constrained, given_v, velocity)
        state.at = replace(at, internal=at.internal - self.force)
        state.a = np.where(constrained, given_a, acceleration)
        state.reaction = np.where(constrained, residual + self.mass * given_a, 0.0)
        state.step_time, state.loop = time, None
        account.kinetic = 0.5 * float(state.v @ (self.mass * state.v))
        account.add_work(moved, at.external, residual)
        account.internal += float(0.5 * (self.at.internal + at.internal) @ moved)
        scalars = {
            "between increments": 1.0,
            "dt": lag,
            "iterations": 1.0,
            "external work": account.work,
            "kinetic energy": account.kinetic,
            **momenta(system, self.mass, state.u, state.v),
        }
        self.save(state, self.taken + 1, time / self.step.period, scalars)
        vars(state).update(kept)
        account.kinetic, account.work, account.internal = sums
        account.drive(self.at.external, self.at.residual - self.force)

    def _accelerate(
        self, v: Floats, residual: Floats, time: float, share: float, u: Floats | None = None
    ) -> Floats:
        """Acceleration at a state that changes the velocity `v` over a share of an increment."""
        dt = self.dt
        at = self.u if u is None else u
        return self.moved.accelerate(at, v, residual, share * dt, dt, self._driven(time))

    def _gathered(self, at: Evaluation, residual: Floats, a: Floats) -> Floats:
        """Residual with what dependent dofs, and their inertia, pass on to their masters."""
        dependent = self.system.constraints.dependent
        if not len(dependent):
            return residual
        inertia = np.zeros_like(residual)
        inertia[dependent] = self.mass[dependent] * a[dependent]
        return at.link.gather(residual + inertia)

    def _driven(self, time: float) -> Floats:
        """Moves of supports in the increment that begins at a step time, shape (n_dofs,)."""
        supports, dt = self.system.conditions.supports, self.dt
        if time < self.step.period - 0.5 * dt:
            ahead: Floats = supports.at(time + dt, self.u) - self.u
            return ahead
        return dt * supports.rates(time, dt)[0]

    def _contact(
        self, du: Floats, before: Floats, free: Floats, share: float, time: float
    ) -> Floats:
        """Contact forces at a state, shape (n_dofs,).

        Parameters
        ----------
        du : ndarray, shape (n_dofs,)
            Increment that ended there.
        before, free : ndarray, shape (n_dofs,)
            Velocity before the state, and behind it without contact.
        share : float
            Of an increment that forces act over.
        time : float
            Step time.
        """
        system, dt = self.system, self.dt
        driven = self._driven(time)
        held = self.moved.follow(driven, self.u)
        ahead = np.where(held, driven, dt * free)
        inverse = self.moved.inverse
        force = self.contact.act(self.u, du, ahead, dt * before, share, inverse, time)
        if self.idle.any():
            pushed = self.idle & (np.abs(force) > BALANCED * np.abs(force).max())
            _refuse_idle(system, pushed, "has a contact force on it but no mass")
        return force

    def tell_of_impacts(self) -> None:
        """Note what impacts have cost, where that is much."""
        account = self.account
        if account.impact is not None and -account.impact > LARGE_ERROR * account.largest:
            self.state.notes.append(
                f"impacts have dissipated {-account.impact / account.largest:.1%} of the largest "
                "energy (ALLPW): in central differences nodes in contact stop at once and lose "
                "their kinetic energy; finer meshes lose less"
            )


class Envelope:
    """Smallest and largest values of the increments between two frames."""

    def __init__(self, system: System) -> None:
        self.columns = [np.flatnonzero(system.component == i) for i in (0, 1)]
        self.turned = system.constraints.to_global
        self.clear()

    def clear(self) -> None:
        """Begin another interval."""
        self.low: list[Floats] = []
        self.high: list[Floats] = []
        self.totals: list[list[float]] = []

    def add(self, u: Floats, v: Floats, external: Floats, reaction: Floats) -> None:
        """Take an increment: displacement, velocity, loads and reactions, shape (n_dofs,)."""
        u, v, external, reaction = map(self.turned, (u, v, external, reaction))
        if self.low:
            for low, high, values in zip(self.low, self.high, (u, v), strict=True):
                np.minimum(low, values, out=low)
                np.maximum(high, values, out=high)
        else:
            self.low, self.high = [u.copy(), v.copy()], [u.copy(), v.copy()]
        self.totals.append([float(f[c].sum()) for f in (external, reaction) for c in self.columns])

    def scalars(self) -> dict[str, float]:
        """Extremes by the names of scalars of frames."""
        found: dict[str, float] = {}
        for name, low, high in zip("UV", self.low, self.high, strict=True):
            for i, column in enumerate(self.columns, start=1):
                found[f"smallest {name}{i}"] = float(low[column].min(initial=0.0))
                found[f"largest {name}{i}"] = float(high[column].max(initial=0.0))
        totals = np.array(self.totals)
        for i, name in enumerate(("F1", "F2", "RF1", "RF2")):
            found[f"smallest total {name}"] = float(totals[:, i].min())
            found[f"largest total {name}"] = float(totals[:, i].max())
        return found


def momenta(system: System, mass: Floats, u: Floats, v: Floats) -> dict[str, float]:
    """Linear momenta, and the angular one about the origin at current positions."""
    u, v = (system.constraints.to_global(part) for part in (u, v))
    component, push = system.component, mass * v
    at = system.model.mesh.points[system.node_of_dof]
    moved = np.zeros((system.model.mesh.n_nodes, 2))
    for i in (0, 1):
        own = component == i
        moved[system.node_of_dof[own], i] = u[own]
    place = at + moved[system.node_of_dof]
    x, y, turn = (component == i for i in (0, 1, 2))
    return {
        "momentum x": float(push[x].sum()),
        "momentum y": float(push[y].sum()),
        "angular momentum": float(place[y, 0] @ push[y] - place[x, 1] @ push[x] + push[turn].sum()),
    }


def peak_times(loop: IncrementLoop, step: Dynamic) -> list[float]:
    """Step times of the peaks of the amplitudes that loads and supports of a step name."""
    model = loop.system.model
    items = (*model.loads, *model.supports, *step.loads, *step.supports)
    named = {item.amplitude for item in items}
    found: list[float] = []
    for name in named - {""}:
        table = model.amplitudes[name]
        shift = loop.state.time if table.total_time else 0.0
        rise = np.sign(np.diff(table.value))
        peaks = np.flatnonzero(rise[:-1] != rise[1:]) + 1
        found += (table.time[peaks] - shift).tolist()
    inside = [t for t in found if 0.0 < t < step.period]
    return inside if len(inside) <= FRAMES else []


class Known:
    """Energy that a motion can have: what it started with, what was put in and set free.

    Parameters
    ----------
    mass : ndarray, shape (n_dofs,)
    first : float
        Kinetic energy at the start [force*length].
    dt : float
        Increment [time].
    """

    def __init__(self, system: System, mass: Floats, first: float, dt: float) -> None:
        # A body at rest has no energy to compare with but that of rounded displacements.
        speed = ROUND_OFF * np.where(system.is_rotation, 1.0, system.length) / dt
        self.first = first + 0.5 * float(mass @ speed**2)
        self.worked = self.freed = 0.0

    def energy(self, worked: float, internal: float, pending: float) -> float:
        """Energy after an increment [force*length].

        Parameters
        ----------
        worked : float
            Work of loads and supports in the increment.
        internal : float
            Internal work since the start; what was stored before makes it negative.
        pending : float
            Work of the next increment: kinetic energy is ahead of the work by half of one.
        """
        self.worked += abs(worked)
        self.freed = max(self.freed, -internal)
        return self.first + self.worked + self.freed + abs(pending)


def _refuse_pushed(system: System, idle: Bools, at: Evaluation) -> None:
    """Refuse forces at free dofs without mass, which would follow at once."""
    if idle.any():
        largest = max(float(at.scale.max()), float(np.abs(at.external).max()))
        pushed = idle & (np.abs(at.residual) > BALANCED * largest)
        _refuse_idle(system, pushed, "has a force on it but no mass")

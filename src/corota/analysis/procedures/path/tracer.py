"""Following an equilibrium path: predictor, size of increments, ends, critical points.

An increment starts along the tangent of the path and is closed by a control. Its size adapts
to the iterations it takes and to the angle by which the path turns, so that sharp turns are
followed and no other path is entered by mistake. Nothing is committed before an increment
is accepted: a cut-back forgets the attempt.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from abc import ABC, abstractmethod
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from corota.analysis.path_system import Metric, PathSystem, Point, Tangent
from corota.analysis.procedures.path.controls import Arc, Control, Factor, Plane, Row
from corota.analysis.procedures.path.corrector import STILL, Corrected, correct, tangent_at
from corota.analysis.procedures.path.kinks import direction, sense_behind, shares
from corota.analysis.procedures.path.plan import End, Increment, PathStalled, Plan
from corota.analysis.procedures.path.stability import (
    Critical,
    Station,
    has_event,
    limit_behind,
    locate,
    turned,
)
from corota.errors import SingularError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from corota.analysis.newton import ResidualNorms, Settings
    from corota.arrays import Floats

    Report = Callable[[int, int, ResidualNorms, float, float, float], None]

#: Iterations that an increment should take ...
DESIRED = 5
#: ... and the angle by which the path should turn over it [rad].
TURN = 0.35
#: An increment over which the path turns by more is solved again, shorter [rad].
MAX_TURN = 1.05
#: Bounds on the change of size from one increment to the next.
SHRINK, GROW = 0.5, 2.0
#: Share to which a failed attempt is cut.
CUT = 0.4
#: Residual above which a start is out of balance.
UNBALANCED = 1e-6
#: Least part of a direction in the mean of two, of which the sharpest kink has none.
MIN_BISECTOR = 0.02
#: Share of an increment that its end may lie beside the chord.
MAX_CHORD_OFFSET = 0.5
#: Share of an increment with a kink that may lie beside the directions before and behind ...
MAX_KINK_OFFSET = 0.3
#: ... and attempts after which such a turn is taken as it is.
KINK = 3
#: Attempts at an increment before the path is given up ...
MAX_ATTEMPTS = 16
#: ... and the attempt from which a single displacement replaces the arc.
OTHER_CONTROL = 6

#: Growth of the load's way that counts: roundings are below it, hardening and geometry above.
FLAT = 1e-6
#: Part of an amplitude that must be left at the end of the path, or it is another path's.
LEFT = 0.05


class PathTracer(ABC):
    """A path from a starting point; iterate to get its increments.

    Parameters
    ----------
    start : Point
        Committed equilibrium.
    period : float
        Step time of load factor one [time].
    settings : Settings
        Of Newton's method.
    report : callable, optional
        Called with attempt, iteration, residual norms, largest correction, load factor and size.
    cut_back : callable, optional
        Called with attempt, reason and the next size.
    """

    def __init__(
        self,
        system: PathSystem,
        start: Point,
        period: float,
        settings: Settings,
        plan: Plan,
        report: Report | None = None,
        cut_back: Callable[[int, str, float], None] | None = None,
    ) -> None:
        self.system, self.period, self.settings, self.plan = system, period, settings, plan
        self.report, self.cut_back = report, cut_back
        self.base = start
        self.size = plan.first
        self.attempt = 1
        self.iterations = 0
        self.started = self.switched = self.landed = False
        self.metric: Metric
        self.first_metric: Metric
        self.tangent: Tangent
        #: Tangent against which events are found: behind a critical point, not at it.
        self.mark: Tangent
        self.guess: Point | None = None
        #: Where the branch that is followed began.
        self.origin: Point | None = None
        #: Predicted point behind kinks, and the direction there.
        self.aim: tuple[Point, Tangent] | None = None
        #: Ways of displacements and load factor so far.
        self.way = (0.0, 0.0)
        #: The same when the load changed last.
        self.risen = (0.0, 0.0)
        #: Increments so far; whether the start is found, and whether increments follow a tangent.
        self.count, self.begun, self.going = 0, False, False
        #: The bifurcation point from which the next increment takes another branch.
        self.crossing: Critical | None = None
        #: How often the path turned too much since an increment was taken at once.
        self.sharp = 0
        #: Direction behind a corner of a law in the increment.
        self.corner: Tangent | None = None
        self._evaluated: Point | None = None

    def __iter__(self) -> Iterator[Increment]:
        # The generator may be begun again after any increment: where it stands are attributes.
        if not self.begun:
            for begun in self._begin():
                self.count, self.begun = self.count + 1, True
                yield begun
            self.begun = True
        if not self.going:
            self._set_off()
        while True:
            self.count += 1
            crossing, self.crossing = self.crossing, None
            if crossing is not None:
                found = self.take_branch(crossing)
            else:
                before = self.base
                found = self._increment()
                if self.origin is not None and returned(self, before, self.base, self.origin):
                    found.closed = True
            if self._ends_after(found, self.count):
                found.last = True
            critical = found.critical
            bifurcation = critical is not None and critical.kind == "bifurcation"
            if crossing is None and bifurcation and self.plan.switch and not self.switched:
                self.switched, self.crossing = not found.last, critical
            yield found
            if found.last:
                return

    @abstractmethod
    def take_branch(self, critical: Critical) -> Increment:
        """The first increment on another branch."""

    def next(self) -> Increment:
        """The next increment; the one before was not the last."""
        return next(iter(self))

    def _set_off(self) -> None:
        """Size and sense of the first increment along the tangent."""
        self.first_metric = self.metric
        if self.base.factor != 0.0:
            # The load has come this far already: its way is measured from its start.
            self.way = (self.metric.displacement(self.base.u), abs(self.base.factor))
        else:
            self.way = (self.metric.length * self.size, self.size)
        self._measure(0.0, 0.0)
        row = self.plan.row
        if row is not None and row.of(self.tangent.u) * row.value < 0.0:
            self.tangent = self.tangent.reversed()
        self.mark = self.tangent
        self.going = True

    # -- the start ---------------------------------------------------------------------

    def _begin(self) -> Iterator[Increment]:
        """Find the direction at the start; gives the increments that this takes.

        A start that is out of balance, as surfaces that overlap, and one where something moves
        freely, as bodies before they touch, has none before a first load has found its hold.
        """
        norms = self.system.residual_norms(self.base.evaluation, self.base.u)
        balanced = norms.size <= max(UNBALANCED, 10.0 * self.settings.tolerance)
        with suppress(SingularError):
            self.tangent, self.metric = tangent_at(self.system, self.base)
            if balanced:
                return
        end = self.plan.ends[0] if self.plan.ends else None
        up = end is None or end.row is not None or end.value > self.base.factor
        first = self.plan.first if up else -self.plan.first
        yield self._by_load([first * CUT**k for k in range(MAX_ATTEMPTS)])

    def _by_load(self, changes: list[float]) -> Increment:
        """Equilibrium at the first change of the load factor that has one, and direction there."""
        reason = ""
        for self.attempt, change in enumerate(changes, start=1):
            if reason and self.cut_back is not None:
                self.cut_back(self.attempt - 1, reason, abs(change))
            _, move = self.system.load_rate(self.base.u)
            guess = Point(self.base.u + change * move, self.base.factor + change, None)
            done = self._solve(guess, Factor(change), abs(change), loose=True)
            if done.singular is not None and done.iterations == 0:
                raise done.singular
            reason = done.reason
            if done.point is None:
                continue
            self.tangent, self.metric = tangent_at(self.system, done.point)
            du = done.point.u - self.base.u
            length = self.metric.size(du, done.point.factor - self.base.factor)
            self._commit(done.point)
            self.base = done.point
            return Increment(
                done.point,
                self.tangent,
                done.iterations,
                self.attempt,
                length,
                self.tangent.negative,
                "load",
            )
        raise PathStalled(f"no equilibrium near the start: {reason}")

    # -- one increment -----------------------------------------------------------------

    def _increment(self) -> Increment:
        self.attempt = 1
        wanted = self._wanted()
        size = wanted
        while True:
            self.corner = None
            guess, size = self._predict(size)
            control, name = self._control(guess, size)
            done = self._solve(guess, control, size)
            reason = done.reason
            if done.point is not None:
                station, reason = self._check_growth(done.point, size)
                if station is not None:
                    found = self._finish(station, done, size, name)
                    if found is not None:
                        return found
                    reason = "no solution found for the end or the critical point"
            size = self._cut(size, reason)

    def _cut(self, size: float, reason: str) -> float:
        if self.plan.fixed and self.guess is None:
            raise PathStalled(f"the increments are fixed (DIRECT) and cannot be cut; {reason}")
        self.guess = None
        size *= CUT
        if self.attempt >= MAX_ATTEMPTS:
            raise PathStalled(f"{MAX_ATTEMPTS} attempts failed; last: {reason}")
        if size < self.plan.smallest:
            raise PathStalled(f"the smallest increment {self.plan.smallest:g} failed: {reason}")
        if self.cut_back is not None:
            self.cut_back(self.attempt, reason, size)
        self.attempt += 1
        return size

    def _wanted(self) -> float:
        """Size of the next increment: that of displacement control, or the arc's."""
        row = self.plan.row
        if row is None:
            return self.size
        slope = row.of(self.tangent.u)
        if slope * row.value <= 0.0:
            return self.size
        left = self.plan.ends[0].value - row.of(self.base.u)
        step = row.value if abs(row.value) < abs(left) * (1.0 - 1e-6) else left
        wanted = step / slope
        return wanted if not self.started else min(wanted, 4.0 * self.size)

    def _predict(self, size: float) -> tuple[Point, float]:
        self.aim = None
        if self.guess is not None:
            du, df = self.guess.u - self.base.u, self.guess.factor - self.base.factor
            return self.guess, self.metric.size(du, df)
        if self.plan.row is None or self.attempt >= OTHER_CONTROL:
            self.aim = self.system.around(self.base, self.tangent, self.metric, size, self.period)
            if self.aim is not None:
                return self.aim[0], size
        u = self.base.u + size * self.tangent.u
        return Point(u, self.base.factor + size * self.tangent.factor, None), size

    def _control(
        self, guess: Point, size: float
    ) -> tuple[Control, Literal["arc", "displacement", "load"]]:
        du, df = guess.u - self.base.u, guess.factor - self.base.factor
        row = self.plan.row
        if row is not None and self.guess is None and self.attempt < OTHER_CONTROL:
            value = row.of(du)
            if value * row.value > 0.0:
                return replace(row, value=value), "displacement"
        moved = self.metric.displacement(du)
        if self.attempt >= OTHER_CONTROL or self._still(moved):
            counted = np.where(self.system.counted, np.abs(du), 0.0)
            dof = int(counted.argmax())
            if self._still(counted[dof]):
                return Factor(df), "load"
            return Row(np.array([dof]), np.ones(1), float(du[dof])), "displacement"
        # Behind a kink the structure may be so stiff that displacements alone are no measure.
        both = self.plan.spherical or self.attempt > 1 or self.aim is not None
        weight = self.metric.length if both else 0.0
        radius = math.hypot(moved, weight * df)
        return Arc(radius, self.system.counted, weight), "arc"

    def _solve(self, guess: Point, control: Control, size: float, loose: bool = False) -> Corrected:
        def report(iteration: int, norms: ResidualNorms, correction: float, factor: float) -> None:
            if self.report is not None:
                self.report(self.attempt, iteration, norms, correction, factor, size)

        done = correct(
            self.system,
            self.base,
            guess,
            self.period,
            control,
            self.settings,
            report,
            loose,
        )
        self._evaluated = done.point
        self.iterations += done.iterations
        return done

    def _check_growth(self, point: Point, size: float) -> tuple[Station | None, str]:
        """Direction at a new point, if it can be the next on this path."""
        du, df = point.u - self.base.u, point.factor - self.base.factor
        length = self.metric.size(du, df)
        try:
            aim = self.mark if self.guess is not None else self.aim and self.aim[1]
            tangent, aside = direction(
                self.system, self.metric, self.base, self.tangent, point, aim, self.attempt > KINK
            )
        except SingularError as error:
            return None, str(error)
        if self.guess is None and not self.plan.fixed and (aside is None or self.attempt <= KINK):
            turn = self._angle(tangent, du, df, length)
            if aside is not None and self.aim is not None:
                there = self.aim[0]
                aside = self.metric.size(point.u - there.u, point.factor - there.factor) / length
            if aside is not None and aside > MAX_KINK_OFFSET:
                return None, "the path has more than one kink"
            if aside is None and (turn > MAX_TURN or length > 3.0 * size):
                why = f"the path turns by {math.degrees(turn):.0f} degrees"
                self.sharp += 1
                if self.sharp <= KINK or not self.system.has_corner(self.base, point, self.period):
                    return None, why
                self.corner = sense_behind(self.metric, self.base, self.tangent, point, tangent)
                tangent, aside = direction(
                    self.system, self.metric, self.base, self.tangent, point, corner=self.corner
                )
                if aside is None or aside > MAX_KINK_OFFSET:
                    return None, why
        return Station(1.0, point, tangent, aside is not None), ""

    def _angle(self, tangent: Tangent, du: Floats, df: float, length: float) -> float:
        """Angle from the old tangent to the new one, or twice that to the chord."""
        old = self.tangent
        ends = self.metric.dot(old.u, old.factor, tangent.u, tangent.factor)
        chord = self.metric.dot(old.u, old.factor, du, df) / (length or 1.0)
        return max(_arc_cosine(ends), 2.0 * _arc_cosine(chord))

    # -- accepting ---------------------------------------------------------------------

    def _finish(
        self,
        end: Station,
        done: Corrected,
        size: float,
        name: Literal["arc", "displacement", "load"],
    ) -> Increment | None:
        """Shorten to an event or an end inside the increment, commit, and set the next size."""
        point, tangent = end.point, end.tangent
        critical: Critical | None = None
        if self.plan.locate and has_event(self.mark, tangent):
            critical = locate(
                self.system, Station(0.0, self.base, self.mark), end, *self._between(end)
            )
            self._evaluated = None  # others were tried since the point that is taken
            # A kink that seven digits do not resolve is passed all the same.
            if critical is None:
                if not (end.behind and self.attempt > KINK):
                    return None
                if turned(self.mark, tangent):
                    critical = limit_behind(self.system, self.mark, end)
            point = end.point if critical is None else critical.point
        crossed = self._crossed(point)
        if crossed is not None:
            landed = self._land(crossed, point)
            if landed is None:
                return None
            critical, (point, tangent) = None, landed
        self.landed = crossed is not None or any(self._reached(e, point) for e in self.plan.ends)
        self._commit(point)
        self.started = True
        if self.attempt == 1 or self.corner is not None:
            self.sharp = 0
        du, df = point.u - self.base.u, point.factor - self.base.factor
        length = self.first_metric.size(du, df)
        if critical is None:
            turn = self._angle(tangent, du, df, self.metric.size(du, df))
            found = Increment(
                point, tangent, done.iterations, self.attempt, length, tangent.negative, name
            )
            if self.guess is None and crossed is None:
                self._resize(size, done.iterations, turn)
            self.guess, self.tangent, self.mark = None, tangent, tangent
            self._measure(self.metric.displacement(du), abs(df))
        else:
            before = critical.negative[0]
            found = Increment(
                point,
                tangent,
                done.iterations,
                self.attempt,
                length,
                before,
                name,
                None if critical.kind == "kink" else critical,
            )
            self._go_on_behind(critical, end, size)
        self.base = point
        return found

    def _go_on_behind(self, critical: Critical, end: Station, size: float) -> None:
        """Aim at the end of the increment with the point: the tangent here is singular."""
        point, after = critical.point, critical.after
        du, df = end.point.u - point.u, end.point.factor - point.factor
        left = self.metric.size(du, df)
        self.size = min(self.size, size)
        self.mark = after.tangent
        if left > 1e-2 * size:
            self.guess = end.point
            self.tangent = Tangent(du / left, df / left, after.tangent.negative)
        else:
            self.guess, self.tangent = None, end.tangent

    def _still(self, moved: float) -> bool:
        """Whether a displacement is rounding: a fully constrained body only takes load."""
        return moved <= STILL * self.system.length

    def _resize(self, size: float, iterations: int, turn: float) -> None:
        if self.plan.fixed:
            return
        change = min(math.sqrt(DESIRED / max(iterations, 1)), TURN / max(turn, 1e-9))
        self.size = size * min(max(change, SHRINK), GROW)

    def _measure(self, moved: float, raised: float) -> None:
        """Let the way of the displacements so far count as much as that of the load factor.

        A structure that has become much softer or stiffer than it was at the start would
        otherwise show a path along one axis, on which turns cannot be seen.
        """
        if self.plan.fixed:
            return
        self.way = (self.way[0] + moved, self.way[1] + raised)
        if self.way[1] > (1.0 + FLAT) * self.risen[1]:
            self.risen = self.way
        if min(self.way) <= 0.0 or self._still(self.way[0]):
            return
        self.metric = Metric(self.metric.counted, self.way[0] / self.way[1])
        t = self.tangent
        scale = self.metric.size(t.u, t.factor)
        largest = self.plan.largest / self.first_metric.size(t.u, t.factor)
        self.size = min(self.size, largest) * scale
        self.tangent = Tangent(t.u / scale, t.factor / scale, t.negative)

    def flat(self, growth: float) -> bool:
        """Whether displacements grew by a factor since the load changed last."""
        return self.way[0] > growth * self.risen[0] > 0.0

    def _commit(self, point: Point) -> None:
        if self._evaluated is not point:
            self.system.restart()
            point.at = self.system.evaluate(point.u, point.factor * self.period)
        self.system.commit()

    def _between(
        self, end: Station
    ) -> tuple[Callable[[float], Station | None], Callable[[Station, Station], float]]:
        """Solver for points inside an increment, and where two directions cross in it.

        The way is measured by displacements or, with a kink, across it: along the mean of the
        directions before and behind, along which both increase.
        """
        metric, old, new = self.metric, self.tangent, end.tangent
        du, df = end.point.u - self.base.u, end.point.factor - self.base.factor
        mean = Tangent(old.u + new.u, old.factor + new.factor, -1)

        def part(u: Floats, f: float) -> float:
            return metric.dot(mean.u, mean.factor, u, f)

        whole, before, behind = part(du, df), part(old.u, old.factor), part(new.u, new.factor)
        kink = end.behind and min(whole, before - MIN_BISECTOR, behind - MIN_BISECTOR) > 0.0

        def place(share: float) -> tuple[Floats, float, Control]:
            if not kink and self._still(metric.displacement(du)):
                return share * du, share * df, Factor(share * df)
            if not kink:
                moved = share * metric.displacement(du)
                weight = metric.length if self.plan.spherical else 0.0
                arc = Arc(math.hypot(moved, weight * share * df), self.system.counted, weight)
                return share * du, share * df, arc
            first, _ = shares(metric, du, df, old, new)
            way, back = share * whole / before, (1.0 - share) * whole / behind
            u, f = way * old.u, way * old.factor
            if way > first:
                u, f = du - back * new.u, df - back * new.factor
            plane = Plane(u, f, mean.u, mean.factor, self.system.counted, metric.length)
            return u, f, plane

        def cross(low: Station, high: Station) -> float:
            a, b, t = low.point, high.point, low.tangent
            way, _ = shares(metric, b.u - a.u, b.factor - a.factor, t, high.tangent)
            return low.share + way * part(t.u, t.factor) / whole

        def solve(share: float) -> Station | None:
            u, f, control = place(share)
            done = self._solve(Point(self.base.u + u, self.base.factor + f, None), control, share)
            if done.singular is not None:
                raise done.singular
            if done.point is None:
                return None
            tangent, aside = direction(
                self.system,
                self.metric,
                self.base,
                self.tangent,
                done.point,
                end.tangent,
                corner=self.corner,
            )
            return Station(share, done.point, tangent, aside is not None)

        return solve, cross

    # -- ends --------------------------------------------------------------------------

    def _crossed(self, point: Point) -> End | None:
        """End that lies between the base and a point, but not at the point."""
        for end in self.plan.ends:
            before, now = end.miss(self.base), end.miss(point)
            if before * now < 0.0 and not self._reached(end, point):
                return end
        return None

    def _reached(self, end: End, point: Point) -> bool:
        scale = max(abs(end.value), abs(end.miss(self.base)), abs(end.miss(point)))
        return abs(end.miss(point)) <= 1e-9 * scale

    def _land(self, end: End, point: Point) -> tuple[Point, Tangent] | None:
        """Equilibrium exactly at an end."""
        before, now = end.miss(self.base), end.miss(point)
        share = before / (before - now)
        u = self.base.u + share * (point.u - self.base.u)
        factor = self.base.factor + share * (point.factor - self.base.factor)
        done = self._solve(Point(u, factor, None), end.control(self.base), share)
        if done.point is None:
            return None
        whole = self.metric.size(point.u - self.base.u, point.factor - self.base.factor)
        aside = self.metric.size(done.point.u - u, done.point.factor - factor)
        if aside > MAX_CHORD_OFFSET * whole:
            return None  # behind a kink the path passes the same end once more
        found, _ = self._check_growth(done.point, self.size)
        return None if found is None else (found.point, found.tangent)

    def _ends_after(self, found: Increment, count: int) -> bool:
        at_limit = found.critical is not None and found.critical.kind == "limit"
        return (
            self.landed
            or (self.plan.increments > 0 and count >= self.plan.increments)
            or (self.plan.stop_at_limit and at_limit)
        )


def returned(tracer: PathTracer, before: Point, now: Point, origin: Point) -> bool:
    """Whether an increment on a branch passes the point at which the branch began."""
    metric = tracer.metric
    du, df = now.u - before.u, now.factor - before.factor
    way = metric.dot(du, df, du, df)
    ou, of = origin.u - before.u, origin.factor - before.factor
    share = metric.dot(ou, of, du, df) / way if way else -1.0
    if not 0.0 <= share <= 1.0:
        return False
    return bool(metric.size(ou - share * du, of - share * df) <= LEFT * np.sqrt(way))


def _arc_cosine(x: float) -> float:
    return math.acos(min(max(x, -1.0), 1.0))

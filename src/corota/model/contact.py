"""Contact pairs, rigid curves, pressure laws and ties as plain data."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

import corota._core as _core
from corota.display import Brief
from corota.errors import InputError, Location, number
from corota.model.friction import MOST_FRICTION, Friction, coefficients, described, largest
from corota.names import choose_attribute
from corota.renamed import accept_old_names

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.mesh.data import Mesh

    Reference = int | str | tuple[float, float] | None

#: Half the length of the line of a gap element, in sizes of the model: sideways nothing ends it.
FAR = 10.0
#: Treatment of overlaps and gaps at the start.
STARTS = ("keep", "adjust", "ramp")
#: Facts of the discretizations of contact that the core knows, by their names.
METHODS: dict[str, dict[str, Any]] = {
    facts["name"]: facts for facts in _core.contact_methods() if not facts["joins"]
}


@dataclass(repr=False)
class RigidCurve(Brief):
    """A rigid curve of straight lines and arcs; the deformable body lies to its left.

    Its outward normal, from the rigid body towards the deformable one, points to the left of the
    direction of travel, in Python as in decks.

    Parameters
    ----------
    segments : ndarray, shape (n, 7)
        Rows x0, y0, x1, y1, cx, cy, sweep in the reference configuration: a straight line from
        (x0, y0) to (x1, y1) where sweep is 0, else an arc about (cx, cy) from (x0, y0) through
        the angle sweep [rad], counter-clockwise if positive.
    reference : int, str, tuple of float or None
        Node that carries the curve, by its index or the name of a set that has it alone: it can be
        moved, rotated, loaded or fixed like any node; its reaction is that of the curve. A point,
        or None: the curve is fixed.
    turns : bool
        Whether the curve turns with its node. Otherwise it moves along with it only, and the node
        needs no rotation.
    """

    segments: Floats
    reference: Reference = None
    name: str = ""
    turns: bool = field(default=True, kw_only=True)

    def __post_init__(self) -> None:
        self.segments = np.asarray(self.segments, dtype=np.float64).reshape(-1, 7)
        if not len(self.segments) or not np.isfinite(self.segments).all():
            raise InputError("a rigid curve needs one segment at least, with finite numbers")
        flat = self.segments[:, 6] == 0.0
        length = np.where(
            flat,
            np.hypot(*(self.segments[:, 2:4] - self.segments[:, :2]).T),
            np.hypot(*(self.segments[:, :2] - self.segments[:, 4:6]).T),
        )
        if (length <= 0.0).any():
            at = int(np.argmin(length))
            raise InputError(f"segment {at + 1} of the rigid curve has no length")
        if (np.abs(self.segments[:, 6]) > 2.0 * math.pi * (1.0 + 1e-12)).any():
            raise InputError("an arc of a rigid curve turns by at most one full circle")

    @classmethod
    def line(
        cls, start: Sequence[float], end: Sequence[float], reference: Reference = None
    ) -> RigidCurve:
        """A straight line; the deformable body is on the left when going from start to end."""
        return cls.polyline([start, end], reference=reference)

    @classmethod
    @accept_old_names(centre="center")
    def circle(
        cls,
        center: Sequence[float],
        radius: float,
        *,
        inside: bool = False,
        reference: Reference = None,
    ) -> RigidCurve:
        """A disc, or with `inside` a round hole that contains the deformable body."""
        return cls.arc(center, radius, 0.0, 360.0 if inside else -360.0, reference=reference)

    @classmethod
    @accept_old_names(centre="center")
    def arc(
        cls,
        center: Sequence[float],
        radius: float,
        start: float,
        sweep: float,
        reference: Reference = None,
    ) -> RigidCurve:
        """An arc from the angle `start` through `sweep`, both in degrees.

        Clockwise (sweep < 0) the rigid body is the disc, counter-clockwise it lies outside.
        """
        number(radius, "the radius of an arc", above=0.0)
        if sweep == 0.0:
            raise InputError("the sweep of an arc must not be 0")
        a, turn = math.radians(start), math.radians(sweep)
        (cx, cy), end = center, a + turn
        first = (cx + radius * math.cos(a), cy + radius * math.sin(a))
        last = (cx + radius * math.cos(end), cy + radius * math.sin(end))
        return cls(np.array([[*first, *last, cx, cy, turn]]), reference)

    @classmethod
    def polyline(
        cls,
        points: ArrayLike,
        *,
        closed: bool = False,
        fillet: float = 0.0,
        reference: Reference = None,
    ) -> RigidCurve:
        """Straight lines through points, the corners rounded with the radius `fillet`.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            In the order that has the deformable body on the left: clockwise round a rigid body,
            counter-clockwise round a hole; over a floor from left to right.
        closed : bool
            Join the last point with the first.
        fillet : float
            Radius of the corners [length]; 0 leaves them sharp.
        """
        p = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        if len(p) < 2 + closed:
            raise InputError(f"a polyline needs {2 + closed} points at least, not {len(p)}")
        n = len(p)
        before, after = p.copy(), p.copy()  # ends of the straight parts at each corner
        arcs: dict[int, list[float]] = {}
        for i in range(n) if closed else range(1, n - 1):
            if fillet <= 0.0:
                break
            a, b = p[i] - p[i - 1], p[(i + 1) % n] - p[i]
            la, lb = np.hypot(*a), np.hypot(*b)
            a, b = a / la, b / lb
            turn = math.atan2(a[0] * b[1] - a[1] * b[0], float(a @ b))
            if abs(turn) < 1e-9:
                continue
            cut = fillet * math.tan(0.5 * abs(turn))
            if cut > 0.5 * min(la, lb) * (1.0 + 1e-9):
                raise InputError(
                    f"the fillet {fillet:g} does not fit at point {i + 1} of the polyline; take "
                    f"at most {0.5 * min(la, lb) / math.tan(0.5 * abs(turn)):.4g} there"
                )
            before[i], after[i] = p[i] - cut * a, p[i] + cut * b
            side = math.copysign(1.0, turn)
            c = before[i] + side * fillet * np.array([-a[1], a[0]])
            arcs[i] = [*before[i], *after[i], *c, turn]
        rows: list[list[float]] = []
        for i in range(n if closed else n - 1):
            j = (i + 1) % n
            left = np.hypot(*(before[j] - after[i]))
            if not arcs or left > 1e-12 * np.hypot(*(p[j] - p[i])):
                rows.append([*after[i], *before[j], 0.0, 0.0, 0.0])
            if j in arcs:
                rows.append(arcs[j])
        return cls(np.array(rows), reference)

    @property
    def turning_node(self) -> int | None:
        """The node that moves and turns the curve, if there is one."""
        carries = self.turns and isinstance(self.reference, int | np.integer)
        return int(self.reference) if carries else None  # type: ignore[arg-type]

    @property
    def backward(self) -> Floats:
        """The segments in reverse order, the rigid body on the left, shape (n, 7)."""
        back: Floats = self.segments[::-1].copy()
        back[:, :2], back[:, 2:4] = self.segments[::-1, 2:4], self.segments[::-1, :2]
        back[:, 6] *= -1.0
        return back


@dataclass(repr=False)
class PressureLaw(Brief):
    """Pressure [force/length^2] against overclosure [length], in place of hard contact.

    Parameters
    ----------
    kind : str
        Law of the core. ``linear``: ``pressure[0]`` is the stiffness [force/length^3];
        ``exponential``: the pressure begins at the clearance ``overclosure[0]`` = c and is
        ``pressure[0]`` = p0 at zero, p = p0 / (e - 1) (w/c + 1) (exp(w/c + 1) - 1) at the
        overclosure w; ``tabular``: straight between points, beyond the last one with the last
        slope.
    pressure, overclosure : ndarray, shape (n,)
    """

    kind: str
    pressure: Floats
    overclosure: Floats = field(default_factory=lambda: np.zeros(1))
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        p = self.pressure = np.atleast_1d(np.asarray(self.pressure, np.float64))
        w = self.overclosure = np.atleast_1d(np.asarray(self.overclosure, np.float64))
        known = [name for name in _core.contact_laws()[0] if name != "hard"]
        choose_attribute(self, "kind", known, "pressure law", self.where)
        if not (np.isfinite(p).all() and np.isfinite(w).all()):
            raise InputError("the numbers of a pressure law must be finite", self.where)
        if self.kind == "tabular":
            if len(p) != len(w) or len(p) < 2 or p[0] != 0.0:
                raise InputError(
                    "a pressure table needs as many pressures as overclosures, two at least, and "
                    "begins with the pressure 0",
                    self.where,
                )
            if (np.diff(p) <= 0.0).any() or (np.diff(w) <= 0.0).any():
                raise InputError(
                    "pressures and overclosures of a table must increase strictly", self.where
                )
        elif not (p[0] > 0.0 and (self.kind == "linear" or w[0] > 0.0)):
            raise InputError("the numbers of a pressure law must be > 0", self.where)
        try:
            _core.ContactLaw(*self.constants)
        except (TypeError, ValueError) as error:
            raise InputError(f"{self.kind} pressure law: {error}", self.where) from None

    @property
    def constants(self) -> tuple[str, list[float], list[float]]:
        """Kind, pressures and overclosures, as the core takes them."""
        return self.kind, self.pressure.tolist(), self.overclosure.tolist()

    @property
    def start(self) -> float:
        """Overclosure at which the pressure begins [length]; negative before contact."""
        return _core.ContactLaw(*self.constants).start

    def __call__(self, w: Floats) -> tuple[Floats, Floats, Floats]:
        """Pressure, slope and energy per area at overclosures above the start.

        Parameters
        ----------
        w : ndarray, shape (n,)

        Returns
        -------
        pressure, slope, energy : ndarray, shape (n,)
            [force/length^2], [force/length^3], [force/length].
        """
        pressure, slope, energy = _core.ContactLaw(*self.constants).curve(np.asarray(w, float))
        return pressure, slope, energy


@accept_old_names(stabilise="stabilize", stabilise_from="stabilize_from")
@dataclass(repr=False)
class ContactPair(Brief):
    """Two surfaces, or a surface and a rigid curve, that may come into contact.

    Parameters
    ----------
    slave : str or array_like of int, shape (n, 2)
        Edge set, or pairs of cell index and local edge: the side that carries the pressures;
        the finer or softer one. Lines (trusses, beams) are edges, too: 0 forwards, 1 backwards.
        Or a node set, or indices of nodes, shape (n,).
    master : str, array_like of int or RigidCurve
        The opposite surface; the slave again for self-contact.
    method : {"mortar", "node_to_segment"}
        Gaps weighted and integrated over slave edges, or measured at slave nodes. Where a line or
        single nodes take part, they are always measured at nodes, ends and corners.
    friction : float, DecayingFriction or FrictionTable
        Coulomb coefficient from 0 to 1e6; surfaces stick with the largest. Or one that depends on
        slip rate and pressure.
    law : PressureLaw, optional
        Pressure against overclosure; without it, contact is hard.
    clearance : float, optional
        Initial gap [length], independent of the coordinates.
    start : {"keep", "adjust", "ramp"}
        Overlap of the coordinates at the start: removed in the first increment, treated as
        contact without strain, or removed over the first step.
    adjust : float
        With ``start="adjust"``: gaps up to this at the start [length] count as contact, too.
    adjust_nodes : str or array_like of int, optional
        With ``start="adjust"``: these slave nodes only, whatever their gap.
    smooth : bool
        Treat the edges of a deformable master as a curve without kinks; corners sharper
        than 50 degrees are kept.
    stabilize : bool
        Damp the two surfaces in static steps until the end of each, so that bodies without
        other supports come into contact.
    stabilize_from : int
        First step that is damped, from 1.
    reach : float
        Search distance for pairs [length]; 0 for four edges.
    name : str
    shear_limit : float, optional
        Largest shear traction of friction [force/length^2], at any pressure.
    separates : bool
        Whether surfaces that have met come apart again. If not, they slide on each other and carry
        tension; for static and implicit steps without path control.
    steps : tuple of int, optional
        Numbers of the steps in which the surfaces may meet, from 1; all by default. What they
        pressed at the end of the step before fades over the first static step without them.
    friction_steps : mapping of int to a coefficient as `friction`, optional
        Other coefficients, each from the begin of a step (its number, from 1) on.
    friction_ramps : bool
        Whether these grow from the coefficient before over a static step whose loads grow.
    images : ndarray of int, shape (k, n_nodes), optional
        The slave meets k images of the master in its place: for each node of the master the node
        that repeats it, which constraints of the model move. See :mod:`corota.cells.images`.
    """

    slave: str | Ints
    master: str | Ints | RigidCurve
    method: str = "mortar"
    friction: Friction = 0.0
    law: PressureLaw | None = None
    clearance: float | None = None
    start: Literal["keep", "adjust", "ramp"] = "keep"
    stabilize: bool = False
    reach: float = 0.0
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)
    stabilize_from: int = field(default=1, kw_only=True)
    adjust: float = field(default=0.0, kw_only=True)
    adjust_nodes: str | Ints | None = field(default=None, kw_only=True)
    smooth: bool = field(default=False, kw_only=True)
    shear_limit: float | None = field(default=None, kw_only=True)
    separates: bool = field(default=True, kw_only=True)
    steps: tuple[int, ...] | None = field(default=None, kw_only=True)
    friction_steps: Mapping[int, Friction] = field(default_factory=dict, kw_only=True)
    friction_ramps: bool = field(default=True, kw_only=True)
    images: Ints | None = field(default=None, kw_only=True, repr=False)

    def __post_init__(self) -> None:
        choose_attribute(self, "method", METHODS, "contact method", self.where)
        choose_attribute(self, "start", STARTS, "start", self.where)
        for what, value in (
            ("friction", largest(self.friction)),
            *(("friction", largest(value)) for value in self.friction_steps.values()),
            ("reach", self.reach),
            ("adjusted gap", self.adjust),
        ):
            known = isinstance(value, (int, float, np.number)) and math.isfinite(value)
            if not known or value < 0.0:
                raise InputError(f"the {what} of a contact pair must be a number >= 0", self.where)
        self.friction_steps = dict(sorted(self.friction_steps.items()))
        if self.friction_steps and min(self.friction_steps) < 1:
            raise InputError("steps of a contact pair are numbers from 1", self.where)
        if self.most_friction > MOST_FRICTION:
            raise InputError(
                f"a friction coefficient of {self.most_friction:g} is too large: for surfaces that "
                f"do not slip give at most {MOST_FRICTION:g}",
                self.where,
            )
        limit = self.shear_limit
        if limit is not None and not (0.0 < limit < math.inf and self.most_friction):
            raise InputError(
                f"the largest shear traction must be > 0 and go with friction, not {limit:g} with "
                f"{described(self.friction)}",
                self.where,
            )
        if not self.separates and self.law is not None:
            raise InputError(
                "surfaces that do not separate are in hard contact: omit the pressure law",
                self.where,
            )
        if self.steps is not None:
            self.steps = tuple(sorted({int(number) for number in self.steps}))
            if not self.steps or self.steps[0] < 1:
                raise InputError("steps of a contact pair are numbers from 1", self.where)
        if self.clearance is not None and not math.isfinite(self.clearance):
            raise InputError("the clearance of a contact pair must be finite", self.where)
        if self.smooth and (self.itself or isinstance(self.master, RigidCurve)):
            raise InputError(
                "only a master of element edges can be smoothed; give a rigid curve fillets "
                "instead, and self-contact keeps its edges",
                self.where,
            )
        if not self.name:
            self.name = f"{_called(self.slave)}-{_called(self.master)}"

    @property
    def most_friction(self) -> float:
        """Largest coefficient of all steps."""
        return max(map(largest, (self.friction, *self.friction_steps.values())))

    @property
    def varies(self) -> bool:
        """Whether its friction depends on slip rate or pressure, in some step."""
        return any(callable(mu) for mu in (self.friction, *self.friction_steps.values()))

    def friction_at(self, step: int, share: float, rate: Floats, pressure: Floats) -> Floats:
        """Coefficients of friction in a step, at a share of its change in that step.

        Parameters
        ----------
        step : int
            Its number, from 1.
        share : float
        rate, pressure : ndarray, shape (n,)
            Slip rates [length/time] and pressures [force/length^2].

        Returns
        -------
        ndarray, shape (n,)
        """
        old = [self.friction, *(mu for n, mu in self.friction_steps.items() if n < step)][-1]
        at = coefficients(old, rate, pressure)
        if step not in self.friction_steps:
            return at
        return at + share * (coefficients(self.friction_steps[step], rate, pressure) - at)

    @property
    def itself(self) -> bool:
        """Whether it is self-contact of one surface."""
        if self.images is not None or isinstance(self.master, RigidCurve):
            return False
        if isinstance(self.slave, str) != isinstance(self.master, str):
            return False
        if isinstance(self.slave, str):
            return self.slave == self.master
        return np.array_equal(self.slave, np.asarray(self.master))


def gap_element(
    points: Floats,
    nodes: tuple[int, int],
    clearance: float,
    direction: tuple[float, float],
    name: str = "gap",
    where: Location | None = None,
) -> ContactPair:
    """Contact of two nodes along a fixed direction n: ``clearance + n . (u2 - u1) >= 0``.

    The second node is in contact with a line across n that moves along with the first one.

    Parameters
    ----------
    points : ndarray, shape (n_nodes, 2)
        Reference positions [length].
    nodes : tuple of int
        Indices of the first and the second node.
    clearance : float
        Distance at the start [length]; a negative one is an overlap.
    direction : tuple of float
        From the first side to the second, of any length.

    Returns
    -------
    ContactPair
        Its force y and force x are those on the second node.

    Raises
    ------
    InputError
        If the direction has no length.
    """
    n = np.asarray(direction, float)
    if not np.hypot(*n) > 0.0:
        raise InputError("the direction of a gap has no length", where)
    n = n / np.hypot(*n)
    far = FAR * (float(np.ptp(points, axis=0).max()) + abs(clearance))
    on = points[nodes[1]] - max(clearance, 0.0) * n
    along = far * np.array([n[1], -n[0]])
    line = RigidCurve.line(on - along, on + along, reference=int(nodes[0]))
    line.turns = False
    return ContactPair(
        np.array([nodes[1]], np.int64),
        line,
        clearance=clearance if clearance < 0.0 else None,
        reach=far,
        name=name,
        where=where,
    )


def is_gap(pair: ContactPair) -> bool:
    """Whether a pair is a gap element."""
    return isinstance(pair.master, RigidCurve) and not pair.master.turns


def of_gap(points: Floats, pair: ContactPair) -> tuple[tuple[int, int], float, tuple[float, float]]:
    """Nodes, clearance and direction of a gap element: what :func:`gap_element` takes."""
    curve, second = pair.master, int(np.asarray(pair.slave)[0])
    assert isinstance(curve, RigidCurve)
    start, end = curve.segments[0, :2], curve.segments[0, 2:4]
    t = (end - start) / np.hypot(*(end - start))
    n = np.array([-t[1], t[0]])
    away = float(n @ (points[second] - start))
    first = int(curve.reference)  # type: ignore[arg-type]
    return (first, second), away if pair.clearance is None else pair.clearance, (n[0], n[1])


def edges_or_nodes(mesh: Mesh, where: str | Ints) -> tuple[Ints, Ints]:
    """Edges of a surface, shape (n, 2), or the nodes of one of single nodes, shape (m,).

    One of both is empty.
    """
    none: Ints = np.zeros(0, np.int64)
    if isinstance(where, str):
        if where not in mesh.edge_sets and where in mesh.node_sets:
            return none.reshape(0, 2), mesh.node_sets[where]
        return mesh.edge_sets[where], none
    found = np.asarray(where, np.int64)
    return (found, none) if found.ndim == 2 else (none.reshape(0, 2), found)


@dataclass(repr=False)
class Tie(Brief):
    """Two surfaces joined without common nodes.

    Parameters
    ----------
    slave, master : str or array_like of int, shape (n, 2)
    tolerance : float
        Largest distance that is tied [length]; 0 for a tenth of the longest edge. Edges
        farther apart are not tied.
    name : str
    """

    slave: str | Ints
    master: str | Ints
    tolerance: float = 0.0
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        number(self.tolerance, "the tolerance of a tie", self.where, least=0.0)
        if np.array_equal(self.slave, self.master):
            raise InputError("a surface cannot be tied to itself", self.where)
        if not self.name:
            self.name = f"{_called(self.slave)}-{_called(self.master)}"


def _called(where: object) -> str:
    if isinstance(where, RigidCurve):
        return where.name or "rigid curve"
    return where if isinstance(where, str) else "edges"


def joint_thickness(
    points: Floats, slave: Ints, thickness: Floats, master: Ints, other: Floats
) -> Floats:
    """Thickness of the joint at the slave edges: the smaller of both sides.

    The contact area, and with it the contact pressure, then does not depend on which side is
    the slave. The thickness of the other side is that of its nearest undeformed edge.

    Parameters
    ----------
    points : ndarray, shape (n_nodes, 2)
        Reference positions [length].
    slave, master : ndarray of int, shapes (n, k), (m, l)
        Nodes of the edges, both ends first.
    thickness, other : ndarray, shapes (n,), (m,)
        Of the slave's and the master's cells [length].

    Returns
    -------
    ndarray, shape (n,)
    """
    from scipy.spatial import cKDTree  # takes longer to import than a small job to solve

    ends = points[slave[:, :2]].mean(axis=1)
    nearest = cKDTree(points[master[:, :2]].mean(axis=1)).query(ends)[1]
    return np.minimum(thickness, other[nearest])

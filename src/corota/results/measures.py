"""Measures of a stage along its path: one table, one function for each measure.

A measure of a frame follows from the frames up to it, so that it is the same number in memory, in
result files and in tables, whatever comes later. Definitions are in docs/measures.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from corota.arrays import Floats

#: Rotation between two frames [rad] below which a center of rotation has no place.
LEAST_ROTATION = 1e-9
#: Share of the largest load by which a load must fall to count as a limit load.
NOISE = 1e-9
#: Condition of a stiffness from which it counts as singular.
SINGULAR = 1e14
#: Names of the three components of motion in those of matrices: along x, along y, rotation.
COMPONENTS = "xyr"


def _rows(*shape: int) -> Floats:
    return np.zeros((0, *shape))


@dataclass
class StagePath:
    """The frames of a stage so far.

    Parameters
    ----------
    direction : ndarray, shape (3,)
        Components of the wanted motion along x, along y and about z.
    reference : ndarray, shape (2,)
        Undeformed place of the reference point [length].
    input : StagePath or None
        The path of the stage that drives this one.
    motion : ndarray, shape (n_frames, 3)
        Displacement of the reference point and rotation.
    force : ndarray, shape (n_frames, 3)
        Force on the stage and its moment about the moved reference point.
    stiffness : ndarray, shape (n_frames, 3, 3)
        Tangent stiffness; NaN where it was not computed.
    compliance : ndarray, shape (n_frames, 3, 3)
        Its inverse; NaN where that is singular.
    guided : ndarray, shape (n_frames, 3, 3)
        Compliance in the motions that supports of the stage leave free, and along its axis.
    utilization : ndarray, shape (n_frames, 4)
        Largest share of an allowable that is used, and its place: element, x, y; NaN without one.
    """

    direction: Floats
    reference: Floats
    input: StagePath | None = None
    motion: Floats = field(default_factory=partial(_rows, 3))
    force: Floats = field(default_factory=partial(_rows, 3))
    stiffness: Floats = field(default_factory=partial(_rows, 3, 3))
    compliance: Floats = field(default_factory=partial(_rows, 3, 3))
    guided: Floats = field(default_factory=partial(_rows, 3, 3))
    utilization: Floats = field(default_factory=partial(_rows, 4))

    def add(
        self,
        motion: Floats,
        force: Floats,
        stiffness: Floats,
        free: Floats,
        utilization: Floats,
    ) -> None:
        """Append a frame; the rotation is continued over whole turns.

        Parameters
        ----------
        motion, force : ndarray, shape (3,)
        stiffness : ndarray, shape (3, 3)
        free : ndarray, shape (3, k)
            Columns that span the motions that supports leave free, and the axis.
        utilization : ndarray, shape (4,)
        """
        motion = motion.copy()
        if len(self.motion):
            turns = (self.motion[-1, 2] - motion[2]) / (2.0 * math.pi)
            motion[2] += 2.0 * math.pi * round(turns)
        self.motion = np.concatenate([self.motion, motion[None]])
        self.force = np.concatenate([self.force, force[None]])
        self.stiffness = np.concatenate([self.stiffness, stiffness[None]])
        self.compliance = np.concatenate([self.compliance, _inverse_of(stiffness)[None]])
        guided = free @ _inverse_of(free.T @ stiffness @ free) @ free.T
        self.guided = np.concatenate([self.guided, guided[None]])
        self.utilization = np.concatenate([self.utilization, utilization[None]])

    @property
    def turns(self) -> bool:
        """Whether the wanted motion is the rotation."""
        return bool(self.direction[2])

    @property
    def across(self) -> Floats:
        """Direction across the wanted translation, to its left, shape (3,)."""
        return np.array([-self.direction[1], self.direction[0], 0.0])

    @property
    def travel(self) -> Floats:
        """Wanted part of the motion, shape (n_frames,)."""
        return np.asarray(self.motion @ self.direction)

    @property
    def load(self) -> Floats:
        """Force along the wanted motion, or moment, shape (n_frames,)."""
        return np.asarray(self.force @ self.direction)

    @property
    def work(self) -> Floats:
        """Work of the forces on the stage by the trapezoidal rule, shape (n_frames,) [energy]."""
        mean = 0.5 * (self.force[1:] + self.force[:-1])
        parts = (mean * np.diff(self.motion, axis=0)).sum(axis=1)
        return np.concatenate([[0.0], np.cumsum(parts)])

    @property
    def place(self) -> Floats:
        """Current place of the reference point, shape (2,) [length]."""
        return np.asarray(self.reference + self.motion[-1, :2])


def _inverse_of(matrix: Floats) -> Floats:
    """Inverse of a small matrix; NaN where it is unknown or singular."""
    if not np.isfinite(matrix).all():
        return np.full_like(matrix, np.nan)
    size = np.sqrt(np.abs(np.diag(matrix)))
    # Displacements and rotations have different units.
    scale = np.where(size > 0.0, size, 1.0)
    scaled = matrix / np.outer(scale, scale)
    if not size.all() or np.linalg.cond(scaled) > SINGULAR:
        return np.full_like(matrix, np.nan)
    return np.asarray(np.linalg.inv(scaled) / np.outer(scale, scale))


# -- functions of a path: the value in its last frame, NaN where it has none ---------------


def parasitic_translation(path: StagePath) -> float:
    """Displacement across the wanted one, to its left; of a rotation the whole displacement."""
    if path.turns:
        return float(np.hypot(*path.motion[-1, :2]))
    return float(path.motion[-1] @ path.across)


def instant_center(path: StagePath) -> Floats:
    """Point of the plane that the stage turns about in the last frame, shape (2,).

    From the derivative of the displacement by the rotation over the last three frames; of the
    second frame it is the center of the finite rotation from the first.
    """
    unknown = np.full(2, math.nan)
    angle = path.motion[-3:, 2]
    if len(angle) < 2 or (np.abs(np.diff(angle)) < LEAST_ROTATION).any():
        return unknown
    if len(angle) == 2:
        change = np.diff(path.motion[-2:], axis=0)[0]
        middle = path.place - 0.5 * change[:2]
        across = np.array([-change[1], change[0]])
        return np.asarray(middle + 0.5 / math.tan(0.5 * change[2]) * across)
    first, second = angle[1] - angle[0], angle[2] - angle[1]
    if abs(first + second) < LEAST_ROTATION:
        return unknown
    early, late = np.diff(path.motion[-3:, :2], axis=0) / np.array([[first], [second]])
    rate = late + (late - early) * second / (first + second)
    return np.asarray(path.place + np.array([-rate[1], rate[0]]))


def axis_stiffness(path: StagePath) -> float:
    """Stiffness along the wanted motion: load per travel, with the supports of the stage."""
    return _inverse(float(path.direction @ path.guided[-1] @ path.direction))


def lateral_stiffness(path: StagePath) -> float:
    """Stiffness across the wanted translation, or that of the softest translation of a pivot."""
    inverse = path.guided[-1]
    if not path.turns:
        return _inverse(float(path.across @ inverse @ path.across))
    if not np.isfinite(inverse).all():
        return math.nan
    plane = inverse[:2, :2]
    return _inverse(float(np.linalg.eigvalsh(0.5 * (plane + plane.T))[-1]))


def lateral_coupling(path: StagePath) -> float:
    """Lateral motion per wanted motion under a small load along the axis."""
    column = path.guided[-1] @ path.direction
    across = np.hypot(column[0], column[1]) if path.turns else path.across @ column
    return float(across) * _inverse(float(path.direction @ column))


def rotation_coupling(path: StagePath) -> float:
    """Rotation per wanted translation under a small load along the axis."""
    column = path.guided[-1] @ path.direction
    return math.nan if path.turns else float(column[2]) * _inverse(float(path.direction @ column))


def elastic_center(path: StagePath, k: int) -> float:
    """A coordinate of the point that stays where it is under a small moment."""
    inverse = path.guided[-1]
    arm = (-inverse[1, 2], inverse[0, 2])[k] * _inverse(float(inverse[2, 2]))
    return float(path.place[k] + arm)


def _resistance(path: StagePath, way: float) -> float:
    """Largest load against the motion while the travel grows (1) or shrinks (-1)."""
    sense = way * _sense(path)
    moved = np.flatnonzero(sense * np.diff(path.travel) > 0.0) + 1
    return float((sense * path.load[moved]).max()) if len(moved) else math.nan


def return_energy(path: StagePath) -> float:
    """Work from the second stable equilibrium back to the unstable one."""
    (_, top), (_, bottom) = _zeros(path)
    return top - bottom


def transmission_ratio(path: StagePath) -> float:
    """Travel over that of the input."""
    if path.input is None or not path.input.travel[-1]:
        return math.nan
    return float(path.travel[-1] / path.input.travel[-1])


def force_ratio(path: StagePath) -> float:
    """Load that the stage gives over that of the input."""
    if path.input is None or not path.input.load[-1]:
        return math.nan
    return float(-path.load[-1] / path.input.load[-1])


def efficiency(path: StagePath) -> float:
    """Work that the stage gives over that of the input."""
    if path.input is None or not path.input.work[-1]:
        return math.nan
    return float(-path.work[-1] / path.input.work[-1])


def travel_to_allowable(path: StagePath) -> float:
    """Travel at which an allowable is reached first, linear between the frames."""
    at = _exceeded(path)
    if at < 1:
        return math.nan
    before, after = path.utilization[at - 1 : at + 1, 0]
    share = (1.0 - before) / (after - before)
    first, last = path.travel[at - 1 : at + 1]
    return float(first + share * (last - first))


def allowable_place(path: StagePath, k: int) -> float:
    """Element (1), x (2) or y (3) where an allowable is exceeded first."""
    at = _exceeded(path)
    return math.nan if at < 0 else float(path.utilization[at, k])


def _exceeded(path: StagePath) -> int:
    """First frame in which an allowable is exceeded; -1 for none."""
    over = np.flatnonzero(path.utilization[:, 0] >= 1.0)
    return int(over[0]) if len(over) else -1


def _inverse(value: float) -> float:
    return 1.0 / value if value else math.nan


def _sense(path: StagePath) -> float:
    """Sign of the first travel under load; without load, as by heat, the stage finds its place."""
    moved, loads = np.diff(path.travel), np.abs(path.load[1:])
    first = moved[
        (loads > NOISE * loads.max(initial=0.0))
        & (np.abs(moved) > NOISE * np.abs(path.travel).max(initial=0.0))
    ]
    return float(np.sign(first[0])) if len(first) else 1.0


def _limits(path: StagePath) -> tuple[tuple[float, float], tuple[float, float]]:
    """Travel and load at the first largest and the next smallest load along the path.

    From the parabola of the load over the length of the path through three frames.
    """
    unknown = (math.nan, math.nan)
    sense, loads, travels = _sense(path), path.load, path.travel
    found: list[tuple[float, float]] = []
    least = NOISE * np.abs(loads).max(initial=0.0)
    for k in range(1, len(loads) - 1):
        way = sense if not found else -sense
        before, here, after = way * loads[k - 1 : k + 2]
        if here - before > least and here - after > least and len(found) < 2:
            found.append(_vertex(travels[k - 1 : k + 2], loads[k - 1 : k + 2]))
    found += [unknown] * (2 - len(found))
    return found[0], found[1]


def _vertex(travels: Floats, loads: Floats) -> tuple[float, float]:
    """Travel and load at the extreme of a parabola through three points of a path."""
    x = travels - travels[1]
    if x[0] * x[2] >= 0.0:  # the path turns back: its travel is no parameter
        return float(travels[1]), float(loads[1])
    left, right = (loads[0] - loads[1]) / x[0], (loads[2] - loads[1]) / x[2]
    curve = (right - left) / (x[2] - x[0])
    slope = left - curve * x[0]
    at = float(np.clip(-0.5 * slope / curve, min(x[0], x[2]), max(x[0], x[2])))
    return float(travels[1] + at), float(loads[1] + slope * at + curve * at * at)


def _zeros(path: StagePath) -> tuple[tuple[float, float], tuple[float, float]]:
    """Travel and work at the unstable and at the second stable equilibrium without load."""
    unknown = (math.nan, math.nan)
    sense = _sense(path)
    loads, travels, works = sense * path.load, sense * path.travel, path.work
    found: list[tuple[float, float]] = []
    for k in range(1, len(loads)):
        way = 1.0 if not found else -1.0
        if way * loads[k - 1] > 0.0 >= way * loads[k] and len(found) < 2:
            part = (travels[k] - travels[k - 1]) * loads[k - 1] / (loads[k - 1] - loads[k])
            found.append(
                (
                    float(sense * (travels[k - 1] + part)),
                    float(works[k - 1] + 0.5 * part * loads[k - 1]),
                )
            )
    found += [unknown] * (2 - len(found))
    return found[0], found[1]


# -- the table ---------------------------------------------------------------------------


@dataclass(frozen=True)
class StageMeasure:
    """A measure of a stage.

    Parameters
    ----------
    value : callable
        ``value(path)`` is the number of the last frame, NaN where there is none.
    meaning : str
    dimension : str
        Such as ``force/length``; empty for a number, and where it depends on the axis.
    """

    value: Callable[[StagePath], float]
    meaning: str
    dimension: str = ""


def _matrix(
    name: str, value: Callable[..., float], meaning: str, dimensions: str
) -> dict[str, StageMeasure]:
    """The nine entries of a matrix; `dimensions`: of displacements, mixed, of the rotation."""
    shared = dimensions.split()
    return {
        f"{name} {a}{b}": StageMeasure(
            partial(value, i=i, j=j), f"{meaning}, {a} by {b}", shared[(i == 2) + (j == 2)]
        )
        for i, a in enumerate(COMPONENTS)
        for j, b in enumerate(COMPONENTS)
    }


def _each(
    value: Callable[..., float], *rows: tuple[str, str, str], first: int = 0
) -> dict[str, StageMeasure]:
    """Measures of one function by the number `k` of a column."""
    return {
        name: StageMeasure(partial(value, k=k), meaning, dimension)
        for k, (name, meaning, dimension) in enumerate(rows, start=first)
    }


#: Every measure by its name; see docs/measures.md for the definitions.
MEASURES: dict[str, StageMeasure] = {
    **_each(
        lambda path, k: path.motion[-1, k],
        ("motion x", "displacement of the reference point along x", "length"),
        ("motion y", "displacement of the reference point along y", "length"),
        ("rotation", "rotation of the stage, whole turns counted", "rad"),
    ),
    **_each(
        lambda path, k: path.place[k],
        ("place x", "current place of the reference point", "length"),
        ("place y", "current place of the reference point", "length"),
    ),
    "travel": StageMeasure(
        lambda path: path.travel[-1], "wanted part of the motion: length, or rad"
    ),
    "parasitic translation": StageMeasure(
        parasitic_translation, "displacement across the travel; all of it for a rotation", "length"
    ),
    "parasitic rotation": StageMeasure(
        lambda path: math.nan if path.turns else path.motion[-1, 2],
        "rotation beside a translation",
        "rad",
    ),
    **_each(
        lambda path, k: float(instant_center(path)[k]),
        ("instant center x", "point that the stage turns about", "length"),
        ("instant center y", "point that the stage turns about", "length"),
    ),
    "center shift": StageMeasure(
        lambda path: np.hypot(*(instant_center(path) - path.reference)),
        "distance of the instant center from the undeformed reference",
        "length",
    ),
    **_each(
        lambda path, k: path.force[-1, k],
        ("force x", "force on the stage along x", "force"),
        ("force y", "force on the stage along y", "force"),
        ("moment", "moment on the stage about the moved reference point", "force*length"),
    ),
    "load": StageMeasure(lambda path: path.load[-1], "force along the travel, or moment"),
    **_matrix(
        "stiffness",
        lambda path, i, j: path.stiffness[-1, i, j],
        "tangent stiffness",
        "force/length force/rad force*length/rad",
    ),
    **_matrix(
        "compliance",
        lambda path, i, j: path.compliance[-1, i, j],
        "tangent compliance",
        "length/force rad/force rad/force/length",
    ),
    "axis stiffness": StageMeasure(axis_stiffness, "load per travel"),
    "lateral stiffness": StageMeasure(
        lateral_stiffness, "force per displacement across, other motion free", "force/length"
    ),
    "stiffness ratio": StageMeasure(
        lambda path: lateral_stiffness(path) * _inverse(axis_stiffness(path)),
        "lateral over axis stiffness",
    ),
    "lateral coupling": StageMeasure(lateral_coupling, "displacement across per travel"),
    "rotation coupling": StageMeasure(rotation_coupling, "rotation per travel", "rad/length"),
    **_each(
        elastic_center,
        ("elastic center x", "point at rest under a small moment", "length"),
        ("elastic center y", "point at rest under a small moment", "length"),
    ),
    "work": StageMeasure(lambda path: path.work[-1], "work of the forces on the stage", "energy"),
    "largest load": StageMeasure(lambda path: path.load.max(), "largest load so far"),
    "smallest load": StageMeasure(lambda path: path.load.min(), "smallest load so far"),
    "insertion load": StageMeasure(
        partial(_resistance, way=1.0), "largest resistance while the travel grows"
    ),
    "retention load": StageMeasure(
        partial(_resistance, way=-1.0), "largest resistance while it shrinks"
    ),
    **_each(
        lambda path, k: _limits(path)[0][k],
        ("snap travel", "travel at the first limit load", ""),
        ("snap load", "first limit load", ""),
    ),
    **_each(
        lambda path, k: _limits(path)[1][k],
        ("return travel", "travel at the limit load of the way back", ""),
        ("return load", "limit load of the way back", ""),
    ),
    "switching travel": StageMeasure(
        lambda path: _zeros(path)[0][0], "travel of the unstable equilibrium"
    ),
    "switching energy": StageMeasure(lambda path: _zeros(path)[0][1], "work up to it", "energy"),
    "second equilibrium": StageMeasure(
        lambda path: _zeros(path)[1][0], "travel of the second stable one"
    ),
    "return energy": StageMeasure(return_energy, "work from there back to the unstable", "energy"),
    "transmission ratio": StageMeasure(transmission_ratio, "travel over that of the input"),
    "force ratio": StageMeasure(force_ratio, "load that it gives over that of the input"),
    "efficiency": StageMeasure(efficiency, "work that it gives over that of the input"),
    **_each(
        lambda path, k: path.utilization[-1, k],
        ("utilization", "largest share of an allowable that is used", ""),
        ("utilization element", "its element", ""),
        ("utilization x", "its current place", "length"),
        ("utilization y", "its current place", "length"),
    ),
    "safety factor": StageMeasure(
        lambda path: _inverse(path.utilization[-1, 0]), "allowable over what is used"
    ),
    "travel to allowable": StageMeasure(travel_to_allowable, "travel at which one is reached"),
    **_each(
        allowable_place,
        ("allowable element", "element where it is reached first", ""),
        ("allowable x", "current place where it is reached first", "length"),
        ("allowable y", "current place where it is reached first", "length"),
        first=1,
    ),
}


def measure_values(path: StagePath) -> dict[str, float]:
    """All measures of the last frame that have a value."""
    found = {name: float(measure.value(path)) for name, measure in MEASURES.items()}
    return {name: value for name, value in found.items() if math.isfinite(value)}


def stage_measure(scalar: str) -> str:
    """Name of the measure of a scalar of frames such as ``hub: travel``; empty for others.

    Examples
    --------
    >>> stage_measure("hub: travel"), stage_measure("hub: area")
    ('travel', '')
    """
    _, colon, name = scalar.rpartition(": ")
    return name if colon and name in MEASURES else ""


def table() -> list[str]:
    """The table of the documents: name, meaning, dimension."""
    rows = ["| measure | meaning | dimension |", "| --- | --- | --- |"]
    return rows + [f"| `{name}` | {m.meaning} | {m.dimension} |" for name, m in MEASURES.items()]

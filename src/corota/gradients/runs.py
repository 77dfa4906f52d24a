"""Gradients of measures of a run, and a function that optimizers call for value and gradient."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.analysis.run import keep_nlgeom, solve
from corota.errors import InputError, UnsupportedError
from corota.gradients.adjoint import Adjoint, Field, FieldSums, adjoints, control_row
from corota.gradients.differences import derivative, step_between_kinks
from corota.gradients.measures import Measure, SpecialMeasure, combine, leaves
from corota.gradients.parameters import Parameter
from corota.gradients.sides import one_sided as limit
from corota.gradients.sides import require_side
from corota.gradients.store import HistoryStore
from corota.gradients.trajectory import Increment, Point, Trajectory, increments_of
from corota.model.paths import DisplacementControl
from corota.model.steps import Static, Step, listed_steps

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.gradients.sides import Side
    from corota.model.model import Model
    from corota.results.results import Results


#: Change of a force that symmetry excludes, over the forces it is made of.
SYMMETRY = 1e-7
#: Least size of a sum of forces, over the largest of them.
FORCE_FLOOR = 1e-8
#: Share of the largest force whose rounding, by `differences.ROUNDING`, is that of every force.
ROUNDED = 1e-3
#: Relative difference of the results of second and fourth order that shows a kink.
KINK = 1e-4


def gradient(
    results: Results,
    measure: Measure | Sequence[Measure],
    wrt: Parameter | Field | Sequence[Parameter | Field],
    *,
    memory: float | None = None,
    one_sided: Side | None = None,
) -> Any:
    """Gradient of measures of a run by parameters of its model, by the adjoint method.

    One linear system is solved for each measure; of materials with history one for each measure
    and increment. The states are those of the run: nothing is solved again.

    Parameters
    ----------
    results : Results
        Of static steps, with the frames of all increments.
    measure : Measure or sequence of Measure
    wrt : Parameter, Field or sequence of these
        See :mod:`corota.gradients.parameters`.
    memory : float, optional
        Memory for the histories of all increments and their adjoint states [MB]; what does not fit
        goes to a temporary file, with the same gradient to the bit. By default all is in memory.

    Returns
    -------
    ndarray, or list of ndarray
        By parameter of `wrt`, in the shape of its values, with a leading axis for several
        measures.

    Raises
    ------
    UnsupportedError
        If the model or a measure has a feature whose derivative is not included.

    Examples
    --------
    >>> import corota as ct
    >>> from corota import gradients
    >>> model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    >>> model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    >>> model.fix("left")
    >>> model.force("right", y=-0.2)
    >>> results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    >>> tip = gradients.Displacement("right", "y")
    >>> by_modulus = ct.gradient(results, tip, gradients.Constant("E"))
    >>> bool(abs(by_modulus * 1000.0 / -results.history("U2", at="right")[-1] - 1.0) < 1e-9)
    True
    """
    measures = [measure] if isinstance(measure, Measure) else list(measure)
    wanted = [wrt] if isinstance(wrt, (Parameter, Field)) else list(wrt)
    require_side(one_sided)
    if one_sided is None:
        fields = [each for each in wanted if isinstance(each, Field)]
        run = Run(results, measures, memory=memory, fields=fields)
        found = [run.by(parameter) for parameter in wanted]
    else:
        found = [_beside(results, measures, each, one_sided, memory) for each in wanted]
    if isinstance(measure, Measure):
        found = [each[0] for each in found]
    return found[0] if isinstance(wrt, (Parameter, Field)) else found


def _beside(
    results: Results,
    measures: Sequence[Measure],
    parameter: Parameter | Field,
    side: Side,
    memory: float | None,
) -> Floats:
    """One-sided gradient of all measures by a parameter, shape (n_measures, ...)."""
    if isinstance(parameter, Field):
        raise UnsupportedError(
            f"{type(parameter).__name__} has no one-sided gradient, which takes analyses for each "
            "number; take gradients.Shape or Attribute"
        )
    base, steps = results.model, results.steps
    threads = int(results.info.get("threads", 1))
    shape = np.shape(parameter.values(base))
    sizes = np.broadcast_to(parameter.sizes(base), int(np.prod(shape)))
    values = Run(results, measures, adjoint=False).values
    columns = []
    for k, size in enumerate(sizes):
        name = f"{type(parameter).__name__} {k}"

        def slope(offset: float, k: int = k, size: float = float(size), name: str = name) -> Floats:
            def vary(change: float) -> tuple[Model, Sequence[Step]]:
                return parameter.vary(base, k, offset + change), steps

            beside = solve(vary(0.0)[0], steps, threads=threads, fields=False)
            return Run(beside, measures, memory=memory).by_variation(vary, size, name)

        columns.append(limit(slope, values, float(size), side, name))
    rows = np.stack(columns, axis=1) if columns else np.zeros((len(measures), 0))
    return rows.reshape(len(measures), *shape)


class Run:
    """A run with the adjoint states of measures.

    Parameters
    ----------
    results : Results
    measures : sequence of Measure
    adjoint : bool
        Whether there will be gradients; else the values alone.
    memory : float, optional
        As of :func:`gradient`.
    fields : sequence of Field, optional
        Those that :meth:`by` will get: materials with history give these on the way back.
    """

    def __init__(
        self,
        results: Results,
        measures: Sequence[Measure],
        adjoint: bool = True,
        memory: float | None = None,
        fields: Sequence[Field] = (),
    ) -> None:
        self.measures = list(measures)
        for each in self.measures:
            if not isinstance(each, Measure):
                raise InputError(
                    f"{each!r} is no measure with a gradient; see corota.gradients.Displacement "
                    "and the others there"
                )
        self.model, self.steps = results.model, results.steps
        self.threads = int(results.info.get("threads", 1))
        self.increments = increments_of(results)
        self.leaves = [leaf for m in self.measures for leaf in leaves(m)]
        for leaf in self.leaves:
            if isinstance(leaf, SpecialMeasure):
                leaf.prepare(results)
        self.store = HistoryStore(memory)
        self.trajectory = Trajectory(
            self.model, self.steps, self.threads, self.store, kinks=not adjoint
        )
        self.sums = FieldSums(list(fields))
        self.leaf_values, self.adjoints = adjoints(
            self.trajectory, self.increments, self.leaves, adjoint, self.sums
        )
        self.values = np.array([self._combined(None, m)[0] for m in self.measures])

    def _combined(self, rows: Floats | None, measure: Measure) -> tuple[float, Any]:
        values = {id(leaf): v for leaf, v in zip(self.leaves, self.leaf_values, strict=True)}
        by = {id(leaf): 0.0 if rows is None else rows[k] for k, leaf in enumerate(self.leaves)}
        return combine(measure, values, by)

    def combined(self, rows: Floats) -> Floats:
        """Derivatives of the measures from those of their leaves, one a row."""
        return np.array([self._combined(rows, m)[1] for m in self.measures])

    def by(self, parameter: Parameter | Field) -> Floats:
        """Gradient of all measures, shape (n_measures, ...)."""
        if isinstance(parameter, Field):
            return self._by_field(parameter)
        shape = np.shape(parameter.values(self.model))
        sizes = np.broadcast_to(parameter.sizes(self.model), int(np.prod(shape)))
        name = type(parameter).__name__
        columns = []
        for k, size in enumerate(sizes):

            def vary(change: float, k: int = k) -> tuple[Model, Sequence[Step]]:
                return parameter.vary(self.model, k, change), self.steps

            columns.append(self.by_variation(vary, float(size), f"{name} {k}"))
        rows = np.stack(columns, axis=1) if columns else np.zeros((len(self.measures), 0))
        return rows.reshape(len(self.measures), *shape)

    def by_variation(
        self, vary: Callable[[float], tuple[Model, Sequence[Step]]], size: float, name: str
    ) -> Floats:
        """Derivatives of all measures by one number that changes model and steps."""
        first = step_between_kinks(sum(len(h) for h in self.increments[0].histories))
        slope, rough = derivative(lambda change: self._varied(*vary(change)), size, first)
        count = len(self.leaves)
        for k, leaf in enumerate(self.leaves):
            if abs(slope[count + k]) * size > SYMMETRY * self.sizes[count + k]:
                raise UnsupportedError(
                    f"{leaf!r} has no derivative by {name}, which breaks the symmetry: the "
                    "branches part, and the load falls with a power of the change below one"
                )
        worst = float(rough[:count].max(initial=0.0))
        if worst > KINK:
            raise UnsupportedError(
                f"{name}: forces or measures have no derivative at the state of the run (results "
                f"of two orders differ by {worst:.1%}): a material or a table has a kink there. "
                "Change the parameter or the load a little"
            )
        return self.combined(slope[:count])

    def _varied(self, model: Model, steps: Sequence[Step]) -> tuple[Floats, Floats]:
        """Sum of weighted residuals and histories and of the measures of a varied model.

        Returns
        -------
        total, size : ndarray, shape (n_leaves,)
            The sums, and those of the sizes of their terms.
        """
        other = Trajectory(model, steps, self.threads)
        same = [(s.procedure, s.nlgeom, s.period) for s in self.steps]
        if same != [(s.procedure, s.nlgeom, s.period) for s in other.steps]:
            raise InputError("a varied model must have the steps of the first one, and their times")
        if not np.array_equal(other.system.start, self.trajectory.system.start):
            raise InputError("a varied model must have the mesh and the dofs of the first one")
        total, size, largest = np.zeros((3, 2 * len(self.leaves)))
        needed, own = self._needed()
        for point in other.walk(needed, given=True):
            adjoint = own.get(id(point.increment))
            if adjoint is None:
                continue
            total += point.reaction @ adjoint.weights
            size += point.at.scale @ np.abs(adjoint.weights)
            largest += point.at.scale.max() * np.abs(adjoint.weights).sum(axis=0)
            for column, leaf in adjoint.measures:
                direct = leaf.direct(point)
                total[column] += direct
                size[column] += abs(direct)
            if adjoint.multipliers is not None:
                total[: len(self.leaves)] += point.gaps @ adjoint.multipliers
                size[: len(self.leaves)] += np.abs(point.gaps) @ np.abs(adjoint.multipliers)
            if adjoint.velocity is not None:
                total[: len(self.leaves)] += point.v @ adjoint.velocity
            if adjoint.trace is not None:
                total[: len(self.leaves)] += point.trace @ adjoint.trace
            if adjoint.control is not None:
                total[: len(self.leaves)] += self._off_control(adjoint, point)
            if any(adjoint.histories):
                new = other.system.core.histories(True)
                for column, weights in enumerate(adjoint.histories):
                    pairs = list(zip(weights, new, strict=False))
                    total[column] += sum(w @ h for w, h in pairs)
                    size[column] += sum(np.abs(w) @ np.abs(h) for w, h in pairs)
        # What symmetry makes zero exactly has a size, too.
        self.sizes = size + FORCE_FLOOR * largest
        return total, size + ROUNDED * largest

    def _off_control(self, adjoint: Adjoint, point: Point) -> Floats:
        """Weighted difference of a controlled displacement from what the path prescribes."""
        assert adjoint.control is not None
        weights, before = adjoint.control
        increment = point.increment
        _, target = _target(self.steps[increment.step])
        varied, its_target = _target(point.steps[increment.step])
        row = control_row(point.system, varied)
        share = before / target if target else 0.0
        return weights * (before + share * (its_target - target) - row @ point.u) * -1.0

    def _needed(self) -> tuple[list[Increment], dict[int, Adjoint]]:
        """Increments with adjoint states, by their identity, and the last of each step before."""
        own = {id(adjoint.increment): adjoint for adjoint in self.adjoints}
        final = max(adjoint.increment.frame for adjoint in self.adjoints)
        step = max(adjoint.increment.step for adjoint in self.adjoints)
        ends = {i.step: i for i in self.increments if i.step < step}
        both = [*(adjoint.increment for adjoint in self.adjoints), *ends.values()]
        needed = {id(i): i for i in both if i.frame <= final}
        # Improved states come before the end of their step.
        return sorted(needed.values(), key=lambda i: (i.frame, i is ends.get(i.step))), own

    def _by_field(self, parameter: Field) -> Floats:
        for known, rows in zip(self.sums.fields, self.sums.rows, strict=False):
            if known is parameter:
                return self.combined(rows)
        sums, inputs = FieldSums([parameter]), [parameter.wanted()]
        trajectory = Trajectory(self.model, self.steps, self.threads)
        needed, own = self._needed()
        for point in trajectory.walk(needed, given=True):
            adjoint = own.get(id(point.increment))
            if adjoint is None:
                continue
            system = trajectory.system
            here, found = system.in_space(point.u), []
            for column in range(len(self.leaves)):
                force = np.ascontiguousarray(system.in_space(adjoint.forces[:, column]))
                weights = list(adjoint.histories[column]) if adjoint.histories else []
                found.append(system.core.differentiate(here, system.nlgeom, force, weights, inputs))
            sums.add(trajectory, adjoint, found)
        return self.combined(sums.rows[0])


def _target(step: Step) -> tuple[list[Any], float]:
    """Terms and target of the displacement that a path controls."""
    path = getattr(step, "path", None)
    if isinstance(path, DisplacementControl):
        return path.terms, path.target
    assert path is not None
    assert path.displacement is not None
    where, dof, value = path.displacement
    return [(where, dof, 1.0)], value


def _steps_of(model: Model) -> list[Step]:
    listed = listed_steps(model.steps or [Static()])
    finite = any(section.material.local_strain for section in model.sections)
    return keep_nlgeom(listed, finite)[0]


@dataclass
class ValueAndGradient:
    """A function of parameters for optimizers: value and gradient of measures.

    Parameters
    ----------
    build : callable
        Gives the model of parameters, with its steps.
    measures : list of Measure
    scalar : bool
        Whether there is one measure, so that the value is a number.
    sizes : ndarray, shape (k,), or None
        Sizes of the parameters, over which the model is smooth.
    options : dict
        Options of :func:`corota.solve`.
    memory : float or None
        As of :func:`gradient`.
    one_sided : {"left", "right"} or None
        As of :func:`gradient`.
    runs : int
        Analyses so far.
    """

    build: Callable[[Floats], Model]
    measures: list[Measure]
    scalar: bool
    sizes: Floats | None = None
    options: dict[str, Any] = field(default_factory=dict)
    memory: float | None = None
    one_sided: Side | None = None
    runs: int = 0
    results: Results | None = field(default=None, repr=False)

    def __call__(self, x: ArrayLike) -> tuple[Any, Floats]:
        """Value and gradient at parameters of shape (k,).

        Returns
        -------
        value : float, or ndarray of shape (n_measures,)
        gradient : ndarray, shape (k,) or (n_measures, k)
        """
        at = np.array(x, dtype=float)
        if at.ndim != 1:
            raise InputError(f"parameters have the shape (k,), not {at.shape}")
        results = self.results = self._solve(at)
        run = Run(results, self.measures, self.one_sided is None, self.memory)
        columns = []
        for k, size in enumerate(self._sizes(at)):
            if self.one_sided is None:
                columns.append(self._by(run, at, k, float(size)))
                continue

            def slope(offset: float, k: int = k, size: float = float(size)) -> Floats:
                moved = at.copy()
                moved[k] += offset
                beside = Run(self._solve(moved), self.measures, memory=self.memory)
                return self._by(beside, moved, k, size)

            columns.append(limit(slope, run.values, float(size), self.one_sided, f"parameter {k}"))
        rows = np.stack(columns, axis=1) if columns else np.zeros((len(run.values), 0))
        return (float(run.values[0]), rows[0]) if self.scalar else (run.values, rows)

    def _solve(self, at: Floats) -> Results:
        self.runs += 1
        return solve(self.build(at.copy()), fields=False, **self.options)

    def _by(self, run: Run, at: Floats, k: int, size: float) -> Floats:
        """Derivatives of all measures of a run by one of the parameters."""

        def vary(change: float) -> tuple[Model, Sequence[Step]]:
            moved = at.copy()
            moved[k] += change
            model = self.build(moved)
            return model, _steps_of(model)

        return run.by_variation(vary, size, f"parameter {k}")

    def _sizes(self, at: Floats) -> Floats:
        if self.sizes is not None:
            return np.broadcast_to(self.sizes, at.shape)
        size = np.abs(at)
        most = float(size.max(initial=0.0)) or 1.0
        return np.where(size > 0.0, size, most)


def value_and_grad(
    build: Callable[[Floats], Model],
    measure: Measure | Sequence[Measure],
    *,
    sizes: ArrayLike | None = None,
    memory: float | None = None,
    one_sided: Side | None = None,
    **options: Any,
) -> ValueAndGradient:
    """Make a function that gives the value of a measure and its exact gradient by parameters.

    All that `build` makes of the parameters is differentiated: shape, thickness, materials, loads,
    prescribed values. One call is one analysis, one adjoint solution for each measure (of
    materials with history: for each increment), and some evaluations of forces for each
    parameter.

    Parameters
    ----------
    build : callable
        ``build(x)`` gives the model of parameters of shape (k,); the mesh must keep its topology.
    measure : Measure or sequence of Measure
    sizes : array_like, optional
        Sizes of the parameters over which the model is smooth; by default their magnitudes.
    memory : float, optional
        As of :func:`gradient`.
    one_sided : {"left", "right"}, optional
        As of :func:`gradient`: three analyses or more for each parameter.
    **options
        Of :func:`corota.solve`.

    Returns
    -------
    ValueAndGradient
        For ``scipy.optimize.minimize(..., jac=True)``.

    Examples
    --------
    >>> import corota as ct
    >>> from corota import gradients
    >>> def build(x):
    ...     model = ct.Model(ct.mesh.rectangle(10.0, x[0], nx=10, ny=1))
    ...     model.section("all", element="Q4I", material=ct.Elastic(E=1000.0, nu=0.0))
    ...     model.fix("left")
    ...     model.force("right", y=-0.02)
    ...     return model
    >>> f = ct.value_and_grad(build, gradients.Displacement("right", "y"), threads=1)
    >>> value, by_height = f([1.0])
    >>> bool(abs(by_height[0] / value + 3.0) < 0.1)  # stiffness grows with the third power
    True
    """
    scalar = isinstance(measure, Measure)
    measures = [measure] if isinstance(measure, Measure) else list(measure)
    own = None if sizes is None else np.asarray(sizes, dtype=float)
    require_side(one_sided)
    return ValueAndGradient(build, measures, scalar, own, dict(options), memory, one_sided)

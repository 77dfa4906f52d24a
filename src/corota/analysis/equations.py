"""The discrete equations of a model, as the procedures use them.

A system gives the residual and the tangent at a displacement and a time; it has dofs,
elements, loads and supports, but no increments or iterations.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, TypeVar

import numpy as np

from corota.analysis.evaluation import Evaluation
from corota.analysis.linear.unsymmetric import FullMatrix
from corota.analysis.newton import ResidualNorms
from corota.analysis.numbered_model import NumberedModel, Role
from corota.analysis.recovery import recover
from corota.analysis.rule import REST, Rule
from corota.analysis.scales import Scales
from corota.analysis.terms.conditions import Conditions
from corota.analysis.terms.contact.contact import ContactTerm
from corota.analysis.terms.elements import Elements
from corota.analysis.terms.term import TERMS, StatePoint, Term
from corota.errors import ModelError, SingularError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from corota.analysis.linear.solvers import LinearSolver
    from corota.analysis.linear.types import Sparse
    from corota.arrays import Bools, Floats, Ints
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.results import PointFields


#: A kind of term.
Kind = TypeVar("Kind", bound="Term")
#: Procedures that find the equilibrium of their own theory.
EQUILIBRATING = ("static", "dynamic")
#: Tangents whose memory is kept for the next ones.
SPARE = 2
#: Values of a returned tangent.
NOWHERE = np.empty(0)


class System(NumberedModel):
    """The discrete system of a model: its equations at any state.

    Parameters
    ----------
    steps : sequence of Step, optional
        See :class:`NumberedModel`.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset(
        {"model", "blocks", "own_blocks", "own_numbers", "largest_linear_strain", "_spare"}
        | {"communicator"}
    )

    def __init__(
        self, model: Model, solver: LinearSolver, threads: int = 1, steps: Sequence[Step] = ()
    ) -> None:
        super().__init__(model, solver, threads, steps)
        self.conditions = Conditions(self)
        self.elements = Elements(self, self.conditions)
        more = [term for make in TERMS.values() if (term := make(self)) is not None]
        #: All terms of the equation except inertia and damping: the elements come first, contact,
        #: whose multipliers are unknowns, last.
        self.terms: list[Term] = [self.elements, self.conditions, *more, ContactTerm(self)]
        #: Whether the last static or dynamic step was geometrically linear.
        self._linear_state = False
        self.scales = Scales(self, self.conditions, self.terms)
        self._spare: list[Floats] = []

    @property
    def constrained(self) -> Bools:
        return self.conditions.constrained

    @property
    def joined(self) -> bool:
        """Whether terms such as contact constrain bodies without supports."""
        return any(term.joins for term in self.terms)

    @property
    def opens(self) -> bool:
        """Whether forces of terms may begin and end within an increment."""
        return any(term.opens for term in self.terms)

    @property
    def n_multipliers(self) -> int:
        """Unknowns besides the dofs."""
        return sum(term.unknowns for term in self.terms)

    def multiplier_force(self, u: Floats | None = None, values: Floats = NOWHERE) -> Floats:
        """Force of the committed multipliers, shape (n_dofs,); see :class:`Term`."""
        forces = [term.multiplier_force(u, values) for term in self.terms]
        return sum((f for f in forces if f is not None), start=np.zeros(self.n_dofs))

    def nodes_of_terms(self, role: Role) -> Bools:
        out = np.zeros(len(self.per_node), bool)
        for term in self.terms:
            out[term.nodes(role)] = True
        return out

    def term(self, kind: type[Kind]) -> Kind:
        """The term of a kind, for those who know what it is."""
        return next(term for term in self.terms if isinstance(term, kind))

    def gives_way(self) -> str:
        """What slides or tips beyond the committed state, for messages; or nothing."""
        return next(filter(None, (term.gives_way() for term in self.terms)), "")

    def wedges(self) -> str:
        """What is wedged in the committed state, for messages; or nothing."""
        return next(filter(None, (term.wedges() for term in self.terms)), "")

    def remarks(self, u: Floats, finished: bool) -> list[str]:
        """Remarks on the displacement at which a run ends, `finished` or not."""
        return [text for term in self.terms for text in term.remarks(u, finished)]

    def keeps(self, at: Evaluation, states: list[NDArray[np.int8]], tolerance: float) -> bool:
        """Whether `states` of constraints are those of an equilibrium; see :class:`Term`."""
        return all(term.keeps(at, states, tolerance) for term in self.terms)

    # -- evaluation --------------------------------------------------------------------

    def begin(self, step: Step, time: float, u: Floats, reaction: Floats | None) -> None:
        """Activate the loads and supports of a step."""
        if step.procedure in EQUILIBRATING:
            self._linear_state = not step.nlgeom
            self.set_kinematics(step.nlgeom)
        else:
            self.set_kinematics(step.nlgeom, about_linear=self._linear_state and step.nlgeom)
        self.constraints.complete(u)
        for term in self.terms:
            term.begin(step, time, u, reaction)
        self.scales.begin(getattr(step, "tolerance", 1e-9), u)
        self.free_motion_excluded = False

    def set_kinematics(self, nlgeom: bool, about_linear: bool = False) -> None:
        """Let displacements be finite or infinitesimal from now on.

        Parameters
        ----------
        about_linear : bool
            Look at small motions about the state of a geometrically linear step: its stress, on
            the reference shape, has a stiffness, and so have loads and constraints there. This is
            then so whatever `nlgeom` says.
        """
        self.nlgeom = nlgeom and not about_linear
        self.about_linear = about_linear
        self.free.set_kinematics(self.nlgeom)
        self.constraints.set_nlgeom(nlgeom or about_linear, about_linear)

    def borrow_tangent(self) -> Floats:
        """Memory for the values of a tangent: allocation costs as much as filling."""
        return self._spare.pop() if self._spare else np.empty(self.pattern.nnz)

    def return_tangent(self, at: Evaluation) -> None:
        """Return the memory of a tangent that is no longer used."""
        if len(self._spare) < SPARE:
            self._spare.append(at.values)
        at.values = NOWHERE

    def evaluate(self, z: Floats, step_time: float, rule: Rule = REST) -> Evaluation:
        """Residual and tangent at a trial state; dependent dofs of `z` are set, in place.

        Parameters
        ----------
        z : ndarray, shape (n_dofs,) or (n_dofs + n_multipliers,)
            Displacements at the end of an increment, and multipliers; without these contact and
            ties do not act.
        step_time : float
            Of that end.
        rule : Rule
            What the increment makes of it: a time scheme, or statics.

        Raises
        ------
        ElementFailure
            If an element is inverted or its material did not converge.
        """
        u = z[: self.n_dofs]
        self.constraints.complete(u)
        at = self.blank(self.borrow_tangent())
        point = rule.point(u, step_time)
        self._add_terms(point, at, rule)
        at.link = rule.link(self.constraints, u)
        rule.close(point, at)
        if len(z) > len(u):
            # Constraints hold at the end of the increment, whatever the rule weighs.
            end = StatePoint(u, step_time, multipliers=z[self.n_dofs :].copy())
            self.terms[-1].add(end, at)
        if at.added is not None:
            self.pattern.add_diagonal(at.values, at.added)
        return at

    def blank(self, values: Floats) -> Evaluation:
        """An evaluation to be filled; `values` is the memory of its tangent."""
        return Evaluation(np.empty(self.n_dofs), NOWHERE, np.empty(self.n_dofs), values)

    def _add_terms(self, point: StatePoint, at: Evaluation, rule: Rule) -> None:
        """Add all terms without multipliers."""
        rule.add_elements(self.elements, point, at)
        if not (self.scales.stiffest or rule.moves) and len(at.values):
            self.scales.measure(at.values)
        self.conditions.add(point, at)
        for term in self.terms[2:-1]:
            term.add(point, at)
            # Elements and loads refuse numbers that are not finite themselves.
            parts = (at.internal, at.external, at.values, at.damping)
            if not all(part is None or math.isfinite(part.sum()) for part in parts):
                raise ModelError(f"a force or a derivative of {term.name!r} is not a finite number")

    def damping_of_terms(self, u: Floats, values: Floats) -> tuple[Ints, Ints, Floats] | None:
        """Add the derivatives of user terms by velocity to `values`; unsymmetric ones as triplets.

        Parameters
        ----------
        u : ndarray, shape (n_dofs,)
        values : ndarray, shape (nnz,)
        """
        still = np.zeros(self.n_dofs)
        at = Evaluation(still.copy(), still.copy(), still.copy(), values)
        for term in self.terms[2:-1]:
            term.add(StatePoint(u, 0.0, still, still, (0.0, 1.0, 0.0)), at)
        return at.load_stiffness

    def with_loads(self, at: Evaluation, u: Floats, step_time: float) -> Evaluation:
        """An evaluation at `u` with the loads of another time; its tangent is a copy."""
        external, stiffness = self.conditions.external(step_time, u)
        values = self.borrow_tangent()
        values[:] = at.values
        return Evaluation(at.internal, external, at.scale, values, stiffness, at.link)

    def forces(self, u: Floats, step_time: float) -> Evaluation:
        """Forces at a state without the tangent."""
        at = self.blank(NOWHERE)
        self._add_terms(REST.point(u, step_time), at, REST)
        at.link = self.constraints.link(u)
        return at

    def reaction(self, at: Evaluation) -> Floats:
        """Residual with what dependent dofs pass on to their masters, shape (n_dofs,)."""
        return at.reaction

    def holds(self, step_time: float) -> bool:
        """Whether an evaluation is that of another step time, except for loads."""
        return all(term.holds(step_time) for term in self.terms)

    def load_rate(self, u: Floats) -> tuple[Floats, Floats]:
        """Change of forces and of prescribed dofs per unit of load factor, shapes (n_dofs,)."""
        return self.conditions.rate(u)

    def residual_norms(self, at: Evaluation, u: Floats) -> ResidualNorms:
        """Size of the residual against its scale; see :class:`corota.analysis.scales.Scales`."""
        return self.scales.residual_norms(at, u)

    def commit(self) -> None:
        """Accept the last evaluated state."""
        for term in self.terms:
            term.commit()
        self.scales.commit()

    def revert(self) -> None:
        """Go back to the committed state."""
        for term in self.terms:
            term.revert()

    # -- linear algebra ----------------------------------------------------------------

    def predict(self, at: Evaluation, du_prescribed: Floats) -> tuple[Floats, int]:
        """Newton correction: free dofs solve the linearized equilibrium, prescribed ones move.

        Parameters
        ----------
        at : Evaluation
            Overwritten: the tangent's prescribed rows become diagonal.
        du_prescribed : ndarray, shape (n_dofs,)
            Prescribed increments at constrained dofs, 0 elsewhere. They act through the tangent.

        Returns
        -------
        du : ndarray, shape (n_dofs,)
        negative : int
            Negative pivots: unstable directions of the free system; -1 if not symmetric.

        Raises
        ------
        SingularError
            Naming the unconstrained node and dof.
        """
        return self._correct(at, at.external - at.internal, du_prescribed)

    def correct_with_last_factor(self, at: Evaluation) -> Floats:
        """Newton correction with the last factorization; prescribed dofs do not change."""
        return self.solve_with_last_factor(-at.residual)

    def correct(self, at: Evaluation, rhs: Floats, du_prescribed: Floats) -> tuple[Floats, int]:
        """Factorize the tangent at a state and solve for one or several right-hand sides.

        Parameters
        ----------
        at : Evaluation
            Overwritten: the tangent's prescribed rows become diagonal.
        rhs : ndarray, shape (n_dofs,) or (n_dofs, k)
            Forces; those at prescribed dofs are ignored.
        du_prescribed : ndarray, of the same shape
            Prescribed increments at constrained dofs, 0 elsewhere. They act through the tangent.

        Returns
        -------
        du : ndarray, of the shape of `rhs`
        negative : int
            Negative pivots; -1 if not symmetric.

        Raises
        ------
        SingularError
            Naming the unconstrained node and dof.
        """
        return self._correct(at, np.array(rhs, order="F"), np.asfortranarray(du_prescribed))

    def correct_adjoint(self, at: Evaluation, rhs: Floats, prescribed: Floats) -> Floats:
        """:meth:`correct` with the transposed tangent: the adjoint of the linearized equilibrium.

        A symmetric tangent is its own transpose, and its factor the one that exists.
        """
        rhs, prescribed = np.array(rhs, order="F"), np.asfortranarray(prescribed)
        return self._correct(at, rhs, prescribed, transposed=True)[0]

    def _correct(
        self, at: Evaluation, rhs: Floats, du_prescribed: Floats, transposed: bool = False
    ) -> tuple[Floats, int]:
        """:meth:`correct` for columns one after the other, of which `rhs` is overwritten."""
        link, pattern = at.link, self.constraints.pattern
        if (at.load_stiffness is not None or (link.couples and self.nlgeom)) and not (
            self.free_motion_excluded or at.inertial_stiffness
        ):
            # Follower loads, and loads on rotating rigid parts, give a free motion a stiffness
            # that does not constrain it.
            self._refuse_free(at)
        unsymmetric = None
        if at.load_stiffness is not None:
            _, unsymmetric = self._add_load_stiffness(at)
        self.link = link
        constrained = link.unknowns(self.conditions.constrained)
        force = np.asfortranarray(link.unknowns(link.gather(rhs)))
        moved = link.unknowns(du_prescribed)
        if unsymmetric is not None:
            matrix = link.reduce_full(unsymmetric, at.residual)
            if transposed:
                matrix = matrix.T.tocsc()
            return link.expand(self._solve_unsymmetric(matrix, force, moved, constrained)), -1
        with self.timed("constraints"):
            values = link.reduce(at.values, at.residual)
            pattern.impose(values, force, moved, constrained)
        try:
            inertia = self.linear.factorize(pattern, values)
            x = self.linear.solve(force)
        except SingularError as error:
            raise self.singular(error) from None
        x[constrained] = moved[constrained]
        return link.expand(x), (inertia[1] if inertia is not None else -1)

    def _refuse_free(self, at: Evaluation) -> None:
        """Refuse a structure that has a free motion without the stiffness of its loads."""
        link, pattern = at.link, self.constraints.pattern
        values = link.reduce(at.values.copy(), self.at_nodes(at.internal))
        pattern.mask(values, link.unknowns(self.conditions.constrained))
        self.link = link
        try:
            self.linear.factorize(pattern, values)
        except SingularError as error:
            raise self.singular(error) from None
        self.free_motion_excluded = True

    def solve_with_last_factor(self, rhs: Floats) -> Floats:
        """Solve with the last factorization, prescribed dofs fixed; shape as in `correct`."""
        link = self.link
        constrained = link.unknowns(self.conditions.constrained)
        force = np.array(link.unknowns(link.gather(rhs)), order="K")
        force[constrained] = 0.0
        x = self.linear.solve(force)
        x[constrained] = 0.0
        return link.expand(x)

    def singular(self, error: SingularError) -> SingularError:
        from corota.analysis.free_motion import name_motion

        return name_motion(self, error, self.scales.ratio)

    def _add_load_stiffness(self, at: Evaluation) -> tuple[bool, Sparse | None]:
        import scipy.sparse as sp

        assert at.load_stiffness is not None
        rows, columns, values = at.load_stiffness
        n = self.n_dofs
        extra = sp.coo_array((-values, (rows, columns)), shape=(n, n)).tocsr()
        constrained = self.conditions.constrained
        inside = (~constrained).astype(float)
        skew = (extra - extra.T).multiply(inside[:, None]).multiply(inside[None, :])
        size = abs(extra).max() if extra.nnz else 0.0
        if skew.nnz and abs(skew).max() > 1e-9 * size:
            return False, self._full.build(self._gathered(at), rows, columns, -values)
        upper_extra = sp.triu(0.5 * (extra + extra.T)).tocoo()
        places, known, mine = self.pattern.owned_places(upper_extra.row, upper_extra.col)
        if not known.all():
            # Nodes without a common element: not in the pattern.
            return False, self._full.build(self._gathered(at), rows, columns, -values)
        at.values[places[mine]] += upper_extra.data[mine]
        return True, None

    def _gathered(self, at: Evaluation) -> Floats:
        return self.pattern.gathered(at.values)

    @cached_property
    def _full(self) -> FullMatrix:
        return FullMatrix(self.pattern.whole)

    def _solve_unsymmetric(
        self,
        matrix: Sparse,
        rhs: Floats,
        du_prescribed: Floats,
        constrained: Bools,
    ) -> Floats:
        rhs = rhs - matrix @ du_prescribed
        rhs[constrained] = 0.0
        try:
            self.linear.factorize_unsymmetric(matrix, constrained, self.constraints.pattern.node)
            du = self.linear.solve(rhs)
        except SingularError as error:
            raise self.singular(error) from None
        du[constrained] = du_prescribed[constrained]
        return du

    # -- output ------------------------------------------------------------------------

    def recover(self, u: Floats) -> tuple[list[PointFields], dict[str, float]]:
        """Fields at the quadrature points, and sums over them."""
        return recover(self, self.elements.user, u)

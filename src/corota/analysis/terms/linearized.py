"""The equations of motion linearized about a state: ``M z'' + C z' + K z = f``.

The unknowns z are the independent dofs and the multipliers of ties and closed contact. Surfaces
that are closed stay closed and stick, if they have friction; open ones stay open. All linear
procedures (frequencies, modal and harmonic response) use only these matrices.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from corota.analysis.linear.factor import Factor
from corota.analysis.linear.triplets import Triplets, nonempty_columns
from corota.analysis.terms.attachments import Attachments
from corota.analysis.terms.contact.gaps import COMPLIANCE
from corota.analysis.terms.damping import damping_matrix
from corota.analysis.terms.inertia import Inertia
from corota.errors import SingularError, UnsupportedError
from corota.lazy import lazy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.linear.coupling import Coupling
    from corota.analysis.linear.types import Kind, Sparse
    from corota.arrays import Floats, Ints

    LinearizedContact = tuple[Evaluation, Coupling, Floats, list[NDArray[np.int8]], Ints]
    #: Rows, columns and values.
    Entries = tuple[Ints, Ints, Floats]

linearized_contact = lazy("corota.analysis.terms.contact.equations:linearized_contact")

#: Skew part of a stiffness, relative to its largest entry, that is rounding.
SKEW = 1e-9


class Linearized:
    """The matrices at a committed state.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
        The committed displacement, or a neighbor of it.
    multipliers : ndarray, shape (n_multipliers,), optional
        Of contact and ties; the committed ones by default.
    states : list of ndarray, optional
        Of their constraints; the committed ones by default, with what slips stuck.
    load : ndarray, shape (n_dofs,), optional
        Additional forces, for the geometric stiffness of constraints.
    time : float, optional
        Step time at which loads are taken; those that earlier steps reached by default.

    Attributes
    ----------
    stiffness : scipy CSC array, shape (n, n)
        Tangent with that of loads, constraints and contact, of all unknowns, including prescribed
        ones.
    active : ndarray of int
        Unknowns without supports.
    symmetric : bool
        Whether the stiffness of the active unknowns is.
    residuals : ndarray, shape (n_multipliers,)
        What a correction adds to the rows of the multipliers: it closes gaps.
    """

    def __init__(
        self,
        system: System,
        u: Floats,
        multipliers: Floats | None = None,
        states: list[NDArray[np.int8]] | None = None,
        load: Floats | None = None,
        time: float | None = None,
    ) -> None:
        self.system = system
        self.u = u.copy()
        self._load = load
        self._pressures: Sparse | None = None
        self._hard: Sparse | None = None
        self._normal: SuperLU | None = None
        loads = system.conditions.as_reached() if time is None else nullcontext()
        with loads, system.elements.unloading(u):
            found: LinearizedContact = linearized_contact(
                system, u, multipliers, states, time or 0.0
            )
        self.at, coupling, self.residuals, self.states, self._laws = found
        self.multipliers = self.at.contact_state.multipliers
        self.link = self.at.link
        self.free = system.constraints.free
        self.nf = len(self.free)
        self.n_multipliers = len(coupling.diagonal)
        self.n = self.nf + self.n_multipliers
        constrained = np.zeros(self.n, bool)
        constrained[: self.nf] = system.conditions.constrained[self.free]
        self.constrained, self.active = constrained, np.flatnonzero(~constrained)
        new = len(system.per_node) + np.arange(self.n_multipliers)
        self.node = np.concatenate([system.node_of_dof[self.free], new])
        self.multiplier = np.arange(self.n) >= self.nf
        self.stiffness: Any = self._stiffness(coupling)
        k = self.sub(self.stiffness)
        size = abs(k).max() if k.nnz else 0.0
        self.symmetric = not k.nnz or abs(k - k.T).max() <= SKEW * size

    @property
    def reaction(self) -> Floats:
        """Residual with what dependent dofs pass on to their masters, shape (n_dofs,)."""
        return self.link.gather(self.at.residual)

    def _stiffness(self, coupling: Coupling) -> Sparse:
        at, more = self.at, coupling.geometric_stiffness
        if at.load_stiffness is not None:
            rows, columns, values = at.load_stiffness
            more = Triplets.join([Triplets(rows, columns, -values), more])
        triplets = (more.rows, more.columns, more.values) if len(more.values) else None
        residual = at.residual if self._load is None else at.residual - self._load
        k = self.reduce(at.values, triplets, residual)
        if not self.n_multipliers:
            return k
        shape = (self.system.n_dofs, self.n_multipliers)
        border = coupling.rows
        side = sp.coo_array((border.values, (border.rows, border.columns)), shape=shape).tocsc()
        side = self.link.reduce_columns(side).tocsc()
        # A law p = h(-gap) is a row with the compliance of the layer: its pressure follows.
        scale = sp.diags_array(-1.0 / coupling.diagonal[self._laws])
        self._pressures = (scale @ side.T.tocsr()[self._laws]).tocsr()
        hard = np.setdiff1d(nonempty_columns(side), self._laws)
        self._hard = side[:, hard].tocsc()
        return sp.block_array(
            [[k, side], [side.T, sp.diags_array(coupling.diagonal)]], format="csc"
        )

    # -- between dofs and unknowns -----------------------------------------------------

    def reduce(
        self,
        values: Floats | None = None,
        triplets: Entries | None = None,
        residual: Floats | None = None,
    ) -> Sparse:
        """A matrix of the independent dofs.

        Parameters
        ----------
        values : ndarray, shape (nnz,), optional
            Upper triangle in the pattern of the tangent, in global axes.
        triplets : tuple of ndarray, optional
            Rows, columns and values of further entries.
        residual : ndarray, shape (n_dofs,), optional
            Forces for the geometric stiffness of constraints: for a tangent.
        """
        system = self.system
        n = system.n_dofs
        matrix: Sparse = sp.csc_array((n, n))
        if values is not None:
            matrix = system.pattern.full(values)
        if triplets is not None:
            rows, columns, entries = triplets
            matrix = matrix + sp.coo_array((entries, (rows, columns)), shape=(n, n))
        force = np.zeros(n) if residual is None else residual
        return self.link.reduce_full(matrix.tocsr(), force).tocsc()

    def of_dofs(self) -> tuple[Any, Any]:
        """Stiffness of the dofs alone, and what closed surfaces and ties prevent.

        Returns
        -------
        stiffness : scipy CSC array, shape (nf, nf)
            With that of pressure laws.
        prevented : scipy CSC array, shape (nf, m)
            Directions in which dofs do not move, one a column.
        """
        k = self.stiffness[: self.nf][:, : self.nf]
        if self._pressures is None:
            return k, sp.csc_array((self.nf, 0))
        side = self.stiffness[: self.nf][:, self.nf + self._laws]
        return (k + side @ self._pressures).tocsc(), self._hard

    def padded(self, matrix: Sparse) -> Any:
        """A matrix of the independent dofs with empty rows and columns of the multipliers."""
        if not self.n_multipliers:
            return matrix
        empty = sp.csc_array((self.n_multipliers, self.n_multipliers))
        return sp.block_array([[matrix, None], [None, empty]], format="csc")

    def sub(self, matrix: Any) -> Any:
        """The part of the active unknowns."""
        return matrix[self.active][:, self.active].tocsc()

    def coupled(self, matrix: Any, moves: Floats) -> Floats:
        """Rows of the active unknowns times the prescribed displacements, shape (n_active, k)."""
        out: Floats = (matrix @ moves)[self.active]
        return out

    def gather(self, force: Floats) -> Floats:
        """Forces at dofs along the axes of their nodes as those on the active unknowns."""
        found = self.link.gather(force)
        padded = np.concatenate(
            [found[self.free], np.zeros((self.n_multipliers, *force.shape[1:]))]
        )
        return padded[self.active]

    def restrict(self, u: NDArray[Kind]) -> NDArray[Kind]:
        """Changes of all dofs as those of all unknowns; multipliers stay."""
        return np.concatenate([u[self.free], np.zeros((self.n_multipliers, *u.shape[1:]))])

    def pressed(self, z: Any) -> Any:
        """Changes of all unknowns with the pressures of contact laws that follow from the dofs."""
        if self._pressures is None or not len(self._laws):
            return z
        out = z.copy()
        out[self.nf + self._laws] = self._pressures @ z[: self.nf]
        return out

    def tractions(self, force: Floats) -> Floats:
        """Forces of closed surfaces and ties that best balance a force at free dofs.

        Parameters
        ----------
        force : ndarray, shape (nf,)
            Sum of stiffness, inertia and loads of a response at the independent dofs.

        Returns
        -------
        ndarray, shape (nf,)
        """
        if self._hard is None or not self._hard.shape[1]:
            return np.zeros_like(force)
        loose = self.active[self.active < self.nf]
        rows = self._hard[loose]
        if self._normal is None:
            normal = (rows.T @ rows).tocsc()
            trace = COMPLIANCE * normal.diagonal().max()
            self._normal = splu(normal + trace * sp.eye_array(normal.shape[0], format="csc"))
        return self._hard @ self._normal.solve(-(rows.T @ force[loose]))

    def expand(self, z: Any) -> Any:
        """Changes of all dofs from those of all unknowns; complex ones too."""
        if np.iscomplexobj(z):
            return self.expand(z.real) + 1j * self.expand(z.imag)
        dofs = z[: self.nf]
        return np.array(self.link.expand(dofs))

    def from_active(self, x: NDArray[Kind]) -> NDArray[Kind]:
        """All unknowns from the active ones, the others zero."""
        z = np.zeros((self.n, *x.shape[1:]), x.dtype)
        z[self.active] = x
        return z

    def factor(self, matrix: Sparse, symmetric: bool) -> Factor:
        """Factorize a matrix of the active unknowns.

        Raises
        ------
        SingularError
            In terms of nodes.
        """
        a = self.active
        threads = getattr(self.system.linear.solver, "threads", 1)
        try:
            return Factor(matrix, symmetric, self.node[a], self.multiplier[a], threads)
        except SingularError as error:
            equation, mode = error.equation, error.mode
            if not 0 <= equation < len(a) or a[equation] >= self.nf:
                raise
            shown = None
            if mode is not None:
                shown = self.from_active(np.asarray(mode, float).reshape(len(a), -1)[:, 0])[
                    : self.nf
                ]
            self.system.link = self.link
            raise self.system.singular(SingularError(str(error), int(a[equation]), shown)) from None


class LinearMotion(Linearized):
    """The matrices with inertia and damping.

    Parameters
    ----------
    u : ndarray, shape (n_dofs,)
    kind : {"consistent", "constant", "lumped"}
        Of the mass.

    Attributes
    ----------
    mass : scipy CSC array, shape (n, n)
    turns : bool
        Whether Coriolis forces of that frame count among the damping.
    """

    def __init__(self, system: System, u: Floats, kind: str = "consistent") -> None:
        # Body loads have the stiffness of the inertial mass, see `loads.body`.
        system.conditions.set_mass(kind)
        super().__init__(system, u)
        self.kind = kind
        self.inertia = Inertia(system, kind)
        self.mass_values = self.inertia.tangent(np.zeros_like(u) if system.about_linear else u)
        self.mass: Any = self.padded(self.reduce(self.mass_values))
        self.turns = False
        system.conditions.reset_mass()
        self._damping: dict[tuple[float, float, bool], Sparse] = {}

    def damping(self, rayleigh: tuple[float, float] = (0.0, 0.0)) -> Sparse:
        """Dashpots, damping of materials and of the whole model, and Coriolis forces if it `turns`.

        Parameters
        ----------
        rayleigh : tuple of float
            Of the whole model, per mass [1/time] and per stiffness [time].
        """
        key = (*rayleigh, self.turns)
        if key not in self._damping:
            system = self.system
            per_mass, per_stiffness = rayleigh
            values = damping_matrix(system, self.u, per_stiffness, self.kind)
            values = system.pattern.zeros() if values is None else values.copy()
            values += per_mass * self.mass_values
            _, triplets = Attachments(system).damp(self.u, np.zeros(system.n_dofs), values, 1.0)
            more = system.damping_of_terms(self.u, values)
            matrix = self.reduce(values, triplets)
            if more is not None:
                rows, columns, entries = more
                matrix = matrix + self.reduce(None, (rows, columns, -entries))
            matrix = self.padded(matrix)
            self._damping[key] = (matrix + self.coriolis()).tocsc() if self.turns else matrix
        return self._damping[key]

    def coriolis(self) -> Sparse:
        """Coriolis matrix, skew, of a model that rotates with the speed of its centrifugal load.

        Exact for displacements; drilling rotations and beams take the mean of the masses along
        both axes, which converges with the mesh.
        """
        rate = math.sqrt(spin(self.system))
        system = self.system
        if system.axisymmetric:
            raise UnsupportedError(
                "complex modes, modal and harmonic steps of an axisymmetric model that spins: its "
                "Coriolis forces turn it about the axis, which is no part of the model; *FREQUENCY "
                "has the stiffness of the spin without them"
            )
        n = system.n_dofs
        x = np.flatnonzero(system.component == 0)
        y = x + 1
        turn = sp.coo_array(
            (
                np.concatenate([-np.ones(len(x)), np.ones(len(x))]),
                (np.concatenate([x, y]), np.concatenate([y, x])),
            ),
            shape=(n, n),
        ).tocsr()
        mass = system.pattern.full(self.mass_values)
        whole = (rate * (mass @ turn + turn @ mass)).tocoo()
        found: Sparse = self.padded(self.reduce(None, (whole.row, whole.col, whole.data)))
        return found


def spin(system: System) -> float:
    """Square of the angular velocity of the centrifugal load that acts, or 0 [1/time^2].

    Raises
    ------
    UnsupportedError
        If bodies rotate at several speeds.
    """
    with system.conditions.as_reached():
        rates = {
            round(scale * item.value[0], 12)
            for item, scale in system.conditions.body_forces()
            if item.kind == "centrifugal"
        }
    if len(rates) > 1:
        raise UnsupportedError(
            "bodies that rotate at different speeds have no common frame of reference; give one "
            "centrifugal load to the whole model"
        )
    return float(sum(rates))

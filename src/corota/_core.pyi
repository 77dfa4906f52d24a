"""Compiled core of Corota: types of what `rust/src/python` offers."""

# SPDX-License-Identifier: BSD-3-Clause
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

__version__: str

#: States of a constraint of contact.
OPEN: int
CLOSED: int
SLIPPING: int
#: Turns of a boundary [rad]: at a corner, beside which it is round; of a round that is coarse; of a
#: rigid round over a slave edge from which nodes alone do not represent it.
CORNER: float
TURN: float
STEEP: float

_Floats = NDArray[np.float64]
_Indices = NDArray[np.uint32]

_Integers = NDArray[np.int64]

class _Gaps(TypedDict):
    total_gap: _Floats
    total_slip: _Floats
    total_area: _Floats
    constraint: _Integers
    pair: _Integers
    variables: _Integers
    gap_gradient: _Floats
    slip_gradient: _Floats

class Contact:
    threads: int
    offset: _Floats
    @staticmethod
    def edges(
        reference: _Floats,
        slave_nodes: _Integers,
        slave_bulge: _Floats,
        slave_thickness: _Floats,
        master_nodes: _Integers,
        master_bulge: _Floats,
        *,
        master_shapes: _Integers | None = ...,
        method: str = ...,
        reach: float,
        margin: float,
        depth: float = ...,
        corners: bool = ...,
    ) -> Contact: ...
    @staticmethod
    def itself(
        reference: _Floats,
        nodes: _Integers,
        bulge: _Floats,
        thickness: _Floats,
        *,
        method: str = ...,
        reach: float,
        margin: float,
        corners: bool = ...,
    ) -> Contact: ...
    @staticmethod
    def rigid(
        reference: _Floats,
        slave_nodes: _Integers,
        slave_bulge: _Floats,
        slave_thickness: _Floats,
        segments: _Floats,
        node: int,
        point: tuple[float, float],
        *,
        turns: bool = ...,
        method: str = ...,
        reach: float,
        margin: float,
        depth: float = ...,
        corners: bool = ...,
    ) -> Contact: ...
    @property
    def nodes(self) -> _Integers: ...
    @property
    def full_area(self) -> _Floats: ...
    @property
    def corners(self) -> _Integers: ...
    def search(self, x: _Floats) -> bool: ...
    def candidates(self) -> _Integers: ...
    def near(self, pairs: _Integers) -> tuple[_Integers, _Integers]: ...
    def evaluate(
        self, x: _Floats, old: _Floats | None = ..., closed: NDArray[np.bool_] | None = ...
    ) -> _Gaps: ...
    def discrete_gradient(
        self,
        middle: Any,
        end: Any,
        known: NDArray[np.bool_],
        rise: _Floats,
        old: _Floats,
        x: _Floats,
        rounding: float,
    ) -> dict[str, Any]: ...
    def hessian(self, p: _Floats, q: _Floats) -> tuple[_Integers, _Integers, _Floats]: ...
    def hold(self, held: list[bool], rough: bool) -> None: ...
    def carry(self, slave: int | None, master: int | None) -> None: ...
    def commit(self) -> None: ...
    def state(self) -> tuple[_Floats, _Integers, _Floats]: ...
    def restore_state(self, places: _Floats, whole: _Integers, offset: _Floats) -> None: ...
    def forget(self) -> None: ...
    def restore(self) -> None: ...

_Constraints = tuple[
    _Floats,
    _Floats,
    _Floats,
    _Floats,
    _Floats,
    _Floats,
    _Floats | None,
    NDArray[np.bool_] | None,
    _Floats | None,
]

def line_contact(
    reference: _Floats,
    slave: tuple[_Integers, _Floats, _Floats],
    thickness: _Floats,
    points: _Integers,
    master: tuple[_Integers, _Floats, _Floats],
    rigid: tuple[_Floats, int, tuple[float, float], bool] | None = ...,
    *,
    method: str = ...,
    reach: float,
    margin: float,
    depth: float = ...,
) -> Contact: ...

class ContactLaw:
    def __init__(
        self,
        normal: str,
        pressures: list[float],
        overclosures: list[float],
        tangential: str = ...,
        coefficients: list[float] = ...,
        *,
        noise: float = ...,
    ) -> None: ...
    @staticmethod
    def joined(*, noise: float = ...) -> ContactLaw: ...
    @property
    def start(self) -> float: ...
    def curve(self, overclosure: _Floats) -> list[_Floats]: ...
    def pressure(self, gap: _Floats) -> list[_Floats]: ...
    def mean(self, begin: _Floats, end: _Floats) -> tuple[_Floats, _Floats]: ...
    def trial(self, at: _Constraints, p: _Floats) -> tuple[_Floats, _Floats]: ...
    def shear(self, at: _Constraints, q: _Floats) -> _Floats: ...
    def states(
        self, at: _Constraints, p: _Floats, q: _Floats, last: NDArray[np.int8] | None = ...
    ) -> NDArray[np.int8]: ...
    def residual(self, at: _Constraints, p: _Floats, q: _Floats) -> _Floats: ...
    def rows(
        self,
        at: _Constraints,
        p: _Floats,
        q: _Floats,
        states: NDArray[np.int8],
        directions: _Floats,
    ) -> list[_Floats]: ...
    def energy(self, at: _Constraints) -> _Floats: ...

class Problem:
    def __init__(
        self, points: _Floats, blocks: list[dict[str, Any]], extra_dofs: NDArray[np.uint8]
    ) -> None: ...
    @property
    def n_dofs(self) -> int: ...
    @property
    def dof_start(self) -> _Indices: ...
    @property
    def node_of_dof(self) -> _Indices: ...
    @property
    def indptr(self) -> NDArray[np.uint64]: ...
    @property
    def indices(self) -> _Indices: ...
    def set_threads(self, n: int) -> None: ...
    def set_lanes(self, lanes: str) -> int: ...
    def set_active(self, active: list[bool]) -> None: ...
    def assemble(
        self,
        u: _Floats,
        nlgeom: bool,
        force: _Floats,
        scale: _Floats,
        values: _Floats,
        stressed: bool = False,
    ) -> None: ...
    def inertia(
        self,
        u: _Floats,
        v: _Floats,
        a: _Floats,
        kind: str,
        weights: list[float],
        force: _Floats,
        scale: _Floats,
        values: _Floats,
    ) -> None: ...
    def conserving(
        self,
        u: _Floats,
        u0: _Floats,
        v0: _Floats,
        dt: float,
        kind: str,
        nlgeom: bool,
        force: _Floats,
        internal: _Floats,
        scale: _Floats,
        values: _Floats,
    ) -> None: ...
    def start_motion(self, u: _Floats, v: _Floats) -> None: ...
    def kinetic(self, block: int, u: _Floats, v: _Floats, kind: str, carried: bool) -> _Floats: ...
    def momenta(
        self, u: _Floats, v: _Floats, kind: str, carried: bool
    ) -> tuple[float, float, float, float, float]: ...
    def shape(self, block: int) -> _Floats: ...
    def set_initial(self, block: int, values: _Floats) -> None: ...
    def set_temperatures(self, block: int, values: _Floats) -> None: ...
    def set_massless(self, massless: NDArray[np.bool_]) -> None: ...
    def set_mass_factors(self, block: int, factors: _Floats) -> None: ...
    def set_removed(self, removed: list[bool]) -> None: ...
    def renew(self, block: int, u: _Floats) -> None: ...
    def state(self) -> tuple[_Floats, NDArray[np.uint64]]: ...
    def restore_state(self, values: _Floats, lengths: NDArray[np.uint64]) -> None: ...
    def commit(self) -> None: ...
    def plastic_increment(self) -> float: ...
    def creep_error(self) -> float: ...
    def set_clock(self, increment: float, end: float, lasting: bool) -> None: ...
    def strains(self, block: int, u: _Floats, nlgeom: bool, committed: bool) -> _Floats: ...
    def give(self, block: int, values: _Floats) -> None: ...
    def differentiate(
        self,
        u: _Floats,
        nlgeom: bool,
        force: _Floats,
        state: list[_Floats],
        wanted: list[str],
    ) -> dict[str, Any]: ...
    def histories(self, trial: bool) -> list[_Floats]: ...
    def set_histories(self, values: list[_Floats]) -> None: ...
    def sizes(
        self,
        residual: _Floats,
        scale: _Floats,
        external: _Floats,
        u: _Floats,
        held: NDArray[np.bool_],
        balance: bool,
    ) -> tuple[list[float], list[float], list[int], list[float]]: ...
    def multiply(self, values: _Floats, x: _Floats) -> _Floats: ...
    def mask(self, values: _Floats, held: NDArray[np.bool_]) -> None: ...
    def reduce(
        self, values: _Floats, rhs: _Floats, moved: _Floats, held: NDArray[np.bool_]
    ) -> None: ...
    def by_node(self, vector: _Floats) -> _Floats: ...
    def body_force(
        self,
        kind: str,
        value: list[float],
        mass: str,
        masks: list[NDArray[np.bool_]],
        u: _Floats,
        start: _Floats,
        share: float,
        force: _Floats,
        values: _Floats,
    ) -> None: ...
    def recover(self, u: _Floats, nlgeom: bool) -> list[dict[str, Any]]: ...

class EdgeLoads:
    def __init__(
        self,
        points: _Floats,
        nodes: _Indices,
        thickness: _Floats,
        alpha_b: _Floats,
        ring: bool = False,
    ) -> None: ...
    def traction(
        self, u: _Floats, n_nodes: int, t: tuple[float, float]
    ) -> tuple[_Floats, _Indices, _Indices, _Floats]: ...
    def pressure(
        self, u: _Floats, n_nodes: int, p: float
    ) -> tuple[_Floats, _Indices, _Indices, _Floats]: ...

class Ldlt:
    threads: int
    def __init__(self) -> None: ...
    def analyze(
        self,
        indptr: NDArray[np.uintp],
        indices: _Indices,
        node_of_dof: _Indices,
        after: _Indices | None = None,
    ) -> None: ...
    def factorize(self, data: _Floats) -> tuple[int, int, int] | None: ...
    def solve_in_place(self, rhs: _Floats) -> None: ...

def computed_orders() -> int: ...
def place_nodes(solver: Ldlt, points: _Floats) -> None: ...
def factor_size(solver: Ldlt) -> tuple[int, float]: ...

class Lu:
    threads: int
    def __init__(self) -> None: ...
    def analyze(
        self,
        indptr: NDArray[np.uintp],
        indices: _Indices,
        node_of_dof: _Indices,
        after: _Indices | None = None,
    ) -> None: ...
    def factorize(self, data: _Floats) -> tuple[int, int, int] | None: ...
    def solve_in_place(self, rhs: _Floats) -> None: ...

def elements() -> list[dict[str, Any]]: ...
def contact_methods() -> list[dict[str, Any]]: ...
def contact_laws() -> tuple[list[str], list[str]]: ...
def add_contact_forces(
    constraint: _Integers,
    dofs: _Integers,
    gap: _Floats,
    slip: _Floats,
    p: _Floats,
    q: _Floats | None,
    force: _Floats,
    size: _Floats | None = ...,
) -> None: ...
def unilateral(
    states: NDArray[np.int8],
    directions: _Floats,
    friction: _Floats,
    rubs: NDArray[np.bool_],
    normal: _Floats,
    tangent: _Floats,
    start: NDArray[np.int8] | None = ...,
    slides: bool = ...,
) -> tuple[_Floats, NDArray[np.int8], _Floats, _Floats, _Floats] | None: ...
def times_of_crossing(
    first: _Floats,
    last: _Floats,
    ends: _Integers,
    old: _Floats,
    new: _Floats,
    nodes: _Integers,
    outside: _Floats,
    depth: float = ...,
) -> _Floats: ...
def materials() -> list[str]: ...
def require_memory(bytes: float, job: str) -> None: ...
def parse_nodes(
    data: bytes, start: int, stop: int, line: int
) -> tuple[NDArray[np.int64], _Floats, NDArray[np.int64], list[tuple[int, int]]]: ...
def parse_table(
    data: bytes, start: int, stop: int, line: int, width: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], list[tuple[int, int]]]: ...
def parse_reals(data: bytes, start: int, stop: int) -> _Floats | int: ...
def parse_labels(data: bytes, start: int, stop: int, line: int) -> NDArray[np.int64] | None: ...
def register_function(convention: str, address: int) -> int: ...
def material_path(
    law: str,
    parameters: list[float],
    plane_name: str,
    strain: _Floats,
    state: _Floats,
    times: list[float] = ...,
    start: float = ...,
    lasting: bool = ...,
    small: bool = ...,
) -> dict[str, Any]: ...
def strain_measure(name: str, gradient: _Floats, moduli: _Floats) -> dict[str, Any]: ...

"""Analysis steps with their loads, supports and outputs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from corota.arrays import distinct
from corota.display import Brief
from corota.errors import InputError, number
from corota.lazy import lazy
from corota.mesh import selection
from corota.model.element_changes import ElementChange
from corota.model.loading import Loading
from corota.model.loads import LOAD_KINDS, Fixed, check_loads, check_supports, selected
from corota.model.paths import ArcLength, DisplacementControl
from corota.model.settings import Settings
from corota.names import choose, choose_attribute

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats, Ints
    from corota.errors import Location
    from corota.model.loads import Load, LoadKind

    #: Share of critical damping of all modes, or (first, last, share) of ranges of modes.
    ModalDamping = float | Sequence[tuple[int, int, float]]

#: What :meth:`Step.remove` ends.
REMOVED = (
    *("all", *LOAD_KINDS, "traction", "pressure", "shear", "electrostatic"),
    "hydrostatic pressure",
    *("gravity", "centrifugal"),
)
#: Actions at bifurcation points.
AT_BIFURCATION = ("warn", "stop", "follow")
#: Kinds of mass matrices.
MASSES = ("consistent", "constant", "lumped")


#: Frequencies of a harmonic response between two eigenfrequencies.
MOST_POINTS = 1_000_000


@dataclass(repr=False)
class Output(Brief):
    """One print, file or history request.

    Parameters
    ----------
    kind : {"node print", "el print", "contact print", "section print", "node file", ...}
    variables : tuple of str
        Names as in decks: ``U RF S E CSTR ...``.
    where : str
        Node or cell set, or name of a contact pair; empty for all.
    frequency : int
        Every n increments; 0 for the end of the step only.
    every : bool
        Whether all increments count, also those of explicit steps that are no frames otherwise;
        they do with a frequency of 2 or more.
    totals : {"no", "yes", "only"}
        Sums over the set in addition to, or instead of, the rows.
    time_points : str
        Name of a list of times in ``Model.time_points``; empty for none.
    in_global : bool
        Print nodal vectors in global axes also for nodes with local axes.
    """

    kind: Literal[
        "node print",
        "el print",
        "contact print",
        "section print",
        "node file",
        "el file",
        "contact file",
    ]
    variables: tuple[str, ...]
    where: str = ""
    frequency: int = 1
    totals: Literal["no", "yes", "only"] = "no"
    time_points: str = ""
    source: Location | None = field(default=None, compare=False, repr=False)
    in_global: bool = False
    every: bool = False

    @property
    def of_file(self) -> bool:
        """Whether it chooses what goes into result files."""
        return self.kind.endswith(" file")


def in_force(steps: Sequence[Step]) -> list[list[Output]]:
    """Active requests of each step, earlier ones first.

    As in CalculiX: a card kind that the step does not use keeps the requests of the step before;
    one that it uses replaces them.
    """
    found: list[list[Output]] = []
    kept: list[Output] = []
    for step in steps:
        new = {o.kind for o in step.outputs}
        kept = [o for o in kept if o.kind not in new] + list(step.outputs)
        found.append(kept)
    return found


@dataclass(kw_only=True, repr=False)
class Step(Brief, Loading, Settings):
    """Common data of all steps.

    Supports and loads of a step are given by its methods ``fix``, ``force``, ``traction``,
    ``pressure``, ``gravity``, ``centrifugal`` and ``temperature``, as those of a model are.

    Parameters
    ----------
    nlgeom : bool
        Large rotations; otherwise the same elements in a fixed frame. Once on, it stays on in
        later static and dynamic steps. Frequencies without it omit the preload.
    period : float
        Duration of the step [time].
    first_increment, smallest_increment, largest_increment : float
        Increment control [time]; 0 takes the default (period, 1e-6 of it, period).
    fixed_increments : bool
        Never change the increment (``DIRECT``).
    max_increments : int
    supports, loads : list
        Those of this step, beside the model's.
    new_supports : bool
        Remove the supports of earlier steps (``OP=NEW``) instead of adding and modifying; those
        of the model act again. To release some of them see :meth:`release`.
    new_loads : bool or collection of {"force", "distributed", "temperature"}
        Remove the loads of earlier steps: all, or those of some kinds.
    ended : set of {"force", "distributed", "temperature"}
        Kinds of loads that end, those of the model too; see :meth:`remove`.
    element_changes : list of ElementChange
        Elements that leave the structure or join it; see :meth:`remove_elements`.
    outputs : list of Output
    restart : int
        Keep a checkpoint every n increments and at the end of the step; 0 for none.

    Attributes
    ----------
    procedure : str
        Name of what a step of the class runs.
    run : callable
        Function of an :class:`~corota.analysis.increment_loop.IncrementLoop`, the step, and the
        step times at which increments end.
    """

    nlgeom: bool = True
    period: float = 1.0
    first_increment: float = 0.0
    smallest_increment: float = 0.0
    largest_increment: float = 0.0
    fixed_increments: bool = False
    max_increments: int = 1000
    supports: list[Fixed] = field(default_factory=list)
    loads: list[Load] = field(default_factory=list)
    new_supports: bool = False
    new_loads: bool | Collection[LoadKind] = False
    ended: set[LoadKind] = field(default_factory=set)
    element_changes: list[ElementChange] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    restart: int = 0
    name: str = ""
    where: Location | None = field(default=None, compare=False, repr=False)

    procedure: ClassVar[str] = ""
    #: Whether creep and relaxation take part.
    lasting: ClassVar[bool] = False
    run: ClassVar[Callable[..., None]]
    excludes: ClassVar[dict[str, tuple[str, Any]]] = {"first_increment": ("increments", 0)}
    #: Whether the procedure computes velocities and forces of the initial state.
    starts_in_motion = False

    def __post_init__(self) -> None:
        self._kinds()
        check_supports(self.supports, self.where)
        check_loads(self.loads, self.where)
        self.period = number(self.period, "the period of a step", self.where, above=0.0)
        for name in ("first_increment", "smallest_increment", "largest_increment"):
            value = getattr(self, name)
            if not value >= 0.0:
                raise InputError(f"{name} must be >= 0, not {value}", self.where)
        self.first_increment = min(self.first_increment or self.period, self.period)
        self.largest_increment = self.largest_increment or self.period
        self.smallest_increment = self.smallest_increment or min(
            self.first_increment, 1e-6 * self.period
        )
        self._control_numbers()

    def remove_elements(self, cells: str | ArrayLike) -> None:
        """Take elements out of the structure; what they carried fades out over the step.

        Loads on them end too, and nodes without another element stay where they are.

        Parameters
        ----------
        cells : str or array_like of int
            Cell set, or cell indices.
        """
        self.element_changes.append(ElementChange(_cells_of(cells)))

    def add_elements(self, cells: str | ArrayLike, *, strain_free: bool = True) -> None:
        """Put elements back that an earlier step removed.

        Parameters
        ----------
        cells : str or array_like of int
            Cell set, or cell indices.
        strain_free : bool
            Whether they are as new in the shape that their nodes give them; otherwise their
            stress, as if they had always been there, grows over the step.
        """
        self.element_changes.append(ElementChange(_cells_of(cells), True, strain_free))

    def _control_numbers(self) -> None:
        """Check tolerances and counts of the procedures that have them.

        Raises
        ------
        InputError
            If a tolerance is not above 0 and at most 1, or a count is not a whole number in its
            range.
        """
        for name in ("tolerance", "error_tolerance"):
            value = getattr(self, name, 1.0)
            if not (isinstance(value, (int, float)) and 0.0 < value <= 1.0):
                raise InputError(f"{name} must be > 0 and <= 1, not {value!r}", self.where)
        for name, least in (("increments", 0), ("max_increments", 1), ("max_iterations", 1)):
            value = getattr(self, name, least)
            if not (hasattr(value, "__index__") and value >= least):
                raise InputError(
                    f"{name} must be a whole number >= {least}, not {value!r}", self.where
                )

    def _kinds(self) -> None:
        given = self.new_loads
        wanted = (LOAD_KINDS if given else ()) if isinstance(given, bool) else given
        if unknown := set(wanted) - set(LOAD_KINDS):
            raise InputError(
                f"no kind of load {sorted(unknown)[0]!r}; there are {', '.join(LOAD_KINDS)}",
                self.where,
            )
        self.new_loads = frozenset(wanted)

    def _fixes_nothing(self) -> None:
        raise InputError(
            "fix(..., x=None, y=None) of a step fixes nothing; step.release(...) ends a support "
            "of an earlier step or of the model",
            self.where,
        )

    def release(
        self, nodes: str | ArrayLike, *, x: bool = True, y: bool = True, rotation: bool = True
    ) -> None:
        """End a support of an earlier step or of the model.

        Its reactions fade to zero over a static step, and at once in a dynamic one. Nodes that
        another support fixes as well stay with that one.

        Parameters
        ----------
        nodes : str, sequence of str or array_like of int
            The place, as it was given to :meth:`fix`.
        x, y, rotation : bool
            Directions that become free.

        Raises
        ------
        ModelError
            In the run, if there is no support of this place and direction.

        Examples
        --------
        >>> import corota as ct
        >>> step = ct.Static()
        >>> step.release("clamp", x=False)
        >>> [(s.nodes, s.dof, s.free) for s in step.supports]
        [('clamp', 1, True), ('clamp', 2, True)]
        """
        if not (x or y or rotation):
            raise InputError("release(...) releases no direction: x, y or rotation", self.where)
        places = [selected(place, "node", None) for place in selection.names(nodes) or [nodes]]
        for where in places:
            for dof, free in enumerate((x, y, rotation)):
                if free:
                    self.supports.append(Fixed(where, dof, free=True))

    def remove(self, kind: str = "all", at: str | ArrayLike | None = None) -> None:
        """End loads of earlier steps and of the model, as loads of zero do.

        They fall to zero over a static step, and at once in a dynamic one. Loads that the step
        itself defines act. Supports are ended by :meth:`release`.

        Parameters
        ----------
        kind : str
            ``"all"``, or ``"force"`` (with moments), ``"distributed"`` (tractions, pressures,
            shear, gravity, centrifugal forces) or ``"temperature"``, anywhere. With a place also
            ``"traction"``, ``"pressure"``, ``"shear"``, ``"electrostatic"``,
            ``"hydrostatic pressure"``; ``"gravity"`` and ``"centrifugal"`` with an element set or
            without a place.
        at : str or array_like, optional
            Set, or as the method of that load takes it; everywhere by default.

        Raises
        ------
        InputError
            If there is no such kind, or it needs a place.

        Examples
        --------
        >>> import corota as ct
        >>> step = ct.Static()
        >>> step.remove("pressure", "top")
        >>> step.remove("force")
        >>> step.loads[0].value, step.ended
        ((0.0,), {'force'})
        """
        kind = choose(kind, REMOVED, "kind of load", self.where)
        if at is None and kind in ("all", *LOAD_KINDS):
            self.ended |= set(LOAD_KINDS) if kind == "all" else {kind}  # type: ignore[arg-type]
        elif kind == "gravity":
            self.gravity(cells="" if at is None else at)
        elif kind == "centrifugal":
            self.centrifugal(0.0, cells="" if at is None else at)
        elif at is None or kind == "distributed":
            raise InputError(
                f"{kind}: give kind and place, as in remove('pressure', 'top'); without a place "
                f"there are all, {', '.join(LOAD_KINDS)}, gravity and centrifugal",
                self.where,
            )
        elif kind == "force":
            self.force(at)
        elif kind == "temperature":
            self.temperature(0.0, at)
        elif kind == "all":
            self.force(at)
            for name in ("traction", "shear", "pressure", "electrostatic", "hydrostatic pressure"):
                self.remove(name, at)
        elif kind == "hydrostatic pressure":
            self.hydrostatic_pressure(at, 0.0, level=0.0, height=1.0)
        elif kind in ("traction", "electrostatic"):
            getattr(self, kind)(at)
        else:
            getattr(self, kind)(at, 0.0)

    def renews(self, kind: LoadKind) -> bool:
        """Whether the step removes earlier loads of a kind."""
        return not isinstance(self.new_loads, bool) and kind in self.new_loads


def _cells_of(cells: str | ArrayLike) -> str | Ints:
    return cells if isinstance(cells, str) else np.asarray(cells, np.int64)


@dataclass(kw_only=True)
class Static(Step):
    """Static equilibrium under loads that grow with time, by Newton's method.

    Parameters
    ----------
    increments : int, optional
        Start with ``period / increments`` (and grow no further than that).
    ramp : bool
        Loads without amplitude grow linearly over the step; otherwise they act at once.
    tolerance : float
        Largest residual force relative to the force scale of the model, and likewise moments.
    max_iterations : int
        Newton iterations before the increment is cut back.
    path : ArcLength or DisplacementControl, optional
        Follow the equilibrium path instead of raising the load; see :mod:`corota.model.paths`.
        Increments are then arcs, in units in which a linear structure takes one for a load
        factor of one; the first is a twentieth of the period by default.
    at_bifurcation : {"warn", "stop", "follow"}
        Action where an increment of load control ends on an unstable equilibrium, because it passed
        a bifurcation or limit point: accept it with a warning, refuse it and stop before the point,
        or go on by arc length from there, with a switch to the branch that leaves a bifurcation.
    at_limit : {"stop", "follow"}
        Action where load control cannot increase the load further: end there with the
        reason, or continue by arc length until the full load is reached.
    plastic_increment : float
        Largest growth of the equivalent plastic strain at any point in one increment of load
        control; larger increments are cut back. 0 for no limit.
    """

    increments: int = 0
    ramp: bool = True
    tolerance: float = 1e-9
    max_iterations: int = 16
    path: ArcLength | DisplacementControl | None = None
    at_limit: Literal["stop", "follow"] = "stop"
    at_bifurcation: Literal["warn", "stop", "follow"] = "warn"
    plastic_increment: float = 0.0

    procedure = "static"
    run = staticmethod(lazy("corota.analysis.procedures.static:static_step"))

    def __post_init__(self) -> None:
        number(self.plastic_increment, "plastic_increment", self.where, least=0.0)
        choose_attribute(self, "at_limit", ("stop", "follow"), "at_limit", self.where)
        self._control_numbers()
        choose_attribute(self, "at_bifurcation", AT_BIFURCATION, "at_bifurcation", self.where)
        if self.path is not None:
            if not isinstance(self.path, (ArcLength, DisplacementControl)):
                raise InputError(
                    f"path must be an ArcLength or a DisplacementControl, not {self.path!r}",
                    self.where,
                )
            self._path_increments()
            return
        if self.increments:
            self.first_increment = self.period / self.increments
            self.largest_increment = self.largest_increment or self.first_increment
        super().__post_init__()

    def _path_increments(self) -> None:
        """Defaults of arcs: no largest one, and a first one suitable for a limit load."""
        share = 1.0 / self.increments if self.increments else 0.05
        first = self.first_increment or share * self.period
        largest = self.largest_increment or math.inf
        super().__post_init__()
        self.first_increment, self.largest_increment = first, largest
        self.smallest_increment = min(self.smallest_increment, 1e-6 * first)


@dataclass(kw_only=True)
class Visco(Static):
    """Static equilibrium over a time in which materials creep and relax.

    Loads without amplitude act at once, unless ``ramp=True``.

    Parameters
    ----------
    creep_tolerance : float, optional
        Largest error of the creep strain in an increment at any point: the difference between the
        creep by the stress at its start and that of the increment. Larger increments are cut back;
        after smaller errors they grow. By default 0.003 of the largest elastic strain of what
        creeps, unless increments are fixed; 0 for no limit. Of viscoelastic materials it is how far
        the strain bends within the increment, over the largest strain.

    Notes
    -----
    As ``*VISCO, CETOL=``. In other static steps the time only counts for rates of plastic flow.
    """

    ramp: bool = False
    creep_tolerance: float | None = None

    lasting: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if self.path is not None:
            raise InputError("a step of creep follows its time, not a path", self.where)
        if self.creep_tolerance is not None:
            number(self.creep_tolerance, "creep_tolerance", self.where, least=0.0)
        super().__post_init__()


@dataclass(kw_only=True)
class Dynamic(Step):
    """Motion by implicit or explicit time integration.

    Parameters
    ----------
    increments : int, optional
        Fixed increments of ``period / increments``.
    scheme : str
        One of :func:`corota.model.schemes.names`.
    alpha : float
        Of the HHT scheme, -1/3 to 0, and of Bossak's, -1 to 0.
    rho_inf : float
        Of the generalized-alpha scheme, 0 to 1.
    mass : {"consistent", "constant", "lumped"}
        ``central_difference`` is always lumped.
    rayleigh : tuple of float
        Damping per mass [1/time] and per stiffness [time].
    ramp : bool
        Loads without amplitude grow over the step; else (default) they act at once.
    error_tolerance : float
        Local error of an automatic increment, relative to the largest displacement.
    tolerance : float
        Largest residual relative to the force scale.
    max_iterations : int
    redistribute : bool
        Let the other nodes of their elements carry the mass of the slave nodes of contact, so
        that contact neither creates energy nor chatters; see docs/contact.md.
    """

    increments: int = 0
    scheme: str = "hht"
    alpha: float = -0.05
    rho_inf: float = 0.8
    mass: Literal["consistent", "constant", "lumped"] = "consistent"
    rayleigh: tuple[float, float] = (0.0, 0.0)
    ramp: bool = False
    error_tolerance: float = 1e-2
    tolerance: float = 1e-9
    max_iterations: int = 16
    redistribute: bool = True

    procedure = "dynamic"
    run = staticmethod(lazy("corota.analysis.procedures.dynamic:dynamic_step"))
    starts_in_motion = True
    lasting: ClassVar[bool] = True

    def __post_init__(self) -> None:
        self._control_numbers()
        if self.increments:
            self.first_increment = self.period / self.increments
            self.largest_increment = self.first_increment
            self.fixed_increments = True
        if self.max_increments == 1000:
            self.max_increments = 10_000_000
        super().__post_init__()
        from corota.model.schemes import names

        self.scheme = choose(self.scheme, names(), "scheme", self.where)
        choose_attribute(self, "mass", MASSES, "kind of mass", self.where)
        if min(self.rayleigh) < 0.0:
            raise InputError(f"damping must be >= 0, not {self.rayleigh}", self.where)


@dataclass(kw_only=True)
class Buckle(Step):
    """Linear buckling about the state that the steps before reached.

    The tangent is expanded to first order along the linear response to a perturbing
    load; the factors are those at which it becomes singular. The perturbing load is that of
    the step, or the model's own where the step has none; loads of earlier steps remain.

    Parameters
    ----------
    modes : int
        Number of lowest positive factors.
    preload : bool
        Start from the state after the steps before; otherwise from the unloaded structure.
    dead_loads : bool
        Let loads that follow the structure without a potential, as a pressure on the free end of a
        column, keep their directions, as decks have it. By default they are refused.
    """

    modes: int = 1
    preload: bool = True
    dead_loads: bool = field(default=False, compare=False)

    procedure = "buckle"
    run = staticmethod(lazy("corota.analysis.procedures.buckling:buckle_step"))

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.modes < 1:
            raise InputError(f"at least one buckling mode is needed, not {self.modes}", self.where)


@dataclass(kw_only=True)
class Frequency(Step):
    """Natural frequencies and modes about the state that the steps before reached.

    Parameters
    ----------
    modes : int
        Number of modes, from the lowest, or the largest number in a range; 0 for all in the range.
    mass : {"consistent", "constant", "lumped"}
    lowest, highest : float
        Range of frequencies [1/time], of real modes; infinity for no end.
    complex_modes : bool
        Include damping (of materials and dashpots) and, under a centrifugal load, Coriolis forces:
        complex frequencies with rates of growth or decay. Follower loads without
        a potential make frequencies complex in any case.
    rayleigh : tuple of float
        Damping of complex modes per mass [1/time] and per stiffness [time].
    """

    modes: int = 6
    mass: Literal["consistent", "constant", "lumped"] = "consistent"
    complex_modes: bool = False
    rayleigh: tuple[float, float] = (0.0, 0.0)
    lowest: float = 0.0
    highest: float = math.inf

    procedure = "frequency"
    run = staticmethod(lazy("corota.analysis.procedures.frequency:frequency_step"))

    def __post_init__(self) -> None:
        super().__post_init__()
        choose_attribute(self, "mass", MASSES, "kind of mass", self.where)
        if not 0.0 <= self.lowest < self.highest:
            text = f"a range of frequencies must rise from 0, not {self.lowest} to {self.highest}"
            raise InputError(text, self.where)
        if self.complex_modes and (self.lowest, self.highest) != (0.0, math.inf):
            raise InputError("complex modes are found by number, not by range", self.where)
        if self.modes < (1 if self.highest == math.inf else 0):
            raise InputError(f"at least one mode is needed, not {self.modes}", self.where)


@dataclass(kw_only=True)
class ModalDynamic(Step):
    """Linear transient about a state, by superposition of the modes of a frequency step.

    Parameters
    ----------
    increments : int
        Increments over the period; loads vary linearly within each.
    damping : float or sequence of tuple
        Share of critical damping of every mode; or ``(first, last, share)`` for ranges of modes,
        counted from 1. Modes in no range have none.
    rayleigh : tuple of float
        Damping per mass [1/time] and per stiffness [time], added.
    residual : bool
        Add a residual mode for each pattern of loads and moving supports: with them the static
        response is exact with any number of modes.
    """

    increments: int = 0
    damping: ModalDamping = 0.0
    rayleigh: tuple[float, float] = (0.0, 0.0)
    ramp: bool = False
    residual: bool = False

    procedure = "modal dynamic"
    run = staticmethod(lazy("corota.analysis.procedures.modal:modal_step"))

    def __post_init__(self) -> None:
        if self.increments:
            self.first_increment = self.period / self.increments
        if self.max_increments == 1000:
            self.max_increments = 10_000_000
        super().__post_init__()
        check_damping(self.damping, self.rayleigh, self.where)


@dataclass(kw_only=True)
class SteadyState(Step):
    """Harmonic response about a state, by superposition of modes or of the whole model.

    Amplitudes of loads and moving supports are tables over the frequency.

    Parameters
    ----------
    lowest, highest : float
        Range of frequencies [1/time].
    points : int
        Frequencies between neighboring eigenfrequencies, ends included.
    bias : float
        Above 1 they crowd near the eigenfrequencies: those of an interval stand at
        ``sign(t) |t|**(1 / bias)`` with evenly spaced t from -1 to 1. Without modes they are even.
    damping : float or sequence of tuple
        Share of critical damping of every mode, or of ranges of modes (see `ModalDynamic`).
    rayleigh : tuple of float
        Damping per mass [1/time] and per stiffness [time], added.
    residual : bool
        Add residual modes (see `ModalDynamic`).
    direct : bool
        Solve the equations of the whole model at each frequency; modes are not needed, and without
        them `points` are spread over the whole range.
    mass : {"consistent", "constant", "lumped"}
        Of the whole model; modes have that of their own step.
    imaginary_loads, imaginary_supports : list
        Loads, and motions of supports, that act a quarter of a period ahead of the others.
    """

    lowest: float
    highest: float
    points: int = 20
    damping: ModalDamping = 0.0
    rayleigh: tuple[float, float] = (0.0, 0.0)
    ramp: bool = False
    residual: bool = False
    bias: float = 3.0
    direct: bool = False
    mass: Literal["consistent", "constant", "lumped"] = "consistent"
    imaginary_loads: list[Load] = field(default_factory=list)
    imaginary_supports: list[Fixed] = field(default_factory=list)

    procedure = "steady state"
    run = staticmethod(lazy("corota.analysis.procedures.harmonic:steady_state_step"))

    def __post_init__(self) -> None:
        super().__post_init__()
        choose_attribute(self, "mass", MASSES, "kind of mass", self.where)
        check_supports(self.imaginary_supports, self.where)
        check_loads(self.imaginary_loads, self.where)
        if not 0.0 <= self.lowest < self.highest:
            raise InputError(
                f"the range of frequencies must increase, not {self.lowest} to {self.highest}",
                self.where,
            )
        if not 1 <= self.points <= MOST_POINTS:
            raise InputError(
                f"between two eigenfrequencies there are 1 to {MOST_POINTS:,} frequencies, not "
                f"{self.points:,}",
                self.where,
            )
        number(self.bias, "bias", self.where, above=0.0)
        check_damping(self.damping, self.rayleigh, self.where)
        if self.direct and (self.residual or _any_share(self.damping)):
            raise InputError(
                "direct=True uses no modes, so modal damping has no effect; give damping by "
                "rayleigh=, materials or dashpots",
                self.where,
            )

    def sweep(self, own: Floats) -> Floats:
        """Frequencies of the response, refined between eigenfrequencies."""
        import numpy as np

        inside = own[(own > self.lowest) & (own < self.highest)]
        marks = distinct([self.lowest, *inside, self.highest])
        t = np.linspace(-1.0, 1.0, self.points)
        if len(own):
            t = np.sign(t) * np.abs(t) ** (1.0 / self.bias)
        inner = [(a + b) / 2.0 + (b - a) / 2.0 * t[1:-1] for a, b in pairwise(marks)]
        return distinct(np.concatenate([marks, *inner]))


def listed_steps(steps: object) -> list[Step]:
    """Steps as a list, from one step or several.

    Raises
    ------
    InputError
        If something is no step, such as a class that was not called.
    """
    if isinstance(steps, Step):
        return [steps]
    found: list[Any] = list(steps) if isinstance(steps, Iterable) else [steps]
    for item in found:
        if isinstance(item, type) and issubclass(item, Step):
            raise InputError(f"{item.__name__} is a class: write {item.__name__}()")
        if not isinstance(item, Step):
            raise InputError(
                f"a step is Static(...), Dynamic(...), ..., or a list of them, not {item!r}"
            )
    return found


def check_damping(
    given: ModalDamping, rayleigh: tuple[float, float], where: Location | None
) -> None:
    """Refuse damping of modes that is negative or has invalid ranges.

    Raises
    ------
    InputError
        With the cause.
    """
    if min(rayleigh) < 0.0:
        raise InputError(f"damping must be >= 0, not {rayleigh}", where)
    if isinstance(given, (int, float)):
        if not 0.0 <= given < math.inf:
            raise InputError(f"the damping of modes must be >= 0, not {given}", where)
        return
    for item in given:
        if len(item) != 3 or not (1 <= item[0] <= item[1] and 0.0 <= item[2] < math.inf):
            raise InputError(
                f"a range of damping is (first mode, last mode, share >= 0), not {item!r}", where
            )


def _any_share(given: ModalDamping) -> bool:
    if isinstance(given, (int, float)):
        return given != 0.0
    return any(item[2] != 0.0 for item in given)

"""Data of single cards: nodes, sets, sections and loads, with names not yet resolved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from corota.errors import Location
from corota.io.deck.card import Card, Refused, Row, key
from corota.model.friction import Friction, largest

if TYPE_CHECKING:
    from collections.abc import Iterable

    from corota.arrays import Floats, Ints
    from corota.model.loads import LoadKind
    from corota.model.materials import Elastic, Expansion
    from corota.model.rates import Norton
    from corota.model.steps import Output, Step
    from corota.model.viscoelastic import WLF

    #: Numbers of steps.
    Numbers = tuple[int, ...]


#: Degrees of freedom of decks in the plane, and their index here.
PLANAR = {1: 0, 2: 1, 6: 2}


@dataclass(eq=False, repr=False)
class NodeBlock:
    """Nodes of consecutive lines: labels (n,), coordinates (n, 3), line numbers (n,)."""

    labels: Ints
    points: Floats
    file: str
    lines: Ints


@dataclass(eq=False, repr=False)
class ElementBlock:
    """Elements of one type: labels (n,), node labels (n, k), line numbers (n,)."""

    card: Card
    type: str
    labels: Ints
    nodes: Ints
    file: str
    lines: Ints


@dataclass(eq=False, repr=False)
class Entry:
    """Labels, or the name of another set, in a set."""

    where: Location
    labels: Ints
    name: str = ""


@dataclass(eq=False, repr=False)
class NamedSet:
    """A node or element set: entries in the user's order."""

    name: str
    where: Location
    entries: list[Entry] = field(default_factory=list)


@dataclass(eq=False, repr=False)
class SurfaceRow:
    """One line of a surface: element label or set, and a face such as ``S2``."""

    card: Card
    where: Location
    text: str
    target: str
    face: str

    def refuse(self, message: str, hint: str = "") -> NoReturn:
        """Record an error; see :meth:`corota.io.deck.card.Row.refuse`."""
        self.card.deck.error(self.card, self.where, message, text=self.text, hint=hint)
        raise Refused


@dataclass(eq=False, repr=False)
class Surface:
    """A surface of element edges, of nodes, or a rigid profile.

    ``profile`` has rows x0, y0, x1, y1, cx, cy, sweep in the deck's order.
    """

    name: str
    card: Card
    nodes: bool
    rows: list[SurfaceRow] = field(default_factory=list)
    #: How surfaces, one in each row, make this one.
    combine: str = ""
    profile: Floats | None = None
    fillet: float = 0.0


@dataclass(eq=False, repr=False)
class DistributionDraft:
    """One ``*DISTRIBUTION``: lines of an element or set, blank for all, and its values."""

    name: str
    card: Card
    rows: list[Row]


@dataclass(eq=False, repr=False)
class SectionDraft:
    """One ``*SOLID SECTION``."""

    card: Card
    elset: str
    material: str
    thickness: float
    plane: str
    #: Empty where the dialect and the material decide.
    local_strain: str
    orientation: str
    mean_dilatation: bool = False
    beta0: float | None = None
    #: Whether ``*NODAL THICKNESS`` gives the thickness.
    nodal: bool = False
    #: Whether any thickness is given.
    given: bool = True
    #: Distribution of the thickness by element.
    thicknesses: str = ""


@dataclass(eq=False, repr=False)
class PlasticDraft:
    """Numbers of ``*PLASTIC`` and ``*CYCLIC HARDENING``; ``ready`` is false after an error."""

    card: Card | None = None
    kind: str = "ISOTROPIC"
    ready: bool = True
    curves: list[CurveDraft] = field(default_factory=list)
    cyclic_card: Card | None = None
    cyclic: list[CurveDraft] | None = None
    #: Whether rows are stresses of a test, as in Abaqus; in CalculiX the back-stress grows by them.
    of_test: bool = False
    #: Curves by rate of the plastic strain, where ``RATE=`` is given.
    rated: list[tuple[float, list[tuple[float, float]]]] = field(default_factory=list)


@dataclass(eq=False, repr=False)
class CurveDraft:
    """Yield stress against plastic strain at one temperature, with the places of the rows.

    ``back`` holds the back-stresses, ``voce`` Q and b, where they are given by parameters.
    """

    temperature: float
    points: list[tuple[float, float]]
    rows: list[Location]
    back: list[tuple[float, float]] = field(default_factory=list)
    voce: tuple[float, float] | None = None


@dataclass(eq=False, repr=False)
class MaterialDraft:
    """One ``*MATERIAL`` with the numbers of the cards below it."""

    name: str
    card: Card
    law: str = ""
    #: Constants of the law by temperature.
    constants: list[tuple[float, list[float]]] = field(default_factory=list)
    law_where: Location | None = None
    law_card: Card | None = None
    rho: float = 0.0
    #: Densities by temperature, where there are several.
    densities: list[tuple[float, float]] = field(default_factory=list)
    damping: tuple[float, float] = (0.0, 0.0)
    plastic: PlasticDraft | None = None
    expansion: float | Expansion = 0.0
    #: Rate of plastic flow (of Johnson-Cook C and a rate), with its card; creep by temperature.
    rate: Any = None
    rate_card: Card | None = None
    creep: list[tuple[float, Norton]] = field(default_factory=list)
    #: Numbers of Johnson-Cook hardening, and of its heat.
    johnson_cook: list[float] | None = None
    johnson_cook_card: Card | None = None
    #: State variables of a user subroutine.
    states: int = 0
    specific_heat: float = 0.0
    #: Ratios of Hill's yield function, with their card.
    potential: tuple[float, ...] = ()
    potential_card: Card | None = None
    #: Terms of a Prony series with its card, its shift, and what the constants are.
    prony: list[tuple[float, float, float]] = field(default_factory=list)
    prony_card: Card | None = None
    shift: WLF | None = None
    moduli: str = "LONGTERM"
    heat_fraction: float = 0.0
    #: r, m and beta of the softening of rubber, with their card.
    softening: tuple[float, float, float] | None = None
    softening_card: Card | None = None
    #: Kind, number of terms and Poisson's ratio of a hyperelastic law that is fitted to `tests`.
    fit: tuple[str, int, float] | None = None
    tests: dict[str, list[tuple[float, float]]] = field(default_factory=dict)

    @property
    def follows_temperature(self) -> bool:
        """Whether its law or its density is given at several temperatures."""
        counts = [len(self.constants), len(self.densities)]
        if self.plastic is not None:
            counts += [len(self.plastic.curves), len(self.plastic.cyclic or ())]
        if self.johnson_cook is not None and self.johnson_cook[4] > self.johnson_cook[5]:
            return True
        if self.shift is not None:
            return True
        counts.append(len(self.creep))
        return max(counts) > 1


@dataclass(eq=False, repr=False)
class Draft:
    """One data line of a support or a load, its target not yet looked up.

    ``kind`` is ``fixed``, ``force``, ``pressure``, ``surface pressure``,
    ``surface traction``, ``gravity`` or ``centrifugal``; ``index`` the degree of freedom
    (from 0) or the face (from 0).
    """

    kind: str
    row: Row
    target: str
    value: tuple[float, ...]
    index: int = -1
    silent: bool = False
    #: Of a support: how often its value is integrated over time, and whether it stays where it is.
    order: int = 0
    keep: bool = False

    @property
    def card(self) -> Card:
        """Card of the line."""
        return self.row.card

    @property
    def amplitude(self) -> str:
        """Name of its amplitude, empty without one."""
        return "" if self.kind == "nothing" else self.card.value("AMPLITUDE")


@dataclass(eq=False, repr=False)
class InitialDraft:
    """A line of initial temperature or stress; ``point`` from 1, 0 for all."""

    draft: Draft
    point: int = 0


@dataclass(eq=False, repr=False)
class StepDraft:
    """One step as written."""

    card: Card
    nlgeom: bool
    max_increments: int
    ramp: bool
    procedure: Card | None = None
    times: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 0.0)
    direct: bool = False
    make: type[Step] | None = None
    options: dict[str, Any] = field(default_factory=dict)
    supports: list[Draft] = field(default_factory=list)
    loads: list[Draft] = field(default_factory=list)
    new_supports: bool = False
    new_loads: set[LoadKind] = field(default_factory=set)
    #: Whether it is a static load case of the structure without load.
    perturbs: bool = False
    #: Kinds of conditions that cards of the step gave so far.
    said: set[str] = field(default_factory=set)
    #: Motions of all supports in a direction.
    base_motions: list[Draft] = field(default_factory=list)
    #: Lines of ``*MODEL CHANGE, TYPE=ELEMENT``; ``index`` is 1 where they join without strain, 2
    #: where they join with it, 0 where they leave.
    element_changes: list[Draft] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    frequency: int = 1
    #: Increments between checkpoints that are kept, 0 for none.
    restart: int = 0
    #: For frequencies: whether stresses and displacements of earlier steps count; else None.
    preload: bool | None = None


@dataclass(eq=False, repr=False)
class Instance:
    """A part placed in the plane: shift, then turn by ``angle`` about ``center``."""

    name: str
    part: str
    card: Card
    shift: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    center: tuple[float, float] = (0.0, 0.0)
    scope: Scope = field(default_factory=lambda: Scope())


@dataclass(eq=False, repr=False)
class Scope:
    """One name space: the flat model, a part, or an instance's own data."""

    name: str = ""
    nodes: list[NodeBlock] = field(default_factory=list)
    elements: list[ElementBlock] = field(default_factory=list)
    nsets: dict[str, NamedSet] = field(default_factory=dict)
    elsets: dict[str, NamedSet] = field(default_factory=dict)
    surfaces: dict[str, Surface] = field(default_factory=dict)
    sections: list[SectionDraft] = field(default_factory=list)
    lines: list[LineDraft] = field(default_factory=list)
    orientations: dict[str, float] = field(default_factory=dict)
    distributions: dict[str, DistributionDraft] = field(default_factory=dict)
    #: Orientations by element: card, distribution, and an angle more [rad].
    axes_by_element: dict[str, tuple[Card, str, float]] = field(default_factory=dict)

    def add_node(self, point: Floats, where: Location, scopes: Iterable[Scope] = ()) -> int:
        """Add a node under the first number that this scope and others leave free."""
        blocks = [block for scope in scopes or (self,) for block in scope.nodes]
        label = 1 + max(int(b.labels.max(initial=0)) for b in blocks)
        labels, lines = np.array([[label], [where.line]], np.int64)
        self.nodes.append(NodeBlock(labels, point, where.file, lines))
        return label

    def joined(self, own: Scope) -> Scope:
        """The data of a part with those that one of its instances adds."""
        return Scope(
            self.name,
            self.nodes + own.nodes,
            self.elements + own.elements,
            {**self.nsets, **own.nsets},
            {**self.elsets, **own.elsets},
            {**self.surfaces, **own.surfaces},
            self.sections + own.sections,
            self.lines + own.lines,
            {**self.orientations, **own.orientations},
            {**self.distributions, **own.distributions},
            {**self.axes_by_element, **own.axes_by_element},
        )


@dataclass(eq=False, repr=False)
class AttachedDraft:
    """One ``*ELEMENT`` card of point masses, dashpots or gaps.

    Parameters
    ----------
    name : str
        Its element set.
    nodes : list of list of Draft
        For each element its nodes, not yet looked up.
    labels : list of int
        Numbers of the elements.
    numbers : list of list of int
        The same nodes by number, as in an :class:`ElementBlock`.
    value : tuple of float
        Empty until the card with the numbers is read: mass, damping with its dofs, or clearance and
        direction.
    table : tuple of (float, float)
        Velocities and forces of a nonlinear dashpot.
    scope : Scope
        Where the card stands.
    """

    type: str
    name: str
    card: Card
    nodes: list[list[Draft]] = field(default_factory=list)
    labels: list[int] = field(default_factory=list)
    numbers: list[list[int]] = field(default_factory=list)
    value: tuple[float, ...] = ()
    table: tuple[tuple[float, float], ...] = ()
    scope: Scope = field(default_factory=lambda: Scope())
    connector: ConnectorDraft | None = None
    #: Driven components: place of the element, component, first card, the node of its motion.
    controls: list[tuple[int, int, Draft, Draft]] = field(default_factory=list)


@dataclass(eq=False, repr=False)
class ConnectorDraft:
    """One ``*CONNECTOR SECTION``: what it connects, its behavior, and angle of its directions."""

    card: Card
    rows: list[Row]
    kinds: tuple[str, ...] = ()
    behavior: BehaviorDraft | None = None
    angle: float = 0.0


@dataclass(eq=False, repr=False)
class BehaviorDraft:
    """One ``*CONNECTOR BEHAVIOR``: lines of springs, cards of dampers by component (1, 2, 6).

    ``rigid`` are the locked components.
    """

    name: str
    card: Card
    elastic: dict[int, list[Row]] = field(default_factory=dict)
    damped: dict[int, Card] = field(default_factory=dict)
    rigid: set[int] = field(default_factory=set)
    stops: dict[int, tuple[float, float]] = field(default_factory=dict)


@dataclass(eq=False, repr=False)
class ReleaseDraft:
    """A line of ``*RELEASE``: the end (0 or -1) of beams that carries no moment."""

    row: Row
    scope: Scope
    end: int


@dataclass(eq=False, repr=False)
class InteractionDraft:
    """One ``*SURFACE INTERACTION`` with the cards below it.

    ``law`` is a name of :data:`LAWS`; ``pressure`` and ``overclosure`` its numbers.
    """

    name: str
    card: Card
    law: str = "HARD"
    law_where: Location | None = None
    pressure: list[float] = field(default_factory=list)
    overclosure: list[float] = field(default_factory=list)
    friction: Friction = 0.0
    #: Coefficients that begin with steps, and whether they are reached at the end of the step.
    friction_steps: dict[int, Friction] = field(default_factory=dict)
    friction_ramps: bool = False
    #: Largest shear traction, and whether what has met separates.
    shear_limit: float | None = None
    separates: bool = True
    #: ``*CONTACT DAMPING`` by a fraction of the critical one.
    damping: Card | None = None
    #: Interactions with other laws that begin with steps.
    later: dict[int, InteractionDraft] = field(default_factory=dict)

    def spans(
        self, steps: int, acts: Numbers | None
    ) -> list[tuple[InteractionDraft, Numbers | None]]:
        """The interaction of each law, and the steps among `acts` (None: all) in which it holds."""
        if not self.later:
            return [(self, acts)]
        among = range(1, steps + 1) if acts is None else acts
        laws = {1: self, **self.later}
        ends = [*sorted(laws)[1:], steps + 1]
        spans = [
            (laws[first], tuple(k for k in among if first <= k < end))
            for first, end in zip(sorted(laws), ends, strict=True)
        ]
        return [(law, numbers) for law, numbers in spans if numbers]

    @property
    def rubs(self) -> bool:
        """Whether it has friction in any step."""
        return max(map(largest, (self.friction, *self.friction_steps.values()))) > 0.0


@dataclass(eq=False, repr=False)
class PairDraft:
    """One line of ``*CONTACT PAIR`` or ``*TIE``: slave, master and options."""

    row: Row
    slave: str
    master: str
    tied: bool = False
    interaction: str = ""
    method: str = "mortar"
    start: str = "keep"
    adjust: float = 0.0
    adjust_set: str = ""
    clearance: float | None = None
    #: First step that is damped, 0 for none.
    stabilize: int = 0
    smooth: bool = False
    name: str = ""
    #: Steps from which on the pair acts or does not.
    changes: dict[int, bool] = field(default_factory=dict)

    def acts(self, steps: int) -> tuple[int, ...] | None:
        """Steps in which it acts; None for all."""
        if not self.changes:
            return None
        on = [max((n for n in self.changes if n <= k), default=0) for k in range(1, steps + 1)]
        return tuple(k for k, n in enumerate(on, start=1) if self.changes.get(n, True))

    def joins(self, slave: str, master: str) -> bool:
        """Whether these are its surfaces."""
        return (key(self.slave), key(self.master)) == (key(slave), key(master))


@dataclass(eq=False, repr=False)
class GeneralDraft:
    """General contact: which outer edges take part, or the pairs of its lines.

    ``included``, ``excluded``, ``properties`` and ``starts`` are lines with two surfaces; a blank
    one stands for all outer edges.
    """

    card: Card
    every: bool = False
    pairs: list[Row] = field(default_factory=list)
    included: list[Row] = field(default_factory=list)
    excluded: list[Row] = field(default_factory=list)
    properties: list[Row] = field(default_factory=list)
    starts: list[Row] = field(default_factory=list)
    interaction: str = ""
    stabilize: int = 0
    where: Location | None = None
    #: Step that it begins in, from 1.
    step: int = 0


@dataclass(eq=False, repr=False)
class StartDraft:
    """One ``*CONTACT INITIALIZATION DATA``: what becomes of overlaps and gaps at the start."""

    name: str
    card: Card
    start: str = "adjust"
    adjust: float = 0.0
    clearance: float | None = None


@dataclass(eq=False, repr=False)
class LineDraft:
    """A section of line elements: ``role`` is ``beam`` or ``spring``."""

    role: str
    card: Card
    elset: str
    material: str = ""
    elastic: Elastic | None = None
    profile: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Distance, area and initial stress of the fibers of a beam.
    fibers: tuple[tuple[float, float, float], ...] = ()
    #: Distance of the outer fibers from the axis, 0 if they are not alike.
    fiber: float = 0.0
    rows: list[Row] = field(default_factory=list)
    height: float = 0.0
    #: Shear modulus times shear area, 0 where they follow from shape and material.
    shear_stiffness: float = 0.0


@dataclass(eq=False, repr=False)
class PretensionDraft:
    """One section: its surface, its node, and the normal, if it is given."""

    card: Card
    surface: str
    node: Draft
    normal: tuple[float, float] | None = None


@dataclass(eq=False, repr=False)
class TieDraft:
    """One constraint as written.

    ``kind`` is ``equation``, ``kinematic``, ``distributing``, ``same``, ``straight`` or ``axes``.
    ``terms`` holds the terms of an equation, the nodes of a straight line; the first one the
    reference node of a coupling.
    """

    kind: str
    card: Card
    where: Location
    terms: list[Draft] = field(default_factory=list)
    target: Draft | None = None
    surface: str = ""
    elset: str = ""
    dofs: tuple[int, ...] = (0, 1, 2)
    #: Nodes and their weights, where a card lists them.
    members: list[tuple[Draft, float]] = field(default_factory=list)
    #: Distance from the reference node within which nodes of a surface take part.
    radius: float = math.inf
    angle: float = 0.0
    center: tuple[float, float] | None = None
    ready: bool = False

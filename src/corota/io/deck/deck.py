"""The contents of the cards of a deck, before names and numbers are resolved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

from corota.errors import Diagnostic, Location
from corota.io.deck import numerals
from corota.io.deck.card import Card, Row, key
from corota.io.deck.drafts import (
    AttachedDraft,
    BehaviorDraft,
    ConnectorDraft,
    Draft,
    GeneralDraft,
    InitialDraft,
    Instance,
    InteractionDraft,
    MaterialDraft,
    PairDraft,
    PretensionDraft,
    ReleaseDraft,
    Scope,
    StartDraft,
    StepDraft,
    TieDraft,
)
from corota.io.deck.lexer import Lexer

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable

    from corota.arrays import Floats, Ints
    from corota.io.deck.amplitudes import Curve
    from corota.model.loads import Amplitude

    #: Enters the data of cards into the model: a function of targets, which know decks, and data.
    Build = Callable[[Any, list[Any]], None]

Number = TypeVar("Number", int, float)
#: When cards enter their data: :meth:`Deck.later`.
Stage = Literal["mesh", "sections", "model"]

#: What follows from elements that were refused.
FOLLOWS = (
    r"no (element set|surface|set|node set) named|element (set )?\S+ |elements? .* not defined|"
    r"the deck has no elements|surface \S+ (cannot|has no)|either NSET|.* elements of curves only"
)
#: Diagnostics kept; the rest is counted only.
MAX_DIAGNOSTICS = 200


@dataclass(eq=False, repr=False)
class Deck:
    """All data read so far, and all errors found."""

    lenient: bool = False
    #: Program that the deck was written for: ``calculix`` or ``abaqus``.
    dialect: str = "calculix"
    #: Whether a card or comment says so: decks without cards of Abaqus count as CalculiX's, too.
    of_calculix: bool = False
    #: Field variables by number; ``None`` for those that are not constant.
    fields: dict[int, float | None] = field(default_factory=dict)
    #: Element and plane (or "") by the deck's name of an element.
    element_map: dict[str, tuple[str, str]] = field(default_factory=dict)
    literal: bool = False
    #: Library that ``*USER MATERIAL`` may load.
    library: str | os.PathLike[str] | None = None
    #: Says which files the deck may read.
    lexer: Lexer | None = None
    root: Scope = field(default_factory=Scope)
    parts: dict[str, Scope] = field(default_factory=dict)
    instances: dict[str, Instance] = field(default_factory=dict)
    materials: dict[str, MaterialDraft] = field(default_factory=dict)
    amplitudes: dict[str, Amplitude] = field(default_factory=dict)
    #: Amplitudes without an end, sampled when the steps are known.
    curves: dict[str, Curve] = field(default_factory=dict)
    time_points: dict[str, Floats] = field(default_factory=dict)
    supports: list[Draft] = field(default_factory=list)
    steps: list[StepDraft] = field(default_factory=list)
    heading: list[str] = field(default_factory=list)
    damping: tuple[float, float] = (0.0, 0.0)
    controls: dict[str, float] = field(default_factory=dict)
    #: Reference nodes whose rotation no coupling carries on.
    without_moment: set[int] = field(default_factory=set)
    #: Whether a card turns on NLGEOM in all steps that do not say otherwise.
    nonlinear: list[str] = field(default_factory=list)
    #: Whether the model is built: all cards are read.
    building: bool = False
    #: Refused element types: references to their elements are not reported again.
    refused_types: set[str] = field(default_factory=set)
    #: Nodes of instances that elements of the assembly name, as they are written.
    instance_nodes: list[str] = field(default_factory=list)
    #: Origin and axes (rows) of ``*SYSTEM``.
    system: tuple[Floats, Floats] | None = None
    #: Lines of ``*NODAL THICKNESS``.
    thicknesses: list[Draft] = field(default_factory=list)
    releases: list[ReleaseDraft] = field(default_factory=list)
    #: Amplitudes whose values are those of the loads.
    absolute: set[str] = field(default_factory=set)
    initial: list[InitialDraft] = field(default_factory=list)
    ties: list[TieDraft] = field(default_factory=list)
    attached: list[AttachedDraft] = field(default_factory=list)
    #: Read the values of attached elements, when all elements are known.
    properties: list[Callable[[], None]] = field(default_factory=list)
    connectors: list[ConnectorDraft] = field(default_factory=list)
    #: Motions and loads of connectors, each with the index of its step.
    drives: list[tuple[int, Draft]] = field(default_factory=list)
    #: ``*CONNECTOR BEHAVIOR`` by name, and the last one.
    behaviors: dict[str, BehaviorDraft] = field(default_factory=dict)
    behavior: BehaviorDraft | None = None
    #: Index in the model's point masses by the number of the attached element, from 0.
    masses: dict[int, int] = field(default_factory=dict)
    rotation_nodes: dict[str, str] = field(default_factory=dict)
    pairs: list[PairDraft] = field(default_factory=list)
    interactions: dict[str, InteractionDraft] = field(default_factory=dict)
    general: GeneralDraft | None = None
    #: ``*CONTACT INITIALIZATION DATA`` by name.
    starts: dict[str, StartDraft] = field(default_factory=dict)
    #: Reference nodes of distributing couplings, by the set of their elements.
    couplers: dict[str, Draft] = field(default_factory=dict)
    pretensions: list[PretensionDraft] = field(default_factory=list)
    #: Node sets whose members keep their order in ``*EQUATION``.
    unsorted: set[str] = field(default_factory=set)
    carriers: list[tuple[Card, Draft | None]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    hidden: int = 0
    scope: Scope = field(default_factory=Scope)
    #: Increments between checkpoints in the steps that follow, 0 for none.
    restart: int = 0
    #: What cards do to the model: data by stage of the build and function; see :meth:`later`.
    builds: dict[tuple[Stage, Build], list[Any]] = field(default_factory=dict)
    step: StepDraft | None = None
    material: MaterialDraft | None = None
    instance: Instance | None = None
    interaction: InteractionDraft | None = None
    #: Interaction whose friction the next ``*FRICTION`` changes.
    changed: InteractionDraft | None = None
    in_assembly: bool = False

    def __post_init__(self) -> None:
        self.scope = self.root

    @property
    def has_contact(self) -> bool:
        """Whether any card defines contact, or a part of it that may be unused."""
        general = self.general is not None
        return general or bool(self.pairs or self.interactions or self.carriers)

    def later(self, stage: Stage, build: Build, data: Any) -> None:
        """Let a function enter data of a card into the model when sets and meshes are known.

        Parameters
        ----------
        stage : {"mesh", "sections", "model"}
            When the mesh is made; when it has sections, before ties and contact; when everything
            but steps and initial stresses is there.
        build : callable
            Takes :class:`~corota.io.deck.build.targets.Targets` and the data of all such cards in
            their order. It is called once; a function of a module, not one made by each card.
        data : object
            Such as a :class:`~corota.io.deck.drafts.Draft`.
        """
        self.builds.setdefault((stage, build), []).append(data)

    @property
    def n_errors(self) -> int:
        """Number of errors found."""
        return sum(d.severity == "error" for d in self.diagnostics)

    def error(
        self,
        card: Card | None,
        where: Location | None,
        message: str,
        *,
        text: str | None = None,
        hint: str = "",
        severity: str = "error",
    ) -> None:
        """Record an error, or a warning; reading continues."""
        if severity == "error" and len(self.diagnostics) >= MAX_DIAGNOSTICS:
            self.hidden += 1
            return
        if text is None:
            text = card.text if card and where and where.line == card.where.line else ""
        if len(text) > 160:
            text = text[:157] + "..." if not where or where.column <= 157 else ""
        if self.refused_types and self.building and re.match(FOLLOWS, message):
            return  # the elements were refused; references to them are not reported again
        name = numerals.clipped(card.spelled, 60) if card else ""
        message, hint = numerals.clipped(message), numerals.clipped(hint)
        found = Diagnostic(severity, message, where, name, text, hint)
        # Errors of a part with several instances are reported once.
        if found not in self.diagnostics:
            self.diagnostics.append(found)

    def turned(self, target: str) -> str | None:
        """Reference node whose rotation a rotation node is; ``target`` is it, or a set of it."""
        found = self.scope.nsets.get(key(target))
        if found is not None and len(found.entries) == 1 and len(found.entries[0].labels) == 1:
            target = str(found.entries[0].labels[0])
        return self.rotation_nodes.get(key(target))

    def note(self, text: str) -> None:
        """Note what was ignored, repaired or assumed, once."""
        text = numerals.clipped(text)
        if text not in self.notes:
            self.notes.append(text)

    def node(self, row: Row, index: int, what: str) -> int | None:
        """Number of a node; of ``INSTANCE.12`` a negative one, see ``instance_nodes``."""
        text = row.get(index)
        instance, dot, label = text.rpartition(".")
        if not dot or key(instance) not in self.instances or not numerals.is_label(label):
            return row.integer(index, what)
        self.instance_nodes.append(text)
        return -len(self.instance_nodes)


def int_array(values: Iterable[int]) -> Ints:
    """Array of whole numbers."""
    return np.fromiter(values, dtype=np.int64)

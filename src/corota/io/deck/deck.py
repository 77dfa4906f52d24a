"""The contents of the cards of a deck, before names and numbers are resolved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

from corota.errors import Diagnostic, Location
from corota.io.deck import numerals
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
from corota.io.deck.lexer import Card, Lexer, Row, key

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
    carriers: dict[str, tuple[Card, Draft | None]] = field(default_factory=dict)
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

    def row_error(self, card: Card, row: Row, index: int, message: str, hint: str = "") -> None:
        """Record an error at a field of a data line."""
        self.error(card, row.at(index), message, text=row.text, hint=hint)

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

    def real(
        self, card: Card, row: Row, index: int, what: str, default: float | None = None
    ) -> float | None:
        """Value of a field; an empty one is the default; ``None`` after an error."""
        return self._field(card, row, index, what, default, numerals.real)

    def integer(
        self, card: Card, row: Row, index: int, what: str, default: int | None = None
    ) -> int | None:
        """Value of a whole-number field; as :meth:`real`."""
        return self._field(card, row, index, what, default, numerals.integer)

    def node(self, card: Card, row: Row, index: int, what: str) -> int | None:
        """Number of a node; of ``INSTANCE.12`` a negative one, see ``instance_nodes``."""
        text = row.get(index)
        instance, dot, label = text.rpartition(".")
        if not dot or key(instance) not in self.instances or not numerals.is_label(label):
            return self.integer(card, row, index, what)
        self.instance_nodes.append(text)
        return -len(self.instance_nodes)

    def _field(
        self,
        card: Card,
        row: Row,
        index: int,
        what: str,
        default: Number | None,
        read: Callable[[str], Number],
    ) -> Number | None:
        text = row.get(index)
        if not text and default is not None:
            return default
        if not text:
            self.row_error(card, row, index, f"{what} is missing")
            return None
        try:
            return read(text)
        except ValueError as error:
            self.row_error(card, row, index, f"{what}: {error}")
            return None

    def parameter_number(self, card: Card, name: str, default: float, least: float) -> float:
        """Value of a numeric parameter, at least ``least``."""
        return self._parameter(card, name, default, least, numerals.real)

    def parameter_integer(self, card: Card, name: str, default: int, least: int) -> int:
        """Value of a whole-number parameter, at least ``least``."""
        return self._parameter(card, name, default, least, numerals.integer)

    def _parameter(
        self, card: Card, name: str, default: Number, least: Number, read: Callable[[str], Number]
    ) -> Number:
        if not card.has(name):
            return default
        try:
            value = read(card.value(name))
            if value < least:
                raise ValueError(f"{value:g} is less than {least:g}")
        except ValueError as error:
            self.error(card, card.at(name), f"{card.parameters[name].name}: {error}")
            return default
        return value

    def choice(self, card: Card, name: str, choices: Iterable[str], default: str) -> str:
        """Value of a parameter out of a list (compared without case and blanks).

        Unique abbreviations of at least three letters are accepted, as in Abaqus.
        """
        if not card.has(name):
            return default
        value, allowed = key(card.value(name)), list(choices)
        if value in allowed:
            return value
        begun = [word for word in allowed if len(value) > 2 and word.startswith(value)]
        if len(begun) == 1:
            return begun[0]
        self.error(
            card,
            card.at(name),
            f"{card.parameters[name].name}={card.value(name)} is not known; "
            f"expected {', '.join(allowed)}",
            hint=nearest(value, allowed),
        )
        return default

    def required(self, card: Card, name: str, shown: str = "") -> str:
        """Value of a parameter that must be there; empty after an error."""
        value = card.value(name)
        if not value:
            self.error(card, card.where, f"{shown or name}= is missing")
        return value

    def no_rows(self, card: Card) -> None:
        """Refuse data lines under a card that takes none."""
        for row in card.rows():
            self.row_error(card, row, 0, "no data line is expected here")
            return

    def extra_fields(self, card: Card, row: Row, most: int) -> None:
        """Refuse non-empty fields after the last one that the card takes."""
        for index in range(most, len(row)):
            if row.fields[index]:
                self.row_error(card, row, index, f"too many fields: at most {most} are expected")
                return


def nearest(word: str, words: Iterable[str], cutoff: float = 0.7) -> str:
    """Question that names the nearest word, or an empty text."""
    from difflib import get_close_matches

    candidates = {key(w): w for w in words}
    found = get_close_matches(key(word)[:80], list(candidates), 1, cutoff)
    return f"did you mean {candidates[found[0]]}?" if found else ""


def int_array(values: Iterable[int]) -> Ints:
    """Array of whole numbers."""
    return np.fromiter(values, dtype=np.int64)

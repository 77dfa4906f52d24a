"""From a deck to a model: its parts in order, and the steps."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import InputError
from corota.io.deck.build.loads import LoadBuilder
from corota.io.deck.build.materials import share_damping
from corota.io.deck.build.mesh import MeshBuilder, views_in
from corota.io.deck.build.sections import SectionBuilder
from corota.io.deck.build.targets import Targets
from corota.io.deck.card import key, nearest
from corota.io.deck.deck import Deck, Stage
from corota.lazy import lazy
from corota.model.element_changes import ElementChange
from corota.model.model import Model
from corota.model.steps import Buckle, Static, SteadyState, Step

if TYPE_CHECKING:
    from collections.abc import Mapping

    from corota.io.deck.drafts import Draft, StepDraft, TieDraft

# Parts that few decks have.
add_releases = lazy("corota.io.deck.cards.release:add_releases")
base_supports = lazy("corota.io.deck.build.base_motion:base_supports")
build_attachments = lazy("corota.io.deck.cards.attachments:build_attachments")
build_contacts = lazy("corota.io.deck.build.contact:build_contacts")
build_initial = lazy("corota.io.deck.cards.thermal:build_initial")
build_tie = lazy("corota.io.deck.build.ties:build_tie")
prepare_connectors = lazy("corota.io.deck.cards.connectors:prepare_connectors")
pretension_builder = lazy("corota.io.deck.cards.pretension:PretensionBuilder")


class ModelBuilder:
    """Builds the model of a deck; faults go to ``deck.diagnostics``."""

    def __init__(self, deck: Deck, name: str) -> None:
        self.deck = deck
        if deck.releases:
            add_releases(deck)
        if deck.connectors:
            prepare_connectors(deck)
        self.meshes = MeshBuilder(deck)
        self.model = Model(self.meshes.build(), name)
        self.mesh = self.model.mesh
        self.targets = Targets(deck, self.meshes, self.model)
        self.sets = self.targets.sets
        self.loads = LoadBuilder(self.targets)

    def build(self) -> Model:
        """Everything."""
        targets = self.targets
        self.sets.fill()
        self._enter("mesh")
        pretension = None
        if self.deck.pretensions:
            pretension = pretension_builder(self.deck, self.model, self.sets)
            pretension.cut()
            targets.twins = pretension.twins()
        targets.rotating = np.zeros(self.mesh.n_nodes, bool)
        share_damping(self.deck)
        until = sum(step.times[1] for step in self.deck.steps)
        for name, curve in self.deck.curves.items():
            self.deck.amplitudes[name] = curve.sampled(until)
        SectionBuilder(targets).build()
        model, deck = self.model, self.deck
        # Constraints along the global axes need the axes of their nodes.
        ties = sorted(deck.ties, key=lambda tie: tie.kind != "axes")
        count = sum(tie.kind == "axes" for tie in ties)
        self._ties(ties[:count])
        self._enter("sections")
        self._ties(ties[count:])
        if deck.has_contact:
            build_contacts(targets)
        model.amplitudes = {a.name: a for a in deck.amplitudes.values()}
        if pretension is not None:
            pretension.join(targets)
        if deck.attached or deck.properties:
            build_attachments(targets)
        model.supports += self.loads.supports(deck.supports)
        self._enter("model")
        if deck.initial:
            build_initial(targets)
        if sum(step.perturbs for step in deck.steps) > 1:
            self._check_linear()
        for draft in deck.steps:
            step = self._step(draft)
            if step is not None:
                step.restart = draft.restart
                model.steps.append(step)
        if pretension is not None:
            pretension.share_fields()
        self.sets.report_missing(targets.used | {key(tie.surface) for tie in deck.ties})
        model.time_points = deck.time_points
        model.title = " ".join(deck.heading)
        self._move_supports()
        self._unused()
        model.notes += deck.notes
        return model

    def _ties(self, ties: list[TieDraft]) -> None:
        for tie in ties:
            for view in views_in(self.meshes.views, self.deck, tie.card.scope):
                with self.targets.inside(view):
                    build_tie(self.targets, tie)

    def _enter(self, stage: Stage) -> None:
        """Enter the data of cards that wait for this part of the model."""
        for (when, build), data in self.deck.builds.items():
            if when == stage:
                build(self.targets, data)

    def _check_linear(self) -> None:
        """Refuse load cases of structures that do not answer in proportion."""
        what = ""
        if self.model.contacts:
            what = "contact"
        for section in self.model.sections:
            if section.material.remembers or section.material.flows or section.table:
                what = "a material or spring that is not linear"
        if what:
            card = next(s.card for s in self.deck.steps if s.perturbs)
            text = f"load cases (PERTURBATION) of a model with {what} are not part of this version"
            card.error(text, "PERTURBATION", hint="give each a deck of its own")

    def _unused(self) -> None:
        deck = self.deck
        scopes = [view.scope for view in self.meshes.views]
        used = {key(s.material) for scope in scopes for s in scope.sections}
        used |= {key(s.material) for scope in scopes for s in scope.lines}
        for name, material in deck.materials.items():
            if name not in used and self.model.sections:
                deck.note(f"{material.card.where}: material {material.name} is not used")
        steps = [d for s in deck.steps for d in s.supports + s.loads + s.base_motions]
        drafts = deck.supports + steps
        named = {key(draft.amplitude) for draft in drafts}
        for name, amplitude in deck.amplitudes.items():
            if name not in named and deck.steps:
                deck.note(f"{amplitude.where}: amplitude {amplitude.name} is not used")

    def _step(self, draft: StepDraft) -> Step | None:
        deck = self.deck
        if draft.procedure is None:
            return None
        if draft.make is Buckle:
            self._drop_second_case(draft)
        behind = {id(d) for d in (*draft.supports, *draft.loads) if self._is_imaginary(d, draft)}
        supports = self.loads.supports([d for d in draft.supports if id(d) not in behind], draft)
        if draft.base_motions:
            supports += base_supports(deck, self.model, draft, supports)
        ahead = [d for d in draft.loads if id(d) not in behind]
        loads = [load for item in ahead for load in self.loads.loads(item)]
        changes = [found for item in draft.element_changes if (found := self._change(item))]
        for request in draft.outputs:
            self._check_target(request.kind, request.where, draft)
        first, period, least, most = draft.times
        try:
            make = draft.make or Static
            options = draft.options or {"ramp": draft.ramp}
            if behind:
                late = [x for d in draft.loads if id(d) in behind for x in self.loads.loads(d)]
                options = {
                    **options,
                    "imaginary_supports": self.loads.supports(
                        [d for d in draft.supports if id(d) in behind], draft
                    ),
                    "imaginary_loads": late,
                }
            return make(
                nlgeom=draft.nlgeom if draft.preload is None else draft.preload,
                period=period,
                first_increment=first,
                smallest_increment=least,
                largest_increment=most,
                fixed_increments=draft.direct,
                max_increments=draft.max_increments,
                supports=supports,
                loads=loads,
                new_supports=draft.new_supports,
                new_loads=draft.new_loads,
                element_changes=changes,
                outputs=draft.outputs,
                where=draft.card.where,
                **options,
            )
        except InputError as error:
            draft.procedure.error(error.message)
            return None

    def _change(self, draft: Draft) -> ElementChange | None:
        """Elements that leave the structure or join it."""
        found = self.targets.cells_of(draft)
        if found is None:
            return None
        if len(found.attached) or not len(found.cells):
            text = f"{draft.target} holds no solid elements, trusses, beams or springs"
            draft.row.error(0, text)
            return None
        where = draft.row.where
        return ElementChange(found.cells, draft.index > 0, draft.index < 2, where)

    def _drop_second_case(self, draft: StepDraft) -> None:
        """Supports of ``*BUCKLE`` for the modes (LOAD CASE=2), as CAE repeats them.

        Those for the perturbation hold the modes too; other ones for the modes are refused.
        """

        def dofs(drafts: list[Draft]) -> set[tuple[int, int]]:
            supports = self.loads.supports(drafts, draft)
            return {(int(n), s.dof) for s in supports for n in self.mesh.node_indices(s.nodes)}

        second = [d for d in draft.supports if d.card.value("LOADCASE") == "2"]
        if not second:
            return
        draft.supports = [d for d in draft.supports if d.card.value("LOADCASE") != "2"]
        before = [] if draft.new_supports else [*self.model.supports]
        before += [] if draft.new_supports else [s for m in self.model.steps for s in m.supports]
        held = {(int(n), s.dof) for s in before for n in self.mesh.node_indices(s.nodes)}
        if dofs(second) | held != dofs(draft.supports) | held:
            card = second[0].card
            card.error(
                "the modes have other supports (LOAD CASE=2) than the perturbation (LOAD CASE=1)",
                "LOADCASE",
                hint="buckle the whole structure instead of a half with antisymmetric modes",
            )

    def _is_imaginary(self, item: Draft, draft: StepDraft) -> bool:
        """Whether ``LOAD CASE=2`` makes a load of a harmonic step act out of phase."""
        if item.card.has("REAL") or item.card.has("IMAGINARY"):
            # Abaqus's words for the load cases of CalculiX.
            part = "IMAGINARY" if item.card.has("IMAGINARY") else "REAL"
            if draft.make is not SteadyState:
                item.card.error(f"{part} belongs to *STEADY STATE DYNAMICS", part)
            return part == "IMAGINARY" and draft.make is SteadyState
        case = item.card.value("LOADCASE") or "1"
        if case not in ("1", "2"):
            item.card.error(f"LOAD CASE must be 1 or 2, not {case}", "LOADCASE")
        elif case == "2" and draft.make is not SteadyState:
            item.card.error(
                "LOAD CASE=2 (out of phase) belongs to *STEADY STATE DYNAMICS", "LOADCASE"
            )
        return case == "2" and draft.make is SteadyState

    def _check_target(self, kind: str, where: str, draft: StepDraft) -> None:
        known: dict[str, Mapping[str, object]] = {
            "node print": self.mesh.node_sets,
            "el print": self.mesh.cell_sets,
            "contact print": {pair.name: None for pair in self.model.contacts},
            "section print": self.mesh.edge_sets,
        }
        tables = known.get(kind, {**self.mesh.node_sets, **self.mesh.cell_sets})
        request = next(o for o in draft.outputs if o.kind == kind and o.where == where)
        if not where:
            return
        name = self.sets.mesh_name(tables, self.meshes.views[0], where)
        if name:
            request.where = name
            return
        what = {
            "node print": "node set",
            "el print": "element set",
            "contact print": "contact pair",
            "section print": "surface",
        }.get(kind, "set")
        self.deck.error(
            None, request.source, f"no {what} named {where!r}", hint=nearest(where, tables)
        )

    def _move_supports(self) -> None:
        """Supports before the first step end with the first ``OP=NEW``, as the others do."""
        steps = self.model.steps
        if any(step.new_supports for step in steps):
            if not steps[0].new_supports:
                steps[0].supports = self.model.supports + steps[0].supports
            self.model.supports = []

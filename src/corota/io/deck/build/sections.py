"""Sections of a model from those of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota.arrays import Floats, Ints, Lookup, distinct
from corota.errors import InputError
from corota.io.deck.build.materials import build_material
from corota.io.deck.build.mesh import View, views_in
from corota.io.deck.build.temperatures import constant_temperature, drop_temperatures
from corota.io.deck.card import Refused, key, nearest
from corota.io.deck.cards.material import HYBRID_RATIO
from corota.io.deck.elements import (
    ASK,
    DRILLING,
    ELEMENTS,
    LINE_ELEMENTS,
    LINES,
    OWN,
    WRITTEN_BY_MESHIO,
)
from corota.lazy import lazy
from corota.mesh.parts import nodes_of_cells
from corota.model import axisymmetry
from corota.model.hyperelastic import with_ratio
from corota.model.local_strain import LocalStrain, dialect_strain
from corota.model.sections import Plane, Section

if TYPE_CHECKING:
    from collections.abc import Iterator

    from corota.io.deck.build.targets import Targets
    from corota.io.deck.drafts import SectionDraft
    from corota.model.materials import Material


#: Elements that are the same at small strain and stay stable at large strain.
STABLE = {"Q4I": "Q4S"}
#: Cards that give beams and springs their section.
SECTION_CARDS = {"beam": "*BEAM SECTION", "spring": "*SPRING"}

#: Poisson's ratio at small strain of rubber without compressibility in CalculiX, whose bulk modulus
#: then is 20 times the shear modulus.
CALCULIX_RATIO = 58.0 / 122.0
DIALECTS = {"calculix": "CalculiX takes it", "abaqus": "hybrid elements keep the volume"}

by_cell = lazy("corota.io.deck.cards.distribution:by_cell")
plane_angle = lazy("corota.io.deck.cards.distribution:plane_angle")
read_thickness = lazy("corota.io.deck.cards.distribution:thickness")
build_lines = lazy("corota.io.deck.cards.lines:build_lines")
truss_section = lazy("corota.io.deck.cards.lines:truss_section")


def _alike(
    mine: Ints, cells: Ints, by_cells: dict[str, Floats], thickness: float | Floats, angle: float
) -> Iterator[tuple[Ints, float | Floats, float]]:
    """Parts of the cells `mine` with one thickness and one angle of the axes.

    Parameters
    ----------
    mine, cells : ndarray of int, shapes (m,), (n,)
    by_cells : dict of ndarray, shape (n,)
        ``thickness`` [length] and ``angle`` [rad] of distributions, which add to `angle`.
    """
    if not by_cells:
        yield mine, thickness, angle
        return
    at = Lookup(cells)(mine)
    turns = by_cells.get("angle", np.zeros(len(cells)))[at]
    depths = by_cells.get("thickness", np.zeros(len(cells)))[at]
    pairs, which = np.unique(np.column_stack([turns, depths]), axis=0, return_inverse=True)
    for number, (turn, depth) in enumerate(pairs.tolist()):
        yield mine[which.ravel() == number], depth or thickness, angle + turn


class SectionBuilder:
    """Gives the cells of a model their sections."""

    def __init__(self, targets: Targets) -> None:
        self.targets, self.deck, self.sets = targets, targets.deck, targets.sets
        self.meshes, self.model, self.mesh = targets.meshes, targets.model, targets.mesh
        self.nonlinear = any(step.nlgeom for step in targets.deck.steps)
        #: Thickness of nodes, nan where none is given; computed on demand.
        self.nodal: np.ndarray[tuple[int], np.dtype[np.float64]] | None = None

    def build(self) -> None:
        owner = np.full(self.mesh.n_cells, -1, np.int64)
        drafts = [(view, draft) for view in self.meshes.views for draft in view.scope.sections]
        temperature = constant_temperature(self.targets)
        drop_temperatures(self.deck)
        materials = {
            name: build_material(self.deck, draft, temperature)
            for name, draft in self.deck.materials.items()
        }
        for number, (view, draft) in enumerate(drafts):
            card = draft.card
            found = self.sets.elements(view, draft.elset, card.at("ELSET"), card)
            if found is None:
                continue
            taken = found.cells[owner[found.cells] >= 0]
            if len(found.lines) and not len(found.cells):
                text = f"{draft.elset} holds line elements of curves only"
                hint = "for trusses, put the set and the section beside the elements"
                card.error(text, "ELSET", hint)
            elif len(taken):
                first = drafts[int(owner[taken[0]])][1].card.where
                label = self.mesh.cell_labels[taken[0]]
                card.error(f"element {label} already has a section ({first})")
            else:
                owner[found.cells] = number
                if draft.material and key(draft.material) not in materials:
                    hint = nearest(draft.material, [m.name for m in self.deck.materials.values()])
                    card.error(f"no material named {draft.material!r}", "MATERIAL", hint)
                elif material := materials[key(draft.material)]:
                    with suppress(Refused):
                        self._section(view, draft, found.cells, material)
        if any(view.scope.lines for view in self.meshes.views):
            rotating = self.targets.rotating
            build_lines(self.deck, self.model, self.meshes, self.sets, materials, rotating, owner)
        if any(section.axisymmetric for section in self.model.sections):
            for section in axisymmetry.in_the_plane(self.model):
                self.deck.note(
                    f"{section.where}: plane {section.plane} beside axisymmetric elements: the "
                    "thickness is that around the whole circumference, as in CalculiX"
                )
        bare = np.flatnonzero(owner == -1)
        if len(bare) and (drafts or self.deck.steps):
            label = self.mesh.cell_labels[bare[0]]
            more = f" and {len(bare) - 1} others have" if len(bare) > 1 else " has"
            line_element = LINE_ELEMENTS.get(self.meshes.types[self.meshes.cell_type[bare[0]]])
            wanted = SECTION_CARDS[line_element.role] if line_element else "*SOLID SECTION"
            self.deck.error(None, None, f"element {label}{more} no {wanted}", hint="give it one")

    def _section(self, view: View, draft: SectionDraft, cells: Ints, material: Material) -> None:
        deck, card = self.deck, draft.card
        angle = 0.0
        by_cells: dict[str, Floats] = {}
        if draft.orientation:
            tables = (view.scope.orientations, deck.root.orientations)
            turned = (view.scope.axes_by_element, deck.root.axes_by_element)
            named = next((t for t in tables if key(draft.orientation) in t), None)
            if named is None:
                hint = nearest(draft.orientation, [n for t in tables for n in t])
                card.refuse(f"no orientation named {draft.orientation!r}", "ORIENTATION", hint)
            angle = named[key(draft.orientation)]
            by_element = next(
                (t[key(draft.orientation)] for t in turned if key(draft.orientation) in t), None
            )
            if by_element is not None:
                origin, source, angle = by_element
                use = (origin, source)
                by_cells["angle"] = by_cell(deck, self.sets, view, use, cells, plane_angle)
            elif math.isnan(angle):
                if material.oriented:
                    text = "axes that turn about a point are not part of this version"
                    hint = "give *ORIENTATION, SYSTEM=RECTANGULAR to parts of the body"
                    card.refuse(text, "ORIENTATION", hint)
                card.note(
                    "the axes of an isotropic material do not matter; results are in global axes"
                )
                angle = 0.0
            if view.instance is not None:
                angle += view.instance.angle
        strain = draft.local_strain or dialect_strain(material.default_strain, deck.dialect)
        groups: dict[tuple[str, str, float], list[Ints]] = {}
        types = self.meshes.cell_type[cells]
        for code in distinct(types):
            name = self.meshes.types[code]
            if name in LINES:
                with suppress(Refused):
                    truss = truss_section(draft, cells[types == code], material)
                    self.model.sections.append(truss)
                continue
            if name in LINE_ELEMENTS:
                wanted = SECTION_CARDS[LINE_ELEMENTS[name].role]
                card.error(f"elements of type {name} take {wanted}", "ELSET")
                continue
            info = ELEMENTS[name]
            ask = info.ask
            if name in WRITTEN_BY_MESHIO and any("written by meshio" in t for t in deck.heading):
                info, ask = replace(info, plane=""), ASK
            if draft.plane and info.plane and draft.plane != info.plane:
                text = f"PLANE={draft.plane.upper()} does not fit"
                card.refuse(f"{name} elements are in plane {info.plane}; {text}", "PLANE")
            mapped = self.deck.element_map.get(name)
            if ask and not draft.plane and not mapped:
                hint = f"or replace them: --element {name}=CPS{info.kind[-1]}"
                card.refuse(f"{name} elements: {ask}", hint=hint)
            plane = draft.plane or info.plane or (mapped[1] if mapped else "") or "stress"
            element = self._element(name, strain != "linear" and self.nonlinear)
            ratio = self._ratio(name, plane) if material.incompressible else 0.0
            groups.setdefault((element, plane, ratio), []).append(cells[types == code])
        if not draft.given and any(plane != "axisymmetric" for _, plane, _ in groups):
            deck.note(f"{card.where}: no thickness is given for {draft.elset}; 1 is taken")
        if draft.thickness != 1.0 and any(plane == "axisymmetric" for _, plane, _ in groups):
            deck.note(
                f"{card.where}: the thickness {draft.thickness:g} has no effect: forces of "
                "axisymmetric elements are those of the whole circumference"
            )
        full = self.sets.full_name(self.sets.elsets, view, draft.elset)
        thickness = self._thickness(draft, cells)
        if draft.thicknesses:
            use = card, draft.thicknesses
            by_cells["thickness"] = by_cell(deck, self.sets, view, use, cells, read_thickness)
        if any(plane == "axisymmetric" for _, plane, _ in groups) and draft.nodal:
            text = "an axisymmetric section has no thickness"
            card.refuse(text, "NODALTHICKNESS", hint="remove NODAL THICKNESS")
        for (element, plane, ratio), parts in groups.items():
            mine = np.sort(np.concatenate(parts))
            law = material
            if ratio:
                law = with_ratio(material, ratio)
                deck.note(
                    f"{card.where}: no compressibility is given for {material.name}: Poisson's "
                    f"ratio {ratio:.5g}, as {DIALECTS[deck.dialect]}"
                )
            if element in DRILLING:
                for block, row in ((self.mesh.cells[b], r) for b, r in self._rows(mine)):
                    self.targets.rotating[block.nodes[row]] = True
            for own, depth, turn in _alike(mine, cells, by_cells, thickness, angle):
                whole = full and len(own) == len(cells)
                where = self.sets.spelled(self.sets.elsets, full) if whole else own
                try:
                    self.model.sections.append(
                        Section(
                            where,
                            element,
                            law,
                            cast("float", 1.0 if plane == "axisymmetric" else depth),
                            cast("Plane", plane),
                            cast("LocalStrain", strain),
                            turn,
                            card.where,
                            mean_dilatation=draft.mean_dilatation,
                            beta0=draft.beta0,
                        )
                    )
                except InputError as error:
                    card.refuse(error.message)

    def _ratio(self, name: str, plane: str) -> float:
        """Poisson's ratio of an incompressible law in elements of a name; 0 where it stays so."""
        if name in OWN:
            return 0.0
        if self.deck.dialect == "calculix":
            return CALCULIX_RATIO
        return HYBRID_RATIO if plane != "stress" and name.endswith("H") else 0.0

    def _thickness(
        self, draft: SectionDraft, cells: Ints
    ) -> float | np.ndarray[Any, np.dtype[np.float64]]:
        """Thickness of a section, or that of each node.

        As in CalculiX and Abaqus, ``*NODAL THICKNESS`` counts where the section says so.
        """
        if not draft.nodal:
            if self.deck.thicknesses:
                self.deck.note(
                    f"{draft.card.where}: {draft.card.spelled} has no NODAL THICKNESS: its own "
                    "thickness is used, *NODAL THICKNESS is not"
                )
            return draft.thickness
        if self.nodal is None:
            self.nodal = np.full(self.mesh.n_nodes, np.nan)
            for item in self.deck.thicknesses:
                for view in views_in(self.meshes.views, self.deck, item.card.scope):
                    self.targets.at = view
                    nodes = self.targets.nodes(item)
                    if nodes is not None:
                        self.nodal[self.mesh.node_indices(nodes)] = item.value[0]
            self.targets.at = self.meshes.views[0]
            near, far = self.targets.twins
            self.nodal[near] = self.nodal[far]
        if not self.deck.thicknesses:
            text = "NODAL THICKNESS is given, and no card *NODAL THICKNESS"
            draft.card.error(text, "NODALTHICKNESS")
        values = np.where(np.isnan(self.nodal), draft.thickness, self.nodal)
        mine = values[nodes_of_cells(self.mesh, cells)]
        # One thickness for all nodes is passed as a scalar.
        return float(mine[0]) if len(mine) and (mine == mine[0]).all() else values

    def _element(self, type_: str, finite: bool) -> str:
        """Element for a name; `finite` if its local strain is nonlinear."""
        mapped = self.deck.element_map.get(type_)
        own, literal = ELEMENTS[type_].element, ELEMENTS[type_].literal
        if finite and own != type_:
            own = STABLE.get(own, own)
        if mapped or not literal:
            return mapped[0] if mapped else own
        if self.deck.literal:
            return literal
        self.deck.note(
            f"{type_} becomes {own}, which is more accurate on coarse meshes than one point with "
            f"a stabilized hourglass ({literal}); --as-written (as_written=True) takes {literal}"
        )
        return own

    def _rows(self, cells: Ints) -> list[tuple[int, Ints]]:
        offsets = self.mesh.offsets
        inside = [(cells >= a) & (cells < b) for a, b in pairwise(offsets)]
        return [(i, cells[m] - offsets[i]) for i, m in enumerate(inside) if m.any()]

"""A model written as a deck reads back to the same model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from decks import MESH, SECTION, STEP, SUPPORT, read
from seeds import WRITABLE

import corota as ct
from corota.io.formats import write
from corota.model.contact import RigidCurve
from corota.model.loads import BodyForce, EdgeLoad

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def sections(model: ct.Model) -> list[tuple[object, ...]]:
    """Sections by cell, so that names of invented sets do not matter."""
    found = []
    for s in model.sections:
        cells = s.cells
        if isinstance(cells, str):
            cells = model.mesh.cell_sets.get(cells, np.arange(model.mesh.n_cells))
        constants = tuple(np.round(s.material.parameters(), 10))
        for label in model.mesh.cell_labels[cells]:
            found.append(
                (
                    label,
                    s.element,
                    constants,
                    s.material.rho,
                    s.thickness,
                    s.plane,
                    s.local_strain,
                    round(s.orientation, 12),
                )
            )
    return sorted(found)


def conditions(model: ct.Model, items: list[object]) -> list[tuple[object, ...]]:
    """Supports and loads by node, edge or cell number."""
    mesh, found = model.mesh, []
    for item in items:
        if isinstance(item, EdgeLoad):
            edges = mesh.edge_sets[item.edges] if isinstance(item.edges, str) else item.edges
            where = sorted((int(mesh.cell_labels[c]), int(e)) for c, e in edges)
            kind: object = (item.kind, tuple(np.round(item.value, 9)))
        elif isinstance(item, BodyForce):
            cells = mesh.cell_sets.get(item.cells) if isinstance(item.cells, str) else item.cells
            cells = np.arange(mesh.n_cells) if cells is None else cells
            where = sorted(mesh.cell_labels[cells].tolist())
            kind = (item.kind, tuple(np.round(item.value, 9)))
        else:
            nodes = mesh.nodes_of(item.nodes) if isinstance(item.nodes, str) else item.nodes  # type: ignore[attr-defined]
            for label in mesh.node_labels[nodes].tolist():
                found.append((label, item.dof, item.value, item.amplitude.upper()))  # type: ignore[attr-defined]
            continue
        found.append((tuple(where), kind, item.amplitude.upper()))
    return sorted(found, key=str)


def same(a: ct.Model, b: ct.Model) -> None:
    assert np.array_equal(a.mesh.points, b.mesh.points)
    assert np.array_equal(a.mesh.node_labels, b.mesh.node_labels)
    assert [c.kind for c in a.mesh.cells] == [c.kind for c in b.mesh.cells]
    for mine, theirs in zip(a.mesh.cells, b.mesh.cells, strict=True):
        assert np.array_equal(mine.nodes, theirs.nodes)
        assert np.array_equal(mine.labels, theirs.labels)
    for name, nodes in a.mesh.node_sets.items():
        assert np.array_equal(b.mesh.node_sets[name.replace(" ", "_")], nodes)
    assert sections(a) == sections(b)
    assert conditions(a, a.supports) == conditions(b, b.supports)  # type: ignore[arg-type]
    assert len(a.steps) == len(b.steps)
    for one, two in zip(a.steps, b.steps, strict=True):
        assert conditions(a, one.supports) == conditions(b, two.supports)  # type: ignore[arg-type]
        assert conditions(a, one.loads) == conditions(b, two.loads)  # type: ignore[arg-type]
        for name in (
            "nlgeom",
            "period",
            "first_increment",
            "smallest_increment",
            "largest_increment",
            "fixed_increments",
            "max_increments",
            "new_supports",
            "new_loads",
            "ramp",
            "tolerance",
            "max_iterations",
        ):
            assert getattr(one, name) == getattr(two, name)
        for old, new in zip(one.outputs, two.outputs, strict=True):
            assert (old.kind, old.variables, old.frequency, old.totals) == (
                new.kind,
                new.variables,
                new.frequency,
                new.totals,
            )
    assert {k.upper() for k in a.amplitudes} == {k.upper() for k in b.amplitudes}


@pytest.mark.parametrize("number", range(len(WRITABLE)))
def test_decks_survive_a_round_trip(tmp_path: Path, number: int) -> None:
    model = read(tmp_path, WRITABLE[number])
    same(model, ct.read(write(model, tmp_path / "again.inp")))


def test_a_python_model_survives_a_round_trip(tmp_path: Path) -> None:
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 4, 2, "quad8"), 0.1)
    mesh.node_sets["left side"] = mesh.node_sets.pop("left")
    model = ct.Model(mesh)
    wood = ct.Orthotropic(10.0, 4.0, 3.0, 0.3, 0.2, 0.1, 2.0, rho=0.5)
    model.section([0, 1], element="Q8", material=wood, plane="strain", orientation=0.7)
    model.section(
        [2, 3, 4, 5, 6, 7],
        element="Q8R",
        material=ct.Elastic(1.0, 0.2),
        local_strain="green_lagrange",
    )
    model.fix("left side")
    model.fix([7], x=None, y=0.25)
    model.pressure("top", 3.0)
    model.traction(mesh.edge_sets["right"][:1], x=1.0, y=-2.0)
    model.force("bottom", y=-1.0, per_node=True)
    model.gravity(y=-9.81, cells=[0, 1])
    model.steps = [
        ct.Static(increments=4, tolerance=1e-11, max_iterations=7),
        ct.Static(new_loads=True),
    ]
    again = ct.read(write(model, tmp_path / "model.inp"))
    # The model's loads act in every step; a deck says them in the first, and after OP=NEW.
    model.steps[0].loads = model.loads + model.steps[0].loads
    model.steps[1].loads = model.loads + model.steps[1].loads
    same(model, again)


def test_options_of_a_section_survive_a_round_trip(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2, "tri3"))
    steel = ct.Elastic(1.0, 0.2)
    model.section([0, 1], element="OPT", material=steel, beta0=0.25)
    model.section(range(2, 16), element="T3", material=steel, plane="strain")
    again = ct.read(write(model, tmp_path / "triangles.inp"))
    assert [s.beta0 for s in again.sections] == [0.25, None]
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    model.section("all", element="Q4", material=steel, plane="strain", mean_dilatation=True)
    again = ct.read(write(model, tmp_path / "squares.inp"))
    assert again.sections[0].mean_dilatation


def test_a_total_force_on_edges_is_written_as_a_traction(tmp_path: Path) -> None:
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 2)
    del mesh.node_sets["right"]
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(1.0), thickness=0.5)
    model.force("right", x=3.0, y=4.0)
    model.fix("left")
    again = ct.read(write(model, tmp_path / "model.inp"))
    load = again.steps[0].loads[0]
    assert isinstance(load, EdgeLoad)
    assert load.value == pytest.approx((6.0, 8.0))


def test_what_a_deck_cannot_hold_is_refused(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    with pytest.raises(ct.UnsupportedError, match="no writer"):
        write(model, tmp_path / "model.bdf")
    model.steps = [ct.model.steps.Step()]
    with pytest.raises(ct.UnsupportedError, match="step 1"):
        write(model, tmp_path / "model.inp")


def _without_card(model: ct.Model) -> None:
    law = ct.PressureLaw("linear", 1.0)
    model.contact("left", "right", law=law)
    law.kind = "power"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m.equation((1, "x", 1.0), (2, "x", -1.0), rhs=0.1), "right-hand side 0.1"),
        (
            lambda m: m.couple("right", 2, kind="distributing", dofs="x", weights=[1.0, 2.0, 3.0]),
            "weights and only some dofs",
        ),
        (lambda m: m.local_axes([1], angle=0.5, center=(0.0, 1.0)), "local axes about a point"),
        (lambda m: m.contact("left", "right", reach=0.5), "reach"),
        (_without_card, "no card of a deck holds a power pressure law"),
        (
            lambda m: m.steps.append(ct.Static(path=ct.DisplacementControl("right", "y", 1.0))),
            "step 1: path=DisplacementControl",
        ),
        (
            lambda m: m.steps.append(ct.Static(path=ct.ArcLength(switch=True))),
            "step 1: switch of ArcLength",
        ),
        (lambda m: m.steps.append(ct.Static(at_limit="follow")), "step 1: at_limit of Static"),
        (lambda m: m.steps.append(ct.Static(plastic_increment=0.01)), "step 1: plastic_increment"),
        (lambda m: m.steps.append(ct.Static(tolerance=1e-6)), "step 1: a tolerance of 1e-06"),
        (lambda m: m.steps.append(ct.Dynamic(scheme="generalized_alpha")), "with rho_inf=0.8"),
        (lambda m: m.steps.append(ct.Dynamic(mass="lumped")), "step 1: mass='lumped'"),
        (lambda m: m.steps.append(ct.Dynamic(error_tolerance=1e-3)), "step 1: error_tolerance"),
        (lambda m: m.steps.append(ct.Frequency(mass="lumped")), "step 1: mass='lumped'"),
        (lambda m: m.steps.append(ct.ModalDynamic(residual=True)), "step 1: residual"),
        (
            lambda m: m.steps.extend([ct.Dynamic(rayleigh=(1.0, 0.0)), ct.Dynamic()]),
            "different rayleigh damping",
        ),
        (
            lambda m: setattr(
                m.sections[0],
                "material",
                ct.Mises(1.0, 0.3, yield_stress=1.0, isotropic=ct.Voce(1.0, 1.0, 1.0), name="m"),
            ),
            "material m: the linear part H",
        ),
        (
            lambda m: setattr(m.sections[0], "material", ct.UserMaterial(lambda *_: None)),
            "material of type UserMaterial",
        ),
    ],
)
def test_nothing_is_left_out_in_silence(
    tmp_path: Path, change: Callable[[ct.Model], object], words: str
) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    model.section("all", element="Q4", material=ct.Elastic(1.0), plane="strain")
    change(model)
    with pytest.raises(ct.UnsupportedError, match=words):
        write(model, tmp_path / "model.inp")
    assert not list(tmp_path.iterdir())


CONTACT = """*SURFACE, NAME=LOW
1, S3
*SURFACE, NAME=RIGHT
2, S2
*SURFACE INTERACTION, NAME=I
*FRICTION
.25
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR
0., 0.
5., .01
*SURFACE INTERACTION, NAME=J
*SURFACE, TYPE=SEGMENTS, NAME=DIE
START, 3., 4.
LINE, 2., 4.
CIRCL, 1., 3., 2., 3.
*RIGID BODY, ANALYTICAL SURFACE=DIE, REF NODE=3
*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE
LOW, RIGHT
*CLEARANCE, SLAVE=LOW, MASTER=RIGHT, VALUE=.5
*CONTACT PAIR, INTERACTION=J, TYPE=MORTAR, ADJUST=.1
RIGHT, DIE
*CONTACT PAIR, INTERACTION=J, TYPE=MORTAR
LOW, LOW
LOW, DIE
*TIE, NAME=T, POSITION TOLERANCE=2., ADJUST=NO
LOW, RIGHT
"""


def test_contact(tmp_path: Path) -> None:
    step = STEP.replace(
        "*END STEP",
        "*CONTACT INTERFERENCE, SHRINK\nLOW, LOW\n*CONTACT CONTROLS, STABILIZE, SLAVE=LOW, "
        "MASTER=DIE\n*CONTACT PRINT, SLAVE=LOW, MASTER=DIE\nCF\n*END STEP",
    )
    first = read(tmp_path, MESH + SECTION + CONTACT + SUPPORT + step)
    write(first, tmp_path / "again.inp")
    second = ct.read(tmp_path / "again.inp")
    assert second.ties == first.ties
    assert len(second.contacts) == len(first.contacts) == 4
    for a, b in zip(first.contacts, second.contacts, strict=True):
        for name in ("slave", "method", "friction", "clearance", "start", "stabilize", "adjust"):
            assert getattr(a, name) == getattr(b, name)
        assert (a.law is None) == (b.law is None)
        if a.law is not None and b.law is not None:
            np.testing.assert_array_equal(a.law.pressure, b.law.pressure)
            np.testing.assert_array_equal(a.law.overclosure, b.law.overclosure)
        if isinstance(a.master, str):
            assert a.master == b.master
        else:
            assert isinstance(b.master, RigidCurve)
            np.testing.assert_allclose(a.master.segments, b.master.segments, atol=1e-15)
            assert a.master.reference == b.master.reference == 2
    (request,) = second.steps[0].outputs
    assert (request.kind, request.where) == ("contact print", second.contacts[3].name)


def test_full_circles_are_written_in_pieces(tmp_path: Path) -> None:
    model = read(tmp_path, MESH + SECTION + "*SURFACE, NAME=LOW\n1, S3\n" + SUPPORT + STEP)
    model.contact("LOW", RigidCurve.circle((0.5, 3.0), 1.0))
    write(model, tmp_path / "again.inp")
    curve = ct.read(tmp_path / "again.inp").contacts[0].master
    assert isinstance(curve, RigidCurve)
    assert curve.segments[:, 6].sum() == pytest.approx(-2.0 * np.pi)
    assert len(curve.segments) == 3


def test_a_mesh_is_written_with_its_sets(tmp_path: Path) -> None:
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    found = ct.mesh.read(ct.write(mesh, tmp_path / "mesh.inp"))
    np.testing.assert_allclose(found.points, mesh.points)
    assert {"LEFT", "RIGHT", "TOP", "BOTTOM"} <= {name.upper() for name in found.edge_sets}


@pytest.mark.parametrize("thing", ["model", 3, None, [1.0]])
def test_what_is_no_model_is_not_written(thing: object, tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="neither a model nor a mesh"):
        ct.write(thing, tmp_path / "part.inp")  # type: ignore[arg-type]


def test_a_mesh_has_no_steps_to_write(tmp_path: Path) -> None:
    with pytest.raises(ct.InputError, match="no steps"):
        ct.write(ct.mesh.rectangle(1.0, 1.0, 1, 1), tmp_path / "mesh.inp", steps=ct.Static())

"""What ``check`` finds before anything is solved."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.check import check


def beam(element: str = "Q4I", **options: object) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    material = ct.Elastic(E=1e5, nu=0.3)
    model.section("all", element=element, material=material, **options)  # type: ignore[arg-type]
    model.force("right", y=-1.0, per_node=True)
    return model


def errors(model: ct.Model) -> list[str]:
    return [str(d) for d in check(model) if d.severity == "error"]


def warnings(model: ct.Model) -> str:
    return "\n".join(str(d) for d in check(model) if d.severity == "warning")


def test_a_sound_model_has_no_errors_and_its_counts() -> None:
    model = beam()
    model.fix("left")
    assert errors(model) == []
    assert warnings(model) == ""
    assert "63 nodes, 40 quad4, 0 steps" in "\n".join(map(str, check(model)))


def test_a_loose_beam_has_three_free_modes_each_with_a_remedy() -> None:
    found = errors(beam())
    assert len(found) == 3
    assert "move along x" in found[0]
    assert "move along y" in found[1]
    assert "turn about" in found[2]
    assert all("hint: hold node" in text for text in found)


def test_a_beam_on_one_pin_turns_about_it() -> None:
    model = beam()
    model.fix([0])
    assert len(errors(model)) == 1
    assert "turn about (0, 0)" in errors(model)[0]


def test_a_drilling_support_holds_the_turn() -> None:
    for element, count in (("Q4D", 0), ("Q4I", 1)):
        model = beam(element)
        model.fix([0], rotation=True)
        assert len(errors(model)) == count


def test_a_part_by_itself_is_named() -> None:
    near = ct.mesh.rectangle(1.0, 1.0, 2, 2)
    far = ct.mesh.rectangle(1.0, 1.0, 2, 2, origin=(5.0, 0.0))
    model = ct.Model(ct.mesh.merge(near, far))
    model.section("all", element="Q4I", material=ct.Elastic(1.0, 0.3))
    model.fix(np.flatnonzero(model.mesh.points[:, 0] == 0.0))
    found = errors(model)
    assert len(found) == 3
    assert all("the part of node" in text for text in found)


def test_cells_that_touch_in_one_node_are_a_hinge() -> None:
    near = ct.mesh.rectangle(1.0, 1.0, 2, 2)
    far = ct.mesh.rectangle(1.0, 1.0, 2, 2, origin=(1.0, 1.0))
    for element, count in (("Q4I", 1), ("Q4D", 0)):
        model = ct.Model(ct.mesh.merge(near, far))
        model.section("all", element=element, material=ct.Elastic(1.0, 0.3))
        model.fix(np.flatnonzero(model.mesh.points[:, 0] == 0.0))
        found = errors(model)
        assert len(found) == count
        if found:
            assert "hinge" in found[0]
            assert "turn about (1, 1)" in found[0]


def test_free_modes_are_counted_right_on_random_supports() -> None:
    """The count equals the rank deficiency of the supports on the three rigid motions."""
    rng = np.random.default_rng(7)
    for _ in range(50):
        model = beam("Q4D" if rng.random() < 0.5 else "Q4I")
        rows = []
        for _ in range(rng.integers(0, 4)):
            node, dof = int(rng.integers(63)), int(rng.integers(3))
            x, y = model.mesh.points[node]
            if dof == 2 and model.sections[0].element == "Q4I":
                continue
            rows.append([[1, 0, -y], [0, 1, x], [0, 0, 1]][dof])
            free = {"x": None, "y": None, "rotation": None}
            model.fix([node], **(free | {["x", "y", "rotation"][dof]: 0.0}))
        rank = np.linalg.matrix_rank(np.array(rows)) if rows else 0
        assert len(errors(model)) == 3 - rank


def test_supports_are_those_of_every_step() -> None:
    model = beam()
    model.fix("left")
    held = list(model.supports)
    model.supports.clear()
    model.steps = [ct.Static(supports=held), ct.Static(new_supports=True)]
    # The run starts, and step 2 holds nothing any more.
    assert errors(model) == []
    assert warnings(model).count("step 2: a free body") == 3
    model.steps[1].new_supports = False
    assert errors(model) == []
    assert "free body" not in warnings(model)


def test_cells_need_one_section_that_fits() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=20, ny=2))
    # A bare mesh is no faulty model: what is missing is a note.
    assert errors(model) == []
    assert "note: element 1 and 39 others have no section" in "\n".join(map(str, check(model)))
    model.section([0], element="Q4I", material=ct.Elastic(1.0))
    model.section([0, 1], element="Q8", material=ct.Elastic(1.0))
    found = "\n".join(errors(model))
    assert "element 1 is a quad4; Q8 needs a quad8" in found
    assert "element 3 and 37 others have no section" in found
    assert "element 1 has more than one section" in found


@pytest.mark.parametrize(("element", "hint"), [("Q4", "Q4I or Q4D"), ("Q4I", ""), ("Q4D", "")])
def test_plain_elements_in_a_slender_part_are_warned_about(element: str, hint: str) -> None:
    model = beam(element)
    model.fix("left")
    assert ("too stiff in bending" in warnings(model)) == bool(hint)
    assert hint in warnings(model)


def test_volumetric_locking_is_warned_about() -> None:
    for element, expected in (("Q4D", True), ("Q4I", False)):
        model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2))
        rubber = ct.Elastic(1.0, 0.499)
        model.section("all", element=element, material=rubber, plane="strain")
        model.fix("left")
        assert ("locks in plane strain" in warnings(model)) == expected


def test_bad_shapes_are_found() -> None:
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 1)
    mesh.points[4] = [0.4, -0.2]
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(1.0))
    model.fix("left")
    assert any("inverted or folded" in text for text in errors(model))
    long = ct.Model(ct.mesh.rectangle(100.0, 1.0, 2, 1))
    long.section("all", element="Q4I", material=ct.Elastic(1.0))
    long.fix("left")
    assert "longer than 20 times" in warnings(long)


def test_nodes_at_the_same_place_are_found() -> None:
    a = ct.mesh.rectangle(1.0, 1.0, 1, 1)
    b = ct.mesh.rectangle(1.0, 1.0, 1, 1, origin=(1.0, 0.0))
    model = ct.Model(ct.mesh.merge(a, b, tolerance=0.0))
    assert "same place" not in warnings(model)
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [1, 0], [2, 0], [2, 1], [1, 1.0]])
    cells = ct.mesh.Cells("quad4", np.array([[0, 1, 2, 3], [4, 5, 6, 7]]), np.array([1, 2]))
    assert "2 pairs of nodes lie at the same place" in warnings(ct.Model(ct.Mesh(points, [cells])))


def test_gravity_needs_a_density() -> None:
    model = beam()
    model.fix("left")
    model.gravity(y=-9.81)
    assert "whose material has no density" in errors(model)[0]


def test_mixed_units_are_warned_about() -> None:
    for young, rho, size, text in (
        (2.1e11, 0.0, 100.0, "pascals mixed with millimeters"),
        (2.1e5, 7850.0, 100.0, "wave speed"),
        (2.1e5, 7.85e-9, 100.0, ""),
        (2.1e11, 7850.0, 2.0, ""),
    ):
        model = ct.Model(ct.mesh.rectangle(size, size, 2, 2))
        steel = ct.Elastic(young, 0.3, rho=rho, name="steel")
        model.section("all", element="Q4I", material=steel)
        model.fix("left")
        assert text in warnings(model)
        assert bool(warnings(model)) == bool(text)


def test_unused_sets_are_listed() -> None:
    model = beam()
    model.fix("left")
    listed = [str(d) for d in check(model) if "unused sets" in str(d)]
    assert listed == ["note: unused sets: bottom, top"]


def test_an_initial_velocity_moves_a_body_in_motion_only() -> None:
    model = beam()
    model.loads.clear()
    model.velocity(x=2.0)
    model.steps = [ct.Dynamic(period=1.0)]
    assert "no load" not in warnings(model)
    model.steps = [ct.Static()]
    assert "no load and no moving support" in warnings(model)

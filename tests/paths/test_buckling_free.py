"""Linear buckling of structures that are free where their load does no work."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

LENGTH, HEIGHT, MODULUS = 60.0, 1.0, 1000.0
EULER = np.pi**2 * MODULUS * HEIGHT**3 / 12.0 / LENGTH**2


def strut(angle: float = 0.0, element: str = "Q4I", cells: int = 60) -> ct.Model:
    """A strip pressed at both ends by 1, without supports."""
    mesh = ct.mesh.rectangle(LENGTH, HEIGHT, cells, 2, origin=(0.0, -HEIGHT / 2))
    model = ct.Model(turned(mesh, angle))
    model.section("all", element=element, material=ct.Elastic(MODULUS, 0.0), thickness=1.0)
    along = np.array([np.cos(angle), np.sin(angle)])
    model.force("left", x=along[0], y=along[1])
    model.force("right", x=-along[0], y=-along[1])
    return model


def turned(mesh: ct.Mesh, angle: float) -> ct.Mesh:
    c, s = np.cos(angle), np.sin(angle)
    mesh.points[:] = mesh.points @ np.array([[c, s], [-s, c]])
    return mesh


def frame(cells: int = 6) -> ct.Model:
    """A portal of beams with a force on each column."""
    corners = [(0.0, 0.0), (0.0, 10.0), (14.0, 10.0), (14.0, 0.0)]
    model = ct.Model(ct.mesh.line(corners, n=cells))
    model.beam("all", material=ct.Elastic(MODULUS, 0.0), area=0.5, inertia=0.01)
    for x in (0.0, 14.0):
        model.force([int(np.argmin(np.hypot(*(model.mesh.points - [x, 10.0]).T)))], y=-1.0)
    return model


def feet(model: ct.Model) -> list[int]:
    return list(np.flatnonzero(model.mesh.points[:, 1] == 0.0))


def buckled(model: ct.Model, modes: int = 4) -> ct.Results:
    return ct.solve(model, ct.Buckle(modes=modes), threads=1)


def test_a_frame_that_may_slide_has_the_factors_of_one_that_a_support_stops() -> None:
    free, held = frame(), frame()
    for model in (free, held):
        model.fix(feet(model), x=None, y=0.0, rotation=True)
    held.fix([3], x=0.0, y=None)
    found, expected = buckled(free, 6), buckled(held, 6)
    np.testing.assert_allclose(found.modes[0].factors, expected.modes[0].factors, rtol=1e-7)
    for shape, other in zip(found.modes[0].shapes, expected.modes[0].shapes, strict=True):
        # Modes of a structure that slides have no mean displacement.
        assert abs(shape[:, 0].mean()) < 1e-9
        bent = shape[:, :2] - shape[3, :2] * [1.0, 0.0]
        size = (bent * other[:, :2]).sum() / (other[:, :2] ** 2).sum()
        np.testing.assert_allclose(bent, size * other[:, :2], atol=1e-5)
    assert any("can move in x; the load does no work there" in note for note in found.notes)


@pytest.mark.parametrize("angle", [0.0, 0.7, 1.5708])
def test_a_strut_without_supports_buckles_at_the_euler_load(angle: float) -> None:
    """Modes 1, 2, 3 at 1, 4, 9 times the first, but for the critical strain, 2e-4 to 2e-3."""
    results = buckled(strut(angle), 3)
    factors = results.modes[0].factors
    np.testing.assert_allclose(factors, EULER * np.array([1.0, 4.0, 9.0]), rtol=4e-3)
    ends = results.modes[0].shapes[0, [61, 121], :2]
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-4)
    assert any("the load turns with it" in note for note in results.notes)


def test_a_strut_with_rigid_ends_and_without_supports() -> None:
    """Factors of the held strut, the first by ``k a tan(k (L / 2 - a)) = 1`` with ends of a."""
    factors = []
    for held in (False, True):
        model = ct.Model(ct.mesh.line([(0.0, 0.0), (LENGTH, 0.0)], n=60))
        model.beam("all", material=ct.Elastic(MODULUS, 0.0), area=1.0, inertia=1.0 / 12.0)
        model.rigid([0, 1, 2, 3, 4], 0)
        model.rigid([56, 57, 58, 59, 60], 60)
        model.force([0], x=1.0)
        model.force([60], x=-1.0)
        if held:
            model.fix([0])
            model.fix([60], x=None, y=0.0)
        factors.append(buckled(model, 3).modes[0].factors)
    np.testing.assert_allclose(*factors, rtol=1e-4)
    assert factors[0][0] == pytest.approx(1.003825 * EULER, rel=1e-3)


def test_unloaded_bodies_may_be_free() -> None:
    model = frame()
    model.fix(feet(model), rotation=True)
    expected = buckled(model).modes[0].factors
    mesh, bar = model.mesh, ct.mesh.line([(30.0, 0.0), (31.0, 0.0)], n=1)
    both = ct.Model(ct.mesh.merge(mesh, bar))
    both.beam("all", material=ct.Elastic(MODULUS, 0.0), area=0.5, inertia=0.01)
    both.supports, both.loads = model.supports, model.loads
    np.testing.assert_allclose(buckled(both).modes[0].factors, expected, rtol=1e-9)


def test_a_mast_that_turns_about_its_foot_is_refused() -> None:
    """It falls at any load; only a body without supports takes its load along."""
    model = strut()
    model.fix([60])
    with pytest.raises(ct.ModelError, match=r"at a factor of 0: .* can turn about"):
        buckled(model)


def test_a_load_that_moves_the_body_is_refused() -> None:
    model = strut()
    model.force([20], y=1e-3)
    with pytest.raises(ct.SingularError, match="can move freely"):
        buckled(model)


def test_supports_end_with_the_step() -> None:
    with pytest.raises(ct.CorotaError, match="can move freely"):
        ct.solve(strut(), [ct.Buckle(), ct.Static(nlgeom=False)], threads=1)

"""What a solid of revolution cannot have is refused with the reason, and its axis is kept."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

STEEL = ct.Elastic(E=1000.0, nu=0.3, rho=1.0)


def disc(inner: float = 0.0, element: str = "Q4", **options: object) -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=2))
    model.mesh.points[:, 0] += inner
    model.section("all", element=element, material=STEEL, plane="axisymmetric", **options)
    return model


def test_a_negative_radius_is_refused_by_name() -> None:
    model = disc(-1.0)
    with pytest.raises(ct.ModelError, match="node 1 has the negative radius"):
        ct.solve(model, threads=1)


def test_a_part_in_another_plane_is_refused() -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section([0, 1], element="Q4", material=STEEL, plane="axisymmetric")
    model.section([2, 3], element="Q4", material=STEEL, plane="strain")
    with pytest.raises(ct.ModelError, match="plane strain"):
        ct.solve(model, threads=1)


def test_nodes_on_the_axis_stay_there() -> None:
    model = disc()
    model.fix("bottom", x=None)
    model.pressure("top", 10.0)
    frame = ct.solve(model, threads=1).frames[-1]
    on_axis = model.mesh.points[:, 0] == 0.0
    assert np.abs(frame.U[on_axis, 0]).max() == 0.0
    # As a solid disc between smooth plates: p / E along the axis, nu p / E across.
    assert frame.U[model.mesh.node_sets["right"], 0].mean() == pytest.approx(0.012, rel=0.02)


def test_nodes_on_the_axis_cannot_be_moved_off_it() -> None:
    model = disc()
    model.fix("left", x=0.1)
    with pytest.raises(ct.ModelError, match="lies on the axis"):
        ct.solve(model, threads=1)


def test_a_ring_needs_support_along_its_axis_only() -> None:
    model = disc(1.0)
    model.pressure("right", 1.0)
    assert any("move along y" in d.message for d in model.check())
    model.fix([0], x=None)
    assert not [d for d in model.check() if d.severity == "error"]
    ct.solve(model, threads=1)


def test_loads_and_materials_without_symmetry_are_refused() -> None:
    model = disc(1.0)
    model.fix("bottom")
    model.gravity(x=1.0)
    with pytest.raises(ct.ModelError, match="along the axis"):
        ct.solve(model, threads=1)
    model = disc(1.0)
    model.fix("bottom")
    model.centrifugal(omega=1.0, about=(1.0, 0.0))
    with pytest.raises(ct.ModelError, match="turns about its axis"):
        ct.solve(model, threads=1)
    law = ct.UserMaterial(lambda strain, state, plane: (strain, np.eye(3), state))
    with pytest.raises(ct.InputError, match="no hoop stress"):
        ct.Section("all", "Q4", law, plane="axisymmetric")
    with pytest.raises(ct.InputError, match="constant volume"):
        ct.Section("all", "Q8R", ct.NeoHooke(C10=1.0), plane="axisymmetric")


def test_section_forces_are_refused() -> None:
    model = disc(1.0)
    model.fix("bottom")
    model.pressure("right", 1.0)
    results = ct.solve(model, threads=1)
    with pytest.raises(ct.InputError, match="section forces are for planar models"):
        results.section((0.0, 0.5), (6.0, 0.5))

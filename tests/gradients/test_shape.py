"""Shapes: boundaries that move by control points, with the mesh behind them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota import gradients

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("extension", ["harmonic", "elastic"])
@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "quad9"])
def test_an_affine_motion_is_extended_exactly(cell: str, extension: str) -> None:
    """Stretching by the top side: the inside and the sides that slide follow linearly."""
    mesh = ct.mesh.rectangle(3.0, 1.0, nx=5, ny=3, cell=cell)
    design = ct.shape(mesh, extension=extension, slide={"left": "y", "right": "y"})
    design.control("top", 2, direction=(0.0, 1.0), ends=True)
    moved = design.mesh([0.2, 0.2]).points - mesh.points
    if extension == "harmonic":
        assert moved[:, 1] == pytest.approx(0.2 * mesh.points[:, 1], abs=1e-12)
        assert np.abs(moved[:, 0]).max() < 1e-12
    # An elastic body of different cells is not even; its sides still stand where they must.
    assert np.abs(moved[mesh.node_sets["bottom"]]).max() == 0.0
    assert moved[mesh.node_sets["top"], 1] == pytest.approx(0.2)


def test_splines_pass_through_their_points_and_mirror() -> None:
    mesh = ct.mesh.rectangle(8.0, 1.0, nx=16, ny=2)
    design = ct.shape(mesh)
    assert design.control("top", 3, mirror=("y", 0.5)) == slice(0, 3)
    x = [0.1, -0.2, 0.3]
    points = design.mesh(x).points
    for k, place in enumerate((2.0, 4.0, 6.0)):
        column = np.abs(mesh.points[:, 0] - place) < 1e-9
        y = np.sort(points[column, 1])
        assert y[-1] == pytest.approx(1.0 + x[k])
        assert y[0] == pytest.approx(-x[k])


def test_normals_and_closed_chains() -> None:
    """All four points of a ring's bore move by the same distance: a smaller bore."""
    mesh = ct.mesh.annulus(1.0, 2.0, n_radial=3, n_around=32)
    design = ct.shape(mesh)
    design.control("inner", 4)
    points = design.mesh([0.1] * 4).points
    inner = points[mesh.node_sets["inner"]]
    assert np.hypot(*inner.T) == pytest.approx(0.9)
    design.translate("inner", (1.0, 0.0))
    moved = design.mesh([0.0] * 4 + [0.2]).points[mesh.node_sets["inner"]]
    assert moved == pytest.approx(mesh.points[mesh.node_sets["inner"]] + [0.2, 0.0])


def test_folded_cells_and_wrong_boundaries_are_named() -> None:
    mesh = ct.mesh.rectangle(8.0, 1.0, nx=16, ny=2)
    design = ct.shape(mesh)
    design.control("top", 3)
    with pytest.raises(ct.InputError, match=r"folds \d+ cells.*narrow the bounds"):
        design.mesh([0.0, -1.2, 0.0])
    with pytest.raises(ct.InputError, match="has 3 parameters"):
        design.mesh([0.0])
    with pytest.raises(ct.InputError, match="no edge set"):
        design.control("roof", 2)
    with pytest.raises(ct.InputError, match="mirror image"):
        design.control("top", 2, mirror=("y", 7.0))
    mesh.edge_sets["two"] = np.concatenate([mesh.edge_sets["left"], mesh.edge_sets["right"]])
    with pytest.raises(ct.InputError, match="2 chains"):
        design.control("two", 2)


def cantilever(design: gradients.ShapeDesign, x: np.ndarray) -> ct.Model:
    model = ct.Model(design.mesh(x))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
    model.fix("left")
    model.force("right", y=-0.5)
    return model


def test_gradient_by_the_shape_of_a_run() -> None:
    """From results, and by the function that builds: both are the difference."""
    design = ct.shape(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    design.control("top", 2, mirror=("y", 0.5))
    measures = [gradients.Displacement("right", "y"), gradients.Width("top", "bottom")]
    function = ct.value_and_grad(lambda x: cantilever(design, x), measures, threads=1)
    x = np.array([0.05, -0.1])
    _, exact = function(x)
    results = ct.solve(cantilever(design, x), threads=1)
    found = ct.gradient(results, measures[0], design.parameter())
    assert found == pytest.approx(exact[0], rel=1e-9)
    for k in (0, 1):
        step = 1e-4 * np.eye(2)[k]
        difference = (function(x + step)[0] - function(x - step)[0]) / 2e-4
        assert difference == pytest.approx(exact[:, k], rel=1e-5)


def test_width_is_a_bound_of_the_least_distance() -> None:
    design = ct.shape(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    design.control("top", 1)
    model = cantilever(design, np.array([-0.3]))
    results = ct.solve(model, threads=1)
    least = float(np.ptp(model.mesh.points[np.abs(model.mesh.points[:, 0] - 5.0) < 1e-9, 1]))
    found = [
        gradients.Run(results, [gradients.Width("top", "bottom", p=p)], adjoint=False).values[0]
        for p in (24.0, 200.0)
    ]
    assert found[0] < found[1] < least
    assert found[1] == pytest.approx(least, rel=0.02)


def test_page_of_an_optimization(tmp_path: Path) -> None:
    design = ct.shape(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=2))
    design.control("top", 2, mirror=("y", 0.5))
    sag = gradients.Displacement("right", "y")
    found = ct.optimize(
        lambda x: cantilever(design, x), [0.0, 0.0], gradients.Mass(),
        [gradients.Constraint(sag, lower=-0.25)], bounds=[(-0.3, 0.3)] * 2, most=3, threads=1,
    )  # fmt: skip
    page = tmp_path / "design.html"
    gradients.write_page(found, page, lambda x: cantilever(design, x), names=["root", "tip"])
    text = page.read_text(encoding="utf-8")
    assert text.count("<polyline") == 2
    assert "root" in text
    assert text.count("<path") >= 2
    with pytest.raises(ct.InputError, match="names"):
        gradients.write_page(found, page, names=["one"])

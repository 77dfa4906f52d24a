"""The density method: derivatives through filter and projection, bodies, optimization."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import corota as ct
from corota import gradients
from corota.gradients.runs import Run

if TYPE_CHECKING:
    from pathlib import Path

TIP = gradients.Displacement([20], "y")


def cantilever(mesh: ct.Mesh, thickness: Any) -> ct.Model:
    model = ct.Model(mesh)
    material = ct.Elastic(E=100.0, nu=0.3)
    model.section("all", element="Q4I", material=material, thickness=thickness)
    model.fix("left")
    model.force([20], y=-0.05)
    model.steps = [ct.Static(increments=2)]
    return model


def densities(**options: Any) -> gradients.Density:
    """A strip of 20 x 8 whose tip and one other node are given."""
    mesh = ct.mesh.rectangle(20.0, 8.0, nx=20, ny=8)
    return gradients.Density(mesh, 2.5, solid=[20], void=[100], **options)


@pytest.mark.parametrize(("sharpness", "threshold"), [(0.0, 0.5), (4.0, 0.5), (6.0, 0.7)])
def test_gradient_through_filter_and_projection(sharpness: float, threshold: float) -> None:
    own = densities(sharpness=sharpness, threshold=threshold)
    rng = np.random.default_rng(3)
    x = rng.uniform(0.3, 0.9, own.mesh.n_nodes)
    way = rng.standard_normal(len(x))

    def run(y: np.ndarray) -> Run:
        model = cantilever(own.mesh, own.thicknesses(y))
        return Run(ct.solve(model, fields=False, threads=1), [TIP])

    slope = own.by_design(x, run(x).by(gradients.Thickness(by="node"))[0]) @ way
    h = 1e-4
    near, far = (run(x + k * h * way).values - run(x - k * h * way).values for k in (1, 2))
    assert slope == pytest.approx(float((8.0 * near - far)[0]) / (12.0 * h), rel=1e-7)
    near, far = (own.volume(x + k * h * way)[0] - own.volume(x - k * h * way)[0] for k in (1, 2))
    assert own.volume(x)[1] @ way == pytest.approx((8.0 * near - far) / (12.0 * h), rel=1e-9)


def test_filter_keeps_uniform_densities() -> None:
    own = replace(densities(sharpness=8.0), solid=(), void=())
    for value in (0.0, 0.5, 1.0):
        density = own.densities(np.full(own.mesh.n_nodes, value))[0]
        np.testing.assert_allclose(density, value, atol=1e-12)
    assert own.volume(np.ones(own.mesh.n_nodes))[0] == pytest.approx(1.0)
    assert own.gray(np.ones(own.mesh.n_nodes)) == pytest.approx(0.0, abs=1e-12)


def test_body_follows_the_boundary() -> None:
    """A disc and an island: the area of the disc, its nodes at the radius, the island gone."""
    mesh = ct.mesh.rectangle(4.0, 4.0, nx=40, ny=40)
    radius = np.hypot(*(mesh.points - 2.0).T)
    island = np.hypot(*(mesh.points - 0.3).T)
    own = gradients.Density(mesh, 0.01)
    level = np.clip(0.5 + np.maximum(1.2 - radius, 0.2 - island), 0.0, 1.0)
    body = own.body(level)
    p = body.points[body.cells[0].nodes]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert area.min() > 0.0
    assert area.sum() == pytest.approx(np.pi * 1.2**2, rel=5e-3)
    edge = body.edge_set_nodes(body.boundary_edges())
    np.testing.assert_allclose(np.hypot(*(body.points[edge] - 2.0).T), 1.2, rtol=5e-3)


def test_stiff_cantilever_of_little_material(tmp_path: Path) -> None:
    """Much stiffer than the even sheet of the same volume; it goes on from its record."""
    pytest.importorskip("mmapy", reason="mmapy is not installed (requirements-optimize.txt)")
    start = densities()
    sag = TIP**2

    def find(**options: Any) -> tuple[np.ndarray, gradients.Density]:
        return gradients.optimize_density(
            cantilever, start, sag, 0.4, sharpness=(2.0,), most=8, threads=1, **options
        )

    x, found = find()
    assert found.volume(x)[0] < 0.4 * (1.0 + 1e-3)
    even = start.thicknesses(np.full(len(x), 0.4))
    tips = []
    for thickness in (even, found.thicknesses(x)):
        results = ct.solve(cantilever(start.mesh, thickness), fields=False, threads=1)
        tips.append(abs(results.frames[-1].U[20, 1]))
    assert tips[1] < 0.6 * tips[0]
    record = tmp_path / "designs.jsonl"

    def stop(number: int, design: gradients.Design) -> None:
        if number == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        find(record=record, progress=stop)
    assert find(record=record)[0].tobytes() == x.tobytes()


def test_what_is_refused() -> None:
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell="quad8")
    with pytest.raises(ct.InputError, match="tri3 and quad4"):
        gradients.Density(mesh, 0.5)
    with pytest.raises(ct.InputError, match="radius"):
        gradients.Density(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1), 0.0)
    with pytest.raises(ct.InputError, match="between 0 and 1"):
        gradients.optimize_density(cantilever, densities(), TIP, 1.5)

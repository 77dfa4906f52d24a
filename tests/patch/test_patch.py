"""Constant strain is reproduced exactly on meshes of any shape.

Source: R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985).
"""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.mesh import Cells, Mesh
from corota.model.steps import Static
from corota.verification.problems import distorted_patches
from support.models import (
    DRILLING,
    ELEMENTS,
    ISOPARAMETRIC,
    balance,
    boundary,
    cell,
    linear,
    prescribe,
    run,
)
from support.pairs import cover

DISPLACEMENT, STRESS = 1e-12, 1e-11
BALANCE = 1e-10
#: Displacement of a body held at two nodes: rounding times the condition, about 1e5.
STATICALLY = 1e-10
E, NU, SEEDS = distorted_patches.YOUNG, distorted_patches.POISSON, distorted_patches.SEEDS


def point_values(results, name):
    return np.concatenate([f.values[name].reshape(-1, 4) for f in results.frames[-1].fields])


@pytest.mark.parametrize(("element", "plane"), cover(ELEMENTS, ["stress", "strain"], strength=1))
def test_constant_strain_on_twenty_distorted_meshes(element, plane):
    for seed in range(SEEDS):
        results, h = distorted_patches.solved(element, plane, seed)
        model, mesh = results.model, results.mesh
        u = mesh.points @ h.T
        skew = 0.5 * (h[1, 0] - h[0, 1])
        frame = results.frames[-1]
        assert np.abs(frame.U - u).max() <= DISPLACEMENT * np.abs(u).max()
        if element in DRILLING:
            assert np.abs(frame.UR - skew).max() <= DISPLACEMENT * np.abs(h).max()
        strain = np.array([h[0, 0], h[1, 1], h[0, 1] + h[1, 0]])
        stress = distorted_patches.moduli(plane) @ strain
        found = point_values(results, "S")
        assert np.abs(found[:, [0, 1, 3]] - stress).max() <= STRESS * np.abs(stress).max()
        through = NU * (stress[0] + stress[1]) if plane == "strain" else 0.0
        assert np.abs(found[:, 2] - through).max() <= STRESS * np.abs(stress).max()
        found = point_values(results, "E")
        assert np.abs(found[:, [0, 1, 3]] - strain).max() <= STRESS * np.abs(strain).max()
        assert max(balance(model, frame, moved=False)) <= BALANCE


MACNEAL = np.array(
    [[0, 0], [0.24, 0], [0.24, 0.12], [0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08],
     [0.08, 0.08]]
)  # fmt: skip
QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])


def macneal(element):
    mesh = Mesh(MACNEAL, [Cells("quad4", QUADS, np.arange(1, 6))])
    kind = cell(element)
    if kind.startswith("tri"):
        mesh = ct.mesh.to_triangles(mesh)
    if kind in ("tri6", "quad8", "quad9"):
        mesh = ct.mesh.to_quadratic(mesh, center=kind == "quad9")
    return mesh


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_macneal_harder_patch(element, nlgeom):
    mesh = macneal(element)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e6, nu=0.25), thickness=0.001)
    # With turning frames only infinitesimal strains superpose exactly.
    scale = 1e-9 if nlgeom else 1.0
    x, y = mesh.points.T
    u = scale * 1e-3 * np.stack([x + y / 2, y + x / 2], axis=1)
    edge = boundary(mesh)
    prescribe(model, edge, u[edge], 0.0 if element in DRILLING else None)
    results = ct.solve(model, Static(nlgeom=nlgeom, tolerance=1e-12), threads=1)
    # 1333.333, 1333.333, 400 in the source.
    expected = scale * np.array([4000 / 3, 4000 / 3, 0.0, 400.0])
    tolerance = STRESS if not nlgeom else 1e-8
    assert np.abs(point_values(results, "S") - expected).max() <= tolerance * scale * 1333.0
    assert np.abs(results.frames[-1].U - u).max() <= tolerance * np.abs(u).max()


SIDES = {"bottom": (0, -1), "right": (1, 0), "top": (0, 1), "left": (-1, 0)}


@pytest.mark.parametrize("element", ELEMENTS)
def test_traction_patch_with_free_rotations(element):
    """Edge tractions carry the end moments of drilling elements, so nothing holds rotations."""
    stress = np.array([[3.0, -1.2], [-1.2, -2.0]])
    strain = np.linalg.solve(distorted_patches.moduli("stress"), [3.0, -2.0, -1.2])
    for seed in range(10):
        angle = np.radians(23.0 * seed)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        mesh = ct.mesh.rectangle(3.0, 2.0, 3, 3, cell(element), "alternate")
        mesh = ct.mesh.distort(mesh, 0.3, seed=seed)
        first, second = 0, int(np.argmin(np.abs(mesh.points - [3.0, 0.0]).sum(axis=1)))
        straight = mesh.points.copy()
        mesh = ct.mesh.move(mesh, angle=np.degrees(angle))
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=E, nu=NU), thickness=0.7)
        for name, normal in SIDES.items():
            t = turn @ stress @ np.array(normal, float)
            model.traction(name, x=t[0], y=t[1])
        # Displacement without rotation; the supports hold three dofs with its values.
        h = np.array([[strain[0], strain[2] / 2], [strain[2] / 2, strain[1]]])
        u = straight @ h.T @ turn.T
        prescribe(model, [first], u[[first]])
        model.fix([second], x=None, y=u[second, 1])
        frame = linear(model)
        assert np.abs(frame.U - u).max() <= STATICALLY * np.abs(u).max()
        if element in DRILLING:
            assert np.abs(frame.UR).max() <= STATICALLY * np.abs(h).max()
        assert max(balance(model, frame, moved=False)) <= BALANCE


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_stretched_then_rotated_patch_keeps_its_stress(element, local_strain):
    """A quarter turn after a large stretch turns displacement and stress with it."""
    mesh = distorted_patches.distorted(element, 3)
    model = ct.Model(mesh)
    material = ct.Elastic(E=E, nu=NU)
    model.section("all", element=element, material=material, local_strain=local_strain)
    f = np.array([[1.03, 0.02], [-0.01, 0.97]])
    edge = boundary(mesh)
    steps = []
    for angle in np.radians([0.0, 30.0, 60.0, 90.0]):
        r = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        part = ct.Model(mesh)
        u = mesh.points @ (r @ f).T - mesh.points
        turn = angle - 0.015
        prescribe(part, edge, u[edge], turn if element in DRILLING else None)
        steps.append(Static(supports=part.supports, tolerance=1e-13))
    results = ct.solve(model, steps, threads=1)
    stretched = next(f for f in reversed(results.frames) if f.step == 1)
    turned = results.frames[-1]
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    before, after = mesh.points + stretched.U, mesh.points + turned.U
    size = np.abs(mesh.points).max()
    assert np.abs(after - before @ quarter.T).max() <= STRESS * size
    for old, new in zip(stretched.fields, turned.fields, strict=True):
        s, t = old.values["S"], new.values["S"]
        expected = np.stack([s[..., 1], s[..., 0], s[..., 2], -s[..., 3]], axis=-1)
        assert np.abs(t - expected).max() <= STRESS * np.abs(s).max()
    if local_strain == "green_lagrange" and element in (*ISOPARAMETRIC, "Q4I"):
        u = mesh.points @ f.T - mesh.points
        assert np.abs(stretched.U - u).max() <= STRESS * size


def test_large_strain_patch_is_in_balance():
    mesh = distorted_patches.distorted("Q9", 2)
    model = ct.Model(mesh)
    model.section(
        "all", element="Q9", material=ct.Elastic(E=E, nu=NU), local_strain="green_lagrange"
    )
    edge = boundary(mesh)
    f = np.array([[0.8, -0.7], [0.8, 0.6]])
    prescribe(model, edge, (mesh.points @ f.T - mesh.points)[edge])
    frame = run(model, Static(tolerance=1e-12, increments=4))
    assert max(balance(model, frame)) <= BALANCE

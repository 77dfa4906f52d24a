"""Theorems that any right answer keeps: reciprocity, work, stress times area, turned frames.

Every check names its claim; its docstring says where the reference comes from.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.mesh.data import Cells
from corota.model.loads import Fixed
from support.audits import CELL, DRILLING, boundary, rotation
from support.pairs import cover, quickly

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


def bracket(first: str, second: str, plane: Any) -> tuple[Any, Any, int, int]:
    """Two tied bodies, a rigid handle, an equation, a beam and a spring."""
    a = ct.mesh.rectangle(3.0, 1.0, 3, 2, CELL[first])
    b = ct.mesh.rectangle(1.0, 2.0, 2, 3, CELL[second], origin=(3.0, -0.5))
    mesh = ct.mesh.assembly(a=a, b=b)
    handle = ct.mesh.add_node(mesh, 3.5, 2.5, "handle")
    post = ct.mesh.add_node(mesh, 5.0, 2.5, "post")
    foot = ct.mesh.add_node(mesh, 5.0, 0.0, "foot")
    n = mesh.n_cells
    mesh.cells.append(
        Cells("line2", np.array([[handle, post], [post, foot]]), np.array([900, 901]))
    )
    model = ct.Model(mesh)
    steel = ct.Elastic(E=200.0, nu=0.3)
    wood = ct.Orthotropic(E1=150.0, E2=60.0, E3=80.0, nu12=0.25, nu13=0.2, nu23=0.3, G12=40.0)
    model.section("a", element=first, material=wood, thickness=0.6, plane=plane, orientation=0.5)
    model.section("b", element=second, material=steel, thickness=0.4, plane=plane)
    model.beam([n], material=steel, area=0.1, inertia=0.01, shear_area=0.08)
    model.spring([n + 1], 3.0)
    model.tie("b.left", "a.right", tolerance=0.2)
    model.rigid("b.top", handle)
    model.fix("a.left", rotation=True if first in DRILLING else None)
    model.fix([foot])
    low = mesh.nodes_of("b.bottom")
    model.equation((int(low[0]), "y", 1.0), (int(low[-1]), "y", -0.5))
    return mesh, model, post, handle


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize(
    "pair", [("Q4I", "Q8R"), ("T6", "Q4D"), ("OPT", "Q9"), ("Q4S", "T3"), ("Q4DI", "Q8")]
)
def test_reciprocity_through_all_joints(pair: tuple[str, str], plane: str) -> None:
    """Betti: the work of one load on the displacements of another is the same both ways. Linear."""
    answers = []
    for which in (0, 1):
        mesh, model, post, handle = bracket(*pair, plane)
        if which == 0:
            model.force([post], x=0.3, y=-0.2, moment=0.1)
        else:
            top = mesh.nodes_of("a.top")
            model.force([int(top[len(top) // 2])], y=0.5)
            model.force([handle], moment=0.4)
            model.pressure("b.right", 0.2)
        answers.append(ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1])
    one, two = answers

    def work(f: Any, g: Any) -> float:
        return float(np.sum(f.F[:, :2] * g.U) + np.sum(f.F[:, 2] * g.UR))

    assert work(one, two) == pytest.approx(work(two, one), rel=1e-9)
    for f in answers:  # Clapeyron
        assert f.scalars["ALLWK"] == pytest.approx(work(f, f) / 2, rel=1e-9)
        stored = f.scalars["ALLSE"] + f.scalars["ALLAE"]
        assert stored == pytest.approx(work(f, f) / 2, rel=1e-8)


@pytest.mark.parametrize("strain", ["linear", "logarithmic", "green_lagrange"])
@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T6", "OPT", "Q4D", "Q9", "Q4R", "Q4S"])
def test_energy_rises_by_the_work_of_a_step(element: str, strain: str) -> None:
    """dU = F . du along a far bent state: differences of the stored energy of small steps.

    Handle, dead force and moment, large turns; the energy is a function of the state alone.
    """
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 6, 2, CELL[element]), 0.1, seed=6)
    end = ct.mesh.add_node(mesh, 4.5, 1.0, "end")
    model = ct.Model(mesh)
    model.section(
        "all",
        element=element,
        material=ct.Elastic(E=80.0, nu=0.3),
        thickness=0.5,
        local_strain=strain,
        plane="strain",
    )
    model.fix("left", rotation=True if element in DRILLING else None)
    model.rigid("right", end)
    # Three states near each other.
    h = 1e-3
    steps = []
    for k, s in enumerate((1 - h, 1.0, 1 + h)):
        step = ct.Static(increments=8 if k == 0 else 1, tolerance=1e-11)
        step.force([end], x=-0.1 * s, y=0.3 * s, moment=1.0 * s)
        steps.append(step)
    frames = ct.solve(model, steps, threads=1).frames
    a, b, c = ([f for f in frames if f.step == k][-1] for k in (1, 2, 3))
    rise = sum(sign * (f.scalars["ALLSE"] + f.scalars["ALLAE"]) for sign, f in ((1, c), (-1, a)))
    du, dr = c.U[end] - a.U[end], c.UR[end] - a.UR[end]
    work = float(b.F[end, :2] @ du + b.F[end, 2] * dr)
    assert rise == pytest.approx(work, rel=1e-5)
    assert abs(b.UR[end]) > 0.5


@pytest.mark.parametrize(
    ("element", "strain", "law"),
    cover(
        [e for e in CELL if e != "OPT"],
        ["logarithmic", "green_lagrange"],
        ["elastic", "flow"],
        allowed=lambda _, *case: case != ("green_lagrange", "flow"),  # refused
    ),
)
def test_reaction_is_true_stress_times_current_area(element: str, strain: str, law: str) -> None:
    """A sheet drawn to 1.3 x 1.1 in plane stress and turned: force = Cauchy stress x height x STH.

    Without OPT: the frames of its two triangles turn apart when stretches differ, the rotations of
    nodes cannot fit both. The thickness is that of the output (flow) or follows from the strain.
    """
    t, nu, E = 0.4, 0.3, 200.0
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 2, CELL[element])
    model = ct.Model(mesh)
    material: Any = ct.Elastic(E=E, nu=nu)
    if law == "flow":
        material = ct.Mises(E=E, nu=nu, yield_stress=4.0, isotropic=30.0)
    model.section("all", element=element, material=material, thickness=t, local_strain=strain)
    stretch = np.diag([1.3, 1.1])
    R = rotation(0.9)
    steps = []
    path = [np.eye(2) + k / 6 * (stretch - np.eye(2)) for k in range(1, 7)]
    path += [rotation(0.9 * k / 6) @ stretch for k in range(1, 7)]
    for k, F in enumerate(path):
        u = mesh.points @ (F - np.eye(2)).T
        held = [Fixed([int(i)], d, float(u[i, d])) for i in boundary(mesh) for d in (0, 1)]
        if element in DRILLING:
            held += [Fixed([i], 2, 0.15 * max(k - 5, 0)) for i in range(mesh.n_nodes)]
        steps.append(ct.Static(supports=held, increments=1))
    frame = ct.solve(model, steps, threads=1).frames[-1]
    values = frame.fields[0].values
    S = values["S"][0, 0]
    sigma = R.T @ np.array([[S[0], S[3]], [S[3], S[1]]]) @ R
    if law == "flow":
        thick = values["STH"].ravel()[0]
        assert thick < 0.8 * t
    elif strain == "logarithmic":
        thick = t * math.exp(-nu / (1 - nu) * math.log(1.3 * 1.1))
    else:
        e = (1.3**2 - 1 + 1.1**2 - 1) / 2
        thick = t * math.sqrt(1 - 2 * nu / (1 - nu) * e)
    right = mesh.nodes_of("right")
    # The corners carry the top's and bottom's share too: only the x part in the turned frame.
    force = frame.RF[right, :2].sum(axis=0) @ R
    assert force[0] == pytest.approx(sigma[0, 0] * 1.1 * 1.0 * thick, rel=2e-6)
    top = mesh.nodes_of("top")
    force = frame.RF[top, :2].sum(axis=0) @ R
    assert force[1] == pytest.approx(sigma[1, 1] * 1.3 * 2.0 * thick, rel=2e-6)


@pytest.mark.parametrize(
    "element", quickly(["Q4I", "Q8", "T6", "Q4D", "Q4DI", "OPT", "Q9"], "Q4I", "T6", "Q4D")
)
def test_lamina_in_turned_axes_and_turned_later(element: str) -> None:
    """Orthotropic strip bent far: the same in axes turned by 37 degrees, and after a turn of 75.

    Heat along the material axes, pressure that follows, a moment on a rigid end.
    """
    answers = []
    for angle, later in ((0.0, 0.0), (37.0, 0.0), (0.0, 75.0)):
        mesh = ct.mesh.rectangle(4.0, 1.0, 6, 2, CELL[element])
        mesh = ct.mesh.move(mesh, angle=angle)
        R = rotation(math.radians(angle))
        grip = ct.mesh.add_node(mesh, *(R @ [0.0, 0.5]), name="grip")
        end = ct.mesh.add_node(mesh, *(R @ [4.0, 0.5]), name="end")
        wood = ct.Orthotropic(
            E1=150.0,
            E2=30.0,
            E3=50.0,
            nu12=0.25,
            nu13=0.2,
            nu23=0.3,
            G12=20.0,
            expansion=(1e-3, 4e-3, 2e-3),
        )
        model = ct.Model(mesh)
        model.section(
            "all",
            element=element,
            material=wood,
            thickness=0.6,
            plane="strain",
            orientation=math.radians(30.0 + angle),
        )
        model.rigid("left", grip)
        model.rigid("right", end)
        model.pressure("top", 0.15)
        model.force([end], moment=0.5)
        model.temperature(8.0)
        first = ct.Static(increments=6)
        first.fix([grip], rotation=0.0)
        steps = [first]
        if later:
            turn = ct.Static(increments=6)
            turn.fix([grip], rotation=math.radians(later))
            steps.append(turn)
        frame = ct.solve(model, steps, threads=1).frames[-1]
        total = rotation(math.radians(angle + later))
        x = (mesh.points + frame.U - mesh.points[grip]) @ total
        answers.append((x, frame.UR[end] - math.radians(later), frame.RF[grip], total))
    plain = answers[0]
    assert abs(plain[1]) > 0.2
    for x, turn, reaction, total in answers[1:]:
        assert np.allclose(x, plain[0], atol=1e-6)
        assert turn == pytest.approx(plain[1], abs=1e-7)
        assert np.allclose(reaction[:2] @ total, plain[2][:2], atol=1e-6)
        assert reaction[2] == pytest.approx(plain[2][2], rel=1e-6)

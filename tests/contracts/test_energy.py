"""Work and energy: what loads and supports put in is what the elements hold."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.models import DRILLING, ELEMENTS, cell, cook

pytestmark = pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_energy_of_a_linear_step_is_the_work_of_loads_and_supports(element, plane):
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 5, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0, nu=0.3, rho=2.0)
    model.section("all", element=element, material=material, thickness=0.3, plane=plane)
    model.fix("left", rotation=True)
    model.fix([int(np.argmax(mesh.points.sum(axis=1)))], x=None, y=0.1)
    model.pressure("top", 2.0)
    model.gravity(x=0.3, y=-0.4)
    if element in DRILLING:
        model.force([8], moment=0.2)
    frame = ct.solve(model, Static(nlgeom=False), threads=1).frames[-1]
    energy, work = frame.scalars["strain energy"], frame.scalars["external work"]
    assert abs(work - energy) <= 1e-11 * energy


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_work_over_a_closed_path_vanishes(element, local_strain):
    """Load and unload through large rotation: all work comes back, the rest state too."""
    model, _ = cook(element, 2, local_strain=local_strain)
    model.loads.clear()
    steps = []
    for up, across in ((0.4, 0.0), (0.4, 0.3), (0.0, 0.3), (0.0, 0.0)):
        part = ct.Model(model.mesh)
        part.traction("right", y=up / 16.0, x=across / 16.0)
        steps.append(Static(loads=part.loads, increments=8, tolerance=1e-11))
    frames = ct.solve(model, steps, threads=1).frames
    peak = max(f.scalars["strain energy"] for f in frames)
    assert np.abs(frames[-1].U).max() <= 1e-8 * np.abs(frames[8].U).max()
    assert frames[-1].scalars["strain energy"] <= 1e-12 * peak
    # The trapezoidal rule over eight increments a side.
    assert abs(frames[-1].scalars["external work"]) <= 2e-3 * peak


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q4D", "OPT"])
def test_a_prescribed_displacement_needs_the_force_that_gives_it(element):
    """Moved supports and loads are two sides of one solution; a released support lets go.

    Drilling elements carry a traction on a turned side with end moments too: rotations are moved.
    """
    model, tip = cook(element, 2, force=0.3)
    loaded = ct.solve(model, Static(increments=2, tolerance=1e-12), threads=1).frames[-1]
    edge = model.mesh.node_sets["right"]
    other, _ = cook(element, 2)
    other.loads.clear()
    moved = ct.Model(other.mesh)
    for n in edge:
        turn = float(loaded.UR[n]) if element in DRILLING else None
        moved.fix([int(n)], x=float(loaded.U[n, 0]), y=float(loaded.U[n, 1]), rotation=turn)
    release = Static(new_supports=True, tolerance=1e-12)
    steps = [Static(supports=moved.supports, tolerance=1e-12, increments=2), release]
    frames = ct.solve(other, steps, threads=1).frames
    reached = next(f for f in reversed(frames) if f.step == 1)
    size = np.abs(loaded.U).max()
    assert np.abs(reached.U - loaded.U).max() <= 1e-9 * size
    assert np.abs(reached.RF[edge] - loaded.F[edge]).max() <= 1e-9
    assert np.abs(frames[-1].U).max() <= 1e-8 * size
    assert tip in edge


def test_orthotropic_axes_turn_with_the_body():
    """The same strip in axes turned by 37 degrees, its fibers with it."""
    answers = []
    for angle in (0.0, 37.0):
        mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 8, 2, "quad8"), 0.2)
        model = ct.Model(ct.mesh.move(mesh, angle=angle))
        material = ct.Orthotropic(
            E1=900.0, E2=300.0, E3=200.0, nu12=0.3, nu13=0.2, nu23=0.25, G12=120.0
        )
        turn = np.radians(angle)
        model.section("all", element="Q8", material=material, orientation=0.5 + turn)
        model.fix("left")
        c, s = np.cos(turn), np.sin(turn)
        model.traction("right", x=-2.0 * s, y=2.0 * c)
        frame = ct.solve(model, Static(increments=2), threads=1).frames[-1]
        answers.append(frame.U @ np.array([[c, -s], [s, c]]))
    assert np.abs(answers[0]).max() > 1.0
    assert np.abs(answers[0] - answers[1]).max() <= 1e-10 * np.abs(answers[0]).max()

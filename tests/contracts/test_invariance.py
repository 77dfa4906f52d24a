"""Results do not depend on units, axes, numbering or threads."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.models import ELEMENTS, Watch, cell

SAME = 1e-10
ANGLE = 37.0


def clamped_strip(element, *, meter=1.0, angle=0.0, seed=None, local_strain="linear"):
    """A strip under pressure, end shear and its weight; lengths in units of 1 / meter."""
    mesh = ct.mesh.rectangle(4.0, 1.0, 8, 2, cell(element), "alternate")
    mesh = ct.mesh.distort(mesh, 0.2, seed=4)
    labels = np.arange(mesh.n_nodes)
    mesh = ct.mesh.move(mesh, angle=angle, scale=meter)
    if seed is not None:
        mesh.node_sets["order"] = labels
        mesh = ct.mesh.renumber(mesh, seed=seed)
        labels = mesh.node_sets["order"]
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0 / meter**2, nu=0.3, rho=2.0 / meter**4)
    model.section(
        "all", element=element, material=material, thickness=meter, local_strain=local_strain
    )
    model.fix("left", rotation=True)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    model.traction("right", x=-s * 3.0 / meter**2, y=c * 3.0 / meter**2)
    model.pressure("top", -1.0 / meter**2)
    model.gravity(x=-s * 0.2 * meter, y=c * 0.2 * meter)
    return model, labels


def solved(element, **change):
    """Iterations, displacement by original node, rotations, energy, in the first units."""
    meter, angle = change.get("meter", 1.0), np.radians(change.get("angle", 0.0))
    model, labels = clamped_strip(element, **change)
    watch = Watch()
    frame = ct.solve(model, Static(increments=3), observers=[watch], threads=1).frames[-1]
    back = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    u = frame.U[labels] @ back.T / meter
    mises = np.sort(np.concatenate([f.values["MISES"].ravel() for f in frame.fields]))
    energy = frame.scalars["strain energy"] / meter
    return watch.iterations, u, frame.UR[labels], mises * meter**2, energy


@pytest.mark.parametrize("local_strain", ["linear", "green_lagrange"])
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")
def test_units_axes_and_numbering_do_not_matter(element, local_strain):
    reference = solved(element, local_strain=local_strain)
    assert np.abs(reference[1]).max() > 0.5
    changes = ({"meter": 1000.0}, {"angle": ANGLE}, {"seed": 1})
    for change in changes:
        other = solved(element, local_strain=local_strain, **change)
        assert other[0] == reference[0], change
        for a, b in zip(reference[1:], other[1:], strict=True):
            assert np.abs(a - b).max() <= SAME * np.abs(a).max(), change


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "Q8"])
@pytest.mark.filterwarnings("ignore:.*local strain:UserWarning")
def test_results_are_the_same_bits_for_any_number_of_threads(element):
    """A whole analysis of several thousand cells: assembly, factorization, recovery."""
    answers = []
    for threads in (1, 2, 3, 4, 8):
        mesh = ct.mesh.rectangle(4.0, 2.0, 60, 40, cell(element))
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=1000.0, nu=0.3))
        model.fix("left", rotation=True)
        model.traction("right", y=8.0)
        frame = ct.solve(model, Static(increments=2), threads=threads).frames[-1]
        stress = [f.values["S"].tobytes() for f in frame.fields]
        answers.append((frame.U.tobytes(), frame.UR.tobytes(), frame.RF.tobytes(), *stress))
    assert all(answer == answers[0] for answer in answers)

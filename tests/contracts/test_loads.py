"""Loads add up as forces do: resultants, amplitudes of their own, totals beside tractions."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.loads import Amplitude, BodyForce
from corota.model.steps import Static
from support.models import DRILLING, ELEMENTS, balance, boundary, cell, linear

ROUNDOFF = 1e-12


def strip(element="Q4I", thickness=0.5, rho=3.0):
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 1.0, 4, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1000.0, nu=0.3, rho=rho)
    model.section("all", element=element, material=material, thickness=thickness)
    model.fix("left", rotation=True)
    return model


def total(frame):
    return frame.F[:, :2].sum(axis=0)


def rotating(model, frame):
    x = model.mesh.points
    return float(x[:, 0] @ frame.F[:, 1] - x[:, 1] @ frame.F[:, 0] + frame.F[:, 2].sum())


@pytest.mark.parametrize("element", ELEMENTS)
def test_resultants(element):
    """Force and moment about the origin of every kind of load."""
    expected = {
        # t A at the middle of the edge
        "traction": ((1.0, -2.0), 4.0 * -2.0 - 0.5 * 1.0),
        # downwards on the top, at its middle
        "pressure": ((0.0, -6.0), -12.0),
        "force": ((0.0, 5.0), 20.0),
        "gravity": ((12.0, -6.0), 2.0 * -6.0 - 0.5 * 12.0),
    }
    for kind, (force, moment) in expected.items():
        model = strip(element)
        if kind == "traction":
            model.traction("right", x=2.0, y=-4.0)
        elif kind == "pressure":
            model.pressure("top", 3.0)
        elif kind == "force":
            edges = model.mesh.edge_sets["right"]
            model.mesh.edge_sets["end"] = edges
            model.force("end", y=5.0)
        else:
            model.gravity(x=2.0, y=-1.0)
        frame = linear(model)
        assert np.abs(total(frame) - force).max() <= ROUNDOFF * 10, kind
        assert abs(rotating(model, frame) - moment) <= ROUNDOFF * 30, kind
        assert max(balance(model, frame, moved=False)) <= 1e-10, kind
        assert ((np.abs(frame.F[:, 2]).max() > 0.0) == (element in DRILLING)) or kind == "force"


@pytest.mark.parametrize("element", ["Q9", "Q4D", "OPT"])
def test_hydrostatic_pressure_dilates_without_rotation(element):
    """Pressure on every side, also large and following: U = -c X and no rotation."""
    for nlgeom in (False, True):
        mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(element)), 0.2)
        model = ct.Model(mesh)
        model.section("all", element=element, material=ct.Elastic(E=100.0, nu=0.25))
        model.fix([0], x=0.0, y=0.0)
        model.fix([int(np.argmax(mesh.points[:, 0] - mesh.points[:, 1]))], x=None, y=0.0)
        p = 1e-7
        model.pressure(mesh.boundary_edges(), p)
        frame = linear(model) if not nlgeom else ct.solve(model, Static()).frames[-1]
        shrink = p * (1 - 0.25) / 100.0
        assert np.abs(frame.U + shrink * mesh.points).max() <= 1e-7 * shrink
        assert np.abs(frame.UR).max() <= 1e-7 * shrink
        assert len(boundary(mesh)) > 0


def test_loads_on_one_set_keep_their_own_amplitudes():
    """Two tractions and two forces, one of each held back by its amplitude."""
    model = strip()
    model.amplitudes["late"] = Amplitude(np.array([0.0, 1.0]), np.array([0.0, 0.25]))
    model.traction("right", x=2.0)
    model.traction("right", y=8.0, amplitude="late")
    frame = linear(model)
    assert np.abs(total(frame) - [1.0, 1.0]).max() <= ROUNDOFF * 10
    model = strip()
    model.amplitudes["late"] = Amplitude(np.array([0.0, 1.0]), np.array([0.0, 0.25]))
    model.force([3], y=2.0)
    model.force([3], y=8.0, amplitude="late")
    assert np.abs(total(linear(model)) - [0.0, 4.0]).max() <= ROUNDOFF * 10


def test_a_total_force_beside_a_traction():
    model = strip()
    model.mesh.edge_sets["end"] = model.mesh.edge_sets["right"]
    model.force("end", y=5.0)
    model.traction("end", y=4.0)
    assert np.abs(total(linear(model)) - [0.0, 7.0]).max() <= ROUNDOFF * 10


def test_two_gravities_and_two_pressures_add_up():
    model = strip()
    model.gravity(y=-1.0)
    model.gravity(y=-2.0)
    model.pressure("top", 1.0)
    model.pressure("top", 0.5)
    assert np.abs(total(linear(model)) - [0.0, -18.0 - 3.0]).max() <= ROUNDOFF * 30


def test_two_spins_add_up():
    """Each about its own center."""
    parts = []
    for centers in ([(0.0, 0.0)], [(1.0, 2.0)], [(0.0, 0.0), (1.0, 2.0)]):
        model = strip()
        model.loads += [BodyForce("", "centrifugal", (2.0, *c)) for c in centers]
        parts.append(linear(model).F)
    assert np.abs(parts[0] + parts[1] - parts[2]).max() <= ROUNDOFF * 30


def test_a_load_with_an_amplitude_replaces_at_once():
    model = strip()
    model.amplitudes["half"] = Amplitude(np.array([0.0, 1.0]), np.array([0.5, 0.5]))
    first, second = ct.Model(model.mesh), ct.Model(model.mesh)
    first.traction("right", y=1.0)
    first.force([3], x=1.0)
    second.traction("right", y=3.0, amplitude="half")
    second.force([3], x=3.0, amplitude="half")
    steps = [Static(nlgeom=False, loads=m.loads, increments=2) for m in (first, second)]
    frames = ct.solve(model, steps, threads=1).frames
    for frame, expected in zip(frames, (0.0, 0.5, 1.0, 1.5, 1.5), strict=True):
        assert np.abs(total(frame) - [expected, 0.5 * expected]).max() <= ROUNDOFF * 10


def test_a_later_step_replaces_and_the_ramp_is_linear():
    model = strip()
    steps = []
    for value in (1.0, 3.0):
        part = ct.Model(model.mesh)
        part.traction("right", y=value)
        part.force([3], x=value)
        steps.append(Static(nlgeom=False, loads=part.loads, increments=2))
    frames = ct.solve(model, steps, threads=1).frames
    for frame, expected in zip(frames, (0.0, 0.5, 1.0, 2.0, 3.0), strict=True):
        assert np.abs(total(frame) - [expected, 0.5 * expected]).max() <= ROUNDOFF * 10


@pytest.mark.parametrize("load", ["traction", "pressure", "gravity", "centrifugal"])
def test_whole_numbers_are_numbers(load):
    """A thickness, a modulus and a load given as integers are those given as floats."""
    ends = []
    for number in (int, float):
        model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 1))
        material = ct.Elastic(E=number(1000), nu=0.3, rho=number(1))
        model.section("all", element="Q4I", material=material, thickness=number(2))
        model.fix("left")
        if load == "traction":
            model.traction("right", y=number(1))
        elif load == "pressure":
            model.pressure("top", number(1))
        elif load == "gravity":
            model.gravity(y=number(-1))
        else:
            model.centrifugal(number(1), about=(number(0), number(0)))
        ends.append(ct.solve(model, ct.Static(), threads=1).frames[-1].U)
    assert (ends[0] == ends[1]).all()

"""Central differences with contact at nodes that have axes of their own."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct

#: Angle of the axes of nodes [rad].
TURN = 0.5


def block(turn: float) -> ct.Model:
    """A square of edge 1 that moves down on a floor .05 below it, all turned about the origin."""
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=2, ny=2)
    c, s = np.cos(turn), np.sin(turn)
    mesh.points[:] = mesh.points @ np.array([[c, s], [-s, c]])
    model = ct.Model(mesh)
    model.section("all", element="Q4", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
    model.velocity("all", x=0.3 * c + s, y=0.3 * s - c)
    return model


def floor(turn: float) -> ct.RigidCurve:
    """A line along the first axis, .05 below the block."""
    c, s = np.cos(turn), np.sin(turn)
    ends = [(c * x + s * 0.05, s * x - c * 0.05) for x in (-5.0, 5.0)]
    return ct.RigidCurve.line(*ends)


def last(model: ct.Model) -> ct.Frame:
    """The end of a motion in which the block bounces."""
    step = ct.Dynamic(period=0.2, scheme="central_difference")
    return ct.solve(model, step).frames[-1]


@pytest.mark.parametrize("law", [None, ct.PressureLaw("linear", 1e4)])
@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_axes_of_free_nodes_do_not_matter(friction, method, law):
    found = []
    for axes in (False, True):
        model = block(0.0)
        if axes:
            model.local_axes("all", angle=TURN)
        model.contact("bottom", floor(0.0), friction=friction, method=method, law=law, name="floor")
        frame = last(model)
        energies = [frame.scalars[name] for name in ("ALLFD", "ALLPW", "ALLKE", "ALLSE")]
        found.append((frame.U, frame.V, energies))
    for plain, turned in zip(*found, strict=True):
        assert turned == pytest.approx(plain, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_guide_along_an_axis_turns_with_the_problem(friction):
    """A block in an inclined guide is that in a vertical one, turned."""
    found = []
    for turn in (0.0, TURN):
        model = block(turn)
        if turn:
            model.local_axes("left", angle=turn)
        model.fix("left", x=0.0, y=None)
        model.contact("bottom", floor(turn), friction=friction)
        u = last(model).U
        c, s = np.cos(turn), np.sin(turn)
        found.append(u @ np.array([[c, -s], [s, c]]))
    assert found[1] == pytest.approx(found[0], rel=1e-8, abs=1e-11)
    assert np.abs(found[0]).max() > 0.01


def test_a_free_body_whose_nodes_have_axes_flies_on():
    model = block(0.0)
    model.local_axes("all", angle=TURN)
    assert pytest.approx(np.tile([0.06, -0.2], (9, 1)), abs=1e-12) == last(model).U


def test_a_tie_between_bodies_with_axes():
    """Two bodies joined at nodes with axes deform as those without."""
    found = []
    for axes in (False, True):
        mesh = ct.mesh.assembly(
            lower=ct.mesh.rectangle(1.0, 0.5, nx=2, ny=1),
            upper=ct.mesh.rectangle(1.0, 0.5, nx=3, ny=1, origin=(0.0, 0.5)),
        )
        model = ct.Model(mesh)
        model.section("all", element="Q4", material=ct.Elastic(E=1000.0, nu=0.3, rho=1.0))
        model.fix("lower.bottom")
        model.velocity("upper", x=1.0, y=-1.0)
        model.tie("upper.bottom", "lower.top")
        if axes:
            model.local_axes("upper.bottom", angle=TURN)
            model.local_axes("lower.top", angle=-TURN)
        found.append(last(model).U)
    assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-12)

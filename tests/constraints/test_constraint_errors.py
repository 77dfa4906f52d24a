"""Impossible constraints are found and named."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.errors import Location
from corota.model.constraints import Coupling, Equation
from support.tied import beam


def at(line: int) -> Location:
    return Location("job.inp", line)


def fails(model: ct.Model, *words: str) -> None:
    with pytest.raises(ct.InputError) as caught:
        ct.solve(model)
    for word in words:
        assert word in str(caught.value)


def test_circle_is_named_with_its_places() -> None:
    model, _ = beam()
    a, b, c = model.mesh.nodes_of("right")
    model.constraints += [
        Equation([(a, 0, 1.0), (b, 0, -1.0)], where=at(10)),
        Equation([(b, 0, 1.0), (c, 0, -1.0)], where=at(12)),
        Equation([(c, 0, 1.0), (a, 0, -1.0)], where=at(14)),
    ]
    fails(model, "circularly", "job.inp:10", "job.inp:12", "job.inp:14")


def test_dof_determined_twice_is_named_with_both_places() -> None:
    model, reference = beam()
    a, b, _ = model.mesh.nodes_of("right")
    model.constraints += [
        Coupling("right", reference, name="rigid body", where=at(3)),
        Equation([(a, 1, 1.0), (b, 1, -1.0)], where=at(7)),
    ]
    label = model.mesh.node_labels[a]
    fails(model, f"node {label} y is determined twice", "job.inp:3", "job.inp:7")


def test_support_at_a_dependent_dof_is_named_with_both_places() -> None:
    model, reference = beam()
    model.constraints.append(Coupling("left", reference, name="rigid body", where=at(3)))
    model.fix("left")
    fails(model, "is supported, but the rigid body with reference node", "job.inp:3")


def test_reference_node_held_by_nothing_is_named() -> None:
    model, reference = beam()
    model.rigid("left", reference)
    model.fix([reference])  # turns freely
    model.force("right", y=1.0, per_node=True)
    with pytest.raises(ct.SingularError, match="unconstrained"):
        ct.solve(model)


def test_distributing_coupling_needs_two_places() -> None:
    model, reference = beam()
    model.couple([0], reference, kind="distributing")
    fails(model, "two positions")


def test_loose_node_in_a_distributing_coupling() -> None:
    model, reference = beam()
    model.couple([0, 1, reference + 1], reference, kind="distributing")
    fails(model, "belongs to no element")


def test_rotation_of_a_node_without_one() -> None:
    model, _ = beam(element="Q4I")
    model.equation((0, "rotation", 1.0), (1, "rotation", -1.0))
    fails(model, "has no drilling rotation to constrain")


def test_radial_axes_at_the_center() -> None:
    model, _ = beam()
    model.local_axes([0], center=tuple(model.mesh.points[0]))
    fails(model, "no radial direction")


def test_force_that_nothing_carries() -> None:
    model, reference = beam()
    model.equation((reference, "x", 1.0), (0, "x", -1.0))
    model.fix("left")
    model.force([reference], y=1.0)
    fails(model, "cannot carry a force")


def test_equation_without_pivot() -> None:
    with pytest.raises(ct.InputError, match="must not be zero"):
        Equation([(0, 0, 0.0), (1, 0, 1.0)])
    with pytest.raises(ct.InputError, match="finite"):
        Equation([(0, 0, np.nan)])
    with pytest.raises(ct.InputError, match="at least one term"):
        Equation([])

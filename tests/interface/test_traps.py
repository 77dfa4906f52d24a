"""What surprised new users: it says something, or does what they expected."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re

import numpy as np
import pytest

import corota as ct
from corota.model.contact import RigidCurve
from corota.model.single_point import LawOfTheCore
from corota.model.units import Units


def strip(element: str = "Q4I") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2))
    model.section(element=element, material=ct.Elastic(1000.0, 0.3))
    return model


def test_check_takes_the_steps_that_will_run() -> None:
    """Supports of a step hold the body, and a fault of a step is found before it runs."""
    model = strip()
    model.force("right", y=-1.0)
    step = ct.Static()
    step.fix("left")
    assert model.check().errors
    assert not model.check(step).errors
    assert not model.check([step]).errors
    assert not model.steps
    late = ct.Static(loads=[ct.NodalForce("right", 0, 1.0, amplitude="up")])
    late.supports = step.supports
    assert "no amplitude named 'up'" in str(model.check(late).errors[0])


@pytest.mark.parametrize("element", ["Q4I", "Q8R", "T3"])
def test_a_rotation_that_no_element_has_is_told(element: str) -> None:
    cell = {"Q8R": "quad8", "T3": "tri3"}.get(element, "quad4")
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, 4, 2, cell))
    model.section(element=element, material=ct.Elastic(1000.0, 0.3))
    model.fix("left", rotation=True)
    model.force("right", y=-0.1)
    words = r"rotation=0 of 'left' has no effect: .*OPT, Q4D, Q4DI and of beams"
    notes = ct.solve(model, ct.Static(), threads=1).notes
    assert any(re.match(words, note) for note in notes)
    assert any(re.match(words, d.message) for d in model.check(ct.Static()).warnings)


def test_a_rotation_is_held_where_elements_have_one() -> None:
    model = strip("Q4D")
    model.fix("left", rotation=True)
    model.force("right", y=-0.1)
    results = ct.solve(model, ct.Static(), threads=1)
    assert results.frames[-1].UR[0] == 0.0
    assert not any("rotation" in note for note in results.notes)
    assert not any("rotation" in d.message for d in model.check(ct.Static()).warnings)


def test_the_gap_is_known_before_the_first_increment() -> None:
    """A block over a floor: the gap of the drawing, not zero."""
    model = strip()
    model.fix("top", x=0.0, y=-0.1)
    model.contact("bottom", RigidCurve.line((-1.0, -0.25), (5.0, -0.25)), name="floor")
    model.contact("right", RigidCurve.line((4.5, 0.0), (4.5, 2.0)), name="wall")
    results = ct.solve(model, ct.Static(increments=2), threads=1)
    for frame, gap in zip(results.frames, (0.25, 0.2, 0.15), strict=True):
        nodes = model.mesh.nodes_of("bottom")[:-1]  # the last one sees the wall, too
        assert frame.C is not None
        assert frame.C[nodes, 2] == pytest.approx(np.full(4, gap))
        assert frame.pairs["floor"][nodes, 2] == pytest.approx(np.full(4, gap))
        assert frame.C[nodes, 4].max() == 0.0


def test_a_law_without_first_yield_cannot_be_made() -> None:
    with pytest.raises(TypeError, match="abstract"):
        LawOfTheCore()  # type: ignore[abstract]


def test_a_step_that_was_not_called_is_named() -> None:
    for given in (ct.Static, [ct.Static], [ct.Static(), ct.Dynamic]):
        with pytest.raises(ct.InputError, match=r"is a class: write (Static|Dynamic)\(\)"):
            ct.solve(strip(), given)  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="not 'static'"):
        ct.solve(strip(), ["static"])  # type: ignore[list-item]


def test_an_amplitude_that_is_none_is_named() -> None:
    model = strip()
    model.amplitudes["up"] = [(0.0, 0.0), (1.0, 1.0)]  # type: ignore[assignment]
    model.force("right", y=1.0, amplitude="up")
    with pytest.raises(ct.ModelError, match=r"'up' is no Amplitude but list: .*ct\.Amplitude"):
        ct.solve(model, ct.Static(), threads=1)


def test_units_are_set_by_call_or_by_assignment() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    model.units = "mm"  # type: ignore[assignment, method-assign]
    assert model.unit_system == Units.of("mm")
    model.units = ("mm", "N", "t")  # type: ignore[assignment, method-assign]
    assert model.unit_system == Units.of("mm", "N", "t")
    model.units("m")
    assert model.unit_system == Units.of("m")
    with pytest.raises(ct.InputError, match="cubit"):
        model.units = "cubit"  # type: ignore[assignment, method-assign]
    with pytest.raises(AttributeError, match=r"call model\.fix"):
        model.fix = 1.0  # type: ignore[assignment, method-assign]


def test_a_direction_that_is_fixed_with_another_is_in_the_summary() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    model.section(element="Q4", material=ct.Elastic(1.0, 0.3))
    model.fix("left")
    model.fix("bottom", x=None, y=0.5)
    model.steps.append(ct.Static())
    model.steps[0].fix("right", x=1.0)
    lines = model.summary().splitlines()
    assert "  support left: x 0, y 0" in lines
    assert "  support bottom: y 0.5" in lines
    assert "  support right: x 1, y 0 (fixed as well: y=None leaves it free)" in lines

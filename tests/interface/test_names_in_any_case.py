"""A name in another case means the name: what is accepted is also taken."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
from pathlib import Path

import pytest

import corota as ct


def _removed(kind: str) -> ct.Static:
    step = ct.Static()
    step.remove(kind)
    return step


@pytest.mark.parametrize(
    ("make", "attribute", "name"),
    [
        (lambda name: ct.Norton(A=1e-9, n=3.0, hardening=name), "hardening", "strain"),
        (lambda name: ct.Static(at_bifurcation=name), "at_bifurcation", "stop"),
        (lambda name: ct.Dynamic(mass=name), "mass", "lumped"),
        (lambda name: ct.Frequency(mass=name), "mass", "lumped"),
        (lambda name: ct.SteadyState(lowest=0.0, highest=1.0, mass=name), "mass", "lumped"),
        (lambda name: ct.EdgeLoad("top", name, (1.0,)), "kind", "pressure"),
        (lambda name: ct.BodyForce("", name, (0.0, 1.0)), "kind", "gravity"),
    ],
)
def test_an_attribute_is_the_name_it_matches(make, attribute, name):
    assert getattr(make(name.title()), attribute) == name
    assert make(name.upper()) == make(name)


def test_loads_are_removed_by_their_kind_in_any_case():
    assert _removed("Force").ended == _removed("force").ended == {"force"}


def test_points_of_a_sample_do_not_depend_on_the_case_of_its_engine():
    ranges = {"t": (0.0, 1.0)}
    assert ct.sample(4, ranges, engine="Sobol") == ct.sample(4, ranges, engine="sobol")


def test_no_choice_is_checked_and_then_left():
    for path in Path(ct.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                assert getattr(node.value.func, "id", "") != "choose", f"{path}:{node.lineno}"

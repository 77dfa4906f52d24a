"""What objects look like in a shell and in a notebook: short, and never an error."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import inspect
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.errors import Diagnostic
from corota.model.materials import Material
from corota.sweeps.variant import Outcome

LONGEST = 2000


def large_model() -> ct.Model:
    """Every kind of public data in one model, with arrays that must not be printed."""
    mesh = ct.mesh.rectangle(40.0, 10.0, nx=80, ny=20)
    mesh.node_sets |= {f"a long name of a node set {i}": np.arange(50) for i in range(100)}
    model = ct.Model(mesh, name="m" * 300)
    curve = [(200.0 + i, 1e-3 * i) for i in range(500)]
    many = np.arange(1000)
    model.section(many, element="Q4I", material=ct.Mises(E=1e5, nu=0.3, yield_curve=curve))
    model.section(
        np.arange(1000, 1600), element="Q4", material=ct.UserMaterial(lambda e, s, p: (e, e, s))
    )
    model.fix(many)
    model.force(many, y=0.1)
    model.velocity(many, x=1.0)
    model.point_mass(many, 1.0)
    model.dashpot(1, 2, c=1.0)
    model.equation(*[(i, "x", 1.0) for i in range(900)])
    model.couple(np.arange(100, 900), 3, weights=np.ones(800))
    model.straight(np.arange(100, 900), 0, 1)
    model.local_axes(many, angle=0.1)
    model.contact(mesh.edge_sets["top"], ct.RigidCurve.line((0.0, 12.0), (40.0, 12.0)))
    model.contact(mesh.edge_sets["top"], mesh.edge_sets["bottom"], name="p" * 3000)
    model.tie(mesh.edge_sets["top"], mesh.edge_sets["bottom"])
    model.pressure("right", 1.0)
    model.gravity(9.81)
    for kind in (ct.Static, ct.Dynamic, ct.Frequency, ct.Buckle, ct.ModalDynamic):
        model.steps.append(kind())
    model.steps[0].fix(many)
    model.steps[0].force(many, y=1.0)
    model.steps[0].outputs += [ct.Output("node file", ("U",) * 700)]
    model.notes += ["a note " * 100] * 100
    return model


@pytest.fixture(scope="module")
def results() -> ct.Results:
    model = ct.Model(ct.mesh.rectangle(20.0, 4.0, nx=20, ny=4), name="strip")
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.force("right", y=-0.1)
    return ct.solve(model, ct.Static(increments=20), threads=1)


def sought() -> ct.Sought:
    """A search of a thousand runs."""
    rows = [{"length": float(i)} for i in range(1000)]
    outcomes = [Outcome({"tip": 1.0}, notes=["a note " * 100]) for _ in rows]
    return ct.Sought("length", 1.0, 1.0, 1.0, ct.Sweep(rows, ["tip"], outcomes))


def within(value: Any, depth: int = 0) -> Iterator[Any]:
    """A value and the Corota objects in it."""
    if depth > 4:
        return
    if type(value).__module__.startswith("corota"):
        yield value
        parts = vars(value).values() if hasattr(value, "__dict__") else []
        if is_dataclass(value):
            parts = [getattr(value, f.name) for f in fields(value)]
        for part in parts:
            yield from within(part, depth + 1)
    elif isinstance(value, list | tuple | dict):
        members = value.values() if isinstance(value, dict) else value
        for member in list(members)[:30]:
            yield from within(member, depth + 1)


def test_no_representation_is_long(results: ct.Results) -> None:
    """Over every object of a large model and of results, all public data among them."""
    errors = [kind("w" * 9000) for kind in (ct.InputError, ct.ModelError, ct.FileError)]
    messages = [Diagnostic("error", "m" * 500) for _ in range(200)]
    things: list[Any] = [
        large_model(), results, results.history("U2"), results.at(node=3),
        results.along([(0.0, 1.0), (20.0, 1.0)]), ct.Findings(messages), ct.DeckError(messages),
        ct.JobFiles("."), results.body_motion("right"), sought(), *errors,
    ]  # fmt: skip
    seen = [item for thing in things for item in within(thing)]
    assert len({type(item).__name__ for item in seen}) > 30
    for item in seen:
        text = repr(item)
        assert len(text) <= LONGEST, f"{type(item).__name__}: {len(text)}: {text[:300]}"
        assert "array([" not in text
    public = {c for n in ct.__all__ if inspect.isclass(c := getattr(ct, n)) and is_dataclass(c)}
    missing = {c.__name__ for c in public} - {type(item).__name__ for item in seen}
    # Those have a few numbers each and no arrays.
    small = {
        "Amplitude", "ArcLength", "BodyForce", "CowperSymonds", "CriticalPoint",
        "DecayingFriction", "DisplacementControl", "Expansion", "FrictionTable", "InitialStress",
        "InitialTemperature", "Iteration", "Modes", "Norton", "PressureLaw", "RateCurves",
        "SteadyState", "Temperature", "Visco",
        "Voce", "WLF", "YieldRatio",
    }  # fmt: skip
    materials = {c.__name__ for c in public if issubclass(c, Material)}
    assert missing <= small | materials


def test_what_is_shown_says_what_it_is(results: ct.Results) -> None:
    assert repr(results).startswith("Results('strip': 21 frames, last step 1 increment 20")
    assert repr(results.model).startswith("Model('strip': 105 nodes, 80 elements")
    assert "80 quad4" in repr(results.mesh)
    assert "21 values" in repr(results.history("U2"))
    assert "U=array(105 x 2)" in repr(results.frame())
    assert repr(ct.Elastic(E=2.0, nu=0.25)).startswith("Elastic(")


@pytest.mark.parametrize("what", ["model", "mesh", "results", "history"])
def test_notebooks_show_a_picture_and_a_table(results: ct.Results, what: str) -> None:
    pytest.importorskip("matplotlib")
    shown: Any = {
        "model": results.model,
        "mesh": results.mesh,
        "results": results,
        "history": results.history("U2", at="right"),
    }[what]
    html = shown._repr_html_()
    assert html.count("<img") == 1
    assert "data:image/png;base64," in html
    assert "<table>" in html
    assert "<script" not in html


def test_names_are_escaped_in_notebooks() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1), name="<b>a & b")
    assert "&lt;b&gt;a &amp; b" in model._repr_html_()
    assert "<b>" not in model._repr_html_()

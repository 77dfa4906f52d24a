"""Copying, summing up, checking and drawing a model; names that a user imports."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import inspect
from pathlib import Path

import numpy as np
import pytest

import corota as ct


@pytest.fixture
def model() -> ct.Model:
    made = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=4, ny=1), name="strip")
    made.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    made.fix("left")
    made.force("right", y=-0.1)
    return made


def test_a_copy_shares_nothing(model: ct.Model) -> None:
    other = model.copy()
    other.fix([9], x=1.0)
    other.mesh.points[0] = 7.0
    other.sections[0].thickness = 3.0
    assert len(model.supports) == 2
    assert model.mesh.points[0, 0] == 0.0
    assert model.sections[0].thickness == 1.0


def test_the_summary_names_what_is_there(model: ct.Model) -> None:
    text = model.summary()
    for words in ("strip: 10 nodes, 4 elements", "Q4I", "left", "2 supports, 1 loads"):
        assert words in text


def test_the_check_finds_a_free_body_and_prints_as_text(model: ct.Model) -> None:
    assert not model.check().errors
    model.supports.clear()
    found = model.check()
    assert "free body" in found.errors[0].message
    assert "error: a free body" in str(found)
    assert isinstance(found.warnings, list)


def test_contact_surfaces_count_as_used(model: ct.Model) -> None:
    model.contact("top", ct.RigidCurve.line((10.0, 2.0), (0.0, 2.0)))
    notes = " ".join(d.message for d in model.check())
    assert "unused sets" in notes
    assert "top" not in notes.split("unused sets")[1]


@pytest.mark.usefixtures("quick_pictures")
def test_results_and_models_draw_themselves(model: ct.Model, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    results = ct.solve(model, ct.Static(), threads=1)
    for figure in (results.plot(), model.plot()):
        figure.savefig(tmp_path / "picture.png")
    frame = ct.Model(ct.Mesh(np.array([[0.0, 0.0], [1.0, 0.0]]), [_bar()]))
    frame.spring([0], 2.0)
    frame.fix([0])
    frame.fix([1], x=None)
    frame.force([1], x=1.0)
    ct.solve(frame, ct.Static(), threads=1).plot().savefig(tmp_path / "spring.png")


def _bar() -> ct.Cells:
    return ct.Cells("line2", np.array([[0, 1]]), np.array([1]))


@pytest.mark.parametrize("name", ct.examples.names())
def test_examples_are_models_that_a_check_accepts(name: str) -> None:
    model = ct.examples.load(name)
    assert model.steps
    assert ct.examples.describe(name).endswith(".")
    assert not model.check().errors


@pytest.mark.parametrize("name", ct.__all__)
def test_every_public_name_is_there_and_documented(name: str) -> None:
    value = getattr(ct, name)
    if inspect.isclass(value) or inspect.isfunction(value) or inspect.ismodule(value):
        assert (value.__doc__ or "").strip(), name


def test_observers_hear_events_and_need_only_those_they_want(model: ct.Model) -> None:
    class Counter(ct.BaseObserver):
        frames = 0

        def increment(self, frame: ct.Frame) -> None:
            self.frames += 1

    counter = Counter()
    ct.solve(model, ct.Static(increments=2), observers=[counter], threads=1)
    assert counter.frames == 3


def test_results_that_are_zero_everywhere_have_a_picture(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    idle = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    idle.section(element="Q4", material=ct.Elastic(E=1.0))
    idle.fix("left")
    ct.solve(idle, ct.Static()).plot(path=tmp_path / "zero.png")
    assert (tmp_path / "zero.png").stat().st_size > 1000

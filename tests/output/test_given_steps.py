"""Files of results are the same for steps of the model and for steps given to solve."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re

import pytest

import corota as ct
from corota.model.steps import Output


def bent(*, given: bool, nlgeom: bool) -> ct.Results:
    """A bar whose supports, loads and requests are those of its step."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    step = ct.Static(increments=1, nlgeom=nlgeom)
    step.fix("left", x=0.0, y=0.0)
    step.force("right", y=1.0)
    step.outputs = [
        Output("node print", ("U", "RF"), "right"),
        Output("section print", ("SOF", "SOM"), "right"),
    ]
    if given:
        return ct.solve(model, [step], threads=1)
    model.steps = [step]
    return ct.solve(model, threads=1)


@pytest.mark.parametrize("nlgeom", [False, True])
@pytest.mark.parametrize("suffix", ["csv", "dat", "frd", "sta"])
def test_files_do_not_depend_on_where_the_steps_come_from(tmp_path, suffix, nlgeom):
    texts = []
    for given in (False, True):
        path = tmp_path / f"{given}.{suffix}"
        bent(given=given, nlgeom=nlgeom).write(path)
        # The clock may go on between the two.
        texts.append(re.sub(rb"1U(DATE|TIME).*", b"", path.read_bytes()))
    assert texts[0], "nothing was written"
    assert texts[0] == texts[1]


def test_summary_and_picture_take_the_steps_of_a_call():
    """They knew those of the model only: no supports and loads of a step given to `solve`."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    step = ct.Static()
    step.fix("left", x=0.0, y=0.0)
    step.force("right", y=1.0)
    bare = len(model.plot().axes[0].lines)
    given = model.summary(step), model.summary([step]), model.plot(steps=step)
    assert not model.steps
    model.steps = [step]
    assert given[0] == given[1] == model.summary()
    marks = len(given[2].axes[0].lines)
    assert marks == len(model.plot().axes[0].lines) > bare


def test_solve_leaves_the_steps_of_the_model_alone():
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    results = ct.solve(model, ct.Static(increments=1), threads=1)
    assert model.steps == []
    assert results.model.steps == results.steps

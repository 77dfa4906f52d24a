"""Supports that a step releases: reactions fade, the rest stays, decks say the same."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct


def bar(**options: bool) -> tuple[ct.Model, ct.Static]:
    """A strip of 10 x 1 that the first step stretches by .1, and the second lets go."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=5, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    pull, free = ct.Static(), ct.Static(increments=4)
    pull.fix("right", x=0.1, y=None)
    free.release("right", **options)
    model.steps += [pull, free]
    return model, free


def test_what_a_support_carried_fades_over_the_step() -> None:
    model, _ = bar()
    results = ct.solve(model)
    tip = results.history("U1", at="right").values
    # A linear force over the step: the stretch of the frames follows it.
    assert tip[-5:] == pytest.approx([0.1, 0.075, 0.05, 0.025, 0.0], abs=2e-3)
    assert tip[-1] == pytest.approx(0.0, abs=1e-9)
    # The plane below the strip keeps it at its height.
    assert np.abs(results.frames[-1].U[model.mesh.node_indices("bottom"), 1]).max() == 0.0


def test_one_direction_is_released_and_the_other_stays() -> None:
    model, free = bar(y=False, rotation=False)
    free.fix("left", y=-0.2)
    free.fix("bottom", x=None, y=-0.2)
    results = ct.solve(model)
    assert results.history("U1", at="right").values[-1] == pytest.approx(0.0, abs=1e-9)


def test_a_clamp_of_the_model_is_released() -> None:
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section(element="Q4I", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("left")
    model.fix("right")
    load, free = ct.Static(), ct.Static()
    load.force("top", y=-2.0)
    free.release("right")
    model.steps += [load, free]
    results = ct.solve(model)
    sag = results.history("U2", at="right", combine="min").values
    alone = model.copy()
    alone.steps.clear()
    alone.supports = [s for s in alone.supports if s.nodes == "left"]
    alone.force("top", y=-2.0)
    cantilever = ct.solve(alone, ct.Static())
    assert sag[-1] == pytest.approx(cantilever.history("U2", at="right", combine="min").values[-1])


def test_supports_at_lists_of_nodes_are_released_as_those_at_sets() -> None:
    named, _ = bar()
    listed = named.copy()
    mesh = listed.mesh
    for owner in (listed, *listed.steps):
        for support in owner.supports:
            support.nodes = mesh.node_indices(support.nodes)
    at_sets, at_lists = (ct.solve(model).frames[-1].U for model in (named, listed))
    assert np.array_equal(at_lists, at_sets)


def test_without_a_support_there_is_nothing_to_release() -> None:
    model, free = bar()
    free.release("top", y=False)
    places = "supports are at: 'left', 'bottom'"
    with pytest.raises(ct.ModelError, match=f"no support at 'top' in x, rotation.*{places}"):
        ct.solve(model)
    with pytest.raises(ct.InputError, match="release"):
        free.fix("right", x=None, y=None)
    free.fix("right", x=None, y=None, rotation=0.0)  # a rotation of zero is a support
    assert free.supports[-1].value == 0.0
    with pytest.raises(ct.InputError, match="no direction"):
        free.release("right", x=False, y=False, rotation=False)


def test_deck_means_the_same(tmp_path: Path) -> None:
    model, free = bar()
    free.fix("top", x=None, y=0.01)
    deck = ct.write(model, tmp_path / "bar.inp")
    assert "OP=NEW" in deck.read_text()
    again, same = ct.solve(ct.read(deck)), ct.solve(model)
    assert pytest.approx(same.frames[-1].U, abs=1e-12) == again.frames[-1].U
    assert free.supports[0].free


def test_check_sees_that_a_body_is_left_without_support() -> None:
    model, free = bar()
    assert not [d for d in model.check() if d.severity == "error"]
    free.release("left")
    free.release("bottom")
    assert any("step 2" in d.message for d in model.check())

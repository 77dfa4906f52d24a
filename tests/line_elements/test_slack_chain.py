"""A chain of bars or springs without tension: what stops it, and what the message suggests."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re

import numpy as np
import pytest

import corota as ct

SPAN, SAG, LOAD, STIFFNESS = 10.0, 1.0, 0.01, 1e4


def chain(n: int = 8) -> ct.Model:
    """Nodes on a parabola, the shape of a chain under equal forces at equal distances."""
    x = np.linspace(0.0, SPAN, n + 1)
    mesh = ct.mesh.line(list(zip(x, -4.0 * SAG * x * (SPAN - x) / SPAN**2, strict=True)), n=1)
    model = ct.Model(mesh)
    model.fix([0, n])
    model.force(np.arange(1, n), y=-LOAD, per_node=True)
    return model


def test_the_message_of_a_slack_chain_says_what_to_do() -> None:
    model = chain()
    model.spring("all", STIFFNESS)
    with pytest.raises(ct.SingularError) as caught:
        ct.solve(model, ct.Static(), threads=1)
    message = str(caught.value)
    assert "Bars and springs without tension have no stiffness across" in message
    assert re.search(r"; \d more move", message)
    assert message.count(" with element ") == 3


def test_an_initial_stress_gives_the_equilibrium() -> None:
    """The horizontal force of a parabola: ``q l^2 / 8 f``, with q per length."""
    model = chain()
    model.truss("all", material=ct.Elastic(1e6, 0.0), area=1.0)
    model.initial_stress("all", xx=1e-3)
    frame = ct.solve(model, ct.Static(), threads=1).frames[-1]
    assert frame.RF[-1, 0] == pytest.approx(LOAD * 8 * SPAN / (8 * SAG), rel=1e-4)


def test_a_hinge_of_other_bodies_has_the_plain_message() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1))
    model.section("all", element="Q4I", material=ct.Elastic(1.0, 0.0))
    model.fix([0])
    model.force("right", y=1.0)
    with pytest.raises(ct.SingularError, match="can turn about") as caught:
        ct.solve(model, ct.Static(), threads=1)
    assert "tension" not in str(caught.value)

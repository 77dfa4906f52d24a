"""An observer's wish to stop ends every procedure after the increment, with what was found."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import dataclasses
from typing import Any

import pytest

import corota as ct
from corota.results.observer import BaseObserver

STEPS: dict[str, list[Any]] = {
    "static": [ct.Static(increments=5)],
    "path": [ct.Static(path=ct.ArcLength(factor=1.0, increments=5))],
    "implicit": [ct.Dynamic(period=0.1, increments=5)],
    "explicit": [ct.Dynamic(period=0.05, scheme="central_difference")],
    "modal": [ct.Frequency(modes=2), ct.ModalDynamic(period=0.1, increments=5)],
    "harmonic": [ct.Frequency(modes=2), ct.SteadyState(lowest=0.1, highest=0.2, points=5)],
}


class StopAt(BaseObserver):
    """Asks to stop once the second increment of a step is there."""

    stop = False

    def __init__(self, step: int) -> None:
        self.last = step
        self.frames: list[tuple[int, int]] = []

    def increment(self, frame: Any) -> None:
        self.frames.append((frame.step, frame.increment))
        self.stop = frame.step == self.last and frame.increment >= 2


@pytest.mark.parametrize("name", STEPS)
def test_every_procedure_stops_after_the_increment(name: str) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3, rho=1e-3))
    model.fix("left")
    model.force("right", y=-0.01)
    steps = STEPS[name]
    observer = StopAt(len(steps))
    with pytest.raises(ct.Interrupted, match=f"stopped at step {len(steps)}, "):
        ct.solve(model, steps, observers=[observer], threads=1)
    assert observer.frames[-1] == (len(steps), 2)


@pytest.mark.parametrize("name", ["static", "implicit", "explicit", "modal"])
def test_every_procedure_stops_at_its_increments(name: str) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=100.0, nu=0.3, rho=1e-3))
    model.fix("left")
    model.force("right", y=-0.01)
    steps = [dataclasses.replace(step, max_increments=2) for step in STEPS[name]]
    if name != "explicit":  # it costs what it takes, not what it would take
        steps[-1] = dataclasses.replace(steps[-1], increments=10_000_000)
    observer = StopAt(0)
    with pytest.raises(ct.ConvergenceError, match=f"step {len(steps)} used its 2 increments"):
        ct.solve(model, steps, observers=[observer], threads=1)
    assert observer.frames[-1] == (len(steps), 2)

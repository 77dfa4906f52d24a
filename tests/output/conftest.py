"""A cantilever whose results are known by formula, and an analysis that hands them out."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from corota import cli
from corota.mesh import Cells, Mesh
from corota.model.materials import Elastic
from corota.model.model import Model
from corota.model.steps import Output, Static
from corota.results.observer import Iteration
from corota.results.results import Frame, PointFields, Results

GAUSS = 1.0 / np.sqrt(3.0)
POINTS = np.array([[-GAUSS, -GAUSS], [GAUSS, -GAUSS], [-GAUSS, GAUSS], [GAUSS, GAUSS]])


def bilinear(at: np.ndarray) -> np.ndarray:
    """Shape functions of the four-node square, shape (p, 4)."""
    x, y = at.T
    return 0.25 * np.stack(
        [(1 - x) * (1 - y), (1 + x) * (1 - y), (1 + x) * (1 + y), (1 - x) * (1 + y)], 1
    )


def strip(nx: int = 2, ny: int = 1, length: float = 2.0, height: float = 1.0) -> Mesh:
    """Rectangle of four-node cells with element labels from 11 and node labels from 101."""
    x, y = np.meshgrid(np.linspace(0, length, nx + 1), np.linspace(0, height, ny + 1))
    number = np.arange((nx + 1) * (ny + 1)).reshape(ny + 1, nx + 1)
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], -1)
    nodes = quads.reshape(-1, 4)
    mesh = Mesh(
        np.stack([x.ravel(), y.ravel()], 1),
        [Cells("quad4", nodes, np.arange(len(nodes)) + 11)],
        node_labels=np.arange(x.size) + 101,
    )
    mesh.node_sets["LEFT"] = number[:, 0].copy()
    mesh.node_sets["RIGHT"] = number[:, -1].copy()
    mesh.cell_sets["EALL"] = np.arange(len(nodes))
    return mesh


def state(model: Model, step: int, increment: int, time: float, factor: float) -> Frame:
    """Stress S11 = factor (1 + x), S12 = factor y: linear, so extrapolation must be exact."""
    mesh = model.mesh
    nodes = mesh.cells[0].nodes
    shape = bilinear(POINTS)
    at = np.einsum("pk,nkd->npd", shape, mesh.points[nodes])
    S = np.zeros((*at.shape[:2], 4))
    S[..., 0], S[..., 3] = factor * (1.0 + at[..., 0]), factor * at[..., 1]
    E = S / 1000.0
    volume = np.full(
        at.shape[:2], 0.1 * np.ptp(mesh.points[:, 0]) * np.ptp(mesh.points[:, 1]) / at[..., 0].size
    )
    n = mesh.n_nodes
    RF, F = np.zeros((n, 3)), np.zeros((n, 3))
    RF[mesh.node_sets["LEFT"], 1] = factor * 0.5
    F[mesh.node_sets["RIGHT"], 1] = -factor * 0.5
    U = factor * np.stack([-0.01 * mesh.points[:, 1], 0.05 * mesh.points[:, 0] ** 2], 1)
    fields = PointFields(
        "Q4I",
        np.arange(len(nodes)),
        at,
        shape,
        np.full(len(nodes), 0.1 * factor),
        volume,
        {"S": S, "E": E, "ENER": np.full(at.shape[:2], factor**2)},
    )
    return Frame(
        step,
        increment,
        time,
        time,
        factor,
        U,
        0.1 * U[:, 0],
        RF,
        F,
        [fields],
        {
            "iterations": 3.0 if increment else 0.0,
            "strain energy": factor**2,
            "external work": factor**2,
        },
    )


def play(model: Model, observers=(), count: int = 4, sabotage=None) -> Results:
    """Act as an analysis: one step, `count` increments, one cut-back in the second."""
    results = Results(model, info={"profile": {"factor": 0.25}})
    error = None
    for o in observers:
        o.start(model, model.steps)
    try:
        for o in observers:
            o.step(1, model.steps[0])
        for i in range(count + 1):
            frame = state(model, 1, i, i / count, i / count)
            if i:
                for k in range(1, 4):
                    info = Iteration(
                        1, i, 1 + (i == 2), k, 10.0 ** -(2**k), 0.0, 0.1**k, 3, 1, dt=1 / count
                    )
                    for o in observers:
                        o.iteration(info)
            if i == 1 and count > 1:
                for o in observers:
                    o.cut_back(1, 2, 1, "slow", 0.125)
            if sabotage:
                sabotage(i, frame)
            results.add(frame)
            for o in observers:
                o.increment(frame)
    except Exception as caught:
        error = caught
        raise
    finally:
        for o in observers:
            o.end(results, error)
    return results


@pytest.fixture
def model() -> Model:
    """Two-cell cantilever with print requests."""
    made = Model(strip(), "beam")
    made.section("EALL", element="Q4I", material=Elastic(E=1000.0, nu=0.3), thickness=0.1)
    made.fix("LEFT")
    made.force("RIGHT", y=-0.5, per_node=True)
    made.steps.append(
        Static(
            first_increment=0.25,
            outputs=[
                Output("node print", ("U",), "RIGHT"),
                Output("node print", ("RF",), "LEFT", totals="yes"),
                Output("el print", ("S", "E", "ELSE", "EVOL"), "EALL", totals="yes", frequency=2),
            ],
        )
    )
    return made


@pytest.fixture
def results(model: Model) -> Results:
    """Five frames of the cantilever."""
    return play(model)


@pytest.fixture
def fake() -> SimpleNamespace:
    """The functions above, for tests to call."""
    return SimpleNamespace(state=state, play=play, strip=strip)


@pytest.fixture
def call():
    """Run the command line as a process."""

    def call(*arguments, **options):
        options.setdefault("capture_output", True)
        command = [sys.executable, "-m", "corota", *map(str, arguments)]
        done = subprocess.run(command, text=True, timeout=120, check=False, **options)
        for stream in (done.stdout, done.stderr):
            assert "Traceback" not in (stream or "")
        return done

    return call


@pytest.fixture
def here(capsys):
    """Run the command line in this process."""

    def inside(*arguments):
        code = cli.main([str(a) for a in arguments])
        text = capsys.readouterr()
        assert "Traceback" not in text.err
        return SimpleNamespace(returncode=code, stdout=text.out, stderr=text.err)

    return inside


@pytest.fixture
def deck():
    """Copy the deck with replacements."""

    def copy(path, *changes):
        text = (Path(__file__).parent / "deck.inp").read_text()
        for old, new in changes:
            assert old in text
            text = text.replace(old, new)
        path.write_text(text)
        return path

    return copy

"""Softening of rubber beside closed forms of Ogden and Roxburgh with SciPy's error function."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import erf

import corota as ct
from support.laws import RUBBER, energy

R, M, BETA = 1.8, 0.05, 0.2
#: Stretched, let go, pressed, and stretched beyond.
CYCLE = np.array([1.2, 1.6, 2.0, 1.7, 1.3, 1.05, 1.0, 0.8, 1.4, 1.9, 2.0, 2.1, 2.6, 1.8, 0.5, 1.5])


def shape(stretch: Any) -> Any:
    """Energy of a uniaxial stretch at constant volume, C10 = 0.5."""
    return 0.5 * (stretch**2 + 2.0 / stretch - 3.0)


def factor(u: Any, top: float, m: float = M, beta: float = BETA) -> Any:
    return 1.0 - erf(np.maximum(top - u, 0.0) / (m + beta * top)) / R


@pytest.mark.parametrize(("m", "beta"), [(M, BETA), (0.3, 0.0), (0.0, 0.6), (1e-3, 0.0)])
def test_uniaxial_cycles(m: float, beta: float) -> None:
    law = ct.Mullins(ct.NeoHooke(C10=0.5), R, m, beta)
    top, wanted = 0.0, []
    for stretch in CYCLE:
        u = shape(stretch)
        top = max(top, u)
        wanted.append(factor(u, top, m, beta) * (stretch - stretch**-2.0))
    assert np.abs(law.nominal("uniaxial", CYCLE) - wanted).max() < 3e-14


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("name", RUBBER)
def test_stress_of_the_shape_is_reduced(name: str, plane: str) -> None:
    """By the answers of the parent: its shape alone, its volume alone, along a random path."""
    parent = RUBBER[name]
    law = ct.Mullins(parent, R, M, BETA)
    path = np.random.default_rng(2).uniform(-0.5, 0.5, (30, 3))
    found = law.respond(path, plane)
    size = np.abs(found["tangent"]).max(axis=(1, 2), keepdims=True)
    assert (np.abs(found["tangent"] - found["derivative"]) < 1e-10 * size).all()
    if plane == "stress":
        assert np.abs(found["zz"][:, 1]).max() == 0.0
        return
    top = 0.0
    for row, strain in enumerate(path):
        volume = strain[:2].sum()
        whole = parent.respond(strain, plane)
        energy, stress = whole["energy"][0], whole["stress"][0]
        part = np.zeros(3)
        if not isinstance(parent, ct.Hyperfoam):
            part[:2] = _mean_stress(parent, volume)
            energy = energy - _volume_energy(parent, volume)
        top = max(top, energy)
        wanted = part + factor(energy, top) * (stress - part)
        assert np.abs(found["stress"][row] - wanted).max() < 1e-11, row


def _volume_energy(parent: Any, theta: Any) -> Any:
    """Energy of equal stretches, which change no shape."""
    return energy(parent, np.full(3, np.exp(theta / 3.0)))


def _mean_stress(parent: Any, theta: float) -> float:
    h = 1e-30
    return float(_volume_energy(parent, theta + 1j * h).imag / h)


@pytest.mark.parametrize("steps", [3, 40])
def test_a_cycle_loses_what_the_loop_encloses(steps: int) -> None:
    """A strip to a stretch of 2 and back: force, loss and balance, also in few large increments."""
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    law = ct.Mullins(ct.NeoHooke(C10=0.5), R, M, BETA)
    model.section("all", element="Q4", material=law, plane="stress")
    model.fix("left", x=0.0, y=None)
    model.fix("bottom", x=None, y=0.0)
    up, down = ct.Static(increments=steps), ct.Static(increments=steps)
    up.fix("right", x=1.0, y=None)
    down.fix("right", x=0.0, y=None)
    results = ct.solve(model, [up, down])
    top = shape(2.0)
    for frame in results.frames:
        stretch = 1.0 + frame.U[model.mesh.nodes_of("right"), 0].mean()
        reduced = factor(shape(stretch), top) if frame.step == 2 else 1.0
        force = frame.RF[model.mesh.nodes_of("right"), 0].sum()
        assert force == pytest.approx(reduced * (stretch - stretch**-2.0), abs=1e-7)
    loss = quad(lambda s: (1.0 - factor(shape(s), top)) * (s - s**-2.0), 1.0, 2.0, epsabs=1e-13)[0]
    last = results.frames[-1].scalars
    assert last["ALLDMD"] == pytest.approx(loss, rel=1e-9)
    assert abs(last["ALLSE"]) < 1e-9
    assert abs(last["energy balance"]) < (0.3 if steps == 3 else 2e-3) * loss
    assert results.frames[steps].scalars["ALLSE"] == pytest.approx(top - loss, rel=1e-9)


def test_deck(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "docs" / "decks" / "softening.inp").read_text()
    path = tmp_path / "a.inp"
    path.write_text(text)
    model = ct.read(path)
    law = model.sections[0].material
    wanted = ct.Mullins(ct.Yeoh(0.5, -0.01, 0.002), 2.0, 0.1, 0.1).parameters()
    assert law.parameters() == wanted
    ct.write(model, tmp_path / "b.inp")
    assert ct.read(tmp_path / "b.inp").sections[0].material.parameters() == wanted
    for card, message in (
        ("*ELASTIC\n200., 0.3\n*MULLINS EFFECT\n2., 1.\n", "belongs below"),
        ("*HYPERELASTIC, NEO HOOKE\n1., 1.\n*MULLINS EFFECT\n1., 1.\n", "r > 1"),
        (
            "*HYPERELASTIC, NEO HOOKE\n1., 1.\n*MULLINS EFFECT\n2., 1.\n"
            "*VISCOELASTIC, TIME=PRONY\n0.1, 0., 1.\n",
            "does not relax",
        ),
    ):
        start, end = text.index("*HYPERELASTIC"), text.index("*SOLID SECTION")
        path.write_text(text[:start] + card + text[end:])
        with pytest.raises(ct.InputError, match=message):
            ct.read(path)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ct.Mullins(ct.Elastic(1.0, 0.3), 2.0, 1.0), "Elastic does not"),
        (lambda: ct.Mullins(ct.NeoHooke(1.0), 2.0, 0.0), "not both zero"),
        (lambda: ct.Viscoelastic(ct.Mullins(ct.NeoHooke(1.0), 2.0, 1.0), [(0.1, 0, 1)]), "relax"),
    ],
)
def test_refused(make: Any, message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        make()

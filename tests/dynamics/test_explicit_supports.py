"""Moving supports with mass under central differences: rates, reactions and work."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np

import corota as ct
from corota.model.loads import Amplitude

PERIOD, STROKE, RATE = 1.0, 0.01, 2.0 * np.pi


def driven_bar(scheme: str, increments: int):
    """A bar of mass 4 whose end moves as STROKE (1 - cos(RATE t)); axial motion alone."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1))
    model.section("all", element="Q4", material=ct.Elastic(E=100.0, nu=0.0, rho=1.0))
    time = np.linspace(0.0, PERIOD, increments + 1)
    model.amplitudes["s"] = Amplitude(time, STROKE * (1.0 - np.cos(RATE * time)))
    model.fix("left", x=1.0, y=None, amplitude="s")
    model.fix(np.arange(len(model.mesh.points)), x=None, y=0.0)
    step = ct.Dynamic(period=PERIOD, increments=increments, scheme=scheme, mass="lumped")
    frames = ct.solve(model, step, fields=True, threads=1).frames[1:]
    end = model.mesh.nodes_of("left")
    each = len(frames) // 25
    frames = frames[each - 1 :: each]
    reaction = np.array([f.RF[end, 0].sum() for f in frames])
    rates = np.array([[f.V[end[0], 0], f.A[end[0], 0]] for f in frames])
    balance = max(abs(f.scalars["energy balance error"]) for f in frames)
    return np.array([f.time for f in frames]), reaction, rates, balance


def test_rates_reactions_and_balance_are_of_second_order():
    """Accelerations of supports were shown as 0, and reactions lagged by an increment."""
    exact = driven_bar("newmark", 800)[1]
    errors = []
    for increments in (50, 100, 200):
        time, reaction, rates, balance = driven_bar("central_difference", increments)
        v = STROKE * RATE * np.sin(RATE * time)
        a = STROKE * RATE**2 * np.cos(RATE * time)
        off = (
            np.abs(rates[:, 0] - v).max() / np.abs(v).max(),
            np.abs(rates[:, 1] - a).max() / np.abs(a).max(),
            np.abs(reaction - exact).max() / np.abs(exact).max(),
            balance,
        )
        errors.append(off)
    assert (np.array(errors[-1]) <= [1e-3, 1e-2, 2e-3, 2e-3]).all()
    fall = np.array(errors[0]) / np.array(errors[2])
    assert (fall > 8.0).all(), (errors, fall)

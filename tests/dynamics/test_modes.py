"""Frequencies, modes and their superposition."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.verification.problems.tapered_membrane import EXACT as FV32
from corota.verification.problems.tapered_membrane import tapered


def frequencies(model, modes=6, **keys):
    return (
        ct.solve(model, ct.Frequency(modes=modes, **keys), threads=1, fields=False)
        .modes[-1]
        .factors
    )


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "OPT"])
def test_tapered_membrane_converges(element):
    errors = [
        np.abs(frequencies(tapered(element, 2 * n, n)) / FV32 - 1.0)[:3].max() for n in (4, 8)
    ]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 0.01


def test_free_beam_has_three_rigid_modes_and_the_beams_frequencies():
    model = ct.Model(ct.mesh.rectangle(10.0, 0.1, nx=60, ny=1, cell="quad8"))
    model.section("all", element="Q8R", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
    found = frequencies(model, 6)
    assert (found[:3] < 1e-3 * found[3]).all()
    beta = np.sqrt(2.0 * np.pi * found[3:] * 100.0 / np.sqrt(1e6 * 0.01 / 12.0))
    # Slender limit; at h/L = 0.01 shear and rotary inertia take 0.1 % of the third.
    assert beta == pytest.approx([4.730040745, 7.853204624, 10.99560784], rel=1e-3)


def test_tension_raises_and_compression_lowers_the_frequency():
    def first(force):
        model = ct.Model(ct.mesh.rectangle(10.0, 0.2, nx=20, ny=1))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.0, rho=1.0))
        model.fix("left")
        model.force("right", x=0.5 * force, per_node=True)
        steps = [ct.Static(), ct.Frequency(modes=1)]
        return ct.solve(model, steps, threads=1, fields=False).modes[-1].factors[0]

    rest = first(0.0)
    critical = np.pi**2 * 1e6 * 0.2**3 / 12.0 / (4.0 * 100.0)
    # Beam with axial force: f^2 falls almost linearly to zero at the critical load.
    pressed = first(-0.5 * critical)
    assert (pressed / rest) ** 2 == pytest.approx(0.5, abs=0.02)
    assert first(0.5 * critical) > rest


def cantilever():
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=10, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e6, nu=0.3, rho=1.0))
    model.fix("left")
    return model


def test_superposition_of_all_modes_is_the_direct_solution():
    model = cantilever()
    n = model.mesh.n_nodes - len(model.mesh.nodes_of("left"))
    load = [ct.model.NodalForce("right", 1, -0.1)]
    steps = [ct.Frequency(modes=2 * n), ct.ModalDynamic(period=0.5, increments=50, loads=load)]
    modal = ct.solve(model, steps, threads=1, fields=False).frames[-1].U
    direct = (
        ct.solve(
            cantilever(),
            ct.Dynamic(period=0.5, increments=4000, scheme="newmark", nlgeom=False, loads=load),
            threads=1,
            fields=False,
        )
        .frames[-1]
        .U
    )
    assert np.abs(modal - direct).max() <= 2e-3 * np.abs(direct).max()


def test_harmonic_response_peaks_at_the_frequency_with_its_damping():
    model = cantilever()
    load = [ct.model.NodalForce("right", 1, -0.1)]
    first = frequencies(model, 1)[0]
    sweep = ct.SteadyState(
        lowest=0.01 * first, highest=2.0 * first, points=41, damping=0.02, loads=load
    )
    results = ct.solve(model, [ct.Frequency(modes=1), sweep], threads=1, fields=False)
    frames = [f for f in results.frames if "frequency" in f.scalars]
    f = np.array([x.scalars["frequency"] for x in frames])
    size = np.array([x.scalars["largest amplitude"] for x in frames])
    assert f[size.argmax()] == pytest.approx(first, rel=1e-3)
    # One mode: amplification 1 / (2 zeta) at resonance over the static deflection.
    assert size.max() / size[0] == pytest.approx(25.0, rel=2e-3)


def small_block(held: str) -> ct.Model:
    """A block of two elements on the ground, held by supports or by friction."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1))
    model.section("all", element="Q4", material=ct.Elastic(1000.0, 0.3, rho=1.0))
    model.pressure("top", 1.0)
    if held == "supports":
        model.fix("bottom")
    else:
        floor = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
        model.contact("bottom", floor, friction=5.0, method=held)  # type: ignore[arg-type]
    return model


@pytest.mark.parametrize("held", ["mortar", "node_to_segment"])
def test_closed_contact_has_no_modes_of_its_own(held: str) -> None:
    """More modes are asked for than there are: those of the same block on supports, no others."""
    wanted, found = (
        ct.solve(small_block(by), [ct.Static(nlgeom=False), ct.Frequency(modes=40)], threads=1)
        for by in ("supports", held)
    )
    frequencies = wanted.modes[0].factors
    assert len(frequencies) == 6
    assert found.modes[0].factors == pytest.approx(frequencies, rel=1e-6)

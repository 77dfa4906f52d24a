"""Cards of motion by a few lines each: what they put into the model, what they refuse."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np
import pytest

import corota as ct
from corota.errors import CorotaError
from corota.model.steps import Dynamic, Frequency, ModalDynamic, SteadyState

HEAD = """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2., 1.
*ELEMENT, TYPE=CPS4I, ELSET=EALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1.
*SOLID SECTION, ELSET=EALL, MATERIAL=M
1.
*BOUNDARY
1, 1, 2
4, 1, 2
"""
FREQUENCY = "*STEP\n*FREQUENCY\n3\n*END STEP\n"


def read(folder, text):
    path = folder / "deck.inp"
    path.write_text(text, encoding="ascii")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ct.read(path)


def step_of(folder, card, data=".01, .1", head=HEAD):
    return read(folder, f"{head}*STEP, NLGEOM\n{card}\n{data}\n*END STEP\n").steps[-1]


def test_dynamic_reads_alpha_and_increments(tmp_path):
    step = step_of(tmp_path, "*DYNAMIC, ALPHA=-.1, DIRECT")
    assert isinstance(step, Dynamic)
    assert (step.scheme, step.alpha, step.fixed_increments) == ("hht", -0.1, True)
    assert (step.first_increment, step.period) == (0.01, 0.1)
    step = step_of(tmp_path, "*DYNAMIC")
    assert (step.alpha, step.fixed_increments) == (-0.05, False)


def test_explicit_dynamic_is_lumped(tmp_path):
    step = step_of(tmp_path, "*DYNAMIC, EXPLICIT")
    assert (step.scheme, step.mass) == ("central_difference", "lumped")


def test_frequency_and_modal_steps(tmp_path):
    text = (
        HEAD
        + FREQUENCY
        + (
            "*STEP\n*MODAL DYNAMIC\n.01, .5\n*MODAL DAMPING\n1, 3, .02\n"
            "*CLOAD\n6, 2, -1.\n*END STEP\n"
            "*STEP\n*STEADY STATE DYNAMICS\n.1, 20., 5\n*MODAL DAMPING\n1, 3, .02\n"
            "*CLOAD\n6, 2, -1.\n*END STEP\n"
        )
    )
    model = read(tmp_path, text)
    frequency, modal, steady = model.steps
    assert isinstance(frequency, Frequency)
    assert frequency.modes == 3
    assert isinstance(modal, ModalDynamic)
    assert (modal.first_increment, modal.period) == (0.01, 0.5)
    assert modal.damping == [(1, 3, 0.02)]
    assert isinstance(steady, SteadyState)
    assert (steady.lowest, steady.highest, steady.points) == (0.1, 20.0, 5)
    results = ct.solve(model, threads=1)
    assert results.modes[0].factors.shape == (3,)
    assert np.isfinite(results.frames[-1].U).all()


STEADY = "*STEP\n*STEADY STATE DYNAMICS{}\n.1, 20., 5\n{}*END STEP\n"


def harmonic(folder, card, cards, head=HEAD):
    """Frequencies and complex displacements of node 6 of a harmonic step."""
    model = read(folder, head + FREQUENCY + STEADY.format(card, cards))
    frames = ct.solve(model, threads=1, fields=False).frames
    frames = [f for f in frames if "frequency" in f.scalars]
    f = np.array([x.scalars["frequency"] for x in frames])
    node = int(np.flatnonzero(model.mesh.node_labels == 6)[0])
    w = 2.0 * np.pi * f
    return f, np.array([x.U[node] - 1j * x.V[node, :2] / v for x, v in zip(frames, w, strict=True)])


def test_ranges_of_modal_damping_are_read(tmp_path):
    text = HEAD + FREQUENCY + "*STEP\n*MODAL DYNAMIC\n.01, .5\n*MODAL DAMPING\n"
    model = read(tmp_path, text + "1, 2, .02\n3, , .05\n*END STEP\n")
    assert model.steps[1].damping == [(1, 2, 0.02), (3, 3, 0.05)]
    with pytest.raises(CorotaError, match="first mode"):
        read(tmp_path, text + "3, 2, .02\n*END STEP\n")


@pytest.mark.parametrize("card", ["", ", DIRECT"])
def test_load_case_2_is_a_quarter_of_a_period_out_of_phase(tmp_path, card):
    head = HEAD + "*DAMPING, ALPHA=.5, BETA=.0001\n"
    _, real = harmonic(tmp_path, card, "*CLOAD\n6, 2, -1.\n", head)
    _, late = harmonic(tmp_path, card, "*CLOAD, LOAD CASE=2\n6, 2, -1.\n", head)
    assert late == pytest.approx(1j * real, rel=1e-9)
    with pytest.raises(CorotaError, match="LOAD CASE"):
        read(tmp_path, HEAD + "*STEP\n*STATIC\n*CLOAD, LOAD CASE=2\n6, 2, -1.\n*END STEP\n")


def test_the_direct_response_needs_no_modes(tmp_path):
    text = HEAD + STEADY.format(", DIRECT", "*CLOAD\n6, 2, -1.\n")
    model = read(tmp_path, text)
    assert model.steps[0].direct
    assert len([f for f in ct.solve(model, threads=1).frames if "frequency" in f.scalars]) == 5


def test_amplitudes_of_a_harmonic_step_are_over_the_frequency(tmp_path):
    head = HEAD + "*DAMPING, ALPHA=.5\n*AMPLITUDE, NAME=A\n0., 0., 20., 40.\n"
    f, plain = harmonic(tmp_path, ", DIRECT", "*CLOAD\n6, 2, -1.\n", head)
    _, table = harmonic(tmp_path, ", DIRECT", "*CLOAD, AMPLITUDE=A\n6, 2, -1.\n", head)
    assert table == pytest.approx(2.0 * f[:, None] * plain, rel=1e-9)


def test_complex_frequencies_have_the_damping_of_the_deck(tmp_path):
    """Damping by mass alone takes alpha / 2 from every mode."""
    head = HEAD + "*DAMPING, ALPHA=.5\n"
    model = read(tmp_path, head + FREQUENCY.replace("*FREQUENCY", "*COMPLEX FREQUENCY, CORIOLIS"))
    modes = ct.solve(model, threads=1).modes[0]
    assert modes.growth == pytest.approx(-0.25, rel=1e-6)


def test_damping_and_initial_velocity(tmp_path):
    head = HEAD + "*DAMPING, ALPHA=.5, BETA=.001\n"
    head += "*INITIAL CONDITIONS, TYPE=VELOCITY\nNALL, 1, 2.5\n"
    model = read(tmp_path, head + "*STEP\n*DYNAMIC\n.01, .1\n*END STEP\n")
    assert model.steps[0].rayleigh == (0.5, 0.001)
    assert [(v.dof, v.value) for v in model.velocities] == [(0, (2.5,))]


@pytest.mark.parametrize(
    ("card", "data", "line", "words"),
    [
        ("*DYNAMIC, ALPHA=.1", ".01, .1", 22, "ALPHA"),
        ("*DYNAMIC, ALPHA=-.5", ".01, .1", 22, "ALPHA"),
        ("*FREQUENCY", "0", 23, "at least one mode"),
        ("*STEADY STATE DYNAMICS", "20., .1", 23, "range"),
        ("*MODAL DYNAMIC", "-.1, 1.", 23, "increment"),
    ],
)
def test_errors_name_the_line(tmp_path, card, data, line, words):
    with pytest.raises(CorotaError, match=words) as caught:
        step_of(tmp_path, card, data)
    assert f":{line}" in str(caught.value)


def test_missing_density_is_refused_with_the_material(tmp_path):
    model = read(
        tmp_path, HEAD.replace("*DENSITY\n1.\n", "") + "*STEP\n*DYNAMIC\n.01, .1\n*END STEP\n"
    )
    with pytest.raises(CorotaError, match="has no density") as caught:
        ct.solve(model, threads=1)
    assert "deck.inp" in str(caught.value)


def test_wrong_initial_conditions_are_refused(tmp_path):
    for line in ("NALL, 3, 1.", ", 1, 1.", "NALL, 1, x"):
        with pytest.raises(CorotaError):
            read(tmp_path, f"{HEAD}*INITIAL CONDITIONS, TYPE=VELOCITY\n{line}\n{FREQUENCY}")


def test_increment_longer_than_the_period_of_the_load_is_warned_of(tmp_path):
    time = np.linspace(0.0, 1.0, 401)
    rows = "\n".join(f"{t:.6g}, {np.sin(20.0 * np.pi * t):.6g}" for t in time)
    text = (
        HEAD + f"*AMPLITUDE, NAME=WAVE\n{rows}\n"
        "*STEP, INC=100\n*DYNAMIC, DIRECT\n{dt}, .4\n*CLOAD, AMPLITUDE=WAVE\n6, 2, -1.\n*END STEP\n"
    )
    with pytest.warns(UserWarning, match=r"period of 0\.1: use at most 0\.005"):
        ct.solve(read(tmp_path, text.replace("{dt}", ".2")), threads=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ct.solve(read(tmp_path, text.replace("{dt}", ".005")), threads=1)

# SPDX-License-Identifier: BSD-3-Clause
"""Second audit, cards of motion and what runs write.

References: SciPy's integrator, closed forms, and CalculiX 2.20, whose answers are stored here.
"""

import csv
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from support.pairs import cover
from support.particles import CHAIN_CARDS, MASSES, STIFFNESS, chain_matrices, linear_motion

pytestmark = [
    pytest.mark.filterwarnings("ignore:central differences took"),
    pytest.mark.filterwarnings("ignore:the increment .* is long for the amplitude"),
]
CHAIN = (
    CHAIN_CARDS
    + """*BOUNDARY
1, 2
2, 2
3, 2
4, 2
"""
)
HELD = "*BOUNDARY\n1, 1\n"


def run(text, folder):
    """Results, .dat (empty where none was requested) and rows of .csv."""
    path, tables = folder / "job.inp", folder / "job.dat"
    path.write_text(text)
    results = ct.solve(ct.read(path), observers=[ct.JobFiles(str(folder))])
    rows = list(csv.reader((folder / "job.csv").read_text().splitlines()))
    return results, tables.read_text() if tables.exists() else "", rows


def exact_chain(load, end, start=None, c=None, breaks=()):
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    return linear_motion(k, m, np.zeros((3, 3)) if c is None else c, load, end, breaks, start)


def column(rows, name):
    at = [i for i, title in enumerate(rows[0]) if title.strip().startswith(name)]
    return np.array([float(row[at[0]] or "nan") for row in rows[1:]])


@pytest.mark.parametrize(
    "card",
    [
        "*DYNAMIC, DIRECT, ALPHA=0.\n0.01, 1.",
        "*DYNAMIC, DIRECT\n0.01, 1.",
        "*DYNAMIC, DIRECT, APPLICATION=MODERATE DISSIPATION\n0.01, 1.",
        "*DYNAMIC\n0.002, 1.",
    ],
)
def test_initial_velocity_and_a_load_at_once(card, tmp_path):
    # A sudden force on a chain that already moves: .dat, .csv and results beside SciPy.
    deck = (
        CHAIN + HELD + "*INITIAL CONDITIONS, TYPE=VELOCITY\n3, 1, -1.5\n"
        f"*STEP, INC=100000\n{card}\n*CLOAD\n4, 1, 3.\n"
        "*NODE PRINT, NSET=TIP, FREQUENCY=1000\nU\n*END STEP\n"
    )
    results, text, rows = run(deck, tmp_path)
    exact = exact_chain(lambda t: np.array([0.0, 0.0, 3.0]), 1.0, np.array([0, 0, 0, 0, -1.5, 0.0]))
    last = results.frames[-1]
    automatic = "DIRECT" not in card  # a percent of local error
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], atol=0.04 if automatic else 0.01)
    printed = [line.split() for line in text.splitlines() if line.split()[:1] == ["4"]]
    np.testing.assert_allclose(float(printed[-1][1]), last.U[3, 0], rtol=1e-5)
    _, m, _ = chain_matrices(STIFFNESS, MASSES)
    kinetic = 0.5 * exact[3:] @ m @ exact[3:]
    tolerance = 0.5 if automatic else 0.12
    np.testing.assert_allclose(column(rows, "ALLKE")[-1], kinetic, rtol=tolerance)
    np.testing.assert_allclose(column(rows, "ALLWK")[-1], 3.0 * exact[2], rtol=tolerance)
    np.testing.assert_allclose(last.RF[0, 0], -100.0 * last.U[1, 0], rtol=1e-6)


def test_ramp_of_a_step(tmp_path):
    # AMPLITUDE=RAMP lets the force grow over the step; SciPy.
    deck = (
        CHAIN
        + HELD
        + (
            "*STEP, INC=100000, AMPLITUDE=RAMP\n*DYNAMIC, DIRECT, ALPHA=0.\n0.02, 1.\n"
            "*CLOAD\n4, 1, 3.\n*END STEP\n"
        )
    )
    results, _, _ = run(deck, tmp_path)
    exact = exact_chain(lambda t: np.array([0.0, 0.0, 3.0 * t]), 1.0)
    np.testing.assert_allclose(results.frames[-1].U[1:, 0], exact[:3], atol=2e-3)


AMPLITUDES = {
    "SMOOTH STEP": (
        "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., 0.5, 1.\n",
        lambda t: (lambda x: x**3 * (10 - 15 * x + 6 * x * x))(min(t / 0.5, 1.0)),
    ),
    "PERIODIC": (
        "*AMPLITUDE, NAME=A, DEFINITION=PERIODIC\n1, 5., 0., 0.2\n-0.2, 0.5\n",
        lambda t: 0.2 - 0.2 * math.cos(5 * t) + 0.5 * math.sin(5 * t),
    ),
    "DECAY": (
        "*AMPLITUDE, NAME=A, DEFINITION=DECAY\n1., -1., 0., 0.4\n",
        lambda t: 1.0 - math.exp(-t / 0.4),
    ),
    "EQUALLY SPACED": (
        "*AMPLITUDE, NAME=A, DEFINITION=EQUALLY SPACED, FIXED INTERVAL=0.25\n0., 1., .5, -1., 0.\n",
        lambda t: float(np.interp(t, [0, 0.25, 0.5, 0.75, 1.0], [0, 1, 0.5, -1, 0])),
    ),
}


@pytest.mark.parametrize(
    ("procedure", "definition"), cover(["direct", "modal"], list(AMPLITUDES), strength=1)
)
def test_base_moved_by_every_kind_of_amplitude(definition, procedure, tmp_path):
    # The base of the chain moves by 0.1 A(t): displacement of the tip, reaction of the base.
    card, value = AMPLITUDES[definition]
    first = "*STEP\n*FREQUENCY\n3\n*BOUNDARY\n1, 1\n*END STEP\n" if procedure == "modal" else ""
    kind = {
        "direct": "*DYNAMIC, DIRECT, ALPHA=0.\n0.02, 0.9",
        "modal": "*MODAL DYNAMIC\n0.02, 0.9",
    }[procedure]
    deck = (
        CHAIN
        + card
        + first
        + (f"*STEP, INC=100000\n{kind}\n*BOUNDARY, AMPLITUDE=A\n1, 1, 1, 0.1\n*END STEP\n")
    )
    results, _, _ = run(deck, tmp_path)
    k, m, to_base = chain_matrices(STIFFNESS, MASSES)

    def rate(t, z):
        force = to_base * 0.1 * value(t) - k @ z[:3]
        return np.r_[z[3:], np.linalg.solve(m, force)]

    exact = solve_ivp(rate, (0, 0.9), np.zeros(6), rtol=1e-9, atol=1e-11, max_step=0.01).y[:, -1]
    last = results.frames[-1]
    np.testing.assert_allclose(last.U[1:, 0], exact[:3], atol=4e-3)
    np.testing.assert_allclose(last.U[0, 0], 0.1 * value(0.9), atol=1e-6)
    reaction = 100.0 * (0.1 * value(0.9) - exact[0])
    np.testing.assert_allclose(last.RF[0, 0], reaction, atol=0.3)


def test_rayleigh_shares_of_modes_in_a_deck(tmp_path):
    # *MODAL DAMPING, RAYLEIGH over all modes is C = a M + b K.
    deck = (
        CHAIN
        + HELD
        + (
            "*STEP\n*FREQUENCY\n3\n*END STEP\n*STEP\n*MODAL DYNAMIC\n0.05, 1.2\n"
            "*MODAL DAMPING, RAYLEIGH\n1, 3, 0.7, 0.004\n*CLOAD\n3, 1, 2.\n*END STEP\n"
        )
    )
    results, _, _ = run(deck, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    exact = exact_chain(lambda t: np.array([0.0, 2.0, 0.0]), 1.2, c=0.7 * m + 0.004 * k)
    np.testing.assert_allclose(results.frames[-1].U[1:, 0], exact[:3], rtol=1e-6)


@pytest.mark.parametrize("direct", ["", ", DIRECT"])
def test_harmonic_force_by_a_table_over_the_frequency(direct, tmp_path):
    # The amplitude is read at the frequency, not at a time.
    deck = (
        CHAIN + HELD + "*AMPLITUDE, NAME=F\n0., 1., 2., 3.\n"
        "*STEP\n*FREQUENCY\n3\n*END STEP\n"
        f"*STEP\n*STEADY STATE DYNAMICS{direct}\n0.3, 0.6, 4\n*CLOAD, AMPLITUDE=F\n4, 1, 2.\n"
        "*END STEP\n"
    )
    results, _, _ = run(deck, tmp_path)
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    frames = [f for f in results.frames if f.step == 2]
    assert len(frames) >= 3
    for frame in frames:
        w = 2 * math.pi * frame.time
        force = 2.0 * (1.0 + frame.time)
        exact = np.linalg.solve(k - w**2 * m, [0.0, 0.0, force])
        np.testing.assert_allclose(frame.U[1:, 0], exact, rtol=1e-6)


def test_times_that_output_asks_for(tmp_path):
    # *TIME POINTS are hit exactly; between them the motion is that without them.
    deck = (
        CHAIN + HELD + "*TIME POINTS, NAME=T\n0.137, 0.5, 0.7315\n"
        "*STEP, INC=100000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.01, 1.\n*CLOAD\n4, 1, 3.\n"
        "*NODE PRINT, NSET=TIP, TIME POINTS=T\nU\n*END STEP\n"
    )
    _, text, _ = run(deck, tmp_path)
    times = [float(line.split()[-1]) for line in text.splitlines() if "time" in line]
    np.testing.assert_allclose(times[:3], [0.137, 0.5, 0.7315], rtol=1e-6)
    rows = [float(line.split()[1]) for line in text.splitlines() if line.split()[:1] == ["4"]]
    for t, row in zip(times[:3], rows, strict=False):
        exact = exact_chain(lambda now: np.array([0.0, 0.0, 3.0]), t)
        np.testing.assert_allclose(row, exact[2], atol=5e-4)


def test_files_hold_velocity_and_acceleration(tmp_path):
    # V, A, RF and energies of the last instant, read back from the result file.
    deck = (
        CHAIN
        + HELD
        + ("*STEP, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0.\n0.02, 0.5\n*CLOAD\n4, 1, 3.\n*END STEP\n")
    )
    results, _, rows = run(deck, tmp_path)
    there = ct.read_results(str(tmp_path / "job.vtkhdf"))
    last, back = results.frames[-1], there.frames[-1]
    np.testing.assert_allclose(back.U, last.U, rtol=1e-12)
    np.testing.assert_allclose(back.RF, last.RF, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(back.V, last.V, rtol=1e-12)
    np.testing.assert_allclose(back.A, last.A, rtol=1e-12)
    for name in ("ALLKE", "ALLSE", "ALLWK", "ETOTAL"):
        np.testing.assert_allclose(back.scalars[name], last.scalars[name], rtol=1e-12)
        np.testing.assert_allclose(column(rows, name)[-1], last.scalars[name], rtol=1e-5, atol=1e-9)
    # Newton's second law holds in the frame itself
    k, m, _ = chain_matrices(STIFFNESS, MASSES)
    force = np.array([0.0, 0.0, 3.0]) - k @ last.U[1:, 0]
    np.testing.assert_allclose(m @ last.A[1:, 0], force, atol=1e-6)


@pytest.mark.parametrize("card", ["*DYNAMIC, DIRECT\n0.03, 0.3", "*DYNAMIC\n0.03, 0.3"])
def test_resumed_steps_of_motion(card, tmp_path):
    # Static stretch, motion, motion under another load: resumed after the second step the
    # end is the same to the bit.
    deck = (
        CHAIN
        + HELD
        + (
            "*RESTART, WRITE\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n4, 1, 3.\n*END STEP\n"
            f"*STEP, INC=10000\n{card}\n*CLOAD\n4, 1, 0.\n*END STEP\n"
            f"*STEP, INC=10000\n{card}\n*CLOAD\n3, 1, 1.\n*END STEP\n"
        )
    )
    results, _, _ = run(deck, tmp_path)
    last = results.frames[-1]
    again = ct.resume(str(tmp_path / "job.step-2.ckpt")).frames[-1]
    assert np.array_equal(again.U, last.U)
    assert np.array_equal(again.V, last.V)
    assert again.scalars["ETOTAL"] == last.scalars["ETOTAL"]


# --- beside CalculiX -----------------------------------------------------------------------------


def frame_deck():
    """An L of CPE8 elements, legs of 100 x 10 mm and 60 x 10."""
    lines = ["*NODE, NSET=ALL"]
    number, cells = {}, []

    def node(x, y):
        key = (round(x, 6), round(y, 6))
        if key not in number:
            number[key] = len(number) + 1
            lines.append(f"{number[key]}, {key[0]}, {key[1]}")
        return number[key]

    grid = [(5.0 * i, 5.0 * j) for j in range(22) for i in range(2)]
    grid += [(10.0 + 5.0 * i, 100.0 + 5.0 * j) for i in range(12) for j in range(2)]
    for x, y in grid:
        h = 2.5
        corners = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        cells.append([node(x + a * h, y + b * h) for a, b in corners])
    lines.append("*ELEMENT, TYPE=CPE8, ELSET=E")
    lines += [f"{i + 1}, " + ", ".join(map(str, c)) for i, c in enumerate(cells)]
    tip = number[70.0, 105.0]
    foot = [n for (x, y), n in number.items() if y == 0.0]
    lines += ["*NSET, NSET=FOOT", ", ".join(map(str, foot))]
    lines += ["*NSET, NSET=TIP", str(tip)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "210000., .3", "*DENSITY", "7.8E-9"]
    lines += ["*SOLID SECTION, ELSET=E, MATERIAL=M", "5."]
    lines += ["*BOUNDARY", "FOOT, 1, 2"]
    return "\n".join(lines) + "\n"


#: CalculiX 2.20, the deck above: frequencies at rest and under -300 N at the tip [Hz].
CALCULIX = {
    "rest": [383.2654, 1349.410, 4662.217, 8734.807],
    "loaded": [381.8669, 1341.862, 4661.912, 8751.543],
}
STEPS = {
    "rest": "*STEP\n*FREQUENCY\n4\n*END STEP\n",
    "loaded": (
        "*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\nTIP, 2, -300.\n*END STEP\n"
        "*STEP, PERTURBATION\n*FREQUENCY\n4\n*END STEP\n"
    ),
}


@pytest.mark.parametrize("case", list(STEPS))
def test_frame_beside_calculix(case, tmp_path):
    path = tmp_path / "frame.inp"
    path.write_text(frame_deck() + STEPS[case])
    found = ct.solve(ct.read(path)).modes[-1].factors
    tolerance = {"rest": 1e-6, "loaded": 2e-4}[case]
    np.testing.assert_allclose(found, CALCULIX[case], rtol=tolerance)

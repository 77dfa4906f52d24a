"""Supports by velocity and acceleration, and those that stay where a step finds them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.model.integrated import IntegratedAmplitude

#: A mass on a spring whose other end is the base: omega = 20.
OSCILLATOR = """*NODE
1, 0., 0.
2, 1., 0.
*ELEMENT, TYPE=SPRINGA, ELSET=COIL
1, 1, 2
*SPRING, ELSET=COIL

800.
*ELEMENT, TYPE=MASS, ELSET=BOB
2, 2
*MASS, ELSET=BOB
2.
*BOUNDARY
1, 2
2, 2
"""
OMEGA = 20.0


def solve(tmp_path: Path, text: str) -> ct.Results:
    path = tmp_path / "base.inp"
    path.write_text(OSCILLATOR + text, encoding="utf-8")
    return ct.solve(ct.read(path), threads=1)


def message(tmp_path: Path, text: str) -> str:
    with pytest.raises(ct.DeckError) as caught:
        solve(tmp_path, text)
    return str(caught.value)


def test_integrals_of_a_table_are_exact() -> None:
    rng = np.random.default_rng(3)
    time = np.cumsum(rng.uniform(0.1, 1.0, 6)) - 0.5
    rate = rng.normal(size=6)
    for begins in (-1.0, 0.0, 1.3, 9.0):
        fine = np.unique(np.concatenate([np.linspace(begins, begins + 8.0, 200_001), time]))
        fine = fine[fine >= begins]
        f = np.interp(fine, time, rate)
        h = np.diff(fine)
        v = np.append(0.0, np.cumsum(0.5 * h * (f[1:] + f[:-1])))
        u = np.append(0.0, np.cumsum(h * v[:-1] + h * h * (f[:-1] / 3.0 + f[1:] / 6.0)))
        once, twice = (IntegratedAmplitude(time, rate, order, begins) for order in (1, 2))
        for at in rng.integers(1, len(fine), 20):
            t = float(fine[at])
            assert once(t) == pytest.approx(v[at], abs=1e-9)
            assert twice(t) == pytest.approx(u[at], abs=1e-9)
            assert once.derivatives(t, 0.01)[0] == pytest.approx(f[at], abs=1e-9)
            assert twice.derivatives(t, 0.01) == pytest.approx((v[at], f[at]), abs=1e-9)


@pytest.mark.parametrize(("direct", "error"), [(", DIRECT", 4e-5), ("", 2e-4)])
def test_a_base_that_is_accelerated(tmp_path: Path, direct: str, error: float) -> None:
    """The mass swings about -a/omega^2 in the frame of the base."""
    results = solve(
        tmp_path,
        f"*STEP, INC=4000\n*DYNAMIC, ALPHA=0.{direct}\n5e-4, 0.5, , 2e-3\n"
        "*BOUNDARY, TYPE=ACCELERATION\n1, 1, 1, 3.\n*END STEP\n",
    )
    for frame in results.frames:
        t = frame.time
        assert frame.U[0, 0] == pytest.approx(1.5 * t * t, abs=1e-12)
        relative = -3.0 / OMEGA**2 * (1.0 - np.cos(OMEGA * t))
        assert frame.U[1, 0] - frame.U[0, 0] == pytest.approx(relative, abs=error)


def test_a_velocity_goes_on_in_total_time_from_where_a_static_step_ended(tmp_path: Path) -> None:
    results = solve(
        tmp_path,
        "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0., 5., 1., 0., 3., 4.\n"
        "*STEP\n*STATIC\n*BOUNDARY\n1, 1, 1, 0.25\n*END STEP\n"
        "*STEP, INC=4000\n*DYNAMIC, DIRECT\n0.01, 1.\n"
        "*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=RUN\n1, 1, 1, 0.5\n*END STEP\n"
        "*STEP, INC=4000\n*DYNAMIC, DIRECT\n0.01, 1.\n*END STEP\n",
    )
    for frame in results.frames:
        if frame.step > 1:
            # In total time: from 0 at 1 the velocity grows by 2 x 0.5 per time.
            past = frame.time - 1.0
            assert frame.U[0, 0] == pytest.approx(0.25 + 0.5 * past**2, abs=1e-12)


def test_a_velocity_lasts_until_it_is_given_again(tmp_path: Path) -> None:
    """An acceleration says how it goes on."""
    step = (
        "*STEP\n*DYNAMIC, DIRECT\n0.01, 0.1\n*BOUNDARY, TYPE={}\n1, 1, 1, 1.\n*END STEP\n"
        "*STEP\n*DYNAMIC, DIRECT\n0.01, 0.1\n*END STEP\n"
    )
    assert "does not continue it" in message(tmp_path, step.format("ACCELERATION"))
    frame = solve(tmp_path, step.format("VELOCITY")).frames[-1]
    assert frame.U[0, 0] == pytest.approx(0.2, abs=1e-12)
    again = step.format("VELOCITY").replace(
        "0.1\n*END", "0.1\n*BOUNDARY, TYPE=VELOCITY\n1,1,1,2.\n*END"
    )
    frame = solve(tmp_path, again).frames[-1]
    assert frame.U[0, 0] == pytest.approx(0.1 * 1.0 + 0.1 * 2.0, abs=1e-12)


@pytest.mark.parametrize("kind", ["0., 0., .1, 1., .4, -2.", "0., 1., .2, 3."])
def test_a_table_of_step_time_leaves_its_last_velocity(tmp_path: Path, kind: str) -> None:
    """The record of one step ends within another: the support goes on at its last velocity."""
    frame = solve(
        tmp_path,
        f"*AMPLITUDE, NAME=RUN\n{kind}\n*STEP\n*DYNAMIC, DIRECT\n0.01, 0.2\n"
        "*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=RUN\n1, 1, 1, 0.5\n*END STEP\n"
        "*STEP\n*DYNAMIC, DIRECT\n0.01, 0.3\n*END STEP\n",
    ).frames[-1]
    way, last = (0.05 + 0.05, 0.0) if kind.endswith("-2.") else (0.4, 3.0)
    assert frame.U[0, 0] == pytest.approx(0.5 * (way + 0.3 * last), abs=1e-12)


def test_velocities_in_static_steps_are_displacements_per_time(tmp_path: Path) -> None:
    """They act at once and last, also across a frequency step; a table is integrated.

    One of step time ends with its step, as in Abaqus ("the prescribed condition remains constant
    at the magnitude associated with the end of the previous step"); it went on in later ones.
    """
    move = "*BOUNDARY, TYPE=VELOCITY{}\n1, 1, 1, {}\n"
    head = "*AMPLITUDE, NAME=RUN\n0., 0., 2., 4.\n*STEP\n*STATIC\n.5, .5\n"
    for option, value, ends in (("", "0.2", (0.1, 0.5, 0.9)), (", AMPLITUDE=RUN", "1.", ())):
        text = head + move.format(option, value) + "*END STEP\n*STEP\n*FREQUENCY\n1\n*END STEP\n"
        text += "*STEP\n*STATIC\n2., 2.\n*END STEP\n*STEP\n*STATIC\n1., 1.\n"
        text += move.format("", "0.4") + "*END STEP\n"
        found = [f.U[0, 0] for f in solve(tmp_path, text).frames if f.step != 2 and f.time]
        # t^2 up to the end of the first step at 0.5, where the velocity is 1.
        expected = ends or (0.25, 2.25, 2.65)
        assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("*BOUNDARY, TYPE=VELOCITY\n1, 1, 1, 1.\n", "TYPE belongs in a step"),
        (
            "*STEP\n*STATIC\n*BOUNDARY, TYPE=ACCELERATION\n1, 1, 1, 1.\n*END STEP\n",
            "belongs to *DYNAMIC",
        ),
        (
            "*STEP\n*BUCKLE\n1\n*BOUNDARY, TYPE=VELOCITY\n1, 1, 1, 1.\n*END STEP\n",
            "belongs to steps with time",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=VELOCITY\n1, 1, 3.\n"
            "*STEP\n*DYNAMIC\n.1, 1.\n*BOUNDARY, TYPE=ACCELERATION\n1, 1, 1, 1.\n*END STEP\n",
            "have an initial velocity",
        ),
        ("*BOUNDARY, FIXED\n1, 1\n", "FIXED belongs in a step"),
    ],
)
def test_what_has_no_meaning_is_refused(tmp_path: Path, text: str, said: str) -> None:
    assert said in message(tmp_path, text)


def test_fixed_keeps_what_the_step_before_reached(tmp_path: Path) -> None:
    results = solve(
        tmp_path,
        "*STEP\n*STATIC\n*BOUNDARY\n1, 1\n*CLOAD\n2, 1, 40.\n*END STEP\n"
        "*STEP\n*STATIC\n*BOUNDARY, FIXED\n2, 1, 1\n*CLOAD\n2, 1, 0.\n*END STEP\n",
    )
    assert [f.U[1, 0] for f in results.frames] == pytest.approx([0.0, 0.05, 0.05], abs=1e-12)

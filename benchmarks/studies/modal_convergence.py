"""Modal response beside direct integration over the number of modes: a table of docs/dynamics.md.

A cantilever under every kind of load, support, start and attachment, linear, over a fifth of
its first period and more. The direct answer is the trapezoidal rule with increments so short that
halving them changes less than the last digit; the error is the largest displacement over space and
time that differs, relative to the largest. With residual modes and without.

``--write`` puts the table between the marks in docs/dynamics.md.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import write_between
from corota.model.loads import Amplitude, BodyForce, EdgeLoad, NodalForce

PAGE = Path(__file__).resolve().parents[2] / "docs" / "dynamics.md"
PERIOD, INCREMENTS = 1.0, 200
#: Increments of the direct run over those of the modal one; two runs are extrapolated.
FINER = (8, 16)
COUNTS = (1, 2, 4, 8, 24)
TIMES = np.linspace(0.0, PERIOD, INCREMENTS + 1)


def cantilever() -> ct.Model:
    """A strip of 10 x 1; 24 dofs are free."""
    model = ct.Model(ct.mesh.rectangle(10.0, 1.0, nx=6, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.3, rho=1.0))
    model.fix("left")
    smooth = 0.5 * (1.0 - np.cos(np.pi * TIMES / PERIOD))
    model.amplitudes["smooth"] = Amplitude(TIMES, smooth)
    model.amplitudes["sine"] = Amplitude(TIMES, np.sin(10.0 * TIMES))
    return model


def moved(model: ct.Model) -> None:
    """The clamp moves across."""
    model.supports.clear()
    model.fix("left", y=0.2, amplitude="smooth")


def one_moved(model: ct.Model) -> None:
    """One of two supports moves, which bends the strip."""
    model.fix("right", x=None, y=0.2, amplitude="smooth")


def rigid(model: ct.Model) -> None:
    """A rigid end with a moment at its reference node."""
    model.rigid(model.mesh.nodes_of("right"), ct.mesh.add_node(model.mesh, 11.0, 0.5))


def damped(model: ct.Model) -> None:
    """A dashpot to the ground and one along a line."""
    right, left = model.mesh.nodes_of("right"), model.mesh.nodes_of("left")
    model.dashpot(int(right[0]), x=1.0, y=3.0)
    model.dashpot(int(right[1]), int(left[0]), c=5.0)


def nothing(_: ct.Model) -> None:
    """The plain cantilever."""


TIP = [NodalForce("right", 1, -0.1, "sine")]
Case = tuple[Callable[[ct.Model], Any], list[Any], dict[str, Any]]
CASES: dict[str, Case] = {
    "force, at once": (nothing, [NodalForce("right", 1, -0.1)], {}),
    "force, sine": (nothing, TIP, {}),
    "traction": (nothing, [EdgeLoad("top", "traction", (0.1, -0.2))], {}),
    "pressure, sine": (nothing, [EdgeLoad("top", "pressure", (0.2,), "sine")], {}),
    "gravity": (nothing, [BodyForce("", "gravity", (0.3, -1.0))], {}),
    "moving clamp": (moved, [], {}),
    "one support moves": (one_moved, [], {}),
    "initial velocity": (lambda m: m.velocity(spin=0.1, about=(0.0, 0.5)), [], {}),
    "point mass": (lambda m: m.point_mass("right", 2.0), TIP, {}),
    "dashpots": (damped, TIP, {}),
    "Rayleigh damping": (nothing, TIP, {"rayleigh": (2.0, 1e-4)}),
    "rigid end": (rigid, TIP, {}),
}


def response(case: str, steps: Callable[[dict[str, Any]], list[Any]]) -> Any:
    """Displacements at TIMES after the start."""
    change, loads, keys = CASES[case]
    model = cantilever()
    change(model)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(
            model, steps({"loads": loads, "nlgeom": False, **keys}), fields=False, threads=1
        )
    last = max(frame.step for frame in results.frames)
    frames = [f for f in results.frames if f.step == last and f.increment]
    each = len(frames) // INCREMENTS
    return np.array([f.U for f in frames[each - 1 :: each]])


def direct(case: str) -> Any:
    """The answer of direct integration, extrapolated (Richardson)."""
    coarse, fine = (
        response(
            case,
            lambda keys, n=n: [  # type: ignore[misc]
                ct.Dynamic(period=PERIOD, increments=n * INCREMENTS, scheme="newmark", **keys)
            ],
        )
        for n in FINER
    )
    return (4.0 * fine - coarse) / 3.0


def modal(case: str, count: int, residual: bool) -> Any:
    """The answer of so many modes."""
    return response(
        case,
        lambda keys: [
            ct.Frequency(modes=count, nlgeom=False),
            ct.ModalDynamic(period=PERIOD, increments=INCREMENTS, residual=residual, **keys),
        ],
    )


def errors(case: str) -> list[tuple[float, float]]:
    """Largest error over time without and with residual modes, for each number of modes."""
    exact = direct(case)
    size = np.abs(exact).max()
    return [
        tuple(float(np.abs(modal(case, n, r) - exact).max() / size) for r in (False, True))  # type: ignore[misc]
        for n in COUNTS
    ]


def table() -> str:
    """Lines of Markdown."""
    lines = [
        "| case | " + " | ".join(f"{n} modes" if n > 1 else "1 mode" for n in COUNTS) + " |",
        "| --- |" + " --- |" * len(COUNTS),
    ]
    sys.stdout.write("\n".join(lines) + "\n")
    for case in CASES:
        cells = [f"{a:.1e} / {b:.1e}" for a, b in errors(case)]
        lines.append(f"| {case} | {' | '.join(cells)} |")
        sys.stdout.write(lines[-1] + "\n")
        sys.stdout.flush()
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    text = table()
    if parser.parse_args().write:
        write_between(PAGE, "modal", text)


if __name__ == "__main__":
    main()

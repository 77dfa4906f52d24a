"""Elements and local strains beyond yield, side by side: writes ``docs/plasticity-table.md``.

Six elements with the linear and the logarithmic local strain on two meshes of
the perforated strip, Cook's panel and a perfectly plastic cantilever; and OPT's weight, locking in
plane strain. Results, iterations and seconds of one thread. ``--write`` writes the page.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from benchmarks.common import machine, table
from corota.verification.plastic_models import (
    cantilever,
    cook,
    find,
    notched,
    perforated_strip,
)

ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D", "Q4S", "Q4DI")
MEASURES = ("linear", "logarithmic")
PAGE = Path(__file__).parents[2] / "docs" / "plasticity-table.md"


def solve(model: ct.Model, step: ct.Static) -> tuple[ct.Results, str, float]:
    """Results, iterations and seconds; what stopped it where it did not end."""
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            results = ct.solve(model, step, threads=1)
        except ct.ConvergenceError as error:
            if error.results is None:
                raise
            results = error.results
    seconds = time.perf_counter() - begin
    ended = results.frames[-1].factor == 1.0
    count = str(int(results.info["iterations"])) + ("" if ended else " (stopped)")
    return results, count, seconds


def strip(element: str, n: int, measure: str) -> tuple[float, str, float]:
    """Force at an elongation of 0.3 of the strip 10 x 18, per unit thickness."""
    model = perforated_strip(element, n, local_strain=measure)
    results, count, seconds = solve(model, ct.Static(increments=10))
    top = find(model.mesh, 1, 18.0)
    return float(results.frames[-1].RF[top, 1].sum()) / 0.01, count, seconds


def panel(element: str, n: int, measure: str) -> tuple[float, str, float]:
    """Tip displacement of Cook's panel under a force of 1.8."""
    model = cook(element, n, local_strain=measure)
    results, count, seconds = solve(model, ct.Static(first_increment=0.1))
    corner = int(np.argmin(np.abs(model.mesh.points - [48.0, 60.0]).sum(axis=1)))
    return float(results.frames[-1].U[corner, 1]), count, seconds


def beam(element: str, n: int, measure: str) -> tuple[float, str, float]:
    """Force over the limit load of beam theory at a tip displacement of 0.5."""
    model = cantilever(element, n, 0.5, measure)
    results, count, seconds = solve(model, ct.Static(increments=10))
    right = model.mesh.nodes_of("right")
    return -40.0 * float(results.frames[-1].RF[right, 1].sum()), count, seconds


PROBLEMS: tuple[tuple[str, Any, tuple[int, int], str], ...] = (
    ("Perforated strip: force at an elongation of 0.3", strip, (5, 10), "cells per eighth"),
    ("Cook's panel: tip displacement at a force of 1.8", panel, (8, 16), "elements per side"),
    ("Cantilever: force over the beam's limit load", beam, (4, 8), "cells in the height"),
)


def comparison(title: str, run: Any, meshes: tuple[int, int], what: str) -> str:
    """Table of one problem."""
    rows: list[list[object]] = []
    for measure in MEASURES:
        for element in ELEMENTS:
            row: list[object] = [measure, element]
            for n in meshes:
                value, count, seconds = run(element, n, measure)
                row += [f"{value:.4f}", count, f"{seconds:.2f}"]
            rows.append(row)
    head = ["local strain", "element"]
    for n in meshes:
        head += [f"{n} {what}", "iterations", "s"]
    return f"### {title}\n\n{table(head, rows)}\n"


def weight() -> str:
    """OPT's weight beyond the limit load of the cantilever, and in Cook's panel."""
    rows: list[list[object]] = []
    for beta0 in (None, 0.2, 0.05, 0.01):
        row: list[object] = ["elastic (0.32)" if beta0 is None else f"{beta0:g}"]
        for build, value in ((_weighted_beam, _beam_force), (_weighted_panel, _panel_tip)):
            for n in (4, 8):
                model = build(n, beta0)
                rotating = build is _weighted_panel
                results, _, _ = solve(model, ct.Static(first_increment=0.1, nlgeom=rotating))
                row.append(f"{value(model, results):.4f}")
        rows.append(row)
    head = ("beta0", "cantilever, 4", "cantilever, 8", "Cook, 4", "Cook, 8")
    return f"### OPT: weight of the bending stiffness\n\n{table(head, rows)}\n"


def _weighted_beam(n: int, beta0: float | None) -> ct.Model:
    model = cantilever("OPT", n, 0.5)
    model.sections[0].beta0 = beta0
    return model


def _weighted_panel(n: int, beta0: float | None) -> ct.Model:
    model = cook("OPT", n)
    model.sections[0].beta0 = beta0
    return model


def _beam_force(model: ct.Model, results: ct.Results) -> float:
    right = model.mesh.nodes_of("right")
    return -40.0 * float(results.frames[-1].RF[right, 1].sum())


def _panel_tip(model: ct.Model, results: ct.Results) -> float:
    corner = int(np.argmin(np.abs(model.mesh.points - [48.0, 60.0]).sum(axis=1)))
    return float(results.frames[-1].U[corner, 1])


def locking() -> str:
    """Load on the ligament of the double-notched specimen in plane strain."""
    rows: list[list[object]] = []
    cases: tuple[tuple[str, bool], ...] = (
        ("Q4", False),
        ("Q4", True),
        ("Q4I", False),
        ("Q8R", False),
        ("Q8R", True),
        ("Q8", False),
        ("Q4D", False),
        ("Q4D", True),
        ("OPT", False),
    )
    for element, mean in cases:
        row: list[object] = [element, "yes" if mean else "no"]
        for n in (4, 8):
            # Until the load rises no more: before that it passes the limit on its way.
            model = notched(element, n, 0.3, mean_dilatation=mean)
            results, count, _ = solve(model, ct.Static(increments=10, nlgeom=False))
            top = find(model.mesh, 1, 15.0)
            row += [f"{results.frames[-1].RF[top, 1].sum() / 450.0:.4f}", count]
        rows.append(row)
    head = ("element", "mean dilatation", "4 cells", "iterations", "8 cells", "iterations")
    return f"### Double notch, plane strain: limit load 2.9685\n\n{table(head, rows)}\n"


def page() -> str:
    """The whole page."""
    parts = [comparison(*problem) for problem in PROBLEMS] + [weight(), locking()]
    head = (
        "# Plasticity: measured tables\n\n"
        "Written by `python -m benchmarks plasticity_table --write`; the page "
        f"[plasticity](plasticity.md) has the conclusions. Measured on {machine()}.\n"
    )
    return "\n".join([head, *parts])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    options = parser.parse_args()
    text = page()
    if options.write:
        PAGE.write_text(text, encoding="utf-8")
    sys.stdout.write(text)


if __name__ == "__main__":
    main()

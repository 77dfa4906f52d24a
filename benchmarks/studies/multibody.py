"""Flexible multibody problems beside exudyn: the tables and pictures of docs/multibody.md.

A beam that is spun up (Simo and Vu-Quoc), a falling flexible pendulum, a slider-crank and a
four-bar linkage, with beams and, where there is one bar, with planar elements too. exudyn has
geometrically exact beams and generalized alpha. Where it is not installed its stored answers are
taken.

``--store`` runs exudyn and stores its answers, ``--write`` puts tables and pictures into the page.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import importlib.util
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.common import table, write_between
from benchmarks.corpora.mechanisms import (
    MECHANISMS,
    SAMPLES,
    Floats,
    Mechanism,
    measured,
    with_beams,
    with_planes,
)

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "multibody.md"
STORED = ROOT / "benchmarks" / "data" / "multibody.json"
#: Beams a bar and increments of exudyn. Elements and scheme are of second order, so the answers of
#: both are extrapolated (Richardson).
PEER = ((32, 3000), (64, 6000))
#: Beams a bar of our runs, coarse to fine, and the increments over those of the mechanism.
OURS = ((4, 1), (8, 2), (16, 4))
SCHEME = "generalized_alpha"
PLANES = ("spin_up", "pendulum")
PLANE_CELLS, PLANE_FACTOR = 16, 2
TITLES = {
    "spin_up": "Spin-up",
    "pendulum": "Falling pendulum",
    "slider_crank": "Slider-crank",
    "four_bar": "Four-bar linkage",
}


def largest(difference: Floats, size: Floats) -> float:
    """Largest difference over the largest size."""
    return float(np.abs(difference).max() / np.abs(size).max())


def store(names: list[str]) -> None:
    """Run exudyn and store its answers with what they changed by refinement."""
    import exudyn

    from benchmarks.peers import run_exudyn

    kept = json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else {}
    for name in names:
        mechanism = MECHANISMS[name]()
        coarse, fine = (run_exudyn.run(mechanism, *size) for size in PEER)
        values = {q: (4.0 * fine[q] - coarse[q]) / 3.0 for q in fine}
        kept[name] = {
            "exudyn": exudyn.__version__,
            "change": {q: float(f"{largest(fine[q] - values[q], values[q]):.3g}") for q in fine},
            "values": {q: [float(f"{v:.6g}") for v in values[q]] for q in fine},
        }
        sys.stdout.write(f"stored {name}: {kept[name]['change']}\n")
    STORED.write_text(json.dumps(kept, separators=(",", ":"), indent=None) + "\n", "utf-8")


def answers(name: str) -> dict[str, Any]:
    """Answers of exudyn, stored."""
    found: dict[str, Any] = json.loads(STORED.read_text(encoding="utf-8"))[name]
    return found


def ours(name: str, mechanism: Mechanism) -> dict[str, dict[str, Floats]]:
    """Quantities of our runs at the times of exudyn."""
    found = {}
    for cells, factor in OURS:
        increments = factor * mechanism.increments
        time, x = with_beams(mechanism, cells, increments, SCHEME)
        values = measured(mechanism, time, x)
        found[f"{cells} beams"] = {q: v[:: increments // SAMPLES] for q, v in values.items()}
    if name in PLANES:
        increments = PLANE_FACTOR * mechanism.increments
        time, x = with_planes(mechanism, "Q8", PLANE_CELLS, increments, SCHEME)
        values = measured(mechanism, time, x)
        found["Q8"] = {q: v[:: increments // SAMPLES] for q, v in values.items()}
    return found


def rows(name: str, runs: dict[str, dict[str, Floats]]) -> list[list[str]]:
    """Rows of the table: largest difference over time, relative to the largest value."""
    peer = answers(name)
    out = []
    for quantity, values in peer["values"].items():
        reference = np.array(values)
        errors = {
            label: largest(run[quantity] - reference, reference) for label, run in runs.items()
        }
        out.append(
            [
                TITLES[name],
                quantity,
                f"{np.abs(reference).max():.4g}",
                f"{peer['change'][quantity]:.1e}",
                *(f"{errors[f'{cells} beams']:.1e}" for cells, _ in OURS),
                f"{errors['Q8']:.1e}" if "Q8" in errors else "",
            ]
        )
    return out


def draw(name: str, mechanism: Mechanism, runs: dict[str, dict[str, Floats]]) -> Path:
    """Histories of ours as lines on exudyn's points, and the mechanism at some times."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    peer = answers(name)["values"]
    time = np.linspace(0.0, mechanism.period, SAMPLES + 1)
    figure, axes = plt.subplots(
        1, len(peer) + 1, figsize=(3.4 * (len(peer) + 1), 2.9), layout="constrained"
    )
    last = 2 * mechanism.increments
    _, x = with_beams(mechanism, 8, last, SCHEME)
    for k in np.linspace(0, last, 13).astype(int):
        shade = str(0.75 - 0.75 * k / last)
        for bar in x:
            axes[0].plot(bar[k, :, 0], bar[k, :, 1], color=shade, linewidth=0.9)
    axes[0].set(aspect="equal", title=TITLES[name])
    axes[0].set_adjustable("datalim")
    label = f"{OURS[-1][0]} beams"
    for axis, (quantity, values) in zip(axes[1:], peer.items(), strict=True):
        axis.plot(
            time[::2], values[::2], "o", markersize=3, markerfacecolor="none", color="#cc6677"
        )
        axis.plot(time, runs[label][quantity], color="#4477aa", linewidth=1.0)
        if "Q8" in runs:
            axis.plot(time, runs["Q8"][quantity], "--", color="#228833", linewidth=1.0)
        axis.set(title=quantity, xlabel="time")
    names = ["exudyn", "Corota, beams", *(["Corota, Q8"] if "Q8" in runs else [])]
    axes[1].legend(names, frameon=False, fontsize=8)
    path = ROOT / "docs" / "images" / f"multibody-{name.replace('_', '-')}.png"
    figure.savefig(path, dpi=80)
    plt.close(figure)
    return path


def steady(run: dict[str, Floats]) -> float:
    """Mean stretch of the spun beam over the last second, in steady spin."""
    return float(run["tip, along"][-SAMPLES // 20 :].mean())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(MECHANISMS)}")
    parser.add_argument("--store", action="store_true", help="run exudyn and store its answers")
    parser.add_argument("--write", action="store_true", help="write docs/multibody.md")
    options = parser.parse_args()
    names = options.names or list(MECHANISMS)
    if options.store or importlib.util.find_spec("exudyn") is not None:
        store(names)
    lines: list[list[str]] = []
    notes = []
    for name in names:
        mechanism = MECHANISMS[name]()
        runs = ours(name, mechanism)
        lines += rows(name, runs)
        if name == "spin_up":
            bar = mechanism.bars[0]
            exact = bar.mass * 36.0 * bar.length**3 / (3.0 * bar.ea)
            values = ", ".join(f"{label} {steady(run):.3e}" for label, run in runs.items())
            notes.append(
                f"Steady stretch of the spun beam, rho A w^2 L^3 / (3 EA) = {exact:.3e}: {values}."
            )
        if options.write:
            draw(name, mechanism, runs)
    head = ["problem", "quantity", "largest", "exudyn, 64 beams per bar"]
    head += [f"{cells} beams per bar" for cells, _ in OURS]
    head += [f"Q8, {PLANE_CELLS} x 2"]
    text = table(head, lines) + "\n" + "".join(f"\n{note}\n" for note in notes)
    sys.stdout.write(text)
    if options.write:
        write_between(PAGE, "multibody", text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

"""Impacts: schemes on an elastic bar, rings and bars that yield: the tables of docs/measured.md.

The bar (200 elements, increments of half the time a wave takes through one) with every implicit
scheme, with the mass of the contact nodes redistributed and without; an elastic ring that hits the
wall straight and obliquely with friction: momenta, energies and where they go; then bars and rings
that hit a wall at two speeds and yield, with four elements, consistent inertia and the scheme of
energy and momentum with automatic increments: rebound, energies, balance error, momentum
along the wall, residual shape, iterations, time.

``--quick`` runs coarser models; ``--write`` puts the tables between the marks in docs/measured.md
and draws the picture there.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.common import machine, write_between
from corota.verification.impact_models import Flight, fly, run_ring, strike

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "measured.md"
PICTURE = ROOT / "docs" / "images" / "impact.png"
SCHEME_PICTURE = ROOT / "docs" / "images" / "impact-schemes.png"
SCHEMES = ("newmark", "hht", "generalized_alpha", "energy_momentum")
ELEMENTS = ("Q4I", "Q8", "OPT", "Q4D")


@dataclass
class Budget:
    """Momenta and energies of a flight; energies over the kinetic energy of the start.

    Parameters
    ----------
    before, after, impulse : ndarray, shape (3,)
        Momentum along and across the wall and about the origin at both ends, and what the wall
        gave: its force and moment, summed over the increments.
    travel, spin, vibration : float
        Energy at the end of the motion of the center of mass, of the mean spin about it, and the
        rest, kinetic and elastic.
    friction : float
        Frictional dissipation.
    energy_error : float
        Energy missing at the end: dissipated by scheme and contact, or created if negative.
    depth : float
        Deepest penetration of a slave node's weighted gap [length].
    contacts : int
        Number of contacts of the ring with the wall.
    ratio : float
        Largest ratio of the friction of the wall to its pressure.
    history : dict of ndarray
        Times, forces, momenta and energies of every increment.
    """

    before: np.ndarray
    after: np.ndarray
    impulse: np.ndarray
    travel: float
    spin: float
    vibration: float
    friction: float
    energy_error: float
    depth: float
    contacts: int
    ratio: float
    history: dict[str, np.ndarray]


def body_of(results: ct.Results, frame: int) -> tuple[float, np.ndarray, float]:
    """Mass, center of mass and inertia about it in a frame."""
    rho = results.model.sections[0].material.rho
    fields = results.frames[frame].fields
    weight = rho * np.concatenate([f.volume.ravel() for f in fields])
    x = np.concatenate([f.points.reshape(-1, 2) for f in fields])
    mass = float(weight.sum())
    center = weight @ x / mass
    return mass, center, float(weight @ ((x - center) ** 2).sum(axis=1))


def budget(results: ct.Results) -> Budget:
    """Balance of momenta and energies of an elastic ring against the wall."""
    frames, mesh = results.frames, results.mesh
    value = {n: np.array([f.scalars[n] for f in frames[1:]]) for n in frames[-1].scalars}
    mass, _, inertia = body_of(results, 0)
    motion = results.model.velocities[0].value
    velocity, spin, about = np.array(motion[:2]), motion[2], np.array(motion[3:5])
    turn = mass * (about[0] * velocity[1] - about[1] * velocity[0]) + inertia * spin
    first = 0.5 * mass * float(velocity @ velocity) + 0.5 * inertia * spin**2
    names = ("momentum x", "momentum y", "angular momentum")
    after = np.array([value[n][-1] for n in names])
    force = {n: value[f"wall: {n}"] for n in ("force x", "force y", "moment")}
    _, center, spread = body_of(results, -1)
    own = after[2] - (center[0] * after[1] - center[1] * after[0])
    energy = value["kinetic energy"] + value["strain energy"]
    travel = 0.5 * float(after[:2] @ after[:2]) / mass
    rotary = 0.5 * own**2 / spread
    friction = value["friction energy"]
    closed = force["force y"] > 1e-9 * force["force y"].max()
    ratio = np.abs(force["force x"][closed]) / force["force y"][closed]
    gaps = [f.C[mesh.nodes_of("outer"), 2].min() for f in frames[1:] if f.C is not None]
    return Budget(
        before=np.array([*(mass * velocity), turn]),
        after=after,
        impulse=np.array([float(f @ value["dt"]) for f in force.values()]),
        travel=travel / first,
        spin=rotary / first,
        vibration=(float(energy[-1]) - travel - rotary) / first,
        friction=float(friction[-1]) / first,
        energy_error=1.0 - float(energy[-1] + friction[-1]) / first,
        depth=max(0.0, -min(gaps)),
        contacts=int(closed[0]) + int((np.diff(closed.astype(int)) > 0).sum()),
        ratio=float(ratio.max(initial=0.0)),
        history={
            "time": np.array([f.time for f in frames[1:]]),
            "energy": energy / first,
            "friction": friction / first,
            **{n: value[n] for n in names},
            **force,
        },
    )


def say(line: str) -> str:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()
    return line


def named(scheme: str) -> str:
    """A scheme in words, which may be broken in a narrow column."""
    return {"energy_momentum": "energy-momentum"}.get(scheme, scheme.replace("_", " "))


def schemes(cells: int) -> list[str]:
    """Table of schemes on the elastic bar."""
    lines = [
        f"Elastic bar, {cells} `Q4I`; figures relative to the exact value, except for contacts "
        "and iterations.",
        "",
        "| scheme | mass | contacts | duration | rebound | energy | largest force | iterations |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for line in lines:
        say(line)
    for scheme in SCHEMES:
        for redistribute in (True, False):
            hit = strike("Q4I", scheme, cells=cells, redistribute=redistribute)
            lines.append(
                say(
                    f"| {named(scheme)} | {'redistributed' if redistribute else 'kept'} "
                    f"| {hit.contacts} "
                    f"| {hit.duration:.4f} | {hit.rebound:.4f} | {hit.energy:.4f} "
                    f"| {hit.force:.2f} | {hit.iterations:.2f} |"
                )
            )
    return lines


#: Elastic rings: friction, velocity along the wall.
RINGS = {"straight": (0.0, 0.0), "oblique, friction 0.3": (0.3, 1.0)}


def budgets(around: int) -> tuple[list[str], dict[str, Budget]]:
    """Table of momenta and energies of the elastic ring with each scheme, and the figures."""
    lines = [
        f"Elastic ring, {around} x 2 `Q4I`, speed 1 towards the wall, 400 fixed increments of "
        "1/500; momenta relative to the initial momentum normal to the wall, energies to the "
        "initial energy.",
        "",
        "| hit | scheme | mass | normal momentum | tangential | gain less impulse "
        "| angular gain | less moment | travel | spin | vibration | friction | lost | contacts "
        "| largest force |",
        "| " + " | ".join(["---"] * 15) + " |",
    ]
    for line in lines:
        say(line)
    found = {}
    for hit, (friction, along) in RINGS.items():
        for scheme in ("hht", "generalized_alpha", "energy_momentum"):
            for redistribute in (True, False):
                b = budget(
                    run_ring(
                        "Q4I",
                        around,
                        speed=1.0,
                        sideways=along,
                        friction=friction,
                        scheme=scheme,
                        redistribute=redistribute,
                        increments=400,
                        period=0.8,
                    )
                )
                found[f"{hit} {scheme} {redistribute}"] = b
                size = abs(b.before[1])
                gained, rest = b.after - b.before, (b.after - b.before - b.impulse) / size
                lines.append(
                    say(
                        f"| {hit} | {named(scheme)} "
                        f"| {'redistributed' if redistribute else 'kept'} "
                        f"| {b.before[1] / size:+.3f} to {b.after[1] / size:+.4f} "
                        f"| {b.before[0] / size:.3f} to {abs(b.after[0]) / size:.4f} "
                        f"| {abs(rest[:2]).max():.0e} | {abs(gained[2]) / size:.4f} "
                        f"| {abs(rest[2]):.0e} | {b.travel:.4f} | {b.spin:.4f}"
                        f" | {b.vibration:.4f} | {b.friction:.4f} | {b.energy_error:+.4f} "
                        f"| {b.contacts} "
                        f"| {b.history['force y'].max() / size:.1f} |"
                    )
                )
    return lines, found


def compare(found: dict[str, Budget], path: Path) -> None:
    """Force and energy over time of the straight hit: schemes, mass kept or not."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    chosen = [k for k in found if k.startswith("straight")]
    figure, axes = plt.subplots(2, 3, figsize=(10.0, 4.8), sharex=True, layout="constrained")
    for key in chosen:
        _, scheme, redistributed = key.split()
        kept = redistributed == "False"
        history = found[key].history
        column = ["hht", "generalized_alpha", "energy_momentum"].index(scheme)
        style = {"color": "#cc6677" if kept else "#4477aa", "linewidth": 0.9, "zorder": 1 - kept}
        label = "mass kept" if kept else "mass redistributed"
        axes[0, column].plot(history["time"], history["force y"], label=label, **style)
        axes[1, column].plot(history["time"], history["energy"], label=label, **style)
        axes[0, column].set(title=scheme.replace("_", " "), ylim=(0, 31))
        axes[1, column].set(xlabel="time", ylim=(0.86, 1.04))
    axes[0, 0].set(ylabel="contact force", xlim=(0, 0.8))
    axes[1, 0].set(ylabel="energy / initial energy")
    axes[1, 2].legend(frameon=False, loc="lower left")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def yielding(around: int, cells: int) -> tuple[list[str], dict[str, Flight]]:
    """Table of the rings and bars that yield, and the flights of the rings."""
    lines = [
        f"Energies relative to the initial energy. Ring: {around} x 2 elements; bar: {cells} x 4.",
        "",
        "| body | element | speed | rebound | kinetic | strain | plastic | balance error | "
        "momentum along wall | shape | increments | iterations | CPU s |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for line in lines:
        say(line)
    flights = {}
    for body in ("ring", "bar"):
        for speed in (0.5, 1.0):
            for element in ELEMENTS:
                begin = time.process_time()
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    if body == "ring":
                        f = fly(
                            element,
                            plastic=True,
                            speed=speed,
                            around=around,
                            increments=0,
                            scheme="energy_momentum",
                            tolerance=2e-4,
                        )
                        flights[f"{element} {speed}"] = f
                    else:
                        f = fly(
                            element,
                            plastic=True,
                            speed=2.0 * speed,
                            around=cells,
                            through=4,
                            body="bar",
                            increments=0,
                            period=0.4,
                            tolerance=2e-3,
                        )
                assert f.results is not None
                lines.append(
                    say(
                        f"| {body} | {element} | {speed if body == 'ring' else 2 * speed:g} "
                        f"| {f.rebound:.4f} | {f.kinetic:.4f} "
                        f"| {f.strain:.4f} | {f.plastic:.4f} | {f.energy_error:.2%} "
                        f"| {f.sideways:.0e} "
                        f"| {f.squash:+.4f} | {len(f.results.frames) - 1} | {f.iterations:.1f} "
                        f"| {time.process_time() - begin:.1f} |"
                    )
                )
    return lines, flights


def picture(flight: Flight, path: Path) -> None:
    """Energies and force over time of one flight."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    history = flight.history
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.2), layout="constrained")
    t = history["time"]
    left.stackplot(
        t,
        history["kinetic"],
        history["strain"],
        history["plastic"],
        labels=["kinetic", "elastic", "plastic"],
        colors=["#4477aa", "#ccbb44", "#cc6677"],
    )
    left.set(xlabel="time", ylabel="energy / initial energy", xlim=(0, t[-1]), ylim=(0, 1.1))
    left.axhline(1.0, color="black", linewidth=0.8)
    left.legend(loc="lower left", frameon=True)
    right.plot(t, history["force"], color="#333333", linewidth=0.9)
    right.set(xlabel="time", ylabel="contact force", xlim=(0, t[-1]))
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser models")
    parser.add_argument("--write", action="store_true", help="write docs/measured.md")
    args = parser.parse_args()
    begin = time.perf_counter()
    lines = schemes(50 if args.quick else 200)
    table, found = budgets(32 if args.quick else 48)
    lines += ["", *table]
    table, flights = yielding(32 if args.quick else 48, 20 if args.quick else 40)
    lines += ["", *table]
    if args.write:
        command = f"`python -m benchmarks impact_table --write`, {machine()}"
        write_between(PAGE, "impact tables", "\n".join([command, "", *lines]))
        picture(flights["Q4D 1.0"], PICTURE)
        compare(found, SCHEME_PICTURE)
    say(f"{time.perf_counter() - begin:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())

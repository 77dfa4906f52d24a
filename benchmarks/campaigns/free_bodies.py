"""Small random decks: no exit code 0 without an equilibrium, no refusal without a reason.

    python -m benchmarks free_bodies --count 2000 --seed 1 [--check] [--keep FOLDER]

Each deck runs through the command line in this process. Equilibrium is computed again from the
results that were written: the sums of forces and moments of reactions and loads, and what is left
at nodes that nothing holds, against the size of all that acts. Who is held is known by construction
(:mod:`free_body_decks`). With ``--check``, ``corota check`` judges the same decks.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import contextlib
import io
import re
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.corpora.free_body_decks import Deck, make
from corota.cli import main as corota

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: Forces that do not balance, of all that acts.
BALANCE = 1e-6
#: A displacement beyond so many sizes of the model is none of a body that is held.
SENSE = 100.0
#: Rounding errors of the stiffness times the size of the model that count as a force, where nothing
#: else acts: a body that turns with its supports has no forces but these.
NEGLIGIBLE = 1e4 * float(np.finfo(float).eps)
#: Elements with rotations.
DRILLING = ("OPT", "Q4D")
#: Words of which a refusal holds one: a motion, or a reason.
REASON = re.compile(
    r"can move|can turn|unconstrained|stopped at|limit point|collapse|moves by|"
    r"inverted|used its|no path|free motion|move freely"
)


@dataclass
class Outcome:
    """How a deck ended.

    Parameters
    ----------
    code : int
        Exit code.
    message : str
        Of the standard error.
    faults : list of str
        What is wrong with it.
    """

    code: int
    message: str
    faults: list[str] = field(default_factory=list)


def call(arguments: list[str]) -> tuple[int, str]:
    """Exit code and messages of the program."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        code = corota(arguments)
    return code, said.getvalue().strip()


def run(deck: Deck, folder: Path) -> Outcome:
    """Run a deck and judge how it ended."""
    path = folder / "job.inp"
    path.write_text(deck.text)
    code, message = call(
        ["run", str(path), "--output", str(folder), "--quiet", "--format", "npz", "--threads", "1"]
    )
    outcome, data = Outcome(code, message), {}
    if code == 0:
        with np.load(folder / "job.npz") as written:
            data = {name: written[name] for name in written.files}
        outcome.faults = wrong(deck, data)
    elif code not in (3, 4):
        outcome.faults = [f"exit code {code}"]
    elif not REASON.search(message):
        outcome.faults = ["a refusal without a reason"]
    still = not deck.features["dynamic"]
    if still and deck.held and code == 3:
        outcome.faults.append("refused although it is held")
    # What rests without forces may rest.
    moved = code != 0 or np.abs(data["U"]).max() > 0.0
    if still and deck.held is False and code != 3 and moved:
        outcome.faults.append(f"exit code {code} although it is free")
    return outcome


def wrong(deck: Deck, data: dict[str, Floats]) -> list[str]:
    """What is wrong with the results of a run that ended well."""
    names = ("U", "UR", "RF", "F")
    found = [f"{name} has no number" for name in names if not np.isfinite(data[name]).all()]
    if found:
        return found
    points, size = data["X"], float(np.ptp(data["X"], axis=0).max())
    if float(data["residual"].max()) > BALANCE:
        found.append("a recorded residual above 1e-6")
    if deck.features["dynamic"]:
        return found
    if np.abs(data["U"]).max() > SENSE * (size + deck.driven):
        found.append("a displacement beyond sense")
    row = {int(n): k for k, n in enumerate(data["node_labels"])}
    now = points + (data["U"][-1] if deck.features["nlgeom"] else 0.0)
    reaction = data["RF"][-1]
    force = np.zeros_like(now)
    for label, x, y in deck.forces:
        force[row[label]] += x, y
    turned = sum((m for _, m in deck.moments), 0.0)
    acting = [np.abs(force).sum(), abs(turned) / size]
    total, moment = force.sum(axis=0), turned + _moments(now, force)
    for first, second, p in deck.pressures:
        a, b = now[row[first]], now[row[second]]
        total += p * deck.thickness * np.array([a[1] - b[1], b[0] - a[0]])
        moment += 0.5 * p * deck.thickness * float(b @ b - a @ a)
        acting.append(abs(p) * deck.thickness * float(np.hypot(*(b - a))))
    if deck.features.get("gravity") and any(b.kind in DRILLING for b in deck.bodies):
        # Rotations of the nodes move the mass within an element: where, only the program says.
        written = data["F"][-1]
        moment = _moments(now, written[:, :2]) + float(written[:, 2].sum())
    total += reaction[:, :2].sum(axis=0)
    moment += _moments(now, reaction[:, :2]) + float(reaction[:, 2].sum())
    held = np.zeros(reaction.shape, bool)
    for label, dof in deck.supports:
        held[row[label], dof] = True
    nothing = NEGLIGIBLE * deck.modulus * deck.thickness * size
    whole = max(*acting, np.abs(reaction[held]).sum(), nothing / BALANCE)
    reach = max(size, float(np.ptp(now, axis=0).max()), float(np.abs(now).max()))
    twist = 0.0 if deck.couples else abs(moment) / (whole * reach)
    deck.features["balance"] = max(np.abs(total).max() / whole, twist)
    if np.abs(total).max() > BALANCE * whole:
        found.append("forces out of balance")
    if twist > BALANCE:
        found.append("moments out of balance")
    joined = deck.features["link"] != "none"
    inside = [row[int(n)] for b in deck.bodies for n in b.labels if n not in deck.passive]
    left = np.where(held, 0.0, np.abs(reaction))[inside][:, :2].max(initial=0.0)
    deck.features["left"] = left / whole
    if left > BALANCE * whole:
        found.append("forces left at nodes that nothing holds" + " (joined)" * joined)
    return found


def _moments(points: Floats, force: Floats) -> float:
    return float((points[:, 0] * force[:, 1] - points[:, 1] * force[:, 0]).sum())


def same_verdict(deck: Deck, folder: Path, code: int) -> str:
    """How ``corota check`` and ``corota run`` disagree on a deck, or an empty text."""
    checked, _ = call(["check", str(folder / "job.inp"), "--quiet"])
    # A run that was started and stopped has the code 4.
    started = code in (0, 4)
    return "" if (checked == 0) == started else f"check {checked}, run {code}"


def campaign(count: int, seed: int, check: bool, keep: Path | None) -> int:
    """Run decks and print a table; the number of decks with a fault."""
    codes: Counter[tuple[str, str, int]] = Counter()
    faults: Counter[str] = Counter()
    begin, bad, worst, left = time.perf_counter(), 0, 0.0, 0.0
    for number in range(count):
        deck = make(f"{seed}:{number}")
        with tempfile.TemporaryDirectory() as name:
            outcome = run(deck, Path(name))
            if check and (differs := same_verdict(deck, Path(name), outcome.code)):
                outcome.faults.append(differs)
        held = {True: "held", False: "free", None: "contact"}[deck.held]
        codes[deck.features["link"], held, outcome.code] += 1
        worst = max(worst, deck.features.get("balance", 0.0))
        left = max(left, deck.features.get("left", 0.0))
        bad += bool(outcome.faults)
        for fault in outcome.faults:
            faults[fault] += 1
        if outcome.faults:
            print(f"{seed}:{number} {outcome.code} {'; '.join(outcome.faults)}", flush=True)
            print(f"    {deck.features}")
            print(f"    {outcome.message[:300]}", flush=True)
            if keep is not None:
                keep.mkdir(parents=True, exist_ok=True)
                (keep / f"{seed}_{number}.inp").write_text(deck.text)
    print(f"\n{'joined by':<12}{'known':<10}" + "".join(f"{f'exit {c}':>9}" for c in (0, 3, 4)))
    for link, held in sorted({key[:2] for key in codes}):
        row = [codes[link, held, code] for code in (0, 3, 4)]
        print(f"{link:<12}{held:<10}" + "".join(f"{n:>9}" for n in row))
    print(f"\n{count} decks, {bad} with a fault, {time.perf_counter() - begin:.0f} s")
    print(f"largest imbalance {worst:.1e}, largest force left {left:.1e} of all that acts")
    for fault, times in faults.most_common():
        print(f"  {times:>5}  {fault}")
    return bad


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--check", action="store_true", help="compare with `corota check`")
    parser.add_argument("--keep", type=Path, help="folder for decks with a fault")
    args = parser.parse_args()
    return min(campaign(args.count, args.seed, args.check, args.keep), 63)


if __name__ == "__main__":
    sys.exit(main())

"""Feed mutated decks to the reader: no crash, no hang, no traceback, no silent success.

    python benchmarks/campaigns/fuzz_decks.py [count] [seed]

A deck is either refused with a list of faults, or it gives a model. A model counts as a silent
success if its numbers are not finite, its sets or cells point nowhere, a cell has no section, or
if it does not survive being written to a deck and read again.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import corota as ct
from corota.check import check
from corota.io.formats import write

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "io"))
from mutate import mutate  # noqa: E402
from seeds import SEEDS  # noqa: E402

#: Seconds of the processor after which one deck counts as a hang. Its check tries an increment:
#: the slowest deck of the tests needs 8 s, and twice that where others use the processor.
LIMIT = 60.0


def sound(model: ct.Model, path: Path) -> str:
    """Why a model that was accepted should not have been, or an empty text."""
    mesh = model.mesh
    if not np.isfinite(mesh.points).all() or mesh.n_cells == 0:
        return "a mesh without cells or with numbers that are not finite"
    if len(set(mesh.node_labels.tolist())) != mesh.n_nodes:
        return "node numbers occur twice"
    for cells in mesh.cells:
        if cells.nodes.min() < 0 or cells.nodes.max() >= mesh.n_nodes:
            return "cells refer to missing nodes"
    for table in (mesh.node_sets, mesh.cell_sets):
        for values in table.values():
            if len(values) and values.min() < 0:
                return "sets with members that are not there"
    for support in model.supports + [s for step in model.steps for s in step.supports]:
        if not np.isfinite(support.value):
            return "a support that is not finite"
    if model.steps or model.sections:
        names = [str(d) for d in check(model) if "section" in d.message and d.severity == "error"]
        if names:
            return names[0]
    return survives(model, path)


def survives(model: ct.Model, path: Path) -> str:
    """Why a model does not come back from a deck, or an empty text."""
    try:
        again = ct.read(write(model, path))
    except ct.UnsupportedError:
        # A deck of ours cannot hold it, and says so.
        return ""
    for what, one, two in (
        ("points", model.mesh.points, again.mesh.points),
        ("node numbers", model.mesh.node_labels, again.mesh.node_labels),
        ("element numbers", model.mesh.cell_labels, again.mesh.cell_labels),
    ):
        if not np.array_equal(one, two):
            return f"{what} do not come back"
    counts = [
        [(len(s.loads), len(s.outputs), s.nlgeom, s.period) for s in m.steps]
        for m in (model, again)
    ]
    return "" if counts[0] == counts[1] else f"steps come back as {counts[1]}, not {counts[0]}"


def hang(*_: object) -> None:
    """Stop an input that takes too long."""
    raise TimeoutError(f"more than {LIMIT:g} s")


def run(count: int, seed: int) -> Counter[str]:
    """Outcomes by name; ends with an error at the first failure."""
    rng = random.Random(seed)
    outcomes: Counter[str] = Counter()
    signal.signal(signal.SIGPROF, hang)
    slowest = 0.0
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        # Notes on a deck beside its model are no failure.
        warnings.filterwarnings("ignore", message=".*: warning: ")
        path = Path(folder) / "deck.inp"
        for number in range(count):
            raw = mutate(rng.choice(SEEDS), rng)
            path.write_bytes(raw)
            start = time.process_time()
            signal.setitimer(signal.ITIMER_PROF, LIMIT)
            try:
                model = ct.read(path)
                reason = sound(model, path.with_name("again.inp"))
                outcome = f"silent: {reason}" if reason else "accepted"
            except ct.DeckError as error:
                outcome = "refused"
                if not error.diagnostics or len(str(error)) > 1_000_000:
                    outcome = f"empty or endless message of deck {number}"
            except Exception as error:  # whatever it is, it is a finding
                outcome = f"{type(error).__name__}: {error}"
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            seconds = time.process_time() - start
            slowest = max(slowest, seconds)
            if outcome not in ("refused", "accepted") or seconds > LIMIT:
                Path("failed.inp").write_bytes(raw)
                raise SystemExit(f"deck {number} of seed {seed}: {outcome} ({seconds:.1f} s)")
            outcomes[outcome] += 1
    print(f"{count} decks: {dict(outcomes)}; slowest {slowest:.2f} s")
    return outcomes


if __name__ == "__main__":
    arguments = [int(a) for a in sys.argv[1:]]
    run(arguments[0] if arguments else 5000, arguments[1] if len(arguments) > 1 else 1)

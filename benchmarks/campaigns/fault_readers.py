"""Random decks and meshes through the readers, many in one process."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random
import signal
import sys
import time
import warnings
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.campaigns.fuzz_decks import LIMIT, hang, sound

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "io"))
import grammar  # noqa: E402
import mesh_seeds  # noqa: E402
import mutate  # noqa: E402
from seeds import SEEDS  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Characters that a message may have.
LONGEST = 1_000_000


def spliced(rng: random.Random) -> bytes:
    """Bytes of two decks, joined and then damaged."""
    one, two = (rng.choice(SEEDS).encode() for _ in range(2))
    raw = one[: rng.randrange(len(one))] + two[rng.randrange(len(two)) :]
    for _ in range(rng.randint(0, 3)):
        raw = mutate.mutate_bytes(raw, rng)
    return raw


#: Name, share, ending of the file, and what makes an input.
SOURCES = (
    ("mutated decks", 0.4, ".inp", lambda rng: mutate.mutate(rng.choice(SEEDS), rng)),
    ("decks of the grammar", 0.25, ".inp", grammar.deck),
    ("spliced bytes", 0.1, ".inp", spliced),
    (
        "mutated meshes",
        0.25,
        ".msh",
        lambda rng: mesh_seeds.mutate(rng.choice(mesh_seeds.SEEDS), rng),
    ),
)


def inputs(count: int, seed: int) -> Iterator[tuple[str, str, bytes]]:
    """Source, ending and bytes of `count` inputs; the same for the same seed."""
    rng = random.Random(seed)
    names, shares = zip(*((s, s[1]) for s in SOURCES), strict=True)
    for _ in range(count):
        name, _, ending, make = rng.choices(names, shares)[0]
        yield name, ending, make(rng)


def read_one(path: Path) -> str:
    """``accepted``, ``refused``, or what went wrong with an input."""
    try:
        model = ct.mesh.read(path) if path.suffix == ".msh" else ct.read(path)
    except Exception as error:
        return _refusal(error)
    try:
        reason = (
            sound_mesh(model)
            if isinstance(model, ct.Mesh)
            else sound(model, path.with_name("again.inp"))
        )
    except ct.CorotaError as error:
        return f"failure: does not come back: {str(error).splitlines()[0][:60]}"
    except Exception as error:
        return _refusal(error)
    return f"silent: {reason}" if reason else "accepted"


def _refusal(error: Exception) -> str:
    """What an exception means; only messages on purpose are refusals."""
    if isinstance(error, ct.CorotaError):
        if not str(error).strip() or len(str(error)) > LONGEST:
            return "failure: an empty or endless message"
        if error.exit_code not in (2, 3, 6):
            return f"failure: exit code {error.exit_code}"
        return "refused"
    if isinstance(error, TimeoutError):
        return "hang"
    at = error.__traceback__
    while at is not None and at.tb_next is not None:
        at = at.tb_next
    place = f"{Path(at.tb_frame.f_code.co_filename).name}:{at.tb_lineno}" if at else ""
    return f"traceback: {type(error).__name__} at {place}"


def sound_mesh(mesh: ct.Mesh) -> str:
    """Why a mesh that was accepted should not have been, or an empty text."""
    if mesh.n_cells == 0 or not np.isfinite(mesh.points).all():
        return "a mesh without cells or with numbers that are not finite"
    for cells in mesh.cells:
        if cells.nodes.min() < 0 or cells.nodes.max() >= mesh.n_nodes:
            return "cells refer to missing nodes"
    for table, size in ((mesh.node_sets, mesh.n_nodes), (mesh.cell_sets, mesh.n_cells)):
        for values in table.values():
            if len(values) and (values.min() < 0 or values.max() >= size):
                return "sets with members that are not there"
    return ""


def run(count: int, seed: int, folder: Path, finds: Path) -> Counter[str]:
    """Counts of ``source: outcome``; inputs that failed are kept in `finds`."""
    outcomes: Counter[str] = Counter()
    signal.signal(signal.SIGPROF, hang)
    kept: set[str] = set()
    with warnings.catch_warnings():
        # What numpy warns of is a find; what the reader warns the user of is its work.
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)
        for number, (source, ending, raw) in enumerate(inputs(count, seed)):
            path = folder / f"deck{ending}"
            path.write_bytes(raw)
            start = time.process_time()
            signal.setitimer(signal.ITIMER_PROF, LIMIT)
            outcome = read_one(path)
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            if time.process_time() - start > LIMIT:
                outcome = "hang"
            outcomes[f"{source}: {outcome}"] += 1
            if outcome not in ("accepted", "refused") and outcome not in kept:
                kept.add(outcome)
                finds.mkdir(parents=True, exist_ok=True)
                (finds / f"{seed}-{number}{ending}").write_bytes(raw)
                (finds / f"{seed}-{number}.txt").write_text(outcome + "\n")
    return outcomes

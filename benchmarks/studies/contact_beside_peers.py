"""Problems of the torture set beside CalculiX and Kratos: who finishes, iterations, forces.

``python -m benchmarks contact_beside_peers --write`` takes the first problems of
:mod:`contact_problems` that the peers can be given
(:mod:`contact_for_peers`). All programs get the same nodes, elements, supports, loads
and the first increments, and St. Venant's law in large rotations. Kratos has no quadratic
elements in plane contact: all its problems have linear ones, in Corota too.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import shutil
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import corota as ct
from benchmarks.common import machine, table, write_between
from benchmarks.corpora.contact_for_peers import chosen, data, nodes_of, sheared, slid
from benchmarks.peers import contact_ccx, contact_kratos
from benchmarks.peers.contact_data import Outcome, mean
from benchmarks.peers.install import install
from corota.model.contact import RigidCurve

if TYPE_CHECKING:
    from benchmarks.corpora.contact_problems import Problem

#: Programs beside Corota.
PEERS: dict[str, Any] = {"ccx": contact_ccx, "Kratos": contact_kratos}
PAGE = Path(__file__).parents[2] / "docs" / "contact.md"


def by_corota(given: Problem, limit: int) -> tuple[Outcome, list[int]]:
    """Our outcome, and the increments of each step."""
    begin = time.process_time()
    why, results = "", None

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            watch = [_Limit(begin + limit)]
            results = ct.solve(given.model, given.steps, threads=1, observers=watch)
        except ct.CorotaError as error:
            results = getattr(error, "results", None)
            why = "over time" if isinstance(error, ct.Interrupted) else "stops"
    ends = np.cumsum([0.0, *(step.period for step in given.steps)])
    period = float(ends[-1])
    frames = results.frames[1:] if results else []
    force = mean([(frame.time, _force(given.model, frame)) for frame in frames], period)
    share = results.times[-1] / period if results and len(results.times) else 0.0
    end = "yes" if not why else f"{why}, {share:.0%}"
    count = int(results.info.get("iterations", 0)) if results else 0
    near = 1e-9 * period
    used = [
        sum(1 for frame in frames if first + near < frame.time < last + near)
        for first, last in zip(ends[:-1], ends[1:], strict=True)
    ]
    return Outcome(end, count, force), used


class _Limit(ct.BaseObserver):
    """Stops a run that takes too long."""

    def __init__(self, end: float) -> None:
        self.last = end

    @property
    def stop(self) -> bool:
        """Whether time is up."""
        return time.process_time() > self.last


def _force(model: ct.Model, frame: Any) -> float:
    """The force whose mean is compared."""
    for pair in model.contacts:
        if isinstance(pair.master, RigidCurve):
            name = pair.name
            return math.hypot(frame.scalars[f"{name}: force x"], frame.scalars[f"{name}: force y"])
    nodes = nodes_of(model, model.supports[0].nodes)
    return math.hypot(*frame.RF[nodes][:, :2].sum(axis=0))


def compare(peer: str, count: int, size: float, limit: int, jobs: int) -> str:
    """The table of Corota beside a peer.

    Parameters
    ----------
    peer : str
        A key of :data:`PEERS`.
    count : int
    size : float
        Factor on numbers of elements.
    limit : int
        Longest processor time of a run [s].
    jobs : int
        Problems at a time, in processes of their own.
    """
    kinds = PEERS[peer].KINDS.values()
    head = ["problem", "element, friction", "Corota", "iterations", "force"]
    for kind in kinds:
        head += [f"{peer}, {kind}", "iterations", "force"]
    rows = []
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
        work = [(peer, place, size, limit) for place in range(count)]
        for cells in pool.map(_row, *zip(*work, strict=True)):
            rows.append(cells)
            sys.stdout.write(" | ".join(cells) + "\n")
            sys.stdout.flush()
    last = ["finished", *[""] * (len(head) - 1)]
    for column in range(2, len(head), 3):
        last[column] = str(sum(cells[column] == "yes" for cells in rows))
    return table(head, [*rows, last])


def _row(peer: str, place: int, size: float, limit: int) -> list[str]:
    given = chosen(place + 1, size, linear=peer == "Kratos")[-1]
    own, used = by_corota(given, limit)
    element = given.model.sections[0].element
    mu = given.model.contacts[0].friction
    cells = [given.name, f"{element}, {mu:g}", own.end, str(own.iterations), f"{own.force:.4g}"]
    for kind in PEERS[peer].KINDS:
        other = PEERS[peer].run(data(given), kind, used, limit)
        away = ""
        if other.end == own.end == "yes" and own.force:
            away = _percent(other.force / own.force - 1.0)
        cells += [other.end, str(other.iterations), away]
    return cells


def checks(limit: int) -> None:
    """Print the reactions of a sheared block, and of one that slides, in Corota and Kratos."""
    given = sheared()
    own = ct.solve(given.model, given.steps, threads=1)
    watched = nodes_of(given.model, "bottom")
    sys.stdout.write(f"sheared, Corota: {own.frames[-1].RF[watched][:, :2].sum(axis=0)}\n")
    rows = contact_kratos.call(data(given), "ALM", [2], limit)[1]
    sys.stdout.write(f"sheared, Kratos: {rows[-1]['force']}\n")
    given = slid()
    own = ct.solve(given.model, given.steps, threads=1)
    watched = nodes_of(given.model, "low.bottom")
    sys.stdout.write(f"slid, Corota: {own.frames[-1].RF[watched][:, :2].sum(axis=0)}\n")
    for count in (10, 40, 500):
        row = contact_kratos.call(data(given), "ALM", [10, count], limit)[1][-1]
        sys.stdout.write(f"slid, Kratos in {count}: {row}\n")


def _percent(part: float) -> str:
    return f"{100.0 * part:+.1f} %" if abs(part) < 1e3 else f"times {part:.0e}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--peers", nargs="+", choices=list(PEERS), default=list(PEERS))
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--size", type=float, default=0.5, help="factor on numbers of elements")
    parser.add_argument("--limit", type=int, default=30, help="CPU seconds of a run")
    parser.add_argument("--jobs", type=int, default=1, help="problems at a time")
    parser.add_argument("--deck", type=int, help="print the deck of one, by its place")
    parser.add_argument("--check", action="store_true", help="run two blocks in Corota and Kratos")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/contact.md")
    args = parser.parse_args()
    if args.deck is not None:
        given = chosen(args.deck + 1, args.size)[-1]
        sys.stdout.write(contact_ccx.deck(data(given), "SURFACE TO SURFACE"))
        return 0
    for peer in args.peers:
        if not (shutil.which("ccx") if peer == "ccx" else install(peer)):
            sys.stderr.write(f"{peer} is not installed\n")
            return 2
    if args.check:
        checks(args.limit)
        return 0
    for peer in args.peers:
        text = compare(peer, args.count, args.size, args.limit, args.jobs)
        said = f"`python -m benchmarks contact_beside_peers --peers {peer} --write`, {machine()}"
        text = f"{said}\n\n{text}"
        if args.write:
            write_between(PAGE, peer.lower(), text)
        else:
            sys.stdout.write(f"\n{text}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())

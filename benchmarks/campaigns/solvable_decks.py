"""Valid decks changed within physical ranges, so that they reach the solver, and what came of it.

    python -m benchmarks solvable_decks [--count 2000] [--seed 1] [--keep DIR] [--fresh]

Changed are numbers (stiffness, yield stress, density, loads, displacements, coordinates, periods,
increments), steps (repeated, left out, exchanged), options (NLGEOM, PERTURBATION apart, element
types, hardening, friction, amplitudes) and the order of cards, nodes and elements; never bytes.
Each deck runs by ``corota run`` in a forked process. Decks that no iteration was made of do not
count. Behind exit 0 no number may be missing or not finite, no recorded residual may be above its
tolerance, nodes that nothing holds may have no reaction, reactions and loads must balance, and an
energy balance beyond 2 % must be reported. Counts are kept in ``build/solvable_decks.json``, from
where a campaign that was ended goes on.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import shutil
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.campaigns.fault_runs import command, forked, judged, warm_up
from benchmarks.common import machine, table
from benchmarks.corpora.restart_cases import DECKS
from corota.analysis.energies import LARGE_ERROR

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.model.model import Model
    from corota.results.frame import Frame
    from corota.results.results import Results

ROOT = Path(__file__).resolve().parents[2]
STORE = ROOT / "build" / "solvable_decks.json"
#: Seconds of the processor that a run may take.
LIMIT = 40
#: Residual, reaction of free nodes and sum of forces over what acts.
SMALL = 1e-6
#: Forces below this share of stiffness times size are rounding errors.
NEGLIGIBLE = 1e-11

# -- the decks -------------------------------------------------------------------------------

Card = tuple[str, list[str]]


def seeds() -> list[str]:
    """Valid decks: those of the restart campaign and of the documentation."""
    found = [build() for build in DECKS.values()]
    for path in sorted((ROOT / "docs" / "decks").glob("*.inp")):
        if "*INCLUDE" not in (text := path.read_text()).upper():
            found.append(text)
    return found


def cards_of(deck: str) -> list[Card]:
    """Keyword lines with their data lines; comments are left out."""
    cards: list[Card] = []
    for line in deck.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            cards.append((line, []))
        elif cards:
            cards[-1][1].append(line)
    return cards


def text_of(cards: list[Card]) -> str:
    """The deck again."""
    return "\n".join("\n".join([head, *lines]) for head, lines in cards) + "\n"


def keyword(card: Card) -> str:
    """Name of a card, such as ``*ELASTIC``."""
    return card[0].partition(",")[0].strip().upper()


def of(cards: list[Card], *names: str) -> list[int]:
    """Places of cards with these names."""
    return [k for k, card in enumerate(cards) if keyword(card) in names]


def _scaled(fields: list[str], which: slice, factor: float) -> list[str]:
    found = list(fields)
    for k in range(*which.indices(len(found))):
        if re.fullmatch(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*", found[k]):
            found[k] = f" {float(found[k]) * factor:.9g}"
    return found


def _scale(card: Card, which: slice, factor: float, rows: slice = slice(None)) -> None:
    lines = card[1]
    for k in range(*rows.indices(len(lines))):
        lines[k] = ",".join(_scaled(lines[k].split(","), which, factor))


def _log(rng: random.Random, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def stiffness(cards: list[Card], rng: random.Random) -> None:
    """Moduli by a factor, Poisson's ratio anew."""
    for k in of(cards, "*ELASTIC"):
        head, lines = cards[k]
        if "TYPE" in head.upper():
            _scale(cards[k], slice(0, 3), _log(rng, 0.3, 3.0), slice(0, 1))
        else:
            for i, line in enumerate(lines):
                fields = line.split(",")
                fields[0] = f"{float(fields[0]) * _log(rng, 0.1, 10.0):.9g}"
                fields[1] = f" {rng.uniform(0.0, 0.49):.4f}"
                lines[i] = ",".join(fields)


def strength(cards: list[Card], rng: random.Random) -> None:
    """Yield stresses by a factor."""
    factor = _log(rng, 0.3, 5.0)
    for k in of(cards, "*PLASTIC", "*CYCLIC HARDENING"):
        _scale(cards[k], slice(0, 1), factor)


def density(cards: list[Card], rng: random.Random) -> None:
    """Densities by a factor."""
    for k in of(cards, "*DENSITY"):
        _scale(cards[k], slice(0, 1), _log(rng, 0.1, 10.0))


def loads(cards: list[Card], rng: random.Random) -> None:
    """One card of loads by a factor, sometimes reversed."""
    places = of(cards, "*CLOAD", "*DLOAD", "*DSLOAD", "*TEMPERATURE")
    if places:
        sign = rng.choice((1.0, 1.0, -1.0))
        _scale(cards[rng.choice(places)], slice(2, 3), sign * _log(rng, 0.05, 4.0))


def driven(cards: list[Card], rng: random.Random) -> None:
    """Prescribed displacements by a factor."""
    factor = rng.choice((1.0, -1.0)) * _log(rng, 0.1, 2.0)
    for k in of(cards, "*BOUNDARY"):
        _scale(cards[k], slice(3, 4), factor)


def coordinates(cards: list[Card], rng: random.Random) -> None:
    """All coordinates by two factors, and each moved a little."""
    fx, fy = _log(rng, 0.7, 1.5), _log(rng, 0.7, 1.5)
    little = rng.choice((0.0, 0.0, 0.02))
    for k in of(cards, "*NODE"):
        lines = cards[k][1]
        for i, line in enumerate(lines):
            f = line.split(",")
            try:
                x, y = float(f[1]) * fx, float(f[2]) * fy
            except (ValueError, IndexError):
                continue
            x, y = (v + little * rng.uniform(-1.0, 1.0) for v in (x, y))
            lines[i] = ",".join([f[0], f" {x:.9g}", f" {y:.9g}", *f[3:]])


def thickness(cards: list[Card], rng: random.Random) -> None:
    """Thicknesses of solid sections."""
    for k in of(cards, "*SOLID SECTION"):
        if cards[k][1]:
            _scale(cards[k], slice(0, 1), _log(rng, 0.2, 5.0))


def increments(cards: list[Card], rng: random.Random) -> None:
    """First, smallest or largest increment, or the whole period."""
    places = of(cards, "*STATIC", "*DYNAMIC")
    if not places:
        return
    card = cards[rng.choice(places)]
    if card[1]:
        which = rng.choice((slice(0, 1), slice(0, 1), slice(1, 2), slice(3, 4)))
        _scale(card, which, _log(rng, 0.4, 3.0), slice(0, 1))


def geometry(cards: list[Card], rng: random.Random) -> None:
    """NLGEOM of a step on or off."""
    k = rng.choice(of(cards, "*STEP") or [0])
    head = cards[k][0]
    if "NLGEOM" in head.upper():
        head = re.sub(r",\s*NLGEOM(=\w+)?", "", head, flags=re.IGNORECASE)
    elif "PERTURBATION" not in head.upper():
        head += ", NLGEOM"
    cards[k] = (head, cards[k][1])


QUADS = ("CPS4", "CPS4I", "CPE4", "CPE4I", "CPS4R", "CPE4R", "Q4D", "Q4DI", "CPE4H")


def elements(cards: list[Card], rng: random.Random) -> None:
    """Another type of quadrilateral in all cards."""
    new = rng.choice(QUADS)
    for k in of(cards, "*ELEMENT"):
        head = re.sub(r"(TYPE\s*=\s*)(CPS4I?|CPE4I?)(?=\s*(,|$))", rf"\g<1>{new}", cards[k][0])
        cards[k] = (head, cards[k][1])


def friction(cards: list[Card], rng: random.Random) -> None:
    """Coefficients of friction."""
    for k in of(cards, "*FRICTION"):
        cards[k] = (cards[k][0], [f"{rng.choice((0.0, 0.05, 0.3, 0.8)):g}"])


def hardening(cards: list[Card], rng: random.Random) -> None:
    """Kinematic in place of isotropic hardening, and back; or plastic flow where there is none."""
    places = of(cards, "*PLASTIC")
    for k in places:
        head = cards[k][0]
        if "COMBINED" not in head.upper() and len(cards[k][1]) == 2:
            head = "*PLASTIC" if "KINEMATIC" in head.upper() else "*PLASTIC, HARDENING=KINEMATIC"
            cards[k] = (head, cards[k][1])
    plain = [k for k in of(cards, "*ELASTIC") if "TYPE" not in cards[k][0].upper()]
    if not places and plain and rng.random() < 0.5:
        limit = _log(rng, 3.0, 100.0)
        cards.insert(plain[0] + 1, ("*PLASTIC", [f"{limit:.6g}, 0.", f"{2.0 * limit:.6g}, .2"]))


def amplitude(cards: list[Card], rng: random.Random) -> None:
    """A load follows a table."""
    places = [k for k in of(cards, "*CLOAD", "*DLOAD") if "AMPLITUDE" not in cards[k][0].upper()]
    first = of(cards, "*STEP")[:1]
    if not places or not first:
        return
    k = rng.choice(places)
    name = f"AMP{rng.randrange(10**6)}"
    cards[k] = (cards[k][0] + f", AMPLITUDE={name}", cards[k][1])
    times = sorted(round(rng.uniform(0.05, 0.95), 3) for _ in range(2))
    rows = [f"0., 0., {times[0]}, {rng.uniform(-1, 1):.3f}"]
    if times[1] > times[0]:
        rows.append(f"{times[1]}, {rng.uniform(-1, 1):.3f}, 1., 1.")
    else:
        rows.append("1., 1.")
    cards.insert(first[0], (f"*AMPLITUDE, NAME={name}", rows))


def _steps(cards: list[Card]) -> tuple[list[Card], list[list[Card]]]:
    head: list[Card] = []
    steps: list[list[Card]] = []
    for card in cards:
        if keyword(card) == "*STEP":
            steps.append([])
        (steps[-1] if steps else head).append(card)
    return head, steps


def steps(cards: list[Card], rng: random.Random) -> None:
    """A step twice, one less, or two exchanged."""
    head, found = _steps(cards)
    if not found:
        return
    how = rng.choice(("twice", "less", "exchange"))
    if how == "twice" and len(found) < 5:
        k = rng.randrange(len(found))
        found.insert(rng.randint(k, len(found)), [(h, list(lines)) for h, lines in found[k]])
    elif how == "less" and len(found) > 1:
        del found[rng.randrange(len(found))]
    elif how == "exchange" and len(found) > 1:
        i, j = rng.sample(range(len(found)), 2)
        found[i], found[j] = found[j], found[i]
    cards[:] = head + [card for step in found for card in step]


def operations(cards: list[Card], rng: random.Random) -> None:
    """OP=NEW on loads of a later step."""
    _, found = _steps(cards)
    later = [c for step in found[1:] for c in step if keyword(c) in ("*CLOAD", "*DLOAD")]
    if later:
        k = cards.index(rng.choice(later))
        if "OP" not in cards[k][0].upper():
            cards[k] = (cards[k][0] + ", OP=NEW", cards[k][1])


def rows(cards: list[Card], rng: random.Random) -> None:
    """Nodes or elements in another order."""
    places = of(cards, "*NODE", "*ELEMENT")
    card = cards[rng.choice(places)]
    # An element of many nodes may go over two lines.
    if len({line.rstrip().endswith(",") for line in card[1]}) == 1:
        rng.shuffle(card[1])


def order(cards: list[Card], rng: random.Random) -> None:
    """Two cards of a step, or two sets, exchanged."""
    names = rng.choice((("*CLOAD", "*DLOAD", "*BOUNDARY", "*DSLOAD"), ("*NSET", "*ELSET")))
    starts = of(cards, "*STEP")[:1] or [len(cards)]
    places = [k for k in of(cards, *names) if (k > starts[0]) == (names[0] == "*CLOAD")]
    if len(places) > 1:
        i, j = rng.sample(places, 2)
        ends = of(cards, "*END STEP")
        if sum(e < i for e in ends) == sum(e < j for e in ends):
            cards[i], cards[j] = cards[j], cards[i]


def damping(cards: list[Card], rng: random.Random) -> None:
    """Damping per mass and stiffness."""
    if not of(cards, "*DAMPING"):
        for k in of(cards, "*DENSITY")[:1]:
            text = f"*DAMPING, ALPHA={rng.uniform(0, 0.5):.3f}, BETA={rng.uniform(0, 0.02):.4f}"
            cards.insert(k + 1, (text, []))


MUTATIONS: tuple[Callable[[list[Card], random.Random], None], ...] = (
    stiffness, strength, density, loads, loads, driven, driven, coordinates, thickness, increments,
    increments, geometry, elements, friction, hardening, amplitude, steps, steps, operations, rows,
    order, damping,
)  # fmt: skip


def mutant(number: int, seed: int, known: list[str]) -> str:
    """A changed deck; always the same for the same number and seed."""
    rng = random.Random(f"{seed} {number}")
    cards = cards_of(rng.choice(known))
    for _ in range(rng.choice((1, 2, 2, 3, 4))):
        rng.choice(MUTATIONS)(cards, rng)
    return text_of(cards)


# -- what became of them ---------------------------------------------------------------------


def beyond_limits(folder: Path) -> str:
    """Why results behind exit 0 should not be there, or an empty text."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = ct.read(folder / "deck.inp")
        with ct.read_results(folder / "deck.vtkhdf") as results:
            least = _negligible(model)
            return (
                _residual(results, least)
                or _energy(results, folder, least)
                or _forces(model, results, least)
            )


def _negligible(model: Model) -> float:
    """Force that is a rounding error of the stiffest part; 0 where no modulus is known."""
    size = float(np.ptp(model.mesh.points, axis=0).max())
    moduli = [getattr(s.material, "E", 0.0) * np.max(s.thickness) for s in model.sections]
    return NEGLIGIBLE * size * float(max(moduli, default=0.0))


def _residual(results: Results, least: float) -> str:
    for frame in results.frames:
        pairs = [abs(v) for name, v in frame.scalars.items() if ": force" in name]
        acting = max(np.abs(frame.F).max(), np.abs(frame.RF).max(), *pairs, 0.0)
        if frame.scalars.get("residual", 0.0) > SMALL and acting > least:
            return f"a recorded residual: {frame.scalars['residual']:.1e}"
    return ""


def _energy(results: Results, folder: Path, least: float) -> str:
    """Whether an energy balance beyond its limit is reported."""
    worst = max(abs(f.scalars.get("energy balance", 0.0)) for f in results.frames)
    largest = max(_largest(f) for f in results.frames)
    if worst <= least * float(np.ptp(results.mesh.points, axis=0).max()):
        return ""
    if worst > LARGE_ERROR * largest:
        said = (folder / "log").read_text(errors="replace")
        if "energy balance" not in said:
            return (
                f"an energy balance is off by more than 2 %, untold: {worst:.1e} of {largest:.1e}"
            )
    return ""


def _largest(frame: Frame) -> float:
    """Largest energy up to a frame, to which its balance error refers."""
    error = frame.scalars.get("energy balance error", 0.0)
    return abs(frame.scalars["energy balance"] / error) if error else 0.0


def _forces(model: Model, results: Results, least: float) -> str:
    """Whether reactions and loads of static steps balance, and free nodes have no reaction."""
    frame = results.frames[-1]
    if frame.V is not None or any(s.procedure not in ("static", "path") for s in results.steps):
        return ""
    # Forces of constraints and rigid bodies have no place in these columns.
    if model.constraints or model.ties or model.contacts:
        return ""
    held = np.zeros(frame.RF.shape, bool)
    for support in [*model.supports, *(s for step in model.steps for s in step.supports)]:
        nodes = support.nodes
        held[model.mesh.nodes_of(nodes) if isinstance(nodes, str) else nodes] = True
    acting = max(np.abs(frame.F).sum(), np.abs(frame.RF).sum())
    if acting <= least:
        return ""
    total = (frame.RF + frame.F)[:, :2].sum(axis=0)
    if np.abs(total).max() > SMALL * acting:
        return f"forces are out of balance: {np.abs(total).max() / acting:.1e}"
    left = np.abs(np.where(held, 0.0, frame.RF))[:, :2].max()
    if left > SMALL * acting:
        return f"forces are left at free nodes: {left / acting:.1e}"
    return ""


def run_one(text: str, folder: Path) -> tuple[bool, str]:
    """Whether a deck reached the solver, and its outcome."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "deck.inp").write_text(text)

    def work() -> int:
        os.chdir(folder)
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        return command("run", "deck.inp", "--threads", "1", "--format", "vtkhdf")

    code, _, said = forked(work, folder / "log", cpu=LIMIT)
    outcome = judged(code, said, folder, "deck")
    rows_of_iterations = folder / "deck.cvg"
    reached = code in (0, 4) or (
        rows_of_iterations.exists() and rows_of_iterations.read_text().count("\n") > 3
    )
    if outcome == "exit 0":
        try:
            wrong = beyond_limits(folder)
        except Exception as error:
            wrong = f"results cannot be judged: {error!r:.80}"
        outcome = wrong or outcome
    return reached, outcome


def main() -> int:
    """Run until so many decks have reached the solver."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=ROOT / "build" / "solvable")
    parser.add_argument("--fresh", action="store_true", help="begin again")
    parser.add_argument("--one", type=int, help="write this deck to standard output")
    args = parser.parse_args()
    known = seeds()
    if args.one is not None:
        sys.stdout.write(mutant(args.one, args.seed, known))
        return 0
    warm_up()
    STORE.parent.mkdir(exist_ok=True)
    state = {"next": 0, "reached": 0, "counts": {}, "seconds": 0.0}
    if STORE.exists() and not args.fresh:
        state = json.loads(STORE.read_text())
    counts: Counter[str] = Counter(state["counts"])
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="corota-solvable-") as name:
        while state["reached"] < args.count:
            number = state["next"]
            text = mutant(number, args.seed, known)
            reached, outcome = run_one(text, Path(name) / "run")
            kind = outcome.partition(":")[0]
            counts[kind if reached else f"before the solver: {kind}"] += 1
            state |= {"next": number + 1, "reached": state["reached"] + reached}
            state |= {"counts": dict(counts)}
            if not outcome.startswith("exit "):
                args.keep.mkdir(parents=True, exist_ok=True)
                (args.keep / f"{args.seed}-{number}.inp").write_text(text)
                sys.stderr.write(f"{number}: {outcome}\n")
            STORE.write_text(json.dumps(state))
    seconds = time.perf_counter() - begin
    print(f"\n### Decks that reach the solver, seed {args.seed}\n\n{machine()}; {seconds:.0f} s\n")
    print(table(["outcome", "count"], [[k, v] for k, v in sorted(counts.items())]))
    return int(any(not k.removeprefix("before the solver: ").startswith("exit ") for k in counts))


if __name__ == "__main__":
    sys.exit(main())

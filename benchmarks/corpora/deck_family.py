"""A family of generated decks, run by Corota and CalculiX and compared.

``python -m benchmarks deck_family`` runs CalculiX (``ccx``) on every deck, compares and writes the
answers to ``tests/data/deck_family.json``, so that the tests compare without it. With ``--stored``
it compares with the stored answers; ``--show N`` prints a deck and both answers.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import re
import subprocess
import tempfile
import warnings
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import corota as ct
from benchmarks.corpora.deck_generator import COUNT, Deck, generate

if TYPE_CHECKING:
    from collections.abc import Iterator

ANSWERS = Path(__file__).parents[2] / "tests" / "data" / "deck_family.json"
#: Answers: displacements, reactions and stresses by step; eigenvalues by perturbation.
Answer = dict[str, list[list[float]]]
#: Reactions below this are rounding errors.
NO_FORCE = 1e-9
#: Difference of displacements where CalculiX starts a motion in another way.
SUDDEN = 0.02
#: Where CalculiX is wrong: feature of a deck, reason and proof.
EXCEPTIONS = {
    "edge load inserted under a ramp": (
        "CalculiX starts the ramp from the old value of another edge: loadadd.f sorts a new edge "
        "load among the old ones, but the old values (xloadold) stay where they are"
    ),
    "heat with step time": (
        "CalculiX runs an amplitude of step time anew in the next step, for temperatures only: "
        "the loop over the nodes is missing where it ends such amplitudes (CalculiX.c, iamt1). "
        "Its manual and Abaqus's end them for all loads; free expansion in "
        "tests/steps/test_proofs.py"
    ),
    "heat taken away from total time": (
        "CalculiX multiplies the initial temperature, to which OP=NEW goes back, by the amplitude "
        "of the load that was taken away (temperatures.f leaves iamt1); tests/steps/test_proofs.py"
    ),
    "sudden load in motion": (
        "CalculiX starts *DYNAMIC with another acceleration than M a = f: one element integrated "
        "with its own matrices in tests/steps/test_proofs.py has Corota's values to rounding. "
        "Displacements are still compared, to 2 %"
    ),
}
#: Tables of a ``.dat`` file: head, kind, columns that are compared.
TABLES = (
    (r"displacements \(vx,vy,vz\) for set RIGHT and time\s+(\S+)", "U", slice(1, 3)),
    (r"total force \(fx,fy,fz\) for set LEFT and time\s+(\S+)", "RF", slice(0, 2)),
    (r"stresses .*? for set ONE and time\s+(\S+)", "S", slice(2, 6)),
)
#: Points of a brick, and of a layer of it.
LAYER = {8: 4, 27: 9, 9: 3}
EIGEN = {"E I G E N V A L U E   O U T P U T": 3, "B U C K L I N G   F A C T O R": 1}


def by_ccx(deck: Deck) -> Answer | None:
    """What CalculiX answers; None if it does not finish."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(deck.text)
        done = subprocess.run(
            ["ccx", "job"], cwd=folder, check=False, capture_output=True, text=True, timeout=120
        )
        dat = folder / "job.dat"
        if not dat.exists() or "Job finished" not in done.stdout:
            return None
        return read_dat(dat.read_text(), deck)


def read_dat(text: str, deck: Deck) -> Answer:
    """Tables at the ends of the steps, and eigenvalues, of a ``.dat`` file."""
    answer: Answer = {"U": [], "RF": [], "S": [], "eigenvalues": []}
    printed = text
    if deck.theme in ("frequencies", "buckling"):
        # Behind the eigenvalues the same tables hold the modes.
        printed = re.split("|".join(EIGEN), text)[0]
    for head, kind, columns in TABLES:
        tables = list(re.finditer(head, printed))
        for end in deck.ends:
            last = [t for t in tables if abs(float(t.group(1)) - end) < 1e-6 * max(end, 1.0)]
            if not last:
                continue
            # A buckling step prints what its load does, under the same time.
            table = last[0 if deck.theme == "buckling" else -1]
            rows = list(_rows(printed[table.end() :]))
            if kind == "S":
                # Its bricks have layers of points, which are alike.
                rows = rows[: LAYER[len(rows)]]
            answer[kind].append([float(v) for row in rows for v in row[columns]])
    for head, column in EIGEN.items():
        for part in text.split(head)[1:]:
            body = part[part.index("\n\n") :].lstrip()
            start = re.search(r"^\s+1\s", part, re.MULTILINE)
            if start and body:
                rows = list(_rows("\n\n" + part[start.start() :]))
                answer["eigenvalues"].append([float(row[column]) for row in rows])
    return answer


def _rows(text: str) -> Iterator[list[str]]:
    """Rows of the first table of numbers in a text."""
    begun = False
    for line in text.splitlines()[1:]:
        words = line.split()
        if not words:
            if begun:
                return
            continue
        if not re.match(r"[-+.\d]", words[0]):
            return
        begun = True
        yield words


def by_corota(deck: Deck) -> Answer:
    """What Corota answers."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "job.inp"
        path.write_text(deck.text)
        model = ct.read(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = ct.solve(model, threads=1)
    answer: Answer = {"U": [], "RF": [], "S": [], "eigenvalues": []}
    right, left = (model.mesh.nodes_of(name) for name in ("RIGHT", "LEFT"))
    one = int(model.mesh.cell_sets["ONE"][0])
    perturbations = ("frequency", "buckle")
    for number, step in enumerate(model.steps, start=1):
        if step.procedure in perturbations:
            modes = next(m for m in results.modes if m.step == number)
            answer["eigenvalues"].append(modes.factors.real.tolist())
            continue
        frame = [f for f in results.frames if f.step == number][-1]
        answer["U"].append(frame.U[right].ravel().tolist())
        answer["RF"].append((frame.RF + frame.F)[left, :2].sum(axis=0).tolist())
        block = next(b for b in frame.fields if one in b.cells)
        row = int(np.flatnonzero(block.cells == one)[0])
        answer["S"].append(block.values["S"][row].ravel().tolist())
    return answer


def difference(ours: Answer, theirs: Answer, skipped: tuple[str, ...] = ()) -> float:
    """Largest difference of two answers, relative to the largest value of a kind."""
    worst = 0.0
    for kind, rows in theirs.items():
        if kind in skipped:
            continue
        size = max((abs(v) for row in rows for v in row), default=0.0)
        if kind == "RF" and size < NO_FORCE:
            continue
        if len(rows) != len(ours[kind]):
            return float("inf")
        for mine, other in zip(ours[kind], rows, strict=True):
            a, b = np.array(mine), np.array(other)
            if kind == "eigenvalues":
                n = min(len(a), len(b))
                worst = max(worst, float(np.abs(a[:n] / b[:n] - 1.0).max(initial=0.0)))
            elif len(a) != len(b):
                return float("inf")
            elif size > 0.0:
                worst = max(worst, float(np.abs(a - b).max()) / size)
    return worst


def excepted(deck: Deck) -> str:
    """Feature for which CalculiX's answer is not expected; empty for none."""
    return next((name for name in EXCEPTIONS if name in deck.features), "")


def verdict(deck: Deck, ours: Answer, theirs: Answer) -> tuple[str, float]:
    """What a comparison says: agreeing, excepted with the reason, or differing; and by how much."""
    # In motion reactions balance the inertia at held nodes too; CalculiX prints internal forces.
    skipped = ("RF",) if deck.theme in ("motion", "modal") else ()
    error = difference(ours, theirs, skipped)
    if error <= deck.tolerance:
        return "agreeing", error
    reason = excepted(deck)
    if reason == "sudden load in motion":
        error = difference(ours, theirs, ("RF", "S"))
        if error > SUDDEN:
            return "differing", error
    return (f"excepted: {reason}" if reason else "differing"), error


def compact(answer: Answer) -> Answer:
    """An answer with seven digits."""
    return {
        kind: [[float(f"{v:.6e}") for v in row] for row in rows]
        for kind, rows in answer.items()
        if rows
    }


def full(answer: Answer) -> Answer:
    """An answer with all kinds."""
    return {kind: answer.get(kind, []) for kind in ("U", "RF", "S", "eigenvalues")}


def main() -> None:
    """Run the family."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stored", action="store_true", help="compare with the stored answers")
    parser.add_argument("--show", type=int, help="print one deck and both answers")
    parser.add_argument("--count", type=int, default=COUNT)
    given = parser.parse_args()
    if given.show is not None:
        deck = generate(given.show)
        print(deck.text[deck.text.index("*BOUNDARY") :], deck.features)
        print("CalculiX", by_ccx(deck))
        print("Corota  ", by_corota(deck))
        return
    stored = json.loads(ANSWERS.read_text()) if given.stored else {}
    kept: dict[str, Answer] = {}
    counts: Counter[str] = Counter()
    for number in range(given.count):
        deck = generate(number)
        theirs = stored.get(str(number)) if given.stored else by_ccx(deck)
        if theirs is None:
            counts["not finished by CalculiX"] += 1
            continue
        theirs = full(theirs)
        kept[str(number)] = compact(theirs)
        found, error = verdict(deck, by_corota(deck), theirs)
        counts[found] += 1
        if found == "differing":
            print(f"deck {number} ({deck.theme}): {error:.2e}; {sorted(deck.features)}")
    if not given.stored:
        ANSWERS.write_text(json.dumps(kept, separators=(",", ":")) + "\n")
    for name, reason in EXCEPTIONS.items():
        if counts[f"excepted: {name}"]:
            print(f"{name}: {reason}")
    print(f"generated {given.count}: " + ", ".join(f"{n} {what}" for what, n in counts.items()))


if __name__ == "__main__":
    main()

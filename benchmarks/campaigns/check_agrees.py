"""``check`` and ``run`` on generated decks: both start, or both refuse with the same code.

Run with ``python -m benchmarks check_agrees [number] [seed]`` (default 1,000). The decks are those
of the family of loads and steps and those of the corpus, whole and damaged.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random
import sys
import tempfile
import warnings
from collections import Counter
from pathlib import Path

import corota as ct
from benchmarks.corpora.corpus import FOLDER
from benchmarks.corpora.deck_generator import generate
from corota.check import examine
from corota.results.observer import BaseObserver


class _Begun(Exception):
    """The run has found its first increment."""


class _Stop(BaseObserver):
    """Ends a run at its first increment."""

    def increment(self, frame: object) -> None:
        """Stop after the first accepted increment."""
        if frame.increment > 0:  # type: ignore[attr-defined]
            raise _Begun


def damaged(text: str, source: random.Random) -> str:
    """A deck with one line left out, twice, or one of its cards taken away."""
    lines = text.splitlines()
    at = source.randrange(len(lines))
    how = source.randrange(4)
    if how == 0:
        del lines[at]
    elif how == 1:
        lines.insert(at, lines[at])
    elif how == 2:
        cards = [i for i, line in enumerate(lines) if line.upper().startswith("*BOUNDARY")]
        if cards:
            stop = next(
                (i for i in range(cards[0] + 1, len(lines)) if lines[i].startswith("*")),
                len(lines),
            )
            del lines[cards[0] + 1 : stop]
    else:
        lines[at] = lines[at].replace("1", "0", 1)
    return "\n".join(lines) + "\n"


def codes(path: Path) -> tuple[int, int]:
    """Exit codes of ``check`` and of the start of ``run``."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            checked = examine(ct.read(path))[1]
        except ct.CorotaError as error:
            checked = error.exit_code
        try:
            ct.solve(ct.read(path), threads=1, observers=[_Stop()], fields=False)
            ran = 0
        except _Begun:
            ran = 0
        except ct.ConvergenceError:
            ran = 0  # it started
        except ct.CorotaError as error:
            ran = error.exit_code
    return checked, ran


def main() -> None:
    """Print how often they agree, and each deck on which they do not."""
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    source = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
    corpus = sorted(path for path in FOLDER.glob("*.inp") if not path.stem.startswith("cgx"))
    counts: Counter[tuple[int, int]] = Counter()
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "deck.inp"
        for i in range(number):
            text = generate(i).text if i % 2 else source.choice(corpus).read_text(encoding="utf-8")
            path.write_text(damaged(text, source) if i % 4 > 1 else text, encoding="utf-8")
            found = codes(path)
            counts[found] += 1
            if found[0] != found[1]:
                kept = Path(tempfile.gettempdir()) / f"check_differs_{i}.inp"
                kept.write_bytes(path.read_bytes())
                print(f"{kept}: check {found[0]}, run {found[1]}")
    agree = sum(count for (a, b), count in counts.items() if a == b)
    print(f"{agree} of {number} agree; (check, run): {dict(sorted(counts.items()))}")


if __name__ == "__main__":
    main()

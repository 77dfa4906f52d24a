"""The corpus of small decks in the layouts of pre-processors, with CalculiX's answers.

Run with ``python -m benchmarks corpus``: it writes ``tests/data/corpus`` again (needs ``ccx``) and
prints how many decks are accepted, run and agree. ``--check`` writes nothing. ``--accepted`` reads
every deck of the tests and of the pages, and counts.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import shutil
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.corpora.ccx_decks import displacements, run_ccx
from benchmarks.corpora.corpus_layouts import LAYOUTS, flat
from benchmarks.corpora.corpus_problems import PROBLEMS
from corota.check import examine

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "corpus"
ANSWERS = FOLDER / "answers.json"

#: Decks of single features, beside those of the layouts: name and text.
EXTRA = {
    "truss_frame": """*NODE, NSET=NALL
1, 0., 0.
2, 3., 0.
3, 3., 4.
*ELEMENT, TYPE=T3D2, ELSET=BARS
1, 1, 3
2, 2, 3
3, 1, 2
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.
*SOLID SECTION, ELSET=BARS, MATERIAL=STEEL
2.
*BOUNDARY
1, 1, 3
2, 2, 3
3, 3
*STEP
*STATIC
*CLOAD
3, 1, 100.
*NODE FILE
U
*END STEP
""",
    "collapsed": """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 3, 3
2, 1, 3, 4, 4
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
1.
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*BOUNDARY
2, 1, 1, 0.001
3, 1, 1, 0.001
*NODE FILE, OUTPUT=2D
U
*END STEP
""",
    "thickness": """*NODE, NSET=NALL
1, 0., 0.
2, 2., 0.
3, 2., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 3, 4
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL, NODAL THICKNESS
*NODAL THICKNESS
NALL, 0.25
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
*CLOAD
2, 1, 10.
3, 1, 10.
*NODE FILE, OUTPUT=2D
U
*END STEP
""",
    "spring": """*NODE, NSET=NALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 3., 0.
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 3, 4
*ELEMENT, TYPE=SPRINGA, ELSET=COIL
2, 2, 5
*SPRING, ELSET=COIL

1000.
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.
*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL
1.
*EQUATION
2
3, 1, 1., 2, 1, -1.
*BOUNDARY
1, 1, 2
4, 1
2, 2
5, 1, 2
*STEP
*STATIC
*CLOAD
2, 1, 500.
*NODE FILE, OUTPUT=2D
U
*END STEP
""",
}


#: Closed forms where CalculiX has no answer, or not the exact one of a uniform state.
EXACT = {
    "collapsed": [[2.0, 1.0, 1e-3, -1.5e-4], [0.0, 1.0, 0.0, -1.5e-4]],
    "spring": [[1.0, 0.0, 500.0 / 211000.0, 0.0]],
}


def write(folder: Path) -> dict[str, str]:
    """Write the decks; the deck that CalculiX gets, by the name of each."""
    theirs = {}
    for problem in PROBLEMS:
        for layout, writer in LAYOUTS.items():
            stem = f"{layout}_{problem.name}"
            for ending, text in writer(problem).items():
                path = folder / f"{stem}{ending or '.inp'}"
                path.write_text(text.replace("{stem}", stem), encoding="utf-8")
            theirs[stem] = flat(problem)
    for name, text in EXTRA.items():
        (folder / f"{name}.inp").write_text(text, encoding="utf-8")
        theirs[name] = text
    return theirs


def answers(theirs: dict[str, str]) -> dict[str, list[list[float]]]:
    """x, y, ux, uy of the node that moves most, and of the mean of all, by CalculiX."""
    found: dict[str, list[list[float]]] = {}
    known: dict[str, list[list[float]]] = {}
    for name, text in theirs.items():
        if text not in known:
            known[text] = _by_ccx(text)
        if known[text]:
            found[name] = known[text]
    return found


def _by_ccx(text: str) -> list[list[float]]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(text, encoding="utf-8")
        run_ccx(folder)
        frd = folder / "job.frd"
        moved = displacements(frd) if frd.exists() else {}
        mesh = ct.read(folder / "job.inp").mesh
    at = {int(n): p for n, p in zip(mesh.node_labels, mesh.points, strict=True)}
    moved = {n: u for n, u in moved.items() if n in at}
    if not moved:
        return []
    rows = [[*at[n].tolist(), *u[:2].tolist()] for n, u in moved.items()]
    rows.sort(key=lambda row: -np.hypot(row[2], row[3]))
    return [rows[0], rows[len(rows) // 2]]


def compare(deck: Path, rows: list[list[float]]) -> tuple[bool, bool, float]:
    """Whether a deck is accepted and runs, and the difference relative to the largest motion."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = ct.read(deck)
            accepted = examine(model)[1] == 0
            frame = ct.solve(model, threads=1).frames[-1]
    except ct.CorotaError:
        return False, False, float("inf")
    size = max((float(np.hypot(*row[2:])) for row in rows), default=0.0)
    worst = 0.0
    for x, y, *u in rows:
        node = int(np.argmin(np.hypot(*(model.mesh.points - [x, y]).T)))
        worst = max(worst, float(np.abs(frame.U[node] - u).max()))
    return accepted, True, worst / size if size else float("inf")


def count_accepted() -> None:
    """Print how many decks of the tests and of the pages are read, and why the others are not."""
    root = FOLDER.parents[2]
    decks = sorted([*(root / "tests" / "data").rglob("*.inp"), *(root / "docs").rglob("*.inp")])
    refused = 0
    for deck in decks:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                ct.read(deck)
        except ct.CorotaError as error:
            refused += 1
            print(f"{deck.name}: {str(error).splitlines()[0]}")
    print(f"{len(decks) - refused} of {len(decks)} decks are read")


def main() -> None:
    """Write the corpus and print the table."""
    if "--accepted" in sys.argv:
        count_accepted()
        return
    if "--check" not in sys.argv:
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        found = answers(write(FOLDER)) | EXACT
        text = json.dumps(found, indent=None).replace("]], ", "]],\n")
        ANSWERS.write_text(text + "\n", encoding="utf-8")
    found = json.loads(ANSWERS.read_text(encoding="utf-8"))
    decks = sorted(FOLDER.glob("*.inp"))
    results = {d.stem: compare(d, found.get(d.stem, [])) for d in decks}
    for name, (accepted, ran, difference) in results.items():
        if not (accepted and ran and difference < 1e-2):
            print(f"{name:32} accepted {accepted} ran {ran} difference {difference:.1e}")
    for limit in (1e-5, 1e-3, 1e-2):
        print(f"differ by less than {limit:g}: {sum(r[2] < limit for r in results.values())}")
    print(
        f"{len(results)} decks: accepted {sum(r[0] for r in results.values())}, ran "
        f"{sum(r[1] for r in results.values())}, answers of ccx {len(found)}"
    )


if __name__ == "__main__":
    main()

"""Small decks of beams, shells, point masses, joints and the layout of CAE beside CalculiX.

``python -m benchmarks structure_decks`` runs CalculiX (``ccx``) on every deck, compares and writes
the answers to ``tests/data/structure_decks.json``, so that the tests compare without it. With
``--stored`` it compares with the stored answers; ``--show N`` prints a deck and both answers.

CalculiX makes solids of beams, with rigid knots where elements meet at an angle or a moment acts:
beams are straight here and slender, so that both agree within a percent.
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
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import numpy as np

import corota as ct

if TYPE_CHECKING:
    from collections.abc import Callable

ANSWERS = Path(__file__).parents[2] / "tests" / "data" / "structure_decks.json"
COUNT = 120
THEMES = ("beams", "shells", "masses", "equations", "cae", "springs")
#: Largest difference of displacements, relative to the largest.
TOLERANCES = {"beams": 1.5e-2}
EXACT = 2e-5
STEEL = "*MATERIAL, NAME=M\n*ELASTIC\n210000., 0.\n*DENSITY\n7.8e-9\n"


@dataclass
class Deck:
    """A generated deck: for CalculiX, and as Corota gets it.

    Parameters
    ----------
    number : int
    theme : str
    text, given : str
        The same model in the flat layout, and in the one that is tried.
    """

    number: int
    theme: str
    text: str
    given: str

    @property
    def tolerance(self) -> float:
        """Largest difference, relative to the largest displacement."""
        return TOLERANCES.get(self.theme, EXACT)


def generate(number: int) -> Deck:
    """The deck of a number."""
    theme = THEMES[number % len(THEMES)]
    random = Random(f"structure {number}")
    text = MAKERS[theme](random)
    given = _as_cae(text) if theme == "cae" else text
    return Deck(number, theme, text, given)


def _end(random: Random, loads: str, linear: bool = False) -> str:
    large = ", NLGEOM" if random.random() < 0.3 and not linear else ""
    step = "*STATIC\n0.5, 1.\n" if large else "*STATIC\n"
    return f"*STEP{large}\n{step}{loads}*NODE PRINT, NSET=OUT\nU\n*END STEP\n"


def _beams(random: Random) -> str:
    """A straight slender beam of 8 quadratic elements, clamped or on two supports."""
    n, length = 8, random.choice((1000.0, 1500.0))
    width, height = random.choice(((10.0, 20.0), (20.0, 20.0), (8.0, 30.0)))
    angle = random.choice((0.0, 0.0, 0.7))
    c, s = float(np.cos(angle)), float(np.sin(angle))
    places = np.linspace(0.0, length, 2 * n + 1)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{i}, {x * c:.10g}, {x * s:.10g}, 0." for i, x in enumerate(places, start=1)]
    lines += [f"*ELEMENT, TYPE={random.choice(('B32', 'B32R'))}, ELSET=EALL"]
    lines += [f"{k + 1}, {2 * k + 1}, {2 * k + 2}, {2 * k + 3}" for k in range(n)]
    last = 2 * n + 1
    lines += ["*NSET, NSET=OUT", f"{n + 1}, {last}"]
    section = f"*BEAM SECTION, ELSET=EALL, MATERIAL=M, SECTION=RECT\n{width}, {height}\n0, 0, 1\n"
    clamped = random.random() < 0.6 or angle != 0.0
    held = "1, 1, 6\n" if clamped else f"1, 1, 3\n1, 4, 5\n{last}, 2, 3\n"
    stiffness = 210000.0 * width * height**3 / 12.0
    force = 0.02 * length * 3.0 * stiffness / length**3
    at = last if clamped else n + 1
    kind = random.choice(("force", "weight", "both"))
    loads = "" if kind == "weight" else f"*CLOAD\n{at}, 2, {force:.6g}\n"
    if kind != "force":
        g = 8.0 * 0.01 * length * stiffness / length**4 / (7.8e-9 * width * height)
        loads += f"*DLOAD\nEALL, GRAV, {g:.6g}, 0., 1., 0.\n"
    return "\n".join(lines) + f"\n{STEEL}{section}*BOUNDARY\n{held}" + _end(random, loads)


def _sheet(element: str, section: str, extra: str = "") -> str:
    """A strip of four quadrilaterals under a quadrilateral's name."""
    quadratic = "8" in element
    mesh = ct.mesh.rectangle(4.0, 1.0, 4, 1, "quad8" if quadratic else "quad4")
    lines = ["*NODE, NSET=NALL"]
    lines += [
        f"{label}, {x:.10g}, {y:.10g}, 0."
        for label, (x, y) in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True)
    ]
    lines += [f"*ELEMENT, TYPE={element}, ELSET=EALL"]
    for block in mesh.cells:
        for label, row in zip(block.labels.tolist(), block.nodes.tolist(), strict=True):
            lines.append(", ".join(map(str, [label, *(mesh.node_labels[row]).tolist()])))
    for name, at in (("LEFT", "left"), ("OUT", "right")):
        labels = mesh.node_labels[mesh.nodes_of(at)].tolist()
        lines += [f"*NSET, NSET={name}", ", ".join(map(str, labels))]
    return "\n".join(lines) + f"\n{extra}{STEEL}{section}"


def _corners(element: str) -> tuple[int, int]:
    """Numbers of the lower and the upper corner at the end of the strip."""
    return (9, 23) if "8" in element else (5, 10)


def _shells(random: Random) -> str:
    """A strip of shells or membranes, stretched by pressures on its edges.

    CalculiX stretches M3D8 five times as much as p l / E: membranes are linear M3D4.
    """
    element = random.choice(("S4", "S8", "S8R", "M3D4"))
    card = "SHELL" if element.startswith("S") else "MEMBRANE"
    thickness = random.choice((0.5, 2.0))
    surfaces = "*SURFACE, NAME=TIP\n4, S4\n*SURFACE, NAME=ROOF\nEALL, S5\n"
    section = f"*{card} SECTION, ELSET=EALL, MATERIAL=M\n{thickness}\n"
    sheet = _sheet(element, section, surfaces)
    pull = random.choice((-100.0, 60.0))
    loads = f"*DSLOAD\nTIP, P, {pull}\n"
    if "8" in element and random.random() < 0.5:
        loads += f"*DSLOAD\nROOF, P, {random.choice((2.0, -3.0))}\n"
    return sheet + "*BOUNDARY\nLEFT, 1, 2\nNALL, 3, 3\n" + _end(random, loads, card == "MEMBRANE")


def _masses(random: Random) -> str:
    """A strip with point masses at its end, under weight and spin of some of its sets."""
    element = random.choice(("CPS8", "CPE8", "CPS8R"))
    section = "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n"
    value = random.choice((1e-8, 4e-8))
    nodes = "\n".join(f"{900 + i}, {node}" for i, node in enumerate(_corners(element)))
    extra = f"*ELEMENT, TYPE=MASS, ELSET=MS\n{nodes}\n*ELSET, ELSET=BOTH\nEALL, MS\n"
    sheet = _sheet(element, section, extra) + f"*MASS, ELSET=MS\n{value}\n"
    where = random.choice(("BOTH", "EALL", "MS"))
    loads = f"*DLOAD\n{where}, GRAV, 9.81e5, {random.choice(('0., -1.', '1., 0.'))}, 0.\n"
    if random.random() < 0.5:
        loads += f"*DLOAD\n{random.choice(('BOTH', 'EALL'))}, CENTRIF, 1e5, 0.,0.,0., 0.,0.,1.\n"
    return sheet + "*BOUNDARY\nLEFT, 1, 2\n" + _end(random, loads)


def _equations(random: Random) -> str:
    """A strip whose end moves as one, by equations between single nodes."""
    element = random.choice(("CPS8", "CPE8", "CPS4"))
    sheet = _sheet(element, "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n")
    lead, other = _corners(element)
    text = f"*EQUATION\n2\n{other}, 1, 1., {lead}, 1, -1.\n"
    loads = f"*CLOAD\n{lead}, 1, {random.choice((300.0, -500.0))}\n{lead}, 2, 20.\n"
    return sheet + text + "*BOUNDARY\nLEFT, 1, 2\n" + _end(random, loads)


def _springs(random: Random) -> str:
    """A strip on springs of both kinds."""
    element = random.choice(("CPS8", "CPE8R"))
    k = random.choice((500.0, 2000.0))
    low, high = _corners(element)
    extra = (
        f"*NODE\n901, 4., -1., 0.\n*ELEMENT, TYPE=SPRINGA, ELSET=SA\n901, {low}, 901\n"
        f"*ELEMENT, TYPE=SPRING1, ELSET=S1\n902, {high}\n"
        f"*SPRING, ELSET=SA\n\n{k}\n*SPRING, ELSET=S1\n1\n{2.0 * k}\n"
    )
    sheet = _sheet(element, "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n", extra)
    loads = f"*CLOAD\n{high}, 1, {random.choice((300.0, -500.0))}\n{high}, 2, 40.\n"
    held = "*BOUNDARY\nLEFT, 1, 2\n901, 1, 3\n"
    return sheet + held + _end(random, loads)


def _cae(random: Random) -> str:
    """A strip whose deck can be split into a part and an assembly."""
    element = random.choice(("CPS8", "CPE8R", "CPS4", "CPE8"))
    surface = "*SURFACE, NAME=TIP\n4, S2\n"
    sheet = _sheet(element, "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n1.\n", surface)
    loads = f"*DSLOAD\nTIP, P, {random.choice((-80.0, 50.0))}\n*CLOAD\nOUT, 2, 2.\n"
    return (
        sheet
        + f"*BOUNDARY\nLEFT, 1, 2\n*STEP\n*STATIC\n{loads}*NODE PRINT, NSET=OUT\nU\n*END STEP\n"
    )


def _as_cae(text: str) -> str:
    """The flat deck with a part, an instance and sets of the assembly, and CAE's output cards."""
    head, rest = text.split("*NSET, NSET=LEFT", 1)
    sets, rest = ("*NSET, NSET=LEFT" + rest).split("*MATERIAL", 1)
    material, rest = ("*MATERIAL" + rest).split("*SOLID SECTION", 1)
    section, history = ("*SOLID SECTION" + rest).split("*BOUNDARY", 1)
    sets = re.sub(r"\*NSET, NSET=(\w+)", r"*Nset, nset=\1, instance=Part-1-1", sets)
    sets = sets.replace("\n4, S2\n", "\n_TIP, S2\n")
    sets = "*Elset, elset=_TIP, internal, instance=Part-1-1\n 4,\n" + sets
    output = (
        "*Restart, write, frequency=0\n*Output, field, variable=PRESELECT\n"
        "*Output, history, variable=PRESELECT\n"
    )
    history = history.replace("*NODE PRINT", output + "*NODE PRINT")
    history = history.replace("*STEP\n", "*Step, name=Step-1, nlgeom=NO\n")
    return (
        "*Heading\n** Job name: Job-1 Model name: Model-1\n*Preprint, echo=NO, model=NO\n"
        f"*Part, name=Part-1\n{head}{section}*End Part\n*Assembly, name=Assembly\n"
        f"*Instance, name=Part-1-1, part=Part-1\n*End Instance\n{sets}*End Assembly\n"
        f"{material}*BOUNDARY{history}"
    )


MAKERS = {
    "beams": _beams,
    "shells": _shells,
    "masses": _masses,
    "equations": _equations,
    "cae": _cae,
    "springs": _springs,
}


def by_ccx(deck: Deck) -> list[float] | None:
    """Displacements of the set OUT by CalculiX; None if it does not finish."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(deck.text)
        done = subprocess.run(
            ["ccx", "job"], cwd=folder, check=False, capture_output=True, text=True, timeout=120
        )
        dat = folder / "job.dat"
        if not dat.exists() or "Job finished" not in done.stdout:
            return None
        last = dat.read_text().split("displacements")[-1]
    rows = [line.split() for line in last.splitlines()[1:] if line.strip()]
    return [float(v) for row in rows for v in row[1:3]]


def by_corota(deck: Deck) -> list[float]:
    """Displacements of the set OUT by Corota."""
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(name) / "job.inp"
        path.write_text(deck.given)
        model = ct.read(path)
        frame = ct.solve(model, threads=1).frames[-1]
    nodes = np.sort(model.mesh.nodes_of("OUT"))
    found: list[float] = frame.U[nodes].ravel().tolist()
    return found


def difference(ours: list[float], theirs: list[float]) -> float:
    """Largest difference, relative to the largest displacement."""
    a, b = np.array(ours), np.array(theirs)
    return float(np.abs(a - b).max() / np.abs(b).max()) if len(a) == len(b) else float("inf")


def run(
    description: str | None, generate: Callable[[int], Deck], count: int, answers: Path
) -> None:
    """Command line of generated decks: run, compare with CalculiX or its stored answers, count.

    Parameters
    ----------
    description : str or None
        Of the command.
    generate : callable
        Makes the deck of a number.
    count : int
        Number of decks by default.
    answers : Path
        Where the answers of CalculiX are stored.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--stored", action="store_true", help="compare with the stored answers")
    parser.add_argument("--show", type=int, help="print one deck and both answers")
    parser.add_argument("--count", type=int, default=count)
    given = parser.parse_args()
    if given.show is not None:
        deck = generate(given.show)
        print(deck.given)
        print("CalculiX", by_ccx(deck))
        print("Corota  ", by_corota(deck))
        return
    stored = json.loads(answers.read_text()) if given.stored else {}
    kept: dict[str, list[float]] = {}
    counts: Counter[str] = Counter()
    for number in range(given.count):
        deck = generate(number)
        theirs = stored.get(str(number)) if given.stored else by_ccx(deck)
        if theirs is None:
            counts["not finished by CalculiX"] += 1
            continue
        kept[str(number)] = theirs
        error = difference(by_corota(deck), theirs)
        found = "agreeing" if error <= deck.tolerance else "differing"
        counts[found] += 1
        if found == "differing":
            print(f"deck {number} ({deck.theme}): {error:.2e}")
    if not given.stored:
        answers.write_text(json.dumps(kept, separators=(",", ":")) + "\n")
    print(f"generated {given.count}: " + ", ".join(f"{n} {what}" for what, n in counts.items()))


if __name__ == "__main__":
    run(__doc__, generate, COUNT, ANSWERS)

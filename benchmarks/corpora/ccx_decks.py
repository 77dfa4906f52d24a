"""Decks of CalculiX's test suite, run by both programs and compared.

Needs the program ``ccx`` and its test decks (Debian: ``calculix-ccx``,
``calculix-ccx-test``). Run with ``python -m benchmarks ccx_decks [folder of the decks]``; it
writes ``docs/ccx-decks.md``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import gzip
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import corota as ct

DECKS = Path("/usr/share/doc/calculix-ccx-test/examples/test")
FOLDER = Path(sys.argv[1]) if len(sys.argv) > 1 and __name__ == "__main__" else DECKS
_TYPE = re.compile(rb"TYPE\s*=\s*(\w+)", re.IGNORECASE)
PAGE = Path(__file__).parents[2] / "docs" / "ccx-decks.md"


@dataclass
class Case:
    """A deck, and why the two programs differ."""

    name: str
    reason: str


ROTATED = (
    "half of the beam bends under a moment: exact is M l^2 / 2 EI = 0.0451499; Corota gives this. "
    "CalculiX expands beams to solids, with rigid knots where moments act"
)
CASES = (
    Case("oneel", "digits printed by CalculiX"),
    Case("planestrain", "digits printed by CalculiX"),
    Case("planestrain2", "digits printed by CalculiX"),
    Case("planestress", "digits printed by CalculiX"),
    Case("planestress2", "digits printed by CalculiX"),
    Case(
        "planestress3",
        "CalculiX expands CPS4 into a solid whose out-of-plane stress does not vanish at each "
        "point",
    ),
    Case(
        "scheibe",
        "a plate rotated by half a turn: exact is 2 for the corners beside the center; Corota "
        "gives this. CalculiX linearizes the rotation in each of 100 increments and drifts to 3.17",
    ),
    Case("spring4", "digits printed by CalculiX"),
    Case("spring1", "a spring alone"),
    Case("spring2", "a nonlinear spring"),
    Case("edgeload", "digits printed by CalculiX"),
    Case(
        "beamlin",
        "a stepped bar: exact is F l / EA, 0.0125 in a quarter of it; Corota gives this. CalculiX "
        "expands beams to solids, with a rigid knot at the step",
    ),
    Case("rot1", ROTATED),
    Case("rot2", ROTATED),
    Case("rot3", ROTATED + "; in NLGEOM 0.0449824"),
    Case("section4", "circular section with one number"),
    Case("axiplane", "axisymmetric elements"),
    Case("dam", "heat conduction"),
    Case(
        "plate",
        "CalculiX models contact by springs between the surfaces, whose stiffness is a parameter",
    ),
)


def displacements(frd: Path) -> dict[int, np.ndarray]:
    """Last displacements of an ``.frd`` file by node."""
    found: dict[int, np.ndarray] = {}
    inside = False
    for line in frd.read_text(errors="replace").splitlines():
        if line.startswith(" -4"):
            inside = line[5:9].strip() == "DISP"
            if inside:
                found = {}
        elif line.startswith(" -3"):
            inside = False
        elif inside and line.startswith(" -1"):
            numbers = [float(line[13 + 12 * i : 25 + 12 * i]) for i in range(2)]
            found[int(line[3:13])] = np.array(numbers)
    return found


def run_ccx(folder: Path) -> None:
    """Run ``job.inp`` of a folder on one thread."""
    subprocess.run(
        ["ccx", "-i", "job"],
        cwd=folder,
        check=False,
        capture_output=True,
        timeout=300,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )


def by_ccx(deck: Path, folder: Path) -> dict[int, np.ndarray]:
    """Displacements of the deck by CalculiX; its output requests get one more."""
    text = deck.read_text(errors="replace")
    # Shapes of modes would stand behind the displacements.
    place = text.upper().find("*FREQUENCY")
    if place >= 0:
        text = text[: text.upper().rfind("*STEP", 0, place)]
    out: list[str] = []
    for line in text.splitlines():
        if line.replace(" ", "").upper().startswith("*ENDSTEP"):
            out += ["*NODE FILE, OUTPUT=2D", "U"]
        out.append(line)
    (folder / "job.inp").write_text("\n".join(out) + "\n")
    run_ccx(folder)
    frd = folder / "job.frd"
    return displacements(frd) if frd.exists() else {}


def row(case: Case) -> str:
    """One line of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = folder / f"{case.name}.inp"
        deck.write_bytes(text_of(case.name))
        how = "unchanged"
        try:
            try:
                model = ct.read(deck)
            except ct.DeckError:
                model = ct.read(deck, lenient=True)
                how = "lenient"
            frame = ct.solve(model).frames[-1]
        except ct.CorotaError as error:
            said = str(error).splitlines()[0].split(": ", 2)[-1]
            return f"| `{case.name}` | refused | | | {case.reason}: {said} |"
        theirs = by_ccx(deck, folder)
    size, worst = 0.0, 0.0
    body = np.unique(np.concatenate([c.nodes.ravel() for c in model.mesh.cells]))
    for index in body.tolist():
        other = theirs.get(int(model.mesh.node_labels[index]))
        if other is not None:
            size = max(size, float(np.abs(other).max()))
            worst = max(worst, float(np.abs(frame.U[index] - other).max()))
    ours = float(np.abs(frame.U[body]).max())
    difference = f"{worst / size:.1e}" if size else "no result of ccx"
    return f"| `{case.name}` | {how} | {ours:.6g} | {difference} | {case.reason} |"


def text_of(name: str) -> bytes:
    """Text of a deck of the suite, which Debian packs."""
    packed = FOLDER / f"{name}.inp.gz"
    return (
        gzip.decompress(packed.read_bytes())
        if packed.exists()
        else (FOLDER / f"{name}.inp").read_bytes()
    )


def others() -> list[Case]:
    """Decks of planar elements that are not in the list above."""
    names = sorted({path.name.split(".")[0] for path in FOLDER.glob("*.inp*")})
    known = {case.name for case in CASES}
    found = []
    for name in names:
        types = {t.upper() for t in _TYPE.findall(text_of(name))}
        planar = any(t.startswith((b"CPS", b"CPE")) for t in types)
        if name not in known and planar and not any(t.startswith(b"C3D") for t in types):
            found.append(Case(name, "not investigated"))
    return found


def main() -> None:
    """Write the page."""
    version = subprocess.run(["ccx", "-v"], check=False, capture_output=True, text=True).stdout
    lines = [
        "# Decks of CalculiX's tests",
        "",
        f"Written by `python -m benchmarks ccx_decks` with CalculiX {version.split()[-1]}.",
        "The decks are those of its test suite that lie in one plane and have only planar",
        "elements, trusses, beams and springs; the files are not changed. The difference is the",
        "largest of any nodal displacement at the end of the static steps, relative to the",
        "largest displacement.",
        "",
        "| deck | runs | largest displacement | difference | cause |",
        "| --- | --- | --- | --- | --- |",
        *(row(case) for case in [*CASES, *others()]),
        "",
    ]
    by_hand = "".join(PAGE.read_text(encoding="utf-8").partition("\n## ")[1:])
    PAGE.write_text("\n".join(lines) + by_hand, encoding="utf-8")


if __name__ == "__main__":
    main()

"""Whether a name means one number everywhere: `python -m benchmarks same_values [NAME ...]`.

Every example, deck of the documents and picture of the catalogue is run; results in memory are
compared with those read back from the result file, with and without values at points, with
`.frd` and `.pvd`, the CSV table, tables of the `.dat` file, the page of the report and the lines of
`corota info`: extremes at points with their places, nodal values, histories and scalars. Numbers of
text files are equal to their digits, those of the page to its bits, all others to the bit.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import csv
import re
import runpy
import sys
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import chdir, suppress
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota.analysis.run import Analysis
from corota.cli.info import result_lines
from corota.errors import CorotaError
from corota.io.tables.dat import check_requests
from corota.model.steps import Output
from corota.report.chunk import unpack
from corota.report.content import content_of_results
from corota.report.records import without_units
from corota.results.table import COMPONENTS, INVARIANTS, NODAL, TABLE, variables
from corota.verification.catalogue import Picture, problems

ROOT = Path(__file__).parents[2]
#: Results of more numbers than this are compared at fewer frames.
LARGE = 2_000_000
#: Share of the largest number that texts of 6 and 5 digits and the page round off.
DAT, FRD, CSV, INFO, PAGE = 1.0e-6, 1.0e-5, 1.0e-11, 1.0e-5, 2.0e-4


class Comparison:
    """Counts equal numbers and lists others."""

    def __init__(self, name: str) -> None:
        self.name, self.count, self.wrong = name, 0, []  # type: ignore[var-annotated]

    def same(
        self, what: str, found: Any, wanted: Any, tolerance: float = 0.0, size: float = 0.0
    ) -> None:
        """Compare numbers; the tolerance is relative to the size, or to the largest number."""
        found, wanted = np.asarray(found, float), np.asarray(wanted, float)
        self.count += wanted.size
        if found.shape != wanted.shape:
            self.wrong.append(f"{what}: shape {found.shape} for {wanted.shape}")
            return
        size = size or float(np.nanmax(np.abs(wanted), initial=0.0))
        close = np.isclose(found, wanted, rtol=0.0, atol=tolerance * size, equal_nan=True)
        if not close.all():
            worst = int(np.argmin(close))
            self.wrong.append(f"{what}: {found.flat[worst]!r} for {wanted.flat[worst]!r}")


def compare(name: str, results: ct.Results) -> Comparison:
    """All ways to read the results beside those in memory."""
    report = Comparison(name)
    results.model.name = "job"
    size = results.mesh.n_nodes * len(results.frames) * 40
    if size > LARGE and len(results.frames) > 3:
        keep = np.unique(np.linspace(0, len(results.frames) - 1, 3).astype(int))
        results.frames = [results.frames[i] for i in keep]
    with tempfile.TemporaryDirectory() as folder:
        for ending, options in (
            ("vtkhdf", {}),
            ("hdf", {"points": True}),
            ("pvd", {}),
            ("frd", {}),
        ):
            path = Path(folder) / f"job.{ending}"
            results.write(path, **options)
            with ct.read_results(path) as read:
                _file(report, ending, results, read)
        _table(report, results, Path(folder) / "job.csv")
        _dat(report, results, Path(folder) / "job.dat")
        with ct.read_results(Path(folder) / "job.vtkhdf") as read:
            report.count += 1
            if result_lines(results) != result_lines(read):
                report.wrong.append("info: lines of memory and file differ")
            _info(report, results, result_lines(read))
            _page(report, "page of the file", results, read)
        _page(report, "page", results, results)
    return report


def _file(report: Comparison, ending: str, results: ct.Results, read: ct.Results) -> None:
    names = results.variables()
    whole = ending in ("vtkhdf", "hdf")
    pick = (
        range(len(results.frames))
        if ending != "frd"
        else [i for i, f in enumerate(results.frames) if f.increment]
    )
    for index, frame in zip(range(len(read.frames)), pick, strict=False):
        blocks = {row.block for row in variables().values() if row.block}
        for name in results.variables(frame):
            row = next(r for r in variables().values() if name in r.names)
            if ending == "frd" and (
                row.name in ("RF", "UR") or row.block not in blocks or not row.block
            ):
                continue
            if ending == "frd" and name in INVARIANTS:
                continue  # of rounded components
            tolerance = FRD if ending == "frd" else 0.0
            what = f"{ending}: nodal {name}, frame {frame}"
            with suppress(*([ct.InputError] if ending == "frd" else [])):  # not a block of files
                # A file of CalculiX's layout has the nodes of rigid curves behind the others.
                found = read.nodal(name, index)[: results.mesh.n_nodes]
                report.same(what, found, results.nodal(name, frame), tolerance)
            if whole and name not in NODAL:
                for at in ("points", "nodes"):
                    mine, theirs = results.extremes(name, frame, at), read.extremes(name, index, at)
                    report.count += 1
                    if mine != theirs:
                        report.wrong.append(f"{ending}: extremes {mine} for {theirs}")
    if whole:
        # Each history reads all frames: here once.
        read.frames._read = list(read.frames).__getitem__  # type: ignore[attr-defined]
        for name in names:
            for how in ("auto", "min", "max"):
                found, wanted = read.history(name, combine=how), results.history(name, combine=how)
                report.same(f"{ending}: history {name}, {how}", found, wanted)
            found, wanted = read.history(name, at="nodes"), results.history(name, at="nodes")
            report.same(f"{ending}: history {found.name}", found, wanted)
        for name in {k for f in results.frames for k in f.scalars}:
            report.same(f"{ending}: scalar {name}", read.history(name), results.history(name))


def _table(report: Comparison, results: ct.Results, path: Path) -> None:
    results.write(path)
    with open(path, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    names, _ = without_units(head)
    table = np.array([[float(text or "nan") for text in row] for row in rows])
    for column, name in enumerate(names):
        if name == "largest MISES":
            with suppress(ct.InputError):
                wanted = results.history("MISES", combine="max")
                report.same("csv: largest MISES", table[:, column], wanted, CSV)
        elif name == "largest U":
            report.same(
                "csv: largest U", table[:, column], results.history("U", combine="max"), CSV
            )
        elif any(name in f.scalars for f in results.frames):
            known = [i for i, f in enumerate(results.frames) if name in f.scalars]
            wanted = [results.frames[i].scalars[name] for i in known]
            report.same(f"csv: {name}", table[known, column], wanted, CSV)
        elif (match := re.fullmatch(r"(RF[12]) (.+)", name)) and match[2] in results.mesh.node_sets:
            wanted = results.history(match[1], at=match[2])
            report.same(f"csv: {name}", table[:, column], wanted, CSV)


def _dat(report: Comparison, results: ct.Results, path: Path) -> None:
    """Tables at points beside extremes, tables at nodes beside nodal values; of the last frame."""
    steps = results.model.steps
    last = results.frames[-1]
    if not last.fields or any("M1" in b.values for b in last.fields):
        return  # of beams the table has the stress at the outer fibers
    stored = {n for b in last.fields for n in b.values}
    point = tuple(n for n, r in variables().items() if r.title and not r.frame and n in stored)
    step = ct.Static()
    step.outputs = [Output("el print", point), Output("node print", ("U",))]
    try:
        results.model.steps = [step] * last.step
        check_requests([step])
        kept, results.frames = results.frames, [last]
        if not last.increment:
            return
        results.write(path)
    finally:
        results.frames = kept
        results.model.steps = steps
    text = path.read_text()
    parts = re.split(r"\n (?=[a-z])", "\n" + text)
    for name in point:
        title = variables()[name].title.strip()
        body = next(p for p in parts if p.startswith(title)).split("\n\n", 1)[1]
        rows = np.array([line.split() for line in body.splitlines() if line.strip()], float)
        columns = [n for n, (of, _) in COMPONENTS.items() if of == name] or [name]
        for i, component in enumerate(columns):
            found = results.extremes(component)
            scale = TABLE[name].shear if name in TABLE and i == 3 else 1.0
            wanted = [scale * found.smallest.value, scale * found.largest.value]
            values = rows[:, 2 + i]
            report.same(f"dat: {component}", [values.min(), values.max()], wanted, DAT)
    body = next(p for p in parts if p.startswith("displacements")).split("\n\n", 1)[1]
    rows = np.array([line.split()[:4] for line in body.splitlines() if line.strip()], float)
    report.same("dat: U", rows[:, 1:3], last.U, DAT)


def _info(report: Comparison, results: ct.Results, lines: list[str]) -> None:
    for name in results.variables():
        line = next(text for text in lines if text.split()[:1] == [name])
        at = "nodes" if name in NODAL else "points"
        found = results.extremes(name, at=at)
        places = re.findall(r"(-?[\d.]+(?:e[+-]\d+)?)  +(node \d+|element \d+, point \d+)", line)
        values = [float(value) for value, _ in places]
        report.same(f"info: {name}", values, [found.smallest.value, found.largest.value], INFO)
        report.count += 1
        if [where for _, where in places] != [found.smallest.place, found.largest.place]:
            report.wrong.append(f"info: {name}: {line}")


def _page(report: Comparison, what: str, results: ct.Results, shown: ct.Results) -> None:
    content = content_of_results(shown)
    frames = [c for n, c in content.chunks.items() if n.startswith("frame-")]
    head, arrays = next(
        (h, a) for h, a in map(unpack, reversed(frames)) if h["kind"] == "increment"
    )
    index = int(head["index"])
    for row in variables().values():
        key = {"UR": "UR", "V": "VEL", "A": "ACC"}.get(row.name, row.name)
        if key not in arrays or (row.frame and row.first):
            continue
        for column, (part, _) in enumerate(row.parts):
            values = np.asarray(arrays[key], float).reshape(len(results.mesh.points), -1)
            wanted = results.nodal(part, index)
            size = np.abs(np.asarray(arrays[key], float)).max() or 1.0
            report.same(f"{what}: {part}", values[:, column], wanted, PAGE, size)


def subjects(names: list[str]) -> Iterator[tuple[str, ct.Results]]:
    """Results of examples, decks of the documents and pictures of the catalogue, by name."""

    def wanted(name: str) -> bool:
        return not names or any(part in name for part in names)

    for path in sorted([*ROOT.glob("docs/decks/*.inp"), *ROOT.glob("examples/*/*.inp")]):
        if wanted(path.name):
            try:
                model = ct.read(path)
                yield path.name, ct.solve(model)
            except CorotaError as error:
                print(f"{path.name}: not run: {str(error)[:100]}")
    for path in sorted(ROOT.glob("examples/*/*.py")):
        if wanted(path.name) and path.name != "mesh.py":
            for number, results in enumerate(_of_script(path)):
                yield f"{path.name} {number + 1}", results
    for name, problem in problems().items():
        if wanted(name) and problem.picture is not None:
            picture: Picture = problem.picture()
            if isinstance(picture.subject, ct.Results):
                yield name, picture.subject


def _of_script(path: Path) -> list[ct.Results]:
    """The first and the last results that a script solves for."""
    found: list[ct.Results] = []
    run = Analysis.run

    def keep(self: Analysis) -> ct.Results:
        results = run(self)
        found.append(results)
        return results

    Analysis.run = keep  # type: ignore[method-assign]
    argv, path_before = sys.argv, sys.path
    # An example may import from the file beside it.
    sys.path = [str(path.parent), *sys.path]
    try:
        with tempfile.TemporaryDirectory() as folder, chdir(folder):
            sys.argv = [str(path)]
            runpy.run_path(str(path), run_name="__main__")
    except (CorotaError, SystemExit) as error:
        print(f"{path.name}: stopped: {str(error)[:100]}")
    finally:
        Analysis.run = run  # type: ignore[method-assign]
        sys.argv, sys.path = argv, path_before
    whole = [r for r in found if r.frames and r.frames[-1].fields]
    return [whole[0], whole[-1]] if len(whole) > 1 else whole


def main() -> None:
    """Print one line for each subject and what differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="parts of names of subjects; all by default")
    warnings.simplefilter("ignore")
    numbers = wrong = count = 0
    for name, results in subjects(parser.parse_args().names):
        if not results.frames:
            continue
        try:
            found = compare(name, results)
        except Exception as error:  # a way to read results that fails is a difference
            found = Comparison(name)
            found.wrong.append(f"{type(error).__name__}: {error}")
        numbers, wrong, count = numbers + found.count, wrong + len(found.wrong), count + 1
        print(f"{name}: {found.count:,} numbers, {len(found.wrong)} differ", flush=True)
        for text in found.wrong[:8]:
            print("   ", text, flush=True)
    print(f"{count} results, {numbers:,} numbers compared, {wrong} differ")
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()

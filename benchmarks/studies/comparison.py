"""The paper's comparison: efficiency and accuracy of elements, masses and local strains.

Runs every case of ``benchmarks/studies/elements`` (a module there is a study, one more file is one
more) on a sequence of meshes, one thread each, and draws the error over the number of dofs and over
processor time. ``--studies`` and ``--cases`` choose, ``--write`` puts tables and figures into
``docs/comparison.md``; the page's conclusions are written by hand. Measured values are kept in
``results/comparison.json``, and only the studies named are run again; ``--redraw`` runs nothing.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

from benchmarks.common import machine, table
from benchmarks.studies.elements.case import Case, measure

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "results" / "comparison.json"
PAGE = ROOT / "docs" / "comparison.md"
IMAGES = ROOT / "docs" / "images"
#: Color and marker of each element.
LOOK = {
    "Q4I": ("#0072B2", "o"),
    "Q8": ("#56B4E9", "D"),
    "Q9": ("#009E73", "s"),
    "OPT": ("#D55E00", "^"),
    "Q4D": ("#CC79A7", "v"),
    "Q4S": ("#E69F00", "p"),
    "Q4DI": ("#F0E442", "<"),
}


def cases() -> list[Case]:
    """All cases, in the order of the page."""
    order = ("statics", "dynamics", "plasticity", "contact", "impact")
    names = {p.stem for p in Path(__file__).with_name("elements").glob("*.py")}
    names -= {"__init__", "case"}
    ranked = sorted(names, key=lambda n: (order.index(n) if n in order else len(order), n))
    return [c for n in ranked for c in import_module(f"benchmarks.studies.elements.{n}").CASES]


def run(case: Case) -> list[dict[str, Any]]:
    """Every element, variant and mesh of a case."""
    records = []
    for variant in case.variants:
        for element in case.elements:
            for n in case.meshes:
                records.append(measure(case, element, variant, n))
                r = records[-1]
                said = r.get("stopped") or f"{r['error']:.2e}  {r['seconds']:.3f} s"
                sys.stdout.write(f"{case.name} {variant} {element} {r['dofs']}: {said}\n")
                sys.stdout.flush()
    return records


def draw(case: Case, records: list[dict[str, Any]], path: Path) -> None:
    """Error over dofs (above) and over processor time (below), a column for each variant."""
    from corota.plots.figure import look, new_figure, save

    with look():
        figure = new_figure(2.35 * len(case.variants) + 0.5, 4.3, shown=False)
        axes = figure.subplots(2, len(case.variants), sharey=True, squeeze=False)
        for column, variant in enumerate(case.variants):
            for row, key in enumerate(("dofs", "seconds")):
                ax = axes[row][column]
                for element in case.elements:
                    found = [
                        r
                        for r in records
                        if (r["element"], r["variant"]) == (element, variant) and "error" in r
                    ]
                    color, marker = LOOK[element]
                    ax.loglog(
                        [r[key] for r in found],
                        [r["error"] for r in found],
                        marker=marker,
                        color=color,
                        label=element,
                        markersize=3.5,
                        linewidth=1.1,
                    )
                ax.grid(True, which="major", alpha=0.3)
                ax.set_xlabel("dofs" if key == "dofs" else "processor time [s]")
                if row == 0:
                    ax.set_title(variant)
                if column == 0:
                    ax.set_ylabel(case.quantity)
        for line in axes:
            plain_ticks(line)
        axes[0][-1].legend(fontsize=7)
        save(figure, path, dpi=100)


def plain_ticks(row: Any) -> None:
    """One range for all axes of a row, and ticks that stay apart where it is short."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low = min(ax.get_xlim()[0] for ax in row)
    high = max(ax.get_xlim()[1] for ax in row)
    steps = (1.0, 2.0, 5.0) if high / low < 30.0 else (1.0,)
    for ax in row:
        ax.set_xlim(low, high)
        ax.xaxis.set_major_locator(LogLocator(subs=steps))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())


def cost(records: list[dict[str, Any]], error: float, key: str) -> float:
    """Dofs or seconds at which a sequence of meshes reaches an error, by logarithmic interpolation.

    NaN if none does, and if the first one does already: then that one's.
    """
    found = [r for r in records if "error" in r]
    for before, after in zip([None, *found], found, strict=False):
        if after["error"] <= error:
            if before is None or before["error"] == after["error"]:
                return float(after[key])
            share = math.log(before["error"] / error) / math.log(before["error"] / after["error"])
            return float(before[key] * (after[key] / before[key]) ** share)
    return math.nan


def tables(case: Case, records: list[dict[str, Any]], error: float = 0.01) -> str:
    """Table of the errors on the finest mesh and of the cost of one percent."""
    rows: list[list[object]] = []
    more = [key for key in ("balance error",) if any(key in r for r in records)]
    for variant in case.variants:
        for element in case.elements:
            found = [r for r in records if (r["element"], r["variant"]) == (element, variant)]
            good = [r for r in found if "error" in r]
            last = found[-1]
            dofs, seconds = cost(found, error, "dofs"), cost(found, error, "seconds")
            rows.append(
                [
                    variant,
                    element,
                    f"{good[0]['error']:.1e} ({good[0]['dofs']})" if good else "",
                    f"{last['error']:.1e} ({last['dofs']})" if "error" in last else "stopped",
                    f"{last['iterations']}" if "iterations" in last else "",
                    "not reached" if math.isnan(dofs) else f"{dofs:.0f}",
                    "" if math.isnan(seconds) else f"{seconds:.3f}",
                    f"{last['seconds']:.2f}" if "error" in last else "",
                    *(f"{last[key]:.1e}" if key in last else "" for key in more),
                ]
            )
    head = (
        "",
        "element",
        "coarsest: error (dofs)",
        "finest: error (dofs)",
        "iterations",
        "dofs for 1 %",
        "CPU s for 1 %",
        "CPU s, finest",
        *more,
    )
    return table(head, rows)


def doubt(case: Case, records: list[dict[str, Any]]) -> str:
    """Change of the references with a mesh half as fine."""
    by_value: dict[str, list[str]] = {}
    for variant in case.variants:
        found = [r["moves"] for r in records if r["variant"] == variant and "moves" in r]
        if found:
            by_value.setdefault(f"{found[0]:.1e}", []).append(variant)
    if not by_value:
        return ""
    common = max(by_value, key=lambda value: len(by_value[value]))
    others = "".join(
        f", in {' and '.join(repr(v) for v in variants)} by {value}"
        for value, variants in by_value.items()
        if value != common
    )
    return f" With a mesh half as fine the reference changes by {common}{others}."


def has_all(case: Case, records: list[dict[str, Any]], variant: str) -> bool:
    """Whether every element of a variant was run."""
    return all(
        any((r["element"], r["variant"]) == (element, variant) for r in records)
        for element in case.elements
    )


def marks(name: str) -> tuple[str, str]:
    """Lines of the page between which a case's part is written."""
    return f"<!-- {name}: begin -->", f"<!-- {name}: end -->"


def write(case: Case, records: list[dict[str, Any]]) -> None:
    """Put a case's description, figure and table between its marks in the page."""
    begin, end = marks(case.name)
    text = PAGE.read_text(encoding="utf-8")
    if begin not in text:
        raise SystemExit(f"{PAGE}: no line {begin!r}")
    draw(case, records, IMAGES / f"comparison-{case.name}.png")
    part = (
        f"### {case.title}\n\n{case.about}{doubt(case, records)}\n\n"
        f"![{case.title}](images/comparison-{case.name}.png)\n\n{tables(case, records)}\n"
    )
    head, rest = text.split(begin)
    PAGE.write_text(f"{head}{begin}\n{part}\n{end}{rest.split(end)[1]}", encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--studies", nargs="+")
    parser.add_argument("--cases", nargs="+")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name} and its figures")
    parser.add_argument("--redraw", action="store_true", help="run nothing, take what is kept")
    args = parser.parse_args()
    for case in cases():
        if (args.studies and case.study not in args.studies) or (
            args.cases and case.name not in args.cases
        ):
            continue
        found = None if args.redraw else run(case)
        # Read late: another run may have added to it.
        kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
        if found is not None:
            kept[case.name] = found
            KEPT.parent.mkdir(parents=True, exist_ok=True)
            KEPT.write_text(json.dumps(kept), encoding="utf-8")
        if case.name not in kept:
            continue
        # What was stopped half-way is shown as far as it came.
        done = [v for v in case.variants if has_all(case, kept[case.name], v)]
        case = replace(case, variants=done)
        if args.write:
            write(case, kept[case.name])
        sys.stdout.write(f"\n### {case.title}\n\n{machine()}\n\n{tables(case, kept[case.name])}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Writes one page per problem: description, table, picture, curve and convergence plot."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import os
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.plots.figure import look, new_figure, save
from corota.verification.catalogue import GROUPS, Curve, Picture, Problem, Study, Value, problems

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.verification.outcome import Outcome

#: Dots per inch: enough for a page, small enough to keep under version control.
DPI = 80.0
#: Colors of a written picture; contours have few.
COLORS = 64
MARKERS = "osD^vP*Xh"
#: Text below the list of all pages.
LEFT_OUT = """\
## Not included

Three-dimensional problems (twisted beam, 45-degree bend, curved hook, right-angle cantilever).
Problems without numbers that we could check: the moving shallow arch, shallow-angle frame and
Lee frame of Le, Battini and Hjiaj; NAFEMS NL1 and NL4, SSNP303; Simo and Armero's panel in plane
strain, whose hardening is not available to us. Howland's strip, except for one width. Folding of a
body onto itself, for which there are no reference values (`examples/contact` has a crushed ring
and a seal)."""


def prepare(folder: str | os.PathLike[str]) -> Path:
    """Create the folder of the pages and of their figures."""
    target = Path(folder)
    (target / "figures").mkdir(parents=True, exist_ok=True)
    return target


def write_page(problem: Problem, outcome: Outcome, folder: str | os.PathLike[str]) -> Path:
    """Draw the figures of a problem and write its page.

    Parameters
    ----------
    outcome : Outcome
        With its study, if there is one.
    """
    target = prepare(folder)
    figures = []
    if problem.picture is not None:
        figures.append(("the model", _picture(problem.picture(), target, problem.name)))
    if problem.curve is not None:
        figures.append(("curves", _curve(problem.curve(), target, problem.name)))
    if outcome.study is not None:
        figures.append(("convergence", _study(outcome.study, target, problem.name)))
    page = target / f"{problem.name}.md"
    page.write_text(_text(problem, outcome, figures), encoding="utf-8")
    return page


def write_index(
    chosen: Sequence[Problem], outcomes: Sequence[Outcome], folder: str | os.PathLike[str]
) -> Path:
    """Write the list of the pages."""
    lines = [
        "# Verification",
        "",
        "Each problem is measured by `corota verify` and has a page, written by",
        "`corota verify --full --pages docs/verification`. *Values* counts the measured numbers,",
        "*worst* is the largest error over its tolerance.",
    ]
    by_name = {o.name: o for o in outcomes}
    for group in GROUPS:
        members = [p for p in chosen if p.group == group]
        if not members:
            continue
        lines += ["", f"## {group.capitalize()}", ""]
        lines += ["| problem | reference | values | worst | status |", "| --- " * 5 + "|"]
        for p in members:
            o = by_name[p.name]
            status = "ok" if o.ok else "missed"
            lines.append(
                f"| [{p.title}]({p.name}.md) | {p.certainty} | {len(o.values)} | {_worst(o)} "
                f"| {status} |"
            )
    if len(chosen) == len(problems()):
        lines += ["", LEFT_OUT]
    page = prepare(folder) / "index.md"
    page.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return page


def _worst(outcome: Outcome) -> str:
    shares = [v.error / v.tolerance for v in outcome.values if v.tolerance > 0.0]
    return f"{max(shares):.0%}" if shares else ""


def _text(problem: Problem, outcome: Outcome, figures: Sequence[tuple[str, Path]]) -> str:
    head, _, rest = problem.description.partition("\n\n")
    lines = [
        f"# {problem.title}",
        "",
        head,
        "",
        *([rest, ""] if rest else []),
        f"*Source:* {problem.source}.",
        "",
        f"*Reference:* {problem.certainty}. *Tolerance:* {problem.why}.",
        "",
        f"Run it with `corota verify {problem.name}`; the model is in "
        f"`corota.verification.problems.{problem.name}`.",
        "",
    ]
    for name, path in figures:
        lines += [f"![{problem.title}: {name}](figures/{path.name})", ""]
    lines += [
        "| quantity | reference | measured | error | tolerance |",
        "| --- | --- | --- | --- | --- |",
    ]
    lines += [_row(v) for v in outcome.values]
    if outcome.study is not None:
        lines += ["", *_study_table(outcome.study)]
    return "\n".join(lines) + "\n"


def _row(v: Value) -> str:
    bound = {"at least": "≥ ", "at most": "≤ "}.get(v.kind, "")
    error = "" if bound else f"{v.error:.1e}"
    tolerance = "" if bound else f"{v.tolerance:.0e}"
    miss = "" if v.ok else " **missed**"
    return (
        f"| {v.quantity} | {bound}{v.reference:.7g} | {v.measured:.7g}{miss} | {error} "
        f"| {tolerance} |"
    )


def _study_table(study: Study) -> list[str]:
    """Errors and the order over the last two sizes."""
    lines = [f"{study.label.capitalize()}, with the order over the last refinement:", ""]
    sizes = next(iter(study.series.values()))[0]
    same = all(tuple(s) == tuple(sizes) for s, _ in study.series.values())
    head = [f"{s:g}" for s in sizes] if same else [str(k + 1) for k in range(len(sizes))]
    what = study.across if same else "mesh"
    lines += [f"| {what} | " + " | ".join(head) + " | order |"]
    lines += ["| --- " * (len(sizes) + 2) + "|"]
    for name, (at, errors) in study.series.items():
        cells = " | ".join(f"{e:.1e}" for e in errors)
        lines.append(f"| {name} | {cells} | {order(study, at, errors):.2f} |")
    return lines


def order(study: Study, sizes: Sequence[float], errors: Sequence[float]) -> float:
    """Observed order against the size of a cell or increment, over the last refinement."""
    ratio = float(np.log(errors[-2] / errors[-1]) / np.log(sizes[-1] / sizes[-2]))
    plane = study.across in ("degrees of freedom", "cells")
    return 2.0 * ratio if plane else ratio


def _picture(picture: Picture, target: Path, name: str) -> Path:
    from corota import plots
    from corota.results.results import Results

    path = target / "figures" / f"{name}.png"
    if isinstance(picture.subject, Results):
        plots.contour(
            picture.subject, picture.variable, scale=picture.scale, path=path, dpi=DPI, title=""
        )
    else:
        plots.model(picture.subject, sets=False, path=path, dpi=DPI)
    return _shrunk(path)


def _curve(curve: Curve, target: Path, name: str) -> Path:
    path = target / "figures" / f"{name}-curve.png"
    with look():
        figure = new_figure(5.2, 3.6, shown=False)
        ax = figure.add_subplot()
        for label, (x, y) in curve.series.items():
            ax.plot(x, y, label=label, linewidth=1.3)
        for k, (label, (x, y)) in enumerate(curve.points.items()):
            ax.plot(
                x,
                y,
                linestyle="",
                marker=MARKERS[k % len(MARKERS)],
                markersize=5.0,
                markerfacecolor="none",
                color="#20242b",
                label=label,
            )
        _finish(ax, curve.x, curve.y)
        # Beside the lines and marks, not over them.
        ax.legend(fontsize=7.0, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
        save(figure, path, DPI * 1.15)
    return _shrunk(path)


def _study(study: Study, target: Path, name: str) -> Path:
    path = target / "figures" / f"{name}-convergence.png"
    with look():
        from matplotlib.ticker import LogFormatterSciNotation, NullLocator

        figure = new_figure(5.2, 3.8, shown=False)
        ax = figure.add_subplot()
        for k, (label, (x, y)) in enumerate(study.series.items()):
            ax.loglog(
                x,
                y,
                marker=MARKERS[k % len(MARKERS)],
                markersize=3.8,
                linewidth=1.1,
                label=label,
                linestyle="-" if k < 7 else "--",
            )
        _finish(ax, study.across, study.label)
        sizes = sorted({s for at, _ in study.series.values() for s in at})
        if len(sizes) <= 8:
            ax.xaxis.set_minor_locator(NullLocator())
            ax.set_xticks(sizes, [f"{s:g}" for s in sizes])
        # Less than a decade or two: minor ticks get numbers too.
        ax.yaxis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(1.5, 0.6)))
        ax.tick_params(axis="y", which="minor", labelsize=6.5)
        save(figure, path, DPI * 1.15)
    return _shrunk(path)


def _finish(ax: Any, x: str, y: str) -> None:
    ax.grid(True, color="#e6e9ee", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.set_xlabel(x)
    ax.set_ylabel("\n".join(wrap(y, 40)))
    ax.legend(fontsize=7.0, frameon=True, framealpha=0.85, edgecolor="none")


def _shrunk(path: Path) -> Path:
    """Give a picture a palette: a third of the bytes. Pillow comes with matplotlib."""
    from PIL import Image

    with Image.open(path) as image:
        small = image.convert("RGB").quantize(COLORS)
    small.save(path, optimize=True)
    return path

"""``corota plot``: pictures of results or of a model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input
from corota.errors import InputError

if TYPE_CHECKING:
    from corota.cli.terminal import Terminal
    from corota.results.history import History
    from corota.results.results import Results


def run(args: Any, terminal: Terminal) -> int:
    """Draw the requested picture and print its file."""
    from corota import plots

    with plots.width_of(args.width):
        return _run(args, terminal)


def _run(args: Any, terminal: Terminal) -> int:
    from corota import plots

    args.elements, args.parameters, args.lenient, args.allow_include = [], [], True, True
    args.as_written = False
    source = Path(args.file)
    if not is_result(args.file):
        if not args.model and source.suffix.lower() == ".inp":
            raise InputError(
                f"{source}: a deck has no results; draw them from {source.stem}.vtkhdf, "
                "or the model itself with --model"
            )
        subject = read_input(args.file, args)
        path = Path(args.output or f"{source.stem}_model.png")
        plots.model(subject, edges=args.edges, path=path, dpi=args.dpi)
        return _tell(path, terminal)
    from corota.io.result_reader import read_results

    if args.last_iterate:
        source = _iterate(source)
    with read_results(source) as results:
        if args.model:
            path = Path(args.output or f"{source.stem}_model.png")
            plots.model(results.model, edges=args.edges, path=path, dpi=args.dpi)
            return _tell(path, terminal)
        if args.modes or args.response or args.energies:
            return _of_motion(args, source, results, terminal)
        if args.forces or args.section or args.diagram:
            return _section_forces(args, source, results, terminal)
        if args.principal or args.flow:
            return _stress_lines(args, source, results, terminal)
        if args.curve:
            path = Path(args.output or f"{source.stem}_curve.png")
            y, x = _axes(args.curve, results)
            plots.curve(y, x, path=path, dpi=args.dpi)
            return _tell(path, terminal)
        if args.contact is not None:
            path = Path(args.output or f"{source.stem}_contact.png")
            plots.contact_line(results, args.contact, frame=args.frame, path=path, dpi=args.dpi)
            return _tell(path, terminal)
        if (args.field or "").upper() == "CSTATUS":
            path = Path(args.output or f"{source.stem}_CSTATUS.png")
            plots.status(results, frame=args.frame, scale=args.scale, path=path, dpi=args.dpi)
            return _tell(path, terminal)
        field = args.field or ("MISES" if "MISES" in results.variables() else "U")
        options = {"scale": args.scale, "per_cell": args.per_cell, "edges": args.edges}
        moving = args.animate or (args.output or "").lower().endswith((".gif", ".mp4", ".html"))
        if moving:
            path = Path(args.output or f"{source.stem}_{field}.gif")
            plots.animate(results, field, path=path, dpi=min(args.dpi, 110), **options)
        else:
            path = Path(args.output or f"{source.stem}_{field}.png")
            options |= {"frame": args.frame, "plastic": args.plastic or None}
            plots.contour(results, field, path=path, dpi=args.dpi, **options)
    return _tell(path, terminal)


def _iterate(source: Path) -> Path:
    """File with the last attempt of a run that stopped."""
    beside = source.with_name(f"{source.stem}.last_iterate{source.suffix}")
    if not beside.exists():
        raise InputError(
            f"{beside}: no such file; it is written beside the results of a run that stopped "
            "without convergence"
        )
    return beside


def _of_motion(args: Any, source: Path, results: Results, terminal: Terminal) -> int:
    """Modes, response or energies; modes are in a separate file."""
    from corota import plots
    from corota.io.result_reader import read_results

    kind = next(k for k in ("modes", "response", "energies") if getattr(args, k))
    path = Path(args.output or f"{source.stem}_{kind}.png")
    beside = source.with_name(f"{source.stem}.modes{source.suffix}")
    draw = getattr(plots, kind)
    if kind == "modes" and beside.exists():
        with read_results(beside) as found:
            draw(found, path=path, dpi=args.dpi)
    else:
        draw(results, path=path, dpi=args.dpi)
    return _tell(path, terminal)


def _stress_lines(args: Any, source: Path, results: Results, terminal: Terminal) -> int:
    """Principal stresses as crosses, or the flow of force."""
    from corota import plots

    options = {"frame": args.frame, "scale": args.scale, "dpi": args.dpi}
    if args.principal:
        path = Path(args.output or f"{source.stem}_principal.png")
        plots.principal(results, path=path, **options)
    else:
        path = Path(args.output or f"{source.stem}_flow.png")
        plots.flow(results, args.flow, path=path, **options)
    return _tell(path, terminal)


def _section_forces(args: Any, source: Path, results: Results, terminal: Terminal) -> int:
    """Diagrams of line elements, across planar ones, or the forces of a cut over the time."""
    from corota import plots
    from corota.results.section import Cut

    if args.forces:
        path = Path(args.output or f"{source.stem}_{args.forces}.png")
        found = results.member_forces(frame=args.frame)
        plots.section_forces(found, args.forces, scale=args.scale, path=path, dpi=args.dpi)
        return _tell(path, terminal)
    if args.diagram:
        path = Path(args.output or f"{source.stem}_diagram.png")
        x1, y1, x2, y2, width = args.diagram
        diagram = results.section_diagram([(x1, y1), (x2, y2)], width, frame=args.frame)
        plots.section_diagram(diagram, path=path, dpi=args.dpi)
        return _tell(path, terminal)
    path = Path(args.output or f"{source.stem}_section.png")
    x1, y1, x2, y2 = args.section
    cut = Cut(results, (x1, y1), (x2, y2))
    one = cut.forces(args.frame)
    terminal.line(f"N {one.N:.7g}  V {one.V:.7g}  M {one.M:.7g}  ({one.method})")
    terminal.record({"event": "section", "N": one.N, "V": one.V, "M": one.M, "method": one.method})
    plots.section_history(cut, path=path, dpi=args.dpi)
    return _tell(path, terminal)


def _axes(text: str, results: Results) -> tuple[History, History]:
    """Read ``Y,X``, each a variable or ``VARIABLE@SET`` or ``VARIABLE@NODE``."""
    parts = [p.strip() for p in text.split(",")]
    if len(parts) != 2:
        raise InputError(f"--curve {text!r}: write two quantities, such as 'U2@TIP,load factor'")
    first, second = (_history(p, results) for p in parts)
    return first, second


def _history(text: str, results: Results) -> History:
    import numpy as np

    name, _, where = text.partition("@")
    if not where:
        return results.history(name)
    if where.isdigit() and where not in results.mesh.node_sets:
        node = np.flatnonzero(results.mesh.node_labels == int(where))
        if not len(node):
            raise InputError(f"--curve {text!r}: there is no node {where}")
        found = results.history(name, at=int(node[0]))
        found.name = f"{found.name.partition(' at ')[0]} at node {where}"
        return found
    return results.history(name, at=where)


def _tell(path: Path, terminal: Terminal) -> int:
    terminal.line(f"wrote {path}")
    terminal.record({"event": "picture", "file": str(path)})
    return 0

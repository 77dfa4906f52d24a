"""``corota plot``: pictures of results or of a model."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.reading import is_result, read_input
from corota.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.cli.terminal import Terminal
    from corota.results.history import History
    from corota.results.results import Results

    #: Draws by a function of :mod:`corota.plots` into JOB_ENDING, or the file of the user.
    Draw = Callable[..., None]


def run(args: Any, terminal: Terminal) -> int:
    """Draw the requested picture and print its file."""
    from corota import plots

    args.elements, args.parameters, args.lenient, args.allow_include = [], [], True, True
    args.as_written = False
    source = Path(args.file)
    if args.last_iterate and is_result(args.file):
        source = _iterate(source)

    def draw(
        ending: str, function: Any, *subject: Any, dpi: int = args.dpi, **options: Any
    ) -> None:
        path = Path(args.output or f"{source.stem}_{ending}")
        function(*subject, path=path, dpi=dpi, **options)
        terminal.line(f"wrote {path}")
        terminal.record({"event": "picture", "file": str(path)})

    with plots.width_of(args.width):
        if is_result(args.file):
            from corota.io.result_reader import read_results

            with read_results(source) as results:
                _draw_results(args, source, results, terminal, draw)
        elif not args.model and source.suffix.lower() == ".inp":
            raise InputError(
                f"{source}: a deck has no results; draw them from {source.stem}.vtkhdf, "
                "or the model itself with --model"
            )
        else:
            draw("model.png", plots.model, read_input(args.file, args), edges=args.edges)
    return 0


def _draw_results(
    args: Any, source: Path, results: Results, terminal: Terminal, draw: Draw
) -> None:
    from corota import plots

    at: dict[str, Any] = {"frame": args.frame, "scale": args.scale}
    if args.model:
        draw("model.png", plots.model, results.model, edges=args.edges)
    elif args.modes:
        _draw_modes(source, results, draw)
    elif args.response:
        draw("response.png", plots.response, results)
    elif args.energies:
        draw("energies.png", plots.energies, results)
    elif args.forces:
        found = results.member_forces(frame=args.frame)
        draw(f"{args.forces}.png", plots.section_forces, found, args.forces, scale=args.scale)
    elif args.diagram:
        x1, y1, x2, y2, width = args.diagram
        diagram = results.section_diagram([(x1, y1), (x2, y2)], width, frame=args.frame)
        draw("diagram.png", plots.section_diagram, diagram)
    elif args.section:
        _draw_section(args, results, terminal, draw)
    elif args.principal:
        draw("principal.png", plots.principal, results, **at)
    elif args.flow:
        draw("flow.png", plots.flow, results, args.flow, **at)
    elif args.curve:
        y, x = _axes(args.curve, results)
        draw("curve.png", plots.curve, y, x)
    elif args.contact is not None:
        draw("contact.png", plots.contact_line, results, args.contact, frame=args.frame)
    elif args.field.upper() == "CSTATUS":
        draw("CSTATUS.png", plots.status, results, **at)
    else:
        field = args.field or ("MISES" if "MISES" in results.variables() else "U")
        options = {"scale": args.scale, "per_cell": args.per_cell, "edges": args.edges}
        if args.animate or (args.output or "").lower().endswith((".gif", ".mp4", ".html")):
            draw(f"{field}.gif", plots.animate, results, field, dpi=min(args.dpi, 110), **options)
        else:
            options |= {"frame": args.frame, "plastic": args.plastic or None}
            draw(f"{field}.png", plots.contour, results, field, **options)


def _iterate(source: Path) -> Path:
    """File with the last attempt of a run that stopped."""
    beside = source.with_name(f"{source.stem}.last_iterate{source.suffix}")
    if not beside.exists():
        raise InputError(
            f"{beside}: no such file; it is written beside the results of a run that stopped "
            "without convergence"
        )
    return beside


def _draw_modes(source: Path, results: Results, draw: Draw) -> None:
    """Modes, which are in a file of their own beside the results, if there is one."""
    from corota import plots
    from corota.io.result_reader import read_results

    beside = source.with_name(f"{source.stem}.modes{source.suffix}")
    if not beside.exists():
        draw("modes.png", plots.modes, results)
        return
    with read_results(beside) as found:
        draw("modes.png", plots.modes, found)


def _draw_section(args: Any, results: Results, terminal: Terminal, draw: Draw) -> None:
    """Forces of a cut over the time; those of the frame are printed."""
    from corota import plots
    from corota.results.section import Cut

    x1, y1, x2, y2 = args.section
    cut = Cut(results, (x1, y1), (x2, y2))
    one = cut.forces(args.frame)
    terminal.line(f"N {one.N:.7g}  V {one.V:.7g}  M {one.M:.7g}  ({one.method})")
    terminal.record({"event": "section", "N": one.N, "V": one.V, "M": one.M, "method": one.method})
    draw("section.png", plots.section_history, cut)


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

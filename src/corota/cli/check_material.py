"""``corota check-material``: drive material laws through strain paths and report their faults."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import runpy
from pathlib import Path
from typing import TYPE_CHECKING, Any

from corota.cli.reading import read_input
from corota.errors import FileError, InputError
from corota.model.materials import Material

if TYPE_CHECKING:
    from corota.check.material import LawCheck
    from corota.cli.terminal import Terminal

#: Exit code where a law has a fault.
FAULTY = 3
#: Errors of a law, and how the row calls them.
ERRORS = {n: n for n in ("tangent", "asymmetry", "objectivity", "energy")} | {"created": "gained"}


def run(args: Any, terminal: Terminal) -> int:
    """Check laws; 0 if none has a fault."""
    from corota.check.material import check_material

    found: list[LawCheck] = []
    for name, material in _materials(args).items():
        for plane in ("stress", "strain") if args.plane == "both" else (args.plane,):
            if plane == "strain" and material.incompressible:
                continue
            found.append(checked := check_material(material, plane, args.strain))
            checked.name = name
            terminal.line(_row(checked))
            for fault in checked.faults:
                terminal.error(f"{name}, plane {plane}: {fault}")
            facts = ("name", "plane", *ERRORS, "faults")
            terminal.record({"event": "material"} | {n: getattr(checked, n) for n in facts})
    if args.plot:
        from corota.plots.laws import law_curves

        law_curves(found, path=args.plot)
        terminal.line(f"picture: {args.plot}")
    return FAULTY if any(c.faults for c in found) else 0


def _materials(args: Any) -> dict[str, Material]:
    """The materials of a deck, or of a Python file by the names of its variables."""
    path = Path(args.file)
    if path.suffix != ".py":
        model = read_input(args.file, args)
        laws = {s.material.name or type(s.material).__name__: s.material for s in model.sections}
    elif not path.is_file():
        raise FileError(f"{path}: no such file")
    else:
        values = runpy.run_path(str(path))
        laws = {name: value for name, value in values.items() if isinstance(value, Material)}
    if args.name:
        if args.name not in laws:
            raise InputError(
                f"{path}: no material {args.name!r}; there are: {', '.join(laws) or 'none'}"
            )
        return {args.name: laws[args.name]}
    if not laws:
        raise InputError(f"{path}: no variable holds a material")
    return laws


def _row(checked: LawCheck) -> str:
    found = {words: getattr(checked, name) for name, words in ERRORS.items()}
    shown = (f"{words} {'-' if e is None else f'{e:.1e}'}" for words, e in found.items())
    return f"{checked.name}, plane {checked.plane}: {'  '.join(shown)}"

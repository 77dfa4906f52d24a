"""Arguments of the commands."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

#: Method of parsers that adds an argument.
Add = Callable[..., object]
#: Names of :data:`corota.analysis.linear.solvers.SOLVERS`, which would load numerics.
SOLVERS = ("multifrontal", "pardiso", "petsc", "petsc:gamg", "superlu")

EPILOG = """\
exit codes:
  0 done   2 input   3 model   4 not converged   5 resource   6 file
  7 interrupted   64 command line   70 internal
"""


def terminal_columns() -> int:
    """Width of the terminal as ``shutil`` finds it, which would load modules for archives."""
    try:
        columns = int(os.environ["COLUMNS"])
    except (KeyError, ValueError):
        columns = 0
    if columns <= 0:
        try:
            columns = os.get_terminal_size(sys.__stdout__.fileno()).columns  # type: ignore[union-attr]
        except (AttributeError, ValueError, OSError):
            columns = 0
    return columns or 80


class Help(argparse.HelpFormatter):
    """Help of that width."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=terminal_columns() - 2)


class Overview(Help, argparse.RawDescriptionHelpFormatter):
    """Help whose description keeps its line breaks."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog)
        # The names of commands are indented twice, which the base class does not count.
        self._action_max_length = max(map(len, COMMANDS)) + 4


class Parser(argparse.ArgumentParser):
    """Parser that ends with exit code 64 and a pointer to the help."""

    def error(self, message: str) -> NoReturn:
        self.exit(64, f"{self.prog}: {message}\n    see: {self.prog} --help\n")


class Version(argparse.Action):
    """Print the version without importing large modules."""

    def __call__(self, parser: argparse.ArgumentParser, *rest: object) -> NoReturn:
        from corota._core import __version__

        print(f"corota {__version__}")
        parser.exit(0)


def _run(add: Add) -> None:
    add("deck", help="input deck (.inp)")
    add("-o", "--output", metavar="DIR", default=".", help="folder of the results")
    add("--name", metavar="JOB", default="", help="name of the job (default: that of the deck)")
    add("--threads", type=_count, metavar="N", help="number of threads (default: all cores)")
    _solver(add)
    add(
        "--format",
        dest="formats",
        action="append",
        choices=("vtkhdf", "pvd", "frd", "frd-binary", "npz", "vtu"),
        help="result format, repeatable (default: vtkhdf)",
    )
    add(
        "--history",
        dest="histories",
        action="append",
        metavar="VAR@SET",
        default=[],
        help="column of the CSV file, such as U2@TIP or RF1@17, repeatable",
    )
    add(
        "--frd",
        nargs="?",
        const="frd",
        choices=("frd", "frd-binary"),
        help="JOB.frd for cgx, PrePoMax, FreeCAD beside the result file; frd-binary: smaller",
    )
    add("--points", action="store_true", help="also write values at quadrature points")
    add("--single", action="store_true", help="write fields in single precision (4 bytes)")
    add(
        "--fields",
        type=_fields,
        default="all",
        metavar="LIST",
        help="fields of the result file, such as U,S,PEEQ; or requested: as *NODE FILE, *EL FILE",
    )
    add("--compression", type=int, default=1, metavar="0-9", help="of the result file (default: 1)")
    _reading(add)
    add(
        "--checkpoint-every",
        type=_whole,
        metavar="N",
        help="checkpoint every N increments, 0 for none (default: every minute)",
    )
    add("--provenance", action="store_true", help="also write versions and digests of the inputs")
    add(
        "--serve",
        nargs="?",
        type=_port,
        const=0,
        metavar="PORT",
        help="show the progress on a local page and print its address",
    )


def _resume(add: Add) -> None:
    add("job", help="deck, checkpoint (.ckpt), or stem of the job's files")
    add("-o", "--output", metavar="DIR", help="folder of the results (default: that of the job)")
    add("--threads", type=_count, metavar="N", help="number of threads (default: all cores)")
    _solver(add)


def _sweep(add: Add) -> None:
    add("deck", help="input deck (.inp)")
    add(
        "-p",
        dest="grid",
        action="append",
        metavar="NAME=VALUES",
        required=True,
        type=_values,
        help="values t=0.2:0.6:9 (first, last, count) or n=1,2,4; repeatable, all combinations",
    )
    add(
        "-m",
        dest="measures",
        action="append",
        metavar="MEASURE",
        required=True,
        help="measure to keep, such as max(RM3@hub) or last(U2@tip); repeatable",
    )
    add(
        "--sample",
        type=_count,
        metavar="N",
        help="N points of a Latin hypercube between the first and last values, instead of a grid",
    )
    add("--seed", type=int, default=0, help="of the sample")
    add("--workers", type=_count, metavar="N", help="number of processes (default: all cores)")
    add("-o", "--output", metavar="FILE", help="table; else DECK_sweep.csv")
    add("--plot", metavar="FILE", help="picture of the first measure")
    add("--again", action="store_true", help="run stored rows again")
    _reading(add)


def _seek(add: Add) -> None:
    add("deck", help="input deck (.inp)")
    add(
        "-p",
        dest="range",
        metavar="NAME=FIRST:LAST",
        required=True,
        type=_values,
        help="the parameter and its range, such as t=0.3:0.9",
    )
    add("-m", dest="measure", metavar="MEASURE", required=True, help="such as max(RF2@tip)")
    add("--target", type=float, required=True, help="wanted value of the measure")
    add(
        "--tolerance",
        type=float,
        default=1e-4,
        help="largest error relative to the target (default: 1e-4)",
    )
    add("-o", "--output", metavar="FILE", help="store of the runs; else DECK_seek.jsonl")
    _reading(add)


def _mesh(add: Add) -> None:
    add("outline", help="drawing (.dxf) or planar face (.step, .iges, .brep)")
    add("-o", "--output", metavar="FILE", help="mesh (.inp, .msh); else OUTLINE.inp")
    add("--size", type=float, default=0.0, help="largest side of a cell")
    add("--through", type=_count, default=4, metavar="N", help="cells across a member (default: 4)")
    add("--quadratic", action="store_true", help="cells with middle nodes")
    add("--triangles", action="store_true", help="triangles only")
    add("--gap", type=float, default=0.0, help="largest gap that is closed")
    add("--layer", dest="layers", action="append", default=[], help="layer to take, repeatable")
    add("--plot", metavar="FILE", help="picture of the mesh with its sets")


def _demo(add: Add) -> None:
    add("name", nargs="?", default="gripper", help="example; else gripper")
    add("--list", action="store_true", help="list the examples")
    add("-o", "--output", metavar="DIR", default="", help="folder; else corota-demo/NAME")


def _check(add: Add) -> None:
    add("deck", help="input deck (.inp) or mesh (.msh)")
    _reading(add)


def _check_material(add: Add) -> None:
    add("file", help="input deck (.inp), or Python file (.py) with materials")
    add("--name", default="", help="one material by its name; else all")
    add("--plane", choices=("stress", "strain", "both"), default="both")
    add(
        "--strain",
        type=float,
        help="largest strain (default: ten times that of first yield, or 0.02)",
    )
    add("--plot", metavar="FILE", help="picture of stress against strain")
    _reading(add)


def _plot(add: Add) -> None:
    add("file", help="result file, or deck or mesh with --model")
    add("-o", "--output", metavar="FILE", help="picture: .png .svg .pdf; .gif .mp4 .html")
    add("--field", default="", help="variable: MISES S11 SP1 E12 U U2 ... ")
    add("--frame", type=int, default=-1, help="index of the frame, from 0 (default: -1, the last)")
    add("--scale", type=float, default=1.0, help="scale factor of the displacements")
    add("--element", dest="per_cell", action="store_true", help="element averages")
    add("--plastic", action="store_true", help="the elastic-plastic boundary as a line")
    add("--edges", action=argparse.BooleanOptionalAction, help="draw element edges")
    add("--model", action="store_true", help="mesh, sets, supports and loads")
    add("--curve", metavar="X,Y", help="a curve, such as 'U2@TIP,load factor'")
    add(
        "--contact",
        nargs="?",
        const="",
        metavar="PAIR",
        help="pressure along the slave surface of a contact pair, the first by default",
    )
    add(
        "--forces",
        choices=("N", "V", "M"),
        type=str.upper,
        help="diagram of a section force on trusses and beams",
    )
    add(
        "--section",
        nargs=4,
        type=float,
        metavar=("X1", "Y1", "X2", "Y2"),
        help="N, V and M of a cut through planar elements, over the time",
    )
    add(
        "--diagram",
        nargs=5,
        type=float,
        metavar=("X1", "Y1", "X2", "Y2", "WIDTH"),
        help="N, V and M along an axis, of cuts of this width across it",
    )
    add("--principal", action="store_true", help="principal stresses as crosses")
    add(
        "--flow",
        nargs="?",
        const="principal",
        choices=("principal", "x", "y"),
        help="trajectories of principal stress, or the flow of force along x or y",
    )
    add("--modes", action="store_true", help="mode shapes with their frequencies")
    add("--response", action="store_true", help="steady-state response")
    add("--energies", action="store_true", help="energies of a motion over time")
    add("--animate", action="store_true", help="all frames as a GIF, MP4 or HTML page")
    add(
        "--last-iterate",
        action="store_true",
        help="the last attempt of a run that stopped; RF shows the residual",
    )
    add("--dpi", type=_count, default=150, help="dots per inch")
    add("--width", type=float, default=0.0, metavar="MM", help="of the picture, such as 85")


def _report(add: Add) -> None:
    add("job", help="name of the job, or any of its files")
    add("other", nargs="?", help="another job, whose curves are drawn beside")
    add("-o", "--output", metavar="FILE", help="report (.html; default: JOB.html)")
    add("--title", default="", help="heading (default: the name of the job)")
    add(
        "--limit",
        type=float,
        default=9.5,
        metavar="MB",
        help="largest size of the page (default: 9.5); longer results are thinned, with a note",
    )


def _watch(add: Add) -> None:
    add("job", help="name of the job, its deck, or any of its files")
    add("-o", "--output", metavar="DIR", help="folder of the files (default: that of the job)")
    add("--terminal", action="store_true", help="print lines instead of serving a page")
    add("--open", action="store_true", help="open the page in a browser")
    add("--port", type=_port, default=0, metavar="PORT", help="else any free one")


def _view(add: Add) -> None:
    add("file", help="result file")
    add("-o", "--output", metavar="FILE", help="write a .png and open no window")
    add("--field", default="", help="variable: MISES S11 U2 ...")
    add("--scale", type=float, default=1.0, help="scale factor of the displacements")


def _info(add: Add) -> None:
    add("file")
    _reading(add)


def _convert(add: Add) -> None:
    add("source")
    add("target", nargs="?", help="the file extension selects the format")
    add(
        "--paraview",
        action="store_true",
        help="write a script beside the results that shows them in ParaView",
    )
    add("--field", default="", help="variable of the colors in ParaView")
    add("--scale", type=float, default=1.0, help="scale factor of the displacements in ParaView")
    _reading(add)


def _verify(add: Add) -> None:
    add("names", nargs="*", metavar="NAME", help="names or patterns (default: all)")
    add("--list", action="store_true", help="list the problems")
    add("--full", action="store_true", help="also run the convergence studies (minutes)")
    add("--pages", metavar="DIR", help="write a page for each problem (extra `plot`)")
    add("--jobs", type=_count, metavar="N", help="number of processes (default: all cores)")


def _solver(add: Add) -> None:
    add(
        "--solver",
        choices=SOLVERS,
        default=SOLVERS[0],
        help=f"solver of linear systems (default: {SOLVERS[0]})",
    )


def _reading(add: Add) -> None:
    add(
        "--element",
        dest="elements",
        action="append",
        metavar="OLD=NEW",
        default=[],
        type=_pair,
        help="replace an element type, such as CPS4=Q4D, repeatable",
    )
    add(
        "--parameter",
        dest="parameters",
        action="append",
        metavar="NAME=VALUE",
        default=[],
        type=_value,
        help="value of a *PARAMETER of the deck, repeatable",
    )
    add(
        "--stage",
        dest="stages",
        action="append",
        metavar="'SET axis=AXIS ...'",
        default=[],
        help="measure a body in every increment: 'HUB axis=rotation point=0,0 MISES=400', "
        "repeatable",
    )
    add(
        "--as-written",
        action="store_true",
        help="use reduced integration as written: CPS4R becomes Q4R instead of Q4I",
    )
    add("--lenient", action="store_true", help="treat unknown keywords as warnings")
    add(
        "--allow-include", action="store_true", help="allow *INCLUDE outside the folder of the deck"
    )
    add(
        "--allow-library",
        dest="library",
        metavar="PATH",
        help="load this library for *USER MATERIAL; its code runs with your rights",
    )


def _pair(text: str) -> tuple[str, str]:
    old, sign, new = text.partition("=")
    if not (old.strip() and sign and new.strip()):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form OLD=NEW, such as CPS4=Q4D")
    return old.strip().upper(), new.strip().upper()


def _value(text: str) -> tuple[str, float]:
    name, sign, value = text.partition("=")
    try:
        if not (name.strip() and sign):
            raise ValueError
        return name.strip(), int(value) if value.strip().lstrip("+-").isdigit() else float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not of the form NAME=NUMBER, such as t=0.5"
        ) from None


#: Values that a parameter of a sweep may have.
MOST_VALUES = 1_000_000


def _values(text: str) -> tuple[str, list[float]]:
    """``t=0.2:0.6:9`` (nine values from .2 to .6) or ``n=1,2,4``."""
    name, sign, values = text.partition("=")
    try:
        if not (name.strip() and sign):
            raise ValueError
        if ":" not in values:
            return name.strip(), [_value(f"x={v}")[1] for v in values.split(",")]
        low, high, *count = values.split(":")
        n = int(count[0]) if count else 2
        if not 1 <= n <= MOST_VALUES or len(count) > 1:
            raise ValueError
        a, b = float(low), float(high)
        # Without the last digits: 0.45, not 0.44999999999999996.
        return name.strip(), [float(f"{a + (b - a) * i / max(n - 1, 1):.14g}") for i in range(n)]
    except (ValueError, argparse.ArgumentTypeError):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not of the form NAME=FIRST:LAST:COUNT or NAME=VALUE,VALUE,..."
        ) from None


def _fields(text: str) -> str | tuple[str, ...]:
    if text in ("all", "requested"):
        return text
    return tuple(part.strip() for part in text.split(",") if part.strip())


def _whole(text: str) -> int:
    return 0 if text.strip() == "0" else _count(text)


def _port(text: str) -> int:
    number = int(text) if text.strip().isdigit() else -1
    if not 0 <= number < 65536:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port, 0 to 65535")
    return number


def _count(text: str) -> int:
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1")
    return number


#: Help text of each command, and the function that adds its arguments.
COMMANDS = {
    "run": ("Solve the steps of a deck and write the results.", _run),
    "resume": ("Resume a stopped run from its newest checkpoint.", _resume),
    "sweep": ("Run a deck for many values of its *PARAMETER names.", _sweep),
    "seek": ("Find the value of a parameter for which a measure has a given value.", _seek),
    "mesh": ("Mesh the outline of a drawing (.dxf) or of a planar face (.step).", _mesh),
    "demo": ("Run a built-in example; needs no file and no network.", _demo),
    "check": ("Check a deck or mesh without solving it.", _check),
    "check-material": ("Drive material laws through strain paths.", _check_material),
    "plot": ("Draw results (.vtkhdf), or a model with --model.", _plot),
    "report": ("Write an HTML report from the files of a job.", _report),
    "watch": ("Watch a run in progress, in a browser or in the terminal.", _watch),
    "view": ("Show results in an interactive window (extra `view`).", _view),
    "info": ("Describe a deck, a mesh or a result file.", _info),
    "convert": ("Convert a mesh to a deck (.inp), or results to another format.", _convert),
    "verify": ("Solve the problems of the verification catalogue.", _verify),
}


def make_parser(words: Sequence[str]) -> Parser:
    """Build the parser of a command line: of all commands, with the arguments of the one in it.

    Where the command comes first the others are left out: the arguments of all commands take as
    long to build as Python to start.
    """
    command = next((word for word in words if not word.startswith("-")), "")
    alone = command in COMMANDS and words[0] == command
    parser = Parser(
        prog="corota",
        description="Co-rotational planar finite elements: solve decks, draw and convert results.",
        epilog=EPILOG,
        formatter_class=Overview,
    )
    parser.add_argument("--version", action=Version, nargs=0, help="print the version")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in [command] if alone else COMMANDS:
        text, add_arguments = COMMANDS[name]
        made = commands.add_parser(name, help=text, description=text, formatter_class=Help)
        if name == command:
            made.add_argument("--json", action="store_true", help="JSON lines on standard output")
            made.add_argument("-q", "--quiet", action="store_true", help="errors only")
            made.add_argument(
                "-v", "--verbose", action="count", default=0, help="more lines; -vv more"
            )
            add_arguments(made.add_argument)
    return parser
